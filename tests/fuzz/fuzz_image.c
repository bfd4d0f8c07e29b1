// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target: any bytes as a picture file (PNG, JPEG, OpenEXR, PFM, Radiance by their first bytes), and their EXIF.
#include "ewa/io.h"
#include "fuzz.h"
#include "io/image/exif.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    ewa_context *context = fuzz_context(1, 0, NULL);
    ewa_image image;
    if (ewa_image_load_memory(context, bytes, size_bytes, "fuzz", &image) == EWA_OK) ewa_image_free(&image);
    if (ewa_exif_orientation(bytes, size_bytes) > EWA_EXIF_LAST) abort();
    ewa_context_destroy(&context);
    return 0;
}
