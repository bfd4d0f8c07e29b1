// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What tests of generated objects share.
#ifndef EWA_TESTS_CHECK_GENERATED_H
#define EWA_TESTS_CHECK_GENERATED_H

#include "check.h"

#include <stdbool.h>

static inline ewa_generate_options check_generate_options(ewa_object object, uint64_t point_count) {
    WITH_DEFAULTS(ewa_generate_options, options);
    options.object = object;
    options.point_count = point_count;
    return options;
}

static inline ewa_cloud *check_generated(ewa_context *context, const ewa_generate_options *options) {
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_generate(context, options, &cloud), EWA_OK);
    return cloud;
}

/// Points of a generated object.
static inline ewa_cloud *check_object(ewa_context *context, ewa_object object, uint64_t point_count) {
    const ewa_generate_options options = check_generate_options(object, point_count);
    return check_generated(context, &options);
}

/// FNV-1a over all attributes.
static inline uint64_t check_cloud_hash(const ewa_cloud *cloud) {
    uint64_t hash = 0xcbf29ce484222325u;
    for (uint32_t a = 0; a < ewa_cloud_attribute_count(cloud); a++) {
        const ewa_attribute *attribute = ewa_cloud_attribute_at(cloud, a);
        const uint8_t *bytes = attribute->data;
        const size_t size = attribute->stride_bytes * (size_t)ewa_cloud_point_count(cloud);
        for (size_t i = 0; i < size; i++) hash = (hash ^ bytes[i]) * 0x100000001b3u;
    }
    return hash;
}

/// Generates with the first, second, ... allocation failing, until none does: an error each time, and nothing is kept.
static inline void check_generate_without_memory(const ewa_generate_options *options) {
    for (int fail_at = 0;; fail_at++) {
        check_memory memory = {.calls_left = -1};
        ewa_context *context = check_context_on(0, &memory);
        const int64_t before = memory.held_bytes;
        memory.calls_left = fail_at;
        ewa_cloud *cloud = NULL;
        const ewa_status status = ewa_cloud_generate(context, options, &cloud);
        const bool failed = memory.calls_left < 0;
        assert_int_equal(status, failed ? EWA_ERROR_MEMORY : EWA_OK);
        ewa_cloud_destroy(&cloud);
        assert_int_equal(memory.held_bytes, before);
        ewa_context_destroy(&context);
        if (!failed) break;
    }
}

#endif
