// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Parts of records that flat and layered chunks code alike: medians of steps, times, colours, waveform packets,
// in both directions (see laz_coder.h).
//
// Based on: M. Isenburg, "LASzip: lossless compression of LiDAR data" (2013); rapidlasso, "LAZ Specification
// 1.4".
#ifndef EWA_SRC_LAZ_FIELDS_H
#define EWA_SRC_LAZ_FIELDS_H

#include "io/las/laz_integer.h"

#include <string.h>

static inline uint16_t ewa_laz_load16(const uint8_t *p) { return (uint16_t)(p[0] | p[1] << 8); }

static inline uint32_t ewa_laz_load32(const uint8_t *p) {
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static inline uint64_t ewa_laz_load64(const uint8_t *p) {
    return ewa_laz_load32(p) | (uint64_t)ewa_laz_load32(p + 4) << 32;
}

static inline void ewa_laz_store16(uint8_t *p, uint32_t v) {
    p[0] = (uint8_t)v;
    p[1] = (uint8_t)(v >> 8);
}

static inline void ewa_laz_store32(uint8_t *p, uint32_t v) {
    p[0] = (uint8_t)v;
    p[1] = (uint8_t)(v >> 8);
    p[2] = (uint8_t)(v >> 16);
    p[3] = (uint8_t)(v >> 24);
}

static inline void ewa_laz_store64(uint8_t *p, uint64_t v) {
    ewa_laz_store32(p, (uint32_t)v);
    ewa_laz_store32(p + 4, (uint32_t)(v >> 32));
}

/// Five of the last numbers, in order. A new one replaces the largest or the smallest, whichever is not the
/// end at which numbers came last.
typedef struct ewa_laz_median {
    int32_t sorted[5];
    bool keeps_largest;
} ewa_laz_median;

static inline void ewa_laz_median_add(ewa_laz_median *median, int32_t number) {
    int32_t *a = median->sorted, kept[4];
    const bool keeps_largest = median->keeps_largest;
    median->keeps_largest = keeps_largest ? number > a[2] : number >= a[2];
    for (int i = 0; i < 4; i++) kept[i] = keeps_largest ? a[i + 1] : a[i];
    a[0] = number < kept[0] ? number : kept[0];
    for (int i = 1; i < 4; i++) {
        const int32_t below = number < kept[i] ? number : kept[i];
        a[i] = below > kept[i - 1] ? below : kept[i - 1];
    }
    a[4] = number > kept[3] ? number : kept[3];
}

/// Context of a coordinate: one return or several, and how wide the differences before it were.
static inline uint32_t ewa_laz_width_context(bool single, uint32_t width, uint32_t maximum) {
    return single + (width < maximum ? width & ~1u : maximum);
}

enum {
    EWA_LAZ_TIME_MULTI = 500,     ///< largest multiple of the last step that has a symbol of its own
    EWA_LAZ_TIME_MULTI_MIN = -10, ///< smallest
    EWA_LAZ_TIME_SEQUENCES = 4,
};

#define EWA_LAZ_TIME_ROOM 516 ///< symbols of steps

/// Times: up to four sequences of numbers, each predicted by multiples of its last step.
typedef struct ewa_laz_times {
    EWA_LAZ_MODEL(EWA_LAZ_TIME_ROOM) multiple;
    EWA_LAZ_MODEL(6) still;
    EWA_LAZ_INTEGER(32, 9) number;
    uint32_t last, next;
    uint64_t time[EWA_LAZ_TIME_SEQUENCES]; ///< bits of doubles
    int32_t step[EWA_LAZ_TIME_SEQUENCES];
    uint32_t extreme_count[EWA_LAZ_TIME_SEQUENCES];
} ewa_laz_times;

static inline void ewa_laz_times_start(ewa_laz_times *t, uint64_t time) {
    t->last = t->next = 0;
    memset(t->time, 0, sizeof t->time);
    memset(t->step, 0, sizeof t->step);
    memset(t->extreme_count, 0, sizeof t->extreme_count);
    t->time[0] = time;
}

/// What happens to a time, beside the symbols 0 to 510 for multiples of steps.
typedef enum ewa_laz_time_event {
    EWA_LAZ_TIME_SAME = -1, ///< flat chunks only
    EWA_LAZ_TIME_STEP,      ///< a step of 32 bits, after none
    EWA_LAZ_TIME_NEW,       ///< another sequence, that begins
    EWA_LAZ_TIME_SWITCH,    ///< another sequence, by one, two or three on
} ewa_laz_time_event;

static inline bool ewa_laz_fits32(uint64_t difference) {
    return (int64_t)difference == (int32_t)(uint32_t)difference;
}

/// The event that an encoder chooses.
static inline int ewa_laz_time_choose(const ewa_laz_times *t, bool flat, uint64_t time) {
    if (flat && time == t->time[t->last]) return EWA_LAZ_TIME_SAME;
    if (ewa_laz_fits32(time - t->time[t->last])) return EWA_LAZ_TIME_STEP;
    for (uint32_t i = 1; i < EWA_LAZ_TIME_SEQUENCES; i++)
        if (ewa_laz_fits32(time - t->time[(t->last + i) % EWA_LAZ_TIME_SEQUENCES]))
            return EWA_LAZ_TIME_SWITCH + (int)i - 1;
    return EWA_LAZ_TIME_NEW;
}

/// The symbol of a step: the nearest multiple of the last one. Float and double as LASzip has them.
static inline uint32_t ewa_laz_time_multiple(int32_t step, int32_t last_step) {
    const double quotient = (float)step / (float)last_step;
    if (quotient >= EWA_LAZ_TIME_MULTI) return EWA_LAZ_TIME_MULTI;
    if (quotient <= EWA_LAZ_TIME_MULTI_MIN) return EWA_LAZ_TIME_MULTI - EWA_LAZ_TIME_MULTI_MIN;
    const int multiple = (int)(quotient >= 0 ? quotient + 0.5 : quotient - 0.5);
    return (uint32_t)(multiple >= 0 ? multiple : EWA_LAZ_TIME_MULTI - multiple);
}

/// Codes the number of a step by symbol 0 to 510 of its multiple.
EWA_LAZ_INLINE void ewa_laz_time_step(bool encoding, ewa_laz_coder *c, ewa_laz_times *t, uint32_t symbol,
                                      uint64_t time) {
    const uint32_t i = t->last;
    const int32_t last_step = t->step[i];
    int32_t multiple = (int32_t)symbol;
    uint32_t context = 7, width;
    bool extreme = false;
    if (symbol == 0) {
        extreme = true;
    } else if (symbol == 1) {
        context = 1;
    } else if (symbol < EWA_LAZ_TIME_MULTI) {
        context = symbol < 10 ? 2 : 3;
    } else if (symbol == EWA_LAZ_TIME_MULTI) {
        context = 4;
        extreme = true;
    } else {
        multiple = EWA_LAZ_TIME_MULTI - (int32_t)symbol;
        extreme = multiple == EWA_LAZ_TIME_MULTI_MIN;
        context = extreme ? 6 : 5;
    }
    const int32_t step =
        ewa_laz_integer32(encoding, c, &t->number, context, (uint32_t)multiple * (uint32_t)last_step,
                          (uint32_t)(time - t->time[i]), &width);
    t->time[i] += (uint64_t)(int64_t)step;
    if (symbol == 1) t->extreme_count[i] = 0;
    if (extreme && ++t->extreme_count[i] > 3) {
        t->step[i] = step;
        t->extreme_count[i] = 0;
    }
}

/// Codes a time; `flat` (a constant): as chunks of items of version 2 have it.
EWA_LAZ_INLINE uint64_t ewa_laz_time(bool encoding, bool flat, ewa_laz_coder *c, ewa_laz_times *t,
                                     uint64_t time) {
    enum { FIRST_EVENT = EWA_LAZ_TIME_MULTI - EWA_LAZ_TIME_MULTI_MIN, SAME }; // symbols
    uint32_t width;
    for (int turn = 0; turn < EWA_LAZ_TIME_SEQUENCES; turn++) {
        const uint32_t i = t->last;
        int event = encoding ? ewa_laz_time_choose(t, flat, time) : 0;
        if (t->step[i] == 0) {
            event =
                (int)ewa_laz_symbol_of(encoding, c, &t->still.head, 5 + flat, 6, (uint32_t)(event + flat)) -
                flat;
            if (event == EWA_LAZ_TIME_STEP) {
                t->step[i] =
                    ewa_laz_integer32(encoding, c, &t->number, 0, 0, (uint32_t)(time - t->time[i]), &width);
                t->time[i] += (uint64_t)(int64_t)t->step[i];
                t->extreme_count[i] = 0;
            }
        } else {
            uint32_t symbol = event == EWA_LAZ_TIME_SAME ? SAME : (uint32_t)(FIRST_EVENT + flat + event);
            if (encoding && event == EWA_LAZ_TIME_STEP)
                symbol = ewa_laz_time_multiple((int32_t)(uint32_t)(time - t->time[i]), t->step[i]);
            symbol = ewa_laz_symbol_of(encoding, c, &t->multiple.head, 515 + flat, EWA_LAZ_TIME_ROOM, symbol);
            event = EWA_LAZ_TIME_STEP;
            if (symbol <= FIRST_EVENT)
                ewa_laz_time_step(encoding, c, t, symbol, time);
            else
                event = flat && symbol == SAME ? EWA_LAZ_TIME_SAME : (int)symbol - (FIRST_EVENT + flat);
        }
        if (event <= EWA_LAZ_TIME_STEP) return t->time[t->last];
        if (event == EWA_LAZ_TIME_NEW) {
            const uint32_t upper =
                (uint32_t)ewa_laz_integer32(encoding, c, &t->number, 8, t->time[i] >> 32, time >> 32, &width);
            const uint32_t lower = ewa_laz_bits(encoding, c, 32, (uint32_t)time);
            t->last = t->next = (t->next + 1) % EWA_LAZ_TIME_SEQUENCES;
            t->time[t->last] = (uint64_t)upper << 32 | lower;
            t->step[t->last] = 0;
            t->extreme_count[t->last] = 0;
            return t->time[t->last];
        }
        t->last = (t->last + (uint32_t)event - 1) % EWA_LAZ_TIME_SEQUENCES;
    }
    c->damaged = true; // encoders switch once
    return t->time[t->last];
}

/// Colours: which of the six bytes differ, and by how much; green and blue are predicted by red.
typedef struct ewa_laz_colors {
    EWA_LAZ_MODEL(128) used;
    ewa_laz_model256 bytes[6];
} ewa_laz_colors;

/// Codes a byte as its difference from a prediction, which wraps around.
EWA_LAZ_INLINE uint8_t ewa_laz_byte(bool encoding, ewa_laz_coder *c, ewa_laz_model256 *model,
                                    uint8_t prediction, uint8_t byte) {
    return (uint8_t)(prediction + ewa_laz_symbol(encoding, c, model, 256, (uint8_t)(byte - prediction)));
}

static inline uint8_t ewa_laz_clamp8(int number) {
    return (uint8_t)(number < 0 ? 0 : number > 255 ? 255 : number);
}

enum { EWA_LAZ_COLORED = 1 << 6 }; ///< of the symbol of a colour: it is not grey

/// Codes a colour after the one before it; returns 0 where nothing changes.
EWA_LAZ_INLINE uint32_t ewa_laz_color(bool encoding, ewa_laz_coder *c, ewa_laz_colors *m,
                                      const uint16_t last[3], uint16_t now[3]) {
    uint32_t used = 0;
    uint8_t was[6], is[6]; // lower and upper byte of red, green, blue
    for (int i = 0; i < 3; i++) {
        was[2 * i] = (uint8_t)last[i];
        was[2 * i + 1] = (uint8_t)(last[i] >> 8);
        is[2 * i] = encoding ? (uint8_t)now[i] : was[2 * i];
        is[2 * i + 1] = encoding ? (uint8_t)(now[i] >> 8) : was[2 * i + 1];
    }
    if (encoding) {
        for (int i = 0; i < 6; i++) used |= (uint32_t)(was[i] != is[i]) << i;
        if (now[0] != now[1] || now[0] != now[2]) used |= EWA_LAZ_COLORED;
    }
    used = ewa_laz_symbol(encoding, c, &m->used, 128, used);
    for (int i = 0; i < 2; i++)
        if (used & 1u << i) is[i] = ewa_laz_byte(encoding, c, &m->bytes[i], was[i], is[i]);
    if (used & EWA_LAZ_COLORED) {
        for (int i = 0; i < 2; i++) { // the lower bytes, then the upper ones
            const int red = is[i] - was[i], green = 2 + i, blue = 4 + i;
            if (used & 1u << green)
                is[green] =
                    ewa_laz_byte(encoding, c, &m->bytes[green], ewa_laz_clamp8(red + was[green]), is[green]);
            if (used & 1u << blue)
                is[blue] =
                    ewa_laz_byte(encoding, c, &m->bytes[blue],
                                 ewa_laz_clamp8((red + is[green] - was[green]) / 2 + was[blue]), is[blue]);
        }
    } else {
        is[2] = is[4] = is[0];
        is[3] = is[5] = is[1];
    }
    for (int i = 0; i < 3; i++) now[i] = (uint16_t)(is[2 * i] | is[2 * i + 1] << 8);
    return used;
}

enum { EWA_LAZ_PACKET_BYTES = 29 };

/// Waveform packets: descriptor, where the waveform lies, how large it is, and a place and a direction on it.
typedef struct ewa_laz_packets {
    ewa_laz_model256 descriptor;
    EWA_LAZ_MODEL(4) offset_kinds[4];
    EWA_LAZ_INTEGER(32, 1) offset, size, place;
    EWA_LAZ_INTEGER(32, 3) direction;
    int32_t last_offset_step;
    uint32_t last_offset_kind;
} ewa_laz_packets;

static inline void ewa_laz_packets_start(ewa_laz_packets *m) {
    m->last_offset_step = 0, m->last_offset_kind = 0;
}

/// Codes a packet after the one before it: 29 bytes each.
EWA_LAZ_INLINE void ewa_laz_packet(bool encoding, ewa_laz_coder *c, ewa_laz_packets *m, const uint8_t *last,
                                   uint8_t *now) {
    enum { SAME, BEHIND, STEP, ANYWHERE };
    now[0] = (uint8_t)ewa_laz_symbol(encoding, c, &m->descriptor, 256, now[0]);
    const uint64_t last_offset = ewa_laz_load64(last + 1);
    const uint32_t last_size = ewa_laz_load32(last + 9);
    uint64_t offset = encoding ? ewa_laz_load64(now + 1) : last_offset;
    const uint64_t step = offset - last_offset;
    uint32_t kind = step == 0               ? SAME
                    : !ewa_laz_fits32(step) ? ANYWHERE
                    : step == last_size     ? BEHIND
                                            : STEP,
             width;
    kind = ewa_laz_symbol(encoding, c, &m->offset_kinds[m->last_offset_kind], 4, kind);
    m->last_offset_kind = kind;
    if (kind == BEHIND) {
        offset = last_offset + last_size;
    } else if (kind == STEP) {
        m->last_offset_step =
            ewa_laz_integer32(encoding, c, &m->offset, 0, m->last_offset_step, (uint32_t)step, &width);
        offset = last_offset + (uint64_t)(int64_t)m->last_offset_step;
    } else if (kind == ANYWHERE) {
        offset = ewa_laz_bits64(encoding, c, offset);
    }
    ewa_laz_store64(now + 1, offset);
    ewa_laz_store32(now + 9, (uint32_t)ewa_laz_integer32(encoding, c, &m->size, 0, last_size,
                                                         ewa_laz_load32(now + 9), &width));
    ewa_laz_store32(now + 13,
                    (uint32_t)ewa_laz_integer32(encoding, c, &m->place, 0, ewa_laz_load32(last + 13),
                                                ewa_laz_load32(now + 13), &width));
    for (int i = 0; i < 3; i++)
        ewa_laz_store32(now + 17 + 4 * i,
                        (uint32_t)ewa_laz_integer32(encoding, c, &m->direction, i,
                                                    ewa_laz_load32(last + 17 + 4 * i),
                                                    ewa_laz_load32(now + 17 + 4 * i), &width));
}

#endif
