// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// glTF 2.0 and GLB: the container, the tree of nodes, and the primitives that they put into the scene, as
// they stand before any animation.
//
// Based on: "glTF 2.0 Specification", sections 3.5 (scenes), 3.7 (geometry) and 4 (GLB).
#include "io/mesh/gltf.h"
#include "base/base.h"
#include "io/reader.h"

#include <math.h>
#include <stdio.h>

enum {
    MAX_DEPTH = 256,
    HEADER_BYTES = 12, // of a .glb
    CHUNK_JSON = 0x4e4f534a,
    CHUNK_BIN = 0x004e4942,
    FREE_ITEMS = 1 << 22, // that any file may be made of, however short
    PRIMITIVE_ITEMS = 16, // that a primitive costs, even an empty one
    POINTS = 0,
    TRIANGLES = 4,
    STRIP = 5,
    FAN = 6, // modes of primitives
};

static gltf_placement multiply(const gltf_placement *a, const gltf_placement *b) {
    gltf_placement made;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++) {
            made.m[r][c] = c == 3 ? a->m[r][3] : 0;
            for (int k = 0; k < 3; k++) made.m[r][c] += a->m[r][k] * b->m[k][c];
        }
    return made;
}

/// Cofactors of the linear part, which carry normals but for their sign; returns the determinant.
static double cofactors(const gltf_placement *at, double cofactor[3][3]) {
    const double(*m)[4] = at->m;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
            cofactor[r][c] = m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
        }
    return m[0][0] * cofactor[0][0] + m[0][1] * cofactor[0][1] + m[0][2] * cofactor[0][2];
}

static ewa_status read_placement(const gltf *g, uint64_t index, gltf_placement *own) {
    const cJSON *node = g->nodes.items[index];
    double matrix[16], t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
    if (ewa_gltf_member(node, "matrix")) {
        if (!ewa_gltf_numbers(node, "matrix", 16, matrix))
            return ewa_gltf_fail(g, "nodes", index, "matrix is no array of 16 numbers");
        for (int r = 0; r < 3; r++) // stored by columns
            for (int c = 0; c < 4; c++) own->m[r][c] = matrix[4 * c + r];
        return EWA_OK;
    }
    if (!ewa_gltf_numbers(node, "translation", 3, t) || !ewa_gltf_numbers(node, "rotation", 4, q) ||
        !ewa_gltf_numbers(node, "scale", 3, s))
        return ewa_gltf_fail(g, "nodes", index,
                             "translation, rotation or scale is no array of 3, 4, 3 numbers");
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const double turn[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                               {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                               {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) own->m[r][c] = turn[r][c] * s[c];
        own->m[r][3] = t[r];
    }
    return EWA_OK;
}

// ---- primitives

/// What a primitive is made of, and the numbers that its streams begin at in the build.
typedef struct primitive {
    uint64_t mesh; ///< for messages
    const cJSON *attributes;
    uint64_t count; ///< of its vertices
    uint32_t position, texcoord, normal;
    gltf_array indices;  ///< or none
    gltf_packed *packed; ///< by Draco, or NULL
    bool mirrored;
    bool opaque; ///< alpha of its colours means nothing
} primitive;

ewa_status ewa_gltf_read_attribute(gltf *g, uint64_t mesh, const cJSON *attributes, uint64_t wanted_count,
                                   const char *name, uint32_t low, uint32_t high, gltf_array *array) {
    uint64_t accessor;
    *array = (gltf_array){0};
    if (!ewa_gltf_member(attributes, name)) return EWA_OK;
    if (!ewa_gltf_count(attributes, name, 0, &accessor))
        return ewa_gltf_fail(g, "meshes", mesh, "the number of an accessor is wrong");
    EWA_TRY(ewa_gltf_read_accessor(g, accessor, low, high, array));
    if (!wanted_count || array->count == wanted_count) return EWA_OK;
    ewa_gltf_free_array(g, array);
    return ewa_gltf_fail(g, "meshes", mesh, "a primitive has attributes of different lengths");
}

/// Reads an attribute of as many items as there are vertices; `array` is empty when it is not there.
static ewa_status read_attribute(gltf *g, const primitive *p, const char *name, uint32_t low, uint32_t high,
                                 gltf_array *array) {
    uint64_t accessor;
    if (ewa_gltf_packed_has(p->packed, name) && ewa_gltf_count(p->attributes, name, UINT64_MAX, &accessor))
        return ewa_gltf_packed_attribute(g, p->mesh, p->packed, name, accessor, low, high, array);
    return ewa_gltf_read_attribute(g, p->mesh, p->attributes, p->count, name, low, high, array);
}

static ewa_status add_positions(gltf *g, primitive *p, const gltf_placement *at) {
    gltf_array array;
    ewa_status status = read_attribute(g, p, "POSITION", 3, 3, &array);
    p->count = array.count;
    p->position = (uint32_t)g->build->positions.count;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++)
            if (at->m[r][c] != (r == c)) g->build->float_positions = false;
    for (uint64_t i = 0; i < array.count && status == EWA_OK; i++) {
        const double *from = array.numbers + 3 * i;
        double to[3];
        for (int r = 0; r < 3; r++)
            to[r] = at->m[r][0] * from[0] + at->m[r][1] * from[1] + at->m[r][2] * from[2] + at->m[r][3];
        status = ewa_mesh_add_position(g->build, to);
    }
    ewa_gltf_free_array(g, &array);
    return status;
}

static ewa_status add_colors(gltf *g, const primitive *p) {
    static const float white[4] = {1, 1, 1, 1};
    gltf_array array;
    ewa_mesh_build *build = g->build;
    EWA_TRY(read_attribute(g, p, "COLOR_0", 3, 4, &array));
    // Colours go by place: what has none before this primitive is white.
    const uint64_t end = build->positions.count;
    build->positions.count = p->position;
    ewa_status status = EWA_OK;
    for (uint64_t i = 0; i < array.count && build->positions.count < end && status == EWA_OK; i++) {
        const double *from = array.numbers + array.components * i;
        float color[4] = {1, 1, 1, 1};
        bool odd = false;
        for (uint32_t c = 0; c < array.components; c++) odd |= !isfinite(from[c]);
        for (uint32_t c = 0; c < array.components && !odd; c++)
            color[c] = (float)(from[c] >= 0 ? fmin(from[c], 1) : 0);
        if (p->opaque) color[3] = 1;
        build->odd_color_count += odd;
        build->positions.count++;
        status = ewa_mesh_add_color(build, white, color);
    }
    build->positions.count = end;
    ewa_gltf_free_array(g, &array);
    return status;
}

static ewa_status add_texcoords(gltf *g, primitive *p, uint64_t set) {
    char name[32];
    gltf_array array;
    snprintf(name, sizeof name, "TEXCOORD_%llu", (unsigned long long)set);
    ewa_status status = read_attribute(g, p, name, 2, 2, &array);
    p->texcoord = array.count ? (uint32_t)g->build->texcoords.count : EWA_MESH_NONE;
    for (uint64_t i = 0; i < array.count && status == EWA_OK; i++) // from the upper left there
        status = ewa_mesh_add_texcoord(g->build, array.numbers[2 * i], 1 - array.numbers[2 * i + 1]);
    ewa_gltf_free_array(g, &array);
    return status;
}

static ewa_status add_normals(gltf *g, primitive *p, const gltf_placement *at) {
    gltf_array array;
    double cofactor[3][3];
    const double sign = cofactors(at, cofactor) < 0 ? -1 : 1;
    ewa_status status = read_attribute(g, p, "NORMAL", 3, 3, &array);
    p->normal = array.count ? (uint32_t)g->build->normals.count : EWA_MESH_NONE;
    for (uint64_t i = 0; i < array.count && status == EWA_OK; i++) {
        const double *from = array.numbers + 3 * i;
        double to[3];
        for (int r = 0; r < 3; r++)
            to[r] = sign * (cofactor[r][0] * from[0] + cofactor[r][1] * from[1] + cofactor[r][2] * from[2]);
        status = ewa_mesh_add_normal(g->build, to);
    }
    ewa_gltf_free_array(g, &array);
    return status;
}

static ewa_mesh_corner corner_at(const primitive *p, uint64_t index) {
    const double vertex = p->indices.numbers ? p->indices.numbers[index] : (double)index;
    if (!(vertex >= 0 && vertex < (double)p->count))
        return (ewa_mesh_corner){EWA_MESH_NONE, EWA_MESH_NONE, EWA_MESH_NONE};
    const uint32_t number = (uint32_t)vertex;
    return (ewa_mesh_corner){p->position + number,
                             p->texcoord == EWA_MESH_NONE ? EWA_MESH_NONE : p->texcoord + number,
                             p->normal == EWA_MESH_NONE ? EWA_MESH_NONE : p->normal + number};
}

static ewa_status add_triangles(gltf *g, const primitive *p, uint64_t mode) {
    const uint64_t count = p->indices.numbers ? p->indices.count : p->count;
    const uint64_t triangles = mode == TRIANGLES ? count / 3 : count < 3 ? 0 : count - 2;
    for (uint64_t t = 0; t < triangles; t++) {
        uint64_t a = t, b = t + 1, c = t + 2;
        if (mode == TRIANGLES) a = 3 * t, b = a + 1, c = a + 2;
        if (mode == FAN) a = 0;
        // In a strip every other triangle is turned; a mirroring node turns all.
        const bool turned = p->mirrored != (mode == STRIP && t % 2);
        const ewa_mesh_corner corners[3] = {corner_at(p, a), corner_at(p, turned ? c : b),
                                            corner_at(p, turned ? b : c)};
        EWA_TRY(ewa_mesh_add_polygon(g->build, corners, 3));
    }
    return EWA_OK;
}

/// Adds the vertices of a primitive and its triangles.
static ewa_status add_parts(gltf *g, primitive *p, const gltf_placement *at, uint64_t mode, uint64_t indices,
                            uint64_t set) {
    EWA_TRY(add_positions(g, p, at));
    EWA_TRY(add_colors(g, p));
    if (mode == POINTS) return EWA_OK;
    EWA_TRY(add_texcoords(g, p, set));
    EWA_TRY(add_normals(g, p, at));
    if (p->packed)
        EWA_TRY(ewa_gltf_packed_indices(g, p->packed, &p->indices));
    else if (indices != UINT64_MAX)
        EWA_TRY(ewa_gltf_read_accessor(g, indices, 1, 1, &p->indices));
    return add_triangles(g, p, mode);
}

static ewa_status add_primitive(gltf *g, uint64_t mesh, const cJSON *item, const gltf_placement *at) {
    primitive p = {.mesh = mesh, .attributes = ewa_gltf_member(item, "attributes")};
    uint64_t mode, material, indices, positions, set = 0;
    EWA_TRY(ewa_gltf_spend(g, PRIMITIVE_ITEMS)); // many nodes may have one mesh
    if (!ewa_gltf_count(item, "mode", TRIANGLES, &mode) || mode > FAN ||
        !ewa_gltf_count(item, "material", UINT64_MAX, &material) ||
        !ewa_gltf_count(item, "indices", UINT64_MAX, &indices))
        return ewa_gltf_fail(g, "meshes", mesh, "mode, material or indices of a primitive are wrong");
    if (mode < TRIANGLES) {
        ++*(mode == POINTS ? &g->build->point_count : &g->build->line_count);
        if (mode != POINTS || g->has_triangles) return EWA_OK;
    }
    double cofactor[3][3];
    p.mirrored = cofactors(at, cofactor) < 0;
    g->build->look = EWA_MESH_NONE;
    if (material != UINT64_MAX) EWA_TRY(ewa_gltf_look(g, material, &g->build->look, &set));
    p.opaque = material == UINT64_MAX || ewa_gltf_alpha(g, material) == EWA_MESH_ALPHA_DROP;
    if (mode == TRIANGLES && indices != UINT64_MAX &&
        ewa_gltf_count(p.attributes, "POSITION", UINT64_MAX, &positions))
        EWA_TRY(ewa_gltf_open_packed(g, mesh, item, positions, indices, &p.packed));
    const ewa_status status = add_parts(g, &p, at, mode, indices, set);
    ewa_gltf_close_packed(g, &p.packed);
    ewa_gltf_free_array(g, &p.indices);
    return status;
}

static ewa_status add_node(gltf *g, uint64_t index, const gltf_placement *above, uint32_t depth) {
    if (index >= g->nodes.count) return ewa_gltf_fail(g, "nodes", index, "there is no such one");
    if (g->visited[index]) return ewa_gltf_fail(g, "nodes", index, "it hangs at two places of the tree");
    if (depth > MAX_DEPTH) return ewa_gltf_fail(g, "nodes", index, "the tree is over 256 nodes deep");
    g->visited[index] = true;
    const cJSON *node = g->nodes.items[index], *item;
    gltf_placement own;
    uint64_t mesh, child;
    EWA_TRY(read_placement(g, index, &own));
    const gltf_placement at = multiply(above, &own);
    if (!ewa_gltf_count(node, "mesh", UINT64_MAX, &mesh) || (mesh != UINT64_MAX && mesh >= g->meshes.count))
        return ewa_gltf_fail(g, "nodes", index, "there is no such mesh");
    if (mesh != UINT64_MAX)
        cJSON_ArrayForEach(item, ewa_gltf_member(g->meshes.items[mesh], "primitives"))
            EWA_TRY(g->take(g, mesh, item, &at));
    cJSON_ArrayForEach(item, ewa_gltf_member(node, "children")) {
        if (!cJSON_IsNumber(item) || !(item->valuedouble >= 0 && item->valuedouble < 0x1p32))
            return ewa_gltf_fail(g, "nodes", index, "a child is no number of a node");
        child = (uint64_t)item->valuedouble;
        EWA_TRY(add_node(g, child, &at, depth + 1));
    }
    return ewa_progress(g->build->context, "read", 0.5);
}

/// The nodes of the scene; without scenes, those that are nobody's child.
static ewa_status add_scene(gltf *g) {
    static const gltf_placement identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    const cJSON *scenes = ewa_gltf_member(g->root, "scenes"), *item;
    uint64_t number;
    if (!ewa_gltf_count(g->root, "scene", 0, &number))
        return ewa_gltf_fail(g, "scenes", 0, "scene is no number");
    if (cJSON_GetArraySize(scenes) > 0) {
        const cJSON *scene =
            number < (uint64_t)cJSON_GetArraySize(scenes) ? cJSON_GetArrayItem(scenes, (int)number) : NULL;
        if (!scene) return ewa_gltf_fail(g, "scenes", number, "there is no such one");
        cJSON_ArrayForEach(item, ewa_gltf_member(scene, "nodes")) {
            if (!cJSON_IsNumber(item) || !(item->valuedouble >= 0 && item->valuedouble < 0x1p32))
                return ewa_gltf_fail(g, "scenes", number, "a node is no number");
            EWA_TRY(add_node(g, (uint64_t)item->valuedouble, &identity, 0));
        }
        return EWA_OK;
    }
    bool *is_child = ewa_allocate_zeroed(g->build->context, g->nodes.count, sizeof *is_child);
    if (!is_child) return EWA_ERROR_MEMORY;
    for (uint32_t n = 0; n < g->nodes.count; n++)
        cJSON_ArrayForEach(item, ewa_gltf_member(g->nodes.items[n], "children")) if (cJSON_IsNumber(item) &&
                                                                                     item->valuedouble >= 0 &&
                                                                                     item->valuedouble <
                                                                                         g->nodes.count)
            is_child[(uint32_t)item->valuedouble] = true;
    ewa_status status = EWA_OK;
    for (uint32_t n = 0; n < g->nodes.count && status == EWA_OK; n++)
        if (!is_child[n]) status = add_node(g, n, &identity, 0);
    ewa_release(g->build->context, is_child, g->nodes.count, sizeof *is_child);
    return status;
}

// ---- the file

static ewa_status open_table(const gltf *g, const char *name, gltf_table *table) {
    const cJSON *array = ewa_gltf_member(g->root, name), *item;
    *table = (gltf_table){0};
    if (!cJSON_IsArray(array)) return EWA_OK;
    const uint32_t count = (uint32_t)cJSON_GetArraySize(array);
    table->items = ewa_allocate(g->build->context, count, sizeof(const cJSON *));
    if (!table->items) return EWA_ERROR_MEMORY;
    cJSON_ArrayForEach(item, array) table->items[table->count++] = item;
    return EWA_OK;
}

/// Extensions without which the file would be drawn wrongly.
static ewa_status check_extensions(const gltf *g) {
    static const char *const known[] = {"KHR_texture_transform",     "KHR_mesh_quantization",
                                        "EXT_texture_webp",          "KHR_materials_pbrSpecularGlossiness",
                                        "KHR_texture_basisu", // such pictures are left out
                                        "KHR_lights_punctual",       "KHR_gaussian_splatting",
                                        "EXT_meshopt_compression",   "KHR_meshopt_compression",
                                        "KHR_draco_mesh_compression"};
    const cJSON *item;
    char quote[EWA_QUOTE_BYTES];
    cJSON_ArrayForEach(item, ewa_gltf_member(g->root, "extensionsRequired")) {
        const char *name = cJSON_IsString(item) ? item->valuestring : "";
        // How light meets a material is not looked at.
        bool found =
            strncmp(name, "KHR_materials_", 14) == 0 || (g->extension && strcmp(name, g->extension) == 0);
        for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
            found = found || strcmp(name, known[i]) == 0;
        if (!found)
            return ewa_fail(g->build->context, EWA_ERROR_UNSUPPORTED,
                            "%s: it requires the extension %s, which is not read", g->build->source->name,
                            ewa_quote((ewa_text){name, strlen(name)}, quote));
    }
    return EWA_OK;
}

static ewa_status check_version(const gltf *g) {
    const cJSON *version = ewa_gltf_member(ewa_gltf_member(g->root, "asset"), "version");
    char quote[EWA_QUOTE_BYTES];
    if (!cJSON_IsString(version) || strncmp(version->valuestring, "2.", 2) == 0) return EWA_OK;
    return ewa_fail(g->build->context, EWA_ERROR_UNSUPPORTED, "%s: glTF of version %s; 2.0 is read",
                    g->build->source->name,
                    ewa_quote((ewa_text){version->valuestring, strlen(version->valuestring)}, quote));
}

static void find_triangles(gltf *g) {
    for (uint32_t m = 0; m < g->meshes.count && !g->has_triangles; m++) {
        const cJSON *item;
        uint64_t mode;
        cJSON_ArrayForEach(item, ewa_gltf_member(g->meshes.items[m], "primitives")) g->has_triangles =
            g->has_triangles || (ewa_gltf_count(item, "mode", TRIANGLES, &mode) && mode >= TRIANGLES);
    }
}

static ewa_status read_tree(gltf *g) {
    const struct {
        const char *name;
        gltf_table *table;
    } tables[] = {{"nodes", &g->nodes},       {"meshes", &g->meshes},   {"accessors", &g->accessors},
                  {"bufferViews", &g->views}, {"buffers", &g->buffers}, {"materials", &g->materials},
                  {"textures", &g->textures}, {"images", &g->images}};
    enum { TABLE_COUNT = sizeof tables / sizeof tables[0] };
    ewa_context *context = g->build->context;
    ewa_status status = check_version(g);
    if (status == EWA_OK) status = check_extensions(g);
    for (int i = 0; i < TABLE_COUNT && status == EWA_OK; i++)
        status = open_table(g, tables[i].name, tables[i].table);
    if (status == EWA_OK) {
        find_triangles(g);
        g->opened = ewa_allocate_zeroed(context, g->buffers.count, sizeof *g->opened);
        g->looks = ewa_allocate(context, g->materials.count, sizeof *g->looks);
        g->visited = ewa_allocate_zeroed(context, g->nodes.count, sizeof *g->visited);
        if (!g->opened || !g->looks || !g->visited) status = EWA_ERROR_MEMORY;
    }
    if (status == EWA_OK) {
        memset(g->looks, 0xff, g->materials.count * sizeof *g->looks);
        status = add_scene(g);
    }
    ewa_gltf_close_buffers(g);
    ewa_release(context, g->visited, g->nodes.count, sizeof *g->visited);
    ewa_release(context, g->looks, g->materials.count, sizeof *g->looks);
    for (int i = 0; i < TABLE_COUNT; i++)
        ewa_release(context, tables[i].table->items, tables[i].table->count, sizeof(const cJSON *));
    return status;
}

/// Finds the chunks of a .glb.
static ewa_status open_container(gltf *g, const uint8_t **json, size_t *json_bytes) {
    const ewa_mesh_source *source = g->build->source;
    if (source->size_bytes < HEADER_BYTES)
        return ewa_fail(g->build->context, EWA_ERROR_FORMAT, "%s: the file ends in its header", source->name);
    const uint32_t version = ewa_bytes_u32(source->bytes + 4);
    if (version != 2)
        return ewa_fail(g->build->context, EWA_ERROR_UNSUPPORTED, "%s: GLB of version %u; 2 is read",
                        source->name, version);
    *json = NULL;
    for (size_t at = HEADER_BYTES; source->size_bytes - at >= 8;) {
        const uint32_t length = ewa_bytes_u32(source->bytes + at), type = ewa_bytes_u32(source->bytes + at + 4);
        if (length > source->size_bytes - at - 8)
            return ewa_fail(g->build->context, EWA_ERROR_FORMAT,
                            "%s: a chunk of %u bytes from byte %zu on ends behind the file", source->name,
                            length, at);
        if (type == CHUNK_JSON && !*json) *json = source->bytes + at + 8, *json_bytes = length;
        if (type == CHUNK_BIN && !g->chunk) g->chunk = source->bytes + at + 8, g->chunk_bytes = length;
        at += 8 + (size_t)length;
    }
    return *json ? EWA_OK
                 : ewa_fail(g->build->context, EWA_ERROR_FORMAT, "%s: there is no JSON chunk", source->name);
}

ewa_status ewa_mesh_read_gltf(ewa_mesh_build *build) {
    build->float_positions = true; // unless a node moves them
    return ewa_gltf_walk(build, add_primitive, NULL, NULL);
}

ewa_status ewa_gltf_walk(ewa_mesh_build *build, gltf_take *take, void *user, const char *extension) {
    const ewa_mesh_source *source = build->source;
    gltf g = {.build = build, .take = take, .user = user, .extension = extension};
    g.items_left = FREE_ITEMS;
    ewa_gltf_grant(&g, source->size_bytes);
    const uint8_t *json = source->bytes;
    size_t json_bytes = source->size_bytes;
    ewa_json tree;
    if (json_bytes >= 4 && memcmp(json, "glTF", 4) == 0) EWA_TRY(open_container(&g, &json, &json_bytes));
    const uint32_t mark = ewa_bytes_mark(json, json_bytes);
    json += mark, json_bytes -= mark;
    while (json_bytes && json[json_bytes - 1] == 0) json_bytes--; // padding that should be blanks
    ewa_status status = ewa_json_parse(build->context, source->name, "a glTF file", json, json_bytes, &tree);
    g.root = tree.root;
    if (status == EWA_OK) status = read_tree(&g);
    ewa_json_free(build->context, &tree);
    return status;
}
