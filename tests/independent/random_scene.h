// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scenes by number: cameras, surfels and options of every kind, for the same pictures by three renderers.
#ifndef EWA_TESTS_RANDOM_SCENE_H
#define EWA_TESTS_RANDOM_SCENE_H

#include "tests/independent/independent.h"

enum { RANDOM_SCENE_MATERIALS = 4, RANDOM_SCENE_WORDS = 256 };

/// A scene in both forms: plain numbers and a cloud of the same.
typedef struct random_scene {
    independent_scene scene; ///< its unit_coverage is not set
    independent_surfel *surfels;
    ewa_material materials[RANDOM_SCENE_MATERIALS];
    ewa_environment *environment; ///< may be NULL, and so the next
    independent_environment *sky;
    ewa_cloud *cloud;
    ewa_surfels_options surfels_options;
    char words[RANDOM_SCENE_WORDS]; ///< what is special about it
} random_scene;

/// Makes scene `seed`, the same everywhere. Free with random_scene_free().
void random_scene_make(ewa_context *context, uint64_t seed, random_scene *made);
void random_scene_free(random_scene *made);

/// Makes one of the scenes that have names, false beyond the last.
bool named_scene_make(ewa_context *context, uint32_t index, random_scene *made);

/// Makes the cloud of a scene whose `surfels` are set, all discs or none. Positions are those of `surfels`
/// plus `origin`, of type EWA_F32 or EWA_F64; colours are EWA_U8, EWA_U16 or EWA_F32.
void scene_cloud_make(ewa_context *context, random_scene *made, const double origin[3], ewa_type positions,
                      ewa_type colors);

/// EWA_U8, EWA_U16 or EWA_F32 for 0, 1, 2; always EWA_F32 where a colour is brighter than 1.
ewa_type scene_cloud_color_type(const random_scene *made, uint32_t choice);

/// How far a picture is from the independent one, in decibels; the peak is 1.
///
/// color_db: over the four premultiplied linear numbers of all pixels, clamped to [0, 1]; where the scene is
/// brighter than 1, also unclamped with the brightest number as the peak, whichever is lower. Depth: of the
/// nearest surface, relative to the deepest of the picture; normal: unit vectors; coverage: over max(1,
/// coverage). A pixel that only one picture has is off by 1. Depth and normal leave out pixels that are
/// covered by less than a hundredth in either picture, where they are quotients of small numbers.
typedef struct random_scene_distance {
    double color_db, depth_db, normal_db, coverage_db;
    double decided_db; ///< color_db without the pixels that are doubtful (independent_picture)
    uint64_t doubtful_count;
    uint64_t codes_over; ///< numbers of rgba8 that are off by more than one
    double worst;        ///< largest difference of one number of the clamped colour
    uint32_t worst_px[2];
} random_scene_distance;

random_scene_distance random_scene_compare(const independent_picture *truth, const ewa_frame *frame);

/// Pictures of a scene by the pipeline and by the reference, each held to the independent one.
typedef struct random_scene_result {
    random_scene_distance pipeline, reference;
} random_scene_result;

/// Draws a scene three times; with `keep` (may be NULL), files keep-truth.png, keep-pipeline.png,
/// keep-reference.png and keep-difference.png (ten times) are written. Returns false where a call failed.
bool random_scene_run(ewa_context *context, random_scene *made, const char *keep,
                      random_scene_result *result);

#endif
