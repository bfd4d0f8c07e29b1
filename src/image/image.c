// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Float images: memory and comparison.
#include "ewa/image.h"
#include "base/base.h"

#include <math.h>

enum { MAX_CHANNELS = 16 };

static size_t number_count(const ewa_image *image) {
    return (size_t)image->width_px * image->height_px * image->channel_count;
}

/// |a - b|; infinite when only one of them is NaN, zero for equal infinities and two NaNs.
static double distance(float a, float b) {
    if (a == b) return 0;
    if (isnan(a) || isnan(b)) return isnan(a) && isnan(b) ? 0 : INFINITY;
    return fabs((double)a - (double)b);
}

ewa_status ewa_image_create(ewa_context *context, uint32_t width_px, uint32_t height_px,
                            uint32_t channel_count, ewa_image *image) {
    if (!context || !image) return EWA_ERROR_ARGUMENT;
    *image = (ewa_image){0};
    if (width_px == 0 || height_px == 0 || channel_count == 0 || channel_count > MAX_CHANNELS)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "image of %u x %u pixels with %u channels", width_px,
                        height_px, channel_count);
    const uint32_t limit = ewa_context_limits(context)->max_image_side;
    if (width_px > limit || height_px > limit)
        return ewa_fail(context, EWA_ERROR_LIMIT, "image of %u x %u pixels is over the limit of %u a side",
                        width_px, height_px, limit);
    ewa_image made = {context, width_px, height_px, channel_count, NULL};
    made.pixels = ewa_allocate_zeroed(context, number_count(&made), sizeof *made.pixels);
    if (!made.pixels) return EWA_ERROR_MEMORY;
    *image = made;
    return EWA_OK;
}

void ewa_image_free(ewa_image *image) {
    if (!image) return;
    if (image->pixels) ewa_release(image->context, image->pixels, number_count(image), sizeof *image->pixels);
    *image = (ewa_image){0};
}

ewa_status ewa_image_compare(const ewa_image *a, const ewa_image *b, double peak, double threshold,
                             ewa_difference *difference, ewa_image *heat) {
    if (!a || !b || !difference) return EWA_ERROR_ARGUMENT;
    if (heat) *heat = (ewa_image){0};
    if (a->width_px != b->width_px || a->height_px != b->height_px || a->channel_count != b->channel_count)
        return ewa_fail(a->context, EWA_ERROR_ARGUMENT,
                        "images of %u x %u x %u and %u x %u x %u cannot be compared", a->width_px,
                        a->height_px, a->channel_count, b->width_px, b->height_px, b->channel_count);
    if (!(peak > 0) || !(threshold >= 0))
        return ewa_fail(a->context, EWA_ERROR_ARGUMENT, "peak of %g and threshold of %g", peak, threshold);
    if (heat) {
        const ewa_status status = ewa_image_create(a->context, a->width_px, a->height_px, 1, heat);
        if (status != EWA_OK) return status;
    }
    double sum = 0, square_sum = 0, maximum = 0;
    uint64_t over_threshold_count = 0;
    const size_t pixel_count = (size_t)a->width_px * a->height_px;
    const float *from = a->pixels, *to = b->pixels;
    for (size_t pixel = 0; pixel < pixel_count; pixel++) {
        double largest = 0;
        for (uint32_t channel = 0; channel < a->channel_count; channel++) {
            const double d = distance(*from++, *to++);
            sum += d;
            square_sum += d * d;
            largest = d > largest ? d : largest;
        }
        maximum = largest > maximum ? largest : maximum;
        over_threshold_count += largest > threshold;
        if (heat) heat->pixels[pixel] = (float)largest;
    }
    const double count = (double)number_count(a), rms = sqrt(square_sum / count);
    *difference = (ewa_difference){.mean_absolute = sum / count,
                                   .rms = rms,
                                   .maximum = maximum,
                                   .psnr_db = rms > 0 ? 20 * log10(peak / rms) : INFINITY,
                                   .over_threshold_count = over_threshold_count};
    return EWA_OK;
}
