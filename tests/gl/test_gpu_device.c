// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How a device is classed, that pictures of a close one are close, and that a renderer leaves nothing behind.
#include "gl/compute.h"
#include "gpu_scene.h"

#include <math.h>
#include <unistd.h>

static void tune(const char *text) { assert_int_equal(setenv("EWA_GL_TUNING", text, 1), 0); }

static ewa_gl_verdict try_arithmetic(const char *text) {
    tune(text);
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    OWNED(ewa_gl_close) ewa_gl *device = NULL;
    assert_int_equal(ewa_gl_open(context, &device), EWA_OK);
    ewa_gl_verdict verdict;
    assert_int_equal(ewa_gl_try(device, &verdict), EWA_OK);
    assert_true(ewa_gl_enter(device) == EWA_OK && glGetError() == GL_NO_ERROR);
    ewa_gl_leave(device);
    return verdict;
}

/// Emulation gives the bits of the processor where a device's own operations do not; without it, it is only close.
TEST_ON(test_classes, 1) {
    const ewa_gl_verdict own = try_arithmetic(""), emulated = try_arithmetic("arith=emulated"),
                         close = try_arithmetic("arith=close");
    assert_true(emulated.exact && !emulated.differs);
    assert_false(emulated.arithmetic.fused || emulated.arithmetic.divides || emulated.arithmetic.roots);
    assert_true(own.exact && !own.differs);
    const bool all_own = own.arithmetic.fused && own.arithmetic.divides && own.arithmetic.roots;
    assert_true(close.arithmetic.fused && close.arithmetic.divides && close.arithmetic.roots);
    assert_int_equal(close.exact, all_own);
    assert_true(close.exact || close.differs);
    ewa_gpu_info info = {.struct_size = sizeof info};
    assert_int_equal(ewa_gpu_describe(context, &info), EWA_OK);
    assert_int_equal(info.device_class, close.exact ? EWA_GPU_EXACT : EWA_GPU_CLOSE);
    assert_true(info.renderer[0] && info.storage_bytes >= 1 << 27 && info.storage_count >= 14);
}

/// Arithmetic that rounds otherwise: at least 60 dB, and at most one pixel in 10^5 off by more than a level.
TEST(test_close_pictures) {
    enum { SIDE_PX = GPU_MAX_PX };
    static uint8_t planes[2][4 * SIDE_PX * SIDE_PX];
    tune("arith=close");
    gpu_scene at;
    gpu_scene_make(&at, 20000, SIDE_PX, SIDE_PX);
    ewa_renderer *renderers[2] = {NULL, NULL};
    assert_int_equal(ewa_renderer_create(at.context, &renderers[0]), EWA_OK);
    assert_int_equal(ewa_renderer_create_on(at.context, EWA_BACKEND_GL, &renderers[1]), EWA_OK);
    for (int k = 0; k < 2; k++) assert_int_equal(gpu_scene_draw(&at, renderers[k], planes[k]), EWA_OK);
    double sum = 0;
    uint32_t more = 0, one = 0;
    for (size_t i = 0; i < (size_t)SIDE_PX * SIDE_PX; i++) {
        int largest = 0;
        for (size_t c = 4 * i; c < 4 * i + 4; c++) {
            const int off = abs(planes[0][c] - planes[1][c]);
            sum += off * off;
            largest = off > largest ? off : largest;
        }
        more += largest > 1, one += largest == 1;
    }
    const double psnr_db = 10 * log10(255.0 * 255 * sizeof planes[0] / sum);
    print_message("close: %.1f dB, %u pixels off by one, %u by more\n", psnr_db, one, more);
    assert_true(psnr_db >= 60);
    assert_true(more <= 1e-5 * SIDE_PX * SIDE_PX);
    for (int k = 0; k < 2; k++) ewa_renderer_destroy(&renderers[k]);
    gpu_scene_free(&at);
    tune("");
}

static long resident_kib(void) {
    long pages = 0, unused = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file) {
        if (fscanf(file, "%ld %ld", &unused, &pages) != 2) pages = 0;
        fclose(file);
    }
    return pages * (sysconf(_SC_PAGESIZE) / 1024);
}

/// A thousand sizes: no error of OpenGL, and no more memory than the largest takes.
TEST(test_resizes) {
    enum { SIZES = 1000, WARM = 100, MAX_PX = 40, ALLOWED_KIB = 24 << 10 };
    static uint8_t rgba8[4 * MAX_PX * MAX_PX];
    OWNED(gpu_scene_free) gpu_scene at;
    gpu_scene_make(&at, 100, MAX_PX, MAX_PX);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = NULL;
    assert_int_equal(ewa_renderer_create_on(at.context, EWA_BACKEND_GL, &renderer), EWA_OK);
    check_random random = {7};
    long warm_kib = 0;
    for (int i = 0; i < SIZES; i++) {
        const uint32_t width_px = 1 + (uint32_t)(check_random_u64(&random) % MAX_PX),
                       height_px = 1 + (uint32_t)(check_random_u64(&random) % MAX_PX);
        gpu_scene_resize(&at, width_px, height_px);
        // Errors that OpenGL notes are failures of the frame (ewa_gl_check()).
        assert_int_equal(gpu_scene_draw(&at, renderer, rgba8), EWA_OK);
        if (i % 100 == 0) assert_true(gpu_scene_same(&at, rgba8));
        if (i == WARM) warm_kib = resident_kib();
    }
    print_message("%d sizes: %ld KiB, then %ld\n", SIZES, warm_kib, resident_kib());
    assert_true(resident_kib() <= warm_kib + ALLOWED_KIB);
    assert_int_equal(at.log.count, 0);
}

/// A hundred renderers, each with its device, programs and surfels.
TEST(test_creations) {
    enum { RENDERERS = 100, WARM = 20, SIDE_PX = 16, ALLOWED_KIB = 64 << 10 };
    static uint8_t rgba8[4 * SIDE_PX * SIDE_PX];
    check_memory memory = {.calls_left = -1};
    ewa_context *context = check_context_on(1, &memory);
    const int64_t held_bytes = memory.held_bytes;
    long warm_kib = 0;
    for (int i = 0; i < RENDERERS; i++) {
        ewa_renderer *renderer = NULL;
        assert_int_equal(ewa_renderer_create_on(context, EWA_BACKEND_GL, &renderer), EWA_OK);
        if (i % 25 == 0) { // with all programs of a frame
            OWNED(gpu_scene_free) gpu_scene at;
            gpu_scene_make(&at, 50, SIDE_PX, SIDE_PX);
            assert_int_equal(gpu_scene_draw(&at, renderer, rgba8), EWA_OK);
            assert_true(gpu_scene_same(&at, rgba8));
            ewa_renderer_destroy(&renderer);
        }
        ewa_renderer_destroy(&renderer);
        assert_int_equal(memory.held_bytes, held_bytes);
        if (i == WARM) warm_kib = resident_kib();
    }
    print_message("%d renderers: %ld KiB, then %ld\n", RENDERERS, warm_kib, resident_kib());
    assert_true(resident_kib() <= warm_kib + ALLOWED_KIB);
    ewa_context_destroy(&context);
    assert_int_equal(memory.held_bytes, 0);
}

/// A context of the caller's own stays current.
TEST_ON(test_outside_stays, 1) {
    tune("");
    OWNED(ewa_gl_close) ewa_gl *outside = NULL;
    assert_int_equal(ewa_gl_open(context, &outside), EWA_OK);
    assert_int_equal(ewa_gl_enter(outside), EWA_OK);
    const EGLContext current = eglGetCurrentContext();
    gpu_scene at;
    static uint8_t rgba8[4 * 16 * 16];
    gpu_scene_make(&at, 50, 16, 16);
    ewa_renderer *renderer = NULL;
    assert_int_equal(ewa_renderer_create_on(at.context, EWA_BACKEND_GL, &renderer), EWA_OK);
    assert_ptr_equal(eglGetCurrentContext(), current);
    assert_int_equal(gpu_scene_draw(&at, renderer, rgba8), EWA_OK);
    assert_ptr_equal(eglGetCurrentContext(), current);
    ewa_renderer_destroy(&renderer);
    assert_ptr_equal(eglGetCurrentContext(), current);
    gpu_scene_free(&at);
    ewa_gl_leave(outside);
}

int main(void) {
    enum { SKIPPED = 77 };
    if (!gpu_there()) return SKIPPED;
    return RUN_TESTS(NULL, NULL);
}
