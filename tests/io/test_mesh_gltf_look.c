// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Materials of glTF: colours, pictures and where they lie, alpha, extensions.
#include "io/gltf_check.h"
#include "io/mesh_fixture.h"

/// The rectangle with two sets of texture coordinates and one material.
#define TEXTURED(material, textures, images)                                                                 \
    GLTF_HEAD(GLTF_NODE)                                                                                     \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1,\"TEXCOORD_1\":2},"       \
    "\"mode\":6,\"material\":0}]}],"                                                                         \
    "\"materials\":[" material "],\"textures\":[" textures "],\"images\":[" images "],"                      \
    "\"accessors\":[" GLTF_POSITIONS                                                                         \
    ",{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"                              \
    "{\"bufferView\":2,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"}],"                              \
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":32},"  \
    "{\"buffer\":0,\"byteOffset\":80,\"byteLength\":32}],\"buffers\":[{\"byteLength\":112}]"

static glb textured(const char *json) {
    glb g = {.size = 0};
    static const float uv[8] = {0, 0, 1, 0, 1, 1, 0, 1},
                       other[8] = {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f};
    put_floats(&g, 12, gltf_square);
    put_floats(&g, 8, uv);
    put_floats(&g, 8, other);
    snprintf(g.json, sizeof g.json, "%s", json);
    return g;
}

/// A red pixel.
#define RED_PNG                                                                                              \
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z8AAAAMBAQDJ/"        \
    "pLvAAAAAElFTkSuQmCC"

CASE(test_materials) {
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    glb g = textured(TEXTURED("{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.25,1,0.5],"
                              "\"baseColorTexture\":{\"index\":0}}}",
                              "{\"source\":0}", "{\"uri\":\"" RED_PNG "\"}") "}");
    glb_load(context, &messages, &g, false, &mesh);
    const ewa_mesh_material *material = mesh_material(&mesh, 0);
    // Linear, times the picture; opaque, whatever alpha says.
    assert_true(material->base_color[0] == 0.5f && material->base_color[1] == 0.25f &&
                material->base_color[3] == 1);
    assert_true(mesh_texture(&mesh, 0)->pixels[0] == 1 && mesh_texture(&mesh, 0)->pixels[1] == 0);
    assert_true(mesh.texcoords[2 * mesh_corner(&mesh, 0, 0, 0, 0) + 1] == 1);
    ewa_mesh_free(&mesh);
    g = textured(
        TEXTURED("{\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,0.5],"
                 "\"baseColorTexture\":{\"index\":0,\"texCoord\":1}}}",
                 "{\"source\":0}", "{\"uri\":\"" RED_PNG "\"}") "}");
    glb_load(context, &messages, &g, false, &mesh);
    assert_true(mesh_material(&mesh, 0)->base_color[3] == 0.5f && mesh.texcoords[0] == 0.5f &&
                mesh.texcoords[1] == 0.5f);
    ewa_mesh_free(&mesh);
    // Offset, rotation and scale of the picture, from the upper left there.
    g = textured(TEXTURED("{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,\"extensions\":{"
                          "\"KHR_texture_transform\":"
                          "{\"offset\":[0.25,0.5],\"scale\":[2,4],\"rotation\":1.5707963267948966}}}}}",
                          "{\"source\":0}",
                          "{\"uri\":\"" RED_PNG
                          "\"}") ",\"extensionsRequired\":[\"KHR_texture_transform\"]}");
    glb_load(context, &messages, &g, false, &mesh);
    // (1, 0) there: scaled (2, 0), turned (0, -2), moved (0.25, -1.5); ours from below.
    const uint32_t second = mesh_corner(&mesh, 0, 2, 0, 0);
    assert_float_equal(mesh.texcoords[2 * second], 0.25, 1e-6);
    assert_float_equal(mesh.texcoords[2 * second + 1], 2.5, 1e-6);
    ewa_mesh_free(&mesh);
    g = textured(
        TEXTURED("{\"extensions\":{\"KHR_materials_pbrSpecularGlossiness\":{\"diffuseFactor\":[0,1,0,1]}}}",
                 "", "") "}");
    glb_load(context, &messages, &g, false, &mesh);
    assert_true(mesh_material(&mesh, 0)->base_color[0] == 0 && mesh_material(&mesh, 0)->base_color[1] == 1);
}

/// Alpha of pictures: kept where it blends, dropped where the material is opaque, cut where it is a mask.
CASE(test_alpha) {
    char path[512];
    ewa_mesh mesh;
    const uint8_t pixels[8] = {255, 0, 0, 51, 0, 255, 0, 204};
    assert_int_equal(ewa_png_save(context, scratch_path("gltf_alpha.png", path), 2, 1, 4, pixels, 8), EWA_OK);
    static const struct {
        const char *mode;
        uint32_t channels;
        float first[4], second[4];
    } cases[] = {{"", 3, {1, 0, 0, 0}, {0, 1, 0, 0}},
                 {"\"alphaMode\":\"MASK\",", 4, {0, 0, 0, 0}, {0, 1, 0, 1}},
                 {"\"alphaMode\":\"MASK\",\"alphaCutoff\":0.1,", 4, {1, 0, 0, 1}, {0, 1, 0, 1}},
                 {"\"alphaMode\":\"BLEND\",", 4, {0.2f, 0, 0, 0.2f}, {0, 0.8f, 0, 0.8f}}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char json[4096];
        uint8_t file[16384];
        snprintf(json, sizeof json, "%s",
                 TEXTURED("{@\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}",
                          "{\"source\":0}", "{\"uri\":\"gltf_alpha.png\"}") "}");
        char *at = strchr(json, '@'), rest[4096];
        snprintf(rest, sizeof rest, "%s", at + 1);
        snprintf(at, sizeof json - (size_t)(at - json), "%s%s", cases[i].mode, rest);
        const glb g = textured(json);
        scratch_write(scratch_path("alpha.glb", path), file, glb_bytes(&g, file));
        assert_int_equal(ewa_mesh_load(context, path, &mesh), EWA_OK);
        const ewa_image *picture = mesh_texture(&mesh, 0);
        assert_int_equal(picture->channel_count, cases[i].channels);
        for (uint32_t c = 0; c < cases[i].channels; c++) {
            assert_float_equal(picture->pixels[c], cases[i].first[c], 1e-6);
            assert_float_equal(picture->pixels[cases[i].channels + c], cases[i].second[c], 1e-6);
        }
        ewa_mesh_free(&mesh);
    }
    assert_string_equal(messages.text, "");
}

/// Materials with one picture have it once, whatever is done with alpha, where it has none.
CASE(test_shared) {
    OWNED(ewa_mesh_free) ewa_mesh mesh;
#define PART(material)                                                                                       \
    "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"mode\":6,\"material\":" material "}"
#define LOOK(mode) "{\"alphaMode\":\"" mode "\",\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}"
    glb g = {.size = 0};
    snprintf(g.json, sizeof g.json, "%s",
             GLTF_HEAD(GLTF_NODE) "\"meshes\":[{\"primitives\":[" PART("0") "," PART("1") "," PART("2") "]}],"
             "\"materials\":[" LOOK("OPAQUE") "," LOOK("MASK") "," LOOK("BLEND") "],\"textures\":[{\"source\":0}],"
             "\"images\":[{\"uri\":\"" RED_PNG "\"}],\"accessors\":[" GLTF_POSITIONS ","
             "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"}]," GLTF_VIEW);
    put_floats(&g, 12, gltf_square);
    glb_load(context, &messages, &g, false, &mesh);
    assert_int_equal(mesh.material_count, 3);
    assert_non_null(mesh.textures[0].pixels);
    for (uint32_t m = 1; m < 3; m++) {
        assert_int_equal(mesh.materials[m].texture, 0);
        assert_null(mesh.textures[m].pixels);
    }
}

/// A WebP picture of one blue pixel.
#define BLUE_WEBP                                                                                            \
    "data:image/webp;base64,UklGRjgAAABXRUJQVlA4ICwAAACQAQCdASoBAAEAAgA0JaACdLoAA5gA/vmTb/+QH/+QH/+QH/"      \
    "8gP+IXeyAwAA=="

CASE(test_extensions) {
    ewa_mesh mesh;
    glb g = textured(TEXTURED(
        "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}",
        "{\"extensions\":{\"EXT_texture_webp\":{\"source\":0}}}",
        "{\"uri\":\"" BLUE_WEBP
        "\"}") ",\"extensionsRequired\":[\"EXT_texture_webp\"],\"extensionsUsed\":[\"EXT_texture_webp\"]}");
    glb_load(context, &messages, &g, false, &mesh);
    const float *pixel = mesh_texture(&mesh, 0)->pixels;
    assert_true(pixel[0] < 0.02f && pixel[1] < 0.02f && pixel[2] > 0.95f);
    ewa_mesh_free(&mesh);
    g = textured(TEXTURED("{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}",
                          "{\"extensions\":{\"KHR_texture_basisu\":{\"source\":0}}}",
                          "{\"uri\":\"a.ktx2\"}") ",\"extensionsRequired\":[\"KHR_texture_basisu\"]}");
    glb_load(context, &messages, &g, true, &mesh);
    mesh_says(&messages, "KTX2 (KHR_texture_basisu) is not read");
    ewa_mesh_free(&mesh);
    static const char *const unknown[] = {"KHR_mesh_primitive_restart", "EXT_mesh_gpu_instancing"};
    for (int i = 0; i < 2; i++) {
        char json[4096];
        snprintf(json, sizeof json, "%s,\"extensionsRequired\":[\"KHR_mesh_quantization\",\"%s\"]}",
                 TEXTURED("", "", ""), unknown[i]);
        g = textured(json);
        glb_refuse(context, &messages, &g, EWA_ERROR_UNSUPPORTED, unknown[i]);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
