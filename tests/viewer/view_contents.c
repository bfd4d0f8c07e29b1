// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Services of a viewer whose files are names of generated objects.
#include "view_contents.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static void free_content(viewer_content *content) {
    view_contents *contents = content->keeper;
    ewa_surfels_destroy(&content->surfels);
    ewa_voxels_destroy(&content->voxels);
    ewa_lod_close(&content->lod);
    ewa_cloud_destroy(&content->cloud);
    ewa_cloud_destroy(&content->outline);
    ewa_context_destroy(&content->context);
    contents->frees++;
}

static bool make_object(const char *path, uint64_t count, viewer_content *content) {
    ewa_generate_options options;
    ewa_generate_options_init(&options, sizeof options);
    options.point_count = count;
    options.object = strcmp(path, "plane") == 0    ? EWA_OBJECT_PLANE
                     : strcmp(path, "sphere") == 0 ? EWA_OBJECT_SPHERE
                                                   : EWA_OBJECT_TORUS;
    ewa_surfels_options surfels;
    ewa_surfels_options_init(&surfels, sizeof surfels);
    surfels.level_count = 4;
    return ewa_cloud_generate(content->context, &options, &content->cloud) == EWA_OK &&
           ewa_surfels_create(content->cloud, &surfels, &content->surfels) == EWA_OK;
}

static bool make_volume(viewer_content *content) {
    ewa_volume_generate_options options;
    ewa_volume_generate_options_init(&options, sizeof options);
    options.object = EWA_VOLUME_BALL;
    for (int c = 0; c < 3; c++) options.dims[c] = 24;
    ewa_volume volume;
    ewa_volume_facts facts;
    ewa_transfer transfer;
    if (ewa_volume_generate(content->context, &options, &volume) != EWA_OK) return false;
    const bool done = ewa_volume_measure(&volume, &facts) == EWA_OK &&
                      ewa_transfer_automatic(&volume, &facts, &transfer) == EWA_OK &&
                      ewa_voxels_create(&volume, &transfer, NULL, &content->voxels) == EWA_OK &&
                      ewa_volume_outline(&volume, &transfer, 2, &content->outline) == EWA_OK;
    ewa_volume_free(&volume);
    return done;
}

/// Makes the files of an octree once for each run, and opens it.
static bool make_octree(viewer_content *content) {
    static bool made;
    char cloud_path[1024], tree_path[1024];
    snprintf(cloud_path, sizeof cloud_path, "%s/viewer_octree.ply", getenv("EWA_BINARY_DIR"));
    snprintf(tree_path, sizeof tree_path, "%s/viewer_octree.copc.laz", getenv("EWA_BINARY_DIR"));
    const char *paths[1] = {cloud_path};
    ewa_generate_options options;
    ewa_generate_options_init(&options, sizeof options);
    options.object = EWA_OBJECT_TORUS;
    options.point_count = CONTENTS_OCTREE_POINTS;
    ewa_cloud *cloud = NULL;
    bool done = made || (ewa_cloud_generate(content->context, &options, &cloud) == EWA_OK &&
                         ewa_cloud_save(cloud, cloud_path, NULL) == EWA_OK &&
                         ewa_lod_build(content->context, paths, 1, tree_path, NULL, NULL) == EWA_OK);
    made = done;
    ewa_cloud_destroy(&cloud);
    return done && ewa_lod_open(content->context, tree_path, &content->lod) == EWA_OK &&
           ewa_lod_sample(content->lod, 1000, &content->outline) == EWA_OK;
}

static bool load(void *user, const char *path, const viewer_news *news, viewer_content *content) {
    view_contents *contents = user;
    contents->loads++;
    while (contents->holds) {
        nanosleep(&(struct timespec){.tv_nsec = 200000}, NULL);
        if (!news->progress(news->user, "hold", 0.5)) return false;
    }
    const bool object =
        strcmp(path, "plane") == 0 || strcmp(path, "sphere") == 0 || strcmp(path, "torus") == 0;
    const bool octree = strcmp(path, "octree") == 0;
    if (!object && !octree && strcmp(path, "volume") != 0) {
        char text[256];
        snprintf(text, sizeof text, "%.100s: no such object", path);
        news->message(news->user, EWA_SEVERITY_ERROR, text);
        return false;
    }
    viewer_content preview = {.keeper = contents, .free = free_content};
    if (object && contents->preview && ewa_context_create(NULL, &preview.context) == EWA_OK) {
        if (make_object(path, 500, &preview))
            news->preview(news->user, &preview);
        else
            free_content(&preview);
    }
    *content = (viewer_content){.keeper = contents, .free = free_content};
    if (ewa_context_create(NULL, &content->context) != EWA_OK) return false;
    if (octree) return make_octree(content);
    return object ? make_object(path, CONTENTS_POINTS, content) : make_volume(content);
}

/// Red for any wish, so that it shows.
static bool color(void *user, const viewer_content *content, const viewer_news *news, viewer_coloring *wish,
                  ewa_surfels **surfels) {
    (void)news;
    view_contents *contents = user;
    contents->colors++;
    if (strcmp(wish->attribute, "bad") == 0) return false;
    ewa_cloud *cloud = NULL;
    const uint64_t count = ewa_cloud_point_count(content->cloud);
    bool done = ewa_cloud_create(content->context, count, &cloud) == EWA_OK;
    const ewa_attribute *a;
    for (uint32_t k = 0; done && (a = ewa_cloud_attribute_at(content->cloud, k)); k++)
        done =
            ewa_cloud_borrow(cloud, a->name, a->type, a->component_count, a->data, a->stride_bytes) == EWA_OK;
    void *data = NULL;
    done = done && ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, &data) == EWA_OK;
    for (uint64_t i = 0; done && i < count; i++) memcpy((uint8_t *)data + 3 * i, "\xff\0\0", 3);
    wish->range[0] = -1, wish->range[1] = 1;
    done = done && ewa_surfels_create(cloud, NULL, surfels) == EWA_OK;
    ewa_cloud_destroy(&cloud);
    return done;
}

/// Looks along y at the unit ball, or down for "top".
static bool place(void *user, size_t count, const viewer_content *const *contents, const char *const *paths,
                  const char *view, ewa_camera *camera, double up_world[3]) {
    (void)user, (void)count, (void)contents, (void)paths;
    static const double front[3] = {0, -6, 0}, above[3] = {0, 0, 6}, middle[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    const bool top = view && strcmp(view, "top") == 0;
    memcpy(up_world, up, sizeof up);
    return ewa_camera_set_fov(camera, 30) == EWA_OK &&
           ewa_camera_look_at(camera, top ? above : front, middle, up) == EWA_OK;
}

static void say(void *user, bool message, const char *text) {
    view_contents *contents = user;
    snprintf(message ? contents->message : contents->said, sizeof contents->said, "%s", text);
}

static void clipboard_set(void *user, const char *text) {
    view_contents *contents = user;
    snprintf(contents->clipboard, sizeof contents->clipboard, "%s", text);
}

static bool clipboard_get(void *user, char *text, size_t text_bytes) {
    const view_contents *contents = user;
    snprintf(text, text_bytes, "%s", contents->clipboard);
    return contents->clipboard[0] != 0;
}

viewer_services view_contents_services(view_contents *contents) {
    return (viewer_services){.user = contents,
                             .load = load,
                             .color = color,
                             .place = place,
                             .say = say,
                             .clipboard_set = clipboard_set,
                             .clipboard_get = clipboard_get};
}
