// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The exact projection against integrals along rays, also where the affine map fails; and that turning the
// camera changes nothing at once.
#include "volume/gaussian_scene.h"

#include <math.h>

/// Of at most 6.5 units: four steps in the thinnest standard deviation, where the midpoint rule is exact but for rounding.
enum { STEPS = 1000, SIDE_PX = 75 };

/// Integral of a Gaussian of peak 1 along a ray from the eye, by the midpoint rule, in double precision.
static double integrate(const double eye[3], const double direction[3], const double center[3],
                        const double axes[3][3], const double scales[3], double length) {
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        const double t = (i + 0.5) * length / STEPS;
        double m2 = 0;
        for (int a = 0; a < 3; a++) {
            double along = 0;
            for (int k = 0; k < 3; k++) along += axes[a][k] * (eye[k] + t * direction[k] - center[k]);
            m2 += along * along / (scales[a] * scales[a]);
        }
        if (m2 < 100) sum += exp(-m2 / 2); // beyond, less than 2e-22
    }
    return sum * length / STEPS;
}

/// A Gaussian alone: its opacity times its integral along each ray, over that of the parallel ray through its
/// centre.
static ewa_image draw_integrals(ewa_context *context, const ewa_camera *camera, const double center[3],
                                const double axes[3][3], const double scales[3], double opacity,
                                double minimum) {
    ewa_image image;
    assert_int_equal(ewa_image_create(context, camera->width_px, camera->height_px, 4, &image), EWA_OK);
    double eye[3];
    ewa_camera_eye(camera, eye);
    double away = 0;
    for (int k = 0; k < 3; k++) away += (center[k] - eye[k]) * (center[k] - eye[k]);
    const double length = sqrt(away) + 8 * fmax(scales[0], fmax(scales[1], scales[2]));
    for (size_t i = 0; i < (size_t)camera->width_px * camera->height_px; i++) {
        const double x = ((double)(i % camera->width_px) + 0.5 - camera->cx_px) / camera->fx_px;
        const double y = ((double)(i / camera->width_px) + 0.5 - camera->cy_px) / camera->fy_px;
        const double *m = camera->world_to_camera;
        double direction[3], start[3];
        const double shrink = 1 / sqrt(x * x + y * y + 1);
        for (int k = 0; k < 3; k++) direction[k] = (x * m[k] + y * m[4 + k] + m[8 + k]) * shrink;
        for (int k = 0; k < 3; k++) start[k] = center[k] - length / 2 * direction[k];
        const double through = integrate(start, direction, center, axes, scales, length);
        double alpha = opacity * integrate(eye, direction, center, axes, scales, length) / through;
        if (alpha < minimum) alpha = 0;
        for (size_t k = 0; k < 4; k++) image.pixels[4 * i + k] = (float)alpha; // white
    }
    return image;
}

/// Places in the picture under 120 degrees, shapes, and what either projection makes of them.
TEST_ON(test_integrals, 2) {
    static const double white[3] = {1, 1, 1}, ahead[3] = {0, 0, -1};
    static const double shapes[3][3] = {{0.2, 0.2, 0.2}, {0.5, 0.15, 0.1}, {0.4, 0.3, 0.03}};
    static const double angles[3] = {0, 35, 55};
    double worst_exact = INFINITY, worst_trained = INFINITY;
    for (int n = 0; n < 9; n++) {
        const double *scales = shapes[n % 3], angle = angles[n / 3] * 3.141592653589793 / 180;
        const ewa_camera camera = gaussians_camera(SIDE_PX, SIDE_PX, 120, ahead, 3); // at 0 0 -3
        const double center[3] = {2.5 * sin(angle), 0.1, 2.5 * cos(angle) - 3};
        const double turn = 0.3 + n,
                     rotation[4] = {cos(turn / 2), 0.6 * sin(turn / 2), 0, 0.8 * sin(turn / 2)};
        const double w = rotation[0], x = rotation[1], y = rotation[2], z = rotation[3];
        const double axes[3][3] = {
            {1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
            {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
            {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)},
        };
        OWNED(ewa_gaussians_free) ewa_gaussians set = gaussians_one(context, center, scales, rotation, 0.9, white);
        WITH_DEFAULTS(ewa_gaussian_options, options);
        options.prefilter_px2 = 0;
        options.minimum_alpha = 1e-4, options.cutoff = 5;
        OWNED(ewa_image_free)
        ewa_image truth = draw_integrals(context, &camera, center, axes, scales, 0.9, options.minimum_alpha);
        double decibels[2];
        for (int exact = 0; exact < 2; exact++) {
            options.projection = (ewa_gaussian_projection)exact;
            OWNED(ewa_image_free) ewa_image image = gaussians_draw(&set, &camera, &options, NULL);
            // Alpha alone: white on nothing.
            double sum = 0;
            for (size_t i = 0; i < SIDE_PX * SIDE_PX; i++) {
                const double d = (double)image.pixels[4 * i + 3] - (double)truth.pixels[4 * i + 3];
                sum += d * d;
            }
            decibels[exact] = -10 * log10(sum / (SIDE_PX * SIDE_PX) + 1e-30);
        }
        print_message("%g degrees off the axis, shape %d: exact %.1f dB, affine %.1f dB\n", angles[n / 3],
                      n % 3, decibels[1], decibels[0]);
        worst_exact = fmin(worst_exact, decibels[1]), worst_trained = fmin(worst_trained, decibels[0]);
    }
    if (!(worst_exact > 60)) fail_msg("%g dB", worst_exact);
    assert_true(worst_trained < 40); // the affine map fails
}

/// The largest change between two pictures, RMS.
static double change(const ewa_image *a, const ewa_image *b) {
    double sum = 0;
    const size_t numbers = (size_t)a->width_px * a->height_px * 4;
    for (size_t i = 0; i < numbers; i++)
        sum += ((double)a->pixels[i] - (double)b->pixels[i]) * ((double)a->pixels[i] - (double)b->pixels[i]);
    return sqrt(sum / (double)numbers);
}

/// The picture after some degrees of a turntable, by the depths of rays or of centres.
static ewa_image draw_turned(const ewa_gaussians *set, double degrees, bool by_centers) {
    static const double origin[3] = {0, 0, 0}, axis[3] = {0, 1, 0}, from[3] = {0, 0.2, -1};
    ewa_camera camera = gaussians_camera(48, 48, 40, from, 4);
    assert_int_equal(ewa_camera_orbit(&camera, origin, axis, degrees), EWA_OK);
    WITH_DEFAULTS(ewa_gaussian_options, options);
    options.order = by_centers ? EWA_ORDER_CENTER : EWA_ORDER_RAY;
    return gaussians_draw(set, &camera, &options, NULL);
}

/// The largest change from one picture to the next of `steps`, and before which.
static double largest_change(const ewa_gaussians *set, double first_deg, double step_deg, int steps,
                             bool by_centers, int *where) {
    double largest = 0;
    ewa_image before = draw_turned(set, first_deg, by_centers);
    for (int n = 0; n < steps; n++) {
        ewa_image image = draw_turned(set, first_deg + (n + 1) * step_deg, by_centers);
        const double here = change(&before, &image);
        if (here > largest) largest = here, *where = n;
        ewa_image_free(&before);
        before = image;
    }
    ewa_image_free(&before);
    return largest;
}

/// The share of pixels that change at once: within a 2048th of a degree about the largest change.
static double popped(const ewa_gaussians *set, double first_deg, bool by_centers) {
    double step_deg = 0.25;
    for (int n = 0; n < 3; n++) {
        int where = 0;
        step_deg /= 8;
        largest_change(set, first_deg, step_deg, 8, by_centers, &where);
        first_deg += where * step_deg;
    }
    ewa_image images[2] = {draw_turned(set, first_deg, by_centers),
                           draw_turned(set, first_deg + step_deg, by_centers)};
    const size_t pixels = (size_t)images[0].width_px * images[0].height_px;
    size_t count = 0;
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 4; c++)
            if (fabsf(images[0].pixels[4 * i + c] - images[1].pixels[4 * i + c]) > 0.01f) {
                count++;
                break;
            }
    for (int i = 0; i < 2; i++) ewa_image_free(&images[i]);
    return (double)count / (double)pixels;
}

/// Shields that cut each other while the camera turns about them through 90 degrees in steps of a quarter of
/// a degree: what passes before what changes pixel by pixel. Sorted by centres whole shields do, and the
/// largest change from frame to frame is several times as large.
TEST_ON(test_popping, 2) {
    OWNED(ewa_gaussians_free) ewa_gaussians set = gaussians_random(context, 10, 0, 21);
    for (size_t i = 0; i < set.count; i++) {
        set.opacities[i] = 0.9f;
        for (size_t k = 0; k < 3; k++) {
            set.scales[3 * i + k] = k == 2 ? 0.1f : 0.5f;
            set.centers[3 * i + k] *= 0.3f;
        }
    }
    double largest[2], share[2];
    for (int sorted = 0; sorted < 2; sorted++) {
        int where = 0;
        largest[sorted] = largest_change(&set, 0, 0.25, 360, sorted, &where);
        share[sorted] = popped(&set, 0.25 * where, sorted);
    }
    print_message(
        "largest change from frame to frame, RMS: %.4f, sorted by centres %.4f; of the pixels change at "
        "once: %.2f %%, sorted by centres %.2f %%\n",
        largest[0], largest[1], 100 * share[0], 100 * share[1]);
    assert_true(share[0] < 0.0005);
    assert_true(share[1] > 0.05);
    assert_true(largest[1] > 3 * largest[0]);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
