// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The search: leaf by leaf, all places of a leaf share one list of candidates.
//
// The candidates of a leaf are the places in its box grown by a radius. It is done when every lane has k of
// them within that radius; the first guess is what the leaf before it needed. Where no radius serves all
// lanes (places of very different density, an outlier far from everything) each place is searched alone, with
// the radius from a branch-and-bound descent: J. H. Friedman, J. L. Bentley, R. A. Finkel, "An algorithm for
// finding best matches in logarithmic expected time", 1977.
#include "base/base.h"
#include "cloud/neighbours_tree.h"

#include <float.h>
#include <math.h>

enum {
    TASK_LEAVES = 64,
    MAX_TRIES = 4, // radii for a whole leaf before its places are searched one by one
    STACK_NODES = TREE_MAX_LEVELS * TREE_ARITY,
    MAX_UNIT_EXPONENT = 126, // of single precision
    LISTED_GROUPS = 8,       // of leaves near a group
    LISTED_PLACES = 4,       // of a leaf, more than which are searched by that list
};

// A disc of so many spacings times the root of k holds k places and half as many more.
static const double SPACING_SHARE = 0.7;
// The guess for a leaf over what its predecessor needed: larger means fewer second tries but more candidates.
static const double GUESS_MARGIN = 1.1;
// The same over what one of its places needs.
static const double FIRST_GUESS_MARGIN = 1.2;
// The reach of a group's list over what the leaf needs for which it is made.
static const double LIST_MARGIN = 1.3;
// The first guess of all over the diagonal of the leaf: what an even surface needs.
static const double DIAGONAL_SHARE = 0.75;
// Single precision may find the k-th neighbour a little further away than double does.
static const double ROUNDING_MARGIN = 0x1p-20;

/// The leaves near a group of leaves, ascending, and their boxes: sixteen searches go down the tree once.
typedef struct near_list {
    tree_group boxes[LISTED_GROUPS];
    uint32_t leaf[LISTED_GROUPS * TREE_ARITY];
    uint32_t group, count;
    double radius; // up to which places in the group's box may search; negative: none may
} near_list;

/// What one worker writes.
typedef struct scratch {
    ewa_block block;
    near_list list;
} scratch;

typedef struct search_job {
    const ewa_neighbours *tree;
    const search_kernels *kernels;
    int32_t rank; // k + 1: the place itself is its first neighbour
    const ewa_visit_choice *choice;
    ewa_block_visit *visit;
    void *user;
    scratch *scratch; // one per worker
} search_job;

typedef struct node {
    uint32_t level, index;
    double distance2;
} node;

static void anchor_of(const ewa_neighbours *tree, uint32_t leaf, double anchor[3]) {
    const tree_group *group = &tree->groups[leaf / TREE_ARITY];
    for (int c = 0; c < 3; c++) anchor[c] = tree->anchored ? group->low[c][leaf % TREE_ARITY] : 0;
}

static void place_position(const ewa_neighbours *tree, uint32_t leaf, uint32_t place, double p[3]) {
    anchor_of(tree, leaf, p);
    for (int c = 0; c < 3; c++) p[c] += (double)tree->offset[c][place];
}

/// What the offsets of a leaf lack to be coordinates of the block; zero when nothing is anchored.
static void shift_of(const ewa_neighbours *tree, const tree_query *query, uint32_t leaf, float shift[3]) {
    double anchor[3];
    anchor_of(tree, leaf, anchor);
    for (int c = 0; c < 3; c++) shift[c] = (float)((anchor[c] - query->anchor[c]) * query->per_unit);
}

/// What a query compares with: never infinite, as the distance of boxes that are not there is.
static double finite_square(double radius) { return fmin(radius * radius, DBL_MAX); }

/// Receives a leaf near enough to the query's box; returns false to stop.
typedef bool leaf_visit(const search_job *job, const tree_query *query, uint32_t leaf, void *user);

/// Visits the leaves near enough to the query's box, in order. Returns false when a visit stopped it.
static bool visit_near(const search_job *job, const tree_query *query, leaf_visit *visit, void *user) {
    const ewa_neighbours *tree = job->tree;
    node stack[STACK_NODES];
    uint32_t depth = 1;
    stack[0] = (node){.level = tree->level_count - 1, .index = 0};
    while (depth) {
        const node top = stack[--depth]; // a group of nodes of this level
        uint32_t near = job->kernels->overlap(&tree->groups[tree->level_start[top.level] + top.index], query);
        if (top.level > 0) {
            while (near) {
                const uint32_t last = 31 - (uint32_t)__builtin_clz(near);
                stack[depth++] = (node){.level = top.level - 1, .index = top.index * TREE_ARITY + last};
                near ^= 1u << last;
            }
            continue;
        }
        for (; near; near &= near - 1)
            if (!visit(job, query, top.index * TREE_ARITY + (uint32_t)__builtin_ctz(near), user))
                return false;
    }
    return true;
}

/// Appends the places of a leaf that are near enough. Returns false when they may be too many.
static bool gather_leaf(const search_job *job, const tree_query *query, uint32_t leaf, void *user) {
    const ewa_neighbours *tree = job->tree;
    ewa_block *block = user;
    const uint32_t first = tree->leaf_first[leaf], count = tree->leaf_first[leaf + 1] - first;
    if (block->candidate_count + count > EWA_BLOCK_CANDIDATES) return false;
    float shift[3];
    shift_of(tree, query, leaf, shift);
    job->kernels->gather(tree, query, first, count, shift, block);
    return true;
}

static bool list_leaf(const search_job *job, const tree_query *query, uint32_t leaf, void *user) {
    (void)query;
    near_list *list = user;
    if (list->count == LISTED_GROUPS * TREE_ARITY) return false;
    const tree_group *from = &job->tree->groups[leaf / TREE_ARITY];
    tree_group *to = &list->boxes[list->count / TREE_ARITY];
    for (int c = 0; c < 3; c++) {
        to->low[c][list->count % TREE_ARITY] = from->low[c][leaf % TREE_ARITY];
        to->high[c][list->count % TREE_ARITY] = from->high[c][leaf % TREE_ARITY];
    }
    list->leaf[list->count++] = leaf;
    return true;
}

/// Lists the leaves within `radius` of a group of leaves, unless they are too many.
static void make_list(const search_job *job, uint32_t group, double radius, near_list *list) {
    const tree_group *leaves = &job->tree->groups[group];
    tree_query query = {.radius2 = finite_square(radius)};
    for (int c = 0; c < 3; c++) {
        query.low[c] = INFINITY, query.high[c] = -INFINITY;
        for (int i = 0; i < TREE_ARITY; i++) {
            query.low[c] = leaves->low[c][i] < query.low[c] ? leaves->low[c][i] : query.low[c];
            query.high[c] = leaves->high[c][i] > query.high[c] ? leaves->high[c][i] : query.high[c];
        }
    }
    list->group = group;
    list->count = 0;
    const bool all = visit_near(job, &query, list_leaf, list);
    list->radius = all ? radius : -1;
    for (uint32_t i = list->count; i % TREE_ARITY; i++)
        for (int c = 0; c < 3; c++)
            list->boxes[i / TREE_ARITY].low[c][i % TREE_ARITY] = INFINITY,
                                                   list->boxes[i / TREE_ARITY].high[c][i % TREE_ARITY] =
                                                       -INFINITY;
}

/// Gathers the places near enough to the query's box, in order. Returns false when they are too many.
static bool gather_near(const search_job *job, const tree_query *query, const near_list *list,
                        ewa_block *block) {
    block->candidate_count = 0;
    if (!list) return visit_near(job, query, gather_leaf, block);
    for (uint32_t i = 0; i < list->count; i += TREE_ARITY) {
        uint32_t near = job->kernels->overlap(&list->boxes[i / TREE_ARITY], query);
        for (; near; near &= near - 1)
            if (!gather_leaf(job, query, list->leaf[i + (uint32_t)__builtin_ctz(near)], block)) return false;
    }
    return true;
}

static double box_distance2(const tree_group *group, uint32_t child, const double p[3]) {
    double sum = 0;
    for (int c = 0; c < 3; c++) {
        const double below = group->low[c][child] - p[c], above = p[c] - group->high[c][child];
        const double outside = below > 0 ? below : above > 0 ? above : 0;
        sum += outside * outside;
    }
    return sum;
}

/// Returns the distance of the `rank`-th nearest place, the place at p itself being the first.
static double nearest_distance(const search_job *job, const double p[3]) {
    const ewa_neighbours *tree = job->tree;
    const int32_t rank = job->rank;
    double best[EWA_NEIGHBOURS_MAX + 1]; // ascending
    for (int32_t i = 0; i < rank; i++) best[i] = INFINITY;
    node stack[STACK_NODES];
    uint32_t depth = 1;
    stack[0] = (node){.level = tree->level_count - 1, .index = 0, .distance2 = 0};
    while (depth) {
        const node top = stack[--depth];
        if (!(top.distance2 < best[rank - 1])) continue;
        const tree_group *group = &tree->groups[tree->level_start[top.level] + top.index];
        const uint32_t bottom = depth;
        node leaves[TREE_ARITY];
        node *list = top.level ? &stack[bottom] : leaves;
        uint32_t count = 0;
        for (uint32_t c = 0; c < TREE_ARITY; c++) {
            const node child = {top.level ? top.level - 1 : 0, top.index * TREE_ARITY + c,
                                box_distance2(group, c, p)};
            if (!(child.distance2 < best[rank - 1])) continue;
            uint32_t to = count++;
            for (; to > 0 && list[to - 1].distance2 < child.distance2; to--) list[to] = list[to - 1];
            list[to] = child; // the nearest comes last
        }
        if (top.level) {
            depth += count;
            continue;
        }
        while (count--) {
            const uint32_t leaf = leaves[count].index;
            if (!(leaves[count].distance2 < best[rank - 1])) break;
            double anchor[3];
            anchor_of(tree, leaf, anchor);
            for (uint32_t i = tree->leaf_first[leaf]; i < tree->leaf_first[leaf + 1]; i++) {
                double distance2 = 0;
                for (int c = 0; c < 3; c++) {
                    const double d = (double)tree->offset[c][i] + anchor[c] - p[c];
                    distance2 += d * d;
                }
                if (!(distance2 < best[rank - 1])) continue;
                int32_t to = rank - 1;
                for (; to > 0 && best[to - 1] > distance2; to--) best[to] = best[to - 1];
                best[to] = distance2;
            }
        }
    }
    return sqrt(best[rank - 1]);
}

/// One attempt at the places [first, first + count) of a leaf.
typedef struct attempt {
    uint32_t leaf, first, count;
    double low[3], high[3]; // their box
    double radius;          // up to which candidates are gathered
    bool exact;             // not a guess: of too many candidates the first ones serve
} attempt;

typedef enum outcome { FOUND, TOO_FEW, TOO_MANY } outcome;

static void set_lanes(const ewa_neighbours *tree, const attempt *a, const tree_query *query,
                      ewa_block *block) {
    float shift[3];
    shift_of(tree, query, a->leaf, shift);
    float *const lanes[3] = {block->lane_x, block->lane_y, block->lane_z};
    for (int c = 0; c < 3; c++) {
        const float *offset = &tree->offset[c][a->first]; // readable beyond the last place
        for (uint32_t lane = 0; lane < EWA_BLOCK_LANES; lane++)
            lanes[c][lane] = offset[lane] * query->per_unit + shift[c];
        for (uint32_t lane = a->count; lane < EWA_BLOCK_LANES; lane++) lanes[c][lane] = lanes[c][0];
    }
    block->first_place = a->first;
    block->lane_count = a->count;
}

/// Prepares a search around the attempt's box; returns the unit of the block.
static double set_query(const ewa_neighbours *tree, const attempt *a, tree_query *query) {
    double size = a->radius;
    for (int c = 0; c < 3; c++) size = fmax(size, a->high[c] - a->low[c]);
    // A power of two changes no digit, and keeps the squares inside the range of single precision.
    int exponent = 0;
    if (size > 0 && isfinite(size)) frexp(size, &exponent);
    exponent = exponent < -MAX_UNIT_EXPONENT ? -MAX_UNIT_EXPONENT : exponent;
    exponent = exponent > MAX_UNIT_EXPONENT ? MAX_UNIT_EXPONENT : exponent;
    query->per_unit = (float)ldexp(1, -exponent);
    query->radius2 = finite_square(a->radius);
    const double local_radius = a->radius * query->per_unit * (1 + ROUNDING_MARGIN);
    query->local_radius2 = (float)(local_radius * local_radius);
    for (int c = 0; c < 3; c++) {
        query->low[c] = a->low[c];
        query->high[c] = a->high[c];
        query->anchor[c] = tree->anchored ? a->low[c] : 0;
        query->local_low[c] = (float)((a->low[c] - query->anchor[c]) * query->per_unit);
        query->local_high[c] = (float)((a->high[c] - query->anchor[c]) * query->per_unit);
    }
    return ldexp(1, exponent);
}

/// Returns the list of leaves for an attempt, NULL when it has to search the whole tree.
static const near_list *find_list(const search_job *job, const attempt *a, near_list *list) {
    const uint32_t group = a->leaf / TREE_ARITY;
    if (list->group != group) make_list(job, group, a->radius * LIST_MARGIN, list);
    return a->radius <= list->radius ? list : NULL;
}

/// Fills the block. `*needed` gets the largest distance of a k-th neighbour, or a guess at it after TOO_FEW.
static outcome search(const search_job *job, const attempt *a, scratch *s, double *needed) {
    const ewa_neighbours *tree = job->tree;
    ewa_block *block = &s->block;
    tree_query query;
    block->unit_world = set_query(tree, a, &query);
    // A list serves many searches around whole leaves.
    const near_list *list = a->count > LISTED_PLACES ? find_list(job, a, &s->list) : NULL;
    const bool all = gather_near(job, &query, list, block);
    if (!all && !a->exact) return TOO_MANY;
    set_lanes(tree, a, &query, block);
    const double limit = a->radius * (double)query.per_unit;
    const float limit2 = (float)(limit * limit);
    float within[EWA_BLOCK_LANES], fewest = EWA_BLOCK_CANDIDATES;
    job->kernels->measure(block, limit2, within);
    for (uint32_t lane = 0; lane < EWA_BLOCK_LANES; lane++)
        fewest = within[lane] < fewest ? within[lane] : fewest;
    if (fewest < (float)job->rank) {
        *needed = a->radius * sqrt((job->rank + 1) / fmax(fewest, 1));
        for (uint32_t lane = 0; lane < EWA_BLOCK_LANES; lane++) block->radius2[lane] = limit2;
        return TOO_FEW;
    }
    job->kernels->select(block, limit2, within, job->rank);
    float largest = 0;
    for (uint32_t lane = 0; lane < EWA_BLOCK_LANES; lane++)
        largest = block->radius2[lane] > largest ? block->radius2[lane] : largest;
    *needed = sqrt((double)largest) * block->unit_world;
    return FOUND;
}

static bool is_chosen(const search_job *job, uint32_t place) {
    if (!job->choice->chosen) return true;
    const uint8_t bits = job->choice->chosen_bits ? job->choice->chosen_bits : UINT8_MAX;
    return job->choice->chosen[place] & bits;
}

static double guess_by_spacing(const search_job *job, uint32_t place) {
    return (double)job->choice->spacing[place] * sqrt(job->rank) * SPACING_SHARE;
}

/// Searches with the attempt's radius and larger ones, as long as they have too few candidates.
static outcome search_wider(const search_job *job, attempt *a, scratch *s, double *needed) {
    for (int tries = 0; tries < MAX_TRIES; tries++) {
        const outcome result = search(job, a, s, needed);
        if (result != TOO_FEW) return result;
        a->radius = fmax(*needed, a->radius * FIRST_GUESS_MARGIN);
    }
    return TOO_FEW;
}

/// The place's own search always ends: with too many at the same distance it takes the first ones in order.
static void search_alone(const search_job *job, const attempt *whole, uint32_t place, uint32_t worker) {
    attempt a = {.leaf = whole->leaf, .first = place, .count = 1};
    place_position(job->tree, a.leaf, place, a.low);
    for (int c = 0; c < 3; c++) a.high[c] = a.low[c];
    scratch *s = &job->scratch[worker];
    double needed;
    a.radius = job->choice->spacing ? guess_by_spacing(job, place) : 0;
    if (!(a.radius > 0) || search_wider(job, &a, s, &needed) != FOUND) {
        a.radius = nearest_distance(job, a.low) * (1 + ROUNDING_MARGIN);
        a.exact = true;
        search(job, &a, s, &needed);
    }
    job->visit(job->user, &s->block, worker);
}

static double diagonal(const attempt *a) {
    double sum = 0;
    for (int c = 0; c < 3; c++) sum += (a->high[c] - a->low[c]) * (a->high[c] - a->low[c]);
    return sqrt(sum);
}

/// A guess that holds for the attempt whatever the leaf before it needed.
static double first_guess(const search_job *job, const attempt *a) {
    const double by_spacing = job->choice->spacing ? guess_by_spacing(job, a->first) : 0;
    if (by_spacing > 0) return by_spacing;
    double p[3];
    place_position(job->tree, a->leaf, a->first, p);
    return nearest_distance(job, p) * FIRST_GUESS_MARGIN;
}

/// Makes an attempt at those places of a leaf that are chosen and those between them; false when none is.
static bool set_attempt(const search_job *job, uint32_t leaf, attempt *a) {
    const ewa_neighbours *tree = job->tree;
    if (leaf % job->choice->sample_step != 0) return false;
    uint32_t first = tree->leaf_first[leaf], end = tree->leaf_first[leaf + 1];
    const tree_group *group = &tree->groups[leaf / TREE_ARITY];
    for (int c = 0; c < 3; c++) {
        a->low[c] = group->low[c][leaf % TREE_ARITY];
        a->high[c] = group->high[c][leaf % TREE_ARITY];
    }
    if (job->choice->chosen) {
        const uint32_t all = end - first;
        while (first < end && !is_chosen(job, first)) first++;
        while (first < end && !is_chosen(job, end - 1)) end--;
        if (first == end) return false;
        for (uint32_t place = first; end - first < all && place < end; place++) {
            double p[3];
            place_position(tree, leaf, place, p);
            for (int c = 0; c < 3; c++) {
                a->low[c] = place == first || p[c] < a->low[c] ? p[c] : a->low[c];
                a->high[c] = place == first || p[c] > a->high[c] ? p[c] : a->high[c];
            }
        }
    }
    a->leaf = leaf;
    a->first = first;
    a->count = end - first;
    a->exact = false;
    return true;
}

/// Searches a leaf; `*guess` is the radius to begin with, negative when unknown, and becomes that for the
/// next leaf.
static void search_leaf(const search_job *job, uint32_t leaf, double *guess, uint32_t worker) {
    attempt a;
    if (!set_attempt(job, leaf, &a)) return;
    // A part of a leaf says nothing about the density.
    a.radius = *guess >= 0 ? *guess : job->choice->chosen ? 0 : DIAGONAL_SHARE * diagonal(&a);
    bool guessed_here = !(a.radius > 0);
    if (guessed_here) a.radius = first_guess(job, &a);
    for (int tries = 0; tries < MAX_TRIES; tries++) {
        double needed = 0;
        const outcome result = search(job, &a, &job->scratch[worker], &needed);
        if (result == FOUND) {
            job->visit(job->user, &job->scratch[worker].block, worker);
            *guess = needed * GUESS_MARGIN;
            return;
        }
        if (result == TOO_FEW) {
            a.radius = fmax(needed, a.radius * FIRST_GUESS_MARGIN);
        } else {
            if (guessed_here) break;
            a.radius = first_guess(job, &a);
            guessed_here = true;
        }
    }
    for (uint32_t place = a.first; place < a.first + a.count; place++)
        if (is_chosen(job, place)) search_alone(job, &a, place, worker);
    *guess = -1;
}

static void search_task(void *data, uint32_t index, uint32_t worker) {
    const search_job *job = data;
    const uint32_t leaf_count = job->tree->leaf_count, begin = index * TASK_LEAVES;
    const uint32_t end = leaf_count - begin < TASK_LEAVES ? leaf_count : begin + TASK_LEAVES;
    double guess = -1;
    job->scratch[worker].list.group = UINT32_MAX;
    for (uint32_t leaf = begin; leaf < end; leaf++) search_leaf(job, leaf, &guess, worker);
}

ewa_status ewa_neighbours_visit(const ewa_neighbours *neighbours, const ewa_visit_choice *choice,
                                ewa_block_visit *visit, void *user) {
    ewa_context *context = neighbours->context;
    if (neighbours->place_count == 0) return ewa_progress(context, choice->stage, 1);
    const uint32_t others = neighbours->place_count - 1, wanted = choice->neighbour_count;
    search_job job = {.tree = neighbours,
                      .kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_search_kernels),
                      .rank = 1 + (int32_t)(wanted < others ? wanted : others),
                      .choice = choice,
                      .visit = visit,
                      .user = user};
    const uint32_t worker_count = ewa_context_worker_count(context);
    job.scratch = ewa_allocate(context, worker_count, sizeof *job.scratch);
    if (!job.scratch) return EWA_ERROR_MEMORY;
    const uint32_t tasks = (neighbours->leaf_count + TASK_LEAVES - 1) / TASK_LEAVES;
    const ewa_status status = ewa_parallel_stoppable(context, choice->stage, search_task, &job, tasks);
    ewa_release(context, job.scratch, worker_count, sizeof *job.scratch);
    return status;
}
