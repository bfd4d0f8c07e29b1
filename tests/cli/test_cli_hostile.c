// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Bad input: a message that names file, place and reason, exit status 1, nothing half-written.
#include <signal.h>
#include <string.h>
#include <unistd.h>

#include "run_ewa.h"

static int enter(void **state) { return scratch_enter("cli_hostile"); }

#define HEADER(count)                                                                                        \
    "ply\nformat ascii 1.0\nelement vertex " count "\nproperty float x\nproperty float y\nproperty float "   \
    "z\n"
#define NORMAL "property float nx\nproperty float ny\nproperty float nz\n"
#define RADIUS "property float radius\n"
#define END    "end_header\n"

/// Every command that reads a cloud refuses the file with these words and writes nothing.
static void refuse_everywhere(const char *name, const char *said) {
    const int before = scratch_count();
    char words[512];
    snprintf(words, sizeof words, "%s: |%s", name, said);
    run_fails(1, words, "ewa render %s -o out.png --size 32x32 --aov depth=out.pfm --stats out.json", name);
    run_fails(1, words, "ewa convert %s -o out.ply", name);
    run_fails(1, words, "ewa surfels %s -o out.ply", name);
    run_fails(1, words, "ewa info %s", name);
    assert_int_equal(scratch_count(), before);
}

TEST(test_no_file) {
    refuse_everywhere("none.ply", "No such file");
    run_done("mkdir -p folder.ply");
    refuse_everywhere("folder.ply", "");
}

TEST(test_broken_files) {
    scratch_text("empty.ply", "");
    refuse_everywhere("empty.ply", "");
    scratch_text("text.ply", "not a cloud at all\n");
    refuse_everywhere("text.ply", "");
    scratch_text("pointless.ply", HEADER("0") END);
    refuse_everywhere("pointless.ply", "no points");
    scratch_text("short.ply", HEADER("3") END "0 0 0\n1 1 1\n");
    refuse_everywhere("short.ply", "");
    scratch_text("word.ply", HEADER("2") END "0 0 0\n1 one 1\n");
    refuse_everywhere("word.ply", "");
    scratch_text(
        "flat.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n");
    refuse_everywhere("flat.ply", "");
    scratch_text("huge.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 18446744073709551615\n"
                             "property float x\nproperty float y\nproperty float z\nend_header\n");
    refuse_everywhere("huge.ply", "");
    scratch_text("lying.ply",
                 "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\n"
                 "property float x\nproperty float y\nproperty float z\nend_header\n123456789012");
    refuse_everywhere("lying.ply", "");
}

/// A truncated binary file at every length that matters.
TEST(test_every_truncation) {
    run_done("ewa generate sphere -n 3 -o whole.ply");
    const long size = scratch_size("whole.ply");
    static char bytes[4096];
    FILE *file = fopen(scratch_path("whole.ply"), "rb");
    assert_int_equal(fread(bytes, 1, sizeof bytes, file), size);
    fclose(file);
    for (long length = 0; length < size; length += 1 + size / 60) {
        scratch_write("cut.ply", bytes, (size_t)length);
        run_fails(1, "cut.ply: ", "ewa info cut.ply");
    }
    run_done("rm whole.ply cut.ply");
}

TEST(test_nothing_to_draw) {
    scratch_text("nan.ply", HEADER("2") END "nan 0 0\ninf 1 1\n");
    run_fails(1, "nan.ply: ", "ewa render nan.ply -o out.png");
    scratch_text("zeronormal.ply", HEADER("2") NORMAL RADIUS END "0 0 0 0 0 0 1\n1 0 0 0 0 0 1\n");
    run_fails(1, "zeronormal.ply: none of the 2 points can be drawn", "ewa render zeronormal.ply -o out.png");
    scratch_text("zeroradius.ply", HEADER("2") NORMAL RADIUS END "0 0 0 0 0 1 0\n1 0 0 0 0 1 0\n");
    run_fails(1, "zeroradius.ply: none of the 2 points can be drawn", "ewa render zeroradius.ply -o out.png");
    assert_int_equal(scratch_size("out.png"), -1);
    scratch_text("some.ply", HEADER("3") NORMAL RADIUS END "0 0 0 0 0 1 1\n1 0 0 0 0 1 0\nnan 0 0 0 0 1 1\n");
    assert_int_equal(run("ewa render some.ply -o some.png --size 32x32"), 0);
    assert_non_null(strstr(last_run.err, "ewa: warning: some.ply: 2 of 3 points are left out"));
}

/// Odd but honest clouds are drawn.
TEST(test_odd_clouds) {
    scratch_text("one.ply", HEADER("1") NORMAL RADIUS END "5 5 5 0 0 1 1\n");
    run_done("ewa render one.ply -o one.png --size 32x32");
    scratch_text("same.ply", HEADER("3") NORMAL RADIUS END "1 1 1 0 0 1 1\n1 1 1 0 0 1 1\n1 1 1 0 0 1 1\n");
    run_done("ewa render same.ply -o same.png --size 32x32");
    assert_int_equal(run("ewa generate plane -n 400 --positions-only -o flat.ply && "
                         "ewa render flat.ply -o flat.png --size 32x32 && ewa info flat.ply"),
                     0);
    assert_non_null(strstr(last_run.out, "all points lie in one plane"));
    scratch_text("line.ply", HEADER("4") END "0 0 0\n1 1 1\n2 2 2\n3 3 3\n");
    scratch_text("twice.ply", HEADER("3") END "1 1 1\n1 1 1\n1 1 1\n");
    scratch_text("lone.ply", HEADER("1") END "1 2 3\n");
    static const char *const names[] = {"line", "twice", "lone"};
    for (size_t i = 0; i < 3; i++) {
        // Without normals these have no surface: a picture or a refusal, but never a crash or half a file.
        const int exit_status = run("ewa render %s.ply -o %s.png --size 32x32", names[i], names[i]);
        assert_true(exit_status == 0 || exit_status == 1);
        char name[64];
        snprintf(name, sizeof name, "%s.png", names[i]);
        assert_int_equal(scratch_size(name) > 0, exit_status == 0);
        if (exit_status == 1) assert_non_null(strstr(last_run.err, names[i]));
    }
}

TEST(test_outputs) {
    run_done("ewa generate sphere -n 500 -o ball.ply && mkdir -p taken.png");
    const int before = scratch_count();
    run_fails(2, "--output: taken.png: is a folder", "ewa render ball.ply -o taken.png");
    run_fails(2, "--output: nowhere/a.png: cannot create: folder nowhere: No such file",
              "ewa render ball.ply -o nowhere/a.png");
    run_fails(2, "--aov: nowhere/d.pfm: cannot create",
              "ewa render ball.ply -o a.png --aov depth=nowhere/d.pfm");
    run_fails(2, "--save-camera: nowhere/c.json: cannot create",
              "ewa render ball.ply -o a.png --save-camera nowhere/c.json");
    run_fails(2, "--stats: nowhere/s.json: cannot create",
              "ewa render ball.ply -o a.png --stats nowhere/s.json");
    run_fails(1, "c.json: ", "ewa render ball.ply -o a.png --camera c.json");
    scratch_text("c.json", "{\"width\": 10");
    run_fails(1, "c.json:", "ewa render ball.ply -o a.png --camera c.json");
    run_fails(1, "the eye 0,0,0 is also where the camera looks",
              "ewa render ball.ply -o a.png --eye 0,0,0 --target 0,0,0");
    assert_int_equal(scratch_count(), before + 1);
    if (access("/dev/full", W_OK) == 0)
        run_fails(1, "No space left", "ewa render ball.ply -o - --size 64x64 >/dev/full");
    // A file size limit breaks the write halfway; the old file stays as it was.
    run_done("printf old >kept.png");
    assert_int_equal(
        run("ulimit -f 1; ewa render ball.ply -o kept.png --size 600x600 --background 0.3,0.6,0.9"), 1);
    assert_non_null(strstr(last_run.err, "ewa: kept.png: "));
    assert_int_equal(scratch_size("kept.png"), 3);
    run_done("rm kept.png");
    assert_int_equal(scratch_count(), before + 1);
}

/// Writes a cloud of doubles: `count` points, three numbers each.
static void write_doubles(const char *name, int count, const double *numbers) {
    FILE *file = fopen(scratch_path(name), "w");
    assert_non_null(file);
    fprintf(file,
            "ply\nformat ascii 1.0\nelement vertex %d\nproperty double x\nproperty double y\nproperty "
            "double z\nend_header\n",
            count);
    for (int i = 0; i < count; i++)
        fprintf(file, "%.17g %.17g %.17g\n", numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
    fclose(file);
}

/// Extents that overflow, that vanish when they are divided, and that are nothing but rounding.
TEST(test_extents) {
    enum { COUNT = 4000 };
    static double numbers[3 * COUNT];
    static const double scales[][3] = {
        {1.7e308, 1.7e308, 1}, {5e-323, 5e-323, 5e-324}, {5e-323, 5e-323, 1}, {1.7e308, 5e-323, 1.7e308}};
    const int before = scratch_count();
    for (size_t k = 0; k < sizeof scales / sizeof scales[0]; k++) {
        uint32_t state_bits = 1;
        for (int i = 0; i < 3 * COUNT; i++) {
            state_bits = state_bits * 1664525 + 1013904223;
            numbers[i] = (2 * (state_bits >> 8) / 16777215.0 - 1) * scales[k][i % 3] + (i % 3 == 2);
        }
        write_doubles("extent.ply", COUNT, numbers);
        if (run("ewa info extent.ply") != 0) fail_msg("case %zu: %s", k, last_run.err);
        const int status = run("ewa render extent.ply -o out.png --size 64x64; status=$?; rm -f out.png; "
                               "exit $status");
        if (status > 1) fail_msg("case %zu: status %d, %s", k, status, last_run.err);
    }
    // A plane across the axis of a turntable: where its points are along that is rounding.
    for (int i = 0; i < COUNT; i++) {
        const double x = i % 61 / 61.0, y = i / 61 / 61.0;
        numbers[3 * i] = x, numbers[3 * i + 1] = y, numbers[3 * i + 2] = -(x + 3 * y) / 7;
    }
    write_doubles("extent.ply", COUNT, numbers);
    const int status =
        run("ewa render extent.ply -o out_%%d.png --size 64x64 --turntable 2 --up 1,3,7 --target "
            "0.5,0.5,-1; status=$?; rm -f out_?.png; exit $status");
    if (status != 0) fail_msg("status %d, %s", status, last_run.err);
    run_done("rm extent.ply");
    assert_int_equal(scratch_count(), before);
}

TEST(test_out_of_memory) {
#ifdef __SANITIZE_ADDRESS__
    skip(); // needs address space of its own
#elif defined(__SANITIZE_THREAD__)
    skip();
#endif
    run_done("ewa generate torus -n 1000000 -o big.ply && rm -f out.*");
    const int before = scratch_count();
    run_fails(1, "memory", "ulimit -v 60000; ewa render big.ply -o out.png --threads 1");
    run_fails(1, "out.exr: |memory",
              "ulimit -v 400000; ewa render big.ply -o out.exr --size 20000x20000 --threads 1");
    run_fails(1, "memory",
              "ulimit -v 60000; ewa convert big.ply -o out.ply --crop -1,-1,-1,1,1,1 --threads 1");
    run_fails(1, "out.ply: |memory", "ulimit -v 60000; ewa generate torus -n 4000000 -o out.ply --threads 1");
    assert_int_equal(scratch_count(), before);
}

TEST(test_interruption) {
    const int before = scratch_count();
    // Terminated while it works: ends by the signal, and what it was writing is gone. `ewa` is a function of the shell
    // here, whose process the signal would end in the program's place.
    assert_int_equal(run("\"$EWA_PROGRAM\" generate terrain -n 30000000 -o out.ply & pid=$!; sleep 0.7; "
                         "kill -TERM $pid; wait $pid"),
                     128 + SIGTERM);
    assert_int_equal(scratch_count(), before);
}

int main(void) { return RUN_TESTS(enter, NULL); }
