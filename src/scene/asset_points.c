// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Assets of points: clouds, meshes that are sampled, Gaussians, octrees.
#include "base/base.h"
#include "ewa/diagnosis.h"
#include "ewa/prepare.h"
#include "scene/asset.h"

#include <math.h>
#include <string.h>

/// A mesh is drawn from at least so many points, and from so many per triangle.
static const uint64_t MESH_POINTS = 200000, MESH_POINTS_PER_TRIANGLE = 4;

/// Smallest cutoff that axes of a mesh's points are made for.
static const double MESH_CUTOFF = 1e-3;

static bool has_axes(const ewa_cloud *cloud) {
    return ewa_cloud_find(cloud, EWA_TANGENT_U) && ewa_cloud_find(cloud, EWA_TANGENT_V);
}

/// Whether a cloud has all that a surfel needs.
static bool is_drawable(const ewa_cloud *cloud) {
    return has_axes(cloud) || (ewa_cloud_find(cloud, EWA_NORMAL) && ewa_cloud_find(cloud, EWA_RADIUS));
}

/// Replaces a cloud by the points that a filter takes, at least one.
static ewa_status filter_points(ewa_context *context, const ewa_filter *filter, ewa_cloud **cloud) {
    const uint64_t count = ewa_cloud_point_count(*cloud);
    if (!filter || !filter->term_count) return EWA_OK;
    uint8_t *marks = ewa_allocate(context, count, 1);
    if (!marks) return EWA_ERROR_MEMORY;
    memset(marks, 1, count);
    ewa_cloud *chosen = NULL;
    ewa_status status = ewa_filter_mark(filter, *cloud, marks);
    if (status == EWA_OK && memchr(marks, 0, count)) status = ewa_cloud_keep(*cloud, marks, &chosen);
    ewa_release(context, marks, count, 1);
    if (!chosen) return status;
    ewa_report(context, EWA_SEVERITY_INFO, "%llu of %llu points are taken",
               (unsigned long long)ewa_cloud_point_count(chosen), (unsigned long long)count);
    ewa_cloud_destroy(cloud);
    *cloud = chosen;
    return EWA_OK;
}

ewa_status ewa_asset_take_cloud(const ewa_asset_job *job, ewa_cloud *cloud) {
    ewa_asset *asset = job->asset;
    asset->kind = EWA_ASSET_POINTS;
    asset->cloud = cloud;
    if (!ewa_cloud_find(cloud, EWA_POSITION))
        return ewa_fail(asset->context, EWA_ERROR_ARGUMENT, "the points have no positions");
    EWA_TRY(filter_points(asset->context, job->options->filter, &asset->cloud));
    static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    if (memcmp(asset->to_world, identity, sizeof identity) != 0)
        EWA_TRY(ewa_cloud_transform(asset->cloud, asset->to_world));
    asset->count = ewa_cloud_point_count(asset->cloud);
    asset->drawable = is_drawable(asset->cloud);
    ewa_status status = EWA_OK;
    if (!asset->drawable) {
        status = ewa_cloud_refuse_gaussians(asset->cloud);
        if (status == EWA_OK) ewa_cloud_drop_zero_normals(asset->cloud);
    }
    return status == EWA_OK && asset->count ? ewa_cloud_measure(asset->cloud, &asset->bounds) : status;
}

ewa_status ewa_asset_sample_mesh(const ewa_asset_job *job, const ewa_mesh *mesh) {
    ewa_context *context = job->asset->context;
    ewa_mesh_sample_options options;
    ewa_mesh_sample_options_init(&options, sizeof options);
    options.cutoff = fmax(job->options->cutoff, MESH_CUTOFF);
    options.point_count = MESH_POINTS_PER_TRIANGLE * mesh->triangle_count;
    if (options.point_count < MESH_POINTS) options.point_count = MESH_POINTS;
    options.texture_filter = EWA_TEXTURE_EWA; // least squares would take most of the time
    const double started_s = ewa_now_s();
    ewa_cloud *cloud = NULL;
    EWA_TRY(ewa_mesh_sample(mesh, &options, &cloud));
    ewa_report(context, EWA_SEVERITY_INFO,
               "%llu points on %u triangles in %.3f s; `ewa sample` has options for this",
               (unsigned long long)ewa_cloud_point_count(cloud), mesh->triangle_count,
               ewa_now_s() - started_s);
    ewa_status status = ewa_asset_take_cloud(job, cloud);
    job->asset->kind = EWA_ASSET_MESH;
    return status;
}

ewa_status ewa_asset_take_model(const ewa_asset_job *job, ewa_model *model) {
    ewa_context *context = job->asset->context;
    if (!model->points && model->mesh.triangle_count) return ewa_asset_sample_mesh(job, &model->mesh);
    if (!model->points || ewa_cloud_point_count(model->points) == 0)
        return ewa_fail(context, EWA_ERROR_FORMAT, "the file has no points");
    if (!model->face_count) { // the readers of meshes say so themselves
        ewa_cloud_check_steps(model->points);
        ewa_cloud_check_degrees(model->points);
    }
    ewa_cloud *cloud = model->points;
    model->points = NULL;
    return ewa_asset_take_cloud(job, cloud);
}

ewa_status ewa_asset_take_gaussians(const ewa_asset_job *job, ewa_gaussians *set, const double up_world[3]) {
    ewa_asset *asset = job->asset;
    static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const bool moved = memcmp(asset->to_world, identity, sizeof identity) != 0;
    memcpy(asset->up_world, up_world, sizeof asset->up_world);
    if (job->options->gaussians_as_surfels) {
        ewa_cloud *cloud = NULL;
        const ewa_status status = ewa_gaussians_to_cloud(set, &cloud);
        return status == EWA_OK ? ewa_asset_take_cloud(job, cloud) : status;
    }
    if (job->options->filter && job->options->filter->term_count)
        return ewa_fail(
            asset->context, EWA_ERROR_UNSUPPORTED,
            "a filter is for points; Gaussians have none of their attributes, but drawn as surfels");
    ewa_status status = moved ? ewa_gaussians_transform(set, asset->to_world) : EWA_OK;
    if (status == EWA_OK) status = ewa_splats_create(set, &asset->splats);
    EWA_TRY(status);
    ewa_splats_info info;
    ewa_splats_describe(asset->splats, &info);
    asset->kind = EWA_ASSET_GAUSSIANS;
    asset->count = info.splat_count;
    asset->bounds = info.core;
    asset->near_world = info.near_world;
    return ewa_gaussians_outline(set, &info.core, &asset->outline);
}

ewa_status ewa_asset_take_octree(const ewa_asset_job *job, ewa_lod *lod) {
    ewa_asset *asset = job->asset;
    ewa_lod_info info;
    static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    asset->kind = EWA_ASSET_OCTREE;
    asset->lod = lod;
    ewa_lod_describe(lod, &info);
    asset->count = info.point_count;
    asset->bounds = info.bounds;
    asset->bounds.finite_count = info.point_count;
    if (memcmp(asset->to_world, identity, sizeof identity) != 0)
        return ewa_fail(asset->context, EWA_ERROR_UNSUPPORTED,
                        "to_world: an octree that is drawn from its levels stays where it is; read whole "
                        "(levels: never), or by `ewa convert`, it can be moved");
    if (!info.merged)
        ewa_report(
            asset->context, EWA_SEVERITY_NOTE,
            "its levels have points only, none that stand for others: what is far away is drawn by few of "
            "them; `ewa lod %s -o FILE.copc.laz` makes better levels",
            asset->name);
    EWA_TRY(ewa_lod_sample(lod, EWA_OCTREE_SAMPLE_POINTS, &asset->outline));
    if (ewa_cloud_point_count(asset->outline) == 0)
        return ewa_fail(asset->context, EWA_ERROR_FORMAT, "the file has no points");
    if (is_drawable(asset->outline)) return EWA_OK;
    ewa_estimate_options options;
    ewa_estimate_options_init(&options, sizeof options);
    return ewa_cloud_estimate(&asset->outline, &options);
}
