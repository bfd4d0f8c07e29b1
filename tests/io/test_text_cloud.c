// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clouds of text: separators, heads, columns by names and by numbers, types, exact places, damage.
#include "io/rows_check.h"

TEST_WITHIN(test_separators, set_up, tear_down) {
    static const char *const texts[] = {"1.5 2.5 3\n-4 5.25 6\n",
                                        "1.5\t2.5\t3\n-4\t5.25\t6",
                                        "1.5,2.5,3\n-4,5.25,6\n",
                                        "1.5;2.5;3\n-4;5.25;6\n",
                                        "1,5;2,5;3\n-4;5,25;6\n",
                                        "1,5 2,5 3,0\n-4,0 5,25 6,0\n",
                                        "1,5\t2,5\t3\n-4\t5,25\t6\n",
                                        "  1.5   2.5   3  \n  -4  5.25   6  \n",
                                        "1.5, 2.5, 3\n-4, 5.25, 6\n",
                                        "1.5 , 2.5 , 3\r\n-4 , 5.25 , 6\r\n",
                                        "1.5 2.5 3\r-4 5.25 6\r",
                                        "\xef\xbb\xbf"
                                        "1.5 2.5 3\r\n-4 5.25 6\r\n",
                                        "\n\n1.5 2.5 3\n\n\n-4 5.25 6\n\n",
                                        "# a remark\n1.5 2.5 3\n// another\n-4 5.25 6\n",
                                        "2\n1.5 2.5 3\n-4 5.25 6\n",
                                        "1.5,2.5,3,\n-4,5.25,6,\n",
                                        "+1.5 2.5e0 3.\n-4.0 .525e1 006\n",
                                        "\"1.5\",\"2.5\",\"3\"\n\"-4\",\"5.25\",\"6\"\n",
                                        "X,Y,Z\n1.5,2.5,3\n-4,5.25,6\n",
                                        "\"x\";\"y\";\"z\"\n1,5;2,5;3\n-4;5,25;6\n",
                                        "// X Y Z\n2\n1.5 2.5 3\n-4 5.25 6\n",
                                        "A scan of a thing\n1.5 2.5 3\n-4 5.25 6\n"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = rows_load(texts[i]);
        if (ewa_cloud_point_count(cloud) != 2)
            fail_msg("%d points of: %s", (int)ewa_cloud_point_count(cloud), texts[i]);
        rows_expect(cloud, 2, "position");
        rows_expect_world(cloud, 0, 1.5, 2.5, 3);
        rows_expect_world(cloud, 1, -4, 5.25, 6);
        rows_find(cloud, EWA_POSITION, EWA_F64, 3);
    }
}

TEST_WITHIN(test_utf16, set_up, tear_down) {
    const char text[] = "x,y,z\n1.5,2,3\n4,5,6\n";
    for (int big = 0; big < 2; big++) {
        char wide[2 * sizeof text];
        memcpy(wide, big ? "\xfe\xff" : "\xff\xfe", 2);
        for (size_t i = 0; i + 1 < sizeof text; i++) {
            wide[2 + 2 * i] = big ? 0 : text[i];
            wide[3 + 2 * i] = big ? text[i] : 0;
        }
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
        assert_int_equal(ewa_cloud_load_memory(context, wide, 2 * sizeof text, "t", &cloud), EWA_OK);
        rows_expect(cloud, 2, "position");
        rows_expect_world(cloud, 0, 1.5, 2, 3);
    }
}

TEST_WITHIN(test_names, set_up, tear_down) {
    static const struct {
        const char *text, *names;
    } files[] = {
        {"//X Y Z R G B Nx Ny Nz\n1 2 3 255 0 7 0 0 1\n", "position,color,normal"},
        {"x,y,z,intensity\n1,2,3,4\n", "position,intensity"},
        {"# z y x red green blue alpha\n3 2 1 1 2 3 4\n", "position,color"},
        {"Easting[m];Northing[m];Elevation (m);Return Number;GpsTime\n1;2;3;1;5,5\n",
         "position,return_number,gps_time"},
        {"X,Y,Z,Classification,Scan Angle Rank,\"Point Source ID\",UserData\n1,2,3,2,-5,9,1\n",
         "position,classification,scan_angle,point_source_id,user_data"},
        {"x y z r g\n1 2 3 4 5\n", "position,r,g"},
        {"x,y,z,Scalar field,Scalar field\n1,2,3,4,5\n", "position,Scalar_field,Scalar_field_2"},
        {"x,y,z,position,color\n1,2,3,4,5\n", "position,position_2,color_2"},
        {"x,y,z,-,t\n1,2,3,4,5\n", "position,t"},
        {"x,y,z\n1,2,3,4,5\n", "position,c4,c5"},
        {"# 4 columns, of which nobody knows what they are\n1 2 3 4\n", "position,intensity"},
        {"x y z tu_x tu_y tu_z tv_x tv_y tv_z radius\n1 2 3 1 0 0 0 1 0 .5\n",
         "position,tangent_u,tangent_v,radius"},
    };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = rows_load(files[i].text);
        rows_expect(cloud, 1, files[i].names);
        rows_expect_world(cloud, 0, 1, 2, 3);
    }
}

TEST_WITHIN(test_numbers_without_names, set_up, tear_down) {
    static const struct {
        const char *text, *names;
    } files[] = {
        {"1 2 3 0.5\n1 2 4 0.25\n", "position,intensity"},
        {"1 2 3 4 5\n", "position,c4,c5"},
        {"1 2 3 255 0 7\n1 2 3 1 0 0\n", "position,color"},
        {"1 2 3 0.5 0 0.25\n1 2 3 1 0.5 0\n", "position,color"},
        {"1 2 3 0 0 1\n1 2 3 0.6 -0.8 0\n", "position,normal"},
        {"1 2 3 0.5 -7 0\n", "position,c4,c5,c6"},
        {"1 2 3 -1200 255 0 7\n", "position,intensity,color"},
        {"1 2 3 4 5 6 7\n", "position,intensity,color"},
        {"1 2 3 255 0 7 0.125\n", "position,color,c7"},
        {"1 2 3 255 0 7 255\n1 2 3 9 0 7 255\n1 2 3 9 0 7 255\n", "position,color"},             // an alpha
        {"1 2 3 40 255 255 255\n1 2 3 40 255 255 255\n1 2 3 40 255 255 255\n", "position,intensity,color"}, // white
        {"1 2 3 255 0 7 254\n1 2 3 9 0 7 254\n1 2 3 9 0 7 254\n", "position,intensity,color"},
        {"1 2 3 255 0 7 0 0 1\n1 2 3 5 0 7 0 0.6 0.8\n", "position,color,normal"},
        {"1 2 3 0 0 1 255 0 7\n1 2 3 0 0.6 0.8 9 0 7\n", "position,normal,color"},
        {"1 2 3 4.5 0 0 1\n1 2 3 5.5 0 0.6 0.8\n", "position,intensity,normal"},
        {"1 2 3 900 255 0 7 11\n", "position,intensity,color,c8"},
    };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = rows_load(files[i].text);
        rows_expect(cloud, ewa_cloud_point_count(cloud), files[i].names);
    }
}

TEST_WITHIN(test_types, set_up, tear_down) {
    OWNED(ewa_cloud_destroy)
    ewa_cloud *cloud = rows_load("x,y,z,intensity,classification,a1,a2,a3,a4,a5,a6,a7,gps_time,a8\n"
                                 "1,2,3,5,2.000,255,256,-1,70000,0.25,0.1234567,123456789,1,1e3\n"
                                 "1,2,3,65535,6.000,0,0,300,0,12.125,0.5,0,2,7\n");
    rows_find(cloud, "intensity", EWA_U16, 1);
    rows_find(cloud, "classification", EWA_U8, 1);
    rows_find(cloud, "a1", EWA_U8, 1);
    rows_find(cloud, "a2", EWA_U16, 1);
    rows_find(cloud, "a3", EWA_I16, 1);
    rows_find(cloud, "a4", EWA_U32, 1);
    rows_find(cloud, "a5", EWA_F32, 1);
    rows_find(cloud, "a6", EWA_F64, 1);
    rows_find(cloud, "a7", EWA_F64, 1);
    rows_find(cloud, "gps_time", EWA_F64, 1);
    rows_find(cloud, "a8", EWA_F64, 1);
    assert_true(rows_number(cloud, "classification", 1, 0) == 6);
    assert_true(rows_number(cloud, "a6", 0, 0) == 0.1234567);
    assert_true(rows_number(cloud, "a7", 0, 0) == 123456789);
    assert_true(rows_number(cloud, "a8", 0, 0) == 1000);
    assert_true(rows_number(cloud, "a3", 1, 0) == 300);
    ewa_cloud_destroy(&cloud);
    cloud = rows_load("x,y,z,r,g,b,v\n1,2,3,256,0,65535,\n1,2,3,,1,2,0.5\n1,2,3,7,1,2,NA\n");
    rows_find(cloud, EWA_COLOR, EWA_U16, 3);
    rows_find(cloud, "v", EWA_F32, 1);
    assert_true(isnan(rows_number(cloud, "v", 0, 0)) && isnan(rows_number(cloud, "v", 2, 0)));
    assert_true(rows_number(cloud, "v", 1, 0) == 0.5);
    assert_true(rows_number(cloud, EWA_COLOR, 1, 0) == 0);
    ewa_cloud_destroy(&cloud);
    cloud = rows_load("1 2 3 0.5 1.0 0.0039215686\n1 2 3 0 0.2 0.25\n");
    rows_find(cloud, EWA_COLOR, EWA_U16, 3);
    assert_true(rows_number(cloud, EWA_COLOR, 0, 0) == 32768);
    assert_true(rows_number(cloud, EWA_COLOR, 0, 1) == 65535);
    assert_true(rows_number(cloud, EWA_COLOR, 0, 2) == 257);
}

/// Types hold for numbers that come long after the sample.
TEST_WITHIN(test_late_numbers, set_up, tear_down) {
    enum { ROWS = 40000, BYTES = 40 };
    OWNED(check_free) char *text = malloc(ROWS * BYTES);
    assert_non_null(text);
    size_t length = 0;
    for (int i = 0; i < ROWS; i++)
        length += (size_t)snprintf(text + length, BYTES, "%d %d.%d 1 %d %d 4 1\n", i, i,
                                   i == 30001 ? 1255 : 5, i == 30005 ? -4 : 7, i == 30003 ? 3000 : 3);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = rows_load(text);
    rows_expect(cloud, ROWS, "position,intensity,color");
    rows_find(cloud, "intensity", EWA_I16, 1);
    rows_find(cloud, EWA_COLOR, EWA_U16, 3);
    assert_true(rows_number(cloud, "intensity", 30005, 0) == -4);
    assert_true(rows_number(cloud, EWA_COLOR, 30003, 0) == 3000);
    ewa_coordinate_grid grid;
    ewa_cloud_grid(cloud, &grid);
    assert_true(grid.step_world[1] == 1e-4);
}

TEST_WITHIN(test_places, set_up, tear_down) {
    ewa_cloud *far = rows_load("4200000.125 -5200017.3 99.07\n4200001.1 -5199999.9999 -3\n"),
              *near = rows_load("0.125 -17.3 99.07\n1.1 0.0001 -3\n");
    double origin_world[3];
    ewa_cloud_origin(far, origin_world);
    assert_true(origin_world[0] == 4200000 && origin_world[1] == -5200000 && origin_world[2] == 0);
    rows_expect_same(far, near);
    ewa_coordinate_grid grid;
    ewa_cloud_grid(far, &grid);
    assert_true(grid.step_world[0] == 1e-3 && grid.step_world[1] == 1e-4 && grid.step_world[2] == 1e-2);
    assert_true(ewa_grid_world(&grid, 1, origin_world[1] + rows_number(far, EWA_POSITION, 1, 1)) ==
                -5199999.9999);
    ewa_cloud_destroy(&far);
    ewa_cloud_destroy(&near);
    static const char *const without[] = {"1.0123456789 2 3\n", "1e-3 2 3\n", "1 2 3\n1E2 3 4\n"};
    for (size_t i = 0; i < sizeof without / sizeof without[0]; i++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = rows_load(without[i]);
        ewa_cloud_grid(cloud, &grid);
        assert_true(grid.step_world[0] == 0 && grid.step_world[2] == 1);
    }
}

/// Every decimal, however long, is the nearest double less the origin.
TEST_WITHIN(test_nearest, set_up, tear_down) {
    check_random random = {7};
    for (int i = 0; i < 2000; i++) {
        char text[256];
        const int decimals = (int)(check_random_u64(&random) % 12);
        const int64_t parts = (int64_t)(check_random_u64(&random) % 900000000000) - 450000000000;
        double unit = 1;
        for (int k = 0; k < decimals; k++) unit *= 10;
        const char *sign = parts < 0 ? "-" : "";
        const long long size = parts < 0 ? -parts : parts, scale = (long long)unit;
        if (decimals)
            snprintf(text, sizeof text, "%s%lld.%0*lld 0 0\n2 3 4\n", sign, size / scale, decimals,
                     size % scale);
        else
            snprintf(text, sizeof text, "%s%lld 0 0\n2 3 4\n", sign, size);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = rows_load(text);
        double origin_world[3];
        ewa_cloud_origin(cloud, origin_world);
        // Both are doubles, so one division rounds once.
        const double expected = (double)(parts - (int64_t)origin_world[0] * scale) / (double)scale;
        if (rows_number(cloud, EWA_POSITION, 0, 0) != expected)
            fail_msg("%s gives %.17g", text, rows_number(cloud, EWA_POSITION, 0, 0));
    }
}

TEST_WITHIN(test_damage, set_up, tear_down) {
    static const struct {
        const char *text, *said;
    } files[] = {
        {"1 2 3\n4 5 6\n7 8 9\n4 foo 6\n", "t: line 4, column 2: 'foo' is no number"},
        {"1 2 3\n4 5 6\n7 8 9\n\n4 5\n", "t: line 5: the line ends too early, before column 3"},
        {"1 2 3\n4 5 6\n7 8 9\n4 5 6 7\n", "t: line 4, column 4: '7' stands behind the last column"},
        {"x,y,z\n1,2,3\n4,5,6\n4,5,6x\n8,9,10\n7,8,9\n", "t: line 4, column 3: '6x' is no number"},
        {"1\r2", "not a point file"},
        {"5\n1 2 3\n4 5 6\n", "5 points are announced, 2 lines follow"},
        {"x,y,x\n1,2,3\n", "two columns are 'x'"},
        {"x,y,w\n1,2,3\n", "none of the 3 columns is called z"},
        {"It is a truth universally acknowledged\nthat a man in possession\nof 1 2 3 and so on\n",
         "not a point file"},
        {"{\n\"a\": [1, 2, 3]\n}\n", "not a point file"},
        {"1 2\n3 4\n", "not a point file"},
        {"1 2 3\n1 2 x\n1 y 3\nz 2 3\n", "not a point file"},
        {"OFFER\n1 2 3 4 x\nabc\n", "not a point file"},
        {"# only remarks\n# x y z\n", "not a point file"},
        {"1 2 3\n4 5 \001\n7 8 9\n7 8 9\n7 8 9\n", "not a point file"},
    };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) rows_refuse(files[i].text, files[i].said);
}

TEST_WITHIN(test_keep_going, set_up, tear_down) {
    WITH_DEFAULTS(ewa_cloud_load_options, options);
    const char *text = "1 2 3\n4 5 6\nbad 1 2\n7 8 9\n7 8 9\n7 8 9\n7 8 9\n7 8 9\n1 2\n10 11 12\n13 14 15 "
                       "16\n16 17 18\n1 2 3\n";
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    uint64_t lost_count = 0;
    assert_int_equal(rows_read(text, &options, &cloud, NULL), EWA_ERROR_FORMAT);
    options.keep_going = true;
    messages.count = 0;
    assert_int_equal(rows_read(text, &options, &cloud, &lost_count), EWA_OK);
    assert_int_equal(lost_count, 3);
    assert_int_equal(messages.count, 1);
    assert_non_null(strstr(messages.text, "line 3, column 1: 'bad' is no number; 3 lines near it"));
    rows_expect(cloud, 10, "position");
    rows_expect_world(cloud, 7, 10, 11, 12);
    rows_expect_world(cloud, 9, 1, 2, 3);
    ewa_cloud_destroy(&cloud);
    messages.count = 0;
    assert_int_equal(rows_read("1 2 3\nnan 1 2\n4 5 6\n1 inf 2\n", &options, &cloud, NULL), EWA_OK);
    assert_int_equal(messages.count, 1);
    assert_non_null(strstr(messages.text, "2 points without a place are left out"));
    rows_expect_world(cloud, 1, 4, 5, 6);
}

TEST_WITHIN(test_columns, set_up, tear_down) {
    WITH_DEFAULTS(ewa_cloud_load_options, options);
    options.columns = "intensity,-,z,x,Y";
    ewa_cloud *cloud = NULL;
    assert_int_equal(rows_read("9 8 3 1 2 7\n9 8 6 4 5 7\n", &options, &cloud, NULL), EWA_OK);
    rows_expect(cloud, 2, "intensity,position");
    rows_expect_world(cloud, 1, 4, 5, 6);
    ewa_cloud_destroy(&cloud);
    options.columns = "x,y,z,r";
    assert_int_equal(rows_read("9 8 3\n9 8 6\n", &options, &cloud, NULL), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(messages.text, "are 4, but lines have 3"));
    options.columns = "x,y,-";
    assert_int_equal(rows_read("9 8 3\n9 8 6\n", &options, &cloud, NULL), EWA_ERROR_FORMAT);
}

/// Columns of words are left out, and said.
TEST_WITHIN(test_words, set_up, tear_down) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    const char *text = "x,y,z,kind of thing,v\n1,2,3,a tree,5\n4,5,6,\"a, b\",7\n7,8,9,,11\n1,1,1,tree,9\n";
    messages.count = 0;
    assert_int_equal(ewa_cloud_load_memory(context, text, strlen(text), "t", &cloud), EWA_OK);
    assert_int_equal(messages.count, 1);
    assert_non_null(strstr(messages.text, "column 4, 'kind of thing', holds words"));
    rows_expect(cloud, 4, "position,v");
    assert_true(rows_number(cloud, "v", 1, 0) == 7 && rows_number(cloud, "v", 2, 0) == 11);
}

/// A text that is cut reads as what is left, or is refused; never more points, and all of them those of the whole.
TEST_WITHIN(test_truncation, set_up, tear_down) {
    static const char *const texts[] = {
        "x,y,z,intensity\n100.5,200.25,300,7\n101.5,201.25,301,8\n102.5,202.25,302,9\n103.5,203.25,303,10\n",
        "4\r\n1 2 3\r\n4 5 6\r\n7 8 9\r\n10 11 12\r\n",
        "//X Y Z R G B\n1.5 2 3 255 0 0\n4 5 6 1 2 3\n7 8 9 1 2 3\n"};
    for (size_t t = 0; t < sizeof texts / sizeof texts[0]; t++) {
        const size_t length = strlen(texts[t]);
        for (size_t cut = 0; cut < length; cut++) {
            // Of its own size, so that a sanitizer sees what is read behind it.
            char *text = malloc(cut + 1);
            assert_non_null(text);
            memcpy(text, texts[t], cut);
            ewa_cloud *cloud = NULL;
            messages.count = 0;
            const ewa_status status = ewa_cloud_load_memory(context, cut ? text : "", cut, "t", &cloud);
            assert_int_equal(status == EWA_OK, cloud != NULL);
            assert_int_equal(status == EWA_OK, messages.count == 0);
            if (cloud) assert_true(ewa_cloud_point_count(cloud) <= 4);
            if (t == 1 && cut < length - 4) assert_int_not_equal(status, EWA_OK); // a point is missing
            ewa_cloud_destroy(&cloud);
            free(text);
        }
    }
}

/// Any number of threads and any pieces give the same bytes, and the plain path those of the careful one.
TEST_WITHIN(test_paths, set_up, tear_down) {
    enum { ROWS = 30000, BYTES = 90 };
    check_random random = {3};
    OWNED(check_free) char *plain = malloc(ROWS * BYTES), *odd = malloc(ROWS * BYTES);
    assert_non_null(plain);
    assert_non_null(odd);
    size_t length = 0, odd_length = 0;
    for (int i = 0; i < ROWS; i++) {
        double v[4];
        for (int c = 0; c < 4; c++) v[c] = check_uniform(&random, -1e6, 1e6);
        const int color = (int)(check_random_u64(&random) % 256);
        const int digits = i % 10 == 0 ? 9 : i % 7;
        length += (size_t)snprintf(plain + length, BYTES, "%.*f %.3f %.2f %.4f %d 0 255\n", digits, v[0],
                                   v[1], v[2], v[3], color);
        // Tabs, blanks and quotes in places where the plain path does not go.
        odd_length +=
            (size_t)snprintf(odd + odd_length, BYTES, " \"%.*f\"\t%.3f  %.2f\t %.4f \"%d\" 0 255 \n", digits,
                             v[0], v[1], v[2], v[3], color);
        if (i % 1000 == 0) odd_length += (size_t)snprintf(odd + odd_length, BYTES, "# remark\n\n");
    }
    ewa_cloud *whole = rows_load(plain), *careful = rows_load(odd);
    rows_expect(whole, ROWS, "position,intensity,color");
    const ewa_attribute *a = ewa_cloud_find(whole, EWA_POSITION), *b = ewa_cloud_find(careful, EWA_POSITION);
    assert_memory_equal(a->data, b->data, ROWS * a->stride_bytes);
    for (uint64_t i = 0; i < ROWS; i++)
        for (uint32_t c = 0; c < 3; c++)
            assert_true(rows_number(whole, EWA_COLOR, i, c) == rows_number(careful, EWA_COLOR, i, c));
    ewa_context *first = context;
    for (uint32_t threads = 1; threads <= 5; threads += 2) {
        context = check_context(threads, NULL);
        ewa_cloud *other = rows_load(plain);
        rows_expect_same(whole, other);
        ewa_cloud_destroy(&other);
        ewa_context_destroy(&context);
    }
    context = first;
    ewa_cloud_destroy(&whole);
    ewa_cloud_destroy(&careful);
    char path[512];
    FILE *file = fopen(scratch_path("pieces.xyz", path), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(odd, 1, odd_length, file), odd_length);
    fclose(file);
    careful = rows_load(odd);
    for (uint64_t maximum = 700; maximum < 30000; maximum = 3 * maximum + 1) {
        OWNED(ewa_cloud_reader_close) ewa_cloud_reader *reader = NULL;
        assert_int_equal(ewa_cloud_reader_open(context, path, NULL, &reader), EWA_OK);
        uint64_t count = 0;
        for (;;) {
            OWNED(ewa_cloud_destroy) ewa_cloud *piece = NULL;
            assert_int_equal(ewa_cloud_reader_next(reader, maximum, &piece), EWA_OK);
            if (!piece) break;
            const ewa_attribute *position = ewa_cloud_find(piece, EWA_POSITION);
            assert_memory_equal(position->data,
                                (const uint8_t *)ewa_cloud_find(careful, EWA_POSITION)->data + count * 24,
                                ewa_cloud_point_count(piece) * 24);
            count += ewa_cloud_point_count(piece);
        }
        assert_int_equal(count, ROWS);
    }
    ewa_cloud_destroy(&careful);
}

/// Every allocation that fails ends in an error, and nothing is kept.
TEST_WITHIN(test_memory, set_up, tear_down) {
    const char *text = "x;y;z;name;intensity\n1,5;2,5;3;a b;0,5\n1,5;2,5;4;c;NA\n";
    bool done = false;
    for (long call = 0; !done; call++) {
        check_memory memory = {.calls_left = -1};
        OWNED(ewa_context_destroy) ewa_context *poor = check_context_on(1, &memory);
        const int64_t held_bytes = memory.held_bytes;
        memory.calls_left = call;
        ewa_cloud *cloud = NULL;
        const ewa_status status = ewa_cloud_load_memory(poor, text, strlen(text), "t", &cloud);
        done = status == EWA_OK;
        if (!done) assert_int_equal(status, EWA_ERROR_MEMORY);
        memory.calls_left = -1;
        ewa_cloud_destroy(&cloud);
        assert_int_equal(memory.held_bytes, held_bytes);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
