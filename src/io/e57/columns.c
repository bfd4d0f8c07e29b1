// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which attributes the points of all scans of an E57 file have together, and of which types.
#include "io/e57/e57.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

int ewa_e57_find(const ewa_e57_contents *contents, const ewa_e57_scan *scan, ewa_e57_role role) {
    const ewa_e57_field *fields = ewa_e57_fields_of(contents, scan);
    for (uint32_t i = 0; i < scan->field_count; i++)
        if (fields[i].role == role) return (int)i;
    return -1;
}

static bool has_all(const ewa_e57_contents *contents, const ewa_e57_scan *scan, ewa_e57_role first) {
    for (int i = 0; i < 3; i++)
        if (ewa_e57_find(contents, scan, (ewa_e57_role)((int)first + i)) < 0) return false;
    return true;
}

bool ewa_e57_has_place(const ewa_e57_contents *contents, const ewa_e57_scan *scan, bool *spherical) {
    *spherical = !has_all(contents, scan, EWA_E57_X);
    return !*spherical || has_all(contents, scan, EWA_E57_RANGE);
}

ewa_e57_limits ewa_e57_color_range(const ewa_e57_contents *contents, const ewa_e57_scan *scan,
                                   int component) {
    const int field = ewa_e57_find(contents, scan, (ewa_e57_role)(EWA_E57_RED + component));
    const ewa_e57_field *f = &ewa_e57_fields_of(contents, scan)[field];
    const ewa_e57_limits said = scan->color[component];
    ewa_e57_limits own = {f->low, f->high};
    if (f->kind == EWA_E57_SCALED)
        own = (ewa_e57_limits){f->low * f->scale + f->offset, f->high * f->scale + f->offset};
    const ewa_e57_limits bytes = {0, 255}, words = {0, 65535};
    // Programs write limits of what a scan happens to have: the usual ranges stay what they are.
    if ((own.low == 0 && own.high == 255) || (said.low == 0 && said.high == 255)) return bytes;
    if ((own.low == 0 && own.high == 65535) || (said.low == 0 && said.high == 65535)) return words;
    if (said.low < said.high && isfinite(said.high - said.low)) return said;
    if (own.low < own.high && isfinite(own.high - own.low)) return own;
    return f->kind == EWA_E57_FLOAT ? (ewa_e57_limits){0, 1} : bytes;
}

/// Names of single numbers that have a role.
static const struct {
    ewa_e57_role role;
    const char *name;
} names[] = {{EWA_E57_INTENSITY, "intensity"},
             {EWA_E57_TIME, "gps_time"},
             {EWA_E57_RETURN_INDEX, "return_number"},
             {EWA_E57_RETURN_COUNT, "number_of_returns"},
             {EWA_E57_ROW, "row_index"},
             {EWA_E57_COLUMN, "column_index"}};

/// The column of a name, or a new one; NULL when there are too many.
static ewa_e57_column *column_of(ewa_e57_columns *columns, const char *name, ewa_e57_role role,
                                 uint32_t component_count) {
    for (uint32_t i = 0; i < columns->count; i++)
        if (strcmp(columns->columns[i].name, name) == 0) return &columns->columns[i];
    if (columns->count == EWA_E57_MAX_COLUMNS) return NULL;
    ewa_e57_column *made = &columns->columns[columns->count++];
    *made = (ewa_e57_column){
        .role = role, .component_count = component_count, .low = INFINITY, .high = -INFINITY};
    memcpy(made->name, name, strlen(name) + 1);
    return made;
}

/// Widens what a column has to hold by a field of one scan.
static void widen(ewa_e57_column *column, const ewa_e57_field *field) {
    const double more = field->role == EWA_E57_RETURN_INDEX; // counted from 1
    if (field->kind == EWA_E57_INTEGER) {
        column->low = fmin(column->low, field->low + more);
        column->high = fmax(column->high, field->high + more);
    } else {
        column->is_float = true;
        column->is_double |= field->kind == EWA_E57_SCALED || !field->single;
    }
}

static ewa_type type_of(const ewa_e57_column *column) {
    const bool has_integers = column->low <= column->high;
    const double low = fmin(column->low, 0), high = fmax(column->high, 0); // 0 where a scan has none
    if (column->is_double) return EWA_F64;
    if (column->is_float) return !has_integers || (low >= -0x1p24 && high <= 0x1p24) ? EWA_F32 : EWA_F64;
    if (low == 0) return high < 0x1p8 ? EWA_U8 : high < 0x1p16 ? EWA_U16 : high < 0x1p32 ? EWA_U32 : EWA_F64;
    if (low >= -0x1p7 && high < 0x1p7) return EWA_I8;
    if (low >= -0x1p15 && high < 0x1p15) return EWA_I16;
    return low >= -0x1p31 && high < 0x1p31 ? EWA_I32 : EWA_F64;
}

/// Names that mean attributes of several components, or what the reader adds.
static bool is_reserved(const char *name) {
    static const char *const reserved[] = {EWA_POSITION,  EWA_NORMAL, EWA_COLOR, EWA_TANGENT_U,
                                           EWA_TANGENT_V, EWA_CLIP0,  EWA_CLIP1, EWA_BORDER,   "scan"};
    for (size_t i = 0; i < sizeof reserved / sizeof reserved[0]; i++)
        if (strcmp(name, reserved[i]) == 0) return true;
    return false;
}

/// Adds the fields of a scan that have names of their own or of scans in general.
static ewa_status add_numbers(const ewa_cloud_source *source, const ewa_e57_contents *contents,
                              const ewa_e57_scan *scan, ewa_e57_columns *columns) {
    const ewa_e57_field *fields = ewa_e57_fields_of(contents, scan);
    for (uint32_t i = 0; i < scan->field_count; i++) {
        const char *name = fields[i].role == EWA_E57_OTHER ? fields[i].name : NULL;
        for (size_t k = 0; k < sizeof names / sizeof names[0]; k++)
            if (fields[i].role == names[k].role) name = names[k].name;
        if (!name) continue;
        if (is_reserved(name)) {
            ewa_report(source->context, EWA_SEVERITY_WARNING,
                       "%s: field '%s' is left out: an attribute of that name is something else",
                       source->name, name);
            continue;
        }
        ewa_e57_column *column = column_of(columns, name, fields[i].role, 1);
        if (!column)
            return ewa_fail(source->context, EWA_ERROR_LIMIT, "%s: more than %d fields of all scans",
                            source->name, EWA_E57_MAX_COLUMNS);
        if (column->component_count == 1 && column->role == fields[i].role) widen(column, &fields[i]);
    }
    return EWA_OK;
}

static bool scan_has(const ewa_e57_contents *contents, const ewa_e57_scan *scan,
                     const ewa_e57_column *column) {
    const ewa_e57_field *fields = ewa_e57_fields_of(contents, scan);
    if (column->component_count == 3) return has_all(contents, scan, column->role);
    for (uint32_t i = 0; i < scan->field_count; i++)
        if (fields[i].role == column->role &&
            (column->role != EWA_E57_OTHER || strcmp(fields[i].name, column->name) == 0))
            return true;
    return false;
}

static bool is_moved(const ewa_e57_scan *scan) {
    const double *r = scan->rotation, *t = scan->translation_world;
    return scan->has_pose && !(r[1] == 0 && r[2] == 0 && r[3] == 0 && t[0] == 0 && t[1] == 0 && t[2] == 0);
}

/// Positions are doubles unless all that there is are floats; far away, from an origin.
static void settle_place(const ewa_e57_contents *contents, ewa_e57_columns *columns) {
    const double far_world = 1000;
    bool single = true, first = true, same_grid = true;
    for (uint32_t i = 0; i < contents->scan_count; i++) {
        const ewa_e57_scan *scan = ewa_e57_scan_at(contents, i);
        bool spherical;
        if (!ewa_e57_has_place(contents, scan, &spherical)) continue;
        ewa_coordinate_grid grid = {.step_world = {0, 0, 0}};
        for (int c = 0; c < 3; c++) {
            const int index = ewa_e57_find(contents, scan, (ewa_e57_role)(EWA_E57_X + c));
            const ewa_e57_field *f = index < 0 ? NULL : &ewa_e57_fields_of(contents, scan)[index];
            single = single && !spherical && f && f->kind == EWA_E57_FLOAT && f->single && !is_moved(scan);
            if (spherical || is_moved(scan) || !f || f->kind != EWA_E57_SCALED || !(f->scale > 0)) continue;
            grid.step_world[c] = f->scale;
            grid.offset_world[c] = f->offset;
        }
        if (first) {
            columns->grid = grid;
            for (int c = 0; c < 3; c++) {
                const double far =
                    is_moved(scan) ? nearbyint(scan->translation_world[c]) : grid.offset_world[c];
                columns->origin_world[c] = fabs(far) >= far_world && fabs(far) < 0x1p53 ? far : 0;
            }
        }
        same_grid = same_grid && memcmp(&columns->grid, &grid, sizeof grid) == 0;
        first = false;
    }
    if (!same_grid) columns->grid = (ewa_coordinate_grid){.step_world = {0, 0, 0}};
    columns->columns[0].type = single ? EWA_F32 : EWA_F64;
}

/// Says what stands where a scan lacks what others have.
static void tell_lacking(const ewa_cloud_source *source, const ewa_e57_columns *columns) {
    char text[400] = "";
    size_t length = 0;
    for (uint32_t k = 1; k < columns->count; k++) {
        const ewa_e57_column *column = &columns->columns[k];
        const bool is_float = column->type == EWA_F32 || column->type == EWA_F64;
        if (!column->lacking || length + EWA_NAME_BYTES + 16 > sizeof text) continue;
        length += (size_t)snprintf(text + length, sizeof text - length, "%s%s (%s)", length ? ", " : "",
                                   column->name, is_float ? "nan" : "0");
    }
    if (length)
        ewa_report(source->context, EWA_SEVERITY_WARNING, "%s: some scans lack, and get instead: %s",
                   source->name, text);
}

static void settle_types(const ewa_cloud_source *source, const ewa_e57_contents *contents,
                         ewa_e57_columns *columns) {
    for (uint32_t k = 1; k < columns->count; k++) {
        ewa_e57_column *column = &columns->columns[k];
        for (uint32_t i = 0; i < contents->scan_count; i++)
            column->lacking |= strcmp(column->name, "scan") != 0 &&
                               !scan_has(contents, ewa_e57_scan_at(contents, i), column);
        if (column->role == EWA_E57_RED && column->component_count == 3) {
            column->type = EWA_U8;
            for (uint32_t i = 0; i < contents->scan_count; i++)
                for (int c = 0; c < 3 && scan_has(contents, ewa_e57_scan_at(contents, i), column); c++)
                    if (ewa_e57_color_range(contents, ewa_e57_scan_at(contents, i), c).high != 255)
                        column->type = EWA_U16;
        } else if (column->component_count == 3) {
            column->type = EWA_F32;
        } else {
            column->type = column->role == EWA_E57_TIME ? EWA_F64 : type_of(column);
        }
    }
    tell_lacking(source, columns);
}

ewa_status ewa_e57_columns_map(const ewa_cloud_source *source, const ewa_e57_contents *contents,
                               ewa_e57_columns *columns) {
    *columns = (ewa_e57_columns){.count = 0};
    column_of(columns, EWA_POSITION, EWA_E57_X, 3);
    if (contents->scan_count > 1)
        widen(column_of(columns, "scan", EWA_E57_RANGE, 1),
              &(ewa_e57_field){.kind = EWA_E57_INTEGER, .high = 65535});
    uint32_t placed = 0;
    for (uint32_t i = 0; i < contents->scan_count; i++) {
        const ewa_e57_scan *scan = ewa_e57_scan_at(contents, i);
        bool spherical;
        placed += ewa_e57_has_place(contents, scan, &spherical);
        if (has_all(contents, scan, EWA_E57_NORMAL_X)) column_of(columns, EWA_NORMAL, EWA_E57_NORMAL_X, 3);
        if (has_all(contents, scan, EWA_E57_RED)) column_of(columns, EWA_COLOR, EWA_E57_RED, 3);
    }
    if (placed == 0)
        return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: no scan has coordinates", source->name);
    for (uint32_t i = 0; i < contents->scan_count; i++) {
        EWA_TRY(add_numbers(source, contents, ewa_e57_scan_at(contents, i), columns));
    }
    settle_place(contents, columns);
    settle_types(source, contents, columns);
    return EWA_OK;
}
