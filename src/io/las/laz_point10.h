// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The core of a record of the formats 0 to 5, unpacked.
#ifndef EWA_SRC_LAZ_POINT10_H
#define EWA_SRC_LAZ_POINT10_H

#include "io/las/laz_fields.h"

/// The core of a record of the formats 0 to 5.
typedef struct ewa_laz_point10 {
    int32_t x, y, z;
    uint16_t intensity, source;
    uint8_t flags; ///< return number (3 bits), number of returns (3), scan direction, edge of the flight line
    uint8_t classification, angle, user;
} ewa_laz_point10;

static inline ewa_laz_point10 ewa_laz_point10_load(const uint8_t *record) {
    return (ewa_laz_point10){
        .x = (int32_t)ewa_laz_load32(record),
        .y = (int32_t)ewa_laz_load32(record + 4),
        .z = (int32_t)ewa_laz_load32(record + 8),
        .intensity = ewa_laz_load16(record + 12),
        .flags = record[14],
        .classification = record[15],
        .angle = record[16],
        .user = record[17],
        .source = ewa_laz_load16(record + 18),
    };
}

static inline void ewa_laz_point10_store(const ewa_laz_point10 *point, uint8_t *record) {
    ewa_laz_store32(record, (uint32_t)point->x);
    ewa_laz_store32(record + 4, (uint32_t)point->y);
    ewa_laz_store32(record + 8, (uint32_t)point->z);
    ewa_laz_store16(record + 12, point->intensity);
    record[14] = point->flags;
    record[15] = point->classification;
    record[16] = point->angle;
    record[17] = point->user;
    ewa_laz_store16(record + 18, point->source);
}

#endif
