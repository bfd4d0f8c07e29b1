// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h and of the kernels of volumes: what lights give to sixteen places (docs/math.md
// section 7; semantics.h, shading).
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

/// For each of up to WIDE_TOGETHER sixteens; `normal` and `view` (towards the eye) are of unit length.
static ALWAYS_INLINE void gather_light_each(const ewa_kernel_light *lights, uint32_t light_count,
                                            bool highlights, const wf normal[][3], const wf view[][3],
                                            wf shininess, lane_light *sum, const int count) {
    const wf zero = wf_set(0);
    wf sight[WIDE_TOGETHER];
    for (int n = 0; n < count; n++) {
        sum[n] = (lane_light){{zero, zero, zero}, {zero, zero, zero}};
        sight[n] = dot3(normal[n], view[n]);
    }
    for (const ewa_kernel_light *from = lights; from < lights + light_count; from++) {
        wf facing[WIDE_TOGETHER], power[WIDE_TOGETHER];
        for (int n = 0; n < count; n++) {
            wf toward[3];
            for (int i = 0; i < 3; i++) toward[i] = from->headlight ? view[n][i] : wf_set(from->toward[i]);
            facing[n] = wf_max(dot3(normal[n], toward), zero);
            for (int i = 0; i < 3; i++)
                sum[n].diffuse[i] = wf_fma(wf_set(from->color[i]), facing[n], sum[n].diffuse[i]);
            power[n] = facing[n]; // the headlight's H is V
            if (highlights && !from->headlight) {
                // N.(L + V) / |L + V|, whose square is 2 + 2 L.V.
                const wf two = wf_set(2), length2 = wf_max(wf_fma(two, dot3(toward, view[n]), two), zero);
                power[n] = wf_mul(wf_add(facing[n], sight[n]), wf_inverse_root(length2));
            }
        }
        if (!highlights) continue;
        wf_power_each(power, shininess, count);
        for (int n = 0; n < count; n++) {
            // Nothing rather than less than any normal number, which would take a hundred times as long.
            const wm shows = wm_and(wf_lt(zero, facing[n]), wf_lt(wf_set(0x1p-90f), power[n]));
            const wf highlight = wf_keep(shows, power[n]);
            for (int i = 0; i < 3; i++)
                sum[n].specular[i] = wf_fma(wf_set(from->color[i]), highlight, sum[n].specular[i]);
        }
    }
}

#endif
