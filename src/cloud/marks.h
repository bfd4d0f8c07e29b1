// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Marks of points, block by block, on all threads.
#ifndef EWA_SRC_CLOUD_MARKS_H
#define EWA_SRC_CLOUD_MARKS_H

#include "ewa/select.h"

enum { EWA_MARK_BLOCK = 512 };

/// Looks at the marks of `count` <= EWA_MARK_BLOCK points from point `first`; marks[0] is that of the first.
typedef void ewa_mark_block(const void *data, uint64_t first, uint32_t count, uint8_t *marks);

/// Has all blocks of a cloud looked at.
void ewa_mark_blocks(const ewa_cloud *cloud, ewa_mark_block *look, const void *data, uint8_t *marks);

/// Finds the position of three components; NULL after reporting that there is none.
const ewa_attribute *ewa_marks_position(const ewa_cloud *cloud);

#endif
