// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// PLY files made in memory, number by number and independently of the library's writer.
#ifndef EWA_TESTS_PLY_SAMPLE_H
#define EWA_TESTS_PLY_SAMPLE_H

#include "check.h"

#include <string.h>

static const char *const sample_formats[] = {"binary_little_endian", "binary_big_endian", "ascii"};

typedef struct sample {
    ewa_ply_encoding encoding;
    const char *line_end;
    uint8_t *bytes;
    size_t size, capacity;
} sample;

static inline void sample_bytes(sample *s, const void *bytes, size_t size) {
    if (s->size + size > s->capacity) {
        s->capacity = 2 * (s->size + size);
        s->bytes = realloc(s->bytes, s->capacity);
        assert_non_null(s->bytes);
    }
    memcpy(s->bytes + s->size, bytes, size);
    s->size += size;
}

static inline void sample_text(sample *s, const char *text) { sample_bytes(s, text, strlen(text)); }

/// One line of the header, with the line end of the sample.
static inline void sample_line(sample *s, const char *text) {
    sample_text(s, text);
    sample_text(s, s->line_end);
}

static inline sample sample_start(ewa_ply_encoding encoding, const char *line_end) {
    sample s = {.encoding = encoding, .line_end = line_end};
    char format[64];
    snprintf(format, sizeof format, "format %s 1.0", sample_formats[encoding]);
    sample_line(&s, "ply");
    sample_line(&s, format);
    return s;
}

/// One number as the encoding has it; in ascii with a blank before it.
static inline void sample_number(sample *s, ewa_type type, double value) {
    if (s->encoding == EWA_PLY_ASCII) {
        char text[64];
        const bool real = type == EWA_F32 || type == EWA_F64;
        snprintf(text, sizeof text, real ? " %.17g" : " %.0f", value);
        sample_text(s, text);
        return;
    }
    uint8_t bytes[8];
    const size_t size = ewa_type_bytes(type);
    float f32;
    uint64_t bits;
    switch (type) {
    case EWA_F32:
        f32 = (float)value;
        bits = 0;
        memcpy(&bits, &f32, sizeof f32);
        break;
    case EWA_F64:
        memcpy(&bits, &value, sizeof bits);
        break;
    default:
        bits = (uint64_t)(int64_t)value;
    }
    for (size_t i = 0; i < size; i++)
        bytes[s->encoding == EWA_PLY_BINARY_LITTLE_ENDIAN ? i : size - 1 - i] = (uint8_t)(bits >> 8 * i);
    sample_bytes(s, bytes, size);
}

/// The end of a record.
static inline void sample_record_end(sample *s) {
    if (s->encoding == EWA_PLY_ASCII) sample_text(s, s->line_end);
}

/// Loads from an exact copy, so that a sanitizer sees every byte too many.
static inline ewa_status sample_load_bytes(ewa_context *context, const void *bytes, size_t size,
                                           ewa_cloud **cloud) {
    uint8_t *copy = malloc(size ? size : 1);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    const ewa_status status = ewa_cloud_load_memory(context, copy, size, "sample.ply", cloud);
    assert_true((status == EWA_OK) == (*cloud != NULL));
    free(copy);
    return status;
}

/// Loads a sample and frees it.
static inline ewa_status sample_load(ewa_context *context, sample *s, ewa_cloud **cloud) {
    const ewa_status status = sample_load_bytes(context, s->bytes, s->size, cloud);
    free(s->bytes);
    *s = (sample){0};
    return status;
}

static inline ewa_status sample_load_text(ewa_context *context, const char *text, ewa_cloud **cloud) {
    return sample_load_bytes(context, text, strlen(text), cloud);
}

/// Component `c` of a point of an attribute that has to be there with that type and component count; of
/// positions, in the world.
static inline double sample_value(const ewa_cloud *cloud, const char *name, ewa_type type,
                                  uint32_t components, uint64_t point, uint32_t c) {
    const ewa_attribute *attribute = ewa_cloud_find(cloud, name);
    if (!attribute) fail_msg("no attribute '%s'", name);
    if (attribute->type != type || attribute->component_count != components)
        fail_msg("'%s' is %s x %u, not %s x %u", name, ewa_type_name(attribute->type),
                 attribute->component_count, ewa_type_name(type), components);
    double values[4], origin_world[3];
    ewa_attribute_read_f64(attribute, point, 1, values);
    ewa_cloud_origin(cloud, origin_world);
    const bool moved = strcmp(name, EWA_POSITION) == 0 && c < 3 && origin_world[c] != 0;
    return moved ? values[c] + origin_world[c] : values[c]; // -0 stays
}

static inline void assert_same_bits(double a, double b) {
    if (memcmp(&a, &b, sizeof a) != 0 && !(a != a && b != b)) fail_msg("%.17g is not %.17g", a, b);
}

/// The same attributes in the same order with the same numbers; NaN equals NaN.
static inline void assert_same_cloud(const ewa_cloud *a, const ewa_cloud *b) {
    assert_true(ewa_cloud_point_count(a) == ewa_cloud_point_count(b));
    assert_int_equal(ewa_cloud_attribute_count(a), ewa_cloud_attribute_count(b));
    for (uint32_t i = 0; i < ewa_cloud_attribute_count(a); i++) {
        const ewa_attribute *left = ewa_cloud_attribute_at(a, i), *right = ewa_cloud_attribute_at(b, i);
        assert_string_equal(left->name, right->name);
        assert_int_equal(left->type, right->type);
        assert_int_equal(left->component_count, right->component_count);
        for (uint64_t point = 0; point < ewa_cloud_point_count(a); point++) {
            double x[4], y[4];
            ewa_attribute_read_f64(left, point, 1, x);
            ewa_attribute_read_f64(right, point, 1, y);
            for (uint32_t c = 0; c < left->component_count; c++) assert_same_bits(x[c], y[c]);
        }
    }
}

#endif
