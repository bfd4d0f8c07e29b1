// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Groups of neighbouring surfels, by a tree of planes.
//
// Four surfels in a row along the Morton curve would do on a grid, but the curve jumps: what stands for surfels
// on both sides of a jump lies between them, and leaves holes where they were. Of 64 in a row, few are near a
// jump.
#include "surface/groups.h"

#include <math.h>
#include <string.h>

enum { LANES = EWA_PACKET_LANES, AXES = 4, FEW = 8 };

/// Neighbours are closer than that, in support radii: the default radius is 1.14 spacings.
static const float GAP = 1.5f;

/// Support radii per unit of a normal: where faces meet at right angles and more, that is a gap.
static const float NORMAL_RADII = 2;

/// Of a key: beyond, all places are alike.
static const float FARTHEST = 1e9f;

/// Places or normals, in support radii; of the four axes the last one is none.
typedef struct lane_keys {
    float key[EWA_WINDOW_LANES][AXES];
} lane_keys;

typedef struct divider {
    lane_keys places, normals;
    bool with_normals; ///< they differ
    uint8_t *order;
    uint16_t *starts;
    uint32_t group_count;
} divider;

void ewa_window_read(const ewa_surfels *surfels, uint32_t first, uint32_t packet_count, ewa_window *window) {
    window->first = first, window->packet_count = packet_count;
    const ewa_vec3 base = ewa_packet_center(surfels, first);
    for (uint32_t k = 0; k < packet_count; k++) {
        const ewa_packet *packet = &surfels->packets[first + k];
        const ewa_vec3 way = vec3_sub(ewa_packet_center(surfels, first + k), base);
        const float from[3] = {(float)way.x, (float)way.y, (float)way.z};
        const float *const places[3] = {packet->x, packet->y, packet->z};
        for (int c = 0; c < 3; c++) {
            float *to = window->place[c] + k * LANES;
            for (int i = 0; i < LANES; i++) to[i] = places[c][i] + from[c];
        }
        memcpy(window->sigma + k * LANES, packet->sigma, sizeof packet->sigma);
        float(*normal)[EWA_WINDOW_LANES] = window->normal;
        for (uint32_t i = 0, to = k * LANES; i < LANES; i++, to++) {
            const float u = packet->oct_x[i] * (1.0f / 32767), v = packet->oct_y[i] * (1.0f / 32767);
            const float z = 1 - fabsf(u) - fabsf(v), fold = z < 0 ? -z : 0;
            const float x = u - copysignf(fold, u), y = v - copysignf(fold, v);
            const float inverse = 1 / sqrtf(x * x + y * y + z * z);
            normal[0][to] = x * inverse, normal[1][to] = y * inverse, normal[2][to] = z * inverse;
        }
    }
}

/// An axis along which to divide.
typedef struct key_axis {
    const float *keys; ///< [AXES * lane]
    float low, extent;
} key_axis;

/// Widens `widest` to the axis along which the lanes [first, end) of the order reach farthest.
static inline void find_widest(const lane_keys *keys, const uint8_t *order, uint32_t first, uint32_t end,
                               key_axis *widest) {
    float low[AXES], high[AXES];
    for (int c = 0; c < AXES; c++) low[c] = high[c] = keys->key[order[first]][c];
    for (uint32_t i = first + 1; i < end; i++) {
        const float *key = keys->key[order[i]];
        for (int c = 0; c < AXES; c++) {
            low[c] = key[c] < low[c] ? key[c] : low[c];
            high[c] = key[c] > high[c] ? key[c] : high[c];
        }
    }
    for (int c = 0; c < 3; c++)
        if (high[c] - low[c] > widest->extent)
            *widest = (key_axis){&keys->key[0][c], low[c], high[c] - low[c]};
}

static inline float key_of(const float *keys, uint8_t lane) { return keys[AXES * (size_t)lane]; }

/// Sorts them along an axis; equal ones keep their order.
static void sort_along(uint8_t *order, const float *keys, uint32_t first, uint32_t end) {
    for (uint32_t i = first + 1; i < end; i++) {
        const uint8_t lane = order[i];
        const float key = key_of(keys, lane);
        uint32_t to = i;
        for (; to > first && key_of(keys, order[to - 1]) > key; to--) order[to] = order[to - 1];
        order[to] = lane;
    }
}

/// Puts those below a key before the others; returns where the others begin.
static uint32_t part_below(uint8_t *order, const float *keys, uint32_t first, uint32_t end, float key) {
    uint32_t middle = first;
    for (uint32_t i = first; i < end; i++) { // without branches, which would be guessed wrong
        const uint8_t lane = order[i];
        order[i] = order[middle], order[middle] = lane;
        middle += key_of(keys, lane) < key;
    }
    return middle;
}

/// Puts the `middle` - `first` least ones first (quickselect).
static void part_min(uint8_t *order, const float *keys, uint32_t first, uint32_t end, uint32_t middle) {
    while (end - first > FEW) {
        const float a = key_of(keys, order[first]), b = key_of(keys, order[(first + end) / 2]),
                    c = key_of(keys, order[end - 1]);
        const float low = a < b ? a : b, high = a < b ? b : a, pivot = c < low ? low : c > high ? high : c;
        const uint32_t below = part_below(order, keys, first, end, pivot);
        uint32_t above = below; // those of the pivot's key, one at least, lie between
        for (uint32_t i = below; i < end; i++) {
            const uint8_t lane = order[i];
            order[i] = order[above], order[above] = lane;
            above += key_of(keys, lane) == pivot;
        }
        if (middle <= below)
            end = below;
        else if (middle >= above)
            first = above;
        else
            return;
    }
    sort_along(order, keys, first, end);
}

/// Whether there is a gap among the lanes [first, end) of the order; sets `between` to a key in the widest one.
/// Gaps of less than twice GAP may be missed.
static bool find_gap(const key_axis *axis, const uint8_t *order, uint32_t first, uint32_t end,
                     float *between) {
    enum { STEPS = 62 };
    const float step = axis->extent / STEPS > GAP ? axis->extent / STEPS : GAP, per_step = 1 / step;
    uint64_t taken = 0;
    for (uint32_t i = first; i < end; i++)
        taken |= UINT64_C(1) << (uint32_t)((key_of(axis->keys, order[i]) - axis->low) * per_step);
    if (!(taken & (taken + 1))) return false; // all of the lowest steps
    uint32_t widest = 0, at = 0, run = 0;
    for (uint32_t k = 0; taken >> k; k++) {
        run = taken >> k & 1 ? 0 : run + 1;
        if (run > widest) widest = run, at = k;
    }
    *between = axis->low + ((float)at + 0.5f - 0.5f * (float)(widest - 1)) * step;
    return true;
}

/// Where to divide the lanes [first, end) of the order, which are parted there; `first`: they are a group.
static uint32_t find_middle(divider *d, uint32_t first, uint32_t end) {
    const uint32_t count = end - first, groups = (count + EWA_GROUP_SURFELS - 1) / EWA_GROUP_SURFELS;
    key_axis axis = {.extent = -1};
    find_widest(&d->places, d->order, first, end, &axis);
    if (d->with_normals) find_widest(&d->normals, d->order, first, end, &axis);
    float between;
    if (axis.extent > GAP && find_gap(&axis, d->order, first, end, &between))
        return part_below(d->order, axis.keys, first, end, between);
    if (groups == 1) return first;
    const uint32_t even = first + count * (groups / 2) / groups;
    part_min(d->order, axis.keys, first, end, even);
    return even;
}

static void divide(divider *d, uint32_t first, uint32_t end) {
    const uint32_t middle = find_middle(d, first, end);
    if (middle > first && middle < end) {
        divide(d, first, middle);
        divide(d, middle, end);
        return;
    }
    d->starts[first / LANES] |= (uint16_t)(1u << first % LANES);
    d->group_count++;
}

uint32_t ewa_groups_make(const ewa_window *window, double cutoff, uint8_t order[EWA_WINDOW_LANES],
                         uint16_t starts[EWA_WINDOW_PACKETS]) {
    divider d;
    d.order = order, d.starts = starts, d.group_count = 0;
    const uint32_t lanes = window->packet_count * LANES;
    uint32_t count = 0;
    double sigmas = 0;
    for (uint32_t k = 0; k < window->packet_count; k++) starts[k] = 0;
    for (uint32_t i = 0; i < lanes; i++) {
        if (!(window->sigma[i] > 0)) continue;
        order[count++] = (uint8_t)i;
        sigmas += (double)window->sigma[i];
    }
    if (!count) return 0;
    const float per_radius = (float)(count / (cutoff * sigmas));
    for (uint32_t i = 0; i < lanes; i++)
        for (int c = 0; c < AXES; c++) {
            const float key = c < 3 ? window->place[c][i] * per_radius : 0;
            d.places.key[i][c] = key > -FARTHEST ? (key < FARTHEST ? key : FARTHEST) : -FARTHEST; // NaN too
            d.normals.key[i][c] = c < 3 ? window->normal[c][i] * NORMAL_RADII : 0;
        }
    key_axis normals = {.extent = -1};
    find_widest(&d.normals, order, 0, count, &normals);
    d.with_normals = normals.extent > GAP;
    divide(&d, 0, count);
    return d.group_count;
}
