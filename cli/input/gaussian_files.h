// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sets of Gaussians from the files of the command line.
#ifndef EWA_CLI_INPUT_GAUSSIAN_FILES_H
#define EWA_CLI_INPUT_GAUSSIAN_FILES_H

#include "cli/base/session.h"

/// Which form of Gaussians a file holds, by its content; EWA_GAUSSIANS_NONE for all else, and for what is no regular
/// file.
ewa_gaussian_format gaussian_files_format(cli_session *session, const char *path);

/// Loads a set; `facts` may be NULL. Returns false after reporting.
bool gaussian_files_load(cli_session *session, const char *path, ewa_gaussians *set,
                         ewa_gaussian_facts *facts);

/// Loads a set as surfels in their constant colours; NULL after reporting.
ewa_cloud *gaussian_files_load_surfels(cli_session *session, const char *path);

#endif
