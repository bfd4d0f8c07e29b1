// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scenes of a known amount of work.
#ifndef EWA_BENCH_SCENE_H
#define EWA_BENCH_SCENE_H

#include "cli/base/session.h"
#include "cli/bench/bench.h"

enum { BENCH_VARIANTS = 3 };

/// What a scene is measured with where the command line does not say; zeros end each list.
typedef struct bench_recipe {
    const char *name;
    double splats[BENCH_VARIANTS];
    double pixels[BENCH_VARIANTS]; ///< covered by a splat on average; none: the scene's own
    option_size sizes[BENCH_VARIANTS];
} bench_recipe;

/// By kind.
extern const bench_recipe bench_recipes[BENCH_SCENE_COUNT];

/// A scene that can be drawn.
typedef struct bench_scene {
    const char *name;
    char label[64]; ///< name, points and pixels, or the picture's size where it matters
    ewa_cloud *cloud;
    ewa_camera camera;
    ewa_cull cull;
    bool color_only;
    bool glossy;         ///< shaded with highlights from one direction
    bool in_all_ways;    ///< transparent, without edges, without light: beside the picture as it is
    double covered_px;   ///< by a splat on average; 0: unknown
    double unseen_share; ///< of the points: seen from behind, hidden, or outside
} bench_scene;

/// Makes a scene. `covered_px` 0: as large as the scene's own. Returns false after reporting; the caller
/// destroys the cloud either way.
bool bench_scene_make(cli_session *session, bench_scene_kind kind, uint64_t point_count, double covered_px,
                      const option_size *size, double prefilter_px, bench_scene *scene);

#endif
