// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Rows of a frame on their way to the paper's pipeline: which packets they see, and what programs see of views and lights.
#include "gl/raster_band.h"
#include "gl/scene.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

enum { PAGE_PACKETS = 1 << 16, MAX_GAP = 8 };

static_assert(sizeof(ewa_raster_view) == 320 && sizeof(ewa_raster_view) <= EWA_RASTER_VIEW_STRIDE &&
                  sizeof(ewa_raster_resolve) == 480 + 16 * EWA_MAX_ENVIRONMENT_LEVELS &&
                  sizeof(ewa_raster_packet) == 48,
              "as std140 and the attributes of vertices have them");

/// Marks the packets that some field of the rows has.
static void mark_live(const ewa_raster_band *band, const ewa_tile_job *job, const ewa_tile_source *source,
                      uint8_t *live) {
    const uint32_t columns = job->tiles.columns, first_row = band->first_row_px / EWA_FIELD_PX,
                   end_row = (band->end_row_px + EWA_FIELD_PX - 1) / EWA_FIELD_PX;
    const uint64_t *starts = source->bins.lists.starts;
    memset(live, 0, source->surfels->packet_count);
    for (uint64_t i = starts[first_row * columns]; i < starts[end_row * columns]; i++)
        live[source->bins.lists.ids[i]] = 1;
}

/// Whether a surfel of the packet may touch the eye's plane, or be huge.
static bool may_be_near(const ewa_tile_source *source, uint32_t id) {
    const ewa_view *view = &source->view;
    if (view->point_sigma_px > 0) return false;
    float radius;
    const uint32_t bits = (uint32_t)source->surfels->bounds.radius[id] << EWA_RADIUS_SHIFT;
    memcpy(&radius, &bits, sizeof radius);
    radius *= view->scale;
    if (view->orthographic) return radius > view->broad;
    const float margin = 1.1f;
    return source->packets.places.depth[id] <= radius * (margin + view->broad);
}

static ewa_raster_packet make_packet(const ewa_raster_band *band, const ewa_tile_source *source,
                                     uint32_t id) {
    const ewa_packet_source *packets = &source->packets;
    const ewa_packet_places *places = &packets->places;
    const ewa_view *view = &source->view;
    const double slope[2] = {(double)places->slope_x[id], (double)places->slope_y[id]};
    const double first_px[2] = {0, band->first_row_px};
    ewa_raster_packet packet = {.slope = {places->slope_x[id], places->slope_y[id]},
                                .rest = {places->rest_x[id], places->rest_y[id]},
                                .depth = places->depth[id],
                                .form = packets->colors[id],
                                .lanes = places->lanes ? places->lanes[id] : 0xffffu};
    for (int i = 0; i < 2; i++)
        packet.base_px[i] = (float)(slope[i] * view->focal_px[i] + view->principal_px[i] - first_px[i]);
    if (places->cuts) packet.lanes |= (uint32_t)places->cuts[id] << 16;
    if (!packets->clip_masks || !packets->clip_masks[id]) return packet;
    packet.own = packets->clip_masks[id];
    packet.first_line = source->surfels->clip_first[id];
    return packet;
}

/// Lists a source's runs; short gaps between them are packets without surfels.
static void list_source(ewa_raster_band *band, const ewa_tile_source *source, uint32_t index,
                        const uint8_t *live) {
    ewa_raster_packet *packets = band->packets.data;
    ewa_raster_run *runs = band->runs.data, *run = NULL;
    for (uint32_t id = 0; id < source->surfels->packet_count; id++) {
        if (!live[id]) continue;
        const uint32_t page = id / PAGE_PACKETS, at = id % PAGE_PACKETS;
        if (run && (run->page != page || at - (run->first + run->count) > MAX_GAP)) run = NULL;
        if (!run) {
            run = &runs[band->run_count++];
            *run = (ewa_raster_run){.source = index, .page = page, .first = at, .record = band->packet_count};
        }
        for (; run->first + run->count < at; run->count++)
            packets[band->packet_count++] = (ewa_raster_packet){0};
        packets[band->packet_count++] = make_packet(band, source, id);
        run->count++;
        run->near |= may_be_near(source, id);
        band->surfel_count += EWA_PACKET_LANES;
    }
}

ewa_status ewa_raster_band_start(ewa_context *context, ewa_raster_band *band, const ewa_tile_job *job,
                                 uint32_t first_row_px, uint32_t end_row_px) {
    band->first_row_px = first_row_px, band->end_row_px = end_row_px;
    band->packet_count = band->run_count = 0;
    band->surfel_count = 0;
    uint64_t packet_count = 0;
    uint32_t maximum = 0;
    for (uint32_t i = 0; i < job->source_count; i++) {
        const uint32_t here = job->sources[i].surfels->packet_count;
        packet_count += here;
        maximum = here > maximum ? here : maximum;
    }
    if (packet_count > UINT32_MAX)
        return ewa_fail(context, EWA_ERROR_LIMIT, "OpenGL: %llu packets of surfels are more than %u",
                        (unsigned long long)packet_count, UINT32_MAX);
    EWA_TRY(ewa_buffer_reserve(context, &band->live, maximum, 1));
    EWA_TRY(ewa_buffer_reserve(context, &band->packets, packet_count, sizeof(ewa_raster_packet)));
    EWA_TRY(ewa_buffer_reserve(context, &band->runs, packet_count, sizeof(ewa_raster_run)));
    for (uint32_t i = 0; i < job->source_count; i++) {
        mark_live(band, job, &job->sources[i], band->live.data);
        list_source(band, &job->sources[i], i, band->live.data);
    }
    return EWA_OK;
}

void ewa_raster_band_free(ewa_context *context, ewa_raster_band *band) {
    ewa_buffer_free(context, &band->packets);
    ewa_buffer_free(context, &band->runs);
    ewa_buffer_free(context, &band->live);
}

/// The section planes in camera space: with q = linear (c - anchor) + offset, linear a rotation R times a length:
/// the plane is (R m).q + e' in its unit.
static void set_sections(ewa_raster_view *to, const ewa_view *from) {
    for (uint32_t k = 0; k < from->section_count; k++) {
        const double *plane = from->sections[k];
        double at =
            plane[3] + plane[0] * from->anchor[0] + plane[1] * from->anchor[1] + plane[2] * from->anchor[2];
        at *= (double)from->scale;
        for (int i = 0; i < 3; i++) {
            double is_back = 0;
            for (int j = 0; j < 3; j++) is_back += (double)from->rotation[3 * i + j] * plane[j];
            to->sections[k][i] = (float)is_back;
            at -= is_back * from->offset[i];
        }
        to->sections[k][3] = (float)at;
    }
}

void ewa_raster_view_set(ewa_raster_view *to, const ewa_view *from, const ewa_tile_job *job,
                         const ewa_raster_band *band) {
    ewa_gl_view view;
    ewa_gl_view_set(&view, from, false);
    memset(to, 0, sizeof *to);
    for (int i = 0; i < 3; i++) memcpy(to->rotation[i], &view.rotation[3 * i], 3 * sizeof(float));
    // One pass draws the nearest: what both passes make of its key may differ in the last places.
    const float slack = job->resolve.one_pass ? 0x1p-22f : 0;
    const float numbers[7][4] = {{view.fx_px, view.fy_px, view.inverse_fx, view.inverse_fy},
                                 {view.fx_zoomed, view.fy_zoomed, view.zoom, view.scale},
                                 {view.cutoff, view.cutoff2, view.prefilter2_px2, view.reach_px},
                                 {view.tolerance, view.grazing, view.broad, slack},
                                 {view.point_x, view.point_y, view.point_major, view.point_minor},
                                 {view.sum_scale, view.color_scale, view.point_sigma, 1 / view.zoom},
                                 {(float)job->tiles.width_px, (float)(band->end_row_px - band->first_row_px),
                                  (float)from->principal_px[0],
                                  (float)(from->principal_px[1] - band->first_row_px)}};
    memcpy((char *)to + offsetof(ewa_raster_view, focal), numbers, sizeof numbers);
    set_sections(to, from);
    to->flags[0] = view.flags | (job->with_opacity ? EWA_RASTER_TRANSLUCENT : 0);
    to->flags[1] = from->section_reach > 0 ? from->section_count : 0;
    to->contour[0] = from->contour_shift, to->contour[1] = from->contour_sine2;
    to->contour[2] = from->curvature_scale;
}

/// The environment, and what materials differ in.
static void set_reflection(ewa_raster_resolve *to, const ewa_tile_job *job) {
    ewa_gl_resolve from;
    ewa_gl_resolve_set(&from, &job->resolve);
    memcpy(to->material_units, from.material_units, sizeof to->material_units);
    to->reflection[0] = from.material[4], to->reflection[1] = from.material_units[4];
    to->reflection[2] = from.texels_per_radian2;
    for (int i = 0; i < 3; i++)
        memcpy(to->environment_from_camera[i], &from.environment_from_camera[3 * i], 3 * sizeof(float));
    for (uint32_t i = 0; i < from.level_count; i++) {
        to->levels[i][0] = from.levels[i].width, to->levels[i][1] = from.levels[i].height;
        to->levels[i][2] = from.levels[i].first / 3;
    }
    to->flags[3] = from.level_count;
    to->flags[0] |= job->with_materials ? 64u : 0;
}

void ewa_raster_resolve_set(ewa_raster_resolve *to, const ewa_tile_job *job, const ewa_raster_band *band) {
    const ewa_resolve *from = &job->resolve;
    memset(to, 0, sizeof *to);
    const float numbers[5][4] = {
        {from->unit_coverage_inverse, from->alpha_scale, from->covering, from->front_scale},
        {from->color_unit, from->opacity, from->depth_unit, 0},
        {from->material[0], from->material[1], from->material[2], from->material[3]},
        {from->background[0], from->background[1], from->background[2], from->background[3]},
        {from->ray_x[0], from->ray_x[1], from->ray_y[0],
         from->ray_y[1] + from->ray_y[0] * (float)band->first_row_px}};
    memcpy((char *)to + offsetof(ewa_raster_resolve, scales), numbers, sizeof numbers);
    for (int i = 0; i < 3; i++) memcpy(to->to_world[i], &from->to_world[3 * i], 3 * sizeof(float));
    for (uint32_t i = 0; i < from->light_count; i++) {
        memcpy(to->toward[i], from->lights[i].toward, 3 * sizeof(float));
        to->toward[i][3] = from->lights[i].headlight;
        memcpy(to->light[i], from->lights[i].color, 3 * sizeof(float));
    }
    to->flags[0] = (from->edge_antialiasing ? 1u : 0) | (from->transparent ? 2u : 0) |
                   (from->one_pass ? 4u : 0) | (from->orthographic ? 8u : 0) | (job->with_opacity ? 16u : 0) |
                   (job->view.cull_back ? 0 : 32u);
    to->flags[1] = (uint32_t)from->shading;
    to->flags[2] = from->light_count;
    set_reflection(to, job);
}
