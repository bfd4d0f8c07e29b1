// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The readers of meshes, one per format: each fills a build from the bytes of a file. All errors are those of
// parsers: EWA_ERROR_FORMAT with the place, EWA_ERROR_UNSUPPORTED, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY,
// EWA_CANCELLED.
#ifndef EWA_SRC_MESH_FORMATS_H
#define EWA_SRC_MESH_FORMATS_H

#include "ewa/model.h"
#include "io/mesh/build.h"

/// Finds the format by content; the suffix of `name` decides where content does not.
ewa_model_format ewa_mesh_probe(const char *name, const uint8_t *bytes, size_t size_bytes);

/// Makes places and faces of what a PLY file holds.
ewa_status ewa_mesh_read_ply(ewa_mesh_build *build, const ewa_cloud *vertices, const ewa_elements *elements);

ewa_status ewa_mesh_read_obj(ewa_mesh_build *build);
ewa_status ewa_mesh_read_stl(ewa_mesh_build *build);
ewa_status ewa_mesh_read_off(ewa_mesh_build *build);
ewa_status ewa_mesh_read_gltf(ewa_mesh_build *build);
ewa_status ewa_mesh_read_vtk(ewa_mesh_build *build);
ewa_status ewa_mesh_read_vtk_xml(ewa_mesh_build *build);
ewa_status ewa_mesh_read_vtk_list(ewa_mesh_build *build);

/// Adds the pieces of one of VTK's XML files, `name` in messages.
ewa_status ewa_mesh_read_vtk_pieces(ewa_mesh_build *build, const char *name, const uint8_t *bytes, size_t size_bytes);

/// Whether bytes begin like a legacy VTK file of polygons, cells or places, not of voxels.
bool ewa_mesh_is_vtk(const uint8_t *bytes, size_t size_bytes);

/// The same of VTK's XML files.
bool ewa_mesh_is_vtk_xml(const uint8_t *bytes, size_t size_bytes);

/// Whether bytes are one of VTK's lists of such files.
bool ewa_mesh_is_vtk_list(const uint8_t *bytes, size_t size_bytes);

/// Materials by name, of OBJ files.
typedef struct ewa_mtl ewa_mtl;

/// Reads the material libraries that one `mtllib` line names and adds what they hold to `*materials`, which
/// is NULL at first. A library that cannot be had is a warning. Free with ewa_mtl_free().
ewa_status ewa_mtl_read(ewa_mesh_build *build, ewa_text names, ewa_mtl **materials);

/// The look of the one material in the library that is called like the mesh, for meshes that name none; EWA_MESH_NONE
/// when there is no such file, or more than one material in it.
ewa_status ewa_mtl_look_of_own(ewa_mesh_build *build, ewa_mtl **materials, uint32_t *look);

/// The look of a material, made when it is asked for first; `*look` is EWA_MESH_NONE when no library has it.
ewa_status ewa_mtl_look(ewa_mesh_build *build, ewa_mtl *materials, ewa_text name, uint32_t *look);
void ewa_mtl_free(ewa_mesh_build *build, ewa_mtl **materials);

#endif
