// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// LAZ files that end too early, read with keep_going: the points up to the cut, or of layered chunks, up to the last
// whole one, as they are in the whole file.
#include "io/scratch.h"

#include <math.h>

enum { POINTS = 4000, CHUNK_POINTS = 700, STEP = 61 };

static ewa_cloud *make_cloud(ewa_context *context, bool layered) {
    ewa_cloud *cloud = NULL;
    void *data = NULL;
    assert_int_equal(ewa_cloud_create(context, POINTS, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, &data), EWA_OK);
    double *places = data;
    for (int i = 0; i < POINTS; i++) {
        places[3 * i] = floor(1e4 * sin(i / 50.0)) / 100;
        places[3 * i + 1] = floor(1e4 * cos(i / 77.0)) / 100;
        places[3 * i + 2] = floor(1e3 * sin(i / 9.0)) / 100;
    }
    assert_int_equal(ewa_cloud_add(cloud, "classification", EWA_U8, 1, &data), EWA_OK);
    for (int i = 0; i < POINTS; i++) ((uint8_t *)data)[i] = (uint8_t)(layered && i % 9 == 0 ? 77 : i % 4);
    return cloud;
}

/// Loads a file's first bytes; NULL when nothing of it can be read.
static ewa_cloud *load_cut(ewa_context *context, const uint8_t *bytes, size_t length, const char *path,
                           uint64_t *lost_count) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, length, file), length);
    fclose(file);
    ewa_cloud_load_options options;
    ewa_cloud_load_options_init(&options, sizeof options);
    options.keep_going = true;
    ewa_cloud_reader *reader = NULL;
    ewa_cloud *cloud = NULL;
    *lost_count = 0;
    ewa_status status = ewa_cloud_reader_open(context, path, &options, &reader);
    if (status == EWA_OK) status = ewa_cloud_reader_next(reader, 2 * POINTS, &cloud);
    if (status == EWA_OK) *lost_count = ewa_cloud_reader_lost_count(reader);
    ewa_cloud_reader_close(&reader);
    if (status != EWA_OK) ewa_cloud_destroy(&cloud);
    return cloud;
}

/// Whether a cloud is the begin of another.
static void expect_begin(const ewa_cloud *part, const ewa_cloud *whole) {
    const uint64_t count = ewa_cloud_point_count(part);
    static double a[3 * POINTS], b[3 * POINTS];
    assert_true(count <= POINTS);
    static const char *const names[] = {EWA_POSITION, "classification"};
    for (int n = 0; n < 2; n++) {
        ewa_attribute_read_f64(ewa_cloud_find(part, names[n]), 0, count, a);
        ewa_attribute_read_f64(ewa_cloud_find(whole, names[n]), 0, count, b);
        for (uint64_t i = 0; i < count * (n ? 1 : 3); i++)
            if (a[i] != b[i]) fail_msg("%s %llu is %g, not %g", names[n], (unsigned long long)i, a[i], b[i]);
    }
}

static uint32_t number_at(const uint8_t *bytes) {
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static void test_cut(void **state) {
    check_log log = {.count = 0};
    ewa_context *context = check_context(2, &log);
    for (int layered = 0; layered < 2; layered++) {
        char path[512], cut_path[512];
        ewa_cloud *made = make_cloud(context, layered), *whole = NULL;
        ewa_cloud_save_options options;
        ewa_cloud_save_options_init(&options, sizeof options);
        options.chunk_points = CHUNK_POINTS;
        options.step_world = 0.01;
        assert_int_equal(ewa_cloud_save(made, scratch_path("whole.laz", path), &options), EWA_OK);
        ewa_cloud_destroy(&made);
        assert_int_equal(ewa_cloud_load(context, path, &whole), EWA_OK);
        assert_int_equal(ewa_cloud_point_count(whole), POINTS);
        size_t size_bytes;
        uint8_t *bytes = scratch_read(path, &size_bytes);
        assert_true(bytes[104] % 64 < 6 ? !layered : layered);
        scratch_path("cut.laz", cut_path);
        uint64_t last = 0, counts = 0;
        for (size_t length = 227; length < size_bytes; length += STEP) {
            uint64_t lost_count;
            log.count = 0;
            ewa_cloud *part = load_cut(context, bytes, length, cut_path, &lost_count);
            assert_true(log.count > 0);
            if (!part) continue;
            const uint64_t count = ewa_cloud_point_count(part);
            assert_true(count >= last);
            assert_int_equal(count + lost_count, POINTS);
            if (layered) assert_true(count % CHUNK_POINTS == 0 || count == POINTS);
            counts += count != last;
            last = count;
            expect_begin(part, whole);
            ewa_cloud_destroy(&part);
        }
        print_message("%s: %llu counts, %llu points at last, %zu bytes\n", layered ? "layered" : "flat",
                      (unsigned long long)counts, (unsigned long long)last, size_bytes);
        // Nearly every step brings points more; of layered chunks, every chunk.
        assert_true(layered ? counts >= POINTS / CHUNK_POINTS : counts > size_bytes / STEP * 9 / 10 - 12);
        // Nothing is lost where only the table is.
        const uint32_t points_at = number_at(bytes + 96), table_at = number_at(bytes + points_at);
        uint64_t lost_count;
        ewa_cloud *part = load_cut(context, bytes, table_at, cut_path, &lost_count);
        assert_int_equal(ewa_cloud_point_count(part), POINTS);
        assert_int_equal(lost_count, 0);
        expect_begin(part, whole);
        ewa_cloud_destroy(&part);
        free(bytes);
        ewa_cloud_destroy(&whole);
    }
    ewa_context_destroy(&context);
}

static ewa_status load_failing(ewa_context *context, void *user) {
    size_t size_bytes;
    uint8_t *bytes = scratch_read(user, &size_bytes);
    ewa_cloud_load_options options;
    ewa_cloud_load_options_init(&options, sizeof options);
    options.keep_going = true;
    ewa_cloud_reader *reader = NULL;
    ewa_cloud *cloud = NULL;
    ewa_status status = ewa_cloud_reader_open(context, user, &options, &reader);
    if (status == EWA_OK) status = ewa_cloud_reader_next(reader, 2 * POINTS, &cloud);
    ewa_cloud_reader_close(&reader);
    ewa_cloud_destroy(&cloud);
    free(bytes);
    return status;
}

static void test_failing_allocations(void **state) {
    char path[512];
    scratch_fail_each(load_failing, (void *)(uintptr_t)scratch_path("cut.laz", path));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_cut),
                                       cmocka_unit_test(test_failing_allocations)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
