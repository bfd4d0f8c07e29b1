// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What messages of the library advise, in the words of the program.
#include "cli/base/wording.h"

#include <stdio.h>
#include <string.h>

/// What the library says, with enough around it that no name of a file is taken for it.
static const struct {
    const char *library, *program;
} words[] = {
    {"(keep_going leaves out what is damaged)", "(--keep-going leaves out what is damaged)"},
    {"(close_gaps = false keeps the file's)", "(--close-gaps off keeps the file's)"},
    {", point_size_px decides otherwise", ", --point-size decides otherwise"},
    {"; ewa_coloring says otherwise (", "; --color-by says otherwise ("},
    {"; eye_world decides otherwise", "; --eye decides otherwise"},
    {"; ewa_lod_build() makes better levels", "; `ewa lod FILE -o FILE.copc.laz` makes better levels"},
    {"with an error of 0 the points themselves", "with an error of 0 (--lod-error 0) the points themselves"},
    {"; to_world of one in a scene file turns it", "; 'ewa convert' with --transform, or to_world in a scene file, turns one"},
    {"; ewa_mesh_sample() has options", "; `ewa sample` has options"},
    {"write what is wanted to a file of its own", "`ewa convert` what is wanted to a file of its own"},
    {"ewa_cloud_estimate() of the centres makes surfels",
     "'ewa surfels --keep-normals off' makes surfels of the centres"},
    {"; ewa_cloud_detect_features() makes", "; `ewa features` makes"},
    {"ewa_cloud_estimate() makes new normals and radii",
     "'ewa surfels --keep-normals off --keep-radii off' makes new normals and radii"},
    {"; times ", "; 'ewa convert' with --scale "},
    {"; moved nearer to the origin they do", "; 'ewa convert --translate' moves them"},
    {"which has no points: heights says",
     "which has no points: 'ewa texture' draws pictures, 'ewa warp' those with depths, --heights says"},
    {", which has no voxels", ", which has no voxels: 'ewa texture' draws pictures, 'ewa warp' those with depths"},
};

void wording_of_program(const char *message, char *to, size_t size_bytes) {
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        const char *at = strstr(message, words[i].library);
        if (!at) continue;
        snprintf(to, size_bytes, "%.*s%s%s", (int)(at - message), message, words[i].program,
                 at + strlen(words[i].library));
        return;
    }
    snprintf(to, size_bytes, "%s", message);
}
