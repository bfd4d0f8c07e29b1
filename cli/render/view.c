// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where the camera stands: options, default views, framing.
#include "cli/render/view.h"
#include "cli/input/camera_input.h"

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
     .absent = "auto: from --fov", .excludes = "fov"},
    {"eye", OPTION_VECTOR, offsetof(view_arguments, eye), "x,y,z",
     .help = "position of the camera in the world", .aliases = "camera-position", .low = 3, .high = 3,
     .absent = "auto: so that all is in the picture", .excludes = "view azimuth elevation"},
    {"target", OPTION_VECTOR, offsetof(view_arguments, target), "x,y,z",
     .help = "point that the camera looks at", .aliases = "camera-focal-point", .low = 3, .high = 3,
     .absent = "auto: middle of the cloud"},
    {"up", OPTION_VECTOR, offsetof(view_arguments, up), "x,y,z|AXIS",
     .help = "direction that points up in the picture; or an axis: z, -y; what has y or z down is seen from the sides of what hangs", .aliases = "camera-view-up", .low = 3, .high = 3, .axes = true,
     .absent = "auto: 0,1,0 or 0,0,1, see above"},
    {"fov", OPTION_NUMBER, offsetof(view_arguments, fov_deg), "DEG", "(0, 180)",
     .help = "vertical field of view in degrees", .aliases = "camera-view-angle",
     .absent = "auto: 30, but for what a camera at the origin took", .excludes = "ortho"},
    {"ortho", OPTION_NUMBER, offsetof(view_arguments, ortho_height), "HEIGHT", "(0, inf)",
     .help = "orthographic camera that shows HEIGHT world units from bottom to top",
     .absent = "none: perspective"},
    {"view", OPTION_CHOICE, offsetof(view_arguments, view), NULL, "front|back|left|right|top|bottom|iso",
     .help = "side from which the cloud is seen, framed whole", .absent = "auto: see above"},
    {"azimuth", OPTION_NUMBER, offsetof(view_arguments, azimuth_deg), "DEG", "[-360, 360]",
     .help = "carries the camera about the up axis from there, counter-clockwise seen from above, in degrees",
     .aliases = "camera-azimuth-angle"},
    {"elevation", OPTION_NUMBER, offsetof(view_arguments, elevation_deg), "DEG", "[-180, 180]",
     .help = "then raises it by so many degrees", .aliases = "camera-elevation-angle"},
    {"size", OPTION_SIZE, offsetof(view_arguments, size), "WxH", .help = "pixels of the picture",
     .aliases = "resolution", .absent = "auto: the camera's, else 1280x720, of a window 1280x800"},
};

const option_group view_options = OPTION_GROUP("Camera", view_table);

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

/// The library's options of a camera.
static ewa_view_options options_of(const view_arguments *arguments, const ewa_scene *scene, bool turntable) {
    ewa_view_options options;
    ewa_view_options_init(&options, sizeof options);
    ewa_camera own; // has a size
    if (arguments->size.given || !scene || !ewa_scene_get_camera(scene, &own)) {
        options.width_px = arguments->size.width_px;
        options.height_px = arguments->size.height_px;
    }
    options.fov_deg = arguments->fov_deg;
    options.ortho_height_world = arguments->ortho_height;
    options.view = arguments->view;
    options.azimuth_deg = arguments->azimuth_deg;
    options.elevation_deg = arguments->elevation_deg;
    options.turntable = turntable;
    options.color_bar = arguments->color_bar;
    options.has_eye = arguments->eye.count;
    options.has_target = arguments->target.count;
    if (arguments->up.count) memcpy(options.up_world, arguments->up.values, sizeof options.up_world);
    memcpy(options.eye_world, arguments->eye.values, sizeof options.eye_world);
    memcpy(options.target_world, arguments->target.values, sizeof options.target_world);
    return options;
}

/// Has the library place a camera at what is looked at; `camera` NULL: only what is up and where the middle is.
static bool place(cli_session *session, const view_arguments *arguments, const view_subject *subject,
                  bool turntable, ewa_camera *camera, ewa_view_info *info) {
    const common_arguments *common = &arguments->common;
    const ewa_view_options options = options_of(arguments, subject->scene, turntable);
    return session_passed(
        session, subject->scene
                     ? ewa_scene_place_camera(subject->scene, &options, camera, info)
                     : ewa_cloud_place_camera(subject->cloud, subject->radius_scale,
                                              ewa_up_convention_of(common->operand_count, common->operands),
                                              EWA_UP_AUTO, &options, camera, info));
}

bool view_middle(cli_session *session, const view_arguments *arguments, const view_subject *subject,
                 double middle_world[3]) {
    ewa_view_info info;
    if (!place(session, arguments, subject, false, NULL, &info)) return false;
    memcpy(middle_world, info.pivot_world, sizeof info.pivot_world);
    return true;
}

void view_resize(ewa_camera *camera, const option_size *size) {
    if (size->given) ewa_camera_resize(camera, EWA_RESIZE_STRETCH, size->width_px, size->height_px);
}

/// Sets the picture's size and the projection that the options ask for.
static ewa_status set_lens(const view_arguments *arguments, ewa_camera *camera) {
    camera->width_px = arguments->size.width_px;
    camera->height_px = arguments->size.height_px;
    return arguments->ortho_height > 0
               ? ewa_camera_set_ortho(camera, arguments->ortho_height)
               : ewa_camera_set_fov(camera, arguments->fov_deg > 0 ? arguments->fov_deg : EWA_VIEW_FOV_DEG);
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
                     path, EWA_VIEW_FOV_DEG);
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
    return session_passed(session, ewa_camera_check(session->context, camera));
}

static view_turn turn_of(const ewa_view_info *info) {
    view_turn turn;
    memcpy(turn.pivot_world, info->pivot_world, sizeof turn.pivot_world);
    memcpy(turn.axis_world, info->up_world, sizeof turn.axis_world);
    return turn;
}

bool view_make(cli_session *session, const view_arguments *arguments, const view_subject *subject,
               ewa_camera *camera, view_turn *turn) {
    ewa_camera_init(camera);
    if (arguments->camera_path && !load_camera(session, arguments, camera)) return false;
    if (arguments->camera_path && !turn) return true;
    ewa_view_info info;
    if (!place(session, arguments, subject, turn != NULL, arguments->camera_path ? NULL : camera, &info))
        return false;
    if (turn) *turn = turn_of(&info);
    return true;
}

bool view_axis(cli_session *session, const view_arguments *arguments, const view_subject *subject,
               view_turn *turn) {
    ewa_view_info info;
    if (!place(session, arguments, subject, false, NULL, &info)) return false;
    *turn = turn_of(&info);
    return true;
}

bool view_make_panorama(cli_session *session, const view_arguments *arguments, const view_subject *subject,
                        ewa_panorama_options *panorama, ewa_camera *camera) {
    const ewa_view_options options = options_of(arguments, subject->scene, false);
    ewa_camera_init(camera);
    return session_passed(session, ewa_scene_place_panorama(subject->scene, &options, panorama, camera));
}
