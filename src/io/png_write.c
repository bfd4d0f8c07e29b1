// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// PNG out. Bands of rows are filtered and compressed side by side, each to an IDAT chunk of its own; the size
// of the bands depends on the picture only, so that the file is the same for any number of threads. Based on:
// W3C, Portable Network Graphics (PNG) Specification (Second Edition), 2003, sections 5, 7, 9, 11.
#include "base/base.h"
#include "ewa/io.h"
#include "io/deflate.h"
#include "io/file.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum {
    BAND_BYTES = 1 << 17, // filtered bytes of a band: in cache, and enough for its own Huffman codes
    BANDS_PER_WORKER = 4, // compressed before they are written, so that memory does not grow with the picture
    CHUNK_HEAD_BYTES = 8,
    CHUNK_BYTES = 12, // length, type and checksum around the data
    ZLIB_HEAD_BYTES = 2,
};

typedef enum filter { FILTER_UP = 2, FILTER_AVERAGE = 3 } filter;

/// One compressed band: a whole IDAT chunk.
typedef struct band {
    uint8_t *chunk;
    size_t chunk_bytes, filtered_bytes;
    uint32_t checksum; // Adler-32 of the filtered bytes
} band;

/// What a worker needs for a band.
typedef struct scratch {
    uint8_t *filtered;
    uint16_t *tokens;
} scratch;

typedef struct encoder {
    ewa_context *context;
    const uint8_t *pixels;
    size_t stride_bytes, row_bytes, pixel_bytes;
    uint32_t height_px, rows_per_band, first_band;
    scratch *scratches; // one per worker
    band *bands;        // those in flight
    uint32_t slot_count, worker_count;
    size_t band_capacity_bytes, chunk_capacity_bytes;
    const uint8_t *zero_row; // above the first
} encoder;

static void put_u32(uint8_t *out, uint32_t value) {
    for (int byte = 0; byte < 4; byte++) out[byte] = (uint8_t)(value >> (24 - 8 * byte));
}

/// Completes a chunk whose data is already at chunk + CHUNK_HEAD_BYTES; returns its whole size.
static size_t close_chunk(uint8_t *chunk, const char *type, size_t data_bytes) {
    put_u32(chunk, (uint32_t)data_bytes);
    memcpy(chunk + 4, type, 4);
    put_u32(chunk + CHUNK_HEAD_BYTES + data_bytes, (uint32_t)crc32(0, chunk + 4, (uInt)(4 + data_bytes)));
    return data_bytes + CHUNK_BYTES;
}

static void filter_up(const uint8_t *row, const uint8_t *above, size_t row_bytes, uint8_t *out) {
    for (size_t i = 0; i < row_bytes; i++) out[i] = (uint8_t)(row[i] - above[i]);
}

static void filter_average(const uint8_t *row, const uint8_t *above, size_t row_bytes, size_t pixel_bytes,
                           uint8_t *out) {
    for (size_t i = 0; i < pixel_bytes; i++) out[i] = (uint8_t)(row[i] - above[i] / 2);
    for (size_t i = pixel_bytes; i < row_bytes; i++)
        out[i] = (uint8_t)(row[i] - (row[i - pixel_bytes] + above[i]) / 2);
}

/// Sum of the absolute differences from zero, modulo 256: small where Huffman codes will be short.
static uint64_t filtered_cost(const uint8_t *filtered, size_t size_bytes) {
    uint64_t cost = 0;
    while (size_bytes) {
        const size_t block = size_bytes < 1 << 20 ? size_bytes : 1 << 20; // its sum fits 32 bits: a fast loop
        uint32_t sum = 0;
        for (size_t i = 0; i < block; i++) sum += (uint32_t)abs((int)(uint8_t)(filtered[i] ^ 128) - 128);
        cost += sum;
        filtered += block;
        size_bytes -= block;
    }
    return cost;
}

/// Filters a row by what gives the smaller cost: "up" where rows repeat, "average" on shaded surfaces.
static void filter_row(const encoder *job, uint32_t y, uint8_t *out, uint8_t *trial) {
    const uint8_t *row = job->pixels + y * job->stride_bytes;
    const uint8_t *above = y ? row - job->stride_bytes : job->zero_row;
    filter_up(row, above, job->row_bytes, out + 1);
    filter_average(row, above, job->row_bytes, job->pixel_bytes, trial);
    out[0] = FILTER_UP;
    if (filtered_cost(trial, job->row_bytes) >= filtered_cost(out + 1, job->row_bytes)) return;
    out[0] = FILTER_AVERAGE;
    memcpy(out + 1, trial, job->row_bytes);
}

static void encode_band(void *data, uint32_t index, uint32_t worker) {
    encoder *job = data;
    band *made = &job->bands[index];
    const scratch *mine = &job->scratches[worker];
    const uint32_t first = (job->first_band + index) * job->rows_per_band;
    const uint32_t rows =
        job->height_px - first < job->rows_per_band ? job->height_px - first : job->rows_per_band;
    const size_t line_bytes = job->row_bytes + 1;
    made->filtered_bytes = rows * line_bytes;
    uint8_t *trial = mine->filtered + job->band_capacity_bytes;
    for (uint32_t r = 0; r < rows; r++) filter_row(job, first + r, mine->filtered + r * line_bytes, trial);
    uint8_t *out = made->chunk + CHUNK_HEAD_BYTES;
    size_t data_bytes = 0;
    if (first == 0) { // the zlib stream's head: deflate, a window of 32 KiB, fastest
        out[0] = 0x78;
        out[1] = 0x01;
        data_bytes = ZLIB_HEAD_BYTES;
    }
    data_bytes += ewa_deflate_block(mine->filtered, made->filtered_bytes, mine->tokens, out + data_bytes);
    made->checksum = (uint32_t)adler32(1, mine->filtered, (uInt)made->filtered_bytes);
    made->chunk_bytes = close_chunk(made->chunk, "IDAT", data_bytes);
}

static void release_scratch(encoder *job) {
    for (uint32_t i = 0; job->scratches && i < job->worker_count; i++) {
        ewa_release(job->context, job->scratches[i].filtered, job->band_capacity_bytes + job->row_bytes, 1);
        ewa_release(job->context, job->scratches[i].tokens, job->band_capacity_bytes, sizeof(uint16_t));
    }
    for (uint32_t i = 0; job->bands && i < job->slot_count; i++)
        ewa_release(job->context, job->bands[i].chunk, job->chunk_capacity_bytes, 1);
    ewa_release(job->context, job->scratches, job->worker_count, sizeof *job->scratches);
    ewa_release(job->context, job->bands, job->slot_count, sizeof *job->bands);
    ewa_release(job->context, (void *)(uintptr_t)job->zero_row, job->row_bytes, 1);
}

static ewa_status reserve_scratch(encoder *job) {
    job->scratches = ewa_allocate_zeroed(job->context, job->worker_count, sizeof *job->scratches);
    job->bands = ewa_allocate_zeroed(job->context, job->slot_count, sizeof *job->bands);
    job->zero_row = ewa_allocate_zeroed(job->context, job->row_bytes, 1);
    if (!job->scratches || !job->bands || !job->zero_row) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < job->worker_count; i++) {
        scratch *mine = &job->scratches[i];
        mine->filtered = ewa_allocate(job->context, job->band_capacity_bytes + job->row_bytes, 1);
        mine->tokens = ewa_allocate(job->context, job->band_capacity_bytes, sizeof(uint16_t));
        if (!mine->filtered || !mine->tokens) return EWA_ERROR_MEMORY;
    }
    for (uint32_t i = 0; i < job->slot_count; i++) {
        job->bands[i].chunk = ewa_allocate(job->context, job->chunk_capacity_bytes, 1);
        if (!job->bands[i].chunk) return EWA_ERROR_MEMORY;
    }
    return EWA_OK;
}

/// Signature, IHDR and sRGB.
static ewa_status put_head(ewa_writer *writer, uint32_t width_px, uint32_t height_px,
                           uint32_t channel_count) {
    static const uint8_t signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    ewa_writer_put(writer, signature, sizeof signature);
    uint8_t header[CHUNK_BYTES + 13] = {0}, *fields = header + CHUNK_HEAD_BYTES;
    put_u32(fields, width_px);
    put_u32(fields + 4, height_px);
    fields[8] = 8; // bits
    fields[9] = channel_count == 1 ? 0 : channel_count == 3 ? 2 : 6;
    ewa_writer_put(writer, header, close_chunk(header, "IHDR", 13));
    uint8_t srgb[CHUNK_BYTES + 1] = {0}; // rendering intent 0: perceptual
    return ewa_writer_put(writer, srgb, close_chunk(srgb, "sRGB", 1));
}

static ewa_status put_tail(ewa_writer *writer, uint32_t checksum) {
    uint8_t last[CHUNK_BYTES + 6], end[CHUNK_BYTES];
    const size_t deflate_bytes = ewa_deflate_end(last + CHUNK_HEAD_BYTES);
    put_u32(last + CHUNK_HEAD_BYTES + deflate_bytes, checksum);
    ewa_writer_put(writer, last, close_chunk(last, "IDAT", deflate_bytes + 4));
    return ewa_writer_put(writer, end, close_chunk(end, "IEND", 0));
}

static ewa_status put_bands(encoder *job, ewa_writer *writer) {
    const uint32_t band_count = (job->height_px - 1) / job->rows_per_band + 1;
    uLong checksum = 1;
    while (job->first_band < band_count) {
        const uint32_t left = band_count - job->first_band;
        const uint32_t count = left < job->slot_count ? left : job->slot_count;
        ewa_parallel(job->context, encode_band, job, count);
        for (uint32_t i = 0; i < count; i++) {
            const band *made = &job->bands[i];
            checksum = adler32_combine(checksum, made->checksum, (z_off_t)made->filtered_bytes);
            const ewa_status status = ewa_writer_put(writer, made->chunk, made->chunk_bytes);
            if (status != EWA_OK) return status;
        }
        job->first_band += count;
    }
    return put_tail(writer, (uint32_t)checksum);
}

ewa_status ewa_png_save(ewa_context *context, const char *path, uint32_t width_px, uint32_t height_px,
                        uint32_t channel_count, const uint8_t *pixels, size_t stride_bytes) {
    if (!context || !path || !pixels) return EWA_ERROR_ARGUMENT;
    if (channel_count != 1 && channel_count != 3 && channel_count != 4)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: PNG of %u channels (1, 3 or 4 can be written)",
                        path, channel_count);
    const uint32_t limit = ewa_context_limits(context)->max_image_side;
    if (width_px == 0 || height_px == 0 || width_px > limit || height_px > limit)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: PNG of %u x %u pixels (1 to %u a side)", path,
                        width_px, height_px, limit);
    const size_t row_bytes = (size_t)width_px * channel_count;
    if (stride_bytes < row_bytes)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: rows of %zu bytes at a stride of %zu", path,
                        row_bytes, stride_bytes);
    const size_t rows = BAND_BYTES / (row_bytes + 1), rows_per_band = rows < 1 ? 1 : rows;
    const uint32_t workers = ewa_context_worker_count(context);
    const uint32_t band_count = (uint32_t)((height_px - 1) / rows_per_band + 1);
    const uint32_t slots = BANDS_PER_WORKER * workers;
    encoder job = {.context = context,
                   .pixels = pixels,
                   .stride_bytes = stride_bytes,
                   .row_bytes = row_bytes,
                   .pixel_bytes = channel_count,
                   .height_px = height_px,
                   .rows_per_band = (uint32_t)rows_per_band,
                   .slot_count = band_count < slots ? band_count : slots,
                   .worker_count = workers,
                   .band_capacity_bytes = rows_per_band * (row_bytes + 1)};
    job.chunk_capacity_bytes = CHUNK_BYTES + ZLIB_HEAD_BYTES + ewa_deflate_bound(job.band_capacity_bytes);
    ewa_writer *writer = NULL;
    ewa_status status = ewa_writer_open(context, path, &writer);
    if (status == EWA_OK) status = reserve_scratch(&job);
    if (status == EWA_OK) status = put_head(writer, width_px, height_px, channel_count);
    if (status == EWA_OK) status = put_bands(&job, writer);
    release_scratch(&job);
    if (status == EWA_OK) return ewa_writer_commit(&writer);
    ewa_writer_abort(&writer);
    return status;
}
