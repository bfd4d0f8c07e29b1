// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What is in a lane of a packet. Harmonics beyond degree 0 become integers of 16 bits, each Gaussian's in a unit of its own: within
// 1/65534 of its largest coefficient.
#include "volume/splat_packets.h"

#include <math.h>

static void set_harmonics(const ewa_splats *splats, const float *from, size_t packet, size_t lane) {
    ewa_splat_packet *to = &splats->packets[packet];
    for (int c = 0; c < 3; c++) (*to)[EWA_SPLAT_COLOR + c][lane] = from[c];
    double largest = 0;
    for (uint32_t i = 0; i < splats->harmonic_count; i++) largest = fmax(largest, fabs((double)from[3 + i]));
    (*to)[EWA_SPLAT_HARMONIC_UNIT][lane] = (float)(largest / 32767);
    for (uint32_t i = 0; i < splats->harmonic_count; i++) {
        const double share = largest > 0 ? (double)from[3 + i] / largest : 0;
        splats->harmonics[packet * splats->harmonic_count + i][lane] = (int16_t)floor(32767 * share + 0.5);
    }
}

void ewa_splats_set(ewa_splats *splats, const ewa_gaussians *set, size_t number, size_t packet, size_t lane) {
    const float *center = set->centers + 3 * number, *scales = set->scales + 3 * number;
    const double unit = splats->unit_world;
    ewa_splat_packet *to = &splats->packets[packet];
    const double longest = fmax(fmax((double)scales[0], (double)scales[1]), (double)scales[2]);
    for (int i = 0; i < 3; i++) {
        (*to)[EWA_SPLAT_PLACE + i][lane] = (float)((double)center[i] / unit);
        (*to)[EWA_SPLAT_SCALE + i][lane] =
            (float)(fmax((double)scales[i], EWA_SPLAT_MIN_ASPECT * longest) / unit);
    }
    for (int i = 0; i < 4; i++) (*to)[EWA_SPLAT_ROTATION + i][lane] = set->rotations[4 * number + (size_t)i];
    (*to)[EWA_SPLAT_OPACITY][lane] = set->opacities[number] < 1 ? set->opacities[number] : 1;
    if (splats->classes) splats->classes[packet][lane] = set->classes[number];
    set_harmonics(splats, set->harmonics + 3 * (size_t)(set->sh_degree + 1) * (set->sh_degree + 1) * number, packet, lane);
}
