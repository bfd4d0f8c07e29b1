// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which fields of a PCD file make up which attribute of a cloud, and how their numbers get there.
#include "base/base.h"
#include "io/cloud/pcd.h"
#include "io/records.h"

#include <stdio.h>

enum {
    MAX_SPELLINGS = 2,
    BLOCK_POINTS = 1024, ///< whose positions are looked at before they are moved
};

/// Bytes of files are in this order.
static const bool is_swapped = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;

/// An attribute that several fields make up.
typedef struct group {
    const char *attribute;
    uint32_t min_components, max_components;
    const char *spellings[MAX_SPELLINGS][4];
} group;

static const group groups[] = {
    {EWA_POSITION, 3, 3, {{"x", "y", "z"}}},
    {EWA_NORMAL, 3, 3, {{"normalx", "normaly", "normalz"}, {"nx", "ny", "nz"}}},
    {EWA_COLOR, 3, 4, {{"red", "green", "blue", "alpha"}, {"r", "g", "b", "a"}}},
};
enum { GROUP_COUNT = sizeof groups / sizeof groups[0] };

/// Names that scans have in common, and how their fields are spelt without regard to case and '_'.
static const struct {
    const char *attribute, *spelling;
} names[] = {
    {"radius", "radius"},
    {"intensity", "intensity"},
    {"return_number", "returnnumber"},
    {"number_of_returns", "numberofreturns"},
    {"scan_direction_flag", "scandirectionflag"},
    {"edge_of_flight_line", "edgeofflightline"},
    {"classification", "classification"},
    {"synthetic", "synthetic"},
    {"key_point", "keypoint"},
    {"withheld", "withheld"},
    {"overlap", "overlap"},
    {"scanner_channel", "scannerchannel"},
    {"user_data", "userdata"},
    {"scan_angle", "scanangle"},
    {"scan_angle", "scananglerank"},
    {"point_source_id", "pointsourceid"},
    {"gps_time", "gpstime"},
    {"nir", "nir"},
    {"nir", "infrared"},
};

/// Whether a name is this one without regard to case and '_'.
static bool is_spelt(ewa_text name, const char *spelling) {
    for (size_t i = 0; i < name.length; i++) {
        const char c = name.chars[i];
        if (c == '_') continue;
        if ((c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c) != *spelling || !*spelling) return false;
        spelling++;
    }
    return !*spelling;
}

static const ewa_pcd_field *find(const ewa_pcd_header *header, const char *spelling) {
    for (uint32_t i = 0; i < header->field_count; i++) {
        const ewa_pcd_field *field = &header->fields[i];
        if (!field->padding && field->count == 1 && is_spelt(field->name, spelling)) return field;
    }
    return NULL;
}

/// Type of an attribute with the numbers of a field; integers of 8 bytes become doubles.
static ewa_type type_of(const ewa_pcd_field *field) {
    switch (field->size_bytes) {
    case 1:
        return field->kind == 'I' ? EWA_I8 : EWA_U8;
    case 2:
        return field->kind == 'I' ? EWA_I16 : EWA_U16;
    case 4:
        return field->kind == 'F' ? EWA_F32 : field->kind == 'I' ? EWA_I32 : EWA_U32;
    default:
        return EWA_F64;
    }
}

static bool is_wide_integer(const ewa_pcd_field *field) {
    return field->size_bytes == 8 && field->kind != 'F';
}

static ewa_type color_type(const ewa_pcd_field *field) {
    if (field->kind == 'F') return EWA_F32;
    return field->kind == 'U' && field->size_bytes == 2 ? EWA_U16 : EWA_U8;
}

static ewa_type group_type(const ewa_pcd_column *column, const group *g) {
    if (strcmp(g->attribute, EWA_COLOR) == 0) return color_type(column->sources[0]);
    if (strcmp(g->attribute, EWA_POSITION) == 0)
        for (uint32_t c = 0; c < 3; c++) {
            const ewa_type part = type_of(column->sources[c]);
            if (part == EWA_F64 || part == EWA_I32 || part == EWA_U32) return EWA_F64;
        }
    return EWA_F32;
}

/// Fills a column when all fields of one spelling are there.
static bool match(const ewa_pcd_header *header, const group *g, ewa_pcd_column *column) {
    const bool is_color = strcmp(g->attribute, EWA_COLOR) == 0;
    for (uint32_t s = 0; s < MAX_SPELLINGS && g->spellings[s][0]; s++) {
        *column = (ewa_pcd_column){.component_count = g->min_components};
        bool found = true;
        for (uint32_t c = 0; c < g->min_components; c++) {
            column->sources[c] = find(header, g->spellings[s][c]);
            found = found && column->sources[c];
        }
        if (!found) continue;
        if (is_color) { // numbers that mean shares of different ranges are no colour
            const ewa_type type = color_type(column->sources[0]);
            if (color_type(column->sources[1]) != type || color_type(column->sources[2]) != type) continue;
            const ewa_pcd_field *alpha = find(header, g->spellings[s][3]);
            if (alpha && color_type(alpha) == type) column->sources[column->component_count++] = alpha;
        }
        memcpy(column->attribute, g->attribute, strlen(g->attribute) + 1);
        column->type = group_type(column, g);
        return true;
    }
    return false;
}

/// Colours that are packed into one number win over others.
static bool match_packed(const ewa_pcd_header *header, ewa_pcd_column *column) {
    const ewa_pcd_field *rgb = find(header, "rgb"), *rgba = find(header, "rgba");
    const ewa_pcd_field *field = rgb && rgb->size_bytes == 4 ? rgb : rgba;
    if (!field || field->size_bytes != 4) return false;
    *column = (ewa_pcd_column){.attribute = EWA_COLOR,
                               .type = EWA_U8,
                               .component_count = field == rgb ? 3 : 4,
                               .packed = true,
                               .sources = {field}};
    return true;
}

static bool is_used(const ewa_pcd_column *columns, uint32_t count, const ewa_pcd_field *field) {
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t c = 0; c < 4; c++)
            if (columns[i].sources[c] == field) return true;
    return false;
}

static bool has_attribute(const ewa_pcd_column *columns, uint32_t count, const char *attribute) {
    for (uint32_t i = 0; i < count; i++)
        if (strcmp(columns[i].attribute, attribute) == 0) return true;
    return false;
}

static uint32_t components_of(const char *attribute) {
    for (uint32_t g = 0; g < GROUP_COUNT; g++)
        if (strcmp(groups[g].attribute, attribute) == 0) return groups[g].min_components;
    return 0;
}

/// Appends a column for `component_count` numbers of a field, from number `element` on; says why not.
static ewa_status add(const ewa_cloud_source *source, const ewa_pcd_field *field, const char *attribute,
                      uint32_t element, uint32_t component_count, ewa_pcd_column *columns, uint32_t *count) {
    const uint32_t wanted = components_of(attribute);
    const char *reason = NULL;
    if (has_attribute(columns, *count, attribute))
        reason = "there is one of that name before it";
    else if (wanted && wanted != component_count)
        reason = "an attribute of that name has another number of components";
    if (reason) {
        ewa_report(source->context, EWA_SEVERITY_WARNING, "%s: field '%s' is left out: %s", source->name,
                   attribute, reason);
        return EWA_OK;
    }
    if (*count == EWA_PCD_MAX_COLUMNS)
        return ewa_fail(source->context, EWA_ERROR_LIMIT, "%s: more than %d numbers per point", source->name,
                        EWA_PCD_MAX_COLUMNS);
    ewa_pcd_column *column = &columns[(*count)++];
    *column = (ewa_pcd_column){.type = type_of(field), .component_count = component_count};
    memcpy(column->attribute, attribute, strlen(attribute) + 1);
    if (strcmp(attribute, "gps_time") == 0) column->type = EWA_F64;
    if (strcmp(attribute, "scan_angle") == 0 && column->type != EWA_F64) column->type = EWA_F32;
    for (uint32_t c = 0; c < component_count; c++) {
        column->sources[c] = field;
        column->elements[c] = element + c;
    }
    return EWA_OK;
}

/// An attribute of the field's name; numbers beyond four become attributes of their own: name_0, name_1, ...
static ewa_status add_other(const ewa_cloud_source *source, const ewa_pcd_field *field,
                            ewa_pcd_column *columns, uint32_t *count) {
    char quote[EWA_QUOTE_BYTES], attribute[EWA_NAME_BYTES];
    const size_t room = EWA_NAME_BYTES - (field->count > 4 ? sizeof "_1000000" : 1);
    if (field->name.length > room || !ewa_text_is_name(field->name)) {
        ewa_report(source->context, EWA_SEVERITY_WARNING,
                   "%s: field %s is left out: its name is not UTF-8 of at most %zu bytes", source->name,
                   ewa_quote(field->name, quote), room);
        return EWA_OK;
    }
    const int length =
        snprintf(attribute, sizeof attribute, "%.*s", (int)field->name.length, field->name.chars);
    if (field->count == 1)
        for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
            if (is_spelt(field->name, names[i].spelling))
                snprintf(attribute, sizeof attribute, "%s", names[i].attribute);
    if (field->count <= 4) return add(source, field, attribute, 0, field->count, columns, count);
    for (uint32_t e = 0; e < field->count; e++) {
        snprintf(attribute + length, sizeof attribute - (size_t)length, "_%u", e);
        EWA_TRY(add(source, field, attribute, e, 1, columns, count));
    }
    return EWA_OK;
}

ewa_status ewa_pcd_columns_map(const ewa_cloud_source *source, const ewa_pcd_header *header,
                               ewa_pcd_column columns[EWA_PCD_MAX_COLUMNS], uint32_t *column_count) {
    uint32_t count = 0;
    for (uint32_t g = 0; g < GROUP_COUNT; g++) {
        if (strcmp(groups[g].attribute, EWA_COLOR) == 0 && match_packed(header, &columns[count]))
            count++;
        else
            count += match(header, &groups[g], &columns[count]);
        if (g == 0 && count == 0)
            return ewa_fail(source->context, EWA_ERROR_FORMAT,
                            "%s: there are no fields x, y, z of one number each", source->name);
    }
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < header->field_count && status == EWA_OK; i++)
        if (!header->fields[i].padding && !is_used(columns, count, &header->fields[i]))
            status = add_other(source, &header->fields[i], columns, &count);
    *column_count = count;
    return status;
}

static bool is_packed_alpha(const ewa_pcd_column *column) {
    return column->packed && column->component_count == 4;
}

static bool is_color16(const ewa_pcd_column *column) {
    return column->type == EWA_U16 && strcmp(column->attribute, EWA_COLOR) == 0;
}

bool ewa_pcd_needs_look(const ewa_pcd_column *columns, uint32_t column_count) {
    for (uint32_t i = 0; i < column_count; i++)
        if (is_packed_alpha(&columns[i]) || is_color16(&columns[i])) return true;
    return false;
}

void ewa_pcd_settle(const ewa_pcd_colors *colors, ewa_pcd_column *columns, uint32_t column_count) {
    for (uint32_t i = 0; i < column_count; i++) {
        if (is_packed_alpha(&columns[i]) && !colors->alpha_bits) columns[i].component_count = 3;
        if (is_color16(&columns[i]) && colors->number_bits && colors->number_bits < 256)
            columns[i].type = EWA_U8;
    }
}

static const uint8_t *number_at(const ewa_pcd_records *records, const ewa_pcd_column *column,
                                uint32_t component, uint64_t point) {
    const ewa_pcd_field *field = column->sources[component];
    return records->bytes + field->base_bytes + point * field->stride_bytes +
           (uint64_t)column->elements[component] * field->size_bytes;
}

/// Bit 31 is set when a number is not finite: when all bits of its exponent are.
static inline uint32_t overflow_of(const uint8_t *number, bool is_double) {
    uint32_t bits;
    const uint32_t exponent = is_double ? 0x7ff00000u : 0x7f800000u;
    memcpy(&bits, number + (is_double && !is_swapped ? 4 : 0), sizeof bits);
    if (is_swapped) bits = __builtin_bswap32(bits);
    return (bits & exponent) + (is_double ? 0x00100000u : 0x00800000u);
}

/// Whether all of these points have finite positions; looks at all without asking in between.
static bool is_all_finite(const ewa_pcd_records *records, uint64_t first, uint64_t count) {
    const ewa_pcd_column *position = &records->columns[0];
    uint32_t found = 0;
    for (uint32_t c = 0; c < 3; c++) {
        const ewa_pcd_field *field = position->sources[c];
        const uint8_t *number = number_at(records, position, c, first);
        const uint64_t stride = field->stride_bytes;
        if (field->kind != 'F') continue;
        if (field->size_bytes == 8)
            for (uint64_t i = 0; i < count; i++) found |= overflow_of(number + i * stride, true);
        else
            for (uint64_t i = 0; i < count; i++) found |= overflow_of(number + i * stride, false);
    }
    return !(found >> 31);
}

/// Lists which points from `first` on have a finite position, counted from it; returns how many.
static uint32_t list_finite(const ewa_pcd_records *records, uint64_t first, uint64_t count,
                            uint16_t kept[BLOCK_POINTS]) {
    uint32_t kept_count = 0;
    if (records->all_finite || is_all_finite(records, first, count)) {
        for (uint32_t i = 0; i < count; i++) kept[i] = (uint16_t)i;
        return (uint32_t)count;
    }
    const ewa_pcd_column *position = &records->columns[0];
    for (uint32_t i = 0; i < count; i++) {
        uint32_t found = 0;
        for (uint32_t c = 0; c < 3; c++)
            if (position->sources[c]->kind == 'F')
                found |= overflow_of(number_at(records, position, c, first + i),
                                     position->sources[c]->size_bytes == 8);
        kept[kept_count] = (uint16_t)i;
        kept_count += !(found >> 31);
    }
    return kept_count;
}

static uint64_t block_end(uint64_t first, uint64_t end) {
    return end - first < BLOCK_POINTS ? end : first + BLOCK_POINTS;
}

uint64_t ewa_pcd_count(const ewa_pcd_records *records, uint64_t first, uint64_t end) {
    uint16_t kept[BLOCK_POINTS];
    uint64_t kept_count = 0;
    for (uint64_t next; first < end; first = next) {
        next = block_end(first, end);
        kept_count += is_all_finite(records, first, next - first)
                          ? next - first
                          : list_finite(records, first, next - first, kept);
    }
    return kept_count;
}

void ewa_pcd_look(const ewa_pcd_records *records, uint64_t first, uint64_t end, ewa_pcd_colors *colors) {
    for (uint32_t i = 0; i < records->column_count; i++) {
        const ewa_pcd_column *column = &records->columns[i];
        for (uint64_t k = first; k < end && is_packed_alpha(column); k++)
            colors->alpha_bits |= number_at(records, column, 0, k)[is_swapped ? 0 : 3];
        for (uint32_t c = 0; c < column->component_count && is_color16(column); c++)
            for (uint64_t k = first; k < end; k++) {
                uint16_t bits;
                memcpy(&bits, number_at(records, column, c, k), sizeof bits);
                colors->number_bits |= is_swapped ? __builtin_bswap16(bits) : bits;
            }
    }
}

/// Whether all components lie side by side and have one type.
static bool is_adjacent(const ewa_pcd_column *column) {
    const ewa_pcd_field *first = column->sources[0];
    for (uint32_t c = 1; c < column->component_count; c++) {
        const ewa_pcd_field *field = column->sources[c];
        if (field->kind != first->kind || field->size_bytes != first->size_bytes ||
            field->stride_bytes != first->stride_bytes ||
            field->base_bytes + column->elements[c] * field->size_bytes !=
                first->base_bytes + (column->elements[0] + c) * first->size_bytes)
            return false;
    }
    return true;
}

static void move_wide(const ewa_pcd_field *field, uint8_t *to, size_t to_stride, const uint8_t *from,
                      uint64_t count) {
    for (uint64_t i = 0; i < count; i++) {
        uint64_t bits;
        memcpy(&bits, from + i * field->stride_bytes, sizeof bits);
        if (is_swapped) bits = __builtin_bswap64(bits);
        const double value = field->kind == 'I' ? (double)(int64_t)bits : (double)bits;
        memcpy(to + i * to_stride, &value, sizeof value);
    }
}

static void move_packed(const ewa_pcd_column *column, uint8_t *to, size_t to_stride, const uint8_t *from,
                        uint64_t count) {
    const uint64_t stride = column->sources[0]->stride_bytes;
    for (uint64_t i = 0; i < count; i++, from += stride, to += to_stride) {
        to[0] = from[2];
        to[1] = from[1];
        to[2] = from[0];
        if (column->component_count == 4) to[3] = from[3];
    }
}

static void move_column(const ewa_pcd_records *records, const ewa_pcd_column *column, uint64_t first,
                        uint64_t count, uint8_t *to, size_t to_stride) {
    if (column->packed) {
        move_packed(column, to, to_stride, number_at(records, column, 0, first), count);
        return;
    }
    const bool adjacent = is_adjacent(column) && !is_wide_integer(column->sources[0]);
    for (uint32_t c = 0; c < (adjacent ? 1 : column->component_count); c++) {
        const ewa_pcd_field *field = column->sources[c];
        const uint8_t *from = number_at(records, column, c, first);
        uint8_t *number = to + c * ewa_type_bytes(column->type);
        const ewa_move move = {type_of(field), column->type, adjacent ? column->component_count : 1,
                               is_swapped};
        if (!is_wide_integer(field)) {
            ewa_move_numbers(&move, number, to_stride, from, field->stride_bytes, count);
        } else if (column->type == EWA_F64) {
            move_wide(field, number, to_stride, from, count);
        } else { // to floats or colours: by way of doubles
            for (uint64_t i = 0; i < count; i++) {
                double value;
                move_wide(field, (uint8_t *)&value, 0, from + i * field->stride_bytes, 1);
                const ewa_move narrow = {EWA_F64, column->type, 1, false};
                ewa_move_numbers(&narrow, number + i * to_stride, 0, (const uint8_t *)&value, 0, 1);
            }
        }
    }
}

#define GATHER(size)                                                                                         \
    case size:                                                                                               \
        for (uint32_t i = 0; i < count; i++)                                                                 \
            memcpy(to + i * to_stride, from + (size_t)indices[i] * (size), size);                            \
        break

/// Copies the numbers of some points, which lie side by side.
static void gather(uint8_t *to, size_t to_stride, const uint8_t *from, size_t size_bytes,
                   const uint16_t *indices, uint32_t count) {
    switch (size_bytes) {
        GATHER(1);
        GATHER(2);
        GATHER(3);
        GATHER(4);
        GATHER(6);
        GATHER(8);
        GATHER(12);
        GATHER(16);
        GATHER(24);
        GATHER(32);
    }
}

/// Moves `count` of the points from `first` on, those of the list.
static void move_listed(const ewa_pcd_records *records, uint64_t first, const uint16_t *kept, uint32_t count,
                        const ewa_cloud_sink *sinks, uint64_t to) {
    enum { MAX_BYTES = 4 * sizeof(double) };
    uint8_t block[BLOCK_POINTS * MAX_BYTES];
    const uint32_t span = count ? kept[count - 1] + 1u : 0;
    for (uint32_t i = 0; i < records->column_count; i++) {
        const ewa_pcd_column *column = &records->columns[i];
        const size_t stride = sinks[i].stride_bytes,
                     size = column->component_count * ewa_type_bytes(column->type);
        if (!sinks[i].to) continue;
        uint8_t *numbers = sinks[i].to + to * stride;
        if (span == count) {
            move_column(records, column, first, count, numbers, stride);
            continue;
        }
        move_column(records, column, first, span, block, size);
        gather(numbers, stride, block, size, kept, count);
    }
}

uint64_t ewa_pcd_move(const ewa_pcd_records *records, uint64_t first, uint64_t end,
                      const ewa_cloud_sink *sinks, uint64_t to, uint64_t maximum, uint64_t *moved) {
    uint16_t kept[BLOCK_POINTS];
    *moved = 0;
    for (uint64_t next; first < end && *moved < maximum; first = next) {
        next = block_end(first, end);
        uint32_t count = list_finite(records, first, next - first, kept);
        if (count > maximum - *moved) {
            count = (uint32_t)(maximum - *moved);
            next = first + kept[count - 1] + 1;
        }
        move_listed(records, first, kept, count, sinks, to + *moved);
        *moved += count;
    }
    return first;
}
