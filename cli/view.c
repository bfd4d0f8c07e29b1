// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where the camera stands: options, default views, framing.
#include "view.h"
#include "camera_input.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const cli_option view_table[] = {
    {"camera", OPTION_TEXT, offsetof(view_arguments, camera_path), "FILE",
     .help = "camera file: ours, Open3D, nerfstudio, INRIA (JSON), or the folder of a COLMAP model, whose "
             "picture --size scales; or poses as text (.txt, .log, .tum: 4 x 4 matrices or TUM's lines, "
             "camera to world), which get their lens from --intrinsics or --fov",
     .excludes = "eye target up ortho view azimuth elevation"},
    {"camera-index", OPTION_INTEGER, offsetof(view_arguments, camera_index), "N", "[0, 4294967295]",
     .help = "which camera of the file, counted from 0", .needs = "camera"},
    {"intrinsics", OPTION_TEXT, offsetof(view_arguments, intrinsics), "fx,fy,cx,cy|FILE",
     .help = "lens of poses: focal lengths and principal point in pixels of a picture of --size, pixel "
             "centres at halves; or a file with a lens, such as Open3D's",
     .absent = "from --fov", .excludes = "fov"},
    {"eye", OPTION_VECTOR, offsetof(view_arguments, eye), "x,y,z",
     .help = "position of the camera in the world", .aliases = "camera-position", .low = 3, .high = 3,
     .absent = "so that all is in the picture", .excludes = "view azimuth elevation"},
    {"target", OPTION_VECTOR, offsetof(view_arguments, target), "x,y,z",
     .help = "point that the camera looks at", .aliases = "camera-focal-point", .low = 3, .high = 3,
     .absent = "middle of the cloud"},
    {"up", OPTION_VECTOR, offsetof(view_arguments, up), "x,y,z",
     .help = "direction that points up in the picture", .aliases = "camera-view-up", .low = 3, .high = 3,
     .absent = "0,1,0 or 0,0,1, see above"},
    {"fov", OPTION_NUMBER, offsetof(view_arguments, fov_deg), "DEG", "(0, 180)",
     .help = "vertical field of view in degrees", .aliases = "camera-view-angle", .absent = "30",
     .excludes = "ortho"},
    {"ortho", OPTION_NUMBER, offsetof(view_arguments, ortho_height), "HEIGHT", "(0, inf)",
     .help = "orthographic camera that shows HEIGHT world units from bottom to top", .absent = "perspective"},
    {"view", OPTION_CHOICE, offsetof(view_arguments, view), NULL, "front|back|left|right|top|bottom|iso",
     .help = "side from which the cloud is seen, framed whole", .absent = "see above"},
    {"azimuth", OPTION_NUMBER, offsetof(view_arguments, azimuth_deg), "DEG", "[-360, 360]",
     .help = "carries the camera about the up axis from there, counter-clockwise seen from above, in degrees",
     .aliases = "camera-azimuth-angle"},
    {"elevation", OPTION_NUMBER, offsetof(view_arguments, elevation_deg), "DEG", "[-180, 180]",
     .help = "then raises it by so many degrees", .aliases = "camera-elevation-angle"},
    {"size", OPTION_SIZE, offsetof(view_arguments, size), "WxH", .help = "pixels of the picture",
     .aliases = "resolution"},
};

const option_group view_options = OPTION_GROUP("Camera", view_table);

/// Where neither --fov nor --ortho says.
static const double DEFAULT_FOV_DEG = 30;

void view_set_defaults(view_arguments *arguments) {
    arguments->view = -1;
    arguments->size = (option_size){1280, 720, false};
}

bool view_check(const view_arguments *arguments, bool poses, char message[OPTION_ERROR_BYTES]) {
    const option_vector *up = &arguments->up;
    poses = poses || (arguments->camera_path && camera_input_is_poses(arguments->camera_path));
    const char *clash = NULL;
    if (arguments->camera_path && !poses && arguments->fov_deg > 0)
        clash =
            "--camera and --fov exclude each other, but for poses (.txt, .log, .tum): the file has a lens";
    else if (arguments->intrinsics && !poses)
        clash = "--intrinsics is the lens of poses (.txt, .log, .tum)";
    else if (up->count && !up->values[0] && !up->values[1] && !up->values[2])
        clash = "--up: 0,0,0 has no direction";
    return options_fine(clash, message) && camera_input_check_lens(arguments->intrinsics, message);
}

bool view_is_placed(const view_arguments *arguments) {
    return arguments->camera_path || arguments->eye.count || arguments->target.count || arguments->up.count ||
           arguments->fov_deg > 0 || arguments->ortho_height > 0 || arguments->view >= 0 ||
           arguments->azimuth_deg != 0 || arguments->elevation_deg != 0;
}

/// What is up and how it is looked at, as far as the options do not say.
static ewa_upright choose_upright(const view_arguments *arguments, const ewa_framing *framing) {
    const common_arguments *common = &arguments->common;
    const option_vector *up = &arguments->up;
    if (!up->count && !arguments->up_axis) {
        ewa_upright chosen;
        ewa_framing_choose(framing, ewa_up_convention_of(common->operand_count, common->operands), &chosen);
        return chosen;
    }
    ewa_framing_info info;
    ewa_framing_describe(framing, &info);
    const double *low = info.box.low_world, *high = info.box.high_world;
    const double extent[3] = {high[0] - low[0], high[1] - low[1], high[2] - low[2]};
    const int axis = !up->count ? abs(arguments->up_axis) : fabs(up->values[2]) > fabs(up->values[1]) ? 2 : 1;
    return (ewa_upright){.axis = axis,
                         .reversed = !up->count && arguments->up_axis < 0,
                         .view = ewa_upright_view(extent, axis),
                         .why = up->count ? "as it was asked for" : "as files of this kind have it"};
}

/// What the directions of a view come from.
typedef struct view_frame {
    double direction[3];  ///< in which the camera looks
    double up_world[3];   ///< of the picture
    double axis_world[3]; ///< of a turntable
    bool from_origin;     ///< the eye belongs at the origin
} view_frame;

/// The up vector of the picture, the axis of a turntable and, for a camera without --eye, the direction in
/// which it looks.
static ewa_status choose_direction(cli_session *session, const view_arguments *arguments,
                                   const ewa_framing *framing, view_frame *frame) {
    ewa_upright chosen = choose_upright(arguments, framing);
    const option_vector *up = &arguments->up;
    const bool turned = arguments->azimuth_deg != 0 || arguments->elevation_deg != 0;
    chosen.from_origin = chosen.from_origin && arguments->view < 0 && !turned;
    if (arguments->view >= 0) chosen.view = (ewa_named_view)arguments->view;
    char text[EWA_UPRIGHT_TEXT_BYTES];
    ewa_upright_describe(&chosen, text);
    if (!arguments->camera_path) session_say(session, "up: %s", text);
    frame->from_origin = chosen.from_origin;
    ewa_upright_look(&chosen, frame->direction, frame->up_world);
    for (int c = 0; c < 3; c++) {
        const double sign = chosen.reversed ? -1 : 1;
        frame->axis_world[c] = up->count ? up->values[c] : c == chosen.axis ? sign : 0;
    }
    if (up->count) memcpy(frame->up_world, up->values, sizeof frame->up_world);
    return !turned ? EWA_OK
                   : ewa_upright_turn(frame->axis_world, arguments->azimuth_deg, arguments->elevation_deg,
                                      frame->direction, frame->up_world);
}

bool view_default(cli_session *session, const char *path, const ewa_cloud *cloud, int up_axis,
                  ewa_upright *chosen) {
    const view_arguments arguments = {
        .common = {.operands = &path, .operand_count = 1}, .view = -1, .up_axis = up_axis};
    ewa_framing *framing = NULL;
    const ewa_status status = ewa_framing_create(cloud, 1, &framing);
    if (status == EWA_OK)
        *chosen = choose_upright(&arguments, framing);
    else
        session_failed(session, status);
    ewa_framing_destroy(&framing);
    return status == EWA_OK;
}

void view_resize(ewa_camera *camera, const option_size *size) {
    if (!size->given) return;
    const double x = (double)size->width_px / camera->width_px,
                 y = (double)size->height_px / camera->height_px;
    camera->fx_px *= x;
    camera->cx_px *= x;
    camera->fy_px *= y;
    camera->cy_px *= y;
    camera->width_px = size->width_px;
    camera->height_px = size->height_px;
}

/// Sets the picture's size and the projection that the options ask for.
static ewa_status set_lens(const view_arguments *arguments, ewa_camera *camera) {
    camera->width_px = arguments->size.width_px;
    camera->height_px = arguments->size.height_px;
    return arguments->ortho_height > 0
               ? ewa_camera_set_ortho(camera, arguments->ortho_height)
               : ewa_camera_set_fov(camera, arguments->fov_deg > 0 ? arguments->fov_deg : DEFAULT_FOV_DEG);
}

bool view_load_lens(cli_session *session, const view_arguments *arguments, const char *path,
                    ewa_camera *lens) {
    session->subject = NULL;
    ewa_camera_init(lens);
    const ewa_status status = set_lens(arguments, lens);
    if (status != EWA_OK) session_failed(session, status);
    if (status != EWA_OK || !camera_input_is_poses(path)) return status == EWA_OK;
    if (arguments->intrinsics) {
        if (!camera_input_load_lens(session, arguments->intrinsics, lens)) return false;
        view_resize(lens, &arguments->size);
    } else if (!(arguments->fov_deg > 0)) {
        session_note(session,
                     "%s: poses have no lens: drawn with --fov %g; that or --intrinsics fx,fy,cx,cy says "
                     "otherwise",
                     path, DEFAULT_FOV_DEG);
    }
    return true;
}

static bool load_camera(cli_session *session, const view_arguments *arguments, ewa_camera *camera) {
    const char *path = arguments->camera_path;
    ewa_camera lens;
    if (!view_load_lens(session, arguments, path, &lens) ||
        !camera_input_load(session, path, (uint32_t)arguments->camera_index, &lens, camera))
        return false;
    session->subject = path;
    view_resize(camera, &arguments->size);
    const ewa_status status = ewa_camera_check(session->context, camera);
    if (status != EWA_OK) session_failed(session, status);
    return status == EWA_OK;
}

/// Moves the camera sideways so that it looks at `target_world` from the same distance.
static ewa_status aim_at(ewa_camera *camera, const double direction[3], const double middle_world[3],
                         const double target_world[3], const double up_world[3]) {
    double eye_world[3], aimed_world[3], distance = 0, length = 0;
    ewa_camera_eye(camera, eye_world);
    for (int c = 0; c < 3; c++) {
        distance += (middle_world[c] - eye_world[c]) * (middle_world[c] - eye_world[c]);
        length += direction[c] * direction[c];
    }
    for (int c = 0; c < 3; c++) aimed_world[c] = target_world[c] - direction[c] * sqrt(distance / length);
    return ewa_camera_look_at(camera, aimed_world, target_world, up_world);
}

/// Places a camera whose picture and projection are set. With `turn`, whose pivot is set, the cloud is framed
/// in all its turns.
static ewa_status place_camera(cli_session *session, const view_arguments *arguments,
                               const ewa_framing *framing, ewa_camera *camera, view_turn *turn) {
    view_frame frame;
    ewa_framing_info info;
    ewa_framing_describe(framing, &info);
    ewa_status status = choose_direction(session, arguments, framing, &frame);
    if (status != EWA_OK) return status;
    const double *direction = frame.direction, *up_world = frame.up_world;
    if (turn) memcpy(turn->axis_world, frame.axis_world, sizeof turn->axis_world);
    const option_vector *eye = &arguments->eye, *target = &arguments->target;
    if (eye->count) {
        const double *target_world = target->count ? target->values : info.middle_world;
        status = ewa_camera_look_at(camera, eye->values, target_world, up_world);
        if (status != EWA_OK)
            session_fail(session, "--eye: %g,%g,%g is also where the camera looks", eye->values[0],
                         eye->values[1], eye->values[2]);
        return status;
    }
    if (info.trimmed)
        session_note(session,
                     "a few points lie far off and are left outside the picture; --eye decides otherwise");
    if (turn) {
        ewa_framing *solid = NULL;
        status = ewa_framing_revolve(framing, turn->pivot_world, frame.axis_world, direction, &solid);
        if (status == EWA_OK) status = ewa_framing_fit(solid, direction, up_world, camera);
        ewa_framing_destroy(&solid);
    } else if (frame.from_origin && !target->count && !(arguments->fov_deg > 0) &&
               !(arguments->ortho_height > 0)) {
        static const double origin[3] = {0, 0, 0};
        return ewa_framing_zoom(framing, origin, up_world, camera);
    } else {
        status = ewa_framing_fit(framing, direction, up_world, camera);
        if (status == EWA_OK && target->count)
            status = aim_at(camera, direction, info.middle_world, target->values, up_world);
    }
    if (status == EWA_OK && arguments->ortho_height > 0)
        status = ewa_camera_set_ortho(camera, arguments->ortho_height);
    return status;
}

bool view_make(cli_session *session, const view_arguments *arguments, const ewa_cloud *cloud,
               double radius_scale, ewa_camera *camera, view_turn *turn) {
    ewa_camera_init(camera);
    if (arguments->camera_path && !load_camera(session, arguments, camera)) return false;
    if (arguments->camera_path && !turn) return true;
    ewa_framing *framing = NULL;
    ewa_status status = ewa_framing_create(cloud, radius_scale, &framing);
    if (status != EWA_OK) return session_failed(session, status) == EXIT_DONE;
    if (turn) {
        ewa_framing_info info;
        ewa_framing_describe(framing, &info);
        memcpy(turn->pivot_world, arguments->target.count ? arguments->target.values : info.middle_world,
               sizeof turn->pivot_world);
    }
    if (arguments->camera_path) {
        view_frame frame;
        status = choose_direction(session, arguments, framing, &frame);
        memcpy(turn->axis_world, frame.axis_world, sizeof turn->axis_world);
    } else {
        status = set_lens(arguments, camera);
        if (status == EWA_OK) status = place_camera(session, arguments, framing, camera, turn);
    }
    if (status == EWA_ERROR_NUMERIC && !session->reported)
        session_fail(session, "no camera can be placed: the numbers of its options are too large");
    else if (status != EWA_OK)
        session_failed(session, status);
    ewa_framing_destroy(&framing);
    return status == EWA_OK;
}
