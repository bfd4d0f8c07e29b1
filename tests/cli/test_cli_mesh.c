// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files that have faces, from the command line: what each command makes of them, whatever their names are.
#include "run_ewa.h"

#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int enter(void **state) { return scratch_enter("cli_mesh"); }

#define XYZ(type) "property " type " x\nproperty " type " y\nproperty " type " z\n"

/// A cube of quads from corner a to corner b, as text of three formats.
static void write_cube(const char *name, const double a[3], double size) {
    static const char *const faces[] = {"4 0 2 3 1\n", "4 4 5 7 6\n", "4 0 1 5 4\n",
                                        "4 2 6 7 3\n", "4 0 4 6 2\n", "4 1 3 7 5\n"};
    char text[2048], file[64];
    const struct {
        const char *suffix, *head, *vertex, *end;
    } formats[] = {{"ply",
                    "ply\nformat ascii 1.0\nelement vertex 8\n" XYZ(
                        "double") "element face 6\nproperty list uchar int vertex_indices\nend_header\n",
                    "", ""},
                   {"off", "OFF\n8 6 0\n", "", ""},
                   {"obj", "", "v ", ""}};
    for (int f = 0; f < 3; f++) {
        size_t at = (size_t)snprintf(text, sizeof text, "%s", formats[f].head);
        for (int v = 0; v < 8; v++)
            at += (size_t)snprintf(text + at, sizeof text - at, "%s%.17g %.17g %.17g\n", formats[f].vertex,
                                   a[0] + (v & 1) * size, a[1] + (v >> 1 & 1) * size, a[2] + (v >> 2) * size);
        for (int i = 0; i < 6; i++) {
            int c[4];
            sscanf(faces[i] + 2, "%d %d %d %d", &c[0], &c[1], &c[2], &c[3]);
            if (f == 2)
                at += (size_t)snprintf(text + at, sizeof text - at, "f %d %d %d %d\n", c[0] + 1, c[1] + 1,
                                       c[2] + 1, c[3] + 1);
            else
                at += (size_t)snprintf(text + at, sizeof text - at, "%s", faces[i]);
        }
        snprintf(file, sizeof file, "%s.%s", name, formats[f].suffix);
        scratch_text(file, text);
    }
}

static const double origin[3] = {-1, -1, -1};

/// The same picture from every format and under every name, also through a pipe.
TEST_WITHIN(test_formats, enter, NULL) {
    write_cube("cube", origin, 2);
    run_done("ewa render cube.obj -o obj.png --size 120x90");
    run_done("ewa render cube.ply -o ply.png --size 120x90");
    run_done("ewa render cube.off -o off.png --size 120x90");
    assert_true(scratch_same("obj.png", "ply.png") && scratch_same("obj.png", "off.png"));
    // Under other names, and through a pipe.
    run_done("ewa sample cube.ply -n 500 -o points.ply && cp cube.ply cube.xyz && cp cube.obj cube_obj && "
             "ewa sample cube.xyz -n 500 -o a.ply && ewa sample cube_obj -n 500 -o b.ply && "
             "cat cube.obj | ewa sample - -n 500 -o c.ply && cat cube.ply | ewa sample - -n 500 -o d.ply");
    static const char *const names[] = {"a.ply", "b.ply", "c.ply", "d.ply"};
    for (int i = 0; i < 4; i++) assert_true(scratch_same("points.ply", names[i]));
    // Its corners alone are no cube.
    run_done("ewa surfels cube.ply -o corners.ply -q && ewa render corners.ply -o corners.png --size 120x90");
    assert_false(scratch_same("obj.png", "corners.png"));
    // A file that declares no faces is points.
    scratch_text("points.ply", "ply\nformat ascii 1.0\nelement vertex 3\n" XYZ(
                                   "float") "element face 0\nproperty list uchar int "
                                            "vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n");
    run_done("ewa info points.ply");
    assert_null(strstr(last_run.out, "mesh"));
    scratch_text("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2 3\n");
    run_done("ewa render points.obj -o p.png --size 50x50 --point-size 4");
    run_fails(1, "points.obj: there are no faces to sample|ewa surfels", "ewa sample points.obj -o p.ply");
}

/// Whether two pictures differ by no more than what the last digits of a camera's place do: in one pixel of a
/// hundred, by one level.
static bool nearly_same(const char *first, const char *second) {
    OWNED(ewa_context_destroy) ewa_context *context;
    assert_int_equal(ewa_context_create(NULL, &context), EWA_OK);
    ewa_image images[2];
    assert_int_equal(ewa_image_load(context, scratch_path(first), &images[0]), EWA_OK);
    assert_int_equal(ewa_image_load(context, scratch_path(second), &images[1]), EWA_OK);
    const size_t count = (size_t)images[0].width_px * images[0].height_px * images[0].channel_count;
    assert_int_equal(images[1].width_px * images[1].height_px * images[1].channel_count, count);
    size_t differ = 0;
    double maximum = 0;
    for (size_t i = 0; i < count; i++) {
        const double a = 255 * (double)ewa_srgb_from_linear(images[0].pixels[i]),
                     b = 255 * (double)ewa_srgb_from_linear(images[1].pixels[i]);
        differ += fabs(a - b) > 0.5;
        maximum = fmax(maximum, fabs(a - b));
    }
    for (int i = 0; i < 2; i++) ewa_image_free(&images[i]);
    return 100 * differ <= count && maximum < 1.5;
}

/// At map coordinates and those of the earth's centre, the picture is that at the origin. The matrix of the
/// camera that frames it holds its place to 2^-30 there.
TEST_WITHIN(test_map_coordinates, enter, NULL) {
    static const double places[][3] = {{-1, -1, -1}, {500000, 4200000, 0}, {6000000.5, -3000000.25, 1048576}};
    for (int i = 0; i < 3; i++) {
        char name[16];
        snprintf(name, sizeof name, "at%d", i);
        write_cube(name, places[i], 2);
        for (int f = 0; f < 2; f++)
            run_done("ewa render %s.%s -o %s_%d.png --size 160x120 --view iso --up 0,0,1", name,
                     f ? "ply" : "obj", name, f);
    }
    for (int i = 1; i < 3; i++)
        for (int f = 0; f < 2; f++) {
            char name[32];
            snprintf(name, sizeof name, "at%d_%d.png", i, f);
            assert_true(nearly_same("at0_0.png", name));
        }
    run_done("ewa sample at1.obj -o at1.points.ply -n 2000");
    run_done("ewa info at1.points.ply --json");
    assert_non_null(strstr(last_run.out, "500000"));
    // What is left of one cube without another, in the same places.
    static const double corners[][3] = {{0, 0, 0}, {500001, 4200001, 1}};
    for (int i = 0; i < 2; i++) {
        char name[16];
        snprintf(name, sizeof name, "cut%d", i);
        write_cube(name, corners[i], 2);
        run_done("ewa csg at%d.obj %s.ply --op difference -o rest%d.ply", i, name, i);
        const double *at = corners[i];
        run_done("ewa render rest%d.ply -o rest%d.png --size 160x120 --eye %.17g,%.17g,%.17g "
                 "--target %.17g,%.17g,%.17g --up 0,0,1 --cull back",
                 i, i, at[0] + 4, at[1] - 4, at[2] + 3.5, at[0], at[1], at[2]);
    }
    assert_true(nearly_same("rest0.png", "rest1.png"));
    // Floats cannot say where it is.
    scratch_text("coarse.ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\n" XYZ(
                     "float") "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                              "500000 4200000 0\n500001 4200000 0\n500000 4200001 0\n3 0 1 2\n");
    assert_int_equal(run("ewa render coarse.ply -o c.png --size 50x50"), 0);
    assert_non_null(strstr(
        last_run.err, "ewa: warning: coarse.ply: coordinates up to 4200001 are floats, in steps of 0.5"));
}

TEST_WITHIN(test_info, enter, NULL) {
    write_cube("cube", origin, 2);
    static const char *const files[] = {"cube.ply", "cube.obj", "cube.off"}, *const formats[] = {"PLY", "OBJ",
                                                                                                 "OFF"};
    for (int i = 0; i < 3; i++) {
        char line[64];
        run_done("ewa info %s", files[i]);
        assert_non_null(strstr(last_run.out, "6 faces, 12 triangles, closed"));
        assert_non_null(strstr(last_run.out, "area        24"));
        assert_non_null(strstr(last_run.out, "vertices    8"));
        assert_non_null(strstr(last_run.out, "low         -1 -1 -1"));
        snprintf(line, sizeof line, "format      %s", formats[i]);
        assert_non_null(strstr(last_run.out, line));
        run_done("ewa info %s --json", files[i]);
        assert_non_null(strstr(last_run.out, "\"closed\": true"));
        assert_non_null(strstr(last_run.out, "\"triangles\": 12"));
    }
    assert_int_equal(run("ewa info none.obj"), 1);
}

/// Faces stay where their vertices stay; else it is said.
TEST_WITHIN(test_convert, enter, NULL) {
    write_cube("cube", origin, 2);
    run_done("ewa convert cube.ply -o same.ply --ascii && ewa convert same.ply -o again.ply --big-endian && "
             "ewa convert again.ply -o back.ply --ascii");
    assert_true(scratch_same("same.ply", "back.ply"));
    run_done("ewa render cube.ply -o a.png --size 80x60 && ewa render again.ply -o b.png --size 80x60");
    assert_true(scratch_same("a.png", "b.png"));
    // From other formats.
    run_done("ewa convert cube.obj -o from_obj.ply && ewa render from_obj.ply -o c.png --size 80x60 && "
             "ewa convert cube.off -o from_off.ply --ascii && ewa render from_off.ply -o d.png --size 80x60");
    assert_true(scratch_same("a.png", "c.png") && scratch_same("a.png", "d.png"));
    // Moved: the vertices are, and the faces go along.
    run_done("ewa convert cube.ply -o moved.ply --scale 3 --translate 500000,0,0");
    run_done("ewa info moved.ply");
    assert_non_null(strstr(last_run.out, "6 faces, 12 triangles, closed"));
    assert_non_null(strstr(last_run.out, "area        216"));
    assert_non_null(strstr(last_run.out, "low         499997 -3 -3"));
    run_done("ewa convert cube.ply -o kept.ply --crop -2,-2,-2,2,2,2 && ewa info kept.ply");
    assert_non_null(strstr(last_run.out, "6 faces"));
    static const char *const drops[] = {"--crop -2,-2,-2,2,2,0", "--subsample 3"};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(run("ewa convert cube.ply -o less.ply %s", drops[i]), 0);
        assert_non_null(strstr(last_run.err, "6 faces are dropped: some of their vertices are left out"));
        run_done("ewa info less.ply");
        assert_null(strstr(last_run.out, "faces"));
    }
    assert_int_equal(run("ewa convert cube.ply cube.ply -o two.ply"), 0);
    assert_non_null(strstr(last_run.err, "cube.ply: a mesh of 6 faces; its vertices are taken"));
}

/// Commands for points take the vertices, and say so.
TEST_WITHIN(test_points_of_meshes, enter, NULL) {
    write_cube("cube", origin, 2);
    static const char *const commands[] = {"surfels", "features --neighbours 0"};
    for (int c = 0; c < 2; c++)
        for (int f = 0; f < 2; f++) {
            const int status = run("ewa %s cube.%s -o out.ply", commands[c], f ? "obj" : "ply");
            assert_non_null(
                strstr(last_run.err,
                       "a mesh of 6 faces; its vertices are taken, `ewa sample` makes points on the faces"));
            assert_true(status == 0 || c == 1); // eight points have no features
        }
    run_done("ewa bench cube.ply --frames 1 --threads 1 --size 64x64");
}

/// A mesh that names files of the machine gets none of them.
TEST_WITHIN(test_named_files, enter, NULL) {
    scratch_text("m.mtl", "newmtl m\nmap_Kd ../../../../../../etc/passwd\n");
    scratch_text("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n");
    assert_int_equal(run("ewa render m.obj -o m.png --size 40x40"), 0);
    assert_non_null(
        strstr(last_run.err, "warning: m.obj: the picture '../../../../../../etc/passwd' is left out"));
    assert_int_equal(mkfifo(scratch_path("pipe.bin"), 0666), 0);
    scratch_text("m.gltf", "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],\"meshes\":[{"
                           "\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
                           "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":"
                           "\"VEC3\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
                           "\"buffers\":[{\"byteLength\":36,\"uri\":\"pipe.bin\"}]}");
    run_fails(1, "m.gltf: buffer 0, 'pipe.bin': it is no regular file", "ewa render m.gltf -o m.png");
}

int main(void) { return RUN_TESTS(NULL, NULL); }
