// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours of points from photographs: found on the loading thread, written to a file of our own until they are saved, from which the
// item is loaded again, so that pictures are those of what `ewa photos` writes. Steps back and forth load the one file or the other.
#include "inner.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool photos_is_changed(const viewer *v, size_t index) { return own_files_has(v, v->items[index].load.colored); }

/// Whether an item has points that can be coloured; says why not.
static bool has_points(viewer *v, size_t index) {
    ewa_asset_info info = {.kind = EWA_ASSET_VOLUME};
    if (v->items[index].asset) ewa_asset_describe(v->items[index].asset, &info);
    const bool fine = info.kind == EWA_ASSET_POINTS || info.kind == EWA_ASSET_MESH || info.kind == EWA_ASSET_OCTREE;
    if (!fine) viewer_tell(v, "photos: %s has no points, or is not loaded yet", v->items[index].name);
    return fine;
}

/// Has an item loaded from a file of coloured points, or from its own where that is empty.
static bool apply(viewer *v, size_t index, const char *path) {
    item_load load = v->items[index].load;
    memset(load.colored, 0, sizeof load.colored);
    snprintf(load.colored, sizeof load.colored, "%s", path);
    return items_reload(v, index, &load);
}

/// Takes what is behind a word off the end of a text, `*length` of which count. False: the name is too long.
static bool take_folder(const char *text, const char *word, size_t *length, char folder[VIEWER_PATH_BYTES]) {
    const char *at = strstr(text, word);
    if (!at || at >= text + *length) return true;
    const char *name = at + strlen(word);
    const size_t name_length = *length - (size_t)(name - text);
    *length = (size_t)(at - text);
    if (name_length >= VIEWER_PATH_BYTES) return false;
    memcpy(folder, name, name_length);
    return true;
}

/// Orders the colours; `text`: cameras, behind " images " the folder of the photographs, behind " masks " that of their masks.
static bool order(viewer *v, size_t index, const char *text) {
    scene_item *item = &v->items[index];
    viewer_photos *photos = calloc(1, sizeof *photos);
    size_t length = strlen(text);
    char path[OWN_PATH_BYTES];
    bool done = photos != NULL;
    if (!done) viewer_tell(v, "%s: out of memory", item->name);
    if (done && !(take_folder(text, " masks ", &length, photos->masks) && take_folder(text, " images ", &length, photos->images) &&
                  length < sizeof photos->cameras)) {
        viewer_tell(v, "photos: %.60s...: the name is too long", text);
        done = false;
    }
    done = done && own_files_make(v, "photos", ".ply", path);
    if (done) {
        memcpy(photos->cameras, text, length);
        snprintf(photos->to, sizeof photos->to, "%s", path);
        photos->options = v->photos;
        done = items_photos(v, index, photos);
    }
    free(photos);
    return done;
}

/// Writes the coloured points to a file, which is loaded from then on.
static bool save(viewer *v, size_t index, const char *path) {
    const char *colored = v->items[index].load.colored;
    if (!colored[0]) {
        viewer_tell(v, "photos: %s has no colours of photographs yet: photos %zu CAMERAS", v->items[index].name, index);
        return false;
    }
    ewa_cloud *cloud = NULL;
    v->probe.message[0] = 0;
    ewa_status status = ewa_cloud_load(v->probe.context, colored, &cloud);
    if (status == EWA_OK) status = ewa_cloud_save(cloud, path, NULL);
    ewa_cloud_destroy(&cloud);
    if (status != EWA_OK) {
        viewer_tell(v, "%s: the points cannot be saved: %s", path, v->probe.message[0] ? v->probe.message : ewa_status_name(status));
        return false;
    }
    viewer_say(v, "photos %zu saved %s", index, path);
    viewer_note(v, "coloured points saved: %s", path);
    return apply(v, index, path);
}

/// Has the window ask for what is left out.
static bool ask(viewer *v, size_t index, viewer_question question) {
    v->state.asked_item = index;
    v->state.question = question;
    return true;
}

/// The first item that is shown and has points.
static bool ask_of_first(viewer *v) {
    for (size_t i = 0; i < v->item_count; i++) {
        viewer_item item;
        if (v->items[i].visible && v->items[i].asset && viewer_item_get(v, i, &item) && !item.volume && !item.gaussians)
            return ask(v, i, VIEWER_ASKS_PHOTOS);
    }
    viewer_tell(v, "photos: no points are shown that could be coloured");
    return false;
}

bool photos_do(viewer *v, const char *rest) {
    size_t index;
    v->state.question = VIEWER_ASKS_NOTHING;
    if (!v->services.photos) {
        viewer_tell(v, "photos: photographs are not read here");
        return false;
    }
    if (!*rest) return ask_of_first(v);
    if (!commands_take_item(v, "photos", &rest, &index)) return false;
    if (strcmp(rest, "off") == 0) return apply(v, index, "");
    if (strcmp(rest, "save") == 0) return ask(v, index, VIEWER_ASKS_SAVE_PHOTOS);
    if (strncmp(rest, "save ", 5) == 0) return save(v, index, rest + 5);
    if (!has_points(v, index)) return false;
    return *rest ? order(v, index, rest) : ask(v, index, VIEWER_ASKS_PHOTOS);
}

void photos_take(viewer *v, size_t index, const viewer_photos *photos, const ewa_photos_report *found) {
    history_begin(v);
    const bool done = apply(v, index, photos->to);
    history_end(v);
    char held_out[64] = "";
    if (found->held_out_count)
        snprintf(held_out, sizeof held_out, ", held out %u %.2f dB", found->held_out_count, found->held_out_psnr_db);
    if (done)
        viewer_say(v, "photos %zu %u photographs %llu points %.2f dB%s", index, found->used_count,
                   (unsigned long long)found->seen_count, found->psnr_db, held_out);
}
