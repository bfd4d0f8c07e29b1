// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sorts by the upper digits into many buckets, then each of these.
#include "lod/codes.h"

#include <string.h>

enum { PARTS = 32, DIGIT_BITS = 11, BUCKETS = 1 << DIGIT_BITS, FEW = 48, BYTE = 256 };

typedef struct sort_job {
    ewa_coded *items, *spare;
    uint32_t count, shift;
    uint32_t places[PARTS][BUCKETS]; ///< counts, then where the next one goes
    uint32_t first[BUCKETS + 1];
} sort_job;

static uint32_t bucket_of(const sort_job *job, uint64_t code) {
    return (uint32_t)(code >> job->shift) & (BUCKETS - 1);
}

static void count_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    sort_job *job = data;
    memset(job->places[part], 0, sizeof job->places[part]);
    const uint64_t end = ewa_split(job->count, PARTS, part + 1);
    for (uint64_t i = ewa_split(job->count, PARTS, part); i < end; i++)
        job->places[part][bucket_of(job, job->items[i].code)]++;
}

static void scatter_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    sort_job *job = data;
    const uint64_t end = ewa_split(job->count, PARTS, part + 1);
    for (uint64_t i = ewa_split(job->count, PARTS, part); i < end; i++)
        job->spare[job->places[part][bucket_of(job, job->items[i].code)]++] = job->items[i];
}

static void insert_sort(ewa_coded *items, uint32_t count) {
    for (uint32_t i = 1; i < count; i++) {
        const ewa_coded item = items[i];
        uint32_t k = i;
        for (; k > 0 && items[k - 1].code > item.code; k--) items[k] = items[k - 1];
        items[k] = item;
    }
}

/// Sorts items of `from` by the bits below `bits`; the result is in `to`.
static void sort_bucket(ewa_coded *from, ewa_coded *to, uint32_t count, uint32_t bits) {
    if (count <= FEW) {
        memcpy(to, from, count * sizeof *to);
        insert_sort(to, count);
        return;
    }
    ewa_coded *source = from, *target = to;
    for (uint32_t shift = 0; shift < bits; shift += 8) {
        uint32_t counts[BYTE + 1] = {0};
        for (uint32_t i = 0; i < count; i++) counts[(source[i].code >> shift & 0xff) + 1]++;
        for (int d = 0; d < BYTE; d++) counts[d + 1] += counts[d];
        for (uint32_t i = 0; i < count; i++) target[counts[source[i].code >> shift & 0xff]++] = source[i];
        ewa_coded *swap = source;
        source = target, target = swap;
    }
    if (source != to) memcpy(to, source, count * sizeof *to);
}

static void sort_task(void *data, uint32_t bucket, uint32_t worker) {
    (void)worker;
    const sort_job *job = data;
    const uint32_t first = job->first[bucket];
    sort_bucket(job->spare + first, job->items + first, job->first[bucket + 1] - first, job->shift);
}

void ewa_codes_sort(ewa_context *context, ewa_coded *items, ewa_coded *spare, uint32_t count, uint32_t bits) {
    sort_job job = {
        .items = items, .spare = spare, .count = count, .shift = bits > DIGIT_BITS ? bits - DIGIT_BITS : 0};
    ewa_parallel(context, count_part, &job, PARTS);
    uint32_t place = 0;
    for (uint32_t b = 0; b < BUCKETS; b++) {
        job.first[b] = place;
        for (uint32_t part = 0; part < PARTS; part++) {
            const uint32_t counted = job.places[part][b];
            job.places[part][b] = place;
            place += counted;
        }
    }
    job.first[BUCKETS] = place;
    ewa_parallel(context, scatter_part, &job, PARTS);
    ewa_parallel(context, sort_task, &job, BUCKETS);
}
