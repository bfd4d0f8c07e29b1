// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// WebP in a library without libwebp: known, and refused.
#include "base/base.h"
#include "io/image/webp.h"

static ewa_status refuse(ewa_context *context, const char *name) {
    return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: WebP, which this build has not (EWA_WITH_WEBP)", name);
}

ewa_status ewa_webp_decode(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                           bool straight, ewa_image *image) {
    (void)bytes, (void)size_bytes, (void)straight;
    *image = (ewa_image){0};
    return refuse(context, name);
}

ewa_status ewa_webp_look(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes, uint32_t *width_px,
                         uint32_t *height_px) {
    (void)bytes, (void)size_bytes, (void)width_px, (void)height_px;
    return refuse(context, name);
}

ewa_status ewa_webp_decode_codes(ewa_context *context, const char *name, const uint8_t *bytes,
                                 size_t size_bytes, uint32_t *width_px, uint32_t *height_px, uint8_t **codes,
                                 size_t *code_bytes) {
    (void)bytes, (void)size_bytes, (void)width_px, (void)height_px;
    *codes = NULL;
    *code_bytes = 0;
    return refuse(context, name);
}

ewa_status ewa_webp_encode_codes(ewa_context *context, const char *name, uint32_t width_px, uint32_t height_px, const uint8_t *codes,
                                 ewa_webp *webp) {
    (void)width_px, (void)height_px, (void)codes;
    *webp = (ewa_webp){.bytes = NULL};
    return refuse(context, name);
}

void ewa_webp_free(ewa_webp *webp) { (void)webp; }
