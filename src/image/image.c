// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Float images: their memory.
#include "ewa/image.h"
#include "base/base.h"

enum { MAX_CHANNELS = 16 };

static size_t number_count(const ewa_image *image) {
    return (size_t)image->width_px * image->height_px * image->channel_count;
}

ewa_status ewa_image_create(ewa_context *context, uint32_t width_px, uint32_t height_px,
                            uint32_t channel_count, ewa_image *image) {
    if (!context || !image) return EWA_ERROR_ARGUMENT;
    *image = (ewa_image){0};
    if (width_px == 0 || height_px == 0 || channel_count == 0 || channel_count > MAX_CHANNELS)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "image of %u x %u pixels with %u channels", width_px,
                        height_px, channel_count);
    const uint32_t limit = ewa_context_limits(context)->max_image_side;
    if (width_px > limit || height_px > limit)
        return ewa_fail(context, EWA_ERROR_LIMIT, "image of %u x %u pixels is over the limit of %u a side",
                        width_px, height_px, limit);
    ewa_image made = {context, width_px, height_px, channel_count, NULL};
    made.pixels = ewa_allocate_zeroed(context, number_count(&made), sizeof *made.pixels);
    if (!made.pixels) return EWA_ERROR_MEMORY;
    *image = made;
    return EWA_OK;
}

void ewa_image_free(ewa_image *image) {
    if (!image) return;
    if (image->pixels) ewa_release(image->context, image->pixels, number_count(image), sizeof *image->pixels);
    *image = (ewa_image){0};
}
