// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Small TIFF files with heights, written byte by byte: head, directory, arrays, then the cells.
#ifndef EWA_TESTS_TIFF_SAMPLE_H
#define EWA_TESTS_TIFF_SAMPLE_H

#include "check.h"

#include <math.h>
#include <string.h>

enum { TIFF_ROOM = 1 << 16, TIFF_COLUMNS = 7, TIFF_ROWS = 5, TIFF_TILE = 16 };
enum { SAMPLE_UINT = 1, SAMPLE_INT = 2, SAMPLE_FLOAT = 3 };

/// What a file is like; zeros: one band of 32-bit floats in strips of two rows, without a place.
typedef struct tiff_kind {
    bool big_endian, tiled, separate, matrix, points_only, is_point, no_strips;
    int bits, kind, bands, photometric, compression;
    int model;          ///< 0: no keys
    const char *no_data;
    double scale, x, y; ///< scale 0: no place
    double hole;        ///< the number in the cell of row 1, column 2
} tiff_kind;

typedef struct tiff_file {
    tiff_kind kind;
    size_t size, arrays_at, entry_at;
    int entries;
    uint8_t bytes[TIFF_ROOM];
} tiff_file;

static inline double tiff_height(int column, int row) { return 100 + 10 * row + column; }

static inline void tiff_put_at(tiff_file *f, size_t at, const void *number, size_t size) {
    const uint8_t *from = number;
    for (size_t i = 0; i < size; i++) f->bytes[at + i] = from[f->kind.big_endian ? size - 1 - i : i];
}

static inline void tiff_entry(tiff_file *f, uint16_t tag, uint16_t type, uint32_t count, const void *values) {
    static const size_t sizes[] = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8};
    const size_t size = sizes[type], all = size * count;
    uint8_t *start = f->bytes + f->entry_at;
    size_t at = f->entry_at + 8;
    tiff_put_at(f, f->entry_at, &tag, 2);
    tiff_put_at(f, f->entry_at + 2, &type, 2);
    tiff_put_at(f, f->entry_at + 4, &count, 4);
    memset(start + 8, 0, 4);
    if (all > 4) {
        const uint32_t place = (uint32_t)f->arrays_at;
        tiff_put_at(f, f->entry_at + 8, &place, 4);
        at = f->arrays_at;
        f->arrays_at += (all + 7) / 8 * 8;
    }
    for (uint32_t i = 0; i < count; i++) tiff_put_at(f, at + i * size, (const uint8_t *)values + i * size, size);
    f->entry_at += 12;
    f->entries++;
}

static inline void tiff_short(tiff_file *f, uint16_t tag, int value) {
    const uint16_t number = (uint16_t)value;
    tiff_entry(f, tag, 3, 1, &number);
}

static inline void tiff_cell(tiff_file *f, size_t at, double value) {
    const int bits = f->kind.bits, kind = f->kind.kind;
    const float f32 = (float)value;
    const int64_t whole = (int64_t)value;
    if (kind == SAMPLE_FLOAT && bits == 32)
        tiff_put_at(f, at, &f32, 4);
    else if (kind == SAMPLE_FLOAT)
        tiff_put_at(f, at, &value, 8);
    else
        tiff_put_at(f, at, &whole, (size_t)bits / 8);
}

/// Makes a file of TIFF_COLUMNS x TIFF_ROWS cells, further bands with other numbers.
static inline void tiff_make(tiff_file *f, tiff_kind kind) {
    enum { STRIP_ROWS = 2, STRIPS = 3, ROOM_ENTRIES = 20 };
    if (!kind.bits) kind.bits = 32;
    if (!kind.kind) kind.kind = SAMPLE_FLOAT;
    if (!kind.bands) kind.bands = 1;
    if (!kind.compression) kind.compression = 1;
    memset(f, 0, sizeof *f);
    f->kind = kind;
    memcpy(f->bytes, kind.big_endian ? "MM" : "II", 2);
    const uint16_t mark = 42;
    const uint32_t directory = 8;
    tiff_put_at(f, 2, &mark, 2);
    tiff_put_at(f, 4, &directory, 4);
    f->entry_at = directory + 2;
    f->arrays_at = directory + 2 + 12 * ROOM_ENTRIES + 6;
    const int planes = kind.separate ? kind.bands : 1, in_cell = kind.separate ? 1 : kind.bands;
    const int blocks = planes * (kind.tiled ? 1 : STRIPS), columns = kind.tiled ? TIFF_TILE : TIFF_COLUMNS;
    uint32_t at[16], size[16];
    // The arrays take no more than this.
    size_t data = 1024;
    for (int b = 0; b < blocks; b++) {
        const int strip = b % (kind.tiled ? 1 : STRIPS), first = strip * STRIP_ROWS;
        const int rows = kind.tiled ? TIFF_TILE : first + STRIP_ROWS > TIFF_ROWS ? TIFF_ROWS - first : STRIP_ROWS;
        at[b] = (uint32_t)data;
        size[b] = kind.no_strips && strip == 0 ? 0 : (uint32_t)(rows * columns * in_cell * kind.bits / 8);
        for (int r = 0; r < rows && size[b]; r++)
            for (int c = 0; c < columns; c++)
                for (int band = 0; band < in_cell; band++) {
                    const bool other = band || b >= blocks / planes, hole = first + r == 1 && c == 2 && kind.hole;
                    const double value = other ? 7 : hole ? kind.hole : tiff_height(c, first + r);
                    tiff_cell(f, data + (size_t)((r * columns + c) * in_cell + band) * (size_t)kind.bits / 8, value);
                }
        data += size[b];
    }
    f->size = data;
    uint16_t each[16];
    tiff_short(f, 256, TIFF_COLUMNS);
    tiff_short(f, 257, TIFF_ROWS);
    for (int i = 0; i < 16; i++) each[i] = (uint16_t)kind.bits;
    tiff_entry(f, 258, 3, (uint32_t)kind.bands, each);
    tiff_short(f, 259, kind.compression);
    tiff_short(f, 262, kind.photometric ? kind.photometric : 1);
    if (!kind.tiled) tiff_entry(f, 273, 4, (uint32_t)blocks, at);
    tiff_short(f, 277, kind.bands);
    if (!kind.tiled) {
        tiff_short(f, 278, STRIP_ROWS);
        tiff_entry(f, 279, 4, (uint32_t)blocks, size);
    }
    tiff_short(f, 284, kind.separate ? 2 : 1);
    if (kind.tiled) {
        tiff_short(f, 322, TIFF_TILE);
        tiff_short(f, 323, TIFF_TILE);
        tiff_entry(f, 324, 4, (uint32_t)blocks, at);
        tiff_entry(f, 325, 4, (uint32_t)blocks, size);
    }
    for (int i = 0; i < 16; i++) each[i] = (uint16_t)kind.kind;
    tiff_entry(f, 339, 3, (uint32_t)kind.bands, each);
    const double scale[3] = {kind.scale, kind.scale, 0}, tie[6] = {0, 0, 0, kind.x, kind.y, 0};
    // Columns lead to the north, rows to the east.
    const double matrix[16] = {0, kind.scale, 0, kind.x, kind.scale, 0, 0, kind.y, 0, 0, 0, 0, 0, 0, 0, 1};
    if (kind.scale && !kind.matrix && !kind.points_only) tiff_entry(f, 33550, 12, 3, scale);
    if (kind.scale && !kind.matrix) tiff_entry(f, 33922, 12, 6, tie);
    if (kind.scale && kind.matrix) tiff_entry(f, 34264, 12, 16, matrix);
    const uint16_t keys[] = {1,    1, 0, 3, 1024, 0, 1, (uint16_t)kind.model, 1025, 0,
                             1,    (uint16_t)(kind.is_point ? 2 : 1), (uint16_t)(kind.model == 2 ? 2048 : 3072), 0, 1,
                             (uint16_t)(kind.model == 2 ? 4326 : 32632)};
    if (kind.model || kind.is_point) tiff_entry(f, 34735, 3, sizeof keys / sizeof keys[0], keys);
    if (kind.no_data) tiff_entry(f, 42113, 2, (uint32_t)strlen(kind.no_data) + 1, kind.no_data);
    const uint16_t count = (uint16_t)f->entries;
    assert_true(count <= ROOM_ENTRIES && f->arrays_at <= 1024);
    tiff_put_at(f, directory, &count, 2);
}

#endif
