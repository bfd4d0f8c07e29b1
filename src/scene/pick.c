// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What is seen at a place of the picture: a few pixels of its depth plane, and the point that is nearest in space.
#include "base/base.h"
#include "cloud/cloud.h"
#include "homogeneous/camera.h"
#include "scene/octree.h"

#include <math.h>
#include <string.h>

enum { BLOCK = 512, MAX_REACH_PX = 32, MAX_SIDE_PX = 2 * MAX_REACH_PX + 1 };

/// Finds the depth nearest to a pixel on the screen; +infinity: nothing is within reach.
static double nearest_depth(const float *depth, int side, int reach_px, int *away_x, int *away_y) {
    double found = INFINITY;
    int nearest = 2 * side * side;
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            const int dx = x - reach_px, dy = y - reach_px, away = dx * dx + dy * dy;
            if (away >= nearest || away > reach_px * reach_px || !isfinite(depth[y * side + x])) continue;
            nearest = away;
            found = (double)depth[y * side + x];
            *away_x = dx, *away_y = dy;
        }
    return found;
}

/// The place of the world that a pixel shows at a depth.
static void unproject(const ewa_camera *camera, double x_px, double y_px, double depth,
                      double place_world[3]) {
    const double *m = camera->world_to_camera;
    const double scale = camera->projection == EWA_PERSPECTIVE ? depth : 1;
    const double seen[3] = {(x_px - camera->cx_px) / camera->fx_px * scale - m[3],
                            (y_px - camera->cy_px) / camera->fy_px * scale - m[7], depth - m[11]};
    // The upper 3 x 3 is a rotation times a scale.
    const double scale2 = m[8] * m[8] + m[9] * m[9] + m[10] * m[10];
    for (int c = 0; c < 3; c++)
        place_world[c] = (m[c] * seen[0] + m[4 + c] * seen[1] + m[8 + c] * seen[2]) / scale2;
}

/// What a place is compared with.
typedef struct search {
    const ewa_render_options *render; ///< whose sections cut
    const ewa_scene_options *scene;   ///< whose regions hide
    const double *place_world;
    double best; ///< square of the distance of what was found, or within which to look
} search;

/// The point of a cloud that is nearest to the place, and nearer than what was found; false: there is none.
static bool find_in_cloud(search *s, const ewa_cloud *cloud, ewa_scene_hit *hit) {
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    const uint64_t count = ewa_cloud_point_count(cloud);
    double origin[3], block[BLOCK][3];
    bool found = false;
    ewa_cloud_origin(cloud, origin);
    for (uint64_t first = 0; first < count; first += BLOCK) {
        const uint64_t in_block = count - first < BLOCK ? count - first : BLOCK;
        ewa_attribute_read_f64(position, first, in_block, &block[0][0]);
        for (uint64_t k = 0; k < in_block; k++) {
            double p[3], away = 0;
            for (int c = 0; c < 3; c++) {
                p[c] = block[k][c] + origin[c];
                away += (p[c] - s->place_world[c]) * (p[c] - s->place_world[c]);
            }
            if (!(away < s->best) || !ewa_sections_keep(s->render, p) ||
                !ewa_regions_keep(s->scene->regions, s->scene->region_count, cloud, first + k, p))
                continue;
            s->best = away;
            found = true;
            hit->point = first + k;
            memcpy(hit->point_world, p, sizeof p);
        }
    }
    return found;
}

/// Looks among the points of an octree about the place; those that were read become the hit's, the nearest first.
static ewa_status find_in_octree(search *s, const ewa_asset *asset, double reach_world, ewa_scene_hit *hit,
                                 bool *found) {
    ewa_cloud *cloud = NULL;
    double low_world[3], high_world[3];
    for (int c = 0; c < 3; c++)
        low_world[c] = s->place_world[c] - reach_world, high_world[c] = s->place_world[c] + reach_world;
    ewa_status status = ewa_asset_read_octree(asset, low_world, high_world, &cloud);
    *found = status == EWA_OK && find_in_cloud(s, cloud, hit);
    if (*found) {
        ewa_cloud *nearest = NULL;
        status = ewa_cloud_select(cloud, &hit->point, 1, &nearest);
        ewa_cloud_destroy(&hit->points);
        hit->points = nearest;
        hit->point = 0;
    }
    ewa_cloud_destroy(&cloud);
    return status;
}

/// Finds the point that is nearest to the place.
static ewa_status find_point(const ewa_scene *scene, const ewa_render_options *render, double reach_world,
                             ewa_scene_hit *hit) {
    search s = {render, &scene->options, hit->place_world, reach_world * reach_world};
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < scene->count && status == EWA_OK; i++) {
        const ewa_asset *asset = scene->items[i].asset;
        if (!scene->items[i].instance.visible) continue;
        bool found = false;
        if (asset->cloud) {
            found = find_in_cloud(&s, asset->cloud, hit);
            if (found) ewa_cloud_destroy(&hit->points);
        } else if (asset->lod) {
            status = find_in_octree(&s, asset, reach_world, hit, &found);
        }
        if (!found) continue;
        hit->has_point = true;
        hit->instance = i;
    }
    return status;
}

ewa_status ewa_scene_pick(ewa_scene *scene, ewa_scene_renderer *renderer, const ewa_camera *camera,
                          const ewa_scene_options *given, double x_px, double y_px, double reach_px,
                          double reach_world, ewa_scene_hit *hit) {
    if (!scene || !renderer || !camera || !hit) return EWA_ERROR_ARGUMENT;
    *hit = (ewa_scene_hit){.depth = INFINITY};
    if (!(reach_px >= 0) || !(reach_world >= 0) || !isfinite(x_px) || !isfinite(y_px))
        return ewa_fail(scene->context, EWA_ERROR_ARGUMENT,
                        "pick: at %g, %g within %g pixels and %g of the world", x_px, y_px, reach_px,
                        reach_world);
    const int reach = (int)fmin(reach_px, MAX_REACH_PX), side = 2 * reach + 1;
    if (x_px < -reach || y_px < -reach || x_px >= camera->width_px + reach ||
        y_px >= camera->height_px + reach)
        return EWA_OK;
    const int middle_x = (int)floor(x_px), middle_y = (int)floor(y_px);
    float depth[MAX_SIDE_PX * MAX_SIDE_PX];
    ewa_scene_options options = given ? *given : scene->options;
    options.render.shading = EWA_SHADING_NONE;
    options.render.eye_dome = 0;
    if (!options.render.supersampling) options.render.supersampling = 1; // a window does not know the picture's surfels
    ewa_camera window = *camera;
    window.cx_px -= middle_x - reach, window.cy_px -= middle_y - reach;
    window.width_px = window.height_px = (uint32_t)side;
    EWA_TRY(ewa_scene_draw(scene, renderer, &window, &options, &(ewa_frame){.depth = depth}, NULL));
    int dx = 0, dy = 0;
    hit->depth = nearest_depth(depth, side, reach, &dx, &dy);
    if (!isfinite(hit->depth)) return EWA_OK;
    hit->hit = true;
    const bool there = dx == 0 && dy == 0;
    unproject(camera, there ? x_px : middle_x + dx + 0.5, there ? y_px : middle_y + dy + 0.5, hit->depth,
              hit->place_world);
    ewa_status status = reach_world > 0 ? find_point(scene, &options.render, reach_world, hit) : EWA_OK;
    if (status != EWA_OK) ewa_cloud_destroy(&hit->points);
    return status;
}
