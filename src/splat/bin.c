// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which packets each tile has to look at: count per contiguous part of the packets, prefix sums over parts,
// fill. Parts come in order, so a tile's packets stay in order however many parts there are.
#include "splat/bin.h"

typedef struct bin_job {
    ewa_bins *bins;
    const ewa_road_kernels *kernels;
    const ewa_view *view;
    const ewa_surfels *surfels;
    ewa_kept_packets kept; // each part's from its first packet on
    uint64_t *counts;      // [part][tile]: first the number of entries, then where the next one goes
    uint64_t *kept_count;  // [part]
    uint32_t parts, tiles;
} bin_job;

/// First packet of a part: parts begin at full vectors of packets.
static uint32_t part_first(const bin_job *job, uint32_t part) {
    const uint64_t vectors = job->surfels->bounds_stride / EWA_PACKET_LANES;
    const uint64_t first = ewa_split(vectors, job->parts, part) * EWA_PACKET_LANES;
    return first < job->surfels->packet_count ? (uint32_t)first : job->surfels->packet_count;
}

/// Tiles [x0, x1) x [y0, y1).
typedef struct tile_rect {
    uint32_t x0, y0, x1, y1;
} tile_rect;

static tile_rect rect_of(const bin_job *job, size_t k) {
    const uint32_t first = (uint32_t)job->kept.tiles_first[k], end = (uint32_t)job->kept.tiles_end[k];
    return (tile_rect){first & 0xffff, first >> 16, end & 0xffff, end >> 16};
}

static void count_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const bin_job *job = data;
    uint64_t *counts = job->counts + (size_t)part * job->tiles;
    for (uint32_t tile = 0; tile < job->tiles; tile++) counts[tile] = 0;
    const uint32_t first = part_first(job, part), count = part_first(job, part + 1) - first;
    job->kept_count[part] =
        job->kernels->cull(job->view, &job->surfels->bounds, first, count, &job->bins->places, &job->kept);
    for (size_t k = first; k < first + job->kept_count[part]; k++) {
        const tile_rect r = rect_of(job, k);
        for (uint32_t y = r.y0; y < r.y1; y++)
            for (uint32_t x = r.x0; x < r.x1; x++) counts[y * job->bins->tiles_x + x]++;
    }
}

static void fill_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const bin_job *job = data;
    uint64_t *next = job->counts + (size_t)part * job->tiles;
    uint32_t *entries = job->bins->entries;
    const uint32_t first = part_first(job, part);
    for (size_t k = first; k < first + job->kept_count[part]; k++) {
        const tile_rect r = rect_of(job, k);
        for (uint32_t y = r.y0; y < r.y1; y++)
            for (uint32_t x = r.x0; x < r.x1; x++)
                entries[next[y * job->bins->tiles_x + x]++] = (uint32_t)job->kept.packets[k];
    }
}

/// Turns counts into first places, tile by tile and part by part; returns the number of entries.
static uint64_t place(const bin_job *job) {
    ewa_bins *bins = job->bins;
    uint64_t sum = 0;
    for (uint32_t tile = 0; tile < job->tiles; tile++) {
        bins->tile_first[tile] = sum;
        for (uint32_t part = 0; part < job->parts; part++) {
            uint64_t *count = &job->counts[(size_t)part * job->tiles + tile];
            const uint64_t here = *count;
            *count = sum;
            sum += here;
        }
    }
    bins->tile_first[job->tiles] = sum;
    return sum;
}

ewa_status ewa_bins_fill(ewa_context *context, ewa_bins *bins, const ewa_road_kernels *kernels,
                         const ewa_view *view, const ewa_surfels *surfels) {
    bins->tiles_x = (view->width_px + view->tile_px - 1) / view->tile_px;
    bins->tiles_y = (view->height_px + view->tile_px - 1) / view->tile_px;
    bin_job job = {.bins = bins,
                   .kernels = kernels,
                   .view = view,
                   .surfels = surfels,
                   .tiles = bins->tiles_x * bins->tiles_y,
                   .parts = ewa_context_worker_count(context)};
    const size_t count_numbers = (size_t)job.parts * job.tiles + job.parts;
    const size_t stride = surfels->bounds_stride;
    enum {
        LISTS = sizeof(ewa_kept_packets) / sizeof(int32_t *),
        STREAMS = sizeof(ewa_packet_places) / sizeof(float *)
    };
    ewa_status status = ewa_buffer_reserve(context, &bins->kept_buffer, LISTS * stride, sizeof(int32_t));
    if (status == EWA_OK)
        status = ewa_buffer_reserve(context, &bins->counts, count_numbers, sizeof *job.counts);
    if (status == EWA_OK)
        status =
            ewa_buffer_reserve(context, &bins->tile_first_buffer, (size_t)job.tiles + 1, sizeof(uint64_t));
    if (status == EWA_OK)
        status = ewa_buffer_reserve(context, &bins->places_buffer, STREAMS * stride, sizeof(float));
    if (status != EWA_OK) return status;
    float *places = bins->places_buffer.data;
    bins->places = (ewa_packet_places){places, places + stride, places + 2 * stride, places + 3 * stride,
                                       places + 4 * stride};
    int32_t *kept = bins->kept_buffer.data;
    job.kept = (ewa_kept_packets){kept, kept + stride, kept + 2 * stride};
    job.counts = bins->counts.data;
    job.kept_count = job.counts + (size_t)job.parts * job.tiles;
    bins->tile_first = bins->tile_first_buffer.data;
    ewa_parallel(context, count_part, &job, job.parts);
    const uint64_t entry_count = place(&job);
    status = ewa_buffer_reserve(context, &bins->entries_buffer, entry_count, sizeof *bins->entries);
    if (status != EWA_OK) return status;
    bins->entries = bins->entries_buffer.data;
    ewa_parallel(context, fill_part, &job, job.parts);
    bins->culled_packet_count = surfels->packet_count;
    for (uint32_t part = 0; part < job.parts; part++) bins->culled_packet_count -= job.kept_count[part];
    return EWA_OK;
}

void ewa_bins_free(ewa_context *context, ewa_bins *bins) {
    ewa_buffer_free(context, &bins->kept_buffer);
    ewa_buffer_free(context, &bins->counts);
    ewa_buffer_free(context, &bins->tile_first_buffer);
    ewa_buffer_free(context, &bins->entries_buffer);
    ewa_buffer_free(context, &bins->places_buffer);
}
