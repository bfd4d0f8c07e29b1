// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa warp: what its options do together, what is wrong usage, what fails.
#include <string.h>

#include "run_ewa.h"

/// A picture, its depth and its camera, from the program itself.
static int enter(void **state) {
    if (scratch_enter("cli_warp")) return 1;
    run_done("ewa generate sphere --points 20000 -o ball.ply");
    run_done("ewa render ball.ply -o color.png --size 96x64 --aov depth=depth.pfm --save-camera cam.json");
    run_done("ewa render ball.ply -o small.png --size 48x32");
    scratch_text("pose.txt", "1 0 0 0.1\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    return 0;
}

TEST(test_outputs) {
    run_done("ewa warp color.png depth.pfm --source-camera cam.json --camera cam.json -o same.png");
    run_done("ewa warp color.png depth.pfm --source-camera cam.json --shift 0.1,0,0.2 --method mcmillan -o "
             "near.png "
             "--hole-mask holes.png --aov depth=d.exr,normal=n.pfm,coverage=c.pfm --save-camera moved.json "
             "--background 1,0,0 --size 200x100 --quiet");
    const char *const made[] = {"same.png", "near.png", "holes.png", "d.exr", "n.pfm", "c.pfm", "moved.json"};
    for (size_t i = 0; i < sizeof made / sizeof made[0]; i++) assert_true(scratch_size(made[i]) > 0);
    run_done("ewa warp color.png depth.pfm color.png depth.pfm --source-camera cam.json,cam.json --camera "
             "moved.json "
             "-o two.exr");
    run_done("ewa warp color.png depth.pfm --intrinsics 100,100,48,32 --camera pose.txt -o posed.png");
    run_done("ewa warp color.png depth.pfm --intrinsics 100,100,48,32 --depth-is disparity --baseline 0.1 "
             "--shift 0.01,0,0 -o disparity.png");
    run_done("ewa warp color.png depth.pfm --source-camera cam.json --camera cam.json -o - >piped.png");
}

/// A JPEG has a quality, of 95 where nobody says.
TEST(test_jpeg_quality) {
    static const char *const qualities[] = {"", "--quality 95", "--quality 20"};
    for (int i = 0; i < 3; i++)
        run_done("ewa warp color.png depth.pfm --source-camera cam.json --camera cam.json -o w%d.jpg --background 1,1,1 %s", i, qualities[i]);
    assert_true(scratch_same("w0.jpg", "w1.jpg"));
    assert_true(scratch_size("w2.jpg") > 0 && scratch_size("w2.jpg") < scratch_size("w0.jpg"));
}

TEST(test_said) {
    // 8-bit depths are integers; their scale is guessed aloud.
    assert_int_equal(
        run("ewa warp color.png depth.pfm --source-camera cam.json --camera cam.json -o a.png --verbose"), 0);
    assert_non_null(strstr(last_run.err, "pixels have a depth"));
    assert_non_null(strstr(last_run.err, "holes: "));
    assert_int_equal(run("ewa warp color.png depth.pfm --source-camera cam.json --shift 0,0,50 -o a.png"), 0);
    assert_non_null(strstr(last_run.err, "sees nothing"));
}

TEST(test_usage) {
    static const char *const wrong[][2] = {
        {"color.png depth.pfm --source-camera cam.json --camera cam.json", "no output"},
        {"color.png depth.pfm --source-camera cam.json -o a.png", "no new camera"},
        {"color.png depth.pfm --camera cam.json -o a.png", "--intrinsics"},
        {"color.png depth.pfm --source-camera pose.txt --camera cam.json -o a.png", "--intrinsics"},
        {"color.png depth.pfm --source-camera cam.json --intrinsics 1,1,1,1 --camera cam.json -o a.png",
         "has them"},
        {"color.png depth.pfm --intrinsics 0,1,1,1 --camera cam.json -o a.png", "positive"},
        {"color.png depth.pfm color.png --source-camera cam.json --camera cam.json -o a.png", "in pairs"},
        {"color.png depth.pfm color.png depth.pfm --intrinsics 1,1,1,1 --shift 0,0,0 -o a.png",
         "need cameras"},
        {"color.png depth.pfm --source-camera cam.json,cam.json --shift 0,0,0 -o a.png", "one for each"},
        {"color.png depth.pfm --source-camera cam.json --source-index 0,1 --shift 0,0,0 -o a.png",
         "--source-index"},
        {"color.png depth.pfm --source-camera cam.json --shift 0,0,0 --depth-is disparity -o a.png",
         "--baseline"},
        {"color.png depth.pfm --source-camera cam.json --shift 0,0,0 --baseline 1 -o a.png",
         "--depth-is disparity"},
        {"color.png depth.pfm --source-camera cam.json --shift 0,0,0 --near 3 --far 2 -o a.png", "--near"},
        {"color.png depth.pfm --source-camera cam.json --shift 0,0,0 -o a.bmp", "no .png"},
        {"color.png depth.pfm --source-camera cam.json --shift 0,0,0 -o a.png --quality 20", "--quality is for JPEG"},
        {"color.png depth.pfm --source-camera cam.json --shift 0,0,0 --camera-index 1 -o a.png",
         "--camera-index"},
        {"color.png --source-camera cam.json --shift 0,0,0 -o a.png", ""},
        {"color.png depth.pfm --source-camera cam.json --shift 0,0,0 --method splat -o a.png", "--method"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        run_fails(2, wrong[i][1], "ewa warp %s", wrong[i][0]);
    assert_int_equal(scratch_size("a.bmp"), -1);
}

TEST(test_failures) {
    static const char *const failing[][2] = {
        {"none.png depth.pfm --source-camera cam.json --shift 0,0,0", "none.png: |No such file"},
        {"color.png none.pfm --source-camera cam.json --shift 0,0,0", "none.pfm: |No such file"},
        {"color.png color.png --source-camera cam.json --shift 0,0,0", "color.png: |grey of 8 or 16 bits"},
        {"small.png depth.pfm --source-camera cam.json --shift 0,0,0",
         "small.png has 48 x 32|depth.pfm has 96 x 64"},
        {"color.png depth.pfm --source-camera none.json --shift 0,0,0", "none.json: |No such file"},
        {"color.png depth.pfm --source-camera cam.json --source-index 3 --shift 0,0,0",
         "cam.json: |camera 3 wanted"},
        {"color.png depth.pfm --intrinsics 9,9,9,9 --source-camera pose.txt --source-index 1 --shift 0,0,0",
         "pose 1 wanted"},
        {"color.png depth.pfm --intrinsics 9,9,9,9 --camera cam.txt", "cam.txt: |No such file"},
        {"color.png depth.pfm --source-camera cam.json --shift 0,0,0 --near 1000 --far 2000",
         "no pixel has a depth"},
    };
    scratch_text("flat.json",
                 "{\"projection\": \"orthographic\", \"width\": 96, \"height\": 64, \"fx\": 9, \"fy\": 9, "
                 "\"cx\": 48, \"cy\": 32, \"world_to_camera\": [1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}");
    for (size_t i = 0; i < sizeof failing / sizeof failing[0]; i++) {
        run_fails(1, failing[i][1], "ewa warp %s -o out.png", failing[i][0]);
        assert_int_equal(scratch_size("out.png"), -1);
    }
    run_fails(1, "orthographic",
              "ewa warp color.png depth.pfm --source-camera flat.json --shift 0,0,0 -o out.png");
    run_done("ewa warp color.png depth.pfm --source-camera cam.json --camera flat.json -o out.png --quiet");
    run_done("ewa render ball.ply -o big.png --size 100x64 --save-camera big.json");
    run_fails(1, "pictures of 100 x 64",
              "ewa warp color.png depth.pfm --source-camera big.json --shift 0,0,0 -o b.png");
}

int main(void) { return RUN_TESTS(enter, NULL); }
