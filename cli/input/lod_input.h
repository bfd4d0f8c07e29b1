// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Octrees of points (COPC, EPT) as inputs: which are drawn from their levels, and which are read whole.
#ifndef EWA_CLI_INPUT_LOD_INPUT_H
#define EWA_CLI_INPUT_LOD_INPUT_H

#include "cli/base/session.h"

/// Options of what is drawn from an octree.
typedef struct lod_arguments {
    ewa_lod_options options;
    int levels; ///< ewa_octree_levels
} lod_arguments;

#define LOD_MEMBER(offset, member)                                                                           \
    OPTION_OF(ewa_lod_options, (offset) + offsetof(lod_arguments, options), member)

#define LOD_OPTIONS(offset)                                                                                  \
    {"levels",                                                                                               \
     OPTION_CHOICE,                                                                                          \
     (offset) + offsetof(lod_arguments, levels),                                                             \
     NULL,                                                                                                   \
     "auto|always|never",                                                                                    \
     .help = "draw octrees (COPC, EPT) from their levels, never more than a picture needs; auto: those of "  \
             "more than 4000000 points, unless --filter by what levels lack, --columns, --keep-going or --lod-error 0 ask for " \
             "all"},                                                                                         \
        {"memory", LOD_MEMBER(offset, memory_bytes),                                                         \
         .help = "for the nodes of octrees that are drawn from their levels: 512M, 8G; a picture that "      \
                 "needs more at a time is drawn in bands, the same bytes; and for streamed Gaussians, coarser "  \
                 "ones where all that is wanted would take more"},                                           \
        {"lod-spacing", LOD_MEMBER(offset, spacing_px),                                                      \
         .help = "of an octree, nodes are drawn by surfels that represent their points where these are no "  \
                 "farther apart on the screen"},                                                             \
    {                                                                                                        \
        "lod-error", LOD_MEMBER(offset, error),                                                              \
            .help = "and where these are expected to be off by no more than so much, rms, in 1/255 of the "  \
                    "screen's white; 0: all points, as of any file. Films of clouds in memory: a third of it, over the whole picture, " \
                    "by levels that are made of them"                                                        \
    },                                                                                                       \
    {                                                                                                        \
        "max-splats", LOD_MEMBER(offset, max_splats),                                                        \
            .help = "draw about so many surfels and points of octrees, or streamed Gaussians: where it would be more, spacing and " \
                    "error, or the pixels of --gaussian-merge, grow by one factor; 0: 8 surfels for each pixel that they cover"                          \
    }

void lod_input_set_defaults(lod_arguments *arguments);

/// Whether octrees are drawn from their levels: without an error, all points are.
ewa_octree_levels lod_input_levels(const lod_arguments *arguments);

/// Opens the octree at a path; NULL after reporting.
ewa_lod *lod_input_open(cli_session *session, const char *path);

/// Whether a box, corner low, corner high, is so small a part of the octree at a path that reading only the nodes
/// that meet it is worth it; of a folder, which cannot be read otherwise, always. False where there is no octree.
bool lod_input_serves(cli_session *session, const char *path, const double corners_world[6]);

/// Reads all points of a box, of a folder or file, both corners included; `corners_world` NULL: all. NULL after
/// reporting.
ewa_cloud *lod_input_read(cli_session *session, const char *path, const double corners_world[6]);

#endif
