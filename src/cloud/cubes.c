// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Points in groups by cubes: strewn over buckets by a hash, grouped in each bucket by a small table.
#include "cloud/cubes.h"
#include "base/base.h"
#include "cloud/cloud.h"

#include <math.h>
#include <string.h>

enum { MAX_PARTS = 64, PART_POINTS = 1 << 14, BUCKET_POINTS = 1 << 10 };

/// Scrambles 64 bits (splitmix64 of Vigna, 2015).
static uint64_t scramble(uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

uint64_t ewa_hash3(const double numbers[3]) {
    uint64_t hash = 0;
    for (int c = 0; c < 3; c++) {
        const double number = numbers[c] + 0.0; // makes -0 into 0
        uint64_t bits;
        memcpy(&bits, &number, sizeof bits);
        hash = scramble(hash + 0x9e3779b97f4a7c15u + bits);
    }
    return hash;
}

int ewa_points_compare(const ewa_cloud *cloud, uint64_t a, uint64_t b) {
    double p[3], q[3];
    const ewa_attribute *attribute = ewa_cloud_find(cloud, EWA_POSITION);
    ewa_attribute_read_f64(attribute, a, 1, p);
    ewa_attribute_read_f64(attribute, b, 1, q);
    for (int c = 0; c < 3; c++)
        if (p[c] != q[c]) return p[c] < q[c] ? -1 : 1;
    for (uint32_t k = 0; (attribute = ewa_cloud_attribute_at(cloud, k)); k++) {
        const char *bytes = attribute->data;
        const int order = memcmp(bytes + a * attribute->stride_bytes, bytes + b * attribute->stride_bytes,
                                 attribute->component_count * ewa_type_bytes(attribute->type));
        if (order) return order;
    }
    return 0;
}

void ewa_cell_of(const ewa_cell_frame *frame, uint64_t point, double cell[3], double at_cells[3]) {
    ewa_attribute_read_f64(frame->position, point, 1, at_cells);
    for (int c = 0; c < 3; c++) {
        at_cells[c] = (at_cells[c] + frame->origin_world[c]) / frame->cell_world;
        cell[c] = floor(at_cells[c]);
    }
}

static void find_cube(const ewa_cell_frame *frame, uint64_t point, double cube[3]) {
    double at_cells[3];
    ewa_cell_of(frame, point, cube, at_cells);
    for (int c = 0; c < 3; c++) cube[c] = floor(cube[c] * frame->cubes_per_cell);
}

static bool same_cube(const double a[3], const double b[3]) {
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

typedef struct group_job {
    ewa_cubes *cubes;
    uint8_t *marks;
    uint64_t point_count;
    uint32_t parts;
    uint32_t *places; // [parts][bucket_count]: counts, then where the part's points go
    uint32_t *points; // [point_count], bucket by bucket
    uint32_t *groups; // [point_count]: of each place
} group_job;

static uint32_t bucket_of(const ewa_cubes *cubes, uint64_t hash) {
    return (uint32_t)((hash >> 32) * cubes->bucket_count >> 32);
}

/// Whether a point takes part; clears the mark of one that is nowhere.
static bool takes_part(const group_job *job, uint64_t point) {
    if (!job->marks[point]) return false;
    double p[3];
    ewa_attribute_read_f64(job->cubes->frame.position, point, 1, p);
    const bool finite = isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
    job->marks[point] = finite;
    return finite;
}

/// Counts or places the points of a part.
static void strew_part(const group_job *job, uint32_t part, bool placed) {
    uint32_t *places = job->places + (size_t)part * job->cubes->bucket_count;
    const uint64_t end = ewa_split(job->point_count, job->parts, part + 1);
    double last_cube[3] = {NAN, NAN, NAN};
    uint32_t bucket = 0;
    for (uint64_t i = ewa_split(job->point_count, job->parts, part); i < end; i++) {
        if (!takes_part(job, i)) continue;
        double cube[3];
        find_cube(&job->cubes->frame, i, cube);
        if (!same_cube(cube, last_cube)) {
            bucket = bucket_of(job->cubes, ewa_hash3(cube));
            memcpy(last_cube, cube, sizeof cube);
        }
        const uint32_t place = places[bucket]++;
        if (placed) job->points[place] = (uint32_t)i;
    }
}

static void count_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    strew_part(data, part, false);
}

static void place_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    strew_part(data, part, true);
}

/// First slot of a bucket's table, which has half as many again as the bucket has points, and one.
static uint64_t first_slot(const ewa_cubes *cubes, uint32_t bucket) {
    const uint64_t place = cubes->first_place[bucket];
    return place + place / 2 + bucket;
}

/// Finds the slot of a cube in a bucket's table, or the empty one where it belongs. `starts[g]` is a point of
/// group g, or, `placed`, the place of one.
static uint32_t *find_slot(const ewa_cubes *cubes, uint32_t bucket, uint64_t hash, const double cube[3],
                           bool placed) {
    const uint32_t *starts = cubes->starts + cubes->first_place[bucket];
    const uint64_t first = first_slot(cubes, bucket), size = first_slot(cubes, bucket + 1) - first;
    uint32_t *table = cubes->slots + first;
    uint64_t slot = (hash & UINT32_MAX) * size >> 32;
    for (;; slot = slot + 1 < size ? slot + 1 : 0) {
        if (!table[slot]) return &table[slot];
        const uint32_t start = starts[table[slot] - 1];
        double other[3];
        find_cube(&cubes->frame, placed ? cubes->order[start] : start, other);
        if (same_cube(cube, other)) return &table[slot];
    }
}

/// Groups the points of a bucket.
static void group_bucket(void *data, uint32_t bucket, uint32_t worker) {
    (void)worker;
    const group_job *job = data;
    ewa_cubes *cubes = job->cubes;
    const uint32_t begin = cubes->first_place[bucket], end = cubes->first_place[bucket + 1];
    memset(cubes->slots + first_slot(cubes, bucket), 0,
           (first_slot(cubes, bucket + 1) - first_slot(cubes, bucket)) * sizeof *cubes->slots);
    uint32_t *starts = cubes->starts + begin; // at first a point of each group
    uint32_t count = 0, group = 0;
    double last_cube[3] = {NAN, NAN, NAN};
    for (uint32_t place = begin; place < end; place++) {
        double cube[3];
        find_cube(&cubes->frame, job->points[place], cube);
        if (!same_cube(cube, last_cube)) {
            uint32_t *slot = find_slot(cubes, bucket, ewa_hash3(cube), cube, false);
            if (!*slot) {
                starts[count] = job->points[place];
                *slot = ++count;
            }
            group = *slot - 1;
            memcpy(last_cube, cube, sizeof cube);
        }
        job->groups[place] = group;
    }
    memset(starts, 0, count * sizeof *starts);
    for (uint32_t place = begin; place < end; place++) starts[job->groups[place]]++;
    for (uint32_t g = 0, sum = begin; g < count; g++) starts[g] = sum += starts[g]; // ends
    for (uint32_t place = end; place-- > begin;)
        cubes->order[--starts[job->groups[place]]] = job->points[place];
    cubes->cube_count[bucket] = count;
}

uint32_t ewa_cubes_find(const ewa_cubes *cubes, const double cube[3]) {
    const uint64_t hash = ewa_hash3(cube);
    const uint32_t bucket = bucket_of(cubes, hash), slot = *find_slot(cubes, bucket, hash, cube, true);
    return slot ? cubes->first_place[bucket] + slot - 1 : UINT32_MAX;
}

/// Turns the counts of parts and buckets into places.
static void sum_places(group_job *job) {
    ewa_cubes *cubes = job->cubes;
    uint32_t sum = 0;
    for (uint32_t bucket = 0; bucket < cubes->bucket_count; bucket++) {
        cubes->first_place[bucket] = sum;
        for (uint32_t part = 0; part < job->parts; part++) {
            uint32_t *place = &job->places[(size_t)part * cubes->bucket_count + bucket];
            const uint32_t count = *place;
            *place = sum;
            sum += count;
        }
    }
    cubes->first_place[cubes->bucket_count] = sum;
}

static uint64_t slot_capacity(const ewa_cubes *cubes) {
    return cubes->capacity + cubes->capacity / 2 + cubes->bucket_count;
}

ewa_status ewa_cubes_make(const ewa_cloud *cloud, const ewa_cell_frame *frame, uint8_t *marks,
                          ewa_cubes *cubes) {
    ewa_context *context = ewa_cloud_context(cloud);
    const uint64_t point_count = ewa_cloud_point_count(cloud), buckets = point_count / BUCKET_POINTS + 1,
                   parts = point_count / PART_POINTS + 1;
    *cubes = (ewa_cubes){.context = context, .frame = *frame, .capacity = point_count};
    cubes->bucket_count = buckets < EWA_MAX_BUCKETS ? (uint32_t)buckets : EWA_MAX_BUCKETS;
    group_job job = {.cubes = cubes,
                     .marks = marks,
                     .point_count = point_count,
                     .parts = parts < MAX_PARTS ? (uint32_t)parts : MAX_PARTS};
    const size_t place_count = (size_t)job.parts * cubes->bucket_count;
    job.places = ewa_allocate_zeroed(context, place_count, sizeof *job.places);
    job.points = ewa_allocate(context, point_count, sizeof *job.points);
    job.groups = ewa_allocate(context, point_count, sizeof *job.groups);
    cubes->order = ewa_allocate(context, point_count, sizeof *cubes->order);
    cubes->starts = ewa_allocate(context, point_count, sizeof *cubes->starts);
    cubes->slots = ewa_allocate(context, slot_capacity(cubes), sizeof *cubes->slots);
    const bool ready =
        job.places && job.points && job.groups && cubes->order && cubes->starts && cubes->slots;
    ewa_status status = ready ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = ewa_parallel_stoppable(context, "thinning", count_part, &job, job.parts);
    if (status == EWA_OK) {
        sum_places(&job);
        status = ewa_parallel_stoppable(context, "thinning", place_part, &job, job.parts);
    }
    if (status == EWA_OK)
        status = ewa_parallel_stoppable(context, "thinning", group_bucket, &job, cubes->bucket_count);
    ewa_release(context, job.groups, point_count, sizeof *job.groups);
    ewa_release(context, job.points, point_count, sizeof *job.points);
    ewa_release(context, job.places, place_count, sizeof *job.places);
    return status;
}

void ewa_cubes_free(ewa_cubes *cubes) {
    ewa_release(cubes->context, cubes->slots, slot_capacity(cubes), sizeof *cubes->slots);
    ewa_release(cubes->context, cubes->starts, cubes->capacity, sizeof *cubes->starts);
    ewa_release(cubes->context, cubes->order, cubes->capacity, sizeof *cubes->order);
}
