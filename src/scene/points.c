// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The points of what a scene shows, as their files have them: to be written, or looked at further.
#include "scene/points.h"
#include "base/base.h"
#include "cloud/cloud.h"
#include "cloud/marks.h"
#include "scene/octree.h"

#include <math.h>
#include <string.h>

/// What the points of a cloud are held against.
typedef struct cut_view {
    const ewa_scene *scene;
    ewa_place_test *test;
    const void *user;
    const ewa_attribute *position;
    double origin_world[3];
} cut_view;

static void mark_block(const void *data, uint64_t first, uint32_t count, uint8_t *marks) {
    const cut_view *view = data;
    double block[EWA_MARK_BLOCK][3];
    ewa_attribute_read_f64(view->position, first, count, &block[0][0]);
    for (uint32_t i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++) block[i][c] += view->origin_world[c];
        if (!ewa_sections_keep(&view->scene->options.render, block[i]) ||
            (view->test && !view->test(view->user, block[i])))
            marks[i] = 0;
    }
}

/// Makes a cloud of the points that are taken. By a view of the scene's own context: that of the cloud, which loads other files
/// meanwhile, or that of an octree is another thread's.
static ewa_status cut(const cut_view *given, const ewa_cloud *cloud, ewa_cloud **piece) {
    const ewa_scene_options *options = &given->scene->options;
    ewa_context *context = given->scene->context;
    const uint64_t count = ewa_cloud_point_count(cloud);
    ewa_cloud *own = NULL;
    EWA_TRY(ewa_cloud_view(context, cloud, 0, count, &own));
    cut_view view = *given;
    view.position = ewa_marks_position(own);
    uint8_t *marks = view.position ? ewa_allocate(context, count, 1) : NULL;
    ewa_status status = !view.position ? EWA_ERROR_ARGUMENT : marks ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) {
        ewa_cloud_origin(own, view.origin_world);
        memset(marks, 1, count);
        ewa_mark_blocks(own, mark_block, &view, marks);
        status = ewa_regions_mark(options->regions, options->region_count, own, marks);
    }
    if (status == EWA_OK) status = ewa_cloud_keep(own, marks, piece);
    ewa_release(context, marks, count, 1);
    ewa_cloud_destroy(&own);
    return status;
}

ewa_status ewa_scene_cut_item(const ewa_scene *scene, const ewa_scene_item *item, const double low_world[3],
                              const double high_world[3], ewa_place_test *test, const void *user, ewa_cloud **piece) {
    const ewa_asset *asset = item->asset;
    ewa_cloud *read = NULL;
    ewa_status status = EWA_OK;
    *piece = NULL;
    if (asset->lod) {
        double low[3], high[3];
        for (int c = 0; c < 3; c++) {
            low[c] = fmax(low_world[c], asset->bounds.low_world[c]);
            high[c] = fmin(high_world[c], asset->bounds.high_world[c]);
            if (!(low[c] <= high[c])) return EWA_OK;
        }
        status = ewa_asset_read_octree(asset, low, high, &read);
    }
    const ewa_cloud *cloud = asset->lod ? read : asset->cloud;
    const cut_view view = {.scene = scene, .test = test, .user = user};
    if (status == EWA_OK && cloud) status = cut(&view, cloud, piece);
    ewa_cloud_destroy(&read);
    if (status != EWA_OK || (*piece && !ewa_cloud_point_count(*piece))) ewa_cloud_destroy(piece);
    return status;
}

/// Cuts all that is visible; `*count` pieces have points.
static ewa_status cut_all(const ewa_scene *scene, ewa_cloud **pieces, uint32_t *count) {
    static const double low[3] = {-INFINITY, -INFINITY, -INFINITY}, high[3] = {INFINITY, INFINITY, INFINITY};
    for (uint32_t i = 0; i < scene->count; i++) {
        if (!scene->items[i].instance.visible) continue;
        EWA_TRY(ewa_scene_cut_item(scene, &scene->items[i], low, high, NULL, NULL, &pieces[*count]));
        *count += pieces[*count] != NULL;
    }
    return EWA_OK;
}

ewa_status ewa_scene_points(ewa_scene *scene, ewa_cloud **cloud) {
    if (!cloud) return EWA_ERROR_ARGUMENT;
    *cloud = NULL;
    if (!scene) return EWA_ERROR_ARGUMENT;
    ewa_context *context = scene->context;
    if (scene->points_gone)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "the points of this scene are gone (keep_points)");
    ewa_cloud **pieces = ewa_allocate_zeroed(context, scene->count, sizeof(ewa_cloud *));
    if (!pieces) return EWA_ERROR_MEMORY;
    uint32_t count = 0;
    ewa_status status = cut_all(scene, pieces, &count);
    if (status == EWA_OK && count == 1) {
        *cloud = pieces[0];
        pieces[0] = NULL;
    } else if (status == EWA_OK) {
        status = count ? ewa_cloud_merge((const ewa_cloud *const *)pieces, count, cloud) : ewa_cloud_create(context, 0, cloud);
    }
    for (uint32_t i = 0; i < count; i++) ewa_cloud_destroy(&pieces[i]);
    ewa_release(context, pieces, scene->count, sizeof(ewa_cloud *));
    return status;
}
