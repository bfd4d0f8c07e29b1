// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volumes like those of scanners: materials with blurred borders and noise, and which voxel is of what.
#ifndef EWA_TESTS_IMAGE_PHANTOMS_H
#define EWA_TESTS_IMAGE_PHANTOMS_H

#include "ewa/ewa.h"

enum { PHANTOM_SIDE = 96, PHANTOM_VOXELS = PHANTOM_SIDE * PHANTOM_SIDE * PHANTOM_SIDE };

/// Materials; 0 is what surrounds.
enum {
    PHANTOM_AIR,
    PHANTOM_LEAVES,
    PHANTOM_WOOD,
    PHANTOM_POT,
    PHANTOM_BOX,
    PHANTOM_NUT,
    PHANTOM_SOFT,
    PHANTOM_BONE
};

/// A volume while it is made: a value and a material for every voxel, x fastest.
typedef struct phantom {
    float *values;     ///< [PHANTOM_VOXELS]
    uint8_t *material; ///< [PHANTOM_VOXELS]
} phantom;

/// What a scanner adds.
typedef struct phantom_scan {
    double air, noise; ///< value of air, standard deviation
    bool padded;       ///< zeros outside of the circle that it sees
} phantom_scan;

phantom phantom_make(double air);
void phantom_free(phantom *scene);

/// A small tree: leaves of 3 voxels, branches, a trunk, earth in a pot with a rim.
void phantom_add_bonsai(phantom *scene, double leaves, double wood, double earth, double pot);

/// A cup around the middle with walls of `thick` voxels, with or without a lid; in it a nut, a shell around a
/// kernel with hollows.
void phantom_add_walnut(phantom *scene, double cup, double thick, bool lid, double shell, double kernel);

/// A head: soft matter around a skull with holes, cut off at the neck, which reaches the lowest face.
void phantom_add_head(phantom *scene, double skin, double brain, double bone);

/// Blurs, adds noise, pads, rounds to 8 bits: a volume with unit steps, whose voxels the caller frees with
/// ewa_volume_free().
ewa_volume phantom_scan_it(ewa_context *context, const phantom *scene, const phantom_scan *scan);

/// What is seen of some materials, from the six sides, line by line.
typedef struct phantom_seen {
    double object;    ///< mean share of the light that comes from them, where any of them is behind a pixel
    double elsewhere; ///< mean opacity where none of them is
    double opacity;   ///< mean opacity where any of them is
} phantom_seen;

/// `materials`: bits 1 << material.
phantom_seen phantom_look(const phantom *scene, const ewa_volume *volume, const ewa_transfer *transfer,
                          unsigned materials);

/// The transfer function that is chosen for a volume.
ewa_transfer phantom_transfer(const ewa_volume *volume);

/// Fails the test, with `what`, where a value is not within its limits.
void phantom_expect(const char *what, double value, double low, double high);

#endif
