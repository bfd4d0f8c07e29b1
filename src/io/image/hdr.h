// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Radiance pictures (.hdr, RGBE).
#ifndef EWA_SRC_HDR_H
#define EWA_SRC_HDR_H

#include "ewa/image.h"

/// Tells whether the bytes begin like a Radiance picture.
bool ewa_hdr_recognise(const uint8_t *bytes, size_t size_bytes);

/// Decodes a Radiance picture of RGBE pixels, run-length encoded or not, rows from the top ("-Y height +X
/// width") or from the bottom ("+Y ..."), to 3 channels; divided by the product of its EXPOSURE lines.
/// Errors: EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED (XYZE, other orders of pixels), EWA_ERROR_LIMIT,
/// EWA_ERROR_MEMORY.
ewa_status ewa_hdr_decode(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                          ewa_image *image);

#endif
