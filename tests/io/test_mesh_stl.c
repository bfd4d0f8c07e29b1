// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// STL and OFF: text and bytes, several solids, colours of both kinds of STL, every head of OFF.
#include "io/mesh_fixture.h"

#define FACET(a, b, c)                                                                                       \
    "facet normal 0 0 1\nouter loop\nvertex " a "\nvertex " b "\nvertex " c "\nendloop\nendfacet\n"
#define TWO_FACETS FACET("0 0 0", "2 0 0", "2 3 0") FACET("0 0 0", "2 3 0", "0 3 0")

CASE(test_ascii_stl) {
    static const char *const texts[] = {
        "solid s\n" TWO_FACETS "endsolid s\n",
        "SOLID\n" TWO_FACETS "ENDSOLID",
        "solid facet vertex 1\n" FACET(
            "0 0 0", "2 0 0",
            "2 3 0") "endsolid facet\nsolid b\nendsolid\nsolid c\n" FACET("0 0 0", "2 3 0",
                                                                          "0 3 0") "endsolid c\n",
        "\n  solid x\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex 2 0 0 vertex 2 3 0 endloop endfacet\n"
        "Facet Normal nan nan nan\nOuter Loop\nVertex 0 0 0\nVERTEX 2 3.0e0 0\nvertex 0 3 "
        "0\nEndLoop\nEndFacet\nendsolid\n",
        "solid s\r\nfacet normal 0 0 1\r\nouter loop\r\nvertex 0 0 0\r\nvertex 2 0 0\r\nvertex 2 3 "
        "0\r\nvertex 0 3 0\r\nendloop\r\nendfacet\r\nendsolid\r\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        double sum[3];
        mesh_load_text(context, &messages, i % 2 ? "a.bin" : "a.stl", texts[i], &mesh);
        assert_float_equal(mesh_area(&mesh, sum), 6, 0);
        assert_float_equal(sum[2], 6, 0);
    }
    static const struct {
        const char *text, *said;
    } broken[] = {
        {"solid s\n" TWO_FACETS, "'endsolid' is wanted, not the end"},
        {"solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n",
         "'vertex' or 'endfacet' is wanted, not the end"},
        {"solid s\nfoo\n", "line 2: 'facet', 'solid' or 'endsolid' is wanted, not 'foo'"},
        {"solid s\nfacet normal 0 0 1\nouter loop\nedge 1 2\n",
         "line 4: 'vertex' or 'endfacet' is wanted, not 'edge'"},
        {"solid s\nendsolid s\n", "there are neither faces nor points"},
        {"solid s\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\nendloop\nendfacet\nendsolid\n",
         "none of the faces can be used"},
        {"solid s\n" FACET("0 0 x", "1 0 0", "0 1 0") "endsolid\n", "line 4: not a number"},
    };
    for (size_t i = 0; i < sizeof broken / sizeof broken[0]; i++)
        mesh_refuse(context, &messages, "a.stl", broken[i].text, strlen(broken[i].text), EWA_ERROR_FORMAT,
                    broken[i].said);
}

/// A binary STL of the square, with a head and a code for each of the two triangles.
static size_t make_binary(const char *head, uint32_t count, unsigned first, unsigned second,
                          uint8_t bytes[256]) {
    static const float corners[2][9] = {{0, 0, 0, 2, 0, 0, 2, 3, 0}, {0, 0, 0, 2, 3, 0, 0, 3, 0}};
    memset(bytes, ' ', 80);
    memcpy(bytes, head, strlen(head));
    memcpy(bytes + 80, &count, 4);
    for (int t = 0; t < 2; t++) {
        uint8_t *record = bytes + 84 + 50 * t;
        const unsigned code = t ? second : first;
        memset(record, 0, 12);
        memcpy(record + 12, corners[t], 36);
        record[48] = (uint8_t)code;
        record[49] = (uint8_t)(code >> 8);
    }
    return 184;
}

static void check_color(const ewa_mesh *mesh, uint32_t triangle, double red, double green, double blue) {
    const float *color = mesh->colors + 4 * (size_t)mesh->triangles[3 * triangle];
    const double wanted[3] = {red, green, blue};
    for (int c = 0; c < 3; c++) assert_float_equal(color[c], ewa_linear_from_srgb((float)wanted[c]), 1e-5);
    assert_true(color[3] == 1);
}

CASE(test_binary_stl) {
    uint8_t bytes[256];
    ewa_mesh mesh;
    // A head that begins as text does, or is empty; any name.
    static const char *const heads[] = {"solid like text", "", "something"};
    for (int i = 0; i < 3; i++) {
        const size_t size = make_binary(heads[i], 2, 0, 0, bytes);
        mesh_load_bytes(context, &messages, "a", bytes, size, false, &mesh);
        assert_float_equal(mesh_area(&mesh, NULL), 6, 0);
        assert_null(mesh.colors);
        ewa_mesh_free(&mesh);
        // Bytes behind the last triangle.
        memset(bytes + size, 0, 9);
        mesh_load_bytes(context, &messages, "a.stl", bytes, size + 9, false, &mesh);
        assert_float_equal(mesh_area(&mesh, NULL), 6, 0);
        ewa_mesh_free(&mesh);
    }
    make_binary("x", 2, 0, 0, bytes);
    mesh_refuse(context, &messages, "a.stl", bytes, 183, EWA_ERROR_FORMAT,
                "the file ends in triangle 1 of 2");
    mesh_refuse(context, &messages, "a.stl", bytes, 83, EWA_ERROR_FORMAT, "83 bytes");
    make_binary("x", 0xffffffffu, 0, 0, bytes);
    mesh_refuse(context, &messages, "a.stl", bytes, 184, EWA_ERROR_FORMAT, "triangle 2 of 4294967295");
    make_binary("x", 0, 0, 0, bytes);
    mesh_refuse(context, &messages, "a.stl", bytes, 84, EWA_ERROR_FORMAT, "neither faces nor points");
}

CASE(test_colors_of_stl) {
    uint8_t bytes[256];
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    // Magics: components from the low end, the high bit means the common colour.
    size_t size = make_binary("COLOR=\xff\x80\x40\xff, MATERIAL=", 2, 31u | 15u << 5, 0x8000u, bytes);
    mesh_load_bytes(context, &messages, "a.stl", bytes, size, false, &mesh);
    check_color(&mesh, 0, 1, 15 / 31.0, 0);
    check_color(&mesh, 1, 1, 128 / 255.0, 64 / 255.0);
    ewa_mesh_free(&mesh);
    // Codes that are all zero say nothing: many programs write so.
    size = make_binary("COLOR=\xff\x80\x40\xff, MATERIAL=", 2, 0, 0, bytes);
    mesh_load_bytes(context, &messages, "a.stl", bytes, size, false, &mesh);
    check_color(&mesh, 0, 1, 128 / 255.0, 64 / 255.0);
    ewa_mesh_free(&mesh);
    size = make_binary("COLOR=\xff\x80\x40\xff, MATERIAL=", 2, 0, 0x100u, bytes);
    mesh_load_bytes(context, &messages, "a.stl", bytes, size, false, &mesh);
    check_color(&mesh, 0, 0, 0, 0);
    ewa_mesh_free(&mesh);
    // VisCAM: from the high end, the high bit means a colour of its own.
    size = make_binary("x", 2, 0x8000u | 31u | 15u << 5, 31u << 10, bytes);
    mesh_load_bytes(context, &messages, "a.stl", bytes, size, false, &mesh);
    check_color(&mesh, 0, 0, 15 / 31.0, 1);
    check_color(&mesh, 1, 1, 1, 1);
}

CASE(test_off) {
#define BODY "4 1 0\n0 0 0\n2 0 0\n2 3 0\n0 3 0\n4 0 1 2 3\n"
    static const char *const texts[] = {
        "OFF\n" BODY,
        "OFF " BODY,
        "OFF4 1 0\n0 0 0\n2 0 0\n2 3 0\n0 3 0\n4 0 1 2 3\n", // as ModelNet has it
        "# remark\n\nOFF # more\n# counts\n4 1\n\n0 0 0 # a\n2 0 0\n2 3 0\n0 3 0\n\n4 0 1 2 3\n",
        "4OFF\n4 1 0\n0 0 0 1\n4 0 0 2\n4 6 0 2\n0 3 0 1\n4 0 1 2 3\n",
        "NOFF\n4 1 0\n0 0 0 0 0 1\n2 0 0 0 0 1\n2 3 0 0 0 1\n0 3 0 0 0 1\n4 0 1 2 3\n",
        "COFF\n4 1 0\n0 0 0 255 0 0 255\n2 0 0 255 0 0 255\n2 3 0 255 0 0 255\n0 3 0 255 0 0 255\n4 0 1 2 "
        "3\n",
        "STCNOFF\n4 1 0\n0 0 0 0 0 1 1 0 0 1 0 0\n2 0 0 0 0 1 1 0 0 1 1 0\n2 3 0 0 0 1 1 0 0 1 1 1\n0 3 0 0 "
        "0 1 1 0 0 1 0 1\n4 0 1 2 3\n",
        "OFF\r\n4 2 0\r\n0 0 0\r\n2 0 0\r\n2 3 0\r\n0 3 0\r\n3 0 1 2 0\r\n3 0 2 3 1\r\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        double sum[3];
        mesh_load_text(context, &messages, "a", texts[i], &mesh);
        assert_float_equal(mesh_area(&mesh, sum), 6, 0);
        assert_float_equal(sum[2], 6, 0);
        const bool colored = i == 6 || i == 7;
        assert_true((mesh.colors != NULL) == colored && (mesh.normals != NULL) == (i == 5 || i == 7) &&
                    (mesh.texcoords != NULL) == (i == 7));
        if (colored) check_color(&mesh, 0, 1, 0, 0);
        if (i == 7) assert_true(mesh.texcoords[2 * mesh_corner(&mesh, 0, 2, 3, 0) + 1] == 1);
    }
    ewa_mesh mesh;
    mesh_load_text(context, &messages, "a.off",
                   "OFF\n4 2 0\n0 0 0\n2 0 0\n2 3 0\n0 3 0\n3 0 1 2 0 255 0\n3 0 2 3 0.5 0 0 0.25\n", &mesh);
    check_color(&mesh, 0, 0, 1, 0);
    assert_float_equal(mesh.colors[4 * mesh.triangles[3] + 3], 0.25, 1e-6);
    ewa_mesh_free(&mesh);
    static const struct {
        const char *text, *said;
        ewa_status status;
    } broken[] = {
        {"OFF BINARY\n", "binary OFF is not read", EWA_ERROR_UNSUPPORTED},
        {"COFF BINARY\n\1\2\3", "binary OFF is not read", EWA_ERROR_UNSUPPORTED},
        {"nOFF\n3\n", "another dimension", EWA_ERROR_UNSUPPORTED},
        {"OFF\n", "numbers of vertices and faces are wanted", EWA_ERROR_FORMAT},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n", "the numbers of a vertex are wanted", EWA_ERROR_FORMAT},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n", "the number of a face's corners is wanted", EWA_ERROR_FORMAT},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "the number of a vertex is wanted", EWA_ERROR_FORMAT},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n99999999999 0 1\n", "the number of a face's corners",
         EWA_ERROR_FORMAT},
        {"OFF\n-3 1 0\n", "numbers of vertices and faces are wanted", EWA_ERROR_FORMAT},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", "none of the faces can be used", EWA_ERROR_FORMAT},
        {"OFF\n1e300 1 0\n0 0 0\n", "line 4: the numbers of a vertex are wanted", EWA_ERROR_FORMAT},
    };
    for (size_t i = 0; i < sizeof broken / sizeof broken[0]; i++)
        mesh_refuse(context, &messages, "a.off", broken[i].text, strlen(broken[i].text), broken[i].status,
                    broken[i].said);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
