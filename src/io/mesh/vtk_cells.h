// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cells of VTK as polygons: flat cells as they are, the outer surface of those with a volume, the sides of grids.
#ifndef EWA_SRC_VTK_CELLS_H
#define EWA_SRC_VTK_CELLS_H

#include "io/mesh/build.h"

/// Cells of VTK that readers name, by its numbers.
enum { EWA_VTK_VERTEX = 1, EWA_VTK_LINES = 4, EWA_VTK_STRIP = 6, EWA_VTK_POLYGON = 7 };

/// The group of polygonal data that a kind of cells is in: vertices, lines, polygons, strips, in which order their data go.
static inline int ewa_vtk_group(uint32_t kind) {
    return kind == EWA_VTK_VERTEX ? 0 : kind == EWA_VTK_LINES ? 1 : kind == EWA_VTK_POLYGON ? 2 : 3;
}

/// Cells as files have them.
typedef struct ewa_vtk_cells {
    const uint32_t *numbers; ///< of each cell how many corners, then which; of polyhedra their stream of faces
    uint64_t number_count;   ///< every cell ends within them
    const uint32_t *kinds;   ///< of VTK's numbers, by cell
    uint64_t kind_count;
    bool has_normals; ///< normals are those of places
    const uint64_t *group_counts; ///< of polygonal data, by group; NULL: cells' data go by cell
} ewa_vtk_cells;

/// Adds the polygons of cells: flat ones, and the faces of solids that no two of them share. Cells of second order have
/// the middles of their edges for corners, too; those of higher order are drawn by their corners. Kinds that are
/// unknown are counted in a warning. Data of cells are those from build->cell_count on. Errors: those of ewa_mesh_add_polygon(), EWA_CANCELLED.
ewa_status ewa_vtk_add_cells(ewa_mesh_build *build, const ewa_vtk_cells *cells);

/// Adds the sides of a grid of places, x fastest: six, or the one of a grid that has one place along an axis. From place
/// `first` on there are as many as the product of `counts`. Errors: as above.
ewa_status ewa_vtk_add_sides(ewa_mesh_build *build, uint64_t first, const uint64_t counts[3], bool has_normals);

#endif
