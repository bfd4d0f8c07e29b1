// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What ranks tell each other of their sources.
#include "cluster/sources.h"

#include <string.h>

/// A source as the others need to know it; plain numbers, of ranks with the same program.
typedef struct told_source {
    uint64_t count, left_out_count;
    double origin_world[3], unit, reach_world, largest_sigmas_world[2], largest_color, cutoff, unit_coverage;
    ewa_bounds extent;
    double weight;
    uint32_t material, most_material;
    uint32_t fine_colors, ellipses, opacities, materials, clips, hides;
} told_source;

static void tell(const ewa_frame_source *source, told_source *told) {
    const ewa_surfels *s = source->surfels;
    memset(told, 0, sizeof *told); // its gaps, too
    told->count = s->count, told->left_out_count = s->left_out_count;
    memcpy(told->origin_world, s->origin_world, sizeof told->origin_world);
    memcpy(told->largest_sigmas_world, s->largest_sigmas_world, sizeof told->largest_sigmas_world);
    told->unit = s->unit, told->reach_world = s->reach_world;
    told->largest_color = s->largest_color, told->cutoff = s->cutoff;
    told->unit_coverage = s->unit_coverage;
    told->extent = s->extent;
    told->weight = source->weight;
    told->material = s->material, told->most_material = s->most_material;
    told->fine_colors = s->fine_colors, told->ellipses = s->ellipses;
    told->opacities = s->opacities || s->with_opacities;
    told->materials = s->materials || s->with_materials;
    told->clips = s->clip_masks || s->with_clips;
    told->hides = source->hides;
}

/// Surfels without packets that have the say of what was told.
static ewa_surfels hollow_of(ewa_context *context, const told_source *told) {
    ewa_surfels made = {.context = context,
                        .unit = told->unit,
                        .extent = told->extent,
                        .reach_world = told->reach_world,
                        .largest_color = told->largest_color,
                        .fine_colors = told->fine_colors,
                        .cutoff = told->cutoff,
                        .ellipses = told->ellipses,
                        .unit_coverage = told->unit_coverage,
                        .material = (uint8_t)told->material,
                        .most_material = (uint8_t)told->most_material,
                        .with_opacities = told->opacities,
                        .with_materials = told->materials,
                        .with_clips = told->clips};
    memcpy(made.origin_world, told->origin_world, sizeof made.origin_world);
    memcpy(made.largest_sigmas_world, told->largest_sigmas_world, sizeof made.largest_sigmas_world);
    return made;
}

/// Gathers what all ranks tell into room->told: `most` sources of each, of which counts[rank] are there.
static ewa_status gather(ewa_context *context, const ewa_exchange *exchange, ewa_joint_sources *room,
                         const ewa_render_job *frame, uint64_t *counts, uint64_t *most) {
    const uint64_t mine = frame->source_count;
    ewa_status status = ewa_exchange_gather(context, exchange, &mine, sizeof mine, counts);
    if (status != EWA_OK) return status;
    *most = 0;
    for (uint32_t i = 0; i < exchange->rank_count; i++) *most = counts[i] > *most ? counts[i] : *most;
    status = ewa_buffer_reserve(context, &room->told, (size_t)*most * (exchange->rank_count + 1u),
                                sizeof(told_source));
    if (status != EWA_OK) return status;
    told_source *all = room->told.data, *own = all + (size_t)*most * exchange->rank_count;
    if (*most) memset(own, 0, (size_t)*most * sizeof *own);
    for (uint32_t i = 0; i < frame->source_count; i++) tell(&frame->sources[i], &own[i]);
    return *most ? ewa_exchange_gather(context, exchange, own, (size_t)*most * sizeof *own, all) : EWA_OK;
}

/// Lists the sources of all ranks in their order.
static ewa_status list(ewa_context *context, const ewa_exchange *exchange, ewa_joint_sources *room,
                       const ewa_render_job *frame, const uint64_t *counts, uint64_t most) {
    uint64_t count = 0;
    for (uint32_t i = 0; i < exchange->rank_count; i++) count += counts[i];
    if (count > UINT32_MAX)
        return ewa_fail(context, EWA_ERROR_LIMIT, "render: more than %u sources", UINT32_MAX);
    ewa_status status = ewa_buffer_reserve(context, &room->sources, count, sizeof(ewa_frame_source));
    if (status == EWA_OK) status = ewa_buffer_reserve(context, &room->hollow, count, sizeof(ewa_surfels));
    if (status != EWA_OK) return status;
    ewa_frame_source *sources = room->sources.data;
    ewa_surfels *hollow = room->hollow.data;
    const told_source *all = room->told.data;
    room->count = 0;
    room->splat_count = 0;
    for (uint32_t rank = 0; rank < exchange->rank_count; rank++)
        for (uint64_t i = 0; i < counts[rank]; i++) {
            const uint32_t at = room->count++;
            const told_source *told = &all[rank * most + i];
            room->splat_count += told->count;
            hollow[at] = hollow_of(context, told);
            sources[at] = rank == exchange->rank ? frame->sources[i]
                                                 : (ewa_frame_source){&hollow[at], told->weight, told->hides};
            if (told->cutoff != sources[0].surfels->cutoff)
                return ewa_fail(context, EWA_ERROR_ARGUMENT,
                                "render: surfels with a cutoff of %g beside others with %g", told->cutoff,
                                sources[0].surfels->cutoff);
        }
    return EWA_OK;
}

ewa_status ewa_joint_sources_gather(ewa_context *context, const ewa_exchange *exchange,
                                    ewa_joint_sources *room, const ewa_render_job *frame,
                                    ewa_render_job *joint) {
    uint64_t *counts = ewa_allocate_zeroed(context, exchange->rank_count, sizeof *counts), most = 0;
    if (!counts) return EWA_ERROR_MEMORY;
    ewa_status status = gather(context, exchange, room, frame, counts, &most);
    if (status == EWA_OK) status = list(context, exchange, room, frame, counts, most);
    ewa_release(context, counts, exchange->rank_count, sizeof *counts);
    if (status != EWA_OK) return status;
    *joint = *frame;
    joint->sources = room->sources.data;
    joint->source_count = room->count;
    return EWA_OK;
}

void ewa_joint_sources_free(ewa_context *context, ewa_joint_sources *room) {
    ewa_buffer_free(context, &room->told);
    ewa_buffer_free(context, &room->sources);
    ewa_buffer_free(context, &room->hollow);
}
