// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What shines on a picture: options of shading, lights, materials and environment, and the files behind them.
#include "cli/render/light.h"

#include <stdio.h>
#include <string.h>

_Static_assert(EWA_MAX_LIGHTS == 8 && OPTION_VECTORS_MAX == 8, "the help of --light says so");

#define AT(member)     (LIGHT_OFFSET + offsetof(light_arguments, member))
#define RENDER(member) OPTION_OF(ewa_render_options, AT(render), member)

static const cli_option light_table[] = {
    {"shading", OPTION_CHOICE, AT(shading), NULL, "none|lambert|phong",
     .help = "light: none gives the bare colours, lambert matt surfaces, phong materials with highlights",
     .absent = "auto: phong with --materials or --env, else lambert"},
    {"light", OPTION_VECTORS, AT(lights), "x,y,z[,r,g,b]",
     .help = "direction towards a light, and its linear colour (default 1,1,1); may be given up to 8 times; "
             "0,0,0,r,g,b is a headlight of that colour",
     .low = 3, .high = 6, .absent = "auto: from above left of the eye where nothing has colours, else headlight"},
    {"ambient", RENDER(ambient)},
    {"edl", RENDER(eye_dome)},
};

static const cli_option object_table[] = {
    {"materials", OPTION_TEXT, AT(materials_path), "FILE",
     .help = "JSON table of materials (ambient, diffuse, specular, shininess, reflection), by the points' "
             "property material"},
    {"env", OPTION_TEXT, AT(environment_path), "FILE",
     .help = "surroundings that surfaces mirror: equirectangular .exr, .hdr, .pfm, .png or .jpg"},
    {"env-up", RENDER(environment_up), .value = "x,y,z"},
};

const option_group light_options = OPTION_GROUP("Light", light_table),
                   light_object_options = OPTION_GROUP("Materials and surroundings", object_table);

void light_set_defaults(light_arguments *arguments) {
    ewa_render_options_init(&arguments->render, sizeof arguments->render);
    arguments->shading = -1;
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
    if (is_zero(arguments->render.environment_up)) wrong = "--env-up: 0,0,0 has no direction";
    return options_fine(wrong, message);
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
    return session_passed(session, status);
}

void light_free(light_objects *objects) { ewa_environment_destroy(&objects->environment); }

ewa_render_options light_apply(const light_arguments *arguments, const light_objects *objects) {
    ewa_render_options options = arguments->render;
    if (arguments->shading >= 0)
        options.shading = (ewa_shading)arguments->shading;
    else if (objects->material_count || objects->environment)
        options.shading = EWA_SHADING_PHONG;
    options.light_count = arguments->lights.count;
    for (uint32_t i = 0; i < arguments->lights.count; i++) {
        const option_vector *from = &arguments->lights.each[i];
        ewa_light *to = &options.lights[i];
        ewa_light_init(to);
        memcpy(to->direction_world, from->values, sizeof to->direction_world);
        for (uint32_t c = 3; c < from->count; c++) to->color[c - 3] = (float)from->values[c];
    }
    options.materials = objects->material_count ? objects->materials : NULL;
    options.material_count = objects->material_count;
    options.environment = objects->environment;
    return options;
}
