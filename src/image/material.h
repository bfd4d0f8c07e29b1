// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The members of a material by name, and their ranges.
#ifndef EWA_SRC_IMAGE_MATERIAL_H
#define EWA_SRC_IMAGE_MATERIAL_H

#include "ewa/shade.h"

enum { EWA_MATERIAL_MEMBERS = 5 };

typedef struct ewa_material_member {
    const char *name;
    size_t offset; ///< of a float in ewa_material
    double least, most;
} ewa_material_member;

extern const ewa_material_member ewa_material_members[EWA_MATERIAL_MEMBERS];

/// Fails with "WHERE: MEMBER of material INDEX is ..." unless every number is in its range.
/// Errors: EWA_ERROR_ARGUMENT.
ewa_status ewa_material_check(ewa_context *context, const char *where, uint32_t index,
                              const ewa_material *material);

#endif
