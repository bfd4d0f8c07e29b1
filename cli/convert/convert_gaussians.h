// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa convert for Gaussians: to another form of them, moved.
#ifndef EWA_CLI_CONVERT_CONVERT_GAUSSIANS_H
#define EWA_CLI_CONVERT_CONVERT_GAUSSIANS_H

#include "cli/base/session.h"

/// Whether a path is written in a form that only Gaussians have.
bool convert_gaussians_is_named(const char *path);

/// Replaces a cloud by those of its points that are to be kept, at least one; false after reporting.
typedef bool convert_chooser(cli_session *session, const void *data, ewa_cloud **cloud);

/// Reads, leaves out what floats beside or is never seen if `prune_factor` > 0 (--prune), keeps what `choose` (NULL: all) keeps of the centres, which have "opacity" and "size", the longest standard
/// deviation, maps by `count` matrices, one after the other, and writes. False after reporting.
bool convert_gaussians(cli_session *session, const char *from, const char *to,
                       const ewa_gaussians_save_options *options, double prune_factor, convert_chooser *choose, const void *data,
                       const double (*matrices)[16], uint32_t count);

#endif
