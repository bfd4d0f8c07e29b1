// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From the streams of a cloud to LAS records: the way back of las_unpack.c, field by field. Numbers of
// another type than their field's are rounded and kept within its range.
#include "cloud/cloud.h"
#include "image/srgb.h"
#include "io/las/las_write.h"
#include "io/records.h"

#include <math.h>
#include <string.h>

enum { BLOCK_POINTS = 256 };

/// Up to BLOCK_POINTS points of a piece and their records.
typedef struct block {
    const ewa_attribute *attribute; ///< of the field at hand
    uint64_t first;
    size_t count;
    uint8_t *records;
    size_t stride;
    ewa_las_sums *sums;
} block;

/// Rounds to the nearest whole number, ties to even, within 2^51: an addition each, not a call.
static inline double rounded(double value) { return value + 0x1.8p52 - 0x1.8p52; }

static double clamp(double value, double low, double high, ewa_las_sums *sums) {
    // Not a number is 0, as where a number is missing.
    if (value >= low && value <= high) return value;
    sums->clamped_count++;
    return value < low ? low : value > high ? high : 0;
}

static void pack_positions(const ewa_las_plan *plan, const double shift_steps[3], const block *b) {
    double positions[3 * BLOCK_POINTS];
    ewa_attribute_read_f64(b->attribute, b->first, b->count, positions);
    uint8_t *to = b->records;
    double steps_per_unit[3];
    for (int c = 0; c < 3; c++) steps_per_unit[c] = 1 / plan->table.scale[c];
    for (size_t i = 0; i < b->count; i++, to += b->stride) {
        for (int c = 0; c < 3; c++) {
            const double step = rounded(positions[3 * i + c] * steps_per_unit[c] + shift_steps[c]);
            const int32_t whole = (int32_t)(step < INT32_MIN   ? INT32_MIN
                                            : step > INT32_MAX ? INT32_MAX
                                                               : step);
            if (whole < b->sums->low[c]) b->sums->low[c] = whole;
            if (whole > b->sums->high[c]) b->sums->high[c] = whole;
            ewa_las_put_u32(to + 4 * c, (uint32_t)whole);
        }
    }
}

/// Puts whole numbers, rounded, into a field.
static void pack_numbers(const ewa_las_column *column, const double *values, const block *b) {
    uint8_t *to = b->records + column->at_bytes[0];
    for (size_t i = 0; i < b->count; i++, to += b->stride) {
        const double value = rounded(values[i]);
        if (column->kind == EWA_LAS_BITS)
            *to |= (uint8_t)((uint32_t)clamp(value, 0, column->mask, b->sums) << column->shift);
        else if (column->kind == EWA_LAS_RANK)
            *to = (uint8_t)(int8_t)clamp(value, -128, 127, b->sums);
        else if (column->kind == EWA_LAS_ANGLE)
            ewa_las_put_u16(to, (uint16_t)(int16_t)clamp(value, -32768, 32767, b->sums));
        else if (column->type == EWA_U8)
            *to = (uint8_t)clamp(value, 0, UINT8_MAX, b->sums);
        else if (column->type == EWA_U16)
            ewa_las_put_u16(to, (uint16_t)clamp(value, 0, UINT16_MAX, b->sums));
        else
            ewa_las_put_f64(to, values[i]);
    }
}

/// Bits of a byte from bytes: most fields of most clouds.
static void pack_bits(const ewa_las_column *column, const block *b) {
    const uint8_t *from = (const uint8_t *)b->attribute->data + b->first * b->attribute->stride_bytes;
    uint8_t *to = b->records + column->at_bytes[0];
    const uint32_t mask = column->mask, shift = column->shift;
    uint64_t above_count = 0;
    for (size_t i = 0; i < b->count; i++, from += b->attribute->stride_bytes, to += b->stride) {
        const uint32_t value = *from < mask ? *from : mask;
        above_count += *from > mask;
        *to |= (uint8_t)(value << shift);
    }
    b->sums->clamped_count += above_count;
}

static void pack_colors(const ewa_las_column *column, const block *b) {
    double values[4 * BLOCK_POINTS];
    const ewa_attribute *attribute = b->attribute;
    const uint32_t components = attribute->component_count;
    ewa_attribute_read_f64(attribute, b->first, b->count, values);
    const bool is_linear = attribute->type == EWA_F32 || attribute->type == EWA_F64;
    for (size_t i = 0; i < b->count; i++) {
        for (uint32_t c = 0; c < column->component_count; c++) {
            double value = values[components * i + c];
            if (is_linear) {
                value = value > 0 ? value < 1 ? value : 1 : 0;
                value = nearbyint(65535 * (c == 3 ? value : ewa_srgb_encode(value)));
            } else if (attribute->type == EWA_U16) {
                value = clamp(value, 0, 65535, b->sums);
            } else {
                value = 257 * clamp(value, 0, 255, b->sums);
            }
            ewa_las_put_u16(b->records + i * b->stride + column->at_bytes[c], (uint16_t)value);
        }
    }
}

static void pack_plain(const ewa_las_column *column, const block *b) {
    const ewa_attribute *attribute = b->attribute;
    const ewa_move move = {.from_type = attribute->type,
                           .to_type = attribute->type,
                           .component_count = attribute->component_count};
    ewa_move_numbers(&move, b->records + column->at_bytes[0], b->stride,
                     (const uint8_t *)attribute->data + b->first * attribute->stride_bytes,
                     attribute->stride_bytes, b->count);
}

static void pack_column(const ewa_las_plan *plan, const ewa_las_column *column, const block *b) {
    const ewa_attribute *attribute = b->attribute;
    if (column->kind == EWA_LAS_COLOR) {
        pack_colors(column, b);
    } else if (column->kind == EWA_LAS_PLAIN && column->type == attribute->type) {
        pack_plain(column, b);
    } else if (column->kind == EWA_LAS_BITS && attribute->type == EWA_U8) {
        pack_bits(column, b);
    } else {
        double values[BLOCK_POINTS];
        ewa_attribute_read_f64(attribute, b->first, b->count, values);
        double factor = column->kind == EWA_LAS_ANGLE ? 1 / 0.006 : 1;
        if (strcmp(column->name, "intensity") == 0) factor = plan->intensity_scale;
        for (size_t i = 0; i < b->count && factor != 1; i++) values[i] *= factor;
        pack_numbers(column, values, b);
    }
}

/// What a point gets that says nothing of returns: the only one of its pulse.
static void pack_single_returns(const ewa_las_column *column, const block *b) {
    uint8_t *to = b->records + column->at_bytes[0];
    for (size_t i = 0; i < b->count; i++, to += b->stride) *to |= (uint8_t)(1u << column->shift);
}

void ewa_las_pack(const ewa_las_plan *plan, const ewa_cloud *piece, uint64_t first, uint64_t count,
                  uint8_t *records, ewa_las_sums *sums) {
    const ewa_las_table *table = &plan->table;
    double origin_world[3], shift_steps[3];
    ewa_cloud_origin(piece, origin_world);
    for (int c = 0; c < 3; c++) shift_steps[c] = (origin_world[c] - plan->offset_world[c]) / table->scale[c];
    memset(records, 0, count * table->record_bytes);
    for (uint64_t done = 0; done < count; done += BLOCK_POINTS) {
        block b = {.first = first + done,
                   .count = (size_t)(count - done < BLOCK_POINTS ? count - done : BLOCK_POINTS),
                   .records = records + done * table->record_bytes,
                   .stride = table->record_bytes,
                   .sums = sums};
        for (uint32_t i = 0; i < table->column_count; i++) {
            const ewa_las_column *column = &table->columns[i];
            b.attribute =
                plan->sources[i] < 0 ? NULL : ewa_cloud_attribute_at(piece, (uint32_t)plan->sources[i]);
            if (column->kind == EWA_LAS_POSITION)
                pack_positions(plan, shift_steps, &b);
            else if (b.attribute)
                pack_column(plan, column, &b);
            else if (strstr(column->name, "return"))
                pack_single_returns(column, &b);
        }
        const uint8_t returns_mask = plan->point_format < 6 ? 7 : 15;
        for (size_t i = 0; i < b.count; i++) sums->by_return[b.records[i * b.stride + 14] & returns_mask]++;
    }
}

void ewa_las_sums_add(ewa_las_sums *sums, const ewa_las_sums *more) {
    for (int c = 0; c < 3; c++) {
        if (more->low[c] < sums->low[c]) sums->low[c] = more->low[c];
        if (more->high[c] > sums->high[c]) sums->high[c] = more->high[c];
    }
    for (int i = 0; i <= EWA_LAS_RETURNS; i++) sums->by_return[i] += more->by_return[i];
    sums->clamped_count += more->clamped_count;
}
