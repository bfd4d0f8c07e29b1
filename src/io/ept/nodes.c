// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// EPT folders by nodes: the files of a wave are opened one by one, then their records are unpacked by all workers.
#include "base/base.h"
#include "base/platform.h"
#include "io/ept/ept.h"
#include "io/remote.h"
#include "io/zstandard.h"

#include <stdio.h>
#include <string.h>

enum {
    SAMPLE_NODES = 8, // whose colours are looked at
    SAMPLE_BYTES = 1 << 25,
    /// No byte of zstandard becomes more: a block of 128 KiB takes 4 at least.
    MAX_BYTES_PER_BYTE = 1 << 15,
};

static const char *const suffixes[] = {
    [EWA_EPT_LASZIP] = "laz", [EWA_EPT_BINARY] = "bin", [EWA_EPT_ZSTANDARD] = "zst"};

// ---- Finding the folder

/// Writes the folder of a tree; false when the path is none and leads to none.
static bool find_folder(ewa_context *context, const char *path, char folder[EWA_EPT_FOLDER_BYTES]) {
    char file[EWA_EPT_PATH_BYTES];
    const char *name = ewa_platform_file_name(path);
    const size_t length = strlen(path);
    if (length == 0 || length >= EWA_EPT_FOLDER_BYTES) return false;
    if (strcmp(name, "ept.json") == 0 && ewa_file_may_read(context, path)) {
        const int folder_length = (int)(name - path) - 1; // without the slash
        snprintf(folder, EWA_EPT_FOLDER_BYTES, "%.*s", name > path ? folder_length : 1, name > path ? path : ".");
        return true;
    }
    // A server has no folders that could be told from files.
    if (ewa_remote_is(path)) return false;
    snprintf(file, sizeof file, "%s/ept.json", path);
    memcpy(folder, path, length + 1);
    return ewa_file_may_read(context, file);
}

static bool is_ept(ewa_context *context, const char *path) {
    char folder[EWA_EPT_FOLDER_BYTES];
    return find_folder(context, path, folder);
}

// ---- One file

static ewa_cloud_source source_of(const ewa_ept *ept, const char *path, const ewa_file *file,
                                  const ewa_cloud_load_options *options, uint64_t *lost_count) {
    return (ewa_cloud_source){.context = ept->context,
                              .name = path,
                              .path = path,
                              .bytes = file->bytes,
                              .size_bytes = file->size_bytes,
                              .options = options,
                              .lost_count = lost_count};
}

/// Whether two files have records of one kind on one grid.
static bool is_like(const ewa_ept *ept, const ewa_las_header *header, const ewa_laz_plan *laz) {
    bool like = header->record_bytes == ept->header.record_bytes && laz->item_count == ept->laz.item_count &&
                header->point_format == ept->header.point_format;
    for (uint32_t i = 0; like && i < laz->item_count; i++)
        like = memcmp(&laz->items[i], &ept->laz.items[i], sizeof laz->items[i]) == 0;
    for (int c = 0; like && c < 3; c++)
        like = header->scale[c] == ept->header.scale[c] && header->offset[c] == ept->header.offset[c];
    return like;
}

/// Looks where the chunks of a node's file lie; `first`: other files are to be like it.
static ewa_status open_laz(ewa_ept *ept, const char *path, const ewa_octree_node *node, bool first,
                           ewa_octree *octree, ewa_ept_file *file) {
    ewa_cloud_load_options options;
    uint64_t lost_count = 0;
    ewa_cloud_load_options_init(&options, sizeof options);
    const ewa_cloud_source source = source_of(ept, path, &file->bytes, &options, &lost_count);
    ewa_las_header header;
    if (source.size_bytes < 4 || memcmp(source.bytes, "LASF", 4) != 0)
        return ewa_fail(ept->context, EWA_ERROR_FORMAT, "%s: no LAZ file", path);
    EWA_TRY(ewa_las_header_read(&source, &header));
    if (!header.compressed)
        return ewa_fail(ept->context, EWA_ERROR_FORMAT, "%s: its points are not compressed", path);
    EWA_TRY(ewa_laz_layout_read(&source, &header, &file->layout));
    if (first) {
        ept->header = header;
        ept->laz = file->layout.plan;
        ewa_las_table_make(&source, &header, &ept->table);
        memcpy(ept->offset_world, header.offset, sizeof header.offset);
        EWA_TRY(ewa_las_notes(&source, &header, octree->prototype));
    }
    if (!is_like(ept, &header, &file->layout.plan))
        return ewa_fail(
            ept->context, EWA_ERROR_FORMAT,
            "%s: its records of %u bytes in point format %u are not like those of the tree's first file, "
            "or on another grid",
            path, header.record_bytes, header.point_format);
    if (file->layout.point_count != node->point_count)
        return ewa_fail(ept->context, EWA_ERROR_FORMAT, "%s: it has %llu points, the hierarchy counts %llu",
                        path, (unsigned long long)file->layout.point_count,
                        (unsigned long long)node->point_count);
    return EWA_OK;
}

static ewa_status check_size(const ewa_ept *ept, const char *path, const ewa_octree_node *node,
                             const ewa_ept_file *file) {
    const uint64_t there = file->bytes.size_bytes, record_bytes = ept->table.record_bytes;
    const bool packed = ept->encoding == EWA_EPT_ZSTANDARD;
    const uint64_t max_bytes = ewa_context_limits(ept->context)->max_memory_bytes;
    if (node->point_count > max_bytes / record_bytes)
        return ewa_fail(ept->context, EWA_ERROR_LIMIT,
                        "%s: %llu points of %llu bytes are over the limit of %llu bytes", path,
                        (unsigned long long)node->point_count, (unsigned long long)record_bytes,
                        (unsigned long long)max_bytes);
    const uint64_t wanted = node->point_count * record_bytes;
    if (packed ? wanted / MAX_BYTES_PER_BYTE <= there : wanted == there) return EWA_OK;
    return ewa_fail(ept->context, EWA_ERROR_FORMAT,
                    "%s: %llu bytes cannot hold the %llu points of %llu bytes that the "
                    "hierarchy counts",
                    path, (unsigned long long)there, (unsigned long long)node->point_count,
                    (unsigned long long)record_bytes);
}

static ewa_status open_file(ewa_octree *octree, const ewa_octree_node *node, bool first, ewa_ept_file *file) {
    ewa_ept *ept = octree->state;
    char path[EWA_EPT_PATH_BYTES];
    EWA_TRY(ewa_ept_open(ept, "ept-data/", &node->key, suffixes[ept->encoding], path, &file->bytes));
    return ept->encoding == EWA_EPT_LASZIP ? open_laz(ept, path, node, first, octree, file)
                                           : check_size(ept, path, node, file);
}

static void close_file(ewa_ept *ept, ewa_ept_file *file) {
    ewa_laz_layout_free(ept->context, &file->layout);
    ewa_file_unmap(ept->context, &file->bytes);
}

// ---- Records

/// Gets records that lie one after the other.
typedef void visit(void *user, const uint8_t *records, uint64_t count);

static void fail(ewa_octree_result *result, const char *fault) {
    result->status = EWA_ERROR_FORMAT;
    result->fault = fault;
}

/// Visits the records of a node's file chunk by chunk.
static void visit_laz(const ewa_ept *ept, const ewa_ept_file *file, uint32_t worker, visit *visitor,
                      void *user, ewa_octree_result *result) {
    const ewa_laz_layout *layout = &file->layout;
    ewa_buffer *records = &ept->records[worker];
    for (uint64_t i = 0; i < layout->chunk_count && result->status == EWA_OK; i++) {
        const ewa_laz_chunk *chunk = &layout->chunks[i];
        ewa_laz_result decoded;
        result->status =
            ewa_buffer_reserve(ept->context, records, chunk->point_count, ept->table.record_bytes);
        if (result->status == EWA_OK)
            result->status = ewa_laz_decode(
                ept->context, &layout->plan, file->bytes.bytes + layout->at_bytes[i], chunk->size_bytes,
                chunk->point_count, records->data, &ept->memories[worker], &decoded);
        if (result->status != EWA_OK) return;
        if (decoded.fault)
            fail(result, decoded.fault);
        else
            visitor(user, records->data, chunk->point_count);
    }
}

static void visit_zstandard(const ewa_ept *ept, const ewa_ept_file *file, uint64_t point_count,
                            uint32_t worker, visit *visitor, void *user, ewa_octree_result *result) {
    ewa_buffer *records = &ept->records[worker];
    const size_t wanted = (size_t)(point_count * ept->table.record_bytes);
    result->status = ewa_buffer_reserve(ept->context, records, wanted, 1);
    if (result->status != EWA_OK) return;
    size_t got = 0;
    const char *wrong = ewa_zstandard_unpack(file->bytes.bytes, file->bytes.size_bytes, records->data, wanted, &got);
    if (wrong)
        fail(result, wrong);
    else if (got != wanted)
        fail(result, "its file unpacks to fewer points");
    else
        visitor(user, records->data, point_count);
}

static void visit_file(const ewa_ept *ept, const ewa_ept_file *file, uint64_t point_count, uint32_t worker,
                       visit *visitor, void *user, ewa_octree_result *result) {
    if (ept->encoding == EWA_EPT_LASZIP)
        visit_laz(ept, file, worker, visitor, user, result);
    else if (ept->encoding == EWA_EPT_ZSTANDARD)
        visit_zstandard(ept, file, point_count, worker, visitor, user, result);
    else
        visitor(user, file->bytes.bytes, point_count);
}

/// Where the records of a node go.
typedef struct unpacking {
    const ewa_las_table *table;
    const ewa_cloud_sink *sinks;
    uint64_t point_count, above_count; ///< so far
} unpacking;

static void unpack(void *user, const uint8_t *records, uint64_t count) {
    unpacking *u = user;
    ewa_cloud_sink sinks[EWA_LAS_MAX_COLUMNS];
    for (uint32_t i = 0; i < u->table->column_count; i++) {
        sinks[i] = u->sinks[i];
        if (sinks[i].to) sinks[i].to += u->point_count * sinks[i].stride_bytes;
    }
    u->above_count += ewa_las_unpack(u->table, records, count, sinks);
    u->point_count += count;
}

static void read_node(ewa_octree *octree, const ewa_octree_node *node, uint32_t slot, uint32_t worker,
                      const ewa_cloud_sink *sinks, ewa_octree_result *result) {
    const ewa_ept *ept = octree->state;
    unpacking u = {.table = &ept->table, .sinks = sinks};
    visit_file(ept, &ept->files[slot], node->point_count, worker, unpack, &u, result);
    result->above_count = u.above_count;
}

static ewa_status begin_wave(ewa_octree *octree, const uint32_t *indices, uint32_t count) {
    ewa_ept *ept = octree->state;
    for (uint32_t i = 0; i < count; i++)
        EWA_TRY(open_file(octree, &octree->facts.nodes[indices[i]], false, &ept->files[i]));
    return EWA_OK;
}

static void end_wave(ewa_octree *octree) {
    ewa_ept *ept = octree->state;
    for (uint32_t i = 0; i < EWA_OCTREE_WAVE; i++) close_file(ept, &ept->files[i]);
}

// ---- The tree

/// Opens the first of the nodes of the lowest level, whose records all others are like.
static ewa_status look_at_first(ewa_octree *octree) {
    ewa_ept *ept = octree->state;
    const ewa_octree_node *nodes = octree->nodes.data, *first = NULL;
    for (uint64_t i = 0; i < octree->node_count; i++)
        if (!first || ewa_octree_key_compare(&nodes[i].key, &first->key) < 0) first = &nodes[i];
    if (!first)
        return ewa_fail(ept->context, EWA_ERROR_UNSUPPORTED, "%s: EPT of LAZ without points", octree->path);
    const ewa_status status = open_file(octree, first, true, &ept->files[0]);
    close_file(ept, &ept->files[0]);
    return status;
}

static void look_at(void *user, const uint8_t *records, uint64_t count) { ewa_las_look(user, records, count); }

/// Looks at the colours of some nodes and chooses their type for all.
static ewa_status choose_colors(ewa_octree *octree) {
    ewa_ept *ept = octree->state;
    ewa_las_table *table = &ept->table;
    if (table->color_at == table->column_count || octree->node_count == 0) return EWA_OK;
    const ewa_octree_node *nodes = octree->nodes.data;
    const uint32_t maximum = octree->node_count < SAMPLE_NODES ? (uint32_t)octree->node_count : SAMPLE_NODES;
    ewa_las_color_look look = {.color = &table->columns[table->color_at],
                               .record_bytes = table->record_bytes};
    bool is_all = maximum == octree->node_count;
    uint64_t bytes = 0;
    ewa_status status = EWA_OK;
    // What cannot be read is said when it is wanted.
    ewa_failures_soften(ept->context, true);
    for (uint32_t i = 0; i < maximum && !look.is_wide && status == EWA_OK; i++) {
        const ewa_octree_node *node = &nodes[ewa_split(octree->node_count, maximum, i)];
        ewa_octree_result result = {0};
        bytes += node->point_count * table->record_bytes;
        if (i && bytes > SAMPLE_BYTES) {
            is_all = false;
            break;
        }
        result.status = open_file(octree, node, false, &ept->files[0]);
        if (result.status == EWA_OK)
            visit_file(ept, &ept->files[0], node->point_count, 0, look_at, &look, &result);
        is_all = is_all && result.status == EWA_OK;
        if (result.status == EWA_ERROR_MEMORY) status = result.status;
        close_file(ept, &ept->files[0]);
    }
    ewa_failures_soften(ept->context, false);
    const ewa_cloud_source source = {.context = ept->context, .name = octree->path};
    ewa_las_colors_choose(&source, &look, is_all, table);
    return status;
}

static ewa_status open_ept(ewa_octree *octree) {
    ewa_context *context = octree->context;
    ewa_ept *ept = ewa_allocate_zeroed(context, 1, sizeof *ept);
    octree->state = ept;
    if (!ept) return EWA_ERROR_MEMORY;
    ept->context = context;
    if (!find_folder(context, octree->path, ept->folder))
        return ewa_fail(context, EWA_ERROR_IO, "%s: no folder with an ept.json", octree->path);
    ept->worker_count = ewa_context_worker_count(context);
    ept->memories = ewa_allocate_zeroed(context, ept->worker_count, sizeof *ept->memories);
    ept->records = ewa_allocate_zeroed(context, ept->worker_count, sizeof *ept->records);
    if (!ept->memories || !ept->records) return EWA_ERROR_MEMORY;
    uint64_t said_count, point_count = 0;
    EWA_TRY(ewa_ept_describe(octree, ept, &said_count));
    EWA_TRY(ewa_ept_hierarchy(octree, ept));
    if (ept->encoding == EWA_EPT_LASZIP) EWA_TRY(look_at_first(octree));
    EWA_TRY(choose_colors(octree));
    for (uint64_t i = 0; i < octree->node_count; i++)
        point_count += ((const ewa_octree_node *)octree->nodes.data)[i].point_count;
    if (point_count != said_count)
        ewa_report(context, EWA_SEVERITY_WARNING, "%s: its nodes hold %llu points, \"points\" says %llu",
                   octree->path, (unsigned long long)point_count, (unsigned long long)said_count);
    return ewa_las_lay_out(&ept->table, ept->offset_world, octree->prototype);
}

static void close_ept(ewa_octree *octree) {
    ewa_ept *ept = octree->state;
    if (!ept) return;
    ewa_context *context = ept->context;
    for (uint32_t i = 0; i < ept->worker_count; i++) {
        if (ept->memories) ewa_laz_memory_free(context, &ept->memories[i]);
        if (ept->records) ewa_buffer_free(context, &ept->records[i]);
    }
    ewa_release(context, ept->memories, ept->worker_count, sizeof *ept->memories);
    ewa_release(context, ept->records, ept->worker_count, sizeof *ept->records);
    ewa_release(context, ept, 1, sizeof *ept);
}

const ewa_octree_format ewa_octree_ept = {.is = is_ept,
                                          .open = open_ept,
                                          .begin = begin_wave,
                                          .read = read_node,
                                          .end = end_wave,
                                          .close = close_ept};
