// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Points as records: the place from the root's corner, 3 x 32 bits, the numbers that vary, and behind them what is
// estimated: a normal of 3 x 16 bits, times 32767, a radius, a signed curvature and a border, floats.
#ifndef EWA_SRC_LOD_RECORDS_H
#define EWA_SRC_LOD_RECORDS_H

#include "lod/region.h"

static inline uint32_t ewa_record_place(const uint8_t *record, int axis) {
    uint32_t place;
    __builtin_memcpy(&place, record + 4 * axis, sizeof place);
    return place;
}

/// The Morton code of a record's place.
static inline uint64_t ewa_record_code(const ewa_lattice *lattice, const uint8_t *record) {
    int64_t place[3];
    for (int c = 0; c < 3; c++) place[c] = lattice->low[c] + ewa_record_place(record, c);
    return ewa_lattice_code(lattice, place);
}

/// Store a unit normal, in steps of 16 of its 32767, a radius with 11 bits after the first, a curvature with 4 and a border
/// with 7 each, so that they pack well.
void ewa_record_put_normal(uint8_t *to, const float normal[3]);
void ewa_record_put_radius(uint8_t *to, float radius_world);
void ewa_record_put_curvature(uint8_t *to, float curvature);
void ewa_record_put_border(uint8_t *to, const float border_world[3]);

/// Copies the numbers of an attribute of the inputs.
void ewa_record_get(const ewa_region_plan *plan, const uint8_t *record, const char *attribute, uint8_t *to);

/// Makes a cloud of records with the attributes of the output. The caller owns `*piece`. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_records_to_cloud(const ewa_region_plan *plan, const uint8_t *records, uint32_t count,
                                ewa_cloud **piece);

/// Reads the unit normals, 3 floats each, that points came with, where none are made.
void ewa_records_read_normals(const ewa_region_plan *plan, const uint8_t *records, uint32_t count, float *normals);

/// Makes surfels of records, which are in the order of their codes. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_records_to_representatives(const ewa_region_plan *plan, const uint8_t *records, uint32_t count,
                                          ewa_representatives *representatives);

#endif
