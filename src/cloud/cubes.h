// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Points in groups by the cubes of an endless grid, whatever its extent and however few cubes hold points.
#ifndef EWA_SRC_CLOUD_CUBES_H
#define EWA_SRC_CLOUD_CUBES_H

#include "ewa/cloud.h"

/// The cells of an endless grid that is aligned to the world's origin, and cubes of some cells along each
/// edge. Coordinates of cells and cubes are whole numbers, in doubles so that every finite point has a cell.
typedef struct ewa_cell_frame {
    const ewa_attribute *position; ///< three components
    double origin_world[3];
    double cell_world;
    double cubes_per_cell; ///< a power of two, at most 1
} ewa_cell_frame;

/// Gives the cell of a point, and the point in units of cells.
void ewa_cell_of(const ewa_cell_frame *frame, uint64_t point, double cell[3], double at_cells[3]);

enum { EWA_MAX_BUCKETS = 4096 };

/// Runs of points that share a cube. A cube has a number: that of its bucket's first place plus its own in
/// the bucket.
typedef struct ewa_cubes {
    ewa_context *context;
    ewa_cell_frame frame;
    uint64_t capacity;     ///< points that the arrays have room for
    uint32_t bucket_count; ///< cubes are strewn over them by a hash
    uint32_t first_place[EWA_MAX_BUCKETS + 1], cube_count[EWA_MAX_BUCKETS];
    uint32_t *order;  ///< points, run by run
    uint32_t *starts; ///< by number of the cube: place of its first point in `order`
    uint32_t *slots;  ///< of each bucket: a hash table of its cubes
} ewa_cubes;

/// Groups the marked points; clears the marks of those with a coordinate that is not finite. Errors:
/// EWA_ERROR_MEMORY; free with ewa_cubes_free() in any case. Needs 22 bytes per point meanwhile, and 14 as
/// long as it lives.
ewa_status ewa_cubes_make(const ewa_cloud *cloud, const ewa_cell_frame *frame, uint8_t *marks,
                          ewa_cubes *cubes);
void ewa_cubes_free(ewa_cubes *cubes);

/// Returns the points of cube `number`, which is in `bucket`.
static inline const uint32_t *ewa_cubes_points(const ewa_cubes *cubes, uint32_t bucket, uint32_t number,
                                               uint32_t *count) {
    const uint32_t last = cubes->first_place[bucket] + cubes->cube_count[bucket] - 1;
    const uint32_t end = number < last ? cubes->starts[number + 1] : cubes->first_place[bucket + 1];
    *count = end - cubes->starts[number];
    return cubes->order + cubes->starts[number];
}

/// Finds the number of a cube; UINT32_MAX when it holds no point. Any thread.
uint32_t ewa_cubes_find(const ewa_cubes *cubes, const double cube[3]);

/// Scrambles three numbers to 64 bits; -0 counts as 0.
uint64_t ewa_hash3(const double numbers[3]);

/// Orders two points by their coordinates, then by the bytes of their other attributes: < 0, 0 or > 0.
int ewa_points_compare(const ewa_cloud *cloud, uint64_t a, uint64_t b);

#endif
