// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files of points streamed piece by piece.
#include "cli/convert/streaming.h"
#include "cli/input/gaussian_files.h"
#include "cli/input/import.h"
#include "cli/input/lod_input.h"
#include "cli/input/volume_input.h"

#include <math.h>
#include <string.h>

/// Enough for every thread to have its share, little enough for 100 bytes a point not to matter.
static const uint64_t PIECE_POINTS = 1 << 19;

/// Whether a file holds points of a known format, which `*format` gets, and can be read twice.
static bool is_possible(cli_session *session, const char *path, ewa_model_format *format) {
    if (strcmp(path, "-") == 0 || strncmp(path, "/dev/", 5) == 0 || ewa_volume_is_file(session->context, path) ||
        import_is_named(path) || ewa_lod_is_folder(session->context, path) ||
        gaussian_files_format(session, path) > EWA_GAUSSIANS_PLY ||
        ewa_model_probe(session->context, path, format) != EWA_OK)
        return false;
    return *format == EWA_MODEL_PLY || (*format >= EWA_MODEL_LAS && *format != EWA_MODEL_VTK);
}

typedef struct stream_job {
    cli_session *session;
    const char *path;
    const output_arguments *output;
    const void *arguments;
    streaming_change *change;
    ewa_cloud_reader *reader;
    ewa_cloud_writer *writer;
    bool checked;      // the first piece was looked at
    bool opened, read; // the file was, to its end
    uint64_t count;    // of the points that are kept
    ewa_bounds bounds; // of those
} stream_job;

static void widen(ewa_bounds *box, const ewa_bounds *other) {
    if (other->finite_count == 0) return;
    for (int c = 0; c < 3; c++) {
        box->low_world[c] = fmin(box->low_world[c], other->low_world[c]);
        box->high_world[c] = fmax(box->high_world[c], other->high_world[c]);
    }
    box->finite_count += other->finite_count;
}

/// Opens the file anew, at its begin; false after reporting.
static bool reopen(stream_job *p) {
    ewa_cloud_reader_close(&p->reader);
    p->session->repeats = p->opened;
    const ewa_status status = ewa_cloud_reader_open(p->session->context, p->path, &p->session->load, &p->reader);
    p->session->repeats = false;
    p->opened = true;
    return session_passed(p->session, status);
}

/// Reads all pieces and changes them; each goes to `take`. False after reporting.
static bool each_piece(stream_job *p, ewa_status (*take)(stream_job *p, const ewa_cloud *piece)) {
    ewa_status status = EWA_OK;
    bool changed = true;
    while (status == EWA_OK && changed) {
        ewa_cloud *piece = NULL;
        p->session->repeats = p->read;
        status = ewa_cloud_reader_next(p->reader, PIECE_POINTS, &piece);
        p->session->repeats = false;
        if (status != EWA_OK || !piece) break;
        // What the file says, not what becomes of it.
        if (!p->checked) ewa_cloud_check_steps(piece);
        p->checked = true;
        changed = p->change(p->session, p->arguments, &piece);
        if (changed && ewa_cloud_point_count(piece)) status = take(p, piece);
        ewa_cloud_destroy(&piece);
    }
    p->read = true;
    if (status != EWA_OK) session_failed(p->session, status);
    return status == EWA_OK && changed;
}

static ewa_status measure_piece(stream_job *p, const ewa_cloud *piece) {
    ewa_bounds box;
    const ewa_status status = ewa_cloud_measure(piece, &box);
    p->count += ewa_cloud_point_count(piece);
    if (status == EWA_OK) widen(&p->bounds, &box);
    return status;
}

static ewa_status put_piece(stream_job *p, const ewa_cloud *piece) {
    p->count += ewa_cloud_point_count(piece);
    return ewa_cloud_writer_put(p->writer, piece);
}

/// The attributes, the origin and the grid of what is written: those of a changed piece.
static bool make_prototype(stream_job *p, ewa_cloud **prototype) {
    if (!reopen(p)) return false;
    const ewa_status status = ewa_cloud_reader_next(p->reader, 1, prototype);
    if (status == EWA_OK && !*prototype) {
        session_fail(p->session, "%s: the file has no points", p->path);
        return false;
    }
    if (!session_passed(p->session, status)) return false;
    return p->change(p->session, p->arguments, prototype);
}

/// Opens the output for what a first look has found.
static bool open_output(stream_job *p, const ewa_cloud *prototype, bool counted, bool keeps_count) {
    ewa_cloud_save_options options;
    cloud_output_options_fill(p->output, &options);
    const uint64_t point_count = counted       ? p->count
                                 : keeps_count ? ewa_cloud_reader_maximum_points(p->reader)
                                               : EWA_POINTS_UNKNOWN;
    return session_passed(p->session,
                          ewa_cloud_writer_open(p->session->context, p->output->path, &options, prototype,
                                                point_count, counted ? &p->bounds : NULL, &p->writer));
}

/// Whether the number of points comes before them and cannot be put there later.
static bool needs_count(const char *path) { return strcmp(path, "-") == 0 || strncmp(path, "/dev/", 5) == 0; }

/// Says how many points were lost to damage, and how many were written.
static void report(const stream_job *p) {
    const uint64_t lost_count = ewa_cloud_reader_lost_count(p->reader);
    if (lost_count)
        session_note(p->session, "%s: %llu points are lost", p->path, (unsigned long long)lost_count);
    session_say(p->session, "%s: %llu points written", p->output->path, (unsigned long long)p->count);
}

static streaming_result pass(stream_job *p, bool keeps_count) {
    ewa_model_format format;
    if (!is_possible(p->session, p->path, &format)) return STREAMING_IMPOSSIBLE;
    // Other formats have points that are left out, and no count of the others.
    keeps_count &= (format == EWA_MODEL_PLY || format == EWA_MODEL_LAS) && !p->session->load.keep_going;
    ewa_cloud *prototype = NULL;
    bool done = make_prototype(p, &prototype);
    if (done && ewa_cloud_note(prototype, "file.faces", NULL)) {
        ewa_cloud_destroy(&prototype);
        return STREAMING_IMPOSSIBLE;
    }
    const bool counted = done && (ewa_cloud_writer_needs_bounds(p->output->path, prototype) ||
                                  (!keeps_count && needs_count(p->output->path)));
    if (done && counted) done = reopen(p) && each_piece(p, measure_piece);
    if (done) done = reopen(p) && open_output(p, prototype, counted, keeps_count);
    p->count = 0;
    done = done && each_piece(p, put_piece);
    if (done && p->count == 0) {
        session_fail(p->session, "%s: none of the points is left", p->path);
        done = false;
    }
    const ewa_status status = done ? ewa_cloud_writer_commit(&p->writer) : EWA_OK;
    if (status != EWA_OK) session_failed(p->session, status);
    if (done && status == EWA_OK) report(p);
    ewa_cloud_writer_abort(&p->writer);
    ewa_cloud_destroy(&prototype);
    return done && status == EWA_OK ? STREAMING_DONE : STREAMING_FAILED;
}

streaming_result streaming_run(cli_session *session, const char *path, const output_arguments *output,
                               const void *arguments, streaming_change *change, bool keeps_count) {
    stream_job p = {.session = session,
                    .path = path,
                    .output = output,
                    .arguments = arguments,
                    .change = change,
                    .bounds = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 0}};
    session->subject = path;
    const streaming_result result = pass(&p, keeps_count);
    ewa_cloud_reader_close(&p.reader);
    return result;
}
