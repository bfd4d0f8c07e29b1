// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Opacities, two bytes for each surfel of clouds that have some; materials, one byte for each surfel of
// clouds that have several; curvatures, two bytes for each surfel of clouds that know them; clip lines, for the
// surfels that have them.
#include "surface/extras.h"
#include "base/base.h"
#include "surface/packet_order.h"

enum { LANES = EWA_PACKET_LANES, PART_PACKETS = 1024, PART_POINTS = LANES * PART_PACKETS };

typedef struct work {
    ewa_surfels *surfels;
    const ewa_surfel_reader *reader;
    const uint32_t *order;
    uint64_t point_count;
    uint8_t *clipped; // by point
} work;

/// Packets [first, end) of a part.
static uint64_t part_end(const work *w, uint32_t part) {
    const uint64_t end = ((uint64_t)part + 1) * PART_PACKETS;
    return end < w->surfels->packet_count ? end : w->surfels->packet_count;
}

static uint32_t part_count(const ewa_surfels *surfels) {
    return (uint32_t)(((uint64_t)surfels->packet_count + PART_PACKETS - 1) / PART_PACKETS);
}

static void encode_opacities(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const work *w = data;
    const ewa_surfels *surfels = w->surfels;
    for (uint64_t i = (uint64_t)part * PART_PACKETS * LANES; i < part_end(w, part) * LANES; i++) {
        const double alpha = w->order[i] != EWA_NO_POINT ? ewa_surfel_alpha(w->reader, w->order[i]) : 1;
        surfels->opacities[i] = (uint16_t)(alpha * 65535 + 0.5);
    }
}

static ewa_status set_opacities(ewa_context *context, work *w) {
    ewa_surfels *surfels = w->surfels;
    if (!w->reader->color || w->reader->color->component_count < 4) return EWA_OK;
    surfels->opacities =
        ewa_allocate(context, (size_t)surfels->packet_count * LANES, sizeof *surfels->opacities);
    if (!surfels->opacities) return EWA_ERROR_MEMORY;
    ewa_parallel(context, encode_opacities, w, part_count(surfels));
    uint16_t minimum = 65535;
    for (size_t i = 0; i < (size_t)surfels->packet_count * LANES; i++)
        minimum = surfels->opacities[i] < minimum ? surfels->opacities[i] : minimum;
    if (minimum < 65535) return EWA_OK;
    ewa_release(context, surfels->opacities, (size_t)surfels->packet_count * LANES,
                sizeof *surfels->opacities);
    surfels->opacities = NULL;
    return EWA_OK;
}

static void copy_materials(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const work *w = data;
    const ewa_surfels *surfels = w->surfels;
    for (uint64_t i = (uint64_t)part * PART_PACKETS * LANES; i < part_end(w, part) * LANES; i++)
        surfels->materials[i] = ewa_surfel_material(w->reader, w->order[w->order[i] != EWA_NO_POINT ? i : 0]);
}

static ewa_status set_materials(ewa_context *context, work *w) {
    ewa_surfels *surfels = w->surfels;
    const size_t lanes = (size_t)surfels->packet_count * LANES;
    if (!w->reader->material || lanes == 0) return EWA_OK;
    surfels->materials = ewa_allocate(context, lanes, sizeof *surfels->materials);
    if (!surfels->materials) return EWA_ERROR_MEMORY;
    ewa_parallel(context, copy_materials, w, part_count(surfels));
    surfels->material = surfels->materials[0];
    bool several = false;
    for (size_t i = 0; i < lanes; i++) {
        several |= surfels->materials[i] != surfels->material;
        if (surfels->materials[i] > surfels->max_material) surfels->max_material = surfels->materials[i];
    }
    if (several) return EWA_OK;
    ewa_release(context, surfels->materials, lanes, sizeof *surfels->materials);
    surfels->materials = NULL;
    return EWA_OK;
}

static void encode_curvatures(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const work *w = data;
    const ewa_surfels *surfels = w->surfels;
    for (uint64_t i = (uint64_t)part * PART_PACKETS * LANES; i < part_end(w, part) * LANES; i++) {
        const double curvature_world =
            w->order[i] != EWA_NO_POINT ? ewa_surfel_curvature(w->reader, w->order[i]) : 0;
        surfels->curvatures[i] = ewa_packet_code_curvature(curvature_world * surfels->unit);
    }
}

static ewa_status set_curvatures(ewa_context *context, work *w) {
    ewa_surfels *surfels = w->surfels;
    const size_t lanes = (size_t)surfels->packet_count * LANES;
    if (!w->reader->curvature) return EWA_OK;
    surfels->curvatures = ewa_allocate(context, lanes, sizeof *surfels->curvatures);
    if (!surfels->curvatures) return EWA_ERROR_MEMORY;
    ewa_parallel(context, encode_curvatures, w, part_count(surfels));
    bool bends = false;
    for (size_t i = 0; i < lanes && !bends; i++) bends = surfels->curvatures[i] << 1 & UINT16_MAX; // 0 has a sign
    if (bends) return EWA_OK;
    ewa_release(context, surfels->curvatures, lanes, sizeof *surfels->curvatures);
    surfels->curvatures = NULL;
    return EWA_OK;
}

static void find_clipped(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const work *w = data;
    const uint64_t first = (uint64_t)part * PART_POINTS, left = w->point_count - first;
    ewa_surfel_mark_clipped(w->reader, first, left < PART_POINTS ? left : PART_POINTS, w->clipped + first);
}

static void mark_clips(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const work *w = data;
    const ewa_surfels *surfels = w->surfels;
    for (uint64_t p = (uint64_t)part * PART_PACKETS; p < part_end(w, part); p++) {
        uint32_t mask = 0;
        const uint32_t *points = w->order + p * LANES;
        for (uint32_t lane = 0; lane < LANES && points[lane] != EWA_NO_POINT; lane++)
            mask |= (uint32_t)w->clipped[points[lane]] << lane;
        surfels->clip_masks[p] = (uint16_t)mask;
    }
}

/// From the frame of a surfel's axes to its plane, where lengths are in units of `unit_world`.
static void encode_clip(const ewa_surfel *surfel, double unit_world, ewa_surfel_clip *clip) {
    const ewa_vec3 axes[2] = {vec3_load(surfel->axis_u_world), vec3_load(surfel->axis_v_world)};
    clip->either = surfel->clip_either == 1;
    for (int k = 0; k < 2; k++) {
        ewa_vec3 toward = vec3_make(0, 0, 0);
        for (int i = 0; i < 2; i++)
            toward = vec3_add(toward, vec3_scale(axes[i], surfel->clip[k][i] / vec3_dot(axes[i], axes[i])));
        const double length = vec3_length(toward);
        const bool line = length > 0;
        const ewa_vec3 unit = line ? vec3_scale(toward, 1 / length) : toward;
        clip->toward[k][0] = (float)unit.x, clip->toward[k][1] = (float)unit.y;
        clip->toward[k][2] = (float)unit.z;
        clip->offset[k] = line ? (float)(surfel->clip[k][2] / length / unit_world) : 1;
        clip->either = clip->either && line; // one line alone has nothing to choose from
    }
}

static void encode_clips(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const work *w = data;
    const ewa_surfels *surfels = w->surfels;
    for (uint64_t p = (uint64_t)part * PART_PACKETS; p < part_end(w, part); p++) {
        ewa_surfel_clip *clip = surfels->clips + surfels->clip_first[p];
        for (uint32_t lanes = surfels->clip_masks[p]; lanes; lanes &= lanes - 1) {
            ewa_surfel surfel;
            bool drawable;
            ewa_surfel_read(w->reader, w->order[p * LANES + (uint64_t)__builtin_ctz(lanes)], 1, &surfel,
                            &drawable);
            encode_clip(&surfel, surfels->unit, clip++);
        }
    }
}

static ewa_status set_clips(ewa_context *context, work *w) {
    ewa_surfels *surfels = w->surfels;
    if (!w->reader->clip[0] && !w->reader->clip[1] && !w->reader->border) return EWA_OK;
    surfels->clip_masks = ewa_allocate(context, surfels->packet_count, sizeof *surfels->clip_masks);
    surfels->clip_first = ewa_allocate(context, surfels->packet_count, sizeof *surfels->clip_first);
    w->clipped = ewa_allocate(context, w->point_count, 1);
    const bool complete = surfels->clip_masks && surfels->clip_first && w->clipped;
    if (complete) {
        ewa_parallel(context, find_clipped, w, (uint32_t)((w->point_count + PART_POINTS - 1) / PART_POINTS));
        ewa_parallel(context, mark_clips, w, part_count(surfels));
    }
    ewa_release(context, w->clipped, w->point_count, 1);
    if (!complete) return EWA_ERROR_MEMORY;
    for (uint32_t p = 0; p < surfels->packet_count; p++) {
        surfels->clip_first[p] = (uint32_t)surfels->clip_count;
        surfels->clip_count += (uint64_t)__builtin_popcount(surfels->clip_masks[p]);
    }
    surfels->clips = ewa_allocate(context, surfels->clip_count, sizeof *surfels->clips);
    if (!surfels->clips) return EWA_ERROR_MEMORY;
    ewa_parallel(context, encode_clips, w, part_count(surfels));
    return EWA_OK;
}

ewa_status ewa_extras_make(ewa_context *context, ewa_surfels *surfels, const ewa_surfel_reader *reader,
                           uint64_t point_count, const uint32_t *order) {
    work w = {.surfels = surfels, .reader = reader, .order = order, .point_count = point_count};
    EWA_TRY(set_opacities(context, &w));
    EWA_TRY(set_materials(context, &w));
    EWA_TRY(set_curvatures(context, &w));
    return set_clips(context, &w);
}

void ewa_extras_free(ewa_context *context, ewa_surfels *surfels) {
    ewa_release(context, surfels->opacities, (size_t)surfels->packet_count * LANES,
                sizeof *surfels->opacities);
    ewa_release(context, surfels->materials, (size_t)surfels->packet_count * LANES,
                sizeof *surfels->materials);
    ewa_release(context, surfels->curvatures, (size_t)surfels->packet_count * LANES,
                sizeof *surfels->curvatures);
    ewa_release(context, surfels->clip_masks, surfels->packet_count, sizeof *surfels->clip_masks);
    ewa_release(context, surfels->clip_first, surfels->packet_count, sizeof *surfels->clip_first);
    ewa_release(context, surfels->clips, surfels->clip_count, sizeof *surfels->clips);
}

size_t ewa_extras_bytes(const ewa_surfels *surfels) {
    size_t bytes = surfels->clip_count * sizeof *surfels->clips;
    if (surfels->opacities) bytes += (size_t)surfels->packet_count * LANES * sizeof *surfels->opacities;
    if (surfels->materials) bytes += (size_t)surfels->packet_count * LANES * sizeof *surfels->materials;
    if (surfels->curvatures) bytes += (size_t)surfels->packet_count * LANES * sizeof *surfels->curvatures;
    if (surfels->clip_masks)
        bytes += surfels->packet_count * (sizeof *surfels->clip_masks + sizeof *surfels->clip_first);
    return bytes;
}
