// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which borders of a node's points are those of the surface: docs/math.md section 5, borders.
#include "lod/cell_borders.h"
#include "cloud/cloud.h"

#include <math.h>
#include <string.h>

enum { BLOCK = 256 };

/// From a face of a node's cube: radii within which all borders may be its, and up to which borders that lean towards it
/// may; and how much these lean at least.
static const double FACE_NEAR = 0.1, FACE_ROOM = 0.5, FACE_LEAN = 0.1;

/// A node's cube in the file.
typedef struct cell_faces {
    double low[3], side;
    bool inner[3][2];     ///< whether other nodes may have points beyond a face
    double to_file[3][4]; ///< of places in the world
    double scale;         ///< lengths of the file over the world's
} cell_faces;

bool ewa_cell_is_similar(const double m[16]) {
    double scale2[3], across = 0;
    for (int r = 0; r < 3; r++) {
        const double *a = m + 4 * r, *b = m + 4 * ((r + 1) % 3);
        scale2[r] = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
        across = fmax(across, fabs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]));
    }
    const double off = fmax(fabs(scale2[0] - scale2[1]), fabs(scale2[0] - scale2[2]));
    return fmax(off, across) <= 1e-6 * scale2[0];
}

/// The inverse of a map that keeps angles is its transpose over the square of its scale.
static void find_faces(const ewa_octree_facts *facts, const ewa_octree_key *key, const double m[16], cell_faces *faces) {
    const double scale2 = m[0] * m[0] + m[1] * m[1] + m[2] * m[2];
    faces->side = ldexp(facts->side_world, -key->level);
    faces->scale = 1 / sqrt(scale2);
    for (int r = 0; r < 3; r++) {
        faces->low[r] = facts->low_world[r] + key->cell[r] * faces->side;
        faces->inner[r][0] = key->cell[r] > 0;
        faces->inner[r][1] = key->cell[r] + 1 < 1 << key->level;
        faces->to_file[r][3] = 0;
        for (int c = 0; c < 3; c++) {
            faces->to_file[r][c] = m[4 * c + r] / scale2;
            faces->to_file[r][3] -= faces->to_file[r][c] * m[4 * c + 3];
        }
    }
}

/// Whether a border may be where the node's cube ended the points.
static bool is_at_face(const cell_faces *faces, const double world[3], const double to_world[3], double radius_world) {
    const double radius = radius_world * faces->scale;
    const double length =
        sqrt(to_world[0] * to_world[0] + to_world[1] * to_world[1] + to_world[2] * to_world[2]) * faces->scale;
    for (int r = 0; r < 3; r++) {
        const double *row = faces->to_file[r];
        const double at = row[0] * world[0] + row[1] * world[1] + row[2] * world[2] + row[3] - faces->low[r];
        const double along = row[0] * to_world[0] + row[1] * to_world[1] + row[2] * to_world[2];
        for (int end = 0; end < 2; end++) {
            const double distance = end ? faces->side - at : at, towards = end ? along : -along;
            if (!faces->inner[r][end]) continue;
            if (distance < FACE_NEAR * radius) return true;
            if (towards > FACE_LEAN * length && distance - towards < FACE_ROOM * radius) return true;
        }
    }
    return false;
}

/// Whether borders and radii are the estimate's; a file may call by these names what it likes.
static bool are_discs(const ewa_attribute *border, const ewa_attribute *radius) {
    return border->type == EWA_F32 && border->component_count == 3 && border->stride_bytes == 3 * sizeof(float) && radius &&
           radius->component_count == 1;
}

static bool is_border(const double to[3]) { return to[0] != 0 || to[1] != 0 || to[2] != 0; }

void ewa_cell_keep_borders(const ewa_octree_facts *facts, const ewa_octree_key *key, const double to_world[16],
                           ewa_cloud *cloud) {
    const ewa_attribute *border = ewa_cloud_find(cloud, EWA_BORDER);
    const ewa_attribute *radius = ewa_cloud_find(cloud, EWA_RADIUS);
    if (!border) return;
    if (!are_discs(border, radius) || (key->level > 0 && !ewa_cell_is_similar(to_world))) {
        ewa_cloud_remove(cloud, EWA_BORDER);
        return;
    }
    if (key->level == 0) return;
    cell_faces faces;
    find_faces(facts, key, to_world, &faces);
    double origin[3], places[3 * BLOCK], borders[3 * BLOCK], radii[BLOCK];
    ewa_cloud_origin(cloud, origin);
    float *out = border->data;
    const uint64_t all = ewa_cloud_point_count(cloud);
    for (uint64_t first = 0; first < all; first += BLOCK) {
        const uint64_t count = all - first < BLOCK ? all - first : BLOCK;
        ewa_attribute_read_f64(ewa_cloud_find(cloud, EWA_POSITION), first, count, places);
        ewa_attribute_read_f64(border, first, count, borders);
        ewa_attribute_read_f64(radius, first, count, radii);
        for (uint64_t i = 0; i < count; i++) {
            if (!is_border(&borders[3 * i])) continue;
            for (uint64_t c = 0; c < 3; c++) places[3 * i + c] += origin[c];
            if (is_at_face(&faces, &places[3 * i], &borders[3 * i], radii[i]))
                memset(out + 3 * (first + i), 0, 3 * sizeof *out);
        }
    }
}

void ewa_cell_drop_empty_borders(ewa_cloud *cloud) {
    const ewa_attribute *border = ewa_cloud_find(cloud, EWA_BORDER);
    if (!border || border->component_count != 3) return;
    const uint64_t all = ewa_cloud_point_count(cloud);
    double borders[3 * BLOCK];
    for (uint64_t first = 0; first < all; first += BLOCK) {
        const uint64_t count = all - first < BLOCK ? all - first : BLOCK;
        ewa_attribute_read_f64(border, first, count, borders);
        for (uint64_t i = 0; i < count; i++)
            if (is_border(&borders[3 * i])) return;
    }
    ewa_cloud_remove(cloud, EWA_BORDER);
}
