// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa convert for Gaussians: to another form of them, moved.
#ifndef EWA_CLI_CONVERT_CONVERT_GAUSSIANS_H
#define EWA_CLI_CONVERT_CONVERT_GAUSSIANS_H

#include "cli/base/session.h"

/// Whether a path is written in a form that only Gaussians have.
bool convert_gaussians_is_named(const char *path);

/// Reads, keeps those whose centres lie in a box between two corners (NULL: all), maps by `count` matrices, one after the
/// other, and writes. False after reporting.
bool convert_gaussians(cli_session *session, const char *from, const char *to,
                       const ewa_gaussians_save_options *options, const double *corners_world,
                       const double (*matrices)[16], uint32_t count);

#endif
