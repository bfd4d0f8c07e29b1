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
    {.key = "azimuth",
     .aliases = "camera-azimuth-angle",
     .kind = OPTION_NUMBER,
     .offset = offsetof(view_arguments, azimuth_deg),
     .value = "DEG",
     .range = "[-360, 360]",
     .help =
         "carries the camera about the up axis from there, counter-clockwise seen from above, in degrees"},
    {.key = "elevation",
     .aliases = "camera-elevation-angle",
     .kind = OPTION_NUMBER,
     .offset = offsetof(view_arguments, elevation_deg),
     .value = "DEG",
     .range = "[-180, 180]",
     .help = "then raises it by so many degrees"},
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
    const bool turned = arguments->azimuth_deg != 0 || arguments->elevation_deg != 0;
    const char *clash = NULL;
    if (arguments->camera_path && (placed || arguments->ortho_height > 0 || arguments->view >= 0))
        clash = "--camera excludes --eye, --target, --up, --ortho and --view";
    else if (!arguments->camera_path && arguments->camera_index > 0)
        clash = "--camera-index needs --camera";
    else if (arguments->eye.count && arguments->view >= 0)
        clash = "--eye and --view exclude each other";
    else if (turned && (arguments->eye.count || arguments->camera_path))
        clash = "--azimuth and --elevation exclude --eye and --camera";
    else if (arguments->up.count && !arguments->up.values[0] && !arguments->up.values[1] &&
             !arguments->up.values[2])
        clash = "--up: 0,0,0 has no direction";
    if (clash) snprintf(message, OPTION_ERROR_BYTES, "%s", clash);
    return !clash;
}

bool view_is_placed(const view_arguments *arguments) {
    return arguments->camera_path || arguments->camera_index > 0 || arguments->eye.count ||
           arguments->target.count || arguments->up.count || arguments->ortho_height > 0 ||
           arguments->view >= 0 || arguments->azimuth_deg != 0 || arguments->elevation_deg != 0;
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

/// Carries a direction, seen as that of a camera that looks at the origin, by --azimuth and --elevation. Its
/// up goes along, so that nothing flips at the poles.
static void turn_direction(const view_arguments *arguments, const double axis_world[3], double direction[3],
                           double up_world[3]) {
    static const double origin[3] = {0, 0, 0};
    ewa_camera camera;
    ewa_camera_init(&camera, sizeof camera);
    ewa_camera_look_at(&camera, origin, direction, up_world);
    ewa_camera_orbit(&camera, origin, axis_world, arguments->azimuth_deg);
    const double *m = camera.world_to_camera, right[3] = {m[0], m[1], m[2]};
    ewa_camera_orbit(&camera, origin, right, -arguments->elevation_deg);
    for (int c = 0; c < 3; c++) {
        up_world[c] = -m[4 + c];
        direction[c] = m[8 + c];
    }
}

/// The up vector of the picture, the axis of a turntable and, for a camera without --eye, the direction in
/// which it looks.
static void choose_direction(const view_arguments *arguments, const cloud_framing *framing,
                             double direction[3], double up_world[3], double axis_world[3]) {
    const ewa_bounds *box = &framing->box;
    int up_axis = arguments->up_axis ? arguments->up_axis : guess_up_axis(framing);
    if (arguments->up.count) {
        memcpy(up_world, arguments->up.values, 3 * sizeof *up_world);
        up_axis = fabs(up_world[2]) > fabs(up_world[1]) ? 2 : 1;
    } else {
        for (int c = 0; c < 3; c++) up_world[c] = c == up_axis;
    }
    memcpy(axis_world, up_world, 3 * sizeof *axis_world);
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
    if (arguments->azimuth_deg != 0 || arguments->elevation_deg != 0)
        turn_direction(arguments, axis_world, direction, up_world);
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

static bool load_camera(cli_session *session, const view_arguments *arguments, ewa_camera *camera) {
    session->subject = arguments->camera_path;
    ewa_status status =
        ewa_camera_load(session->context, arguments->camera_path, (uint32_t)arguments->camera_index, camera);
    if (status == EWA_OK) view_resize(camera, &arguments->size);
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

/// Places a camera whose picture and projection are set. With `turn`, whose pivot is set, the cloud is framed
/// in all its turns.
static ewa_status place_camera(cli_session *session, const view_arguments *arguments,
                               const cloud_framing *framing, ewa_camera *camera, view_turn *turn) {
    double direction[3], up_world[3], axis_world[3];
    choose_direction(arguments, framing, direction, up_world, axis_world);
    if (turn) memcpy(turn->axis_world, axis_world, sizeof axis_world);
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
    ewa_status status;
    if (turn) {
        cloud_framing solid;
        if (!framing_revolve(session, framing, turn->pivot_world, axis_world, direction, &solid))
            return EWA_ERROR_MEMORY;
        status = framing_fit(&solid, direction, up_world, camera);
        framing_free(&solid);
    } else {
        status = framing_fit(framing, direction, up_world, camera);
        if (status == EWA_OK && target->count)
            status = aim_at(camera, direction, framing->middle_world, target->values, up_world);
    }
    if (status == EWA_OK && arguments->ortho_height > 0)
        status = ewa_camera_set_ortho(camera, arguments->ortho_height);
    return status;
}

bool view_make(cli_session *session, const view_arguments *arguments, const ewa_cloud *cloud,
               double radius_scale, ewa_camera *camera, view_turn *turn) {
    ewa_camera_init(camera, sizeof *camera);
    if (arguments->camera_path && !load_camera(session, arguments, camera)) return false;
    if (arguments->camera_path && !turn) return true;
    cloud_framing framing;
    bool done = framing_make(session, cloud, radius_scale, &framing);
    if (done && turn)
        memcpy(turn->pivot_world, arguments->target.count ? arguments->target.values : framing.middle_world,
               sizeof turn->pivot_world);
    if (done && arguments->camera_path) {
        double direction[3], up_world[3];
        choose_direction(arguments, &framing, direction, up_world, turn->axis_world);
    } else if (done) {
        camera->width_px = arguments->size.width_px;
        camera->height_px = arguments->size.height_px;
        ewa_status status = arguments->ortho_height > 0
                                ? ewa_camera_set_ortho(camera, arguments->ortho_height)
                                : ewa_camera_set_fov(camera, arguments->fov_deg);
        if (status == EWA_OK) status = place_camera(session, arguments, &framing, camera, turn);
        done = status == EWA_OK;
        if (!done) session_failed(session, status);
    }
    framing_free(&framing);
    return done;
}
