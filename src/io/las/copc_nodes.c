// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// COPC files by nodes: each is a chunk of LAZ that a worker decodes into the streams of a cloud.
#include "base/base.h"
#include "base/platform.h"
#include "io/file.h"
#include "io/las/copc.h"
#include "io/las/las_open.h"
#include "io/levels.h"
#include "io/octree_format.h"

#include <math.h>
#include <string.h>

enum {
    /// Bytes by which a file shows that it is COPC: the header, and the head of the record behind it.
    MAGIC_BYTES = EWA_LAS_HEAD_14_BYTES + EWA_LAS_RECORD_BYTES,
    /// No point takes less than 1 / 2048 byte: the arithmetic coder's surest symbol costs more.
    MAX_POINTS_PER_BYTE = 2048,
};

typedef struct copc_state {
    ewa_file bytes; ///< without the nodes, where these are read piece by piece
    int descriptor; ///< which they are read from; -1: from `bytes`
    uint32_t held_count; ///< parts of a file that comes in parts, beside those of a wave
    ewa_cloud_source source;
    ewa_cloud_load_options options;
    uint64_t lost_count;
    ewa_las_file file;
    uint32_t worker_count;
    ewa_laz_memory **memories; ///< one per worker
    ewa_buffer *records;       ///< one per worker
} copc_state;

static bool is_copc(ewa_context *context, const char *path) {
    uint8_t bytes[MAGIC_BYTES];
    const bool there = ewa_file_head(context, path, bytes, sizeof bytes) == sizeof bytes;
    const uint8_t *record = bytes + EWA_LAS_HEAD_14_BYTES;
    return there && memcmp(bytes, "LASF", 4) == 0 && ewa_las_u16(bytes + 94) == EWA_LAS_HEAD_14_BYTES &&
           ewa_bytes_u32(bytes + 100) > 0 && strncmp((const char *)record + 2, "copc", 16) == 0 &&
           ewa_las_u16(record + 18) == 1 && ewa_las_u16(record + 20) == EWA_COPC_INFO_BYTES;
}

static void close_copc(ewa_octree *octree) {
    copc_state *state = octree->state;
    if (!state) return;
    ewa_context *context = octree->context;
    for (uint32_t i = 0; i < state->worker_count; i++) {
        if (state->memories) ewa_laz_memory_free(context, &state->memories[i]);
        if (state->records) ewa_buffer_free(context, &state->records[i]);
    }
    ewa_release(context, state->memories, state->worker_count, sizeof *state->memories);
    ewa_release(context, state->records, state->worker_count, sizeof *state->records);
    ewa_las_file_close(&state->file);
    if (state->descriptor >= 0) ewa_platform_close(state->descriptor);
    ewa_file_unmap(context, &state->bytes);
    ewa_ranges_close(&state->source.ranges);
    ewa_release(context, state, 1, sizeof *state);
}

/// Takes the nodes of the hierarchy and what is said of the root.
static ewa_status take_tree(ewa_octree *octree, const copc_state *state, const ewa_copc_tree *tree) {
    ewa_octree_facts *facts = &octree->facts;
    const ewa_octree_node *nodes = tree->nodes.data;
    if (tree->fault[0])
        return ewa_fail(octree->context, EWA_ERROR_FORMAT, "%s: the hierarchy of COPC is damaged: %s",
                        octree->path, tree->fault);
    const double *centre = tree->centre_world;
    if (!(tree->half_world > 0) || !isfinite(tree->half_world) || !(tree->spacing_world > 0) ||
        !isfinite(tree->spacing_world) || !isfinite(centre[0]) || !isfinite(centre[1]) ||
        !isfinite(centre[2]))
        return ewa_fail(octree->context, EWA_ERROR_FORMAT,
                        "%s: the root of COPC has half a side of %g about (%g, %g, %g) and a spacing of %g",
                        octree->path, tree->half_world, centre[0], centre[1], centre[2], tree->spacing_world);
    facts->kind = "COPC 1.0";
    facts->side_world = 2 * tree->half_world;
    facts->spacing_world = tree->spacing_world;
    for (int c = 0; c < 3; c++) {
        facts->low_world[c] = centre[c] - tree->half_world;
        facts->bounds.low_world[c] = state->file.header.low[c];
        facts->bounds.high_world[c] = state->file.header.high[c];
    }
    facts->bounds.finite_count = state->file.header.point_count;
    const uint64_t max_bytes = ewa_context_limits(octree->context)->max_memory_bytes;
    for (size_t i = 0; i < tree->node_count; i++) {
        const ewa_octree_node *node = &nodes[i];
        const ewa_octree_key *k = &node->key;
        if (node->point_count / MAX_POINTS_PER_BYTE > node->size_bytes)
            return ewa_fail(octree->context, EWA_ERROR_FORMAT,
                            "%s: node %d-%d-%d-%d is said to hold %llu points in %llu bytes", octree->path,
                            k->level, k->cell[0], k->cell[1], k->cell[2],
                            (unsigned long long)node->point_count, (unsigned long long)node->size_bytes);
        if (node->point_count > max_bytes / state->file.header.record_bytes)
            return ewa_fail(octree->context, EWA_ERROR_LIMIT,
                            "%s: node %d-%d-%d-%d, %llu points, is over the limit of %llu bytes",
                            octree->path, k->level, k->cell[0], k->cell[1], k->cell[2],
                            (unsigned long long)node->point_count, (unsigned long long)max_bytes);
        EWA_TRY(ewa_octree_add(octree, node));
    }
    return EWA_OK;
}

/// Finds the levels among the extended records, and reads their table.
static ewa_status find_levels(ewa_octree *octree, const copc_state *state) {
    const ewa_cloud_source *source = &state->source;
    ewa_las_walk walk = {0};
    ewa_las_vlr vlr;
    while (ewa_las_walk_next(source, &state->file.header, &walk, &vlr)) {
        if (!vlr.extended || !ewa_las_vlr_is(&vlr, EWA_COPC_LEVELS_USER, EWA_COPC_LEVELS_ID)) continue;
        octree->facts.levels_at_bytes = vlr.at_bytes;
        octree->facts.levels_bytes = vlr.size_bytes;
        const uint8_t *head;
        const uint64_t head_bytes = vlr.size_bytes < EWA_LEVELS_HEAD_BYTES ? vlr.size_bytes : EWA_LEVELS_HEAD_BYTES;
        EWA_TRY(ewa_cloud_need(source, vlr.at_bytes, head_bytes, &head));
        return ewa_cloud_need(source, vlr.at_bytes, ewa_levels_table_bytes(head, vlr.size_bytes), &octree->facts.levels);
    }
    return EWA_OK;
}

/// Lets go of the nodes' bytes, most of the file, so that files larger than the room for addresses can be drawn.
static void give_up_nodes(ewa_octree *octree, copc_state *state) {
    if (!state->bytes.mapped) return;
    uint64_t first = UINT64_MAX, end = 0;
    for (uint64_t i = 0; i < octree->node_count; i++) {
        const ewa_octree_node *node = (const ewa_octree_node *)octree->nodes.data + i;
        if (!node->size_bytes) continue;
        if (node->at_bytes < first) first = node->at_bytes;
        if (node->at_bytes + node->size_bytes > end) end = node->at_bytes + node->size_bytes;
    }
    const uint8_t *levels = octree->facts.levels, *bytes = state->bytes.bytes;
    const bool amid = levels && levels < bytes + end && levels + octree->facts.levels_bytes > bytes + first;
    if (end <= first || amid) return;
    state->descriptor = ewa_file_open_pieces(octree->path, state->bytes.size_bytes);
    if (state->descriptor >= 0) ewa_file_give_up(&state->bytes, first, end);
}

static ewa_status open_copc(ewa_octree *octree) {
    ewa_context *context = octree->context;
    copc_state *state = ewa_allocate_zeroed(context, 1, sizeof *state);
    octree->state = state;
    if (!state) return EWA_ERROR_MEMORY;
    state->descriptor = -1;
    ewa_ranges *ranges;
    EWA_TRY(ewa_ranges_open(context, octree->path, &ranges));
    state->source.ranges = ranges;
    if (!ranges) EWA_TRY(ewa_file_map(context, octree->path, &state->bytes));
    ewa_cloud_load_options_init(&state->options, sizeof state->options);
    state->source = (ewa_cloud_source){.context = context,
                                       .name = octree->path,
                                       .path = octree->path,
                                       .bytes = state->bytes.bytes,
                                       .size_bytes = ranges ? ewa_ranges_size_bytes(ranges) : state->bytes.size_bytes,
                                       .ranges = ranges,
                                       .options = &state->options,
                                       .lost_count = &state->lost_count};
    EWA_TRY(ewa_las_file_open(&state->source, octree->prototype, &state->file));
    if (!state->file.header.compressed || !ewa_copc_is(&state->source, &state->file.header))
        return ewa_fail(context, EWA_ERROR_FORMAT,
                        "%s: the points of COPC are compressed as LAZ, these are not", octree->path);
    // The chunks that were looked at for colours are not what nodes are read from.
    ewa_laz_stream_close(state->file.stream);
    state->file.stream = NULL;
    state->worker_count = ewa_context_worker_count(context);
    state->memories = ewa_allocate_zeroed(context, state->worker_count, sizeof *state->memories);
    state->records = ewa_allocate_zeroed(context, state->worker_count, sizeof *state->records);
    if (!state->memories || !state->records) return EWA_ERROR_MEMORY;
    ewa_copc_tree tree;
    EWA_TRY(ewa_copc_tree_read(&state->source, &state->file.header, &tree));
    ewa_status status = take_tree(octree, state, &tree);
    ewa_copc_tree_free(context, &tree);
    if (status == EWA_OK) status = find_levels(octree, state);
    if (status == EWA_OK) give_up_nodes(octree, state);
    if (ranges) state->held_count = ewa_ranges_count(ranges);
    return status;
}

/// Reads the bytes of a wave's nodes, or of levels, of a file that comes in parts.
static ewa_status need_parts(ewa_octree *octree, ewa_range *parts, uint32_t count) {
    copc_state *state = octree->state;
    return state->source.ranges ? ewa_ranges_need_all(state->source.ranges, parts, count) : EWA_OK;
}

static ewa_status begin_wave(ewa_octree *octree, const uint32_t *indices, uint32_t count) {
    ewa_range parts[EWA_OCTREE_WAVE];
    for (uint32_t i = 0; i < count; i++) {
        const ewa_octree_node *node = &octree->facts.nodes[indices[i]];
        parts[i] = (ewa_range){node->at_bytes, node->size_bytes};
    }
    return need_parts(octree, parts, count);
}

static void end_wave(ewa_octree *octree) {
    copc_state *state = octree->state;
    if (state->source.ranges) ewa_ranges_let_go(state->source.ranges, state->held_count);
}

static const uint8_t *find_part(const ewa_octree *octree, const ewa_range *part) {
    const copc_state *state = octree->state;
    return ewa_cloud_find_bytes(&state->source, part->at_bytes, part->size_bytes);
}

/// Decodes a node's bytes to records.
static ewa_status decode_node(const ewa_octree *octree, const copc_state *state, const ewa_octree_node *node,
                              uint32_t worker, ewa_laz_result *decoded) {
    ewa_file piece = {0};
    const uint8_t *bytes = ewa_cloud_find_bytes(&state->source, node->at_bytes, node->size_bytes);
    if (state->descriptor >= 0 && node->size_bytes &&
        !ewa_file_piece_map(state->descriptor, node->at_bytes, node->size_bytes, &piece, &bytes)) {
        decoded->fault = "its bytes cannot be mapped";
        return EWA_OK;
    }
    const ewa_status status =
        ewa_laz_decode(octree->context, &state->file.layout.plan, bytes, node->size_bytes, node->point_count,
                       state->records[worker].data, &state->memories[worker], decoded);
    ewa_file_unmap(octree->context, &piece);
    return status;
}

static void read_node(ewa_octree *octree, const ewa_octree_node *node, uint32_t slot, uint32_t worker,
                      const ewa_cloud_sink *sinks, ewa_octree_result *result) {
    (void)slot;
    copc_state *state = octree->state;
    ewa_buffer *records = &state->records[worker];
    ewa_laz_result decoded = {0};
    result->status =
        ewa_buffer_reserve(octree->context, records, node->point_count, state->file.table.record_bytes);
    if (result->status != EWA_OK) return;
    result->status = decode_node(octree, state, node, worker, &decoded);
    if (result->status != EWA_OK) return;
    result->fault = decoded.fault;
    if (decoded.fault)
        result->status = EWA_ERROR_FORMAT;
    else
        result->above_count = ewa_las_unpack(&state->file.table, records->data, node->point_count, sinks);
}

const ewa_octree_format ewa_octree_copc = {.is = is_copc,
                                           .open = open_copc,
                                           .begin = begin_wave,
                                           .read = read_node,
                                           .end = end_wave,
                                           .need = need_parts,
                                           .find = find_part,
                                           .close = close_copc};
