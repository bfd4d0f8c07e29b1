// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clouds from the files of the command line.
#ifndef EWA_CLI_INPUT_INPUTS_H
#define EWA_CLI_INPUT_INPUTS_H

#include "cli/base/session.h"

/// How files of points are read, in common_arguments; for every command that reads some.
extern const option_group cloud_input_options;

/// Loads the points of one file that the session's filter takes, at least one; of a mesh, after a note, its
/// vertices. NULL after reporting.
ewa_cloud *input_load(cli_session *session, const char *path);

/// Loads all points of one file, with everything else that a PLY file holds, so that its faces are kept; `*elements`, which the
/// caller frees, are NULL for other formats.
ewa_cloud *input_load_elements(cli_session *session, const char *path, ewa_elements **elements);

/// Loads the points of one file that the session's filter takes, at least one; `*sampled`: they were made on the faces of a mesh, for kernels that end at
/// `cutoff` standard deviations. NULL after reporting.
ewa_cloud *input_points(cli_session *session, const char *path, double cutoff, bool *sampled);

/// Estimates what a surfel needs and the points of a file lack. False after reporting; free the cloud in any
/// case. `*estimate_s` grows by the time that it took.
bool input_complete(cli_session *session, const char *path, ewa_cloud **cloud, double *estimate_s);

/// Loads one file and estimates what a surfel needs and it lacks; a mesh is sampled; NULL after reporting.
/// Axes that are made of a mesh are for kernels that end at `cutoff` standard deviations. `*estimate_s` grows
/// by the time that the estimation took.
ewa_cloud *input_as_surfels(cli_session *session, const char *path, double cutoff, double *estimate_s);

/// Loads the operands and makes one cloud of them (ewa_cloud_merge()); files without colours get `srgb`, in
/// [0, 1], beside others that have some, which a note says. NULL after reporting.
ewa_cloud *inputs_merge(cli_session *session, const common_arguments *common, const double srgb[3]);

/// Loads the operands as one cloud that can be drawn: what a surfel needs and all or some files lack is estimated. Axes
/// that are made of a mesh are for kernels that end at `cutoff` standard deviations. NULL after reporting. `*estimate_s`
/// gets the time that the estimation took.
ewa_cloud *inputs_as_surfels(cli_session *session, const common_arguments *common, double cutoff,
                             double *estimate_s);

/// Gives every point of a cloud one colour, sRGB in [0, 1].
ewa_status cloud_set_color(ewa_cloud *cloud, const double srgb[3]);

/// Whether a cloud has all that a surfel needs.
bool cloud_is_drawable(const ewa_cloud *cloud);

#endif
