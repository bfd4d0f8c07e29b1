// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the fuzz targets of clouds' formats share: one format reads any bytes, in pieces.
#ifndef EWA_TESTS_FUZZ_CLOUD_H
#define EWA_TESTS_FUZZ_CLOUD_H

#include "ewa/ewa.h"
#include "fuzz.h"
#include "io/cloud/format.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Reads all points, at most `maximum` at a time, into memory that ends with them.
static inline ewa_status fuzz_cloud_pieces(const ewa_cloud_source *source, const ewa_cloud_format *format,
                                           uint64_t maximum) {
    enum { MAX_ATTRIBUTES = 1100 };
    ewa_cloud *prototype = NULL;
    fuzz_require(ewa_cloud_create(source->context, 0, &prototype) == EWA_OK, "a prototype");
    uint64_t point_count = 0, read_count = 0, got_count = 1;
    void *state = NULL;
    ewa_status status = format->open(source, prototype, &point_count, &state);
    fuzz_require((status == EWA_OK) == (state != NULL), "a state on success only");
    const uint32_t attribute_count = ewa_cloud_attribute_count(prototype);
    fuzz_require(attribute_count <= MAX_ATTRIBUTES, "not too many attributes");
    while (status == EWA_OK && got_count) {
        ewa_cloud_sink sinks[MAX_ATTRIBUTES];
        for (uint32_t i = 0; i < attribute_count; i++) {
            const ewa_attribute *a = ewa_cloud_attribute_at(prototype, i);
            const size_t stride = a->component_count * ewa_type_bytes(a->type);
            sinks[i] = (ewa_cloud_sink){malloc(maximum * stride), stride};
        }
        status = format->read(state, maximum, sinks, &got_count);
        for (uint32_t i = 0; i < attribute_count; i++) free(sinks[i].to);
        if (status != EWA_OK) break;
        fuzz_require(got_count <= maximum, "no more than are wanted");
        read_count += got_count;
        fuzz_require(read_count <= point_count, "no more than were announced");
    }
    format->close(state);
    ewa_cloud_destroy(&prototype);
    return status;
}

static inline void fuzz_cloud(const ewa_cloud_format *format, const char *name, const uint8_t *bytes,
                              size_t size_bytes) {
    static const uint64_t maximum[2] = {4096, 100};
    for (int keep_going = 0; keep_going < 2; keep_going++) {
        int errors = 0;
        uint64_t lost_count = 0;
        ewa_context *context = fuzz_context(1, 0, &errors);
        WITH_DEFAULTS(ewa_cloud_load_options, load);
        load.keep_going = keep_going;
        const ewa_cloud_source source = {.context = context,
                                         .name = name,
                                         .bytes = bytes,
                                         .size_bytes = size_bytes,
                                         .options = &load,
                                         .lost_count = &lost_count};
        const ewa_status status = fuzz_cloud_pieces(&source, format, maximum[keep_going]);
        fuzz_require((status == EWA_OK) == (errors == 0), "a message on failure only");
        fuzz_require(keep_going || lost_count == 0, "nothing is lost without a word");
        ewa_context_destroy(&context);
    }
}

#endif
