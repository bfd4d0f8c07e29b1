// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files of points or triangles: the one place where the program decides which of them a file holds.
#include "cli/input/model_input.h"
#include "cli/input/gaussian_files.h"
#include "cli/input/import.h"
#include "cli/input/lod_input.h"
#include "cli/input/volume_input.h"

bool model_input_load(cli_session *session, const char *path, uint32_t wanted, ewa_model *model) {
    *model = (ewa_model){.points = NULL};
    session->subject = path;
    if (ewa_volume_is_file(session->context, path)) {
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
    } else if (ewa_lod_is_folder(session->context, path)) {
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
