// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sums of A' W A by blocks of rows: a block that a photograph sees is written anew, with what was there.
#include "photos/normal.h"
#include "colors/gradient.h"

#include <math.h>
#include <string.h>

enum {
    OCTAVE_BINS = 16,
    OCTAVES = 256,
    BIN_COUNT = OCTAVES * OCTAVE_BINS,
    WAVE_BLOCKS = 64, ///< that are written anew at a time: what there was of them is in memory, too
};

/// What one worker needs for a row.
typedef struct ewa_normal_room {
    uint32_t *places; ///< [point]: where it is among those of the row, from 1 on; 0: not there
    uint32_t *found;  ///< [point]: those of the row
    double *sums;     ///< [point]: of each of them
} ewa_normal_room;

typedef struct add_job {
    ewa_normal *normal;
    const ewa_photo_view *view;
    const double *weight, *rest;
    uint32_t first;                ///< block of the wave
    ewa_normal_block made[WAVE_BLOCKS]; ///< of the wave; starts are counts at first
} add_job;

ewa_status ewa_normal_make(ewa_context *context, uint32_t count, ewa_normal *normal) {
    *normal = (ewa_normal){.context = context, .count = count, .worker_count = ewa_context_worker_count(context)};
    normal->blocks = ewa_allocate_zeroed(context, ewa_gradient_blocks(count), sizeof *normal->blocks);
    normal->sides = ewa_allocate_zeroed(context, (size_t)count * EWA_PHOTO_CHANNELS, sizeof *normal->sides);
    normal->rooms = ewa_allocate_zeroed(context, normal->worker_count, sizeof *normal->rooms);
    if (!normal->blocks || !normal->sides || !normal->rooms) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < normal->worker_count; i++) {
        ewa_normal_room *room = &normal->rooms[i];
        room->places = ewa_allocate_zeroed(context, count, sizeof *room->places);
        room->found = ewa_allocate(context, count, sizeof *room->found);
        room->sums = ewa_allocate(context, count, sizeof *room->sums);
        if (!room->places || !room->found || !room->sums) return EWA_ERROR_MEMORY;
    }
    return EWA_OK;
}

static void free_block(ewa_context *context, ewa_normal_block *block) {
    ewa_release(context, block->starts, EWA_GRADIENT_BLOCK_ROWS + 1, sizeof *block->starts);
    ewa_release(context, block->entries, block->capacity, sizeof *block->entries);
    *block = (ewa_normal_block){.starts = NULL};
}

void ewa_normal_free(ewa_normal *normal) {
    const uint32_t blocks = ewa_gradient_blocks(normal->count);
    for (uint32_t i = 0; normal->blocks && i < blocks; i++) free_block(normal->context, &normal->blocks[i]);
    for (uint32_t i = 0; normal->rooms && i < normal->worker_count; i++) {
        ewa_normal_room *room = &normal->rooms[i];
        ewa_release(normal->context, room->places, normal->count, sizeof *room->places);
        ewa_release(normal->context, room->found, normal->count, sizeof *room->found);
        ewa_release(normal->context, room->sums, normal->count, sizeof *room->sums);
    }
    ewa_release(normal->context, normal->rooms, normal->worker_count, sizeof *normal->rooms);
    ewa_release(normal->context, normal->blocks, blocks, sizeof *normal->blocks);
    ewa_release(normal->context, normal->sides, (size_t)normal->count * EWA_PHOTO_CHANNELS, sizeof *normal->sides);
}

/// Adds to a point's number in a row of `count` points.
static inline void add_number(ewa_normal_room *room, uint32_t *count, uint32_t point, double number) {
    if (!room->places[point]) {
        room->found[*count] = point, room->sums[*count] = 0;
        room->places[point] = ++*count;
    }
    room->sums[room->places[point] - 1] += number;
}

/// Makes the row of a point; returns how many points are in it.
static uint32_t make_row(const add_job *job, ewa_normal_room *room, uint32_t point, const ewa_normal_block *old, uint32_t row) {
    const ewa_photo_view *view = job->view;
    uint32_t count = 0;
    for (uint32_t i = old->starts ? old->starts[row] : 0; old->starts && i < old->starts[row + 1]; i++)
        add_number(room, &count, old->entries[i].index, (double)old->entries[i].weight);
    for (uint64_t i = view->point_starts[point]; i < view->point_starts[point + 1]; i++) {
        const uint32_t pixel = view->by_point[i].index;
        const double weighted = (double)view->by_point[i].weight * job->weight[pixel];
        for (uint64_t k = view->row_starts[pixel]; k < view->row_starts[pixel + 1]; k++)
            add_number(room, &count, view->entries[k].index, weighted * (double)view->entries[k].weight);
    }
    for (uint32_t i = 0; i < count; i++) room->places[room->found[i]] = 0;
    return count;
}

/// Whether a photograph sees points of a block.
static bool is_seen(const add_job *job, uint32_t block) {
    const uint32_t first = block * EWA_GRADIENT_BLOCK_ROWS, end = ewa_gradient_block_end(job->normal->count, block);
    return job->view->point_starts[first] < job->view->point_starts[end];
}

/// Counts the points of each row of a block.
static void count_block(void *data, uint32_t index, uint32_t worker) {
    add_job *job = data;
    const uint32_t block = job->first + index, first = block * EWA_GRADIENT_BLOCK_ROWS;
    uint32_t *starts = job->made[index].starts;
    if (!starts) return;
    for (uint32_t point = first; point < ewa_gradient_block_end(job->normal->count, block); point++)
        starts[point - first + 1] =
            make_row(job, &job->normal->rooms[worker], point, &job->normal->blocks[block], point - first);
}

/// Fills the rows of a block, and adds to their right sides.
static void fill_block(void *data, uint32_t index, uint32_t worker) {
    add_job *job = data;
    ewa_normal_room *room = &job->normal->rooms[worker];
    const uint32_t block = job->first + index, first = block * EWA_GRADIENT_BLOCK_ROWS;
    const ewa_normal_block *made = &job->made[index];
    if (!made->starts) return;
    for (uint32_t point = first; point < ewa_gradient_block_end(job->normal->count, block); point++) {
        const uint32_t count = make_row(job, room, point, &job->normal->blocks[block], point - first);
        ewa_photo_entry *to = made->entries + made->starts[point - first];
        for (uint32_t i = 0; i < count; i++) to[i] = (ewa_photo_entry){room->found[i], (float)room->sums[i]};
        double *side = job->normal->sides + (size_t)point * EWA_PHOTO_CHANNELS;
        for (uint64_t i = job->view->point_starts[point]; i < job->view->point_starts[point + 1]; i++) {
            const double *rest = job->rest + (size_t)job->view->by_point[i].index * EWA_PHOTO_CHANNELS;
            for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) side[c] += (double)job->view->by_point[i].weight * rest[c];
        }
    }
}

/// Makes room for the rows that have been counted.
static ewa_status place_rows(ewa_context *context, ewa_normal_block *block) {
    uint64_t sum = 0;
    for (uint32_t i = 1; i <= EWA_GRADIENT_BLOCK_ROWS; i++) {
        sum += block->starts[i];
        if (sum > UINT32_MAX)
            return ewa_fail(context, EWA_ERROR_LIMIT, "photos: more points overlap than there may be");
        block->starts[i] = (uint32_t)sum;
    }
    block->entries = ewa_allocate(context, sum, sizeof *block->entries);
    block->capacity = (uint32_t)sum;
    return block->entries ? EWA_OK : EWA_ERROR_MEMORY;
}

/// Writes `count` blocks anew.
static ewa_status run_wave(add_job *job, uint32_t count) {
    ewa_context *context = job->normal->context;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < count; i++) {
        job->made[i] = (ewa_normal_block){.starts = NULL};
        if (!is_seen(job, job->first + i) || status != EWA_OK) continue;
        job->made[i].starts = ewa_allocate_zeroed(context, EWA_GRADIENT_BLOCK_ROWS + 1, sizeof *job->made[i].starts);
        if (!job->made[i].starts) status = EWA_ERROR_MEMORY;
    }
    if (status == EWA_OK) ewa_parallel(context, count_block, job, count);
    for (uint32_t i = 0; i < count && status == EWA_OK; i++)
        if (job->made[i].starts) status = place_rows(context, &job->made[i]);
    if (status == EWA_OK) ewa_parallel(context, fill_block, job, count);
    for (uint32_t i = 0; i < count; i++) {
        if (status == EWA_OK && !job->made[i].starts) continue;
        ewa_normal_block *block = &job->normal->blocks[job->first + i];
        free_block(context, status == EWA_OK ? block : &job->made[i]);
        if (status == EWA_OK) *block = job->made[i];
    }
    return status;
}

ewa_status ewa_normal_add(ewa_normal *normal, const ewa_photo_view *view, const double *weight, const double *rest) {
    const uint32_t blocks = ewa_gradient_blocks(normal->count);
    add_job job = {.normal = normal, .view = view, .weight = weight, .rest = rest};
    for (; job.first < blocks; job.first += WAVE_BLOCKS)
        EWA_TRY(run_wave(&job, blocks - job.first < WAVE_BLOCKS ? blocks - job.first : WAVE_BLOCKS));
    return EWA_OK;
}

double ewa_normal_median(const ewa_normal *normal) {
    uint64_t bins[BIN_COUNT] = {0}, total = 0, below = 0;
    for (uint32_t point = 0; point < normal->count; point++) {
        const ewa_normal_block *block = &normal->blocks[point / EWA_GRADIENT_BLOCK_ROWS];
        const uint32_t row = point % EWA_GRADIENT_BLOCK_ROWS;
        for (uint32_t i = block->starts ? block->starts[row] : 0; block->starts && i < block->starts[row + 1]; i++) {
            if (block->entries[i].index != point) continue;
            int exponent;
            const double part = frexp((double)block->entries[i].weight, &exponent);
            const int bin = (exponent + OCTAVES / 2) * OCTAVE_BINS + (int)((part - 0.5) * 2 * OCTAVE_BINS);
            if (bin >= 0 && bin < BIN_COUNT && part > 0) bins[bin]++, total++;
        }
    }
    int bin = 0;
    while (bin < BIN_COUNT - 1 && 2 * (below += bins[bin]) < total) bin++;
    return total ? ldexp(0.5 + 0.5 * (bin % OCTAVE_BINS) / OCTAVE_BINS, bin / OCTAVE_BINS - OCTAVES / 2) : 0;
}
