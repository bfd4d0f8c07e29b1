// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From what a reader filled to a mesh with one number per corner: corners that agree in place, texture
// coordinates, normal, colour and cell become one vertex. And what was left out is said.
#include "base/base.h"
#include "io/mesh/build.h"

#include <math.h>
#include <stdio.h>

/// Coordinates as floats are too coarse when a step of them is more than this share of the mean edge.
#define COARSE_SHARE 0.05

/// What tells vertices apart.
typedef struct vertex_key {
    uint32_t position, texcoord, normal;
    uint32_t look;  ///< whose map the texture coordinates go through, or none
    uint32_t color; ///< a triangle with the vertex's colour, or none
    uint32_t cell;  ///< with the vertex's numbers, or none
} vertex_key;

typedef struct finish_job {
    ewa_mesh_build *build;
    vertex_key *vertices;
    uint32_t vertex_count, vertex_capacity;
    uint32_t *table; ///< hash table of vertices
    size_t slots;
    uint32_t *triangles; ///< 3 vertices each
} finish_job;

static uint32_t corner_of(const ewa_mesh_list *list, uint64_t triangle, uint32_t corner, uint64_t limit) {
    if (triangle >= list->count) return EWA_MESH_NONE;
    const uint32_t number = ((const uint32_t *)list->items)[3 * triangle + corner];
    return number < limit ? number : EWA_MESH_NONE;
}

static uint32_t look_of(const ewa_mesh_build *build, uint64_t triangle) {
    return triangle < build->face_looks.count ? ((const uint32_t *)build->face_looks.items)[triangle]
                                              : EWA_MESH_NONE;
}

static vertex_key key_of(const ewa_mesh_build *build, uint64_t triangle, uint32_t corner) {
    vertex_key key = {.position = ((const uint32_t *)build->corners.items)[3 * triangle + corner],
                      .texcoord =
                          corner_of(&build->texcoord_corners, triangle, corner, build->texcoords.count),
                      .normal = corner_of(&build->normal_corners, triangle, corner, build->normals.count),
                      .look = EWA_MESH_NONE,
                      .color = triangle < build->face_colors.count ? (uint32_t)triangle : EWA_MESH_NONE,
                      .cell = EWA_MESH_NONE};
    if (triangle < build->face_cells.count) key.cell = ((const uint32_t *)build->face_cells.items)[triangle];
    const uint32_t look = look_of(build, triangle);
    if (look != EWA_MESH_NONE && key.texcoord != EWA_MESH_NONE &&
        ((const ewa_mesh_look *)build->looks.items)[look].mapped)
        key.look = look;
    return key;
}

static const float *face_color(const ewa_mesh_build *build, uint32_t triangle) {
    return (const float *)build->face_colors.items + 4 * (size_t)triangle;
}

static uint64_t mix(uint64_t hash, uint64_t bits) {
    hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
    return hash ^ hash >> 29;
}

static uint64_t hash_of(const ewa_mesh_build *build, const vertex_key *key) {
    uint64_t hash = mix(mix(mix(0, key->position), (uint64_t)key->texcoord << 32 | key->normal), (uint64_t)key->cell << 32 | key->look);
    if (key->color == EWA_MESH_NONE) return hash;
    uint64_t bits[2];
    memcpy(bits, face_color(build, key->color), sizeof bits);
    return mix(mix(hash, bits[0]), bits[1]);
}

static bool same_vertex(const ewa_mesh_build *build, const vertex_key *a, const vertex_key *b) {
    if (a->position != b->position || a->texcoord != b->texcoord || a->normal != b->normal ||
        a->look != b->look || a->cell != b->cell)
        return false;
    if (a->color == EWA_MESH_NONE || b->color == EWA_MESH_NONE) return a->color == b->color;
    return memcmp(face_color(build, a->color), face_color(build, b->color), 4 * sizeof(float)) == 0;
}

/// Gives every corner of every triangle a vertex.
static void unify(finish_job *job) {
    const ewa_mesh_build *build = job->build;
    memset(job->table, 0xff, job->slots * sizeof *job->table);
    for (uint64_t i = 0; i < 3 * build->corners.count; i++) {
        const vertex_key key = key_of(build, i / 3, (uint32_t)(i % 3));
        size_t slot = hash_of(build, &key) & (job->slots - 1);
        while (job->table[slot] != EWA_MESH_NONE &&
               !same_vertex(build, &job->vertices[job->table[slot]], &key))
            slot = (slot + 1) & (job->slots - 1);
        if (job->table[slot] == EWA_MESH_NONE) {
            job->table[slot] = job->vertex_count;
            job->vertices[job->vertex_count++] = key;
        }
        job->triangles[i] = job->table[slot];
    }
}

void ewa_mesh_map_texcoord(const ewa_mesh_look *look, float uv[2]) {
    const double u = (double)uv[0], v = (double)uv[1];
    for (int c = 0; c < 2 && look->mapped; c++)
        uv[c] = (float)(look->map[c][0] * u + look->map[c][1] * v + look->map[c][2]);
}

static void fill_vertex(const ewa_mesh_build *build, const vertex_key *key, uint32_t vertex, ewa_mesh *mesh) {
    static const float white[4] = {1, 1, 1, 1};
    memcpy(mesh->positions + 3 * (size_t)vertex,
           (const double *)build->positions.items + 3 * (size_t)key->position, 3 * sizeof(double));
    if (mesh->colors) {
        const float *color = key->color != EWA_MESH_NONE ? face_color(build, key->color)
                             : key->position < build->colors.count
                                 ? (const float *)build->colors.items + 4 * (size_t)key->position
                                 : white;
        memcpy(mesh->colors + 4 * (size_t)vertex, color, 4 * sizeof *color);
    }
    if (mesh->normals && key->normal != EWA_MESH_NONE)
        memcpy(mesh->normals + 3 * (size_t)vertex,
               (const float *)build->normals.items + 3 * (size_t)key->normal, 3 * sizeof(float));
    if (!mesh->texcoords || key->texcoord == EWA_MESH_NONE) return;
    const float *uv = (const float *)build->texcoords.items + 2 * (size_t)key->texcoord;
    float *to = mesh->texcoords + 2 * (size_t)vertex;
    memcpy(to, uv, 2 * sizeof *uv);
    if (key->look != EWA_MESH_NONE)
        ewa_mesh_map_texcoord((const ewa_mesh_look *)build->looks.items + key->look, to);
}

static bool is_plain(const ewa_mesh_look *look) {
    return look->picture == EWA_MESH_NONE && look->base_color[0] == 1 && look->base_color[1] == 1 &&
           look->base_color[2] == 1 && look->base_color[3] == 1;
}

/// How many materials the mesh gets: none when all looks are white. Triangles without a look have the last.
static uint32_t count_materials(const ewa_mesh_build *build) {
    bool plain = true, missing = build->face_looks.count < build->corners.count;
    for (uint64_t i = 0; i < build->looks.count; i++)
        plain = plain && is_plain((const ewa_mesh_look *)build->looks.items + i);
    for (uint64_t t = 0; t < build->face_looks.count && !missing; t++)
        missing = look_of(build, t) == EWA_MESH_NONE;
    return plain ? 0 : (uint32_t)build->looks.count + missing;
}

/// Hands looks and pictures over.
static void fill_materials(ewa_mesh_build *build, ewa_mesh *mesh) {
    const ewa_mesh_look *looks = build->looks.items;
    ewa_mesh_picture *pictures = build->pictures.items;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t look = look_of(build, t);
        mesh->triangle_materials[t] = look == EWA_MESH_NONE ? mesh->material_count - 1 : look;
    }
    for (uint32_t m = 0; m < mesh->material_count; m++) {
        const bool known = m < build->looks.count;
        for (int c = 0; c < 4; c++) mesh->materials[m].base_color[c] = known ? looks[m].base_color[c] : 1;
        if (!known || looks[m].picture == EWA_MESH_NONE) continue;
        // The first material with a picture holds it.
        uint32_t first = 0;
        while (looks[first].picture != looks[m].picture) first++;
        mesh->materials[m].texture = first;
        if (first != m) continue;
        mesh->textures[m] = pictures[looks[m].picture].image;
        pictures[looks[m].picture].image = (ewa_image){0};
    }
}

/// Triangles with places that are not finite; nothing is made of them.
static uint32_t count_not_finite(const ewa_mesh *mesh) {
    uint32_t count = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        bool finite = true;
        for (uint32_t c = 0; c < 3; c++) {
            const double *p = mesh->positions + 3 * (size_t)mesh->triangles[3 * (size_t)t + c];
            finite = finite && isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
        }
        count += !finite;
    }
    return count;
}

/// Warns when the places come from floats and those are too far apart for the mesh.
static void check_steps(const ewa_mesh_build *build, const ewa_mesh *mesh) {
    double largest = 0, sum = 0;
    for (uint32_t t = 0; t < mesh->triangle_count && build->float_positions; t++) {
        const uint32_t *v = mesh->triangles + 3 * (size_t)t;
        for (int c = 0; c < 3; c++) {
            const double *a = mesh->positions + 3 * (size_t)v[c],
                         *b = mesh->positions + 3 * (size_t)v[(c + 1) % 3];
            double squared = 0;
            for (int k = 0; k < 3; k++) {
                largest = fmax(largest, fabs(a[k]));
                squared += (a[k] - b[k]) * (a[k] - b[k]);
            }
            sum += sqrt(squared);
        }
    }
    const double edge = mesh->triangle_count ? sum / 3 / mesh->triangle_count : 0;
    if (!isfinite(largest + edge)) return; // something else has been said
    int exponent;
    frexp(largest, &exponent);
    const double step = ldexp(1, exponent - 24);
    if (largest > 0 && step > COARSE_SHARE * edge)
        ewa_report(
            build->context, EWA_SEVERITY_WARNING,
            "%s: coordinates up to %.7g are floats, in steps of %.3g, for edges of %.3g: the surface is "
            "coarse; doubles, or an origin near the mesh, keep it",
            build->source->name, largest, step, edge);
}

static size_t append(char *text, size_t room, size_t at, uint64_t count, const char *what) {
    if (!count || at >= room) return at;
    return at + (size_t)snprintf(text + at, room - at, "%s%llu %s", at ? ", " : "", (unsigned long long)count,
                                 what);
}

/// Says what of the file is not in the mesh.
static void say_losses(const ewa_mesh_build *build, bool is_mesh, uint64_t not_finite) {
    char text[400] = "";
    size_t at = append(text, sizeof text, 0, build->beyond_count, "faces with a vertex that is not there");
    at = append(text, sizeof text, at, build->short_count, "faces of fewer than three corners");
    at = append(text, sizeof text, at, not_finite, "triangles with a coordinate that is not finite");
    if (at)
        ewa_report(build->context, EWA_SEVERITY_WARNING, "%s: left out of %llu faces: %s",
                   build->source->name, (unsigned long long)build->face_count, text);
    at = append(text, sizeof text, 0, build->line_count, "lines");
    if (append(text, sizeof text, at, is_mesh ? build->point_count : 0, "points"))
        ewa_report(build->context, EWA_SEVERITY_WARNING, "%s: %s beside the %s are left out",
                   build->source->name, text, is_mesh ? "faces" : "points");
    if (build->unread_count)
        ewa_report(build->context, EWA_SEVERITY_WARNING,
                   "%s: line %llu: not a number; %llu in the file, whose vertices do not count",
                   build->source->name, (unsigned long long)build->unread_line,
                   (unsigned long long)build->unread_count);
    if (build->uncut_count)
        ewa_report(build->context, EWA_SEVERITY_WARNING,
                   "%s: %llu polygons meet themselves or are too large; their triangles may overlap",
                   build->source->name, (unsigned long long)build->uncut_count);
    if (build->odd_color_count)
        ewa_report(build->context, EWA_SEVERITY_WARNING, "%s: %llu colours are not finite and count as white",
                   build->source->name, (unsigned long long)build->odd_color_count);
    if (build->missing_count > 1)
        ewa_report(build->context, EWA_SEVERITY_WARNING, "%s: %llu pictures are left out in all",
                   build->source->name, (unsigned long long)build->missing_count);
}

/// Makes vertices that corners share; without texture coordinates, normals and colours of faces they are the
/// places of the file.
static ewa_status make_vertices(finish_job *job, bool *same) {
    const ewa_mesh_build *build = job->build;
    const uint64_t triangles = build->corners.count;
    *same = !build->texcoord_corners.count && !build->normal_corners.count && !build->face_colors.count &&
            !build->face_cells.count;
    if (*same) return EWA_OK;
    job->slots = 16;
    while (job->slots < 6 * triangles) job->slots *= 2;
    const uint64_t bytes =
        3 * triangles * (sizeof *job->vertices + sizeof *job->triangles) + job->slots * sizeof *job->table;
    if (3 * triangles >= EWA_MESH_NONE)
        return ewa_fail(build->context, EWA_ERROR_LIMIT, "%s: %llu triangles, over %u", build->source->name,
                        (unsigned long long)triangles, EWA_MESH_NONE / 3);
    EWA_TRY(ewa_memory_check(build->context, bytes, "%s: %llu triangles", build->source->name, (unsigned long long)triangles));
    job->vertex_capacity = (uint32_t)(3 * triangles);
    job->vertices = ewa_allocate(build->context, job->vertex_capacity, sizeof *job->vertices);
    job->triangles = ewa_allocate(build->context, job->vertex_capacity, sizeof *job->triangles);
    job->table = ewa_allocate(build->context, job->slots, sizeof *job->table);
    if (!job->vertices || !job->triangles || !job->table) return EWA_ERROR_MEMORY;
    unify(job);
    return EWA_OK;
}

static ewa_status fill_mesh(finish_job *job, bool same, ewa_mesh *mesh) {
    ewa_mesh_build *build = job->build;
    const uint32_t vertex_count = same ? (uint32_t)build->positions.count : job->vertex_count,
                   triangle_count = (uint32_t)build->corners.count, material_count = count_materials(build);
    const uint32_t streams =
        (build->colors.count || build->face_colors.count ? EWA_MESH_COLORS : 0u) |
        (build->texcoord_corners.count && build->texcoords.count ? EWA_MESH_TEXCOORDS : 0u) |
        (build->normal_corners.count && build->normals.count ? EWA_MESH_NORMALS : 0u);
    EWA_TRY(ewa_mesh_create(build->context, vertex_count, triangle_count, material_count, streams, mesh));
    for (uint32_t v = 0; v < vertex_count; v++) {
        const vertex_key key =
            same ? (vertex_key){v, EWA_MESH_NONE, EWA_MESH_NONE, EWA_MESH_NONE, EWA_MESH_NONE, EWA_MESH_NONE}
                 : job->vertices[v];
        fill_vertex(build, &key, v, mesh);
    }
    memcpy(mesh->triangles, same ? build->corners.items : job->triangles,
           3 * (size_t)triangle_count * sizeof(uint32_t));
    if (material_count) fill_materials(build, mesh);
    if (!build->arrays.count) return EWA_OK;
    EWA_TRY(ewa_cloud_create(build->context, vertex_count, &mesh->attributes));
    return ewa_mesh_fill_arrays(build, same ? NULL : &job->vertices->position, same ? NULL : &job->vertices->cell,
                                sizeof(vertex_key) / sizeof(uint32_t), mesh->attributes);
}

ewa_status ewa_mesh_build_mesh(ewa_mesh_build *build, ewa_mesh *mesh) {
    *mesh = (ewa_mesh){0};
    ewa_context *context = build->context;
    if (!build->corners.count) {
        say_losses(build, true, 0);
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: %s", build->source->name,
                        build->face_count ? "none of the faces can be used" : "there are no faces");
    }
    finish_job job = {.build = build};
    bool same;
    ewa_status status = make_vertices(&job, &same);
    if (status == EWA_OK) status = fill_mesh(&job, same, mesh);
    ewa_release(context, job.table, job.slots, sizeof *job.table);
    ewa_release(context, job.triangles, job.vertex_capacity, sizeof *job.triangles);
    ewa_release(context, job.vertices, job.vertex_capacity, sizeof *job.vertices);
    if (status != EWA_OK) {
        ewa_mesh_free(mesh);
        return status;
    }
    const uint32_t not_finite = count_not_finite(mesh);
    say_losses(build, true, not_finite);
    if (not_finite < mesh->triangle_count) {
        check_steps(build, mesh);
        return EWA_OK;
    }
    ewa_mesh_free(mesh);
    return ewa_fail(context, EWA_ERROR_FORMAT, "%s: none of the faces has finite coordinates",
                    build->source->name);
}

ewa_status ewa_mesh_build_points(ewa_mesh_build *build, ewa_cloud **points) {
    *points = NULL;
    EWA_TRY(ewa_mesh_fill_lines(build));
    const uint64_t count = build->positions.count;
    if (!count)
        return ewa_fail(build->context, EWA_ERROR_FORMAT, "%s: there are neither faces nor points",
                        build->source->name);
    ewa_cloud *made = NULL;
    void *position = NULL, *color = NULL, *normal = NULL, *radius = NULL, *surfaceness = NULL;
    // What no corner chooses is one of each point, if there are as many; points of lines have none.
    const bool has_normals = build->normals.count == count && !(build->line_step > 0);
    ewa_status status = ewa_cloud_create(build->context, count, &made);
    if (status == EWA_OK)
        status = ewa_cloud_add(made, EWA_POSITION, build->float_positions ? EWA_F32 : EWA_F64, 3, &position);
    if (status == EWA_OK && build->colors.count) status = ewa_cloud_add(made, EWA_COLOR, EWA_F32, 4, &color);
    if (status == EWA_OK && has_normals) status = ewa_cloud_add(made, EWA_NORMAL, EWA_F32, 3, &normal);
    if (status == EWA_OK && build->line_step > 0) status = ewa_cloud_add(made, EWA_RADIUS, EWA_F32, 1, &radius);
    if (status == EWA_OK && radius) status = ewa_cloud_add(made, EWA_SURFACENESS, EWA_F32, 1, &surfaceness);
    if (status == EWA_OK) status = ewa_mesh_fill_arrays(build, NULL, NULL, 0, made);
    if (status != EWA_OK) {
        ewa_cloud_destroy(&made);
        return status;
    }
    say_losses(build, false, 0);
    const double *from = build->positions.items;
    for (uint64_t i = 0; i < 3 * count; i++) {
        if (build->float_positions)
            ((float *)position)[i] = (float)from[i];
        else
            ((double *)position)[i] = from[i];
    }
    if (normal) memcpy(normal, build->normals.items, 3 * (size_t)count * sizeof(float));
    // Lines are dots that touch, and no surface.
    for (uint64_t i = 0; radius && i < count; i++) ((float *)radius)[i] = (float)build->line_step, ((float *)surfaceness)[i] = 0;
    for (uint64_t i = 0; color && i < 4 * count; i++)
        ((float *)color)[i] = i < 4 * build->colors.count ? ((const float *)build->colors.items)[i] : 1;
    *points = made;
    return EWA_OK;
}
