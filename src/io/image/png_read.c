// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// PNG in, by libspng, to linear light.
#include "base/base.h"
#include "base/unpacking.h"
#include "image/srgb.h"
#include "io/image/png.h"

#include <math.h>
#include <spng.h>
#include <string.h>

enum {
    // DEFLATE makes at most 1032 bytes of one: a shorter file cannot hold what its header claims.
    DEFLATE_MAX_RATIO = 1032,
    // Text, profiles and the like; bounds what a compressed chunk may grow to.
    CHUNK_LIMIT_BYTES = 1 << 24,
};

typedef struct reader {
    ewa_context *context;
    const char *name;
    spng_ctx *png;
    struct spng_ihdr header;
    uint32_t channel_count;
    bool straight; // colours are not multiplied by alpha
} reader;

static ewa_status fail_spng(const reader *in, int error) {
    const ewa_status status = error == SPNG_EMEM ? EWA_ERROR_MEMORY : EWA_ERROR_FORMAT;
    return ewa_fail(in->context, status, "%s: PNG: %s", in->name, spng_strerror(error));
}

static ewa_status open_png(reader *in, const uint8_t *bytes, size_t size_bytes) {
    in->png = spng_ctx_new(0);
    if (!in->png) return ewa_fail(in->context, EWA_ERROR_MEMORY, "%s: out of memory", in->name);
    int error = spng_set_png_buffer(in->png, bytes, size_bytes);
    if (!error) error = spng_set_chunk_limits(in->png, CHUNK_LIMIT_BYTES, CHUNK_LIMIT_BYTES);
    if (!error) error = spng_get_ihdr(in->png, &in->header);
    return error ? fail_spng(in, error) : EWA_OK;
}

/// Checks the header against the limits and the file's length, before anything of the picture's size is made.
static ewa_status check_size(reader *in, size_t size_bytes) {
    const struct spng_ihdr *header = &in->header;
    const ewa_limits *limits = ewa_context_limits(in->context);
    if (header->width > limits->max_image_side || header->height > limits->max_image_side)
        return ewa_fail(in->context, EWA_ERROR_LIMIT, "%s: %u x %u pixels are over the limit of %u a side",
                        in->name, header->width, header->height, limits->max_image_side);
    struct spng_trns transparency;
    const int error = spng_get_trns(in->png, &transparency);
    if (error && error != SPNG_ECHUNKAVAIL) return fail_spng(in, error);
    const bool has_alpha = !error || header->color_type == SPNG_COLOR_TYPE_GRAYSCALE_ALPHA ||
                           header->color_type == SPNG_COLOR_TYPE_TRUECOLOR_ALPHA;
    in->channel_count = has_alpha ? 4 : header->color_type == SPNG_COLOR_TYPE_GRAYSCALE ? 1 : 3;

    static const uint8_t samples[] = {1, 0, 3, 1, 2, 0, 4}; // by colour type
    const uint64_t pixel_count = (uint64_t)header->width * header->height;
    const uint64_t packed_bytes = pixel_count * samples[header->color_type] * header->bit_depth / 8;
    if (packed_bytes / DEFLATE_MAX_RATIO > size_bytes)
        return ewa_fail(in->context, EWA_ERROR_FORMAT, "%s: PNG: %zu bytes cannot hold %u x %u pixels",
                        in->name, size_bytes, header->width, header->height);
    const uint64_t decoded_bytes =
        pixel_count * (in->channel_count * sizeof(float) + (header->bit_depth == 16 ? 8 : 4));
    return ewa_memory_check_unpacked(in->context, size_bytes, EWA_UNPACKED_RATIO, decoded_bytes, "%s: PNG of %u x %u pixels",
                                     in->name, header->width, header->height);
}

/// RGBA of 8 bits to the image's channels, linear, and premultiplied unless `straight`.
static void convert_8(const uint8_t *rgba, bool straight, ewa_image *image) {
    const size_t pixel_count = (size_t)image->width_px * image->height_px;
    const uint32_t colours = image->channel_count == 1 ? 1 : 3;
    float *out = image->pixels;
    for (size_t i = 0; i < pixel_count; i++, rgba += 4) {
        const float alpha = (float)rgba[3] / 255.0f, weight = straight ? 1 : alpha;
        for (uint32_t c = 0; c < colours; c++) *out++ = ewa_srgb_decoded[rgba[c]] * weight;
        if (image->channel_count == 4) *out++ = alpha;
    }
}

static void convert_16(const uint16_t *rgba, const float linear[65536], bool straight, ewa_image *image) {
    const size_t pixel_count = (size_t)image->width_px * image->height_px;
    const uint32_t colours = image->channel_count == 1 ? 1 : 3;
    float *out = image->pixels;
    for (size_t i = 0; i < pixel_count; i++, rgba += 4) {
        const float alpha = (float)rgba[3] / 65535.0f, weight = straight ? 1 : alpha;
        for (uint32_t c = 0; c < colours; c++) *out++ = linear[rgba[c]] * weight;
        if (image->channel_count == 4) *out++ = alpha;
    }
}

static ewa_status convert(const reader *in, const void *rgba, ewa_image *image) {
    if (in->header.bit_depth != 16) {
        convert_8(rgba, in->straight, image);
        return EWA_OK;
    }
    float *linear = ewa_allocate(in->context, 65536, sizeof *linear);
    if (!linear) return EWA_ERROR_MEMORY;
    for (int code = 0; code < 65536; code++) linear[code] = (float)ewa_srgb_decode(code / 65535.0);
    convert_16(rgba, linear, in->straight, image);
    ewa_release(in->context, linear, 65536, sizeof *linear);
    return EWA_OK;
}

static ewa_status read_pixels(const reader *in, ewa_image *image) {
    const bool deep = in->header.bit_depth == 16;
    const size_t pixel_count = (size_t)in->header.width * in->header.height, pixel_bytes = deep ? 8 : 4;
    void *rgba = ewa_allocate(in->context, pixel_count, pixel_bytes);
    if (!rgba) return EWA_ERROR_MEMORY;
    int error = spng_decode_image(in->png, rgba, pixel_count * pixel_bytes,
                                  deep ? SPNG_FMT_RGBA16 : SPNG_FMT_RGBA8, SPNG_DECODE_TRNS);
    if (!error) error = spng_decode_chunks(in->png); // to the end: a file cut short is broken
    ewa_status status = error ? fail_spng(in, error) : EWA_OK;
    if (status == EWA_OK)
        status = ewa_image_create(in->context, in->header.width, in->header.height, in->channel_count, image);
    if (status == EWA_OK) status = convert(in, rgba, image);
    ewa_release(in->context, rgba, pixel_count, pixel_bytes);
    if (status != EWA_OK) ewa_image_free(image);
    return status;
}

ewa_status ewa_png_decode(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                          bool straight, ewa_image *image) {
    *image = (ewa_image){0};
    reader in = {.context = context, .name = name, .straight = straight};
    ewa_status status = open_png(&in, bytes, size_bytes);
    if (status == EWA_OK) status = check_size(&in, size_bytes);
    if (status == EWA_OK) status = read_pixels(&in, image);
    spng_ctx_free(in.png);
    return status;
}

static ewa_status read_numbers(const reader *in, ewa_image *image) {
    const bool deep = in->header.bit_depth == 16;
    const size_t pixel_count = (size_t)in->header.width * in->header.height, number_bytes = deep ? 2 : 1;
    void *numbers = ewa_allocate(in->context, pixel_count, number_bytes);
    if (!numbers) return EWA_ERROR_MEMORY;
    // 16 bits as they are in the file, in the machine's byte order.
    int error =
        spng_decode_image(in->png, numbers, pixel_count * number_bytes, deep ? SPNG_FMT_PNG : SPNG_FMT_G8, 0);
    if (!error) error = spng_decode_chunks(in->png);
    ewa_status status = error ? fail_spng(in, error) : EWA_OK;
    if (status == EWA_OK)
        status = ewa_image_create(in->context, in->header.width, in->header.height, 1, image);
    for (size_t i = 0; status == EWA_OK && i < pixel_count; i++) {
        const uint32_t number = deep ? ((const uint16_t *)numbers)[i] : ((const uint8_t *)numbers)[i];
        image->pixels[i] = number < UINT16_MAX ? (float)number : INFINITY;
    }
    ewa_release(in->context, numbers, pixel_count, number_bytes);
    return status;
}

ewa_status ewa_png_decode_numbers(ewa_context *context, const char *name, const uint8_t *bytes,
                                  size_t size_bytes, ewa_image *image) {
    *image = (ewa_image){0};
    reader in = {.context = context, .name = name};
    ewa_status status = open_png(&in, bytes, size_bytes);
    if (status == EWA_OK && (in.header.color_type != SPNG_COLOR_TYPE_GRAYSCALE || in.header.bit_depth < 8))
        status =
            ewa_fail(context, EWA_ERROR_UNSUPPORTED,
                     "%s: depths have to be grey of 8 or 16 bits, this PNG has colours, alpha or %u bits",
                     name, in.header.bit_depth);
    if (status == EWA_OK) status = check_size(&in, size_bytes);
    if (status == EWA_OK) status = read_numbers(&in, image);
    spng_ctx_free(in.png);
    return status;
}

/// Decodes to memory that the caller releases also after a failure.
static ewa_status read_codes(const reader *in, uint8_t **codes, size_t *code_bytes) {
    const size_t all_bytes = 4 * (size_t)in->header.width * in->header.height;
    *codes = ewa_allocate(in->context, all_bytes, 1);
    if (!*codes) return EWA_ERROR_MEMORY;
    *code_bytes = all_bytes;
    int error = spng_decode_image(in->png, *codes, all_bytes, SPNG_FMT_RGBA8, SPNG_DECODE_TRNS);
    if (!error) error = spng_decode_chunks(in->png);
    return error ? fail_spng(in, error) : EWA_OK;
}

ewa_status ewa_png_decode_codes(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                                uint32_t *width_px, uint32_t *height_px, uint8_t **codes, size_t *code_bytes) {
    *codes = NULL;
    *code_bytes = 0;
    reader in = {.context = context, .name = name};
    ewa_status status = open_png(&in, bytes, size_bytes);
    if (status == EWA_OK) status = check_size(&in, size_bytes);
    if (status == EWA_OK) status = read_codes(&in, codes, code_bytes);
    spng_ctx_free(in.png);
    *width_px = in.header.width;
    *height_px = in.header.height;
    if (status == EWA_OK) return EWA_OK;
    ewa_release(context, *codes, *code_bytes, 1);
    *codes = NULL;
    *code_bytes = 0;
    return status;
}

ewa_status ewa_png_size(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                        uint32_t *width_px, uint32_t *height_px) {
    reader in = {.context = context, .name = name};
    const ewa_status status = open_png(&in, bytes, size_bytes);
    if (status == EWA_OK) {
        *width_px = in.header.width;
        *height_px = in.header.height;
    }
    spng_ctx_free(in.png);
    return status;
}
