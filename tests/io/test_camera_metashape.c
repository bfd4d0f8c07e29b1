// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cameras of Metashape's cameras.xml: where they stand, their lenses, what is left out, what is wrong.
#include "io/camera/file.h"
#include "scratch.h"

#include <math.h>
#include <string.h>

#define SENSORS                                                                                                            \
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<document version=\"2.0.0\">\n <chunk label=\"a\" enabled=\"true\">\n"    \
    "  <sensors next_id=\"2\">\n   <sensor id=\"0\" label=\"X\" type=\"frame\">\n"                                         \
    "    <resolution width=\"640\" height=\"480\"/>\n    <property name=\"pixel_width\" value=\"0.002\"/>\n"               \
    "    <calibration type=\"frame\" class=\"initial\"><resolution width=\"640\" height=\"480\"/><f>99</f><k1>9</k1>"      \
    "</calibration>\n    <calibration type=\"%s\" class=\"adjusted\">\n"                                                   \
    "     <resolution width=\"640\" height=\"480\"/><f>510</f><cx>0.125</cx><cy>-247.5</cy><b1>-10</b1>%s"                 \
    "</calibration>\n   </sensor>\n  </sensors>\n"
/// Twice as large, moved, and x becomes y, y z, z x.
#define MAP                                                                                                                \
    "  <components next_id=\"1\" active_id=\"0\"><component id=\"0\" label=\"c\"><transform>"                              \
    "<rotation locked=\"false\">0 0 1 1 0 0 0 1 0</rotation><translation>10 20 30</translation><scale>2</scale>"           \
    "</transform></component></components>\n"
/// Camera axes x = x, y = -z, z = y of the chunk, at (-10, -14, 0) there; and two that are not to be had.
#define CAMERAS                                                                                                            \
    "  <cameras next_id=\"3\" next_group_id=\"0\">\n   <group id=\"0\">\n"                                                 \
    "   <camera id=\"0\" sensor_id=\"0\" component_id=\"0\" label=\"DSC 1.JPG\">"                                          \
    "<transform>1 0 0 -10 0 0 1 -14\n0 -1 0 0 0 0 0 1</transform><orientation>1</orientation></camera></group>\n"         \
    "   <camera id=\"1\" sensor_id=\"0\" component_id=\"0\" label=\"b\"/>\n"                                               \
    "   <camera id=\"2\" sensor_id=\"0\" label=\"off\" enabled=\"false\"><transform>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"       \
    "</transform></camera>\n  </cameras>\n <reference>LOCAL_CS[\"m\"]</reference></chunk>\n"                               \
    " <chunk><cameras><camera id=\"0\" sensor_id=\"7\"><transform>1</transform></camera></cameras></chunk>\n</document>"

static ewa_status read_text(ewa_context *context, const char *text, size_t length, bool takes_lenses, ewa_camera_list *list) {
    OWNED(check_free) uint8_t *bytes = malloc(length ? length : 1); // of just this size, for the sanitizer
    assert_non_null(bytes);
    memcpy(bytes, text, length);
    *list = (ewa_camera_list){.context = context, .name = "cameras.xml", .takes_lenses = takes_lenses};
    const ewa_status status = ewa_camera_list_read_metashape(list, bytes, length);
    return status;
}

static const char *make_text(const char *kind, const char *numbers) {
    static char text[4000];
    const int length = snprintf(text, sizeof text, SENSORS MAP CAMERAS, kind, numbers);
    assert_true(length > 0 && (size_t)length < sizeof text);
    return text;
}

TEST_LOGGED(test_places_and_lenses, 1) {
    ewa_camera_list list;
    const char *text = make_text("frame", "<k1>0.1</k1><k2>-0.2</k2><k3>0.3</k3><p1>0.01</p1><p2>0.02</p2>");
    assert_int_equal(read_text(context, text, strlen(text), true, &list), EWA_OK);
    assert_int_equal(list.count, 1);
    assert_non_null(strstr(log->text, "1 cameras are left out"));
    const ewa_camera *camera = list.cameras;
    assert_true(camera->width_px == 640 && camera->height_px == 480);
    assert_true(camera->fx_px == 500 && camera->fy_px == 510 && camera->cx_px == 320.125 && camera->cy_px == -7.5);
    assert_string_equal(list.pictures[0], "DSC 1.JPG");
    // Of the chunk's (-10, -14, 0) is (10, 0, 2) of the world; axes are x = y, y = -x, z = z of the world.
    double eye[3];
    ewa_camera_eye(camera, eye);
    assert_true(fabs(eye[0] - 10) < 1e-12 && fabs(eye[1]) < 1e-12 && fabs(eye[2] - 2) < 1e-12);
    static const double axes[3][3] = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) assert_true(fabs(camera->world_to_camera[4 * r + c] - axes[r][c] / 2) < 1e-12);
    const ewa_lens *lens = list.lenses;
    assert_int_equal(lens->model, EWA_LENS_BROWN);
    assert_true(lens->radial[0] == 0.1 && lens->radial[1] == -0.2 && lens->radial[2] == 0.3);
    assert_true(lens->tangential[0] == 0.02 && lens->tangential[1] == 0.01); // x has 2 P2 xy + P1 (r2 + 2 x2)
    ewa_camera_list_free(&list);

    text = make_text("fisheye", "<k4>0.4</k4>");
    assert_int_equal(read_text(context, text, strlen(text), true, &list), EWA_OK);
    assert_true(list.lenses[0].model == EWA_LENS_FISHEYE && list.lenses[0].radial[3] == 0.4);
    ewa_camera_list_free(&list);
    assert_int_equal(read_text(context, text, strlen(text), false, &list), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(log->text, "no pinhole, of the type 'fisheye'"));
    ewa_camera_list_free(&list);

    text = make_text("frame", "<k1>0.1</k1>");
    assert_int_equal(read_text(context, text, strlen(text), false, &list), EWA_OK);
    ewa_camera_list_free(&list);
    // By the file, with the photograph found by its name.
    char path[512], picture[512];
    scratch_write(scratch_path("cameras.xml", path), text, strlen(text));
    scratch_write(scratch_path("DSC 1.JPG", picture), "x", 1);
    OWNED(ewa_photo_list_destroy) ewa_photo_list *photos;
    uint32_t count;
    assert_int_equal(ewa_photo_list_load(context, path, NULL, &photos), EWA_OK);
    assert_non_null(strstr(ewa_photo_list_photos(photos, &count)->path, "DSC 1.JPG"));
    assert_int_equal(count, 1);
}

/// A chunk of a version without components has the map itself.
TEST_ON(test_old_chunk, 1) {
    OWNED(ewa_camera_list_free) ewa_camera_list list;
    static const char text[] =
        "<document><chunk><sensors><sensor id=\"3\" type=\"frame\"><resolution width=\"8\" height=\"6\"/><calibration><f>7</f>"
        "</calibration></sensor></sensors><cameras><camera id=\"0\" sensor_id=\"3\" label=\"a\"><transform>1 0 0 1 0 1 0 0 0 0 1 0 "
        "0 0 0 1</transform></camera></cameras><transform><translation>1 2 3</translation></transform></chunk></document>";
    assert_int_equal(read_text(context, text, sizeof text - 1, true, &list), EWA_OK);
    double eye[3];
    ewa_camera_eye(&list.cameras[0], eye);
    assert_true(eye[0] == 2 && eye[1] == 2 && eye[2] == 3);
    assert_true(list.lenses[0].model == EWA_LENS_PINHOLE && list.cameras[0].cx_px == 4 && list.cameras[0].fx_px == 7);
}

TEST(test_broken) {
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    ewa_camera_list list;
    static char broken[4000];
    const char *whole = make_text("frame", "<k1>0.1</k1>");
    const size_t length = strlen(whole);
    for (size_t i = 0; i < length; i++) {
        assert_int_not_equal(read_text(context, whole, i, true, &list), EWA_OK);
        ewa_camera_list_free(&list);
    }
    for (size_t i = 0; i < length; i++) { // whatever comes of it, no harm is done
        memcpy(broken, whole, length);
        broken[i] ^= 0x15;
        read_text(context, broken, length, true, &list);
        ewa_camera_list_free(&list);
    }
    static const char *const cases[][3] = {
        // what stands there, what instead, what is said
        {"type=\"frame\" class=\"adjusted\"", "type=\"spherical\"", "of the type 'spherical'"},
        {"<k1>0.1", "<k4>0.1", "k4 = 0.1 of a lens of the type frame"},
        {"<k1>0.1", "<b2>0.1", "b2 = 0.1"},
        {"<k1>0.1", "<k1>zero", "a number wanted in the element 'k1'"},
        {"<f>510", "<fx>510", "PhotoScan before 1.3"},
        {"sensor_id=\"0\"", "sensor_id=\"5\"", "a sensor that is missing: '5'"},
        {"1 0 0 -10 0", "1 0 0 0", "sixteen numbers wanted in the transform of 'DSC 1.JPG'"},
        {"0 0 1 1 0 0 0 1 0", "0 0 1 1", "nine numbers"},
        {"<scale>2", "<scale>0", "above 0"},
        {"component_id=\"0\" label=\"DSC", "component_id=\"1\" label=\"DSC", "no camera of it is aligned"},
        {"<f>510</f>", "<f>-5</f>", "fx_px"},
        {"<resolution width=\"640\"", "<resolution width=\"-1\"", "width_px"},
        {"</document>", "</documents>", "no whole file of Metashape's cameras"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *at = strstr(whole, cases[i][0]);
        assert_non_null(at);
        snprintf(broken, sizeof broken, "%.*s%s%s", (int)(at - whole), whole, cases[i][1], at + strlen(cases[i][0]));
        log = (check_log){.count = 0};
        assert_int_not_equal(read_text(context, broken, strlen(broken), true, &list), EWA_OK);
        if (!strstr(log.text, cases[i][2])) fail_msg("said '%s', not '%s'", log.text, cases[i][2]);
        ewa_camera_list_free(&list);
    }
    char path[512];
    ewa_camera camera;
    scratch_write(scratch_path("page.xml", path), "<html></html>", 13);
    assert_int_equal(ewa_camera_load(context, path, 0, &camera), EWA_ERROR_FORMAT);
    assert_non_null(strstr(log.text, "no whole file of Metashape's cameras"));
}

TEST(test_failing_allocations) {
    const char *text = make_text("frame", "<k1>0.1</k1>");
    for (long n = 0;; n++) {
        check_memory memory = {.calls_left = -1};
        ewa_context *context = check_context_on(1, &memory);
        ewa_camera_list list;
        memory.calls_left = n;
        const ewa_status status = read_text(context, text, strlen(text), true, &list);
        const bool failed = memory.calls_left < 0;
        assert_int_equal(status, failed ? EWA_ERROR_MEMORY : EWA_OK);
        ewa_camera_list_free(&list);
        ewa_context_destroy(&context);
        assert_int_equal(memory.held_bytes, 0);
        if (!failed) break;
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
