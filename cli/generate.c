// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa generate: test objects.
#include "cloud_output.h"
#include "commands.h"
#include "json.h"

#include <stdio.h>
#include <string.h>

typedef struct generate_arguments {
    output_arguments output; // first
    bool positions_only, sharp;
    int64_t point_count, seed;
    double size_world, jitter, checks, radius_scale;
} generate_arguments;

#define AT(member) offsetof(generate_arguments, member)

/// In the order of ewa_object.
static const char *const objects[] = {"plane", "checker", "cube", "sphere", "torus", "terrain", "csg"};

static const cli_option object_table[] = {
    {.key = "points",
     .letter = 'n',
     .kind = OPTION_INTEGER,
     .offset = AT(point_count),
     .value = "N",
     .range = "[1, 4294967279]",
     .help = "about how many points; grids round"},
    {.key = "seed",
     .kind = OPTION_INTEGER,
     .offset = AT(seed),
     .value = "N",
     .range = "[0, inf)",
     .help = "same seed, same bytes, on every machine"},
    {.key = "extent",
     .kind = OPTION_NUMBER,
     .offset = AT(size_world),
     .value = "SIZE",
     .range = "(0, inf)",
     .help = "edge of plane, cube and terrain, outer diameter of sphere and torus, length of csg, in world "
             "units"},
    {.key = "jitter",
     .kind = OPTION_NUMBER,
     .offset = AT(jitter),
     .value = "J",
     .range = "[0, 1]",
     .help = "0: a regular grid, 1: anywhere in the cell"},
    {.key = "checks",
     .kind = OPTION_NUMBER,
     .offset = AT(checks),
     .value = "N",
     .range = "(0, inf)",
     .help = "squares along an edge of the checkerboard and of the cube's faces"},
    {.key = "radius-scale",
     .kind = OPTION_NUMBER,
     .offset = AT(radius_scale),
     .value = "S",
     .range = "(0, inf)",
     .absent = "closed for the jitter",
     .help = "support radius in units of the spacing"},
    {.key = "positions-only",
     .kind = OPTION_FLAG,
     .offset = AT(positions_only),
     .help = "leave out normals and radii, as a scanner does"},
    {.key = "sharp",
     .kind = OPTION_FLAG,
     .offset = AT(sharp),
     .help = "cube and csg: clip lines on every edge, and points on the edges"},
};

static void set_defaults(void *data) {
    generate_arguments *arguments = data;
    ewa_generate_options options;
    ewa_generate_options_init(&options, sizeof options);
    arguments->point_count = (int64_t)options.point_count;
    arguments->seed = (int64_t)options.seed;
    arguments->size_world = options.size_world;
    arguments->jitter = options.jitter;
    arguments->checks = options.checks;
    arguments->radius_scale = options.radius_scale;
    arguments->positions_only = options.positions_only;
}

enum { OBJECT_COUNT = sizeof objects / sizeof objects[0] };

static size_t find_object(const char *word) {
    size_t index = 0;
    while (index < OBJECT_COUNT && strcmp(objects[index], word) != 0) index++;
    return index;
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const generate_arguments *arguments = data;
    const char *word = arguments->output.common.operands[0];
    if (find_object(word) == OBJECT_COUNT) {
        const char *nearest = options_nearest(word, OBJECT_COUNT, objects);
        snprintf(message, OPTION_ERROR_BYTES,
                 "generate: '%.80s' is none of plane, checker, cube, sphere, torus, terrain, csg%s%s", word,
                 nearest ? "; did you mean " : "", nearest ? nearest : "");
        return false;
    }
    return cloud_output_check(&arguments->output, message);
}

static ewa_cloud *make(cli_session *session, const void *data) {
    const generate_arguments *arguments = data;
    ewa_generate_options options;
    ewa_generate_options_init(&options, sizeof options);
    options.object = (ewa_object)find_object(arguments->output.common.operands[0]);
    options.point_count = (uint64_t)arguments->point_count;
    options.seed = (uint64_t)arguments->seed;
    options.size_world = arguments->size_world;
    options.jitter = arguments->jitter;
    options.checks = arguments->checks;
    options.radius_scale = arguments->radius_scale;
    options.positions_only = arguments->positions_only;
    options.sharp = arguments->sharp;
    session->subject = arguments->output.path;
    ewa_cloud *cloud = NULL;
    const ewa_status status = ewa_cloud_generate(session->context, &options, &cloud);
    if (status != EWA_OK) session_failed(session, status);
    return cloud;
}

static int run(const void *data) { return cloud_output_run(data, make); }

static const option_group object_options = {"Object", object_table,
                                            sizeof object_table / sizeof object_table[0]};
static const option_group *const groups[] = {&cloud_output_options, &object_options};

const cli_command generate_command = {
    .name = "generate",
    .operands = "KIND -o OUT",
    .summary = "make test objects: plane, checker, cube, sphere, torus, terrain, csg",
    .details = "The object is centred at the origin. Plane, checker and terrain lie in x-y with z up; the "
               "axis of the "
               "torus is z. csg is a block with a slot, a notch and two round holes.",
    .examples = "ewa generate torus -o torus.ply --points 200000\n"
                "ewa generate terrain -o terrain.ply -n 4000000 --seed 7\n"
                "ewa generate csg --sharp -n 7000 -o part.ply\n"
                "ewa generate checker -o - --jitter 0 | ewa render - -o checker.png --shading none\n",
    .low_operands = 1,
    .high_operands = 1,
    .groups = groups,
    .group_count = sizeof groups / sizeof groups[0],
    .arguments_bytes = sizeof(generate_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
