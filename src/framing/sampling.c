// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Some points of a cloud, the same ones in whatever order the file has them: those of the smallest hashes.
#include "framing/sampling.h"
#include "base/base.h"
#include "cloud/cloud.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK_POINTS = 256 };

/// A point and the hash of its numbers, by which points are told apart.
typedef struct hashed_point {
    uint64_t hash, index;
} hashed_point;

/// Points whose hash is not over the limit. Where there is no more room, equal ones count once, half of the
/// room is kept and the limit sinks.
typedef struct collection {
    hashed_point *points;
    size_t count, capacity;
    uint64_t limit;
    bool overflowed; ///< there was no more room
} collection;

/// Mixes a number into a hash (the finish of splitmix64, Vigna 2015).
static uint64_t mix(uint64_t hash, double number) {
    const double plain = number + 0.0; // -0 is 0
    uint64_t bits;
    memcpy(&bits, &plain, sizeof bits);
    uint64_t z = hash ^ (bits + 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static int compare_points(const void *a, const void *b) {
    const hashed_point *left = a, *right = b;
    if (left->hash != right->hash) return left->hash < right->hash ? -1 : 1;
    return left->index < right->index ? -1 : left->index > right->index;
}

/// Leaves of equal points one, and of the others at most half of the room, those of the smallest hashes.
static void compact(collection *all) {
    qsort(all->points, all->count, sizeof *all->points, compare_points);
    size_t kept = 0;
    for (size_t i = 0; i < all->count && kept < all->capacity / 2; i++)
        if (kept == 0 || all->points[i].hash != all->points[kept - 1].hash)
            all->points[kept++] = all->points[i];
    all->count = kept;
    all->overflowed = true;
    if (kept == all->capacity / 2) all->limit = all->points[kept - 1].hash;
}

/// Takes all points of a cloud whose hash is not over the limit.
static void collect(const ewa_cloud *cloud, collection *all) {
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION),
                        *radius = ewa_cloud_find(cloud, EWA_RADIUS);
    const bool has_radius = radius && radius->component_count == 1;
    const uint64_t point_count = ewa_cloud_point_count(cloud);
    double block[3 * BLOCK_POINTS], radii[BLOCK_POINTS] = {0};
    for (uint64_t first = 0; first < point_count; first += BLOCK_POINTS) {
        const uint64_t count = point_count - first < BLOCK_POINTS ? point_count - first : BLOCK_POINTS;
        ewa_attribute_read_f64(position, first, count, block);
        if (has_radius) ewa_attribute_read_f64(radius, first, count, radii);
        for (uint64_t i = 0; i < count; i++) {
            const double *p = &block[3 * i];
            const uint64_t hash = mix(mix(mix(mix(0, p[0]), p[1]), p[2]), radii[i]);
            if (hash > all->limit || !isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2])) continue;
            if (all->count == all->capacity) compact(all);
            if (hash <= all->limit) all->points[all->count++] = (hashed_point){hash, first + i};
        }
    }
    if (all->overflowed) compact(all);
}

ewa_status ewa_sample_choose(const ewa_cloud *cloud, size_t wanted, point_sample *sample) {
    ewa_context *context = ewa_cloud_context(cloud);
    const uint64_t point_count = ewa_cloud_point_count(cloud);
    const bool some = point_count > wanted;
    const size_t room = some ? 2 * wanted : (size_t)point_count;
    *sample = (point_sample){.room = room};
    collection all = {
        .points = ewa_allocate(context, room, sizeof *all.points), .capacity = room, .limit = UINT64_MAX};
    sample->indices = ewa_allocate(context, room, sizeof *sample->indices);
    const bool done = all.points && sample->indices;
    if (done && some) all.limit = (uint64_t)(0x1p63 * ((double)wanted / (double)point_count)) * 2;
    if (done) collect(cloud, &all);
    // Too few only where many points are few different ones.
    if (done && some && all.count < wanted / 2) {
        all = (collection){.points = all.points, .capacity = room, .limit = UINT64_MAX};
        collect(cloud, &all);
    }
    for (size_t i = 0; done && i < all.count; i++) sample->indices[i] = all.points[i].index;
    sample->count = done ? all.count : 0;
    ewa_release(context, all.points, room, sizeof *all.points);
    return done ? EWA_OK : EWA_ERROR_MEMORY;
}

void ewa_sample_free(const ewa_cloud *cloud, point_sample *sample) {
    ewa_release(ewa_cloud_context(cloud), sample->indices, sample->room, sizeof *sample->indices);
    *sample = (point_sample){.count = 0};
}
