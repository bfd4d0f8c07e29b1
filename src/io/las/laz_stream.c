// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The records of LAZ chunks, decoded by all workers: whole chunks go from the worker that decodes them into
// the sinks; a chunk that is larger than what is wanted is kept and handed out in parts.
#include "base/allocating.h"
#include "io/las/laz_chunks.h"

#include <string.h>

enum { MAX_SAMPLES = 8, SAMPLE_BYTES = 1 << 25 };

/// The records of one chunk.
typedef struct kept_chunk {
    uint64_t chunk;
    uint8_t *records; ///< NULL: nothing is kept
    uint64_t capacity_bytes;
    ewa_laz_result result;
    ewa_status status;
} kept_chunk;

struct ewa_laz_stream {
    const ewa_cloud_source *source;
    const ewa_laz_layout *layout;
    uint64_t next_chunk, next_point; ///< the next point within the chunk
    uint64_t points_before;          ///< of the chunks before the next one
    uint32_t worker_count, kept_count;
    ewa_laz_memory **memories; ///< one per worker
    ewa_buffer *records;       ///< one per worker
    kept_chunk kept[MAX_SAMPLES + 1];
};

ewa_status ewa_laz_stream_open(const ewa_cloud_source *source, const ewa_laz_layout *layout,
                               ewa_laz_stream **stream) {
    ewa_context *context = source->context;
    ewa_laz_stream *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    *stream = made;
    if (!made) return EWA_ERROR_MEMORY;
    made->source = source;
    made->layout = layout;
    made->worker_count = ewa_context_worker_count(context);
    made->memories = ewa_allocate_zeroed(context, made->worker_count, sizeof *made->memories);
    made->records = ewa_allocate_zeroed(context, made->worker_count, sizeof *made->records);
    if (made->memories && made->records) return EWA_OK;
    ewa_laz_stream_close(made);
    *stream = NULL;
    return EWA_ERROR_MEMORY;
}

static void drop_kept(ewa_laz_stream *stream, kept_chunk *kept) {
    ewa_release(stream->source->context, kept->records, kept->capacity_bytes, 1);
    *kept = stream->kept[--stream->kept_count];
}

void ewa_laz_stream_close(ewa_laz_stream *stream) {
    if (!stream) return;
    ewa_context *context = stream->source->context;
    while (stream->kept_count) drop_kept(stream, &stream->kept[0]);
    for (uint32_t i = 0; i < stream->worker_count; i++) {
        if (stream->memories) ewa_laz_memory_free(context, &stream->memories[i]);
        if (stream->records) ewa_buffer_free(context, &stream->records[i]);
    }
    ewa_release(context, stream->memories, stream->worker_count, sizeof *stream->memories);
    ewa_release(context, stream->records, stream->worker_count, sizeof *stream->records);
    ewa_release(context, stream, 1, sizeof *stream);
}

static uint64_t chunk_bytes(const ewa_laz_stream *stream, uint64_t chunk) {
    return stream->layout->chunks[chunk].point_count * stream->layout->plan.record_bytes;
}

static kept_chunk *find_kept(ewa_laz_stream *stream, uint64_t chunk) {
    for (uint32_t i = 0; i < stream->kept_count; i++)
        if (stream->kept[i].chunk == chunk) return &stream->kept[i];
    return NULL;
}

static ewa_status decode(ewa_laz_stream *stream, uint64_t chunk, uint8_t *records, uint32_t worker,
                         ewa_laz_result *result) {
    const ewa_laz_layout *layout = stream->layout;
    const ewa_cloud_source *source = stream->source;
    const bool cut = layout->cut && chunk == layout->chunk_count - 1;
    const uint64_t size_bytes = layout->chunks[chunk].size_bytes;
    return (cut ? ewa_laz_decode_cut : ewa_laz_decode)(
        source->context, &layout->plan, ewa_cloud_find_bytes(source, layout->at_bytes[chunk], size_bytes), size_bytes,
        layout->chunks[chunk].point_count, records, &stream->memories[worker], result);
}

/// Kept chunks from `first` on that are to be decoded.
typedef struct keep_job {
    ewa_laz_stream *stream;
    uint32_t first;
} keep_job;

static void decode_kept(void *data, uint32_t index, uint32_t worker) {
    const keep_job *job = data;
    ewa_laz_stream *stream = job->stream;
    kept_chunk *kept = &stream->kept[job->first + index];
    kept->status = decode(stream, kept->chunk, kept->records, worker, &kept->result);
}

/// Makes room to keep a chunk.
static ewa_status add_kept(ewa_laz_stream *stream, uint64_t chunk) {
    const uint64_t bytes = chunk_bytes(stream, chunk);
    uint8_t *records = ewa_allocate(stream->source->context, bytes, 1);
    if (!records) return EWA_ERROR_MEMORY;
    stream->kept[stream->kept_count++] =
        (kept_chunk){.chunk = chunk, .records = records, .capacity_bytes = bytes};
    return EWA_OK;
}

/// Decodes chunks that are kept, from `first` on; of a file that comes in parts, their bytes are read before.
static ewa_status decode_samples(ewa_laz_stream *stream, uint32_t first, uint32_t count) {
    ewa_ranges *ranges = stream->source->ranges;
    const uint32_t held_count = ranges ? ewa_ranges_count(ranges) : 0;
    const keep_job job = {stream, first};
    for (uint32_t i = first; i < first + count && ranges; i++) {
        const uint64_t chunk = stream->kept[i].chunk;
        const uint8_t *bytes;
        EWA_TRY(ewa_ranges_need(ranges, stream->layout->at_bytes[chunk], stream->layout->chunks[chunk].size_bytes, &bytes));
    }
    ewa_parallel_allocating(stream->source->context, decode_kept, (void *)&job, count);
    if (ranges) ewa_ranges_let_go(ranges, held_count);
    return EWA_OK;
}

ewa_status ewa_laz_stream_sample(ewa_laz_stream *stream,
                                 bool (*look)(void *user, const uint8_t *records, uint64_t count), void *user,
                                 bool *is_all) {
    const uint64_t chunk_count = stream->layout->chunk_count;
    const uint32_t maximum = chunk_count < MAX_SAMPLES ? (uint32_t)chunk_count : MAX_SAMPLES;
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < maximum; i++) {
        const uint64_t chunk = ewa_split(chunk_count, maximum, i);
        bytes += chunk_bytes(stream, chunk);
        if (i && bytes > SAMPLE_BYTES) break;
        EWA_TRY(add_kept(stream, chunk));
    }
    // Of a file that comes in parts, one after the other, until enough was seen.
    const uint32_t step = stream->source->ranges ? 1 : stream->kept_count;
    bool enough = false;
    *is_all = stream->kept_count == chunk_count;
    for (uint32_t first = 0; first < stream->kept_count && !enough; first += step) {
        EWA_TRY(decode_samples(stream, first, step));
        for (uint32_t i = first; i < first + step; i++) {
            const kept_chunk *kept = &stream->kept[i];
            if (kept->status != EWA_OK) return kept->status;
            if (kept->result.fault)
                *is_all = false;
            else
                enough = look(user, kept->records, kept->result.point_count);
        }
    }
    return EWA_OK;
}

/// Says that a chunk is damaged; its points are lost, since those before the fault may be wrong, too.
static ewa_status damage(const ewa_laz_stream *stream, uint64_t chunk, uint64_t points_before,
                         const ewa_laz_result *result) {
    const ewa_laz_layout *layout = stream->layout;
    const uint64_t point_count = layout->chunks[chunk].point_count;
    return ewa_cloud_damage(stream->source, point_count,
                            "%s: chunk %llu of %llu, at byte %llu, is damaged at its point %llu of %llu, "
                            "point %llu of the file: %s",
                            stream->source->name, (unsigned long long)chunk + 1,
                            (unsigned long long)layout->chunk_count,
                            (unsigned long long)layout->at_bytes[chunk],
                            (unsigned long long)result->point_count + 1, (unsigned long long)point_count,
                            (unsigned long long)(points_before + result->point_count + 1), result->fault);
}

/// Decodes and keeps the next chunks, one per worker as far as there is room.
static ewa_status keep_next(ewa_laz_stream *stream) {
    const uint64_t chunk_count = stream->layout->chunk_count;
    const uint32_t first = stream->kept_count;
    uint64_t bytes = 0;
    for (uint64_t chunk = stream->next_chunk; chunk < chunk_count && stream->kept_count <= MAX_SAMPLES &&
                                              stream->kept_count - first < stream->worker_count;
         chunk++) {
        if (find_kept(stream, chunk)) continue;
        bytes += chunk_bytes(stream, chunk);
        if (chunk > stream->next_chunk && bytes > SAMPLE_BYTES) break;
        EWA_TRY(add_kept(stream, chunk));
    }
    const keep_job job = {stream, first};
    ewa_parallel_allocating(stream->source->context, decode_kept, (void *)&job, stream->kept_count - first);
    return EWA_OK;
}

/// Hands out a part of the next chunk, which is decoded and kept for it.
static ewa_status read_part(ewa_laz_stream *stream, const ewa_las_table *table, uint64_t maximum,
                            const ewa_cloud_sink *sinks, uint64_t *got_count, ewa_las_seen *seen) {
    const uint64_t chunk = stream->next_chunk;
    kept_chunk *kept = find_kept(stream, chunk);
    if (!kept) {
        EWA_TRY(keep_next(stream));
        kept = find_kept(stream, chunk);
    }
    ewa_status status = kept->status;
    const uint64_t point_count = stream->layout->chunks[chunk].point_count;
    if (status == EWA_OK && kept->result.fault) {
        status = damage(stream, chunk, stream->points_before, &kept->result);
        stream->next_point = point_count;
    } else if (status == EWA_OK) {
        const uint64_t left = point_count - stream->next_point;
        *got_count = left < maximum ? left : maximum;
        ewa_las_unpack_seen(table, kept->records + stream->next_point * stream->layout->plan.record_bytes, *got_count, sinks,
                            seen);
        stream->next_point += *got_count;
    }
    if (status != EWA_OK || stream->next_point < point_count) return status;
    drop_kept(stream, kept);
    stream->points_before += point_count;
    stream->next_chunk++;
    stream->next_point = 0;
    return EWA_OK;
}

/// What became of one chunk of a wave.
typedef struct wave_result {
    uint64_t first_point; ///< in the sinks
    ewa_las_seen seen;
    ewa_laz_result result;
    ewa_status status;
} wave_result;

typedef struct wave {
    ewa_laz_stream *stream;
    const ewa_las_table *table;
    const ewa_cloud_sink *sinks;
    wave_result *results;
    uint64_t chunk_count;
} wave;

static void read_chunk(void *data, uint32_t index, uint32_t worker) {
    const wave *w = data;
    ewa_laz_stream *stream = w->stream;
    wave_result *r = &w->results[index];
    const uint64_t chunk = stream->next_chunk + index;
    const kept_chunk *kept = find_kept(stream, chunk);
    const uint8_t *records = kept ? kept->records : stream->records[worker].data;
    if (kept) {
        r->status = kept->status;
        r->result = kept->result;
    } else {
        r->status = decode(stream, chunk, stream->records[worker].data, worker, &r->result);
    }
    if (r->status != EWA_OK || r->result.fault) return;
    ewa_cloud_sink sinks[EWA_LAS_MAX_COLUMNS];
    for (uint32_t i = 0; i < w->table->column_count; i++) {
        sinks[i] = w->sinks[i];
        if (sinks[i].to) sinks[i].to += r->first_point * sinks[i].stride_bytes;
    }
    ewa_las_unpack_seen(w->table, records, r->result.point_count, sinks, &r->seen);
}

/// Closes a gap in the sinks that lost points left.
static void move_down(const wave *w, uint64_t to, uint64_t from, uint64_t count) {
    for (uint32_t i = 0; i < w->table->column_count; i++) {
        const ewa_cloud_sink *sink = &w->sinks[i];
        const ewa_las_column *column = &w->table->columns[i];
        const size_t point_bytes = column->component_count * ewa_type_bytes(column->type);
        for (uint64_t p = 0; sink->to && p < count; p++)
            memmove(sink->to + (to + p) * sink->stride_bytes, sink->to + (from + p) * sink->stride_bytes,
                    point_bytes);
    }
}

/// Looks at the results in the order of the file: lost chunks are said and closed up, the stream goes on
/// behind the last.
static ewa_status settle(const wave *w, uint64_t *got_count, ewa_las_seen *seen) {
    ewa_laz_stream *stream = w->stream;
    for (uint64_t i = 0; i < w->chunk_count; i++) {
        const wave_result *r = &w->results[i];
        const uint64_t chunk = stream->next_chunk, point_count = stream->layout->chunks[chunk].point_count;
        if (r->status != EWA_OK) return r->status;
        if (r->result.fault) {
            EWA_TRY(damage(stream, chunk, stream->points_before, &r->result));
        } else {
            if (*got_count != r->first_point) move_down(w, *got_count, r->first_point, point_count);
            *got_count += point_count;
            ewa_las_seen_add(seen, &r->seen);
        }
        kept_chunk *kept = find_kept(stream, chunk);
        if (kept) drop_kept(stream, kept);
        stream->points_before += point_count;
        stream->next_chunk++;
    }
    return EWA_OK;
}

/// Reads as many whole chunks as there is room for.
static ewa_status read_wave(ewa_laz_stream *stream, const ewa_las_table *table, uint64_t chunk_count,
                            const ewa_cloud_sink *sinks, uint64_t *got_count, ewa_las_seen *seen) {
    ewa_context *context = stream->source->context;
    wave w = {.stream = stream, .table = table, .sinks = sinks, .chunk_count = chunk_count};
    w.results = ewa_allocate_zeroed(context, chunk_count, sizeof *w.results);
    ewa_status status = w.results ? EWA_OK : EWA_ERROR_MEMORY;
    uint64_t first_point = 0, max_bytes = 0;
    for (uint64_t i = 0; i < chunk_count && status == EWA_OK; i++) {
        const uint64_t bytes = chunk_bytes(stream, stream->next_chunk + i);
        w.results[i].first_point = first_point;
        first_point += stream->layout->chunks[stream->next_chunk + i].point_count;
        if (bytes > max_bytes && !find_kept(stream, stream->next_chunk + i)) max_bytes = bytes;
    }
    // Allocators are called by this thread only, which does a single chunk itself.
    const uint32_t worker_count = chunk_count == 1 ? 1 : stream->worker_count;
    for (uint32_t i = 0; i < worker_count && max_bytes && status == EWA_OK; i++)
        status = ewa_buffer_reserve(context, &stream->records[i], max_bytes, 1);
    if (status == EWA_OK && chunk_count == 1)
        read_chunk(&w, 0, 0);
    else if (status == EWA_OK)
        status = ewa_parallel_allocating_stoppable(context, "read", read_chunk, &w, (uint32_t)chunk_count);
    if (status == EWA_OK) status = settle(&w, got_count, seen);
    ewa_release(context, w.results, chunk_count, sizeof *w.results);
    return status;
}

ewa_status ewa_laz_stream_read(ewa_laz_stream *stream, const ewa_las_table *table, uint64_t maximum,
                               const ewa_cloud_sink *sinks, uint64_t *got_count, ewa_las_seen *seen) {
    const ewa_laz_layout *layout = stream->layout;
    ewa_status status = EWA_OK;
    *got_count = 0;
    // Nothing is got from chunks that are empty or lost; the end is where there is no further one.
    while (status == EWA_OK && *got_count == 0 && stream->next_chunk < layout->chunk_count) {
        uint64_t chunk_count = 0, room = maximum;
        for (uint64_t i = stream->next_chunk;
             stream->next_point == 0 && i < layout->chunk_count && chunk_count < UINT32_MAX &&
             layout->chunks[i].point_count <= room;
             i++, chunk_count++)
            room -= layout->chunks[i].point_count;
        status = chunk_count ? read_wave(stream, table, chunk_count, sinks, got_count, seen)
                             : read_part(stream, table, maximum, sinks, got_count, seen);
    }
    if (stream->next_chunk < layout->chunk_count)
        ewa_cloud_passed(stream->source, layout->at_bytes[stream->next_chunk]);
    return status;
}
