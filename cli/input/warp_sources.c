// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pairs of pictures and depths with their cameras.
#include "cli/input/warp_sources.h"
#include "cli/input/camera_input.h"

#include <stdio.h>
#include <string.h>

enum { MAX_PATH = 1024 };

#define AT(member) offsetof(source_arguments, member)

static const cli_option source_table[] = {
    {"source-camera", OPTION_TEXT, AT(camera_paths), "FILE[,FILE...]",
     .help = "cameras of the pictures: one file for each pair, or one file with a camera for each; formats "
             "as --camera of render, or poses as text (.txt, .log, .tum: 4 x 4 matrices or TUM's lines, "
             "camera to world), which need --intrinsics",
     .absent = "none: at the origin, looking along +z"},
    {"source-index", OPTION_VECTOR, AT(camera_indices), "N[,N...]", "[0, 4294967295]",
     .help = "which camera of its file each pair has, counted from 0", .low = 1, .high = OPTION_VECTOR_MAX,
     .absent = "auto: 0,1,2,... of one file, 0 of each of several", .needs = "source-camera"},
    {"intrinsics", OPTION_TEXT, AT(intrinsics), "fx,fy,cx,cy|FILE",
     .help = "focal lengths and principal point in pixels, for poses, pixel centres at halves: where they "
             "count as whole numbers, as in OpenCV and TUM's files, add 0.5 to cx and cy; or a file with a "
             "lens, such as Open3D's",
     .absent = "auto: those of --source-camera"},
    {"depth-is", OPTION_CHOICE, AT(depth_kind), NULL, "z|ray|disparity",
     .help = "what the numbers are: depth along the view, distance to the eye, or a shift in pixels"},
    {"depth-scale", OPTION_NUMBER, AT(depth_scale), "S", "[0, 1000000000]",
     .help = "numbers per unit: 1000 for millimetres in metres, 5000 for TUM's files",
     .absent = "auto: 1000 for PNG, else 1"},
    {"baseline", OPTION_NUMBER, AT(baseline_world), "B", "[0, 1000000000]",
     .help = "with --depth-is disparity: distance of the two eyes; z = fx B / (disparity + offset)",
     .absent = "none"},
    {"disparity-offset", OPTION_NUMBER, AT(disparity_offset_px), "PX", "[-1000000, 1000000]",
     .help = "with --depth-is disparity: difference of the two principal points"},
};

const option_group source_options = OPTION_GROUP("Sources", source_table);

void sources_set_defaults(source_arguments *arguments) { arguments->depth_kind = EWA_DEPTH_Z; }

/// Copies path `index` of a list with commas; false when there is none or it is too long.
static bool path_at(const char *list, size_t index, char path[MAX_PATH]) {
    for (; index > 0; index--) {
        list = strchr(list, ',');
        if (!list) return false;
        list++;
    }
    const size_t length = strcspn(list, ",");
    if (length == 0 || length >= MAX_PATH) return false;
    memcpy(path, list, length);
    path[length] = 0;
    return true;
}

static size_t path_count(const char *list) {
    size_t count = 1;
    for (; *list; list++) count += *list == ',';
    return count;
}

/// Whether cameras come without lenses; says in `wrong` which name is no file's.
static bool needs_lens(const char *camera_paths, const char **wrong) {
    bool poses = !camera_paths;
    char path[MAX_PATH];
    for (size_t i = 0; camera_paths && i < path_count(camera_paths); i++) {
        if (path_at(camera_paths, i, path))
            poses |= camera_input_is_poses(path);
        else
            *wrong = "--source-camera: an empty or overlong name";
    }
    return poses;
}

/// What is wrong with the cameras; NULL: nothing.
static const char *check_cameras(const source_arguments *arguments) {
    const size_t pairs = arguments->common.operand_count / 2;
    const size_t files = arguments->camera_paths ? path_count(arguments->camera_paths) : 0;
    const char *wrong = NULL;
    const bool no_lens = needs_lens(arguments->camera_paths, &wrong);
    if (wrong) return wrong;
    if (files > 1 && files != pairs) return "--source-camera: neither one file nor one for each pair";
    if (!files && pairs > 1) return "--source-camera: several pairs need cameras";
    if (arguments->camera_indices.count && arguments->camera_indices.count != pairs)
        return "--source-index: one number for each pair";
    if (no_lens && !arguments->intrinsics)
        return "--intrinsics fx,fy,cx,cy: needed without a camera file, and with poses";
    return !no_lens && arguments->intrinsics ? "--intrinsics: the camera file has them" : NULL;
}

bool sources_check(const source_arguments *arguments, char message[OPTION_ERROR_BYTES]) {
    const bool disparity = arguments->depth_kind == EWA_DEPTH_DISPARITY;
    const char *wrong;
    if (arguments->common.operand_count % 2)
        wrong = "warp: pictures and depths come in pairs: COLOR DEPTH";
    else if (disparity && !(arguments->baseline_world > 0))
        wrong = "--depth-is disparity needs --baseline";
    else if (!disparity && (arguments->baseline_world > 0 || arguments->disparity_offset_px != 0))
        wrong = "--baseline and --disparity-offset need --depth-is disparity";
    else
        wrong = check_cameras(arguments);
    return options_fine(wrong, message) && camera_input_check_lens(arguments->intrinsics, message);
}

/// Makes the camera of a pair. Returns false after reporting.
static bool load_camera(cli_session *session, const source_arguments *arguments, uint32_t pair,
                        const ewa_camera *lens, ewa_camera *camera) {
    *camera = *lens;
    if (!arguments->camera_paths) return true;
    char path[MAX_PATH];
    const bool one_file = path_count(arguments->camera_paths) == 1;
    path_at(arguments->camera_paths, one_file ? 0 : pair, path);
    uint32_t index = one_file ? pair : 0;
    if (arguments->camera_indices.count) index = (uint32_t)arguments->camera_indices.values[pair];
    if (!camera_input_load(session, path, index, lens, camera)) return false;
    if (camera->width_px == lens->width_px && camera->height_px == lens->height_px) return true;
    session_fail(session, "%s: camera %u is for pictures of %u x %u pixels, %s has %u x %u", path, index,
                 camera->width_px, camera->height_px, arguments->common.operands[2 * pair + 1],
                 lens->width_px, lens->height_px);
    return false;
}

/// Sets a camera of the size of a depth image, with the lens of --intrinsics. Returns false after reporting.
static bool load_lens(cli_session *session, const source_arguments *arguments, const char *depth_path,
                      const ewa_image *depth, ewa_camera *lens) {
    ewa_camera_init(lens);
    lens->width_px = depth->width_px;
    lens->height_px = depth->height_px;
    if (!arguments->intrinsics) return true;
    if (!camera_input_load_lens(session, arguments->intrinsics, lens)) return false;
    if (lens->width_px == depth->width_px && lens->height_px == depth->height_px) return true;
    session_fail(session, "%s: the lens is for pictures of %u x %u pixels, %s has %u x %u",
                 arguments->intrinsics, lens->width_px, lens->height_px, depth_path, depth->width_px,
                 depth->height_px);
    return false;
}

static bool load_pair(cli_session *session, const source_arguments *arguments, uint32_t pair,
                      warp_sources *sources) {
    const char *color_path = arguments->common.operands[2 * pair],
               *depth_path = arguments->common.operands[2 * pair + 1];
    ewa_image *color = &sources->colors[pair], *depth = &sources->depths[pair];
    session->subject = color_path;
    ewa_status status = ewa_image_load(session->context, color_path, color);
    if (status == EWA_OK) {
        session->subject = depth_path;
        status = ewa_depth_load(session->context, depth_path, depth);
    }
    if (!session_passed(session, status)) return false;
    if (color->width_px != depth->width_px || color->height_px != depth->height_px) {
        session_fail(session, "%s has %u x %u pixels, %s has %u x %u", color_path, color->width_px,
                     color->height_px, depth_path, depth->width_px, depth->height_px);
        return false;
    }
    if (color->channel_count != 1 && color->channel_count != 3 && color->channel_count != 4) {
        session_fail(session, "%s: a picture of %u channels; colours are 1, 3 or 4", color_path,
                     color->channel_count);
        return false;
    }
    const double standard = ewa_depth_file_scale(depth_path, (ewa_depth_kind)arguments->depth_kind);
    if (standard != 1 && arguments->depth_scale == 0 && pair == 0)
        session_note(session, "%s: depths are taken as 1/%g units; --depth-scale says otherwise", depth_path,
                     standard);
    ewa_depth_image *image = &sources->images[pair];
    ewa_depth_image_init(image);
    image->depth = depth->pixels;
    image->depth_type = EWA_F32;
    image->kind = (ewa_depth_kind)arguments->depth_kind;
    image->depth_scale = arguments->depth_scale > 0 ? arguments->depth_scale : standard;
    image->baseline_world = arguments->baseline_world;
    image->disparity_offset_px = arguments->disparity_offset_px;
    image->color = color->pixels;
    image->color_type = EWA_F32;
    image->color_channel_count = color->channel_count;
    ewa_camera lens;
    return load_lens(session, arguments, depth_path, depth, &lens) &&
           load_camera(session, arguments, pair, &lens, &image->camera);
}

bool sources_load(cli_session *session, const source_arguments *arguments, warp_sources *sources) {
    *sources = (warp_sources){.count = (uint32_t)(arguments->common.operand_count / 2)};
    for (uint32_t i = 0; i < sources->count; i++)
        if (!load_pair(session, arguments, i, sources)) return false;
    session->subject = NULL;
    return true;
}

void sources_free(warp_sources *sources) {
    for (uint32_t i = 0; i < sources->count; i++) {
        ewa_image_free(&sources->colors[i]);
        ewa_image_free(&sources->depths[i]);
    }
    *sources = (warp_sources){.count = 0};
}
