// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa volume: volumes to a picture.
#include "cli/base/backend.h"
#include "cli/base/commands.h"
#include "cli/base/json.h"
#include "cli/render/frame_partition.h"
#include "cli/render/furnish.h"
#include "cli/render/light.h"
#include "cli/render/section.h"
#include "cli/render/sequence.h"
#include "cli/render/video.h"
#include "cli/volume/volume_scene.h"

#include <stdio.h>
#include <string.h>

typedef struct volume_arguments {
    frames_arguments frames; // first: it begins with the common arguments
    light_arguments light;   // second
    volume_input_arguments input;
    volume_scene_arguments scene;
    const char *output, *aov, *save_camera_path, *stats_path;
    bool progressive;
    int backend;
    option_color background;
    section_arguments section;
    furnish_arguments furniture;
} volume_arguments;

#define AT(member)     offsetof(volume_arguments, member)
#define VOLUME(member) OPTION_OF(ewa_volume_options, AT(scene.options), member)

_Static_assert(offsetof(volume_arguments, light) == LIGHT_OFFSET, "light_check() and light_apply() say so");

static const cli_option output_table[] = {
    {"output", OPTION_OUTPUT, AT(output), "FILE",
     .help = "the picture: .png or .jpg (8-bit sRGB), .exr (linear floats, premultiplied: R G B A Z coverage), .pfm "
             "(linear RGB); -: PNG to standard output. Frames: NAME_%04d.png and such, or a film: .mp4, .mkv "
             "(H.264), .webm (VP9), .gif, by the program ffmpeg",
     .letter = 'o'},
    {"aov", OPTION_OUTPUTS, AT(aov), "NAME=FILE,...",
     .help = "further planes, .pfm or .exr: depth (camera z where half of the light is gone, infinite where "
             "that never is), coverage (alpha of the volume)"},
    {"save-camera", OPTION_OUTPUT, AT(save_camera_path), "FILE",
     .help = "write the camera that was used, for --camera; of frames all cameras, for --path"},
    {"stats", OPTION_OUTPUT, AT(stats_path), "FILE",
     .help = "write times per stage, counts and peak memory as JSON"},
    BACKEND_OPTION(AT(backend)),
    {"progressive", OPTION_FLAG, AT(progressive),
     .help = "write a first picture of every second voxel along each axis, then the whole in its place",
     .excludes = "turntable path"},
};

static const cli_option input_table[] = {VOLUME_INPUT_OPTIONS(AT(input))};

static const cli_option voxel_table[] = {
    {"transfer", OPTION_TEXT, AT(scene.transfer), "FILE|PRESET",
     .help = "what values look like: a JSON file, or bone, soft, skin, vessels (CT, in Hounsfield units "
             "where the volume has them), mri, gray, fog, auto",
     .absent = "auto: by the surfaces between its materials"},
    {"save-transfer", OPTION_OUTPUT, AT(scene.save_transfer_path), "FILE",
     .help = "write the transfer function that was used, to change it and come back with --transfer"},
    {"range", OPTION_BOUNDS, AT(scene.range), "a,b",
     .help = "values to which its first and its last point go; with a percent sign, percentiles: 50%,99%",
     .absent = "auto: as the transfer function says"},
    {"gradient", OPTION_VECTOR, AT(scene.gradient), "low,high",
     .help = "show boundaries: voxels whose value changes by less than low per world unit are empty, by high "
             "or more as they are, a ramp between",
     .low = 2, .high = 2, .absent = "auto: as the transfer function says"},
    {"opacity-scale", VOLUME(density_scale)},
    {"method", VOLUME(method)},
    {"footprint", VOLUME(index)},
    {"mark-splats", OPTION_FLAG, AT(scene.options.mark_splats),
     .help = "draw voxels that are splats in red, points as they are"},
    {"sigma", VOLUME(sigma)},
    {"cutoff", VOLUME(cutoff)},
    {"prefilter", VOLUME(prefilter_px)},
    {"surfels", OPTION_TEXT, AT(scene.surfels_path), "FILE",
     .help = "a point cloud or mesh that stands in the volume, opaque, in the same world"},
};

static const cli_option section_table[] = {SECTION_OPTIONS(AT(section))};

static const cli_option look_table[] = {
    {"shading", OPTION_CHOICE, LIGHT_OFFSET + offsetof(light_arguments, shading), NULL, "none|lambert|phong",
     .help = "light, by the gradient: none gives the bare colours, lambert matt matter, phong highlights",
     .absent = "auto: phong; none with the presets gray and fog"},
    {"light", OPTION_VECTORS, LIGHT_OFFSET + offsetof(light_arguments, lights), "x,y,z[,r,g,b]",
     .help = "direction towards a light, and its linear colour (default 1,1,1); may be given up to 8 times",
     .low = 3, .high = 6, .absent = "auto: headlight"},
    {"background", OPTION_COLOR, AT(background), "r,g,b[,a]", .help = OPTION_COLOR_HELP,
     .aliases = "background-color"},
};

static const cli_option furniture_table[] = {FURNISH_OPTIONS(AT(furniture))};

static void set_defaults(void *data) {
    volume_arguments *arguments = data;
    frames_set_defaults(&arguments->frames);
    light_set_defaults(&arguments->light);
    volume_input_set_defaults(&arguments->input);
    ewa_volume_options_init(&arguments->scene.options, sizeof arguments->scene.options);
    arguments->background = (option_color){{0, 0, 0, 1}};
}

static bool parse_paths(const volume_arguments *arguments, picture_paths *paths,
                        char message[OPTION_ERROR_BYTES]) {
    const char *color = video_find_format(arguments->output) ? NULL : arguments->output;
    if (!picture_parse_paths(color, arguments->aov, paths, message)) return false;
    paths->no_normals = true;
    paths->jpeg_quality = arguments->frames.quality;
    if (paths->normal[0]) {
        snprintf(message, OPTION_ERROR_BYTES, "--aov: a volume has no normals; depth and coverage it has");
        return false;
    }
    return !frames_many(&arguments->frames) || sequence_check_paths(paths, message);
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const volume_arguments *arguments = data;
    const option_vector *gradient = &arguments->scene.gradient;
    const char *wrong = NULL;
    picture_paths paths;
    if (!arguments->output)
        wrong = "volume: no output; say -o FILE";
    else if (gradient->count && !(gradient->values[0] >= 0 && gradient->values[1] >= gradient->values[0]))
        wrong = "--gradient: two numbers >= 0, the second not below the first";
    if (!options_fine(wrong, message)) return false;
    return volume_input_check(&arguments->input, message) && section_check(&arguments->section, message) &&
           light_check(&arguments->light, message) &&
           frames_check(&arguments->frames, arguments->output, arguments->background.rgba[3] == 1, message) &&
           parse_paths(arguments, &paths, message) &&
           furnish_check(&arguments->furniture, arguments->output, message);
}

/// What paint() works with.
typedef struct volume_painter {
    cli_session *session;
    ewa_scene *scene;
    ewa_scene_renderer *renderer;
    ewa_scene_options options;
    ewa_voxels_info voxels;
    double load_s, classify_s;
    furnishing furniture;
    ewa_volume_stats stats; // counts and times summed over all frames
} volume_painter;

static ewa_status paint(void *user, const ewa_camera *camera, const ewa_frame *frame,
                        ewa_render_stats *stats) {
    volume_painter *painter = user;
    ewa_scene_stats took;
    const ewa_status status =
        ewa_scene_draw(painter->scene, painter->renderer, camera, &painter->options, frame, &took);
    if (status != EWA_OK) return status;
    *stats = took.render;
    const ewa_volume_stats *drawn = &took.volumes;
    ewa_volume_stats *sum = &painter->stats;
    sum->voxel_count = drawn->voxel_count;
    sum->culled_count += drawn->culled_count;
    sum->hidden_count += drawn->hidden_count;
    sum->near_count += drawn->near_count;
    sum->splat_count += drawn->splat_count;
    sum->point_count += drawn->point_count;
    sum->bin_s += drawn->bin_s;
    sum->setup_s += drawn->setup_s;
    sum->points_s += drawn->points_s;
    sum->splats_s += drawn->splats_s;
    sum->resolve_s += drawn->resolve_s;
    return furnish_draw(painter->session, &painter->furniture, camera, frame);
}

/// Makes the scene, places the cameras and gets ready to draw. Returns false after reporting.
static bool prepare(const volume_arguments *arguments, frame_cameras *frames, volume_painter *painter) {
    cli_session *session = painter->session;
    const light_objects nothing = {.material_count = 0};
    const double started_s = clock_now_s();
    ewa_scene_options *options = &painter->options;
    ewa_scene_options_init(options, sizeof *options);
    options->render = light_apply(&arguments->light, &nothing);
    option_color_linear(&arguments->background, options->render.background);
    section_fill(&arguments->section, options->render.section_planes, &options->render.section_count);
    options->volumes = arguments->scene.options;
    options->shade_volumes = arguments->light.shading < 0;
    if (!options->shade_volumes) options->volumes.shading = (ewa_shading)arguments->light.shading;
    ewa_status status = ewa_scene_create(session->context, options, &painter->scene);
    if (status == EWA_OK)
        status = ewa_scene_renderer_create(session->context, (ewa_backend_kind)arguments->backend, NULL, &painter->renderer);
    if (status != EWA_OK) return session_failed(session, status) == EXIT_DONE;
    backend_warn(session, arguments->backend, ewa_scene_renderer_surfaces(painter->renderer));
    if (!volume_scene_fill(session, &arguments->input, &arguments->scene,
                           arguments->frames.view.common.operands[0], arguments->progressive ? 2 : 1,
                           painter->scene))
        return false;
    ewa_asset_info volume;
    ewa_asset_describe(ewa_scene_asset(painter->scene, 0), &volume);
    ewa_voxels_describe(volume.voxels, &painter->voxels);
    painter->classify_s = volume.load_s;
    painter->load_s = clock_now_s() - started_s - volume.load_s;
    const view_subject subject = {.scene = painter->scene};
    return frames_make(session, &arguments->frames, &subject, frames) &&
           furnish_make(session, &arguments->furniture, &arguments->frames, &arguments->background, &subject,
                        &painter->furniture);
}

/// Draws and writes everything, coarse first when asked for. False after reporting.
static bool draw(const volume_arguments *arguments, const picture_paths *paths, const frame_cameras *frames,
                 volume_painter *painter, render_report *report) {
    const sequence_output output = sequence_output_of(&arguments->frames, arguments->output, paths,
                                                      arguments->background.rgba[3] == 1);
    const frame_painter paints = {paint, painter};
    cli_session *session = painter->session;
    if (arguments->progressive && painter->voxels.level_count > 1) {
        painter->options.volumes.level = painter->voxels.level_count - 1;
        if (!sequence_draw(session, &output, frames, &paints, report)) return false;
        session_say(session, "%s: a first picture after %.3f s", arguments->output,
                    clock_now_s() - session->started_s);
        painter->options.volumes.level = 0;
        painter->stats = (ewa_volume_stats){.voxel_count = 0};
    }
    return sequence_draw(session, &output, frames, &paints, report) &&
           (!arguments->save_camera_path ||
            frames_save(session, arguments->save_camera_path, frames, output.numbered));
}

/// Writes --stats; false after reporting.
static bool write_stats(cli_session *session, const volume_arguments *arguments, const frame_cameras *frames,
                        const volume_painter *painter, const render_report *report) {
    text_file text;
    if (!text_file_open(session, &text, arguments->stats_path)) return false;
    const ewa_voxels_info *info = &painter->voxels;
    const ewa_volume_stats *stats = &painter->stats;
    const uint64_t drawn = stats->splat_count + stats->point_count;
    json_writer json;
    json_start(&json, text.file);
    json_text(&json, "version", ewa_version());
    json_text(&json, "input", arguments->frames.view.common.operands[0]);
    json_count(&json, "width", frames->cameras->width_px);
    json_count(&json, "height", frames->cameras->height_px);
    json_count(&json, "film_frame_count", frames->count);
    json_count(&json, "frame_count", frames->chosen_count);
    json_count(&json, "threads", ewa_context_worker_count(session->context));
    ewa_renderer_info renderer = {.struct_size = sizeof renderer};
    if (ewa_scene_renderer_describe(painter->renderer, &renderer) == EWA_OK) backend_write(&json, &renderer);
    json_count(&json, "voxels", info->voxel_count);
    json_count(&json, "voxels_occupied", info->occupied_count);
    json_count(&json, "blocks", info->block_count);
    json_count(&json, "blocks_skipped", info->skipped_count);
    json_count(&json, "resident_bytes", info->resident_bytes);
    json_count(&json, "voxels_culled", stats->culled_count);
    json_count(&json, "voxels_hidden", stats->hidden_count);
    json_count(&json, "voxels_near", stats->near_count);
    json_count(&json, "splats_drawn", stats->splat_count);
    json_count(&json, "points_drawn", stats->point_count);
    json_number(&json, "point_share", drawn ? (double)stats->point_count / (double)drawn : 0);
    json_object(&json, "wall_s");
    json_number(&json, "load", painter->load_s);
    json_number(&json, "classify", painter->classify_s);
    json_number(&json, "render", report->render_s);
    json_number(&json, "write", report->write_s);
    json_number(&json, "total", clock_now_s() - session->started_s);
    json_close(&json, '}');
    json_object(&json, "thread_s");
    json_number(&json, "bin", stats->bin_s);
    json_number(&json, "setup", stats->setup_s);
    json_number(&json, "points", stats->points_s);
    json_number(&json, "splats", stats->splats_s);
    json_number(&json, "resolve", stats->resolve_s);
    json_close(&json, '}');
    json_count(&json, "peak_memory_bytes", memory_peak_bytes());
    json_end(&json);
    return text_file_close(session, &text);
}

static int run(const void *data) {
    const volume_arguments *arguments = data;
    const common_arguments *common = &arguments->frames.view.common;
    cli_session session;
    if (!session_start(&session, common)) return session_end(&session, EXIT_FAILED);
    char message[OPTION_ERROR_BYTES];
    picture_paths paths;
    frame_cameras frames = {.count = 0};
    volume_painter painter = {.session = &session};
    render_report report = {.load_s = 0};
    const bool film = video_find_format(arguments->output) != NULL;
    bool done = frame_partition_check(&session, frames_many(&arguments->frames), film, true) &&
                parse_paths(arguments, &paths, message) &&
                frames_plan(&session, &arguments->frames, sequence_exists, &paths, &frames) &&
                frame_partition_choose(&session, &frames);
    const bool idle = done && !frames.chosen_count && !arguments->save_camera_path &&
                      !arguments->stats_path && !arguments->scene.save_transfer_path;
    done = done && !idle &&
           prepare(arguments, &frames, &painter) &&
           draw(arguments, &paths, &frames, &painter, &report) &&
           (!arguments->stats_path || !process_group_leads(session.group) ||
            write_stats(&session, arguments, &frames, &painter, &report));
    if (done && frames.chosen_count)
        session_say(&session, "%s: %llu of %llu voxels, drawn in %.1f ms, %.3f s in all", arguments->output,
                    (unsigned long long)painter.voxels.occupied_count, (unsigned long long)painter.voxels.voxel_count,
                    1e3 * report.render_s / (double)frames.chosen_count, clock_now_s() - session.started_s);
    ewa_scene_renderer_destroy(&painter.renderer);
    render_report_free(&report);
    const int ended = done || idle ? EXIT_DONE : frames.beyond ? EXIT_USAGE : EXIT_FAILED;
    frames_free(&frames);
    ewa_scene_destroy(&painter.scene);
    return session_end(&session, ended);
}

static const option_group output_options = OPTION_GROUP("Output", output_table);
static const option_group input_options = OPTION_GROUP("Raw volumes", input_table);
static const option_group voxel_options = OPTION_GROUP("Voxels", voxel_table);
static const option_group section_options = OPTION_GROUP("Section", section_table);
static const option_group look_options = OPTION_GROUP("Look", look_table);
static const option_group furniture_options = OPTION_GROUP("Over the picture", furniture_table);
const cli_command volume_command = {
    .name = "volume",
    .operands = "VOL -o OUT",
    .summary = "draw a volume: NRRD, NIfTI, MetaImage, VTK or raw numbers",
    .details =
        "Without --transfer, what surrounds is left out, and so is a container that stands around all that "
        "is denser; a material that hides others is drawn translucent, the densest is solid. --verbose and "
        "info say "
        "which values these are.\n"
        "\n"
        "The volume is framed whole. Where the file says how a patient lies, z is up and it is seen from "
        "the front, from -y: into the face; else what is up is measured by where matter ends (--verbose says it). A slice or a picture is seen upright, anything else from a "
        "corner. --azimuth, --elevation and --up start from the front. Raw numbers need --dims, or a "
        "name such as head_256x256x128_uint8.raw.gz.",
    .examples = "ewa volume head.nrrd -o head.png\n"
                "ewa volume ct.nii.gz -o bone.png --transfer bone --view left\n"
                "ewa volume engine.raw -o engine.png --dims 256,256,128 --azimuth 30 --elevation 20\n"
                "ewa volume head.mhd -o turn.mp4 --turntable 120 --transfer soft --size 800x800\n"
                "ewa volume fog.nrrd -o foggy.png --transfer fog --surfels bunny.ply\n",
    .low_operands = 1,
    .high_operands = 1,
    .groups = (const option_group *const[]){&output_options, &input_options, &view_options, &frames_options,
                                            &voxel_options, &section_options, &look_options,
                                            &furniture_options, NULL},
    .arguments_bytes = sizeof(volume_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
