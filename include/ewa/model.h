// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files of points or triangles, whichever they hold: a file that has faces is a mesh.
#ifndef EWA_MODEL_H
#define EWA_MODEL_H

#include "ewa/base.h"
#include "ewa/cloud.h"
#include "ewa/io.h"
#include "ewa/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum ewa_model_format {
    EWA_MODEL_UNKNOWN = 0,
    EWA_MODEL_PLY,
    EWA_MODEL_OBJ,
    EWA_MODEL_STL,
    EWA_MODEL_OFF,
    EWA_MODEL_GLTF, ///< .gltf and .glb
    EWA_MODEL_LAS,  ///< LAS, LAZ and COPC
    EWA_MODEL_E57,
    EWA_MODEL_PCD,
    EWA_MODEL_PTX,
    EWA_MODEL_TEXT, ///< XYZ, PTS, CSV: numbers in columns
    EWA_MODEL_GRID, ///< ASCII grid: heights of cells
    EWA_MODEL_TIFF, ///< TIFF with heights of cells (GeoTIFF)
    EWA_MODEL_TERRAIN, ///< picture with heights in its colours (ewa_cloud_load_options.heights)
    EWA_MODEL_VTK,     ///< polygons, and the surface of cells and grids; grids of voxels are volumes
} ewa_model_format;

/// Returns "PLY", "OBJ", "STL", "OFF", "glTF", "LAS", "E57", "PCD", "PTX", "text", "ASCII grid", "GeoTIFF",
/// "terrain picture", "VTK" or "unknown".
EWA_API const char *ewa_model_format_name(ewa_model_format format);

/// Says which format a regular file has, by its content; EWA_MODEL_UNKNOWN: none that is read here. Errors:
/// EWA_ERROR_IO.
EWA_API ewa_status ewa_model_probe(ewa_context *context, const char *path, ewa_model_format *format);

/// What ewa_model_load() is asked for.
enum {
    EWA_MODEL_MESH = 1u << 0,     ///< the triangles, if there are faces
    EWA_MODEL_POINTS = 1u << 1,   ///< the points also where there are faces, whose vertices they are
    EWA_MODEL_ELEMENTS = 1u << 2, ///< the faces, of PLY all else that is no vertex, to be written as PLY
};

/// What a file holds. Zero-initialise; free with ewa_model_free().
typedef struct ewa_model {
    ewa_model_format format;
    uint64_t lost_count;    ///< points lost to damage (`keep_going`)
    uint64_t face_count;    ///< faces and strips in the file, before polygons are cut
    ewa_mesh mesh;          ///< no triangles: not asked for, or there are no faces
    ewa_cloud *points;      ///< the caller may take it, and set this to NULL
    ewa_elements *elements; ///< NULL: none; the caller may take it
} ewa_model;

/// Reads a file of points or triangles, the format by content: PLY, OBJ (with MTL), STL, OFF, glTF and GLB, VTK (legacy and XML).
/// Clouds of every format that ewa_cloud_load() knows are read as there, by `options` (may be NULL).
/// `wanted` are EWA_MODEL_* bits; without EWA_MODEL_POINTS, `points` are made only where there are no faces.
/// "-" reads standard input.
///
/// - Faces: polygons become triangles, also concave ones; strips and fans too; nodes are put into place.
///   Faces with a vertex that is not there are counted, said in a warning, and left out; lines and points
///   beside faces as well. Coordinates keep every digit. Where triangles have a coordinate that is not
///   finite, that is said.
/// - Colours: of vertices, else of faces; integers and the text of OBJ and OFF are sRGB, floats of PLY and
///   glTF linear. Materials are their diffuse or base colour and its picture. In OBJ the picture stands for
///   the colour.
/// - Pictures are of every format that ewa_image_load() reads, in the file or in files that it names. These,
///   and material libraries and buffers, must be regular files below the file's folder when links are
///   resolved; of names that are absolute or lead elsewhere, the last part is tried beside the file. A
///   picture or library that is missing or broken is left out with a warning that names it.
///
/// `*model` is zeroed after a failure. Errors: EWA_ERROR_IO, EWA_ERROR_FORMAT (with the place; no face can be
/// used), EWA_ERROR_UNSUPPORTED (format, required extensions of glTF), EWA_ERROR_LIMIT, EWA_ERROR_MEMORY,
/// EWA_CANCELLED.
EWA_API ewa_status ewa_model_load(ewa_context *context, const char *path, uint32_t wanted,
                                  const ewa_cloud_load_options *options, ewa_model *model);

/// The same from `size_bytes` bytes in memory; `name` stands for the file in messages. Files that they name
/// lie below the folder of `path`; NULL: they are not read.
EWA_API ewa_status ewa_model_load_memory(ewa_context *context, const void *bytes, size_t size_bytes,
                                         const char *name, const char *path, uint32_t wanted,
                                         const ewa_cloud_load_options *options, ewa_model *model);

/// Frees what the model still holds and zeroes the struct; accepts NULL and a zeroed struct.
EWA_API void ewa_model_free(ewa_model *model);

#ifdef __cplusplus
}
#endif
#endif
