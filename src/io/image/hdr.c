// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Radiance pictures: a head of lines, a line with the size, then rows of pixels of three mantissas and one
// exponent, each row plain, with repeated pixels, or with runs of each component.
// Based on: G. Ward, "Real Pixels", Graphics Gems II, 1991; Radiance File Formats, 1997 (the rows).
#include "io/image/hdr.h"
#include "base/base.h"
#include "io/number.h"
#include "io/reader.h"

#include <string.h>

enum {
    PIXEL_BYTES = 4,
    MIN_RUN_WIDTH = 8, ///< rows outside of these widths never have runs of components
    MAX_RUN_WIDTH = 32767,
    MAX_RUN = 128, ///< longer counts are runs of one value
};

typedef struct decoder {
    ewa_context *context;
    const char *name;
    ewa_reader reader;
    uint32_t width_px, height_px;
    bool from_bottom;
    double exposure;
} decoder;

static ewa_status fail(const decoder *in, ewa_status status, const char *what) {
    return ewa_fail(in->context, status, "%s: Radiance: byte %llu: %s", in->name,
                    (unsigned long long)in->reader.at_bytes, what);
}

static bool begins_with(const uint8_t *line, uint64_t length, const char *word) {
    return length >= strlen(word) && memcmp(line, word, strlen(word)) == 0;
}

/// Reads the lines up to the empty one.
static ewa_status read_head(decoder *in) {
    static const char format[] = "FORMAT=", exposure[] = "EXPOSURE=";
    for (;;) {
        uint64_t length;
        const uint8_t *line = ewa_reader_take_line(&in->reader, '\n', &length);
        if (!line) return fail(in, EWA_ERROR_FORMAT, "the head does not end");
        if (length && line[length - 1] == '\r') length--;
        if (length == 0) return EWA_OK;
        const char *end = (const char *)line + length;
        if (begins_with(line, length, format) && !begins_with(line, length, "FORMAT=32-bit_rle_rgbe"))
            return fail(in, EWA_ERROR_UNSUPPORTED, "a format other than 32-bit_rle_rgbe");
        if (begins_with(line, length, exposure)) {
            const char *text = (const char *)line + sizeof exposure - 1;
            double value;
            while (text < end && *text == ' ') text++;
            if (!ewa_number_read_f64(text, end, &value) || !(value > 0) || !(value < 1e30))
                return fail(in, EWA_ERROR_FORMAT, "an exposure that is not positive");
            in->exposure *= value;
        }
    }
}

/// Reads " AXIS number" of the line with the size.
static const char *read_side(const char *text, const char *end, char axis, uint32_t *side_px) {
    int64_t value;
    if (end - text < 3 || text[0] != axis || text[1] != ' ') return NULL;
    text = ewa_number_read_i64(text + 2, end, &value);
    if (!text || value < 1 || value > UINT32_MAX) return NULL;
    *side_px = (uint32_t)value;
    return text;
}

static ewa_status read_size(decoder *in) {
    uint64_t length;
    const uint8_t *line = ewa_reader_take_line(&in->reader, '\n', &length);
    const char *text = line ? (const char *)line : "", *end = text + (line ? length : 0);
    if (!line || length < 2 || (text[0] != '-' && text[0] != '+'))
        return fail(in, EWA_ERROR_FORMAT, "no line with the size");
    in->from_bottom = text[0] == '+';
    text = read_side(text + 1, end, 'Y', &in->height_px);
    if (text && end - text > 2 && text[0] == ' ' && text[1] == '+')
        text = read_side(text + 2, end, 'X', &in->width_px);
    else
        text = NULL;
    if (!text) return fail(in, EWA_ERROR_UNSUPPORTED, "the size is none of '-Y N +X N' and '+Y N +X N'");
    const uint32_t limit = ewa_context_limits(in->context)->max_image_side;
    if (in->width_px > limit || in->height_px > limit)
        return ewa_fail(in->context, EWA_ERROR_LIMIT, "%s: %u x %u pixels are over the limit of %u a side",
                        in->name, in->width_px, in->height_px, limit);
    // No row takes less than one pixel.
    if ((uint64_t)in->height_px * PIXEL_BYTES > ewa_reader_left(&in->reader))
        return fail(in, EWA_ERROR_FORMAT, "too short for its rows");
    return EWA_OK;
}

/// Reads the runs of a row, component by component.
static bool read_runs(decoder *in, uint8_t *pixels) {
    for (uint32_t c = 0; c < PIXEL_BYTES; c++) {
        for (uint32_t x = 0; x < in->width_px;) {
            const uint8_t *count = ewa_reader_take(&in->reader, 1);
            if (!count || *count == 0) return false;
            const bool repeats = *count > MAX_RUN;
            const uint32_t length = repeats ? *count - MAX_RUN : *count;
            const uint8_t *values = ewa_reader_take(&in->reader, repeats ? 1 : length);
            if (!values || length > in->width_px - x) return false;
            for (uint32_t i = 0; i < length; i++, x++) pixels[PIXEL_BYTES * x + c] = values[repeats ? 0 : i];
        }
    }
    return true;
}

/// Reads the pixels of a row after its first; (1, 1, 1, n) repeats the one before n times, several of these
/// in a row are the digits of one number.
static bool read_pixels(decoder *in, uint8_t *pixels) {
    uint32_t shift = 0;
    for (uint32_t x = 1; x < in->width_px;) {
        const uint8_t *pixel = ewa_reader_take(&in->reader, PIXEL_BYTES);
        if (!pixel) return false;
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            memcpy(pixels + (size_t)PIXEL_BYTES * x++, pixel, PIXEL_BYTES);
            shift = 0;
            continue;
        }
        if (shift > 24) return false;
        const uint64_t length = (uint64_t)pixel[3] << shift;
        if (length > in->width_px - x) return false;
        for (uint64_t i = 0; i < length; i++, x++)
            memcpy(pixels + (size_t)PIXEL_BYTES * x, pixels + (size_t)PIXEL_BYTES * (x - 1), PIXEL_BYTES);
        shift += 8;
    }
    return true;
}

static bool read_row(decoder *in, uint8_t *pixels) {
    const uint8_t *first = ewa_reader_take(&in->reader, PIXEL_BYTES);
    if (!first) return false;
    const bool may_run = in->width_px >= MIN_RUN_WIDTH && in->width_px <= MAX_RUN_WIDTH;
    if (may_run && first[0] == 2 && first[1] == 2 && first[2] < 128)
        return ((uint32_t)first[2] << 8 | first[3]) == in->width_px && read_runs(in, pixels);
    memcpy(pixels, first, PIXEL_BYTES);
    return read_pixels(in, pixels);
}

/// 2^(exponent - 136), exact: 136 is the exponent of 1 and the eight bits of a mantissa.
static double scale_of(uint8_t exponent) {
    double scale = 1;
    for (int e = exponent; e < 136; e++) scale *= 0.5;
    for (int e = 136; e < exponent; e++) scale *= 2;
    return scale;
}

static ewa_status read_rows(decoder *in, uint8_t *pixels, ewa_image *image) {
    double scales[256];
    for (int e = 0; e < 256; e++) scales[e] = e == 0 ? 0 : scale_of((uint8_t)e) / in->exposure;
    for (uint32_t row = 0; row < in->height_px; row++) {
        if (!read_row(in, pixels)) return fail(in, EWA_ERROR_FORMAT, "a row that ends early or too late");
        const uint32_t y = in->from_bottom ? in->height_px - 1 - row : row;
        float *to = image->pixels + 3 * (size_t)y * in->width_px;
        for (size_t x = 0; x < in->width_px; x++)
            for (size_t c = 0; c < 3; c++) {
                const uint8_t *pixel = pixels + PIXEL_BYTES * x;
                // A mantissa stands for the middle of its interval, as in Radiance itself.
                to[3 * x + c] = (float)((pixel[c] + 0.5) * scales[pixel[3]]);
            }
    }
    return EWA_OK;
}

bool ewa_hdr_recognise(const uint8_t *bytes, size_t size_bytes) {
    return size_bytes >= 10 &&
           (begins_with(bytes, size_bytes, "#?RADIANCE") || begins_with(bytes, size_bytes, "#?RGBE"));
}

ewa_status ewa_hdr_decode(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                          ewa_image *image) {
    *image = (ewa_image){0};
    decoder in = {.context = context,
                  .name = name,
                  .reader = {.bytes = bytes, .size_bytes = size_bytes},
                  .exposure = 1};
    EWA_TRY(read_head(&in));
    EWA_TRY(read_size(&in));
    EWA_TRY(ewa_image_create(context, in.width_px, in.height_px, 3, image));
    uint8_t *pixels = ewa_allocate(context, in.width_px, PIXEL_BYTES);
    ewa_status status = pixels ? read_rows(&in, pixels, image) : EWA_ERROR_MEMORY;
    ewa_release(context, pixels, in.width_px, PIXEL_BYTES);
    if (status != EWA_OK) ewa_image_free(image);
    return status;
}
