// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// WebP through libwebp, into memory of the context.
#include "base/base.h"
#include "image/srgb.h"
#include "io/image/webp.h"

#include <string.h>
#include <webp/decode.h>

bool ewa_webp_recognise(const uint8_t *bytes, size_t size_bytes) {
    return size_bytes >= 12 && memcmp(bytes, "RIFF", 4) == 0 && memcmp(bytes + 8, "WEBP", 4) == 0;
}

/// Decodes to `codes`, RGB or RGBA, and from there to the image.
static ewa_status decode(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                         bool straight, uint8_t *codes, ewa_image *image) {
    const uint32_t channels = image->channel_count;
    const size_t row_bytes = (size_t)image->width_px * channels, all_bytes = row_bytes * image->height_px;
    const uint8_t *decoded = channels == 4
                                 ? WebPDecodeRGBAInto(bytes, size_bytes, codes, all_bytes, (int)row_bytes)
                                 : WebPDecodeRGBInto(bytes, size_bytes, codes, all_bytes, (int)row_bytes);
    if (!decoded)
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: WebP: the data are broken or cut short", name);
    for (size_t i = 0; i < all_bytes; i += channels) {
        const float alpha = channels == 4 ? (float)codes[i + 3] / 255.0f : 1;
        for (uint32_t c = 0; c < 3; c++)
            image->pixels[i + c] = ewa_srgb_decoded[codes[i + c]] * (straight ? 1 : alpha);
        if (channels == 4) image->pixels[i + 3] = alpha;
    }
    return EWA_OK;
}

ewa_status ewa_webp_decode(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                           bool straight, ewa_image *image) {
    *image = (ewa_image){0};
    WebPBitstreamFeatures facts;
    if (WebPGetFeatures(bytes, size_bytes, &facts) != VP8_STATUS_OK || facts.width <= 0 || facts.height <= 0)
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: WebP: the header is broken", name);
    if (facts.has_animation) return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: WebP: an animation", name);
    const uint32_t width = (uint32_t)facts.width, height = (uint32_t)facts.height,
                   channels = facts.has_alpha ? 4 : 3;
    const uint64_t count = (uint64_t)width * height * channels;
    if (count * (sizeof(float) + 1) > ewa_context_limits(context)->max_memory_bytes)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%s: WebP of %u x %u pixels is over max_memory_bytes", name,
                        width, height);
    EWA_TRY(ewa_image_create(context, width, height, channels, image));
    uint8_t *codes = ewa_allocate(context, count, 1);
    ewa_status status =
        codes ? decode(context, name, bytes, size_bytes, straight, codes, image) : EWA_ERROR_MEMORY;
    ewa_release(context, codes, count, 1);
    if (status != EWA_OK) ewa_image_free(image);
    return status;
}

ewa_status ewa_webp_decode_codes(ewa_context *context, const char *name, const uint8_t *bytes,
                                 size_t size_bytes, uint32_t *width_px, uint32_t *height_px, uint8_t **codes,
                                 size_t *code_bytes) {
    *codes = NULL;
    *code_bytes = 0;
    WebPBitstreamFeatures facts;
    if (WebPGetFeatures(bytes, size_bytes, &facts) != VP8_STATUS_OK || facts.width <= 0 || facts.height <= 0)
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: WebP: the header is broken", name);
    if (facts.has_animation) return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: WebP: an animation", name);
    const size_t row_bytes = 4 * (size_t)facts.width, all_bytes = row_bytes * (size_t)facts.height;
    if (all_bytes > ewa_context_limits(context)->max_memory_bytes)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%s: WebP of %d x %d pixels is over max_memory_bytes", name,
                        facts.width, facts.height);
    uint8_t *made = ewa_allocate(context, all_bytes, 1);
    if (!made) return EWA_ERROR_MEMORY;
    if (!WebPDecodeRGBAInto(bytes, size_bytes, made, all_bytes, (int)row_bytes)) {
        ewa_release(context, made, all_bytes, 1);
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: WebP: the data are broken or cut short", name);
    }
    *width_px = (uint32_t)facts.width;
    *height_px = (uint32_t)facts.height;
    *codes = made;
    *code_bytes = all_bytes;
    return EWA_OK;
}
