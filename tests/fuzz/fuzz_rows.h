// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What holds of every reader of text, whatever the bytes: with and without keep_going, at once and in pieces, by
// one thread and by several, the points are the same.
#ifndef EWA_TESTS_FUZZ_ROWS_H
#define EWA_TESTS_FUZZ_ROWS_H

#include "cloud/cloud.h"
#include "ewa/ewa.h"
#include "fuzz.h"
#include "io/cloud/format.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MAX_WRITTEN = 1 << 14 };

static inline void require_same(const ewa_cloud *a, const ewa_cloud *b) {
    fuzz_require(ewa_cloud_point_count(a) == ewa_cloud_point_count(b), "as many points");
    fuzz_require(ewa_cloud_attribute_count(a) == ewa_cloud_attribute_count(b), "as many attributes");
    for (uint32_t i = 0; i < ewa_cloud_attribute_count(a); i++) {
        const ewa_attribute *left = ewa_cloud_attribute_at(a, i), *right = ewa_cloud_attribute_at(b, i);
        fuzz_require(strcmp(left->name, right->name) == 0 && left->type == right->type,
                     "the same attributes");
        fuzz_require(memcmp(left->data, right->data, ewa_cloud_point_count(a) * left->stride_bytes) == 0,
                     "the same numbers");
    }
}

/// Reads all points, at once, or by a few at a time when `maximum` is not 0.
static inline ewa_status read_rows(const ewa_cloud_source *source, const ewa_cloud_format *format,
                                   uint64_t maximum, ewa_cloud **cloud) {
    if (maximum == 0) return ewa_cloud_read_all(source, format, cloud);
    ewa_cloud *prototype = NULL;
    uint64_t point_count = 0, count = 0, got = 0;
    void *state = NULL;
    *cloud = NULL;
    fuzz_require(ewa_cloud_create(source->context, 0, &prototype) == EWA_OK, "a prototype");
    ewa_status status = format->open(source, prototype, &point_count, &state);
    fuzz_require((status == EWA_OK) == (state != NULL), "a state on success only");
    ewa_cloud_sink sinks[300];
    if (status == EWA_OK)
        status = ewa_cloud_make_room(source->name, prototype, NULL, point_count, cloud, sinks);
    while (status == EWA_OK) {
        const uint64_t room = point_count - count < maximum ? point_count - count : maximum;
        if (room == 0) break;
        status = format->read(state, room, sinks, &got);
        fuzz_require(got <= room, "no more points than there is room for");
        if (got == 0) break;
        count += got;
        for (uint32_t i = 0; i < ewa_cloud_attribute_count(prototype); i++)
            sinks[i].to += got * sinks[i].stride_bytes;
    }
    if (status == EWA_OK)
        ewa_cloud_truncate(*cloud, count);
    else
        ewa_cloud_destroy(cloud);
    format->close(state);
    ewa_cloud_destroy(&prototype);
    return status;
}

/// Whether a second cloud failed for the room that the first one holds.
static inline bool lacks_memory(ewa_status status) {
    return status == EWA_ERROR_LIMIT || status == EWA_ERROR_MEMORY;
}

/// Tries one input.
static inline int try_rows(const ewa_cloud_format *format, const uint8_t *bytes, size_t size_bytes) {
    int errors = 0;
    ewa_context *context = fuzz_context(1, 0, &errors);
    format->probe("input", bytes, size_bytes);
    WITH_DEFAULTS(ewa_cloud_load_options, options);
    uint64_t lost_count = 0;
    ewa_cloud_source source = {.context = context,
                               .name = "input",
                               .bytes = bytes,
                               .size_bytes = size_bytes,
                               .options = &options,
                               .lost_count = &lost_count};
    ewa_cloud *strict = NULL, *going = NULL, *pieces = NULL, *back = NULL;
    const ewa_status status = read_rows(&source, format, 0, &strict);
    fuzz_require((status == EWA_OK) == (strict != NULL), "a cloud on success only");
    fuzz_require((status == EWA_OK) == (errors == 0), "a message on failure only");
    options.keep_going = true;
    const ewa_status kept = read_rows(&source, format, 0, &going);
    fuzz_require(status != EWA_OK || kept == EWA_OK || lacks_memory(kept),
                 "what is right is read with keep_going too");
    if (kept == EWA_OK) {
        const ewa_status again = read_rows(&source, format, 3, &pieces);
        fuzz_require(again == EWA_OK || lacks_memory(again), "in pieces as at once");
    }
    if (strict && going) require_same(strict, going);
    if (going) {
        if (pieces) require_same(going, pieces);
        char path[64];
        snprintf(path, sizeof path, "/tmp/ewa-fuzz-%ld.csv", (long)getpid());
        errors = 0;
        // What a small file unpacks to takes longer to write in decimals and to read again than to unpack.
        const uint64_t count = ewa_cloud_point_count(going);
        if (count > 0 && count <= MAX_WRITTEN && ewa_cloud_save(going, path, NULL) == EWA_OK) {
            fuzz_require(ewa_cloud_load(context, path, &back) == EWA_OK, "what was written can be read");
            fuzz_require(ewa_cloud_point_count(back) == count, "all of it");
        }
        unlink(path);
    }
    ewa_cloud_destroy(&strict);
    ewa_cloud_destroy(&going);
    ewa_cloud_destroy(&pieces);
    ewa_cloud_destroy(&back);
    ewa_context_destroy(&context);
    return 0;
}

#endif
