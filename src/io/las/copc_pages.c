// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Shares the nodes of an octree out to pages: level by level, a node's children go into its own page while that has
// room, else the node becomes the root of a page of its own.
#include "io/las/copc.h"
#include "io/las/copc_write.h"

#include <stdlib.h>
#include <string.h>

enum { PAGE_ENTRIES = 1000, NO_PAGE = -1 };

/// What is known of one node of the tree.
typedef struct place {
    uint64_t parent;
    uint32_t child_count;
    int64_t page;         ///< of its entry
    int64_t page_of_link; ///< of the entry that leads to `page`, whose root the node is; NO_PAGE: none does
    int64_t page_of_children;
} place;

typedef struct page {
    uint64_t first_entry, entry_count;
    uint64_t put_count; ///< of them
} page;

static int compare_nodes(const void *a, const void *b) {
    const ewa_octree_node *left = a, *right = b;
    return ewa_octree_key_compare(&left->key, &right->key);
}

static ewa_octree_key parent_of(const ewa_octree_key *key) {
    return (ewa_octree_key){key->level - 1, {key->cell[0] / 2, key->cell[1] / 2, key->cell[2] / 2}};
}

static ewa_octree_node *find(const ewa_octree_node *nodes, uint64_t count, const ewa_octree_key *key) {
    const ewa_octree_node wanted = {.key = *key};
    return bsearch(&wanted, nodes, count, sizeof *nodes, compare_nodes);
}

/// Puts nodes in order and leaves one of each key; returns how many there are.
static uint64_t sort(ewa_octree_node *nodes, uint64_t count) {
    qsort(nodes, count, sizeof *nodes, compare_nodes);
    uint64_t kept = 0;
    for (uint64_t i = 0; i < count; i++)
        if (kept == 0 || compare_nodes(&nodes[kept - 1], &nodes[i]) != 0) nodes[kept++] = nodes[i];
    return kept;
}

/// Adds the parents that are missing, and theirs, up to the root.
static ewa_status add_parents(ewa_context *context, ewa_buffer *buffer, uint64_t *count) {
    for (bool added = true; added;) {
        *count = sort(buffer->data, *count);
        const uint64_t sorted_count = *count;
        added = false;
        for (uint64_t i = 0; i < sorted_count; i++) {
            const ewa_octree_node *nodes = buffer->data;
            if (nodes[i].key.level == 0) continue;
            const ewa_octree_node parent = {.key = parent_of(&nodes[i].key)};
            if (find(nodes, sorted_count, &parent.key)) continue;
            EWA_TRY(ewa_buffer_grow(context, buffer, *count, *count + 1, sizeof parent));
            ((ewa_octree_node *)buffer->data)[(*count)++] = parent;
            added = true;
        }
    }
    return EWA_OK;
}

/// Gives each node its page. `pages` has room for as many as there are nodes; returns how many there are.
static uint64_t share_out(const ewa_octree_node *nodes, uint64_t count, place *places, page *pages) {
    for (uint64_t i = 1; i < count; i++) {
        const ewa_octree_key key = parent_of(&nodes[i].key);
        places[i].parent = (uint64_t)(find(nodes, count, &key) - nodes);
        places[places[i].parent].child_count++;
    }
    uint64_t page_count = 1;
    pages[0].entry_count = 1;
    for (uint64_t i = 0; i < count; i++) {
        place *at = &places[i];
        at->page = i ? places[at->parent].page_of_children : 0;
        at->page_of_link = NO_PAGE;
        if (pages[at->page].entry_count + at->child_count > PAGE_ENTRIES && at->child_count) {
            at->page_of_link = at->page;
            at->page = (int64_t)page_count;
            pages[page_count++].entry_count = 1;
        }
        at->page_of_children = at->page;
        pages[at->page].entry_count += at->child_count;
    }
    for (uint64_t p = 1; p < page_count; p++)
        pages[p].first_entry = pages[p - 1].first_entry + pages[p - 1].entry_count;
    return page_count;
}

static void put_entry(uint8_t *bytes, page *p, const ewa_octree_key *key, uint64_t at_bytes,
                      uint64_t size_bytes, int32_t point_count) {
    uint8_t *to = bytes + (p->first_entry + p->put_count++) * EWA_COPC_ENTRY_BYTES;
    ewa_las_put_u32(to, (uint32_t)key->level);
    for (int c = 0; c < 3; c++) ewa_las_put_u32(to + 4 + 4 * c, (uint32_t)key->cell[c]);
    ewa_las_put_u64(to + 16, at_bytes);
    ewa_las_put_u32(to + 24, (uint32_t)size_bytes);
    ewa_las_put_u32(to + 28, (uint32_t)point_count);
}

/// Makes the pages for nodes in order, all of whose parents are among them.
static ewa_status make(ewa_context *context, const ewa_octree_node *nodes, uint64_t count, uint64_t at_bytes,
                       ewa_copc_pages *made) {
    place *places = ewa_allocate_zeroed(context, count, sizeof *places);
    page *pages = places ? ewa_allocate_zeroed(context, count, sizeof *pages) : NULL;
    ewa_status status = pages ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) {
        const uint64_t page_count = share_out(nodes, count, places, pages);
        const page *last = &pages[page_count - 1];
        made->root_bytes = pages[0].entry_count * EWA_COPC_ENTRY_BYTES;
        made->size_bytes = (last->first_entry + last->entry_count) * EWA_COPC_ENTRY_BYTES;
        status = ewa_buffer_reserve(context, &made->bytes, made->size_bytes, 1);
    }
    for (uint64_t i = 0; i < count && status == EWA_OK; i++) {
        const ewa_octree_node *node = &nodes[i];
        page *own = &pages[places[i].page];
        put_entry(made->bytes.data, own, &node->key, node->at_bytes, node->size_bytes,
                  (int32_t)node->point_count);
        if (places[i].page_of_link != NO_PAGE)
            put_entry(made->bytes.data, &pages[places[i].page_of_link], &node->key,
                      at_bytes + own->first_entry * EWA_COPC_ENTRY_BYTES,
                      own->entry_count * EWA_COPC_ENTRY_BYTES, -1);
    }
    ewa_release(context, pages, count, sizeof *pages);
    ewa_release(context, places, count, sizeof *places);
    return status;
}

ewa_status ewa_copc_pages_make(ewa_context *context, const ewa_octree_node *nodes, uint64_t node_count,
                               uint64_t at_bytes, ewa_copc_pages *pages) {
    ewa_buffer buffer = {0};
    uint64_t count = node_count ? node_count : 1;
    ewa_status status = ewa_buffer_reserve(context, &buffer, count, sizeof *nodes);
    if (status == EWA_OK) {
        if (node_count)
            memcpy(buffer.data, nodes, node_count * sizeof *nodes);
        else
            *(ewa_octree_node *)buffer.data = (ewa_octree_node){0};
        status = add_parents(context, &buffer, &count);
    }
    if (status == EWA_OK) status = make(context, buffer.data, count, at_bytes, pages);
    ewa_buffer_free(context, &buffer);
    return status;
}
