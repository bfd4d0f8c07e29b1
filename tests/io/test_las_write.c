// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Writing LAS and LAZ: what was read comes out bit for bit, attributes find their fields or extra bytes,
// headers hold counts and bounds, coordinates find a grid.
#include "io/las_sample.h"
#include "io/scratch.h"

#include "io/fixture.h"

/// Saves and reads again; `*bytes` (may be NULL) gets the file, which the caller frees.
static ewa_cloud *save_and_load(const ewa_cloud *cloud, const char *name,
                                const ewa_cloud_save_options *options, uint8_t **bytes, size_t *size_bytes) {
    char path[512];
    scratch_path(name, path);
    if (ewa_cloud_save(cloud, path, options) != EWA_OK) fail_msg("%s", messages.text);
    if (bytes) *bytes = scratch_read(path, size_bytes);
    ewa_cloud *back = NULL;
    if (ewa_cloud_load(context, path, &back) != EWA_OK) fail_msg("%s", messages.text);
    remove(path);
    return back;
}

CASE(test_round_trips) {
    enum { COUNT = 12345 };
    for (uint8_t format = 0; format < LAS_FORMATS; format++) {
        las_sample s = las_make(format, format < 4 ? 2 : format < 6 ? 3 : 4, 0, COUNT, NULL, 0, 0);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = las_load(context, &s);
        for (int compressed = 0; compressed < 2; compressed++) {
            WITH_DEFAULTS(ewa_cloud_save_options, options);
            options.chunk_points = 1000;
            OWNED(check_free) uint8_t *bytes = NULL;
            size_t size_bytes = 0;
            OWNED(ewa_cloud_destroy) ewa_cloud *back =
                save_and_load(cloud, compressed ? "trip.laz" : "trip.las", &options, &bytes, &size_bytes);
            las_compare(cloud, back);
            const bool same_format = format < 4 || (format >= 6 && format < 9);
            const size_t at = (size_t)las_get(bytes + 96, 4);
            if (same_format) assert_int_equal(bytes[104] & 0x7f, format);
            if (same_format && !compressed) {
                assert_int_equal(size_bytes - at, COUNT * s.record_bytes);
                assert_memory_equal(bytes + at, s.bytes + s.points_at, size_bytes - at);
            }
            assert_memory_equal(bytes + 131, s.bytes + 131, 48); // scale and offset
        }
        free(s.bytes);
    }
    assert_int_equal(messages.count, 0);
}

CASE(test_header) {
    enum { COUNT = 5000 };
    las_sample s = las_make(1, 2, 0, COUNT, NULL, 0, 0);
    ewa_cloud *cloud = las_load(context, &s);
    uint8_t *bytes;
    size_t size_bytes;
    ewa_cloud *back = save_and_load(cloud, "header.las", NULL, &bytes, &size_bytes);
    assert_int_equal(bytes[25], 2);
    assert_int_equal(las_get(bytes + 107, 4), COUNT);
    for (int r = 0; r < 5; r++) assert_int_equal(las_get(bytes + 111 + 4 * r, 4), COUNT / 5);
    int32_t low = INT32_MAX, high = INT32_MIN;
    for (uint64_t i = 0; i < COUNT; i++) {
        const int32_t x = (int32_t)las_get(las_record(&s, i), 4);
        low = x < low ? x : low;
        high = x > high ? x : high;
    }
    assert_float_equal(las_get_f64(bytes + 179), 500000 + 0.001 * high, 1e-9);
    assert_float_equal(las_get_f64(bytes + 187), 500000 + 0.001 * low, 1e-9);
    assert_memory_equal(bytes + 26, "a scanner", 10);
    ewa_cloud_destroy(&back);
    ewa_cloud_destroy(&cloud);
    free(bytes);
    free(s.bytes);
}

CASE(test_pieces) {
    enum { COUNT = 4321 };
    las_sample s = las_make(7, 4, 0, COUNT, NULL, 0, 0);
    ewa_cloud *cloud = las_load(context, &s);
    WITH_DEFAULTS(ewa_cloud_save_options, options);
    options.chunk_points = 500;
    char path[512];
    scratch_path("pieces.laz", path);
    assert_int_equal(ewa_cloud_save(cloud, path, &options), EWA_OK);
    size_t whole_bytes, pieces_bytes;
    uint8_t *whole = scratch_read(path, &whole_bytes);
    static const uint64_t sizes[] = {1, 499, 500, 777, 5000};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        char copy[512];
        scratch_path("copy.laz", copy);
        ewa_cloud_reader *reader = NULL;
        ewa_cloud_writer *writer = NULL;
        assert_int_equal(ewa_cloud_reader_open(context, path, NULL, &reader), EWA_OK);
        assert_int_equal(ewa_cloud_writer_open(context, copy, &options, ewa_cloud_reader_prototype(reader),
                                               k % 2 ? COUNT : EWA_POINTS_UNKNOWN, NULL, &writer),
                         EWA_OK);
        ewa_cloud *piece = NULL;
        while (ewa_cloud_reader_next(reader, sizes[k], &piece) == EWA_OK && piece) {
            assert_int_equal(ewa_cloud_writer_put(writer, piece), EWA_OK);
            ewa_cloud_destroy(&piece);
        }
        assert_int_equal(ewa_cloud_writer_commit(&writer), EWA_OK);
        ewa_cloud_reader_close(&reader);
        uint8_t *pieces = scratch_read(copy, &pieces_bytes);
        // The same bytes, however the points came.
        assert_int_equal(pieces_bytes, whole_bytes);
        assert_memory_equal(pieces, whole, whole_bytes);
        free(pieces);
        remove(copy);
    }
    remove(path);
    free(whole);
    ewa_cloud_destroy(&cloud);
    free(s.bytes);
    assert_int_equal(messages.count, 0);
}

/// A cloud of `count` positions in doubles.
static ewa_cloud *make_cloud(uint64_t count, double **positions) {
    ewa_cloud *cloud = check_cloud_of(context, count);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, (void **)positions), EWA_OK);
    for (uint64_t i = 0; i < 3 * count; i++) (*positions)[i] = 0;
    return cloud;
}

CASE(test_attributes_of_every_type) {
    enum { COUNT = 300 };
    static const struct {
        const char *name;
        ewa_type type;
        uint32_t components;
    } attributes[] = {{EWA_NORMAL, EWA_F32, 3},       {EWA_RADIUS, EWA_F32, 1},   {EWA_TANGENT_U, EWA_F64, 3},
                      {EWA_TANGENT_V, EWA_F32, 3},    {EWA_CLIP0, EWA_F32, 3},    {EWA_CLIP1, EWA_F32, 3},
                      {EWA_CLIP_MODE, EWA_U8, 1},     {EWA_MATERIAL, EWA_U16, 1}, {"intensity", EWA_F32, 1},
                      {"classification", EWA_I32, 1}, {"scan", EWA_U16, 1},       {"bytes", EWA_U8, 4},
                      {"pair", EWA_I16, 2},           {"triple", EWA_U32, 3},     {"small", EWA_I8, 1},
                      {"gps_time", EWA_F32, 1},       {"nir", EWA_U16, 1}};
    double *positions;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(COUNT, &positions);
    check_random random = {5};
    for (int i = 0; i < 3 * COUNT; i++) positions[i] = check_uniform(&random, -3, 3);
    for (size_t k = 0; k < sizeof attributes / sizeof *attributes; k++) {
        const size_t bytes = COUNT * attributes[k].components * ewa_type_bytes(attributes[k].type);
        uint8_t *data = check_add(cloud, attributes[k].name, attributes[k].type, attributes[k].components);
        for (size_t i = 0; i < bytes; i++) data[i] = (uint8_t)(check_random_u64(&random) % 64);
    }
    ewa_coordinate_grid grid = {{1e-6, 1e-6, 1e-6}, {0, 0, 0}};
    for (int i = 0; i < 3 * COUNT; i++) positions[i] = nearbyint(positions[i] * 1e6) * 1e-6;
    ewa_cloud_set_grid(cloud, &grid);
    for (int compressed = 0; compressed < 2; compressed++) {
        OWNED(ewa_cloud_destroy)
        ewa_cloud *back = save_and_load(cloud, compressed ? "types.laz" : "types.las", NULL, NULL, NULL);
        las_compare(cloud, back);
    }
}

CASE(test_colors) {
    double *positions;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(256, &positions);
    uint8_t *color = check_add(cloud, EWA_COLOR, EWA_U8, 4);
    for (int i = 0; i < 1024; i++) color[i] = (uint8_t)(i / 4 + i);
    uint8_t *bytes;
    size_t size_bytes;
    OWNED(ewa_cloud_destroy) ewa_cloud *back = save_and_load(cloud, "color.las", NULL, &bytes, &size_bytes);
    const uint8_t *record = bytes + las_get(bytes + 96, 4) + 28 * 5; // with an alpha
    assert_int_equal(las_get(record + 20, 2), 257 * color[4 * 5]);
    las_compare(cloud, back); // eight bits again
    ewa_cloud_destroy(&back);
    free(bytes);
    float *linear = check_add(cloud, EWA_COLOR, EWA_F32, 3);
    for (int i = 0; i < 768; i++) linear[i] = (float)i / 700;
    back = save_and_load(cloud, "color.las", NULL, NULL, NULL);
    const ewa_attribute *read = ewa_cloud_find(back, EWA_COLOR);
    assert_int_equal(read->type, EWA_U16);
    for (int i = 0; i < 768; i++) {
        const double x = linear[i] < 1 ? linear[i] : 1;
        const double srgb = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
        assert_float_equal(((const uint16_t *)read->data)[i], 65535 * srgb, 0.51);
    }
}

CASE(test_grids) {
    static const struct {
        double low, high, step, offset;
        const char *crs;
    } boxes[] = {{4200000.123, 4200100.75, 1e-4, 4200050, NULL}, // a scan in metres
                 {-150000, 150000, 1e-4, 0, NULL},
                 {0, 1e6, 1e-3, 500000, NULL},
                 {-6.4e6, 6.4e6, 1e-2, 0, NULL},
                 {0.25, 0.75, 1e-7, 0, NULL},        // a small object
                 {7.5, 9.25, 1e-8, 8, "EPSG:4326"}}; // degrees
    for (size_t k = 0; k < sizeof boxes / sizeof *boxes; k++) {
        double *positions;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(2, &positions);
        for (int i = 0; i < 6; i++) positions[i] = i < 3 ? boxes[k].low : boxes[k].high;
        if (boxes[k].crs) ewa_cloud_set_note(cloud, "crs", boxes[k].crs, strlen(boxes[k].crs));
        OWNED(check_free) uint8_t *bytes;
        size_t size_bytes;
        OWNED(ewa_cloud_destroy) ewa_cloud *back = save_and_load(cloud, "grid.las", NULL, &bytes, &size_bytes);
        if (las_get_f64(bytes + 131) != boxes[k].step)
            fail_msg("box %d: step %g", (int)k, las_get_f64(bytes + 131));
        assert_true(las_get_f64(bytes + 155) == boxes[k].offset);
        for (int i = 0; i < 2; i++)
            assert_float_equal(las_world(back, (uint64_t)i, 0), positions[3 * i], boxes[k].step / 1.9);
        if (boxes[k].crs) assert_string_equal(ewa_cloud_note(back, "crs", NULL), boxes[k].crs);
    }
    double *positions;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(2, &positions);
    positions[3] = 1e8;
    char path[512];
    scratch_path("wide.las", path);
    assert_int_equal(ewa_cloud_save(cloud, path, NULL), EWA_ERROR_LIMIT);
    assert_non_null(strstr(messages.text, "x from 0 to 100000000 in steps of 0.01 does not fit the 32 bits"));
    WITH_DEFAULTS(ewa_cloud_save_options, options);
    options.step_world = 0.5;
    assert_int_equal(ewa_cloud_save(cloud, path, &options), EWA_OK);
    remove(path);
    // A grid whose offset is too far keeps its decimals, counted from elsewhere.
    const ewa_coordinate_grid grid = {{1e-6, 1e-6, 1e-6}, {0, 0, 0}};
    ewa_cloud_set_grid(cloud, &grid);
    positions[0] = 4200000.123456;
    positions[3] = 4200001.654321;
    OWNED(ewa_cloud_destroy) ewa_cloud *back = save_and_load(cloud, "grid.las", NULL, NULL, NULL);
    assert_true(las_world(back, 0, 0) == 4200000.123456 && las_world(back, 1, 0) == 4200001.654321);
    // Steps so fine that whole numbers are too far away for an offset.
    OWNED(ewa_cloud_destroy) ewa_cloud *tiny = make_cloud(2, &positions);
    for (int i = 0; i < 6; i++) positions[i] = i < 3 ? 0.45 : 0.55;
    options.step_world = 1e-10;
    OWNED(ewa_cloud_destroy) ewa_cloud *fine = save_and_load(tiny, "fine.las", &options, NULL, NULL);
    assert_float_equal(las_world(fine, 0, 0), 0.45, 1e-10);
    assert_float_equal(las_world(fine, 1, 0), 0.55, 1e-10);
}

/// Intensities that are shares of the brightest use all of the 16 bits.
CASE(test_shares_as_intensities) {
    for (int wide = 0; wide < 2; wide++) {
        double *positions;
        void *to;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(2, &positions);
        assert_int_equal(ewa_cloud_add(cloud, "intensity", wide ? EWA_F64 : EWA_F32, 1, &to), EWA_OK);
        for (int i = 0; i < 2; i++) wide ? (((double *)to)[i] = i ? 1 : 0.25) : (((float *)to)[i] = i ? 1 : 0.25f);
        OWNED(check_free) uint8_t *bytes = NULL;
        size_t size_bytes = 0;
        OWNED(ewa_cloud_destroy) ewa_cloud *back = save_and_load(cloud, "shares.las", NULL, &bytes, &size_bytes);
        const size_t at = (size_t)las_get(bytes + 96, 4), record_bytes = (size_t)las_get(bytes + 105, 2);
        assert_float_equal(las_get(bytes + at + 12, 2), 0.25 * 65535, 1);
        assert_int_equal(las_get(bytes + at + record_bytes + 12, 2), 65535);
        assert_true(las_value(back, "intensity", 0, 0) == 0.25); // as it was, in bytes of its own
    }
}

CASE(test_points_without_a_place) {
    double *positions;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(5, &positions);
    for (int i = 0; i < 15; i++) positions[i] = i;
    positions[4] = NAN;
    positions[11] = INFINITY;
    OWNED(ewa_cloud_destroy) ewa_cloud *back = save_and_load(cloud, "nan.las", NULL, NULL, NULL);
    assert_int_equal(ewa_cloud_point_count(back), 3);
    assert_true(las_world(back, 1, 0) == 6 && las_world(back, 2, 2) == 14);
    assert_non_null(strstr(messages.text, "2 points without finite coordinates"));
}

CASE(test_format_that_holds_the_numbers) {
    static const struct {
        const char *name;
        double value;
        int format;
    } cases[] = {{"return_number", 5, 0},   {"return_number", 6, 6},   {"classification", 31, 0},
                 {"classification", 32, 6}, {"scanner_channel", 0, 6}, {"overlap", 1, 6},
                 {"point_source_id", 9, 0}, {"user_data", 255, 0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        double *positions;
        void *data;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(1, &positions);
        const bool wide = strcmp(cases[k].name, "point_source_id") == 0;
        assert_int_equal(ewa_cloud_add(cloud, cases[k].name, wide ? EWA_U16 : EWA_U8, 1, &data), EWA_OK);
        las_put(data, (uint64_t)cases[k].value, wide ? 2 : 1);
        OWNED(check_free) uint8_t *bytes;
        size_t size_bytes;
        OWNED(ewa_cloud_destroy) ewa_cloud *back = save_and_load(cloud, "format.las", NULL, &bytes, &size_bytes);
        if (bytes[104] != cases[k].format) fail_msg("%s %g: %d", cases[k].name, cases[k].value, bytes[104]);
        assert_true(las_value(back, cases[k].name, 0, 0) == cases[k].value);
        // Points of which nothing is known are the only returns of their pulses.
        if (k > 2) assert_true(las_value(back, "number_of_returns", 0, 0) == 1);
    }
}

CASE(test_records_and_systems) {
    const char wkt[] = "GEOGCS[\"WGS 84\"]";
    uint8_t vlrs[300];
    size_t at = las_vlr(vlrs, "LASF_Projection", 2112, wkt, sizeof wkt), bytes_count;
    at += las_vlr(vlrs + at, "somebody", 9, "abc", 3);
    las_sample s = las_make(6, 4, 0, 1, vlrs, at, 2);
    las_put(s.bytes + 6, 17, 2);
    ewa_cloud *cloud = las_load(context, &s);
    uint8_t *bytes;
    ewa_cloud *back = save_and_load(cloud, "crs.las", NULL, &bytes, &bytes_count);
    assert_memory_equal(bytes + 375, vlrs, at);
    assert_int_equal(las_get(bytes + 6, 2), 17);
    ewa_cloud_destroy(&back);
    free(bytes);
    // A system that was set since then takes the place of the records, the others stay.
    ewa_cloud_set_note(cloud, "crs", "EPSG:25832+7837", 15);
    back = save_and_load(cloud, "crs.las", NULL, &bytes, &bytes_count);
    assert_string_equal(ewa_cloud_note(back, "crs_name", NULL), "ETRS89 / UTM zone 32N + DHHN2016 height");
    assert_memory_equal(bytes + 375, vlrs + at - 57, 57);
    assert_int_equal(las_get(bytes + 6, 2), 17);
    ewa_cloud_destroy(&back);
    ewa_cloud_destroy(&cloud);
    free(bytes);
    free(s.bytes);
}

CASE(test_memory) {
    // Every allocation of reading and of writing fails once.
    las_sample s = las_make(8, 4, 0, 700, NULL, 0, 0);
    for (int compressed = 0; compressed < 2; compressed++) {
        for (long nth = 0;; nth++) {
            check_memory memory = {.calls_left = -1};
            check_log log = {0};
            ewa_context *poor = scratch_context(&memory, &log);
            const int64_t before = memory.held_bytes;
            ewa_cloud *cloud = NULL;
            char path[512];
            scratch_path(compressed ? "memory.laz" : "memory.las", path);
            memory.calls_left = nth;
            ewa_status status = ewa_cloud_load_memory(poor, s.bytes, s.size_bytes, "made.las", &cloud);
            if (status == EWA_OK) status = ewa_cloud_save(cloud, path, NULL);
            ewa_cloud_destroy(&cloud);
            if (status == EWA_OK) status = ewa_cloud_load(poor, path, &cloud);
            ewa_cloud_destroy(&cloud);
            const bool reached = memory.calls_left < 0;
            assert_int_equal(memory.held_bytes, before);
            ewa_context_destroy(&poor);
            remove(path);
            assert_int_equal(status, reached ? EWA_ERROR_MEMORY : EWA_OK);
            if (!reached) break;
        }
    }
    free(s.bytes);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
