// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: what clip lines leave of pixels (docs/math.md section 5; semantics.h, clip lines).
#ifndef EWA_SRC_SURFACE_PIPELINE_CLIP_H
#define EWA_SRC_SURFACE_PIPELINE_CLIP_H

#include "surface/pipeline_camera.h"

/// A clip line of each lane, as ewa_clip_line.
typedef struct wide_line {
    wf x_inward, y_inward, offset, reach, narrow, per_narrow, per_widths;
} wide_line;

static ALWAYS_INLINE wide_line broadcast_line(const ewa_clip_line *l) {
    return (wide_line){wf_set(l->x_inward), wf_set(l->y_inward),   wf_set(l->offset),    wf_set(l->reach),
                       wf_set(l->narrow),   wf_set(l->per_narrow), wf_set(l->per_widths)};
}

/// The area of pixels' squares on the inner side of a line. x, y: pixel centres in the field.
static ALWAYS_INLINE wf half_plane_share(const wide_line *l, wf x, wf y) {
    const wf zero = wf_set(0), inside = wf_fma(l->x_inward, x, wf_fma(l->y_inward, y, l->offset));
    // What is on the far side of the line is a triangle, as far as it is narrow, and a parallelogram.
    const wf left = wf_sub(l->reach, wf_abs(inside)), corner = wf_min(wf_max(left, zero), l->narrow);
    const wf triangle = wf_mul(wf_mul(corner, corner), l->per_narrow);
    const wf beside = wf_max(wf_sub(left, l->narrow), zero);
    const wf smaller = wf_mul(wf_fma(beside, wf_set(2), triangle), l->per_widths);
    return wf_select(wf_lt(zero, inside), wf_sub(wf_set(1), smaller), smaller);
}

/// What clip lines leave of pixels' squares.
typedef struct clip_sample {
    wf line[EWA_CLIP_LINES]; ///< each of them
    wf first;                ///< the first two together
    wf share;                ///< all together
} clip_sample;

static ALWAYS_INLINE clip_sample clip_at(const ewa_clip *clip, wf x, wf y) {
    clip_sample sample;
    for (uint32_t i = 0; i < clip->count; i++) {
        const wide_line line = broadcast_line(&clip->line[i]);
        sample.line[i] = half_plane_share(&line, x, y);
    }
    sample.first =
        clip->either ? wf_max(sample.line[0], sample.line[1]) : wf_min(sample.line[0], sample.line[1]);
    sample.share = sample.first;
    for (uint32_t i = 2; i < clip->count; i++) sample.share = wf_min(sample.share, sample.line[i]);
    return sample;
}

/// Of a block in the tile.
static ALWAYS_INLINE clip_sample clip_block(const ewa_tile *tile, const ewa_clip *clip, uint32_t row,
                                            uint32_t column) {
    return clip_at(clip, wf_add(lanes_x(), wf_set(column_px(tile, column))),
                   wf_add(lanes_y(), wf_set(row_px(tile, row))));
}

#endif
