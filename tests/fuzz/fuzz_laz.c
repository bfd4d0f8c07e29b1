// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target of LAZ: any items, any chunk, any table of chunks. What was decoded without a fault comes back when it
// is encoded, and the records before a fault are those that the whole chunk begins with.
//
// An input: number of items (1 byte), each type, size and version (1 byte each); number of points (2 bytes); then the
// chunk. Number of items 0: number of chunks (2 bytes), whether it varies (1 byte), then a table.
#include "ewa/ewa.h"
#include "fuzz.h"
#include "io/las/laz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void try_table(ewa_context *context, const uint8_t *bytes, size_t size_bytes) {
    if (size_bytes < 3) return;
    const uint32_t count = bytes[0] | (uint32_t)bytes[1] << 8;
    const bool variable = bytes[2] & 1;
    ewa_laz_chunk *chunks = calloc(count + 1, sizeof *chunks), *back = calloc(count + 1, sizeof *back);
    if (!ewa_laz_table_decode(bytes + 3, size_bytes - 3, count, variable, chunks)) {
        ewa_buffer to = {0};
        size_t at = 0;
        fuzz_require(ewa_laz_table_encode(context, chunks, count, variable, &to, &at) == EWA_OK, "a table");
        fuzz_require(!ewa_laz_table_decode((const uint8_t *)to.data + 8, at - 8, count, variable, back),
                     "a table that is read");
        fuzz_require(memcmp(chunks, back, count * sizeof *chunks) == 0, "the same table");
        ewa_buffer_free(context, &to);
    }
    free(chunks);
    free(back);
}

static void try_chunk(ewa_context *context, ewa_laz_plan plan, const uint8_t *bytes, size_t size_bytes,
                      uint32_t point_count) {
    uint8_t *records = calloc(point_count + 1, plan.record_bytes),
            *back = calloc(point_count + 1, plan.record_bytes);
    ewa_laz_memory *memory = NULL, *encoder = NULL;
    ewa_laz_result result;
    fuzz_require(ewa_laz_decode(context, &plan, bytes, size_bytes, point_count, records, &memory, &result) ==
                     EWA_OK,
                 "memory");
    fuzz_require(result.point_count <= point_count, "no more points than were asked for");
    fuzz_require(result.fault || result.point_count == point_count, "a fault, or all points");
    if (plan.layered) {
        // What is cut has no more points, and as far as the whole one is read, the same places.
        ewa_laz_result cut;
        const size_t there_bytes = size_bytes - (size_bytes ? point_count % size_bytes : 0);
        fuzz_require(ewa_laz_decode_cut(context, &plan, bytes, there_bytes, point_count, back, &memory, &cut) == EWA_OK,
                     "memory");
        fuzz_require(cut.point_count <= point_count && cut.poor_count <= cut.point_count, "counts of a cut chunk");
        for (uint64_t i = 0; i < cut.point_count && i < result.point_count && !result.fault; i++)
            fuzz_require(memcmp(records + i * plan.record_bytes, back + i * plan.record_bytes, 12) == 0,
                         "the same places");
    }
    bool first = false;
    for (uint32_t i = 0; i < plan.item_count; i++)
        first |= plan.items[i].version == 1 && plan.items[i].type != EWA_LAZ_WAVEPACKET13;
    if (!first && result.point_count > 0) {
        ewa_buffer to = {0};
        size_t at = 0;
        const uint64_t count = result.point_count;
        fuzz_require(ewa_laz_encode(context, &plan, records, count, &to, &at, &encoder) == EWA_OK, "a chunk");
        fuzz_require(ewa_laz_decode(context, &plan, to.data, at, count, back, &memory, &result) == EWA_OK,
                     "memory");
        fuzz_require(!result.fault && result.point_count == count, "what was encoded is decoded");
        fuzz_require(memcmp(records, back, count * plan.record_bytes) == 0, "the same records");
        ewa_buffer_free(context, &to);
    }
    ewa_laz_memory_free(context, &memory);
    ewa_laz_memory_free(context, &encoder);
    free(records);
    free(back);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    if (size_bytes < 1) return 0;
    ewa_context *context = fuzz_context(1, 0, NULL);
    ewa_laz_plan plan = {.item_count = bytes[0]};
    const size_t head_bytes = 1 + 3 * (size_t)plan.item_count + 2;
    if (plan.item_count == 0) {
        try_table(context, bytes + 1, size_bytes - 1);
    } else if (size_bytes >= head_bytes) {
        for (uint32_t i = 0; i < plan.item_count && i < EWA_LAZ_MAX_ITEMS; i++) {
            const uint8_t *item = bytes + 1 + 3 * (size_t)i;
            plan.items[i] = (ewa_laz_item){item[0], item[1], item[2]};
        }
        const uint32_t point_count = bytes[head_bytes - 2] | (uint32_t)bytes[head_bytes - 1] << 8;
        if (!ewa_laz_plan_check(&plan))
            try_chunk(context, plan, bytes + head_bytes, size_bytes - head_bytes, point_count);
    }
    ewa_context_destroy(&context);
    return 0;
}
