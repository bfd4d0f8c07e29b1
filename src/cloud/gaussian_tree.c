// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A tree over Gaussians, from the top down. Orders along the three axes are made once; every division leaves the halves in order.
//
// Based on: X. Wu, "Color Quantization by Dynamic Programming and Principal Analysis", 1992 (dividing the part of most variance where
// that of the halves is least).
#include "cloud/gaussian_tree.h"

#include <math.h>
#include <string.h>

enum { DIGITS = 3, DIGIT_BITS = 11 }; ///< of the bits of a float

static uint32_t digit_of(uint32_t key, int digit) { return key >> digit * DIGIT_BITS & ((1u << DIGIT_BITS) - 1); }

/// Orders the members along an axis, of those at one place as they were given: by digits of the bits of their places, which as floats are in the
/// order of the numbers once the negative ones are turned over.
static void order_along(ewa_gaussian_tree *tree, const ewa_gaussians *set, const uint32_t *members, uint32_t axis) {
    uint32_t counts[DIGITS][1 << DIGIT_BITS] = {{0}}, *from = tree->moved, *to = tree->orders[axis];
    for (uint32_t i = 0; i < tree->count; i++) {
        uint32_t bits;
        memcpy(&bits, &set->centers[3 * (size_t)members[i] + axis], sizeof bits);
        tree->keys[i] = bits >> 31 ? ~bits : bits | 1u << 31;
        from[i] = i;
        for (int d = 0; d < DIGITS; d++) counts[d][digit_of(tree->keys[i], d)]++;
    }
    for (int d = 0; d < DIGITS; d++) {
        for (uint32_t k = 0, first = 0; k < 1 << DIGIT_BITS; k++) {
            const uint32_t count = counts[d][k];
            counts[d][k] = first;
            first += count;
        }
        for (uint32_t i = 0; i < tree->count; i++) to[counts[d][digit_of(tree->keys[from[i]], d)]++] = from[i];
        uint32_t *const sorted = to;
        to = from, from = sorted;
    }
}

/// Measures a node; returns the axis along which it is most spread.
static uint32_t measure(const ewa_gaussian_tree *tree, ewa_gaussian_node *node, double sums[4]) {
    double mass = 0, mean[3] = {0}, spread[3] = {0};
    const uint32_t *members = tree->orders[0] + node->first;
    for (uint32_t i = 0; i < node->count; i++) {
        const double weight = tree->weights[members[i]];
        mass += weight;
        for (uint32_t axis = 0; axis < 3; axis++) mean[axis] += weight * tree->at[axis][members[i]];
    }
    sums[3] = mass;
    for (uint32_t axis = 0; axis < 3; axis++) sums[axis] = mean[axis], mean[axis] /= mass > 0 ? mass : 1;
    for (uint32_t i = 0; i < node->count; i++)
        for (uint32_t axis = 0; axis < 3; axis++) {
            const double off = tree->at[axis][members[i]] - mean[axis];
            spread[axis] += tree->weights[members[i]] * off * off;
        }
    node->cost = spread[0] + spread[1] + spread[2];
    uint32_t widest = spread[1] > spread[0] ? 1 : 0;
    if (spread[2] > spread[widest]) widest = 2;
    return widest;
}

/// How many members of a node, the first along an axis, make the half with which the sum of both spreads is least.
static uint32_t choose_half(const ewa_gaussian_tree *tree, const ewa_gaussian_node *node, uint32_t axis, const double sums[4]) {
    const uint32_t *members = tree->orders[axis] + node->first;
    double mass = 0, sum = 0, most = 0;
    uint32_t half = node->count / 2;
    if (tree->at[axis][members[0]] == tree->at[axis][members[node->count - 1]]) return half; // all at one place
    for (uint32_t i = 0; i + 1 < node->count; i++) {
        mass += tree->weights[members[i]], sum += tree->weights[members[i]] * tree->at[axis][members[i]];
        const double rest = sums[3] - mass;
        if (!(mass > 0) || !(rest > 0)) continue;
        const double apart = sum * rest - (sums[axis] - sum) * mass, between = apart * apart / (mass * rest);
        if (between > most) most = between, half = i + 1;
    }
    return half;
}

/// Has the members of a node that are in the first half along an axis come first in all three orders.
static void divide(ewa_gaussian_tree *tree, const ewa_gaussian_node *node, uint32_t axis, uint32_t half) {
    for (uint32_t i = 0; i < node->count; i++) tree->low[tree->orders[axis][node->first + i]] = i < half;
    for (uint32_t a = 0; a < 3; a++) {
        uint32_t *order = tree->orders[a] + node->first, low = 0, high = 0;
        if (a == axis) continue;
        for (uint32_t i = 0; i < node->count; i++)
            if (tree->low[order[i]])
                order[low++] = order[i];
            else
                tree->moved[high++] = order[i];
        memcpy(order + low, tree->moved, high * sizeof *order);
    }
}

void ewa_gaussian_tree_make(ewa_gaussian_tree *tree, const ewa_gaussians *set, const uint32_t *members, uint32_t count) {
    double mass = 0;
    tree->count = count;
    for (uint32_t i = 0; i < count; i++) {
        ewa_gaussian_mass own;
        ewa_gaussian_weigh(set, members[i], &own);
        tree->weights[i] = own.mass, mass += own.mass;
        for (uint32_t axis = 0; axis < 3; axis++) tree->at[axis][i] = (double)set->centers[3 * (size_t)members[i] + axis];
    }
    for (uint32_t i = 0; i < count && !(mass > 0); i++) tree->weights[i] = 1;
    for (uint32_t axis = 0; axis < 3; axis++) order_along(tree, set, members, axis);
    tree->nodes[0] = (ewa_gaussian_node){.count = count};
    tree->node_count = 1;
    for (uint32_t n = 0; n < tree->node_count; n++) {
        ewa_gaussian_node *node = &tree->nodes[n];
        if (node->count == 1) continue;
        double sums[4];
        const uint32_t axis = measure(tree, node, sums), half = choose_half(tree, node, axis, sums);
        divide(tree, node, axis, half);
        node->halves = tree->node_count;
        tree->nodes[tree->node_count++] = (ewa_gaussian_node){.first = node->first, .count = half};
        tree->nodes[tree->node_count++] = (ewa_gaussian_node){.first = node->first + half, .count = node->count - half};
    }
    for (uint32_t i = 0; i < count; i++) tree->members[i] = members[tree->orders[0][i]];
    for (uint32_t i = 0; i < count; i++) ewa_gaussian_weigh(set, tree->members[i], &tree->masses[i]);
}

/// Whether a node is divided before another.
static bool is_dearer(const ewa_gaussian_tree *tree, uint32_t a, uint32_t b) {
    const ewa_gaussian_node *p = &tree->nodes[a], *q = &tree->nodes[b];
    if (!p->halves || !q->halves) return p->halves && !q->halves;
    return p->cost != q->cost ? p->cost > q->cost : a < b;
}

/// Moves entry `at` of a heap, whose first is the dearest, down to its place.
static void sink(ewa_gaussian_tree *tree, uint32_t at) {
    uint32_t *heap = tree->groups;
    for (uint32_t next; (next = 2 * at + 1) < tree->group_count; at = next) {
        if (next + 1 < tree->group_count && is_dearer(tree, heap[next + 1], heap[next])) next++;
        if (!is_dearer(tree, heap[next], heap[at])) return;
        const uint32_t moved = heap[at];
        heap[at] = heap[next];
        heap[next] = moved;
    }
}

/// Adds an entry.
static void swim(ewa_gaussian_tree *tree, uint32_t node) {
    uint32_t *heap = tree->groups, at = tree->group_count++;
    for (; at && is_dearer(tree, node, heap[(at - 1) / 2]); at = (at - 1) / 2) heap[at] = heap[(at - 1) / 2];
    heap[at] = node;
}

/// Puts the groups in the order of their members.
static void order_groups(ewa_gaussian_tree *tree) {
    memset(tree->moved, 0, tree->count * sizeof *tree->moved);
    for (uint32_t g = 0; g < tree->group_count; g++) tree->moved[tree->nodes[tree->groups[g]].first] = tree->groups[g] + 1;
    uint32_t to = 0;
    for (uint32_t i = 0; i < tree->count; i++)
        if (tree->moved[i]) tree->groups[to++] = tree->moved[i] - 1;
}

void ewa_gaussian_tree_cut(ewa_gaussian_tree *tree, uint32_t group_count) {
    tree->groups[0] = 0, tree->group_count = 1;
    while (tree->group_count < group_count) {
        const uint32_t halves = tree->nodes[tree->groups[0]].halves;
        tree->groups[0] = halves;
        sink(tree, 0);
        swim(tree, halves + 1);
    }
    order_groups(tree);
}

double ewa_gaussian_tree_merge(const ewa_gaussian_tree *tree, const ewa_gaussians *set, uint32_t group, ewa_gaussians *merged, size_t to) {
    const ewa_gaussian_node *node = &tree->nodes[tree->groups[group]];
    return ewa_gaussians_merge(set, tree->members + node->first, tree->masses + node->first, node->count, merged, to);
}
