// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of kernels_body.h: what a depth unit changed in a tile's pixels, as layers (docs/math.md section 12).
#ifndef EWA_SRC_VOLUME_KERNELS_LAYERS_H
#define EWA_SRC_VOLUME_KERNELS_LAYERS_H

#include "volume/kernels.h"
#include "volume/layers.h"
#include "wide/wide.h"

static void take_layers(const ewa_volume_tile *tile, float z, ewa_volume_layers *to) {
    const wf zero = wf_set(0), one = wf_set(1);
    for (uint32_t block = 0; block < EWA_VOLUME_TILE_BLOCKS; block++) {
        const float *pixels = tile->pixels + (size_t)block * EWA_VOLUME_CHANNELS * 16;
        float(*before)[16] = to->before[block];
        const wf through = wf_load(before[3]), rest = wf_load(pixels + 48), taken = wf_sub(through, rest);
        const wm some = wf_lt(zero, taken);
        if (!wm_bits(some)) continue;
        ewa_volume_layer *layer = &to->layers[to->count];
        wf_store(layer->alpha, wf_keep(some, wf_div(taken, wf_select(some, through, one))));
        const wf straight = wf_div(one, wf_select(some, taken, one));
        for (int c = 0; c < 3; c++) {
            const wf light = wf_load(pixels + 16 * c), more = wf_sub(light, wf_load(before[c]));
            wf_store(layer->color[c], wf_keep(some, wf_mul(wf_max(more, zero), straight)));
            wf_store(before[c], light);
        }
        wf_store(before[3], rest);
        layer->z = z;
        layer->next = EWA_NO_LAYER;
        if (to->first[block] == EWA_NO_LAYER)
            to->first[block] = to->count;
        else
            to->layers[to->last[block]].next = to->count;
        to->last[block] = to->count++;
    }
}

#endif
