// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Defaults and checks of surfels' and pictures' options.
#include "splat/options.h"
#include "base/base.h"
#include "image/material.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double HUGE_OPTION = 1e15;

ewa_status ewa_option_check_range(ewa_context *context, const char *member, double value, double low,
                                  bool open, double high) {
    if (value <= high && (open ? value > low : value >= low)) return EWA_OK;
    return ewa_fail(context, EWA_ERROR_ARGUMENT, "options: %s is %g, allowed is %c%g, %g]", member, value,
                    open ? '(' : '[', low, high);
}

ewa_status ewa_option_check_choice(ewa_context *context, const char *member, int value, int last) {
    if (value >= 0 && value <= last) return EWA_OK;
    return ewa_fail(context, EWA_ERROR_ARGUMENT, "options: %s is %d, allowed is 0 to %d", member, value,
                    last);
}

ewa_status ewa_option_check_size(ewa_context *context, const char *type, size_t given, size_t wanted) {
    if (given == wanted) return EWA_OK;
    return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: struct_size is %zu, not %zu (not initialised?)", type,
                    given, wanted);
}

static ewa_status check_surfels(ewa_context *context, const ewa_surfels_options *options) {
    ewa_status status = ewa_option_check_range(context, "cutoff", options->cutoff, 0, true, 4);
    if (status == EWA_OK)
        status = ewa_option_check_range(context, "radius_scale", options->radius_scale, 0, true, HUGE_OPTION);
    return status;
}

static bool is_finite(const double v[3]) { return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]); }

ewa_status ewa_option_check_lights(ewa_context *context, const ewa_light *lights, uint32_t light_count) {
    static const double MOST = 1e6;
    ewa_status status = ewa_option_check_range(context, "light_count", light_count, 0, false, EWA_MAX_LIGHTS);
    for (uint32_t i = 0; status == EWA_OK && i < light_count; i++) {
        const ewa_light *light = &lights[i];
        const double *direction = light->direction_world;
        if (!is_finite(direction))
            status = ewa_fail(context, EWA_ERROR_ARGUMENT,
                              "options: lights[%u].direction_world is %g, %g, %g: not finite", i,
                              direction[0], direction[1], direction[2]);
        char member[32];
        for (int c = 0; c < 3 && status == EWA_OK; c++) {
            snprintf(member, sizeof member, "lights[%u].color[%d]", i, c);
            status = ewa_option_check_range(context, member, (double)light->color[c], 0, false, MOST);
        }
    }
    return status;
}

static ewa_status check_materials(ewa_context *context, const ewa_render_options *options) {
    if (!options->materials != !options->material_count)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "options: material_count is %u %s materials",
                        options->material_count, options->materials ? "with" : "without");
    ewa_status status = ewa_option_check_range(context, "material_count", options->material_count, 0, false,
                                               EWA_MAX_MATERIALS);
    for (uint32_t i = 0; status == EWA_OK && i < options->material_count; i++)
        status = ewa_material_check(context, "options", i, &options->materials[i]);
    return status;
}

static ewa_status check_shading(ewa_context *context, const ewa_render_options *options) {
    ewa_status status = ewa_option_check_choice(context, "shading", (int)options->shading, EWA_SHADING_PHONG);
    if (status == EWA_OK) status = ewa_option_check_lights(context, options->lights, options->light_count);
    if (status == EWA_OK) status = ewa_option_check_range(context, "ambient", options->ambient, 0, false, 1);
    if (status == EWA_OK) status = check_materials(context, options);
    if (status == EWA_OK)
        status = ewa_option_check_range(context, "eye_dome", options->eye_dome, 0, false, 100);
    const double *up = options->environment_up;
    if (status == EWA_OK && (!is_finite(up) || (up[0] == 0 && up[1] == 0 && up[2] == 0)))
        status = ewa_fail(context, EWA_ERROR_ARGUMENT,
                          "options: environment_up is %g, %g, %g: not finite, or no direction", up[0], up[1],
                          up[2]);
    return status;
}

ewa_status ewa_option_check_background(ewa_context *context, const float background[4]) {
    static const char *const names[] = {"background[0]", "background[1]", "background[2]", "background[3]"};
    ewa_status status = EWA_OK;
    for (int c = 0; c < 4 && status == EWA_OK; c++)
        status = ewa_option_check_range(context, names[c], (double)background[c], 0, false,
                                        c < 3 ? HUGE_OPTION : 1);
    return status;
}

static ewa_status check_render(ewa_context *context, const ewa_render_options *options) {
    if (options->passes != 1 && options->passes != 3)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "options: passes is %u, allowed are 1 and 3",
                        options->passes);
    ewa_status status = ewa_option_check_choice(context, "kernel", (int)options->kernel, EWA_KERNEL_RAYCAST);
    if (status == EWA_OK)
        status = ewa_option_check_choice(context, "cull", (int)options->cull, EWA_CULL_BACK);
    if (status == EWA_OK)
        status = ewa_option_check_range(context, "prefilter_px", options->prefilter_px, 0, false, 4);
    if (status == EWA_OK && options->point_size_px != 0)
        status = ewa_option_check_range(context, "point_size_px", options->point_size_px, 1, false, 256);
    if (status == EWA_OK)
        status = ewa_option_check_range(context, "tolerance", options->tolerance, 0, false, HUGE_OPTION);
    if (status == EWA_OK)
        status =
            ewa_option_check_range(context, "edge_threshold", options->edge_threshold, 0, true, HUGE_OPTION);
    if (status == EWA_OK)
        status = ewa_option_check_range(context, "edge_layers", options->edge_layers, 1, false,
                                        EWA_MAX_EDGE_LAYERS);
    if (status == EWA_OK) status = ewa_option_check_range(context, "opacity", options->opacity, 0, false, 1);
    if (status == EWA_OK) status = check_shading(context, options);
    if (status == EWA_OK) status = ewa_option_check_background(context, options->background);
    return status;
}

ewa_status ewa_surfels_options_choose(ewa_context *context, const ewa_surfels_options *given,
                                      ewa_surfels_options *chosen) {
    ewa_surfels_options_init(chosen, sizeof *chosen);
    if (!given) return EWA_OK;
    ewa_status status =
        ewa_option_check_size(context, "ewa_surfels_options", given->struct_size, sizeof *chosen);
    if (status == EWA_OK) status = check_surfels(context, given);
    if (status == EWA_OK) *chosen = *given;
    return status;
}

ewa_status ewa_render_options_choose(ewa_context *context, const ewa_render_options *given,
                                     ewa_render_options *chosen) {
    ewa_render_options_init(chosen, sizeof *chosen);
    if (!given) return EWA_OK;
    ewa_status status =
        ewa_option_check_size(context, "ewa_render_options", given->struct_size, sizeof *chosen);
    if (status == EWA_OK) status = check_render(context, given);
    if (status == EWA_OK) *chosen = *given;
    if (chosen->point_size_px > 0) {
        // The disc's own rim is the filter.
        chosen->prefilter_px = 0;
        chosen->kernel = EWA_KERNEL_PERSPECTIVE;
        chosen->cull = EWA_CULL_NONE;
    }
    return status;
}

void ewa_surfels_options_init(ewa_surfels_options *options, size_t struct_size) {
    if (!options || struct_size < sizeof *options) return;
    memset(options, 0, struct_size);
    options->struct_size = struct_size;
    options->cutoff = 3;
    options->radius_scale = 1;
}

void ewa_render_options_init(ewa_render_options *options, size_t struct_size) {
    if (!options || struct_size < sizeof *options) return;
    memset(options, 0, struct_size);
    options->struct_size = struct_size;
    options->kernel = EWA_KERNEL_PERSPECTIVE;
    options->prefilter_px = 0.35;
    options->tolerance = 1;
    options->passes = 3;
    options->edge_antialiasing = true;
    options->edge_threshold = 0.45;
    options->edge_layers = EWA_MAX_EDGE_LAYERS;
    options->opacity = 1;
    options->cull = EWA_CULL_NONE;
    options->shading = EWA_SHADING_LAMBERT;
    options->ambient = 0.15;
    options->environment_up[1] = 1;
}
