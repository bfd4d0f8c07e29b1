// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the triangles of a file are, for ewa info.
#include "cli/info/info_mesh.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

static double area_of(const ewa_mesh *mesh, uint32_t triangle) {
    const uint32_t *v = mesh->triangles + 3 * (size_t)triangle;
    double e[2][3], squared = 0;
    for (int k = 0; k < 2; k++)
        for (int c = 0; c < 3; c++)
            e[k][c] = mesh->positions[3 * (size_t)v[k + 1] + (size_t)c] -
                      mesh->positions[3 * (size_t)v[0] + (size_t)c];
    for (int c = 0; c < 3; c++) {
        const int d = (c + 1) % 3, f = (c + 2) % 3;
        const double n = e[0][d] * e[1][f] - e[0][f] * e[1][d];
        squared += n * n;
    }
    return 0.5 * sqrt(squared);
}

bool info_mesh_gather(cli_session *session, const ewa_model *model, mesh_facts *facts) {
    const ewa_mesh *mesh = &model->mesh;
    *facts = (mesh_facts){.face_count = model->face_count,
                          .vertex_count = mesh->vertex_count,
                          .triangle_count = mesh->triangle_count,
                          .material_count = mesh->material_count,
                          .colors = mesh->colors != NULL,
                          .texcoords = mesh->texcoords != NULL,
                          .normals = mesh->normals != NULL};
    for (uint32_t m = 0; m < mesh->material_count; m++)
        facts->picture_count += mesh->textures[m].pixels != NULL;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const double area = area_of(mesh, t);
        if (area > 0 && isfinite(area))
            facts->area_world += area;
        else
            facts->flat_count++;
    }
    return session_passed(session, ewa_mesh_is_closed(mesh, &facts->closed));
}

void info_mesh_print(const mesh_facts *facts) {
    printf("  mesh        %" PRIu64 " faces, %u triangles, %s\n", facts->face_count, facts->triangle_count,
           facts->closed ? "closed" : "open");
    printf("  area        %.6g\n", facts->area_world);
    printf("  of corners  place%s%s%s: %u different\n", facts->texcoords ? ", texture coordinates" : "",
           facts->normals ? ", normal" : "", facts->colors ? ", colour" : "", facts->vertex_count);
    printf("  materials   %u, %u pictures\n", facts->material_count, facts->picture_count);
    if (facts->flat_count) printf("  flat        %u triangles without an area\n", facts->flat_count);
}

void info_mesh_write(json_writer *json, const mesh_facts *facts) {
    json_object(json, "mesh");
    json_count(json, "faces", facts->face_count);
    json_count(json, "triangles", facts->triangle_count);
    json_count(json, "vertices", facts->vertex_count);
    json_count(json, "materials", facts->material_count);
    json_count(json, "pictures", facts->picture_count);
    json_count(json, "flat_triangles", facts->flat_count);
    json_number(json, "area", facts->area_world);
    json_flag(json, "closed", facts->closed);
    json_flag(json, "colors", facts->colors);
    json_flag(json, "texcoords", facts->texcoords);
    json_flag(json, "normals", facts->normals);
    json_close(json, '}');
}
