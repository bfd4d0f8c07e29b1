// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// PTX: matrices on row vectors, several scans, missing points, colours, damage, every truncation.
#include "io/rows_check.h"

#define STILL "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"
// A quarter turn about z: the x of the scanner becomes y of the world; then a step.
#define TURNED "10 20 30\n0 1 0\n-1 0 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n10 20 30 1\n"

TEST_WITHIN(test_scans, set_up, tear_down) {
    OWNED(ewa_cloud_destroy)
    ewa_cloud *cloud = rows_load("2\n2\n" STILL "1 2 3 0.5\n0 0 0 0.5\n4 5 6 0.25\n-1 0 0 1\n"
                                 "1\n2\n" TURNED "1 2 3 0.125 255 7 0\n4 5 6 0 1 2 3\n");
    rows_expect(cloud, 5, "position,intensity,color,scan");
    rows_find(cloud, EWA_POSITION, EWA_F64, 3);
    rows_find(cloud, "intensity", EWA_F32, 1);
    rows_find(cloud, EWA_COLOR, EWA_U8, 3);
    rows_find(cloud, "scan", EWA_U16, 1);
    rows_expect_world(cloud, 0, 1, 2, 3);
    rows_expect_world(cloud, 1, 4, 5, 6);
    rows_expect_world(cloud, 3, 10 - 2, 20 + 1, 33);
    rows_expect_world(cloud, 4, 10 - 5, 20 + 4, 36);
    assert_true(rows_number(cloud, "intensity", 1, 0) == 0.25);
    assert_true(rows_number(cloud, "scan", 2, 0) == 0 && rows_number(cloud, "scan", 3, 0) == 1);
    assert_true(rows_number(cloud, EWA_COLOR, 3, 0) == 255 && rows_number(cloud, EWA_COLOR, 4, 2) == 3);
    assert_string_equal(ewa_cloud_note(cloud, "scanners", NULL), "0 0 0\n10 20 30\n");
}

TEST_WITHIN(test_places, set_up, tear_down) {
    OWNED(ewa_cloud_destroy)
    ewa_cloud *far = rows_load("1\r\n3\r\n" STILL
                               "4200000.125 5200007.3 1 0.5\r\n0 0 0 0.5\r\n4200001.1 5200000.7 2 1\r\n"),
              *near = rows_load("1\n3\n" STILL "0.125 7.3 1 0.5\n0 0 0 0.5\n1.1 0.7 2 1");
    rows_expect(far, 2, "position,intensity");
    rows_expect_same(far, near);
    double origin_world[3];
    ewa_cloud_origin(far, origin_world);
    assert_true(origin_world[0] == 4200000 && origin_world[1] == 5200000 && origin_world[2] == 0);
    ewa_cloud_destroy(&far);
    // The step of the matrix, in whole metres, is exact as well.
    far = rows_load(
        "1\n3\n4200000 5200000 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n4200000 5200000 0 1\n"
        "0.125 7.3 1 0.5\n0 0 0 0.5\n1.1 0.7 2 1");
    rows_expect_same(far, near);
}

TEST_WITHIN(test_damage, set_up, tear_down) {
    static const struct {
        const char *text, *said;
    } files[] = {
        {"2\n1\n" STILL "1 2 3 0.5\n1 2 x 0.5\n", "t: line 12, column 3: 'x' is no number"},
        {"2\n1\n" STILL "1 2 3 0.5\n1 2 3\n", "t: line 12: the line ends too early, before column 4"},
        {"2\n1\n" STILL "1 2 3 0.5\n1 2 3 1 7\n", "t: line 12, column 5: '7' stands behind the last column"},
        {"2\n1\n" STILL "1 2 3 0.5 1 2 3\n1 2 3 1 7 8 256\n", "t: line 12, column 7: '256' does not fit"},
        {"2\n2\n" STILL "1 2 3 0.5\n1 2 3 0.5\n",
         "the file ends in scan 1, of 2 x 2 points; 2 are not there"},
        {"4294967295\n4294967295\n" STILL "1 2 3 0.5\n", "18446744065119617024 are not there"},
        {"1\n1\n" STILL "1 2 3 0.5\n1\n1\n0 0 0\n", "t: the file ends before the points of scan 2"},
        {"1\n1\n" STILL "1 2 3 0.5\n1 2 3 0.5\n", "t: line 12: '1 2 3 0.5' is not what stands before scan 2"},
    };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) rows_refuse(files[i].text, files[i].said);
}

TEST_WITHIN(test_keep_going, set_up, tear_down) {
    WITH_DEFAULTS(ewa_cloud_load_options, options);
    options.keep_going = true;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    uint64_t lost_count = 0;
    assert_int_equal(
        rows_read("2\n2\n" STILL "1 2 3 0.5\n1 2 x 0.5\n4 5 6 1\n", &options, &cloud, &lost_count), EWA_OK);
    assert_int_equal(lost_count, 2); // a line that is damaged, and one that is not there
    rows_expect(cloud, 2, "position,intensity");
    rows_expect_world(cloud, 1, 4, 5, 6);
}

TEST_WITHIN(test_truncation, set_up, tear_down) {
    const char *text =
        "1\n2\n" STILL "1 2 3 0.5 1 2 3\n4 5 6 0.25 4 5 6\n2\n1\n" TURNED "1 2 3 0 1 2 3\n4 5 6 0 1 2 3\n";
    const size_t length = strlen(text),
                 first_length = strlen("1\n2\n" STILL "1 2 3 0.5 1 2 3\n4 5 6 0.25 4 5 6\n");
    for (size_t cut = 0; cut < length; cut++) {
        OWNED(check_free) char *part = malloc(cut + 1);
        assert_non_null(part);
        memcpy(part, text, cut);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
        const ewa_status status = ewa_cloud_load_memory(context, cut ? part : "", cut, "t", &cloud);
        // Only without the final line feed, or behind a scan, all points are there.
        const bool whole = cut + 1 >= length || cut == first_length || cut == first_length - 1;
        if (whole) assert_int_equal(status, EWA_OK);
        if (!whole && cut + 1 < length) assert_int_not_equal(status, EWA_OK);
    }
}

TEST_WITHIN(test_threads, set_up, tear_down) {
    enum { POINTS = 20000, BYTES = 64 };
    OWNED(check_free) char *text = malloc(POINTS * BYTES);
    assert_non_null(text);
    size_t length = (size_t)snprintf(text, BYTES, "200\n100\n");
    length += (size_t)snprintf(text + length, 200, "%s", TURNED);
    uint64_t expected = 0;
    for (int i = 0; i < POINTS; i++) {
        const bool nothing = i % 3 == 1;
        expected += !nothing;
        length += (size_t)(nothing ? snprintf(text + length, BYTES, "0 0 0 0.5\n")
                                   : snprintf(text + length, BYTES, "%d.%d 1 2 0.25\n", i, i % 10));
    }
    OWNED(ewa_cloud_destroy) ewa_cloud *whole = rows_load(text);
    rows_expect(whole, expected, "position,intensity");
    ewa_context *first = context;
    context = check_context(5, NULL);
    ewa_cloud *other = rows_load(text);
    rows_expect_same(whole, other);
    ewa_cloud_destroy(&other);
    ewa_context_destroy(&context);
    context = first;
}

int main(void) { return RUN_TESTS(NULL, NULL); }
