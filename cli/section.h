// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a picture leaves out: a box and planes that cut the scene.
#ifndef EWA_CLI_SECTION_H
#define EWA_CLI_SECTION_H

#include "options.h"

#include "ewa/render.h"

/// Options of sections.
typedef struct section_arguments {
    option_vector box;     ///< low corner, high corner
    option_vectors planes; ///< a, b, c, d: keep a x + b y + c z + d >= 0
} section_arguments;

/// Says in `message` what is wrong with the options together; see command.check.
bool section_check(const section_arguments *arguments, char message[OPTION_ERROR_BYTES]);

/// Sets the section planes of a picture.
void section_apply(const section_arguments *arguments, ewa_render_options *options);

#endif
