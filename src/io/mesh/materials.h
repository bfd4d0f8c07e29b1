// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Material tables, the inner side.
#ifndef EWA_SRC_MATERIALS_H
#define EWA_SRC_MATERIALS_H

#include "ewa/shade.h"

/// ewa_materials_load() from memory; `name` stands for the file in messages.
ewa_status ewa_materials_read(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                              ewa_material materials[EWA_MAX_MATERIALS], uint32_t *count);

#endif
