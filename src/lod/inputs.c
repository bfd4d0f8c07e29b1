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
                           bool keep_going, uint64_t keep_bytes, ewa_inputs *inputs) {
    *inputs = (ewa_inputs){.context = context,
                           .keep_bytes = keep_bytes,
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

/// Frees the pieces that were kept from number `first` on.
static void forget_from(ewa_inputs *inputs, uint32_t first) {
    while (inputs->kept_count > first) ewa_cloud_destroy(&inputs->kept[--inputs->kept_count]);
}

void ewa_inputs_forget(ewa_inputs *inputs) {
    forget_from(inputs, 0);
    ewa_buffer buffer = {inputs->kept, inputs->kept_capacity_bytes};
    ewa_buffer_free(inputs->context, &buffer);
    inputs->kept = NULL, inputs->kept_capacity_bytes = 0;
    inputs->kept_bytes = inputs->kept_files = 0;
}

void ewa_inputs_free(ewa_inputs *inputs) {
    ewa_inputs_forget(inputs);
    ewa_cloud_destroy(&inputs->prototype);
}

/// Bytes of a piece's numbers; 0: some are a file's own memory, and end with its reader.
static uint64_t bytes_of(const ewa_cloud *piece) {
    uint64_t bytes = 0;
    for (uint32_t a = 0; a < ewa_cloud_attribute_count(piece); a++) {
        const ewa_attribute *attribute = ewa_cloud_attribute_at(piece, a);
        if (attribute->borrowed) return 0;
        bytes += ewa_cloud_point_count(piece) * attribute->stride_bytes;
    }
    return bytes;
}

/// Takes a piece into those that are kept; returns whether it was.
static bool keep(ewa_inputs *inputs, ewa_cloud **piece) {
    const uint64_t bytes = bytes_of(*piece);
    if (!bytes || bytes > inputs->keep_bytes - inputs->kept_bytes) return false;
    ewa_buffer buffer = {inputs->kept, inputs->kept_capacity_bytes};
    const ewa_status status =
        ewa_buffer_grow(inputs->context, &buffer, inputs->kept_count, (size_t)inputs->kept_count + 1, sizeof *inputs->kept);
    inputs->kept = buffer.data, inputs->kept_capacity_bytes = buffer.capacity_bytes;
    if (status != EWA_OK) return false;
    inputs->kept[inputs->kept_count++] = *piece;
    inputs->kept_bytes += bytes;
    *piece = NULL;
    return true;
}

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

/// What a reading has come to.
typedef struct reading {
    ewa_inputs *inputs;
    const char *stage;
    ewa_piece_callback *take;
    void *user;
    uint64_t done;
} reading;

static ewa_status take_piece(reading *r, const ewa_cloud *piece, uint64_t count) {
    r->done += count;
    EWA_TRY(r->take(r->user, piece));
    return ewa_progress(r->inputs->context, r->stage, (double)r->done / (double)r->inputs->max_points);
}

/// Whether all points of a file fit into what is left, as far as its head says.
static bool has_room(const ewa_inputs *inputs, const ewa_cloud_reader *reader) {
    uint64_t point_bytes = 1;
    for (uint32_t a = 0; a < ewa_cloud_attribute_count(inputs->prototype); a++) {
        const ewa_attribute *attribute = ewa_cloud_attribute_at(inputs->prototype, a);
        point_bytes += attribute->component_count * ewa_type_bytes(attribute->type);
    }
    return ewa_cloud_reader_maximum_points(reader) <= (inputs->keep_bytes - inputs->kept_bytes) / point_bytes;
}

/// Reads a file; keeps all of its pieces, as long as those of the files before it are kept, or none.
static ewa_status read_file(reading *r, uint32_t file) {
    ewa_inputs *inputs = r->inputs;
    ewa_cloud_reader *reader = NULL;
    ewa_cloud *piece = NULL;
    const uint32_t first_kept = inputs->kept_count;
    const uint64_t bytes_before = inputs->kept_bytes;
    bool keeps = inputs->kept_files == file;
    ewa_status status = ewa_cloud_reader_open(inputs->context, inputs->paths[file], &inputs->options, &reader);
    keeps = keeps && status == EWA_OK && has_room(inputs, reader);
    while (status == EWA_OK) {
        status = ewa_cloud_reader_next(reader, EWA_INPUT_PIECE_POINTS, &piece);
        if (status != EWA_OK || !piece) break;
        const uint64_t count = ewa_cloud_point_count(piece);
        status = conform(inputs, &piece);
        if (status == EWA_OK) status = take_piece(r, piece, count);
        if (keeps && status == EWA_OK && !(keeps = keep(inputs, &piece))) {
            forget_from(inputs, first_kept);
            inputs->kept_bytes = bytes_before;
        }
        ewa_cloud_destroy(&piece);
    }
    ewa_cloud_reader_close(&reader);
    if (keeps && status == EWA_OK) inputs->kept_files = file + 1;
    return status;
}

ewa_status ewa_inputs_read(ewa_inputs *inputs, const char *stage, ewa_piece_callback *take, void *user) {
    reading r = {inputs, stage, take, user, 0};
    ewa_status status = EWA_OK;
    for (uint32_t k = 0; k < inputs->kept_count && status == EWA_OK; k++)
        status = take_piece(&r, inputs->kept[k], ewa_cloud_point_count(inputs->kept[k]));
    for (uint32_t i = inputs->kept_files; i < inputs->path_count && status == EWA_OK; i++) status = read_file(&r, i);
    return status;
}
