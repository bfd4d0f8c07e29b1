// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Defaults and checks of the options of volumes.
#include "volume/options.h"
#include "base/base.h"
#include "base/options.h"
#include "image/material.h"
#include "surface/options.h"

#include <string.h>

#define OF_VOXELS(member) offsetof(ewa_voxels_options, member)
#define OF_VOLUME(member) offsetof(ewa_volume_options, member)

static const ewa_option voxels_rows[] = {
    {"level_count", EWA_OPTION_U32, OF_VOXELS(level_count), 1, EWA_MAX_VOLUME_LEVELS, .initial = 2,
     .help = "levels of means of 2x2x2 voxels, for a first picture that is fast"},
};

const ewa_option_table ewa_voxels_options_table = EWA_OPTION_TABLE(ewa_voxels_options, voxels_rows);

static const ewa_option volume_rows[] = {
    {"method", EWA_OPTION_CHOICE, OF_VOLUME(method), .words = "hybrid|splats|points",
     .help = "voxels as splats where they are magnified and as points where they are minified, or all as one "
             "of these"},
    {"index", EWA_OPTION_CHOICE, OF_VOLUME(index), .words = "exact|table",
     .help = "how a pixel finds its place in a splat: how far its ray passes the voxel's centre, or the "
             "paper's table"},
    {"sigma", EWA_OPTION_F64, OF_VOLUME(sigma), 0.3, 2, .initial = 0.6,
     .help = "standard deviation of the kernel around each voxel, in voxels"},
    {"cutoff", EWA_OPTION_F64, OF_VOLUME(cutoff), 1, 4, .initial = 3,
     .help = "standard deviations at which a kernel ends"},
    {"prefilter_px", EWA_OPTION_F64, OF_VOLUME(prefilter_px), 0, 4, .initial = 0.35, .unit = "px",
     .help = "standard deviation of the pixel filter in pixels; 0: none"},
    {"point_threshold_px", EWA_OPTION_F64, OF_VOLUME(point_threshold_px), 0, 1.5, .initial = 1.2,
     .unit = "px", .help = "spacing on the screen up to which voxels are points"},
    {"depth_unit", EWA_OPTION_F64, OF_VOLUME(depth_unit), 0.25, 16, .initial = 1,
     .help = "depth that is composited at once, in smallest spacings of the grid"},
    {"level", EWA_OPTION_U32, OF_VOLUME(level), 0, EWA_MAX_VOLUME_LEVELS - 1,
     .help = "which of the voxels' levels; 0: all voxels"},
    {"density_scale", EWA_OPTION_F64, OF_VOLUME(density_scale), 0, 1e15, .initial = 1,
     .help = "multiplies every extinction: 2 is twice as dense"},
    {"minimum_transmittance", EWA_OPTION_F64, OF_VOLUME(minimum_transmittance), 0, 0.999999,
     .initial = 1.0 / 512,
     .help = "where less of what is behind would show, nothing more is drawn; 0: everything is"},
    {"shading", EWA_OPTION_CHOICE, OF_VOLUME(shading), .words = "none|lambert|phong",
     .help = "light, by the gradient: none gives the bare colours, lambert matt matter, phong highlights"},
    {"light_count", EWA_OPTION_U32, OF_VOLUME(light_count), 0, EWA_MAX_LIGHTS,
     .help = "how many lights there are; 0: a headlight"},
    {"background", EWA_OPTION_F32, OF_VOLUME(background), 0, 1e15, .count = 4,
     .help = "linear light, straight alpha, which is at most 1"},
    {"mark_splats", EWA_OPTION_BOOL, OF_VOLUME(mark_splats),
     .help = "draw voxels that are splats in red, points as they are"},
    {"section_count", EWA_OPTION_U32, OF_VOLUME(section_count), 0, EWA_MAX_SECTION_PLANES,
     .help = "how many section planes there are"},
};

const ewa_option_table ewa_volume_options_table = EWA_OPTION_TABLE(ewa_volume_options, volume_rows);

void ewa_voxels_options_init(ewa_voxels_options *options, size_t struct_size) {
    ewa_options_init(&ewa_voxels_options_table, options, struct_size);
}

void ewa_volume_options_init(ewa_volume_options *options, size_t struct_size) {
    ewa_options_init(&ewa_volume_options_table, options, struct_size);
    if (options && struct_size >= OF_VOLUME(material) + sizeof options->material)
        ewa_material_init(&options->material);
}

ewa_status ewa_voxels_options_choose(ewa_context *context, const ewa_voxels_options *given,
                                     ewa_voxels_options *chosen) {
    ewa_voxels_options_init(chosen, sizeof *chosen);
    return ewa_options_take(context, &ewa_voxels_options_table, given, chosen);
}

ewa_status ewa_surface_planes_check(ewa_context *context, const ewa_surface_planes *planes) {
    if (!planes->depth != !planes->rgba)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "options: %s without %s",
                        planes->depth ? "surface_depth" : "surface_rgba",
                        planes->depth ? "surface_rgba" : "surface_depth");
    if (planes->depth || (!planes->normal && !planes->coverage)) return EWA_OK;
    return ewa_fail(context, EWA_ERROR_ARGUMENT, "options: %s without surface_depth",
                    planes->normal ? "surface_normal" : "surface_coverage");
}

ewa_status ewa_volume_options_choose(ewa_context *context, const ewa_volume_options *given,
                                     ewa_volume_options *chosen) {
    ewa_volume_options_init(chosen, sizeof *chosen);
    EWA_TRY(ewa_options_take(context, &ewa_volume_options_table, given, chosen));
    EWA_TRY(ewa_option_check_lights(context, chosen->lights, chosen->light_count));
    EWA_TRY(ewa_material_check(context, "options", 0, &chosen->material));
    EWA_TRY(ewa_option_check_background(context, chosen->background));
    EWA_TRY(ewa_option_check_sections(context, (const double(*)[4])chosen->section_planes,
                                      chosen->section_count));
    const ewa_surface_planes planes = EWA_SURFACE_PLANES_OF(chosen);
    return ewa_surface_planes_check(context, &planes);
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
