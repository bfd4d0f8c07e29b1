// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Binary records of EPT: which of the dimensions that a schema lists make up which attribute.
#include "base/base.h"
#include "io/ept/ept.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// Names that PDAL gives to dimensions, and those of ewa/cloud.h.
static const struct {
    const char *name, *attribute;
} names[] = {{"Intensity", "intensity"},
             {"ReturnNumber", "return_number"},
             {"NumberOfReturns", "number_of_returns"},
             {"ScanDirectionFlag", "scan_direction_flag"},
             {"EdgeOfFlightLine", "edge_of_flight_line"},
             {"Classification", "classification"},
             {"Synthetic", "synthetic"},
             {"KeyPoint", "key_point"},
             {"Withheld", "withheld"},
             {"Overlap", "overlap"},
             {"ScanChannel", "scanner_channel"},
             {"UserData", "user_data"},
             {"ScanAngleRank", "scan_angle"},
             {"ScanAngle", "scan_angle"},
             {"PointSourceId", "point_source_id"},
             {"GpsTime", "gps_time"},
             {"Infrared", "nir"},
             {"Alpha", "alpha"}};

/// What a schema says of one dimension.
typedef struct dimension {
    const char *name;
    ewa_las_raw raw;
    uint32_t at_bytes;
    double scale, offset;
    bool scaled; ///< they are not 1 and 0
} dimension;

/// Dimensions that come together.
enum { X, Y, Z, RED, GREEN, BLUE, GATHERED_COUNT };
static const char *const gathered_names[GATHERED_COUNT] = {"X", "Y", "Z", "Red", "Green", "Blue"};

static double number_of(const cJSON *object, const char *name, double otherwise) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, name);
    return cJSON_IsNumber(item) ? item->valuedouble : otherwise;
}

/// Reads what is said of a dimension; false when it is of no known type.
static bool read_dimension(const cJSON *object, dimension *d) {
    const char *type = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, "type"));
    const double size = number_of(object, "size", 0);
    d->name = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, "name"));
    d->scale = number_of(object, "scale", 1);
    d->offset = number_of(object, "offset", 0);
    d->scaled = d->scale != 1 || d->offset != 0;
    if (!type || !d->name || !d->name[0] || !isfinite(d->scale) || !isfinite(d->offset) || d->scale == 0)
        return false;
    static const struct {
        const char *type;
        ewa_las_raw raw;
    } types[] = {{"unsigned", EWA_LAS_U8},  {"unsigned", EWA_LAS_U16}, {"unsigned", EWA_LAS_U32},
                 {"unsigned", EWA_LAS_U64}, {"signed", EWA_LAS_I8},    {"signed", EWA_LAS_I16},
                 {"signed", EWA_LAS_I32},   {"signed", EWA_LAS_I64},   {"float", EWA_LAS_F32},
                 {"float", EWA_LAS_F64}};
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        d->raw = types[i].raw;
        if (strcmp(type, types[i].type) == 0 && size == ewa_las_raw_bytes(d->raw)) return true;
    }
    return false;
}

static ewa_las_column *add(ewa_las_table *table, const char *name, const dimension *d) {
    ewa_las_column *column = &table->columns[table->column_count++];
    *column = (ewa_las_column){.component_count = 1, .at_bytes = {(uint16_t)d->at_bytes}};
    ewa_las_text((const uint8_t *)name, strnlen(name, EWA_NAME_BYTES - 1), column->name);
    ewa_las_column_number(d->raw, column);
    column->scale[0] = d->scale;
    column->offset[0] = d->offset;
    if (!d->scaled) return column;
    column->kind = EWA_LAS_SCALED;
    column->type = EWA_F64;
    return column;
}

/// Adds a dimension that is an attribute of its own.
static void add_single(ewa_las_table *table, const dimension *d) {
    const char *name = d->name;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (strcmp(name, names[i].name) == 0) name = names[i].attribute;
    ewa_las_column *column = add(table, name, d);
    if (strcmp(name, "scan_angle") == 0 && column->type != EWA_F32) {
        column->kind = EWA_LAS_SCALED;
        column->type = EWA_F32;
    }
}

/// Adds the colours, as one attribute when they are of one type that colours have.
static void add_colors(ewa_las_table *table, const dimension *gathered) {
    static const char *const singles[3] = {"red", "green", "blue"};
    const dimension *red = &gathered[RED];
    bool is_color = red->raw == EWA_LAS_U8 || red->raw == EWA_LAS_U16;
    for (int c = RED; c <= BLUE; c++)
        is_color = is_color && gathered[c].name && gathered[c].raw == red->raw && !gathered[c].scaled;
    for (int c = RED; c <= BLUE && !is_color; c++)
        if (gathered[c].name) add(table, singles[c - RED], &gathered[c]);
    if (!is_color) return;
    ewa_las_column *color = add(table, EWA_COLOR, red);
    color->component_count = 3;
    if (red->raw == EWA_LAS_U16) color->kind = EWA_LAS_COLOR;
    for (int c = 0; c < 3; c++) color->at_bytes[c] = (uint16_t)gathered[RED + c].at_bytes;
}

/// Adds the positions: whole numbers of 32 bits on their grid, others as doubles about a whole place.
static void add_position(const dimension *gathered, const double low_world[3], ewa_ept *ept) {
    ewa_las_table *table = &ept->table;
    ewa_las_column *position = add(table, EWA_POSITION, &gathered[X]);
    position->component_count = 3;
    position->type = EWA_F64;
    const bool on_grid = gathered[X].raw == EWA_LAS_I32;
    position->kind = on_grid ? EWA_LAS_POSITION : EWA_LAS_SCALED;
    for (int c = 0; c < 3; c++) {
        const dimension *d = &gathered[X + c];
        const double first = nearbyint((low_world[c] - d->offset) / d->scale);
        position->at_bytes[c] = (uint16_t)d->at_bytes;
        if (on_grid) {
            table->scale[c] = d->scale;
            table->first[c] = first < INT32_MIN ? INT32_MIN : first > INT32_MAX ? INT32_MAX : (int64_t)first;
            ept->offset_world[c] = d->offset;
        } else {
            ept->offset_world[c] = floor(low_world[c]);
            position->scale[c] = d->scale;
            position->offset[c] = d->offset - ept->offset_world[c];
        }
    }
}

/// Checks that X, Y and Z are there and of one type.
static ewa_status check_position(const ewa_ept *ept, const char *name, const dimension *gathered) {
    for (int c = X; c <= Z; c++) {
        if (!gathered[c].name)
            return ewa_fail(ept->context, EWA_ERROR_FORMAT, "%s: the schema has no dimension %s", name,
                            gathered_names[c]);
        if (gathered[c].raw != gathered[X].raw || !(gathered[c].scale > 0))
            return ewa_fail(ept->context, EWA_ERROR_UNSUPPORTED,
                            "%s: dimension %s is of another type than X, or has a scale of %g", name,
                            gathered_names[c], gathered[c].scale);
    }
    return EWA_OK;
}

/// An attribute that could not be asked for: its name is another's, or blank.
static const char *find_double(ewa_las_table *table) {
    for (uint32_t i = 1; i < table->column_count; i++)
        if (!table->columns[i].name[0] ||
            ewa_las_table_find(table, table->columns[i].name) != &table->columns[i])
            return table->columns[i].name;
    return NULL;
}

ewa_status ewa_ept_schema(const char *name, const cJSON *schema, const double low_world[3], ewa_ept *ept) {
    ewa_las_table *table = &ept->table;
    dimension gathered[GATHERED_COUNT] = {{0}};
    const int count = cJSON_GetArraySize(schema);
    if (!cJSON_IsArray(schema) || count == 0 || count > EWA_LAS_MAX_COLUMNS)
        return ewa_fail(ept->context, EWA_ERROR_FORMAT,
                        "%s: the schema lists %d dimensions, 1 to %d are read", name, count,
                        EWA_LAS_MAX_COLUMNS);
    uint32_t at_bytes = 0;
    const cJSON *object;
    char shown[EWA_EPT_SHOWN_BYTES];
    memset(table, 0, sizeof *table);
    // Positions come first, as in all other clouds.
    for (int round = 0; round < 2; round++) {
        at_bytes = 0;
        cJSON_ArrayForEach(object, schema) {
            dimension d = {.at_bytes = at_bytes};
            if (!read_dimension(object, &d))
                return ewa_fail(
                    ept->context, EWA_ERROR_FORMAT,
                    "%s: the schema: dimension %s has no name, an unknown type or size, or a scale "
                    "that is none",
                    name, ewa_ept_show(d.name, shown));
            at_bytes += ewa_las_raw_bytes(d.raw);
            int slot = 0;
            while (slot < GATHERED_COUNT && strcmp(d.name, gathered_names[slot]) != 0) slot++;
            if (slot < GATHERED_COUNT)
                gathered[slot] = d;
            else if (round == 1)
                add_single(table, &d);
        }
        if (round == 1) break;
        EWA_TRY(check_position(ept, name, gathered));
        add_position(gathered, low_world, ept);
    }
    add_colors(table, gathered);
    ewa_las_table_join(table);
    const char *twice = find_double(table);
    if (twice)
        return ewa_fail(ept->context, EWA_ERROR_FORMAT,
                        "%s: the schema has two dimensions of '%s', or one without a name", name, twice);
    table->record_bytes = at_bytes;
    const ewa_las_column *color = ewa_las_table_find(table, EWA_COLOR);
    table->color_at =
        color && color->kind == EWA_LAS_COLOR ? (uint32_t)(color - table->columns) : table->column_count;
    return EWA_OK;
}
