// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files of Gaussians by the program: told of, turned into each other, moved; what cannot be is said.
#include "run_ewa.h"

#include <math.h>

static const char head[] =
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
    "property float z\nproperty float f_dc_0\nproperty float f_dc_1\nproperty float f_dc_2\n"
    "%sproperty float opacity\nproperty float scale_0\nproperty float scale_1\n%s"
    "property float rot_0\nproperty float rot_1\nproperty float rot_2\nproperty float rot_3\n"
    "end_header\n%s";

static int enter(void **state) {
    static char text[4096], rest[1024];
    rest[0] = 0;
    for (int k = 0; k < 9; k++)
        snprintf(rest + strlen(rest), sizeof rest - strlen(rest), "property float f_rest_%d\n", k);
    const int status = scratch_enter("cli_gaussians");
    snprintf(text, sizeof text, head, rest, "property float scale_2\n",
             "1 2 3 0 .1 .2 .5 0 0 0 0 0 0 0 0 0 -2 -3 -4 1 0 0 0\n"
             "4 5 6 1 .1 .2 .5 0 0 0 0 0 0 0 0 0 -2 -3 -4 0 1 0 0\n");
    scratch_text("three.ply", text);
    snprintf(text, sizeof text, head, "", "",
             "1 2 3 0 .1 .2 0 -2 -3 1 0 0 0\n4 5 6 1 .1 .2 0 -2 -3 0 1 0 0\n");
    scratch_text("two.ply", text);
    snprintf(text, sizeof text, head, "", "",
             "1 2 3 0 .1 .2 0 -2 -3 1 0 0 0\n4 5 6 1 .1 .2 0 -2 nan 0 1 0 0\n");
    scratch_text("broken.ply", text);
    return status;
}

static void said(const char *what) {
    if (!strstr(last_run.out, what)) fail_msg("'%s' is not in:\n%s", what, last_run.out);
}

TEST(told) {
    run_done("ewa info three.ply");
    said("holds       3D Gaussians, spherical harmonics of degree 1");
    said("with a filter that thickens");
    said("sizes       median 0.04979"); // e^-3
    said("opacities   median 0.5");
    run_done("ewa info two.ply");
    said("holds       2D Gaussians, spherical harmonics of degree 0");
    run_done("ewa convert three.ply -o a.spz && ewa info a.spz");
    said("format      SPZ, version 3");
    said("gaussians   2");
    said("low         1 2 3");
    said("high        4 5 6");
    run_done("ewa info a.spz --json");
    said("\"format\": \"SPZ\"");
    said("\"version\": 3");
    said("\"sh_degree\": 1");
    said("\"antialiased\": false");
    run_done("ewa info three.ply --json");
    said("\"median_opacity\": 0.5");
    said("\"format\": \"3DGS PLY\"");
}

TEST(converted) {
    run_done("ewa convert three.ply -o b.spz --spz-version 4 && ewa info b.spz");
    said("version 4");
    said("up          -y ("); // right, up, back there
    run_done("ewa convert three.ply -o b.spz --spz-version 2 --sh-degree 0 && ewa info b.spz");
    said("version 2");
    said("degree 0");
    assert_int_equal(run("ewa convert three.ply -o b.splat"), 0);
    assert_non_null(strstr(last_run.err, "degree 1 to 1"));
    assert_int_equal(scratch_size("b.splat"), 64);
    run_done("ewa convert three.ply -o b.compressed.ply && ewa info b.compressed.ply");
    said("compressed PLY");
    said("degree 1");
    said("high        4 5 6");
    run_done("ewa convert three.ply -o b.sog && ewa info b.sog");
    said("SOG, version 2");
    said("degree 1");
    said("high        4 5 6");
    run_done("mkdir sog && ewa convert three.ply -o sog/meta.json && ewa info sog && ewa render sog -o by_folder.png --size 40x40 && "
             "ewa render sog/meta.json -o by_file.png --size 40x40");
    said("SOG, version 2");
    assert_true(scratch_same("by_folder.png", "by_file.png"));
    run_done("ewa convert a.spz -o b.glb && ewa info b.glb"); // y is up there
    said("format      glTF");
    said("up          y (");
    run_done("ewa convert b.glb -o c.compressed.ply && ewa info c.compressed.ply"); // and is turned back
    said("up          -y (");
    said("high        4 5 6");
    run_done("ewa convert b.splat -o c.ply && ewa info c.ply");
    said("3D Gaussians, spherical harmonics of degree 0");
    run_done("ewa convert a.spz -o c.ply && ewa info c.ply");
    said("3D Gaussians, spherical harmonics of degree 1");
    run_done("ewa convert two.ply -o d.splat && ewa convert d.splat -o - > e.ply && ewa info e.ply");
    said("3D Gaussians"); // .splat does not say that they are flat
    // As points: passed through with every column.
    run_done("ewa convert three.ply -o f.ply && ewa info f.ply");
    said("f_rest_8");
    // Others become surfels for who wants points.
    run_done("ewa convert a.spz -o g.ply --scale 1 && ewa surfels b.splat -o h.ply && ewa info h.ply");
    said("tangent_u");
    said("size                 float  0.135335 .. 0.135335"); // e^-2
    said("color");
    run_done("ewa render three.ply -o s.png --surface --color-by opacity --size 40x40 && "
             "ewa render three.ply -o s.png --surface --filter 'size>0.1 and opacity<0.6' --size 40x40 && rm s.png");
    // Centres alone keep their colours: 0.5 + 0.2821 of 0 and 1.
    run_done("ewa surfels three.ply -o i.ply --keep-normals off && ewa info i.ply");
    said("color                uchar  128 .. 199, 135 .. 135, 142 .. 142");
}

/// Scales follow, and where they are.
TEST(moved) {
    run_done("ewa convert three.ply -o m.ply --scale 2 --translate 0,0,1000000 && ewa info m.ply");
    said("sizes       median 0.09957"); // 2 e^-3
    said("low         2 4 1000006");
    run_done("ewa convert two.ply -o n.ply --transform 0,-1,0,0,1,0,0,0,0,0,1,0,0,0,0,1 && ewa info n.ply");
    said("2D Gaussians");
    said("low         -5 1 3");
    // What is in a box, before it is moved.
    run_done("ewa convert two.ply -o c.ply --crop 9,9,9,3,4,5 --scale 2 && ewa info c.ply");
    said("points      1\n");
    said("low         8 10 12");
    run_done("ewa convert three.ply -o c.spz --crop 0,0,0,2,3,4 && ewa info c.spz");
    said("degree 1");
}

/// Options that choose points choose Gaussians, which keep all their numbers.
TEST(chosen) {
    FILE *file = fopen(scratch_path("line.ply"), "w");
    assert_non_null(file);
    fprintf(file, head, "", "property float scale_2\n", "");
    fclose(file);
    run_done("sed -i 's/element vertex 2/element vertex 100/' line.ply && for i in $(seq 0 99); do echo "
             "$i 0 $((i %% 2)) 1 1 1 $((i - 50)) $((i %% 10 - 9)) -3 -3 1 0 0 0; done >> line.ply && "
             "ewa convert line.ply -o line.spz");
    run_done("ewa convert line.spz -o a.spz --subsample 10 && ewa info a.spz");
    said("gaussians   10\n");
    run_done("ewa convert line.spz -o a.spz --subsample 0.25 && ewa info a.spz");
    said("gaussians   25\n");
    run_done("ewa convert line.spz -o a.splat --filter 'opacity>=0.5' && ewa info a.splat");
    said("gaussians   50\n");
    said("low         50 0 0");
    run_done("ewa convert line.spz -o a.splat --filter 'size<0.5 and x<50' && ewa info a.splat"); // e^0 and e^-1 = 0.37
    said("gaussians   45\n");
    run_done("ewa convert line.spz -o a.ply --crop-polygon '9.5,-1;19.5,-1;19.5,1;9.5,1' && ewa info a.ply");
    said("points      10\n");
    said("low         10 0 0");
    run_done("ewa convert line.spz -o a.spz --min-distance 1.9 --crop 0,0,0,19,0,1 && ewa info a.spz");
    run_done("ewa convert line.spz -o a.spz --voxel 10 && ewa info a.spz");
    said("gaussians   10\n");
    run_done("ewa convert line.spz -o a.sog --crop-sphere 30,0,0,5 && ewa info a.sog");
    said("gaussians   9\n"); // those at 25 and 35 are 1 off the line
    run_done("ewa convert line.spz -o a.glb --crop-sphere 30,0,0,0 && ewa info a.glb");
    said("gaussians   1\n");
    run_fails(2, "the radius is below 0", "ewa convert line.spz -o x.spz --crop-sphere 30,0,0,-1");
    // One far away, one huge, one as good as not there.
    run_done("cp line.ply floaters.ply && sed -i 's/element vertex 100/element vertex 103/' floaters.ply && "
             "printf '900 0 0 1 1 1 1 -3 -3 -3 1 0 0 0\\n5.5 0 0 1 1 1 1 4 -3 -3 1 0 0 0\\n"
             "6.5 0 0 1 1 1 -6 -3 -3 -3 1 0 0 0\\n' >> floaters.ply && "
             "ewa convert floaters.ply -o a.sog --prune 5 && ewa info a.sog");
    said("gaussians   55\n"); // from an opacity of 1/148 on
    said("low         45 ");
    said("high        99 ");
    run_done("ewa convert floaters.ply -o a.ply --prune 5 --crop 0,0,0,54,9,9 && ewa info a.ply");
    said("points      10\n");
    // On a line those at its ends are farther from their neighbours.
    run_done("ewa convert line.spz -o a.spz --outliers 2 && ewa info a.spz");
    said("gaussians   9");
    run_fails(1, "none of the points is left", "ewa convert line.spz -o x.spz --filter 'size>3'");
    run_fails(1, "opacity", "ewa convert line.spz -o x.spz --filter 'weight>3'");
}

TEST(refused) {
    const int before = scratch_count();
    run_fails(1, "broken.ply: Gaussian 1 of 2: a scale is not finite", "ewa info broken.ply");
    run_fails(1, "broken.ply: Gaussian 1 of 2: a scale is not finite", "ewa convert broken.ply -o x.spz");
    run_fails(1, "three.ply: none of the points is left",
              "ewa convert three.ply -o x.spz --crop 0,0,0,1,1,1");
    run_fails(1, "--ascii: Gaussians are not changed that way", "ewa convert a.spz -o x.ply --ascii");
    run_fails(1, "several files are not merged", "ewa convert three.ply two.ply -o x.spz");
    run_fails(2, "output", "ewa surfels three.ply -o x.spz");
    run_fails(2, "spz-version", "ewa convert three.ply -o x.spz --spz-version 5");
    scratch_text("points.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                               "property float z\nend_header\n1 2 3\n");
    run_fails(1, "points.ply: no Gaussians of a known form", "ewa convert points.ply -o x.spz");
    run_fails(1, "points.ply: no Gaussians of a known form", "ewa convert points.ply -o x.ply --prune 5");
    run_fails(1, "missing.spz", "ewa convert missing.spz -o x.splat");
    run_fails(1, "missing.spz", "ewa info missing.spz");
    assert_int_equal(run("head -c 40 a.spz > cut.spz && ewa info cut.spz"), 1);
    assert_non_null(strstr(last_run.err, "cut.spz: "));
    assert_int_equal(scratch_count(), before + 2);
}

int main(void) { return RUN_TESTS(enter, NULL); }
