// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scenes of a known amount of work.
#include "bench/scene.h"

#include "bench/cover.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define STANDARD_SIZE                                                                                        \
    { 1280, 1024, false }

const bench_recipe bench_recipes[BENCH_SCENE_COUNT] = {
    [BENCH_PLANE] = {"plane", {1e6}, {9, 25, 100}, {STANDARD_SIZE}},
    [BENCH_COLOR] = {"color", {1e6}, {9, 25, 100}, {STANDARD_SIZE}},
    [BENCH_LARGE] = {"large", {1e7}, {9}, {STANDARD_SIZE}},
    [BENCH_HIDDEN] = {"hidden", {2.5e6}, {9}, {STANDARD_SIZE}},
    [BENCH_POINTS] = {"points", {1e6}, {0}, {STANDARD_SIZE}},
    [BENCH_CULLED] = {"culled", {1e7}, {9}, {STANDARD_SIZE}},
    [BENCH_CLOSED] = {"closed", {2.5e6}, {0}, {STANDARD_SIZE}},
    [BENCH_SEEN] = {"seen", {2.5e6}, {0}, {STANDARD_SIZE}},
    [BENCH_LAYERS] = {"layers", {1e6}, {0}, {STANDARD_SIZE}},
    [BENCH_PEER] = {"peer", {1e5, 1e6, 5e6}, {0}, {STANDARD_SIZE, {512, 512, false}}},
    [BENCH_PHONG] = {"phong", {1e6}, {9}, {STANDARD_SIZE}},
};

/// Room around the object; its outermost discs stay in the picture.
static const double MARGIN = 0.01;

/// Radius of the discs of the scene of points, in pixels.
static const double POINT_RADIUS_PX = 0.25;

/// The closed scene: spheres of these radii, as many points on each. Densities are almost the same, as in a
/// scan, so that all are equally covered.
enum { SPHERES = 3 };
static const float sphere_radii[SPHERES] = {1, 0.95f, 0.9f};

static ewa_status generate(cli_session *session, ewa_object object, uint64_t point_count, ewa_cloud **cloud) {
    ewa_generate_options options;
    ewa_generate_options_init(&options, sizeof options);
    options.object = object;
    options.point_count = point_count;
    return ewa_cloud_generate(session->context, &options, cloud);
}

static float *stream(const ewa_cloud *cloud, const char *name) { return ewa_cloud_find(cloud, name)->data; }

static void set_radius(ewa_cloud *cloud, double radius_world) {
    float *radius = stream(cloud, EWA_RADIUS);
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) radius[i] = (float)radius_world;
}

static ewa_status frame(const ewa_cloud *cloud, const option_size *size, double fov_deg,
                        const double direction_world[3], const double up_world[3], ewa_camera *camera) {
    ewa_bounds bounds;
    ewa_status status = ewa_cloud_measure(cloud, &bounds);
    ewa_camera_init(camera);
    camera->width_px = size->width_px;
    camera->height_px = size->height_px;
    if (status == EWA_OK) status = ewa_camera_set_fov(camera, fov_deg);
    if (status == EWA_OK) status = ewa_camera_frame(camera, &bounds, direction_world, up_world, MARGIN);
    return status;
}

/// A rectangle in the shape of the picture, and a camera above it.
static ewa_status make_plane(cli_session *session, uint64_t point_count, const option_size *size,
                             bench_scene *scene) {
    static const double down[3] = {0, 0.05, -1}, ahead[3] = {0, 1, 0};
    const ewa_status status = generate(session, EWA_OBJECT_PLANE, point_count, &scene->cloud);
    if (status != EWA_OK) return status;
    const float aspect = (float)size->width_px / (float)size->height_px;
    float *position = stream(scene->cloud, EWA_POSITION), *radius = stream(scene->cloud, EWA_RADIUS);
    for (uint64_t i = 0; i < point_count; i++) {
        position[3 * i] *= aspect;
        radius[i] *= fmaxf(aspect, 1);
    }
    return frame(scene->cloud, size, 30, down, ahead, &scene->camera);
}

static ewa_status make_points(cli_session *session, uint64_t point_count, const option_size *size,
                              bench_scene *scene) {
    const ewa_status status = make_plane(session, point_count, size, scene);
    if (status == EWA_OK)
        set_radius(scene->cloud, POINT_RADIUS_PX * scene->camera.world_to_camera[11] / scene->camera.fx_px);
    return status;
}

/// A sheet of a scene of several.
typedef struct sheet {
    double share;        ///< of the scene's points
    double distance;     ///< from the eye, times that of the first sheet, which it covers exactly
    double shift_widths; ///< to the side
    bool turned;         ///< shows its back
} sheet;

/// Bends a plane into waves: z = height sin kx sin ky.
static void bend(ewa_cloud *cloud) {
    const double height = 0.02, k = 6 * acos(-1);
    float *position = stream(cloud, EWA_POSITION), *normal = stream(cloud, EWA_NORMAL);
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++, position += 3, normal += 3) {
        const double x = k * position[0], y = k * position[1];
        const double slope_x = height * k * cos(x) * sin(y), slope_y = height * k * sin(x) * cos(y);
        const double length = sqrt(1 + slope_x * slope_x + slope_y * slope_y);
        position[2] = (float)(height * sin(x) * sin(y));
        normal[0] = (float)(-slope_x / length);
        normal[1] = (float)(-slope_y / length);
        normal[2] = (float)(1 / length);
    }
}

static void place(ewa_cloud *cloud, const sheet *where, const double eye_world[3], double width_world) {
    float *position = stream(cloud, EWA_POSITION), *normal = stream(cloud, EWA_NORMAL);
    const double shift[3] = {where->shift_widths * width_world, 0, 0};
    for (uint64_t i = 0; i < 3 * ewa_cloud_point_count(cloud); i++) {
        const double eye = eye_world[i % 3];
        position[i] = (float)(eye + where->distance * (position[i] - eye) + shift[i % 3]);
        if (where->turned) normal[i] = -normal[i];
    }
    set_radius(cloud, where->distance);
}

/// Objects in one cloud; destroys the parts.
static ewa_status join(ewa_status status, ewa_cloud **parts, uint32_t count, ewa_cloud **whole) {
    if (status == EWA_OK) status = ewa_cloud_merge((const ewa_cloud *const *)parts, count, whole);
    for (uint32_t k = 0; k < count; k++) ewa_cloud_destroy(&parts[k]);
    return status;
}

static ewa_status make_sheets(cli_session *session, uint64_t point_count, const option_size *size,
                              const sheet *sheets, uint32_t sheet_count, bench_scene *scene) {
    enum { MAX_SHEETS = 4 };
    ewa_cloud *clouds[MAX_SHEETS] = {NULL};
    ewa_status status = EWA_OK;
    double share = 0;
    for (uint32_t k = 0; status == EWA_OK && k < sheet_count; k++) {
        const double first = round(share * (double)point_count);
        share += sheets[k].share;
        const uint64_t count = (uint64_t)fmax(round(share * (double)point_count) - first, 1);
        bench_scene part = {.cloud = NULL};
        status = make_plane(session, count, size, &part);
        clouds[k] = part.cloud;
        if (status != EWA_OK) break;
        if (k == 0) scene->camera = part.camera;
        double eye_world[3];
        ewa_camera_eye(&scene->camera, eye_world);
        bend(part.cloud);
        place(part.cloud, &sheets[k], eye_world, 2.0 * size->width_px / size->height_px);
    }
    status = join(status, clouds, sheet_count, &scene->cloud);
    scene->cull = EWA_CULL_BACK;
    return status;
}

static ewa_status make_hidden(cli_session *session, uint64_t point_count, const option_size *size,
                              bench_scene *scene) {
    static const sheet sheets[] = {{.share = 0.4, .distance = 1},
                                   {.share = 0.3, .distance = 1.25, .turned = true},
                                   {.share = 0.3, .distance = 1.5}};
    scene->unseen_share = 0.6;
    return make_sheets(session, point_count, size, sheets, 3, scene);
}

static ewa_status make_culled(cli_session *session, uint64_t point_count, const option_size *size,
                              bench_scene *scene) {
    static const sheet sheets[] = {{.share = 0.5, .distance = 1, .turned = true},
                                   {.share = 0.5, .distance = 1, .shift_widths = 3}};
    scene->unseen_share = 1;
    return make_sheets(session, point_count, size, sheets, 2, scene);
}

/// Camera for spheres about the origin, along x.
static ewa_status frame_spheres(const option_size *size, bench_scene *scene) {
    static const double ahead[3] = {1, 0, 0}, up[3] = {0, 0, 1};
    scene->cull = EWA_CULL_BACK;
    return frame(scene->cloud, size, 20, ahead, up, &scene->camera);
}

static ewa_status make_closed(cli_session *session, uint64_t point_count, const option_size *size,
                              bench_scene *scene) {
    ewa_cloud *parts[SPHERES] = {NULL};
    ewa_status status = EWA_OK;
    for (uint64_t k = 0; status == EWA_OK && k < SPHERES; k++) {
        const uint64_t count = (k + 1) * point_count / SPHERES - k * point_count / SPHERES;
        status = generate(session, EWA_OBJECT_SPHERE, count ? count : 1, &parts[k]);
        if (status != EWA_OK) break;
        float *position = stream(parts[k], EWA_POSITION), *radius = stream(parts[k], EWA_RADIUS);
        for (uint64_t i = 0; i < ewa_cloud_point_count(parts[k]); i++) {
            for (int r = 0; r < 3; r++) position[3 * i + r] *= sphere_radii[k];
            radius[i] *= sphere_radii[k];
        }
    }
    status = join(status, parts, SPHERES, &scene->cloud);
    if (status == EWA_OK) status = frame_spheres(size, scene);
    if (status != EWA_OK) return status;
    double eye_world[3];
    ewa_camera_eye(&scene->camera, eye_world);
    const uint64_t count = ewa_cloud_point_count(scene->cloud);
    uint64_t seen_count = 0;
    const float *position = stream(scene->cloud, EWA_POSITION);
    for (uint64_t i = 0; i < count / SPHERES; i++, position += 3) {
        double facing = -1; // the eye's height over the tangent plane, the outer sphere's radius being 1
        for (int r = 0; r < 3; r++) facing += eye_world[r] * position[r];
        seen_count += facing > 0;
    }
    scene->unseen_share = 1 - (double)seen_count / (double)count;
    return EWA_OK;
}

/// Archimedes: heights on a sphere are uniform, so a linear map of heights takes the sphere to the part that
/// is seen, with uniform points. Discs are as large as those of the closed scene.
static ewa_status make_seen(cli_session *session, uint64_t point_count, const option_size *size,
                            bench_scene *scene) {
    ewa_status status = generate(session, EWA_OBJECT_SPHERE, point_count, &scene->cloud);
    if (status == EWA_OK) status = frame_spheres(size, scene);
    if (status != EWA_OK) return status;
    set_radius(scene->cloud, EWA_DEFAULT_RADIUS_SCALE * sqrt(4 * acos(-1) * SPHERES / (double)point_count));
    double eye_world[3];
    ewa_camera_eye(&scene->camera, eye_world);
    const double horizon = 1 / fabs(eye_world[0]);
    float *position = stream(scene->cloud, EWA_POSITION), *normal = stream(scene->cloud, EWA_NORMAL);
    for (uint64_t i = 0; i < point_count; i++, position += 3, normal += 3) {
        const double x = fmin(fmax(normal[0], -1), 1), towards = horizon + (1 - horizon) * 0.5 * (1 - x);
        const double narrower = sqrt((1 - towards * towards) / fmax(1 - x * x, 1e-12));
        normal[0] = (float)-towards;
        normal[1] = (float)(narrower * normal[1]);
        normal[2] = (float)(narrower * normal[2]);
        memcpy(position, normal, 3 * sizeof *position);
    }
    return EWA_OK;
}

/// Sphere and torus side by side, of one density.
static ewa_status make_peer(cli_session *session, uint64_t point_count, const option_size *size,
                            bench_scene *scene) {
    static const double ahead[3] = {0, 1, -0.7}, up[3] = {0, 0, 1};
    const double tube = 2.0 / 7, pi = acos(-1), sphere_area = 4 * pi,
                 torus_area = 4 * pi * pi * tube * (1 - tube);
    const double sphere_share = sphere_area / (sphere_area + torus_area);
    ewa_cloud *parts[2] = {NULL};
    const uint64_t sphere_count = 1 + (uint64_t)(sphere_share * (double)(point_count - 1));
    ewa_status status = generate(session, EWA_OBJECT_SPHERE, sphere_count, &parts[0]);
    if (status == EWA_OK && point_count > sphere_count)
        status = generate(session, EWA_OBJECT_TORUS, point_count - sphere_count, &parts[1]);
    const uint32_t count = parts[1] ? 2 : 1;
    for (uint32_t k = 0; status == EWA_OK && k < count; k++) {
        float *position = stream(parts[k], EWA_POSITION);
        for (uint64_t i = 0; i < ewa_cloud_point_count(parts[k]); i++) position[3 * i] += k ? 1.1f : -1.1f;
    }
    status = join(status, parts, count, &scene->cloud);
    scene->cull = EWA_CULL_BACK;
    return status == EWA_OK ? frame(scene->cloud, size, 30, ahead, up, &scene->camera) : status;
}

static ewa_status make_layers(cli_session *session, uint64_t point_count, const option_size *size,
                              bench_scene *scene) {
    const ewa_status status = make_peer(session, point_count, size, scene);
    scene->cull = EWA_CULL_NONE;
    scene->in_all_ways = true;
    return status;
}

typedef ewa_status scene_maker(cli_session *session, uint64_t point_count, const option_size *size,
                               bench_scene *scene);

static scene_maker *const makers[BENCH_SCENE_COUNT] = {
    [BENCH_PLANE] = make_plane,   [BENCH_COLOR] = make_plane,   [BENCH_LARGE] = make_plane,
    [BENCH_HIDDEN] = make_hidden, [BENCH_POINTS] = make_points, [BENCH_CULLED] = make_culled,
    [BENCH_CLOSED] = make_closed, [BENCH_SEEN] = make_seen,     [BENCH_PEER] = make_peer,
    [BENCH_PHONG] = make_plane,   [BENCH_LAYERS] = make_layers,
};

bool bench_scene_make(cli_session *session, bench_scene_kind kind, uint64_t point_count, double covered_px,
                      const option_size *size, double prefilter_px, bench_scene *scene) {
    *scene = (bench_scene){
        .name = bench_recipes[kind].name, .color_only = kind == BENCH_COLOR, .glossy = kind == BENCH_PHONG};
    if (!session_passed(session, makers[kind](session, point_count, size, scene))) return false;
    if (covered_px > 0 && !bench_cover_scale(session, scene->cloud, &scene->camera, prefilter_px, covered_px))
        return false;
    scene->covered_px = bench_cover_px(scene->cloud, &scene->camera, prefilter_px);
    if (kind == BENCH_PEER)
        snprintf(scene->label, sizeof scene->label, "%s %.4g M %ux%u", scene->name,
                 1e-6 * (double)point_count, size->width_px, size->height_px);
    else if (kind == BENCH_LAYERS)
        snprintf(scene->label, sizeof scene->label, "%s %.4g M", scene->name, 1e-6 * (double)point_count);
    else
        snprintf(scene->label, sizeof scene->label, "%s %.4g M of %.3g px", scene->name,
                 1e-6 * (double)point_count, scene->covered_px);
    return true;
}
