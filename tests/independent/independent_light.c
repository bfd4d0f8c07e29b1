// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Shading and eye-dome lighting, in the order of semantics.h.
#include "tests/independent/independent.h"

#include <math.h>

static const real EYE_DOME_GAIN = 300;

static real positive(real value) { return value > 0 ? value : 0; }

real3 independent_shade(const independent_scene *scene, const independent_surface *at,
                        const independent_surface *beside, const independent_surface *below) {
    const ewa_render_options *options = &scene->options;
    if (options->shading == EWA_SHADING_NONE) return at->color;
    const real ambient = at->material[0], diffuse = at->material[1], specular = at->material[2];
    real3 diffuse_light = {ambient, ambient, ambient}, highlight = {0, 0, 0};
    const uint32_t count = options->light_count ? options->light_count : 1;
    for (uint32_t i = 0; i < count; i++) {
        real3 toward = at->eye, color = {1, 1, 1};
        if (options->light_count) {
            const ewa_light *light = &options->lights[i];
            const real3 given = real3_unit(real3_of(light->direction_world));
            if (real3_length(given) > 0) toward = given;
            color = (real3){(real)light->color[0], (real)light->color[1], (real)light->color[2]};
        }
        const real facing = real3_dot(at->normal, toward);
        if (!(facing > 0)) continue;
        diffuse_light = real3_add(diffuse_light, real3_times(color, diffuse * facing));
        const real3 half_way = real3_unit(real3_add(toward, at->eye));
        const real shine = positive(real3_dot(at->normal, half_way));
        if (options->shading == EWA_SHADING_PHONG && shine > 0)
            highlight = real3_add(highlight, real3_times(color, specular * powl(shine, at->material[3])));
    }
    if (options->shading == EWA_SHADING_PHONG && scene->sky)
        highlight =
            real3_add(highlight, real3_times(independent_reflection(scene->sky, options, at, beside, below),
                                             at->material[4]));
    return (real3){at->color.x * diffuse_light.x + highlight.x, at->color.y * diffuse_light.y + highlight.y,
                   at->color.z * diffuse_light.z + highlight.z};
}

real independent_eye_dome(const independent_scene *scene, const double *depth, int64_t x, int64_t y) {
    const int64_t width = scene->camera.width_px, height = scene->camera.height_px;
    const bool flat = scene->camera.projection == EWA_ORTHOGRAPHIC;
    const real here = (real)depth[y * width + x];
    if (isinf(here)) return 1;
    // Keys: 1/z over the pixel's own, or -z over the height of the view.
    const real unit = flat ? (real)scene->camera.height_px / (real)scene->camera.fy_px : 1 / here;
    const real key = flat ? -here : 1 / here;
    static const int directions[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    static const int radii[3] = {1, 2, 4};
    real sum = 0;
    for (int k = 0; k < 12; k++) {
        const int64_t dx = directions[k % 4][0] * radii[k / 4], dy = directions[k % 4][1] * radii[k / 4];
        real pair = 0;
        bool whole = true;
        for (int side = -1; side <= 1; side += 2) {
            const int64_t at_x = x + side * dx, at_y = y + side * dy;
            if (at_x < 0 || at_y < 0 || at_x >= width || at_y >= height) {
                whole = false;
                continue;
            }
            const real z = (real)depth[at_y * width + at_x];
            whole = whole && isfinite(z);
            pair += flat ? -z / 2 : 1 / z / 2;
        }
        if (whole) sum += positive(pair - key) / unit;
    }
    return expl(-EYE_DOME_GAIN * (real)scene->options.eye_dome * sum / 12);
}
