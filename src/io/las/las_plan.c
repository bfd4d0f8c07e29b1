// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which point format a cloud gets, and which attribute goes where: into the format's own fields where there
// is one of its name and type, else into extra bytes.
#include "base/base.h"
#include "cloud/cloud.h"
#include "io/las/las_write.h"
#include "io/number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LEGACY_MAX_RETURNS = 5, LEGACY_MAX_CLASS = 31, LEGACY_MAX_RANK = 90 };

/// Largest number of an attribute of one component; 0 when there is none. `*whole` says whether all numbers
/// are whole.
static double largest(const ewa_cloud *piece, const char *name, bool *whole) {
    enum { BLOCK = 1024 };
    const ewa_attribute *attribute = ewa_cloud_find(piece, name);
    const uint64_t count = ewa_cloud_point_count(piece);
    double maximum = 0;
    *whole = true;
    if (!attribute || attribute->component_count != 1) return 0;
    for (uint64_t first = 0; first < count; first += BLOCK) {
        double values[BLOCK];
        const uint64_t part = count - first < BLOCK ? count - first : BLOCK;
        ewa_attribute_read_f64(attribute, first, part, values);
        for (uint64_t i = 0; i < part; i++) {
            const double size = fabs(values[i]);
            if (size > maximum) maximum = size;
            *whole = *whole && (values[i] == nearbyint(values[i]) || values[i] != values[i]);
        }
    }
    return maximum;
}

/// Whether the fields of the formats 0 to 3 hold what the cloud says. Of pieces to come nothing is known but
/// what files of these formats cannot have held.
static bool is_legacy(const ewa_cloud_target *target, const ewa_cloud *piece, bool is_whole) {
    static const char *const later[] = {"overlap", "scanner_channel", "nir"};
    static const char *const narrow[] = {"return_number", "number_of_returns", "classification",
                                         "scan_angle"};
    static const double maximum[] = {LEGACY_MAX_RETURNS, LEGACY_MAX_RETURNS, LEGACY_MAX_CLASS,
                                     LEGACY_MAX_RANK};
    const ewa_cloud *prototype = target->prototype;
    for (size_t i = 0; i < sizeof later / sizeof *later; i++)
        if (ewa_cloud_find(prototype, later[i])) return false;
    const char *note = ewa_cloud_note(prototype, EWA_LAS_NOTE_FORMAT, NULL);
    const bool was_legacy = note && atoi(note) < 6;
    for (size_t i = 0; i < sizeof narrow / sizeof *narrow; i++) {
        bool whole;
        if (!ewa_cloud_find(prototype, narrow[i]) || (was_legacy && !is_whole)) continue;
        if (!is_whole || largest(piece, narrow[i], &whole) > maximum[i] || !whole) return false;
    }
    return true;
}

static uint8_t choose_format(const ewa_cloud_target *target, const ewa_cloud *piece, bool is_whole,
                             bool is_new) {
    const bool has_time = ewa_cloud_find(target->prototype, "gps_time") != NULL;
    const ewa_attribute *color = ewa_cloud_find(target->prototype, EWA_COLOR);
    const bool has_color = color && color->component_count >= 3;
    if (!is_new && is_legacy(target, piece, is_whole)) return (uint8_t)(has_time + 2 * has_color);
    if (!has_color) return 6;
    return ewa_cloud_find(target->prototype, "nir") ? 8 : 7;
}

/// Whether a field of the format holds every number of the attribute's type.
static bool is_held(const ewa_las_column *column, const ewa_attribute *attribute) {
    if (column->kind == EWA_LAS_COLOR) return attribute->component_count >= 3;
    return attribute->component_count == 1 && column->type == attribute->type;
}

/// What one of a field's whole numbers stands for; 0: itself. A note says so, and of normals in 16 bits it is known.
static double scale_of(const ewa_cloud_target *target, const ewa_attribute *attribute) {
    if (attribute->type == EWA_F32 || attribute->type == EWA_F64) return 0;
    char name[EWA_NAME_BYTES + 8];
    snprintf(name, sizeof name, EWA_LAS_NOTE_SCALE "%s", attribute->name);
    const char *note = ewa_cloud_note(target->prototype, name, NULL);
    double scale = 0;
    if (note) {
        const char *end = note + strlen(note);
        return ewa_number_read_f64(note, end, &scale) == end && scale > 0 && isfinite(scale) ? scale : 0;
    }
    const bool is_normal = strcmp(attribute->name, EWA_NORMAL) == 0 && attribute->component_count == 3;
    return is_normal && attribute->type == EWA_I16 ? 1.0 / INT16_MAX : 0;
}

/// Describes one field of extra bytes; `scale` 0: its numbers stand for themselves.
static ewa_status describe(const ewa_cloud_target *target, ewa_las_plan *plan, const char *name, uint8_t type,
                           uint8_t options, double scale) {
    enum { SCALED = 8, SCALES_AT = 112 };
    const size_t at = (size_t)plan->extra_count * EWA_LAS_EXTRA_BYTES;
    EWA_TRY(ewa_buffer_grow(target->context, &plan->extras, at, at + EWA_LAS_EXTRA_BYTES, 1));
    uint8_t *bytes = (uint8_t *)plan->extras.data + at;
    memset(bytes, 0, EWA_LAS_EXTRA_BYTES);
    bytes[2] = type;
    bytes[3] = (uint8_t)(options | (scale > 0 ? SCALED : 0));
    for (int c = 0; c < 3 && scale > 0; c++) ewa_las_put_f64(bytes + SCALES_AT + 8 * c, scale);
    const size_t length = strlen(name);
    if (length > EWA_LAS_EXTRA_NAME_BYTES)
        ewa_report(target->context, EWA_SEVERITY_WARNING, "%s: the name of attribute '%s' is cut to %d bytes",
                   target->name, name, EWA_LAS_EXTRA_NAME_BYTES);
    memcpy(bytes + 4, name, length < EWA_LAS_EXTRA_NAME_BYTES ? length : EWA_LAS_EXTRA_NAME_BYTES);
    plan->extra_count++;
    return EWA_OK;
}

static uint8_t raw_type(ewa_type type) {
    static const uint8_t types[] = {
        [EWA_F32] = EWA_LAS_F32, [EWA_F64] = EWA_LAS_F64, [EWA_I8] = EWA_LAS_I8,   [EWA_U8] = EWA_LAS_U8,
        [EWA_I16] = EWA_LAS_I16, [EWA_U16] = EWA_LAS_U16, [EWA_I32] = EWA_LAS_I32, [EWA_U32] = EWA_LAS_U32};
    return types[type];
}

/// Appends an attribute to the records: bytes by fours without a type, two or three numbers as one field,
/// or as fields with names of their own, four as four.
static ewa_status add_extra(const ewa_cloud_target *target, ewa_las_plan *plan, uint32_t index) {
    const ewa_attribute *attribute = ewa_cloud_attribute_at(target->prototype, index);
    const uint32_t count = attribute->component_count;
    const size_t size_bytes = count * ewa_type_bytes(attribute->type);
    ewa_las_table *table = &plan->table;
    if (table->column_count == EWA_LAS_MAX_COLUMNS || table->record_bytes + size_bytes > UINT16_MAX)
        return ewa_fail(
            target->context, EWA_ERROR_LIMIT,
            "%s: attribute '%s' does not fit into a record of LAS: %d fields and %d bytes at most",
            target->name, attribute->name, EWA_LAS_MAX_COLUMNS, UINT16_MAX);
    ewa_las_column *column = &table->columns[table->column_count];
    *column = (ewa_las_column){.kind = EWA_LAS_PLAIN,
                               .type = attribute->type,
                               .component_count = count,
                               .at_bytes = {(uint16_t)table->record_bytes}};
    plan->sources[table->column_count++] = (int32_t)index;
    table->record_bytes += (uint32_t)size_bytes;
    const uint8_t raw = raw_type(attribute->type);
    if (count == 4 && raw == EWA_LAS_U8) return describe(target, plan, attribute->name, 0, 4, 0);
    const bool has_parts = count == 3 && ewa_las_part_name(attribute->name, 0);
    const double scale = scale_of(target, attribute);
    if (count < 4 && !has_parts)
        return describe(target, plan, count == 1 ? ewa_las_alias(attribute->name) : attribute->name,
                        (uint8_t)(raw + 10 * (count - 1)), 0, scale);
    for (uint32_t c = 0; c < count; c++) {
        char name[EWA_NAME_BYTES + 12];
        if (has_parts)
            snprintf(name, sizeof name, "%s", ewa_las_part_name(attribute->name, c));
        else
            snprintf(name, sizeof name, "%s_%u", attribute->name, c);
        EWA_TRY(describe(target, plan, name, raw, 0, scale));
    }
    return EWA_OK;
}

/// Gives a colour's alpha a field behind those of the point format.
static ewa_status add_alpha(const ewa_cloud_target *target, ewa_las_plan *plan, ewa_las_column *color) {
    color->at_bytes[3] = (uint16_t)plan->table.record_bytes;
    color->component_count = 4;
    plan->table.record_bytes += 2;
    return describe(target, plan, "alpha", EWA_LAS_U16, 0, 0);
}

static ewa_status assign(const ewa_cloud_target *target, ewa_las_plan *plan) {
    ewa_las_table *table = &plan->table;
    const uint32_t own_count = table->column_count;
    for (uint32_t i = 0; i < EWA_LAS_MAX_COLUMNS; i++) plan->sources[i] = -1;
    for (uint32_t i = 0; i < ewa_cloud_attribute_count(target->prototype); i++) {
        const ewa_attribute *attribute = ewa_cloud_attribute_at(target->prototype, i);
        ewa_las_column *column = ewa_las_table_find(table, attribute->name);
        if (column && column >= table->columns + own_count) column = NULL;
        const bool takes = column && (column->kind == EWA_LAS_COLOR ? attribute->component_count >= 3
                                                                    : attribute->component_count == 1);
        if (takes) plan->sources[column - table->columns] = (int32_t)i;
        if (column && column->kind == EWA_LAS_POSITION) {
            plan->sources[0] = (int32_t)i;
            continue;
        }
        if (!column || !is_held(column, attribute))
            EWA_TRY(add_extra(target, plan, i));
        else if (column->kind == EWA_LAS_COLOR && attribute->component_count == 4)
            EWA_TRY(add_alpha(target, plan, column));
    }
    return EWA_OK;
}

ewa_status ewa_las_plan_make(const ewa_cloud_target *target, const ewa_cloud *piece, bool is_whole,
                             bool is_new, ewa_las_plan *plan) {
    const ewa_attribute *position = ewa_cloud_find(target->prototype, EWA_POSITION);
    if (!position || position->component_count != 3)
        return ewa_fail(target->context, EWA_ERROR_ARGUMENT,
                        "%s: the cloud has no attribute 'position' of three components", target->name);
    const size_t length = strlen(target->name);
    plan->compressed = length >= 4 && (target->name[length - 1] | 32) == 'z';
    plan->point_format = choose_format(target, piece, is_whole, is_new);
    ewa_las_table_begin(plan->point_format, &plan->table);
    EWA_TRY(assign(target, plan));
    EWA_TRY(ewa_las_grid_choose(target, plan));
    // A count of 32 bits and the records of older versions are what most programs read.
    const bool is_long = target->point_count > UINT32_MAX; // also when unknown
    plan->version_minor = plan->point_format >= 6 || plan->extra_count || is_long ? 4 : 2;
    plan->intensity_scale = 1;
    const ewa_attribute *intensity = ewa_cloud_find(target->prototype, "intensity");
    bool whole;
    if (intensity && piece && (intensity->type == EWA_F32 || intensity->type == EWA_F64) &&
        largest(piece, "intensity", &whole) <= 1)
        plan->intensity_scale = UINT16_MAX;
    return EWA_OK;
}

void ewa_las_plan_free(ewa_context *context, ewa_las_plan *plan) { ewa_buffer_free(context, &plan->extras); }
