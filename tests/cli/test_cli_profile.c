// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa profile: a ramp as text, whose profile is text again, to the byte; what is refused.
#include "run_ewa.h"

#include <stdio.h>
#include <string.h>

enum { SIDE = 5 };

/// A ramp of steps of 10, of height x / 2, with decimals of centimetres.
static int enter(void **state) {
    (void)state;
    static char text[4096] = "x,y,z,code\n";
    for (int i = 0; i < SIDE * SIDE; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%d.00,%d.25,%d.00,%d\n", 849200 + 10 * (i % SIDE),
                 1000 + 10 * (i / SIDE), 5 * (i % SIDE), i);
    if (scratch_enter("cli_profile") != 0) return -1;
    scratch_text("ramp.csv", text);
    return 0;
}

/// Stations along x are those of the points; to the right is south.
TEST(test_known_answer) {
    (void)state;
    run_done("ewa profile ramp.csv --line '849200,1020;849230,1020' --width 1 -o profile.csv");
    scratch_text("wanted.csv", "x,y,z,code,station,offset,profile_height\n"
                               "849200.00,1020.25,0.00,10,0,-0.25,0\n"
                               "849210.00,1020.25,5.00,11,10,-0.25,5\n"
                               "849220.00,1020.25,10.00,12,20,-0.25,10\n"
                               "849230.00,1020.25,15.00,13,30,-0.25,15\n");
    assert_true(scratch_same("profile.csv", "wanted.csv"));
    // Backwards, from a scene file and by class of points.
    scratch_text("scene.json", "{\"ewa_scene\": 1, \"items\": [{\"file\": \"ramp.csv\", \"filter\": \"code<=12\"}]}");
    run_done("ewa profile scene.json --line '849230,1020;849200,1020' --width 1 -o back.csv --graph back.png --size 200x100");
    scratch_text("wanted.csv", "x,y,z,code,station,offset,profile_height\n"
                               "849220.00,1020.25,10.00,12,10,0.25,10\n"
                               "849210.00,1020.25,5.00,11,20,0.25,5\n"
                               "849200.00,1020.25,0.00,10,30,0.25,0\n");
    assert_true(scratch_same("back.csv", "wanted.csv"));
    assert_true(scratch_size("back.png") > 100);
}

/// The profile of a profile is itself.
TEST(test_again) {
    (void)state;
    run_done("ewa profile ramp.csv --line '849200,1000;849240,1040' --width 30 -o once.csv");
    run_done("ewa profile once.csv --line '849200,1000;849240,1040' --width 30 -o twice.csv --quiet");
    assert_true(scratch_same("once.csv", "twice.csv"));
    assert_int_equal(run("ewa profile ramp.csv --line '849200,1000;849240,1040' --width 30 --graph a.png --threads 1 && "
                         "ewa profile ramp.csv --line '849200,1000;849240,1040' --width 30 --graph b.png --threads 3"),
                     0);
    assert_true(scratch_same("a.png", "b.png"));
}

TEST(test_refused) {
    (void)state;
    run_fails(2, "no line", "ewa profile ramp.csv -o a.csv");
    run_fails(2, "no output", "ewa profile ramp.csv --line '0,0;1,1'");
    run_fails(2, "--graph|.png", "ewa profile ramp.csv --line '0,0;1,1' --graph a.csv");
    run_fails(2, "--width", "ewa profile ramp.csv --line '0,0;1,1' --width 0 -o a.csv");
    run_fails(1, "--line|two corners", "ewa profile ramp.csv --line '0,0' -o a.csv");
    run_fails(1, "no point lies", "ewa profile ramp.csv --line '0,0;1,1' -o a.csv");
    run_fails(1, "no length", "ewa profile ramp.csv --line '1,1,0;1,1,5' -o a.csv");
    assert_int_equal(scratch_size("a.csv"), -1);
}

int main(void) { return RUN_TESTS(enter, NULL); }
