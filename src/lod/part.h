// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Parts of an octree as files.
#ifndef EWA_SRC_LOD_PART_H
#define EWA_SRC_LOD_PART_H

#include "lod/assemble.h"

/// Makes the regions `subset`, `subset` + `subset_count`, ... into a part's file.
ewa_status ewa_lod_part_write(ewa_lod_builder *b, const char *out, uint32_t subset, uint32_t subset_count);

#endif
