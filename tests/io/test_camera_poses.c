// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Poses as text, and the numbers of depth images.
#include "ewa/io.h"
#include "io/camera/file.h"
#include "scratch.h"

#include <math.h>

static ewa_camera lens(void) {
    ewa_camera camera;
    ewa_camera_init(&camera);
    return camera;
}

static ewa_status read_text(ewa_context *context, const char *text, ewa_camera_list *list) {
    *list = (ewa_camera_list){.context = context, .name = "poses"};
    const ewa_camera camera = lens();
    return ewa_camera_list_read_poses(list, &camera, (const uint8_t *)text, strlen(text));
}

static void expect_eye(const ewa_camera *camera, double x, double y, double z) {
    double eye[3];
    ewa_camera_eye(camera, eye);
    assert_true(fabs(eye[0] - x) + fabs(eye[1] - y) + fabs(eye[2] - z) < 1e-9);
}

static const char MATRICES[] = "# a comment\n0 0 2\n1 0 0 1.5\n0 1 0 -2\n0 0 1 3\n0 0 0 1\n\n1 1 2\r\n"
                               "0 -1 0 4\n1 0 0 5 # turned\n0 0 1 6\n0.0 0 0 1.0";
static const char TUM[] = "# time tx ty tz qx qy qz qw\n1305031102.17 1 2 3 0 0 0 1\n"
                          "1305031102.21 4 5 6 0 0 0.7071067811865476 0.7071067811865476\n";

TEST_ON(test_matrices, 1) {
    OWNED(ewa_camera_list_free) ewa_camera_list list;
    assert_int_equal(read_text(context, MATRICES, &list), EWA_OK);
    assert_int_equal(list.count, 2);
    expect_eye(&list.cameras[0], 1.5, -2, 3);
    expect_eye(&list.cameras[1], 4, 5, 6);
    // Camera to world takes x to y: world to camera takes y to x.
    assert_true(list.cameras[1].world_to_camera[1] == 1 && list.cameras[1].world_to_camera[4] == -1);
}

TEST_ON(test_tum, 1) {
    OWNED(ewa_camera_list_free) ewa_camera_list list;
    assert_int_equal(read_text(context, TUM, &list), EWA_OK);
    assert_int_equal(list.count, 2);
    expect_eye(&list.cameras[0], 1, 2, 3);
    expect_eye(&list.cameras[1], 4, 5, 6);
    assert_true(fabs(list.cameras[1].world_to_camera[1] - 1) < 1e-12); // a quarter turn about z, x to y
}

TEST(test_broken) {
    static const struct {
        const char *text, *said;
    } broken[] = {
        {"", "no camera pose"},
        {"# nothing\n\n", "no camera pose"},
        {"0 0 1\n", "ends before a matrix"},
        {"1 0 0 0\n0 1 0 0\n0 0 1 0\n", "four numbers of a 4 x 4 matrix wanted"},
        {"1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 2\n", "last row of a matrix"},
        {"1 0 0 0\n0 1 0\n0 0 1 0\n0 0 0 1\n", "line 2"},
        {"1 0 0 nan\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "not finite"},
        {"1 0 0 x\n", "what is no number"},
        {"1 2 3 4 5 6 7 8 9\n", "more than eight numbers"},
        {"1 2 3 4 5\n", "neither a row"},
        {"0 0 1\n1 2 3 0 0 0 1 0\n", "neither a row"},
        {"1 0 0 0 0 0 0 0\n", "quaternion is zero"},
        {"0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 1\n", "rotation is zero"},
        {"1 0 0 0\n0 9 0 0\n0 0 1 0\n0 0 0 1\n", "pose 0"},
    };
    check_log log = {0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    for (size_t i = 0; i < sizeof broken / sizeof broken[0]; i++) {
        OWNED(ewa_camera_list_free) ewa_camera_list list;
        assert_int_equal(read_text(context, broken[i].text, &list), EWA_ERROR_FORMAT);
        if (!strstr(log.text, broken[i].said)) fail_msg("'%s' does not say '%s'", log.text, broken[i].said);
    }
    // Every beginning of a valid file is read or refused.
    for (size_t length = 0; length < strlen(MATRICES); length++) {
        OWNED(ewa_camera_list_free) ewa_camera_list list = {.context = context, .name = "poses"};
        const ewa_camera camera = lens();
        OWNED(check_free) uint8_t *cut = malloc(length + 1);
        memcpy(cut, MATRICES, length);
        ewa_camera_list_read_poses(&list, &camera, cut, length);
    }
}

static ewa_status work(ewa_context *context, void *user) {
    (void)user;
    OWNED(ewa_camera_list_free) ewa_camera_list list;
    const ewa_status status = read_text(context, MATRICES, &list);
    return status;
}

TEST(test_failing_allocations) { scratch_fail_each(work, NULL); }

static void count_pose(void *user, uint32_t index, const ewa_camera *camera) {
    assert_int_equal(index, *(uint32_t *)user);
    assert_int_equal(camera->width_px, 1280);
    ++*(uint32_t *)user;
}

TEST_ON(test_files, 1) {
    char path[512];
    scratch_write(scratch_path("poses.txt", path), TUM, sizeof TUM - 1);
    const ewa_camera camera = lens();
    uint32_t count = 0;
    assert_int_equal(ewa_camera_load_poses(context, path, &camera, count_pose, &count), EWA_OK);
    assert_int_equal(count, 2);
    assert_int_equal(ewa_camera_load_poses(context, "not there.txt", &camera, count_pose, &count),
                     EWA_ERROR_IO);
    assert_int_equal(ewa_camera_load_poses(context, path, NULL, count_pose, &count), EWA_ERROR_ARGUMENT);
    if (check_data("rgbd/livingroom/trajectory.log", path, sizeof path)) {
        count = 0;
        assert_int_equal(ewa_camera_load_poses(context, path, &camera, count_pose, &count), EWA_OK);
        assert_int_equal(count, 5);
    }
}

/// Depths in PNG are integers, not colours.
TEST(test_depths) {
    char path[512];
    check_log log = {0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    ewa_image depth, image;
    if (check_data("rgbd/livingroom/depth/00000.png", path, sizeof path)) {
        assert_int_equal(ewa_depth_load(context, path, &depth), EWA_OK);
        assert_int_equal(depth.channel_count, 1);
        assert_true(depth.pixels[200 * 640 + 300] == 2248 && depth.pixels[100 * 640 + 101] == 1370);
        ewa_image_free(&depth);
    }
    const uint8_t grey[6] = {0, 1, 127, 128, 254, 255};
    assert_int_equal(ewa_png_save(context, scratch_path("grey.png", path), 3, 2, 1, grey, 3), EWA_OK);
    assert_int_equal(ewa_depth_load(context, path, &depth), EWA_OK);
    for (int i = 0; i < 6; i++) assert_true(depth.pixels[i] == grey[i]);
    ewa_image_free(&depth);
    const uint8_t red[3] = {1, 2, 3};
    assert_int_equal(ewa_png_save(context, path, 1, 1, 3, red, 3), EWA_OK);
    assert_int_equal(ewa_depth_load(context, path, &depth), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(log.text, "grey of 8 or 16 bits"));
    assert_int_equal(ewa_image_create(context, 4, 3, 1, &image), EWA_OK);
    for (int i = 0; i < 12; i++) image.pixels[i] = 0.5f * (float)i;
    static const char *const names[] = {"depth.pfm", "depth.exr"};
    for (int k = 0; k < 2; k++) {
        assert_int_equal(ewa_image_save(&image, scratch_path(names[k], path), NULL), EWA_OK);
        assert_int_equal(ewa_depth_load(context, path, &depth), EWA_OK);
        assert_memory_equal(depth.pixels, image.pixels, 12 * sizeof(float));
        ewa_image_free(&depth);
    }
    ewa_image_free(&image);
    assert_int_equal(ewa_image_create(context, 4, 3, 3, &image), EWA_OK);
    assert_int_equal(ewa_image_save(&image, path, NULL), EWA_OK);
    assert_int_equal(ewa_depth_load(context, path, &depth), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(log.text, "3 channels"));
    assert_null(depth.pixels);
    ewa_image_free(&image);
    assert_int_equal(ewa_depth_load_memory(context, "P5 1 1 255\n1", 12, "raw", &depth),
                     EWA_ERROR_UNSUPPORTED);
}

/// Every beginning of a file is refused.
TEST_ON(test_cut_short, 1) {
    char path[512];
    if (!check_data("rgbd/sensor_sequence/frame-000065.depth.png", path, sizeof path)) skip();
    ewa_image depth;
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = scratch_read(path, &size_bytes);
    for (size_t length = 0; length < size_bytes; length += length < 200 ? 1 : 997) {
        OWNED(check_free) uint8_t *cut = malloc(length + 1);
        memcpy(cut, bytes, length);
        assert_int_not_equal(ewa_depth_load_memory(context, cut, length, "cut", &depth), EWA_OK);
        assert_null(depth.pixels);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
