// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/cloud/edit.c: parts, unions, affine maps.
#include "check.h"

#include <math.h>
#include <string.h>

#include "io/fixture.h"

/// A cloud of `count` points with positions (i, 10 i, 100 i) and one further attribute.
static ewa_cloud *make(uint64_t count, ewa_type position_type, const char *name, ewa_type type) {
    ewa_cloud *cloud = check_cloud_of(context, count);
    void *positions = NULL, *numbers = NULL;
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, position_type, 3, &positions), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, name, type, 1, &numbers), EWA_OK);
    for (uint64_t i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++) {
            const double p = (double)i * (c == 0 ? 1 : c == 1 ? 10 : 100);
            if (position_type == EWA_F64)
                ((double *)positions)[3 * i + (uint64_t)c] = p;
            else
                ((float *)positions)[3 * i + (uint64_t)c] = (float)p;
        }
        if (type == EWA_U8)
            ((uint8_t *)numbers)[i] = (uint8_t)i;
        else
            ((float *)numbers)[i] = (float)i + 0.5f;
    }
    return cloud;
}

static double number(const ewa_cloud *cloud, const char *name, uint64_t point, uint32_t component) {
    double values[4];
    const ewa_attribute *attribute = ewa_cloud_find(cloud, name);
    assert_non_null(attribute);
    ewa_attribute_read_f64(attribute, point, 1, values);
    return values[component];
}

TEST(test_select) {
    ewa_cloud *cloud = make(10, EWA_F32, "intensity", EWA_U8), *part = NULL;
    const double origin[3] = {1e6, 2e6, 3};
    ewa_cloud_set_origin(cloud, origin);
    const uint64_t indices[] = {7, 2, 2, 9};
    assert_int_equal(ewa_cloud_select(cloud, indices, 4, &part), EWA_OK);
    assert_int_equal(ewa_cloud_point_count(part), 4);
    for (uint64_t i = 0; i < 4; i++) {
        assert_true(number(part, EWA_POSITION, i, 2) == 100.0 * (double)indices[i]);
        assert_true(number(part, "intensity", i, 0) == (double)indices[i]);
    }
    double kept[3];
    ewa_cloud_origin(part, kept);
    assert_memory_equal(kept, origin, sizeof kept);
    ewa_cloud_destroy(&part);
    assert_int_equal(ewa_cloud_select(cloud, NULL, 0, &part), EWA_OK);
    assert_int_equal(ewa_cloud_point_count(part), 0);
    ewa_cloud_destroy(&part);
    const uint64_t beyond = 10;
    assert_int_equal(ewa_cloud_select(cloud, &beyond, 1, &part), EWA_ERROR_ARGUMENT);
    assert_null(part);
    ewa_cloud_destroy(&cloud);
}

/// Streams with gaps between the points are read through their stride.
TEST(test_select_borrowed) {
    const float records[] = {1, 2, 3, -1, 4, 5, 6, -1, 7, 8, 9, -1};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL, *part = NULL, *both = NULL;
    assert_int_equal(ewa_cloud_create(context, 3, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F32, 3, records, 16), EWA_OK);
    const uint64_t last = 2;
    assert_int_equal(ewa_cloud_select(cloud, &last, 1, &part), EWA_OK);
    assert_true(number(part, EWA_POSITION, 0, 1) == 8);
    const ewa_cloud *const clouds[] = {part, cloud};
    assert_int_equal(ewa_cloud_merge(clouds, 2, &both), EWA_OK);
    assert_true(number(both, EWA_POSITION, 0, 2) == 9 && number(both, EWA_POSITION, 2, 0) == 4);
}

TEST(test_merge) {
    OWNED(ewa_cloud_destroy)
    ewa_cloud *a = make(300, EWA_F32, "intensity", EWA_U8), *b = make(700, EWA_F64, "intensity", EWA_F32),
              *all = NULL;
    void *times = NULL;
    assert_int_equal(ewa_cloud_add(b, "time", EWA_F64, 1, &times), EWA_OK);
    for (int i = 0; i < 700; i++) ((double *)times)[i] = i + 0.5;
    const double origin_a[3] = {1000, 0, 0}, origin_b[3] = {1000, 0.25, -7};
    ewa_cloud_set_origin(a, origin_a);
    ewa_cloud_set_origin(b, origin_b);
    const ewa_cloud *const clouds[] = {a, b};
    messages.count = 0;
    assert_int_equal(ewa_cloud_merge(clouds, 2, &all), EWA_OK);
    assert_int_equal(messages.count, 1);
    assert_non_null(strstr(messages.text, "attribute 'time': 1 of 2 clouds lack it, their points get NaN"));
    assert_int_equal(ewa_cloud_point_count(all), 1000);
    assert_int_equal(ewa_cloud_attribute_count(all), 3);
    assert_true(isnan(number(all, "time", 299, 0)));
    assert_true(number(all, "time", 300 + 17, 0) == 17.5);
    assert_int_equal(ewa_cloud_find(all, EWA_POSITION)->type, EWA_F64);
    assert_int_equal(ewa_cloud_find(all, "intensity")->type, EWA_F32);
    assert_true(number(all, "intensity", 255, 0) == 255 && number(all, "intensity", 300 + 40, 0) == 40.5);
    // In the world every point is where it was.
    double origin[3];
    ewa_cloud_origin(all, origin);
    for (uint64_t i = 0; i < 700; i++)
        for (uint32_t c = 0; c < 3; c++)
            assert_true(number(all, EWA_POSITION, 300 + i, c) + origin[c] ==
                        number(b, EWA_POSITION, i, c) + origin_b[c]);
}

/// Adds a stream whose every number is the same.
static void add_constant(ewa_cloud *cloud, const char *name, ewa_type type, uint32_t components,
                         double number) {
    void *data = NULL;
    assert_int_equal(ewa_cloud_add(cloud, name, type, components, &data), EWA_OK);
    for (uint64_t i = 0; i < components * ewa_cloud_point_count(cloud); i++)
        if (type == EWA_U8)
            ((uint8_t *)data)[i] = (uint8_t)number;
        else if (type == EWA_U16)
            ((uint16_t *)data)[i] = (uint16_t)number;
        else if (type == EWA_I32)
            ((int32_t *)data)[i] = (int32_t)number;
        else
            ((float *)data)[i] = (float)number;
}

/// Colours of every kind become one, and those without become grey; classes become 0; normals need all.
TEST(test_merge_colors) {
    static const struct {
        ewa_type types[2];
        uint32_t components[2];
        double numbers[2];
        ewa_type type;
        uint32_t count;
        double expected[3], alpha, alpha_of_first; ///< of the first, the second, one without colours
    } cases[] = {
        {{EWA_U8, EWA_U8}, {3, 3}, {10, 200}, EWA_U8, 3, {10, 200, 203}, 0, 0},
        {{EWA_U8, EWA_U8}, {3, 4}, {10, 200}, EWA_U8, 4, {10, 200, 203}, 255, 255},
        {{EWA_U8, EWA_U16}, {3, 3}, {10, 2000}, EWA_U16, 3, {2570, 2000, 203 * 257}, 0, 0},
        {{EWA_U16, EWA_U8}, {4, 3}, {1000, 255}, EWA_U16, 4, {1000, 65535, 203 * 257}, 65535, 1000},
        {{EWA_F32, EWA_F32}, {3, 3}, {0.25, 7}, EWA_F32, 3, {0.25, 7, 0.6}, 0, 0},
        {{EWA_F32, EWA_U8}, {3, 3}, {0.25, 255}, EWA_F32, 3, {0.25, 1, 0.6}, 0, 0},
        {{EWA_I32, EWA_I32}, {3, 3}, {0, 2147483647}, EWA_F32, 3, {0, 1, 0.6}, 0, 0},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        ewa_cloud *parts[3], *all = NULL;
        for (int i = 0; i < 3; i++) {
            parts[i] = make(4, EWA_F32, "intensity", EWA_U8);
            if (i < 2)
                add_constant(parts[i], EWA_COLOR, cases[k].types[i], cases[k].components[i],
                             cases[k].numbers[i]);
        }
        add_constant(parts[1], "classification", EWA_U8, 1, 6);
        add_constant(parts[2], EWA_NORMAL, EWA_F32, 3, 1);
        assert_int_equal(ewa_cloud_merge((const ewa_cloud *const *)parts, 3, &all), EWA_OK);
        assert_non_null(strstr(messages.text, "attribute 'normal' of cloud 3 is dropped"));
        assert_null(ewa_cloud_find(all, EWA_NORMAL));
        const ewa_attribute *color = ewa_cloud_find(all, EWA_COLOR);
        assert_int_equal(color->type, cases[k].type);
        assert_int_equal(color->component_count, cases[k].count);
        for (uint64_t i = 0; i < 12; i++) {
            for (uint32_t c = 0; c < 3; c++)
                assert_true(fabs(number(all, EWA_COLOR, i, c) - cases[k].expected[i / 4]) < 1e-6);
            if (color->component_count == 4 && i < 4)
                assert_true(number(all, EWA_COLOR, i, 3) == cases[k].alpha_of_first);
            if (color->component_count == 4 && i >= 8)
                assert_true(number(all, EWA_COLOR, i, 3) == cases[k].alpha);
            assert_true(number(all, "classification", i, 0) == (i / 4 == 1 ? 6 : 0));
        }
        ewa_cloud_destroy(&all);
        for (int i = 0; i < 3; i++) ewa_cloud_destroy(&parts[i]);
    }
}

/// Reference systems that differ are named; one that is missing or the same says nothing.
TEST(test_merge_systems) {
    ewa_cloud *parts[3], *all = NULL;
    for (int i = 0; i < 3; i++) parts[i] = make(4, EWA_F32, "intensity", EWA_U8);
    assert_int_equal(ewa_cloud_set_note(parts[0], "crs", "EPSG:32632", 10), EWA_OK);
    messages.count = 0;
    assert_int_equal(ewa_cloud_merge((const ewa_cloud *const *)parts, 3, &all), EWA_OK);
    assert_int_equal(messages.count, 0);
    assert_string_equal(ewa_cloud_note(all, "crs", NULL), "EPSG:32632");
    ewa_cloud_destroy(&all);
    assert_int_equal(ewa_cloud_set_note(parts[2], "crs", "PROJCS[\"other\", ...]", 20), EWA_OK);
    assert_int_equal(ewa_cloud_set_note(parts[2], "crs_name", "ETRS89 / UTM zone 33N", 21), EWA_OK);
    assert_int_equal(ewa_cloud_merge((const ewa_cloud *const *)parts, 3, &all), EWA_OK);
    assert_int_equal(messages.count, 1);
    assert_non_null(strstr(messages.text, "clouds 1 and 3 are in different coordinate reference systems, "
                                          "'EPSG:32632' and 'ETRS89 / UTM zone 33N'"));
    ewa_cloud_destroy(&all);
    for (int i = 0; i < 3; i++) ewa_cloud_destroy(&parts[i]);
}

static void add_triple(ewa_cloud *cloud, const char *name, float x, float y, float z) {
    void *data = NULL;
    assert_int_equal(ewa_cloud_add(cloud, name, EWA_F32, 3, &data), EWA_OK);
    float *triple = data;
    triple[0] = x;
    triple[1] = y;
    triple[2] = z;
}

/// A random affine map keeps what geometry says: normals stay across the axes, clip lines keep their points.
TEST(test_transform) {
    check_random random = {7};
    for (int round = 0; round < 200; round++) {
        double m[16] = {0};
        for (int i = 0; i < 12; i++) m[i] = check_uniform(&random, -2, 2);
        m[15] = 1;
        const double det = m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
                           m[2] * (m[4] * m[9] - m[5] * m[8]);
        if (fabs(det) < 0.5) continue;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, 1);
        add_triple(cloud, EWA_POSITION, 1, -2, 0.5f);
        add_triple(cloud, EWA_TANGENT_U, 0.3f, 0, 0.1f);
        add_triple(cloud, EWA_TANGENT_V, 0, 0.2f, 0);
        add_triple(cloud, EWA_NORMAL, -0.1f, 0, 0.3f); // u x v, not normalised
        add_triple(cloud, EWA_CLIP0, 1, 2, 0.5f);
        add_triple(cloud, EWA_BORDER, 0.5f, -1, 0.25f);
        void *radius = NULL;
        assert_int_equal(ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, &radius), EWA_OK);
        *(float *)radius = 2;
        const double origin[3] = {10, 20, 30};
        ewa_cloud_set_origin(cloud, origin);
        assert_int_equal(ewa_cloud_transform(cloud, m), EWA_OK);
        double moved[3], n[3], u[3], v[3], cross[3], dot_u = 0, dot_v = 0, length = 0, along = 0;
        ewa_cloud_origin(cloud, moved);
        for (uint32_t c = 0; c < 3; c++) {
            const double world = m[4 * c] * 11 + m[4 * c + 1] * 18 + m[4 * c + 2] * 30.5 + m[4 * c + 3];
            assert_true(fabs(number(cloud, EWA_POSITION, 0, c) + moved[c] - world) < 1e-5);
            n[c] = number(cloud, EWA_NORMAL, 0, c);
            u[c] = number(cloud, EWA_TANGENT_U, 0, c);
            v[c] = number(cloud, EWA_TANGENT_V, 0, c);
        }
        for (int c = 0; c < 3; c++) {
            cross[c] = u[(c + 1) % 3] * v[(c + 2) % 3] - u[(c + 2) % 3] * v[(c + 1) % 3];
            dot_u += n[c] * u[c];
            dot_v += n[c] * v[c];
            length += n[c] * n[c];
            along += n[c] * cross[c];
        }
        assert_true(fabs(length - 1) < 1e-5 && fabs(dot_u) < 1e-5 && fabs(dot_v) < 1e-5);
        // u x v stays on the side of the normal, also under reflections, and the clip line keeps the same
        // points.
        assert_true(along > 0);
        assert_true(fabs(number(cloud, EWA_CLIP0, 0, 1) - (det < 0 ? -2 : 2)) < 1e-6);
        assert_true(fabs(number(cloud, EWA_RADIUS, 0, 0) - 2 * cbrt(fabs(det))) < 1e-5);
        // What lay on the plane through the border, across it, lies on that of the new one.
        static const double on_plane[3][3] = {{0.5, -1, 0.25}, {2.5, 0, 0.25}, {0.5, 0, 4.25}};
        for (int k = 0; k < 3; k++) {
            double there = 0, border2 = 0;
            for (uint32_t r = 0; r < 3; r++) {
                const double b = number(cloud, EWA_BORDER, 0, r), *p = on_plane[k];
                there += b * (m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2]);
                border2 += b * b;
            }
            assert_true(border2 > 0 && fabs(there - border2) < 1e-5 * (1 + border2));
        }
    }
}

/// Scanners go with what they saw, and so does the eye of a range image.
TEST(test_transform_scanners) {
    static const double m[16] = {0, -1, 0, 1000, 1, 0, 0, 2000, 0, 0, 1, 30, 0, 0, 0, 1};
    static const char *const notes[][2] = {{"1 2 3", "998 2001 33"}, {"1 2 3\n0.5 0 -1", "998 2001 33\n1000 2000.5 29"}, {NULL, "1000 2000 30"}};
    for (size_t i = 0; i < 3; i++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, 1);
        add_triple(cloud, EWA_POSITION, 1, -2, 0.5f);
        const char *name = notes[i][0] ? "scanners" : "file.organised", *note = notes[i][0] ? notes[i][0] : "640 x 480";
        assert_int_equal(ewa_cloud_set_note(cloud, name, note, strlen(note)), EWA_OK);
        assert_int_equal(ewa_cloud_transform(cloud, m), EWA_OK);
        assert_string_equal(ewa_cloud_note(cloud, "scanners", NULL), notes[i][1]);
    }
}

TEST(test_transform_refusals) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make(2, EWA_F32, "a", EWA_U8);
    double m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
    assert_int_equal(ewa_cloud_transform(cloud, m), EWA_ERROR_NUMERIC);
    m[10] = NAN;
    assert_int_equal(ewa_cloud_transform(cloud, m), EWA_ERROR_ARGUMENT);
    m[10] = 1;
    m[12] = 1;
    assert_int_equal(ewa_cloud_transform(cloud, m), EWA_ERROR_ARGUMENT);
}

int main(void) { return RUN_TESTS(begin, end); }
