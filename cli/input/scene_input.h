// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The scene that a command's operands and options ask for.
#ifndef EWA_CLI_INPUT_SCENE_INPUT_H
#define EWA_CLI_INPUT_SCENE_INPUT_H

#include "cli/base/session.h"

/// Options of an asset as the session has them, with the readers of the helper program.
ewa_asset_options scene_input_asset_options(cli_session *session);

/// Adds files to a scene; of points, how they are coloured. Files of which the filter takes no point are left out, which
/// a note says. Returns false after reporting, also when nothing is left.
bool scene_input_add(cli_session *session, size_t count, const char *const *paths, const ewa_asset_options *options,
                     const ewa_coloring *coloring, ewa_scene *scene);

/// Makes one cloud of the points of files as a scene shows them, in their own colours, with normals and radii, or axes for
/// kernels that end at `cutoff` standard deviations; of meshes points on their faces, of Gaussians their discs. The caller
/// destroys it; NULL after reporting.
ewa_cloud *scene_input_cloud(cli_session *session, size_t count, const char *const *paths, double cutoff);

/// Fills in a colouring from the options --color-by, --colormap and --range; `word` may be NULL.
void scene_input_coloring(const char *word, int colormap, const option_bounds *range, ewa_coloring *coloring);

#endif
