// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How far splats at contours move. Across the contour of a surface that is sampled finely, its coverage is the prefilter's
// integral, and alpha is that over tau: it is a half where little of the prefilter is within, outside of the contour.
// Where both sides are drawn, the far side shows through the near one, and as much again.
#include "surface/contour.h"
#include "math/gaussian.h"
#include "surface/semantics.h"

double ewa_contour_shift(const ewa_render_options *options, bool orthographic) {
    if (options->kernel == EWA_KERNEL_RAYCAST && !orthographic) return 0;
    if (options->passes != 3 || !options->edge_antialiasing || options->point_size_px > 0) return 0;
    const double alone = options->cull == EWA_CULL_BACK ? 0.5 : 1 - 0.70710678118654752;
    const double below = options->edge_threshold * alone;
    double low = 0, high = 6; // x that as much is below -x, to steps that no rounding of the series decides
    for (int i = 0; i < 16; i++) {
        const double middle = (low + high) / 2;
        if (ewa_normal_below(-middle) > below)
            low = middle;
        else
            high = middle;
    }
    return EWA_CONTOUR_SHIFT * low;
}

double ewa_contour_sine2(double cutoff, double shift) {
    // At the sine s a disc reaches F s across, and with its way s (F + w (1 - s^2 / S)), w = EWA_CONTOUR_WIDTH c. That is at
    // most F, for every s, up to this S.
    const double way = EWA_CONTOUR_WIDTH * shift, both = cutoff + way;
    const double largest = way > cutoff / 2 ? 6.75 * way * cutoff * cutoff / (both * both * both) : 1;
    return EWA_CONTOUR_WITHIN * largest;
}
