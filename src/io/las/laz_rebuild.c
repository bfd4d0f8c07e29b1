// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Chunks of a LAZ file that was cut: the table that says where they are stood at its end. A flat chunk ends where
// its last point does, which decoding it tells; a layered one says how long it is, and how many points it has. Of a flat
// chunk that is cut, the points before the cut are good: the decoder has looked at no byte that is not there. A
// layered one has the positions of all its points in front, so that most cuts cost other fields only.
#include "base/allocating.h"
#include "io/las/laz_chunk.h"
#include "io/las/laz_chunks.h"

#include <stdio.h>
#include <string.h>

/// What is found, chunk by chunk.
typedef struct rebuild {
    const ewa_cloud_source *source;
    const ewa_laz_plan *plan;
    ewa_laz_memory *memory;
    ewa_buffer records, chunks; ///< of one chunk; of ewa_laz_chunk
    uint64_t chunk_count;
    ewa_laz_result cut; ///< what the last chunk came to, if it is layered and cut
} rebuild;

static ewa_status add_chunk(rebuild *r, uint64_t point_count, uint64_t size_bytes) {
    EWA_TRY(ewa_buffer_grow(r->source->context, &r->chunks, r->chunk_count, r->chunk_count + 1,
                            sizeof(ewa_laz_chunk)));
    ((ewa_laz_chunk *)r->chunks.data)[r->chunk_count++] = (ewa_laz_chunk){point_count, size_bytes};
    return EWA_OK;
}

/// Makes room for the records of a chunk; `*point_count` falls to what `left` bytes can hold. Errors: EWA_ERROR_LIMIT,
/// EWA_ERROR_MEMORY.
static ewa_status reserve_records(rebuild *r, uint64_t left, uint64_t *point_count) {
    const ewa_cloud_source *source = r->source;
    const uint64_t maximum = left * EWA_LAZ_MAX_POINTS_PER_BYTE;
    if (*point_count > maximum) *point_count = maximum;
    const uint64_t max_bytes = ewa_context_limits(source->context)->max_memory_bytes;
    if (*point_count > max_bytes / r->plan->record_bytes)
        return ewa_fail(source->context, EWA_ERROR_LIMIT,
                        "%s: a chunk of %llu points is over the limit of %llu bytes", source->name,
                        (unsigned long long)*point_count, (unsigned long long)max_bytes);
    return ewa_buffer_reserve(source->context, &r->records, (size_t)*point_count, r->plan->record_bytes);
}

/// Adds the flat chunk of `point_count` points at byte `at`, or as much as there is; `*size_bytes` becomes its length,
/// 0 when there is nothing.
static ewa_status add_flat(rebuild *r, uint64_t at, uint64_t point_count, uint64_t *size_bytes, bool *cut) {
    const ewa_cloud_source *source = r->source;
    const uint8_t *bytes = source->bytes + at;
    const uint64_t left = source->size_bytes - at;
    EWA_TRY(reserve_records(r, left, &point_count));
    ewa_laz_result result;
    EWA_TRY(ewa_laz_decode(source->context, r->plan, bytes, left, point_count, r->records.data, &r->memory,
                           &result));
    *cut = result.point_count < point_count;
    *size_bytes = 0;
    if (result.point_count == 0) return EWA_OK;
    // Once more without the point that was cut, for where the one before it ends.
    point_count = result.point_count;
    if (*cut)
        EWA_TRY(ewa_laz_decode(source->context, r->plan, bytes, left, point_count, r->records.data,
                               &r->memory, &result));
    *size_bytes = result.used_bytes;
    return result.used_bytes ? add_chunk(r, point_count, result.used_bytes) : EWA_OK;
}

/// The same for a layered chunk, of no more than `point_count` points.
static ewa_status add_layered(rebuild *r, uint64_t at, uint64_t point_count, uint64_t *size_bytes, bool *cut) {
    const ewa_cloud_source *source = r->source;
    const uint8_t *bytes = source->bytes + at, *head = bytes + r->plan->record_bytes;
    const uint64_t left = source->size_bytes - at;
    uint32_t layer_count = 0;
    for (uint32_t i = 0; i < r->plan->item_count; i++) {
        uint32_t more = 0;
        ewa_laz_layered_bytes(&r->plan->items[i], &more);
        layer_count += more;
    }
    uint64_t all = r->plan->record_bytes + 4 + 4 * (uint64_t)layer_count;
    *cut = all > left;
    *size_bytes = 0;
    if (!*cut) {
        const uint32_t own_count = ewa_laz_load32(head);
        if (point_count > own_count) point_count = own_count;
        for (uint32_t i = 0; i < layer_count; i++) all += ewa_laz_load32(head + 4 + 4 * (size_t)i);
        *cut = all > left;
    }
    if (*cut) {
        EWA_TRY(reserve_records(r, left, &point_count));
        EWA_TRY(ewa_laz_decode_cut(source->context, r->plan, bytes, left, point_count, r->records.data,
                                   &r->memory, &r->cut));
        point_count = r->cut.point_count;
        all = left;
    }
    if (point_count == 0) return EWA_OK;
    *size_bytes = all;
    return add_chunk(r, point_count, all);
}

/// Says which fields the last chunk lacks.
static void report_lost(const rebuild *r) {
    static const char *const NAMES[EWA_LAZ_FIELD_COUNT] = {
        "classification", "flags", "intensity", "scan_angle", "user_data",  "point_source_id",
        "gps_time",       "color", "nir",       "wave packets", "extra bytes"};
    if (!r->cut.lost_fields) return;
    char text[192] = "";
    size_t length = 0;
    for (uint32_t i = 0; i < EWA_LAZ_FIELD_COUNT; i++)
        if (r->cut.lost_fields >> i & 1)
            length += (size_t)snprintf(text + length, sizeof text - length, "%s%s", length ? ", " : "", NAMES[i]);
    ewa_report(r->source->context, EWA_SEVERITY_WARNING,
               "%s: up to %llu points of the last chunk, which is cut, lack %s: 0 is read", r->source->name,
               (unsigned long long)r->cut.poor_count, text);
}

static ewa_status find_chunks(rebuild *r, uint64_t at, uint64_t *points_left, uint32_t chunk_points) {
    bool cut = false;
    while (*points_left && !cut && at < r->source->size_bytes) {
        const uint64_t wanted = *points_left < chunk_points ? *points_left : chunk_points,
                       before = r->chunk_count;
        uint64_t size_bytes;
        EWA_TRY((r->plan->layered ? add_layered : add_flat)(r, at, wanted, &size_bytes, &cut));
        if (r->chunk_count == before) break;
        at += size_bytes;
        *points_left -= ((const ewa_laz_chunk *)r->chunks.data)[before].point_count;
    }
    return EWA_OK;
}

ewa_status ewa_laz_layout_rebuild(const ewa_cloud_source *source, uint64_t first, uint64_t point_count,
                                  uint32_t chunk_points, ewa_laz_layout *layout) {
    ewa_context *context = source->context;
    rebuild r = {.source = source, .plan = &layout->plan};
    uint64_t points_left = point_count;
    ewa_status status = find_chunks(&r, first, &points_left, chunk_points);
    if (status == EWA_OK && r.chunk_count) {
        layout->cut = r.cut.point_count > 0;
        layout->chunks = ewa_allocate(context, r.chunk_count, sizeof *layout->chunks);
        layout->at_bytes = ewa_allocate_zeroed(context, r.chunk_count, sizeof *layout->at_bytes);
        layout->chunk_count = r.chunk_count;
        if (layout->chunks && layout->at_bytes)
            memcpy(layout->chunks, r.chunks.data, r.chunk_count * sizeof *layout->chunks);
        else
            status = EWA_ERROR_MEMORY;
    }
    if (status == EWA_OK && points_left)
        status = ewa_cloud_damage(
            source, points_left,
            "%s: the file is cut short: the table of chunks is missing, and %llu of %llu points are there",
            source->name, (unsigned long long)(point_count - points_left), (unsigned long long)point_count);
    if (status == EWA_OK) report_lost(&r);
    ewa_buffer_free(context, &r.records);
    ewa_buffer_free(context, &r.chunks);
    ewa_laz_memory_free(context, &r.memory);
    return status;
}
