// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Flat chunks: the first record as it is, then one stream of symbols for all others, item by item. This header
// holds what the items remember, and the items of version 2 in both directions (see laz_coder.h).
//
// Based on: M. Isenburg, "LASzip: lossless compression of LiDAR data" (2013); rapidlasso, "LAZ Specification
// 1.4", section "Point data format 0 to 5".
#ifndef EWA_SRC_LAZ_FLAT_H
#define EWA_SRC_LAZ_FLAT_H

#include "io/las/laz_fields.h"
#include "io/las/laz_point10.h"

/// What POINT10 of version 2 remembers.
typedef struct ewa_laz_points10 {
    EWA_LAZ_MODEL(64) changed;
    EWA_LAZ_INTEGER(32, 2) x;
    EWA_LAZ_INTEGER(32, 22) y;
    EWA_LAZ_INTEGER(32, 20) z;
    EWA_LAZ_INTEGER(16, 4) intensity;
    EWA_LAZ_INTEGER(16, 1) source;
    ewa_laz_model256 angles[2], flags[256], classifications[256], users[256];
    ewa_laz_point10 last;
    ewa_laz_median step_x[16], step_y[16];
    uint16_t intensities[16];
    int32_t heights[8];
} ewa_laz_points10;

void ewa_laz_points10_start(ewa_laz_points10 *m, const uint8_t *record);

/// Number of a pair (number of returns, return number), for all pairs, sensible or not.
extern const uint8_t ewa_laz_return_map[8][8];

/// Codes a record's core.
EWA_LAZ_INLINE void ewa_laz_point10_code(bool encoding, ewa_laz_coder *coder, ewa_laz_points10 *m,
                                         uint8_t *record) {
    enum { SOURCE = 1, USER = 2, ANGLE = 4, CLASSIFICATION = 8, INTENSITY = 16, FLAGS = 32 };
    ewa_laz_coder c = *coder;
    const ewa_laz_point10 last = m->last;
    ewa_laz_point10 now = encoding ? ewa_laz_point10_load(record) : last;
    uint32_t changed = 0;
    if (encoding) {
        const uint8_t map = ewa_laz_return_map[now.flags >> 3 & 7][now.flags & 7];
        changed = (last.flags != now.flags ? FLAGS : 0) |
                  (m->intensities[map] != now.intensity ? INTENSITY : 0) |
                  (last.classification != now.classification ? CLASSIFICATION : 0) |
                  (last.angle != now.angle ? ANGLE : 0) | (last.user != now.user ? USER : 0) |
                  (last.source != now.source ? SOURCE : 0);
    }
    changed = ewa_laz_symbol(encoding, &c, &m->changed, 64, changed);
    if (changed & FLAGS)
        now.flags = (uint8_t)ewa_laz_symbol(encoding, &c, &m->flags[last.flags], 256, now.flags);
    const uint32_t number = now.flags & 7, returns = now.flags >> 3 & 7;
    const uint32_t map = ewa_laz_return_map[returns][number];
    const uint32_t level = returns > number ? returns - number : number - returns;
    const bool single = returns == 1;
    if (changed & INTENSITY)
        m->intensities[map] = ewa_laz_integer16(encoding, &c, &m->intensity, map < 3 ? map : 3,
                                                m->intensities[map], now.intensity);
    now.intensity = m->intensities[map];
    if (changed & CLASSIFICATION)
        now.classification = (uint8_t)ewa_laz_symbol(encoding, &c, &m->classifications[last.classification],
                                                     256, now.classification);
    if (changed & ANGLE)
        now.angle = ewa_laz_byte(encoding, &c, &m->angles[now.flags >> 6 & 1], last.angle, now.angle);
    if (changed & USER) now.user = (uint8_t)ewa_laz_symbol(encoding, &c, &m->users[last.user], 256, now.user);
    if (changed & SOURCE)
        now.source = ewa_laz_integer16(encoding, &c, &m->source, 0, last.source, now.source);

    uint32_t width_x, width_y, width_z;
    const int32_t step_x = ewa_laz_integer32(encoding, &c, &m->x, single, m->step_x[map].sorted[2],
                                             (uint32_t)now.x - (uint32_t)last.x, &width_x);
    const int32_t step_y =
        ewa_laz_integer32(encoding, &c, &m->y, ewa_laz_width_context(single, width_x, 20),
                          m->step_y[map].sorted[2], (uint32_t)now.y - (uint32_t)last.y, &width_y);
    now.z = ewa_laz_integer32(encoding, &c, &m->z, ewa_laz_width_context(single, (width_x + width_y) / 2, 18),
                              m->heights[level], now.z, &width_z);
    now.x = (int32_t)((uint32_t)last.x + (uint32_t)step_x);
    now.y = (int32_t)((uint32_t)last.y + (uint32_t)step_y);
    ewa_laz_median_add(&m->step_x[map], step_x);
    ewa_laz_median_add(&m->step_y[map], step_y);
    m->heights[level] = now.z;
    m->last = now;
    if (!encoding) ewa_laz_point10_store(&now, record);
    *coder = c;
}

#endif
