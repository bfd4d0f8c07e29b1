// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Photographs that files of cameras name: where they are.
#include "base/base.h"
#include "base/platform.h"
#include "ewa/io.h"
#include "io/camera/file.h"
#include "io/referenced_file.h"

#include <stdio.h>
#include <string.h>

struct ewa_photo_list {
    ewa_context *context;
    ewa_photo *photos;
    uint32_t count;
};

/// Writes a place in the folder that names are relative to; false where the path is too long.
static bool find_base(const char *path, const char *images, char base[EWA_PATH_BYTES]) {
    static const char *const places[] = {"images", "../images", "../../images"};
    int length = snprintf(base, EWA_PATH_BYTES, "%s%s", images ? images : path, images ? "/." : "");
    if (!images && ewa_camera_is_folder(path)) {
        length = snprintf(base, EWA_PATH_BYTES, "%s/.", path);
        for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
            char folder[EWA_PATH_BYTES];
            const int there = snprintf(folder, sizeof folder, "%s/%s", path, places[i]);
            if (there < 0 || there >= EWA_PATH_BYTES - 2 || !ewa_camera_is_folder(folder)) continue;
            length = snprintf(base, EWA_PATH_BYTES, "%s/.", folder);
            break;
        }
    }
    return length > 0 && length < EWA_PATH_BYTES;
}

/// Finds the file of a name, which may lack its suffix; in a folder that somebody chose also by its last part.
/// Errors: EWA_ERROR_IO.
static ewa_status find_picture(ewa_context *context, const char *path, const char *base, bool chosen, const char *name,
                               char found[EWA_PATH_BYTES]) {
    static const char *const suffixes[] = {"", ".png", ".jpg", ".JPG", ".jpeg"};
    char reason[EWA_REASON_BYTES] = "", first[EWA_REASON_BYTES] = "", quote[EWA_QUOTE_BYTES];
    const char *slash = strrchr(name, '/');
    for (size_t i = 0; i < 2 * sizeof suffixes / sizeof suffixes[0]; i++) {
        if (i % 2 && !(chosen && slash)) continue;
        char whole[EWA_PATH_BYTES];
        const int length = snprintf(whole, sizeof whole, "%s%s", i % 2 ? slash + 1 : name, suffixes[i / 2]);
        if (length > 0 && length < (int)sizeof whole &&
            ewa_referenced_file_find(context, base, whole, false, found, reason))
            return EWA_OK;
        if (i == 0) memcpy(first, reason, sizeof first);
    }
    return ewa_fail(context, EWA_ERROR_IO, "%s: the photograph %s: %s", path,
                    ewa_quote((ewa_text){name, strlen(name)}, quote), first);
}

static ewa_status add(ewa_photo_list *list, const char *path, const char *base, bool chosen, const ewa_camera *camera,
                      const ewa_lens *lens, const char *name) {
    char found[EWA_PATH_BYTES];
    if (!name)
        return ewa_fail(list->context, EWA_ERROR_FORMAT, "%s: camera %u has no name of a photograph", path, list->count);
    EWA_TRY(find_picture(list->context, path, base, chosen, name, found));
    const size_t bytes = strlen(found) + 1;
    char *copy = ewa_allocate(list->context, bytes, 1);
    if (!copy) return EWA_ERROR_MEMORY;
    memcpy(copy, found, bytes);
    list->photos[list->count++] = (ewa_photo){.camera = *camera, .lens = *lens, .path = copy};
    return EWA_OK;
}

ewa_status ewa_photo_list_load(ewa_context *context, const char *path, const char *images, ewa_photo_list **list) {
    if (list) *list = NULL;
    if (!context || !path || !list) return EWA_ERROR_ARGUMENT;
    char base[EWA_PATH_BYTES];
    if (!find_base(path, images, base)) return ewa_fail(context, EWA_ERROR_IO, "%s: the path is too long", path);
    ewa_camera_list cameras = {.context = context, .name = path, .takes_lenses = true};
    ewa_photo_list *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    ewa_status status = made ? ewa_camera_list_read(&cameras, path) : EWA_ERROR_MEMORY;
    if (status == EWA_OK) {
        made->context = context;
        made->photos = ewa_allocate(context, cameras.count, sizeof *made->photos);
        status = made->photos ? EWA_OK : EWA_ERROR_MEMORY;
    }
    for (size_t i = 0; i < cameras.count && status == EWA_OK; i++)
        status = add(made, path, base, images != NULL, &cameras.cameras[i], &cameras.lenses[i],
                     cameras.pictures[i]);
    if (made && made->photos && status != EWA_OK) {
        for (uint32_t i = 0; i < made->count; i++)
            ewa_release(context, (void *)made->photos[i].path, strlen(made->photos[i].path) + 1, 1);
        ewa_release(context, made->photos, cameras.count, sizeof *made->photos);
    }
    if (status == EWA_OK)
        *list = made;
    else
        ewa_release(context, made, 1, sizeof *made);
    ewa_camera_list_free(&cameras);
    return status;
}

const ewa_photo *ewa_photo_list_photos(const ewa_photo_list *list, uint32_t *count) {
    if (count) *count = list ? list->count : 0;
    return list ? list->photos : NULL;
}

void ewa_photo_list_destroy(ewa_photo_list **list) {
    if (!list || !*list) return;
    ewa_photo_list *from = *list;
    for (uint32_t i = 0; i < from->count; i++)
        ewa_release(from->context, (void *)from->photos[i].path, strlen(from->photos[i].path) + 1, 1);
    ewa_release(from->context, from->photos, from->count, sizeof *from->photos);
    ewa_release(from->context, from, 1, sizeof *from);
    *list = NULL;
}
