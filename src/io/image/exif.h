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

/// ewa_image_load() of a picture that is wanted in a size. One that lies on its side, by its EXIF, is turned upright if the
/// size is that of the turned one and not its own: cameras are either of pictures as they are stored (COLMAP) or of
/// pictures as they are looked at (Metashape). Errors: those.
ewa_status ewa_image_load_sized(ewa_context *context, const char *path, uint32_t width_px, uint32_t height_px,
                                ewa_image *image);

#endif
