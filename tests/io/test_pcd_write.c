// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of PCD files that are written: they read back as they were, whole and in pieces.
#include "io/cloud_check.h"

#define FIXTURE_THREADS 3
#include "io/fixture.h"

static ewa_cloud *make_cloud(uint64_t point_count, ewa_type position_type) {
    ewa_cloud *cloud = check_cloud_of(context, point_count);
    static const struct {
        const char *name;
        ewa_type type;
        uint32_t component_count;
    } streams[] = {{"normal", EWA_F32, 3},   {"color", EWA_U8, 4},      {"intensity", EWA_U16, 1},
                   {"gps_time", EWA_F64, 1}, {"tangent_u", EWA_F32, 3}, {"a b", EWA_I8, 1},
                   {"pair", EWA_I32, 2}};
    check_random random = {21};
    void *data;
    assert_int_equal(ewa_cloud_add(cloud, "position", position_type, 3, &data), EWA_OK);
    for (uint64_t i = 0; i < 3 * point_count; i++) {
        const double value = check_uniform(&random, -1000, 1000);
        if (position_type == EWA_F32)
            ((float *)data)[i] = (float)value;
        else
            ((double *)data)[i] = value;
    }
    for (size_t s = 0; s < sizeof streams / sizeof streams[0]; s++) {
        const uint32_t n = streams[s].component_count;
        assert_int_equal(ewa_cloud_add(cloud, streams[s].name, streams[s].type, n, &data), EWA_OK);
        uint8_t *byte = data;
        for (uint64_t i = 0; i < point_count * n * ewa_type_bytes(streams[s].type); i++)
            byte[i] = (uint8_t)check_random_u64(&random);
        for (uint64_t i = 0; i < point_count * n; i++) { // no NaN, whose bits text does not keep
            if (streams[s].type == EWA_F32) ((float *)data)[i] = (float)check_uniform(&random, -1, 1);
            if (streams[s].type == EWA_F64) ((double *)data)[i] = check_uniform(&random, -1, 1);
        }
    }
    return cloud;
}

static void check_written(const ewa_cloud *cloud, const ewa_cloud *back) {
    assert_int_equal(ewa_cloud_point_count(back), ewa_cloud_point_count(cloud));
    assert_int_equal(ewa_cloud_attribute_count(back), ewa_cloud_attribute_count(cloud));
    for (uint32_t i = 0; i < ewa_cloud_attribute_count(cloud); i++) {
        const ewa_attribute *a = ewa_cloud_attribute_at(cloud, i);
        const char *name = strcmp(a->name, "a b") == 0 ? "a_b" : a->name;
        for (uint64_t point = 0; point < ewa_cloud_point_count(cloud); point++) {
            double values[4];
            ewa_attribute_read_f64(a, point, 1, values);
            cloud_expect(back, name, a->type, a->component_count, point, values);
        }
    }
}

CASE(test_written_files_read_back) {
    char path[512];
    scratch_path("back.pcd", path);
    for (int encoding = 0; encoding < 3; encoding += 2)
        for (int type = EWA_F32; type <= EWA_F64; type++) {
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(9001, (ewa_type)type), *back = NULL;
            WITH_DEFAULTS(ewa_cloud_save_options, options);
            options.ply_encoding = (ewa_ply_encoding)encoding;
            assert_int_equal(ewa_cloud_set_note(cloud, "scanners", "1.5 -2 3e6", 10), EWA_OK);
            assert_int_equal(ewa_cloud_save(cloud, path, &options), EWA_OK);
            assert_int_equal(ewa_cloud_load(context, path, &back), EWA_OK);
            check_written(cloud, back);
            assert_string_equal(ewa_cloud_note(back, "scanners", NULL), "1.5 -2 3000000");
            assert_string_equal(ewa_cloud_note(back, "file.format", NULL),
                                encoding ? "PCD 0.7 ascii" : "PCD 0.7 binary");
        }
    assert_string_equal(messages.text, "");
}

CASE(test_written_in_pieces_of_unknown_count) {
    char path[512];
    scratch_path("pieces.pcd", path);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(300, EWA_F32), *back = NULL;
    ewa_cloud_writer *writer = NULL;
    assert_int_equal(ewa_cloud_writer_open(context, path, NULL, cloud, EWA_POINTS_UNKNOWN, NULL, &writer),
                     EWA_OK);
    for (int i = 0; i < 5; i++) assert_int_equal(ewa_cloud_writer_put(writer, cloud), EWA_OK);
    assert_int_equal(ewa_cloud_writer_commit(&writer), EWA_OK);
    assert_int_equal(ewa_cloud_load(context, path, &back), EWA_OK);
    assert_int_equal(ewa_cloud_point_count(back), 1500);
}

CASE(test_world_coordinates_are_written) {
    char path[512];
    scratch_path("world.pcd", path);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL, *back = NULL;
    void *data;
    assert_int_equal(ewa_cloud_create(context, 1, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, "position", EWA_F32, 3, &data), EWA_OK);
    memcpy(data, (const float[3]){0.25f, -0.5f, 1}, 12);
    ewa_cloud_set_origin(cloud, (const double[3]){4200000, 500000, 0});
    assert_int_equal(ewa_cloud_save(cloud, path, NULL), EWA_OK);
    assert_int_equal(ewa_cloud_load(context, path, &back), EWA_OK);
    cloud_expect_world(back, 0, (const double[]){4200000.25, 499999.5, 1});
}

CASE(test_what_is_not_written) {
    char path[512];
    scratch_path("refused.pcd", path);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(1, EWA_F32);
    WITH_DEFAULTS(ewa_cloud_save_options, options);
    options.ply_encoding = EWA_PLY_BINARY_BIG_ENDIAN;
    assert_int_equal(ewa_cloud_save(cloud, path, &options), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(messages.text, "PCD files are not big-endian"));
    assert_int_equal(ewa_cloud_add(cloud, "a_b", EWA_U8, 1, NULL), EWA_OK);
    assert_int_equal(ewa_cloud_save(cloud, path, NULL), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(messages.text, "field 'a_b' would have the name of another one"));
}

int main(void) { return RUN_TESTS(NULL, NULL); }
