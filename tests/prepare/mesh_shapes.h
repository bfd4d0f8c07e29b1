// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Meshes for the tests of sampling.
#ifndef EWA_TESTS_MESH_SHAPES_H
#define EWA_TESTS_MESH_SHAPES_H

#include "check.h"

#include <math.h>
#include <string.h>

static inline void shape_fill(ewa_context *context, uint32_t vertex_count, const double *positions,
                              uint32_t triangle_count, const uint32_t *triangles, ewa_mesh *mesh) {
    assert_int_equal(ewa_mesh_create(context, vertex_count, triangle_count, 0, 0, mesh), EWA_OK);
    memcpy(mesh->positions, positions, vertex_count * 3 * sizeof *positions);
    memcpy(mesh->triangles, triangles, triangle_count * 3 * sizeof *triangles);
}

/// The cube from -1 to 1: vertex i has x, y, z from bits 0, 1, 2 of i.
static inline void shape_cube(ewa_context *context, ewa_mesh *mesh) {
    static const uint32_t triangles[36] = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                           2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    double positions[24];
    for (int i = 0; i < 24; i++) positions[i] = i / 3 >> i % 3 & 1 ? 1.0 : -1.0;
    shape_fill(context, 8, positions, 12, triangles, mesh);
}

/// The cube less its upper right quarter: an L along y, whose ends are polygons with a concave corner.
static inline void shape_angle(ewa_context *context, ewa_mesh *mesh) {
    static const double outline[6][2] = {{-1, -1}, {1, -1}, {1, 0}, {0, 0}, {0, 1}, {-1, 1}};
    static const uint32_t ends[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
    double positions[36];
    uint32_t triangles[60], count = 0;
    for (int i = 0; i < 12; i++) {
        positions[3 * i] = outline[i % 6][0];
        positions[3 * i + 1] = i < 6 ? -1.0 : 1.0;
        positions[3 * i + 2] = outline[i % 6][1];
    }
    for (int t = 0; t < 4; t++) {
        for (int c = 0; c < 3; c++) triangles[count++] = ends[t][c];
        for (int c = 0; c < 3; c++) triangles[count++] = 6 + ends[t][2 - c];
    }
    for (uint32_t i = 0; i < 6; i++) {
        const uint32_t next = (i + 1) % 6, sides[6] = {i, i + 6, next + 6, i, next + 6, next};
        for (int c = 0; c < 6; c++) triangles[count++] = sides[c];
    }
    shape_fill(context, 12, positions, 20, triangles, mesh);
}

/// A unit sphere of 2 * rows columns.
static inline void shape_sphere(ewa_context *context, uint32_t rows, ewa_mesh *mesh) {
    const uint32_t columns = 2 * rows;
    assert_int_equal(ewa_mesh_create(context, (rows + 1) * columns, 2 * rows * columns, 0, 0, mesh), EWA_OK);
    for (uint32_t r = 0; r <= rows; r++) {
        for (uint32_t c = 0; c < columns; c++) {
            const double polar = 3.141592653589793 * r / rows, around = 2 * 3.141592653589793 * c / columns;
            const double ring = r == 0 || r == rows ? 0 : sin(polar);
            double *p = mesh->positions + 3 * (r * columns + c);
            p[0] = ring * cos(around), p[1] = ring * sin(around), p[2] = cos(polar);
        }
    }
    uint32_t *t = mesh->triangles;
    for (uint32_t r = 0; r < rows; r++) {
        for (uint32_t c = 0; c < columns; c++, t += 6) {
            const uint32_t a = r * columns + c, b = r * columns + (c + 1) % columns;
            const uint32_t two[6] = {a, a + columns, b + columns, a, b + columns, b};
            memcpy(t, two, sizeof two);
        }
    }
}

/// World coordinates of a cloud's points, three each; the caller frees.
static inline double *shape_places(const ewa_cloud *cloud) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    double *places = malloc(3 * count * sizeof *places), origin[3];
    assert_non_null(places);
    ewa_attribute_read_f64(ewa_cloud_find(cloud, EWA_POSITION), 0, count, places);
    ewa_cloud_origin(cloud, origin);
    for (uint64_t i = 0; i < 3 * count; i++) places[i] += origin[i % 3];
    return places;
}

static inline ewa_cloud *shape_sample(const ewa_mesh *mesh, const ewa_mesh_sample_options *options) {
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_mesh_sample(mesh, options, &cloud), EWA_OK);
    assert_non_null(cloud);
    return cloud;
}

static inline const float *shape_stream(const ewa_cloud *cloud, const char *name) {
    const ewa_attribute *attribute = ewa_cloud_find(cloud, name);
    assert_non_null(attribute);
    assert_int_equal(attribute->type, EWA_F32);
    return attribute->data;
}

static inline ewa_mesh_sample_options shape_options(uint64_t point_count) {
    WITH_DEFAULTS(ewa_mesh_sample_options, options);
    options.point_count = point_count;
    return options;
}

#endif
