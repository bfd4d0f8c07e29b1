// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Help, version, wrong usage.
#include <string.h>

#include "run_ewa.h"

static int enter(void **state) { return scratch_enter("cli_usage"); }

static const char *const commands[] = {"render", "info", "convert", "surfels", "generate", "bench"};
enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };

TEST(test_program_help) {
    run_done("ewa --help");
    for (size_t i = 0; i < COMMAND_COUNT; i++) assert_non_null(strstr(last_run.out, commands[i]));
    run_done("ewa --version");
    char version[512];
    snprintf(version, sizeof version, "ewa %s\nwith %s\n", ewa_version(), ewa_parts());
    assert_string_equal(last_run.out, version);
    assert_non_null(strstr(ewa_parts(), "spng deflate cjson jpeg webp "));
    assert_int_equal(run("ewa"), 2);
    assert_non_null(strstr(last_run.err, "usage: ewa COMMAND"));
}

TEST(test_command_help) {
    for (size_t i = 0; i < COMMAND_COUNT; i++) {
        run_done("ewa %s --help", commands[i]);
        char usage[64];
        snprintf(usage, sizeof usage, "usage: ewa %s ", commands[i]);
        assert_int_equal(strncmp(last_run.out, usage, strlen(usage)), 0);
        assert_non_null(strstr(last_run.out, "\nExamples:\n  ewa "));
        assert_non_null(strstr(last_run.out, "  --threads N "));
        for (const char *line = last_run.out; *line;) {
            const size_t length = strcspn(line, "\n");
            assert_true(length <= 100);
            line += length + 1;
        }
    }
    run_done("ewa render --help");
    assert_non_null(strstr(last_run.out, "--size WxH"));
    assert_non_null(strstr(last_run.out, "; also --resolution"));
    run_done("ewa help render");
    assert_non_null(strstr(last_run.out, "usage: ewa render "));
}

TEST(test_page) {
    static const char *const rows[][2] = {{"--help-markdown", "cli.md"}, {"--help-json", "options.json"}};
    for (int i = 0; i < 2; i++) {
        run_done("ewa %s", rows[i][0]);
        char path[1024];
        snprintf(path, sizeof path, "%s/docs/%s", getenv("EWA_SOURCE_DIR"), rows[i][1]);
        FILE *file = fopen(path, "rb");
        assert_non_null(file);
        static char page[sizeof last_run.out];
        page[fread(page, 1, sizeof page - 1, file)] = 0;
        fclose(file);
        // When this fails: make docs
        assert_string_equal(page, last_run.out);
    }
}

TEST(test_wrong_usage) {
    run_fails(2, "'rendr': no such command; did you mean 'render'?", "ewa rendr");
    run_fails(2, "'--vresion': no such option; did you mean '--version'?", "ewa --vresion");
    run_fails(2, "'xyzzy': no such command; see 'ewa --help'", "ewa help xyzzy");
    run_fails(2,
              "'a scan.ply': a file, no command; to look at it: ewa view 'a scan.ply'; to draw it: ewa "
              "render 'a scan.ply' -o "
              "picture.png",
              "touch 'a scan.ply' && ewa 'a scan.ply'");
    run_done("rm 'a scan.ply'");
    run_fails(2, "an input is missing; usage: ewa render IN... -o OUT", "ewa render -o a.png");
    run_fails(2, "render: no output; say -o FILE", "ewa render a.ply");
    run_fails(2, "--size: 'abc' is not WxH", "ewa render a.ply -o a.png --size abc");
    run_fails(2, "--siez: no such option; did you mean --size?", "ewa render a.ply -o a.png --siez 1x1");
    run_fails(2, "--output: 'a.bmp' is no .png, .jpg, .jpeg, .exr or .pfm file", "ewa render a.ply -o a.bmp");
    run_fails(2, "--aov: 'depth' is not", "ewa render a.ply -o a.png --aov depth");
    run_fails(2, "--aov: 'd.png' is no .exr or .pfm file", "ewa render a.ply -o a.png --aov depth=d.png");
    run_fails(2, "--aov: 'a.exr' would be written twice", "ewa render a.ply -o a.exr --aov depth=a.exr");
    run_fails(2, "--aov: 'd.exr' would be written twice",
              "ewa render a.ply -o a.png --aov depth=d.exr,normal=d.exr");
    run_fails(2, "--range needs --color-by", "ewa render a.ply -o a.png --range 0,1");
    run_fails(2, "--colormap needs --color-by", "ewa render a.ply -o a.png --colormap turbo");
    run_fails(2, "--opacity below 1 needs --passes 3", "ewa render a.ply -o a.png --opacity 0.5 --passes 1");
    run_fails(2, "--light: 0,0,0", "ewa render a.ply -o a.png --light 0,0,0");
    run_fails(2, "--light: neither", "ewa render a.ply -o a.png --light 1,2,3,4");
    run_fails(2, "--light: a colour", "ewa render a.ply -o a.png --light 1,2,3,0,-1,0");
    run_fails(2, "--light: given more than 8 times",
              "ewa render a.ply -o a.png $(for i in 1 2 3 4 5 6 7 8 9; do echo --light 1,2,$i; done)");
    run_fails(2, "--materials and --env need", "ewa render a.ply -o a.png --shading lambert --env e.exr");
    run_fails(2, "--clip-box: '1,2,3' is not x0,y0,z0,x1,y1,z1",
              "ewa render a.ply -o a.png --clip-box 1,2,3");
    run_fails(2, "--clip-box: the first corner is not the lower one",
              "ewa render a.ply -o a.png --clip-box 0,0,1,1,1,0.5");
    run_fails(2, "--clip-plane: '1,0,0' is not a,b,c,d", "ewa render a.ply -o a.png --clip-plane 1,0,0");
    run_fails(2, "--clip-plane: 'nan,0,0,0' is not", "ewa render a.ply -o a.png --clip-plane nan,0,0,0");
    run_fails(2, "--clip-plane: 0,0,0,d has no normal", "ewa render a.ply -o a.png --clip-plane 0,0,0,1");
    run_fails(2, "--clip-plane: given more than twice beside --clip-box",
              "ewa render a.ply -o a.png --clip-box 0,0,0,1,1,1 --clip-plane 1,0,0,0 --clip-plane 0,1,0,0 "
              "--clip-plane 0,0,1,0");
    run_fails(2, "--env-up: 0,0,0", "ewa render a.ply -o a.png --env-up 0,0,0");
    run_fails(2, "--camera and --view exclude", "ewa render a.ply -o a.png --camera c.json --view top");
    run_fails(2, "--camera and --fov exclude|poses", "ewa render a.ply -o a.png --camera c.json --fov 60");
    run_fails(2, "--path and --fov exclude|poses", "ewa render a.ply -o a_%%d.png --path c.json --fov 60");
    run_fails(2, "--intrinsics is the lens of poses",
              "ewa render a.ply -o a.png --camera c.json --intrinsics 1,1,1,1");
    run_fails(2, "--intrinsics is the lens of poses", "ewa render a.ply -o a.png --intrinsics 1,1,1,1");
    run_fails(2, "--intrinsics: neither", "ewa render a.ply -o a.png --camera c.log --intrinsics 1,1,1");
    run_fails(2, "--intrinsics: the focal lengths",
              "ewa render a.ply -o a.png --camera c.log --intrinsics 0,1,1,1");
    run_fails(2, "--intrinsics and --fov exclude",
              "ewa render a.ply -o a.png --camera c.log --intrinsics 1,1,1,1 --fov 30");
    run_fails(2, "--points and --spacing exclude", "ewa sample a.obj -o b.ply --points 10 --spacing 0.1");
    run_fails(2, "--output: 'b.abc' is no .ply, .las", "ewa convert a.ply -o b.abc");
    run_fails(2, "--hole-mask: 'h.jpg' is no .png file",
              "ewa warp a.png b.png --intrinsics 1,1,1,1 --shift 1,0,0 -o o.png --hole-mask h.jpg");
    run_fails(2, "--fov and --ortho exclude", "ewa render a.ply -o a.png --ortho 2 --fov 60");
    run_fails(2, "--eye and --view", "ewa render a.ply -o a.png --eye 1,2,3 --view top");
    run_fails(2, "--ascii and --big-endian", "ewa convert a.ply -o b.ply --ascii --big-endian");
    run_fails(2, "--subsample", "ewa convert a.ply -o b.ply --subsample 2.5");
    run_fails(2, "'torsu' is none of plane|did you mean torus", "ewa generate torsu -o a.ply");
    run_fails(2, "one operand too many", "ewa surfels a.ply b.ply -o c.ply");
    run_fails(2, "--orient viewpoint needs --viewpoint", "ewa surfels a.ply -o c.ply --orient viewpoint");
    assert_int_equal(scratch_count(), 0);
}

int main(void) { return RUN_TESTS(enter, NULL); }
