// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target of the PLY reader and writer: any bytes may be given; what is read can be written in every
// encoding and reads back the same.
#include "ewa/ewa.h"
#include "fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/// The numbers of both; equal bits, or both NaN, whose bits ascii does not keep.
static void compare(const ewa_cloud *a, const ewa_cloud *b) {
    fuzz_require(ewa_cloud_point_count(a) == ewa_cloud_point_count(b), "as many points");
    fuzz_require(ewa_cloud_attribute_count(a) == ewa_cloud_attribute_count(b), "as many attributes");
    double a_origin[3], b_origin[3];
    ewa_cloud_origin(a, a_origin);
    ewa_cloud_origin(b, b_origin);
    ewa_coordinate_grid grid;
    ewa_cloud_grid(a, &grid);
    const bool on_grid = grid.step_world[0] > 0 || grid.step_world[1] > 0 || grid.step_world[2] > 0;
    for (uint32_t i = 0; i < ewa_cloud_attribute_count(a); i++) {
        // PLY has what it has names for before all else.
        const ewa_attribute *left = ewa_cloud_attribute_at(a, i), *right = ewa_cloud_find(b, left->name);
        fuzz_require(right != NULL, "the same names");
        // Other formats than PLY, which any bytes may be, choose other origins, and other roundings with them.
        // Places on a grid, which text has too, are written as the grid's, nearest to what they are. What the
        // sum with the origin loses, a place may lose.
        const bool is_place = strcmp(left->name, EWA_POSITION) == 0;
        if (is_place && (on_grid || memcmp(a_origin, b_origin, sizeof a_origin) != 0)) continue;
        fuzz_require(left->type == right->type && left->component_count == right->component_count,
                     "the same types");
        for (uint64_t point = 0; point < ewa_cloud_point_count(a); point++) {
            double x[4], y[4];
            ewa_attribute_read_f64(left, point, 1, x);
            ewa_attribute_read_f64(right, point, 1, y);
            for (uint32_t c = 0; c < left->component_count; c++)
                fuzz_require(memcmp(&x[c], &y[c], sizeof x[c]) == 0 || (x[c] != x[c] && y[c] != y[c]) ||
                                 (is_place && a_origin[c] + x[c] == b_origin[c] + y[c]),
                             "the same numbers");
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    int errors = 0;
    ewa_context *context = fuzz_context(1, 0, &errors);
    ewa_cloud *cloud = NULL;
    const ewa_status status = ewa_cloud_load_memory(context, bytes, size_bytes, "input", &cloud);
    fuzz_require((status == EWA_OK) == (cloud != NULL), "a cloud on success only");
    fuzz_require((status == EWA_OK) == (errors == 0), "a message on failure only");
    for (int encoding = 0; cloud && encoding < 3; encoding++) {
        char path[64];
        snprintf(path, sizeof path, "/tmp/ewa-fuzz-%ld.ply", (long)getpid());
        WITH_DEFAULTS(ewa_cloud_save_options, save_options);
        save_options.ply_encoding = (ewa_ply_encoding)encoding;
        ewa_cloud *back = NULL;
        fuzz_require(ewa_cloud_save(cloud, path, &save_options) == EWA_OK, "what was read can be written");
        fuzz_require(ewa_cloud_load(context, path, &back) == EWA_OK, "what was written can be read");
        unlink(path);
        compare(cloud, back);
        ewa_cloud_destroy(&back);
    }
    ewa_cloud_destroy(&cloud);
    ewa_context_destroy(&context);
    return 0;
}
