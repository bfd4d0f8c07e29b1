// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What ewa bench says: statistics of repeated measurements, goals beside them, a table and JSON.
#include "bench/report.h"

#include "bench/goals.h"
#include "cli/base/backend.h"

#include <stdlib.h>

static const char *const frame_stages[BENCH_FRAME_STAGES] = {"bin",        "setup", "visibility",
                                                             "accumulate", "edges", "resolve"};

/// Goals have few digits: a figure that misses one by less reaches it.
static const double ROUNDING = 1.0005;

static int compare_times(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

bench_sample bench_summarise(double *times, size_t count) {
    if (count == 0) return (bench_sample){0, 0, 0};
    qsort(times, count, sizeof *times, compare_times);
    return (bench_sample){times[0], times[count / 4], times[count / 2]};
}

double bench_clock_ghz(void) {
    enum { RUNS = 40, ADDITIONS = 1 << 20 };
    double shortest_s = 1;
    uint64_t sum = 1;
    for (int run = 0; run < RUNS; run++) {
        const double started_s = clock_now_s();
        for (int i = 0; i < ADDITIONS / 4; i++) {
            // The empty statements keep the compiler from making one addition of four.
            sum += sum;
            __asm__ volatile("" : "+r"(sum));
            sum += sum;
            __asm__ volatile("" : "+r"(sum));
            sum += sum;
            __asm__ volatile("" : "+r"(sum));
            sum += sum;
            __asm__ volatile("" : "+r"(sum));
        }
        const double took_s = clock_now_s() - started_s;
        if (took_s < shortest_s) shortest_s = took_s;
    }
    return 1e-9 * ADDITIONS / shortest_s;
}

static void report_goals(const bench_sink *sink, const bench_goal *goals, size_t count) {
    for (size_t i = 0; i < count; i++)
        fprintf(sink->text, "%s %s %.4g %s: %.2f x floor, %.2f x target", i ? ";" : " ", goals[i].figure,
                goals[i].value, goals[i].unit, bench_goal_ratio(&goals[i], goals[i].floor),
                bench_goal_ratio(&goals[i], goals[i].target));
    if (!sink->json || count == 0) return;
    json_array(sink->json, "goals");
    for (size_t i = 0; i < count; i++) {
        const double floor_ratio = bench_goal_ratio(&goals[i], goals[i].floor),
                     target_ratio = bench_goal_ratio(&goals[i], goals[i].target);
        json_object(sink->json, NULL);
        json_text(sink->json, "figure", goals[i].figure);
        json_text(sink->json, "unit", goals[i].unit);
        json_number(sink->json, "value", goals[i].value);
        json_number(sink->json, "floor", goals[i].floor);
        json_number(sink->json, "target", goals[i].target);
        json_number(sink->json, "ratio_to_floor", floor_ratio);
        json_number(sink->json, "ratio_to_target", target_ratio);
        json_text(sink->json, "reaches",
                  target_ratio <= ROUNDING  ? "target"
                  : floor_ratio <= ROUNDING ? "floor"
                                            : "nothing");
        json_close(sink->json, '}');
    }
    json_close(sink->json, ']');
}

void bench_report_head(const bench_sink *sink) {
    fprintf(sink->text, "%-26s %-5s %3s %8s %8s %8s %6s  %7s %7s %7s %7s %7s %7s %6s\n", "", "cpu", "thr",
            "median", "quartile", "M/s", "ratio", "bin", "setup", "visib.", "accum.", "edges", "resolve",
            "B/pt");
    fprintf(sink->text, "%-26s %-5s %3s %8s %8s %8s %6s  %47s\n", "", "", "", "ms", "ms", "", "",
            "ms of thread time");
}

static void write_frames(json_writer *json, const bench_frame_row *row, const char *label) {
    const bench_scene *scene = row->scene;
    const double points = (double)row->info.point_count;
    json_text(json, "scene", scene->name);
    json_text(json, "label", label);
    if (row->way) json_text(json, "way", row->way);
    json_count(json, "splats", row->info.point_count);
    if (scene->covered_px > 0) json_number(json, "covered_px", scene->covered_px);
    if (scene->unseen_share > 0) json_number(json, "unseen_share", scene->unseen_share);
    json_count(json, "width", scene->camera.width_px);
    json_count(json, "height", scene->camera.height_px);
    json_text(json, "cpu", row->cpu);
    json_count(json, "threads", row->threads);
    backend_write(json, &row->renderer);
    json_count(json, "passes", row->passes);
    json_number(json, "median_ms", 1e3 * row->total.median);
    json_number(json, "lower_quartile_ms", 1e3 * row->total.quartile);
    json_number(json, "lowest_ms", 1e3 * row->total.lowest);
    json_number(json, "splats_per_s", points / row->total.median);
    if (row->one_thread_s > 0) json_number(json, "speedup", row->one_thread_s / row->total.quartile);
    if (row->all_sets_s > 0) json_number(json, "ratio_to_all_sets", row->total.quartile / row->all_sets_s);
    if (row->first_way_s > 0) json_number(json, "ratio_to_first_way", row->total.quartile / row->first_way_s);
    json_number(json, "resident_bytes_per_point", (double)row->info.resident_bytes / points);
    json_count(json, "splats_culled", row->stats.culled_count);
    json_count(json, "splats_drawn", row->stats.drawn_count);
    json_count(json, "fragment_blocks", row->stats.fragment_count);
    json_number(json, "clock_ghz", row->clock_ghz);
    json_object(json, "thread_ms");
    for (int k = 0; k < BENCH_FRAME_STAGES; k++) json_number(json, frame_stages[k], 1e3 * row->stage_s[k]);
    json_close(json, '}');
    json_object(json, "cycles_per_splat");
    for (int k = 0; k < BENCH_FRAME_STAGES; k++)
        json_number(json, frame_stages[k], 1e9 * row->clock_ghz * row->stage_s[k] / points);
    json_close(json, '}');
}

void bench_report_frames(const bench_sink *sink, const bench_frame_row *row) {
    const double points = (double)row->info.point_count;
    char label[96];
    snprintf(label, sizeof label, row->way ? "%s, %s" : "%s", row->scene->label, row->way);
    fprintf(sink->text, "%-26s %-5s %3u %8.2f %8.2f %8.1f ", label, row->cpu, row->threads,
            1e3 * row->total.median, 1e3 * row->total.quartile, 1e-6 * points / row->total.median);
    if (row->one_thread_s > 0)
        fprintf(sink->text, "%6.2f ", row->one_thread_s / row->total.quartile);
    else
        fprintf(sink->text, "%6s ", "");
    for (int k = 0; k < BENCH_FRAME_STAGES; k++) fprintf(sink->text, " %7.2f", 1e3 * row->stage_s[k]);
    fprintf(sink->text, " %6.1f", (double)row->info.resident_bytes / points);
    if (sink->json) {
        json_object(sink->json, NULL);
        write_frames(sink->json, row, label);
    }
    const bool on_device = *row->renderer.device != 0;
    if (on_device) fprintf(sink->text, "  %s: %s", row->renderer.backend, row->renderer.device);
    const bool all_splats = row->stats.level == 0 && !on_device; // others draw them, and goals are of them
    const double peer_ms = row->threads == 2 && all_splats ? bench_peer_ms(row->scene) : 0;
    if (peer_ms > 0) {
        const double ratio = peer_ms / (1e3 * row->total.median);
        fprintf(sink->text, "  best peer %.0f ms: %.1f times faster", peer_ms, ratio);
        if (sink->json) {
            json_number(sink->json, "peer_ms", peer_ms);
            json_number(sink->json, "times_faster_than_peer", ratio);
        }
    }
    if (row->competitor) {
        const double ratio = row->competitor_total.quartile / row->total.quartile;
        fprintf(sink->text, "  %s %.2f ms: %.1f times faster", row->competitor,
                1e3 * row->competitor_total.median, ratio);
        if (sink->json) {
            json_text(sink->json, "against", row->competitor);
            json_number(sink->json, "against_median_ms", 1e3 * row->competitor_total.median);
            json_number(sink->json, "against_lower_quartile_ms", 1e3 * row->competitor_total.quartile);
            json_number(sink->json, "times_faster_than_against", ratio);
        }
    }
    if (row->first_way_s > 0)
        fprintf(sink->text, "  %.3f of the first", row->total.quartile / row->first_way_s);
    bench_goal goals[BENCH_MAX_GOALS];
    report_goals(sink, goals, all_splats ? bench_goals_frames(row, goals) : 0);
    if (sink->json) json_close(sink->json, '}');
    fputc('\n', sink->text);
    fflush(sink->text);
}

void bench_report_stage(const bench_sink *sink, const bench_stage_row *row) {
    fprintf(sink->text, "%-26s %-5s %3u %8.2f %8.2f %8.1f", row->stage, "", row->threads,
            1e3 * row->time.median, 1e3 * row->time.quartile,
            1e-6 * (double)row->item_count / row->time.median);
    if (row->bytes) fprintf(sink->text, "  %.2f GB/s", 1e-9 * (double)row->bytes / row->time.median);
    if (sink->json) {
        json_object(sink->json, NULL);
        json_text(sink->json, "stage", row->stage);
        json_count(sink->json, "threads", row->threads);
        json_number(sink->json, "median_ms", 1e3 * row->time.median);
        json_number(sink->json, "lower_quartile_ms", 1e3 * row->time.quartile);
        json_number(sink->json, "lowest_ms", 1e3 * row->time.lowest);
        json_count(sink->json, "items", row->item_count);
        if (row->bytes) json_count(sink->json, "bytes", row->bytes);
    }
    bench_goal goals[BENCH_MAX_GOALS];
    report_goals(sink, goals, bench_goals_stage(row, goals));
    if (sink->json) json_close(sink->json, '}');
    fputc('\n', sink->text);
    fflush(sink->text);
}
