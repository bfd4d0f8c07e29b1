// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One tile from its packets to its pixels: runs of packets are set up, sorted and lower the depth bound; then
// all records that reach the bound are summed, and the sums resolved (math.md sections 6 and 7).
//
// Records are kept from the first pass to the second. A tile that would need more than KEPT_RECORDS sets its
// runs up again for the second pass instead: the same records in the same order, so the same bytes.
#include "splat/tile.h"

enum {
    KEPT_RECORDS = 1 << 18, // 20 MiB per worker
    NEAR_CHUNK = 64,
};

ewa_status ewa_tile_scratch_reserve(ewa_context *context, ewa_tile_scratch *s, const ewa_tile_job *job,
                                    uint64_t largest_bin) {
    uint64_t records = largest_bin * EWA_PACKET_LANES;
    if (records > KEPT_RECORDS) records = KEPT_RECORDS;
    if (records < EWA_RUN_RECORDS) records = EWA_RUN_RECORDS;
    const size_t tile_floats = (size_t)job->view.tile_px * job->view.tile_px;
    ewa_status status = ewa_buffer_reserve(context, &s->record_buffer, records, sizeof *s->records);
    if (status == EWA_OK)
        status = ewa_buffer_reserve(context, &s->normal_buffer, records, sizeof *s->normals);
    if (status == EWA_OK)
        status = ewa_buffer_reserve(context, &s->near_buffer, records, sizeof *s->near_surfels);
    if (status == EWA_OK)
        status = ewa_buffer_reserve(context, &s->kept_buffer, records / EWA_RUN_RECORDS + 1, sizeof *s->kept);
    if (status == EWA_OK)
        status = ewa_buffer_reserve(context, &s->nearest_buffer, tile_floats, sizeof(float));
    if (status == EWA_OK)
        status = ewa_buffer_reserve(context, &s->sum_buffer, tile_floats * EWA_MAX_CHANNELS, sizeof(float));
    if (status != EWA_OK) return status;
    s->records = s->record_buffer.data;
    s->normals = s->normal_buffer.data;
    s->near_surfels = s->near_buffer.data;
    s->kept = s->kept_buffer.data;
    s->nearest = s->nearest_buffer.data;
    s->sums = s->sum_buffer.data;
    s->record_capacity = s->record_buffer.capacity_bytes / sizeof *s->records;
    s->drawn_count = s->fragment_count = 0;
    s->setup_s = s->visibility_s = s->accumulate_s = s->resolve_s = 0;
    return EWA_OK;
}

void ewa_tile_scratch_free(ewa_context *context, ewa_tile_scratch *s) {
    ewa_buffer_free(context, &s->record_buffer);
    ewa_buffer_free(context, &s->normal_buffer);
    ewa_buffer_free(context, &s->near_buffer);
    ewa_buffer_free(context, &s->kept_buffer);
    ewa_buffer_free(context, &s->nearest_buffer);
    ewa_buffer_free(context, &s->sum_buffer);
}

static void draw_near(const ewa_tile_job *job, const ewa_tile *tile, const uint32_t *surfels, uint32_t count,
                      bool second_pass) {
    ewa_near_record records[NEAR_CHUNK];
    for (uint32_t done = 0; done < count;) {
        uint32_t filled = 0;
        for (; done < count && filled < NEAR_CHUNK; done++)
            filled += ewa_near_record_set(&records[filled], job->surfels, surfels[done], &job->view, tile);
        (second_pass ? job->kernels->near_accumulate : job->kernels->near_visibility)(&job->view, tile,
                                                                                      records, filled);
    }
}

static void count_fragments(ewa_tile_scratch *s, const ewa_record *records, uint32_t count) {
    for (uint32_t i = 0; i < count; i++)
        s->fragment_count += (uint64_t)(records[i].box >> 16 & 0xff) * (records[i].box >> 24);
}

/// Sets up and sorts run `index` of a tile to `records`; the result is in `kept` and s->run's near surfels.
static void prepare_run(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s,
                        const uint32_t *packets, uint64_t packet_count, uint64_t index, ewa_record *records,
                        float (*normals)[4], ewa_kept_run *kept) {
    const uint64_t first = index * EWA_RUN_PACKETS, left = packet_count - first;
    job->kernels->setup(&job->view, job->surfels->packets, packets + first,
                        left < EWA_RUN_PACKETS ? (uint32_t)left : EWA_RUN_PACKETS, tile, &s->run);
    job->kernels->sort(&s->run, job->with_normals, records, normals, kept->class_first);
    kept->near_count = s->run.near_count;
}

static void draw_kept(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s,
                      const uint32_t *packets, uint64_t packet_count) {
    const ewa_road_kernels *kernels = job->kernels;
    const uint64_t runs = (packet_count + EWA_RUN_PACKETS - 1) / EWA_RUN_PACKETS;
    uint32_t record_count = 0, near_count = 0;
    double before = ewa_now_s();
    for (uint64_t i = 0; i < runs; i++) {
        ewa_kept_run *kept = &s->kept[i];
        kept->record_first = record_count;
        kept->near_first = near_count;
        prepare_run(job, tile, s, packets, packet_count, i, s->records + record_count,
                    s->normals + record_count, kept);
        const double middle = ewa_now_s();
        s->setup_s += middle - before;
        kernels->visibility(&job->view, tile, s->records + record_count, kept->class_first);
        draw_near(job, tile, s->run.near_surfels, kept->near_count, false);
        for (uint32_t k = 0; k < kept->near_count; k++)
            s->near_surfels[near_count + k] = s->run.near_surfels[k];
        record_count += s->run.count;
        near_count += kept->near_count;
        before = ewa_now_s();
        s->visibility_s += before - middle;
    }
    s->drawn_count += record_count + near_count;
    if (job->count_fragments) count_fragments(s, s->records, record_count);
    before = ewa_now_s();
    kernels->bound(&job->view, tile);
    for (uint64_t i = 0; i < runs; i++) {
        const ewa_kept_run *kept = &s->kept[i];
        kernels->accumulate(&job->view, tile, s->records + kept->record_first,
                            (const float(*)[4])s->normals + kept->record_first, kept->class_first);
        draw_near(job, tile, s->near_surfels + kept->near_first, kept->near_count, true);
    }
    s->accumulate_s += ewa_now_s() - before;
}

static void draw_again(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s,
                       const uint32_t *packets, uint64_t packet_count) {
    const ewa_road_kernels *kernels = job->kernels;
    const uint64_t runs = (packet_count + EWA_RUN_PACKETS - 1) / EWA_RUN_PACKETS;
    for (int second_pass = 0; second_pass < 2; second_pass++) {
        for (uint64_t i = 0; i < runs; i++) {
            ewa_kept_run kept;
            const double before = ewa_now_s();
            prepare_run(job, tile, s, packets, packet_count, i, s->records, s->normals, &kept);
            const double middle = ewa_now_s();
            s->setup_s += middle - before;
            if (!second_pass) {
                kernels->visibility(&job->view, tile, s->records, kept.class_first);
                s->drawn_count += s->run.count + s->run.near_count;
                if (job->count_fragments) count_fragments(s, s->records, s->run.count);
            } else {
                kernels->accumulate(&job->view, tile, s->records, (const float(*)[4])s->normals,
                                    kept.class_first);
            }
            draw_near(job, tile, s->run.near_surfels, kept.near_count, second_pass);
            *(second_pass ? &s->accumulate_s : &s->visibility_s) += ewa_now_s() - middle;
        }
        if (!second_pass) kernels->bound(&job->view, tile);
    }
}

void ewa_tile_draw(void *data, uint32_t index, uint32_t worker) {
    const ewa_tile_job *job = data;
    ewa_tile_scratch *s = job->scratch[worker];
    const ewa_view *view = &job->view;
    ewa_tile tile = {.x_px = (int32_t)(index % job->bins->tiles_x * view->tile_px),
                     .y_px = (int32_t)(index / job->bins->tiles_x * view->tile_px),
                     .nearest = s->nearest,
                     .sums = s->sums,
                     .channel_count = job->channel_count,
                     .with_normals = job->with_normals,
                     .with_depth = job->with_depth};
    const int32_t side = (int32_t)view->tile_px;
    tile.width_px = (int32_t)view->width_px - tile.x_px < side ? (int32_t)view->width_px - tile.x_px : side;
    tile.height_px =
        (int32_t)view->height_px - tile.y_px < side ? (int32_t)view->height_px - tile.y_px : side;
    tile.blocks_per_row = ((uint32_t)tile.width_px + EWA_BLOCK_PX - 1) / EWA_BLOCK_PX;
    tile.block_rows = ((uint32_t)tile.height_px + EWA_BLOCK_PX - 1) / EWA_BLOCK_PX;
    job->kernels->clear(&tile);
    const uint64_t first = job->bins->tile_first[index], count = job->bins->tile_first[index + 1] - first;
    const uint32_t *packets = job->bins->entries + first;
    if (count * EWA_PACKET_LANES <= s->record_capacity)
        draw_kept(job, &tile, s, packets, count);
    else
        draw_again(job, &tile, s, packets, count);
    const double before = ewa_now_s();
    job->kernels->resolve(&tile, &job->resolve);
    s->resolve_s += ewa_now_s() - before;
}
