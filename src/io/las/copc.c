// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Reads the octree of COPC files page by page. Points are read as from any LAZ file, in the order of the
// chunks, so a damaged hierarchy costs a warning only.
#include "io/las/copc.h"
#include "io/octree.h"
#include "base/format.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

bool ewa_copc_is(const ewa_cloud_source *source, const ewa_las_header *header) {
    ewa_las_walk walk = {0};
    ewa_las_vlr vlr;
    return header->head_bytes == EWA_LAS_HEAD_14_BYTES && ewa_las_walk_next(source, header, &walk, &vlr) &&
           ewa_las_vlr_is(&vlr, "copc", 1) && vlr.size_bytes == EWA_COPC_INFO_BYTES;
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
    EWA_TRY(ewa_buffer_grow(context, &pages->buffer, pages->count, pages->count + 1, sizeof(page)));
    ((page *)pages->buffer.data)[pages->count++] = (page){at_bytes, size_bytes};
    return EWA_OK;
}

/// Keeps what is wrong first.
__attribute__((format(printf, 2, 3))) static void find_fault(ewa_copc_tree *tree, const char *format, ...) {
    if (tree->fault[0]) return;
    va_list arguments;
    va_start(arguments, format);
    ewa_format_list(tree->fault, sizeof tree->fault, format, arguments);
    va_end(arguments);
}

/// Whether an entry is a valid node of the tree.
static bool is_cube(const ewa_octree_key *key) {
    if (key->level < 0 || key->level >= EWA_OCTREE_LEVELS) return false;
    for (int c = 0; c < 3; c++)
        if (key->cell[c] < 0 || key->cell[c] >= (int64_t)1 << key->level) return false;
    return true;
}

/// Takes the entries of a page, whose own pages join the list.
static ewa_status read_page(const ewa_cloud_source *source, page p, page_list *pages, ewa_copc_tree *tree) {
    ewa_octree_node *nodes = tree->nodes.data;
    const uint8_t *bytes;
    EWA_TRY(ewa_cloud_need(source, p.at_bytes, p.size_bytes, &bytes));
    for (uint64_t i = 0; i < p.size_bytes / EWA_COPC_ENTRY_BYTES; i++) {
        const uint8_t *entry = bytes + i * EWA_COPC_ENTRY_BYTES;
        const int32_t point_count = (int32_t)ewa_bytes_u32(entry + 28), size = (int32_t)ewa_bytes_u32(entry + 24);
        ewa_octree_node node = {.key = {.level = (int32_t)ewa_bytes_u32(entry)},
                                .at_bytes = ewa_las_u64(entry + 16)};
        for (int c = 0; c < 3; c++) node.key.cell[c] = (int32_t)ewa_bytes_u32(entry + 4 + 4 * c);
        const ewa_octree_key *k = &node.key;
        if (point_count == 0) continue;
        if (point_count < -1 || size < 0 || !is_cube(k) || node.at_bytes > source->size_bytes ||
            (uint64_t)size > source->size_bytes - node.at_bytes) {
            find_fault(
                tree,
                "entry %d-%d-%d-%d of %d points is no node of the octree, or its %d bytes from byte %llu "
                "on lie beyond the file",
                k->level, k->cell[0], k->cell[1], k->cell[2], point_count, size,
                (unsigned long long)node.at_bytes);
            continue;
        }
        node.size_bytes = (uint64_t)size;
        node.point_count = (uint64_t)point_count;
        if (point_count == -1)
            EWA_TRY(push_page(source->context, pages, node.at_bytes, node.size_bytes));
        else
            nodes[tree->node_count++] = node;
    }
    return EWA_OK;
}

ewa_status ewa_copc_tree_read(const ewa_cloud_source *source, const ewa_las_header *header,
                              ewa_copc_tree *tree) {
    ewa_context *context = source->context;
    ewa_las_vlr info;
    *tree = (ewa_copc_tree){0};
    if (!ewa_las_find(source, header, "copc", 1, &info) || info.size_bytes < EWA_COPC_INFO_BYTES)
        return EWA_OK;
    for (int c = 0; c < 3; c++) tree->centre_world[c] = ewa_las_f64(info.bytes + 8 * c);
    tree->half_world = ewa_las_f64(info.bytes + 24);
    tree->spacing_world = ewa_las_f64(info.bytes + 32);
    page_list pages = {0};
    uint64_t left_bytes = source->size_bytes; // pages that lie in circles or over each other end with it
    ewa_status status =
        push_page(context, &pages, ewa_las_u64(info.bytes + 40), ewa_las_u64(info.bytes + 48));
    for (size_t i = 0; i < pages.count && status == EWA_OK; i++) {
        const page p = ((const page *)pages.buffer.data)[i];
        if (p.at_bytes > source->size_bytes || p.size_bytes > source->size_bytes - p.at_bytes ||
            p.size_bytes > left_bytes || p.size_bytes < EWA_COPC_ENTRY_BYTES) {
            find_fault(
                tree,
                "a page of %llu bytes from byte %llu on lies beyond the file, is empty, or comes again "
                "and again",
                (unsigned long long)p.size_bytes, (unsigned long long)p.at_bytes);
            continue;
        }
        left_bytes -= p.size_bytes;
        status =
            ewa_buffer_grow(context, &tree->nodes, tree->node_count,
                            tree->node_count + p.size_bytes / EWA_COPC_ENTRY_BYTES, sizeof(ewa_octree_node));
        if (status == EWA_OK) status = read_page(source, p, &pages, tree);
    }
    ewa_buffer_free(context, &pages.buffer);
    if (status != EWA_OK) ewa_copc_tree_free(context, tree);
    return status;
}

void ewa_copc_tree_free(ewa_context *context, ewa_copc_tree *tree) {
    ewa_buffer_free(context, &tree->nodes);
    *tree = (ewa_copc_tree){0};
}

ewa_status ewa_copc_note(const ewa_cloud_source *source, const ewa_las_header *header, ewa_cloud *prototype) {
    if (!ewa_copc_is(source, header)) return EWA_OK;
    ewa_copc_tree tree;
    EWA_TRY(ewa_copc_tree_read(source, header, &tree));
    const ewa_octree_node *nodes = tree.nodes.data;
    uint64_t point_count = 0;
    int32_t levels = 0;
    for (size_t i = 0; i < tree.node_count; i++) {
        point_count += nodes[i].point_count;
        if (nodes[i].key.level >= levels) levels = nodes[i].key.level + 1;
    }
    if (point_count != header->point_count)
        find_fault(&tree, "its nodes hold %llu points, the header counts %llu",
                   (unsigned long long)point_count, (unsigned long long)header->point_count);
    if (tree.fault[0])
        ewa_report(source->context, EWA_SEVERITY_WARNING, "%s: the hierarchy of COPC is damaged: %s",
                   source->name, tree.fault);
    char text[96];
    ewa_format(text, sizeof text, "COPC 1.0, spacing %g, %d levels, %zu nodes", tree.spacing_world, levels,
             tree.node_count);
    ewa_copc_tree_free(source->context, &tree);
    return ewa_cloud_set_note(prototype, "file.copc", text, strlen(text));
}
