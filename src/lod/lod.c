// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Open octrees, what they are, and points out of them.
#include "base/base.h"
#include "base/platform.h"
#include "cloud/cloud.h"
#include "lod/tree.h"

#include <math.h>
#include <string.h>

bool ewa_lod_probe(ewa_context *context, const char *path) {
    return context && path && ewa_octree_is(context, path);
}

bool ewa_lod_is_folder(ewa_context *context, const char *path) {
    if (!context || !path) return false;
    ewa_platform_facts facts;
    const bool folder = ewa_platform_stat(path, &facts) && facts.folder;
    return (folder || strcmp(ewa_platform_file_name(path), "ept.json") == 0) && ewa_octree_is(context, path);
}

static ewa_status open_tree(ewa_lod *lod, const char *path) {
    EWA_TRY(ewa_octree_open(lod->context, path, &lod->octree));
    lod->facts = ewa_octree_describe(lod->octree);
    lod->has_surfels = ewa_cloud_is_drawable(lod->facts->prototype);
    ewa_status status = EWA_OK;
    if (lod->facts->levels) {
        status =
            ewa_levels_read(lod->context, path, lod->facts->levels, lod->facts->levels_bytes, &lod->levels);
        lod->has_levels = lod->levels.page_count > 0;
    }
    if (status == EWA_OK && lod->has_levels) status = ewa_tree_make_represented(lod, &lod->represented);
    return status == EWA_OK ? ewa_tree_make(lod) : status;
}

ewa_status ewa_lod_open(ewa_context *context, const char *path, ewa_lod **lod) {
    if (!context || !path || !lod) return EWA_ERROR_ARGUMENT;
    *lod = NULL;
    ewa_lod *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    ewa_status status = open_tree(made, path);
    if (status == EWA_OK) status = ewa_tree_set_appearance(made, NULL);
    if (status == EWA_OK)
        *lod = made;
    else
        ewa_lod_close(&made);
    return status;
}

static ewa_status add_instance(ewa_lod *lod, ewa_lod **added) {
    *added = ewa_allocate_zeroed(lod->context, 1, sizeof **added);
    if (!*added) return EWA_ERROR_MEMORY;
    **added = (ewa_lod){.context = lod->context,
                        .octree = lod->octree,
                        .facts = lod->facts,
                        .levels = lod->levels,
                        .represented = lod->represented,
                        .has_levels = lod->has_levels,
                        .has_surfels = lod->has_surfels,
                        .is_instance = true};
    ewa_status status = ewa_tree_make(*added);
    if (status == EWA_OK) status = ewa_tree_set_appearance(*added, NULL);
    if (status != EWA_OK) ewa_lod_close(added);
    return status;
}

ewa_status ewa_tree_instance(ewa_lod *lod, uint32_t number, ewa_lod **instance) {
    for (*instance = lod; number > 0; number--) {
        ewa_lod *last = *instance;
        if (!last->next) EWA_TRY(add_instance(lod, &last->next));
        *instance = last->next;
    }
    return EWA_OK;
}

void ewa_lod_close(ewa_lod **lod) {
    if (!lod || !*lod) return;
    ewa_lod *old = *lod;
    ewa_context *context = old->context;
    while (old->next) {
        ewa_lod *instance = old->next;
        old->next = instance->next;
        instance->next = NULL;
        ewa_lod_close(&instance);
    }
    for (uint32_t i = 0; i < old->node_count; i++) ewa_surfels_destroy(&old->nodes[i].surfels);
    const size_t node_count = old->facts ? old->facts->node_count : 0;
    for (size_t i = 0; old->clouds && i < node_count; i++) ewa_cloud_destroy(&old->clouds[i]);
    ewa_release(context, old->clouds, node_count, sizeof *old->clouds);
    ewa_release(context, old->cloud_frames, node_count, sizeof *old->cloud_frames);
    ewa_buffer nodes = {old->nodes, old->node_capacity_bytes};
    ewa_buffer_free(context, &nodes);
    ewa_buffer_free(context, &old->appearance_user);
    ewa_buffer_free(context, &old->items);
    ewa_buffer_free(context, &old->cover);
    ewa_buffer_free(context, &old->measured);
    ewa_buffer_free(context, &old->instances);
    ewa_buffer_free(context, &old->mixing);
    ewa_buffer_free(context, &old->wanted);
    if (!old->is_instance) ewa_cloud_destroy(&old->represented);
    if (!old->is_instance) ewa_levels_free(context, &old->levels);
    if (!old->is_instance) ewa_octree_close(&old->octree);
    ewa_release(context, old, 1, sizeof *old);
    *lod = NULL;
}

void ewa_lod_describe(const ewa_lod *lod, ewa_lod_info *info) {
    const ewa_octree_facts *facts = lod->facts;
    *info = (ewa_lod_info){.kind = facts->kind,
                           .point_count = facts->point_count,
                           .bounds = facts->bounds,
                           .side_world = facts->side_world,
                           .spacing_world = facts->spacing_world,
                           .node_count = facts->node_count,
                           .merged = lod->has_levels,
                           .merged_count = lod->levels.surfel_count,
                           .surfels = lod->has_surfels,
                           .prototype = facts->prototype,
                           .represented = lod->represented};
    memcpy(info->low_world, facts->low_world, sizeof info->low_world);
    for (uint32_t i = 0; i < facts->node_count; i++)
        if ((uint32_t)facts->nodes[i].key.level >= info->level_count)
            info->level_count = (uint32_t)facts->nodes[i].key.level + 1;
}

/// Reads nodes and makes one cloud of them. The caller owns it.
static ewa_status read_nodes(ewa_lod *lod, const uint32_t *nodes, uint32_t count, ewa_cloud **cloud) {
    if (count == 0) return ewa_cloud_like(lod->facts->prototype, cloud);
    ewa_cloud **clouds = ewa_allocate_zeroed(lod->context, count, sizeof *clouds);
    if (!clouds) return EWA_ERROR_MEMORY;
    ewa_status status = ewa_octree_read(lod->octree, nodes, count, NULL, clouds);
    if (status == EWA_OK) status = ewa_cloud_merge((const ewa_cloud *const *)clouds, count, cloud);
    for (uint32_t i = 0; i < count; i++) ewa_cloud_destroy(&clouds[i]);
    ewa_release(lod->context, clouds, count, sizeof *clouds);
    return status;
}

ewa_status ewa_lod_sample(ewa_lod *lod, uint64_t maximum_points, ewa_cloud **cloud) {
    if (!lod || !cloud || maximum_points == 0) return EWA_ERROR_ARGUMENT;
    *cloud = NULL;
    const ewa_octree_facts *facts = lod->facts;
    uint32_t *nodes = ewa_allocate(lod->context, facts->node_count, sizeof *nodes);
    if (!nodes) return EWA_ERROR_MEMORY;
    uint64_t points = 0;
    uint32_t count = 0;
    while (count < facts->node_count) { // nodes are ordered by level
        uint32_t end = count;
        uint64_t more = 0;
        for (; end < facts->node_count && facts->nodes[end].key.level == facts->nodes[count].key.level; end++)
            more += facts->nodes[end].point_count;
        if (count && points + more > maximum_points) break;
        for (; count < end; count++) nodes[count] = count;
        points += more;
    }
    const ewa_status status = read_nodes(lod, nodes, count, cloud);
    ewa_release(lod->context, nodes, facts->node_count, sizeof *nodes);
    return status;
}

/// Whether a node's node intersects a box.
static bool meets(const ewa_octree_facts *facts, const ewa_octree_key *key, const double low[3],
                  const double high[3]) {
    const double side = ldexp(facts->side_world, -key->level);
    for (int c = 0; c < 3; c++) {
        const double from = facts->low_world[c] + key->cell[c] * side;
        // A step of the grid more on each side: points are rounded.
        if (!(from - 1e-6 * side <= high[c] && from + (1 + 1e-6) * side >= low[c])) return false;
    }
    return true;
}

static ewa_status cut(ewa_lod *lod, const double low[3], const double high[3], ewa_cloud **cloud) {
    const uint64_t count = ewa_cloud_point_count(*cloud);
    uint64_t *indices = ewa_allocate(lod->context, count, sizeof *indices), kept = 0;
    if (!indices) return EWA_ERROR_MEMORY;
    const ewa_attribute *position = ewa_cloud_find(*cloud, EWA_POSITION);
    double origin[3];
    ewa_cloud_origin(*cloud, origin);
    for (uint64_t i = 0; i < count; i++) {
        double at[4];
        bool inside = true;
        ewa_attribute_read_f64(position, i, 1, at);
        for (int c = 0; c < 3; c++)
            inside = inside && at[c] + origin[c] >= low[c] && at[c] + origin[c] <= high[c];
        if (inside) indices[kept++] = i;
    }
    ewa_cloud *selected = NULL;
    const ewa_status status = ewa_cloud_select(*cloud, indices, kept, &selected);
    ewa_release(lod->context, indices, count, sizeof *indices);
    EWA_TRY(status);
    ewa_cloud_destroy(cloud);
    *cloud = selected;
    return EWA_OK;
}

ewa_status ewa_lod_read(ewa_lod *lod, const double low_world[3], const double high_world[3],
                        double spacing_world, ewa_cloud **cloud) {
    if (!lod || !low_world || !high_world || !cloud || !(spacing_world >= 0)) return EWA_ERROR_ARGUMENT;
    *cloud = NULL;
    const ewa_octree_facts *facts = lod->facts;
    uint32_t *nodes = ewa_allocate(lod->context, facts->node_count, sizeof *nodes), count = 0;
    if (!nodes) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < facts->node_count; i++) {
        const ewa_octree_key *key = &facts->nodes[i].key;
        if (key->level > 0 && ldexp(facts->spacing_world, 1 - key->level) <= spacing_world) break;
        if (meets(facts, key, low_world, high_world)) nodes[count++] = i;
    }
    ewa_status status = read_nodes(lod, nodes, count, cloud);
    if (status == EWA_OK) status = cut(lod, low_world, high_world, cloud);
    if (status != EWA_OK) ewa_cloud_destroy(cloud);
    ewa_release(lod->context, nodes, facts->node_count, sizeof *nodes);
    return status;
}
