// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Legacy files of VTK: polygons, strips and flat cells in text and in bytes, old and new ways of writing cells, normals
// and colours of points, what is stepped over, what is refused, every truncation. Solids are test_mesh_vtk_cells.c's.
#include "io/mesh_fixture.h"

#define HEAD    "# vtk DataFile Version 3.0\na title\n"
#define TEXT    HEAD "ASCII\nDATASET POLYDATA\n"
#define POINTS  "POINTS 4 float\n0 0 0 2 0 0\n2 3 0 0 3 0\n"
#define SQUARE  TEXT POINTS "POLYGONS 1 5\n4 0 1 2 3\n"

/// Loads a mesh of the square, six of area.
static void load_square(const char *text, ewa_mesh *mesh) {
    double sum[3];
    mesh_load_text(context, &messages, "a.vtk", text, mesh);
    assert_int_equal(mesh->vertex_count >= 4, 1);
    assert_float_equal(mesh_area(mesh, sum), 6, 0);
    if (sum[2] != 6) fail_msg("%g of %s", sum[2], text);
}

CASE(test_cells) {
    static const char *const texts[] = {
        SQUARE,
        "\xef\xbb\xbf" SQUARE, // behind a byte order mark
        TEXT POINTS "POLYGONS 2 8\n3 0 1 2 3 0\n2 3\n",
        TEXT POINTS "TRIANGLE_STRIPS 1 5\n4 0 1 3 2\n",
        TEXT POINTS "VERTICES 1 2 1 0\nLINES 1 3 2 0 1\nPOLYGONS 1 5 4 0 1 2 3\n",
        "# vtk DataFile Version 5.1\nvtk output\nASCII\nDATASET POLYDATA\n" POINTS
        "METADATA\nINFORMATION 0\n\nPOLYGONS 3 6\nOFFSETS vtktypeint64\n0 3 6 \n"
        "CONNECTIVITY vtktypeint64\n0 1 2 0 2 3\n",
        HEAD "ascii\nDATASET UNSTRUCTURED_GRID\n" POINTS "CELLS 2 8\n3 0 1 2\n3 0 2 3\nCELL_TYPES 2\n5 5\n",
        HEAD "ASCII\r\nDATASET UNSTRUCTURED_GRID\r\n" POINTS "CELLS 1 5 4 0 1 3 2 CELL_TYPES 1 8\n",
        HEAD "ASCII\nDATASET UNSTRUCTURED_GRID\n" POINTS "CELLS 1 5 4 0 1 2 3 CELL_TYPES 1 9\n",
        SQUARE "CELL_DATA 1\nSCALARS s float 2\nLOOKUP_TABLE default\n1 2\nNORMALS n float\n0 0 1\n"
               "FIELD f 2\na 1 1 int\n7\nb 3 1 double\n1 2 3\nPOINT_DATA 4\nVECTORS v float\n1 2 3 1 2 3 1 2 3 1 2 3\n"
               "TEXTURE_COORDINATES t 2 float\n0 0 1 0 1 1 0 1\nLOOKUP_TABLE l 1\n1 1 1 1\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        if (i == 4) {
            mesh_load_bytes(context, &messages, "a.vtk", texts[i], strlen(texts[i]), true, &mesh);
            assert_float_equal(mesh_area(&mesh, NULL), 6, 0);
        } else {
            load_square(texts[i], &mesh);
        }
    }
}

CASE(test_data) {
    static const char *const colors[] = {
        "SCALARS rgb unsigned_char 4\nLOOKUP_TABLE default\n255 0 0 255 255 0 0 51 255 0 0 255 255 0 0 255\n",
        "COLOR_SCALARS rgba 4\n1 0 0 1 1 0 0 0.2 1 0 0 1 1 0 0 1\n",
        "FIELD FieldData 1\nrgb 4 4 unsigned_char\n255 0 0 255 255 0 0 51 255 0 0 255 255 0 0 255\n",
    };
    for (size_t i = 0; i < sizeof colors / sizeof colors[0]; i++) {
        char text[1024];
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        snprintf(text, sizeof text, SQUARE "POINT_DATA 4\nNORMALS n double\n0 0 1 0 0.1 1 0 0 1 0 0 1\n%s",
                 colors[i]);
        load_square(text, &mesh);
        assert_non_null(mesh.colors);
        assert_non_null(mesh.normals);
        const uint32_t second = mesh_corner(&mesh, 0, 2, 0, 0);
        assert_true(mesh.colors[4 * second] == 1 && mesh.colors[4 * second + 1] == 0);
        assert_float_equal(mesh.colors[4 * second + 3], 0.2, 1e-6);
        assert_float_equal(mesh.normals[3 * second + 1] / mesh.normals[3 * second + 2], 0.1, 1e-6);
    }
}

static void hold_numbers(const ewa_cloud *of, const char *name, ewa_type type, uint32_t components, uint64_t point, const double *wanted) {
    const ewa_attribute *found = ewa_cloud_find(of, name);
    double numbers[4];
    if (!found || found->type != type || found->component_count != components) fail_msg("%s", name);
    ewa_attribute_read_f64(found, point, 1, numbers);
    for (uint32_t c = 0; c < components; c++) assert_float_equal(numbers[c], wanted[c], 1e-5);
}

#define ARRAYS                                                                                                             \
    "POINT_DATA 4\nSCALARS Elevation float 1\nLOOKUP_TABLE default\n0 1 2 7\nVECTORS Flow double\n1 0 0 0 1 0 0 0 1 1 1 1\n"     \
    "TENSORS t float\n1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1\n"                            \
    "FIELD f 4\nids 1 4 int\n7 7 -9 8\nradius 1 4 float\n1 2 3 4\nElevation 2 4 float\n1 2 3 4 5 6 7 8\nshort 1 3 int\n1 2 3\n"

/// Numbers of points by name become attributes of vertices, of points where there are no faces, and of what is sampled;
/// names that mean something here do not mean it there.
CASE(test_numbers) {
    ewa_mesh mesh;
    mesh_load_text(context, &messages, "a.vtk", SQUARE ARRAYS, &mesh);
    assert_int_equal(ewa_cloud_attribute_count(mesh.attributes), 4);
    const uint32_t third = mesh_corner(&mesh, 0, 2, 3, 0);
    hold_numbers(mesh.attributes, "Elevation", EWA_F32, 1, third, (const double[]){2});
    hold_numbers(mesh.attributes, "Flow", EWA_F64, 3, third, (const double[]){0, 0, 1});
    hold_numbers(mesh.attributes, "ids", EWA_I32, 1, third, (const double[]){-9});
    hold_numbers(mesh.attributes, "scalar_radius", EWA_F32, 1, third, (const double[]){3});
    WITH_DEFAULTS(ewa_mesh_sample_options, options);
    options.point_count = 2000;
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_mesh_sample(&mesh, &options, &cloud), EWA_OK);
    // Floats are between those of the corners, whole numbers those of the nearest.
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    double origin[3];
    ewa_cloud_origin(cloud, origin);
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        double p[3], id;
        ewa_attribute_read_f64(position, i, 1, p);
        const double u = (p[0] + origin[0]) / 2, v = (p[1] + origin[1]) / 3;
        const double flow[3] = {u > v ? 1 - u : 1 - v + (v - u), u > v ? u - v : v - u, u > v ? v : u + (v - u)};
        hold_numbers(cloud, "Elevation", EWA_F32, 1, i, (const double[]){u > v ? u + v : 7 * (v - u) + 2 * u});
        hold_numbers(cloud, "Flow", EWA_F64, 3, i, flow);
        ewa_attribute_read_f64(ewa_cloud_find(cloud, "ids"), i, 1, &id);
        // What the first, the third and the fourth corner weigh, and which is told apart from the others.
        const double first = u > v ? fmax(1 - u, u - v) : 1 - v, third_weight = u > v ? v : u, fourth = u > v ? 0 : v - u;
        const double weights[3] = {first, third_weight, fourth}, ids[3] = {7, -9, 8};
        for (int k = 0; k < 3; k++)
            if (weights[k] > fmax(weights[(k + 1) % 3], weights[(k + 2) % 3]) + 1e-5) assert_true(id == ids[k]);
    }
    ewa_cloud_destroy(&cloud);
    mesh.vertex_count--;
    assert_int_equal(ewa_mesh_sample(&mesh, &options, &cloud), EWA_ERROR_ARGUMENT);
    mesh.vertex_count++;
    ewa_mesh_free(&mesh);
    OWNED(ewa_model_free) ewa_model model;
    assert_int_equal(ewa_model_load_memory(context, TEXT POINTS ARRAYS, sizeof(TEXT POINTS ARRAYS) - 1, "a.vtk", NULL, 0, NULL, &model), EWA_OK);
    hold_numbers(model.points, "Elevation", EWA_F32, 1, 3, (const double[]){7});
}

/// Checks that every corner of the triangle over (x, y) has a number of its cell.
static void hold_cell(const ewa_mesh *mesh, double x, double y, const char *name, ewa_type type, double wanted) {
    int found = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = mesh->triangles + 3 * (size_t)t;
        bool inside = true;
        for (int c = 0; c < 3; c++) {
            const double *a = mesh->positions + 3 * (size_t)v[c], *b = mesh->positions + 3 * (size_t)v[(c + 1) % 3];
            inside = inside && (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) > 0;
        }
        for (int c = 0; c < 3 && inside; c++) hold_numbers(mesh->attributes, name, type, 1, v[c], (const double[]){wanted});
        found += inside;
    }
    assert_int_equal(found, 1);
}

/// Numbers of cells are those of all corners of their faces; of polygonal data they go by vertices, lines, polygons, strips, in
/// whatever order these come. Points have arrays of the same names for themselves.
CASE(test_cell_numbers) {
    static const char *const cells[] = {
        TEXT "POINTS 6 float\n0 0 0 2 0 0 2 3 0 0 3 0 4 0 0 4 3 0\n"
             "TRIANGLE_STRIPS 1 5\n4 1 4 2 5\nVERTICES 1 2 1 0\nLINES 1 3 2 0 1\nPOLYGONS 2 8\n3 0 1 2 3 0 2 3\n"
             "CELL_DATA 5\nSCALARS id int\nLOOKUP_TABLE default\n1 2 30 40 50\n"
             "METADATA\nINFORMATION 0\n\nFIELD f 2\nt 1 5 float\n0 0 3.5 4.5 5.5\nMETADATA\nINFORMATION 0\n\nradius 1 5 short\n0 0 3 4 5\n"
             "POINT_DATA 6\nSCALARS t double\n9 9 9 9 9 9\n",
        HEAD "ASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 float\n0 0 0 2 0 0 2 3 0 0 3 0 4 0 0 4 3 0\n"
             "CELLS 3 13\n3 0 1 2\n3 0 2 3\n4 1 4 2 5\nCELL_TYPES 3\n5 5 6\n"
             "POINT_DATA 6\nSCALARS t double\n9 9 9 9 9 9\n"
             "CELL_DATA 3\nSCALARS id int\nLOOKUP_TABLE default\n30 40 50\nFIELD f 2\nt 1 3 float\n3.5 4.5 5.5\nradius 1 3 short\n3 4 5\n",
    };
    for (int i = 0; i < 2; i++) {
        ewa_mesh mesh;
        mesh_load_bytes(context, &messages, "a.vtk", cells[i], strlen(cells[i]), i == 0, &mesh);
        const char *of_cells = i ? "cell_t" : "t", *of_points = i ? "t" : "point_t";
        hold_cell(&mesh, 1.5, 0.1, "id", EWA_I32, 30);
        hold_cell(&mesh, 0.1, 1, "id", EWA_I32, 40);
        hold_cell(&mesh, 2.1, 0.1, "id", EWA_I32, 50);
        hold_cell(&mesh, 0.1, 1, of_cells, EWA_F32, 4.5);
        hold_cell(&mesh, 3.9, 2.9, of_cells, EWA_F32, 5.5);
        hold_cell(&mesh, 0.1, 1, "scalar_radius", EWA_I16, 4);
        hold_cell(&mesh, 0.1, 1, of_points, EWA_F64, 9);
        ewa_mesh_free(&mesh);
        OWNED(ewa_model_free) ewa_model model;
        assert_int_equal(ewa_model_load_memory(context, cells[i], strlen(cells[i]), "a.vtk", NULL, EWA_MODEL_POINTS, NULL, &model), EWA_OK);
        assert_null(ewa_cloud_find(model.points, "id"));
    }
    // Of a grid the cells at its sides.
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    mesh_load_text(context, &messages, "a.vtk",
                   HEAD "ASCII\nDATASET RECTILINEAR_GRID\nDIMENSIONS 3 2 3\nX_COORDINATES 3 float\n0 1 2\nY_COORDINATES 2 float\n0 1\n"
                        "Z_COORDINATES 3 float\n0 1 2\nCELL_DATA 4\nSCALARS id int\nLOOKUP_TABLE default\n1 2 3 4\n", &mesh);
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        double middle[3] = {0};
        for (int c = 0; c < 9; c++) middle[c % 3] += mesh.positions[3 * (size_t)mesh.triangles[3 * t + (uint32_t)c / 3] + (size_t)c % 3] / 3;
        const double wanted = 1 + (middle[0] > 1) + 2 * (middle[2] > 1);
        for (int c = 0; c < 3; c++) hold_numbers(mesh.attributes, "id", EWA_I32, 1, mesh.triangles[3 * t + (uint32_t)c], &wanted);
    }
}

/// Colours of cells are those of their faces, where points have none.
CASE(test_cell_colors) {
    static const char *const colors[] = {
        "CELL_DATA 2\nSCALARS rgb unsigned_char 3\nLOOKUP_TABLE default\n255 0 0 0 0 255\n",
        "CELL_DATA 2\nCOLOR_SCALARS rgba 4\n1 0 0 1 0 0 1 1\n",
        "POINT_DATA 4\nCOLOR_SCALARS p 3\n0 1 0 0 1 0 0 1 0 0 1 0\nCELL_DATA 2\nCOLOR_SCALARS rgb 3\n1 0 0 0 0 1\n",
        "CELL_DATA 2\nCOLOR_SCALARS rgb 3\n1 0 0 0 0 1\nPOINT_DATA 4\nCOLOR_SCALARS p 3\n0 1 0 0 1 0 0 1 0 0 1 0\n",
    };
    for (int i = 0; i < 4; i++) {
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        char text[1024];
        snprintf(text, sizeof text, TEXT POINTS "POLYGONS 2 8\n3 0 1 2 3 0 2 3\n%s", colors[i]);
        mesh_load_text(context, &messages, "a.vtk", text, &mesh);
        for (uint32_t t = 0; t < 2; t++)
            for (int c = 0; c < 3; c++) {
                const float *color = mesh.colors + 4 * (size_t)mesh.triangles[3 * t + (uint32_t)c];
                const int wanted = i >= 2 ? 1 : t ? 2 : 0;
                for (int k = 0; k < 4; k++) assert_true(color[k] == (k == 3 || k == wanted));
            }
    }
}

static void put(uint8_t *bytes, size_t *size, const char *text) {
    memcpy(bytes + *size, text, strlen(text));
    *size += strlen(text);
}

/// Numbers with the highest byte first.
static void put_numbers(uint8_t *bytes, size_t *size, int type_bytes, int count, const double *numbers) {
    for (int i = 0; i < count; i++) {
        uint64_t bits = (uint64_t)(int64_t)numbers[i];
        const float number = (float)numbers[i];
        uint32_t half;
        memcpy(&half, &number, 4);
        if (type_bytes == -4) bits = half;
        for (int k = abs(type_bytes) - 1; k >= 0; k--) bytes[(*size)++] = (uint8_t)(bits >> 8 * k);
    }
    put(bytes, size, "\n");
}

/// The square in bytes, as old versions or as version 5 write it.
static size_t make_bytes(bool new, uint8_t bytes[1024]) {
    static const double places[12] = {0, 0, 0, 2, 0, 0, 2, 3, 0, 0, 3, 0}, faces[5] = {4, 0, 1, 2, 3},
                        offsets[2] = {0, 4}, colors[12] = {255, 0, 0, 255, 0, 0, 255, 0, 0, 255, 0, 0},
                        scalars[4] = {10, 32, 35, 10};
    size_t size = 0;
    put(bytes, &size, HEAD "BINARY\nDATASET POLYDATA\nPOINTS 4 float\n");
    put_numbers(bytes, &size, -4, 12, places);
    put(bytes, &size, new ? "POLYGONS 2 4\nOFFSETS vtktypeint64\n" : "POLYGONS 1 5\n");
    put_numbers(bytes, &size, new ? 8 : 4, new ? 2 : 5, new ? offsets : faces);
    if (new) put(bytes, &size, "CONNECTIVITY vtktypeint64\n");
    if (new) put_numbers(bytes, &size, 8, 4, faces + 1);
    // Numbers that look like ends of lines and remarks.
    put(bytes, &size, "POINT_DATA 4\nSCALARS s short 1\nLOOKUP_TABLE default\n");
    put_numbers(bytes, &size, 2, 4, scalars);
    put(bytes, &size, "COLOR_SCALARS c 3\n");
    put_numbers(bytes, &size, 1, 12, colors);
    return size;
}

CASE(test_bytes) {
    for (int new = 0; new < 2; new++) {
        uint8_t bytes[1024];
        const size_t size = make_bytes(new, bytes);
        ewa_mesh mesh;
        mesh_load_bytes(context, &messages, "a.bin", bytes, size, false, &mesh);
        assert_float_equal(mesh_area(&mesh, NULL), 6, 0);
        assert_true(mesh.colors[0] == 1 && mesh.colors[1] == 0 && mesh.colors[3] == 1);
        ewa_mesh_free(&mesh);
        // Cut anywhere: refused, or as much as there is.
        for (size_t cut = 0; cut < size; cut++) {
            OWNED(check_free) uint8_t *part = malloc(cut + 1);
            assert_non_null(part);
            memcpy(part, bytes, cut);
            OWNED(ewa_model_free) ewa_model model;
            const ewa_status status =
                ewa_model_load_memory(context, part, cut, "a.vtk", NULL, EWA_MODEL_MESH, NULL, &model);
            if (status == EWA_OK && model.mesh.triangle_count)
                assert_float_equal(mesh_area(&model.mesh, NULL), 6, 0);
        }
    }
}

CASE(test_refused) {
    static const struct {
        const char *text, *said;
    } broken[] = {
        {TEXT, "there are neither faces nor points"},
        {TEXT "PIINTS 4 float\n", "there are no POINTS"},
        {TEXT "POINTS 4\n0 0 0", "POINTS has no number and type"},
        {TEXT "POINTS 4 float\n0 0 0 1", "the file ends early"},
        {TEXT "POINTS 2 float\n0 0 0 1 x 0", "a number is wanted"},
        {TEXT POINTS "POLYGONS 1 5\n5 0 1 2 3\n", "a cell is larger than all of them"},
        {TEXT POINTS "POLYGONS 2 8\n2.5 0 1 400000000\n3 0 1 2\n", "a number of corners is not whole"},
        {TEXT POINTS "POLYGONS 2 5\n4 0 1 2 3\n", "there are fewer cells than their number"},
        {TEXT POINTS "POLYGONS 1 6\n4 0 1 2 3 0\n", "there are more cells than their number"},
        {TEXT POINTS "POLYGONS 1 5\n4 0 1 2 9\n", "none of the faces can be used"},
        {TEXT POINTS "POLYGONS 3 4\nOFFSETS vtktypeint64\n0 3 2\nCONNECTIVITY int\n0 1 2 3\n",
         "OFFSETS do not ascend"},
        {TEXT POINTS "POLYGONS 2 4\nOFFSETS int\n0 5\nCONNECTIVITY int\n0 1 2 3\n", "OFFSETS do not ascend"},
        {TEXT POINTS "POLYGONS 2 4\nOFFSETS int\n0 3\nCONNECTIVITY int\n0 1 2 3\n", "more than OFFSETS say"},
        {SQUARE "POINT_DATA 3\nNORMALS n float\n0 0 1 0 0 1 0 0 1\n", "not as many normals as points"},
        {SQUARE "POINT_DATA 3\nCOLOR_SCALARS c 3\n0 0 1 0 0 1 0 0 1\n", "not as many colours as points"},
        {SQUARE "POINT_DATA 9999999999999999999\n", "data have no number"},
        {HEAD "BINARY\nDATASET POLYDATA\nPOINTS 400000000000 float\n", "the file ends early"},
        {HEAD "BINARY\nDATASET POLYDATA\nPOINTS 9000000000000000000 float\n", "POINTS has no number"},
        {HEAD "HEX\nDATASET POLYDATA\n", "ASCII or BINARY is wanted"},
    };
    for (size_t i = 0; i < sizeof broken / sizeof broken[0]; i++)
        mesh_refuse(context, &messages, "a.vtk", broken[i].text, strlen(broken[i].text), EWA_ERROR_FORMAT,
                    broken[i].said);
}

/// Cells that are not known are left out, words that are not known end the file; points alone are points. Grids of voxels
/// are none.
CASE(test_left_out) {
    ewa_mesh mesh;
    static const char mixed[] = HEAD "ASCII\nDATASET UNSTRUCTURED_GRID\n" POINTS
                                     "CELLS 2 10\n4 0 1 2 3\n4 0 1 2 3\nCELL_TYPES 2\n99 9\n",
                      odd[] = SQUARE "POINT_DATA 4\nSCALARS b bit\nLOOKUP_TABLE default\n0 1 1 0\n";
    mesh_load_bytes(context, &messages, "a.vtk", mixed, sizeof mixed - 1, true, &mesh);
    mesh_says(&messages, "1 cells of a kind that is not known are left out");
    ewa_mesh_free(&mesh);
    mesh_load_bytes(context, &messages, "a.vtk", odd, sizeof odd - 1, true, &mesh);
    mesh_says(&messages, "what 'SCALARS' begins is left out");
    ewa_mesh_free(&mesh);
    ewa_model model;
    const char *points = TEXT POINTS;
    assert_int_equal(
        ewa_model_load_memory(context, points, strlen(points), "a.vtk", NULL, EWA_MODEL_MESH, NULL, &model), EWA_OK);
    assert_int_equal(ewa_cloud_point_count(model.points), 4);
    assert_null(ewa_cloud_find(model.points, EWA_NORMAL));
    ewa_model_free(&model);
    points = TEXT POINTS "VERTICES 1 2 1 0\nPOINT_DATA 4\nNORMALS n float\n0 0 1 0 1 0 1 0 0 0 0.6 0.8\n";
    assert_int_equal(
        ewa_model_load_memory(context, points, strlen(points), "a.vtk", NULL, EWA_MODEL_MESH, NULL, &model), EWA_OK);
    const ewa_attribute *normal = ewa_cloud_find(model.points, EWA_NORMAL);
    assert_true(normal && normal->type == EWA_F32 && normal->component_count == 3);
    static const float expected[12] = {0, 0, 1, 0, 1, 0, 1, 0, 0, 0, 0.6f, 0.8f};
    assert_memory_equal(normal->data, expected, sizeof expected);
    ewa_model_free(&model);
    char path[512];
    scratch_write(scratch_path("a.vtk", path), SQUARE, strlen(SQUARE));
    assert_true(ewa_volume_is_named(path) && !ewa_volume_is_file(context, path));
    const char *voxels = HEAD "ASCII\nDATASET STRUCTURED_POINTS\n";
    scratch_write(path, voxels, strlen(voxels));
    assert_true(ewa_volume_is_file(context, path));
    assert_true(ewa_volume_is_file(context, "/nowhere/a.vtk") && !ewa_volume_is_file(context, "a.ply"));
    assert_string_equal(ewa_model_format_name(EWA_MODEL_VTK), "VTK");
}

static ewa_status load_failing(ewa_context *failing, void *user) {
    uint8_t bytes[1024];
    const size_t size = make_bytes(true, bytes);
    OWNED(ewa_model_free) ewa_model model;
    const ewa_status status =
        ewa_model_load_memory(failing, bytes, size, "a.vtk", NULL, EWA_MODEL_MESH, NULL, &model);
    return status;
}

TEST(test_failing_allocations) { scratch_fail_each(load_failing, NULL); }

int main(void) { return RUN_TESTS(NULL, NULL); }
