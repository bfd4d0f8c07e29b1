// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A file of trained Gaussians, resident, and where they are.
#ifndef EWA_CLI_GAUSSIAN_SCENE_H
#define EWA_CLI_GAUSSIAN_SCENE_H

#include "session.h"

/// Zero-initialise; free with gaussian_scene_free().
typedef struct gaussian_scene {
    const char *path;
    ewa_splats *splats;
    ewa_splats_info info;
    ewa_cloud *outline; ///< where they are, but for far floaters
    int up_axis;        ///< as view_arguments have it
} gaussian_scene;

/// Loads a file. Returns false after reporting; free in any case.
bool gaussian_scene_load(cli_session *session, const char *path, gaussian_scene *scene);

void gaussian_scene_free(gaussian_scene *scene);

#endif
