// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The packing kernels over the wide type. What a surfel is: docs/math.md section 2; what storing costs:
// docs/conventions.md, precision.
#include "surface/pack.h"
#include "wide/wide_double.h"
#include "wide/wide_octahedral.h"

enum { LANES = EWA_PACKET_LANES };

/// Single precision of radius, axis and sine, rounded to the safe side.
static const float SLACK = 16 * 0x1p-24f;

static uint64_t measure_discs(const ewa_safe_range *range, const float *position, const float *normal,
                       const float *radius, uint64_t group_count, float low[EWA_BOX_FLOATS],
                       float high[EWA_BOX_FLOATS]) {
    const wf finite_max = wf_set(0x1.fffffep127f);
    const wf radius_min = wf_set(range->radius_min), radius_max = wf_set(range->radius_max);
    wf lows[3], highs[3];
    for (int c = 0; c < 3; c++) lows[c] = wf_load(low + c * LANES), highs[c] = wf_load(high + c * LANES);
    uint64_t group = 0;
    for (; group < group_count; group++) {
        const wf r = wf_load(radius + group * LANES);
        wm good = wm_and(wf_le(radius_min, r), wf_le(r, radius_max));
        wf at[3];
        uint64_t zeros = 0; // of all numbers of the normals
        for (int c = 0; c < 3; c++) {
            at[c] = wf_load(position + group * EWA_BOX_FLOATS + c * LANES);
            const wf n = wf_abs(wf_load(normal + group * EWA_BOX_FLOATS + c * LANES));
            good = wm_and(good, wm_and(wf_le(wf_abs(at[c]), finite_max), wf_le(n, finite_max)));
            zeros |= (uint64_t)wm_bits(wf_le(n, wf_set(0))) << c * LANES;
        }
        const uint64_t firsts = 0x249249249249u; // of each normal
        if (wm_bits(good) != 0xffff || (zeros & zeros >> 1 & zeros >> 2 & firsts)) break;
        for (int c = 0; c < 3; c++) lows[c] = wf_min(lows[c], at[c]), highs[c] = wf_max(highs[c], at[c]);
    }
    for (int c = 0; c < 3; c++) wf_store(low + c * LANES, lows[c]), wf_store(high + c * LANES, highs[c]);
    return group;
}

/// Sets the codes of normals of which no sum overflows or vanishes.
static ALWAYS_INLINE void code_directions(const wf n[3], ewa_packet *packet) {
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

static void code_normals(const float normal[3][LANES], ewa_packet *packet) {
    wf n[3];
    for (int c = 0; c < 3; c++) n[c] = wf_load(normal[c]);
    // Tiny and huge normals keep their direction.
    const wf largest = wf_max(wf_abs(n[0]), wf_max(wf_abs(n[1]), wf_abs(n[2])));
    for (int c = 0; c < 3; c++) n[c] = wf_div(n[c], largest);
    code_directions(n, packet);
}

static inline wf dot(const wf a[3], const wf b[3]) {
    return wf_fma(a[0], b[0], wf_fma(a[1], b[1], wf_mul(a[2], b[2])));
}

/// A rotation of the pair of axes by t keeps their covariance; they become orthogonal for tan 2t = 2 u.v /
/// (u.u - v.v), as in surfel.c.
static void code_ellipses(const float normal[3][LANES], const float axis_u[3][LANES],
                          const float axis_v[3][LANES], ewa_packet *packet) {
    const wf zero = wf_set(0), one = wf_set(1), half = wf_set(0.5f);
    wf n[3], u[3], v[3], largest = zero;
    for (int c = 0; c < 3; c++) {
        n[c] = wf_load(normal[c]), u[c] = wf_load(axis_u[c]), v[c] = wf_load(axis_v[c]);
        largest = wf_max(wf_max(wf_abs(u[c]), wf_abs(v[c])), largest);
    }
    code_directions(n, packet);
    const wf inverse = wf_reciprocal(largest); // squares neither overflow nor vanish
    for (int c = 0; c < 3; c++) u[c] = wf_mul(u[c], inverse), v[c] = wf_mul(v[c], inverse);
    const wf uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), sum = wf_add(uu, vv);
    const wf difference = wf_sub(uu, vv), twice = wf_add(uv, uv);
    const wf length2 = wf_fma(difference, difference, wf_mul(twice, twice));
    const wm round = wf_le(length2, wf_mul(wf_mul(sum, sum), wf_set(1e-12f)));
    const wf safe2 = wf_select(round, one, length2), inverse_length = wf_inverse_root(safe2);
    const wf length = wf_mul(safe2, inverse_length);
    const wf larger2 = wf_fma(wf_mul(wf_abs(difference), inverse_length), half, half);
    const wf inverse_larger = wf_inverse_root(larger2), larger = wf_mul(larger2, inverse_larger);
    const wf smaller = wf_mul(wf_mul(wf_abs(twice), inverse_length), wf_mul(inverse_larger, half));
    const wm first = wf_le(zero, difference);
    const wf cosine = wf_select(first, larger, smaller);
    const wf sine = with_sign_of(wf_select(first, smaller, larger), twice);
    wf axis[3];
    for (int c = 0; c < 3; c++) axis[c] = wf_fma(cosine, u[c], wf_mul(sine, v[c]));
    const wf major2 = wf_select(round, wf_mul(sum, half), wf_mul(wf_add(sum, length), half));
    const wf inverse_major = wf_inverse_root(major2);
    // The area of the pair is that of the principal axes.
    const wf cross[3] = {wf_sub(wf_mul(u[1], v[2]), wf_mul(u[2], v[1])),
                         wf_sub(wf_mul(u[2], v[0]), wf_mul(u[0], v[2])),
                         wf_sub(wf_mul(u[0], v[1]), wf_mul(u[1], v[0]))};
    const wf area = wf_sqrt(dot(cross, cross));
    const wf thin = wf_min(wf_mul(area, wf_mul(inverse_major, inverse_major)), one);
    const wf ratio = wf_sqrt(wf_sqrt(wf_select(round, one, thin)));
    wf_store(packet->sigma, wf_mul(wf_mul(major2, inverse_major), largest));

    // The angle in the frame of the decoded normal: packet_frame() of packets.c.
    decode_normals(packet->oct_x, packet->oct_y, n);
    const wf sign = wf_select(wf_lt(n[2], zero), wf_set(-1), one);
    const wf a = wf_div(wf_set(-1), wf_add(sign, n[2])), b = wf_mul(wf_mul(n[0], n[1]), a);
    const wf frame_u[3] = {wf_fma(wf_mul(sign, n[0]), wf_mul(n[0], a), one), wf_mul(sign, b),
                           wf_sub(zero, wf_mul(sign, n[0]))};
    const wf frame_v[3] = {b, wf_fma(wf_mul(n[1], n[1]), a, sign), wf_sub(zero, n[1])};
    wf c = dot(axis, frame_u), s = dot(axis, frame_v);
    c = wf_select(wf_lt(s, zero), wf_sub(zero, c), c), s = wf_abs(s); // the axis has no sign
    const wf extent = wf_max(wf_add(wf_abs(c), s), wf_set(0x1p-100f));
    const wf diamond = wf_keep(wm_not(round), wf_sub(one, wf_div(c, extent)));
    int32_t angles[LANES], ratios[LANES];
    wi_store(angles, wi_from_f(wf_fma(diamond, wf_set(32768), half)));
    wi_store(ratios, wi_from_f(wf_fma(ratio, wf_set(65535), half)));
    for (int i = 0; i < LANES; i++) packet->angle[i] = (uint16_t)angles[i];
    for (int i = 0; i < LANES; i++) packet->ratio[i] = (uint16_t)ratios[i];
}

/// The sum, the smallest or the largest number of each row: lane k of the result is that of rows[k].
static inline wf sum_rows(wf rows[LANES]) {
    w_transpose(rows);
    wf sum = rows[0];
    for (int i = 1; i < LANES; i++) sum = wf_add(sum, rows[i]);
    return sum;
}

static inline wf min_of_rows(wf rows[LANES]) {
    w_transpose(rows);
    wf minimum = rows[0];
    for (int i = 1; i < LANES; i++) minimum = wf_min(minimum, rows[i]);
    return minimum;
}

static inline wf greatest_of_rows(wf rows[LANES]) {
    w_transpose(rows);
    wf greatest = rows[0];
    for (int i = 1; i < LANES; i++) greatest = wf_max(greatest, rows[i]);
    return greatest;
}

/// Middles of the boxes around the positions, whose coordinates c are `values`; raises `extent` to theirs.
static inline wf middle_of(float *const values[LANES], wf *extent) {
    wf low[LANES], high[LANES];
    for (int k = 0; k < LANES; k++) low[k] = high[k] = wf_load(values[k]);
    // Halves first: the sum of two coordinates may overflow.
    const wf half = wf_set(0.5f);
    const wf minimum = wf_mul(min_of_rows(low), half), greatest = wf_mul(greatest_of_rows(high), half);
    *extent = wf_max(wf_sub(greatest, minimum), *extent);
    return wf_add(minimum, greatest);
}

/// Rounds middles to steps of about a hundredth of the extent: that much more digits than a centre needs
/// would be lost where the packet is far from the origin.
static inline wf round_middle(wf middle, wf extent) {
    const wf power = wf_of_bits(wi_and(wi_of_bits(extent), wi_set(0x7f800000)));
    const wf rounder = wf_mul(power, wf_set(0x1.8p16f));
    return wf_sub(wf_add(middle, rounder), rounder);
}

/// Radii of the spheres around the packets' centres; sets the mask of packets that reach too far.
static inline wf radii(const ewa_packet *const packets[LANES], float cutoff, float reach, uint32_t *wide) {
    wf reaches[LANES];
    *wide = 0;
    for (int k = 0; k < LANES; k++) {
        const ewa_packet *p = packets[k];
        const wf x = wf_load(p->x), y = wf_load(p->y), z = wf_load(p->z), sigma = wf_load(p->sigma);
        // By way of the largest one: squares of coordinates may overflow.
        const wf largest = wf_max(wf_max(wf_abs(x), wf_max(wf_abs(y), wf_abs(z))), wf_set(0x1p-100f));
        const wf inverse = wf_reciprocal(largest);
        const wf a = wf_mul(x, inverse), b = wf_mul(y, inverse), c = wf_mul(z, inverse);
        const wf square = wf_fma(a, a, wf_fma(b, b, wf_mul(c, c)));
        const wf length = wf_mul(wf_mul(square, wf_inverse_root(square)), largest);
        reaches[k] = wf_fma(wf_set(cutoff), sigma, length);
        *wide |= (uint32_t)(wm_bits(wf_le(wf_mul(wf_set(reach), sigma), length)) != 0) << k;
    }
    return greatest_of_rows(reaches);
}

/// Sets the packets' centres and moves their positions there.
static inline void center_packets(ewa_packet *packets, uint32_t count, const double starts[LANES][3],
                                  const ewa_packet_bounds *bounds, uint64_t first) {
    float *values[3][LANES];
    double start[3][LANES];
    for (uint32_t k = 0; k < LANES; k++) {
        ewa_packet *p = &packets[k < count ? k : 0];
        values[0][k] = p->x, values[1][k] = p->y, values[2][k] = p->z;
        for (int c = 0; c < 3; c++) start[c][k] = starts[k < count ? k : 0][c];
    }
    wf middle[3], extent = wf_set(0);
    for (int c = 0; c < 3; c++) middle[c] = middle_of(values[c], &extent);
    double *const streams[3] = {bounds->center_x + first, bounds->center_y + first, bounds->center_z + first};
    for (int c = 0; c < 3; c++) {
        // Where the centre had to be rounded once more, the way there is what is left.
        float moved[LANES];
        const wd from = wd_load(start[c]), to = wd_add(from, wd_from_f(round_middle(middle[c], extent)));
        wd_store(streams[c], to);
        wf_store(moved, wf_from_d(wd_sub(to, from)));
        for (uint32_t k = 0; k < count; k++)
            wf_store(values[c][k], wf_sub(wf_load(values[c][k]), wf_set(moved[k])));
    }
}

/// Radii as the codes of floats that are no smaller.
static inline void store_radii(wf radius, uint16_t *codes) {
    const wi round_up = wi_set((1 << EWA_RADIUS_SHIFT) - 1);
    int32_t lanes[LANES];
    wi_store(lanes, wi_sar(wi_add(wi_of_bits(radius), round_up), EWA_RADIUS_SHIFT));
    for (int k = 0; k < LANES; k++) codes[k] = (uint16_t)lanes[k];
}

/// Octahedral codes of unit vectors, and the unit vectors that these stand for.
static inline wi code_axes(wf axis[3]) {
    const wf one = wf_set(1), steps = wf_set(EWA_CONE_AXIS), half = wf_set(0.5f);
    const wf inverse = wf_div(one, wf_add(wf_add(wf_abs(axis[0]), wf_abs(axis[1])), wf_abs(axis[2])));
    const wf u = wf_mul(axis[0], inverse), v = wf_mul(axis[1], inverse);
    const wm below = wf_lt(axis[2], wf_set(0));
    const wf x = wf_select(below, with_sign_of(wf_sub(one, wf_abs(v)), u), u);
    const wf y = wf_select(below, with_sign_of(wf_sub(one, wf_abs(u)), v), v);
    const wi codes[2] = {wi_from_f(wf_floor(wf_fma(x, steps, half))),
                         wi_from_f(wf_floor(wf_fma(y, steps, half)))};
    const wf coded[2] = {wf_mul(wf_from_i(codes[0]), wf_set(1.0f / EWA_CONE_AXIS)),
                         wf_mul(wf_from_i(codes[1]), wf_set(1.0f / EWA_CONE_AXIS))};
    unfold(coded[0], coded[1], axis);
    const wi offset = wi_set(EWA_CONE_AXIS);
    return wi_or(wi_add(codes[0], offset), wi_shl(wi_add(codes[1], offset), EWA_CONE_BITS));
}

static inline void bound_normals(const ewa_packet *const packets[LANES], uint32_t *cones) {
    wf normal[3][LANES];
    for (int k = 0; k < LANES; k++) {
        wf n[3];
        decode_normals(packets[k]->oct_x, packets[k]->oct_y, n);
        for (int c = 0; c < 3; c++) normal[c][k] = n[c];
    }
    wf rows[LANES], axis[3];
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < LANES; k++) rows[k] = normal[c][k];
        axis[c] = sum_rows(rows);
    }
    const wf length2 = wf_fma(axis[0], axis[0], wf_fma(axis[1], axis[1], wf_mul(axis[2], axis[2])));
    const wm directed = wf_lt(wf_set(SLACK), length2);
    for (int c = 0; c < 3; c++) axis[c] = wf_select(directed, axis[c], wf_set(c == 2));
    const wi codes = code_axes(axis);
    float axes[3][LANES];
    for (int c = 0; c < 3; c++) wf_store(axes[c], axis[c]);
    wf cosine[LANES], sine2[LANES];
    for (int k = 0; k < LANES; k++) {
        const wf x = normal[0][k], y = normal[1][k], z = normal[2][k];
        const wf a = wf_set(axes[0][k]), b = wf_set(axes[1][k]), c = wf_set(axes[2][k]);
        cosine[k] = wf_fma(x, a, wf_fma(y, b, wf_mul(z, c)));
        // By the cross product, which is exact where the cosine says nothing.
        const wf s = wf_sub(wf_mul(y, c), wf_mul(z, b)), t = wf_sub(wf_mul(z, a), wf_mul(x, c)),
                 u = wf_sub(wf_mul(x, b), wf_mul(y, a));
        sine2[k] = wf_fma(s, s, wf_fma(t, t, wf_mul(u, u)));
    }
    const wm narrow = wm_and(directed, wf_lt(wf_set(SLACK), min_of_rows(cosine)));
    const wf sine = wf_add(wf_sqrt(greatest_of_rows(sine2)), wf_set(SLACK));
    const wf steps = wf_min(wf_fma(sine, wf_set(EWA_CONE_SINE), wf_set(1)), wf_set(EWA_CONE_SINE)); // upwards
    const wi sine_codes = wi_from_f(wf_select(narrow, steps, wf_set(EWA_CONE_SINE + 1)));
    wi_store((int32_t *)(void *)cones, wi_or(codes, wi_shl(sine_codes, 2 * EWA_CONE_BITS)));
}

static uint32_t bound_packets(ewa_packet *packets, uint32_t count, const double starts[LANES][3],
                              float cutoff, float reach, const ewa_packet_bounds *bounds, uint64_t first) {
    center_packets(packets, count, starts, bounds, first);
    const ewa_packet *all[LANES];
    for (uint32_t k = 0; k < LANES; k++) all[k] = &packets[k < count ? k : 0];
    uint32_t wide;
    store_radii(wf_mul(radii(all, cutoff, reach, &wide), wf_set(1 + SLACK)), bounds->radius + first);
    bound_normals(all, bounds->cone + first);
    return wide;
}

const ewa_pack_kernels EWA_VERSION(ewa_pack_kernels) = {measure_discs, code_normals, code_ellipses, bound_packets};
