// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which points share a packet.
#include "surface/packet_order.h"
#include "base/base.h"
#include "cloud/morton.h"
#include "homogeneous/vec.h"
#include "surface/packet.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    LANES = EWA_PACKET_LANES,
    TIE_BLOCK = 64, // points that are looked at together for ties, which are rare
};

/// A surfel with its point, for ordering what the Morton curve leaves in the order of the input.
typedef struct tied_surfel {
    ewa_surfel surfel;
    uint32_t point;
} tied_surfel;

static int compare_tied(const void *a, const void *b) {
    const tied_surfel *s = a, *t = b;
    const double *x = &s->surfel.center[0], *y = &t->surfel.center[0];
    for (size_t i = 0; i < sizeof(ewa_surfel) / sizeof(double); i++)
        if (x[i] != y[i]) return x[i] < y[i] ? -1 : 1;
    return s->point < t->point ? -1 : s->point > t->point;
}

/// Whether some of the next TIE_BLOCK points is not told apart from the one before it.
static bool any_same(const uint16_t split_level[TIE_BLOCK]) {
    uint16_t any = 0;
    for (int i = 0; i < TIE_BLOCK; i++) any |= split_level[i] == EWA_MORTON_SAME;
    return any;
}

/// Orders runs of points that the curve does not tell apart by everything that is drawn of them.
static ewa_status order_ties(ewa_context *context, const ewa_surfel_reader *reader,
                             const uint16_t *split_level, uint32_t count, uint32_t *order) {
    for (uint32_t first = 0, end; first < count; first = end) {
        if (count - first > TIE_BLOCK && !any_same(&split_level[first + 1])) {
            end = first + TIE_BLOCK;
            continue;
        }
        end = first + 1;
        while (end < count && split_level[end] == EWA_MORTON_SAME) end++;
        if (end - first < 2) continue;
        tied_surfel *tied = ewa_allocate_zeroed(context, end - first, sizeof *tied);
        if (!tied) return EWA_ERROR_MEMORY;
        for (uint32_t i = first; i < end; i++) {
            tied_surfel *t = &tied[i - first];
            bool drawable;
            ewa_surfel_read(reader, order[i], 1, &t->surfel, &drawable);
            if (!drawable) memset(&t->surfel, 0, sizeof t->surfel);
            t->point = order[i];
        }
        qsort(tied, end - first, sizeof *tied, compare_tied);
        for (uint32_t i = first; i < end; i++) order[i] = tied[i - first].point;
        ewa_release(context, tied, end - first, sizeof *tied);
    }
    return EWA_OK;
}

static uint32_t packets_of(uint32_t points) { return (uint32_t)(((uint64_t)points + LANES - 1) / LANES); }

ewa_status ewa_packet_order_make(ewa_context *context, const ewa_surfel_reader *reader, uint32_t count,
                                 const uint8_t *drawable, uint32_t drawable_count, const ewa_bounds *box,
                                 void *room, ewa_packet_order *order) {
    // All points are ordered, of which those that cannot be drawn are then dropped.
    order->packet_count = packets_of(drawable_count);
    order->room = (size_t)packets_of(count) * LANES;
    order->points = ewa_allocate(context, order->room, sizeof *order->points);
    uint16_t *split_level = ewa_allocate(context, count, sizeof *split_level);
    ewa_status status = order->points && split_level ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK)
        status = ewa_morton_order_in(context, reader->position, count, box, room, order->points, split_level);
    if (status == EWA_OK) status = order_ties(context, reader, split_level, count, order->points);
    ewa_release(context, split_level, count, sizeof *split_level);
    EWA_TRY(status);
    if (drawable_count < count) {
        uint32_t kept = 0;
        for (uint32_t i = 0; i < count; i++)
            if (drawable[order->points[i]]) order->points[kept++] = order->points[i];
    }
    for (size_t i = drawable_count; i < order->room; i++) order->points[i] = EWA_NO_POINT;
    return EWA_OK;
}

void ewa_packet_order_free(ewa_context *context, ewa_packet_order *order) {
    ewa_release(context, order->points, order->room, sizeof *order->points);
    *order = (ewa_packet_order){.points = NULL};
}

/// Divides one packet's points before each that is not within `reach` sigmas of those before it; fills
/// `points`, if any, and returns the number of packets.
static uint32_t divide(const ewa_surfel_reader *reader, const uint32_t from[LANES], double reach,
                       uint32_t *points) {
    double low[3], high[3], min_sigma = 0;
    uint32_t packets = 0, lanes = 0;
    for (uint32_t i = 0; i < LANES && from[i] != EWA_NO_POINT; i++) {
        ewa_surfel surfel;
        bool drawable;
        ewa_surfel_read(reader, from[i], 1, &surfel, &drawable);
        const double sigma = vec3_length(vec3_load(surfel.axis_u_world));
        double extent = 0;
        for (int c = 0; c < 3 && lanes; c++)
            extent = fmax(extent, fmax(high[c], surfel.center[c]) - fmin(low[c], surfel.center[c]));
        if (lanes == 0 || !(extent <= reach * fmin(min_sigma, sigma))) {
            packets++;
            lanes = 0;
            min_sigma = sigma;
            memcpy(low, surfel.center, sizeof low);
            memcpy(high, surfel.center, sizeof high);
            for (int lane = 0; points && lane < LANES; lane++)
                points[(packets - 1) * LANES + (uint32_t)lane] = EWA_NO_POINT;
        }
        for (int c = 0; c < 3; c++) {
            low[c] = fmin(low[c], surfel.center[c]);
            high[c] = fmax(high[c], surfel.center[c]);
        }
        min_sigma = fmin(min_sigma, sigma);
        if (points) points[(packets - 1) * LANES + lanes] = from[i];
        lanes++;
    }
    return packets;
}

static uint64_t divide_all(const ewa_surfel_reader *reader, const ewa_packet_order *order,
                           const uint8_t *wide, double reach, uint32_t *points) {
    uint64_t packets = 0;
    for (uint32_t p = 0; p < order->packet_count; p++) {
        const uint32_t *from = order->points + (size_t)p * LANES;
        uint32_t *to = points ? points + packets * LANES : NULL;
        if (wide[p]) {
            packets += divide(reader, from, reach, to);
        } else {
            if (to) memcpy(to, from, LANES * sizeof *to);
            packets++;
        }
    }
    return packets;
}

ewa_status ewa_packet_order_split(ewa_context *context, const ewa_surfel_reader *reader, const uint8_t *wide,
                                  ewa_packet_order *order) {
    enum { ALWAYS = 64 }; // more packets that any cloud may have
    const uint64_t maximum = order->packet_count + (uint64_t)order->packet_count / 4 + ALWAYS;
    double reach = EWA_PACKET_REACH;
    uint64_t packets = divide_all(reader, order, wide, reach, NULL);
    while (packets > maximum) {
        reach *= LANES;
        packets = divide_all(reader, order, wide, reach, NULL);
    }
    if (packets > UINT32_MAX / LANES)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%llu packets are more than a renderer holds",
                        (unsigned long long)packets);
    ewa_packet_order divided = {.room = packets * LANES, .packet_count = (uint32_t)packets};
    divided.points = ewa_allocate(context, divided.room, sizeof *divided.points);
    if (!divided.points) return EWA_ERROR_MEMORY;
    divide_all(reader, order, wide, reach, divided.points);
    ewa_packet_order_free(context, order);
    *order = divided;
    return EWA_OK;
}
