// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What shines on a picture: options of shading, lights, materials and environment, and the files behind them.
#include "light.h"

#include <stdio.h>
#include <string.h>

_Static_assert(EWA_MAX_LIGHTS == 8 && OPTION_VECTORS_MAX == 8, "the help of --light says so");

#define AT(member) (LIGHT_OFFSET + offsetof(light_arguments, member))

static const cli_option light_table[] = {
    {.key = "shading",
     .kind = OPTION_CHOICE,
     .offset = AT(shading),
     .range = "none|lambert|phong",
     .absent = "phong with --materials or --env, else lambert",
     .help = "light: none gives the bare colours, lambert matt surfaces, phong materials with highlights"},
    {.key = "light",
     .kind = OPTION_VECTORS,
     .offset = AT(lights),
     .value = "x,y,z[,r,g,b]",
     .low = 3,
     .high = 6,
     .absent = "headlight",
     .help = "direction towards a light, and its linear colour (default 1,1,1); may be given up to 8 times; "
             "0,0,0,r,g,b is a headlight of that colour"},
    {.key = "ambient",
     .kind = OPTION_NUMBER,
     .offset = AT(ambient),
     .value = "A",
     .range = "[0, 1]",
     .help = "share of the light that comes from everywhere, where --materials does not say"},
    {.key = "materials",
     .kind = OPTION_TEXT,
     .offset = AT(materials_path),
     .value = "FILE",
     .help = "JSON table of materials (ambient, diffuse, specular, shininess, reflection), by the points' "
             "property material"},
    {.key = "env",
     .kind = OPTION_TEXT,
     .offset = AT(environment_path),
     .value = "FILE",
     .help = "surroundings that surfaces mirror: equirectangular .exr, .hdr, .pfm, .png or .jpg"},
    {.key = "env-up",
     .kind = OPTION_VECTOR,
     .offset = AT(environment_up),
     .value = "x,y,z",
     .low = 3,
     .high = 3,
     .help = "direction in the world of the surroundings' upper edge"},
    {.key = "edl",
     .kind = OPTION_NUMBER,
     .offset = AT(eye_dome),
     .value = "S",
     .range = "[0, 100]",
     .help = "eye-dome lighting: darken what lies behind its surroundings; 0: none, 1: strong"},
};

const option_group light_options = {"Light", light_table, sizeof light_table / sizeof light_table[0]};

void light_set_defaults(light_arguments *arguments) {
    ewa_render_options options;
    ewa_render_options_init(&options, sizeof options);
    arguments->shading = -1;
    arguments->ambient = options.ambient;
    arguments->eye_dome = options.eye_dome;
    memcpy(arguments->environment_up.values, options.environment_up, sizeof options.environment_up);
    arguments->environment_up.count = 3;
}

static bool is_zero(const double v[3]) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

bool light_check(const light_arguments *arguments, char message[OPTION_ERROR_BYTES]) {
    const char *wrong = NULL;
    for (uint32_t i = 0; i < arguments->lights.count; i++) {
        const option_vector *light = &arguments->lights.each[i];
        if (light->count != 3 && light->count != 6)
            wrong = "--light: neither x,y,z nor x,y,z,r,g,b";
        else if (light->count == 3 && is_zero(light->values))
            wrong = "--light: 0,0,0 has no direction (0,0,0,1,1,1 is the headlight)";
        for (uint32_t c = 3; !wrong && c < light->count; c++)
            if (light->values[c] < 0 || light->values[c] > 1e6)
                wrong = "--light: a colour is outside [0, 1e6]";
    }
    const bool objects = arguments->materials_path || arguments->environment_path;
    if (objects && arguments->shading >= 0 && arguments->shading != EWA_SHADING_PHONG)
        wrong = "--materials and --env need --shading phong";
    if (is_zero(arguments->environment_up.values)) wrong = "--env-up: 0,0,0 has no direction";
    if (wrong) snprintf(message, OPTION_ERROR_BYTES, "%s", wrong);
    return !wrong;
}

static ewa_status load_environment(cli_session *session, const char *path, ewa_environment **environment) {
    ewa_image image;
    ewa_status status = ewa_image_load(session->context, path, &image);
    if (status == EWA_OK) status = ewa_environment_create(&image, environment);
    ewa_image_free(&image);
    return status;
}

bool light_load(cli_session *session, const light_arguments *arguments, light_objects *objects) {
    memset(objects, 0, sizeof *objects);
    ewa_status status = EWA_OK;
    if (arguments->materials_path) {
        session->subject = arguments->materials_path;
        status = ewa_materials_load(session->context, arguments->materials_path, objects->materials,
                                    &objects->material_count);
    }
    if (status == EWA_OK && arguments->environment_path) {
        session->subject = arguments->environment_path;
        status = load_environment(session, arguments->environment_path, &objects->environment);
    }
    if (status != EWA_OK) session_failed(session, status);
    return status == EWA_OK;
}

void light_free(light_objects *objects) { ewa_environment_destroy(&objects->environment); }

void light_apply(const light_arguments *arguments, const light_objects *objects,
                 ewa_render_options *options) {
    if (arguments->shading >= 0)
        options->shading = (ewa_shading)arguments->shading;
    else if (objects->material_count || objects->environment)
        options->shading = EWA_SHADING_PHONG;
    options->ambient = arguments->ambient;
    options->eye_dome = arguments->eye_dome;
    options->light_count = arguments->lights.count;
    for (uint32_t i = 0; i < arguments->lights.count; i++) {
        const option_vector *from = &arguments->lights.each[i];
        ewa_light *to = &options->lights[i];
        ewa_light_init(to);
        memcpy(to->direction_world, from->values, sizeof to->direction_world);
        for (uint32_t c = 3; c < from->count; c++) to->color[c - 3] = (float)from->values[c];
    }
    options->materials = objects->material_count ? objects->materials : NULL;
    options->material_count = objects->material_count;
    options->environment = objects->environment;
    memcpy(options->environment_up, arguments->environment_up.values, sizeof options->environment_up);
}
