// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Moving numbers between records and streams: one loop per size, so that each copy is a few machine
// instructions.
#include "io/records.h"

#include <string.h>

enum { BLOCK_NUMBERS = 256 };

/// Copies `size` bytes of each record.
#define COPY(size)                                                                                           \
    case size:                                                                                               \
        for (; from != end; to += to_stride, from += from_stride) memcpy(to, from, size);                    \
        break

/// The same where the numbers get to lie side by side: all but the last are copied as `wide` bytes at once, a
/// machine word; what that puts too much, the next one covers.
#define COPY_WIDE(size, wide)                                                                                \
    case size:                                                                                               \
        if (to_stride == (size))                                                                             \
            for (; from != last; to += (size), from += from_stride) memcpy(to, from, wide);                  \
        for (; from != end; to += to_stride, from += from_stride) memcpy(to, from, size);                    \
        break

static void copy(uint8_t *to, size_t to_stride, const uint8_t *from, size_t from_stride, size_t size_bytes,
                 size_t count) {
    if (count < 2) { // its strides may be anything
        if (count) memcpy(to, from, size_bytes);
        return;
    }
    const uint8_t *const end = from + count * from_stride, *const last = end - from_stride;
    switch (size_bytes) {
        COPY(1);
        COPY(2);
        COPY_WIDE(3, 4);
        COPY(4);
        COPY_WIDE(6, 8);
        COPY(8);
        COPY_WIDE(12, 16);
        COPY(16);
        COPY_WIDE(24, 32);
        COPY(32);
    }
}

#define COPY_SWAPPED(word, swap)                                                                             \
    for (; count; count--, to += to_stride, from += from_stride) {                                           \
        for (uint32_t c = 0; c < components; c++) {                                                          \
            word bits;                                                                                       \
            memcpy(&bits, from + c * sizeof bits, sizeof bits);                                              \
            bits = swap(bits);                                                                               \
            memcpy(to + c * sizeof bits, &bits, sizeof bits);                                                \
        }                                                                                                    \
    }                                                                                                        \
    break

static void copy_swapped(uint8_t *to, size_t to_stride, const uint8_t *from, size_t from_stride,
                         size_t number_bytes, uint32_t components, size_t count) {
    switch (number_bytes) {
    case 2:
        COPY_SWAPPED(uint16_t, __builtin_bswap16);
    case 4:
        COPY_SWAPPED(uint32_t, __builtin_bswap32);
    case 8:
        COPY_SWAPPED(uint64_t, __builtin_bswap64);
    }
}

#define SAME(bits) (bits)
#define LOAD(type, word, swap_word)                                                                          \
    for (size_t i = 0; i < count; i++, from += stride) {                                                     \
        word bits;                                                                                           \
        type value;                                                                                          \
        memcpy(&bits, from, sizeof bits);                                                                    \
        if (swap) bits = swap_word(bits);                                                                    \
        memcpy(&value, &bits, sizeof value);                                                                 \
        values[i] = (double)value;                                                                           \
    }                                                                                                        \
    break

/// Loads one component of `count` records; a double holds each of these types exactly.
static void load(double *values, ewa_type type, bool swap, const uint8_t *from, size_t stride, size_t count) {
    switch (type) {
    case EWA_F32:
        LOAD(float, uint32_t, __builtin_bswap32);
    case EWA_F64:
        LOAD(double, uint64_t, __builtin_bswap64);
    case EWA_I8:
        LOAD(int8_t, uint8_t, SAME);
    case EWA_U8:
        LOAD(uint8_t, uint8_t, SAME);
    case EWA_I16:
        LOAD(int16_t, uint16_t, __builtin_bswap16);
    case EWA_U16:
        LOAD(uint16_t, uint16_t, __builtin_bswap16);
    case EWA_I32:
        LOAD(int32_t, uint32_t, __builtin_bswap32);
    case EWA_U32:
        LOAD(uint32_t, uint32_t, __builtin_bswap32);
    }
}

#define STORE(type, expression)                                                                              \
    for (size_t i = 0; i < count; i++, to += stride) {                                                       \
        const type value = (type)(expression);                                                               \
        memcpy(to, &value, sizeof value);                                                                    \
    }                                                                                                        \
    break

static void store(uint8_t *to, size_t stride, ewa_type type, const double *values, size_t count) {
    switch (type) {
    case EWA_F32:
        STORE(float, values[i]);
    case EWA_F64:
        STORE(double, values[i]);
    default:
        STORE(uint8_t, values[i] < 0 ? 0 : values[i] > 255 ? 255 : values[i]);
    }
}

void ewa_move_numbers(const ewa_move *move, uint8_t *to, size_t to_stride_bytes, const uint8_t *from,
                      size_t from_stride_bytes, size_t count) {
    const size_t from_bytes = ewa_type_bytes(move->from_type), to_bytes = ewa_type_bytes(move->to_type);
    if (move->from_type == move->to_type) {
        if (move->swap && from_bytes > 1)
            copy_swapped(to, to_stride_bytes, from, from_stride_bytes, from_bytes, move->component_count,
                         count);
        else
            copy(to, to_stride_bytes, from, from_stride_bytes, from_bytes * move->component_count, count);
        return;
    }
    double values[BLOCK_NUMBERS];
    for (size_t done = 0; done < count; done += BLOCK_NUMBERS) {
        const size_t block = count - done < BLOCK_NUMBERS ? count - done : BLOCK_NUMBERS;
        for (uint32_t c = 0; c < move->component_count; c++) {
            load(values, move->from_type, move->swap, from + c * from_bytes, from_stride_bytes, block);
            store(to + c * to_bytes, to_stride_bytes, move->to_type, values, block);
        }
        to += block * to_stride_bytes;
        from += block * from_stride_bytes;
    }
}
