// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which surfaces of a pixel the reference composites (docs/math.md section 8; semantics.h, layers).
#ifndef EWA_SRC_REFERENCE_LAYERING_H
#define EWA_SRC_REFERENCE_LAYERING_H

#include "surface/surfel.h"

typedef struct ewa_reference_layering {
    uint32_t max_layers; ///< surfaces
    bool transparent; ///< these let light through wherever they are
    bool merge_last;  ///< the last of so many is all that is left
} ewa_reference_layering;

/// `options` are checked ones; `count` points are looked at.
ewa_reference_layering ewa_reference_layering_of(const ewa_render_options *options, const ewa_surfel_reader *reader,
                                                 uint64_t count);

/// Returns the alpha of a merged layer whose alpha as one surface and coverage q/q0 are given.
double ewa_reference_merged_alpha(double alpha, double coverage);

/// Takes the cotangent of that to those of both.
void ewa_reference_merged_alpha_pull_back(double alpha, double coverage, double cotangent, double *by_alpha,
                                          double *by_coverage);

#endif
