// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Nodes that are read on one thread while another one draws those that are there.
#include "lod/reading.h"
#include "base/base.h"
#include "base/context.h"
#include "base/options.h"
#include "lod/cut.h"

#include <string.h>

/// Copies how the octree looks, which may change while its nodes are read.
static ewa_status copy_look(ewa_lod_reading *reading) {
    const ewa_lod_appearance *appearance = &reading->lod->appearance;
    if (appearance->user_bytes) {
        EWA_TRY(ewa_buffer_reserve(reading->context, &reading->appearance_user, appearance->user_bytes, 1));
        memcpy(reading->appearance_user.data, appearance->user, appearance->user_bytes);
    }
    reading->appearance = *appearance;
    reading->appearance.user = reading->appearance_user.data;
    return EWA_OK;
}

/// Takes the first nodes of the list that are to be read, of one octree.
static void take_urgent(ewa_lod_reading *reading, const ewa_cut *c, uint32_t max_count) {
    for (uint32_t i = 0; i < c->item_count && reading->count < max_count; i++) {
        ewa_lod *lod = c->items[i].lod;
        const uint32_t index = c->items[i].node;
        if (lod->nodes[index].surfels || lod->nodes[index].damaged) continue;
        if (reading->count && reading->lod != lod) return;
        const uint64_t beside = ewa_cut_bytes_beside(c->scene, lod);
        const uint64_t memory_bytes = c->options->memory_bytes > beside ? c->options->memory_bytes - beside : 0;
        uint64_t chosen_bytes = 0;
        for (uint32_t k = 0; k < reading->count; k++) chosen_bytes += ewa_tree_bytes_of(&lod->nodes[reading->nodes[k]]);
        if (!ewa_tree_make_room(lod, index, memory_bytes > chosen_bytes ? memory_bytes - chosen_bytes : 0)) return;
        reading->lod = lod;
        reading->frame = lod->frame;
        reading->memory_bytes = memory_bytes;
        reading->nodes[reading->count++] = index;
        // A root alone, so that there is something to draw.
        if (index == 0) return;
    }
}

ewa_status ewa_lod_reading_choose(ewa_lod_reading *reading, const ewa_lod_scene *given, const ewa_lod_appearance *const *appearances,
                                  const ewa_camera *camera, const ewa_render_options *options,
                                  const ewa_lod_options *lod_options, uint32_t max_count) {
    reading->count = 0;
    reading->lod = NULL;
    if (!given->lod_count) return EWA_OK;
    ewa_context *context = given->lods[0]->context;
    ewa_lod_scene scene = *given;
    ewa_render_options plain;
    ewa_lod_options chosen;
    ewa_lod_options_init(&chosen, sizeof chosen);
    EWA_TRY(ewa_options_take(context, &ewa_lod_options_table, lod_options, &chosen));
    EWA_TRY(ewa_camera_check(context, camera));
    EWA_TRY(ewa_lod_begin_picture(&scene, appearances, options, &plain));
    ewa_division parts;
    EWA_TRY(ewa_cut_choose_parts(&scene, camera, &plain, &chosen, &parts));
    plain.supersampling = parts.finer_share > 0 ? 2 * parts.count : parts.count;
    ewa_cut_divide(&chosen, plain.supersampling);
    ewa_cut c;
    EWA_TRY(ewa_cut_begin(&c, &scene, camera, &plain, &chosen));
    EWA_TRY(ewa_cut_list_urgent(&c));
    if (reading->careful_count) max_count = 1;
    take_urgent(reading, &c, max_count < EWA_TREE_BATCH ? max_count : EWA_TREE_BATCH);
    if (reading->count && reading->careful_count) reading->careful_count--;
    return reading->count ? copy_look(reading) : EWA_OK;
}

ewa_status ewa_lod_reading_read(ewa_lod_reading *reading) {
    const ewa_tree_reading how = {&reading->appearance, reading->frame, reading->memory_bytes};
    ewa_lod *lod = reading->lod;
    const bool told = lod->damage_reported; // of a file that was cut short each node would be
    if (told) ewa_failures_hush(lod->context, true);
    const ewa_status status = ewa_tree_read(lod, &how, reading->nodes, reading->count, reading->surfels);
    if (told) ewa_failures_hush(lod->context, false);
    lod->damage_reported = lod->damage_reported || status != EWA_OK;
    return status;
}

void ewa_lod_reading_put(ewa_lod_reading *reading) {
    ewa_lod *lod = reading->lod;
    const bool same = ewa_tree_appearances_equal(&reading->appearance, &lod->appearance);
    for (uint32_t i = 0; i < reading->count; i++) {
        ewa_lod_node *node = &lod->nodes[reading->nodes[i]];
        if (!reading->surfels[i]) {
            if (same && reading->count == 1) node->damaged = true;
            if (reading->count > 1) reading->careful_count = reading->count;
        } else if (same && !node->surfels) {
            ewa_tree_put(lod, reading->nodes[i], reading->surfels[i]);
            node->last_frame = lod->frame;
        } else {
            ewa_surfels_destroy(&reading->surfels[i]);
        }
        reading->surfels[i] = NULL;
    }
    reading->count = 0;
}

void ewa_lod_reading_free(ewa_lod_reading *reading) { ewa_buffer_free(reading->context, &reading->appearance_user); }
