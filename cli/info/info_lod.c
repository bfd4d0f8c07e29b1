// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What `ewa info` says of the levels of an octree.
#include "cli/info/info_lod.h"
#include "cli/input/lod_input.h"

#include <inttypes.h>

bool info_lod_open(cli_session *session, const char *path, ewa_lod **lod) {
    *lod = NULL;
    if (!ewa_lod_probe(session->context, path)) return true;
    *lod = lod_input_open(session, path);
    return *lod || !ewa_lod_is_folder(session->context, path); // of a file there may be more to tell
}

void info_lod_print(const ewa_lod *lod, uint64_t sampled_count) {
    ewa_lod_info info;
    ewa_lod_describe(lod, &info);
    printf("  octree      %s, %" PRIu32 " nodes of %" PRIu32 " levels\n", info.kind, info.node_count,
           info.level_count);
    printf("    cube      %.6g from %.10g %.10g %.10g\n", info.side_world, info.low_world[0],
           info.low_world[1], info.low_world[2]);
    printf("    spacing   %.4g at the root\n", info.spacing_world);
    if (info.merged)
        printf("    surfels   %" PRIu64 " stand for the points at its levels\n", info.merged_count);
    else
        printf("    surfels   none that stand for points: ewa lod adds them\n");
    for (uint32_t i = 0; info.merged && i < ewa_cloud_attribute_count(info.represented); i++)
        printf("%s%s%s", i ? " " : "    have      ", ewa_cloud_attribute_at(info.represented, i)->name,
               i + 1 == ewa_cloud_attribute_count(info.represented) ? "\n" : "");
    if (sampled_count)
        printf("    sample    all else is told of %" PRIu64 " points, those of its coarsest levels\n",
               sampled_count);
}

void info_lod_write(json_writer *json, const ewa_lod *lod, uint64_t sampled_count) {
    ewa_lod_info info;
    ewa_lod_describe(lod, &info);
    json_object(json, "octree");
    json_text(json, "kind", info.kind);
    json_count(json, "points", info.point_count);
    json_count(json, "nodes", info.node_count);
    json_count(json, "levels", info.level_count);
    json_vector(json, "cube_low", 3, info.low_world);
    json_number(json, "cube_side", info.side_world);
    json_number(json, "root_spacing", info.spacing_world);
    json_flag(json, "merged", info.merged);
    json_count(json, "merged_surfels", info.merged_count);
    json_array(json, "merged_attributes");
    for (uint32_t i = 0; info.merged && i < ewa_cloud_attribute_count(info.represented); i++)
        json_text(json, NULL, ewa_cloud_attribute_at(info.represented, i)->name);
    json_close(json, ']');
    json_count(json, "sampled_points", sampled_count);
    json_close(json, '}');
}
