// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Normal, spacing and shape from a neighbourhood, sixteen at a time. No section of docs/math.md is about it;
// what radii come to is in docs/quality.md.
//
// Normal: the direction of smallest variance of the neighbourhood. Based on H. Hoppe, T. DeRose, T. Duchamp,
// J. McDonald, W. Stuetzle, "Surface reconstruction from unorganized points", 1992, section 3.2.
//
// Spacing: in a plane with rho samples per area the j-th nearest neighbour is found at pi rho d_j^2 = j on
// average (a Poisson process; on lattices about j + 1/4). Summed over all n neighbours: 1 / rho = 2 pi
// sum(d^2) / (n (n + 1)). A sum over the closed ball does not care which of several equally far neighbours
// were found first. At the border of a scan the neighbours lie on one side and further away; the offset of
// their mean tells.
//
// Shape: the place's cell in the Voronoi diagram, cut by the tangent plane. Seen in direction u it ends at
// t(u) = 1 / (2 max_j u.p_j / |p_j|^2). A ball that holds an anisotropic lattice shows no anisotropy in its
// variance, but the cell has the lattice's own proportions.
#include "estimate/local.h"
#include "wide/wide.h"

enum {
    JACOBI_SWEEPS = 3, // quadratic convergence: normals are then exact to 1e-5 degrees over the gap
    DIRECTIONS = 8,    // of the cell, with their opposites
};

// Constants of the estimators; the tests of regular, jittered, hexagonal and random samplings depend on them.
static const float PI = 3.14159265f;
static const float SELF_SHARE = 0.15f; // of j + share above: between a random sampling and a lattice
static const float HALF_PLANE_OFFSET =
    0.36f;                                // |mean|^2 / mean(d^2) at a straight border: (4 / 3 pi)^2 / (1 / 2)
static const float OFFSET_NOISE = 2.0f;   // times 1 / n: offsets up to that occur in the middle of a surface
static const float LINE_VARIANCE = 1e-3f; // second over first variance below which a neighbourhood is a line
static const float THIN_VARIANCE = 0.05f; // the same below which more neighbours should be asked
static const float MAX_REACH = 2.0f; // spacings; cells that reach further are open: at a border or a hole
static const float ENCLOSED_COSINE = 0.866025404f; // of the angle up to which a neighbour bounds a direction
// Share of the variance along the normal up to which samples lie on a surface; from twice that on they are noise around it.
static const float THIN_VARIATION = 0.007f;
static const float REACH_MARGIN = 1.08f; // a corner of the cell between two directions reaches further

// cos and sin of i * 22.5 degrees
static const float DIRECTION_X[DIRECTIONS] = {1, 0.923879533f,  0.707106781f,  0.382683432f,
                                              0, -0.382683432f, -0.707106781f, -0.923879533f};
static const float DIRECTION_Y[DIRECTIONS] = {0, 0.382683432f, 0.707106781f, 0.923879533f,
                                              1, 0.923879533f, 0.707106781f, 0.382683432f};

typedef struct vec {
    wf x, y, z;
} vec;

static inline vec v_set(float x, float y, float z) { return (vec){wf_set(x), wf_set(y), wf_set(z)}; }
static inline vec v_scale(vec a, wf s) { return (vec){wf_mul(a.x, s), wf_mul(a.y, s), wf_mul(a.z, s)}; }
static inline vec v_add(vec a, vec b) { return (vec){wf_add(a.x, b.x), wf_add(a.y, b.y), wf_add(a.z, b.z)}; }
static inline vec v_sub(vec a, vec b) { return (vec){wf_sub(a.x, b.x), wf_sub(a.y, b.y), wf_sub(a.z, b.z)}; }
static inline wf v_dot(vec a, vec b) {
    return wf_add(wf_add(wf_mul(a.x, b.x), wf_mul(a.y, b.y)), wf_mul(a.z, b.z));
}
static inline vec v_select(wm m, vec a, vec b) {
    return (vec){wf_select(m, a.x, b.x), wf_select(m, a.y, b.y), wf_select(m, a.z, b.z)};
}
static inline vec v_cross(vec a, vec b) {
    return (vec){wf_sub(wf_mul(a.y, b.z), wf_mul(a.z, b.y)), wf_sub(wf_mul(a.z, b.x), wf_mul(a.x, b.z)),
                 wf_sub(wf_mul(a.x, b.y), wf_mul(a.y, b.x))};
}
static inline vec v_unit(vec a) {
    return v_scale(a, wf_div(wf_set(1), wf_sqrt(wf_max(v_dot(a, a), wf_set(1e-30f)))));
}
static inline void v_store(float to[3][EWA_BLOCK_LANES], vec a) {
    wf_store(to[0], a.x);
    wf_store(to[1], a.y);
    wf_store(to[2], a.z);
}

/// A symmetric matrix: m[0..5] = xx xy xz yy yz zz.
typedef struct symmetric {
    wf xx, xy, xz, yy, yz, zz;
} symmetric;

/// Sums over a neighbourhood, relative to its place, which is counted but adds nothing.
typedef struct moments {
    wf count;
    vec first;
    symmetric second;
} moments;

static inline vec lanes_of(const ewa_block *block) {
    return (vec){wf_load(block->lane_x), wf_load(block->lane_y), wf_load(block->lane_z)};
}

static moments no_moments(void) {
    const wf zero = wf_set(0);
    return (moments){zero, {zero, zero, zero}, {zero, zero, zero, zero, zero, zero}};
}

static inline void add_offset(moments *m, vec d) {
    m->first = v_add(m->first, d);
    m->second.xx = wf_add(m->second.xx, wf_mul(d.x, d.x));
    m->second.xy = wf_add(m->second.xy, wf_mul(d.x, d.y));
    m->second.xz = wf_add(m->second.xz, wf_mul(d.x, d.z));
    m->second.yy = wf_add(m->second.yy, wf_mul(d.y, d.y));
    m->second.yz = wf_add(m->second.yz, wf_mul(d.y, d.z));
    m->second.zz = wf_add(m->second.zz, wf_mul(d.z, d.z));
}

#include "estimate/local_rows_body.h"

/// Turns rows and columns p and q of a symmetric matrix so that (p, q) becomes 0; r is the third. Columns of
/// the eigenvectors turn along. (Jacobi 1846, in the form that divides by nothing small.)
static inline void rotate(wf *pp, wf *qq, wf *pq, wf *pr, wf *qr, vec *vp, vec *vq) {
    const wf one = wf_set(1), difference = wf_sub(*qq, *pp), twice = wf_add(*pq, *pq);
    const wf length = wf_sqrt(wf_add(wf_mul(difference, difference), wf_mul(twice, twice)));
    const wf sum = wf_add(wf_abs(difference), length), tiny = wf_set(1e-30f);
    const wf sign = wf_select(wf_lt(difference, wf_set(0)), wf_set(-1), one);
    const wf t = wf_div(wf_mul(sign, twice), wf_max(sum, tiny));
    // The cosine from that of twice the angle, beside the division above: what limits this is its latency.
    const wf c2 = wf_div(sum, wf_max(wf_add(length, length), tiny));
    const wf c = wf_select(wf_lt(tiny, length), wf_sqrt(c2), one), s = wf_mul(t, c);
    *pp = wf_sub(*pp, wf_mul(t, *pq));
    *qq = wf_add(*qq, wf_mul(t, *pq));
    *pq = wf_set(0);
    const wf old = *pr;
    *pr = wf_sub(wf_mul(c, old), wf_mul(s, *qr));
    *qr = wf_add(wf_mul(s, old), wf_mul(c, *qr));
    const vec old_v = *vp;
    *vp = v_sub(v_scale(old_v, c), v_scale(*vq, s));
    *vq = v_add(v_scale(old_v, s), v_scale(*vq, c));
}

/// Eigenvalues descending, with their vectors.
typedef struct eigen {
    wf value[3];
    vec vector[3];
} eigen;

static void order_pair(eigen *e, int low, int high) {
    const wm swap = wf_lt(e->value[low], e->value[high]);
    const wf value = e->value[low];
    const vec vector = e->vector[low];
    e->value[low] = wf_select(swap, e->value[high], value);
    e->value[high] = wf_select(swap, value, e->value[high]);
    e->vector[low] = v_select(swap, e->vector[high], vector);
    e->vector[high] = v_select(swap, vector, e->vector[high]);
}

static eigen decompose(symmetric a) {
    eigen e = {.vector = {v_set(1, 0, 0), v_set(0, 1, 0), v_set(0, 0, 1)}};
    for (int sweep = 0; sweep < JACOBI_SWEEPS; sweep++) {
        rotate(&a.xx, &a.yy, &a.xy, &a.xz, &a.yz, &e.vector[0], &e.vector[1]);
        rotate(&a.xx, &a.zz, &a.xz, &a.xy, &a.yz, &e.vector[0], &e.vector[2]);
        rotate(&a.yy, &a.zz, &a.yz, &a.xy, &a.xz, &e.vector[1], &e.vector[2]);
    }
    e.value[0] = a.xx;
    e.value[1] = a.yy;
    e.value[2] = a.zz;
    order_pair(&e, 0, 1);
    order_pair(&e, 1, 2);
    order_pair(&e, 0, 1);
    return e;
}

/// The tangent frame and what it says: unit vectors, normal = u x v up to sign.
typedef struct frame {
    vec u, v, normal;
    wf variation;
    wm thin, degenerate;
} frame;

static frame find_frame(const moments *m) {
    const wf per_count = wf_div(wf_set(1), wf_max(m->count, wf_set(1)));
    const vec mean = v_scale(m->first, per_count);
    symmetric c = {wf_sub(wf_mul(m->second.xx, per_count), wf_mul(mean.x, mean.x)),
                   wf_sub(wf_mul(m->second.xy, per_count), wf_mul(mean.x, mean.y)),
                   wf_sub(wf_mul(m->second.xz, per_count), wf_mul(mean.x, mean.z)),
                   wf_sub(wf_mul(m->second.yy, per_count), wf_mul(mean.y, mean.y)),
                   wf_sub(wf_mul(m->second.yz, per_count), wf_mul(mean.y, mean.z)),
                   wf_sub(wf_mul(m->second.zz, per_count), wf_mul(mean.z, mean.z))};
    const wf trace = wf_add(wf_add(c.xx, c.yy), c.zz);
    const wf scale = wf_div(wf_set(1), wf_max(trace, wf_set(1e-30f)));
    c = (symmetric){wf_mul(c.xx, scale), wf_mul(c.xy, scale), wf_mul(c.xz, scale),
                    wf_mul(c.yy, scale), wf_mul(c.yz, scale), wf_mul(c.zz, scale)};
    const eigen e = decompose(c);
    frame f = {.u = e.vector[0], .v = e.vector[1], .normal = e.vector[2], .variation = e.value[2]};
    const wm few = wf_lt(m->count, wf_set(3));
    f.thin = wm_or(few, wf_le(e.value[1], wf_mul(e.value[0], wf_set(THIN_VARIANCE))));
    f.degenerate = wm_or(few, wf_le(e.value[1], wf_mul(e.value[0], wf_set(LINE_VARIANCE))));
    // Without a plane: upright on the line if there is one, or on x if the line itself is upright.
    const vec up = v_set(0, 0, 1), line = v_select(wf_lt(wf_set(0), e.value[0]), e.vector[0], v_set(1, 0, 0));
    const vec helper = v_select(wf_lt(wf_abs(line.z), wf_set(0.9f)), up, v_set(1, 0, 0));
    const vec upright = v_unit(v_sub(helper, v_scale(line, v_dot(helper, line))));
    f.normal = v_select(f.degenerate, upright, f.normal);
    f.u = v_select(f.degenerate, line, f.u);
    // The sign by the largest component makes the result independent of how the rotations went.
    const wf ax = wf_abs(f.normal.x), ay = wf_abs(f.normal.y), az = wf_abs(f.normal.z);
    wf largest = wf_select(wf_lt(ax, ay), f.normal.y, f.normal.x);
    largest = wf_select(wf_lt(wf_max(ax, ay), az), f.normal.z, largest);
    const wf sign = wf_select(wf_lt(largest, wf_set(0)), wf_set(-1), wf_set(1));
    f.normal = v_unit(v_scale(f.normal, sign));
    f.v = v_unit(v_cross(f.normal, f.u));
    f.u = v_cross(f.v, f.normal);
    return f;
}

/// Of neighbours on a line: their number per length from the variance of even ones, L^2 / 12. The place
/// itself does not count.
static wf find_line_spacing(const moments *m) {
    const wf one = wf_set(1), count = wf_max(wf_sub(m->count, one), one);
    const wf all = wf_add(wf_add(m->second.xx, m->second.yy), m->second.zz);
    const wf spread = wf_max(wf_sub(all, wf_div(v_dot(m->first, m->first), count)), wf_set(0));
    return wf_sqrt(wf_div(wf_mul(wf_set(12), spread), wf_mul(count, wf_mul(count, count))));
}

static wf find_spacing(const moments *m, const frame *f) {
    const vec n = f->normal;
    const wf one = wf_set(1), zero = wf_set(0);
    const wf count = wf_sub(m->count, one), safe_count = wf_max(count, one);
    // n.S n, what the neighbourhood is thick.
    const vec sn = {
        wf_add(wf_add(wf_mul(m->second.xx, n.x), wf_mul(m->second.xy, n.y)), wf_mul(m->second.xz, n.z)),
        wf_add(wf_add(wf_mul(m->second.xy, n.x), wf_mul(m->second.yy, n.y)), wf_mul(m->second.yz, n.z)),
        wf_add(wf_add(wf_mul(m->second.xz, n.x), wf_mul(m->second.yz, n.y)), wf_mul(m->second.zz, n.z))};
    const wf all = wf_add(wf_add(m->second.xx, m->second.yy), m->second.zz);
    const wf tangential = wf_max(wf_sub(all, v_dot(n, sn)), zero);
    const wf pairs = wf_mul(safe_count, wf_add(safe_count, wf_set(1 + 2 * SELF_SHARE)));
    const wf area = wf_div(wf_mul(wf_set(2 * PI), tangential), pairs);
    const vec first = v_sub(m->first, v_scale(n, v_dot(n, m->first)));
    const wf offset = wf_div(v_dot(first, first), wf_max(wf_mul(safe_count, tangential), wf_set(1e-30f)));
    const wf noise = wf_div(wf_set(OFFSET_NOISE), safe_count);
    // Half the area is empty at a straight border, three quarters at a corner: area / (1 + offset / half
    // plane's).
    const wf half_plane = wf_max(wf_sub(wf_set(HALF_PLANE_OFFSET), noise), wf_set(0.05f));
    const wf empty = wf_div(wf_max(wf_sub(offset, noise), zero), half_plane);
    const wf share = wf_max(wf_div(one, wf_add(one, empty)), wf_set(0.25f));
    const wm enough = wf_lt(noise, wf_set(HALF_PLANE_OFFSET));
    return wf_sqrt(wf_mul(area, wf_select(enough, share, one)));
}

/// 1 / a for normal a > 0, to 3e-6: a guess from the bits, a cubic and a quadratic step of Newton's kind. A
/// division takes three times as long.
static inline wf reciprocal(wf a) {
    enum { GUESS = 0x7ef311c7 }; // exponents negated, the line through the mantissa with the smallest error
    const wf one = wf_set(1);
    wf r = wf_of_bits(wi_sub(wi_set(GUESS), wi_of_bits(a)));
    const wf e = wf_sub(one, wf_mul(a, r));
    r = wf_mul(r, wf_add(one, wf_mul(e, wf_add(one, e))));
    return wf_mul(r, wf_sub(wf_set(2), wf_mul(a, r)));
}

/// A neighbour in the tangent plane, inverted at the unit circle: p / |p|^2, zero for what is none.
static inline void invert_offset(vec d, wf distance2, wm other, const frame *f, wf *u, wf *v) {
    const wf inverse = wf_keep(other, reciprocal(wf_max(distance2, wf_set(1e-30f))));
    *u = wf_mul(v_dot(d, f->u), inverse);
    *v = wf_mul(v_dot(d, f->v), inverse);
}

static inline void invert_row(const local_row *row, const frame *f, wf *u, wf *v) {
    const wf distance2 = wf_load(row->distance2);
    invert_offset(row_offset(row), distance2, wf_lt(wf_set(0), distance2), f, u, v);
}

/// Writes the unit eigenvector of the larger eigenvalue of (xx xy; xy yy), (1, 0) when they are equal;
/// returns both eigenvalues, the larger first.
static void major_axis(wf xx, wf xy, wf yy, wf *u, wf *v, wf values[2]) {
    const wf half = wf_set(0.5f), one = wf_set(1), tiny = wf_set(1e-30f);
    const wf middle = wf_mul(wf_add(xx, yy), half), difference = wf_mul(wf_sub(xx, yy), half);
    const wf length = wf_sqrt(wf_add(wf_mul(difference, difference), wf_mul(xy, xy)));
    values[0] = wf_add(middle, length);
    values[1] = wf_max(wf_sub(middle, length), tiny);
    // Of the two forms the one that does not cancel.
    const wm wide = wf_le(wf_set(0), difference);
    const wf x = wf_select(wide, wf_add(length, difference), xy);
    const wf y = wf_select(wide, xy, wf_sub(length, difference));
    const wf norm2 = wf_add(wf_mul(x, x), wf_mul(y, y));
    const wm round = wf_le(norm2, wf_mul(wf_mul(middle, middle), wf_set(1e-12f)));
    const wf inverse = wf_div(one, wf_sqrt(wf_max(norm2, tiny)));
    *u = wf_select(round, one, wf_mul(x, inverse));
    *v = wf_select(round, wf_set(0), wf_mul(y, inverse));
}
/// Turns u to where the nearest neighbours are: a long cell is then seen along its axes.
static void turn_to(frame *f, wf uu, wf uv, wf vv) {
    wf values[2], turn_u, turn_v;
    // Near neighbours weigh as the inverse square of their distance, which single precision cannot always
    // square.
    const wf scale = wf_div(wf_set(1), wf_max(wf_add(uu, vv), wf_set(1e-30f)));
    major_axis(wf_mul(uu, scale), wf_mul(uv, scale), wf_mul(vv, scale), &turn_u, &turn_v, values);
    const vec old = f->u;
    f->u = v_add(v_scale(old, turn_u), v_scale(f->v, turn_v));
    f->v = v_sub(v_scale(f->v, turn_u), v_scale(old, turn_v));
}

static void align_frame(const local_batch *batch, uint32_t rows, frame *f) {
    wf uu = wf_set(0), uv = uu, vv = uu;
    for (uint32_t i = 0; i < rows; i++) {
        wf u, v;
        invert_row(&batch->row[i], f, &u, &v);
        uu = wf_add(uu, wf_mul(u, u));
        uv = wf_add(uv, wf_mul(u, v));
        vv = wf_add(vv, wf_mul(v, v));
    }
    turn_to(f, uu, uv, vv);
}

/// How far the cell of a place extends in 16 directions of the tangent frame: i, and i + DIRECTIONS opposite.
typedef struct cell {
    wf extent[2 * DIRECTIONS];
    wm open[2 * DIRECTIONS]; // it reaches over the limit there
    wm shut[2 * DIRECTIONS]; // it does not, and neighbours stand there
} cell;

/// along[i] = u DIRECTION_X[i] + v DIRECTION_Y[i], each product once.
static inline void project(wf u, wf v, wf along[DIRECTIONS]) {
    const wf uc = wf_mul(u, wf_set(DIRECTION_X[1])), us = wf_mul(u, wf_set(DIRECTION_Y[1]));
    const wf vc = wf_mul(v, wf_set(DIRECTION_X[1])), vs = wf_mul(v, wf_set(DIRECTION_Y[1]));
    const wf ud = wf_mul(u, wf_set(DIRECTION_X[2])), vd = wf_mul(v, wf_set(DIRECTION_Y[2]));
    along[0] = u;
    along[1] = wf_add(uc, vs);
    along[2] = wf_add(ud, vd);
    along[3] = wf_add(us, vc);
    along[4] = v;
    along[5] = wf_sub(vc, us);
    along[6] = wf_sub(vd, ud);
    along[7] = wf_sub(vs, uc);
}

/// The largest and the smallest of (u, v) along each direction so far.
typedef struct range {
    wf high[DIRECTIONS], low[DIRECTIONS];
} range;

static inline void widen(range *r, wf u, wf v) {
    wf along[DIRECTIONS];
    project(u, v, along);
    for (int i = 0; i < DIRECTIONS; i++) {
        r->high[i] = wf_max(r->high[i], along[i]);
        r->low[i] = wf_min(r->low[i], along[i]);
    }
}

static range empty_range(void) {
    range r;
    for (int i = 0; i < DIRECTIONS; i++) r.high[i] = r.low[i] = wf_set(0);
    return r;
}

static inline void set_extents(cell *made, const range *inverted, wf limit) {
    const wf half = wf_set(0.5f), tiny = wf_set(1e-30f), zero = wf_set(0);
    for (int i = 0; i < DIRECTIONS; i++) {
        made->extent[i] = wf_mul(half, reciprocal(wf_max(inverted->high[i], tiny)));
        made->extent[i + DIRECTIONS] = wf_mul(half, reciprocal(wf_max(wf_sub(zero, inverted->low[i]), tiny)));
    }
    for (int i = 0; i < 2 * DIRECTIONS; i++) made->open[i] = wf_lt(limit, made->extent[i]);
}

static void find_cell(const local_batch *batch, uint32_t rows, const frame *f, wf limit, cell *made) {
    range inverted = empty_range();
    for (uint32_t i = 0; i < rows; i++) {
        wf u, v;
        invert_row(&batch->row[i], f, &u, &v);
        widen(&inverted, u, v);
    }
    set_extents(made, &inverted, limit);
    for (int i = 0; i < 2 * DIRECTIONS; i++) made->shut[i] = wm_not(made->open[i]);
}

/// The extent of the cell in a direction; zero where it is open there or next to it, so that borders do not
/// swell.
static wf closed_extent(const cell *c, int i) {
    enum { ALL = 2 * DIRECTIONS };
    const wm beside = wm_or(c->open[(i + 1) % ALL], c->open[(i + ALL - 1) % ALL]);
    return wf_keep(wm_and(c->shut[i], wm_not(beside)), c->extent[i]);
}

/// Sets how far the cell reaches, and where.
static void find_reach(const cell *c, const frame *f, local_surface *surface) {
    wf reach = wf_set(0), x = reach, y = reach;
    for (int i = 0; i < 2 * DIRECTIONS; i++) {
        const wf extent = closed_extent(c, i);
        const wm farther = wf_lt(reach, extent);
        const float sign = i < DIRECTIONS ? 1.0f : -1.0f;
        reach = wf_select(farther, extent, reach);
        x = wf_select(farther, wf_set(sign * DIRECTION_X[i % DIRECTIONS]), x);
        y = wf_select(farther, wf_set(sign * DIRECTION_Y[i % DIRECTIONS]), y);
    }
    wf_store(surface->reach, wf_mul(reach, wf_set(REACH_MARGIN)));
    v_store(surface->corner, v_add(v_scale(f->u, wf_mul(reach, x)), v_scale(f->v, wf_mul(reach, y))));
}

/// The axes of the ellipse with the cell's proportions, from the cell's second moments: t^4 u u^T summed over
/// u.
static void find_shape(const cell *c, const frame *f, wf spacing, local_surface *surface) {
    const wf zero = wf_set(0);
    const wf per_spacing = wf_div(wf_set(1), wf_max(spacing, wf_set(1e-30f)));
    wf xx = zero, xy = zero, yy = zero;
    for (int i = 0; i < 2 * DIRECTIONS; i++) {
        // Where the cell is open its other side stands in, so that borders grow no fringe.
        const int opposite = (i + DIRECTIONS) % (2 * DIRECTIONS);
        const wf mirrored = wf_select(c->shut[opposite], c->extent[opposite], spacing);
        const wf t = wf_mul(wf_select(c->shut[i], c->extent[i], mirrored), per_spacing), t2 = wf_mul(t, t);
        const wf weight = wf_mul(t2, t2);
        const float x = DIRECTION_X[i % DIRECTIONS], y = DIRECTION_Y[i % DIRECTIONS];
        xx = wf_add(xx, wf_mul(weight, wf_set(x * x)));
        xy = wf_add(xy, wf_mul(weight, wf_set(x * y)));
        yy = wf_add(yy, wf_mul(weight, wf_set(y * y)));
    }
    wf major_u, major_v, values[2];
    major_axis(xx, xy, yy, &major_u, &major_v, values);
    // Less than 1 where the cell is nothing at all.
    const wf ratio = wf_max(wf_sqrt(wf_div(values[0], values[1])), wf_set(1));
    const wf aspect = wf_min(ratio, wf_set(LOCAL_MAX_ASPECT));
    v_store(surface->major, v_add(v_scale(f->u, major_u), v_scale(f->v, major_v)));
    wf_store(surface->aspect, aspect);
    wf reach2 = zero;
    for (int i = 0; i < 2 * DIRECTIONS; i++) {
        const wf x = wf_set(DIRECTION_X[i % DIRECTIONS]), y = wf_set(DIRECTION_Y[i % DIRECTIONS]);
        const wf along = wf_add(wf_mul(x, major_u), wf_mul(y, major_v));
        const wf across = wf_sub(wf_mul(y, major_u), wf_mul(x, major_v));
        const wf stretch =
            wf_add(wf_div(wf_mul(along, along), aspect), wf_mul(wf_mul(across, across), aspect));
        const wf t = closed_extent(c, i);
        reach2 = wf_max(reach2, wf_mul(wf_mul(t, t), stretch));
    }
    wf_store(surface->ellipse_reach, wf_mul(wf_sqrt(reach2), wf_set(REACH_MARGIN)));
}

static wm any_open(const cell *c) {
    wm any = c->open[0];
    for (int i = 1; i < 2 * DIRECTIONS; i++) any = wm_or(any, c->open[i]);
    return any;
}

/// The lower median of the first lanes: the smallest value that half of the others are not above.
static float find_median(const float *values, uint32_t count) {
    const wf all = wf_load(values), one = wf_set(1);
    wf not_above = wf_set(0);
    for (uint32_t i = 0; i < count; i++)
        not_above = wf_add(not_above, wf_keep(wf_le(wf_set(values[i]), all), one));
    float minimum[EWA_BLOCK_LANES];
    wf_store(minimum, wf_select(wf_le(wf_set(0.5f * (float)count), not_above), all, wf_set(3e38f)));
    float median = minimum[0];
    for (uint32_t i = 1; i < count; i++) median = minimum[i] < median ? minimum[i] : median;
    return median;
}

static void measure_cell(uint32_t wanted, const cell *c, const frame *f, wf spacing, local_surface *surface) {
    if (wanted & LOCAL_REACH) find_reach(c, f, surface);
    if (wanted & LOCAL_SHAPE) find_shape(c, f, spacing, surface);
}

/// What needs no cell.
static wf measure_plane(const moments *m, const frame *f, local_surface *surface) {
    const wf spacing = find_spacing(m, f);
    v_store(surface->normal, f->normal);
    wf_store(surface->spacing, spacing);
    wf_store(surface->variation, f->variation);
    surface->thin = wm_bits(f->thin);
    if (surface->thin) wf_store(surface->line_spacing, find_line_spacing(m));
    surface->degenerate = wm_bits(f->degenerate);
    surface->doubtful = 0;
    return spacing;
}

static void measure(const ewa_block *block, uint32_t wanted, local_batch *batch, local_surface *surface) {
    moments m = no_moments();
    const uint32_t rows = arrange(block, batch, &m.count);
    sum_moments(batch, rows, &m);
    frame f = find_frame(&m);
    const wf spacing = measure_plane(&m, &f, surface);
    if (!wanted) return;
    if (wanted & LOCAL_SHAPE) align_frame(batch, rows, &f);
    cell c;
    find_cell(batch, rows, &f, wf_mul(spacing, wf_set(MAX_REACH)), &c);
    measure_cell(wanted, &c, &f, spacing, surface);
    surface->median_spacing = find_median(surface->spacing, block->lane_count);
    const wm scattered = wf_lt(wf_set((float)LOCAL_SURFACE_VARIATION), f.variation);
    surface->doubtful = wm_bits(wm_or(any_open(&c), scattered));
}

static void size(uint32_t wanted, const local_sizing *sizing, local_surface *surface) {
    const wf spacing = wf_load(surface->spacing), zero = wf_set(0), one = wf_set(1);
    const wf reach = wf_load(wanted & LOCAL_SHAPE ? surface->ellipse_reach : surface->reach);
    // Kernels in a gap among noise lie at several depths, and not all of them count later.
    const wf off = wf_sub(wf_load(surface->variation), wf_set(THIN_VARIATION));
    const wf thick = sizing->gaps_later ? wf_max(zero, wf_min(one, wf_div(off, wf_set(THIN_VARIATION)))) : one;
    const wf wide = wf_add(reach, wf_mul(wf_max(wf_sub(reach, spacing), zero), thick));
    const wf cover = wf_add(wf_set(sizing->thin_cover), wf_mul(wf_set(sizing->cover - sizing->thin_cover), thick));
    const wf allowed = wf_mul(wf_min(spacing, wf_set(surface->median_spacing)), wf_set(sizing->limit));
    const wf closed = wf_min(wf_mul(wide, cover), allowed);
    const wf radius = wf_max(wf_mul(spacing, wf_set(sizing->scale)), closed);
    wf_store(surface->radius, radius);
    const wf steps = wf_mul(wf_div(radius, wf_max(spacing, wf_set(1e-30f))), wf_set(sizing->ratio_steps));
    wi_store_u8(surface->ratio, wi_from_f(wf_min(wf_set(sizing->max_steps), wf_add(steps, wf_set(1)))));
    // What an open cell may hide adds nothing to a radius at the limit.
    const wm scattered = wf_lt(wf_set((float)LOCAL_SURFACE_VARIATION), wf_load(surface->variation));
    surface->doubtful &= wm_bits(wm_or(scattered, wf_lt(closed, allowed)));
}

static void measure_distance(const ewa_block *block, local_surface *surface) {
    const wf radius2 = wf_load(block->radius2), zero = wf_set(0), one = wf_set(1);
    wf sum = zero, count = wf_set(-1);
    for (uint32_t i = 0; i < block->candidate_count; i++) {
        const wf distance2 = wf_load(block->distance2[i]);
        const wm inside = wf_le(distance2, radius2);
        sum = wf_add(sum, wf_keep(inside, wf_sqrt(distance2)));
        count = wf_add(count, wf_keep(inside, one));
    }
    wf_store(surface->mean_distance, wf_div(sum, wf_max(count, one)));
}

/// Sorts the keys of the rows by insertion into the few smallest of each lane.
static void link_nearest(const ewa_block *block, const local_batch *batch, local_graph graph) {
    enum { KEPT = LOCAL_GRAPH_DEGREE + 1 }; // the place itself is kept too
    const wf none = wf_set(NO_KEY);
    wf smallest[KEPT];
    for (int i = 0; i < KEPT; i++) smallest[i] = none;
    for (uint32_t r = 0; r < batch->row_count; r++) {
        wf key = wf_load(batch->row[r].value);
        for (int i = 0; i < KEPT; i++) {
            const wf smaller = wf_min(smallest[i], key);
            key = wf_max(smallest[i], key);
            smallest[i] = smaller;
        }
    }
    uint32_t count[EWA_BLOCK_LANES] = {0};
    for (int i = 0; i < KEPT; i++) {
        int32_t bits[EWA_BLOCK_LANES];
        wi_store(bits, wi_of_bits(smallest[i]));
        const uint32_t found = wm_bits(wf_lt(smallest[i], none));
        for (uint32_t lane = 0; lane < block->lane_count; lane++) {
            const uint32_t place = block->place[bits[lane] & ((1 << KEY_INDEX_BITS) - 1)];
            const bool other = (found >> lane & 1) && place != block->first_place + lane;
            if (other && count[lane] < LOCAL_GRAPH_DEGREE) graph[lane][count[lane]++] = place;
        }
    }
    for (uint32_t lane = 0; lane < block->lane_count; lane++)
        for (uint32_t i = count[lane]; i < LOCAL_GRAPH_DEGREE; i++) graph[lane][i] = UINT32_MAX;
}

#include "estimate/local_batch_body.h"
#include "estimate/local_border_body.h"
#include "estimate/local_curvature_body.h"
#include "estimate/local_gap_body.h"

const local_kernels EWA_VERSION(ewa_local_kernels) = {
    measure, size, collect, find_around, enclose, find_border, measure_distance, link_nearest,
    fit_curvature, grow};
