// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Grids of heights in TIFF files: numbers of one band, read by libtiff a row of strips or tiles at a time. Where they lie
// is in the tags (geotiff.h).
//
// Based on: Aldus, "TIFF 6.0" (1992); OGC 19-008r4, "OGC GeoTIFF Standard 1.1".
#include "io/cloud/geotiff.h"

#include "base/base.h"
#include "base/format.h"
#include "base/unpacking.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <tiffio.h>

enum {
    MAX_CELLS_PER_BYTE = 65536, ///< that a codec makes of a byte: more than any does of what is no constant
    OWN_BYTES = 1 << 22,        ///< that libtiff takes by itself: its directory, tables of its codecs
    PICTURE_BANDS = 3,
};

/// Bytes that libtiff reads like a file; what it said last.
typedef struct tiff_bytes {
    const uint8_t *bytes;
    uint64_t size_bytes, at;
    char fault[256];
} tiff_bytes;

typedef struct tiff_state {
    const ewa_cloud_source *source;
    tiff_bytes file;
    TIFF *tiff;
    ewa_height_grid grid;
    uint16_t bands, bits, kind; ///< kind: SAMPLEFORMAT_...
    bool tiled, separate;
    uint32_t block_columns, block_rows, across; ///< of a strip or tile; how many lie side by side
    uint64_t block_bytes, band_bytes;           ///< of one; of all that lie side by side
    uint8_t *band;                              ///< a row of blocks
    uint64_t band_index;                        ///< which; UINT64_MAX: none yet
    bool looking;                               ///< damage is left to who reads
    bool *good;                                 ///< blocks of the band that could be read
    uint64_t cell;                              ///< the next one
} tiff_state;

static tmsize_t read_bytes(thandle_t handle, void *to, tmsize_t size) {
    tiff_bytes *file = handle;
    const uint64_t left = file->at < file->size_bytes ? file->size_bytes - file->at : 0;
    const uint64_t count = (uint64_t)size < left ? (uint64_t)size : left;
    if (count) memcpy(to, file->bytes + file->at, count);
    file->at += count;
    return (tmsize_t)count;
}

static tmsize_t write_bytes(thandle_t handle, void *from, tmsize_t size) {
    (void)handle, (void)from, (void)size;
    return 0;
}

static toff_t seek_bytes(thandle_t handle, toff_t to, int from) {
    tiff_bytes *file = handle;
    file->at = to + (from == SEEK_CUR ? file->at : from == SEEK_END ? file->size_bytes : 0);
    return file->at;
}

static int close_bytes(thandle_t handle) {
    (void)handle;
    return 0;
}

static toff_t count_bytes(thandle_t handle) { return ((tiff_bytes *)handle)->size_bytes; }

/// Lets libtiff look at the bytes where they are.
static int map_bytes(thandle_t handle, void **bytes, toff_t *size) {
    tiff_bytes *file = handle;
    *bytes = (void *)(uintptr_t)file->bytes;
    *size = file->size_bytes;
    return 1;
}

static void unmap_bytes(thandle_t handle, void *bytes, toff_t size) { (void)handle, (void)bytes, (void)size; }

static int keep_fault(TIFF *tiff, void *user, const char *module, const char *format, va_list arguments) {
    (void)tiff, (void)module;
    tiff_bytes *file = user;
    ewa_format_list(file->fault, sizeof file->fault, format, arguments);
    return 1;
}

static int keep_quiet(TIFF *tiff, void *user, const char *module, const char *format, va_list arguments) {
    (void)tiff, (void)user, (void)module, (void)format, (void)arguments;
    return 1;
}

static bool probe(const char *name, const uint8_t *bytes, uint64_t size_bytes) {
    (void)name;
    return ewa_tiff_recognise(bytes, size_bytes);
}

static ewa_status open_tiff(tiff_state *state) {
    ewa_context *context = state->source->context;
    const uint64_t left_bytes = ewa_memory_left(context);
    TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
    if (!options) return ewa_fail(context, EWA_ERROR_MEMORY, "%s: out of memory", state->source->name);
    // 0 would be no limit.
    TIFFOpenOptionsSetMaxSingleMemAlloc(options, left_bytes < PTRDIFF_MAX ? (tmsize_t)(left_bytes | 1) : PTRDIFF_MAX);
    TIFFOpenOptionsSetErrorHandlerExtR(options, keep_fault, &state->file);
    TIFFOpenOptionsSetWarningHandlerExtR(options, keep_quiet, NULL);
    // The name is for messages; the first directory is read.
    state->tiff = TIFFClientOpenExt("TIFF", "r", &state->file, read_bytes, write_bytes, seek_bytes, close_bytes,
                                    count_bytes, map_bytes, unmap_bytes, options);
    TIFFOpenOptionsFree(options);
    if (state->tiff) return EWA_OK;
    return ewa_fail(context, EWA_ERROR_FORMAT, "%s: TIFF: %s", state->source->name,
                    state->file.fault[0] ? state->file.fault : "the head is broken");
}

/// Whether the numbers are colours.
static bool is_picture(TIFF *tiff, const tiff_state *state, bool placed) {
    uint16_t photometric = PHOTOMETRIC_MINISBLACK;
    TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
    return photometric > PHOTOMETRIC_MINISBLACK || (state->bits == 8 && (!placed || state->bands >= PICTURE_BANDS));
}

/// Reads what the numbers are.
static ewa_status read_kind(tiff_state *state, bool placed) {
    const ewa_cloud_source *source = state->source;
    TIFF *tiff = state->tiff;
    uint16_t compression = COMPRESSION_NONE, planar = PLANARCONFIG_CONTIG;
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &state->bands);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &state->bits);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &state->kind);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &compression);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &planar);
    state->separate = planar == PLANARCONFIG_SEPARATE && state->bands > 1;
    if (is_picture(tiff, state, placed))
        return ewa_fail(source->context, EWA_ERROR_UNSUPPORTED,
                        "%s: a TIFF picture, no grid of heights; as a picture, make a PNG of it", source->name);
    const bool real = state->kind == SAMPLEFORMAT_IEEEFP, whole = state->kind == SAMPLEFORMAT_UINT ||
                                                                  state->kind == SAMPLEFORMAT_INT;
    const bool bytes = state->bits == 8 || state->bits == 16 || state->bits == 32 || state->bits == 64;
    if (state->bands == 0 || !bytes || !(real || whole) || (real && state->bits < 32))
        return ewa_fail(source->context, EWA_ERROR_UNSUPPORTED,
                        "%s: TIFF with numbers of %u bits, format %u; integers of 8 to 64 bits and floats of 32 and 64 "
                        "are read",
                        source->name, state->bits, state->kind);
    if (!TIFFIsCODECConfigured(compression))
        return ewa_fail(source->context, EWA_ERROR_UNSUPPORTED,
                        "%s: TIFF of compression %u, which this libtiff cannot read", source->name, compression);
    if (state->bands > 1)
        ewa_report(source->context, EWA_SEVERITY_WARNING, "%s: %u bands; the first is read as heights", source->name,
                   state->bands);
    return EWA_OK;
}

/// Reads how the cells are stored, and makes room for a row of blocks.
static ewa_status read_blocks(tiff_state *state) {
    const ewa_cloud_source *source = state->source;
    ewa_context *context = source->context;
    TIFF *tiff = state->tiff;
    uint32_t columns = 0, rows = 0, rows_per_strip = 0;
    TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &columns);
    TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &rows);
    if (columns == 0 || rows == 0)
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: TIFF of %u x %u cells", source->name, columns, rows);
    state->grid.columns = columns;
    state->grid.rows = rows;
    state->tiled = TIFFIsTiled(tiff);
    state->across = 1;
    if (state->tiled) {
        TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &state->block_columns);
        TIFFGetField(tiff, TIFFTAG_TILELENGTH, &state->block_rows);
        if (state->block_columns) state->across = (columns - 1) / state->block_columns + 1;
    } else {
        TIFFGetFieldDefaulted(tiff, TIFFTAG_ROWSPERSTRIP, &rows_per_strip);
        state->block_columns = columns;
        state->block_rows = rows_per_strip < rows ? rows_per_strip : rows;
    }
    const uint64_t cell_bytes = (state->separate ? 1u : state->bands) * (uint64_t)(state->bits / 8);
    uint64_t block_cells, bytes;
    const bool too_large = __builtin_mul_overflow(state->block_columns, (uint64_t)state->block_rows, &block_cells) ||
                           __builtin_mul_overflow(block_cells, cell_bytes, &state->block_bytes) ||
                           __builtin_mul_overflow(state->block_bytes, state->across, &state->band_bytes);
    const tmsize_t own = state->tiled ? TIFFTileSize(tiff) : TIFFStripSize(tiff);
    if (too_large || block_cells == 0 || own < 0 || (uint64_t)own != state->block_bytes)
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: TIFF with blocks of %u x %u cells", source->name,
                        state->block_columns, state->block_rows);
    // The room for a band, and what libtiff takes for one block of it.
    if (__builtin_add_overflow(state->band_bytes, state->block_bytes + OWN_BYTES, &bytes)) bytes = UINT64_MAX;
    EWA_TRY(ewa_memory_check_unpacked(context, source->size_bytes, EWA_UNPACKED_RATIO, bytes,
                                      "%s: TIFF with blocks of %u x %u cells", source->name, state->block_columns,
                                      state->block_rows));
    state->band = ewa_allocate(context, state->band_bytes, 1);
    state->good = ewa_allocate_zeroed(context, state->across, sizeof *state->good);
    return state->band && state->good ? EWA_OK : EWA_ERROR_MEMORY;
}

/// Reads the row of blocks that has row `row`; those that are damaged have no heights.
static ewa_status read_band(tiff_state *state, uint64_t row) {
    const uint64_t index = row / state->block_rows;
    if (index == state->band_index) return EWA_OK;
    const ewa_cloud_source *source = state->source;
    state->band_index = index;
    for (uint32_t i = 0; i < state->across; i++) {
        const uint32_t column = i * state->block_columns, first_row = (uint32_t)(index * state->block_rows);
        const uint32_t block = state->tiled ? TIFFComputeTile(state->tiff, column, first_row, 0, 0)
                                            : TIFFComputeStrip(state->tiff, first_row, 0);
        uint8_t *to = state->band + i * state->block_bytes;
        // A block of no bytes is one of no heights: programs leave those out.
        state->good[i] = TIFFGetStrileByteCount(state->tiff, block) > 0;
        if (!state->good[i]) continue;
        const uint64_t rows_left = state->grid.rows - first_row,
                       rows = rows_left < state->block_rows ? rows_left : state->block_rows;
        const uint64_t wanted = state->tiled ? state->block_bytes : state->block_bytes / state->block_rows * rows;
        state->file.fault[0] = 0;
        const tmsize_t got = state->tiled ? TIFFReadEncodedTile(state->tiff, block, to, (tmsize_t)wanted)
                                          : TIFFReadEncodedStrip(state->tiff, block, to, (tmsize_t)wanted);
        if (got >= 0 && (uint64_t)got == wanted) continue;
        state->good[i] = false;
        if (state->looking) continue;
        const uint64_t columns_left = state->grid.columns - column,
                       columns = columns_left < state->block_columns ? columns_left : state->block_columns;
        EWA_TRY(ewa_cloud_damage(source, rows * columns, "%s: rows %llu to %llu of %llu, columns from %u on: %s",
                                 source->name, (unsigned long long)first_row + 1,
                                 (unsigned long long)(first_row + rows), (unsigned long long)state->grid.rows,
                                 column + 1, state->file.fault[0] ? state->file.fault : "the block ends early"));
    }
    return EWA_OK;
}

/// Whether no block of the band could be read. Grids of any size take no bytes in such blocks, and should take no time.
static bool band_is_empty(const tiff_state *state) {
    for (uint32_t i = 0; i < state->across; i++)
        if (state->good[i]) return false;
    return true;
}

/// The number of a cell in the band; NaN where its block is not there.
static double number_at(const tiff_state *state, uint64_t column, uint64_t row) {
    const uint64_t block = column / state->block_columns;
    if (!state->good[block]) return NAN;
    const uint64_t at = row % state->block_rows * state->block_columns + column % state->block_columns;
    const uint64_t bands = state->separate ? 1 : state->bands;
    const uint8_t *from = state->band + block * state->block_bytes + at * bands * (state->bits / 8);
    union {
        uint8_t u8;
        int8_t i8;
        uint16_t u16;
        int16_t i16;
        uint32_t u32;
        int32_t i32;
        uint64_t u64;
        int64_t i64;
        float f32;
        double f64;
    } n;
    memcpy(&n, from, state->bits / 8);
    const bool is_signed = state->kind == SAMPLEFORMAT_INT;
    if (state->kind == SAMPLEFORMAT_IEEEFP) return state->bits == 32 ? (double)n.f32 : n.f64;
    switch (state->bits) {
    case 8:
        return is_signed ? n.i8 : n.u8;
    case 16:
        return is_signed ? n.i16 : n.u16;
    case 32:
        return is_signed ? (double)n.i32 : (double)n.u32;
    default:
        return is_signed ? (double)n.i64 : (double)n.u64;
    }
}

/// How much neighbouring cells of the first row of blocks that has heights differ on the average.
static ewa_status find_mean_step(tiff_state *state, double *mean_step) {
    double sum = 0, count = 0;
    state->looking = true;
    for (uint64_t first = 0; first < state->grid.rows && count == 0; first += state->block_rows) {
        EWA_TRY(read_band(state, first));
        EWA_TRY(ewa_progress(state->source->context, "read", 0));
        if (band_is_empty(state)) continue;
        for (uint64_t row = first; row < first + state->block_rows && row < state->grid.rows; row++)
            for (uint64_t column = 1; column < state->grid.columns; column++) {
                const double a = number_at(state, column - 1, row), b = number_at(state, column, row);
                if (!ewa_height_is(&state->grid, a) || !ewa_height_is(&state->grid, b)) continue;
                sum += fabs(b - a);
                count++;
            }
    }
    *mean_step = count ? sum / count : 0;
    state->looking = false;
    state->band_index = UINT64_MAX;
    return EWA_OK;
}

static void close_grid(void *data) {
    tiff_state *state = data;
    if (!state) return;
    ewa_context *context = state->source->context;
    if (state->tiff) TIFFClose(state->tiff);
    ewa_release(context, state->band, state->band_bytes, 1);
    ewa_release(context, state->good, state->across, sizeof *state->good);
    ewa_release(context, state, 1, sizeof *state);
}

static ewa_status prepare(tiff_state *state, ewa_cloud *prototype) {
    ewa_geotiff_place place;
    EWA_TRY(open_tiff(state));
    EWA_TRY(ewa_geotiff_read(state->source, state->tiff, &place));
    EWA_TRY(read_kind(state, place.is_placed));
    EWA_TRY(read_blocks(state));
    ewa_height_grid *grid = &state->grid;
    memcpy(grid->to_world, place.to_world, sizeof grid->to_world);
    grid->has_no_data = place.has_no_data;
    // The mark is the file's decimals, a cell what is left of them in its type.
    grid->no_data = state->bits == 32 && state->kind == SAMPLEFORMAT_IEEEFP && fabs(place.no_data) < 3e38
                        ? (double)(float)place.no_data
                        : place.no_data;
    grid->is_degrees = place.model == EWA_GEOTIFF_GEOGRAPHIC;
    if (place.is_placed && place.model == EWA_GEOTIFF_UNKNOWN && ewa_height_grid_fits_degrees(grid)) {
        double mean_step;
        EWA_TRY(find_mean_step(state, &mean_step));
        grid->is_degrees = ewa_height_grid_is_too_steep(grid, mean_step);
    }
    // Smaller copies of a map follow it, too; a map knows its place.
    if (!place.is_placed && !TIFFLastDirectory(state->tiff))
        return ewa_fail(state->source->context, EWA_ERROR_UNSUPPORTED,
                        "%s: a stack of pictures, no heights: a volume, which is read of NRRD, NIfTI, MetaImage and VTK", state->source->name);
    if (!place.is_placed)
        ewa_report(state->source->context, EWA_SEVERITY_WARNING,
                   "%s: the file does not say how large its cells are: 1 is taken", state->source->name);
    EWA_TRY(ewa_height_grid_settle(state->source, grid, prototype));
    return grid->is_degrees ? EWA_OK : ewa_geotiff_note(state->source->context, state->tiff, prototype);
}

static ewa_status open_grid(const ewa_cloud_source *source, ewa_cloud *prototype, uint64_t *point_count, void **data) {
    tiff_state *state = ewa_allocate_zeroed(source->context, 1, sizeof *state);
    if (!state) return EWA_ERROR_MEMORY;
    state->source = source;
    state->file = (tiff_bytes){.bytes = source->bytes, .size_bytes = source->size_bytes};
    state->band_index = UINT64_MAX;
    const ewa_status status = prepare(state, prototype);
    if (status != EWA_OK) {
        close_grid(state);
        return status;
    }
    const uint64_t cells = state->grid.columns * state->grid.rows, maximum = source->size_bytes * MAX_CELLS_PER_BYTE;
    *point_count = cells < maximum ? cells : maximum;
    *data = state;
    return EWA_OK;
}

static ewa_status read_grid(void *data, uint64_t maximum, const ewa_cloud_sink *sinks, uint64_t *got_count) {
    tiff_state *state = data;
    const uint64_t columns = state->grid.columns, cells = columns * state->grid.rows;
    uint64_t got = 0;
    for (; got < maximum && state->cell < cells; state->cell++) {
        const uint64_t column = state->cell % columns, row = state->cell / columns;
        if (column == 0) {
            EWA_TRY(read_band(state, row));
            EWA_TRY(ewa_progress(state->source->context, "read", (double)state->cell / (double)cells));
            if (band_is_empty(state)) {
                const uint64_t next_row = (state->band_index + 1) * state->block_rows;
                state->cell = (next_row < state->grid.rows ? next_row : state->grid.rows) * columns - 1;
                continue;
            }
        }
        const double height = number_at(state, column, row);
        if (!ewa_height_is(&state->grid, height)) continue;
        if (sinks[0].to)
            ewa_height_grid_place(&state->grid, column, row, height, sinks[0].to + got * sinks[0].stride_bytes);
        got++;
    }
    *got_count = got;
    return ewa_progress(state->source->context, "read", (double)state->cell / (double)cells);
}

const ewa_cloud_format ewa_format_tiff = {EWA_MODEL_TIFF, probe, open_grid, read_grid, close_grid};
