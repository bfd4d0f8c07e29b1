// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What coding a chunk needs beside its records: the memory of a worker, and the two kinds of chunks.
#ifndef EWA_SRC_LAZ_CHUNK_H
#define EWA_SRC_LAZ_CHUNK_H

#include "io/las/laz.h"
#include "io/las/laz_layered.h"

/// A worker's memory: what the items of a plan remember, kept from chunk to chunk.
struct ewa_laz_memory {
    ewa_laz_plan plan;
    uint32_t generation; ///< of the chunk; models that were started for another one count as new
    size_t size_bytes;   ///< of this block, in which everything below lies
    void *items[EWA_LAZ_MAX_ITEMS];
    ewa_laz_layer *layers; ///< of layered chunks, in the file's order
    ewa_buffer *outputs;   ///< encoder: their bytes
    uint32_t layer_count;
};

/// Bytes of an item's memory in flat chunks.
size_t ewa_laz_flat_bytes(const ewa_laz_item *item);

/// The same in layered chunks; `*layer_count` is what the item adds to the layers.
size_t ewa_laz_layered_bytes(const ewa_laz_item *item, uint32_t *layer_count);

void ewa_laz_flat_decode(ewa_laz_memory *memory, const uint8_t *bytes, uint64_t size_bytes,
                         uint64_t point_count, uint8_t *records, ewa_laz_result *result);
ewa_status ewa_laz_flat_encode(ewa_context *context, ewa_laz_memory *memory, const uint8_t *records,
                               uint64_t point_count, ewa_buffer *to, size_t *at_bytes);

void ewa_laz_layered_decode(ewa_laz_memory *memory, const uint8_t *bytes, uint64_t size_bytes,
                            uint64_t point_count, uint8_t *records, ewa_laz_result *result);
void ewa_laz_layered_decode_cut(ewa_laz_memory *memory, const uint8_t *bytes, uint64_t size_bytes,
                                uint64_t point_count, uint8_t *records, ewa_laz_result *result);
ewa_status ewa_laz_layered_encode(ewa_context *context, ewa_laz_memory *memory, const uint8_t *records,
                                  uint64_t point_count, ewa_buffer *to, size_t *at_bytes);

/// Makes room for `more` bytes behind byte `at`. Errors: EWA_ERROR_MEMORY.
static inline ewa_status ewa_laz_room(ewa_context *context, ewa_buffer *to, size_t at, size_t more) {
    if (to->capacity_bytes >= more && to->capacity_bytes - more >= at) return EWA_OK;
    return at > SIZE_MAX - more ? ewa_fail(context, EWA_ERROR_MEMORY, "a chunk of LAZ is too large")
                                : ewa_buffer_grow(context, to, at, at + more, 1);
}

#define EWA_LAZ_TOO_SHORT "it is too short for its first point"
#define EWA_LAZ_DAMAGED   "its bytes end early or are no code"
#define EWA_LAZ_LEFT_OVER "bytes are left over behind its last point"

#endif
