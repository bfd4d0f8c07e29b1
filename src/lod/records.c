// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Records into clouds and surfels.
#include "lod/records.h"
#include "cloud/cloud.h"
#include "cloud/color.h"

#include <math.h>
#include <string.h>

enum { NORMAL_ONE = 32767, NORMAL_STEP = 16, TASK_POINTS = 1 << 12, MAX_BYTES = 32 };

void ewa_record_put_normal(uint8_t *to, const float normal[3]) {
    for (int c = 0; c < 3; c++) {
        const long code = lrintf(normal[c] * NORMAL_ONE / NORMAL_STEP) * NORMAL_STEP;
        const int16_t stored = (int16_t)(code > NORMAL_ONE    ? NORMAL_ONE
                                         : code < -NORMAL_ONE ? -NORMAL_ONE
                                                              : code);
        memcpy(to + 2 * c, &stored, sizeof stored);
    }
}

/// Stores a float without its last `dropped` bits, rounded.
static void put_shortened(uint8_t *to, float value, uint32_t dropped) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    bits = (bits + (1u << (dropped - 1))) & ~((1u << dropped) - 1);
    memcpy(to, &bits, sizeof bits);
}

void ewa_record_put_radius(uint8_t *to, float radius_world) { put_shortened(to, radius_world, 12); }

void ewa_record_put_curvature(uint8_t *to, float curvature) { put_shortened(to, curvature, 19); }

void ewa_record_put_border(uint8_t *to, const float border_world[3]) {
    for (int c = 0; c < 3; c++) put_shortened(to + 4 * c, border_world[c], 16);
}

/// Finds where the numbers of an attribute of the inputs are: in the record, or those that all points have.
static const uint8_t *find_numbers(const ewa_region_plan *plan, const uint8_t *record, uint32_t column) {
    const ewa_statistics_column *known = &plan->statistics->columns[column];
    return known->constant ? known->value : record + known->at_bytes;
}

/// Number of an attribute of the inputs among those that are no positions; UINT32_MAX: there is none of that name.
static uint32_t column_of(const ewa_region_plan *plan, const char *name) {
    uint32_t column = 0;
    for (uint32_t a = 0; a < ewa_cloud_attribute_count(plan->inputs); a++) {
        const ewa_attribute *attribute = ewa_cloud_attribute_at(plan->inputs, a);
        if (strcmp(attribute->name, name) == 0) return column;
        column += strcmp(attribute->name, EWA_POSITION) != 0;
    }
    return UINT32_MAX;
}

void ewa_record_get(const ewa_region_plan *plan, const uint8_t *record, const char *attribute, uint8_t *to) {
    const uint32_t column = column_of(plan, attribute);
    if (column != UINT32_MAX)
        memcpy(to, find_numbers(plan, record, column), plan->statistics->columns[column].size_bytes);
}

/// One stream of a cloud that is made.
typedef struct target {
    uint8_t *to;
    uint32_t size_bytes;
    uint32_t column;   ///< of the inputs
    uint32_t at_bytes; ///< in the record, where it was estimated
    enum { FROM_PLACE, FROM_COLUMN, FROM_BEHIND } from;
} target;

typedef struct cloud_job {
    const ewa_region_plan *plan;
    const uint8_t *records;
    uint32_t count, target_count;
    target *targets;
} cloud_job;

/// Copies `count` numbers of one size that are `stride_bytes` apart.
#define DEFINE_COPY(size)                                                                                        \
    static void copy_##size(uint8_t *to, const uint8_t *from, size_t stride_bytes, uint32_t count) {             \
        for (uint32_t i = 0; i < count; i++) memcpy(to + (size_t)i * (size), from + i * stride_bytes, (size));   \
    }

DEFINE_COPY(1)
DEFINE_COPY(2)
DEFINE_COPY(4)
DEFINE_COPY(12)

static void copy_numbers(uint8_t *to, uint32_t size_bytes, const uint8_t *from, size_t stride_bytes, uint32_t count) {
    switch (size_bytes) {
    case 1: copy_1(to, from, stride_bytes, count); return;
    case 2: copy_2(to, from, stride_bytes, count); return;
    case 4: copy_4(to, from, stride_bytes, count); return;
    case 12: copy_12(to, from, stride_bytes, count); return;
    }
    for (uint32_t i = 0; i < count; i++) memcpy(to + (size_t)i * size_bytes, from + i * stride_bytes, size_bytes);
}

static void fill_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const cloud_job *job = data;
    const ewa_lattice *lattice = &job->plan->statistics->lattice;
    const uint32_t first = task * TASK_POINTS, left = job->count - first;
    const uint32_t end = first + (left < TASK_POINTS ? left : TASK_POINTS);
    for (uint32_t t = 0; t < job->target_count; t++) {
        const target *made = &job->targets[t];
        const size_t record_bytes = job->plan->record_bytes;
        const uint8_t *record = job->records + first * record_bytes;
        uint8_t *to = made->to + (size_t)first * made->size_bytes;
        if (made->from == FROM_COLUMN) {
            const bool constant = job->plan->statistics->columns[made->column].constant;
            copy_numbers(to, made->size_bytes, find_numbers(job->plan, record, made->column), constant ? 0 : record_bytes, end - first);
            continue;
        }
        if (made->from == FROM_BEHIND) {
            copy_numbers(to, made->size_bytes, record + made->at_bytes, record_bytes, end - first);
            continue;
        }
        for (uint32_t i = first; i < end; i++, record += record_bytes, to += 3 * sizeof(double)) {
            double place[3];
            for (int c = 0; c < 3; c++)
                place[c] = (double)(lattice->low[c] + (int64_t)ewa_record_place(record, c)) * lattice->step_world;
            memcpy(to, place, sizeof place);
        }
    }
}

static ewa_status add_target(const ewa_region_plan *plan, ewa_cloud *cloud, const ewa_attribute *attribute,
                             target *made) {
    void *data = NULL;
    const ewa_status status =
        ewa_cloud_add(cloud, attribute->name, attribute->type, attribute->component_count, &data);
    *made = (target){.to = data,
                     .size_bytes = (uint32_t)(attribute->component_count * ewa_type_bytes(attribute->type)),
                     .from = FROM_COLUMN,
                     .column = column_of(plan, attribute->name)};
    if (strcmp(attribute->name, EWA_POSITION) == 0) {
        made->from = FROM_PLACE;
    } else if (plan->makes_normals && strcmp(attribute->name, EWA_NORMAL) == 0) {
        made->from = FROM_BEHIND, made->at_bytes = plan->normal_at_bytes;
    } else if (plan->makes_radii && strcmp(attribute->name, EWA_RADIUS) == 0) {
        made->from = FROM_BEHIND, made->at_bytes = plan->radius_at_bytes;
    } else if (plan->makes_curvatures && strcmp(attribute->name, EWA_CURVATURE) == 0) {
        made->from = FROM_BEHIND, made->at_bytes = plan->curvature_at_bytes;
    } else if (plan->makes_radii && strcmp(attribute->name, EWA_BORDER) == 0) {
        made->from = FROM_BEHIND, made->at_bytes = plan->border_at_bytes;
    }
    return status;
}

ewa_status ewa_records_to_cloud(const ewa_region_plan *plan, const uint8_t *records, uint32_t count,
                                ewa_cloud **piece) {
    const uint32_t target_count = ewa_cloud_attribute_count(plan->output);
    target *targets = ewa_allocate(plan->context, target_count, sizeof *targets);
    *piece = NULL;
    ewa_status status = targets ? ewa_cloud_create(plan->context, count, piece) : EWA_ERROR_MEMORY;
    for (uint32_t t = 0; t < target_count && status == EWA_OK; t++)
        status = add_target(plan, *piece, ewa_cloud_attribute_at(plan->output, t), &targets[t]);
    if (status == EWA_OK) {
        double origin[3];
        ewa_coordinate_grid grid;
        ewa_cloud_origin(plan->output, origin);
        ewa_cloud_grid(plan->output, &grid);
        ewa_cloud_set_origin(*piece, origin);
        ewa_cloud_set_grid(*piece, &grid);
        cloud_job job = {plan, records, count, target_count, targets};
        ewa_parallel(plan->context, fill_task, &job, (count + TASK_POINTS - 1) / TASK_POINTS);
    }
    ewa_release(plan->context, targets, target_count, sizeof *targets);
    if (status != EWA_OK) ewa_cloud_destroy(piece);
    return status;
}

/// Where the numbers of a surfel are.
typedef struct surfel_job {
    const ewa_region_plan *plan;
    const uint8_t *records;
    ewa_representative *items; ///< out; or
    float *normals;            ///< only these
    uint32_t count;
    uint32_t normal, radius, tangent_u, tangent_v, color, curvature; ///< columns; UINT32_MAX: none
    const ewa_attribute *normal_of, *radius_of, *tangent_of, *color_of, *curvature_of;
    ewa_color_table colors;
    double *numbers; ///< out, of attributes of the plan
    uint32_t number_columns[EWA_LEVELS_MAX_ATTRIBUTES];
    const ewa_attribute *number_of[EWA_LEVELS_MAX_ATTRIBUTES];
} surfel_job;

/// Reads the numbers of a column as doubles.
static void read_column(const surfel_job *job, const uint8_t *record, uint32_t column,
                        const ewa_attribute *of, double values[4]) {
    uint64_t aligned[MAX_BYTES / 8];
    memcpy(aligned, find_numbers(job->plan, record, column),
           job->plan->statistics->columns[column].size_bytes);
    ewa_attribute one = *of;
    one.data = aligned;
    ewa_attribute_read_f64(&one, 0, 1, values);
}

static void read_shape(const surfel_job *job, const uint8_t *record, ewa_representative *made) {
    static const double CUTOFF = 3; // of radii, as surfels are made with
    const ewa_region_plan *plan = job->plan;
    double normal[4] = {0}, radius[4] = {0};
    if (job->tangent_u != UINT32_MAX) {
        double u[4], v[4];
        read_column(job, record, job->tangent_u, job->tangent_of, u);
        read_column(job, record, job->tangent_v, job->tangent_of, v);
        for (int c = 0; c < 3; c++)
            normal[c] = u[(c + 1) % 3] * v[(c + 2) % 3] - u[(c + 2) % 3] * v[(c + 1) % 3];
        const double area = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
        radius[0] = CUTOFF * sqrt(area);
        if (job->normal != UINT32_MAX) read_column(job, record, job->normal, job->normal_of, normal);
    } else {
        if (plan->makes_normals) {
            int16_t codes[3];
            memcpy(codes, record + plan->normal_at_bytes, sizeof codes);
            for (int c = 0; c < 3; c++) normal[c] = codes[c];
        } else {
            read_column(job, record, job->normal, job->normal_of, normal);
        }
        if (plan->makes_radii) {
            float stored;
            memcpy(&stored, record + plan->radius_at_bytes, sizeof stored);
            radius[0] = (double)stored;
        } else {
            read_column(job, record, job->radius, job->radius_of, radius);
        }
    }
    const double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (int c = 0; c < 3; c++)
        made->normal[c] = length > 0 && isfinite(length) ? (float)(normal[c] / length) : c == 2;
    made->radius_world = radius[0] > 0 && isfinite(radius[0]) ? (float)radius[0] : 0;
}

static float read_curvature(const surfel_job *job, const uint8_t *record) {
    double value[4] = {0};
    float stored = 0;
    if (job->plan->makes_curvatures)
        memcpy(&stored, record + job->plan->curvature_at_bytes, sizeof stored);
    else if (job->curvature_of)
        read_column(job, record, job->curvature, job->curvature_of, value), stored = (float)value[0];
    return isfinite(stored) ? stored : 0;
}

static void representative_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const surfel_job *job = data;
    const ewa_lattice *lattice = &job->plan->statistics->lattice;
    const uint32_t first = task * TASK_POINTS, left = job->count - first;
    const uint32_t end = first + (left < TASK_POINTS ? left : TASK_POINTS);
    for (uint32_t i = first; i < end; i++) {
        const uint8_t *record = job->records + (size_t)i * job->plan->record_bytes;
        ewa_representative *made = &job->items[i];
        *made = (ewa_representative){.code = ewa_record_code(lattice, record), .alpha = 1};
        for (int c = 0; c < 3; c++) made->at_world[c] = ewa_record_place(record, c) * lattice->step_world;
        read_shape(job, record, made);
        made->curvature = read_curvature(job, record);
        double values[4] = {0}, linear[3] = {EWA_DEFAULT_GREY, EWA_DEFAULT_GREY, EWA_DEFAULT_GREY};
        if (job->color != UINT32_MAX) {
            read_column(job, record, job->color, job->color_of, values);
            ewa_color_decode(&job->colors, job->color_of, values, linear);
            made->alpha = (float)ewa_color_alpha(job->color_of, values);
        }
        for (int c = 0; c < 3; c++) made->color[c] = made->shown[c] = (float)linear[c];
        for (uint32_t a = 0; a < job->plan->attribute_count; a++) {
            read_column(job, record, job->number_columns[a], job->number_of[a], values);
            job->numbers[(size_t)i * job->plan->attribute_count + a] = values[0];
        }
    }
}

static surfel_job make_surfel_job(const ewa_region_plan *plan, const uint8_t *records, uint32_t count) {
    surfel_job job = {.plan = plan,
                      .records = records,
                      .count = count,
                      .normal = column_of(plan, EWA_NORMAL),
                      .radius = column_of(plan, EWA_RADIUS),
                      .tangent_u = column_of(plan, EWA_TANGENT_U),
                      .tangent_v = column_of(plan, EWA_TANGENT_V),
                      .color = column_of(plan, EWA_COLOR),
                      .curvature = column_of(plan, EWA_CURVATURE),
                      .normal_of = ewa_cloud_find(plan->inputs, EWA_NORMAL),
                      .radius_of = ewa_cloud_find(plan->inputs, EWA_RADIUS),
                      .tangent_of = ewa_cloud_find(plan->inputs, EWA_TANGENT_U),
                      .color_of = ewa_cloud_find(plan->inputs, EWA_COLOR),
                      .curvature_of = ewa_cloud_find(plan->inputs, EWA_CURVATURE)};
    if (job.color_of && job.color_of->component_count < 3) job.color = UINT32_MAX;
    if (job.tangent_v == UINT32_MAX) job.tangent_u = UINT32_MAX;
    for (uint32_t a = 0; a < plan->attribute_count; a++) {
        job.number_columns[a] = column_of(plan, plan->attributes[a].name);
        job.number_of[a] = ewa_cloud_find(plan->inputs, plan->attributes[a].name);
    }
    return job;
}

static void normal_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const surfel_job *job = data;
    const uint32_t first = task * TASK_POINTS, left = job->count - first;
    const uint32_t end = first + (left < TASK_POINTS ? left : TASK_POINTS);
    for (uint32_t i = first; i < end; i++) {
        ewa_representative made;
        read_shape(job, job->records + (size_t)i * job->plan->record_bytes, &made);
        memcpy(job->normals + 3 * (size_t)i, made.normal, sizeof made.normal);
    }
}

void ewa_records_read_normals(const ewa_region_plan *plan, const uint8_t *records, uint32_t count, float *normals) {
    surfel_job job = make_surfel_job(plan, records, count);
    job.normals = normals;
    ewa_parallel(plan->context, normal_task, &job, (count + TASK_POINTS - 1) / TASK_POINTS);
}

ewa_status ewa_records_to_representatives(const ewa_region_plan *plan, const uint8_t *records, uint32_t count,
                                          ewa_representatives *representatives) {
    const size_t number_count = plan->attribute_count;
    EWA_TRY(ewa_representatives_reserve(plan->context, representatives, count, plan->attribute_count));
    representatives->radius_scale = 1;
    representatives->unit_coverage = 0;
    surfel_job job = make_surfel_job(plan, records, count);
    job.items = representatives->items;
    job.numbers = representatives->numbers;
    ewa_color_table_make(&job.colors);
    ewa_parallel(plan->context, representative_task, &job, (count + TASK_POINTS - 1) / TASK_POINTS);
    representatives->count = 0; // what cannot be drawn is left out
    for (uint32_t i = 0; i < count; i++) {
        if (!(representatives->items[i].radius_world > 0)) continue;
        const uint32_t to = representatives->count++;
        representatives->items[to] = representatives->items[i];
        for (size_t a = 0; a < number_count; a++)
            representatives->numbers[to * number_count + a] = representatives->numbers[i * number_count + a];
    }
    return EWA_OK;
}
