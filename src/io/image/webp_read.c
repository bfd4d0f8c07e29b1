// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// WebP through libwebp, into memory of the context.
#include "base/base.h"
#include "base/unpacking.h"
#include "image/srgb.h"
#include "io/image/webp.h"

#include <string.h>
#include <webp/decode.h>

/// What libwebp takes by itself for a pixel: the picture before it is turned to RGB, and the same of alpha.
enum { OWN_BYTES_PER_PIXEL = 5, OWN_BYTES = 1 << 20 };

static uint64_t own_bytes(const WebPBitstreamFeatures *facts) {
    return OWN_BYTES + (uint64_t)facts->width * (uint64_t)facts->height * OWN_BYTES_PER_PIXEL;
}

/// Reads the header.
static ewa_status look(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                       WebPBitstreamFeatures *facts) {
    if (WebPGetFeatures(bytes, size_bytes, facts) != VP8_STATUS_OK || facts->width <= 0 || facts->height <= 0)
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: WebP: the header is broken", name);
    if (facts->has_animation) return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: WebP: an animation", name);
    return EWA_OK;
}

/// Decodes to `codes`, RGB or RGBA. Errors: EWA_ERROR_LIMIT, EWA_ERROR_FORMAT.
static ewa_status unpack(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                         const WebPBitstreamFeatures *facts, uint32_t channels, uint8_t *codes) {
    const size_t row_bytes = (size_t)facts->width * channels, all_bytes = row_bytes * (size_t)facts->height;
    EWA_TRY(ewa_memory_take(context, own_bytes(facts), "%s: WebP of %d x %d pixels", name, facts->width, facts->height));
    const uint8_t *decoded = channels == 4
                                 ? WebPDecodeRGBAInto(bytes, size_bytes, codes, all_bytes, (int)row_bytes)
                                 : WebPDecodeRGBInto(bytes, size_bytes, codes, all_bytes, (int)row_bytes);
    ewa_memory_give(context, own_bytes(facts));
    return decoded ? EWA_OK
                   : ewa_fail(context, EWA_ERROR_FORMAT, "%s: WebP: the data are broken or cut short", name);
}

/// Codes to linear light.
static void convert(const uint8_t *codes, bool straight, ewa_image *image) {
    const uint32_t channels = image->channel_count;
    const size_t count = (size_t)image->width_px * image->height_px * channels;
    for (size_t i = 0; i < count; i += channels) {
        const float alpha = channels == 4 ? (float)codes[i + 3] / 255.0f : 1;
        for (uint32_t c = 0; c < 3; c++)
            image->pixels[i + c] = ewa_srgb_decoded[codes[i + c]] * (straight ? 1 : alpha);
        if (channels == 4) image->pixels[i + 3] = alpha;
    }
}

ewa_status ewa_webp_decode(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                           bool straight, ewa_image *image) {
    *image = (ewa_image){0};
    WebPBitstreamFeatures facts;
    EWA_TRY(look(context, name, bytes, size_bytes, &facts));
    const uint32_t width = (uint32_t)facts.width, height = (uint32_t)facts.height,
                   channels = facts.has_alpha ? 4 : 3;
    const uint64_t count = (uint64_t)width * height * channels;
    // The library's own is given back before there are floats.
    const uint64_t more = own_bytes(&facts) > count * sizeof(float) ? own_bytes(&facts) : count * sizeof(float);
    EWA_TRY(ewa_memory_check_unpacked(context, size_bytes, EWA_UNPACKED_RATIO, count + more, "%s: WebP of %u x %u pixels", name,
                                      width, height));
    uint8_t *codes = ewa_allocate(context, count, 1);
    if (!codes) return EWA_ERROR_MEMORY;
    ewa_status status = unpack(context, name, bytes, size_bytes, &facts, channels, codes);
    if (status == EWA_OK) status = ewa_image_create(context, width, height, channels, image);
    if (status == EWA_OK) convert(codes, straight, image);
    ewa_release(context, codes, count, 1);
    return status;
}

ewa_status ewa_webp_look(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes, uint32_t *width_px,
                         uint32_t *height_px) {
    WebPBitstreamFeatures facts;
    EWA_TRY(look(context, name, bytes, size_bytes, &facts));
    *width_px = (uint32_t)facts.width;
    *height_px = (uint32_t)facts.height;
    return EWA_OK;
}

ewa_status ewa_webp_decode_codes(ewa_context *context, const char *name, const uint8_t *bytes,
                                 size_t size_bytes, uint32_t *width_px, uint32_t *height_px, uint8_t **codes,
                                 size_t *code_bytes) {
    *codes = NULL;
    *code_bytes = 0;
    WebPBitstreamFeatures facts;
    EWA_TRY(look(context, name, bytes, size_bytes, &facts));
    const size_t all_bytes = 4 * (size_t)facts.width * (size_t)facts.height;
    EWA_TRY(ewa_memory_check_unpacked(context, size_bytes, EWA_UNPACKED_RATIO, all_bytes + own_bytes(&facts),
                                      "%s: WebP of %d x %d pixels", name, facts.width, facts.height));
    uint8_t *made = ewa_allocate(context, all_bytes, 1);
    if (!made) return EWA_ERROR_MEMORY;
    ewa_status status = unpack(context, name, bytes, size_bytes, &facts, 4, made);
    if (status != EWA_OK) {
        ewa_release(context, made, all_bytes, 1);
        return status;
    }
    *width_px = (uint32_t)facts.width;
    *height_px = (uint32_t)facts.height;
    *codes = made;
    *code_bytes = all_bytes;
    return EWA_OK;
}
