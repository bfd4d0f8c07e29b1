// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Gaps by what the kernels of all discs around add up to in them. That asks for the radii of all of these, so blocks
// leave the numbers of the places around for a second look.
#include "estimate/gaps.h"
#include "base/base.h"
#include "estimate/radii.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum {
    TASK_PLACES = 1 << 14,
    CHUNK_WORDS = 1 << 14, // 64 KiB
    HEAD_WORDS = 3,        // first place, places, discs, before the numbers of these
    SPACING_STEP = 2,      // of those around every so manieth is asked for its spacing
};

static const double PI = 3.141592653589793;
// What kernels in a gap are to add up to, of what a covered pixel expects: a fifth over tau, from which on pixels are opaque.
static const double OPAQUE_SHARE = 0.54;
// Of the limit of radii: three discs close a void that is four spacings wide.
static const double VOID_LIMIT = 1.27;
// Of a place's own spacing: what may be between places around it, where it lies at the rim of denser ones.
static const double DENSER = 1.2;
// Spacings. Cells that reach no farther have no gaps; those of square lattices reach 0.76 with the margin.
static const float CLOSED_REACH = 0.7f;

struct gap_chunk {
    gap_chunk *next;
    uint32_t used;
    uint32_t words[CHUNK_WORDS];
};

ewa_status ewa_gaps_make(ewa_context *context, uint32_t place_count, gap_set *made) {
    *made = (gap_set){.context = context, .place_count = place_count, .worker_count = ewa_context_worker_count(context)};
    made->corner = ewa_allocate(context, place_count, sizeof *made->corner);
    made->radius = ewa_allocate_zeroed(context, place_count, sizeof *made->radius);
    made->chunks = ewa_allocate_zeroed(context, made->worker_count, sizeof *made->chunks);
    return made->corner && made->radius && made->chunks ? EWA_OK : EWA_ERROR_MEMORY;
}

static void free_chunks(gap_set *set) {
    for (uint32_t w = 0; w < set->worker_count && set->chunks; w++)
        while (set->chunks[w]) {
            gap_chunk *next = set->chunks[w]->next;
            ewa_release(set->context, set->chunks[w], 1, sizeof **set->chunks);
            set->chunks[w] = next;
        }
}

void ewa_gaps_free(gap_set *set) {
    free_chunks(set);
    ewa_release(set->context, set->corner, set->place_count, sizeof *set->corner);
    ewa_release(set->context, set->radius, set->place_count, sizeof *set->radius);
    ewa_release(set->context, set->chunks, set->worker_count, sizeof *set->chunks);
    *set = (gap_set){0};
}

void ewa_gaps_set_corner(gap_set *set, uint32_t place, const local_surface *surface, uint32_t lane, double spacing) {
    const float steps = spacing > 0 ? (float)(GAP_CORNER_STEPS / spacing) : 0;
    for (int c = 0; c < 3; c++) {
        const float to = surface->corner[c][lane] * steps;
        set->corner[place][c] = (int16_t)(fabsf(to) <= INT16_MAX ? to : 0);
    }
}

/// Whether some cell reaches so far that there may be a gap, and all of them are of a surface.
static bool may_gape(const ewa_block *block, const local_surface *surface, uint32_t again) {
    bool far = again != 0;
    for (uint32_t lane = 0; lane < block->lane_count; lane++) {
        if ((double)surface->variation[lane] > LOCAL_SURFACE_VARIATION) return false;
        far |= surface->reach[lane] > CLOSED_REACH * fminf(surface->spacing[lane], surface->median_spacing);
    }
    return far;
}

void ewa_gaps_note(gap_set *set, const ewa_block *block, const local_surface *surface, uint32_t again, uint32_t worker) {
    for (uint32_t lane = 0; lane < block->lane_count; lane++) {
        const uint32_t place = block->first_place + lane;
        ewa_gaps_set_corner(set, place, surface, lane, again >> lane & 1 ? 0 : (double)surface->spacing[lane]);
    }
    if (!may_gape(block, surface, again)) return;
    const uint32_t words = HEAD_WORDS + block->candidate_count;
    gap_chunk *chunk = set->chunks[worker];
    if (!chunk || CHUNK_WORDS - chunk->used < words) {
        chunk = ewa_allocate(set->context, 1, sizeof *chunk);
        if (!chunk) {
            atomic_store_explicit(&set->failed, true, memory_order_relaxed);
            return;
        }
        chunk->next = set->chunks[worker], chunk->used = 0;
        set->chunks[worker] = chunk;
    }
    uint32_t *to = &chunk->words[chunk->used];
    to[0] = block->first_place, to[1] = block->lane_count, to[2] = block->candidate_count;
    memcpy(to + HEAD_WORDS, block->place, block->candidate_count * sizeof *to);
    chunk->used += words;
}

void ewa_gaps_need(gap_set *set, const uint8_t *notes, double cutoff) {
    uint64_t counts[RADIUS_NOTE_MAX + 1] = {0}, all = 0, below = 0;
    for (uint32_t place = 0; place < set->place_count; place++) {
        if (notes[place] & RADIUS_AGAIN) continue;
        counts[notes[place] >> RADIUS_NOTE_SHIFT]++, all++;
    }
    if (!all) return;
    uint32_t steps = 0;
    while ((below += counts[steps]) * 2 < all) steps++;
    // Notes are rounded up.
    const double sigma = ((double)steps - 0.5) / RADIUS_NOTE_RATIO / cutoff;
    set->needed = (float)(OPAQUE_SHARE * 2 * PI * sigma * sigma * (1 - exp(-0.5 * cutoff * cutoff)));
}

typedef struct gap_job {
    const gap_input *input;
    gap_set *set;
    const float *const *offsets; // of places, if these say all
    gap_chunk **chunks;          // of all workers
    uint32_t *end;               // by place: the border's, where there is one; NULL where no surface ends
} gap_job;

static void read_position(const gap_job *job, uint32_t place, double p[3]) {
    if (job->offsets)
        for (int c = 0; c < 3; c++) p[c] = (double)job->offsets[c][place];
    else
        ewa_neighbours_positions(job->input->neighbours, place, 1, (double(*)[3])p);
}

/// Fills in the discs.
static void read_discs(const gap_job *job, const uint32_t *places, uint32_t count, const double origin[3], double per_unit,
                       local_gaps *gaps) {
    float *const to[3] = {gaps->x, gaps->y, gaps->z};
    const float scale = (float)per_unit;
    for (int c = 0; c < 3 && job->offsets; c++) {
        const float *offset = job->offsets[c], from = (float)origin[c];
        for (uint32_t i = 0; i < count; i++) to[c][i] = (offset[places[i]] - from) * scale;
    }
    for (uint32_t i = 0; i < count && !job->offsets; i++) {
        double p[3];
        read_position(job, places[i], p);
        for (int c = 0; c < 3; c++) to[c][i] = (float)((p[c] - origin[c]) * per_unit);
    }
    for (uint32_t i = 0; i < count; i++) gaps->kernel[i] = job->set->radius[places[i]] * scale;
    gaps->count = count;
}

/// Lists the discs' places that are near a border; returns how many.
static uint32_t list_near(const gap_job *job, const uint32_t *places, uint32_t count, uint32_t near[EWA_BLOCK_CANDIDATES]) {
    uint32_t found = 0;
    for (uint32_t i = 0; i < count && job->end; i++) {
        near[found] = places[i];
        found += ewa_borders_is_near(job->input->borders, places[i]);
    }
    return found;
}

/// How far a place is from where the surface ends by what those around know of that. Its own line cuts its disc.
static double border_distance(const gap_job *job, uint32_t place, const double p[3], const uint32_t *near, uint32_t count) {
    const border_set *borders = job->input->borders;
    double least = INFINITY;
    if (!count || ewa_borders_is_near(borders, place)) return least;
    for (uint32_t i = 0; i < count; i++) {
        const float *to = borders->ends[job->end[near[i]]].to_world;
        double q[3], along = 0, square = 0;
        read_position(job, near[i], q);
        for (int c = 0; c < 3; c++) along += (p[c] - q[c]) * (double)to[c], square += (double)to[c] * (double)to[c];
        const double length = sqrt(square);
        if (length > 0) least = fmin(least, length - along / length);
    }
    return least;
}

/// Hands a radius to the points of a place.
static void set_radius(const gap_job *job, uint32_t place, float radius) {
    uint32_t count;
    const uint32_t *points = ewa_neighbours_points(job->input->neighbours, place, &count);
    for (uint32_t i = 0; i < count; i++) job->input->radius[points[i]] = radius;
}

static void close_block(const gap_job *job, const uint32_t *words, local_gaps *gaps) {
    const uint32_t first = words[0], lanes = words[1], count = words[2];
    const uint32_t *places = words + HEAD_WORDS;
    double around = 0, seen = 0, origin[3];
    for (uint32_t i = 0; i < count; i += SPACING_STEP) around += (double)job->input->spacing[places[i]], seen++;
    around /= seen;
    read_position(job, first, origin);
    const double per_unit = 1 / around;
    if (!(per_unit < (double)FLT_MAX)) return;
    read_discs(job, places, count, origin, per_unit, gaps);
    uint32_t near[EWA_BLOCK_CANDIDATES];
    const uint32_t near_count = list_near(job, places, count, near);
    for (uint32_t lane = 0; lane < EWA_BLOCK_LANES; lane++) {
        const uint32_t place = first + (lane < lanes ? lane : 0);
        const double step = (double)job->input->spacing[place] * per_unit / GAP_CORNER_STEPS;
        double p[3];
        read_position(job, place, p);
        const bool open = job->input->strewn[place];
        double reach2 = 0;
        for (int c = 0; c < 3; c++) {
            const double to = job->set->corner[place][c] * step;
            gaps->corner[c][lane] = (float)((p[c] - origin[c]) * per_unit + to);
            reach2 += to * to;
        }
        gaps->reach2[lane] = open ? 0 : (float)reach2;
        gaps->radius[lane] = (float)((double)job->set->radius[place] * per_unit);
        const double border = border_distance(job, place, p, near, near_count) * per_unit;
        const double apart = fmin(1, DENSER * (double)job->input->spacing[place] * per_unit);
        gaps->limit[lane] = (float)fmin(VOID_LIMIT * job->input->options->radius_limit * apart, border);
    }
    float grown[EWA_BLOCK_LANES];
    job->input->kernels->grow(gaps, job->set->needed, (float)job->input->options->cutoff, grown);
    for (uint32_t lane = 0; lane < lanes; lane++)
        if (grown[lane] > gaps->radius[lane]) set_radius(job, first + lane, (float)((double)grown[lane] * around));
}

static void close_chunk(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const gap_job *job = data;
    const gap_chunk *chunk = job->chunks[task];
    local_gaps gaps;
    for (uint32_t at = 0; at < chunk->used; at += HEAD_WORDS + chunk->words[at + 2]) close_block(job, &chunk->words[at], &gaps);
}

static void hand_out(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const gap_job *job = data;
    const uint32_t begin = task * TASK_PLACES;
    const uint32_t end = job->set->place_count - begin < TASK_PLACES ? job->set->place_count : begin + TASK_PLACES;
    for (uint32_t place = begin; place < end; place++) set_radius(job, place, job->set->radius[place]);
}

ewa_status ewa_gaps_close(gap_set *set, const gap_input *input) {
    ewa_context *context = set->context;
    gap_job job = {.input = input, .set = set, .offsets = ewa_neighbours_offsets(input->neighbours)};
    uint32_t chunk_count = 0, at = 0;
    for (uint32_t w = 0; w < set->worker_count; w++)
        for (const gap_chunk *chunk = set->chunks[w]; chunk; chunk = chunk->next) chunk_count++;
    job.chunks = ewa_allocate(context, chunk_count, sizeof *job.chunks);
    ewa_status status = job.chunks && !set->failed ? EWA_OK : EWA_ERROR_MEMORY;
    if (input->borders->end_count) {
        job.end = ewa_allocate(context, set->place_count, sizeof *job.end);
        if (!job.end) status = EWA_ERROR_MEMORY;
        for (uint32_t i = 0; i < input->borders->end_count && job.end; i++) job.end[input->borders->ends[i].place] = i;
    }
    if (status == EWA_OK)
        status = ewa_parallel_stoppable(context, "estimate", hand_out, &job, (set->place_count + TASK_PLACES - 1) / TASK_PLACES);
    if (status == EWA_OK && set->needed > 0) {
        for (uint32_t w = 0; w < set->worker_count; w++)
            for (gap_chunk *chunk = set->chunks[w]; chunk; chunk = chunk->next) job.chunks[at++] = chunk;
        status = ewa_parallel_stoppable(context, "estimate", close_chunk, &job, chunk_count);
    }
    ewa_release(context, job.chunks, chunk_count, sizeof *job.chunks);
    ewa_release(context, job.end, set->place_count, sizeof *job.end);
    return status;
}
