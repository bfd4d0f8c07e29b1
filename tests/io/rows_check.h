// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the tests of clouds of text share: clouds from text in memory, messages, single numbers.
#ifndef EWA_TESTS_ROWS_CHECK_H
#define EWA_TESTS_ROWS_CHECK_H

#include "ewa/ewa.h"
#include "io/scratch.h"

#include <math.h>

static ewa_context *context;
static check_log messages;

static inline int set_up(void **state) {
    memset(&messages, 0, sizeof messages);
    context = check_context(2, &messages);
    return 0;
}

static inline int tear_down(void **state) {
    ewa_context_destroy(&context);
    return 0;
}

/// Loads text that must be right, without a word.
static inline ewa_cloud *rows_load(const char *text) {
    ewa_cloud *cloud = NULL;
    messages.count = 0;
    if (ewa_cloud_load_memory(context, text, strlen(text), "t", &cloud) != EWA_OK)
        fail_msg("%s\nof:\n%.200s", messages.text, text);
    if (messages.count) fail_msg("%s\nof:\n%.200s", messages.text, text);
    return cloud;
}

/// Loads text that must be refused with a message that holds `said`.
static inline void rows_refuse(const char *text, const char *said) {
    ewa_cloud *cloud = NULL;
    messages.count = 0;
    if (ewa_cloud_load_memory(context, text, strlen(text), "t", &cloud) == EWA_OK)
        fail_msg("read:\n%.200s", text);
    assert_null(cloud);
    assert_int_equal(messages.count, 1);
    if (!strstr(messages.text, said)) fail_msg("%s\nlacks: %s", messages.text, said);
}

/// Opens text from a file with options, reads all; `*lost_count` may be NULL.
static inline ewa_status rows_read(const char *text, const ewa_cloud_load_options *options, ewa_cloud **cloud,
                                   uint64_t *lost_count) {
    char path[512];
    FILE *file = fopen(scratch_path("rows.txt", path), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, strlen(text), file), strlen(text));
    fclose(file);
    ewa_cloud_reader *reader = NULL;
    *cloud = NULL;
    ewa_status status = ewa_cloud_reader_open(context, path, options, &reader);
    if (status == EWA_OK) status = ewa_cloud_reader_next(reader, 1000000, cloud);
    if (status == EWA_OK && lost_count) *lost_count = ewa_cloud_reader_lost_count(reader);
    ewa_cloud_reader_close(&reader);
    return status;
}

/// The attribute of that name, which must have that type and so many components.
static inline const ewa_attribute *rows_find(const ewa_cloud *cloud, const char *name, ewa_type type,
                                             uint32_t component_count) {
    const ewa_attribute *found = ewa_cloud_find(cloud, name);
    if (!found) fail_msg("no attribute %s", name);
    if (found->type != type || found->component_count != component_count)
        fail_msg("%s: %s x %u", name, ewa_type_name(found->type), found->component_count);
    return found;
}

static inline double rows_number(const ewa_cloud *cloud, const char *name, uint64_t point,
                                 uint32_t component) {
    const ewa_attribute *found = ewa_cloud_find(cloud, name);
    if (!found) fail_msg("no attribute %s", name);
    double values[4];
    ewa_attribute_read_f64(found, point, 1, values);
    return values[component];
}

/// The names of all attributes, with commas between.
static inline void rows_expect(const ewa_cloud *cloud, uint64_t point_count, const char *names) {
    char text[512] = "";
    const ewa_attribute *attribute;
    for (uint32_t i = 0; (attribute = ewa_cloud_attribute_at(cloud, i)); i++) {
        if (i) strcat(text, ",");
        strcat(text, attribute->name);
    }
    assert_string_equal(text, names);
    assert_int_equal(ewa_cloud_point_count(cloud), point_count);
}

/// The world coordinates of a point.
static inline void rows_expect_world(const ewa_cloud *cloud, uint64_t point, double x, double y, double z) {
    double origin_world[3];
    const double expected[3] = {x, y, z};
    ewa_cloud_origin(cloud, origin_world);
    for (uint32_t c = 0; c < 3; c++) {
        const double world = origin_world[c] + rows_number(cloud, EWA_POSITION, point, c);
        if (world != expected[c]) fail_msg("point %d, %c: %.17g", (int)point, "xyz"[c], world);
    }
}

/// Whether two clouds have the same attributes and bytes.
static inline void rows_expect_same(const ewa_cloud *a, const ewa_cloud *b) {
    assert_int_equal(ewa_cloud_point_count(a), ewa_cloud_point_count(b));
    assert_int_equal(ewa_cloud_attribute_count(a), ewa_cloud_attribute_count(b));
    for (uint32_t i = 0; i < ewa_cloud_attribute_count(a); i++) {
        const ewa_attribute *left = ewa_cloud_attribute_at(a, i), *right = ewa_cloud_attribute_at(b, i);
        assert_string_equal(left->name, right->name);
        assert_int_equal(left->type, right->type);
        assert_memory_equal(left->data, right->data, ewa_cloud_point_count(a) * left->stride_bytes);
    }
}

#endif
