// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa warp: pictures with depths to a new camera.
#include "cli/base/commands.h"
#include "cli/base/outputs.h"
#include "cli/input/camera_input.h"
#include "cli/input/warp_sources.h"
#include "cli/render/picture.h"
#include "cli/render/view.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct warp_arguments {
    source_arguments sources; // first: it begins with the common arguments
    const char *output, *aov, *hole_path, *save_camera_path, *camera_path;
    int64_t camera_index;
    option_vector shift;
    option_size size;
    int method;
    ewa_warp_options warp;
    ewa_render_options render;
    option_color background;
    int64_t quality; // of a JPEG; -1: not given
} warp_arguments;

#define AT(member)     offsetof(warp_arguments, member)
#define WARP(member)   OPTION_OF(ewa_warp_options, AT(warp), member)
#define RENDER(member) OPTION_OF(ewa_render_options, AT(render), member)

static const cli_option output_table[] = {
    {"output", OPTION_OUTPUT, AT(output), "FILE",
     .help =
         "the picture: .png or .jpg (8-bit sRGB), .exr (linear floats, premultiplied: R G B A Z N.X N.Y N.Z "
         "coverage), .pfm (linear RGB); -: PNG to standard output",
     .letter = 'o'},
    {"aov", OPTION_OUTPUTS, AT(aov), "NAME=FILE,...",
     .help = "further planes, .pfm or .exr: depth (camera z, infinite where nothing is), normal (world, "
             "towards the viewer), coverage (1: covered)"},
    PICTURE_QUALITY(AT(quality)),
    {"hole-mask", OPTION_OUTPUT, AT(hole_path), "FILE",
     .help = "a grey .png: white where less than half of a pixel is covered"},
    {"save-camera", OPTION_OUTPUT, AT(save_camera_path), "FILE", .help = "write the camera that was used"},
};

static const cli_option target_table[] = {
    {"camera", OPTION_TEXT, AT(camera_path), "FILE",
     .help = "the new camera; formats as --source-camera. Poses have the lens of the first pair",
     .absent = "auto: that of the first pair"},
    {"camera-index", OPTION_INTEGER, AT(camera_index), "N", "[0, 4294967295]",
     .help = "which camera of the file, counted from 0", .needs = "camera"},
    {"shift", OPTION_VECTOR, AT(shift), "x,y,z",
     .help = "moves the new camera so far to its right, down and ahead, in world units", .low = 3, .high = 3,
     .absent = "0,0,0"},
    {"size", OPTION_SIZE, AT(size), "WxH", .help = "scales the picture to so many pixels",
     .aliases = "resolution", .absent = "auto: the camera's"},
};

static const cli_option warp_table[] = {
    {"method", OPTION_CHOICE, AT(method), NULL, "hybrid|mcmillan",
     .help = "hybrid: splats of the size of their surroundings, filtered and blended; mcmillan: each sample "
             "to its nearest pixel"},
    {"radius", WARP(radius_spacings)},
    {"depth-jump", WARP(depth_jump)},
    {"depth-noise", WARP(depth_noise)},
    {"drop-flying", WARP(drop_flying)},
    {"near", WARP(nearest_world), .value = "Z"},
    {"far", WARP(farthest_world), .value = "Z"},
    {"cull", RENDER(cull), .help = "leave out samples that face away from the new camera"},
    {"cutoff", WARP(cutoff)},
    {"prefilter", RENDER(prefilter_px)},
    {"tolerance", RENDER(tolerance)},
    {"edge-aa", RENDER(edge_antialiasing)},
    {"tau", RENDER(edge_threshold)},
    {"background", OPTION_COLOR, AT(background), "r,g,b[,a]", .help = OPTION_COLOR_HELP,
     .aliases = "background-color"},
};

static void set_defaults(void *data) {
    warp_arguments *arguments = data;
    sources_set_defaults(&arguments->sources);
    ewa_warp_options_init(&arguments->warp, sizeof arguments->warp);
    ewa_warp_render_options_init(&arguments->render, sizeof arguments->render);
    arguments->method = EWA_WARP_HYBRID;
    arguments->background = (option_color){{0, 0, 0, 0}};
    arguments->quality = -1;
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const warp_arguments *arguments = data;
    picture_paths paths;
    const char *wrong = NULL;
    if (!arguments->output)
        wrong = "warp: no output; say -o FILE";
    else if (!arguments->camera_path && !arguments->shift.count)
        wrong = "warp: no new camera; say --camera FILE or --shift x,y,z";
    else if (arguments->warp.nearest_world >= arguments->warp.farthest_world)
        wrong = "--near has to be less than --far";
    else
        wrong = picture_check_quality(arguments->output, arguments->quality);
    return options_fine(wrong, message) && sources_check(&arguments->sources, message) &&
           (!arguments->hole_path ||
            output_check_suffix("hole-mask", arguments->hole_path, ".png|-", message)) &&
           picture_parse_paths(arguments->output, arguments->aov, &paths, message);
}

static bool make_target(cli_session *session, const warp_arguments *arguments, const ewa_camera *first,
                        ewa_camera *target) {
    *target = *first;
    if (arguments->camera_path &&
        !camera_input_load(session, arguments->camera_path, (uint32_t)arguments->camera_index, first, target))
        return false;
    double scale2 = 0; // camera space may be a scaled world
    for (int i = 0; i < 3; i++) scale2 += target->world_to_camera[i] * target->world_to_camera[i];
    for (int i = 0; i < 3 && arguments->shift.count; i++)
        target->world_to_camera[4 * i + 3] -= sqrt(scale2) * arguments->shift.values[i];
    view_resize(target, &arguments->size);
    return session_passed(session, ewa_camera_check(session->context, target));
}

/// Takes the samples; warns when there is none.
static bool take(cli_session *session, const warp_arguments *arguments, const warp_sources *sources,
                 ewa_warp *warp) {
    ewa_warp_facts facts;
    if (!session_passed(session,
                        ewa_warp_take(warp, sources->images, sources->count, &arguments->warp, &facts)))
        return false;
    if (facts.sample_count == 0) {
        session_fail(session, "%s: no pixel has a depth between %g and %g",
                     arguments->sources.common.operands[1], arguments->warp.nearest_world,
                     arguments->warp.farthest_world);
        return false;
    }
    session_say(session, "%llu of %llu pixels have a depth, %llu were dropped between surfaces; %.1f ms",
                (unsigned long long)facts.sample_count, (unsigned long long)facts.pixel_count,
                (unsigned long long)facts.flying_count, 1e3 * facts.take_s);
    return true;
}

/// Warns when nothing of the sources is in the picture; says how much is not.
static void report_holes(cli_session *session, const ewa_camera *target, const uint8_t *holes) {
    const size_t count = (size_t)target->width_px * target->height_px;
    size_t hole_count = 0;
    for (size_t i = 0; i < count; i++) hole_count += holes[i] > 0;
    if (hole_count == count)
        session_warn(session, "the new camera sees nothing of the pictures");
    else
        session_say(session, "holes: %.2f %% of the picture", 100 * (double)hole_count / (double)count);
}

static bool draw(cli_session *session, const warp_arguments *arguments, const picture_paths *paths,
                 const ewa_camera *target, ewa_warp *warp) {
    ewa_render_options options = arguments->render;
    option_color_linear(&arguments->background, options.background);
    const size_t pixel_count = (size_t)target->width_px * target->height_px;
    cli_picture picture;
    uint8_t *holes = malloc(pixel_count);
    bool done = picture_make(session, paths, target, &picture);
    if (done && !holes) {
        session_fail(session, "out of memory for %zu pixels", pixel_count);
        done = false;
    }
    if (done) {
        const double started_s = clock_now_s();
        const ewa_status status = ewa_warp_draw(warp, target, (ewa_warp_method)arguments->method, &options,
                                                &picture.frame, holes, NULL);
        if (status != EWA_OK) session_failed(session, status);
        done = status == EWA_OK;
        if (done)
            session_say(session, "%s: drawn in %.1f ms", paths->color, 1e3 * (clock_now_s() - started_s));
    }
    if (done) report_holes(session, target, holes);
    done = done && picture_save(session, paths, target, arguments->background.rgba[3] == 1, &picture);
    if (done && arguments->hole_path) {
        session->subject = arguments->hole_path;
        const ewa_status status = ewa_png_save(session->context, arguments->hole_path, target->width_px,
                                               target->height_px, 1, holes, target->width_px);
        if (status != EWA_OK) session_failed(session, status);
        done = status == EWA_OK;
    }
    if (done && arguments->save_camera_path) {
        session->subject = arguments->save_camera_path;
        const ewa_status status = ewa_camera_save(session->context, target, arguments->save_camera_path);
        if (status != EWA_OK) session_failed(session, status);
        done = status == EWA_OK;
    }
    picture_free(&picture);
    free(holes);
    return done;
}

static int run(const void *data) {
    const warp_arguments *arguments = data;
    cli_session session;
    if (!session_start(&session, &arguments->sources.common)) return session_end(&session, EXIT_FAILED);
    picture_paths paths;
    char message[OPTION_ERROR_BYTES];
    warp_sources sources = {.count = 0};
    ewa_camera target;
    ewa_warp *warp = NULL;
    bool done = picture_parse_paths(arguments->output, arguments->aov, &paths, message) &&
                sources_load(&session, &arguments->sources, &sources) &&
                make_target(&session, arguments, &sources.images[0].camera, &target);
    const ewa_status status = done ? ewa_warp_create(session.context, &warp) : EWA_OK;
    if (status != EWA_OK) session_failed(&session, status);
    done = done && status == EWA_OK && take(&session, arguments, &sources, warp);
    sources_free(&sources);
    paths.jpeg_quality = arguments->quality;
    done = done && draw(&session, arguments, &paths, &target, warp);
    ewa_warp_destroy(&warp);
    return session_end(&session, done ? EXIT_DONE : EXIT_FAILED);
}

static const option_group output_options = OPTION_GROUP("Output", output_table);
static const option_group target_options = OPTION_GROUP("New camera", target_table);
static const option_group warp_options = OPTION_GROUP("Warping", warp_table);
const cli_command warp_command = {
    .name = "warp",
    .operands = "COLOR DEPTH [COLOR DEPTH...] --camera FILE -o OUT",
    .summary = "draw pictures with depths as another camera sees them",
    .details =
        "COLOR is a picture, DEPTH one of the same size with a number for each pixel: PNG (grey, 8 or 16 "
        "bits), PFM or OpenEXR. 0, negative and infinite numbers, NaN and the largest of 16 bits mean that "
        "there is no depth; so do pixels of COLOR whose alpha is 0. Several pairs are drawn together.\n"
        "\n"
        "docs/warp.md says how it is done and how good it is.",
    .examples =
        "ewa warp color.png depth.png --source-camera camera.json --camera other.json -o warped.png\n"
        "ewa warp color.png depth.png --intrinsics 525,525,320,240 --shift 0.2,0,0 -o aside.png "
        "--hole-mask holes.png\n"
        "ewa warp a.jpg a.png b.jpg b.png --source-camera trajectory.log --intrinsics 525,525,320,240 "
        "--camera trajectory.log --camera-index 2 -o between.png\n"
        "ewa warp left.png disparity.pfm --intrinsics 994.978,994.978,311.193,254.877 --depth-is disparity "
        "--baseline 193.001 --disparity-offset 31.086 --shift 193,0,0 -o right.png\n",
    .low_operands = 2,
    .high_operands = 2 * WARP_MAX_SOURCES,
    .groups =
        (const option_group *const[]){&output_options, &source_options, &target_options, &warp_options, NULL},
    .arguments_bytes = sizeof(warp_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
