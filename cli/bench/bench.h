// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the options of ewa bench say to the program ewa-bench.
#ifndef EWA_CLI_BENCH_BENCH_H
#define EWA_CLI_BENCH_BENCH_H

#include "cli/render/view.h"

/// Scenes that ewa bench makes, in the order in which it measures them.
typedef enum bench_scene_kind {
    BENCH_PLANE,  ///< a plane that fills the picture, everything visible
    BENCH_COLOR,  ///< the same without normals in the pixels
    BENCH_LARGE,  ///< the same with ten times the points
    BENCH_HIDDEN, ///< three wavy sheets: in front, seen from behind, and hidden
    BENCH_POINTS, ///< a plane of discs far below a pixel
    BENCH_CULLED, ///< nothing to be seen: one sheet shows its back, another lies beside the picture
    BENCH_CLOSED, ///< a sphere that hides two others
    BENCH_SEEN,   ///< as many points on the side of the outer sphere that is seen
    BENCH_PEER,   ///< sphere and torus with the radii that close them
    BENCH_LAYERS, ///< the same without culling, drawn in several ways: what layers, edges and light cost
    BENCH_PHONG,  ///< the plane with highlights from a light of one direction
    BENCH_SCENE_COUNT
} bench_scene_kind;

/// The words for the kinds, as OPTION_SET takes them.
#define BENCH_SCENES "plane|color|large|hidden|points|culled|closed|seen|peer|layers|phong"

typedef struct bench_arguments {
    view_arguments view;   // first: it begins with the common arguments; only the size is an option here
    uint32_t scenes, cpus; ///< bits, in the order of the words
    bool files;
    option_vector splats, pixels, threads;
    int64_t frames;
    ewa_render_options render;
    bool stages;
    int backend;
    const char *against, *json_path;
} bench_arguments;

#endif
