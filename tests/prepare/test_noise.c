// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/estimate/noise.c: normals of a room with a ball, as a depth camera with steps and noise in 1 / z sees it.
#include "prepare/check_prepare.h"

enum { WIDTH = 200, HEIGHT = 150, PIXELS = WIDTH * HEIGHT };

static const double FOCAL = 164, STEP = 0.009; // of a first Kinect at this size: noise of 1.5 to 3 samples' distances
static const double BALL[3] = {-0.5, 0.5, 2.3}, BALL_RADIUS = 0.45;

/// What each pixel sees.
typedef struct room {
    double z[PIXELS], normal[PIXELS][3];
    int surface[PIXELS]; // 0 to 2: walls and floor, 3: the ball
} room;

static double dot3(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void view(uint32_t i, double d[3]) {
    d[0] = (i % WIDTH - 0.5 * WIDTH) / FOCAL, d[1] = (i / WIDTH - 0.5 * HEIGHT) / FOCAL, d[2] = 1;
}

static void look(room *seen) {
    static const double planes[3][4] = {{0, 1, 0, 1.1}, {0.447214, 0, 0.894427, 2.8}, {-0.943858, 0, 0.330350, 1.5}};
    for (uint32_t i = 0; i < PIXELS; i++) {
        double d[3];
        view(i, d);
        seen->z[i] = INFINITY;
        for (int k = 0; k < 3; k++) {
            const double z = planes[k][3] / dot3(planes[k], d);
            if (!(z > 0 && z < seen->z[i])) continue;
            seen->z[i] = z, seen->surface[i] = k;
            memcpy(seen->normal[i], planes[k], sizeof seen->normal[i]);
        }
        const double a = dot3(d, d), b = dot3(d, BALL), c = dot3(BALL, BALL) - BALL_RADIUS * BALL_RADIUS;
        if (!(b * b > a * c)) continue;
        seen->z[i] = (b - sqrt(b * b - a * c)) / a, seen->surface[i] = 3;
        for (int k = 0; k < 3; k++) seen->normal[i][k] = (d[k] * seen->z[i] - BALL[k]) / BALL_RADIUS;
    }
}

/// The cloud that a camera makes of it; `step` 0: without noise.
static ewa_cloud *take(ewa_context *context, const room *seen, double step, bool grid) {
    float *xyz = NULL;
    ewa_cloud *cloud = check_cloud(context, PIXELS, &xyz);
    check_random random = {17};
    for (uint32_t i = 0; i < PIXELS; i++) {
        double d[3], z = seen->z[i];
        view(i, d);
        const double off = check_uniform(&random, -0.5, 0.5);
        if (step > 0) z = 1 / (step * floor(1 / z / step + off + 0.5));
        for (int c = 0; c < 3; c++) xyz[3 * i + (uint32_t)c] = (float)(d[c] * z);
    }
    if (grid) {
        assert_int_equal(ewa_cloud_set_note(cloud, "file.organised", "200 x 150", 9), EWA_OK);
        assert_int_equal(ewa_cloud_set_note(cloud, "scanners", "0 0 0\n", 6), EWA_OK);
    }
    const ewa_estimate_options options = check_estimate_options();
    assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
    return cloud;
}

/// How far normals are off, of pixels on one surface (-1: all) at least so many pixels from another: the peak signal-to-noise ratio, the peak
/// being 2, and degrees, on average.
static double measure(const ewa_cloud *cloud, const room *seen, int surface, int apart, double *degrees) {
    const float *normal = check_stream(cloud, EWA_NORMAL);
    double sum = 0, sum_degrees = 0, count = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const uint32_t i = (uint32_t)(y * WIDTH + x);
            bool counts = surface < 0 || seen->surface[i] == surface;
            for (int dy = -apart; dy <= apart && counts; dy++)
                for (int dx = -apart; dx <= apart && counts; dx++)
                    counts = x + dx >= 0 && x + dx < WIDTH && y + dy >= 0 && y + dy < HEIGHT &&
                             seen->surface[(y + dy) * WIDTH + x + dx] == seen->surface[i];
            if (!counts) continue;
            double cosine = 0;
            for (int c = 0; c < 3; c++) cosine += seen->normal[i][c] * (double)normal[3 * i + (uint32_t)c];
            cosine = fmin(fabs(cosine), 1);
            sum += 2 - 2 * cosine, sum_degrees += acos(cosine) * 180 / 3.141592653589793, count++;
        }
    *degrees = sum_degrees / count;
    return 10 * log10(4 * count / sum);
}

static room seen;

/// Normals are right in spite of steps of several samples; a pixel or two beside an edge, too.
TEST_ON(test_room, 2) {
    look(&seen);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = take(context, &seen, STEP, true);
    double degrees, all;
    const double decibels = measure(cloud, &seen, -1, 0, &all);
    print_message("all: %.1f dB, %.2f degrees\n", decibels, all);
    assert_true(decibels > 20 && all < 4);
    for (int k = 0; k < 4; k++) {
        measure(cloud, &seen, k, 2, &degrees);
        print_message("surface %d: %.2f degrees\n", k, degrees);
        assert_true(degrees < (k == 3 ? 12 : 4));
    }
}

/// An eye that nobody told of is found where it is the world's origin; a cloud elsewhere keeps its noise.
TEST_ON(test_eye, 2) {
    look(&seen);
    OWNED(ewa_cloud_destroy) ewa_cloud *told = take(context, &seen, STEP, true), *found = take(context, &seen, STEP, false);
    double degrees;
    assert_true(measure(found, &seen, -1, 0, &degrees) > 20);
    float *xyz = NULL;
    OWNED(ewa_cloud_destroy) ewa_cloud *inside = check_cloud(context, PIXELS, &xyz);
    memcpy(xyz, check_stream(told, EWA_POSITION), PIXELS * 3 * sizeof *xyz);
    ewa_cloud_set_origin(inside, (const double[3]){0, 0, -2}); // the world's origin lies in the room
    const ewa_estimate_options options = check_estimate_options();
    assert_int_equal(ewa_cloud_estimate(&inside, &options), EWA_OK);
    const double noisy = measure(inside, &seen, -1, 0, &degrees);
    print_message("without an eye: %.1f dB, %.2f degrees\n", noisy, degrees);
    assert_true(noisy < 16);
}

/// Without noise nothing is turned: the normals are the bytes of a cloud that nobody saw from one side.
TEST_ON(test_without_noise, 2) {
    look(&seen);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = take(context, &seen, 0, false);
    float *xyz = NULL;
    OWNED(ewa_cloud_destroy) ewa_cloud *inside = check_cloud(context, PIXELS, &xyz);
    memcpy(xyz, check_stream(cloud, EWA_POSITION), PIXELS * 3 * sizeof *xyz);
    ewa_cloud_set_origin(inside, (const double[3]){0, 0, -2});
    const ewa_estimate_options options = check_estimate_options();
    assert_int_equal(ewa_cloud_estimate(&inside, &options), EWA_OK);
    assert_memory_equal(check_stream(cloud, EWA_NORMAL), check_stream(inside, EWA_NORMAL), PIXELS * 3 * sizeof *xyz);
    assert_memory_equal(check_stream(cloud, EWA_RADIUS), check_stream(inside, EWA_RADIUS), PIXELS * sizeof *xyz);
}

/// What is turned gets discs that are wide enough where it is seen at a grazing angle: no disc on the floor leaves a gap in the row of pixels
/// between it and the next.
TEST_ON(test_discs, 2) {
    look(&seen);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = take(context, &seen, STEP, true);
    const float *radius = check_stream(cloud, EWA_RADIUS);
    uint64_t count = 0, narrow = 0;
    for (uint32_t i = WIDTH; i < PIXELS; i++) {
        if (seen.surface[i] != 0 || seen.surface[i - WIDTH] != 0) continue;
        const double apart = fabs(seen.z[i - WIDTH] - seen.z[i]);
        narrow += (double)radius[i] < 0.5 * fmin(apart, 4 * seen.z[i] / FOCAL);
        count++;
    }
    print_message("%llu of %llu discs do not reach half of the way\n", (unsigned long long)narrow, (unsigned long long)count);
    assert_true(count > 1000 && narrow * 200 < count);
}

/// The same bytes for one thread and three.
TEST(test_threads) {
    (void)state;
    look(&seen);
    OWNED(ewa_context_destroy) ewa_context *one = check_context(1, NULL), *three = check_context(3, NULL);
    OWNED(ewa_cloud_destroy) ewa_cloud *a = take(one, &seen, STEP, true), *b = take(three, &seen, STEP, true);
    assert_memory_equal(check_stream(a, EWA_NORMAL), check_stream(b, EWA_NORMAL), PIXELS * 3 * sizeof(float));
    assert_memory_equal(check_stream(a, EWA_RADIUS), check_stream(b, EWA_RADIUS), PIXELS * sizeof(float));
}

int main(void) { return RUN_TESTS(NULL, NULL); }
