// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of the PLY writer: what is written reads back the same in every encoding, does not depend on threads,
// and appears whole or not at all.
#define _XOPEN_SOURCE 700 // mkdtemp
#include "io/file.h"
#include "io/ply_sample.h"

#include <dirent.h>
#include <math.h>
#include <sys/stat.h>
#include <unistd.h>

static ewa_context *context;
static check_log messages;
static char folder[64];

static int set_up(void **state) {
    memset(&messages, 0, sizeof messages);
    context = check_context(2, &messages);
    snprintf(folder, sizeof folder, "/tmp/ewa-test-ply-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int count_files(bool remove_them) {
    DIR *list = opendir(folder);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(list));) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
        count++;
        char path[512];
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (remove_them) unlink(path);
    }
    closedir(list);
    return count;
}

static int tear_down(void **state) {
    count_files(true);
    ewa_context_destroy(&context);
    return rmdir(folder);
}

static char *inside(const char *name, char path[128]) {
    snprintf(path, 128, "%s/%s", folder, name);
    return path;
}

static ewa_status save_as(const ewa_cloud *cloud, const char *path, int encoding) {
    WITH_DEFAULTS(ewa_cloud_save_options, options);
    options.ply_encoding = (ewa_ply_encoding)encoding;
    return ewa_cloud_save(cloud, path, &options);
}

static void fill_bits(check_random *random, void *data, size_t size) {
    uint8_t *bytes = data;
    for (size_t i = 0; i < size; i++) bytes[i] = (uint8_t)(check_random_u64(random) >> 11);
}

/// All canonical attributes and one scalar of every type; floats of any bits, so with NaN, infinities,
/// denormals.
static ewa_cloud *make_everything(ewa_context *owner, uint64_t points, ewa_type position_type,
                                  ewa_type color_type) {
    static const struct {
        const char *name;
        ewa_type type;
        uint32_t components;
    } parts[] = {
        {"normal", EWA_F32, 3},  {"radius", EWA_F32, 1}, {"tangent_u", EWA_F32, 3}, {"tangent_v", EWA_F32, 3},
        {"clip0", EWA_F32, 3},   {"clip1", EWA_F32, 3},  {"border", EWA_F32, 3},    {"clip_mode", EWA_U8, 1},
        {"material", EWA_U16, 1}, {"quality", EWA_F32, 1}, {"gps", EWA_F64, 1},     {"i8", EWA_I8, 1},
        {"u8", EWA_U8, 1},       {"i16", EWA_I16, 1},    {"u16", EWA_U16, 1},       {"i32", EWA_I32, 1},
        {"u32", EWA_U32, 1}};
    ewa_cloud *cloud;
    void *data;
    check_random random = {points};
    assert_int_equal(ewa_cloud_create(owner, points, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, position_type, 3, &data), EWA_OK);
    fill_bits(&random, data, points * 3 * ewa_type_bytes(position_type));
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        // The reader makes the known groups before the other scalars: the colour has its place behind the
        // normal.
        if (i == 1) {
            assert_int_equal(ewa_cloud_add(cloud, EWA_COLOR, color_type, 4, &data), EWA_OK);
            fill_bits(&random, data, points * 4 * ewa_type_bytes(color_type));
        }
        assert_int_equal(ewa_cloud_add(cloud, parts[i].name, parts[i].type, parts[i].components, &data),
                         EWA_OK);
        fill_bits(&random, data, points * parts[i].components * ewa_type_bytes(parts[i].type));
    }
    return cloud;
}

TEST_WITHIN(test_round_trips_are_exact, set_up, tear_down) {
    static const ewa_type colors[] = {EWA_U8, EWA_U16, EWA_F32};
    static const uint64_t counts[] = {0, 1, 2, 1000};
    char path[128];
    inside("cloud.ply", path);
    for (int encoding = 0; encoding < 3; encoding++)
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 4; k++) {
                OWNED(ewa_cloud_destroy)
                ewa_cloud *cloud = make_everything(context, counts[k], i == 1 ? EWA_F64 : EWA_F32, colors[i]),
                          *back;
                assert_int_equal(save_as(cloud, path, encoding), EWA_OK);
                assert_int_equal(ewa_cloud_load(context, path, &back), EWA_OK);
                assert_same_cloud(cloud, back);
            }
    assert_int_equal(messages.count, 0);
    assert_int_equal(count_files(false), 1);
}

TEST_WITHIN(test_bits_of_nan_survive_in_binary, set_up, tear_down) {
    char path[128];
    inside("nan.ply", path);
    for (int encoding = 0; encoding < 2; encoding++) {
        const uint32_t bits[3] = {0x7fc12345, 0xffc00001, 0x7f800001};
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud, *back;
        assert_int_equal(ewa_cloud_create(context, 1, &cloud), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F32, 3, bits, 0), EWA_OK);
        assert_int_equal(save_as(cloud, path, encoding), EWA_OK);
        assert_int_equal(ewa_cloud_load(context, path, &back), EWA_OK);
        assert_memory_equal(ewa_cloud_find(back, EWA_POSITION)->data, bits, sizeof bits);
    }
}

static void assert_file(const char *path, const char *text) {
    ewa_file file;
    assert_int_equal(ewa_file_map(context, path, &file), EWA_OK);
    if (file.size_bytes != strlen(text) || memcmp(file.bytes, text, file.size_bytes) != 0)
        fail_msg("'%.*s' instead of '%s'", (int)file.size_bytes, (const char *)file.bytes, text);
    ewa_file_unmap(context, &file);
}

TEST_WITHIN(test_text_that_is_written, set_up, tear_down) {
    // Interleaved memory of the caller, an attribute of several components that has no canonical names,
    // blanks.
    struct vertex {
        float position[3];
        uint8_t color[3], unused;
        double pair[2];
        int32_t label;
    } vertices[2] = {{{0, -1.5f, 0.1f}, {255, 0, 7}, 9, {1e-7, 3}, -5},
                     {{1e20f, 2, 3}, {1, 2, 3}, 9, {0.25, -0.0}, 2000000000}};
    char path[128];
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud;
    assert_int_equal(ewa_cloud_create(context, 2, &cloud), EWA_OK);
    ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F32, 3, vertices[0].position, sizeof vertices[0]);
    ewa_cloud_borrow(cloud, EWA_COLOR, EWA_U8, 3, vertices[0].color, sizeof vertices[0]);
    ewa_cloud_borrow(cloud, "pair", EWA_F64, 2, vertices[0].pair, sizeof vertices[0]);
    ewa_cloud_borrow(cloud, "my\nlabel", EWA_I32, 1, &vertices[0].label, sizeof vertices[0]);
    assert_int_equal(save_as(cloud, inside("text.PLY", path), EWA_PLY_ASCII), EWA_OK);
    assert_file(
        path,
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\n"
        "property double pair_0\nproperty double pair_1\nproperty int my_label\nend_header\n"
        "0 -1.5 0.1 255 0 7 1e-7 3 -5\n1e20 2 3 1 2 3 0.25 -0 2000000000\n");
}

TEST_WITHIN(test_origin_gives_doubles, set_up, tear_down) {
    char path[128];
    inside("georeferenced.ply", path);
    for (int encoding = 0; encoding < 3; encoding++)
        for (int wide = 0; wide < 2; wide++) {
            enum { POINTS = 700 };
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud, *back;
            void *data;
            const double origin[3] = {431000.25, 5812000.5, -17};
            assert_int_equal(ewa_cloud_create(context, POINTS, &cloud), EWA_OK);
            assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, wide ? EWA_F64 : EWA_F32, 3, &data), EWA_OK);
            for (int i = 0; i < 3 * POINTS; i++) {
                if (wide)
                    ((double *)data)[i] = i / 3.0;
                else
                    ((float *)data)[i] = (float)i / 3;
            }
            ewa_cloud_set_origin(cloud, origin);
            assert_int_equal(save_as(cloud, path, encoding), EWA_OK);
            assert_int_equal(ewa_cloud_load(context, path, &back), EWA_OK);
            for (int i = 0; i < 3 * POINTS; i++)
                assert_true(sample_value(back, EWA_POSITION, EWA_F64, 3, (uint64_t)i / 3, (uint32_t)i % 3) ==
                            (wide ? i / 3.0 : (double)((float)i / 3)) + origin[i % 3]);
        }
}

TEST_WITHIN(test_threads_change_no_byte, set_up, tear_down) {
    for (int encoding = 0; encoding < 3; encoding++) {
        char first_path[128];
        ewa_file first;
        for (uint32_t threads = 1; threads <= 7; threads += 3) {
            char path[128], name[32];
            snprintf(name, sizeof name, "threads%u.ply", threads);
            inside(name, path);
            ewa_context *own = check_context(threads, &messages);
            ewa_cloud *cloud = make_everything(own, 9000, EWA_F32, EWA_U8);
            assert_int_equal(save_as(cloud, path, encoding), EWA_OK);
            ewa_cloud_destroy(&cloud);
            ewa_context_destroy(&own);
            if (threads == 1) {
                memcpy(first_path, path, sizeof path);
                assert_int_equal(ewa_file_map(context, path, &first), EWA_OK);
                continue;
            }
            ewa_file file;
            assert_int_equal(ewa_file_map(context, path, &file), EWA_OK);
            assert_int_equal(file.size_bytes, first.size_bytes);
            assert_memory_equal(file.bytes, first.bytes, first.size_bytes);
            ewa_file_unmap(context, &file);
        }
        ewa_file_unmap(context, &first);
    }
}

TEST_WITHIN(test_many_points, set_up, tear_down) {
    enum { POINTS = 300000 }; // more bytes than one wave of parallel tasks takes
    char path[128];
    ewa_cloud *cloud, *back;
    void *position, *color;
    check_random random = {3};
    assert_int_equal(ewa_cloud_create(context, POINTS, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, &position), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_COLOR, EWA_U16, 3, &color), EWA_OK);
    fill_bits(&random, position, POINTS * 3 * sizeof(double));
    fill_bits(&random, color, POINTS * 3 * sizeof(uint16_t));
    for (int encoding = 0; encoding < 2; encoding++) {
        assert_int_equal(save_as(cloud, inside("many.ply", path), encoding), EWA_OK);
        assert_int_equal(ewa_cloud_load(context, path, &back), EWA_OK);
        assert_memory_equal(ewa_cloud_find(back, EWA_POSITION)->data, position, POINTS * 3 * sizeof(double));
        assert_memory_equal(ewa_cloud_find(back, EWA_COLOR)->data, color, POINTS * 3 * sizeof(uint16_t));
        ewa_cloud_destroy(&back);
    }
    ewa_cloud_destroy(&cloud);
}

TEST_WITHIN(test_outputs_that_fail_leave_nothing, set_up, tear_down) {
    char path[128];
    ewa_cloud *cloud = make_everything(context, 100, EWA_F32, EWA_U8);
    assert_int_equal(save_as(cloud, inside("cloud.obj", path), 0), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(messages.text, "cloud.obj: point clouds are written as .ply"));
    assert_int_equal(save_as(cloud, inside("none/cloud.ply", path), 0), EWA_ERROR_IO);
    assert_int_equal(save_as(cloud, folder, 0), EWA_ERROR_UNSUPPORTED);
    assert_int_equal(save_as(cloud, inside("cloud.ply", path), 3), EWA_ERROR_ARGUMENT);
    if (access("/dev/full", W_OK) == 0) {
        assert_int_equal(save_as(cloud, "/dev/full", 0), EWA_ERROR_IO);
        assert_string_equal(messages.text, "/dev/full: No space left on device");
    }
    // Two attributes under one name, no position, too many properties.
    assert_int_equal(ewa_cloud_add(cloud, "red", EWA_U8, 1, NULL), EWA_OK);
    assert_int_equal(save_as(cloud, path, 0), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(messages.text, "two attributes would become property 'red'"));
    ewa_cloud_remove(cloud, "red");
    ewa_cloud_remove(cloud, EWA_POSITION);
    assert_int_equal(save_as(cloud, path, 0), EWA_ERROR_ARGUMENT);
    ewa_cloud_destroy(&cloud);
    assert_int_equal(ewa_cloud_create(context, 1, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, NULL), EWA_OK);
    for (int i = 0; i < 250; i++) {
        char name[16];
        snprintf(name, sizeof name, "a%d", i);
        assert_int_equal(ewa_cloud_add(cloud, name, EWA_U8, 4, NULL), EWA_OK);
    }
    assert_int_equal(save_as(cloud, path, 0), EWA_ERROR_LIMIT);
    ewa_cloud_destroy(&cloud);
    assert_int_equal(count_files(false), 0);
}

static bool stop_writing(void *user, const char *stage, double fraction) {
    (void)user;
    (void)fraction;
    return strcmp(stage, "write") != 0;
}

TEST_WITHIN(test_cancelled_output_keeps_the_old_file, set_up, tear_down) {
    char path[128];
    ewa_cloud *cloud = make_everything(context, 10, EWA_F32, EWA_U8), *back;
    assert_int_equal(save_as(cloud, inside("cloud.ply", path), 0), EWA_OK);
    WITH_DEFAULTS(ewa_context_options, options);
    options.progress = stop_writing;
    ewa_context *own = NULL;
    assert_int_equal(ewa_context_create(&options, &own), EWA_OK);
    ewa_cloud *other = make_everything(own, 500, EWA_F32, EWA_U8);
    assert_int_equal(save_as(other, path, 0), EWA_CANCELLED);
    assert_int_equal(ewa_cloud_load(context, path, &back), EWA_OK);
    assert_same_cloud(cloud, back);
    ewa_cloud_destroy(&back);
    ewa_cloud_destroy(&other);
    ewa_cloud_destroy(&cloud);
    ewa_context_destroy(&own);
    assert_int_equal(count_files(false), 1);
}

static void collect_line(void *user, const char *line) {
    char *text = user;
    strcat(strcat(text, line), "|");
}

TEST_WITHIN(test_description, set_up, tear_down) {
    char path[128], text[1024] = "";
    FILE *file = fopen(inside("described.ply", path), "wb");
    fputs("ply\r\nformat ascii 1.0\r\ncomment by\thand \xff\r\nelement vertex 0\r\nproperty float "
          "x\r\n\r\nproperty float y\r\n"
          "property float z\r\nelement face 12\r\nproperty list uchar int vertex_indices\r\nend_header\r\n",
          file);
    fclose(file);
    assert_int_equal(ewa_ply_describe(context, path, collect_line, text), EWA_OK);
    assert_string_equal(
        text, "format ascii 1.0|comment by hand ?|element vertex 0|property float x||property float y|"
              "property float z|element face 12|property list uchar int vertex_indices|");
    assert_int_equal(ewa_ply_describe(context, "/no/such.ply", collect_line, text), EWA_ERROR_IO);
    file = fopen(path, "wb");
    fputs("ply\nformat ascii 1.0\n", file);
    fclose(file);
    assert_int_equal(ewa_ply_describe(context, path, collect_line, text), EWA_ERROR_FORMAT);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
