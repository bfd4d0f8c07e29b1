// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of the PLY reader on files that are right: types, orders, names, elements, layouts, real models.
#include "io/ply_sample.h"
#include "tests/data/facts.h"

#include <math.h>

#include "io/fixture.h"

static const char *const type_names[][3] = {{"float", "float32"},       {"double", "float64"}, {"char", "int8"},
                                            {"uchar", "uint8", "bool"}, {"short", "int16"},    {"ushort", "uint16"},
                                            {"int", "int32"},           {"uint", "uint32"}};
enum { TYPES = 8, ENCODINGS = 3 };

/// Extremes and odd values of each type.
static const double type_values[TYPES][4] = {
    {3.4028234663852886e38, -1.1754943508222875e-38, 1.401298464324817e-45, -0.0},
    {1.7976931348623157e308, -2.2250738585072014e-308, 4.9406564584124654e-324, 431234.123456789},
    {-128, 127, 0, -1},
    {0, 255, 128, 7},
    {-32768, 32767, 0, 258},
    {0, 65535, 32768, 258},
    {-2147483648.0, 2147483647, 16777217, -1},
    {0, 4294967295, 2147483648, 16909060}};

CASE(test_every_type_in_every_encoding) {
    for (int encoding = 0; encoding < ENCODINGS; encoding++)
        for (int type = 0; type < TYPES; type++)
            for (int spelling = 0; spelling < 3 && type_names[type][spelling]; spelling++) {
                sample s = sample_start((ewa_ply_encoding)encoding, "\n");
                char line[64];
                snprintf(line, sizeof line, "property %s value", type_names[type][spelling]);
                sample_line(&s, "element vertex 4");
                sample_line(&s, "property float x");
                sample_line(&s, line);
                sample_line(&s, "property float y");
                sample_line(&s, "property float z");
                sample_line(&s, "end_header");
                for (int i = 0; i < 4; i++) {
                    sample_number(&s, EWA_F32, i);
                    sample_number(&s, (ewa_type)type, type_values[type][i]);
                    sample_number(&s, EWA_F32, 10 + i);
                    sample_number(&s, EWA_F32, -i);
                    sample_record_end(&s);
                }
                OWNED(ewa_cloud_destroy) ewa_cloud *cloud;
                assert_int_equal(sample_load(context, &s, &cloud), EWA_OK);
                assert_int_equal(ewa_cloud_point_count(cloud), 4);
                assert_int_equal(ewa_cloud_attribute_count(cloud), 2);
                for (int i = 0; i < 4; i++) {
                    const double expected[3] = {i, 10 + i, -i};
                    for (uint32_t c = 0; c < 3; c++)
                        assert_true(sample_value(cloud, "position", EWA_F32, 3, i, c) == expected[c]);
                    assert_same_bits(sample_value(cloud, "value", (ewa_type)type, 1, i, 0),
                                     type_values[type][i]);
                }
            }
    assert_int_equal(messages.count, 0);
}

CASE(test_positions_are_exact) {
    static const ewa_type expected[TYPES] = {EWA_F32, EWA_F64, EWA_F32, EWA_F32,
                                             EWA_F32, EWA_F32, EWA_F64, EWA_F64};
    for (int encoding = 0; encoding < ENCODINGS; encoding++)
        for (int type = 0; type < TYPES; type++)
            for (int mixed = 0; mixed < 2; mixed++) {
                // Either all of one type, or x and z of it around a float.
                sample s = sample_start((ewa_ply_encoding)encoding, "\n");
                const ewa_type middle = mixed ? EWA_F32 : (ewa_type)type;
                char line[128];
                snprintf(line, sizeof line,
                         "element vertex 4\nproperty %s x\nproperty %s y\nproperty %s z\nend_header",
                         type_names[type][0], type_names[middle][0], type_names[type][0]);
                sample_line(&s, line);
                for (int i = 0; i < 4; i++) {
                    sample_number(&s, (ewa_type)type, type_values[type][i]);
                    sample_number(&s, middle, i);
                    sample_number(&s, (ewa_type)type, type_values[type][3 - i]);
                    sample_record_end(&s);
                }
                OWNED(ewa_cloud_destroy) ewa_cloud *cloud;
                assert_int_equal(sample_load(context, &s, &cloud), EWA_OK);
                for (int i = 0; i < 4; i++) {
                    assert_same_bits(sample_value(cloud, "position", expected[type], 3, i, 0),
                                     type_values[type][i]);
                    assert_same_bits(sample_value(cloud, "position", expected[type], 3, i, 1), i);
                    assert_same_bits(sample_value(cloud, "position", expected[type], 3, i, 2),
                                     type_values[type][3 - i]);
                }
            }
}

CASE(test_any_order_of_properties) {
    static const struct {
        const char *name, *attribute;
        ewa_type type;
        uint32_t components, component;
    } parts[] = {
        {"x", "position", EWA_F32, 3, 0},         {"y", "position", EWA_F32, 3, 1},
        {"z", "position", EWA_F32, 3, 2},         {"nx", "normal", EWA_F32, 3, 0},
        {"ny", "normal", EWA_F32, 3, 1},          {"nz", "normal", EWA_F32, 3, 2},
        {"red", "color", EWA_U8, 4, 0},           {"green", "color", EWA_U8, 4, 1},
        {"blue", "color", EWA_U8, 4, 2},          {"alpha", "color", EWA_U8, 4, 3},
        {"radius", "radius", EWA_F32, 1, 0},      {"tu_x", "tangent_u", EWA_F32, 3, 0},
        {"tu_y", "tangent_u", EWA_F32, 3, 1},     {"tu_z", "tangent_u", EWA_F32, 3, 2},
        {"tv_x", "tangent_v", EWA_F32, 3, 0},     {"tv_y", "tangent_v", EWA_F32, 3, 1},
        {"tv_z", "tangent_v", EWA_F32, 3, 2},     {"material", "material", EWA_U16, 1, 0},
        {"clip0_a", "clip0", EWA_F32, 3, 0},      {"clip0_b", "clip0", EWA_F32, 3, 1},
        {"clip0_c", "clip0", EWA_F32, 3, 2},      {"clip1_a", "clip1", EWA_F32, 3, 0},
        {"clip1_b", "clip1", EWA_F32, 3, 1},      {"clip1_c", "clip1", EWA_F32, 3, 2},
        {"border_x", "border", EWA_F32, 3, 0},     {"border_y", "border", EWA_F32, 3, 1},
        {"border_z", "border", EWA_F32, 3, 2},     {"clip_mode", "clip_mode", EWA_U8, 1, 0},
        {"scalar_gps", "scalar_gps", EWA_F64, 1, 0},
    };
    enum { PARTS = sizeof parts / sizeof parts[0], POINTS = 37 };
    check_random random = {11};
    for (int round = 0; round < 60; round++) {
        int order[PARTS];
        for (int i = 0; i < PARTS; i++) order[i] = i;
        for (int i = PARTS - 1; i > 0; i--) {
            const int k = (int)(check_random_u64(&random) % (uint64_t)(i + 1)), kept = order[i];
            order[i] = order[k];
            order[k] = kept;
        }
        sample s = sample_start((ewa_ply_encoding)(round % ENCODINGS), "\n");
        sample_line(&s, "element vertex 37");
        for (int i = 0; i < PARTS; i++) {
            char line[64];
            snprintf(line, sizeof line, "property %s %s", ewa_type_name(parts[order[i]].type),
                     parts[order[i]].name);
            sample_line(&s, line);
        }
        sample_line(&s, "end_header");
        for (int point = 0; point < POINTS; point++) {
            for (int i = 0; i < PARTS; i++)
                sample_number(&s, parts[order[i]].type, (order[i] * 7 + point) % 256);
            sample_record_end(&s);
        }
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud;
        assert_int_equal(sample_load(context, &s, &cloud), EWA_OK);
        for (int point = 0; point < POINTS; point++)
            for (int i = 0; i < PARTS; i++)
                assert_true(sample_value(cloud, parts[i].attribute, parts[i].type, parts[i].components, point,
                                         parts[i].component) == (i * 7 + point) % 256);
    }
}

/// Loads one vertex whose numbers are 1, 2, 3, ... in the order of `properties`, in ascii.
static ewa_cloud *load_counting(const char *properties) {
    char text[2048];
    snprintf(text, sizeof text, "ply\nformat ascii 1.0\nelement vertex 1\n%send_header\n", properties);
    int value = 1;
    for (const char *c = properties; (c = strchr(c, '\n')); c++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%d ", value++);
    ewa_cloud *cloud;
    assert_int_equal(sample_load_text(context, text, &cloud), EWA_OK);
    return cloud;
}

#define XYZ "property float x\nproperty float y\nproperty float z\n"

CASE(test_other_names_of_attributes) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud =
        load_counting(XYZ "property float normal_x\nproperty float normal_y\nproperty float normal_z\n"
                          "property uchar diffuse_red\nproperty uchar diffuse_green\n"
                          "property uchar diffuse_blue\nproperty float psz\n");
    assert_int_equal(ewa_cloud_attribute_count(cloud), 4);
    assert_true(sample_value(cloud, "normal", EWA_F32, 3, 0, 2) == 6);
    assert_true(sample_value(cloud, "color", EWA_U8, 3, 0, 0) == 7);
    assert_true(sample_value(cloud, "psz", EWA_F32, 1, 0, 0) == 10);
    ewa_cloud_destroy(&cloud);
    cloud = load_counting(XYZ "property float r\nproperty float g\nproperty float b\nproperty float a\n");
    assert_true(sample_value(cloud, "color", EWA_F32, 4, 0, 3) == 7);
    ewa_cloud_destroy(&cloud);
    cloud = load_counting(
        XYZ "property double nx\nproperty double ny\nproperty double nz\nproperty double radius\n");
    assert_true(sample_value(cloud, "normal", EWA_F32, 3, 0, 0) == 4);
    assert_true(sample_value(cloud, "radius", EWA_F32, 1, 0, 0) == 7);
}

CASE(test_types_of_colors) {
    static const ewa_type expected[TYPES] = {EWA_F32, EWA_F32, EWA_U8, EWA_U8,
                                             EWA_U8,  EWA_U16, EWA_U8, EWA_U8};
    for (int encoding = 0; encoding < ENCODINGS; encoding++)
        for (int type = 0; type < TYPES; type++) {
            sample s = sample_start((ewa_ply_encoding)encoding, "\n");
            sample_text(&s, "element vertex 1\n" XYZ);
            for (int c = 0; c < 3; c++) {
                char line[64];
                snprintf(line, sizeof line, "property %s %s", type_names[type][0],
                         c == 0   ? "red"
                         : c == 1 ? "green"
                                  : "blue");
                sample_line(&s, line);
            }
            sample_line(&s, "end_header");
            for (int c = 0; c < 3; c++) sample_number(&s, EWA_F32, 0);
            for (int c = 0; c < 3; c++) sample_number(&s, (ewa_type)type, type_values[type][c]);
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud;
            assert_int_equal(sample_load(context, &s, &cloud), EWA_OK);
            for (uint32_t c = 0; c < 3; c++) {
                const double value = type_values[type][c];
                const double clamped = value < 0 ? 0 : value > 255 ? 255 : value;
                assert_same_bits(sample_value(cloud, "color", expected[type], 3, 0, c),
                                 type == EWA_F64            ? (double)(float)value
                                 : expected[type] == EWA_U8 ? clamped
                                                            : value);
            }
        }
}

CASE(test_incomplete_groups_stay_scalars) {
    ewa_cloud *cloud =
        load_counting(XYZ "property float nx\nproperty float ny\nproperty uchar red\nproperty uchar green\n"
                          "property float blue\nproperty uchar r\nproperty uchar g\n");
    assert_null(ewa_cloud_find(cloud, "normal"));
    assert_null(ewa_cloud_find(cloud, "color"));
    assert_true(sample_value(cloud, "ny", EWA_F32, 1, 0, 0) == 5);
    assert_true(sample_value(cloud, "green", EWA_U8, 1, 0, 0) == 7);
    assert_true(sample_value(cloud, "blue", EWA_F32, 1, 0, 0) == 8);
    ewa_cloud_destroy(&cloud);
    // An alpha of another type is no part of the colour.
    cloud = load_counting(
        XYZ "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float alpha\n");
    assert_true(sample_value(cloud, "color", EWA_U8, 3, 0, 2) == 6);
    assert_true(sample_value(cloud, "alpha", EWA_F32, 1, 0, 0) == 7);
    ewa_cloud_destroy(&cloud);
    assert_int_equal(messages.count, 0);
}

CASE(test_names_that_no_attribute_can_have) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = load_counting(XYZ "property float color\nproperty float intensity\n");
    assert_int_equal(ewa_cloud_attribute_count(cloud), 2);
    assert_true(sample_value(cloud, "intensity", EWA_F32, 1, 0, 0) == 5);
    assert_string_equal(messages.text,
                        "sample.ply: property 'color' is left out: an attribute of that name has 3 "
                        "components");
    ewa_cloud_destroy(&cloud);
    cloud =
        load_counting(XYZ "property float a23456789b123456789c123456789d123456789e123456789f123456789g123\n"
                          "property float a23456789b123456789c123456789d123456789e123456789f123456789g1234\n"
                          "property float bad\x80name\nproperty float gr\xc3\xb6\xc3\x9f"
                          "e\n");
    assert_int_equal(ewa_cloud_attribute_count(cloud), 3);
    assert_true(sample_value(cloud,
                             "gr\xc3\xb6\xc3\x9f"
                             "e",
                             EWA_F32, 1, 0, 0) == 7);
    assert_int_equal(messages.count, 3);
}

CASE(test_elements_and_lists_around_the_vertices) {
    for (int encoding = 0; encoding < ENCODINGS; encoding++) {
        sample s = sample_start((ewa_ply_encoding)encoding, "\n");
        sample_text(
            &s,
            "comment by hand\nobj_info num_cols 512\nCreated by Blender3D 247 - www.blender.org, source file: \n"
            "element camera 2\nproperty double view\nproperty int n\n"
            "element face 3\nproperty list uchar int vertex_indices\nproperty short flags\n"
            "element nothing 5\nelement vertex 300\nproperty list uchar float weights\n" XYZ
            "property list int ushort more\nproperty uchar last\n"
            "element edge 2\nproperty int a\nproperty int b\nend_header\n");
        for (int i = 0; i < 2; i++) {
            sample_number(&s, EWA_F64, 1.5);
            sample_number(&s, EWA_I32, 1000000);
            sample_record_end(&s);
        }
        for (int face = 0; face < 3; face++) {
            sample_number(&s, EWA_U8, face + 3);
            for (int i = 0; i < face + 3; i++) sample_number(&s, EWA_I32, i);
            sample_number(&s, EWA_I16, -5);
            sample_record_end(&s);
        }
        for (int point = 0; point < 300; point++) {
            sample_number(&s, EWA_U8, point % 4);
            for (int i = 0; i < point % 4; i++) sample_number(&s, EWA_F32, 0.5);
            for (int c = 0; c < 3; c++) sample_number(&s, EWA_F32, 3 * point + c);
            sample_number(&s, EWA_I32, point % 7);
            for (int i = 0; i < point % 7; i++) sample_number(&s, EWA_U16, 65535);
            sample_number(&s, EWA_U8, point % 256);
            sample_record_end(&s);
        }
        for (int edge = 0; edge < 2; edge++) {
            sample_number(&s, EWA_I32, edge);
            sample_number(&s, EWA_I32, edge + 1);
            sample_record_end(&s);
        }
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud;
        assert_int_equal(sample_load(context, &s, &cloud), EWA_OK);
        assert_int_equal(ewa_cloud_point_count(cloud), 300);
        assert_int_equal(ewa_cloud_attribute_count(cloud), 2);
        for (int point = 0; point < 300; point++) {
            for (uint32_t c = 0; c < 3; c++)
                assert_true(sample_value(cloud, "position", EWA_F32, 3, point, c) == 3 * point + (int)c);
            assert_true(sample_value(cloud, "last", EWA_U8, 1, point, 0) == point % 256);
        }
    }
    assert_int_equal(messages.count, 0);
}

CASE(test_line_ends) {
    static const char *const ends[] = {"\n", "\r\n", "\r"};
    for (int encoding = 0; encoding < ENCODINGS; encoding++)
        for (int end = 0; end < 3; end++) {
            sample s = sample_start((ewa_ply_encoding)encoding, ends[end]);
            sample_line(&s, "comment  spaced\tout ");
            sample_line(&s, "");
            sample_line(&s, "  element\tvertex   2 ");
            sample_line(&s, "property uchar x");
            sample_line(&s, "property uchar y");
            sample_line(&s, "property uchar z");
            sample_line(&s, "end_header");
            // The first bytes of the data look like a line end.
            for (int i = 0; i < 2; i++) {
                for (int c = 0; c < 3; c++) sample_number(&s, EWA_U8, c == 1 ? 13 : 10);
                sample_record_end(&s);
            }
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud;
            assert_int_equal(sample_load(context, &s, &cloud), EWA_OK);
            for (int i = 0; i < 2; i++)
                for (uint32_t c = 0; c < 3; c++)
                    assert_true(sample_value(cloud, "position", EWA_F32, 3, i, c) == (c == 1 ? 13 : 10));
        }
}

#define ASCII_HEADER(count) "ply\nformat ascii 1.0\nelement vertex " #count "\n" XYZ "end_header\n"

CASE(test_ascii_layouts) {
    static const struct {
        const char *text;
        bool warns;
    } layouts[] = {
        {ASCII_HEADER(3) "1 2 3\n4 5 6\n7 8 9\n", false},
        {ASCII_HEADER(3) "1 2 3\n4 5 6\n7 8 9", false},
        {ASCII_HEADER(3) "  1\t2  3 \r\n4 5 6\r\n7 8 9\r\n", false},
        {ASCII_HEADER(3) "\n1 2 3\n\n \n4 5 6\n7 8 9\n\n\n", false},
        {ASCII_HEADER(3) "1 2 3 4 5 6 7 8 9\n", true},
        {ASCII_HEADER(3) "1\n2\n3\n4\n5\n6\n7\n8\n9\n", true},
        {ASCII_HEADER(3) "1 2 3\n4 5\n6 7 8 9\n", true},
        {"\xef\xbb\xbf" ASCII_HEADER(3) "1 2 3\n4 5 6\n7 8 9\n", false}, // a byte order mark
        {ASCII_HEADER(3) "+1 2.0 3e0\n.4e1 50e-1 6.\n0007 8 9 \n", false},
    };
    for (size_t i = 0; i < sizeof layouts / sizeof layouts[0]; i++) {
        messages.count = 0;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud;
        assert_int_equal(sample_load_text(context, layouts[i].text, &cloud), EWA_OK);
        for (int k = 0; k < 9; k++)
            assert_true(sample_value(cloud, "position", EWA_F32, 3, (uint64_t)k / 3, (uint32_t)k % 3) ==
                        k + 1);
        assert_int_equal(messages.count, layouts[i].warns);
    }
}

CASE(test_ascii_words_and_integers) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud;
    assert_int_equal(sample_load_text(context,
                                      "ply\nformat ascii 1.0\nelement vertex 2\n" XYZ
                                      "property uchar u\nproperty int i\n"
                                      "end_header\nnan inf -inf 255.0 -2e9\n-nan(ind) 1.#INF 1e400 0 -0\n",
                                      &cloud),
                     EWA_OK);
    assert_true(isnan(sample_value(cloud, "position", EWA_F32, 3, 0, 0)));
    assert_true(sample_value(cloud, "position", EWA_F32, 3, 0, 1) == (double)INFINITY);
    assert_true(sample_value(cloud, "position", EWA_F32, 3, 0, 2) == -(double)INFINITY);
    assert_true(isnan(sample_value(cloud, "position", EWA_F32, 3, 1, 0)));
    assert_true(sample_value(cloud, "position", EWA_F32, 3, 1, 2) == (double)INFINITY);
    assert_true(sample_value(cloud, "u", EWA_U8, 1, 0, 0) == 255);
    assert_true(sample_value(cloud, "i", EWA_I32, 1, 0, 0) == -2e9);
}

/// Many lines, so that chunks and blocks have seams, some of them after a blank line.
static sample make_long_ascii(uint64_t points, uint64_t blank_after, const char *line_end) {
    sample s = sample_start(EWA_PLY_ASCII, line_end);
    char line[64];
    snprintf(line, sizeof line, "element vertex %llu", (unsigned long long)points);
    sample_line(&s, line);
    sample_line(&s, "property int x");
    sample_line(&s, "property int y");
    sample_line(&s, "property double z");
    sample_line(&s, "element face 3");
    sample_line(&s, "property list uchar int vertex_indices");
    sample_line(&s, "end_header");
    for (uint64_t i = 0; i < points; i++) {
        sample_number(&s, EWA_I32, (double)i);
        sample_number(&s, EWA_I32, -(double)(i * i % 1000003));
        sample_number(&s, EWA_F64, (double)i / 7);
        sample_record_end(&s);
        if (i == blank_after) sample_record_end(&s);
    }
    for (int i = 0; i < 3; i++) sample_line(&s, "2 0 1");
    return s;
}

CASE(test_long_ascii) {
    enum { POINTS = 140000 }; // more text than one wave of parallel tasks takes
    static const struct {
        uint64_t blank_after;
        const char *line_end;
    } cases[] = {{UINT64_MAX, "\n"}, {UINT64_MAX, "\r"}, {UINT64_MAX, "\r\n"}, {120000, "\n"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        sample s = make_long_ascii(POINTS, cases[i].blank_after, cases[i].line_end);
        for (uint32_t threads = 1; threads <= 7; threads += 6) {
            OWNED(ewa_context_destroy) ewa_context *own = check_context(threads, &messages);
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud;
            assert_int_equal(sample_load_bytes(own, s.bytes, s.size, &cloud), EWA_OK);
            double values[3];
            const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
            for (uint64_t k = 0; k < POINTS; k++) {
                ewa_attribute_read_f64(position, k, 1, values);
                if (values[0] != (double)k || values[1] != -(double)(k * k % 1000003) ||
                    values[2] != (double)k / 7)
                    fail_msg("point %llu is wrong", (unsigned long long)k);
            }
        }
        free(s.bytes);
    }
    assert_int_equal(messages.count, 0);
}

CASE(test_empty_cloud) {
    for (int encoding = 0; encoding < ENCODINGS; encoding++) {
        sample s = sample_start((ewa_ply_encoding)encoding, "\n");
        sample_text(&s, "element vertex 0\n" XYZ "end_header");
        if (encoding) sample_text(&s, "\n");
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud;
        assert_int_equal(sample_load(context, &s, &cloud), EWA_OK);
        assert_int_equal(ewa_cloud_point_count(cloud), 0);
        assert_non_null(ewa_cloud_find(cloud, EWA_POSITION));
    }
}

/// What the models' README says of the files that hold vertices.

CASE(test_real_models) {
    for (size_t i = 0; i < sizeof model_facts / sizeof model_facts[0]; i++) {
        char path[512];
        if (!check_data(model_facts[i].path, path, sizeof path)) skip();
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud;
        assert_int_equal(ewa_cloud_load(context, path, &cloud), EWA_OK);
        ewa_bounds bounds;
        assert_int_equal(ewa_cloud_measure(cloud, &bounds), EWA_OK);
        assert_true(ewa_cloud_point_count(cloud) == model_facts[i].points);
        for (int c = 0; c < 3; c++)
            if (fabs(bounds.low_world[c] - model_facts[i].low[c]) > 1e-5 * fabs(model_facts[i].low[c]) ||
                fabs(bounds.high_world[c] - model_facts[i].high[c]) > 1e-5 * fabs(model_facts[i].high[c]))
                fail_msg("%s: %g to %g on axis %d", model_facts[i].path, bounds.low_world[c],
                         bounds.high_world[c], c);
    }
    assert_int_equal(messages.count, 0);
}

CASE(test_one_model_in_both_byte_orders) {
    char path[512];
    OWNED(ewa_cloud_destroy) ewa_cloud *little, *big;
    if (!check_data("models/variants/dolphins_le.ply", path, sizeof path)) skip();
    assert_int_equal(ewa_cloud_load(context, path, &little), EWA_OK);
    if (!check_data("models/variants/dolphins_be.ply", path, sizeof path)) skip();
    assert_int_equal(ewa_cloud_load(context, path, &big), EWA_OK);
    assert_same_cloud(little, big);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
