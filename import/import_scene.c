// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A scene of Assimp as a PLY mesh. Counts and numbers are looked at before they are used; what reads the PLY
// checks them once more.
#include "import_scene.h"
#include "image/srgb.h"

#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

enum { MAX_DEPTH = 256, MAX_PICTURES = 4096 };

/// Where a node puts its meshes: three rows of an affine map on column vectors.
typedef struct placement {
    double m[3][4];
} placement;

/// One way through the nodes.
typedef struct scene_walk {
    const struct aiScene *scene;
    FILE *file;
    enum { WALK_COUNT, WALK_VERTICES, WALK_FACES } pass;
    uint64_t vertex_count, face_count;
    bool texcoords;                 ///< of some mesh
    uint32_t picture[MAX_PICTURES]; ///< number of the picture by material, or UINT32_MAX
    const char *problem;
} scene_walk;

static placement placement_in(const placement *above, const struct aiMatrix4x4 *own) {
    const double rows[3][4] = {{(double)own->a1, (double)own->a2, (double)own->a3, (double)own->a4},
                               {(double)own->b1, (double)own->b2, (double)own->b3, (double)own->b4},
                               {(double)own->c1, (double)own->c2, (double)own->c3, (double)own->c4}};
    placement made;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++) {
            made.m[r][c] = c == 3 ? above->m[r][3] : 0;
            for (int k = 0; k < 3; k++) made.m[r][c] += above->m[r][k] * rows[k][c];
        }
    return made;
}

static bool mirrors(const placement *at) {
    const double(*m)[4] = at->m;
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
               m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]) <
           0;
}

/// The name of a material's picture; false when it has none in a file of its own.
static bool picture_of(const struct aiScene *scene, uint32_t material, struct aiString *name) {
    static const enum aiTextureType kinds[] = {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE};
    for (int k = 0; k < 2; k++)
        if (aiGetMaterialTexture(scene->mMaterials[material], kinds[k], 0, name, NULL, NULL, NULL, NULL, NULL,
                                 NULL) == aiReturn_SUCCESS &&
            name->length > 0 && name->length < sizeof name->data && name->data[0] != '*')
            return true;
    return false;
}

static float linear_of(double srgb) { return (float)ewa_srgb_decode(srgb > 0 ? (srgb < 1 ? srgb : 1) : 0); }

/// The diffuse colour of a material, white where a picture stands for it.
static void color_of(const scene_walk *walk, uint32_t material, float color[4]) {
    struct aiColor4D given;
    struct aiString name = {0};
    for (int c = 0; c < 4; c++) color[c] = 1;
    if (material >= walk->scene->mNumMaterials || !walk->scene->mMaterials[material]) return;
    // What Assimp makes up where a file has none is grey.
    if (aiGetMaterialString(walk->scene->mMaterials[material], AI_MATKEY_NAME, &name) == aiReturn_SUCCESS &&
        strncmp(name.data, AI_DEFAULT_MATERIAL_NAME, sizeof name.data) == 0)
        return;
    if (material < MAX_PICTURES && walk->picture[material] != UINT32_MAX) return;
    if (aiGetMaterialColor(walk->scene->mMaterials[material], AI_MATKEY_COLOR_DIFFUSE, &given) !=
        aiReturn_SUCCESS)
        return;
    color[0] = linear_of((double)given.r);
    color[1] = linear_of((double)given.g);
    color[2] = linear_of((double)given.b);
}

/// One vertex as it lies in the file: no padding between.
static void write_vertex(scene_walk *walk, const struct aiMesh *mesh, uint32_t index, const placement *at,
                         const float base[4]) {
    const struct aiVector3D *p = &mesh->mVertices[index];
    double place[3];
    float look[4] = {base[0], base[1], base[2], base[3]}, texcoord[2] = {0, 0};
    for (int r = 0; r < 3; r++)
        place[r] = at->m[r][0] * (double)p->x + at->m[r][1] * (double)p->y + at->m[r][2] * (double)p->z +
                   at->m[r][3];
    if (mesh->mTextureCoords[0]) {
        texcoord[0] = mesh->mTextureCoords[0][index].x;
        texcoord[1] = mesh->mTextureCoords[0][index].y;
    }
    if (mesh->mColors[0]) {
        const struct aiColor4D *color = &mesh->mColors[0][index];
        look[0] *= linear_of((double)color->r);
        look[1] *= linear_of((double)color->g);
        look[2] *= linear_of((double)color->b);
    }
    fwrite(place, sizeof place, 1, walk->file);
    if (walk->texcoords) fwrite(texcoord, sizeof texcoord, 1, walk->file);
    fwrite(look, sizeof look, 1, walk->file);
}

static void write_face(scene_walk *walk, const struct aiMesh *mesh, const struct aiFace *face, bool turned) {
    const uint8_t count = 3;
    uint32_t corners[3];
    const int32_t picture =
        mesh->mMaterialIndex < MAX_PICTURES && walk->picture[mesh->mMaterialIndex] != UINT32_MAX
            ? (int32_t)walk->picture[mesh->mMaterialIndex]
            : -1;
    for (int c = 0; c < 3; c++)
        corners[c] = (uint32_t)walk->vertex_count + face->mIndices[turned ? 2 - c : c];
    fwrite(&count, sizeof count, 1, walk->file);
    fwrite(corners, sizeof corners, 1, walk->file);
    fwrite(&picture, sizeof picture, 1, walk->file);
}

static void visit_mesh(scene_walk *walk, const struct aiMesh *mesh, const placement *at) {
    float base[4];
    const bool turned = mirrors(at);
    if (walk->pass == WALK_VERTICES) {
        color_of(walk, mesh->mMaterialIndex, base);
        for (uint32_t v = 0; v < mesh->mNumVertices; v++) write_vertex(walk, mesh, v, at, base);
    }
    for (uint32_t f = 0; f < mesh->mNumFaces; f++) {
        const struct aiFace *face = &mesh->mFaces[f];
        if (face->mNumIndices != 3 || !face->mIndices) continue;
        if (walk->pass == WALK_FACES) write_face(walk, mesh, face, turned);
        walk->face_count += walk->pass == WALK_COUNT;
    }
    walk->vertex_count += mesh->mNumVertices;
    walk->texcoords = walk->texcoords || mesh->mTextureCoords[0];
}

static void visit_node(scene_walk *walk, const struct aiNode *node, const placement *above, uint32_t depth) {
    if (!node || walk->problem) return;
    if (depth > MAX_DEPTH) {
        walk->problem = "its nodes are nested too deep";
        return;
    }
    const placement at = placement_in(above, &node->mTransformation);
    for (unsigned i = 0; node->mMeshes && i < node->mNumMeshes; i++) {
        const struct aiMesh *mesh =
            node->mMeshes[i] < walk->scene->mNumMeshes ? walk->scene->mMeshes[node->mMeshes[i]] : NULL;
        if (!mesh || !mesh->mVertices || (mesh->mNumFaces && !mesh->mFaces)) continue;
        visit_mesh(walk, mesh, &at);
    }
    for (unsigned i = 0; node->mChildren && i < node->mNumChildren; i++)
        visit_node(walk, node->mChildren[i], &at, depth + 1);
}

/// Names the pictures, one line each, and numbers them by material.
static void write_pictures(scene_walk *walk) {
    uint32_t count = 0;
    memset(walk->picture, 0xff, sizeof walk->picture);
    for (uint32_t m = 0; m < walk->scene->mNumMaterials && m < MAX_PICTURES; m++) {
        struct aiString name = {0};
        if (!walk->scene->mMaterials[m] || !picture_of(walk->scene, m, &name)) continue;
        for (uint32_t i = 0; i < name.length; i++)
            if ((unsigned char)name.data[i] < ' ') name.data[i] = '?';
        fprintf(walk->file, "comment TextureFile %.*s\n", (int)name.length, name.data);
        walk->picture[m] = count++;
    }
}

const char *import_write_scene(const struct aiScene *scene, FILE *file) {
    static const placement identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    static scene_walk walk; // large
    walk = (scene_walk){.scene = scene, .file = file, .pass = WALK_COUNT};
    visit_node(&walk, scene->mRootNode, &identity, 0);
    if (walk.problem) return walk.problem;
    if (!walk.face_count) return "there are no faces";
    if (walk.vertex_count > UINT32_MAX) return "it has too many vertices";
    fprintf(file, "ply\nformat binary_%s_endian 1.0\n",
            __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__ ? "big" : "little");
    write_pictures(&walk);
    fprintf(
        file,
        "element vertex %llu\nproperty double x\nproperty double y\nproperty double z\n%s"
        "property float red\nproperty float green\nproperty float blue\nproperty float alpha\n"
        "element face %llu\nproperty list uchar uint vertex_indices\nproperty int texnumber\nend_header\n",
        (unsigned long long)walk.vertex_count, walk.texcoords ? "property float s\nproperty float t\n" : "",
        (unsigned long long)walk.face_count);
    walk.pass = WALK_VERTICES;
    visit_node(&walk, scene->mRootNode, &identity, 0);
    walk.pass = WALK_FACES;
    walk.vertex_count = 0;
    visit_node(&walk, scene->mRootNode, &identity, 0);
    return fflush(file) == 0 && !ferror(file) ? NULL : "the mesh cannot be handed back";
}
