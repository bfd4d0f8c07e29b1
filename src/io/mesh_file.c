// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Meshes through Assimp's C interface. Nothing that it returns is believed: counts, indices and names are
// checked again before they are used.
#include "base/base.h"
#include "ewa/io.h"
#include "ewa/mesh.h"
#include "image/srgb.h"
#include "io/file.h"

#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { PATH_BYTES = 4096, MAX_MATERIALS = 4096, MAX_DEPTH = 256 };

/// Where a node puts its meshes: three rows of an affine map on column vectors.
typedef struct placement {
    double m[3][4];
} placement;

/// One way through the nodes of a scene, and what has been met.
typedef struct scene_walk {
    ewa_context *context;
    const char *path;
    const struct aiScene *scene;
    ewa_mesh *mesh; ///< to fill; NULL: counts only
    bool linear_colors;
    uint64_t vertices, triangles;
    bool colors, texcoords;
} scene_walk;

static placement placement_in(const placement *above, const struct aiMatrix4x4 *own) {
    const double rows[4][4] = {{(double)own->a1, (double)own->a2, (double)own->a3, (double)own->a4},
                               {(double)own->b1, (double)own->b2, (double)own->b3, (double)own->b4},
                               {(double)own->c1, (double)own->c2, (double)own->c3, (double)own->c4},
                               {0, 0, 0, 1}};
    placement made = {{{0}}};
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++) {
            made.m[r][c] = c == 3 ? above->m[r][3] : 0;
            for (int k = 0; k < 3; k++) made.m[r][c] += above->m[r][k] * rows[k][c];
        }
    return made;
}

static double determinant(const placement *at) {
    const double(*m)[4] = at->m;
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

static bool has_suffix(const char *path, const char *suffix) {
    const size_t length = strlen(path), suffix_length = strlen(suffix);
    return length > suffix_length && strcasecmp(path + length - suffix_length, suffix) == 0;
}

static bool has_mesh_suffix(const char *path) {
    static const char *const suffixes[] = {".obj", ".ply", ".stl", ".gltf", ".glb"};
    for (size_t i = 0; i < sizeof suffixes / sizeof suffixes[0]; i++)
        if (has_suffix(path, suffixes[i])) return true;
    return false;
}

static void ignore_line(void *user, const char *line) {
    (void)user;
    (void)line;
}

static bool is_regular(const char *path, uint64_t *size_bytes) {
    struct stat information;
    if (stat(path, &information) != 0 || !S_ISREG(information.st_mode)) return false;
    *size_bytes = (uint64_t)information.st_size;
    return true;
}

/// Whether every face has only vertices that its mesh has. Assimp's own further steps rely on it, and some of
/// its readers do not.
static ewa_status check_faces(ewa_context *context, const char *path, const struct aiScene *scene) {
    for (unsigned m = 0; m < scene->mNumMeshes; m++) {
        const struct aiMesh *mesh = scene->mMeshes ? scene->mMeshes[m] : NULL;
        if (!mesh || (mesh->mNumVertices && !mesh->mVertices) || (mesh->mNumFaces && !mesh->mFaces))
            return ewa_fail(context, EWA_ERROR_FORMAT, "%s: mesh %u has no data", path, m);
        for (unsigned f = 0; f < mesh->mNumFaces; f++) {
            const struct aiFace *face = &mesh->mFaces[f];
            for (unsigned c = 0; c < face->mNumIndices; c++)
                if (!face->mIndices || face->mIndices[c] >= mesh->mNumVertices)
                    return ewa_fail(context, EWA_ERROR_FORMAT,
                                    "%s: face %u of mesh %u has vertex %u, there are %u", path, f, m,
                                    face->mIndices ? face->mIndices[c] : 0, mesh->mNumVertices);
        }
    }
    return EWA_OK;
}

static float unit_or(float value, float otherwise) {
    if (!(value >= 0)) return otherwise; // NaN too
    return value < 1 ? value : 1;
}

static float linear_of(float srgb) { return (float)ewa_srgb_decode(unit_or(srgb, 0)); }

/// Copies one mesh behind the first `vertex` vertices and `triangle` triangles; a placement that mirrors
/// turns its triangles, so that they stay counter-clockwise seen from outside.
static void copy_mesh(const struct aiMesh *from, const placement *at, bool linear_colors, uint32_t vertex,
                      uint32_t triangle, ewa_mesh *to) {
    for (uint32_t i = 0; i < from->mNumVertices; i++) {
        float *position = to->positions + 3 * (size_t)(vertex + i);
        const double p[3] = {(double)from->mVertices[i].x, (double)from->mVertices[i].y,
                             (double)from->mVertices[i].z};
        for (int c = 0; c < 3; c++)
            position[c] = (float)(at->m[c][0] * p[0] + at->m[c][1] * p[1] + at->m[c][2] * p[2] + at->m[c][3]);
        if (to->texcoords && from->mTextureCoords[0]) {
            to->texcoords[2 * (size_t)(vertex + i)] = from->mTextureCoords[0][i].x;
            to->texcoords[2 * (size_t)(vertex + i) + 1] = from->mTextureCoords[0][i].y;
        }
        if (!to->colors) continue;
        float *color = to->colors + 4 * (size_t)(vertex + i);
        const struct aiColor4D *given = from->mColors[0] ? &from->mColors[0][i] : NULL;
        const float values[3] = {given ? given->r : 1, given ? given->g : 1, given ? given->b : 1};
        for (int c = 0; c < 3; c++) color[c] = linear_colors ? unit_or(values[c], 0) : linear_of(values[c]);
        color[3] = given ? unit_or(given->a, 1) : 1;
    }
    const bool mirrors = determinant(at) < 0;
    for (uint32_t f = 0; f < from->mNumFaces; f++) {
        const struct aiFace *face = &from->mFaces[f];
        if (face->mNumIndices != 3) continue;
        for (uint32_t c = 0; c < 3; c++)
            to->triangles[3 * (size_t)triangle + c] = vertex + face->mIndices[mirrors ? 2 - c : c];
        if (to->triangle_materials)
            to->triangle_materials[triangle] =
                from->mMaterialIndex < to->material_count ? from->mMaterialIndex : 0;
        triangle++;
    }
}

/// Goes through the nodes: counts what their meshes come to and, with a mesh to fill, copies it.
static ewa_status visit_node(scene_walk *walk, const struct aiNode *node, const placement *above,
                             uint32_t depth) {
    if (!node) return EWA_OK;
    if (depth > MAX_DEPTH)
        return ewa_fail(walk->context, EWA_ERROR_LIMIT, "%s: more than %d nodes in each other", walk->path,
                        MAX_DEPTH);
    const placement at = placement_in(above, &node->mTransformation);
    for (unsigned i = 0; node->mMeshes && i < node->mNumMeshes; i++) {
        if (node->mMeshes[i] >= walk->scene->mNumMeshes)
            return ewa_fail(walk->context, EWA_ERROR_FORMAT, "%s: a node has mesh %u, there are %u",
                            walk->path, node->mMeshes[i], walk->scene->mNumMeshes);
        const struct aiMesh *mesh = walk->scene->mMeshes[node->mMeshes[i]];
        uint32_t triangles = 0;
        for (unsigned f = 0; f < mesh->mNumFaces; f++) triangles += mesh->mFaces[f].mNumIndices == 3;
        if (!triangles) continue;
        if (walk->mesh)
            copy_mesh(mesh, &at, walk->linear_colors, (uint32_t)walk->vertices, (uint32_t)walk->triangles,
                      walk->mesh);
        walk->vertices += mesh->mNumVertices;
        walk->triangles += triangles;
        walk->colors = walk->colors || mesh->mColors[0];
        walk->texcoords = walk->texcoords || mesh->mTextureCoords[0];
    }
    for (unsigned i = 0; node->mChildren && i < node->mNumChildren; i++) {
        const ewa_status status = visit_node(walk, node->mChildren[i], &at, depth + 1);
        if (status != EWA_OK) return status;
    }
    return EWA_OK;
}

/// The picture that a path like "*0" or the name of an embedded one means; NULL: a file of its own.
static const struct aiTexture *find_embedded(const struct aiScene *scene, const char *name) {
    unsigned index = 0;
    char end = 0;
    if (sscanf(name, "*%u%c", &index, &end) == 1)
        return scene->mTextures && index < scene->mNumTextures ? scene->mTextures[index] : NULL;
    for (unsigned i = 0; scene->mTextures && i < scene->mNumTextures; i++)
        if (scene->mTextures[i] && scene->mTextures[i]->mFilename.length &&
            strcmp(scene->mTextures[i]->mFilename.data, name) == 0)
            return scene->mTextures[i];
    return NULL;
}

/// Path of a picture beside the mesh. Absolute paths and such that climb are cut to their last name, so that
/// a mesh cannot have other files read.
static bool find_beside(const char *mesh_path, const char *name, char path[PATH_BYTES]) {
    char relative[PATH_BYTES];
    const size_t length = strlen(name);
    if (!length || length >= sizeof relative) return false;
    for (size_t i = 0; i <= length; i++) relative[i] = name[i] == '\\' ? '/' : name[i];
    const char *used = relative;
    const char *slash = strrchr(relative, '/');
    if (slash &&
        (relative[0] == '/' || relative[1] == ':' || strstr(relative, "..") || strstr(relative, "://")))
        used = slash + 1;
    const char *folder_end = strrchr(mesh_path, '/');
    const int folder = folder_end ? (int)(folder_end - mesh_path) + 1 : 0;
    const int printed = snprintf(path, PATH_BYTES, "%.*s%s", folder, mesh_path, used);
    return *used && printed > 0 && printed < PATH_BYTES;
}

/// Reads the picture of a material; one that cannot be had is a warning, and the base colour stays.
static void load_texture(ewa_context *context, const char *path, const struct aiScene *scene,
                         const char *name, ewa_image *texture) {
    const struct aiTexture *embedded = find_embedded(scene, name);
    char file[PATH_BYTES];
    uint64_t size_bytes = 0;
    ewa_status status = EWA_OK;
    if (embedded || name[0] == '*') {
        if (!embedded || embedded->mHeight != 0 || !embedded->pcData) {
            ewa_report(context, EWA_SEVERITY_WARNING,
                       "%s: the embedded picture %s is missing or has no file format; left out", path, name);
            return;
        }
        snprintf(file, sizeof file, "%s: embedded picture", path);
        status = ewa_image_load_memory(context, embedded->pcData, embedded->mWidth, file, texture);
    } else if (!find_beside(path, name, file) || !is_regular(file, &size_bytes)) {
        ewa_report(context, EWA_SEVERITY_WARNING, "%s: the picture '%.200s' is not beside the mesh; left out",
                   path, name);
        return;
    } else {
        status = ewa_image_load(context, file, texture);
    }
    const uint32_t channels = status == EWA_OK ? texture->channel_count : 0;
    if (status == EWA_OK && (channels == 1 || channels == 3 || channels == 4)) return;
    ewa_report(context, EWA_SEVERITY_WARNING, "%s: the picture '%.200s' cannot be used; left out", path,
               name);
    ewa_image_free(texture);
}

static void load_materials(const char *path, const struct aiScene *scene, bool linear_colors,
                           ewa_mesh *mesh) {
    for (uint32_t i = 0; i < mesh->material_count; i++) {
        ewa_mesh_material *material = &mesh->materials[i];
        const struct aiMaterial *from = scene->mMaterials[i];
        for (int c = 0; c < 4; c++) material->base_color[c] = 1;
        if (!from) continue;
        struct aiString name = {0};
        bool textured = false;
        static const enum aiTextureType kinds[] = {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE};
        for (int k = 0; k < 2 && mesh->texcoords && !textured; k++)
            textured = aiGetMaterialTexture(from, kinds[k], 0, &name, NULL, NULL, NULL, NULL, NULL, NULL) ==
                           aiReturn_SUCCESS &&
                       name.length > 0 && memchr(name.data, 0, sizeof name.data);
        if (textured) load_texture(mesh->context, path, scene, name.data, &material->texture);
        struct aiColor4D color;
        if (aiGetMaterialColor(from, AI_MATKEY_COLOR_DIFFUSE, &color) == aiReturn_SUCCESS) {
            const float values[3] = {color.r, color.g, color.b};
            // In OBJ files a texture replaces Kd; in glTF it is multiplied with the factor.
            for (int c = 0; c < 3; c++)
                if (linear_colors || !material->texture.pixels)
                    material->base_color[c] = linear_colors ? unit_or(values[c], 1) : linear_of(values[c]);
            material->base_color[3] = unit_or(color.a, 1);
        }
    }
}

/// Whether some material says more than "grey": Assimp gives every mesh at least a default one.
static bool materials_matter(const struct aiScene *scene) {
    for (unsigned i = 0; scene->mMaterials && i < scene->mNumMaterials; i++) {
        const struct aiMaterial *material = scene->mMaterials[i];
        struct aiString name = {0};
        if (!material) continue;
        const bool is_default = aiGetMaterialString(material, AI_MATKEY_NAME, &name) != aiReturn_SUCCESS ||
                                strncmp(name.data, AI_DEFAULT_MATERIAL_NAME, sizeof name.data) == 0 ||
                                name.length == 0;
        if (!is_default || aiGetMaterialTextureCount(material, aiTextureType_DIFFUSE) > 0 ||
            aiGetMaterialTextureCount(material, aiTextureType_BASE_COLOR) > 0)
            return true;
    }
    return false;
}

static ewa_status take_scene(ewa_context *context, const char *path, const struct aiScene *scene,
                             ewa_mesh *mesh) {
    static const placement identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    scene_walk walk = {.context = context, .path = path, .scene = scene};
    walk.linear_colors = has_suffix(path, ".gltf") || has_suffix(path, ".glb");
    ewa_status status = visit_node(&walk, scene->mRootNode, &identity, 0);
    if (status != EWA_OK) return status;
    if (!walk.triangles) return ewa_fail(context, EWA_ERROR_FORMAT, "%s: no triangles in the file", path);
    if (walk.vertices > UINT32_MAX || walk.triangles > UINT32_MAX)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%s: %llu vertices and %llu triangles, 4294967295 can be",
                        path, (unsigned long long)walk.vertices, (unsigned long long)walk.triangles);
    const uint32_t materials = materials_matter(scene) ? scene->mNumMaterials : 0;
    if (materials > MAX_MATERIALS)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%s: %u materials, %d can be", path, materials,
                        MAX_MATERIALS);
    const uint32_t streams =
        (walk.colors ? EWA_MESH_COLORS : 0u) | (walk.texcoords ? EWA_MESH_TEXCOORDS : 0u);
    status =
        ewa_mesh_create(context, (uint32_t)walk.vertices, (uint32_t)walk.triangles, materials, streams, mesh);
    if (status != EWA_OK) return status;
    walk.mesh = mesh;
    walk.vertices = walk.triangles = 0;
    status = visit_node(&walk, scene->mRootNode, &identity, 0);
    if (status == EWA_OK) load_materials(path, scene, walk.linear_colors, mesh);
    return status;
}

/// Whether some face has more than three corners.
static bool has_polygons(const struct aiScene *scene) {
    for (unsigned m = 0; m < scene->mNumMeshes; m++)
        for (unsigned f = 0; f < scene->mMeshes[m]->mNumFaces; f++)
            if (scene->mMeshes[m]->mFaces[f].mNumIndices > 3) return true;
    return false;
}

ewa_status ewa_mesh_load(ewa_context *context, const char *path, ewa_mesh *mesh) {
    if (!context || !path || !mesh) return EWA_ERROR_ARGUMENT;
    *mesh = (ewa_mesh){0};
    if (!has_mesh_suffix(path))
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: the suffix is none of .obj .ply .stl .gltf .glb",
                        path);
    // Opening it first gives the system's own reason when that fails, which Assimp does not.
    ewa_file file = {0};
    ewa_status status = ewa_file_map(context, path, &file);
    if (status != EWA_OK) return status;
    const uint64_t size_bytes = file.size_bytes;
    ewa_file_unmap(context, &file);
    if (size_bytes > ewa_context_limits(context)->max_memory_bytes)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%s: %llu bytes, max_memory_bytes is %llu", path,
                        (unsigned long long)size_bytes,
                        (unsigned long long)ewa_context_limits(context)->max_memory_bytes);
    uint64_t regular_bytes = 0;
    if (!is_regular(path, &regular_bytes))
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: a mesh has to be a file, no pipe", path);
    // Assimp's reader of PLY trusts its header; ours does not.
    if (has_suffix(path, ".ply")) status = ewa_ply_describe(context, path, ignore_line, NULL);
    if (status != EWA_OK) return status;
    const struct aiScene *scene = aiImportFile(path, 0);
    if (!scene) return ewa_fail(context, EWA_ERROR_FORMAT, "%s: %s", path, aiGetErrorString());
    status = check_faces(context, path, scene);
    if (status == EWA_OK && has_polygons(scene)) {
        // After a failure of a further step the scene is freed, and NULL.
        scene = aiApplyPostProcessing(scene, aiProcess_Triangulate);
        status = scene ? check_faces(context, path, scene)
                       : ewa_fail(context, EWA_ERROR_FORMAT, "%s: %s", path, aiGetErrorString());
    }
    if (status == EWA_OK) status = take_scene(context, path, scene, mesh);
    if (scene) aiReleaseImport(scene);
    if (status != EWA_OK) ewa_mesh_free(mesh);
    return status;
}
