// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// PNG out. Rows are filtered side by side and packed in one go (io/deflate.h): a
// second copy of the picture is the price for about half of zlib's time. Based on: W3C, Portable Network
// Graphics (PNG) Specification (Second Edition), 2003, sections 5, 7, 9, 11.
#include "base/base.h"
#include "ewa/io.h"
#include "io/deflate.h"
#include "io/file.h"

#include <stdlib.h>
#include <string.h>

enum {
    COMPRESSION_LEVEL = 1, // of 12; 2 takes 1.3 times as long, 6 up to 3.5 times, for 5 and 10 per cent
    BAND_BYTES = 1 << 17,  // filtered bytes of one task
    IDAT_BYTES = 1 << 20,  // data of one chunk; PNG allows less than 2 GiB
};

typedef enum filter { FILTER_UP = 2, FILTER_AVERAGE = 3 } filter;

typedef struct encoder {
    ewa_context *context;
    const char *path;
    const uint8_t *pixels;
    size_t stride_bytes, row_bytes, pixel_bytes;
    uint32_t height_px, rows_per_band, worker_count;
    uint8_t *filtered;       // the lines to compress: the number of a filter, then row_bytes
    uint8_t *trials;         // a row for each worker
    const uint8_t *zero_row; // above the first
} encoder;

static void put_u32(uint8_t *out, uint32_t value) {
    for (int byte = 0; byte < 4; byte++) out[byte] = (uint8_t)(value >> (24 - 8 * byte));
}

static ewa_status put_chunk(ewa_writer *writer, const char *type, const uint8_t *data, size_t data_bytes) {
    uint8_t head[8], tail[4];
    put_u32(head, (uint32_t)data_bytes);
    memcpy(head + 4, type, 4);
    put_u32(tail, ewa_crc32(ewa_crc32(0, head + 4, 4), data, data_bytes));
    ewa_writer_put(writer, head, sizeof head);
    ewa_writer_put(writer, data, data_bytes);
    return ewa_writer_put(writer, tail, sizeof tail);
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

static void filter_band(void *data, uint32_t index, uint32_t worker) {
    const encoder *job = data;
    const uint32_t first = index * job->rows_per_band, left = job->height_px - first;
    const uint32_t end = first + (left < job->rows_per_band ? left : job->rows_per_band);
    uint8_t *trial = job->trials + worker * job->row_bytes;
    for (uint32_t y = first; y < end; y++)
        filter_row(job, y, job->filtered + y * (job->row_bytes + 1), trial);
}

static ewa_status filter_rows(encoder *job) {
    uint8_t *zero_row = ewa_allocate_zeroed(job->context, job->row_bytes, 1);
    job->trials = ewa_allocate(job->context, job->worker_count, job->row_bytes);
    job->zero_row = zero_row;
    const bool complete = zero_row && job->trials;
    if (complete) ewa_parallel(job->context, filter_band, job, (job->height_px - 1) / job->rows_per_band + 1);
    ewa_release(job->context, job->trials, job->worker_count, job->row_bytes);
    ewa_release(job->context, zero_row, job->row_bytes, 1);
    return complete ? EWA_OK : EWA_ERROR_MEMORY;
}

/// Signature, IHDR and sRGB.
static ewa_status put_head(ewa_writer *writer, uint32_t width_px, uint32_t height_px,
                           uint32_t channel_count) {
    static const uint8_t signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    ewa_writer_put(writer, signature, sizeof signature);
    uint8_t header[13] = {0};
    put_u32(header, width_px);
    put_u32(header + 4, height_px);
    header[8] = 8; // bits
    header[9] = channel_count == 1 ? 0 : channel_count == 3 ? 2 : 6;
    put_chunk(writer, "IHDR", header, sizeof header);
    const uint8_t perceptual = 0; // the rendering intent
    return put_chunk(writer, "sRGB", &perceptual, 1);
}

/// Compresses the filtered lines and puts them into IDAT chunks.
static ewa_status put_lines(const encoder *job, ewa_writer *writer) {
    ewa_deflated packed;
    ewa_status status = ewa_deflate(job->context, EWA_DEFLATE_ZLIB, COMPRESSION_LEVEL, job->filtered,
                                    job->height_px * (job->row_bytes + 1), &packed);
    for (size_t at = 0; at < packed.size_bytes && status == EWA_OK; at += IDAT_BYTES) {
        const size_t left = packed.size_bytes - at;
        status = put_chunk(writer, "IDAT", packed.bytes + at, left < IDAT_BYTES ? left : IDAT_BYTES);
    }
    ewa_deflated_free(job->context, &packed);
    return status;
}

static ewa_status put_picture(encoder *job, ewa_writer *writer) {
    job->filtered = ewa_allocate(job->context, job->height_px, job->row_bytes + 1);
    if (!job->filtered) return EWA_ERROR_MEMORY;
    ewa_status status = filter_rows(job);
    if (status == EWA_OK) status = put_lines(job, writer);
    ewa_release(job->context, job->filtered, job->height_px, job->row_bytes + 1);
    return status;
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
    const size_t rows = BAND_BYTES / (row_bytes + 1);
    encoder job = {.context = context,
                   .path = path,
                   .pixels = pixels,
                   .stride_bytes = stride_bytes,
                   .row_bytes = row_bytes,
                   .pixel_bytes = channel_count,
                   .height_px = height_px,
                   .rows_per_band = rows < 1 ? 1 : (uint32_t)rows,
                   .worker_count = ewa_context_worker_count(context)};
    ewa_writer *writer = NULL;
    ewa_status status = ewa_writer_open(context, path, &writer);
    if (status == EWA_OK) status = put_head(writer, width_px, height_px, channel_count);
    if (status == EWA_OK) status = put_picture(&job, writer);
    if (status == EWA_OK) status = put_chunk(writer, "IEND", NULL, 0);
    if (status == EWA_OK) return ewa_writer_commit(&writer);
    ewa_writer_abort(&writer);
    return status;
}
