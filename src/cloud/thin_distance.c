// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Points that keep a distance: dart throwing among the points, block by block. Blocks of one of 8 colours
// have no neighbours of the same colour, so that they can be thinned at the same time.
//
// Based on R. L. Cook, "Stochastic sampling in computer graphics", 1986, section 5.
#include "base/base.h"
#include "cloud/cloud.h"
#include "cloud/cubes.h"
#include "cloud/marks.h"

#include <math.h>
#include <string.h>

enum {
    BLOCK_CELLS = 8,
    SIDE = BLOCK_CELLS + 2, ///< cells of a block and of the border around it
    CELLS = SIDE * SIDE * SIDE,
    CELL_KEPT = 8, ///< points as far from each other as a cell's edge that fit into it: its corners
    COLORS = 8,
    SMALL_RUN = 128,
};

/// Edge of a cell in distances: a little more, so that rounding leaves points that are too near in cells side
/// by side. Out to MAX_CELLS from the world's origin quotients are so exact.
static const double CELL_DISTANCES = 1 + 0x1p-10, MAX_CELLS = 0x1p40;

/// What a worker knows of the block in hand: the points that stay, in lists by cells.
typedef struct block_scratch {
    uint32_t node_count;
    uint32_t heads[CELLS]; ///< 0: none, else 1 + node
    struct {
        double position[3];
        uint32_t next, cell;
    } nodes[CELLS * CELL_KEPT];
} block_scratch;

typedef struct distance_job {
    const ewa_cloud *cloud;
    const ewa_cubes *cubes;
    double distance2;
    uint8_t *marks;
    uint64_t *turns;      ///< by places: hash and point, sorted by runs; of blocks that are done, what stays
    uint32_t *kept_count; ///< by number of the block
    uint8_t *far;         ///< by bucket: a point is too far out
    block_scratch *scratch;
    uint32_t color;
} distance_job;

static bool comes_before(const ewa_cloud *cloud, uint64_t a, uint64_t b) {
    if (a >> 32 != b >> 32) return a < b;
    return ewa_points_compare(cloud, a & UINT32_MAX, b & UINT32_MAX) < 0;
}

static void sift_down(const ewa_cloud *cloud, uint64_t *turns, uint32_t at, uint32_t count) {
    const uint64_t moved = turns[at];
    for (uint32_t child; (child = 2 * at + 1) < count; at = child) {
        if (child + 1 < count && comes_before(cloud, turns[child], turns[child + 1])) child++;
        if (!comes_before(cloud, moved, turns[child])) break;
        turns[at] = turns[child];
    }
    turns[at] = moved;
}

static void sort_heap(const ewa_cloud *cloud, uint64_t *turns, uint32_t count) {
    for (uint32_t i = count / 2; i-- > 0;) sift_down(cloud, turns, i, count);
    for (uint32_t end = count; end-- > 1;) {
        const uint64_t last = turns[0];
        turns[0] = turns[end];
        turns[end] = last;
        sift_down(cloud, turns, 0, end);
    }
}

/// Sorts by the 8 bits at `shift` and those below: long runs by their digits, in place, short ones and those
/// of one hash by comparing.
static void sort_turns(const ewa_cloud *cloud, uint64_t *turns, uint32_t count, int shift) {
    if (count <= SMALL_RUN || shift < 32) {
        sort_heap(cloud, turns, count);
        return;
    }
    uint32_t ends[256] = {0}, next[256];
    for (uint32_t i = 0; i < count; i++) ends[turns[i] >> shift & 255]++;
    for (uint32_t digit = 0, sum = 0; digit < 256; digit++) {
        next[digit] = sum;
        ends[digit] = sum += ends[digit];
    }
    for (uint32_t digit = 0; digit < 256; digit++)
        while (next[digit] < ends[digit]) {
            const uint64_t moved = turns[next[digit]];
            const uint32_t to = moved >> shift & 255;
            turns[next[digit]] = turns[next[to]];
            turns[next[to]++] = moved;
        }
    for (uint32_t digit = 0; digit < 256; digit++) {
        const uint32_t begin = digit ? ends[digit - 1] : 0;
        if (ends[digit] - begin > 1) sort_turns(cloud, turns + begin, ends[digit] - begin, shift - 8);
    }
}

/// Gives the points of a bucket's blocks their turns.
static void order_bucket(void *data, uint32_t bucket, uint32_t worker) {
    (void)worker;
    const distance_job *job = data;
    const ewa_cubes *cubes = job->cubes;
    for (uint32_t g = 0; g < cubes->cube_count[bucket]; g++) {
        const uint32_t number = cubes->first_place[bucket] + g;
        uint32_t count;
        const uint32_t *points = ewa_cubes_points(cubes, bucket, number, &count);
        uint64_t *turns = job->turns + cubes->starts[number];
        for (uint32_t i = 0; i < count; i++) {
            double cell[3], world[3];
            ewa_cell_of(&cubes->frame, points[i], cell, world);
            for (int c = 0; c < 3; c++)
                if (!(fabs(cell[c]) < MAX_CELLS)) job->far[bucket] = 1;
            ewa_attribute_read_f64(cubes->frame.position, points[i], 1, world);
            for (int c = 0; c < 3; c++) world[c] += cubes->frame.origin_world[c];
            turns[i] = (ewa_hash3(world) & ~(uint64_t)UINT32_MAX) | points[i];
        }
        sort_turns(job->cloud, turns, count, 56);
        job->kept_count[number] = 0;
    }
}

/// Adds a point that stays to the list of its cell.
static void add_node(block_scratch *scratch, uint32_t cell, const double position[3]) {
    const uint32_t node = scratch->node_count++;
    memcpy(scratch->nodes[node].position, position, 3 * sizeof *position);
    scratch->nodes[node].cell = cell;
    scratch->nodes[node].next = scratch->heads[cell];
    scratch->heads[cell] = node + 1;
}

/// The cell of a point among those of a block and its border; CELLS when it is in none.
static uint32_t local_cell(const ewa_cell_frame *frame, uint32_t point, const double block[3]) {
    double cell[3], at_cells[3];
    uint32_t local[3];
    ewa_cell_of(frame, point, cell, at_cells);
    for (int c = 0; c < 3; c++) {
        const double offset = cell[c] - block[c] * BLOCK_CELLS + 1;
        if (!(offset >= 0 && offset < SIDE)) return CELLS;
        local[c] = (uint32_t)offset;
    }
    return (local[2] * SIDE + local[1]) * SIDE + local[0];
}

/// Whether a point that stays is too near, in the 27 cells around `cell`: its own first, where most are.
static bool is_too_dense(const block_scratch *scratch, uint32_t cell, const double position[3],
                         double distance2) {
    static const int order[3] = {0, -1, 1};
    for (int k = 0; k < 27; k++) {
        const int step = (order[k / 9] * SIDE + order[k / 3 % 3]) * SIDE + order[k % 3];
        for (uint32_t next = scratch->heads[(int)cell + step]; next; next = scratch->nodes[next - 1].next) {
            const double *other = scratch->nodes[next - 1].position;
            double sum = 0;
            for (int c = 0; c < 3; c++) sum += (position[c] - other[c]) * (position[c] - other[c]);
            if (sum < distance2) return true;
        }
    }
    return false;
}

/// Adds what stays in the blocks around, as far as it is beside this one.
static void add_border(const distance_job *job, const double block[3], block_scratch *scratch) {
    const ewa_cubes *cubes = job->cubes;
    for (int k = 0; k < 27; k++) {
        const double beside[3] = {block[0] + k % 3 - 1, block[1] + k / 3 % 3 - 1, block[2] + k / 9 - 1};
        const uint32_t number = k == 13 ? UINT32_MAX : ewa_cubes_find(cubes, beside);
        if (number == UINT32_MAX) continue;
        const uint64_t *kept = job->turns + cubes->starts[number];
        for (uint32_t i = 0; i < job->kept_count[number]; i++) {
            const uint32_t point = (uint32_t)kept[i], cell = local_cell(&cubes->frame, point, block);
            double position[3];
            ewa_attribute_read_f64(cubes->frame.position, point, 1, position);
            if (cell < CELLS) add_node(scratch, cell, position);
        }
    }
}

static void thin_block(const distance_job *job, uint32_t number, uint32_t count, const double block[3],
                       block_scratch *scratch) {
    const ewa_cubes *cubes = job->cubes;
    uint64_t *turns = job->turns + cubes->starts[number];
    uint32_t kept = 0;
    add_border(job, block, scratch);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t point = (uint32_t)turns[i], cell = local_cell(&cubes->frame, point, block);
        double position[3];
        ewa_attribute_read_f64(cubes->frame.position, point, 1, position);
        const bool stays = !is_too_dense(scratch, cell, position, job->distance2);
        job->marks[point] = stays;
        if (!stays) continue;
        add_node(scratch, cell, position);
        turns[kept++] = turns[i];
    }
    job->kept_count[number] = kept;
    for (uint32_t node = 0; node < scratch->node_count; node++) scratch->heads[scratch->nodes[node].cell] = 0;
    scratch->node_count = 0;
}

/// Thins the blocks of a bucket that have the colour.
static void thin_bucket(void *data, uint32_t bucket, uint32_t worker) {
    const distance_job *job = data;
    const ewa_cubes *cubes = job->cubes;
    for (uint32_t g = 0; g < cubes->cube_count[bucket]; g++) {
        const uint32_t number = cubes->first_place[bucket] + g;
        uint32_t count, color = 0;
        const uint32_t *points = ewa_cubes_points(cubes, bucket, number, &count);
        double block[3], at_cells[3];
        ewa_cell_of(&cubes->frame, points[0], block, at_cells);
        for (int c = 0; c < 3; c++) {
            block[c] = floor(block[c] * cubes->frame.cubes_per_cell);
            color |= (uint32_t)((int64_t)block[c] & 1) << c;
        }
        if (color == job->color) thin_block(job, number, count, block, &job->scratch[worker]);
    }
}

/// Says which point is so far out that the distance means nothing there.
static ewa_status check_far(const distance_job *job, double distance_world) {
    for (uint32_t bucket = 0; bucket < job->cubes->bucket_count; bucket++)
        if (job->far[bucket])
            return ewa_fail(job->cubes->context, EWA_ERROR_NUMERIC,
                            "a distance of %g cannot be kept: coordinates are over %g", distance_world,
                            distance_world * MAX_CELLS);
    return EWA_OK;
}

static ewa_status thin(distance_job *job, double distance_world) {
    ewa_context *context = job->cubes->context;
    const uint32_t workers = ewa_context_worker_count(context), buckets = job->cubes->bucket_count;
    const uint64_t capacity = job->cubes->capacity;
    job->turns = ewa_allocate(context, capacity, sizeof *job->turns);
    job->kept_count = ewa_allocate(context, capacity, sizeof *job->kept_count);
    job->far = ewa_allocate_zeroed(context, buckets, sizeof *job->far);
    job->scratch = ewa_allocate(context, workers, sizeof *job->scratch);
    ewa_status status = EWA_ERROR_MEMORY;
    if (job->turns && job->kept_count && job->far && job->scratch) {
        for (uint32_t w = 0; w < workers; w++) {
            memset(job->scratch[w].heads, 0, sizeof job->scratch[w].heads);
            job->scratch[w].node_count = 0;
        }
        status = ewa_parallel_stoppable(context, "thinning", order_bucket, job, buckets);
        if (status == EWA_OK) status = check_far(job, distance_world);
        for (job->color = 0; job->color < COLORS && status == EWA_OK; job->color++)
            status = ewa_parallel_stoppable(context, "thinning", thin_bucket, job, buckets);
    }
    ewa_release(context, job->scratch, workers, sizeof *job->scratch);
    ewa_release(context, job->far, buckets, sizeof *job->far);
    ewa_release(context, job->kept_count, capacity, sizeof *job->kept_count);
    ewa_release(context, job->turns, capacity, sizeof *job->turns);
    return status;
}

ewa_status ewa_cloud_thin_distance(const ewa_cloud *cloud, double distance_world, uint8_t *marks) {
    if (!cloud || !marks) return EWA_ERROR_ARGUMENT;
    ewa_cell_frame frame = {.position = ewa_marks_position(cloud),
                            .cell_world = distance_world * CELL_DISTANCES,
                            .cubes_per_cell = 1.0 / BLOCK_CELLS};
    if (!frame.position) return EWA_ERROR_ARGUMENT;
    if (!(distance_world > 0) || !(distance_world * distance_world > 0) ||
        !isfinite(distance_world * distance_world))
        return ewa_fail(ewa_cloud_context(cloud), EWA_ERROR_ARGUMENT, "a distance of %g", distance_world);
    ewa_cloud_origin(cloud, frame.origin_world);
    ewa_cubes cubes;
    ewa_status status = ewa_cubes_make(cloud, &frame, marks, &cubes);
    distance_job job = {
        .cloud = cloud, .cubes = &cubes, .distance2 = distance_world * distance_world, .marks = marks};
    if (status == EWA_OK) status = thin(&job, distance_world);
    ewa_cubes_free(&cubes);
    return status;
}
