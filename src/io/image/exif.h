// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What cameras write beside a photograph: which way it was held.
#ifndef EWA_SRC_IO_IMAGE_EXIF_H
#define EWA_SRC_IO_IMAGE_EXIF_H

#include "ewa/image.h"

/// How the rows and columns of a picture lie: EXIF's numbers.
enum {
    EWA_EXIF_UPRIGHT = 1,
    EWA_EXIF_SIDEWAYS = 5, ///< from here on to 8 rows are what stands upright
    EWA_EXIF_LAST = 8,
};

/// Returns the orientation that a JPEG file's EXIF says, in [1, 8]; EWA_EXIF_UPRIGHT where it says nothing that can be read.
uint32_t ewa_exif_orientation(const uint8_t *bytes, size_t size_bytes);

/// Turns a picture that lies on its side, from EWA_EXIF_SIDEWAYS on, upright. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_exif_turn(ewa_image *image, uint32_t orientation);

#endif
