// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volumes on the device: all planes are the processor's bytes, whatever the options, cameras, grids and kinds of numbers; what a frame
// asks of the device; what is left to the processor, and that this is said.
#include "check.h"
#include "gl/backends.h"
#include "gpu_scene.h"
#include "volume/backend.h"
#include "volume/scene.h"

#include <math.h>

enum { MAX_PX = 160, PLANES_FLOATS = 10 };

/// A frame's planes: 4 bytes, then floats.
typedef struct picture {
    float floats[PLANES_FLOATS * MAX_PX * MAX_PX];
} picture;

static picture by_device, by_processor;

static ewa_frame frame_of(picture *at) {
    const size_t pixels = MAX_PX * MAX_PX;
    memset(at, 0x5a, sizeof *at);
    return (ewa_frame){.rgba8 = (uint8_t *)at->floats,
                       .rgba = at->floats + pixels,
                       .depth = at->floats + 5 * pixels,
                       .normal = at->floats + 6 * pixels,
                       .coverage = at->floats + 9 * pixels};
}

/// Both renderers.
typedef struct pair {
    ewa_renderer *surfaces;
    ewa_volume_renderer *device, *processor;
} pair;

static void free_pair(pair *of) {
    ewa_volume_renderer_destroy(&of->device);
    ewa_volume_renderer_destroy(&of->processor);
    ewa_renderer_destroy(&of->surfaces);
}

static pair make_pair(ewa_context *context, ewa_backend_kind kind, const char *tuning) {
    pair made = {NULL, NULL, NULL};
    assert_int_equal(setenv("EWA_GL_TUNING", tuning, 1), 0);
    assert_int_equal(ewa_renderer_create_on(context, kind, &made.surfaces), EWA_OK);
    assert_int_equal(ewa_volume_renderer_create(context, &made.device), EWA_OK);
    assert_int_equal(ewa_gl_volume_attach(context, made.surfaces, made.device), EWA_OK);
    assert_int_equal(ewa_volume_renderer_create(context, &made.processor), EWA_OK);
    return made;
}

/// Draws a frame by both, which have the same bytes in all planes; returns what the device's renderer says.
static ewa_renderer_info draw_both(const pair *by, const ewa_voxels *voxels, const ewa_camera *camera,
                                   const ewa_volume_options *options, const char **remark) {
    const ewa_frame device = frame_of(&by_device), processor = frame_of(&by_processor);
    ewa_volume_stats stats, wanted;
    assert_int_equal(ewa_volume_render(by->device, voxels, camera, options, &device, &stats), EWA_OK);
    assert_int_equal(ewa_volume_render(by->processor, voxels, camera, options, &processor, &wanted), EWA_OK);
    ewa_renderer_info info = {.struct_size = sizeof info};
    const char *own_remark;
    const bool used = ewa_volume_renderer_describe(by->device, &info, remark ? remark : &own_remark);
    assert_true(used == (*info.device != 0));
    snprintf(info.backend, sizeof info.backend, "%s", used ? "gl" : "cpu");
    assert_memory_equal(&by_device, &by_processor, sizeof by_device);
    assert_int_equal(stats.voxel_count, wanted.voxel_count);
    assert_int_equal(stats.culled_count, wanted.culled_count);
    assert_true(stats.splat_count + stats.point_count >= (used ? 0 : wanted.splat_count + wanted.point_count));
    if (used && wanted.hidden_count == 0) {
        assert_int_equal(stats.splat_count, wanted.splat_count);
        assert_int_equal(stats.point_count, wanted.point_count);
    }
    return info;
}

static void assert_by_device(const ewa_renderer_info *info) {
    assert_string_equal(info->backend, "gl");
    assert_int_equal(info->wait_count, 1);
    assert_int_equal(info->readback_count, 1);
}

/// Tubes and, among them, a field of low values: neither empty nor flat anywhere.
static double tubes(const void *data, double x, double y, double z) {
    return scene_vessels(data, x, y, z) + 0.15 * (1 + sin(0.4 * x) * cos(0.3 * y + 0.2 * z));
}

static ewa_voxels *make_voxels(ewa_context *context, const uint32_t dims[3], const double spacing[3], float extinction) {
    const double half = 0.5 * dims[0] * spacing[0];
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, spacing, tubes, &half);
    ewa_transfer transfer = scene_linear(0.9f, 0.5f, 0.2f, extinction);
    transfer.points[1].color[2] = 0.8f;
    ewa_voxels *made;
    WITH_DEFAULTS(ewa_voxels_options, options);
    options.level_count = 2;
    assert_int_equal(ewa_voxels_create(&volume, &transfer, &options, &made), EWA_OK);
    return made;
}

static const uint32_t DIMS[3] = {22, 20, 25};
static const double UNIT[3] = {1, 1, 1}, AXIS[3] = {0, 0, 1}, SLANT[3] = {0.5, 0.35, -1};

/// Options, one of which is set in each row.
static void set_option(int row, ewa_volume_options *options) {
    ewa_volume_options_init(options, sizeof *options);
    options->shading = EWA_SHADING_PHONG;
    switch (row) {
    case 0: break;
    case 1: options->method = EWA_VOLUME_SPLATS; break;
    case 2: options->method = EWA_VOLUME_POINTS; break;
    case 3: options->shading = EWA_SHADING_NONE, options->background[0] = 0.5f, options->background[3] = 0.7f; break;
    case 4: options->shading = EWA_SHADING_LAMBERT, options->light_count = 2;
        ewa_light_init(&options->lights[0]), ewa_light_init(&options->lights[1]);
        options->lights[0].direction_world[0] = 1, options->lights[1].direction_world[1] = -2;
        break;
    case 5: options->minimum_transmittance = 0; break;
    case 6: options->minimum_transmittance = 0.4; break;
    case 7: options->sigma = 0.9, options->cutoff = 2.2, options->prefilter_px = 0.6; break;
    case 8: options->depth_unit = 2.5, options->mark_splats = true; break;
    case 9: options->level = 1, options->density_scale = 30; break;
    case 10: options->light_count = 1, ewa_light_init(&options->lights[0]), options->lights[0].direction_world[0] = 1;
        options->material.specular = 0.8f, options->material.shininess = 7; break;
    default: options->depth_unit = 0.3; break;
    }
}

enum { OPTION_ROWS = 12 };

TEST_ON(test_options, 2) {
    OWNED(free_pair) pair by = make_pair(context, EWA_BACKEND_GL, "");
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = make_voxels(context, DIMS, UNIT, 0.4f);
    for (int row = 0; row < OPTION_ROWS; row++)
        for (int far = 0; far < 2; far++) {
            if (row > 2 && far != row % 2) continue;
            ewa_volume_options options;
            set_option(row, &options);
            const ewa_camera camera = scene_camera(70, 53, SLANT, far ? 75 : 33);
            const ewa_renderer_info info = draw_both(&by, voxels, &camera, &options, NULL);
            assert_by_device(&info);
        }
}

/// From all sides, in parallel, from among the voxels, with the volume beside and behind the eye.
TEST_ON(test_cameras, 2) {
    OWNED(free_pair) pair by = make_pair(context, EWA_BACKEND_GL, "");
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = make_voxels(context, DIMS, UNIT, 0.3f);
    static const double directions[][3] = {{0, 0, 1}, {1, 0, 0}, {0, -1, 0.01}, {-0.6, 0.6, 0.5}};
    static const double distances[] = {-16, 0.5, 7, 14, 45, 200};
    for (size_t d = 0; d < 4; d++)
        for (size_t k = d % 2; k < 6; k += 2)
            for (int parallel = 0; parallel < 2; parallel++) {
                ewa_camera camera = scene_camera(70, 53, directions[d], distances[k]);
                if (parallel) {
                    camera.projection = EWA_ORTHOGRAPHIC;
                    camera.fx_px = camera.fy_px = 0.6 + 0.6 * (double)k;
                }
                camera.cx_px += 3.3 * (double)k;
                ewa_volume_options options;
                set_option(k % 2 ? 0 : 3, &options);
                const ewa_renderer_info info = draw_both(&by, voxels, &camera, &options, NULL);
                assert_by_device(&info);
            }
}

/// Section planes: across, slanted, together, before and behind all; of a picture from among the voxels, too.
TEST_ON(test_sections, 2) {
    OWNED(free_pair) pair by = make_pair(context, EWA_BACKEND_GL, "");
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = make_voxels(context, DIMS, UNIT, 0.3f);
    static const double planes[][4] = {{1, 0, 0, 0}, {0.3, -1, 0.5, 2}, {0, 0, -1, 3}, {0, 0, 1, -100}};
    for (uint32_t first = 0; first < 4; first++)
        for (int k = 0; k < 4; k++) {
            ewa_volume_options options;
            set_option(k, &options);
            options.section_count = first < 3 ? 1 + (uint32_t)k % (3 - first) : 1;
            memcpy(options.section_planes, planes[first], options.section_count * sizeof planes[0]);
            ewa_camera camera = scene_camera(70, 53, SLANT, k == 0 ? 8 : k == 3 ? 100 : 45);
            if (k == 1) camera.projection = EWA_ORTHOGRAPHIC, camera.fx_px = camera.fy_px = 1.5;
            const ewa_renderer_info info = draw_both(&by, voxels, &camera, &options, NULL);
            assert_by_device(&info);
        }
}

/// Flat, long and single voxels, empty and opaque ones.
TEST_ON(test_grids, 2) {
    OWNED(free_pair) pair by = make_pair(context, EWA_BACKEND_GL, "");
    static const struct {
        uint32_t dims[3];
        double spacing[3];
        float extinction;
    } grids[] = {{{18, 18, 9}, {1, 1, 3.7}, 0.3f}, {{6, 28, 20}, {4, 0.7, 1}, 0.5f}, {{23, 19, 1}, {1, 1, 1}, 2},
                 {{1, 1, 1}, {1, 1, 1}, 1},         {{20, 20, 20}, {1, 1, 1}, 60},    {{20, 20, 20}, {1, 1, 1}, 1e-6f},
                 {{9, 9, 9}, {1, 1, 1}, 0}};
    for (size_t g = 0; g < sizeof grids / sizeof grids[0]; g++) {
        OWNED(ewa_voxels_destroy) ewa_voxels *voxels = make_voxels(context, grids[g].dims, grids[g].spacing, grids[g].extinction);
        for (int far = 0; far < 2; far++) {
            ewa_volume_options options;
            set_option(0, &options);
            const ewa_camera camera = scene_camera(47, 71, far ? AXIS : SLANT, far ? 90 : 40);
            const ewa_renderer_info info = draw_both(&by, voxels, &camera, &options, NULL);
            assert_by_device(&info);
        }
    }
}

/// Numbers of 8 and 16 bits.
TEST_ON(test_kinds, 1) {
    OWNED(free_pair) pair by = make_pair(context, EWA_BACKEND_GL, "");
    static const ewa_type types[] = {EWA_U8, EWA_I16};
    for (int t = 0; t < 2; t++) {
        OWNED(ewa_volume_free) ewa_volume volume = {.context = NULL};
        assert_int_equal(ewa_volume_create(context, DIMS, types[t], &volume), EWA_OK);
        for (uint32_t i = 0; i < DIMS[0] * DIMS[1] * DIMS[2]; i++) {
            const uint32_t value = i * 2654435761u >> 24;
            if (t) ((int16_t *)volume.voxels)[i] = (int16_t)(value * 17 - 900);
            else ((uint8_t *)volume.voxels)[i] = (uint8_t)value;
        }
        ewa_transfer transfer = {.point_count = 2};
        transfer.points[0] = (ewa_transfer_point){t ? 900.0f : 120.0f, {0.1f, 0.5f, 0.9f}, 0};
        transfer.points[1] = (ewa_transfer_point){t ? 3000.0f : 255.0f, {0.9f, 0.5f, 0.9f}, 0.3f};
        OWNED(ewa_voxels_destroy) ewa_voxels *voxels = NULL;
        assert_int_equal(ewa_voxels_create(&volume, &transfer, NULL, &voxels), EWA_OK);
        ewa_volume_options options;
        set_option(0, &options);
        const ewa_camera camera = scene_camera(60, 60, SLANT, 50);
        const ewa_renderer_info info = draw_both(&by, voxels, &camera, &options, NULL);
        assert_by_device(&info);
    }
}

/// Neither how often a picture waits for the next dispatch, nor in how many parts its tiles are drawn, nor how a device's arithmetic is
/// helped changes a byte.
TEST_ON(test_division, 1) {
    static const char *const tunings[] = {"", "turns=60", "storage=1400000", "storage=1400000 turns=900", "groups=99", "arith=emulated"};
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = make_voxels(context, DIMS, UNIT, 0.4f);
    uint32_t dispatches[6];
    for (int i = 0; i < 6; i++) {
        OWNED(free_pair) pair by = make_pair(context, EWA_BACKEND_GL, tunings[i]);
        for (int near = 0; near < 3; near++) {
            ewa_volume_options options;
            set_option(near == 2 ? 0 : near, &options);
            const ewa_camera camera = scene_camera(140, 70, SLANT, near == 2 ? 11 : 38);
            const ewa_renderer_info info = draw_both(&by, voxels, &camera, &options, NULL);
            assert_by_device(&info);
            dispatches[i] = info.dispatch_count;
        }
        assert_int_equal(setenv("EWA_GL_TUNING", "", 1), 0);
    }
    for (int i = 1; i < 4; i++) assert_true(dispatches[i] > dispatches[0]);
}

/// Voxels are sent once, and those of another volume in their place.
TEST_ON(test_residence, 1) {
    OWNED(free_pair) pair by = make_pair(context, EWA_BACKEND_GL, "turns=1000000");
    OWNED(ewa_voxels_destroy) ewa_voxels *one = make_voxels(context, DIMS, UNIT, 0.4f);
    OWNED(ewa_voxels_destroy) ewa_voxels *other = make_voxels(context, DIMS, UNIT, 0.1f);
    ewa_volume_options options;
    set_option(2, &options);
    const ewa_camera camera = scene_camera(64, 64, AXIS, 90);
    ewa_voxels_info about;
    ewa_voxels_describe(one, &about);
    const uint64_t voxel_bytes = 16 * about.occupied_count;
    uint64_t bytes[5];
    for (int i = 0; i < 5; i++) bytes[i] = draw_both(&by, i == 2 || i == 3 ? other : one, &camera, &options, NULL).upload_bytes;
    assert_true(bytes[0] >= bytes[1] + voxel_bytes);
    assert_true(bytes[1] < voxel_bytes / 8);
    assert_int_equal(bytes[2], bytes[1] + voxel_bytes);
    assert_int_equal(bytes[3], bytes[1]);
    assert_int_equal(bytes[4], bytes[2]);
    // Points alone take a program for records and one for pixels.
    const ewa_renderer_info info = draw_both(&by, one, &camera, &options, NULL);
    assert_int_equal(info.dispatch_count, 2);
    assert_int_equal(info.readback_bytes, 64 + 4ull * 64 * 64 * (1 + 4 + 1 + 1));
}

static void assert_left(const pair *by, const ewa_voxels *voxels, const ewa_volume_options *options, const char *why) {
    const ewa_camera camera = scene_camera(50, 40, SLANT, 80);
    const char *remark;
    ewa_renderer_info info = draw_both(by, voxels, &camera, options, &remark);
    assert_string_equal(info.backend, "cpu");
    assert_non_null(strstr(remark, why));
    ewa_volume_options plain;
    set_option(0, &plain);
    info = draw_both(by, voxels, &camera, &plain, &remark);
    assert_by_device(&info);
    assert_string_equal(remark, "");
}

/// What the device does not draw is the processor's, which the renderer says; the next frame is the device's again.
TEST_ON(test_left, 1) {
    OWNED(free_pair) pair by = make_pair(context, EWA_BACKEND_GL, "");
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = make_voxels(context, DIMS, UNIT, 0.4f);
    ewa_volume_options options;
    set_option(1, &options);
    options.index = EWA_INDEX_TABLE;
    assert_left(&by, voxels, &options, "footprints");
    set_option(0, &options);
    static float depth[50 * 40], rgba[4 * 50 * 40];
    for (size_t i = 0; i < 50 * 40; i++) depth[i] = 80, rgba[4 * i + 3] = 1;
    options.surface_depth = depth, options.surface_rgba = rgba;
    assert_left(&by, voxels, &options, "surfaces");
    free_pair(&by);
    by = make_pair(context, EWA_BACKEND_GL, "storage=800000");
    OWNED(ewa_voxels_destroy) ewa_voxels *many = make_voxels(context, (const uint32_t[3]){40, 36, 40}, UNIT, 0.4f);
    const ewa_camera camera = scene_camera(20, 20, SLANT, 90);
    const char *remark;
    set_option(0, &options);
    assert_string_equal(draw_both(&by, many, &camera, &options, &remark).backend, "cpu");
    assert_non_null(strstr(remark, "buffers"));
    assert_int_equal(setenv("EWA_GL_TUNING", "", 1), 0);
}

/// A device that is lost is a failure where it was asked for; else the processor draws, and nothing is missing.
TEST_ON(test_lost, 1) {
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = make_voxels(context, DIMS, UNIT, 0.4f);
    const ewa_camera camera = scene_camera(50, 40, SLANT, 80);
    OWNED(free_pair) pair by = make_pair(context, EWA_BACKEND_GL, "lose=1");
    const ewa_frame frame = frame_of(&by_device);
    for (int i = 0; i < 2; i++)
        assert_int_equal(ewa_volume_render(by.device, voxels, &camera, NULL, &frame, NULL), EWA_ERROR_UNSUPPORTED);
    free_pair(&by);
    by = make_pair(context, EWA_BACKEND_AUTO, "software=1 auto=gl lose=2");
    for (int i = 0; i < 6; i++) draw_both(&by, voxels, &camera, NULL, NULL);
    assert_int_equal(setenv("EWA_GL_TUNING", "", 1), 0);
}

/// The processor draws the first frame, both are measured, then the faster draws; other volumes are measured anew.
TEST_ON(test_auto, 1) {
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = make_voxels(context, DIMS, UNIT, 0.4f);
    OWNED(ewa_voxels_destroy) ewa_voxels *small = make_voxels(context, (const uint32_t[3]){9, 9, 9}, UNIT, 0.4f);
    const ewa_camera camera = scene_camera(50, 40, SLANT, 80);
    OWNED(free_pair) pair by = make_pair(context, EWA_BACKEND_AUTO, "software=1 auto=gl");
    for (int turn = 0; turn < 2; turn++) {
        static const char *const wanted[] = {"cpu", "gl", "cpu", "gl", "gl", "gl"};
        const char *remark;
        for (int i = 0; i < 6; i++)
            assert_string_equal(draw_both(&by, turn ? small : voxels, &camera, NULL, &remark).backend, wanted[i]);
        assert_non_null(strstr(remark, "ms by the device"));
    }
    free_pair(&by);
    by = make_pair(context, EWA_BACKEND_AUTO, "");
    const char *remark;
    for (int i = 0; i < 3; i++) assert_string_equal(draw_both(&by, voxels, &camera, NULL, &remark).backend, "cpu");
    if (strstr(remark, "software") == NULL) print_message("a device that is no software: %s\n", remark);
}

/// A scene says what drew its picture.
TEST_ON(test_scene, 1) {
    OWNED(ewa_scene_destroy) ewa_scene *scene = NULL;
    assert_int_equal(ewa_scene_create(context, NULL, &scene), EWA_OK);
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, DIMS, UNIT, scene_ones, NULL);
    const ewa_transfer transfer = scene_linear(0.9f, 0.5f, 0.2f, 0.4f);
    OWNED(ewa_asset_release) ewa_asset *asset = NULL;
    const ewa_asset_source source = {.name = "ones", .volume = &volume, .transfer = &transfer};
    assert_int_equal(ewa_asset_create(context, &source, NULL, &asset), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
    assert_int_equal(setenv("EWA_GL_TUNING", "", 1), 0);
    OWNED(ewa_scene_renderer_destroy) ewa_scene_renderer *renderer = NULL;
    assert_int_equal(ewa_scene_renderer_create(context, EWA_BACKEND_GL, NULL, &renderer), EWA_OK);
    const ewa_camera camera = scene_camera(64, 48, SLANT, 90);
    WITH_DEFAULTS(ewa_scene_options, options);
    for (int tabled = 0; tabled < 2; tabled++) {
        options.volumes.index = tabled ? EWA_INDEX_TABLE : EWA_INDEX_EXACT;
        const ewa_frame frame = frame_of(&by_device);
        assert_int_equal(ewa_scene_draw(scene, renderer, &camera, &options, &frame, NULL), EWA_OK);
        ewa_renderer_info info = {.struct_size = sizeof info};
        assert_int_equal(ewa_scene_renderer_describe(renderer, &info), EWA_OK);
        assert_string_equal(info.mixture, tabled ? "cpu" : "gl");
        assert_true(tabled ? strstr(info.mixture_remark, "footprints") != NULL : info.dispatch_count > 1 && !*info.mixture_remark);
    }
}

int main(void) {
    if (!gpu_there()) return 77;
    return RUN_TESTS(NULL, NULL);
}
