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

/// Makes one cloud of the points of a scene file, as it shows them: with every attribute of their files, without what its
/// regions hide and its sections cut away. The caller destroys it; NULL after reporting.
ewa_cloud *scene_input_points(cli_session *session, const char *path);

/// Whether a scene file shows Gaussians, and nothing else.
bool scene_input_is_of_gaussians(cli_session *session, const char *path);

/// Makes a set of the Gaussians of a scene file, as scene_input_points() does. The caller frees it; false after reporting.
bool scene_input_gaussians(cli_session *session, const char *path, ewa_gaussians *set, double up_world[3]);

/// Options of a colouring.
typedef struct coloring_arguments {
    const char *color_by; ///< NULL: none given
    int colormap;         ///< index of a word; EWA_COLORING_AUTO - 1: none given
    option_bounds range;
} coloring_arguments;

/// Rows of an option table; `at` is the offset of the coloring_arguments in the command's arguments.
#define COLORING_OPTIONS(at)                                                                                 \
    {"color-by", OPTION_TEXT, (at) + offsetof(coloring_arguments, color_by), "ATTR",                         \
     .help = "colour by an attribute ('ewa info' lists them), one component of it (normal.x), x, y, z, "     \
             "red, green or blue; rgb: the file's colours; none: these or grey",                             \
     .absent = "auto: the file's colours, else, of scans, intensity or height, else grey"},                  \
        {"colormap", OPTION_CHOICE, (at) + offsetof(coloring_arguments, colormap), NULL,                     \
         "viridis|turbo|gray|plasma|inferno|magma|cividis|coolwarm|classes",                                 \
         .help = "colours for --color-by; classes: whole numbers by the colours of LAS classes (ground, "    \
                 "vegetation, building, ...)",                                                               \
         .absent = "auto: classes for whole numbers named classification, else viridis",                     \
         .needs = "color-by"},                                                                               \
    {                                                                                                        \
        "range", OPTION_BOUNDS, (at) + offsetof(coloring_arguments, range), "a,b",                           \
            .help = "numbers that get the first and the last colour; with a percent sign, percentiles: "     \
                    "2%,98%",                                                                                \
            .aliases = "coloring-range", .absent = "auto: smallest to largest; 2%,98% for intensities",      \
            .needs = "color-by"                                                                              \
    }

/// Fills in a colouring from the options.
void scene_input_coloring(const coloring_arguments *arguments, ewa_coloring *coloring);

#endif
