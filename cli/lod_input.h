// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Octrees of points (COPC, EPT) as inputs: which are drawn from their levels, and which are read whole.
#ifndef EWA_CLI_LOD_INPUT_H
#define EWA_CLI_LOD_INPUT_H

#include "session.h"

/// Options of what is drawn from an octree.
typedef struct lod_arguments {
    ewa_lod_options options; ///< 0, and an error of -1, of what is not given: lod_input_options()
} lod_arguments;

enum {
    LOD_SAMPLE_POINTS = 400000, ///< that stand for all where a whole is looked at
    LOD_WHOLE_POINTS = 4000000, ///< octrees of more are drawn from their levels
};

#define LOD_OPTIONS(offset)                                                                                  \
    {"memory", OPTION_OF(ewa_lod_options, (offset) + offsetof(lod_arguments, options), memory_bytes),        \
     .help = "draw an octree (COPC, EPT) from its levels, with so much memory for its cubes: 512M, 8G; a "   \
             "picture that needs more at a time is drawn in bands, the same bytes",                          \
     .absent = "1G"},                                                                                        \
        {"lod-spacing", OPTION_OF(ewa_lod_options, (offset) + offsetof(lod_arguments, options), spacing_px), \
         .help = "of an octree, cubes are drawn by surfels that stand for their points where these are no "  \
                 "farther apart on the screen",                                                              \
         .absent = "0.5"},                                                                                   \
    {                                                                                                        \
        "lod-error", OPTION_OF(ewa_lod_options, (offset) + offsetof(lod_arguments, options), error),         \
            .help = "and where these are expected to be off by no more than so much, rms, in 1/255 of the "  \
                    "screen's white; 0: all points, as of any file",                                         \
            .absent = "16"                                                                                   \
    }

/// Marks all options as not given.
void lod_input_set_defaults(lod_arguments *arguments);

/// Whether one of the options that ask for drawing from levels was given.
bool lod_input_asked(const lod_arguments *arguments);

/// The library's options, with its defaults for what is not given.
ewa_lod_options lod_input_options(const lod_arguments *arguments);

/// Whether a path is a folder of EPT, or its "ept.json".
bool lod_input_is_folder(cli_session *session, const char *path);

/// Opens the octree at a path; NULL after reporting.
ewa_lod *lod_input_open(cli_session *session, const char *path);

/// Whether an octree has more than LOD_WHOLE_POINTS.
bool lod_input_is_large(cli_session *session, const char *path);

/// Opens the only operand, if it is an octree that is to be drawn from its levels: one of the options asks for
/// that, or there are more than LOD_WHOLE_POINTS, unless --lod-error is 0 or an option needs all points: `clash`
/// names one of the command's, NULL: none. `*lod` is NULL where it is not. False after reporting.
bool lod_input_choose(cli_session *session, const common_arguments *common, const lod_arguments *arguments,
                      const char *clash, ewa_lod **lod);

/// Reads what the whole looks like, at least one point. NULL after reporting.
ewa_cloud *lod_input_sample(cli_session *session, ewa_lod *lod, const char *path);

/// Whether a box, corner low, corner high, is so small a part of the octree at a path that reading only the nodes
/// that meet it is worth it; of a folder, which cannot be read otherwise, always. False where there is no octree.
bool lod_input_serves(cli_session *session, const char *path, const double corners_world[6]);

/// Reads all points of a box, of a folder or file, both corners included; `corners_world` NULL: all. NULL after
/// reporting.
ewa_cloud *lod_input_read(cli_session *session, const char *path, const double corners_world[6]);

#endif
