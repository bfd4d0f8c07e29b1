// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// --backend and info --gpu: the same pictures whatever draws them, and what is said where there is no device.
#include <string.h>

#include "run_ewa.h"

static int enter(void **state) {
    const int entered = scratch_enter("cli_gpu");
    run_done("ewa generate torus -n 2000 -o torus.ply");
    return entered;
}

/// Whether there is a device that draws the same bytes; else says what the program said.
static bool exact(void) {
    const bool there = run("ewa info --gpu --json") == 0 && strstr(last_run.out, "\"class\": \"exact\"");
    if (!there) print_message("skipped: %s\n", *last_run.err ? last_run.err : last_run.out);
    return there;
}

TEST(test_info) {
    if (!exact()) return;
    assert_non_null(strstr(last_run.out, "\"native_fma\": "));
    assert_non_null(strstr(last_run.out, "\"subnormals\": true")); // llvmpipe has them, and a device of class exact nearly always
    assert_non_null(strstr(last_run.out, "\"files\": []"));
    run_done("ewa info --gpu torus.ply");
    assert_int_equal(strncmp(last_run.out, "gpu\n  renderer ", strlen("gpu\n  renderer ")), 0);
    assert_non_null(strstr(last_run.out, "\n  class       exact"));
    assert_non_null(strstr(last_run.out, "\n  device      0: "));
    assert_non_null(strstr(last_run.out, "\ntorus.ply\n"));
    run_done("EWA_GL_TUNING=arith=emulated ewa info --gpu");
    assert_non_null(strstr(last_run.out, "fma emulated, division emulated, square root emulated"));
}

TEST(test_no_device) {
    run_fails(1, "OpenGL", "EWA_GL_TUNING=nodevice=1 ewa info --gpu");
    run_fails(1, "OpenGL",
              "EWA_GL_TUNING=nodevice=1 ewa render torus.ply -o none.png --size 32x24 --backend gl");
    assert_int_equal(scratch_size("none.png"), -1);
    run_fails(2, "an input is missing", "ewa info");
    run_fails(2, "--backend", "ewa render torus.ply -o none.png --backend gpu");
}

/// A film of four frames: auto has found out by then that there is nothing to choose.
TEST(test_auto) {
    run_done("ewa render torus.ply -o cpu_%%d.png --size 32x24 --turntable 4 && "
             "EWA_GL_TUNING=nodevice=1 ewa render torus.ply -o auto_%%d.png --size 32x24 --turntable 4 "
             "--backend auto --stats - ");
    assert_non_null(strstr(last_run.out, "\"backend\": \"cpu\""));
    assert_non_null(strstr(last_run.out, "\"backend_remark\": \""));
    assert_null(strstr(last_run.out, "\"device\""));
    for (int i = 0; i < 4; i++) {
        char a[16], b[16];
        snprintf(a, sizeof a, "cpu_%d.png", i), snprintf(b, sizeof b, "auto_%d.png", i);
        assert_true(scratch_same(a, b));
    }
}

TEST(test_same_pictures) {
    if (!exact()) return;
    run_done("ewa render torus.ply -o a.png --aov depth=a.pfm --size 64x48");
    assert_int_equal(
        run("ewa render torus.ply -o b.png --aov depth=b.pfm --size 64x48 --backend gl --stats -"), 0);
    // Of software, and of nothing else, there is a warning.
    const bool software = strstr(last_run.out, "is software\"") != NULL;
    if (software)
        assert_non_null(strstr(last_run.err, "is software: --backend cpu is many times faster"));
    else
        assert_string_equal(last_run.err, "");
    assert_non_null(strstr(last_run.out, "\"backend\": \"gl\""));
    assert_non_null(strstr(last_run.out, "\"device\": \""));
    assert_non_null(strstr(last_run.out, "\"device_class\": \"exact\""));
    assert_true(scratch_same("a.png", "b.png"));
    assert_true(scratch_same("a.pfm", "b.pfm"));
    run_done("ewa bench torus.ply --backend gl --size 32x24 --frames 1 --workers 1 --stages off --json - "
             "2>tables");
    assert_non_null(strstr(last_run.out, "\"backend\": \"gl\""));
    assert_non_null(strstr(last_run.out, "\"splats_per_s\": "));
    assert_non_null(strstr(last_run.out, "\"passes\": 3"));
}

/// Writes a file of three Gaussians.
static void write_gaussians(void) {
    FILE *file = fopen(scratch_path("three.splat"), "wb");
    assert_non_null(file);
    for (int i = 0; i < 3; i++) {
        const float numbers[6] = {(float)i, 0, 0.5f * (float)i, 0.5f, 0.3f, 0.4f};
        const uint8_t codes[8] = {(uint8_t)(250 - 80 * i), 100, (uint8_t)(80 * i), 200, 255, 128, 128, 128};
        assert_int_equal(fwrite(numbers, sizeof numbers, 1, file), 1);
        assert_int_equal(fwrite(codes, sizeof codes, 1, file), 1);
    }
    assert_int_equal(fclose(file), 0);
}

/// Gaussians by both, alone and among points; what the device leaves says why.
TEST(test_gaussians) {
    if (!exact()) return;
    static const char *const scenes[] = {"three.splat", "three.splat torus.ply", "three.splat --order ray"};
    write_gaussians();
    for (int i = 0; i < 3; i++) {
        run_done("ewa render %s -o c.png --size 64x48 --up y && ewa render %s -o d.png --size 64x48 --up y --backend gl --stats - 2>err", scenes[i],
                 scenes[i]);
        assert_non_null(strstr(last_run.out, i < 2 ? "\"mixture_backend\": \"gl\"" : "\"mixture_backend\": \"cpu\""));
        assert_true((strstr(last_run.out, "in the order of rays") != NULL) == (i == 2));
        assert_true(scratch_same("c.png", "d.png"));
    }
}

/// Three frames, of which the device is lost in one: the same film as ever, and a warning.
TEST(test_lost) {
    if (!exact()) return;
    assert_int_equal(
        run("ewa render torus.ply -o whole_%%d.png --size 32x24 --turntable 3 && "
            "EWA_GL_TUNING='lose=1 software=1' ewa render torus.ply -o lost_%%d.png --size 32x24 "
            "--turntable 3 --backend auto"),
        0);
    assert_non_null(strstr(last_run.err, "the CPU draws from here on"));
    for (int i = 0; i < 3; i++) {
        char a[16], b[16];
        snprintf(a, sizeof a, "whole_%d.png", i), snprintf(b, sizeof b, "lost_%d.png", i);
        assert_true(scratch_same(a, b));
    }
}

/// Volumes, too, by each command that draws them; what is the processor's is said.
TEST(test_volume) {
    if (!exact()) return;
    run_done("ewa generate vessels -o v.nrrd --dims 16 && ewa volume v.nrrd -o a.png --aov depth=a.pfm --size 40x30");
    assert_int_equal(run("ewa volume v.nrrd -o b.png --aov depth=b.pfm --size 40x30 --backend gl --stats -"), 0);
    assert_non_null(strstr(last_run.out, "\"mixture_backend\": \"gl\""));
    assert_non_null(strstr(last_run.out, "\"device_waits\": 1,"));
    assert_true(scratch_same("a.png", "b.png"));
    assert_true(scratch_same("a.pfm", "b.pfm"));
    assert_int_equal(run("ewa volume v.nrrd -o c.png --size 40x30 --backend gl --footprint table --stats -"), 0);
    assert_non_null(strstr(last_run.out, "\"mixture_backend\": \"cpu\""));
    assert_non_null(strstr(last_run.out, "\"mixture_remark\": \"the footprints of the paper"));
}

/// The viewer draws by it too.
TEST(test_view) {
    if (!exact()) return;
    scratch_text("cpu.txt", "shot view_cpu.png\n");
    scratch_text("gl.txt", "shot view_gl.png\n");
    run_done("ewa view torus.ply --script cpu.txt --size 64x48 && "
             "ewa view torus.ply --script gl.txt --size 64x48 --backend gl");
    assert_true(scratch_same("view_cpu.png", "view_gl.png"));
}

int main(void) { return RUN_TESTS(enter, NULL); }
