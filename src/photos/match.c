// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A photograph beside what the points show: its exposure, the falloff of light towards its corners, and the pose of its camera,
// whose steps follow the gradient of both pictures (docs/math.md section 15, poses).
//
// Based on: B. Lucas, T. Kanade, "An Iterative Image Registration Technique", 1981; S. Benhimane, E. Malis, "Real-time
// Image-based Tracking of Planes using Efficient Second-order Minimization", 2004 (the mean of both gradients).
#include "homogeneous/vec.h"
#include "photos/parts.h"

#include <math.h>
#include <string.h>

enum {
    POSE = 6,                              ///< turns, then shifts
    SUMS = POSE * (POSE + 1) / 2 + POSE,   ///< the lower triangle of a matrix and a right side
    WIDE_POSE_STEPS = 2,                   ///< begin with robust weights of a larger scale
};

/// A step moves what is seen by no more than this, in the mean: farther off the gradient says nothing.
static const double MAX_STEP_PX = 1.5;
/// Of each number of a pose, relative to what pixels say of it: what they say nothing of stays.
static const double DAMPING = 1e-3;

void ewa_photo_match_get(const void *match, uint32_t i, double shown[EWA_PHOTO_CHANNELS], double color[EWA_PHOTO_CHANNELS],
                         double *weight) {
    const ewa_photo_match *at = match;
    const float *from = at->shown + 4 * (size_t)i;
    const ewa_photo_pixel *pixel = &at->view->pixels[i];
    for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) shown[c] = (double)pixel->color[c], color[c] = (double)from[c];
    *weight = (double)(pixel->weight * from[3]);
}

/// A step of a pose on its way.
typedef struct pose_job {
    const ewa_photo_match *match;
    const float *places; ///< [pixel][4]: places in camera space
    double pivot;        ///< depth of the point on the axis that the camera turns round
    double scale;        ///< of the robust weights
    double (*sums)[SUMS]; ///< [row]
} pose_job;

/// The change of a pixel's place by that of the point there: rows by x, y, z of camera space.
static void find_flow(const ewa_camera *camera, ewa_vec3 p, ewa_vec3 flow[2]) {
    const bool flat = camera->projection == EWA_ORTHOGRAPHIC;
    const double s = flat ? 1 : 1 / p.z, fx = camera->fx_px * s, fy = camera->fy_px * s;
    flow[0] = vec3_make(fx, 0, flat ? 0 : -fx * p.x * s);
    flow[1] = vec3_make(0, fy, flat ? 0 : -fy * p.y * s);
}

static double change_of(const float *pixel, ptrdiff_t step) { return 0.5 * ((double)pixel[step] - (double)pixel[-step]); }

/// Adds what a pixel says of the pose.
static void add_pixel(const pose_job *job, uint32_t i, double sums[SUMS]) {
    const ewa_photo_match *match = job->match;
    const uint32_t width = match->view->camera.width_px;
    const ewa_photo_pixel *at = &match->view->pixels[i];
    const float *from = match->shown + 4 * (size_t)i;
    double shown[EWA_PHOTO_CHANNELS], color[EWA_PHOTO_CHANNELS], wanted[EWA_PHOTO_CHANNELS], weight, mean = 0;
    ewa_photo_match_get(match, i, shown, color, &weight);
    for (int k = 0; k < 4; k++) {
        const ptrdiff_t step = (ptrdiff_t[]){1, -1, (ptrdiff_t)width, -(ptrdiff_t)width}[k];
        weight *= (double)(at[step].weight * from[4 * step + 3]);
    }
    if (!(weight > 0)) return;
    for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) {
        wanted[c] = match->photo->gain[c] * color[c] + match->photo->offset[c];
        mean += fmax(wanted[c], 0) / EWA_PHOTO_CHANNELS;
    }
    weight *= ewa_robust_weight(shown, wanted, job->scale) / (mean + EWA_PHOTO_MIN_COLOR);
    const float *place = job->places + 4 * (size_t)i;
    const ewa_vec3 p = vec3_make((double)place[0], (double)place[1], (double)place[2]);
    const ewa_vec3 arm = vec3_make(p.x, p.y, p.z - job->pivot);
    ewa_vec3 flow[2];
    find_flow(&match->view->camera, p, flow);
    for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) {
        const ptrdiff_t colors = sizeof *at / sizeof(float), down = (ptrdiff_t)width;
        const double gain = match->photo->gain[c];
        const double x = 0.5 * (change_of(&at->color[c], colors) + gain * change_of(from + c, 4)),
                     y = 0.5 * (change_of(&at->color[c], colors * down) + gain * change_of(from + c, 4 * down));
        const ewa_vec3 shift = vec3_add(vec3_scale(flow[0], x), vec3_scale(flow[1], y)), turn = vec3_cross(arm, shift);
        const double row[POSE] = {turn.x, turn.y, turn.z, shift.x, shift.y, shift.z}, error = wanted[c] - shown[c];
        double *to = sums;
        for (int k = 0; k < POSE; k++)
            for (int j = 0; j <= k; j++) *to++ += weight * row[k] * row[j];
        for (int k = 0; k < POSE; k++) *to++ += weight * row[k] * error;
    }
}

static void add_row(void *data, uint32_t y, uint32_t worker) {
    (void)worker;
    const pose_job *job = data;
    const uint32_t width = job->match->view->camera.width_px;
    if (y == 0 || y + 1 == job->match->view->camera.height_px) return;
    for (uint32_t x = 1; x + 1 < width; x++) add_pixel(job, y * width + x, job->sums[y]);
}

/// Solves for the motion by Cholesky's method; false where pixels say nothing.
static bool solve(const double sums[SUMS], double motion[POSE]) {
    double a[POSE][POSE];
    for (int i = 0; i < POSE; i++)
        for (int j = 0; j <= i; j++) a[i][j] = *sums++;
    for (int i = 0; i < POSE; i++) {
        const double damped = a[i][i] * (1 + DAMPING);
        if (!(damped > 0)) return false;
        double diagonal = damped;
        for (int j = 0; j < i; j++) {
            double sum = a[i][j];
            for (int k = 0; k < j; k++) sum -= a[i][k] * a[j][k];
            a[i][j] = sum / a[j][j];
            diagonal -= a[i][j] * a[i][j];
        }
        if (!(diagonal > 1e-12 * damped)) return false;
        a[i][i] = sqrt(diagonal);
    }
    for (int i = 0; i < POSE; i++) {
        motion[i] = sums[i];
        for (int k = 0; k < i; k++) motion[i] -= a[i][k] * motion[k];
        motion[i] /= a[i][i];
    }
    for (int i = POSE - 1; i >= 0; i--) {
        for (int k = i + 1; k < POSE; k++) motion[i] -= a[k][i] * motion[k];
        motion[i] /= a[i][i];
    }
    return true;
}

/// Moves a camera: a point p of its space becomes p + r x (p - pivot) + t, but by a turn that is one.
static void move(ewa_camera *camera, double pivot, const double motion[POSE], double share) {
    const ewa_vec3 r = vec3_scale(vec3_load(motion), share), t = vec3_scale(vec3_load(motion + 3), share);
    const double angle2 = vec3_dot(r, r), angle = sqrt(angle2);
    const double along = angle2 > 1e-20 ? sin(angle) / angle : 1, across = angle2 > 1e-20 ? (1 - cos(angle)) / angle2 : 0.5;
    double *m = camera->world_to_camera;
    for (int c = 0; c < 4; c++) {
        const ewa_vec3 p = vec3_make(m[c], m[4 + c], m[8 + c] - (c == 3 ? pivot : 0)), once = vec3_cross(r, p);
        ewa_vec3 q = vec3_add(p, vec3_add(vec3_scale(once, along), vec3_scale(vec3_cross(r, once), across)));
        if (c == 3) q = vec3_add(q, vec3_make(t.x, t.y, t.z + pivot));
        m[c] = q.x, m[4 + c] = q.y, m[8 + c] = q.z;
    }
}

/// How far what is seen lies apart in the pictures of two poses: root of the mean square, pixels.
static double distance_px(const pose_job *job, const double first[16], const double second[16]) {
    const ewa_photo_view *view = job->match->view;
    const double *m = view->camera.world_to_camera;
    const double scale2 = m[8] * m[8] + m[9] * m[9] + m[10] * m[10];
    double squares = 0, count = 0;
    for (size_t i = 0; i < view->pixel_count; i++) {
        const float *place = job->places + 4 * i;
        if (!(place[3] > 0)) continue;
        const double from[3] = {(double)place[0] - m[3], (double)place[1] - m[7], (double)place[2] - m[11]};
        double x_px[2], y_px[2];
        for (int k = 0; k < 2; k++) {
            const double *to = k ? second : first;
            double p[3] = {to[3], to[7], to[11]};
            for (int c = 0; c < 3; c++) {
                const double world = (m[c] * from[0] + m[4 + c] * from[1] + m[8 + c] * from[2]) / scale2;
                for (int r = 0; r < 3; r++) p[r] += to[4 * r + c] * world;
            }
            const double depth = view->camera.projection == EWA_ORTHOGRAPHIC ? 1 : p[2];
            x_px[k] = view->camera.fx_px * p[0] / depth, y_px[k] = view->camera.fy_px * p[1] / depth;
        }
        const double x = x_px[1] - x_px[0], y = y_px[1] - y_px[0];
        squares += x * x + y * y, count++;
    }
    return count > 0 ? sqrt(squares / count) : 0;
}

static void find_pivot(pose_job *job) {
    double sum = 0, count = 0;
    for (size_t i = 0; i < job->match->view->pixel_count; i++)
        if (job->places[4 * i + 3] > 0) sum += (double)job->places[4 * i + 2], count++;
    job->pivot = count > 0 ? sum / count : 0;
}

/// With memory for the places of points in camera space.
static ewa_status show_places(const ewa_photo_match *match, double *points, float *places) {
    const double *m = match->view->camera.world_to_camera;
    const ewa_attribute *position = ewa_cloud_find(match->job->cloud, EWA_POSITION);
    double origin[3];
    ewa_cloud_origin(match->job->cloud, origin);
    for (size_t i = 0; i < match->job->point_count; i++) {
        double at[3];
        ewa_attribute_read_f64(position, i, 1, at);
        for (int c = 0; c < 3; c++) at[c] += origin[c];
        for (size_t c = 0; c < 3; c++)
            points[3 * i + c] = m[4 * c] * at[0] + m[4 * c + 1] * at[1] + m[4 * c + 2] * at[2] + m[4 * c + 3];
    }
    return ewa_photo_view_show(match->view, points, places);
}

/// With the places at hand.
static void step_pose(pose_job *job) {
    ewa_photo_state *photo = job->match->photo;
    ewa_photo_view *view = job->match->view;
    double sums[SUMS] = {0}, motion[POSE];
    find_pivot(job);
    ewa_parallel(job->match->job->context, add_row, job, view->camera.height_px);
    for (size_t y = 0; y < view->camera.height_px; y++)
        for (int k = 0; k < SUMS; k++) sums[k] += job->sums[y][k];
    if (!solve(sums, motion)) return;
    ewa_camera moved = view->camera;
    move(&moved, job->pivot, motion, 1);
    const double length_px = distance_px(job, view->camera.world_to_camera, moved.world_to_camera);
    if (length_px > MAX_STEP_PX) {
        moved = view->camera;
        move(&moved, job->pivot, motion, MAX_STEP_PX / length_px);
    }
    photo->report.shift_px = distance_px(job, photo->photo->camera.world_to_camera, moved.world_to_camera);
    memcpy(photo->world_to_camera, moved.world_to_camera, sizeof moved.world_to_camera);
    view->camera = moved;
}

/// Improves a pose by one step, and shows the points by it.
static ewa_status refine_pose(const ewa_photo_match *match, double scale) {
    ewa_context *context = match->job->context;
    const size_t numbers = 3 * (size_t)match->job->point_count, floats = 4 * (size_t)match->view->pixel_count,
                 rows = match->view->camera.height_px;
    double *points = ewa_allocate(context, numbers, sizeof *points);
    float *places = ewa_allocate(context, floats, sizeof *places);
    pose_job job = {match, places, 0, scale, ewa_allocate_zeroed(context, rows, sizeof *job.sums)};
    ewa_status status = points && places && job.sums ? show_places(match, points, places) : EWA_ERROR_MEMORY;
    if (status == EWA_OK) step_pose(&job);
    ewa_release(context, points, numbers, sizeof *points);
    ewa_release(context, places, floats, sizeof *places);
    ewa_release(context, job.sums, rows, sizeof *job.sums);
    EWA_TRY(status);
    return ewa_photo_view_show(match->view, match->job->color, match->shown);
}

static void expose(const ewa_photo_match *match, double scale) {
    const uint32_t count = match->view->pixel_count;
    const ewa_exposure_pairs pairs = {count, ewa_exposure_stride(count), match, ewa_photo_match_get};
    ewa_exposure_step(&pairs, match->job->options.exposure, scale, match->photo->gain, match->photo->offset);
}

ewa_status ewa_photo_match_refine(const ewa_photo_match *match, int steps, int wide_steps, uint32_t pose_steps) {
    const double robust = match->job->options.robust;
    EWA_TRY(ewa_photo_view_show(match->view, match->job->color, match->shown));
    for (int step = 0; step < steps; step++) expose(match, robust * ldexp(1, step < wide_steps ? wide_steps - step : 0));
    for (uint32_t step = 0; step < pose_steps; step++) {
        EWA_TRY(refine_pose(match, robust * ldexp(1, step < WIDE_POSE_STEPS ? WIDE_POSE_STEPS - (int)step : 0)));
        expose(match, robust);
    }
    return EWA_OK;
}
