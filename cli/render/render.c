// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa render: clouds to a picture.
#include "cli/base/backend.h"
#include "cli/base/commands.h"
#include "cli/base/json.h"
#include "cli/base/pattern.h"
#include "cli/input/inputs.h"
#include "cli/render/frame_partition.h"
#include "cli/render/frames.h"
#include "cli/render/look.h"
#include "cli/render/picture.h"
#include "cli/render/render_report.h"
#include "cli/render/sequence.h"
#include "cli/render/video.h"

#include <stdio.h>
#include <string.h>

typedef struct render_arguments {
    frames_arguments frames; // first: it begins with the common arguments
    look_arguments look;     // second
    const char *output, *aov, *save_camera_path, *save_scene_path, *stats_path;
    int backend;
    uint64_t outlines; ///< how many surfels' outlines are drawn over the picture
    ewa_panorama_options panorama;
} render_arguments;

#define AT(member) offsetof(render_arguments, member)

_Static_assert(offsetof(render_arguments, look) == LOOK_OFFSET, "the look's tables say so");

static const cli_option output_table[] = {
    {"output", OPTION_OUTPUT, AT(output), "FILE",
     .help =
         "the picture: .png or .jpg (8-bit sRGB), .exr (linear floats, premultiplied: R G B A Z N.X N.Y N.Z "
         "coverage), .pfm (linear RGB); -: PNG to standard output. Frames: NAME_%04d.png and such, or a "
         "film: .mp4, .mkv (H.264), .webm (VP9), .gif, by the program ffmpeg",
     .letter = 'o'},
    {"aov", OPTION_OUTPUTS, AT(aov), "NAME=FILE,...",
     .help = "further planes, .pfm or .exr: depth (camera z, infinite where nothing is), normal (world, "
             "towards the viewer), coverage (1: covered)"},
    {"save-camera", OPTION_OUTPUT, AT(save_camera_path), "FILE",
     .help = "write the camera that was used, for --camera; of frames all cameras, for --path"},
    {"save-scene", OPTION_OUTPUT, AT(save_scene_path), "FILE.json",
     .help = "write what is drawn, how, and from where as a scene file, which `render`, `view` and Python "
             "open; its files "
             "must lie below its folder"},
    {"stats", OPTION_OUTPUT, AT(stats_path), "FILE",
     .help = "write times per stage, counts and peak memory as JSON"},
    BACKEND_OPTION(AT(backend)),
};

static const cli_option panorama_table[] = {
    {"panorama", OPTION_OF(ewa_panorama_options, AT(panorama), kind)},
    {"panorama-fov", OPTION_OF(ewa_panorama_options, AT(panorama), fov_deg), .needs = "panorama"},
};

static const cli_option outline_table[] = {
    {"outlines", OPTION_INTEGER, AT(outlines), "N", "[0, 1000000]",
     .help = "draw the outlines of N of the surfels that are seen, as their kernels end; 0: none"},
};

static void set_defaults(void *data) {
    render_arguments *arguments = data;
    frames_set_defaults(&arguments->frames);
    ewa_panorama_options_init(&arguments->panorama, sizeof arguments->panorama);
    look_set_defaults(&arguments->look);
}

/// Paths of the picture, or of all frames: then with the place of their number. A film is none of the
/// pictures.
static bool parse_paths(const render_arguments *arguments, picture_paths *paths,
                        char message[OPTION_ERROR_BYTES]) {
    const char *color = video_find_format(arguments->output) ? NULL : arguments->output;
    if (!picture_parse_paths(color, arguments->aov, paths, message)) return false;
    paths->jpeg_quality = arguments->frames.quality;
    return !frames_many(&arguments->frames) || sequence_check_paths(paths, message);
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const render_arguments *arguments = data;
    picture_paths paths;
    const char *missing = NULL;
    if (!arguments->output)
        missing = "render: no output; say -o FILE";
    else if (arguments->outlines && path_has_suffix(arguments->output, ".exr|.pfm"))
        missing = "--outlines are not drawn on .exr and .pfm, which hold data";
    else if (arguments->outlines && arguments->look.light.render.point_size_px > 0)
        missing = "--outlines are of surfels, and --point-size draws none";
    else if (arguments->panorama.kind != EWA_PANORAMA_NONE &&
             (arguments->outlines || arguments->look.furniture.axes || arguments->look.furniture.scale_bar || arguments->frames.view.ortho_height > 0))
        missing = "--panorama has no --outlines, --axes, --scale-bar and --ortho: these are of plane pictures";
    if (!options_fine(missing, message)) return false;
    return look_check(&arguments->look, arguments->output, message) &&
           frames_check(&arguments->frames, arguments->output, arguments->look.background.rgba[3] == 1, message) &&
           parse_paths(arguments, &paths, message);
}

/// What all frames share.
typedef struct render_scene {
    frame_cameras frames;
    ewa_scene *scene;
    bool octrees;
    furnishing furniture;
    uint32_t outlines;
    ewa_panorama_options panorama;
} render_scene;

/// Says which options of surfaces are given where there are none.
static void warn_of_surface_options(cli_session *session, const render_arguments *arguments, bool volumes) {
    const light_arguments *light = &arguments->look.light;
    ewa_render_options usual;
    ewa_render_options_init(&usual, sizeof usual);
    const struct {
        const char *name;
        bool given;
    } options[] = {{"opacity", light->render.opacity < 1},
                   {"layers", arguments->look.layers},
                   {"point-size", light->render.point_size_px > 0},
                   {"prefilter", light->render.prefilter_px != usual.prefilter_px},
                   {"shading", light->shading > EWA_SHADING_NONE && !volumes}};
    for (size_t i = 0; i < sizeof options / sizeof options[0]; i++)
        if (options[i].given)
            session_warn(session,
                         "--%s is for surfaces, and there are none; --surface draws Gaussians as surfels",
                         options[i].name);
}

/// Checks what cannot be asked of what there is. False after reporting.
static bool check_scene(cli_session *session, const render_arguments *arguments, const ewa_scene *scene) {
    ewa_scene_info info;
    ewa_surfels_options surfels;
    ewa_surfels_options_init(&surfels, sizeof surfels);
    ewa_scene_describe(scene, &info);
    const bool colored = arguments->look.coloring.color_by && !ewa_coloring_is_own(arguments->look.coloring.color_by);
    if (info.octrees && arguments->look.surfels.cutoff != surfels.cutoff) {
        session_fail(
            session,
            "--cutoff needs all points of an octree; --levels never reads them, or `ewa convert` what "
            "is wanted to a file of its own");
        return false;
    }
    if (colored && !info.surfaces && !info.gaussians) {
        session_fail(session, "--color-by: volumes have colours of their own, by --transfer");
        return false;
    }
    if (!info.surfaces) warn_of_surface_options(session, arguments, info.volumes);
    return true;
}

/// Says what is upright in a panorama, and where it is seen from where the cameras do not. False after reporting.
static bool place_panorama(cli_session *session, const render_arguments *arguments, const view_subject *subject,
                           render_scene *scene) {
    scene->panorama = arguments->panorama;
    if (scene->panorama.kind == EWA_PANORAMA_NONE) return true;
    const view_arguments *view = &arguments->frames.view;
    ewa_camera placed, own;
    if (!view_make_panorama(session, view, subject, &scene->panorama, &placed)) return false;
    if (view->camera_path || frames_many(&arguments->frames)) return true;
    scene->frames.cameras[0] = placed;
    if (!view->eye.count && !ewa_scene_get_camera(scene->scene, &own))
        session_note(session, "a panorama from the middle of what there is; --eye stands elsewhere");
    return true;
}

/// Loads what is to be drawn, places the cameras and makes all resident. False after reporting.
static bool prepare(cli_session *session, const render_arguments *arguments, const light_objects *lit_by,
                    render_scene *scene, render_report *report) {
    const common_arguments *common = &arguments->frames.view.common;
    ewa_scene_options options = look_scene_options(&arguments->look, lit_by);
    options.keep_points = arguments->outlines > 0;
    options.many_frames = frames_many(&arguments->frames);
    scene->outlines = (uint32_t)arguments->outlines;
    ewa_asset_options assets = scene_input_asset_options(session);
    look_set_asset_options(&arguments->look, &assets);
    assets.gaussian_levels = options.gaussians.merge_px > 0;
    ewa_coloring coloring;
    scene_input_coloring(&arguments->look.coloring, &coloring);
    ewa_status status = ewa_scene_create(session->context, &options, &scene->scene);
    if (status != EWA_OK) return session_failed(session, status) == EXIT_DONE;
    if (!scene_input_add(session, common->operand_count, common->operands, &assets, &coloring, scene->scene)) return false;
    session->subject = common->operand_count == 1 ? common->operands[0] : NULL;
    if (!check_scene(session, arguments, scene->scene)) return false;
    if (ewa_scene_measure(scene->scene, 0))
        session_note(session, "its measurements and notes are left out; pictures of 'ewa view' (shot) show them");
    if (arguments->outlines && process_group_shares_cloud(session->group)) {
        session_fail(session, "--outlines needs all points in one process");
        return false;
    }
    const view_subject subject = {.scene = scene->scene};
    frames_arguments frames = arguments->frames;
    frames.view.color_bar = arguments->look.furniture.color_bar;
    if (!frames_make(session, &frames, &subject, &scene->frames) ||
        !furnish_make(session, &arguments->look.furniture, &arguments->frames, &arguments->look.background, &subject,
                      &scene->furniture))
        return false;
    if (!place_panorama(session, arguments, &subject, scene)) return false;
    status = ewa_scene_commit(scene->scene);
    if (status != EWA_OK) return session_failed(session, status) == EXIT_DONE;
    ewa_scene_info info;
    ewa_scene_describe(scene->scene, &info);
    scene->octrees = info.octrees;
    report->from_lod = info.octrees;
    report->point_count = info.point_count;
    report->load_s = info.load_s;
    report->estimate_s = info.estimate_s;
    report->surfels_s = info.surfels_s;
    report->surfels = info.surfels;
    const ewa_legend *legend = NULL;
    for (uint32_t i = 0; i < info.instance_count && !legend; i++) legend = ewa_scene_legend(scene->scene, i);
    if (!arguments->look.furniture.color_bar) return true;
    if (legend)
        furnish_color_bar(legend, &scene->furniture);
    else
        session_fail(session, "--color-bar has nothing to show for the file's own colours; --color-by ATTR shows a number");
    return legend;
}

/// What paint() works with.
typedef struct scene_painter {
    cli_session *session;
    ewa_scene_renderer *renderer;
    render_scene *scene;
    render_report *report;
} scene_painter;

static ewa_status paint(void *user, const ewa_camera *camera, const ewa_frame *frame,
                        ewa_render_stats *stats) {
    const scene_painter *painter = user;
    render_scene *scene = painter->scene;
    ewa_scene_stats took;
    const ewa_status status =
        ewa_scene_draw_panorama(scene->scene, painter->renderer, camera, NULL, &scene->panorama, frame, &took);
    if (status != EWA_OK) return status;
    *stats = took.render;
    if (scene->octrees || took.lod.node_count) render_report_add_lod(painter->report, &took.lod);
    const ewa_canvas canvas = {frame->rgba8, camera->width_px, camera->height_px};
    const ewa_status drawn =
        scene->outlines
            ? ewa_scene_draw_outlines(scene->scene, painter->renderer, camera, NULL, scene->outlines, &canvas)
            : EWA_OK;
    if (drawn != EWA_OK) return drawn;
    return furnish_draw(painter->session, &scene->furniture, camera, frame);
}

/// Makes the renderer that was asked for, or the one of all processes. False after reporting.
static bool make_renderer(cli_session *session, int backend, ewa_scene_renderer **renderer) {
    const char *subject = session->subject;
    session->subject = NULL; // a device is nothing of the file
    const bool joint = process_group_shares_cloud(session->group);
    ewa_status status = EWA_OK;
    if (joint && backend != EWA_BACKEND_CPU)
        session_fail(session, "--split cloud draws on processors: leave out --backend");
    else
        status = ewa_scene_renderer_create(session->context, (ewa_backend_kind)backend,
                                           joint ? &session->group->exchange : NULL, renderer);
    if (status != EWA_OK) session_failed(session, status);
    if (*renderer && !joint) backend_warn(session, backend, ewa_scene_renderer_surfaces(*renderer));
    session->subject = subject;
    return *renderer != NULL;
}

/// Writes the scene file that was asked for, with the first camera. False after reporting.
static bool save_scene(cli_session *session, const render_arguments *arguments, const render_scene *scene) {
    if (!arguments->save_scene_path || !process_group_leads(session->group)) return true;
    return session_passed(session,
                          ewa_scene_save(scene->scene, scene->frames.cameras, arguments->save_scene_path));
}

/// Draws and writes everything. False after reporting.
static bool draw(cli_session *session, const render_arguments *arguments, const picture_paths *paths,
                 render_scene *scene, render_report *report) {
    const bool many = frames_many(&arguments->frames);
    const sequence_output output =
        sequence_output_of(&arguments->frames, arguments->output, paths, arguments->look.background.rgba[3] == 1);
    scene_painter painting = {.session = session, .scene = scene, .report = report};
    const frame_cameras *frames = &scene->frames;
    const bool saves_camera = arguments->save_camera_path && process_group_leads(session->group);
    const bool done = make_renderer(session, arguments->backend, &painting.renderer) &&
                      sequence_draw(session, &output, frames, &(frame_painter){paint, &painting}, report) &&
                      save_scene(session, arguments, scene) &&
                      (!saves_camera || frames_save(session, arguments->save_camera_path, frames, many));
    report->renderer.struct_size = sizeof report->renderer;
    if (done) ewa_scene_renderer_describe(painting.renderer, &report->renderer);
    ewa_scene_renderer_destroy(&painting.renderer);
    return done;
}

/// Gives panoramas the shape that they have, where neither a size is given nor cameras, which have one.
static render_arguments shape_panorama(const render_arguments *given) {
    enum { HEIGHT_PX = 1024 };
    render_arguments arguments = *given;
    option_size *size = &arguments.frames.view.size;
    const bool sized = size->given || arguments.frames.view.camera_path || arguments.frames.path_file;
    if (sized || arguments.panorama.kind == EWA_PANORAMA_NONE) return arguments;
    size->width_px = arguments.panorama.kind == EWA_PANORAMA_EQUIRECTANGULAR ? 2 * HEIGHT_PX : HEIGHT_PX;
    size->height_px = HEIGHT_PX;
    size->given = true;
    return arguments;
}

static int run(const void *data) {
    const render_arguments shaped = shape_panorama(data), *arguments = &shaped;
    const common_arguments *common = &arguments->frames.view.common;
    cli_session session;
    if (!session_start(&session, common)) return session_end(&session, EXIT_FAILED);
    picture_paths paths;
    char message[OPTION_ERROR_BYTES];
    render_scene scene = {.scene = NULL};
    const frame_cameras *frames = &scene.frames;
    const bool many = frames_many(&arguments->frames);
    light_objects lit_by = {.material_count = 0};
    render_report report = {.load_s = 0};
    const bool film = video_find_format(arguments->output) != NULL;
    bool done = frame_partition_check(&session, many, film, false) &&
                parse_paths(arguments, &paths, message) &&
                frames_plan(&session, &arguments->frames, sequence_exists, &paths, &scene.frames) &&
                frame_partition_choose(&session, &scene.frames);
    const bool idle = done && !frames->chosen_count && !arguments->save_camera_path &&
                      !arguments->save_scene_path && !arguments->stats_path;
    done = done && !idle && light_load(&session, &arguments->look.light, &lit_by) &&
           prepare(&session, arguments, &lit_by, &scene, &report) &&
           draw(&session, arguments, &paths, &scene, &report) &&
           (!arguments->stats_path || !process_group_leads(session.group) ||
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
    frames_free(&scene.frames);
    ewa_scene_destroy(&scene.scene);
    light_free(&lit_by);
    return session_end(&session, ended);
}

static const option_group panorama_group = OPTION_GROUP("Panorama", panorama_table);
static const option_group outline_options = OPTION_GROUP("Outlines", outline_table);
static const option_group output_options = OPTION_GROUP("Output", output_table);
const cli_command render_command = {
    .name = "render",
    .operands = "IN... -o OUT",
    .summary = "draw point clouds and meshes as continuous, antialiased surfaces",
    .details =
        "Several inputs are drawn together. Normals and radii that a file lacks are estimated from "
        "the neighbours "
        "of each point; 'ewa surfels' does the same with options and keeps the result. A file that has "
        "faces (PLY, OBJ, STL, OFF, glTF, VTK), whatever its name, is a mesh: points are put onto its faces, "
        "'ewa sample' does it with options. Sharp edges of bare clouds, as of a box, "
        "are ragged: 'ewa features' finds them and ends their surfels there. Clouds that are no surface, such as "
        "a bundle of curves, look best with --point-size.\n"
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
        "seen from the front (from +z with y up, from -y with z up), but ground, what is long and what has "
        "a plane for a front, as cubes, from above at an angle (iso), drawings face on, and pictures of a camera at the origin from there. "
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
        "ewa render hall.e57 -o around.jpg --panorama equirectangular --eye 0,0,1.7\n"
        "ewa render scan.ply -o floor.png --view top --clip-plane 0,0,-1,1.5\n",
    .low_operands = 1,
    .high_operands = 4096,
    .groups = (const option_group *const[]){&output_options, &cloud_input_options, &view_options,
                                            &panorama_group, &frames_options, LOOK_GROUPS, &outline_options, NULL},
    .arguments_bytes = sizeof(render_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
