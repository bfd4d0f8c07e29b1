// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a page calls of the library in WebAssembly: bytes become a scene, a camera goes about it, pictures come out. One view at a
// time for each module, since a page instantiates as many as it wants.
#include "ewa/ewa.h"
#include "viewer/navigate.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXPORT(name) __attribute__((export_name(#name))) name

enum { MESSAGE_BYTES = 1024 };

typedef struct page {
    ewa_context *context;
    ewa_scene *scene;
    ewa_scene_renderer *renderer;
    ewa_camera camera;
    ewa_view_info view;
    uint8_t *rgba8;
    size_t rgba8_bytes;
    char message[MESSAGE_BYTES]; ///< the last error
} page;

/// Makes an empty view; NULL where there is no memory, or where the host's multiply-add rounds twice and the exact module is to be
/// loaded.
page *EXPORT(page_create)(void);

/// Ends it.
void EXPORT(page_destroy)(page *p);

/// Returns memory for bytes of a file, which page_open() takes, or NULL.
uint8_t *EXPORT(page_allocate)(size_t size_bytes);

/// Shows a file, the format by content (points, meshes, Gaussians), in place of what was there; the bytes are freed. `name`, of
/// the same memory, ends by 0 and is freed too. False: page_message() says why.
bool EXPORT(page_open)(page *p, char *name, uint8_t *bytes, size_t size_bytes);

/// Carries the camera about the middle, degrees, as a hand turns what is in front of it.
void EXPORT(page_orbit)(page *p, double right_deg, double down_deg);

/// Multiplies the distance to the middle.
void EXPORT(page_zoom)(page *p, double factor);

/// Draws; returns 4 bytes a pixel, rows from the top, sRGB, valid until the next call, or NULL: page_message() says why.
const uint8_t *EXPORT(page_draw)(page *p, uint32_t width_px, uint32_t height_px);

/// Returns the last error, ended by 0.
const char *EXPORT(page_message)(const page *p);

static void keep_message(void *user, ewa_severity severity, const char *text) {
    page *p = user;
    if (severity == EWA_SEVERITY_ERROR) snprintf(p->message, sizeof p->message, "%s", text);
}

page *page_create(void) {
    page *made = calloc(1, sizeof *made);
    if (!made) return NULL;
    ewa_context_options options;
    ewa_context_options_init(&options, sizeof options);
    options.message = keep_message;
    options.message_user = made;
    options.untrusted = true;
    if (ewa_context_create(&options, &made->context) == EWA_OK) return made;
    free(made);
    return NULL;
}

static void close_scene(page *p) {
    ewa_scene_renderer_destroy(&p->renderer);
    ewa_scene_destroy(&p->scene);
}

void page_destroy(page *p) {
    if (!p) return;
    close_scene(p);
    ewa_context_destroy(&p->context);
    free(p->rgba8);
    free(p);
}

uint8_t *page_allocate(size_t size_bytes) { return malloc(size_bytes ? size_bytes : 1); }

static void destroy_cloud(void *cloud) {
    ewa_cloud *old = cloud;
    ewa_cloud_destroy(&old);
}

/// Makes an asset of a file's bytes.
static ewa_status make_asset(page *p, const char *name, const uint8_t *bytes, size_t size_bytes, ewa_asset **asset) {
    ewa_gaussians gaussians;
    ewa_asset_source source = {.name = name};
    if (ewa_gaussians_load_memory(p->context, bytes, size_bytes, name, NULL, &gaussians, NULL) == EWA_OK) {
        source.gaussians = &gaussians;
        const ewa_status status = ewa_asset_create(p->context, &source, NULL, asset);
        ewa_gaussians_free(&gaussians);
        return status;
    }
    ewa_model model;
    const ewa_status status =
        ewa_model_load_memory(p->context, bytes, size_bytes, name, NULL, EWA_MODEL_MESH, NULL, &model);
    if (status != EWA_OK) return status;
    if (model.points) {
        source.cloud = model.points;
        source.release = destroy_cloud;
        source.user = model.points;
        model.points = NULL;
    } else {
        source.mesh = &model.mesh;
    }
    const ewa_status made = ewa_asset_create(p->context, &source, NULL, asset);
    ewa_model_free(&model);
    return made;
}

bool page_open(page *p, char *name, uint8_t *bytes, size_t size_bytes) {
    ewa_asset *asset = NULL;
    close_scene(p);
    ewa_status status = make_asset(p, name, bytes, size_bytes, &asset);
    free(bytes);
    if (status == EWA_OK) status = ewa_scene_create(p->context, NULL, &p->scene);
    if (status == EWA_OK) status = ewa_scene_add(p->scene, asset, NULL);
    ewa_asset_release(&asset);
    if (status == EWA_OK) status = ewa_scene_renderer_create(p->context, EWA_BACKEND_CPU, NULL, &p->renderer);
    if (status == EWA_OK) status = ewa_scene_place_camera(p->scene, NULL, &p->camera, &p->view);
    free(name);
    if (status == EWA_OK) return true;
    close_scene(p);
    return false;
}

void page_orbit(page *p, double right_deg, double down_deg) {
    navigate_orbit(&p->camera, p->view.pivot_world, p->view.up_world, right_deg, down_deg);
}

void page_zoom(page *p, double factor) { navigate_zoom(&p->camera, p->view.pivot_world, factor); }

const uint8_t *page_draw(page *p, uint32_t width_px, uint32_t height_px) {
    const size_t wanted_bytes = 4 * (size_t)width_px * height_px;
    if (!p->scene || width_px == 0 || height_px == 0) {
        snprintf(p->message, sizeof p->message, "there is nothing to draw");
        return NULL;
    }
    if (wanted_bytes > p->rgba8_bytes) {
        free(p->rgba8);
        p->rgba8 = malloc(wanted_bytes);
        p->rgba8_bytes = p->rgba8 ? wanted_bytes : 0;
        if (!p->rgba8) {
            snprintf(p->message, sizeof p->message, "no memory for %u x %u pixels", width_px, height_px);
            return NULL;
        }
    }
    if (p->camera.width_px != width_px || p->camera.height_px != height_px) navigate_resize(&p->camera, width_px, height_px);
    const ewa_frame frame = {.rgba8 = p->rgba8};
    return ewa_scene_draw(p->scene, p->renderer, &p->camera, NULL, &frame, NULL) == EWA_OK ? p->rgba8 : NULL;
}

const char *page_message(const page *p) { return p->message; }
