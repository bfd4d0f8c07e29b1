// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clouds of text of the data set, which others' programs have written: counts, attributes, first and last points.
#include "io/rows_check.h"

TEST_WITHIN(test_files, set_up, tear_down) {
    static const struct {
        const char *path;
        ewa_model_format format;
        uint64_t point_count;
        const char *names;
        double first[3], last[3];
    } files[] = {
        {"autzen.pts",
         EWA_MODEL_TEXT,
         10,
         "position,intensity,color",
         {636110.300003, 849345.050003, 512.139999},
         {0}},
        {"bunnyData.pts",
         EWA_MODEL_TEXT,
         30571,
         "position",
         {-0.037829, 0.12794, 0.004474},
         {-0.07063, 0.04015, 0.001226}},
        {"bunny_8.pts",
         EWA_MODEL_TEXT,
         9,
         "position",
         {-0.037829, 0.12794, 0.004474},
         {-0.025508, 0.112568, 0.036676}},
        {"point_cloud_sample1.pts",
         EWA_MODEL_TEXT,
         10,
         "position,intensity,color",
         {4.246445, -6.426620, -50.214615},
         {0}},
        {"point_cloud_sample2.pts",
         EWA_MODEL_TEXT,
         10,
         "position,intensity",
         {4.246445, -6.426620, -50.214615},
         {-6.369919, -13.915909, -65.089279}},
        {"test.pts", EWA_MODEL_TEXT, 19, "position,intensity,color", {3.980972, -2.006119, -0.010086}, {0}},
        {"simple.xyz", EWA_MODEL_TEXT, 4, "position", {0, 0, 0}, {0, 0, 1}},
        {"utm17_1.txt",
         EWA_MODEL_TEXT,
         10,
         "position",
         {289814.15, 4320978.61, 170.76},
         {289818.50, 4320980.59, 170.58}},
        {"crlf_test.txt",
         EWA_MODEL_TEXT,
         10,
         "position,intensity",
         {289814.15, 4320978.61, 170.76},
         {289818.50, 4320980.59, 170.58}},
        {"quoted.txt", EWA_MODEL_TEXT, 9, "position", {0, 1, 2}, {29, 22, 2}},
        {"largescan.txt",
         EWA_MODEL_TEXT,
         6,
         "position,OffsetTime,scan_angle",
         {377445.342, 986746.942, 7.062},
         {0}},
        {"no-color.ptx", EWA_MODEL_PTX, 15, "position,intensity", {637012.24, 849028.31, 431.66}, {0}},
        {"1.2-with-color.ptx",
         EWA_MODEL_PTX,
         1065,
         "position,intensity,color",
         {637012.24, 849028.31, 431.66},
         {0}},
        {"complex-transform.ptx", EWA_MODEL_PTX, 4, "position,intensity,color", {0}, {0}},
    };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        char name[128], path[512];
        snprintf(name, sizeof name, "clouds/text/%s", files[i].path);
        if (!check_data(name, path, sizeof path)) skip();
        OWNED(ewa_model_free) ewa_model model;
        assert_int_equal(ewa_model_load(context, path, EWA_MODEL_POINTS, NULL, &model), EWA_OK);
        assert_int_equal(model.format, files[i].format);
        rows_expect(model.points, files[i].point_count, files[i].names);
        if (files[i].first[0] != 0 || files[i].first[1] != 0)
            rows_expect_world(model.points, 0, files[i].first[0], files[i].first[1], files[i].first[2]);
        if (files[i].last[2] != 0)
            rows_expect_world(model.points, files[i].point_count - 1, files[i].last[0], files[i].last[1],
                              files[i].last[2]);
    }
    assert_int_equal(messages.count, 0);
}

/// By hand from the matrix and the line of the file: x y z 1 times the matrix, whose rows come in the file's order.
TEST_WITHIN(test_matrix, set_up, tear_down) {
    char path[512];
    if (!check_data("clouds/text/complex-transform.ptx", path, sizeof path)) skip();
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_load(context, path, &cloud), EWA_OK);
    const double expected[3] = {
        -0.005630 * 0.999979 + 0.645218 * 0.003613 - 0.440506 * 0.005359 - 3.028748,
        -0.005630 * -0.003604 + 0.645218 * 0.999992 - 0.440506 * -0.001650 - 3.819741,
        -0.005630 * -0.005365 + 0.645218 * 0.001630 - 0.440506 * 0.999984 - 1.384333,
    };
    for (uint32_t c = 0; c < 3; c++)
        assert_true(fabs(rows_number(cloud, EWA_POSITION, 0, c) - expected[c]) < 1e-12);
    assert_string_equal(ewa_cloud_note(cloud, "scanners", NULL), "-3.028748 -3.819741 -1.384333\n");
}

TEST_WITHIN(test_mesh_and_broken, set_up, tear_down) {
    char path[512];
    ewa_cloud *cloud = NULL;
    if (!check_data("hostile/text/badheader.txt", path, sizeof path)) skip();
    assert_int_equal(ewa_cloud_load(context, path, &cloud), EWA_ERROR_FORMAT);
    assert_non_null(strstr(messages.text, "two columns are 'X'"));
    OWNED(ewa_model_free) ewa_model model;
    if (!check_data("clouds/text/1.2-with-color.obj", path, sizeof path)) skip();
    assert_int_equal(ewa_model_load(context, path, EWA_MODEL_MESH, NULL, &model), EWA_OK);
    assert_int_equal(model.format, EWA_MODEL_OBJ);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
