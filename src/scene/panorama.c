// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Panoramas: the sides of a cube around the eye, each an exact picture, and from these the pixels of another projection.
//
// Based on: N. Greene, "Environment Mapping and Other Applications of World Projections", 1986 (pictures on the sides of a cube).
#include "ewa/panorama.h"
#include "base/base.h"
#include "base/options.h"
#include "homogeneous/camera.h"
#include "homogeneous/vec.h"
#include "image/srgb.h"
#include "math/angle.h"
#include "scene/draw.h"
#include "scene/parts.h"
#include "surface/eye_dome.h"

#include <math.h>
#include <string.h>

enum {
    SIDES = 6,
    SAMPLES = 2, // along each side of a pixel
    PIXEL_SAMPLES = SAMPLES * SAMPLES,
    // Of a side's picture beyond 90 degrees, so that no sample lacks a neighbour, lit by all that eye-dome lighting looks at.
    MARGIN_PX = 2 + EWA_EYE_DOME_REACH,
};

/// Axes of the sides in camera coordinates: right, down, ahead.
static const int8_t side_axes[SIDES][3][3] = {
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},   {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}},
    {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},  {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}},
};

typedef struct panorama_job {
    const ewa_panorama_options *options;
    const ewa_frame *frame;
    uint32_t width_px, height_px;
    int side; // that is sampled
    uint32_t side_px;
    double focal_px; // of a side
    float *rgba;     // sums: 4 per pixel; NULL: none are wanted
    uint8_t *sides;  // by pixel, then sample: the one that it meets; SIDES: outside of the circle
    double (*across)[2], (*down)[2]; // sines and cosines of an equirectangular picture: by column and by row of samples
    ewa_image side_rgba, side_depth, side_normal, side_coverage;
} panorama_job;

/// Sine and cosine of any angle of at most pi in size.
static void sin_cos(double angle_rad, double *sine, double *cosine) {
    ewa_sin_cos(fabs(angle_rad), sine, cosine);
    if (angle_rad < 0) *sine = -*sine;
}

/// The direction of a sample in camera axes, not of any length; false: outside of the circle.
static bool find_direction(const panorama_job *job, uint32_t column, uint32_t row, double direction[3]) {
    if (job->options->kind == EWA_PANORAMA_EQUIRECTANGULAR) {
        const double *longitude = job->across[column], *latitude = job->down[row];
        direction[0] = latitude[1] * longitude[0], direction[1] = latitude[0], direction[2] = latitude[1] * longitude[1];
        return true;
    }
    const double x_px = (column + 0.5) / SAMPLES, y_px = (row + 0.5) / SAMPLES;
    const double radius_px = 0.5 * (job->width_px < job->height_px ? job->width_px : job->height_px);
    const double x = (x_px - 0.5 * job->width_px) / radius_px, y = (y_px - 0.5 * job->height_px) / radius_px;
    const double away = sqrt(x * x + y * y);
    if (away > 1) return false;
    double sine, cosine;
    sin_cos(away * 0.5 * job->options->fov_deg * (EWA_PI / 180), &sine, &cosine);
    direction[0] = away > 0 ? sine * x / away : 0, direction[1] = away > 0 ? sine * y / away : 0, direction[2] = cosine;
    return true;
}

/// The side that a direction meets: that of its longest component, of equal ones the first of the list.
static int find_side(const double d[3]) {
    const double x = fabs(d[0]), y = fabs(d[1]), z = fabs(d[2]);
    if (z >= x && z >= y) return d[2] > 0 ? 0 : SIDES - 1;
    if (x >= y) return d[0] > 0 ? 1 : 2;
    return d[1] > 0 ? 3 : 4;
}

/// Adds four weighed pixels of a plane around a place.
static void add_bilinear(const panorama_job *job, const float *plane, double x_px, double y_px, float rgba[4]) {
    const double left = floor(x_px - 0.5), top = floor(y_px - 0.5);
    const float right_share = (float)(x_px - 0.5 - left), low_share = (float)(y_px - 0.5 - top);
    const size_t first = 4 * ((size_t)top * job->side_px + (size_t)left), row = 4 * (size_t)job->side_px;
    for (int c = 0; c < 4; c++) {
        const float *at = plane + first + c;
        const float upper = at[0] + right_share * (at[4] - at[0]), lower = at[row] + right_share * (at[row + 4] - at[row]);
        rgba[c] += upper + low_share * (lower - upper);
    }
}

/// Adds what a place of the picture sees of the side at hand.
static void add_sample(const panorama_job *job, const double d[3], size_t pixel) {
    double at[3];
    for (int r = 0; r < 3; r++)
        at[r] = side_axes[job->side][r][0] * d[0] + side_axes[job->side][r][1] * d[1] + side_axes[job->side][r][2] * d[2];
    const double x_px = job->focal_px * at[0] / at[2] + 0.5 * job->side_px, y_px = job->focal_px * at[1] / at[2] + 0.5 * job->side_px;
    if (job->rgba) add_bilinear(job, job->side_rgba.pixels, x_px, y_px, job->rgba + 4 * pixel);
    const size_t nearest_x = (size_t)x_px, nearest_y = (size_t)y_px, nearest = nearest_y * job->side_px + nearest_x;
    const ewa_frame *frame = job->frame;
    if (frame->depth) {
        // Its distance is that along its own ray.
        const double x = ((double)nearest_x + 0.5 - 0.5 * job->side_px) / job->focal_px,
                     y = ((double)nearest_y + 0.5 - 0.5 * job->side_px) / job->focal_px, along = sqrt(1 + x * x + y * y);
        frame->depth[pixel] = fminf(frame->depth[pixel], (float)(along * (double)job->side_depth.pixels[nearest]));
    }
    for (int c = 0; c < 3 && frame->normal; c++) frame->normal[3 * pixel + (size_t)c] += job->side_normal.pixels[3 * nearest + (size_t)c];
    if (frame->coverage) frame->coverage[pixel] += job->side_coverage.pixels[nearest];
}

/// Notes which sides the samples of a row of pixels meet.
static void find_sides(void *data, uint32_t row, uint32_t worker) {
    (void)worker;
    const panorama_job *job = data;
    uint8_t *sides = job->sides + (size_t)row * job->width_px * PIXEL_SAMPLES;
    for (uint32_t column = 0; column < job->width_px; column++)
        for (uint32_t i = 0; i < PIXEL_SAMPLES; i++) {
            double direction[3];
            const bool inside = find_direction(job, column * SAMPLES + i % SAMPLES, row * SAMPLES + i / SAMPLES, direction);
            *sides++ = (uint8_t)(inside ? find_side(direction) : SIDES);
        }
}

static void sample_row(void *data, uint32_t row, uint32_t worker) {
    (void)worker;
    const panorama_job *job = data;
    const uint8_t *sides = job->sides + (size_t)row * job->width_px * PIXEL_SAMPLES;
    for (uint32_t column = 0; column < job->width_px; column++)
        for (uint32_t i = 0; i < PIXEL_SAMPLES; i++) {
            double direction[3];
            if (*sides++ == job->side && find_direction(job, column * SAMPLES + i % SAMPLES, row * SAMPLES + i / SAMPLES, direction))
                add_sample(job, direction, (size_t)row * job->width_px + column);
        }
}

/// Makes means of the sums of a row, and codes.
static void finish_row(void *data, uint32_t row, uint32_t worker) {
    (void)worker;
    const panorama_job *job = data;
    const ewa_frame *frame = job->frame;
    const float share = 1.0f / PIXEL_SAMPLES;
    for (size_t pixel = (size_t)row * job->width_px; pixel < (size_t)(row + 1) * job->width_px; pixel++) {
        for (int c = 0; c < 4 && job->rgba; c++) job->rgba[4 * pixel + (size_t)c] *= share;
        if (frame->rgba8) {
            const float *rgba = job->rgba + 4 * pixel, alpha = rgba[3] < 1 ? rgba[3] : 1;
            uint8_t *codes = frame->rgba8 + 4 * pixel;
            for (int c = 0; c < 3; c++) codes[c] = alpha > 0 ? ewa_srgb8_from_linear(rgba[c] / alpha) : 0;
            codes[3] = (uint8_t)(255 * alpha + 0.5f);
        }
        if (frame->coverage) frame->coverage[pixel] *= share;
        if (!frame->normal) continue;
        float *n = frame->normal + 3 * pixel;
        const float length2 = n[0] * n[0] + n[1] * n[1] + n[2] * n[2], scale = length2 > 0 ? 1 / sqrtf(length2) : 0;
        for (int c = 0; c < 3; c++) n[c] *= scale;
    }
}

/// The camera of a side; `upright` looks ahead.
static ewa_camera side_camera(const panorama_job *job, const ewa_camera *upright) {
    ewa_camera camera = *upright;
    camera.width_px = camera.height_px = job->side_px;
    camera.fx_px = camera.fy_px = job->focal_px;
    camera.cx_px = camera.cy_px = 0.5 * job->side_px;
    const double *m = upright->world_to_camera;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++) {
            camera.world_to_camera[4 * r + c] = 0;
            for (int k = 0; k < 3; k++) camera.world_to_camera[4 * r + c] += side_axes[job->side][r][k] * m[4 * k + c];
        }
    return camera;
}

/// Turns a camera so that an axis of the world is upright in it, and ahead is level; one that looks along the axis keeps its own.
static void stand_upright(const double up_world[3], ewa_camera *camera) {
    double *m = camera->world_to_camera, eye_world[3];
    ewa_vec3 up = vec3_load(up_world), ahead = vec3_load(m + 8);
    if (!vec3_normalize(&up) || !vec3_normalize(&ahead)) return;
    ahead = vec3_sub(ahead, vec3_scale(up, vec3_dot(ahead, up)));
    if (vec3_length(ahead) < 1e-6 || !vec3_normalize(&ahead)) return;
    ewa_camera_eye(camera, eye_world);
    // Rows of a camera may all be of one length other than 1.
    const double scale = vec3_length(vec3_load(m));
    const ewa_vec3 rows[3] = {vec3_cross(ahead, up), vec3_scale(up, -1), ahead};
    for (int r = 0; r < 3; r++) {
        vec3_store(vec3_scale(rows[r], scale), m + 4 * r);
        m[4 * r + 3] = -vec3_dot(vec3_load(m + 4 * r), vec3_load(eye_world));
    }
}

/// Sines and cosines of angles from -range / 2 to range / 2, at the middles of `count` equal parts.
static void fill_angles(double range_rad, uint32_t count, double (*angles)[2]) {
    for (uint32_t i = 0; i < count; i++) sin_cos(((i + 0.5) / count - 0.5) * range_rad, &angles[i][0], &angles[i][1]);
}

/// Makes the planes of a side, empties those of the picture, and finds what its samples meet.
static ewa_status begin(ewa_context *context, panorama_job *job) {
    const ewa_frame *frame = job->frame;
    const size_t pixel_count = (size_t)job->width_px * job->height_px;
    job->sides = ewa_allocate(context, pixel_count, PIXEL_SAMPLES);
    job->across = ewa_allocate(context, (size_t)job->width_px * SAMPLES, sizeof *job->across);
    job->down = ewa_allocate(context, (size_t)job->height_px * SAMPLES, sizeof *job->down);
    if (!job->sides || !job->across || !job->down) return EWA_ERROR_MEMORY;
    fill_angles(2 * EWA_PI, job->width_px * SAMPLES, job->across);
    fill_angles(EWA_PI, job->height_px * SAMPLES, job->down);
    ewa_parallel(context, find_sides, job, job->height_px);
    const uint32_t side_px = job->side_px;
    if (job->rgba) EWA_TRY(ewa_image_create(context, side_px, side_px, 4, &job->side_rgba));
    if (frame->depth) EWA_TRY(ewa_image_create(context, side_px, side_px, 1, &job->side_depth));
    if (frame->normal) EWA_TRY(ewa_image_create(context, side_px, side_px, 3, &job->side_normal));
    if (frame->coverage) EWA_TRY(ewa_image_create(context, side_px, side_px, 1, &job->side_coverage));
    if (job->rgba) memset(job->rgba, 0, 4 * pixel_count * sizeof *job->rgba);
    for (size_t i = 0; i < pixel_count && frame->depth; i++) frame->depth[i] = INFINITY;
    if (frame->normal) memset(frame->normal, 0, 3 * pixel_count * sizeof *frame->normal);
    if (frame->coverage) memset(frame->coverage, 0, pixel_count * sizeof *frame->coverage);
    return EWA_OK;
}

static void add_stats(const ewa_scene_stats *took, ewa_scene_stats *sum) {
    const uint64_t splat_count = took->render.splat_count;
    ewa_render_stats_add(&sum->render, &took->render);
    sum->render.splat_count = splat_count; // the same for all sides
    sum->lod = took->lod;
    sum->volumes = took->volumes;
}

static ewa_status draw_sides(ewa_scene *scene, ewa_scene_renderer *renderer, const ewa_camera *upright,
                             const ewa_scene_options *options, panorama_job *job, ewa_scene_stats *stats) {
    ewa_context *context = scene->context;
    EWA_TRY(begin(context, job));
    const ewa_frame side = {.rgba = job->side_rgba.pixels,
                            .depth = job->side_depth.pixels,
                            .normal = job->side_normal.pixels,
                            .coverage = job->side_coverage.pixels};
    for (job->side = 0; job->side < SIDES; job->side++) {
        if (!memchr(job->sides, job->side, (size_t)job->width_px * job->height_px * PIXEL_SAMPLES)) continue;
        const ewa_camera camera = side_camera(job, upright);
        ewa_scene_stats took;
        EWA_TRY(ewa_scene_draw(scene, renderer, &camera, options, &side, &took));
        add_stats(&took, stats);
        ewa_parallel(context, sample_row, job, job->height_px);
    }
    ewa_parallel(context, finish_row, job, job->height_px);
    return EWA_OK;
}

static ewa_status draw(ewa_scene *scene, ewa_scene_renderer *renderer, const ewa_camera *camera, const ewa_scene_options *given,
                       const ewa_panorama_options *panorama, const ewa_frame *frame, ewa_scene_stats *stats) {
    ewa_context *context = scene->context;
    const bool sphere = panorama->kind == EWA_PANORAMA_EQUIRECTANGULAR;
    const double circle_px = camera->width_px < camera->height_px ? camera->width_px : camera->height_px;
    const double px_per_rad = sphere ? camera->width_px / (2 * EWA_PI) : circle_px / (panorama->fov_deg * (EWA_PI / 180));
    // Of points that would be too large on finer sides, sides are as fine as the picture.
    const ewa_option *point_sizes = ewa_option_find(&ewa_render_options_table, "point_size_px");
    const double finer = panorama->finer * given->render.point_size_px <= point_sizes->maximum ? panorama->finer : 1;
    const double focal_px = ceil(finer * px_per_rad), side_px = 2 * focal_px + 2 * MARGIN_PX;
    if (side_px > EWA_CAMERA_MAX_SIDE_PX)
        return ewa_fail(context, EWA_ERROR_LIMIT, "panorama: %u x %u pixels need sides of %.0f, over the limit of %d", camera->width_px,
                        camera->height_px, side_px, EWA_CAMERA_MAX_SIDE_PX);
    panorama_job job = {.options = panorama,
                        .frame = frame,
                        .width_px = camera->width_px,
                        .height_px = camera->height_px,
                        .side_px = (uint32_t)side_px,
                        .focal_px = focal_px,
                        .rgba = frame->rgba};
    ewa_image own = {.pixels = NULL};
    if (!frame->rgba && frame->rgba8) EWA_TRY(ewa_image_create(context, camera->width_px, camera->height_px, 4, &own));
    if (own.pixels) job.rgba = own.pixels;
    ewa_camera upright = *camera;
    if (sphere) stand_upright(panorama->up_world, &upright);
    renderer->lit_from = &upright; // one light for all sides
    renderer->finer = finer;
    const ewa_status status = draw_sides(scene, renderer, &upright, given, &job, stats);
    renderer->lit_from = NULL;
    renderer->finer = 0;
    ewa_release(context, job.sides, (size_t)job.width_px * job.height_px, PIXEL_SAMPLES);
    ewa_release(context, job.across, (size_t)job.width_px * SAMPLES, sizeof *job.across);
    ewa_release(context, job.down, (size_t)job.height_px * SAMPLES, sizeof *job.down);
    ewa_image_free(&job.side_rgba);
    ewa_image_free(&job.side_depth);
    ewa_image_free(&job.side_normal);
    ewa_image_free(&job.side_coverage);
    ewa_image_free(&own);
    return status;
}

#define AT(member) offsetof(ewa_panorama_options, member)

static const ewa_option option_rows[] = {
    {"kind", EWA_OPTION_CHOICE, AT(kind), .words = "none|equirectangular|fisheye",
     .help = "all that is around the eye, in place of a plane picture: longitude and latitude, twice as wide as high; or a circle, in which "
             "distances from the middle are angles"},
    {"fov_deg", EWA_OPTION_F64, AT(fov_deg), 0, 360, EWA_OPTION_ABOVE, .initial = 180, .unit = "deg",
     .help = "angle across the circle of a fisheye"},
    {"up_world", EWA_OPTION_F64, AT(up_world), -INFINITY, INFINITY, EWA_OPTION_ABOVE | EWA_OPTION_BELOW, 3,
     .help = "axis that stands upright in an equirectangular picture; 0,0,0: the camera's own"},
    {"finer", EWA_OPTION_F64, AT(finer), 1, 4, .initial = 2,
     .help = "pixels of the plane pictures that it is made of, along each side of its own"},
};

const ewa_option_table ewa_panorama_options_table = EWA_OPTION_TABLE(ewa_panorama_options, option_rows);

void ewa_panorama_options_init(ewa_panorama_options *options, size_t struct_size) {
    ewa_options_init(&ewa_panorama_options_table, options, struct_size);
}

ewa_status ewa_scene_place_panorama(ewa_scene *scene, const ewa_view_options *view, ewa_panorama_options *panorama, ewa_camera *camera) {
    if (!scene || !panorama || !camera) return EWA_ERROR_ARGUMENT;
    ewa_view_info info;
    EWA_TRY(ewa_scene_place_camera(scene, view, camera, &info));
    double *up_world = panorama->up_world;
    if (up_world[0] == 0 && up_world[1] == 0 && up_world[2] == 0) memcpy(up_world, info.up_world, sizeof info.up_world);
    if ((view && view->has_eye) || scene->has_camera) return EWA_OK;
    for (int r = 0; r < 3; r++) {
        double *row = camera->world_to_camera + 4 * r;
        row[3] = -(row[0] * info.pivot_world[0] + row[1] * info.pivot_world[1] + row[2] * info.pivot_world[2]);
    }
    return EWA_OK;
}

ewa_status ewa_scene_draw_panorama(ewa_scene *scene, ewa_scene_renderer *renderer, const ewa_camera *camera,
                                   const ewa_scene_options *options, const ewa_panorama_options *given, const ewa_frame *frame,
                                   ewa_scene_stats *stats) {
    if (!scene || !renderer || !camera || !frame) return EWA_ERROR_ARGUMENT;
    ewa_context *context = scene->context;
    ewa_panorama_options panorama;
    ewa_panorama_options_init(&panorama, sizeof panorama);
    if (given) EWA_TRY(ewa_options_take(context, &ewa_panorama_options_table, given, &panorama));
    if (panorama.kind == EWA_PANORAMA_NONE) return ewa_scene_draw(scene, renderer, camera, options, frame, stats);
    EWA_TRY(ewa_camera_check(context, camera));
    if (camera->projection != EWA_PERSPECTIVE)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "panorama: the camera is orthographic, and has no eye");
    const double started_s = ewa_now_s();
    ewa_scene_stats took = {.total_s = 0};
    EWA_TRY(draw(scene, renderer, camera, options ? options : &scene->options, &panorama, frame, &took));
    took.total_s = took.render.total_s = ewa_now_s() - started_s;
    if (stats) *stats = took;
    return EWA_OK;
}
