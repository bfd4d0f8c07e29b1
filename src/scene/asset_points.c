// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Assets of points: clouds, meshes that are sampled, Gaussians.
#include "base/base.h"
#include "ewa/diagnosis.h"
#include "ewa/prepare.h"
#include "framing/conventions.h"
#include "io/crs.h"
#include "math/degree.h"
#include "scene/asset.h"

#include <math.h>
#include <string.h>

/// A mesh is drawn from at least so many points, and from so many per triangle.
static const uint64_t MESH_POINTS = 200000, MESH_POINTS_PER_TRIANGLE = 4;

/// Smallest cutoff that axes of a mesh's points are made for.
static const double MESH_CUTOFF = 1e-3;

/// A mesh of no more colours is plain, as parts of machines are; their number is that of a legend's rows at a glance.
enum { PLAIN_COLORS = 8 };

/// Whether the points have colours, but few. Of what a whole file says, so that all ranks find the same.
static bool has_few_colors(const ewa_cloud *cloud) {
    const ewa_attribute *color = ewa_cloud_find(cloud, EWA_COLOR);
    if (!color) return false;
    const size_t bytes = color->component_count * ewa_type_bytes(color->type);
    const uint8_t *data = color->data, *found[PLAIN_COLORS];
    int count = 0, last = 0;
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        const uint8_t *own = data + i * bytes;
        if (count && memcmp(own, found[last], bytes) == 0) continue;
        for (last = 0; last < count && memcmp(own, found[last], bytes) != 0;) last++;
        if (last == PLAIN_COLORS) return false;
        if (last == count) found[count++] = own;
    }
    return true;
}

void ewa_asset_take_unit(ewa_asset *asset, const ewa_cloud *cloud) {
    bool same = true;
    for (int c = 0; c < 3; c++) {
        const double *m = asset->to_world + c;
        same = same && fabs(sqrt(m[0] * m[0] + m[4] * m[4] + m[8] * m[8]) - 1) < 1e-9;
    }
    asset->unit = same ? ewa_crs_unit_name(ewa_cloud_crs_unit(cloud)) : NULL;
}

/// Takes points as they are.
static ewa_status take_points(const ewa_asset_job *job, ewa_cloud *cloud) {
    ewa_asset *asset = job->asset;
    asset->kind = EWA_ASSET_POINTS;
    asset->cloud = cloud;
    if (!ewa_cloud_find(cloud, EWA_POSITION))
        return ewa_fail(asset->context, EWA_ERROR_ARGUMENT, "the points have no positions");
    const uint64_t all = ewa_cloud_point_count(cloud);
    EWA_TRY(ewa_cloud_filter(asset->context, &asset->filter, &asset->cloud));
    if (ewa_cloud_point_count(asset->cloud) < all)
        ewa_report(asset->context, EWA_SEVERITY_INFO, "%llu of %llu points are taken",
                   (unsigned long long)ewa_cloud_point_count(asset->cloud), (unsigned long long)all);
    if (ewa_asset_is_moved(asset)) EWA_TRY(ewa_cloud_transform(asset->cloud, asset->to_world));
    ewa_asset_take_unit(asset, asset->cloud);
    asset->count = ewa_cloud_point_count(asset->cloud);
    asset->drawable = ewa_cloud_is_drawable(asset->cloud);
    ewa_status status = EWA_OK;
    if (!asset->drawable) {
        status = ewa_cloud_refuse_gaussians(asset->cloud);
        if (status == EWA_OK) ewa_cloud_drop_zero_normals(asset->cloud);
    }
    return status == EWA_OK && asset->count ? ewa_cloud_measure(asset->cloud, &asset->bounds) : status;
}

/// Makes metres of points in degrees, of lengths that all places of about one latitude share, so that tiles meet.
static ewa_status make_metres(ewa_asset *asset) {
    const double *low = asset->bounds.low_world, *high = asset->bounds.high_world;
    double length_m[2], to_metres[16] = {[10] = 1, [15] = 1};
    ewa_degree_lengths(fmax(-89, fmin(89, round(0.5 * (low[1] + high[1])))), length_m);
    to_metres[0] = length_m[0], to_metres[5] = length_m[1];
    ewa_report(asset->context, EWA_SEVERITY_NOTE,
               "degrees with heights in metres: x and y are drawn times %.0f and %.0f, about metres", length_m[0],
               length_m[1]);
    EWA_TRY(ewa_cloud_transform(asset->cloud, to_metres));
    asset->unit = ewa_crs_unit_name(EWA_CRS_METRES);
    return ewa_cloud_measure(asset->cloud, &asset->bounds);
}

ewa_status ewa_asset_take_cloud(const ewa_asset_job *job, ewa_cloud *cloud) {
    char text[EWA_DIAGNOSIS_TEXT_BYTES];
    const bool degrees = !ewa_asset_is_moved(job->asset) && ewa_cloud_find_degrees(cloud, text);
    EWA_TRY(take_points(job, cloud));
    return degrees && job->asset->count ? make_metres(job->asset) : EWA_OK;
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
               "%llu points on %u triangles in %.3f s; ewa_mesh_sample() has options for this",
               (unsigned long long)ewa_cloud_point_count(cloud), mesh->triangle_count,
               ewa_now_s() - started_s);
    job->asset->plain = has_few_colors(cloud);
    ewa_status status = take_points(job, cloud);
    job->asset->kind = EWA_ASSET_MESH;
    return status;
}

ewa_status ewa_asset_take_model(const ewa_asset_job *job, ewa_model *model) {
    ewa_context *context = job->asset->context;
    if (!model->points && model->mesh.triangle_count) return ewa_asset_sample_mesh(job, &model->mesh);
    if (!model->points || ewa_cloud_point_count(model->points) == 0)
        return ewa_fail(context, EWA_ERROR_FORMAT, "the file has no points");
    if (!model->face_count) ewa_cloud_check_steps(model->points); // the readers of meshes say so themselves
    ewa_cloud *cloud = model->points;
    model->points = NULL;
    job->asset->plain = model->face_count && has_few_colors(cloud);
    return model->face_count ? take_points(job, cloud) : ewa_asset_take_cloud(job, cloud);
}

ewa_status ewa_asset_take_gaussians(const ewa_asset_job *job, ewa_gaussians *set, const double up_world[3]) {
    ewa_asset *asset = job->asset;
    const bool says_up = up_world[0] != 0 || up_world[1] != 0 || up_world[2] != 0;
    memcpy(asset->up_world, says_up ? up_world : ewa_up_of_gaussians, sizeof asset->up_world);
    if (job->options->gaussians_as_surfels) {
        ewa_cloud *cloud = NULL;
        const ewa_status status = ewa_gaussians_to_cloud(set, &cloud);
        return status == EWA_OK ? take_points(job, cloud) : status;
    }
    if (asset->filter.term_count)
        return ewa_fail(
            asset->context, EWA_ERROR_UNSUPPORTED,
            "a filter is for points; Gaussians have none of their attributes, but drawn as surfels");
    ewa_status status = ewa_asset_is_moved(asset) ? ewa_gaussians_transform(set, asset->to_world) : EWA_OK;
    if (status == EWA_OK) status = ewa_splats_create(set, job->options->gaussian_levels, &asset->splats);
    EWA_TRY(status);
    ewa_splats_info info;
    ewa_splats_describe(asset->splats, &info);
    asset->kind = EWA_ASSET_GAUSSIANS;
    asset->count = info.splat_count;
    asset->bounds = info.core;
    asset->near_world = info.near_world;
    return ewa_gaussians_outline(set, &info.core, &asset->outline);
}
