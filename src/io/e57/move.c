// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From the numbers of a scan's fields to attributes: coordinates by the scan's pose, colours by their range.
#include "io/e57/e57.h"

#include <math.h>
#include <string.h>

/// The rotation of a quaternion of any length; false when it has none.
static bool rotation_of(const double q[4], double turn[9]) {
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length > 0) || !isfinite(length)) return false;
    const double w = q[0] / length, x = q[1] / length, y = q[2] / length, z = q[3] / length;
    const double rows[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                            2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                            2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    memcpy(turn, rows, sizeof rows);
    return true;
}

void ewa_e57_plan_make(const ewa_e57_contents *contents, const ewa_e57_columns *columns, uint32_t scan,
                       ewa_e57_plan *plan) {
    const ewa_e57_scan *s = ewa_e57_scan_at(contents, scan);
    const ewa_e57_field *fields = ewa_e57_fields_of(contents, s);
    *plan = (ewa_e57_plan){
        .columns = columns, .scan = s, .scan_index = scan, .turn = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    for (int role = 0; role < EWA_E57_ROLES; role++)
        plan->fields[role] = ewa_e57_find(contents, s, (ewa_e57_role)role);
    for (uint32_t k = 0; k < columns->count; k++) {
        plan->column_fields[k] = -1;
        for (uint32_t i = 0; i < s->field_count; i++)
            if (fields[i].role == EWA_E57_OTHER && strcmp(fields[i].name, columns->columns[k].name) == 0)
                plan->column_fields[k] = (int)i;
        const ewa_e57_column *column = &columns->columns[k];
        if (column->role != EWA_E57_RED || column->component_count != 3) continue;
        for (int c = 0; c < 3 && plan->fields[EWA_E57_RED + c] >= 0; c++) {
            const ewa_e57_limits range = ewa_e57_color_range(contents, s, c);
            plan->color_low[c] = range.low;
            plan->color_factor[c] = (column->type == EWA_U8 ? 255 : 65535) / (range.high - range.low);
        }
    }
    ewa_e57_has_place(contents, s, &plan->spherical);
    plan->may_drop =
        plan->fields[plan->spherical ? EWA_E57_SPHERICAL_INVALID : EWA_E57_CARTESIAN_INVALID] >= 0;
    for (int c = 0; c < 3; c++) {
        const int field = plan->fields[(plan->spherical ? EWA_E57_RANGE : EWA_E57_X) + c];
        plan->may_drop |= field >= 0 && fields[field].kind == EWA_E57_FLOAT;
    }
    if (s->has_pose) rotation_of(s->rotation, plan->turn);
    for (int c = 0; c < 3; c++) {
        plan->shift[c] = (s->has_pose ? s->translation_world[c] : 0) - columns->origin_world[c];
        for (int k = 0; k < 3; k++) plan->moved |= plan->turn[3 * c + k] != (c == k);
    }
}

uint32_t ewa_e57_list(const ewa_e57_plan *plan, const ewa_e57_streams *streams, uint64_t first, uint64_t end,
                      uint16_t kept[EWA_E57_CHUNK_RECORDS], uint64_t *lost_count) {
    const uint32_t count = (uint32_t)(end - first);
    uint8_t keep[EWA_E57_CHUNK_RECORDS];
    double numbers[EWA_E57_CHUNK_RECORDS];
    memset(keep, 1, sizeof keep);
    *lost_count = 0;
    const int state = plan->fields[plan->spherical ? EWA_E57_SPHERICAL_INVALID : EWA_E57_CARTESIAN_INVALID];
    if (state >= 0) {
        ewa_e57_numbers(streams, (uint32_t)state, first, count, 0, numbers);
        for (uint32_t i = 0; i < count; i++) keep[i] = numbers[i] == 0;
    }
    for (int c = 0; c < 3 && plan->may_drop; c++) {
        const int field = plan->fields[(plan->spherical ? EWA_E57_RANGE : EWA_E57_X) + c];
        if (streams->fields[field].kind != EWA_E57_FLOAT) continue;
        ewa_e57_numbers(streams, (uint32_t)field, first, count, 0, numbers);
        for (uint32_t i = 0; i < count; i++) keep[i] &= numbers[i] - numbers[i] == 0;
    }
    const ewa_e57_gap *gaps = streams->gaps.data;
    for (uint32_t g = 0; g < streams->gap_count; g++)
        for (uint32_t i = 0; i < count; i++) {
            const uint64_t record = streams->record + first + i;
            const bool lost = record >= gaps[g].first && record < gaps[g].end && keep[i] != 2;
            *lost_count += lost;
            if (lost) keep[i] = 2;
        }
    uint32_t kept_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        kept[kept_count] = (uint16_t)i;
        kept_count += keep[i] == 1;
    }
    return kept_count;
}

/// A piece of work: `span` records from `first` on, of which `count` are kept.
typedef struct move_job {
    const ewa_e57_plan *plan;
    const ewa_e57_streams *streams;
    uint64_t first;
    const uint16_t *kept;
    uint32_t span, count;
} move_job;

/// Reads the numbers of the records that are kept, plus `shift`; false when the scan has no such field.
static bool read_kept(const move_job *job, int field, double shift, double *numbers) {
    if (field < 0) return false;
    ewa_e57_numbers(job->streams, (uint32_t)field, job->first, job->span, shift, numbers);
    if (job->span != job->count)
        for (uint32_t i = 0; i < job->count; i++) numbers[i] = numbers[job->kept[i]];
    return true;
}

#define STORE(type_name)                                                                                     \
    for (uint32_t i = 0; i < count; i++, to += stride) {                                                     \
        const type_name value = (type_name)numbers[i];                                                       \
        memcpy(to, &value, sizeof value);                                                                    \
    }                                                                                                        \
    break

static void store(ewa_type type, const double *numbers, uint32_t count, uint8_t *to, size_t stride) {
    switch (type) {
    case EWA_F32:
        STORE(float);
    case EWA_F64:
        STORE(double);
    case EWA_I8:
        STORE(int8_t);
    case EWA_U8:
        STORE(uint8_t);
    case EWA_I16:
        STORE(int16_t);
    case EWA_U16:
        STORE(uint16_t);
    case EWA_I32:
        STORE(int32_t);
    case EWA_U32:
        STORE(uint32_t);
    }
}

/// From range, azimuth from x towards y, elevation from the plane of both.
static void to_cartesian(double *x, double *y, double *z, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        const double range = x[i], azimuth = y[i], elevation = z[i], flat = range * cos(elevation);
        x[i] = flat * cos(azimuth);
        y[i] = flat * sin(azimuth);
        z[i] = range * sin(elevation);
    }
}

static void turn(const double m[9], const double shift[3], double (*v)[EWA_E57_CHUNK_RECORDS],
                 uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        const double x = v[0][i], y = v[1][i], z = v[2][i];
        for (int c = 0; c < 3; c++) v[c][i] = m[3 * c] * x + m[3 * c + 1] * y + m[3 * c + 2] * z + shift[c];
    }
}

static void move_place(const move_job *job, double (*v)[EWA_E57_CHUNK_RECORDS]) {
    const ewa_e57_plan *plan = job->plan;
    const bool apart = plan->spherical || plan->moved; // the shift comes after what else is done
    for (int c = 0; c < 3; c++)
        read_kept(job, plan->fields[(plan->spherical ? EWA_E57_RANGE : EWA_E57_X) + c],
                  apart ? 0 : plan->shift[c], v[c]);
    if (plan->spherical) to_cartesian(v[0], v[1], v[2], job->count);
    if (apart) turn(plan->turn, plan->shift, v, job->count);
}

/// Sets numbers that a flag says are invalid.
static void blank(const move_job *job, ewa_e57_role flag, double value, double *numbers) {
    double flags[EWA_E57_CHUNK_RECORDS];
    if (!read_kept(job, job->plan->fields[flag], 0, flags)) return;
    for (uint32_t i = 0; i < job->count; i++)
        if (flags[i] != 0) numbers[i] = value;
}

static void move_colors(const move_job *job, ewa_type type, double (*v)[EWA_E57_CHUNK_RECORDS]) {
    const double maximum = type == EWA_U8 ? 255 : 65535;
    for (int c = 0; c < 3; c++) {
        const double low = job->plan->color_low[c], factor = job->plan->color_factor[c];
        const bool given = read_kept(job, job->plan->fields[EWA_E57_RED + c], 0, v[c]);
        for (uint32_t i = 0; i < job->count; i++) {
            const double share = given ? (v[c][i] - low) * factor + 0.5 : 0;
            v[c][i] = share >= maximum ? maximum : share > 0 ? floor(share) : 0;
        }
        blank(job, EWA_E57_COLOR_INVALID, 0, v[c]);
    }
}

static void move_number(const move_job *job, uint32_t index, double *numbers) {
    const ewa_e57_plan *plan = job->plan;
    const ewa_e57_column *column = &plan->columns->columns[index];
    const double nothing = column->type == EWA_F32 || column->type == EWA_F64 ? NAN : 0;
    const bool is_other = column->role == EWA_E57_OTHER;
    if (strcmp(column->name, "scan") == 0) {
        for (uint32_t i = 0; i < job->count; i++) numbers[i] = plan->scan_index;
    } else if (!read_kept(job, is_other ? plan->column_fields[index] : plan->fields[column->role], 0,
                          numbers)) {
        for (uint32_t i = 0; i < job->count; i++) numbers[i] = nothing;
    } else if (column->role == EWA_E57_RETURN_INDEX) { // counted from 1
        for (uint32_t i = 0; i < job->count; i++) numbers[i] += 1;
    } else if (column->role == EWA_E57_INTENSITY) {
        blank(job, EWA_E57_INTENSITY_INVALID, nothing, numbers);
    } else if (column->role == EWA_E57_TIME) {
        blank(job, EWA_E57_TIME_INVALID, nothing, numbers);
    }
}

void ewa_e57_move(const ewa_e57_plan *plan, const ewa_e57_streams *streams, uint64_t first,
                  const uint16_t *kept, uint32_t kept_count, const ewa_cloud_sink *sinks, uint64_t to) {
    const move_job job = {plan, streams, first, kept, kept_count ? kept[kept_count - 1] + 1u : 0, kept_count};
    double v[3][EWA_E57_CHUNK_RECORDS];
    for (uint32_t k = 0; k < plan->columns->count; k++) {
        const ewa_e57_column *column = &plan->columns->columns[k];
        const size_t stride = sinks[k].stride_bytes;
        if (!sinks[k].to) continue;
        if (k == 0) {
            move_place(&job, v);
        } else if (column->component_count == 1) {
            move_number(&job, k, v[0]);
        } else if (column->role == EWA_E57_RED) {
            move_colors(&job, column->type, v);
        } else {
            for (int c = 0; c < 3; c++)
                if (!read_kept(&job, plan->fields[EWA_E57_NORMAL_X + c], 0, v[c]))
                    for (uint32_t i = 0; i < kept_count; i++) v[c][i] = NAN;
            if (plan->moved) turn(plan->turn, (const double[3]){0, 0, 0}, v, kept_count);
        }
        for (uint32_t c = 0; c < column->component_count; c++)
            store(column->type, v[c], kept_count,
                  sinks[k].to + to * stride + c * ewa_type_bytes(column->type), stride);
    }
}
