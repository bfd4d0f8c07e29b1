// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Grids of heights: where the cells are, and which numbers are heights. What the readers of ASCII grids, GeoTIFF and
// terrain pictures share.
#ifndef EWA_SRC_HEIGHT_GRID_H
#define EWA_SRC_HEIGHT_GRID_H

#include "io/cloud/format.h"

/// Cells in rows; whoever reads a file fills it up to `origin_world`, ewa_height_grid_settle() does the rest.
typedef struct ewa_height_grid {
    uint64_t columns, rows;
    /// From column and row to the middle of the cell: x = [0] column + [1] row + [2], y = [3] column + [4] row + [5].
    double to_world[6];
    bool has_no_data;
    double no_data;    ///< the number that stands for no height, if the file says one
    bool is_degrees;   ///< x is a longitude, y a latitude, heights are metres
    double origin_world[3];
} ewa_height_grid;

/// Whether a number is a height: finite, of a size that is no mark, and not the number that stands for none.
bool ewa_height_is(const ewa_height_grid *grid, double number);

/// Whether the places of a grid can be longitudes and latitudes. One that does not say so is of degrees with metres for
/// heights where it is too steep as well.
bool ewa_height_grid_fits_degrees(const ewa_height_grid *grid);

/// Whether neighbouring cells that differ by `mean_step` on the average would have a slope of over 83 degrees if all were
/// in one unit.
bool ewa_height_grid_is_too_steep(const ewa_height_grid *grid, double mean_step);

/// Prepares a prototype for the points of a grid: their attribute, an origin near them. Degrees become metres to the east
/// and to the north of the grid's middle, by the ellipsoid of WGS 84 there, which a note and a message tell. Errors:
/// EWA_ERROR_FORMAT (places that are not finite), EWA_ERROR_MEMORY.
ewa_status ewa_height_grid_settle(const ewa_cloud_source *source, ewa_height_grid *grid, ewa_cloud *prototype);

/// Writes the position of a cell, relative to the origin.
void ewa_height_grid_place(const ewa_height_grid *grid, uint64_t column, uint64_t row, double height, uint8_t *to);

#endif
