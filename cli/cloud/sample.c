// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa sample: surfels from a triangle mesh.
#include "cli/base/commands.h"
#include "cli/base/session.h"
#include "cli/image/textured.h"
#include "cli/input/model_input.h"

#include <stdio.h>

typedef struct sample_arguments {
    textured_arguments textured; // first
    ewa_mesh_sample_options options;
} sample_arguments;

#define AT(member)     offsetof(sample_arguments, member)
#define SAMPLE(member) OPTION_OF(ewa_mesh_sample_options, AT(options), member)

static const cli_option sample_table[] = {
    {"points", OPTION_INTEGER, AT(options.point_count), "N", "[1, 4294967279]",
     .help = "about how many points, within a few percent", .letter = 'n', .excludes = "spacing"},
    {"spacing", SAMPLE(spacing_world), .value = "S", .absent = "auto: from --points"},
    {"seed", SAMPLE(seed)},
    {"crease", SAMPLE(crease_degrees)},
    {"clip-lines", SAMPLE(clip_lines)},
    {"smooth-normals", SAMPLE(smooth_normals)},
    {"radius-scale", SAMPLE(radius_scale)},
    {"cutoff", SAMPLE(cutoff)},
};

static void set_defaults(void *data) {
    sample_arguments *arguments = data;
    ewa_mesh_sample_options_init(&arguments->options, sizeof arguments->options);
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
    ewa_mesh_sample_options options = arguments->options;
    options.texture_filter = arguments->textured.acquire.filter;
    options.pixel_sigma_px = arguments->textured.acquire.pixel_sigma_px;
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
    if (cloud && !procedure_apply(session, &arguments->textured.procedure, arguments->options.cutoff, cloud))
        ewa_cloud_destroy(&cloud);
    return cloud;
}

static int run(const void *data) { return cloud_output_run(data, make); }

static const option_group sample_options = OPTION_GROUP("Sampling", sample_table);
const cli_command sample_command = {
    .name = "sample",
    .operands = "MESH -o OUT",
    .summary = "make surfels from a mesh (PLY, OBJ, STL, OFF, glTF, VTK), sharp edges as clip lines",
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
    .groups = (const option_group *const[]){&cloud_output_options, &sample_options, &procedure_options,
                                            &textured_options, NULL},
    .arguments_bytes = sizeof(sample_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
