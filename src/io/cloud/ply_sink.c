// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where decoded records go: the streams of a cloud, and lists that grow within the limits.
#include "base/base.h"
#include "io/cloud/ply.h"

#include <string.h>

enum { FIRST_NUMBERS = 64 };

void ewa_ply_sink_put(const ewa_ply_sink *sink, uint64_t first, const uint8_t *records, uint32_t record_bytes,
                      uint64_t count) {
    for (uint32_t i = 0; i < sink->stream_count; i++) {
        const ewa_ply_stream *stream = &sink->streams[i];
        ewa_move_numbers(&stream->move, stream->to + first * stream->to_stride_bytes, stream->to_stride_bytes,
                         records + stream->from_offset_bytes, record_bytes, (size_t)count);
    }
}

uint8_t *ewa_ply_list_add(const ewa_ply_source *source, ewa_ply_list *list, uint64_t more,
                          size_t number_bytes, ewa_status *status) {
    uint64_t wanted = 0;
    const uint64_t limit = ewa_context_limits(source->context)->max_memory_bytes / number_bytes;
    if (__builtin_add_overflow(list->count, more, &wanted) || wanted > limit) {
        *status =
            ewa_fail(source->context, EWA_ERROR_LIMIT, "%s: a list of %llu numbers is over max_memory_bytes",
                     source->name, (unsigned long long)wanted);
        return NULL;
    }
    if (wanted > list->capacity || !list->numbers) {
        uint64_t capacity = list->capacity ? 2 * list->capacity : FIRST_NUMBERS;
        if (capacity < wanted) capacity = wanted;
        uint8_t *numbers = ewa_allocate(source->context, capacity, number_bytes);
        if (!numbers) {
            *status = EWA_ERROR_MEMORY;
            return NULL;
        }
        if (list->count) memcpy(numbers, list->numbers, list->count * number_bytes);
        ewa_release(source->context, list->numbers, list->capacity, number_bytes);
        list->numbers = numbers;
        list->capacity = capacity;
    }
    uint8_t *added = list->numbers + list->count * number_bytes;
    list->count = wanted;
    return added;
}
