// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which way is up in real files, by eye, and from where they are seen when nobody says. Only where the data
// set is: test_cli_view and test_upright hold the rules on shapes that they make.
#include <stdio.h>
#include <string.h>

#include "run_ewa.h"

static int enter(void **state) { return scratch_enter("cli_view_real"); }

TEST(test_real_files) {
    static const struct {
        const char *path, *up, *view;
    } files[] = {
        {"models/armadillo_86k_tri.obj", "y", "front"},
        {"models/bunny_zipper_ascii.ply", "y", "front"},
        {"models/dragon_100k_tri_normals.ply", "y", "front"},
        {"models/fuze/fuze.obj", "z", "front"},
        {"models/head_lps/LeePerrySmith.obj", "y", "front"},
        {"models/head_lps/head_surfels_100k.ply", "y", "front"},
        {"models/laurana50k_colour.ply", "y", "front"},
        {"models/lucy_100k_tri.ply", "z", "front"},
        {"models/nefertiti_100k_tri.obj", "z", "front"},
        {"models/rangemap_lato000.ply", "y", "the origin"},
        {"models/spot/spot.obj", "y", "iso"},
        {"clouds/ply/Guanyin_colour.ply", "y", "front"},
        {"clouds/ply/lion_takanawa_normals_colour.ply", "z", "front"},
        {"clouds/ply/pond_normals_colour_psz.ply", "y", "iso"},
        {"clouds/text/1.2-with-color.obj", "z", "iso"},
        {"gaussians/garden_sfm_points.ply", "z", "iso"},
    };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        char path[1024];
        if (!check_data(files[i].path, path, sizeof path)) skip();
        assert_true(run("ewa render '%s' -o view.png --size 32x24 --verbose", path) == 0);
        char wanted[64], place[64];
        snprintf(wanted, sizeof wanted, "up: %s (", files[i].up);
        snprintf(place, sizeof place, "), seen from %s\n", files[i].view);
        if (!strstr(last_run.err, wanted) || !strstr(last_run.err, place))
            fail_msg("%s: '%s' and '%s' wanted, said: %s", path, wanted, place, last_run.err);
    }
}

int main(void) { return RUN_TESTS(enter, NULL); }
