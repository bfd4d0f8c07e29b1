// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Reads the octree of COPC files page by page. Points are read as from any LAZ file, in the order of the
// chunks, so a damaged hierarchy costs a warning only.
#include "io/las/copc.h"
#include "base/base.h"

#include <stdio.h>
#include <string.h>

enum { INFO_BYTES = 160, ENTRY_BYTES = 32, MOST_LEVELS = 31 };

bool ewa_copc_is(const ewa_cloud_source *source, const ewa_las_header *header) {
    ewa_las_walk walk = {0};
    ewa_las_vlr vlr;
    return header->head_bytes == EWA_LAS_HEAD_14_BYTES && ewa_las_walk_next(source, header, &walk, &vlr) &&
           ewa_las_vlr_is(&vlr, "copc", 1) && vlr.size_bytes == INFO_BYTES;
}

/// A page of the hierarchy that is still to be read.
typedef struct page {
    uint64_t at_bytes, size_bytes;
} page;

typedef struct page_list {
    ewa_buffer buffer;
    size_t count;
} page_list;

static ewa_status push_page(ewa_context *context, page_list *pages, uint64_t at_bytes, uint64_t size_bytes) {
    const ewa_status status =
        ewa_buffer_grow(context, &pages->buffer, pages->count, pages->count + 1, sizeof(page));
    if (status == EWA_OK) ((page *)pages->buffer.data)[pages->count++] = (page){at_bytes, size_bytes};
    return status;
}

/// Whether an entry is a cube of the tree whose chunk lies within the file.
static bool is_node(const ewa_cloud_source *source, const ewa_copc_node *node) {
    if (node->level < 0 || node->level >= MOST_LEVELS) return false;
    for (int c = 0; c < 3; c++)
        if (node->cell[c] < 0 || node->cell[c] >= (int64_t)1 << node->level) return false;
    return node->at_bytes <= source->size_bytes && node->size_bytes <= source->size_bytes - node->at_bytes;
}

/// Takes the entries of a page, whose own pages join the list.
static ewa_status read_page(const ewa_cloud_source *source, page p, page_list *pages, ewa_copc_node *nodes,
                            size_t *node_count, const char **fault) {
    ewa_status status = EWA_OK;
    for (uint64_t i = 0; i < p.size_bytes / ENTRY_BYTES && status == EWA_OK; i++) {
        const uint8_t *entry = source->bytes + p.at_bytes + i * ENTRY_BYTES;
        const int32_t point_count = (int32_t)ewa_las_u32(entry + 28);
        ewa_copc_node node = {.level = (int32_t)ewa_las_u32(entry),
                              .at_bytes = ewa_las_u64(entry + 16),
                              .size_bytes = ewa_las_u32(entry + 24)};
        for (int c = 0; c < 3; c++) node.cell[c] = (int32_t)ewa_las_u32(entry + 4 + 4 * c);
        if (point_count == 0) continue;
        if (point_count < -1 || !is_node(source, &node)) {
            *fault = "an entry is no cube of the octree or lies beyond the file";
        } else if (point_count == -1) {
            status = push_page(source->context, pages, node.at_bytes, node.size_bytes);
        } else {
            node.point_count = (uint32_t)point_count;
            nodes[(*node_count)++] = node;
        }
    }
    return status;
}

ewa_status ewa_copc_tree_read(const ewa_cloud_source *source, const ewa_las_header *header,
                              ewa_copc_tree *tree, const char **fault) {
    ewa_context *context = source->context;
    ewa_las_vlr info;
    *tree = (ewa_copc_tree){0};
    *fault = NULL;
    if (!ewa_las_find(source, header, "copc", 1, &info) || info.size_bytes < INFO_BYTES) return EWA_OK;
    tree->spacing_world = ewa_las_f64(info.bytes + 32);
    page_list pages = {0};
    ewa_buffer nodes = {0};
    uint64_t left_bytes = source->size_bytes; // pages that lie in circles or over each other end with it
    ewa_status status =
        push_page(context, &pages, ewa_las_u64(info.bytes + 40), ewa_las_u64(info.bytes + 48));
    for (size_t i = 0; i < pages.count && status == EWA_OK; i++) {
        const page p = ((const page *)pages.buffer.data)[i];
        if (p.at_bytes > source->size_bytes || p.size_bytes > source->size_bytes - p.at_bytes ||
            p.size_bytes > left_bytes || p.size_bytes < ENTRY_BYTES) {
            *fault = "a page lies beyond the file, is empty, or comes again and again";
            continue;
        }
        left_bytes -= p.size_bytes;
        status = ewa_buffer_grow(context, &nodes, tree->node_count,
                                 tree->node_count + p.size_bytes / ENTRY_BYTES, sizeof *tree->nodes);
        if (status == EWA_OK) status = read_page(source, p, &pages, nodes.data, &tree->node_count, fault);
    }
    ewa_buffer_free(context, &pages.buffer);
    tree->nodes = nodes.data;
    tree->capacity_bytes = nodes.capacity_bytes;
    if (status != EWA_OK) ewa_copc_tree_free(context, tree);
    return status;
}

void ewa_copc_tree_free(ewa_context *context, ewa_copc_tree *tree) {
    ewa_buffer nodes = {tree->nodes, tree->capacity_bytes};
    ewa_buffer_free(context, &nodes);
    *tree = (ewa_copc_tree){0};
}

ewa_status ewa_copc_note(const ewa_cloud_source *source, const ewa_las_header *header, ewa_cloud *prototype) {
    if (!ewa_copc_is(source, header)) return EWA_OK;
    ewa_copc_tree tree;
    const char *fault;
    ewa_status status = ewa_copc_tree_read(source, header, &tree, &fault);
    if (status != EWA_OK) return status;
    uint64_t point_count = 0;
    int32_t levels = 0;
    for (size_t i = 0; i < tree.node_count; i++) {
        point_count += tree.nodes[i].point_count;
        if (tree.nodes[i].level >= levels) levels = tree.nodes[i].level + 1;
    }
    if (!fault && point_count != header->point_count) fault = "its nodes do not hold the header's points";
    if (fault)
        ewa_report(source->context, EWA_SEVERITY_WARNING, "%s: the hierarchy of COPC is damaged: %s",
                   source->name, fault);
    char text[96];
    snprintf(text, sizeof text, "COPC 1.0, spacing %g, %d levels, %zu nodes", tree.spacing_world, levels,
             tree.node_count);
    ewa_copc_tree_free(source->context, &tree);
    return ewa_cloud_set_note(prototype, "file.copc", text, strlen(text));
}
