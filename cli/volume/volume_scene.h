// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a picture of a volume shows: the voxels under a transfer function, and surfaces within.
#ifndef EWA_CLI_VOLUME_VOLUME_SCENE_H
#define EWA_CLI_VOLUME_VOLUME_SCENE_H

#include "cli/input/volume_input.h"
#include "cli/render/frames.h"

/// Options of what the voxels look like, and of what else there is.
typedef struct volume_scene_arguments {
    const char *transfer, *save_transfer_path, *surfels_path;
    option_bounds range;
    option_vector gradient;
    ewa_volume_options options;
} volume_scene_arguments;

typedef struct volume_scene {
    ewa_voxels *voxels;
    ewa_voxels_info info;
    ewa_cloud *outline;   ///< of what can be seen of it
    ewa_surfels *surfels; ///< NULL: none
    ewa_bounds surfels_bounds;
    int view;  ///< index of the named view that suits it
    bool flat; ///< the transfer function is one of those that look best without light
    double load_s, classify_s;
} volume_scene;

/// Whether a word is the name of a preset.
bool volume_scene_is_preset(const char *word);

/// Loads a volume and what lies within, and classifies. Returns false after reporting; free in any case.
bool volume_scene_load(cli_session *session, const volume_input_arguments *input,
                       const volume_scene_arguments *arguments, const char *path, uint32_t level_count,
                       volume_scene *scene);
void volume_scene_free(volume_scene *scene);

/// Makes the cameras that the options ask for, looking at all that can be seen; `frames` is planned.
/// Returns false after reporting.
bool volume_scene_frame(cli_session *session, const frames_arguments *arguments, const volume_scene *scene,
                        frame_cameras *frames);

#endif
