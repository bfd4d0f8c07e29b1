// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clouds written as text: the decimals of the file they came from, heads of every suffix, colours, pieces.
#include "io/rows_check.h"

/// Saves a cloud, compares the bytes of the file.
static void expect_file(const ewa_cloud *cloud, const char *name, const char *expected) {
    char path[512];
    assert_int_equal(ewa_cloud_save(cloud, scratch_path(name, path), NULL), EWA_OK);
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = scratch_read(path, &size_bytes);
    bytes[size_bytes] = 0;
    assert_string_equal((char *)bytes, expected);
}

/// Text that is read and written is the same text.
TEST_WITHIN(test_same, set_up, tear_down) {
    static const struct {
        const char *name, *text;
    } files[] = {
        {"a.xyz", "1.50 -2.250 3\n-0.05 7.125 -100\n"},
        {"a.xyz", "4200000.125 -5200017.30 99.070\n4200001.100 5199999.99 -3.000\n"},
        {"a.txt", "//X Y Z R G B\n1.5 2 3 255 0 7\n4.5 5 6 1 2 3\n"},
        {"a.asc", "//X Y Z Nx Ny Nz R G B intensity label\n1.5 2 3 0 0.6 -0.8 255 0 7 300 1\n"},
        {"a.csv", "x,y,z,red,green,blue,intensity,gps_time\n1.5,2,3,255,0,7,0.25,123456.789\n"},
        {"a.csv", "x,y,z\n4200000.123456789,-5000000.500000001,100\n4200000.000000001,0.000000000,-7\n"},
        {"a.pts", "2\n1.5 2 3 300 255 0 7\n4.5 5 6 -7 1 2 3\n"},
        {"a.pts", "1\n1.5 2 3 300\n"},
        {"a.txt", "//X Y Z Rf Gf Bf\n1.5 2 3 1.000000 0.500008 0.000015\n"},
        {"a.csv", "x,y,z,r,g,b\n0.1,2,3,1.000000,0.500008,0.003922\n"},
    };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = rows_load(files[i].text);
        char text[512];
        snprintf(text, sizeof text, "%s", files[i].text);
        char *short_names = strstr(text, ",r,g,b");
        if (short_names)
            snprintf(text, sizeof text, "x,y,z,red,green,blue%s", strstr(files[i].text, ",r,g,b") + 6);
        if (ewa_cloud_point_count(cloud) > 0) expect_file(cloud, files[i].name, text);
    }
}

/// Any decimals and any whole number of steps, also where origin and offset differ.
TEST_WITHIN(test_every_digit, set_up, tear_down) {
    enum { POINTS = 500 };
    check_random random = {11};
    for (int decimals = 0; decimals <= 9; decimals++) {
        char text[POINTS * 64];
        size_t length = 0;
        const int64_t unit = (int64_t)pow(10, decimals);
        for (int i = 0; i < POINTS; i++) {
            for (int c = 0; c < 3; c++) {
                const int64_t whole = c == 0 ? 4200000 : c == 1 ? -517 : 0;
                const int64_t parts =
                    whole * unit + (int64_t)(check_random_u64(&random) % (uint64_t)(2 * unit));
                const unsigned long long size = (unsigned long long)(parts < 0 ? -parts : parts);
                length += (size_t)snprintf(text + length, 32, "%s%llu", parts < 0 ? "-" : "",
                                           size / (unsigned long long)unit);
                if (decimals)
                    length += (size_t)snprintf(text + length, 32, ".%0*llu", decimals,
                                               size % (unsigned long long)unit);
                text[length++] = c < 2 ? ' ' : '\n';
            }
        }
        text[length] = 0;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = rows_load(text);
        expect_file(cloud, "digits.xyz", text);
    }
}

/// Coordinates of no grid and floats read back as they were.
TEST_WITHIN(test_shortest, set_up, tear_down) {
    enum { POINTS = 1000 };
    check_random random = {5};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL, *back = NULL;
    void *position, *value, *color;
    assert_int_equal(ewa_cloud_create(context, POINTS, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, &position), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, "value", EWA_F64, 1, &value), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_COLOR, EWA_U16, 3, &color), EWA_OK);
    for (uint64_t i = 0; i < POINTS; i++) {
        for (uint64_t c = 0; c < 3; c++) {
            ((double *)position)[3 * i + c] = check_uniform(&random, -1, 1);
            ((uint16_t *)color)[3 * i + c] = (uint16_t)check_random_u64(&random);
        }
        ((double *)value)[i] = i == 3 ? NAN : check_uniform(&random, -1e9, 1e9);
    }
    char path[512];
    assert_int_equal(ewa_cloud_save(cloud, scratch_path("short.csv", path), NULL), EWA_OK);
    assert_int_equal(ewa_cloud_load(context, path, &back), EWA_OK);
    rows_expect(back, POINTS, "position,color,value");
    for (uint64_t i = 0; i < POINTS; i++) {
        const double expected = rows_number(cloud, "value", i, 0), got = rows_number(back, "value", i, 0);
        assert_true(expected == got || (isnan(expected) && isnan(got)));
        for (uint32_t c = 0; c < 3; c++) {
            assert_true(rows_number(cloud, EWA_POSITION, i, c) == rows_number(back, EWA_POSITION, i, c));
            assert_true(rows_number(cloud, EWA_COLOR, i, c) == rows_number(back, EWA_COLOR, i, c));
        }
    }
}

TEST_WITHIN(test_linear_colors, set_up, tear_down) {
    const float position[3] = {0.1f, 2, 3}, color[3] = {1, 0, 0.21404114f};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, 1);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F32, 3, position, 0), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_COLOR, EWA_F32, 3, color, 0), EWA_OK);
    expect_file(cloud, "linear.txt", "//X Y Z Rf Gf Bf\n0.1 2 3 1.000000 0.000000 0.500000\n");
    expect_file(cloud, "linear.pts", "1\n0.1 2 3 255 0 128\n");
}

/// The file does not depend on pieces and threads; a count that comes late is put in front.
TEST_WITHIN(test_pieces, set_up, tear_down) {
    enum { POINTS = 20000, BYTES = 48 };
    OWNED(check_free) char *text = malloc(POINTS * BYTES);
    assert_non_null(text);
    size_t length = 0;
    for (int i = 0; i < POINTS; i++)
        length += (size_t)snprintf(text + length, BYTES, "%d.25 %d 3.5 %d %d 2 3\n", i, -i, i % 999, i % 256);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = rows_load(text);
    char path[512];
    ewa_cloud_writer *writer = NULL;
    scratch_path("pieces.pts", path);
    assert_int_equal(ewa_cloud_writer_open(context, path, NULL, cloud, EWA_POINTS_UNKNOWN, NULL, &writer),
                     EWA_OK);
    for (uint64_t first = 0; first < POINTS; first += 7000) {
        uint64_t indices[7000];
        const uint64_t count = POINTS - first < 7000 ? POINTS - first : 7000;
        for (uint64_t i = 0; i < count; i++) indices[i] = first + i;
        OWNED(ewa_cloud_destroy) ewa_cloud *piece = NULL;
        assert_int_equal(ewa_cloud_select(cloud, indices, count, &piece), EWA_OK);
        assert_int_equal(ewa_cloud_writer_put(writer, piece), EWA_OK);
    }
    assert_int_equal(ewa_cloud_writer_commit(&writer), EWA_OK);
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = scratch_read(path, &size_bytes);
    const char *line = memchr(bytes, '\n', size_bytes);
    assert_int_equal(strtoul((char *)bytes, NULL, 10), POINTS);
    assert_int_equal(size_bytes - (size_t)(line + 1 - (char *)bytes), length);
    assert_memory_equal(line + 1, text, length);
}

TEST_WITHIN(test_refused, set_up, tear_down) {
    char path[512];
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = rows_load("1 2 3\n");
    void *value;
    assert_int_equal(ewa_cloud_add(cloud, "x", EWA_U8, 1, &value), EWA_OK);
    assert_int_equal(ewa_cloud_save(cloud, scratch_path("twice.csv", path), NULL), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(messages.text, "two attributes would become column 'x'"));
    ewa_cloud_destroy(&cloud);
    cloud = rows_load("x,y,z,nx,ny,nz,gps_time\n1,2,3,0,0,1,7\n");
    messages.count = 0;
    assert_int_equal(ewa_cloud_save(cloud, scratch_path("less.pts", path), NULL), EWA_OK);
    assert_int_equal(messages.count, 1);
    assert_non_null(strstr(messages.text, "2 other attributes are left out"));
}

int main(void) { return RUN_TESTS(NULL, NULL); }
