// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What was opened: clouds, meshes and volumes, each with how it is shown.
#include "inner.h"
#include "navigate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Points of a cloud that is not ready are drawn as discs of so many pixels.
static const double PREVIEW_POINT_PX = 2;

static scene_item *find_item(viewer *v, uint64_t id) {
    for (size_t i = 0; i < v->item_count; i++)
        if (v->items[i].id == id) return &v->items[i];
    return NULL;
}

static const char *file_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash && slash[1] ? slash + 1 : path;
}

/// In waiting viewers, everything that was ordered is there afterwards.
static void wait_if_asked(viewer *v) {
    while (v->waits && loader_is_busy(v->loader)) {
        loader_wait(v->loader);
        items_update(v); // which may order a scene
    }
}

/// Orders a file; `file` (may be NULL) is the scene file that names it, as `entry`.
static bool order(viewer *v, const char *path, const ewa_scene_file *file, uint32_t entry) {
    if (v->item_count == VIEWER_MAX_ITEMS) {
        viewer_tell(v, "%s: there are %d things open already", path, VIEWER_MAX_ITEMS);
        return false;
    }
    if (strlen(path) >= VIEWER_PATH_BYTES) {
        viewer_tell(v, "%.60s...: the name is too long", path);
        return false;
    }
    scene_item *item = &v->items[v->item_count];
    *item = (scene_item){.id = ++v->next_id, .visible = true, .material = EWA_MATERIAL_OWN};
    ewa_asset_options usual;
    ewa_asset_options_init(&usual, sizeof usual);
    snprintf(item->path, sizeof item->path, "%s", path);
    snprintf(item->name, sizeof item->name, "%.255s", file_name(path));
    item->named = file != NULL;
    item->file = file;
    item->entry = entry;
    viewer_coloring_init(&item->wish);
    colorings_take(&v->coloring, &item->wish);
    snprintf(item->load.transfer, sizeof item->load.transfer, "%s", v->transfer);
    ewa_scene_entry said;
    if (file && ewa_scene_file_entry(file, entry, &said) == EWA_OK) {
        colorings_take_instance(&said.instance, item);
        memcpy(usual.to_world, said.asset.to_world, sizeof usual.to_world);
        if (said.asset.transfer)
            snprintf(item->load.transfer, sizeof item->load.transfer, "%s", said.asset.transfer);
    }
    memcpy(item->load.to_world, usual.to_world, sizeof usual.to_world);
    item->shown_load = item->load;
    item->coloring = item->wish;
    if (!loader_load(v->loader, item->id, path, file, entry, &item->load)) {
        viewer_tell(v, "%s: out of memory", path);
        return false;
    }
    v->item_count++;
    return true;
}

/// Keeps a scene file, which orders borrow. False: out of memory.
static bool keep_file(viewer *v, ewa_scene_file *file) {
    ewa_scene_file **larger = realloc(v->files, (v->file_count + 1) * sizeof *larger);
    if (!larger) return false;
    v->files = larger;
    v->files[v->file_count++] = file;
    return true;
}

/// Takes the settings that a scene file says, where they have their defaults, and its camera.
static void take_settings(viewer *v, const ewa_scene_file *file) {
    uint32_t index = 0;
    v->base.render = v->render;
    v->base.lod = v->lod;
    ewa_scene_file_apply(file, &v->base);
    v->render = v->base.render;
    v->lod = v->base.lod;
    cutaway_take(v);
    while (v->measure_count < EWA_MAX_MEASURES) {
        if (!ewa_scene_file_measure(file, index++, &v->measure_list[v->measure_count])) break;
        v->measure_count++;
    }
    index = 0;
    while (v->film.key_count < EWA_MAX_KEYFRAMES && ewa_scene_file_keyframe(file, index++, &v->film.keys[v->film.key_count]))
        v->film.key_count++;
    viewer_mark(v);
    if (!v->has_scene_camera) v->has_scene_camera = ewa_scene_file_camera(file, &v->scene_camera);
}

static void note_opened(viewer *v, const char *path) {
    snprintf(v->opened, sizeof v->opened, "%s", path);
    v->opened_count++;
}

static bool open_scene(viewer *v, const char *path) {
    ewa_scene_file *file = NULL;
    const ewa_status status = ewa_scene_file_load(v->probe.context, path, NULL, &file);
    const uint32_t count = ewa_scene_file_count(file);
    if (status != EWA_OK || !keep_file(v, file)) {
        viewer_tell(v, "%s", status != EWA_OK && v->probe.message[0] ? v->probe.message : "out of memory");
        ewa_scene_file_destroy(&file);
        return false;
    }
    if (count > VIEWER_MAX_ITEMS - v->item_count) {
        viewer_tell(v, "%s: names %u files; there is room for %zu", path, count,
                    VIEWER_MAX_ITEMS - v->item_count);
        return false;
    }
    if (!v->item_count && v->opened_count) { // all was closed: this one is seen from where it says
        ewa_camera camera;
        v->has_scene_camera = false;
        v->placed = v->placed && !ewa_scene_file_camera(file, &camera);
    }
    take_settings(v, file);
    bool done = true;
    for (uint32_t i = 0; i < count && done; i++) {
        ewa_scene_entry entry;
        (void)ewa_scene_file_entry(file, i, &entry);
        done = order(v, entry.path, file, i);
    }
    if (done) note_opened(v, path);
    return done;
}

bool items_open(viewer *v, const char *path) {
    const size_t first = v->item_count;
    if (!(ewa_scene_file_probe(path) ? open_scene(v, path) : order(v, path, NULL, 0))) return false;
    const size_t last = v->item_count;
    wait_if_asked(v);
    return v->item_count >= last && last >= first;
}

size_t items_find_instance(const viewer *v, uint32_t instance) {
    for (size_t i = 0; i < v->item_count && instance < v->scene_count; i++)
        if (v->items[i].id == v->scene_items[instance]) return i;
    return SIZE_MAX;
}

static bool is_colorable(const ewa_asset *asset) {
    ewa_asset_info info;
    ewa_asset_describe(asset, &info);
    return info.colorable;
}

/// Orders a scene of the items as they are now.
static void items_reorder(viewer *v) {
    loader_scene of = {.count = 0, .options = v->base};
    of.options.lod = v->lod;
    for (size_t i = 0; i < v->item_count; i++) {
        const scene_item *item = &v->items[i];
        if (!item->asset) continue;
        of.items[of.count] = item->id;
        of.assets[of.count] = ewa_asset_retain(item->asset);
        of.instances[of.count] = colorings_instance(item);
        of.colorings[of.count++] = item->wish;
    }
    if (!loader_make(v->loader, &of)) viewer_tell(v, "out of memory for the scene");
}

/// Returns the coarsest level of voxels at which all visible volumes have enough; the second at least.
static uint32_t coarsest_voxels(const viewer *v) {
    enum { FEWEST_VOXELS = 32 * 32 * 32 };
    uint32_t level = VIEWER_VOXEL_LEVELS - 1;
    for (size_t i = 0; i < v->item_count; i++) {
        ewa_asset_info info = {.kind = EWA_ASSET_POINTS};
        if (v->items[i].asset) ewa_asset_describe(v->items[i].asset, &info);
        if (info.kind != EWA_ASSET_VOLUME || !v->items[i].visible) continue;
        while (level > 1 && info.count >> 3 * level < FEWEST_VOXELS) level--;
    }
    return level;
}

/// Shows another scene, and the previews of what is still being loaded.
static void show(viewer *v, const ewa_scene *scene) {
    ewa_scene *next = NULL;
    ewa_status status = ewa_scene_copy(scene, v->probe.context, &next);
    // Previews of the scene before are behind its items.
    while (status == EWA_OK && ewa_scene_count(next) > v->scene_count)
        status = ewa_scene_remove(next, ewa_scene_count(next) - 1);
    for (size_t i = 0; i < v->item_count && status == EWA_OK; i++)
        if (v->items[i].preview && v->items[i].visible)
            status = ewa_scene_add(next, v->items[i].preview, NULL);
    if (status == EWA_OK) status = ewa_scene_commit(next);
    if (status == EWA_OK && v->has_scene_camera) status = ewa_scene_set_camera(next, &v->scene_camera);
    if (status != EWA_OK) {
        viewer_tell(v, "the scene cannot be shown: %s", ewa_status_name(status));
        ewa_scene_destroy(&next);
        return;
    }
    painter_rest(v->painter);
    if (v->node_reader) node_reader_rest(v->node_reader);
    ewa_scene_destroy(&v->scene);
    v->scene = next;
    ewa_scene_info info;
    ewa_scene_describe(next, &info);
    v->octrees = info.octrees;
    v->gaussian_levels = info.gaussian_levels;
    v->volumes = info.volumes;
    v->unit = info.unit;
    v->voxel_level = coarsest_voxels(v);
    viewer_change(v);
}

void items_refresh(viewer *v) {
    items_reorder(v);
    show(v, v->scene);
    wait_if_asked(v);
}

static void remove_item(viewer *v, size_t index) {
    ewa_asset_release(&v->items[index].preview);
    ewa_asset_release(&v->items[index].asset);
    free(v->items[index].values);
    memmove(&v->items[index], &v->items[index + 1], (v->item_count - index - 1) * sizeof v->items[0]);
    v->item_count--;
    pick_clear(v);
}

bool items_close(viewer *v, size_t index) {
    if (index >= v->item_count) {
        viewer_tell(v, "close: there is no item %zu", index);
        return false;
    }
    const uint64_t id = v->items[index].id;
    loader_forget(v->loader, id);
    items_update(v); // in which it may go by itself
    scene_item *item = find_item(v, id);
    if (!item) return true;
    const bool shown = item->asset != NULL;
    remove_item(v, (size_t)(item - v->items));
    if (shown) items_reorder(v);
    show(v, v->scene);
    wait_if_asked(v);
    return true;
}

bool items_reload(viewer *v, size_t index, const item_load *load) {
    scene_item *item = &v->items[index];
    if (memcmp(&item->load, load, sizeof *load) == 0) return true;
    const bool other = strcmp(item->load.transfer, load->transfer) != 0;
    if (item->photographed) viewer_tell(v, "%s: the colours of photographs were given up", item->name);
    loader_forget(v->loader, item->id);
    items_update(v);
    if (!loader_load(v->loader, item->id, item->path, item->file, item->entry, load)) {
        viewer_tell(v, "%s: out of memory", item->path);
        return false;
    }
    item->load = *load;
    item->counts = item->photographed = false; // those orders were forgotten, too
    pick_clear(v);
    if (other && item->values && !items_count(v, index, true)) return false;
    wait_if_asked(v);
    return true;
}

bool items_count(viewer *v, size_t index, bool again) {
    scene_item *item = &v->items[index];
    if (item->counts || (item->values && !again)) return true;
    if (!loader_count(v->loader, item->id, item->path, &item->load)) {
        viewer_tell(v, "%s: out of memory", item->path);
        return false;
    }
    item->counts = true;
    wait_if_asked(v);
    return true;
}

bool items_photos(viewer *v, size_t index, const viewer_photos *photos) {
    scene_item *item = &v->items[index];
    if (item->photographed || !loader_photos(v->loader, item->id, item->path, item->file, item->entry, photos)) {
        viewer_tell(v, "%s: %s", item->name, item->photographed ? "its colours are being found already" : "out of memory");
        return false;
    }
    item->photographed = true;
    wait_if_asked(v);
    return true;
}

void items_move(viewer *v, size_t from, size_t to) {
    const scene_item moved = v->items[from];
    if (from < to)
        memmove(&v->items[from], &v->items[from + 1], (to - from) * sizeof moved);
    else
        memmove(&v->items[to + 1], &v->items[to], (from - to) * sizeof moved);
    v->items[to] = moved;
    pick_clear(v);
    items_refresh(v);
}

bool items_cancel(viewer *v) {
    bool any = false;
    loader_cancel(v->loader);
    for (size_t i = v->item_count; i-- > 0;) {
        scene_item *item = &v->items[i];
        if (item->loaded) { // it stays where it is
            any = any || item->photographed || memcmp(&item->load, &item->shown_load, sizeof item->load) != 0;
            item->load = item->shown_load;
            item->counts = item->photographed = false;
            continue;
        }
        any = true; // what is loaded already goes with the scene that is given up
        if (!v->items[i].asset) remove_item(v, i);
    }
    if (any) show(v, v->scene);
    return any;
}

void items_recolor(viewer *v, size_t index) {
    scene_item *item = &v->items[index];
    if (!item->asset) return;
    if (!is_colorable(item->asset)) {
        item->wish = item->coloring;
        return;
    }
    items_reorder(v);
    wait_if_asked(v);
}

bool items_bounds(const viewer *v, double low_world[3], double high_world[3]) {
    ewa_bounds bounds;
    ewa_scene_bounds(v->scene, &bounds);
    if (!bounds.finite_count) return false;
    memcpy(low_world, bounds.low_world, sizeof bounds.low_world);
    memcpy(high_world, bounds.high_world, sizeof bounds.high_world);
    return true;
}

/// Sets what the size of the scene decides: how fast one flies, where the middle is.
static void measure(viewer *v, bool with_pivot) {
    double low[3], high[3], size = 0;
    if (!items_bounds(v, low, high)) return;
    for (int c = 0; c < 3; c++) {
        size += (high[c] - low[c]) * (high[c] - low[c]);
        if (with_pivot) v->pivot_world[c] = 0.5 * (low[c] + high[c]);
    }
    v->reach_world = size > 0 ? sqrt(size) : 1;
}

bool items_place(viewer *v, const char *view, bool animate) {
    ewa_scene_info info;
    ewa_scene_describe(v->scene, &info);
    if (!info.visible_count) return false;
    ewa_camera camera;
    ewa_camera_init(&camera);
    camera.width_px = v->camera.width_px;
    camera.height_px = v->camera.height_px;
    const bool color_bar = v->furniture.color_bar && overlay_has_color_bar(v);
    if (!v->services.place(v->services.user, v->scene, view, color_bar, &camera, v->up_world)) return false;
    measure(v, true);
    const bool ortho = v->camera.projection == EWA_ORTHOGRAPHIC;
    if (ortho) navigate_set_ortho(&camera, true, v->pivot_world, 0);
    if (animate)
        viewer_go(v, &camera);
    else
        v->camera = camera;
    viewer_change(v);
    return true;
}

/// The first looks are the program's.
static void look(viewer *v) {
    if (!v->placed) items_place(v, NULL, false);
    measure(v, false);
}

static void take_preview(viewer *v, loader_note *note) {
    scene_item *item = find_item(v, note->item);
    if (!item || item->asset) return;
    ewa_asset_release(&item->preview);
    item->preview = note->asset;
    item->as_points = note->as_points;
    note->asset = NULL;
    show(v, v->scene);
    look(v);
}

/// Takes in what was loaded; it is shown when the scene is made.
static void take_asset(viewer *v, loader_note *note) {
    scene_item *item = find_item(v, note->item);
    // It was closed; or closed and opened again, when two loads may have come to an end.
    const bool again = item && item->asset && memcmp(&item->load, &item->shown_load, sizeof item->load) != 0;
    if (!item || (item->asset && !again)) return;
    ewa_asset_release(&item->asset);
    item->asset = note->asset;
    note->asset = NULL;
    item->shown_load = item->load;
    if (!item->named && !again) note_opened(v, item->path);
    items_reorder(v);
}

static void take_scene(viewer *v, loader_note *note) {
    bool more = false;
    v->scene_count = note->of.count;
    memcpy(v->scene_items, note->of.items, sizeof v->scene_items);
    for (uint32_t i = 0; i < note->of.count; i++) {
        scene_item *item = find_item(v, note->of.items[i]);
        if (!item) continue;
        more = more || !item->loaded;
        item->loaded = true;
        item->coloring = note->of.colorings[i];
        colorings_take_legend(ewa_scene_legend(note->scene, i), &item->coloring);
        ewa_asset_release(&item->preview);
    }
    show(v, note->scene);
    if (more)
        look(v);
    else
        measure(v, false); // something may lie elsewhere
}

static void take_values(viewer *v, loader_note *note) {
    scene_item *item = find_item(v, note->item);
    if (!item) return;
    free(item->values);
    item->values = note->values;
    note->values = NULL;
    item->counts = false;
}

static void take_photos(viewer *v, const loader_note *note) {
    scene_item *item = find_item(v, note->item);
    if (!item) return;
    item->photographed = false;
    photos_take(v, (size_t)(item - v->items), &note->photos, &note->found);
}

/// What came to nothing goes, or is again as it was; what cannot be coloured as the program says for all has its own colours.
static void take_failure(viewer *v, const loader_note *note) {
    bool gone = false, again = false;
    for (size_t i = v->item_count; i-- > 0;) {
        scene_item *item = &v->items[i];
        if (note->item && item->id != note->item) continue;
        if (item->loaded) {
            item->wish = item->coloring;
            item->load = item->shown_load;
            item->counts = item->photographed = false;
        } else if (!note->item && item->asset && !item->named && colorings_is_program(v, &item->wish)) {
            viewer_coloring_init(&item->wish);
            again = true;
        } else if (note->item || item->asset) {
            remove_item(v, i);
            gone = true;
        }
    }
    if (gone) show(v, v->scene);
    if ((gone || again) && !note->item) items_reorder(v);
}

void items_update(viewer *v) {
    for (loader_note *note; (note = loader_take(v->loader));) {
        switch (note->kind) {
        case LOADER_LOAD:
            take_asset(v, note);
            break;
        case LOADER_PREVIEW:
            take_preview(v, note);
            break;
        case LOADER_VALUES:
            take_values(v, note);
            break;
        case LOADER_SCENE:
            take_scene(v, note);
            break;
        case LOADER_PHOTOS:
            take_photos(v, note);
            break;
        case LOADER_FAILED:
            take_failure(v, note);
            break;
        case LOADER_MESSAGE:
            viewer_tell(v, "%s", note->text);
            break;
        }
        loader_note_free(note);
    }
}

void items_gather(const viewer *v, paint_scene *scene) {
    ewa_scene_info info;
    ewa_scene_describe(v->scene, &info);
    scene->scene = v->scene;
    scene->octrees = info.octrees;
    for (size_t i = 0; i < v->item_count; i++)
        if (v->items[i].preview && v->items[i].as_points && v->items[i].visible &&
            scene->options.render.point_size_px == 0)
            scene->options.render.point_size_px = PREVIEW_POINT_PX;
}

size_t viewer_item_count(const viewer *v) { return v->item_count; }

bool viewer_item_get(const viewer *v, size_t index, viewer_item *item) {
    if (index >= v->item_count) return false;
    const scene_item *from = &v->items[index];
    ewa_asset_info info = {.count = 0};
    const ewa_asset *asset = from->asset ? from->asset : from->preview;
    if (asset) ewa_asset_describe(asset, &info);
    *item = (viewer_item){.path = from->path,
                          .visible = from->visible,
                          .volume = asset && info.kind == EWA_ASSET_VOLUME,
                          .gaussians = asset && info.kind == EWA_ASSET_GAUSSIANS,
                          .mesh = asset && info.kind == EWA_ASSET_MESH,
                          .octree = asset && info.kind == EWA_ASSET_OCTREE,
                          .count = info.count,
                          .coloring = from->coloring};
    memcpy(item->name, from->name, sizeof item->name);
    memcpy(item->to_world, from->load.to_world, sizeof item->to_world);
    item->values = from->values;
    item->colored = photos_is_changed(v, index) ? "changed" : from->load.colored;
    item->transfer = transfers_is_changed(v, index) ? "changed" : from->load.transfer;
    return true;
}

const char *viewer_attribute_at(const viewer *v, size_t index, uint32_t wanted,
                                char name[EWA_NAME_BYTES + 4]) {
    ewa_asset_info info = {.cloud = NULL};
    if (index < v->item_count && v->items[index].asset) ewa_asset_describe(v->items[index].asset, &info);
    ewa_lod_info octree = {.prototype = NULL};
    if (info.lod) ewa_lod_describe(info.lod, &octree);
    const ewa_cloud *cloud = info.cloud ? info.cloud : octree.prototype;
    static const char *const of_gaussians[] = {"opacity", "size", "x", "y", "z", "classification"};
    ewa_splats_info splats = {.has_classes = false};
    ewa_splats_describe(info.splats, &splats);
    if (info.kind == EWA_ASSET_GAUSSIANS && info.splats && wanted + !splats.has_classes < sizeof of_gaussians / sizeof *of_gaussians) {
        snprintf(name, EWA_NAME_BYTES + 4, "%s", of_gaussians[wanted]);
        return name;
    }
    if (!cloud) return NULL;
    const ewa_attribute *attribute;
    for (uint32_t k = 0; (attribute = ewa_cloud_attribute_at(cloud, k)); k++) {
        if (wanted >= attribute->component_count) {
            wanted -= attribute->component_count;
            continue;
        }
        const bool color = strcmp(attribute->name, EWA_COLOR) == 0;
        if (attribute->component_count == 1)
            snprintf(name, EWA_NAME_BYTES + 4, "%s", attribute->name);
        else
            snprintf(name, EWA_NAME_BYTES + 4, "%s.%c", attribute->name, (color ? "rgba" : "xyzw")[wanted]);
        return name;
    }
    return NULL;
}
