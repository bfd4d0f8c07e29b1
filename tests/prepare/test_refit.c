// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours as coefficients: what the reconstruction shows at the points, what stays as it is, pictures against
// the texture, bad clouds.
#include "check_prepare.h"
#include "io/scratch.h"
#include "quality/refit_scene.h"
#include "reference/surface.h"

static ewa_refit_options options_of(ewa_refit goal) {
    WITH_DEFAULTS(ewa_refit_options, options);
    options.goal = goal;
    return options;
}

static ewa_cloud *generate(ewa_context *context, ewa_object object, uint64_t count, bool sharp) {
    WITH_DEFAULTS(ewa_generate_options, options);
    options.object = object;
    options.point_count = count;
    options.radius_scale = 1.5;
    options.sharp = sharp;
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_generate(context, &options, &cloud), EWA_OK);
    return cloud;
}

/// Replaces the colours by random linear ones of `components` floats.
static float *random_colors(ewa_cloud *cloud, uint32_t components) {
    float *color = check_add(cloud, EWA_COLOR, EWA_F32, components);
    check_random random = {23};
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud) * components; i++)
        color[i] = (float)check_uniform(&random, 0, 1);
    return color;
}

/// The blend of kernels at point i of a plane of discs, component c, by brute force.
static double blend_at(const ewa_cloud *cloud, uint64_t i, uint64_t c) {
    const float *p = check_stream(cloud, EWA_POSITION), *radius = check_stream(cloud, EWA_RADIUS),
                *color = check_stream(cloud, EWA_COLOR);
    double sum = 0, weights = 0;
    for (uint64_t k = 0; k < ewa_cloud_point_count(cloud); k++) {
        const double x = (double)p[3 * k] - (double)p[3 * i], y = (double)p[3 * k + 1] - (double)p[3 * i + 1],
                     r2 = 9 * (x * x + y * y) / ((double)radius[k] * (double)radius[k]);
        if (r2 >= 9) continue;
        sum += exp(-r2 / 2) * (double)color[3 * k + c];
        weights += exp(-r2 / 2);
    }
    return sum / weights;
}

/// Interpolation gives the points their colours, a fit comes nearer; the report says by how much.
TEST_ON(test_reconstruction, 0) {
    for (int goal = EWA_REFIT_INTERPOLATE; goal <= EWA_REFIT_FIT; goal++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = generate(context, EWA_OBJECT_PLANE, 900, false);
        const uint64_t count = ewa_cloud_point_count(cloud);
        const float *color = random_colors(cloud, 3);
        OWNED(check_free) float *wanted = malloc(3 * count * sizeof *wanted);
        assert_non_null(wanted);
        memcpy(wanted, color, 3 * count * sizeof *wanted);
        double before = 0, after = 0;
        for (uint64_t i = 0; i < 3 * count; i++)
            before += pow(blend_at(cloud, i / 3, i % 3) - (double)wanted[i], 2) / (3 * (double)count);
        const ewa_refit_options options = options_of((ewa_refit)goal);
        ewa_refit_report report;
        assert_int_equal(ewa_cloud_refit_colors(cloud, &options, &report), EWA_OK);
        for (uint64_t i = 0; i < 3 * count; i++)
            after += pow(blend_at(cloud, i / 3, i % 3) - (double)wanted[i], 2) / (3 * (double)count);
        assert_true(fabs(report.before_rms - sqrt(before)) < 1e-6);
        assert_true(fabs(report.after_rms - sqrt(after)) < 1e-6);
        assert_true(sqrt(before) > 0.1);
        assert_true(sqrt(after) < (goal == EWA_REFIT_INTERPOLATE ? 0.01 : 0.5) * sqrt(before));
        assert_int_equal(report.surfel_count, count);
        assert_int_equal(report.left_out_count, 0);
        assert_true(report.low < 0 && report.high > 1);
    }
}

/// Colours that do not change over the surface stay what they are, and alpha always does; one face of a sharp
/// cube does not see the next one.
TEST_ON(test_constant, 0) {
    for (int sharp = 0; sharp < 2; sharp++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = generate(context, EWA_OBJECT_CUBE, 3000, sharp);
        const uint64_t count = ewa_cloud_point_count(cloud);
        const float *normal = check_stream(cloud, EWA_NORMAL);
        uint8_t *color = check_add(cloud, EWA_COLOR, EWA_U8, 4);
        for (uint64_t i = 0; i < count; i++) {
            for (uint64_t c = 0; c < 3; c++) color[4 * i + c] = (uint8_t)(128 + 80 * normal[3 * i + c]);
            color[4 * i + 3] = (uint8_t)(i % 256);
        }
        OWNED(ewa_cloud_destroy) ewa_cloud *copy = NULL;
        assert_int_equal(ewa_cloud_merge((const ewa_cloud *[]){cloud}, 1, &copy), EWA_OK);
        assert_int_equal(ewa_cloud_refit_colors(cloud, NULL, NULL), EWA_OK);
        const ewa_attribute *made = ewa_cloud_find(cloud, EWA_COLOR);
        assert_int_equal(made->type, EWA_F32);
        assert_int_equal(made->component_count, 4);
        const uint8_t *old = ewa_cloud_find(copy, EWA_COLOR)->data;
        for (uint64_t i = 0; i < count; i++) {
            const float *rgba = (const float *)made->data + 4 * i;
            for (uint64_t c = 0; c < 3; c++) {
                const double code = old[4 * i + c] / 255.0,
                             linear = code <= 0.04045 ? code / 12.92 : pow((code + 0.055) / 1.055, 2.4);
                assert_true(fabs((double)rgba[c] - linear) < 1e-6);
            }
            assert_true(rgba[3] == (float)(old[4 * i + 3] / 255.0));
        }
    }
}

/// The same bytes for any number of threads.
TEST(test_threads) {
    OWNED(check_free) float *first = NULL;
    const uint32_t threads[] = {1, 2, 7};
    for (int t = 0; t < 3; t++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(threads[t], NULL);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = generate(context, EWA_OBJECT_TORUS, 20000, false);
        random_colors(cloud, 3);
        assert_int_equal(ewa_cloud_refit_colors(cloud, NULL, NULL), EWA_OK);
        const size_t bytes = ewa_cloud_point_count(cloud) * sizeof(float[3]);
        if (!first) {
            first = malloc(bytes);
            assert_non_null(first);
            memcpy(first, check_stream(cloud, EWA_COLOR), bytes);
        }
        assert_memory_equal(first, check_stream(cloud, EWA_COLOR), bytes);
    }
}

/// Points at one place with different colours, places covered by hundreds of kernels, points that are no
/// surfels, colours that are no numbers: everything stays finite and bounded.
TEST_ON(test_bad_points, 0) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = generate(context, EWA_OBJECT_PLANE, 2000, false);
    float *position = (float *)ewa_cloud_find(cloud, EWA_POSITION)->data,
          *radius = (float *)ewa_cloud_find(cloud, EWA_RADIUS)->data, *color = random_colors(cloud, 3);
    memcpy(position + 3, position, sizeof(float[3]));
    for (uint64_t i = 1000; i < 1400; i++) memcpy(position + 3 * i, position + 3 * 1000, sizeof(float[3]));
    position[3 * 20] = NAN;
    radius[21] = 0;
    radius[22] = INFINITY;
    color[3 * 30] = NAN;
    const float kept[3] = {color[3 * 21], color[3 * 21 + 1], color[3 * 21 + 2]};
    ewa_refit_report report;
    assert_int_equal(ewa_cloud_refit_colors(cloud, NULL, &report), EWA_OK);
    assert_int_equal(report.surfel_count, 1997);
    assert_in_range(report.left_out_count, 400, 450);
    const float *made = check_stream(cloud, EWA_COLOR);
    for (uint64_t i = 0; i < 3 * ewa_cloud_point_count(cloud); i++) assert_true(fabsf(made[i]) < 40);
    for (int c = 0; c < 3; c++) assert_true(made[3 * 21 + c] == kept[c]);
}

/// What is missing or out of range is named, and the cloud stays as it was.
TEST_LOGGED(test_arguments, 1) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = generate(context, EWA_OBJECT_PLANE, 100, false);
    ewa_refit_options options = options_of((ewa_refit)7);
    assert_int_equal(ewa_cloud_refit_colors(cloud, &options, NULL), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "goal is 7"));
    options = options_of(EWA_REFIT_FIT);
    options.cutoff = NAN;
    assert_int_equal(ewa_cloud_refit_colors(cloud, &options, NULL), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "cutoff is nan"));
    options.struct_size = 1;
    assert_int_equal(ewa_cloud_refit_colors(cloud, &options, NULL), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "struct_size is 1"));
    assert_int_equal(ewa_cloud_refit_colors(NULL, NULL, NULL), EWA_ERROR_ARGUMENT);
    ewa_cloud_remove(cloud, EWA_RADIUS);
    assert_int_equal(ewa_cloud_refit_colors(cloud, NULL, NULL), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "refit: 'position' is needed with 'normal' and 'radius'"));
    assert_int_equal(ewa_cloud_find(cloud, EWA_COLOR)->type, EWA_U8);
    ewa_cloud_remove(cloud, EWA_COLOR);
    assert_int_equal(ewa_cloud_refit_colors(cloud, NULL, NULL), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "no 'color'"));
}

static ewa_status refit_plane(ewa_context *context, void *user) {
    float *xyz, *normal, *radius;
    const uint64_t count = 400;
    (void)user;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    uint8_t *color;
    ewa_status status = ewa_cloud_create(context, count, &cloud);
    if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, (void **)&xyz);
    if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_NORMAL, EWA_F32, 3, (void **)&normal);
    if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, (void **)&radius);
    if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, (void **)&color);
    if (status == EWA_OK) {
        for (uint64_t i = 0; i < count; i++) {
            memcpy(xyz + 3 * i, (float[3]){(float)(i % 20), (float)(i / 20), 0}, sizeof(float[3]));
            memcpy(normal + 3 * i, (float[3]){0, 0, 1}, sizeof(float[3]));
            radius[i] = 1.5f;
            memset(color + 3 * i, (int)(i * 7919 % 256), 3);
        }
        status = ewa_cloud_refit_colors(cloud, NULL, NULL);
        assert_int_equal(ewa_cloud_find(cloud, EWA_COLOR)->type, status == EWA_OK ? EWA_F32 : EWA_U8);
    }
    return status;
}

TEST(test_cancel_and_memory) {
    scratch_fail_each(refit_plane, NULL);
    assert_true(check_cancel_each("refit", refit_plane, NULL) > 5);
}

/// What the solver reports, from its first step on.
typedef struct solver_progress {
    int count;
    double last, longest; ///< the longest way between two reports before the last one, which is 1
} solver_progress;

static bool note_progress(void *user, const char *stage, double fraction) {
    solver_progress *progress = user;
    (void)stage;
    if (fraction >= 0.3 && fraction < 1) {
        if (progress->count++) progress->longest = fmax(progress->longest, fraction - progress->last);
        progress->last = fraction;
    }
    return true;
}

/// The steps end at a share of the first gradient that is known beforehand, and each takes off about as much,
/// so that the report of progress gets there evenly.
TEST(test_progress) {
    solver_progress progress = {0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context_telling(0, note_progress, &progress);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = generate(context, EWA_OBJECT_PLANE, 3000, false);
    random_colors(cloud, 3);
    progress = (solver_progress){0};
    ewa_refit_report report;
    assert_int_equal(ewa_cloud_refit_colors(cloud, NULL, &report), EWA_OK);
    print_message("%u steps, %d reports, the last but one %.3f, the longest way %.3f\n",
                  report.iteration_count, progress.count, progress.last, progress.longest);
    assert_true(report.iteration_count >= 5);
    assert_true(progress.last > 0.9 && progress.longest < 0.1);
}

/// Pictures of a magnified texture come nearer to it: by over a decibel for exact colours, by some for noisy
/// ones that are fitted.
TEST_ON(test_pictures, 0) {
    const refit_setting clean = {EWA_PROCEDURE_NOISE, 4, 10000, 0.5, 1.6, 0},
                        noisy = {EWA_PROCEDURE_NOISE, 4, 10000, 1, 1.6, 0.02};
    const double plain = refit_scene_psnr(context, &clean, REFIT_PLAIN, NULL);
    assert_true(plain > 28);
    assert_true(refit_scene_psnr(context, &clean, EWA_REFIT_INTERPOLATE, NULL) > plain + 1);
    assert_true(refit_scene_psnr(context, &clean, EWA_REFIT_FIT, NULL) > plain + 1);
    assert_true(refit_scene_psnr(context, &noisy, EWA_REFIT_FIT, NULL) >
                refit_scene_psnr(context, &noisy, REFIT_PLAIN, NULL) + 0.5);
}

/// Coefficients of any sign are drawn as the reference draws them.
TEST_ON(test_drawn, 0) {
    enum { SIDE = 48 };
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = generate(context, EWA_OBJECT_PLANE, 400, false);
    float *color = random_colors(cloud, 3), lowest = 0;
    for (uint64_t i = 0; i < 3 * ewa_cloud_point_count(cloud); i++) color[i] = 6 * color[i] - 3;
    ewa_camera camera = check_camera(SIDE, SIDE);
    ewa_camera_look_at(&camera, (double[3]){0, 0, 5}, (double[3]){0, 0, 0}, (double[3]){0, 1, 0});
    ewa_camera_set_ortho(&camera, 1.5);
    WITH_DEFAULTS(ewa_render_options, look);
    look.shading = EWA_SHADING_NONE;
    ewa_surfels_info info;
    static float fast[4 * SIDE * SIDE], slow[4 * SIDE * SIDE];
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(cloud, NULL);
    ewa_surfels_describe(surfels, &info);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    assert_int_equal(ewa_render(renderer, surfels, &camera, &look, &(ewa_frame){.rgba = fast}, NULL), EWA_OK);
    assert_int_equal(
        ewa_render_reference(cloud, NULL, info.unit_coverage, &camera, &look, &(ewa_frame){.rgba = slow}),
        EWA_OK);
    for (int i = 0; i < 4 * SIDE * SIDE; i++) {
        assert_true(fabsf(fast[i] - slow[i]) < 2e-3f);
        lowest = fminf(lowest, fast[i]);
    }
    assert_true(lowest < -0.5f);
}

/// Coefficients of any sign survive a file.
TEST_ON(test_file, 0) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = generate(context, EWA_OBJECT_PLANE, 500, false), *back = NULL;
    random_colors(cloud, 3);
    assert_int_equal(ewa_cloud_refit_colors(cloud, NULL, NULL), EWA_OK);
    char path[512];
    scratch_path("refit.ply", path);
    assert_int_equal(ewa_cloud_save(cloud, path, NULL), EWA_OK);
    assert_int_equal(ewa_cloud_load(context, path, &back), EWA_OK);
    assert_memory_equal(check_stream(cloud, EWA_COLOR), check_stream(back, EWA_COLOR),
                        500 * sizeof(float[3]));
    remove(path);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
