// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// PLY of Gaussians: columns, activations, order of the harmonics, flat ones, filters, tags, doubles; what cannot be is
// refused with its reason.
#include "../check.h"

#include <math.h>

/// Loads a text; NULL context after use.
static ewa_status load(const char *text, size_t bytes, ewa_gaussians *set, ewa_gaussian_facts *facts,
                       check_log *log, ewa_context **context) {
    memset(log, 0, sizeof *log);
    *context = check_context(1, log);
    return ewa_gaussians_load_memory(*context, text, bytes, "test", NULL, set, facts);
}

static void check_near(float value, double wanted) {
    if (fabs((double)value - wanted) > 1e-6 * fmax(1, fabs(wanted)))
        fail_msg("%.9g is not %.9g", (double)value, wanted);
}

static const char head[] = "ply\nformat ascii 1.0\n";
static const char plain[] = "property float x\nproperty float y\nproperty float z\n"
                            "property float f_dc_0\nproperty float f_dc_1\nproperty float f_dc_2\n"
                            "property float opacity\nproperty float scale_0\nproperty float scale_1\n"
                            "property float scale_2\nproperty float rot_0\nproperty float rot_1\n"
                            "property float rot_2\nproperty float rot_3\n";

static void columns(void **state) {
    (void)state;
    char text[2048];
    snprintf(text, sizeof text,
             "%scomment SplatRenderMode: mip\ncomment Vertical axis: z\nelement vertex 2\n%send_header\n"
             "1 2 3 0.1 0.2 0.3 0 0 0.69314718 -0.69314718 2 0 0 0\n"
             "4 5 6 -1 0 1 2.1972246 -1 -2 -3 1 -1 1 -1\n",
             head, plain);
    check_log log;
    ewa_context *context;
    ewa_gaussians set;
    ewa_gaussian_facts facts;
    assert_int_equal(load(text, strlen(text), &set, &facts, &log, &context), EWA_OK);
    assert_int_equal(set.count, 2);
    assert_int_equal(set.sh_degree, 0);
    assert_true(set.antialiased && !set.flat && !facts.filtered);
    assert_int_equal(facts.format, EWA_GAUSSIANS_PLY);
    assert_true(facts.up_world[2] == 1 && facts.size_bytes == strlen(text));
    for (int k = 0; k < 3; k++) {
        check_near(set.centers[k], k + 1);
        check_near(set.harmonics[k], 0.1 * (k + 1));
        assert_true(set.origin[k] == 0);
    }
    check_near(set.scales[0], 1);
    check_near(set.scales[1], 2);
    check_near(set.scales[2], 0.5);
    check_near(set.opacities[0], 0.5);
    check_near(set.opacities[1], 0.9);
    check_near(set.rotations[0], 1);
    for (int k = 0; k < 4; k++) check_near(set.rotations[4 + k], k % 2 ? -0.5 : 0.5);
    ewa_gaussians_free(&set);
    ewa_context_destroy(&context);
}

/// Red comes first as a whole in files, each coefficient as a whole in sets.
static void harmonics(void **state) {
    (void)state;
    for (uint32_t degree = 0; degree <= 4; degree++) {
        char text[8192];
        const uint32_t count = (degree + 1) * (degree + 1), rest = 3 * (count - 1);
        int at = snprintf(text, sizeof text, "%selement vertex 1\n%s", head, plain);
        for (uint32_t i = 0; i < rest; i++)
            at += snprintf(text + at, sizeof text - (size_t)at, "property float f_rest_%u\n", i);
        at += snprintf(text + at, sizeof text - (size_t)at, "end_header\n0 0 0 7 8 9 0 0 0 0 1 0 0 0");
        for (uint32_t i = 0; i < rest; i++)
            at += snprintf(text + at, sizeof text - (size_t)at, " %u",
                           1000 * (i / (count - 1)) + i % (count - 1) + 1);
        check_log log;
        ewa_context *context;
        ewa_gaussians set;
        assert_int_equal(load(text, (size_t)at, &set, NULL, &log, &context), EWA_OK);
        assert_int_equal(set.sh_degree, degree);
        for (uint32_t color = 0; color < 3; color++) {
            assert_true(set.harmonics[color] == (float)(7 + color));
            for (uint32_t k = 1; k < count; k++)
                assert_true(set.harmonics[3 * k + color] == (float)(1000 * color + k));
        }
        ewa_gaussians_free(&set);
        ewa_context_destroy(&context);
    }
}

static void flat(void **state) {
    (void)state;
    const char text[] =
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "property float f_dc_0\nproperty float f_dc_1\nproperty float f_dc_2\nproperty float opacity\n"
        "property float scale_0\nproperty float scale_1\nproperty float rot_0\nproperty float rot_1\n"
        "property float rot_2\nproperty float rot_3\nend_header\n0 0 0 0 0 0 0 0 0 1 0 0 0\n";
    check_log log;
    ewa_context *context;
    ewa_gaussians set;
    assert_int_equal(load(text, sizeof text - 1, &set, NULL, &log, &context), EWA_OK);
    assert_true(set.flat && set.scales[0] == 1 && set.scales[1] == 1 && set.scales[2] == 0);
    ewa_gaussians_free(&set);
    ewa_context_destroy(&context);
}

/// A filter widens, and the opacity falls as the volume grows.
static void filtered(void **state) {
    (void)state;
    char text[2048];
    snprintf(text, sizeof text,
             "%selement vertex 1\n%sproperty float filter_3D\nend_header\n0 0 0 0 0 0 0 0 0 0.69314718 1 0 0 "
             "0 2\n",
             head, plain);
    check_log log;
    ewa_context *context;
    ewa_gaussians set;
    ewa_gaussian_facts facts;
    assert_int_equal(load(text, strlen(text), &set, &facts, &log, &context), EWA_OK);
    assert_true(facts.filtered && set.antialiased);
    check_near(set.scales[0], sqrt(5));
    check_near(set.scales[2], sqrt(8));
    check_near(set.opacities[0], 0.5 * sqrt(4.0 / 200));
    ewa_gaussians_free(&set);
    ewa_context_destroy(&context);
}

/// Coordinates of a map in doubles keep their digits by the origin.
static void doubles(void **state) {
    (void)state;
    char text[4096] =
        "ply\nformat binary_big_endian 1.0\nelement first 1\nproperty uchar skipped\nelement vertex 2\n"
        "property double x\nproperty double y\nproperty double z\n";
    strcat(text, strstr(plain, "property float f_dc_0"));
    strcat(text, "end_header\n");
    size_t at = strlen(text);
    text[at++] = 'x';
    const double centers[2][3] = {{4000000.125, -500000.0625, 1.5}, {4000001.375, -500000.03125, 2.5}};
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 3; k++) {
            uint64_t bits;
            memcpy(&bits, &centers[i][k], 8);
            for (int b = 0; b < 8; b++) text[at++] = (char)(bits >> (56 - 8 * b));
        }
        const float rest[11] = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0};
        for (int k = 0; k < 11; k++) {
            uint32_t bits;
            memcpy(&bits, &rest[k], 4);
            for (int b = 0; b < 4; b++) text[at++] = (char)(bits >> (24 - 8 * b));
        }
    }
    check_log log;
    ewa_context *context;
    ewa_gaussians set;
    assert_int_equal(load(text, at, &set, NULL, &log, &context), EWA_OK);
    for (int i = 0; i < 6; i++)
        assert_true(set.origin[i % 3] + (double)set.centers[i] == centers[i / 3][i % 3]);
    ewa_gaussians_free(&set);
    for (size_t cut = 0; cut < at; cut++) {
        assert_int_not_equal(ewa_gaussians_load_memory(context, text, cut, "test", NULL, &set, NULL), EWA_OK);
        assert_null(set.centers);
        assert_true(log.count > 0);
        log.count = 0;
    }
    ewa_context_destroy(&context);
}

static void refused(void **state) {
    (void)state;
    static const struct {
        const char *count, *more, *record, *reason;
    } cases[] = {
        {"1", "", "nan 2 3 0 0 0 0 0 0 0 1 0 0 0",
         "Gaussian 0 of 1: a coordinate of the centre is not finite"},
        {"1", "", "1 2 3 0 0 0 0 0 nan 0 1 0 0 0", "a scale is not finite"},
        {"1", "", "1 2 3 0 0 0 0 0 100 0 1 0 0 0", "a scale is not finite"},
        {"1", "", "1 2 3 0 0 0 0 0 1e30 0 1 0 0 0", "a scale is not finite"},
        {"1", "", "1 2 3 0 0 0 0 0 0 0 0 0 0 0", "the quaternion is zero"},
        {"1", "", "1 2 3 0 0 0 0 0 0 0 1 inf 0 0", "the quaternion is zero or not finite"},
        {"1", "", "1 2 3 0 0 0 nan 0 0 0 1 0 0 0", "the opacity"},
        {"1", "", "1 2 3 0 inf 0 0 0 0 0 1 0 0 0", "a coefficient of the colour"},
        {"1", "property float filter_3D\n", "1 2 3 0 0 0 0 0 0 0 1 0 0 0 inf", "a scale is not finite"},
        {"0", "", "", "there are no Gaussians"},
        {"99999999999", "", "1 2 3 0 0 0 0 0 0 0 1 0 0 0", "the file ends in"},
        {"1", "property float f_rest_0\n", "1 2 3 0 0 0 0 0 0 0 1 0 0 0 1", "1 coefficients f_rest"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[2048];
        snprintf(text, sizeof text, "%selement vertex %s\n%s%send_header\n%s\n", head, cases[i].count, plain,
                 cases[i].more, cases[i].record);
        check_log log;
        ewa_context *context;
        ewa_gaussians set;
        assert_int_equal(load(text, strlen(text), &set, NULL, &log, &context), EWA_ERROR_FORMAT);
        if (!strstr(log.text, cases[i].reason))
            fail_msg("'%s' says nothing of '%s'", log.text, cases[i].reason);
        assert_null(set.centers);
        ewa_context_destroy(&context);
    }
}

/// Logits of any size are opacities.
static void steep(void **state) {
    (void)state;
    char text[2048];
    snprintf(text, sizeof text,
             "%selement vertex 2\n%send_header\n0 0 0 0 0 0 1e30 -inf 0 0 1 0 0 0\n0 0 0 0 0 0 -1e30 -1e30 0 "
             "0 1 0 0 0\n",
             head, plain);
    check_log log;
    ewa_context *context;
    ewa_gaussians set;
    assert_int_equal(load(text, strlen(text), &set, NULL, &log, &context), EWA_OK);
    assert_true(set.opacities[0] == 1 && set.opacities[1] == 0 && set.scales[0] == 0 && set.scales[3] == 0);
    ewa_gaussians_free(&set);
    ewa_context_destroy(&context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(columns),  cmocka_unit_test(harmonics), cmocka_unit_test(flat),
        cmocka_unit_test(filtered), cmocka_unit_test(doubles),   cmocka_unit_test(refused),
        cmocka_unit_test(steep),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
