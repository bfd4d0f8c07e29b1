// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Octrees of so many points that they are drawn from their levels, and told about by a sample, without being asked to.
#include "run_ewa.h"

static int enter(void **state) { return scratch_enter("lod_large"); }

/// Whether a file of the scratch folder holds a text.
static bool holds(const char *name, const char *text) {
    run("cat %s", name);
    return strstr(last_run.out, text) != NULL;
}

TEST(test_large) {
    run_done("ewa generate plane -n 4010000 -o big.ply && ewa lod big.ply -o big.copc.laz && rm big.ply");
    run_done("ewa render big.copc.laz -o big.png --size 200x200 --stats s.json");
    assert_true(holds("s.json", "\"nodes_drawn\": "));
    run_done("ewa info --json big.copc.laz");
    assert_non_null(strstr(last_run.out, "\"points\": 4010000"));
    assert_null(strstr(last_run.out, "\"sampled_points\": 0"));
    run_done("ewa render big.copc.laz -o ground.png --size 200x200 --filter 'x<0' --stats s.json");
    assert_true(holds("s.json", "\"nodes_drawn\": "));
    run_done("ewa render big.copc.laz -o ground.png --size 200x200 --filter 'return_number<9' --stats s.json");
    assert_false(holds("s.json", "\"nodes_drawn\": ")); // of what its levels lack, that takes all points
}

int main(void) { return RUN_TESTS(enter, NULL); }
