// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The part of local_body.h that finds where a sampled surface ends: at a line across the tangent plane beyond
// which a place has no neighbours, where many would be if it went on. See docs/math.md section 5, borders;
// what it comes to is in docs/quality.md.

enum {
    BORDER_TURNS = 7, // of 9 degrees to either side of where most neighbours are missing
    BORDER_FINE = 2,  // of 3 degrees to either side of the best of these
};

// |mean offset| over the farthest distance: 0.42 at a straight border, 0.17 at half of that distance from it;
// 0.06 by chance.
static const float BORDER_LEAN = 0.12f;
// Spacings to either side of a place within which its neighbours tell the line: more would not follow a border
// that is curved, fewer tell less.
static const float BORDER_WIDTH = 4.0f;
// Neighbours that would be beyond the line: by chance there are none in e^-12 of all cases.
static const float BORDER_MISSING = 12.0f;
// How many of those one weighs that is there nevertheless, half a spacing beyond the line or more.
static const float BORDER_STRAY = 4.0f;
static const float BORDER_CLEAR = 0.5f;
// Spacings from the outermost neighbours to where the surface ends: of random ones, and of those in rows, each of
// which stands for its cell. They are in a row where so many are as far out as the outermost, to a quarter of a
// spacing; of random ones 2 or 3 are.
static const float BORDER_BEYOND = 0.2f, BORDER_BEYOND_ROW = 0.5f;
static const float BORDER_ROW_DEPTH = 0.25f, BORDER_ROW_LEAST = 4.0f, BORDER_ROW_SURE = 7.0f;

// cos and sin of i * 9 degrees, of i * 3 degrees
static const float TURN_X[BORDER_TURNS + 1] = {1,           0.987688341f, 0.951056516f, 0.891006524f,
                                               0.809016994f, 0.707106781f, 0.587785252f, 0.453990500f};
static const float TURN_Y[BORDER_TURNS + 1] = {0,           0.156434465f, 0.309016994f, 0.453990500f,
                                               0.587785252f, 0.707106781f, 0.809016994f, 0.891006524f};
static const float FINE_X[BORDER_FINE + 1] = {1, 0.998629535f, 0.994521895f};
static const float FINE_Y[BORDER_FINE + 1] = {0, 0.052335956f, 0.104528463f};

/// A direction in the tangent plane, and how far neighbours reach in it.
typedef struct outward {
    wf x, y, reach;
    wf cost; // the reach, and a little for the angle to where most neighbours are missing
} outward;

/// Replaces x and y of the rows by coordinates in the tangent plane, x towards where most neighbours are missing;
/// returns the two axes.
static void face_missing(local_batch *batch, uint32_t rows, const frame *f, vec axes[2]) {
    const wf zero = wf_set(0);
    wf u = zero, v = zero;
    for (uint32_t i = 0; i < rows; i++) {
        const vec d = row_offset(&batch->row[i]);
        u = wf_sub(u, v_dot(d, f->u));
        v = wf_sub(v, v_dot(d, f->v));
    }
    const wf length = wf_sqrt(wf_add(wf_mul(u, u), wf_mul(v, v)));
    const wf per = wf_div(wf_set(1), wf_max(length, wf_set(1e-30f)));
    u = wf_mul(u, per), v = wf_mul(v, per);
    axes[0] = v_add(v_scale(f->u, u), v_scale(f->v, v));
    axes[1] = v_sub(v_scale(f->v, u), v_scale(f->u, v));
    for (uint32_t i = 0; i < rows; i++) {
        const vec d = row_offset(&batch->row[i]);
        wf_store(batch->row[i].x, v_dot(d, axes[0]));
        wf_store(batch->row[i].y, v_dot(d, axes[1]));
    }
}

/// Takes a direction where neighbours reach less far in it.
static void try_direction(const local_batch *batch, uint32_t rows, wf x, wf y, wf width, wf turned,
                          outward *best) {
    wf reach = wf_set(0);
    for (uint32_t i = 0; i < rows; i++) {
        const wf px = wf_load(batch->row[i].x), py = wf_load(batch->row[i].y);
        const wf along = wf_add(wf_mul(px, x), wf_mul(py, y)), across = wf_sub(wf_mul(py, x), wf_mul(px, y));
        reach = wf_max(reach, wf_keep(wf_le(wf_abs(across), width), along));
    }
    const wf cost = wf_add(reach, turned);
    const wm better = wf_lt(cost, best->cost);
    *best = (outward){wf_select(better, x, best->x), wf_select(better, y, best->y),
                      wf_select(better, reach, best->reach), wf_select(better, cost, best->cost)};
}

static outward find_outward(const local_batch *batch, uint32_t rows, wf spacing) {
    const wf width = wf_mul(spacing, wf_set(BORDER_WIDTH));
    outward best = {wf_set(1), wf_set(0), wf_set(0), wf_set(3e38f)};
    for (int i = -BORDER_TURNS; i <= BORDER_TURNS; i++) {
        const int k = i < 0 ? -i : i;
        const wf turned = wf_mul(spacing, wf_set(4e-3f * (float)k));
        try_direction(batch, rows, wf_set(TURN_X[k]), wf_set(i < 0 ? -TURN_Y[k] : TURN_Y[k]), width, turned,
                      &best);
    }
    const outward middle = best;
    for (int i = -BORDER_FINE; i <= BORDER_FINE; i++) {
        const int k = i < 0 ? -i : i;
        if (k == 0) continue;
        const wf c = wf_set(FINE_X[k]), s = wf_set(i < 0 ? -FINE_Y[k] : FINE_Y[k]);
        const wf x = wf_sub(wf_mul(middle.x, c), wf_mul(middle.y, s));
        const wf y = wf_add(wf_mul(middle.y, c), wf_mul(middle.x, s));
        try_direction(batch, rows, x, y, width, wf_sub(middle.cost, middle.reach), &best);
    }
    return best;
}

/// Counts the neighbours that would be beyond the line if the surface went on: as many as on the other side,
/// as far away. Replaces x of the rows by how far they are in the direction.
static wf count_missing(local_batch *batch, uint32_t rows, const outward *out, wf clear) {
    const wf zero = wf_set(0), one = wf_set(1), beyond = wf_add(out->reach, clear);
    wf missing = zero;
    for (uint32_t i = 0; i < rows; i++) {
        local_row *row = &batch->row[i];
        const wf along = wf_add(wf_mul(wf_load(row->x), out->x), wf_mul(wf_load(row->y), out->y));
        wf_store(row->x, along);
        missing = wf_add(missing, wf_keep(wf_lt(beyond, wf_sub(zero, along)), one));
        missing = wf_sub(missing, wf_keep(wf_lt(beyond, along), wf_set(BORDER_STRAY)));
    }
    return missing;
}

/// Spacings from the outermost neighbours to the end of the surface.
static wf spacings_beyond(const local_batch *batch, uint32_t rows, const outward *out, wf spacing) {
    const wf width = wf_mul(spacing, wf_set(BORDER_WIDTH)), one = wf_set(1);
    const wf minimum = wf_sub(out->reach, wf_mul(spacing, wf_set(BORDER_ROW_DEPTH))), own = count_of(batch);
    wf count = wf_set(0);
    for (uint32_t i = 0; i < rows; i++) {
        const wf px = wf_load(batch->row[i].x), py = wf_load(batch->row[i].y);
        const wf along = wf_add(wf_mul(px, out->x), wf_mul(py, out->y)),
                 across = wf_sub(wf_mul(py, out->x), wf_mul(px, out->y));
        // Rows that a lane does not have are at its place, which may itself be among the outermost.
        const wm outermost = wm_and(wf_le(minimum, along), wf_lt(wf_set((float)i), own));
        count = wf_add(count, wf_keep(wm_and(outermost, wf_le(wf_abs(across), width)), one));
    }
    const wf slope = wf_set(1 / (BORDER_ROW_SURE - BORDER_ROW_LEAST));
    const wf share = wf_min(wf_max(wf_mul(wf_sub(count, wf_set(BORDER_ROW_LEAST)), slope), wf_set(0)), one);
    return wf_add(wf_set(BORDER_BEYOND), wf_mul(wf_set(BORDER_BEYOND_ROW - BORDER_BEYOND), share));
}

static uint32_t find_border(local_batch *batch, const local_surface *surface, const local_sizes *sizes,
                            local_border *border) {
    const wf farthest = wf_load(sizes->farthest), radius = wf_load(sizes->radius), spacing = wf_load(sizes->around);
    // What is farther off than discs on the other side of a gap could reach stays as open as it is.
    wm found = wf_le(wf_add(radius, wf_load(sizes->limit)), farthest);
    found = wm_and(found, wf_lt(wf_mul(farthest, wf_set(BORDER_LEAN)), wf_load(surface->lean)));
    found = wm_and(found, wf_lt(wf_load(surface->variation), wf_set((float)LOCAL_SURFACE_VARIATION)));
    if (!wm_bits(found)) return 0;
    const uint32_t rows = fill_rows(batch);
    frame f;
    turn_frame(&f, surface->normal);
    vec axes[2];
    face_missing(batch, rows, &f, axes);
    const outward out = find_outward(batch, rows, spacing);
    const wf known = wf_load(sizes->beyond), lies = spacings_beyond(batch, rows, &out, spacing);
    const wf end = wf_add(out.reach, wf_mul(spacing, wf_select(wf_lt(wf_set(0), known), known, lies)));
    const wf missing = count_missing(batch, rows, &out, wf_mul(spacing, wf_set(BORDER_CLEAR)));
    found = wm_and(found, wm_and(wf_le(wf_set(BORDER_MISSING), missing), wf_lt(end, radius)));
    v_store(border->direction, v_add(v_scale(axes[0], out.x), v_scale(axes[1], out.y)));
    wf_store(border->distance, end);
    return wm_bits(found);
}
