// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Reads LAS and LAZ: tasks of a fixed number of records, or of a chunk, fill the sinks.
#include "base/base.h"
#include "io/las/las_check.h"
#include "io/las/las_open.h"

#include <string.h>

enum { TASK_POINTS = 1 << 14 };

typedef struct las_state {
    const ewa_cloud_source *source;
    ewa_las_file file;
    uint64_t next_point;  ///< of files without compression
    ewa_las_seen seen;
} las_state;

static bool probe(const char *name, const uint8_t *bytes, uint64_t size_bytes) {
    (void)name;
    return size_bytes >= 4 && memcmp(bytes, "LASF", 4) == 0;
}

static void close_las(void *data) {
    las_state *state = data;
    if (!state) return;
    ewa_context *context = state->source->context;
    if (state->seen.above_count)
        ewa_report(context, EWA_SEVERITY_WARNING,
                   "%s: %llu numbers of colours are above 255, which none was of those that were looked at; "
                   "they are read as 255",
                   state->source->name, (unsigned long long)state->seen.above_count);
    ewa_las_check(state->source, &state->file.header, &state->seen);
    ewa_las_file_close(&state->file);
    ewa_release(context, state, 1, sizeof *state);
}

static ewa_status open_las(const ewa_cloud_source *source, ewa_cloud *prototype, uint64_t *point_count,
                           void **state) {
    las_state *made = ewa_allocate_zeroed(source->context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->source = source;
    const ewa_status status = ewa_las_file_open(source, prototype, &made->file);
    if (status != EWA_OK) {
        close_las(made);
        return status;
    }
    *point_count = made->file.stream ? made->file.layout.point_count : made->file.point_count;
    *state = made;
    return EWA_OK;
}

/// The records of one call, unpacked by tasks.
typedef struct unpack_job {
    const las_state *state;
    const ewa_cloud_sink *sinks;
    const uint8_t *records;
    uint64_t count;
    ewa_las_seen *seen; ///< one per task
} unpack_job;

static void unpack_task(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const unpack_job *job = data;
    const ewa_las_table *table = &job->state->file.table;
    const uint64_t first = (uint64_t)index * TASK_POINTS, left = job->count - first;
    ewa_cloud_sink sinks[EWA_LAS_MAX_COLUMNS];
    for (uint32_t i = 0; i < table->column_count; i++) {
        sinks[i] = job->sinks[i];
        if (sinks[i].to) sinks[i].to += first * sinks[i].stride_bytes;
    }
    ewa_las_unpack_seen(table, job->records + first * table->record_bytes, left < TASK_POINTS ? left : TASK_POINTS, sinks,
                        &job->seen[index]);
}

static ewa_status read_plain(las_state *state, uint64_t maximum, const ewa_cloud_sink *sinks,
                             uint64_t *got_count) {
    ewa_context *context = state->source->context;
    const uint64_t max_at_once = (uint64_t)UINT32_MAX * TASK_POINTS;
    const uint64_t left = state->file.point_count - state->next_point;
    uint64_t count = left < maximum ? left : maximum;
    if (count > max_at_once) count = max_at_once;
    *got_count = count;
    if (count == 0) return EWA_OK;
    const uint64_t at = state->file.header.points_at + state->next_point * state->file.table.record_bytes;
    const uint32_t tasks = (uint32_t)((count + TASK_POINTS - 1) / TASK_POINTS);
    unpack_job job = {.state = state, .sinks = sinks, .records = state->source->bytes + at, .count = count};
    job.seen = ewa_allocate_zeroed(context, tasks, sizeof *job.seen);
    if (!job.seen) return EWA_ERROR_MEMORY;
    const ewa_status status = ewa_parallel_stoppable(context, "read", unpack_task, &job, tasks);
    for (uint32_t i = 0; i < tasks; i++) ewa_las_seen_add(&state->seen, &job.seen[i]);
    ewa_release(context, job.seen, tasks, sizeof *job.seen);
    state->next_point += count;
    ewa_cloud_passed(state->source, at + count * state->file.table.record_bytes);
    return status;
}

static ewa_status read_las(void *data, uint64_t maximum, const ewa_cloud_sink *sinks, uint64_t *got_count) {
    las_state *state = data;
    if (!state->file.stream) return read_plain(state, maximum, sinks, got_count);
    return ewa_laz_stream_read(state->file.stream, &state->file.table, maximum, sinks, got_count,
                               &state->seen);
}

const ewa_cloud_format ewa_format_las = {
    .format = EWA_MODEL_LAS, .probe = probe, .open = open_las, .read = read_las, .close = close_las};
