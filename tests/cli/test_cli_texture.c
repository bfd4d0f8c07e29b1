// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// texture: maps, formats, usage, broken input.
#include "check_pictures.h"
#include "image_difference.h"

#include <math.h>
#include <string.h>

static void save(const char *name, uint32_t channels) {
    OWNED(ewa_image_free) ewa_image image;
    assert_int_equal(ewa_image_create(context, 60, 40, channels, &image), EWA_OK);
    for (uint32_t i = 0; i < 60 * 40; i++)
        for (uint32_t c = 0; c < channels; c++)
            image.pixels[channels * i + c] = c == 3 ? 1.0f : (float)(i % 60 / 10 + i / 600 + c) / 12;
    assert_int_equal(ewa_image_save(&image, scratch_path(name), NULL), EWA_OK);
}

static int enter(void **state) {
    context = check_context(0, NULL);
    if (scratch_enter("cli_texture") != 0) return -1;
    save("grey.exr", 1);
    save("rgb.png", 3);
    save("rgb.pfm", 3);
    return 0;
}

/// The same map said in four ways gives the same picture.
TEST(test_maps) {
    run_done("ewa texture rgb.pfm -o a.exr --homography 2,0,10,0,2,5,0,0,1 --size 140x90");
    run_done("ewa texture rgb.pfm -o b.exr --homography -2,0,-10,0,-2,-5,0,0,-1 --size 140x90");
    run_done("ewa texture rgb.pfm -o c.exr --corners 10,5,130,5,130,85,10,85 --size 140x90");
    run_done(
        "ewa texture rgb.pfm -o d.exr --ortho 90 --eye 0,0,9 --target 0,0,0 --plane -60,40,0,120,0,0,0,-80,0 "
        "--size 140x90");
    OWNED(ewa_image_free) ewa_image a = load("a.exr");
    assert_int_equal(a.channel_count, 4);
    assert_true(a.pixels[3] == 0 && fabsf(a.pixels[4 * (45 * 140 + 70) + 3] - 1) < 1e-6f);
    for (const char *name = "bcd"; *name; name++) {
        const char file[] = {*name, '.', 'e', 'x', 'r', 0};
        OWNED(ewa_image_free) ewa_image other = load(file);
        const image_difference difference = image_compare(&a, &other, 0);
        assert_true(difference.maximum < 1e-4);
    }
}

/// All formats in and out, all methods; without a camera's options the whole image is seen.
TEST(test_files) {
    static const char *const inputs[] = {"grey.exr", "rgb.png", "rgb.pfm"}, *const outputs[] = {
                                                                                "o.png", "o.exr", "o.pfm"};
    static const char *const methods[] = {"hybrid", "splat", "point", "bilinear"};
    for (int k = 0; k < 12; k++) {
        run_done("ewa texture %s -o %s --method %s --size 90x70", inputs[k % 3], outputs[k / 4],
                 methods[k % 4]);
        OWNED(ewa_image_free) ewa_image image = load(outputs[k / 4]);
        assert_int_equal(image.width_px, 90);
        assert_true(image.pixels[0] == 0);
    }
    run_done("ewa texture rgb.png -o - --corners 0,0,60,0,60,40,0,40 >p.png && ewa texture rgb.png -o q.png "
             "--corners "
             "0,0,60,0,60,40,0,40");
    assert_true(scratch_same("p.png", "q.png"));
    ewa_image image = load("q.png");
    assert_int_equal(image.width_px, 60);
    assert_int_equal(image.channel_count, 3); // wholly covered
    ewa_image_free(&image);
    run_done("ewa texture rgb.png -o floor.png --repeat on --eye 0,-3,0.5 --target 0,1,0 --size 80x60 "
             "--background 0,0,1");
    run_done("ewa texture rgb.png -o one.png --threads 1 --size 80x60 && ewa texture rgb.png -o two.png "
             "--threads 2 --size 80x60");
    assert_true(scratch_same("one.png", "two.png"));
}

/// A JPEG has a quality, of 95 where nobody says; other formats have none.
TEST(test_jpeg_quality) {
    run_done("ewa texture rgb.png -o j.jpg --background 1,1,1 && ewa texture rgb.png -o j95.jpg --background 1,1,1 --quality 95 && "
             "ewa texture rgb.png -o j20.jpg --background 1,1,1 --quality 20");
    assert_true(scratch_same("j.jpg", "j95.jpg"));
    assert_true(scratch_size("j20.jpg") > 0 && scratch_size("j20.jpg") < scratch_size("j.jpg"));
    run_fails(2, "--quality is for JPEG", "ewa texture rgb.png -o n.png --quality 20");
    run_fails(2, "[0, 100]", "ewa texture rgb.png -o n.jpg --quality 101");
}

TEST(test_usage) {
    run_fails(2, "texture: no output", "ewa texture rgb.png");
    run_fails(2, "an input is missing", "ewa texture -o n.png");
    run_fails(2, "one operand too many", "ewa texture rgb.png rgb.pfm -o n.png");
    run_fails(2, "exclude each other",
              "ewa texture rgb.png -o n.png --corners 0,0,1,0,1,1,0,1 --homography 1,0,0,0,1,0,0,0,1");
    run_fails(2, "--corners and --eye exclude each other",
              "ewa texture rgb.png -o n.png --corners 0,0,1,0,1,1,0,1 --eye 1,2,3");
    run_fails(2, "--homography", "ewa texture rgb.png -o n.png --homography 1,2,3");
    run_fails(2, "--corners", "ewa texture rgb.png -o n.png --corners 0,0,nan,0,1,1,0,1");
    run_fails(2, "--repeat", "ewa texture rgb.png -o n.png --repeat on --method splat");
    run_fails(2, "--method", "ewa texture rgb.png -o n.png --method cubic");
    run_fails(2, "--prefilter", "ewa texture rgb.png -o n.png --prefilter 0");
    run_fails(2, "--output", "ewa texture rgb.png -o n.bmp");
    run_fails(1, "singular", "ewa texture rgb.png -o n.png --homography 1,2,3,2,4,6,0,0,1");
    run_fails(1, "singular", "ewa texture rgb.png -o n.png --homography 0,0,0,0,0,0,0,0,0");
    run_fails(1, "corners", "ewa texture rgb.png -o n.png --corners 0,0,5,5,5,0,0,5");
    run_fails(1, "plane", "ewa texture rgb.png -o n.png --plane 0,0,0,1,0,0,2,0,0 --eye 0,0,3");
    run_fails(1, "none.png", "ewa texture none.png -o n.png");
    run("head -c 100 rgb.png >short.png && echo no >text.png");
    run_fails(1, "short.png", "ewa texture short.png -o n.png");
    run_fails(1, "text.png", "ewa texture text.png -o n.png");
    run_fails(2, "nowhere", "ewa texture rgb.png -o nowhere/n.png");
    assert_int_equal(scratch_size("n.png"), -1);
}

int main(void) { return RUN_TESTS(enter, leave); }
