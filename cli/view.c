// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where the camera stands: options, default views, framing.
#include "view.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLES = 1 << 16 };

/// Share of the points beyond each side of the box that is framed when a few points lie far off, and how many times
/// larger the box of all points is then.
static const double FAR_SHARE = 0.005, FAR_RATIO = 3;

/// Room around the object, as a share of the picture.
static const double MARGIN = 0.04;

static const option view_table[] = {
    {.key = "camera",
     .kind = OPTION_TEXT,
     .offset = offsetof(view_arguments, camera_path),
     .value = "FILE",
     .help = "camera file (JSON); with --size, its picture is scaled to that size"},
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
    else if (arguments->eye.count && arguments->view >= 0) clash = "--eye and --view exclude each other";
    else if (arguments->up.count && !arguments->up.values[0] && !arguments->up.values[1] && !arguments->up.values[2])
        clash = "--up: 0,0,0 has no direction";
    if (clash) snprintf(message, OPTION_ERROR_BYTES, "%s", clash);
    return !clash;
}

static int compare_numbers(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// The box without the outermost points of each side, from at most SAMPLES points evenly spread over the cloud.
static bool inner_box(const ewa_cloud *cloud, ewa_bounds *box) {
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    const uint64_t count = ewa_cloud_point_count(cloud), samples = count < SAMPLES ? count : SAMPLES;
    double *numbers = malloc(3 * samples * sizeof *numbers);
    if (!numbers) return false;
    uint64_t finite = 0;
    for (uint64_t i = 0; i < samples; i++) {
        double p[3];
        ewa_attribute_read_f64(position, i * count / samples, 1, p);
        if (!isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2])) continue;
        for (uint64_t c = 0; c < 3; c++) numbers[c * samples + finite] = p[c];
        finite++;
    }
    double origin_world[3];
    ewa_cloud_origin(cloud, origin_world);
    box->finite_count = finite;
    for (uint64_t c = 0; c < 3 && finite; c++) {
        double *axis = numbers + c * samples;
        qsort(axis, finite, sizeof *axis, compare_numbers);
        const uint64_t skipped = (uint64_t)(FAR_SHARE * (double)finite);
        box->low_world[c] = axis[skipped] + origin_world[c];
        box->high_world[c] = axis[finite - 1 - skipped] + origin_world[c];
    }
    free(numbers);
    return finite > 0;
}

static double diagonal(const ewa_bounds *box) {
    double squared = 0;
    for (int c = 0; c < 3; c++) {
        const double extent = box->high_world[c] - box->low_world[c];
        squared += extent * extent;
    }
    return sqrt(squared);
}

/// The box to frame: of all points, unless a few far ones would make the rest tiny.
static void choose_box(session *session, const ewa_cloud *cloud, ewa_bounds *box) {
    ewa_bounds inner;
    if (!inner_box(cloud, &inner) || diagonal(box) <= FAR_RATIO * diagonal(&inner) || diagonal(&inner) == 0) return;
    session_note(session,
                 "a few far points stretch the bounding box %.1f times; the other %g %% are framed (set --eye to "
                 "see all)",
                 diagonal(box) / diagonal(&inner), 100 - 600 * FAR_SHARE);
    for (int c = 0; c < 3; c++) {
        // The sampled box has lost a rim of the object: give some back, but never more than there is.
        const double rim = 0.05 * (inner.high_world[c] - inner.low_world[c]);
        box->low_world[c] = fmax(box->low_world[c], inner.low_world[c] - rim);
        box->high_world[c] = fmin(box->high_world[c], inner.high_world[c] + rim);
    }
}

/// Which axis of the world is up, by the shape of the box; see the help of render.
static int guess_up_axis(const ewa_bounds *box) {
    double extent[3], middle[3];
    for (int c = 0; c < 3; c++) {
        extent[c] = box->high_world[c] - box->low_world[c];
        middle[c] = 0.5 * (box->high_world[c] + box->low_world[c]);
    }
    const double narrow = fmin(extent[0], extent[1]), wide = fmax(extent[0], extent[1]);
    const bool flat = extent[2] < 0.4 * narrow, tall = extent[2] > 1.3 * wide;
    const bool georeferenced = fmax(fabs(middle[0]), fabs(middle[1])) > 100 * fmax(wide, extent[2]);
    return wide > 0 && (flat || tall || georeferenced) ? 2 : 1;
}

/// Direction from the eye to the middle for a named view with y (1) or z (2) up.
static void view_direction(int view, int up_axis, double direction[3]) {
    // Written for z up, from the front at -y; y up is the same turned about x.
    static const double directions[][3] = {{0, 1, 0},  {0, -1, 0}, {1, 0, 0},           {-1, 0, 0},
                                           {0, 0, -1}, {0, 0, 1},  {-0.55, 0.7, -0.45}};
    const double *d = directions[view];
    direction[0] = d[0];
    direction[1] = up_axis == 2 ? d[1] : d[2];
    direction[2] = up_axis == 2 ? d[2] : -d[1];
}

/// The up vector and, for a camera without --eye, the direction in which it looks.
static void choose_direction(const view_arguments *arguments, const ewa_bounds *box, double direction[3],
                             double up_world[3]) {
    int up_axis = guess_up_axis(box);
    if (arguments->up.count) {
        memcpy(up_world, arguments->up.values, 3 * sizeof *up_world);
        up_axis = fabs(up_world[2]) > fabs(up_world[1]) ? 2 : 1;
    } else {
        for (int c = 0; c < 3; c++) up_world[c] = c == up_axis;
    }
    const double height = box->high_world[up_axis] - box->low_world[up_axis];
    const int side = up_axis == 2 ? 1 : 2;
    const double across = fmin(box->high_world[0] - box->low_world[0], box->high_world[side] - box->low_world[side]);
    const bool ground = up_axis == 2 && height < 0.4 * across;
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
    const double x = (double)size->width_px / camera->width_px, y = (double)size->height_px / camera->height_px;
    camera->fx_px *= x;
    camera->cx_px *= x;
    camera->fy_px *= y;
    camera->cy_px *= y;
    camera->width_px = size->width_px;
    camera->height_px = size->height_px;
}

static bool load_camera(session *session, const view_arguments *arguments, ewa_camera *camera) {
    session->subject = arguments->camera_path;
    ewa_status status = ewa_camera_load(session->context, arguments->camera_path, camera);
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

bool view_make(session *session, const view_arguments *arguments, const ewa_cloud *cloud, ewa_camera *camera) {
    ewa_camera_init(camera, sizeof *camera);
    if (arguments->camera_path) return load_camera(session, arguments, camera);
    camera->width_px = arguments->size.width_px;
    camera->height_px = arguments->size.height_px;
    ewa_bounds box;
    ewa_status status = ewa_cloud_measure(cloud, &box);
    if (status == EWA_OK && box.finite_count == 0) {
        session_fail(session, "no point has finite coordinates");
        return false;
    }
    if (status == EWA_OK) {
        choose_box(session, cloud, &box);
        status = ewa_camera_set_fov(camera, arguments->fov_deg);
    }
    if (status == EWA_OK && arguments->ortho_height > 0)
        status = ewa_camera_set_ortho(camera, arguments->ortho_height);
    double direction[3], up_world[3], middle_world[3];
    if (status == EWA_OK) choose_direction(arguments, &box, direction, up_world);
    for (int c = 0; c < 3; c++) middle_world[c] = 0.5 * (box.low_world[c] + box.high_world[c]);
    const double *target_world = arguments->target.count ? arguments->target.values : middle_world;
    if (status == EWA_OK && arguments->eye.count) {
        status = ewa_camera_look_at(camera, arguments->eye.values, target_world, up_world);
        if (status != EWA_OK) session_fail(session, "--eye %g,%g,%g is where the camera looks", arguments->eye.values[0],
                                           arguments->eye.values[1], arguments->eye.values[2]);
    } else if (status == EWA_OK) {
        status = ewa_camera_frame(camera, &box, direction, up_world, MARGIN);
        if (status == EWA_OK && arguments->target.count)
            status = aim_at(camera, direction, middle_world, target_world, up_world);
        if (status == EWA_OK && arguments->ortho_height > 0)
            status = ewa_camera_set_ortho(camera, arguments->ortho_height);
    }
    if (status != EWA_OK) session_failed(session, status);
    return status == EWA_OK;
}
