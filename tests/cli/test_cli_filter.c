// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of --filter, thinning, cropping by outlines, merging, and of what ewa info says of scans.
#include "run_ewa.h"

static int enter(void **state) { return scratch_enter("filter"); }

/// Rows of a cloud: x y z class intensity.
static void write_scan(const char *name, const char *rows, int count) {
    char text[4096];
    snprintf(
        text, sizeof text,
        "ply\nformat ascii 1.0\nelement vertex %d\nproperty double x\nproperty double y\nproperty double z\n"
        "property uchar classification\nproperty ushort intensity\nend_header\n%s",
        count, rows);
    scratch_text(name, text);
}

static const char rows[] = "500000.25 4200000 1 2 10\n500001.25 4200000 2 6 20\n500002.25 4200001 3 2 30\n"
                           "500003.25 4200002 4 9 40\n500004.25 4200003 5 2 50\n500005.25 4200009 6 18 60\n";

/// What convert prints behind the header.
static const char *converted(const char *options) {
    assert_int_equal(run("ewa convert a.ply -o - --ascii %s", options), 0);
    const char *body = strstr(last_run.out, "end_header\n");
    assert_non_null(body);
    return body + strlen("end_header\n");
}

TEST(test_convert) {
    write_scan("a.ply", rows, 6);
    assert_string_equal(converted("--filter classification=ground"),
                        "500000.25 4200000 1 2 10\n500002.25 4200001 3 2 30\n500004.25 4200003 5 2 50\n");
    assert_string_equal(converted("--filter 'classification=2 and intensity>10' --filter 'z<4.5'"),
                        "500002.25 4200001 3 2 30\n");
    assert_string_equal(converted("--filter classification!=2,6,noise"), "500003.25 4200002 4 9 40\n");
    assert_string_equal(converted("--filter x=500004.25.."),
                        "500004.25 4200003 5 2 50\n500005.25 4200009 6 18 60\n");
    assert_string_equal(converted("--filter classification=2 --crop 0,0,2,1e6,1e7,4"),
                        "500002.25 4200001 3 2 30\n");
    run_fails(1,
              "a.ply: |there is no attribute 'height'; there are position (x y z), classification, intensity",
              "ewa convert a.ply -o b.ply --filter 'height>1'");
    run_fails(1, "none of the points is left", "ewa convert a.ply -o b.ply --filter classification=7");
    run_fails(2, "--filter: 'grund' is neither a number nor a class",
              "ewa convert a.ply -o b.ply --filter classification=grund");
    run_fails(2, "--filter: 'intensity': a comparison", "ewa info a.ply --filter intensity");
    assert_int_equal(scratch_size("b.ply"), -1);
}

/// Every command that reads points takes the same ones.
TEST(test_other_commands) {
    run_done("ewa generate terrain -n 4000 -o t.ply && ewa convert t.ply -o low.ply --filter 'z<=0.02'");
    run_done("ewa info --json low.ply");
    char kept[64] = "";
    const char *points = strstr(last_run.out, "\"points\": ");
    assert_non_null(points);
    snprintf(kept, sizeof kept, "%.*s", (int)strcspn(points, ","), points);
    assert_null(strstr(kept, " 4000"));
    run_done("ewa info --json t.ply --filter 'z<=0.02'");
    assert_non_null(strstr(last_run.out, kept));
    run_done("ewa render low.ply -o a.png --size 64x64 && ewa render t.ply --filter 'z<=0.02' -o b.png "
             "--size 64x64");
    assert_true(scratch_same("a.png", "b.png"));
    run_done("ewa surfels low.ply -o a.ply --keep-radii off && "
             "ewa surfels t.ply --filter 'z<=0.02' -o b.ply --keep-radii off");
    assert_true(scratch_same("a.ply", "b.ply"));
    run_fails(1, "--filter: none of the points is left", "ewa render t.ply -o c.png --filter 'z>100'");
    // One of several files may have none.
    run_done("ewa convert t.ply -o high.ply --translate 0,0,100");
    assert_int_equal(run("ewa render t.ply high.ply --filter 'z<=0.02' -o c.png --size 64x64"), 0);
    assert_non_null(strstr(last_run.err, "high.ply: --filter takes none of its points; it is left out"));
    assert_true(scratch_same("a.png", "c.png"));
    assert_int_equal(run("ewa convert high.ply t.ply --filter 'z<=0.02' -o c.ply"), 0);
    // A file that is passed through in pieces has room for its count; a copy of each has not.
    run_done("ewa convert c.ply -o c1.ply && ewa convert low.ply -o low1.ply");
    assert_true(scratch_same("low1.ply", "c1.ply"));
    // Of a mesh the vertices are looked at, and faces go with them.
    scratch_text("m.ply",
                 "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
                 "float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n"
                 "1 0 0\n1 1 0\n0 1 1\n3 0 1 2\n3 0 2 3\n");
    assert_int_equal(run("ewa convert m.ply -o n.ply --filter 'z<0.5' && ewa info n.ply"), 0);
    assert_non_null(strstr(last_run.err, "2 faces are dropped: some of their vertices are left out"));
    assert_non_null(strstr(last_run.out, "points      3"));
    run_done("ewa convert m.ply -o n.ply --filter 'z<5' && ewa info n.ply");
    assert_non_null(strstr(last_run.out, "2 faces"));
    run_done("ewa render m.ply -o m.png --size 32x32 --filter 'z<0.5'");
}

TEST(test_polygons) {
    write_scan("a.ply", rows, 6);
    static const char inside[] = "500001.25 4200000 2 6 20\n500002.25 4200001 3 2 30\n";
    assert_string_equal(
        converted("--crop-polygon '500001,4199999;500003,4199999;500003,4200001;500001,4200001'"), inside);
    scratch_text("p.txt", "# a plot\n500001 4199999\n500003 4199999\n500003 4200001\n500001 4200001\n");
    assert_string_equal(converted("--crop-polygon p.txt"), inside);
    scratch_text("p.wkt", "POLYGON ((500001 4199999, 500003 4199999, 500003 4200001, 500001 4200001, 500001 "
                          "4199999))\n");
    assert_string_equal(converted("--crop-polygon p.wkt"), inside);
    scratch_text("p.json", "{\"type\":\"Feature\",\"properties\":{},\"geometry\":{\"type\":\"Polygon\","
                           "\"coordinates\":[[[500001,4199999],[500003,4199999],[500003,4200001],[500001,"
                           "4200001],[500001,4199999]]]}}");
    assert_string_equal(converted("--crop-polygon p.json"), inside);
    assert_string_equal(converted("--crop-polygon p.json --filter classification=building"),
                        "500001.25 4200000 2 6 20\n");
    run_fails(1, "none.txt: ", "ewa convert a.ply -o b.ply --crop-polygon none.txt");
    run_fails(1, "none of the points is left", "ewa convert a.ply -o b.ply --crop-polygon '0,0;1,0;1,1'");
    run_fails(1, "--crop-polygon: ring 1 of the outline has 2 corners",
              "ewa convert a.ply -o b.ply --crop-polygon '0,0;1,0'");
}

TEST(test_thinning) {
    write_scan("a.ply", rows, 6);
    assert_string_equal(converted("--voxel 4"), "500001.25 4200000 2 6 20\n500003.25 4200002 4 9 40\n"
                                                "500004.25 4200003 5 2 50\n500005.25 4200009 6 18 60\n");
    assert_string_equal(converted("--min-distance 100 --filter z=2..2"), "500001.25 4200000 2 6 20\n");
    run_done("ewa generate sphere -n 20000 -o s.ply && ewa convert s.ply -o a1.ply --min-distance 0.1 "
             "--threads 1 && "
             "ewa convert s.ply -o a2.ply --min-distance 0.1 --threads 3");
    assert_true(scratch_same("a1.ply", "a2.ply"));
    // What is thinned already stays.
    run_done("ewa convert a1.ply -o a3.ply --min-distance 0.1");
    assert_true(scratch_same("a1.ply", "a3.ply"));
    // Neighbours of points are those that other options leave.
    run_done("ewa generate plane -n 400 -o p.ply --ascii --positions-only && ewa generate plane -n 1 -o q.ply --positions-only --extent 1e-3 && "
             "ewa convert q.ply -o far.ply --translate 0,0,9 && ewa convert p.ply far.ply -o both.ply && "
             "ewa convert both.ply -o o1.ply --outliers 3 && ewa info o1.ply");
    assert_non_null(strstr(last_run.out, "points      400\n"));
    run_done("ewa convert both.ply -o o2.ply --outliers 3 --crop -9,-9,5,9,9,99 && ewa info o2.ply");
    assert_non_null(strstr(last_run.out, "points      1\n"));
    run_fails(2, "--outliers: -1 is outside [0, inf)", "ewa convert a.ply -o b.ply --outliers -1");
    run_fails(2, "--voxel: 0 is outside (0, inf)", "ewa convert a.ply -o b.ply --voxel 0");
    run_fails(2, "--min-distance: -1 is outside (0, inf)", "ewa convert a.ply -o b.ply --min-distance -1");
}

TEST(test_merge) {
    write_scan("a.ply", rows, 6);
    scratch_text("c.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\n"
                          "property double z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                          "property float height\nend_header\n1 2 3 10 20 30 0.5\n");
    assert_int_equal(run("ewa convert a.ply c.ply -o - --ascii --filter 'z>5 and z<100' --filter 'x>0' 2>&1"),
                     0);
    assert_int_equal(run("ewa convert a.ply c.ply -o - --ascii --filter 'z=2..3' --voxel 1e9"), 0);
    assert_int_equal(run("ewa convert a.ply c.ply -o - --ascii --filter 'z=2..3'"), 0);
    assert_non_null(
        strstr(last_run.err, "a.ply: it has no colours; its points become (0.796, 0.796, 0.796)"));
    assert_non_null(strstr(last_run.err, "attribute 'height': 1 of 2 clouds lack it, their points get NaN"));
    assert_non_null(
        strstr(last_run.err, "attribute 'classification': 1 of 2 clouds lack it, their points get 0"));
    assert_non_null(strstr(last_run.out, "500001.25 4200000 2 6 20 203 203 203 nan\n"));
    assert_non_null(strstr(last_run.out, "\n1 2 3 0 0 10 20 30 0.5\n"));
    assert_int_equal(run("ewa convert c.ply a.ply -o - --ascii --default-color 1,0,0.2"), 0);
    assert_non_null(strstr(last_run.out, "500001.25 4200000 2 255 0 51 nan 6 20\n"));
}

TEST(test_info) {
    write_scan("a.ply", rows, 6);
    run_done("ewa info a.ply");
    assert_non_null(strstr(last_run.out,
                           "  classes\n      2 ground               3\n      6 building             1\n"
                           "      9 water                1\n     18 high noise           1\n"));
    run_done("ewa info --json a.ply --filter 'classification=2,6'");
    assert_non_null(strstr(last_run.out, "\"classes\": ["));
    assert_non_null(strstr(last_run.out, "\"name\": \"building\""));
    assert_null(strstr(last_run.out, "\"name\": \"water\""));
    // Text comes with a grid.
    scratch_text("g.xyz", "500000.25 4200000.5 1.25\n500001.75 4200001.25 2.5\n");
    run_done("ewa info g.xyz");
    assert_non_null(strstr(last_run.out, "  scale       0.01 0.01 0.01\n"));
}

TEST(test_degrees) {
    write_scan("d.ply",
               "7.001 50.001 100 2 1\n7.002 50.001 120 2 1\n7.001 50.002 110 2 1\n7.002 50.002 150 2 1\n", 4);
    assert_int_equal(run("ewa info d.ply"), 0);
    assert_non_null(strstr(last_run.out, "coordinates look like degrees of longitude and latitude"));
    assert_non_null(strstr(last_run.out, "--scale 71694,111229,1"));
    assert_non_null(strstr(last_run.out, "UTM zone 32"));
    assert_non_null(strstr(last_run.err, "d.ply: coordinates look like degrees"));
    // Pictures are of metres, by the length of degrees at latitude 50, unless they are moved by hand.
    assert_int_equal(run("ewa render d.ply -o d.png --size 64x64"), 0);
    assert_non_null(strstr(last_run.err, "d.ply: degrees with heights in metres: x and y are drawn times 71696 and 111229"));
    const char *moved = "ewa convert d.ply -o m.ply --scale 71695.75361600298,111229.06398856244,1 && "
                        "ewa render m.ply -o m.png --size 64x64";
    assert_int_equal(run("%s", moved), 0);
    assert_true(scratch_same("d.png", "m.png"));
    assert_null(strstr(last_run.err, "drawn times"));
    write_scan("d.ply", "7.001 50.001 0.1 2 1\n7.002 50.001 0.12 2 1\n7.001 50.002 0.11 2 1\n", 3);
    run_done("ewa info d.ply");
    assert_null(strstr(last_run.out, "degrees of longitude"));
}

TEST(test_colors) {
    run_done("ewa generate sphere -n 2000 -o s.ply && ewa render s.ply -o a.png --size 64x64 && "
             "ewa render s.ply -o b.png --size 64x64 --color-by rgb");
    assert_true(scratch_same("a.png", "b.png"));
    run_fails(2, "--color-bar has nothing to show", "ewa render s.ply -o c.png --color-by rgb --color-bar");
    // One number far above all others does not make the rest dark.
    char text[8192];
    int used = snprintf(
        text, sizeof text,
        "ply\nformat ascii 1.0\nelement vertex 200\nproperty float x\nproperty float y\nproperty float "
        "z\nproperty ushort intensity\nproperty ushort other\nend_header\n");
    for (int i = 0; i < 200; i++)
        used += snprintf(text + used, sizeof text - (size_t)used, "%d %d 0 %d %d\n", i % 20, i / 20,
                         i == 77 ? 60000 : i, i == 77 ? 60000 : i);
    scratch_text("i.ply", text);
    assert_int_equal(run("ewa render i.ply -o i.png --size 64x64 --color-by intensity --verbose"), 0);
    assert_non_null(strstr(last_run.err, "intensity from 4 to 196"));
    assert_int_equal(run("ewa render i.ply -o i.png --size 64x64 --color-by other --verbose"), 0);
    assert_non_null(strstr(last_run.err, "other from 0 to 60000"));
    // A scan without colours shows its intensity, and says so; none is kept by a scene file.
    assert_int_equal(run("ewa render i.ply -o i.png --size 64x64 --color-bar"), 0);
    assert_non_null(strstr(last_run.err, "no colours: coloured by intensity; --color-by says otherwise"));
    assert_int_equal(run("ewa render i.ply -o b.png --size 64x64 --color-by intensity --color-bar"), 0);
    assert_true(scratch_same("i.png", "b.png"));
    // What was said of the surfels is not said again for their outlines.
    assert_int_equal(run("ewa render i.ply -o o.png --size 64x64 --outlines 5"), 0);
    const char *note = strstr(last_run.err, "no colours");
    assert_non_null(note);
    assert_null(strstr(note + 1, "no colours"));
    assert_int_equal(run("ewa render i.ply -o n.png --size 64x64 --color-by none --save-scene n.json"), 0);
    assert_null(strstr(last_run.err, "no colours"));
    run_done("ewa render n.json -o m.png --size 64x64");
    assert_true(scratch_same("n.png", "m.png"));
    assert_false(scratch_same("n.png", "i.png"));
}

int main(void) { return RUN_TESTS(enter, NULL); }
