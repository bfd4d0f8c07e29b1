// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of clouds in pieces: pieces of any size put together are the whole, in and out, of every format that is
// written; grid and notes travel with a cloud; what a file promises of counts is held.
#include "ewa/ewa.h"
#include "io/cloud/format.h"
#include "io/scratch.h"

#include <math.h>

#include "io/fixture.h"

enum { POINTS = 5003 };

/// A cloud with a grid of millimetres at a place of seven digits, colours, and two attributes of scans.
static ewa_cloud *make_scan(void) {
    void *position, *color, *class, *time;
    ewa_cloud *cloud = check_cloud_of(context, POINTS);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, &position), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, &color), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, "classification", EWA_U8, 1, &class), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, "gps_time", EWA_F64, 1, &time), EWA_OK);
    for (uint64_t i = 0; i < POINTS; i++) {
        for (uint64_t c = 0; c < 3; c++) {
            ((double *)position)[3 * i + c] = (double)((i * (7 + 4 * c) + 31 * c) % 9973) / 1000;
            ((uint8_t *)color)[3 * i + c] = (uint8_t)(i * (c + 1));
        }
        ((uint8_t *)class)[i] = (uint8_t)(i % 7);
        ((double *)time)[i] = 3.0e8 + (double)i / 64;
    }
    ewa_cloud_set_origin(cloud, (const double[3]){512345, 4200000, 100});
    ewa_cloud_set_grid(cloud, &(ewa_coordinate_grid){{0.001, 0.001, 0.001}, {500000, 4200000, 0}});
    assert_int_equal(ewa_cloud_set_note(cloud, "crs", "EPSG:32632", 10), EWA_OK);
    return cloud;
}

static ewa_cloud *load(const char *path) {
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_load(context, path, &cloud), EWA_OK);
    return cloud;
}

/// World coordinates as their decimals say them.
static void world_of(const ewa_cloud *cloud, uint64_t point, double world[3]) {
    ewa_coordinate_grid grid;
    double origin_world[3];
    ewa_cloud_grid(cloud, &grid);
    ewa_cloud_origin(cloud, origin_world);
    ewa_attribute_read_f64(ewa_cloud_find(cloud, EWA_POSITION), point, 1, world);
    for (uint32_t c = 0; c < 3; c++) world[c] = ewa_grid_world(&grid, c, world[c] + origin_world[c]);
}

/// Every format that is written, and the pieces of prime sizes that it is read and written in.
CASE(test_pieces) {
    static const char *const suffixes[] = {".ply", ".las", ".laz", ".pcd", ".csv"};
    static const uint64_t sizes[] = {1, 7, 997, 5003, 100000};
    OWNED(ewa_cloud_destroy) ewa_cloud *scan = make_scan();
    for (size_t s = 0; s < sizeof suffixes / sizeof suffixes[0]; s++) {
        char name[64], whole_path[512], path[512];
        snprintf(name, sizeof name, "scan%s", suffixes[s]);
        scratch_path(name, whole_path);
        assert_int_equal(ewa_cloud_save(scan, whole_path, NULL), EWA_OK);
        OWNED(ewa_cloud_destroy) ewa_cloud *whole = load(whole_path);
        size_t whole_bytes;
        OWNED(check_free) uint8_t *whole_file = scratch_read(whole_path, &whole_bytes);
        for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
            if (sizes[k] == 1 && strcmp(suffixes[s], ".ply") != 0) continue;
            ewa_cloud_reader *reader = NULL;
            ewa_cloud_writer *writer = NULL;
            ewa_cloud *piece = NULL;
            assert_int_equal(ewa_cloud_reader_open(context, whole_path, NULL, &reader), EWA_OK);
            snprintf(name, sizeof name, "pieces%s", suffixes[s]);
            assert_int_equal(ewa_cloud_writer_open(context, scratch_path(name, path), NULL,
                                                   ewa_cloud_reader_prototype(reader), POINTS, NULL, &writer),
                             EWA_OK);
            uint64_t count = 0;
            while (ewa_cloud_reader_next(reader, sizes[k], &piece) == EWA_OK && piece) {
                assert_true(ewa_cloud_point_count(piece) <= sizes[k]);
                count += ewa_cloud_point_count(piece);
                assert_int_equal(ewa_cloud_writer_put(writer, piece), EWA_OK);
                ewa_cloud_destroy(&piece);
            }
            assert_int_equal(count, POINTS);
            assert_int_equal(ewa_cloud_writer_commit(&writer), EWA_OK);
            ewa_cloud_reader_close(&reader);
            size_t bytes;
            OWNED(check_free) uint8_t *file = scratch_read(path, &bytes);
            assert_int_equal(bytes, whole_bytes);
            assert_memory_equal(file, whole_file, bytes);
        }
        for (uint64_t i = 0; i < POINTS; i += 13) {
            double wanted[3], got[3];
            world_of(scan, i, wanted);
            world_of(whole, i, got);
            assert_memory_equal(wanted, got, sizeof wanted);
        }
    }
}

/// What is held at most.
typedef struct held_memory {
    size_t held_bytes, max_bytes;
} held_memory;

static void *hold(void *user, size_t size_bytes) {
    held_memory *memory = user;
    memory->held_bytes += size_bytes;
    if (memory->held_bytes > memory->max_bytes) memory->max_bytes = memory->held_bytes;
    return check_aligned(size_bytes);
}

static void let_go(void *user, void *block, size_t size_bytes) {
    if (block) ((held_memory *)user)->held_bytes -= size_bytes;
    check_aligned_release(block);
}

/// A file that is passed through needs memory for a piece, not for its points.
CASE(test_memory) {
    enum { MANY = 400000, PIECE = 4096, MAX_BYTES = 3 << 20 };
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, MANY);
    float *position = check_add(cloud, EWA_POSITION, EWA_F32, 3);
    for (int i = 0; i < 3 * MANY; i++) position[i] = (float)(i % 1013) / 8;
    static const char *const suffixes[] = {".ply", ".las", ".pcd", ".xyz"};
    enum { SUFFIXES = sizeof suffixes / sizeof suffixes[0] };
    for (int from = 0; from < SUFFIXES; from++)
        for (int to = 0; to < SUFFIXES; to++) {
            char name[64], from_path[512], to_path[512];
            snprintf(name, sizeof name, "many%s", suffixes[from]);
            scratch_path(name, from_path);
            snprintf(name, sizeof name, "passed%s", suffixes[to]);
            scratch_path(name, to_path);
            if (to == 0) assert_int_equal(ewa_cloud_save(cloud, from_path, NULL), EWA_OK);
            held_memory memory = {0};
            WITH_DEFAULTS(ewa_context_options, options);
            options.allocator = (ewa_allocator){&memory, hold, let_go};
            options.thread_count = 2;
            ewa_context *own = NULL;
            ewa_cloud_reader *reader = NULL;
            ewa_cloud_writer *writer = NULL;
            ewa_cloud *piece = NULL;
            const ewa_bounds bounds = {{0, 0, 0}, {127, 127, 127}, MANY};
            assert_int_equal(ewa_context_create(&options, &own), EWA_OK);
            assert_int_equal(ewa_cloud_reader_open(own, from_path, NULL, &reader), EWA_OK);
            assert_int_equal(ewa_cloud_writer_open(own, to_path, NULL, ewa_cloud_reader_prototype(reader),
                                                   EWA_POINTS_UNKNOWN, &bounds, &writer),
                             EWA_OK);
            uint64_t count = 0;
            while (ewa_cloud_reader_next(reader, PIECE, &piece) == EWA_OK && piece) {
                count += ewa_cloud_point_count(piece);
                assert_int_equal(ewa_cloud_writer_put(writer, piece), EWA_OK);
                ewa_cloud_destroy(&piece);
            }
            assert_int_equal(count, MANY);
            assert_int_equal(ewa_cloud_writer_commit(&writer), EWA_OK);
            ewa_cloud_reader_close(&reader);
            ewa_context_destroy(&own);
            assert_int_equal(memory.held_bytes, 0);
            if (memory.max_bytes > MAX_BYTES)
                fail_msg("%s to %s: %zu bytes", suffixes[from], suffixes[to], memory.max_bytes);
        }
}

/// Only what is wanted is read, and positions always.
CASE(test_wanted) {
    char path[512];
    ewa_cloud *scan = make_scan(), *piece = NULL;
    assert_int_equal(ewa_cloud_save(scan, scratch_path("wanted.ply", path), NULL), EWA_OK);
    WITH_DEFAULTS(ewa_cloud_load_options, options);
    options.attributes = "gps_time,no such";
    ewa_cloud_reader *reader = NULL;
    assert_int_equal(ewa_cloud_reader_open(context, path, &options, &reader), EWA_OK);
    assert_int_equal(ewa_cloud_attribute_count(ewa_cloud_reader_prototype(reader)), 2);
    assert_int_equal(ewa_cloud_reader_next(reader, POINTS, &piece), EWA_OK);
    assert_non_null(ewa_cloud_find(piece, EWA_POSITION));
    assert_memory_equal(ewa_cloud_find(piece, "gps_time")->data, ewa_cloud_find(scan, "gps_time")->data,
                        POINTS * sizeof(double));
    assert_null(ewa_cloud_find(piece, EWA_COLOR));
    ewa_cloud_destroy(&piece);
    assert_int_equal(ewa_cloud_reader_next(reader, POINTS, &piece), EWA_OK);
    assert_null(piece);
    ewa_cloud_reader_close(&reader);
    ewa_cloud_destroy(&scan);
}

/// A writer that was promised other points than it gets says so, and leaves nothing behind.
CASE(test_promises) {
    char path[512];
    OWNED(ewa_cloud_destroy) ewa_cloud *scan = make_scan();
    scratch_path("promised.ply", path);
    unlink(path);
    ewa_cloud_writer *writer = NULL;
    assert_int_equal(ewa_cloud_writer_open(context, path, NULL, scan, POINTS + 1, NULL, &writer), EWA_OK);
    assert_int_equal(ewa_cloud_writer_put(writer, scan), EWA_OK);
    assert_int_equal(ewa_cloud_writer_commit(&writer), EWA_ERROR_ARGUMENT);
    assert_null(writer);
    assert_int_not_equal(access(path, F_OK), 0);
    assert_int_equal(ewa_cloud_writer_open(context, path, NULL, scan, POINTS - 1, NULL, &writer), EWA_OK);
    assert_int_equal(ewa_cloud_writer_put(writer, scan), EWA_ERROR_ARGUMENT);
    ewa_cloud_remove(scan, "gps_time");
    assert_int_equal(ewa_cloud_writer_put(writer, scan), EWA_ERROR_ARGUMENT);
    ewa_cloud_writer_abort(&writer);
    assert_int_not_equal(access(path, F_OK), 0);
}

/// A number of points that is only known at the end is put where it belongs.
CASE(test_unknown_count) {
    char path[512];
    OWNED(ewa_cloud_destroy) ewa_cloud *scan = make_scan();
    ewa_cloud_writer *writer = NULL;
    assert_int_equal(ewa_cloud_writer_open(context, scratch_path("unknown.ply", path), NULL, scan,
                                           EWA_POINTS_UNKNOWN, NULL, &writer),
                     EWA_OK);
    for (int i = 0; i < 3; i++) assert_int_equal(ewa_cloud_writer_put(writer, scan), EWA_OK);
    assert_int_equal(ewa_cloud_writer_commit(&writer), EWA_OK);
    OWNED(ewa_cloud_destroy) ewa_cloud *back = load(path);
    assert_int_equal(ewa_cloud_point_count(back), 3 * POINTS);
}

/// Decimals are those that were there, also where the sum of two doubles is another double.
CASE(test_grid) {
    const ewa_coordinate_grid grid = {{0.01, 0.001, 0.25}, {600000, 0, 0.125}};
    assert_true(ewa_grid_world(&grid, 0, 600000 + 35619.85) == 635619.85);
    uint32_t inexact = 0;
    for (int i = 0; i < 100000; i++) {
        const double wanted = (4200000000.0 + i) / 1000, sum = (4200000000.0 + i) * 0.001;
        assert_true(ewa_grid_world(&grid, 1, sum) == wanted);
        inexact += sum != wanted;
    }
    assert_true(inexact > 1000); // without the grid, other digits would come out
    assert_true(ewa_grid_world(&grid, 2, 3.4) == 3.375);
    assert_true(isnan(ewa_grid_world(&grid, 0, NAN)));
    assert_true(ewa_grid_world(&grid, 0, INFINITY) == INFINITY);
    assert_true(ewa_grid_world(&grid, 0, 1e30) == 1e30);
    assert_true(ewa_grid_world(&(ewa_coordinate_grid){{0}, {0}}, 0, 0.1 + 0.2) == 0.1 + 0.2);
}

/// The suffix chooses, wherever a file lies; streams and devices have none.
TEST(test_places) {
    static const struct {
        const char *path, *suffixes;
    } cases[] = {{"-", ".ply"},
                 {"/dev/stdout", ".ply"},
                 {"/dev/fd/3", ".ply"},
                 {"/dev/shm/a.laz", ".las|.laz"},
                 {"/dev/shm/a.PCD", ".pcd"},
                 {"/dev/shm/a.b/c.xyz", ".xyz|.txt|.csv|.asc|.pts"},
                 {"/dev/shm/a.abc", NULL},
                 {"a", NULL}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const ewa_cloud_write_format *format = ewa_cloud_write_format_of(cases[i].path);
        if (cases[i].suffixes)
            assert_string_equal(format->suffixes, cases[i].suffixes);
        else
            assert_null(format);
    }
}

/// Notes are copies, are replaced, removed, and handed on.
CASE(test_notes) {
    OWNED(ewa_cloud_destroy) ewa_cloud *scan = make_scan(), *some = NULL, *both = NULL;
    size_t size_bytes;
    assert_int_equal(ewa_cloud_set_note(scan, "file.what", "a\0b", 3), EWA_OK);
    assert_memory_equal(ewa_cloud_note(scan, "file.what", &size_bytes), "a\0b", 4);
    assert_int_equal(size_bytes, 3);
    assert_int_equal(ewa_cloud_set_note(scan, "crs", "EPSG:4978", 9), EWA_OK);
    assert_string_equal(ewa_cloud_note_name(scan, 0), "crs");
    const uint64_t indices[2] = {5, 3};
    assert_int_equal(ewa_cloud_select(scan, indices, 2, &some), EWA_OK);
    assert_string_equal(ewa_cloud_note(some, "crs", NULL), "EPSG:4978");
    ewa_coordinate_grid grid;
    ewa_cloud_grid(some, &grid);
    assert_true(grid.step_world[1] == 0.001);
    assert_int_equal(ewa_cloud_merge((const ewa_cloud *const[]){scan, some}, 2, &both), EWA_OK);
    ewa_cloud_grid(both, &grid);
    assert_true(grid.step_world[1] == 0.001 && ewa_cloud_note(both, "file.what", NULL));
    // A cloud that is moved as a whole stays on its grid; one that is turned does not.
    double shift[16] = {1, 0, 0, 7, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    assert_int_equal(ewa_cloud_transform(both, shift), EWA_OK);
    ewa_cloud_grid(both, &grid);
    assert_true(grid.step_world[0] == 0.001 && grid.offset_world[0] == 500007);
    shift[0] = 2;
    assert_int_equal(ewa_cloud_transform(both, shift), EWA_OK);
    ewa_cloud_grid(both, &grid);
    assert_true(grid.step_world[0] == 0);
    assert_int_equal(ewa_cloud_set_note(scan, "crs", NULL, 0), EWA_OK);
    assert_null(ewa_cloud_note(scan, "crs", NULL));
    assert_null(ewa_cloud_note_name(scan, 1));
    assert_int_equal(ewa_cloud_set_note(scan, "", "x", 1), EWA_ERROR_ARGUMENT);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
