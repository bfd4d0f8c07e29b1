// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a volume file holds, for ewa info.
#ifndef EWA_CLI_INFO_INFO_VOLUME_H
#define EWA_CLI_INFO_INFO_VOLUME_H

#include "cli/base/json.h"
#include "cli/input/volume_input.h"

/// Prints what a volume file holds as text, or as an object of `json` when that is not NULL. Returns false
/// after reporting.
bool info_volume(cli_session *session, const volume_input_arguments *arguments, const char *path,
                 json_writer *json);

#endif
