// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Faces of PLY files: polygons, strips, colours of faces, texture coordinates in all the places where
// programs put them, and the pictures that comments name.
//
// Based on: G. Turk, "The PLY Polygon File Format", Stanford University 1994, and on what MeshLab (texcoord,
// texnumber, "comment TextureFile"), Blender (s, t) and Artec Studio (multi_texture_vertex) write.
#include "io/cloud/ply.h"
#include "base/base.h"
#include "base/platform.h"
#include "image/srgb.h"
#include "io/mesh/formats.h"

#include <math.h>
#include <stdio.h>

enum { MAX_TEXTURES = 4096 };

/// Properties of the element of faces.
typedef struct face_properties {
    uint32_t vertices, texcoord, texnumber, color[4];
    bool has_texcoord, has_texnumber;
    uint32_t color_count; ///< 0, 3 or 4
} face_properties;

/// Texture coordinates that lie in elements of their own, for face k of the faces in record `face[k]`.
typedef struct multi_texture {
    const ewa_ply_table *vertices, *faces;
    uint32_t u, v, indices, texture;
    bool has_texture;
    uint32_t *face; ///< record of multi_texture_face by face, or none
    uint64_t face_count;
} multi_texture;

typedef struct ply_mesh {
    ewa_mesh_build *build;
    const ewa_elements *elements;
    uint32_t first_look, look_count; ///< one per picture of the header
    uint32_t vertex_texcoords;       ///< texcoords that go by vertex come first: how many
    ewa_mesh_corner *corners;
    uint64_t corner_capacity;
} ply_mesh;

static const ewa_ply_table *find_table(const ewa_elements *elements, const char *name) {
    for (uint32_t i = 0; i < elements->table_count; i++)
        if (ewa_text_is(elements->header->elements[i].name, name)) return &elements->tables[i];
    return NULL;
}

static bool find_scalar(const ewa_ply_header *header, const ewa_ply_element *element, const char *name,
                        uint32_t *property) {
    return ewa_ply_find_property(header, element, name, property) && !header->properties[*property].is_list;
}

static bool find_list(const ewa_ply_header *header, const ewa_ply_element *element, const char *name,
                      uint32_t *property) {
    return ewa_ply_find_property(header, element, name, property) && header->properties[*property].is_list;
}

// ---- vertices

static float linear_of(double value, ewa_type type) {
    if (type == EWA_F32 || type == EWA_F64) return (float)value;
    const double full = type == EWA_U16 ? 65535 : 255;
    return (float)ewa_srgb_decode(fmin(fmax(value / full, 0), 1));
}

static float alpha_of(double value, ewa_type type) {
    const double full = type == EWA_F32 || type == EWA_F64 ? 1 : type == EWA_U16 ? 65535 : 255;
    return value >= 0 ? (float)fmin(value / full, 1) : 1;
}

/// Fills 4 floats from 3 or 4 numbers of a type. What is not finite counts as white.
static void color_of(ewa_mesh_build *build, const double *values, uint32_t count, ewa_type type,
                     float color[4]) {
    bool odd = count == 4 && !isfinite(values[3]);
    for (uint32_t c = 0; c < 3; c++) {
        color[c] = linear_of(values[c], type);
        odd |= !isfinite(values[c]) || !isfinite(color[c]);
    }
    for (uint32_t c = 0; c < 3 && odd; c++) color[c] = 1;
    color[3] = count == 4 ? alpha_of(values[3], type) : 1;
    build->odd_color_count += odd;
}

static const char *const texcoord_names[][2] = {
    {"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}, {"tx", "ty"}};
enum { TEXCOORD_NAMES = sizeof texcoord_names / sizeof texcoord_names[0] };

static ewa_status add_texcoords(ply_mesh *mesh, const ewa_cloud *vertices) {
    const ewa_attribute *u = NULL, *v = NULL;
    for (size_t i = 0; i < TEXCOORD_NAMES && !(u && v); i++) {
        u = ewa_cloud_find(vertices, texcoord_names[i][0]);
        v = ewa_cloud_find(vertices, texcoord_names[i][1]);
    }
    ewa_status status = EWA_OK;
    if (!u || !v) return EWA_OK;
    for (uint64_t i = 0; i < ewa_cloud_point_count(vertices) && status == EWA_OK; i++) {
        double at[2];
        ewa_attribute_read_f64(u, i, 1, &at[0]);
        ewa_attribute_read_f64(v, i, 1, &at[1]);
        status = ewa_mesh_add_texcoord(mesh->build, at[0], at[1]);
    }
    mesh->vertex_texcoords = (uint32_t)mesh->build->texcoords.count;
    return status;
}

/// Adds what else there is of vertices: numbers that have a name.
static ewa_status add_arrays(ply_mesh *mesh, const ewa_cloud *vertices) {
    const uint64_t count = ewa_cloud_point_count(vertices);
    const ewa_attribute *a;
    for (uint32_t k = 0; (a = ewa_cloud_attribute_at(vertices, k)); k++) {
        bool taken = strcmp(a->name, EWA_POSITION) == 0 || strcmp(a->name, EWA_NORMAL) == 0 || strcmp(a->name, EWA_COLOR) == 0;
        for (size_t i = 0; i < 2 * TEXCOORD_NAMES && mesh->vertex_texcoords; i++)
            taken |= strcmp(a->name, texcoord_names[i / 2][i % 2]) == 0;
        ewa_mesh_array *array = NULL;
        if (!taken)
            EWA_TRY(ewa_mesh_find_array(mesh->build, false, (ewa_text){a->name, strlen(a->name)}, a->type, a->component_count, 0, &array));
        for (uint64_t i = 0; i < count && array; i++) {
            double numbers[4];
            ewa_attribute_read_f64(a, i, 1, numbers);
            EWA_TRY(ewa_mesh_add_numbers(mesh->build, array, numbers));
        }
    }
    return EWA_OK;
}

static ewa_status add_vertices(ply_mesh *mesh, const ewa_cloud *vertices) {
    ewa_mesh_build *build = mesh->build;
    const ewa_attribute *position = ewa_cloud_find(vertices, EWA_POSITION),
                        *color = ewa_cloud_find(vertices, EWA_COLOR),
                        *normal = ewa_cloud_find(vertices, EWA_NORMAL);
    const uint64_t count = ewa_cloud_point_count(vertices);
    build->float_positions = position->type == EWA_F32;
    EWA_TRY(ewa_mesh_list_grow(build, &build->positions, count));
    if (color) EWA_TRY(ewa_mesh_list_grow(build, &build->colors, count));
    if (normal) EWA_TRY(ewa_mesh_list_grow(build, &build->normals, count));
    for (uint64_t i = 0; i < count; i++) {
        double values[4];
        float rgba[4];
        ewa_attribute_read_f64(position, i, 1, values);
        EWA_TRY(ewa_mesh_add_position(build, values));
        if (color) {
            ewa_attribute_read_f64(color, i, 1, values);
            color_of(build, values, color->component_count, color->type, rgba);
            EWA_TRY(ewa_mesh_add_color(build, rgba, rgba));
        }
        if (normal) {
            ewa_attribute_read_f64(normal, i, 1, values);
            EWA_TRY(ewa_mesh_add_normal(build, values));
        }
    }
    EWA_TRY(add_texcoords(mesh, vertices));
    return add_arrays(mesh, vertices);
}

// ---- pictures

/// The name that stands behind "comment TextureFile"; "<this>" there means the mesh's own name less its
/// suffix.
static ewa_status add_texture(ply_mesh *mesh, ewa_text name) {
    static const char own[] = "<this>";
    char whole[1024];
    ewa_mesh_build *build = mesh->build;
    const char *path = build->source->path;
    if (path && name.length > sizeof own - 1 && memcmp(name.chars, own, sizeof own - 1) == 0) {
        const char *base = ewa_platform_file_name(path), *dot = strrchr(base, '.');
        const int length =
            snprintf(whole, sizeof whole, "%.*s%.*s", dot ? (int)(dot - base) : (int)strlen(base), base,
                     (int)(name.length - (sizeof own - 1)), name.chars + sizeof own - 1);
        if (length > 0 && (size_t)length < sizeof whole) name = (ewa_text){whole, (size_t)length};
    }
    uint32_t look;
    EWA_TRY(ewa_mesh_add_look(build, &look));
    mesh->look_count++;
    uint32_t picture;
    const ewa_status found = ewa_mesh_find_picture(build, name, EWA_MESH_ALPHA_KEEP, 0, &picture);
    ewa_mesh_look_at(build, look)->picture = picture;
    return found;
}

static ewa_status add_textures(ply_mesh *mesh) {
    const ewa_elements *elements = mesh->elements;
    ewa_cursor cursor = {elements->text, elements->text + elements->text_bytes, 1};
    ewa_status status = EWA_OK;
    while (cursor.at < cursor.end && status == EWA_OK && mesh->look_count < MAX_TEXTURES) {
        if (ewa_text_is(ewa_cursor_word(&cursor), "comment") &&
            ewa_text_is_any_case(ewa_cursor_word(&cursor), "TextureFile"))
            status = add_texture(mesh, ewa_cursor_rest(&cursor));
        while (cursor.at < cursor.end && !ewa_is_line_end(*cursor.at)) cursor.at++;
        ewa_cursor_step_line(&cursor);
    }
    return status;
}

// ---- faces

static face_properties face_properties_of(const ewa_ply_header *header, const ewa_ply_element *element,
                                          uint32_t vertices) {
    static const char *const names[2][4] = {
        {"red", "green", "blue", "alpha"}, {"diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"}};
    face_properties made = {.vertices = vertices};
    made.has_texcoord = find_list(header, element, "texcoord", &made.texcoord);
    made.has_texnumber = find_scalar(header, element, "texnumber", &made.texnumber);
    for (int n = 0; n < 2 && made.color_count < 3; n++)
        for (made.color_count = 0; made.color_count < 4; made.color_count++)
            if (!find_scalar(header, element, names[n][made.color_count], &made.color[made.color_count]))
                break;
    if (made.color_count < 3) made.color_count = 0;
    return made;
}

/// Finds texture coordinates in elements of their own. Errors: EWA_ERROR_MEMORY.
static ewa_status open_multi_texture(const ply_mesh *mesh, uint64_t face_count, multi_texture *multi) {
    const ewa_ply_header *header = mesh->elements->header;
    *multi = (multi_texture){.vertices = find_table(mesh->elements, "multi_texture_vertex"),
                             .faces = find_table(mesh->elements, "multi_texture_face")};
    uint32_t number;
    if (!multi->vertices || !multi->faces || !multi->vertices->element->count ||
        !multi->faces->element->count || !find_scalar(header, multi->vertices->element, "u", &multi->u) ||
        !find_scalar(header, multi->vertices->element, "v", &multi->v) ||
        !find_list(header, multi->faces->element, "texture_vertex_indices", &multi->indices) ||
        !find_scalar(header, multi->faces->element, "tn", &number)) {
        multi->faces = NULL;
        return EWA_OK;
    }
    multi->has_texture = find_scalar(header, multi->faces->element, "tx", &multi->texture);
    multi->face = ewa_allocate(mesh->build->context, face_count, sizeof *multi->face);
    if (!multi->face) return EWA_ERROR_MEMORY;
    multi->face_count = face_count;
    memset(multi->face, 0xff, face_count * sizeof *multi->face);
    for (uint64_t i = 0; i < multi->faces->element->count && i < EWA_MESH_NONE; i++) {
        const double face = ewa_ply_table_number(header, multi->faces, number, i);
        if (face >= 0 && face < (double)face_count) multi->face[(uint64_t)face] = (uint32_t)i;
    }
    return EWA_OK;
}

/// Numbers the corners of a face into mesh->corners; `*count` gets how many.
static ewa_status take_corners(ply_mesh *mesh, const ewa_ply_list *list, ewa_type type, uint64_t face,
                               uint64_t *count) {
    const uint64_t first = list->first[face];
    *count = list->first[face + 1] - first;
    if (*count > mesh->corner_capacity) {
        ewa_context *context = mesh->build->context;
        ewa_release(context, mesh->corners, mesh->corner_capacity, sizeof *mesh->corners);
        mesh->corners = ewa_allocate(context, 2 * *count, sizeof *mesh->corners);
        mesh->corner_capacity = mesh->corners ? 2 * *count : 0;
        if (!mesh->corners) return EWA_ERROR_MEMORY;
    }
    const bool normals = mesh->build->normals.count > 0;
    for (uint64_t i = 0; i < *count; i++) {
        const double number = ewa_ply_list_number(list, type, first + i);
        const uint32_t vertex = number >= 0 && number < (double)EWA_MESH_NONE && number == floor(number)
                                    ? (uint32_t)number
                                    : EWA_MESH_NONE;
        mesh->corners[i] = (ewa_mesh_corner){vertex, vertex < mesh->vertex_texcoords ? vertex : EWA_MESH_NONE,
                                             normals ? vertex : EWA_MESH_NONE};
    }
    return EWA_OK;
}

/// Texture coordinates that a face lists: u, v for each corner.
static ewa_status take_texcoords(ply_mesh *mesh, const ewa_ply_list *list, ewa_type type, uint64_t face,
                                 uint64_t count) {
    const uint64_t first = list->first[face];
    if (list->first[face + 1] - first != 2 * count) return EWA_OK;
    for (uint64_t i = 0; i < count; i++) {
        mesh->corners[i].texcoord = (uint32_t)mesh->build->texcoords.count;
        EWA_TRY(ewa_mesh_add_texcoord(mesh->build, ewa_ply_list_number(list, type, first + 2 * i),
                                      ewa_ply_list_number(list, type, first + 2 * i + 1)));
    }
    return EWA_OK;
}

/// Texture coordinates of a face in elements of their own; `*texture` gets the number of the picture.
static ewa_status take_multi_texture(ply_mesh *mesh, const multi_texture *multi, uint64_t face,
                                     uint64_t count, double *texture) {
    const ewa_ply_header *header = mesh->elements->header;
    const uint32_t record = multi->face[face];
    if (record == EWA_MESH_NONE) return EWA_OK;
    const ewa_ply_list *list = ewa_ply_table_list(header, multi->faces, multi->indices);
    const uint64_t first = list->first[record];
    if (list->first[record + 1] - first != count) return EWA_OK;
    if (multi->has_texture) *texture = ewa_ply_table_number(header, multi->faces, multi->texture, record);
    for (uint64_t i = 0; i < count; i++) {
        const double at = ewa_ply_list_number(list, header->properties[multi->indices].type, first + i);
        if (!(at >= 0 && at < (double)multi->vertices->element->count)) continue;
        mesh->corners[i].texcoord = (uint32_t)mesh->build->texcoords.count;
        EWA_TRY(ewa_mesh_add_texcoord(mesh->build,
                                      ewa_ply_table_number(header, multi->vertices, multi->u, (uint64_t)at),
                                      ewa_ply_table_number(header, multi->vertices, multi->v, (uint64_t)at)));
    }
    return EWA_OK;
}

/// The look of a texture number: none when there is no such picture.
static uint32_t look_of(const ply_mesh *mesh, double texture) {
    return texture >= 0 && texture < (double)mesh->look_count ? mesh->first_look + (uint32_t)texture
                                                              : EWA_MESH_NONE;
}

static ewa_status add_faces(ply_mesh *mesh, const ewa_ply_table *table, uint32_t vertices) {
    const ewa_ply_header *header = mesh->elements->header;
    ewa_mesh_build *build = mesh->build;
    const face_properties of = face_properties_of(header, table->element, vertices);
    const ewa_ply_list *corners = ewa_ply_table_list(header, table, of.vertices);
    const ewa_ply_list *texcoords = of.has_texcoord ? ewa_ply_table_list(header, table, of.texcoord) : NULL;
    const uint64_t face_count = table->element->count;
    multi_texture multi;
    ewa_status status = open_multi_texture(mesh, face_count, &multi);
    // Colours of vertices say more than those of faces.
    build->has_face_color = of.color_count && !build->colors.count;
    for (uint64_t f = 0; f < face_count && status == EWA_OK; f++) {
        uint64_t count;
        double texture = 0;
        status = take_corners(mesh, corners, header->properties[of.vertices].type, f, &count);
        if (status == EWA_OK && texcoords)
            status = take_texcoords(mesh, texcoords, header->properties[of.texcoord].type, f, count);
        else if (status == EWA_OK && multi.faces)
            status = take_multi_texture(mesh, &multi, f, count, &texture);
        if (status != EWA_OK) break;
        if (of.has_texnumber) texture = ewa_ply_table_number(header, table, of.texnumber, f);
        build->look = look_of(mesh, texture);
        if (build->has_face_color) {
            double values[4];
            for (uint32_t c = 0; c < of.color_count; c++)
                values[c] = ewa_ply_table_number(header, table, of.color[c], f);
            color_of(build, values, of.color_count, header->properties[of.color[0]].type, build->face_color);
        }
        status = ewa_mesh_add_polygon(build, mesh->corners, count);
    }
    build->has_face_color = false;
    ewa_release(build->context, multi.face, multi.face_count, sizeof *multi.face);
    return status;
}

/// Strips: every vertex makes a triangle with the two before it, turned every other time; a negative number
/// begins anew.
static ewa_status add_strips(ply_mesh *mesh, const ewa_ply_table *table, uint32_t vertices) {
    const ewa_ply_header *header = mesh->elements->header;
    const ewa_ply_list *list = ewa_ply_table_list(header, table, vertices);
    const ewa_type type = header->properties[vertices].type;
    ewa_mesh_build *build = mesh->build;
    build->look = look_of(mesh, 0);
    for (uint64_t s = 0; s < table->element->count; s++) {
        uint64_t run = 0;
        ewa_mesh_corner last[3] = {{0, 0, 0}};
        for (uint64_t i = list->first[s]; i < list->first[s + 1]; i++) {
            const double number = ewa_ply_list_number(list, type, i);
            if (number < 0 || number == (double)UINT32_MAX) { // -1, also where it is stored without a sign
                run = 0;
                continue;
            }
            const uint32_t vertex = number < (double)EWA_MESH_NONE ? (uint32_t)number : EWA_MESH_NONE;
            last[0] = last[1];
            last[1] = last[2];
            last[2] = (ewa_mesh_corner){vertex, vertex < mesh->vertex_texcoords ? vertex : EWA_MESH_NONE,
                                        build->normals.count ? vertex : EWA_MESH_NONE};
            if (++run < 3) continue;
            // A vertex twice in a row only turns or moves the strip.
            if (last[0].position == last[1].position || last[1].position == last[2].position ||
                last[2].position == last[0].position)
                continue;
            const bool turned = run % 2 == 0;
            const ewa_mesh_corner corners[3] = {last[turned], last[!turned], last[2]};
            EWA_TRY(ewa_mesh_add_polygon(build, corners, 3));
        }
    }
    return EWA_OK;
}

ewa_status ewa_mesh_read_ply(ewa_mesh_build *build, const ewa_cloud *vertices, const ewa_elements *elements) {
    ply_mesh mesh = {.build = build, .elements = elements, .first_look = (uint32_t)build->looks.count};
    ewa_status status = add_vertices(&mesh, vertices);
    if (status == EWA_OK) status = add_textures(&mesh);
    for (uint32_t i = 0; i < elements->table_count && status == EWA_OK; i++) {
        const ewa_ply_table *table = &elements->tables[i];
        bool strips;
        uint32_t property;
        if (!ewa_ply_is_faces(elements->header, table->element, &strips, &property)) continue;
        status = strips ? add_strips(&mesh, table, property) : add_faces(&mesh, table, property);
    }
    ewa_release(build->context, mesh.corners, mesh.corner_capacity, sizeof *mesh.corners);
    return status;
}
