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

const ewa_surfels *item_surfels(const scene_item *item) {
    return item->made ? item->made : item->content.surfels;
}

/// In waiting viewers, everything that was ordered is there afterwards.
static void wait_if_asked(viewer *v) {
    if (!v->waits) return;
    loader_wait(v->loader);
    items_update(v);
}

bool items_open(viewer *v, const char *path) {
    if (v->item_count == VIEWER_MAX_ITEMS) {
        viewer_tell(v, "%s: there are %d things open already", path, VIEWER_MAX_ITEMS);
        return false;
    }
    if (strlen(path) >= VIEWER_PATH_BYTES) {
        viewer_tell(v, "%.60s...: the name is too long", path);
        return false;
    }
    scene_item *item = &v->items[v->item_count];
    *item = (scene_item){.id = ++v->next_id, .visible = true};
    snprintf(item->path, sizeof item->path, "%s", path);
    snprintf(item->name, sizeof item->name, "%.255s", file_name(path));
    viewer_coloring_init(&item->wish);
    item->coloring = item->wish;
    if (!loader_load(v->loader, item->id, path)) {
        viewer_tell(v, "%s: out of memory", path);
        return false;
    }
    v->item_count++;
    const size_t before = v->item_count;
    wait_if_asked(v);
    return v->item_count >= before;
}

/// Lets go of what an item shows.
static void clear_item(viewer *v, scene_item *item) {
    painter_rest(v->painter);
    ewa_surfels_destroy(&item->made);
    viewer_content_free(&item->content);
    item->preview = item->loaded = false;
    viewer_change(v);
}

static void remove_item(viewer *v, size_t index) {
    clear_item(v, &v->items[index]);
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
    if (item) remove_item(v, (size_t)(item - v->items));
    return true;
}

void items_recolor(viewer *v, size_t index) {
    scene_item *item = &v->items[index];
    if (item->loaded && item->content.lod) {
        viewer_tell(v, "%s: an octree has the colours of its points", item->name);
        item->wish = item->coloring;
    }
    if (!item->loaded || !item->content.cloud) return;
    if (!loader_color(v->loader, item->id, &item->content, &item->wish))
        viewer_tell(v, "%s: out of memory", item->name);
    wait_if_asked(v);
}

bool items_bounds(const viewer *v, double low_world[3], double high_world[3]) {
    bool any = false;
    for (size_t i = 0; i < v->item_count; i++) {
        const scene_item *item = &v->items[i];
        if (!item->visible) continue;
        ewa_bounds bounds = {.finite_count = 0};
        if (item_surfels(item)) {
            ewa_surfels_info info;
            ewa_surfels_describe(item_surfels(item), &info);
            bounds = info.bounds;
        } else if (item->content.voxels) {
            ewa_voxels_info info;
            ewa_voxels_describe(item->content.voxels, &info);
            bounds = info.bounds;
        } else if (item->content.splats) {
            ewa_splats_info info;
            ewa_splats_describe(item->content.splats, &info);
            bounds = info.core;
        } else if (item->content.lod) {
            ewa_lod_info info;
            ewa_lod_describe(item->content.lod, &info);
            bounds = info.bounds;
            bounds.finite_count = info.point_count;
        }
        if (!bounds.finite_count || !(bounds.low_world[0] <= bounds.high_world[0])) continue;
        for (int c = 0; c < 3; c++) {
            low_world[c] = any ? fmin(low_world[c], bounds.low_world[c]) : bounds.low_world[c];
            high_world[c] = any ? fmax(high_world[c], bounds.high_world[c]) : bounds.high_world[c];
        }
        any = true;
    }
    return any;
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
    const viewer_content *contents[VIEWER_MAX_ITEMS];
    const char *paths[VIEWER_MAX_ITEMS];
    size_t count = 0;
    for (size_t i = 0; i < v->item_count; i++) {
        const scene_item *item = &v->items[i];
        if (!item->visible || (!item->content.cloud && !item->content.outline)) continue;
        contents[count] = &item->content;
        paths[count++] = item->path;
    }
    if (!count) return false;
    ewa_camera camera;
    ewa_camera_init(&camera);
    camera.width_px = v->camera.width_px;
    camera.height_px = v->camera.height_px;
    if (!v->services.place(v->services.user, count, contents, paths, view, &camera, v->up_world))
        return false;
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

/// Takes in what was loaded; the first look at it is the program's.
static void take_content(viewer *v, loader_note *note) {
    scene_item *item = find_item(v, note->item);
    if (!item) return;
    clear_item(v, item);
    item->content = note->content;
    note->content = (viewer_content){.context = NULL};
    item->preview = note->kind == LOADER_PREVIEW;
    item->loaded = !item->preview;
    if (!v->placed) items_place(v, NULL, false);
    measure(v, false);
}

static void take_failure(viewer *v, const loader_note *note) {
    scene_item *item = find_item(v, note->item);
    if (!item) return;
    if (item->loaded)
        item->wish = item->coloring;
    else
        remove_item(v, (size_t)(item - v->items));
}

static void take_surfels(viewer *v, loader_note *note) {
    scene_item *item = find_item(v, note->item);
    if (!item) return;
    painter_rest(v->painter);
    ewa_surfels_destroy(&item->made);
    item->made = note->surfels;
    note->surfels = NULL;
    item->coloring = note->coloring;
    viewer_change(v);
}

void items_update(viewer *v) {
    for (loader_note *note; (note = loader_take(v->loader));) {
        switch (note->kind) {
        case LOADER_LOAD:
        case LOADER_PREVIEW:
            take_content(v, note);
            break;
        case LOADER_COLOR:
            take_surfels(v, note);
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
    for (size_t i = 0; i < v->item_count; i++) {
        const scene_item *item = &v->items[i];
        if (!item->visible) continue;
        if (item_surfels(item)) {
            scene->surfels[scene->surfels_count++] = item_surfels(item);
            if (item->content.as_points && scene->render.point_size_px == 0)
                scene->render.point_size_px = PREVIEW_POINT_PX;
        }
        if (item->content.lod) scene->lods[scene->lods_count++] = item->content.lod;
        if (item->content.voxels) scene->voxels[scene->voxels_count++] = item->content.voxels;
        if (item->content.splats) scene->splats[scene->splats_count++] = item->content.splats;
    }
}

size_t viewer_item_count(const viewer *v) { return v->item_count; }

bool viewer_item_get(const viewer *v, size_t index, viewer_item *item) {
    if (index >= v->item_count) return false;
    const scene_item *from = &v->items[index];
    *item = (viewer_item){.path = from->path,
                          .visible = from->visible,
                          .volume = from->content.voxels != NULL,
                          .gaussians = from->content.splats != NULL,
                          .mesh = from->content.mesh,
                          .coloring = from->coloring};
    memcpy(item->name, from->name, sizeof item->name);
    if (from->content.cloud) item->count = ewa_cloud_point_count(from->content.cloud);
    if (from->content.lod) {
        ewa_lod_info info;
        ewa_lod_describe(from->content.lod, &info);
        item->count = info.point_count;
    }
    if (from->content.voxels) {
        ewa_voxels_info info;
        ewa_voxels_describe(from->content.voxels, &info);
        item->count = info.voxel_count;
    }
    if (from->content.splats) {
        ewa_splats_info info;
        ewa_splats_describe(from->content.splats, &info);
        item->count = info.splat_count;
    }
    return true;
}

const char *viewer_attribute_at(const viewer *v, size_t index, uint32_t wanted,
                                char name[EWA_NAME_BYTES + 4]) {
    if (index >= v->item_count || !v->items[index].content.cloud) return NULL;
    const ewa_cloud *cloud = v->items[index].content.cloud;
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

void items_cycle_color(viewer *v) {
    for (size_t i = 0; i < v->item_count; i++) {
        scene_item *item = &v->items[i];
        char name[EWA_NAME_BYTES + 4];
        uint32_t k = 0;
        if (item->wish.attribute[0]) {
            while (viewer_attribute_at(v, i, k, name) && strcmp(name, item->wish.attribute) != 0) k++;
            k++;
        }
        const bool more = viewer_attribute_at(v, i, k, name) != NULL;
        snprintf(item->wish.attribute, sizeof item->wish.attribute, "%s", more ? name : "");
        item->wish.ranged = false;
        items_recolor(v, i);
    }
}
