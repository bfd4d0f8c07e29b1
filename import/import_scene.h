// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A scene of Assimp as a PLY mesh.
#ifndef EWA_IMPORT_SCENE_H
#define EWA_IMPORT_SCENE_H

#include <assimp/scene.h>
#include <stdio.h>

/// Writes all triangles of a scene, put into place by its nodes, as binary PLY: doubles, linear colours,
/// texture coordinates and the names of pictures. Returns NULL, or what is wrong.
const char *import_write_scene(const struct aiScene *scene, FILE *file);

#endif
