// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a scene file shows, for ewa info.
#ifndef EWA_CLI_INFO_INFO_SCENE_H
#define EWA_CLI_INFO_INFO_SCENE_H

#include "cli/base/json.h"

/// Tells of a scene file: `json` is NULL for text. False after reporting.
bool info_scene(cli_session *session, const char *path, json_writer *json);

#endif
