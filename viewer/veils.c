// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What of a picture lets light through.
#include "veils.h"

#include <math.h>
#include <string.h>

/// The finest level that voxels have and that is wanted.
static uint32_t voxels_level(const paint_scene *scene, const ewa_voxels *voxels) {
    ewa_voxels_info info;
    ewa_voxels_describe(voxels, &info);
    return scene->voxels_level < info.level_count ? scene->voxels_level : info.level_count - 1;
}

/// Each volume of a picture has a renderer of its own.
static ewa_status make_renderers(paint_tools *tools, uint32_t count) {
    ewa_status status = EWA_OK;
    for (uint32_t i = count; i < VIEWER_MAX_ITEMS; i++) // of what is shown no longer
        ewa_volume_renderer_destroy(&tools->volume_renderers[i]);
    for (uint32_t i = 0; i < count && status == EWA_OK; i++)
        if (!tools->volume_renderers[i])
            status = ewa_volume_renderer_create(tools->context, &tools->volume_renderers[i]);
    return status;
}

void veils_free(paint_tools *tools) {
    for (int i = 0; i < VIEWER_MAX_ITEMS; i++) ewa_volume_renderer_destroy(&tools->volume_renderers[i]);
    ewa_gaussian_renderer_destroy(&tools->gaussian_renderer);
}

/// One volume and nothing else takes no layers.
static ewa_status draw_volume(paint_tools *tools, const paint_scene *scene, const ewa_frame *frame,
                              double *took_s) {
    ewa_volume_options options = scene->volume;
    ewa_volume_stats stats = {.total_s = 0};
    options.level = voxels_level(scene, scene->voxels[0]);
    memcpy(options.background, scene->render.background, sizeof options.background);
    memcpy(options.section_planes, scene->render.section_planes, sizeof options.section_planes);
    options.section_count = scene->render.section_count;
    const ewa_status status = ewa_volume_render(tools->volume_renderers[0], scene->voxels[0], &scene->camera,
                                                &options, frame, &stats);
    *took_s += stats.total_s;
    return status;
}

ewa_status veils_draw(paint_tools *tools, const paint_scene *scene, const float *surface_depth,
                      const float *surface_rgba, const ewa_frame *frame, double *took_s) {
    ewa_status status = make_renderers(tools, scene->voxels_count);
    if (status != EWA_OK) return status;
    if (scene->voxels_count == 1 && !scene->splats_count && !surface_depth)
        return draw_volume(tools, scene, frame, took_s);
    ewa_volume_options volumes[VIEWER_MAX_ITEMS];
    ewa_mixed_volume mixed[VIEWER_MAX_ITEMS];
    for (uint32_t i = 0; i < scene->voxels_count; i++) {
        volumes[i] = scene->volume;
        volumes[i].level = voxels_level(scene, scene->voxels[i]);
        mixed[i] = (ewa_mixed_volume){tools->volume_renderers[i], scene->voxels[i], &volumes[i], NULL};
    }
    ewa_gaussian_options options;
    ewa_gaussian_stats stats = {.total_s = 0};
    ewa_gaussian_options_init(&options, sizeof options);
    for (uint32_t i = 0; i < scene->splats_count; i++) {
        ewa_splats_info info;
        ewa_splats_describe(scene->splats[i], &info);
        options.near_world = fmin(options.near_world, info.near_world);
    }
    memcpy(options.background, scene->render.background, sizeof options.background);
    memcpy(options.section_planes, scene->render.section_planes, sizeof options.section_planes);
    options.section_count = scene->render.section_count;
    options.surface_depth = surface_depth;
    options.surface_rgba = surface_rgba;
    const ewa_mixture mixture = {scene->splats, scene->splats_count, scene->voxels_count, mixed};
    status = ewa_mixture_render(tools->gaussian_renderer, &mixture, &scene->camera, &options, frame, &stats);
    *took_s += stats.total_s;
    return status;
}
