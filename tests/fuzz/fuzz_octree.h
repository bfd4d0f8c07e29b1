// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the fuzz targets of octrees share: what opens is a tree in order, whose nodes can be read one by one and
// together.
#ifndef EWA_TESTS_FUZZ_OCTREE_H
#define EWA_TESTS_FUZZ_OCTREE_H

#include "fuzz_cloud.h"
#include "io/octree.h"

static inline void fuzz_octree_facts(const ewa_octree *octree, const ewa_octree_facts *facts) {
    uint64_t point_count = 0;
    fuzz_require(facts->side_world > 0 && facts->spacing_world > 0, "a root of some size");
    for (uint32_t i = 0; i < facts->node_count; i++) {
        const ewa_octree_node *node = &facts->nodes[i];
        fuzz_require(i == 0 || ewa_octree_key_compare(&node[-1].key, &node->key) < 0, "nodes in order");
        fuzz_require(node->point_count > 0, "nodes of points");
        fuzz_require(ewa_octree_find(octree, &node->key) == i, "nodes that are found");
        point_count += node->point_count;
    }
    fuzz_require(point_count == facts->point_count, "the sum of all nodes");
}

static inline ewa_status fuzz_octree_nodes(ewa_octree *octree, const ewa_octree_facts *facts) {
    enum { MAX_NODES = 64 };
    uint32_t indices[MAX_NODES] = {0}, count = 0;
    ewa_cloud *clouds[MAX_NODES], *alone = NULL;
    for (; count < facts->node_count && count < MAX_NODES; count++) indices[count] = count;
    ewa_status status = ewa_octree_read(octree, indices, count, NULL, clouds);
    for (uint32_t i = 0; i < count; i++) {
        fuzz_require((clouds[i] != NULL) == (status == EWA_OK), "all clouds or none");
        if (clouds[i])
            fuzz_require(ewa_cloud_point_count(clouds[i]) == facts->nodes[i].point_count,
                         "as many points as are said");
        ewa_cloud_destroy(&clouds[i]);
    }
    if (status == EWA_OK && count) status = ewa_octree_read(octree, indices, 1, "intensity", &alone);
    ewa_cloud_destroy(&alone);
    return status;
}

/// Opens and reads the tree at a path by a context whose messages are counted, and destroys that; `size_bytes` is what its levels lie
/// within.
static inline ewa_status fuzz_octree_by(ewa_context *context, const int *counted, const char *path, size_t size_bytes) {
    ewa_octree *octree = NULL;
    ewa_octree_is(context, path);
    fuzz_require(*counted == 0, "no word about what a file is not");
    ewa_status status = ewa_octree_open(context, path, &octree);
    fuzz_require((status == EWA_OK) == (octree != NULL), "a tree on success only");
    if (status == EWA_OK) {
        const ewa_octree_facts *facts = ewa_octree_describe(octree);
        fuzz_octree_facts(octree, facts);
        fuzz_require(facts->levels_bytes <= size_bytes, "levels within the file");
        status = fuzz_octree_nodes(octree, facts);
    }
    fuzz_require((status == EWA_OK) == (*counted == 0), "a message on failure only");
    ewa_octree_close(&octree);
    ewa_context_destroy(&context);
    return status;
}

static inline ewa_status fuzz_octree(const char *path, size_t size_bytes) {
    int errors = 0;
    return fuzz_octree_by(fuzz_context(1, 1 << 22, &errors), &errors, path, size_bytes);
}

#endif
