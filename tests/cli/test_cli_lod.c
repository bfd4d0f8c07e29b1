// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Octrees of points in the program: made, told about, drawn from their levels, cut out of.
#include "check_pictures.h"

static int enter(void **state) {
    context = check_context(0, NULL);
    if (scratch_enter("lod") != 0) return 1;
    run_done("ewa generate torus -n 60000 -o t.ply && ewa lod t.ply -o t.copc.laz");
    return 0;
}

/// Whether a file of the scratch folder holds a text.
static bool holds(const char *name, const char *text) {
    run("cat %s", name);
    return strstr(last_run.out, text) != NULL;
}

TEST(test_make) {
    run_done("ewa lod t.ply -o again.copc.laz --threads 1 --memory 64M --stats s.json");
    assert_true(scratch_same("t.copc.laz", "again.copc.laz"));
    assert_true(holds("s.json", "\"points\": 60000"));
    assert_true(holds("s.json", "\"distribute\": "));
    run_done("ewa convert t.copc.laz -o back.ply");
    run_done("ewa info --json back.ply");
    assert_non_null(strstr(last_run.out, "\"points\": 60000"));
    // Several files, as one that holds the same points.
    run_done("ewa convert t.ply -o left.ply --crop -9,-9,-9,0,9,9 && "
             "ewa convert t.ply -o right.ply --filter 'x>0'");
    run_done("ewa lod left.ply right.ply -o both.copc.laz");
    run_done("ewa info --json both.copc.laz");
    assert_non_null(strstr(last_run.out, "\"points\": 60000"));
    run_fails(2, "lod: no output", "ewa lod t.ply");
    run_fails(2, "--output: an octree is written to a file", "ewa lod t.ply -o -");
    run_fails(2, "--output: 'x.ply' is no .copc.laz or .laz file", "ewa lod t.ply -o x.ply");
    static const char *const wrong[] = {"0/2", "3/2", "1", "1/2x", "a/b", "1/70000"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        run_fails(2, "--subset: not I/N", "ewa lod t.ply -o x.copc.laz --subset %s", wrong[i]);
    run_fails(2, "--subset and --merge exclude each other",
              "ewa lod t.ply -o x.copc.laz --subset 1/2 --merge");
    run_fails(1, "nothing.ply", "ewa lod nothing.ply -o x.copc.laz");
    assert_int_equal(scratch_size("x.copc.laz"), -1);
}

/// Of Gaussians the centres are taken, which is said, and how to keep the rest.
TEST(test_gaussians) {
    run_done("printf 'ply\\nformat ascii 1.0\\nelement vertex 4\\n' >g.ply; "
             "for n in x y z f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3; do "
             "echo property float $n >>g.ply; done; echo end_header >>g.ply; "
             "for i in 1 2 3 4; do echo $i 0 0 1 1 1 2 -3 -3 -3 1 0 0 0 >>g.ply; done");
    assert_int_equal(run("ewa lod g.ply t.ply -o centres.copc.laz"), 0);
    assert_non_null(strstr(last_run.err, "g.ply: Gaussians become points at their centres; 'ewa convert g.ply -o lod-meta.json'"));
    assert_null(strstr(last_run.err, "t.ply: Gaussians"));
    assert_int_equal(run("ewa lod g.ply -o centres.copc.laz -q"), 0);
    assert_string_equal(last_run.err, "");
}

/// Parts that are made alone become the file that is made at once.
TEST(test_parts) {
    for (int part = 1; part <= 3; part++) run_done("ewa lod t.ply -o p%d.copc.laz --subset %d/3", part, part);
    run_done("ewa lod p2.copc.laz p3.copc.laz p1.copc.laz -o joined.copc.laz --merge --stats s.json");
    assert_true(scratch_same("t.copc.laz", "joined.copc.laz"));
    assert_true(holds("s.json", "\"points\": 60000"));
    assert_int_equal(run("ewa lod p1.copc.laz p2.copc.laz -o x.copc.laz --merge"), 1);
    assert_int_equal(run("ewa lod p1.copc.laz p2.copc.laz p2.copc.laz -o x.copc.laz --merge"), 1);
    assert_int_equal(scratch_size("x.copc.laz"), -1);
}

TEST(test_sizes) {
    static const char *const fine[] = {"64M", "64m", "0.5G", "1GiB", "100MB", "67108864", "1T"};
    for (size_t i = 0; i < sizeof fine / sizeof fine[0]; i++)
        run_done("ewa lod t.ply -o x.copc.laz --memory %s", fine[i]);
    run_fails(2, "--memory: 1K is outside [64M, 1P]", "ewa lod t.ply -o x.copc.laz --memory 1K");
    static const char *const wrong[] = {"M", "1X", "-64M", "64 M", "64MM", "0x10M", "nan", "inf"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        run_fails(2, "--memory", "ewa lod t.ply -o x.copc.laz --memory='%s'", wrong[i]);
}

TEST(test_info) {
    run_done("ewa info t.copc.laz");
    assert_non_null(strstr(last_run.out, "octree      COPC 1.0"));
    assert_non_null(strstr(last_run.out, "stand for the points at its levels"));
    assert_non_null(strstr(last_run.out, "problems    none"));
    // The cube's corner in words is that in JSON, to ten digits.
    double words[3], numbers[3];
    const char *cube = strstr(last_run.out, "    cube ");
    assert_true(cube && sscanf(cube, " cube %*f from %lf %lf %lf", &words[0], &words[1], &words[2]) == 3);
    run_done("ewa info --json t.copc.laz");
    const char *corner = strstr(last_run.out, "\"cube_low\": [");
    assert_true(corner && sscanf(corner, "\"cube_low\": [%lf, %lf, %lf]", &numbers[0], &numbers[1], &numbers[2]) == 3);
    for (int c = 0; c < 3; c++) assert_float_equal(words[c], numbers[c], 1e-9);
    assert_non_null(strstr(last_run.out, "\"octree\": {"));
    assert_non_null(strstr(last_run.out, "\"merged\": true"));
    assert_non_null(strstr(last_run.out, "\"sampled_points\": 0"));
}

/// Mean square of the differences of two pictures' numbers, in 1/255 of white.
static double mean_square(const char *a, const char *b) {
    OWNED(ewa_image_free) ewa_image first = load(a), second = load(b);
    assert_true(first.width_px == second.width_px && first.height_px == second.height_px);
    double sum = 0;
    const size_t count = (size_t)first.width_px * first.height_px * first.channel_count;
    for (size_t i = 0; i < count; i++) {
        const double off = 255 * ((double)first.pixels[i] - (double)second.pixels[i]);
        sum += off * off;
    }
    return sum / (double)count;
}

TEST(test_render) {
    // A small octree is drawn as any file; --lod-error 0 asks for that.
    run_done("ewa render t.copc.laz -o plain.png --size 300x300");
    run_done("ewa render t.copc.laz -o all.png --size 300x300 --lod-error 0 --memory 1G");
    assert_true(scratch_same("plain.png", "all.png"));
    // From its levels it looks the same, whatever the memory and the number of threads.
    run_done("ewa render t.copc.laz -o levels.png --size 300x300 --levels always --memory 1G --lod-spacing 2 "
             "--stats s.json");
    assert_true(mean_square("plain.png", "levels.png") < 25);
    assert_true(holds("s.json", "\"nodes_drawn\": "));
    assert_true(holds("s.json", "\"bands\": 1"));
    run_done("ewa render t.copc.laz -o again.png --size 300x300 --levels always --memory 16M --lod-spacing 2 "
             "--threads 1");
    assert_true(scratch_same("levels.png", "again.png"));
    // Without colours it is lit as the whole file is, and shows the height, as what represents points has no intensity.
    run_done("ewa convert t.ply -o t.xyz && awk '{print $1, $2, $3}' t.xyz >bare.xyz && ewa lod bare.xyz -o bare.copc.laz");
    run_done("ewa render bare.copc.laz -o none.png --size 300x300 --levels always --color-by none --lod-spacing 2 && "
             "ewa render bare.copc.laz -o head.png --size 300x300 --levels always --color-by none --light 0,0,0,1,1,1 && "
             "ewa render bare.copc.laz -o whole.png --size 300x300 --levels never --color-by none && "
             "ewa render bare.copc.laz -o z.png --size 300x300 --levels always --color-by z --range 2%%,98%%");
    assert_true(mean_square("none.png", "whole.png") < 25 && mean_square("none.png", "head.png") > 100);
    assert_int_equal(run("ewa render bare.copc.laz -o auto.png --size 300x300 --levels always"), 0);
    assert_non_null(strstr(last_run.err, "no colours: coloured by height"));
    assert_true(scratch_same("auto.png", "z.png"));
    // Frames share what was read.
    run_done("ewa render t.copc.laz -o f%%d.png --size 300x300 --levels always --lod-spacing 2 --turntable 3 "
             "--stats s.json "
             "--scale-bar");
    assert_true(scratch_size("f2.png") > 0);
    assert_true(holds("s.json", "\"frame_count\": 3"));
    // Planes and sections are there, too.
    run_done(
        "ewa render t.copc.laz -o cut.png --aov depth=cut.pfm --size 100x100 --levels always --lod-spacing 2 "
        "--clip-plane 1,0,0,0 --edl 0.5");
    assert_true(scratch_size("cut.pfm") > 0);
}

TEST(test_refusals) {
    run_fails(1, "represents points at its levels has no intensity",
              "ewa render t.copc.laz -o x.png --levels always --filter 'intensity>0'");
    run_fails(1, "represents points at its levels has no classification",
              "ewa render t.copc.laz -o x.png --levels always --color-by classification");
    run_fails(1, "there is no attribute 'warmth'",
              "ewa render t.copc.laz -o x.png --levels always --color-by warmth");
    run_fails(1, "there is no attribute 'warmth'",
              "ewa render t.copc.laz -o x.png --levels always --filter 'warmth>0'");
    run_fails(1, "--cutoff needs all points", "ewa render t.copc.laz -o x.png --levels always --cutoff 2");
    run_fails(2, "octrees are made by 'ewa lod IN... -o x.copc.laz'", "ewa convert t.copc.laz -o x.copc.laz");
    run_fails(2, "--lod-spacing: 0 is outside (0, 64]", "ewa render t.copc.laz -o x.png --lod-spacing 0");
    assert_int_equal(scratch_size("x.png"), -1);
}

/// What a box keeps is the same whether the file is read whole or by nodes.
TEST(test_crop) {
    static const char sorted[] = "--ascii | sort";
    run_done("ewa convert t.copc.laz -o - --filter 'x=0.2..0.7 and y=0.1..0.6 and z>=0' %s > a.txt", sorted);
    run_done("ewa convert t.copc.laz -o - --crop 0.2,0.1,0,0.7,0.6,1 %s > b.txt", sorted);
    assert_true(scratch_size("a.txt") > 1000);
    assert_true(scratch_same("a.txt", "b.txt"));
    run_done("ewa convert t.copc.laz -o whole.ply");
    run_done("ewa convert whole.ply -o - --crop-polygon '0.2,0.2;0.7,0.3;0.5,0.6' --ascii | cut -d' ' -f1-3 "
             "| sed '1,/end_header/d' | sort > a.txt");
    run_done("ewa convert t.copc.laz -o - --crop-polygon '0.2,0.2;0.7,0.3;0.5,0.6' --ascii | cut -d' ' -f1-3 "
             "| sed '1,/end_header/d' | sort > b.txt");
    assert_true(scratch_size("a.txt") > 1000);
    assert_true(scratch_same("a.txt", "b.txt"));
    run_fails(1, "none of the points is left", "ewa convert t.copc.laz -o x.ply --crop 5,5,5,6,6,6");
}

/// Folders of EPT are inputs as any file, and are drawn from their levels when that is asked for.
TEST(test_folder) {
    run_done("mkdir -p e/ept-data e/ept-hierarchy && ewa generate sphere -n 5000 -o s.ply");
    run_done("ewa convert s.ply -o e/ept-data/0-0-0-0.laz && ewa convert s.ply -o - --ascii "
             "--crop 0,-1,-1,1,0,0 | sed '1,/end_header/d' | wc -l");
    unsigned long below = 0, all = 0;
    assert_true(sscanf(last_run.out, "%lu", &below) == 1 && below > 100);
    run_done("ewa info --json s.ply");
    const char *points = strstr(last_run.out, "\"points\": ");
    assert_true(points && sscanf(points, "\"points\": %lu", &all) == 1);
    char text[2048];
    snprintf(text, sizeof text, "{\"0-0-0-0\": %lu}", all);
    scratch_text("e/ept-hierarchy/0-0-0-0.json", text);
    snprintf(text, sizeof text,
             "{\"bounds\": [-1, -1, -1, 1, 1, 1], \"boundsConforming\": [-1, -1, -1, 1, 1, 1], "
             "\"dataType\": \"laszip\", \"hierarchyType\": \"json\", \"points\": %lu, \"span\": 128, "
             "\"version\": \"1.1.0\", \"srs\": {}, \"schema\": ["
             "{\"name\": \"X\", \"type\": \"signed\", \"size\": 4, \"scale\": 1e-8, \"offset\": 0}, "
             "{\"name\": \"Y\", \"type\": \"signed\", \"size\": 4, \"scale\": 1e-8, \"offset\": 0}, "
             "{\"name\": \"Z\", \"type\": \"signed\", \"size\": 4, \"scale\": 1e-8, \"offset\": 0}]}",
             all);
    scratch_text("e/ept.json", text);
    run_done("ewa info e");
    assert_non_null(strstr(last_run.out, "format      EPT 1.1.0"));
    assert_non_null(strstr(last_run.out, "1 nodes of 1 levels"));
    run_done("ewa info --json e/ept.json");
    snprintf(text, sizeof text, "\"points\": %lu", all);
    assert_non_null(strstr(last_run.out, text));
    run_done("ewa convert e -o all.ply && ewa info --json all.ply");
    assert_non_null(strstr(last_run.out, text));
    run_done("ewa convert e -o part.ply --crop 0,-1,-1,1,0,0 && ewa info --json part.ply");
    snprintf(text, sizeof text, "\"points\": %lu", below);
    assert_non_null(strstr(last_run.out, text));
    run_done("ewa render e -o e.png --size 100x100");
    assert_int_equal(run("ewa render e/ept.json -o levels.png --size 100x100 --levels always --memory 64M"),
                     0);
    assert_non_null(strstr(last_run.err, "none that stand for others"));
    assert_true(mean_square("e.png", "levels.png") < 100);
    run_done("mkdir empty");
    assert_int_equal(run("ewa info empty"), 1);
}

int main(void) { return RUN_TESTS(enter, leave); }
