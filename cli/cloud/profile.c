// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa profile: the points beside a line on the map, as points and as a graph.
#include "cli/base/commands.h"
#include "cli/base/outputs.h"
#include "cli/convert/cloud_output.h"
#include "cli/input/inputs.h"
#include "cli/input/scene_input.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct profile_arguments {
    output_arguments output; // first
    const char *graph_path, *line, *title, *unit;
    option_size size;
    option_vector up;
    coloring_arguments coloring;
    ewa_profile_options profile;
    ewa_profile_graph_options graph;
} profile_arguments;

#define AT(member) offsetof(profile_arguments, member)

static const cli_option line_table[] = {
    {"line", OPTION_TEXT, AT(line), "x,y;x,y;...",
     .help = "corners of the line, or x,y,z;...; where it goes on the map is what counts"},
    {"width", OPTION_OF(ewa_profile_options, AT(profile), width_world), .value = "W"},
    {"up", OPTION_VECTOR, AT(up), "x,y,z|AXIS", .help = "direction in which heights count; or an axis: z, -y", .low = 3, .high = 3, .axes = true,
     .absent = "auto: as the files say, z of surveyed ones, else as the points stand"},
};

static const cli_option graph_table[] = {
    {"graph", OPTION_OUTPUT, AT(graph_path), "FILE", .help = "draw the graph of stations and heights (.png, .jpg)"},
    {"size", OPTION_SIZE, AT(size), "WxH", .help = "pixels of the graph", .aliases = "resolution"},
    {"exaggeration", OPTION_OF(ewa_profile_graph_options, AT(graph), exaggeration), .value = "N"},
    {"point-size", OPTION_OF(ewa_profile_graph_options, AT(graph), point_size_px), .value = "PX"},
    {"title", OPTION_TEXT, AT(title), "TEXT", .help = "write a line over the top of the graph", .absent = "none"},
    {"unit", OPTION_TEXT, AT(unit), "UNIT", .help = "of the file's lengths, for the names of the axes",
     .absent = "auto: as the files' reference systems say"},
};

static const cli_option color_table[] = {COLORING_OPTIONS(AT(coloring))};

static void set_defaults(void *data) {
    profile_arguments *arguments = data;
    ewa_profile_options_init(&arguments->profile, sizeof arguments->profile);
    ewa_profile_graph_options_init(&arguments->graph, sizeof arguments->graph);
    arguments->size = (option_size){1280, 720, false};
    arguments->coloring.colormap = EWA_COLORING_AUTO - 1;
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const profile_arguments *arguments = data;
    if (!arguments->line) return options_fine("no line; say --line x,y;x,y", message);
    if (!arguments->output.path && !arguments->graph_path)
        return options_fine("no output; say -o FILE for the points, --graph FILE.png for the graph", message);
    if (arguments->graph_path && !output_check_suffix("graph", arguments->graph_path, ".png|.jpg|.jpeg", message))
        return false;
    return !arguments->output.path || cloud_output_check(&arguments->output, message);
}

/// Takes the profile of all inputs. False after reporting.
static bool take(cli_session *session, const profile_arguments *arguments, ewa_profile *profile) {
    const common_arguments *common = &arguments->output.common;
    const ewa_asset_options options = scene_input_asset_options(session);
    ewa_profile_options wanted = arguments->profile;
    double corners_world[3 * EWA_PROFILE_CORNERS];
    uint32_t corner_count;
    char problem[EWA_OPTION_TEXT_BYTES];
    if (ewa_profile_line_read(arguments->line, corners_world, &corner_count, problem) != EWA_OK) {
        session_fail(session, "--line: %s", problem);
        return false;
    }
    memcpy(wanted.up_world, arguments->up.values, sizeof wanted.up_world);
    ewa_coloring coloring;
    scene_input_coloring(&arguments->coloring, &coloring);
    ewa_scene *scene = NULL;
    const bool done = session_passed(session, ewa_scene_create(session->context, NULL, &scene)) &&
                      scene_input_add(session, common->operand_count, common->operands, &options, &coloring, scene) &&
                      session_passed(session, ewa_scene_profile(scene, corners_world, corner_count, &wanted, profile));
    ewa_scene_destroy(&scene);
    return done;
}

/// Draws the graph and saves it. False after reporting.
static bool save_graph(cli_session *session, const profile_arguments *arguments, const ewa_profile *profile) {
    const option_size *size = &arguments->size;
    const size_t row_bytes = 4 * (size_t)size->width_px;
    ewa_profile_graph_options options = arguments->graph;
    options.title = arguments->title;
    options.unit = arguments->unit;
    uint8_t *rgba8 = malloc(row_bytes * size->height_px);
    if (!rgba8) {
        session_fail(session, "out of memory: a picture of %ux%u", size->width_px, size->height_px);
        return false;
    }
    session->subject = arguments->graph_path;
    const ewa_canvas canvas = {rgba8, size->width_px, size->height_px};
    ewa_status status = ewa_profile_draw(profile, &options, &canvas);
    if (status == EWA_OK)
        status = ewa_pixels_save(session->context, arguments->graph_path, size->width_px, size->height_px, 4, rgba8,
                                 row_bytes, NULL);
    free(rgba8);
    return session_passed(session, status);
}

static int run(const void *data) {
    const profile_arguments *arguments = data;
    cli_session session;
    ewa_profile profile = {.context = NULL};
    if (!session_start(&session, &arguments->output.common)) return session_end(&session, EXIT_FAILED);
    bool done = take(&session, arguments, &profile);
    const uint64_t count = done ? ewa_cloud_point_count(profile.points) : 0;
    session.subject = NULL;
    if (done && !count) session_fail(&session, "--line: no point lies within half of --width beside it");
    if (done && count)
        session_say(&session, "%llu points along %.9g", (unsigned long long)count, profile.length_world);
    done = done && count && (!arguments->output.path || cloud_output_save(&session, &arguments->output, profile.points, NULL)) &&
           (!arguments->graph_path || save_graph(&session, arguments, &profile));
    ewa_profile_free(&profile);
    return session_end(&session, done ? EXIT_DONE : EXIT_FAILED);
}

static const option_group line_options = OPTION_GROUP("Line", line_table);
static const option_group graph_options = OPTION_GROUP("Graph", graph_table);
static const option_group color_options = OPTION_GROUP("Colours of the graph", color_table);
const cli_command profile_command = {
    .name = "profile",
    .operands = "IN... --line x,y;x,y [-o OUT] [--graph PICTURE]",
    .summary = "cut a profile along a line: points by station, offset and height, and their graph",
    .details = "Takes the points no farther from the line than half of --width, of all inputs together, of octrees only from the "
               "nodes there, of a scene file what it shows. They are written in the order of their stations, with all "
               "attributes and three more: station (along the line, from its first corner), offset (to its right, to its "
               "left below 0) and profile_height. Hidden parts of a scene, and what its sections cut away, are left out.",
    .examples = "ewa profile scan.laz --line '849100,1233500;849300,1233620' --width 2 -o profile.csv --graph profile.png\n"
                "ewa profile road.copc.laz --line '0,0;100,0;150,80' -o road.las --color-by classification --graph road.png\n",
    .low_operands = 1,
    .high_operands = 4096,
    .groups = (const option_group *const[]){&cloud_output_options, &line_options, &graph_options, &color_options,
                                            &cloud_input_options, NULL},
    .arguments_bytes = sizeof(profile_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
