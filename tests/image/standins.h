// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volumes like those of scanners: materials with blurred borders and noise, and which voxel is of what.
#ifndef EWA_TESTS_IMAGE_STANDINS_H
#define EWA_TESTS_IMAGE_STANDINS_H

#include "ewa/ewa.h"

enum { STANDIN_SIDE = 96, STANDIN_VOXELS = STANDIN_SIDE * STANDIN_SIDE * STANDIN_SIDE };

/// Materials; 0 is what surrounds.
enum {
    STANDIN_AIR,
    STANDIN_LEAVES,
    STANDIN_WOOD,
    STANDIN_POT,
    STANDIN_BOX,
    STANDIN_NUT,
    STANDIN_SOFT,
    STANDIN_BONE
};

/// A volume while it is made: a value and a material for every voxel, x fastest.
typedef struct standin {
    float *values;     ///< [STANDIN_VOXELS]
    uint8_t *material; ///< [STANDIN_VOXELS]
} standin;

/// What a scanner adds.
typedef struct standin_scan {
    double air, noise; ///< value of air, standard deviation
    bool padded;       ///< zeros outside of the circle that it sees
} standin_scan;

standin standin_make(double air);
void standin_free(standin *scene);

/// A small tree: leaves of 3 voxels, branches, a trunk, earth in a pot with a rim.
void standin_add_bonsai(standin *scene, double leaves, double wood, double earth, double pot);

/// A cup around the middle with walls of `thick` voxels, with or without a lid; in it a nut, a shell around a
/// kernel with hollows.
void standin_add_walnut(standin *scene, double cup, double thick, bool lid, double shell, double kernel);

/// A head: soft matter around a skull with holes, cut off at the neck, which reaches the lowest face.
void standin_add_head(standin *scene, double skin, double brain, double bone);

/// Blurs, adds noise, pads, rounds to 8 bits: a volume with unit steps, whose voxels the caller frees with
/// ewa_volume_free().
ewa_volume standin_scan_it(ewa_context *context, const standin *scene, const standin_scan *scan);

/// What is seen of some materials, from the six sides, line by line.
typedef struct standin_seen {
    double object;    ///< mean share of the light that comes from them, where any of them is behind a pixel
    double elsewhere; ///< mean opacity where none of them is
    double opacity;   ///< mean opacity where any of them is
} standin_seen;

/// `materials`: bits 1 << material.
standin_seen standin_look(const standin *scene, const ewa_volume *volume, const ewa_transfer *transfer,
                          unsigned materials);

#endif
