// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The cubes of an octree, from its nodes or from the pages of surfels that stand for them.
#include "lod/tree.h"
#include "base/base.h"
#include "cloud/cloud.h"
#include "ewa/prepare.h"
#include "surface/hollow.h"

#include <math.h>
#include <string.h>

/// Mean distance of surfels of a surface, over the side of the cells that have one each.
static const double CELLS_CROSSED = 0.82;

/// Which of its parent's parts a cube is.
static uint32_t part_of(const ewa_octree_key *key) {
    return (uint32_t)(key->cell[0] & 1) << 2 | (uint32_t)(key->cell[1] & 1) << 1 |
           (uint32_t)(key->cell[2] & 1);
}

static ewa_status add_cube(ewa_lod *lod, const ewa_octree_key *key, uint32_t *index) {
    ewa_buffer buffer = {lod->cubes, lod->cube_capacity_bytes};
    const ewa_status status = ewa_buffer_grow(lod->context, &buffer, lod->cube_count,
                                              (size_t)lod->cube_count + 1, sizeof *lod->cubes);
    lod->cubes = buffer.data, lod->cube_capacity_bytes = buffer.capacity_bytes;
    if (status != EWA_OK) return status;
    ewa_cube *cube = &lod->cubes[lod->cube_count];
    *cube = (ewa_cube){.key = *key, .node = UINT32_MAX, .page = UINT32_MAX};
    for (int i = 0; i < 8; i++) cube->parts[i] = EWA_NO_CUBE;
    cube->side_world = ldexp(lod->facts->side_world, -key->level);
    cube->spacing_world = ldexp(lod->facts->spacing_world, -key->level);
    cube->largest_radius_world = 4 * cube->spacing_world; // unless it is known
    for (int c = 0; c < 3; c++)
        cube->low_world[c] = lod->facts->low_world[c] + key->cell[c] * cube->side_world;
    *index = lod->cube_count++;
    return EWA_OK;
}

/// Finds the cube of a key below the root, making those that lie between.
static ewa_status reach_cube(ewa_lod *lod, const ewa_octree_key *key, uint32_t *index) {
    ewa_status status = EWA_OK;
    *index = 0;
    for (int32_t level = 1; level <= key->level && status == EWA_OK; level++) {
        ewa_octree_key at = {.level = level};
        for (int c = 0; c < 3; c++) at.cell[c] = key->cell[c] >> (key->level - level);
        uint32_t next = lod->cubes[*index].parts[part_of(&at)];
        if (next == EWA_NO_CUBE) {
            status = add_cube(lod, &at, &next);
            if (status != EWA_OK) break;
            lod->cubes[*index].parts[part_of(&at)] = next;
            lod->cubes[*index].divided = true;
        }
        *index = next;
    }
    return status;
}

static ewa_status add_pages(ewa_lod *lod) {
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < lod->levels.page_count && status == EWA_OK; i++) {
        const ewa_levels_page *page = &lod->levels.pages[i];
        uint32_t index;
        status = reach_cube(lod, &page->key, &index);
        if (status != EWA_OK) break;
        ewa_cube *cube = &lod->cubes[index];
        cube->page = i;
        cube->divided = page->size_bytes > 0;
        cube->error = (double)page->error;
        cube->largest_radius_world = (double)page->largest_radius_world;
        cube->count = cube->divided ? page->surfel_count : page->point_count;
        // A surface that crosses cells in any way has half as many surfels more as one along them.
        if (cube->divided) cube->spacing_world *= CELLS_CROSSED;
    }
    return status;
}

static ewa_status add_nodes(ewa_lod *lod) {
    const ewa_octree_facts *facts = lod->facts;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < facts->node_count && status == EWA_OK; i++) {
        uint32_t index = EWA_NO_CUBE;
        if (lod->has_levels) {
            // A node without a page belongs to no cube that is drawn: the record is of another tree.
            index = 0;
            for (int32_t level = 1; level <= facts->nodes[i].key.level && index != EWA_NO_CUBE; level++) {
                ewa_octree_key at = {.level = level};
                for (int c = 0; c < 3; c++)
                    at.cell[c] = facts->nodes[i].key.cell[c] >> (facts->nodes[i].key.level - level);
                index = lod->cubes[index].parts[part_of(&at)];
            }
            if (index == EWA_NO_CUBE)
                return ewa_fail(lod->context, EWA_ERROR_FORMAT,
                                "the record of surfels does not fit the nodes: %d-%d-%d-%d has no cube",
                                facts->nodes[i].key.level, facts->nodes[i].key.cell[0],
                                facts->nodes[i].key.cell[1], facts->nodes[i].key.cell[2]);
        } else {
            status = reach_cube(lod, &facts->nodes[i].key, &index);
        }
        if (status == EWA_OK) lod->cubes[index].node = i;
        if (status == EWA_OK && !lod->has_levels) lod->cubes[index].count = facts->nodes[i].point_count;
    }
    return status;
}

/// Makes the parts of divided cubes that have no node: points of the nodes above may lie in them.
static ewa_status add_parts(ewa_lod *lod) {
    const uint32_t cube_count = lod->cube_count;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < cube_count; i++)
        for (uint32_t part = 0; part < 8 && status == EWA_OK; part++) {
            if (!lod->cubes[i].divided || lod->cubes[i].parts[part] != EWA_NO_CUBE) continue;
            ewa_octree_key key = {.level = lod->cubes[i].key.level + 1};
            for (int c = 0; c < 3; c++)
                key.cell[c] = 2 * lod->cubes[i].key.cell[c] + (int32_t)(part >> (2 - c) & 1);
            uint32_t index;
            status = add_cube(lod, &key, &index);
            if (status == EWA_OK) lod->cubes[i].parts[part] = index;
        }
    return status;
}

/// Adds to every cube its share of the points of the nodes above, which are drawn with its own; parents come first.
static void share_counts(ewa_lod *lod) {
    for (uint32_t i = 0; i < lod->cube_count; i++) {
        const ewa_cube *cube = &lod->cubes[i];
        uint32_t sharers[8], count = 0;
        for (int part = 0; part < 8; part++) {
            const uint32_t index = cube->parts[part];
            // Next to nothing lies where no node is.
            if (index != EWA_NO_CUBE && (lod->cubes[index].node != UINT32_MAX || lod->cubes[index].divided))
                sharers[count++] = index;
        }
        for (uint32_t k = 0; k < count; k++) lod->cubes[sharers[k]].count += cube->count / count;
    }
}

ewa_status ewa_tree_make(ewa_lod *lod) {
    const ewa_octree_key root = {.level = 0};
    uint32_t index;
    ewa_status status = add_cube(lod, &root, &index);
    if (status == EWA_OK && lod->has_levels) status = add_pages(lod);
    if (status == EWA_OK) status = add_nodes(lod);
    if (status == EWA_OK && !lod->has_levels) {
        status = add_parts(lod);
        share_counts(lod);
    }
    const size_t node_count = lod->facts->node_count;
    lod->clouds = ewa_allocate_zeroed(lod->context, node_count, sizeof *lod->clouds);
    lod->cloud_frames = ewa_allocate_zeroed(lod->context, node_count, sizeof *lod->cloud_frames);
    return lod->clouds && lod->cloud_frames ? status : EWA_ERROR_MEMORY;
}

void ewa_tree_cell(const ewa_lod *lod, const double world[3], const ewa_octree_key *node, int32_t level,
                   int32_t cell[3]) {
    const double per_side = ldexp(1 / lod->facts->side_world, level);
    for (int c = 0; c < 3; c++) {
        const double at = floor((world[c] - lod->facts->low_world[c]) * per_side);
        const double first = ldexp(node->cell[c], level - node->level),
                     last = ldexp(node->cell[c] + 1.0, level - node->level) - 1;
        cell[c] = (int32_t)(at >= first ? (at <= last ? at : last) : first);
    }
}

void ewa_tree_drop(ewa_lod *lod, uint32_t index) {
    ewa_cube *cube = &lod->cubes[index];
    ewa_surfels_destroy(&cube->surfels);
    lod->resident_bytes -= cube->resident_bytes;
    cube->resident_bytes = 0;
}

static size_t cloud_bytes(const ewa_cloud *cloud) {
    size_t bytes = 0;
    for (uint32_t a = 0; a < ewa_cloud_attribute_count(cloud); a++)
        bytes += ewa_cloud_attribute_at(cloud, a)->stride_bytes;
    return bytes * (size_t)ewa_cloud_point_count(cloud);
}

/// Drops the points of nodes, those that were wanted longest ago first.
static void trim_clouds(ewa_lod *lod, uint64_t memory_bytes) {
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

void ewa_tree_trim(ewa_lod *lod, uint64_t memory_bytes) {
    trim_clouds(lod, memory_bytes / 8);
    while (lod->resident_bytes + lod->cloud_bytes > memory_bytes) {
        uint32_t oldest = EWA_NO_CUBE;
        for (uint32_t i = 0; i < lod->cube_count; i++) {
            const ewa_cube *cube = &lod->cubes[i];
            if (cube->surfels && cube->last_frame < lod->frame &&
                (oldest == EWA_NO_CUBE || cube->last_frame < lod->cubes[oldest].last_frame))
                oldest = i;
        }
        if (oldest == EWA_NO_CUBE) return;
        ewa_tree_drop(lod, oldest);
    }
}

/// What surfels are made of; everything else of the points is left out.
#define SURFEL_ATTRIBUTES                                                                                    \
    EWA_NORMAL "," EWA_RADIUS "," EWA_TANGENT_U "," EWA_TANGENT_V "," EWA_COLOR "," EWA_MATERIAL             \
               "," EWA_CLIP0 "," EWA_CLIP1 "," EWA_CLIP_MODE

/// Nodes on the way from the root to a cube, itself included.
static uint32_t find_path(const ewa_lod *lod, const ewa_cube *cube, uint32_t nodes[EWA_OCTREE_LEVELS]) {
    uint32_t count = 0, index = 0;
    for (int32_t level = 0;; level++) {
        if (lod->cubes[index].node != UINT32_MAX) nodes[count++] = lod->cubes[index].node;
        if (level == cube->key.level) return count;
        ewa_octree_key at = {.level = level + 1};
        for (int c = 0; c < 3; c++) at.cell[c] = cube->key.cell[c] >> (cube->key.level - level - 1);
        index = lod->cubes[index].parts[part_of(&at)];
    }
}

enum { BATCH = 16, BATCH_NODES = BATCH * EWA_OCTREE_LEVELS };

/// Reads the points of nodes that are not in memory, all at once.
static ewa_status fetch_nodes(ewa_lod *lod, const uint32_t *nodes, uint32_t count) {
    uint32_t missing[BATCH_NODES], missing_count = 0;
    ewa_cloud *clouds[BATCH_NODES];
    for (uint32_t i = 0; i < count; i++) {
        lod->cloud_frames[nodes[i]] = lod->frame;
        bool known = lod->clouds[nodes[i]] != NULL;
        for (uint32_t k = 0; k < missing_count && !known; k++) known = missing[k] == nodes[i];
        if (!known) missing[missing_count++] = nodes[i];
    }
    if (!missing_count) return EWA_OK;
    const ewa_status status = ewa_octree_read(lod->octree, missing, missing_count, SURFEL_ATTRIBUTES, clouds);
    for (uint32_t i = 0; i < missing_count && status == EWA_OK; i++) {
        lod->clouds[missing[i]] = clouds[i];
        lod->cloud_bytes += cloud_bytes(clouds[i]);
    }
    return status;
}

/// Which points of a node are in a cube.
typedef struct inside_job {
    const ewa_lod *lod;
    const ewa_cube *cube;
    const ewa_octree_key *node;
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
        const uint64_t part = end - i < BLOCK ? end - i : BLOCK;
        ewa_attribute_read_f64(job->position, i, part, block);
        for (uint64_t k = 0; k < part; k++) {
            int32_t cell[3];
            double at[3];
            for (uint64_t c = 0; c < 3; c++) at[c] = block[3 * k + c] + job->origin[c];
            ewa_tree_cell(job->lod, at, job->node, job->cube->key.level, cell);
            job->inside[i + k] = memcmp(cell, job->cube->key.cell, sizeof cell) == 0;
        }
    }
}

/// Makes one cloud of the points that nodes have in a cube. The caller owns it.
static ewa_status gather_points(ewa_lod *lod, const ewa_cube *cube, const uint32_t *nodes,
                                uint32_t node_count, ewa_cloud **gathered) {
    ewa_cloud *selected[EWA_OCTREE_LEVELS] = {NULL};
    ewa_status status = EWA_OK;
    uint32_t count = 0;
    for (uint32_t n = 0; n < node_count && status == EWA_OK; n++) {
        const ewa_cloud *cloud = lod->clouds[nodes[n]];
        const ewa_octree_key *key = &lod->facts->nodes[nodes[n]].key;
        const uint64_t point_count = ewa_cloud_point_count(cloud);
        uint64_t *indices = ewa_allocate(lod->context, point_count, sizeof *indices), kept = 0;
        inside_job job = {.lod = lod,
                          .cube = cube,
                          .node = key,
                          .position = ewa_cloud_find(cloud, EWA_POSITION),
                          .count = point_count,
                          .inside = ewa_allocate(lod->context, point_count, 1)};
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

/// Makes surfels of a cube, of its cloud.
static ewa_status keep(ewa_lod *lod, ewa_cube *cube, const ewa_cloud *cloud, double radius_scale) {
    ewa_surfels_options options;
    ewa_surfels_options_init(&options, sizeof options);
    options.radius_scale = radius_scale;
    const ewa_status status = ewa_surfels_create(cloud, &options, &cube->surfels);
    if (status != EWA_OK) return status;
    if (lod->levels.unit_coverage > 0)
        ewa_surfels_set_unit_coverage(cube->surfels, lod->levels.unit_coverage * radius_scale * radius_scale);
    ewa_surfels_info info;
    ewa_surfels_describe(cube->surfels, &info);
    cube->resident_bytes = info.resident_bytes;
    lod->resident_bytes += info.resident_bytes;
    return EWA_OK;
}

static ewa_status load_points(ewa_lod *lod, ewa_cube *cube) {
    uint32_t nodes[EWA_OCTREE_LEVELS];
    const uint32_t count = find_path(lod, cube, nodes);
    ewa_cloud *cloud = NULL;
    ewa_estimate_options options;
    ewa_estimate_options_init(&options, sizeof options);
    ewa_status status = fetch_nodes(lod, nodes, count);
    if (status == EWA_OK) status = gather_points(lod, cube, nodes, count, &cloud);
    if (status == EWA_OK && !lod->has_surfels && ewa_cloud_point_count(cloud))
        status = ewa_cloud_estimate(&cloud, &options);
    if (status == EWA_OK && ewa_cloud_point_count(cloud) == 0 && !lod->has_surfels) {
        // An empty cloud has no shape either.
        status = ewa_cloud_add(cloud, EWA_NORMAL, EWA_F32, 3, NULL);
        if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, NULL);
    }
    if (status == EWA_OK) status = keep(lod, cube, cloud, 1);
    ewa_cloud_destroy(&cloud);
    return status;
}

/// A page that is unpacked.
typedef struct unpacked {
    ewa_cloud *cloud;
    ewa_level_surfels surfels;
    uint8_t *scratch;
    const char *fault;
} unpacked;

typedef struct unpack_job {
    ewa_lod *lod;
    const uint32_t *cubes;
    unpacked *pages;
} unpack_job;

static void unpack_task(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const unpack_job *job = data;
    const ewa_cube *cube = &job->lod->cubes[job->cubes[index]];
    unpacked *page = &job->pages[index];
    const ewa_levels_page *entry = &job->lod->levels.pages[cube->page];
    page->fault = ewa_level_decode(entry, job->lod->facts->levels, page->scratch, &page->surfels);
    if (page->fault) return;
    for (size_t i = 0; i < (size_t)3 * entry->surfel_count; i++)
        page->surfels.at[i] = (page->surfels.at[i] - 0.5f) * (float)cube->side_world;
}

/// Makes room for a page; positions are relative to its cube's middle.
static ewa_status prepare_page(ewa_lod *lod, const ewa_cube *cube, unpacked *page) {
    const uint32_t count = lod->levels.pages[cube->page].surfel_count;
    void *at = NULL, *normal = NULL, *radius = NULL, *rgba = NULL;
    ewa_status status = ewa_cloud_create(lod->context, count, &page->cloud);
    if (status == EWA_OK) status = ewa_cloud_add(page->cloud, EWA_POSITION, EWA_F32, 3, &at);
    if (status == EWA_OK) status = ewa_cloud_add(page->cloud, EWA_NORMAL, EWA_F32, 3, &normal);
    if (status == EWA_OK) status = ewa_cloud_add(page->cloud, EWA_RADIUS, EWA_F32, 1, &radius);
    if (status == EWA_OK) status = ewa_cloud_add(page->cloud, EWA_COLOR, EWA_U8, 4, &rgba);
    page->scratch = ewa_allocate(lod->context, ewa_level_raw_bytes(count), 1);
    if (status != EWA_OK || !page->scratch) return EWA_ERROR_MEMORY;
    page->surfels = (ewa_level_surfels){at, normal, radius, rgba};
    double middle[3];
    for (int c = 0; c < 3; c++) middle[c] = cube->low_world[c] + cube->side_world / 2;
    ewa_cloud_set_origin(page->cloud, middle);
    return EWA_OK;
}

static ewa_status load_pages(ewa_lod *lod, const uint32_t *cubes, uint32_t count) {
    unpacked *pages = ewa_allocate_zeroed(lod->context, count, sizeof *pages);
    if (!pages) return EWA_ERROR_MEMORY;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < count && status == EWA_OK; i++)
        status = prepare_page(lod, &lod->cubes[cubes[i]], &pages[i]);
    unpack_job job = {lod, cubes, pages};
    if (status == EWA_OK) ewa_parallel(lod->context, unpack_task, &job, count);
    for (uint32_t i = 0; i < count; i++) {
        ewa_cube *cube = &lod->cubes[cubes[i]];
        const ewa_levels_page *entry = &lod->levels.pages[cube->page];
        if (status == EWA_OK && pages[i].fault)
            status = ewa_fail(lod->context, EWA_ERROR_FORMAT,
                              "the surfels of cube %d-%d-%d-%d are damaged: %s", cube->key.level,
                              cube->key.cell[0], cube->key.cell[1], cube->key.cell[2], pages[i].fault);
        if (status == EWA_OK) status = keep(lod, cube, pages[i].cloud, (double)entry->radius_scale);
        ewa_release(lod->context, pages[i].scratch, ewa_level_raw_bytes(entry->surfel_count), 1);
        ewa_cloud_destroy(&pages[i].cloud);
    }
    ewa_release(lod->context, pages, count, sizeof *pages);
    return status;
}

/// Makes surfels of the points of some cubes, at most BATCH.
static ewa_status load_leaves(ewa_lod *lod, const uint32_t *cubes, uint32_t count, uint64_t memory_bytes) {
    uint32_t nodes[BATCH_NODES] = {0}, node_count = 0;
    for (uint32_t i = 0; i < count; i++)
        node_count += find_path(lod, &lod->cubes[cubes[i]], nodes + node_count);
    ewa_status status = fetch_nodes(lod, nodes, node_count);
    for (uint32_t i = 0; i < count && status == EWA_OK; i++) status = load_points(lod, &lod->cubes[cubes[i]]);
    trim_clouds(lod, memory_bytes / 8);
    return status;
}

ewa_status ewa_tree_load(ewa_lod *lod, const uint32_t *cubes, uint32_t count, uint64_t memory_bytes) {
    uint32_t pages[BATCH], leaves[BATCH], page_count = 0, leaf_count = 0;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < count && status == EWA_OK; i++) {
        const ewa_cube *cube = &lod->cubes[cubes[i]];
        if (cube->surfels) continue;
        if (cube->page == UINT32_MAX || !cube->divided)
            leaves[leaf_count++] = cubes[i];
        else
            pages[page_count++] = cubes[i];
        if (leaf_count == BATCH) {
            status = load_leaves(lod, leaves, leaf_count, memory_bytes);
            leaf_count = 0;
        }
        if (page_count == BATCH && status == EWA_OK) {
            status = load_pages(lod, pages, page_count);
            page_count = 0;
        }
    }
    if (status == EWA_OK && leaf_count) status = load_leaves(lod, leaves, leaf_count, memory_bytes);
    if (status == EWA_OK && page_count) status = load_pages(lod, pages, page_count);
    return status;
}
