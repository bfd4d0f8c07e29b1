// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Well-known text of coordinate reference systems by their EPSG codes.
#ifndef EWA_SRC_LAS_WKT_H
#define EWA_SRC_LAS_WKT_H

#include <stdbool.h>

enum { EWA_LAS_WKT_BYTES = 4096 };

/// Writes the well-known text (OGC 01-009) of "HORIZONTAL" or "HORIZONTAL+VERTICAL", EPSG codes in decimals, zero-terminated;
/// false where one of them is not among those that are known: zones of UTM, MGA and grids of some countries, with common
/// systems of heights. Any thread.
bool ewa_las_wkt_make(const char *codes, char text[EWA_LAS_WKT_BYTES]);

#endif
