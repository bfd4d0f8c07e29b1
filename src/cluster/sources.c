// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Facts about sources that ranks exchange.
#include "cluster/sources.h"

#include <string.h>

/// A source as the others need to know it; plain numbers, of ranks with the same program.
typedef struct source_facts {
    uint64_t count, left_out_count;
    double origin_world[3], unit, reach_world, largest_sigmas_world[2], largest_color, cutoff, unit_coverage;
    ewa_bounds extent;
    double weight;
    uint32_t material, max_material;
    uint32_t fine_colors, ellipses, opacities, materials, clips, hides;
} source_facts;

static void describe(const ewa_frame_source *source, source_facts *facts) {
    const ewa_surfels *s = source->surfels;
    memset(facts, 0, sizeof *facts); // its gaps, too
    facts->count = s->count, facts->left_out_count = s->left_out_count;
    memcpy(facts->origin_world, s->origin_world, sizeof facts->origin_world);
    memcpy(facts->largest_sigmas_world, s->largest_sigmas_world, sizeof facts->largest_sigmas_world);
    facts->unit = s->unit, facts->reach_world = s->reach_world;
    facts->largest_color = s->largest_color, facts->cutoff = s->cutoff;
    facts->unit_coverage = s->unit_coverage;
    facts->extent = s->extent;
    facts->weight = source->weight;
    facts->material = s->material, facts->max_material = s->max_material;
    facts->fine_colors = s->fine_colors, facts->ellipses = s->ellipses;
    facts->opacities = s->opacities || s->with_opacities;
    facts->materials = s->materials || s->with_materials;
    facts->clips = s->clip_masks || s->with_clips;
    facts->hides = source->hides;
}

/// A proxy source: surfels without packets that have the facts of another rank's source.
static ewa_surfels proxy_of(ewa_context *context, const source_facts *facts) {
    ewa_surfels made = {.context = context,
                        .unit = facts->unit,
                        .extent = facts->extent,
                        .reach_world = facts->reach_world,
                        .largest_color = facts->largest_color,
                        .fine_colors = facts->fine_colors,
                        .cutoff = facts->cutoff,
                        .ellipses = facts->ellipses,
                        .unit_coverage = facts->unit_coverage,
                        .material = (uint8_t)facts->material,
                        .max_material = (uint8_t)facts->max_material,
                        .with_opacities = facts->opacities,
                        .with_materials = facts->materials,
                        .with_clips = facts->clips};
    memcpy(made.origin_world, facts->origin_world, sizeof made.origin_world);
    memcpy(made.largest_sigmas_world, facts->largest_sigmas_world, sizeof made.largest_sigmas_world);
    return made;
}

/// Gathers the facts of all ranks in room->facts: `maximum` sources of each, of which counts[rank] are there.
static ewa_status gather(ewa_context *context, const ewa_exchange *exchange, ewa_joint_sources *room,
                         const ewa_render_job *frame, uint64_t *counts, uint64_t *maximum) {
    const uint64_t mine = frame->source_count;
    EWA_TRY(ewa_exchange_gather(context, exchange, &mine, sizeof mine, counts));
    *maximum = 0;
    for (uint32_t i = 0; i < exchange->rank_count; i++)
        *maximum = counts[i] > *maximum ? counts[i] : *maximum;
    EWA_TRY(ewa_buffer_reserve(context, &room->facts, (size_t)*maximum * (exchange->rank_count + 1u),
                               sizeof(source_facts)));
    source_facts *all = room->facts.data, *own = all + (size_t)*maximum * exchange->rank_count;
    if (*maximum) memset(own, 0, (size_t)*maximum * sizeof *own);
    for (uint32_t i = 0; i < frame->source_count; i++) describe(&frame->sources[i], &own[i]);
    return *maximum ? ewa_exchange_gather(context, exchange, own, (size_t)*maximum * sizeof *own, all)
                    : EWA_OK;
}

/// Lists the sources of all ranks in their order.
static ewa_status list(ewa_context *context, const ewa_exchange *exchange, ewa_joint_sources *room,
                       const ewa_render_job *frame, const uint64_t *counts, uint64_t maximum) {
    uint64_t count = 0;
    for (uint32_t i = 0; i < exchange->rank_count; i++) count += counts[i];
    if (count > UINT32_MAX)
        return ewa_fail(context, EWA_ERROR_LIMIT, "render: more than %u sources", UINT32_MAX);
    EWA_TRY(ewa_buffer_reserve(context, &room->sources, count, sizeof(ewa_frame_source)));
    EWA_TRY(ewa_buffer_reserve(context, &room->proxy, count, sizeof(ewa_surfels)));
    ewa_frame_source *sources = room->sources.data;
    ewa_surfels *proxy = room->proxy.data;
    const source_facts *all = room->facts.data;
    room->count = 0;
    room->splat_count = 0;
    for (uint32_t rank = 0; rank < exchange->rank_count; rank++)
        for (uint64_t i = 0; i < counts[rank]; i++) {
            const uint32_t at = room->count++;
            const source_facts *facts = &all[rank * maximum + i];
            room->splat_count += facts->count;
            proxy[at] = proxy_of(context, facts);
            sources[at] = rank == exchange->rank
                              ? frame->sources[i]
                              : (ewa_frame_source){&proxy[at], facts->weight, facts->hides};
            if (facts->cutoff != sources[0].surfels->cutoff)
                return ewa_fail(context, EWA_ERROR_ARGUMENT,
                                "render: surfels with a cutoff of %g beside others with %g", facts->cutoff,
                                sources[0].surfels->cutoff);
        }
    return EWA_OK;
}

ewa_status ewa_joint_sources_gather(ewa_context *context, const ewa_exchange *exchange,
                                    ewa_joint_sources *room, const ewa_render_job *frame,
                                    ewa_render_job *joint) {
    uint64_t *counts = ewa_allocate_zeroed(context, exchange->rank_count, sizeof *counts), maximum = 0;
    if (!counts) return EWA_ERROR_MEMORY;
    ewa_status status = gather(context, exchange, room, frame, counts, &maximum);
    if (status == EWA_OK) status = list(context, exchange, room, frame, counts, maximum);
    ewa_release(context, counts, exchange->rank_count, sizeof *counts);
    EWA_TRY(status);
    *joint = *frame;
    joint->sources = room->sources.data;
    joint->source_count = room->count;
    return EWA_OK;
}

void ewa_joint_sources_free(ewa_context *context, ewa_joint_sources *room) {
    ewa_buffer_free(context, &room->facts);
    ewa_buffer_free(context, &room->sources);
    ewa_buffer_free(context, &room->proxy);
}
