// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the options say about light, in the form that both renderers start from.
#include "surface/shading.h"
#include "base/base.h"

#include <string.h>

/// Unit direction of `v`, which is finite; zero when it is zero.
static ewa_vec3 direction_of(const double v[3]) {
    // By way of the largest component, so that no square overflows.
    const double largest = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    if (largest == 0) return vec3_make(0, 0, 0);
    const ewa_vec3 shorter = vec3_make(v[0] / largest, v[1] / largest, v[2] / largest);
    return vec3_scale(shorter, 1 / vec3_length(shorter));
}

/// The rotation that takes `up` to +y the shortest way; from -y around x.
static ewa_mat3 turn_up(ewa_vec3 up) {
    if (up.y < -1 + 1e-12) return (ewa_mat3){{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
    // Rodrigues around up x y = (-up.z, 0, up.x), whose length is the sine, up.y being the cosine.
    const double x = -up.z, z = up.x, k = 1 / (1 + up.y);
    return (ewa_mat3){{{up.y + x * x * k, -z, x * z * k}, {z, up.y, -x}, {x * z * k, x, up.y + z * z * k}}};
}

void ewa_shading_setup_make(const ewa_render_options *options, ewa_shading_setup *setup) {
    memset(setup, 0, sizeof *setup);
    setup->lit = options->shading != EWA_SHADING_NONE;
    setup->highlights = options->shading == EWA_SHADING_PHONG;
    ewa_light headlight;
    ewa_light_init(&headlight);
    setup->light_count = options->light_count ? options->light_count : 1;
    for (uint32_t i = 0; i < setup->light_count; i++) {
        const ewa_light *from = options->light_count ? &options->lights[i] : &headlight;
        ewa_shading_light *to = &setup->lights[i];
        to->toward_world = direction_of(from->direction_world);
        to->headlight = vec3_length(to->toward_world) == 0;
        for (int c = 0; c < 3; c++) to->color[c] = (double)from->color[c];
    }
    if (setup->highlights && options->materials) {
        setup->has_table = true;
        setup->material_count = options->material_count;
        memcpy(setup->materials, options->materials, options->material_count * sizeof *options->materials);
    } else {
        setup->material_count = 1;
        ewa_material_init(&setup->materials[0]);
        setup->materials[0].ambient = (float)options->ambient;
        setup->materials[0].diffuse = 1 - (float)options->ambient;
    }
    setup->environment_from_world = turn_up(direction_of(options->environment_up));
}

ewa_status ewa_shading_check_materials(ewa_context *context, const ewa_shading_setup *setup,
                                       uint32_t largest) {
    if (!setup->has_table || largest < setup->material_count) return EWA_OK;
    return ewa_fail(context, EWA_ERROR_ARGUMENT,
                    "render: a surfel has material %u, the table has %u (counted from 0)", largest,
                    setup->material_count);
}
