// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ASCII grids of heights: where cells are, cells without a height, heads, damage, every truncation.
#include "io/rows_check.h"

#define HEAD "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 50\ncellsize 10\n"

/// Rows from the north, points in the middles of cells, none where there is no height.
TEST_WITHIN(test_places, set_up, tear_down) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = rows_load(HEAD "NODATA_value -1\n1 2 3\n4 -1.0 6.5\n");
    rows_expect(cloud, 5, "position");
    rows_find(cloud, EWA_POSITION, EWA_F64, 3);
    rows_expect_world(cloud, 0, 105, 65, 1);
    rows_expect_world(cloud, 2, 125, 65, 3);
    rows_expect_world(cloud, 3, 105, 55, 4);
    rows_expect_world(cloud, 4, 125, 55, 6.5);
    ewa_cloud_destroy(&cloud);
    // Middles of cells that are not square, names in capitals, lines cut anywhere; usual and rounded marks.
    cloud = rows_load(
        "NROWS 2\r\nNCOLS 3\r\nXLLCENTER -7.5\r\nYLLCENTER 45\r\nDX 0.25\r\nDY 0.5\r\n1 2\r\n3 -9999\r\n"
        "-3.40282e+38 nan");
    rows_expect(cloud, 3, "position");
    rows_expect_world(cloud, 0, -7.5, 45.5, 1);
    rows_expect_world(cloud, 2, -7, 45.5, 3);
    ewa_cloud_destroy(&cloud);
    // Far from zero, relative to a whole thousand.
    cloud = rows_load("ncols 1\nnrows 1\nxllcorner 4200000.25\nyllcorner 5200000\ncellsize 0.5\n7\n");
    double origin_world[3];
    ewa_cloud_origin(cloud, origin_world);
    assert_true(origin_world[0] == 4200000 && origin_world[1] == 5200000 && origin_world[2] == 0);
    rows_expect_world(cloud, 0, 4200000.5, 5200000.25, 7);
}

/// Degrees with heights in metres, which slopes tell, become metres; of marks and gentle slopes nothing is said.
TEST_WITHIN(test_degrees, set_up, tear_down) {
    OWNED(ewa_cloud_destroy)
    ewa_cloud *cloud = rows_load("ncols 3\nnrows 2\nxllcorner 7\nyllcorner 49.99\ncellsize 0.01\n"
                                 "-9999 200 230\n190 -9999 250\n");
    rows_expect(cloud, 4, "position");
    assert_string_equal(ewa_cloud_note(cloud, "file.degrees", NULL), "longitude 7.015, latitude 50");
    double places[12];
    ewa_attribute_read_f64(ewa_cloud_find(cloud, EWA_POSITION), 0, 4, places);
    // A degree of longitude is 71,696 m at 50 degrees, one of latitude 111,229 m.
    assert_true(fabs(places[3] - places[0] - 716.96) < 0.01 && fabs(places[1] - places[10] - 1112.29) < 0.01);
    assert_true(places[2] == 200 && places[11] == 250);
    ewa_cloud_destroy(&cloud);
    cloud = rows_load("ncols 3\nnrows 2\nxllcorner 7\nyllcorner 49\ncellsize 1\n-9999 8 9\n7 -9999 9\n");
    rows_expect_world(cloud, 0, 8.5, 50.5, 8);
    assert_null(ewa_cloud_note(cloud, "file.degrees", NULL));
}

TEST_WITHIN(test_refused, set_up, tear_down) {
    static const struct {
        const char *text, *said;
    } files[] = {
        {HEAD "1 2 3\n4 5\n", "t: the file ends in row 2 of 2"},
        {HEAD "1 2 3\n4 x 6\n", "t: line 7, row 2: 'x' is no number"},
        {HEAD "1 2 3\n4 5e 6\n", "'5e' is no number"},
        {"ncols 3\nnrows two\n1 2 3\n", "t: line 2: 'two' of nrows is no number"},
        {"ncols 3\nnrows 2\nheight 7\n1 2 3\n", "t: line 3: 'height' is no name"},
        {"ncols 3\nxllcorner 1\n1 2 3\n", "nrows of the ASCII grid is 0"},
        {"ncols 2.5\nnrows 1\n1 2 3\n", "ncols of the ASCII grid is 2.5"},
        {"ncols 3\nnrows 1\nxllcorner 1\nyllcorner 1\n1 2 3\n", "where its cells are"},
        {"ncols 3\nnrows 1\nxllcorner 1\ncellsize 1\n1 2 3\n", "where its cells are"},
        {"ncols 3\nnrows 1\nxllcorner 1\nyllcorner 1\ncellsize -1\n1 2 3\n", "where its cells are"},
        {"ncols 1000000000\nnrows 1000000000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n",
         "the file ends in row 1"},
    };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) rows_refuse(files[i].text, files[i].said);
}

TEST_WITHIN(test_keep_going, set_up, tear_down) {
    WITH_DEFAULTS(ewa_cloud_load_options, options);
    options.keep_going = true;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    uint64_t lost_count = 0;
    assert_int_equal(rows_read(HEAD "1 2x 3\n4", &options, &cloud, &lost_count), EWA_OK);
    assert_int_equal(lost_count, 3); // a word, and two cells that are not there
    rows_expect(cloud, 3, "position");
    rows_expect_world(cloud, 1, 125, 65, 3); // in its own cell
    rows_expect_world(cloud, 2, 105, 55, 4);
}

/// Cut anywhere it is refused, but within the last number, which only is a shorter one.
TEST_WITHIN(test_truncation, set_up, tear_down) {
    const char *text = HEAD "1 2 3\n4 5 678\n";
    const size_t length = strlen(text);
    for (size_t cut = 0; cut < length; cut++) {
        OWNED(check_free) char *part = malloc(cut + 1);
        assert_non_null(part);
        memcpy(part, text, cut);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
        const ewa_status status = ewa_cloud_load_memory(context, cut ? part : "", cut, "t", &cloud);
        if (cut + 3 >= length)
            assert_int_equal(status, EWA_OK);
        else
            assert_int_not_equal(status, EWA_OK);
    }
}

/// Piece by piece as at once.
TEST_WITHIN(test_pieces, set_up, tear_down) {
    char path[512];
    FILE *file = fopen(scratch_path("pieces.asc", path), "wb");
    assert_non_null(file);
    fputs(HEAD "1 -9999 3\n4 5 6\n", file);
    fclose(file);
    ewa_cloud_reader *reader = NULL;
    assert_int_equal(ewa_cloud_reader_open(context, path, NULL, &reader), EWA_OK);
    static const double heights[] = {1, 3, 4, 5, 6};
    ewa_cloud *piece = NULL;
    uint64_t count = 0;
    while (ewa_cloud_reader_next(reader, 2, &piece) == EWA_OK && piece && ewa_cloud_point_count(piece) > 0) {
        for (uint64_t i = 0; i < ewa_cloud_point_count(piece); i++, count++)
            assert_true(rows_number(piece, EWA_POSITION, i, 2) == heights[count]);
        ewa_cloud_destroy(&piece);
    }
    ewa_cloud_destroy(&piece);
    assert_int_equal(count, 5);
    ewa_cloud_reader_close(&reader);
    ewa_model_format format;
    assert_int_equal(ewa_model_probe(context, path, &format), EWA_OK);
    assert_int_equal(format, EWA_MODEL_GRID);
    assert_string_equal(ewa_model_format_name(format), "ASCII grid");
}

int main(void) { return RUN_TESTS(NULL, NULL); }
