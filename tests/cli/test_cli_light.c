// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// render: materials, surroundings and eye-dome lighting from files and options.
#include <math.h>
#include <string.h>

#include "run_ewa.h"

static ewa_context *context;

/// A file of two discs, left and right, that face the eye at (0, 0, 5), with a material each.
static const char DISCS[] = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                            "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                            "property float radius\nproperty uchar material\nend_header\n"
                            "-1 0 0 0 0 1 0.9 0\n1 0 0 0 0 1 0.9 1\n";

/// The same place without materials.
static const char DISC[] = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                           "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                           "property float radius\nend_header\n0 1 0 0 0 1 0.9\n";

#define VIEW "--size 60x60 --eye 0,0,5 --target 0,0,0 --up 0,1,0 --fov 45"

static int enter(void **state) {
    context = check_context(0, NULL);
    if (scratch_enter("cli_light") != 0) return -1;
    scratch_text("discs.ply", DISCS);
    scratch_text("disc.ply", DISC);
    scratch_text("table.json", "[{\"ambient\": 0.5, \"diffuse\": 0, \"specular\": 0, \"reflection\": 0},"
                               " {\"ambient\": 0, \"diffuse\": 0, \"specular\": 0, \"reflection\": 1}]");
    // Light 4 from everywhere: mantissas of 128.5 / 256, exponent 3.
    char sky[256] = "#?RADIANCE\n\n-Y 2 +X 4\n";
    const size_t head = strlen(sky);
    for (size_t i = 0; i < 8; i++) memcpy(sky + head + 4 * i, "\x80\x80\x80\x83", 4);
    scratch_write("sky.hdr", sky, head + 32);
    return 0;
}

static int leave(void **state) {
    ewa_context_destroy(&context);
    return 0;
}

/// Red, linear, at a pixel of a .pfm picture.
static float red_at(const char *name, uint32_t x, uint32_t y) {
    OWNED(ewa_image_free) ewa_image image = {0};
    assert_int_equal(ewa_image_load(context, scratch_path(name), &image), EWA_OK);
    const float red = image.pixels[3 * (y * image.width_px + x)];
    return red;
}

TEST(test_materials_and_surroundings) {
    run_done("ewa render discs.ply -o a.pfm --materials table.json --env sky.hdr " VIEW);
    assert_true(fabsf(red_at("a.pfm", 15, 30) - 0.5f * 0.6f) < 1e-5f); // grey of 0.6
    assert_true(fabsf(red_at("a.pfm", 44, 30) - 4 * 128.5f / 128) < 1e-4f);
    run_done("ewa render discs.ply -o b.pfm --materials table.json --env sky.hdr --env-up 1,2,3 "
             "--shading phong " VIEW);
    assert_true(fabsf(red_at("b.pfm", 44, 30) - 4 * 128.5f / 128) < 1e-4f); // the same all around
    // A file without materials beside one that has some is of the first one.
    run_done("ewa render discs.ply disc.ply -o c.pfm --materials table.json --env sky.hdr " VIEW);
    assert_true(fabsf(red_at("c.pfm", 30, 15) - 0.5f * 0.6f) < 1e-5f);
    assert_true(red_at("c.pfm", 44, 30) == red_at("a.pfm", 44, 30));
}

TEST(test_lights) {
    run_done("ewa render disc.ply -o a.pfm --ambient 0 --light 0,0,1,0.5,1,1 --light 0,0,1,0.25,0,0 " VIEW);
    assert_true(fabsf(red_at("a.pfm", 30, 15) - 0.75f * 0.6f) < 1e-5f);
}

TEST(test_what_is_wrong_is_named) {
    scratch_text("short.json", "[{}]");
    scratch_text("wrong.json", "[{\"shine\": 1}]");
    run_fails(1, "material 1, the table has 1", "ewa render discs.ply -o a.png --materials short.json");
    run_fails(1, "wrong.json: material 0 has an unknown member 'shine'",
              "ewa render discs.ply -o a.png --materials wrong.json");
    run_fails(1, "nowhere.json", "ewa render discs.ply -o a.png --materials nowhere.json");
    run_fails(1, "table.json: no picture", "ewa render discs.ply -o a.png --env table.json");
    assert_int_equal(scratch_size("a.png"), -1);
}

int main(void) { return RUN_TESTS(enter, leave); }
