// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a run of render took and drew: --stats.
#ifndef EWA_CLI_RENDER_RENDER_REPORT_H
#define EWA_CLI_RENDER_RENDER_REPORT_H

#include "cli/render/frames.h"

/// One frame of many.
typedef struct frame_report {
    double render_s, write_s;
    uint64_t culled_count, drawn_count;
} frame_report;

typedef struct render_report {
    uint64_t point_count;
    double load_s, estimate_s, surfels_s;
    double render_s, write_s; ///< of all frames
    ewa_surfels_info surfels;
    ewa_renderer_info renderer; ///< after the last frame
    ewa_render_stats stats;     ///< counts and times summed over all frames, but for the splats
    frame_report *frames;       ///< of each frame that was drawn, when there are many
    bool from_lod;              ///< drawn from the levels of an octree:
    ewa_lod_stats lod; ///< of the frame with the most surfels, but for what was loaded and times: of all
} render_report;

/// Adds what frame `index` of the `count` that are drawn took; false after reporting that memory ran out.
bool render_report_add(cli_session *session, render_report *report, size_t index, size_t count,
                       const ewa_render_stats *stats, double render_s, double write_s);

/// Adds what a frame of an octree took, beside its drawing.
void render_report_add_lod(render_report *report, const ewa_lod_stats *stats);

void render_report_free(render_report *report);

/// Writes the report as JSON; `many`: with a list of the frames. Returns false after reporting.
bool render_report_write(cli_session *session, const common_arguments *common, bool many,
                         const frame_cameras *frames, const render_report *report, const char *path);

#endif
