// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Octrees of points in files, whatever their kind: nodes in order, waves of nodes that all workers read.
#include "io/octree.h"
#include "base/allocating.h"
#include "io/octree_format.h"

#include <stdlib.h>
#include <string.h>

static const ewa_octree_format *const formats[] = {&ewa_octree_copc, &ewa_octree_ept};
enum { FORMAT_COUNT = sizeof formats / sizeof formats[0] };

int ewa_octree_key_compare(const ewa_octree_key *a, const ewa_octree_key *b) {
    if (a->level != b->level) return a->level < b->level ? -1 : 1;
    for (int c = 2; c >= 0; c--)
        if (a->cell[c] != b->cell[c]) return a->cell[c] < b->cell[c] ? -1 : 1;
    return 0;
}

static int compare_nodes(const void *a, const void *b) {
    const ewa_octree_node *left = a, *right = b;
    return ewa_octree_key_compare(&left->key, &right->key);
}

static const ewa_octree_format *format_of(ewa_context *context, const char *path) {
    for (uint32_t i = 0; i < FORMAT_COUNT; i++)
        if (formats[i]->is(context, path)) return formats[i];
    return NULL;
}

bool ewa_octree_is(ewa_context *context, const char *path) { return path && format_of(context, path); }

ewa_status ewa_octree_add(ewa_octree *octree, const ewa_octree_node *node) {
    EWA_TRY(ewa_buffer_grow(octree->context, &octree->nodes, octree->node_count, octree->node_count + 1,
                            sizeof *node));
    ((ewa_octree_node *)octree->nodes.data)[octree->node_count++] = *node;
    return EWA_OK;
}

/// Puts the nodes in order and counts their points.
static ewa_status settle_nodes(ewa_octree *octree) {
    ewa_octree_facts *facts = &octree->facts;
    ewa_octree_node *nodes = octree->nodes.data;
    const ewa_limits *limits = ewa_context_limits(octree->context);
    if (octree->node_count >= UINT32_MAX)
        return ewa_fail(octree->context, EWA_ERROR_LIMIT, "%s: more than 2^32 nodes", octree->path);
    if (octree->node_count) qsort(nodes, octree->node_count, sizeof *nodes, compare_nodes);
    for (uint64_t i = 0; i < octree->node_count; i++) {
        const ewa_octree_key *k = &nodes[i].key;
        if (i && ewa_octree_key_compare(k, &nodes[i - 1].key) == 0)
            return ewa_fail(octree->context, EWA_ERROR_FORMAT, "%s: node %d-%d-%d-%d comes twice",
                            octree->path, k->level, k->cell[0], k->cell[1], k->cell[2]);
        if (nodes[i].point_count > limits->max_points)
            return ewa_fail(octree->context, EWA_ERROR_LIMIT,
                            "%s: node %d-%d-%d-%d, %llu points, is over the limit of %llu", octree->path,
                            k->level, k->cell[0], k->cell[1], k->cell[2],
                            (unsigned long long)nodes[i].point_count, (unsigned long long)limits->max_points);
        facts->point_count += nodes[i].point_count;
    }
    facts->nodes = nodes;
    facts->node_count = (uint32_t)octree->node_count;
    facts->prototype = octree->prototype;
    return EWA_OK;
}

ewa_status ewa_octree_open(ewa_context *context, const char *path, ewa_octree **octree) {
    *octree = NULL;
    const ewa_octree_format *format = format_of(context, path);
    if (!format)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED,
                        "%s: no octree of points: neither a COPC file nor a folder with an ept.json", path);
    ewa_octree *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->format = format;
    const size_t path_bytes = strlen(path) + 1;
    made->path = ewa_allocate(context, path_bytes, 1);
    ewa_status status = made->path ? EWA_OK : EWA_ERROR_MEMORY;
    if (made->path) memcpy(made->path, path, path_bytes);
    if (status == EWA_OK) status = ewa_cloud_create(context, 0, &made->prototype);
    if (status == EWA_OK) status = format->open(made);
    if (status == EWA_OK) status = settle_nodes(made);
    if (status == EWA_OK)
        *octree = made;
    else
        ewa_octree_close(&made);
    return status;
}

const ewa_octree_facts *ewa_octree_describe(const ewa_octree *octree) { return &octree->facts; }

uint32_t ewa_octree_find(const ewa_octree *octree, const ewa_octree_key *key) {
    uint32_t low = 0, high = octree->facts.node_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        const int order = ewa_octree_key_compare(&octree->facts.nodes[middle].key, key);
        if (order == 0) return middle;
        if (order < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return UINT32_MAX;
}

/// Nodes that are read at once.
typedef struct wave {
    ewa_octree *octree;
    const uint32_t *indices;
    uint32_t count, attribute_count;
    ewa_cloud_sink *sinks; ///< attribute_count for each node
    ewa_octree_result results[EWA_OCTREE_WAVE];
} wave;

static void read_node(void *data, uint32_t index, uint32_t worker) {
    wave *w = data;
    ewa_octree *octree = w->octree;
    octree->format->read(octree, &octree->facts.nodes[w->indices[index]], index, worker,
                         w->sinks + (size_t)index * w->attribute_count, &w->results[index]);
}

/// Says what is wrong with the first node that could not be read.
static ewa_status settle_wave(wave *w) {
    ewa_octree *octree = w->octree;
    for (uint32_t i = 0; i < w->count; i++) {
        const ewa_octree_node *node = &octree->facts.nodes[w->indices[i]];
        const ewa_octree_key *k = &node->key;
        const ewa_octree_result *result = &w->results[i];
        octree->above_count += result->above_count;
        if (result->status == EWA_OK) continue;
        if (!result->fault) return result->status;
        return ewa_fail(octree->context, result->status, "%s: node %d-%d-%d-%d of %llu points is damaged: %s",
                        octree->path, k->level, k->cell[0], k->cell[1], k->cell[2],
                        (unsigned long long)node->point_count, result->fault);
    }
    return EWA_OK;
}

static ewa_status read_wave(wave *w, const char *attributes, ewa_cloud **clouds) {
    ewa_octree *octree = w->octree;
    memset(w->results, 0, sizeof w->results);
    const ewa_octree_format *format = octree->format;
    ewa_status status = format->begin ? format->begin(octree, w->indices, w->count) : EWA_OK;
    for (uint32_t i = 0; i < w->count && status == EWA_OK; i++)
        status = ewa_cloud_make_room(octree->path, octree->prototype, attributes,
                                     octree->facts.nodes[w->indices[i]].point_count, &clouds[i],
                                     w->sinks + (size_t)i * w->attribute_count);
    if (status == EWA_OK) {
        ewa_parallel_allocating(octree->context, read_node, w, w->count);
        status = settle_wave(w);
    }
    if (format->end) format->end(octree);
    return status;
}

ewa_status ewa_octree_read(ewa_octree *octree, const uint32_t *indices, uint32_t count,
                           const char *attributes, ewa_cloud **clouds) {
    ewa_context *context = octree->context;
    for (uint32_t i = 0; i < count; i++) clouds[i] = NULL;
    for (uint32_t i = 0; i < count; i++)
        if (indices[i] >= octree->facts.node_count)
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: node %u of %u is wanted", octree->path,
                            indices[i], octree->facts.node_count);
    if (count == 0) return EWA_OK;
    const uint32_t maximum = count < EWA_OCTREE_WAVE ? count : EWA_OCTREE_WAVE;
    const uint32_t attribute_count = ewa_cloud_attribute_count(octree->prototype);
    const size_t sink_count = (size_t)maximum * attribute_count;
    wave w = {.octree = octree, .attribute_count = attribute_count};
    w.sinks = ewa_allocate(context, sink_count, sizeof *w.sinks);
    ewa_status status = w.sinks ? EWA_OK : EWA_ERROR_MEMORY;
    for (uint32_t first = 0; first < count && status == EWA_OK; first += w.count) {
        w.indices = indices + first;
        w.count = count - first < maximum ? count - first : maximum;
        status = read_wave(&w, attributes, clouds + first);
    }
    ewa_release(context, w.sinks, sink_count, sizeof *w.sinks);
    for (uint32_t i = 0; i < count && status != EWA_OK; i++) ewa_cloud_destroy(&clouds[i]);
    return status;
}

ewa_status ewa_octree_need_levels(ewa_octree *octree, ewa_range *parts, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) parts[i].at_bytes += octree->facts.levels_at_bytes;
    return octree->format->need(octree, parts, count);
}

const uint8_t *ewa_octree_find_level(const ewa_octree *octree, uint64_t at_bytes, uint64_t size_bytes) {
    return octree->format->find(octree, &(ewa_range){octree->facts.levels_at_bytes + at_bytes, size_bytes});
}

void ewa_octree_let_levels_go(ewa_octree *octree) { octree->format->end(octree); }

void ewa_octree_close(ewa_octree **octree) {
    if (!octree || !*octree) return;
    ewa_octree *old = *octree;
    ewa_context *context = old->context;
    if (old->above_count)
        ewa_report(context, EWA_SEVERITY_WARNING,
                   "%s: %llu numbers of colours are above 255, which none was of those that were looked at; "
                   "they are read as 255",
                   old->path, (unsigned long long)old->above_count);
    old->format->close(old);
    ewa_cloud_destroy(&old->prototype);
    ewa_buffer_free(context, &old->nodes);
    if (old->path) ewa_release(context, old->path, strlen(old->path) + 1, 1);
    ewa_release(context, old, 1, sizeof *old);
    *octree = NULL;
}
