// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa bench: the scenes are what they are called, and every figure is there. Times are nobody's to check
// here.
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "run_ewa.h"

static int enter(void **state) { return scratch_enter("cli_bench"); }

/// The last number of a member of the object of `label` with `threads` in the JSON of the last run; -1: none.
static double member(const char *label, int threads, const char *name) {
    char wanted[128], key[64];
    snprintf(wanted, sizeof wanted, "\"label\": \"%s\"", label);
    snprintf(key, sizeof key, "\"%s\": ", name);
    for (const char *row = last_run.out; (row = strstr(row, wanted)); row++) {
        const char *count = strstr(row, "\"threads\": "), *end = strstr(row, "\"cycles_per_splat\"");
        const char *value = strstr(row, key);
        if (count && end && value && value < end && atoi(count + strlen("\"threads\": ")) == threads)
            return atof(value + strlen(key));
    }
    return -1;
}

TEST(test_stages) {
    run_done("TMPDIR=. ewa bench --scene plane --splats 2000 --pixels 20,40 --size 96x64 --frames 3 "
             "--workers 1,2 --cpu all,plain --json b.json && cat b.json");
    assert_non_null(strstr(last_run.out, "plane 0.002 M of 20 px"));
    assert_non_null(strstr(last_run.out, "\"cpu\": \"plain\""));
    assert_true(member("plane 0.002 M of 40 px", 1, "covered_px") > 39.9);
    assert_true(member("plane 0.002 M of 40 px", 1, "lowest_ms") <=
                member("plane 0.002 M of 40 px", 1, "median_ms"));
    assert_true(member("plane 0.002 M of 40 px", 2, "speedup") > 0);
    assert_true(member("plane 0.002 M of 40 px", 1, "clock_ghz") > 0.1);
    static const char *const stages[] = {"write PLY",         "read PLY",      "read PLY, ASCII",
                                         "normals and radii", "surfels",       "PNG, RGB",
                                         "PNG, RGBA",         "clip segments", "normals and radii, uneven",
                                         "gradients",         "gradients of colours"};
    for (size_t i = 0; i < sizeof stages / sizeof stages[0]; i++) {
        char key[64];
        snprintf(key, sizeof key, "\"stage\": \"%s\"", stages[i]);
        assert_non_null(strstr(last_run.out, key));
    }
    assert_non_null(strstr(last_run.out, "\"reaches\": \""));
    assert_int_equal(scratch_count(), 1);
}

TEST(test_files) {
    run_done("ewa generate sphere -n 3000 -o ball.ply && "
             "ewa bench ball.ply --size 96x64 --frames 1 --workers 1 --stages off --json - 2>tables");
    assert_non_null(strstr(last_run.out, "\"scene\": \"ball.ply\""));
    assert_true(member("ball.ply", 1, "splats") == 3000);
}

TEST(test_unseen) {
    run_done(
        "ewa bench --scene hidden,culled,closed,seen --splats 20000 --pixels 60 --size 256x256 --frames 1 "
        "--workers 1 --stages off --json - 2>tables");
    static const char *const hidden = "hidden 0.02 M of 60 px", *const culled = "culled 0.02 M of 60 px";
    assert_true(member(hidden, 1, "unseen_share") == 0.6);
    assert_true(member(hidden, 1, "splats") == 20000);
    // Three tenths show their backs, and no packet of a wavy sheet holds splats that do not.
    assert_true(member(hidden, 1, "splats_culled") > 0.25 * 20000);
    assert_true(member(culled, 1, "splats_culled") > 0.9 * 20000);
    const char *closed = strstr(last_run.out, "\"unseen_share\": 0.8");
    assert_non_null(closed); // five sixths, and a little for the nearness of the eye
    assert_non_null(strstr(closed, "\"scene\": \"seen\""));
}

TEST(test_recipes) {
    run_done(
        "ewa bench --scene points,peer,color --splats 5000 --pixels 30 --frames 1 --workers 1 --stages off "
        "--json - 2>tables");
    // The pixel filter of 0.35 px alone covers 3.46 pixels at 3 deviations.
    assert_true(member("points 0.005 M of 3.66 px", 1, "covered_px") < 3.7);
    assert_true(member("peer 0.005 M 1280x1024", 1, "width") == 1280);
    assert_true(member("peer 0.005 M 512x512", 1, "width") == 512);
    assert_true(member("color 0.005 M of 30 px", 1, "covered_px") > 29.9);
    assert_null(strstr(last_run.out, "plane"));
}

TEST(test_refusals) {
    run_fails(1, "the pixel filter alone covers |more than 2", "ewa bench --splats 100 --pixels 2");
    run_fails(2, "--scene: 'plain' is not one of plane|color", "ewa bench --scene plain");
    run_fails(2, "--cpu: 'sse' is not one of all", "ewa bench --cpu all,sse");
}

/// Every way of drawing has its row, and all but the first say what they are of it.
TEST(test_ways) {
    run_done("ewa bench --scene layers --splats 5000 --size 128x96 --frames 1 --workers 1,2 --stages off "
             "--json - 2>tables");
    static const char *const ways[] = {"opaque", "3 layers", "exact", "1 edge layer", "no edges", "no light"};
    for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
        char key[64];
        snprintf(key, sizeof key, "\"way\": \"%s\"", ways[i]);
        const char *row = strstr(last_run.out, key);
        assert_non_null(row);
        const char *end = strstr(row, "\"cycles_per_splat\""), *ratio = strstr(row, "\"ratio_to_first_way\"");
        assert_non_null(end);
        assert_true((ratio && ratio < end) == (i > 0));
    }
}

/// Writes a program of shell lines that draws nothing.
static void make_competitor(const char *lines) {
    char text[1024];
    snprintf(text, sizeof text, "#!/bin/sh\n%s\n", lines);
    scratch_text("competitor", text);
    assert_int_equal(chmod(scratch_path("competitor"), 0755), 0);
}

#define BENCH_AGAINST                                                                                        \
    "TMPDIR=. ewa bench --scene peer --splats 2000 --size 96x64 --frames 3 --workers 2 --stages off "        \
    "--against ./competitor"

/// Another program gets the scene as files that it can read, and is asked for every frame in turn.
TEST(test_against) {
    run_done("rm -rf *");
    make_competitor("cp \"$1\" got.ply; cp \"$2\" got.json; echo \"a \\\"competitor\\\" with $3 threads\"\n"
                    "while read -r ask; do echo >>asked; sleep 0.02; echo; done; echo >>ended");
    run_done(BENCH_AGAINST " --json - 2>tables");
    static const char *const label = "peer 0.002 M 96x64";
    const char *name = strstr(last_run.out, "\"against\": \"a \\\"competitor\\\" with 2 threads\"");
    assert_non_null(name);
    const char *ratio = strstr(name, "\"times_faster_than_against\": "),
               *median = strstr(name, "\"against_median_ms\": ");
    assert_true(ratio && median);
    assert_true(atof(median + strlen("\"against_median_ms\": ")) >= 20);
    const double wanted = atof(strstr(name, "_quartile_ms\": ") + strlen("_quartile_ms\": ")) /
                          member(label, 2, "lower_quartile_ms");
    assert_true(fabs(atof(ratio + strlen("\"times_faster_than_against\": ")) / wanted - 1) < 1e-9);
    run_done("wc -l <asked; wc -l <ended; ewa info got.ply; "
             "ewa render got.ply --camera got.json -o got.png");
    assert_int_equal(atoi(last_run.out), 5); // two warm up
    assert_non_null(strstr(last_run.out, "\n1\n"));
    assert_non_null(strstr(last_run.out, "element vertex 2000\n"));
    run_done("rm -f got.* asked ended tables");
    assert_int_equal(scratch_count(), 1); // no folder is left, but the competitor
}

TEST(test_bad_competitors) {
    static const struct {
        const char *lines, *said;
    } cases[] = {
        {"echo no discs >&2; exit 3", "--against: ./competitor failed with status 3: no discs"},
        {"exit 0", "--against: ./competitor ended early"},
        {"echo name; read -r ask; kill -9 $$", "--against: ./competitor was ended by signal 9"},
        {"echo name; exec <&-; exit 4", "--against: ./competitor failed with status 4"},
        {"echo name; exec cat", NULL},
        {"echo name; while read -r ask; do echo; done; echo too late >&2; exit 1",
         "--against: ./competitor failed with status 1: too late"},
        {"echo name; while read -r ask; do printf 'a\\nb\\n'; done",
         "--against: ./competitor says more than one line at a time"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        make_competitor(cases[i].lines);
        if (cases[i].said)
            run_fails(1, cases[i].said, BENCH_AGAINST);
        else
            run_done(BENCH_AGAINST " --json - 2>tables");
    }
    run_fails(1, "--against: ./nobody cannot be started: No such file",
              "ewa bench --scene peer --splats 2000 --size 96x64 --frames 1 --stages off --against ./nobody");
}

int main(void) { return RUN_TESTS(enter, NULL); }
