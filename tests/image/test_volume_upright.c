// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What is up in volumes whose file does not say, along every axis and both ways: a head on a neck that the last slice cuts,
// slices of a head that are cut at both ends, and what nothing tells of.
#include "check.h"
#include "image/volume_upright.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 100 };

/// A body by its height z in [-1, 1] and places beside it: whether there is matter.
typedef bool body(double x, double y, double z);

static bool head_on_neck(double x, double y, double z) {
    const bool head = x * x / 0.3 + y * y / 0.45 + (z - 0.2) * (z - 0.2) / 0.36 < 1;
    return head || (x * x / 0.3 + y * y / 0.45 < 0.68 && z < 0.2);
}

/// Cut at the crown, which is an ellipse, and at the jaw, whose chin and neck are none.
static bool slices_of_head(double x, double y, double z) {
    if (z > -0.2) return x * x / 0.36 + y * y / 0.56 < 1 - (z - 0.4) * (z - 0.4);
    const bool neck = x * x + (y - 0.35) * (y - 0.35) < 0.1, jaw = fabs(x) < 0.12 && fabs(y + 0.2) < 0.55;
    return neck || jaw;
}

static bool ball(double x, double y, double z) { return x * x + y * y + z * z < 0.5; }

static bool column(double x, double y, double z) { return x * x + y * y < 0.3 && fabs(z) < 2; }

/// A frame is no base, though nothing else ends there.
static bool frame(double x, double y, double z) {
    const double beside = fmax(fabs(x), fabs(y));
    return z < -0.9 ? beside > 0.6 && beside < 0.8 : x * x + y * y + z * z < 0.35;
}

/// Fills a volume with a body whose up is along `axis`, towards its last index or its first.
static void fill(const ewa_volume *volume, body *is_matter, int axis, bool to_last) {
    uint8_t *next = volume->voxels;
    srand(7);
    uint32_t i[3];
    for (i[2] = 0; i[2] < volume->dims[2]; i[2]++)
        for (i[1] = 0; i[1] < volume->dims[1]; i[1]++)
            for (i[0] = 0; i[0] < volume->dims[0]; i[0]++) {
                double p[3];
                for (int a = 0; a < 3; a++) p[a] = 2 * (i[a] + 0.5) / volume->dims[a] - 1;
                const double up = to_last ? p[axis] : -p[axis];
                *next++ = (uint8_t)((is_matter(p[(axis + 1) % 3], p[(axis + 2) % 3], up) ? 150 : 20) + rand() % 20);
            }
}

/// What is found, as "-y"; "" for nothing.
static const char *found(const ewa_volume *volume, char text[4]) {
    double up[3] = {0, 0, 0};
    const char *why = NULL;
    assert_int_equal(ewa_volume_find_up(volume, up, &why), EWA_OK);
    text[0] = 0;
    for (int c = 0; c < 3; c++)
        if (fabs(up[c]) > 0.99) snprintf(text, 4, "%s%c", up[c] < 0 ? "-" : "", "xyz"[c]);
    assert_true((text[0] != 0) == (why != NULL));
    return text;
}

TEST(test_every_way) {
    static body *const bodies[] = {head_on_neck, slices_of_head};
    static const char *const names[2][3] = {{"", "-y", "-z"}, {"", "y", "z"}}; // x is never up
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    for (int b = 0; b < 2; b++)
        for (int axis = 0; axis < 3; axis++)
            for (int last = 0; last < 2; last++) {
                OWNED(ewa_volume_free) ewa_volume volume;
                char text[4];
                const uint32_t dims[3] = {SIDE, SIDE + 9, SIDE - 8};
                assert_int_equal(ewa_volume_create(context, dims, EWA_U8, &volume), EWA_OK);
                fill(&volume, bodies[b], axis, last);
                if (strcmp(found(&volume, text), names[last][axis]) != 0) fail_msg("body %d, axis %d, %d: '%s'", b, axis, last, text);
                // Where the axes of the voxels point in the world is what counts.
                for (int c = 0; c < 3; c++) {
                    const double x = volume.index_to_world[c];
                    volume.index_to_world[c] = -volume.index_to_world[8 + c];
                    volume.index_to_world[8 + c] = x;
                }
                static const char *const turned[2][3] = {{"-z", "-y", ""}, {"z", "y", ""}};
                assert_string_equal(found(&volume, text), turned[last][axis]);
            }
}

TEST(test_nothing_tells) {
    static body *const bodies[] = {ball, column, frame};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    const uint32_t dims[3] = {SIDE, SIDE, SIDE}, slice[3] = {SIDE, SIDE, 1};
    OWNED(ewa_volume_free) ewa_volume volume;
    char text[4];
    for (int b = 0; b < 3; b++) {
        assert_int_equal(ewa_volume_create(context, dims, EWA_U8, &volume), EWA_OK);
        fill(&volume, bodies[b], 2, true);
        if (*found(&volume, text)) fail_msg("body %d: '%s'", b, text);
        ewa_volume_free(&volume);
    }
    assert_int_equal(ewa_volume_create(context, slice, EWA_U8, &volume), EWA_OK);
    fill(&volume, head_on_neck, 1, true);
    assert_string_equal(found(&volume, text), "");
    ewa_volume_free(&volume);
    assert_int_equal(ewa_volume_create(context, dims, EWA_F32, &volume), EWA_OK);
    assert_string_equal(found(&volume, text), ""); // all zeros
    float *voxels = volume.voxels;
    for (size_t i = 0; i < (size_t)SIDE * SIDE * SIDE; i++) voxels[i] = i % 2 ? NAN : INFINITY;
    assert_string_equal(found(&volume, text), "");
}

/// A few values far beyond all others, and voxels that are none, change nothing; nor does a volume of many voxels.
TEST_ON(test_outliers, 1) {
    const uint32_t dims[3] = {150, 140, 260};
    OWNED(ewa_volume_free) ewa_volume bytes, floats;
    char text[4];
    assert_int_equal(ewa_volume_create(context, dims, EWA_U8, &bytes), EWA_OK);
    assert_int_equal(ewa_volume_create(context, dims, EWA_F32, &floats), EWA_OK);
    fill(&bytes, head_on_neck, 2, false);
    const size_t count = (size_t)dims[0] * dims[1] * dims[2];
    const uint8_t *from = bytes.voxels;
    float *to = floats.voxels;
    for (size_t i = 0; i < count; i++) to[i] = i % 9973 == 0 ? 1e9f : i % 1009 == 0 ? NAN : (float)from[i];
    assert_string_equal(found(&bytes, text), "-z");
    assert_string_equal(found(&floats, text), "-z");
}

TEST(test_memory) {
    check_memory memory = {.calls_left = -1};
    ewa_context_options options;
    ewa_context_options_init(&options, sizeof options);
    options.allocator = check_allocator(&memory);
    options.thread_count = 1;
    OWNED(ewa_context_destroy) ewa_context *context;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    const uint32_t dims[3] = {SIDE, SIDE, SIDE};
    OWNED(ewa_volume_free) ewa_volume volume;
    assert_int_equal(ewa_volume_create(context, dims, EWA_U8, &volume), EWA_OK);
    fill(&volume, head_on_neck, 2, true);
    for (long which = 0; which < 2; which++) {
        double up[3] = {0, 0, 0};
        const char *why = NULL;
        memory.calls_left = which;
        assert_int_equal(ewa_volume_find_up(&volume, up, &why), EWA_ERROR_MEMORY);
        memory.calls_left = -1;
        assert_null(why);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
