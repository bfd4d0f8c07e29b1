// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures of Gaussians by the program: upright, among surfaces, as surfels, films; what cannot be is said.
#include "check_pictures.h"

#include <math.h>

static const char head[] =
    "ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
    "property float z\nproperty float f_dc_0\nproperty float f_dc_1\nproperty float f_dc_2\n"
    "property float opacity\nproperty float scale_0\nproperty float scale_1\n"
    "property float scale_2\nproperty float rot_0\nproperty float rot_1\n"
    "property float rot_2\nproperty float rot_3\nend_header\n%s";

/// One of an upright pair: red above (y is down), blue below; with green ahead of both, or behind them.
static int enter(void **state) {
    char text[4096];
    const int status = scratch_enter("cli_splats");
    snprintf(text, sizeof text, head, 2,
             "0 -1 0 1.7 -1.7 -1.7 9 -1.5 -1.5 -1.5 1 0 0 0\n0 1 0 -1.7 -1.7 1.7 9 -1.5 -1.5 -1.5 1 0 0 0\n");
    scratch_text("pair.ply", text);
    snprintf(text, sizeof text, head, 3,
             "0 -1 0 1.7 -1.7 -1.7 9 -1.5 -1.5 -1.5 1 0 0 0\n0 1 0 -1.7 -1.7 1.7 9 -1.5 -1.5 -1.5 1 0 0 0\n"
             "0 0 -2 -2 2 -2 9 0.7 0.7 -3 1 0 0 0\n");
    scratch_text("translucent.ply", text);
    // A wall of points between.
    FILE *file = fopen(scratch_path("wall.ply"), "w");
    assert_non_null(file);
    fprintf(file,
            "ply\nformat ascii 1.0\nelement vertex 10000\nproperty float x\nproperty float y\n"
            "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n");
    for (int i = 0; i < 10000; i++)
        fprintf(file, "%g %g -1 255 255 0\n", 0.06 * (i % 100) - 3, 0.06 * (i / 100) - 3);
    fclose(file);
    WITH_DEFAULTS(ewa_context_options, options);
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    return status;
}

/// The colour at a share of the picture's width and height.
static const float *pixel(const ewa_image *image, double x, double y) {
    const size_t column = (size_t)(x * image->width_px), row = (size_t)(y * image->height_px);
    return image->pixels + image->channel_count * (row * image->width_px + column);
}

static void check_upright(const char *name) {
    OWNED(ewa_image_free) ewa_image image = load(name);
    const float *above = pixel(&image, 0.5, 0.2), *below = pixel(&image, 0.5, 0.8);
    if (!(above[0] > 0.8f && above[2] < 0.1f)) fail_msg("%s: not red above", name);
    if (!(below[2] > 0.8f && below[0] < 0.1f)) fail_msg("%s: not blue below", name);
}

TEST(upright) {
    run_done("ewa render pair.ply -o trained.png --size 100x200");
    check_upright("trained.png");
    run_done("ewa render pair.ply -o exact.png --size 100x200 --projection exact --azimuth 30");
    check_upright("exact.png");
    run_done("ewa convert pair.ply -o pair.spz && ewa render pair.spz -o spz.png --size 100x200");
    check_upright("spz.png");
    assert_int_equal(run("ewa render pair.ply -o a.png --size 10x20 --prefilter 0.5"), 0);
    assert_non_null(strstr(last_run.err, "--prefilter is for surfaces"));
    run_done("ewa convert pair.ply -o pair.splat && ewa render pair.splat -o splat.png --size 100x200");
    check_upright("splat.png");
    run_done("ewa convert pair.ply -o small.ply --scale 0.001 && ewa render small.ply -o small.png --size "
             "100x200");
    check_upright("small.png");
    run_done("ewa render pair.ply -o one.png --size 100x200 --threads 1 && "
             "ewa render pair.ply -o three.png --size 100x200 --threads 3");
    assert_true(scratch_same("one.png", "three.png") && scratch_same("one.png", "trained.png"));
}

/// What is ahead hides what is behind; a wall hides all of what is behind it.
TEST(hidden) {
    run_done("ewa render translucent.ply -o veiled.png --size 100x200");
    OWNED(ewa_image_free) ewa_image image = load("veiled.png");
    assert_true(pixel(&image, 0.5, 0.3)[1] > 0.8f && pixel(&image, 0.5, 0.3)[0] < 0.3f);
    ewa_image_free(&image);
    run_done("ewa render translucent.ply wall.ply -o wall.png --size 100x200 --shading none");
    image = load("wall.png"); // the translucent layer is before the wall
    assert_true(pixel(&image, 0.5, 0.5)[1] > 0.8f && pixel(&image, 0.5, 0.5)[0] < 0.3f);
    ewa_image_free(&image);
    run_done("ewa render wall.ply pair.ply -o behind.exr --size 100x200 --shading none");
    image = load("behind.exr"); // yellow everywhere
    const float *middle = pixel(&image, 0.5, 0.3);
    assert_true(middle[0] > 0.9f && middle[1] > 0.9f && middle[2] < 0.1f);
}

/// Several sets, volumes and surfaces are in one order of depth, in whichever order they are named.
TEST(together) {
    run_done("ewa generate ball -o ball.nrrd --extent 3 && ewa generate sphere -o sphere.ply --extent 0.8");
    run_done("ewa generate ball -o between.nrrd --extent 1 && "
             "ewa render pair.ply between.nrrd -o ball.png --size 100x200 --shading none");
    ewa_image image = load("ball.png"); // between red and blue, neither
    const float *middle = pixel(&image, 0.5, 0.5);
    assert_true(fabsf(middle[0] - 1) + fabsf(middle[1] - 1) + fabsf(middle[2] - 1) > 0.05f);
    ewa_image_free(&image);
    check_upright("ball.png");
    run_done("ewa render translucent.ply ball.nrrd sphere.ply -o all.png --size 100x200 && "
             "ewa render sphere.ply ball.nrrd translucent.ply -o turned.png --size 100x200");
    assert_true(scratch_same("all.png", "turned.png"));
    image = load("all.png"); // the translucent layer is before all
    assert_true(pixel(&image, 0.5, 0.5)[1] > 0.8f && pixel(&image, 0.5, 0.5)[0] < 0.3f);
    ewa_image_free(&image);
    run_done("ewa render pair.ply translucent.ply -o sets.png --size 100x200");
    image = load("sets.png");
    assert_true(pixel(&image, 0.5, 0.3)[1] > 0.8f && pixel(&image, 0.5, 0.3)[0] < 0.3f);
    ewa_image_free(&image);
    run_done("ewa render ball.nrrd sphere.ply -o inside.exr --size 60x60 --transfer fog --aov depth=z.pfm "
             "--background 0,0,0 --stats stats.json");
    run_done("ewa render ball.nrrd ball.nrrd -o twice.exr --size 60x60 --transfer fog --background 0,0,0 && "
             "ewa render ball.nrrd sphere.ply -o denser.exr --size 60x60 --transfer fog --opacity-scale 9 "
             "--background 0,0,0");
    ewa_image thin = load("inside.exr"), dense = load("denser.exr");
    float apart = 0;
    for (size_t i = 0; i < 60 * 60; i++)
        apart =
            fmaxf(apart, fabsf(thin.pixels[thin.channel_count * i] - dense.pixels[dense.channel_count * i]));
    assert_true(apart > 0.05f);
    ewa_image_free(&thin);
    ewa_image_free(&dense);
    // Sections cut all three.
    run_done("ewa render pair.ply -o cut.png --size 100x200 --clip-plane 0,1,0,0"); // what is below is left
    image = load("cut.png");
    assert_true(pixel(&image, 0.5, 0.8)[2] > 0.8f && pixel(&image, 0.5, 0.8)[0] < 0.1f);
    assert_true(pixel(&image, 0.5, 0.1)[1] > 0.99f);
    ewa_image_free(&image);
    run_done(
        "ewa volume ball.nrrd -o whole.exr --size 60x60 --view front --transfer fog && "
        "ewa volume ball.nrrd -o half.exr --size 60x60 --view front --transfer fog --clip-box 0,-9,-9,9,9,9");
    ewa_image halves[2] = {load("whole.exr"), load("half.exr")};
    assert_true(pixel(&halves[0], 0.4, 0.5)[0] > 0.1f && pixel(&halves[1], 0.4, 0.5)[0] == 0);
    assert_true(fabsf(pixel(&halves[0], 0.6, 0.5)[0] - pixel(&halves[1], 0.6, 0.5)[0]) < 1e-3f);
    for (int k = 0; k < 2; k++) ewa_image_free(&halves[k]);
    run_fails(2, "--clip-box", "ewa volume ball.nrrd -o x.png --clip-box 1,0,0,0,1,1");
    // A volume alone is that of its own command.
    run_done("ewa render ball.nrrd -o r.png --size 64x48 --background 0,0,0 && "
             "ewa volume ball.nrrd -o v.png --size 64x48 --background 0,0,0");
    assert_true(scratch_same("r.png", "v.png"));
    run_done("ewa render ball.nrrd sphere.ply -o r.png --size 64x48 --aov normal=y.pfm,depth=z.pfm");
    run_fails(1, "none.nrrd", "ewa render none.nrrd sphere.ply -o x.png");
    run_fails(1, "none.json", "ewa render ball.nrrd sphere.ply -o x.png --transfer none.json");
}

/// The defaults are the order of centres of the trained projection and that of rays of the exact one; a scene file keeps
/// what was said.
TEST(ordered) {
    char text[4096];
    snprintf(text, sizeof text, head, 2,
             "0 0 -0.01 1.7 -1.7 -1.7 1 0 0 -5 0.94 0 0.34 0\n0 0 0 -1.7 -1.7 1.7 1 0 0 -5 0.94 0 -0.34 0\n");
    scratch_text("crossing.ply", text);
    run_done("ewa render crossing.ply -o trained.png --size 80x60 && "
             "ewa render crossing.ply -o centre.png --size 80x60 --order centre && "
             "ewa render crossing.ply -o ray.png --size 80x60 --order ray --save-scene ray.json && "
             "ewa render ray.json -o again.png && "
             "ewa render crossing.ply -o exact.png --size 80x60 --projection exact && "
             "ewa render crossing.ply -o exact_ray.png --size 80x60 --projection exact --order ray && "
             "ewa render crossing.ply -o exact_centre.png --size 80x60 --projection exact --order centre");
    assert_true(scratch_same("trained.png", "centre.png") && scratch_same("ray.png", "again.png"));
    assert_true(scratch_same("exact.png", "exact_ray.png"));
    assert_false(scratch_same("centre.png", "ray.png") || scratch_same("exact.png", "exact_centre.png"));
    // Two units from the eye nothing is left that is nearer than three.
    assert_int_equal(run("ewa render crossing.ply -o near.png --size 80x60 --eye 0,0,-2 --target 0,0,0 --gaussian-near 3"), 0);
    assert_non_null(strstr(last_run.err, "sees none of the 2 splats"));
    run_done("ewa render crossing.ply -o seen.png --size 80x60 --eye 0,0,-2 --target 0,0,0 --gaussian-near 1 && "
             "ewa render crossing.ply -o usual.png --size 80x60 --eye 0,0,-2 --target 0,0,0 --gaussian-near auto");
    ewa_image image = load("near.png");
    for (size_t i = 0; i < 80 * 60; i++)
        for (size_t c = 0; c < 3; c++) assert_true(image.pixels[image.channel_count * i + c] == 1);
    ewa_image_free(&image);
    assert_true(scratch_same("seen.png", "usual.png") && !scratch_same("seen.png", "near.png"));
    run_fails(2, "--order", "ewa render crossing.ply -o x.png --order depth");
    run_fails(2, "--gaussian-near", "ewa render crossing.ply -o x.png --gaussian-near -1");
}

TEST(surfaces) {
    run_done(
        "ewa render pair.ply -o surface.png --surface --shading none --size 100x200 --up 0,-1,0 --view front "
        "--aov normal=normal.pfm");
    ewa_image image = load("surface.png");
    assert_true(pixel(&image, 0.5, 0.2)[0] > 0.8f);
    ewa_image_free(&image);
    run_done("ewa render pair.ply translucent.ply -o both.png --surface --size 50x50");
}

TEST(films) {
    run_done("ewa render pair.ply -o turn_%%d.png --turntable 4 --size 60x120 --stats stats.json "
             "--save-camera cameras.json");
    for (int i = 0; i < 4; i++) {
        char name[16];
        snprintf(name, sizeof name, "turn_%d.png", i);
        check_upright(name);
    }
    run_done("ewa render pair.ply -o again.png --camera cameras.json --camera-index 2");
    assert_true(scratch_same("again.png", "turn_2.png"));
}

TEST(refused) {
    const int before = scratch_count();
    run_fails(1, "pair.ply: |no attribute 'class'|opacity, size", "ewa render pair.ply -o x.png --color-by class");
    assert_int_equal(run("ewa render pair.ply -o lit.png --size 20x20 --shading phong --opacity 0.5"), 0);
    assert_non_null(strstr(last_run.err, "--opacity is for surfaces, and there are none"));
    assert_non_null(strstr(last_run.err, "--shading is for surfaces"));
    run_done("ewa render pair.ply wall.ply -o lit.png --size 20x20 --shading phong && rm lit.png");
    assert_null(strstr(last_run.err, "is for surfaces"));
    run_fails(2, "projection", "ewa render pair.ply -o x.png --projection affine");
    run_fails(1, "missing.ply", "ewa render pair.ply missing.ply -o x.png");
    assert_int_equal(run("head -c 300 pair.ply > cut.ply; ewa render cut.ply -o x.png"), 1);
    assert_int_equal(scratch_count(), before + 1);
}

int main(void) { return RUN_TESTS(enter, leave); }
