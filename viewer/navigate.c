// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How cameras move: functions of a camera alone, which keep what the hand holds under the hand.
#include "navigate.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

/// The turntable stops so far from looking straight up or down, where its horizon would be lost.
static const double POLE_DEG = 89.5;

/// Camera space from the world: p = A w + t.
static void to_camera(const ewa_camera *camera, const double point_world[3], double point[3]) {
    const double *m = camera->world_to_camera;
    for (int i = 0; i < 3; i++)
        point[i] = m[4 * i] * point_world[0] + m[4 * i + 1] * point_world[1] + m[4 * i + 2] * point_world[2] +
                   m[4 * i + 3];
}

/// The square of the scale that A is a rotation times.
static double scale2(const ewa_camera *camera) {
    const double *m = camera->world_to_camera;
    return m[8] * m[8] + m[9] * m[9] + m[10] * m[10];
}

/// The world from camera space: A' (p - t) / scale^2.
static void to_world(const ewa_camera *camera, const double point[3], double point_world[3]) {
    const double *m = camera->world_to_camera, s2 = scale2(camera);
    for (int i = 0; i < 3; i++)
        point_world[i] =
            (m[i] * (point[0] - m[3]) + m[4 + i] * (point[1] - m[7]) + m[8 + i] * (point[2] - m[11])) / s2;
}

bool navigate_project(const ewa_camera *camera, const double point_world[3], double place_px[2],
                      double *depth) {
    double p[3];
    to_camera(camera, point_world, p);
    *depth = p[2];
    const bool ortho = camera->projection == EWA_ORTHOGRAPHIC;
    if (!ortho && !(p[2] > 0)) return false;
    const double w = ortho ? 1 : p[2];
    place_px[0] = camera->fx_px * p[0] / w + camera->cx_px;
    place_px[1] = camera->fy_px * p[1] / w + camera->cy_px;
    return isfinite(place_px[0]) && isfinite(place_px[1]);
}

void navigate_unproject(const ewa_camera *camera, double x_px, double y_px, double depth,
                        double point_world[3]) {
    const double w = camera->projection == EWA_ORTHOGRAPHIC ? 1 : depth;
    const double p[3] = {(x_px - camera->cx_px) / camera->fx_px * w,
                         (y_px - camera->cy_px) / camera->fy_px * w, depth};
    to_world(camera, p, point_world);
}

double navigate_depth(const ewa_camera *camera, const double point_world[3]) {
    double p[3];
    to_camera(camera, point_world, p);
    return p[2];
}

/// How far the camera looks down, seen with `up_world` up.
static double look_down_deg(const ewa_camera *camera, const double up_world[3]) {
    const double *ahead = &camera->world_to_camera[8];
    double along = 0, up2 = 0;
    for (int c = 0; c < 3; c++) along -= ahead[c] * up_world[c], up2 += up_world[c] * up_world[c];
    const double sine = along / sqrt(up2 * scale2(camera));
    return asin(fmin(fmax(sine, -1), 1)) * 180 / PI;
}

static void carry(ewa_camera *camera, const double pivot_world[3], const double *up_world, double right_deg,
                  double down_deg) {
    const double *m = camera->world_to_camera;
    const double own_up[3] = {-m[4], -m[5], -m[6]};
    ewa_camera_orbit(camera, pivot_world, up_world ? up_world : own_up, -right_deg);
    if (up_world) {
        const double now = look_down_deg(camera, up_world);
        const double maximum = fmax(POLE_DEG, fabs(now)); // who is nearer already may stay there
        down_deg = fmin(fmax(now + down_deg, -maximum), maximum) - now;
    }
    const double right[3] = {m[0], m[1], m[2]};
    ewa_camera_orbit(camera, pivot_world, right, -down_deg);
}

void navigate_orbit(ewa_camera *camera, const double pivot_world[3], const double *up_world, double right_deg,
                    double down_deg) {
    carry(camera, pivot_world, up_world, right_deg, down_deg);
}

void navigate_look(ewa_camera *camera, const double up_world[3], double right_deg, double down_deg) {
    double eye_world[3];
    ewa_camera_eye(camera, eye_world);
    carry(camera, eye_world, up_world, right_deg, down_deg);
}

void navigate_pan(ewa_camera *camera, double depth, double x_px, double y_px) {
    const double w = camera->projection == EWA_ORTHOGRAPHIC ? 1 : depth;
    camera->world_to_camera[3] += x_px / camera->fx_px * w;
    camera->world_to_camera[7] += y_px / camera->fy_px * w;
}

void navigate_zoom(ewa_camera *camera, const double point_world[3], double factor) {
    double p[3];
    to_camera(camera, point_world, p);
    double *m = camera->world_to_camera;
    if (camera->projection == EWA_ORTHOGRAPHIC) {
        const double fx = camera->fx_px / factor, fy = camera->fy_px / factor;
        if (!(fx > 1e-300 && fy > 1e-300 && fx < 1e300 && fy < 1e300)) return;
        camera->fx_px = fx;
        camera->fy_px = fy;
        m[3] += p[0] * (factor - 1);
        m[7] += p[1] * (factor - 1);
        return;
    }
    for (int i = 0; i < 3; i++) m[4 * i + 3] += p[i] * (factor - 1);
}

void navigate_move(ewa_camera *camera, const double by[3]) {
    const double scale = sqrt(scale2(camera));
    for (int i = 0; i < 3; i++) camera->world_to_camera[4 * i + 3] -= by[i] * scale;
}

void navigate_center(ewa_camera *camera, const double point_world[3]) {
    double p[3];
    to_camera(camera, point_world, p);
    const double w = camera->projection == EWA_ORTHOGRAPHIC ? 1 : p[2];
    const double x = (0.5 * camera->width_px - camera->cx_px) / camera->fx_px * w,
                 y = (0.5 * camera->height_px - camera->cy_px) / camera->fy_px * w;
    camera->world_to_camera[3] += x - p[0];
    camera->world_to_camera[7] += y - p[1];
}

void navigate_set_ortho(ewa_camera *camera, bool ortho, const double point_world[3], double fov_deg) {
    if (ortho == (camera->projection == EWA_ORTHOGRAPHIC)) return;
    const double depth = navigate_depth(camera, point_world);
    double *m = camera->world_to_camera;
    if (ortho) {
        if (!(depth > 0)) return;
        camera->fx_px /= depth;
        camera->fy_px /= depth;
        camera->projection = EWA_ORTHOGRAPHIC;
        return;
    }
    // Back to where things at the point's depth have the size that they have now.
    const double fy_px = 0.5 * camera->height_px / tan(fov_deg * PI / 360);
    const double distance = fy_px / camera->fy_px;
    camera->fx_px *= distance;
    camera->fy_px = fy_px;
    m[11] += distance - depth;
    camera->projection = EWA_PERSPECTIVE;
}
