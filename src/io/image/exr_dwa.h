// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// OpenEXR packed by DWA, which OpenEXRCore 3.1 does not unpack: what is reached of OpenEXR's C++.
#ifndef EWA_SRC_EXR_DWA_H
#define EWA_SRC_EXR_DWA_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/// What became of a call; absent: the library is without DWA.
typedef enum ewa_exr_dwa_result {
    EWA_EXR_DWA_DONE,
    EWA_EXR_DWA_BROKEN,
    EWA_EXR_DWA_MEMORY,
    EWA_EXR_DWA_ABSENT
} ewa_exr_dwa_result;

/// Writes the named channels of a file, of which `header` takes the place of the first bytes, to `pixels`, height_px rows of width_px
/// pixels of channel_count floats, if its data window is as large. `reason` gets why not, unless memory ends. Any thread.
ewa_exr_dwa_result ewa_exr_dwa_decode(const uint8_t *header, size_t header_bytes, const uint8_t *bytes, size_t size_bytes,
                                      const char *const *channels, uint32_t channel_count, uint32_t width_px, uint32_t height_px,
                                      float *pixels, char *reason, size_t reason_bytes);

#ifdef __cplusplus
}
#endif
#endif
