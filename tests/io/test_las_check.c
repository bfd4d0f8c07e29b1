// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// LAS and LAZ beside their headers: bounds and numbers of returns that do not fit what was read are said, right ones are not.
#include "las_sample.h"
#include "scratch.h"

enum { POINTS = 120000, HIGH_X_AT = 179, LOW_Z_AT = 219, RETURNS_AT = 111 };

typedef struct said {
    int warnings, notes;
    char text[1024];
} said;

static void keep(void *user, ewa_severity severity, const char *text) {
    said *s = user;
    s->warnings += severity == EWA_SEVERITY_WARNING;
    s->notes += severity == EWA_SEVERITY_NOTE && strstr(text, "the header says") != NULL;
    if (severity <= EWA_SEVERITY_NOTE) snprintf(s->text, sizeof s->text, "%s", text);
}

/// Writes points as LAS or LAZ, by the suffix, and returns its bytes; the caller frees.
static uint8_t *make(const char *name, size_t *size_bytes) {
    char path[512];
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, POINTS);
    void *position = NULL, *number = NULL;
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, &position), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, "return_number", EWA_U8, 1, &number), EWA_OK);
    for (int i = 0; i < POINTS; i++) {
        double *p = (double *)position + 3 * i;
        p[0] = 0.25 * (i % 400), p[1] = 0.5 * (i / 400), p[2] = 100 + 0.125 * (i % 37);
        ((uint8_t *)number)[i] = (uint8_t)(1 + i % 3);
    }
    assert_int_equal(ewa_cloud_save(cloud, scratch_path(name, path), NULL), EWA_OK);
    return scratch_read(path, size_bytes);
}

/// Loads bytes and says what was said.
static said load(const uint8_t *bytes, size_t size_bytes, uint32_t threads) {
    said s = {0};
    WITH_DEFAULTS(ewa_context_options, options);
    options.thread_count = threads;
    options.message = keep;
    options.message_user = &s;
    options.message_level = EWA_SEVERITY_NOTE;
    OWNED(ewa_context_destroy) ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_load_memory(context, bytes, size_bytes, "tile", &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_point_count(cloud), POINTS);
    return s;
}

static void judge(const char *name, uint32_t threads) {
    size_t size_bytes = 0;
    OWNED(check_free) uint8_t *bytes = make(name, &size_bytes);
    assert_true(bytes[25] < 4); // where the numbers of returns are
    said s = load(bytes, size_bytes, threads);
    assert_int_equal(s.warnings + s.notes, 0);
    const double high_x = las_get_f64(bytes + HIGH_X_AT), low_z = las_get_f64(bytes + LOW_Z_AT);
    assert_true(high_x == 99.75 && low_z == 100);

    // A step more or less is how a writer rounds.
    las_put_f64(bytes + HIGH_X_AT, high_x - 1e-4);
    s = load(bytes, size_bytes, threads);
    assert_int_equal(s.warnings + s.notes, 0);
    las_put_f64(bytes + HIGH_X_AT, 50);
    s = load(bytes, size_bytes, threads);
    assert_int_equal(s.warnings, 1);
    assert_string_equal(s.text, "tile: x of the points is from 0 to 99.75; the header says from 0 to 50");
    las_put_f64(bytes + HIGH_X_AT, high_x);

    las_put_f64(bytes + LOW_Z_AT, 12.5);
    s = load(bytes, size_bytes, threads);
    assert_int_equal(s.warnings, 0);
    assert_int_equal(s.notes, 1);
    assert_string_equal(s.text, "tile: z of the points is from 100 to 104.5; the header says from 12.5 to 104.5");
    las_put_f64(bytes + LOW_Z_AT, low_z);

    las_put(bytes + RETURNS_AT + 4, 39999, 4);
    s = load(bytes, size_bytes, threads);
    assert_int_equal(s.warnings, 0);
    assert_string_equal(s.text, "tile: return 2 has 40000 points; the header says 39999");

    // What a header leaves at zero says nothing.
    memset(bytes + RETURNS_AT, 0, 5 * 4);
    memset(bytes + HIGH_X_AT, 0, 6 * 8);
    s = load(bytes, size_bytes, threads);
    assert_int_equal(s.warnings + s.notes, 0);
}

TEST(las_is_checked) {
    judge("checked.las", 1);
    judge("checked.las", 3);
}

TEST(laz_is_checked) {
    judge("checked.laz", 1);
    judge("checked.laz", 3);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
