// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What ewa bench says: statistics of repeated measurements, goals beside them, a table and JSON.
#ifndef EWA_BENCH_REPORT_H
#define EWA_BENCH_REPORT_H

#include "bench/scene.h"
#include "cli/base/json.h"

/// Where the figures go.
typedef struct bench_sink {
    FILE *text;        ///< the table
    json_writer *json; ///< inside an array of results; NULL: none wanted
} bench_sink;

/// Times of one thing that was done again and again.
typedef struct bench_sample {
    double lowest, quartile, median; ///< quartile: a quarter of the times are lower
} bench_sample;

/// Sorts the times and summarises them; zeros when there are none.
bench_sample bench_summarise(double *times, size_t count);

/// Billions of dependent additions per second on the calling thread, which is the clock in GHz where an
/// addition takes one cycle. Takes some ten milliseconds.
double bench_clock_ghz(void);

enum { BENCH_FRAME_STAGES = 6 };

/// What the frames of one scene took with one context.
typedef struct bench_frame_row {
    const bench_scene *scene;
    const char *way; ///< of drawing, where a scene is drawn in several
    const char *cpu; ///< instruction sets
    uint32_t threads;
    bench_sample total;                 ///< seconds
    double stage_s[BENCH_FRAME_STAGES]; ///< medians of thread time, in the order of ewa_render_stats
    ewa_render_stats stats;             ///< of the last frame
    ewa_renderer_info renderer;         ///< after it
    uint32_t passes;
    ewa_surfels_info info;
    double clock_ghz;
    double one_thread_s; ///< lower quartile of the same scene and instruction sets with one thread; 0: none
    double all_sets_s;   ///< the same with all instruction sets and as many threads; 0: none
    double first_way_s;  ///< the same drawn in the first of several ways; 0: none
    const char *competitor; ///< another program that drew the same in turns; NULL: none
    bench_sample competitor_total;
} bench_frame_row;

/// Prints the heads of the columns.
void bench_report_head(const bench_sink *sink);
void bench_report_frames(const bench_sink *sink, const bench_frame_row *row);

/// What one stage outside the frame took.
typedef struct bench_stage_row {
    const char *stage;
    uint32_t threads;
    bench_sample time;
    uint64_t item_count; ///< points, pixels or segments
    uint64_t bytes;      ///< 0: no file
} bench_stage_row;

void bench_report_stage(const bench_sink *sink, const bench_stage_row *row);

#endif
