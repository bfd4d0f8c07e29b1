// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures from memory, the inner side.
#ifndef EWA_SRC_IMAGE_FILE_H
#define EWA_SRC_IMAGE_FILE_H

#include "ewa/image.h"

/// ewa_image_load_memory(); with `straight`, colours of PNG and WebP are not multiplied by alpha, so that
/// those of transparent pixels are there.
ewa_status ewa_image_decode(ewa_context *context, const void *bytes, size_t size_bytes, const char *name,
                            bool straight, ewa_image *image);

/// The name of the format of a picture, by its first bytes, of those too that are not read; NULL: it is none.
const char *ewa_image_kind(const uint8_t *bytes, size_t size_bytes);

/// ewa_image_load() of a picture that is wanted in a size. One that lies on its side, by its EXIF, is turned upright if the
/// size is that of the turned one and not its own: cameras are either of pictures as they are stored (COLMAP) or of
/// pictures as they are looked at (Metashape). Errors: those.
ewa_status ewa_image_load_sized(ewa_context *context, const char *path, uint32_t width_px, uint32_t height_px,
                                ewa_image *image);

#endif
