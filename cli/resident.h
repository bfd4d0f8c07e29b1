// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From a cloud that can be drawn to the surfels that are: the same in every command that shows one.
#ifndef EWA_CLI_RESIDENT_H
#define EWA_CLI_RESIDENT_H

#include "render_report.h"

typedef struct resident_options {
    ewa_surfels_options surfels;
    bool close_gaps; ///< measure radii anew that leave gaps
    bool as_points;  ///< drawn as discs of pixels, whose radii do not matter
} resident_options;

/// Makes surfels; says what is left out, and where radii are measured anew, which changes the cloud. Adds to
/// the report's times and fills in its facts. Returns false after reporting.
bool resident_make(cli_session *session, const resident_options *options, ewa_cloud **cloud,
                   ewa_surfels **surfels, render_report *report);

#endif
