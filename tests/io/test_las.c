// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Reading LAS: every field of every point format, extra bytes, headers that lie, notes.
#include "io/las_sample.h"

#include "io/fixture.h"

CASE(test_fields_of_all_formats) {
    enum { COUNT = 20000 }; // more than a task takes
    for (uint8_t format = 0; format < LAS_FORMATS; format++) {
        las_sample s = las_make(format, format < 4 ? 2 : format < 6 ? 3 : 4, 0, COUNT, NULL, 0, 0);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = las_load(context, &s);
        assert_int_equal(ewa_cloud_point_count(cloud), COUNT);
        for (uint64_t i = 0; i < COUNT; i++) {
            for (uint32_t c = 0; c < 3; c++) {
                const double scale = las_get_f64(s.bytes + 131 + 8 * c);
                const double offset = las_get_f64(s.bytes + 155 + 8 * c);
                const int32_t whole = (int32_t)las_get(las_record(&s, i) + 4 * c, 4);
                // The origin is where the header says the points begin, the rest is exact.
                if (las_value(cloud, EWA_POSITION, i, c) != (double)(whole + 1000) * scale)
                    fail_msg("format %u, point %d: %c", format, (int)i, "xyz"[c]);
                assert_float_equal(las_world(cloud, i, c), offset + whole * scale, 1e-9);
            }
            for (int k = 0; k < LAS_FIELD_COUNT; k++) {
                double wanted;
                const bool there = las_number(&s, i, las_fields[k], 0, &wanted);
                if (there != (ewa_cloud_find(cloud, las_fields[k]) != NULL))
                    fail_msg("format %u: '%s' there: %d", format, las_fields[k], there);
                for (uint32_t c = 0; there && c < (strcmp(las_fields[k], "color") == 0 ? 3 : 1); c++) {
                    las_number(&s, i, las_fields[k], c, &wanted);
                    const double value = las_value(cloud, las_fields[k], i, c);
                    if (value != wanted)
                        fail_msg("format %u, '%s' of point %d: %g, not %g", format, las_fields[k], (int)i,
                                 value, wanted);
                }
            }
        }
        if (format == 4 || format == 5 || format >= 9) {
            const uint8_t *wave = las_record(&s, 7) + s.record_bytes - 29;
            assert_true(las_value(cloud, "wave_packet_descriptor", 7, 0) == wave[0]);
            assert_true(las_value(cloud, "wave_packet_offset", 7, 0) == (double)las_get(wave + 1, 8));
            assert_true(las_value(cloud, "wave_packet_size", 7, 0) == (double)las_get(wave + 9, 4));
            const uint32_t bits = (uint32_t)las_get(wave + 25, 4);
            float z;
            memcpy(&z, &bits, sizeof z);
            assert_memory_equal((const float *)ewa_cloud_find(cloud, "wave_z_t")->data + 7, &z, sizeof z);
        }
        assert_int_equal(messages.count, 0);
        free(s.bytes);
    }
}

/// Describes a field of extra bytes.
static void describe(uint8_t *to, const char *name, uint8_t type, uint8_t options) {
    memset(to, 0, 192);
    to[2] = type;
    to[3] = options;
    memcpy(to + 4, name, strlen(name));
}

CASE(test_extra_bytes) {
    static const uint8_t sizes[11] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    static const char *const names[11] = {"",    "u8",  "i8",  "u16", "i16", "u32",
                                          "i32", "u64", "i64", "f32", "f64"};
    static const ewa_type types[11] = {EWA_U8,  EWA_U8,  EWA_I8,  EWA_U16, EWA_I16, EWA_U32,
                                       EWA_I32, EWA_F64, EWA_F64, EWA_F32, EWA_F64};
    uint8_t fields[15 * 192], vlr[54 + sizeof fields];
    uint32_t extra_bytes = 0;
    for (uint8_t type = 1; type <= 10; type++) {
        describe(fields + 192 * (type - 1), names[type], type, 0);
        extra_bytes += sizes[type];
    }
    describe(fields + 192 * 10, "three", 23, 0); // u16 x 3
    describe(fields + 192 * 11, "raw", 0, 6);    // bytes without a type
    describe(fields + 192 * 12, "scaled", 4, 8 | 16 | 1);
    las_put(fields + 192 * 12 + 40, (uint64_t)(int64_t)-5, 8); // no data
    las_put_f64(fields + 192 * 12 + 112, 0.5);
    las_put_f64(fields + 192 * 12 + 136, 100);
    describe(fields + 192 * 13, "gap", 9, 1);
    las_put_f64(fields + 192 * 13 + 40, 2.5);
    describe(fields + 192 * 14, "vector", 24, 8 | 16); // i16 x 3
    for (uint32_t c = 0; c < 3; c++) {
        las_put_f64(fields + 192 * 14 + 112 + 8 * c, 0.5 + c);
        las_put_f64(fields + 192 * 14 + 136 + 8 * c, 100 + 10 * c);
    }
    extra_bytes += 6 + 6 + 2 + 4 + 6 + 5; // and five that nobody describes
    const size_t vlr_bytes = las_vlr(vlr, "LASF_Spec", 4, fields, sizeof fields);
    las_sample s = las_make(1, 4, extra_bytes, 3, vlr, vlr_bytes, 1);
    uint8_t *record = s.bytes + s.points_at + 28;
    const uint32_t scaled_at = extra_bytes - 17, gap_at = extra_bytes - 15, vector_at = extra_bytes - 11;
    las_put(record + scaled_at, (uint64_t)(int64_t)-5, 2);
    las_put(record + s.record_bytes + scaled_at, 6, 2);
    las_put(record + gap_at, 0x40200000, 4); // 2.5f
    las_put(record + s.record_bytes + gap_at, 0x40400000, 4);
    for (uint32_t c = 0; c < 3; c++) las_put(record + vector_at + 2 * c, 4 + c, 2);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = las_load(context, &s);
    uint32_t at = 0;
    for (uint8_t type = 1; type <= 10; type++) {
        const ewa_attribute *attribute = ewa_cloud_find(cloud, names[type]);
        assert_non_null(attribute);
        assert_int_equal(attribute->type, types[type]);
        const uint64_t raw = las_get(record + at, sizes[type]);
        if (type == 7 || type == 8)
            assert_true(las_value(cloud, names[type], 0, 0) ==
                        (type == 7 ? (double)raw : (double)(int64_t)raw));
        else
            assert_memory_equal(attribute->data, record + at, sizes[type]);
        at += sizes[type];
    }
    assert_true(las_value(cloud, "three", 2, 2) == (double)las_get(record + 2 * s.record_bytes + at + 4, 2));
    assert_int_equal(ewa_cloud_find(cloud, "raw")->component_count, 4);
    assert_true(las_value(cloud, "raw_1", 0, 1) == record[at + 6 + 5]);
    assert_true(isnan(las_value(cloud, "scaled", 0, 0)));
    assert_true(las_value(cloud, "scaled", 1, 0) == 103);
    assert_true(isnan(las_value(cloud, "gap", 0, 0)) && las_value(cloud, "gap", 1, 0) == 3);
    for (uint32_t c = 0; c < 3; c++)
        assert_true(las_value(cloud, "vector", 0, c) == (4 + c) * (0.5 + c) + 100 + 10 * c);
    assert_true(las_value(cloud, "extra_bytes", 0, 0) == record[extra_bytes - 5]);
    assert_true(las_value(cloud, "extra_bytes_1", 0, 0) == record[extra_bytes - 1]);
    assert_int_equal(messages.count, 0);
    ewa_cloud_destroy(&cloud);
    // More fields than bytes: what does not fit is said and stays bytes. The records are others then.
    memset(s.bytes + 179, 0, 6 * 8);
    las_put(s.bytes + 105, 28 + 4, 2);
    cloud = las_load(context, &s);
    assert_non_null(ewa_cloud_find(cloud, "u16"));
    assert_null(ewa_cloud_find(cloud, "i16"));
    assert_non_null(strstr(messages.text, "field 4 of 15"));
    free(s.bytes);
}

CASE(test_names_of_parts) {
    uint8_t fields[4 * 192], vlr[54 + sizeof fields];
    describe(fields, "ny", 9, 0);
    describe(fields + 192, "nx", 9, 0);
    describe(fields + 384, "nz", 9, 0);
    describe(fields + 576, "intensity", 9, 0); // in full what the format has in short
    las_sample s = las_make(0, 4, 16, 1, vlr, las_vlr(vlr, "LASF_Spec", 4, fields, sizeof fields), 1);
    static const uint32_t bits[4] = {0x3f800000, 0x40000000, 0x40400000, 0x3e800000};
    for (int i = 0; i < 4; i++) las_put(s.bytes + s.points_at + 20 + 4 * i, bits[i], 4);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = las_load(context, &s);
    assert_true(las_value(cloud, EWA_NORMAL, 0, 0) == 2 && las_value(cloud, EWA_NORMAL, 0, 1) == 1 &&
                las_value(cloud, EWA_NORMAL, 0, 2) == 3);
    assert_true(las_value(cloud, "intensity", 0, 0) == 0.25);
    assert_null(ewa_cloud_find(cloud, "nx"));
    free(s.bytes);
}

CASE(test_colors_of_eight_bits) {
    enum { COUNT = 1000 };
    las_sample s = las_make(2, 2, 0, COUNT, NULL, 0, 0);
    for (int kind = 0; kind < 4; kind++) {
        for (uint64_t i = 0; i < COUNT; i++)
            for (int c = 0; c < 3; c++) {
                const uint64_t value = i * 7 % 256;
                uint8_t *to = (uint8_t *)(uintptr_t)las_record(&s, i) + 20 + 2 * c;
                las_put(to, kind == 0 ? value : kind == 1 ? value * 257 : kind == 2 ? 0 : value, 2);
                if (kind == 3 && i == COUNT - 1) las_put(to, 256, 2);
            }
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = las_load(context, &s);
        const ewa_attribute *color = ewa_cloud_find(cloud, EWA_COLOR);
        if (kind == 2) { // no colour is set
            assert_null(color);
        } else {
            assert_int_equal(color->type, kind == 3 ? EWA_U16 : EWA_U8);
            for (uint64_t i = 0; i + 1 < COUNT; i++)
                assert_true(las_value(cloud, EWA_COLOR, i, 1) == (double)(i * 7 % 256));
        }
    }
    free(s.bytes);
}

CASE(test_notes) {
    const char wkt[] = "PROJCS[\"Somewhere / zone 1\",GEOGCS[\"Somewhere\"]]";
    uint8_t vlrs[600];
    size_t at = las_vlr(vlrs, "LASF_Projection", 2112, wkt, sizeof wkt);
    at += las_vlr(vlrs + at, "somebody", 9, "abc", 3);
    las_sample s = las_make(6, 4, 0, 1, vlrs, at, 2);
    las_put(s.bytes + 6, 17, 2);
    ewa_cloud *cloud = las_load(context, &s);
    size_t bytes;
    assert_string_equal(ewa_cloud_note(cloud, "crs", NULL), wkt);
    assert_string_equal(ewa_cloud_note(cloud, "crs_name", NULL), "Somewhere / zone 1");
    assert_non_null(ewa_cloud_note(cloud, "las.vlrs", &bytes));
    assert_int_equal(bytes, at);
    assert_string_equal(ewa_cloud_note(cloud, "file.format", NULL),
                        "LAS 1.4, point format 6, 30 bytes a point");
    assert_string_equal(ewa_cloud_note(cloud, "file.date", NULL), "2023-03-02");
    assert_string_equal(ewa_cloud_note(cloud, "file.system", NULL), "a scanner");
    assert_string_equal(ewa_cloud_note(cloud, "file.software", NULL), "a test");
    assert_string_equal(ewa_cloud_note(cloud, "las.global_encoding", NULL), "17");
    ewa_cloud_destroy(&cloud);
    free(s.bytes);
    static const struct {
        uint16_t model, projected, geodetic, unit, vertical_unit;
        const char *crs, *name, *unit_name;
    } keys[] = {{1, 32632, 0, 0, 0, "EPSG:32632", "UTM 32", NULL},
                {2, 0, 4326, 0, 0, "EPSG:4326", "UTM 32", NULL},
                {1, 32767, 0, 9001, 9001, "user-defined: UTM 32", "UTM 32", "m"},
                {1, 2263, 0, 9003, 0, "EPSG:2263", "UTM 32", "US ft"},
                {1, 2263, 0, 9003, 9001, "EPSG:2263", "UTM 32", NULL},
                {1, 2222, 0, 9002, 0, "EPSG:2222", "UTM 32", "ft"}};
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) {
        const uint16_t numbers[28] = {1,    1,     0, 6,
                                      1024, 0,     1, keys[k].model,
                                      1026, 34737, 7, 2,
                                      3072, 0,     1, keys[k].projected,
                                      2048, 0,     1, keys[k].geodetic,
                                      3076, 0,     1, keys[k].unit,
                                      4099, 0,     1, keys[k].vertical_unit};
        uint8_t directory[sizeof numbers];
        for (int i = 0; i < 28; i++) las_put(directory + 2 * i, numbers[i], 2);
        at = las_vlr(vlrs, "LASF_Projection", 34735, directory, sizeof directory);
        at += las_vlr(vlrs + at, "LASF_Projection", 34737, "x|UTM 32|", 9);
        s = las_make(0, 2, 0, 1, vlrs, at, 2);
        cloud = las_load(context, &s);
        assert_string_equal(ewa_cloud_note(cloud, "crs", NULL), keys[k].crs);
        assert_string_equal(ewa_cloud_note(cloud, "crs_name", NULL), keys[k].name);
        const char *unit = ewa_cloud_note(cloud, "crs_unit", NULL);
        assert_string_equal(unit ? unit : "none", keys[k].unit_name ? keys[k].unit_name : "none");
        ewa_cloud_destroy(&cloud);
        free(s.bytes);
    }
}

CASE(test_headers_that_lie) {
    las_sample s = las_make(3, 4, 0, 10, NULL, 0, 0);
    // The count of 64 bits is 0: that of 32 bits counts.
    las_put(s.bytes + 247, 0, 8);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = las_load(context, &s);
    assert_int_equal(ewa_cloud_point_count(cloud), 10);
    ewa_cloud_destroy(&cloud);
    // Both are 0 though records are there.
    las_put(s.bytes + 107, 0, 4);
    cloud = las_load(context, &s);
    assert_int_equal(ewa_cloud_point_count(cloud), 10);
    assert_non_null(strstr(messages.text, "counts no points, 10 are there"));
    ewa_cloud_destroy(&cloud);
    // Bounds that are no numbers, or far away.
    las_put(s.bytes + 107, 10, 4);
    for (int k = 0; k < 2; k++) {
        for (int c = 0; c < 3; c++) las_put_f64(s.bytes + 187 + 16 * c, k ? NAN : -1e30);
        cloud = las_load(context, &s);
        const int32_t x = (int32_t)las_get(las_record(&s, 0), 4);
        assert_float_equal(las_world(cloud, 0, 0), 500000 + 0.001 * x, 1e-9);
        ewa_cloud_destroy(&cloud);
    }
    memset(s.bytes + 179, 0, 6 * 8);
    // Points that the header counts and the file does not have.
    las_put(s.bytes + 107, 0xffffffff, 4);
    assert_int_equal(ewa_cloud_load_memory(context, s.bytes, s.size_bytes, "made.las", &cloud),
                     EWA_ERROR_FORMAT);
    assert_string_equal(messages.text,
                        "made.las: the file ends in point 11 of 4294967295: records of 34 bytes "
                        "from byte 375 on, 340 bytes are there (keep_going leaves out what is damaged)");
    cloud = NULL;
    assert_int_equal(ewa_cloud_load_memory(context, s.bytes, s.points_at, "made.las", &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_point_count(cloud), 0);
    ewa_cloud_destroy(&cloud);
    // More records before the points than there is room for.
    las_put(s.bytes + 107, 10, 4);
    las_put(s.bytes + 100, 0xffffffff, 4);
    cloud = las_load(context, &s);
    assert_non_null(strstr(messages.text, "variable length records end before the last"));
    free(s.bytes);
}

CASE(test_only_what_is_wanted) {
    las_sample s = las_make(3, 2, 0, 50, NULL, 0, 0);
    const char *path = "las_wanted.las";
    FILE *file = fopen(path, "wb");
    assert_int_equal(fwrite(s.bytes, 1, s.size_bytes, file), s.size_bytes);
    fclose(file);
    WITH_DEFAULTS(ewa_cloud_load_options, options);
    options.attributes = "classification,color";
    ewa_cloud_reader *reader = NULL;
    assert_int_equal(ewa_cloud_reader_open(context, path, &options, &reader), EWA_OK);
    remove(path);
    ewa_cloud *piece = NULL;
    uint64_t count = 0;
    while (ewa_cloud_reader_next(reader, 7, &piece) == EWA_OK && piece) {
        assert_int_equal(ewa_cloud_attribute_count(piece), 3);
        for (uint64_t i = 0; i < ewa_cloud_point_count(piece); i++) {
            double wanted;
            las_number(&s, count + i, "classification", 0, &wanted);
            assert_true(las_value(piece, "classification", i, 0) == wanted);
        }
        count += ewa_cloud_point_count(piece);
        ewa_cloud_destroy(&piece);
    }
    assert_int_equal(count, 50);
    ewa_cloud_reader_close(&reader);
    free(s.bytes);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
