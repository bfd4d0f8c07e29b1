// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a picture shows of trained Gaussians, alone or with surfaces among them.
#ifndef EWA_CLI_GAUSSIAN_SCENE_H
#define EWA_CLI_GAUSSIAN_SCENE_H

#include "session.h"
#include "within.h"

/// How Gaussians are drawn.
typedef struct gaussian_arguments {
    ewa_gaussian_options options;
    bool surface; ///< as surfels
} gaussian_arguments;

#define GAUSSIANS_OF(offset, member)                                                                         \
    OPTION_OF(ewa_gaussian_options, (offset) + offsetof(gaussian_arguments, options), member)

/// Rows of a table of options whose gaussian_arguments lie at `offset`.
#define GAUSSIAN_OPTIONS(offset)                                                                             \
    {"projection", GAUSSIANS_OF(offset, projection)}, {"gaussian-filter", GAUSSIANS_OF(offset, filter)},     \
        {"sh-degree", GAUSSIANS_OF(offset, sh_degree)}, {                                                    \
        "surface", OPTION_FLAG, (offset) + offsetof(gaussian_arguments, surface),                            \
            .help =                                                                                          \
                "draw Gaussians as opaque surfels, with depth, normals and light, in their constant colours" \
    }

/// The Gaussians of a picture. Zero-initialise; free with gaussian_scene_free().
typedef struct gaussian_scene {
    const char *path;      ///< NULL: none
    common_arguments rest; ///< with the other operands alone
    const char **operands;
    ewa_splats *splats;
    ewa_splats_info info;
    ewa_cloud *outline; ///< where they are, but for far floaters
    int up_axis;        ///< as view_arguments have it
    ewa_gaussian_renderer *renderer;
    within_planes planes;
} gaussian_scene;

/// Looks for the operand that holds Gaussians, unless they are to be surfels. Returns false after reporting.
bool gaussian_scene_find(cli_session *session, const common_arguments *common,
                         const gaussian_arguments *arguments, gaussian_scene *scene);

/// Loads them; `others`, which may be NULL, is in the outline, too. Returns false after reporting.
bool gaussian_scene_load(cli_session *session, const ewa_cloud *others, gaussian_scene *scene);

/// Makes splats of a file, and an outline of where they are, with `others` (may be NULL); the rest of the scene is not
/// needed. Returns false after reporting.
bool gaussian_scene_read(cli_session *session, const ewa_cloud *others, gaussian_scene *scene);

/// Draws them over the background.
ewa_status gaussian_scene_paint(gaussian_scene *scene, const ewa_camera *camera,
                                const ewa_gaussian_options *options, const ewa_frame *frame,
                                ewa_render_stats *stats);

/// The same among the surfaces in scene->planes, whose rgba (over nothing) and depth are drawn.
ewa_status gaussian_scene_paint_among(gaussian_scene *scene, const ewa_camera *camera,
                                      const ewa_gaussian_options *options, const ewa_frame *frame,
                                      ewa_render_stats *stats);

void gaussian_scene_free(gaussian_scene *scene);

#endif
