// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/edges/feature*.c: creases and corners whose lines are known, smooth surfaces that have none,
// what stays as it was, odd input.
#include "io/scratch.h"
#include "prepare/check_prepare.h"

enum { SIDE = 40, MAXIMUM = 5 * SIDE * SIDE };

/// Adds a jittered grid of unit spacing: corner + s a + t b for s, t in [0, SIDE); returns the new count.
static uint32_t add_square(const double corner[3], const double a[3], const double b[3],
                           const double normal[3], uint64_t seed, float *xyz, float *normals,
                           uint32_t count) {
    check_random random = {seed};
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double s = i % SIDE + check_uniform(&random, 0.2, 0.8),
                     t = i / SIDE + check_uniform(&random, 0.2, 0.8);
        for (int c = 0; c < 3; c++) {
            xyz[3 * count + (uint32_t)c] = (float)(corner[c] + s * a[c] + t * b[c]);
            normals[3 * count + (uint32_t)c] = (float)normal[c];
        }
        count++;
    }
    return count;
}

/// A cloud of squares with discs of the default size; the normals are blurred where the surface bends.
static ewa_cloud *make_cloud(ewa_context *context, uint32_t count, const float *xyz, const float *normals) {
    ewa_cloud *cloud = check_cloud_of(context, count);
    float *positions = check_add(cloud, EWA_POSITION, EWA_F32, 3);
    memcpy(positions, xyz, 3 * count * sizeof *xyz);
    float *n = check_add(cloud, EWA_NORMAL, EWA_F32, 3);
    memcpy(n, normals, 3 * count * sizeof *normals);
    uint8_t *color = check_add(cloud, EWA_COLOR, EWA_U8, 3);
    for (uint32_t i = 0; i < 3 * count; i++) color[i] = (uint8_t)(i * 7);
    const ewa_estimate_options estimate = check_estimate_options();
    assert_int_equal(ewa_cloud_estimate(&cloud, &estimate), EWA_OK);
    return cloud;
}

/// The same cloud without the borders of its squares, which are no features.
static ewa_cloud *without_borders(ewa_cloud *cloud) {
    ewa_cloud_remove(cloud, EWA_BORDER);
    return cloud;
}

static ewa_feature_options default_options(void) {
    WITH_DEFAULTS(ewa_feature_options, options);
    return options;
}

/// Two squares that meet along the y axis; their normals differ by `angle`, upwards (convex) or as a valley.
static ewa_cloud *make_bordered_crease(ewa_context *context, double angle_deg, bool valley) {
    static float xyz[3 * MAXIMUM], normals[3 * MAXIMUM];
    const double half = angle_deg * 3.141592653589793 / 360, c = cos(half),
                 s = valley ? sin(half) : -sin(half);
    const double origin[3] = {0, 0, 0}, y[3] = {0, 1, 0};
    uint32_t count = 0;
    for (int side = -1; side < 2; side += 2) {
        const double a[3] = {side * c, 0, s}, normal[3] = {-side * s, 0, c};
        count = add_square(origin, a, y, normal, (uint64_t)(side + 5), xyz, normals, count);
    }
    return make_cloud(context, count, xyz, normals);
}

static ewa_cloud *make_crease(ewa_context *context, double angle_deg, bool valley) {
    return without_borders(make_bordered_crease(context, angle_deg, valley));
}

static bool has_line(const float *clip, uint64_t i) { return clip[3 * i] != 0 || clip[3 * i + 1] != 0; }

/// The point of a clip line nearest to the surfel's centre, and the direction of the line.
static void line_in_world(const ewa_cloud *cloud, const float *clip, uint64_t i, double foot[3]) {
    const float *p = check_stream(cloud, EWA_POSITION), *u = check_stream(cloud, EWA_TANGENT_U),
                *v = check_stream(cloud, EWA_TANGENT_V);
    double uu = 0, vv = 0, across[3], length2 = 0;
    for (int c = 0; c < 3; c++) uu += u[3 * i + c] * u[3 * i + c], vv += v[3 * i + c] * v[3 * i + c];
    for (int c = 0; c < 3; c++) {
        across[c] = clip[3 * i] * u[3 * i + c] / uu + clip[3 * i + 1] * v[3 * i + c] / vv;
        length2 += across[c] * across[c];
    }
    for (int c = 0; c < 3; c++) foot[c] = p[3 * i + c] - clip[3 * i + 2] * across[c] / length2;
}

static double length_of(const float *v) {
    return sqrt((double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] + (double)v[2] * (double)v[2]);
}

static void check_crease(double angle_deg, bool valley) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    OWNED(ewa_cloud_destroy)
    ewa_cloud *cloud = make_crease(context, angle_deg, valley),
              *before = make_crease(context, angle_deg, valley);
    ewa_feature_options options = default_options();
    if (angle_deg < 35) options.angle_deg = angle_deg - 6;
    ewa_feature_counts counts;
    assert_int_equal(ewa_cloud_detect_features(cloud, &options, &counts), EWA_OK);
    assert_true(counts.noise < 0.01 && counts.corner_count == 0);
    const float *clip = check_stream(cloud, EWA_CLIP0), *normal = check_stream(cloud, EWA_NORMAL);
    const float *position = check_stream(cloud, EWA_POSITION), *old = check_stream(before, EWA_POSITION);
    const float *old_normal = check_stream(before, EWA_NORMAL);
    const float *radius = check_stream(before, EWA_RADIUS), *along = check_stream(cloud, EWA_TANGENT_U),
                *across = check_stream(cloud, EWA_TANGENT_V);
    assert_null(ewa_cloud_find(cloud, EWA_RADIUS));
    uint32_t near = 0, clipped = 0;
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        const double distance = hypot(old[3 * i], old[3 * i + 2]);
        const bool inner = old[3 * i + 1] > 3 && old[3 * i + 1] < SIDE - 3;
        if (inner && distance < 1) near++, clipped += has_line(clip, i);
        if (distance > 7) {
            assert_false(has_line(clip, i));
            assert_memory_equal(&position[3 * i], &old[3 * i], 3 * sizeof *old);
            assert_memory_equal(&normal[3 * i], &old_normal[3 * i], 3 * sizeof *old);
        }
        if (!has_line(clip, i)) continue;
        assert_true(distance < 2.5);
        double foot[3], dot = 0;
        line_in_world(cloud, clip, i, foot);
        assert_true(fabs(foot[0]) < 0.02 && fabs(foot[2]) < 0.02);
        assert_true(fabs(foot[1] - (double)old[3 * i + 1]) < 0.05);
        assert_true(clip[3 * i + 2] > -0.05f); // what is kept holds the centre
        // A disc that ends at the edge is 1.5 times as wide, and 1.1 times as long along it.
        assert_float_equal(length_of(&across[3 * i]), 1.5 * (double)radius[i] / 3, 1e-5);
        assert_float_equal(length_of(&along[3 * i]), 1.1 * (double)radius[i] / 3, 1e-5);
        for (int c = 0; c < 3; c++) dot += (double)normal[3 * i + c] * (double)old_normal[3 * i + c];
        assert_true(dot > 0.9999);
    }
    print_message("%g degrees, %s: %u of %u clipped\n", angle_deg, valley ? "valley" : "ridge", clipped,
                  near);
    assert_true(near > 50 && clipped >= near - near / 50);
}

TEST(test_creases) {
    static const double angles[] = {25, 40, 60, 90, 120};
    for (size_t i = 0; i < sizeof angles / sizeof angles[0]; i++) {
        check_crease(angles[i], false);
        check_crease(angles[i], true);
    }
}

/// Points over the surface are put onto it up to 0.3 spacings, or 4 times the noise where that is more; those
/// that are farther off are left alone.
TEST_ON(test_outliers, 2) {
    static const struct {
        double noise;  ///< in spacings, which are 0.87 here
        double height; ///< in world units
        bool snapped;
    } cases[] = {{0.01, 0.23, true}, {0.01, 0.29, false}, {0.1, 0.32, true}, {0.1, 0.39, false}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        OWNED(ewa_cloud_destroy)
        ewa_cloud *cloud = make_crease(context, 90, false), *before = make_crease(context, 90, false);
        float *position = ewa_cloud_find(cloud, EWA_POSITION)->data;
        const float *old = check_stream(before, EWA_POSITION), *normal = check_stream(before, EWA_NORMAL);
        uint32_t lifted = 0, snapped = 0;
        for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i += 17) {
            if (fabsf(old[3 * i]) > 1) continue;
            for (int c = 0; c < 3; c++) position[3 * i + c] += (float)cases[k].height * normal[3 * i + c];
        }
        ewa_feature_options options = default_options();
        options.noise = cases[k].noise;
        assert_int_equal(ewa_cloud_detect_features(cloud, &options, NULL), EWA_OK);
        position = ewa_cloud_find(cloud, EWA_POSITION)->data;
        for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i += 17) {
            if (fabsf(old[3 * i]) > 1 || old[3 * i + 1] < 3 || old[3 * i + 1] > SIDE - 3) continue;
            double height = 0;
            for (int c = 0; c < 3; c++)
                height += (double)(position[3 * i + c] - old[3 * i + c]) * (double)normal[3 * i + c];
            lifted++, snapped += fabs(height) < 0.5 * cases[k].height;
        }
        assert_true(lifted > 5);
        assert_int_equal(snapped, cases[k].snapped ? lifted : 0);
    }
}

/// Below the threshold nothing changes, not even the streams.
TEST_ON(test_threshold, 2) {
    OWNED(ewa_cloud_destroy)
    ewa_cloud *cloud = make_crease(context, 22, false), *before = make_crease(context, 22, false);
    const ewa_feature_options options = default_options();
    ewa_feature_counts counts;
    assert_int_equal(ewa_cloud_detect_features(cloud, &options, &counts), EWA_OK);
    assert_int_equal(counts.snapped_count, 0);
    assert_int_equal(ewa_cloud_attribute_count(cloud), ewa_cloud_attribute_count(before));
    assert_memory_equal(check_stream(cloud, EWA_RADIUS), check_stream(before, EWA_RADIUS),
                        sizeof(float) * ewa_cloud_point_count(cloud));
}

/// Exact points have 24 neighbours looked at, those with noise of a quarter of a spacing or more all 64, and
/// between these as many more as there is noise.
TEST_ON(test_neighbour_counts, 2) {
    static const double noise[] = {0, 0.0625, 0.125, 0.1875, 0.25, 0.5};
    static const uint32_t expected[] = {24, 34, 44, 54, 64, 64};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_crease(context, 90, false);
    for (size_t k = 0; k < sizeof noise / sizeof noise[0]; k++) {
        ewa_feature_options options = default_options();
        options.noise = noise[k];
        ewa_feature_counts counts;
        assert_int_equal(ewa_cloud_detect_features(cloud, &options, &counts), EWA_OK);
        assert_int_equal(counts.neighbour_count, expected[k]);
    }
}

/// The lines near a step of so many spacings that runs across a crease, and how many of them are not where
/// their own side of the step has the edge.
static void count_at_step(double step, uint32_t *lines, uint32_t *moved) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_crease(context, 90, false);
    // The faces of the crease are tilted by half of a right angle; the spacing is 0.87.
    const double lift = step * 0.87 * sqrt(2);
    float *position = ewa_cloud_find(cloud, EWA_POSITION)->data;
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++)
        if (position[3 * i + 1] > SIDE / 2) position[3 * i + 2] += (float)lift;
    ewa_feature_options options = default_options();
    options.noise = 0;
    assert_int_equal(ewa_cloud_detect_features(cloud, &options, NULL), EWA_OK);
    const float *clip = check_stream(cloud, EWA_CLIP0);
    position = ewa_cloud_find(cloud, EWA_POSITION)->data;
    *lines = *moved = 0;
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        const double beyond = (double)position[3 * i + 1] - SIDE / 2;
        if (fabs(beyond) > 8 || !has_line(clip, i)) continue;
        double foot[3];
        line_in_world(cloud, clip, i, foot);
        *lines += 1;
        *moved += fabs(foot[2] - (beyond > 0 ? lift : 0)) > 0.02;
    }
    print_message("step of %g spacings: %u lines, %u moved\n", step, *lines, *moved);
}

/// Neighbours whose planes are less than 0.6 spacings apart have one edge, the mean of theirs; at a higher
/// step each side keeps its own.
TEST(test_steps) {
    static const double high[] = {0.7, 0.75, 0.8, 0.9};
    uint32_t lines, moved;
    count_at_step(0, &lines, &moved);
    assert_true(lines > 40 && moved == 0);
    count_at_step(0.56, &lines, &moved);
    assert_true(lines > 40 && moved > 12);
    for (size_t k = 0; k < sizeof high / sizeof high[0]; k++) {
        count_at_step(high[k], &lines, &moved);
        assert_true(lines > 40 && moved == 0);
    }
}

/// Squares that meet in the origin at right angles; returns how many points.
typedef enum corner_kind { CORNER_CUBE, CORNER_ROOM, CORNER_NOTCH } corner_kind;

static uint32_t make_corner(corner_kind kind, float *xyz, float *normals) {
    static const double axis[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const double west[3] = {-1, 0, 0}, south[3] = {0, -1, 0}, down[3] = {0, 0, -1},
                        origin[3] = {0, 0, 0};
    uint32_t count = 0;
    if (kind == CORNER_NOTCH) {
        // A solid below z = 0 without its quadrant x, y > 0: the top's surfels are bounded by either wall.
        count = add_square(origin, west, south, axis[2], 3, xyz, normals, count);
        count = add_square(origin, axis[0], south, axis[2], 4, xyz, normals, count);
        count = add_square(origin, west, axis[1], axis[2], 5, xyz, normals, count);
        count = add_square(origin, axis[1], down, axis[0], 6, xyz, normals, count);
        return add_square(origin, axis[0], down, axis[1], 7, xyz, normals, count);
    }
    for (int n = 0; n < 3; n++) {
        double normal[3] = {0};
        normal[n] = kind == CORNER_CUBE ? -1 : 1; // the solid is at positive places, or all around them
        count = add_square(origin, axis[(n + 1) % 3], axis[(n + 2) % 3], normal, (uint64_t)n + 3, xyz,
                           normals, count);
    }
    return count;
}

static void check_corner(corner_kind kind) {
    static float xyz[3 * MAXIMUM], normals[3 * MAXIMUM];
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    const uint32_t count = make_corner(kind, xyz, normals);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = without_borders(make_cloud(context, count, xyz, normals));
    const ewa_feature_options options = default_options();
    ewa_feature_counts counts;
    assert_int_equal(ewa_cloud_detect_features(cloud, &options, &counts), EWA_OK);
    const float *clip[2] = {check_stream(cloud, EWA_CLIP0), check_stream(cloud, EWA_CLIP1)};
    const float *normal = check_stream(cloud, EWA_NORMAL);
    const uint8_t *mode = ewa_cloud_find(cloud, EWA_CLIP_MODE)->data;
    uint32_t two = 0, either = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (!has_line(clip[1], i)) continue;
        two++;
        either += mode[i];
        assert_int_equal(mode[i], kind == CORNER_NOTCH && normal[3 * i + 2] > 0.9f);
        for (int k = 0; k < 2; k++) {
            double foot[3];
            line_in_world(cloud, clip[k], i, foot);
            int zeros = 0; // the lines are the axes
            for (int c = 0; c < 3; c++) zeros += fabs(foot[c]) < 0.05;
            assert_true(zeros >= 2);
            assert_true(mode[i] || clip[k][3 * i + 2] > -0.05f);
        }
    }
    print_message("corner %d: %u surfels with two lines, %u of them hold either\n", (int)kind, two, either);
    assert_true(two >= 3 && two == counts.corner_count);
    assert_true(kind != CORNER_NOTCH || either > 0);
}

TEST(test_corners) {
    for (int kind = CORNER_CUBE; kind <= CORNER_NOTCH; kind++) check_corner((corner_kind)kind);
}

/// Smooth objects have no edges, exact or noisy; their bytes stay.
TEST_ON(test_smooth, 0) {
    static const ewa_object objects[] = {EWA_OBJECT_PLANE, EWA_OBJECT_SPHERE, EWA_OBJECT_TORUS};
    for (int i = 0; i < 6; i++) {
        WITH_DEFAULTS(ewa_generate_options, generate);
        generate.object = objects[i / 2];
        generate.point_count = 20000;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
        assert_int_equal(ewa_cloud_generate(context, &generate, &cloud), EWA_OK);
        float *p = ewa_cloud_find(cloud, EWA_POSITION)->data;
        check_random random = {5};
        ewa_spacing spacing;
        assert_int_equal(ewa_cloud_measure_spacing(cloud, 0, &spacing), EWA_OK);
        const double noise = i % 2 ? 0.25 * sqrt(3) * spacing.median_world : 0;
        for (uint64_t j = 0; j < 3 * generate.point_count; j++)
            p[j] += (float)(noise * check_uniform(&random, -1, 1));
        const ewa_feature_options options = default_options();
        ewa_feature_counts counts;
        assert_int_equal(ewa_cloud_detect_features(cloud, &options, &counts), EWA_OK);
        print_message("object %d, noise %.3f: %llu clipped\n", (int)objects[i / 2], counts.noise,
                      (unsigned long long)(counts.edge_count + counts.corner_count));
        assert_int_equal(counts.snapped_count, 0);
        assert_non_null(ewa_cloud_find(cloud, EWA_RADIUS));
    }
}

TEST(test_threads) {
    static const uint32_t threads[] = {1, 2, 5};
    static const char *const names[] = {EWA_POSITION,  EWA_NORMAL, EWA_TANGENT_U,
                                        EWA_TANGENT_V, EWA_CLIP0,  EWA_CLIP1};
    ewa_cloud *first = NULL;
    ewa_context *contexts[3];
    for (int t = 0; t < 3; t++) {
        contexts[t] = check_context(threads[t], NULL);
        WITH_DEFAULTS(ewa_generate_options, generate);
        generate.object = EWA_OBJECT_CUBE;
        generate.point_count = 20000;
        ewa_cloud *cloud = NULL;
        assert_int_equal(ewa_cloud_generate(contexts[t], &generate, &cloud), EWA_OK);
        const ewa_feature_options options = default_options();
        assert_int_equal(ewa_cloud_detect_features(cloud, &options, NULL), EWA_OK);
        for (size_t i = 0; first && i < sizeof names / sizeof names[0]; i++)
            assert_memory_equal(check_stream(cloud, names[i]), check_stream(first, names[i]),
                                3 * sizeof(float) * generate.point_count);
        if (first)
            ewa_cloud_destroy(&cloud);
        else
            first = cloud;
    }
    ewa_cloud_destroy(&first);
    for (int t = 0; t < 3; t++) ewa_context_destroy(&contexts[t]);
}

/// Clouds of few points, of one place, on a line, and with coordinates that are not finite.
TEST_ON(test_odd_clouds, 2) {
    for (uint32_t count = 0; count < 90; count += count < 8 ? 1 : 27) {
        for (int kind = 0; kind < 3; kind++) {
            float *xyz;
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud(context, count, &xyz);
            for (uint32_t i = 0; i < 3 * count; i++)
                xyz[i] = kind == 0 ? 1 : kind == 1 ? (float)(i / 3) : (float)(i * 2654435761u % 1000);
            const ewa_estimate_options estimate = check_estimate_options();
            assert_int_equal(ewa_cloud_estimate(&cloud, &estimate), EWA_OK);
            const ewa_feature_options options = default_options();
            assert_int_equal(ewa_cloud_detect_features(cloud, &options, NULL), EWA_OK);
        }
    }
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_crease(context, 90, false);
    float *position = ewa_cloud_find(cloud, EWA_POSITION)->data,
          *normal = ewa_cloud_find(cloud, EWA_NORMAL)->data;
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i += 11)
        position[3 * i + i % 3] = i % 2 ? NAN : INFINITY;
    for (uint64_t i = 5; i < ewa_cloud_point_count(cloud); i += 30) normal[3 * i] = NAN;
    const ewa_feature_options options = default_options();
    ewa_feature_counts counts;
    assert_int_equal(ewa_cloud_detect_features(cloud, &options, &counts), EWA_OK);
    assert_true(counts.edge_count > 50);
    const float *clip = check_stream(cloud, EWA_CLIP0);
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i += 11) assert_false(has_line(clip, i));
}

/// Doubles stay doubles, borrowed memory is not written to, axes that are there keep their size.
TEST_ON(test_streams, 2) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_crease(context, 90, false);
    const uint64_t count = ewa_cloud_point_count(cloud);
    OWNED(check_free) double *position = malloc(3 * count * sizeof *position), *copy = malloc(3 * count * sizeof *copy);
    assert_non_null(position);
    assert_non_null(copy);
    ewa_attribute_read_f64(ewa_cloud_find(cloud, EWA_POSITION), 0, count, position);
    memcpy(copy, position, 3 * count * sizeof *copy);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F64, 3, position, 0), EWA_OK);
    ewa_estimate_options estimate = check_estimate_options();
    estimate.keep_radii = false;
    estimate.shape = EWA_SHAPE_ELLIPSE;
    assert_int_equal(ewa_cloud_estimate(&cloud, &estimate), EWA_OK);
    const ewa_feature_options options = default_options();
    ewa_feature_counts counts;
    assert_int_equal(ewa_cloud_detect_features(cloud, &options, &counts), EWA_OK);
    assert_true(counts.edge_count > 50);
    assert_int_equal(ewa_cloud_find(cloud, EWA_POSITION)->type, EWA_F64);
    assert_memory_equal(position, copy, 3 * count * sizeof *copy);
}

TEST(test_refusals) {
    check_log log = {{0}, 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_crease(context, 90, false);
    ewa_feature_options options = default_options();
    options.neighbour_count = 15;
    assert_int_equal(ewa_cloud_detect_features(cloud, &options, NULL), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log.text, "neighbour_count is 15"));
    options = default_options();
    options.angle_deg = 5;
    assert_int_equal(ewa_cloud_detect_features(cloud, &options, NULL), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log.text, "angle_deg is 5"));
    options = default_options();
    options.noise = NAN;
    assert_int_equal(ewa_cloud_detect_features(cloud, &options, NULL), EWA_ERROR_ARGUMENT);
    options = default_options();
    ewa_cloud_remove(cloud, EWA_NORMAL);
    assert_int_equal(ewa_cloud_detect_features(cloud, &options, NULL), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log.text, "normal"));
    assert_int_equal(ewa_cloud_detect_features(NULL, &options, NULL), EWA_ERROR_ARGUMENT);
}

/// A valley of its own, whose edge is found.
static ewa_status detect_work(ewa_context *context, void *user) {
    enum { COUNT = 700 };
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    float *positions = NULL, *normals = NULL, *radii = NULL;
    ewa_status status = ewa_cloud_create(context, COUNT, &cloud);
    if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, (void **)&positions);
    if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_NORMAL, EWA_F32, 3, (void **)&normals);
    if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, (void **)&radii);
    check_random random = {3};
    for (uint32_t i = 0; i < COUNT && status == EWA_OK; i++) {
        const double x = check_uniform(&random, -12, 12), y = check_uniform(&random, -12, 12);
        const float place[3] = {(float)x, (float)y, (float)fabs(x)};
        const float normal[3] = {x < 0 ? 0.7071f : -0.7071f, 0, 0.7071f};
        memcpy(positions + 3 * i, place, sizeof place);
        memcpy(normals + 3 * i, normal, sizeof normal);
        radii[i] = 1.2f;
    }
    ewa_feature_counts counts = {0};
    const ewa_feature_options options = default_options();
    if (status == EWA_OK) status = ewa_cloud_detect_features(cloud, &options, &counts);
    if (status == EWA_OK) *(uint64_t *)user = counts.edge_count;
    return status;
}

TEST(test_failing_allocations) {
    uint64_t edges = 0;
    scratch_fail_each(detect_work, &edges);
    assert_true(edges > 20);
}

/// Discs get axes where there are features; their borders become clip lines, which end the surface where it ended.
TEST_ON(test_borders_become_lines, 2) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_bordered_crease(context, 90, false);
    const uint64_t count = ewa_cloud_point_count(cloud);
    OWNED(check_free) float *ends = malloc(3 * count * sizeof *ends);
    assert_non_null(ends);
    memcpy(ends, check_stream(cloud, EWA_BORDER), 3 * count * sizeof *ends);
    const ewa_feature_options options = default_options();
    ewa_feature_counts counts;
    assert_int_equal(ewa_cloud_detect_features(cloud, &options, &counts), EWA_OK);
    assert_true(counts.edge_count > 50);
    assert_null(ewa_cloud_find(cloud, EWA_BORDER));
    const float *clip = check_stream(cloud, EWA_CLIP0), *position = check_stream(cloud, EWA_POSITION);
    uint64_t bordered = 0;
    for (uint64_t i = 0; i < count; i++) {
        const float *b = &ends[3 * i];
        if (fabsf(position[3 * i]) < 6 || (b[0] == 0 && b[1] == 0 && b[2] == 0)) continue;
        double foot[3], off = 0;
        assert_true(has_line(clip, i));
        line_in_world(cloud, clip, i, foot);
        for (int c = 0; c < 3; c++)
            off = fmax(off, fabs(foot[c] - (double)position[3 * i + (uint64_t)c] - (double)b[c]));
        assert_true(off < 1e-4);
        bordered++;
    }
    assert_true(bordered > 40);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
