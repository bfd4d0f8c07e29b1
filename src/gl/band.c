// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A band of a frame on its way to the device.
#include "gl/band.h"

#include <string.h>

enum { LANES = EWA_PACKET_LANES, PLACE_FLOATS = 6 };

static uint64_t bin_count(const ewa_tile_source *source, uint32_t bin) {
    return source->bins.lists.starts[bin + 1] - source->bins.lists.starts[bin];
}

uint64_t ewa_gl_band_pairs(const ewa_tile_job *job, uint32_t first_field_row, uint32_t end_field_row) {
    const uint32_t columns = job->tiles.columns;
    uint64_t count = 0;
    for (uint32_t i = 0; i < job->source_count; i++)
        for (uint32_t bin = first_field_row * columns; bin < end_field_row * columns; bin++)
            count += bin_count(&job->sources[i], bin);
    return count;
}

/// Writes what the set-up reads of a packet in a field.
static void write_pair(const ewa_tile_source *source, uint32_t id, float *place, uint32_t *words) {
    const ewa_packet_source *packets = &source->packets;
    const ewa_packet_places *places = &packets->places;
    place[0] = places->slope_x[id], place[1] = places->slope_y[id];
    place[2] = places->rest_x[id], place[3] = places->rest_y[id];
    place[4] = places->depth[id], place[5] = 0;
    const uint32_t lanes = places->lanes ? places->lanes[id] : 0xffff;
    const uint32_t clipped =
        (packets->clip_masks ? packets->clip_masks[id] : 0u) | (places->cuts ? places->cuts[id] : 0u);
    words[0] = packets->colors[id] | (uint32_t)packets->material << 16;
    words[1] = lanes | clipped << 16;
}

/// Appends the pairs of one page of a source.
static void append_page(ewa_gl_band *band, const ewa_tile_job *job, uint32_t index, uint32_t page,
                        uint32_t page_packets) {
    const ewa_tile_source *source = &job->sources[index];
    const uint32_t columns = job->tiles.columns, first_row = band->first_row_px / EWA_FIELD_PX,
                   end_row = (band->end_row_px + EWA_FIELD_PX - 1) / EWA_FIELD_PX;
    const uint64_t first_id = (uint64_t)page * page_packets, end_id = first_id + page_packets;
    ewa_gl_pair *pairs = band->pairs.data;
    float *places = band->places.data;
    uint32_t *words = band->words.data, *ids = band->ids.data;
    const uint32_t before = band->pair_count;
    for (uint32_t bin = first_row * columns; bin < end_row * columns; bin++) {
        const uint32_t field = bin % columns | bin / columns << 16;
        const uint32_t *of_bin = source->bins.lists.ids + source->bins.lists.starts[bin];
        for (uint64_t i = 0, count = bin_count(source, bin); i < count; i++) {
            const uint32_t id = of_bin[i];
            if (id < first_id || id >= end_id) continue;
            const uint32_t at = band->pair_count++;
            pairs[at] = (ewa_gl_pair){(uint32_t)(id - first_id), field};
            ids[at] = id;
            write_pair(source, id, places + (size_t)at * PLACE_FLOATS, words + (size_t)at * 2);
        }
    }
    if (band->pair_count == before) return;
    ((ewa_gl_batch *)band->batches.data)[band->batch_count++] =
        (ewa_gl_batch){index, page, before, band->pair_count - before};
}

ewa_status ewa_gl_band_start(ewa_context *context, ewa_gl_band *band, const ewa_tile_job *job,
                             uint32_t first_row_px, uint32_t end_row_px, uint32_t tile_px,
                             const uint32_t *page_packets) {
    enum { SIDE = EWA_BLOCK_PX };
    band->first_row_px = first_row_px, band->end_row_px = end_row_px;
    band->width_px = (job->tiles.width_px + SIDE - 1) / SIDE * SIDE;
    band->height_px = (end_row_px - first_row_px + SIDE - 1) / SIDE * SIDE;
    band->tile_px = tile_px;
    band->tiles_per_row = (band->width_px + tile_px - 1) / tile_px;
    band->tile_count = band->tiles_per_row * ((band->height_px + tile_px - 1) / tile_px);
    band->batch_count = band->pair_count = 0;
    const uint64_t pair_count =
        ewa_gl_band_pairs(job, first_row_px / EWA_FIELD_PX, (end_row_px + EWA_FIELD_PX - 1) / EWA_FIELD_PX);
    uint64_t batch_count = 0;
    for (uint32_t i = 0; i < job->source_count; i++)
        batch_count += (job->sources[i].surfels->packet_count + page_packets[i] - 1) / page_packets[i];
    const struct {
        ewa_buffer *buffer;
        size_t count, size_bytes;
    } needs[] = {{&band->batches, batch_count, sizeof(ewa_gl_batch)},
                 {&band->pairs, pair_count, sizeof(ewa_gl_pair)},
                 {&band->places, pair_count, PLACE_FLOATS * sizeof(float)},
                 {&band->words, pair_count, 2 * sizeof(uint32_t)},
                 {&band->ids, pair_count, sizeof(uint32_t)},
                 {&band->masks, pair_count, sizeof(uint32_t)},
                 {&band->counts, band->tile_count, sizeof(uint32_t)}};
    for (size_t i = 0; i < sizeof needs / sizeof needs[0]; i++) {
        EWA_TRY(ewa_buffer_reserve(context, needs[i].buffer, needs[i].count, needs[i].size_bytes));
    }
    for (uint32_t i = 0; i < job->source_count; i++) {
        const uint32_t pages =
            (job->sources[i].surfels->packet_count + page_packets[i] - 1) / page_packets[i];
        for (uint32_t page = 0; page < pages; page++) append_page(band, job, i, page, page_packets[i]);
    }
    return EWA_OK;
}

/// A field as a tile, for what the host makes in its pixels.
static ewa_tile field_tile(const ewa_tile_job *job, uint32_t field) {
    return (ewa_tile){.x_px = (int32_t)((field & 0xffff) * EWA_FIELD_PX),
                      .y_px = (int32_t)((field >> 16) * EWA_FIELD_PX),
                      .field_x_px = -EWA_FIELD_PX / 2,
                      .field_y_px = -EWA_FIELD_PX / 2,
                      .with_opacity = job->with_opacity,
                      .with_materials = job->with_materials};
}

static uint32_t field_number(const ewa_gl_band *band, const ewa_tile_job *job, uint32_t field) {
    return ((field >> 16) - band->first_row_px / EWA_FIELD_PX) * job->tiles.columns + (field & 0xffff);
}

static uint32_t field_count(const ewa_gl_band *band, const ewa_tile_job *job) {
    return (band->height_px + EWA_FIELD_PX - 1) / EWA_FIELD_PX * job->tiles.columns;
}

/// Reserves what the masks ask for: near records by field, with those of each between near_starts[field] and
/// near_starts[field_count + field].
static ewa_status reserve_answers(ewa_context *context, ewa_gl_band *band, const ewa_tile_job *job) {
    const uint32_t fields = field_count(band, job), *masks = band->masks.data;
    const ewa_gl_pair *pairs = band->pairs.data;
    EWA_TRY(ewa_buffer_reserve(context, &band->near_starts, (size_t)2 * fields, sizeof(uint32_t)));
    EWA_TRY(ewa_buffer_reserve(context, &band->clipped, band->pair_count, 2 * sizeof(uint32_t)));
    uint32_t *starts = band->near_starts.data, *ends = starts + fields;
    memset(starts, 0, (size_t)fields * sizeof *starts);
    band->near_count = band->clip_count = 0;
    for (uint32_t i = 0; i < band->pair_count; i++) {
        starts[field_number(band, job, pairs[i].field)] += (uint32_t)__builtin_popcount(masks[i] & 0xffff);
        band->clip_count += (uint32_t)__builtin_popcount(masks[i] >> 16);
    }
    for (uint32_t i = 0; i < fields; i++) {
        const uint32_t here = starts[i];
        starts[i] = ends[i] = band->near_count;
        band->near_count += here;
    }
    EWA_TRY(ewa_buffer_reserve(context, &band->nears, band->near_count, sizeof(ewa_gl_near)));
    return ewa_buffer_reserve(context, &band->clips, band->clip_count, sizeof(ewa_gl_clip));
}

ewa_status ewa_gl_band_answer(ewa_context *context, ewa_gl_band *band, const ewa_tile_job *job) {
    EWA_TRY(reserve_answers(context, band, job));
    const uint32_t *masks = band->masks.data, *ids = band->ids.data;
    const ewa_gl_pair *pairs = band->pairs.data;
    const ewa_gl_batch *batches = band->batches.data;
    uint32_t *ends = (uint32_t *)band->near_starts.data + field_count(band, job);
    uint32_t *clipped = band->clipped.data, clip_count = 0;
    ewa_gl_near *nears = band->nears.data;
    ewa_gl_clip *clips = band->clips.data;
    for (uint32_t b = 0; b < band->batch_count; b++) {
        const ewa_tile_source *source = &job->sources[batches[b].source];
        for (uint32_t i = batches[b].first_pair; i < batches[b].first_pair + batches[b].pair_count; i++) {
            clipped[2 * i] = masks[i] >> 16, clipped[2 * i + 1] = clip_count;
            if (!masks[i]) continue;
            const ewa_tile tile = field_tile(job, pairs[i].field);
            uint32_t *next = &ends[field_number(band, job, pairs[i].field)];
            for (uint32_t left = masks[i] & 0xffff; left; left &= left - 1) {
                const uint32_t surfel = ids[i] * LANES + (uint32_t)__builtin_ctz(left);
                ewa_near_record record;
                if (!ewa_near_record_set(&record, source->surfels, surfel, &source->view, &tile)) continue;
                ewa_gl_near_set(&nears[(*next)++], &record, batches[b].source);
            }
            for (uint32_t left = masks[i] >> 16; left; left &= left - 1) {
                const uint32_t surfel = ids[i] * LANES + (uint32_t)__builtin_ctz(left);
                ewa_clip clip;
                ewa_clip_set(&clip, source->surfels, surfel, &source->view, &tile);
                ewa_gl_clip_set(&clips[clip_count++], &clip);
            }
        }
    }
    return EWA_OK;
}

/// Appends the units of a range, `maximum` of its items to each.
static ewa_status append_units(ewa_context *context, ewa_gl_band *band, uint32_t tile, uint32_t first,
                               uint32_t end, uint32_t near, uint32_t maximum) {
    const uint32_t count = (end - first + maximum - 1) / maximum;
    EWA_TRY(ewa_buffer_grow(context, &band->units, band->unit_count, (size_t)band->unit_count + count,
                            sizeof(ewa_gl_unit)));
    ewa_gl_unit *units = band->units.data;
    for (uint32_t at = first; at < end; at += maximum)
        units[band->unit_count++] = (ewa_gl_unit){tile, at, end - at < maximum ? end : at + maximum, near};
    return EWA_OK;
}

ewa_status ewa_gl_band_divide(ewa_context *context, ewa_gl_band *band, const ewa_tile_job *job,
                              uint32_t maximum) {
    ewa_status status = ewa_buffer_reserve(context, &band->starts, band->tile_count, sizeof(uint32_t));
    const uint32_t *counts = band->counts.data, *near_starts = band->near_starts.data;
    uint32_t *starts = band->starts.data;
    band->unit_count = 0;
    band->list_count = 0;
    for (uint32_t tile = 0; tile < band->tile_count && status == EWA_OK; tile++) {
        starts[tile] = (uint32_t)band->list_count;
        band->list_count += counts[tile];
        if (band->list_count > UINT32_MAX)
            return ewa_fail(context, EWA_ERROR_LIMIT, "OpenGL: more than %u splats in the tiles of a band",
                            UINT32_MAX);
        status = append_units(context, band, tile, starts[tile], (uint32_t)band->list_count, 0, maximum);
        if (status != EWA_OK || !band->near_count) continue;
        const uint32_t x_px = tile % band->tiles_per_row * band->tile_px,
                       y_px = tile / band->tiles_per_row * band->tile_px;
        const uint32_t field = y_px / EWA_FIELD_PX * job->tiles.columns + x_px / EWA_FIELD_PX;
        status = append_units(context, band, tile, near_starts[field],
                              near_starts[field_count(band, job) + field], 1, maximum);
    }
    return status;
}

void ewa_gl_band_free(ewa_context *context, ewa_gl_band *band) {
    ewa_buffer *const buffers[] = {&band->batches,     &band->pairs, &band->places,  &band->words,
                                   &band->ids,         &band->units, &band->starts,  &band->nears,
                                   &band->near_starts, &band->clips, &band->clipped, &band->masks,
                                   &band->counts};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++) ewa_buffer_free(context, buffers[i]);
}
