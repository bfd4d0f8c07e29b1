// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What shines on a picture: options of shading, lights, materials and environment, and the files behind them.
#ifndef EWA_CLI_RENDER_LIGHT_H
#define EWA_CLI_RENDER_LIGHT_H

#include "cli/render/frames.h"

/// Options of shading.
typedef struct light_arguments {
    ewa_render_options render; ///< without what the other members say
    int shading;               ///< ewa_shading; -1: not given
    option_vectors lights;
    const char *materials_path, *environment_path;
} light_arguments;

/// Where a command's arguments have them: right after the frames_arguments that they begin with.
enum { LIGHT_OFFSET = sizeof(frames_arguments) };

/// Light alone, as scene files have it, and what has files of its own.
extern const option_group light_options, light_object_options;

/// The objects that options refer to.
typedef struct light_objects {
    ewa_material materials[EWA_MAX_MATERIALS];
    uint32_t material_count;
    ewa_environment *environment;
} light_objects;

void light_set_defaults(light_arguments *arguments);

/// Says in `message` what is wrong with the options together; see command.check.
bool light_check(const light_arguments *arguments, char message[OPTION_ERROR_BYTES]);

/// Loads materials and environment. Returns false after reporting; free with light_free() in any case.
bool light_load(cli_session *session, const light_arguments *arguments, light_objects *objects);
void light_free(light_objects *objects);

/// Returns the options of the picture with light and objects, which must stay as long as they are used.
ewa_render_options light_apply(const light_arguments *arguments, const light_objects *objects);

#endif
