// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// LAS files that the tests make byte by byte, and what their fields are, written down apart from the reader.
#ifndef EWA_TESTS_LAS_SAMPLE_H
#define EWA_TESTS_LAS_SAMPLE_H

#include "check.h"

#include <math.h>
#include <string.h>

enum { LAS_FORMATS = 11, LAS_HEAD_BYTES = 375 };

static const uint8_t las_record_bytes[LAS_FORMATS] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

/// A file in memory; free `bytes`.
typedef struct las_sample {
    uint8_t *bytes;
    size_t size_bytes, points_at;
    uint32_t record_bytes, count;
    uint8_t format;
} las_sample;

static inline void las_put(uint8_t *to, uint64_t value, int count) {
    for (int i = 0; i < count; i++) to[i] = (uint8_t)(value >> (8 * i));
}

static inline uint64_t las_get(const uint8_t *from, int count) {
    uint64_t value = 0;
    for (int i = count; i-- > 0;) value = value << 8 | from[i];
    return value;
}

static inline void las_put_f64(uint8_t *to, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    las_put(to, bits, 8);
}

static inline double las_get_f64(const uint8_t *from) {
    const uint64_t bits = las_get(from, 8);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/// Puts a variable length record into `to`; returns its bytes.
static inline size_t las_vlr(uint8_t *to, const char *user, uint16_t id, const void *bytes, size_t count) {
    memset(to, 0, 54);
    memcpy(to + 2, user, strlen(user));
    las_put(to + 18, id, 2);
    las_put(to + 20, count, 2);
    if (count) memcpy(to + 54, bytes, count);
    return 54 + count;
}

/// Makes a file of LAS 1.4 (1.2 for formats 0 to 3 without `minor`) with `vlr_count` records in `vlrs` and
/// points of random bytes, whose return numbers and classes are what the formats may hold.
static inline las_sample las_make(uint8_t format, uint8_t minor, uint32_t extra_bytes, uint32_t count,
                                  const uint8_t *vlrs, size_t vlrs_bytes, uint32_t vlr_count) {
    las_sample s = {.record_bytes = las_record_bytes[format] + extra_bytes, .count = count, .format = format};
    const size_t head_bytes = minor >= 4 ? LAS_HEAD_BYTES : minor == 3 ? 235 : 227;
    s.points_at = head_bytes + vlrs_bytes;
    s.size_bytes = s.points_at + (size_t)count * s.record_bytes;
    s.bytes = calloc(1, s.size_bytes + 1);
    assert_non_null(s.bytes);
    uint8_t *h = s.bytes;
    memcpy(h, "LASF", 4);
    h[24] = 1;
    h[25] = minor;
    memcpy(h + 26, "a scanner", 9);
    memcpy(h + 58, "a test", 6);
    las_put(h + 90, 61, 2); // the first of March, or the second
    las_put(h + 92, 2023, 2);
    las_put(h + 94, head_bytes, 2);
    las_put(h + 96, s.points_at, 4);
    las_put(h + 100, vlr_count, 4);
    h[104] = format;
    las_put(h + 105, s.record_bytes, 2);
    if (format < 6) las_put(h + 107, count, 4);
    static const double scale[3] = {0.001, 0.01, 0.0001}, offset[3] = {500000, 4200000, -10};
    for (int c = 0; c < 3; c++) {
        las_put_f64(h + 131 + 8 * c, scale[c]);
        las_put_f64(h + 155 + 8 * c, offset[c]);
        las_put_f64(h + 179 + 16 * c, offset[c] + 1000 * scale[c]);
        las_put_f64(h + 187 + 16 * c, offset[c] - 1000 * scale[c]);
    }
    if (minor >= 4) las_put(h + 247, count, 8);
    if (vlrs_bytes) memcpy(h + head_bytes, vlrs, vlrs_bytes);
    check_random random = {format + 17u};
    for (uint32_t i = 0; i < count; i++) {
        uint8_t *r = s.bytes + s.points_at + (size_t)i * s.record_bytes;
        for (uint32_t k = 0; k < s.record_bytes; k++) r[k] = (uint8_t)check_random_u64(&random);
        for (int c = 0; c < 3; c++)
            las_put(r + 4 * c, (uint64_t)(int64_t)check_uniform(&random, -1000, 1001), 4);
        if (format < 6) {
            r[14] = (uint8_t)((r[14] & 0xc0) | (i % 5 + 1) | 5 << 3);
            r[16] = (uint8_t)(int8_t)check_uniform(&random, -90, 91);
        }
        const int time_at = format == 0 || format == 2 ? 0 : format < 6 ? 20 : 22;
        if (time_at) las_put_f64(r + time_at, 1e8 + 0.125 * i);
    }
    return s;
}

static inline const uint8_t *las_record(const las_sample *s, uint64_t i) {
    return s->bytes + s->points_at + i * s->record_bytes;
}

/// The number of a field as the specification has it; false when the format has no such field.
static inline bool las_number(const las_sample *s, uint64_t i, const char *name, uint32_t c, double *value) {
    const uint8_t *r = las_record(s, i), f = s->format;
    const bool late = f >= 6;
    const struct {
        const char *name;
        bool there;
        double value;
    } fields[] = {
        {"intensity", true, (double)las_get(r + 12, 2)},
        {"return_number", true, late ? r[14] % 16 : r[14] % 8},
        {"number_of_returns", true, late ? r[14] / 16 : r[14] / 8 % 8},
        {"scan_direction_flag", true, (late ? r[15] : r[14]) / 64 % 2},
        {"edge_of_flight_line", true, (late ? r[15] : r[14]) / 128},
        {"classification", true, late ? r[16] : r[15] % 32},
        {"synthetic", true, late ? r[15] % 2 : r[15] / 32 % 2},
        {"key_point", true, late ? r[15] / 2 % 2 : r[15] / 64 % 2},
        {"withheld", true, late ? r[15] / 4 % 2 : r[15] / 128},
        {"overlap", late, r[15] / 8 % 2},
        {"scanner_channel", late, r[15] / 16 % 4},
        {"user_data", true, r[17]},
        {"scan_angle", true, late ? (float)(0.006 * (int16_t)las_get(r + 18, 2)) : (double)(int8_t)r[16]},
        {"point_source_id", true, (double)las_get(r + (late ? 20 : 18), 2)},
        {"gps_time", late || f % 2 || f == 4, las_get_f64(r + (late ? 22 : 20))},
        {"color", f == 2 || f == 3 || f == 5 || f == 7 || f == 8 || f == 10,
         (double)las_get(r +
                             (late     ? 30
                              : f == 2 ? 20
                                       : 28) +
                             2 * c,
                         2)},
        {"nir", f == 8 || f == 10, (double)las_get(r + (late ? 36 : 0), 2)},
    };
    for (size_t k = 0; k < sizeof fields / sizeof *fields; k++)
        if (strcmp(fields[k].name, name) == 0 && fields[k].there) {
            *value = fields[k].value;
            return true;
        }
    return false;
}

enum { LAS_FIELD_COUNT = 17 };
static const char *const las_fields[LAS_FIELD_COUNT] = {"intensity",
                                                        "return_number",
                                                        "number_of_returns",
                                                        "scan_direction_flag",
                                                        "edge_of_flight_line",
                                                        "classification",
                                                        "synthetic",
                                                        "key_point",
                                                        "withheld",
                                                        "overlap",
                                                        "scanner_channel",
                                                        "user_data",
                                                        "scan_angle",
                                                        "point_source_id",
                                                        "gps_time",
                                                        "color",
                                                        "nir"};

static inline ewa_cloud *las_load(ewa_context *context, const las_sample *s) {
    ewa_cloud *cloud = NULL;
    const ewa_status status = ewa_cloud_load_memory(context, s->bytes, s->size_bytes, "made.las", &cloud);
    if (status != EWA_OK) fail_msg("format %u: %s", s->format, ewa_status_name(status));
    return cloud;
}

static inline double las_value(const ewa_cloud *cloud, const char *name, uint64_t i, uint32_t c) {
    const ewa_attribute *attribute = ewa_cloud_find(cloud, name);
    if (!attribute) fail_msg("no attribute '%s'", name);
    double values[4];
    ewa_attribute_read_f64(attribute, i, 1, values);
    return values[c];
}

/// World coordinates as decimals.
static inline double las_world(const ewa_cloud *cloud, uint64_t i, uint32_t c) {
    double origin_world[3];
    ewa_coordinate_grid grid;
    ewa_cloud_origin(cloud, origin_world);
    ewa_cloud_grid(cloud, &grid);
    return ewa_grid_world(&grid, c, las_value(cloud, EWA_POSITION, i, c) + origin_world[c]);
}

/// Holds all that two clouds know of their points to each other.
static inline void las_compare(const ewa_cloud *a, const ewa_cloud *b) {
    assert_int_equal(ewa_cloud_point_count(a), ewa_cloud_point_count(b));
    const uint64_t count = ewa_cloud_point_count(a);
    for (uint32_t k = 0; k < ewa_cloud_attribute_count(a); k++) {
        const ewa_attribute *left = ewa_cloud_attribute_at(a, k), *right = ewa_cloud_find(b, left->name);
        if (!right) fail_msg("'%s' is lost", left->name);
        if (left->type != right->type || left->component_count != right->component_count)
            fail_msg("'%s' is of another type", left->name);
        for (uint64_t i = 0; i < count; i++) {
            double x[4], y[4];
            ewa_attribute_read_f64(left, i, 1, x);
            ewa_attribute_read_f64(right, i, 1, y);
            for (uint32_t c = 0; c < left->component_count; c++) {
                if (strcmp(left->name, EWA_POSITION) == 0) {
                    x[c] = las_world(a, i, c);
                    y[c] = las_world(b, i, c);
                }
                if (memcmp(&x[c], &y[c], sizeof x[c]) != 0 && (x[c] == x[c] || y[c] == y[c]))
                    fail_msg("'%s' %u of point %d: %.17g, %.17g", left->name, c, (int)i, x[c], y[c]);
            }
        }
    }
}

#endif
