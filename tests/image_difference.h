// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How far two images are from each other.
#ifndef EWA_TESTS_IMAGE_DIFFERENCE_H
#define EWA_TESTS_IMAGE_DIFFERENCE_H

#include "ewa/image.h"

#include <math.h>

typedef struct image_difference {
    double rms, maximum;
    double psnr_db;                ///< for a full scale of 1; infinite for equal images
    uint64_t over_threshold_count; ///< pixels in which any channel differs by more than the threshold
} image_difference;

/// Compares all numbers of two images. What is NaN in one of them only is infinitely far, as are images of
/// different shapes.
static inline image_difference image_compare(const ewa_image *a, const ewa_image *b, double threshold) {
    const size_t pixel_count = (size_t)a->width_px * a->height_px, channel_count = a->channel_count;
    if (a->width_px != b->width_px || a->height_px != b->height_px || a->channel_count != b->channel_count)
        return (image_difference){INFINITY, INFINITY, -INFINITY, pixel_count};
    image_difference found = {0};
    double square_sum = 0;
    for (size_t pixel = 0; pixel < pixel_count; pixel++) {
        double largest = 0;
        for (size_t i = pixel * channel_count; i < (pixel + 1) * channel_count; i++) {
            const double from = (double)a->pixels[i], to = (double)b->pixels[i];
            const bool same = from == to || (isnan(from) && isnan(to));
            const double d = same ? 0 : isnan(from) || isnan(to) ? INFINITY : fabs(from - to);
            square_sum += d * d;
            largest = fmax(largest, d);
        }
        found.maximum = fmax(found.maximum, largest);
        found.over_threshold_count += largest > threshold;
    }
    found.rms = sqrt(square_sum / (double)(pixel_count * channel_count));
    found.psnr_db = found.rms > 0 ? -20 * log10(found.rms) : INFINITY;
    return found;
}

#endif
