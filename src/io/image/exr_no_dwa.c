// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// OpenEXR packed by DWA in a library without its C++: known, and refused.
#include "io/image/exr_dwa.h"

#include <stdio.h>

ewa_exr_dwa_result ewa_exr_dwa_decode(const uint8_t *header, size_t header_bytes, const uint8_t *bytes, size_t size_bytes,
                                      const char *const *channels, uint32_t channel_count, uint32_t width_px, uint32_t height_px,
                                      float *pixels, char *reason, size_t reason_bytes) {
    (void)header, (void)header_bytes, (void)bytes, (void)size_bytes, (void)channels, (void)channel_count, (void)width_px;
    (void)height_px, (void)pixels;
    snprintf(reason, reason_bytes,
             "packed by DWA, which this build does not read (EWA_WITH_DWA); packed another way, such as ZIP, it is read");
    return EWA_EXR_DWA_ABSENT;
}
