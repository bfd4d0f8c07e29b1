// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What is selected, taken out of the scene: to be counted and marked, and to be written to a file of its kind.
#include "inner.h"

#include <stdio.h>

/// Makes a copy of the scene that shows what of the selection is not hidden.
static ewa_status copy_selected(viewer *v, ewa_scene **scene) {
    paint_scene shown;
    viewer_scene(v, &shown);
    ewa_scene_options *options = &shown.options;
    v->probe.message[0] = 0;
    ewa_status status = ewa_scene_copy(v->scene, v->probe.context, scene);
    if (options->region_count == EWA_MAX_REGIONS) return EWA_ERROR_LIMIT;
    options->regions[options->region_count] = v->selection.region;
    options->regions[options->region_count++].kept = true;
    return status == EWA_OK ? ewa_scene_set_options(*scene, options) : status;
}

ewa_status cut_take_points(viewer *v, ewa_cloud **points) {
    ewa_scene *scene = NULL;
    ewa_scene_info info;
    ewa_scene_describe(v->scene, &info);
    if (info.octrees) {
        painter_hurry(v->painter);
        v->posted_whole = false;
        turns_take_all(v->turns);
    }
    ewa_status status = copy_selected(v, &scene);
    if (status == EWA_OK) status = ewa_scene_points(scene, points);
    ewa_scene_destroy(&scene);
    if (info.octrees) turns_give_all(v->turns);
    return status;
}

ewa_status cut_take_centers(viewer *v, uint64_t limit, ewa_cloud **centers, uint64_t *count) {
    ewa_scene *scene = NULL;
    ewa_status status = copy_selected(v, &scene);
    if (status == EWA_OK) status = ewa_scene_centers(scene, limit, centers, count);
    ewa_scene_destroy(&scene);
    return status;
}

/// Writes the points; `*count` of them.
static ewa_status save_points(viewer *v, const char *path, uint64_t *count) {
    ewa_cloud *points = NULL;
    ewa_status status = cut_take_points(v, &points);
    *count = points ? ewa_cloud_point_count(points) : 0;
    if (status == EWA_OK && *count) status = ewa_cloud_save(points, path, NULL);
    ewa_cloud_destroy(&points);
    return status;
}

/// Writes the Gaussians, with the up of their file.
static ewa_status save_gaussians(viewer *v, const char *path, uint64_t *count) {
    ewa_scene *scene = NULL;
    ewa_gaussians set = {.context = NULL};
    ewa_gaussians_save_options options;
    ewa_gaussians_save_options_init(&options, sizeof options);
    ewa_status status = copy_selected(v, &scene);
    if (status == EWA_OK) status = ewa_scene_gaussians(scene, &set, options.up_world);
    *count = set.count;
    if (status == EWA_OK && *count) status = ewa_gaussians_save(&set, path, &options);
    ewa_gaussians_free(&set);
    ewa_scene_destroy(&scene);
    return status;
}

/// Writes the grid around the voxels.
static ewa_status save_volume(viewer *v, const char *path, uint64_t *count) {
    ewa_scene *scene = NULL;
    ewa_volume volume = {.context = NULL};
    ewa_status status = copy_selected(v, &scene);
    if (status == EWA_OK) status = ewa_scene_volume(scene, &volume);
    *count = (uint64_t)volume.dims[0] * volume.dims[1] * volume.dims[2];
    if (status == EWA_OK) status = ewa_volume_save(&volume, path, NULL);
    ewa_volume_free(&volume);
    ewa_scene_destroy(&scene);
    return status;
}

bool select_cut(viewer *v, const char *path) {
    const viewer_selection *s = &v->selection;
    v->state.question = VIEWER_ASKS_NOTHING;
    if (!s->given) {
        viewer_tell(v, "cut: nothing is selected");
        return false;
    }
    if (!*path) return commands_ask(v, VIEWER_ASKS_CUT);
    ewa_scene_info info;
    ewa_scene_describe(v->scene, &info);
    const bool points = s->count || info.octrees, centers = s->center_count > 0;
    if (centers && (points || (info.gaussians && info.volumes))) {
        viewer_tell(v, "cut: several kinds are selected, which no file holds together: hide all but one (show N off), then select again");
        return false;
    }
    uint64_t count = 0;
    const char *what = !centers ? "points" : info.gaussians ? "Gaussians" : "voxels";
    const ewa_status status = (!centers ? save_points : info.gaussians ? save_gaussians : save_volume)(v, path, &count);
    if (status != EWA_OK)
        viewer_tell(v, "%s: the %s cannot be saved: %s", path, what, v->probe.message[0] ? v->probe.message : ewa_status_name(status));
    else if (!count)
        viewer_tell(v, "cut: none of the %s is selected", what);
    else
        viewer_say(v, "cut %llu %s to %s", (unsigned long long)count, what, path), viewer_note(v, "%s", v->said);
    return status == EWA_OK && count;
}
