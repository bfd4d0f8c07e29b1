// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Writes LAS and LAZ: points are packed into a wave of records by all workers, waves go to the file as they
// are or as chunks that all workers compress; counts and bounds are patched into the header at the end.
#include "io/las/las_write.h"
#include "base/allocating.h"
#include "cloud/cloud.h"
#include "io/file.h"
#include "io/las/laz_chunks.h"

#include <string.h>

enum { TASK_POINTS = 1 << 12, WAVE_TASKS_PER_WORKER = 4, WAVE_CHUNKS_PER_WORKER = 2 };

typedef struct las_writer {
    const ewa_cloud_target *target;
    ewa_las_plan plan;
    bool begun; ///< the header is written
    bool dry;   ///< points are summed up, none are written
    uint32_t worker_count, vlr_count;
    uint64_t points_at; ///< byte of the first point
    uint64_t at_bytes;  ///< of the file
    uint64_t point_count, left_out_count;
    ewa_las_sums sums;
    uint8_t *wave; ///< records
    uint64_t wave_points, wave_filled, wave_bytes;
    ewa_las_sums *task_sums;
    uint64_t task_capacity;
    ewa_laz_plan laz;
    uint32_t chunk_points, wave_chunks;
    ewa_buffer *chunk_buffers; ///< one per chunk of a wave
    size_t *chunk_sizes;
    ewa_status *chunk_statuses;
    ewa_laz_memory **memories; ///< one per worker
    ewa_buffer chunks;         ///< ewa_laz_chunk, all of the file
    uint64_t chunk_count;
} las_writer;

static void close_writer(void *data) {
    las_writer *w = data;
    if (!w) return;
    ewa_context *context = w->target->context;
    for (uint32_t i = 0; i < w->wave_chunks && w->chunk_buffers; i++)
        ewa_buffer_free(context, &w->chunk_buffers[i]);
    for (uint32_t i = 0; i < w->worker_count && w->memories; i++)
        ewa_laz_memory_free(context, &w->memories[i]);
    ewa_release(context, w->chunk_buffers, w->wave_chunks, sizeof *w->chunk_buffers);
    ewa_release(context, w->chunk_sizes, w->wave_chunks, sizeof *w->chunk_sizes);
    ewa_release(context, w->chunk_statuses, w->wave_chunks, sizeof *w->chunk_statuses);
    ewa_release(context, w->memories, w->worker_count, sizeof *w->memories);
    ewa_release(context, w->task_sums, w->task_capacity, sizeof *w->task_sums);
    ewa_release(context, w->wave, w->wave_bytes, 1);
    ewa_buffer_free(context, &w->chunks);
    ewa_las_plan_free(context, &w->plan);
    ewa_release(context, w, 1, sizeof *w);
}

static ewa_status open_writer(const ewa_cloud_target *target, void **state) {
    las_writer *made = ewa_allocate_zeroed(target->context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->target = target;
    made->worker_count = ewa_context_worker_count(target->context);
    made->sums = EWA_LAS_NO_SUMS;
    *state = made;
    return EWA_OK;
}

static ewa_status put_bytes(las_writer *w, const void *bytes, size_t size_bytes) {
    w->at_bytes += size_bytes;
    return ewa_writer_put(w->target->writer, bytes, size_bytes);
}

/// Makes the public header; returns its size.
static uint16_t make_header(const las_writer *w, uint8_t head[EWA_LAS_HEAD_14_BYTES]) {
    const ewa_las_head said = {.points_at = w->points_at,
                               .point_count = w->point_count,
                               .vlr_count = w->vlr_count,
                               .sums = &w->sums};
    return ewa_las_head_make(&w->plan, w->target->prototype, &said, head);
}

/// Makes room for a wave and, compressed, for what its chunks become.
static ewa_status make_waves(las_writer *w) {
    ewa_context *context = w->target->context;
    const uint64_t known = w->target->point_count;
    w->wave_points = (uint64_t)WAVE_TASKS_PER_WORKER * w->worker_count * TASK_POINTS;
    if (w->plan.compressed) {
        w->chunk_points = w->target->options->chunk_points;
        w->wave_chunks = WAVE_CHUNKS_PER_WORKER * w->worker_count;
        w->wave_points = (uint64_t)w->wave_chunks * w->chunk_points;
        w->chunk_buffers = ewa_allocate_zeroed(context, w->wave_chunks, sizeof *w->chunk_buffers);
        w->chunk_sizes = ewa_allocate_zeroed(context, w->wave_chunks, sizeof *w->chunk_sizes);
        w->chunk_statuses = ewa_allocate_zeroed(context, w->wave_chunks, sizeof *w->chunk_statuses);
        w->memories = ewa_allocate_zeroed(context, w->worker_count, sizeof *w->memories);
        if (!w->chunk_buffers || !w->chunk_sizes || !w->chunk_statuses || !w->memories)
            return EWA_ERROR_MEMORY;
        ewa_laz_plan_make(w->plan.point_format, w->plan.table.record_bytes, &w->laz);
    }
    if (w->wave_points > known) w->wave_points = known ? known : 1;
    w->wave_bytes = w->wave_points * w->plan.table.record_bytes;
    w->wave = ewa_allocate(context, w->wave_bytes, 1);
    w->task_capacity = (w->wave_points + TASK_POINTS - 1) / TASK_POINTS;
    w->task_sums = ewa_allocate(context, w->task_capacity, sizeof *w->task_sums);
    return w->wave && w->task_sums ? EWA_OK : EWA_ERROR_MEMORY;
}

/// Writes all that comes before the points. The header holds what the sums hold now.
static ewa_status write_head(las_writer *w, const ewa_buffer *records, size_t records_bytes) {
    uint8_t head[EWA_LAS_HEAD_14_BYTES];
    const uint16_t head_bytes = make_header(w, head);
    ewa_status status = put_bytes(w, head, head_bytes);
    if (status == EWA_OK) status = put_bytes(w, records->data, records_bytes);
    uint8_t table_at[8];
    ewa_las_put_u64(table_at, UINT64_MAX); // at the end of the file, unless it is patched
    if (status == EWA_OK && w->plan.compressed) status = put_bytes(w, table_at, sizeof table_at);
    return status;
}

static void encode_chunk(void *data, uint32_t index, uint32_t worker) {
    las_writer *w = data;
    const uint64_t first = (uint64_t)index * w->chunk_points, left = w->wave_filled - first;
    w->chunk_sizes[index] = 0;
    w->chunk_statuses[index] =
        ewa_laz_encode(w->target->context, &w->laz, w->wave + first * w->plan.table.record_bytes,
                       left < w->chunk_points ? left : w->chunk_points, &w->chunk_buffers[index],
                       &w->chunk_sizes[index], &w->memories[worker]);
}

static ewa_status flush_chunks(las_writer *w) {
    ewa_context *context = w->target->context;
    const uint32_t count = (uint32_t)((w->wave_filled + w->chunk_points - 1) / w->chunk_points);
    EWA_TRY(ewa_parallel_allocating_stoppable(context, "write", encode_chunk, w, count));
    EWA_TRY(ewa_buffer_grow(context, &w->chunks, (size_t)w->chunk_count, (size_t)w->chunk_count + count,
                            sizeof(ewa_laz_chunk)));
    for (uint32_t i = 0; i < count; i++) {
        const uint64_t left = w->wave_filled - (uint64_t)i * w->chunk_points;
        EWA_TRY(w->chunk_statuses[i]);
        ((ewa_laz_chunk *)w->chunks.data)[w->chunk_count++] =
            (ewa_laz_chunk){left < w->chunk_points ? left : w->chunk_points, w->chunk_sizes[i]};
        EWA_TRY(put_bytes(w, w->chunk_buffers[i].data, w->chunk_sizes[i]));
    }
    return EWA_OK;
}

static ewa_status flush(las_writer *w) {
    if (w->wave_filled == 0) return EWA_OK;
    ewa_status status = EWA_OK;
    if (!w->dry)
        status = w->plan.compressed
                     ? flush_chunks(w)
                     : put_bytes(w, w->wave, (size_t)(w->wave_filled * w->plan.table.record_bytes));
    w->wave_filled = 0;
    return status;
}

/// Points of a piece that are packed behind what is in the wave.
typedef struct pack_job {
    las_writer *writer;
    const ewa_cloud *piece;
    uint64_t first, count;
} pack_job;

static void pack_task(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const pack_job *job = data;
    las_writer *w = job->writer;
    const uint64_t first = (uint64_t)index * TASK_POINTS, left = job->count - first;
    w->task_sums[index] = EWA_LAS_NO_SUMS;
    ewa_las_pack(&w->plan, job->piece, job->first + first, left < TASK_POINTS ? left : TASK_POINTS,
                 w->wave + (w->wave_filled + first) * w->plan.table.record_bytes, &w->task_sums[index]);
}

static ewa_status put_finite(las_writer *w, const ewa_cloud *piece) {
    const uint64_t count = ewa_cloud_point_count(piece);
    for (uint64_t first = 0; first < count;) {
        const uint64_t left = count - first, room = w->wave_points - w->wave_filled;
        const pack_job job = {
            .writer = w, .piece = piece, .first = first, .count = left < room ? left : room};
        const uint32_t tasks = (uint32_t)((job.count + TASK_POINTS - 1) / TASK_POINTS);
        EWA_TRY(ewa_parallel_stoppable(w->target->context, "write", pack_task, (void *)&job, tasks));
        for (uint32_t i = 0; i < tasks; i++) ewa_las_sums_add(&w->sums, &w->task_sums[i]);
        w->wave_filled += job.count;
        w->point_count += job.count;
        first += job.count;
        if (w->wave_filled == w->wave_points) EWA_TRY(flush(w));
        // What is in the wave of a dry run is packed again.
        if (w->dry && first == count) EWA_TRY(flush(w));
    }
    return EWA_OK;
}

/// Makes the piece without the points whose coordinates are not finite; NULL: all are.
static ewa_status drop_unplaced(las_writer *w, const ewa_cloud *piece, uint64_t finite_count,
                                ewa_cloud **finite) {
    const uint64_t count = ewa_cloud_point_count(piece);
    *finite = NULL;
    if (finite_count == count) return EWA_OK;
    uint64_t *indices = ewa_allocate(w->target->context, finite_count, sizeof *indices);
    if (!indices) return EWA_ERROR_MEMORY;
    const ewa_attribute *position = ewa_cloud_find(piece, EWA_POSITION);
    uint64_t kept = 0;
    for (uint64_t i = 0; i < count; i++) {
        double at[4];
        ewa_attribute_read_f64(position, i, 1, at);
        // Differences of numbers that are not finite are no numbers.
        if (at[0] - at[0] == 0 && at[1] - at[1] == 0 && at[2] - at[2] == 0) indices[kept++] = i;
    }
    w->left_out_count += count - finite_count;
    const ewa_status status = ewa_cloud_select(piece, indices, kept, finite);
    ewa_release(w->target->context, indices, finite_count, sizeof *indices);
    return status;
}

/// Checks that all places of a piece have whole numbers of 32 bits.
static ewa_status check_range(const las_writer *w, const ewa_bounds *bounds) {
    const ewa_las_plan *plan = &w->plan;
    for (int c = 0; c < 3 && bounds->finite_count; c++) {
        const double scale = plan->table.scale[c], offset = plan->offset_world[c];
        if ((bounds->low_world[c] - offset) / scale > INT32_MIN - 0.5 &&
            (bounds->high_world[c] - offset) / scale < INT32_MAX + 0.5)
            continue;
        return ewa_fail(
            w->target->context, EWA_ERROR_LIMIT,
            "%s: %c from %.17g to %.17g does not fit the 32 bits of LAS in steps of %g from %.17g",
            w->target->name, "xyz"[c], bounds -> low_world[c], bounds -> high_world[c], scale, offset);
    }
    return EWA_OK;
}

/// Plans the file by its first piece, which may be all of it, and writes what comes before the points.
static ewa_status begin(las_writer *w, const ewa_cloud *piece, bool is_whole) {
    const ewa_cloud_target *target = w->target;
    const bool can_patch = ewa_writer_can_patch(target->writer);
    if (!can_patch && !is_whole && target->point_count != 0)
        return ewa_fail(target->context, EWA_ERROR_UNSUPPORTED,
                        "%s: the header of LAS holds counts and bounds of all points, which are not known "
                        "when they come in pieces; write to a file",
                        target->name);
    ewa_buffer records = {0};
    size_t records_bytes = 0;
    ewa_status status = ewa_las_plan_make(target, piece, is_whole, false, &w->plan);
    if (status == EWA_OK)
        status = ewa_las_records_make(target, &w->plan, &records, &records_bytes, &w->vlr_count);
    if (status == EWA_OK) status = make_waves(w);
    if (status == EWA_OK && w->plan.compressed) {
        status =
            ewa_las_laz_record_append(target->context, &w->laz, w->chunk_points, &records, &records_bytes);
        w->vlr_count++;
    }
    w->points_at = (w->plan.version_minor >= 4 ? EWA_LAS_HEAD_14_BYTES : EWA_LAS_HEAD_BYTES) + records_bytes;
    if (status == EWA_OK && piece && !can_patch) {
        w->dry = true;
        status = put_finite(w, piece);
        w->dry = false;
    }
    if (status == EWA_OK) status = write_head(w, &records, records_bytes);
    if (!can_patch) {
        w->sums = EWA_LAS_NO_SUMS;
        w->point_count = 0;
    }
    ewa_buffer_free(target->context, &records);
    w->begun = true;
    return status;
}

static ewa_status put_points(void *data, const ewa_cloud *piece) {
    las_writer *w = data;
    ewa_bounds bounds;
    EWA_TRY(ewa_cloud_measure(piece, &bounds));
    ewa_cloud *finite = NULL;
    ewa_status status = drop_unplaced(w, piece, bounds.finite_count, &finite);
    if (status == EWA_OK && !w->begun)
        status = begin(w, finite ? finite : piece, ewa_cloud_point_count(piece) == w->target->point_count);
    if (status == EWA_OK) status = check_range(w, &bounds);
    if (status == EWA_OK) status = put_finite(w, finite ? finite : piece);
    ewa_cloud_destroy(&finite);
    return status;
}

/// Writes the table of chunks, and where it is.
static ewa_status finish_chunks(las_writer *w) {
    ewa_context *context = w->target->context;
    const uint64_t table_at = w->at_bytes;
    ewa_buffer table = {0};
    size_t table_bytes = 0;
    ewa_status status = w->chunk_count > UINT32_MAX
                            ? ewa_fail(context, EWA_ERROR_LIMIT, "%s: more than 2^32 chunks", w->target->name)
                            : ewa_laz_table_encode(context, w->chunks.data, (uint32_t)w->chunk_count, false,
                                                   &table, &table_bytes);
    if (status == EWA_OK) status = put_bytes(w, table.data, table_bytes);
    uint8_t at[8];
    ewa_las_put_u64(at, table_at);
    if (status == EWA_OK)
        status = ewa_writer_can_patch(w->target->writer)
                     ? ewa_writer_patch(w->target->writer, w->points_at, at, sizeof at)
                     : put_bytes(w, at, sizeof at);
    ewa_buffer_free(context, &table);
    return status;
}

static ewa_status finish_writer(void *data) {
    las_writer *w = data;
    const ewa_cloud_target *target = w->target;
    ewa_status status = w->begun ? EWA_OK : begin(w, NULL, false);
    if (status == EWA_OK) status = flush(w);
    if (status == EWA_OK && w->plan.compressed) status = finish_chunks(w);
    if (status == EWA_OK && w->plan.version_minor < 4 && w->point_count > UINT32_MAX)
        status = ewa_fail(target->context, EWA_ERROR_LIMIT, "%s: %llu points are more than LAS 1.2 counts",
                          target->name, (unsigned long long)w->point_count);
    uint8_t head[EWA_LAS_HEAD_14_BYTES];
    const uint16_t head_bytes = make_header(w, head);
    if (status == EWA_OK && ewa_writer_can_patch(target->writer))
        status = ewa_writer_patch(target->writer, 0, head, head_bytes);
    if (w->left_out_count)
        ewa_report(target->context, EWA_SEVERITY_WARNING,
                   "%s: %llu points without finite coordinates, which LAS cannot hold, are left out",
                   target->name, (unsigned long long)w->left_out_count);
    if (w->sums.clamped_count)
        ewa_report(
            target->context, EWA_SEVERITY_WARNING,
            "%s: %llu numbers are out of the range of their fields in point format %u and were brought "
            "into it",
            target->name, (unsigned long long)w->sums.clamped_count, w->plan.point_format);
    return status;
}

const ewa_cloud_write_format ewa_write_las = {.suffixes = ".las|.laz",
                                              .needs_bounds = true,
                                              .open = open_writer,
                                              .put = put_points,
                                              .finish = finish_writer,
                                              .close = close_writer};
