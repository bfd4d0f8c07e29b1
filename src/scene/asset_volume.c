// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Assets of volumes: the transfer function, voxels, from where they are seen.
#include "base/base.h"
#include "ewa/io.h"
#include "ewa/prepare.h"
#include "framing/conventions.h"
#include "image/volume_upright.h"
#include "scene/asset.h"

#include <math.h>
#include <string.h>

/// How many times as wide as thick a volume is when it is a slice or a picture.
static const double SLICE_RATIO = 8;

/// A patient is seen from the front, a slice from where it is not a line (a picture upright), and what
/// nothing is known of from a corner, which shows most of any shape.
int ewa_asset_view_of_volume(const ewa_volume *volume) {
    double thickness = INFINITY, width = INFINITY;
    int thin = 0, single_count = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double *m = volume->index_to_world + axis;
        const bool single = volume->dims[axis] == 1;
        const double extent = single ? 0 : volume->dims[axis] * hypot(hypot(m[0], m[4]), m[8]);
        single_count += single;
        if (extent < thickness) {
            width = thickness;
            thickness = extent;
            thin = axis;
        } else if (extent < width) {
            width = extent;
        }
    }
    const double *m = volume->index_to_world + thin;
    const double x = fabs(m[0]), y = fabs(m[4]), z = fabs(m[8]);
    if (single_count < 2 && width > SLICE_RATIO * thickness)
        return z >= x && z >= y ? EWA_VIEW_BOTTOM : x > y ? EWA_VIEW_LEFT : EWA_VIEW_FRONT;
    return volume->anatomical ? EWA_VIEW_FRONT : EWA_VIEW_ISO;
}

void ewa_asset_move_volume(const double to_world[16], ewa_volume *volume) {
    double moved[12];
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++) {
            double sum = c == 3 ? to_world[4 * r + 3] : 0;
            for (int k = 0; k < 3; k++) sum += to_world[4 * r + k] * volume->index_to_world[4 * k + c];
            moved[4 * r + c] = sum;
        }
    memcpy(volume->index_to_world, moved, sizeof moved);
}

ewa_status ewa_asset_take_volume(const ewa_asset_job *job, const ewa_transfer *given, ewa_volume *volume) {
    ewa_asset *asset = job->asset;
    ewa_context *context = asset->context;
    const char *word = asset->transfer;
    asset->kind = EWA_ASSET_VOLUME;
    asset->flat = asset->source.flat || (word && (strcmp(word, "fog") == 0 || strcmp(word, "gray") == 0));
    memcpy(asset->up_world, ewa_up_of_volumes, sizeof asset->up_world);
    ewa_asset_move_volume(asset->to_world, volume);
    // A file that knows its patient knows what is up.
    if (!volume->anatomical) EWA_TRY(ewa_volume_find_up(volume, asset->up_world, &asset->up_why));
    ewa_transfer *chosen = given ? NULL : ewa_allocate(context, 1, sizeof *chosen);
    if (!given && !chosen) return EWA_ERROR_MEMORY;
    const ewa_transfer *transfer = given ? given : chosen;
    ewa_voxels_options options;
    ewa_voxels_options_init(&options, sizeof options);
    options.level_count = job->options->voxel_level_count;
    if (options.level_count < job->options->voxel_level_minimum) options.level_count = job->options->voxel_level_minimum;
    ewa_status status = given ? EWA_OK : ewa_transfer_choose(context, word, volume, chosen);
    if (status == EWA_OK) status = ewa_voxels_create(volume, transfer, &options, &asset->voxels);
    if (status == EWA_OK)
        status = ewa_volume_outline(volume, transfer, job->options->reach_steps, &asset->outline);
    ewa_release(context, chosen, 1, sizeof *chosen);
    EWA_TRY(status);
    ewa_voxels_info info;
    ewa_voxels_describe(asset->voxels, &info);
    if (!info.occupied_count)
        ewa_report(context, EWA_SEVERITY_WARNING, "the transfer function leaves all voxels empty");
    asset->count = info.voxel_count;
    asset->bounds = info.bounds;
    asset->view = ewa_asset_view_of_volume(volume);
    return EWA_OK;
}
