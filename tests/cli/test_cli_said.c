// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the program says of files and cameras that are not what they seem: which file, what it is, how many.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "run_ewa.h"

#define VERTEX  "property float x\nproperty float y\nproperty float z\n"
#define NORMAL  "property float nx\nproperty float ny\nproperty float nz\n"
#define HEAD(n) "ply\nformat ascii 1.0\nelement vertex " n "\n" VERTEX
#define END     "end_header\n"

static int enter(void **state) {
    if (scratch_enter("cli_said") != 0) return -1;
    return run("ewa generate sphere -n 3000 -o ball.ply && ewa generate plane -n 2000 -o sheet.ply && "
               "ewa generate torus -n 2000 -o torus.ply");
}

/// Checks that a command succeeds and says all of the words, which '|' separates.
static void says(const char *words, const char *command) {
    if (run("%s", command) != 0) fail_msg("%s: %s", command, last_run.err);
    for (const char *word = words; *word;) {
        char part[256];
        const size_t length = strcspn(word, "|");
        snprintf(part, sizeof part, "%.*s", (int)length, word);
        if (!strstr(last_run.err, part)) fail_msg("%s: '%s' wanted, said: %s", command, part, last_run.err);
        word += length + (word[length] == '|');
    }
}

TEST(test_one_place) {
    scratch_text("lone.ply", HEAD("1") END "1 2 3\n");
    says("1 point: drawn as dots", "ewa render lone.ply -o a.png --size 32x32");
    scratch_text("heap.ply", HEAD("3") END "1 2 3\n1 2 3\n1 2 3\n");
    says("3 points on no surface", "ewa render heap.ply -o b.png --size 32x32");
    scratch_text("some.ply", HEAD("3") END "1 2 3\n1 2 3\nnan 2 3\n");
    says("some.ply: 1 of 3 points are left out: 1 with coordinates", "ewa render some.ply -o b.png --size 32x32");
    // Of discs somebody has to say how large one is.
    run_fails(1, "s.ply: |one point only, at 1,2,3|radius", "ewa surfels lone.ply -o s.ply && ewa render s.ply -o a.png");
    // With a radius a point is drawn.
    scratch_text("disc.ply", HEAD("1") NORMAL "property float radius\n" END "1 2 3 0 0 1 1\n");
    run_done("ewa render disc.ply -o disc.png --size 32x32");
}

/// What is wrong with points that are left out is counted by its kind.
TEST(test_faults) {
    scratch_text(
        "faults.ply", HEAD("6") NORMAL
        "property float radius\n" END
        "0 0 0 0 0 1 1\nnan 0 0 0 0 1 1\n2 0 0 0 0 0 1\n3 0 0 0 0 1 0\n4 0 0 0 0 1 nan\n5 0 0 0 0 1 1\n");
    says("warning: faults.ply: 4 of 6 points are left out: 1 with coordinates that are not finite, 1 with "
         "normals "
         "that are zero or not finite, 2 with radii",
         "ewa render faults.ply -o a.png --size 32x32");
    // Each counts once: what has no place has no normal and no radius that could be measured.
    scratch_text("places.ply", HEAD("6") END "0 0 0\n1 0 0\n0 1 0\n1 1 0\nnan 0 0\n0 inf 0\n");
    says("2 of 6 points are left out: 2 with coordinates that are not finite\n",
         "ewa render places.ply -o a.png --size 32x32");
}

/// Colours that are no numbers are counted, as points are; those are drawn in grey.
TEST(test_colors) {
    scratch_text("colors.ply", HEAD("4") NORMAL
                 "property float radius\nproperty float red\nproperty float green\n"
                 "property float blue\n" END
                 "0 0 0 0 0 1 1 1 0 0\n1 0 0 0 0 1 1 nan 0 0\n2 0 0 0 0 1 1 0 inf 0\n3 0 0 0 0 1 1 0 0 9\n");
    says("warning: colors.ply: 2 of 4 points have a colour that is not finite",
         "ewa render colors.ply -o a.png --size 32x32");
    assert_int_equal(run("ewa info colors.ply"), 0);
    assert_non_null(strstr(last_run.out, "2 colours are not finite"));
    run_done("ewa render ball.ply -o a.png --size 32x32");
    assert_int_equal(run("ewa generate blob --dims 16 -o blob.nrrd"), 0);
    says("colors.ply: 2 of 4 points have a colour",
         "ewa volume blob.nrrd -o a.png --size 32x32 --surfels colors.ply");
}

/// Floats that count to 255 are no light; a bright spot among dark ones is.
TEST(test_bright_colors) {
    scratch_text("byte.ply", HEAD("4") "property float red\nproperty float green\nproperty float blue\n" END
                             "0 0 0 200 100 0\n1 0 0 3 250 20\n0 1 0 12 30 0\n1 1 0 90 0 0\n");
    says("colours are floats of up to 250|1 is white|unsigned bytes", "ewa render byte.ply -o c.png --size 32x32");
    scratch_text("light.ply", HEAD("4") "property float red\nproperty float green\nproperty float blue\n" END
                              "0 0 0 6 1 0\n1 0 0 0.3 0.2 0.1\n0 1 0 0.1 0.1 0\n1 1 0 0.9 0 0\n");
    says("light.ply", "ewa render light.ply -o c.png --size 32x32 -v");
    assert_null(strstr(last_run.err, "is white"));
}

TEST(test_csg_names_files) {
    run_fails(1, "sheet.ply is not closed", "ewa csg ball.ply sheet.ply --op union -o a.ply");
    assert_null(strstr(last_run.err, "operand"));
    run_fails(1, "sheet.ply is not closed", "ewa csg sheet.ply ball.ply --op difference -o a.ply");
}

/// Scenes of Gaussian splatting are named, whatever their columns hold besides.
TEST(test_gaussians) {
    static const char columns[] = NORMAL
        "property float f_dc_0\nproperty float f_dc_1\nproperty float f_dc_2\n%sproperty float opacity\n"
        "property float scale_0\nproperty float scale_1\n%sproperty float rot_0\nproperty float rot_1\n"
        "property float rot_2\nproperty float rot_3\n%s";
    static const struct {
        const char *third, *filter;
        int rest;
        const char *said;
    } kinds[] = {{"property float scale_2\n", "", 0, "2 3D Gaussians, spherical harmonics of degree 0"},
                 {"property float scale_2\n", "", 9, "2 3D Gaussians, spherical harmonics of degree 1"},
                 {"property float scale_2\n", "", 45, "2 3D Gaussians, spherical harmonics of degree 3"},
                 {"property float scale_2\n", "property float filter_3D\n", 24,
                  "2 3D Gaussians with 3D filters (Mip-Splatting), spherical harmonics of degree 2"},
                 {"", "", 45, "2 2D Gaussians, spherical harmonics of degree 3"}};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        static char text[8192], rest[2048];
        rest[0] = 0;
        for (int k = 0; k < kinds[i].rest; k++)
            snprintf(rest + strlen(rest), sizeof rest - strlen(rest), "property float f_rest_%d\n", k);
        snprintf(text, sizeof text, HEAD("2"));
        snprintf(text + strlen(text), sizeof text - strlen(text), columns, rest, kinds[i].third,
                 kinds[i].filter);
        snprintf(text + strlen(text), sizeof text - strlen(text), END);
        const int turn = 6 + 3 + kinds[i].rest + 1 + 2 + (kinds[i].third[0] != 0),
                  count = turn + 4 + (kinds[i].filter[0] != 0);
        for (int p = 0; p < 2; p++)
            for (int c = 0; c < count; c++)
                snprintf(text + strlen(text), sizeof text - strlen(text), "%d%s", c < 3 ? p + c : c == turn,
                         c + 1 < count ? " " : "\n");
        scratch_text("gauss.ply", text);
        run_done("ewa render gauss.ply -o a.png --size 30x30");
        assert_int_equal(run("ewa info gauss.ply"), 0);
        assert_non_null(strstr(last_run.out, kinds[i].said + 2));
        run_fails(1, "gauss.ply is not closed", "ewa csg gauss.ply ball.ply --op union -o a.ply");
        // Passed through, and made into surfels when asked for.
        run_done("ewa convert gauss.ply -o copy.ply && ewa info copy.ply");
        assert_non_null(strstr(last_run.out, kinds[i].said + 2));
    }
    scratch_text("packed.ply",
                 "ply\nformat ascii 1.0\nelement chunk 1\nproperty float min_x\nelement vertex 1\n"
                 "property uint packed_position\nproperty uint packed_rotation\n"
                 "property uint packed_scale\nproperty uint packed_color\nend_header\n0\n1 2 3 4\n");
    run_fails(1, "packed.ply: packed Gaussians without a property min_y", "ewa render packed.ply -o a.png");
    run_fails(1, "packed.ply: packed Gaussians without a property min_y", "ewa info packed.ply");
}

/// Normals that are all zero are none, and estimated; surfels of them are drawn.
TEST(test_zero_normals) {
    static char text[1 << 16];
    snprintf(text, sizeof text, HEAD("400") NORMAL END);
    for (int i = 0; i < 400; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%d %d 0.%d 0 0 0\n", i % 20, i / 20,
                 i % 3);
    scratch_text("zero.ply", text);
    says("zero.ply: all normals are zero", "ewa render zero.ply -o a.png --size 32x32");
    says("zero.ply: all normals are zero", "ewa surfels zero.ply -o surfels.ply");
    run_done("ewa render surfels.ply -o b.png --size 32x32");
    assert_true(scratch_same("a.png", "b.png"));
    says("zero.ply: all normals are zero", "ewa features zero.ply -o sharp.ply");
}

/// Floats that are too coarse for where they are: a warning with both lengths.
/// Normals of a file that are not those of its points leave gaps: new ones are taken, which is said. Right ones of either side are kept.
TEST(test_wrong_normals) {
    static const double tilts[] = {0, 0, 2};
    char *text = malloc(1 << 20);
    assert_non_null(text);
    for (int k = 0; k < 3; k++) {
        int length = sprintf(text, HEAD("3600") NORMAL END);
        for (int i = 0; i < 3600; i++)
            length += sprintf(text + length, "%d %d 0 %g 0 %d\n", i % 60, i / 60, i % 4 ? 0 : tilts[k], k == 1 ? -1 : 1);
        scratch_text(k == 2 ? "tilted.ply" : k == 1 ? "down.ply" : "right.ply", text);
    }
    free(text);
    assert_int_equal(run("ewa render right.ply -o right.png --size 120x90 && ewa render down.ply -o down.png --size 120x90"), 0);
    assert_null(strstr(last_run.err, "normals"));
    says("tilted.ply: normals of 2|% of the points are over 60 degrees off|--close-gaps off keeps",
         "ewa render tilted.ply -o tilted.png --size 120x90");
    says("which leaves gaps", "ewa render tilted.ply -o off.png --size 120x90 --close-gaps off");
    // The picture is that of the points alone.
    run_done("ewa convert tilted.ply -o bare.xyz && ewa convert bare.xyz -o bare.ply --columns x,y,z,-,-,- && ewa render bare.ply -o bare.png --size 120x90");
    assert_true(scratch_same("bare.png", "tilted.png"));
    assert_false(scratch_same("bare.png", "off.png"));
}

TEST(test_steps) {
    static const struct {
        double at, apart;
        bool warned;
    } cases[] = {{4200000, 0.01, true}, {4200000, 1, true},  {4200000, 10, false},
                 {0, 0.01, false},      {4200, 0.01, false}, {16777216, 2, true}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        static char text[1 << 17];
        for (int wide = 1; wide >= 0; wide--) {
            size_t used = (size_t)snprintf(text, sizeof text, "ply\nformat ascii 1.0\nelement vertex 900\n");
            for (int c = 0; c < 3; c++)
                used += (size_t)snprintf(text + used, sizeof text - used, "property %s %c\n",
                                         wide ? "double" : "float", "xyz"[c]);
            used += (size_t)snprintf(text + used, sizeof text - used, END);
            for (int k = 0; k < 900; k++)
                used += (size_t)snprintf(text + used, sizeof text - used, "%.9f %.9f %.9f\n",
                                         cases[i].at + cases[i].apart * (k % 30), cases[i].apart * (k / 30),
                                         0.1 * cases[i].apart * (k % 7));
            scratch_text("far.ply", text);
            assert_int_equal(run("ewa convert far.ply -o copy.ply"), 0);
            const bool warned = strstr(last_run.err, "far.ply: coordinates up to") != NULL;
            assert_int_equal(warned, cases[i].warned && !wide);
            assert_true(!warned || strstr(last_run.err, "steps of "));
        }
    }
    says("steps of 2 there, but the points are about 1.9",
         "ewa render far.ply -o a.png --size 32x32 || true");
}

#define CAMERA(z)                                                                                            \
    "{\"width\": 64, \"height\": 48, \"fx\": 60, \"fy\": 60, \"cx\": 32, \"cy\": 24, "                       \
    "\"world_to_camera\": [1,0,0,0,0,1,0,0,0,0,1," z ",0,0,0,1]}"

/// A camera that sees nothing of what there is: a warning, once, with the number of frames.
TEST(test_nothing_seen) {
    scratch_text("away.json", CAMERA("-9"));
    says("warning: the picture shows nothing|3000 splats", "ewa render ball.ply -o a.png --camera away.json");
    assert_ptr_equal(strchr(last_run.err, '\n'), last_run.err + strlen(last_run.err) - 1);
    scratch_text("some.json", "[" CAMERA("3") ", " CAMERA("-9") ", " CAMERA("-8") "]");
    says("warning: 2 of 3 frames, the first is 1, show nothing",
         "ewa render ball.ply -o a_%d.png --path some.json");
    assert_ptr_equal(strchr(last_run.err, '\n'), last_run.err + strlen(last_run.err) - 1);
    run_done("ewa render ball.ply -o a.png --camera some.json");
    assert_int_equal(run("ewa generate blob --dims 16 -o blob.nrrd"), 0);
    says("warning: the picture shows nothing", "ewa volume blob.nrrd -o a.png --camera away.json");
    run_done("ewa volume blob.nrrd -o a.png --camera some.json");
    says("warning: nothing of the image is in the picture",
         "ewa render ball.ply -o a.png --size 32x32 && ewa texture a.png -o b.png --camera away.json");
}

/// A path that fails midway: which file, which of its frames, and which pictures are there.
TEST(test_path_fails) {
    scratch_text(
        "beside.json",
        "[" CAMERA("3") ", " CAMERA(
            "4") ", {\"width\": 64, \"height\": 48, \"fx\": 60, \"fy\": 60, "
                 "\"cx\": 1e300, \"cy\": 24, \"world_to_camera\": [1,0,0,0,0,1,0,0,0,0,1,3,0,0,0,1]}]");
    run_fails(1, "beside.json: frame 2: |no view volume|of 3 frames, 2 are written and stay: 0 to 1",
              "ewa render ball.ply -o frame_%%d.png --path beside.json");
    run_done("test -f frame_0.png -a -f frame_1.png -a ! -e frame_2.png");
    run_fails(1, "beside.json: render: the camera has no view volume",
              "ewa render ball.ply -o a.png --camera beside.json --camera-index 2");
}

/// Poses with a lens from --fov, from numbers or from a file are cameras like others.
TEST(test_poses) {
    static const char matrix[] = "1 0 0 0\n0 -1 0 0\n0 0 -1 4\n0 0 0 1\n"; // from +z, y up
    scratch_text("one.txt", matrix);
    scratch_text("two.log",
                 "0 0 1\n1 0 0 0\n0 -1 0 0\n0 0 -1 4\n0 0 0 1\n1 1 2\n1 0 0 0.5\n0 -1 0 0\n0 0 -1 4\n"
                 "0 0 0 1\n");
    scratch_text("one.tum", "0.5 0 0 4 1 0 0 0\n");
    scratch_text("lens.json",
                 "{\"width\": 64, \"height\": 48, \"intrinsic_matrix\": [60,0,0,0,60,0,31.5,23.5,1]}");
    run_done("ewa render torus.ply -o eye.png --size 64x48 --eye 0,0,4 --target 0,0,0 --up 0,1,0 --fov 43.6");
    run_done("ewa render torus.ply -o fov.png --size 64x48 --camera one.txt --fov 43.6");
    assert_true(scratch_same("eye.png", "fov.png"));
    run_done("ewa render torus.ply -o tum.png --size 64x48 --camera one.tum --fov 43.6");
    assert_true(scratch_same("eye.png", "tum.png"));
    run_done("ewa render torus.ply -o numbers.png --size 64x48 --camera one.txt --intrinsics 60,60,32,24");
    run_done("ewa render torus.ply -o file.png --camera one.txt --intrinsics lens.json");
    run_done("ewa render torus.ply -o path_%%d.png --path two.log --intrinsics lens.json");
    run_done("ewa render torus.ply -o index.png --camera two.log --camera-index 1 --intrinsics lens.json");
    assert_true(scratch_same("numbers.png", "file.png") && scratch_same("file.png", "path_0.png"));
    assert_true(scratch_same("index.png", "path_1.png") && !scratch_same("file.png", "path_1.png"));
    // A file's lens is scaled with its picture.
    run_done("ewa render torus.ply -o a.png --camera one.txt --intrinsics lens.json --size 128x96 && "
             "ewa render torus.ply -o b.png --camera one.txt --intrinsics 120,120,64,48 --size 128x96");
    assert_true(scratch_same("a.png", "b.png"));
    // Without any lens the default is said; numbers that look like those of another convention too.
    says("one.txt: poses have no lens|--fov 30",
         "ewa render torus.ply -o a.png --size 64x48 --camera one.txt");
    says("31.5,23.5 is the middle of 64 x 48|32,24",
         "ewa render torus.ply -o a.png --size 64x48 --camera one.txt --intrinsics 60,60,31.5,23.5");
    run_fails(1, "two.log: pose 2 wanted, 2 there",
              "ewa render torus.ply -o a.png --camera two.log --camera-index 2 --fov 40");
    scratch_text("cut.log", "0 0 1\n1 0 0 0\n0 -1 0 0\n");
    run_fails(1, "cut.log: |line 3", "ewa render torus.ply -o a_%%d.png --path cut.log --fov 40");
    run_fails(1, "none.json: ", "ewa render torus.ply -o a.png --camera one.txt --intrinsics none.json");
    // A lens as the matrix K of a text; poses are none.
    scratch_text("K.txt", "60 0 32\n0 60 24\n0 0 1\n");
    run_done("ewa render torus.ply -o k.png --size 64x48 --camera one.txt --intrinsics K.txt");
    assert_true(scratch_same("numbers.png", "k.png"));
    scratch_text("bent.txt", "60 1 32\n0 60 24\n0 0 1\n");
    run_fails(1, "bent.txt: a lens with a skew of 1", "ewa render torus.ply -o a.png --camera one.txt --intrinsics bent.txt");
    scratch_text("behind.txt", "-60 0 32\n0 60 24\n0 0 1\n");
    run_fails(1, "behind.txt: no lens", "ewa render torus.ply -o a.png --camera one.txt --intrinsics behind.txt");
    run_fails(1, "one.txt: line 1: no row of a 3 x 3 matrix",
              "ewa render torus.ply -o a.png --camera one.txt --intrinsics one.txt");
    run_fails(1, "away.json: |skewed",
              "echo '{\"width\":4,\"height\":4,\"intrinsic_matrix\":[1,0,0,9,1,0,0,0,1]}' >away.json; "
              "ewa render torus.ply -o a.png --camera one.txt --intrinsics away.json");
}

/// Files that are read twice, for their bounds first, are complained of once.
TEST(test_once) {
    (void)state;
    run_done("ewa generate sphere -n 500 -o s.las && head -c 9000 s.las >cut.las");
    assert_int_equal(run("ewa convert cut.las -o whole.las --keep-going"), 0);
    const char *said = strstr(last_run.err, "the file ends in point");
    assert_non_null(said);
    assert_null(strstr(said + 1, "the file ends in point"));
}

/// What cannot be drawn says what can.
TEST(test_wording) {
    (void)state;
    run_done("ewa render torus.ply -o shot.png --size 16x16 && cp shot.png shot.hdr");
    run_fails(1, "shot.png: a picture (PNG), which has no points: 'ewa texture'", "ewa render shot.png -o a.png");
    run_fails(1, "shot.hdr: a picture (PNG), which has no voxels", "ewa render shot.hdr -o a.png");
    run_done("mkdir -p folder sog && echo '{}' >sog/meta.json");
    static const char *const folders[] = {"folder", "sog"};
    for (size_t i = 0; i < 2; i++)
        run_fails(1, "a folder, and neither an octree (EPT) nor Gaussians (SOG): name the files in it (", "ewa render %s -o a.png", folders[i]);
    run_fails(2, "'sog': a folder, no command; to draw the files in it: ewa render 'sog'/* -o picture.png", "ewa sog");
    run_fails(1, "No such file or directory; * and ? stand for other letters where a shell expands them", "ewa render 'folder/*.ply' -o a.png");
    run_fails(1, "No such file or directory; of addresses, those with http:// and https:// are read", "ewa render s3://a/b.ply -o a.png");
    run_fails(1, "t.tar: an archive (tar): unpack it", "tar cf t.tar sog && ewa info t.tar");
    scratch_text("cells.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\n"
                              "CELL_DATA 1\nSCALARS id int\nLOOKUP_TABLE default\n7\nFIELD f 5\na 1 1 int\n1\nb 1 1 int\n1\nc 1 1 int\n1\nd 1 1 int\n1\n"
                              "e 1 1 int\n1\n");
    assert_int_equal(run("ewa convert cells.vtk -o cells.xyz"), 0);
    assert_non_null(strstr(last_run.err, "numbers of cells (id, a, b, c, ...): faces have them as they are drawn, points do not"));
    run_done("ewa render cells.vtk -o a.png --size 16x16 --color-by id");
    scratch_text("title.xyz", "Yard scan\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n");
    run_fails(1, "title.xyz: line 1: 'Yard scan' is neither", "ewa render title.xyz -o a.png");
    scratch_text("odd.xyz", "0 0 0\n1 0 0\n0 1 0\n1 x 0\n2 2 2\n");
    run_fails(1, "odd.xyz: line 4, column 2: 'x' is no number (--keep-going leaves out what is damaged)",
              "ewa render odd.xyz -o a.png");
    assert_int_equal(run("ewa render odd.xyz -o a.png --size 16x16 --keep-going"), 0);
}

/// Points that are no surface are dots, one alone too, of a size that a message names.
TEST(dots) {
    (void)state;
    scratch_text("one.xyz", "1 2 3\n");
    scratch_text("eight.xyz", "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n");
    run_done("ewa generate cube -n 5000 -o cube.ply && ewa convert cube.ply -o cube.csv");
    says("cube.csv: flat faces that meet in sharp edges; `ewa features` makes these clean",
         "cut -d , -f 1-3 cube.csv > bare.csv && mv bare.csv cube.csv && ewa render cube.csv -o auto.png --size 64x48");
    run_done("ewa generate terrain -n 1000000 -o hills.ply --positions-only && ewa render hills.ply -o hills.png --size 64x48");
    assert_null(strstr(last_run.err, "sharp edges"));
    says("8 points on no surface: drawn as dots of 6 pixels|--point-size", "ewa render eight.xyz -o auto.png --size 64x48");
    run_done("ewa render eight.xyz -o six.png --size 64x48 --point-size 6");
    assert_null(strstr(last_run.err, "--point-size"));
    assert_true(scratch_same("auto.png", "six.png"));
    says("1 point: drawn", "ewa render one.xyz -o one.png --size 64x48");
    run_done("ewa render one.xyz -o other.png --size 64x48 --point-size 12");
    assert_false(scratch_same("one.png", "other.png"));
    // A size of the file's own counts.
    scratch_text("disc.csv", "x,y,z,nx,ny,nz,radius\n0,0,0,0,0,1,1\n3,0,0,0,0,1,1\n");
    run_done("ewa render disc.csv -o disc.png --size 64x48");
    assert_null(strstr(last_run.err, "--point-size"));
}

int main(void) { return RUN_TESTS(enter, NULL); }
