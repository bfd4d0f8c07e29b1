// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Records of binary PLY files. Records without lists all have one size and are decoded in parallel, straight
// from the file's bytes. Lists make records differ: those are walked one by one, and their scalars gathered
// to records of one size first.
#include "base/base.h"
#include "io/cloud/ply.h"
#include "io/reader.h"

#include <string.h>

enum {
    TASK_BYTES = 1 << 17, // file bytes per parallel task
    WAVE_TASKS = 1 << 6,  // tasks between two reports of progress
};

static ewa_status fail_truncated(const ewa_ply_source *source, const ewa_ply_element *element, uint64_t index,
                                 uint64_t at, uint64_t wanted) {
    char quote[EWA_QUOTE_BYTES];
    return ewa_fail(
        source->context, EWA_ERROR_FORMAT,
        "%s: the file ends in %s %llu of %llu: %llu bytes wanted from byte %llu on, %llu are there",
        source->name, ewa_quote(element->name, quote), (unsigned long long)(element->before_count + index),
        (unsigned long long)(element->before_count + element->count + element->after_count),
        (unsigned long long)wanted, (unsigned long long)at, (unsigned long long)(source->size_bytes - at));
}

/// Reads the length of a list as the number that `type` says; false when it is negative.
static bool read_count(const uint8_t *bytes, ewa_type type, bool swap, uint64_t *count) {
    const ewa_move move = {.from_type = type, .to_type = EWA_F64, .component_count = 1, .swap = swap};
    double value;
    ewa_move_numbers(&move, (uint8_t *)&value, 0, bytes, 0, 1);
    if (value < 0) return false;
    *count = (uint64_t)value;
    return true;
}

/// Appends the numbers of one list to those of the records before.
static ewa_status keep_list(const ewa_ply_source *source, ewa_type type, bool swap, const uint8_t *bytes,
                            uint64_t count, uint64_t index, ewa_ply_list *list) {
    ewa_status status = EWA_OK;
    const size_t number_bytes = ewa_type_bytes(type);
    uint8_t *to = ewa_ply_list_add(source, list, count, number_bytes, &status);
    if (!to) return status;
    const ewa_move move = {.from_type = type, .to_type = type, .component_count = 1, .swap = swap};
    ewa_move_numbers(&move, to, number_bytes, bytes, number_bytes, (size_t)count);
    list->first[index + 1] = list->count;
    return EWA_OK;
}

/// Steps over one record; its scalars go to `record` unless that is NULL, its lists to `lists` unless that
/// is.
static ewa_status walk_record(const ewa_ply_source *source, const ewa_ply_header *header,
                              const ewa_ply_element *element, uint64_t index, ewa_reader *reader,
                              uint8_t *record, ewa_ply_list *lists) {
    for (uint32_t i = 0; i < element->property_count; i++) {
        const ewa_ply_property *property = &header->properties[element->first_property + i];
        const uint64_t at = reader->at_bytes, number_bytes = ewa_type_bytes(property->type);
        uint64_t wanted = property->is_list ? ewa_type_bytes(property->count_type) : number_bytes;
        const uint8_t *bytes = ewa_reader_take(reader, wanted);
        if (!bytes) return fail_truncated(source, element, index, at, wanted);
        if (!property->is_list) {
            if (record) memcpy(record + property->offset_bytes, bytes, number_bytes);
            continue;
        }
        uint64_t count;
        if (!read_count(bytes, property->count_type, ewa_ply_is_swapped(header), &count)) {
            char element_quote[EWA_QUOTE_BYTES], quote[EWA_QUOTE_BYTES];
            return ewa_fail(source->context, EWA_ERROR_FORMAT,
                            "%s: byte %llu: list %s of %s %llu has a negative length", source->name,
                            (unsigned long long)at, ewa_quote(property->name, quote),
                            ewa_quote(element->name, element_quote), (unsigned long long)index);
        }
        wanted = count * number_bytes; // at most 2^32 * 8
        bytes = ewa_reader_take(reader, wanted);
        if (!bytes) return fail_truncated(source, element, index, reader->at_bytes, wanted);
        if (!lists) continue;
        EWA_TRY(keep_list(source, property->type, ewa_ply_is_swapped(header), bytes, count, index, lists++));
    }
    return EWA_OK;
}

ewa_status ewa_ply_binary_skip(const ewa_ply_source *source, const ewa_ply_header *header,
                               const ewa_ply_element *element, uint64_t *at) {
    if (element->list_count == 0) {
        *at += element->count * element->record_bytes;
        return EWA_OK;
    }
    ewa_reader reader = {.bytes = source->bytes, .size_bytes = source->size_bytes, .at_bytes = *at};
    for (uint64_t i = 0; i < element->count; i++) {
        EWA_TRY(walk_record(source, header, element, i, &reader, NULL, NULL));
    }
    *at = reader.at_bytes;
    return EWA_OK;
}

typedef struct decode_job {
    const ewa_ply_sink *sink;
    const uint8_t *records;
    uint32_t record_bytes;
    uint64_t first, end; // of this wave
    uint64_t task_records;
} decode_job;

static void decode_task(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const decode_job *job = data;
    const uint64_t block = ewa_ply_block_records(job->record_bytes);
    uint64_t at = job->first + index * job->task_records;
    const uint64_t end = at + job->task_records < job->end ? at + job->task_records : job->end;
    while (at < end) {
        const uint64_t count = end - at < block ? end - at : block;
        ewa_ply_sink_put(job->sink, at, job->records + at * job->record_bytes, job->record_bytes, count);
        at += count;
    }
}

static ewa_status read_plain(const ewa_ply_source *source, const ewa_ply_element *element,
                             const ewa_ply_sink *sink, uint64_t *at) {
    ewa_status status = EWA_OK;
    const uint64_t task_records = TASK_BYTES / element->record_bytes;
    decode_job job = {.sink = sink,
                      .records = source->bytes + *at,
                      .record_bytes = element->record_bytes,
                      .task_records = task_records};
    while (job.first < element->count && status == EWA_OK) {
        const uint64_t left = element->count - job.first, wave = WAVE_TASKS * task_records;
        const uint64_t count = left < wave ? left : wave;
        job.end = job.first + count;
        ewa_parallel(source->context, decode_task, &job,
                     (uint32_t)((count + task_records - 1) / task_records));
        job.first = job.end;
        const uint64_t whole = element->before_count + element->count + element->after_count;
        status =
            ewa_progress(source->context, "read", (double)(element->before_count + job.end) / (double)whole);
    }
    *at += element->count * element->record_bytes;
    return status;
}

/// Gathers the scalars of records with lists, block by block.
static ewa_status read_with_lists(const ewa_ply_source *source, const ewa_ply_header *header,
                                  const ewa_ply_element *element, const ewa_ply_sink *sink, uint64_t *at) {
    uint8_t records[EWA_PLY_BLOCK_BYTES];
    const uint64_t block = ewa_ply_block_records(element->record_bytes);
    ewa_reader reader = {.bytes = source->bytes, .size_bytes = source->size_bytes, .at_bytes = *at};
    for (uint64_t first = 0; first < element->count;) {
        const uint64_t count = element->count - first < block ? element->count - first : block;
        for (uint64_t i = 0; i < count; i++) {
            EWA_TRY(walk_record(source, header, element, first + i, &reader,
                                records + i * element->record_bytes, sink->lists));
        }
        ewa_ply_sink_put(sink, first, records, element->record_bytes, count);
        first += count;
    }
    *at = reader.at_bytes;
    return ewa_progress(source->context, "read", 1);
}

ewa_status ewa_ply_binary_read(const ewa_ply_source *source, const ewa_ply_header *header,
                               const ewa_ply_element *element, const ewa_ply_sink *sink, uint64_t *at) {
    return element->list_count ? read_with_lists(source, header, element, sink, at)
                               : read_plain(source, element, sink, at);
}
