// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Services of a viewer whose files are names of generated objects.
#include "view_contents.h"
#include "check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/// What an asset of the tests is of, freed with it.
typedef struct held {
    view_contents *contents;
    ewa_context *context; ///< its own; NULL: that of the loading thread
    ewa_cloud *cloud, *outline;
    ewa_surfels *surfels;
    ewa_voxels *voxels;
    ewa_lod *lod;
} held;

static void free_held(void *user) {
    held *own = user;
    ewa_surfels_destroy(&own->surfels);
    ewa_voxels_destroy(&own->voxels);
    ewa_lod_close(&own->lod);
    ewa_cloud_destroy(&own->cloud);
    ewa_cloud_destroy(&own->outline);
    ewa_context_destroy(&own->context);
    own->contents->frees++;
    free(own);
}

static bool make_cloud(ewa_context *context, const char *path, uint64_t count, ewa_cloud **cloud) {
    WITH_DEFAULTS(ewa_generate_options, options);
    options.point_count = count;
    options.object = strcmp(path, "plane") == 0    ? EWA_OBJECT_PLANE
                     : strcmp(path, "sphere") == 0 ? EWA_OBJECT_SPHERE
                                                   : EWA_OBJECT_TORUS;
    return ewa_cloud_generate(context, &options, cloud) == EWA_OK;
}

static bool make_volume(ewa_context *context, held *own) {
    WITH_DEFAULTS(ewa_volume_generate_options, options);
    options.object = EWA_VOLUME_BALL;
    for (int c = 0; c < 3; c++) options.dims[c] = 24;
    ewa_volume volume;
    ewa_volume_facts facts;
    ewa_transfer transfer;
    WITH_DEFAULTS(ewa_voxels_options, levels);
    levels.level_count = VIEWER_VOXEL_LEVELS;
    if (ewa_volume_generate(context, &options, &volume) != EWA_OK) return false;
    const bool done = ewa_volume_measure(&volume, &facts) == EWA_OK &&
                      ewa_transfer_automatic(&volume, &facts, &transfer) == EWA_OK &&
                      ewa_voxels_create(&volume, &transfer, &levels, &own->voxels) == EWA_OK &&
                      ewa_volume_outline(&volume, &transfer, 2, &own->outline) == EWA_OK;
    ewa_volume_free(&volume);
    return done;
}

/// Makes the files of an octree once for each run, and opens it.
static bool make_octree(held *own) {
    static bool made;
    char cloud_path[1024], tree_path[1024];
    snprintf(cloud_path, sizeof cloud_path, "%s/viewer_octree.ply", getenv("EWA_BINARY_DIR"));
    snprintf(tree_path, sizeof tree_path, "%s/viewer_octree.copc.laz", getenv("EWA_BINARY_DIR"));
    const char *paths[1] = {cloud_path};
    ewa_cloud *cloud = NULL;
    if (ewa_context_create(NULL, &own->context) != EWA_OK) return false;
    bool done = made || (make_cloud(own->context, "torus", CONTENTS_OCTREE_POINTS, &cloud) &&
                         ewa_cloud_save(cloud, cloud_path, NULL) == EWA_OK &&
                         ewa_lod_build(own->context, paths, 1, tree_path, NULL, NULL) == EWA_OK);
    made = done;
    ewa_cloud_destroy(&cloud);
    return done && ewa_lod_open(own->context, tree_path, &own->lod) == EWA_OK;
}

static ewa_context *context(void *user, const viewer_news *news) {
    (void)news;
    view_contents *contents = user;
    if (!contents->context) ewa_context_create(NULL, &contents->context);
    return contents->context;
}

static bool load(void *user, const char *path, const ewa_asset_options *said, const viewer_news *news, ewa_asset **asset) {
    (void)said;
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
    if (object && contents->preview) {
        ewa_cloud *cloud = NULL;
        held *own = calloc(1, sizeof *own);
        own->contents = contents;
        ewa_asset *preview = NULL;
        if (make_cloud(contents->context, path, 500, &cloud) &&
            ewa_surfels_create(cloud, NULL, &own->surfels) == EWA_OK &&
            ewa_asset_create(contents->context,
                             &(ewa_asset_source){.surfels = own->surfels, .release = free_held, .user = own},
                             NULL, &preview) == EWA_OK)
            news->preview(news->user, preview, false);
        ewa_cloud_destroy(&cloud);
    }
    held *own = calloc(1, sizeof *own);
    own->contents = contents;
    const bool made = octree   ? make_octree(own)
                      : object ? make_cloud(contents->context, path, CONTENTS_POINTS, &own->cloud)
                               : make_volume(contents->context, own);
    const ewa_asset_source source = {.name = path,
                                     .cloud = own->cloud,
                                     .lod = own->lod,
                                     .voxels = own->voxels,
                                     .outline = own->outline,
                                     .release = free_held,
                                     .user = own};
    return made && ewa_asset_create(contents->context, &source, NULL, asset) == EWA_OK;
}

/// Looks along y at the unit ball, or down for "top".
static bool place(void *user, ewa_scene *scene, const char *view, bool color_bar, ewa_camera *camera, double up_world[3]) {
    (void)user, (void)scene, (void)color_bar;
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
                             .context = context,
                             .load = load,
                             .place = place,
                             .say = say,
                             .clipboard_set = clipboard_set,
                             .clipboard_get = clipboard_get};
}

viewer *view_contents_viewer(view_contents *contents) {
    const viewer_options options = {.services = view_contents_services(contents),
                                    .thread_count = 1,
                                    .cpu_mask = EWA_CPU_ALL,
                                    .width = 64,
                                    .height = 48,
                                    .scale = 1,
                                    .waits = true};
    viewer *made = NULL;
    assert_int_equal(viewer_create(&options, &made), EWA_OK);
    return made;
}
