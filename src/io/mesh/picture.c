// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures of meshes: each is read once, whatever number of materials has it; one that is missing or broken
// is a warning, and the mesh comes without.
#include "base/base.h"
#include "base/unpacking.h"
#include "io/image/image_file.h"
#include "io/mesh/build.h"
#include "io/referenced_file.h"

#include <stdio.h>

enum {
    NAMED_PICTURES = 5, // further ones that are missing are counted
    COLORS = 3,
};

/// Finds what was asked for before: the same picture, whose alpha counts only where it has one.
static bool find_known(const ewa_mesh_build *build, const ewa_mesh_picture *wanted, uint32_t *picture) {
    const ewa_mesh_picture *pictures = build->pictures.items;
    *picture = EWA_MESH_NONE;
    for (uint64_t i = 0; i < build->pictures.count; i++) {
        const ewa_mesh_picture *known = &pictures[i];
        if (known->beside != wanted->beside || known->name_bytes != wanted->name_bytes ||
            memcmp(known->name, wanted->name, known->name_bytes) != 0 ||
            (known->has_alpha && (known->alpha != wanted->alpha || known->limit != wanted->limit)))
            continue;
        *picture = known->image.pixels ? (uint32_t)i : EWA_MESH_NONE;
        return true;
    }
    return false;
}

/// Keeps what is asked for; the image is empty then.
static ewa_status add_entry(ewa_mesh_build *build, const ewa_mesh_picture *wanted, ewa_mesh_picture **entry) {
    char *copy = ewa_allocate(build->context, wanted->name_bytes, 1);
    if (!copy) return EWA_ERROR_MEMORY;
    if (wanted->name_bytes) memcpy(copy, wanted->name, wanted->name_bytes);
    ewa_status status = EWA_OK;
    *entry = ewa_mesh_list_add(build, &build->pictures, &status);
    if (*entry) {
        **entry = *wanted;
        (*entry)->name = copy;
    } else {
        ewa_release(build->context, copy, wanted->name_bytes, 1);
    }
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
static ewa_status decode(ewa_mesh_build *build, const uint8_t *bytes, size_t size_bytes,
                         ewa_mesh_picture *entry) {
    const ewa_mesh_alpha alpha = entry->alpha;
    const ewa_text name = {entry->name, entry->name_bytes};
    char label[512], quote[EWA_QUOTE_BYTES];
    snprintf(label, sizeof label, "%.400s: picture %s", build->source->name, ewa_quote(name, quote));
    ewa_failures_soften(build->context, true);
    ewa_memory_unpacked_before(build->context, build->packed_picture_bytes, build->picture_bytes);
    ewa_status status =
        ewa_image_decode(build->context, bytes, size_bytes, label, alpha != EWA_MESH_ALPHA_KEEP, &entry->image);
    ewa_memory_unpacked_before(build->context, 0, 0);
    ewa_failures_soften(build->context, false);
    if (status == EWA_ERROR_MEMORY) return status;
    const uint32_t channels = entry->image.channel_count;
    build->packed_picture_bytes += size_bytes;
    // A grey one counts as if it were coloured, for its smaller copies are (image/texture.h).
    build->picture_bytes +=
        (uint64_t)entry->image.width_px * entry->image.height_px * (channels > COLORS ? channels : COLORS) * sizeof(float);
    if (status != EWA_OK || (channels != 1 && channels != 3 && channels != 4)) {
        ewa_image_free(&entry->image);
        ewa_mesh_miss_picture(build, name,
                              status == EWA_OK ? "its channels are no colours" : "it cannot be read");
        return EWA_OK;
    }
    entry->has_alpha = channels == 4;
    if (channels == 4 && alpha == EWA_MESH_ALPHA_CUT) cut_alpha(&entry->image, entry->limit);
    return channels == 4 && alpha == EWA_MESH_ALPHA_DROP ? drop_alpha(&entry->image) : EWA_OK;
}

static ewa_mesh_picture make_wanted(ewa_text name, bool beside, ewa_mesh_alpha alpha, double limit) {
    return (ewa_mesh_picture){.name = (char *)(uintptr_t)name.chars,
                              .name_bytes = name.length,
                              .beside = beside,
                              .alpha = alpha,
                              .limit = alpha == EWA_MESH_ALPHA_CUT ? limit : 0};
}

ewa_status ewa_mesh_decode_picture(ewa_mesh_build *build, ewa_text name, const uint8_t *bytes,
                                   size_t size_bytes, ewa_mesh_alpha alpha, double limit, uint32_t *picture) {
    const ewa_mesh_picture wanted = make_wanted(name, false, alpha, limit);
    if (find_known(build, &wanted, picture)) return EWA_OK;
    ewa_mesh_picture *entry;
    EWA_TRY(add_entry(build, &wanted, &entry));
    EWA_TRY(decode(build, bytes, size_bytes, entry));
    if (entry->image.pixels) *picture = (uint32_t)(build->pictures.count - 1);
    return EWA_OK;
}

ewa_status ewa_mesh_find_picture(ewa_mesh_build *build, ewa_text name, ewa_mesh_alpha alpha, double limit,
                                 uint32_t *picture) {
    const ewa_mesh_picture wanted = make_wanted(name, true, alpha, limit);
    if (find_known(build, &wanted, picture)) return EWA_OK;
    ewa_mesh_picture *entry;
    EWA_TRY(add_entry(build, &wanted, &entry));
    char reason[EWA_REASON_BYTES];
    ewa_file file;
    ewa_status status = EWA_OK;
    if (!build->source->path) {
        ewa_mesh_miss_picture(build, name, "the mesh is no file that pictures could lie beside");
    } else if (!ewa_referenced_file_map(build->context, build->source->path, name, &file, reason)) {
        ewa_mesh_miss_picture(build, name, reason);
    } else {
        status = decode(build, file.bytes, file.size_bytes, entry);
        ewa_file_unmap(build->context, &file);
    }
    if (status == EWA_OK && entry->image.pixels) *picture = (uint32_t)(build->pictures.count - 1);
    return status;
}
