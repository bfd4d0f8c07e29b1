// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A file of trained Gaussians, resident, and where they are.
#include "gaussian_scene.h"
#include "gaussian_files.h"

bool gaussian_scene_load(cli_session *session, const char *path, gaussian_scene *scene) {
    ewa_gaussians set;
    ewa_gaussian_facts facts;
    scene->path = path;
    if (!gaussian_files_load(session, path, &set, &facts)) return false;
    scene->up_axis = gaussian_files_up_axis(&facts);
    ewa_status status = ewa_splats_create(&set, &scene->splats);
    if (status == EWA_OK) {
        ewa_splats_describe(scene->splats, &scene->info);
        status = ewa_gaussians_outline(&set, &scene->info.core, &scene->outline);
    }
    ewa_gaussians_free(&set);
    if (status != EWA_OK) session_failed(session, status);
    return status == EWA_OK;
}

void gaussian_scene_free(gaussian_scene *scene) {
    ewa_splats_destroy(&scene->splats);
    ewa_cloud_destroy(&scene->outline);
}
