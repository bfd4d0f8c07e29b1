// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// info, convert, surfels, generate: what goes in comes out.
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "run_ewa.h"

static int enter(void **state) { return scratch_enter("cli_files"); }

static const char small_cloud[] = "ply\nformat ascii 1.0\ncomment three points\nelement vertex 3\n"
                                  "property double x\nproperty double y\nproperty double z\n"
                                  "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                                  "property float intensity\nend_header\n"
                                  "500000.125 4000000.5 10 255 0 0 0.25\n"
                                  "500001.125 4000000.5 11 0 255 0 0.5\n"
                                  "500002.125 4000001.5 12 0 0 255 0.75\n";

/// The number after `key` in the last output.
static double number_after(const char *key) {
    const char *at = strstr(last_run.out, key);
    if (!at) print_error("no '%s' in: %s\n", key, last_run.out);
    assert_non_null(at);
    return strtod(at + strlen(key), NULL);
}

TEST(test_info) {
    scratch_text("small.ply", small_cloud);
    run_done("ewa info small.ply");
    assert_non_null(strstr(last_run.out, "comment three points"));
    assert_non_null(strstr(last_run.out, "500000.125 4000000.5 10"));
    assert_non_null(strstr(last_run.out, "intensity            float  0.25 .. 0.75"));
    run_done("ewa info --json small.ply");
    assert_true(number_after("\"points\": ") == 3);
    assert_true(number_after("\"low\": [") == 500000.125);
    assert_non_null(strstr(last_run.out, "\"name\": \"intensity\""));
    run_done("cat small.ply | ewa info -");
    assert_non_null(strstr(last_run.out, "points      3"));
}

TEST(test_info_problems) {
    scratch_text("odd.ply", "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
                            "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                            "property float radius\nend_header\n"
                            "0 0 0 0 0 1 1\n1 0 0 0 0 0 1\n0 1 0 0 0 1 0\n1 1 0 0 0 1 -1\nnan 1 0 0 0 1 1\n");
    run_done("ewa info odd.ply");
    assert_non_null(strstr(last_run.out, "1 points have coordinates that are not finite"));
    assert_non_null(strstr(last_run.out, "1 normals are zero"));
    assert_non_null(strstr(last_run.out, "2 radii are zero, negative"));
    assert_non_null(strstr(last_run.out, "all points lie in one plane"));
    run_done("ewa info --json odd.ply");
    assert_true(number_after("\"zero_normals\": ") == 1);
    assert_true(number_after("\"finite_points\": ") == 4);
    assert_non_null(strstr(last_run.out, "\"fills\": \"plane\""));
    run_done("ewa generate sphere -n 500 -o ball.ply && ewa info ball.ply");
    assert_non_null(strstr(last_run.out, "problems    none"));
}

TEST(test_generate) {
    static const char *const kinds[] = {"plane", "checker", "cube", "sphere", "torus", "terrain"};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        run_done("ewa generate %s -n 1000 -o a.ply && ewa generate %s -n 1000 -o b.ply --threads 3 && "
                 "ewa generate %s -n 1000 --seed 2 -o c.ply",
                 kinds[i], kinds[i], kinds[i]);
        assert_true(scratch_same("a.ply", "b.ply"));
        assert_false(scratch_same("a.ply", "c.ply"));
        run_done("ewa info --json a.ply");
        assert_true(fabs(number_after("\"points\": ") - 1000) < 100);
        assert_non_null(strstr(last_run.out, "\"name\": \"radius\""));
    }
    run_done("ewa generate torus -n 1000 --positions-only -o a.ply && ewa info --json a.ply");
    assert_null(strstr(last_run.out, "\"name\": \"normal\""));
    run_done("ewa generate torus -n 100 -o - --ascii | head -n 2");
    assert_string_equal(last_run.out, "ply\nformat ascii 1.0\n");
}

TEST(test_encodings) {
    run_done("ewa generate terrain -n 2000 -o a.ply && ewa convert a.ply -o big.ply --big-endian && "
             "ewa convert big.ply -o text.ply --ascii && ewa convert text.ply -o back.ply");
    assert_true(scratch_same("a.ply", "back.ply"));
    assert_false(scratch_same("a.ply", "big.ply"));
    scratch_text("small.ply", small_cloud);
    run_done("ewa convert small.ply -o - --ascii");
    assert_non_null(strstr(last_run.out, "property double x"));
    assert_non_null(strstr(last_run.out, "property float intensity"));
    assert_non_null(strstr(last_run.out, "500002.125 4000001.5 12 0 0 255 0.75"));
}

TEST(test_part) {
    run_done("ewa generate plane -n 10000 -o a.ply && ewa convert a.ply -o b.ply --crop 0,0,-1,1,1,1 && "
             "ewa info --json b.ply");
    assert_true(fabs(number_after("\"points\": ") - 2500) < 200);
    assert_true(number_after("\"low\": [") >= 0);
    run_done("ewa convert a.ply -o b.ply --subsample 100 && ewa convert a.ply -o c.ply --subsample 0.01 "
             "--threads 1 "
             "&& ewa info --json b.ply");
    assert_true(number_after("\"points\": ") == 100);
    assert_true(scratch_same("b.ply", "c.ply"));
    run_done("ewa convert a.ply -o b.ply --subsample 20000");
    assert_true(scratch_same("a.ply", "b.ply"));
    run_fails(1, "a.ply: none of the points is left", "ewa convert a.ply -o d.ply --crop 5,5,5,6,6,6");
    assert_int_equal(scratch_size("d.ply"), -1);
}

TEST(test_move) {
    scratch_text(
        "disc.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "property float nx\nproperty float ny\nproperty float nz\nproperty float radius\nend_header\n"
        "1 2 3 0 0.6 0.8 0.5\n");
    run_done("ewa convert disc.ply -o - --ascii --scale 2 --translate 0.5,0,-1");
    assert_non_null(strstr(last_run.out, "end_header\n2.5 4 5 0 0.6 0.8 1\n"));
    // A quarter turn about x: y to z, z to -y.
    run_done("ewa convert disc.ply -o - --ascii --transform 1,0,0,0,0,0,-1,0,0,1,0,0,0,0,0,1");
    assert_non_null(strstr(last_run.out, "end_header\n1 -3 2 0 -0.8 0.6 0.5\n"));
    run_done("ewa convert disc.ply -o - --ascii --scale 1,1,2");
    assert_non_null(strstr(last_run.out, "end_header\n1 2 6 0 0.83205"));
    run_fails(1, "determinant", "ewa convert disc.ply -o a.ply --scale 0");
    run_fails(1, "last row", "ewa convert disc.ply -o a.ply --transform 1,0,0,0,0,1,0,0,0,0,1,0,0,0,1,1");
}

TEST(test_merge) {
    run_done("ewa generate sphere -n 300 -o a.ply && ewa generate torus -n 200 -o b.ply && "
             "ewa convert a.ply b.ply -o c.ply && ewa info --json c.ply");
    assert_true(number_after("\"points\": ") == 500);
    assert_non_null(strstr(last_run.out, "\"name\": \"color\""));
    scratch_text("small.ply", small_cloud);
    assert_int_equal(run("ewa convert small.ply b.ply -o d.ply && ewa info --json d.ply"), 0);
    assert_non_null(strstr(last_run.err, "ewa: warning: attribute 'intensity': 1 of 2 clouds lack it"));
    assert_non_null(strstr(last_run.err, "attribute 'normal' of cloud 2 is dropped"));
    assert_true(number_after("\"points\": ") == 203);
    assert_non_null(strstr(last_run.out, "\"high\": [500002.125, 4000001.5, 12]"));
    run_done("ewa convert --quiet small.ply b.ply -o d.ply");
}

TEST(test_surfels) {
    run_done("ewa generate sphere -n 5000 --positions-only -o a.ply && ewa surfels a.ply -o b.ply && "
             "ewa info --json b.ply");
    assert_non_null(strstr(last_run.out, "\"name\": \"normal\""));
    assert_non_null(strstr(last_run.out, "\"name\": \"radius\""));
    assert_true(number_after("\"zero_normals\": ") == 0);
    run_done("ewa surfels a.ply -o c.ply --shape ellipse --neighbours 12 && ewa info --json c.ply");
    assert_non_null(strstr(last_run.out, "\"name\": \"tangent_u\""));
    run_done("ewa surfels a.ply -o d.ply --viewpoint 0,0,10 --outliers 3");
}

/// Refitted colours are floats beyond [0, 1]; what they need and a file lacks is estimated.
TEST(test_refit) {
    run_done("ewa generate checker -n 4000 --radius-scale 1.6 -o a.ply && "
             "ewa convert a.ply -o b.ply --refit-colors interpolate && ewa info --json b.ply");
    const char *color = strstr(last_run.out, "\"color\"");
    assert_non_null(color);
    assert_int_equal(strncmp(strstr(color, "\"type\": ") + 8, "\"float\"", 7), 0);
    assert_true(strtod(strstr(color, "\"low\": [") + 8, NULL) < 0);
    run_done("ewa generate checker -n 4000 --positions-only -o a.ply && "
             "ewa convert a.ply -o b.ply --refit-colors fit && ewa info b.ply");
    assert_non_null(strstr(last_run.out, "radius"));
    scratch_text("bare.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                             "property float z\nend_header\n0 0 0\n");
    run_fails(1, "no 'color'", "ewa convert bare.ply -o b.ply --refit-colors fit");
    run_fails(2, "interpolate", "ewa convert a.ply -o b.ply --refit-colors sharp");
}

/// Solid textures on all that makes clouds, the same for any number of threads.
TEST(test_procedure) {
    run_done("ewa generate torus -n 3000 --procedure marble -o a.ply && "
             "ewa generate torus -n 3000 --procedure marble -o b.ply --threads 3 && "
             "ewa generate torus -n 3000 --procedure marble --procedure-seed 2 -o c.ply && "
             "ewa generate torus -n 3000 -o d.ply");
    run_done("cmp a.ply b.ply && ! cmp -s a.ply c.ply && ! cmp -s a.ply d.ply");
    run_done("ewa convert d.ply --procedure marble -o e.ply && cmp a.ply e.ply");
    run_done(
        "ewa generate plane -n 100 --procedure checker --frequency 1e6 --first-color 1,1,1 --second-color "
        "0,0,0 -o a.ply && ewa convert a.ply -o - --ascii");
    assert_non_null(strstr(last_run.out, " 188 188 188 "));
    run_done("ewa generate plane -n 100 --positions-only --procedure noise --prefilter-scale 0 -o a.ply");
    run_fails(2, "--prefilter-scale 0", "ewa generate plane --positions-only --procedure noise -o a.ply");
    run_fails(2, "--frequency needs --procedure", "ewa generate plane --frequency 2 -o a.ply");
    run_fails(2, "must be in [0, 1]", "ewa generate plane --procedure wood --first-color 1,2,1 -o a.ply");
    run_fails(2, "exclude", "ewa generate plane --procedure wood --texture a.png -o a.ply");
}

/// Scene files: written by render, told of by info, refused with their place by both.
TEST(test_scenes) {
    run_done("ewa generate torus -o ring.ply -n 2000");
    run_done("ewa render ring.ply ring.ply -o made.png --size 64x48 --save-scene two.json --color-by z "
             "--filter 'z>0'");
    run_done("ewa render two.json -o again.png");
    assert_true(scratch_same("made.png", "again.png"));
    assert_null(strstr(last_run.err, "measurements"));
    scratch_text("noted.json", "{\"ewa_scene\": 1, \"items\": [{\"file\": \"ring.ply\"}], \"measures\": [{\"kind\": \"note\", "
                               "\"name\": \"here\", \"places_world\": [0, 0, 0]}]}");
    assert_int_equal(run("ewa render noted.json -o noted.png --size 64x48"), 0);
    assert_non_null(strstr(last_run.err, "noted.json: its measurements and notes are left out"));
    run_done("ewa info two.json");
    assert_non_null(strstr(last_run.out, "items       2"));
    assert_non_null(strstr(last_run.out, "camera      64 x 48"));
    run_done("ewa info --json two.json");
    assert_non_null(strstr(last_run.out, "\"format\": \"scene\""));
    assert_non_null(strstr(last_run.out, "\"kind\": \"points\""));
    scratch_text("bad.json", "{\"ewa_scene\": 1, \"items\": [{\"file\": \"ring.ply\", \"opacity\": 7}]}");
    run_fails(1, "bad.json: items[0].opacity: 7 is outside [0, 1]", "ewa info ring.ply bad.json");
    run_fails(1, "bad.json: items[0].opacity: 7 is outside [0, 1]", "ewa render bad.json -o never.png");
    assert_int_equal(scratch_size("never.png"), -1);
    scratch_text("none.json", "{\"ewa_scene\": 1}");
    run_fails(1, "none.json: there is nothing to draw", "ewa render none.json -o never.png");
    // A file that lies elsewhere cannot be named.
    run_done("mkdir -p below");
    run_fails(1, "ring.ply|below/elsewhere.json",
              "ewa render ring.ply -o below/p.png --save-scene below/elsewhere.json");
    assert_int_equal(scratch_size("below/elsewhere.json"), -1);
}

TEST(test_failures_leave_nothing) {
    assert_int_equal(scratch_enter("cli_files_none"), 0);
    run_fails(1, "none.ply: |No such file", "ewa convert none.ply -o a.ply");
    run_fails(2, "missing/a.ply|No such file", "ewa generate sphere -o missing/a.ply");
    run_fails(2, "a.abc", "ewa generate sphere -n 10 -o a.abc");
    assert_int_equal(scratch_count(), 0);
    run_done("mkdir sub.ply");
    run_fails(2, "sub.ply: is a folder", "ewa generate sphere -o sub.ply");
    run_fails(1, "sub.ply", "ewa info sub.ply");
    assert_int_equal(scratch_count(), 1);
    if (access("/dev/full", W_OK) == 0) {
        run_fails(1, "No space left", "ewa generate sphere -o - >/dev/full");
        run_fails(1, "standard output: cannot write: No space left", "ewa render --help >/dev/full");
    }
    // Files that lie in memory are of the format of their suffix, too.
    if (access("/dev/shm", W_OK) == 0) {
        run_done("f=$(mktemp /dev/shm/ewa_XXXXXX.laz) && ewa generate sphere -n 50 -o $f; head -c 4 $f >magic; "
                 "rm -f $f; test $(cat magic) = LASF");
        run_done("f=$(mktemp /dev/shm/ewa_XXXXXX.xyz) && ewa generate sphere -n 50 -o s.ply && "
                 "ewa convert s.ply -o $f; head -c 3 $f >magic; rm -f $f; test $(cat magic) != ply");
        run_fails(2, "/dev/shm/a.abc", "ewa generate sphere -n 10 -o /dev/shm/a.abc");
    }
    // What is no regular file takes the bytes and stays what it is; a link stays one; a mode stays.
    run_done("mkfifo pipe && (cat pipe >got &) && ewa generate sphere -n 50 -o s.ply && "
             "ewa render s.ply -o s.png --size 9x9 --stats pipe && sleep 0.1 && test -p pipe && grep -q "
             "splats got");
    run_done("touch there && chmod 640 there && ln -s there link && ewa render s.ply -o s.png --size 9x9 "
             "--stats link && "
             "test -L link && grep -q splats there && test $(stat -c %%a there) = 640");
    // A reader that goes away is no reason to speak, nor to succeed.
    assert_int_equal(
        run("ewa generate sphere -n 1000000 -o - 2>said | head -c 10 >head; test $(wc -c <head) = 10"), 0);
}

int main(void) { return RUN_TESTS(enter, NULL); }
