// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// OBJ and its material libraries: every way to write faces, colours, numbers, names and text.
#include "io/mesh_fixture.h"

#define SQUARE "v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\n"

/// The same square in many spellings.
CASE(test_spellings) {
    static const char *const texts[] = {
        SQUARE "f 1 2 3 4\n",
        SQUARE "f 1 2 3 4",
        SQUARE "f -4 -3 -2 -1\n",
        SQUARE "f 1 2 3\nf 1 3 4\n",
        SQUARE "fo 1 2 3 4\n",
        SQUARE "f 1/ 2/ 3/ 4/\n",
        SQUARE "f 1// 2// 3// 4//\n",
        SQUARE "f 1/9/9 2/9/9 3/9/9 4/9/9\n", // there are no such texture coordinates and normals
        "f 1 2 3 4\n" SQUARE,                 // faces before what they name
        "\xef\xbb\xbf" SQUARE "f 1 2 3 4\n",
        "# a remark\n\n  \t\n" SQUARE "\tf\t1  2 3\t4  # of the square\n",
        "v 0 0 0 # a\nv 2. +0 -0 1\nv 2e0 .3e1 0.\nv 0 3.000000000000000000000000 0e9\nf 1 2 3 4\n",
        "v 0 0 \\\n0\nv 2 0 0\nv 2 3 0\nv 0 \\\r\n 3 0\nf 1 2 \\\n 3 \\\n\\\n4\n",
        "o one\ng a b\ns off\nv 0 0 0\nv 2 0 0\nv 2 3 0\ng\nv 0 3 0\ns 1\nf 1 2 3 4\nend\nvp 1 2\ncstype "
        "bezier\n",
        "v 5 5 5\nv 0 0 0\nv 2 0 0\nf -2 -1 -1\nv 2 3 0\nv 0 3 0\nf 2 3 4 5\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
        for (int end_of_line = 0; end_of_line < 3; end_of_line++) {
            static const char *const ends[] = {"\n", "\r\n", "\r"};
            char text[512] = "";
            size_t at = 0;
            for (const char *c = texts[i]; *c; c++) {
                if (*c == '\r') continue;
                if (*c == '\n')
                    at += (size_t)snprintf(text + at, sizeof text - at, "%s", ends[end_of_line]);
                else
                    text[at++] = *c;
            }
            OWNED(ewa_mesh_free) ewa_mesh mesh;
            double sum[3];
            mesh_load_bytes(context, &messages, "a.obj", text, at, false, &mesh);
            assert_float_equal(mesh_area(&mesh, sum), 6, 0);
            assert_float_equal(sum[2], 6, 0);
        }
}

/// The same text in two bytes per letter, both orders; letters beyond ASCII and beyond 16 bits in remarks.
CASE(test_utf16) {
    static const char text[] = "# caf\xc3\xa9 \xf0\x9f\x90\x80\n" SQUARE "f 1 2 3 4\n";
    for (int big = 0; big < 2; big++) {
        uint8_t bytes[1024];
        size_t at = 0;
#define PUT(unit)                                                                                            \
    (bytes[at + (size_t)!big] = (uint8_t)((unit) >> 8), bytes[at + (size_t)big] = (uint8_t)(unit), at += 2)
        PUT(0xfeffu);
        for (const char *c = text; *c; c++) {
            const uint8_t lead = (uint8_t)*c;
            if (lead == 0xc3) {
                PUT(0xe9u);
                c++;
            } else if (lead == 0xf0) {
                PUT(0xd83du);
                PUT(0xdc00u);
                c += 3;
            } else {
                PUT((unsigned)lead);
            }
        }
        ewa_mesh mesh;
        mesh_load_bytes(context, &messages, "whatever", bytes, at, false, &mesh);
        assert_float_equal(mesh_area(&mesh, NULL), 6, 0);
        ewa_mesh_free(&mesh);
        mesh_load_bytes(context, &messages, "odd.obj", bytes, at - 3, false, &mesh); // cut within a letter
        ewa_mesh_free(&mesh);
    }
}

CASE(test_texcoords_and_normals) {
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    mesh_load_text(context, &messages, "a.obj",
                   SQUARE "vt 0 0\nvt 1 0 0.5\nvt 0.25\nvn 0 0 2\nvn 1 0 0\n"
                          "f 1/1/1 2/2/1 3/3/1\nf 1/2/-1 3/-1/2 4//2\n",
                   &mesh);
    assert_int_equal(mesh.vertex_count, 6);
    const uint32_t first = mesh_corner(&mesh, 0, 0, 0, 0), again = mesh_corner(&mesh, 1, 0, 0, 0),
                   third = mesh_corner(&mesh, 0, 2, 3, 0), fourth = mesh_corner(&mesh, 1, 0, 3, 0);
    assert_true(mesh.texcoords[2 * first] == 0 && mesh.texcoords[2 * again] == 1);
    assert_true(mesh.texcoords[2 * third] == 0.25f && mesh.texcoords[2 * third + 1] == 0);
    assert_true(mesh.texcoords[2 * fourth] == 0 && mesh.texcoords[2 * fourth + 1] == 0);
    assert_true(mesh.normals[3 * first + 2] == 2 && mesh.normals[3 * again] == 1);
    ewa_mesh_free(&mesh);
    // Corners that agree are one vertex.
    mesh_load_text(context, &messages, "a.obj", SQUARE "vt 0 0\nvt 0 0\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\n",
                   &mesh);
    assert_int_equal(mesh.vertex_count, 4);
}

CASE(test_vertex_colors) {
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    mesh_load_text(context, &messages, "a.obj",
                   "v 0 0 0\nv 1 0 0 0.5 0 1\nv 0 1 0 1 0 0 0.25\nv 1 1 0\nf 1 2 3\nf 2 4 3\n", &mesh);
    assert_float_equal(mesh.colors[4], ewa_linear_from_srgb(0.5f), 1e-6);
    assert_true(mesh.colors[0] == 1 && mesh.colors[3] == 1); // white where there is none
    assert_true(mesh.colors[5] == 0 && mesh.colors[6] == 1 && mesh.colors[7] == 1);
    assert_true(mesh.colors[8] == 1 && mesh.colors[11] == 0.25f);
    assert_true(mesh.colors[12] == 1 && mesh.colors[13] == 1);
    ewa_mesh_free(&mesh);
    mesh_load_text(context, &messages, "a.obj", "v 0 0 0\nv 1 0 0 255 0 128\nv 0 1 0 51 0 0\nf 1 2 3\n",
                   &mesh);
    assert_true(mesh.colors[0] == 1 && mesh.colors[3] == 1);
    assert_true(mesh.colors[4] == 1 && mesh.colors[7] == 1);
    assert_float_equal(mesh.colors[6], ewa_linear_from_srgb(128 / 255.0f), 1e-6);
    assert_float_equal(mesh.colors[8], ewa_linear_from_srgb(0.2f), 1e-6);
}

/// What is no number, no corner, no face: the rest is a mesh, and it is said.
CASE(test_bad_statements) {
    ewa_mesh mesh;
    static const struct {
        const char *text, *said;
        uint32_t triangles;
    } cases[] = {
        {SQUARE "v 1 x 2\nf 1 2 3\nf 1 2 5\n", "line 5: not a number; 1 in the file", 2},
        {SQUARE "v 1 2\nf 1 2 3\n", "line 5: not a number", 1},
        {SQUARE "v 1 2 3.1+e2\nf 1 2 3\n", "line 5: not a number", 1},
        {SQUARE "f 1 2 3\nf 1 2 9\nf 0 1 2\nf 1 2 -9\n", "3 faces with a vertex that is not there", 1},
        {SQUARE "f 1 2 3\nf 1 2 x\nf 1 2 3/1/1/1\nf 1 2 3.5\n", "3 faces with a vertex that is not there", 1},
        {SQUARE "f 1 2 3\nf\nf 1\nf 1 2\n", "3 faces of fewer than three corners", 1},
        {SQUARE "l 1 2\nl 1 2 3\np 1\nf 1 2 3\n", "2 lines, 1 points beside the faces are left out", 1},
        {SQUARE "f 1 2 99999999999999999999\nf 1 2 3\n", "1 faces with a vertex that is not there", 1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        mesh_load_bytes(context, &messages, "a.obj", cases[i].text, strlen(cases[i].text), true, &mesh);
        mesh_says(&messages, cases[i].said);
        assert_int_equal(mesh.triangle_count, cases[i].triangles);
        ewa_mesh_free(&mesh);
    }
    static const char none[] = "v 0 0 0\nv 1 0 0\nf 1 2 3\n",
                      nan[] = "v nan inf -inf\nv 1 0 0\nv 2 0 0\nf 1 2 3\n";
    mesh_refuse(context, &messages, "a.obj", none, strlen(none), EWA_ERROR_FORMAT,
                "none of the faces can be used");
    mesh_refuse(context, &messages, "a.obj", nan, strlen(nan), EWA_ERROR_FORMAT,
                "none of the faces has finite");
}

/// Without faces, places are points.
CASE(test_points) {
    static const char *const texts[] = {"v 1 2 3\nv 4 5 6\nv 7 8 9\n", "v 1 2 3\nv 4 5 6\nv 7 8 9\np 1 2 3\n",
                                        "vn 0 0 1\nv 1 2 3\nvn 0 0 1\nv 4 5 6\nv 7 8 9\n"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        ewa_model model;
        ewa_mesh mesh;
        char path[512];
        assert_int_equal(ewa_model_load_memory(context, texts[i], strlen(texts[i]), "a.obj", NULL,
                                               EWA_MODEL_MESH, NULL, &model),
                         EWA_OK);
        assert_int_equal(ewa_cloud_point_count(model.points), 3);
        double p[3];
        ewa_attribute_read_f64(ewa_cloud_find(model.points, EWA_POSITION), 1, 1, p);
        assert_true(p[0] == 4 && p[1] == 5 && p[2] == 6 && model.face_count == 0);
        ewa_model_free(&model);
        assert_string_equal(messages.text, "");
        scratch_write(scratch_path("points.obj", path), texts[i], strlen(texts[i]));
        assert_int_equal(ewa_mesh_load(context, path, &mesh), EWA_ERROR_FORMAT);
        messages = (mesh_messages){.errors = 0};
    }
    static const char lines[] = "v 1 2 3\nv 4 5 6\nl 1 2 7\n"; // drawn, as far as there are places
    OWNED(ewa_model_free) ewa_model model;
    assert_int_equal(
        ewa_model_load_memory(context, lines, strlen(lines), "a.obj", NULL, EWA_MODEL_MESH, NULL, &model),
        EWA_OK);
    assert_string_equal(messages.text, "");
    assert_int_equal(ewa_cloud_point_count(model.points), 1001); // 1,000 steps
}

#define TEXTURED(library) "mtllib " library "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"

/// Loads scratch/mtl.obj with this library.
static void load_with(const char *library, const char *object, ewa_mesh *mesh) {
    char path[512];
    messages = (mesh_messages){.errors = 0};
    if (library) scratch_write(scratch_path("mtl.mtl", path), library, strlen(library));
    scratch_write(scratch_path("mtl.obj", path), object, strlen(object));
    assert_int_equal(ewa_mesh_load(context, path, mesh), EWA_OK);
}

/// Several materials, colours, pictures with blanks in their names, options before them.
CASE(test_materials) {
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    mesh_picture(context, "mtl red.png", 255, 0, 0);
    mesh_picture(context, "mtl_green.png", 0, 255, 0);
    load_with(
        "# library\nnewmtl plain\nKd 1 0.5 0\nd 0.25\nKs 1 1 1\n\tnewmtl pictured \t\n  Kd 0.5 0.5 0.5\n"
        "map_Kd mtl red.png\nillum 2\nnewmtl mapped\nmap_Kd -blendu on -mm 0 1 -o 0.25 0.5 0 -clamp off "
        "-s 2 4 1 mtl_green.png\nnewmtl one\nKd 0.25\nnewmtl xyz\nKd xyz 1 2 3\n",
        TEXTURED("mtl.mtl") "f 1 2 3\nusemtl plain\nf 1/1 2/2 3/3\nusemtl pictured\nf 1/1 2/2 3/3\n"
                            "usemtl mapped\nf 1/1 2/2 3/3\nusemtl one\nf 1 2 3\nusemtl xyz\nf 1 2 3\n",
        &mesh);
    assert_string_equal(messages.text, "");
    const float half = ewa_linear_from_srgb(0.5f), quarter = ewa_linear_from_srgb(0.25f);
    const float *color = mesh_material(&mesh, 0)->base_color;
    assert_true(color[0] == 1 && color[1] == 1 && color[3] == 1 && !mesh_texture(&mesh, 0));
    color = mesh_material(&mesh, 1)->base_color;
    assert_true(color[0] == 1 && color[2] == 0 && color[3] == 0.25f);
    assert_float_equal(color[1], half, 1e-6);
    color = mesh_material(&mesh, 2)->base_color; // the picture stands for Kd
    assert_true(color[0] == 1 && mesh_texture(&mesh, 2)->pixels[0] == 1 &&
                mesh_texture(&mesh, 2)->pixels[1] == 0);
    assert_true(mesh_texture(&mesh, 3)->pixels[1] == 1);
    const uint32_t second = mesh_corner(&mesh, 3, 1, 0, 0), third = mesh_corner(&mesh, 3, 0, 1, 0);
    assert_true(mesh.texcoords[2 * second] == 2.25f && mesh.texcoords[2 * second + 1] == 0.5f);
    assert_true(mesh.texcoords[2 * third] == 0.25f && mesh.texcoords[2 * third + 1] == 4.5f);
    const uint32_t unmapped = mesh_corner(&mesh, 2, 1, 0, 0);
    assert_true(mesh.texcoords[2 * unmapped] == 1 && mesh.texcoords[2 * unmapped + 1] == 0);
    for (int c = 0; c < 3; c++) assert_float_equal(mesh_material(&mesh, 4)->base_color[c], quarter, 1e-6);
    for (int c = 0; c < 3; c++) assert_true(mesh_material(&mesh, 5)->base_color[c] == 1);
}

/// What is written as PLY is the same mesh when it is read again: places, pictures, their coordinates,
/// colours.
CASE(test_written_as_ply) {
    static const char *const library =
        "newmtl a\nmap_Kd -s 2 1 one picture.png\nnewmtl b\nKd 0.2 0.4 0.6\nd 0.4\nnewmtl c\n"
        "map_Kd written.png\n";
    char path[512];
    ewa_mesh from, to;
    mesh_picture(context, "one picture.png", 255, 0, 0);
    mesh_picture(context, "written.png", 0, 0, 255);
    load_with(library,
              TEXTURED("mtl.mtl") "v 1 1 4200000.125\nusemtl b\nf 1 2 3\nusemtl c\nf 1/1 2/2 3/3\nusemtl a\n"
                                  "f 2/1 4/3 3/2\n",
              &from);
    OWNED(ewa_model_free) ewa_model model;
    assert_int_equal(ewa_model_load(context, scratch_path("mtl.obj", path),
                                    EWA_MODEL_POINTS | EWA_MODEL_ELEMENTS, NULL, &model),
                     EWA_OK);
    WITH_DEFAULTS(ewa_cloud_save_options, options);
    for (int encoding = 0; encoding < 3; encoding++) {
        options.ply_encoding = (ewa_ply_encoding)encoding;
        options.elements = model.elements;
        assert_int_equal(ewa_cloud_save(model.points, scratch_path("written.ply", path), &options), EWA_OK);
        assert_int_equal(ewa_mesh_load(context, path, &to), EWA_OK);
        assert_int_equal(to.triangle_count, 3);
        for (uint32_t i = 0; i < 9; i++) {
            const uint32_t a = from.triangles[i], b = to.triangles[i];
            assert_memory_equal(from.positions + 3 * a, to.positions + 3 * b, 3 * sizeof(double));
            if (i >= 3) assert_memory_equal(from.texcoords + 2 * a, to.texcoords + 2 * b, 2 * sizeof(float));
            for (int c = 0; c < 4 && i < 3; c++)
                assert_float_equal(to.colors[4 * b + (uint32_t)c], mesh_material(&from, 0)->base_color[c],
                                   0.005);
            for (int c = 0; c < 4 && i >= 3; c++) assert_float_equal(to.colors[4 * b + (uint32_t)c], 1, 0);
        }
        assert_true(mesh_texture(&to, 1)->pixels[2] == 1 && mesh_texture(&to, 2)->pixels[0] == 1 &&
                    !mesh_texture(&to, 0));
        ewa_mesh_free(&to);
    }
    assert_string_equal(messages.text, "");
    ewa_model_free(&model);
    ewa_mesh_free(&from);
    // Places whose faces cannot be used are points.
    static const char *const useless = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\nf 1 2 9\n";
    assert_int_equal(ewa_model_load_memory(context, useless, strlen(useless), "a.obj", NULL,
                                           EWA_MODEL_POINTS | EWA_MODEL_ELEMENTS, NULL, &model),
                     EWA_OK);
    assert_true(ewa_cloud_point_count(model.points) == 3 && !model.elements);
    mesh_says(&messages, "left out of 2 faces");
}

/// One picture that many materials name is there once.
CASE(test_shared_picture) {
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    mesh_picture(context, "shared.png", 255, 0, 0);
    load_with(
        "newmtl a\nmap_Kd shared.png\nnewmtl b\nKd 0 1 0\nmap_Kd shared.png\nnewmtl c\nmap_Kd shared.png\n",
        TEXTURED("mtl.mtl") "usemtl b\nf 1/1 2/2 3/3\nusemtl a\nf 1/1 2/2 3/3\nusemtl c\nf 1/1 2/2 3/3\n",
        &mesh);
    int count = 0;
    for (uint32_t m = 0; m < mesh.material_count; m++) count += mesh.textures[m].pixels != NULL;
    assert_int_equal(count, 1);
    for (uint32_t t = 0; t < 3; t++) assert_ptr_equal(mesh_texture(&mesh, t), mesh_texture(&mesh, 0));
}

CASE(test_libraries) {
    char path[512];
    ewa_mesh mesh;
    static const char *const library = "newmtl m\nKd 0 1 0\n";
    scratch_write(scratch_path("a name.mtl", path), library, strlen(library));
    scratch_write(scratch_path("second.mtl", path), "newmtl n\nKd 0 0 1\n", 18);
    static const struct {
        const char *line;
        bool m, n;
        const char *said;
    } cases[] = {
        {"mtllib a name.mtl\n", true, false, "uses of materials that no library has"},
        {"mtllib mtl.mtl second.mtl\n", true, true, ""},
        {"mtllib second.mtl\nmtllib mtl.mtl\n", true, true, ""},
        {"mtllib ./mtl.mtl\nmtllib .\\second.mtl\n", true, true, ""},
        {"mtllib C:\\models\\second.mtl\n", false, true, "uses of materials"},
        {"mtllib /nowhere/second.mtl\n", false, true, "uses of materials"},
        {"mtllib none.mtl\n", true, false,
         "'none.mtl' is left out: it is not there; instead of it: 'mtl.mtl'"},
        {"mtllib none.mtl second.mtl\n", true, true,
         "the material library 'none.mtl second.mtl' is left out"},
        {"mtllib\n", false, false, ""},
        {"", false, false, ""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[512];
        snprintf(text, sizeof text, "%s" SQUARE "usemtl m\nf 1 2 3\nusemtl n\nf 1 3 4\n", cases[i].line);
        load_with(library, text, &mesh);
        if (cases[i].said[0])
            mesh_says(&messages, cases[i].said);
        else
            assert_string_equal(messages.text, "");
        assert_int_equal(messages.errors, 0);
        if (!cases[i].m && !cases[i].n) {
            assert_int_equal(mesh.material_count, 0);
        } else {
            assert_true((mesh_material(&mesh, 0)->base_color[0] == 0) == cases[i].m);
            assert_true((mesh_material(&mesh, 1)->base_color[0] == 0) == cases[i].n);
        }
        ewa_mesh_free(&mesh);
    }
}

/// A mesh that was renamed together with its library.
CASE(test_renamed) {
    char path[512];
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    static const char *const library = "newmtl m\nKd 0 1 0\n", *const text =
                                                                   "mtllib old.mtl\nmtllib older.mtl\n" SQUARE
                                                                   "usemtl m\nf 1 2 3 4\n";
    for (int there = 0; there < 2; there++) {
        unlink(scratch_path("renamed.mtl", path));
        if (there) scratch_write(path, library, strlen(library));
        scratch_write(scratch_path("renamed.obj", path), text, strlen(text));
        messages = (mesh_messages){.errors = 0};
        assert_int_equal(ewa_mesh_load(context, path, &mesh), EWA_OK);
        assert_int_equal(mesh.material_count, there);
        mesh_says(&messages, "'older.mtl' is left out: it is not there");
        const char *instead = strstr(messages.text, "'old.mtl' is left out: it is not there; instead of it: "
                                                    "'renamed.mtl'");
        assert_int_equal(instead != NULL, there);
        assert_int_equal(strstr(messages.text, "instead") != NULL, there);
        ewa_mesh_free(&mesh);
    }
    // It is not had twice, and not in place of itself.
    static const char *const itself = "mtllib itself.mtl\n" SQUARE "f 1 2 3 4\n";
    scratch_write(scratch_path("itself.obj", path), itself, strlen(itself));
    messages = (mesh_messages){.errors = 0};
    assert_int_equal(ewa_mesh_load(context, path, &mesh), EWA_OK);
    mesh_says(&messages, "'itself.mtl' is left out: it is not there");
    assert_null(strstr(messages.text, "instead"));
}

/// A mesh that names no library has the one material of that beside it, where it has texture coordinates.
CASE(test_unnamed) {
    (void)state;
    static const struct {
        const char *library, *text;
        bool taken;
    } cases[] = {
        {"newmtl m\nKd 0 1 0\n", SQUARE "vt 0 0\nf 1/1 2/1 3/1 4/1\n", true},
        {"newmtl m\nKd 0 1 0\nnewmtl n\nKd 0 0 1\n", SQUARE "vt 0 0\nf 1/1 2/1 3/1 4/1\n", false},
        {"", SQUARE "vt 0 0\nf 1/1 2/1 3/1 4/1\n", false},
        {NULL, SQUARE "vt 0 0\nf 1/1 2/1 3/1 4/1\n", false},
        {"newmtl m\nKd 0 1 0\n", SQUARE "f 1 2 3 4\n", false},
        {"newmtl m\nKd 0 1 0\n", SQUARE "vt 0 0\nusemtl m\nf 1/1 2/1 3/1 4/1\n", false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char path[512];
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        unlink(scratch_path("unnamed.mtl", path));
        if (cases[i].library) scratch_write(path, cases[i].library, strlen(cases[i].library));
        scratch_write(scratch_path("unnamed.obj", path), cases[i].text, strlen(cases[i].text));
        messages = (mesh_messages){.errors = 0};
        assert_int_equal(ewa_mesh_load(context, path, &mesh), EWA_OK);
        assert_int_equal(mesh.material_count, cases[i].taken);
        if (cases[i].taken) assert_true(mesh_material(&mesh, 0)->base_color[0] == 0);
        assert_int_equal(messages.errors, 0);
        assert_null(strstr(messages.text, "left out"));
    }
}

/// A library that is a folder, a pipe, a device or elsewhere is not opened.
CASE(test_hostile_names) {
    char path[512];
    ewa_mesh mesh;
    unlink(scratch_path("pipe.png", path));
    assert_int_equal(mkfifo(path, 0666), 0);
    mkdir(scratch_path("folder.png", path), 0777);
    unlink(scratch_path("link.png", path));
    assert_int_equal(symlink("/etc/hostname", path), 0);
    unlink(scratch_path("zero.png", path));
    assert_int_equal(symlink("/dev/zero", path), 0);
    static const struct {
        const char *name, *said;
    } names[] = {{"pipe.png", "it is no regular file"},
                 {"folder.png", "it is no regular file"},
                 {"link.png", "it is not below the folder"},
                 {"zero.png", "it is not below the folder"},
                 {"../scratch/../../../../../../etc/hostname", "left out"},
                 {"/etc/hostname", "its name is absolute"},
                 {"/dev/zero", "its name is absolute"},
                 {"file:///etc/hostname", "its name is absolute"},
                 {"mtl.obj", "it cannot be read"},
                 {"none.png", "it is not there"}};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        char library[256];
        snprintf(library, sizeof library, "newmtl m\nKd 0 1 0\nmap_Kd %s\n", names[i].name);
        load_with(library, TEXTURED("mtl.mtl") "usemtl m\nf 1/1 2/2 3/3\n", &mesh);
        assert_null(mesh_texture(&mesh, 0));
        assert_true(mesh_material(&mesh, 0)->base_color[1] == 1 &&
                    mesh_material(&mesh, 0)->base_color[0] == 0);
        char quoted[64];
        snprintf(quoted, sizeof quoted, "the picture '%.40s", names[i].name);
        mesh_says(&messages, quoted);
        mesh_says(&messages, names[i].said);
        assert_int_equal(messages.errors, 0);
        ewa_mesh_free(&mesh);
    }
    static const char *const lines[] = {"mtllib pipe.png\n", "mtllib zero.png\n", "mtllib folder.png\n",
                                        "mtllib ../../../etc/hostname\n"};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        char text[512];
        snprintf(text, sizeof text, "%s" SQUARE "f 1 2 3\n", lines[i]);
        load_with(NULL, text, &mesh);
        mesh_says(&messages, "the material library");
        ewa_mesh_free(&mesh);
    }
}

/// Many pictures that are missing are named a few times and counted.
CASE(test_many_missing) {
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    char library[4096] = "", object[8192] = TEXTURED("mtl.mtl");
    for (int i = 0; i < 50; i++) {
        const size_t a = strlen(library), b = strlen(object);
        snprintf(library + a, sizeof library - a, "newmtl m%d\nmap_Kd missing%d.png\n", i, i);
        snprintf(object + b, sizeof object - b, "usemtl m%d\nf 1/1 2/2 3/3\n", i);
    }
    load_with(library, object, &mesh);
    mesh_says(&messages, "missing4.png");
    mesh_says(&messages, "50 pictures are left out in all");
    assert_null(strstr(messages.text, "missing5.png"));
}

int main(void) { return RUN_TESTS(NULL, NULL); }
