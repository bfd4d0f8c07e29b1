// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What every reader of meshes fills: places, colours, texture coordinates and normals with numbers of their
// own, as files have them, and polygons over them, which become triangles; then looks and pictures. From it a
// mesh is made, or a cloud where there are no faces.
#ifndef EWA_SRC_MESH_BUILD_H
#define EWA_SRC_MESH_BUILD_H

#include "ewa/io.h"
#include "ewa/mesh.h"
#include "io/text.h"

enum {
    EWA_MESH_NONE = UINT32_MAX,
    EWA_MESH_MAX_LOOKS = 16384,
};

/// The bytes of a file.
typedef struct ewa_mesh_source {
    ewa_context *context;
    const char *name; ///< stands for the file in messages
    const char *path; ///< files that it names lie below its folder; NULL: they are not read
    const uint8_t *bytes;
    size_t size_bytes;
} ewa_mesh_source;

/// Items that become more; zero-initialise but for item_bytes.
typedef struct ewa_mesh_list {
    void *items;
    uint64_t count, capacity;
    uint32_t item_bytes;
} ewa_mesh_list;

/// What polygons of one kind look like.
typedef struct ewa_mesh_look {
    float base_color[4];
    uint32_t picture; ///< number of ewa_mesh_build.pictures, or none
    bool mapped;      ///< texture coordinates are mapped before use:
    double map[2][3]; ///< (u, v, 1) as a column to the new u and v
} ewa_mesh_look;

/// What becomes of a picture's alpha.
typedef enum ewa_mesh_alpha {
    EWA_MESH_ALPHA_KEEP = 0,
    EWA_MESH_ALPHA_DROP, ///< as if it were 1
    EWA_MESH_ALPHA_CUT,  ///< 0 or 1, by a limit
} ewa_mesh_alpha;

/// A picture and how it was asked for; pixels NULL: it cannot be had.
typedef struct ewa_mesh_picture {
    char *name;
    size_t name_bytes;
    bool beside; ///< it is a file of that name, not in the mesh's
    ewa_mesh_alpha alpha;
    double limit;   ///< of EWA_MESH_ALPHA_CUT
    bool has_alpha; ///< else the same for every `alpha`
    ewa_image image;
} ewa_mesh_picture;

/// One corner of a polygon: numbers of its place, texture coordinates and normal, or none.
typedef struct ewa_mesh_corner {
    uint32_t position, texcoord, normal;
} ewa_mesh_corner;

/// Numbers of places or of cells that have a name in the file, by number of the place or cell.
typedef struct ewa_mesh_array {
    char name[EWA_NAME_BYTES];
    ewa_type type;
    uint32_t component_count; ///< 1 to 4
    bool of_cells;
    bool wide; ///< whole numbers of eight bytes, kept as doubles until all are known
    ewa_mesh_list values; ///< item_bytes: of one place or cell
} ewa_mesh_array;

typedef struct ewa_mesh_build {
    const ewa_mesh_source *source;
    ewa_context *context;
    ewa_mesh_list positions;        ///< 3 doubles
    ewa_mesh_list colors;           ///< 4 floats, linear, by place; none, or for the first places
    ewa_mesh_list texcoords;        ///< 2 floats
    ewa_mesh_list normals;          ///< 3 floats
    ewa_mesh_list corners;          ///< 3 places per triangle
    ewa_mesh_list texcoord_corners; ///< 3 texcoords per triangle; none, or for the first triangles
    ewa_mesh_list normal_corners;   ///< 3 normals per triangle; as texcoord_corners
    ewa_mesh_list face_colors;      ///< 4 floats, linear, per triangle; as texcoord_corners
    ewa_mesh_list face_looks;       ///< look per triangle; as texcoord_corners
    ewa_mesh_list face_cells;       ///< cell per triangle; as texcoord_corners
    ewa_mesh_list cell_colors;      ///< 4 floats, linear, by cell; none, or for the first cells
    ewa_mesh_list segments;         ///< 2 places each, of lines that readers hand over
    double line_step;               ///< between the places along them; 0: there are none
    ewa_mesh_list looks, pictures;
    ewa_mesh_list arrays;           ///< ewa_mesh_array
    uint64_t packed_picture_bytes, picture_bytes; ///< of the pictures so far, in files and decoded
    ewa_mesh_list scratch;                        ///< of the polygon that is being cut
    uint32_t look;       ///< of the next polygons, or none
    float face_color[4]; ///< of the next polygons when has_face_color
    bool has_face_color;
    uint32_t cell;       ///< of the next polygons, or none
    uint64_t cell_count; ///< of the parts of the file that have been read; their data go by it
    bool has_cell_data;  ///< numbers or colours of cells
    bool float_positions;    ///< places come from floats, which may be too coarse
    uint64_t cut_tests_left; ///< bound of the time that cutting polygons may take
    // What was found, to report.
    uint64_t face_count;              ///< polygons in the file
    uint64_t short_count;             ///< of fewer than three corners
    uint64_t beyond_count;            ///< with a vertex that is not there
    uint64_t uncut_count;             ///< that were not cut well
    uint64_t odd_color_count;         ///< that are not finite
    uint64_t line_count, point_count; ///< lines and points of the file that are no faces
    uint64_t unread_count;            ///< numbers that are none
    uint64_t unread_line;             ///< where the first is
    uint64_t missing_count;           ///< pictures that cannot be had
} ewa_mesh_build;

void ewa_mesh_build_open(const ewa_mesh_source *source, ewa_mesh_build *build);
void ewa_mesh_build_close(ewa_mesh_build *build);

/// Makes room for `more` items behind the list's last. Errors: EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_mesh_list_grow(ewa_mesh_build *build, ewa_mesh_list *list, uint64_t more);

/// Appends one item and returns it, unset; NULL when there is no room (then `*status` says why).
static inline void *ewa_mesh_list_add(ewa_mesh_build *build, ewa_mesh_list *list, ewa_status *status) {
    if (list->count == list->capacity) {
        *status = ewa_mesh_list_grow(build, list, 1);
        if (*status != EWA_OK) return NULL;
    }
    return (uint8_t *)list->items + list->count++ * list->item_bytes;
}

ewa_status ewa_mesh_add_position(ewa_mesh_build *build, const double position[3]);
/// Colour of the last place; places before it without one get `missing`. In the end, colours are linear, with
/// straight alpha, and places behind the last one are white.
ewa_status ewa_mesh_add_color(ewa_mesh_build *build, const float missing[4], const float color[4]);
ewa_status ewa_mesh_add_texcoord(ewa_mesh_build *build, double u, double v);
ewa_status ewa_mesh_add_normal(ewa_mesh_build *build, const double normal[3]);

/// Finds the array of a name, or begins one of so many numbers by place, or cell; those before `first` are not known. The
/// name of an attribute that has a meaning here gets "scalar_" in front: the file did not mean it so; that of an array which the
/// others, places or cells, have got "point_" or "cell_". `*array`, which more
/// arrays make invalid, is NULL, after a message, where the name is no UTF-8 or too long, where there are more than four
/// components or 256 arrays, or where an array of that name has other numbers, or those of the places from `first` on.
/// Errors: EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_mesh_find_array(ewa_mesh_build *build, bool of_cells, ewa_text name, ewa_type type, uint64_t component_count,
                               uint64_t first, ewa_mesh_array **array);

/// Adds the numbers of the next place or cell.
ewa_status ewa_mesh_add_numbers(ewa_mesh_build *build, ewa_mesh_array *array, const double *numbers);

/// Gives a cloud the arrays' numbers: of place i, or of place `places[i * stride]` and cell `cells[i * stride]`; `cells` NULL: arrays
/// of cells are left out, after a message. What has none has NaN, whole numbers 0. Errors: EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_mesh_fill_arrays(const ewa_mesh_build *build, const uint32_t *places, const uint32_t *cells, size_t stride,
                                ewa_cloud *cloud);

/// Adds the colour of the next cell, linear, with straight alpha.
ewa_status ewa_mesh_add_cell_color(ewa_mesh_build *build, const float color[4]);

/// The polygons that follow are of a cell: they have its numbers and its colour.
void ewa_mesh_begin_cell(ewa_mesh_build *build, uint64_t cell);

/// Adds a line through places, those that are there.
ewa_status ewa_mesh_add_line(ewa_mesh_build *build, const uint32_t *places, uint64_t count);

/// Adds places along the lines, of a build without faces, so that they are drawn as lines; sets line_step.
ewa_status ewa_mesh_fill_lines(ewa_mesh_build *build);

/// Adds a white look; `*look` is its number. Errors: EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_mesh_add_look(ewa_mesh_build *build, uint32_t *look);
static inline ewa_mesh_look *ewa_mesh_look_at(ewa_mesh_build *build, uint32_t look) {
    return (ewa_mesh_look *)build->looks.items + look;
}

/// Maps texture coordinates as a look says.
void ewa_mesh_map_texcoord(const ewa_mesh_look *look, float uv[2]);

/// Adds a polygon with the look and the colour of the build, cut into triangles. Polygons of fewer than three
/// corners, and with a corner that is not there, are counted and left out; texture coordinates and normals
/// that are not there become none (polygon.c).
ewa_status ewa_mesh_add_polygon(ewa_mesh_build *build, const ewa_mesh_corner *corners, uint64_t count);

/// Adds a triangle whose places are there; for ewa_mesh_add_polygon() and what it calls.
ewa_status ewa_mesh_add_triangle(ewa_mesh_build *build, const ewa_mesh_corner *a, const ewa_mesh_corner *b,
                                 const ewa_mesh_corner *c);

/// Notes a number that is none, in a line of the file or at 0.
static inline void ewa_mesh_note_unread(ewa_mesh_build *build, uint64_t line) {
    if (build->unread_count++ == 0) build->unread_line = line;
}

/// Finds a picture below the mesh's folder, reading it once. `*picture` is EWA_MESH_NONE, after a warning
/// that names it, when it cannot be had. `limit` is that of EWA_MESH_ALPHA_CUT. Errors: EWA_ERROR_LIMIT
/// (pictures over max_memory_bytes together), EWA_ERROR_MEMORY.
ewa_status ewa_mesh_find_picture(ewa_mesh_build *build, ewa_text name, ewa_mesh_alpha alpha, double limit,
                                 uint32_t *picture);

/// The same for bytes in memory; `name` says which picture it is.
ewa_status ewa_mesh_decode_picture(ewa_mesh_build *build, ewa_text name, const uint8_t *bytes,
                                   size_t size_bytes, ewa_mesh_alpha alpha, double limit, uint32_t *picture);

/// Warns of a picture that is left out, the first few by name.
void ewa_mesh_miss_picture(ewa_mesh_build *build, ewa_text name, const char *reason);

/// Makes the mesh, and says what was left out. Errors: EWA_ERROR_FORMAT (no triangle is left),
/// EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_mesh_build_mesh(ewa_mesh_build *build, ewa_mesh *mesh);

/// Makes the faces, as triangles, elements of PLY for a cloud of all places. Colours of vertices are not
/// among them; those of faces and materials are, in 8 bits. NULL when no face can be used. Errors:
/// EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_mesh_build_elements(ewa_mesh_build *build, ewa_elements **elements);

/// Makes a cloud of all places: "position" F64 (F32 when they come from floats), "color" F32 if there are
/// some. Errors: EWA_ERROR_FORMAT (no places), EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_mesh_build_points(ewa_mesh_build *build, ewa_cloud **points);

#endif
