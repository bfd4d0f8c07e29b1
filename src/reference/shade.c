// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Shading in double precision, one pixel after another (docs/math.md section 7).
//
// Based on: M. Zwicker, H. Pfister, J. van Baar, M. Gross, "Surface Splatting", 2001, section 4 (shading of
// filtered attributes); J. Blinn, "Models of Light Reflection for Computer Synthesized Pictures", 1977; C.
// Boucheny, "Interactive Scientific Visualization of Large Datasets: Towards a Perceptive-Based Approach",
// 2009 (eye-dome lighting; here by pairs of opposite pixels, which leaves planes alone).
#include "reference/shade.h"
#include "image/environment.h"
#include "surface/semantics.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

ewa_reference_surface ewa_reference_surface_of(const ewa_reference_view *view, const ewa_reference_sums *sums,
                                               double x_px, double y_px) {
    if (!(sums->weight > 0)) return (ewa_reference_surface){.there = false};
    const double inverse = 1 / sums->weight;
    const double length = fmax(vec3_length(sums->normal_world), EWA_SHADED_NORMAL * sums->weight);
    ewa_reference_surface surface = {.there = true,
                                     .color = vec3_scale(sums->color, sums->opacity > 0 ? 1 / sums->opacity : 0),
                                     .normal_world = vec3_scale(sums->normal_world, 1 / length),
                                     .ambient = sums->material[0] * inverse,
                                     .diffuse = sums->material[1] * inverse,
                                     .specular = sums->material[2] * inverse,
                                     .shininess = sums->material[3] * inverse,
                                     .reflection = sums->material[4] * inverse};
    // From the surface to the eye, back to world space: -d A, A being a rotation but for its scale.
    const ewa_vec3 d = ewa_reference_ray(view, x_px, y_px);
    const ewa_vec3 toward_eye = vec3_scale(vec3_mul_mat3(d, &view->placement.linear), -1);
    surface.view_world = vec3_scale(toward_eye, 1 / vec3_length(toward_eye));
    return surface;
}

/// Adds `light` times the surface's answer to it.
static void add_light(const ewa_shading_setup *setup, const ewa_shading_light *light,
                      const ewa_reference_surface *at, ewa_vec3 *color) {
    const ewa_vec3 L = light->headlight ? at->view_world : light->toward_world;
    const double facing = vec3_dot(at->normal_world, L);
    if (facing <= 0) return;
    double highlight = 0;
    if (setup->highlights) {
        const ewa_vec3 between = vec3_add(L, at->view_world);
        const double length = vec3_length(between);
        if (length > 0) highlight = pow(fmax(0, vec3_dot(at->normal_world, between) / length), at->shininess);
    }
    color->x += light->color[0] * (at->color.x * at->diffuse * facing + at->specular * highlight);
    color->y += light->color[1] * (at->color.y * at->diffuse * facing + at->specular * highlight);
    color->z += light->color[2] * (at->color.z * at->diffuse * facing + at->specular * highlight);
}

/// The environment's direction that a surface mirrors to the eye.
static ewa_vec3 mirrored(const ewa_shading_setup *setup, const ewa_reference_surface *at) {
    const double twice = 2 * vec3_dot(at->normal_world, at->view_world);
    const ewa_vec3 R = vec3_sub(vec3_scale(at->normal_world, twice), at->view_world);
    return mat3_mul_vec3(&setup->environment_from_world, R);
}

/// A level at (u, v), between its four nearest texels.
static ewa_vec3 sample_level(const ewa_environment_level *level, double u, double v) {
    const double x = u * level->width - 0.5, y = v * level->height - 0.5;
    ewa_vec3 sum = vec3_make(0, 0, 0);
    for (int row = 0; row < 2; row++)
        for (int column = 0; column < 2; column++) {
            int64_t texel_x = (int64_t)floor(x) + column, texel_y = (int64_t)floor(y) + row;
            const double share = (1 - fabs(x - (double)texel_x)) * (1 - fabs(y - (double)texel_y));
            if (texel_y < 0 || texel_y >= level->height) {
                texel_y = texel_y < 0 ? 0 : level->height - 1;
                texel_x += level->width / 2; // over the pole
            }
            texel_x = (texel_x + level->width) % level->width;
            const float *texel = level->texels + 3 * ((size_t)texel_y * level->width + (size_t)texel_x);
            const ewa_vec3 light = vec3_make((double)texel[0], (double)texel[1], (double)texel[2]);
            sum = vec3_add(sum, vec3_scale(light, share));
        }
    return sum;
}

ewa_vec3 ewa_reference_environment(const ewa_environment *environment, ewa_vec3 direction, double footprint) {
    const double u = 0.5 - atan2(direction.x, direction.z) / (2 * PI);
    const double v = 0.5 - atan2(direction.y, hypot(direction.x, direction.z)) / PI;
    const double texels = footprint * environment->levels[0].height / PI;
    const double last = environment->level_count - 1.0;
    const double level = texels > 1 ? fmin(log2(texels), last) : 0, fine = floor(level);
    ewa_vec3 light = sample_level(&environment->levels[(uint32_t)fine], u, v);
    if (level > fine) {
        const ewa_vec3 coarser = sample_level(&environment->levels[(uint32_t)fine + 1], u, v);
        light = vec3_add(vec3_scale(light, fine + 1 - level), vec3_scale(coarser, level - fine));
    }
    return light;
}

ewa_vec3 ewa_reference_shade(const ewa_shading_setup *setup, const ewa_environment *environment,
                             const ewa_reference_surface *at, const ewa_reference_surface *beside,
                             const ewa_reference_surface *below) {
    if (!setup->lit) return at->color;
    ewa_vec3 color = vec3_scale(at->color, at->ambient);
    for (uint32_t i = 0; i < setup->light_count; i++) add_light(setup, &setup->lights[i], at, &color);
    if (setup->highlights && environment && at->reflection > 0) {
        const ewa_vec3 direction = mirrored(setup, at);
        double footprint = 0;
        if (beside->there) footprint = vec3_length(vec3_sub(direction, mirrored(setup, beside)));
        if (below->there)
            footprint = fmax(footprint, vec3_length(vec3_sub(direction, mirrored(setup, below))));
        const ewa_vec3 light = ewa_reference_environment(environment, direction, footprint);
        color = vec3_add(color, vec3_scale(light, at->reflection));
    }
    return color;
}

/// The key of a pixel: 1/z, orthographic -z; NaN where there is nothing.
static double key_at(const ewa_reference_depths *depths, int64_t x, int64_t y) {
    if (x < 0 || y < 0 || x >= depths->width_px || y >= depths->height_px) return NAN;
    const double z = depths->depth(depths->data, (size_t)y * depths->width_px + (size_t)x);
    return isinf(z) ? NAN : depths->orthographic ? -z : 1 / z;
}

double ewa_reference_eye_dome(const ewa_reference_depths *depths, double strength, uint32_t x, uint32_t y) {
    const double key = key_at(depths, x, y);
    if (isnan(key)) return 1;
    const double unit = depths->orthographic ? depths->view_height_world : key;
    double sum = 0;
    for (int r = 1; r <= 4; r *= 2) {
        const int steps[4][2] = {{r, 0}, {0, r}, {r, r}, {r, -r}};
        for (int i = 0; i < 4; i++) {
            const int dx = steps[i][0], dy = steps[i][1];
            const double between = (key_at(depths, x + (int64_t)dx, y + (int64_t)dy) +
                                    key_at(depths, x - (int64_t)dx, y - (int64_t)dy)) /
                                   2;
            sum += fmax(0, (between - key) / unit); // 0 for NaN
        }
    }
    return exp(-EWA_EYE_DOME_GAIN * strength * sum / EWA_EYE_DOME_PAIRS);
}
