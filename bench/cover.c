// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How many pixels the splats of a cloud cover, and radii for a wanted number.
//
// Based on: Zwicker et al., "Surface Splatting", 2001, section 3: a disc of deviation s and unit normal n has
// the covariance s^2 J (I - n n') J' on the screen, J the projection's Jacobian at its centre.
#include "bench/cover.h"

#include <math.h>

enum { MAX_SAMPLES = 4096, BISECTIONS = 60 };

/// Screen covariance of a disc, without the pixel filter: xx, xy, yy in squared pixels.
typedef struct footprint {
    double xx, xy, yy;
} footprint;

/// Footprints of some points of a cloud.
typedef struct footprint_sample {
    size_t count;
    footprint discs[MAX_SAMPLES];
} footprint_sample;

/// The footprint of a disc of deviation `sigma_world` at `world` with normal `n_world`.
static footprint project_disc(const ewa_camera *camera, const double world[3], const double n_world[3],
                              double sigma_world) {
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
    const double s = sigma_world * sigma_world;
    return (footprint){s * (jx[0] * jx[0] + jx[2] * jx[2] - nx * nx), s * (jx[2] * jy[2] - nx * ny),
                       s * (jy[1] * jy[1] + jy[2] * jy[2] - ny * ny)};
}

static double cutoff(void) {
    ewa_surfels_options options;
    ewa_surfels_options_init(&options, sizeof options);
    return options.cutoff;
}

static void sample_footprints(const ewa_cloud *cloud, const ewa_camera *camera, footprint_sample *sample) {
    const uint64_t point_count = ewa_cloud_point_count(cloud);
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION),
                        *normal = ewa_cloud_find(cloud, EWA_NORMAL),
                        *radius = ewa_cloud_find(cloud, EWA_RADIUS);
    sample->count = point_count < MAX_SAMPLES ? (size_t)point_count : MAX_SAMPLES;
    for (size_t i = 0; i < sample->count; i++) {
        const uint64_t point = i * point_count / sample->count;
        double p[3], n[3], support_world;
        ewa_attribute_read_f64(position, point, 1, p);
        ewa_attribute_read_f64(normal, point, 1, n);
        ewa_attribute_read_f64(radius, point, 1, &support_world);
        sample->discs[i] = project_disc(camera, p, n, support_world / cutoff());
    }
}

/// Mean area of the filtered ellipses in pixels when all radii are `scale` times what they are.
static double mean_area(const footprint_sample *sample, double scale, double prefilter_px) {
    const double s = scale * scale, h = prefilter_px * prefilter_px, ends = cutoff();
    double sum = 0;
    for (size_t i = 0; i < sample->count; i++) {
        const footprint *disc = &sample->discs[i];
        const double xx = s * disc->xx + h, xy = s * disc->xy, yy = s * disc->yy + h;
        sum += sqrt(fmax(xx * yy - xy * xy, 0));
    }
    return acos(-1) * ends * ends * sum / (double)sample->count;
}

double bench_cover_px(const ewa_cloud *cloud, const ewa_camera *camera, double prefilter_px) {
    footprint_sample sample;
    sample_footprints(cloud, camera, &sample);
    return mean_area(&sample, 1, prefilter_px);
}

bool bench_cover_scale(cli_session *session, ewa_cloud *cloud, const ewa_camera *camera, double prefilter_px,
                       double covered_px) {
    footprint_sample sample;
    sample_footprints(cloud, camera, &sample);
    const double min_px = mean_area(&sample, 0, prefilter_px);
    if (covered_px <= min_px) {
        session_fail(session, "--pixels: the pixel filter alone covers %.2f pixels, more than %g", min_px,
                     covered_px);
        return false;
    }
    double low = 0, high = 1;
    while (mean_area(&sample, high, prefilter_px) < covered_px) high *= 2;
    for (int i = 0; i < BISECTIONS; i++) {
        const double middle = 0.5 * (low + high);
        if (mean_area(&sample, middle, prefilter_px) < covered_px)
            low = middle;
        else
            high = middle;
    }
    float *radius = ewa_cloud_find(cloud, EWA_RADIUS)->data;
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) radius[i] = (float)(high * radius[i]);
    return true;
}
