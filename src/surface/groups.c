// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Groups of a packet's surfels, by a tree of planes.
//
// Four surfels in a row along the Morton curve would do on a grid, but the curve jumps: what stands for surfels
// on both sides of a jump lies between them, and leaves holes where they were.
#include "surface/groups.h"

#include <math.h>

enum { LANES = EWA_PACKET_LANES, AXES = 6 };

/// Neighbours are closer than that, in support radii: the default radius is 1.14 spacings.
static const float GAP = 1.5f;

/// Support radii per unit of a normal: where faces meet at right angles and more, that is a gap.
static const float NORMAL_RADII = 2;

typedef struct divider {
    float keys[AXES][LANES]; ///< [axis][lane] places, then normals, in support radii
    uint8_t order[LANES];    ///< lanes, those of a group side by side
    ewa_packet_groups *groups;
} divider;

void ewa_packet_normals(const ewa_packet *packet, float normal[3][LANES]) {
    for (int i = 0; i < LANES; i++) {
        const float u = packet->oct_x[i] * (1.0f / 32767), v = packet->oct_y[i] * (1.0f / 32767);
        const float z = 1 - fabsf(u) - fabsf(v), fold = z < 0 ? -z : 0;
        const float x = u - copysignf(fold, u), y = v - copysignf(fold, v);
        const float inverse = 1 / sqrtf(x * x + y * y + z * z);
        normal[0][i] = x * inverse, normal[1][i] = y * inverse, normal[2][i] = z * inverse;
    }
}

/// The axis along which the lanes [first, end) of the order reach farthest.
static int widest_axis(const divider *d, uint32_t first, uint32_t end) {
    int widest = 0;
    float largest = -1;
    for (int axis = 0; axis < AXES; axis++) {
        const float *keys = d->keys[axis];
        float low = keys[d->order[first]], high = low;
        for (uint32_t i = first + 1; i < end; i++) {
            const float key = keys[d->order[i]];
            low = key < low ? key : low, high = key > high ? key : high;
        }
        if (high - low > largest) largest = high - low, widest = axis;
    }
    return widest;
}

/// Sorts them along an axis; equal ones keep their order.
static void sort_along(divider *d, const float *keys, uint32_t first, uint32_t end) {
    for (uint32_t i = first + 1; i < end; i++) {
        const uint8_t lane = d->order[i];
        const float key = keys[lane];
        uint32_t to = i;
        for (; to > first && keys[d->order[to - 1]] > key; to--) d->order[to] = d->order[to - 1];
        d->order[to] = lane;
    }
}

static void divide(divider *d, uint32_t first, uint32_t end) {
    const uint32_t count = end - first;
    uint32_t middle = first;
    if (count > 1) {
        const float *keys = d->keys[widest_axis(d, first, end)];
        sort_along(d, keys, first, end);
        float gap = GAP;
        for (uint32_t i = first + 1; i < end; i++) {
            const float here = keys[d->order[i]] - keys[d->order[i - 1]];
            if (here > gap) gap = here, middle = i;
        }
        const uint32_t groups = (count + EWA_GROUP_SURFELS - 1) / EWA_GROUP_SURFELS;
        if (middle == first && groups > 1) middle = first + count * (groups / 2) / groups;
    }
    if (middle == first) {
        uint32_t lanes = 0;
        for (uint32_t i = first; i < end; i++) lanes |= 1u << d->order[i];
        d->groups->lanes[d->groups->count++] = (uint16_t)lanes;
        return;
    }
    divide(d, first, middle);
    divide(d, middle, end);
}

void ewa_groups_make(const ewa_packet *packet, const float normal[3][LANES], double cutoff,
                     ewa_packet_groups *groups) {
    divider d = {.groups = groups};
    groups->count = 0;
    uint32_t count = 0;
    double sigmas = 0;
    for (uint32_t i = 0; i < LANES; i++) {
        if (!(packet->sigma[i] > 0)) continue;
        d.order[count++] = (uint8_t)i;
        sigmas += (double)packet->sigma[i];
    }
    if (!count) return;
    const float per_radius = (float)(count / (cutoff * sigmas));
    const float *const places[3] = {packet->x, packet->y, packet->z};
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++) {
            d.keys[c][i] = places[c][i] * per_radius;
            d.keys[3 + c][i] = normal[c][i] * NORMAL_RADII;
        }
    divide(&d, 0, count);
    for (uint32_t i = 1; i < groups->count; i++) { // by the lowest bit
        const uint16_t lanes = groups->lanes[i];
        const uint32_t low = lanes & -(uint32_t)lanes;
        uint32_t to = i;
        for (; to > 0 && (groups->lanes[to - 1] & -(uint32_t)groups->lanes[to - 1]) > low; to--)
            groups->lanes[to] = groups->lanes[to - 1];
        groups->lanes[to] = lanes;
    }
}
