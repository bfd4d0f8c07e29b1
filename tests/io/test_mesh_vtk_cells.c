// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cells of VTK that have a volume, and its grids: each kind closes, turns outward and has the volume that geometry says;
// faces between two cells are gone; what is broken is refused or left out.
#include "io/mesh_fixture.h"

static const double PI = 3.14159265358979323846, R2 = 1.41421356237309504880, R3 = 1.73205080756887729353;

#define HEAD "# vtk DataFile Version 3.0\na title\nASCII\n"
#define GRID HEAD "DATASET UNSTRUCTURED_GRID\n"

/// A cube's corners in the order of hexahedra, the same one above it, and its tip.
#define CUBE  "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1 "
#define ABOVE "0 0 2 1 0 2 1 1 2 0 1 2 0.5 0.5 1.5 "

/// Volume by the theorem of Gauss, and whether the triangles close.
static double volume_of(const ewa_mesh *mesh) {
    double volume = 0, area[3], sum[3];
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const double *p = mesh->positions + 3 * (size_t)mesh->triangles[3 * t];
        mesh_area_vector(mesh, t, area);
        volume += (p[0] * area[0] + p[1] * area[1] + p[2] * area[2]) / 3;
    }
    mesh_area(mesh, sum);
    for (int c = 0; c < 3; c++) assert_float_equal(sum[c], 0, 1e-12);
    return volume;
}

/// Checks the area, the volume and the number of faces of a text; messages may be said.
static void check(const char *text, double area, double volume, uint32_t triangles) {
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    mesh_load_bytes(context, &messages, "a.vtk", text, strlen(text), true, &mesh);
    if (fabs(mesh_area(&mesh, NULL) - area) > 1e-9 || fabs(volume_of(&mesh) - volume) > 1e-9 ||
        (triangles && mesh.triangle_count != triangles))
        fail_msg("area %.12g, volume %.12g, %u triangles of %s", mesh_area(&mesh, NULL), volume_of(&mesh),
                 mesh.triangle_count, text);
}

CASE(test_solids) {
    const double s5 = sin(PI / 5) * cos(PI / 5) * 5, s6 = 1.5 * R3;
    check(GRID "POINTS 4 float 0 0 0 1 0 0 0 1 0 0 0 1 CELLS 1 5 4 0 1 2 3 CELL_TYPES 1 10\n", 1.5 + R3 / 2, 1.0 / 6, 4);
    check(GRID "POINTS 8 float 0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1 CELLS 1 9 8 0 1 2 3 4 5 6 7\n"
               "CELL_TYPES 1 11\n",
          6, 1, 12);
    check(GRID "POINTS 8 float " CUBE "CELLS 1 9 8 0 1 2 3 4 5 6 7 CELL_TYPES 1 12\n", 6, 1, 12);
    // The triangle 0 1 2 of a wedge is seen from outside as it turns left.
    check(GRID "POINTS 6 float 0 0 0 0 1 0 1 0 0 0 0 1 0 1 1 1 0 1 CELLS 1 7 6 0 1 2 3 4 5 CELL_TYPES 1 13\n", 3 + R2, 0.5,
          8);
    check(GRID "POINTS 5 float 0 0 0 2 0 0 2 2 0 0 2 0 1 1 1 CELLS 1 6 5 0 1 2 3 4 CELL_TYPES 1 14\n", 4 + 4 * R2, 4.0 / 3,
          6);
    for (int sides = 5; sides <= 6; sides++) {
        char text[2048];
        size_t size = (size_t)snprintf(text, sizeof text, GRID "POINTS %d double\n", 2 * sides);
        for (int i = 0; i < 2 * sides; i++)
            size += (size_t)snprintf(text + size, sizeof text - size, "%.17g %.17g %d\n", cos(2 * PI * i / sides),
                                     sin(2 * PI * i / sides), i / sides);
        size += (size_t)snprintf(text + size, sizeof text - size, "CELLS 1 %d %d", 2 * sides + 1, 2 * sides);
        for (int i = 0; i < 2 * sides; i++) size += (size_t)snprintf(text + size, sizeof text - size, " %d", i);
        snprintf(text + size, sizeof text - size, "\nCELL_TYPES 1 %d\n", sides + 10);
        const double base = sides == 5 ? s5 : s6;
        check(text, 2 * base + 2 * sides * sin(PI / sides), base, 0);
    }
}

/// Cells of second order whose middles stand out, and of higher order, of which corners count.
CASE(test_curved) {
    // Middles on the edges change nothing but the number of triangles: two and two at the corners of each face.
    check(GRID "POINTS 10 float 0 0 0 2 0 0 0 2 0 0 0 2 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 0 1 1\n"
               "CELLS 1 11 10 0 1 2 3 4 5 6 7 8 9 CELL_TYPES 1 24\n",
          6 + 2 * R3, 8.0 / 6, 16);
    // A square whose middles are at 1.5 from the centre: an octagon, not the square.
    ewa_mesh mesh;
    mesh_load_text(context, &messages, "a.vtk",
                   GRID "POINTS 8 float -1 -1 0 1 -1 0 1 1 0 -1 1 0 0 -1.5 0 1.5 0 0 0 1.5 0 -1.5 0 0\n"
                        "CELLS 1 9 8 0 1 2 3 4 5 6 7 CELL_TYPES 1 23\n",
                   &mesh);
    assert_float_equal(mesh_area(&mesh, NULL), 6, 1e-12);
    ewa_mesh_free(&mesh);
    static const char *const kinds[] = {"25", "29", "33", "72", "79"};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        char text[1024];
        snprintf(text, sizeof text,
                 GRID "POINTS 20 float " CUBE "0.5 0 0 1 0.5 0 0.5 1 0 0 0.5 0 0.5 0 1 1 0.5 1 0.5 1 1 0 0.5 1\n"
                      "0 0 0.5 1 0 0.5 1 1 0.5 0 1 0.5\n"
                      "CELLS 1 21 20 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 CELL_TYPES 1 %s\n",
                 kinds[i]);
        check(text, 6, 1, i < 3 ? 36 : 12);
    }
}

/// Of faces that two cells share none is left, whatever kinds they are and however their corners turn.
CASE(test_shared) {
    static const struct {
        const char *cells;
        double area, volume;
        uint32_t triangles;
    } cases[] = {
        {"CELLS 2 18 8 0 1 2 3 4 5 6 7 8 4 5 6 7 8 9 10 11 CELL_TYPES 2 12 12", 10, 2, 20},
        {"CELLS 2 18 8 0 1 2 3 4 5 6 7 8 11 8 9 10 7 4 5 6 CELL_TYPES 2 12 12", 10, 0, 20}, // the other is inside out
        {"CELLS 2 15 8 0 1 2 3 4 5 6 7 5 4 5 6 7 12 CELL_TYPES 2 12 14", 5 + R2, 1 + 1.0 / 6, 14},
        {"CELLS 2 14 6 0 1 4 3 2 7 6 1 5 4 2 6 7 CELL_TYPES 2 13 13", 6, 1, 12},
        // A hexahedron two of whose corners are the same, beside a wedge.
        {"CELLS 2 16 8 0 1 2 2 4 5 6 6 6 0 2 3 4 6 7 CELL_TYPES 2 12 13", 6, 0, 12},
        {"CELLS 3 27 8 0 1 2 3 4 5 6 7 8 4 5 6 7 8 9 10 11 8 0 1 2 3 4 5 6 7 CELL_TYPES 3 12 12 12", 5, 0, 10},
        {"CELLS 2 13 8 0 1 2 3 4 5 6 7 3 4 5 12 CELL_TYPES 2 12 5", 6 + R2 / 4, 0, 13}, // flat ones stay
        // A polyhedron: seven faces, of which one is that of the cube below.
        {"CELLS 2 40 8 0 1 2 3 4 5 6 7 30 6 4 4 5 6 7 4 4 5 9 8 4 5 6 10 9 4 6 7 11 10 4 7 4 8 11 3 8 9 10\n"
         "CELL_TYPES 2 12 42",
         9.5, 0, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[1024];
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        snprintf(text, sizeof text, GRID "POINTS 13 float " CUBE ABOVE "%s\n", cases[i].cells);
        mesh_load_bytes(context, &messages, "a.vtk", text, strlen(text), true, &mesh);
        if (fabs(mesh_area(&mesh, NULL) - cases[i].area) > 1e-12 ||
            (cases[i].triangles && mesh.triangle_count != cases[i].triangles))
            fail_msg("area %.12g, %u triangles of %s", mesh_area(&mesh, NULL), mesh.triangle_count, text);
        if (cases[i].volume > 0) assert_float_equal(volume_of(&mesh), cases[i].volume, 1e-12);
    }
}

CASE(test_grids) {
    // Structured: a block, inside out where its axes are left-handed; a sheet; scalars behind it are stepped over.
    check(HEAD "DATASET STRUCTURED_GRID\nDIMENSIONS 3 2 2\nPOINTS 12 float\n"
               "0 0 0 1 0 0 2 0 0 0 1 0 1 1 0 2 1 0 0 0 3 1 0 3 2 0 3 0 1 3 1 1 3 2 1 3\n"
               "POINT_DATA 12\nSCALARS s float\nLOOKUP_TABLE default\n1 2 3 4 5 6 7 8 9 10 11 12\n",
          22, 6, 20);
    ewa_mesh mesh;
    double sum[3];
    mesh_load_text(context, &messages, "a.vtk",
                   HEAD "DATASET STRUCTURED_GRID\nDIMENSIONS 2 1 3\nPOINTS 6 float\n"
                        "0 0 0 1 0 0 0 0 1 1 0 1 0 0 2 1 0 2\n",
                   &mesh);
    assert_int_equal(mesh.triangle_count, 4);
    assert_float_equal(mesh_area(&mesh, sum), 2, 0);
    assert_float_equal(sum[1], 2, 0);
    ewa_mesh_free(&mesh);
    check(HEAD "DATASET RECTILINEAR_GRID\nDIMENSIONS 3 3 2\nX_COORDINATES 3 double\n0 1 4\nY_COORDINATES 3 float\n1 2 3\n"
               "Z_COORDINATES 2 float\n-1 0\n",
          28, 8, 32);
    char path[512];
    const char *text = HEAD "DATASET RECTILINEAR_GRID\n";
    scratch_write(scratch_path("a.vtk", path), text, strlen(text));
    assert_false(ewa_volume_is_file(context, path));
}

CASE(test_refused) {
    static const struct {
        const char *text, *said;
    } broken[] = {
        {HEAD "DATASET STRUCTURED_GRID\nDIMENSIONS 2 2\nPOINTS 4 float\n", "DIMENSIONS are no three numbers"},
        {HEAD "DATASET STRUCTURED_GRID\nDIMENSIONS 2 0 2\n", "DIMENSIONS are no three numbers"},
        {HEAD "DATASET STRUCTURED_GRID\nDIMENSIONS 2 2 2\nPOINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\n",
         "not as many POINTS as DIMENSIONS say"},
        {HEAD "DATASET STRUCTURED_GRID\nDIMENSIONS 4294967296 4294967296 1\nPOINTS 0 float\n",
         "not as many POINTS as DIMENSIONS say"},
        {HEAD "DATASET RECTILINEAR_GRID\nDIMENSIONS 2 2 1\nX_COORDINATES 2 float 0 1\nZ_COORDINATES 1 float 0\n",
         "not as many coordinates as DIMENSIONS say"},
        {HEAD "DATASET RECTILINEAR_GRID\nDIMENSIONS 2 2 1\nX_COORDINATES float\n", "coordinates have no number and type"},
        {GRID "POINTS 8 float " CUBE "CELLS 1 9 8 0 1 2 3 4 5 6 9 CELL_TYPES 1 10\n", NULL}, // more corners than its kind has
        {GRID "POINTS 8 float " CUBE "CELLS 1 9 8 8 9 10 11 12 13 14 15 CELL_TYPES 1 12\n", "none of the faces can be used"},
        {GRID "POINTS 8 float " CUBE "CELLS 1 4 3 0 1 2 CELL_TYPES 1 12\n", NULL}, // no corners for a face: points
        {GRID "POINTS 8 float " CUBE "CELLS 1 6 5 2 3 0 1 2 CELL_TYPES 1 42\n", NULL}, // a stream that ends early
        {GRID "POINTS 8 float " CUBE "CELLS 1 3 2 2 4000000000 CELL_TYPES 1 42\n", NULL},
        {GRID "POINTS 8 float " CUBE "CELLS 1 1 0 CELL_TYPES 1 42\n", NULL},
    };
    for (size_t i = 0; i < sizeof broken / sizeof broken[0]; i++) {
        if (broken[i].said) {
            mesh_refuse(context, &messages, "a.vtk", broken[i].text, strlen(broken[i].text), EWA_ERROR_FORMAT,
                        broken[i].said);
            continue;
        }
        OWNED(ewa_model_free) ewa_model model;
        assert_int_equal(ewa_model_load_memory(context, broken[i].text, strlen(broken[i].text), "a.vtk", NULL,
                                               EWA_MODEL_MESH, NULL, &model),
                         EWA_OK);
    }
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    static const char odd[] = GRID "POINTS 8 float " CUBE "CELLS 2 12 8 0 1 2 3 4 5 6 7 2 0 1 CELL_TYPES 2 12 99\n";
    mesh_load_bytes(context, &messages, "a.vtk", odd, sizeof odd - 1, true, &mesh);
    mesh_says(&messages, "1 cells of a kind that is not known are left out");
}

static ewa_status load_failing(ewa_context *failing, void *user) {
    static const char text[] =
        GRID "POINTS 13 float " CUBE ABOVE "CELLS 2 18 8 0 1 2 3 4 5 6 7 8 4 5 6 7 8 9 10 11 CELL_TYPES 2 12 12\n";
    OWNED(ewa_model_free) ewa_model model;
    const ewa_status status =
        ewa_model_load_memory(failing, text, sizeof text - 1, "a.vtk", NULL, EWA_MODEL_MESH, NULL, &model);
    return status;
}

TEST(test_failing_allocations) { scratch_fail_each(load_failing, NULL); }

int main(void) { return RUN_TESTS(NULL, NULL); }
