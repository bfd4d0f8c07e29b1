// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Poisson-disc sampling by throwing darts: candidates even in area, sorted into cubic blocks; of blocks of
// one parity no two touch, so that their samples are thrown in parallel, each against a small grid of what
// is near. Corners first, then rows along sharp edges, then the inside.
//
// Based on L.-Y. Wei, "Parallel Poisson disk sampling", 2008, section 3: phase groups.
#include "mesh/poisson_disc.h"
#include "base/base.h"
#include "homogeneous/vec.h"
#include "math/generate_number.h"

#include <string.h>

enum {
    CORNERS = 0,      // the first throw
    ROWS = 1,         // the second
    INNER_THROWS = 4, // the rest; several, because what is thrown at once takes memory
    THROWS = 2 + INNER_THROWS,
    BLOCK_CELLS = 12, // along an edge of a block; a cell is as wide as the largest distance
    GRID_CELLS = BLOCK_CELLS + 2,
    HEADS = 1 << 12,       // of lists of samples: more than cells
    INNER_CANDIDATES = 12, // per point
    ROW_CANDIDATES = 8,    // per spacing of an edge
    TASK_CANDIDATES = 1 << 14,
    TASK_BLOCKS = 16,
    AHEAD = 4, // candidates
    ASKED_CANDIDATES = 1 << 14, // between two questions where one thread works
};

/// Steps of the sequence R2, 1/g and 1/g^2 with g^3 = g + 1, in units of 2^-64 (M. Roberts, "The unreasonable
/// effectiveness of quasirandom sequences", 2018).
#define R2_U 0xc13fa9a902a6328fu
#define R2_V 0x91e10da5c79e7b1du

/// Points of rows per spacing of an edge's side, less those of the inside whose place they take.
#define ROW_POINTS 0.55

static double throw_distance(uint32_t which) {
    return which == CORNERS ? 0.4 : which == ROWS ? MESH_ROW_DISTANCE : MESH_INNER_DISTANCE;
}

typedef struct sample_block {
    int32_t at[3];
    uint32_t neighbour[27]; // blocks around, itself in the middle; or NONE
    uint64_t first[THROWS]; // of its candidates
    uint32_t candidates[THROWS], accepted[THROWS];
} sample_block;

enum { NONE = UINT32_MAX, HIT = 1u << 31 };

/// A sample in the small grid of a worker; lengths in spacings, from the low corner of the block.
typedef struct grid_sample {
    float at[3], normal[3];
    float distance2; ///< that it keeps at most
    uint32_t part, next;
} grid_sample;

typedef struct poisson_scratch {
    uint32_t head[HEADS]; ///< by cell and part: see head_of()
    grid_sample *samples;
} poisson_scratch;

typedef struct poisson_job {
    const mesh_surface *surface;
    double spacing, cell, unit; // of the grid and of samples, in world units
    uint64_t key;
    poisson_sample
        *pool; // by throws and blocks: the samples so far, then the candidates of the present throw
    poisson_sample *thrown;             // candidates of the present throw, in order of area
    uint32_t *block_of;                 // of `thrown`
    uint64_t capacity, thrown_capacity; // of the pool and of `thrown`
    uint64_t offset;                    // where the present throw begins in the pool
    uint64_t throw_count[THROWS];
    uint64_t *row_first; // by edge: sums of row candidates
    uint32_t which;      // the present throw
    sample_block *blocks;
    uint32_t block_count, block_capacity;
    uint32_t *table; // hash of blocks
    size_t slots;
    uint32_t *turn; // blocks of the present parity
    uint32_t turn_count;
    poisson_scratch *scratch;
    uint32_t scratch_samples;
} poisson_job;

static double unit_of(uint64_t random) { return (double)(random >> 11) * 0x1p-53; }

static void point_of(const mesh_surface *surface, uint32_t triangle, ewa_vec3 p[3]) {
    const uint32_t *v = surface->mesh->triangles + 3 * (size_t)surface->source[triangle];
    for (int c = 0; c < 3; c++) p[c] = ewa_mesh_place(surface, v[c]);
}

/// Rounding may put a place a little out of the box.
static uint32_t sample_number(double place, double unit) {
    const double number = place / unit;
    return number >= 0x1p32 ? UINT32_MAX : number > 0 ? (uint32_t)number : 0;
}

static poisson_sample sample_at(const poisson_job *job, ewa_vec3 p, uint32_t triangle) {
    return (poisson_sample){
        {sample_number(p.x, job->unit), sample_number(p.y, job->unit), sample_number(p.z, job->unit)},
        triangle};
}

/// The point of a row at `along` (0 at a, 1 at b) of an edge, moved in by `inset`, but not out of the
/// triangle.
static poisson_sample row_sample(const poisson_job *job, const mesh_edge *edge, double along, double inset) {
    double room = edge->height_world;
    if (edge->foot > 0) room = fmin(room, edge->height_world * (along / edge->foot));
    if (edge->foot < 1) room = fmin(room, edge->height_world * ((1 - along) / (1 - edge->foot)));
    const ewa_vec3 a = vec3_load(edge->a), b = vec3_load(edge->b);
    const ewa_vec3 foot = vec3_add(vec3_scale(a, 1 - along), vec3_scale(b, along));
    return sample_at(job, vec3_add(foot, vec3_scale(vec3_load(edge->inward), fmin(inset, 0.95 * room))),
                     edge->triangle);
}

static double edge_length(const mesh_edge *edge) {
    return vec3_length(vec3_sub(vec3_load(edge->b), vec3_load(edge->a)));
}

/// Two candidates per edge: one at each end; where there is no corner the rows do.
static uint64_t fill_corners(const poisson_job *job, poisson_sample *samples) {
    const mesh_surface *surface = job->surface;
    const double inset = MESH_ROW_INSET * job->spacing;
    uint64_t count = 0;
    for (uint32_t e = 0; e < surface->edge_count; e++) {
        const mesh_edge *edge = &surface->edges[e];
        const double along = fmin(inset / edge_length(edge), 0.5);
        if (edge->corner_a) samples[count++] = row_sample(job, edge, along, inset);
        if (edge->corner_b) samples[count++] = row_sample(job, edge, 1 - along, inset);
    }
    return count;
}

static void fill_rows(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const poisson_job *job = data;
    const mesh_surface *surface = job->surface;
    const uint32_t parts = surface->edge_count / 64 + 1;
    const uint64_t end = ewa_split(surface->edge_count, parts, part + 1);
    for (uint64_t e = ewa_split(surface->edge_count, parts, part); e < end; e++) {
        const uint64_t first = job->row_first[e], count = job->row_first[e + 1] - first;
        for (uint64_t i = 0; i < count; i++) {
            const double along =
                ((double)i + unit_of(ewa_generate_random(job->key + ROWS, first + i))) / (double)count;
            job->thrown[first + i] =
                row_sample(job, &surface->edges[e], along, MESH_ROW_INSET * job->spacing);
        }
    }
}

static uint32_t inner_parts(const poisson_job *job) {
    return (uint32_t)(job->throw_count[job->which] / TASK_CANDIDATES + 1);
}

/// Candidate i lies in the triangle that has a random place of the i-th of equal shares of the area. Within a
/// triangle candidates of all throws together follow the sequence R2, shifted by chance, which leaves less
/// room between them than independent places, so that samples find nearly every gap.
static void fill_inside(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const poisson_job *job = data;
    const mesh_surface *surface = job->surface;
    const double *below = surface->area_below;
    const uint64_t count = job->throw_count[job->which], key = job->key + job->which;
    const uint64_t first = ewa_split(count, inner_parts(job), part),
                   end = ewa_split(count, inner_parts(job), part + 1);
    const double share = below[surface->triangle_count] / (double)count;
    uint32_t low = 0, high = surface->triangle_count - 1;
    while (low < high) { // the first triangle that ends behind the first share's begin
        const uint32_t middle = low + (high - low) / 2;
        if (below[middle + 1] > (double)first * share)
            high = middle;
        else
            low = middle + 1;
    }
    uint32_t triangle = low, loaded = NONE;
    uint64_t shift = 0;
    ewa_vec3 p[3] = {{0}};
    for (uint64_t i = first; i < end; i++) {
        const double target = ((double)i + unit_of(ewa_generate_random(key, i))) * share;
        while (triangle + 1 < surface->triangle_count && below[triangle + 1] <= target) triangle++;
        if (triangle != loaded) {
            point_of(surface, triangle, p);
            p[1] = vec3_sub(p[1], p[0]);
            p[2] = vec3_sub(p[2], p[0]);
            shift = ewa_generate_random(job->key, triangle);
            loaded = triangle;
        }
        const uint64_t number = i * INNER_THROWS + (job->which - ROWS - 1);
        const uint64_t u_bits = number * R2_U + shift, v_bits = number * R2_V + (shift << 32);
        double u = (double)(u_bits >> 32) * 0x1p-32, v = (double)(v_bits >> 32) * 0x1p-32;
        if (u + v > 1) u = 1 - u, v = 1 - v;
        job->thrown[i] =
            sample_at(job, vec3_add(p[0], vec3_add(vec3_scale(p[1], u), vec3_scale(p[2], v))), triangle);
    }
}

/// The cell of a sample along one axis.
static int64_t cell_of(const poisson_job *job, const poisson_sample *sample, int c) {
    return (int64_t)((double)sample->at[c] * job->unit / job->cell);
}

static size_t slot_of(const poisson_job *job, const int32_t at[3]) {
    uint64_t hash = 0;
    for (int c = 0; c < 3; c++) {
        hash = (hash ^ (uint32_t)at[c]) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    size_t slot = hash & (job->slots - 1);
    while (job->table[slot] != NONE && memcmp(job->blocks[job->table[slot]].at, at, 3 * sizeof *at) != 0)
        slot = (slot + 1) & (job->slots - 1);
    return slot;
}

/// Doubles the room for blocks, and the table, which stays at most a quarter full.
static ewa_status grow_blocks(poisson_job *job) {
    ewa_context *context = job->surface->context;
    const uint32_t capacity = job->block_capacity ? 2 * job->block_capacity : 1024;
    sample_block *blocks = ewa_allocate(context, capacity, sizeof *blocks);
    uint32_t *table = ewa_allocate(context, 4 * (size_t)capacity, sizeof *table);
    if (!blocks || !table) {
        ewa_release(context, blocks, capacity, sizeof *blocks);
        ewa_release(context, table, 4 * (size_t)capacity, sizeof *table);
        return EWA_ERROR_MEMORY;
    }
    if (job->block_count) memcpy(blocks, job->blocks, job->block_count * sizeof *blocks);
    ewa_release(context, job->blocks, job->block_capacity, sizeof *job->blocks);
    ewa_release(context, job->table, job->slots, sizeof *job->table);
    job->blocks = blocks;
    job->block_capacity = capacity;
    job->table = table;
    job->slots = 4 * (size_t)capacity;
    memset(table, 0xff, job->slots * sizeof *table);
    for (uint32_t b = 0; b < job->block_count; b++) table[slot_of(job, blocks[b].at)] = b;
    return EWA_OK;
}

/// How far the present throw is, `share` of it, among all.
static double progress_at(const poisson_job *job, double share) { return 0.1 * (job->which + share); }

static ewa_status tell(const poisson_job *job, double share) {
    return ewa_progress(job->surface->context, "sample", progress_at(job, share));
}

/// Runs tasks of the present throw from one share of it to another.
static ewa_status run_tasks(poisson_job *job, double begin, double end, ewa_task *task, uint32_t count) {
    return ewa_parallel_within(job->surface->context, "sample", progress_at(job, begin), progress_at(job, end), task, job,
                               count);
}

/// Finds the block of every candidate of the present throw, making new ones, and sorts them into the pool.
static ewa_status sort_candidates(poisson_job *job) {
    const uint64_t count = job->throw_count[job->which];
    int32_t last_at[3] = {-1, -1, -1};
    uint32_t last = NONE;
    for (uint64_t i = 0; i < count; i++) {
        if (i % ASKED_CANDIDATES == 0) EWA_TRY(tell(job, 0.1 + 0.1 * (double)i / (double)count));
        int32_t at[3];
        for (int c = 0; c < 3; c++) at[c] = (int32_t)(cell_of(job, &job->thrown[i], c) / BLOCK_CELLS);
        if (last == NONE || at[0] != last_at[0] || at[1] != last_at[1] || at[2] != last_at[2]) {
            if (job->block_count == job->block_capacity) {
                EWA_TRY(grow_blocks(job));
            }
            const size_t slot = slot_of(job, at);
            if (job->table[slot] == NONE) {
                job->table[slot] = job->block_count;
                sample_block *made = &job->blocks[job->block_count++];
                *made = (sample_block){0};
                memcpy(made->at, at, sizeof at);
            }
            last = job->table[slot];
            memcpy(last_at, at, sizeof at);
        }
        job->block_of[i] = last;
        job->blocks[last].candidates[job->which]++;
    }
    uint64_t first = job->offset;
    for (uint32_t b = 0; b < job->block_count; b++) {
        job->blocks[b].first[job->which] = first;
        first += job->blocks[b].candidates[job->which];
    }
    for (uint64_t i = 0; i < count; i++) {
        if (i % ASKED_CANDIDATES == 0) EWA_TRY(tell(job, 0.2));
        job->pool[job->blocks[job->block_of[i]].first[job->which]++] = job->thrown[i];
    }
    for (uint32_t b = 0; b < job->block_count; b++)
        job->blocks[b].first[job->which] -= job->blocks[b].candidates[job->which];
    return EWA_OK;
}

static void find_neighbours(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const poisson_job *job = data;
    const uint32_t parts = job->block_count / 256 + 1;
    const uint64_t end = ewa_split(job->block_count, parts, part + 1);
    for (uint64_t b = ewa_split(job->block_count, parts, part); b < end; b++) {
        sample_block *block = &job->blocks[b];
        for (int n = 0; n < 27; n++) {
            const int32_t at[3] = {block->at[0] + n % 3 - 1, block->at[1] + n / 3 % 3 - 1,
                                   block->at[2] + n / 9 - 1};
            block->neighbour[n] = job->table[slot_of(job, at)];
        }
    }
}

/// Room that the fullest block needs with what is around it.
static ewa_status make_scratch(poisson_job *job) {
    ewa_context *context = job->surface->context;
    uint64_t maximum = 0;
    for (uint32_t b = 0; b < job->block_count; b++) {
        uint64_t sum = 0;
        for (int n = 0; n < 27; n++) {
            const uint32_t other = job->blocks[b].neighbour[n];
            if (other == NONE) continue;
            for (uint32_t k = 0; k < job->which; k++) sum += job->blocks[other].accepted[k];
            sum += job->blocks[other].candidates[job->which];
        }
        if (sum > maximum) maximum = sum;
    }
    if (maximum <= job->scratch_samples) return EWA_OK;
    if (maximum >= NONE) return ewa_fail(context, EWA_ERROR_LIMIT, "sample: too many points in one place");
    const uint32_t workers = ewa_context_worker_count(context);
    for (uint32_t w = 0; w < workers; w++) {
        ewa_release(context, job->scratch[w].samples, job->scratch_samples, sizeof(grid_sample));
        job->scratch[w].samples = NULL;
    }
    job->scratch_samples = (uint32_t)maximum;
    for (uint32_t w = 0; w < workers; w++) {
        job->scratch[w].samples = ewa_allocate(context, job->scratch_samples, sizeof(grid_sample));
        if (!job->scratch[w].samples) return EWA_ERROR_MEMORY;
    }
    return EWA_OK;
}

/// The list of the samples of a part in a cell. Only samples of one part see each other, so that sheets of
/// many parts that meet in one cell, like the pages of a book, are kept apart: every part's lists begin at a
/// place of their own, and those few that share a list are told apart by conflict().
static uint32_t head_of(int32_t cell, uint32_t part) {
    return ((uint32_t)cell + (part * 0x9e3779b1u >> 16)) % HEADS;
}

/// Makes a sample one of the grid's; false when it is beside the grid.
static bool locate(const poisson_job *job, const sample_block *block, const poisson_sample *sample,
                   uint32_t which, grid_sample *made, int32_t *slot) {
    int32_t local[3];
    for (int c = 0; c < 3; c++) { // most samples of blocks around are beside it along the first axis
        const int64_t place = cell_of(job, sample, c) - (int64_t)BLOCK_CELLS * block->at[c] + 1;
        if (place < 0 || place >= GRID_CELLS) return false;
        local[c] = (int32_t)place;
    }
    for (int c = 0; c < 3; c++) {
        made->at[c] = (float)((double)sample->at[c] * job->unit / job->spacing -
                              (double)block->at[c] * (BLOCK_CELLS * job->cell / job->spacing));
        made->normal[c] = job->surface->normal[sample->triangle][c];
    }
    const float distance = (float)throw_distance(which);
    made->distance2 = distance * distance;
    made->part = job->surface->part[sample->triangle];
    *slot = (local[2] * GRID_CELLS + local[1]) * GRID_CELLS + local[0];
    return true;
}

/// Whether two samples of a smooth part are too near. Rows let others come as near as their own: gaps beside
/// them lack the kernels from beyond the edge. Sheets that face elsewhere or lie above each other do not see
/// each other.
static bool conflict(const grid_sample *a, const grid_sample *b) {
    if (a->part != b->part) return false;
    const float distance2 = a->distance2 < b->distance2 ? a->distance2 : b->distance2;
    const float d[3] = {b->at[0] - a->at[0], b->at[1] - a->at[1], b->at[2] - a->at[2]};
    const float d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    if (d2 >= distance2) return false;
    const float facing =
        a->normal[0] * b->normal[0] + a->normal[1] * b->normal[1] + a->normal[2] * b->normal[2];
    const float above = a->normal[0] * d[0] + a->normal[1] * d[1] + a->normal[2] * d[2];
    return facing > 0.5f && above * above < 0.25f * distance2;
}

static bool is_free(const poisson_scratch *scratch, const grid_sample *sample, int32_t slot) {
    static const int16_t order[3] = {0, -1, 1}; // the own cell first: most conflicts are there
    for (int z = 0; z < 3; z++)
        for (int y = 0; y < 3; y++)
            for (int x = 0; x < 3; x++) {
                const int32_t near = slot + (order[z] * GRID_CELLS + order[y]) * GRID_CELLS + order[x];
                for (uint32_t i = scratch->head[head_of(near, sample->part)]; i != NONE;
                     i = scratch->samples[i].next)
                    if (conflict(sample, &scratch->samples[i])) return false;
            }
    return true;
}

static void add_sample(poisson_scratch *scratch, uint32_t index, int32_t slot) {
    grid_sample *sample = &scratch->samples[index];
    uint32_t *head = &scratch->head[head_of(slot, sample->part)];
    sample->next = *head;
    *head = index;
}

static uint32_t greatest_divisor(uint32_t a, uint32_t b) {
    while (b) {
        const uint32_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

static void throw_block(const poisson_job *job, sample_block *block, poisson_scratch *scratch) {
    const uint32_t candidates = block->candidates[job->which];
    uint32_t used = 0;
    int32_t slot;
    if (!candidates) return;
    memset(scratch->head, 0xff, sizeof scratch->head);
    for (int n = 0; n < 27; n++) {
        if (block->neighbour[n] == NONE) continue;
        const sample_block *other = &job->blocks[block->neighbour[n]];
        for (uint32_t k = 0; k <= job->which; k++) {
            for (uint32_t i = 0; i < other->accepted[k]; i++) {
                if (!locate(job, block, &job->pool[other->first[k] + i], k, &scratch->samples[used], &slot))
                    continue;
                add_sample(scratch, used++, slot);
            }
        }
    }
    // Candidates come triangle by triangle; a stride near the golden section mixes them. Hits are marked by
    // the top bit of their triangle until all have been looked at.
    uint32_t stride = (uint32_t)(0.6180339887498949 * candidates) | 1, accepted = 0;
    while (greatest_divisor(stride, candidates) != 1) stride += 2;
    poisson_sample *own = job->pool + block->first[job->which];
    uint32_t at = 0, ahead = (uint32_t)((uint64_t)stride * AHEAD % candidates);
    for (uint32_t i = 0; i < candidates; i++) {
        grid_sample *sample = &scratch->samples[used];
        __builtin_prefetch(&own[ahead]); // the stride is longer than what processors foresee
        ahead = (uint32_t)(((uint64_t)ahead + stride) % candidates);
        if (locate(job, block, &own[at], job->which, sample, &slot) && is_free(scratch, sample, slot)) {
            add_sample(scratch, used++, slot);
            own[at].triangle |= HIT;
            accepted++;
        }
        at = (uint32_t)(((uint64_t)at + stride) % candidates);
    }
    uint32_t kept = 0;
    for (uint32_t i = 0; i < candidates; i++) {
        if (!(own[i].triangle & HIT)) continue;
        own[kept] = own[i];
        own[kept++].triangle &= ~HIT;
    }
    block->accepted[job->which] = accepted;
}

static void throw_blocks(void *data, uint32_t part, uint32_t worker) {
    const poisson_job *job = data;
    for (uint32_t i = part * TASK_BLOCKS; i < job->turn_count && i < (part + 1) * TASK_BLOCKS; i++)
        throw_block(job, &job->blocks[job->turn[i]], &job->scratch[worker]);
}

static ewa_status throw_all(poisson_job *job) {
    ewa_context *context = job->surface->context;
    EWA_TRY(run_tasks(job, 0.2, 0.2, find_neighbours, job->block_count / 256 + 1));
    EWA_TRY(make_scratch(job));
    job->turn = ewa_allocate(context, job->block_count, sizeof *job->turn);
    if (!job->turn) return EWA_ERROR_MEMORY;
    ewa_status status = EWA_OK;
    for (int32_t parity = 0; parity < 8 && status == EWA_OK; parity++) {
        job->turn_count = 0;
        for (uint32_t b = 0; b < job->block_count; b++) {
            const int32_t *at = job->blocks[b].at;
            if (((at[0] & 1) | (at[1] & 1) << 1 | (at[2] & 1) << 2) == parity)
                job->turn[job->turn_count++] = b;
        }
        status = run_tasks(job, 0.2 + 0.1 * parity, 0.3 + 0.1 * parity, throw_blocks,
                           (job->turn_count + TASK_BLOCKS - 1) / TASK_BLOCKS);
    }
    ewa_release(context, job->turn, job->block_count, sizeof *job->turn);
    job->turn = NULL;
    // What has hit moves together; the room of the rest is that of the next throw.
    for (uint32_t b = 0; b < job->block_count; b++) {
        sample_block *block = &job->blocks[b];
        const uint32_t accepted = block->accepted[job->which];
        memmove(job->pool + job->offset, job->pool + block->first[job->which], accepted * sizeof *job->pool);
        block->first[job->which] = job->offset;
        job->offset += accepted;
    }
    return status;
}

/// Numbers of candidates, and memory for them.
static ewa_status prepare(poisson_job *job) {
    const mesh_surface *surface = job->surface;
    ewa_context *context = surface->context;
    const double area = surface->area_below[surface->triangle_count];
    double extent = 0, rows = 0;
    for (int c = 0; c < 3; c++) extent = fmax(extent, surface->extent_world[c]);
    for (uint32_t e = 0; e < surface->edge_count; e++) {
        rows += ceil(ROW_CANDIDATES * edge_length(&surface->edges[e]) / job->spacing);
        job->throw_count[CORNERS] += surface->edges[e].corner_a + surface->edges[e].corner_b;
    }
    const double inner = ceil(INNER_CANDIDATES * area / (job->spacing * job->spacing)) + 64;
    const double limit = fmin((double)ewa_context_limits(context)->max_points * INNER_CANDIDATES, 4e9);
    if (!(inner + rows < limit) || !(extent / job->cell < 1e9))
        return ewa_fail(context, EWA_ERROR_LIMIT,
                        "sample: a spacing of %g gives about %.3g points, over the limit of %.3g",
                        job->spacing, ewa_mesh_poisson_estimate(surface, job->spacing),
                        limit / INNER_CANDIDATES);
    for (uint32_t k = ROWS + 1; k < THROWS; k++) job->throw_count[k] = (uint64_t)(inner / INNER_THROWS) + 1;
    job->row_first = ewa_allocate(context, (size_t)surface->edge_count + 1, sizeof *job->row_first);
    job->scratch = ewa_allocate_zeroed(context, ewa_context_worker_count(context), sizeof *job->scratch);
    if (!job->row_first || !job->scratch) return EWA_ERROR_MEMORY;
    job->row_first[0] = 0;
    for (uint32_t e = 0; e < surface->edge_count; e++)
        job->row_first[e + 1] =
            job->row_first[e] +
            (uint64_t)ceil(ROW_CANDIDATES * edge_length(&surface->edges[e]) / job->spacing);
    job->throw_count[ROWS] = job->row_first[surface->edge_count];
    for (uint32_t k = 0; k < THROWS; k++) {
        job->capacity += job->throw_count[k];
        if (job->throw_count[k] > job->thrown_capacity) job->thrown_capacity = job->throw_count[k];
    }
    job->pool = ewa_allocate(context, job->capacity, sizeof *job->pool);
    job->thrown = ewa_allocate(context, job->thrown_capacity, sizeof *job->thrown);
    job->block_of = ewa_allocate(context, job->thrown_capacity, sizeof *job->block_of);
    return job->pool && job->thrown && job->block_of ? EWA_OK : EWA_ERROR_MEMORY;
}

static ewa_status run(poisson_job *job) {
    ewa_status status = prepare(job);
    for (job->which = 0; job->which < THROWS && status == EWA_OK; job->which++) {
        status = tell(job, 0);
        if (status != EWA_OK || !job->throw_count[job->which]) continue;
        if (job->which == CORNERS)
            fill_corners(job, job->thrown);
        else if (job->which == ROWS)
            status = run_tasks(job, 0, 0.1, fill_rows, job->surface->edge_count / 64 + 1);
        else
            status = run_tasks(job, 0, 0.1, fill_inside, inner_parts(job));
        if (status == EWA_OK) status = sort_candidates(job);
        if (status == EWA_OK) status = throw_all(job);
    }
    return status;
}

double ewa_mesh_poisson_rows(const mesh_surface *surface) {
    double length = 0;
    for (uint32_t e = 0; e < surface->edge_count; e++) length += edge_length(&surface->edges[e]);
    return ROW_POINTS * length;
}

double ewa_mesh_poisson_estimate(const mesh_surface *surface, double spacing_world) {
    return surface->area_below[surface->triangle_count] / (spacing_world * spacing_world) +
           ewa_mesh_poisson_rows(surface) / spacing_world;
}

ewa_status ewa_mesh_sample_poisson_disc(const mesh_surface *surface, double spacing_world, uint64_t seed,
                                        poisson_sample **samples, uint64_t *capacity, uint64_t *count) {
    ewa_context *context = surface->context;
    poisson_job job = {.surface = surface, .spacing = spacing_world, .key = ewa_generate_random(seed, 0)};
    // A hair wider than the distance, so that rounding hides no conflict.
    job.cell = 1.0001 * MESH_INNER_DISTANCE * spacing_world;
    job.unit = ewa_mesh_poisson_unit(surface);
    const ewa_status status = run(&job);
    *samples = status == EWA_OK ? job.pool : NULL;
    *capacity = job.capacity;
    *count = job.offset;
    if (status != EWA_OK) ewa_release(context, job.pool, job.capacity, sizeof *job.pool);
    ewa_release(context, job.thrown, job.thrown_capacity, sizeof *job.thrown);
    ewa_release(context, job.block_of, job.thrown_capacity, sizeof *job.block_of);
    ewa_release(context, job.row_first, (size_t)surface->edge_count + 1, sizeof *job.row_first);
    for (uint32_t w = 0; job.scratch && w < ewa_context_worker_count(context); w++)
        ewa_release(context, job.scratch[w].samples, job.scratch_samples, sizeof(grid_sample));
    ewa_release(context, job.scratch, ewa_context_worker_count(context), sizeof *job.scratch);
    ewa_release(context, job.blocks, job.block_capacity, sizeof *job.blocks);
    ewa_release(context, job.table, job.slots, sizeof *job.table);
    return status;
}
