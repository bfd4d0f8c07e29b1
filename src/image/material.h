// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Checked materials.
#ifndef EWA_SRC_IMAGE_MATERIAL_H
#define EWA_SRC_IMAGE_MATERIAL_H

#include "ewa/shade.h"

/// Fails with "WHERE: MEMBER of material INDEX is ..." unless every number is in its range.
/// Errors: EWA_ERROR_ARGUMENT.
ewa_status ewa_material_check(ewa_context *context, const char *where, uint32_t index,
                              const ewa_material *material);

#endif
