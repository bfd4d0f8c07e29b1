// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Chunks of LAZ: plans, the memory of workers, and which kind of chunk it is; see laz.h.
#include "io/las/laz.h"

#include "io/las/laz_chunk.h"

#include <string.h>

enum { ALIGNMENT = 64 };

static bool item_is_known(const ewa_laz_item *item, bool *layered, bool *sized, uint32_t *size_bytes) {
    static const struct {
        uint16_t type, size_bytes; // 0: any
        uint16_t first_version, last_version;
        bool layered;
    } ITEMS[] = {
        {EWA_LAZ_BYTE, 0, 2, 2, false},          {EWA_LAZ_POINT10, 20, 1, 2, false},
        {EWA_LAZ_GPSTIME11, 8, 1, 2, false},     {EWA_LAZ_RGB12, 6, 1, 2, false},
        {EWA_LAZ_WAVEPACKET13, 29, 1, 2, false}, {EWA_LAZ_POINT14, 30, 3, 4, true},
        {EWA_LAZ_RGB14, 6, 3, 4, true},          {EWA_LAZ_RGBNIR14, 8, 3, 4, true},
        {EWA_LAZ_WAVEPACKET14, 29, 3, 4, true},  {EWA_LAZ_BYTE14, 0, 3, 4, true},
    };
    for (size_t i = 0; i < sizeof ITEMS / sizeof ITEMS[0]; i++) {
        if (ITEMS[i].type != item->type) continue;
        *layered = ITEMS[i].layered;
        *sized = ITEMS[i].size_bytes != 0;
        *size_bytes = ITEMS[i].size_bytes;
        return item->version >= ITEMS[i].first_version && item->version <= ITEMS[i].last_version;
    }
    return false;
}

const char *ewa_laz_plan_check(ewa_laz_plan *plan) {
    if (plan->item_count == 0 || plan->item_count > EWA_LAZ_MAX_ITEMS)
        return "it names no items, or more than there are kinds of";
    const uint16_t first = plan->items[0].type;
    if (first != EWA_LAZ_POINT10 && first != EWA_LAZ_POINT14)
        return "its first item is not the core of a point";
    plan->layered = first == EWA_LAZ_POINT14;
    plan->record_bytes = 0;
    for (uint32_t i = 0; i < plan->item_count; i++) {
        const ewa_laz_item *item = &plan->items[i];
        bool layered, sized;
        uint32_t size_bytes;
        if (!item_is_known(item, &layered, &sized, &size_bytes))
            return "it names an item of an unknown kind or version";
        if (layered != plan->layered) return "it mixes items of flat and of layered chunks";
        if (i > 0 && item->type == first) return "it names the core of a point twice";
        if (sized ? item->size_bytes != size_bytes
                  : item->size_bytes == 0 || item->size_bytes > EWA_LAZ_MAX_EXTRA_BYTES)
            return "it names an item of an impossible size";
        plan->record_bytes += item->size_bytes;
    }
    return plan->record_bytes > EWA_LAZ_MAX_RECORD_BYTES ? "its points are too large" : NULL;
}

static void add(ewa_laz_plan *plan, ewa_laz_item_type type, uint32_t size_bytes, uint16_t version) {
    plan->items[plan->item_count++] =
        (ewa_laz_item){.type = (uint16_t)type, .size_bytes = (uint16_t)size_bytes, .version = version};
    plan->record_bytes += size_bytes;
}

void ewa_laz_plan_make(uint8_t point_format, uint32_t record_bytes, ewa_laz_plan *plan) {
    enum { TIME = 1, RGB = 2, PACKET = 4, CORE14 = 8, INFRARED = 16 };
    static const uint8_t PARTS[11] = {
        0,
        TIME,
        RGB,
        TIME | RGB,
        TIME | PACKET,
        TIME | RGB | PACKET,
        CORE14,
        CORE14 | RGB,
        CORE14 | RGB | INFRARED,
        CORE14 | PACKET,
        CORE14 | RGB | INFRARED | PACKET,
    };
    *plan = (ewa_laz_plan){0};
    if (point_format >= sizeof PARTS) return;
    const uint8_t parts = PARTS[point_format];
    plan->layered = parts & CORE14;
    if (plan->layered) {
        add(plan, EWA_LAZ_POINT14, 30, 3);
        if (parts & INFRARED)
            add(plan, EWA_LAZ_RGBNIR14, 8, 3);
        else if (parts & RGB)
            add(plan, EWA_LAZ_RGB14, 6, 3);
        if (parts & PACKET) add(plan, EWA_LAZ_WAVEPACKET14, EWA_LAZ_PACKET_BYTES, 3);
    } else {
        add(plan, EWA_LAZ_POINT10, 20, 2);
        if (parts & TIME) add(plan, EWA_LAZ_GPSTIME11, 8, 2);
        if (parts & RGB) add(plan, EWA_LAZ_RGB12, 6, 2);
        if (parts & PACKET) add(plan, EWA_LAZ_WAVEPACKET13, EWA_LAZ_PACKET_BYTES, 1);
    }
    if (record_bytes > plan->record_bytes)
        add(plan, plan->layered ? EWA_LAZ_BYTE14 : EWA_LAZ_BYTE, record_bytes - plan->record_bytes,
            plan->layered ? 3 : 2);
}

static size_t aligned(size_t size_bytes) { return (size_bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT; }

void ewa_laz_memory_free(ewa_context *context, ewa_laz_memory **memory) {
    if (!*memory) return;
    for (uint32_t i = 0; i < (*memory)->layer_count; i++) ewa_buffer_free(context, &(*memory)->outputs[i]);
    ewa_release(context, *memory, (*memory)->size_bytes, 1);
    *memory = NULL;
}

static bool same_plan(const ewa_laz_plan *a, const ewa_laz_plan *b) {
    return a->item_count == b->item_count &&
           memcmp(a->items, b->items, a->item_count * sizeof a->items[0]) == 0;
}

/// Prepares the memory for a chunk: one block, in which items, layers and outputs lie one behind the other.
static ewa_status prepare(ewa_context *context, const ewa_laz_plan *plan, ewa_laz_memory **memory) {
    if (*memory && (!same_plan(&(*memory)->plan, plan) || (*memory)->generation == UINT32_MAX))
        ewa_laz_memory_free(context, memory);
    if (!*memory) {
        size_t size_bytes = aligned(sizeof **memory), offsets[EWA_LAZ_MAX_ITEMS];
        uint32_t layer_count = 0;
        for (uint32_t i = 0; i < plan->item_count; i++) {
            uint32_t more = 0;
            offsets[i] = size_bytes;
            size_bytes += aligned(plan->layered ? ewa_laz_layered_bytes(&plan->items[i], &more)
                                                : ewa_laz_flat_bytes(&plan->items[i]));
            layer_count += more;
        }
        const size_t layers = size_bytes, outputs = layers + aligned(layer_count * sizeof(ewa_laz_layer));
        size_bytes = outputs + layer_count * sizeof(ewa_buffer);
        uint8_t *block = ewa_allocate_zeroed(context, size_bytes, 1);
        if (!block) return EWA_ERROR_MEMORY;
        *memory = (ewa_laz_memory *)block;
        **memory = (ewa_laz_memory){
            .plan = *plan,
            .size_bytes = size_bytes,
            .layers = (ewa_laz_layer *)(block + layers),
            .outputs = (ewa_buffer *)(block + outputs),
            .layer_count = layer_count,
        };
        for (uint32_t i = 0; i < plan->item_count; i++) (*memory)->items[i] = block + offsets[i];
    }
    (*memory)->generation++;
    return EWA_OK;
}

ewa_status ewa_laz_decode(ewa_context *context, const ewa_laz_plan *plan, const uint8_t *bytes,
                          uint64_t size_bytes, uint64_t point_count, uint8_t *records,
                          ewa_laz_memory **memory, ewa_laz_result *result) {
    *result = (ewa_laz_result){0};
    if (point_count == 0) return EWA_OK;
    EWA_TRY(prepare(context, plan, memory));
    if (plan->layered)
        ewa_laz_layered_decode(*memory, bytes, size_bytes, point_count, records, result);
    else
        ewa_laz_flat_decode(*memory, bytes, size_bytes, point_count, records, result);
    return EWA_OK;
}

ewa_status ewa_laz_decode_cut(ewa_context *context, const ewa_laz_plan *plan, const uint8_t *bytes,
                              uint64_t size_bytes, uint64_t point_count, uint8_t *records,
                              ewa_laz_memory **memory, ewa_laz_result *result) {
    *result = (ewa_laz_result){0};
    if (point_count == 0) return EWA_OK;
    EWA_TRY(prepare(context, plan, memory));
    ewa_laz_layered_decode_cut(*memory, bytes, size_bytes, point_count, records, result);
    return EWA_OK;
}

ewa_status ewa_laz_encode(ewa_context *context, const ewa_laz_plan *plan, const uint8_t *records,
                          uint64_t point_count, ewa_buffer *to, size_t *at_bytes, ewa_laz_memory **memory) {
    if (point_count == 0) return EWA_OK;
    EWA_TRY(prepare(context, plan, memory));
    return plan->layered ? ewa_laz_layered_encode(context, *memory, records, point_count, to, at_bytes)
                         : ewa_laz_flat_encode(context, *memory, records, point_count, to, at_bytes);
}
