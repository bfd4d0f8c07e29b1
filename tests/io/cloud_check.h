// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the tests of clouds' formats share: files in memory, numbers of points, reading in pieces, files that
// are cut or changed.
#ifndef EWA_TESTS_CLOUD_CHECK_H
#define EWA_TESTS_CLOUD_CHECK_H

#include "check.h"
#include "io/scratch.h"

#include <string.h>

/// A file that grows.
typedef struct cloud_bytes {
    uint8_t *bytes;
    size_t size, capacity;
} cloud_bytes;

static inline void cloud_put(cloud_bytes *file, const void *bytes, size_t size) {
    if (file->size + size > file->capacity) {
        file->capacity = 2 * (file->size + size);
        file->bytes = realloc(file->bytes, file->capacity);
        assert_non_null(file->bytes);
    }
    if (size) memcpy(file->bytes + file->size, bytes, size);
    file->size += size;
}

/// Holds a point's numbers to what they must be, with type and number of components.
static inline void cloud_expect(const ewa_cloud *cloud, const char *name, ewa_type type,
                                uint32_t component_count, uint64_t point, const double *expected) {
    const ewa_attribute *attribute = ewa_cloud_find(cloud, name);
    double values[4];
    if (!attribute) fail_msg("no attribute '%s'", name);
    if (attribute->type != type || attribute->component_count != component_count)
        fail_msg("'%s' is %s x %u", name, ewa_type_name(attribute->type), attribute->component_count);
    ewa_attribute_read_f64(attribute, point, 1, values);
    for (uint32_t c = 0; c < component_count; c++)
        if (values[c] != expected[c] && (values[c] == values[c] || expected[c] == expected[c]))
            fail_msg("'%s' of point %llu, number %u: %.17g instead of %.17g", name, (unsigned long long)point,
                     c, values[c], expected[c]);
}

/// Holds a point's place in the world to the decimals of a file, whatever origin the cloud got.
static inline void cloud_expect_world(const ewa_cloud *cloud, uint64_t point, const double expected[3]) {
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    double origin_world[3], place[3];
    ewa_coordinate_grid grid;
    ewa_cloud_origin(cloud, origin_world);
    ewa_cloud_grid(cloud, &grid);
    assert_int_equal(position->type, EWA_F64);
    ewa_attribute_read_f64(position, point, 1, place);
    for (uint32_t c = 0; c < 3; c++) {
        const double world = ewa_grid_world(&grid, c, origin_world[c] + place[c]);
        if (world != expected[c]) fail_msg("axis %u: %.17g instead of %.17g", c, world, expected[c]);
    }
}

/// Reads a file in pieces of sizes that fit nothing, with one thread and with several: the same points.
static inline void cloud_check_pieces(const cloud_bytes *file, const char *name, const ewa_cloud *whole) {
    static const struct {
        uint32_t threads;
        uint64_t maximum;
    } ways[] = {{1, 777}, {4, 5003}, {2, 1 << 20}};
    char path[512];
    scratch_write(scratch_path(name, path), file->bytes, file->size);
    for (size_t w = 0; w < sizeof ways / sizeof ways[0]; w++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(ways[w].threads, NULL);
        OWNED(ewa_cloud_reader_close) ewa_cloud_reader *reader = NULL;
        ewa_cloud *piece = NULL;
        uint64_t first = 0;
        assert_int_equal(ewa_cloud_reader_open(context, path, NULL, &reader), EWA_OK);
        while (ewa_cloud_reader_next(reader, ways[w].maximum, &piece) == EWA_OK && piece) {
            const uint64_t count = ewa_cloud_point_count(piece);
            assert_true(count <= ways[w].maximum && first + count <= ewa_cloud_point_count(whole));
            assert_int_equal(ewa_cloud_attribute_count(piece), ewa_cloud_attribute_count(whole));
            for (uint32_t i = 0; i < ewa_cloud_attribute_count(whole); i++) {
                const ewa_attribute *a = ewa_cloud_attribute_at(whole, i);
                const ewa_attribute *b = ewa_cloud_attribute_at(piece, i);
                assert_memory_equal((const uint8_t *)a->data + first * a->stride_bytes, b->data,
                                    count * b->stride_bytes);
            }
            first += count;
            ewa_cloud_destroy(&piece);
        }
        assert_int_equal(first, ewa_cloud_point_count(whole));
    }
    unlink(path);
}

/// Reads what can be read of a file; `*lost_count` gets how many points it says are lost.
static inline ewa_cloud *cloud_keep_going(ewa_context *context, const cloud_bytes *file, const char *name,
                                          uint64_t *lost_count) {
    char path[512];
    scratch_write(scratch_path(name, path), file->bytes, file->size);
    WITH_DEFAULTS(ewa_cloud_load_options, options);
    options.keep_going = true;
    ewa_cloud_reader *reader = NULL;
    ewa_cloud *cloud = NULL;
    *lost_count = 0;
    if (ewa_cloud_reader_open(context, path, &options, &reader) == EWA_OK) {
        assert_int_equal(ewa_cloud_reader_next(reader, UINT32_MAX, &cloud), EWA_OK);
        *lost_count = ewa_cloud_reader_lost_count(reader);
    }
    ewa_cloud_reader_close(&reader);
    unlink(path);
    return cloud;
}

/// Every beginning of a file, but for those that lack at most `spare` bytes, is refused with a message that
/// names it, from memory that ends with the file; with keep_going it is read without harm.
static inline void cloud_check_truncations(const cloud_bytes *file, const char *name, size_t spare) {
    check_log log;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    for (size_t size = 0; size < file->size; size++) {
        OWNED(check_free) uint8_t *bytes = malloc(size + !size);
        memcpy(bytes, file->bytes, size);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
        log = (check_log){0};
        const ewa_status status = ewa_cloud_load_memory(context, bytes, size, name, &cloud);
        if (status == EWA_OK && size + spare < file->size) fail_msg("%zu bytes of %s are taken", size, name);
        if (status != EWA_OK && strncmp(log.text, name, strlen(name)) != 0)
            fail_msg("%zu bytes: '%s'", size, log.text);
        ewa_cloud_destroy(&cloud);
        uint64_t lost_count;
        const cloud_bytes cut = {bytes, size, size};
        cloud = cloud_keep_going(context, &cut, name, &lost_count);
    }
}

/// Loads a file `count` times with some bytes changed: it is read or refused with a message.
static inline void cloud_check_changes(const cloud_bytes *file, const char *name, int count) {
    check_log log;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    check_random random = {77};
    for (int i = 0; i < count; i++) {
        OWNED(check_free) uint8_t *bytes = malloc(file->size);
        memcpy(bytes, file->bytes, file->size);
        for (uint64_t k = 1 + check_random_u64(&random) % 3; k > 0; k--)
            bytes[check_random_u64(&random) % file->size] = (uint8_t)check_random_u64(&random);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
        log = (check_log){0};
        const ewa_status status = ewa_cloud_load_memory(context, bytes, file->size, name, &cloud);
        assert_true(status == EWA_OK || log.count > 0);
    }
}

#endif
