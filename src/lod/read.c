// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What is read of an octree's nodes, and the surfels that are made of it. Nothing here changes what pictures are drawn of, so that some may
// be drawn on another thread meanwhile; ewa_tree_load() alone puts nodes into the tree.
#include "base/base.h"
#include "cloud/cloud.h"
#include "ewa/prepare.h"
#include "lod/cell_borders.h"
#include "lod/tree.h"
#include "surface/levels.h"
#include "surface/packets.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// What surfels are made of; everything else of the points is left out.
#define SURFEL_ATTRIBUTES                                                                                    \
    EWA_NORMAL "," EWA_RADIUS "," EWA_TANGENT_U "," EWA_TANGENT_V "," EWA_COLOR "," EWA_MATERIAL             \
               "," EWA_SURFACENESS "," EWA_CURVATURE "," EWA_CLIP0 "," EWA_CLIP1 "," EWA_CLIP_MODE "," EWA_BORDER

/// File nodes on the way from the root to a node, itself included.
static uint32_t find_path(const ewa_lod *lod, const ewa_lod_node *node,
                          uint32_t file_nodes[EWA_OCTREE_LEVELS]) {
    uint32_t count = 0, index = 0;
    for (int32_t level = 0;; level++) {
        if (lod->nodes[index].file_node != UINT32_MAX) file_nodes[count++] = lod->nodes[index].file_node;
        if (level == node->key.level) return count;
        ewa_octree_key at = {.level = level + 1};
        for (int c = 0; c < 3; c++) at.cell[c] = node->key.cell[c] >> (node->key.level - level - 1);
        index = lod->nodes[index].children[ewa_tree_child_of(&at)];
    }
}

enum { BATCH = EWA_TREE_BATCH, BATCH_NODES = BATCH * EWA_OCTREE_LEVELS };

/// Reads the points of nodes that are not in memory, all at once.
static ewa_status fetch_nodes(ewa_lod *lod, const ewa_tree_reading *how, const uint32_t *file_nodes, uint32_t count) {
    uint32_t missing[BATCH_NODES], missing_count = 0;
    ewa_cloud *clouds[BATCH_NODES];
    if (strcmp(how->appearance->attributes, lod->cloud_attributes) != 0) {
        ewa_tree_trim_points(lod, 0);
        snprintf(lod->cloud_attributes, sizeof lod->cloud_attributes, "%s", how->appearance->attributes);
    }
    for (uint32_t i = 0; i < count; i++) {
        lod->cloud_frames[file_nodes[i]] = how->frame;
        bool known = lod->clouds[file_nodes[i]] != NULL;
        for (uint32_t k = 0; k < missing_count && !known; k++) known = missing[k] == file_nodes[i];
        if (!known) missing[missing_count++] = file_nodes[i];
    }
    if (!missing_count) return EWA_OK;
    char attributes[sizeof SURFEL_ATTRIBUTES + EWA_LOD_ATTRIBUTES_BYTES] = SURFEL_ATTRIBUTES;
    strcat(attributes, how->appearance->attributes);
    EWA_TRY(ewa_octree_read(lod->octree, missing, missing_count, attributes, clouds));
    for (uint32_t i = 0; i < missing_count; i++) ewa_tree_keep_points(lod, missing[i], clouds[i]);
    return EWA_OK;
}

/// Which points of a file node lie in the cube of another node.
typedef struct inside_job {
    const ewa_lod_node *node;
    ewa_tree_cells cells; ///< of the node's level
    const ewa_attribute *position;
    double origin[3];
    uint64_t count;
    uint8_t *inside;
} inside_job;

enum { INSIDE_POINTS = 1 << 12 };

static void inside_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    enum { BLOCK = 256 };
    const inside_job *job = data;
    double block[3 * BLOCK];
    const uint64_t first = (uint64_t)task * INSIDE_POINTS, left = job->count - first;
    const uint64_t end = first + (left < INSIDE_POINTS ? left : INSIDE_POINTS);
    for (uint64_t i = first; i < end; i += BLOCK) {
        const uint64_t count = end - i < BLOCK ? end - i : BLOCK;
        ewa_attribute_read_f64(job->position, i, count, block);
        for (uint64_t k = 0; k < count; k++) {
            int32_t cell[3];
            double at[3];
            for (uint64_t c = 0; c < 3; c++) at[c] = block[3 * k + c] + job->origin[c];
            ewa_tree_cell(&job->cells, at, cell);
            job->inside[i + k] = memcmp(cell, job->node->key.cell, sizeof cell) == 0;
        }
    }
}

/// Makes one cloud of the points that file nodes have in a node's cube. The caller owns it.
static ewa_status gather_points(ewa_lod *lod, const ewa_lod_node *node, const uint32_t *file_nodes,
                                uint32_t node_count, ewa_cloud **gathered) {
    ewa_cloud *selected[EWA_OCTREE_LEVELS] = {NULL};
    ewa_status status = EWA_OK;
    uint32_t count = 0;
    for (uint32_t n = 0; n < node_count && status == EWA_OK; n++) {
        const ewa_cloud *cloud = lod->clouds[file_nodes[n]];
        const ewa_octree_key *key = &lod->facts->nodes[file_nodes[n]].key;
        const uint64_t point_count = ewa_cloud_point_count(cloud);
        uint64_t *indices = ewa_allocate(lod->context, point_count, sizeof *indices), kept = 0;
        inside_job job = {.node = node,
                          .position = ewa_cloud_find(cloud, EWA_POSITION),
                          .count = point_count,
                          .inside = ewa_allocate(lod->context, point_count, 1)};
        ewa_tree_cells_begin(lod, key, node->key.level, &job.cells);
        if (indices && job.inside) {
            ewa_cloud_origin(cloud, job.origin);
            ewa_parallel(lod->context, inside_task, &job,
                         (uint32_t)((point_count + INSIDE_POINTS - 1) / INSIDE_POINTS));
            for (uint64_t i = 0; i < point_count; i++)
                if (job.inside[i]) indices[kept++] = i;
        } else {
            status = EWA_ERROR_MEMORY;
        }
        ewa_release(lod->context, job.inside, point_count, 1);
        if (kept) status = ewa_cloud_select(cloud, indices, kept, &selected[count]);
        count += kept > 0;
        ewa_release(lod->context, indices, point_count, sizeof *indices);
    }
    if (status == EWA_OK)
        status = count ? ewa_cloud_merge((const ewa_cloud *const *)selected, count, gathered)
                       : ewa_cloud_like(lod->facts->prototype, gathered);
    for (uint32_t i = 0; i < count; i++) ewa_cloud_destroy(&selected[i]);
    return status;
}

/// Changes a node's points as the appearance says, before what they lack is estimated, or afterwards.
static ewa_status place(const ewa_lod_appearance *appearance, ewa_cloud **cloud, bool *thinned) {
    const uint64_t count = ewa_cloud_point_count(*cloud);
    if (appearance->place) EWA_TRY(appearance->place(appearance->user, cloud));
    *thinned = appearance->filtered && ewa_cloud_point_count(*cloud) < count;
    return EWA_OK;
}

static ewa_status paint(const ewa_lod_appearance *appearance, ewa_cloud **cloud) {
    return appearance->paint ? appearance->paint(appearance->user, cloud) : EWA_OK;
}

/// Makes surfels of a node, of its cloud.
static ewa_status make_surfels(const ewa_lod *lod, const ewa_lod_appearance *appearance, const ewa_cloud *cloud, double radius_scale,
                               bool thinned, ewa_surfels **surfels) {
    ewa_surfels_options options;
    ewa_surfels_options_init(&options, sizeof options);
    options.radius_scale = radius_scale * appearance->radius_scale;
    // What the file says of its surface no longer holds where it is pressed together, or where a filter takes some of it.
    const double said = ewa_cell_is_similar(appearance->to_world) && !thinned ? lod->levels.unit_coverage * options.radius_scale * options.radius_scale : 0;
    return ewa_surfels_create_covering(cloud, &options, said, surfels);
}

static ewa_status load_points(ewa_lod *lod, const ewa_tree_reading *how, const ewa_lod_node *node, ewa_surfels **surfels) {
    uint32_t file_nodes[EWA_OCTREE_LEVELS];
    const uint32_t count = find_path(lod, node, file_nodes);
    ewa_cloud *cloud = NULL;
    ewa_estimate_options options;
    ewa_estimate_options_init(&options, sizeof options);
    bool thinned = false;
    ewa_status status = fetch_nodes(lod, how, file_nodes, count);
    if (status == EWA_OK) status = gather_points(lod, node, file_nodes, count, &cloud);
    if (status == EWA_OK) status = place(how->appearance, &cloud, &thinned);
    if (status == EWA_OK && !lod->has_surfels && ewa_cloud_point_count(cloud))
        status = ewa_cloud_estimate(&cloud, &options);
    if (status == EWA_OK && !lod->has_surfels)
        ewa_cell_keep_borders(lod->facts, &node->key, how->appearance->to_world, cloud);
    if (status == EWA_OK) ewa_cell_drop_empty_borders(cloud);
    if (status == EWA_OK && ewa_cloud_point_count(cloud) == 0 && !lod->has_surfels) {
        // An empty cloud has no shape either.
        status = ewa_cloud_add(cloud, EWA_NORMAL, EWA_F32, 3, NULL);
        if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, NULL);
    }
    if (status == EWA_OK) status = paint(how->appearance, &cloud);
    if (status == EWA_OK) status = make_surfels(lod, how->appearance, cloud, 1, thinned, surfels);
    ewa_cloud_destroy(&cloud);
    return status;
}

/// A page that is unpacked.
typedef struct unpacked {
    ewa_cloud *cloud;
    ewa_level_surfels surfels;
    uint8_t *scratch;
    size_t scratch_bytes;
    void *streams[EWA_LEVELS_MAX_ATTRIBUTES]; ///< of the attributes that are wanted
    bool has_streams;
    const char *fault;
} unpacked;

typedef struct unpack_job {
    ewa_lod *lod;
    const uint32_t *nodes;
    unpacked *pages;
} unpack_job;

/// What of the record is read for a page.
static ewa_range range_of(const ewa_levels_page *entry, bool with_attributes) {
    return (ewa_range){entry->at_bytes, entry->size_bytes + (with_attributes ? (uint64_t)entry->attributes_bytes : 0)};
}

static void unpack_task(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const unpack_job *job = data;
    const ewa_lod_node *node = &job->lod->nodes[job->nodes[index]];
    unpacked *page = &job->pages[index];
    const ewa_levels_page *entry = &job->lod->levels.pages[node->page];
    const ewa_range range = range_of(entry, page->has_streams);
    const uint8_t *block = ewa_octree_find_level(job->lod->octree, range.at_bytes, range.size_bytes);
    page->fault = ewa_level_decode(entry, block, page->scratch, &page->surfels);
    if (!page->fault && page->has_streams)
        page->fault = ewa_level_decode_attributes(&job->lod->levels, entry, block + entry->size_bytes, page->scratch, page->streams);
    if (page->fault) return;
    for (size_t i = 0; i < (size_t)3 * entry->surfel_count; i++)
        page->surfels.at[i] = (page->surfels.at[i] - 0.5f) * (float)node->side_world;
}

/// Whether a name is in a list, each after a comma; NULL has all.
static bool is_listed(const char *list, const char *name) {
    const size_t length = strlen(name);
    for (const char *at = list; at && *at; at += strcspn(at, ",")) {
        at++;
        if (strncmp(at, name, length) == 0 && (at[length] == ',' || !at[length])) return true;
    }
    return !list;
}

/// Makes the cloud of a page of `count` surfels, with the attributes that are listed.
static ewa_status make_page(const ewa_lod *lod, const char *attributes, uint32_t count, unpacked *page) {
    const ewa_levels *levels = &lod->levels;
    void *at = NULL, *normal = NULL, *radius = NULL, *curvature = NULL, *rgba = NULL;
    ewa_status status = ewa_cloud_create(lod->context, count, &page->cloud);
    if (status == EWA_OK) status = ewa_cloud_add(page->cloud, EWA_POSITION, EWA_F32, 3, &at);
    if (status == EWA_OK) status = ewa_cloud_add(page->cloud, EWA_NORMAL, EWA_F32, 3, &normal);
    if (status == EWA_OK) status = ewa_cloud_add(page->cloud, EWA_RADIUS, EWA_F32, 1, &radius);
    if (status == EWA_OK && levels->has_curvatures)
        status = ewa_cloud_add(page->cloud, EWA_CURVATURE, EWA_F32, 1, &curvature);
    if (status == EWA_OK) status = ewa_cloud_add(page->cloud, EWA_COLOR, EWA_U8, 4, &rgba);
    page->surfels = (ewa_level_surfels){at, normal, radius, curvature, rgba};
    for (uint32_t a = 0; a < levels->attribute_count && status == EWA_OK; a++) {
        const ewa_level_attribute *attribute = &levels->attributes[a];
        if (!is_listed(attributes, attribute->name)) continue;
        status = ewa_cloud_add(page->cloud, attribute->name, attribute->type, 1, &page->streams[a]);
        page->has_streams = true;
    }
    return status;
}

ewa_status ewa_tree_make_represented(const ewa_lod *lod, ewa_cloud **cloud) {
    unpacked page = {.cloud = NULL};
    const ewa_status status = make_page(lod, NULL, 0, &page);
    if (status != EWA_OK) ewa_cloud_destroy(&page.cloud);
    *cloud = page.cloud;
    return status;
}

/// Makes room for a page; positions are relative to its node's middle.
static ewa_status prepare_page(ewa_lod *lod, const ewa_lod_node *node, const char *attributes, unpacked *page) {
    const uint32_t count = lod->levels.pages[node->page].surfel_count;
    EWA_TRY(make_page(lod, attributes, count, page));
    const size_t surfels_bytes = ewa_level_raw_bytes(count, lod->levels.has_curvatures),
                 attributes_bytes = page->has_streams ? ewa_level_attribute_bytes(&lod->levels, count) : 0;
    page->scratch_bytes = surfels_bytes > attributes_bytes ? surfels_bytes : attributes_bytes;
    page->scratch = ewa_allocate(lod->context, page->scratch_bytes, 1);
    if (!page->scratch) return EWA_ERROR_MEMORY;
    double middle[3];
    for (int c = 0; c < 3; c++) middle[c] = node->low_world[c] + node->side_world / 2;
    ewa_cloud_set_origin(page->cloud, middle);
    return EWA_OK;
}

/// Loads pages, at most BATCH.
static ewa_status load_pages(ewa_lod *lod, const ewa_tree_reading *how, const uint32_t *nodes, uint32_t count,
                             ewa_surfels **surfels) {
    unpacked *pages = ewa_allocate_zeroed(lod->context, count, sizeof *pages);
    if (!pages) return EWA_ERROR_MEMORY;
    ewa_range blocks[BATCH];
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < count && status == EWA_OK; i++) {
        const ewa_lod_node *node = &lod->nodes[nodes[i]];
        status = prepare_page(lod, node, how->appearance->attributes, &pages[i]);
        blocks[i] = range_of(&lod->levels.pages[node->page], pages[i].has_streams);
    }
    if (status == EWA_OK) status = ewa_octree_need_levels(lod->octree, blocks, count);
    unpack_job job = {lod, nodes, pages};
    if (status == EWA_OK) ewa_parallel(lod->context, unpack_task, &job, count);
    ewa_octree_let_levels_go(lod->octree);
    for (uint32_t i = 0; i < count; i++) {
        const ewa_lod_node *node = &lod->nodes[nodes[i]];
        if (status == EWA_OK && pages[i].fault)
            status = ewa_fail(lod->context, EWA_ERROR_FORMAT,
                              "the surfels of node %d-%d-%d-%d are damaged: %s", node->key.level,
                              node->key.cell[0], node->key.cell[1], node->key.cell[2], pages[i].fault);
        bool thinned = false;
        if (status == EWA_OK) status = place(how->appearance, &pages[i].cloud, &thinned);
        if (status == EWA_OK) status = paint(how->appearance, &pages[i].cloud);
        if (status == EWA_OK)
            status = make_surfels(lod, how->appearance, pages[i].cloud, (double)lod->levels.pages[node->page].radius_scale,
                                  thinned, &surfels[i]);
        // Beyond the root nothing represents it (cut.c).
        if (status == EWA_OK && nodes[i] == 0) status = ewa_levels_make(surfels[i], EWA_MAX_LEVELS);
        ewa_release(lod->context, pages[i].scratch, pages[i].scratch_bytes, 1);
        ewa_cloud_destroy(&pages[i].cloud);
    }
    ewa_release(lod->context, pages, count, sizeof *pages);
    return status;
}

/// Makes surfels of the points of some nodes, at most BATCH.
static ewa_status load_leaves(ewa_lod *lod, const ewa_tree_reading *how, const uint32_t *nodes, uint32_t count,
                              ewa_surfels **surfels) {
    uint32_t file_nodes[BATCH_NODES] = {0}, node_count = 0;
    for (uint32_t i = 0; i < count; i++)
        node_count += find_path(lod, &lod->nodes[nodes[i]], file_nodes + node_count);
    ewa_status status = fetch_nodes(lod, how, file_nodes, node_count);
    for (uint32_t i = 0; i < count && status == EWA_OK; i++)
        status = load_points(lod, how, &lod->nodes[nodes[i]], &surfels[i]);
    ewa_tree_trim_points(lod, how->memory_bytes / 8);
    return status;
}

/// Whether a node is drawn by surfels that represent its points.
static bool has_page(const ewa_lod_node *node) { return node->page != UINT32_MAX && node->divided; }

ewa_status ewa_tree_read(ewa_lod *lod, const ewa_tree_reading *how, const uint32_t *nodes, uint32_t count,
                         ewa_surfels **surfels) {
    uint32_t some[2][BATCH], at[2][BATCH], counts[2] = {0, 0};
    ewa_surfels *made[2][BATCH] = {{NULL}};
    for (uint32_t i = 0; i < count; i++) {
        const int page = has_page(&lod->nodes[nodes[i]]);
        surfels[i] = NULL;
        at[page][counts[page]] = i;
        some[page][counts[page]++] = nodes[i];
    }
    ewa_status status = counts[0] ? load_leaves(lod, how, some[0], counts[0], made[0]) : EWA_OK;
    if (status == EWA_OK && counts[1]) status = load_pages(lod, how, some[1], counts[1], made[1]);
    for (int page = 0; page < 2; page++)
        for (uint32_t i = 0; i < counts[page]; i++)
            if (status == EWA_OK)
                surfels[at[page][i]] = made[page][i];
            else
                ewa_surfels_destroy(&made[page][i]);
    return status;
}

/// Reads a batch and puts it into the tree.
static ewa_status load_batch(ewa_lod *lod, const uint32_t *nodes, uint32_t *count, uint64_t memory_bytes) {
    const ewa_tree_reading how = {&lod->appearance, lod->frame, memory_bytes};
    ewa_surfels *surfels[BATCH];
    EWA_TRY(ewa_tree_read(lod, &how, nodes, *count, surfels));
    for (uint32_t i = 0; i < *count; i++) ewa_tree_put(lod, nodes[i], surfels[i]);
    *count = 0;
    return EWA_OK;
}

ewa_status ewa_tree_load(ewa_lod *lod, const uint32_t *nodes, uint32_t count, uint64_t memory_bytes) {
    // Those of a kind together, so that all workers have some of it.
    uint32_t batches[2][BATCH], counts[2] = {0, 0};
    for (uint32_t i = 0; i < count; i++) {
        if (lod->nodes[nodes[i]].surfels) continue;
        const int page = has_page(&lod->nodes[nodes[i]]);
        batches[page][counts[page]++] = nodes[i];
        if (counts[page] == BATCH) EWA_TRY(load_batch(lod, batches[page], &counts[page], memory_bytes));
    }
    for (int page = 0; page < 2; page++)
        if (counts[page]) EWA_TRY(load_batch(lod, batches[page], &counts[page], memory_bytes));
    return EWA_OK;
}
