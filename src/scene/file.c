// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scene files: the files that they name, and what belongs to each.
#include "io/file.h"
#include "base/base.h"
#include "base/context.h"
#include "base/platform.h"
#include "ewa/scene_file.h"
#include "io/referenced_file.h"
#include "io/number.h"
#include "io/scene_text.h"
#include "scene/file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// A file that a scene file names.
typedef struct scene_file_item {
    char *path;
    char *transfer;     ///< NULL: that of the options
    ewa_filter *filter; ///< NULL: that of the options
    ewa_asset_options asset;
    ewa_instance instance;
} scene_file_item;

struct ewa_scene_file {
    ewa_context *context;
    ewa_asset_options base;
    uint32_t count, capacity, read_count;
    scene_file_item *items;
    char *path;
    ewa_scene_text text; ///< of the file itself, not of those that it names
    ewa_measure *measures; ///< text.measure_count
    size_t measure_room;
};

/// Makes the measurements of a scene file, which it keeps, and looks how many keyframes it has.
static ewa_status take_measures(const ewa_scene_reading *in, ewa_scene_file *file) {
    const uint32_t count = in->text->measure_count;
    if (count > EWA_MAX_MEASURES)
        return ewa_fail(file->context, EWA_ERROR_LIMIT, "%s: %u measurements; there may be %d", in->path, count, EWA_MAX_MEASURES);
    if (in->text->keyframes.count > EWA_MAX_KEYFRAMES)
        return ewa_fail(file->context, EWA_ERROR_LIMIT, "%s: %zu keyframes; there may be %d", in->path, in->text->keyframes.count,
                        EWA_MAX_KEYFRAMES);
    file->measure_room = count + (size_t)1;
    file->measures = ewa_allocate_zeroed(file->context, file->measure_room, sizeof *file->measures);
    return file->measures ? ewa_scene_read_measures(in, file->measures) : EWA_ERROR_MEMORY;
}

/// Reads "0,10" or "2%,98%".
static bool read_range(const char *text, ewa_coloring *coloring) {
    const char *last = text + strlen(text);
    for (int i = 0; i < 2; i++) {
        const char *end = ewa_number_read_f64(text, last, &coloring->range[i]);
        if (!end) return false;
        coloring->percent[i] = *end == '%';
        const double value = coloring->range[i];
        if (end == text || !isfinite(value) || (coloring->percent[i] && !(value >= 0 && value <= 100)))
            return false;
        end += coloring->percent[i];
        if (*end != (i ? 0 : ',')) return false;
        text = end + 1;
    }
    coloring->ranged = true;
    return true;
}

/// Sets a colouring from a member; `*known` says whether it is of one.
static ewa_status set_coloring(const ewa_scene_reading *in, const ewa_scene_member *member, ewa_coloring *coloring,
                               bool *known) {
    const char *value = ewa_scene_text_value(in->text, member);
    *known = true;
    if (strcmp(member->name, "color_by") == 0) {
        if (strlen(value) >= sizeof coloring->attribute) return ewa_scene_fail_at(in, member, "is too long a name");
        snprintf(coloring->attribute, sizeof coloring->attribute, "%s", value);
        return EWA_OK;
    }
    if (strcmp(member->name, "colormap") == 0)
        return ewa_scene_set_option(in, member, ewa_option_find(&ewa_coloring_table, "map"), coloring);
    if (strcmp(member->name, "range") == 0)
        return read_range(value, coloring) ? EWA_OK
                                           : ewa_scene_fail_at(in, member, "is not two numbers, or percentiles \"2%\"");
    if (strcmp(member->name, "tint") == 0) {
        coloring->tinted = true;
        return ewa_scene_set_option(in, member, ewa_option_find(&ewa_coloring_table, "tint"), coloring);
    }
    *known = false;
    return EWA_OK;
}

static ewa_status copy_text(ewa_context *context, const char *text, char **copy) {
    const size_t size = strlen(text) + 1;
    *copy = ewa_allocate(context, size, 1);
    if (!*copy) return EWA_ERROR_MEMORY;
    memcpy(*copy, text, size);
    return EWA_OK;
}

static void release_text(ewa_context *context, char *text) {
    if (text) ewa_release(context, text, strlen(text) + 1, 1);
}

static ewa_status set_filter(const ewa_scene_reading *in, const ewa_scene_member *member, scene_file_item *item) {
    char problem[EWA_OPTION_TEXT_BYTES];
    item->filter = ewa_allocate_zeroed(in->text->context, 1, sizeof *item->filter);
    if (!item->filter) return EWA_ERROR_MEMORY;
    if (ewa_filter_add(item->filter, ewa_scene_text_value(in->text, member), problem) == EWA_OK)
        return EWA_OK;
    return ewa_scene_fail_at(in, member, problem);
}

/// A preset's name, or that of a file.
static ewa_status set_transfer(const ewa_scene_reading *in, const ewa_scene_member *member, scene_file_item *item) {
    const char *value = ewa_scene_text_value(in->text, member), *preset = "auto";
    for (uint32_t i = 0; preset && strcmp(preset, value) != 0; i++)
        preset = ewa_transfer_preset_name(i, NULL);
    if (preset) return copy_text(in->text->context, value, &item->transfer);
    char found[EWA_PATH_BYTES], reason[EWA_REASON_BYTES];
    if (!ewa_referenced_file_find(in->text->context, in->path, value, false, found, reason))
        return ewa_scene_fail_at(in, member, reason);
    return copy_text(in->text->context, found, &item->transfer);
}

/// Sets what a member says of an item, but for the file that it names.
static ewa_status set_member(const ewa_scene_reading *in, const ewa_scene_member *member, scene_file_item *item) {
    bool known;
    const ewa_status status = set_coloring(in, member, &item->instance.coloring, &known);
    if (known) return status;
    if (strcmp(member->name, "filter") == 0) return set_filter(in, member, item);
    if (strcmp(member->name, "transfer") == 0) return set_transfer(in, member, item);
    const ewa_option *option = ewa_option_find(&ewa_instance_table, member->name);
    if (option) return ewa_scene_set_option(in, member, option, &item->instance);
    option = ewa_option_find(&ewa_asset_options_table, member->name);
    // Contexts are the caller's choice, and so is what pictures of things that move are made of.
    if (!option || strcmp(option->name, "own_context") == 0 || strcmp(option->name, "voxel_level_minimum") == 0)
        return ewa_scene_fail_at(in, member, "no item has such a member");
    return ewa_scene_set_option(in, member, option, &item->asset);
}

/// Puts the map of the file that names this one before an item's own.
static ewa_status move(const ewa_scene_reading *in, const ewa_scene_member *at, double to_world[16]) {
    double moved[16];
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++) {
            double sum = 0;
            for (int k = 0; k < 4; k++) sum += in->to_world[4 * r + k] * to_world[4 * k + c];
            moved[4 * r + c] = sum;
        }
    memcpy(to_world, moved, sizeof moved);
    return ewa_asset_map_is_valid(to_world)
               ? EWA_OK
               : ewa_scene_fail_at(in, at, "to_world: is no map that can be turned back, of last row 0 0 0 1");
}

static ewa_status add_item(ewa_scene_file *file, const scene_file_item *item) {
    ewa_context *context = file->context;
    if (file->count == EWA_SCENE_MAX_INSTANCES)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%s: more than %d files", file->path,
                        EWA_SCENE_MAX_INSTANCES);
    if (file->count == file->capacity) {
        const uint32_t capacity = file->capacity ? 2 * file->capacity : 8;
        scene_file_item *items = ewa_allocate(context, capacity, sizeof *items);
        if (!items) return EWA_ERROR_MEMORY;
        if (file->count) memcpy(items, file->items, file->count * sizeof *items);
        ewa_release(context, file->items, file->capacity, sizeof *items);
        file->items = items;
        file->capacity = capacity;
    }
    file->items[file->count++] = *item;
    return EWA_OK;
}

static void free_item(ewa_context *context, scene_file_item *item) {
    release_text(context, item->path);
    release_text(context, item->transfer);
    ewa_release(context, item->filter, 1, sizeof *item->filter);
}

static ewa_status read_file(ewa_scene_file *file, const ewa_scene_reading *by, const char *path,
                            const double to_world[16], bool visible, ewa_scene_text *keep);

/// The members of one item.
static ewa_status read_item(ewa_scene_file *file, const ewa_scene_reading *in, const ewa_scene_member *members,
                            size_t count, uint32_t index) {
    scene_file_item item = {.asset = file->base};
    ewa_instance_init(&item.instance, sizeof item.instance);
    const ewa_scene_member *named = NULL, at = {EWA_SCENE_ITEM, index, NULL, 0};
    bool is_scene = false;
    ewa_status status = EWA_OK;
    for (size_t i = 0; i < count && status == EWA_OK; i++) {
        const ewa_scene_member *member = &members[i];
        const bool scene = strcmp(member->name, "scene") == 0;
        if (!scene && strcmp(member->name, "file") != 0) {
            status = set_member(in, member, &item);
            continue;
        }
        if (named) status = ewa_scene_fail_at(in, member, "an item is of one file, or of one scene");
        named = member;
        is_scene = scene;
    }
    if (status == EWA_OK && !named) status = ewa_scene_fail_at(in, &at, "names no file and no scene");
    for (size_t i = 0; i < count && is_scene && status == EWA_OK; i++)
        if (&members[i] != named && strcmp(members[i].name, "to_world") != 0 &&
            strcmp(members[i].name, "visible") != 0)
            status = ewa_scene_fail_at(in, &members[i], "is of files, not of scenes");
    char found[EWA_PATH_BYTES], reason[EWA_REASON_BYTES];
    if (status == EWA_OK &&
        !ewa_referenced_file_find(in->text->context, in->path, ewa_scene_text_value(in->text, named), !is_scene, found, reason))
        status = ewa_scene_fail_at(in, named, reason);
    if (status == EWA_OK) status = move(in, &at, item.asset.to_world);
    item.instance.visible = item.instance.visible && in->visible;
    if (status == EWA_OK && is_scene) {
        status = read_file(file, in, found, item.asset.to_world, item.instance.visible, NULL);
    } else if (status == EWA_OK) {
        status = copy_text(file->context, found, &item.path);
        if (status == EWA_OK) status = add_item(file, &item);
        if (status == EWA_OK) return EWA_OK; // it is the file's now
    }
    free_item(file->context, &item);
    return status;
}

static ewa_status read_items(ewa_scene_file *file, const ewa_scene_reading *in) {
    const ewa_scene_text *text = in->text;
    size_t first = 0;
    for (uint32_t index = 0; index < text->item_count; index++) {
        while (first < text->member_count && text->members[first].section != EWA_SCENE_ITEM) first++;
        size_t end = first;
        while (end < text->member_count && text->members[end].section == EWA_SCENE_ITEM &&
               text->members[end].index == index)
            end++;
        EWA_TRY(read_item(file, in, text->members + first, end - first, index));
        first = end;
    }
    return EWA_OK;
}

/// Whether two paths are of one file.
static bool is_same(const char *a, const char *b) {
    ewa_platform_facts first, second;
    return ewa_platform_stat(a, &first) && ewa_platform_stat(b, &second) && first.device == second.device &&
           first.number == second.number;
}

static ewa_status read_file(ewa_scene_file *file, const ewa_scene_reading *by, const char *path,
                            const double to_world[16], bool visible, ewa_scene_text *keep) {
    ewa_context *context = file->context;
    for (const ewa_scene_reading *in = by; in; in = in->by)
        if (is_same(in->path, path))
            return ewa_fail(context, EWA_ERROR_LIMIT, "%s: names %s, which is the scene that it is part of",
                            by->path, path);
    if (by && by->depth == EWA_SCENE_FILE_DEPTH)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%s: is %d scene files deep already", by->path,
                        EWA_SCENE_FILE_DEPTH);
    if (file->read_count++ == EWA_SCENE_FILE_COUNT)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%s: names more than %d scene files", file->path,
                        EWA_SCENE_FILE_COUNT);
    ewa_file bytes;
    EWA_TRY(ewa_file_map(context, path, &bytes));
    ewa_scene_text text;
    ewa_status status = ewa_scene_text_read(context, path, bytes.bytes, bytes.size_bytes, &text);
    ewa_file_unmap(context, &bytes);
    EWA_TRY(status);
    ewa_scene_reading in = {.by = by, .path = path, .text = &text, .visible = visible, .depth = by ? by->depth + 1 : 1};
    memcpy(in.to_world, to_world, sizeof in.to_world);
    ewa_scene_options options;
    ewa_scene_options_init(&options, sizeof options);
    status = ewa_scene_apply_text(&in, false, &options);
    if (status == EWA_OK) status = read_items(file, &in);
    if (status == EWA_OK && keep) status = take_measures(&in, file);
    if (status == EWA_OK && keep)
        *keep = text;
    else
        ewa_scene_text_free(&text);
    return status;
}

bool ewa_scene_file_probe(const char *path) {
    uint8_t bytes[256];
    return path && ewa_scene_text_probe(bytes, ewa_file_head(NULL, path, bytes, sizeof bytes));
}

ewa_status ewa_scene_file_load(ewa_context *context, const char *path, const ewa_asset_options *options,
                               ewa_scene_file **made) {
    if (!context || !path || !made) return EWA_ERROR_ARGUMENT;
    *made = NULL;
    ewa_scene_file *file = ewa_allocate_zeroed(context, 1, sizeof *file);
    if (!file) return EWA_ERROR_MEMORY;
    file->context = context;
    ewa_status status = ewa_asset_take_options(context, options, &file->base);
    if (status == EWA_OK) status = copy_text(context, path, &file->path);
    double to_world[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    if (status == EWA_OK) status = read_file(file, NULL, file->path, to_world, true, &file->text);
    ewa_scene_options said;
    ewa_scene_options_init(&said, sizeof said);
    if (status == EWA_OK) ewa_scene_file_apply(file, &said);
    // What merges Gaussians needs their levels.
    for (uint32_t i = 0; i < file->count; i++) file->items[i].asset.gaussian_levels |= said.gaussians.merge_px > 0;
    *made = file;
    if (status != EWA_OK) ewa_scene_file_destroy(made);
    return status;
}

void ewa_scene_file_destroy(ewa_scene_file **given) {
    ewa_scene_file *file = given ? *given : NULL;
    if (!file) return;
    *given = NULL;
    for (uint32_t i = 0; i < file->count; i++) free_item(file->context, &file->items[i]);
    ewa_release(file->context, file->items, file->capacity, sizeof *file->items);
    ewa_release(file->context, file->measures, file->measure_room, sizeof *file->measures);
    if (file->text.context) ewa_scene_text_free(&file->text);
    release_text(file->context, file->path);
    ewa_release(file->context, file, 1, sizeof *file);
}

uint32_t ewa_scene_file_count(const ewa_scene_file *file) { return file ? file->count : 0; }

ewa_status ewa_scene_file_entry(const ewa_scene_file *file, uint32_t index, ewa_scene_entry *entry) {
    if (!file || !entry || index >= file->count) return EWA_ERROR_ARGUMENT;
    const scene_file_item *item = &file->items[index];
    *entry = (ewa_scene_entry){.path = item->path, .asset = item->asset, .instance = item->instance};
    if (item->filter) entry->asset.filter = item->filter;
    if (item->transfer) entry->asset.transfer = item->transfer;
    return EWA_OK;
}

bool ewa_scene_file_camera(const ewa_scene_file *file, ewa_camera *camera) {
    if (!file || !file->text.has_camera) return false;
    *camera = file->text.camera;
    return true;
}

bool ewa_scene_file_measure(const ewa_scene_file *file, uint32_t index, ewa_measure *measure) {
    if (!file || !measure || index >= file->text.measure_count) return false;
    *measure = file->measures[index];
    return true;
}

bool ewa_scene_file_keyframe(const ewa_scene_file *file, uint32_t index, ewa_camera *camera) {
    if (!file || !camera || index >= file->text.keyframes.count) return false;
    *camera = file->text.keyframes.cameras[index];
    return true;
}

void ewa_scene_file_apply(const ewa_scene_file *file, ewa_scene_options *options) {
    const ewa_scene_reading in = {.path = file->path, .text = &file->text};
    // All of it could be set when it was read.
    (void)ewa_scene_apply_text(&in, true, options);
}

/// Adds one file. Points of which a filter leaves none are left out.
static ewa_status add_entry(ewa_scene *scene, const ewa_scene_entry *entry) {
    ewa_asset *asset = NULL;
    EWA_TRY(ewa_asset_load(scene->context, entry->path, &entry->asset, &asset));
    ewa_status status = EWA_OK;
    if (ewa_asset_is_points(asset) && !asset->count)
        ewa_report(scene->context, EWA_SEVERITY_NOTE,
                   "%s: the filter takes none of its points; it is left out", entry->path);
    else
        status = ewa_scene_add(scene, asset, &entry->instance);
    ewa_asset_release(&asset);
    return status;
}

ewa_status ewa_scene_open(ewa_scene *scene, const char *path, const ewa_asset_options *options) {
    if (!scene || !path) return EWA_ERROR_ARGUMENT;
    ewa_scene_file *file;
    const uint32_t before = scene->count;
    ewa_status status = ewa_scene_file_load(scene->context, path, options, &file);
    for (uint32_t i = 0; status == EWA_OK && i < ewa_scene_file_count(file); i++) {
        ewa_scene_entry entry;
        (void)ewa_scene_file_entry(file, i, &entry);
        status = add_entry(scene, &entry);
    }
    ewa_scene_options made;
    ewa_scene_get_options(scene, &made);
    if (status == EWA_OK) {
        ewa_scene_file_apply(file, &made);
        status = ewa_scene_set_options(scene, &made);
    }
    while (status != EWA_OK && scene->count > before) (void)ewa_scene_remove(scene, scene->count - 1);
    ewa_camera camera;
    if (status == EWA_OK && !scene->has_camera && ewa_scene_file_camera(file, &camera))
        status = ewa_scene_set_camera(scene, &camera);
    if (status == EWA_OK && !scene->measure_count)
        status = ewa_scene_set_measures(scene, file->measures, file->text.measure_count);
    if (status == EWA_OK && !scene->keyframe_count)
        status = ewa_scene_set_keyframes(scene, file->text.keyframes.cameras, (uint32_t)file->text.keyframes.count);
    ewa_scene_file_destroy(&file);
    return status;
}
