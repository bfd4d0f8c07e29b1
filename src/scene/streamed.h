// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Streamed Gaussians in scenes: an asset knows where the levels of their leaves are, and a renderer has in memory what its pictures need.
#ifndef EWA_SRC_SCENE_STREAMED_H
#define EWA_SRC_SCENE_STREAMED_H

#include "io/gaussian/streamed.h"
#include "scene/asset.h"
#include "scene/draw.h"

/// The levels of an asset's leaves; immutable once it is there.
struct ewa_asset_stream {
    ewa_context *context;
    ewa_streamed file;  ///< with boxes of its leaves where the asset is in the scene
    double *spacing_world; ///< [range_count] of each range the RMS distance of the finest Gaussians from what stands for them, world units
    uint64_t count;     ///< of the finest
    size_t bytes_each;  ///< that a Gaussian takes in memory
};

/// Fills an asset of lod-meta.json: its coarsest level, which stands for the whole in all but pictures, and where the others are. Files of other
/// forms are not taken.
ewa_status ewa_asset_stream_gaussians(const ewa_asset_job *job, const char *path, bool *taken);
void ewa_asset_stream_free(ewa_asset_stream **stream);

/// Puts into the place of assets that are streamed the levels of those of their leaves that a picture shows: of each the coarsest that is within
/// `merge_px` of the finest, and where that would be more than `memory_bytes` or `max_splats` of the options of levels, coarser ones. Reads
/// those that are not in memory, for `load_s` where that is given. Errors: those of ewa_streamed_read_file().
ewa_status ewa_streams_choose(const ewa_scene *scene, ewa_scene_renderer *renderer, const ewa_camera *camera,
                              const ewa_scene_options *options, ewa_scene_shown *shown, ewa_lod_stats *stats);

#endif
