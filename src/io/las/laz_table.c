// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The table of chunks: sizes, and numbers of points where they vary, each predicted by the one before.
//
// Based on: rapidlasso, "LAZ Specification 1.4", section "Chunk table".
#include "io/las/laz_chunk.h"

enum { HEAD_BYTES = 8, POINTS = 0, SIZES = 1, ENTRY_ROOM = 24 };

typedef EWA_LAZ_INTEGER(32, 2) numbers;

EWA_LAZ_INLINE void code_chunk(bool encoding, ewa_laz_coder *c, numbers *n, bool variable,
                               const ewa_laz_chunk *last, ewa_laz_chunk *chunk) {
    uint32_t width;
    if (variable)
        chunk->point_count = (uint32_t)ewa_laz_integer32(encoding, c, n, POINTS, last->point_count,
                                                         chunk->point_count, &width);
    chunk->size_bytes =
        (uint32_t)ewa_laz_integer32(encoding, c, n, SIZES, last->size_bytes, chunk->size_bytes, &width);
}

const char *ewa_laz_table_decode(const uint8_t *bytes, uint64_t size_bytes, uint32_t chunk_count,
                                 bool variable, ewa_laz_chunk *chunks) {
    if (chunk_count == 0) return NULL;
    numbers n = {0};
    ewa_laz_coder c;
    ewa_laz_decoder_start(&c, bytes, size_bytes, 1);
    ewa_laz_chunk last = {0};
    for (uint32_t i = 0; i < chunk_count && !c.damaged; i++) {
        code_chunk(false, &c, &n, variable, &last, &chunks[i]);
        last = chunks[i];
    }
    return c.damaged ? "it ends early or is no code" : NULL;
}

ewa_status ewa_laz_table_encode(ewa_context *context, const ewa_laz_chunk *chunks, uint32_t chunk_count,
                                bool variable, ewa_buffer *to, size_t *at_bytes) {
    EWA_TRY(ewa_laz_room(context, to, *at_bytes,
                         HEAD_BYTES + (size_t)chunk_count * ENTRY_ROOM + EWA_LAZ_FINISH_BYTES));
    uint8_t *head = (uint8_t *)to->data + *at_bytes;
    ewa_laz_store32(head, 0); // version
    ewa_laz_store32(head + 4, chunk_count);
    *at_bytes += HEAD_BYTES;
    if (chunk_count == 0) return EWA_OK;
    numbers n = {0};
    ewa_laz_coder c;
    ewa_laz_encoder_start(&c, head + HEAD_BYTES, 1);
    ewa_laz_chunk last = {0};
    for (uint32_t i = 0; i < chunk_count; i++) {
        ewa_laz_chunk chunk = chunks[i];
        code_chunk(true, &c, &n, variable, &last, &chunk);
        last = chunk;
    }
    ewa_laz_encoder_finish(&c);
    *at_bytes = (size_t)(c.to - (uint8_t *)to->data);
    return EWA_OK;
}
