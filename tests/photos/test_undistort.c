// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of ewa_image_undistort() and of the lenses of camera files: pictures of a known pattern through a known lens,
// against the same pattern through a pinhole.
#include "tests/io/scratch.h"
#include "tests/photos/photo_scene.h"

#include <math.h>

enum { WIDTH = 220, HEIGHT = 160, RAYS = 4 };

static ewa_camera camera_of(void) {
    ewa_camera camera = check_camera(WIDTH, HEIGHT);
    camera.fx_px = 150, camera.fy_px = 156, camera.cx_px = 104, camera.cy_px = 83.5;
    return camera;
}

/// What the world shows in a direction (x, y, 1): waves of 12 pixels and more.
static double pattern(double x, double y) {
    return 0.5 + 0.2 * sin(80 * x + 10 * y) + 0.15 * cos(60 * y - 15 * x) + 0.1 * sin(9 * x * y + 3 * x);
}

/// OpenCV's formulas, written here by themselves.
static void distort(const ewa_lens *lens, double x, double y, double *u, double *v) {
    const double *k = lens->radial, *p = lens->tangential, r2 = x * x + y * y, r = sqrt(r2);
    if (lens->model == EWA_LENS_FISHEYE) {
        const double a = atan(r);
        const double shown = a * (1 + k[0] * pow(a, 2) + k[1] * pow(a, 4) + k[2] * pow(a, 6) + k[3] * pow(a, 8));
        *u = r > 0 ? x * shown / r : x, *v = r > 0 ? y * shown / r : y;
        return;
    }
    const double f = (1 + k[0] * r2 + k[1] * r2 * r2 + k[2] * pow(r2, 3)) / (1 + k[3] * r2 + k[4] * r2 * r2 + k[5] * pow(r2, 3));
    *u = x * f + 2 * p[0] * x * y + p[1] * (r2 + 2 * x * x);
    *v = y * f + p[0] * (r2 + 2 * y * y) + 2 * p[1] * x * y;
}

/// The direction that a lens shows at a place: by iteration, as nobody has a formula for it.
static bool undistort(const ewa_lens *lens, double u, double v, double *x, double *y) {
    *x = u, *y = v;
    for (int i = 0; i < 200; i++) {
        double a, b;
        distort(lens, *x, *y, &a, &b);
        if (fabs(a - u) + fabs(b - v) < 1e-12) return true;
        *x += 0.7 * (u - a), *y += 0.7 * (v - b);
    }
    return false;
}

/// A photograph of the pattern through a lens.
static ewa_image photograph(ewa_context *context, const ewa_camera *camera, const ewa_lens *lens) {
    ewa_image image;
    assert_int_equal(ewa_image_create(context, WIDTH, HEIGHT, 3, &image), EWA_OK);
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            double sum = 0;
            for (int ray = 0; ray < RAYS * RAYS; ray++) {
                double a = 0, b = 0;
                const double u = (x + (ray % RAYS + 0.5) / RAYS - camera->cx_px) / camera->fx_px;
                const double v = (y + (ray / RAYS + 0.5) / RAYS - camera->cy_px) / camera->fy_px;
                assert_true(undistort(lens, u, v, &a, &b));
                sum += pattern(a, b) / (RAYS * RAYS);
            }
            for (int c = 0; c < 3; c++) image.pixels[3 * (y * WIDTH + x) + (uint32_t)c] = (float)(sum * (c + 1) / 3);
        }
    return image;
}

static void hold(const char *name, const ewa_lens *lens, double least_share) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, NULL);
    const ewa_camera camera = camera_of();
    OWNED(ewa_image_free) ewa_image image = photograph(context, &camera, lens), pinhole;
    assert_int_equal(ewa_image_undistort(&image, &camera, lens, &pinhole), EWA_OK);
    assert_int_equal(pinhole.channel_count, 4);
    double square = 0, left_alone = 0;
    uint32_t count = 0;
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            const double a = (x + 0.5 - camera.cx_px) / camera.fx_px, b = (y + 0.5 - camera.cy_px) / camera.fy_px;
            const float *at = pinhole.pixels + 4 * (y * WIDTH + x);
            double u, v;
            distort(lens, a, b, &u, &v);
            const double u_px = u * camera.fx_px + camera.cx_px, v_px = v * camera.fy_px + camera.cy_px;
            if (u_px > 2 && v_px > 2 && u_px < WIDTH - 2 && v_px < HEIGHT - 2) {
                assert_true(at[3] > 0.999f);
                const double off = (double)at[2] - pattern(a, b);
                const double alone = (double)image.pixels[3 * (y * WIDTH + x) + 2] - pattern(a, b);
                square += off * off, left_alone += alone * alone;
                assert_true(fabs((double)at[0] - (double)at[2] / 3) < 1e-5);
                count++;
            } else if (u_px < -1 || v_px < -1 || u_px > WIDTH + 1 || v_px > HEIGHT + 1) {
                assert_true(at[3] == 0 && at[0] == 0);
            }
        }
    const double db = -10 * log10(square / count), before_db = -10 * log10(left_alone / count);
    print_message("%s: %.2f dB, left out %.2f dB, %.0f %% of the picture\n", name, db, before_db,
                  100.0 * count / (WIDTH * HEIGHT));
    assert_true(db > 38);
    assert_true(db > before_db + 10);
    assert_true(count > least_share * WIDTH * HEIGHT);
}

TEST(test_lenses_are_undone) {
    (void)state;
    hold("radial", &(ewa_lens){EWA_LENS_BROWN, {-0.12, 0.03}, {0}}, 0.9);
    hold("opencv", &(ewa_lens){EWA_LENS_BROWN, {0.08, -0.02}, {0.01, -0.015}}, 0.6);
    hold("full opencv", &(ewa_lens){EWA_LENS_BROWN, {0.2, 0.05, 0.01, 0.3, 0.02, 0.005}, {0.002, 0.003}}, 0.9);
    hold("fisheye", &(ewa_lens){EWA_LENS_FISHEYE, {0.05, -0.01, 0.004, -0.001}, {0}}, 0.9);
}

/// A lens that turns back shows its rim once.
TEST(test_what_a_lens_does_not_show_is_transparent) {
    (void)state;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, NULL);
    const ewa_camera camera = camera_of();
    const ewa_lens lens = {EWA_LENS_BROWN, {-1.5}, {0}}; // r (1 - 1.5 r^2) turns back at 0.47
    OWNED(ewa_image_free) ewa_image image, pinhole;
    assert_int_equal(ewa_image_create(context, WIDTH, HEIGHT, 3, &image), EWA_OK);
    for (uint32_t i = 0; i < 3 * WIDTH * HEIGHT; i++) image.pixels[i] = 1;
    assert_int_equal(ewa_image_undistort(&image, &camera, &lens, &pinhole), EWA_OK);
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            const double r = hypot((x + 0.5 - camera.cx_px) / camera.fx_px, (y + 0.5 - camera.cy_px) / camera.fy_px);
            const float alpha = pinhole.pixels[4 * (y * WIDTH + x) + 3];
            if (r > 0.48) assert_true(alpha == 0);
            if (r < 0.45) assert_true(alpha == 1);
        }
}

TEST(test_bad_lenses_are_named) {
    (void)state;
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, &log);
    ewa_camera camera = camera_of();
    ewa_lens lens = {EWA_LENS_BROWN, {0, NAN}, {0}};
    ewa_image image, pinhole;
    assert_int_equal(ewa_image_create(context, WIDTH, HEIGHT, 3, &image), EWA_OK);
    assert_int_equal(ewa_image_undistort(&image, &camera, &lens, &pinhole), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log.text, "k2 of the lens is nan"));
    lens.radial[1] = 0, camera.width_px = WIDTH + 1;
    assert_int_equal(ewa_image_undistort(&image, &camera, &lens, &pinhole), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log.text, "220 x 160"));
    assert_null(pinhole.pixels);
    ewa_image_free(&image);
}

static void write_text(const char *name, const char *text) {
    FILE *file = fopen(name, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

/// Files in the folder of the test, whose photographs are only looked for.
TEST(test_lists_have_lenses_and_paths) {
    (void)state;
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, &log);
    write_text("undistort_a b.jpg", "x");
    write_text("undistort.json",
               "{\"camera_model\": \"OPENCV\", \"w\": 40, \"h\": 30, \"fl_x\": 35, \"k1\": 0.1, \"p2\": -0.02, \"frames\": ["
               "{\"file_path\": \"undistort_a b\", \"transform_matrix\": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]},"
               "{\"file_path\": \"./undistort_a b.jpg\", \"camera_model\": \"OPENCV_FISHEYE\", \"k4\": 0.3, "
               "\"transform_matrix\": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}]}");
    ewa_photo_list *list = NULL;
    uint32_t count = 0;
    assert_int_equal(ewa_photo_list_load(context, "undistort.json", NULL, &list), EWA_OK);
    assert_int_equal(log.count, 0); // nothing is left out
    const ewa_photo *photos = ewa_photo_list_photos(list, &count);
    assert_int_equal(count, 2);
    assert_non_null(strstr(photos[0].path, "undistort_a b.jpg"));
    assert_int_equal(photos[0].lens.model, EWA_LENS_BROWN);
    assert_true(photos[0].lens.radial[0] == 0.1 && photos[0].lens.tangential[1] == -0.02);
    assert_int_equal(photos[1].lens.model, EWA_LENS_FISHEYE);
    assert_true(photos[1].lens.radial[3] == 0.3 && photos[1].camera.width_px == 40);
    ewa_photo_list_destroy(&list);
    assert_null(list);

    write_text("undistort.json", "{\"w\": 40, \"h\": 30, \"fl_x\": 35, \"frames\": [{\"file_path\": \"gone.png\", "
                                 "\"transform_matrix\": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}]}");
    assert_int_equal(ewa_photo_list_load(context, "undistort.json", NULL, &list), EWA_ERROR_IO);
    assert_non_null(strstr(log.text, "gone.png"));
    assert_null(list);
    write_text("undistort.json", "{\"w\": 40, \"h\": 30, \"fl_x\": 35, \"camera_model\": \"EQUIRECTANGULAR\", \"frames\": [{"
                                 "\"transform_matrix\": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}]}");
    assert_int_equal(ewa_photo_list_load(context, "undistort.json", NULL, &list), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(log.text, "EQUIRECTANGULAR"));
    write_text("undistort.json", "{\"w\": 40, \"h\": 30, \"fl_x\": 35, \"frames\": [{"
                                 "\"transform_matrix\": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}]}");
    assert_int_equal(ewa_photo_list_load(context, "undistort.json", NULL, &list), EWA_ERROR_FORMAT);
    assert_non_null(strstr(log.text, "camera 0 has no name"));
    remove("undistort.json"), remove("undistort_a b.jpg");
}

/// Numbers of COLMAP's models go where the formulas have them.
TEST(test_lenses_of_colmap) {
    (void)state;
    static const struct {
        const char *line;
        ewa_lens lens;
    } models[] = {
        {"SIMPLE_RADIAL 40 30 35 20 15 0.1", {EWA_LENS_BROWN, {0.1}, {0}}},
        {"RADIAL 40 30 35 20 15 0.1 0.2", {EWA_LENS_BROWN, {0.1, 0.2}, {0}}},
        {"OPENCV 40 30 35 35 20 15 0.1 0.2 0.3 0.4", {EWA_LENS_BROWN, {0.1, 0.2}, {0.3, 0.4}}},
        {"FULL_OPENCV 40 30 35 35 20 15 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8",
         {EWA_LENS_BROWN, {0.1, 0.2, 0.5, 0.6, 0.7, 0.8}, {0.3, 0.4}}},
        {"OPENCV_FISHEYE 40 30 35 35 20 15 0.1 0.2 0.3 0.4", {EWA_LENS_FISHEYE, {0.1, 0.2, 0.3, 0.4}, {0}}},
        {"SIMPLE_RADIAL_FISHEYE 40 30 35 20 15 0.1", {EWA_LENS_FISHEYE, {0.1}, {0}}},
        {"RADIAL_FISHEYE 40 30 35 20 15 0.1 0.2", {EWA_LENS_FISHEYE, {0.1, 0.2}, {0}}},
    };
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, &log);
    mkdir("undistort_model", 0777);
    write_text("undistort_model/images.txt", "1 1 0 0 0 0 0 0 7 a b.jpg\n\n");
    write_text("undistort_model/a b.jpg", "x");
    for (size_t i = 0; i < sizeof models / sizeof models[0]; i++) {
        char text[200];
        snprintf(text, sizeof text, "7 %s\n", models[i].line);
        write_text("undistort_model/cameras.txt", text);
        OWNED(ewa_photo_list_destroy) ewa_photo_list *list;
        uint32_t count;
        assert_int_equal(ewa_photo_list_load(context, "undistort_model", NULL, &list), EWA_OK);
        const ewa_lens *lens = &ewa_photo_list_photos(list, &count)->lens, *wanted = &models[i].lens;
        assert_int_equal(lens->model, wanted->model);
        for (int k = 0; k < 6; k++) assert_true(lens->radial[k] == wanted->radial[k]);
        for (int k = 0; k < 2; k++) assert_true(lens->tangential[k] == wanted->tangential[k]);
    }
    assert_int_equal(log.count, 0);
    write_text("undistort_model/cameras.txt", "7 FOV 40 30 35 35 20 15 0.1\n");
    ewa_photo_list *list;
    assert_int_equal(ewa_photo_list_load(context, "undistort_model", NULL, &list), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(log.text, "model FOV"));
    remove("undistort_model/cameras.txt"), remove("undistort_model/images.txt"), remove("undistort_model/a b.jpg"), rmdir("undistort_model");
}

int main(void) { return RUN_TESTS(NULL, NULL); }
