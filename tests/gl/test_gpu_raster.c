// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The paper's pipeline against the processor: pictures of at least 45 dB, whatever the options. Errors of OpenGL are
// failures of its frames.
#include "check.h"
#include "ewa/gpu.h"
#include "gl/raster.h"
#include "surface/render.h"

#include <math.h>

enum { WIDTH = 160, HEIGHT = 144, POINTS = 3000 };

typedef struct fixture {
    ewa_context *context;
    ewa_renderer *cpu, *raster; ///< raster: NULL, there is no device
    check_log log;
} fixture;

static fixture shared;

static int set_up(void **state) {
    shared.context = check_context(0, &shared.log);
    assert_int_equal(ewa_renderer_create(shared.context, &shared.cpu), EWA_OK);
    const ewa_status status = ewa_renderer_create_on(shared.context, EWA_BACKEND_GL_RASTER, &shared.raster);
    assert_true(status == EWA_OK || status == EWA_ERROR_UNSUPPORTED);
    if (status != EWA_OK) print_message("skipped: %s\n", shared.log.text);
    return 0;
}

static int tear_down(void **state) {
    ewa_renderer_destroy(&shared.cpu);
    ewa_renderer_destroy(&shared.raster);
    ewa_context_destroy(&shared.context);
    return 0;
}

/// Both renderers' frames.
typedef struct planes {
    uint8_t rgba8[4 * WIDTH * HEIGHT];
    float rgba[4 * WIDTH * HEIGHT], depth[WIDTH * HEIGHT], normal[3 * WIDTH * HEIGHT],
        coverage[WIDTH * HEIGHT];
} planes;

static planes drawn[2];

static ewa_frame frame_of(planes *to, bool floats) {
    if (!floats) return (ewa_frame){.rgba8 = to->rgba8};
    return (ewa_frame){to->rgba8, to->rgba, to->depth, to->normal, to->coverage};
}

static double decibels(double square_sum, size_t count) {
    return square_sum > 0 ? -10 * log10(square_sum / (double)count) : INFINITY;
}

static double bytes_db(const uint8_t *a, const uint8_t *b, size_t count) {
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        const double d = (a[i] - b[i]) / 255.0;
        sum += d * d;
    }
    return decibels(sum, count);
}

/// Of the finite numbers, over the largest of them; a thousandth of all may be infinite in one of both only.
static double floats_db(const float *a, const float *b, size_t count) {
    double sum = 0, largest = 1e-30;
    size_t other_count = 0;
    for (size_t i = 0; i < count; i++)
        if (isfinite(a[i])) largest = fmax(largest, fabs((double)a[i]));
    for (size_t i = 0; i < count; i++) {
        if (isfinite(a[i]) != isfinite(b[i])) other_count++;
        if (!isfinite(a[i]) || !isfinite(b[i])) continue;
        const double d = ((double)a[i] - (double)b[i]) / largest;
        sum += d * d;
    }
    return other_count * 1000 > count ? 0 : decibels(sum, count);
}

/// Sees to it that both frames are close.
static void compare(const char *what, bool floats) {
    const size_t pixels = WIDTH * HEIGHT;
    const double db = bytes_db(drawn[0].rgba8, drawn[1].rgba8, 4 * pixels);
    print_message("%-28s %.1f dB\n", what, db);
    size_t shown = 0;
    for (size_t i = 0; i < pixels; i++) shown += drawn[0].rgba8[4 * i + 3] > 0;
    assert_true(shown * 20 > pixels);
    assert_true(db >= 45);
    if (!floats) return;
    assert_true(floats_db(drawn[0].rgba, drawn[1].rgba, 4 * pixels) >= 45);
    assert_true(floats_db(drawn[0].depth, drawn[1].depth, pixels) >= 45);
    assert_true(floats_db(drawn[0].normal, drawn[1].normal, 3 * pixels) >= 45);
    assert_true(floats_db(drawn[0].coverage, drawn[1].coverage, pixels) >= 45);
}

typedef struct view {
    ewa_camera camera;
    ewa_render_options options;
    bool floats;
} view;

/// A view of all of a box from aside, `times` as far as that.
static view make_view(const ewa_bounds *bounds, ewa_projection projection, double times) {
    const double along[3] = {-0.3, 0.8, -0.5}, up[3] = {0, 0, 1};
    view made = {.floats = false};
    ewa_render_options_init(&made.options, sizeof made.options);
    ewa_camera_init(&made.camera);
    made.camera.width_px = WIDTH, made.camera.height_px = HEIGHT;
    assert_int_equal(ewa_camera_set_fov(&made.camera, 40), EWA_OK);
    made.camera.projection = projection;
    assert_int_equal(ewa_camera_frame(&made.camera, bounds, along, up, 0), EWA_OK);
    if (times == 1) return made;
    double eye[3], middle[3];
    ewa_camera_eye(&made.camera, eye);
    for (int i = 0; i < 3; i++) {
        middle[i] = (bounds->low_world[i] + bounds->high_world[i]) / 2;
        eye[i] = middle[i] + (eye[i] - middle[i]) * times;
    }
    assert_int_equal(ewa_camera_look_at(&made.camera, eye, middle, up), EWA_OK);
    return made;
}

static ewa_cloud *make_cloud(ewa_object object, bool sharp) {
    WITH_DEFAULTS(ewa_generate_options, options);
    options.object = object, options.point_count = POINTS, options.sharp = sharp;
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_generate(shared.context, &options, &cloud), EWA_OK);
    return cloud;
}

static ewa_surfels *make_surfels(ewa_object object, bool sharp, ewa_bounds *bounds) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(object, sharp);
    assert_int_equal(ewa_cloud_measure(cloud, bounds), EWA_OK);
    ewa_surfels *surfels = check_surfels(cloud, NULL);
    return surfels;
}

static void hold(const char *what, const ewa_surfels *surfels, const view *of) {
    for (int i = 0; i < 2; i++) {
        const ewa_frame frame = frame_of(&drawn[i], of->floats);
        ewa_renderer *renderer = i ? shared.raster : shared.cpu;
        assert_int_equal(ewa_render(renderer, surfels, &of->camera, &of->options, &frame, NULL), EWA_OK);
    }
    compare(what, of->floats);
}

TEST(test_kernels) {
    if (!shared.raster) skip();
    static const char *const names[] = {"perspective", "affine", "source", "circular", "raycast"};
    ewa_bounds bounds;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = make_surfels(EWA_OBJECT_SPHERE, false, &bounds);
    for (int kernel = 0; kernel < 5; kernel++) {
        view of = make_view(&bounds, EWA_PERSPECTIVE, 0.8);
        of.options.kernel = (ewa_kernel)kernel;
        of.options.edge_layers = 2;
        of.floats = kernel == 0;
        hold(names[kernel], surfels, &of);
    }
    view of = make_view(&bounds, EWA_PERSPECTIVE, 1);
    of.options.passes = 1; // not on a plane, where the nearest of all is chance
    hold("one pass", surfels, &of);
    of = make_view(&bounds, EWA_ORTHOGRAPHIC, 1);
    of.floats = true;
    hold("orthographic", surfels, &of);
    of.options.prefilter_px = 0;
    hold("no prefilter", surfels, &of);
}

TEST(test_options) {
    if (!shared.raster) skip();
    ewa_bounds bounds;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = make_surfels(EWA_OBJECT_TERRAIN, false, &bounds);
    const view plain = make_view(&bounds, EWA_PERSPECTIVE, 1);
    view of = plain;
    of.options.edge_antialiasing = false;
    hold("no antialiasing", surfels, &of);
    of = plain;
    of.options.point_size_px = 3;
    hold("points", surfels, &of);
    of = plain;
    of.options.opacity = 0.4, of.options.layers = 3;
    hold("three layers", surfels, &of);
    of = plain;
    of.options.eye_dome = 1, of.options.cull = EWA_CULL_BACK;
    hold("eye-dome, no back faces", surfels, &of);
    of = plain;
    of.options.shading = EWA_SHADING_PHONG;
    of.options.background[2] = of.options.background[3] = 0.5f;
    hold("highlights, background", surfels, &of);
    of = make_view(&bounds, EWA_PERSPECTIVE, 0.2);
    of.floats = true;
    hold("near", surfels, &of);
}

/// Of pixels in parts the device averages those of divisions that bands are made of; all planes, in bands, too.
TEST(test_parts) {
    if (!shared.raster) skip();
    ewa_bounds bounds;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = make_surfels(EWA_OBJECT_TORUS, false, &bounds);
    static const char *const names[] = {"", "", "2x2 parts", "3x3 parts", "4x4 parts"};
    for (uint32_t parts = 2; parts <= 4; parts++)
        for (int floats = 0; floats < 2; floats++) {
            view of = make_view(&bounds, EWA_PERSPECTIVE, 1.2);
            of.floats = floats != 0;
            of.options.supersampling = parts;
            of.options.background[0] = of.options.background[3] = 0.5f;
            hold(names[parts], surfels, &of);
        }
}

TEST(test_lines) {
    if (!shared.raster) skip();
    ewa_bounds bounds;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = make_surfels(EWA_OBJECT_CSG, true, &bounds);
    view of = make_view(&bounds, EWA_PERSPECTIVE, 1);
    of.floats = true;
    hold("clip lines", surfels, &of);
    const double sides[2][4] = {{0.6, 0, 0.8, 0.05}, {-1, 0.3, 0.1, 0.2}};
    memcpy(of.options.section_planes, sides, sizeof sides);
    of.options.section_count = 2;
    hold("section planes", surfels, &of);
    of.camera = make_view(&bounds, EWA_ORTHOGRAPHIC, 1).camera;
    hold("orthographic section planes", surfels, &of);
    of.options.section_count = 0;
    of.camera = make_view(&bounds, EWA_PERSPECTIVE, 0.15).camera;
    of.options.kernel = EWA_KERNEL_RAYCAST;
    hold("clip lines, near", surfels, &of);
}

/// Several sources of different weights; rows of a picture that is drawn in bands are those of the whole.
TEST(test_sources_and_bands) {
    if (!shared.raster) skip();
    ewa_bounds bounds;
    ewa_surfels *surfels[2] = {make_surfels(EWA_OBJECT_CUBE, false, &bounds),
                               make_surfels(EWA_OBJECT_SPHERE, false, &bounds)};
    const view of = make_view(&bounds, EWA_PERSPECTIVE, 1);
    for (int hides = 0; hides < 2; hides++) {
        for (int i = 0; i < 2; i++) {
            const ewa_frame frame = frame_of(&drawn[i], false);
            ewa_renderer *renderer = i ? shared.raster : shared.cpu;
            const ewa_render_source second = {0.25, hides != 0};
            assert_int_equal(ewa_render_begin(renderer, &of.camera, &of.options, &frame), EWA_OK);
            assert_int_equal(ewa_render_add(renderer, surfels[0]), EWA_OK);
            assert_int_equal(ewa_render_add_source(renderer, surfels[1], &second), EWA_OK);
            assert_int_equal(ewa_render_finish(renderer, NULL), EWA_OK);
        }
        compare(hides ? "two sources" : "one that hides nothing", false);
    }
    hold("whole", surfels[0], &of);
    static uint8_t whole[sizeof drawn[1].rgba8];
    memcpy(whole, drawn[1].rgba8, sizeof whole);
    memset(drawn[1].rgba8, 0, sizeof whole);
    const uint32_t rows[] = {0, 128, HEIGHT};
    for (int band = 1; band >= 0; band--) {
        const ewa_frame frame = frame_of(&drawn[1], false);
        assert_int_equal(ewa_render_begin(shared.raster, &of.camera, &of.options, &frame), EWA_OK);
        assert_int_equal(ewa_render_set_rows(shared.raster, rows[band], rows[band + 1]), EWA_OK);
        assert_int_equal(ewa_render_add(shared.raster, surfels[0]), EWA_OK);
        assert_int_equal(ewa_render_finish(shared.raster, NULL), EWA_OK);
    }
    assert_true(bytes_db(whole, drawn[1].rgba8, sizeof whole) >= 60);
    for (int i = 0; i < 2; i++) ewa_surfels_destroy(&surfels[i]);
}

/// Three materials, highlights and what mirrors: a sky of texels finer than pixels, which coarser levels are taken of.
TEST(test_materials) {
    if (!shared.raster) skip();
    enum { SKY_HEIGHT = 256, SKY_WIDTH = 2 * SKY_HEIGHT, MATERIALS = 3 };
    static float sky[3 * SKY_WIDTH * SKY_HEIGHT];
    for (uint32_t i = 0; i < SKY_WIDTH * SKY_HEIGHT; i++) {
        sky[3 * i] = (float)(i % SKY_WIDTH) / SKY_WIDTH;
        sky[3 * i + 1] = i / SKY_WIDTH % 8 < 4;
        sky[3 * i + 2] = 1 - (float)i / (SKY_WIDTH * SKY_HEIGHT);
    }
    const ewa_image image = {.context = shared.context,
                             .pixels = sky,
                             .width_px = SKY_WIDTH,
                             .height_px = SKY_HEIGHT,
                             .channel_count = 3};
    OWNED(ewa_environment_destroy) ewa_environment *environment = NULL;
    assert_int_equal(ewa_environment_create(&image, &environment), EWA_OK);
    ewa_cloud *cloud = make_cloud(EWA_OBJECT_SPHERE, false);
    uint8_t *codes = check_add(cloud, EWA_MATERIAL, EWA_U8, 1);
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) codes[i] = (uint8_t)(i / 500 % MATERIALS);
    ewa_bounds bounds;
    assert_int_equal(ewa_cloud_measure(cloud, &bounds), EWA_OK);
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(cloud, NULL);
    ewa_cloud_destroy(&cloud);
    ewa_material materials[MATERIALS];
    for (int i = 0; i < MATERIALS; i++) ewa_material_init(&materials[i]);
    materials[1].specular = 0.9f, materials[1].shininess = 8, materials[2].reflection = 0.8f;
    view of = make_view(&bounds, EWA_PERSPECTIVE, 1);
    of.options.shading = EWA_SHADING_PHONG;
    of.options.materials = materials, of.options.material_count = MATERIALS;
    ewa_light_init(&of.options.lights[0]);
    of.options.lights[0].direction_world[0] = 1;
    of.options.light_count = 1;
    hold("materials", surfels, &of);
    of.options.environment = environment;
    hold("environment", surfels, &of);
}

/// What is wider than any device's pictures is refused, with a reason; the renderer goes on.
TEST(test_refusal) {
    if (!shared.raster) skip();
    enum { WIDE = 65535 };
    ewa_bounds bounds;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = make_surfels(EWA_OBJECT_SPHERE, false, &bounds);
    view of = make_view(&bounds, EWA_PERSPECTIVE, 1);
    of.camera.width_px = WIDE, of.camera.height_px = 1;
    uint8_t *row = calloc(WIDE, 4);
    assert_non_null(row);
    const ewa_frame frame = {.rgba8 = row};
    assert_int_equal(ewa_render(shared.raster, surfels, &of.camera, &of.options, &frame, NULL),
                     EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(shared.log.text, "65535 pixels are wider than"));
    free(row);
    of = make_view(&bounds, EWA_PERSPECTIVE, 1);
    hold("after a refusal", surfels, &of);
}

/// The raster pipeline, of which the test sees the state.
static ewa_raster *watched;

static ewa_status create_watched(ewa_context *context, void **state) {
    const ewa_status status = ewa_raster_create(context, state);
    watched = status == EWA_OK ? *state : NULL;
    return status;
}

static const ewa_backend watched_backend = {
    .name = "watched", .create = create_watched, .destroy = ewa_raster_destroy, .draw = ewa_raster_draw};

/// Objects of the renderer's context; drivers count names up from 1.
typedef struct object_counts {
    uint32_t pictures, buffers, targets, programs;
} object_counts;

static object_counts count_objects(void) {
    enum { MAX_NAMES = 20000 };
    object_counts found = {0};
    assert_int_equal(ewa_gl_enter(watched->device), EWA_OK);
    for (GLuint name = 1; name < MAX_NAMES; name++) {
        found.pictures += glIsTexture(name);
        found.buffers += glIsBuffer(name);
        found.targets += glIsFramebuffer(name);
        found.programs += glIsProgram(name);
    }
    assert_int_equal(glGetError(), GL_NO_ERROR);
    ewa_gl_leave(watched->device);
    return found;
}

/// Other sizes and options leave no objects behind.
TEST(test_objects) {
    if (!shared.raster) skip();
    enum { TURNS = 61, WARM = 30 };
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = NULL;
    assert_int_equal(ewa_renderer_create_by(shared.context, &watched_backend, &renderer), EWA_OK);
    ewa_bounds bounds;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = make_surfels(EWA_OBJECT_CSG, true, &bounds);
    object_counts warm = {0};
    for (uint32_t i = 0; i < TURNS; i++) {
        view of = make_view(&bounds, EWA_PERSPECTIVE, 1);
        of.camera.width_px = 32 + i, of.camera.height_px = 16 + i * 11 % 40;
        of.options.edge_layers = 1 + i % 2;
        of.options.passes = i % 5 ? 3 : 1;
        const ewa_frame frame = frame_of(&drawn[1], i % 3 == 0);
        assert_int_equal(ewa_render(renderer, surfels, &of.camera, &of.options, &frame, NULL), EWA_OK);
        if (i == WARM) warm = count_objects(); // a frame like the last one
    }
    const object_counts last = count_objects();
    print_message("%u pictures, %u buffers, %u frame buffers, %u programs\n", last.pictures, last.buffers,
                  last.targets, last.programs);
    assert_true(warm.pictures > 0 && warm.buffers > 0 && warm.targets > 0 && warm.programs > 0);
    assert_memory_equal(&warm, &last, sizeof warm);
}

int main(void) { return RUN_TESTS(set_up, tear_down); }
