// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Frames of several sources of every kind.
#include "cluster/joint_frames.h"

#include <string.h>

enum { POINTS = 2500 };

static const scene_kind kinds[JOINT_PARTS] = {SCENE_SPHERE, SCENE_CUBE, SCENE_ELLIPSES, SCENE_NEAR,
                                              SCENE_TORUS};

/// Gives every point one of three materials.
static void add_materials(ewa_cloud *cloud) {
    uint8_t *material = check_add(cloud, EWA_MATERIAL, EWA_U8, 1);
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) material[i] = (uint8_t)(i / 7 % 3);
}

/// Makes surfels of a part in a context and adds them.
static ewa_surfels *add_part(ewa_context *context, ewa_renderer *renderer, const joint_frame *of,
                             uint32_t part) {
    scene made;
    assert_int_equal(scene_make(context, kinds[part], POINTS, JOINT_WIDTH_PX, JOINT_HEIGHT_PX, &made),
                     EWA_OK);
    if (of->clips && part != 2) picture_add_clips(made.cloud);
    if (of->materials) add_materials(made.cloud);
    ewa_surfels *surfels = check_surfels(made.cloud, NULL);
    assert_int_equal(ewa_render_add_source(renderer, surfels, &of->how[part]), EWA_OK);
    scene_free(&made);
    return surfels;
}

ewa_status joint_frame_draw(ewa_context *context, ewa_renderer *renderer, const joint_frame *of,
                            uint32_t rank, uint32_t rank_count, const picture *into) {
    ewa_surfels *surfels[JOINT_PARTS] = {NULL};
    const ewa_frame frame = of->planes ? into->frame : (ewa_frame){.rgba8 = into->frame.rgba8};
    ewa_status status = ewa_render_begin(renderer, &of->camera, &of->options, &frame);
    for (uint32_t i = rank; i < JOINT_PARTS; i += rank_count) surfels[i] = add_part(context, renderer, of, i);
    if (status == EWA_OK) status = ewa_render_finish(renderer, NULL);
    for (uint32_t i = 0; i < JOINT_PARTS; i++) ewa_surfels_destroy(&surfels[i]);
    return status;
}

bool joint_frame_same(const joint_frame *of, const picture *a, const picture *b) {
    const size_t pixels = (size_t)JOINT_WIDTH_PX * JOINT_HEIGHT_PX;
    if (memcmp(a->frame.rgba8, b->frame.rgba8, 4 * pixels) != 0) return false;
    return !of->planes || (memcmp(a->frame.rgba, b->frame.rgba, 16 * pixels) == 0 &&
                           memcmp(a->frame.depth, b->frame.depth, 4 * pixels) == 0 &&
                           memcmp(a->frame.normal, b->frame.normal, 12 * pixels) == 0 &&
                           memcmp(a->frame.coverage, b->frame.coverage, 4 * pixels) == 0);
}

/// What else there is to frames from the thirteenth on, which mix what those before have alone.
static void mix(int index, joint_frame *made) {
    ewa_render_options *o = &made->options;
    switch (index) {
    case 12:
        made->materials = true;
        o->materials = made->table, o->material_count = 3;
        o->shading = EWA_SHADING_PHONG;
        break;
    case 13:
        made->materials = made->clips = true;
        o->materials = made->table, o->material_count = 3;
        o->shading = EWA_SHADING_PHONG, o->opacity = 0.7, o->eye_dome = 0.5;
        break;
    case 14:
        made->clips = true;
        o->opacity = 0.4, o->layers = EWA_LAYERS_EXACT;
        break;
    case 15:
        o->shading = EWA_SHADING_LAMBERT;
        o->section_count = 2;
        o->section_planes[0][1] = 1, o->section_planes[0][3] = 0.2;
        o->section_planes[1][2] = -1, o->section_planes[1][3] = 0.3;
        break;
    case 16:
        made->camera.projection = EWA_ORTHOGRAPHIC;
        made->camera.fx_px = made->camera.fy_px = 40;
        break;
    case 17:
        made->how[0].weight = 0.5, made->how[1] = (ewa_render_source){0.25, false};
        o->opacity = 0.6, o->layers = 2;
        break;
    case 18:
        made->camera.projection = EWA_ORTHOGRAPHIC;
        made->camera.fx_px = made->camera.fy_px = 40;
        o->kernel = EWA_KERNEL_RAYCAST, o->eye_dome = 2;
        break;
    case 19:
        o->supersampling = 3;
        break;
    case 20: // of surfels far below a pixel, which say how many parts it has
        made->camera.fx_px /= 16, made->camera.fy_px /= 16;
        break;
    default:
        o->edge_layers = 1;
        o->cull = EWA_CULL_BACK;
        break;
    }
}

void joint_frame_make(ewa_context *context, int index, joint_frame *made) {
    memset(made, 0, sizeof *made);
    scene of;
    assert_int_equal(
        scene_make(context, kinds[index % JOINT_PARTS], POINTS, JOINT_WIDTH_PX, JOINT_HEIGHT_PX, &of),
        EWA_OK);
    made->camera = of.camera;
    scene_free(&of);
    for (int i = 0; i < JOINT_PARTS; i++) made->how[i] = (ewa_render_source){1, true};
    for (int i = 0; i < 3; i++) ewa_material_init(&made->table[i]);
    made->table[1].diffuse = 0.3f, made->table[2].specular = 0.9f;
    ewa_render_options *o = &made->options;
    ewa_render_options_init(o, sizeof *o);
    made->planes = index % 2;
    switch (index) {
    case 0:
    case 1:
        break;
    case 2:
        o->opacity = 0.5;
        break;
    case 3:
        o->opacity = 0.5, o->layers = 3;
        break;
    case 4:
        o->kernel = EWA_KERNEL_RAYCAST;
        break;
    case 5:
        o->passes = 1;
        break;
    case 6:
        o->edge_antialiasing = false;
        break;
    case 7:
        o->eye_dome = 1;
        break;
    case 8:
        made->clips = true;
        break;
    case 9:
        made->how[2].weight = 0.3, made->how[4] = (ewa_render_source){0.7, false};
        break;
    case 10:
        o->point_size_px = 3;
        break;
    case 11:
        o->section_count = 1, o->section_planes[0][0] = 1, o->section_planes[0][3] = -0.05;
        break;
    default:
        mix(index, made);
        break;
    }
}
