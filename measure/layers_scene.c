// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Transparent surfaces that cross, and what others do with them.
#include "measure/layers_scene.h"
#include "cloud/cloud.h"

#include "base/base.h"
#include "defaults.h"
#include "reference/contour.h"
#include "reference/splat.h"
#include "surface/options.h"

#include <stdlib.h>
#include <string.h>

enum { OBJECTS = 4 };

/// Gives an object a linear colour, lit from one direction on both sides.
static ewa_status paint(ewa_cloud *cloud, const double color[3]) {
    static const double light[3] = {0.48, 0.6, 0.64};
    ewa_cloud_remove(cloud, EWA_COLOR);
    uint8_t *rgb = NULL;
    const ewa_status status = ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, (void **)&rgb);
    if (status != EWA_OK) return status;
    const float *normal = ewa_cloud_find(cloud, EWA_NORMAL)->data;
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++, normal += 3, rgb += 3) {
        double facing = 0;
        for (int c = 0; c < 3; c++) facing += light[c] * (double)normal[c];
        for (int c = 0; c < 3; c++)
            rgb[c] =
                (uint8_t)(255 * (double)ewa_srgb_from_linear((float)(color[c] * (0.3 + 0.7 * fabs(facing)))) +
                          0.5);
    }
    return EWA_OK;
}

static ewa_status make_object(ewa_context *context, ewa_object object, uint64_t point_count,
                              double size_world, const double color[3], ewa_cloud **cloud) {
    WITH_DEFAULTS(ewa_generate_options, options);
    options.object = object;
    options.point_count = point_count;
    options.size_world = size_world;
    const ewa_status status = ewa_cloud_generate(context, &options, cloud);
    return status == EWA_OK ? paint(*cloud, color) : status;
}

ewa_status layers_crossing_make(ewa_context *context, uint64_t points_per_object, ewa_cloud **cloud) {
    static const double colors[OBJECTS][3] = {
        {0.85, 0.12, 0.08}, {0.1, 0.55, 0.12}, {0.1, 0.2, 0.85}, {0.9, 0.75, 0.15}};
    static const double turns[OBJECTS - 1][16] = {
        {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
        {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1},
        {0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 1},
    };
    ewa_cloud *parts[OBJECTS] = {NULL};
    ewa_status status = EWA_OK;
    for (int k = 0; k < OBJECTS - 1 && status == EWA_OK; k++) {
        status = make_object(context, EWA_OBJECT_TORUS, points_per_object, 2, colors[k], &parts[k]);
        // Painted where it will be, so that each torus has its own light.
        if (status == EWA_OK) status = ewa_cloud_transform(parts[k], turns[k]);
        if (status == EWA_OK) status = paint(parts[k], colors[k]);
    }
    if (status == EWA_OK)
        status = make_object(context, EWA_OBJECT_SPHERE, points_per_object, 1.2, colors[3], &parts[3]);
    if (status == EWA_OK) status = ewa_cloud_merge((const ewa_cloud *const *)parts, OBJECTS, cloud);
    for (int k = 0; k < OBJECTS; k++) ewa_cloud_destroy(&parts[k]);
    return status;
}

ewa_status layers_sphere_make(ewa_context *context, uint64_t point_count, ewa_cloud **cloud) {
    static const double color[3] = {0.1, 0.35, 0.75};
    return make_object(context, EWA_OBJECT_SPHERE, point_count, 2, color, cloud);
}

ewa_status layers_camera_make(const ewa_cloud *cloud, uint32_t side_px, ewa_camera *camera) {
    static const double ahead[3] = {-0.5, -0.62, -0.6}, up[3] = {0, 0, 1};
    ewa_bounds bounds;
    ewa_camera_init(camera);
    camera->width_px = camera->height_px = side_px;
    ewa_status status = ewa_cloud_measure(cloud, &bounds);
    if (status == EWA_OK) status = ewa_camera_set_fov(camera, 30);
    if (status == EWA_OK) status = ewa_camera_frame(camera, &bounds, ahead, up, 0);
    // The corners of the box are empty.
    camera->fx_px *= 1.65;
    camera->fy_px *= 1.65;
    return status;
}

ewa_status layers_shuffle(const ewa_cloud *cloud, ewa_cloud **shuffled) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    ewa_context *context = ewa_cloud_context(cloud);
    uint64_t *indices = ewa_allocate(context, count, sizeof *indices), state = 1;
    if (!indices) return EWA_ERROR_MEMORY;
    for (uint64_t i = 0; i < count; i++) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        const uint64_t other = (state >> 33) % (i + 1);
        indices[i] = indices[other];
        indices[other] = i;
    }
    const ewa_status status = ewa_cloud_select(cloud, indices, count, shuffled);
    ewa_release(context, indices, count, sizeof *indices);
    return status;
}

static int compare_depths(const void *a, const void *b) {
    const ewa_reference_splat *left = a, *right = b;
    return (left->center.z < right->center.z) - (left->center.z > right->center.z);
}

/// Reads and projects all splats that are drawn, far ones first; returns their number.
static uint64_t sort_splats(const ewa_surfel_reader *reader, const ewa_reference_view *view, uint64_t count,
                            ewa_reference_splat *splats) {
    uint64_t drawn = 0;
    for (uint64_t k = 0; k < count; k++) {
        ewa_surfel surfel;
        bool drawable;
        ewa_surfel_read(reader, k, 1, &surfel, &drawable);
        if (!drawable) continue;
        ewa_reference_project(view, &surfel, &splats[drawn]);
        drawn += splats[drawn].drawn;
    }
    qsort(splats, drawn, sizeof *splats, compare_depths);
    return drawn;
}

static void blend_splat(const ewa_reference_view *view, const ewa_reference_splat *splat, double opacity,
                        float *rgba) {
    const double color[4] = {splat->color.x, splat->color.y, splat->color.z, 1};
    for (int32_t y = splat->y_begin; y < splat->y_end; y++)
        for (int32_t x = splat->x_begin; x < splat->x_end; x++) {
            ewa_reference_sample sample;
            if (!ewa_reference_sample_at(view, splat, x + 0.5, y + 0.5, &sample) ||
                sample.distance2 >= view->cutoff * view->cutoff)
                continue;
            const double alpha = opacity * splat->opacity * exp(-0.5 * sample.distance2);
            float *pixel = rgba + 4 * ((size_t)y * (size_t)view->width_px + (size_t)x);
            for (int c = 0; c < 4; c++) pixel[c] += (float)(alpha * (color[c] - (double)pixel[c]));
        }
}

ewa_status layers_blend_splats(const ewa_cloud *cloud, const ewa_camera *camera, double opacity,
                               float *rgba) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    ewa_context *context = ewa_cloud_context(cloud);
    ewa_surfels_options surfels;
    ewa_render_options options;
    ewa_surfel_reader reader;
    ewa_status status = ewa_surfels_options_choose(context, NULL, &surfels);
    if (status == EWA_OK) status = ewa_render_options_choose(context, NULL, &options);
    if (status == EWA_OK) status = ewa_surfel_reader_open(cloud, &surfels, &reader);
    if (status != EWA_OK) return status;
    ewa_reference_splat *splats = ewa_allocate(context, count, sizeof *splats);
    if (!splats) return EWA_ERROR_MEMORY;
    ewa_reference_view view;
    ewa_reference_view_make(camera, surfels.cutoff, &options, &view);
    ewa_reference_view_contours(&options, true, &view);
    memset(rgba, 0, (size_t)camera->width_px * camera->height_px * 4 * sizeof *rgba);
    const uint64_t drawn = sort_splats(&reader, &view, count, splats);
    for (uint64_t k = 0; k < drawn; k++) blend_splat(&view, &splats[k], opacity, rgba);
    ewa_release(context, splats, count, sizeof *splats);
    return EWA_OK;
}

layers_alpha layers_measure_alpha(const float *rgba, uint32_t side_px) {
    const double middle = 0.5 * side_px, reach = 0.2 * side_px;
    layers_alpha found = {.minimum = 1};
    double count = 0, sum2 = 0;
    for (uint32_t y = 0; y < side_px; y++)
        for (uint32_t x = 0; x < side_px; x++) {
            if (hypot(x + 0.5 - middle, y + 0.5 - middle) > reach) continue;
            const double alpha = (double)rgba[4 * ((size_t)y * side_px + x) + 3], step = alpha - found.mean;
            found.mean += step / ++count;
            sum2 += step * (alpha - found.mean);
            found.minimum = fmin(found.minimum, alpha), found.maximum = fmax(found.maximum, alpha);
        }
    found.variance = sum2 / count;
    return found;
}
