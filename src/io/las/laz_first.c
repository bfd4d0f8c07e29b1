// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Items of version 1, of flat chunks that were written before 2011: decoded only.
//
// Based on: M. Isenburg, "LASzip: lossless compression of LiDAR data" (2013); LASzip's readers of version 1.
#include "io/las/laz_first.h"

#include "io/las/laz_point10.h"

/// What POINT10 of version 1 remembers.
typedef struct points_item {
    EWA_LAZ_INTEGER(32, 1) x;
    EWA_LAZ_INTEGER(32, 20) y, z;
    EWA_LAZ_INTEGER(16, 1) intensity, source;
    EWA_LAZ_INTEGER(8, 2) angle;
    EWA_LAZ_MODEL(64) changed;
    ewa_laz_model256 flags[256], classifications[256], users[256];
    ewa_laz_point10 last;
    int32_t steps_x[3], steps_y[3];
    uint32_t oldest;
} points_item;

static void start_points(points_item *m, const uint8_t *record) {
    m->last = ewa_laz_point10_load(record);
    memset(m->steps_x, 0, sizeof m->steps_x);
    memset(m->steps_y, 0, sizeof m->steps_y);
    m->oldest = 0;
}

static int32_t median_of_three(const int32_t a[3]) {
    const int32_t low = a[0] < a[1] ? a[0] : a[1], high = a[0] < a[1] ? a[1] : a[0];
    return a[2] < low ? low : a[2] > high ? high : a[2];
}

static void decode_point(ewa_laz_coder *coder, points_item *m, uint8_t *record) {
    enum { SOURCE = 1, USER = 2, ANGLE = 4, CLASSIFICATION = 8, FLAGS = 16, INTENSITY = 32, MAX_WIDTH = 19 };
    ewa_laz_coder c = *coder;
    const ewa_laz_point10 last = m->last;
    ewa_laz_point10 now = last;
    uint32_t width_x, width_y, width_z;
    const int32_t step_x = ewa_laz_integer32(false, &c, &m->x, 0, median_of_three(m->steps_x), 0, &width_x);
    const int32_t step_y = ewa_laz_integer32(false, &c, &m->y, width_x < MAX_WIDTH ? width_x : MAX_WIDTH,
                                             median_of_three(m->steps_y), 0, &width_y);
    const uint32_t width = (width_x + width_y) / 2;
    now.x = (int32_t)((uint32_t)last.x + (uint32_t)step_x);
    now.y = (int32_t)((uint32_t)last.y + (uint32_t)step_y);
    now.z = ewa_laz_integer32(false, &c, &m->z, width < MAX_WIDTH ? width : MAX_WIDTH, last.z, 0, &width_z);
    m->steps_x[m->oldest] = step_x;
    m->steps_y[m->oldest] = step_y;
    m->oldest = (m->oldest + 1) % 3;

    const uint32_t changed = ewa_laz_symbol(false, &c, &m->changed, 64, 0);
    if (changed & INTENSITY)
        now.intensity = ewa_laz_integer16(false, &c, &m->intensity, 0, last.intensity, 0);
    if (changed & FLAGS) now.flags = (uint8_t)ewa_laz_symbol(false, &c, &m->flags[last.flags], 256, 0);
    if (changed & CLASSIFICATION)
        now.classification =
            (uint8_t)ewa_laz_symbol(false, &c, &m->classifications[last.classification], 256, 0);
    if (changed & ANGLE) now.angle = ewa_laz_integer8(false, &c, &m->angle, width < 3, last.angle, 0);
    if (changed & USER) now.user = (uint8_t)ewa_laz_symbol(false, &c, &m->users[last.user], 256, 0);
    if (changed & SOURCE) now.source = ewa_laz_integer16(false, &c, &m->source, 0, last.source, 0);
    m->last = now;
    ewa_laz_point10_store(&now, record);
    *coder = c;
}

enum { MULTIPLES = 512 };

/// What GPSTIME11 of version 1 remembers.
typedef struct time_item {
    EWA_LAZ_MODEL(MULTIPLES) multiple;
    EWA_LAZ_MODEL(3) still;
    EWA_LAZ_INTEGER(32, 6) number;
    uint64_t time;
    int32_t step;
    uint32_t extreme_count;
} time_item;

static void start_times(time_item *m, uint64_t time) {
    m->time = time;
    m->step = 0;
    m->extreme_count = 0;
}

static uint64_t decode_time(ewa_laz_coder *coder, time_item *m) {
    enum { LARGEST = MULTIPLES - 3, ANY };
    ewa_laz_coder c = *coder;
    uint32_t width;
    if (m->step == 0) {
        const uint32_t event = ewa_laz_symbol(false, &c, &m->still, 3, 0);
        if (event == 1) {
            m->step = ewa_laz_integer32(false, &c, &m->number, 0, 0, 0, &width);
            m->time += (uint64_t)(int64_t)m->step;
        } else if (event == 2) {
            m->time = ewa_laz_bits64(false, &c, 0);
        }
    } else {
        const uint32_t multiple = ewa_laz_symbol(false, &c, &m->multiple, MULTIPLES, 0);
        if (multiple <= LARGEST) {
            const uint32_t context = multiple == 0   ? 2
                                     : multiple == 1 ? 1
                                     : multiple < 10 ? 3
                                     : multiple < 50 ? 4
                                                     : 5;
            const uint32_t prediction =
                multiple == 0 ? (uint32_t)(m->step / 4) : multiple * (uint32_t)m->step;
            const int32_t step = ewa_laz_integer32(false, &c, &m->number, context, prediction, 0, &width);
            m->time += (uint64_t)(int64_t)step;
            const bool extreme = (multiple == 0 || multiple == LARGEST) && ++m->extreme_count > 3;
            if (multiple == 1 || extreme) {
                m->step = step;
                m->extreme_count = 0;
            }
        } else if (multiple == ANY) {
            m->time = ewa_laz_bits64(false, &c, 0);
        }
    }
    *coder = c;
    return m->time;
}

/// What RGB12 of version 1 remembers.
typedef struct color_item {
    EWA_LAZ_MODEL(64) used;
    EWA_LAZ_INTEGER(8, 6) bytes;
    uint8_t last[6];
} color_item;

static void decode_color(ewa_laz_coder *coder, color_item *m, uint8_t *record) {
    ewa_laz_coder c = *coder;
    const uint32_t used = ewa_laz_symbol(false, &c, &m->used, 64, 0);
    for (uint32_t i = 0; i < 6; i++) {
        if (used & 1u << i) m->last[i] = ewa_laz_integer8(false, &c, &m->bytes, i, m->last[i], 0);
        record[i] = m->last[i];
    }
    *coder = c;
}

size_t ewa_laz_first_bytes(const ewa_laz_item *item) {
    switch (item->type) {
    case EWA_LAZ_POINT10:
        return sizeof(points_item);
    case EWA_LAZ_GPSTIME11:
        return sizeof(time_item);
    default:
        return sizeof(color_item);
    }
}

void ewa_laz_first_start(const ewa_laz_item *item, void *state, const uint8_t *record) {
    if (item->type == EWA_LAZ_POINT10)
        start_points(state, record);
    else if (item->type == EWA_LAZ_GPSTIME11)
        start_times(state, ewa_laz_load64(record));
    else
        memcpy(((color_item *)state)->last, record, sizeof((color_item *)state)->last);
}

void ewa_laz_first_decode(const ewa_laz_item *item, ewa_laz_coder *coder, void *state, uint8_t *record) {
    if (item->type == EWA_LAZ_POINT10)
        decode_point(coder, state, record);
    else if (item->type == EWA_LAZ_GPSTIME11)
        ewa_laz_store64(record, decode_time(coder, state));
    else
        decode_color(coder, state, record);
}
