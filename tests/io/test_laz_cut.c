// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// LAZ files that end too early, read with keep_going: the points up to the cut as they are in the whole file. Of the
// last chunk of layered ones, those whose positions are there; other fields up to a point, from there on 0.
#include "io/copc_sample.h"
#include "io/scratch.h"

#include <math.h>

enum { POINTS = 4000, CHUNK_POINTS = 700, STEP = 61 };

typedef enum cut_kind { FLAT, LAYERED, LAYERED_COLOR, LAYERED_INFRARED, KIND_COUNT } cut_kind;

static const char *const FIELDS[] = {"classification", "intensity", "user_data", "point_source_id",
                                     "scan_angle",     "gps_time",  EWA_COLOR,   "nir",
                                     "extra"};
enum { FIELD_COUNT = sizeof FIELDS / sizeof FIELDS[0] };

static uint16_t *add_u16(ewa_cloud *cloud, const char *name, uint32_t component_count) {
    void *data = NULL;
    assert_int_equal(ewa_cloud_add(cloud, name, EWA_U16, component_count, &data), EWA_OK);
    return data;
}

/// Points whose fields are never 0, so that what is lost can be told.
static ewa_cloud *make_cloud(ewa_context *context, cut_kind kind) {
    void *data = NULL;
    ewa_cloud *cloud = check_cloud_of(context, POINTS);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, &data), EWA_OK);
    double *places = data;
    for (int i = 0; i < POINTS; i++) {
        places[3 * i] = floor(1e4 * sin(i / 50.0)) / 100;
        places[3 * i + 1] = floor(1e4 * cos(i / 77.0)) / 100;
        places[3 * i + 2] = floor(1e3 * sin(i / 9.0)) / 100;
    }
    assert_int_equal(ewa_cloud_add(cloud, "classification", EWA_U8, 1, &data), EWA_OK);
    for (int i = 0; i < POINTS; i++) ((uint8_t *)data)[i] = (uint8_t)(kind > FLAT && i % 9 == 0 ? 77 : 1 + i % 4);
    if (kind == FLAT) return cloud;
    uint16_t *intensity = add_u16(cloud, "intensity", 1), *source = add_u16(cloud, "point_source_id", 1),
             *extra = add_u16(cloud, "extra", 1);
    for (int i = 0; i < POINTS; i++) {
        intensity[i] = (uint16_t)(1 + i % 1000);
        source[i] = (uint16_t)(1 + i / 100);
        extra[i] = (uint16_t)(0x0101 * (1 + i % 200));
    }
    assert_int_equal(ewa_cloud_add(cloud, "user_data", EWA_U8, 1, &data), EWA_OK);
    for (int i = 0; i < POINTS; i++) ((uint8_t *)data)[i] = (uint8_t)(1 + i / 7 % 200);
    assert_int_equal(ewa_cloud_add(cloud, "scan_angle", EWA_F32, 1, &data), EWA_OK);
    for (int i = 0; i < POINTS; i++) ((float *)data)[i] = 0.006f * (float)(1 + i / 3 % 300);
    assert_int_equal(ewa_cloud_add(cloud, "gps_time", EWA_F64, 1, &data), EWA_OK);
    for (int i = 0; i < POINTS; i++) ((double *)data)[i] = 1e5 + i * 1e-5 + i / 50;
    if (kind >= LAYERED_COLOR) {
        uint16_t *color = add_u16(cloud, EWA_COLOR, 3);
        for (int i = 0; i < 3 * POINTS; i++) color[i] = (uint16_t)(257 * (1 + i % 250) + 1);
    }
    if (kind == LAYERED_INFRARED) {
        uint16_t *infrared = add_u16(cloud, "nir", 1);
        for (int i = 0; i < POINTS; i++) infrared[i] = (uint16_t)(7 + i);
    }
    return cloud;
}

/// Loads a file's first bytes; NULL when nothing of it can be read.
static ewa_cloud *load_cut(ewa_context *context, const uint8_t *bytes, size_t length, const char *path,
                           uint64_t *lost_count) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, length, file), length);
    fclose(file);
    WITH_DEFAULTS(ewa_cloud_load_options, options);
    options.keep_going = true;
    ewa_cloud_reader *reader = NULL;
    ewa_cloud *cloud = NULL;
    *lost_count = 0;
    ewa_status status = ewa_cloud_reader_open(context, path, &options, &reader);
    if (status == EWA_OK) status = ewa_cloud_reader_next(reader, 2 * POINTS, &cloud);
    if (status == EWA_OK) *lost_count = ewa_cloud_reader_lost_count(reader);
    ewa_cloud_reader_close(&reader);
    if (status != EWA_OK) ewa_cloud_destroy(&cloud);
    return cloud;
}

static void read_numbers(const ewa_cloud *cloud, const char *name, uint64_t count, double *to) {
    ewa_attribute_read_f64(ewa_cloud_find(cloud, name), 0, count, to);
}

/// Holds a cloud to the begin of another one; fields behind the positions may be 0 from a point of the last chunk on.
/// Returns how many of these numbers are not.
static uint64_t expect_begin(const ewa_cloud *part, const ewa_cloud *whole, cut_kind kind) {
    const uint64_t count = ewa_cloud_point_count(part);
    const uint64_t last_chunk = count ? (count - 1) / CHUNK_POINTS * CHUNK_POINTS : 0;
    static double a[3 * POINTS], b[3 * POINTS];
    uint64_t known = 0;
    assert_true(count <= POINTS);
    read_numbers(part, EWA_POSITION, count, a);
    read_numbers(whole, EWA_POSITION, count, b);
    for (uint64_t i = 0; i < 3 * count; i++)
        if (a[i] != b[i]) fail_msg("coordinate %llu is %g, not %g", (unsigned long long)i, a[i], b[i]);
    for (int n = 0; n < (kind == FLAT ? 1 : FIELD_COUNT); n++) { // flat files have classes alone
        const ewa_attribute *field = ewa_cloud_find(whole, FIELDS[n]);
        const uint32_t components = field && strcmp(FIELDS[n], EWA_COLOR) == 0 ? 3 : 1;
        if (!field) continue;
        read_numbers(part, FIELDS[n], count, a);
        read_numbers(whole, FIELDS[n], count, b);
        bool lost = false;
        for (uint64_t i = 0; i < components * count; i++) {
            if (b[i] == 0) fail_msg("%s %llu is 0 in the whole file", FIELDS[n], (unsigned long long)i);
            lost |= a[i] == 0;
            if (a[i] != b[i] && a[i] != 0)
                fail_msg("%s %llu is %g, not %g", FIELDS[n], (unsigned long long)i, a[i], b[i]);
            if (lost && (a[i] == b[i] || i / components < last_chunk))
                fail_msg("%s %llu of %llu is %g", FIELDS[n], (unsigned long long)i, (unsigned long long)count, a[i]);
            known += !lost;
        }
    }
    return known;
}

static uint32_t number_at(const uint8_t *bytes) {
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static void try_cuts(cut_kind kind, size_t step) {
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, &log);
    char path[512], cut_path[512];
    ewa_cloud *made = make_cloud(context, kind), *whole = NULL;
    WITH_DEFAULTS(ewa_cloud_save_options, options);
    options.chunk_points = CHUNK_POINTS;
    options.step_world = 0.01;
    assert_int_equal(ewa_cloud_save(made, scratch_path("whole.laz", path), &options), EWA_OK);
    ewa_cloud_destroy(&made);
    assert_int_equal(ewa_cloud_load(context, path, &whole), EWA_OK);
    assert_int_equal(ewa_cloud_point_count(whole), POINTS);
    size_t size_bytes;
    uint8_t *bytes = scratch_read(path, &size_bytes);
    static const int FORMATS[KIND_COUNT] = {0, 6, 7, 8};
    assert_int_equal(bytes[104] % 64, FORMATS[kind]);
    scratch_path("cut.laz", cut_path);
    uint64_t last = 0, counts = 0, last_known = 0, grown = 0;
    for (size_t length = 227; length < size_bytes; length += step) {
        uint64_t lost_count;
        log.count = 0;
        OWNED(ewa_cloud_destroy) ewa_cloud *part = load_cut(context, bytes, length, cut_path, &lost_count);
        assert_true(log.count > 0 || (part && ewa_cloud_point_count(part) == POINTS));
        if (!part) continue;
        const uint64_t count = ewa_cloud_point_count(part), known = expect_begin(part, whole, kind);
        assert_true(count >= last);
        assert_true(known >= last_known);
        assert_int_equal(count + lost_count, POINTS);
        counts += count != last;
        grown += count != last || known != last_known;
        last = count;
        last_known = known;
    }
    print_message("format %d: %llu counts, %llu points at last, %zu bytes, grown %llu times of %zu\n", FORMATS[kind],
                  (unsigned long long)counts, (unsigned long long)last, size_bytes, (unsigned long long)grown,
                  size_bytes / step);
    // Nearly every step brings points more, or fields; of layered chunks x and y, a fifth of the bytes, bring none yet.
    assert_true((double)grown > (double)((size_bytes - 227) / step) * (kind == FLAT ? 0.9 : 0.65) - 12);
    // Nothing is lost where only the table is.
    const uint32_t points_at = number_at(bytes + 96), table_at = number_at(bytes + points_at);
    uint64_t lost_count;
    ewa_cloud *part = load_cut(context, bytes, table_at, cut_path, &lost_count);
    assert_int_equal(ewa_cloud_point_count(part), POINTS);
    assert_int_equal(lost_count, 0);
    expect_begin(part, whole, kind);
    ewa_cloud_destroy(&part);
    free(bytes);
    ewa_cloud_destroy(&whole);
}

TEST(test_flat) { try_cuts(FLAT, 61); }

TEST(test_layered) { try_cuts(LAYERED, 173); }

TEST(test_layered_color) { try_cuts(LAYERED_COLOR, 251); }

TEST(test_layered_infrared) { try_cuts(LAYERED_INFRARED, 251); }

/// Chunks of COPC have sizes of their own, which only the table tells, and they themselves.
TEST(test_octree) {
    enum { COUNT = 3000 };
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, &log);
    char path[512], cut_path[512];
    ewa_cloud *cloud = copc_cloud(context, COUNT, true), *whole = NULL;
    copc_nodes nodes = copc_share(cloud, 3);
    const ewa_octree_plan plan = copc_plan(cloud);
    assert_int_equal(copc_write(context, scratch_path("whole.copc.laz", path), &plan, &nodes, 0), EWA_OK);
    copc_nodes_free(&nodes);
    ewa_cloud_destroy(&cloud);
    assert_int_equal(ewa_cloud_load(context, path, &whole), EWA_OK);
    static double a[3 * COUNT], b[3 * COUNT];
    read_numbers(whole, EWA_POSITION, COUNT, b);
    size_t size_bytes;
    uint8_t *bytes = scratch_read(path, &size_bytes);
    scratch_path("cut.copc.laz", cut_path);
    uint64_t last = 0;
    for (size_t length = 700; length < size_bytes; length += 611) {
        uint64_t lost_count;
        OWNED(ewa_cloud_destroy) ewa_cloud *part = load_cut(context, bytes, length, cut_path, &lost_count);
        if (!part) continue;
        const uint64_t count = ewa_cloud_point_count(part);
        assert_true(count >= last);
        assert_int_equal(count + lost_count, COUNT);
        last = count;
        read_numbers(part, EWA_POSITION, count, a);
        assert_memory_equal(a, b, 3 * count * sizeof *a);
    }
    assert_int_equal(last, COUNT);
    free(bytes);
    ewa_cloud_destroy(&whole);
}

static ewa_status load_failing(ewa_context *context, void *user) {
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = scratch_read(user, &size_bytes);
    WITH_DEFAULTS(ewa_cloud_load_options, options);
    options.keep_going = true;
    OWNED(ewa_cloud_reader_close) ewa_cloud_reader *reader = NULL;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    ewa_status status = ewa_cloud_reader_open(context, user, &options, &reader);
    if (status == EWA_OK) status = ewa_cloud_reader_next(reader, 2 * POINTS, &cloud);
    return status;
}

TEST(test_failing_allocations) {
    char path[512];
    scratch_fail_each(load_failing, (void *)(uintptr_t)scratch_path("cut.laz", path));
}

int main(void) { return RUN_TESTS(NULL, NULL); }
