// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The scene of a volume: its voxels under the transfer function that the options ask for, and a surface within.
#ifndef EWA_CLI_VOLUME_VOLUME_SCENE_H
#define EWA_CLI_VOLUME_VOLUME_SCENE_H

#include "cli/input/volume_input.h"
#include "ewa/scene.h"

/// Options of what the voxels look like, and of what else there is.
typedef struct volume_scene_arguments {
    const char *transfer, *save_transfer_path, *surfels_path;
    option_bounds range;
    option_vector gradient;
    ewa_volume_options options;
} volume_scene_arguments;

/// Loads a volume, as instance 0 of a scene that is empty, with levels of detail, and what lies within. Returns false
/// after reporting.
bool volume_scene_fill(cli_session *session, const volume_input_arguments *input,
                       const volume_scene_arguments *arguments, const char *path, uint32_t level_count,
                       ewa_scene *scene);

#endif
