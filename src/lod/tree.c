// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The nodes of an octree, from the file's nodes or from the pages of representative surfels, and those that are in memory.
#include "lod/tree.h"
#include "base/base.h"
#include "cloud/cloud.h"

#include <math.h>
#include <string.h>

/// Mean distance of surfels of a surface, over the side of the cells that have one each.
static const double CELLS_CROSSED = 0.82;

uint32_t ewa_tree_child_of(const ewa_octree_key *key) {
    return (uint32_t)(key->cell[0] & 1) << 2 | (uint32_t)(key->cell[1] & 1) << 1 |
           (uint32_t)(key->cell[2] & 1);
}

static ewa_status add_node(ewa_lod *lod, const ewa_octree_key *key, uint32_t *index) {
    ewa_buffer buffer = {lod->nodes, lod->node_capacity_bytes};
    const ewa_status status = ewa_buffer_grow(lod->context, &buffer, lod->node_count,
                                              (size_t)lod->node_count + 1, sizeof *lod->nodes);
    lod->nodes = buffer.data, lod->node_capacity_bytes = buffer.capacity_bytes;
    EWA_TRY(status);
    ewa_lod_node *node = &lod->nodes[lod->node_count];
    *node = (ewa_lod_node){.key = *key, .file_node = UINT32_MAX, .page = UINT32_MAX};
    for (int i = 0; i < 8; i++) node->children[i] = EWA_NO_NODE;
    node->side_world = ldexp(lod->facts->side_world, -key->level);
    node->spacing_world = ldexp(lod->facts->spacing_world, -key->level);
    node->largest_radius_world = 4 * node->spacing_world; // unless it is known
    for (int c = 0; c < 3; c++) {
        node->low_world[c] = lod->facts->low_world[c] + key->cell[c] * node->side_world;
        node->box_low_world[c] = node->low_world[c];
        node->box_high_world[c] = node->low_world[c] + node->side_world;
    }
    *index = lod->node_count++;
    return EWA_OK;
}

/// Finds the node of a key below the root, making those that lie between.
static ewa_status reach_node(ewa_lod *lod, const ewa_octree_key *key, uint32_t *index) {
    *index = 0;
    for (int32_t level = 1; level <= key->level; level++) {
        ewa_octree_key at = {.level = level};
        for (int c = 0; c < 3; c++) at.cell[c] = key->cell[c] >> (key->level - level);
        uint32_t next = lod->nodes[*index].children[ewa_tree_child_of(&at)];
        if (next == EWA_NO_NODE) {
            EWA_TRY(add_node(lod, &at, &next));
            lod->nodes[*index].children[ewa_tree_child_of(&at)] = next;
            lod->nodes[*index].divided = true;
        }
        *index = next;
    }
    return EWA_OK;
}

static ewa_status add_pages(ewa_lod *lod) {
    for (uint32_t i = 0; i < lod->levels.page_count; i++) {
        const ewa_levels_page *page = &lod->levels.pages[i];
        uint32_t index;
        EWA_TRY(reach_node(lod, &page->key, &index));
        ewa_lod_node *node = &lod->nodes[index];
        node->page = i;
        node->divided = page->size_bytes > 0;
        node->error = (double)page->error;
        node->largest_radius_world = (double)page->largest_radius_world;
        node->count = node->divided ? page->surfel_count : page->point_count;
        // A surface that crosses cells in any way has half as many surfels more as one along them.
        if (node->divided) node->spacing_world *= CELLS_CROSSED;
    }
    return EWA_OK;
}

static ewa_status add_nodes(ewa_lod *lod) {
    const ewa_octree_facts *facts = lod->facts;
    for (uint32_t i = 0; i < facts->node_count; i++) {
        uint32_t index = EWA_NO_NODE;
        if (lod->has_levels) {
            // A node of the file without a page belongs to nothing that is drawn: the record is of another
            // tree.
            index = 0;
            for (int32_t level = 1; level <= facts->nodes[i].key.level && index != EWA_NO_NODE; level++) {
                ewa_octree_key at = {.level = level};
                for (int c = 0; c < 3; c++)
                    at.cell[c] = facts->nodes[i].key.cell[c] >> (facts->nodes[i].key.level - level);
                index = lod->nodes[index].children[ewa_tree_child_of(&at)];
            }
            if (index == EWA_NO_NODE)
                return ewa_fail(lod->context, EWA_ERROR_FORMAT,
                                "the record of surfels does not fit the nodes: %d-%d-%d-%d has no node",
                                facts->nodes[i].key.level, facts->nodes[i].key.cell[0],
                                facts->nodes[i].key.cell[1], facts->nodes[i].key.cell[2]);
        } else {
            EWA_TRY(reach_node(lod, &facts->nodes[i].key, &index));
        }
        lod->nodes[index].file_node = i;
        if (!lod->has_levels) lod->nodes[index].count = facts->nodes[i].point_count;
    }
    return EWA_OK;
}

/// Makes the children of divided nodes that the file has no node for: points of their ancestors may lie in
/// them.
static ewa_status add_parts(ewa_lod *lod) {
    const uint32_t node_count = lod->node_count;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < node_count; i++)
        for (uint32_t child = 0; child < 8 && status == EWA_OK; child++) {
            if (!lod->nodes[i].divided || lod->nodes[i].children[child] != EWA_NO_NODE) continue;
            ewa_octree_key key = {.level = lod->nodes[i].key.level + 1};
            for (int c = 0; c < 3; c++)
                key.cell[c] = 2 * lod->nodes[i].key.cell[c] + (int32_t)(child >> (2 - c) & 1);
            uint32_t index;
            status = add_node(lod, &key, &index);
            if (status == EWA_OK) lod->nodes[i].children[child] = index;
        }
    return status;
}

/// Adds to every node its share of the points of its ancestors, which are drawn with its own; parents come
/// first.
static void share_counts(ewa_lod *lod) {
    for (uint32_t i = 0; i < lod->node_count; i++) {
        const ewa_lod_node *node = &lod->nodes[i];
        uint32_t holders[8], count = 0;
        for (int child = 0; child < 8; child++) {
            const uint32_t index = node->children[child];
            // Next to nothing lies where no node is.
            if (index != EWA_NO_NODE &&
                (lod->nodes[index].file_node != UINT32_MAX || lod->nodes[index].divided))
                holders[count++] = index;
        }
        for (uint32_t k = 0; k < count; k++) lod->nodes[holders[k]].count += node->count / count;
    }
}

/// Makes the boxes of divided nodes those of their children together, where all points are in children: a ground fills a small part of
/// the cubes above it, which reach near cameras that are far from it. Parents come first.
static void fit_boxes(ewa_lod *lod) {
    for (uint32_t i = lod->node_count; i-- > 0;) {
        ewa_lod_node *node = &lod->nodes[i];
        bool any = false;
        for (int child = 0; child < 8 && node->divided; child++) {
            if (node->children[child] == EWA_NO_NODE) continue;
            const ewa_lod_node *part = &lod->nodes[node->children[child]];
            for (int c = 0; c < 3; c++) {
                node->box_low_world[c] = any ? fmin(node->box_low_world[c], part->box_low_world[c]) : part->box_low_world[c];
                node->box_high_world[c] = any ? fmax(node->box_high_world[c], part->box_high_world[c]) : part->box_high_world[c];
            }
            any = true;
        }
    }
}

ewa_status ewa_tree_make(ewa_lod *lod) {
    const ewa_octree_key root = {.level = 0};
    uint32_t index;
    ewa_status status = add_node(lod, &root, &index);
    if (status == EWA_OK && lod->has_levels) status = add_pages(lod);
    if (status == EWA_OK) status = add_nodes(lod);
    if (status == EWA_OK && lod->has_levels) fit_boxes(lod);
    if (status == EWA_OK && !lod->has_levels) {
        status = add_parts(lod);
        share_counts(lod);
    }
    const size_t node_count = lod->facts->node_count;
    lod->clouds = ewa_allocate_zeroed(lod->context, node_count, sizeof *lod->clouds);
    lod->cloud_frames = ewa_allocate_zeroed(lod->context, node_count, sizeof *lod->cloud_frames);
    return lod->clouds && lod->cloud_frames ? status : EWA_ERROR_MEMORY;
}

void ewa_tree_cells_begin(const ewa_lod *lod, const ewa_octree_key *file_node, int32_t level, ewa_tree_cells *cells) {
    cells->per_side = ldexp(1 / lod->facts->side_world, level);
    for (int c = 0; c < 3; c++) {
        cells->low_world[c] = lod->facts->low_world[c];
        cells->first[c] = ldexp(file_node->cell[c], level - file_node->level);
        cells->last[c] = ldexp(file_node->cell[c] + 1.0, level - file_node->level) - 1;
    }
}

void ewa_tree_drop(ewa_lod *lod, uint32_t index) {
    ewa_lod_node *node = &lod->nodes[index];
    ewa_surfels_destroy(&node->surfels);
    lod->resident_bytes -= node->resident_bytes;
    node->resident_bytes = 0;
}

static size_t cloud_bytes(const ewa_cloud *cloud) {
    size_t bytes = 0;
    for (uint32_t a = 0; a < ewa_cloud_attribute_count(cloud); a++)
        bytes += ewa_cloud_attribute_at(cloud, a)->stride_bytes;
    return bytes * (size_t)ewa_cloud_point_count(cloud);
}

void ewa_tree_trim_points(ewa_lod *lod, uint64_t memory_bytes) {
    while (lod->cloud_bytes > memory_bytes) {
        uint32_t oldest = UINT32_MAX;
        for (uint32_t i = 0; i < lod->facts->node_count; i++)
            if (lod->clouds[i] && (oldest == UINT32_MAX || lod->cloud_frames[i] < lod->cloud_frames[oldest]))
                oldest = i;
        if (oldest == UINT32_MAX) return;
        lod->cloud_bytes -= cloud_bytes(lod->clouds[oldest]);
        ewa_cloud_destroy(&lod->clouds[oldest]);
    }
}

void ewa_tree_keep_points(ewa_lod *lod, uint32_t file_node, ewa_cloud *points) {
    lod->clouds[file_node] = points;
    lod->cloud_bytes += cloud_bytes(points);
}

void ewa_tree_trim(ewa_lod *lod, uint64_t memory_bytes) {
    ewa_tree_trim_points(lod, memory_bytes / 8);
    while (lod->resident_bytes + lod->cloud_bytes > memory_bytes) {
        uint32_t oldest = EWA_NO_NODE;
        for (uint32_t i = 0; i < lod->node_count; i++) {
            const ewa_lod_node *node = &lod->nodes[i];
            if (node->surfels && node->last_frame < lod->frame &&
                (oldest == EWA_NO_NODE || node->last_frame < lod->nodes[oldest].last_frame))
                oldest = i;
        }
        if (oldest == EWA_NO_NODE) return;
        ewa_tree_drop(lod, oldest);
    }
}

bool ewa_tree_appearances_equal(const ewa_lod_appearance *a, const ewa_lod_appearance *b) {
    return a->place == b->place && a->paint == b->paint && a->radius_scale == b->radius_scale &&
           a->user_bytes == b->user_bytes && memcmp(a->to_world, b->to_world, sizeof a->to_world) == 0 &&
           strcmp(a->attributes, b->attributes) == 0 &&
           (!a->user_bytes || memcmp(a->user, b->user, a->user_bytes) == 0);
}

/// The most that a map makes of a length, of rotations times a scale that scale: the root of the largest sum of a row
/// of A A^T, which bounds its eigenvalues (Gershgorin).
static double stretch_of(const double m[16]) {
    double most = 0;
    for (int r = 0; r < 3; r++) {
        double sum = 0;
        for (int k = 0; k < 3; k++)
            sum += fabs(m[4 * r] * m[4 * k] + m[4 * r + 1] * m[4 * k + 1] + m[4 * r + 2] * m[4 * k + 2]);
        most = fmax(most, sum);
    }
    return sqrt(most);
}

uint64_t ewa_tree_bytes_of(const ewa_lod_node *node) {
    enum { BYTES_PER_SURFEL = 36 }; // 32 of packets, 2 of curvatures, lanes that stay empty
    return node->surfels ? node->resident_bytes : node->count * BYTES_PER_SURFEL + 4096;
}

bool ewa_tree_make_room(ewa_lod *lod, uint32_t node, uint64_t memory_bytes) {
    const uint64_t bytes = ewa_tree_bytes_of(&lod->nodes[node]);
    if (lod->resident_bytes + lod->cloud_bytes + bytes <= memory_bytes) return true;
    ewa_tree_trim(lod, memory_bytes > bytes ? memory_bytes - bytes : 0);
    return lod->resident_bytes + lod->cloud_bytes + bytes <= memory_bytes;
}

ewa_status ewa_tree_set_appearance(ewa_lod *lod, const ewa_lod_appearance *given) {
    static const ewa_lod_appearance as_it_is = {.to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                                                .radius_scale = 1};
    const ewa_lod_appearance *appearance = given ? given : &as_it_is;
    if (ewa_tree_appearances_equal(appearance, &lod->appearance)) return EWA_OK;
    for (uint32_t i = 0; i < lod->node_count; i++) {
        ewa_tree_drop(lod, i);
        lod->nodes[i].damaged = false; // the appearance may have been the reason
    }
    lod->appearance = as_it_is;
    lod->stretch = 1;
    if (appearance->user_bytes) EWA_TRY(ewa_buffer_reserve(lod->context, &lod->appearance_user, appearance->user_bytes, 1));
    if (appearance->user_bytes) memcpy(lod->appearance_user.data, appearance->user, appearance->user_bytes);
    lod->appearance = *appearance;
    lod->appearance.user = lod->appearance_user.data;
    lod->stretch = stretch_of(appearance->to_world);
    return EWA_OK;
}

void ewa_tree_put(ewa_lod *lod, uint32_t index, ewa_surfels *surfels) {
    ewa_surfels_info info;
    ewa_surfels_describe(surfels, &info);
    ewa_lod_node *node = &lod->nodes[index];
    node->surfels = surfels;
    node->resident_bytes = info.resident_bytes;
    lod->resident_bytes += info.resident_bytes;
}
