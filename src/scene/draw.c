// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures of scenes: surfaces in one frame, what lets light through among them.
#include "scene/draw.h"
#include "base/base.h"
#include "base/options.h"
#include "gl/backends.h"
#include "scene/octree.h"
#include "scene/streamed.h"
#include "surface/eye_dome.h"
#include "surface/render.h"
#include "surface/packets.h"
#include "volume/backend.h"
#include "volume/gaussian_backend.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

ewa_status ewa_scene_renderer_create(ewa_context *context, ewa_backend_kind backend,
                                     const ewa_exchange *exchange, ewa_scene_renderer **made) {
    if (!context || !made) return EWA_ERROR_ARGUMENT;
    *made = NULL;
    if (exchange && backend != EWA_BACKEND_CPU)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "a frame of several ranks is drawn on processors");
    ewa_scene_renderer *renderer = ewa_allocate_zeroed(context, 1, sizeof *renderer);
    if (!renderer) return EWA_ERROR_MEMORY;
    renderer->context = context;
    if (exchange) renderer->exchange = *exchange;
    const ewa_status status = exchange ? ewa_renderer_create_joint(context, exchange, &renderer->surfaces)
                                       : ewa_renderer_create_on(context, backend, &renderer->surfaces);
    *made = renderer;
    if (status != EWA_OK) ewa_scene_renderer_destroy(made);
    return status;
}

static void free_planes(ewa_scene_renderer *renderer) {
    ewa_image_free(&renderer->rgba);
    ewa_image_free(&renderer->depth);
    ewa_image_free(&renderer->normal);
    ewa_image_free(&renderer->coverage);
    ewa_image_free(&renderer->lit_rgba);
    ewa_image_free(&renderer->lit_depth);
}

void ewa_scene_renderer_free_lists(ewa_scene_renderer *renderer) {
    ewa_context *context = renderer->context;
    ewa_buffer_free(context, &renderer->surfels);
    ewa_buffer_free(context, &renderer->lods);
    ewa_buffer_free(context, &renderer->splats);
    ewa_buffer_free(context, &renderer->splat_colors);
    ewa_buffer_free(context, &renderer->appearances);
    ewa_buffer_free(context, &renderer->appearance_list);
}

void ewa_scene_renderer_destroy(ewa_scene_renderer **given) {
    ewa_scene_renderer *renderer = given ? *given : NULL;
    if (!renderer) return;
    *given = NULL;
    ewa_context *context = renderer->context;
    ewa_gaussian_renderer_destroy(&renderer->gaussians);
    for (uint32_t i = 0; i < EWA_MAX_MIXED_VOLUMES; i++) ewa_volume_renderer_destroy(&renderer->volumes[i]);
    ewa_renderer_destroy(&renderer->surfaces); // whose device the others draw by
    free_planes(renderer);
    ewa_scene_renderer_free_lists(renderer);
    ewa_details_free(context, &renderer->details);
    ewa_streams_free(context, &renderer->streams);
    ewa_release(context, renderer, 1, sizeof *renderer);
}

ewa_renderer *ewa_scene_renderer_surfaces(ewa_scene_renderer *renderer) { return renderer->surfaces; }

ewa_status ewa_scene_renderer_describe(const ewa_scene_renderer *renderer, ewa_renderer_info *info) {
    if (!renderer || !info) return EWA_ERROR_ARGUMENT;
    ewa_renderer_info all = {.struct_size = sizeof all};
    EWA_TRY(ewa_renderer_describe(renderer->surfaces, info)); // which looks at its size
    EWA_TRY(ewa_renderer_describe(renderer->surfaces, &all));
    const char *remark = "";
    bool by_device = false;
    if (renderer->drew_gaussians) by_device = ewa_gaussian_renderer_describe(renderer->gaussians, &all, &remark);
    if (renderer->drew_volume) by_device = ewa_volume_renderer_describe(renderer->volumes[0], &all, &remark);
    if (renderer->drew_gaussians || renderer->drew_volume)
        snprintf(all.mixture, sizeof all.mixture, "%s", by_device ? ewa_backend_gl.name : ewa_backend_cpu.name);
    snprintf(all.mixture_remark, sizeof all.mixture_remark, "%s", remark);
    all.struct_size = info->struct_size;
    memcpy(info, &all, info->struct_size);
    return EWA_OK;
}

/// Says how the visible octrees are drawn, which are listed.
static ewa_status list_appearances(const ewa_scene *scene, const ewa_lod_options *options,
                             ewa_scene_renderer *renderer, ewa_scene_shown *shown) {
    EWA_TRY(ewa_buffer_reserve(renderer->context, &renderer->appearances, shown->lod_count + (size_t)1,
                               sizeof(ewa_octree_appearance)));
    EWA_TRY(ewa_buffer_reserve(renderer->context, &renderer->appearance_list, shown->lod_count + (size_t)1,
                               sizeof *shown->appearances));
    ewa_octree_appearance *appearances = renderer->appearances.data;
    shown->appearances = renderer->appearance_list.data;
    for (uint32_t i = 0, k = 0; i < scene->count; i++) {
        if (!scene->items[i].instance.visible || !scene->items[i].asset->lod) continue;
        EWA_TRY(ewa_scene_octree_appearance(scene, i, options, &appearances[k]));
        shown->appearances[k] = &appearances[k].appearance;
        k++;
    }
    return EWA_OK;
}

/// Whether an item of resident surfels or an octree has colours, of its own or given.
static bool has_colors(const ewa_scene *scene, uint32_t index) {
    const ewa_scene_item *item = &scene->items[index];
    if (item->asset->surfels) return item->asset->surfels->colored;
    return item->asset->lod && (item->instance.coloring.tinted || ewa_scene_legend(scene, index) ||
                                ewa_asset_has_colors(item->asset));
}

ewa_status ewa_scene_list_shown(const ewa_scene *scene, const ewa_lod_options *options, ewa_scene_renderer *renderer,
                                ewa_scene_shown *shown) {
    ewa_context *context = renderer->context;
    *shown = (ewa_scene_shown){.near_world = INFINITY};
    const size_t room = scene->count + (size_t)1;
    EWA_TRY(ewa_buffer_reserve(context, &renderer->surfels, room, sizeof(ewa_surfels *)));
    EWA_TRY(ewa_buffer_reserve(context, &renderer->lods, room, sizeof(ewa_lod *)));
    EWA_TRY(ewa_buffer_reserve(context, &renderer->splats, room, sizeof(ewa_splats *)));
    EWA_TRY(ewa_buffer_reserve(context, &renderer->splat_colors, room, sizeof(ewa_splat_colors *)));
    shown->surfels = renderer->surfels.data;
    shown->lods = renderer->lods.data;
    shown->splats = renderer->splats.data;
    shown->splat_colors = renderer->splat_colors.data;
    if (scene->surface && scene->surface->surfels) {
        shown->surfels[shown->surfels_count++] = scene->surface->surfels;
        shown->colored = scene->surface->colored;
        shown->photographed = scene->surface->photographed;
    }
    for (uint32_t i = 0; i < scene->count; i++) {
        const ewa_asset *asset = scene->items[i].asset;
        if (!scene->items[i].instance.visible) continue;
        shown->colored = shown->colored || has_colors(scene, i);
        shown->photographed = shown->photographed && !asset->surfels && !asset->lod;
        if (asset->surfels) shown->surfels[shown->surfels_count++] = asset->surfels;
        if (asset->lod) shown->lods[shown->lod_count++] = asset->lod;
        if (asset->splats) {
            shown->splat_colors[shown->splats_count] = ewa_surface_splat_colors(scene->surface, asset);
            shown->splats[shown->splats_count++] = ewa_item_splats(&scene->items[i]);
            shown->near_world = fmin(shown->near_world, asset->near_world);
            shown->streamed = shown->streamed || asset->stream;
        }
        if (!asset->voxels) continue;
        if (shown->volume_count == EWA_MAX_MIXED_VOLUMES)
            return ewa_fail(context, EWA_ERROR_LIMIT, "%s: a picture shows at most %d volumes", asset->name,
                            EWA_MAX_MIXED_VOLUMES);
        shown->voxels[shown->volume_count] = ewa_item_voxels(&scene->items[i]);
        shown->volumes[shown->volume_count++] = asset;
    }
    return list_appearances(scene, options, renderer, shown);
}

/// Towards the light of surfaces without colours, in camera space: from above left, not so far from the eye that half
/// of what is seen is dark.
static const double BARE_LIGHT_CAMERA[3] = {-0.5, -0.6, -1};

/// Lights surfaces without colours from above left of the eye, unless lights are given: their form is all there is to
/// see, and a headlight shows little of it. Colours keep the headlight, which leaves them as they are where they are
/// faced; those of photographs are lit already, where nothing else is seen that light has to show.
static void light_by_default(const ewa_scene_shown *shown, const ewa_camera *camera, ewa_render_options *render) {
    if (render->light_count || render->shading != EWA_SHADING_LAMBERT) return;
    if (shown->photographed) render->shading = EWA_SHADING_NONE;
    if (shown->colored) return;
    ewa_light_init(&render->lights[0]);
    render->light_count = 1;
    for (int c = 0; c < 3; c++)
        for (int row = 0; row < 3; row++)
            render->lights[0].direction_world[c] += camera->world_to_camera[4 * row + c] * BARE_LIGHT_CAMERA[row];
}

/// Draws all surfaces in one frame.
static ewa_status draw_surfaces(ewa_scene_renderer *renderer, const ewa_scene_shown *shown,
                                const ewa_camera *camera, const ewa_scene_options *options,
                                const ewa_render_options *render, const ewa_frame *frame,
                                ewa_scene_stats *stats) {
    ewa_lod_options lod = options->lod;
    if (renderer->exchange.swap) {
        lod.share = renderer->exchange.rank;
        lod.share_count = renderer->exchange.rank_count;
    }
    ewa_render_options lit = *render;
    light_by_default(shown, renderer->lit_from ? renderer->lit_from : camera, &lit);
    const ewa_lod_scene together = {shown->lods, shown->lod_count, shown->surfels_count,
                                    (const ewa_surfels *const *)shown->surfels};
    const ewa_status status = ewa_lod_scene_draw(&together, shown->appearances, renderer->surfaces, camera, &lit,
                                                 &lod, frame, &stats->lod);
    stats->render = stats->lod.render;
    if (renderer->level > stats->render.level) stats->render.level = renderer->level;
    return status;
}

/// Makes a plane of a picture's size.
static ewa_status make_plane(ewa_context *context, const ewa_camera *camera, uint32_t channels,
                             ewa_image *plane) {
    if (plane->width_px == camera->width_px && plane->height_px == camera->height_px) return EWA_OK;
    ewa_image_free(plane);
    return ewa_image_create(context, camera->width_px, camera->height_px, channels, plane);
}

/// Draws the surfaces to planes of their own, over nothing, for what lies among them.
static ewa_status draw_among(ewa_scene_renderer *renderer, const ewa_scene_shown *shown,
                             const ewa_camera *camera, const ewa_scene_options *options,
                             const ewa_frame *frame, ewa_gaussian_options *among, ewa_scene_stats *stats) {
    ewa_context *context = renderer->context;
    EWA_TRY(make_plane(context, camera, 4, &renderer->rgba));
    EWA_TRY(make_plane(context, camera, 1, &renderer->depth));
    EWA_TRY(make_plane(context, camera, 1, &renderer->coverage));
    if (frame->normal) EWA_TRY(make_plane(context, camera, 3, &renderer->normal));
    ewa_render_options over_nothing = options->render;
    memset(over_nothing.background, 0, sizeof over_nothing.background);
    over_nothing.eye_dome = 0; // of the whole picture, in the end
    const ewa_frame planes = {.rgba = renderer->rgba.pixels,
                              .depth = renderer->depth.pixels,
                              .normal = frame->normal ? renderer->normal.pixels : NULL,
                              .coverage = renderer->coverage.pixels};
    among->surface_rgba = planes.rgba;
    among->surface_depth = planes.depth;
    among->surface_normal = planes.normal;
    among->surface_coverage = planes.coverage;
    return draw_surfaces(renderer, shown, camera, options, &over_nothing, &planes, stats);
}

/// How a volume is drawn.
static ewa_volume_options volume_options(const ewa_scene_options *options, const ewa_asset *asset) {
    ewa_volume_options own = options->volumes;
    ewa_voxels_info info;
    ewa_voxels_describe(asset->voxels, &info);
    if (own.level >= info.level_count) own.level = info.level_count - 1;
    if (options->shade_volumes) own.shading = asset->flat ? EWA_SHADING_NONE : EWA_SHADING_PHONG;
    if (options->render.light_count) {
        own.light_count = options->render.light_count;
        memcpy(own.lights, options->render.lights, sizeof own.lights);
    }
    memcpy(own.background, options->render.background, sizeof own.background);
    memcpy(own.section_planes, options->render.section_planes, sizeof own.section_planes);
    own.section_count = options->render.section_count;
    return own;
}

static void add_volume_stats(const ewa_volume_stats *volume, ewa_scene_stats *stats) {
    ewa_render_stats *all = &stats->render;
    ewa_volume_stats *sum = &stats->volumes;
    all->splat_count += volume->voxel_count;
    all->culled_count += volume->culled_count;
    all->drawn_count += volume->splat_count + volume->point_count;
    sum->voxel_count += volume->voxel_count;
    sum->culled_count += volume->culled_count;
    sum->near_count += volume->near_count;
    sum->hidden_count += volume->hidden_count;
    sum->splat_count += volume->splat_count;
    sum->point_count += volume->point_count;
    sum->bin_s += volume->bin_s;
    sum->setup_s += volume->setup_s;
    sum->points_s += volume->points_s;
    sum->splats_s += volume->splats_s;
    sum->resolve_s += volume->resolve_s;
    sum->total_s += volume->total_s;
    if (sum->splat_count + sum->point_count)
        sum->point_share = (double)sum->point_count / (double)(sum->splat_count + sum->point_count);
}

static ewa_status make_gaussians(ewa_scene_renderer *renderer) {
    EWA_TRY(ewa_gaussian_renderer_create(renderer->context, &renderer->gaussians));
    return ewa_gl_gaussians_attach(renderer->context, renderer->surfaces, renderer->gaussians);
}

static ewa_status make_volume(ewa_scene_renderer *renderer, uint32_t index) {
    EWA_TRY(ewa_volume_renderer_create(renderer->context, &renderer->volumes[index]));
    return ewa_gl_volume_attach(renderer->context, renderer->surfaces, renderer->volumes[index]);
}

/// Draws what lets light through, among surfaces where there are some.
static ewa_status draw_mixture(ewa_scene_renderer *renderer, const ewa_scene_shown *shown,
                               const ewa_camera *camera, const ewa_scene_options *options,
                               const ewa_gaussian_options *among, const ewa_frame *frame,
                               ewa_scene_stats *stats) {
    ewa_volume_options volumes[EWA_MAX_MIXED_VOLUMES];
    ewa_volume_stats took[EWA_MAX_MIXED_VOLUMES];
    ewa_mixed_volume mixed[EWA_MAX_MIXED_VOLUMES];
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < shown->volume_count && status == EWA_OK; i++) {
        if (!renderer->volumes[i]) status = make_volume(renderer, i);
        volumes[i] = volume_options(options, shown->volumes[i]);
        mixed[i] = (ewa_mixed_volume){renderer->volumes[i], shown->voxels[i], &volumes[i], &took[i]};
    }
    EWA_TRY(status);
    if (shown->volume_count == 1 && !shown->splats_count && !among->surface_depth) {
        renderer->drew_volume = true;
        EWA_TRY(ewa_volume_render(renderer->volumes[0], shown->voxels[0], camera, &volumes[0], frame,
                                  &took[0]));
        add_volume_stats(&took[0], stats);
        return EWA_OK;
    }
    if (!renderer->gaussians) EWA_TRY(make_gaussians(renderer));
    const ewa_mixture mixture = {(const ewa_splats *const *)shown->splats, shown->splats_count,
                                 shown->volume_count, mixed};
    renderer->drew_gaussians = true;
    ewa_gaussian_stats drawn;
    EWA_TRY(ewa_mixture_draw(renderer->gaussians, &mixture, (const ewa_splat_colors *const *)shown->splat_colors, camera, among, frame, &drawn));
    stats->render.splat_count += drawn.splat_count;
    stats->render.culled_count += drawn.splat_count - drawn.visible_count;
    stats->render.drawn_count += drawn.visible_count;
    for (uint32_t i = 0; i < shown->volume_count; i++) add_volume_stats(&took[i], stats);
    return EWA_OK;
}

/// The options of what lets light through, of the scene and its picture.
static ewa_gaussian_options mixture_options(const ewa_scene_shown *shown, const ewa_scene_options *options) {
    ewa_gaussian_options among = options->gaussians;
    memcpy(among.background, options->render.background, sizeof among.background);
    memcpy(among.section_planes, options->render.section_planes, sizeof among.section_planes);
    among.section_count = options->render.section_count;
    if (among.near_world == 0 && shown->splats_count) among.near_world = shown->near_world;
    return among;
}

/// Draws what lets light through over nothing, and lights the whole picture by its depths.
static ewa_status draw_lit(ewa_scene_renderer *renderer, const ewa_scene_shown *shown,
                           const ewa_camera *camera, const ewa_scene_options *options,
                           const ewa_gaussian_options *among, const ewa_frame *frame,
                           ewa_scene_stats *stats) {
    EWA_TRY(make_plane(renderer->context, camera, 4, &renderer->lit_rgba));
    EWA_TRY(make_plane(renderer->context, camera, 1, &renderer->lit_depth));
    ewa_frame lit = *frame;
    lit.rgba8 = NULL;
    if (!lit.rgba) lit.rgba = renderer->lit_rgba.pixels;
    if (!lit.depth) lit.depth = renderer->lit_depth.pixels;
    ewa_gaussian_options over_nothing = *among;
    ewa_scene_options bare = *options;
    memset(over_nothing.background, 0, sizeof over_nothing.background);
    memset(bare.render.background, 0, sizeof bare.render.background);
    EWA_TRY(draw_mixture(renderer, shown, camera, &bare, &over_nothing, &lit, stats));
    lit.rgba8 = frame->rgba8;
    return ewa_eye_dome_apply(renderer->context, camera, options->render.eye_dome, options->render.background,
                              &lit);
}

/// The error of nodes is told where they cover, half a pixel between surfels; that of levels in memory over the whole picture.
/// By default it is 1/255.
static const double ERROR_OF_NODES = 3;

static ewa_status draw(ewa_scene *scene, ewa_scene_renderer *renderer, const ewa_camera *camera,
                       const ewa_scene_options *given, const ewa_frame *frame, ewa_scene_stats *stats) {
    ewa_scene_shown shown;
    ewa_scene_options own;
    const ewa_scene_options *options = given;
    EWA_TRY(ewa_scene_list_shown(scene, &given->lod, renderer, &shown));
    renderer->level = 0;
    renderer->drew_gaussians = renderer->drew_volume = false;
    double size_px = given->render.point_size_px;
    if (size_px == 0 && scene->surface && scene->surface->sparse && shown.surfels_count == 1 && !shown.lod_count)
        size_px = EWA_DOT_PX;
    if (renderer->finer > 0) size_px *= renderer->finer;
    // Of a panorama all faces are to be of one level, and of as many parts.
    const bool one_of_six = renderer->lit_from && !given->render.supersampling;
    if (size_px != given->render.point_size_px || one_of_six) {
        own = *given;
        own.render.point_size_px = size_px;
        if (one_of_six) own.render.supersampling = 1;
        options = &own;
    }
    if (options->many_frames && !renderer->lit_from)
        EWA_TRY(ewa_details_choose(renderer->context, &renderer->details, camera, &options->render, options->lod.error / ERROR_OF_NODES,
                                   shown.lod_count == 0, shown.surfels, shown.surfels_count, &renderer->level));
    const bool by_details = renderer->level > 0 && !shown.lod_count;
    ewa_renderer_set_parts_of(renderer->surfaces, by_details ? renderer->details.parts_of : NULL, by_details ? shown.surfels_count : 0);
    if (!shown.splats_count && !shown.volume_count)
        return draw_surfaces(renderer, &shown, camera, options, &options->render, frame, stats);
    ewa_gaussian_options among = mixture_options(&shown, options);
    const ewa_exchange *exchange = &renderer->exchange;
    if (shown.surfels_count || shown.lod_count)
        EWA_TRY(draw_among(renderer, &shown, camera, options, frame, &among, stats));
    const bool elsewhere =
        exchange->swap && exchange->picture_rank != EWA_ALL_RANKS && exchange->picture_rank != exchange->rank;
    if (elsewhere) return EWA_OK;
    if (shown.streamed) EWA_TRY(ewa_streams_choose(scene, renderer, camera, options, &shown, &stats->lod));
    return options->render.eye_dome > 0 && (frame->rgba || frame->rgba8)
               ? draw_lit(renderer, &shown, camera, options, &among, frame, stats)
               : draw_mixture(renderer, &shown, camera, options, &among, frame, stats);
}

ewa_status ewa_scene_draw(ewa_scene *scene, ewa_scene_renderer *renderer, const ewa_camera *camera,
                          const ewa_scene_options *options, const ewa_frame *frame, ewa_scene_stats *stats) {
    if (!scene || !renderer || !camera || !frame) return EWA_ERROR_ARGUMENT;
    const double started_s = ewa_now_s();
    ewa_status status = ewa_scene_make_resident(scene);
    ewa_scene_stats took = {.total_s = 0};
    if (status == EWA_OK)
        status = draw(scene, renderer, camera, options ? options : &scene->options, frame, &took);
    took.total_s = ewa_now_s() - started_s;
    took.render.total_s = took.total_s;
    if (stats) *stats = took;
    return status;
}
