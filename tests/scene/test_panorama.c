// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Panoramas of a sphere around the eye, of which colour, distance and normal of every direction are known; and of a scene that turns.
#include "check.h"

#include <math.h>

#define PI 3.141592653589793

enum { POINTS = 60000, MAX_PIXELS = 240 * 120 };

static const double EYE[3] = {0.5, -2, 30}, RADIUS = 4;

/// What is drawn, and what came.
typedef struct shot {
    float rgba[4 * MAX_PIXELS], depth[MAX_PIXELS], normal[3 * MAX_PIXELS], coverage[MAX_PIXELS];
    uint8_t rgba8[4 * MAX_PIXELS];
    ewa_scene_stats stats;
} shot;

/// Linear light of a direction.
static double light_of(const double direction[3], int c) { return 0.5 + 0.4 * direction[c]; }

/// A sphere around EYE whose colours are those of directions from there.
static ewa_cloud *make_sphere(ewa_context *context) {
    void *position = NULL, *normal = NULL, *radius = NULL, *color = NULL;
    ewa_cloud *cloud = check_cloud_of(context, POINTS);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, &position), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_NORMAL, EWA_F32, 3, &normal), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, &radius), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_COLOR, EWA_F32, 3, &color), EWA_OK);
    for (int i = 0; i < POINTS; i++) { // a spiral, evenly
        const double up = 1 - (2 * i + 1.0) / POINTS, around = i * PI * (3 - sqrt(5)), level = sqrt(1 - up * up);
        const double direction[3] = {level * cos(around), level * sin(around), up};
        for (int c = 0; c < 3; c++) {
            ((double *)position)[3 * i + c] = EYE[c] + RADIUS * direction[c];
            ((float *)normal)[3 * i + c] = (float)-direction[c];
            ((float *)color)[3 * i + c] = (float)light_of(direction, c);
        }
        ((float *)radius)[i] = (float)(RADIUS * 1.6 * sqrt(4 * PI / POINTS));
    }
    return cloud;
}

typedef struct stage {
    ewa_context *context;
    ewa_cloud *cloud;
    ewa_scene *scene;
    ewa_scene_renderer *renderer;
} stage;

static void open_stage(uint32_t threads, stage *s) {
    s->context = check_context(threads, NULL);
    s->cloud = make_sphere(s->context);
    ewa_asset *asset = NULL;
    WITH_DEFAULTS(ewa_scene_options, options);
    options.render.shading = EWA_SHADING_NONE;
    assert_int_equal(ewa_scene_create(s->context, &options, &s->scene), EWA_OK);
    assert_int_equal(ewa_asset_create(s->context, &(ewa_asset_source){.cloud = s->cloud}, NULL, &asset), EWA_OK);
    assert_int_equal(ewa_scene_add(s->scene, asset, NULL), EWA_OK);
    ewa_asset_release(&asset);
    assert_int_equal(ewa_scene_renderer_create(s->context, EWA_BACKEND_CPU, NULL, &s->renderer), EWA_OK);
}

static void close_stage(stage *s) {
    ewa_scene_renderer_destroy(&s->renderer);
    ewa_scene_destroy(&s->scene);
    ewa_cloud_destroy(&s->cloud);
    ewa_context_destroy(&s->context);
}

/// A camera at EYE that looks along +y with z up, turned by an angle about the vertical, then tilted up.
static ewa_camera make_camera(uint32_t width_px, uint32_t height_px, double turned, double tilted) {
    ewa_camera camera = check_camera(width_px, height_px);
    const double c = cos(turned), s = sin(turned), ct = cos(tilted), st = sin(tilted);
    const double right[3] = {c, s, 0}, level[3] = {-s, c, 0};
    double rows[3][3];
    for (int k = 0; k < 3; k++) {
        const double up = k == 2;
        rows[0][k] = right[k];
        rows[1][k] = -(ct * up - st * level[k]);
        rows[2][k] = ct * level[k] + st * up;
    }
    for (int r = 0; r < 3; r++) {
        double *row = camera.world_to_camera + 4 * r;
        row[3] = 0;
        for (int k = 0; k < 3; k++) row[k] = rows[r][k], row[3] -= rows[r][k] * EYE[k];
    }
    return camera;
}

static ewa_panorama_options make_options(ewa_panorama_kind kind) {
    WITH_DEFAULTS(ewa_panorama_options, options);
    options.kind = kind;
    return options;
}

static ewa_status draw(const stage *s, const ewa_camera *camera, const ewa_panorama_options *options, shot *to) {
    const ewa_frame frame = {to->rgba8, to->rgba, to->depth, to->normal, to->coverage};
    return ewa_scene_draw_panorama(s->scene, s->renderer, camera, NULL, options, &frame, &to->stats);
}

/// The direction, in the world, of a pixel's middle; false: outside of the circle by a pixel or more, `*rim` about on it.
static bool direction_of(const ewa_camera *camera, const ewa_panorama_options *options, uint32_t x, uint32_t y, double world[3], bool *rim) {
    double at[3];
    *rim = false;
    if (options->kind == EWA_PANORAMA_EQUIRECTANGULAR) {
        const double lon = ((x + 0.5) / camera->width_px - 0.5) * 2 * PI, lat = (0.5 - (y + 0.5) / camera->height_px) * PI;
        at[0] = cos(lat) * sin(lon), at[1] = -sin(lat), at[2] = cos(lat) * cos(lon);
    } else {
        const double radius = fmin(camera->width_px, camera->height_px) / 2.0;
        const double u = x + 0.5 - camera->width_px / 2.0, v = y + 0.5 - camera->height_px / 2.0, away = hypot(u, v);
        const double angle = away / radius * options->fov_deg / 2 * PI / 180;
        *rim = fabs(away - radius) < 1;
        if (away > radius) return false;
        at[0] = sin(angle) * u / fmax(away, 1e-9), at[1] = sin(angle) * v / fmax(away, 1e-9), at[2] = cos(angle);
    }
    const double *m = camera->world_to_camera;
    for (int c = 0; c < 3; c++) world[c] = m[c] * at[0] + m[4 + c] * at[1] + m[8 + c] * at[2];
    return true;
}

/// Every pixel shows what lies in its direction, at its distance, also where sides of the cube meet.
TEST(test_directions) {
    static const struct {
        ewa_panorama_kind kind;
        uint32_t width_px, height_px;
        double fov_deg;
    } cases[] = {{EWA_PANORAMA_EQUIRECTANGULAR, 240, 120, 180}, {EWA_PANORAMA_EQUIRECTANGULAR, 101, 77, 180},
                 {EWA_PANORAMA_FISHEYE, 120, 120, 180},         {EWA_PANORAMA_FISHEYE, 131, 90, 80},
                 {EWA_PANORAMA_FISHEYE, 90, 131, 360}};
    stage s;
    open_stage(2, &s);
    static shot got;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        const ewa_camera camera = make_camera(cases[k].width_px, cases[k].height_px, 0.7, 0.4);
        ewa_panorama_options options = make_options(cases[k].kind);
        options.fov_deg = cases[k].fov_deg;
        assert_int_equal(draw(&s, &camera, &options, &got), EWA_OK);
        double color = 0, depth = 0, normal = 0;
        for (uint32_t i = 0; i < camera.width_px * camera.height_px; i++) {
            double d[3];
            bool rim;
            if (!direction_of(&camera, &options, i % camera.width_px, i / camera.width_px, d, &rim)) {
                if (!rim) assert_true(got.rgba[4 * i + 3] == 0 && got.coverage[i] == 0 && isinf(got.depth[i]) && got.rgba8[4 * i + 3] == 0);
                continue;
            }
            if (rim) continue;
            if (!(got.rgba[4 * i + 3] > 0.9999f && got.rgba8[4 * i + 3] == 255 && got.coverage[i] > 0.8f))
                fail_msg("pixel %u, %u: alpha %g, coverage %g", i % camera.width_px, i / camera.width_px, (double)got.rgba[4 * i + 3], (double)got.coverage[i]);
            for (int c = 0; c < 3; c++) {
                color = fmax(color, fabs((double)got.rgba[4 * i + (uint32_t)c] - light_of(d, c)));
                normal = fmax(normal, fabs((double)got.normal[3 * i + (uint32_t)c] + d[c]));
            }
            depth = fmax(depth, fabs((double)got.depth[i] / RADIUS - 1));
        }
        print_message("%d of %u x %u: colours %.4f, distances %.4f, normals %.4f\n", (int)cases[k].kind, camera.width_px, camera.height_px, color,
                      depth, normal);
        assert_true(color < 0.012 && depth < 0.002 && normal < 0.03);
    }
    close_stage(&s);
}

/// A camera that is turned shows the same, moved along; what is upright stays so whatever the camera's tilt.
TEST(test_turned) {
    stage s;
    open_stage(2, &s);
    static shot plain, other;
    ewa_camera camera = make_camera(240, 120, 0, 0);
    ewa_panorama_options options = make_options(EWA_PANORAMA_EQUIRECTANGULAR);
    assert_int_equal(draw(&s, &camera, &options, &plain), EWA_OK);
    camera = make_camera(240, 120, PI / 2, 0);
    assert_int_equal(draw(&s, &camera, &options, &other), EWA_OK);
    // To the left by a quarter: what was ahead is to the right now.
    for (uint32_t y = 0; y < 120; y++)
        for (uint32_t x = 0; x < 240; x++)
            for (int c = 0; c < 3; c++)
                assert_true(fabsf(plain.rgba[4 * (240 * y + x) + (uint32_t)c] - other.rgba[4 * (240 * y + (x + 60) % 240) + (uint32_t)c]) < 2e-3f);
    camera = make_camera(240, 120, 0, 1);
    memcpy(options.up_world, (const double[3]){0, 0, 7}, sizeof options.up_world);
    assert_int_equal(draw(&s, &camera, &options, &other), EWA_OK);
    for (uint32_t i = 0; i < 4 * 240 * 120; i++) assert_true(fabsf(plain.rgba[i] - other.rgba[i]) < 2e-3f);
    close_stage(&s);
}

/// The same bytes for any number of threads, and with fewer planes; without a kind it is the plane picture.
TEST(test_same_bytes) {
    static shot one, more;
    const ewa_camera camera = make_camera(120, 60, 0.3, 0.2);
    const ewa_panorama_options kinds[] = {make_options(EWA_PANORAMA_NONE), make_options(EWA_PANORAMA_EQUIRECTANGULAR),
                                          make_options(EWA_PANORAMA_FISHEYE)};
    for (int k = 0; k < 3; k++) {
        for (uint32_t threads = 1; threads <= 3; threads += 2) {
            stage s;
            open_stage(threads, &s);
            shot *to = threads == 1 ? &one : &more;
            memset(to, 0, sizeof *to);
            if (k == 0 && threads == 3) {
                const ewa_frame frame = {to->rgba8, to->rgba, to->depth, to->normal, to->coverage};
                assert_int_equal(ewa_scene_draw(s.scene, s.renderer, &camera, NULL, &frame, NULL), EWA_OK);
            } else {
                assert_int_equal(draw(&s, &camera, &kinds[k], to), EWA_OK);
            }
            static uint8_t alone[4 * MAX_PIXELS];
            assert_int_equal(ewa_scene_draw_panorama(s.scene, s.renderer, &camera, NULL, &kinds[k], &(ewa_frame){.rgba8 = alone}, NULL), EWA_OK);
            assert_memory_equal(alone, to->rgba8, 4 * 120 * 60);
            close_stage(&s);
        }
        assert_memory_equal(&one, &more, offsetof(shot, stats));
    }
}

/// Who says nothing stands in the middle, upright.
TEST(test_place) {
    stage s;
    open_stage(1, &s);
    ewa_panorama_options options = make_options(EWA_PANORAMA_EQUIRECTANGULAR);
    WITH_DEFAULTS(ewa_view_options, view);
    view.width_px = 200, view.height_px = 100;
    ewa_camera camera;
    for (int k = 0; k < 3; k++) {
        memset(options.up_world, 0, sizeof options.up_world);
        if (k > 0) view.has_eye = true, memcpy(view.eye_world, (const double[3]){1, 2, 3}, sizeof view.eye_world);
        if (k == 2) options.up_world[0] = 1;
        assert_int_equal(ewa_scene_place_panorama(s.scene, &view, &options, &camera), EWA_OK);
        assert_int_equal(camera.width_px, 200);
        const double *m = camera.world_to_camera;
        for (int c = 0; c < 3; c++) {
            const double eye = -(m[c] * m[3] + m[4 + c] * m[7] + m[8 + c] * m[11]);
            assert_true(fabs(eye - (k > 0 ? c + 1 : EYE[c])) < 0.01);
        }
        const double *up = options.up_world;
        assert_true(k == 2 ? up[0] == 1 && up[1] == 0 : up[0] * up[0] + up[1] * up[1] + up[2] * up[2] == 1);
    }
    assert_int_equal(ewa_scene_place_panorama(s.scene, &view, NULL, &camera), EWA_ERROR_ARGUMENT);
    close_stage(&s);
}

/// Points have as many pixels as in a plane picture, of what is on no surface, too, and may be as large.
TEST(test_points) {
    static shot plain, other;
    stage s;
    open_stage(1, &s);
    const float places[4][3] = {{1.5f, -2, 30}, {0.5f, -1, 30}, {-0.5f, -2, 30}, {0.5f, -2.5f, 30.5f}};
    void *position = NULL;
    ewa_cloud *cloud = check_cloud_of(s.context, 4);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, &position), EWA_OK);
    memcpy(position, places, sizeof places);
    ewa_scene *scene = NULL;
    ewa_asset *asset = NULL;
    assert_int_equal(ewa_scene_create(s.context, NULL, &scene), EWA_OK);
    assert_int_equal(ewa_asset_create(s.context, &(ewa_asset_source){.cloud = cloud}, NULL, &asset), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
    ewa_asset_release(&asset);
    const ewa_camera camera = make_camera(240, 120, 0, 0);
    const ewa_panorama_options panorama = make_options(EWA_PANORAMA_EQUIRECTANGULAR);
    ewa_scene_options options;
    ewa_scene_get_options(scene, &options);
    memset(options.render.background, 0, sizeof options.render.background);
    const double sizes_px[] = {0, 6, 256, 257};
    for (int k = 0; k < 4; k++) {
        options.render.point_size_px = sizes_px[k];
        assert_int_equal(ewa_scene_draw_panorama(scene, s.renderer, &camera, &options, &panorama, &(ewa_frame){.rgba = k ? other.rgba : plain.rgba}, NULL),
                         k < 3 ? EWA_OK : EWA_ERROR_ARGUMENT);
        if (k == 1) assert_memory_equal(plain.rgba, other.rgba, sizeof(float) * 4 * 240 * 120); // dots of 6 pixels
    }
    double area_px = 0; // of the two at the horizon, ahead and to the right
    for (uint32_t y = 40; y < 80; y++)
        for (uint32_t x = 110; x < 200; x++) area_px += (double)plain.rgba[4 * (240 * y + x) + 3];
    print_message("discs of %.2f pixels\n", area_px / 2);
    assert_true(fabs(area_px / (2 * PI * 3 * 3) - 1) < 0.1);
    ewa_scene_destroy(&scene);
    ewa_cloud_destroy(&cloud);
    close_stage(&s);
}

/// Eye-dome lighting goes on where sides of the cube meet.
TEST(test_eye_dome) {
    static shot got;
    stage s;
    open_stage(2, &s);
    ewa_scene_options options;
    ewa_scene_get_options(s.scene, &options);
    options.render.eye_dome = 100;
    ewa_camera camera = make_camera(240, 120, 0, 0);
    for (int r = 0; r < 3; r++) // half-way to the sphere, so that depths differ
        camera.world_to_camera[4 * r + 3] -= 0.5 * RADIUS * camera.world_to_camera[4 * r + 1];
    const ewa_panorama_options panorama = make_options(EWA_PANORAMA_EQUIRECTANGULAR);
    assert_int_equal(ewa_scene_draw_panorama(s.scene, s.renderer, &camera, &options, &panorama, &(ewa_frame){.rgba = got.rgba}, NULL), EWA_OK);
    double most = 0;
    for (uint32_t y = 40; y < 80; y++) // across 45 degrees to the right
        for (uint32_t x = 145; x < 155; x++)
            for (uint32_t c = 0; c < 3; c++)
                most = fmax(most, fabs((double)got.rgba[4 * (240 * y + x) + c] - (double)got.rgba[4 * (240 * y + x + 1) + c]));
    print_message("from pixel to pixel at most %.4f\n", most);
    assert_true(most < 0.03);
    close_stage(&s);
}

TEST(test_refusals) {
    stage s;
    open_stage(1, &s);
    static shot got;
    ewa_camera camera = make_camera(120, 60, 0, 0);
    ewa_panorama_options options = make_options(EWA_PANORAMA_FISHEYE);
    options.fov_deg = 361;
    assert_int_equal(draw(&s, &camera, &options, &got), EWA_ERROR_ARGUMENT);
    options.fov_deg = 0.01; // whose sides would be huge
    assert_int_equal(draw(&s, &camera, &options, &got), EWA_ERROR_LIMIT);
    options = make_options(EWA_PANORAMA_EQUIRECTANGULAR);
    options.finer = 0.5;
    assert_int_equal(draw(&s, &camera, &options, &got), EWA_ERROR_ARGUMENT);
    options.finer = 1;
    camera.projection = EWA_ORTHOGRAPHIC;
    assert_int_equal(draw(&s, &camera, &options, &got), EWA_ERROR_ARGUMENT);
    camera.projection = EWA_PERSPECTIVE;
    camera.width_px = 0;
    assert_int_equal(draw(&s, &camera, &options, &got), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_scene_draw_panorama(NULL, s.renderer, &camera, NULL, &options, &(ewa_frame){NULL}, NULL), EWA_ERROR_ARGUMENT);
    close_stage(&s);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
