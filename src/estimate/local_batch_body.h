// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The part of local_body.h for places that are measured by many neighbours. They are few and far between:
// taken from several blocks, each with its own neighbours, they fill all lanes. Neighbours are in the order
// of their block, so that a place gives the same bytes in whatever company. No section of docs/math.md is
// about it.

/// Where no neighbour of a lane is: at the place itself, where it adds nothing.
static uint32_t fill_rows(local_batch *batch) {
    uint32_t maximum = 0;
    for (uint32_t lane = 0; lane < batch->lane_count; lane++)
        maximum = batch->count[lane] > maximum ? batch->count[lane] : maximum;
    for (uint32_t lane = 0; lane < EWA_BLOCK_LANES; lane++) {
        if (lane >= batch->lane_count) batch->count[lane] = 0;
        for (uint32_t i = batch->count[lane]; i < maximum; i++) {
            local_row *row = &batch->row[i];
            row->x[lane] = row->y[lane] = row->z[lane] = row->distance2[lane] = 0;
            row->value[lane] = 3e38f;
        }
    }
    return maximum;
}

static void collect_lane(const ewa_block *block, uint32_t from, int32_t inside[WORDS][EWA_BLOCK_LANES],
                         const float *values, local_batch *batch) {
    const uint32_t lane = batch->lane_count++;
    const float x = block->lane_x[from], y = block->lane_y[from], z = block->lane_z[from];
    local_row *row = batch->row;
    for (uint32_t begin = 0; begin < block->candidate_count; begin += WORD_BITS) {
        uint32_t word = (uint32_t)inside[begin / WORD_BITS][from];
        for (; word; word &= word - 1, row++) {
            const uint32_t i = begin + (uint32_t)__builtin_ctz(word);
            row->x[lane] = block->x[i] - x;
            row->y[lane] = block->y[i] - y;
            row->z[lane] = block->z[i] - z;
            row->distance2[lane] = block->distance2[i][from];
            row->value[lane] = values[block->place[i]];
            row->place[lane] = block->place[i];
        }
    }
    batch->count[lane] = (uint32_t)(row - batch->row);
    batch->place[lane] = block->first_place + from;
    batch->unit_world[lane] = block->unit_world;
}

static uint32_t collect(const ewa_block *block, uint32_t lanes, const float *values, local_batch *batch) {
    int32_t inside[WORDS][EWA_BLOCK_LANES];
    for (uint32_t begin = 0; begin < block->candidate_count; begin += WORD_BITS)
        wi_store(inside[begin / WORD_BITS], find_inside(block, begin));
    for (; lanes && batch->lane_count < EWA_BLOCK_LANES; lanes &= lanes - 1)
        collect_lane(block, (uint32_t)__builtin_ctz(lanes), inside, values, batch);
    return lanes;
}

static wf count_of(const local_batch *batch) {
    float count[EWA_BLOCK_LANES];
    for (uint32_t lane = 0; lane < EWA_BLOCK_LANES; lane++) count[lane] = (float)batch->count[lane];
    return wf_load(count);
}

/// By bisection in the logarithm: steps of 1 / 256 of the lane's range.
static void find_around(local_batch *batch, float around[EWA_BLOCK_LANES], float farthest2[EWA_BLOCK_LANES]) {
    enum { STEPS = 8, CHAINS = 4 }; // sums beside each other
    const uint32_t rows = fill_rows(batch);
    const wf count = count_of(batch), one = wf_set(1), half = wf_set(0.5f);
    wf low = wf_set(3e38f), high = wf_set(0);
    wf farthest = high;
    for (uint32_t i = 0; i < rows; i++) {
        const wf value = wf_load(batch->row[i].value);
        low = wf_min(low, value);
        high = wf_max(high, wf_keep(wf_lt(wf_set((float)i), count), value));
        farthest = wf_max(farthest, wf_load(batch->row[i].distance2));
    }
    wf_store(farthest2, farthest);
    low = wf_max(low, wf_set(1e-30f));
    high = wf_max(low, high);
    const wf wanted = wf_mul(count, half);
    for (int step = 0; step < STEPS; step++) {
        const wf middle = wf_mul(wf_sqrt(low), wf_sqrt(high));
        wf below[CHAINS] = {wf_set(0), wf_set(0), wf_set(0), wf_set(0)};
        for (uint32_t i = 0; i < rows; i++)
            below[i % CHAINS] =
                wf_add(below[i % CHAINS], wf_keep(wf_le(wf_load(batch->row[i].value), middle), one));
        const wm enough = wf_le(wanted, wf_add(wf_add(below[0], below[1]), wf_add(below[2], below[3])));
        high = wf_select(enough, middle, high);
        low = wf_select(enough, low, middle);
    }
    wf_store(around, high);
}

/// The cell as find_cell() has it, open, too, where no neighbour stands: beyond the border. Both ranges at
/// once would be more than there are registers, so a few neighbours at a time go into one, then into the
/// other.
static void find_enclosed_cell(const local_batch *batch, uint32_t rows, const frame *f, wf limit,
                               cell *made) {
    enum { FEW = 32 };
    const wf zero = wf_set(0), minimum = wf_set(ENCLOSED_COSINE);
    range inverted = empty_range(), cosines = empty_range();
    for (uint32_t begin = 0; begin < rows; begin += FEW) {
        const uint32_t left = rows - begin, count = left < FEW ? left : FEW;
        wf u[FEW], v[FEW];
        for (uint32_t i = 0; i < count; i++) {
            invert_row(&batch->row[begin + i], f, &u[i], &v[i]);
            widen(&inverted, u[i], v[i]);
        }
        for (uint32_t i = 0; i < count; i++) {
            const wf distance = wf_sqrt(wf_load(batch->row[begin + i].distance2));
            widen(&cosines, wf_mul(u[i], distance), wf_mul(v[i], distance));
        }
    }
    set_extents(made, &inverted, limit);
    for (int i = 0; i < DIRECTIONS; i++) {
        const int opposite = i + DIRECTIONS;
        made->shut[i] = wm_and(wm_not(made->open[i]), wf_le(minimum, cosines.high[i]));
        made->shut[opposite] =
            wm_and(wm_not(made->open[opposite]), wf_le(minimum, wf_sub(zero, cosines.low[i])));
    }
}

/// Turns a frame so that it has this normal.
static void turn_frame(frame *f, const float normal[3][EWA_BLOCK_LANES]) {
    f->normal = (vec){wf_load(normal[0]), wf_load(normal[1]), wf_load(normal[2])};
    const wm upright = wf_lt(wf_set(0.9f), wf_abs(f->normal.z));
    f->v = v_unit(v_cross(f->normal, v_select(upright, v_set(1, 0, 0), v_set(0, 0, 1))));
    f->u = v_cross(f->v, f->normal);
}

static void enclose(local_batch *batch, uint32_t wanted, const float normal[3][EWA_BLOCK_LANES],
                    const float limit[EWA_BLOCK_LANES], local_surface *surface) {
    const uint32_t rows = fill_rows(batch);
    moments m = no_moments();
    m.count = count_of(batch);
    sum_moments(batch, rows, &m);
    frame f = find_frame(&m);
    if (normal) turn_frame(&f, normal);
    const wf spacing = measure_plane(&m, &f, surface);
    wf_store(surface->lean, wf_div(wf_sqrt(v_dot(m.first, m.first)), wf_max(m.count, wf_set(1))));
    if (wanted & LOCAL_SHAPE) align_frame(batch, rows, &f);
    cell c;
    find_enclosed_cell(batch, rows, &f, wf_load(limit), &c);
    measure_cell(wanted, &c, &f, spacing, surface);
}
