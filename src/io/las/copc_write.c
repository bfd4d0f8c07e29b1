// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Writes COPC: nodes as chunks of LAZ in the order in which they come, then the table of chunks, then the extended
// records, of which the hierarchy is the last; what was not known before is patched in at the end.
//
// Based on: Hobu, "COPC: Cloud Optimized Point Cloud Specification 1.0", 2021.
#include "io/las/copc_write.h"
#include "base/allocating.h"
#include "cloud/cloud.h"
#include "io/file.h"
#include "io/las/copc.h"
#include "io/las/las_write.h"
#include "io/las/laz_chunks.h"

#include <math.h>
#include <string.h>

enum {
    INFO_AT = EWA_LAS_HEAD_14_BYTES + EWA_LAS_RECORD_BYTES,
    FIRST_KEY_SLOTS = 1024,
    SLOT_FREE = -1, ///< level of a key that is none
};

struct ewa_octree_writer {
    ewa_cloud_target target;
    ewa_cloud_save_options options;
    ewa_octree_plan plan;
    char *name;
    ewa_las_plan las;
    ewa_laz_plan laz;
    uint32_t vlr_count, evlr_count, worker_count;
    uint64_t points_at, point_count, evlrs_at;
    ewa_las_sums sums;
    double gps_time_low, gps_time_high; ///< low > high: none
    ewa_buffer chunks;                  ///< ewa_laz_chunk
    ewa_buffer nodes;                   ///< ewa_octree_node
    uint64_t node_count;
    ewa_octree_key *keys; ///< of the nodes, in slots by what their numbers are mixed to
    uint64_t slot_count;  ///< a power of two, more than half of them free
    bool ended;           ///< no more points
    uint64_t levels_left_bytes;
    ewa_laz_memory **memories; ///< one per worker
    ewa_buffer *records;       ///< one per worker
};

void ewa_octree_chunk_free(ewa_context *context, ewa_octree_chunk *chunk) {
    ewa_buffer_free(context, &chunk->bytes);
    *chunk = (ewa_octree_chunk){0};
}

static ewa_status check_plan(const ewa_octree_writer *w) {
    const ewa_octree_plan *plan = &w->plan;
    bool finite = isfinite(plan->side_world) && isfinite(plan->spacing_world);
    for (int c = 0; c < 3; c++) finite = finite && isfinite(plan->low_world[c]);
    if (finite && plan->side_world > 0 && plan->spacing_world > 0) return EWA_OK;
    return ewa_fail(w->target.context, EWA_ERROR_ARGUMENT,
                    "%s: the root has a side of %g and a spacing of %g; both must be finite and above 0",
                    w->name, plan->side_world, plan->spacing_world);
}

/// Makes the record that says what the root is and where the hierarchy.
static void make_info(const ewa_octree_writer *w, uint64_t pages_at, uint64_t root_bytes,
                      uint8_t info[EWA_COPC_INFO_BYTES]) {
    const ewa_octree_plan *plan = &w->plan;
    const bool has_times = w->gps_time_low <= w->gps_time_high;
    memset(info, 0, EWA_COPC_INFO_BYTES);
    for (int c = 0; c < 3; c++) ewa_las_put_f64(info + 8 * c, plan->low_world[c] + plan->side_world / 2);
    ewa_las_put_f64(info + 24, plan->side_world / 2);
    ewa_las_put_f64(info + 32, plan->spacing_world);
    ewa_las_put_u64(info + 40, pages_at);
    ewa_las_put_u64(info + 48, root_bytes);
    ewa_las_put_f64(info + 56, has_times ? w->gps_time_low : 0);
    ewa_las_put_f64(info + 64, has_times ? w->gps_time_high : 0);
}

static uint16_t make_head(const ewa_octree_writer *w, uint8_t head[EWA_LAS_HEAD_14_BYTES]) {
    const ewa_las_head said = {.points_at = w->points_at,
                               .point_count = w->point_count,
                               .evlrs_at = w->evlrs_at,
                               .vlr_count = w->vlr_count,
                               .evlr_count = w->evlr_count,
                               .sums = &w->sums};
    return ewa_las_head_make(&w->las, w->target.prototype, &said, head);
}

/// Plans the records of the points and writes what comes before them.
static ewa_status begin(ewa_octree_writer *w) {
    const ewa_cloud_target *target = &w->target;
    ewa_context *context = target->context;
    ewa_buffer first = {0}, records = {0};
    size_t first_bytes = 0, records_bytes = 0;
    uint8_t info[EWA_COPC_INFO_BYTES], head[EWA_LAS_HEAD_14_BYTES];
    make_info(w, 0, 0, info);
    ewa_status status = ewa_las_plan_make(target, NULL, false, true, &w->las);
    w->las.compressed = true;
    if (status == EWA_OK)
        status =
            ewa_las_record_append(context, "copc", 1, "COPC info", info, sizeof info, &first, &first_bytes);
    if (status == EWA_OK)
        status = ewa_las_records_make(target, &w->las, &records, &records_bytes, &w->vlr_count);
    if (status == EWA_OK) {
        ewa_laz_plan_make(w->las.point_format, w->las.table.record_bytes, &w->laz);
        status = ewa_las_laz_record_append(context, &w->laz, EWA_LAZ_VARIABLE, &records, &records_bytes);
        w->vlr_count += 2;
    }
    w->points_at = EWA_LAS_HEAD_14_BYTES + first_bytes + records_bytes;
    if (status == EWA_OK) {
        const uint16_t head_bytes = make_head(w, head);
        status = ewa_writer_put(target->writer, head, head_bytes);
    }
    if (status == EWA_OK) status = ewa_writer_put(target->writer, first.data, first_bytes);
    if (status == EWA_OK) status = ewa_writer_put(target->writer, records.data, records_bytes);
    const uint8_t table_at[8] = {0}; // patched in
    if (status == EWA_OK) status = ewa_writer_put(target->writer, table_at, sizeof table_at);
    ewa_buffer_free(context, &first);
    ewa_buffer_free(context, &records);
    return status;
}

static ewa_status open_writer(ewa_octree_writer *w, const char *path) {
    ewa_context *context = w->target.context;
    const size_t name_bytes = strlen(path) + 1;
    w->name = ewa_allocate(context, name_bytes, 1);
    if (!w->name) return EWA_ERROR_MEMORY;
    memcpy(w->name, path, name_bytes);
    w->target.name = w->name;
    w->worker_count = ewa_context_worker_count(context);
    w->memories = ewa_allocate_zeroed(context, w->worker_count, sizeof *w->memories);
    w->records = ewa_allocate_zeroed(context, w->worker_count, sizeof *w->records);
    if (!w->memories || !w->records) return EWA_ERROR_MEMORY;
    EWA_TRY(check_plan(w));
    EWA_TRY(ewa_writer_open(context, path, &w->target.writer));
    if (!ewa_writer_can_patch(w->target.writer))
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED,
                        "%s: what COPC says first is known last: write to a file", w->name);
    return begin(w);
}

ewa_status ewa_octree_writer_open(ewa_context *context, const char *path, const ewa_octree_plan *plan,
                                  ewa_octree_writer **writer) {
    *writer = NULL;
    ewa_octree_writer *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->plan = *plan;
    made->sums = EWA_LAS_NO_SUMS;
    made->gps_time_low = INFINITY;
    made->gps_time_high = -INFINITY;
    ewa_cloud_save_options_init(&made->options, sizeof made->options);
    made->target = (ewa_cloud_target){.context = context,
                                      .options = &made->options,
                                      .prototype = plan->prototype,
                                      .point_count = EWA_POINTS_UNKNOWN,
                                      .bounds = &made->plan.bounds};
    const ewa_status status = open_writer(made, path);
    if (status == EWA_OK)
        *writer = made;
    else
        ewa_octree_writer_abort(&made);
    return status;
}

void ewa_octree_writer_grid(const ewa_octree_writer *writer, ewa_coordinate_grid *grid) {
    for (int c = 0; c < 3; c++) {
        grid->step_world[c] = writer->las.table.scale[c];
        grid->offset_world[c] = writer->las.offset_world[c];
    }
}

// ---- Nodes

/// Nodes that are encoded.
typedef struct encode_job {
    ewa_octree_writer *writer;
    const ewa_octree_key *keys;
    const ewa_cloud *const *pieces;
    ewa_octree_chunk *chunks;
    ewa_status *statuses;
} encode_job;

static void measure_times(const ewa_cloud *piece, ewa_octree_sums *sums) {
    enum { BLOCK = 256 };
    const ewa_attribute *time = ewa_cloud_find(piece, "gps_time");
    const uint64_t count = ewa_cloud_point_count(piece);
    sums->gps_time_low = INFINITY;
    sums->gps_time_high = -INFINITY;
    for (uint64_t first = 0; time && time->component_count == 1 && first < count; first += BLOCK) {
        double values[BLOCK];
        const uint64_t part = count - first < BLOCK ? count - first : BLOCK;
        ewa_attribute_read_f64(time, first, part, values);
        for (uint64_t i = 0; i < part; i++) {
            if (values[i] < sums->gps_time_low) sums->gps_time_low = values[i];
            if (values[i] > sums->gps_time_high) sums->gps_time_high = values[i];
        }
    }
}

static void encode_node(void *data, uint32_t index, uint32_t worker) {
    const encode_job *job = data;
    ewa_octree_writer *w = job->writer;
    ewa_context *context = w->target.context;
    ewa_octree_chunk *chunk = &job->chunks[index];
    const ewa_cloud *piece = job->pieces[index];
    const uint64_t count = ewa_cloud_point_count(piece);
    ewa_las_sums sums = EWA_LAS_NO_SUMS;
    chunk->key = job->keys[index];
    chunk->point_count = (uint32_t)count;
    chunk->size_bytes = 0;
    ewa_status status = ewa_buffer_reserve(context, &w->records[worker], count, w->las.table.record_bytes);
    if (status == EWA_OK && count) {
        ewa_las_pack(&w->las, piece, 0, count, w->records[worker].data, &sums);
        status = ewa_laz_encode(context, &w->laz, w->records[worker].data, count, &chunk->bytes,
                                &chunk->size_bytes, &w->memories[worker]);
    }
    memcpy(chunk->sums.low, sums.low, sizeof sums.low);
    memcpy(chunk->sums.high, sums.high, sizeof sums.high);
    memcpy(chunk->sums.by_return, sums.by_return, sizeof sums.by_return);
    chunk->sums.clamped_count = sums.clamped_count;
    measure_times(piece, &chunk->sums);
    job->statuses[index] = status;
}

static ewa_status check_node(const ewa_octree_writer *w, const ewa_octree_key *k, const ewa_cloud *piece) {
    bool is_cube = k->level >= 0 && k->level < EWA_OCTREE_LEVELS;
    for (int c = 0; c < 3 && is_cube; c++) is_cube = k->cell[c] >= 0 && k->cell[c] < (int64_t)1 << k->level;
    if (!is_cube)
        return ewa_fail(w->target.context, EWA_ERROR_ARGUMENT, "%s: there is no node %d-%d-%d-%d", w->name,
                        k->level, k->cell[0], k->cell[1], k->cell[2]);
    if (!ewa_cloud_is_alike(piece, w->target.prototype))
        return ewa_fail(w->target.context, EWA_ERROR_ARGUMENT,
                        "%s: node %d-%d-%d-%d has other attributes than the file", w->name, k->level,
                        k->cell[0], k->cell[1], k->cell[2]);
    if (ewa_cloud_point_count(piece) <= INT32_MAX) return EWA_OK;
    return ewa_fail(w->target.context, EWA_ERROR_LIMIT,
                    "%s: node %d-%d-%d-%d has %llu points; COPC counts up to %d", w->name, k->level,
                    k->cell[0], k->cell[1], k->cell[2], (unsigned long long)ewa_cloud_point_count(piece),
                    INT32_MAX);
}

ewa_status ewa_octree_encode(ewa_octree_writer *writer, const ewa_octree_key *keys,
                             const ewa_cloud *const *pieces, uint32_t count, ewa_octree_chunk *chunks) {
    ewa_context *context = writer->target.context;
    for (uint32_t i = 0; i < count; i++) {
        EWA_TRY(check_node(writer, &keys[i], pieces[i]));
    }
    encode_job job = {.writer = writer, .keys = keys, .pieces = pieces, .chunks = chunks};
    job.statuses = ewa_allocate_zeroed(context, count, sizeof *job.statuses);
    if (!job.statuses) return EWA_ERROR_MEMORY;
    ewa_parallel_allocating(context, encode_node, &job, count);
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < count && status == EWA_OK; i++) status = job.statuses[i];
    ewa_release(context, job.statuses, count, sizeof *job.statuses);
    return status;
}

/// The slot of a key, or the free one that it may have.
static ewa_octree_key *find_slot(ewa_octree_key *slots, uint64_t slot_count, const ewa_octree_key *key) {
    uint64_t mixed = (uint32_t)key->level;
    for (int c = 0; c < 3; c++) mixed = (mixed ^ (uint32_t)key->cell[c]) * 0x9E3779B97F4A7C15u;
    uint64_t at = (mixed >> 32) & (slot_count - 1);
    while (slots[at].level != SLOT_FREE && ewa_octree_key_compare(&slots[at], key) != 0)
        at = (at + 1) & (slot_count - 1);
    return &slots[at];
}

/// Makes twice as many slots.
static ewa_status add_slots(ewa_octree_writer *w) {
    ewa_context *context = w->target.context;
    const uint64_t more = w->slot_count ? 2 * w->slot_count : FIRST_KEY_SLOTS;
    ewa_octree_key *slots = ewa_allocate(context, more, sizeof *slots);
    if (!slots) return EWA_ERROR_MEMORY;
    for (uint64_t i = 0; i < more; i++) slots[i].level = SLOT_FREE;
    for (uint64_t i = 0; i < w->slot_count; i++)
        if (w->keys[i].level != SLOT_FREE) *find_slot(slots, more, &w->keys[i]) = w->keys[i];
    ewa_release(context, w->keys, w->slot_count, sizeof *w->keys);
    w->keys = slots;
    w->slot_count = more;
    return EWA_OK;
}

static ewa_status take_key(ewa_octree_writer *w, const ewa_octree_key *key) {
    if (2 * (w->node_count + 1) > w->slot_count) EWA_TRY(add_slots(w));
    ewa_octree_key *slot = find_slot(w->keys, w->slot_count, key);
    if (slot->level != SLOT_FREE)
        return ewa_fail(w->target.context, EWA_ERROR_ARGUMENT, "%s: node %d-%d-%d-%d comes twice", w->name,
                        key->level, key->cell[0], key->cell[1], key->cell[2]);
    *slot = *key;
    return EWA_OK;
}

static void add_sums(ewa_octree_writer *w, const ewa_octree_sums *sums) {
    ewa_las_sums more = EWA_LAS_NO_SUMS;
    memcpy(more.low, sums->low, sizeof more.low);
    memcpy(more.high, sums->high, sizeof more.high);
    memcpy(more.by_return, sums->by_return, sizeof more.by_return);
    more.clamped_count = sums->clamped_count;
    ewa_las_sums_add(&w->sums, &more);
    w->gps_time_low = fmin(w->gps_time_low, sums->gps_time_low);
    w->gps_time_high = fmax(w->gps_time_high, sums->gps_time_high);
}

ewa_status ewa_octree_append(ewa_octree_writer *writer, const ewa_octree_chunk *chunk) {
    ewa_context *context = writer->target.context;
    const ewa_octree_key *k = &chunk->key;
    if (writer->ended)
        return ewa_fail(context, EWA_ERROR_ARGUMENT,
                        "%s: node %d-%d-%d-%d comes behind the end of the points", writer->name, k->level,
                        k->cell[0], k->cell[1], k->cell[2]);
    if (chunk->point_count == 0) return EWA_OK;
    if (chunk->size_bytes > INT32_MAX || writer->node_count >= UINT32_MAX - 1)
        return ewa_fail(
            context, EWA_ERROR_LIMIT,
            "%s: node %d-%d-%d-%d has %zu bytes and is the %lluth; COPC has nodes of up to %d bytes, "
            "and 2^32 of them",
            writer->name, k->level, k->cell[0], k->cell[1], k->cell[2], chunk->size_bytes,
            (unsigned long long)writer->node_count + 1, INT32_MAX);
    const uint64_t count = writer->node_count;
    const ewa_octree_node node = {.key = *k,
                                  .point_count = chunk->point_count,
                                  .at_bytes = ewa_writer_size(writer->target.writer),
                                  .size_bytes = chunk->size_bytes};
    EWA_TRY(ewa_buffer_grow(context, &writer->chunks, count, count + 1, sizeof(ewa_laz_chunk)));
    EWA_TRY(ewa_buffer_grow(context, &writer->nodes, count, count + 1, sizeof node));
    EWA_TRY(take_key(writer, k));
    EWA_TRY(ewa_writer_put(writer->target.writer, chunk->bytes.data, chunk->size_bytes));
    ((ewa_laz_chunk *)writer->chunks.data)[count] = (ewa_laz_chunk){chunk->point_count, chunk->size_bytes};
    ((ewa_octree_node *)writer->nodes.data)[count] = node;
    writer->node_count++;
    writer->point_count += chunk->point_count;
    add_sums(writer, &chunk->sums);
    return EWA_OK;
}

// ---- What comes behind the points

/// Writes the table of chunks, and where it is.
static ewa_status end_points(ewa_octree_writer *w) {
    if (w->ended) return EWA_OK;
    ewa_context *context = w->target.context;
    const uint64_t table_at = ewa_writer_size(w->target.writer);
    ewa_buffer table = {0};
    size_t table_bytes = 0;
    uint8_t at[8];
    ewa_las_put_u64(at, table_at);
    ewa_status status =
        ewa_laz_table_encode(context, w->chunks.data, (uint32_t)w->node_count, true, &table, &table_bytes);
    if (status == EWA_OK) status = ewa_writer_put(w->target.writer, table.data, table_bytes);
    if (status == EWA_OK) status = ewa_writer_patch(w->target.writer, w->points_at, at, sizeof at);
    ewa_buffer_free(context, &table);
    w->evlrs_at = ewa_writer_size(w->target.writer);
    w->ended = true;
    return status;
}

static ewa_status begin_extended(ewa_octree_writer *w, const char *user, uint16_t id, const char *description,
                                 uint64_t size_bytes) {
    uint8_t head[EWA_LAS_EXTENDED_BYTES] = {0};
    memcpy(head + 2, user, strnlen(user, 16));
    ewa_las_put_u16(head + 18, id);
    ewa_las_put_u64(head + 20, size_bytes);
    memcpy(head + 28, description, strnlen(description, 32));
    w->evlr_count++;
    return ewa_writer_put(w->target.writer, head, sizeof head);
}

ewa_status ewa_octree_levels_begin(ewa_octree_writer *writer, uint64_t size_bytes) {
    if (writer->evlr_count)
        return ewa_fail(writer->target.context, EWA_ERROR_ARGUMENT, "%s: the levels begin twice",
                        writer->name);
    const ewa_status status = end_points(writer);
    writer->levels_left_bytes = size_bytes;
    return status == EWA_OK ? begin_extended(writer, EWA_COPC_LEVELS_USER, EWA_COPC_LEVELS_ID,
                                             "levels of detail", size_bytes)
                            : status;
}

ewa_status ewa_octree_levels_put(ewa_octree_writer *writer, const void *bytes, size_t size_bytes) {
    if (size_bytes > writer->levels_left_bytes)
        return ewa_fail(writer->target.context, EWA_ERROR_ARGUMENT,
                        "%s: the levels are %zu bytes longer than was said", writer->name,
                        (size_t)(size_bytes - writer->levels_left_bytes));
    writer->levels_left_bytes -= size_bytes;
    return ewa_writer_put(writer->target.writer, bytes, size_bytes);
}

static ewa_status finish(ewa_octree_writer *w) {
    ewa_context *context = w->target.context;
    if (w->levels_left_bytes)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: the levels are %llu bytes shorter than was said",
                        w->name, (unsigned long long)w->levels_left_bytes);
    EWA_TRY(end_points(w));
    const uint64_t pages_at = ewa_writer_size(w->target.writer) + EWA_LAS_EXTENDED_BYTES;
    ewa_copc_pages pages = {0};
    ewa_status status = ewa_copc_pages_make(context, w->nodes.data, w->node_count, pages_at, &pages);
    if (status == EWA_OK)
        status = begin_extended(w, "copc", EWA_COPC_PAGES_ID, "COPC hierarchy", pages.size_bytes);
    if (status == EWA_OK) status = ewa_writer_put(w->target.writer, pages.bytes.data, pages.size_bytes);
    uint8_t info[EWA_COPC_INFO_BYTES], head[EWA_LAS_HEAD_14_BYTES];
    make_info(w, pages_at, pages.root_bytes, info);
    const uint16_t head_bytes = make_head(w, head);
    if (status == EWA_OK) status = ewa_writer_patch(w->target.writer, INFO_AT, info, sizeof info);
    if (status == EWA_OK) status = ewa_writer_patch(w->target.writer, 0, head, head_bytes);
    ewa_buffer_free(context, &pages.bytes);
    if (w->sums.clamped_count)
        ewa_report(
            context, EWA_SEVERITY_WARNING,
            "%s: %llu numbers are out of the range of their fields in point format %u and were brought "
            "into it",
            w->name, (unsigned long long)w->sums.clamped_count, w->las.point_format);
    return status;
}

ewa_status ewa_octree_writer_commit(ewa_octree_writer **writer) {
    ewa_status status = finish(*writer);
    if (status == EWA_OK) status = ewa_writer_commit(&(*writer)->target.writer);
    ewa_octree_writer_abort(writer);
    return status;
}

void ewa_octree_writer_abort(ewa_octree_writer **writer) {
    if (!writer || !*writer) return;
    ewa_octree_writer *old = *writer;
    ewa_context *context = old->target.context;
    ewa_writer_abort(&old->target.writer);
    for (uint32_t i = 0; i < old->worker_count; i++) {
        if (old->memories) ewa_laz_memory_free(context, &old->memories[i]);
        if (old->records) ewa_buffer_free(context, &old->records[i]);
    }
    ewa_release(context, old->memories, old->worker_count, sizeof *old->memories);
    ewa_release(context, old->records, old->worker_count, sizeof *old->records);
    ewa_release(context, old->keys, old->slot_count, sizeof *old->keys);
    ewa_buffer_free(context, &old->chunks);
    ewa_buffer_free(context, &old->nodes);
    ewa_las_plan_free(context, &old->las);
    if (old->name) ewa_release(context, old->name, strlen(old->name) + 1, 1);
    ewa_release(context, old, 1, sizeof *old);
    *writer = NULL;
}
