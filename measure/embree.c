// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The strongest other way to draw discs on a CPU, to be measured beside this one: rays against oriented discs
// with Embree 3 or 4. The nearest disc of each pixel's centre, no blending, no antialiasing, one headlight on
// the 8-bit colours as they are: less than ewa draws.
//
// ewa bench --scene peer --against build/release/measure/measure_embree
//
// measure_embree CLOUD.ply CAMERA.json THREADS [PICTURE.png]: a line with its name when the scene is built,
// then an empty line after each frame, which it draws for every line that it reads; `ewa bench --help` says
// more. The last frame becomes the picture.
#include "base/base.h"
#include "ewa/ewa.h"

#ifdef EWA_EMBREE_4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/// Packets of 8 rays, 4 x 2 pixels, are the fastest here, with single rays, packets of 4 and 16, and streams of
/// 256 at 1.0 to 1.3 times their time.
enum { TILE_PX = 32, PACKET_WIDTH = 4, PACKET_HEIGHT = 2, PACKET = PACKET_WIDTH * PACKET_HEIGHT };

static const float AMBIENT = 0.15f;

/// A scene, seen by a camera.
typedef struct ray_view {
    RTCScene scene;
    uint32_t width_px, height_px, columns; ///< columns: of tiles
    float eye_world[3];
    /// The ray through pixel (x, y) goes along right x + down y + corner.
    float right_world[3], down_world[3], corner_world[3];
    const uint8_t *colors; ///< 3 per point; NULL: white
    uint8_t *rgba8;
} ray_view;

static void fail(const char *what) {
    fprintf(stderr, "measure_embree: %s\n", what);
    exit(1);
}

static void on_error(void *user, enum RTCError code, const char *text) {
    (void)user, (void)code;
    fail(text);
}

static void on_message(void *user, ewa_severity severity, const char *text) {
    (void)user;
    if (severity == EWA_SEVERITY_ERROR) fprintf(stderr, "measure_embree: %s\n", text);
}

static void intersect(RTCScene scene, const int *valid, struct RTCRayHit8 *packet) {
#ifdef EWA_EMBREE_4
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect8(valid, scene, packet, &arguments);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(valid, scene, &context, packet);
#endif
}

static void make_rays(const ray_view *view, uint32_t x0, uint32_t y0, int valid[PACKET],
                      struct RTCRayHit8 *packet) {
    for (uint32_t i = 0; i < PACKET; i++) {
        const uint32_t x = x0 + i % PACKET_WIDTH, y = y0 + i / PACKET_WIDTH;
        const float column = (float)x, row = (float)y;
        valid[i] = x < view->width_px && y < view->height_px ? -1 : 0;
        packet->ray.org_x[i] = view->eye_world[0];
        packet->ray.org_y[i] = view->eye_world[1];
        packet->ray.org_z[i] = view->eye_world[2];
        packet->ray.dir_x[i] =
            column * view->right_world[0] + row * view->down_world[0] + view->corner_world[0];
        packet->ray.dir_y[i] =
            column * view->right_world[1] + row * view->down_world[1] + view->corner_world[1];
        packet->ray.dir_z[i] =
            column * view->right_world[2] + row * view->down_world[2] + view->corner_world[2];
        packet->ray.tnear[i] = 0;
        packet->ray.tfar[i] = INFINITY;
        packet->ray.time[i] = 0;
        packet->ray.mask[i] = ~0u;
        packet->ray.id[i] = packet->ray.flags[i] = 0;
        packet->hit.Ng_x[i] = packet->hit.Ng_y[i] = packet->hit.Ng_z[i] = 0;
        packet->hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
}

/// How much light each hit gives back: the cosine between its normal and its ray, and what comes from everywhere.
static void light_hits(const struct RTCRayHit8 *packet, float light[PACKET]) {
    for (int i = 0; i < PACKET; i++) {
        const float nx = packet->hit.Ng_x[i], ny = packet->hit.Ng_y[i], nz = packet->hit.Ng_z[i];
        const float dx = packet->ray.dir_x[i], dy = packet->ray.dir_y[i], dz = packet->ray.dir_z[i];
        const float squares = (nx * nx + ny * ny + nz * nz) * (dx * dx + dy * dy + dz * dz);
        light[i] = AMBIENT + (1 - AMBIENT) * fabsf(nx * dx + ny * dy + nz * dz) / sqrtf(squares);
    }
}

static void draw_tile(void *data, uint32_t tile, uint32_t worker) {
    (void)worker;
    static const uint8_t white[3] = {255, 255, 255};
    const ray_view *view = data;
    const uint32_t left = tile % view->columns * TILE_PX, top = tile / view->columns * TILE_PX;
    for (uint32_t y0 = top; y0 < top + TILE_PX && y0 < view->height_px; y0 += PACKET_HEIGHT)
        for (uint32_t x0 = left; x0 < left + TILE_PX && x0 < view->width_px; x0 += PACKET_WIDTH) {
            struct RTCRayHit8 packet;
            RTC_ALIGN(32) int valid[PACKET];
            float light[PACKET];
            make_rays(view, x0, y0, valid, &packet);
            intersect(view->scene, valid, &packet);
            light_hits(&packet, light);
            for (uint32_t i = 0; i < PACKET; i++) {
                if (!valid[i]) continue;
                const size_t pixel = (size_t)(y0 + i / PACKET_WIDTH) * view->width_px + x0 + i % PACKET_WIDTH;
                uint8_t *to = &view->rgba8[4 * pixel];
                const bool hit = packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
                const uint8_t *color =
                    hit && view->colors ? &view->colors[3 * (size_t)packet.hit.primID[i]] : white;
                for (int c = 0; c < 3; c++) to[c] = hit ? (uint8_t)((float)color[c] * light[i] + 0.5f) : 0;
                to[3] = hit ? 255 : 0;
            }
        }
}

static const ewa_attribute *find(const ewa_cloud *cloud, const char *name) {
    const ewa_attribute *attribute = ewa_cloud_find(cloud, name);
    if (!attribute) fail("the cloud needs positions, normals and radii");
    return attribute;
}

/// Discs as large as the cloud's radii, in Embree's best hierarchy.
static RTCScene build_scene(RTCDevice device, const ewa_cloud *cloud) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    const ewa_attribute *position = find(cloud, EWA_POSITION), *normal = find(cloud, EWA_NORMAL),
                        *radius = find(cloud, EWA_RADIUS);
    RTCGeometry discs = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT);
    float *place = rtcSetNewGeometryBuffer(discs, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                           4 * sizeof(float), count);
    float *direction = rtcSetNewGeometryBuffer(discs, RTC_BUFFER_TYPE_NORMAL, 0, RTC_FORMAT_FLOAT3,
                                               3 * sizeof(float), count);
    for (uint64_t i = 0; i < count; i++) {
        ewa_attribute_read_f32(position, i, 1, &place[4 * i]);
        ewa_attribute_read_f32(radius, i, 1, &place[4 * i + 3]);
    }
    ewa_attribute_read_f32(normal, 0, count, direction);
    rtcSetGeometryBuildQuality(discs, RTC_BUILD_QUALITY_HIGH);
    rtcCommitGeometry(discs);
    RTCScene scene = rtcNewScene(device);
    rtcAttachGeometry(scene, discs);
    rtcReleaseGeometry(discs);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(scene);
    return scene;
}

static void set_camera(const ewa_cloud *cloud, const ewa_camera *camera, ray_view *view) {
    if (camera->projection != EWA_PERSPECTIVE) fail("the camera has to be a perspective one");
    double eye_world[3], origin_world[3];
    ewa_camera_eye(camera, eye_world);
    ewa_cloud_origin(cloud, origin_world);
    for (int r = 0; r < 3; r++) {
        const double right = camera->world_to_camera[r] / camera->fx_px,
                     down = camera->world_to_camera[4 + r] / camera->fy_px;
        view->eye_world[r] = (float)(eye_world[r] - origin_world[r]);
        view->right_world[r] = (float)right;
        view->down_world[r] = (float)down;
        view->corner_world[r] = (float)((0.5 - camera->cx_px) * right + (0.5 - camera->cy_px) * down +
                                        camera->world_to_camera[8 + r]);
    }
    view->width_px = camera->width_px;
    view->height_px = camera->height_px;
    view->columns = (camera->width_px + TILE_PX - 1) / TILE_PX;
}

int main(int count, char **words) {
    if (count < 4 || count > 5) fail("give CLOUD.ply CAMERA.json THREADS [PICTURE.png]");
    ewa_context_options options;
    ewa_context_options_init(&options, sizeof options);
    options.thread_count = (uint32_t)atoi(words[3]);
    options.message = on_message;
    ewa_context *context;
    ewa_cloud *cloud;
    ewa_camera camera;
    ewa_camera_init(&camera);
    if (ewa_context_create(&options, &context) != EWA_OK) fail("cannot start its threads");
    if (ewa_cloud_load(context, words[1], &cloud) != EWA_OK) fail("no cloud");
    if (ewa_camera_load(context, words[2], 0, &camera) != EWA_OK) fail("no camera");
    char device_text[32];
    snprintf(device_text, sizeof device_text, "threads=%d", atoi(words[3]));
    RTCDevice device = rtcNewDevice(device_text);
    if (!device) fail("Embree does not start");
    rtcSetDeviceErrorFunction(device, on_error, NULL);
    ray_view view = {.scene = build_scene(device, cloud)};
    set_camera(cloud, &camera, &view);
    const ewa_attribute *color = ewa_cloud_find(cloud, EWA_COLOR);
    if (color && color->type == EWA_U8 && color->component_count == 3 && color->stride_bytes == 3)
        view.colors = color->data;
    view.rgba8 = malloc(4 * (size_t)view.width_px * view.height_px);
    if (!view.rgba8) fail("out of memory");
    const uint32_t tiles = view.columns * ((view.height_px + TILE_PX - 1) / TILE_PX);
    printf("Embree %s, nearest disc\n", RTC_VERSION_STRING);
    fflush(stdout);
    char line[64];
    while (fgets(line, sizeof line, stdin)) {
        ewa_parallel(context, draw_tile, &view, tiles);
        puts("");
        fflush(stdout);
    }
    if (count > 4 && ewa_png_save(context, words[4], view.width_px, view.height_px, 4, view.rgba8,
                                  4 * (size_t)view.width_px) != EWA_OK)
        fail("no picture");
    free(view.rgba8);
    rtcReleaseScene(view.scene);
    rtcReleaseDevice(device);
    ewa_cloud_destroy(&cloud);
    ewa_context_destroy(&context);
    return 0;
}
