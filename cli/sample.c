// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa sample: surfels from a triangle mesh.
#include "commands.h"
#include "model_input.h"
#include "session.h"
#include "textured.h"

#include <stdio.h>

typedef struct sample_arguments {
    textured_arguments textured; // first
    bool clip_lines, smooth_normals;
    int64_t point_count, seed;
    double spacing_world, crease_degrees, radius_scale, cutoff;
} sample_arguments;

#define AT(member) offsetof(sample_arguments, member)

static const cli_option sample_table[] = {
    {"points", OPTION_INTEGER, AT(point_count), "N", "[1, 4294967279]",
     .help = "about how many points, within a few percent", .letter = 'n', .excludes = "spacing"},
    {"spacing", OPTION_NUMBER, AT(spacing_world), "S", "[0, inf)",
     .help = "square root of the area per point, in world units", .absent = "from --points"},
    {"seed", OPTION_INTEGER, AT(seed), "N", "[0, inf)", .help = "same seed, same points"},
    {"crease", OPTION_NUMBER, AT(crease_degrees), "DEGREES", "[0, 180]",
     .help = "edges that bend by more are sharp"},
    {"clip-lines", OPTION_ON_OFF, AT(clip_lines),
     .help = "make sharp edges, corners and borders exact by clip lines"},
    {"smooth-normals", OPTION_ON_OFF, AT(smooth_normals),
     .help = "interpolate normals across edges that are not sharp; off: those of the triangles"},
    {"radius-scale", OPTION_NUMBER, AT(radius_scale), "S", "[0.5, 10]",
     .help = "support radius in units of the spacing"},
    {"cutoff", OPTION_NUMBER, AT(cutoff), "F", "(0, 4]",
     .help = "standard deviations at which kernels end: axes are support radius / F long"},
};

static void set_defaults(void *data) {
    sample_arguments *arguments = data;
    ewa_mesh_sample_options options;
    ewa_mesh_sample_options_init(&options, sizeof options);
    arguments->point_count = (int64_t)options.point_count;
    arguments->spacing_world = options.spacing_world;
    arguments->seed = (int64_t)options.seed;
    arguments->crease_degrees = options.crease_degrees;
    arguments->clip_lines = options.clip_lines;
    arguments->smooth_normals = options.smooth_normals;
    arguments->radius_scale = options.radius_scale;
    arguments->cutoff = options.cutoff;
    textured_set_defaults(&arguments->textured);
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const sample_arguments *arguments = data;
    return procedure_check(&arguments->textured.procedure, message);
}

static bool has_picture(const ewa_mesh *mesh) {
    bool found = false;
    for (uint32_t m = 0; m < mesh->material_count; m++) found = found || mesh->textures[m].pixels;
    return found;
}

/// Loads a file that has faces; false after reporting, with nothing to free.
static bool load(cli_session *session, const char *path, ewa_model *model) {
    const bool loaded = model_input_load(session, path, EWA_MODEL_MESH, model);
    if (loaded && model->mesh.triangle_count) return true;
    if (loaded) session_fail(session, "%s: there are no faces to sample; `ewa surfels` is for points", path);
    ewa_model_free(model);
    return false;
}

static ewa_cloud *make(cli_session *session, const void *data) {
    const sample_arguments *arguments = data;
    const char *path = arguments->textured.procedure.output.common.operands[0];
    ewa_mesh_sample_options options;
    ewa_mesh_sample_options_init(&options, sizeof options);
    options.point_count = (uint64_t)arguments->point_count;
    options.spacing_world = arguments->spacing_world;
    options.seed = (uint64_t)arguments->seed;
    options.crease_degrees = arguments->crease_degrees;
    options.clip_lines = arguments->clip_lines;
    options.smooth_normals = arguments->smooth_normals;
    options.radius_scale = arguments->radius_scale;
    options.cutoff = arguments->cutoff;
    options.texture_filter = (ewa_texture_filter)arguments->textured.filter;
    options.pixel_sigma_px = arguments->textured.pixel_sigma_px;
    ewa_image picture;
    if (!textured_load(session, &arguments->textured, &picture)) return NULL;
    ewa_model model;
    ewa_cloud *cloud = NULL;
    if (!load(session, path, &model)) {
        ewa_image_free(&picture);
        return NULL;
    }
    ewa_mesh *mesh = &model.mesh;
    ewa_status status = picture.pixels ? ewa_mesh_set_picture(mesh, &picture) : EWA_OK;
    if (status == EWA_OK && mesh->texcoords && !has_picture(mesh))
        session_note(session, "%s: has texture coordinates, but names no picture; say --texture IMAGE", path);
    const double loaded_s = clock_now_s();
    if (status == EWA_OK) status = ewa_mesh_sample(mesh, &options, &cloud);
    if (status == EWA_OK) {
        const double sampled_s = clock_now_s() - loaded_s;
        session_say(session, "%s: %u triangles, %.3g million points per second", path, mesh->triangle_count,
                    (double)ewa_cloud_point_count(cloud) / sampled_s / 1e6);
    } else {
        session_failed(session, status);
    }
    ewa_model_free(&model);
    ewa_image_free(&picture);
    if (cloud && !procedure_apply(session, &arguments->textured.procedure, arguments->cutoff, cloud))
        ewa_cloud_destroy(&cloud);
    return cloud;
}

static int run(const void *data) { return cloud_output_run(data, make); }

static const option_group sample_options = OPTION_GROUP("Sampling", sample_table);
static const option_group *const groups[] = {&cloud_output_options, &sample_options, &procedure_options,
                                             &textured_options};

const cli_command sample_command = {
    .name = "sample",
    .operands = "MESH -o OUT",
    .summary = "make surfels from a mesh (PLY, OBJ, STL, OFF, glTF), sharp edges as clip lines",
    .details =
        "Points keep their distance (Poisson-disc) and are even in area; vertex colours and textures go "
        "onto them. Radii close the surface. Where edges are sharp, the file gets tangent axes and clip "
        "lines. FBX, Collada, 3DS and others are read where the helper ewa-import is installed.",
    .examples = "ewa sample part.stl -o part.ply --points 200000\n"
                "ewa sample scan.obj -o scan.ply --spacing 0.5 --crease 60\n"
                "ewa sample cow.obj --texture cow.png -o cow.ply\n"
                "ewa sample model.glb -o - | ewa render - -o model.png\n",
    .low_operands = 1,
    .high_operands = 1,
    .groups = groups,
    .group_count = sizeof groups / sizeof groups[0],
    .arguments_bytes = sizeof(sample_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
