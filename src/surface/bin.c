// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which packets each tile has to look at: those that the kernels' culling leaves.
#include "surface/bin.h"

typedef struct bin_job {
    const ewa_road_kernels *kernels;
    const ewa_view *view;
    const ewa_surfels *surfels;
    ewa_packet_places places;
} bin_job;

static uint32_t find_packets(const void *data, uint32_t worker, uint32_t first, uint32_t count,
                             const ewa_bin_items *items) {
    (void)worker;
    const bin_job *job = data;
    const ewa_surfels *surfels = job->surfels;
    return job->kernels->cull(job->view, surfels->packets, &surfels->bounds, first, count, &job->places,
                              items);
}

ewa_status ewa_bins_fill(ewa_context *context, ewa_bins *bins, const ewa_road_kernels *kernels,
                         const ewa_view *view, const ewa_surfels *surfels) {
    const size_t stride = surfels->bounds_stride;
    enum { STREAMS = offsetof(ewa_packet_places, lanes) / sizeof(float *) };
    ewa_status status = ewa_buffer_reserve(context, &bins->places_buffer, STREAMS * stride, sizeof(float));
    if (status == EWA_OK && view->section_count)
        status = ewa_buffer_reserve(context, &bins->lanes_buffer, 2 * stride, sizeof(uint16_t));
    if (status != EWA_OK) return status;
    float *places = bins->places_buffer.data;
    uint16_t *lanes = view->section_count ? bins->lanes_buffer.data : NULL;
    bins->places = (ewa_packet_places){places,
                                       places + stride,
                                       places + 2 * stride,
                                       places + 3 * stride,
                                       places + 4 * stride,
                                       lanes,
                                       lanes ? lanes + stride : NULL};
    bins->tiles = ewa_tiles_make(view->width_px, view->height_px, view->tile_px);
    const bin_job job = {kernels, view, surfels, bins->places};
    status = ewa_bin_lists_fill(context, &bins->lists, bins->tiles.columns, bins->tiles.rows,
                                surfels->packet_count, find_packets, &job);
    bins->culled_packet_count = surfels->packet_count - bins->lists.item_count;
    return status;
}

void ewa_bins_free(ewa_context *context, ewa_bins *bins) {
    ewa_bin_lists_free(context, &bins->lists);
    ewa_buffer_free(context, &bins->places_buffer);
    ewa_buffer_free(context, &bins->lanes_buffer);
}
