// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Transfer functions of volumes: presets, files, and functions whose points a person moves. A volume is loaded again with its new
// function, as a scene file would have it, so that pictures are the same. A function that was changed is in a file of our own until
// it is saved; those files go when the viewer does.
#include "inner.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool transfers_is_changed(const viewer *v, size_t index) { return own_files_has(v, v->items[index].load.transfer); }

/// Has a volume loaded with the function of a word: a preset's or a file's name.
static bool apply(viewer *v, size_t index, const char *word) {
    item_load load = v->items[index].load;
    memset(load.transfer, 0, sizeof load.transfer);
    snprintf(load.transfer, sizeof load.transfer, "%s", word);
    return items_reload(v, index, &load);
}

static bool fail(viewer *v, const char *path) {
    viewer_tell(v, "%s: the transfer function cannot be saved: %s", path, v->probe.message[0] ? v->probe.message : "out of memory");
    return false;
}

/// Has a volume loaded with a function, which a file of our own keeps.
static bool apply_changed(viewer *v, size_t index, const ewa_transfer *transfer) {
    char path[OWN_PATH_BYTES];
    v->probe.message[0] = 0;
    if (!own_files_make(v, "transfer", "", path)) return false;
    if (ewa_transfer_save(v->probe.context, transfer, path) == EWA_OK) return apply(v, index, path);
    return fail(v, path);
}

static bool refuse_point(viewer *v, const char *text) {
    viewer_tell(v, "transfer: '%s' is neither [N|add] VALUE,R,G,B,EXTINCTION, colours in [0, 1], nor delete N, where two points stay", text);
    return false;
}

/// Changes, adds or takes out a point; points stay in the order of their values.
static bool change_point(viewer *v, size_t index, const char *text) {
    const viewer_values *values = v->items[index].values;
    ewa_transfer *transfer = malloc(sizeof *transfer);
    if (!transfer) return fail(v, "transfer");
    *transfer = values->transfer;
    unsigned point = 0;
    double n[5];
    char end;
    const bool adds = sscanf(text, "add %lf,%lf,%lf,%lf,%lf%c", &n[0], &n[1], &n[2], &n[3], &n[4], &end) == 5;
    const bool deletes = !adds && sscanf(text, "delete %u%c", &point, &end) == 1;
    bool fine = adds || deletes || sscanf(text, "%u %lf,%lf,%lf,%lf,%lf%c", &point, &n[0], &n[1], &n[2], &n[3], &n[4], &end) == 6;
    if (adds) point = transfer->point_count;
    if (fine && !adds && point >= transfer->point_count) {
        viewer_tell(v, "transfer: point %u: its points are 0 to %u", point, transfer->point_count - 1);
        free(transfer);
        return false;
    }
    fine = fine && (adds ? point < EWA_MAX_TRANSFER_POINTS : point < transfer->point_count) && (!deletes || transfer->point_count > 2);
    for (int i = 0; i < 5 && fine && !deletes; i++) fine = isfinite(n[i]) && (i == 0 || n[i] >= 0) && (i == 0 || i == 4 || n[i] <= 1);
    if (fine && !adds) { // it goes, and comes back at its place
        memmove(&transfer->points[point], &transfer->points[point + 1], (transfer->point_count - point - 1) * sizeof transfer->points[0]);
        transfer->point_count--;
    }
    if (fine && !deletes) {
        uint32_t at = transfer->point_count;
        while (at > 0 && transfer->points[at - 1].value > n[0]) at--;
        memmove(&transfer->points[at + 1], &transfer->points[at], (transfer->point_count - at) * sizeof transfer->points[0]);
        transfer->points[at] = (ewa_transfer_point){.value = n[0], .extinction = (float)n[4]};
        for (int c = 0; c < 3; c++) transfer->points[at].color[c] = ewa_linear_from_srgb((float)n[1 + c]);
        transfer->point_count++;
    }
    const bool done = fine ? apply_changed(v, index, transfer) : refuse_point(v, text);
    // The next change may come before its values are counted anew.
    if (done && index < v->item_count && v->items[index].values) v->items[index].values->transfer = *transfer;
    free(transfer);
    return done;
}

static bool save(viewer *v, size_t index, const char *path) {
    v->probe.message[0] = 0;
    if (ewa_transfer_save(v->probe.context, &v->items[index].values->transfer, path) != EWA_OK) return fail(v, path);
    viewer_say(v, "transfer %s", path);
    return apply(v, index, path);
}

bool transfers_command(viewer *v, const char *rest) {
    size_t index;
    if (!commands_take_item(v, "transfer", &rest, &index)) return false;
    ewa_asset_info info = {.kind = EWA_ASSET_POINTS};
    if (v->items[index].asset) ewa_asset_describe(v->items[index].asset, &info);
    if (info.kind != EWA_ASSET_VOLUME || !*rest) {
        viewer_tell(v, "transfer: %s", *rest ? "that is no volume, or not loaded yet" : "a preset, a file, auto, edit, point ... or save FILE.json");
        return false;
    }
    if (strcmp(rest, "edit") == 0) return items_count(v, index, false);
    const bool point = strncmp(rest, "point ", 6) == 0, saves = strncmp(rest, "save ", 5) == 0;
    if (!point && !saves) return apply(v, index, rest);
    if (!v->items[index].values) {
        viewer_tell(v, "transfer: its values are to be counted first: transfer %zu edit", index);
        return false;
    }
    return point ? change_point(v, index, rest + 6) : save(v, index, rest + 5);
}
