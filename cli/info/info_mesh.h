// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the triangles of a file are, for ewa info.
#ifndef EWA_CLI_INFO_INFO_MESH_H
#define EWA_CLI_INFO_INFO_MESH_H

#include "cli/base/json.h"

typedef struct mesh_facts {
    uint64_t face_count;
    uint32_t vertex_count, triangle_count, material_count, picture_count;
    uint32_t flat_count; ///< triangles without an area or with coordinates that are not finite
    double area_world;
    bool closed, colors, texcoords, normals;
} mesh_facts;

/// Measures a mesh; false after reporting.
bool info_mesh_gather(cli_session *session, const ewa_model *model, mesh_facts *facts);

/// Prints them as lines of text, or as the member "mesh" of an object.
void info_mesh_print(const mesh_facts *facts);
void info_mesh_write(json_writer *json, const mesh_facts *facts);

#endif
