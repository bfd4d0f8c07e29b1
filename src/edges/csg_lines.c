// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sets of clip lines in the plane of a disc.
#include "edges/csg_lines.h"

#include <math.h>

/// Pieces whose centre is farther than this beyond a line, in standard deviations, add next to nothing.
#define BEYOND 1.8

ewa_disc_share ewa_line_share(ewa_vec3 line, double cutoff) {
    const double reach = cutoff * sqrt(line.x * line.x + line.y * line.y);
    return line.z >= reach ? EWA_DISC_ALL : line.z <= -reach ? EWA_DISC_NONE : EWA_DISC_PART;
}

ewa_disc_share ewa_lines_prune(ewa_line_set *lines, double cutoff) {
    ewa_line_set kept = {.either = lines->either};
    const ewa_disc_share decides = lines->either ? EWA_DISC_ALL : EWA_DISC_NONE;
    for (uint32_t k = 0; k < lines->count; k++) {
        const ewa_disc_share share = ewa_line_share(lines->line[k], cutoff);
        if (share == decides) return decides;
        if (share == EWA_DISC_PART) kept.line[kept.count++] = lines->line[k];
    }
    const ewa_disc_share rest = lines->either && lines->count ? EWA_DISC_NONE : EWA_DISC_ALL;
    kept.either = kept.either && kept.count == 2;
    *lines = kept;
    return kept.count ? EWA_DISC_PART : rest;
}

double ewa_line_depth(ewa_vec3 line) { return line.z / sqrt(line.x * line.x + line.y * line.y); }

bool ewa_lines_beyond(const ewa_line_set *lines) {
    uint32_t beyond = 0;
    for (uint32_t k = 0; k < lines->count; k++) beyond += ewa_line_depth(lines->line[k]) < -BEYOND;
    return beyond > 0 && (!lines->either || beyond == lines->count);
}

/// Largest depth that a place of the disc has in both of two half-planes: at the far end of either's normal,
/// or where both are as deep and the disc ends.
static double common_depth(ewa_vec3 a, ewa_vec3 b, double cutoff) {
    const double slope_a = sqrt(a.x * a.x + a.y * a.y), slope_b = sqrt(b.x * b.x + b.y * b.y);
    const double n[2][3] = {{a.x / slope_a, a.y / slope_a, a.z / slope_a},
                            {b.x / slope_b, b.y / slope_b, b.z / slope_b}};
    double best = -INFINITY;
    for (int k = 0; k < 2; k++) {
        const double own = cutoff + n[k][2];
        const double other = cutoff * (n[0][0] * n[1][0] + n[0][1] * n[1][1]) + n[1 - k][2];
        best = fmax(best, fmin(own, other));
    }
    const double du = n[0][0] - n[1][0], dv = n[0][1] - n[1][1], d2 = du * du + dv * dv;
    const double share = d2 > 0 ? (n[1][2] - n[0][2]) / d2 : INFINITY;
    const double rest = cutoff * cutoff - share * share * d2;
    if (!(rest > 0)) return best;
    const double along = fabs(n[0][1] * du - n[0][0] * dv) * sqrt(rest / d2);
    return fmax(best, share * (n[0][0] * du + n[0][1] * dv) + along + n[0][2]);
}

bool ewa_lines_exclude(const ewa_line_set *a, const ewa_line_set *b, double cutoff) {
    if (a->count == 0 || b->count == 0) return false;
    const double nothing = 0.02; // standard deviations
    bool disjoint[2][2];
    for (uint32_t i = 0; i < a->count; i++)
        for (uint32_t k = 0; k < b->count; k++)
            disjoint[i][k] = common_depth(a->line[i], b->line[k], cutoff) < nothing;
    for (uint32_t i = 0; i < (a->either ? a->count : 1); i++)
        for (uint32_t k = 0; k < (b->either ? b->count : 1); k++) {
            bool parted = false;
            for (uint32_t m = a->either ? i : 0; m < (a->either ? i + 1 : a->count); m++)
                for (uint32_t n = b->either ? k : 0; n < (b->either ? k + 1 : b->count); n++)
                    parted |= disjoint[m][n];
            if (!parted) return false;
        }
    return true;
}

bool ewa_lines_join(const ewa_line_set *a, const ewa_line_set *b, ewa_line_set *joined) {
    if (a->count == 0 || b->count == 0) {
        *joined = a->count ? *a : *b;
        return true;
    }
    const ewa_line_set *sets[2] = {a, b};
    ewa_vec3 all[4];
    uint32_t count = 0;
    for (int s = 0; s < 2; s++) {
        const ewa_line_set *set = sets[s];
        const uint32_t less = set->either && ewa_line_depth(set->line[1]) > ewa_line_depth(set->line[0]);
        if (set->either)
            all[count++] = set->line[less];
        else
            for (uint32_t k = 0; k < set->count; k++) all[count++] = set->line[k];
    }
    const bool complete = a->count + b->count == 2;
    for (uint32_t i = 0; i < 2; i++)
        for (uint32_t k = i + 1; k < count; k++)
            if (ewa_line_depth(all[k]) < ewa_line_depth(all[i])) {
                const ewa_vec3 swapped = all[i];
                all[i] = all[k];
                all[k] = swapped;
            }
    *joined = (ewa_line_set){.line = {all[0], all[1]}, .count = 2};
    return complete;
}
