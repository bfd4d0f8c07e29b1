// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Layered chunks: the first record as it is, the number of points, then a stream of symbols ("layer") per kind
// of field. What is remembered is so for each of the scanner's four channels. This header holds the core of a
// record in both directions (see laz_coder.h).
//
// Based on: rapidlasso, "LAZ Specification 1.4", section "Point data format 6 to 10".
#ifndef EWA_SRC_LAZ_LAYERED_H
#define EWA_SRC_LAZ_LAYERED_H

#include "io/las/laz_fields.h"

enum { EWA_LAZ_POINT14_BYTES = 30, EWA_LAZ_CHANNELS = 4 };

/// The layers of the core, in the file's order.
enum {
    EWA_LAZ_LAYER_XY, ///< with channel and returns
    EWA_LAZ_LAYER_Z,
    EWA_LAZ_LAYER_CLASSIFICATION,
    EWA_LAZ_LAYER_FLAGS,
    EWA_LAZ_LAYER_INTENSITY,
    EWA_LAZ_LAYER_ANGLE,
    EWA_LAZ_LAYER_USER,
    EWA_LAZ_LAYER_SOURCE,
    EWA_LAZ_LAYER_TIME,
    EWA_LAZ_POINT14_LAYERS,
};

/// A layer. Where nothing changes in a chunk it has no bytes: then nothing is decoded.
typedef struct ewa_laz_layer {
    ewa_laz_coder coder;
    bool present;         ///< decoder: it has bytes
    bool changed;         ///< encoder: something changed
    uint64_t known_count; ///< decoder of cut chunks: its fields are known of as many points
} ewa_laz_layer;

/// The core of a record of the formats 6 to 10.
typedef struct ewa_laz_point14 {
    int32_t x, y, z;
    uint16_t intensity, angle, source;
    uint8_t number, returns; ///< of the return; of all
    uint8_t flags;           ///< classification flags (4 bits), scan direction, edge of the flight line
    uint8_t channel, classification, user;
    uint64_t time; ///< bits of a double
} ewa_laz_point14;

static inline ewa_laz_point14 ewa_laz_point14_load(const uint8_t *record) {
    return (ewa_laz_point14){
        .x = (int32_t)ewa_laz_load32(record),
        .y = (int32_t)ewa_laz_load32(record + 4),
        .z = (int32_t)ewa_laz_load32(record + 8),
        .intensity = ewa_laz_load16(record + 12),
        .number = record[14] & 15,
        .returns = record[14] >> 4,
        .flags = (uint8_t)((record[15] & 15) | (record[15] >> 2 & 0x30)),
        .channel = record[15] >> 4 & 3,
        .classification = record[16],
        .user = record[17],
        .angle = ewa_laz_load16(record + 18),
        .source = ewa_laz_load16(record + 20),
        .time = ewa_laz_load64(record + 22),
    };
}

static inline void ewa_laz_point14_store(const ewa_laz_point14 *point, uint8_t *record) {
    ewa_laz_store32(record, (uint32_t)point->x);
    ewa_laz_store32(record + 4, (uint32_t)point->y);
    ewa_laz_store32(record + 8, (uint32_t)point->z);
    ewa_laz_store16(record + 12, point->intensity);
    record[14] = (uint8_t)(point->number | point->returns << 4);
    record[15] = (uint8_t)((point->flags & 15) | point->channel << 4 | (point->flags & 0x30) << 2);
    record[16] = point->classification;
    record[17] = point->user;
    ewa_laz_store16(record + 18, point->angle);
    ewa_laz_store16(record + 20, point->source);
    ewa_laz_store64(record + 22, point->time);
}

/// What POINT14 remembers of a channel.
typedef struct ewa_laz_channel14 {
    EWA_LAZ_MODEL(128) changed[8];
    EWA_LAZ_MODEL(3) channel;
    EWA_LAZ_MODEL(13) number_same_time;
    EWA_LAZ_MODEL(16) returns[16], number[16];
    EWA_LAZ_INTEGER(32, 2) x;
    EWA_LAZ_INTEGER(32, 22) y;
    EWA_LAZ_INTEGER(32, 20) z;
    EWA_LAZ_INTEGER(16, 4) intensity;
    EWA_LAZ_INTEGER(16, 2) angle;
    EWA_LAZ_INTEGER(16, 1) source;
    ewa_laz_model256 classifications[64], users[64];
    EWA_LAZ_MODEL(64) flags[64];
    ewa_laz_times times;
    ewa_laz_point14 last;
    bool time_changed; ///< with the last point
    ewa_laz_median step_x[12], step_y[12];
    uint16_t intensities[8];
    int32_t heights[8];
} ewa_laz_channel14;

/// What POINT14 remembers.
typedef struct ewa_laz_points14 {
    ewa_laz_channel14 channels[EWA_LAZ_CHANNELS];
    bool started[EWA_LAZ_CHANNELS];
    uint32_t channel; ///< of the last point
    bool switched;    ///< the last point is of another channel than the one before
} ewa_laz_points14;

void ewa_laz_points14_start(ewa_laz_points14 *m, const uint8_t *record);

/// Begins a channel as if its last point had been `last`.
void ewa_laz_channel14_start(ewa_laz_channel14 *m, const ewa_laz_point14 *last);

/// Number of a pair (number of returns, return number), for all pairs, sensible or not.
extern const uint8_t ewa_laz_return_map14[16][16];

/// Whether doubles of these bits differ: those that are no numbers always do, as they do for LASzip.
static inline bool ewa_laz_times_differ(uint64_t a, uint64_t b) {
    const uint64_t infinite = 0x7FF0000000000000u, magnitude = a & INT64_MAX;
    return a != b || magnitude > infinite;
}

/// What changes from record to record.
enum {
    EWA_LAZ_NUMBER = 3, ///< how the number of the return does
    EWA_LAZ_RETURNS_CHANGED = 4,
    EWA_LAZ_ANGLE_CHANGED = 8,
    EWA_LAZ_TIME_CHANGED = 16,
    EWA_LAZ_SOURCE_CHANGED = 32,
    EWA_LAZ_CHANNEL_CHANGED = 64,
};

/// Codes channel and returns; gives the channel, and which of source, time and angle change.
EWA_LAZ_INLINE uint32_t ewa_laz_returns14(bool encoding, ewa_laz_coder *c, ewa_laz_points14 *m,
                                          ewa_laz_point14 *now) {
    ewa_laz_channel14 *old = &m->channels[m->channel];
    const ewa_laz_point14 *before = &old->last;
    const uint32_t kind = (before->number == 1 ? 1u : 0) | (before->number >= before->returns ? 2u : 0) |
                          (old->time_changed ? 4u : 0);
    uint32_t changed = 0;
    if (encoding) {
        const ewa_laz_point14 *last = m->started[now->channel] ? &m->channels[now->channel].last : before;
        const uint32_t step = (uint32_t)(now->number - last->number) & 15;
        changed = (step == 0    ? 0
                   : step == 1  ? 1
                   : step == 15 ? 2
                                : 3) |
                  (now->returns != last->returns ? EWA_LAZ_RETURNS_CHANGED : 0) | (now->angle != last->angle ? EWA_LAZ_ANGLE_CHANGED : 0) |
                  (ewa_laz_times_differ(now->time, last->time) ? EWA_LAZ_TIME_CHANGED : 0) |
                  (now->source != last->source ? EWA_LAZ_SOURCE_CHANGED : 0) | (now->channel != m->channel ? EWA_LAZ_CHANNEL_CHANGED : 0);
    }
    changed = ewa_laz_symbol(encoding, c, &old->changed[kind], 128, changed);
    m->switched = changed & EWA_LAZ_CHANNEL_CHANGED;
    if (m->switched) {
        const uint32_t by =
            ewa_laz_symbol(encoding, c, &old->channel, 3, (now->channel - m->channel - 1) & 3);
        m->channel = (m->channel + by + 1) % EWA_LAZ_CHANNELS;
        if (!m->started[m->channel]) {
            m->started[m->channel] = true;
            ewa_laz_channel14_start(&m->channels[m->channel], before);
        }
    }
    ewa_laz_channel14 *k = &m->channels[m->channel];
    const uint8_t last_number = k->last.number, last_returns = k->last.returns;
    if (!encoding) {
        *now = k->last;
        now->channel = (uint8_t)m->channel;
    }
    if (changed & EWA_LAZ_RETURNS_CHANGED)
        now->returns = (uint8_t)ewa_laz_symbol(encoding, c, &k->returns[last_returns], 16, now->returns);
    switch (changed & EWA_LAZ_NUMBER) {
    case 0:
        break;
    case 1:
        now->number = (last_number + 1) & 15;
        break;
    case 2:
        now->number = (last_number + 15) & 15;
        break;
    default:
        if (changed & EWA_LAZ_TIME_CHANGED)
            now->number = (uint8_t)ewa_laz_symbol(encoding, c, &k->number[last_number], 16, now->number);
        else
            now->number = (uint8_t)(last_number + 2 +
                                    ewa_laz_symbol(encoding, c, &k->number_same_time, 13,
                                                   (uint32_t)(now->number - last_number - 2) & 15)) &
                          15;
    }
    return changed;
}

/// What the models of a record's core are chosen by.
typedef struct ewa_laz_context14 {
    uint32_t changed;   ///< bits
    uint32_t map, level; ///< of steps, and of heights
    uint32_t kind;      ///< 2 a first return, 1 a last one
} ewa_laz_context14;

static inline ewa_laz_context14 ewa_laz_context14_of(uint32_t changed, const ewa_laz_point14 *now) {
    const bool time_changed = changed & EWA_LAZ_TIME_CHANGED;
    const uint32_t distance =
        (uint32_t)(now->returns > now->number ? now->returns - now->number : now->number - now->returns);
    return (ewa_laz_context14){
        .changed = changed,
        .map = (uint32_t)ewa_laz_return_map14[now->returns][now->number] << 1 | time_changed,
        .level = distance < 7 ? distance : 7,
        .kind = (now->number == 1 ? 2u : 0) | (now->number >= now->returns ? 1u : 0),
    };
}

/// Codes a record's place; `c` is that of the layer of x and y.
EWA_LAZ_INLINE void ewa_laz_place14(bool encoding, ewa_laz_coder *c, ewa_laz_layer *heights, ewa_laz_channel14 *k,
                                    const ewa_laz_context14 *of, ewa_laz_point14 *now) {
    const bool single = now->returns == 1;
    uint32_t width_x, width_y, width_z;
    const int32_t step_x = ewa_laz_integer32(encoding, c, &k->x, single, k->step_x[of->map].sorted[2],
                                             (uint32_t)now->x - (uint32_t)k->last.x, &width_x);
    const int32_t step_y =
        ewa_laz_integer32(encoding, c, &k->y, ewa_laz_width_context(single, width_x, 20),
                          k->step_y[of->map].sorted[2], (uint32_t)now->y - (uint32_t)k->last.y, &width_y);
    now->x = (int32_t)((uint32_t)k->last.x + (uint32_t)step_x);
    now->y = (int32_t)((uint32_t)k->last.y + (uint32_t)step_y);
    ewa_laz_median_add(&k->step_x[of->map], step_x);
    ewa_laz_median_add(&k->step_y[of->map], step_y);
    if (!encoding && !heights->present) return;
    ewa_laz_coder own = heights->coder;
    now->z = ewa_laz_integer32(encoding, &own, &k->z, ewa_laz_width_context(single, (width_x + width_y) / 2, 18),
                               k->heights[of->level], now->z, &width_z);
    k->heights[of->level] = now->z;
    heights->coder = own;
}

/// Codes what else a record's core has, each in a layer of its own.
EWA_LAZ_INLINE void ewa_laz_attributes14(bool encoding, ewa_laz_layer *layers, ewa_laz_channel14 *k,
                                         const ewa_laz_context14 *of, ewa_laz_point14 *now) {
    const bool time_changed = of->changed & EWA_LAZ_TIME_CHANGED;
    const ewa_laz_point14 last = k->last;
    ewa_laz_layer *layer = &layers[EWA_LAZ_LAYER_CLASSIFICATION];
    if (encoding || layer->present) {
        ewa_laz_coder c = layer->coder;
        if (encoding) layer->changed |= now->classification != last.classification;
        now->classification = (uint8_t)ewa_laz_symbol(
            encoding, &c, &k->classifications[(last.classification & 31) << 1 | (of->kind == 3)], 256,
            now->classification);
        layer->coder = c;
    }
    layer = &layers[EWA_LAZ_LAYER_FLAGS];
    if (encoding || layer->present) {
        ewa_laz_coder c = layer->coder;
        if (encoding) layer->changed |= now->flags != last.flags;
        now->flags = (uint8_t)ewa_laz_symbol(encoding, &c, &k->flags[last.flags], 64, now->flags);
        layer->coder = c;
    }
    layer = &layers[EWA_LAZ_LAYER_INTENSITY];
    if (encoding || layer->present) {
        ewa_laz_coder c = layer->coder;
        if (encoding) layer->changed |= now->intensity != last.intensity;
        uint16_t *intensity = &k->intensities[of->kind << 1 | time_changed];
        *intensity = ewa_laz_integer16(encoding, &c, &k->intensity, of->kind, *intensity, now->intensity);
        now->intensity = *intensity;
        layer->coder = c;
    }
    layer = &layers[EWA_LAZ_LAYER_ANGLE];
    if ((encoding || layer->present) && of->changed & EWA_LAZ_ANGLE_CHANGED) {
        ewa_laz_coder c = layer->coder;
        layer->changed = true;
        now->angle = ewa_laz_integer16(encoding, &c, &k->angle, time_changed, last.angle, now->angle);
        layer->coder = c;
    }
    layer = &layers[EWA_LAZ_LAYER_USER];
    if (encoding || layer->present) {
        ewa_laz_coder c = layer->coder;
        if (encoding) layer->changed |= now->user != last.user;
        now->user = (uint8_t)ewa_laz_symbol(encoding, &c, &k->users[last.user / 4], 256, now->user);
        layer->coder = c;
    }
    layer = &layers[EWA_LAZ_LAYER_SOURCE];
    if ((encoding || layer->present) && of->changed & EWA_LAZ_SOURCE_CHANGED) {
        ewa_laz_coder c = layer->coder;
        layer->changed = true;
        now->source = ewa_laz_integer16(encoding, &c, &k->source, 0, last.source, now->source);
        layer->coder = c;
    }
    layer = &layers[EWA_LAZ_LAYER_TIME];
    if ((encoding || layer->present) && time_changed) {
        ewa_laz_coder c = layer->coder;
        layer->changed = true;
        now->time = ewa_laz_time(encoding, false, &c, &k->times, now->time);
        layer->coder = c;
    }
}

/// Codes a record's core.
EWA_LAZ_INLINE void ewa_laz_point14_code(bool encoding, ewa_laz_layer *layers, ewa_laz_points14 *m,
                                         uint8_t *record) {
    ewa_laz_point14 now = {0};
    if (encoding) now = ewa_laz_point14_load(record);
    ewa_laz_coder c = layers[EWA_LAZ_LAYER_XY].coder;
    const uint32_t changed = ewa_laz_returns14(encoding, &c, m, &now);
    ewa_laz_channel14 *k = &m->channels[m->channel];
    const ewa_laz_context14 of = ewa_laz_context14_of(changed, &now);
    ewa_laz_place14(encoding, &c, &layers[EWA_LAZ_LAYER_Z], k, &of, &now);
    layers[EWA_LAZ_LAYER_XY].coder = c;
    ewa_laz_attributes14(encoding, layers, k, &of, &now);
    k->last = now;
    k->time_changed = changed & EWA_LAZ_TIME_CHANGED;
    if (!encoding) ewa_laz_point14_store(&now, record);
}

#endif
