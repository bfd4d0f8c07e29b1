// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cells of VTK as polygons. Of cells with a volume the outer surface is drawn: faces whose corners no other face has.
// Faces are told apart by their four lowest corners, which the faces of a grid that is none of all sorts share with no
// other; they are sorted by them, so that no file, however made, takes longer than that.
//
// Based on: Kitware, "VTK File Formats", The VTK User's Guide, 2010, figures 2 and 3; the order of corners, faces and
// middles of edges is that of vtkTetra, vtkHexahedron, vtkWedge, vtkPyramid and their quadratic likes.
#include "io/mesh/vtk_cells.h"
#include "base/base.h"

#include <stdlib.h>

enum { MAX_FACES = 8, MAX_CORNERS = 6, MAX_EDGES = 12, KEY_PLACES = 4 };

/// A flat cell or a solid: corners, faces and the edges whose middles follow the corners in cells of second order.
typedef struct shape {
    uint8_t corner_count, face_count, edge_count;
    uint8_t faces[MAX_FACES][1 + MAX_CORNERS]; ///< how many corners, which, counter-clockwise from outside
    uint8_t edges[MAX_EDGES][2];
} shape;

static const shape triangle = {3, 1, 3, {{3, 0, 1, 2}}, {{0, 1}, {1, 2}, {2, 0}}};
static const shape quad = {4, 1, 4, {{4, 0, 1, 2, 3}}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
static const shape pixel = {.corner_count = 4, .face_count = 1, .faces = {{4, 0, 1, 3, 2}}};
static const shape tetrahedron = {4,
                                  4,
                                  6,
                                  {{3, 0, 1, 3}, {3, 1, 2, 3}, {3, 2, 0, 3}, {3, 0, 2, 1}},
                                  {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
static const shape voxel = {
    .corner_count = 8,
    .face_count = 6,
    .faces = {{4, 0, 4, 6, 2}, {4, 1, 3, 7, 5}, {4, 0, 1, 5, 4}, {4, 2, 6, 7, 3}, {4, 0, 2, 3, 1}, {4, 4, 5, 7, 6}}};
static const shape hexahedron = {
    8,
    6,
    12,
    {{4, 0, 4, 7, 3}, {4, 1, 2, 6, 5}, {4, 0, 1, 5, 4}, {4, 3, 7, 6, 2}, {4, 0, 3, 2, 1}, {4, 4, 5, 6, 7}},
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
static const shape wedge = {6,
                            5,
                            9,
                            {{3, 0, 1, 2}, {3, 3, 5, 4}, {4, 0, 3, 4, 1}, {4, 1, 4, 5, 2}, {4, 2, 5, 3, 0}},
                            {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}};
static const shape pyramid = {5,
                              5,
                              8,
                              {{4, 0, 3, 2, 1}, {3, 0, 1, 4}, {3, 1, 2, 4}, {3, 2, 3, 4}, {3, 3, 0, 4}},
                              {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}};
static const shape pentagonal_prism = {.corner_count = 10,
                                       .face_count = 7,
                                       .faces = {{5, 0, 4, 3, 2, 1},
                                                 {5, 5, 6, 7, 8, 9},
                                                 {4, 0, 1, 6, 5},
                                                 {4, 1, 2, 7, 6},
                                                 {4, 2, 3, 8, 7},
                                                 {4, 3, 4, 9, 8},
                                                 {4, 4, 0, 5, 9}}};
static const shape hexagonal_prism = {.corner_count = 12,
                                      .face_count = 8,
                                      .faces = {{6, 0, 5, 4, 3, 2, 1},
                                                {6, 6, 7, 8, 9, 10, 11},
                                                {4, 0, 1, 7, 6},
                                                {4, 1, 2, 8, 7},
                                                {4, 2, 3, 9, 8},
                                                {4, 3, 4, 10, 9},
                                                {4, 4, 5, 11, 10},
                                                {4, 5, 0, 6, 11}}};

enum { STRIP = EWA_VTK_STRIP, POLYGON = EWA_VTK_POLYGON, POLYHEDRON = 42 };

/// What is drawn of a kind of cells: a shape, with the middles of its edges or without.
typedef struct cell_kind {
    uint8_t kind;
    const shape *shape;
    bool curved;
} cell_kind;

static const cell_kind cell_kinds[] = {
    {5, &triangle, false},
    {8, &pixel, false},
    {9, &quad, false},
    {10, &tetrahedron, false},
    {11, &voxel, false},
    {12, &hexahedron, false},
    {13, &wedge, false},
    {14, &pyramid, false},
    {15, &pentagonal_prism, false},
    {16, &hexagonal_prism, false},
    {22, &triangle, true},
    {23, &quad, true},
    {24, &tetrahedron, true},
    {25, &hexahedron, true},
    {26, &wedge, true},
    {27, &pyramid, true},
    {28, &quad, true},     // with its middle
    {29, &hexahedron, true}, // with the middles of its faces
    {30, &quad, false},    // of second order along one axis
    {31, &wedge, false},
    {32, &wedge, true},
    {33, &hexahedron, true},
    {34, &triangle, true},
    {37, &pyramid, true},
    // Of any order, by Lagrange and by Bezier.
    {69, &triangle, false},
    {70, &quad, false},
    {71, &tetrahedron, false},
    {72, &hexahedron, false},
    {73, &wedge, false},
    {74, &pyramid, false},
    {76, &triangle, false},
    {77, &quad, false},
    {78, &tetrahedron, false},
    {79, &hexahedron, false},
    {80, &wedge, false},
    {81, &pyramid, false},
};

/// Kinds that have no surface: lines, curves and points.
static bool is_line(uint32_t kind) { return kind == 3 || kind == 4 || kind == 21 || kind == 35 || kind == 68 || kind == 75; }
static bool is_point(uint32_t kind) { return kind <= 2; }

/// A cell, and how far its faces have been taken.
typedef struct cell {
    uint32_t kind, count;
    const uint32_t *places;
    const shape *shape; ///< NULL: a stream of faces, or none
    bool curved;
    uint32_t face, face_count, at; ///< the next face; of a stream, where it begins
} cell;

/// A face of a cell; `middles` of its edges, or NULL.
typedef struct cell_face {
    const uint32_t *places, *middles;
    uint32_t count, own_places[MAX_CORNERS], own_middles[MAX_CORNERS];
} cell_face;

/// A face of a solid by its lowest corners, ascending and each once, EWA_MESH_NONE behind the last.
typedef struct face_key {
    uint32_t places[KEY_PLACES], number;
} face_key;

typedef struct vtk_surface {
    ewa_mesh_build *build;
    const ewa_vtk_cells *cells;
    ewa_mesh_list corners; ///< of one polygon
    ewa_mesh_list keys;    ///< of all faces of solids
    ewa_mesh_list shared;  ///< by number of a face: whether it is none of the surface
    uint64_t unknown_count;
} vtk_surface;

/// Makes a cell of the numbers at `at`. Flat cells have a face; strips, lines and what is unknown have none.
static cell take_cell(const ewa_vtk_cells *cells, uint64_t index, uint64_t at) {
    cell taken = {.kind = cells->kinds[index], .count = cells->numbers[at], .places = cells->numbers + at + 1};
    if (taken.kind == POLYHEDRON && taken.count) {
        taken.face_count = taken.places[0];
        taken.at = 1;
    }
    for (size_t i = 0; i < sizeof cell_kinds / sizeof cell_kinds[0]; i++) {
        if (cell_kinds[i].kind != taken.kind) continue;
        const shape *its = cell_kinds[i].shape;
        taken.shape = its;
        taken.curved = cell_kinds[i].curved && taken.count >= (uint32_t)(its->corner_count + its->edge_count);
        taken.face_count = taken.count >= its->corner_count ? its->face_count : 0;
    }
    return taken;
}

static bool is_solid(const cell *taken) {
    return taken->kind == POLYHEDRON || (taken->shape && taken->shape->face_count > 1);
}

/// The middle of the edge between two corners.
static uint32_t middle_of(const cell *from, uint8_t a, uint8_t b) {
    const shape *its = from->shape;
    for (uint32_t e = 0; e < its->edge_count; e++)
        if ((its->edges[e][0] == a && its->edges[e][1] == b) || (its->edges[e][0] == b && its->edges[e][1] == a))
            return from->places[its->corner_count + e];
    return EWA_MESH_NONE;
}

/// Takes the next face of a cell; false behind the last, or where a stream ends early.
static bool next_face(cell *from, cell_face *face) {
    if (from->face == from->face_count) return false;
    *face = (cell_face){0};
    if (!from->shape) {
        if (from->at >= from->count || from->places[from->at] > from->count - from->at - 1) return false;
        face->count = from->places[from->at];
        face->places = from->places + from->at + 1;
        from->at += 1 + face->count;
        from->face++;
        return true;
    }
    const uint8_t *which = from->shape->faces[from->face++];
    face->count = which[0];
    for (uint32_t k = 0; k < face->count; k++) {
        face->own_places[k] = from->places[which[1 + k]];
        if (from->curved) face->own_middles[k] = middle_of(from, which[1 + k], which[1 + (k + 1) % face->count]);
    }
    face->places = face->own_places;
    face->middles = from->curved ? face->own_middles : NULL;
    return true;
}

static ewa_status add_polygon(vtk_surface *surface, const uint32_t *places, uint64_t count) {
    ewa_status status = EWA_OK;
    surface->corners.count = 0;
    for (uint64_t i = 0; i < count; i++) {
        ewa_mesh_corner *corner = ewa_mesh_list_add(surface->build, &surface->corners, &status);
        if (!corner) return status;
        *corner = (ewa_mesh_corner){places[i], EWA_MESH_NONE, surface->cells->has_normals ? places[i] : EWA_MESH_NONE};
    }
    return ewa_mesh_add_polygon(surface->build, surface->corners.items, count);
}

/// Adds a face; one with middles as triangles at its corners, and the polygon that is left between them.
static ewa_status add_face(vtk_surface *surface, const cell_face *face) {
    if (!face->middles) return add_polygon(surface, face->places, face->count);
    for (uint32_t k = 0; k < face->count; k++) {
        const uint32_t before = face->middles[(k + face->count - 1) % face->count];
        EWA_TRY(add_polygon(surface, (const uint32_t[3]){before, face->places[k], face->middles[k]}, 3));
    }
    return add_polygon(surface, face->middles, face->count);
}

/// Adds the key of a face of a solid; its number is how many were before.
static ewa_status add_key(vtk_surface *surface, const cell_face *face) {
    ewa_status status = EWA_OK;
    face_key *key = ewa_mesh_list_add(surface->build, &surface->keys, &status);
    if (!key) return status;
    *key = (face_key){.number = (uint32_t)(surface->keys.count - 1)};
    for (uint32_t k = 0; k < KEY_PLACES; k++) key->places[k] = EWA_MESH_NONE;
    for (uint32_t i = 0; i < face->count; i++) {
        uint32_t place = face->places[i];
        for (uint32_t k = 0; k < KEY_PLACES && place != key->places[k]; k++) {
            const uint32_t kept = key->places[k];
            if (place > kept) continue;
            key->places[k] = place;
            place = kept;
        }
    }
    return EWA_OK;
}

static int compare_keys(const void *a, const void *b) {
    const face_key *left = a, *right = b;
    for (int k = 0; k < KEY_PLACES; k++)
        if (left->places[k] != right->places[k]) return left->places[k] < right->places[k] ? -1 : 1;
    return left->number < right->number ? -1 : left->number > right->number;
}

/// Notes which faces of solids have the corners of another, or none of an area.
static ewa_status find_shared(vtk_surface *surface) {
    const uint64_t count = surface->keys.count;
    face_key *keys = surface->keys.items;
    if (!count) return EWA_OK;
    EWA_TRY(ewa_mesh_list_grow(surface->build, &surface->shared, count));
    uint8_t *shared = surface->shared.items;
    memset(shared, 0, (size_t)count);
    qsort(keys, (size_t)count, sizeof *keys, compare_keys);
    for (uint64_t i = 0; i < count; i++) {
        // Faces of less than three corners, as of a wedge written as a hexahedron, have no area.
        if (keys[i].places[2] == EWA_MESH_NONE) shared[keys[i].number] = 1;
        if (i == 0 || memcmp(keys[i].places, keys[i - 1].places, sizeof keys[i].places) != 0) continue;
        shared[keys[i].number] = shared[keys[i - 1].number] = 1;
    }
    return ewa_progress(surface->build->context, "read", 0.5);
}

/// Adds what one cell shows; `*face_number` counts the faces of solids.
static ewa_status add_cell(vtk_surface *surface, cell *taken, uint64_t *face_number) {
    const uint8_t *shared = surface->shared.items;
    cell_face face;
    if (taken->kind == POLYGON || taken->kind == 36) return add_polygon(surface, taken->places, taken->count);
    for (uint32_t k = 0; taken->kind == STRIP && k + 2 < taken->count; k++)
        EWA_TRY(add_polygon(
            surface, (const uint32_t[3]){taken->places[k], taken->places[k + 1 + k % 2], taken->places[k + 2 - k % 2]}, 3));
    // Of curves the ends and the middles, which are behind them, are not in a row.
    if (is_line(taken->kind)) EWA_TRY(ewa_mesh_add_line(surface->build, taken->places, taken->kind > 4 && taken->count > 2 ? 2 : taken->count));
    const bool solid = is_solid(taken);
    while (next_face(taken, &face))
        if (!solid || !shared[(*face_number)++]) EWA_TRY(add_face(surface, &face));
    const bool known = taken->shape || taken->kind == STRIP || is_line(taken->kind) || is_point(taken->kind) ||
                       (taken->kind == POLYHEDRON && taken->count > 0);
    surface->unknown_count += !known;
    return EWA_OK;
}

static ewa_status add_all(vtk_surface *surface) {
    const ewa_vtk_cells *cells = surface->cells;
    ewa_mesh_build *build = surface->build;
    uint64_t face_number = 0, next[4] = {build->cell_count}; ///< by group, the number of its next cell
    for (int group = 1; group < 4 && cells->group_counts; group++) next[group] = next[group - 1] + cells->group_counts[group - 1];
    for (int pass = 0; pass < 2; pass++) {
        for (uint64_t i = 0, at = 0; at < cells->number_count && i < cells->kind_count; i++) {
            cell taken = take_cell(cells, i, at);
            cell_face face;
            at += 1 + (uint64_t)taken.count;
            if (pass == 1 && build->has_cell_data)
                ewa_mesh_begin_cell(build, cells->group_counts ? next[ewa_vtk_group(taken.kind)]++ : build->cell_count + i);
            if (pass == 1) EWA_TRY(add_cell(surface, &taken, &face_number));
            while (pass == 0 && is_solid(&taken) && next_face(&taken, &face)) EWA_TRY(add_key(surface, &face));
        }
        if (pass == 0) EWA_TRY(find_shared(surface));
    }
    if (surface->unknown_count)
        ewa_report(build->context, EWA_SEVERITY_WARNING, "%s: VTK: %llu cells of a kind that is not known are left out",
                   build->source->name, (unsigned long long)surface->unknown_count);
    return EWA_OK;
}

ewa_status ewa_vtk_add_cells(ewa_mesh_build *build, const ewa_vtk_cells *cells) {
    vtk_surface surface = {.build = build,
                           .cells = cells,
                           .corners = {.item_bytes = sizeof(ewa_mesh_corner)},
                           .keys = {.item_bytes = sizeof(face_key)},
                           .shared = {.item_bytes = 1}};
    const ewa_status status = add_all(&surface);
    ewa_mesh_list *const lists[] = {&surface.corners, &surface.keys, &surface.shared};
    for (int i = 0; i < 3; i++) ewa_release(build->context, lists[i]->items, lists[i]->capacity, lists[i]->item_bytes);
    return status;
}

/// Adds a side of a grid: the places at one end of an axis, in squares that turn left from outside.
static ewa_status add_side(ewa_mesh_build *build, uint64_t first, const uint64_t counts[3], int axis, bool far,
                           bool has_normals) {
    const uint64_t steps[3] = {1, counts[0], counts[0] * counts[1]};
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const uint64_t width = counts[0] > 1 ? counts[0] - 1 : 1, cell_steps[3] = {1, width, width * (counts[1] > 1 ? counts[1] - 1 : 1)};
    const uint64_t first_cell = build->cell_count + (far && counts[axis] > 1 ? (counts[axis] - 2) * cell_steps[axis] : 0);
    first += far ? (counts[axis] - 1) * steps[axis] : 0;
    const uint64_t across = steps[far ? u : v], along = steps[far ? v : u];
    for (uint64_t y = 0; y + 1 < counts[v]; y++) {
        for (uint64_t x = 0; x + 1 < counts[u]; x++) {
            const uint64_t at = first + x * steps[u] + y * steps[v];
            if (build->has_cell_data) ewa_mesh_begin_cell(build, first_cell + x * cell_steps[u] + y * cell_steps[v]);
            const uint64_t places[4] = {at, at + across, at + across + along, at + along};
            ewa_mesh_corner corners[4];
            for (int k = 0; k < 4; k++)
                corners[k] = (ewa_mesh_corner){(uint32_t)places[k], EWA_MESH_NONE,
                                               has_normals ? (uint32_t)places[k] : EWA_MESH_NONE};
            EWA_TRY(ewa_mesh_add_polygon(build, corners, 4));
        }
    }
    return EWA_OK;
}

ewa_status ewa_vtk_add_sides(ewa_mesh_build *build, uint64_t first, const uint64_t counts[3], bool has_normals) {
    // Of a sheet, the sides along it have no squares.
    const bool flat = counts[0] == 1 || counts[1] == 1 || counts[2] == 1;
    for (int axis = 0; axis < 3; axis++) {
        EWA_TRY(add_side(build, first, counts, axis, true, has_normals));
        if (!flat) EWA_TRY(add_side(build, first, counts, axis, false, has_normals));
    }
    return EWA_OK;
}
