// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Whether normals that a file gives are those of the surface that its points lie on.
#ifndef EWA_SRC_ESTIMATE_GIVEN_H
#define EWA_SRC_ESTIMATE_GIVEN_H

#include "estimate/local.h"
#include "ewa/cloud.h"

/// The note of clouds whose normals are not, with the share of points, in whole percent.
#define EWA_NORMALS_OFF_NOTE "estimate.normals_off"

/// What was seen of them; workers have one each.
typedef struct given_count {
    uint32_t seen, off;
} given_count;

/// Which place of a block is looked at: any, but the same for every run.
uint32_t ewa_given_lane(const ewa_block *block);

/// Looks at a place, if it is on a plain surface: whether the normal of a point there is over 60 degrees off.
void ewa_given_look(const ewa_attribute *normal, uint32_t point, const local_surface *surface, uint32_t lane, given_count *count);

/// Notes on a cloud that many are off. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_given_note(ewa_cloud *cloud, const given_count *count);

#endif
