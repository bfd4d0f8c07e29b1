// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Solid textures: means under footprints against numerical quadrature, what is left of high frequencies, the
// colours of clouds.
#include "check_generated.h"
#include "check_prepare.h"
#include "colors/pattern.h"
#include "io/scratch.h"

static double checker_at(ewa_vec3 p) {
    const double cells = floor(p.x) + floor(p.y) + floor(p.z);
    return cells - 2 * floor(cells / 2) == 0 ? 1 : -1;
}

/// A random footprint in the plane across a random direction: standard deviations `narrow` and `wide`.
static pattern_footprint random_footprint(check_random *random, double narrow, double wide) {
    double d[3], e[3];
    check_direction(random, d);
    check_direction(random, e);
    ewa_vec3 u = vec3_cross(vec3_load(d), vec3_load(e)), v = vec3_cross(vec3_load(d), u);
    vec3_normalize(&u);
    vec3_normalize(&v);
    double center[3];
    check_uniform3(random, -9, 9, center);
    return (pattern_footprint){vec3_load(center), vec3_scale(u, narrow), vec3_scale(v, wide)};
}

/// The mean of a function under a footprint by a fine grid.
static double quadrature(double (*function)(ewa_vec3 p, const void *user), const void *user,
                         const pattern_footprint *footprint, int steps) {
    double sum = 0, weights = 0;
    for (int j = -steps; j < steps; j++)
        for (int i = -steps; i < steps; i++) {
            const double s = 5 * (i + 0.5) / steps, t = 5 * (j + 0.5) / steps,
                         weight = exp(-0.5 * (s * s + t * t));
            const ewa_vec3 at = vec3_add(footprint->place,
                                         vec3_add(vec3_scale(footprint->u, s), vec3_scale(footprint->v, t)));
            sum += weight * function(at, user);
            weights += weight;
        }
    return sum / weights;
}

static double checker_value(ewa_vec3 p, const void *user) {
    (void)user;
    return checker_at(p);
}

/// Round and elongated footprints of all sizes, across and along the axes too.
TEST(test_checker_means) {
    check_random random = {31};
    const double sizes[][2] = {{0.02, 0.02}, {0.2, 0.2},  {0.4, 0.4}, {0.7, 0.7}, {0.79, 3},
                               {0.2, 0.8},   {0.85, 0.9}, {1.2, 1.2}, {2, 2},     {0.9, 3}};
    double worst = 0;
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
        for (int trial = 0; trial < 6; trial++) {
            pattern_footprint footprint = random_footprint(&random, sizes[k][0], sizes[k][1]);
            if (trial == 0) {
                footprint.u = vec3_make(sizes[k][0], 0, 0);
                footprint.v = vec3_make(0, sizes[k][1], 0);
            } else if (trial == 1) { // a plane that keeps a mean of its own
                const double a = sizes[k][0] / sqrt(2), b = sizes[k][1] / sqrt(6);
                footprint.u = vec3_make(a, -a, 0);
                footprint.v = vec3_make(b, b, -2 * b);
            }
            const double truth = quadrature(checker_value, NULL, &footprint, 300);
            const double mean = ewa_pattern_checker(&footprint);
            worst = fmax(worst, fabs(mean - truth));
        }
    print_message("largest error of the checker's mean: %.2g of [-1, 1]\n", worst);
    assert_true(worst < 0.012);
}

static double pattern_value(ewa_vec3 p, const void *user) {
    const pattern_footprint point = {.place = p};
    return ewa_pattern_mean(user, &point);
}

static pattern make_pattern(ewa_procedure procedure, double frequency) {
    ewa_procedure_options options;
    ewa_procedure_options_init(&options, procedure, sizeof options);
    options.frequency = frequency;
    pattern made;
    ewa_pattern_make(&options, &made);
    return made;
}

/// Noise is exact where it is not clamped to [0, 1]; bands bent by noise are near, root mean square over
/// places, at every size.
TEST(test_wave_means) {
    const struct {
        ewa_procedure procedure;
        double rms;
    } rows[] = {{EWA_PROCEDURE_NOISE, 1e-3}, {EWA_PROCEDURE_MARBLE, 0.04}, {EWA_PROCEDURE_WOOD, 0.04}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        const pattern texture = make_pattern(rows[r].procedure, 1);
        check_random random = {37};
        for (double sigma = 0.02; sigma < 1; sigma *= 3) {
            double square = 0;
            for (int trial = 0; trial < 12; trial++) {
                const pattern_footprint footprint = random_footprint(&random, sigma, sigma);
                const double mean = ewa_pattern_mean(&texture, &footprint);
                if (mean < 0.2 || mean > 0.8) continue;
                const double error = mean - quadrature(pattern_value, &texture, &footprint, 30);
                square += error * error / 12;
            }
            print_message("procedure %d, deviation %.2f: error %.2g\n", (int)rows[r].procedure, sigma,
                          sqrt(square));
            assert_true(sqrt(square) < rows[r].rms);
        }
    }
}

/// Whatever the frequency, what is too fine becomes the mean of the texture, everywhere.
TEST(test_high_frequency) {
    for (int procedure = EWA_PROCEDURE_CHECKER; procedure <= EWA_PROCEDURE_NOISE; procedure++) {
        check_random random = {41};
        const pattern texture = make_pattern((ewa_procedure)procedure, 1);
        double mean = 0;
        const int count = 40000;
        for (int i = 0; i < count; i++) {
            const ewa_vec3 at = {check_uniform(&random, -90, 90), check_uniform(&random, -90, 90),
                                 check_uniform(&random, -90, 90)};
            mean += pattern_value(at, &texture) / count;
        }
        for (double frequency = 300; frequency < 1e9; frequency *= 31.4) {
            const pattern fine = make_pattern((ewa_procedure)procedure, frequency);
            for (int trial = 0; trial < 50; trial++) {
                const pattern_footprint footprint = random_footprint(&random, 0.1, 0.1);
                assert_true(fabs(ewa_pattern_mean(&fine, &footprint) - mean) < 0.04);
            }
        }
    }
}

static ewa_cloud *sphere(ewa_context *context, uint64_t count) {
    ewa_cloud *cloud = check_object(context, EWA_OBJECT_SPHERE, count);
    return cloud;
}

/// The same bytes for any number of threads; a disc and its axes give the same colours; the seed matters.
TEST(test_clouds) {
    OWNED(ewa_context_destroy) ewa_context *one = check_context(1, NULL), *many = check_context(7, NULL);
    for (int procedure = EWA_PROCEDURE_CHECKER; procedure <= EWA_PROCEDURE_NOISE; procedure++) {
        ewa_procedure_options options;
        ewa_procedure_options_init(&options, (ewa_procedure)procedure, sizeof options);
        OWNED(ewa_cloud_destroy) ewa_cloud *a = sphere(one, 5000), *b = sphere(many, 5000);
        assert_int_equal(ewa_cloud_color_by_procedure(a, &options), EWA_OK);
        assert_int_equal(ewa_cloud_color_by_procedure(b, &options), EWA_OK);
        const ewa_attribute *color = ewa_cloud_find(a, EWA_COLOR);
        assert_int_equal(color->type, EWA_U8);
        assert_int_equal(color->component_count, 3);
        assert_memory_equal(color->data, ewa_cloud_find(b, EWA_COLOR)->data, 3 * 5000);

        const float *normal = check_stream(b, EWA_NORMAL), *radius = check_stream(b, EWA_RADIUS);
        float *u = check_add(b, EWA_TANGENT_U, EWA_F32, 3);
        float *v = check_add(b, EWA_TANGENT_V, EWA_F32, 3);
        for (uint64_t i = 0; i < 5000; i++) {
            const ewa_vec3 n = {(double)normal[3 * i], (double)normal[3 * i + 1], (double)normal[3 * i + 2]};
            ewa_vec3 p = vec3_cross(n, vec3_make(0.3, -0.8, 0.52));
            vec3_normalize(&p);
            const ewa_vec3 q = vec3_cross(n, p);
            const double sigma = (double)radius[i] / 3;
            u[3 * i] = (float)(p.x * sigma), u[3 * i + 1] = (float)(p.y * sigma),
                  u[3 * i + 2] = (float)(p.z * sigma);
            v[3 * i] = (float)(q.x * sigma), v[3 * i + 1] = (float)(q.y * sigma),
                  v[3 * i + 2] = (float)(q.z * sigma);
        }
        assert_int_equal(ewa_cloud_color_by_procedure(b, &options), EWA_OK);
        const uint8_t *x = ewa_cloud_find(a, EWA_COLOR)->data, *y = ewa_cloud_find(b, EWA_COLOR)->data;
        for (int i = 0; i < 15000; i++) assert_true(abs(x[i] - y[i]) <= 2);

        options.seed = 2;
        assert_int_equal(ewa_cloud_color_by_procedure(b, &options), EWA_OK);
        y = ewa_cloud_find(b, EWA_COLOR)->data;
        if (procedure != EWA_PROCEDURE_CHECKER) assert_true(memcmp(x, y, 15000) != 0);
    }
}

/// Without a filter points have the texture's own two colours; alpha stays; the origin counts; what is no
/// number is the mean.
TEST_ON(test_values, 0) {
    float *xyz;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud(context, 3, &xyz);
    const float at[] = {0.25f, 0.25f, 0.25f, 1.25f, 0.25f, 0.25f, NAN, 0, 0};
    memcpy(xyz, at, sizeof at);
    uint16_t *alpha = check_add(cloud, EWA_COLOR, EWA_U16, 4);
    for (int i = 0; i < 12; i++) alpha[i] = (uint16_t)(i * 5000);
    ewa_procedure_options options;
    ewa_procedure_options_init(&options, EWA_PROCEDURE_CHECKER, sizeof options);
    options.frequency = 1;
    options.prefilter = 0;
    for (int c = 0; c < 3; c++) options.colors[0][c] = 1, options.colors[1][c] = 0;
    assert_int_equal(ewa_cloud_color_by_procedure(cloud, &options), EWA_OK);
    const ewa_attribute *color = ewa_cloud_find(cloud, EWA_COLOR);
    assert_int_equal(color->component_count, 4);
    const uint8_t expected[] = {255, 255, 255, 58, 0, 0, 0, 136, 188, 188, 188, 214};
    assert_memory_equal(color->data, expected, sizeof expected);
    ewa_cloud_set_origin(cloud, (double[3]){1, 0, 0});
    assert_int_equal(ewa_cloud_color_by_procedure(cloud, &options), EWA_OK);
    color = ewa_cloud_find(cloud, EWA_COLOR);
    assert_int_equal(((const uint8_t *)color->data)[0], 0);
    assert_int_equal(((const uint8_t *)color->data)[4], 255);
}

TEST_LOGGED(test_arguments, 1) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = sphere(context, 10);
    const struct {
        const char *says;
        double frequency, prefilter, cutoff;
        float first;
        int procedure;
    } rows[] = {
        {"procedure is 4", 1, 1, 3, 0, 4},     {"frequency is 0", 0, 1, 3, 0, 1},
        {"frequency is nan", NAN, 1, 3, 0, 1}, {"prefilter is -1", 1, -1, 3, 0, 1},
        {"cutoff is 5", 1, 1, 5, 0, 1},        {"colors[1] is 2", 1, 1, 3, 2, 1},
    };
    ewa_procedure_options options;
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        ewa_procedure_options_init(&options, (ewa_procedure)rows[r].procedure, sizeof options);
        options.frequency = rows[r].frequency;
        options.prefilter = rows[r].prefilter;
        options.cutoff = rows[r].cutoff;
        options.colors[0][1] = rows[r].first;
        assert_int_equal(ewa_cloud_color_by_procedure(cloud, &options), EWA_ERROR_ARGUMENT);
        assert_non_null(strstr(log->text, rows[r].says));
    }
    ewa_procedure_options_init(&options, EWA_PROCEDURE_WOOD, sizeof options);
    ewa_cloud_remove(cloud, EWA_NORMAL);
    assert_int_equal(ewa_cloud_color_by_procedure(cloud, &options), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "a prefilter needs 'normal' and 'radius'"));
    ewa_cloud_remove(cloud, EWA_POSITION);
    assert_int_equal(ewa_cloud_color_by_procedure(cloud, &options), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "no 'position'"));
}

static ewa_status color_points(ewa_context *context, void *user) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    float *xyz;
    ewa_status status = ewa_cloud_create(context, *(const uint64_t *)user, &cloud);
    if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, (void **)&xyz);
    if (status == EWA_OK) {
        memset(xyz, 0, ewa_cloud_point_count(cloud) * sizeof(float[3]));
        ewa_procedure_options options;
        ewa_procedure_options_init(&options, EWA_PROCEDURE_CHECKER, sizeof options);
        options.prefilter = 0;
        status = ewa_cloud_color_by_procedure(cloud, &options);
        assert_true((ewa_cloud_find(cloud, EWA_COLOR) != NULL) == (status == EWA_OK));
    }
    return status;
}

/// The default colours are those of the table in docs/colors.md.
TEST(test_default_colors) {
    static const char *const names[] = {"checker", "marble", "wood", "noise"};
    char path[512], line[512], name[32];
    snprintf(path, sizeof path, "%s/docs/colors.md", getenv("EWA_SOURCE_DIR"));
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    int found = 0;
    while (fgets(line, sizeof line, file)) {
        float colors[2][3];
        if (sscanf(line, "| %31s | %f,%f,%f | %f,%f,%f |", name, &colors[0][0], &colors[0][1], &colors[0][2],
                   &colors[1][0], &colors[1][1], &colors[1][2]) != 7)
            continue;
        assert_true(found < 4);
        assert_string_equal(name, names[found]);
        ewa_procedure_options options;
        ewa_procedure_options_init(&options, (ewa_procedure)found, sizeof options);
        assert_memory_equal(options.colors, colors, sizeof colors);
        found++;
    }
    fclose(file);
    assert_int_equal(found, 4);
}

TEST(test_cancel_and_memory) {
    uint64_t count = 100;
    scratch_fail_each(color_points, &count);
    count = 600000;
    assert_int_equal(check_cancel_each("procedure", color_points, &count), 4);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
