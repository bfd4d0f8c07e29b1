// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Defaults and checks of the options of volumes.
#include "volume/options.h"
#include "base/base.h"
#include "image/material.h"
#include "splat/options.h"

#include <string.h>

void ewa_voxels_options_init(ewa_voxels_options *options, size_t struct_size) {
    if (!options || struct_size < sizeof *options) return;
    memset(options, 0, struct_size);
    options->struct_size = struct_size;
    options->level_count = 2;
}

void ewa_volume_options_init(ewa_volume_options *options, size_t struct_size) {
    if (!options || struct_size < sizeof *options) return;
    memset(options, 0, struct_size);
    options->struct_size = struct_size;
    options->sigma = 0.6;
    options->cutoff = 3;
    options->prefilter_px = 0.35;
    options->point_threshold_px = 1.2;
    options->depth_unit = 1;
    options->density_scale = 1;
    options->least_transmittance = 1.0 / 512;
    ewa_material_init(&options->material);
}

ewa_status ewa_voxels_options_choose(ewa_context *context, const ewa_voxels_options *given,
                                     ewa_voxels_options *chosen) {
    ewa_voxels_options_init(chosen, sizeof *chosen);
    if (!given) return EWA_OK;
    ewa_status status =
        ewa_option_check_size(context, "ewa_voxels_options", given->struct_size, sizeof *chosen);
    if (status == EWA_OK)
        status = ewa_option_check_range(context, "level_count", given->level_count, 1, false,
                                        EWA_MAX_VOLUME_LEVELS);
    if (status == EWA_OK) *chosen = *given;
    return status;
}

static ewa_status check_numbers(ewa_context *context, const ewa_volume_options *options) {
    const struct {
        const char *name;
        double value, low, high;
    } ranges[] = {
        {"sigma", options->sigma, 0.3, 2},
        {"cutoff", options->cutoff, 1, 4},
        {"prefilter_px", options->prefilter_px, 0, 4},
        {"point_threshold_px", options->point_threshold_px, 0, 1.5},
        {"depth_unit", options->depth_unit, 0.25, 16},
        {"level", options->level, 0, EWA_MAX_VOLUME_LEVELS - 1},
        {"density_scale", options->density_scale, 0, 1e15},
        {"least_transmittance", options->least_transmittance, 0, 0.999999},
    };
    ewa_status status = EWA_OK;
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges && status == EWA_OK; i++)
        status = ewa_option_check_range(context, ranges[i].name, ranges[i].value, ranges[i].low, false,
                                        ranges[i].high);
    return status;
}

ewa_status ewa_volume_options_choose(ewa_context *context, const ewa_volume_options *given,
                                     ewa_volume_options *chosen) {
    ewa_volume_options_init(chosen, sizeof *chosen);
    if (!given) return EWA_OK;
    ewa_status status =
        ewa_option_check_size(context, "ewa_volume_options", given->struct_size, sizeof *chosen);
    if (status == EWA_OK)
        status = ewa_option_check_choice(context, "method", (int)given->method, EWA_VOLUME_POINTS);
    if (status == EWA_OK)
        status = ewa_option_check_choice(context, "index", (int)given->index, EWA_INDEX_TABLE);
    if (status == EWA_OK)
        status = ewa_option_check_choice(context, "shading", (int)given->shading, EWA_SHADING_PHONG);
    if (status == EWA_OK) status = check_numbers(context, given);
    if (status == EWA_OK) status = ewa_option_check_lights(context, given->lights, given->light_count);
    if (status == EWA_OK) status = ewa_material_check(context, "options", 0, &given->material);
    if (status == EWA_OK) status = ewa_option_check_background(context, given->background);
    if (status == EWA_OK && !given->surface_depth != !given->surface_rgba)
        status = ewa_fail(context, EWA_ERROR_ARGUMENT, "options: %s without %s",
                          given->surface_depth ? "surface_depth" : "surface_rgba",
                          given->surface_depth ? "surface_rgba" : "surface_depth");
    if (status == EWA_OK) *chosen = *given;
    return status;
}

ewa_status ewa_volume_frame_check(ewa_context *context, const ewa_frame *frame) {
    if (!frame->normal) return EWA_OK;
    return ewa_fail(context, EWA_ERROR_ARGUMENT, "volume: a volume has no normals for frame.normal");
}

void ewa_volume_shading_make(const ewa_volume_options *options, ewa_shading_setup *setup) {
    ewa_render_options render;
    ewa_render_options_init(&render, sizeof render);
    render.shading = options->shading;
    memcpy(render.lights, options->lights, sizeof render.lights);
    render.light_count = options->light_count;
    render.materials = &options->material;
    render.material_count = 1;
    ewa_shading_setup_make(&render, setup);
    setup->materials[0] = options->material; // also without highlights
}
