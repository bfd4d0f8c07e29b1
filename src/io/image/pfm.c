// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Portable float maps: a text head, then rows of floats from the bottom up.
// Based on: P. Debevec, PFM Portable FloatMap Image Format, 2001.
#include "io/image/pfm.h"
#include "base/base.h"
#include "io/file.h"

#include <stdio.h>
#include <string.h>

enum { HEAD_BYTES = 64 };

static const bool HOST_IS_LITTLE_ENDIAN = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__;

typedef struct cursor {
    const uint8_t *next, *end;
} cursor;

static bool is_space(uint8_t byte) {
    return byte == ' ' || byte == '\t' || byte == '\n' || byte == '\r' || byte == '\v' || byte == '\f';
}

static void skip_space(cursor *at) {
    while (at->next < at->end && is_space(*at->next)) at->next++;
}

/// Reads a positive decimal number below 2^32.
static bool read_size(cursor *at, uint32_t *size) {
    skip_space(at);
    uint64_t value = 0;
    const uint8_t *first = at->next;
    for (; at->next < at->end && *at->next >= '0' && *at->next <= '9' && value <= UINT32_MAX; at->next++)
        value = 10 * value + (uint64_t)(*at->next - '0');
    *size = (uint32_t)value;
    return at->next > first && value > 0 && value <= UINT32_MAX;
}

/// Reads the scale, of which only the sign matters, and the one white space after it.
static bool read_order(cursor *at, bool *little_endian) {
    skip_space(at);
    const uint8_t *first = at->next;
    bool has_digit = false;
    for (; at->next < at->end && !is_space(*at->next); at->next++) {
        if (!*at->next || !strchr("+-.0123456789eE", *at->next)) return false;
        has_digit |= *at->next >= '1' && *at->next <= '9';
    }
    if (!has_digit || at->next == at->end) return false;
    at->next++;
    *little_endian = *first == '-';
    return true;
}

static ewa_status put_head(const ewa_image *image, uint32_t channel_count, ewa_writer *writer) {
    char head[HEAD_BYTES];
    const int length = snprintf(head, sizeof head, "%s\n%u %u\n%s\n", channel_count == 1 ? "Pf" : "PF",
                                image->width_px, image->height_px, HOST_IS_LITTLE_ENDIAN ? "-1.0" : "1.0");
    return ewa_writer_put(writer, head, (size_t)length);
}

bool ewa_pfm_recognise(const uint8_t *bytes, size_t size_bytes) {
    return size_bytes >= 3 && bytes[0] == 'P' && (bytes[1] == 'f' || bytes[1] == 'F') && is_space(bytes[2]);
}

ewa_status ewa_pfm_decode(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                          ewa_image *image) {
    *image = (ewa_image){0};
    cursor at = {bytes + 2, bytes + size_bytes};
    const uint32_t channel_count = bytes[1] == 'f' ? 1 : 3;
    uint32_t width_px, height_px;
    bool little_endian;
    if (!read_size(&at, &width_px) || !read_size(&at, &height_px) || !read_order(&at, &little_endian))
        return ewa_fail(context, EWA_ERROR_FORMAT,
                        "%s: PFM: byte %zu of the head: width, height and scale wanted", name,
                        (size_t)(at.next - bytes));
    const uint32_t limit = ewa_context_limits(context)->max_image_side;
    if (width_px > limit || height_px > limit)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%s: %u x %u pixels are over the limit of %u a side", name,
                        width_px, height_px, limit);
    const uint64_t row_numbers = (uint64_t)width_px * channel_count;
    const uint64_t wanted_bytes = row_numbers * height_px * sizeof(float),
                   held_bytes = (uint64_t)(at.end - at.next);
    if (wanted_bytes > held_bytes)
        return ewa_fail(context, EWA_ERROR_FORMAT,
                        "%s: PFM: %u x %u pixels of %u channels need %llu bytes, %llu follow", name, width_px,
                        height_px, channel_count, (unsigned long long)wanted_bytes,
                        (unsigned long long)held_bytes);
    EWA_TRY(ewa_image_create(context, width_px, height_px, channel_count, image));
    for (uint32_t y = height_px; y-- > 0; at.next += row_numbers * sizeof(float)) {
        float *row = image->pixels + y * row_numbers;
        memcpy(row, at.next, row_numbers * sizeof(float));
        if (little_endian == HOST_IS_LITTLE_ENDIAN) continue;
        for (uint64_t i = 0; i < row_numbers; i++) {
            uint32_t bits;
            memcpy(&bits, &row[i], sizeof bits);
            bits = __builtin_bswap32(bits);
            memcpy(&row[i], &bits, sizeof bits);
        }
    }
    return EWA_OK;
}

ewa_status ewa_pfm_save(const ewa_image *image, const char *path) {
    ewa_context *context = image->context;
    const uint32_t channel_count = image->channel_count == 1 ? 1 : 3;
    if (image->channel_count != 1 && image->channel_count != 3 && image->channel_count != 4)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: PFM of %u channels (1, 3 or 4 can be written)",
                        path, image->channel_count);
    const size_t row_numbers = (size_t)image->width_px * channel_count;
    float *row = ewa_allocate(context, row_numbers, sizeof *row);
    if (!row) return EWA_ERROR_MEMORY;
    ewa_writer *writer = NULL;
    ewa_status status = ewa_writer_open(context, path, &writer);
    if (status == EWA_OK) status = put_head(image, channel_count, writer);
    for (uint32_t y = image->height_px; status == EWA_OK && y-- > 0;) {
        const float *from = image->pixels + (size_t)y * image->width_px * image->channel_count;
        for (size_t x = 0; x < image->width_px; x++)
            memcpy(&row[x * channel_count], &from[x * image->channel_count], channel_count * sizeof *row);
        status = ewa_writer_put(writer, row, row_numbers * sizeof *row);
    }
    ewa_release(context, row, row_numbers, sizeof *row);
    if (status == EWA_OK) return ewa_writer_commit(&writer);
    ewa_writer_abort(&writer);
    return status;
}
