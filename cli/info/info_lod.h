// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What `ewa info` says of the levels of an octree.
#ifndef EWA_CLI_INFO_INFO_LOD_H
#define EWA_CLI_INFO_INFO_LOD_H

#include "cli/base/json.h"

/// Opens the octree at a path, if there is one that is to be told about, else `*lod` is NULL. False after reporting.
bool info_lod_open(cli_session *session, const char *path, ewa_lod **lod);

/// Prints the lines of the tree; `sampled_count`: of how many points the rest is told, 0: of all.
void info_lod_print(const ewa_lod *lod, uint64_t sampled_count);
void info_lod_write(json_writer *json, const ewa_lod *lod, uint64_t sampled_count);

#endif
