// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// PCD and E57 files of the data set, which others' programs have written, and broken ones: counts, boxes and
// attributes. Only where that is there: what is read of each format is held by files that other tests make.
#include "io/cloud_check.h"

#include <math.h>

#define FIXTURE_THREADS 0
#include "io/fixture.h"

CASE(test_counts_boxes_and_attributes) {
    static const struct {
        const char *path;
        double box[6]; ///< lower corner, upper corner
        uint64_t point_count;
        const char *attribute; ///< NULL: positions alone
        ewa_type type;
        uint32_t component_count;
    } files[] = {
#define BUN0           {-0.093938, 0.03742, -0.055026, 0.059562, 0.1845, 0.057803}, 397
#define COLORED_CLOUD  {-0.887101, -0.650735, 0.882, 0.4888, -0.37549, 1.532}, 1000
#define FIVE_PEOPLE    {-1.93112, -3.87492, 1.759, 2.98851, 1.14061, 9.757}, 239075
#define MILK_COLOR     {-0.140083, -0.26378, 0.714, 0.0138067, -0.0117286, 0.891}, 13704
#define AUTZEN_UTM     {493995, 4.87743e6, 123.93, 494994, 4.87882e6, 178.73}, 1065
#define UTM17_COMMA    {289814.15, 4320978.61, 170.58, 289818.50, 4320980.59, 170.76}, 10
#define CLOUD_BIN_0    {1.2317, -0.00485198, -2.29001, 2.94904, 2.08607, -0.808995}, 3903
#define BUNNY_DOUBLE   {-0.094689, 0.040011, -0.061873, 0.061009, 0.187321, 0.058799}, 30571
#define TINY_CARTESIAN {-9.77952957, 4.51387930, 295.524689, -6.77423811, 7.51546049, 298.532166}, 2090
        {"pcd/bun0.pcd", BUN0, "curvature", EWA_F32, 1},
        {"pcd/bunny.pcd", BUN0, NULL, EWA_F32, 0},
        {"pcd/colored_cloud.pcd", COLORED_CLOUD, "color", EWA_U8, 3},
        {"pcd/five_people.pcd", FIVE_PEOPLE, "color", EWA_U8, 4},
        {"pcd/milk_color.pcd", MILK_COLOR, "color", EWA_U8, 4},
        {"pcd/pcl_logo.pcd", {-0.963, -0.3286, 0, 1, 0.3656, 0}, 12909, "color", EWA_U8, 3},
        {"pcd/simple_ascii.pcd", {-0.95526, -0.31546, 0, 0.99185, 0.35641, 0}, 213, "color", EWA_U8, 3},
        {"pcd/autzen-utm.pcd", AUTZEN_UTM, "gps_time", EWA_F64, 1},
        {"pcd/utm17_comma.pcd", UTM17_COMMA, NULL, EWA_F32, 0},
        {"pcd/utm17_space.pcd", UTM17_COMMA, NULL, EWA_F32, 0},
        {"pcd/utm17_tab.pcd", UTM17_COMMA, NULL, EWA_F32, 0},
        {"pcd/cloud_bin_0.pcd", CLOUD_BIN_0, "normal", EWA_F32, 3},
        {"e57/bunnyDouble.e57", BUNNY_DOUBLE, NULL, EWA_F32, 0},
        {"e57/bunnyInt21.e57", BUNNY_DOUBLE, NULL, EWA_F32, 0},
        {"e57/tinyCartesianFloatRgb.e57", TINY_CARTESIAN, "color", EWA_U8, 3},
        {"e57/ColouredCubeFloat.e57", {-0.5, -0.5, -0.5, 0.5, 0.5, 0.5}, 7680, "color", EWA_U8, 3},
        {"e57/testWithNormals.e57", {1, 0, 0, 2, 0, 0}, 2, "normal", EWA_F32, 3},
        {"e57/tiny_pc_with_extension.e57", {1, 2, 3, 1, 2, 3}, 1, "normal", EWA_F32, 3},
        {"e57/tiny_pc_and_images.e57", {0, 0, 0, 1, 1, 1}, 2, NULL, EWA_F32, 0},
        {"e57/integer_intensity.e57", {1.1, 2.2, 3.3, 4.4, 5.5, 6.6}, 2, "intensity", EWA_I8, 1},
        {"e57/scaled_integer_intensity.e57", {1.1, 2.2, 3.3, 4.4, 5.5, 6.6}, 2, "intensity", EWA_F64, 1},
    };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        char relative[128], path[512];
        snprintf(relative, sizeof relative, "clouds/%s", files[i].path);
        if (!check_data(relative, path, sizeof path)) skip();
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
        ewa_bounds box;
        assert_int_equal(ewa_cloud_load(context, path, &cloud), EWA_OK);
        if (ewa_cloud_point_count(cloud) != files[i].point_count)
            fail_msg("%s: %llu points", path, (unsigned long long)ewa_cloud_point_count(cloud));
        assert_int_equal(ewa_cloud_measure(cloud, &box), EWA_OK);
        for (int c = 0; c < 3; c++) { // the facts have six digits
            const double low = files[i].box[c], high = files[i].box[3 + c];
            if (fabs(box.low_world[c] - low) > 1e-5 * fabs(low) + 1e-9 ||
                fabs(box.high_world[c] - high) > 1e-5 * fabs(high) + 1e-9)
                fail_msg("%s: axis %d from %.9g to %.9g", path, c, box.low_world[c], box.high_world[c]);
        }
        const ewa_attribute *attribute =
            files[i].attribute ? ewa_cloud_find(cloud, files[i].attribute) : NULL;
        if (files[i].attribute && (!attribute || attribute->type != files[i].type ||
                                   attribute->component_count != files[i].component_count))
            fail_msg("%s: %s", path, files[i].attribute);
    }
    assert_string_equal(messages.text, "");
}

CASE(test_spherical_and_empty) {
    char path[512];
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    if (!check_data("clouds/e57/tiny_spherical.e57", path, sizeof path)) skip();
    assert_int_equal(ewa_cloud_load(context, path, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_point_count(cloud), 180); // of 360, every other one is invalid
    for (uint64_t i = 0; i < 180; i++) {
        double place[3];
        ewa_attribute_read_f64(ewa_cloud_find(cloud, "position"), i, 1, place);
        assert_true(fabs(sqrt(place[0] * place[0] + place[1] * place[1] + place[2] * place[2]) - 1) < 1e-12);
    }
    ewa_cloud_destroy(&cloud);
    assert_non_null(check_data("clouds/e57/empty_pc.e57", path, sizeof path));
    assert_int_equal(ewa_cloud_load(context, path, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_point_count(cloud), 0);
}

CASE(test_broken) {
    static const struct {
        const char *path, *message; ///< NULL: merely odd
    } files[] = {{"pcd/missingheader.pcd", "line 1: '289814.15' is no word of a PCD header"},
                 {"e57/corrupt_crc.e57", "page 33 at byte 33792 is damaged"},
                 {"e57/empty.e57", "there are no scans in it"},
                 {"e57/read_error.e57", NULL}};
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        char relative[128], path[512];
        snprintf(relative, sizeof relative, "hostile/%s", files[i].path);
        if (!check_data(relative, path, sizeof path)) skip();
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
        messages = (check_log){0};
        const ewa_status status = ewa_cloud_load(context, path, &cloud);
        if ((status == EWA_OK) != !files[i].message ||
            (files[i].message && !strstr(messages.text, files[i].message)))
            fail_msg("%s: '%s'", path, messages.text);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
