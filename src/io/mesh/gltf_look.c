// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Materials of glTF: base colour, its picture, what alpha means, and where the picture lies on the surface.
//
// Based on: "glTF 2.0 Specification", sections 3.8 (textures) and 3.9 (materials), and the extensions
// KHR_texture_transform, EXT_texture_webp, KHR_materials_pbrSpecularGlossiness.
#include "base/base.h"
#include "io/mesh/gltf.h"

#include <math.h>
#include <stdio.h>

/// Number of the image of a texture, or UINT64_MAX with a reason.
static uint64_t image_of(const gltf *g, uint64_t texture, const char **reason) {
    *reason = "there is no such texture";
    if (texture >= g->textures.count) return UINT64_MAX;
    const cJSON *item = g->textures.items[texture];
    uint64_t image;
    if (ewa_gltf_count(ewa_gltf_extension(item, "EXT_texture_webp"), "source", UINT64_MAX, &image) &&
        image < g->images.count)
        return image;
    *reason = ewa_gltf_extension(item, "KHR_texture_basisu") ? "KTX2 (KHR_texture_basisu) is not read"
                                                             : "its texture names no image";
    return ewa_gltf_count(item, "source", UINT64_MAX, &image) && image < g->images.count ? image : UINT64_MAX;
}

static ewa_status read_image(gltf *g, uint64_t index, ewa_mesh_alpha alpha, double limit, uint32_t *picture) {
    const cJSON *image = g->images.items[index], *uri = ewa_gltf_member(image, "uri");
    char label[32];
    const ewa_text name = {label,
                           (size_t)snprintf(label, sizeof label, "image %llu", (unsigned long long)index)};
    ewa_status status = EWA_OK;
    *picture = EWA_MESH_NONE;
    if (cJSON_IsString(uri) && strncmp(uri->valuestring, "data:", 5) != 0) {
        char path[4096];
        if (ewa_gltf_path_of(uri->valuestring, path, sizeof path))
            return ewa_mesh_find_picture(g->build, (ewa_text){path, strlen(path)}, alpha, limit, picture);
        ewa_mesh_miss_picture(g->build, name, "its name is too long");
        return EWA_OK;
    }
    uint8_t *decoded = NULL;
    const uint8_t *bytes = NULL;
    size_t room = 0, decoded_bytes = 0;
    uint64_t view, size_bytes = 0, stride;
    if (cJSON_IsString(uri)) {
        status = ewa_gltf_decode_uri(g, "images", index, uri->valuestring, &decoded, &room, &decoded_bytes);
        bytes = decoded;
        size_bytes = decoded_bytes;
    } else if (ewa_gltf_count(image, "bufferView", UINT64_MAX, &view) && view != UINT64_MAX) {
        status = ewa_gltf_view(g, view, &bytes, &size_bytes, &stride);
    } else {
        ewa_mesh_miss_picture(g->build, name, "it has neither a uri nor a buffer view");
        return EWA_OK;
    }
    if (status == EWA_OK)
        status = ewa_mesh_decode_picture(g->build, name, bytes, (size_t)size_bytes, alpha, limit, picture);
    ewa_release(g->build->context, decoded, room, 1);
    return status;
}

/// Fills the map of a look from KHR_texture_transform, which acts on (u, v) from the upper left; ours are
/// from the lower left. May name another set of texture coordinates.
static void read_transform(const cJSON *info, ewa_mesh_look *look, uint64_t *texcoord_set) {
    const cJSON *transform = ewa_gltf_extension(info, "KHR_texture_transform");
    double offset[2] = {0, 0}, scale[2] = {1, 1}, rotation = 0;
    const cJSON *angle = ewa_gltf_member(transform, "rotation");
    if (!transform || !ewa_gltf_numbers(transform, "offset", 2, offset) ||
        !ewa_gltf_numbers(transform, "scale", 2, scale))
        return;
    if (cJSON_IsNumber(angle)) rotation = angle->valuedouble;
    uint64_t set;
    if (ewa_gltf_count(transform, "texCoord", *texcoord_set, &set)) *texcoord_set = set;
    const double c = cos(rotation), s = sin(rotation);
    const double m[2][3] = {{scale[0] * c, scale[1] * s, offset[0]},
                            {-scale[0] * s, scale[1] * c, offset[1]}};
    const double map[2][3] = {{m[0][0], -m[0][1], m[0][1] + m[0][2]},
                              {-m[1][0], m[1][1], 1 - m[1][1] - m[1][2]}};
    memcpy(look->map, map, sizeof map);
    look->mapped = true;
}

ewa_mesh_alpha ewa_gltf_alpha(const gltf *g, uint64_t material) {
    const cJSON *mode = ewa_gltf_member(g->materials.items[material], "alphaMode");
    if (cJSON_IsString(mode) && strcmp(mode->valuestring, "MASK") == 0) return EWA_MESH_ALPHA_CUT;
    if (cJSON_IsString(mode) && strcmp(mode->valuestring, "BLEND") == 0) return EWA_MESH_ALPHA_KEEP;
    return EWA_MESH_ALPHA_DROP;
}

ewa_status ewa_gltf_look(gltf *g, uint64_t material, uint32_t *look, uint64_t *texcoord_set) {
    if (material >= g->materials.count)
        return ewa_gltf_fail(g, "materials", material, "there is no such one");
    const cJSON *item = g->materials.items[material];
    const cJSON *base = ewa_gltf_member(item, "pbrMetallicRoughness"),
                *older = ewa_gltf_extension(item, "KHR_materials_pbrSpecularGlossiness");
    const cJSON *info = ewa_gltf_member(older ? older : base, older ? "diffuseTexture" : "baseColorTexture");
    const bool known = g->looks[material] != EWA_MESH_NONE;
    if (!known) EWA_TRY(ewa_mesh_add_look(g->build, &g->looks[material]));
    *look = g->looks[material];
    ewa_mesh_look made = *ewa_mesh_look_at(g->build, *look);
    if (!ewa_gltf_count(info, "texCoord", 0, texcoord_set)) *texcoord_set = 0;
    read_transform(info, &made, texcoord_set);
    if (known) return EWA_OK;
    double factor[4] = {1, 1, 1, 1}, limit = 0.5;
    if (!ewa_gltf_numbers(older ? older : base, older ? "diffuseFactor" : "baseColorFactor", 4, factor))
        return ewa_gltf_fail(g, "materials", material, "its factor is no array of 4 numbers");
    const cJSON *cutoff = ewa_gltf_member(item, "alphaCutoff");
    const ewa_mesh_alpha alpha = ewa_gltf_alpha(g, material);
    if (cJSON_IsNumber(cutoff)) limit = cutoff->valuedouble;
    for (int c = 0; c < 3; c++) made.base_color[c] = factor[c] >= 0 ? (float)fmin(factor[c], 1) : 1;
    made.base_color[3] = alpha == EWA_MESH_ALPHA_KEEP && factor[3] >= 0 ? (float)fmin(factor[3], 1) : 1;
    if (alpha == EWA_MESH_ALPHA_CUT && factor[3] > 0) limit /= factor[3];
    uint64_t texture;
    if (info && ewa_gltf_count(info, "index", UINT64_MAX, &texture)) {
        const char *reason;
        const uint64_t image = image_of(g, texture, &reason);
        char label[32];
        const ewa_text name = {
            label, (size_t)snprintf(label, sizeof label, "of texture %llu", (unsigned long long)texture)};
        if (image == UINT64_MAX)
            ewa_mesh_miss_picture(g->build, name, reason);
        else
            EWA_TRY(read_image(g, image, alpha, limit, &made.picture));
    }
    *ewa_mesh_look_at(g->build, *look) = made;
    return EWA_OK;
}
