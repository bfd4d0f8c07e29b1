// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Items of version 1, of flat chunks that were written before 2011: decoded only.
#ifndef EWA_SRC_LAZ_FIRST_H
#define EWA_SRC_LAZ_FIRST_H

#include "io/las/laz.h"
#include "io/las/laz_coder.h"

/// Bytes of an item's memory.
size_t ewa_laz_first_bytes(const ewa_laz_item *item);

/// Lets an item begin with its part of the first record.
void ewa_laz_first_start(const ewa_laz_item *item, void *state, const uint8_t *record);

/// Decodes an item's part of a record; `stride`: bytes from the record before.
void ewa_laz_first_decode(const ewa_laz_item *item, ewa_laz_coder *coder, void *state, uint32_t stride,
                          uint8_t *record);

#endif
