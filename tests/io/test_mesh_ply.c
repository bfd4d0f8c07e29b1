// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Meshes in PLY files: faces of any kind, strips, where texture coordinates and colours are, and what convert
// keeps.
#include "io/mesh_fixture.h"

#define XYZ             "property float x\nproperty float y\nproperty float z\n"

#define SQUARE_VERTICES "0 0 0\n2 0 0\n2 3 0\n0 3 0\n"

CASE(test_polygons) {
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    double sum[3];
    mesh_load_text(context, &messages, "a.ply",
                   "ply\nformat ascii 1.0\nelement vertex 4\n" XYZ
                   "element face 1\nproperty list uchar int vertex_indices\nend_header\n" SQUARE_VERTICES
                   "4 0 1 2 3\n",
                   &mesh);
    assert_int_equal(mesh.triangle_count, 2);
    assert_int_equal(mesh.vertex_count, 4);
    assert_true(!mesh.colors && !mesh.texcoords && !mesh.normals && !mesh.material_count);
    assert_float_equal(mesh_area(&mesh, sum), 6, 0);
    assert_float_equal(sum[2], 6, 0);
    ewa_mesh_free(&mesh);
    // The other spelling, other types, other properties before and after, blank and broken lines.
    mesh_load_text(context, &messages, "a.ply",
                   "ply\nformat ascii 1.0\ncomment x\nelement vertex 4\n" XYZ
                   "element face 2\nproperty uchar flag\nproperty list ushort uint vertex_index\n"
                   "property list int double other\nproperty float quality\nend_header\n" SQUARE_VERTICES
                   "7 3 0 1 2 0 0.5\n7 3 0 2 3 2 1.5 2.5 1\n",
                   &mesh);
    assert_float_equal(mesh_area(&mesh, NULL), 6, 0);
}

/// Faces first, an element of unknown kind between, and numbers of the other byte order.
CASE(test_order_of_elements) {
    static const char head[] =
        "ply\nformat %s 1.0\nelement face 2\nproperty list uchar short vertex_indices\n"
        "element odd 2\nproperty list uchar uchar things\nproperty short n\n"
        "element vertex 4\nproperty short x\nproperty short y\nproperty short z\nend_header\n";
    static const int faces[2][3] = {{0, 1, 2}, {0, 2, 3}},
                     places[4][3] = {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}};
    for (int big = 0; big < 2; big++) {
        uint8_t bytes[1024];
        size_t at = (size_t)snprintf((char *)bytes, sizeof bytes, head,
                                     big ? "binary_big_endian" : "binary_little_endian");
#define PUT16(value)                                                                                         \
    (bytes[at + (size_t)!big] = (uint8_t)((value) >> 8), bytes[at + (size_t)big] = (uint8_t)(value), at += 2)
        for (int f = 0; f < 2; f++) {
            bytes[at++] = 3;
            for (int c = 0; c < 3; c++) PUT16(faces[f][c]);
        }
        for (int i = 0; i < 2; i++) {
            bytes[at++] = 2;
            bytes[at++] = 9;
            bytes[at++] = 8;
            PUT16(77);
        }
        for (int v = 0; v < 4; v++)
            for (int c = 0; c < 3; c++) PUT16(places[v][c]);
        ewa_mesh mesh;
        mesh_load_bytes(context, &messages, "a.ply", bytes, at, false, &mesh);
        assert_float_equal(mesh_area(&mesh, NULL), 6, 0);
        ewa_mesh_free(&mesh);
    }
}

/// Header lines that end in a lone carriage return; a line feed that belongs to the data.
CASE(test_line_ends) {
    static const char *const ends[] = {"\n", "\r\n", "\r"};
    for (int e = 0; e < 3; e++) {
        char text[2048] = "";
        static const char *const lines[] = {"ply",
                                            "format ascii 1.0",
                                            "element vertex 3",
                                            "property float x",
                                            "property float y",
                                            "property float z",
                                            "element face 1",
                                            "property list uchar int vertex_indices",
                                            "end_header",
                                            "0 0 0",
                                            "1 0 0",
                                            "0 1 0",
                                            "3 0 1 2"};
        for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
            strcat(text, lines[i]);
            strcat(text, ends[e]);
        }
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        mesh_load_text(context, &messages, "a.ply", text, &mesh);
        assert_float_equal(mesh_area(&mesh, NULL), 0.5, 0);
    }
}

/// A strip turns every other triangle; -1 begins anew; a vertex twice in a row turns it.
CASE(test_strips) {
    static const char head[] = "ply\nformat ascii 1.0\nelement vertex 8\n" XYZ
                               "element tristrips %d\nproperty list int int vertex_indices\nend_header\n"
                               "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n0 3 0\n1 3 0\n%s";
    static const struct {
        int strips;
        const char *lists;
        uint32_t triangles;
        double area, up; ///< of the strips: 8 vertices are 6 triangles of area 1/2
    } cases[] = {
        {1, "8 0 1 2 3 4 5 6 7\n", 6, 3, 3},        {1, "9 0 1 2 3 -1 4 5 6 7\n", 4, 2, 2},
        {1, "10 0 1 2 3 -1 -1 4 5 6 7\n", 4, 2, 2}, {2, "4 0 1 2 3\n4 4 5 6 7\n", 4, 2, 2},
        {1, "10 0 1 2 3 3 4 4 5 6 7\n", 4, 2, 2},   {1, "5 0 1 -1 2 3\n", 0, 0, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[1024];
        snprintf(text, sizeof text, head, cases[i].strips, cases[i].lists);
        if (!cases[i].triangles) {
            mesh_refuse(context, &messages, "a.ply", text, strlen(text), EWA_ERROR_FORMAT,
                        "there are no faces");
            continue;
        }
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        double sum[3];
        mesh_load_text(context, &messages, "a.ply", text, &mesh);
        assert_int_equal(mesh.triangle_count, cases[i].triangles);
        assert_float_equal(mesh_area(&mesh, sum), cases[i].area, 1e-12);
        assert_float_equal(sum[2], cases[i].up, 1e-12);
    }
}

CASE(test_colors_and_normals) {
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    // 8 bits are sRGB, alpha is linear.
    mesh_load_text(context, &messages, "a.ply",
                   "ply\nformat ascii 1.0\nelement vertex 3\n" XYZ
                   "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n"
                   "property float nx\nproperty float ny\nproperty float nz\n"
                   "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                   "0 0 0 255 188 0 51 0 0 1\n1 0 0 255 188 0 51 0 0 2\n0 1 0 255 188 0 51 0 1 1\n3 0 1 2\n",
                   &mesh);
    assert_float_equal(mesh.colors[1], ewa_linear_from_srgb(188 / 255.0f), 1e-6);
    assert_true(mesh.colors[0] == 1 && mesh.colors[2] == 0);
    assert_float_equal(mesh.colors[3], 0.2, 1e-6);
    const uint32_t third = mesh_corner(&mesh, 0, 0, 1, 0);
    assert_true(mesh.normals[3 * third + 1] == 1 && mesh.normals[3 * third + 2] == 1);
    ewa_mesh_free(&mesh);
    // Floats are linear, as in clouds; colours of faces part the vertices they share.
    mesh_load_text(context, &messages, "a.ply",
                   "ply\nformat ascii 1.0\nelement vertex 4\n" XYZ
                   "element face 2\nproperty list uchar int vertex_indices\nproperty float red\n"
                   "property float green\nproperty float blue\nend_header\n" SQUARE_VERTICES
                   "3 0 1 2 0.25 0 0\n3 0 2 3 0 0.5 0\n",
                   &mesh);
    assert_int_equal(mesh.vertex_count, 6);
    for (uint32_t k = 0; k < 3; k++) {
        assert_float_equal(mesh.colors[4 * mesh.triangles[k]], 0.25, 0);
        assert_float_equal(mesh.colors[4 * mesh.triangles[3 + k] + 1], 0.5, 0);
        assert_float_equal(mesh.colors[4 * mesh.triangles[k] + 3], 1, 0);
    }
    ewa_mesh_free(&mesh);
    // Vertex colours win.
    mesh_load_text(
        context, &messages, "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\n" XYZ
        "property float red\nproperty float green\nproperty float blue\n"
        "element face 1\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\n"
        "property uchar blue\nend_header\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2 255 0 0\n",
        &mesh);
    assert_true(mesh.colors[0] == 0 && mesh.colors[2] == 1 && mesh.vertex_count == 3);
}

/// Texture coordinates by vertex, under each of their names.
CASE(test_texcoords_of_vertices) {
    static const char *const names[][2] = {
        {"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        char text[1024];
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        snprintf(text, sizeof text,
                 "ply\nformat ascii 1.0\nelement vertex 3\n" XYZ "property float %s\nproperty float %s\n"
                 "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                 "0 0 0 0 0\n1 0 0 1 0.25\n0 1 0 0 2\n3 0 1 2\n",
                 names[i][0], names[i][1]);
        mesh_load_text(context, &messages, "a.ply", text, &mesh);
        const uint32_t second = mesh_corner(&mesh, 0, 1, 0, 0);
        assert_true(mesh.texcoords[2 * second] == 1 && mesh.texcoords[2 * second + 1] == 0.25f);
    }
}

/// As MeshLab writes them: by corner, a number of a picture per face, pictures in comments.
CASE(test_texcoords_of_faces) {
    char path[512];
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    static const char text[] =
        "ply\nformat ascii 1.0\ncomment TextureFile <this>_a.png\ncomment TextureFile second picture.png\n"
        "element vertex 4\n" XYZ "element face 3\nproperty list uchar int vertex_indices\n"
        "property list uchar float texcoord\nproperty int texnumber\nend_header\n" SQUARE_VERTICES
        "3 0 1 2 6 0 0 1 0 1 1 0\n3 0 2 3 6 0.5 0 0 1 1 1 1\n3 1 2 3 0 -1\n";
    mesh_picture(context, "faces_a.png", 255, 0, 0);
    mesh_picture(context, "second picture.png", 0, 255, 0);
    scratch_write(scratch_path("faces.ply", path), text, strlen(text));
    assert_int_equal(ewa_mesh_load(context, path, &mesh), EWA_OK);
    assert_string_equal(messages.text, "");
    assert_true(mesh_texture(&mesh, 0)->pixels[0] == 1 && mesh_texture(&mesh, 1)->pixels[1] == 1);
    assert_null(mesh_texture(&mesh, 2));
    // Place 0 has other coordinates in each of the two.
    const uint32_t first = mesh_corner(&mesh, 0, 0, 0, 0), second = mesh_corner(&mesh, 1, 0, 0, 0);
    assert_true(first != second && mesh.texcoords[2 * first] == 0 && mesh.texcoords[2 * second] == 0.5f);
    ewa_mesh_free(&mesh);
    // Without its pictures, the mesh comes with warnings that name them.
    scratch_write(scratch_path("alone.ply", path), text, strlen(text));
    char picture[512];
    unlink(scratch_path("second picture.png", picture));
    assert_int_equal(ewa_mesh_load(context, path, &mesh), EWA_OK);
    mesh_says(&messages, "the picture 'alone_a.png' is left out: it is not there");
    mesh_says(&messages, "the picture 'second picture.png' is left out");
    assert_int_equal(messages.errors, 0);
}

/// As Artec writes them: in elements of their own, behind the faces.
CASE(test_multi_texture) {
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    mesh_load_text(context, &messages, "a.ply",
                   "ply\nformat ascii 1.0\nelement vertex 4\n" XYZ
                   "element face 2\nproperty list uchar int vertex_indices\n"
                   "element multi_texture_vertex 4\nproperty uchar tx\nproperty float u\nproperty float v\n"
                   "element multi_texture_face 2\nproperty uchar tx\nproperty uint tn\n"
                   "property list uchar int texture_vertex_indices\nend_header\n" SQUARE_VERTICES
                   "3 0 1 2\n3 0 2 3\n0 0.125 0\n0 1 0\n0 1 1\n0 0 1\n0 1 3 0 2 3\n0 0 3 0 1 2\n",
                   &mesh);
    const uint32_t corner = mesh_corner(&mesh, 1, 0, 3, 0), origin = mesh_corner(&mesh, 0, 0, 0, 0);
    assert_true(mesh.texcoords[2 * corner] == 0 && mesh.texcoords[2 * corner + 1] == 1);
    assert_true(mesh.texcoords[2 * origin] == 0.125f);
}

/// Faces that cannot be used are counted and said; the rest is a mesh.
CASE(test_bad_faces) {
    static const char head[] =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
        "property double z\nelement face %d\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0\n2 0 0\n2 3 0\nnan 3 0\n%s";
    char text[1024];
    ewa_mesh mesh;
    snprintf(text, sizeof text, head, 6, "3 0 1 2\n3 0 1 4\n3 0 1 -1\n2 0 1\n0\n3 0 1 3\n");
    mesh_load_bytes(context, &messages, "a.ply", text, strlen(text), true, &mesh);
    assert_int_equal(mesh.triangle_count, 2);
    mesh_says(&messages,
              "a.ply: left out of 6 faces: 2 faces with a vertex that is not there, 2 faces of fewer than "
              "three corners, 1 triangles with a coordinate that is not finite");
    ewa_mesh_free(&mesh);
    snprintf(text, sizeof text, head, 1, "3 0 1 4000000000\n");
    mesh_refuse(context, &messages, "a.ply", text, strlen(text), EWA_ERROR_FORMAT,
                "does not fit the type of its property");
    snprintf(text, sizeof text, head, 1, "3 0 1 4000000\n");
    mesh_refuse(context, &messages, "a.ply", text, strlen(text), EWA_ERROR_FORMAT,
                "none of the faces can be used");
    snprintf(text, sizeof text, head, 1, "3 0 1 3\n");
    mesh_refuse(context, &messages, "a.ply", text, strlen(text), EWA_ERROR_FORMAT,
                "none of the faces has finite coordinates");
    snprintf(text, sizeof text, head, 2, "3 0 1 2\n");
    mesh_refuse(context, &messages, "a.ply", text, strlen(text), EWA_ERROR_FORMAT,
                "the file ends in 'face' 1 of 2");
}

/// Colours that are not finite, or not as floats, are counted and white; others stay.
CASE(test_odd_colors) {
    static const char text[] = "ply\nformat ascii 1.0\nelement vertex 4\n" XYZ
                               "property double red\nproperty double green\nproperty double blue\n"
                               "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
                               "0 0 0 1e300 0.5 0.5\n1 0 0 0.25 nan 0.5\n1 1 0 0.25 0.5 4\n0 1 0 -inf 0 0\n"
                               "3 0 1 2\n3 0 2 3\n";
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    mesh_load_bytes(context, &messages, "a.ply", text, strlen(text), true, &mesh);
    mesh_says(&messages, "a.ply: 3 colours are not finite and count as white");
    assert_int_equal(mesh.vertex_count, 4);
    for (uint32_t v = 0; v < 4; v++) {
        const float expected[2][4] = {{1, 1, 1, 1}, {0.25f, 0.5f, 4, 1}};
        assert_memory_equal(mesh.colors + 4 * v, expected[v == 2], 4 * sizeof(float));
    }
}

/// Without faces it is a cloud, whatever is declared; with them, a mesh whatever the name.
CASE(test_what_is_a_mesh) {
    static const struct {
        const char *elements;
        uint64_t faces;
    } cases[] = {{"element face 0\nproperty list uchar int vertex_indices\n", 0},
                 {"element face 1\nproperty list uchar int vertex_indices\n", 1},
                 {"element face 1\nproperty list uchar int something\n", 0},
                 {"element edge 1\nproperty list uchar int vertex_indices\n", 0},
                 {"element tristrips 1\nproperty list uchar int vertex_indices\n", 1}};
    static const char *const names[] = {"a.ply", "a.xyz", "a"};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        for (int n = 0; n < 3; n++) {
            char text[1024];
            OWNED(ewa_model_free) ewa_model model;
            snprintf(text, sizeof text,
                     "ply\nformat ascii 1.0\nelement vertex 3\n" XYZ "%send_header\n0 0 0\n1 0 0\n0 1 0\n%s",
                     cases[i].elements, strstr(cases[i].elements, " 0\n") ? "" : "3 0 1 2\n");
            assert_int_equal(ewa_model_load_memory(context, text, strlen(text), names[n], NULL,
                                                   EWA_MODEL_MESH, NULL, &model),
                             EWA_OK);
            assert_int_equal(model.format, EWA_MODEL_PLY);
            assert_int_equal(model.face_count, cases[i].faces);
            assert_int_equal(model.mesh.triangle_count, cases[i].faces);
            assert_true((model.points != NULL) == (cases[i].faces == 0));
        }
}

/// Coordinates keep every digit: floats as they are, doubles far from the origin too.
CASE(test_digits) {
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    mesh_load_text(
        context, &messages, "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "500000.000001 4200000.1 0\n500001.5 4200000.1 0\n500000 4200001.0000001 0\n3 0 1 2\n",
        &mesh);
    assert_true(mesh.positions[0] == 500000.000001 && mesh.positions[7] == 4200001.0000001);
    ewa_mesh_free(&mesh);
    // Floats cannot hold them, which is said.
    static const char coarse[] = "ply\nformat ascii 1.0\nelement vertex 3\n" XYZ
                                 "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                                 "500000 4200000 0\n500001 4200000 0\n500000 4200001 0\n3 0 1 2\n";
    mesh_load_bytes(context, &messages, "a.ply", coarse, strlen(coarse), true, &mesh);
    mesh_says(&messages, "coordinates up to 4200001 are floats, in steps of 0.5");
}

/// Everything that is no vertex is written again as it was read, in every encoding.
CASE(test_elements_round_trip) {
    static const char text[] =
        "ply\nformat ascii 1.0\ncomment first\nobj_info second\nelement camera 1\nproperty float focal\n"
        "property list ushort double k\nelement vertex 4\n" XYZ "property int flags\n"
        "element face 2\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty list uchar "
        "float texcoord\n"
        "element edge 1\nproperty char a\nproperty uint b\nend_header\n"
        "0.5 3 1.5 -2 1e300\n0 0 0 1\n2 0 0 2\n2 3 0 3\n0 3 0 4\n3 0 1 2 9 0\n4 0 1 2 3 8 2 0.25 0.5\n-5 "
        "4000000000\n";
    char last[4096] = "";
    for (int encoding = 0; encoding < 3; encoding++) {
        char path[512];
        ewa_model model;
        size_t size;
        scratch_path("elements.ply", path);
        assert_int_equal(ewa_model_load_memory(context, text, strlen(text), "a.ply", NULL,
                                               EWA_MODEL_POINTS | EWA_MODEL_ELEMENTS, NULL, &model),
                         EWA_OK);
        assert_int_equal(ewa_elements_face_count(model.elements), 2);
        WITH_DEFAULTS(ewa_cloud_save_options, options);
        options.ply_encoding = (ewa_ply_encoding)encoding;
        options.elements = model.elements;
        assert_int_equal(ewa_cloud_save(model.points, path, &options), EWA_OK);
        ewa_model_free(&model);
        // And back to text, which is that of the first.
        assert_int_equal(ewa_model_load(context, path, EWA_MODEL_POINTS | EWA_MODEL_ELEMENTS, NULL, &model),
                         EWA_OK);
        options.ply_encoding = EWA_PLY_ASCII;
        options.elements = model.elements;
        assert_int_equal(ewa_cloud_save(model.points, path, &options), EWA_OK);
        ewa_model_free(&model);
        OWNED(check_free) char *again = (char *)scratch_read(path, &size);
        again[size] = 0;
        if (encoding == 0) assert_string_equal(again, text);
        if (encoding) assert_string_equal(again, last);
        snprintf(last, sizeof last, "%s", again);
    }
    assert_string_equal(messages.text, "");
}

int main(void) { return RUN_TESTS(NULL, NULL); }
