// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volumes: voxels of every kind of light, from far, from near and from inside.
#include "reference/volume.h"
#include "tests/probe/probe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void make_transfer(ewa_transfer *transfer, const ewa_volume_facts *facts, int k) {
    static const float colors[4][3] = {
        {0.9f, 0.2f, 0.1f}, {0.2f, 0.8f, 0.3f}, {0.3f, 0.3f, 0.9f}, {1, 1, 0.9f}};
    memset(transfer, 0, sizeof *transfer);
    transfer->point_count = 4;
    for (int i = 0; i < 4; i++) {
        ewa_transfer_point *point = &transfer->points[i];
        point->value = facts->low + (facts->high - facts->low) * (0.15 + 0.3 * i);
        memcpy(point->color, colors[i], sizeof point->color);
        point->extinction = i == 0 ? 0 : (float)(0.3 * i);
    }
    if (k % 3 == 1) transfer->unit_length_world = 2.5 * facts->spacing_world[0];
    if (k % 4 == 2)
        transfer->gradient_low = 0.2 * (facts->high - facts->low),
        transfer->gradient_high = 6 * transfer->gradient_low;
}

static void set_light(ewa_volume_options *options, int k) {
    options->shading = (ewa_shading)(k % 3);
    options->material.specular = 0.6f, options->material.shininess = 12;
    if (k % 2) return;
    options->light_count = 3;
    for (int i = 0; i < 3; i++) {
        ewa_light *light = &options->lights[i];
        ewa_light_init(light);
        light->direction_world[i] = 1, light->direction_world[(i + 1) % 3] = -0.4;
        for (int c = 0; c < 3; c++) light->color[c] = c == i ? 0.9f : 0.2f;
    }
}

/// The outermost places, which a camera frames.
static void put_outline(probe *to, const ewa_volume *volume, const ewa_transfer *transfer) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    probe_status(to, "outline", ewa_volume_outline(volume, transfer, 0.02, &cloud));
    probe_cloud(to, "outline", cloud);
}

static void put_pictures(probe *to, const ewa_volume *volume, const ewa_transfer *transfer, int k) {
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = NULL;
    OWNED(ewa_volume_renderer_destroy) ewa_volume_renderer *renderer = NULL;
    ewa_voxels_info info;
    memset(&info, 0, sizeof info);
    probe_status(to, "voxels", ewa_voxels_create(volume, transfer, NULL, &voxels));
    probe_status(to, "renderer", ewa_volume_renderer_create(to->context, &renderer));
    if (!voxels || !renderer) return;
    ewa_voxels_describe(voxels, &info);
    const double numbers[5] = {(double)info.occupied_count, (double)info.skipped_count, info.level_count,
                               info.spacing_world, info.bounds.low_world[1]};
    for (int i = 0; i < 5; i++) probe_number(to, "voxels info", numbers[i]);
    for (int view = 0; view < 5; view++) {
        ewa_camera camera = probe_view(&info.bounds, 1, 0.3 * k - 1, -0.5, view == 1);
        if (view == 2) camera.world_to_camera[11] += 14 * info.spacing_world; // far
        if (view >= 3) {                                                      // inside, wide
            const double middle[3] = {0.05, -0.1, 0.02}, ahead[3] = {0.4, 0.3, 0.1}, up[3] = {0, 0, 1};
            ewa_camera_set_fov(&camera, 100);
            ewa_camera_look_at(&camera, middle, ahead, up);
        }
        WITH_DEFAULTS(ewa_volume_options, options);
        options.method = (ewa_volume_method)((k + view) % 3);
        options.index = view == 3 ? EWA_INDEX_TABLE : EWA_INDEX_EXACT;
        options.level = view == 4;
        if (view == 2) options.point_threshold_px = 1.5;
        if (view == 0) options.depth_unit = 2, options.background[2] = 0.4f, options.background[3] = 0.7f;
        set_light(&options, k + view);
        OWNED(probe_frame_free) ewa_frame frame = probe_frame(&camera, false);
        OWNED(check_free) float *surface_depth = NULL, *surface_rgba = NULL;
        const size_t count = (size_t)camera.width_px * camera.height_px;
        if (view == 0 && k % 2) {
            surface_depth = calloc(count, sizeof *surface_depth),
            surface_rgba = calloc(4 * count, sizeof *surface_rgba);
            if (!surface_depth || !surface_rgba) abort();
            const double *row = &camera.world_to_camera[8];
            for (size_t i = 0; i < count; i++) {
                surface_depth[i] = i % 64 < 32 ? (float)(row[3] + 0.02) : (float)INFINITY;
                if (i % 64 < 32) surface_rgba[4 * i] = 0.5f, surface_rgba[4 * i + 3] = 1;
            }
            options.surface_depth = surface_depth, options.surface_rgba = surface_rgba;
        }
        probe_status(to, "volume", ewa_volume_render(renderer, voxels, &camera, &options, &frame, NULL));
        probe_frame_put(to, "volume", &camera, &frame);
        if (!to->brief && (k + view) % 3 == 0) {
            probe_status(to, "reference",
                         ewa_volume_render_reference(volume, transfer, &camera, &options, &frame));
            probe_frame_put(to, "volume by the reference", &camera, &frame);
        }
    }
}

void probe_volumes(probe *to) {
    OWNED(check_free) ewa_transfer *transfer = calloc(1, sizeof *transfer);
    if (!transfer) abort();
    for (int k = 0; k < 8; k++) {
        WITH_DEFAULTS(ewa_volume_generate_options, generate);
        generate.object = (ewa_volume_object)(k % 4);
        generate.dims[0] = 19, generate.dims[1] = 17, generate.dims[2] = k < 4 ? 18 : 11;
        generate.checks = 3;
        OWNED(ewa_volume_free) ewa_volume volume;
        ewa_volume_facts facts;
        if (ewa_volume_generate(to->context, &generate, &volume) != EWA_OK) abort();
        probe_status(to, "measure", ewa_volume_measure(&volume, &facts));
        if (k >= 4) { // a grid that is turned and sheared, of other spacings
            static const double grid[12] = {0.05, 0.01, 0, -0.5,  -0.008, 0.06,
                                            0.01, -0.5, 0, 0.004, 0.09,   -0.45};
            memcpy(volume.index_to_world, grid, sizeof grid);
            probe_status(to, "measure", ewa_volume_measure(&volume, &facts));
        }
        make_transfer(transfer, &facts, k);
        put_outline(to, &volume, transfer);
        put_pictures(to, &volume, transfer, k);
    }
}
