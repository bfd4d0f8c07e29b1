// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clouds from the files of the command line: loading, what is missing, merging.
#include "cli/input/inputs.h"
#include "cli/input/gaussian_files.h"
#include "cli/input/model_input.h"
#include "cli/input/point_choice.h"

#include <stdlib.h>
#include <string.h>

static const cli_option input_table[] = {
    {"columns", OPTION_TEXT, offsetof(common_arguments, columns), "NAMES",
     .help = "what the columns of text files are, as x,y,z,intensity,-,r,g,b; -: a column that is left out",
     .absent = "auto: as the file's head or its numbers say"},
    {"heights", OPTION_CHOICE, offsetof(common_arguments, heights), NULL, "none|terrain-rgb|terrarium",
     .help = "what the colours of pictures (PNG, WebP) say: nothing, or heights as in tiles of Mapbox or of Mapzen"},
    {"keep-going", OPTION_FLAG, offsetof(common_arguments, keep_going),
     .help = "step over damaged pieces of files of points, and say what is lost"},
    {"filter", OPTION_FILTER, offsetof(common_arguments, filter), "EXPR",
     .help = "take the points that fulfil conditions on their attributes, x, y, z, red, green, blue: "
             "classification=2,6, classification=ground,building, \"intensity>100 and z<=12.5\", "
             "return_number=1..2, !=; given more than once, all hold",
     .absent = "all"},
};

const option_group cloud_input_options = OPTION_GROUP("Files of points", input_table);

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
    ewa_legend legend; // of a tint there is none
    ewa_coloring coloring;
    ewa_coloring_init(&coloring, sizeof coloring);
    coloring.tinted = true;
    memcpy(coloring.tint, srgb, sizeof coloring.tint);
    for (size_t i = 0; i < loaded->count; i++)
        colored_count += ewa_cloud_find(loaded->clouds[i], EWA_COLOR) != NULL;
    for (size_t i = 0; colored_count && i < loaded->count; i++) {
        if (ewa_cloud_find(loaded->clouds[i], EWA_COLOR)) continue;
        const ewa_status status = ewa_clouds_color(&loaded->clouds[i], 1, &coloring, &legend);
        session->subject = loaded->paths[i];
        if (!session_passed(session, status)) return false;
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
