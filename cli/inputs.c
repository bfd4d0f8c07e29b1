// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clouds from the files of the command line: loading, what is missing, merging.
#include "inputs.h"
#include "choosing.h"
#include "gaussian_files.h"
#include "model_input.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const cli_option input_table[] = {
    {"columns", OPTION_TEXT, offsetof(common_arguments, columns), "NAMES",
     .help = "what the columns of text files are, as x,y,z,intensity,-,r,g,b; -: a column that is left out",
     .absent = "as the file's head or its numbers say"},
    {"keep-going", OPTION_FLAG, offsetof(common_arguments, keep_going),
     .help = "step over damaged pieces of files of points, and say what is lost"},
    {"filter", OPTION_FILTER, offsetof(common_arguments, filter), "EXPR",
     .help = "take the points that fulfil conditions on their attributes, x, y, z, red, green, blue: "
             "classification=2,6, classification=ground,building, \"intensity>100 and z<=12.5\", "
             "return_number=1..2, !=; given more than once, all hold",
     .absent = "all points"},
};

const option_group cloud_input_options = OPTION_GROUP("Files of points", input_table);

/// sRGB of files without colours that are merged with coloured ones: as bright as the renderer's grey, linear
/// 0.6.
static const uint8_t GREY_SRGB = 203;

static bool has_axes(const ewa_cloud *cloud) {
    return ewa_cloud_find(cloud, EWA_TANGENT_U) && ewa_cloud_find(cloud, EWA_TANGENT_V);
}

/// Whether two clouds store a stream in different ways, or only one has it.
static bool streams_differ(const ewa_cloud *a, const ewa_cloud *b, const char *name) {
    const ewa_attribute *first = ewa_cloud_find(a, name), *second = ewa_cloud_find(b, name);
    if (!first || !second) return first != second;
    return first->type != second->type || first->component_count != second->component_count;
}

/// Says that faces of a file are not used, and how they can be.
static void note_faces(cli_session *session, const char *path, uint64_t face_count) {
    session_note(session,
                 "%s: a mesh of %llu faces; its vertices are taken, `ewa sample` makes points on the faces",
                 path, (unsigned long long)face_count);
}

/// Leaves the points that the session's filter takes, maybe none. False after reporting; the cloud is gone then.
static bool filter_points(cli_session *session, ewa_cloud **cloud) {
    const bool done = choose_points(session, &(point_choice){.filter = session->filter}, cloud);
    if (!done) ewa_cloud_destroy(cloud);
    return done;
}

/// Whether a cloud, which may be NULL, has points; false after reporting that the filter takes none. The cloud
/// is gone then.
static bool has_points(cli_session *session, ewa_cloud **cloud) {
    if (!*cloud || ewa_cloud_point_count(*cloud)) return *cloud != NULL;
    session_fail(session, "--filter: none of the points is left");
    ewa_cloud_destroy(cloud);
    return false;
}

/// Loads the points that the filter takes of one file, maybe none; of a mesh, after a note, its vertices. NULL
/// after reporting.
static ewa_cloud *load_points(cli_session *session, const char *path) {
    ewa_model model;
    ewa_cloud *cloud = NULL;
    if (model_input_load(session, path, EWA_MODEL_POINTS, &model)) {
        if (model.face_count) note_faces(session, path, model.face_count);
        cloud = model.points;
        model.points = NULL;
        filter_points(session, &cloud);
    }
    ewa_model_free(&model);
    return cloud;
}

ewa_cloud *input_load(cli_session *session, const char *path) {
    ewa_cloud *cloud = load_points(session, path);
    has_points(session, &cloud);
    return cloud;
}

ewa_cloud *input_load_elements(cli_session *session, const char *path, ewa_elements **elements) {
    ewa_model model;
    ewa_cloud *cloud = NULL;
    *elements = NULL;
    if (model_input_load(session, path, EWA_MODEL_POINTS | EWA_MODEL_ELEMENTS, &model)) {
        cloud = model.points;
        *elements = model.elements;
        model.points = NULL;
        model.elements = NULL;
    }
    ewa_model_free(&model);
    return cloud;
}

/// Loads the points that the filter takes of one file, maybe none; of a mesh, points on its faces; of Gaussians their discs.
static ewa_cloud *load_or_sample(cli_session *session, const char *path, double cutoff, bool *sampled) {
    ewa_model model;
    ewa_cloud *cloud = NULL;
    const ewa_gaussian_format gaussians = gaussian_files_format(session, path);
    if (gaussians == EWA_GAUSSIANS_PLY || gaussians == EWA_GAUSSIANS_GLTF) {
        *sampled = false;
        cloud = gaussian_files_load_surfels(session, path);
        if (cloud) filter_points(session, &cloud);
        return cloud;
    }
    if (model_input_load(session, path, EWA_MODEL_MESH, &model)) {
        cloud = model.points;
        model.points = NULL;
        *sampled = !cloud;
        if (!cloud) cloud = model_input_sample(session, path, &model.mesh, cutoff);
        if (cloud) filter_points(session, &cloud);
    }
    ewa_model_free(&model);
    return cloud;
}

ewa_cloud *input_points(cli_session *session, const char *path, double cutoff, bool *sampled) {
    ewa_cloud *cloud = load_or_sample(session, path, cutoff, sampled);
    has_points(session, &cloud);
    return cloud;
}

bool cloud_is_drawable(const ewa_cloud *cloud) {
    return has_axes(cloud) || (ewa_cloud_find(cloud, EWA_NORMAL) && ewa_cloud_find(cloud, EWA_RADIUS));
}

/// Gives discs two equal axes, so that they can be merged with ellipses.
static ewa_status discs_to_axes(ewa_cloud *cloud, double cutoff) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    void *u_data = NULL, *v_data = NULL;
    ewa_status status = ewa_cloud_add(cloud, EWA_TANGENT_U, EWA_F32, 3, &u_data);
    if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_TANGENT_V, EWA_F32, 3, &v_data);
    if (status != EWA_OK) return status;
    const ewa_attribute *normal = ewa_cloud_find(cloud, EWA_NORMAL),
                        *radius = ewa_cloud_find(cloud, EWA_RADIUS);
    float *u = u_data, *v = v_data;
    for (uint64_t i = 0; i < count; i++, u += 3, v += 3) {
        double n[3], r;
        ewa_attribute_read_f64(normal, i, 1, n);
        ewa_attribute_read_f64(radius, i, 1, &r);
        const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        const double scale = length > 0 ? 1 / length : 0, sigma_world = r / cutoff;
        for (int c = 0; c < 3; c++) n[c] *= scale;
        // Any direction across the normal: the axis in which the normal is shortest leads to a safe one.
        const int least =
            fabs(n[0]) < fabs(n[1]) ? (fabs(n[0]) < fabs(n[2]) ? 0 : 2) : (fabs(n[1]) < fabs(n[2]) ? 1 : 2);
        const int next = (least + 1) % 3, last = (least + 2) % 3;
        double a[3] = {0};
        a[next] = -n[last];
        a[last] = n[next];
        const double a_length = sqrt(a[next] * a[next] + a[last] * a[last]);
        const double a_scale = a_length > 0 ? sigma_world / a_length : 0;
        for (int c = 0; c < 3; c++) a[c] *= a_scale;
        for (int c = 0; c < 3; c++) {
            u[c] = (float)a[c];
            v[c] = (float)(n[(c + 1) % 3] * a[(c + 2) % 3] - n[(c + 2) % 3] * a[(c + 1) % 3]);
        }
    }
    return EWA_OK;
}

ewa_status cloud_set_color(ewa_cloud *cloud, const double srgb[3]) {
    void *data = NULL;
    const ewa_status status = ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, &data);
    uint8_t *colors = data;
    const uint64_t count = status == EWA_OK ? ewa_cloud_point_count(cloud) : 0;
    for (uint64_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) colors[3 * i + (uint64_t)c] = (uint8_t)(255 * srgb[c] + 0.5);
    return status;
}

ewa_status colors_to_linear(ewa_cloud *cloud) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    const ewa_attribute *found = ewa_cloud_find(cloud, EWA_COLOR);
    const ewa_attribute color = found ? *found : (ewa_attribute){.component_count = 0};
    static const double scales[] = {1, 1, 127, 255, 32767, 65535, 2147483647.0, 4294967295.0}; // by ewa_type
    float *linear = malloc(count * 4 * sizeof *linear);
    if (!linear) return EWA_ERROR_MEMORY;
    const bool is_float = color.type == EWA_F32 || color.type == EWA_F64;
    for (uint64_t i = 0; i < count; i++) {
        double rgba[4] = {GREY_SRGB / 255.0, GREY_SRGB / 255.0, GREY_SRGB / 255.0, 1};
        if (found) ewa_attribute_read_f64(&color, i, 1, rgba);
        const double scale = found ? scales[color.type] : 1;
        for (uint32_t c = 0; c < 4; c++) {
            const bool coded = c < 3 && !(found && is_float);
            const float value = (float)(c < color.component_count ? rgba[c] / scale : rgba[c]);
            linear[4 * i + c] = coded ? ewa_linear_from_srgb(value) : value;
        }
    }
    void *data = NULL;
    const ewa_status status = ewa_cloud_add(cloud, EWA_COLOR, EWA_F32, 4, &data);
    if (status == EWA_OK) memcpy(data, linear, count * 4 * sizeof *linear);
    free(linear);
    return status;
}

/// Replaces the materials, or their absence, by doubles, which all can become; without one it is 0.
static ewa_status materials_to_doubles(ewa_cloud *cloud) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    double *numbers = calloc(count ? count : 1, sizeof *numbers);
    if (!numbers) return EWA_ERROR_MEMORY;
    const ewa_attribute *found = ewa_cloud_find(cloud, EWA_MATERIAL);
    if (found && found->component_count == 1) ewa_attribute_read_f64(found, 0, count, numbers);
    void *data = NULL;
    const ewa_status status = ewa_cloud_add(cloud, EWA_MATERIAL, EWA_F64, 1, &data);
    if (status == EWA_OK) memcpy(data, numbers, count * sizeof *numbers);
    free(numbers);
    return status;
}

/// Removes what is not drawn, so that the merge need not speak about it; the attribute that `wanted`
/// (may be NULL) begins with stays.
static void drop_undrawn(ewa_cloud *cloud, const char *wanted) {
    static const char *const drawn[] = {EWA_POSITION,  EWA_NORMAL,   EWA_COLOR, EWA_RADIUS, EWA_TANGENT_U,
                                        EWA_TANGENT_V, EWA_MATERIAL, EWA_CLIP0, EWA_CLIP1,  EWA_CLIP_MODE};
    for (uint32_t k = ewa_cloud_attribute_count(cloud); k-- > 0;) {
        const ewa_attribute *attribute = ewa_cloud_attribute_at(cloud, k);
        const size_t length = strlen(attribute->name);
        bool kept = wanted && strncmp(attribute->name, wanted, length) == 0;
        for (size_t i = 0; i < sizeof drawn / sizeof drawn[0]; i++)
            kept |= strcmp(attribute->name, drawn[i]) == 0;
        char name[EWA_NAME_BYTES];
        memcpy(name, attribute->name, sizeof name);
        if (!kept) ewa_cloud_remove(cloud, name);
    }
}

/// Adds the clip lines that another cloud has: zeros, which cut nothing.
static ewa_status add_clip_lines(ewa_cloud *cloud, const bool wanted[3]) {
    static const char *const names[3] = {EWA_CLIP0, EWA_CLIP1, EWA_CLIP_MODE};
    ewa_status status = EWA_OK;
    for (int k = 0; k < 3 && status == EWA_OK; k++) {
        if (!wanted[k] || ewa_cloud_find(cloud, names[k])) continue;
        const uint32_t components = k < 2 ? 3 : 1;
        void *data = NULL;
        status = ewa_cloud_add(cloud, names[k], EWA_F32, components, &data);
        if (status == EWA_OK) memset(data, 0, ewa_cloud_point_count(cloud) * components * sizeof(float));
    }
    return status;
}

/// Gives clouds that are drawn together the same kinds of colours and axes, and nothing that only some have.
static ewa_status make_alike(ewa_cloud *const *clouds, size_t count, const char *wanted, double cutoff) {
    bool any_axes = false, colors_differ = false, normals_differ = false, materials_differ = false;
    bool clip[3] = {false};
    for (size_t i = 0; i < count; i++) {
        any_axes |= has_axes(clouds[i]);
        colors_differ |= streams_differ(clouds[0], clouds[i], EWA_COLOR);
        normals_differ |= !ewa_cloud_find(clouds[i], EWA_NORMAL);
        materials_differ |= streams_differ(clouds[0], clouds[i], EWA_MATERIAL);
        clip[0] |= ewa_cloud_find(clouds[i], EWA_CLIP0) != NULL;
        clip[1] |= ewa_cloud_find(clouds[i], EWA_CLIP1) != NULL;
        clip[2] |= ewa_cloud_find(clouds[i], EWA_CLIP_MODE) != NULL;
    }
    for (size_t i = 0; i < count; i++) {
        ewa_status status = any_axes && !has_axes(clouds[i]) ? discs_to_axes(clouds[i], cutoff) : EWA_OK;
        if (status == EWA_OK && colors_differ) status = colors_to_linear(clouds[i]);
        if (status == EWA_OK && materials_differ) status = materials_to_doubles(clouds[i]);
        if (status == EWA_OK) status = add_clip_lines(clouds[i], clip);
        if (status != EWA_OK) return status;
        if (any_axes) ewa_cloud_remove(clouds[i], EWA_RADIUS);
        if (normals_differ) ewa_cloud_remove(clouds[i], EWA_NORMAL);
        drop_undrawn(clouds[i], wanted);
    }
    return EWA_OK;
}

/// Frees clouds [0, count) and their array.
static void release_clouds(ewa_cloud **clouds, size_t count) {
    for (size_t i = 0; i < count; i++) ewa_cloud_destroy(&clouds[i]);
    free(clouds);
}

/// The clouds of the operands that have points left.
typedef struct loaded_clouds {
    ewa_cloud **clouds;
    const char **paths;
    size_t count;
} loaded_clouds;

static void release_loaded(loaded_clouds *loaded) {
    release_clouds(loaded->clouds, loaded->count);
    free(loaded->paths);
}

/// One cloud of all; NULL after reporting.
static ewa_cloud *merge(cli_session *session, loaded_clouds *loaded) {
    ewa_cloud *merged = NULL;
    if (loaded->count == 1) {
        merged = loaded->clouds[0];
        loaded->count = 0;
        return merged;
    }
    session->subject = NULL;
    const ewa_status status =
        ewa_cloud_merge((const ewa_cloud *const *)loaded->clouds, (uint32_t)loaded->count, &merged);
    if (status != EWA_OK) session_failed(session, status);
    return merged;
}

/// Adds a cloud, unless the filter takes none of its points, which a note says.
static void add_loaded(cli_session *session, loaded_clouds *loaded, const char *path, ewa_cloud *cloud) {
    if (ewa_cloud_point_count(cloud)) {
        loaded->paths[loaded->count] = path;
        loaded->clouds[loaded->count++] = cloud;
        return;
    }
    session->subject = path;
    session_note(session, "--filter takes none of its points; it is left out");
    ewa_cloud_destroy(&cloud);
}

/// Makes room for the clouds of all operands; false after reporting.
static bool begin_loaded(cli_session *session, const common_arguments *common, loaded_clouds *loaded) {
    *loaded = (loaded_clouds){.clouds = calloc(common->operand_count, sizeof *loaded->clouds),
                              .paths = calloc(common->operand_count, sizeof *loaded->paths)};
    if (loaded->clouds && loaded->paths) return true;
    session_fail(session, "out of memory");
    return false;
}

/// Whether points are left; false after reporting.
static bool any_loaded(cli_session *session, const loaded_clouds *loaded) {
    if (loaded->count) return true;
    session->subject = NULL;
    session_fail(session, "--filter: none of the points is left");
    return false;
}

/// Gives clouds without colours one, if others have some; says so. False after reporting.
static bool add_default_colors(cli_session *session, const loaded_clouds *loaded, const double srgb[3]) {
    size_t colored_count = 0;
    for (size_t i = 0; i < loaded->count; i++)
        colored_count += ewa_cloud_find(loaded->clouds[i], EWA_COLOR) != NULL;
    for (size_t i = 0; colored_count && i < loaded->count; i++) {
        if (ewa_cloud_find(loaded->clouds[i], EWA_COLOR)) continue;
        const ewa_status status = cloud_set_color(loaded->clouds[i], srgb);
        session->subject = loaded->paths[i];
        if (status != EWA_OK) {
            session_failed(session, status);
            return false;
        }
        session_note(session,
                     "it has no colours; its points become (%.3g, %.3g, %.3g), --default-color decides",
                     srgb[0], srgb[1], srgb[2]);
    }
    return true;
}

ewa_cloud *inputs_merge(cli_session *session, const common_arguments *common, const double srgb[3]) {
    loaded_clouds loaded;
    bool done = begin_loaded(session, common, &loaded);
    for (size_t i = 0; done && i < common->operand_count; i++) {
        ewa_cloud *cloud = load_points(session, common->operands[i]);
        done = cloud != NULL;
        if (done) add_loaded(session, &loaded, common->operands[i], cloud);
    }
    done = done && any_loaded(session, &loaded) && add_default_colors(session, &loaded, srgb);
    ewa_cloud *merged = done ? merge(session, &loaded) : NULL;
    release_loaded(&loaded);
    return merged;
}

bool input_complete(cli_session *session, const char *path, ewa_cloud **cloud, double *estimate_s) {
    if (cloud_is_drawable(*cloud)) return true;
    session->subject = path;
    if (ewa_cloud_refuse_gaussians(*cloud) != EWA_OK) return false;
    ewa_cloud_drop_zero_normals(*cloud);
    const bool has_normals = ewa_cloud_find(*cloud, EWA_NORMAL) != NULL;
    ewa_estimate_options options;
    ewa_estimate_options_init(&options, sizeof options);
    const double started_s = clock_now_s();
    const ewa_status status = ewa_cloud_estimate(cloud, &options);
    if (status != EWA_OK) {
        session_failed(session, status);
        return false;
    }
    const double took_s = clock_now_s() - started_s;
    *estimate_s += took_s;
    session_say(session, "%s: %s from %u neighbours in %.3f s", path,
                has_normals ? "radii estimated" : "normals and radii estimated", options.neighbour_count,
                took_s);
    return true;
}

ewa_cloud *input_as_surfels(cli_session *session, const char *path, double cutoff, double *estimate_s) {
    bool sampled;
    ewa_cloud *cloud = input_points(session, path, cutoff, &sampled);
    if (cloud && !input_complete(session, path, &cloud, estimate_s)) ewa_cloud_destroy(&cloud);
    return cloud;
}

ewa_cloud *inputs_as_surfels(cli_session *session, const common_arguments *common, const char *wanted,
                             double cutoff, double *estimate_s) {
    *estimate_s = 0;
    loaded_clouds loaded;
    bool done = begin_loaded(session, common, &loaded);
    for (size_t i = 0; done && i < common->operand_count; i++) {
        bool sampled;
        const char *path = common->operands[i];
        ewa_cloud *cloud = load_or_sample(session, path, cutoff, &sampled);
        done = cloud != NULL;
        if (done && ewa_cloud_point_count(cloud)) done = input_complete(session, path, &cloud, estimate_s);
        if (done)
            add_loaded(session, &loaded, path, cloud);
        else
            ewa_cloud_destroy(&cloud);
    }
    done = done && any_loaded(session, &loaded);
    const ewa_status status =
        done && loaded.count > 1 ? make_alike(loaded.clouds, loaded.count, wanted, cutoff) : EWA_OK;
    if (status != EWA_OK) {
        session->subject = NULL;
        session_failed(session, status);
    }
    ewa_cloud *merged = done && status == EWA_OK ? merge(session, &loaded) : NULL;
    release_loaded(&loaded);
    return merged;
}
