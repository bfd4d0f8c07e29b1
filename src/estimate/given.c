// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Whether normals that a file gives are those of the surface that its points lie on.
#include "estimate/given.h"
#include "base/base.h"

#include <stdio.h>

enum { LEAST_SEEN = 100, MOST_OFF_PERCENT = 10 };

/// Squared cosine of 60 degrees, and the share of the variance along the normal up to which a neighbourhood is a plain surface.
static const double OFF_COSINE2 = 0.25;
static const float PLAIN = 0.01f;

uint32_t ewa_given_lane(const ewa_block *block) {
    // Knuth's multiplier: what is regular in the order of places must not decide.
    return (block->first_place * 2654435761u >> 16) % block->lane_count;
}

void ewa_given_look(const ewa_attribute *normal, uint32_t point, const local_surface *surface, uint32_t lane, given_count *count) {
    if (!(surface->variation[lane] < PLAIN) || (surface->thin | surface->degenerate) >> lane & 1) return;
    double n[3], along = 0, length2 = 0;
    ewa_attribute_read_f64(normal, point, 1, n);
    for (int c = 0; c < 3; c++) along += n[c] * (double)surface->normal[c][lane], length2 += n[c] * n[c];
    if (!(length2 > 0)) return;
    count->seen++;
    count->off += along * along < OFF_COSINE2 * length2;
}

ewa_status ewa_given_note(ewa_cloud *cloud, const given_count *count) {
    const uint64_t percent = count->seen ? (uint64_t)100 * count->off / count->seen : 0;
    if (count->seen < LEAST_SEEN || percent < MOST_OFF_PERCENT) return EWA_OK;
    char text[16];
    const int length = snprintf(text, sizeof text, "%u", (unsigned)percent);
    return ewa_cloud_set_note(cloud, EWA_NORMALS_OFF_NOTE, text, (size_t)length);
}
