// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa render: clouds to a picture.
#include "backend.h"
#include "color_by.h"
#include "commands.h"
#include "dividing.h"
#include "frames.h"
#include "furnish.h"
#include "inputs.h"
#include "json.h"
#include "light.h"
#include "lod_input.h"
#include "mixture_scene.h"
#include "picture.h"
#include "render_report.h"
#include "resident.h"
#include "section.h"
#include "sequence.h"
#include "video.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

typedef struct render_arguments {
    frames_arguments frames; // first: it begins with the common arguments
    light_arguments light;   // second
    const char *output, *aov, *save_camera_path, *stats_path;
    ewa_surfels_options surfels;
    section_arguments section;
    bool close_gaps;
    lod_arguments lod;
    mixture_arguments mixture;
    const char *layers, *color_by;
    int colormap, backend;
    option_bounds range;
    option_color background;
    furnish_arguments furniture;
} render_arguments;

#define AT(member)      offsetof(render_arguments, member)
#define SURFELS(member) OPTION_OF(ewa_surfels_options, AT(surfels), member)
#define RENDER(member)  OPTION_OF(ewa_render_options, AT(light.render), member)

_Static_assert(offsetof(render_arguments, light) == LIGHT_OFFSET, "light_options says so");

static const cli_option output_table[] = {
    {"output", OPTION_OUTPUT, AT(output), "FILE",
     .help = "the picture: .png (8-bit sRGB), .exr (linear floats, premultiplied: R G B A Z N.X N.Y N.Z "
             "coverage), .pfm (linear RGB); -: PNG to standard output. Frames: NAME_%04d.png and such, or a "
             "film: .mp4, .mkv (H.264), .webm (VP9), .gif, by the program ffmpeg",
     .letter = 'o'},
    {"aov", OPTION_OUTPUTS, AT(aov), "NAME=FILE,...",
     .help = "further planes, .pfm or .exr: depth (camera z, infinite where nothing is), normal (world, "
             "towards the viewer), coverage (1: covered)"},
    {"save-camera", OPTION_OUTPUT, AT(save_camera_path), "FILE",
     .help = "write the camera that was used, for --camera; of frames all cameras, for --path"},
    {"stats", OPTION_OUTPUT, AT(stats_path), "FILE",
     .help = "write times per stage, counts and peak memory as JSON"},
    BACKEND_OPTION(AT(backend)),
};

static const cli_option splat_table[] = {
    {"kernel", RENDER(kernel)},
    {"cutoff", SURFELS(cutoff)},
    {"prefilter", RENDER(prefilter_px)},
    {"radius-scale", SURFELS(radius_scale)},
    {"point-size", RENDER(point_size_px)},
    {"close-gaps", OPTION_ON_OFF, AT(close_gaps),
     .help = "measure the radii anew from the spacing where the file's leave gaps between the discs"},
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
    {"tau", RENDER(edge_threshold)},
    {"cull", RENDER(cull)},
};

static const cli_option lod_table[] = {LOD_OPTIONS(AT(lod))};

static const cli_option gaussian_table[] = {GAUSSIAN_OPTIONS(AT(mixture))};

static const cli_option volume_table[] = {MIXED_VOLUME_OPTIONS(AT(mixture))};

static const cli_option section_table[] = {SECTION_OPTIONS(AT(section))};

static const cli_option look_table[] = {
    {"background", OPTION_COLOR, AT(background), "r,g,b[,a]",
     .help = "sRGB numbers in [0, 1], or transparent", .aliases = "background-color"},
    {"color-by", OPTION_TEXT, AT(color_by), "ATTR",
     .help = "colour by an attribute ('ewa info' lists them), one component of it (normal.x), x, y, z, red, "
             "green or blue; rgb: the file's colours",
     .absent = "the file's colours, else grey"},
    {"colormap", OPTION_CHOICE, AT(colormap), NULL,
     "viridis|turbo|gray|plasma|inferno|magma|cividis|coolwarm|classes",
     .help = "colours for --color-by; classes: whole numbers by the colours of LAS classes (ground, "
             "vegetation, building, ...)",
     .absent = "classes for whole numbers named classification, else viridis", .needs = "color-by"},
    {"range", OPTION_BOUNDS, AT(range), "a,b",
     .help = "numbers that get the first and the last colour; with a percent sign, percentiles: 2%,98%",
     .aliases = "coloring-range", .absent = "least to greatest; 2%,98% for intensities", .needs = "color-by"},
};

static const cli_option furniture_table[] = {
    FURNISH_OPTIONS(AT(furniture)),
    {"color-bar", OPTION_FLAG, AT(furniture.color_bar),
     .help = "show on the right what the colours of --color-by mean: a scale, or the classes there are",
     .needs = "color-by"},
};

static void set_defaults(void *data) {
    render_arguments *arguments = data;
    frames_set_defaults(&arguments->frames);
    light_set_defaults(&arguments->light);
    ewa_surfels_options_init(&arguments->surfels, sizeof arguments->surfels);
    arguments->close_gaps = true;
    lod_input_set_defaults(&arguments->lod);
    mixture_set_defaults(&arguments->mixture);
    arguments->colormap = COLOR_BY_AUTO;
    arguments->background = (option_color){{1, 1, 1, 1}};
}

/// Paths of the picture, or of all frames: then with the place of their number. A film is none of the
/// pictures.
static bool parse_paths(const render_arguments *arguments, picture_paths *paths,
                        char message[OPTION_ERROR_BYTES]) {
    const char *color = video_find_format(arguments->output) ? NULL : arguments->output;
    return picture_parse_paths(color, arguments->aov, paths, message) &&
           (!frames_many(&arguments->frames) || sequence_check_paths(paths, message));
}

/// Sets `layers` as ewa_render_options has them.
static bool read_layers(const render_arguments *arguments, uint32_t *layers) {
    const char *word = arguments->layers ? arguments->layers : "auto";
    *layers = strcmp(word, "exact") == 0 ? EWA_LAYERS_EXACT : 0;
    if (*layers || strcmp(word, "auto") == 0) return true;
    for (; *word >= '0' && *word <= '9' && *layers <= 255; word++)
        *layers = 10 * *layers + (uint32_t)(*word - '0');
    return !*word && *layers >= 1 && *layers <= 255;
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const render_arguments *arguments = data;
    picture_paths paths;
    uint32_t layers;
    const char *missing = NULL;
    if (!arguments->output)
        missing = "render: no output; say -o FILE";
    else if (!read_layers(arguments, &layers))
        missing = "--layers: neither auto, nor exact, nor a number in [1, 255]";
    else if (layers > 1 && arguments->light.render.passes == 1)
        missing = "--layers needs --passes 3";
    else if (arguments->light.render.opacity < 1 && arguments->light.render.passes == 1)
        missing = "--opacity below 1 needs --passes 3";
    else if (arguments->colormap == COLOR_BY_CLASSES && arguments->range.given)
        missing = "--colormap classes takes no --range: each class has its own colour";
    else if (arguments->furniture.color_bar && color_by_is_own(arguments->color_by))
        missing = "--color-bar has nothing to show for the file's own colours";
    if (!options_fine(missing, message)) return false;
    return light_check(&arguments->light, message) && section_check(&arguments->section, message) &&
           frames_check(&arguments->frames, arguments->output, arguments->background.rgba[3] == 1, message) &&
           parse_paths(arguments, &paths, message) &&
           furnish_check(&arguments->furniture, arguments->output, message);
}

static ewa_render_options render_options(const render_arguments *arguments, const light_objects *lit_by) {
    ewa_render_options options = light_apply(&arguments->light, lit_by);
    read_layers(arguments, &options.layers);
    section_fill(&arguments->section, options.section_planes, &options.section_count);
    option_color_linear(&arguments->background, options.background);
    return options;
}

/// What all frames share.
typedef struct render_scene {
    frame_cameras frames;
    ewa_surfels *surfels; ///< NULL: an octree
    ewa_lod *lod;         ///< NULL: surfels
    ewa_lod_options lod_options;
    mixture_scene mixture; ///< of all that lets light through
    color_scale scale;
    furnishing furniture;
} render_scene;

/// Loads, colours, and makes surfels and the cameras; the clouds are gone afterwards. False after reporting.
static bool make_scene(cli_session *session, const render_arguments *arguments, render_scene *scene,
                       render_report *report) {
    const common_arguments *common = &arguments->frames.view.common;
    const double started_s = clock_now_s();
    const char *by = arguments->color_by;
    ewa_cloud *cloud = inputs_as_surfels(session, common, by, arguments->surfels.cutoff, &report->estimate_s);
    if (!cloud) return false;
    report->load_s = clock_now_s() - started_s - report->estimate_s;
    report->point_count = ewa_cloud_point_count(cloud);
    session->subject = common->operand_count == 1 ? common->operands[0] : NULL;
    ewa_surfels **surfels = &scene->surfels;
    frames_arguments frames = arguments->frames;
    if (common->operand_count == 1) frames.view.up_axis = session->up_axis;
    bool done =
        (!by || color_by(session, cloud, by, arguments->colormap, &arguments->range, &scene->scale)) &&
        frames_make(session, &frames, cloud, arguments->surfels.radius_scale, &scene->frames) &&
        furnish_make(session, &arguments->furniture, &frames, &arguments->background, cloud, by,
                     &scene->scale, &scene->furniture);
    session->subject = common->operand_count == 1 ? common->operands[0] : NULL;
    const resident_options options = {arguments->surfels, arguments->close_gaps,
                                      arguments->light.render.point_size_px > 0};
    done = done && resident_make(session, &options, &cloud, surfels, report);
    ewa_cloud_destroy(&cloud);
    if (!done) ewa_surfels_destroy(surfels);
    return done;
}

/// Options that need all points of an octree, or change how it was made into surfels; NULL: none is given.
static const char *find_lod_clash(const render_arguments *arguments) {
    ewa_surfels_options surfels;
    ewa_surfels_options_init(&surfels, sizeof surfels);
    return arguments->color_by && !color_by_is_own(arguments->color_by) ? "--color-by"
           : arguments->surfels.cutoff != surfels.cutoff                ? "--cutoff"
           : arguments->surfels.radius_scale != surfels.radius_scale    ? "--radius-scale"
                                                                        : NULL;
}

/// Makes the scene of an octree, of which a sample stands for the whole where that is looked at. False after
/// reporting.
static bool make_lod_scene(cli_session *session, const render_arguments *arguments, render_scene *scene,
                           render_report *report) {
    const double started_s = clock_now_s();
    const char *path = arguments->frames.view.common.operands[0];
    ewa_cloud *sample = lod_input_sample(session, scene->lod, path);
    if (!sample || !input_complete(session, path, &sample, &report->estimate_s)) {
        ewa_cloud_destroy(&sample);
        return false;
    }
    scene->lod_options = lod_input_options(&arguments->lod);
    if (crew_shares_cloud(session->crew)) {
        scene->lod_options.share = session->crew->exchange.rank;
        scene->lod_options.share_count = session->crew->exchange.rank_count;
    }
    ewa_lod_info info;
    ewa_lod_describe(scene->lod, &info);
    report->point_count = info.point_count;
    report->from_lod = true;
    if (!info.merged)
        session_note(
            session,
            "%s has points at its levels only, none that stand for others: what is far away is drawn "
            "by few of them; `ewa lod %s -o FILE.copc.laz` makes better levels",
            path, path);
    const bool done =
        frames_make(session, &arguments->frames, sample, arguments->surfels.radius_scale, &scene->frames) &&
        furnish_make(session, &arguments->furniture, &arguments->frames, &arguments->background, sample, NULL,
                     &scene->scale, &scene->furniture);
    session->subject = path;
    ewa_cloud_destroy(&sample);
    report->load_s = clock_now_s() - started_s - report->estimate_s;
    return done;
}

/// Says which options of surfaces are given where there are none.
static void warn_of_surface_options(cli_session *session, const render_arguments *arguments,
                                    const mixture_scene *mixture) {
    const light_arguments *light = &arguments->light;
    const struct {
        const char *name;
        bool given;
    } options[] = {{"opacity", light->render.opacity < 1},
                   {"layers", arguments->layers},
                   {"point-size", light->render.point_size_px > 0},
                   {"shading", light->shading > EWA_SHADING_NONE && !mixture->volume_count}};
    for (size_t i = 0; i < sizeof options / sizeof options[0]; i++)
        if (options[i].given)
            session_warn(session,
                         "--%s is for surfaces, and there are none; --surface draws Gaussians as surfels",
                         options[i].name);
}

/// Makes the scene of what lets light through, and of the surfaces among it where there are further inputs. False
/// after reporting.
static bool make_mixture_scene(cli_session *session, const render_arguments *arguments, render_scene *scene,
                               render_report *report) {
    mixture_scene *mixture = &scene->mixture;
    const double started_s = clock_now_s();
    const bool among = mixture->rest.operand_count > 0;
    const size_t others = mixture->splats_count + (size_t)mixture->volume_count - 1 + among;
    const char *subject = others ? NULL : mixture_scene_path(mixture);
    ewa_cloud *cloud = NULL;
    if (!among && arguments->color_by && !color_by_is_own(arguments->color_by)) {
        session->subject = subject;
        return session_fail(session,
                            "--color-by: Gaussians and volumes have colours of their own; --surface draws "
                            "Gaussians as surfels") == EXIT_DONE;
    }
    if (!among) warn_of_surface_options(session, arguments, mixture);
    if (among)
        cloud = inputs_as_surfels(session, &mixture->rest, arguments->color_by, arguments->surfels.cutoff,
                                  &report->estimate_s);
    bool done = (!among || cloud) &&
                mixture_scene_load(session, &arguments->mixture, &arguments->light, cloud, mixture);
    report->load_s = clock_now_s() - started_s - report->estimate_s;
    report->point_count = cloud ? ewa_cloud_point_count(cloud) : 0;
    for (uint32_t i = 0; i < mixture->splats_count && done; i++)
        report->point_count += mixture->sets[i].info.splat_count;
    if (cloud && arguments->color_by)
        done = done && color_by(session, cloud, arguments->color_by, arguments->colormap, &arguments->range,
                                &scene->scale);
    frames_arguments frames = arguments->frames;
    frames.view.up_axis = mixture->up_axis;
    session->subject = subject;
    done = done && frames_make(session, &frames, mixture->outline, 1, &scene->frames) &&
           furnish_make(session, &arguments->furniture, &frames, &arguments->background, mixture->outline,
                        arguments->color_by, &scene->scale, &scene->furniture);
    session->subject = subject;
    const resident_options options = {arguments->surfels, arguments->close_gaps,
                                      arguments->light.render.point_size_px > 0};
    done = done && (!cloud || resident_make(session, &options, &cloud, &scene->surfels, report));
    ewa_cloud_destroy(&cloud);
    return done;
}

/// Opens or loads what is to be drawn. False after reporting.
static bool prepare(cli_session *session, const render_arguments *arguments, render_scene *scene,
                    render_report *report) {
    const common_arguments *common = &arguments->frames.view.common;
    if (!mixture_scene_find(session, common, &arguments->mixture, &scene->mixture)) return false;
    if (mixture_scene_some(&scene->mixture) && crew_shares_cloud(session->crew)) {
        session_fail(
            session,
            "%s: --split cloud: what Gaussians and volumes show depends on the order of depth, which "
            "sums of parts do not have; --split frames divides their films",
            mixture_scene_path(&scene->mixture));
        return false;
    }
    if (mixture_scene_some(&scene->mixture)) return make_mixture_scene(session, arguments, scene, report);
    if (!lod_input_choose(session, common, &arguments->lod, find_lod_clash(arguments), &scene->lod))
        return false;
    if (crew_shares_cloud(session->crew) && !scene->lod) {
        struct stat facts;
        const char *path = common->operands[0];
        if (stat(path, &facts) != 0)
            session_fail(session, "%s: %s", path, strerror(errno));
        else
            session_fail(
                session,
                "--split cloud: what is shared is an octree that is drawn from its levels; `ewa-mpi lod "
                "%s -o FILE.copc.laz` makes one, and --memory draws a small one so, too",
                common->operands[0]);
        return false;
    }
    return scene->lod ? make_lod_scene(session, arguments, scene, report)
                      : make_scene(session, arguments, scene, report);
}

/// What paint() works with.
typedef struct surfel_painter {
    cli_session *session;
    ewa_renderer *renderer;
    render_scene *scene;
    const ewa_render_options *options;
    const ewa_gaussian_options *gaussians;
    render_report *report;
} surfel_painter;

/// Draws a frame of an octree, and adds what that took to the report.
static ewa_status paint_lod(const surfel_painter *painter, const ewa_camera *camera, const ewa_frame *frame,
                            ewa_render_stats *stats) {
    const render_scene *scene = painter->scene;
    ewa_lod_stats took;
    const ewa_status status = ewa_lod_render(scene->lod, painter->renderer, camera, painter->options,
                                             &scene->lod_options, frame, &took);
    if (status != EWA_OK) return status;
    *stats = took.render;
    render_report_add_lod(painter->report, &took);
    return EWA_OK;
}

static ewa_status paint(void *user, const ewa_camera *camera, const ewa_frame *frame,
                        ewa_render_stats *stats) {
    const surfel_painter *painter = user;
    render_scene *scene = painter->scene;
    const ewa_render_options *options = painter->options;
    const ewa_status status =
        mixture_scene_some(&scene->mixture)
            ? mixture_scene_paint(&scene->mixture, painter->renderer, scene->surfels, camera, options,
                                  painter->gaussians, frame, stats)
        : scene->lod ? paint_lod(painter, camera, frame, stats)
                     : ewa_render(painter->renderer, scene->surfels, camera, options, frame, stats);
    return status == EWA_OK ? furnish_draw(painter->session, &painter->scene->furniture, camera, frame)
                            : status;
}

/// Makes the renderer that was asked for, or the one of all processes. False after reporting.
static bool make_renderer(cli_session *session, int backend, ewa_renderer **renderer) {
    const char *subject = session->subject;
    session->subject = NULL; // a device is nothing of the file
    const bool joint = crew_shares_cloud(session->crew);
    ewa_status status = EWA_OK;
    if (joint && backend != EWA_BACKEND_CPU)
        session_fail(session, "--split cloud draws on processors: leave out --backend");
    else if (joint)
        status = ewa_renderer_create_joint(session->context, &session->crew->exchange, renderer);
    else
        status = ewa_renderer_create_on(session->context, (ewa_backend_kind)backend, renderer);
    if (status != EWA_OK) session_failed(session, status);
    if (*renderer && !joint) backend_warn(session, backend, *renderer);
    session->subject = subject;
    return *renderer != NULL;
}

/// Draws and writes everything. False after reporting.
static bool draw(cli_session *session, const render_arguments *arguments, const picture_paths *paths,
                 const light_objects *lit_by, render_scene *scene, render_report *report) {
    const bool many = frames_many(&arguments->frames);
    const ewa_render_options options = render_options(arguments, lit_by);
    const sequence_output output = {
        .paths = paths,
        .numbered = many,
        .film = video_find_format(arguments->output) ? arguments->output : NULL,
        .source =
            arguments->frames.path_file ? arguments->frames.path_file : arguments->frames.view.camera_path,
        .frames_per_s = arguments->frames.frames_per_s > 0 ? arguments->frames.frames_per_s : 30,
        .quality = arguments->frames.quality >= 0 ? (int)arguments->frames.quality : 75,
        .opaque = arguments->background.rgba[3] == 1,
    };
    surfel_painter painting = {.session = session,
                               .scene = scene,
                               .options = &options,
                               .gaussians = &arguments->mixture.gaussians,
                               .report = report};
    const frame_cameras *frames = &scene->frames;
    const bool saves_camera = arguments->save_camera_path && crew_leads(session->crew);
    const bool done = make_renderer(session, arguments->backend, &painting.renderer) &&
                      sequence_draw(session, &output, frames, &(frame_painter){paint, &painting}, report) &&
                      (!saves_camera || frames_save(session, arguments->save_camera_path, frames, many));
    report->renderer.struct_size = sizeof report->renderer;
    if (done) ewa_renderer_describe(painting.renderer, &report->renderer);
    ewa_renderer_destroy(&painting.renderer);
    return done;
}

/// Gaussians and volumes have no normals. False after reporting.
static bool choose_planes(cli_session *session, const render_scene *scene, picture_paths *paths) {
    if (!mixture_scene_some(&scene->mixture)) return true;
    paths->no_normals = true;
    if (!paths->normal[0]) return true;
    session->subject = mixture_scene_path(&scene->mixture);
    session_fail(
        session,
        "--aov: Gaussians and volumes have no normals; depth and coverage they have, and Gaussians as "
        "surfels, with --surface, normals");
    return false;
}

static int run(const void *data) {
    const render_arguments *arguments = data;
    const common_arguments *common = &arguments->frames.view.common;
    cli_session session;
    if (!session_start(&session, common)) return session_end(&session, EXIT_FAILED);
    picture_paths paths;
    char message[OPTION_ERROR_BYTES];
    render_scene scene = {.surfels = NULL};
    const frame_cameras *frames = &scene.frames;
    const bool many = frames_many(&arguments->frames);
    light_objects lit_by = {.material_count = 0};
    render_report report = {.load_s = 0};
    const bool film = video_find_format(arguments->output) != NULL;
    bool done = dividing_check(&session, many, film, false) && parse_paths(arguments, &paths, message) &&
                frames_plan(&session, &arguments->frames, sequence_exists, &paths, &scene.frames) &&
                dividing_choose(&session, &scene.frames);
    const bool idle = done && !frames->chosen_count && !arguments->save_camera_path && !arguments->stats_path;
    done = done && !idle && light_load(&session, &arguments->light, &lit_by) &&
           prepare(&session, arguments, &scene, &report) && choose_planes(&session, &scene, &paths) &&
           draw(&session, arguments, &paths, &lit_by, &scene, &report) &&
           (!arguments->stats_path || !crew_leads(session.crew) ||
            render_report_write(&session, common, many, frames, &report, arguments->stats_path));
    if (done && !many)
        session_say(&session, "%s: %llu of %llu splats drawn in %.1f ms, %.3f s in all", arguments->output,
                    (unsigned long long)(report.stats.splat_count - report.stats.culled_count),
                    (unsigned long long)report.stats.splat_count, 1e3 * report.render_s,
                    clock_now_s() - session.started_s);
    else if (done && frames->chosen_count)
        session_say(&session, "%s: %zu frames, each drawn in %.1f ms, %.3f s in all", arguments->output,
                    frames->chosen_count, 1e3 * report.render_s / (double)frames->chosen_count,
                    clock_now_s() - session.started_s);
    const int ended = done || idle ? EXIT_DONE : frames->beyond ? EXIT_USAGE : EXIT_FAILED;
    render_report_free(&report);
    color_scale_free(&scene.scale);
    frames_free(&scene.frames);
    ewa_surfels_destroy(&scene.surfels);
    ewa_lod_close(&scene.lod);
    mixture_scene_free(&scene.mixture);
    light_free(&lit_by);
    return session_end(&session, ended);
}

static const option_group output_options = OPTION_GROUP("Output", output_table);
static const option_group splat_options = OPTION_GROUP("Splats", splat_table);
static const option_group lod_options = OPTION_GROUP("Octrees", lod_table);
static const option_group gaussian_options = OPTION_GROUP("Gaussians", gaussian_table);
static const option_group volume_options = OPTION_GROUP("Volumes", volume_table);
static const option_group section_options = OPTION_GROUP("Section", section_table);
static const option_group look_options = OPTION_GROUP("Look", look_table);
static const option_group furniture_options = OPTION_GROUP("Over the picture", furniture_table);
const cli_command render_command = {
    .name = "render",
    .operands = "IN... -o OUT",
    .summary = "draw point clouds and meshes as continuous, antialiased surfaces",
    .details =
        "Several inputs are drawn together. Normals and radii that a file lacks are estimated from "
        "the neighbours "
        "of each point; 'ewa surfels' does the same with options and keeps the result. A file that has "
        "faces (PLY, OBJ, STL, OFF, glTF), whatever its name, is a mesh: points are put onto its faces, "
        "'ewa sample' does it with options. Clouds that are no surface, such as the points of a curve, look "
        "best with --point-size.\n"
        "\n"
        "A file of trained Gaussians (3DGS, 2DGS and Mip-Splatting PLY, compressed PLY, .splat, SPZ, glTF, "
        "...) is drawn as "
        "such, with other inputs as surfaces among them; so are volumes beside other inputs, all in one "
        "order of "
        "depth. Without --up, y is down and z ahead, as the cameras "
        "that took "
        "the pictures have it, unless the file says otherwise.\n"
        "\n"
        "Without --camera and --eye the cloud is framed whole; when less than one point in a hundred "
        "lies so far off "
        "that the rest would be tiny, those are left outside, which a message says. Without --up, the "
        "axis that points up is y or z by what the points show: what they stand on, ground, map "
        "coordinates (z), what a camera at the origin saw; else y, for STL z. Without --view, all is "
        "seen from the front (from +z with y up, from -y with z up), but ground and what is long from "
        "above at an angle (iso), drawings face on, and pictures of a camera at the origin from there. "
        "--verbose says what was chosen and why.",
    .examples =
        "ewa render scan.ply -o scan.png\n"
        "ewa render scan.ply -o side.png --view right --size 1920x1080 --background transparent\n"
        "ewa render tile1.ply tile2.ply -o height.png --color-by z --colormap turbo --shading lambert\n"
        "ewa render tile.ply -o map.png --view top --color-by classification --color-bar --axes\n"
        "ewa render scan.ply -o scan.exr --camera camera.json --aov depth=depth.pfm,normal=normal.exr\n"
        "ewa render scan.ply -o turn.mp4 --turntable 120 --elevation 20\n"
        "ewa render scan.ply guitar.ply head.nrrd -o all.png --transfer bone\n"
        "ewa render garden.spz -o garden.png --camera cameras.json --projection exact\n"
        "ewa render scan.ply -o fly_%04d.png --path keys.json --frames 300\n"
        "ewa render scan.ply -o turn_%04d.png --turntable 360 --frames 2/8 --skip-existing\n"
        "ewa render scan.ply -o floor.png --view top --clip-plane 0,0,-1,1.5\n",
    .low_operands = 1,
    .high_operands = 4096,
    .groups = (const option_group *const[]){&output_options, &cloud_input_options, &view_options,
                                            &frames_options, &splat_options, &lod_options, &gaussian_options,
                                            &volume_options, &section_options, &light_options, &look_options,
                                            &furniture_options, NULL},
    .arguments_bytes = sizeof(render_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
