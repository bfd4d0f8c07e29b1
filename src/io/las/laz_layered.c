// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Layered chunks, item by item; see laz_layered.h.
//
// Items of version 3 keep two slips of LASzip's, which are in every file with several channels: items behind the
// core take channel 0 for every point that does not switch, and where a channel comes again, its first prediction
// is the last value of the other channel, which is overwritten. Version 4 is without them.
#include "io/las/laz_layered.h"

#include "io/las/laz_chunk.h"

const uint8_t ewa_laz_return_map14[16][16] = {
    {0, 1, 2, 3, 4, 5, 3, 4, 4, 5, 5, 5, 5, 5, 5, 5}, {1, 0, 1, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3},
    {2, 1, 2, 4, 4, 4, 4, 4, 4, 4, 4, 3, 3, 3, 3, 3}, {3, 3, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
    {4, 3, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4}, {5, 3, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
    {3, 3, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4}, {4, 3, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4},
    {4, 3, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4}, {5, 3, 4, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4},
    {5, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4}, {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 4, 4, 4},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 4, 4}, {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 4},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5}, {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5},
};

enum {
    BLOCK_RECORDS = 64, // between two times that room is made
    LAYER_ROOM = 96,    // bytes that a record may take of a layer: 2 a symbol, 6 a number
    BYTE_ROOM = 2,
    AHEAD_ROOM = 8,
    COLOR_BYTES = 6,
};

/// The channels of an item behind the core.
typedef struct channels {
    bool started[EWA_LAZ_CHANNELS];
    uint32_t current; ///< whose models are in use
} channels;

/// What RGB14 and RGBNIR14 remember.
typedef struct color_item {
    channels channels;
    struct {
        ewa_laz_colors colors;
        EWA_LAZ_MODEL(4) infrared_used;
        ewa_laz_model256 infrared_bytes[2];
    } models[EWA_LAZ_CHANNELS];
    uint16_t last[EWA_LAZ_CHANNELS][4];
} color_item;

/// What WAVEPACKET14 remembers.
typedef struct packet_item {
    channels channels;
    ewa_laz_packets models[EWA_LAZ_CHANNELS];
    uint8_t last[EWA_LAZ_CHANNELS][EWA_LAZ_PACKET_BYTES];
} packet_item;

/// What BYTE14 remembers: behind it lie the models of all bytes, then the last bytes, channel by channel.
typedef struct byte_item {
    channels channels;
    alignas(16) ewa_laz_model256 models[];
} byte_item;

size_t ewa_laz_layered_bytes(const ewa_laz_item *item, uint32_t *layer_count) {
    switch (item->type) {
    case EWA_LAZ_POINT14:
        *layer_count = EWA_LAZ_POINT14_LAYERS;
        return sizeof(ewa_laz_points14);
    case EWA_LAZ_RGB14:
        *layer_count = 1;
        return sizeof(color_item);
    case EWA_LAZ_RGBNIR14:
        *layer_count = 2;
        return sizeof(color_item);
    case EWA_LAZ_WAVEPACKET14:
        *layer_count = 1;
        return sizeof(packet_item);
    default:
        *layer_count = item->size_bytes;
        return sizeof(byte_item) + (sizeof(ewa_laz_model256) + 1) * EWA_LAZ_CHANNELS * item->size_bytes;
    }
}

static uint8_t *last_bytes(byte_item *item, uint32_t count) {
    return (uint8_t *)(item->models + (size_t)EWA_LAZ_CHANNELS * count);
}

void ewa_laz_channel14_start(ewa_laz_channel14 *m, const ewa_laz_point14 *last) {
    m->last = *last;
    m->time_changed = false;
    memset(m->step_x, 0, sizeof m->step_x);
    memset(m->step_y, 0, sizeof m->step_y);
    for (int i = 0; i < 8; i++) {
        m->intensities[i] = last->intensity;
        m->heights[i] = last->z;
    }
    ewa_laz_times_start(&m->times, last->time);
}

void ewa_laz_points14_start(ewa_laz_points14 *m, const uint8_t *record) {
    const ewa_laz_point14 first = ewa_laz_point14_load(record);
    memset(m->started, 0, sizeof m->started);
    m->channel = first.channel;
    m->switched = false;
    m->started[first.channel] = true;
    ewa_laz_channel14_start(&m->channels[first.channel], &first);
}

static void channels_start(channels *c, uint32_t channel) {
    memset(c->started, 0, sizeof c->started);
    c->current = channel;
    c->started[channel] = true;
}

/// Lets all items begin with the first record.
static void start(ewa_laz_memory *memory, const uint8_t *record) {
    ewa_laz_points14 *core = memory->items[0];
    ewa_laz_points14_start(core, record);
    const uint32_t channel = core->channel;
    for (uint32_t i = 1; i < memory->plan.item_count; i++) {
        const ewa_laz_item *item = &memory->plan.items[i];
        record += memory->plan.items[i - 1].size_bytes;
        if (item->type == EWA_LAZ_BYTE14) {
            byte_item *bytes = memory->items[i];
            channels_start(&bytes->channels, channel);
            memcpy(last_bytes(bytes, item->size_bytes) + channel * item->size_bytes, record,
                   item->size_bytes);
        } else if (item->type == EWA_LAZ_WAVEPACKET14) {
            packet_item *packets = memory->items[i];
            channels_start(&packets->channels, channel);
            ewa_laz_packets_start(&packets->models[channel]);
            memcpy(packets->last[channel], record, EWA_LAZ_PACKET_BYTES);
        } else {
            color_item *colors = memory->items[i];
            channels_start(&colors->channels, channel);
            for (int k = 0; 2 * k < item->size_bytes; k++)
                colors->last[channel][k] = ewa_laz_load16(record + 2 * k);
        }
    }
}

/// Changes to a channel; gives the one whose last value predicts. `*fresh`: the channel's memory begins, with the
/// last value of channel `*from`.
EWA_LAZ_INLINE uint32_t choose_channel(channels *c, uint32_t channel, uint32_t version, bool *fresh,
                                       uint32_t *from) {
    *fresh = false;
    *from = c->current;
    if (EWA_LAZ_RARELY(channel != c->current)) {
        c->current = channel;
        *fresh = !c->started[channel];
        c->started[channel] = true;
        if (!*fresh && version == 3) return *from;
    }
    return channel;
}

EWA_LAZ_INLINE void code_color(bool encoding, ewa_laz_layer *layers, color_item *m, const ewa_laz_item *item,
                               uint32_t channel, uint8_t *record) {
    bool fresh;
    uint32_t from;
    const uint32_t slot = choose_channel(&m->channels, channel, item->version, &fresh, &from);
    if (fresh) memcpy(m->last[channel], m->last[from], sizeof m->last[channel]);
    uint16_t *last = m->last[slot], now[4] = {last[0], last[1], last[2], last[3]};
    for (int i = 0; encoding && 2 * i < item->size_bytes; i++) now[i] = ewa_laz_load16(record + 2 * i);
    if (encoding || layers[0].present) {
        ewa_laz_coder c = layers[0].coder;
        layers[0].changed |= ewa_laz_color(encoding, &c, &m->models[channel].colors, last, now) != 0;
        layers[0].coder = c;
    }
    if (item->type == EWA_LAZ_RGBNIR14 && (encoding || layers[1].present)) {
        ewa_laz_coder *c = &layers[1].coder;
        uint8_t lower = (uint8_t)now[3], upper = (uint8_t)(now[3] >> 8);
        const uint8_t last_lower = (uint8_t)last[3], last_upper = (uint8_t)(last[3] >> 8);
        uint32_t used = (uint32_t)(lower != last_lower) | (uint32_t)(upper != last_upper) << 1;
        used = ewa_laz_symbol(encoding, c, &m->models[channel].infrared_used, 4, used);
        layers[1].changed |= used != 0;
        if (used & 1)
            lower = ewa_laz_byte(encoding, c, &m->models[channel].infrared_bytes[0], last_lower, lower);
        if (used & 2)
            upper = ewa_laz_byte(encoding, c, &m->models[channel].infrared_bytes[1], last_upper, upper);
        now[3] = (uint16_t)(lower | upper << 8);
    }
    memcpy(last, now, sizeof now);
    for (int i = 0; !encoding && 2 * i < item->size_bytes; i++) ewa_laz_store16(record + 2 * i, now[i]);
}

EWA_LAZ_INLINE void code_packet(bool encoding, ewa_laz_layer *layer, packet_item *m, uint32_t version,
                                uint32_t channel, uint8_t *record) {
    bool fresh;
    uint32_t from;
    const uint32_t slot = choose_channel(&m->channels, channel, version, &fresh, &from);
    if (fresh) {
        memcpy(m->last[channel], m->last[from], EWA_LAZ_PACKET_BYTES);
        ewa_laz_packets_start(&m->models[channel]);
    }
    if (!encoding && !layer->present) {
        memcpy(record, m->last[slot], EWA_LAZ_PACKET_BYTES);
        return;
    }
    if (encoding) layer->changed |= memcmp(record, m->last[slot], EWA_LAZ_PACKET_BYTES) != 0;
    ewa_laz_coder c = layer->coder;
    ewa_laz_packet(encoding, &c, &m->models[channel], m->last[slot], record);
    layer->coder = c;
    memcpy(m->last[slot], record, EWA_LAZ_PACKET_BYTES);
}

EWA_LAZ_INLINE void code_bytes(bool encoding, ewa_laz_layer *layers, byte_item *m, const ewa_laz_item *item,
                               uint32_t channel, uint8_t *record) {
    bool fresh;
    uint32_t from;
    const uint32_t slot = choose_channel(&m->channels, channel, item->version, &fresh, &from);
    const uint32_t count = item->size_bytes;
    uint8_t *last = last_bytes(m, count);
    if (fresh) memcpy(last + channel * count, last + from * count, count);
    last += slot * count;
    ewa_laz_model256 *models = m->models + (size_t)channel * count;
    for (uint32_t i = 0; i < count; i++) {
        if (encoding) layers[i].changed |= record[i] != last[i];
        if (encoding || layers[i].present)
            last[i] = ewa_laz_byte(encoding, &layers[i].coder, &models[i], last[i], record[i]);
        if (!encoding) record[i] = last[i];
    }
}

EWA_LAZ_INLINE void code_record(bool encoding, ewa_laz_memory *memory, uint8_t *record) {
    ewa_laz_layer *layers = memory->layers;
    const ewa_laz_item *item = memory->plan.items;
    ewa_laz_points14 *core = memory->items[0];
    ewa_laz_point14_code(encoding, layers, core, record);
    const uint32_t channel = item->version == 3 && !core->switched ? 0 : core->channel;
    layers += EWA_LAZ_POINT14_LAYERS;
    record += EWA_LAZ_POINT14_BYTES;
    for (uint32_t i = 1; i < memory->plan.item_count; i++) {
        item++;
        if (item->type == EWA_LAZ_BYTE14) {
            code_bytes(encoding, layers, memory->items[i], item, channel, record);
            layers += item->size_bytes;
        } else if (item->type == EWA_LAZ_WAVEPACKET14) {
            code_packet(encoding, layers++, memory->items[i], item->version, channel, record);
        } else {
            code_color(encoding, layers, memory->items[i], item, channel, record);
            layers += item->type == EWA_LAZ_RGBNIR14 ? 2 : 1;
        }
        record += item->size_bytes;
    }
}

/// Decodes a record, once for whole chunks and those that are cut: all of it is much code.
static __attribute__((noinline)) void decode_record(ewa_laz_memory *memory, uint8_t *record) { code_record(false, memory, record); }

/// Finds the layers in what is behind the first record; returns what is wrong, or NULL.
static const char *open_layers(ewa_laz_memory *memory, const uint8_t *bytes, uint64_t size_bytes) {
    const uint64_t head_bytes = 4 + 4 * (uint64_t)memory->layer_count;
    if (size_bytes < head_bytes) return "it is too short for the sizes of its layers";
    const uint8_t *sizes = bytes + 4;
    bytes += head_bytes;
    size_bytes -= head_bytes;
    for (uint32_t i = 0; i < memory->layer_count; i++) {
        const uint32_t layer_bytes = ewa_laz_load32(sizes + 4 * (size_t)i);
        if (layer_bytes > size_bytes) return "its layers are larger than it is";
        memory->layers[i] = (ewa_laz_layer){.present = layer_bytes > 0};
        if (layer_bytes > 0)
            ewa_laz_decoder_start(&memory->layers[i].coder, bytes, layer_bytes, memory->generation);
        bytes += layer_bytes;
        size_bytes -= layer_bytes;
    }
    return size_bytes > 0 ? EWA_LAZ_LEFT_OVER : NULL;
}

static bool any_damaged(const ewa_laz_memory *memory) {
    bool damaged = false;
    for (uint32_t i = 0; i < memory->layer_count; i++) damaged |= memory->layers[i].coder.damaged;
    return damaged;
}

void ewa_laz_layered_decode(ewa_laz_memory *memory, const uint8_t *bytes, uint64_t size_bytes,
                            uint64_t point_count, uint8_t *records, ewa_laz_result *result) {
    const uint32_t stride = memory->plan.record_bytes;
    if (size_bytes < stride) {
        result->fault = EWA_LAZ_TOO_SHORT;
        return;
    }
    memcpy(records, bytes, stride);
    start(memory, records);
    result->point_count = 1;
    result->fault = open_layers(memory, bytes + stride, size_bytes - stride);
    if (result->fault) return;
    const uint32_t count = ewa_laz_load32(bytes + stride);
    if (point_count > 1 && !memory->layers[EWA_LAZ_LAYER_XY].present) {
        result->fault = "its layer of positions is empty";
        return;
    }
    while (result->point_count < point_count && result->point_count < count && !any_damaged(memory)) {
        decode_record(memory, records += stride);
        result->point_count++;
    }
    if (any_damaged(memory)) {
        result->fault = EWA_LAZ_DAMAGED;
        if (result->point_count > 1) result->point_count--;
        return;
    }
    if (count != point_count) {
        result->fault = "it holds another number of points than the file says";
        return;
    }
    for (uint32_t i = 0; i < memory->layer_count; i++)
        if (memory->layers[i].coder.at != memory->layers[i].coder.end) result->fault = EWA_LAZ_LEFT_OVER;
}

/// Finds the layers in what is there of a chunk: one that is cut is decoded as far as it goes, those behind it are
/// missing.
static void open_cut_layers(ewa_laz_memory *memory, const uint8_t *bytes, uint64_t size_bytes) {
    const uint64_t head_bytes = 4 + 4 * (uint64_t)memory->layer_count;
    const uint8_t *sizes = bytes + 4;
    bytes += head_bytes;
    size_bytes -= head_bytes;
    for (uint32_t i = 0; i < memory->layer_count; i++) {
        const uint32_t layer_bytes = ewa_laz_load32(sizes + 4 * (size_t)i);
        const uint64_t there_bytes = layer_bytes < size_bytes ? layer_bytes : size_bytes;
        const bool missing = layer_bytes > 0 && there_bytes == 0;
        memory->layers[i] =
            (ewa_laz_layer){.present = there_bytes > 0, .known_count = missing ? 1 : UINT64_MAX};
        if (there_bytes > 0)
            ewa_laz_decoder_start(&memory->layers[i].coder, bytes, there_bytes, memory->generation);
        bytes += there_bytes;
        size_bytes -= there_bytes;
    }
}

/// Sets `count` bytes of every record from the layer's first unknown one on to 0 where `mask` has bits.
static void clear_unknown(const ewa_laz_layer *layer, uint32_t stride, uint32_t at, uint32_t count, uint8_t mask,
                          ewa_laz_field field, uint8_t *records, ewa_laz_result *result) {
    if (layer->known_count >= result->point_count) return;
    const uint64_t poor_count = result->point_count - layer->known_count;
    if (poor_count > result->poor_count) result->poor_count = poor_count;
    result->lost_fields |= 1u << field;
    for (uint64_t p = layer->known_count; p < result->point_count; p++)
        for (uint32_t i = 0; i < count; i++) records[p * stride + at + i] &= (uint8_t)~mask;
}

/// Clears what is not known of the points.
static void clear_missing(const ewa_laz_memory *memory, uint8_t *records, ewa_laz_result *result) {
    enum { FLAG_BITS = 0xCF, ALL_BITS = 0xFF, CORE_FIELDS = EWA_LAZ_POINT14_LAYERS - EWA_LAZ_LAYER_CLASSIFICATION };
    // Where ewa_laz_point14_store() puts them; the channel, between the flags, belongs to the positions.
    static const uint8_t AT[CORE_FIELDS] = {16, 15, 12, 18, 17, 20, 22}, BYTES[CORE_FIELDS] = {1, 1, 2, 2, 1, 2, 8};
    const uint32_t stride = memory->plan.record_bytes;
    const ewa_laz_layer *layer = &memory->layers[EWA_LAZ_LAYER_CLASSIFICATION];
    for (uint32_t i = 0; i < CORE_FIELDS; i++, layer++) {
        const ewa_laz_field field = EWA_LAZ_FIELD_CLASSIFICATION + i;
        clear_unknown(layer, stride, AT[i], BYTES[i], field == EWA_LAZ_FIELD_FLAGS ? FLAG_BITS : ALL_BITS, field,
                      records, result);
    }
    uint32_t at = EWA_LAZ_POINT14_BYTES;
    for (uint32_t i = 1; i < memory->plan.item_count; i++) {
        const ewa_laz_item *item = &memory->plan.items[i];
        if (item->type == EWA_LAZ_BYTE14) {
            // A number of several bytes is one of several layers: all are known, or none.
            ewa_laz_layer shortest = {.known_count = UINT64_MAX};
            for (uint32_t k = 0; k < item->size_bytes; k++, layer++)
                if (layer->known_count < shortest.known_count) shortest.known_count = layer->known_count;
            clear_unknown(&shortest, stride, at, item->size_bytes, ALL_BITS, EWA_LAZ_FIELD_EXTRA, records, result);
        } else if (item->type == EWA_LAZ_WAVEPACKET14) {
            clear_unknown(layer++, stride, at, EWA_LAZ_PACKET_BYTES, ALL_BITS, EWA_LAZ_FIELD_WAVE, records, result);
        } else {
            clear_unknown(layer++, stride, at, COLOR_BYTES, ALL_BITS, EWA_LAZ_FIELD_COLOR, records, result);
            if (item->type == EWA_LAZ_RGBNIR14)
                clear_unknown(layer++, stride, at + COLOR_BYTES, 2, ALL_BITS, EWA_LAZ_FIELD_INFRARED, records,
                              result);
        }
        at += item->size_bytes;
    }
}

void ewa_laz_layered_decode_cut(ewa_laz_memory *memory, const uint8_t *bytes, uint64_t size_bytes,
                                uint64_t point_count, uint8_t *records, ewa_laz_result *result) {
    const uint32_t stride = memory->plan.record_bytes;
    if (size_bytes < stride) return;
    memcpy(records, bytes, stride);
    result->point_count = 1;
    if (size_bytes - stride < 4 + 4 * (uint64_t)memory->layer_count) return;
    start(memory, records);
    open_cut_layers(memory, bytes + stride, size_bytes - stride);
    ewa_laz_layer *layers = memory->layers;
    // Layers of positions without bytes are those of points that are all at one place; of a cut one some are there.
    const bool there = layers[EWA_LAZ_LAYER_XY].present && layers[EWA_LAZ_LAYER_Z].known_count > 1;
    uint64_t count = 1;
    for (; there && count < point_count; count++) {
        decode_record(memory, records + count * stride);
        if (layers[EWA_LAZ_LAYER_XY].coder.damaged || layers[EWA_LAZ_LAYER_Z].coder.damaged) break;
        for (uint32_t i = EWA_LAZ_LAYER_CLASSIFICATION; i < memory->layer_count; i++) {
            if (!layers[i].present || !layers[i].coder.damaged) continue;
            layers[i].present = false;
            layers[i].known_count = count;
        }
    }
    result->point_count = count;
    clear_missing(memory, records, result);
}

/// Makes room in all layers for a block of records and what ends them.
static ewa_status make_room(ewa_context *context, ewa_laz_memory *memory) {
    uint32_t i = 0;
    for (uint32_t k = 0; k < memory->plan.item_count; k++) {
        const ewa_laz_item *item = &memory->plan.items[k];
        const size_t record_room = item->type == EWA_LAZ_BYTE14 ? BYTE_ROOM : LAYER_ROOM;
        uint32_t layer_count;
        ewa_laz_layered_bytes(item, &layer_count);
        for (const uint32_t end = i + layer_count; i < end; i++) {
            ewa_buffer *output = &memory->outputs[i];
            uint8_t **to = &memory->layers[i].coder.to;
            const size_t at = output->data ? (size_t)(*to - (uint8_t *)output->data) : 0;
            EWA_TRY(ewa_laz_room(context, output, at,
                                 BLOCK_RECORDS * record_room + AHEAD_ROOM + EWA_LAZ_FINISH_BYTES));
            *to = (uint8_t *)output->data + at;
        }
    }
    return EWA_OK;
}

ewa_status ewa_laz_layered_encode(ewa_context *context, ewa_laz_memory *memory, const uint8_t *records,
                                  uint64_t point_count, ewa_buffer *to, size_t *at_bytes) {
    const uint32_t stride = memory->plan.record_bytes;
    const size_t head_bytes = stride + 4 + 4 * (size_t)memory->layer_count;
    const uint8_t *first = records;
    start(memory, first);
    for (uint32_t i = 0; i < memory->layer_count; i++) {
        memory->layers[i].changed = i <= EWA_LAZ_LAYER_Z; // these two are always written
        ewa_laz_encoder_start(&memory->layers[i].coder, memory->outputs[i].data, memory->generation);
    }
    EWA_TRY(make_room(context, memory));
    for (uint64_t i = 1; i < point_count; i++) {
        code_record(true, memory, (uint8_t *)(uintptr_t)(records += stride));
        if (i % BLOCK_RECORDS == 0) EWA_TRY(make_room(context, memory));
    }
    size_t chunk_bytes = head_bytes;
    for (uint32_t i = 0; i < memory->layer_count; i++) {
        ewa_laz_coder *c = &memory->layers[i].coder;
        ewa_laz_encoder_finish(c);
        if (memory->layers[i].changed) chunk_bytes += (size_t)(c->to - (uint8_t *)memory->outputs[i].data);
    }
    EWA_TRY(ewa_laz_room(context, to, *at_bytes, chunk_bytes));
    uint8_t *head = (uint8_t *)to->data + *at_bytes, *body = head + head_bytes;
    memcpy(head, first, stride);
    ewa_laz_store32(head + stride, (uint32_t)point_count);
    for (uint32_t i = 0; i < memory->layer_count; i++) {
        const uint8_t *data = memory->outputs[i].data;
        const size_t layer_bytes =
            memory->layers[i].changed ? (size_t)(memory->layers[i].coder.to - data) : 0;
        ewa_laz_store32(head + stride + 4 + 4 * (size_t)i, (uint32_t)layer_bytes);
        memcpy(body, data, layer_bytes);
        body += layer_bytes;
    }
    *at_bytes += chunk_bytes;
    return EWA_OK;
}
