// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target of COPC by nodes: any bytes may be the file; what opens is a tree in order, whose nodes can be read one by
// one and together.
#define _GNU_SOURCE // memfd_create
#include "fuzz_cloud.h"
#include "io/octree.h"

#include <sys/mman.h>
#include <unistd.h>

enum { MOST_NODES = 64 };

static void check_facts(const ewa_octree *octree, const ewa_octree_facts *facts, size_t size_bytes) {
    uint64_t point_count = 0;
    fuzz_require(facts->side_world > 0 && facts->spacing_world > 0, "a root of some size");
    fuzz_require(facts->levels_bytes <= size_bytes, "levels within the file");
    for (uint32_t i = 0; i < facts->node_count; i++) {
        const ewa_octree_node *node = &facts->nodes[i];
        fuzz_require(i == 0 || ewa_octree_key_compare(&node[-1].key, &node->key) < 0, "nodes in order");
        fuzz_require(node->point_count > 0 && node->at_bytes + node->size_bytes <= size_bytes,
                     "nodes within the file");
        fuzz_require(ewa_octree_find(octree, &node->key) == i, "nodes that are found");
        point_count += node->point_count;
    }
    fuzz_require(point_count == facts->point_count, "the sum of all nodes");
}

static ewa_status read_nodes(ewa_octree *octree, const ewa_octree_facts *facts) {
    uint32_t indices[MOST_NODES], count = 0;
    ewa_cloud *clouds[MOST_NODES], *alone = NULL;
    for (; count < facts->node_count && count < MOST_NODES; count++) indices[count] = count;
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

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    int errors = 0;
    ewa_context_options options;
    ewa_context_options_init(&options, sizeof options);
    options.thread_count = 1;
    options.message = fuzz_message;
    options.message_user = &errors;
    options.limits.max_memory_bytes = 1 << 26;
    options.limits.max_points = 1 << 22;
    ewa_context *context = NULL;
    fuzz_require(ewa_context_create(&options, &context) == EWA_OK, "a context");
    const int file = memfd_create("copc", 0);
    fuzz_require(file >= 0 && write(file, bytes, size_bytes) == (ssize_t)size_bytes, "a file in memory");
    char path[64];
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    ewa_octree *octree = NULL;
    ewa_octree_is(context, path);
    fuzz_require(errors == 0, "no word about what a file is not");
    ewa_status status = ewa_octree_open(context, path, &octree);
    fuzz_require((status == EWA_OK) == (octree != NULL), "a tree on success only");
    if (status == EWA_OK) {
        const ewa_octree_facts *facts = ewa_octree_describe(octree);
        check_facts(octree, facts, size_bytes);
        status = read_nodes(octree, facts);
    }
    fuzz_require((status == EWA_OK) == (errors == 0), "a message on failure only");
    ewa_octree_close(&octree);
    close(file);
    ewa_context_destroy(&context);
    return 0;
}
