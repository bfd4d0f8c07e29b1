// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The surfaces of a picture: surfels as they are, and octrees, each drawn from its levels.
#include "surfaces.h"

#include <stdlib.h>
#include <string.h>

static ewa_status draw_surfels(paint_tools *tools, const paint_scene *scene,
                               const ewa_render_options *options, const ewa_frame *frame,
                               paint_stats *stats) {
    ewa_status status = ewa_render_begin(tools->renderer, &scene->camera, options, frame);
    for (uint32_t i = 0; i < scene->surfels_count && status == EWA_OK; i++)
        status = ewa_render_add(tools->renderer, scene->surfels[i]);
    return status == EWA_OK ? ewa_render_finish(tools->renderer, &stats->render) : status;
}

/// Draws an octree; one thread at a time reads of any.
static ewa_status draw_lod(paint_tools *tools, const paint_scene *scene, ewa_lod *lod,
                           const ewa_render_options *options, const ewa_frame *frame, paint_stats *stats) {
    ewa_lod_stats took = {.cube_count = 0};
    pthread_mutex_lock(scene->lods_lock);
    const ewa_status status =
        ewa_lod_render(lod, tools->renderer, &scene->camera, options, &scene->lod_options, frame, &took);
    pthread_mutex_unlock(scene->lods_lock);
    if (took.render.level > stats->render.level) stats->render.level = took.render.level;
    stats->render.splat_count += took.render.splat_count;
    stats->render.total_s += took.render.total_s + took.load_s + took.choose_s;
    stats->missing_count += took.missing_count;
    stats->loaded_count += took.loaded_count;
    return status;
}

void surfaces_free(paint_tools *tools) {
    for (int k = 0; k < 2; k++) {
        free(tools->layers[k].rgba);
        free(tools->layers[k].depth);
        tools->layers[k] = (paint_layer){.capacity_px = 0};
    }
}

static ewa_status reserve(paint_tools *tools, size_t count) {
    for (int k = 0; k < 2; k++) {
        paint_layer *layer = &tools->layers[k];
        if (count <= layer->capacity_px) continue;
        free(layer->rgba);
        free(layer->depth);
        layer->rgba = malloc(4 * count * sizeof *layer->rgba);
        layer->depth = malloc(count * sizeof *layer->depth);
        layer->capacity_px = layer->rgba && layer->depth ? count : 0;
        if (!layer->capacity_px) return EWA_ERROR_MEMORY;
    }
    return EWA_OK;
}

/// Puts a second layer to the first one, pixel by pixel the nearer over the farther.
static void merge(const paint_layer *first, const paint_layer *second, size_t count) {
    for (size_t i = 0; i < count; i++) {
        float *to = first->rgba + 4 * i;
        const float *from = second->rgba + 4 * i;
        const bool in_front = second->depth[i] < first->depth[i];
        const float through = 1 - (in_front ? from[3] : to[3]);
        for (int c = 0; c < 4; c++) to[c] = in_front ? from[c] + through * to[c] : to[c] + through * from[c];
        if (in_front) first->depth[i] = second->depth[i];
    }
}

static uint8_t code(float number) {
    const float scaled = 255 * number + 0.5f;
    return scaled > 0 ? (scaled < 255 ? (uint8_t)scaled : 255) : 0;
}

/// Puts the layer over the background, and into the planes that are wanted.
static void finish(const paint_layer *layer, const float background[4], size_t count,
                   const ewa_frame *frame) {
    if (frame->depth) memcpy(frame->depth, layer->depth, count * sizeof *frame->depth);
    for (size_t i = 0; i < count; i++) {
        float *out = layer->rgba + 4 * i;
        const float through = (1 - out[3]) * background[3];
        for (int c = 0; c < 3; c++) out[c] += through * background[c];
        out[3] += through;
        for (int c = 0; c < 4 && frame->rgba8; c++) {
            const float straight = c < 3 && out[3] > 0 ? out[c] / out[3] : 0;
            frame->rgba8[4 * i + (size_t)c] = code(c < 3 ? ewa_srgb_from_linear(straight) : out[3]);
        }
    }
    if (frame->rgba) memcpy(frame->rgba, layer->rgba, 4 * count * sizeof *frame->rgba);
}

static ewa_status draw_layers(paint_tools *tools, const paint_scene *scene, const ewa_frame *frame,
                              paint_stats *stats) {
    const size_t count = (size_t)scene->camera.width_px * scene->camera.height_px;
    ewa_render_options options = scene->render;
    memset(options.background, 0, sizeof options.background);
    ewa_status status = reserve(tools, count);
    const ewa_frame layers[2] = {{.rgba = tools->layers[0].rgba, .depth = tools->layers[0].depth},
                                 {.rgba = tools->layers[1].rgba, .depth = tools->layers[1].depth}};
    const bool first = scene->surfels_count > 0;
    if (status == EWA_OK && first) status = draw_surfels(tools, scene, &options, &layers[0], stats);
    for (uint32_t i = 0; i < scene->lods_count && status == EWA_OK; i++) {
        const bool more = first || i > 0;
        status = draw_lod(tools, scene, scene->lods[i], &options, &layers[more], stats);
        if (status == EWA_OK && more) merge(&tools->layers[0], &tools->layers[1], count);
    }
    if (status == EWA_OK) finish(&tools->layers[0], scene->render.background, count, frame);
    return status;
}

ewa_status surfaces_draw(paint_tools *tools, const paint_scene *scene, const ewa_frame *frame,
                         paint_stats *stats) {
    paint_stats own;
    if (!stats) stats = &own;
    *stats = (paint_stats){.missing_count = 0};
    if (!scene->lods_count) return draw_surfels(tools, scene, &scene->render, frame, stats);
    if (scene->lods_count == 1 && !scene->surfels_count)
        return draw_lod(tools, scene, scene->lods[0], &scene->render, frame, stats);
    return draw_layers(tools, scene, frame, stats);
}
