// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Triangle meshes: from files, and to surfels with sharp edges.
#ifndef EWA_MESH_H
#define EWA_MESH_H

#include "ewa/base.h"
#include "ewa/cloud.h"
#include "ewa/image.h"
#include "ewa/options.h"

#ifdef __cplusplus
extern "C" {
#endif

/// What the triangles of one kind look like.
typedef struct ewa_mesh_material {
    float base_color[4]; ///< linear red green blue, straight alpha; times vertex colour and texture
    uint32_t texture;    ///< index into the mesh's textures, which several materials may share
} ewa_mesh_material;

/// Triangles over shared vertices. A caller may fill one with memory of its own, for which ewa_mesh_free() is
/// then not called.
typedef struct ewa_mesh {
    ewa_context *context;
    uint32_t vertex_count, triangle_count, material_count;
    double *positions;   ///< 3 per vertex, world units
    float *normals;      ///< 3 per vertex, outward, any length; zero: none there; NULL: none
    float *colors;       ///< 4 per vertex: linear red green blue, straight alpha; NULL: none
    float *texcoords;    ///< 2 per vertex, (0, 0) bottom left of the picture, which repeats; NULL: none
    uint32_t *triangles; ///< 3 vertices per triangle, counter-clockwise seen from outside
    uint32_t *triangle_materials; ///< 1 per triangle; NULL when there are no materials
    ewa_mesh_material *materials;
    ewa_image *textures; ///< material_count images of 1, 3 or 4 channels as ewa_image_load() gives them; no
                         ///< pixels: none
    ewa_cloud *attributes; ///< other numbers of the vertices, vertex_count points, no positions; NULL: none
} ewa_mesh;

/// Which of the optional streams ewa_mesh_create() makes.
enum {
    EWA_MESH_COLORS = 1u << 0,
    EWA_MESH_TEXCOORDS = 1u << 1,
    EWA_MESH_NORMALS = 1u << 2,
};

/// Makes a mesh with everything zero, but for `texture` of material i, which is i; `streams` are EWA_MESH_*
/// bits. The caller frees it with ewa_mesh_free(). Errors (mesh zeroed): EWA_ERROR_ARGUMENT, EWA_ERROR_LIMIT
/// (vertices or triangles over max_points, bytes over max_memory_bytes), EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_mesh_create(ewa_context *context, uint32_t vertex_count, uint32_t triangle_count,
                                   uint32_t material_count, uint32_t streams, ewa_mesh *mesh);

/// Frees streams, materials, textures and attributes and zeroes the struct; accepts NULL and a zeroed struct.
EWA_API void ewa_mesh_free(ewa_mesh *mesh);

/// Gives all triangles one white material with this picture, in place of their materials and vertex colours.
/// The mesh, which has texture coordinates, takes the pixels, and `*picture` is zeroed; both belong to one
/// context. Errors (nothing has changed): EWA_ERROR_ARGUMENT, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_mesh_set_picture(ewa_mesh *mesh, ewa_image *picture);

/// Reads the triangles of a file of any format that ewa_model_load() knows, which says what is read and how.
/// The caller frees `*mesh`, which is zeroed after a failure. Errors: as there, and EWA_ERROR_FORMAT when
/// there are no faces.
EWA_API ewa_status ewa_mesh_load(ewa_context *context, const char *path, ewa_mesh *mesh);

/// Tells whether a mesh bounds a solid: every edge has just two triangles, which go along it in opposite
/// directions. Vertices at the same place are one; triangles with two corners at one place do not count. A
/// mesh without triangles, or with a coordinate of one that is not finite, is not closed. Errors:
/// EWA_ERROR_ARGUMENT (a triangle with a vertex beyond the last), EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_mesh_is_closed(const ewa_mesh *mesh, bool *closed);

/// How a mesh becomes surfels. Fill with ewa_mesh_sample_options_init().
typedef struct ewa_mesh_sample_options {
    size_t struct_size;
    uint64_t point_count;  ///< about how many points; default 100000; not used when spacing_world > 0
    double spacing_world;  ///< square root of the area per point away from edges; 0: from point_count;
                           ///< [0, inf)
    uint64_t seed;         ///< same seed, same bytes; default 1
    double crease_degrees; ///< edges that bend by more are sharp; [0, 180]; default 35
    double radius_scale;   ///< support radius in units of the spacing; [0.5, 10]; default 1.6
    double cutoff;         ///< F: tangent axes are radius / F long; (0, 4]; default 3
    bool clip_lines;       ///< sharp edges and borders become clip lines; default true
    bool smooth_normals;   ///< interpolate normals between triangles that meet in no sharp edge; default true
    ewa_texture_filter texture_filter; ///< how pictures come onto the points; default EWA_TEXTURE_OPTIMAL
    double pixel_sigma_px;             ///< see ewa_acquire_options; [0.3, 8]; default 0.5
    bool texcoords; ///< keep "texcoord", "texcoord_s", "texcoord_t", "texture_part" and with materials
                    ///< "texture" (their number), for ewa_cloud_acquire(); default false
} ewa_mesh_sample_options;

EWA_API extern const ewa_option_table ewa_mesh_sample_options_table;
EWA_API void ewa_mesh_sample_options_init(ewa_mesh_sample_options *options, size_t struct_size);

/// Makes surfels on the triangles of a mesh: a Poisson-disc sampling, even in area, in which no two points of
/// a smooth part are nearer than 0.77 of the spacing; along sharp edges are rows of points on each side, at
/// least 0.62 of the spacing from any other, and a point in each corner, at least 0.4.
///
/// - "position" F32, "normal" F32 (unit), and with vertex colours or materials "color" U8 (sRGB; 4 components
///   where something is not opaque). With pictures "color" is F32, linear, made by ewa_cloud_acquire(), times
///   vertex and base colours; pictures repeat.
/// - Attributes of the vertices, by their names and types: floats interpolated, whole numbers those of the nearest corner;
///   none of a name that this list has.
/// - With sharp edges or borders: "tangent_u", "tangent_v", "clip0", "clip1", "clip_mode". A disc that
///   reaches over an edge of its smooth part gets the line of that edge, at a corner the lines of both; where
///   more edges are in reach (walls thinner than a disc) the nearest two. Otherwise: "radius".
/// - Sharp are edges that bend by more than crease_degrees, edges of one triangle (borders), and edges of
///   more than two. Parts smaller than a point's area, borders of holes shorter than four spacings, and edges
///   with the same smooth part on both sides are not: discs close them.
/// - Vertices at the same place are one. Triangles without area or with coordinates that are not finite are
///   left out. Where a mesh intersects itself, both surfaces stay as they are.
///
/// `options` may be NULL; the caller owns `*cloud`, which is NULL after a failure. The result does not
/// depend on the number of threads. Progress stages: "sample", and those of ewa_cloud_acquire(). Needs about
/// 200 bytes per point meanwhile. Errors: EWA_ERROR_ARGUMENT (message names the member; a triangle with a
/// vertex beyond the last), EWA_ERROR_LIMIT, EWA_ERROR_NUMERIC (no triangle has an area), EWA_ERROR_MEMORY,
/// EWA_CANCELLED. Based on L.-Y. Wei, "Parallel Poisson disk sampling", 2008, section 3 (phase groups), and
/// M. Zwicker et al., "Perspective accurate splatting", 2004, section 4 (clip lines).
EWA_API ewa_status ewa_mesh_sample(const ewa_mesh *mesh, const ewa_mesh_sample_options *options,
                                   ewa_cloud **cloud);

#ifdef __cplusplus
}
#endif
#endif
