// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which numbers of a LAS record make up which attribute: the fields of the point formats, and extra bytes
// with the types and names that their record gives them.
#include "base/base.h"
#include "io/las/las.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_EXTRA_FIELDS = 340, RAW_TYPE_COUNT = 11 };

/// A field that a family of point formats has.
typedef struct field {
    const char *name;
    ewa_las_kind kind;
    ewa_type type;
    uint16_t at_bytes;
    uint8_t shift, mask;
} field;

// Formats 0 to 5.
static const field fields_legacy[] = {
    {"intensity", EWA_LAS_PLAIN, EWA_U16, 12, 0, 0},
    {"return_number", EWA_LAS_BITS, EWA_U8, 14, 0, 7},
    {"number_of_returns", EWA_LAS_BITS, EWA_U8, 14, 3, 7},
    {"scan_direction_flag", EWA_LAS_BITS, EWA_U8, 14, 6, 1},
    {"edge_of_flight_line", EWA_LAS_BITS, EWA_U8, 14, 7, 1},
    {"classification", EWA_LAS_BITS, EWA_U8, 15, 0, 31},
    {"synthetic", EWA_LAS_BITS, EWA_U8, 15, 5, 1},
    {"key_point", EWA_LAS_BITS, EWA_U8, 15, 6, 1},
    {"withheld", EWA_LAS_BITS, EWA_U8, 15, 7, 1},
    {"user_data", EWA_LAS_PLAIN, EWA_U8, 17, 0, 0},
    {"scan_angle", EWA_LAS_RANK, EWA_F32, 16, 0, 0},
    {"point_source_id", EWA_LAS_PLAIN, EWA_U16, 18, 0, 0},
};

// Formats 6 to 10.
static const field fields_extended[] = {
    {"intensity", EWA_LAS_PLAIN, EWA_U16, 12, 0, 0},
    {"return_number", EWA_LAS_BITS, EWA_U8, 14, 0, 15},
    {"number_of_returns", EWA_LAS_BITS, EWA_U8, 14, 4, 15},
    {"scan_direction_flag", EWA_LAS_BITS, EWA_U8, 15, 6, 1},
    {"edge_of_flight_line", EWA_LAS_BITS, EWA_U8, 15, 7, 1},
    {"classification", EWA_LAS_PLAIN, EWA_U8, 16, 0, 0},
    {"synthetic", EWA_LAS_BITS, EWA_U8, 15, 0, 1},
    {"key_point", EWA_LAS_BITS, EWA_U8, 15, 1, 1},
    {"withheld", EWA_LAS_BITS, EWA_U8, 15, 2, 1},
    {"overlap", EWA_LAS_BITS, EWA_U8, 15, 3, 1},
    {"scanner_channel", EWA_LAS_BITS, EWA_U8, 15, 4, 3},
    {"user_data", EWA_LAS_PLAIN, EWA_U8, 17, 0, 0},
    {"scan_angle", EWA_LAS_ANGLE, EWA_F32, 18, 0, 0},
    {"point_source_id", EWA_LAS_PLAIN, EWA_U16, 20, 0, 0},
};

// Offsets within the 29 bytes of a wave packet.
static const field fields_wave[] = {
    {"wave_packet_descriptor", EWA_LAS_PLAIN, EWA_U8, 0, 0, 0},
    {"wave_packet_offset", EWA_LAS_WIDE, EWA_F64, 1, 0, 0},
    {"wave_packet_size", EWA_LAS_PLAIN, EWA_U32, 9, 0, 0},
    {"wave_return_location", EWA_LAS_PLAIN, EWA_F32, 13, 0, 0},
    {"wave_x_t", EWA_LAS_PLAIN, EWA_F32, 17, 0, 0},
    {"wave_y_t", EWA_LAS_PLAIN, EWA_F32, 21, 0, 0},
    {"wave_z_t", EWA_LAS_PLAIN, EWA_F32, 25, 0, 0},
};

/// Byte of each part of a record, 0: it has none.
static const struct {
    uint8_t gps_time, color, nir, wave;
} parts[EWA_LAS_MAX_FORMAT + 1] = {{0, 0, 0, 0},    {20, 0, 0, 0},   {0, 20, 0, 0},   {20, 28, 0, 0},
                                   {20, 0, 0, 28},  {20, 28, 0, 34}, {22, 0, 0, 0},   {22, 30, 0, 0},
                                   {22, 30, 36, 0}, {22, 0, 0, 30},  {22, 30, 36, 38}};

/// Attributes of three numbers whose fields have names of their own, as they are written.
static const struct {
    const char *attribute, *names[3];
} groups[] = {
    {EWA_NORMAL, {"NormalX", "NormalY", "NormalZ"}}, {EWA_NORMAL, {"nx", "ny", "nz"}},
    {EWA_TANGENT_U, {"tu_x", "tu_y", "tu_z"}},       {EWA_TANGENT_V, {"tv_x", "tv_y", "tv_z"}},
    {EWA_CLIP0, {"clip0_a", "clip0_b", "clip0_c"}},  {EWA_CLIP1, {"clip1_a", "clip1_b", "clip1_c"}},
    {EWA_BORDER, {"border_x", "border_y", "border_z"}}};
enum { GROUP_COUNT = sizeof groups / sizeof groups[0] };

/// Attributes of one number whose field has another name, as it is written.
static const struct { const char *attribute, *name; } aliases[] = {{EWA_RADIUS, "Radius"}};
enum { ALIAS_COUNT = sizeof aliases / sizeof aliases[0] };

static ewa_las_column *add(ewa_las_table *table, const char *name, ewa_las_kind kind, ewa_type type,
                           uint32_t at_bytes) {
    ewa_las_column *column = &table->columns[table->column_count++];
    *column =
        (ewa_las_column){.kind = kind, .type = type, .component_count = 1, .at_bytes = {(uint16_t)at_bytes}};
    snprintf(column->name, sizeof column->name, "%s", name);
    return column;
}

static void add_fields(ewa_las_table *table, const field *fields, size_t count, uint32_t at_bytes) {
    for (size_t i = 0; i < count; i++) {
        const field *f = &fields[i];
        ewa_las_column *column = add(table, f->name, f->kind, f->type, at_bytes + f->at_bytes);
        column->shift = f->shift;
        column->mask = f->mask;
        column->raw = EWA_LAS_U64;
    }
}

ewa_las_column *ewa_las_table_find(ewa_las_table *table, const char *name) {
    for (uint32_t i = 0; i < table->column_count; i++)
        if (strcmp(table->columns[i].name, name) == 0) return &table->columns[i];
    return NULL;
}

const char *ewa_las_part_name(const char *attribute, uint32_t component) {
    for (uint32_t g = 0; g < GROUP_COUNT; g++)
        if (strcmp(groups[g].attribute, attribute) == 0) return groups[g].names[component];
    return NULL;
}

const char *ewa_las_alias(const char *attribute) {
    for (uint32_t i = 0; i < ALIAS_COUNT; i++)
        if (strcmp(aliases[i].attribute, attribute) == 0) return aliases[i].name;
    return attribute;
}

static const uint8_t raw_bytes[RAW_TYPE_COUNT] = {1, 1, 1, 2, 2, 4, 4, 8, 8, 4, 8};

/// One field of extra bytes, as its description has it.
typedef struct extra {
    char name[EWA_LAS_EXTRA_NAME_BYTES + 1];
    ewa_las_raw raw;
    uint32_t component_count, size_bytes;
    bool scaled, shifted, marked;
    const uint8_t *missing, *scales, *offsets; ///< three numbers each
} extra;

/// Reads a description; false when it is of no known type.
static bool read_extra(const uint8_t *bytes, extra *e) {
    enum { LAST_TYPE = 30, NO_DATA = 1, SCALE = 8, OFFSET = 16 };
    const uint8_t type = bytes[2], options = bytes[3];
    if (type > LAST_TYPE) return false;
    *e = (extra){.missing = bytes + 40, .scales = bytes + 112, .offsets = bytes + 136};
    ewa_las_text(bytes + 4, EWA_LAS_EXTRA_NAME_BYTES, e->name);
    if (type == 0) {
        e->size_bytes = e->component_count = options;
        return true;
    }
    e->raw = (ewa_las_raw)((type - 1) % 10 + 1);
    e->component_count = (uint32_t)(type - 1) / 10 + 1;
    e->size_bytes = e->component_count * raw_bytes[e->raw];
    e->marked = options & NO_DATA;
    e->scaled = options & SCALE;
    e->shifted = options & OFFSET;
    return true;
}

/// The mark for no data has the field's own kind of number in 8 bytes.
static double missing_number(ewa_las_raw raw, const uint8_t *bytes) {
    const uint64_t bits = ewa_las_u64(bytes);
    if (raw == EWA_LAS_F32 || raw == EWA_LAS_F64) return ewa_las_f64(bytes);
    const bool is_signed =
        raw == EWA_LAS_I8 || raw == EWA_LAS_I16 || raw == EWA_LAS_I32 || raw == EWA_LAS_I64;
    return is_signed ? (double)(int64_t)bits : (double)bits;
}

uint32_t ewa_las_raw_bytes(ewa_las_raw raw) { return raw_bytes[raw]; }

void ewa_las_column_number(ewa_las_raw raw, ewa_las_column *column) {
    static const ewa_type types[RAW_TYPE_COUNT] = {EWA_U8,  EWA_U8,  EWA_I8,  EWA_U16, EWA_I16, EWA_U32,
                                                   EWA_I32, EWA_F64, EWA_F64, EWA_F32, EWA_F64};
    column->raw = raw;
    column->type = types[raw];
    column->kind = raw == EWA_LAS_U64 || raw == EWA_LAS_I64 ? EWA_LAS_WIDE : EWA_LAS_PLAIN;
}

static void lay_extra(const extra *e, ewa_las_column *column) {
    ewa_las_column_number(e->raw, column);
    column->component_count = e->component_count;
    for (uint32_t c = 0; c < e->component_count; c++)
        column->at_bytes[c] = (uint16_t)(column->at_bytes[0] + c * raw_bytes[e->raw]);
    const bool is_float = e->raw == EWA_LAS_F32 || e->raw == EWA_LAS_F64;
    if (!e->scaled && !e->shifted && !(e->marked && is_float)) return;
    column->kind = EWA_LAS_SCALED;
    if (e->scaled || e->shifted) column->type = EWA_F64;
    column->marked = e->marked;
    for (uint32_t c = 0; c < e->component_count; c++) {
        column->scale[c] = e->scaled ? ewa_las_f64(e->scales + 8 * c) : 1;
        column->offset[c] = e->shifted ? ewa_las_f64(e->offsets + 8 * c) : 0;
        column->missing[c] = missing_number(e->raw, e->missing + 8 * c);
    }
}

/// Adds bytes without a type as attributes of up to four each, numbered from the second on. Returns false when there is
/// no room for all.
static bool add_bytes(ewa_las_table *table, const char *name, uint32_t at_bytes, uint32_t count) {
    for (uint32_t i = 0; 4 * i < count; i++) {
        char part[EWA_NAME_BYTES];
        snprintf(part, sizeof part, i ? "%.48s_%u" : "%.48s", name, i);
        if (table->column_count == EWA_LAS_MAX_COLUMNS || ewa_las_table_find(table, part)) return false;
        ewa_las_column *column = add(table, part, EWA_LAS_PLAIN, EWA_U8, at_bytes + 4 * i);
        column->component_count = count - 4 * i < 4 ? count - 4 * i : 4;
        for (uint32_t c = 1; c < column->component_count; c++)
            column->at_bytes[c] = (uint16_t)(column->at_bytes[0] + c);
    }
    return true;
}

/// Adds a field; one with the name of a field of the point format takes its place, since it holds the same in
/// full. Returns false when there is no room.
static bool add_extra(ewa_las_table *table, const extra *e, uint32_t at_bytes) {
    if (e->raw == EWA_LAS_RAW_BYTES) return add_bytes(table, e->name, at_bytes, e->component_count);
    ewa_las_column *column = ewa_las_table_find(table, e->name);
    if (column && (column->component_count != 1 || e->component_count != 1 ||
                   column->at_bytes[0] >= table->record_bytes))
        return false;
    if (!column && table->column_count == EWA_LAS_MAX_COLUMNS) return false;
    if (column) {
        *column = (ewa_las_column){.at_bytes = {(uint16_t)at_bytes}};
        memcpy(column->name, e->name, sizeof e->name);
    } else {
        column = add(table, e->name, EWA_LAS_PLAIN, EWA_U8, at_bytes);
    }
    lay_extra(e, column);
    return true;
}

/// Whether a column is a plain number from extra bytes, of this type.
static bool is_part(const ewa_las_column *column, ewa_type type) {
    return column && column->kind == EWA_LAS_PLAIN && column->component_count == 1 && column->type == type;
}

/// Whether two columns can be numbers of one attribute: plain floats of one type, or whole numbers of one type
/// with a scale.
static bool are_parts(const ewa_las_column *a, const ewa_las_column *b) {
    if (a->kind == EWA_LAS_PLAIN) return is_part(a, a->type) && is_part(b, a->type) && a->type <= EWA_F64;
    return a->kind == EWA_LAS_SCALED && b->kind == EWA_LAS_SCALED && a->component_count == 1 &&
           b->component_count == 1 && a->raw == b->raw && a->raw < EWA_LAS_F32 && !a->marked && !b->marked;
}

static void drop(ewa_las_table *table, const ewa_las_column *column) {
    const uint32_t index = (uint32_t)(column - table->columns);
    memmove(&table->columns[index], &table->columns[index + 1],
            (table->column_count - index - 1) * sizeof *table->columns);
    table->column_count--;
}

void ewa_las_table_join(ewa_las_table *table) {
    for (uint32_t g = 0; g < GROUP_COUNT; g++) {
        ewa_las_column *first = ewa_las_table_find(table, groups[g].names[0]);
        if (!first || ewa_las_table_find(table, groups[g].attribute)) continue;
        for (uint32_t c = 1; c < 3 && first; c++) {
            const ewa_las_column *part = ewa_las_table_find(table, groups[g].names[c]);
            if (!part || !are_parts(first, part)) first = NULL;
        }
        if (!first) continue;
        // Numbers of 16 bits with a scale are fractions of 16 bits, for which floats have room.
        if (first->kind == EWA_LAS_SCALED && first->raw <= EWA_LAS_I16) first->type = EWA_F32;
        snprintf(first->name, sizeof first->name, "%s", groups[g].attribute);
        for (uint32_t c = 1; c < 3; c++) {
            const ewa_las_column *part = ewa_las_table_find(table, groups[g].names[c]);
            first->at_bytes[c] = part->at_bytes[0];
            first->scale[c] = part->scale[0];
            first->offset[c] = part->offset[0];
            drop(table, part);
            first = ewa_las_table_find(table, groups[g].attribute);
        }
        first->component_count = 3;
    }
    for (uint32_t i = 0; i < ALIAS_COUNT; i++) {
        ewa_las_column *column = ewa_las_table_find(table, aliases[i].name);
        if (column && column->component_count == 1 && !ewa_las_table_find(table, aliases[i].attribute))
            snprintf(column->name, sizeof column->name, "%s", aliases[i].attribute);
    }
    ewa_las_column *color = ewa_las_table_find(table, EWA_COLOR);
    const ewa_las_column *alpha = ewa_las_table_find(table, "alpha");
    if (!color || color->kind != EWA_LAS_COLOR || !is_part(alpha, EWA_U16)) return;
    color->at_bytes[color->component_count++] = alpha->at_bytes[0];
    drop(table, alpha);
}

/// Adds what lies behind the fields of the point format.
static void add_extras(const ewa_cloud_source *source, const ewa_las_header *header, ewa_las_table *table) {
    uint32_t at = ewa_las_format_bytes(header->point_format), left_out = 0;
    ewa_las_vlr vlr;
    uint64_t count = 0;
    if (ewa_las_find(source, header, "LASF_Spec", 4, &vlr)) count = vlr.size_bytes / EWA_LAS_EXTRA_BYTES;
    if (count > MAX_EXTRA_FIELDS) count = MAX_EXTRA_FIELDS;
    for (uint64_t i = 0; i < count; i++) {
        extra e;
        if (!read_extra(vlr.bytes + i * EWA_LAS_EXTRA_BYTES, &e) ||
            e.size_bytes > header->record_bytes - at) {
            ewa_report(source->context, EWA_SEVERITY_WARNING,
                       "%s: extra bytes: field %llu of %llu is of no known type or does not fit the %u bytes "
                       "of a record; it and those behind it stay bytes",
                       source->name, (unsigned long long)i + 1, (unsigned long long)count,
                       header->record_bytes);
            break;
        }
        if (!e.name[0]) snprintf(e.name, sizeof e.name, "extra_%u", (unsigned)i);
        left_out += e.size_bytes && !add_extra(table, &e, at);
        at += e.size_bytes;
    }
    // Whole fields that writers forgot to describe; a name that is taken by a field is not theirs.
    if (at < header->record_bytes)
        left_out += !add_bytes(table, "extra_bytes", at, header->record_bytes - at);
    if (left_out)
        ewa_report(source->context, EWA_SEVERITY_WARNING,
                   "%s: extra bytes: %u fields are left out, since there are too many or two of one name",
                   source->name, left_out);
}

void ewa_las_table_begin(uint8_t point_format, ewa_las_table *table) {
    const uint8_t format = point_format;
    memset(table, 0, sizeof *table);
    table->record_bytes = ewa_las_format_bytes(format);
    ewa_las_column *position = add(table, EWA_POSITION, EWA_LAS_POSITION, EWA_F64, 0);
    position->component_count = 3;
    for (uint32_t c = 0; c < 3; c++) position->at_bytes[c] = (uint16_t)(4 * c);
    if (format < 6)
        add_fields(table, fields_legacy, sizeof fields_legacy / sizeof *fields_legacy, 0);
    else
        add_fields(table, fields_extended, sizeof fields_extended / sizeof *fields_extended, 0);
    if (parts[format].gps_time) add(table, "gps_time", EWA_LAS_PLAIN, EWA_F64, parts[format].gps_time);
    if (parts[format].color) {
        ewa_las_column *color = add(table, EWA_COLOR, EWA_LAS_COLOR, EWA_U16, parts[format].color);
        color->component_count = 3;
        for (uint32_t c = 1; c < 3; c++) color->at_bytes[c] = (uint16_t)(color->at_bytes[0] + 2 * c);
    }
    if (parts[format].nir) add(table, "nir", EWA_LAS_PLAIN, EWA_U16, parts[format].nir);
    if (parts[format].wave)
        add_fields(table, fields_wave, sizeof fields_wave / sizeof *fields_wave, parts[format].wave);
    const ewa_las_column *color = ewa_las_table_find(table, EWA_COLOR);
    table->color_at = color ? (uint32_t)(color - table->columns) : table->column_count;
}

void ewa_las_table_make(const ewa_cloud_source *source, const ewa_las_header *header, ewa_las_table *table) {
    ewa_las_table_begin(header->point_format, table);
    add_extras(source, header, table);
    ewa_las_table_join(table);
    table->record_bytes = header->record_bytes;
    const ewa_las_column *color = ewa_las_table_find(table, EWA_COLOR);
    table->color_at =
        color && color->kind == EWA_LAS_COLOR ? (uint32_t)(color - table->columns) : table->column_count;
    for (int c = 0; c < 3; c++) {
        // The whole number nearest to the header's minimum, so that the positions are small numbers.
        const double first = nearbyint((header->low[c] - header->offset[c]) / header->scale[c]);
        table->scale[c] = header->scale[c];
        table->first[c] = !isfinite(first)    ? 0
                          : first < INT32_MIN ? INT32_MIN
                          : first > INT32_MAX ? INT32_MAX
                                              : (int64_t)first;
    }
}
