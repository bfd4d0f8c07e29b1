// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Small GLB files for tests: JSON, the bytes of its buffer, and the container around both.
#ifndef EWA_TESTS_GLTF_CHECK_H
#define EWA_TESTS_GLTF_CHECK_H

#include "io/mesh_check.h"
/// A file under construction: JSON, and the bytes of its buffer.
typedef struct glb {
    char json[8192];
    uint8_t bytes[4096];
    size_t size;
} glb;

/// Appends floats to the buffer, from a multiple of four bytes on; returns where they begin.
static inline size_t put_floats(glb *g, int count, const float *values) {
    g->size = (g->size + 3) / 4 * 4;
    memcpy(g->bytes + g->size, values, (size_t)count * sizeof *values);
    g->size += (size_t)count * sizeof *values;
    return g->size - (size_t)count * sizeof *values;
}

static inline void put_u32(uint8_t *to, size_t value) {
    for (int i = 0; i < 4; i++) to[i] = (uint8_t)(value >> 8 * i);
}

/// The container's bytes in `file`; returns how many.
static inline size_t glb_bytes(const glb *g, uint8_t file[16384]) {
    const size_t json = (strlen(g->json) + 3) / 4 * 4, bin = (g->size + 3) / 4 * 4;
    memcpy(file, "glTF", 4);
    put_u32(file + 4, 2);
    put_u32(file + 8, 28 + json + bin);
    put_u32(file + 12, json);
    memcpy(file + 16, "JSON", 4);
    memset(file + 20, ' ', json);
    memcpy(file + 20, g->json, strlen(g->json));
    put_u32(file + 20 + json, bin);
    memcpy(file + 24 + json, "BIN\0", 4);
    memset(file + 28 + json, 0, bin);
    memcpy(file + 28 + json, g->bytes, g->size);
    return 28 + json + bin;
}

/// Loads a file that has to be a mesh, without a word unless `talks`.
static inline void glb_load(ewa_context *context, mesh_messages *messages, const glb *g, bool talks,
                            ewa_mesh *mesh) {
    uint8_t file[16384];
    const size_t size = glb_bytes(g, file);
    mesh_load_bytes(context, messages, "a", file, size, talks, mesh);
}

/// Loads a file that has to fail with a message that has `said` in it.
static inline void glb_refuse(ewa_context *context, mesh_messages *messages, const glb *g, ewa_status status,
                              const char *said) {
    uint8_t file[16384];
    const size_t size = glb_bytes(g, file);
    mesh_refuse(context, messages, "a.glb", file, size, status, said);
}

/// A rectangle of 2 x 3, as a fan.
static const float gltf_square[12] = {0, 0, 0, 2, 0, 0, 2, 3, 0, 0, 3, 0};

/// Beginnings and ends of JSON: one node in one scene; the view and the accessor of four positions.
#define GLTF_HEAD(nodes)                                                                                     \
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[" nodes "],"
#define GLTF_NODE      "{\"mesh\":0}"
#define GLTF_VIEW      "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48}],\"buffers\":[{\"byteLength\":48}]}"
#define GLTF_POSITIONS "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"}"

#endif
