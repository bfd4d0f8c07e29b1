// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// OpenEXR in a library without it: known, and refused.
#include "base/base.h"
#include "io/image/exr.h"

static ewa_status refuse(ewa_context *context, const char *name) {
    return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: OpenEXR, which this build has not (EWA_WITH_EXR); PFM holds floats too",
                    name);
}

ewa_status ewa_exr_decode(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                          ewa_image *image) {
    (void)bytes, (void)size_bytes;
    *image = (ewa_image){0};
    return refuse(context, name);
}

ewa_status ewa_exr_save(const ewa_image *image, const char *path, const ewa_image_save_options *options) {
    (void)options;
    return refuse(image->context, path);
}
