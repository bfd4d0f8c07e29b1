// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What commands that put pictures onto points have in common.
#ifndef EWA_CLI_IMAGE_TEXTURED_H
#define EWA_CLI_IMAGE_TEXTURED_H

#include "cli/cloud/procedure.h"

/// What the arguments of such a command begin with.
typedef struct textured_arguments {
    procedure_arguments procedure; // first
    const char *picture;           ///< NULL: none
    ewa_acquire_options acquire;
} textured_arguments;

/// The options of textured_arguments but for those of procedure_arguments.
extern const option_group textured_options;

void textured_set_defaults(textured_arguments *arguments);

/// Reads the picture that was asked for. Returns false after reporting; the caller frees `*picture`, which is
/// zeroed when there is none.
bool textured_load(cli_session *session, const textured_arguments *arguments, ewa_image *picture);

#endif
