// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which levels of streamed Gaussians a picture shows, and what of them is in memory.
//
// A leaf is drawn by the coarsest of its levels that is expected to be within so many pixels of its finest where its box is nearest to the
// eye, in all directions alike, so that the faces of a panorama agree. Where all that is shown would be more than memory
// holds, or than is to be drawn, the pixels grow until it is not. Files are unpacked whole, and of each what was chosen is kept.
#include "scene/streamed.h"
#include "base/base.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Boxes hold three standard deviations, and Gaussians are drawn somewhat beyond the picture's borders.
static const double BOX_DEVIATIONS = 3, MARGIN_SHARE = 0.15;

/// The fewest pixels that grow, the most that they grow to, and the steps by which they are found.
static const double MINIMUM_PX = 1e-3, MAXIMUM_PX = 1e6;
enum { GROWTH_STEPS = 32 };

/// How the Gaussians of an asset are coloured; all bytes of two are compared.
typedef struct paint {
    bool painted, by_number;
    char attribute[EWA_NAME_BYTES];
    ewa_color_scale scale;
    double tint[3];
} paint;

/// A level of a leaf, or the environment.
typedef struct streamed_slot {
    ewa_splats *splats; ///< NULL: it is not in memory
    ewa_left_part *left;
    ewa_splat_colors *colors;
    uint64_t last_frame;
} streamed_slot;

/// What of an asset is in memory.
typedef struct stream_cache {
    uint64_t serial; ///< of the asset
    const ewa_asset_stream *stream;
    streamed_slot *slots; ///< of each range, then of the environment
    uint32_t slot_count;
    paint paint;
    uint64_t last_frame;
} stream_cache;

/// A leaf before the camera.
typedef struct leaf_view {
    uint32_t cache, leaf; ///< leaf UINT32_MAX: the environment
    uint32_t item;        ///< of the scene
    double px_per_world;  ///< infinite: the eye is in it
} leaf_view;

/// A slot that is to be read, or that need not stay.
typedef struct slot_place {
    uint32_t cache, slot, file;
    uint64_t last_frame;
} slot_place;

static const ewa_streamed_leaf *leaf_at(const ewa_asset_stream *stream, uint32_t leaf) {
    return (const ewa_streamed_leaf *)stream->file.leaves.data + leaf;
}

static const ewa_streamed_range *range_at(const ewa_asset_stream *stream, uint32_t slot) {
    return (const ewa_streamed_range *)stream->file.ranges.data + slot;
}

static void drop_colors(stream_cache *cache) {
    for (uint32_t i = 0; i < cache->slot_count; i++) ewa_splat_colors_destroy(&cache->slots[i].colors);
}

static void drop_slot(ewa_streams *streams, streamed_slot *slot) {
    ewa_splats_info info;
    if (!slot->splats) return;
    ewa_splats_describe(slot->splats, &info);
    streams->bytes -= info.resident_bytes;
    ewa_splat_colors_destroy(&slot->colors);
    ewa_left_part_release(&slot->left);
    ewa_splats_destroy(&slot->splats);
}

static void free_cache(ewa_context *context, ewa_streams *streams, stream_cache *cache) {
    for (uint32_t i = 0; i < cache->slot_count; i++) drop_slot(streams, &cache->slots[i]);
    ewa_release(context, cache->slots, cache->slot_count, sizeof *cache->slots);
}

void ewa_streams_free(ewa_context *context, ewa_streams *streams) {
    for (uint32_t i = 0; i < streams->cache_count; i++) free_cache(context, streams, (stream_cache *)streams->caches.data + i);
    ewa_buffer *const buffers[] = {&streams->caches, &streams->views,  &streams->missing,
                                   &streams->unused, &streams->splats, &streams->colors};
    for (size_t b = 0; b < sizeof buffers / sizeof *buffers; b++) ewa_buffer_free(context, buffers[b]);
    *streams = (ewa_streams){.frame = 0};
}

/// The cache of an asset, made where there is none.
static ewa_status find_cache(ewa_context *context, ewa_streams *streams, const ewa_asset *asset, uint32_t *index) {
    stream_cache *caches = streams->caches.data;
    for (*index = 0; *index < streams->cache_count; ++*index)
        if (caches[*index].serial == asset->serial) return EWA_OK;
    EWA_TRY(ewa_buffer_grow(context, &streams->caches, streams->cache_count, streams->cache_count + (size_t)1, sizeof *caches));
    stream_cache *cache = (stream_cache *)streams->caches.data + *index;
    memset(cache, 0, sizeof *cache);
    cache->serial = asset->serial;
    cache->stream = asset->stream;
    cache->slot_count = asset->stream->file.range_count + 1;
    cache->slots = ewa_allocate_zeroed(context, cache->slot_count, sizeof *cache->slots);
    if (!cache->slots) return EWA_ERROR_MEMORY;
    streams->cache_count++;
    return EWA_OK;
}

/// Looks at a box; false: nothing of what it holds can be in the picture.
static bool view_box(const ewa_streamed_leaf *leaf, const ewa_camera *camera, double cutoff, double *px_per_world) {
    const double *m = camera->world_to_camera, grown = fmax(1, cutoff / BOX_DEVIATIONS);
    const double focal_px[2] = {camera->fx_px, camera->fy_px}, center_px[2] = {camera->cx_px, camera->cy_px};
    const double size_px[2] = {camera->width_px, camera->height_px};
    const bool perspective = camera->projection == EWA_PERSPECTIVE;
    *px_per_world = fmax(focal_px[0], focal_px[1]);
    if (!isfinite(leaf->low_world[0])) {
        *px_per_world = perspective ? INFINITY : *px_per_world;
        return true;
    }
    double at[3], half[3], eye[3], distance2 = 0;
    for (int r = 0; r < 3; r++) {
        at[r] = m[4 * r + 3], half[r] = 0, eye[r] = 0;
        for (int k = 0; k < 3; k++) {
            at[r] += m[4 * r + k] * (leaf->low_world[k] + leaf->high_world[k]) / 2;
            half[r] += fabs(m[4 * r + k]) * (leaf->high_world[k] - leaf->low_world[k]) / 2 * grown;
            eye[r] -= m[4 * k + r] * m[4 * k + 3];
        }
        const double outside = fmax(fmax(leaf->low_world[r] - eye[r], eye[r] - leaf->high_world[r]), 0);
        distance2 += outside * outside;
    }
    if (perspective) *px_per_world = distance2 > 0 ? *px_per_world / sqrt(distance2) : INFINITY;
    const double near_z = at[2] - half[2], far_z = at[2] + half[2];
    if (far_z <= 0) return false;
    for (int k = 0; k < 2 && (near_z > 0 || !perspective); k++) {
        const double low = at[k] - half[k], high = at[k] + half[k], margin_px = MARGIN_SHARE * size_px[k];
        const double low_z = low < 0 ? near_z : far_z, high_z = high < 0 ? far_z : near_z;
        if (focal_px[k] * (perspective ? low / low_z : low) + center_px[k] > size_px[k] + margin_px) return false;
        if (focal_px[k] * (perspective ? high / high_z : high) + center_px[k] < -margin_px) return false;
    }
    return true;
}

/// The slot of a leaf's level that is within `merge_px`; UINT32_MAX: the environment has but one.
static uint32_t choose_slot(const stream_cache *cache, const leaf_view *view, double merge_px) {
    const ewa_asset_stream *stream = cache->stream;
    if (view->leaf == UINT32_MAX) return stream->file.range_count;
    const ewa_streamed_leaf *leaf = leaf_at(stream, view->leaf);
    uint32_t slot = leaf->first + leaf->count - 1;
    while (slot > leaf->first && !(stream->spacing_world[slot] * view->px_per_world <= merge_px)) slot--;
    return slot;
}

/// The views of what the camera shows, in the order of the scene and of the leaves.
static ewa_status list_views(const ewa_scene *scene, ewa_scene_renderer *renderer, const ewa_camera *camera, double cutoff,
                             uint32_t *count) {
    ewa_streams *streams = &renderer->streams;
    ewa_context *context = renderer->context;
    *count = 0;
    for (uint32_t i = 0; i < scene->count; i++) {
        const ewa_asset *asset = scene->items[i].asset;
        uint32_t cache;
        if (!scene->items[i].instance.visible || !asset->stream) continue;
        EWA_TRY(find_cache(context, streams, asset, &cache));
        ((stream_cache *)streams->caches.data)[cache].last_frame = streams->frame;
        const uint32_t leaves = asset->stream->file.leaf_count;
        EWA_TRY(ewa_buffer_grow(context, &streams->views, *count, *count + leaves + (size_t)1, sizeof(leaf_view)));
        leaf_view *views = streams->views.data;
        for (uint32_t k = 0; k < leaves; k++) {
            leaf_view view = {.cache = cache, .leaf = k, .item = i};
            if (view_box(leaf_at(asset->stream, k), camera, cutoff, &view.px_per_world)) views[(*count)++] = view;
        }
        if (asset->stream->file.environment) views[(*count)++] = (leaf_view){.cache = cache, .leaf = UINT32_MAX, .item = i};
    }
    return EWA_OK;
}

/// Whether what is within `merge_px` fits in memory, and is no more than is to be drawn.
static bool fits(const ewa_streams *streams, uint32_t count, double merge_px, const ewa_lod_options *options) {
    const stream_cache *caches = streams->caches.data;
    const leaf_view *views = streams->views.data;
    uint64_t bytes = 0, splats = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (views[i].leaf == UINT32_MAX) continue;
        const stream_cache *cache = &caches[views[i].cache];
        const uint64_t own = range_at(cache->stream, choose_slot(cache, &views[i], merge_px))->count;
        splats += own;
        bytes += own * cache->stream->bytes_each;
    }
    return bytes <= options->memory_bytes && (!options->max_splats || splats <= options->max_splats);
}

/// The pixels, no fewer than are asked for, within which what is drawn fits.
static double settle(const ewa_streams *streams, uint32_t count, double merge_px, const ewa_lod_options *options) {
    if (fits(streams, count, merge_px, options)) return merge_px;
    double low = fmax(merge_px, MINIMUM_PX), high = MAXIMUM_PX;
    for (int step = 0; step < GROWTH_STEPS; step++) {
        const double middle = sqrt(low * high);
        *(fits(streams, count, middle, options) ? &high : &low) = middle;
    }
    return high;
}

static int compare_files(const void *a, const void *b) {
    const slot_place *x = a, *y = b;
    if (x->cache != y->cache) return x->cache < y->cache ? -1 : 1;
    if (x->file != y->file) return x->file < y->file ? -1 : 1;
    return x->slot < y->slot ? -1 : x->slot > y->slot;
}

static int compare_ages(const void *a, const void *b) {
    const slot_place *x = a, *y = b;
    if (x->last_frame != y->last_frame) return x->last_frame < y->last_frame ? -1 : 1;
    return compare_files(a, b);
}

/// Frees what was not used for the longest time, until `wanted_bytes` more fit.
static ewa_status make_room(ewa_context *context, ewa_streams *streams, uint64_t wanted_bytes, uint64_t memory_bytes) {
    stream_cache *caches = streams->caches.data;
    uint32_t count = 0;
    if (streams->bytes + wanted_bytes <= memory_bytes) return EWA_OK;
    for (uint32_t c = 0; c < streams->cache_count; c++)
        for (uint32_t i = 0; i < caches[c].slot_count; i++) {
            const streamed_slot *slot = &caches[c].slots[i];
            if (!slot->splats || slot->last_frame == streams->frame) continue;
            EWA_TRY(ewa_buffer_grow(context, &streams->unused, count, count + (size_t)1, sizeof(slot_place)));
            ((slot_place *)streams->unused.data)[count++] = (slot_place){.cache = c, .slot = i, .last_frame = slot->last_frame};
        }
    slot_place *unused = streams->unused.data;
    if (count) qsort(unused, count, sizeof *unused, compare_ages);
    for (uint32_t i = 0; i < count && streams->bytes + wanted_bytes > memory_bytes; i++)
        drop_slot(streams, &caches[unused[i].cache].slots[unused[i].slot]);
    return EWA_OK;
}

/// Makes a range of what a file has resident.
static ewa_status put_slot(ewa_context *context, ewa_streams *streams, const ewa_asset *asset, const ewa_gaussians *file,
                           const slot_place *place) {
    const ewa_asset_stream *stream = asset->stream;
    const bool environment = place->slot == stream->file.range_count;
    const ewa_streamed_range whole = {.count = file->count}, *range = environment ? &whole : range_at(stream, place->slot);
    streamed_slot *slot = (((stream_cache *)streams->caches.data)[place->cache]).slots + place->slot;
    ewa_gaussians set;
    size_t at = 0;
    if (!environment) EWA_TRY(ewa_streamed_check(context, &stream->file, range, file->count));
    EWA_TRY(ewa_gaussians_create(context, range->count, file->sh_degree, &set));
    set.flat = file->flat, set.antialiased = file->antialiased;
    memcpy(set.origin, file->origin, sizeof set.origin);
    ewa_streamed_copy(file, range->offset, range->count, &set, &at);
    ewa_status status = ewa_asset_is_moved(asset) ? ewa_gaussians_transform(&set, asset->to_world) : EWA_OK;
    if (status == EWA_OK) status = ewa_splats_create(&set, false, &slot->splats);
    ewa_gaussians_free(&set);
    EWA_TRY(status);
    ewa_splats_info info;
    ewa_splats_describe(slot->splats, &info);
    streams->bytes += info.resident_bytes;
    return EWA_OK;
}

static const ewa_asset *asset_of(const ewa_scene *scene, uint64_t serial) {
    uint32_t i = 0;
    while (scene->items[i].asset->serial != serial) i++;
    return scene->items[i].asset;
}

/// Reads what is missing, a file after the other, until `end_s` where that is not 0; at least one.
static ewa_status read_missing(const ewa_scene *scene, ewa_context *context, ewa_streams *streams, uint32_t count, double end_s,
                               ewa_lod_stats *stats) {
    slot_place *missing = streams->missing.data;
    const stream_cache *caches = streams->caches.data;
    if (count) qsort(missing, count, sizeof *missing, compare_files);
    for (uint32_t first = 0, end; first < count; first = end) {
        const ewa_asset *asset = asset_of(scene, caches[missing[first].cache].serial);
        ewa_gaussians file;
        for (end = first; end < count && missing[end].cache == missing[first].cache && missing[end].file == missing[first].file;) end++;
        if (first && end_s > 0 && ewa_now_s() > end_s) {
            stats->missing_count += count - first;
            break;
        }
        EWA_TRY(ewa_streamed_read_file(context, &asset->stream->file, missing[first].file, &file));
        ewa_status status = EWA_OK;
        for (uint32_t i = first; i < end && status == EWA_OK; i++) status = put_slot(context, streams, asset, &file, &missing[i]);
        ewa_gaussians_free(&file);
        EWA_TRY(status);
        stats->loaded_count += end - first;
    }
    return EWA_OK;
}

/// Lists a slot to be read, unless it is in memory.
static ewa_status want(ewa_context *context, ewa_streams *streams, uint32_t cache, uint32_t slot, uint32_t *count, uint64_t *bytes) {
    stream_cache *own = (stream_cache *)streams->caches.data + cache;
    const bool used = own->slots[slot].last_frame == streams->frame; // by another instance of the asset
    const bool environment = slot == own->stream->file.range_count;
    own->slots[slot].last_frame = streams->frame;
    if (used || own->slots[slot].splats) return EWA_OK;
    const slot_place place = {.cache = cache, .slot = slot, .file = environment ? own->stream->file.file_count - 1 : range_at(own->stream, slot)->file};
    EWA_TRY(ewa_buffer_grow(context, &streams->missing, *count, *count + (size_t)1, sizeof place));
    ((slot_place *)streams->missing.data)[(*count)++] = place;
    *bytes += environment ? 0 : range_at(own->stream, slot)->count * own->stream->bytes_each;
    return EWA_OK;
}

/// The slot of a leaf that is drawn: what is wanted, or what is nearest to it in memory; UINT32_MAX: none is.
static uint32_t find_slot(const stream_cache *cache, const leaf_view *view, uint32_t wanted) {
    if (cache->slots[wanted].splats || view->leaf == UINT32_MAX) return cache->slots[wanted].splats ? wanted : UINT32_MAX;
    const ewa_streamed_leaf *leaf = leaf_at(cache->stream, view->leaf);
    for (uint32_t slot = wanted; slot < leaf->first + leaf->count; slot++)
        if (cache->slots[slot].splats) return slot;
    for (uint32_t slot = wanted; slot-- > leaf->first;)
        if (cache->slots[slot].splats) return slot;
    return UINT32_MAX;
}

/// Reads what a picture needs; with a limit of time the coarsest of leaves of which nothing is in memory first.
static ewa_status read_all(const ewa_scene *scene, ewa_scene_renderer *renderer, uint32_t count, double merge_px,
                           const ewa_lod_options *options, ewa_lod_stats *stats) {
    ewa_streams *streams = &renderer->streams;
    ewa_context *context = renderer->context;
    const double start_s = ewa_now_s();
    for (int pass = options->load_s > 0 ? 0 : 1; pass < 2; pass++) {
        uint32_t missing = 0;
        uint64_t bytes = 0;
        const leaf_view *views = streams->views.data;
        for (uint32_t i = 0; i < count; i++) {
            const stream_cache *cache = (const stream_cache *)streams->caches.data + views[i].cache;
            const uint32_t wanted = choose_slot(cache, &views[i], merge_px);
            if (pass == 1)
                EWA_TRY(want(context, streams, views[i].cache, wanted, &missing, &bytes));
            else if (find_slot(cache, &views[i], wanted) == UINT32_MAX)
                EWA_TRY(want(context, streams, views[i].cache, choose_slot(cache, &views[i], INFINITY), &missing, &bytes));
        }
        EWA_TRY(make_room(context, streams, bytes, options->memory_bytes));
        EWA_TRY(read_missing(scene, context, streams, missing, pass == 1 && options->load_s > 0 ? start_s + options->load_s : 0, stats));
    }
    stats->load_s += ewa_now_s() - start_s;
    return EWA_OK;
}

/// Paints a slot, and leaves of it what regions do.
static ewa_status paint_slot(ewa_context *context, const ewa_scene *scene, const stream_cache *cache, streamed_slot *slot) {
    if (!ewa_left_part_is_of(slot->left, &scene->options)) {
        ewa_left_part_release(&slot->left);
        if (scene->options.region_count) EWA_TRY(ewa_left_part_make(context, &scene->options, slot->splats, NULL, &slot->left));
    }
    if (!cache->paint.painted || slot->colors) return EWA_OK;
    ewa_cloud *cloud = NULL;
    ewa_status status = ewa_splats_to_cloud(slot->splats, false, &cloud);
    if (status == EWA_OK && cache->paint.by_number) {
        ewa_scalar scalar;
        uint64_t grey_count = 0; // the coarsest level's have been told
        status = ewa_cloud_find_scalar(cloud, cache->paint.attribute, &scalar);
        if (status == EWA_OK) status = ewa_cloud_color_by(cloud, &scalar, &cache->paint.scale, &grey_count);
    } else if (status == EWA_OK) {
        status = ewa_cloud_tint(cloud, cache->paint.tint);
    }
    if (status == EWA_OK) status = ewa_splat_colors_create(slot->splats, cloud, NULL, &slot->colors);
    ewa_cloud_destroy(&cloud);
    return status;
}

/// Takes how an item is coloured, for all that is in memory of its asset.
static void take_paint(const ewa_scene *scene, const ewa_scene_item *item, stream_cache *cache) {
    paint own;
    memset(&own, 0, sizeof own);
    own.painted = ewa_surface_splat_colors(scene->surface, item->asset);
    const ewa_legend *legend = own.painted ? ewa_surface_legend(scene->surface, item->asset) : NULL;
    if (legend) {
        const ewa_color_scale scale = ewa_color_scale_of(legend);
        own.by_number = true;
        memcpy(own.attribute, legend->attribute, sizeof own.attribute);
        own.scale.colormap = scale.colormap;
        own.scale.classes = scale.classes;
        memcpy(own.scale.range, scale.range, sizeof scale.range);
    } else if (own.painted) {
        memcpy(own.tint, item->instance.coloring.tint, sizeof own.tint);
    }
    if (memcmp(&own, &cache->paint, sizeof own) == 0) return;
    drop_colors(cache);
    memcpy(&cache->paint, &own, sizeof own);
}

/// Lists what is drawn, in the place of the coarsest levels.
static ewa_status list_drawn(const ewa_scene *scene, ewa_scene_renderer *renderer, uint32_t count, double merge_px,
                             ewa_scene_shown *shown, ewa_lod_stats *stats) {
    ewa_streams *streams = &renderer->streams;
    ewa_context *context = renderer->context;
    const leaf_view *views = streams->views.data;
    EWA_TRY(ewa_buffer_reserve(context, &streams->splats, shown->splats_count + (size_t)count, sizeof *shown->splats));
    EWA_TRY(ewa_buffer_reserve(context, &streams->colors, shown->splats_count + (size_t)count, sizeof *shown->splat_colors));
    const ewa_splats **splats = streams->splats.data;
    const ewa_splat_colors **colors = streams->colors.data;
    uint32_t drawn = 0, at = 0, view = 0;
    for (uint32_t i = 0; i < scene->count; i++) {
        const ewa_scene_item *item = &scene->items[i];
        if (!item->instance.visible || !item->asset->splats) continue;
        const uint32_t own = at++;
        if (!item->asset->stream) {
            splats[drawn] = shown->splats[own], colors[drawn++] = shown->splat_colors[own];
            continue;
        }
        uint32_t index;
        EWA_TRY(find_cache(context, streams, item->asset, &index));
        stream_cache *cache = (stream_cache *)streams->caches.data + index;
        take_paint(scene, item, cache);
        for (; view < count && views[view].item == i; view++) {
            const uint32_t slot = find_slot(cache, &views[view], choose_slot(cache, &views[view], merge_px));
            if (slot == UINT32_MAX) continue;
            EWA_TRY(paint_slot(context, scene, cache, &cache->slots[slot]));
            cache->slots[slot].last_frame = streams->frame;
            splats[drawn] = cache->slots[slot].left ? cache->slots[slot].left->splats : cache->slots[slot].splats;
            colors[drawn++] = cache->slots[slot].colors;
            stats->node_count++;
        }
    }
    shown->splats = splats, shown->splat_colors = colors, shown->splats_count = drawn;
    return EWA_OK;
}

ewa_status ewa_streams_choose(const ewa_scene *scene, ewa_scene_renderer *renderer, const ewa_camera *camera,
                              const ewa_scene_options *options, ewa_scene_shown *shown, ewa_lod_stats *stats) {
    ewa_streams *streams = &renderer->streams;
    uint32_t count;
    streams->frame++;
    EWA_TRY(list_views(scene, renderer, camera, options->gaussians.cutoff, &count));
    for (uint32_t i = streams->cache_count; i-- > 0;) {
        stream_cache *caches = streams->caches.data;
        if (caches[i].last_frame == streams->frame) continue;
        free_cache(renderer->context, streams, &caches[i]);
        memmove(&caches[i], &caches[i + 1], (--streams->cache_count - i) * sizeof *caches);
        leaf_view *views = streams->views.data;
        for (uint32_t v = 0; v < count; v++) views[v].cache -= views[v].cache > i;
    }
    const double merge_px = settle(streams, count, options->gaussians.merge_px, &options->lod);
    if (merge_px > options->gaussians.merge_px && !streams->told) {
        streams->told = true;
        ewa_report(renderer->context, EWA_SEVERITY_NOTE,
                   "Gaussians in view are more than memory_bytes or max_splats allow: they are drawn within %.3g pixels of all, not %.3g",
                   merge_px, options->gaussians.merge_px);
    }
    EWA_TRY(read_all(scene, renderer, count, merge_px, &options->lod, stats));
    stats->resident_bytes += streams->bytes;
    return list_drawn(scene, renderer, count, merge_px, shown, stats);
}
