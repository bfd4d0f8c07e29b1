// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where all that is visible is: one cloud of places with radii, for whoever has to get it into a picture.
#include "base/base.h"
#include "cloud/cloud.h"
#include "scene/asset.h"
#include "surface/packets.h"

#include <math.h>
#include <string.h>

enum { CORNERS = 8, BLOCK = 256 };

/// Makes a cloud of `count` places, relative to no origin, and radii.
static ewa_status make_places(ewa_context *context, uint64_t count, ewa_cloud **cloud, double **positions,
                              float **radii) {
    void *data[2] = {NULL, NULL};
    ewa_status status = ewa_cloud_create(context, count, cloud);
    if (status == EWA_OK) status = ewa_cloud_add(*cloud, EWA_POSITION, EWA_F64, 3, &data[0]);
    if (status == EWA_OK) status = ewa_cloud_add(*cloud, EWA_RADIUS, EWA_F32, 1, &data[1]);
    *positions = data[0];
    *radii = data[1];
    if (status != EWA_OK) ewa_cloud_destroy(cloud);
    return status;
}

ewa_status ewa_asset_outline_surfels(ewa_context *context, const ewa_surfels *surfels, ewa_cloud **outline) {
    double *position;
    float *radius;
    EWA_TRY(make_places(context, surfels->count, outline, &position, &radius));
    uint32_t left = surfels->count;
    for (uint32_t p = 0; p < surfels->packet_count && left; p++) {
        const ewa_vec3 center = ewa_packet_center(surfels, p);
        for (uint32_t lane = 0; lane < EWA_PACKET_LANES && left; lane++) {
            if (!(surfels->packets[p].sigma[lane] > 0)) continue;
            ewa_packet_surfel s;
            ewa_packet_decode(surfels, p, lane, &s);
            const double at[3] = {center.x + s.offset.x, center.y + s.offset.y, center.z + s.offset.z};
            for (int c = 0; c < 3; c++) *position++ = at[c] * surfels->unit + surfels->origin_world[c];
            *radius++ = (float)(vec3_length(s.axis_u) * surfels->unit * surfels->cutoff);
            left--;
        }
    }
    return EWA_OK;
}

/// The larger axis of a point's ellipse.
static double axis_length(const ewa_attribute *u, const ewa_attribute *v, uint64_t point) {
    double a[3], b[3];
    ewa_attribute_read_f64(u, point, 1, a);
    ewa_attribute_read_f64(v, point, 1, b);
    return fmax(sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]), sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]));
}

/// Adds the places of a cloud, and its radii times a scale.
static void add_cloud(const ewa_cloud *cloud, double cutoff, double scale, double **position,
                      float **radius) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    const ewa_attribute *places = ewa_cloud_find(cloud, EWA_POSITION),
                        *radii = ewa_cloud_find(cloud, EWA_RADIUS), *u = ewa_cloud_find(cloud, EWA_TANGENT_U),
                        *v = ewa_cloud_find(cloud, EWA_TANGENT_V);
    double origin_world[3];
    ewa_cloud_origin(cloud, origin_world);
    ewa_attribute_read_f64(places, 0, count, *position);
    for (uint64_t i = 0; i < count; i++, *position += 3, (*radius)++) {
        double own = 0;
        if (u && v)
            own = cutoff * axis_length(u, v, i);
        else if (radii && radii->component_count == 1)
            ewa_attribute_read_f64(radii, i, 1, &own);
        for (int c = 0; c < 3; c++) (*position)[c] += origin_world[c];
        **radius = (float)(own * scale);
    }
}

/// What of an item has a place in the outline; NULL: its points are gone.
static ewa_cloud *places_of(const ewa_scene_item *item) {
    const ewa_asset *asset = item->asset;
    if (!ewa_asset_is_points(asset)) return asset->outline;
    return asset->drawable || !item->completed ? asset->cloud : item->completed->clouds[item->member];
}

/// Counts the places of all that is visible; `*only` gets the item that has them all, NULL: there are several or none.
static uint64_t count_places(const ewa_scene *scene, const ewa_scene_item **only, bool *gone) {
    uint64_t total = 0;
    uint32_t count = 0;
    *gone = false;
    for (uint32_t i = 0; i < scene->count; i++) {
        const ewa_scene_item *item = &scene->items[i];
        if (!item->instance.visible || !item->asset->count) continue;
        const ewa_cloud *places = places_of(item);
        *gone |= !places;
        const uint64_t own = places ? ewa_cloud_point_count(places) : 0;
        if (!own) continue;
        *only = item;
        count++;
        total += own;
    }
    if (count != 1) *only = NULL;
    return total;
}

/// A box about the origin, where there is nothing.
static ewa_status make_box(ewa_context *context, ewa_cloud **cloud) {
    double *position;
    float *radius;
    EWA_TRY(make_places(context, CORNERS, cloud, &position, &radius));
    for (int i = 0; i < CORNERS; i++) {
        *radius++ = 0;
        for (int c = 0; c < 3; c++) *position++ = i >> c & 1 ? 1 : -1;
    }
    return EWA_OK;
}

ewa_status ewa_scene_outline(ewa_scene *scene, ewa_cloud **outline, bool *made) {
    const ewa_scene_item *only = NULL;
    bool gone;
    const double cutoff = scene->options.surfels.cutoff, scale = scene->options.surfels.radius_scale;
    uint64_t total = count_places(scene, &only, &gone);
    ewa_cloud *cloud = NULL, *resident = NULL;
    *outline = NULL;
    *made = true;
    if (gone && scene->surface && scene->surface->surfels)
        EWA_TRY(ewa_asset_outline_surfels(scene->context, scene->surface->surfels, &resident));
    if (resident && !total) {
        *outline = resident;
        return EWA_OK;
    }
    // The framing reads radii and axes by itself, and as they are drawn where nothing scales them.
    const bool scaled = only && ewa_asset_is_changeable(only->asset);
    if (only && !resident && (!scaled || (scale == 1 && only->instance.radius_scale == 1))) {
        ewa_cloud *places = places_of(only);
        *made = ewa_cloud_context(places) != scene->context; // which is the one of this thread
        *outline = places;
        return *made ? ewa_cloud_view(scene->context, places, 0, ewa_cloud_point_count(places), outline)
                     : EWA_OK;
    }
    ewa_status status = EWA_OK;
    if (!total) {
        status = make_box(scene->context, &cloud);
        *outline = cloud;
        return status;
    }
    if (resident) total += ewa_cloud_point_count(resident);
    double *position;
    float *radius;
    status = make_places(scene->context, total, &cloud, &position, &radius);
    for (uint32_t i = 0; i < scene->count && status == EWA_OK; i++) {
        const ewa_scene_item *item = &scene->items[i];
        const ewa_cloud *places = item->instance.visible && item->asset->count ? places_of(item) : NULL;
        if (places)
            add_cloud(places, cutoff,
                      ewa_asset_is_changeable(item->asset) ? scale * item->instance.radius_scale : 1,
                      &position, &radius);
    }
    if (status == EWA_OK && resident) add_cloud(resident, cutoff, 1, &position, &radius);
    ewa_cloud_destroy(&resident);
    *outline = cloud;
    return status;
}
