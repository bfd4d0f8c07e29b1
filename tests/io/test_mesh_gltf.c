// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// glTF and GLB: where buffers may be, how numbers may be stored, nodes, primitives.
#include "io/gltf_check.h"
#include "io/mesh_fixture.h"

static const float strip[12] = {0, 0, 0, 2, 0, 0, 0, 3, 0, 2, 3, 0};

static void check_square(const ewa_mesh *mesh) {
    double sum[3];
    assert_float_equal(mesh_area(mesh, sum), 6, 1e-6);
    assert_float_equal(sum[2], 6, 1e-6);
}

/// Modes, and indices of every type.
CASE(test_primitives) {
    static const struct {
        const char *primitive;
        const float *places;
        int index_type; ///< 0: none
        uint32_t indices[6], index_count;
    } cases[] = {
        {"\"mode\":4,\"indices\":1", gltf_square, 5121, {0, 1, 2, 0, 2, 3}, 6},
        {"\"mode\":4,\"indices\":1", gltf_square, 5123, {0, 1, 2, 0, 2, 3}, 6},
        {"\"indices\":1", gltf_square, 5125, {0, 1, 2, 0, 2, 3}, 6},
        {"\"mode\":5", strip, 0, {0}, 0},
        {"\"mode\":6", gltf_square, 0, {0}, 0},
        {"\"mode\":5,\"indices\":1", gltf_square, 5121, {0, 1, 3, 2}, 4},
        {"\"mode\":6,\"indices\":1", gltf_square, 5123, {1, 2, 3, 0}, 4},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        glb g = {.size = 0};
        put_floats(&g, 12, cases[i].places);
        const size_t bytes = cases[i].index_type == 5121 ? 1 : cases[i].index_type == 5123 ? 2 : 4;
        for (uint32_t k = 0; k < cases[i].index_count; k++, g.size += bytes) {
            memset(g.bytes + g.size, 0, bytes);
            g.bytes[g.size] = (uint8_t)cases[i].indices[k];
        }
        snprintf(
            g.json, sizeof g.json,
            GLTF_HEAD(
                GLTF_NODE) "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},%s}]}],"
                           "\"accessors\":[" GLTF_POSITIONS
                           ",{\"bufferView\":1,\"componentType\":%d,\"count\":%u,\"type\":\"SCALAR\"}],"
                           "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":"
                           "48,\"byteLength\":%zu}],"
                           "\"buffers\":[{\"byteLength\":%zu}]}",
            cases[i].primitive, cases[i].index_type ? cases[i].index_type : 5125, cases[i].index_count,
            g.size - 48, g.size);
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        glb_load(context, &messages, &g, false, &mesh);
        check_square(&mesh);
    }
}

/// Positions as integers of every kind, plain and normalised, with strides and offsets, and sparse ones.
CASE(test_accessors) {
    static const struct {
        int type;
        bool normalized;
        double scale; ///< of what the numbers stand for
    } kinds[] = {{5120, false, 1},    {5121, false, 1},   {5122, false, 1},  {5123, false, 1},
                 {5125, false, 1},    {5126, false, 1},   {5120, true, 127}, {5121, true, 255},
                 {5122, true, 32767}, {5123, true, 65535}};
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        glb g = {.size = 8};
        const size_t bytes = kinds[k].type < 5122   ? 1
                             : kinds[k].type < 5124 ? 2
                                                    : 4,
                     stride = 3 * bytes + 4 - 3 * bytes % 4 + 4;
        for (int v = 0; v < 4; v++)
            for (size_t c = 0; c < 3; c++) {
                const uint32_t number = (uint32_t)gltf_square[3 * v + (int)c];
                uint8_t *to = g.bytes + g.size + (size_t)v * stride + c * bytes;
                if (kinds[k].type == 5126)
                    memcpy(to, &gltf_square[3 * v + (int)c], 4);
                else
                    memcpy(to, &number, bytes);
            }
        g.size += 4 * stride;
        snprintf(
            g.json, sizeof g.json,
            GLTF_HEAD(
                GLTF_NODE) "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":6}]}],"
                           "\"accessors\":["
                           "{\"bufferView\":0,\"byteOffset\":4,\"componentType\":%d,\"normalized\":%s,"
                           "\"count\":4,\"type\":\"VEC3\"}],"
                           "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":4,\"byteLength\":%zu,"
                           "\"byteStride\":%zu}],\"buffers\":[{\"byteLength\":%zu}]}",
            kinds[k].type, kinds[k].normalized ? "true" : "false", g.size - 4, stride, g.size);
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        glb_load(context, &messages, &g, false, &mesh);
        const double area = mesh_area(&mesh, NULL), wanted = 6 / (kinds[k].scale * kinds[k].scale);
        assert_true(fabs(area - wanted) < 1e-12 + 1e-9 * wanted);
    }
    // Negative ones, normalised: -128 counts as -1.
    glb g = {.bytes = {0x80, 0x81, 0, 127, 0x81, 0, 0, 127, 0}, .size = 9};
    snprintf(
        g.json, sizeof g.json,
        GLTF_HEAD(
            GLTF_NODE) "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":["
                       "{\"bufferView\":0,\"componentType\":5120,\"normalized\":true,\"count\":3,\"type\":"
                       "\"VEC3\"}],"
                       "\"bufferViews\":[{\"buffer\":0,\"byteLength\":9}],\"buffers\":[{\"byteLength\":9}]}");
    ewa_mesh mesh;
    glb_load(context, &messages, &g, false, &mesh);
    assert_float_equal(mesh_area(&mesh, NULL), 2, 0);
    ewa_mesh_free(&mesh);
    // Sparse over a view, and over nothing, which is zeros.
    for (int base = 0; base < 2; base++) {
        glb s = {.size = 0};
        static const float wrong[12] = {0, 0, 0, 9, 9, 9, 2, 3, 0, 9, 9, 9}, right[6] = {2, 0, 0, 0, 3, 0},
                           all[9] = {2, 0, 0, 2, 3, 0, 0, 3, 0};
        put_floats(&s, 12, wrong);
        const size_t values = base ? put_floats(&s, 6, right) : put_floats(&s, 9, all), indices = s.size;
        if (!base)
            s.bytes[s.size++] = 1, s.bytes[s.size++] = 0, s.bytes[s.size++] = 2, s.bytes[s.size++] = 0,
            s.bytes[s.size++] = 3, s.bytes[s.size++] = 0;
        else
            s.bytes[s.size++] = 1, s.bytes[s.size++] = 0, s.bytes[s.size++] = 3, s.bytes[s.size++] = 0;
        snprintf(
            s.json, sizeof s.json,
            GLTF_HEAD(
                GLTF_NODE) "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":6}]}],"
                           "\"accessors\":[{%s"
                           "\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"sparse\":{\"count\":%d,"
                           "\"indices\":{\"bufferView\":2,\"componentType\":5123},"
                           "\"values\":{\"bufferView\":1}}}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":"
                           "48},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu},"
                           "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}],\"buffers\":[{"
                           "\"byteLength\":%zu}]}",
            base ? "\"bufferView\":0," : "", base ? 2 : 3, values, indices - values, indices,
            s.size - indices, s.size);
        glb_load(context, &messages, &s, false, &mesh);
        check_square(&mesh);
        ewa_mesh_free(&mesh);
    }
}

/// Matrices, translation, rotation and scale, one below the other; what mirrors keeps its outside;
/// coordinates of maps keep their digits.
CASE(test_nodes) {
    static const struct {
        const char *nodes;
        double low[3], high[3], up; ///< box, and the z of the area
    } cases[] = {
        {GLTF_NODE, {0, 0, 0}, {2, 3, 0}, 6},
        {"{\"mesh\":0,\"translation\":[500000.25,4200000.5,1e-3]}",
         {500000.25, 4200000.5, 1e-3},
         {500002.25, 4200003.5, 1e-3},
         6},
        {"{\"mesh\":0,\"scale\":[-2,1,1]}", {-4, 0, 0}, {0, 3, 0}, 12},
        {"{\"mesh\":0,\"rotation\":[0,0,0.7071067811865476,0.7071067811865476]}", {-3, 0, 0}, {0, 2, 0}, 6},
        {"{\"mesh\":0,\"matrix\":[0,1,0,0,-1,0,0,0,0,0,1,0,10,20,30,1]}", {7, 20, 30}, {10, 22, 30}, 6},
        {"{\"children\":[1],\"translation\":[1,0,0]},{\"mesh\":0,\"scale\":[2,2,2],\"translation\":[0,1,0]}",
         {1, 1, 0},
         {5, 7, 0},
         24},
        {"{\"children\":[1],\"scale\":[2,2,2]},{\"mesh\":0,\"translation\":[0,1,0]}",
         {0, 2, 0},
         {4, 8, 0},
         24},
        {"{\"children\":[1,2]},{\"mesh\":0},{\"mesh\":0,\"translation\":[0,0,1]}", {0, 0, 0}, {2, 3, 1}, 12},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        glb g = {.size = 0};
        put_floats(&g, 12, gltf_square);
        snprintf(g.json, sizeof g.json,
                 "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[%s],"
                 "\"meshes\":[{\"primitives\":"
                 "[{\"attributes\":{\"POSITION\":0},\"mode\":6}]}],\"accessors\":[" GLTF_POSITIONS
                 "]," GLTF_VIEW,
                 cases[i].nodes);
        for (int scenes = 0; scenes < 2; scenes++) {
            OWNED(ewa_mesh_free) ewa_mesh mesh;
            double sum[3];
            // Without scenes, the nodes that are nobody's children are it.
            if (!scenes) memcpy(strstr(g.json, "\"scenes\""), "\"sceneX\"", 8);
            glb_load(context, &messages, &g, false, &mesh);
            mesh_area(&mesh, sum);
            assert_float_equal(sum[2], cases[i].up, 1e-9);
            for (uint32_t v = 0; v < 3 * mesh.vertex_count; v++) {
                assert_true(mesh.positions[v] >= cases[i].low[v % 3] - 1e-9);
                assert_true(mesh.positions[v] <= cases[i].high[v % 3] + 1e-9);
            }
            if (i == 1) assert_true(mesh.positions[0] == 500000.25 && mesh.positions[1] == 4200000.5);
        }
    }
}

/// Floats that are too coarse are said, unless a node puts them where they are.
CASE(test_coarse_floats) {
    static const float far[12] = {500000, 4200000, 0, 500001, 4200000, 0,
                                  500001, 4200001, 0, 500000, 4200001, 0};
    for (int moved = 0; moved < 2; moved++) {
        glb g = {.size = 0};
        put_floats(&g, 12, far);
        snprintf(g.json, sizeof g.json,
                 "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0,\"translation\":[%d,0,0]}],"
                 "\"meshes\":[{\"primitives\":"
                 "[{\"attributes\":{\"POSITION\":0},\"mode\":6}]}],\"accessors\":[" GLTF_POSITIONS
                 "]," GLTF_VIEW,
                 moved);
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        glb_load(context, &messages, &g, true, &mesh);
        assert_int_equal(strstr(messages.text, "are floats, in steps of 0.5") != NULL, !moved);
    }
}

/// Normals go by the inverse transpose; a mirrored one still points out. Alpha of colours counts where the material blends.
static void try_normals_and_colors(const char *material, float alpha) {
    glb g = {.size = 0};
    static const float normals[12] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 1, 0, 1}, uv[8] = {0, 0, 1, 0, 1, 1, 0, 1};
    put_floats(&g, 12, gltf_square);
    put_floats(&g, 12, normals);
    put_floats(&g, 8, uv);
    const uint8_t colors[16] = {255, 0, 0, 255, 255, 0, 0, 128, 255, 0, 0, 255, 51, 0, 0, 255};
    memcpy(g.bytes + g.size, colors, 16);
    g.size += 16;
    snprintf(
        g.json, sizeof g.json,
        GLTF_HEAD(
            "{\"mesh\":0,\"scale\":[-2,1,1]}") "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,"
                                               "\"NORMAL\":1,\"TEXCOORD_0\":2,\"COLOR_0\":3},\"mode\":6,\"material\":0}]}],\"materials\":[{%s}],"
                                               "\"accessors\":[" GLTF_POSITIONS
                                               ",{\"bufferView\":1,\"componentType\":5126,\"count\":4,"
                                               "\"type\":\"VEC3\"},{\"bufferView\":2,\"componentType\":5126,"
                                               "\"count\":4,\"type\":\"VEC2\"},"
                                               "{\"bufferView\":3,\"componentType\":5121,\"normalized\":true,"
                                               "\"count\":4,\"type\":\"VEC4\"}],\"bufferViews\":[{\"buffer\":"
                                               "0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,"
                                               "\"byteLength\":48},"
                                               "{\"buffer\":0,\"byteOffset\":96,\"byteLength\":32},{"
                                               "\"buffer\":0,\"byteOffset\":128,\"byteLength\":16}],"
                                               "\"buffers\":[{\"byteLength\":144}]}", material);
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    glb_load(context, &messages, &g, false, &mesh);
    const uint32_t last = mesh_corner(&mesh, 1, 0, 3, 0), first = mesh_corner(&mesh, 0, 0, 0, 0),
                   second = mesh_corner(&mesh, 0, -4, 0, 0);
    const float *n = mesh.normals + 3 * last;
    assert_true(mesh.normals[3 * first + 2] > 0 && n[2] > 0);
    assert_float_equal(n[0] / n[2], -0.5, 1e-6); // (1, 0, 1) through diag(-2, 1, 1) to the inverse transpose
    assert_true(mesh.texcoords[2 * first + 1] == 1 && mesh.texcoords[2 * last + 1] == 0); // from below
    assert_float_equal(mesh.colors[4 * last], 0.2, 1e-6);                                 // linear
    assert_float_equal(mesh.colors[4 * second + 3], alpha, 1e-6);
}

CASE(test_normals_and_colors) {
    try_normals_and_colors("\"alphaMode\":\"BLEND\"", 128 / 255.0f);
    try_normals_and_colors("", 1);
}

/// A buffer in text, in a file beside, in a file elsewhere.
CASE(test_buffers) {
    static const char text[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\"meshes\":[{"
        "\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
        "\"buffers\":[{\"byteLength\":36,\"uri\":\"%s\"}]}";
    char json[2048], path[512];
    ewa_mesh mesh;
    snprintf(json, sizeof json, text,
             "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA");
    mesh_load_text(context, &messages, "a.txt", json, &mesh);
    assert_float_equal(mesh_area(&mesh, NULL), 0.5, 0);
    ewa_mesh_free(&mesh);
    static const char *const bad[][2] = {{"data:;base64,AAAA", "it is shorter than byteLength says"},
                                         {"data:,%00", "a data URI that is not base64"},
                                         {"data:;base64,AA*A", "letters that base64 has not"},
                                         {"data:;base64,AAAAA", "letters that base64 has not"}};
    for (int i = 0; i < 4; i++) {
        snprintf(json, sizeof json, text, bad[i][0]);
        mesh_refuse(context, &messages, "a.gltf", json, strlen(json), EWA_ERROR_FORMAT, bad[i][1]);
    }
    const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    scratch_write(scratch_path("my buffer.bin", path), triangle, sizeof triangle);
    snprintf(json, sizeof json, text, "my%20buffer.bin");
    scratch_write(scratch_path("buffer.gltf", path), json, strlen(json));
    assert_int_equal(ewa_mesh_load(context, path, &mesh), EWA_OK);
    assert_float_equal(mesh_area(&mesh, NULL), 0.5, 0);
    ewa_mesh_free(&mesh);
    mesh_refuse(context, &messages, "a.gltf", json, strlen(json), EWA_ERROR_IO,
                "no file that it could lie beside");
    unlink(scratch_path("gltf_pipe", path));
    assert_int_equal(mkfifo(path, 0666), 0);
    static const char *const elsewhere[] = {"/etc/hostname",
                                            "../../../etc/passwd",
                                            "file:///etc/passwd",
                                            "/dev/zero",
                                            "gltf_pipe",
                                            "none.bin",
                                            "."};
    for (size_t i = 0; i < sizeof elsewhere / sizeof elsewhere[0]; i++) {
        messages = (mesh_messages){.errors = 0};
        snprintf(json, sizeof json, text, elsewhere[i]);
        scratch_write(scratch_path("buffer.gltf", path), json, strlen(json));
        assert_int_equal(ewa_mesh_load(context, path, &mesh), EWA_ERROR_IO);
        mesh_says(&messages, elsewhere[i]);
    }
}

/// Points are a cloud where there are no triangles, and counted beside them, as lines are.
CASE(test_points_and_lines) {
    glb g = {.size = 0};
    uint8_t file[16384];
    put_floats(&g, 12, gltf_square);
    snprintf(
        g.json, sizeof g.json,
        GLTF_HEAD(GLTF_NODE) "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":0},{"
                             "\"attributes\":{\"POSITION\":0},\"mode\":1}]}],"
                             "\"accessors\":[" GLTF_POSITIONS "]," GLTF_VIEW);
    ewa_model model;
    assert_int_equal(
        ewa_model_load_memory(context, file, glb_bytes(&g, file), "a", NULL, EWA_MODEL_MESH, NULL, &model),
        EWA_OK);
    assert_int_equal(ewa_cloud_point_count(model.points), 4);
    assert_int_equal(model.mesh.triangle_count, 0);
    mesh_says(&messages, "1 lines beside the points are left out");
    ewa_model_free(&model);
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    snprintf(
        g.json, sizeof g.json,
        GLTF_HEAD(GLTF_NODE) "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":0},{"
                             "\"attributes\":{\"POSITION\":0},\"mode\":3},"
                             "{\"attributes\":{\"POSITION\":0},\"mode\":6}]}],\"accessors\":[" GLTF_POSITIONS
                             "]," GLTF_VIEW);
    glb_load(context, &messages, &g, true, &mesh);
    assert_int_equal(mesh.vertex_count, 4);
    mesh_says(&messages, "1 lines, 1 points beside the faces are left out");
}

/// Numbers that lie: each is an error that names the place.
CASE(test_lies) {
    static const struct {
        const char *from, *to, *said;
        ewa_status status;
    } cases[] = {
        {"\"count\":4", "\"count\":5", "accessors[0]: it ends behind its buffer view", EWA_ERROR_FORMAT},
        {"\"count\":4", "\"count\":-1", "accessors[0]: count is no count", EWA_ERROR_FORMAT},
        {"\"count\":4", "\"count\":1.5", "accessors[0]: count is no count", EWA_ERROR_FORMAT},
        {"\"count\":4", "\"count\":9007199254740992", "more vertices and corners than a file of",
         EWA_ERROR_LIMIT},
        {"\"byteLength\":48}],\"buffers\"", "\"byteLength\":49}],\"buffers\"",
         "bufferViews[0]: it ends behind its buffer", EWA_ERROR_FORMAT},
        {"\"byteLength\":48}],\"buffers\"", "\"byteLength\":48,\"byteOffset\":1}],\"buffers\"",
         "bufferViews[0]: it ends behind its buffer", EWA_ERROR_FORMAT},
        {"\"byteLength\":48}],\"buffers\"", "\"byteLength\":48,\"byteStride\":8}],\"buffers\"",
         "accessors[0]: it ends behind", EWA_ERROR_FORMAT},
        {"\"bufferView\":0", "\"bufferView\":7", "bufferViews[7]: there is no such one", EWA_ERROR_FORMAT},
        {"\"POSITION\":0", "\"POSITION\":3", "accessors[3]: there is no such one", EWA_ERROR_FORMAT},
        {"\"POSITION\":0", "\"POSITION\":\"x\"", "meshes[0]: the number of an accessor is wrong",
         EWA_ERROR_FORMAT},
        {"\"VEC3\"", "\"VEC2\"", "accessors[0]: its type is not what it is used for", EWA_ERROR_FORMAT},
        {"5126", "5124", "accessors[0]: its type is not what it is used for", EWA_ERROR_FORMAT},
        {"\"mode\":6", "\"mode\":7", "meshes[0]: mode, material or indices", EWA_ERROR_FORMAT},
        {"\"mode\":6", "\"mode\":6,\"material\":0", "materials[0]: there is no such one", EWA_ERROR_FORMAT},
        {"\"mode\":6", "\"mode\":6,\"indices\":9", "accessors[9]: there is no such one", EWA_ERROR_FORMAT},
        {"{\"mesh\":0}", "{\"mesh\":1}", "nodes[0]: there is no such mesh", EWA_ERROR_FORMAT},
        {"{\"mesh\":0}", "{\"mesh\":0,\"children\":[0]}", "nodes[0]: it hangs at two places",
         EWA_ERROR_FORMAT},
        {"{\"mesh\":0}", "{\"mesh\":0,\"children\":[5]}", "nodes[5]: there is no such one", EWA_ERROR_FORMAT},
        {"{\"mesh\":0}", "{\"mesh\":0,\"children\":[\"x\"]}", "nodes[0]: a child is no number",
         EWA_ERROR_FORMAT},
        {"{\"mesh\":0}", "{\"mesh\":0,\"matrix\":[1]}", "nodes[0]: matrix is no array of 16",
         EWA_ERROR_FORMAT},
        {"{\"mesh\":0}", "{\"mesh\":0,\"scale\":3}", "nodes[0]: translation, rotation or scale",
         EWA_ERROR_FORMAT},
        {"\"scene\":0", "\"scene\":4", "scenes[4]: there is no such one", EWA_ERROR_FORMAT},
        {"\"2.0\"", "\"1.0\"", "glTF of version '1.0'", EWA_ERROR_UNSUPPORTED},
        {"\"buffers\":[{", "\"buffers\":[{\"x\":[", "not JSON", EWA_ERROR_FORMAT},
        {"\"mesh\":0", "\"name\":0", "there are neither faces nor points", EWA_ERROR_FORMAT},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        glb g = {.size = 0};
        put_floats(&g, 12, gltf_square);
        static const char json[] =
            GLTF_HEAD(GLTF_NODE) "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},"
                                 "\"mode\":6}]}],\"accessors\":[" GLTF_POSITIONS "]," GLTF_VIEW;
        const char *at = strstr(json, cases[i].from);
        assert_non_null(at);
        snprintf(g.json, sizeof g.json, "%.*s%s%s", (int)(at - json), json, cases[i].to,
                 at + strlen(cases[i].from));
        glb_refuse(context, &messages, &g, cases[i].status, cases[i].said);
    }
    // Chunks that end behind the file, other versions of the container.
    glb g = {.size = 0};
    uint8_t file[16384];
    snprintf(g.json, sizeof g.json, "{\"asset\":{\"version\":\"2.0\"}}");
    const size_t size = glb_bytes(&g, file);
    file[12]++;
    file[13]++;
    mesh_refuse(context, &messages, "a.glb", file, size, EWA_ERROR_FORMAT, "ends behind the file");
    file[4] = 1;
    mesh_refuse(context, &messages, "a.glb", file, size, EWA_ERROR_UNSUPPORTED, "GLB of version 1");
    mesh_refuse(context, &messages, "a.glb", file, 11, EWA_ERROR_FORMAT, "ends in its header");
    file[4] = 2;
    mesh_refuse(context, &messages, "a.glb", file, 12, EWA_ERROR_FORMAT, "no JSON chunk");
}

/// A tree that names a child twice at each level would have 2^n nodes; a short file that names one accessor a
/// thousand times, or a huge one of zeros, is refused before it takes memory.
CASE(test_amplification) {
    static char text[1 << 16];
    size_t at = (size_t)snprintf(text, sizeof text,
                                 "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[");
    for (int i = 0; i < 60; i++)
        at += (size_t)snprintf(text + at, sizeof text - at, "{\"children\":[%d,%d]},", i + 1, i + 1);
    snprintf(text + at, sizeof text - at, "{}]}");
    mesh_refuse(context, &messages, "a.gltf", text, strlen(text), EWA_ERROR_FORMAT, "it hangs at two places");
    at = (size_t)snprintf(text, sizeof text,
                          "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[");
    for (int i = 0; i < 300; i++)
        at += (size_t)snprintf(text + at, sizeof text - at, "{\"children\":[%d]},", i + 1);
    snprintf(text + at, sizeof text - at, "{}]}");
    mesh_refuse(context, &messages, "a.gltf", text, strlen(text), EWA_ERROR_FORMAT, "over 256 nodes deep");
    snprintf(
        text, sizeof text,
        GLTF_HEAD(
            GLTF_NODE) "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":["
                       "{\"componentType\":5126,\"count\":1000000000,\"type\":\"VEC3\"}]}");
    mesh_refuse(context, &messages, "a.gltf", text, strlen(text), EWA_ERROR_LIMIT,
                "more vertices and corners");
    at = (size_t)snprintf(text, sizeof text, GLTF_HEAD(GLTF_NODE) "\"meshes\":[{\"primitives\":[");
    for (int i = 0; i < 1000; i++)
        at += (size_t)snprintf(text + at, sizeof text - at, "{\"attributes\":{\"POSITION\":0}},");
    snprintf(text + at, sizeof text - at,
             "{\"attributes\":{}}]}],\"accessors\":[{\"componentType\":5126,\"count\":100000,\"type\":"
             "\"VEC3\"}]}");
    mesh_refuse(context, &messages, "a.gltf", text, strlen(text), EWA_ERROR_LIMIT,
                "more vertices and corners");
}

/// A short file over a large buffer beside it: how much it may hold goes by both.
CASE(test_large_buffer) {
    enum { PLACES = 3, CORNERS = 4500000, BYTES = 12 * PLACES + CORNERS };
    uint8_t *bytes = calloc(BYTES, 1);
    assert_non_null(bytes);
    const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    memcpy(bytes, triangle, sizeof triangle);
    for (int i = 0; i < CORNERS; i++) bytes[sizeof triangle + (size_t)i] = (uint8_t)(i % 3);
    char json[1024], path[512];
    scratch_write(scratch_path("large.bin", path), bytes, BYTES);
    free(bytes);
    snprintf(json, sizeof json,
             GLTF_HEAD(GLTF_NODE) "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},"
                                  "\"indices\":1}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
                                  "\"count\":3,\"type\":\"VEC3\"},{\"bufferView\":1,\"componentType\":5121,"
                                  "\"count\":%d,\"type\":\"SCALAR\"}],\"bufferViews\":[{\"buffer\":0,"
                                  "\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":%d}],"
                                  "\"buffers\":[{\"byteLength\":%d,\"uri\":\"large.bin\"}]}",
             CORNERS, CORNERS, BYTES);
    scratch_write(scratch_path("large.gltf", path), json, strlen(json));
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    assert_int_equal(ewa_mesh_load(context, path, &mesh), EWA_OK);
    assert_int_equal(mesh.triangle_count, CORNERS / 3);
}

/// What is looked at again and again costs little each time: empty primitives of a mesh that many nodes have,
/// and objects of more members than glTF has names for.
CASE(test_repetition) {
    static char text[1 << 17];
    size_t at = (size_t)snprintf(text, sizeof text, "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{}");
    for (int i = 0; i < 4000; i++) at += (size_t)snprintf(text + at, sizeof text - at, ",{\"mesh\":0}");
    at += (size_t)snprintf(text + at, sizeof text - at, "],\"meshes\":[{\"primitives\":[{}");
    for (int i = 0; i < 4000; i++) at += (size_t)snprintf(text + at, sizeof text - at, ",{}");
    snprintf(text + at, sizeof text - at, "]}]}");
    mesh_refuse(context, &messages, "a.gltf", text, strlen(text), EWA_ERROR_LIMIT,
                "more vertices and corners");
    for (int members = 100; members <= 200; members += 100) {
        at = (size_t)snprintf(text, sizeof text, GLTF_HEAD(GLTF_NODE) "\"materials\":[{");
        for (int i = 0; i < members; i++) at += (size_t)snprintf(text + at, sizeof text - at, "\"%d\":0,", i);
        snprintf(text + at, sizeof text - at,
                 "\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0]}}],\"meshes\":[{\"primitives\":[{"
                 "\"material\":0}]}]}");
        mesh_refuse(context, &messages, "a.gltf", text, strlen(text), EWA_ERROR_FORMAT,
                    members == 100 ? "its factor is no array of 4 numbers" : "neither faces nor points");
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
