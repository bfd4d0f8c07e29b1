// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// render: turntables, camera paths, numbered files, films. Films go through a fake ffmpeg that notes
// what it is asked for and counts bytes, and through the real one where it is installed.
#include "check_pictures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/// Writes an ffmpeg of shell lines into the folder `name` of the scratch folder.
static void fake_program(const char *name, const char *lines) {
    char text[1024], path[256];
    run("mkdir -p %s", name);
    snprintf(text, sizeof text, "#!/bin/sh\n%s\n", lines);
    snprintf(path, sizeof path, "%s/ffmpeg", name);
    scratch_text(path, text);
    run("chmod +x %s", path);
}

static int enter(void **state) {
    context = check_context(0, NULL);
    if (scratch_enter("cli_frames") != 0) return -1;
    // The last word is file:PATH.
    fake_program("fake", "printf '%s\\n' \"$@\" >words\nfor last; do :; done\nwc -c >\"${last#file:}\"");
    fake_program("broken", "echo 'Unknown encoder' >&2\nexit 3");
    fake_program("dying", "kill -9 $$");
    // Takes nothing before the second frame is drawn and its depths are written; "late" where that is not before 20 s are over.
    fake_program("waiting", "for last; do :; done\ni=0\nwhile ! test -s depth_1.exr && test $i -lt 200; do sleep 0.1; i=$((i+1)); done\n"
                            "test $i -lt 200 && echo early >when || echo late >when\ncat >\"${last#file:}\"");
    return run("ewa generate torus -n 5000 -o torus.ply && ewa generate cube -n 3000 -o cube.ply");
}

/// Whole in every frame, with little room to spare in the worst, and the first frame again after a full turn.
TEST(test_turntable) {
    static const char *const objects[] = {"torus", "cube"};
    static const char *const views[] = {
        "", "--elevation 30", "--view top", "--up 1,1,0.3", "--azimuth 45", "--target 0.3,0.2,0.1"};
    for (size_t k = 0; k < 12; k++) {
        run_done("rm -f f_*.exr; ewa render %s.ply -o f_%%02d.exr --turntable 7 --size 96x72 %s "
                 "--background transparent",
                 objects[k % 2], views[k / 2]);
        assert_int_equal(scratch_size("f_07.exr"), -1);
        double nearest = 1e9;
        for (int i = 0; i < 7; i++) {
            char name[32];
            snprintf(name, sizeof name, "f_%02d.exr", i);
            OWNED(ewa_image_free) ewa_image image = load(name);
            double border = 0;
            uint32_t low_x = 96, high_x = 0, low_y = 72, high_y = 0;
            for (uint32_t y = 0; y < 72; y++)
                for (uint32_t x = 0; x < 96; x++) {
                    const float alpha = image.pixels[4 * (y * 96 + x) + 3];
                    if (x == 0 || x == 95 || y == 0 || y == 71) border += (double)alpha;
                    if (alpha <= 0.5f) continue;
                    low_x = x < low_x ? x : low_x;
                    high_x = x > high_x ? x : high_x;
                    low_y = y < low_y ? y : low_y;
                    high_y = y > high_y ? y : high_y;
                }
            assert_true(border == 0);
            nearest = fmin(nearest, fmin(fmin(low_x, 95 - high_x), fmin(low_y, 71 - high_y)));
        }
        assert_true(nearest < 14);
    }
}

/// One picture and frames; 95 is what JPEG has where nobody says.
TEST(test_jpeg_quality) {
    run_done("ewa render torus.ply -o j.jpg --size 80x60 --view top && ewa render torus.ply -o j95.jpg --size 80x60 --view top --quality 95 && "
             "ewa render torus.ply -o j20.jpg --size 80x60 --view top --quality 20 && "
             "ewa render torus.ply -o f_%%d.jpg --turntable 3 --size 80x60 --quality 20 && ewa render torus.ply -o g_%%d.jpg --turntable 3 --size 80x60");
    assert_true(scratch_same("j.jpg", "j95.jpg"));
    const char *const pairs[][2] = {{"j20.jpg", "j.jpg"}, {"f_2.jpg", "g_2.jpg"}};
    for (int i = 0; i < 2; i++) {
        struct stat small, large;
        assert_int_equal(stat(scratch_path(pairs[i][0]), &small), 0);
        assert_int_equal(stat(scratch_path(pairs[i][1]), &large), 0);
        assert_true(small.st_size > 0 && small.st_size < large.st_size);
    }
}

TEST(test_turntable_camera) {
    // A quarter of the turn is what the camera sees from there: right-handed about up.
    run_done(
        "ewa render torus.ply -o q_%%d.png --turntable 4 --size 80x60 --eye 0,-5,1 --target 0,0,0 "
        "--up 0,0,1 && ewa render torus.ply -o eye.png --size 80x60 --eye 5,0,1 --target 0,0,0 --up 0,0,1");
    assert_true(scratch_same("q_1.png", "eye.png"));
    // The cameras that were used, as a path, give the same frames; and so does a still with the same azimuth.
    run_done(
        "ewa render torus.ply -o a_%%d.png --turntable 6 --size 80x60 --elevation 20 --save-camera c.json && "
        "ewa render torus.ply -o b_%%d.png --path c.json");
    for (int i = 0; i < 6; i++) {
        char a[16], b[16];
        snprintf(a, sizeof a, "a_%d.png", i);
        snprintf(b, sizeof b, "b_%d.png", i);
        assert_true(scratch_same(a, b));
    }
    run_done("ewa render torus.ply -o c_%%d.png --turntable 2 --camera c.json");
    assert_true(scratch_same("a_0.png", "c_0.png"));
}

TEST(test_path) {
    run_done("ewa render torus.ply -o k_%%d.exr --turntable 4 --size 64x48 --save-camera keys.json && "
             "ewa render torus.ply -o p_%%02d.exr --path keys.json --frames 8 --loop && "
             "ewa render torus.ply -o o_%%02d.exr --path keys.json --frames 7 && "
             "ewa render torus.ply -o s_%%02d.exr --path keys.json --size 128x96");
    // Keys are met by every second frame of the loop and of the open way; the loop has its last step too.
    assert_true(scratch_same("k_1.exr", "p_02.exr"));
    assert_true(scratch_same("k_3.exr", "p_06.exr"));
    assert_true(scratch_same("k_3.exr", "o_06.exr"));
    assert_true(scratch_size("p_07.exr") > 0 && scratch_size("p_08.exr") == -1);
    ewa_image image = load("s_03.exr");
    assert_int_equal(image.width_px, 128);
    ewa_image_free(&image);
    // Each frame's own planes.
    run_done("ewa render torus.ply -o r_%%d.png --path keys.json --aov depth=d_%%03d.pfm,normal=n%%d.exr");
    assert_true(scratch_size("d_003.pfm") > 0 && scratch_size("n0.exr") > 0);
}

TEST(test_usage) {
    static const struct {
        const char *options, *said;
    } cases[] = {
        {"-o a.png --turntable 4", "--output|%04d"},
        {"-o a_%d_%d.png --turntable 4", "--output|%04d"},
        {"-o a_%s.png --turntable 4", "--output|%04d"},
        {"-o a_%d.png --turntable 0", "--turntable|[1,"},
        {"-o a_%d.png --turntable 4 --aov depth=d.pfm", "d.pfm|numbered"},
        {"-o a_%d.png --turntable 4 --path c.json", "exclude"},
        {"-o a_%d.png --frames 4", "--frames needs --turntable or --path"},
        {"-o a_%d.png --path c.json --loop", "--loop needs --frames"},
        {"-o a_%d.png --path c.json --view top", "--path and --view exclude"},
        {"-o a_%d.png --turntable 4 --fps 20", "--fps"},
        {"-o a_%d.png --turntable 4 --quality 20", "--quality|.jpg"},
        {"-o a.jpg --quality 101", "--quality|[0, 100]"},
        {"-o a.gif --turntable 4 --quality 20", "--quality"},
        {"-o a.mp4", "--turntable or --path"},
        {"-o a.mp4 --turntable 4 --background transparent", "transparency|.webm"},
        {"-o a.jpg --background transparent", "transparency|.png"},
        {"-o a.png --eye 0,0,9 --azimuth 20", "--azimuth"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        run_fails(2, cases[i].said, "ewa render torus.ply %s", cases[i].options);
}

TEST(test_stats) {
    run_done("ewa render torus.ply -o t_%%d.png --turntable 3 --size 64x48 --stats s.json && "
             "test $(grep -c render_s s.json) = 3 && grep -q '\"frame_count\": 3' s.json");
    run_done("ewa render torus.ply -o t.png --size 64x48 --stats s.json && ! grep -q frame s.json");
}

/// JPEG by its suffix, of one frame and of several.
TEST(test_jpeg) {
    run_done("ewa render torus.ply -o one.jpg --size 64x48 && ewa render torus.ply -o two_%%d.JPEG "
             "--turntable 2 --size 64x48 && "
             "for f in one.jpg two_0.JPEG two_1.JPEG; do test \"$(head -c 3 $f | od -An -tx1 | tr -d ' ')\" "
             "= ffd8ff || exit 1; done");
}

/// What the fake ffmpeg is asked for, every byte of every frame, and nothing beside the film at the end.
TEST(test_film) {
    run_done("rm -rf films && mkdir films && PATH=$PWD/fake:$PATH && "
             "ewa render torus.ply -o films/a.mp4 --turntable 5 --size 64x48 --fps 24 --quality 100 && "
             "test $(cat films/a.mp4) = %d && test $(ls -A films) = a.mp4 && "
             "grep -qx 64x48 words && grep -qx 24 words && grep -qx rgb0 words && grep -qx libx264 words && "
             "grep -qx yuv420p words && grep -qx -- -crf words && grep -qx 10 words",
             5 * 64 * 48 * 4);
    run_done("PATH=$PWD/fake:$PATH && ewa render torus.ply -o 'films/b c:d.webm' --turntable 2 --size 31x17 "
             "--background transparent && test $(cat 'films/b c:d.webm') = %d && grep -qx rgba words && "
             "grep -qx yuva420p words && grep -qx 30 words",
             2 * 31 * 17 * 4);
    run_done("PATH=$PWD/fake:$PATH && ewa render torus.ply -o films/a.gif --turntable 2 --size 32x16 && "
             "! grep -q -- -crf words && test $(ls -A films | wc -l) = 3");
}

/// While one frame is on its way to ffmpeg the next is drawn; they come in their order, with files beside them and without.
TEST(test_film_frames_overlap) {
    run("rm -rf films depth_*.exr && mkdir films");
    run_done("PATH=$PWD/waiting:$PATH && ewa render torus.ply -o films/a.mp4 --aov depth=depth_%%d.exr --turntable 5 --size 160x120 && "
             "grep -qx early when && test $(wc -c <films/a.mp4) = %d",
             5 * 160 * 120 * 4);
    run_done("PATH=$PWD/waiting:$PATH && ewa render torus.ply -o films/b.mp4 --turntable 5 --size 160x120 && "
             "ewa render torus.ply -o films/c.mp4 --turntable 5 --size 160x120 --threads 1 && cmp films/a.mp4 films/b.mp4 && "
             "cmp films/b.mp4 films/c.mp4");
    // The files of a frame that cannot be written keep it and those after it out of the film.
    run("rm -rf films/* depth_*.exr && mkdir depth_2.exr");
    run_fails(1, "depth_2.exr", "PATH=$PWD/fake:$PATH && ewa render torus.ply -o films/a.mp4 --aov depth=depth_%%d.exr --turntable 9 --size 64x48");
    assert_int_equal(run("rmdir depth_2.exr && test $(ls -A films | wc -l) = 0"), 0);
}

TEST(test_film_fails) {
    run_done("rm -rf films && mkdir films");
    // Under PATH=/nonexistent the shell finds its own commands only.
    run_fails(2, "a.mp4|ffmpeg|not in PATH",
              "PATH=/nonexistent; ewa render torus.ply -o films/a.mp4 --turntable 5");
    run_fails(1, "a.mp4|status 3|Unknown encoder",
              "PATH=$PWD/broken:$PATH && ewa render torus.ply -o films/a.mp4 --turntable 40 --size 320x240");
    // Said once: no frame after the one that could not go is tried.
    assert_null(strstr(strstr(last_run.err, "a.mp4") + 1, "a.mp4"));
    run_fails(1, "a.mp4|signal 9",
              "PATH=$PWD/dying:$PATH && ewa render torus.ply -o films/a.mp4 --turntable 40 --size 320x240");
    run_fails(2, "nowhere", "PATH=$PWD/fake:$PATH && ewa render torus.ply -o nowhere/a.mp4 --turntable 4");
    // One frame among those that are written at the same time cannot be: said once.
    run("mkdir blocked_3.png");
    run_fails(1, "blocked_3.png", "ewa render torus.ply -o blocked_%%d.png --turntable 9 --size 64x48");
    // The others stay, whole, and a second line says which.
    assert_non_null(strstr(last_run.err, "blocked_3.png"));
    assert_null(strstr(strstr(last_run.err, "blocked_3.png") + 1, "blocked_3.png"));
    assert_non_null(strstr(last_run.err, "of 9 frames, "));
    const char *stay = strstr(last_run.err, "are written and stay: 0 to 2");
    assert_non_null(stay);
    for (int i = 0; i < 9; i++) {
        char name[32];
        snprintf(name, sizeof name, "blocked_%d.png", i);
        const bool listed = i < 3 || (i > 3 && strstr(stay, "4") && i <= atoi(strrchr(stay, ' ') + 1));
        assert_int_equal(run("test -f %s", name) == 0, listed);
    }
    // Frames of two sizes.
    run_done("ewa render torus.ply -o x_%%d.png --turntable 2 --size 64x48 --save-camera k.json && "
             "sed '0,/\"width\": 64/s//\"width\": 60/' k.json >sizes.json && "
             "ewa render torus.ply -o y_%%d.png --path sizes.json");
    run_fails(1, "one size|60 x 48|--size",
              "PATH=$PWD/fake:$PATH && ewa render torus.ply -o films/a.mp4 --path sizes.json");
    run_fails(1, "sizes.json: |camera path|key 1",
              "ewa render torus.ply -o y_%%d.png --path sizes.json --frames 4");
    assert_int_equal(run("test $(ls -A films | wc -l) = 0"), 0);
}

/// An interrupt removes the film and what was begun, and ends by the signal.
TEST(test_interrupt) {
    run("rm -rf films && mkdir films");
    const int ended =
        run("PATH=$PWD/fake:$PATH; $EWA_PROGRAM render torus.ply -o films/a.mp4 --turntable 100000 "
            "--size 640x480 & sleep 0.7; kill -TERM $!; wait $!");
    assert_int_equal(ended, 128 + 15);
    assert_int_equal(run("sleep 0.2; test $(ls -A films | wc -l) = 0"), 0);
}

TEST(test_real_film) {
    if (run("command -v ffmpeg && command -v ffprobe") != 0) skip();
    static const char *const films[] = {"a.mp4", "a.mkv", "a.webm"};
    run("rm -rf films && mkdir films");
    for (size_t i = 0; i < 3; i++) {
        run_done("ewa render torus.ply -o films/%s --turntable 6 --size 65x48", films[i]);
        run_done(
            "ffprobe -v error -count_frames -show_entries stream=width,height,nb_read_frames,color_space "
            "-of csv=p=0 films/%s",
            films[i]);
        assert_string_equal(last_run.out, "66,48,bt709,6\n");
    }
    // The middle frame comes back in its colours.
    run_done("ewa render torus.ply -o films/b.mp4 --turntable 4 --size 128x96 --quality 100 && "
             "ewa render torus.ply -o f_%%d.png --turntable 4 --size 128x96 && "
             "ffmpeg -v error -i films/b.mp4 -vf 'select=eq(n\\,2)' -frames:v 1 back.png");
    OWNED(ewa_image_free) ewa_image film = load("back.png"), frame = load("f_2.png");
    double mean = 0;
    for (size_t i = 0; i < 128 * 96 * 3; i++)
        mean += fabs((double)ewa_srgb_from_linear(film.pixels[i]) -
                     (double)ewa_srgb_from_linear(frame.pixels[i])) /
                (128 * 96 * 3);
    assert_true(mean < 0.02);
}

int main(void) { return RUN_TESTS(enter, leave); }
