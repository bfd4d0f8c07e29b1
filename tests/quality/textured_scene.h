// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Textured meshes as pictures by ray casting: what their points are compared with.
#ifndef EWA_TESTS_QUALITY_TEXTURED_SCENE_H
#define EWA_TESTS_QUALITY_TEXTURED_SCENE_H

#include "ewa/ewa.h"

/// Draws a mesh without light: `samples` x `samples` rays per pixel through the triangles, bilinear lookup of
/// the pictures, a box per pixel. 4 channels, linear, premultiplied; back faces are not seen when `cull`. The
/// caller frees the picture.
ewa_status textured_cast(const ewa_mesh *mesh, const ewa_camera *camera, uint32_t samples, bool cull,
                         ewa_image *picture);

/// PSNR in dB of two pictures in sRGB, over the pixels that both cover wholly.
double textured_psnr(const ewa_image *a, const ewa_image *b);

#endif
