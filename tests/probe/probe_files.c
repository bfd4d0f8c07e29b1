// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files: the fuzz targets' corpora, and round trips of what is written.
#define _DEFAULT_SOURCE // scandir
#include "tests/probe/probe.h"

#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef void put_file(probe *to, const char *name, const char *path);

static void put_cloud(probe *to, const char *name, const char *path) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    probe_status(to, name, ewa_cloud_load(to->context, path, &cloud));
    if (cloud) probe_cloud(to, name, cloud);
}

static void put_image(probe *to, const char *name, const char *path) {
    OWNED(ewa_image_free) ewa_image image;
    memset(&image, 0, sizeof image);
    probe_status(to, name, ewa_image_load(to->context, path, &image));
    probe_image(to, name, &image);
    ewa_image_free(&image);
    probe_status(to, name, ewa_depth_load(to->context, path, &image));
    if (image.pixels) // depths are no colours
        probe_floats(to, name, PROBE_NUMBERS, image.pixels, (size_t)image.width_px * image.height_px);
}

static void put_volume_numbers(probe *to, const char *name, const ewa_volume *volume) {
    const size_t count = (size_t)volume->dims[0] * volume->dims[1] * volume->dims[2];
    OWNED(check_free) double *values = calloc(count ? count : 1, sizeof *values);
    if (!values) abort();
    const ewa_attribute numbers = {.type = volume->type,
                                   .component_count = 1,
                                   .stride_bytes = ewa_type_bytes(volume->type),
                                   .data = volume->voxels};
    if (count) ewa_attribute_read_f64(&numbers, 0, count, values);
    probe_doubles(to, name, PROBE_NUMBERS, values, count);
    probe_doubles(to, name, PROBE_NUMBERS, volume->index_to_world, 12);
}

static void put_volume(probe *to, const char *name, const char *path) {
    OWNED(ewa_volume_free) ewa_volume volume;
    memset(&volume, 0, sizeof volume);
    probe_status(to, name, ewa_volume_load(to->context, path, NULL, &volume));
    put_volume_numbers(to, name, &volume);
}

static void put_camera_cb(void *user, uint32_t index, const ewa_camera *camera) {
    (void)index;
    probe_camera(user, "camera of a file", camera);
}

static void put_cameras(probe *to, const char *name, const char *path) {
    probe_status(to, name, ewa_camera_load_each(to->context, path, put_camera_cb, to));
}

static void put_poses(probe *to, const char *name, const char *path) {
    ewa_camera lens;
    ewa_camera_init(&lens);
    probe_status(to, name, ewa_camera_load_poses(to->context, path, &lens, put_camera_cb, to));
}

static void put_materials(probe *to, const char *name, const char *path) {
    static ewa_material materials[EWA_MAX_MATERIALS];
    uint32_t count = 0;
    probe_status(to, name, ewa_materials_load(to->context, path, materials, &count));
    for (uint32_t i = 0; i < count; i++) probe_floats(to, name, PROBE_NUMBERS, &materials[i].ambient, 5);
}

static void put_transfer_numbers(probe *to, const char *name, const ewa_transfer *transfer) {
    const double numbers[4] = {transfer->point_count, transfer->unit_length_world, transfer->gradient_low,
                               transfer->gradient_high};
    probe_doubles(to, name, PROBE_NUMBERS, numbers, 4);
    for (uint32_t i = 0; i < transfer->point_count && i < EWA_MAX_TRANSFER_POINTS; i++) {
        probe_number(to, name, transfer->points[i].value);
        probe_floats(to, name, PROBE_NUMBERS, transfer->points[i].color, 3);
        probe_number(to, name, (double)transfer->points[i].extinction);
    }
}

static void put_transfer(probe *to, const char *name, const char *path) {
    OWNED(check_free) ewa_transfer *transfer = calloc(1, sizeof *transfer);
    if (!transfer) abort();
    probe_status(to, name, ewa_transfer_load(to->context, path, transfer));
    put_transfer_numbers(to, name, transfer);
}

static void put_folder(probe *to, const char *folder, put_file *put) {
    char path[1024];
    OWNED(check_free) struct dirent **entries = NULL;
    snprintf(path, sizeof path, "%s/tests/fuzz/corpus/%s", to->source_dir, folder);
    const int count = scandir(path, &entries, NULL, alphasort);
    for (int i = 0; i < count; i++) {
        if (entries[i]->d_name[0] != '.') {
            snprintf(path, sizeof path, "%s/tests/fuzz/corpus/%s/%s", to->source_dir, folder,
                     entries[i]->d_name);
            put(to, entries[i]->d_name, path);
        }
        free(entries[i]);
    }
}

static const char *scratch(const probe *to, const char *name) {
    static char path[1024];
    snprintf(path, sizeof path, "%s/%s", to->scratch, name);
    return path;
}

static void write_text(const probe *to, const char *name, const char *text) {
    FILE *file = fopen(scratch(to, name), "wb");
    if (!file) abort();
    fputs(text, file);
    fclose(file);
}

static void put_images_written(probe *to) {
    static const char *const names[] = {"a.png", "a.exr", "a.pfm"};
    ewa_image image;
    for (uint32_t channels = 1; channels <= 4; channels += 1 + (channels == 1)) {
        if (ewa_image_create(to->context, 7, 5, channels, &image) != EWA_OK) abort();
        uint64_t state = 99;
        for (uint32_t i = 0; i < 35 * channels; i++) image.pixels[i] = (float)probe_random(&state);
        for (uint32_t i = 0; channels == 4 && i < 35; i++)
            for (uint32_t c = 0; c < 3; c++) image.pixels[4 * i + c] *= image.pixels[4 * i + 3];
        for (int k = 0; k < 6; k++) {
            WITH_DEFAULTS(ewa_image_save_options, options);
            options.exr_half = k >= 3, options.srgb_alpha_straight = k < 3;
            probe_status(to, "image save", ewa_image_save(&image, scratch(to, names[k % 3]), &options));
            put_image(to, names[k % 3], scratch(to, names[k % 3]));
        }
        ewa_image_free(&image);
    }
}

static void put_clouds_written(probe *to) {
    WITH_DEFAULTS(ewa_generate_options, generate);
    generate.object = EWA_OBJECT_CSG, generate.point_count = 1500, generate.sharp = true,
    generate.texcoords = true;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    const double origin[3] = {1e5, -3, 0.25};
    probe_status(to, "generate", ewa_cloud_generate(to->context, &generate, &cloud));
    if (!cloud) return;
    for (int k = 0; k < 6; k++) {
        WITH_DEFAULTS(ewa_cloud_save_options, options);
        options.ply_encoding = (ewa_ply_encoding)(k % 3);
        if (k == 3) ewa_cloud_set_origin(cloud, origin);
        probe_status(to, "cloud save", ewa_cloud_save(cloud, scratch(to, "a.ply"), &options));
        put_cloud(to, "cloud written", scratch(to, "a.ply"));
    }
}

static void put_meshes(probe *to) {
    write_text(to, "a.mtl", "newmtl red\nKd 0.8 0.1 0.2\nd 0.5\nnewmtl blue\nKd 0.1 0.2 0.9\n");
    write_text(to, "a.obj",
               "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 2 0.5\nv 0 2 0\nv 0 0 3\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
               "usemtl red\nf 1/1 2/2 3/3 4/4\nusemtl blue\nf 1/1 5/3 2/2\nf -1 -2 -4\n");
    write_text(
        to, "b.ply",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\n"
        "property list uchar int vertex_indices\nend_header\n"
        "0 0 0 255 0 0\n1 0 0 0 255 0\n1 1 0 0 0 255\n0 1 0.5 90 90 90\n4 0 1 2 3\n3 0 2 3\n");
    write_text(to, "c.stl",
               "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
               "endloop\nendfacet\nendsolid a\n");
    write_text(to, "d.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0.25\n0 1 0\n3 0 1 2\n3 0 2 3\n");
    static const char *const names[] = {"a.obj", "b.ply", "c.stl", "d.off"};
    for (int i = 0; i < 4; i++) {
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        memset(&mesh, 0, sizeof mesh);
        probe_status(to, names[i], ewa_mesh_load(to->context, scratch(to, names[i]), &mesh));
        probe_number(to, "vertices", mesh.vertex_count);
        probe_number(to, "triangles", mesh.triangle_count);
        WITH_DEFAULTS(ewa_mesh_sample_options, options);
        options.point_count = 200;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
        if (mesh.triangle_count) probe_status(to, "sample", ewa_mesh_sample(&mesh, &options, &cloud));
        probe_cloud(to, "sampled file", cloud);
    }
}

static void put_volumes_written(probe *to) {
    WITH_DEFAULTS(ewa_volume_generate_options, generate);
    for (int k = 0; k < 4; k++) {
        generate.object = (ewa_volume_object)k;
        generate.dims[0] = 13, generate.dims[1] = 9, generate.dims[2] = 11;
        OWNED(ewa_volume_free) ewa_volume volume;
        if (ewa_volume_generate(to->context, &generate, &volume) != EWA_OK) continue;
        put_volume_numbers(to, "generated volume", &volume);
        WITH_DEFAULTS(ewa_volume_save_options, options);
        options.plain = k & 1;
        volume.index_to_world[1] = 0.1, volume.index_to_world[3] = 7;
        probe_status(to, "volume save", ewa_volume_save(&volume, scratch(to, "a.nrrd"), &options));
        put_volume(to, "volume written", scratch(to, "a.nrrd"));
        ewa_volume_facts facts;
        probe_status(to, "measure", ewa_volume_measure(&volume, &facts));
        const double numbers[11] = {(double)facts.finite_count,
                                    facts.low,
                                    facts.high,
                                    facts.mean,
                                    facts.low_world[0],
                                    facts.low_world[1],
                                    facts.high_world[2],
                                    facts.spacing_world[0],
                                    facts.spacing_world[1],
                                    facts.spacing_world[2],
                                    facts.high_world[0]};
        probe_doubles(to, "volume facts", PROBE_NUMBERS, numbers, 11);
        for (int i = 0; i < 256; i += 5) probe_number(to, "histogram", (double)facts.histogram[i]);
        OWNED(check_free) ewa_transfer *transfer = calloc(1, sizeof *transfer);
        if (!transfer) abort();
        probe_status(to, "automatic", ewa_transfer_automatic(&volume, &facts, transfer));
        put_transfer_numbers(to, "automatic", transfer);
        for (uint32_t i = 0; ewa_transfer_preset_name(i, NULL); i++) {
            probe_status(to, "preset",
                         ewa_transfer_preset(&volume, &facts, ewa_transfer_preset_name(i, NULL), transfer));
            put_transfer_numbers(to, ewa_transfer_preset_name(i, NULL), transfer);
        }
        probe_status(to, "transfer save", ewa_transfer_save(to->context, transfer, scratch(to, "a.json")));
        put_transfer(to, "transfer written", scratch(to, "a.json"));
    }
}

/// A COLMAP model, which is a folder.
static void put_colmap(probe *to) {
    char folder[1024];
    snprintf(folder, sizeof folder, "%s", scratch(to, "colmap"));
    mkdir(folder, 0777);
    write_text(to, "colmap/cameras.txt",
               "1 PINHOLE 640 480 500 510 320.125 -7.5\n2 SIMPLE_RADIAL 64 48 50 32 24 0.25\n");
    write_text(to, "colmap/images.txt",
               "1 0.5 0.5 0.5 -0.5 0 2 10 1 a name.png\n\n5 1 0 0.2 0 1 2 3 2 b.png\n1.5 2.5 -1 3 4 7\n");
    put_cameras(to, "COLMAP", folder);
}

static void put_cameras_written(probe *to) {
    ewa_camera cameras[2];
    for (int i = 0; i < 2; i++) {
        const double eye[3] = {1 + i, 2, 3}, target[3] = {0, 0.5, 0}, up[3] = {0, 0, 1};
        ewa_camera_init(&cameras[i]);
        ewa_camera_look_at(&cameras[i], eye, target, up);
        if (i) ewa_camera_set_ortho(&cameras[i], 3.5);
    }
    probe_status(to, "camera save", ewa_camera_save(to->context, &cameras[1], scratch(to, "camera.json")));
    put_cameras(to, "camera written", scratch(to, "camera.json"));
    probe_status(to, "cameras save",
                 ewa_camera_save_list(to->context, cameras, 2, scratch(to, "camera.json")));
    put_cameras(to, "cameras written", scratch(to, "camera.json"));
    put_poses(to, "no poses", scratch(to, "camera.json"));
}

void probe_files(probe *to) {
    put_folder(to, "ply", put_cloud);
    put_folder(to, "image", put_image);
    put_folder(to, "depth", put_image);
    put_folder(to, "volume", put_volume);
    put_folder(to, "camera", put_cameras);
    put_folder(to, "poses", put_poses);
    put_folder(to, "materials", put_materials);
    put_folder(to, "transfer", put_transfer);
    put_images_written(to);
    put_clouds_written(to);
    put_meshes(to);
    put_volumes_written(to);
    put_cameras_written(to);
    put_colmap(to);
}
