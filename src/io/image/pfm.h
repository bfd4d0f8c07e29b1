// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Portable float maps.
#ifndef EWA_SRC_PFM_H
#define EWA_SRC_PFM_H

#include "ewa/image.h"

/// Tells whether the bytes begin like a PFM file.
bool ewa_pfm_recognise(const uint8_t *bytes, size_t size_bytes);

/// Decodes a PFM file: "Pf" one channel, "PF" three, either byte order. The magnitude of its scale, for which
/// there is no common meaning, is ignored. Errors: EWA_ERROR_FORMAT, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_pfm_decode(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                          ewa_image *image);

/// Writes a PFM file of 1 or 3 channels; of 4, the first three. Errors: EWA_ERROR_IO, EWA_ERROR_UNSUPPORTED,
/// EWA_ERROR_MEMORY.
ewa_status ewa_pfm_save(const ewa_image *image, const char *path);

#endif
