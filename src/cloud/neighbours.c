// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The tree of boxes over the distinct positions of a cloud.
//
// Points in Morton order are cut where the curve leaves the largest cell, again and again, until no run holds
// more than 16: leaves are small boxes whatever the density. Above them every node has 16 consecutive
// children. Points at the same place become one, so that no number of duplicates displaces the neighbours or
// makes the search quadratic.
#include "cloud/neighbours.h"
#include "base/base.h"
#include "cloud/morton.h"
#include "cloud/neighbours_tree.h"

#include <math.h>
#include <string.h>

enum {
    SHORT_RUN = 32, // longer runs without a split level are all at one place
    MIN_LEAF_PLACES = 6,
    FULL_RUN = 64,         // places; longer runs are cut at the largest cell only
    SECTION_PLACES = 4096, // leaves are cut from sections of about this size in parallel
    SECTION_WINDOW = 1024, // each border is the coarsest one so near
    LEAF_FLAG = 0x8000,    // in a split level: a leaf begins here
};

typedef struct build_job {
    ewa_neighbours *tree;
    const ewa_attribute *position;
    uint32_t finite_count;
    uint16_t *split_level; // of the order, then of the places
    uint32_t parts;
    uint32_t part_count[64];  // places that begin in each part, then the first of them
    uint32_t *section_border; // [section_count + 1]
    uint32_t *section_leaves; // [section_count + 1], then the first leaf of each
    uint32_t section_count;
} build_job;

/// The common type without a call: positions are read in an order that no cache foresees, three at a time.
static void read_point(const ewa_attribute *position, uint32_t point, double p[3]) {
    if (position->type != EWA_F32) {
        ewa_attribute_read_f64(position, point, 1, p);
        return;
    }
    const char *bytes = (const char *)position->data + point * position->stride_bytes;
    const float *from = (const float *)(const void *)bytes;
    for (int c = 0; c < 3; c++) p[c] = (double)from[c];
}

/// Orders by coordinates, then by index.
static bool comes_before(const ewa_attribute *position, uint32_t left, uint32_t right) {
    double l[3], r[3];
    read_point(position, left, l);
    read_point(position, right, r);
    for (int c = 0; c < 3; c++)
        if (l[c] != r[c]) return l[c] < r[c];
    return left < right;
}

/// Brings equal positions together inside the short runs that share the last cell.
static void sort_short_runs(const build_job *job) {
    uint32_t *order = job->tree->order;
    for (uint32_t i = 1; i < job->finite_count; i++) {
        if (job->split_level[i] != EWA_MORTON_SAME) continue;
        const uint32_t begin = i - 1;
        uint32_t end = i + 1;
        while (end < job->finite_count && job->split_level[end] == EWA_MORTON_SAME) end++;
        if (end - begin <= SHORT_RUN) {
            for (uint32_t j = begin + 1; j < end; j++) {
                const uint32_t moved = order[j];
                uint32_t to = j;
                for (; to > begin && comes_before(job->position, moved, order[to - 1]); to--)
                    order[to] = order[to - 1];
                order[to] = moved;
            }
        }
        i = end - 1;
    }
}

static bool begins_place(const build_job *job, uint32_t i) {
    if (i == 0 || job->split_level[i] != EWA_MORTON_SAME) return true;
    double p[3], previous[3];
    read_point(job->position, job->tree->order[i], p);
    read_point(job->position, job->tree->order[i - 1], previous);
    return p[0] != previous[0] || p[1] != previous[1] || p[2] != previous[2];
}

static void count_places_task(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    build_job *job = data;
    const uint32_t end = (uint32_t)ewa_split(job->finite_count, job->parts, part + 1);
    uint32_t count = 0;
    for (uint32_t i = (uint32_t)ewa_split(job->finite_count, job->parts, part); i < end; i++)
        count += begins_place(job, i);
    job->part_count[part] = count;
}

static void list_places_task(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    build_job *job = data;
    const uint32_t end = (uint32_t)ewa_split(job->finite_count, job->parts, part + 1);
    uint32_t place = job->part_count[part];
    for (uint32_t i = (uint32_t)ewa_split(job->finite_count, job->parts, part); i < end; i++)
        if (begins_place(job, i)) job->tree->first[place++] = i;
}

/// Returns the place in (begin, end) where the curve leaves the largest cell.
static uint32_t coarsest(const uint16_t *level, uint32_t begin, uint32_t end) {
    uint16_t lowest = UINT16_MAX;
    for (uint32_t i = begin + 1; i < end; i++) lowest = level[i] < lowest ? level[i] : lowest;
    // Without any split (places closer than the finest grid) any cut is as good: the middle keeps leaves
    // full.
    if (lowest >= EWA_MORTON_SAME) return begin + (end - begin) / 2;
    uint32_t i = begin + 1;
    while (level[i] != lowest) i++;
    return i;
}

static uint32_t leaves_for(uint32_t places) { return (places + LEAF_PLACES - 1) / LEAF_PLACES; }

/// Returns where to cut a run. Cuts that would leave only a few places on one side are avoided, and short
/// runs are cut so that the leaves get full: the search is paid per leaf.
static uint32_t find_cut(const uint16_t *level, uint32_t begin, uint32_t end) {
    const uint32_t size = end - begin;
    if (size > FULL_RUN) return coarsest(level, begin + MIN_LEAF_PLACES - 1, end - MIN_LEAF_PLACES + 1);
    uint32_t cut = 0;
    for (uint32_t left = MIN_LEAF_PLACES; left + MIN_LEAF_PLACES <= size; left++) {
        if (leaves_for(left) + leaves_for(size - left) > leaves_for(size)) continue;
        if (!cut || level[begin + left] < level[begin + cut]) cut = left;
    }
    return begin + cut;
}

/// Cuts a run of places into leaves and flags the first place of each but the first.
static void cut_leaves(uint16_t *level, uint32_t begin, uint32_t end) {
    while (end - begin > LEAF_PLACES) {
        const uint32_t cut = find_cut(level, begin, end);
        level[cut] |= LEAF_FLAG;
        // Recursion on the smaller side only keeps the stack short.
        if (cut - begin < end - cut) {
            cut_leaves(level, begin, cut);
            begin = cut;
        } else {
            cut_leaves(level, cut, end);
            end = cut;
        }
    }
}

static void cut_section_task(void *data, uint32_t section, uint32_t worker) {
    (void)worker;
    build_job *job = data;
    const uint32_t begin = job->section_border[section], end = job->section_border[section + 1];
    cut_leaves(job->split_level, begin, end);
    uint32_t count = 1;
    for (uint32_t i = begin + 1; i < end; i++) count += job->split_level[i] >= LEAF_FLAG;
    job->section_leaves[section] = count;
}

/// Reads the places of one leaf, sets its box, stores the positions relative to its anchor.
static void fill_leaf(const build_job *job, uint32_t leaf, uint32_t begin, uint32_t end) {
    ewa_neighbours *tree = job->tree;
    double p[LEAF_PLACES][3], low[3] = {INFINITY, INFINITY, INFINITY},
                              high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = begin; i < end; i++) {
        double *at = p[i - begin];
        read_point(job->position, tree->order[tree->first[i]], at);
        for (int c = 0; c < 3; c++) {
            low[c] = at[c] < low[c] ? at[c] : low[c];
            high[c] = at[c] > high[c] ? at[c] : high[c];
        }
    }
    tree_group *group = &tree->groups[leaf / TREE_ARITY];
    for (int c = 0; c < 3; c++) {
        group->low[c][leaf % TREE_ARITY] = low[c];
        group->high[c][leaf % TREE_ARITY] = high[c];
        const double anchor = tree->anchored ? low[c] : 0;
        for (uint32_t i = begin; i < end; i++) tree->offset[c][i] = (float)(p[i - begin][c] - anchor);
    }
    tree->leaf_first[leaf] = begin;
}

static void fill_section_task(void *data, uint32_t section, uint32_t worker) {
    (void)worker;
    const build_job *job = data;
    const uint32_t end = job->section_border[section + 1];
    uint32_t leaf = job->section_leaves[section], begin = job->section_border[section];
    for (uint32_t i = begin + 1; i <= end; i++) {
        if (i < end && job->split_level[i] < LEAF_FLAG) continue;
        fill_leaf(job, leaf++, begin, i);
        begin = i;
    }
}

static ewa_status find_places(build_job *job) {
    ewa_neighbours *tree = job->tree;
    ewa_context *context = tree->context;
    sort_short_runs(job);
    job->parts = 64;
    EWA_TRY(ewa_parallel_stoppable(context, "order", count_places_task, job, job->parts));
    uint32_t sum = 0;
    for (uint32_t part = 0; part < job->parts; part++) {
        const uint32_t count = job->part_count[part];
        job->part_count[part] = sum;
        sum += count;
    }
    tree->place_count = sum;
    tree->first = ewa_allocate(context, (size_t)sum + 1, sizeof *tree->first);
    if (!tree->first) return EWA_ERROR_MEMORY;
    EWA_TRY(ewa_parallel_stoppable(context, "order", list_places_task, job, job->parts));
    tree->first[sum] = job->finite_count;
    // From here on the levels are those between places.
    if (sum < job->finite_count)
        for (uint32_t place = 0; place < sum; place++)
            job->split_level[place] = job->split_level[tree->first[place]];
    return EWA_OK;
}

static ewa_status find_leaves(build_job *job) {
    ewa_neighbours *tree = job->tree;
    ewa_context *context = tree->context;
    job->section_border[0] = 0;
    for (uint32_t section = 1; section < job->section_count; section++) {
        const uint32_t middle = section * SECTION_PLACES;
        job->section_border[section] =
            coarsest(job->split_level, middle - SECTION_WINDOW, middle + SECTION_WINDOW);
    }
    job->section_border[job->section_count] = tree->place_count;
    EWA_TRY(ewa_parallel_stoppable(context, "order", cut_section_task, job, job->section_count));
    uint32_t sum = 0;
    for (uint32_t section = 0; section < job->section_count; section++) {
        const uint32_t count = job->section_leaves[section];
        job->section_leaves[section] = sum;
        sum += count;
    }
    tree->leaf_count = sum;
    size_t nodes = sum;
    do {
        const size_t groups = (nodes + TREE_ARITY - 1) / TREE_ARITY;
        tree->level_start[tree->level_count++] = tree->group_count;
        tree->group_count += groups;
        nodes = groups;
    } while (nodes > 1);
    tree->leaf_first = ewa_allocate(context, (size_t)sum + 1, sizeof *tree->leaf_first);
    tree->groups = ewa_allocate(context, tree->group_count, sizeof *tree->groups);
    const size_t padded = (size_t)tree->place_count + EWA_BLOCK_LANES;
    for (int c = 0; c < 3; c++) {
        tree->offset[c] = ewa_allocate(context, padded, sizeof *tree->offset[c]);
        if (!tree->offset[c]) return EWA_ERROR_MEMORY;
        memset(&tree->offset[c][tree->place_count], 0, EWA_BLOCK_LANES * sizeof *tree->offset[c]);
    }
    if (!tree->leaf_first || !tree->groups) return EWA_ERROR_MEMORY;
    for (size_t g = 0; g < tree->group_count; g++)
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < TREE_ARITY; i++)
                tree->groups[g].low[c][i] = INFINITY, tree->groups[g].high[c][i] = -INFINITY;
    tree->leaf_first[sum] = tree->place_count;
    return ewa_parallel_stoppable(context, "order", fill_section_task, job, job->section_count);
}

/// Sets the boxes of each level from those below.
static void fill_levels(ewa_neighbours *tree) {
    for (uint32_t level = 1; level < tree->level_count; level++) {
        const size_t below = tree->level_start[level - 1], here = tree->level_start[level];
        for (size_t node = 0; node < here - below; node++) {
            const tree_group *children = &tree->groups[below + node];
            tree_group *group = &tree->groups[here + node / TREE_ARITY];
            for (int c = 0; c < 3; c++) {
                double low = INFINITY, high = -INFINITY;
                for (int i = 0; i < TREE_ARITY; i++) {
                    low = children->low[c][i] < low ? children->low[c][i] : low;
                    high = children->high[c][i] > high ? children->high[c][i] : high;
                }
                group->low[c][node % TREE_ARITY] = low;
                group->high[c][node % TREE_ARITY] = high;
            }
        }
    }
}

static ewa_status build(build_job *job) {
    ewa_neighbours *tree = job->tree;
    EWA_TRY(ewa_morton_order(tree->context, job->position, tree->point_count, tree->order, job->split_level,
                             &job->finite_count));
    EWA_TRY(find_places(job));
    if (tree->place_count == 0) return EWA_OK;
    const uint32_t whole = tree->place_count / SECTION_PLACES;
    job->section_count = whole ? whole : 1;
    const size_t borders = (size_t)job->section_count + 1;
    job->section_border = ewa_allocate(tree->context, borders, 2 * sizeof *job->section_border);
    if (!job->section_border) return EWA_ERROR_MEMORY;
    job->section_leaves = job->section_border + borders;
    ewa_status status = find_leaves(job);
    if (status == EWA_OK) fill_levels(tree);
    ewa_release(tree->context, job->section_border, borders, 2 * sizeof *job->section_border);
    return status;
}

ewa_status ewa_neighbours_create(ewa_context *context, const ewa_attribute *position, uint32_t count,
                                 ewa_neighbours **made) {
    *made = NULL;
    ewa_neighbours *tree = ewa_allocate_zeroed(context, 1, sizeof *tree);
    if (!tree) return EWA_ERROR_MEMORY;
    tree->context = context;
    tree->point_count = count;
    tree->anchored = position->type != EWA_F32;
    tree->order = ewa_allocate(context, count, sizeof *tree->order);
    build_job job = {.tree = tree, .position = position};
    job.split_level = ewa_allocate(context, count, sizeof *job.split_level);
    ewa_status status = tree->order && job.split_level ? build(&job) : EWA_ERROR_MEMORY;
    ewa_release(context, job.split_level, count, sizeof *job.split_level);
    if (status != EWA_OK) ewa_neighbours_destroy(&tree);
    *made = tree;
    return status;
}

void ewa_neighbours_end_visits(ewa_neighbours *neighbours) {
    ewa_neighbours *tree = neighbours;
    const size_t padded = (size_t)tree->place_count + EWA_BLOCK_LANES;
    for (int c = 0; c < 3; c++) {
        ewa_release(tree->context, tree->offset[c], padded, sizeof *tree->offset[c]);
        tree->offset[c] = NULL;
    }
    ewa_release(tree->context, tree->groups, tree->group_count, sizeof *tree->groups);
    ewa_release(tree->context, tree->leaf_first, (size_t)tree->leaf_count + 1, sizeof *tree->leaf_first);
    tree->groups = NULL;
    tree->leaf_first = NULL;
}

void ewa_neighbours_destroy(ewa_neighbours **neighbours) {
    if (!neighbours || !*neighbours) return;
    ewa_neighbours *tree = *neighbours;
    ewa_context *context = tree->context;
    ewa_neighbours_end_visits(tree);
    ewa_release(context, tree->first, (size_t)tree->place_count + 1, sizeof *tree->first);
    ewa_release(context, tree->order, tree->point_count, sizeof *tree->order);
    ewa_release(context, tree, 1, sizeof *tree);
    *neighbours = NULL;
}

uint32_t ewa_neighbours_place_count(const ewa_neighbours *neighbours) { return neighbours->place_count; }

uint32_t ewa_neighbours_finite_count(const ewa_neighbours *neighbours) {
    return neighbours->first[neighbours->place_count];
}

const uint32_t *ewa_neighbours_points(const ewa_neighbours *neighbours, uint32_t place, uint32_t *count) {
    *count = neighbours->first[place + 1] - neighbours->first[place];
    return neighbours->order + neighbours->first[place];
}

/// Returns the leaf that holds a place.
static uint32_t leaf_of(const ewa_neighbours *tree, uint32_t place) {
    uint32_t low = 0, high = tree->leaf_count;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (tree->leaf_first[middle] <= place)
            low = middle;
        else
            high = middle;
    }
    return low;
}

const float *const *ewa_neighbours_offsets(const ewa_neighbours *neighbours) {
    return neighbours->anchored ? NULL : (const float *const *)neighbours->offset;
}

void ewa_neighbours_positions(const ewa_neighbours *neighbours, uint32_t first, uint32_t count,
                              double (*position)[3]) {
    for (uint32_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) position[i][c] = (double)neighbours->offset[c][first + i];
    if (!neighbours->anchored || !count) return;
    uint32_t leaf = leaf_of(neighbours, first);
    for (uint32_t i = 0; i < count; i++) {
        while (neighbours->leaf_first[leaf + 1] <= first + i) leaf++;
        for (int c = 0; c < 3; c++)
            position[i][c] += neighbours->groups[leaf / TREE_ARITY].low[c][leaf % TREE_ARITY];
    }
}
