// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/cloud: streams, borrowed memory, reading as floats, bounds.
#include "check.h"

#include "cloud/cloud.h"

#include <math.h>
#include <string.h>

TEST_ON(test_streams, 0) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, 3);
    for (int i = 0; i < 20; i++) {
        char name[16];
        snprintf(name, sizeof name, "scalar_%d", i);
        uint16_t *values = check_add(cloud, name, EWA_U16, 1);
        for (int p = 0; p < 3; p++) values[p] = (uint16_t)(100 * i + p);
    }
    ewa_cloud_remove(cloud, "scalar_3");
    ewa_cloud_remove(cloud, "no such stream");
    assert_null(ewa_cloud_find(cloud, "scalar_3"));
    assert_int_equal(ewa_cloud_attribute_count(cloud), 19);
    float read[2];
    ewa_attribute_read_f32(ewa_cloud_find(cloud, "scalar_7"), 1, 2, read);
    assert_true(read[0] == 701.0f && read[1] == 702.0f);
    assert_int_equal(ewa_cloud_add(cloud, "", EWA_F32, 1, NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_cloud_add(cloud, "five", EWA_F32, 5, NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_cloud_add(cloud, "odd", (ewa_type)99, 1, NULL), EWA_ERROR_ARGUMENT);
}

TEST_ON(test_borrowed_stride_and_bounds, 0) {
    struct record {
        float x, y, z, unused;
    } records[4] = {{1, 2, 3, 9}, {NAN, 0, 0, 9}, {-1, INFINITY, 0, 9}, {4, -5, 6, 9}};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, 4);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F32, 3, records, 6), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F32, 3, records, sizeof records[0]), EWA_OK);
    const double origin[3] = {500000, 4000000, 100};
    ewa_cloud_set_origin(cloud, origin);
    ewa_bounds bounds;
    assert_int_equal(ewa_cloud_measure(cloud, &bounds), EWA_OK);
    assert_int_equal(bounds.finite_count, 2);
    assert_true(bounds.low_world[0] == 500001 && bounds.high_world[0] == 500004);
    assert_true(bounds.low_world[1] == 3999995 && bounds.high_world[2] == 106);
}

/// Packed numbers and those with others between them read the same, whatever their type.
TEST_ON(test_packed_and_strided, 0) {
    enum { COUNT = 37, MAX_BYTES = 8 };
    for (int type = EWA_F32; type <= EWA_U32; type++) {
        _Alignas(8) static uint8_t packed[COUNT * 3 * MAX_BYTES], strided[COUNT * 4 * MAX_BYTES];
        const size_t bytes = ewa_type_bytes((ewa_type)type);
        for (size_t i = 0; i < sizeof packed; i++) packed[i] = (uint8_t)(61 * i % 127); // no NaN
        for (size_t i = 0; i < COUNT; i++) memcpy(strided + 4 * bytes * i, packed + 3 * bytes * i, 3 * bytes);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, COUNT);
        assert_int_equal(ewa_cloud_borrow(cloud, "packed", (ewa_type)type, 3, packed, 0), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(cloud, "strided", (ewa_type)type, 3, strided, 4 * bytes), EWA_OK);
        double a[3 * COUNT], b[3 * COUNT];
        float c[3 * COUNT], d[3 * COUNT];
        ewa_attribute_read_f64(ewa_cloud_find(cloud, "packed"), 5, COUNT - 6, a);
        ewa_attribute_read_f64(ewa_cloud_find(cloud, "strided"), 5, COUNT - 6, b);
        ewa_attribute_read_f32(ewa_cloud_find(cloud, "packed"), 5, COUNT - 6, c);
        ewa_attribute_read_f32(ewa_cloud_find(cloud, "strided"), 5, COUNT - 6, d);
        assert_memory_equal(a, b, 3 * (COUNT - 6) * sizeof *a);
        assert_memory_equal(c, d, 3 * (COUNT - 6) * sizeof *c);
    }
}

/// Names, types, components and their order count; points do not.
TEST_ON(test_alike, 0) {
    static const struct {
        const char *names[2];
        ewa_type type;
        uint32_t component_count, count;
    } others[] = {{{"a", "b"}, EWA_F32, 1, 2}, {{"a", "b"}, EWA_U16, 1, 2}, {{"a", "b"}, EWA_F32, 2, 2},
                  {{"b", "a"}, EWA_F32, 1, 2}, {{"a", "c"}, EWA_F32, 1, 2}, {{"a", "b"}, EWA_F32, 1, 1}};
    ewa_cloud *clouds[6];
    for (uint32_t i = 0; i < 6; i++) {
        assert_int_equal(ewa_cloud_create(context, i, &clouds[i]), EWA_OK);
        for (uint32_t k = 0; k < others[i].count; k++)
            assert_int_equal(ewa_cloud_add(clouds[i], others[i].names[k], others[i].type, others[i].component_count, NULL), EWA_OK);
        assert_int_equal(ewa_cloud_is_alike(clouds[i], clouds[0]), i == 0);
        assert_int_equal(ewa_cloud_is_alike(clouds[0], clouds[i]), i == 0);
    }
    for (uint32_t i = 0; i < 6; i++) ewa_cloud_destroy(&clouds[i]);
}

TEST_LOGGED(test_too_many_points, 0) {
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_create(context, (uint64_t)1 << 40, &cloud), EWA_ERROR_LIMIT);
    assert_non_null(strstr(log->text, "limit"));
}

int main(void) { return RUN_TESTS(NULL, NULL); }
