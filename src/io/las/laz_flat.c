// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Flat chunks, item by item; see laz_flat.h.
#include "io/las/laz_flat.h"

#include "io/las/laz_chunk.h"
#include "io/las/laz_first.h"

const uint8_t ewa_laz_return_map[8][8] = {
    {15, 14, 13, 12, 11, 10, 9, 8},  {14, 0, 1, 3, 6, 10, 10, 9},    {13, 1, 2, 4, 7, 11, 11, 10},
    {12, 3, 4, 5, 8, 12, 12, 11},    {11, 6, 7, 8, 9, 13, 13, 12},   {10, 10, 11, 12, 13, 14, 14, 13},
    {9, 10, 11, 12, 13, 14, 15, 14}, {8, 9, 10, 11, 12, 13, 14, 15},
};

enum {
    POINT_ROOM = 96, // bytes that an item may take: at most 2 a symbol, 6 a number, and what is stored ahead
    TIME_ROOM = 48,
    COLOR_ROOM = 24,
    PACKET_ROOM = 96,
    BYTE_ROOM = 2,
    AHEAD_ROOM = 8,
};

/// What RGB12 of version 2 remembers.
typedef struct color_item {
    ewa_laz_colors colors;
    uint16_t last[3];
} color_item;

/// What WAVEPACKET13 remembers.
typedef struct packet_item {
    ewa_laz_packets packets;
    uint8_t last[EWA_LAZ_PACKET_BYTES];
} packet_item;

/// Whether laz_first.h decodes the item. Waveform packets have been the same ever since.
static bool is_first(const ewa_laz_item *item) {
    return item->version == 1 && item->type != EWA_LAZ_WAVEPACKET13;
}

size_t ewa_laz_flat_bytes(const ewa_laz_item *item) {
    if (is_first(item)) return ewa_laz_first_bytes(item);
    switch (item->type) {
    case EWA_LAZ_POINT10:
        return sizeof(ewa_laz_points10);
    case EWA_LAZ_GPSTIME11:
        return sizeof(ewa_laz_times);
    case EWA_LAZ_RGB12:
        return sizeof(color_item);
    case EWA_LAZ_WAVEPACKET13:
        return sizeof(packet_item);
    default:
        return item->size_bytes * sizeof(ewa_laz_model256);
    }
}

static size_t room(const ewa_laz_item *item) {
    switch (item->type) {
    case EWA_LAZ_POINT10:
        return POINT_ROOM;
    case EWA_LAZ_GPSTIME11:
        return TIME_ROOM;
    case EWA_LAZ_RGB12:
        return COLOR_ROOM;
    case EWA_LAZ_WAVEPACKET13:
        return PACKET_ROOM;
    default:
        return (size_t)item->size_bytes * BYTE_ROOM;
    }
}

void ewa_laz_points10_start(ewa_laz_points10 *m, const uint8_t *record) {
    m->last = ewa_laz_point10_load(record);
    memset(m->step_x, 0, sizeof m->step_x);
    memset(m->step_y, 0, sizeof m->step_y);
    memset(m->intensities, 0, sizeof m->intensities);
    memset(m->heights, 0, sizeof m->heights);
}

/// Lets all items begin with the first record.
static void start(ewa_laz_memory *memory, const uint8_t *record) {
    for (uint32_t i = 0; i < memory->plan.item_count; i++) {
        const ewa_laz_item *item = &memory->plan.items[i];
        void *state = memory->items[i];
        if (is_first(item)) {
            ewa_laz_first_start(item, state, record);
        } else if (item->type == EWA_LAZ_POINT10) {
            ewa_laz_points10_start(state, record);
        } else if (item->type == EWA_LAZ_GPSTIME11) {
            ewa_laz_times_start(state, ewa_laz_load64(record));
        } else if (item->type == EWA_LAZ_RGB12) {
            for (int c = 0; c < 3; c++) ((color_item *)state)->last[c] = ewa_laz_load16(record + 2 * c);
        } else if (item->type == EWA_LAZ_WAVEPACKET13) {
            packet_item *packet = state;
            ewa_laz_packets_start(&packet->packets);
            memcpy(packet->last, record, sizeof packet->last);
        }
        record += item->size_bytes;
    }
}

EWA_LAZ_INLINE void code_time(bool encoding, ewa_laz_coder *coder, ewa_laz_times *times, uint8_t *record) {
    ewa_laz_coder c = *coder;
    const uint64_t time = ewa_laz_time(encoding, true, &c, times, encoding ? ewa_laz_load64(record) : 0);
    if (!encoding) ewa_laz_store64(record, time);
    *coder = c;
}

EWA_LAZ_INLINE void code_color(bool encoding, ewa_laz_coder *coder, color_item *item, uint8_t *record) {
    ewa_laz_coder c = *coder;
    uint16_t now[3] = {0};
    for (int i = 0; encoding && i < 3; i++) now[i] = ewa_laz_load16(record + 2 * i);
    ewa_laz_color(encoding, &c, &item->colors, item->last, now);
    for (int i = 0; i < 3; i++) {
        item->last[i] = now[i];
        if (!encoding) ewa_laz_store16(record + 2 * i, now[i]);
    }
    *coder = c;
}

EWA_LAZ_INLINE void code_packet(bool encoding, ewa_laz_coder *coder, packet_item *item, uint8_t *record) {
    ewa_laz_coder c = *coder;
    ewa_laz_packet(encoding, &c, &item->packets, item->last, record);
    memcpy(item->last, record, sizeof item->last);
    *coder = c;
}

/// `stride`: bytes from the record before, which is what bytes are predicted by.
EWA_LAZ_INLINE void code_bytes(bool encoding, ewa_laz_coder *coder, ewa_laz_model256 *models, uint32_t count,
                               uint32_t stride, uint8_t *record) {
    ewa_laz_coder c = *coder;
    for (uint32_t i = 0; i < count; i++) {
        const uint8_t byte = ewa_laz_byte(encoding, &c, &models[i], record[(ptrdiff_t)i - stride], record[i]);
        if (!encoding) record[i] = byte;
    }
    *coder = c;
}

EWA_LAZ_INLINE void code_record(bool encoding, ewa_laz_coder *coder, ewa_laz_memory *memory,
                                uint8_t *record) {
    const uint32_t stride = memory->plan.record_bytes;
    for (uint32_t i = 0; i < memory->plan.item_count; i++) {
        const ewa_laz_item item = memory->plan.items[i];
        void *state = memory->items[i];
        if (!encoding && is_first(&item))
            ewa_laz_first_decode(&item, coder, state, record);
        else if (item.type == EWA_LAZ_POINT10)
            ewa_laz_point10_code(encoding, coder, state, record);
        else if (item.type == EWA_LAZ_GPSTIME11)
            code_time(encoding, coder, state, record);
        else if (item.type == EWA_LAZ_RGB12)
            code_color(encoding, coder, state, record);
        else if (item.type == EWA_LAZ_WAVEPACKET13)
            code_packet(encoding, coder, state, record);
        else
            code_bytes(encoding, coder, state, item.size_bytes, stride, record);
        record += item.size_bytes;
    }
}

void ewa_laz_flat_decode(ewa_laz_memory *memory, const uint8_t *bytes, uint64_t size_bytes,
                         uint64_t point_count, uint8_t *records, ewa_laz_result *result) {
    const uint32_t stride = memory->plan.record_bytes;
    if (size_bytes < stride) {
        result->fault = EWA_LAZ_TOO_SHORT;
        return;
    }
    memcpy(records, bytes, stride);
    start(memory, records);
    ewa_laz_coder c;
    ewa_laz_decoder_start(&c, bytes + stride, size_bytes - stride, memory->generation);
    for (result->point_count = 1; result->point_count < point_count && !c.damaged; result->point_count++)
        code_record(false, &c, memory, records += stride);
    result->used_bytes = (uint64_t)(c.at - bytes);
    if (c.damaged) {
        result->fault = EWA_LAZ_DAMAGED;
        if (result->point_count > 1) result->point_count--;
    } else if (c.at != c.end) {
        result->fault = EWA_LAZ_LEFT_OVER;
    }
}

ewa_status ewa_laz_flat_encode(ewa_context *context, ewa_laz_memory *memory, const uint8_t *records,
                               uint64_t point_count, ewa_buffer *to, size_t *at_bytes) {
    const uint32_t stride = memory->plan.record_bytes;
    size_t record_room = AHEAD_ROOM;
    for (uint32_t i = 0; i < memory->plan.item_count; i++) record_room += room(&memory->plan.items[i]);
    EWA_TRY(ewa_laz_room(context, to, *at_bytes, stride + record_room));
    memcpy((uint8_t *)to->data + *at_bytes, records, stride);
    start(memory, records);
    size_t at = *at_bytes + stride;
    ewa_laz_coder c;
    ewa_laz_encoder_start(&c, (uint8_t *)to->data + at, memory->generation);
    for (uint64_t i = 1; i < point_count; i++) {
        at = (size_t)(c.to - (uint8_t *)to->data);
        EWA_TRY(ewa_laz_room(context, to, at, record_room));
        c.to = (uint8_t *)to->data + at;
        code_record(true, &c, memory, (uint8_t *)(uintptr_t)(records += stride));
    }
    at = (size_t)(c.to - (uint8_t *)to->data);
    EWA_TRY(ewa_laz_room(context, to, at, EWA_LAZ_FINISH_BYTES));
    c.to = (uint8_t *)to->data + at;
    ewa_laz_encoder_finish(&c);
    *at_bytes = (size_t)(c.to - (uint8_t *)to->data);
    return EWA_OK;
}
