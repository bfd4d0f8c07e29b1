// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the tests of mesh files share: a context whose messages are kept, meshes from text, their areas and
// colours.
#ifndef EWA_TESTS_MESH_CHECK_H
#define EWA_TESTS_MESH_CHECK_H

#include "io/scratch.h"

#include <math.h>

/// All messages of a context, one after the other.
typedef struct mesh_messages {
    char text[8192];
    int errors, warnings;
} mesh_messages;

static inline void mesh_keep(void *user, ewa_severity severity, const char *text) {
    mesh_messages *messages = user;
    const size_t length = strlen(messages->text);
    messages->errors += severity == EWA_SEVERITY_ERROR;
    messages->warnings += severity == EWA_SEVERITY_WARNING;
    snprintf(messages->text + length, sizeof messages->text - length, "%s\n", text);
}

static inline ewa_context *mesh_context(mesh_messages *messages) {
    WITH_DEFAULTS(ewa_context_options, options);
    options.thread_count = 1;
    options.message = mesh_keep;
    options.message_user = messages;
    *messages = (mesh_messages){.errors = 0};
    ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    return context;
}

static inline void mesh_says(const mesh_messages *messages, const char *text) {
    if (!strstr(messages->text, text)) fail_msg("'%s' is not in '%s'", text, messages->text);
}

/// Loads bytes that have to be a mesh, without a word unless `talks`.
static inline void mesh_load_bytes(ewa_context *context, mesh_messages *messages, const char *name,
                                   const void *bytes, size_t size_bytes, bool talks, ewa_mesh *mesh) {
    ewa_model model;
    *messages = (mesh_messages){.errors = 0};
    const ewa_status status =
        ewa_model_load_memory(context, bytes, size_bytes, name, NULL, EWA_MODEL_MESH, NULL, &model);
    if (status != EWA_OK || (!talks && messages->text[0]))
        fail_msg("%s: %d, %s", name, status, messages->text);
    assert_null(model.points);
    assert_true(model.mesh.triangle_count > 0 && model.face_count > 0);
    *mesh = model.mesh;
}

static inline void mesh_load_text(ewa_context *context, mesh_messages *messages, const char *name,
                                  const char *text, ewa_mesh *mesh) {
    mesh_load_bytes(context, messages, name, text, strlen(text), false, mesh);
}

/// Loads text that has to fail with a message that has `said` in it.
static inline void mesh_refuse(ewa_context *context, mesh_messages *messages, const char *name,
                               const void *bytes, size_t size_bytes, ewa_status status, const char *said) {
    ewa_model model;
    *messages = (mesh_messages){.errors = 0};
    const ewa_status got =
        ewa_model_load_memory(context, bytes, size_bytes, name, NULL, EWA_MODEL_MESH, NULL, &model);
    if (got != status) fail_msg("%s: %d, not %d: %s", name, got, status, messages->text);
    assert_true(messages->errors >= 1);
    assert_null(model.mesh.positions);
    assert_null(model.points);
    mesh_says(messages, said);
}

/// Area of a triangle, as a vector.
static inline void mesh_area_vector(const ewa_mesh *mesh, uint32_t triangle, double area[3]) {
    const double *p[3];
    for (uint32_t k = 0; k < 3; k++) {
        assert_true(mesh->triangles[3 * triangle + k] < mesh->vertex_count);
        p[k] = mesh->positions + 3 * (size_t)mesh->triangles[3 * triangle + k];
    }
    for (int c = 0; c < 3; c++) {
        const int d = (c + 1) % 3, e = (c + 2) % 3;
        area[c] =
            0.5 * ((p[1][d] - p[0][d]) * (p[2][e] - p[0][e]) - (p[1][e] - p[0][e]) * (p[2][d] - p[0][d]));
    }
}

/// Sum of all areas; `sum` (may be NULL) gets that of the vectors.
static inline double mesh_area(const ewa_mesh *mesh, double sum[3]) {
    double total = 0, one[3];
    for (int c = 0; sum && c < 3; c++) sum[c] = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        mesh_area_vector(mesh, t, one);
        total += sqrt(one[0] * one[0] + one[1] * one[1] + one[2] * one[2]);
        for (int c = 0; sum && c < 3; c++) sum[c] += one[c];
    }
    return total;
}

/// The corner of a triangle at a place, or a failure.
static inline uint32_t mesh_corner(const ewa_mesh *mesh, uint32_t triangle, double x, double y, double z) {
    for (uint32_t k = 0; k < 3; k++) {
        const uint32_t vertex = mesh->triangles[3 * triangle + k];
        const double *p = mesh->positions + 3 * (size_t)vertex;
        if (p[0] == x && p[1] == y && p[2] == z) return vertex;
    }
    fail_msg("triangle %u has no corner at %g %g %g", triangle, x, y, z);
    return 0;
}

/// Writes a picture of one sRGB colour, 2 x 2 pixels, into the scratch folder.
static inline void mesh_picture(ewa_context *context, const char *name, int red, int green, int blue) {
    char path[512];
    uint8_t pixels[12];
    for (int i = 0; i < 4; i++)
        pixels[3 * i] = (uint8_t)red, pixels[3 * i + 1] = (uint8_t)green, pixels[3 * i + 2] = (uint8_t)blue;
    assert_int_equal(ewa_png_save(context, scratch_path(name, path), 2, 2, 3, pixels, 6), EWA_OK);
}

static inline const ewa_mesh_material *mesh_material(const ewa_mesh *mesh, uint32_t triangle) {
    assert_true(triangle < mesh->triangle_count && mesh->triangle_materials[triangle] < mesh->material_count);
    return &mesh->materials[mesh->triangle_materials[triangle]];
}

/// The picture of a triangle, or NULL.
static inline const ewa_image *mesh_texture(const ewa_mesh *mesh, uint32_t triangle) {
    const ewa_image *texture = &mesh->textures[mesh_material(mesh, triangle)->texture];
    return texture->pixels ? texture : NULL;
}

#endif
