// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which packets each tile has to look at: those that the kernels' culling leaves.
#include "surface/bin.h"

static uint32_t find_packets(const void *data, uint32_t worker, uint32_t first, uint32_t count,
                             const ewa_bin_items *items) {
    (void)worker;
    const ewa_bins *bins = data;
    const ewa_surfels *surfels = bins->surfels;
    return bins->kernels->cull(bins->view, surfels->packets, &surfels->bounds, first, count, &bins->places,
                               items);
}

ewa_status ewa_bins_start(ewa_context *context, ewa_bins *bins, const ewa_pipeline_kernels *kernels,
                          const ewa_view *view, const ewa_surfels *surfels) {
    const size_t stride = surfels->bounds_stride;
    enum { STREAMS = offsetof(ewa_packet_places, lanes) / sizeof(float *) };
    EWA_TRY(ewa_buffer_reserve(context, &bins->places_buffer, STREAMS * stride, sizeof(float)));
    if (view->section_count)
        EWA_TRY(ewa_buffer_reserve(context, &bins->lanes_buffer, 2 * stride, sizeof(uint16_t)));
    float *places = bins->places_buffer.data;
    uint16_t *lanes = view->section_count ? bins->lanes_buffer.data : NULL;
    bins->places = (ewa_packet_places){places,
                                       places + stride,
                                       places + 2 * stride,
                                       places + 3 * stride,
                                       places + 4 * stride,
                                       lanes,
                                       lanes ? lanes + stride : NULL};
    bins->kernels = kernels, bins->view = view, bins->surfels = surfels;
    return EWA_OK;
}

ewa_bin_request ewa_bins_request(ewa_bins *bins) {
    return (ewa_bin_request){&bins->lists, bins->surfels->packet_count, find_packets, bins};
}

void ewa_bins_free(ewa_context *context, ewa_bins *bins) {
    ewa_bin_lists_free(context, &bins->lists);
    ewa_buffer_free(context, &bins->places_buffer);
    ewa_buffer_free(context, &bins->lanes_buffer);
}
