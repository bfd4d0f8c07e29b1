// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Flat faces with sharp edges, as cubes and parts of machines have them, by how far normals turn from place to place.
#include "estimate/sharp.h"

#include <math.h>

enum { SAMPLES = 1 << 14, MIN_SAMPLES = 256 }; // places that are looked at

/// Cosines of turns from a place to one beside it that make it flat and sharp: noise of a hundredth of the spacing turns
/// normals by more than the first, and a fitted plane on an edge of a cube by 45 degrees.
static const double FLAT = 0.99995, SHARP = 0.87;

/// Shares of the places that are flat and sharp at least, and on no surface at most. Of a cube of 1,000 points a fifth is flat,
/// of one of 1 M points two in a hundred are on an edge; of surveys and of scans with several depths a tenth is on no surface.
static const double FLAT_SHARE = 0.15, SHARP_SHARE = 0.005, STREWN_SHARE = 0.02;

/// Places that are neither flat nor sharp, at most, for each sharp one: 1 of cubes, 8 of a part of 1 M points with round holes, 50 of a
/// landscape whose ridges are sharp, which has no faces.
static const double BENT_SHARE = 16;

bool ewa_sharp_find(uint32_t place_count, const curvature_input *input, const uint8_t *strewn) {
    const uint32_t step = place_count / SAMPLES + 1;
    uint32_t looked = 0, flat = 0, sharp = 0, off = 0;
    for (uint32_t place = 0; place < place_count; place += step, looked++) {
        double min_cosine = 1;
        for (int i = 0; i < LOCAL_GRAPH_DEGREE; i++) {
            if (input->links[place][i] == UINT32_MAX) continue;
            const float *own = input->normals + 3 * (size_t)place, *next = input->normals + 3 * (size_t)input->links[place][i];
            double cosine = 0;
            for (int c = 0; c < 3; c++) cosine += (double)own[c] * (double)next[c];
            min_cosine = fmin(min_cosine, fabs(cosine));
        }
        flat += min_cosine > FLAT;
        sharp += min_cosine < SHARP;
        off += strewn && strewn[place] > UINT8_MAX / 2;
    }
    return looked >= MIN_SAMPLES && flat >= FLAT_SHARE * looked && sharp >= SHARP_SHARE * looked && off <= STREWN_SHARE * looked &&
           looked - flat - sharp <= BENT_SHARE * sharp;
}
