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
    const char **names; ///< by which the file of cameras names them
    uint32_t count, capacity;
};

/// Copies a text; NULL where there is no memory.
static char *copy_text(ewa_context *context, const char *text) {
    const size_t bytes = strlen(text) + 1;
    char *copy = ewa_allocate(context, bytes, 1);
    if (copy) memcpy(copy, text, bytes);
    return copy;
}

static void free_text(ewa_context *context, const char *text) {
    if (text) ewa_release(context, (void *)text, strlen(text) + 1, 1);
}

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
    ewa_photo *photo = &list->photos[list->count];
    *photo = (ewa_photo){.camera = *camera, .lens = *lens, .path = copy_text(list->context, found)};
    list->names[list->count++] = copy_text(list->context, name);
    return photo->path && list->names[list->count - 1] ? EWA_OK : EWA_ERROR_MEMORY;
}

ewa_status ewa_photo_list_load(ewa_context *context, const char *path, const char *images, ewa_photo_list **list) {
    if (list) *list = NULL;
    if (!context || !path || !list) return EWA_ERROR_ARGUMENT;
    char base[EWA_PATH_BYTES];
    if (!find_base(path, images, base)) return ewa_fail(context, EWA_ERROR_IO, "%s: the path is too long", path);
    ewa_camera_list cameras = {.context = context, .name = path, .takes_lenses = true};
    ewa_photo_list *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    ewa_status status = made ? ewa_camera_list_read(&cameras, path) : EWA_ERROR_MEMORY;
    if (made) made->context = context;
    if (status == EWA_OK) {
        made->capacity = (uint32_t)cameras.count;
        made->photos = ewa_allocate(context, made->capacity, sizeof *made->photos);
        made->names = ewa_allocate(context, made->capacity, sizeof *made->names);
        status = made->photos && made->names ? EWA_OK : EWA_ERROR_MEMORY;
    }
    for (size_t i = 0; i < cameras.count && status == EWA_OK; i++)
        status = add(made, path, base, images != NULL, &cameras.cameras[i], &cameras.lenses[i],
                     cameras.pictures[i]);
    if (status == EWA_OK)
        *list = made;
    else
        ewa_photo_list_destroy(&made);
    ewa_camera_list_free(&cameras);
    return status;
}

/// Finds the mask of a photograph of that name; false where there is none.
static bool find_mask(const ewa_photo_list *list, const char *base, const char *name, char found[EWA_PATH_BYTES]) {
    static const char *const suffixes[] = {".png", ".jpg", ".JPG", ".jpeg"};
    const char *slash = strrchr(name, '/'), *last = slash ? slash + 1 : name, *dot = strrchr(last, '.');
    const char *const starts[] = {name, last};
    char whole[EWA_PATH_BYTES], reason[EWA_REASON_BYTES];
    for (size_t i = 0; i < 2; i++) {
        const int all = (int)strlen(starts[i]), stem = dot ? (int)(dot - starts[i]) : all;
        int length = snprintf(whole, sizeof whole, "%s.png", starts[i]);
        if (length < EWA_PATH_BYTES && ewa_referenced_file_find(list->context, base, whole, false, found, reason)) return true;
        for (size_t k = 0; k < sizeof suffixes / sizeof suffixes[0]; k++) {
            length = snprintf(whole, sizeof whole, "%.*s%s", stem, starts[i], suffixes[k]);
            if (length < EWA_PATH_BYTES && ewa_referenced_file_find(list->context, base, whole, false, found, reason))
                return true;
        }
    }
    return false;
}

ewa_status ewa_photo_list_find_masks(ewa_photo_list *list, const char *folder) {
    if (!list || !folder) return EWA_ERROR_ARGUMENT;
    char base[EWA_PATH_BYTES], found[EWA_PATH_BYTES];
    const int length = snprintf(base, sizeof base, "%s/.", folder);
    if (length < 0 || length >= EWA_PATH_BYTES)
        return ewa_fail(list->context, EWA_ERROR_IO, "%s: the path is too long", folder);
    uint32_t without = 0;
    const char *example = NULL;
    for (uint32_t i = 0; i < list->count; i++) {
        ewa_photo *photo = &list->photos[i];
        free_text(list->context, photo->mask_path);
        photo->mask_path = NULL;
        if (!find_mask(list, base, list->names[i], found)) {
            if (without++ == 0) example = list->names[i];
            continue;
        }
        photo->mask_path = copy_text(list->context, found);
        if (!photo->mask_path) return EWA_ERROR_MEMORY;
    }
    char quote[EWA_QUOTE_BYTES];
    if (!without) return EWA_OK;
    ewa_quote((ewa_text){example, strlen(example)}, quote);
    if (without == list->count)
        return ewa_fail(list->context, EWA_ERROR_IO, "%s: there is no mask of %s nor of any other of %u photographs", folder,
                        quote, without);
    ewa_report(list->context, EWA_SEVERITY_WARNING, "%s: %u of %u photographs have no mask (%s is one), and count as a whole",
               folder, without, list->count, quote);
    return EWA_OK;
}

const ewa_photo *ewa_photo_list_photos(const ewa_photo_list *list, uint32_t *count) {
    if (count) *count = list ? list->count : 0;
    return list ? list->photos : NULL;
}

void ewa_photo_list_destroy(ewa_photo_list **list) {
    if (!list || !*list) return;
    ewa_photo_list *from = *list;
    for (uint32_t i = 0; i < from->count; i++) {
        free_text(from->context, from->photos[i].path);
        free_text(from->context, from->photos[i].mask_path);
        free_text(from->context, from->names[i]);
    }
    ewa_release(from->context, from->photos, from->capacity, sizeof *from->photos);
    ewa_release(from->context, from->names, from->capacity, sizeof *from->names);
    ewa_release(from->context, from, 1, sizeof *from);
    *list = NULL;
}
