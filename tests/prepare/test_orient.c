// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/estimate/orient.c and outliers.c: signs of normals against the truth, what outlier removal
// leaves.
#include "prepare/check_prepare.h"

enum { COUNT = 30000 };

static const double PI = 3.14159265358979323846;

typedef enum object {
    SPHERE,
    TORUS,
    TWO_SPHERES,
    CUBE,
    SHEET,
    NOISY_SPHERE,
    BOWL,
    SLAB,
    DROP,
    OBJECTS
} object;

static double normal_deviate(check_random *random) {
    double sum = -6;
    for (int i = 0; i < 12; i++) sum += check_uniform(random, 0, 1);
    return sum;
}

/// A point and the outward normal there.
static void make_point(object kind, uint32_t i, check_random *random, double p[3], double n[3]) {
    check_direction(random, n);
    for (int c = 0; c < 3; c++) p[c] = n[c];
    const double a = check_uniform(random, -PI, PI), u = check_uniform(random, -1, 1);
    const double v = check_uniform(random, -1, 1);
    double b;
    switch (kind) {
    case TORUS:
        do b = check_uniform(random, -PI, PI);
        while (check_uniform(random, 0, 1.3) > 1 + 0.3 * cos(b));
        n[0] = cos(a) * cos(b), n[1] = sin(a) * cos(b), n[2] = sin(b);
        p[0] = cos(a) * (1 + 0.3 * cos(b)), p[1] = sin(a) * (1 + 0.3 * cos(b)), p[2] = 0.3 * sin(b);
        break;
    case TWO_SPHERES:
        for (int c = 0; c < 3; c++) p[c] *= i % 3 ? 1 : 0.5;
        p[0] += i % 3 ? 0 : 1.6;
        break;
    case CUBE: {
        const uint32_t face = i % 6, axis = face / 2;
        for (uint32_t c = 0; c < 3; c++) n[c] = c == axis ? (face % 2 ? 1 : -1) : 0;
        p[axis] = n[axis];
        p[(axis + 1) % 3] = u, p[(axis + 2) % 3] = v;
        break;
    }
    case SHEET:
        p[0] = u, p[1] = v, p[2] = 0.2 * sin(4 * u) * cos(3 * v);
        n[0] = -0.8 * cos(4 * u) * cos(3 * v), n[1] = 0.6 * sin(4 * u) * sin(3 * v), n[2] = 1;
        break;
    case NOISY_SPHERE:
        for (int c = 0; c < 3; c++) p[c] += 0.004 * normal_deviate(random); // 0.2 spacings
        break;
    case BOWL:
        // Half a sphere seen from outside: open, but with an inside.
        if (n[0] < 0) n[0] = -n[0], p[0] = -p[0];
        break;
    case SLAB: {
        // Closed, but so flat that its volume alone would not tell.
        const bool side = check_uniform(random, 0, 1) < 0.05;
        const uint32_t axis = side ? i % 2 : 2;
        p[0] = u, p[1] = v, p[2] = 0.025 * check_uniform(random, -1, 1);
        for (uint32_t c = 0; c < 3; c++) n[c] = c == axis ? (i % 4 < 2 ? 1 : -1) : 0;
        p[axis] = n[axis] * (axis == 2 ? 0.025 : 1);
        break;
    }
    case DROP: {
        // A tube around the section of a drop, whose sharp edge of 23 degrees must not decide: a circle of
        // radius 0.4 at (2, 0) and its tangents through the origin.
        const double angle = asin(0.2), length = 2 * cos(angle), arc = 0.4 * (0.5 * PI + angle);
        const double along = check_uniform(random, 0, length + arc), sign = i % 2 ? 1 : -1;
        const double turn = 0.5 * PI + angle - fmax(along - length, 0) / 0.4;
        const double straight = fmin(along, length);
        n[0] = cos(turn), n[1] = 0, n[2] = sin(turn) * sign;
        p[0] = along < length ? straight * cos(angle) : 2 + 0.4 * n[0], p[1] = v;
        p[2] = along < length ? straight * sin(angle) * sign : 0.4 * n[2];
        break;
    }
    default:
        break;
    }
}

TEST_ON(test_propagation, 2) {
    for (int run = 0; run < 3 * OBJECTS; run++) {
        const int kind = run % OBJECTS;
        float *xyz = NULL;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud(context, COUNT, &xyz);
        double(*truth)[3] = calloc(COUNT, sizeof *truth);
        check_random random = {(uint64_t)run + 20};
        for (uint32_t i = 0; i < COUNT; i++) {
            double p[3];
            make_point((object)kind, i, &random, p, truth[i]);
            for (uint32_t c = 0; c < 3; c++) xyz[3 * i + c] = (float)p[c];
        }
        ewa_estimate_options options = check_estimate_options();
        assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
        const float *normal = check_stream(cloud, EWA_NORMAL);
        uint32_t agree = 0;
        for (uint32_t i = 0; i < COUNT; i++) {
            double cosine = 0;
            for (uint32_t c = 0; c < 3; c++) cosine += truth[i][c] * (double)normal[3 * i + c];
            // Near the edge of the drop a neighbourhood holds both sides, and no side is right.
            const bool ambiguous = kind == DROP && xyz[3 * i] < 0.25f;
            agree += ambiguous || cosine > 0;
        }
        assert_true(agree > 0.999 * COUNT);
        free(truth);
    }
}

TEST_ON(test_viewpoint_and_none, 2) {
    for (int none = 0; none < 2; none++) {
        float *xyz = NULL;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud(context, COUNT, &xyz);
        check_random random = {2};
        for (uint32_t i = 0; i < COUNT; i++) {
            double d[3];
            check_direction(&random, d);
            for (uint32_t c = 0; c < 3; c++) xyz[3 * i + c] = (float)d[c];
        }
        const double origin[3] = {1000, 0, 0};
        ewa_cloud_set_origin(cloud, origin);
        ewa_estimate_options options = check_estimate_options();
        options.shape = EWA_SHAPE_ELLIPSE;
        options.orientation = none ? EWA_ORIENT_NONE : EWA_ORIENT_VIEWPOINT;
        options.viewpoint_world[0] = 1003;
        assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
        const float *normal = check_stream(cloud, EWA_NORMAL);
        const float *u = check_stream(cloud, EWA_TANGENT_U), *v = check_stream(cloud, EWA_TANGENT_V);
        for (uint32_t i = 0; i < COUNT; i++) {
            const float *n = &normal[3 * i], *p = &xyz[3 * i], *a = &u[3 * i], *b = &v[3 * i];
            const float towards = (3 - p[0]) * n[0] - p[1] * n[1] - p[2] * n[2];
            float largest = 0;
            for (int c = 0; c < 3; c++)
                if (fabsf(n[c]) > fabsf(largest)) largest = n[c];
            if (none)
                assert_true(largest > 0);
            else
                assert_true(towards >= 0);
            const float volume = n[0] * (a[1] * b[2] - a[2] * b[1]) + n[1] * (a[2] * b[0] - a[0] * b[2]) +
                                 n[2] * (a[0] * b[1] - a[1] * b[0]);
            assert_true(volume > 0);
        }
    }
}

/// A random sphere around the origin of a cloud whose origin is at x = 1000.
static ewa_cloud *make_sphere(ewa_context *context, float **xyz) {
    ewa_cloud *cloud = check_cloud(context, COUNT, xyz);
    check_random random = {2};
    for (uint32_t i = 0; i < COUNT; i++) {
        double d[3];
        check_direction(&random, d);
        for (uint32_t c = 0; c < 3; c++) (*xyz)[3 * i + c] = (float)d[c];
    }
    const double origin[3] = {1000, 0, 0};
    ewa_cloud_set_origin(cloud, origin);
    return cloud;
}

/// Counts the points whose estimated normal is turned away from a place, that of their scan, or downwards.
static uint32_t count_turned(ewa_cloud **cloud, const double (*seen_from)[3], const uint16_t *scan) {
    const ewa_estimate_options options = check_estimate_options();
    assert_int_equal(ewa_cloud_estimate(cloud, &options), EWA_OK);
    const float *normal = check_stream(*cloud, EWA_NORMAL), *xyz = check_stream(*cloud, EWA_POSITION);
    uint32_t turned = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        double towards = seen_from ? 0 : (double)normal[3 * i + 2];
        for (uint32_t c = 0; c < 3 && seen_from; c++)
            towards +=
                (seen_from[scan ? scan[i] : 0][c] - (double)xyz[3 * i + c]) * (double)normal[3 * i + c];
        turned += towards < 0;
    }
    return turned;
}

/// Scanners decide before returns do, and returns before the shape does.
TEST_ON(test_what_the_cloud_knows, 2) {
    static const char *const notes[] = {"1003 0 0\n997 0 0\n", "1003 0 0", NULL, "1003 0", "here"};
    static const double seen_from[2][3] = {{3, 0, 0}, {-3, 0, 0}};
    for (size_t k = 0; k < sizeof notes / sizeof *notes; k++) {
        float *xyz = NULL;
        void *returns = NULL, *scan = NULL;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_sphere(context, &xyz);
        assert_int_equal(ewa_cloud_add(cloud, "return_number", EWA_U8, 1, &returns), EWA_OK);
        memset(returns, 1, COUNT);
        if (k == 0) {
            assert_int_equal(ewa_cloud_add(cloud, "scan", EWA_U16, 1, &scan), EWA_OK);
            for (uint32_t i = 0; i < COUNT; i++) ((uint16_t *)scan)[i] = i % 2;
        }
        if (notes[k])
            assert_int_equal(ewa_cloud_set_note(cloud, "scanners", notes[k], strlen(notes[k])), EWA_OK);
        assert_int_equal(count_turned(&cloud, k < 2 ? seen_from : NULL, scan), 0);
    }
}

/// The limit by its definition: over the mean of all mean distances to 16 neighbours plus so many of their
/// deviations.
TEST_ON(test_outlier_limit, 2) {
    enum { OUTLIER_POINTS = 1200, K = 16 };
    static const double factors[] = {0.3, 1, 2.5};
    static double distance[OUTLIER_POINTS];
    for (size_t f = 0; f < sizeof factors / sizeof *factors; f++) {
        float *xyz = NULL;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud(context, OUTLIER_POINTS, &xyz);
        check_random random = {31 + f};
        for (uint32_t i = 0; i < 3 * OUTLIER_POINTS; i++) {
            const double u = check_uniform(&random, -1, 1);
            xyz[i] = (float)(i % 3 == 2 ? 0.1 * u : u * u * u);
        }
        double mean = 0, variance = 0;
        for (uint32_t i = 0; i < OUTLIER_POINTS; i++) {
            double nearest[K + 1], sum = 0;
            uint32_t held = 0;
            for (uint32_t j = 0; j < OUTLIER_POINTS; j++) {
                double d2 = 0;
                for (uint32_t c = 0; c < 3; c++)
                    d2 += pow((double)xyz[3 * i + c] - (double)xyz[3 * j + c], 2);
                if (held == K + 1 && d2 >= nearest[K]) continue;
                uint32_t to = held < K + 1 ? held++ : K;
                for (; to > 0 && nearest[to - 1] > d2; to--) nearest[to] = nearest[to - 1];
                nearest[to] = d2;
            }
            for (uint32_t k = 1; k <= K; k++) sum += sqrt(nearest[k]);
            distance[i] = sum / K;
            mean += distance[i] / OUTLIER_POINTS;
        }
        for (uint32_t i = 0; i < OUTLIER_POINTS; i++) variance += pow(distance[i] - mean, 2) / OUTLIER_POINTS;
        const double limit = mean + factors[f] * sqrt(variance);
        float kept[3 * OUTLIER_POINTS];
        uint32_t kept_count = 0;
        for (uint32_t i = 0; i < OUTLIER_POINTS; i++) {
            assert_true(fabs(distance[i] - limit) > 1e-6 * limit);
            if (distance[i] <= limit) memcpy(&kept[3 * kept_count++], &xyz[3 * i], 3 * sizeof *kept);
        }
        assert_in_range(kept_count, OUTLIER_POINTS / 2, OUTLIER_POINTS - 10);
        ewa_estimate_options options = check_estimate_options();
        options.outlier_factor = factors[f];
        assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
        assert_int_equal(ewa_cloud_point_count(cloud), kept_count);
        assert_memory_equal(check_stream(cloud, EWA_POSITION), kept, 3 * kept_count * sizeof *kept);
    }
}

TEST_ON(test_outliers, 2) {
    float *xyz = NULL;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud(context, COUNT, &xyz);
    uint16_t *label = check_add(cloud, "label", EWA_U16, 1);
    double *precise = check_add(cloud, "precise", EWA_F64, 2);
    struct record {
        uint8_t unused, color[3];
    } *records = calloc(COUNT, sizeof *records);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_COLOR, EWA_U8, 3, records[0].color, sizeof *records),
                     EWA_OK);
    check_random random = {3};
    uint32_t far = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        double d[3];
        check_direction(&random, d);
        const bool outlier = i % 300 == 0, broken = i % 5000 == 11;
        far += outlier || broken;
        for (uint32_t c = 0; c < 3; c++)
            xyz[3 * i + c] = (float)(d[c] * (outlier ? check_uniform(&random, 2, 5) : 1));
        if (broken) xyz[3 * i + 1] = NAN;
        label[i] = (uint16_t)i;
        precise[2 * i] = i, precise[2 * i + 1] = 0.25 * i;
        records[i].color[1] = (uint8_t)i;
    }
    const double origin[3] = {1, 2, 3};
    ewa_cloud_set_origin(cloud, origin);
    ewa_estimate_options options = check_estimate_options();
    options.outlier_factor = 2;
    assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
    const uint64_t left = ewa_cloud_point_count(cloud);
    assert_in_range(left, COUNT - far - COUNT / 100, COUNT - far);
    const float *position = check_stream(cloud, EWA_POSITION);
    const uint16_t *labels = ewa_cloud_find(cloud, "label")->data;
    const double *precises = ewa_cloud_find(cloud, "precise")->data;
    const ewa_attribute *color = ewa_cloud_find(cloud, EWA_COLOR);
    for (uint64_t i = 0; i < left; i++) {
        const float *p = &position[3 * i];
        assert_true(fabsf(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] - 1) < 1e-5f);
        if (i) assert_true(labels[i] > labels[i - 1]);
        assert_true(precises[2 * i] == labels[i] && precises[2 * i + 1] == 0.25 * labels[i]);
        uint8_t rgb[3];
        memcpy(rgb, (const char *)color->data + i * color->stride_bytes, sizeof rgb);
        assert_int_equal(rgb[1], (uint8_t)labels[i]);
    }
    double kept_origin[3];
    ewa_cloud_origin(cloud, kept_origin);
    assert_memory_equal(kept_origin, origin, sizeof origin);
    free(records);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
