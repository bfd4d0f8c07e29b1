// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a picture shows of all that lets light through, files of trained Gaussians and volumes, alone or with
// surfaces among them.
#ifndef EWA_CLI_MIXTURE_SCENE_H
#define EWA_CLI_MIXTURE_SCENE_H

#include "gaussian_scene.h"
#include "light.h"
#include "volume_scene.h"

/// How such files are drawn.
typedef struct mixture_arguments {
    ewa_gaussian_options gaussians;
    bool surface; ///< Gaussians as surfels
    volume_scene_arguments volumes;
} mixture_arguments;

#define MIXED(offset, member)        ((offset) + offsetof(mixture_arguments, member))
#define GAUSSIANS_OF(offset, member) OPTION_OF(ewa_gaussian_options, MIXED(offset, gaussians), member)

/// Rows of a table of options whose mixture_arguments lie at `offset`.
#define GAUSSIAN_OPTIONS(offset)                                                                             \
    {"projection", GAUSSIANS_OF(offset, projection)}, {"gaussian-filter", GAUSSIANS_OF(offset, filter)},     \
        {"sh-degree", GAUSSIANS_OF(offset, sh_degree)}, {                                                    \
        "surface", OPTION_FLAG, MIXED(offset, surface),                                                      \
            .help =                                                                                          \
                "draw Gaussians as opaque surfels, with depth, normals and light, in their constant colours" \
    }
#define MIXED_VOLUME_OPTIONS(offset)                                                                         \
    {"transfer",                                                                                             \
     OPTION_TEXT,                                                                                            \
     MIXED(offset, volumes.transfer),                                                                        \
     "FILE|PRESET",                                                                                          \
     .help =                                                                                                 \
         "what values of volumes look like, as in 'ewa volume', whose --save-transfer writes such files",    \
     .absent = "auto: by the surfaces between its materials"},                                               \
    {                                                                                                        \
        "opacity-scale", OPTION_OF(ewa_volume_options, MIXED(offset, volumes.options), density_scale)        \
    }

void mixture_set_defaults(mixture_arguments *arguments);

/// All of it in a picture. Zero-initialise; free with mixture_scene_free().
typedef struct mixture_scene {
    common_arguments rest; ///< with the other operands alone
    const char **operands; ///< theirs, then those of the sets, then those of the volumes
    uint32_t splats_count, volume_count;
    gaussian_scene *sets;
    volume_scene *volumes;
    const ewa_splats **splats;
    ewa_mixed_volume *mixed;
    ewa_volume_options *volume_options; ///< one for each volume
    ewa_volume_stats *volume_stats;     ///< likewise, of the last frame
    ewa_cloud *outline;                 ///< of everything
    int up_axis;                        ///< as view_arguments have it
    double near_world;
    ewa_context *context;
    ewa_gaussian_renderer *renderer;
    ewa_image surface_rgba, surface_depth; ///< of the size of the last frame
} mixture_scene;

/// Looks for the operands that hold Gaussians, unless they are to be surfels, and volumes, unless there is one and nothing
/// else. Returns false after reporting.
bool mixture_scene_find(cli_session *session, const common_arguments *common,
                        const mixture_arguments *arguments, mixture_scene *scene);

/// Whether there is any.
static inline bool mixture_scene_some(const mixture_scene *scene) {
    return scene->splats_count + scene->volume_count > 0;
}

/// The name of the first one.
const char *mixture_scene_path(const mixture_scene *scene);

/// Loads them; `others` (may be NULL) are in the outline, too. Returns false after reporting.
bool mixture_scene_load(cli_session *session, const mixture_arguments *arguments,
                        const light_arguments *light, const ewa_cloud *others, mixture_scene *scene);

/// Draws them over the background, or among surfels, which `renderer` draws.
ewa_status mixture_scene_paint(mixture_scene *scene, ewa_renderer *renderer, const ewa_surfels *surfels,
                               const ewa_camera *camera, const ewa_render_options *options,
                               const ewa_gaussian_options *gaussians, const ewa_frame *frame,
                               ewa_render_stats *stats);

void mixture_scene_free(mixture_scene *scene);

/// Draws surfels to planes of their own, over nothing, for what lets light through.
ewa_status mixture_paint_surface(ewa_context *context, ewa_renderer *renderer, const ewa_surfels *surfels,
                                 const ewa_camera *camera, const ewa_render_options *options, ewa_image *rgba,
                                 ewa_image *depth, ewa_render_stats *stats);

#endif
