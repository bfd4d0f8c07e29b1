// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a picture shows of trained Gaussians, alone or with surfaces among them.
#include "gaussian_scene.h"
#include "gaussian_files.h"

#include <math.h>
#include <stdlib.h>

enum { CORNERS = 8 };

/// Opacities from there on make a place worth showing.
static const float SEEN = 0.1f;

/// Standard deviations of a Gaussian that belong to what is framed.
static const float REACH = 2;

bool gaussian_scene_find(cli_session *session, const common_arguments *common,
                         const gaussian_arguments *arguments, gaussian_scene *scene) {
    scene->rest = *common;
    if (arguments->surface) return true;
    scene->operands = malloc(common->operand_count * sizeof *scene->operands);
    if (!scene->operands)
        return session_fail(session, "out of memory for %zu names", common->operand_count) == 0;
    scene->rest.operand_count = 0;
    scene->rest.operands = scene->operands;
    for (size_t i = 0; i < common->operand_count; i++) {
        const char *path = common->operands[i];
        if (gaussian_files_format(session, path) == EWA_GAUSSIANS_NONE) {
            scene->operands[scene->rest.operand_count++] = path;
            continue;
        }
        if (scene->path) {
            session->subject = path;
            session_fail(session,
                         "a picture shows the Gaussians of one file, and %s has some; --surface draws all as "
                         "surfels",
                         scene->path);
            return false;
        }
        scene->path = path;
    }
    session->subject = NULL;
    return true;
}

static bool is_shown(const ewa_gaussians *set, const ewa_bounds *core, size_t number) {
    for (size_t k = 0; k < 3; k++) {
        const double at = set->origin[k] + (double)set->centers[3 * number + k];
        if (!(at >= core->low_world[k] && at <= core->high_world[k])) return false;
    }
    return set->opacities[number] >= SEEN;
}

/// Where the Gaussians of the core are, and the corners of a box around the others.
static ewa_status make_outline(const ewa_gaussians *set, const ewa_cloud *others, gaussian_scene *scene) {
    ewa_bounds box = {.finite_count = 0};
    if (others) ewa_cloud_measure(others, &box);
    uint64_t count = 0;
    for (size_t i = 0; i < set->count; i++) count += is_shown(set, &scene->info.core, i);
    const uint64_t corners = box.finite_count || !count ? CORNERS : 0;
    if (!box.finite_count) box = scene->info.core;
    void *data = NULL, *reach = NULL;
    ewa_status status = ewa_cloud_create(set->context, count + corners, &scene->outline);
    if (status == EWA_OK) status = ewa_cloud_add(scene->outline, EWA_POSITION, EWA_F64, 3, &data);
    if (status == EWA_OK) status = ewa_cloud_add(scene->outline, EWA_RADIUS, EWA_F32, 1, &reach);
    if (status != EWA_OK) return status;
    double *positions = data;
    float *radii = reach;
    for (size_t i = 0; i < set->count; i++) {
        if (!is_shown(set, &scene->info.core, i)) continue;
        for (size_t k = 0; k < 3; k++) *positions++ = set->origin[k] + (double)set->centers[3 * i + k];
        const float *scales = set->scales + 3 * i;
        *radii++ = REACH * fmaxf(fmaxf(scales[0], scales[1]), scales[2]);
    }
    for (uint64_t i = 0; i < corners; i++) *radii++ = 0;
    for (uint64_t i = 0; i < corners; i++)
        for (int k = 0; k < 3; k++) *positions++ = i >> k & 1 ? box.high_world[k] : box.low_world[k];
    return EWA_OK;
}

bool gaussian_scene_read(cli_session *session, const ewa_cloud *others, gaussian_scene *scene) {
    ewa_gaussians set;
    ewa_gaussian_facts facts;
    if (!gaussian_files_load(session, scene->path, &set, &facts)) return false;
    scene->up_axis = gaussian_files_up_axis(&facts);
    ewa_status status = ewa_splats_create(&set, &scene->splats);
    if (status == EWA_OK) {
        ewa_splats_describe(scene->splats, &scene->info);
        status = make_outline(&set, others, scene);
    }
    ewa_gaussians_free(&set);
    if (status != EWA_OK) session_failed(session, status);
    return status == EWA_OK;
}

bool gaussian_scene_load(cli_session *session, const ewa_cloud *others, gaussian_scene *scene) {
    if (!gaussian_scene_read(session, others, scene)) return false;
    const ewa_status status = ewa_gaussian_renderer_create(session->context, &scene->renderer);
    if (status != EWA_OK) session_failed(session, status);
    return status == EWA_OK;
}

ewa_status gaussian_scene_paint(gaussian_scene *scene, const ewa_camera *camera,
                                const ewa_gaussian_options *options, const ewa_frame *frame,
                                ewa_render_stats *stats) {
    ewa_gaussian_stats drawn;
    ewa_gaussian_options nearer = *options;
    nearer.near_world = scene->info.near_world;
    const ewa_status status =
        ewa_gaussian_render(scene->renderer, scene->splats, camera, &nearer, frame, &drawn);
    if (status != EWA_OK) return status;
    stats->splat_count += drawn.splat_count;
    stats->culled_count += drawn.splat_count - drawn.visible_count;
    stats->drawn_count += drawn.visible_count;
    stats->total_s += drawn.total_s;
    return EWA_OK;
}

ewa_status gaussian_scene_paint_among(gaussian_scene *scene, const ewa_camera *camera,
                                      const ewa_gaussian_options *options, const ewa_frame *frame,
                                      ewa_render_stats *stats) {
    within_planes *planes = &scene->planes;
    ewa_gaussian_options among = *options;
    among.near_world = scene->info.near_world;
    const ewa_frame past = {.rgba = planes->past.pixels}, front = {.rgba = planes->front.pixels};
    ewa_status status = ewa_gaussian_render(scene->renderer, scene->splats, camera, &among, &past, NULL);
    among.surface_depth = planes->surface_depth.pixels;
    among.surface_rgba = planes->nothing.pixels;
    if (status == EWA_OK)
        status = ewa_gaussian_render(scene->renderer, scene->splats, camera, &among, &front, NULL);
    if (status != EWA_OK) return status;
    within_fill_edges(planes, options->background);
    among.surface_rgba = planes->surface.pixels;
    return gaussian_scene_paint(scene, camera, &among, frame, stats);
}

void gaussian_scene_free(gaussian_scene *scene) {
    ewa_splats_destroy(&scene->splats);
    ewa_gaussian_renderer_destroy(&scene->renderer);
    ewa_cloud_destroy(&scene->outline);
    within_free(&scene->planes);
    free(scene->operands);
}
