// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the calls that write_wrong_arguments.py writes are made of.
#ifndef EWA_TESTS_HOUSE_WRONG_ARGUMENTS_H
#define EWA_TESTS_HOUSE_WRONG_ARGUMENTS_H

#include "ewa/ewa.h"

#include <math.h>
#include <stdint.h>

/// Things that are as they should be, one of each kind.
typedef struct right_things {
    ewa_context *context;
    ewa_cloud *cloud;
    ewa_cloud *clouds[2];
    ewa_image image;
    ewa_mesh mesh;
    ewa_volume volume;
    ewa_volume_facts facts;
    ewa_transfer transfer;
    ewa_gaussians gaussians;
    ewa_renderer *renderer;
    ewa_surfels *surfels;
    ewa_scene *scene;
    ewa_asset *asset;
    ewa_camera camera;
    ewa_camera_path *path;
    ewa_scene_renderer *scene_renderer;
    ewa_scene_reader *scene_reader;
    ewa_framing *framing;
    ewa_polygon *polygon;
    ewa_splats *splats;
    ewa_voxels *voxels;
    ewa_gaussian_renderer *gaussian_renderer;
    ewa_volume_renderer *volume_renderer;
    ewa_warp *warp;
    ewa_environment *environment;
    ewa_cloud_reader *reader;
    ewa_cloud_writer *writer;
    ewa_lod *lod;
    ewa_scene_file *scene_file;
    ewa_elements *elements;
    ewa_photo_list *photo_list;
    const ewa_attribute *attribute;
    ewa_scalar scalar;
    ewa_frame frame;
    ewa_canvas canvas;
    ewa_exchange exchange;
    const char *names[2];
    void *nothing[2]; ///< where a pointer goes
    double numbers[4096]; ///< a matrix of 4 x 4 and what follows
    double vectors[12];
    ewa_mat3 mat3;
    ewa_mat4 mat4;
    ewa_conic conic;
    uint8_t bytes[1 << 16];
} right_things;

extern right_things made;

/// One call with one wrong argument, or with all wrong.
typedef struct wrong_call {
    const char *function, *what;
    int (*call)(int which);
    int which;
} wrong_call;

extern const wrong_call wrong_calls[];

void receive_camera(void *user, uint32_t index, const ewa_camera *camera);
void receive_line(void *user, const char *line);

#endif
