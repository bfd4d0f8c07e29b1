// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: what section planes leave of packets (docs/math.md section 5; semantics.h, section
// planes).
#ifndef EWA_SRC_SURFACE_PIPELINE_SECTION_H
#define EWA_SRC_SURFACE_PIPELINE_SECTION_H

#include "surface/pipeline_project.h"
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

/// Which surfels of a packet the section planes leave, and which of them they cut; `distances` are the packet's.
static inline void section_lanes(const ewa_view *view, const ewa_packet *packet,
                                 const float distances[EWA_MAX_SECTION_PLANES], uint16_t *lanes,
                                 uint16_t *cuts) {
    const wf x = wf_load(packet->x), y = wf_load(packet->y), z = wf_load(packet->z);
    const wf zero = wf_set(0), support = wf_mul(wf_load(packet->sigma), wf_set(view->section_reach));
    wf normal[3];
    decode_normals(packet, normal);
    make_unit(normal);
    const wm billboards = find_billboards(packet); // parallel to the picture
    for (int i = 0; i < 3; i++) normal[i] = wf_select(billboards, wf_set(view->rotation[6 + i]), normal[i]);
    wm inside = wf_lt(zero, wf_load(packet->sigma)), cut = wm_of_bits(0);
    for (uint32_t k = 0; k < view->section_count; k++) {
        wf n[3];
        for (int i = 0; i < 3; i++) n[i] = wf_set((float)view->sections[k][i]);
        const wf yz = wf_fma(n[1], y, wf_fma(n[2], z, wf_set(distances[k]))), distance = wf_fma(n[0], x, yz);
        const wf along = wf_fma(n[0], normal[0], wf_fma(n[1], normal[1], wf_mul(n[2], normal[2])));
        const wf reach = wf_mul(support, wf_sqrt(wf_max(wf_fnma(along, along, wf_set(1)), zero)));
        inside = wm_and(inside, wm_or(wf_le(zero, distance), wf_lt(wf_negate(reach), distance)));
        cut = wm_or(cut, wf_lt(distance, reach));
    }
    *lanes = (uint16_t)wm_bits(inside);
    *cuts = (uint16_t)wm_bits(wm_and(inside, cut));
}

/// Leaves, of packets [first, first + 16), those that reach into what the section planes keep, and sets what
/// is left of these.
static inline wm keep_sections(const ewa_view *view, const ewa_packet *packets,
                               const ewa_packet_bounds *bounds, uint32_t first, wm alive,
                               const ewa_packet_places *places) {
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
    memset(places->lanes + first, 0xff, 16 * sizeof *places->lanes);
    memset(places->cuts + first, 0, 16 * sizeof *places->cuts);
    for (; some; some &= some - 1) {
        const uint32_t i = (uint32_t)__builtin_ctz(some);
        float own[EWA_MAX_SECTION_PLANES];
        for (uint32_t k = 0; k < view->section_count; k++) own[k] = distances[k][i];
        section_lanes(view, &packets[first + i], own, places->lanes + first + i, places->cuts + first + i);
        if (!places->lanes[first + i]) kept &= ~(1u << i);
    }
    return wm_of_bits(kept);
}

#endif
