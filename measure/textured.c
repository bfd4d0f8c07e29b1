// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the table of docs/acquisition.md on textured meshes: PSNR of their points against the mesh, by
// filter and number of points. Arguments: mesh, picture ("" for the mesh's own), azimuth in degrees, and a
// folder for pictures, if any.
#include "measure/measure.h"
#include "quality/textured_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE_PX = 400, SAMPLES = 5 };

static const char *const filter_names[] = {"nearest", "ewa", "optimal"};
static const uint64_t point_counts[] = {10000, 30000, 100000};
static const double pixel_sigmas_px[] = {0.5, 1};

static void draw(ewa_context *context, const ewa_cloud *cloud, const ewa_camera *camera, ewa_image *picture) {
    WITH_DEFAULTS(ewa_render_options, options);
    options.shading = EWA_SHADING_NONE;
    ewa_surfels *surfels = NULL;
    ewa_renderer *renderer = NULL;
    check(ewa_surfels_create(cloud, NULL, &surfels));
    check(ewa_renderer_create(context, &renderer));
    check(ewa_image_create(context, SIDE_PX, SIDE_PX, 4, picture));
    const ewa_frame frame = {.rgba = picture->pixels};
    check(ewa_render(renderer, surfels, camera, &options, &frame, NULL));
    ewa_renderer_destroy(&renderer);
    ewa_surfels_destroy(&surfels);
}

static void save(const char *folder, const char *name, uint64_t count, const ewa_image *picture) {
    char path[1024];
    if (!folder) return;
    snprintf(path, sizeof path, "%s/%s_%llu.png", folder, name, (unsigned long long)count);
    check(ewa_image_save(picture, path, NULL));
}

/// A camera that sees the whole mesh.
static void frame_mesh(const ewa_mesh *mesh, double azimuth_deg, ewa_camera *camera) {
    ewa_bounds bounds = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 1};
    for (uint32_t i = 0; i < 3 * mesh->vertex_count; i++) {
        bounds.low_world[i % 3] = fmin(bounds.low_world[i % 3], mesh->positions[i]);
        bounds.high_world[i % 3] = fmax(bounds.high_world[i % 3], mesh->positions[i]);
    }
    double target[3], size = 0;
    for (int c = 0; c < 3; c++) {
        target[c] = 0.5 * (bounds.low_world[c] + bounds.high_world[c]);
        size = fmax(size, bounds.high_world[c] - bounds.low_world[c]);
    }
    const double angle = azimuth_deg * 0.017453292519943295, up[3] = {0, 1, 0};
    const double eye[3] = {target[0] + 2 * size * sin(angle), target[1] + 0.4 * size,
                           target[2] + 2 * size * cos(angle)};
    ewa_camera_init(camera);
    camera->width_px = camera->height_px = SIDE_PX;
    ewa_camera_set_fov(camera, 40);
    ewa_camera_look_at(camera, eye, target, up);
}

int main(int argument_count, char **arguments) {
    if (argument_count < 4) {
        fprintf(stderr, "usage: measure_textured MESH PICTURE|'' AZIMUTH [FOLDER]\n");
        return 2;
    }
    const char *folder = argument_count > 4 ? arguments[4] : NULL;
    ewa_context *context = make_context(0);
    ewa_mesh mesh;
    ewa_image picture = {0}, truth;
    check(ewa_mesh_load(context, arguments[1], &mesh));
    if (*arguments[2]) {
        check(ewa_image_load(context, arguments[2], &picture));
        check(ewa_mesh_set_picture(&mesh, &picture));
    }
    ewa_camera camera;
    frame_mesh(&mesh, atof(arguments[3]), &camera);
    check(textured_cast(&mesh, &camera, SAMPLES, false, &truth));
    save(folder, "mesh", 0, &truth);
    printf("| points | pixel sigma |");
    for (int f = 0; f <= EWA_TEXTURE_OPTIMAL; f++) printf(" %s |", filter_names[f]);
    printf("\n|---|---|---|---|---|\n");
    for (size_t n = 0; n < sizeof point_counts / sizeof point_counts[0]; n++)
        for (size_t s = 0; s < sizeof pixel_sigmas_px / sizeof pixel_sigmas_px[0]; s++) {
            printf("| %llu | %g |", (unsigned long long)point_counts[n], pixel_sigmas_px[s]);
            for (int f = 0; f <= EWA_TEXTURE_OPTIMAL; f++) {
                WITH_DEFAULTS(ewa_mesh_sample_options, options);
                options.point_count = point_counts[n];
                options.texture_filter = (ewa_texture_filter)f;
                options.pixel_sigma_px = pixel_sigmas_px[s];
                ewa_cloud *cloud = NULL;
                ewa_image drawn;
                check(ewa_mesh_sample(&mesh, &options, &cloud));
                draw(context, cloud, &camera, &drawn);
                printf(" %.2f |", textured_psnr(&truth, &drawn));
                if (pixel_sigmas_px[s] == 0.5) save(folder, filter_names[f], point_counts[n], &drawn);
                ewa_image_free(&drawn);
                ewa_cloud_destroy(&cloud);
            }
            printf("\n");
            fflush(stdout);
        }
    ewa_image_free(&truth);
    ewa_mesh_free(&mesh);
    ewa_context_destroy(&context);
    return 0;
}
