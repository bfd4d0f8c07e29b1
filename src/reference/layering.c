// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which surfaces of a pixel the reference composites (docs/math.md section 8).
#include "reference/layering.h"
#include "surface/semantics.h"

#include <math.h>

enum { READ_POINTS = 64 };

/// Whether some surfel that can be drawn is not opaque. Points have to be read only where some alpha may be below 1.
static bool any_transparent(const ewa_surfel_reader *reader, uint64_t count) {
    ewa_surfel surfels[READ_POINTS];
    bool drawable[READ_POINTS];
    const bool has_alpha = reader->color && reader->color->component_count == 4;
    for (uint64_t first = 0; has_alpha && first < count; first += READ_POINTS) {
        const uint64_t here = count - first < READ_POINTS ? count - first : READ_POINTS;
        ewa_surfel_read(reader, first, here, surfels, drawable);
        for (uint64_t i = 0; i < here; i++)
            if (drawable[i] && surfels[i].alpha < 1) return true;
    }
    return false;
}

ewa_reference_layering ewa_reference_layering_of(const ewa_render_options *options, const ewa_surfel_reader *reader,
                                                 uint64_t count) {
    const bool transparent =
        options->layers != 1 && options->passes == 3 && (options->opacity < 1 || any_transparent(reader, count));
    if (!transparent) return (ewa_reference_layering){options->edge_layers, false, options->edge_layers > 1};
    const uint32_t max_layers = options->layers == 0 ? EWA_LAYERS_EXACT : options->layers;
    return (ewa_reference_layering){max_layers, true, max_layers != EWA_LAYERS_EXACT};
}

/// What one surface more, from the `i`-th on, takes of the light, as a share.
static double share_of(double coverage, int i) { return fmin(fmax(4 * (coverage - i) - 2, 0), 1); }

double ewa_reference_merged_alpha(double alpha, double coverage) {
    double through = 1 - alpha;
    for (int i = 1; i < EWA_MERGED_SURFACES; i++) through *= 1 - alpha * share_of(coverage, i);
    return 1 - through;
}

void ewa_reference_merged_alpha_pull_back(double alpha, double coverage, double cotangent, double *by_alpha,
                                          double *by_coverage) {
    double through = 1 - alpha, d_alpha = -1, d_coverage = 0; // the latter: derivatives of it
    for (int i = 1; i < EWA_MERGED_SURFACES; i++) {
        const double share = share_of(coverage, i), factor = 1 - alpha * share;
        const double slope = share > 0 && share < 1 ? 4 : 0;
        d_alpha = d_alpha * factor - through * share;
        d_coverage = d_coverage * factor - through * alpha * slope;
        through *= factor;
    }
    *by_alpha = -cotangent * d_alpha;
    *by_coverage = -cotangent * d_coverage;
}
