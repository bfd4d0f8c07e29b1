// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Settings by their names: the viewer's own, the renderer's, the furniture's, those of Gaussians and of photographs, from their tables.
#include "inner.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define ROW(member) offsetof(viewer_settings, member)

static const ewa_option own_table[] = {
    {"navigation", EWA_OPTION_CHOICE, ROW(navigation), .words = "turntable|trackball|fly",
     .help = "how the left button turns: with an upright horizon, freely, or the head"},
    {"budget_ms", EWA_OPTION_F64, ROW(budget_ms), 1, 10000, .initial = 25, .unit = "ms",
     .help = "what a picture may take while something moves"},
    {"reduce", EWA_OPTION_BOOL, ROW(reduce), .initial = 1,
     .help = "draw smaller pictures while something moves in large windows, or where drawing is slow"},
    {"animate", EWA_OPTION_BOOL, ROW(animate), .initial = 1, .help = "let the camera travel to where it is sent"},
    {"volume_density", EWA_OPTION_F64, ROW(volume_density), 0, 100, .initial = 1,
     .help = "multiplies the extinctions of volumes"},
};

const ewa_option_table viewer_settings_table = {
    "viewer_settings", own_table, sizeof own_table / sizeof own_table[0], sizeof(viewer_settings)};

/// What a panel shows, of which struct.
typedef enum setting_owner { OWN, RENDER, FURNITURE, LOD, PHOTOS, GAUSSIANS } setting_owner;

static const struct {
    const char *group;
    setting_owner owner;
    const char *name;
} shown[] = {
    {"Look", RENDER, "shading"},
    {"Look", RENDER, "ambient"},
    {"Look", RENDER, "eye_dome"},
    {"Look", RENDER, "opacity"},
    {"Look", RENDER, "cull"},
    {"Look", OWN, "volume_density"},
    {"Splats", RENDER, "kernel"},
    {"Splats", RENDER, "prefilter_px"},
    {"Splats", RENDER, "point_size_px"},
    {"Splats", RENDER, "edge_antialiasing"},
    {"Splats", RENDER, "edge_layers"},
    {"Splats", RENDER, "layers"},
    {"Splats", RENDER, "supersampling"},
    {"Splats", RENDER, "tolerance"},
    {"Splats", RENDER, "passes"},
    {"Octrees", LOD, "spacing_px"},
    {"Octrees", LOD, "error"},
    {"Gaussians", GAUSSIANS, "display"},
    {"Gaussians", GAUSSIANS, "ellipsoid_radius"},
    {"Gaussians", GAUSSIANS, "dot_px"},
    {"Gaussians", GAUSSIANS, "projection"},
    {"Gaussians", GAUSSIANS, "filter"},
    {"Gaussians", GAUSSIANS, "sh_degree"},
    {"Furniture", FURNITURE, "axes"},
    {"Furniture", FURNITURE, "scale_bar"},
    {"Furniture", FURNITURE, "color_bar"},
    {"Photographs", PHOTOS, "method"},
    {"Photographs", PHOTOS, "exposure"},
    {"Photographs", PHOTOS, "hold_out"},
    {"Photographs", PHOTOS, "rounds"},
    {"Photographs", PHOTOS, "pose_steps"},
    {"Photographs", PHOTOS, "vignetting"},
    {"Moving", OWN, "navigation"},
    {"Moving", OWN, "budget_ms"},
    {"Moving", OWN, "reduce"},
};

static const ewa_option_table *const tables[] = {&viewer_settings_table, &ewa_render_options_table,
                                                 &ewa_furniture_options_table, &ewa_lod_options_table,
                                                 &ewa_photos_options_table, &ewa_gaussian_options_table};

/// The struct that an owner's options are in.
static void *place_of(viewer *v, setting_owner owner) {
    void *const places[] = {&v->settings, &v->render, &v->furniture, &v->lod, &v->photos, &v->base.gaussians};
    return places[owner];
}

void settings_init(viewer *v) {
    v->settings = (viewer_settings){
        .struct_size = sizeof v->settings, .budget_ms = 25, .reduce = true, .animate = true, .volume_density = 1};
    ewa_photos_options_init(&v->photos, sizeof v->photos);
}

const ewa_option *viewer_setting_at(const viewer *v, uint32_t index, const char **group) {
    (void)v;
    if (index >= sizeof shown / sizeof shown[0]) return NULL;
    *group = shown[index].group;
    return ewa_option_find(tables[shown[index].owner], shown[index].name);
}

/// Finds a setting of any of the structs; a setting of the renderer that the viewer chooses itself is none.
static const ewa_option *find(const char *name, setting_owner *owner) {
    static const char *const own_choice[] = {"level", "budget_s", "load_s", "resident_only", "merge_px", "section_count"};
    for (size_t i = 0; i < sizeof own_choice / sizeof own_choice[0]; i++)
        if (strcmp(name, own_choice[i]) == 0) return NULL;
    for (int k = OWN; k <= GAUSSIANS; k++) {
        const ewa_option *option = ewa_option_find(tables[k], name);
        *owner = (setting_owner)k;
        if (option) return option;
    }
    return NULL;
}

bool viewer_setting_get(const viewer *v, const char *name, char text[EWA_OPTION_TEXT_BYTES]) {
    setting_owner owner;
    if (strcmp(name, "title") == 0) {
        snprintf(text, EWA_OPTION_TEXT_BYTES, "%.*s", EWA_OPTION_TEXT_BYTES - 1, v->title);
        return true;
    }
    const ewa_option *option = find(name, &owner);
    if (option) ewa_option_get(option, place_of((viewer *)v, owner), text);
    return option != NULL;
}

static bool set_background(viewer *v, const char *text) {
    double srgba[4];
    if (!ewa_color_read(text, srgba)) {
        viewer_tell(v,
                    "background: '%s' is not r,g,b[,a] in [0, 1], #rrggbb, white, black, gray or transparent",
                    text);
        return false;
    }
    for (int c = 0; c < 3; c++) v->render.background[c] = ewa_linear_from_srgb((float)srgba[c]);
    v->render.background[3] = (float)srgba[3];
    return true;
}

bool viewer_setting_set(viewer *v, const char *name, const char *text) {
    setting_owner owner = OWN;
    char problem[EWA_OPTION_TEXT_BYTES];
    if (strcmp(name, "background") == 0) {
        if (!set_background(v, text)) return false;
    } else if (strcmp(name, "title") == 0) {
        snprintf(v->title, sizeof v->title, "%s", text);
        v->furniture.title = v->title[0] ? v->title : NULL;
    } else {
        const ewa_option *option = find(name, &owner);
        if (!option) {
            viewer_tell(v, "set: there is no setting '%s'", name);
            return false;
        }
        if (ewa_option_set(option, place_of(v, owner), text, problem) != EWA_OK) {
            viewer_tell(v, "%s: %s", name, problem);
            return false;
        }
    }
    if (owner != FURNITURE && owner != PHOTOS) viewer_change(v);
    viewer_mark(v);
    return true;
}
