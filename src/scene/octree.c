// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Octrees in scenes: what of them stands for the whole, and how they are moved, filtered and coloured node by node.
#include "scene/octree.h"
#include "base/base.h"
#include "cloud/cloud.h"
#include "ewa/homogeneous.h"
#include "ewa/prepare.h"
#include "math/box.h"
#include "scene/asset.h"

#include <math.h>
#include <string.h>

static bool is_box(const ewa_bounds *box) {
    bool fine = true;
    for (int c = 0; c < 3; c++)
        fine = fine && isfinite(box->low_world[c]) && isfinite(box->high_world[c]) &&
               box->low_world[c] <= box->high_world[c];
    return fine;
}

/// Reads some points that stand for the whole, filtered and moved as the asset's; all where a filter takes none of them.
static ewa_status make_outline(ewa_asset *asset) {
    EWA_TRY(ewa_lod_sample(asset->lod, EWA_OCTREE_SAMPLE_POINTS, &asset->outline));
    if (ewa_cloud_point_count(asset->outline) == 0)
        return ewa_fail(asset->context, EWA_ERROR_FORMAT, "the file has no points");
    if (asset->filter.term_count) {
        ewa_cloud *taken = NULL;
        ewa_status status = ewa_cloud_view(ewa_cloud_context(asset->outline), asset->outline, 0,
                                           ewa_cloud_point_count(asset->outline), &taken);
        if (status == EWA_OK)
            status = ewa_cloud_filter(ewa_cloud_context(asset->outline), &asset->filter, &taken);
        const uint64_t count = status == EWA_OK ? ewa_cloud_point_count(taken) : 0;
        // A view of all points would end with them.
        if (count && count < ewa_cloud_point_count(asset->outline)) {
            ewa_cloud_destroy(&asset->outline);
            asset->outline = taken;
            taken = NULL;
        }
        ewa_cloud_destroy(&taken);
        EWA_TRY(status);
    }
    ewa_asset_take_unit(asset, asset->outline);
    if (ewa_asset_is_moved(asset)) EWA_TRY(ewa_cloud_transform(asset->outline, asset->to_world));
    if (ewa_cloud_is_drawable(asset->outline)) return EWA_OK;
    ewa_estimate_options options;
    ewa_estimate_options_init(&options, sizeof options);
    return ewa_cloud_estimate(&asset->outline, &options);
}

ewa_status ewa_asset_take_octree(const ewa_asset_job *job, ewa_lod *lod) {
    ewa_asset *asset = job->asset;
    ewa_lod_info info;
    asset->kind = EWA_ASSET_OCTREE;
    asset->lod = lod;
    ewa_lod_describe(lod, &info);
    asset->count = info.point_count;
    if (!info.merged)
        ewa_report(
            asset->context, EWA_SEVERITY_NOTE,
            "its levels have points only, none that stand for others: what is far away is drawn by few of "
            "them; ewa_lod_build() makes better levels");
    EWA_TRY(make_outline(asset));
    asset->bounds = info.bounds;
    if (ewa_asset_is_moved(asset)) ewa_box_transform(asset->to_world, asset->bounds.low_world, asset->bounds.high_world);
    // Of a file whose header says no box, that of the sample.
    if (!is_box(&asset->bounds)) EWA_TRY(ewa_cloud_measure(asset->outline, &asset->bounds));
    asset->bounds.finite_count = info.point_count;
    return EWA_OK;
}

/// Has the nodes' points come with what a word means; `levels`: attributes of what represents them, which needs it, too; or NULL.
static ewa_status need(const ewa_scene *scene, const ewa_asset *asset, const char *word, const ewa_cloud *levels,
                       ewa_lod_appearance *appearance) {
    ewa_scalar scalar;
    EWA_TRY(ewa_cloud_find_scalar(asset->outline, word, &scalar));
    const char *name = scalar.attribute.name;
    if (levels && !ewa_cloud_find(levels, name))
        return ewa_fail(scene->context, EWA_ERROR_UNSUPPORTED,
                        "%s: what represents points at its levels has no %s, which is for whoever makes the octree to name (ewa lod "
                        "--attributes); with an error of 0 the points themselves are drawn, which have it",
                        asset->name, word);
    // A term has a name of EWA_NAME_BYTES at most, as a colouring: there is room for all.
    strcat(strcat(appearance->attributes, ","), name);
    return EWA_OK;
}

static ewa_status place(const void *user, ewa_cloud **cloud) {
    const ewa_octree_change *change = user;
    bool whole = true;
    for (uint32_t t = 0; t < change->filter.term_count; t++)
        whole = whole && ewa_cloud_has_scalar(*cloud, change->filter.terms[t].name);
    // What represents points that have not been read yet may lack it.
    if (whole) EWA_TRY(ewa_cloud_filter(ewa_cloud_context(*cloud), &change->filter, cloud));
    if (change->moved) EWA_TRY(ewa_cloud_transform(*cloud, change->to_world));
    return ewa_cloud_hide(ewa_cloud_context(*cloud), change->regions, change->region_count, cloud);
}

static ewa_status paint(const void *user, ewa_cloud **cloud) {
    const ewa_octree_change *change = user;
    if (change->attribute[0] && ewa_cloud_has_scalar(*cloud, change->attribute)) {
        ewa_scalar scalar;
        uint64_t grey_count = 0; // the sample's have been told
        EWA_TRY(ewa_cloud_find_scalar(*cloud, change->attribute, &scalar));
        EWA_TRY(ewa_cloud_color_by(*cloud, &scalar, &change->scale, &grey_count));
    } else if (change->tinted || change->attribute[0]) {
        EWA_TRY(ewa_cloud_tint(*cloud, change->tint));
    }
    return ewa_cloud_set_appearance(*cloud, change->opacity, change->material);
}

ewa_status ewa_asset_read_octree(const ewa_asset *asset, const double low_world[3], const double high_world[3],
                                 ewa_cloud **cloud) {
    ewa_bounds box;
    memcpy(box.low_world, low_world, sizeof box.low_world);
    memcpy(box.high_world, high_world, sizeof box.high_world);
    if (ewa_asset_is_moved(asset)) {
        ewa_mat4 map;
        double back[16];
        memcpy(map.m, asset->to_world, sizeof map.m);
        EWA_TRY(ewa_mat4_invert(&map, &map));
        memcpy(back, map.m, sizeof back);
        ewa_box_transform(back, box.low_world, box.high_world);
    }
    EWA_TRY(ewa_lod_read(asset->lod, box.low_world, box.high_world, 0, cloud));
    ewa_status status = ewa_cloud_filter(ewa_cloud_context(*cloud), &asset->filter, cloud);
    if (status == EWA_OK && ewa_asset_is_moved(asset)) status = ewa_cloud_transform(*cloud, asset->to_world);
    if (status != EWA_OK) ewa_cloud_destroy(cloud);
    return status;
}

ewa_status ewa_scene_octree_appearance(const ewa_scene *scene, uint32_t index, const ewa_lod_options *options,
                                 ewa_octree_appearance *shown) {
    const ewa_asset *asset = scene->items[index].asset;
    const ewa_instance *instance = &scene->items[index].instance;
    const ewa_coloring *coloring = &instance->coloring;
    const ewa_legend *legend = ewa_scene_legend(scene, index);
    ewa_octree_change *change = &shown->change;
    ewa_lod_appearance *appearance = &shown->appearance;
    ewa_lod_info info;
    // All bytes of both are compared, so that none must be left to chance.
    memset(shown, 0, sizeof *shown);
    ewa_lod_describe(asset->lod, &info);
    const ewa_cloud *levels = options->error > 0 ? info.represented : NULL;
    memcpy(&change->filter, &asset->filter, sizeof change->filter);
    memcpy(change->to_world, asset->to_world, sizeof change->to_world);
    change->moved = ewa_asset_is_moved(asset);
    change->opacity = instance->opacity;
    change->material = instance->material;
    for (int c = 0; c < 3; c++) change->tint[c] = 0.5;
    for (uint32_t t = 0; t < asset->filter.term_count; t++)
        EWA_TRY(need(scene, asset, asset->filter.terms[t].name, levels, appearance));
    const ewa_scene_options *own = &scene->options;
    if (ewa_regions_have_classes(own->regions, own->region_count) && ewa_cloud_find(asset->outline, "classification"))
        EWA_TRY(need(scene, asset, "classification", levels, appearance));
    change->region_count = own->region_count;
    memcpy(change->regions, own->regions, own->region_count * sizeof own->regions[0]);
    if (legend) {
        EWA_TRY(need(scene, asset, legend->attribute, levels, appearance));
        memcpy(change->attribute, legend->attribute, sizeof change->attribute);
        const ewa_color_scale scale = ewa_color_scale_of(legend);
        change->scale.colormap = scale.colormap;
        change->scale.classes = scale.classes;
        memcpy(change->scale.range, scale.range, sizeof scale.range);
    } else if (coloring->tinted) {
        change->tinted = true;
        memcpy(change->tint, coloring->tint, sizeof change->tint);
    }
    memcpy(appearance->to_world, asset->to_world, sizeof appearance->to_world);
    appearance->radius_scale = instance->radius_scale * scene->options.surfels.radius_scale;
    appearance->filtered = asset->filter.term_count > 0;
    appearance->place = place;
    appearance->paint = paint;
    appearance->user = change;
    appearance->user_bytes = sizeof *change;
    return EWA_OK;
}
