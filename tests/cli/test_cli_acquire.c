// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures onto points, from the command line.
#include "run_ewa.h"

#include <string.h>

static int enter(void **state) { return scratch_enter("cli_acquire"); }

/// A quad with texture coordinates, but without a picture.
static const char quad[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                           "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";

static void make_picture(void) {
    run_done("ewa generate checker -n 10000 --checks 4 -o board.ply");
    run_done(
        "ewa render board.ply -o board.png --size 64x64 --view top --ortho 2 --shading none --edge-aa off");
}

TEST_WITHIN(test_mesh, enter, NULL) {
    make_picture();
    scratch_text("quad.obj", quad);
    assert_int_equal(run("ewa sample quad.obj -o grey.ply -n 500"), 0);
    assert_non_null(strstr(last_run.err, "--texture"));
    static const char *const filters[] = {"nearest", "ewa", "optimal"};
    for (int i = 0; i < 3; i++) {
        run_done("ewa sample quad.obj --texture board.png --texture-filter %s -o %s.ply -n 500", filters[i],
                 filters[i]);
        assert_int_equal(run("ewa info %s.ply --json", filters[i]), 0);
        assert_non_null(strstr(last_run.out, "color"));
        assert_null(strstr(last_run.out, "texcoord"));
    }
    assert_false(scratch_same("ewa.ply", "optimal.ply"));
    run_done("ewa sample quad.obj --texture board.png -o again.ply -n 500 --threads 3");
    assert_true(scratch_same("again.ply", "optimal.ply"));
}

TEST_WITHIN(test_objects, enter, NULL) {
    make_picture();
    static const char *const objects[] = {"plane", "cube", "sphere", "torus", "terrain", "csg", "town"};
    for (size_t i = 0; i < sizeof objects / sizeof objects[0]; i++) {
        run_done("ewa generate %s --texture board.png -n 9000 -o %s.ply", objects[i], objects[i]);
        run_done("ewa render %s.ply -o %s.png --size 64x64", objects[i], objects[i]);
    }
    run_done("ewa generate cube --sharp --texture board.png --pixel-sigma 1 -n 9000 -o sharp.ply");
}

TEST_WITHIN(test_what_fails, enter, NULL) {
    make_picture();
    scratch_text("bare.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
    run_fails(1, "texture coordinates", "ewa sample bare.obj --texture board.png -o x.ply");
    run_fails(1, "missing.png", "ewa generate plane --texture missing.png -o x.ply");
    run_fails(1, "board.ply", "ewa generate plane --texture board.ply -o x.ply");
    run_fails(1, "normals", "ewa generate plane --positions-only --texture board.png -o x.ply");
    run_fails(2, "optimal", "ewa generate plane --texture board.png --texture-filter sharp -o x.ply");
    run_fails(2, "pixel-sigma", "ewa generate plane --texture board.png --pixel-sigma 0 -o x.ply");
    assert_int_equal(scratch_size("x.ply"), -1);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
