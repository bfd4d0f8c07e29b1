// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clouds that octrees are made of in tests, their files, and how sets of points are compared.
#ifndef EWA_TESTS_LOD_SCENE_H
#define EWA_TESTS_LOD_SCENE_H

#include "io/scratch.h"

enum { LOD_MEMORY_BYTES = 1 << 26 }; ///< a region has at most 104,857 points

/// What the points of a cloud have beside their places.
typedef struct lod_look {
    bool colors;
    bool surfels; ///< normals and radii
} lod_look;

/// `count` points of a hilly ground over [-1, 1] x [-1, 1], those after the `first` of the sequence: coordinates are
/// multiples of 2^-20, colours change slowly.
ewa_cloud *lod_ground(ewa_context *context, uint64_t first, uint64_t count, lod_look look);

/// Saves a cloud in the test's folder and destroys it; LAS with steps of 2^-20.
void lod_save(ewa_cloud *cloud, const char *name);

/// Loads a cloud of the test's folder.
ewa_cloud *lod_load(ewa_context *context, const char *name);

/// Makes a file of the test's folder of some others in it; `options` may be NULL: LOD_MEMORY_BYTES.
ewa_status lod_build(ewa_context *context, const char *const *names, uint32_t count, const char *out,
                     const ewa_lod_build_options *options, ewa_lod_build_stats *stats);

/// Empties the test's folder and makes an octree there, of a ground of so many points with colours, normals and radii.
void lod_build_ground(uint64_t count, const char *out);

/// A point as its bytes are compared.
typedef struct lod_point {
    int64_t at[3]; ///< in steps of 2^-20, from 0
    int32_t color[3];
    int32_t radius, normal[3]; ///< in steps of 1e-6; 0 where they are not compared
    int32_t spare;
} lod_point;

/// The points of some clouds, sorted. `surfels` compares normals and radii too. The caller frees.
lod_point *lod_points(ewa_cloud *const *clouds, uint32_t cloud_count, bool surfels, uint64_t *count);

/// Fails unless both have the same points, in any order.
void lod_hold_same(ewa_cloud *const *inputs, uint32_t input_count, ewa_cloud *output, bool surfels);

/// Fails unless two files of the test's folder are the same bytes.
void lod_hold_same_files(const char *a, const char *b);

/// Whether a file is in the test's folder.
bool lod_is_there(const char *name);

/// Removes all files of the test's folder; returns how many there were.
int lod_clear(void);

#endif
