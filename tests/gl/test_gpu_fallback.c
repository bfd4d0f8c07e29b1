// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a back end says and does where the device is missing, too small, lost or hangs: an error with its reason, and under
// EWA_BACKEND_AUTO the processor's frame, byte by byte. EWA_GL_TUNING makes it so.
#include "gpu_scene.h"

#include <unistd.h>

enum { POINTS = 2000, WIDTH_PX = 48, HEIGHT_PX = 40 };

static gpu_scene at;
static uint8_t rgba8[4 * GPU_MAX_PX * GPU_MAX_PX];

static int enter(void **state) {
    gpu_scene_make(&at, POINTS, WIDTH_PX, HEIGHT_PX);
    return 0;
}

static int leave(void **state) {
    unsetenv("EWA_GL_TUNING");
    gpu_scene_free(&at);
    return 0;
}

static void tune(const char *text) { assert_int_equal(setenv("EWA_GL_TUNING", text, 1), 0); }

static ewa_renderer *make(ewa_backend_kind kind) {
    ewa_renderer *made = NULL;
    assert_int_equal(ewa_renderer_create_on(at.context, kind, &made), EWA_OK);
    return made;
}

static void assert_says(const char *word) {
    if (!strstr(at.log.text, word)) fail_msg("'%s' says nothing of '%s'", at.log.text, word);
}

/// Draws frames by the renderer, each the processor's.
static void draw_same(ewa_renderer *renderer, int frames) {
    for (int i = 0; i < frames; i++) {
        memset(rgba8, 0, sizeof rgba8);
        assert_int_equal(gpu_scene_draw(&at, renderer, rgba8), EWA_OK);
        assert_true(gpu_scene_same(&at, rgba8));
    }
}

static void test_no_device(void **state) {
    tune("nodevice=1");
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = NULL;
    assert_int_equal(ewa_renderer_create_on(at.context, EWA_BACKEND_GL, &renderer), EWA_ERROR_UNSUPPORTED);
    assert_null(renderer);
    assert_says("OpenGL: ");
    const bool built = strstr(at.log.text, "EWA_WITH_GL") == NULL;
    if (built && access("/dev/dri", F_OK) != 0 && access("/dev/nvidiactl", F_OK) != 0)
        assert_says("a container has to be given the files");
    ewa_gpu_info info = {.struct_size = sizeof info};
    assert_int_equal(ewa_gpu_describe(at.context, &info), EWA_ERROR_UNSUPPORTED);
    at.log.count = 0;
    renderer = make(EWA_BACKEND_AUTO);
    draw_same(renderer, 3);
    assert_int_equal(at.log.count, 0); // nothing is missed
    assert_string_equal(gpu_backend(renderer), "cpu");
    ewa_renderer_info what = {.struct_size = sizeof what};
    assert_int_equal(ewa_renderer_describe(renderer, &what), EWA_OK);
    assert_true(what.remark[0] != 0 && what.device[0] == 0 && what.device_class == EWA_GPU_NONE);
}

static void test_arguments(void **state) {
    tune("");
    ewa_renderer *renderer = NULL;
    assert_int_equal(ewa_renderer_create_on(at.context, (ewa_backend_kind)77, &renderer), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_renderer_create_on(NULL, EWA_BACKEND_CPU, &renderer), EWA_ERROR_ARGUMENT);
    ewa_gpu_info info = {.struct_size = sizeof info + 1};
    assert_int_equal(ewa_gpu_describe(at.context, &info), EWA_ERROR_ARGUMENT);
    renderer = make(EWA_BACKEND_CPU);
    // A caller of an older library gets the members that it knows.
    struct {
        ewa_renderer_info info;
    } short_one;
    memset(&short_one, 0x5a, sizeof short_one);
    short_one.info.struct_size = offsetof(ewa_renderer_info, device);
    assert_int_equal(ewa_renderer_describe(renderer, &short_one.info), EWA_OK);
    assert_string_equal(short_one.info.backend, "cpu");
    assert_int_equal((uint8_t)short_one.info.device[0], 0x5a);
    short_one.info.struct_size = 3;
    assert_int_equal(ewa_renderer_describe(renderer, &short_one.info), EWA_ERROR_ARGUMENT);
    ewa_renderer_destroy(&renderer);
    for (int k = 0; k <= EWA_GPU_EXACT; k++)
        assert_true(ewa_gpu_class_name((ewa_gpu_class)k)[0] != 'u' || k == 1);
}

/// Software is not what anybody wants to wait for.
static void test_software_is_not_taken(void **state) {
    tune("");
    ewa_gpu_info info = {.struct_size = sizeof info};
    assert_int_equal(ewa_gpu_describe(at.context, &info), EWA_OK);
    if (!info.software) return;
    at.log.count = 0;
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = make(EWA_BACKEND_AUTO);
    for (int i = 0; i < 6; i++) {
        draw_same(renderer, 1);
        assert_string_equal(gpu_backend(renderer), "cpu");
    }
    assert_int_equal(at.log.count, 0);
}

/// Both are measured; the bytes never tell which it was.
static void test_both_draw(void **state) {
    tune("software=1 auto=gl");
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = make(EWA_BACKEND_AUTO);
    static const char *const wanted[] = {"cpu", "gl", "cpu", "gl", "gl"};
    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++) {
        draw_same(renderer, 1);
        assert_string_equal(gpu_backend(renderer), wanted[i]);
    }
    at.options.supersampling = 2; // of more pixels: measured anew
    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++) {
        draw_same(renderer, 1);
        assert_string_equal(gpu_backend(renderer), wanted[i]);
    }
    at.options.supersampling = 0;
    draw_same(renderer, 4);
    gpu_scene_resize(&at, 2 * WIDTH_PX, 2 * HEIGHT_PX);
    draw_same(renderer, 1);
    assert_string_equal(gpu_backend(renderer), "cpu");
    draw_same(renderer, 1);
    assert_string_equal(gpu_backend(renderer), "gl");
    gpu_scene_resize(&at, WIDTH_PX, HEIGHT_PX);
    ewa_renderer_destroy(&renderer);
    tune("software=1"); // the processor is faster here
    renderer = make(EWA_BACKEND_AUTO);
    draw_same(renderer, 5);
    ewa_gpu_info info = {.struct_size = sizeof info};
    assert_int_equal(ewa_gpu_describe(at.context, &info), EWA_OK);
    if (info.software) assert_string_equal(gpu_backend(renderer), "cpu");
}

/// A frame that is the mean of two pictures decides for each of them: both are drawn by the device in the end.
static void test_means_of_two(void **state) {
    enum { FRAME_BYTES = 4 * WIDTH_PX * HEIGHT_PX };
    static uint8_t fixed[FRAME_BYTES];
    tune("software=1 auto=gl");
    const ewa_camera before = at.camera;
    OWNED(ewa_renderer_destroy) ewa_renderer *cpu = make(EWA_BACKEND_CPU), *both = make(EWA_BACKEND_AUTO);
    int found = 0;
    for (int step = 0; step < 60 && !found; step++) {
        at.camera.fx_px *= 0.96, at.camera.fy_px *= 0.96;
        bool mixed = true;
        for (at.options.supersampling = 1; at.options.supersampling <= 4; at.options.supersampling *= 2) {
            assert_int_equal(gpu_scene_draw(&at, cpu, fixed), EWA_OK);
            const uint32_t parts = at.options.supersampling;
            at.options.supersampling = 0;
            assert_int_equal(gpu_scene_draw(&at, cpu, rgba8), EWA_OK);
            at.options.supersampling = parts;
            mixed = mixed && memcmp(fixed, rgba8, FRAME_BYTES) != 0;
        }
        found = mixed;
    }
    assert_true(found);
    at.options.supersampling = 0;
    draw_same(both, 5);
    assert_string_equal(gpu_backend(both), "gl");
    at.options.supersampling = 0;
    at.camera = before;
}

/// The device ends in one of the waits of a frame; whichever it is, nothing is missing from the picture.
static void test_device_goes(void **state) {
    static const char *const ways[] = {"lose", "hang"}, *const said[] = {"was reset", "hangs"};
    for (int way = 0; way < 2; way++)
        for (int wait = 1; wait <= 4; wait++) {
            char text[64];
            snprintf(text, sizeof text, "%s=%d software=1 auto=gl", ways[way], wait);
            tune(text);
            OWNED(ewa_renderer_destroy) ewa_renderer *renderer = make(EWA_BACKEND_GL);
            ewa_status status = EWA_OK;
            for (int i = 0; i < 4 && status == EWA_OK; i++) status = gpu_scene_draw(&at, renderer, rgba8);
            assert_int_equal(status, EWA_ERROR_UNSUPPORTED);
            assert_says(said[way]);
            assert_int_equal(gpu_scene_draw(&at, renderer, rgba8), EWA_ERROR_UNSUPPORTED); // and stays so
            ewa_renderer_destroy(&renderer);
            at.log.count = 0;
            renderer = make(EWA_BACKEND_AUTO);
            draw_same(renderer, 6);
            assert_int_equal(at.log.count, 2); // why, and what follows from it
            assert_says("the CPU draws from here on");
            assert_string_equal(gpu_backend(renderer), "cpu");
        }
}

/// Storage so small that frames are drawn in bands, then so small that none can be drawn.
static void test_little_memory(void **state) {
    gpu_scene_resize(&at, 96, 384);
    tune("storage=1500000");
    at.log.count = 0;
    ewa_renderer *renderer = make(EWA_BACKEND_GL);
    draw_same(renderer, 1);
    assert_true(at.log.count > 0);
    assert_says("bytes for");
    ewa_renderer_destroy(&renderer);
    tune("storage=3000");
    renderer = NULL;
    ewa_status status = ewa_renderer_create_on(at.context, EWA_BACKEND_GL, &renderer);
    if (status == EWA_OK) status = gpu_scene_draw(&at, renderer, rgba8);
    assert_int_equal(status, EWA_ERROR_LIMIT);
    ewa_renderer_destroy(&renderer);
    tune("storage=700000 software=1 auto=gl"); // the self-test fits, a frame does not
    at.log.count = 0;
    renderer = make(EWA_BACKEND_AUTO);
    draw_same(renderer, 4);
    assert_true(at.log.count > 0);
    assert_says("the CPU draws this scene");
    assert_string_equal(gpu_backend(renderer), "cpu");
    gpu_scene_resize(&at, 16, 16); // another scene: the device is still there
    draw_same(renderer, 2);
    assert_string_equal(gpu_backend(renderer), "gl");
    ewa_renderer_destroy(&renderer);
    gpu_scene_resize(&at, WIDTH_PX, HEIGHT_PX);
}

/// A device that has too few storage blocks is none for this pipeline; one that takes few groups at a time
/// gets them in turns.
static void test_small_limits(void **state) {
    tune("blocks=8");
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = NULL;
    assert_int_equal(ewa_renderer_create_on(at.context, EWA_BACKEND_GL, &renderer), EWA_ERROR_UNSUPPORTED);
    assert_says("8 storage blocks");
    ewa_gpu_info info = {.struct_size = sizeof info};
    assert_int_equal(ewa_gpu_describe(at.context, &info), EWA_OK);
    assert_int_equal(info.device_class, EWA_GPU_UNUSABLE);
    assert_int_equal(info.storage_count, 8);
    tune("bindings=15");
    assert_int_equal(ewa_renderer_create_on(at.context, EWA_BACKEND_GL, &renderer), EWA_ERROR_UNSUPPORTED);
    assert_says("15 places");
    at.log.count = 0;
    tune("blocks=8 software=1");
    renderer = make(EWA_BACKEND_AUTO);
    draw_same(renderer, 3);
    assert_int_equal(at.log.count, 0);
    ewa_renderer_destroy(&renderer);
    tune("groups=3 unit=64");
    renderer = make(EWA_BACKEND_GL);
    draw_same(renderer, 2);
    ewa_renderer_destroy(&renderer);
    tune("plain=1"); // and one that cannot tell of resets draws all the same
    renderer = make(EWA_BACKEND_GL);
    draw_same(renderer, 2);
}

/// A driver that ends long loops, as llvmpipe does, is given fewer splats behind edges at a time until it leaves nothing out. Where
/// one list is too long, no such picture is given.
static void test_loops_that_end(void **state) {
    enum { DENSE = 600000, DENSE_PX = 24 };
    tune("");
    gpu_scene dense;
    gpu_scene_make(&dense, DENSE, DENSE_PX, DENSE_PX);
    dense.options.supersampling = 1;
    ewa_renderer *renderer = NULL;
    assert_int_equal(ewa_renderer_create_on(dense.context, EWA_BACKEND_GL, &renderer), EWA_OK);
    for (int frame = 0; frame < 2; frame++) {
        assert_int_equal(gpu_scene_draw(&dense, renderer, rgba8), EWA_OK);
        assert_true(gpu_scene_same(&dense, rgba8));
    }
    ewa_renderer_info info = {.struct_size = sizeof info};
    assert_int_equal(ewa_renderer_describe(renderer, &info), EWA_OK);
    print_message("%s: %u dispatches, %u wait\n", info.device, info.dispatch_count, info.wait_count);
    assert_int_equal(info.wait_count, 1); // how it is divided is remembered
    ewa_renderer_destroy(&renderer);
    tune("unit=1000000 edge_units=1");
    dense.log.count = 0;
    assert_int_equal(ewa_renderer_create_on(dense.context, EWA_BACKEND_GL, &renderer), EWA_OK);
    const ewa_status drawn = gpu_scene_draw(&dense, renderer, rgba8);
    print_message("all at once: %s\n", drawn == EWA_OK ? "drawn" : dense.log.text);
    if (drawn == EWA_OK)
        assert_true(gpu_scene_same(&dense, rgba8));
    else
        assert_true(info.remark[0] && drawn == EWA_ERROR_LIMIT && strstr(dense.log.text, "too many splats"));
    ewa_renderer_destroy(&renderer);
    gpu_scene_free(&dense);
}

/// Rounds behind edges end somewhere: of so many splats in a tile that no number of them is enough the frame is refused.
static void test_rounds_end(void **state) {
    enum { DENSE = 20000, ONE_TILE_PX = 8 };
    gpu_scene dense;
    gpu_scene_make(&dense, DENSE, ONE_TILE_PX, ONE_TILE_PX);
    dense.options.supersampling = 1;
    tune("unit=1 edge_units=1");
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = NULL;
    assert_int_equal(ewa_renderer_create_on(dense.context, EWA_BACKEND_GL, &renderer), EWA_OK);
    assert_int_equal(gpu_scene_draw(&dense, renderer, rgba8), EWA_ERROR_LIMIT);
    assert_non_null(strstr(dense.log.text, "rounds of 1 units"));
    dense.options.edge_layers = 1; // and what it has left in buffers shows in no other
    assert_int_equal(gpu_scene_draw(&dense, renderer, rgba8), EWA_OK);
    assert_true(gpu_scene_same(&dense, rgba8));
    ewa_renderer_destroy(&renderer);
    gpu_scene_free(&dense);
}

int main(void) {
    const struct CMUnitTest always[] = {
        cmocka_unit_test(test_no_device),
        cmocka_unit_test(test_arguments),
    };
    const struct CMUnitTest with_device[] = {
        cmocka_unit_test(test_software_is_not_taken), cmocka_unit_test(test_both_draw),
        cmocka_unit_test(test_means_of_two),
        cmocka_unit_test(test_device_goes),           cmocka_unit_test(test_little_memory),
        cmocka_unit_test(test_small_limits),          cmocka_unit_test(test_loops_that_end),
        cmocka_unit_test(test_rounds_end),
    };
    const int failed = cmocka_run_group_tests(always, enter, leave);
    if (failed || !gpu_there()) return failed;
    return cmocka_run_group_tests(with_device, enter, leave);
}
