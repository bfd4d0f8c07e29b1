// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// JPEG in a library without libjpeg: known, and refused.
#include "base/base.h"
#include "ewa/io.h"
#include "io/image/jpeg.h"

static ewa_status refuse(ewa_context *context, const char *name) {
    return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: JPEG, which this build has not (EWA_WITH_JPEG)", name);
}

ewa_status ewa_jpeg_decode(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                           ewa_image *image) {
    (void)bytes, (void)size_bytes;
    *image = (ewa_image){0};
    return refuse(context, name);
}

ewa_status ewa_jpeg_save(ewa_context *context, const char *path, uint32_t width_px, uint32_t height_px,
                         uint32_t channel_count, const uint8_t *pixels, size_t stride_bytes,
                         const ewa_image_save_options *options) {
    (void)width_px, (void)height_px, (void)channel_count, (void)stride_bytes, (void)options;
    if (!context || !path || !pixels) return EWA_ERROR_ARGUMENT;
    return refuse(context, path);
}
