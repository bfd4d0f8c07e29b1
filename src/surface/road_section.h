// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of road_body.h: what section planes leave of packets (semantics.h, section 2).
#ifndef EWA_SRC_SURFACE_ROAD_SECTION_H
#define EWA_SRC_SURFACE_ROAD_SECTION_H

#include "surface/road_camera.h"
#include "wide/wide_double.h"

/// The distances of packets' centres [first, first + 16) from a section plane, inward. Rounding to floats keeps
/// their order with the packets' radii.
static ALWAYS_INLINE wf section_distance(const double plane[4], const ewa_packet_bounds *bounds,
                                         uint32_t first) {
    const wd x = wd_load(bounds->center_x + first), y = wd_load(bounds->center_y + first),
             z = wd_load(bounds->center_z + first);
    const wd distance = wd_fma(wd_set(plane[0]), x,
                               wd_fma(wd_set(plane[1]), y, wd_fma(wd_set(plane[2]), z, wd_set(plane[3]))));
    return wf_from_d(distance);
}

/// Which surfels of a packet have their centres inside of all planes; `distances` are the packet's.
static inline uint32_t section_lanes(const ewa_view *view, const ewa_packet *packet,
                                     const float distances[EWA_MAX_SECTION_PLANES]) {
    const wf x = wf_load(packet->x), y = wf_load(packet->y), z = wf_load(packet->z);
    wm inside = wf_lt(wf_set(0), wf_load(packet->sigma));
    for (uint32_t k = 0; k < view->section_count; k++) {
        const double *n = view->sections[k];
        const wf yz = wf_fma(wf_set((float)n[1]), y, wf_fma(wf_set((float)n[2]), z, wf_set(distances[k])));
        inside = wm_and(inside, wf_le(wf_set(0), wf_fma(wf_set((float)n[0]), x, yz)));
    }
    return wm_bits(inside);
}

/// Leaves, of packets [first, first + 16), those that reach into what the section planes keep, and sets
/// `lanes` of these.
static inline wm keep_sections(const ewa_view *view, const ewa_packet *packets,
                               const ewa_packet_bounds *bounds, uint32_t first, wm alive, uint16_t *lanes) {
    const wf radius = wf_of_bits(wi_shl(wi_load_u16(bounds->radius + first), EWA_RADIUS_SHIFT));
    float distances[EWA_MAX_SECTION_PLANES][16];
    wm crossed = wm_of_bits(0);
    for (uint32_t k = 0; k < view->section_count; k++) {
        const wf distance = section_distance(view->sections[k], bounds, first);
        alive = wm_and(alive, wf_le(wf_negate(radius), distance));
        crossed = wm_or(crossed, wf_lt(distance, radius));
        wf_store(distances[k], distance);
    }
    uint32_t kept = wm_bits(alive), some = kept & wm_bits(crossed);
    for (uint32_t left = kept; left; left &= left - 1) lanes[first + (uint32_t)__builtin_ctz(left)] = 0xffff;
    for (; some; some &= some - 1) {
        const uint32_t i = (uint32_t)__builtin_ctz(some);
        float own[EWA_MAX_SECTION_PLANES];
        for (uint32_t k = 0; k < view->section_count; k++) own[k] = distances[k][i];
        const uint32_t inside = section_lanes(view, &packets[first + i], own);
        lanes[first + i] = (uint16_t)inside;
        if (!inside) kept &= ~(1u << i);
    }
    return wm_of_bits(kept);
}

#endif
