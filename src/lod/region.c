// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A region's points: sorted, made surfels, divided among its nodes.
//
// A node has a point of each of its 128^3 cells that has one left; nodes of few points have all that are
// left.
#include "lod/region.h"
#include "cloud/cloud.h"
#include "ewa/prepare.h"
#include "lod/codes.h"
#include "lod/records.h"

#include <math.h>
#include <string.h>

enum { TASK_POINTS = 1 << 13, TAKEN_NOT = 0xff };

static uint32_t task_count(uint64_t count) { return (uint32_t)((count + TASK_POINTS - 1) / TASK_POINTS); }

typedef struct load_job {
    const ewa_region_plan *plan;
    const uint8_t *records; ///< as they were spooled
    ewa_coded *items;
    ewa_region_points *points;
} load_job;

static void code_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const load_job *job = data;
    const ewa_statistics *statistics = job->plan->statistics;
    const uint32_t first = task * TASK_POINTS, left = job->points->count - first;
    const uint32_t end = first + (left < TASK_POINTS ? left : TASK_POINTS);
    for (uint32_t i = first; i < end; i++)
        job->items[i] = (ewa_coded){
            ewa_record_code(&statistics->lattice, job->records + (size_t)i * statistics->record_bytes), i};
}

static void order_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const load_job *job = data;
    const size_t from_bytes = job->plan->statistics->record_bytes, to_bytes = job->plan->record_bytes;
    const uint32_t first = task * TASK_POINTS, left = job->points->count - first;
    const uint32_t end = first + (left < TASK_POINTS ? left : TASK_POINTS);
    for (uint32_t i = first; i < end; i++) {
        job->points->codes[i] = job->items[i].code;
        memcpy(job->points->records + i * to_bytes, job->records + job->items[i].index * from_bytes,
               from_bytes);
    }
}

static void free_points(ewa_context *context, const ewa_region_plan *plan, ewa_region_points *points) {
    ewa_release(context, points->codes, points->capacity, sizeof *points->codes);
    ewa_release(context, points->records, points->capacity, plan->record_bytes);
    *points = (ewa_region_points){0};
}

/// Reads a region's points and sorts them.
static ewa_status load(ewa_region_plan *plan, ewa_distribution *distribution, ewa_region *region,
                       ewa_region_points *points) {
    ewa_context *context = plan->context;
    const uint32_t count = (uint32_t)region->own.count, from_bytes = plan->statistics->record_bytes;
    *points = (ewa_region_points){.count = count, .capacity = count};
    uint8_t *records = ewa_allocate(context, count, from_bytes);
    ewa_coded *items = ewa_allocate(context, count, sizeof *items),
              *spare = ewa_allocate(context, count, sizeof *spare);
    points->codes = ewa_allocate(context, count, sizeof *points->codes);
    ewa_status status = records && items && spare && points->codes ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = ewa_distribution_read(distribution, &region->own, from_bytes, records);
    load_job job = {plan, records, items, points};
    if (status == EWA_OK) {
        ewa_parallel(context, code_task, &job, task_count(count));
        ewa_codes_sort(context, items, spare, count, 3 * (EWA_CODE_LEVELS - (uint32_t)region->key.level));
    }
    ewa_release(context, spare, count, sizeof *spare);
    if (status == EWA_OK) {
        points->records = ewa_allocate(context, count, plan->record_bytes);
        if (!points->records) status = EWA_ERROR_MEMORY;
    }
    if (status == EWA_OK) ewa_parallel(context, order_task, &job, task_count(count));
    ewa_release(context, items, count, sizeof *items);
    ewa_release(context, records, count, from_bytes);
    return status;
}

typedef struct estimate_job {
    const ewa_region_plan *plan;
    ewa_region_points *points;
    const uint8_t *around;
    uint64_t all_count;
    int64_t middle[3]; ///< from the root's corner
    float *positions;
    const float *normals, *radii, *curvatures; ///< curvatures NULL: of a flat cloud
    const float *borders; ///< NULL: the surface does not end here
    float *own_normals; ///< to the sides of which curvatures are told; NULL: those that were made
} estimate_job;

static void position_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const estimate_job *job = data;
    const double step = job->plan->statistics->lattice.step_world;
    const uint64_t first = (uint64_t)task * TASK_POINTS, left = job->all_count - first;
    const uint64_t end = first + (left < TASK_POINTS ? left : TASK_POINTS);
    for (uint64_t i = first; i < end; i++) {
        const uint8_t *record = i < job->points->count
                                    ? job->points->records + i * job->plan->record_bytes
                                    : job->around + (i - job->points->count) * EWA_AROUND_BYTES;
        for (int c = 0; c < 3; c++)
            job->positions[3 * i + (uint64_t)c] =
                (float)((double)((int64_t)ewa_record_place(record, c) - job->middle[c]) * step);
    }
}

/// Puts what was estimated behind the records.
static void keep_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const estimate_job *job = data;
    const ewa_region_plan *plan = job->plan;
    const uint32_t first = task * TASK_POINTS, left = job->points->count - first;
    const uint32_t end = first + (left < TASK_POINTS ? left : TASK_POINTS);
    for (uint32_t i = first; i < end; i++) {
        uint8_t *record = job->points->records + (size_t)i * plan->record_bytes;
        if (plan->makes_normals)
            ewa_record_put_normal(record + plan->normal_at_bytes, job->normals + 3 * (size_t)i);
        if (plan->makes_radii) {
            static const float none[3] = {0};
            ewa_record_put_radius(record + plan->radius_at_bytes, job->radii[i]);
            ewa_record_put_border(record + plan->border_at_bytes, job->borders ? job->borders + 3 * (size_t)i : none);
        }
        if (!plan->makes_curvatures) continue;
        const float *made = job->normals + 3 * (size_t)i, *own = job->own_normals ? job->own_normals + 3 * (size_t)i : made;
        const float along = made[0] * own[0] + made[1] * own[1] + made[2] * own[2];
        const float curvature = job->curvatures ? job->curvatures[i] : 0;
        ewa_record_put_curvature(record + plan->curvature_at_bytes, along < 0 ? -curvature : curvature);
    }
}

/// The cloud of a region's points and those around it, with what orientation may need.
static ewa_status make_neighbourhood(const ewa_region_plan *plan, estimate_job *job, ewa_cloud **cloud) {
    const ewa_lattice *lattice = &plan->statistics->lattice;
    void *positions = NULL, *scans = NULL, *returns = NULL;
    double origin[3];
    for (int c = 0; c < 3; c++) origin[c] = ewa_lattice_world(lattice, c, lattice->low[c] + job->middle[c]);
    EWA_TRY(ewa_cloud_create(plan->context, job->all_count, cloud));
    EWA_TRY(ewa_cloud_add(*cloud, EWA_POSITION, EWA_F32, 3, &positions));
    ewa_cloud_set_origin(*cloud, origin);
    job->positions = positions;
    ewa_parallel(plan->context, position_task, job, task_count(job->all_count));
    if (!plan->makes_radii) { // what is there is not estimated
        void *radii = NULL;
        EWA_TRY(ewa_cloud_add(*cloud, EWA_RADIUS, EWA_F32, 1, &radii));
        memset(radii, 0, job->all_count * sizeof(float));
    }
    const ewa_attribute *scan = ewa_cloud_find(plan->inputs, "scan");
    size_t note_bytes = 0;
    const char *note = ewa_cloud_note(plan->inputs, "scanners", &note_bytes);
    if (note) EWA_TRY(ewa_cloud_set_note(*cloud, "scanners", note, note_bytes));
    if (note && scan && scan->type == EWA_U16 && scan->component_count == 1) {
        EWA_TRY(ewa_cloud_add(*cloud, "scan", EWA_U16, 1, &scans));
        for (uint64_t i = 0; i < job->all_count; i++) {
            uint8_t *to = (uint8_t *)scans + 2 * i;
            memset(to, 0, 2);
            if (i < job->points->count)
                ewa_record_get(plan, job->points->records + i * plan->record_bytes, "scan", to);
        }
    }
    if (ewa_cloud_find(plan->inputs, "return_number")) {
        EWA_TRY(ewa_cloud_add(*cloud, "return_number", EWA_U8, 1, &returns));
        memset(returns, 1, job->all_count);
    }
    return EWA_OK;
}

/// Gives the points normals, radii with borders, and curvatures.
static ewa_status estimate(ewa_region_plan *plan, ewa_distribution *distribution, ewa_region *region,
                           ewa_region_points *points) {
    if (!plan->makes_normals && !plan->makes_radii && !plan->makes_curvatures) return EWA_OK;
    ewa_context *context = plan->context;
    const uint64_t around_count = region->around.count;
    uint8_t *around = ewa_allocate(context, around_count, EWA_AROUND_BYTES);
    ewa_status status = around
                            ? ewa_distribution_read(distribution, &region->around, EWA_AROUND_BYTES, around)
                            : EWA_ERROR_MEMORY;
    estimate_job job = {
        .plan = plan, .points = points, .around = around, .all_count = points->count + around_count};
    const uint32_t bits = plan->statistics->lattice.bits;
    for (int c = 0; c < 3; c++)
        job.middle[c] = (int64_t)ldexp(region->key.cell[c] + 0.5, (int)bits - region->key.level);
    ewa_cloud *cloud = NULL;
    if (status == EWA_OK) status = make_neighbourhood(plan, &job, &cloud);
    ewa_release(context, around, around_count, EWA_AROUND_BYTES);
    ewa_estimate_options options;
    ewa_estimate_options_init(&options, sizeof options);
    if (status == EWA_OK) status = ewa_cloud_estimate(&cloud, &options);
    if (status == EWA_OK) {
        job.normals = ewa_cloud_find(cloud, EWA_NORMAL)->data;
        job.radii = ewa_cloud_find(cloud, EWA_RADIUS)->data;
        const ewa_attribute *curvature = ewa_cloud_find(cloud, EWA_CURVATURE);
        job.curvatures = curvature ? curvature->data : NULL;
        const ewa_attribute *border = ewa_cloud_find(cloud, EWA_BORDER);
        job.borders = border ? border->data : NULL;
    }
    const bool told = job.curvatures && plan->makes_curvatures && !plan->makes_normals;
    if (told) job.own_normals = ewa_allocate(context, points->count, 3 * sizeof(float));
    if (told && !job.own_normals) status = EWA_ERROR_MEMORY;
    if (status == EWA_OK) {
        if (told) ewa_records_read_normals(plan, points->records, points->count, job.own_normals);
        ewa_parallel(context, keep_task, &job, task_count(points->count));
    }
    ewa_release(context, job.own_normals, points->count, 3 * sizeof(float));
    ewa_cloud_destroy(&cloud);
    return status;
}

/// A number that looks random, from a code.
static uint64_t scramble(uint64_t code) {
    code = (code ^ code >> 30) * 0xbf58476d1ce4e5b9u;
    code = (code ^ code >> 27) * 0x94d049bb133111ebu;
    return code ^ code >> 31;
}

/// Gives to nodes of a level one point of each of their cells among the points [first, end) that has one left; returns how many.
static uint32_t pick(const ewa_region_points *points, uint32_t first, uint32_t end, uint32_t level,
                     uint8_t *taken) {
    const uint32_t cell_level = level + EWA_PAGE_BITS;
    uint32_t picked = 0;
    for (uint32_t i = first, next; i < end; i = next) {
        const uint64_t prefix = ewa_code_prefix(points->codes[i], cell_level);
        next = i + 1;
        while (next < end && ewa_code_prefix(points->codes[next], cell_level) == prefix) next++;
        const uint32_t count = next - i, start = (uint32_t)(scramble(prefix) % count);
        for (uint32_t k = 0; k < count; k++) {
            const uint32_t point = i + (start + k) % count;
            if (taken[point] != TAKEN_NOT) continue;
            taken[point] = (uint8_t)level;
            picked++;
            break;
        }
    }
    return picked;
}

static bool is_leaf(uint32_t count, uint32_t level) {
    return count <= EWA_PAGE_POINTS || level + EWA_PAGE_BITS >= EWA_CODE_LEVELS;
}

/// Divides the points [first, end) of a subtree among its root node and the nodes below.
static void divide(const ewa_region_points *points, uint32_t first, uint32_t end, uint32_t level,
                   uint8_t *taken) {
    if (is_leaf(end - first, level)) {
        for (uint32_t i = first; i < end; i++)
            if (taken[i] == TAKEN_NOT) taken[i] = (uint8_t)level;
        return;
    }
    pick(points, first, end, level, taken);
    for (uint32_t i = first, next; i < end; i = next) {
        const uint64_t prefix = ewa_code_prefix(points->codes[i], level + 1);
        next = i + 1;
        while (next < end && ewa_code_prefix(points->codes[next], level + 1) == prefix) next++;
        divide(points, i, next, level + 1, taken);
    }
}

/// Copies the records of the points of a level behind each other.
static ewa_status gather(const ewa_region_plan *plan, const ewa_region_points *points, const uint8_t *taken,
                         uint32_t level, ewa_buffer *to, uint32_t *count) {
    *count = 0;
    for (uint32_t i = 0; i < points->count; i++) *count += taken[i] == level;
    EWA_TRY(ewa_buffer_reserve(plan->context, to, *count, plan->record_bytes));
    uint8_t *records = to->data;
    for (uint32_t i = 0; i < points->count; i++) {
        if (taken[i] != level) continue;
        memcpy(records, points->records + (size_t)i * plan->record_bytes, plan->record_bytes);
        records += plan->record_bytes;
    }
    return EWA_OK;
}

static ewa_status make_nodes(ewa_region_plan *plan, const ewa_region *region, const ewa_region_points *points,
                             ewa_region_result *result) {
    const uint32_t own_level = (uint32_t)region->key.level;
    uint8_t *taken = ewa_allocate(plan->context, points->count, 1);
    if (!taken) return EWA_ERROR_MEMORY;
    memset(taken, TAKEN_NOT, points->count);
    for (uint32_t level = 0; level < own_level; level++) pick(points, 0, points->count, level, taken);
    divide(points, 0, points->count, own_level, taken);
    ewa_status status = EWA_OK;
    for (uint32_t level = 0; level < own_level && status == EWA_OK; level++)
        status = gather(plan, points, taken, level, &result->above[level], &result->above_counts[level]);
    ewa_buffer records = {0};
    for (uint32_t level = own_level; level < EWA_CODE_LEVELS && status == EWA_OK; level++) {
        uint32_t count;
        status = gather(plan, points, taken, level, &records, &count);
        if (status == EWA_OK && count) status = ewa_region_encode(plan, records.data, count, level, result);
    }
    ewa_buffer_free(plan->context, &records);
    ewa_release(plan->context, taken, points->count, 1);
    return status;
}

/// Makes what represents the points [first, end) of a node, and all pages below it.
static ewa_status make_pages(ewa_region_plan *plan, const ewa_region_points *points, uint32_t first,
                             uint32_t end, uint32_t level, ewa_region_result *result,
                             ewa_representatives *representatives) {
    const ewa_octree_key key = ewa_code_key(points->codes[first], level);
    if (is_leaf(end - first, level)) {
        const ewa_status status = ewa_records_to_representatives(
            plan, points->records + (size_t)first * plan->record_bytes, end - first, representatives);
        return status == EWA_OK ? ewa_region_page(plan, &key, end - first, NULL, 0, result, representatives)
                                : status;
    }
    ewa_representatives children[8] = {{0}};
    uint32_t child_count = 0;
    ewa_status status = EWA_OK;
    for (uint32_t i = first, next; i < end && status == EWA_OK; i = next) {
        const uint64_t prefix = ewa_code_prefix(points->codes[i], level + 1);
        next = i + 1;
        while (next < end && ewa_code_prefix(points->codes[next], level + 1) == prefix) next++;
        status = make_pages(plan, points, i, next, level + 1, result, &children[child_count++]);
    }
    if (status == EWA_OK)
        status = ewa_region_page(plan, &key, end - first, children, child_count, result, representatives);
    for (uint32_t i = 0; i < child_count; i++) ewa_representatives_free(plan->context, &children[i]);
    return status;
}

ewa_status ewa_region_make(ewa_region_plan *plan, ewa_distribution *distribution, ewa_region *region,
                           ewa_region_result *result) {
    ewa_region_points points;
    double before = ewa_now_s();
    plan->leaf_count = 0;
    ewa_status status = load(plan, distribution, region, &points);
    if (status == EWA_OK) status = estimate(plan, distribution, region, &points);
    double now = ewa_now_s();
    plan->estimate_s += now - before, before = now;
    if (status == EWA_OK) status = make_nodes(plan, region, &points, result);
    now = ewa_now_s();
    plan->encode_s += now - before, before = now;
    if (status == EWA_OK)
        status = make_pages(plan, &points, 0, points.count, (uint32_t)region->key.level, result,
                            &result->representatives);
    plan->merge_s += ewa_now_s() - before;
    free_points(plan->context, plan, &points);
    return status;
}
