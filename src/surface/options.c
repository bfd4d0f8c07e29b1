// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Defaults and checks of surfels' and pictures' options.
#include "surface/options.h"
#include "base/base.h"
#include "base/options.h"
#include "image/material.h"

#include <math.h>

#define OF_SURFELS(member) offsetof(ewa_surfels_options, member)
#define OF_RENDER(member)  offsetof(ewa_render_options, member)

static const ewa_option surfels_rows[] = {
    {"cutoff", EWA_OPTION_F64, OF_SURFELS(cutoff), 0, 4, EWA_OPTION_ABOVE, .initial = 3,
     .help = "standard deviations at which a kernel ends"},
    {"radius_scale", EWA_OPTION_F64, OF_SURFELS(radius_scale), 0, 1e15, EWA_OPTION_ABOVE, .initial = 1,
     .help = "multiplies every radius and axis"},
    {"level_count", EWA_OPTION_U32, OF_SURFELS(level_count), 1, EWA_MAX_LEVELS, .initial = 1,
     .help = "levels of detail, each of a quarter of the surfels of the one before; 1: all surfels only"},
};

const ewa_option_table ewa_surfels_options_table = EWA_OPTION_TABLE(ewa_surfels_options, surfels_rows);

static const ewa_option render_rows[] = {
    {"kernel", EWA_OPTION_CHOICE, OF_RENDER(kernel), .words = "perspective|affine|source|circular|raycast",
     .help =
         "projected shape of a splat: its exact ellipse, the ellipse of the affine map at its centre, the "
         "same evaluated in the surfel's plane, the circle around it, or the exact kernel at each pixel"},
    {"prefilter_px", EWA_OPTION_F64, OF_RENDER(prefilter_px), 0, 4, .initial = 0.35, .unit = "px",
     .help = "standard deviation of the pixel filter; 0: none"},
    {"point_size_px", EWA_OPTION_F64, OF_RENDER(point_size_px), 1, 256, EWA_OPTION_OR_ZERO, .unit = "px",
     .help = "draws every point as a disc of that diameter that faces the viewer: for points that are no "
             "surface; 0: surfels as they are"},
    {"tolerance", EWA_OPTION_F64, OF_RENDER(tolerance), 0, 1e15, .initial = 1,
     .help = "splats closer in depth than so many support radii are blended as one surface"},
    {"passes", EWA_OPTION_U32, OF_RENDER(passes), .words = "1|3", .initial = 3,
     .help = "3: splats of one surface are blended; 1: the nearest splat of each pixel wins"},
    {"edge_antialiasing", EWA_OPTION_BOOL, OF_RENDER(edge_antialiasing), .initial = true,
     .help = "smooth silhouettes by coverage"},
    {"edge_threshold", EWA_OPTION_F64, OF_RENDER(edge_threshold), 0, 4, EWA_OPTION_ABOVE, .initial = 0.45,
     .help = "coverage, as a share of a covered pixel's, from which a pixel is opaque"},
    {"edge_layers", EWA_OPTION_U32, OF_RENDER(edge_layers), 1, EWA_MAX_EDGE_LAYERS,
     .initial = EWA_MAX_EDGE_LAYERS,
     .help = "surfaces that show through each other at smoothed silhouettes, the last of them all that is left; 1: "
             "the background shows through instead"},
    {"opacity", EWA_OPTION_F64, OF_RENDER(opacity), 0, 1, .initial = 1,
     .help = "of every surface, times the alpha of the colours"},
    {"layers", EWA_OPTION_U32, OF_RENDER(layers), 0, EWA_LAYERS_EXACT,
     .help = "transparent surfaces of a pixel that are composited: 1: the nearest as if it were opaque; L: "
             "the L - 1 nearest and all that lies behind as one more; 4294967295: all; 0: all when something "
             "is transparent"},
    {"cull", EWA_OPTION_CHOICE, OF_RENDER(cull), .words = "none|back",
     .help = "leave out splats that face away"},
    {"shading", EWA_OPTION_CHOICE, OF_RENDER(shading), .words = "none|lambert|phong",
     .initial = EWA_SHADING_LAMBERT,
     .help = "light: none gives the bare colours, lambert matt surfaces, phong materials with highlights"},
    {"light_count", EWA_OPTION_U32, OF_RENDER(light_count), 0, EWA_MAX_LIGHTS,
     .help = "how many lights there are; 0: a headlight"},
    {"ambient", EWA_OPTION_F64, OF_RENDER(ambient), 0, 1, .initial = 0.15,
     .help = "share of the light that comes from everywhere, where materials do not say"},
    {"material_count", EWA_OPTION_U32, OF_RENDER(material_count), 0, EWA_MAX_MATERIALS,
     .help = "how many materials there are"},
    {"environment_up", EWA_OPTION_F64, OF_RENDER(environment_up), -INFINITY, INFINITY,
     EWA_OPTION_ABOVE | EWA_OPTION_BELOW, 3, .initials = (const double[]){0, 1, 0},
     .help = "direction in the world of the surroundings' upper edge"},
    {"eye_dome", EWA_OPTION_F64, OF_RENDER(eye_dome), 0, 100,
     .help = "eye-dome lighting: darken what lies behind its surroundings; 0: none, 1: strong"},
    {"background", EWA_OPTION_F32, OF_RENDER(background), 0, 1e15, .count = 4,
     .help = "linear light, straight alpha, which is at most 1"},
    {"section_count", EWA_OPTION_U32, OF_RENDER(section_count), 0, EWA_MAX_SECTION_PLANES,
     .help = "how many section planes there are"},
    {"level", EWA_OPTION_U32, OF_RENDER(level), 0, EWA_MAX_LEVELS - 1,
     .help = "level of detail, if the surfels have levels; 0: all surfels"},
    {"budget_s", EWA_OPTION_F64, OF_RENDER(budget_s), 0, 1e15, .unit = "s",
     .help = "time for a frame: of the levels of detail from `level` on, the finest that is expected to be "
             "drawn in that time; 0: `level`"},
    {"supersampling", EWA_OPTION_U32, OF_RENDER(supersampling), 0, EWA_MAX_SUPERSAMPLING,
     .help = "draws every pixel as so many by so many parts, and their average; 0: as it is where surfels are as large as "
             "pixels, and 2, 4 or 8 for what is far, where a pixel holds many small things"},
};

const ewa_option_table ewa_render_options_table = EWA_OPTION_TABLE(ewa_render_options, render_rows);

ewa_status ewa_option_check_lights(ewa_context *context, const ewa_light *lights, uint32_t light_count) {
    static const double MAXIMUM = 1e6;
    for (uint32_t i = 0; i < light_count; i++) {
        const double *direction = lights[i].direction_world;
        if (!isfinite(direction[0]) || !isfinite(direction[1]) || !isfinite(direction[2]))
            return ewa_fail(context, EWA_ERROR_ARGUMENT,
                            "options: lights[%u].direction_world is %g, %g, %g: not finite", i, direction[0],
                            direction[1], direction[2]);
        for (int c = 0; c < 3; c++)
            if (!(lights[i].color[c] >= 0 && (double)lights[i].color[c] <= MAXIMUM))
                return ewa_fail(context, EWA_ERROR_ARGUMENT,
                                "options: lights[%u].color[%d] is %g, allowed is [0, %g]", i, c,
                                (double)lights[i].color[c], MAXIMUM);
    }
    return EWA_OK;
}

ewa_status ewa_option_check_background(ewa_context *context, const float background[4]) {
    if (background[3] <= 1) return EWA_OK;
    return ewa_fail(context, EWA_ERROR_ARGUMENT, "options: background[3] is %g, allowed is [0, 1]",
                    (double)background[3]);
}

static ewa_status check_materials(ewa_context *context, const ewa_render_options *options) {
    if (!options->materials != !options->material_count)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "options: material_count is %u %s materials",
                        options->material_count, options->materials ? "with" : "without");
    for (uint32_t i = 0; i < options->material_count; i++)
        EWA_TRY(ewa_material_check(context, "options", i, &options->materials[i]));
    return EWA_OK;
}

ewa_status ewa_option_check_sections(ewa_context *context, const double planes[][4], uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        const double *p = planes[i];
        const char *wrong = p[0] == 0 && p[1] == 0 && p[2] == 0 ? "no normal" : NULL;
        for (int k = 0; k < 4; k++)
            if (!isfinite(p[k])) wrong = "not finite";
        if (wrong)
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "options: section_planes[%u] is %g, %g, %g, %g: %s",
                            i, p[0], p[1], p[2], p[3], wrong);
    }
    return EWA_OK;
}

static ewa_status check_together(ewa_context *context, const ewa_render_options *options) {
    EWA_TRY(ewa_option_check_lights(context, options->lights, options->light_count));
    EWA_TRY(check_materials(context, options));
    EWA_TRY(ewa_option_check_background(context, options->background));
    EWA_TRY(ewa_option_check_sections(context, (const double(*)[4])options->section_planes,
                                      options->section_count));
    const double *up = options->environment_up;
    if (up[0] == 0 && up[1] == 0 && up[2] == 0)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "options: environment_up is 0, 0, 0: no direction");
    return EWA_OK;
}

void ewa_surfels_options_init(ewa_surfels_options *options, size_t struct_size) {
    ewa_options_init(&ewa_surfels_options_table, options, struct_size);
}

void ewa_render_options_init(ewa_render_options *options, size_t struct_size) {
    ewa_options_init(&ewa_render_options_table, options, struct_size);
}

ewa_status ewa_surfels_options_choose(ewa_context *context, const ewa_surfels_options *given,
                                      ewa_surfels_options *chosen) {
    ewa_surfels_options_init(chosen, sizeof *chosen);
    return ewa_options_take(context, &ewa_surfels_options_table, given, chosen);
}

ewa_status ewa_render_options_choose(ewa_context *context, const ewa_render_options *given,
                                     ewa_render_options *chosen) {
    ewa_render_options_init(chosen, sizeof *chosen);
    ewa_status status = ewa_options_take(context, &ewa_render_options_table, given, chosen);
    if (status == EWA_OK) status = check_together(context, chosen);
    if (chosen->point_size_px > 0) {
        // The disc's own rim is the filter.
        chosen->prefilter_px = 0;
        chosen->kernel = EWA_KERNEL_PERSPECTIVE;
        chosen->cull = EWA_CULL_NONE;
        if (chosen->supersampling == 0) chosen->supersampling = 1;
    }
    if (status == EWA_OK && chosen->eye_dome > 0 && chosen->supersampling > 1)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED,
                        "options: supersampling is %u, must be 0 or 1 with eye-dome lighting",
                        chosen->supersampling);
    if (chosen->eye_dome > 0) chosen->supersampling = 1;
    return status;
}
