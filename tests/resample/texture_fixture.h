// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Textures and pictures for tests of forward texture mapping.
#ifndef EWA_TESTS_TEXTURE_FIXTURE_H
#define EWA_TESTS_TEXTURE_FIXTURE_H

#include "check.h"

/// A raster in memory of its own, with bytes between its rows that nobody may touch.
typedef struct raster {
    void *memory;
    size_t row_count, stride_bytes, row_bytes;
    ewa_texture_source source;
    ewa_texture_target target;
} raster;

enum { RASTER_GAP_BYTES = 20, RASTER_GAP = 0x5a };

/// Makes a raster of zeros; the caller frees it.
raster raster_make(ewa_pixel_format format, uint32_t channel_count, uint32_t width_px, uint32_t height_px);

/// Frees a raster after checking that the bytes between its rows are as they were.
void raster_free(raster *image);

/// Number `channel` of a pixel: a byte, or a float.
double raster_get(const raster *image, uint32_t x, uint32_t y, uint32_t channel);
void raster_set(raster *image, uint32_t x, uint32_t y, uint32_t channel, double number);

/// Fills a raster with soft blobs and some noise, the same for each seed; alpha too where there is one.
void raster_paint(raster *image, uint64_t seed);

/// Largest difference of two rasters of the same shape, in 1/255 for bytes.
double raster_difference(const raster *a, const raster *b);

/// Root mean square of the same.
double raster_rms(const raster *a, const raster *b);

/// Whether both have the same bytes.
bool raster_same(const raster *a, const raster *b);

/// Options with defaults but for the method.
ewa_texture_options texture_options(ewa_texture_method method);

/// The map of column form: (x w, y w, w) = H (u, v, 1).
ewa_mat3 texture_map_of(const double h[9]);

/// Draws; has to succeed.
void texture_draw(ewa_context *context, const raster *source, const ewa_mat3 *map,
                  const ewa_texture_options *options, raster *target);
void texture_draw_reference(ewa_context *context, const raster *source, const ewa_mat3 *map,
                            const ewa_texture_options *options, raster *target);

#endif
