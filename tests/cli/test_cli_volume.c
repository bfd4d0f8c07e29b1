// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// volume, and what info and generate do with volumes: pictures that come out as asked for, wrong usage, bad
// input.
#include "check_pictures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int enter(void **state) {
    context = check_context(0, NULL);
    if (scratch_enter("cli_volume") != 0) return -1;
    return run(
        "ewa generate blob -o blob.nrrd --dims 24 && ewa generate ball -o ball.nrrd --dims 32,24,28 && "
        "ewa generate checkerbox -o box.nrrd --dims 24 --checks 4 && "
        "ewa generate vessels -o vessels.nrrd --dims 48");
}

/// Share of the pixels of a picture whose alpha is above a half; its middle is in `place`.
static double covered(const char *name, double place[2]) {
    OWNED(ewa_image_free) ewa_image image = load(name);
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
    return share;
}

TEST(test_info) {
    assert_int_equal(run("ewa info ball.nrrd"), 0);
    assert_non_null(strstr(last_run.out, "32 x 24 x 28 voxels of float"));
    assert_non_null(strstr(last_run.out, "values      0 .. 0.99"));
    // What would be seen, and the same in the words of a file of --transfer.
    assert_non_null(strstr(last_run.out, "  transfer    "));
    // And as which way is up, with the reason, as of points.
    assert_non_null(strstr(last_run.out, "  up          z ("));
    assert_int_equal(run("ewa info --json ball.nrrd box.nrrd"), 0);
    assert_non_null(strstr(last_run.out, "\"transfer\""));
    assert_non_null(strstr(last_run.out, "\"extinction\""));
    assert_non_null(strstr(last_run.out, "\"up_because\""));
    run_done("ewa info --json ball.nrrd | sed -n '/\"transfer\"/,/^      }/p' | sed '1s/.*/{/' > t.json");
    run_done("ewa volume ball.nrrd -o a.png --size 32x32 --transfer t.json && ewa volume ball.nrrd -o b.png "
             "--size 32x32");
    assert_true(scratch_same("a.png", "b.png"));
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

TEST(test_generate) {
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
TEST(test_pictures) {
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

/// The largest alpha at the rim of a picture, and how much of its width or height is covered.
static double at_rim(const char *name, double *extent) {
    OWNED(ewa_image_free) ewa_image image = load(name);
    const uint32_t width = image.width_px, height = image.height_px;
    uint32_t low[2] = {width, height}, high[2] = {0, 0};
    double maximum = 0;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const double alpha = (double)image.pixels[4 * ((size_t)y * width + x) + 3];
            if (x == 0 || y == 0 || x + 1 == width || y + 1 == height) maximum = fmax(maximum, alpha);
            if (alpha < 2.0 / 255) continue;
            low[0] = x < low[0] ? x : low[0], high[0] = x > high[0] ? x : high[0];
            low[1] = y < low[1] ? y : low[1], high[1] = y > high[1] ? y : high[1];
        }
    *extent = fmax((high[0] - low[0] + 1.0) / width, (high[1] - low[1] + 1.0) / height);
    return maximum;
}

/// Nothing of what can be seen touches the frame, however faint it is and however few voxels there are.
TEST(test_framed_whole) {
    scratch_text("few.nrrd", "NRRD0004\ntype: float\ndimension: 3\nsizes: 3 9 1\nspacings: 1 2 1\nencoding: "
                             "txt\n\n1 2 3 4 5 6 7 8 "
                             "9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27");
    scratch_text("row.nrrd",
                 "NRRD0004\ntype: float\ndimension: 1\nsizes: 9\nencoding: txt\n\n1 2 3 4 5 6 7 8 9");
    static const char *const volumes[] = {"ball.nrrd", "blob.nrrd", "vessels.nrrd", "few.nrrd", "row.nrrd"};
    static const char *const looks[] = {"fog", "gray", "auto", "mri", "skin"};
    for (size_t v = 0; v < sizeof volumes / sizeof volumes[0]; v++)
        for (size_t n = 0; n < 2 * sizeof looks / sizeof looks[0]; n++) {
            double extent;
            run_done("ewa volume %s -o f.exr --size 72x60 --background transparent --transfer %s %s",
                     volumes[v], looks[n / 2], n % 2 ? "--view iso" : "");
            const double rim = at_rim("f.exr", &extent);
            if (rim > 2.0 / 255 || extent < 0.3)
                fail_msg("%s, %s: %g at the rim, %g of the picture", volumes[v], looks[n / 2], rim, extent);
        }
}

/// A patient is seen from the front, a slice upright, what is unknown from a corner; options of the view
/// start from the front.
TEST(test_views) {
    run_done("ewa volume ball.nrrd -o a.png --size 40x40 && ewa volume ball.nrrd -o b.png --size 40x40 "
             "--view front");
    assert_true(scratch_same("a.png", "b.png"));
    run_done("head -c 18432 /dev/zero > z.raw && head -c 2048 /dev/urandom | od -An -v -tu1 | head -c 4000 "
             ">> z.raw; "
             "head -c 22432 z.raw > q_28x28x28_uint8.raw; head -c 21952 z.raw > q_28x28x28_uint8.raw");
    run_done("ewa volume q_28x28x28_uint8.raw -o a.png --size 40x40 && "
             "ewa volume q_28x28x28_uint8.raw -o b.png --size 40x40 --view iso");
    assert_true(scratch_same("a.png", "b.png"));
    run_done("ewa volume q_28x28x28_uint8.raw -o a.png --size 40x40 --azimuth 20 && "
             "ewa volume q_28x28x28_uint8.raw -o b.png --size 40x40 --azimuth 20 --view front");
    assert_true(scratch_same("a.png", "b.png"));
    // A picture: the first row is at the top, and bright where its numbers are large.
    scratch_text("slice.nrrd",
                 "NRRD0004\ntype: float\ndimension: 2\nsizes: 4 3\nencoding: txt\n\n9 9 9 9 9 1 1 1 9 1 1 1");
    run_done("ewa volume slice.nrrd -o slice.exr --size 80x60 --transfer gray --background transparent");
    OWNED(ewa_image_free) ewa_image image = load("slice.exr");
    double corners[4]; // the picture is three voxels high, and framed with some room
    for (int n = 0; n < 4; n++) {
        const size_t x = n % 2 ? 53 : 26, y = n / 2 ? 41 : 18;
        corners[n] = (double)image.pixels[4 * (y * 80 + x)];
    }
    for (int n = 0; n < 3; n++) assert_true(corners[n] > 0.1);
    assert_true(corners[3] < 0.02);
}

/// From within, voxels at the eye are there: fog is as dense as without.
TEST(test_from_within) {
    run_done("ewa generate checkerbox -o solid.nrrd --dims 24 --checks 1");
    run_done("ewa volume solid.nrrd -o in.exr --size 48x48 --transfer fog --eye 0,0,0 --target 0,1,0 "
             "--background transparent "
             "--stats in.json");
    ewa_image image = load("in.exr");
    for (int i = 3; i < 4 * 48 * 48; i += 4) assert_true(image.pixels[i] > 0.5f);
    ewa_image_free(&image);
    assert_int_equal(run("cat in.json"), 0);
    assert_null(strstr(last_run.out, "\"voxels_near\": 0"));
    assert_non_null(strstr(last_run.out, "\"voxels_near\""));
}

/// What is saved gives the same picture again; so do other thread counts and a coarse picture before.
TEST(test_same_again) {
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

TEST(test_looks) {
    static const char *const looks[] = {
        "--transfer bone",       "--transfer soft",   "--transfer skin", "--transfer vessels",
        "--transfer mri",        "--transfer gray",   "--transfer fog",  "--transfer auto",
        "--method points",       "--footprint table", "--shading none",  "--shading lambert",
        "--light 1,1,1,1,0.5,0", "--gradient 2,6",    "--range 0.5,0.9", "--range 50%%,99%%",
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

TEST(test_frames) {
    run_done("ewa volume ball.nrrd -o f_%%02d.png --turntable 3 --size 32x32");
    assert_true(scratch_size("f_00.png") > 0 && scratch_size("f_02.png") > 0);
    assert_int_equal(scratch_size("f_03.png"), -1);
}

/// A sphere within a thin fog is seen through it, in front of what is behind.
TEST(test_surfels_within) {
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
    // It is the scene of `ewa render`.
    run_done("ewa volume ball.nrrd -o both.png --size 48x48 --transfer fog --surfels sphere.ply --background white");
    run_done("ewa render ball.nrrd -o scene.png --size 48x48 --transfer fog sphere.ply");
    assert_true(scratch_same("both.png", "scene.png"));
}

TEST(test_wrong_usage) {
    run_fails(2, "-o FILE", "ewa volume blob.nrrd");
    run_fails(2, "--dims", "ewa volume blob.nrrd -o a.png --type float");
    run_fails(2, "--dims", "ewa volume blob.nrrd -o a.png --dims 0,1,1");
    run_fails(2, "--dims", "ewa volume blob.nrrd -o a.png --dims 1.5,1,1");
    run_fails(2, "--spacing", "ewa volume blob.nrrd -o a.png --spacing 1,0,1");
    run_fails(2, "normals", "ewa volume blob.nrrd -o a.png --aov normal=n.pfm");
    run_fails(2, "--progressive", "ewa volume blob.nrrd -o a_%%d.png --turntable 2 --progressive");
    run_fails(2, "--gradient", "ewa volume blob.nrrd -o a.png --gradient 2,1");
    run_fails(2, "--method", "ewa volume blob.nrrd -o a.png --method rays");
    run_fails(2, "a.bmp", "ewa volume blob.nrrd -o a.bmp");
    run_fails(2, "", "ewa volume -o a.png");
    assert_int_equal(scratch_size("a.bmp"), -1);
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

TEST(test_bad_input) {
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

TEST(test_nothing_to_draw) {
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
    assert_int_equal(scratch_size("out.png"), -1);
    // Numbers that are none among others, single voxels and slices are drawn.
    scratch_text("some.nrrd", NRRD "sizes: 2 2 2\n\n0 nan 0 0 1 0 0 2");
    assert_int_equal(run("ewa volume some.nrrd -o out.png --size 32x32"), 0);
    assert_non_null(strstr(last_run.err, "1 of 8 voxels"));
    scratch_text("two.nrrd", NRRD "sizes: 2 1 1\n\n0 1");
    run_done("ewa volume two.nrrd -o out.png --size 32x32");
}

int main(void) { return RUN_TESTS(enter, leave); }
