// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What kind of numbers a volume holds.
#ifndef EWA_SRC_IMAGE_VOLUME_KIND_H
#define EWA_SRC_IMAGE_VOLUME_KIND_H

#include "image/volume_surfaces.h"

enum { EWA_MAX_LABELS = 255 };

typedef enum ewa_volume_kind {
    EWA_KIND_SCAN,    ///< materials with borders between them, and noise
    EWA_KIND_FIELD,   ///< a quantity that changes gradually from voxel to voxel
    EWA_KIND_PICTURE, ///< one slice
    EWA_KIND_LABELS,  ///< codes of things
    EWA_KIND_NOISE    ///< neighbours have nothing in common
} ewa_volume_kind;

/// The codes of a volume of labels, ascending; count is 0 where it is none.
typedef struct ewa_volume_labels {
    float codes[EWA_MAX_LABELS];
    uint32_t count, surrounding; ///< codes; which of them is no thing but what surrounds them
} ewa_volume_labels;

/// Decides. `surfaces` have been measured; `labels` is filled in any case.
ewa_volume_kind ewa_volume_find_kind(const ewa_volume *volume, const ewa_volume_facts *facts,
                                     const ewa_volume_surfaces *surfaces, ewa_volume_labels *labels);

/// What a look from the six sides of the box shows of one label.
typedef struct ewa_label_sight {
    double voxels;  ///< of it on the lines of sight
    double entries; ///< lines that meet it
    double before;  ///< share of the transitions to other labels that come after this one
} ewa_label_sight;

/// Looks along a sample of the columns of each axis, from both ends; one result per code. Errors:
/// EWA_ERROR_MEMORY.
ewa_status ewa_volume_labels_look(const ewa_volume *volume, const ewa_volume_labels *labels,
                                  ewa_label_sight sights[EWA_MAX_LABELS]);

/// The index of a code, or labels->count.
uint32_t ewa_volume_label_index(const ewa_volume_labels *labels, float value);

#endif
