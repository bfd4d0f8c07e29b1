// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where the camera stands: options, default views, framing.
#include "view.h"
#include "framing.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const cli_option view_table[] = {
    {.key = "camera",
     .kind = OPTION_TEXT,
     .offset = offsetof(view_arguments, camera_path),
     .value = "FILE",
     .help = "camera file: ours, Open3D, nerfstudio, INRIA (JSON), or the folder of a COLMAP model; with "
             "--size, its "
             "picture is scaled to that size"},
    {.key = "camera-index",
     .kind = OPTION_INTEGER,
     .offset = offsetof(view_arguments, camera_index),
     .value = "N",
     .range = "[0, 4294967295]",
     .help = "which camera of the file, counted from 0"},
    {.key = "eye",
     .aliases = "camera-position",
     .kind = OPTION_VECTOR,
     .offset = offsetof(view_arguments, eye),
     .value = "x,y,z",
     .low = 3,
     .high = 3,
     .absent = "so that all is in the picture",
     .help = "position of the camera in the world"},
    {.key = "target",
     .aliases = "camera-focal-point",
     .kind = OPTION_VECTOR,
     .offset = offsetof(view_arguments, target),
     .value = "x,y,z",
     .low = 3,
     .high = 3,
     .absent = "middle of the cloud",
     .help = "point that the camera looks at"},
    {.key = "up",
     .aliases = "camera-view-up",
     .kind = OPTION_VECTOR,
     .offset = offsetof(view_arguments, up),
     .value = "x,y,z",
     .low = 3,
     .high = 3,
     .absent = "0,1,0 or 0,0,1, see above",
     .help = "direction that points up in the picture"},
    {.key = "fov",
     .aliases = "camera-view-angle",
     .kind = OPTION_NUMBER,
     .offset = offsetof(view_arguments, fov_deg),
     .value = "DEG",
     .range = "(0, 180)",
     .help = "vertical field of view in degrees"},
    {.key = "ortho",
     .kind = OPTION_NUMBER,
     .offset = offsetof(view_arguments, ortho_height),
     .value = "HEIGHT",
     .range = "(0, inf)",
     .absent = "perspective",
     .help = "orthographic camera that shows HEIGHT world units from bottom to top"},
    {.key = "view",
     .kind = OPTION_CHOICE,
     .offset = offsetof(view_arguments, view),
     .range = "front|back|left|right|top|bottom|iso",
     .absent = "see above",
     .help = "side from which the cloud is seen, framed whole"},
    {.key = "size",
     .aliases = "resolution",
     .kind = OPTION_SIZE,
     .offset = offsetof(view_arguments, size),
     .value = "WxH",
     .help = "pixels of the picture"},
};

const option_group view_options = {"Camera", view_table, sizeof view_table / sizeof view_table[0]};

/// Height over width under which a cloud is ground, over which it stands upright; distance from the origin
/// over size from which coordinates are those of a map.
static const double FLAT_RATIO = 0.4, TALL_RATIO = 1.3, MAP_RATIO = 100;

/// Share of the surface that floors take up at least, and mean normal from which a scan is one-sided. Of
/// twelve scans, upright statues with y up have shares of 0.00 to 0.07 along z, one on a pedestal with z up
/// has 0.17.
static const double FLOOR_SHARE = 0.12, ONE_SIDED = 0.6;

enum { VIEW_FRONT, VIEW_BACK, VIEW_LEFT, VIEW_RIGHT, VIEW_TOP, VIEW_BOTTOM, VIEW_ISO };

void view_set_defaults(view_arguments *arguments) {
    arguments->fov_deg = 30;
    arguments->view = -1;
    arguments->size = (option_size){1280, 720, false};
}

bool view_check(const view_arguments *arguments, char message[OPTION_ERROR_BYTES]) {
    const bool placed = arguments->eye.count || arguments->target.count || arguments->up.count;
    const char *clash = NULL;
    if (arguments->camera_path && (placed || arguments->ortho_height > 0 || arguments->view >= 0))
        clash = "--camera excludes --eye, --target, --up, --ortho and --view";
    else if (!arguments->camera_path && arguments->camera_index > 0)
        clash = "--camera-index needs --camera";
    else if (arguments->eye.count && arguments->view >= 0)
        clash = "--eye and --view exclude each other";
    else if (arguments->up.count && !arguments->up.values[0] && !arguments->up.values[1] &&
             !arguments->up.values[2])
        clash = "--up: 0,0,0 has no direction";
    if (clash) snprintf(message, OPTION_ERROR_BYTES, "%s", clash);
    return !clash;
}

/// Which axis of the world is up; see the help of render.
static int guess_up_axis(const cloud_framing *framing) {
    const ewa_bounds *box = &framing->box;
    double extent[3], middle[3];
    for (int c = 0; c < 3; c++) {
        extent[c] = box->high_world[c] - box->low_world[c];
        middle[c] = 0.5 * (box->high_world[c] + box->low_world[c]);
    }
    const double narrow = fmin(extent[0], extent[1]), wide = fmax(extent[0], extent[1]);
    const bool flat = extent[2]<FLAT_RATIO * narrow, tall = extent[2]> TALL_RATIO * wide;
    const double away = fmax(fabs(middle[0]), fabs(middle[1]));
    const bool map = away > MAP_RATIO * fmax(wide, extent[2]);
    // Floors: much of the surface is level. A scan from one side is level towards its scanner instead.
    const double *facing = framing->facing;
    const bool floors = facing[2] > FLOOR_SHARE && facing[2] > 1.5 * facing[0] && facing[2] > 2 * facing[1] &&
                        framing->one_sided < ONE_SIDED;
    return wide > 0 && (flat || tall || map || floors) ? 2 : 1;
}

/// Direction from the eye to the middle for a named view with y (1) or z (2) up.
static void view_direction(int view, int up_axis, double direction[3]) {
    // Written for z up, from the front at -y; y up is the same turned about x.
    static const double directions[][3] = {{0, 1, 0},  {0, -1, 0}, {1, 0, 0},          {-1, 0, 0},
                                           {0, 0, -1}, {0, 0, 1},  {-0.55, 0.7, -0.45}};
    const double *d = directions[view];
    direction[0] = d[0];
    direction[1] = up_axis == 2 ? d[1] : d[2];
    direction[2] = up_axis == 2 ? d[2] : -d[1];
}

/// The up vector and, for a camera without --eye, the direction in which it looks.
static void choose_direction(const view_arguments *arguments, const cloud_framing *framing,
                             double direction[3], double up_world[3]) {
    const ewa_bounds *box = &framing->box;
    int up_axis = guess_up_axis(framing);
    if (arguments->up.count) {
        memcpy(up_world, arguments->up.values, 3 * sizeof *up_world);
        up_axis = fabs(up_world[2]) > fabs(up_world[1]) ? 2 : 1;
    } else {
        for (int c = 0; c < 3; c++) up_world[c] = c == up_axis;
    }
    const double height = box->high_world[up_axis] - box->low_world[up_axis];
    const int side = up_axis == 2 ? 1 : 2;
    const double across =
        fmin(box->high_world[0] - box->low_world[0], box->high_world[side] - box->low_world[side]);
    const bool ground = height < FLAT_RATIO * across;
    const int view = arguments->view >= 0 ? arguments->view : ground ? VIEW_ISO : VIEW_FRONT;
    view_direction(view, up_axis, direction);
    const bool along_up = view == VIEW_TOP || view == VIEW_BOTTOM;
    if (along_up && !arguments->up.count) {
        // Seen from above, the back is up in the picture; from below, the front.
        double ahead[3];
        view_direction(view == VIEW_TOP ? VIEW_FRONT : VIEW_BACK, up_axis, ahead);
        memcpy(up_world, ahead, sizeof ahead);
    }
}

/// Scales a camera's picture to another size.
static void resize_camera(ewa_camera *camera, const option_size *size) {
    const double x = (double)size->width_px / camera->width_px,
                 y = (double)size->height_px / camera->height_px;
    camera->fx_px *= x;
    camera->cx_px *= x;
    camera->fy_px *= y;
    camera->cy_px *= y;
    camera->width_px = size->width_px;
    camera->height_px = size->height_px;
}

static bool load_camera(cli_session *session, const view_arguments *arguments, ewa_camera *camera) {
    session->subject = arguments->camera_path;
    ewa_status status =
        ewa_camera_load(session->context, arguments->camera_path, (uint32_t)arguments->camera_index, camera);
    if (status == EWA_OK && arguments->size.given) resize_camera(camera, &arguments->size);
    if (status == EWA_OK) status = ewa_camera_check(session->context, camera);
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

/// Places a camera whose picture and projection are set.
static ewa_status place_camera(cli_session *session, const view_arguments *arguments,
                               const cloud_framing *framing, ewa_camera *camera) {
    double direction[3], up_world[3];
    choose_direction(arguments, framing, direction, up_world);
    const option_vector *eye = &arguments->eye, *target = &arguments->target;
    if (eye->count) {
        const double *target_world = target->count ? target->values : framing->middle_world;
        const ewa_status status = ewa_camera_look_at(camera, eye->values, target_world, up_world);
        if (status != EWA_OK)
            session_fail(session, "--eye: %g,%g,%g is also where the camera looks", eye->values[0],
                         eye->values[1], eye->values[2]);
        return status;
    }
    if (framing->trimmed)
        session_note(session,
                     "a few points lie far off and are left outside the picture; --eye decides otherwise");
    ewa_status status = framing_fit(framing, direction, up_world, camera);
    if (status == EWA_OK && target->count)
        status = aim_at(camera, direction, framing->middle_world, target->values, up_world);
    if (status == EWA_OK && arguments->ortho_height > 0)
        status = ewa_camera_set_ortho(camera, arguments->ortho_height);
    return status;
}

bool view_make(cli_session *session, const view_arguments *arguments, const ewa_cloud *cloud,
               double radius_scale, ewa_camera *camera) {
    ewa_camera_init(camera, sizeof *camera);
    if (arguments->camera_path) return load_camera(session, arguments, camera);
    camera->width_px = arguments->size.width_px;
    camera->height_px = arguments->size.height_px;
    cloud_framing framing;
    bool done = framing_make(session, cloud, radius_scale, &framing);
    if (done) {
        ewa_status status = arguments->ortho_height > 0
                                ? ewa_camera_set_ortho(camera, arguments->ortho_height)
                                : ewa_camera_set_fov(camera, arguments->fov_deg);
        if (status == EWA_OK) status = place_camera(session, arguments, &framing, camera);
        done = status == EWA_OK;
        if (!done) session_failed(session, status);
    }
    framing_free(&framing);
    return done;
}
