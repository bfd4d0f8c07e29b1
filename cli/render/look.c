// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How a scene is shown: the options that `ewa render`, `ewa view` and `ewa page` take, in one table.
#include "cli/render/look.h"
#include "cli/render/gaussians.h"

#include <string.h>

#define AT(member)      (LOOK_OFFSET + offsetof(look_arguments, member))
#define SURFELS(member) OPTION_OF(ewa_surfels_options, AT(surfels), member)
#define RENDER(member)  OPTION_OF(ewa_render_options, AT(light.render), member)

_Static_assert((size_t)LOOK_OFFSET == (size_t)LIGHT_OFFSET && offsetof(look_arguments, light) == 0, "light_options says so");

static const cli_option splat_table[] = {
    {"kernel", RENDER(kernel)},
    {"cutoff", SURFELS(cutoff)},
    {"prefilter", RENDER(prefilter_px)},
    {"radius-scale", SURFELS(radius_scale)},
    {"point-size", RENDER(point_size_px)},
    {"close-gaps", OPTION_ON_OFF, AT(close_gaps),
     .help = "measure anew the radii of a file that leave gaps between the discs, and its normals where many are far off the points' own surface"},
    {"tolerance", RENDER(tolerance)},
    {"passes", RENDER(passes)},
    {"edge-aa", RENDER(edge_antialiasing)},
    {"edge-layers", RENDER(edge_layers)},
    {"layers", OPTION_TEXT, AT(layers), "auto|L|exact",
     .help = "transparent surfaces of a pixel that are composited: 1: the nearest as if it were opaque; L: "
             "the L - 1 nearest and all that lies behind as one more; exact: all; auto: all when --opacity "
             "or the file's alpha is below 1",
     .absent = "auto"},
    {"opacity", RENDER(opacity)},
    {"supersampling", RENDER(supersampling)},
    {"tau", RENDER(edge_threshold)},
    {"cull", RENDER(cull)},
};

static const cli_option lod_table[] = {LOD_OPTIONS(AT(lod))};

static const cli_option gaussian_table[] = {
    GAUSSIAN_OPTIONS(AT(gaussians)),
    {"surface", OPTION_FLAG, AT(gaussians_as_surfels),
     .help = "draw Gaussians as opaque surfels, with depth, normals and light, in their constant colours"},
};

static const cli_option volume_table[] = {
    {"transfer", OPTION_TEXT, AT(transfer), "FILE|PRESET",
     .help = "what values of volumes look like, as in 'ewa volume', whose --save-transfer writes such files",
     .absent = "auto: by the surfaces between its materials"},
    {"opacity-scale", OPTION_OF(ewa_volume_options, AT(volumes), density_scale)},
};

static const cli_option section_table[] = {SECTION_OPTIONS(AT(section))};

static const cli_option color_table[] = {
    {"background", OPTION_COLOR, AT(background), "r,g,b[,a]", .help = OPTION_COLOR_HELP,
     .aliases = "background-color"},
    COLORING_OPTIONS(AT(coloring)),
};

static const cli_option furniture_table[] = {
    FURNISH_OPTIONS(AT(furniture)),
    {"color-bar", OPTION_FLAG, AT(furniture.color_bar),
     .help = "show on the right, or at the bottom of a tall picture, what colours of numbers mean: a scale, or the classes there are"},
};

const option_group look_splats = OPTION_GROUP("Splats", splat_table), look_octrees = OPTION_GROUP("Octrees", lod_table),
                   look_gaussians = OPTION_GROUP("Gaussians", gaussian_table), look_volumes = OPTION_GROUP("Volumes", volume_table),
                   look_sections = OPTION_GROUP("Section", section_table), look_colors = OPTION_GROUP("Look", color_table),
                   look_furniture = OPTION_GROUP("Over the picture", furniture_table);

void look_set_defaults(look_arguments *arguments) {
    light_set_defaults(&arguments->light);
    ewa_surfels_options_init(&arguments->surfels, sizeof arguments->surfels);
    arguments->close_gaps = true;
    lod_input_set_defaults(&arguments->lod);
    gaussians_set_defaults(&arguments->gaussians);
    ewa_volume_options_init(&arguments->volumes, sizeof arguments->volumes);
    arguments->coloring.colormap = EWA_COLORING_AUTO - 1;
    arguments->background = (option_color){{1, 1, 1, 1}};
}

/// Sets `layers` as ewa_render_options has them.
static bool read_layers(const look_arguments *arguments, uint32_t *layers) {
    const char *word = arguments->layers;
    *layers = word && strcmp(word, "exact") == 0 ? EWA_LAYERS_EXACT : 0;
    if (*layers || !word) return true;
    for (; *word >= '0' && *word <= '9' && *layers <= 255; word++)
        *layers = 10 * *layers + (uint32_t)(*word - '0');
    return !*word && *layers >= 1 && *layers <= 255;
}

bool look_check(const look_arguments *arguments, const char *output, char message[OPTION_ERROR_BYTES]) {
    uint32_t layers;
    const char *wrong = NULL;
    const coloring_arguments *coloring = &arguments->coloring;
    if (!read_layers(arguments, &layers))
        wrong = "--layers: neither auto, nor exact, nor a number in [1, 255]";
    else if (layers > 1 && arguments->light.render.passes == 1)
        wrong = "--layers needs --passes 3";
    else if (arguments->light.render.opacity < 1 && arguments->light.render.passes == 1)
        wrong = "--opacity below 1 needs --passes 3";
    else if (coloring->colormap == EWA_COLORING_CLASSES - 1 && coloring->range.given)
        wrong = "--colormap classes takes no --range: each class has its own colour";
    else if (arguments->furniture.color_bar && coloring->color_by && ewa_coloring_is_own(coloring->color_by))
        wrong = "--color-bar has nothing to show for the file's own colours";
    return options_fine(wrong, message) && light_check(&arguments->light, message) &&
           section_check(&arguments->section, message) && furnish_check(&arguments->furniture, output, message);
}

ewa_scene_options look_scene_options(const look_arguments *arguments, const light_objects *lit_by) {
    ewa_scene_options options;
    ewa_scene_options_init(&options, sizeof options);
    options.close_gaps = arguments->close_gaps;
    options.surfels = arguments->surfels;
    options.lod = arguments->lod.options;
    options.gaussians = arguments->gaussians;
    options.volumes = arguments->volumes;
    options.shade_volumes = arguments->light.shading < 0;
    if (arguments->light.shading >= 0) options.volumes.shading = (ewa_shading)arguments->light.shading;
    options.render = light_apply(&arguments->light, lit_by);
    read_layers(arguments, &options.render.layers);
    section_fill(&arguments->section, options.render.section_planes, &options.render.section_count);
    option_color_linear(&arguments->background, options.render.background);
    return options;
}

void look_set_asset_options(const look_arguments *arguments, ewa_asset_options *options) {
    options->gaussians_as_surfels = arguments->gaussians_as_surfels;
    options->levels = lod_input_levels(&arguments->lod);
    options->cutoff = arguments->surfels.cutoff;
    options->transfer = arguments->transfer;
    options->reach_steps = arguments->volumes.sigma * arguments->volumes.cutoff;
}
