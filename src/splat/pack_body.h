// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The packing kernels over the wide type: the file that includes it defines which one that is, and
// PACK_KERNELS, the name of the table.
//
// Octahedral normals: Meyer et al., "On Floating-Point Normal Vectors", 2010.
#include "math/wide.h"
#include "splat/pack.h"

enum { LANES = EWA_PACKET_LANES };

/// Single precision of centre, radius, axis and sine, rounded to the safe side.
static const float SLACK = 16 * 0x1p-24f;

static uint64_t survey(const ewa_safe_range *range, const float *position, const float *normal,
                       const float *radius, uint64_t group_count, float low[EWA_BOX_FLOATS],
                       float high[EWA_BOX_FLOATS]) {
    const wf position_most = wf_set(range->position_most), finite_most = wf_set(0x1.fffffep127f);
    const wf radius_least = wf_set(range->radius_least), radius_most = wf_set(range->radius_most);
    wf lows[3], highs[3];
    for (int c = 0; c < 3; c++) lows[c] = wf_load(low + c * LANES), highs[c] = wf_load(high + c * LANES);
    uint64_t group = 0;
    for (; group < group_count; group++) {
        const wf r = wf_load(radius + group * LANES);
        wm good = wm_and(wf_le(radius_least, r), wf_le(r, radius_most));
        wf at[3];
        uint64_t zeros = 0; // of all numbers of the normals
        for (int c = 0; c < 3; c++) {
            at[c] = wf_load(position + group * EWA_BOX_FLOATS + c * LANES);
            const wf n = wf_abs(wf_load(normal + group * EWA_BOX_FLOATS + c * LANES));
            good = wm_and(good, wm_and(wf_le(wf_abs(at[c]), position_most), wf_le(n, finite_most)));
            zeros |= (uint64_t)wm_bits(wf_le(n, wf_set(0))) << c * LANES;
        }
        const uint64_t firsts = 0x249249249249u; // of each normal
        if (wm_bits(good) != 0xffff || (zeros & zeros >> 1 & zeros >> 2 & firsts)) break;
        for (int c = 0; c < 3; c++) lows[c] = wf_min(lows[c], at[c]), highs[c] = wf_max(highs[c], at[c]);
    }
    for (int c = 0; c < 3; c++) wf_store(low + c * LANES, lows[c]), wf_store(high + c * LANES, highs[c]);
    return group;
}

static inline wf with_sign_of(wf magnitude, wf sign) {
    return wf_select(wf_lt(sign, wf_set(0)), wf_sub(wf_set(0), magnitude), magnitude);
}

static void code_normals(const float normal[3][LANES], ewa_packet *packet) {
    wf n[3];
    for (int c = 0; c < 3; c++) n[c] = wf_load(normal[c]);
    // Tiny and huge normals keep their direction.
    const wf largest = wf_max(wf_abs(n[0]), wf_max(wf_abs(n[1]), wf_abs(n[2])));
    for (int c = 0; c < 3; c++) n[c] = wf_div(n[c], largest);
    const wf sum = wf_add(wf_add(wf_abs(n[0]), wf_abs(n[1])), wf_abs(n[2]));
    const wf u = wf_div(n[0], sum), v = wf_div(n[1], sum), one = wf_set(1);
    const wm below = wf_lt(n[2], wf_set(0));
    const wf x = wf_select(below, with_sign_of(wf_sub(one, wf_abs(v)), u), u);
    const wf y = wf_select(below, with_sign_of(wf_sub(one, wf_abs(u)), v), v);
    const wf scale = wf_set(32767), half = wf_set(0.5f);
    int32_t code_x[LANES], code_y[LANES];
    wi_store(code_x, wi_from_f(wf_add(wf_mul(x, scale), with_sign_of(half, x))));
    wi_store(code_y, wi_from_f(wf_add(wf_mul(y, scale), with_sign_of(half, y))));
    for (int i = 0; i < LANES; i++) packet->oct_x[i] = (int16_t)code_x[i];
    for (int i = 0; i < LANES; i++) packet->oct_y[i] = (int16_t)code_y[i];
}

static inline void decode_normals(const ewa_packet *packet, wf n[3]) {
    const wf unit = wf_set(1.0f / 32767.0f), zero = wf_set(0);
    const wf u = wf_mul(wf_from_i(wi_load_i16(packet->oct_x)), unit);
    const wf v = wf_mul(wf_from_i(wi_load_i16(packet->oct_y)), unit);
    const wf z = wf_sub(wf_sub(wf_set(1), wf_abs(u)), wf_abs(v));
    const wf fold = wf_max(wf_sub(zero, z), zero);
    const wf x = wf_sub(u, with_sign_of(fold, u)), y = wf_sub(v, with_sign_of(fold, v));
    const wf length = wf_sqrt(wf_fma(x, x, wf_fma(y, y, wf_mul(z, z))));
    n[0] = wf_div(x, length), n[1] = wf_div(y, length), n[2] = wf_div(z, length);
}

/// The sum, the least or the greatest number of each row: lane k of the result is that of rows[k].
static inline wf sum_rows(wf rows[LANES]) {
    w_transpose(rows);
    wf sum = rows[0];
    for (int i = 1; i < LANES; i++) sum = wf_add(sum, rows[i]);
    return sum;
}

static inline wf least_of_rows(wf rows[LANES]) {
    w_transpose(rows);
    wf least = rows[0];
    for (int i = 1; i < LANES; i++) least = wf_min(least, rows[i]);
    return least;
}

static inline wf greatest_of_rows(wf rows[LANES]) {
    w_transpose(rows);
    wf greatest = rows[0];
    for (int i = 1; i < LANES; i++) greatest = wf_max(greatest, rows[i]);
    return greatest;
}

/// Middles of the boxes around the positions; `values` are the packets' coordinates c.
static inline wf middle_of(const float *const values[LANES]) {
    wf low[LANES], high[LANES];
    for (int k = 0; k < LANES; k++) low[k] = high[k] = wf_load(values[k]);
    // Halves first: the sum of two coordinates may overflow.
    const wf half = wf_set(0.5f);
    return wf_add(wf_mul(least_of_rows(low), half), wf_mul(greatest_of_rows(high), half));
}

static inline wf radii(const ewa_packet *const packets[LANES], float cutoff, const float center[3][LANES]) {
    wf reach[LANES];
    for (int k = 0; k < LANES; k++) {
        const ewa_packet *p = packets[k];
        const wf x = wf_sub(wf_load(p->x), wf_set(center[0][k]));
        const wf y = wf_sub(wf_load(p->y), wf_set(center[1][k]));
        const wf z = wf_sub(wf_load(p->z), wf_set(center[2][k]));
        // By way of the largest one: squares of coordinates may overflow.
        const wf largest = wf_max(wf_max(wf_abs(x), wf_max(wf_abs(y), wf_abs(z))), wf_set(0x1p-100f));
        const wf a = wf_div(x, largest), b = wf_div(y, largest), c = wf_div(z, largest);
        const wf length = wf_sqrt(wf_fma(a, a, wf_fma(b, b, wf_mul(c, c))));
        reach[k] = wf_fma(length, largest, wf_mul(wf_set(cutoff), wf_load(p->sigma)));
    }
    return greatest_of_rows(reach);
}

static inline void bound_normals(const ewa_packet *const packets[LANES], const ewa_packet_bounds *bounds,
                                 uint64_t first) {
    wf normal[3][LANES];
    for (int k = 0; k < LANES; k++) {
        wf n[3];
        decode_normals(packets[k], n);
        for (int c = 0; c < 3; c++) normal[c][k] = n[c];
    }
    float *const streams[3] = {bounds->axis_x + first, bounds->axis_y + first, bounds->axis_z + first};
    wf rows[LANES], sum[3];
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < LANES; k++) rows[k] = normal[c][k];
        sum[c] = sum_rows(rows);
    }
    const wf length2 = wf_fma(sum[0], sum[0], wf_fma(sum[1], sum[1], wf_mul(sum[2], sum[2])));
    const wm directed = wf_lt(wf_set(SLACK), length2);
    const wf length = wf_sqrt(length2);
    for (int c = 0; c < 3; c++)
        wf_store(streams[c], wf_select(directed, wf_div(sum[c], length), wf_set(c == 2)));
    wf cosine[LANES], sine2[LANES];
    for (int k = 0; k < LANES; k++) {
        const wf x = normal[0][k], y = normal[1][k], z = normal[2][k];
        const wf a = wf_set(streams[0][k]), b = wf_set(streams[1][k]), c = wf_set(streams[2][k]);
        cosine[k] = wf_fma(x, a, wf_fma(y, b, wf_mul(z, c)));
        // By the cross product, which is exact where the cosine says nothing.
        const wf s = wf_sub(wf_mul(y, c), wf_mul(z, b)), t = wf_sub(wf_mul(z, a), wf_mul(x, c)),
                 u = wf_sub(wf_mul(x, b), wf_mul(y, a));
        sine2[k] = wf_fma(s, s, wf_fma(t, t, wf_mul(u, u)));
    }
    const wm narrow = wm_and(directed, wf_lt(wf_set(SLACK), least_of_rows(cosine)));
    const wf sine = wf_add(wf_sqrt(greatest_of_rows(sine2)), wf_set(SLACK));
    wf_store(bounds->cone_sine + first, wf_select(narrow, sine, wf_set(2)));
}

static void bound_packets(const ewa_packet *packets, uint32_t count, float cutoff,
                          const ewa_packet_bounds *bounds, uint64_t first) {
    const ewa_packet *all[LANES];
    const float *positions[3][LANES];
    for (uint32_t k = 0; k < LANES; k++) {
        all[k] = &packets[k < count ? k : 0];
        positions[0][k] = all[k]->x, positions[1][k] = all[k]->y, positions[2][k] = all[k]->z;
    }
    float *const streams[3] = {bounds->center_x + first, bounds->center_y + first, bounds->center_z + first};
    float center[3][LANES];
    wf size = wf_set(0);
    for (int c = 0; c < 3; c++) {
        const wf middle = middle_of(positions[c]);
        wf_store(center[c], middle);
        wf_store(streams[c], middle);
        size = wf_add(size, wf_abs(middle));
    }
    const wf radius = wf_mul(radii(all, cutoff, center), wf_set(1 + SLACK));
    wf_store(bounds->radius + first, wf_fma(size, wf_set(SLACK), radius));
    bound_normals(all, bounds, first);
}

const ewa_pack_kernels PACK_KERNELS = {survey, code_normals, bound_packets};
