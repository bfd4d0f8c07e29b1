// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The kernels of kernels.h. Reference: src/reference/splat.c, sums.c and adjoint_splat.c; docs/math.md section 15.
#include "adjoint/eight.h"
#include "adjoint/kernels.h"
#include "surface/semantics.h"

/// A splat at a block's pixels, as ewa_reference_sample.
typedef struct sample {
    m8 counts; ///< nearer to the centre than the cutoff
    d8 distance2, weight, z, share, inward[2];
} sample;

EIGHT d8 lanes_x(double x) {
    static const double steps[LANES] = {0, 1, 2, 3, 0, 1, 2, 3};
    return d8_add(d8_load(steps), d8_set(x));
}

EIGHT d8 lanes_y(double y) {
    static const double steps[LANES] = {0, 0, 0, 0, 1, 1, 1, 1};
    return d8_add(d8_load(steps), d8_set(y));
}

EIGHT bool is_plain(const ewa_reference_splat *splat) { return !splat->by_rays && splat->clip_count == 0; }

/// Its plane of keys (orthographic: of depths).
EIGHT d8 plane_at(const ewa_reference_splat *splat, d8 x, d8 y) {
    const d8 slopes = d8_add(d8_mul(d8_set(splat->plane[0]), x), d8_mul(d8_set(splat->plane[1]), y));
    return d8_add(slopes, d8_set(splat->plane[2]));
}

/// How far pixels are from the centre; returns whether any is within the cutoff.
EIGHT bool reach_plain(const ewa_reference_view *view, const ewa_reference_splat *splat, d8 x, d8 y, sample *s) {
    const d8 dx = d8_sub(d8_sub(x, d8_set(splat->moved_px[0])), d8_set(splat->center_px[0])),
             dy = d8_sub(d8_sub(y, d8_set(splat->moved_px[1])), d8_set(splat->center_px[1]));
    const double *q = splat->inverse;
    const d8 xx = d8_mul(d8_mul(d8_set(q[0]), dx), dx), xy = d8_mul(d8_mul(d8_set(2 * q[1]), dx), dy),
             yy = d8_mul(d8_mul(d8_set(q[2]), dy), dy);
    s->distance2 = d8_add(d8_add(xx, xy), yy);
    s->counts = d8_lt(s->distance2, d8_set(view->cutoff * view->cutoff));
    return m8_any(s->counts);
}

EIGHT d8 depth_plain(const ewa_reference_view *view, const ewa_reference_splat *splat, d8 x, d8 y) {
    const d8 plane = plane_at(splat, x, y), flat = d8_sub(d8_set(0), plane);
    const d8 key = d8_min(d8_max(view->orthographic ? flat : plane, d8_set(splat->key_low)), d8_set(splat->key_high));
    return view->orthographic ? d8_sub(d8_set(0), key) : d8_div(d8_set(1), key);
}

/// Of a splat with clip lines or that is drawn by rays, pixel by pixel.
static __attribute__((noinline)) void sample_any(const ewa_reference_view *view, const ewa_reference_splat *splat,
                                                 double x_px, double y_px, sample *s) {
    double planes[6][LANES] = {{0}};
    int64_t counts[LANES] = {0};
    for (int i = 0; i < LANES; i++) {
        const double x = x_px + i % EWA_EIGHT_COLUMNS, y = y_px + (double)(i / EWA_EIGHT_COLUMNS);
        ewa_reference_sample at = {.distance2 = 0};
        const bool in_box = x > splat->x_begin && x < splat->x_end && y > splat->y_begin && y < splat->y_end;
        if (!in_box || !ewa_reference_sample_at(view, splat, x, y, &at)) continue;
        if (!(at.distance2 < view->cutoff * view->cutoff)) continue;
        counts[i] = -1;
        planes[0][i] = at.weight, planes[1][i] = at.z, planes[2][i] = at.share;
        if (at.share < 1) planes[3][i] = at.inward[0], planes[4][i] = at.inward[1];
    }
    memcpy(&s->counts, counts, sizeof counts);
    s->weight = d8_load(planes[0]), s->z = d8_load(planes[1]), s->share = d8_load(planes[2]);
    s->inward[0] = d8_load(planes[3]), s->inward[1] = d8_load(planes[4]);
}

/// The blocks of an area that a splat may reach, [first, end).
typedef struct block_range {
    uint32_t first_column, end_column, first_row, end_row;
} block_range;

EIGHT uint32_t within(int32_t pixels, uint32_t side, uint32_t maximum) {
    const uint32_t block = pixels < 0 ? 0 : (uint32_t)pixels / side;
    return block < maximum ? block : maximum;
}

EIGHT block_range blocks_of(const ewa_adjoint_area *area, const ewa_reference_splat *splat) {
    enum { WIDE = EWA_EIGHT_COLUMNS, HIGH = EWA_EIGHT_ROWS };
    return (block_range){within(splat->x_begin - area->x_px, WIDE, area->columns),
                         within(splat->x_end - area->x_px + WIDE - 1, WIDE, area->columns),
                         within(splat->y_begin - area->y_px, HIGH, area->rows),
                         within(splat->y_end - area->y_px + HIGH - 1, HIGH, area->rows)};
}

/// The centre of a block's first pixel, and its planes.
typedef struct block {
    double x_px, y_px;
    double *planes;
} block;

EIGHT block block_at(const ewa_adjoint_area *area, uint32_t column, uint32_t row) {
    return (block){area->x_px + (double)(EWA_EIGHT_COLUMNS * column) + 0.5, area->y_px + (double)(EWA_EIGHT_ROWS * row) + 0.5,
                   area->planes + ((size_t)row * area->columns + column) * EWA_PLANES * LANES};
}

#include "adjoint/filled_body.h"

/// Sets all but the weight of plain splats, which have no share; returns whether the splat counts anywhere beyond what is
/// passed. `plain` is a constant.
EIGHT bool sample_block(const ewa_adjoint_area *area, const ewa_reference_splat *splat, const block *at, bool plain,
                        sample *s) {
    if (plain) {
        const d8 x = lanes_x(at->x_px), y = lanes_y(at->y_px);
        if (!reach_plain(area->view, splat, x, y, s)) return false;
        s->z = depth_plain(area->view, splat, x, y);
    } else {
        sample any;
        sample_any(area->view, splat, at->x_px, at->y_px, &any);
        *s = any;
    }
    s->counts = m8_and(s->counts, d8_lt(d8_load(at->planes + EWA_PLANE_PASSED * LANES), s->z));
    return m8_any(s->counts);
}

/// Leaves what counts up to the bounds, and sets the weight there, 0 elsewhere; returns whether any does.
EIGHT bool weigh_block(const ewa_reference_splat *splat, const block *at, bool plain, sample *s) {
    s->counts = m8_and(s->counts, d8_le(s->z, d8_load(at->planes + EWA_PLANE_BOUND * LANES)));
    if (!m8_any(s->counts)) return false;
    s->z = d8_keep(s->counts, s->z);
    if (plain)
        s->weight = d8_mul(d8_set(splat->peak), d8_exp(d8_mul(d8_set(-0.5), d8_keep(s->counts, s->distance2))));
    s->weight = d8_keep(s->counts, s->weight);
    return true;
}

/// What was found of a splat; its box decides whether samples are kept.
EIGHT bool keeps_samples(const block_range *range, const ewa_adjoint_samples *samples) {
    const uint32_t blocks = (range->end_column - range->first_column) * (range->end_row - range->first_row);
    return blocks <= 64 && samples->count + blocks <= samples->capacity;
}

/// A sample as find() leaves it: beyond the cutoff and what is passed its square is infinite.
EIGHT void keep_sample(const sample *s, ewa_adjoint_sample *to) {
    d8_store(to->z, s->z);
    d8_store(to->weight, d8_select(s->counts, s->distance2, d8_set(__builtin_inf())));
}

EIGHT void load_sample(const ewa_adjoint_sample *from, sample *s) {
    s->z = d8_load(from->z), s->distance2 = d8_load(from->weight);
    s->counts = d8_lt(s->distance2, d8_set(__builtin_inf()));
}

/// Whether block `index` of a splat's box is in a set.
EIGHT bool is_in(uint64_t blocks, uint32_t index) { return index >= 64 || (blocks >> index & 1); }

EIGHT uint64_t bit_of(uint32_t index) { return index < 64 ? UINT64_C(1) << index : 0; }

EIGHT void find_splat(const ewa_adjoint_area *area, const ewa_reference_splat *splat, bool plain, ewa_adjoint_samples *samples,
                      ewa_adjoint_visit *visit) {
    const block_range range = blocks_of(area, splat);
    const bool keeps = plain && keeps_samples(&range, samples);
    uint64_t blocks = 0;
    uint32_t index = 0;
    if (keeps) visit->first = samples->count;
    for (uint32_t row = range.first_row; row < range.end_row; row++)
        for (uint32_t column = range.first_column; column < range.end_column; column++, index++) {
            const block at = block_at(area, column, row);
            sample s;
            if (!sample_block(area, splat, &at, plain, &s)) continue;
            double *bound = at.planes + EWA_PLANE_BOUND * LANES;
            const d8 old = d8_load(bound), reached = d8_add(s.z, d8_set(splat->epsilon));
            if (!m8_any(m8_and(s.counts, d8_le(s.z, old)))) continue; // bounds only fall
            blocks |= bit_of(index);
            if (keeps) keep_sample(&s, &samples->items[samples->count++]);
            d8_store(bound, d8_select(m8_and(s.counts, d8_lt(reached, old)), reached, old));
        }
    visit->found = index > 64 ? UINT64_MAX : blocks;
}

static double find(const ewa_adjoint_area *area, const ewa_reference_splat *const *splats, uint32_t count, ewa_adjoint_samples *samples,
                   ewa_adjoint_visit *visits) {
    for (uint32_t k = 0; k < count; k++) {
        visits[k] = (ewa_adjoint_visit){.first = EWA_NO_SAMPLES};
        if (area->behind && splats[k]->concave) continue;
        if (is_plain(splats[k]))
            find_splat(area, splats[k], true, samples, &visits[k]);
        else
            find_splat(area, splats[k], false, samples, &visits[k]);
    }
    d8 farthest = d8_set(-__builtin_inf());
    for (size_t i = 0; i < (size_t)area->columns * area->rows; i++)
        farthest = d8_max(farthest, d8_load(area->planes + (i * EWA_PLANES + EWA_PLANE_BOUND) * LANES));
    double lanes[LANES], maximum = -__builtin_inf();
    d8_store(lanes, farthest);
    for (int i = 0; i < LANES; i++) maximum = lanes[i] > maximum ? lanes[i] : maximum;
    return maximum;
}

EIGHT void add(double *plane, d8 term) { d8_store(plane, d8_add(d8_load(plane), term)); }

EIGHT d8 cut_share(const sample *s) {
    return d8_min(d8_set(1), d8_div(d8_sub(d8_set(1), s->share), d8_set(EWA_CUT)));
}

/// What clip lines cut of a splat where it counts.
static void add_cut(const sample *s, double *planes) {
    const d8 by_share = d8_select(s->counts, s->share, d8_set(1));
    const d8 weight = d8_mul(d8_keep(s->counts, cut_share(s)), s->weight), whole = d8_div(weight, by_share);
    add(planes + EWA_PLANE_KEPT * LANES, weight);
    add(planes + EWA_PLANE_WHOLE * LANES, whole);
    for (int c = 0; c < 2; c++) add(planes + (EWA_PLANE_INWARD + c) * LANES, d8_mul(whole, s->inward[c]));
}

/// `kept`: the splat is plain, and its samples have been kept.
EIGHT void sum_splat(const ewa_adjoint_area *area, const ewa_reference_splat *splat, bool plain, bool kept,
                     const ewa_adjoint_samples *samples, ewa_adjoint_visit *visit) {
    const block_range range = blocks_of(area, splat);
    uint64_t counts = 0;
    uint32_t index = 0;
    const double opacity = area->transparent ? splat->opacity : 1;
    const ewa_vec3 color = vec3_scale(splat->color, opacity), normal = splat->normal_world;
    const double parts[EWA_SIDE_PLANES] = {1, color.x, color.y, color.z, normal.x, normal.y, normal.z, 0, opacity};
    const size_t side = splat->is_back ? EWA_SIDE_PLANES * LANES : 0;
    ewa_adjoint_sample *next = kept ? samples->items + visit->first : NULL;
    for (uint32_t row = range.first_row; row < range.end_row; row++)
        for (uint32_t column = range.first_column; column < range.end_column; column++, index++) {
            if (!is_in(visit->found, index)) continue;
            const block at = block_at(area, column, row);
            sample s;
            if (kept) {
                ewa_adjoint_sample *of = next++;
                load_sample(of, &s);
                if (!weigh_block(splat, &at, true, &s)) continue;
                d8_store(of->weight, s.weight);
            } else if (!sample_block(area, splat, &at, plain, &s) || !weigh_block(splat, &at, plain, &s)) {
                continue;
            }
            counts |= bit_of(index);
            for (int p = 0; p < EWA_SIDE_PLANES; p++)
                add(at.planes + side + p * LANES, d8_mul(s.weight, p == EWA_PLANE_Z ? s.z : d8_set(parts[p])));
            if (!plain) add_cut(&s, at.planes);
        }
    visit->counts = index > 64 ? UINT64_MAX : counts;
}

static void sum(const ewa_adjoint_area *area, const ewa_reference_splat *const *splats, uint32_t count,
                const ewa_adjoint_samples *samples, ewa_adjoint_visit *visits) {
    for (uint32_t k = 0; k < count; k++) {
        if (area->behind && splats[k]->concave)
            visits[k].counts = 0;
        else if (visits[k].first != EWA_NO_SAMPLES)
            sum_splat(area, splats[k], true, true, samples, &visits[k]);
        else if (is_plain(splats[k]))
            sum_splat(area, splats[k], true, false, samples, &visits[k]);
        else
            sum_splat(area, splats[k], false, false, samples, &visits[k]);
    }
}

/// Adds a term in whole units to a sum that has begun at WHOLE.
EIGHT void gain(d8 *sums, const double *scales, int moment, d8 term) {
    sums[moment] = d8_add(sums[moment], d8_odd(d8_mul(term, d8_set(scales[moment]))));
}

/// By the plane of depths, where it decides them.
EIGHT void gain_depth(const ewa_adjoint_area *area, const ewa_reference_splat *splat, const block *at, const sample *s,
                      d8 by_z, const double *scales, d8 *sums) {
    const bool flat = area->view->orthographic;
    const d8 x = lanes_x(at->x_px), y = lanes_y(at->y_px), plane = plane_at(splat, x, y);
    const d8 key = flat ? d8_sub(d8_set(0), plane) : plane;
    const m8 on_plane = m8_and(d8_lt(d8_set(splat->key_low), key), d8_lt(key, d8_set(splat->key_high)));
    const d8 by_key = flat ? d8_set(1) : d8_mul(d8_sub(d8_set(0), s->z), s->z);
    const d8 by_plane = d8_keep(on_plane, d8_mul(d8_mul(s->weight, by_z), by_key));
    gain(sums, scales, EWA_MOMENT_DEPTH, d8_mul(by_plane, d8_sub(x, d8_set(splat->center_px[0]))));
    gain(sums, scales, EWA_MOMENT_DEPTH + 1, d8_mul(by_plane, d8_sub(y, d8_set(splat->center_px[1]))));
    gain(sums, scales, EWA_MOMENT_DEPTH + 2, by_plane);
}

/// By the kernel: g and its moments.
EIGHT void gain_kernel(const ewa_reference_splat *splat, const block *at, const sample *s, d8 by_weight,
                       const double *scales, d8 *sums) {
    const d8 dx = d8_sub(d8_sub(lanes_x(at->x_px), d8_set(splat->center_px[0])), d8_set(splat->moved_px[0]));
    const d8 dy = d8_sub(d8_sub(lanes_y(at->y_px), d8_set(splat->center_px[1])), d8_set(splat->moved_px[1]));
    const d8 g = d8_mul(s->weight, by_weight), gx = d8_mul(g, dx), gy = d8_mul(g, dy);
    gain(sums, scales, EWA_MOMENT_WEIGHT, g);
    gain(sums, scales, EWA_MOMENT_FIRST, gx);
    gain(sums, scales, EWA_MOMENT_FIRST + 1, gy);
    gain(sums, scales, EWA_MOMENT_SECOND, d8_mul(gx, dx));
    gain(sums, scales, EWA_MOMENT_SECOND + 1, d8_mul(gx, dy));
    gain(sums, scales, EWA_MOMENT_SECOND + 2, d8_mul(gy, dy));
}

/// What the loss changes by the weight through what clip lines cut.
static d8 by_cut(const sample *s, const double *planes) {
    d8 whole = d8_load(planes + EWA_PLANE_WHOLE * LANES);
    for (int c = 0; c < 2; c++)
        whole = d8_add(whole, d8_mul(d8_load(planes + (EWA_PLANE_INWARD + c) * LANES), s->inward[c]));
    const d8 of_whole = d8_div(whole, d8_select(s->counts, s->share, d8_set(1)));
    return d8_mul(cut_share(s), d8_add(d8_load(planes + EWA_PLANE_KEPT * LANES), of_whole));
}

/// Adds what a splat gets of a block where it counts.
EIGHT void gain_block(const ewa_adjoint_area *area, const ewa_reference_splat *splat, const block *at, const sample *s,
                      bool plain, uint32_t width, bool with_depth, const double *scales, d8 *sums) {
    const double *of = at->planes + (splat->is_back ? EWA_SIDE_PLANES * LANES : 0);
    const double colors[3] = {splat->color.x, splat->color.y, splat->color.z};
    const double normals[3] = {splat->normal_world.x, splat->normal_world.y, splat->normal_world.z};
    const d8 opacity = d8_set(area->transparent ? splat->opacity : 1), shining = d8_mul(s->weight, opacity);
    d8 shown = d8_load(of + EWA_PLANE_OPACITY * LANES), by_weight = d8_load(of + EWA_PLANE_WEIGHT * LANES);
    for (int c = 0; c < 3; c++) {
        const d8 by_color = d8_load(of + (EWA_PLANE_COLOR + c) * LANES);
        gain(sums, scales, EWA_MOMENT_COLOR + c, d8_mul(shining, by_color));
        shown = d8_add(shown, d8_mul(d8_set(colors[c]), by_color));
    }
    if (width <= EWA_MOMENT_OPACITY) return;
    if (area->transparent) gain(sums, scales, EWA_MOMENT_OPACITY, d8_mul(s->weight, shown));
    for (int c = 0; c < 3; c++) {
        const d8 by_normal = d8_load(of + (EWA_PLANE_NORMAL + c) * LANES);
        gain(sums, scales, EWA_MOMENT_NORMAL + c, d8_mul(s->weight, by_normal));
        by_weight = d8_add(by_weight, d8_mul(d8_set(normals[c]), by_normal));
    }
    if (!plain && splat->by_rays) return;
    const d8 by_z = d8_load(of + EWA_PLANE_Z * LANES);
    by_weight = d8_add(by_weight, with_depth ? d8_add(d8_mul(opacity, shown), d8_mul(s->z, by_z)) : d8_mul(opacity, shown));
    if (!plain) by_weight = d8_add(by_weight, d8_keep(s->counts, by_cut(s, at->planes)));
    gain_kernel(splat, at, s, by_weight, scales, sums);
    if (with_depth) gain_depth(area, splat, at, s, by_z, scales, sums);
}

/// Adds whole numbers to totals, lane after lane, which no order changes.
EIGHT void total_sums(const d8 sums[EWA_MOMENT_COUNT], int64_t totals[EWA_MOMENT_COUNT]) {
    double lanes[EWA_MOMENT_COUNT][LANES];
    for (int m = 0; m < EWA_MOMENT_COUNT; m++) d8_store(lanes[m], d8_sub(sums[m], d8_set(WHOLE)));
    for (int m = 0; m < EWA_MOMENT_COUNT; m++) {
        const double *of = lanes[m];
        const double total = ((of[0] + of[4]) + (of[2] + of[6])) + ((of[1] + of[5]) + (of[3] + of[7]));
        // Of colours beyond all range nothing is known, but that every order gives the same.
        totals[m] += total > -0x1p52 && total < 0x1p52 ? (int64_t)total : 0;
    }
}

EIGHT void gather_splat(const ewa_adjoint_area *area, const ewa_reference_splat *splat, bool plain, bool kept,
                        const ewa_adjoint_samples *samples, const ewa_adjoint_visit *visit, uint32_t width, bool with_depth,
                        const double *scales, int64_t totals[EWA_MOMENT_COUNT]) {
    const block_range range = blocks_of(area, splat);
    const ewa_adjoint_sample *next = kept ? samples->items + visit->first : NULL;
    uint32_t index = 0;
    d8 sums[EWA_MOMENT_COUNT];
    bool any = false;
    for (int m = 0; m < EWA_MOMENT_COUNT; m++) sums[m] = d8_set(WHOLE);
    for (uint32_t row = range.first_row; row < range.end_row; row++)
        for (uint32_t column = range.first_column; column < range.end_column; column++, index++) {
            if (!is_in(visit->found, index)) continue;
            const ewa_adjoint_sample *of = kept ? next++ : NULL;
            if (!is_in(visit->counts, index)) continue;
            const block at = block_at(area, column, row);
            sample s;
            if (kept)
                s.weight = d8_load(of->weight), s.z = d8_load(of->z);
            else if (!sample_block(area, splat, &at, plain, &s) || !weigh_block(splat, &at, plain, &s))
                continue;
            any = true;
            gain_block(area, splat, &at, &s, plain, width, with_depth, scales, sums);
        }
    if (any) total_sums(sums, totals);
}

static void gather(const ewa_adjoint_area *area, const ewa_reference_splat *splat, const ewa_adjoint_samples *samples,
                   const ewa_adjoint_visit *visit, uint32_t width, bool with_depth, const double scales[EWA_MOMENT_COUNT],
                   int64_t totals[EWA_MOMENT_COUNT]) {
    const bool kept = visit->first != EWA_NO_SAMPLES;
    if (area->behind && splat->concave) return;
    if (!is_plain(splat))
        gather_splat(area, splat, false, false, samples, visit, width, with_depth, scales, totals);
    else if (kept && !with_depth && width > EWA_MOMENT_OPACITY && !area->transparent)
        gather_splat(area, splat, true, true, samples, visit, EWA_MOMENT_COUNT, false, scales, totals);
    else if (kept)
        gather_splat(area, splat, true, true, samples, visit, width, with_depth, scales, totals);
    else
        gather_splat(area, splat, true, false, samples, visit, width, with_depth, scales, totals);
}

const ewa_adjoint_kernels EWA_VERSION(ewa_adjoint_kernels) = {.find = find, .sum = sum, .gather = gather, .fill = fill};
