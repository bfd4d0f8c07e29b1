// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Meshes from files: each format, nodes, materials and pictures, what is missing or broken.
#include "scratch.h"

#include <math.h>

static void put(const char *name, const char *text, char path[512]) {
    scratch_write(scratch_path(name, path), text, strlen(text));
}

static double area_of(const ewa_mesh *mesh) {
    double sum = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        double p[3][3], n2 = 0;
        for (int k = 0; k < 3; k++) {
            assert_true(mesh->triangles[3 * t + (uint32_t)k] < mesh->vertex_count);
            for (uint32_t c = 0; c < 3; c++)
                p[k][c] = (double)mesh->positions[3 * mesh->triangles[3 * t + (uint32_t)k] + c];
        }
        for (int c = 0; c < 3; c++) {
            const int d = (c + 1) % 3, e = (c + 2) % 3;
            n2 +=
                pow((p[1][d] - p[0][d]) * (p[2][e] - p[0][e]) - (p[1][e] - p[0][e]) * (p[2][d] - p[0][d]), 2);
        }
        sum += sqrt(n2) / 2;
    }
    return sum;
}

#define SQUARE_PLY                                                                                           \
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"        \
    "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"                        \
    "property list uchar int vertex_indices\nend_header\n"                                                   \
    "0 0 0 255 0 0\n2 0 0 255 0 0\n2 3 0 255 188 0\n0 3 0 255 0 0\n4 0 1 2 3\n"

#define SQUARE_STL                                                                                           \
    "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 0 0\nvertex 2 3 0\nendloop\nendfacet\n" \
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 3 0\nvertex 0 3 0\nendloop\nendfacet\nendsolid " \
    "s\n"

/// A triangle of area 1/2 in a node that doubles it and mirrors x.
#define TRIANGLE_GLTF                                                                                        \
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"                             \
    "\"nodes\":[{\"mesh\":0,\"scale\":[-2,2,2]}],"                                                           \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]}],"                      \
    "\"materials\":[{\"name\":\"m\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.25,1,1]}}],"        \
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","                 \
    "\"min\":[0,0,0],\"max\":[1,1,0]}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"                  \
    "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"                        \
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}"

static void test_formats(void **state) {
    (void)state;
    check_log log = {0};
    ewa_context *context = check_context(0, &log);
    ewa_mesh mesh;
    char path[512];
    put("mesh.ply", SQUARE_PLY, path);
    assert_int_equal(ewa_mesh_load(context, path, &mesh), EWA_OK);
    assert_int_equal(mesh.triangle_count, 2);
    assert_float_equal(area_of(&mesh), 6, 1e-6);
    assert_non_null(mesh.colors);
    float most = 0;
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        assert_float_equal(mesh.colors[4 * v], 1, 1e-6);
        most = fmaxf(most, mesh.colors[4 * v + 1]);
    }
    assert_float_equal(most, ewa_linear_from_srgb(188 / 255.0f), 1e-4);
    ewa_mesh_free(&mesh);
    put("mesh.stl", SQUARE_STL, path);
    assert_int_equal(ewa_mesh_load(context, path, &mesh), EWA_OK);
    assert_float_equal(area_of(&mesh), 6, 1e-6);
    ewa_mesh_free(&mesh);
    put("mesh.gltf", TRIANGLE_GLTF, path);
    assert_int_equal(ewa_mesh_load(context, path, &mesh), EWA_OK);
    assert_float_equal(area_of(&mesh), 2, 1e-6);
    assert_int_equal(mesh.material_count >= 1, 1);
    const float *color = mesh.materials[mesh.triangle_materials[0]].base_color;
    assert_float_equal(color[0], 0.5, 1e-6);
    assert_float_equal(color[1], 0.25, 1e-6);
    // Mirrored, the triangle still faces +z.
    const uint32_t *t = mesh.triangles;
    const float *a = mesh.positions + 3 * t[0], *b = mesh.positions + 3 * t[1],
                *c = mesh.positions + 3 * t[2];
    assert_true((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0);
    ewa_mesh_free(&mesh);
    assert_int_equal(log.count, 0);
    ewa_context_destroy(&context);
}

#define TEXTURED_OBJ(mtl)                                                                                    \
    "mtllib " mtl "\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"

static void test_pictures(void **state) {
    (void)state;
    check_log log = {0};
    ewa_context *context = check_context(0, &log);
    ewa_mesh mesh;
    char path[512], png[512];
    const uint8_t red[12] = {255, 0, 0, 255, 0, 0, 255, 0, 0, 255, 0, 0};
    assert_int_equal(ewa_png_save(context, scratch_path("mesh_red.png", png), 2, 2, 3, red, 6), EWA_OK);
    put("mesh_red.mtl", "newmtl m\nKd 0.5 0.5 0.5\nmap_Kd mesh_red.png\n", path);
    put("mesh_red.obj", TEXTURED_OBJ("mesh_red.mtl"), path);
    assert_int_equal(ewa_mesh_load(context, path, &mesh), EWA_OK);
    const ewa_mesh_material *material = &mesh.materials[mesh.triangle_materials[0]];
    assert_int_equal(material->texture.width_px, 2);
    assert_true(material->texture.pixels[0] == 1 && material->texture.pixels[1] == 0);
    assert_true(material->base_color[0] == 1); // the picture stands for Kd
    assert_int_equal(log.count, 0);
    ewa_mesh_free(&mesh);
    // Missing, out of the folder, no picture: the mesh comes without, and a warning names the file.
    static const char *const names[] = {"mesh_none.png", "/etc/hostname", "../../../../etc/hostname",
                                        "mesh_red.obj", "/dev/zero"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        char text[128];
        snprintf(text, sizeof text, "newmtl m\nKd 0 1 0\nmap_Kd %s\n", names[i]);
        put("mesh_red.mtl", text, path);
        put("mesh_red.obj", TEXTURED_OBJ("mesh_red.mtl"), path);
        log.count = 0;
        assert_int_equal(ewa_mesh_load(context, path, &mesh), EWA_OK);
        material = &mesh.materials[mesh.triangle_materials[0]];
        assert_null(material->texture.pixels);
        assert_true(material->base_color[1] == 1);
        assert_true(log.count > 0 && strstr(log.text, names[i]));
        ewa_mesh_free(&mesh);
    }
    ewa_context_destroy(&context);
}

static void refuse(ewa_context *context, const check_log *log, const char *path, ewa_status status,
                   const char *text) {
    ewa_mesh mesh;
    assert_int_equal(ewa_mesh_load(context, path, &mesh), status);
    assert_null(mesh.positions);
    if (!strstr(log->text, text)) fail_msg("'%s' is not in '%s'", text, log->text);
}

static void test_refusals(void **state) {
    (void)state;
    check_log log = {0};
    ewa_context *context = check_context(0, &log);
    char path[512];
    refuse(context, &log, scratch_path("mesh.xyz", path), EWA_ERROR_UNSUPPORTED, ".obj .ply .stl .gltf .glb");
    refuse(context, &log, scratch_path("mesh_absent.obj", path), EWA_ERROR_IO, "mesh_absent.obj");
    put("mesh_bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", path);
    refuse(context, &log, path, EWA_ERROR_FORMAT, "no triangles");
    put("mesh_bad.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n",
        path);
    refuse(context, &log, path, EWA_ERROR_FORMAT, "vertex 9, there are 3");
    put("mesh_bad.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty real x\nend_header\n", path);
    refuse(context, &log, path, EWA_ERROR_FORMAT, "unknown type");
    ewa_context_destroy(&context);
}

/// Every file that is cut short is a mesh or a clear failure.
static void test_truncations(void **state) {
    (void)state;
    static const struct {
        const char *name, *text;
    } files[] = {{"mesh_cut.obj", TEXTURED_OBJ("no.mtl")},
                 {"mesh_cut.ply", SQUARE_PLY},
                 {"mesh_cut.stl", SQUARE_STL},
                 {"mesh_cut.gltf", TRIANGLE_GLTF}};
    check_log log = {0};
    ewa_context *context = check_context(0, &log);
    for (size_t f = 0; f < sizeof files / sizeof files[0]; f++) {
        for (size_t size = 0; size < strlen(files[f].text); size += 7) {
            char path[512];
            ewa_mesh mesh;
            scratch_write(scratch_path(files[f].name, path), files[f].text, size);
            log.count = 0;
            const ewa_status status = ewa_mesh_load(context, path, &mesh);
            if (status == EWA_OK) {
                assert_true(area_of(&mesh) >= 0);
                ewa_mesh_free(&mesh);
            } else {
                assert_true(log.count > 0);
                assert_null(mesh.positions);
            }
        }
    }
    ewa_context_destroy(&context);
}

#if defined(__SANITIZE_ADDRESS__)
/// Assimp's reader of glTF leaks what it had read of files that end too early.
__attribute__((visibility("default"))) const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) { return "leak:libassimp.so\n"; }
#endif

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_formats),
        cmocka_unit_test(test_pictures),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_truncations),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
