// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scenes of a known amount of work, and the statistics of repeated measurements.
//
// Based on: Zwicker et al., "Surface Splatting", 2001, section 3: a disc of deviation s and unit normal n has
// the covariance s^2 J (I - n n') J' on the screen, J the projection's Jacobian at its centre.
#include "bench_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLES = 4096 };

/// Room around the object; its outermost discs stay in the picture.
static const double MARGIN = 0.01;

/// Screen covariance of a disc of deviation 1: xx, xy, yy in squared pixels.
typedef struct footprint {
    double xx, xy, yy;
} footprint;

/// Widens the square to the shape of the picture.
static void stretch(ewa_cloud *cloud, float aspect) {
    float *position = ewa_cloud_find(cloud, EWA_POSITION)->data;
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) position[3 * i] *= aspect;
}

ewa_cloud *bench_scene_make(cli_session *session, uint64_t point_count, const option_size *size,
                            ewa_camera *camera) {
    ewa_generate_options options;
    ewa_generate_options_init(&options, sizeof options);
    options.object = EWA_OBJECT_PLANE;
    options.point_count = point_count;
    ewa_cloud *cloud = NULL;
    ewa_status status = ewa_cloud_generate(session->context, &options, &cloud);
    ewa_bounds bounds;
    if (status == EWA_OK) stretch(cloud, (float)size->width_px / (float)size->height_px);
    if (status == EWA_OK) status = ewa_cloud_measure(cloud, &bounds);
    if (status == EWA_OK) {
        ewa_camera_init(camera, sizeof *camera);
        camera->width_px = size->width_px;
        camera->height_px = size->height_px;
        static const double down[3] = {0, 0.05, -1}, ahead[3] = {0, 1, 0};
        status = ewa_camera_set_fov(camera, 30);
        if (status == EWA_OK) status = ewa_camera_frame(camera, &bounds, down, ahead, MARGIN);
    }
    if (status == EWA_OK) return cloud;
    session_failed(session, status);
    ewa_cloud_destroy(&cloud);
    return NULL;
}

/// The footprint of a disc at `world` with normal `n_world`.
static footprint project_disc(const ewa_camera *camera, const double world[3], const double n_world[3]) {
    const double *m = camera->world_to_camera;
    double p[3], n[3], length = 0;
    for (int r = 0; r < 3; r++) {
        p[r] = m[4 * r] * world[0] + m[4 * r + 1] * world[1] + m[4 * r + 2] * world[2] + m[4 * r + 3];
        n[r] = m[4 * r] * n_world[0] + m[4 * r + 1] * n_world[1] + m[4 * r + 2] * n_world[2];
        length += n[r] * n[r];
    }
    for (int r = 0; r < 3; r++) n[r] /= sqrt(length);
    const double jx[3] = {camera->fx_px / p[2], 0, -camera->fx_px * p[0] / (p[2] * p[2])};
    const double jy[3] = {0, camera->fy_px / p[2], -camera->fy_px * p[1] / (p[2] * p[2])};
    const double nx = jx[0] * n[0] + jx[2] * n[2], ny = jy[1] * n[1] + jy[2] * n[2];
    return (footprint){jx[0] * jx[0] + jx[2] * jx[2] - nx * nx, jx[2] * jy[2] - nx * ny,
                       jy[1] * jy[1] + jy[2] * jy[2] - ny * ny};
}

/// Mean area of the ellipses at `cutoff` standard deviations, in pixels.
static double mean_area(const footprint *footprints, size_t count, double sigma_world, double prefilter_px,
                        double cutoff) {
    const double s = sigma_world * sigma_world, h = prefilter_px * prefilter_px;
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        const double xx = s * footprints[i].xx + h, xy = s * footprints[i].xy, yy = s * footprints[i].yy + h;
        sum += sqrt(fmax(xx * yy - xy * xy, 0));
    }
    return acos(-1) * cutoff * cutoff * sum / (double)count;
}

bool bench_scene_cover(cli_session *session, ewa_cloud *cloud, const ewa_camera *camera, double prefilter_px,
                       double covered_px) {
    const uint64_t point_count = ewa_cloud_point_count(cloud);
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION),
                        *normal = ewa_cloud_find(cloud, EWA_NORMAL);
    ewa_surfels_options surfels;
    ewa_surfels_options_init(&surfels, sizeof surfels);
    static footprint footprints[SAMPLES];
    const size_t count = point_count < SAMPLES ? (size_t)point_count : SAMPLES;
    for (size_t i = 0; i < count; i++) {
        double p[3], n[3];
        ewa_attribute_read_f64(position, i * point_count / count, 1, p);
        ewa_attribute_read_f64(normal, i * point_count / count, 1, n);
        footprints[i] = project_disc(camera, p, n);
    }
    const double least_px = mean_area(footprints, count, 0, prefilter_px, surfels.cutoff);
    if (covered_px <= least_px) {
        session_fail(session, "--pixels: the pixel filter alone covers %.2f pixels, more than %g", least_px,
                     covered_px);
        return false;
    }
    double low = 0, high = 1;
    while (mean_area(footprints, count, high, prefilter_px, surfels.cutoff) < covered_px) high *= 2;
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (low + high);
        if (mean_area(footprints, count, middle, prefilter_px, surfels.cutoff) < covered_px)
            low = middle;
        else
            high = middle;
    }
    void *data = NULL;
    const ewa_status status = ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, &data);
    if (status != EWA_OK) {
        session_failed(session, status);
        return false;
    }
    for (uint64_t i = 0; i < point_count; i++) ((float *)data)[i] = (float)(surfels.cutoff * high);
    return true;
}

static int compare_times(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

bench_sample bench_summarise(double *times, size_t count) {
    if (count == 0) return (bench_sample){0, 0, 0};
    qsort(times, count, sizeof *times, compare_times);
    return (bench_sample){times[0], times[count / 4], times[count / 2]};
}
