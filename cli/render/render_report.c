// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a run of render took and drew: --stats.
#include "cli/render/render_report.h"
#include "cli/base/backend.h"

#include <stdlib.h>

bool render_report_add(cli_session *session, render_report *report, size_t index, size_t count,
                       const ewa_render_stats *stats, double render_s, double write_s) {
    if (!report->frames) report->frames = calloc(count, sizeof *report->frames);
    if (!report->frames) {
        session_fail(session, "out of memory for %zu frames", count);
        return false;
    }
    report->frames[index] = (frame_report){render_s, write_s, stats->culled_count, stats->drawn_count};
    report->render_s += render_s;
    report->write_s += write_s;
    ewa_render_stats_add(&report->stats, stats);
    return true;
}

void render_report_add_lod(render_report *report, const ewa_lod_stats *stats) {
    ewa_lod_stats *sum = &report->lod;
    const uint64_t loaded_count = sum->loaded_count + (uint64_t)stats->loaded_count;
    const double choose_s = sum->choose_s + stats->choose_s, load_s = sum->load_s + stats->load_s;
    if (stats->surfel_count >= sum->surfel_count) *sum = *stats;
    sum->loaded_count = loaded_count < UINT32_MAX ? (uint32_t)loaded_count : UINT32_MAX;
    sum->choose_s = choose_s;
    sum->load_s = load_s;
}

void render_report_free(render_report *report) {
    free(report->frames);
    report->frames = NULL;
}

static void write_frames(json_writer *json, const frame_cameras *drawn, const frame_report *frames) {
    json_count(json, "film_frame_count", drawn->count);
    json_count(json, "frame_count", drawn->chosen_count);
    json_array(json, "frames");
    for (size_t i = 0; i < drawn->chosen_count; i++) {
        json_object(json, NULL);
        json_count(json, "frame", drawn->chosen[i]);
        json_number(json, "render_s", frames[i].render_s);
        json_number(json, "write_s", frames[i].write_s);
        json_count(json, "splats_culled", frames[i].culled_count);
        json_count(json, "splats_drawn", frames[i].drawn_count);
        json_close(json, '}');
    }
    json_close(json, ']');
}

static void write_lod(json_writer *json, const ewa_lod_stats *stats) {
    json_object(json, "lod");
    json_count(json, "nodes_drawn", stats->node_count);
    json_count(json, "nodes_loaded", stats->loaded_count);
    json_count(json, "nodes_missing", stats->missing_count);
    json_count(json, "surfels", stats->surfel_count);
    json_count(json, "resident_bytes", stats->resident_bytes);
    json_count(json, "bands", stats->band_count);
    json_number(json, "coarser", stats->coarser);
    json_number(json, "choose_s", stats->choose_s);
    json_number(json, "load_s", stats->load_s);
    json_close(json, '}');
}

bool render_report_write(cli_session *session, const common_arguments *common, bool many,
                         const frame_cameras *frames, const render_report *report, const char *path) {
    text_file text;
    if (!text_file_open(session, &text, path)) return false;
    json_writer json;
    json_start(&json, text.file);
    json_text(&json, "version", ewa_version());
    json_array(&json, "inputs");
    for (size_t i = 0; i < common->operand_count; i++) json_text(&json, NULL, common->operands[i]);
    json_close(&json, ']');
    json_count(&json, "width", frames->cameras->width_px);
    json_count(&json, "height", frames->cameras->height_px);
    json_count(&json, "threads", ewa_context_worker_count(session->context));
    backend_write(&json, &report->renderer);
    json_count(&json, "points", report->point_count);
    json_count(&json, "points_left_out", report->surfels.left_out_count);
    json_count(&json, "resident_bytes", report->surfels.resident_bytes);
    json_number(&json, "unit_coverage", report->surfels.unit_coverage);
    json_count(&json, "splats", report->stats.splat_count);
    json_count(&json, "splats_culled", report->stats.culled_count);
    json_count(&json, "splats_hidden", report->stats.hidden_count);
    json_count(&json, "splats_drawn", report->stats.drawn_count);
    json_count(&json, "fragment_blocks", report->stats.fragment_count);
    json_object(&json, "wall_s");
    json_number(&json, "load", report->load_s);
    json_number(&json, "estimate", report->estimate_s);
    json_number(&json, "surfels", report->surfels_s);
    json_number(&json, "render", report->render_s);
    json_number(&json, "write", report->write_s);
    json_number(&json, "total", clock_now_s() - session->started_s);
    json_close(&json, '}');
    json_object(&json, "thread_s");
    json_number(&json, "bin", report->stats.bin_s);
    json_number(&json, "setup", report->stats.setup_s);
    json_number(&json, "visibility", report->stats.visibility_s);
    json_number(&json, "accumulate", report->stats.accumulate_s);
    json_number(&json, "edges", report->stats.edge_s);
    json_number(&json, "resolve", report->stats.resolve_s);
    json_close(&json, '}');
    if (report->from_lod) write_lod(&json, &report->lod);
    if (session->group) {
        json_object(&json, "ranks");
        json_count(&json, "count", session->group->exchange.rank_count);
        json_count(&json, "given_bytes", session->group->given_bytes(session->group));
        json_number(&json, "waited_s", session->group->waited_s(session->group));
        json_close(&json, '}');
    }
    if (many) write_frames(&json, frames, report->frames);
    json_count(&json, "peak_memory_bytes", memory_peak_bytes());
    json_end(&json);
    return text_file_close(session, &text);
}
