// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// volume, and what info and generate do with volumes: pictures that come out as asked for, wrong usage, bad
// input.
#include "run_ewa.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static ewa_context *context;

static int enter(void **state) {
    (void)state;
    context = check_context(0, NULL);
    if (scratch_enter("cli_volume") != 0) return -1;
    return run(
        "ewa generate blob -o blob.nrrd --dims 24 && ewa generate ball -o ball.nrrd --dims 32,24,28 && "
        "ewa generate checkerbox -o box.nrrd --dims 24 --checks 4 && "
        "ewa generate vessels -o vessels.nrrd --dims 48");
}

static int leave(void **state) {
    (void)state;
    ewa_context_destroy(&context);
    return 0;
}

static ewa_image load(const char *name) {
    ewa_image image = {0};
    assert_int_equal(ewa_image_load(context, scratch_path(name), &image), EWA_OK);
    return image;
}

/// Share of the pixels of a picture whose alpha is above a half; its middle is in `place`.
static double covered(const char *name, double place[2]) {
    ewa_image image = load(name);
    assert_int_equal(image.channel_count, 4);
    double count = 0;
    place[0] = place[1] = 0;
    for (uint32_t y = 0; y < image.height_px; y++)
        for (uint32_t x = 0; x < image.width_px; x++) {
            if (image.pixels[4 * ((size_t)y * image.width_px + x) + 3] <= 0.5f) continue;
            count++;
            place[0] += x;
            place[1] += y;
        }
    for (int k = 0; k < 2 && count > 0; k++) place[k] /= count;
    const double share = count / ((double)image.width_px * image.height_px);
    ewa_image_free(&image);
    return share;
}

static void test_info(void **state) {
    (void)state;
    assert_int_equal(run("ewa info ball.nrrd"), 0);
    assert_non_null(strstr(last_run.out, "32 x 24 x 28 voxels of float"));
    assert_non_null(strstr(last_run.out, "values      0 .. 0.99"));
    assert_int_equal(run("ewa info --json ball.nrrd box.nrrd"), 0);
    assert_non_null(strstr(last_run.out, "\"dims\": [32, 24, 28]"));
    assert_non_null(strstr(last_run.out, "\"type\": \"uchar\""));
    assert_non_null(strstr(last_run.out, "\"percentile_50\""));
    // Raw numbers, by options and by their name.
    scratch_write("six", "\1\2\3\4\5\6", 6);
    assert_int_equal(run("ewa info six --dims 3,1,1 --type ushort --big-endian"), 0);
    assert_non_null(strstr(last_run.out, "values      258 .. 1286"));
    assert_int_equal(run("cp six six_1x2x3_uint8.raw && ewa info six_1x2x3_uint8.raw --spacing 1,2,3"), 0);
    assert_non_null(strstr(last_run.out, "spacing     1 2 3"));
    assert_int_equal(run("ewa generate torus -n 100 -o torus.ply && ewa info torus.ply ball.nrrd"), 0);
    assert_non_null(strstr(last_run.out, "points      1"));
}

static void test_generate(void **state) {
    (void)state;
    run_done("ewa generate vessels -o again.nrrd --dims 48 --threads 3");
    assert_true(scratch_same("vessels.nrrd", "again.nrrd"));
    run_done("ewa generate vessels -o other.nrrd --dims 48 --seed 9");
    assert_false(scratch_same("vessels.nrrd", "other.nrrd"));
    assert_int_equal(run("ewa generate blob -o - --dims 8 | ewa info - --dims 1,1,1 --type uchar"), 1);
    run_fails(2, ".nrrd", "ewa generate blob -o blob.ply");
    run_fails(2, "--dims", "ewa generate torus -o torus.ply --dims 32");
    run_fails(2, "--dims", "ewa generate blob -o b.nrrd --dims 1");
    run_fails(2, "--dims", "ewa generate blob -o b.nrrd --dims 8,8");
    run_fails(2, "of a volume", "ewa generate blob -o b.nrrd --points 7");
    run_fails(2, "checkerbox|did you mean vessels", "ewa generate vesels -o b.nrrd");
}

/// Framed whole and in the middle, from every side and in every kind of file.
static void test_pictures(void **state) {
    (void)state;
    static const char *const views[] = {"",           "--view left", "--view top",
                                        "--view iso", "--ortho 1.2", "--azimuth 40 --elevation -20"};
    for (size_t i = 0; i < sizeof views / sizeof views[0]; i++) {
        double place[2];
        run_done("ewa volume ball.nrrd -o ball.exr --size 90x60 --background transparent %s", views[i]);
        const double share = covered("ball.exr", place);
        if (share < 0.08 || share > 0.6 || fabs(place[0] - 44.5) > 5 || fabs(place[1] - 29.5) > 4)
            fail_msg("'%s': %g covered about %g, %g", views[i], share, place[0], place[1]);
    }
    run_done("ewa volume ball.nrrd -o a.png --size 64x64 --aov depth=d.pfm,coverage=c.exr");
    ewa_image depth = load("d.pfm"), coverage = load("c.exr"), picture = load("a.png");
    assert_int_equal(picture.channel_count, 3);
    const size_t middle = 32 * 64 + 32;
    assert_true(isfinite(depth.pixels[middle]) && isinf(depth.pixels[0]));
    assert_true(coverage.pixels[middle] > 0.9f && coverage.pixels[0] == 0);
    assert_true(picture.pixels[3 * middle] > 0.3f && picture.pixels[0] == 0);
    ewa_image_free(&depth);
    ewa_image_free(&coverage);
    ewa_image_free(&picture);
    assert_int_equal(run("ewa volume ball.nrrd -o - --size 32x32 | head -c 4"), 0);
    assert_non_null(strstr(last_run.out, "PNG"));
}

/// What is saved gives the same picture again; so do other thread counts and a coarse picture before.
static void test_same_again(void **state) {
    (void)state;
    run_done("ewa volume vessels.nrrd -o a.png --size 80x80 --azimuth 30 --threads 1 --save-camera c.json "
             "--save-transfer t.json --stats s.json");
    run_done("ewa volume vessels.nrrd -o b.png --threads 3 --camera c.json --transfer t.json --progressive");
    assert_true(scratch_same("a.png", "b.png"));
    assert_int_equal(run("cat s.json"), 0);
    assert_non_null(strstr(last_run.out, "\"voxels\": 110592"));
    assert_non_null(strstr(last_run.out, "\"splats_drawn\""));
    run_done("ewa volume vessels.nrrd -o b.png --camera c.json --transfer t.json --opacity-scale 0.2");
    assert_false(scratch_same("a.png", "b.png"));
}

static void test_looks(void **state) {
    (void)state;
    static const char *const looks[] = {
        "--transfer bone",       "--transfer soft",   "--transfer skin", "--transfer vessels",
        "--transfer mri",        "--transfer gray",   "--transfer fog",  "--transfer auto",
        "--method points",       "--footprint table", "--shading none",  "--shading lambert",
        "--light 1,1,1,1,0.5,0", "--gradient 0.5,1",  "--range 0.5,0.9", "--range 50%%,99%%",
        "--sigma 0.9",           "--cutoff 2",        "--prefilter 1",   "--background 1,1,1",
    };
    run_done("ewa volume blob.nrrd -o plain.png --size 48x48");
    for (size_t i = 0; i < sizeof looks / sizeof looks[0]; i++) {
        char options[64];
        snprintf(options, sizeof options, looks[i], "");
        run_done("ewa volume blob.nrrd -o look.png --size 48x48 %s", options);
        if (scratch_same("plain.png", "look.png") != !strcmp(looks[i], "--transfer auto") &&
            strcmp(looks[i], "--footprint table") != 0)
            fail_msg("%s: %s", looks[i], scratch_same("plain.png", "look.png") ? "nothing new" : "other");
    }
}

static void test_frames(void **state) {
    (void)state;
    run_done("ewa volume ball.nrrd -o f_%%02d.png --turntable 3 --size 32x32");
    assert_true(scratch_size("f_00.png") > 0 && scratch_size("f_02.png") > 0);
    assert_int_equal(scratch_size("f_03.png"), -1);
}

/// A sphere within a thin fog is seen through it, in front of what is behind.
static void test_surfels_within(void **state) {
    (void)state;
    run_done("ewa generate sphere -n 3000 --extent 0.4 -o sphere.ply");
    run_done("ewa volume ball.nrrd -o fog.exr --size 48x48 --transfer fog --background transparent");
    run_done(
        "ewa volume ball.nrrd -o both.exr --size 48x48 --transfer fog --background transparent --surfels "
        "sphere.ply");
    ewa_image fog = load("fog.exr"), both = load("both.exr");
    const size_t middle = 4 * (24 * 48 + 24);
    assert_true(fog.pixels[middle + 3] < 0.9f);
    assert_true(both.pixels[middle + 3] > 0.99f);
    ewa_image_free(&fog);
    ewa_image_free(&both);
}

static void test_wrong_usage(void **state) {
    (void)state;
    run_fails(2, "-o FILE", "ewa volume blob.nrrd");
    run_fails(2, "--dims", "ewa volume blob.nrrd -o a.png --type float");
    run_fails(2, "--dims", "ewa volume blob.nrrd -o a.png --dims 0,1,1");
    run_fails(2, "--dims", "ewa volume blob.nrrd -o a.png --dims 1.5,1,1");
    run_fails(2, "--spacing", "ewa volume blob.nrrd -o a.png --spacing 1,0,1");
    run_fails(2, "normals", "ewa volume blob.nrrd -o a.png --aov normal=n.pfm");
    run_fails(2, "--progressive", "ewa volume blob.nrrd -o a_%%d.png --turntable 2 --progressive");
    run_fails(2, "--gradient", "ewa volume blob.nrrd -o a.png --gradient 2,1");
    run_fails(2, "--method", "ewa volume blob.nrrd -o a.png --method rays");
    run_fails(2, "a.jpg", "ewa volume blob.nrrd -o a.jpg");
    run_fails(2, "", "ewa volume -o a.png");
    assert_int_equal(scratch_size("a.jpg"), -1);
}

#define NRRD "NRRD0004\ntype: float\ndimension: 3\nencoding: txt\n"

/// info and volume refuse the file with these words, and nothing is written.
static void refuse(const char *name, const char *options, const char *said) {
    const int before = scratch_count();
    char words[512];
    snprintf(words, sizeof words, "%s: |%s", name, said);
    run_fails(1, words, "ewa volume %s -o out.png --size 32x32 --stats out.json %s", name, options);
    run_fails(1, words, "ewa info %s %s", name, options);
    assert_int_equal(scratch_count(), before);
}

static void test_bad_input(void **state) {
    (void)state;
    refuse("none.nrrd", "", "No such file");
    run_done("mkdir -p folder.nrrd");
    refuse("folder.nrrd", "", "");
    scratch_text("empty.nrrd", "");
    refuse("empty.nrrd", "", "no volume");
    scratch_text("words.nii", "not a volume at all");
    refuse("words.nii", "", "no volume");
    scratch_write("raw.raw", "12345678", 8);
    refuse("raw.raw", "", "dims");
    refuse("raw.raw", "--dims 3,3,1", "9 bytes|8 are there");
    refuse("raw.raw", "--dims 2,2,1", "4 bytes|8 are there");
    refuse("raw.raw", "--dims 4000000000,4000000000,4000000000", "limit");
    run_done("gzip -c blob.nrrd > whole.raw.gz; head -c 3000 whole.raw.gz > cut.raw.gz; rm whole.raw.gz");
    refuse("cut.raw.gz", "--dims 20,20,20", "end early");
    run_done("head -c 3000 blob.nrrd > cut.nrrd");
    refuse("cut.nrrd", "", "end early");
    scratch_text("type.nrrd", "NRRD0004\ntype: block\ndimension: 3\nsizes: 1 1 1\nencoding: raw\n\nx");
    refuse("type.nrrd", "", "block");
    scratch_text("zero.nrrd", NRRD "sizes: 2 1 1\nspacings: 1 0 1\n\n1 2");
    refuse("zero.nrrd", "", "zero");
    scratch_text("flat.nrrd",
                 NRRD "sizes: 2 1 1\nspace: LPS\nspace directions: (1,0,0) (1,0,0) (0,0,1)\n\n1 2");
    refuse("flat.nrrd", "", "one plane");
    scratch_text("huge.nrrd", NRRD "sizes: 4000000 4000000 4000000\n\n1 2");
    refuse("huge.nrrd", "", "limit");
}

static void test_nothing_to_draw(void **state) {
    (void)state;
    scratch_text("nan.nrrd", NRRD "sizes: 2 2 1\n\nnan nan inf nan");
    run_fails(1, "nan.nrrd: |no voxel is a finite number", "ewa volume nan.nrrd -o out.png --quiet");
    scratch_text("same.nrrd", NRRD "sizes: 2 2 1\n\n7 7 7 7");
    run_fails(1, "same.nrrd: |all voxels are 7", "ewa volume same.nrrd -o out.png");
    run_fails(1, "nosuch.json: |No such file|bone, soft",
              "ewa volume blob.nrrd -o out.png --transfer nosuch.json");
    scratch_text("look.json", "{\"points\": []}");
    run_fails(1, "look.json: |0 points", "ewa volume blob.nrrd -o out.png --transfer look.json");
    run_fails(1, "--range", "ewa volume blob.nrrd -o out.png --range 2,1");
    run_fails(1, "nosuch.ply", "ewa volume blob.nrrd -o out.png --surfels nosuch.ply");
    run_fails(1, "blob.nrrd: a volume|ewa volume", "ewa render blob.nrrd -o out.png");
    assert_int_equal(scratch_size("out.png"), -1);
    // Numbers that are none among others, single voxels and slices are drawn.
    scratch_text("some.nrrd", NRRD "sizes: 2 2 2\n\n0 nan 0 0 1 0 0 2");
    assert_int_equal(run("ewa volume some.nrrd -o out.png --size 32x32"), 0);
    assert_non_null(strstr(last_run.err, "1 of 8 voxels"));
    scratch_text("two.nrrd", NRRD "sizes: 2 1 1\n\n0 1");
    run_done("ewa volume two.nrrd -o out.png --size 32x32");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_info),           cmocka_unit_test(test_generate),
        cmocka_unit_test(test_pictures),       cmocka_unit_test(test_same_again),
        cmocka_unit_test(test_looks),          cmocka_unit_test(test_frames),
        cmocka_unit_test(test_surfels_within), cmocka_unit_test(test_wrong_usage),
        cmocka_unit_test(test_bad_input),      cmocka_unit_test(test_nothing_to_draw),
    };
    return cmocka_run_group_tests(tests, enter, leave);
}
