// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Regions: boxes, outlines on a picture, classes, by which points of a scene are hidden or kept. docs/scene.md.
#ifndef EWA_REGION_H
#define EWA_REGION_H

#include "ewa/camera.h"
#include "ewa/cloud.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    EWA_MAX_REGIONS = 16,     ///< of a scene
    EWA_REGION_CORNERS = 64,  ///< of an outline
    EWA_REGION_CLASSES = 256, ///< codes of classes, from 0 on
    EWA_REGION_WORDS = 8,     ///< of their bits, 32 each
};

/// Points by where they are and what they are: all that is given has to hold for a point to be in the region.
/// Zero-initialised: nothing is given, and no point is in it.
typedef struct ewa_region {
    bool kept;               ///< what is outside is hidden; false: what is inside is
    bool has_box;            ///< `box_world` is given
    bool has_classes;        ///< `classes` are given: points without the attribute "classification" are of none
    double box_world[6];     ///< lower corner, upper corner, world units; both belong to it
    double box_axes_world[9]; ///< of a box that is turned: three unit axes along which the corners are told; zeros: those of the world
    uint32_t corner_count;   ///< of the outline; [3, EWA_REGION_CORNERS], or 0: none is given
    double outline_px[2 * EWA_REGION_CORNERS]; ///< corners x, y on the picture, pixels; an odd number of times around is inside
    /// Of the outline: rows x w, y w and w, acts on columns (x, y, z, 1) of the world; w <= 0: outside.
    double world_to_picture[12];
    uint32_t classes[EWA_REGION_WORDS]; ///< bit c % 32 of word c / 32: class c
} ewa_region;

/// Gives a region the outline of a place on a camera's picture: `corner_count` >= 3 corners x, y in `outline_px`, pixels,
/// finite; of more than EWA_REGION_CORNERS those are left out that change it least. Any thread. Errors: EWA_ERROR_ARGUMENT.
EWA_API ewa_status ewa_region_set_outline(ewa_region *region, const ewa_camera *camera, const double *outline_px,
                                          uint32_t corner_count);

/// Clears the marks, one per point as of ewa/select.h, of the points that regions hide. Errors: EWA_ERROR_ARGUMENT (no positions).
EWA_API ewa_status ewa_regions_mark(const ewa_region *regions, uint32_t count, const ewa_cloud *cloud, uint8_t *marks);

#ifdef __cplusplus
}
#endif
#endif
