// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the Gaussians of a file are, for ewa info.
#ifndef EWA_CLI_INFO_INFO_GAUSSIANS_H
#define EWA_CLI_INFO_INFO_GAUSSIANS_H

#include "cli/base/json.h"
#include "cli/base/session.h"

/// A file of Gaussians, measured.
typedef struct gaussians_told {
    ewa_gaussian_facts file;
    uint32_t count, sh_degree;
    bool flat, antialiased;
    ewa_bounds bounds;
    ewa_upright upright;
    double scales_world[3], opacities[3]; ///< 5 %, median, 95 %; scales: the geometric mean of the axes
} gaussians_told;

/// Loads and measures; false after reporting.
bool info_gaussians_gather(cli_session *session, const char *path, gaussians_told *told);

/// Prints the lines that are about Gaussians and no other points.
void info_gaussians_print(const gaussians_told *told);

/// Writes the member "gaussians".
void info_gaussians_write(json_writer *json, const gaussians_told *told);

/// Tells of a file that holds nothing else: `json` is NULL for text. False after reporting.
bool info_gaussians(cli_session *session, const char *path, json_writer *json);

#endif
