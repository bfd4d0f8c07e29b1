// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures of meshes: each is read once, whatever number of materials has it; one that is missing or broken
// is a warning, and the mesh comes without.
#include "base/base.h"
#include "io/image/image_file.h"
#include "io/mesh/build.h"
#include "io/mesh/referenced_file.h"

#include <stdio.h>

enum { NAMED_PICTURES = 5 }; // further ones that are missing are counted

static bool find_known(const ewa_mesh_build *build, ewa_text key, uint32_t *picture) {
    const ewa_mesh_picture *pictures = build->pictures.items;
    for (uint64_t i = 0; i < build->pictures.count; i++)
        if (pictures[i].key_bytes == key.length && memcmp(pictures[i].key, key.chars, key.length) == 0) {
            *picture = pictures[i].image.pixels ? (uint32_t)i : EWA_MESH_NONE;
            return true;
        }
    return false;
}

/// Keeps an entry under a key; the image is empty then.
static ewa_status add_entry(ewa_mesh_build *build, ewa_text key, ewa_mesh_picture **entry) {
    char *copy = ewa_allocate(build->context, key.length, 1);
    if (!copy) return EWA_ERROR_MEMORY;
    if (key.length) memcpy(copy, key.chars, key.length);
    ewa_status status = EWA_OK;
    *entry = ewa_mesh_list_add(build, &build->pictures, &status);
    if (*entry)
        **entry = (ewa_mesh_picture){.key = copy, .key_bytes = key.length};
    else
        ewa_release(build->context, copy, key.length, 1);
    return status;
}

void ewa_mesh_miss_picture(ewa_mesh_build *build, ewa_text name, const char *reason) {
    char quote[EWA_QUOTE_BYTES];
    if (build->missing_count++ < NAMED_PICTURES)
        ewa_report(build->context, EWA_SEVERITY_WARNING, "%s: the picture %s is left out: %s",
                   build->source->name, ewa_quote(name, quote), reason);
}

/// Makes alpha 0 or 1; the colours are not multiplied by it.
static void cut_alpha(ewa_image *image, double limit) {
    const size_t count = (size_t)image->width_px * image->height_px;
    for (size_t i = 0; i < count; i++) {
        float *pixel = image->pixels + 4 * i;
        const bool keep = (double)pixel[3] >= limit;
        for (int c = 0; c < 3 && !keep; c++) pixel[c] = 0;
        pixel[3] = keep;
    }
}

/// Replaces a picture by its colours only.
static ewa_status drop_alpha(ewa_image *image) {
    ewa_image colors;
    const size_t count = (size_t)image->width_px * image->height_px;
    EWA_TRY(ewa_image_create(image->context, image->width_px, image->height_px, 3, &colors));
    for (size_t i = 0; i < count; i++)
        memcpy(colors.pixels + 3 * i, image->pixels + 4 * i, 3 * sizeof(float));
    ewa_image_free(image);
    *image = colors;
    return EWA_OK;
}

/// Decodes into an entry. What is wrong with the picture is a warning, not a failure of the mesh.
static ewa_status decode(ewa_mesh_build *build, ewa_text name, const uint8_t *bytes, size_t size_bytes,
                         ewa_mesh_alpha alpha, double limit, ewa_mesh_picture *entry) {
    char label[512], quote[EWA_QUOTE_BYTES];
    snprintf(label, sizeof label, "%.400s: picture %s", build->source->name, ewa_quote(name, quote));
    ewa_failures_soften(build->context, true);
    const ewa_status status = ewa_image_decode(build->context, bytes, size_bytes, label,
                                               alpha != EWA_MESH_ALPHA_KEEP, &entry->image);
    ewa_failures_soften(build->context, false);
    if (status == EWA_ERROR_MEMORY) return status;
    const uint32_t channels = entry->image.channel_count;
    if (status != EWA_OK || (channels != 1 && channels != 3 && channels != 4)) {
        ewa_image_free(&entry->image);
        ewa_mesh_miss_picture(build, name,
                              status == EWA_OK ? "its channels are no colours" : "it cannot be read");
        return EWA_OK;
    }
    const uint64_t limit_bytes = ewa_context_limits(build->context)->max_memory_bytes;
    build->picture_bytes +=
        (uint64_t)entry->image.width_px * entry->image.height_px * channels * sizeof(float);
    if (build->picture_bytes > limit_bytes)
        return ewa_fail(build->context, EWA_ERROR_LIMIT,
                        "%s: the pictures need %llu bytes together, max_memory_bytes is %llu",
                        build->source->name, (unsigned long long)build->picture_bytes,
                        (unsigned long long)limit_bytes);
    if (channels == 4 && alpha == EWA_MESH_ALPHA_CUT) cut_alpha(&entry->image, limit);
    return channels == 4 && alpha == EWA_MESH_ALPHA_DROP ? drop_alpha(&entry->image) : EWA_OK;
}

/// Appends to a key what is done with alpha, so that one picture may be had in several ways.
static size_t make_key(ewa_text name, ewa_mesh_alpha alpha, double limit, char *key, size_t room) {
    if (name.length >= room - 40) return 0;
    memcpy(key, name.chars, name.length);
    if (alpha == EWA_MESH_ALPHA_KEEP) return name.length;
    return name.length + (size_t)snprintf(key + name.length, room - name.length, "|%d|%.9g", (int)alpha,
                                          alpha == EWA_MESH_ALPHA_CUT ? limit : 0.0);
}

ewa_status ewa_mesh_decode_picture(ewa_mesh_build *build, ewa_text name, const uint8_t *bytes,
                                   size_t size_bytes, ewa_mesh_alpha alpha, double limit, uint32_t *picture) {
    char key[512];
    const size_t length = make_key(name, alpha, limit, key, sizeof key);
    const ewa_text text = {key, length};
    *picture = EWA_MESH_NONE;
    if (find_known(build, text, picture)) return EWA_OK;
    ewa_mesh_picture *entry;
    EWA_TRY(add_entry(build, text, &entry));
    EWA_TRY(decode(build, name, bytes, size_bytes, alpha, limit, entry));
    if (entry->image.pixels) *picture = (uint32_t)(build->pictures.count - 1);
    return EWA_OK;
}

ewa_status ewa_mesh_find_picture(ewa_mesh_build *build, ewa_text name, ewa_mesh_alpha alpha, double limit,
                                 uint32_t *picture) {
    char key[4096 + 64], reason[EWA_REASON_BYTES] = "its name is too long";
    const ewa_text text = {key, make_key(name, alpha, limit, key, sizeof key)};
    *picture = EWA_MESH_NONE;
    if (find_known(build, text, picture)) return EWA_OK;
    ewa_mesh_picture *entry;
    EWA_TRY(add_entry(build, text, &entry));
    ewa_file file;
    ewa_status status = EWA_OK;
    if (!build->source->path) {
        ewa_mesh_miss_picture(build, name, "the mesh is no file that pictures could lie beside");
    } else if (!text.length || !ewa_referenced_file_map(build->source->path, name, &file, reason)) {
        ewa_mesh_miss_picture(build, name, reason);
    } else {
        status = decode(build, name, file.bytes, file.size_bytes, alpha, limit, entry);
        ewa_file_unmap(build->context, &file);
    }
    if (status == EWA_OK && entry->image.pixels) entry->name_bytes = name.length;
    if (status == EWA_OK && entry->image.pixels) *picture = (uint32_t)(build->pictures.count - 1);
    return status;
}
