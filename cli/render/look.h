// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How a scene is shown: the options that `ewa render`, `ewa view` and `ewa page` take, in one table.
#ifndef EWA_CLI_RENDER_LOOK_H
#define EWA_CLI_RENDER_LOOK_H

#include "cli/input/lod_input.h"
#include "cli/input/scene_input.h"
#include "cli/render/furnish.h"
#include "cli/render/light.h"
#include "cli/render/section.h"

/// Options of the look.
typedef struct look_arguments {
    light_arguments light; // first: LIGHT_OFFSET is LOOK_OFFSET
    ewa_surfels_options surfels;
    section_arguments section;
    bool close_gaps;
    lod_arguments lod;
    ewa_gaussian_options gaussians;
    ewa_volume_options volumes;
    bool gaussians_as_surfels;
    const char *transfer;
    const char *layers;
    coloring_arguments coloring;
    option_color background;
    furnish_arguments furniture;
} look_arguments;

/// Where a command's arguments have them: right after the frames_arguments that they begin with.
enum { LOOK_OFFSET = sizeof(frames_arguments) };

extern const option_group look_splats, look_octrees, look_gaussians, look_volumes, look_sections, look_colors, look_furniture;

/// The groups of a command that has look_arguments at LOOK_OFFSET: what a scene file holds, and with what stands over pictures.
#define LOOK_SCENE_GROUPS &look_splats, &look_octrees, &look_gaussians, &look_volumes, &look_sections, &light_options, &look_colors
#define LOOK_GROUPS       LOOK_SCENE_GROUPS, &light_object_options, &look_furniture

void look_set_defaults(look_arguments *arguments);

/// Says in `message` what is wrong with the options together; see command.check. `output`: the picture's file; NULL: a window.
bool look_check(const look_arguments *arguments, const char *output, char message[OPTION_ERROR_BYTES]);

/// Returns the options of the scene, with the objects that light it, which must stay as long as they are used.
ewa_scene_options look_scene_options(const look_arguments *arguments, const light_objects *lit_by);

/// Sets of an asset's options what the look says.
void look_set_asset_options(const look_arguments *arguments, ewa_asset_options *options);

#endif
