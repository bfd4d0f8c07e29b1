// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Into how many parts a frame's pixels are divided, where its surfels are to say (docs/math.md section 7).
#ifndef EWA_SRC_SURFACE_PARTS_H
#define EWA_SRC_SURFACE_PARTS_H

#include "ewa/camera.h"
#include "ewa/render.h"

/// Places along the scale of sizes, steps of an octave: from discs twice as large as asks for a part to those a tenth of it.
enum { EWA_PART_STEPS = 16, EWA_PART_FIRST = -EWA_PART_STEPS, EWA_PART_PLACES = 69 };

/// Into how many parts a frame's pixels are divided along each side.
typedef struct ewa_division {
    uint32_t count;     ///< 1, 2, 4 or EWA_MAX_SUPERSAMPLING
    double finer_share; ///< [0, 1): of the picture of twice as many in the mean of both
} ewa_division;

/// Areas on the screen of what a frame shows, by the size of its surfels: whole numbers, so that no order counts.
/// Zero-initialise.
typedef struct ewa_part_areas {
    int64_t at[EWA_PART_PLACES];
} ewa_part_areas;

/// Adds surfels of a radius in pixels that cover an area, in square pixels, on the screen.
void ewa_part_areas_add(ewa_part_areas *areas, double radius_px, double area);

/// Adds packets of surfels that a picture of the camera shows, every `step`-th one.
void ewa_part_areas_add_surfels(ewa_part_areas *areas, const ewa_camera *camera, const ewa_surfels *surfels, uint32_t step);

/// The step for so many packets in a frame.
uint32_t ewa_part_areas_step(uint64_t packet_count);

/// Returns how far the median of the areas is below EWA_PART_RADIUS_PX in radius, in octaves: at least -1, which also stands for
/// nothing at all, continuous in what was added.
double ewa_part_areas_octaves(const ewa_part_areas *areas);

/// Returns parts that are so many octaves smaller than pixels, or up to one more: from the octave k = 0, 1, 2 on 2^(k + 1) along a side, which
/// take over within an eighth of an octave behind it. No more than a picture of the camera's size may have.
ewa_division ewa_parts_for(double octaves, const ewa_camera *camera);

#endif
