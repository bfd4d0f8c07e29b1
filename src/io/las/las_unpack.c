// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From LAS records to the streams of a cloud: blocks of records that stay in the nearest cache, one loop for
// each attribute.
#include "io/las/las.h"
#include "io/records.h"

#include <math.h>
#include <string.h>

enum { BLOCK_BYTES = 1 << 14, BLOCK_POINTS = BLOCK_BYTES / 20 };

/// The records of a block and where the numbers of one attribute go.
typedef struct block {
    const uint8_t *records;
    size_t stride, count; ///< bytes from record to record, records
    uint8_t *to;
    size_t to_stride;
} block;

static void unpack_positions(const ewa_las_table *table, const ewa_las_column *column, const block *b) {
    const int64_t x0 = table->first[0], y0 = table->first[1], z0 = table->first[2];
    const double sx = table->scale[0], sy = table->scale[1], sz = table->scale[2];
    const size_t x_at = column->at_bytes[0], y_at = column->at_bytes[1], z_at = column->at_bytes[2];
    const uint8_t *from = b->records;
    uint8_t *to = b->to;
    for (size_t i = 0; i < b->count; i++, from += b->stride, to += b->to_stride) {
        const double position[3] = {(double)((int32_t)ewa_bytes_u32(from + x_at) - x0) * sx,
                                    (double)((int32_t)ewa_bytes_u32(from + y_at) - y0) * sy,
                                    (double)((int32_t)ewa_bytes_u32(from + z_at) - z0) * sz};
        memcpy(to, position, sizeof position);
    }
}

/// Bytes of a block that several fields share, side by side, so that those are taken apart many at a time.
typedef struct shared_bytes {
    uint32_t at_bytes; ///< in the record; UINT32_MAX: none yet
    uint8_t bytes[BLOCK_POINTS];
} shared_bytes;

static void unpack_bits(const ewa_las_column *column, shared_bytes *shared, const block *b) {
    const uint32_t shift = column->shift, mask = column->mask;
    if (shared->at_bytes != column->at_bytes[0]) {
        const uint8_t *from = b->records + column->at_bytes[0];
        shared->at_bytes = column->at_bytes[0];
        for (size_t i = 0; i < b->count; i++) shared->bytes[i] = from[i * b->stride];
    }
    uint8_t *restrict to = b->to;
    const uint8_t *restrict bytes = shared->bytes;
    if (b->to_stride == 1)
        for (size_t i = 0; i < b->count; i++) to[i] = (uint8_t)(bytes[i] >> shift & mask);
    else
        for (size_t i = 0; i < b->count; i++) to[i * b->to_stride] = (uint8_t)(bytes[i] >> shift & mask);
}

static void unpack_angles(const ewa_las_column *column, const block *b) {
    const uint8_t *from = b->records + column->at_bytes[0];
    uint8_t *to = b->to;
    const bool is_rank = column->kind == EWA_LAS_RANK;
    for (size_t i = 0; i < b->count; i++, from += b->stride, to += b->to_stride) {
        const float angle =
            is_rank ? (float)(int8_t)*from : (float)((double)(int16_t)ewa_las_u16(from) * 0.006);
        memcpy(to, &angle, sizeof angle);
    }
}

static uint64_t unpack_colors_8(const ewa_las_column *column, uint32_t color_shift, const block *b) {
    const uint32_t count = column->component_count;
    const uint32_t last = count - 1; // the alpha, or the blue again
    const uint8_t *from = b->records;
    uint8_t *to = b->to;
    uint64_t above_count = 0;
    for (size_t i = 0; i < b->count; i++, from += b->stride, to += b->to_stride) {
        uint32_t values[4] = {
            ewa_las_u16(from + column->at_bytes[0]), ewa_las_u16(from + column->at_bytes[1]),
            ewa_las_u16(from + column->at_bytes[2]), ewa_las_u16(from + column->at_bytes[last])};
        for (int c = 0; c < 4; c++) values[c] >>= color_shift;
        if ((values[0] | values[1] | values[2] | values[3]) > 255)
            for (uint32_t c = 0; c < 4; c++) {
                above_count += values[c] > 255 && c < count;
                if (values[c] > 255) values[c] = 255;
            }
        to[0] = (uint8_t)values[0];
        to[1] = (uint8_t)values[1];
        to[2] = (uint8_t)values[2];
        to[last] = (uint8_t)values[3];
    }
    return above_count;
}

static double load(ewa_las_raw raw, const uint8_t *from) {
    switch (raw) {
    case EWA_LAS_I8:
        return (int8_t)*from;
    case EWA_LAS_U16:
        return ewa_las_u16(from);
    case EWA_LAS_I16:
        return (int16_t)ewa_las_u16(from);
    case EWA_LAS_U32:
        return ewa_bytes_u32(from);
    case EWA_LAS_I32:
        return (int32_t)ewa_bytes_u32(from);
    case EWA_LAS_U64:
        return (double)ewa_las_u64(from);
    case EWA_LAS_I64:
        return (double)(int64_t)ewa_las_u64(from);
    case EWA_LAS_F32: {
        const uint32_t bits = ewa_bytes_u32(from);
        float value;
        memcpy(&value, &bits, sizeof value);
        return value;
    }
    case EWA_LAS_F64:
        return ewa_las_f64(from);
    default:
        return *from;
    }
}

/// Numbers that are computed with: 64-bit integers, scaled ones, and those with a mark for no data.
static void unpack_computed(const ewa_las_column *column, const block *b) {
    const bool is_plain = column->kind == EWA_LAS_WIDE;
    const size_t number_bytes = ewa_type_bytes(column->type);
    for (uint32_t c = 0; c < column->component_count; c++) {
        const uint8_t *from = b->records + column->at_bytes[c];
        uint8_t *to = b->to + c * number_bytes;
        for (size_t i = 0; i < b->count; i++, from += b->stride, to += b->to_stride) {
            double value = load(column->raw, from);
            if (column->marked && value == column->missing[c])
                value = NAN;
            else if (!is_plain)
                value = value * column->scale[c] + column->offset[c];
            if (column->type == EWA_F32) {
                const float narrow = (float)value;
                memcpy(to, &narrow, sizeof narrow);
            } else {
                memcpy(to, &value, sizeof value);
            }
        }
    }
}

/// Numbers that are moved as they are, side by side in one go.
static void unpack_plain(const ewa_las_column *column, const block *b) {
    const size_t number_bytes = ewa_type_bytes(column->type);
    for (uint32_t c = 0; c < column->component_count;) {
        uint32_t run = 1;
        while (c + run < column->component_count &&
               column->at_bytes[c + run] == column->at_bytes[c] + run * number_bytes)
            run++;
        const ewa_move move = {.from_type = column->type, .to_type = column->type, .component_count = run};
        ewa_move_numbers(&move, b->to + c * number_bytes, b->to_stride, b->records + column->at_bytes[c],
                         b->stride, b->count);
        c += run;
    }
}

static uint64_t unpack_column(const ewa_las_table *table, const ewa_las_column *column, shared_bytes *shared,
                              const block *b) {
    switch (column->kind) {
    case EWA_LAS_POSITION:
        unpack_positions(table, column, b);
        break;
    case EWA_LAS_BITS:
        unpack_bits(column, shared, b);
        break;
    case EWA_LAS_RANK:
    case EWA_LAS_ANGLE:
        unpack_angles(column, b);
        break;
    case EWA_LAS_COLOR:
        if (column->type == EWA_U8) return unpack_colors_8(column, table->color_shift, b);
        unpack_plain(column, b);
        break;
    case EWA_LAS_PLAIN:
        unpack_plain(column, b);
        break;
    case EWA_LAS_WIDE:
    case EWA_LAS_SCALED:
        unpack_computed(column, b);
        break;
    }
    return 0;
}

uint64_t ewa_las_unpack(const ewa_las_table *table, const uint8_t *records, uint64_t count,
                        const ewa_cloud_sink *sinks) {
    const uint64_t maximum = BLOCK_BYTES / table->record_bytes > 0 ? BLOCK_BYTES / table->record_bytes : 1;
    uint64_t above_count = 0;
    for (uint64_t first = 0; first < count; first += maximum) {
        block b = {.records = records + first * table->record_bytes,
                   .stride = table->record_bytes,
                   .count = (size_t)(count - first < maximum ? count - first : maximum)};
        shared_bytes shared;
        shared.at_bytes = UINT32_MAX;
        for (uint32_t i = 0; i < table->column_count; i++) {
            if (!sinks[i].to) continue;
            b.to = sinks[i].to + first * sinks[i].stride_bytes;
            b.to_stride = sinks[i].stride_bytes;
            above_count += unpack_column(table, &table->columns[i], &shared, &b);
        }
    }
    return above_count;
}
