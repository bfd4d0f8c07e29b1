// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Textures and pictures for tests of forward texture mapping.
#include "resample/texture_fixture.h"
#include "texture/texture.h"

#include <math.h>
#include <string.h>

raster raster_make(ewa_pixel_format format, uint32_t channel_count, uint32_t width_px, uint32_t height_px) {
    raster image = {.row_count = height_px};
    image.row_bytes = (size_t)width_px * channel_count * (format == EWA_PIXEL_LINEAR ? 4 : 1);
    image.stride_bytes = (image.row_bytes + RASTER_GAP_BYTES) / 4 * 4;
    image.memory = malloc(image.stride_bytes * height_px);
    assert_non_null(image.memory);
    memset(image.memory, RASTER_GAP, image.stride_bytes * height_px);
    for (uint32_t y = 0; y < height_px; y++)
        memset((char *)image.memory + y * image.stride_bytes, 0, image.row_bytes);
    image.source =
        (ewa_texture_source){image.memory, format, channel_count, width_px, height_px, image.stride_bytes};
    image.target =
        (ewa_texture_target){image.memory, format, channel_count, width_px, height_px, image.stride_bytes};
    return image;
}

void raster_free(raster *image) {
    for (size_t y = 0; y < image->row_count; y++)
        for (size_t i = image->row_bytes; i < image->stride_bytes; i++)
            assert_int_equal(((char *)image->memory)[y * image->stride_bytes + i], RASTER_GAP);
    free(image->memory);
    image->memory = NULL;
}

double raster_get(const raster *image, uint32_t x, uint32_t y, uint32_t channel) {
    const char *row = (const char *)image->memory + y * image->stride_bytes;
    const size_t at = (size_t)x * image->source.channel_count + channel;
    if (image->source.format == EWA_PIXEL_SRGB8) return ((const uint8_t *)row)[at];
    float number;
    memcpy(&number, row + 4 * at, sizeof number);
    return (double)number;
}

void raster_set(raster *image, uint32_t x, uint32_t y, uint32_t channel, double number) {
    char *row = (char *)image->memory + y * image->stride_bytes;
    const size_t at = (size_t)x * image->source.channel_count + channel;
    const float linear = (float)number;
    if (image->source.format == EWA_PIXEL_SRGB8)
        ((uint8_t *)row)[at] = (uint8_t)number;
    else
        memcpy(row + 4 * at, &linear, sizeof linear);
}

void raster_paint(raster *image, uint64_t seed) {
    check_random random = {seed};
    double waves[4][3];
    for (int c = 0; c < 4; c++)
        for (int i = 0; i < 3; i++) waves[c][i] = check_uniform(&random, 0.05, 0.6);
    const uint32_t channels = image->source.channel_count;
    const bool bytes = image->source.format == EWA_PIXEL_SRGB8;
    for (uint32_t y = 0; y < image->source.height_px; y++) {
        for (uint32_t x = 0; x < image->source.width_px; x++) {
            double color[4];
            for (int c = 0; c < 4; c++)
                color[c] = 0.5 +
                           0.35 * sin(waves[c][0] * x + 3 * c) * cos(waves[c][1] * y + waves[c][2] * x) +
                           check_uniform(&random, -0.14, 0.14);
            for (uint32_t c = 0; c < channels; c++) {
                const double premultiplied =
                    channels == 4 && c < 3 && !bytes ? color[c] * color[3] : color[c];
                raster_set(image, x, y, c, bytes ? floor(255 * color[c] + 0.5) : premultiplied);
            }
        }
    }
}

/// Sums squares and finds the largest difference.
static double compare(const raster *a, const raster *b, double *largest) {
    double squares = 0;
    const uint32_t channels = a->source.channel_count;
    const double unit = a->source.format == EWA_PIXEL_SRGB8 ? 255 : 1;
    *largest = 0;
    assert_int_equal(a->row_bytes, b->row_bytes);
    for (uint32_t y = 0; y < a->source.height_px; y++)
        for (uint32_t x = 0; x < a->source.width_px; x++)
            for (uint32_t c = 0; c < channels; c++) {
                const double difference = fabs(raster_get(a, x, y, c) - raster_get(b, x, y, c)) / unit;
                if (!(difference <= *largest)) *largest = difference; // a NaN stays
                squares += difference * difference;
            }
    return squares / ((double)a->source.width_px * a->source.height_px * channels);
}

double raster_difference(const raster *a, const raster *b) {
    double largest;
    compare(a, b, &largest);
    return largest;
}

double raster_rms(const raster *a, const raster *b) {
    double largest;
    return sqrt(compare(a, b, &largest));
}

bool raster_same(const raster *a, const raster *b) {
    for (size_t y = 0; y < a->row_count; y++)
        if (memcmp((char *)a->memory + y * a->stride_bytes, (char *)b->memory + y * b->stride_bytes,
                   a->row_bytes))
            return false;
    return true;
}

ewa_texture_options texture_options(ewa_texture_method method) {
    WITH_DEFAULTS(ewa_texture_options, options);
    options.method = method;
    return options;
}

ewa_mat3 texture_map_of(const double h[9]) {
    ewa_mat3 map;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) map.m[i][j] = h[3 * j + i];
    return map;
}

void texture_draw(ewa_context *context, const raster *source, const ewa_mat3 *map,
                  const ewa_texture_options *options, raster *target) {
    assert_int_equal(ewa_texture_map(context, &source->source, map, options, &target->target, NULL), EWA_OK);
}

void texture_draw_reference(ewa_context *context, const raster *source, const ewa_mat3 *map,
                            const ewa_texture_options *options, raster *target) {
    assert_int_equal(ewa_texture_map_reference(context, &source->source, map, options, &target->target),
                     EWA_OK);
}
