// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Meshes in memory: streams, limits, welding, and which meshes are closed.
#include "check.h"
#include "cloud/mesh.h"
#include "prepare/mesh_shapes.h"

TEST_LOGGED(test_streams, 1) {
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    assert_int_equal(
        ewa_mesh_create(context, 5, 3, 2, EWA_MESH_COLORS | EWA_MESH_TEXCOORDS | EWA_MESH_NORMALS, &mesh),
        EWA_OK);
    for (int i = 0; i < 15; i++) assert_true(mesh.positions[i] == 0 && mesh.normals[i] == 0);
    for (uint32_t m = 0; m < 2; m++) assert_true(mesh.materials[m].texture == m && !mesh.textures[m].pixels);
    // A picture in place of all materials; the old pictures go.
    ewa_image picture;
    assert_int_equal(ewa_image_create(context, 2, 2, 3, &mesh.textures[1]), EWA_OK);
    assert_int_equal(ewa_image_create(context, 4, 4, 3, &picture), EWA_OK);
    assert_int_equal(ewa_mesh_set_picture(&mesh, &picture), EWA_OK);
    assert_true(!picture.pixels && !mesh.colors && mesh.material_count == 1 &&
                mesh.textures[0].width_px == 4);
    assert_true(mesh.materials[0].texture == 0 && mesh.triangle_materials[2] == 0);
    ewa_mesh_free(&mesh);
    assert_null(mesh.positions);
    ewa_mesh_free(&mesh);
    ewa_mesh_free(NULL);
    assert_int_equal(ewa_mesh_create(context, 1, 1, 0, 0, &mesh), EWA_OK);
    assert_true(!mesh.normals && !mesh.colors && !mesh.texcoords && !mesh.materials && !mesh.textures);
}

TEST_ON(test_weld, 1) {
    const double places[][3] = {{1, 2, 3},
                                {0, 0, 0},
                                {1, 2, 3},
                                {-0.0, 0, -0.0},
                                {NAN, 0, 0},
                                {NAN, 0, 0},
                                {1, 2, 3 + 1e-15 * 4},
                                {0, 0, 1},
                                {0, 1, 0},
                                {INFINITY, 0, 0},
                                {INFINITY, 0, 0}};
    static const uint32_t wanted[] = {0, 1, 0, 1, 4, 4, 6, 7, 8, 9, 9};
    uint32_t weld[11];
    assert_int_equal(ewa_mesh_weld(context, &places[0][0], 11, weld), EWA_OK);
    assert_memory_equal(weld, wanted, sizeof wanted);
    // Many places, each three times, in another order.
    enum { MANY = 3000 };
    double(*many)[3] = malloc(3 * MANY * sizeof *many);
    OWNED(check_free) uint32_t *numbers = malloc(3 * MANY * sizeof *numbers);
    for (uint32_t i = 0; i < 3 * MANY; i++) {
        const uint32_t k = i * 7919u % MANY;
        many[i][0] = k % 13, many[i][1] = k / 13 % 17, many[i][2] = k / 221;
    }
    assert_int_equal(ewa_mesh_weld(context, many[0], 3 * MANY, numbers), EWA_OK);
    for (uint32_t i = 0; i < 3 * MANY; i++) assert_int_equal(numbers[i], i % MANY);
    free(many);
}

static bool is_closed(const ewa_mesh *mesh) {
    bool closed;
    assert_int_equal(ewa_mesh_is_closed(mesh, &closed), EWA_OK);
    return closed;
}

TEST_LOGGED(test_closed, 1) {
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    shape_cube(context, &mesh);
    assert_true(is_closed(&mesh));
    mesh.triangle_count--; // a hole
    assert_false(is_closed(&mesh));
    mesh.triangle_count++;
    for (uint32_t t = 0; t < 12; t++) { // one triangle turned
        uint32_t *v = mesh.triangles + 3 * t, kept = v[1];
        v[1] = v[2], v[2] = kept;
        assert_false(is_closed(&mesh));
        kept = v[1], v[1] = v[2], v[2] = kept;
    }
    uint32_t kept[36];
    memcpy(kept, mesh.triangles, sizeof kept);
    for (uint32_t t = 0; t < 12; t++) // all turned: inside out, but closed
        for (uint32_t c = 0; c < 3; c++) mesh.triangles[3 * t + c] = kept[3 * t + 2 - c];
    assert_true(is_closed(&mesh));
    memcpy(mesh.triangles, kept, sizeof kept);
    memset(mesh.triangles + 33, 0, 3 * sizeof(uint32_t)); // a triangle that is a point leaves a hole
    assert_false(is_closed(&mesh));
    memcpy(mesh.triangles, kept, sizeof kept);
    mesh.positions[3] = NAN;
    assert_false(is_closed(&mesh));
    mesh.positions[3] = 1;
    mesh.positions[3] = 7; // moved, still closed
    assert_true(is_closed(&mesh));
    mesh.triangles[5] = 8;
    bool closed;
    assert_int_equal(ewa_mesh_is_closed(&mesh, &closed), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "triangle 1 has vertex 8, there are 8"));
    ewa_mesh_free(&mesh);

    shape_sphere(context, 16, &mesh); // its poles and its seam have many vertices at one place
    assert_true(is_closed(&mesh));
    mesh.triangle_count /= 2;
    assert_false(is_closed(&mesh));
    mesh.triangle_count *= 2;
    ewa_mesh_free(&mesh);

    // Every triangle with vertices of its own, far from the origin.
    ewa_mesh cube;
    shape_cube(context, &cube);
    assert_int_equal(ewa_mesh_create(context, 36, 12, 0, 0, &mesh), EWA_OK);
    for (uint32_t i = 0; i < 36; i++) {
        mesh.triangles[i] = i;
        for (uint32_t c = 0; c < 3; c++)
            mesh.positions[3 * i + c] = cube.positions[3 * cube.triangles[i] + c] + 4200000.1;
    }
    assert_true(is_closed(&mesh));
    mesh.positions[0] += 1e-9;
    assert_false(is_closed(&mesh));
    ewa_mesh_free(&mesh);

    // Two cubes that share an edge: four triangles on it. Two that share a corner: closed.
    for (int shared = 1; shared <= 2; shared++) {
        assert_int_equal(ewa_mesh_create(context, 16, 24, 0, 0, &mesh), EWA_OK);
        for (uint32_t i = 0; i < 72; i++) mesh.triangles[i] = cube.triangles[i % 36] + i / 36 * 8;
        for (uint32_t i = 0; i < 48; i++)
            mesh.positions[i] = cube.positions[i % 24] + (i >= 24 && (i % 3 != 2 || shared == 1) ? 2 : 0);
        assert_int_equal(is_closed(&mesh), shared == 1);
        ewa_mesh_free(&mesh);
    }
    ewa_mesh_free(&cube);
    assert_int_equal(ewa_mesh_create(context, 3, 0, 0, 0, &mesh), EWA_OK);
    assert_false(is_closed(&mesh));
}

int main(void) { return RUN_TESTS(NULL, NULL); }
