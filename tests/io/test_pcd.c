// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of PCD: what is read in each encoding, what is refused. The files are made here.
#include "io/cloud_check.h"

#include "io/cloud/pcd.h"
#include "io/scratch.h"

#include <math.h>

#define FIXTURE_THREADS 3
#include "io/fixture.h"

#define HEADER(fields, sizes, types, counts, points)                                                         \
    "# .PCD v0.7\nVERSION 0.7\nFIELDS " fields "\nSIZE " sizes "\nTYPE " types "\nCOUNT " counts             \
    "\nWIDTH " points "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " points "\n"
#define XYZ(points) HEADER("x y z", "4 4 4", "F F F", "1 1 1", points)

/// A file of `header`, a line DATA and `body`.
static cloud_bytes make(const char *header, const char *data, const void *body, size_t body_bytes) {
    cloud_bytes file = {0};
    cloud_put(&file, header, strlen(header));
    cloud_put(&file, "DATA ", 5);
    cloud_put(&file, data, strlen(data));
    cloud_put(&file, "\n", 1);
    cloud_put(&file, body, body_bytes);
    return file;
}

static ewa_cloud *load(const cloud_bytes *file) {
    ewa_cloud *cloud = NULL;
    if (ewa_cloud_load_memory(context, file->bytes, file->size, "sample.pcd", &cloud) != EWA_OK)
        fail_msg("%s", messages.text);
    return cloud;
}

static ewa_cloud *load_text(const char *text) {
    const cloud_bytes file = {(uint8_t *)(uintptr_t)text, strlen(text), 0};
    return load(&file);
}

/// Packs bytes as LZF that repeats nothing.
static void pack_plainly(cloud_bytes *to, const uint8_t *from, size_t size) {
    for (size_t at = 0; at < size; at += 32) {
        const uint8_t count = (uint8_t)(size - at < 32 ? size - at : 32), code = (uint8_t)(count - 1);
        cloud_put(to, &code, 1);
        cloud_put(to, from + at, count);
    }
}

static cloud_bytes compress(const char *header, const void *columns, size_t size) {
    cloud_bytes packed = {0};
    pack_plainly(&packed, columns, size);
    const uint32_t sizes[2] = {(uint32_t)packed.size, (uint32_t)size};
    cloud_bytes file = make(header, "binary_compressed", sizes, sizeof sizes);
    cloud_put(&file, packed.bytes, packed.size);
    free(packed.bytes);
    return file;
}

// ---- every type in every encoding ------------------------------------------------------------------------

#define ALL_TYPES                                                                                            \
    HEADER("curvature x _ i1 u1 i2 y u2 i4 u4 i8 u8 rgb z pair five", "4 4 1 1 1 2 4 2 4 4 8 8 4 4 2 8",     \
           "F F U I U I F U I U I U U F I F", "1 1 3 1 1 1 1 1 1 1 1 1 1 1 2 5", "2")

typedef struct __attribute__((packed)) record {
    float curvature, x;
    uint8_t padding[3];
    int8_t i1;
    uint8_t u1;
    int16_t i2;
    float y;
    uint16_t u2;
    int32_t i4;
    uint32_t u4;
    int64_t i8;
    uint64_t u8;
    uint32_t rgb;
    float z;
    int16_t pair[2];
    double five[5];
} record;

static const record records[2] = {
    {0.5f,
     1,
     {1, 2, 3},
     -128,
     255,
     -32768,
     2,
     65535,
     INT32_MIN,
     UINT32_MAX,
     -(1ll << 53),
     1ull << 53,
     0xff0a141e,
     3,
     {-1, 2},
     {1, 2, 3, 4, 5}},
    {-0.25f,
     -1.5f,
     {9, 9, 9},
     127,
     0,
     32767,
     2.25f,
     0,
     INT32_MAX,
     0,
     5,
     7,
     0x00ffee01,
     1e-30f,
     {300, -300},
     {0.1, 0.2, 0.3, 0.4, 1e300}},
};

static void check_all_types(ewa_cloud *cloud) {
    static const struct {
        const char *name;
        ewa_type type;
        double values[2];
    } scalars[] = {{"curvature", EWA_F32, {0.5, -0.25}},
                   {"i1", EWA_I8, {-128, 127}},
                   {"u1", EWA_U8, {255, 0}},
                   {"i2", EWA_I16, {-32768, 32767}},
                   {"u2", EWA_U16, {65535, 0}},
                   {"i4", EWA_I32, {INT32_MIN, INT32_MAX}},
                   {"u4", EWA_U32, {UINT32_MAX, 0}},
                   {"i8", EWA_F64, {-0x1p53, 5}},
                   {"u8", EWA_F64, {0x1p53, 7}},
                   {"five_0", EWA_F64, {1, 0.1}},
                   {"five_4", EWA_F64, {5, 1e300}}};
    assert_int_equal(ewa_cloud_point_count(cloud), 2);
    for (size_t i = 0; i < sizeof scalars / sizeof scalars[0]; i++)
        for (uint64_t point = 0; point < 2; point++)
            cloud_expect(cloud, scalars[i].name, scalars[i].type, 1, point, &scalars[i].values[point]);
    cloud_expect(cloud, "position", EWA_F32, 3, 0, (const double[]){1, 2, 3});
    cloud_expect(cloud, "position", EWA_F32, 3, 1, (const double[]){-1.5, 2.25, (double)1e-30f});
    cloud_expect(cloud, "color", EWA_U8, 3, 0, (const double[]){10, 20, 30});
    cloud_expect(cloud, "color", EWA_U8, 3, 1, (const double[]){255, 238, 1});
    cloud_expect(cloud, "pair", EWA_I16, 2, 1, (const double[]){300, -300});
    assert_null(ewa_cloud_find(cloud, "_"));
    assert_int_equal(ewa_cloud_attribute_count(cloud), 17);
    assert_string_equal(messages.text, "");
    ewa_cloud_destroy(&cloud);
}

/// The fields one behind the other, of two points; with the padding or without.
static size_t to_columns(bool padding, uint8_t *columns) {
    static const struct {
        size_t offset, size;
    } fields[] = {{0, 4},  {4, 4},  {8, 3},  {11, 1}, {12, 1}, {13, 2}, {15, 4}, {19, 2},
                  {21, 4}, {25, 4}, {29, 8}, {37, 8}, {45, 4}, {49, 4}, {53, 4}, {57, 40}};
    size_t at = 0;
    for (size_t f = 0; f < sizeof fields / sizeof fields[0]; f++)
        for (int point = 0; point < 2 && (padding || fields[f].offset != 8); point++) {
            memcpy(columns + at, (const uint8_t *)&records[point] + fields[f].offset, fields[f].size);
            at += fields[f].size;
        }
    return at;
}

CASE(test_every_type_in_every_encoding) {
    cloud_bytes file = make(ALL_TYPES, "binary", records, sizeof records);
    check_all_types(load(&file));
    free(file.bytes);
    for (int padding = 0; padding < 2; padding++) {
        uint8_t columns[2 * sizeof(record)];
        const size_t size = to_columns(padding, columns);
        file = compress(ALL_TYPES, columns, size);
        check_all_types(load(&file));
        free(file.bytes);
    }
    check_all_types(load_text(
        ALL_TYPES "DATA ascii\n"
                  "0.5 1 1 2 3 -128 255 -32768 2 65535 -2147483648 4294967295 -9007199254740992 "
                  "9007199254740992 4278850590 3 -1 2 1 2 3 4 5\n"
                  "-0.25 -1.5 9 x nan 127 0 32767 2.25 0 2147483647 0 5 7 16772609 1e-30 300 -300 .1 .2 .3 "
                  ".4 1e300\n"));
}

CASE(test_colors) {
    // The bits of a float.
    ewa_cloud *cloud =
        load_text(HEADER("x y z rgb", "4 4 4 4", "F F F F", "1 1 1 1", "1") "DATA ascii\n0 0 0 4.2108e+06\n");
    cloud_expect(cloud, "color", EWA_U8, 3, 0, (const double[]){128, 128, 224});
    ewa_cloud_destroy(&cloud);
    // Alpha that nobody set; that of one point counts for all.
    for (int set = 0; set < 2; set++) {
        float body[2][4] = {{0, 0, 0, 0}, {1, 1, 1, 0}};
        const uint32_t colors[2] = {0x00010203, set ? 0x7f040506 : 0x00040506};
        for (int i = 0; i < 2; i++) memcpy(&body[i][3], &colors[i], 4);
        cloud_bytes file =
            make(HEADER("x y z rgba", "4 4 4 4", "F F F U", "1 1 1 1", "2"), "binary", body, sizeof body);
        cloud = load(&file);
        cloud_expect(cloud, "color", EWA_U8, set ? 4 : 3, 1, (const double[]){4, 5, 6, 127});
        ewa_cloud_destroy(&cloud);
        free(file.bytes);
    }
    // 16 bits, and 8 bits in 16.
    static const char header[] =
        HEADER("X Y Z Red Green Blue", "8 8 8 2 2 2", "F F F U U U", "1 1 1 1 1 1", "2");
    char text[1024];
    for (int wide = 0; wide < 2; wide++) {
        snprintf(text, sizeof text, "%sDATA ascii\n0 0 0 1 2 3\n1 1 1 255 %s 0\n", header,
                 wide ? "256" : "7");
        cloud = load_text(text);
        cloud_expect(cloud, "position", EWA_F64, 3, 1, (const double[]){1, 1, 1});
        cloud_expect(cloud, "color", wide ? EWA_U16 : EWA_U8, 3, 0, (const double[]){1, 2, 3});
        ewa_cloud_destroy(&cloud);
    }
    assert_string_equal(messages.text, "");
}

CASE(test_names_of_scans) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = load_text(HEADER(
        "x y z nx ny nz Intensity ReturnNumber ScanAngleRank GpsTime other", "4 4 4 4 4 4 2 1 1 4 4",
        "F F F F F F U U I F I", "1 1 1 1 1 1 1 1 1 1 1", "1") "DATA ascii\n1 2 3 0 0 1 500 2 -9 0.5 7\n");
    cloud_expect(cloud, "normal", EWA_F32, 3, 0, (const double[]){0, 0, 1});
    cloud_expect(cloud, "intensity", EWA_U16, 1, 0, (const double[]){500});
    cloud_expect(cloud, "return_number", EWA_U8, 1, 0, (const double[]){2});
    cloud_expect(cloud, "scan_angle", EWA_F32, 1, 0, (const double[]){-9});
    cloud_expect(cloud, "gps_time", EWA_F64, 1, 0, (const double[]){0.5});
    cloud_expect(cloud, "other", EWA_I32, 1, 0, (const double[]){7});
}

CASE(test_histograms_are_split) {
    float body[3 + 33];
    for (int i = 0; i < 36; i++) body[i] = (float)i;
    cloud_bytes file =
        make(HEADER("x y z fpfh", "4 4 4 4", "F F F F", "1 1 1 33", "1"), "binary", body, sizeof body);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = load(&file);
    assert_int_equal(ewa_cloud_attribute_count(cloud), 34);
    cloud_expect(cloud, "fpfh_0", EWA_F32, 1, 0, (const double[]){3});
    cloud_expect(cloud, "fpfh_32", EWA_F32, 1, 0, (const double[]){35});
    free(file.bytes);
}

CASE(test_names_that_clash_are_left_out) {
    OWNED(ewa_cloud_destroy)
    ewa_cloud *cloud = load_text(HEADER("x y z a a normal", "4 4 4 4 4 4", "F F F F F F", "1 1 1 1 1 1",
                                        "1") "DATA ascii\n1 2 3 4 5 6\n");
    assert_int_equal(messages.count, 2);
    assert_int_equal(ewa_cloud_attribute_count(cloud), 2);
    cloud_expect(cloud, "a", EWA_F32, 1, 0, (const double[]){4});
}

// ---- text ------------------------------------------------------------------------------------------------

CASE(test_text_keeps_digits) {
    OWNED(ewa_cloud_destroy)
    ewa_cloud *cloud = load_text(XYZ("2") "DATA ascii\n289814.15,4320978.61,170.76\r\n\r\n# no point\r\n"
                                          "\t289814.64 ,\t4320978.84 170.76");
    cloud_expect_world(cloud, 0, (const double[]){289814.15, 4320978.61, 170.76});
    cloud_expect_world(cloud, 1, (const double[]){289814.64, 4320978.84, 170.76});
    ewa_cloud_destroy(&cloud);
    cloud = load_text("\xef\xbb\xbf" XYZ("1") "DATA ascii\n1 2 3\n"); // a byte order mark
    cloud_expect(cloud, "position", EWA_F32, 3, 0, (const double[]){1, 2, 3});
    ewa_cloud_destroy(&cloud);
    cloud = load_text(XYZ("1") "DATA ascii\n0.0054215998 -1.5e-7 1e3\n"); // floats with all their digits
    cloud_expect(cloud, "position", EWA_F32, 3, 0,
                 (const double[]){(double)0.0054215998f, (double)-1.5e-7f, 1000});
}

/// Text of many pieces, with blank lines, comments and points without a place in between.
static cloud_bytes make_text(uint32_t point_count, uint32_t *finite_count) {
    cloud_bytes file = {0};
    char line[512];
    snprintf(line, sizeof line,
             "VERSION .5\nCOLUMNS x y z i\nSIZE 4 4 4 4\nTYPE F F F U\nWIDTH %u\nHEIGHT 1\nDATA ascii\n",
             point_count);
    cloud_put(&file, line, strlen(line));
    check_random random = {5};
    *finite_count = 0;
    for (uint32_t i = 0; i < point_count; i++) {
        const uint64_t draw = check_random_u64(&random) % 50;
        if (draw == 0) cloud_put(&file, "\n# x\n", 5);
        const bool invalid = draw < 5;
        if (invalid)
            snprintf(line, sizeof line, "nan %s 0 %u\n", draw == 1 ? "1" : "nan", i);
        else
            snprintf(line, sizeof line, "%u.5 -%u%*s 0.25 %u%s\n", i, i, (int)draw, "", i,
                     draw == 7 ? "\r" : "");
        *finite_count += !invalid;
        cloud_put(&file, line, strlen(line));
    }
    return file;
}

CASE(test_text_of_many_pieces) {
    uint32_t finite_count;
    cloud_bytes file = make_text(60000, &finite_count);
    assert_true(file.size > 1 << 20);
    ewa_cloud *cloud = load(&file);
    assert_int_equal(ewa_cloud_point_count(cloud), finite_count);
    const ewa_attribute *index = ewa_cloud_find(cloud, "i");
    uint32_t before = UINT32_MAX;
    for (uint32_t k = 0; k < finite_count; k++) {
        double i, place[3];
        ewa_attribute_read_f64(index, k, 1, &i);
        ewa_attribute_read_f64(ewa_cloud_find(cloud, "position"), k, 1, place);
        assert_true(before == UINT32_MAX || (uint32_t)i > before);
        before = (uint32_t)i;
        assert_true(place[0] == i + 0.5 && place[1] == -i && place[2] == 0.25);
    }
    char expected[64];
    snprintf(expected, sizeof expected, "%u of 60000 points have no place and are left out",
             60000 - finite_count);
    assert_string_equal(ewa_cloud_note(cloud, "file.invalid", NULL), expected);
    cloud_check_pieces(&file, "pieces.pcd", cloud);
    ewa_cloud_destroy(&cloud);
    free(file.bytes);
    assert_string_equal(messages.text, "");
}

CASE(test_more_lines_than_points) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = load_text(XYZ("1") "DATA ascii\n1 2 3\n4 5 6\nrubbish\n");
    assert_int_equal(ewa_cloud_point_count(cloud), 1);
}

// ---- points without a place ------------------------------------------------------------------------------

CASE(test_organised_clouds) {
    enum { WIDTH = 100, HEIGHT = 70, COUNT = WIDTH * HEIGHT };
    static float body[COUNT][4];
    check_random random = {9};
    uint32_t finite_count = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        const uint64_t draw = check_random_u64(&random) % 4;
        for (int c = 0; c < 3; c++) body[i][c] = draw == 0 ? NAN : draw == 1 && c == 2 ? INFINITY : (float)i;
        body[i][3] = (float)i;
        finite_count += draw > 1;
    }
    static const char header[] =
        "VERSION 0.7\nFIELDS x y z i\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 100\n"
        "HEIGHT 70\nVIEWPOINT 1 2.5 -3 1 0 0 0\nPOINTS 7000\n";
    cloud_bytes file = make(header, "binary", body, sizeof body);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = load(&file);
    assert_int_equal(ewa_cloud_point_count(cloud), finite_count);
    double before = -1;
    for (uint32_t k = 0; k < finite_count; k++) {
        double i, place[3];
        ewa_attribute_read_f64(ewa_cloud_find(cloud, "i"), k, 1, &i);
        ewa_attribute_read_f64(ewa_cloud_find(cloud, "position"), k, 1, place);
        assert_true(i > before && place[0] == i && place[1] == i && place[2] == i);
        before = i;
    }
    char expected[64];
    snprintf(expected, sizeof expected, "%u of 7000 points have no place and are left out",
             COUNT - finite_count);
    assert_string_equal(ewa_cloud_note(cloud, "file.invalid", NULL), expected);
    assert_string_equal(ewa_cloud_note(cloud, "file.organised", NULL), "100 x 70");
    assert_string_equal(ewa_cloud_note(cloud, "file.format", NULL), "PCD 0.7 binary");
    assert_string_equal(ewa_cloud_note(cloud, "scanners", NULL), "1 2.5 -3");
    cloud_check_pieces(&file, "organised.pcd", cloud);
    free(file.bytes);
}

// ---- what is wrong ---------------------------------------------------------------------------------------

CASE(test_headers_and_their_messages) {
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"1 2 3\n", "line 1: '1' is no word of a PCD header"},
        {"VERSION 0.7\n", "has no line DATA"},
        {"VERSION 0.7\nPOINTS 1\nDATA ascii\n", "has no line FIELDS"},
        {"VERSION 0.7\nFIELDS\n", "line 2: names no field"},
        {"FIELDS x\nFIELDS y\n", "line 2: names fields for the second time"},
        {"FIELDS x y z\nDATA ascii\n1 2 3\n", "neither POINTS nor WIDTH"},
        {"FIELDS x y z\nSIZE 4 4\n", "line 2: '' is no size of a number"},
        {"FIELDS x y z\nSIZE 4 4 0\n", "line 2: '0' is no size"},
        {"FIELDS x y z\nSIZE 4 4 4 4\n", "line 2: '4' is one word more than there are fields"},
        {"FIELDS x y z\nTYPE F F G\n", "line 2: 'G' is no type"},
        {"FIELDS x y z\nCOUNT 1 1 -1\n", "line 2: '-1' is no count"},
        {"FIELDS x y z\nCOUNT 1 1 99999999\n", "line 2: '99999999' is no count"},
        {"FIELDS x y z\nPOINTS -5\n", "line 2: '-5' is no number of points"},
        {"FIELDS x y z\nPOINTS 99999999999999999999\n", "is no number of points"},
        {"FIELDS x y z\nVIEWPOINT 1 2 3\n", "line 2: '' is no number of a VIEWPOINT"},
        {"FIELDS x y z\nPOINTS 1\nDATA zip\n", "line 3: 'zip' is no kind of DATA"},
        {"FIELDS x y z\nTYPE F F F\nSIZE 4 4 2\nPOINTS 1\nDATA ascii\n",
         "field 'z' is of type F with 2 bytes"},
        {"FIELDS x y z\nWIDTH 3\nHEIGHT 2\nPOINTS 5\nDATA ascii\n",
         "WIDTH 3 and HEIGHT 2 do not make 5 POINTS"},
        {"FIELDS x y z\nWIDTH 4294967296\nHEIGHT 4294967296\nDATA ascii\n", "do not make 0 POINTS"},
        {"FIELDS x y\nPOINTS 1\nDATA ascii\n1 2\n", "no fields x, y, z"},
        {"FIELDS x y z\nCOUNT 1 1 2\nPOINTS 1\nDATA ascii\n1 2 3 4\n", "no fields x, y, z"},
        {"FIELDS x y z _\nSIZE 4 4 4 1000\nTYPE F F F U\nCOUNT 1 1 1 10000\nPOINTS 1\nDATA binary\n",
         "points of 10000012 bytes"},
        {"FIELDS x y z h\nSIZE 4 4 4 1\nTYPE F F F U\nCOUNT 1 1 1 5000\nPOINTS 1\nDATA binary\n",
         "more than 1024 numbers"},
        {"FIELDS x y z\nPOINTS 3\nDATA ascii\n1 2 3\n4 5 6\n", "the text ends after 2 of 3 points"},
        {"FIELDS x y z\nPOINTS 2\nDATA ascii\n1 2 3\n4 5\n", "line 5 ends before field 'z'"},
        {"FIELDS x y z\nPOINTS 2\nDATA ascii\n1 2 3\n4 5 6 7\n", "line 5: '7' follows the last of 3 numbers"},
        {"FIELDS x y z\nPOINTS 2\nDATA ascii\n1 2 3\n\n4 5x 6\n", "line 6: '5x' is no number of field 'y'"},
        {"FIELDS x y z\nSIZE 4 4 1\nTYPE F F U\nPOINTS 1\nDATA ascii\n1 2 256\n",
         "line 6: '256' is beyond the type of field 'z'"},
        {"FIELDS x y z\nSIZE 4 4 2\nTYPE F F I\nPOINTS 1\nDATA ascii\n1 2 1.5\n",
         "line 6: '1.5' is beyond the type of field 'z'"},
        {"FIELDS x y z\nPOINTS 1000000000000\nDATA binary\n123456789012",
         "the file ends after 1 of 1000000000000 points of 12 bytes"},
        {"FIELDS x y z\nPOINTS 1\nDATA binary_compressed\n1234567", "ends before the packed points"},
        {"FIELDS x y z\nPOINTS 1\nDATA binary_compressed\n\377\0\0\0\f\0\0\0",
         "255 bytes of packed points, of which"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        ewa_cloud *cloud = NULL;
        const size_t size = strlen(cases[i].text) + (strstr(cases[i].text, "compressed\n\377") ? 7 : 0);
        messages = (check_log){0};
        assert_true(ewa_cloud_load_memory(context, cases[i].text, size, "sample.pcd", &cloud) < 0);
        assert_null(cloud);
        if (!strstr(messages.text, cases[i].message) || strncmp(messages.text, "sample.pcd: ", 12) != 0)
            fail_msg("case %zu: '%s' instead of '%s'", i, messages.text, cases[i].message);
    }
}

CASE(test_what_lzf_packs) {
    static const struct {
        const char *packed;
        size_t packed_bytes;
        const char *text; ///< NULL: damaged
        size_t text_bytes;
    } cases[] = {
        {"\x02"
         "abc",
         4, "abc", 3},
        {"\x00"
         "a\x20\x00",
         4, "aaaa", 4}, // overlaps what it makes
        {"\x01"
         "ab\x40\x01",
         5, "ababab", 6},
        {"\x00"
         "x\xe0\x05\x00",
         5, "xxxxxxxxxxxxxxx", 15}, // 7 + 5 + 2 more
        {"\x02"
         "abc",
         4, NULL, 4}, // too little
        {"\x02"
         "abc",
         4, NULL, 2}, // too much
        {"\x02"
         "ab",
         3, NULL, 3}, // ends
        {"\x00"
         "a\x20",
         3, NULL, 4},
        {"\x00"
         "x\xe0",
         3, NULL, 15},
        {"\x00"
         "x\xe0\x05",
         4, NULL, 15},
        {"\x00"
         "a\x20\x01",
         4, NULL, 4}, // before the begin
        {"\x20\x00", 2, NULL, 3},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        OWNED(check_free) uint8_t *from = malloc(cases[i].packed_bytes), *to = malloc(cases[i].text_bytes);
        memcpy(from, cases[i].packed, cases[i].packed_bytes);
        if (ewa_lzf_unpack(from, cases[i].packed_bytes, to, cases[i].text_bytes) != (cases[i].text != NULL))
            fail_msg("case %zu", i);
        if (cases[i].text) assert_memory_equal(to, cases[i].text, cases[i].text_bytes);
    }
    // Long pieces from far away, as wide copies see them.
    uint8_t packed[4096], text[8192], expected[8192];
    size_t in = 0, out = 0;
    check_random random = {3};
    while (in + 64 < sizeof packed && out + 300 < sizeof text) {
        if (out < 40 || check_random_u64(&random) % 2) {
            const size_t count = 1 + check_random_u64(&random) % 32;
            packed[in++] = (uint8_t)(count - 1);
            for (size_t k = 0; k < count; k++)
                packed[in++] = expected[out++] = (uint8_t)check_random_u64(&random);
        } else {
            const size_t length = 9 + check_random_u64(&random) % 256;
            const size_t distance = 1 + check_random_u64(&random) % out;
            packed[in++] = (uint8_t)(7 << 5 | (distance - 1) >> 8);
            packed[in++] = (uint8_t)(length - 9);
            packed[in++] = (uint8_t)(distance - 1);
            for (size_t k = 0; k < length; k++, out++) expected[out] = expected[out - distance];
        }
    }
    assert_true(ewa_lzf_unpack(packed, in, text, out));
    assert_memory_equal(text, expected, out);
}

/// Every beginning of a file is refused, or stepped over with all its points counted.
CASE(test_truncated) {
    uint8_t columns[2 * sizeof(record)];
    const size_t size = to_columns(false, columns);
    cloud_bytes files[3] = {make(ALL_TYPES, "binary", records, sizeof records),
                            compress(ALL_TYPES, columns, size),
                            make(XYZ("3"), "ascii", "1 2 3\n4 5 6\n7 8 9.5\n", 20)};
    for (int i = 0; i < 3; i++) {
        cloud_check_truncations(&files[i], "cut.pcd", i == 2 ? 5 : 0);
        free(files[i].bytes);
    }
}

CASE(test_keeps_going) {
    cloud_bytes file = make(XYZ("5"), "ascii", "1 2 3\n4 5\nx\n7 8 9\n", 18);
    uint64_t lost_count;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = cloud_keep_going(context, &file, "keep.pcd", &lost_count);
    assert_int_equal(ewa_cloud_point_count(cloud), 2);
    assert_int_equal(lost_count, 3);
    cloud_expect(cloud, "position", EWA_F32, 3, 1, (const double[]){7, 8, 9});
    ewa_cloud_destroy(&cloud);
    free(file.bytes);
    const float body[7] = {1, 2, 3, 4, 5, 6, 7};
    file = make(XYZ("9"), "binary", body, sizeof body);
    cloud = cloud_keep_going(context, &file, "keep.pcd", &lost_count);
    assert_int_equal(ewa_cloud_point_count(cloud), 2);
    assert_int_equal(lost_count, 7);
    free(file.bytes);
}

CASE(test_damaged_bytes_are_survived) {
    uint8_t columns[2 * sizeof(record)];
    const size_t size = to_columns(true, columns);
    cloud_bytes files[2] = {compress(ALL_TYPES, columns, size),
                            make(ALL_TYPES, "binary", records, sizeof records)};
    for (int i = 0; i < 2; i++) {
        cloud_check_changes(&files[i], "changed.pcd", 3000);
        free(files[i].bytes);
    }
}

static ewa_status load_each(ewa_context *failing, void *user) {
    const cloud_bytes *file = user;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    const ewa_status status = ewa_cloud_load_memory(failing, file->bytes, file->size, "sample.pcd", &cloud);
    return status;
}

CASE(test_memory_that_fails) {
    uint8_t columns[2 * sizeof(record)];
    const size_t size = to_columns(true, columns);
    cloud_bytes files[2] = {compress(ALL_TYPES, columns, size), make(XYZ("1"), "ascii", "1 2 3\n", 6)};
    for (int i = 0; i < 2; i++) {
        scratch_fail_each(load_each, &files[i]);
        free(files[i].bytes);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
