// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// PNG in a library without libspng: written (png_write.c), but not read.
#include "base/base.h"
#include "io/image/png.h"

static ewa_status refuse(ewa_context *context, const char *name) {
    return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: PNG, which this build does not read (EWA_WITH_SPNG)", name);
}

ewa_status ewa_png_decode(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                          bool straight, ewa_image *image) {
    (void)bytes, (void)size_bytes, (void)straight;
    *image = (ewa_image){0};
    return refuse(context, name);
}

ewa_status ewa_png_decode_numbers(ewa_context *context, const char *name, const uint8_t *bytes,
                                  size_t size_bytes, ewa_image *image) {
    (void)bytes, (void)size_bytes;
    *image = (ewa_image){0};
    return refuse(context, name);
}

ewa_status ewa_png_decode_codes(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                                uint32_t *width_px, uint32_t *height_px, uint8_t **codes, size_t *code_bytes) {
    (void)bytes, (void)size_bytes, (void)width_px, (void)height_px;
    *codes = NULL;
    *code_bytes = 0;
    return refuse(context, name);
}

ewa_status ewa_png_size(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                        uint32_t *width_px, uint32_t *height_px) {
    (void)bytes, (void)size_bytes, (void)width_px, (void)height_px;
    return refuse(context, name);
}
