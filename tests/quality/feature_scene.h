// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Noisy samplings of solids whose sharp edges are known, and how well they are found.
#ifndef EWA_TESTS_FEATURE_SCENE_H
#define EWA_TESTS_FEATURE_SCENE_H

#include "check.h"

typedef enum feature_solid { SOLID_CUBE, SOLID_CYLINDER, SOLID_PART } feature_solid;

/// Exact samples, and where the sharp edges are.
typedef struct feature_scene {
    uint32_t count;
    double spacing;
    double (*place)[3];
    double (*edges)[2][3]; ///< ends of sharp edges; NULL: cube or cylinder, by formula
    double (*vague)[2][3]; ///< edges that are neither sharp nor smooth: points near them do not count
    uint32_t edge_count, vague_count;
    feature_solid solid;
} feature_scene;

/// Samples a solid with about `count` points; false (after saying so) when a part's file is missing. The cube
/// has edge 2, the cylinder radius 1 and height 2. The part is the mesh of `path`: edges between faces whose
/// normals differ by 35 degrees or more are sharp, from 20 to 35 degrees vague.
bool feature_scene_make(feature_solid solid, const char *path, uint32_t count, feature_scene *scene);
void feature_scene_free(feature_scene *scene);

/// What was found.
typedef struct feature_score {
    uint32_t clipped;                       ///< surfels with a clip line, vague ones left out
    double recall;                          ///< share clipped of the points within 1 spacing of a sharp edge
    double precision;                       ///< share of the clipped that are within 2 spacings of one
    double strict_recall, strict_precision; ///< both at 1.5 spacings
    double line_error; ///< root mean square distance, in spacings, of the line's point nearest to the surfel
                       ///< from the sharp edge; of the clipped within 2 spacings
    ewa_feature_counts counts;
    double seconds;
} feature_score;

/// Adds Gaussian noise of `noise` spacings to every coordinate, makes surfels of the bare positions and
/// detects features; the caller owns the cloud.
ewa_cloud *feature_scene_detect(ewa_context *context, const feature_scene *scene, double noise,
                                ewa_feature_counts *counts, double *seconds);

/// Detects features as above and compares them with the sharp edges.
void feature_scene_measure(ewa_context *context, const feature_scene *scene, double noise,
                           feature_score *score);

#endif
