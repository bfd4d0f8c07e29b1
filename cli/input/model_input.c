// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files of points or triangles: the one place where the program decides which of them a file holds.
#include "cli/input/model_input.h"
#include "cli/input/gaussian_files.h"
#include "cli/input/import.h"
#include "cli/input/lod_input.h"
#include "cli/input/volume_input.h"

#include <math.h>

/// A mesh is drawn from at least so many points, and from so many per triangle.
static const uint64_t MESH_POINTS = 200000, MESH_POINTS_PER_TRIANGLE = 4;

/// Smallest cutoff that axes of a mesh's points are made for.
static const double MESH_CUTOFF = 1e-3;

bool model_input_load(cli_session *session, const char *path, uint32_t wanted, ewa_model *model) {
    *model = (ewa_model){.points = NULL};
    session->subject = path;
    if (ewa_volume_is_named(path)) {
        session_fail(session, "%s: a volume; `ewa volume %s -o FILE.png` draws it", path, path);
        return false;
    }
    const double started_s = clock_now_s();
    const ewa_gaussian_format gaussians = gaussian_files_format(session, path);
    session->subject = path;
    // As PLY, and as glTF, they are points to begin with.
    if (gaussians > EWA_GAUSSIANS_PLY && gaussians != EWA_GAUSSIANS_GLTF) {
        model->points = gaussian_files_load_surfels(session, path);
        if (!model->points) return false;
    } else if (import_is_named(path)) {
        if (!import_load(session, path, wanted, model)) return false;
    } else if (lod_input_is_folder(session, path)) {
        model->points = lod_input_read(session, path, NULL);
        if (!model->points) return false;
    } else {
        if (!session_passed(session, ewa_model_load(session->context, path, wanted, &session->load, model)))
            return false;
    }
    if (model->lost_count)
        session_note(session, "%s: %llu points are lost", path, (unsigned long long)model->lost_count);
    if (model->points && ewa_cloud_point_count(model->points) == 0) {
        session_fail(session, "%s: the file has no points", path);
        return false;
    }
    const double took_s = clock_now_s() - started_s;
    if (model->face_count)
        session_say(session, "%s: %llu faces read in %.3f s", path, (unsigned long long)model->face_count,
                    took_s);
    else
        session_say(session, "%s: %llu points read in %.3f s", path,
                    (unsigned long long)ewa_cloud_point_count(model->points), took_s);
    // The readers of meshes say so themselves.
    if (model->points && !model->face_count) {
        ewa_cloud_check_steps(model->points);
        ewa_cloud_check_degrees(model->points);
    }
    return true;
}

ewa_cloud *model_input_sample(cli_session *session, const char *path, const ewa_mesh *mesh, double cutoff) {
    ewa_mesh_sample_options options;
    ewa_mesh_sample_options_init(&options, sizeof options);
    options.cutoff = fmax(cutoff, MESH_CUTOFF);
    options.point_count = MESH_POINTS_PER_TRIANGLE * mesh->triangle_count;
    if (options.point_count < MESH_POINTS) options.point_count = MESH_POINTS;
    options.texture_filter = EWA_TEXTURE_EWA; // least squares would take most of the time
    const double started_s = clock_now_s();
    ewa_cloud *cloud = NULL;
    const ewa_status status = ewa_mesh_sample(mesh, &options, &cloud);
    if (status != EWA_OK)
        session_failed(session, status);
    else
        session_say(session, "%s: %llu points on %u triangles in %.3f s; `ewa sample` has options for this",
                    path, (unsigned long long)ewa_cloud_point_count(cloud), mesh->triangle_count,
                    clock_now_s() - started_s);
    return cloud;
}
