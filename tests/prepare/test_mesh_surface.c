// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Inner functions of sampling: which way vertices face where triangles meet, which edges cut a disc.
#include "mesh/clip.h"
#include "mesh/surface.h"
#include "mesh_shapes.h"

#define RADIANS (3.141592653589793 / 180)

static ewa_mesh_sample_options options_of(double spacing_world) {
    WITH_DEFAULTS(ewa_mesh_sample_options, options);
    options.spacing_world = spacing_world;
    return options;
}

/// How far the normal of a vertex leans, in degrees, from a triangle that lies flat towards one that is bent
/// down by 30 degrees. The triangles share an edge; at the vertex they have these angles, and the other edges
/// there these lengths.
static double lean_of(ewa_context *context, const double angle_deg[2], const double length[2]) {
    static const uint32_t triangles[6] = {0, 1, 2, 0, 3, 1};
    const double bend = 30 * RADIANS, a = angle_deg[0] * RADIANS, b = angle_deg[1] * RADIANS;
    const double out = length[1] * sin(b);
    const double positions[4][3] = {{0, 0, 0},
                                    {1, 0, 0},
                                    {length[0] * cos(a), length[0] * sin(a), 0},
                                    {length[1] * cos(b), -out * cos(bend), -out * sin(bend)}};
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    shape_fill(context, 4, positions[0], 2, triangles, &mesh);
    const ewa_mesh_sample_options options = options_of(1e-3);
    OWNED(ewa_mesh_surface_free) mesh_surface surface;
    assert_int_equal(ewa_mesh_surface_make(&mesh, &options, &surface), EWA_OK);
    assert_int_equal(surface.triangle_count, 2);
    assert_int_equal(surface.corner_group[0], surface.corner_group[3]);
    const float *normal = surface.group_normal[surface.corner_group[0]];
    assert_true(fabsf(normal[0]) < 1e-6f);
    const double lean = atan2(-(double)normal[1], (double)normal[2]) / RADIANS;
    return lean;
}

/// A vertex faces more as that triangle does which has the larger angle there, whatever their areas; between
/// equal angles it faces half way.
TEST_ON(test_normal_of_vertex, 1) {
    static const double even[2] = {1, 1}, uneven[2] = {0.2, 7};
    for (double first = 20; first < 170; first += 20) {
        double last = 0;
        for (double second = 20; second < 170; second += 20) {
            const double angles[2] = {first, second}, lean = lean_of(context, angles, even);
            assert_float_equal(lean_of(context, angles, uneven), lean, 1e-4);
            assert_true(lean > last && lean < 30);
            if (second < first) assert_true(lean < 14.9);
            if (second > first) assert_true(lean > 15.1);
            if (second == first) assert_float_equal(lean, 15, 1e-4);
            last = lean;
        }
    }
}

enum { SIDES = 5 };

/// Corners of a convex plate in its plane, counterclockwise.
static const double outline[SIDES][2] = {{-1.1, -0.7}, {0.9, -0.9}, {1.3, 0.2}, {0.2, 1.1}, {-0.8, 0.6}};

/// Distance of a place inside of the plate from the line of a side, and from the side itself.
static void distances_from_side(const double at[2], int side, double *line, double *segment) {
    const double *a = outline[side], *b = outline[(side + 1) % SIDES];
    const double along[2] = {b[0] - a[0], b[1] - a[1]}, length = hypot(along[0], along[1]);
    const double to[2] = {at[0] - a[0], at[1] - a[1]};
    const double share = fmin(fmax((to[0] * along[0] + to[1] * along[1]) / (length * length), 0), 1);
    *line = (along[0] * to[1] - along[1] * to[0]) / length;
    *segment = hypot(to[0] - share * along[0], to[1] - share * along[1]);
}

/// The disc's line as the inward normal in the plate's plane and the distance from the centre has to be that
/// of a side.
static void check_line(const double line[3], const double turn[2], int side, const double at[2]) {
    const double *a = outline[side], *b = outline[(side + 1) % SIDES];
    const double length = hypot(b[0] - a[0], b[1] - a[1]);
    double distance, segment;
    distances_from_side(at, side, &distance, &segment);
    assert_true(fabs(line[2] - distance) < 1e-9);
    assert_true(fabs(line[0] * turn[0] - line[1] * turn[1] + (b[1] - a[1]) / length) < 1e-9);
    assert_true(fabs(line[0] * turn[1] + line[1] * turn[0] - (b[0] - a[0]) / length) < 1e-9);
}

/// A disc on a plate is cut by the two of its sides that are nearest, in whatever way its axes are turned.
TEST_ON(test_nearest_sides, 1) {
    enum { DISCS = 4000 };
    static const uint32_t triangles[9] = {0, 1, 2, 0, 2, 3, 0, 3, 4};
    const double tilt[2] = {0.8, 0.6}; // of the plate about x
    double positions[3 * SIDES];
    for (int i = 0; i < SIDES; i++) {
        positions[3 * i] = outline[i][0];
        positions[3 * i + 1] = tilt[0] * outline[i][1];
        positions[3 * i + 2] = tilt[1] * outline[i][1];
    }
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    shape_fill(context, SIDES, positions, 3, triangles, &mesh);
    const ewa_mesh_sample_options options = options_of(0.01);
    const double radius = 0.9;
    OWNED(ewa_mesh_surface_free) mesh_surface surface;
    OWNED(ewa_mesh_edge_grid_free) mesh_edge_grid grid;
    assert_int_equal(ewa_mesh_surface_make(&mesh, &options, &surface), EWA_OK);
    assert_int_equal(surface.edge_count, SIDES);
    assert_int_equal(ewa_mesh_edge_grid_make(&surface, radius, &grid), EWA_OK);
    check_random random = {11};
    uint32_t of_count[3] = {0}, dense = 0;
    for (int i = 0; i < DISCS; i++) {
        const double at[2] = {check_uniform(&random, -1.1, 1.3), check_uniform(&random, -0.9, 1.1)};
        const double angle = check_uniform(&random, 0, 360) * RADIANS, turn[2] = {cos(angle), sin(angle)};
        double line[SIDES], segment[SIDES];
        int first = 0, second = -1, within = 0;
        bool inside = true;
        for (int k = 0; k < SIDES; k++) {
            distances_from_side(at, k, &line[k], &segment[k]);
            inside = inside && line[k] > 0;
            within += segment[k] < radius;
            if (segment[k] < segment[first]) first = k;
        }
        for (int k = 0; k < SIDES; k++)
            if (k != first && (second < 0 || segment[k] < segment[second])) second = k;
        // Sides that only touch the disc's rim may lie on the line of another.
        const double rim = 0.8 * radius;
        if (!inside || (segment[first] > rim && segment[first] < radius) ||
            (segment[second] > rim && segment[second] < radius))
            continue;
        mesh_clip_disc disc = {.radius_world = radius,
                               .part = surface.part[0],
                               .u = {turn[0], tilt[0] * turn[1], tilt[1] * turn[1]},
                               .v = {-turn[1], tilt[0] * turn[0], tilt[1] * turn[0]},
                               .normal = {0, -tilt[1], tilt[0]},
                               .center = {at[0], tilt[0] * at[1], tilt[1] * at[1]}};
        for (int c = 0; c < 3; c++) disc.center[c] -= surface.origin_world[c];
        ewa_mesh_clip_disc(&grid, &disc);
        const int sides[2] = {first, second};
        uint32_t count = 0;
        for (int k = 0; k < 2; k++) {
            if (segment[sides[k]] < radius) {
                check_line(disc.line[k], turn, sides[k], at);
                count++;
            } else {
                assert_true(disc.line[k][0] == 0 && disc.line[k][1] == 0);
            }
        }
        assert_false(disc.either);
        of_count[count]++;
        dense += within > 2;
    }
    print_message("%u discs with two lines, %u of them reach more sides; %u with one, %u with none\n",
                  of_count[2], dense, of_count[1], of_count[0]);
    assert_true(of_count[2] > 1000 && dense > 200 && of_count[1] > 20);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
