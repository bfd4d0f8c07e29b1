// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How assets are filled in, kind by kind.
#ifndef EWA_SRC_SCENE_ASSET_H
#define EWA_SRC_SCENE_ASSET_H

#include "scene/parts.h"

/// What an asset is filled in with; `options` are complete.
typedef struct ewa_asset_job {
    ewa_asset *asset;
    const ewa_asset_options *options;
} ewa_asset_job;

/// Takes over a set of Gaussians, which is needed no more afterwards, as splats or as a cloud. `up_world` zeros: as such
/// files have it.
ewa_status ewa_asset_take_gaussians(const ewa_asset_job *job, ewa_gaussians *set, const double up_world[3]);

/// Takes over what a file of points or triangles holds.
ewa_status ewa_asset_take_model(const ewa_asset_job *job, ewa_model *model);

/// Takes the unit of a cloud's lengths, which a map that changes lengths ends.
void ewa_asset_take_unit(ewa_asset *asset, const ewa_cloud *cloud);

/// Makes points on the faces of a mesh.
ewa_status ewa_asset_sample_mesh(const ewa_asset_job *job, const ewa_mesh *mesh);

/// Takes over a cloud, which is the asset's own, by the filter and the map of the options; degrees that no map moves
/// become metres. After a failure the asset still owns it.
ewa_status ewa_asset_take_cloud(const ewa_asset_job *job, ewa_cloud *cloud);

/// Makes voxels of a volume, whose axes may be changed, by a transfer function, or, where that is NULL, by the options.
ewa_status ewa_asset_take_volume(const ewa_asset_job *job, const ewa_transfer *given, ewa_volume *volume);

/// Puts the map of an asset before the one of the voxels' indices.
void ewa_asset_move_volume(const double to_world[16], ewa_volume *volume);

/// The named view that suits a volume.
int ewa_asset_view_of_volume(const ewa_volume *volume);

/// Reads what of an octree stands for the whole, and has it look as the asset's options say.
ewa_status ewa_asset_take_octree(const ewa_asset_job *job, ewa_lod *lod);

/// Makes the outline of resident surfels: their places and radii.
ewa_status ewa_asset_outline_surfels(ewa_context *context, const ewa_surfels *surfels, ewa_cloud **outline);

#endif
