// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the tables of docs/volume.md about line integrals: the footprint's index as printed in the paper and
// as it holds, on and off the axis; pictures of a blob and a ball against closed forms; pictures against
// marched rays.
#include "defaults.h"
#include "volume/footprint.h"
#include "volume/march.h"
#include "volume/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double PI = 3.14159265358979323846;

/// Largest errors of an index d over the ellipse, and of the Gaussian footprint exp(-F^2 d^2 / 2), in % of
/// its peak, at F = 3.
typedef struct index_error {
    double d, footprint;
} index_error;

static void note(index_error *error, double d2, double truth2) {
    error->d = fmax(error->d, fabs(sqrt(d2) - sqrt(truth2)));
    error->footprint = fmax(error->footprint, 100 * fabs(exp(-4.5 * d2) - exp(-4.5 * truth2)));
}

/// On the axis: exact d from the ray, against both formulas.
static void print_axis(void) {
    printf("| half angle | printed (tan): d | footprint | sin: d | footprint |\n|---|---|---|---|---|\n");
    static const double angles[] = {0.25, 1, 2, 5, 10, 15, 30};
    for (size_t a = 0; a < sizeof angles / sizeof *angles; a++) {
        const double alpha = angles[a] * PI / 180, sine2 = sin(alpha) * sin(alpha);
        index_error printed = {0, 0}, holds = {0, 0};
        for (int n = 0; n <= 1000; n++) {
            const double i = n / 1000.0, slope = i * tan(alpha);
            const double truth2 = slope * slope / (1 + slope * slope) / sine2; // |p x ray| / r, |p| = 1
            note(&printed, ewa_footprint_index2_printed(i * i, sine2), truth2);
            note(&holds, ewa_footprint_index2(i * i, sine2), truth2);
        }
        printf("| %g° | %.2g | %.2g %% | %.1g | %.1g %% |\n", angles[a], printed.d, printed.footprint,
               holds.d, holds.footprint);
    }
}

/// Off the axis: the paper's index by the place in the ellipse, against the ray.
static void print_off_axis(void) {
    printf("\n| half angle | 0° off the axis | 15° | 30° | 45° |\n|---|---|---|---|---|\n");
    static const double angles[] = {0.25, 1, 2, 5};
    for (size_t a = 0; a < sizeof angles / sizeof *angles; a++) {
        printf("| %g° |", angles[a]);
        for (int off = 0; off <= 45; off += 15) {
            const double theta = off * PI / 180, alpha = angles[a] * PI / 180, r = sin(alpha);
            const double p[3] = {sin(theta), 0, cos(theta)};
            // Along the ellipse's long axis, between the images of the two tangent rays.
            const double low = tan(theta - alpha), high = tan(theta + alpha), middle = (low + high) / 2;
            index_error error = {0, 0};
            for (int n = -1000; n <= 1000; n++) {
                const double i = n / 1000.0, x = middle + i * (high - low) / 2;
                const double across = (p[0] - x * p[2]) / sqrt(1 + x * x); // |p x ray|
                note(&error, ewa_footprint_index2(i * i, r * r), across * across / (r * r));
            }
            printf(" %.2g %% |", error.footprint);
        }
        printf("\n");
    }
}

/// Largest and mean error of a picture's optical depths in % of the largest.
static void compare(const char *what, const ewa_image *image, const double *truth) {
    double largest = 0, maximum = 0, sum = 0;
    const size_t count = (size_t)image->width_px * image->height_px;
    for (size_t i = 0; i < count; i++) largest = fmax(largest, truth[i]);
    for (size_t i = 0; i < count; i++) {
        const double depth = -log(1 - (double)image->pixels[4 * i + 3]), error = fabs(depth - truth[i]);
        maximum = fmax(maximum, error);
        sum += error;
    }
    printf("| %s | %.3f %% | %.4f %% |\n", what, 100 * maximum / largest,
           100 * sum / (double)count / largest);
}

enum { SIDE_PX = 96 };

/// Distances of a pixel's ray from the origin.
static double ray_distance(const ewa_camera *camera, double x_px, double y_px) {
    const double *m = camera->world_to_camera;
    const double x = (x_px - camera->cx_px) / camera->fx_px, y = (y_px - camera->cy_px) / camera->fy_px;
    const double along = (m[3] * x + m[7] * y + m[11]) / sqrt(x * x + y * y + 1);
    return sqrt(fmax(m[3] * m[3] + m[7] * m[7] + m[11] * m[11] - along * along, 0));
}

static double ball_integral(double radius, double distance) {
    return distance < radius ? 16.0 / 15 * pow(radius * radius - distance * distance, 2.5) / pow(radius, 4)
                             : 0;
}

static double soft_ball(const void *data, double x, double y, double z) {
    const double radius = *(const double *)data, u = 1 - (x * x + y * y + z * z) / (radius * radius);
    return u > 0 ? u * u : 0;
}

/// A blob and a ball whose integrals are known; the blob also as its kernels make it.
static void print_closed(ewa_context *context) {
    static const uint32_t dims[3] = {64, 64, 64};
    static const double spacing[3] = {1, 1, 1}, direction[3] = {0.4, 0.3, -1};
    static const double KAPPA = 0.05, SIGMA = 0.6;
    const double q = 6, radius = 24;
    ewa_volume volumes[2] = {scene_volume(context, dims, spacing, scene_blob, &q),
                             scene_volume(context, dims, spacing, soft_ball, &radius)};
    const ewa_transfer transfer = scene_linear(1, 1, 1, (float)KAPPA);
    printf("\n| picture against a closed form | largest error | mean error |\n|---|---|---|\n");
    for (int far = 0; far < 2; far++) {
        const ewa_camera camera = scene_camera(SIDE_PX, SIDE_PX, direction, far ? 200 : 90);
        double blob[SIDE_PX * SIDE_PX], kernels[SIDE_PX * SIDE_PX], ball[SIDE_PX * SIDE_PX];
        for (int y = 0; y < SIDE_PX; y++)
            for (int x = 0; x < SIDE_PX; x++) {
                const double d = ray_distance(&camera, x + 0.5, y + 0.5), s2 = q * q + SIGMA * SIGMA;
                const int i = y * SIDE_PX + x;
                blob[i] = KAPPA * q * sqrt(2 * PI) * exp(-d * d / (2 * q * q));
                kernels[i] = KAPPA * q * q * q / s2 * sqrt(2 * PI) * exp(-d * d / (2 * s2));
                ball[i] = KAPPA * ball_integral(radius, d);
            }
        WITH_DEFAULTS(ewa_volume_options, options);
        options.sigma = SIGMA, options.prefilter_px = 0, options.minimum_transmittance = 0;
        options.cutoff = 4;
        for (int v = 0; v < 2; v++) {
            ewa_voxels *voxels = scene_voxels(&volumes[v], &transfer);
            ewa_image image = scene_draw(context, voxels, &camera, &options);
            const char *as = far ? "points" : "splats";
            char what[96];
            snprintf(what, sizeof what, "%s, %s", v ? "ball, R = 24 voxels" : "blob, q = 6 voxels", as);
            compare(what, &image, v ? ball : blob);
            snprintf(what, sizeof what, "blob as its kernels make it, %s", as);
            if (v == 0) compare(what, &image, kernels);
            ewa_image_free(&image);
            ewa_voxels_destroy(&voxels);
        }
    }
    for (int v = 0; v < 2; v++) ewa_volume_free(&volumes[v]);
}

/// Thin tubes against rays marched through the sum of all kernels.
static void print_marched(ewa_context *context) {
    static const uint32_t dims[3] = {32, 32, 32};
    static const double spacing[3] = {1, 1, 1}, direction[3] = {0.4, 0.3, -1};
    const double half = 14;
    ewa_volume volume = scene_volume(context, dims, spacing, scene_vessels, &half);
    const ewa_transfer transfer = scene_linear(1, 1, 1, 0.2f);
    ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    const march_scene scene = {.volume = &volume, .extinction = (double)0.2f, .sigma = 0.6, .step = 0.1};
    printf("\n| splats against marched rays | largest error | mean error |\n|---|---|---|\n");
    static const double distances[] = {34, 60, 100};
    for (int at = 0; at < 3; at++) {
        const ewa_camera camera = scene_camera(SIDE_PX, SIDE_PX, direction, distances[at]);
        static double truth[SIDE_PX * SIDE_PX];
        for (int i = 0; i < SIDE_PX * SIDE_PX; i++)
            truth[i] = march_depth(&scene, &camera, i % SIDE_PX + 0.5, i / SIDE_PX + 0.5);
        for (int index = EWA_INDEX_EXACT; index <= EWA_INDEX_TABLE; index++) {
            WITH_DEFAULTS(ewa_volume_options, options);
            options.method = EWA_VOLUME_SPLATS, options.index = (ewa_volume_index)index;
            options.prefilter_px = 0, options.minimum_transmittance = 0, options.cutoff = 4;
            ewa_image image = scene_draw(context, voxels, &camera, &options);
            char what[96];
            snprintf(what, sizeof what, "eye %g voxels away, %s", distances[at],
                     index == EWA_INDEX_EXACT ? "exact" : "table");
            compare(what, &image, truth);
            ewa_image_free(&image);
        }
    }
    ewa_voxels_destroy(&voxels);
    ewa_volume_free(&volume);
}

int main(void) {
    ewa_context *context;
    if (ewa_context_create(NULL, &context) != EWA_OK) return 1;
    print_axis();
    print_off_axis();
    print_closed(context);
    print_marched(context);
    ewa_context_destroy(&context);
    return 0;
}
