// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The nodes of an octree, from the file's nodes or from the pages of representative surfels.
#include "lod/tree.h"
#include "base/base.h"
#include "cloud/cloud.h"
#include "ewa/prepare.h"
#include "surface/proxy.h"

#include <math.h>
#include <string.h>

/// Mean distance of surfels of a surface, over the side of the cells that have one each.
static const double CELLS_CROSSED = 0.82;

/// Which of its parent's children a node is.
static uint32_t child_of(const ewa_octree_key *key) {
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
        uint32_t next = lod->nodes[*index].children[child_of(&at)];
        if (next == EWA_NO_NODE) {
            EWA_TRY(add_node(lod, &at, &next));
            lod->nodes[*index].children[child_of(&at)] = next;
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
                index = lod->nodes[index].children[child_of(&at)];
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
        uint32_t sharers[8], count = 0;
        for (int child = 0; child < 8; child++) {
            const uint32_t index = node->children[child];
            // Next to nothing lies where no node is.
            if (index != EWA_NO_NODE &&
                (lod->nodes[index].file_node != UINT32_MAX || lod->nodes[index].divided))
                sharers[count++] = index;
        }
        for (uint32_t k = 0; k < count; k++) lod->nodes[sharers[k]].count += node->count / count;
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

void ewa_tree_cell(const ewa_lod *lod, const double world[3], const ewa_octree_key *file_node, int32_t level,
                   int32_t cell[3]) {
    const double per_side = ldexp(1 / lod->facts->side_world, level);
    for (int c = 0; c < 3; c++) {
        const double at = floor((world[c] - lod->facts->low_world[c]) * per_side);
        const double first = ldexp(file_node->cell[c], level - file_node->level),
                     last = ldexp(file_node->cell[c] + 1.0, level - file_node->level) - 1;
        cell[c] = (int32_t)(at >= first ? (at <= last ? at : last) : first);
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

/// What surfels are made of; everything else of the points is left out.
#define SURFEL_ATTRIBUTES                                                                                    \
    EWA_NORMAL "," EWA_RADIUS "," EWA_TANGENT_U "," EWA_TANGENT_V "," EWA_COLOR "," EWA_MATERIAL             \
               "," EWA_SURFACENESS "," EWA_CURVATURE "," EWA_CLIP0 "," EWA_CLIP1 "," EWA_CLIP_MODE "," EWA_BORDER

/// Whether what was made with one look is what another one makes.
static bool looks_agree(const ewa_lod_look *a, const ewa_lod_look *b) {
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

/// Whether a map keeps angles, so that densities and squares of radii change alike.
static bool is_similar(const double m[16]) {
    double scale2[3], across = 0;
    for (int r = 0; r < 3; r++) {
        const double *a = m + 4 * r, *b = m + 4 * ((r + 1) % 3);
        scale2[r] = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
        across = fmax(across, fabs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]));
    }
    const double off = fmax(fabs(scale2[0] - scale2[1]), fabs(scale2[0] - scale2[2]));
    return fmax(off, across) <= 1e-6 * scale2[0];
}

ewa_status ewa_tree_set_look(ewa_lod *lod, const ewa_lod_look *given) {
    static const ewa_lod_look as_it_is = {.to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                                          .radius_scale = 1};
    const ewa_lod_look *look = given ? given : &as_it_is;
    if (looks_agree(look, &lod->look)) return EWA_OK;
    for (uint32_t i = 0; i < lod->node_count; i++) ewa_tree_drop(lod, i);
    if (strcmp(look->attributes, lod->look.attributes) != 0) trim_clouds(lod, 0);
    lod->look = as_it_is;
    lod->stretch = 1;
    lod->is_similar = true;
    if (look->user_bytes) EWA_TRY(ewa_buffer_reserve(lod->context, &lod->look_user, look->user_bytes, 1));
    if (look->user_bytes) memcpy(lod->look_user.data, look->user, look->user_bytes);
    lod->look = *look;
    lod->look.user = lod->look_user.data;
    lod->stretch = stretch_of(look->to_world);
    lod->is_similar = is_similar(look->to_world);
    return EWA_OK;
}

/// File nodes on the way from the root to a node, itself included.
static uint32_t find_path(const ewa_lod *lod, const ewa_lod_node *node,
                          uint32_t file_nodes[EWA_OCTREE_LEVELS]) {
    uint32_t count = 0, index = 0;
    for (int32_t level = 0;; level++) {
        if (lod->nodes[index].file_node != UINT32_MAX) file_nodes[count++] = lod->nodes[index].file_node;
        if (level == node->key.level) return count;
        ewa_octree_key at = {.level = level + 1};
        for (int c = 0; c < 3; c++) at.cell[c] = node->key.cell[c] >> (node->key.level - level - 1);
        index = lod->nodes[index].children[child_of(&at)];
    }
}

enum { BATCH = 16, BATCH_NODES = BATCH * EWA_OCTREE_LEVELS };

/// Reads the points of nodes that are not in memory, all at once.
static ewa_status fetch_nodes(ewa_lod *lod, const uint32_t *file_nodes, uint32_t count) {
    uint32_t missing[BATCH_NODES], missing_count = 0;
    ewa_cloud *clouds[BATCH_NODES];
    for (uint32_t i = 0; i < count; i++) {
        lod->cloud_frames[file_nodes[i]] = lod->frame;
        bool known = lod->clouds[file_nodes[i]] != NULL;
        for (uint32_t k = 0; k < missing_count && !known; k++) known = missing[k] == file_nodes[i];
        if (!known) missing[missing_count++] = file_nodes[i];
    }
    if (!missing_count) return EWA_OK;
    char attributes[sizeof SURFEL_ATTRIBUTES + EWA_LOD_LOOK_NAMES_BYTES] = SURFEL_ATTRIBUTES;
    strcat(attributes, lod->look.attributes);
    EWA_TRY(ewa_octree_read(lod->octree, missing, missing_count, attributes, clouds));
    for (uint32_t i = 0; i < missing_count; i++) {
        lod->clouds[missing[i]] = clouds[i];
        lod->cloud_bytes += cloud_bytes(clouds[i]);
    }
    return EWA_OK;
}

/// Which points of a file node lie in the cube of another node.
typedef struct inside_job {
    const ewa_lod *lod;
    const ewa_lod_node *node;
    const ewa_octree_key *file_node;
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
            ewa_tree_cell(job->lod, at, job->file_node, job->node->key.level, cell);
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
        inside_job job = {.lod = lod,
                          .node = node,
                          .file_node = key,
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

/// Changes a node's points as the look says, before what they lack is estimated, or afterwards.
static ewa_status place(const ewa_lod *lod, ewa_cloud **cloud) {
    return lod->look.place ? lod->look.place(lod->look.user, cloud) : EWA_OK;
}

static ewa_status paint(const ewa_lod *lod, ewa_cloud **cloud) {
    return lod->look.paint ? lod->look.paint(lod->look.user, cloud) : EWA_OK;
}

/// Makes surfels of a node, of its cloud.
static ewa_status keep(ewa_lod *lod, ewa_lod_node *node, const ewa_cloud *cloud, double radius_scale) {
    ewa_surfels_options options;
    ewa_surfels_options_init(&options, sizeof options);
    options.radius_scale = radius_scale * lod->look.radius_scale;
    EWA_TRY(ewa_surfels_create(cloud, &options, &node->surfels));
    // What the file says of its surface no longer holds where it is pressed together.
    if (lod->levels.unit_coverage > 0 && lod->is_similar)
        ewa_surfels_set_unit_coverage(node->surfels, lod->levels.unit_coverage * options.radius_scale *
                                                         options.radius_scale);
    ewa_surfels_info info;
    ewa_surfels_describe(node->surfels, &info);
    node->resident_bytes = info.resident_bytes;
    lod->resident_bytes += info.resident_bytes;
    return EWA_OK;
}

static ewa_status load_points(ewa_lod *lod, ewa_lod_node *node) {
    uint32_t file_nodes[EWA_OCTREE_LEVELS];
    const uint32_t count = find_path(lod, node, file_nodes);
    ewa_cloud *cloud = NULL;
    ewa_estimate_options options;
    ewa_estimate_options_init(&options, sizeof options);
    ewa_status status = fetch_nodes(lod, file_nodes, count);
    if (status == EWA_OK) status = gather_points(lod, node, file_nodes, count, &cloud);
    if (status == EWA_OK) status = place(lod, &cloud);
    if (status == EWA_OK && !lod->has_surfels && ewa_cloud_point_count(cloud))
        status = ewa_cloud_estimate(&cloud, &options);
    // Points of a node end where its cell does, not where their surface does.
    if (!lod->has_surfels) ewa_cloud_remove(cloud, EWA_BORDER);
    if (status == EWA_OK && ewa_cloud_point_count(cloud) == 0 && !lod->has_surfels) {
        // An empty cloud has no shape either.
        status = ewa_cloud_add(cloud, EWA_NORMAL, EWA_F32, 3, NULL);
        if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, NULL);
    }
    if (status == EWA_OK) status = paint(lod, &cloud);
    if (status == EWA_OK) status = keep(lod, node, cloud, 1);
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
    const uint32_t *nodes;
    unpacked *pages;
} unpack_job;

static void unpack_task(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const unpack_job *job = data;
    const ewa_lod_node *node = &job->lod->nodes[job->nodes[index]];
    unpacked *page = &job->pages[index];
    const ewa_levels_page *entry = &job->lod->levels.pages[node->page];
    const uint8_t *block = ewa_octree_find_level(job->lod->octree, entry->at_bytes, entry->size_bytes);
    page->fault = ewa_level_decode(entry, block, page->scratch, &page->surfels);
    if (page->fault) return;
    for (size_t i = 0; i < (size_t)3 * entry->surfel_count; i++)
        page->surfels.at[i] = (page->surfels.at[i] - 0.5f) * (float)node->side_world;
}

/// Makes room for a page; positions are relative to its node's middle.
static ewa_status prepare_page(ewa_lod *lod, const ewa_lod_node *node, unpacked *page) {
    const uint32_t count = lod->levels.pages[node->page].surfel_count;
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
    for (int c = 0; c < 3; c++) middle[c] = node->low_world[c] + node->side_world / 2;
    ewa_cloud_set_origin(page->cloud, middle);
    return EWA_OK;
}

/// Loads pages, at most BATCH.
static ewa_status load_pages(ewa_lod *lod, const uint32_t *nodes, uint32_t count) {
    unpacked *pages = ewa_allocate_zeroed(lod->context, count, sizeof *pages);
    if (!pages) return EWA_ERROR_MEMORY;
    ewa_range blocks[BATCH];
    for (uint32_t i = 0; i < count; i++) {
        const ewa_levels_page *entry = &lod->levels.pages[lod->nodes[nodes[i]].page];
        blocks[i] = (ewa_range){entry->at_bytes, entry->size_bytes};
    }
    ewa_status status = ewa_octree_need_levels(lod->octree, blocks, count);
    for (uint32_t i = 0; i < count && status == EWA_OK; i++)
        status = prepare_page(lod, &lod->nodes[nodes[i]], &pages[i]);
    unpack_job job = {lod, nodes, pages};
    if (status == EWA_OK) ewa_parallel(lod->context, unpack_task, &job, count);
    ewa_octree_let_levels_go(lod->octree);
    for (uint32_t i = 0; i < count; i++) {
        ewa_lod_node *node = &lod->nodes[nodes[i]];
        const ewa_levels_page *entry = &lod->levels.pages[node->page];
        if (status == EWA_OK && pages[i].fault)
            status = ewa_fail(lod->context, EWA_ERROR_FORMAT,
                              "the surfels of node %d-%d-%d-%d are damaged: %s", node->key.level,
                              node->key.cell[0], node->key.cell[1], node->key.cell[2], pages[i].fault);
        if (status == EWA_OK) status = place(lod, &pages[i].cloud);
        if (status == EWA_OK) status = paint(lod, &pages[i].cloud);
        if (status == EWA_OK) status = keep(lod, node, pages[i].cloud, (double)entry->radius_scale);
        ewa_release(lod->context, pages[i].scratch, ewa_level_raw_bytes(entry->surfel_count), 1);
        ewa_cloud_destroy(&pages[i].cloud);
    }
    ewa_release(lod->context, pages, count, sizeof *pages);
    return status;
}

/// Makes surfels of the points of some nodes, at most BATCH.
static ewa_status load_leaves(ewa_lod *lod, const uint32_t *nodes, uint32_t count, uint64_t memory_bytes) {
    uint32_t file_nodes[BATCH_NODES] = {0}, node_count = 0;
    for (uint32_t i = 0; i < count; i++)
        node_count += find_path(lod, &lod->nodes[nodes[i]], file_nodes + node_count);
    ewa_status status = fetch_nodes(lod, file_nodes, node_count);
    for (uint32_t i = 0; i < count && status == EWA_OK; i++) status = load_points(lod, &lod->nodes[nodes[i]]);
    trim_clouds(lod, memory_bytes / 8);
    return status;
}

ewa_status ewa_tree_load(ewa_lod *lod, const uint32_t *nodes, uint32_t count, uint64_t memory_bytes) {
    uint32_t pages[BATCH], leaves[BATCH], page_count = 0, leaf_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        const ewa_lod_node *node = &lod->nodes[nodes[i]];
        if (node->surfels) continue;
        if (node->page == UINT32_MAX || !node->divided)
            leaves[leaf_count++] = nodes[i];
        else
            pages[page_count++] = nodes[i];
        if (leaf_count == BATCH) {
            EWA_TRY(load_leaves(lod, leaves, leaf_count, memory_bytes));
            leaf_count = 0;
        }
        if (page_count == BATCH) {
            EWA_TRY(load_pages(lod, pages, page_count));
            page_count = 0;
        }
    }
    if (leaf_count) EWA_TRY(load_leaves(lod, leaves, leaf_count, memory_bytes));
    if (page_count) EWA_TRY(load_pages(lod, pages, page_count));
    return EWA_OK;
}
