// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of road_body.h and of the kernels of volumes: what lights give to sixteen places (docs/math.md section
// 7; semantics.h, shading).
//
// Based on: J. Blinn, "Models of Light Reflection for Computer Synthesized Pictures", 1977 (the highlight).
#ifndef EWA_SRC_WIDE_SHINE_H
#define EWA_SRC_WIDE_SHINE_H

#include "wide/lights.h"
#include "wide/wide_functions.h"

/// Sums over all lights: of the cosine to the normal, and of the highlights.
typedef struct lane_light {
    wf diffuse[3], specular[3];
} lane_light;

static inline wf dot3(const wf a[3], const wf b[3]) {
    return wf_fma(a[0], b[0], wf_fma(a[1], b[1], wf_mul(a[2], b[2])));
}

/// `normal` and `view` (towards the eye) are of unit length.
static ALWAYS_INLINE lane_light gather_light(const ewa_kernel_light *lights, uint32_t count, bool highlights,
                                             const wf normal[3], const wf view[3], wf shininess) {
    const wf zero = wf_set(0);
    lane_light sum = {{zero, zero, zero}, {zero, zero, zero}};
    const wf sight = dot3(normal, view);
    for (const ewa_kernel_light *from = lights; from < lights + count; from++) {
        wf toward[3];
        for (int i = 0; i < 3; i++) toward[i] = from->headlight ? view[i] : wf_set(from->toward[i]);
        const wf facing = wf_max(dot3(normal, toward), zero);
        for (int i = 0; i < 3; i++) sum.diffuse[i] = wf_fma(wf_set(from->color[i]), facing, sum.diffuse[i]);
        if (!highlights) continue;
        wf cosine = facing; // the headlight's H is V
        if (!from->headlight) {
            // N.(L + V) / |L + V|, whose square is 2 + 2 L.V.
            const wf two = wf_set(2), length2 = wf_max(wf_fma(two, dot3(toward, view), two), zero);
            cosine = wf_mul(wf_add(facing, sight), wf_inverse_root(length2));
        }
        // Nothing rather than less than any normal number, which would take a hundred times as long.
        const wf power = wf_power(cosine, shininess);
        const wf highlight = wf_keep(wm_and(wf_lt(zero, facing), wf_lt(wf_set(0x1p-90f), power)), power);
        for (int i = 0; i < 3; i++)
            sum.specular[i] = wf_fma(wf_set(from->color[i]), highlight, sum.specular[i]);
    }
    return sum;
}

#endif
