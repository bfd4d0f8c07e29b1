// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Several files as one stream of pieces.
#include "lod/inputs.h"
#include "cloud/cloud.h"

#include <math.h>
#include <string.h>

static ewa_status add_prototype(ewa_inputs *inputs, const ewa_cloud *prototype) {
    ewa_coordinate_grid grid;
    ewa_cloud_grid(prototype, &grid);
    for (int c = 0; c < 3; c++) {
        inputs->has_grid &= grid.step_world[c] > 0;
        if (grid.step_world[c] > 0) inputs->min_step_world = fmin(inputs->min_step_world, grid.step_world[c]);
    }
    if (!inputs->prototype) return ewa_cloud_like(prototype, &inputs->prototype);
    if (ewa_cloud_is_alike(inputs->prototype, prototype)) return EWA_OK;
    const ewa_cloud *both[2] = {inputs->prototype, prototype};
    ewa_cloud *merged = NULL;
    EWA_TRY(ewa_cloud_merge(both, 2, &merged));
    ewa_cloud_destroy(&inputs->prototype);
    inputs->prototype = merged;
    return EWA_OK;
}

ewa_status ewa_inputs_open(ewa_context *context, const char *const *paths, uint32_t path_count,
                           bool keep_going, ewa_inputs *inputs) {
    *inputs = (ewa_inputs){.context = context,
                           .paths = paths,
                           .path_count = path_count,
                           .has_grid = true,
                           .min_step_world = INFINITY};
    ewa_cloud_load_options_init(&inputs->options, sizeof inputs->options);
    inputs->options.keep_going = keep_going;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < path_count && status == EWA_OK; i++) {
        ewa_cloud_reader *reader = NULL;
        EWA_TRY(strcmp(paths[i], "-") == 0
                    ? ewa_fail(context, EWA_ERROR_UNSUPPORTED, "standard input cannot be read twice")
                    : ewa_cloud_reader_open(context, paths[i], &inputs->options, &reader));
        inputs->max_points += ewa_cloud_reader_maximum_points(reader);
        status = add_prototype(inputs, ewa_cloud_reader_prototype(reader));
        ewa_cloud_reader_close(&reader);
    }
    const ewa_attribute *position = status == EWA_OK ? ewa_cloud_find(inputs->prototype, EWA_POSITION) : NULL;
    if (status == EWA_OK && (!position || position->component_count != 3))
        status = ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: no positions of three components", paths[0]);
    return status;
}

void ewa_inputs_free(ewa_inputs *inputs) { ewa_cloud_destroy(&inputs->prototype); }

/// Gives a piece the attributes of all files.
static ewa_status conform(const ewa_inputs *inputs, ewa_cloud **piece) {
    if (ewa_cloud_is_alike(inputs->prototype, *piece)) return EWA_OK;
    const ewa_cloud *both[2] = {inputs->prototype, *piece};
    ewa_cloud *merged = NULL;
    EWA_TRY(ewa_cloud_merge(both, 2, &merged));
    ewa_cloud_destroy(piece);
    *piece = merged;
    return EWA_OK;
}

ewa_status ewa_inputs_read(const ewa_inputs *inputs, const char *stage, ewa_piece_callback *take,
                           void *user) {
    uint64_t done = 0;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < inputs->path_count && status == EWA_OK; i++) {
        ewa_cloud_reader *reader = NULL;
        ewa_cloud *piece = NULL;
        status = ewa_cloud_reader_open(inputs->context, inputs->paths[i], &inputs->options, &reader);
        while (status == EWA_OK) {
            status = ewa_cloud_reader_next(reader, EWA_INPUT_PIECE_POINTS, &piece);
            if (status != EWA_OK || !piece) break;
            done += ewa_cloud_point_count(piece);
            status = conform(inputs, &piece);
            if (status == EWA_OK) status = take(user, piece);
            ewa_cloud_destroy(&piece);
            if (status == EWA_OK)
                status = ewa_progress(inputs->context, stage, (double)done / (double)inputs->max_points);
        }
        ewa_cloud_reader_close(&reader);
    }
    return status;
}
