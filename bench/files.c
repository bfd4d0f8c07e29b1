// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How fast files of points are read and written, format by format.
#include "bench/files.h"
#include "bench/report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SCAN_POINTS = 1000000, SCAN_LINE = 1000, SCRATCH_PATH_BYTES = 320 };

/// One format; the names are those of the rows.
typedef struct file_kind {
    const char *read, *write, *suffix;
    bool is_new; ///< point formats 6 to 10 of LAS
} file_kind;

static const file_kind kinds[] = {
    {"read LAS", "write LAS", ".las", false},
    {"read LAZ, format 3", "write LAZ, format 3", ".laz", false},
    {"read LAZ, format 7", "write LAZ, format 7", ".laz", true},
    {"read PCD", "write PCD", ".pcd", false},
    {"read XYZ", "write XYZ", ".xyz", false},
    {"read CSV", "write CSV", ".csv", false},
};

/// Attributes of the scan.
typedef struct scan_streams {
    double *position, *time;
    uint8_t *color, *class, *returns, *channel;
    uint16_t *intensity;
} scan_streams;

static ewa_status add_streams(ewa_cloud *cloud, bool is_new, scan_streams *s) {
    ewa_status status = ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, (void **)&s->position);
    if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, (void **)&s->color);
    if (status == EWA_OK) status = ewa_cloud_add(cloud, "intensity", EWA_U16, 1, (void **)&s->intensity);
    if (status == EWA_OK) status = ewa_cloud_add(cloud, "classification", EWA_U8, 1, (void **)&s->class);
    if (status == EWA_OK) status = ewa_cloud_add(cloud, "return_number", EWA_U8, 1, (void **)&s->returns);
    if (status == EWA_OK) status = ewa_cloud_add(cloud, "gps_time", EWA_F64, 1, (void **)&s->time);
    if (status == EWA_OK && is_new)
        status = ewa_cloud_add(cloud, "scanner_channel", EWA_U8, 1, (void **)&s->channel);
    return status;
}

/// Lines of a scanner over hills, with the noise that such scans have: the numbers of one point say much, but
/// not all, of the next.
static ewa_status make_scan(ewa_context *context, bool is_new, ewa_cloud **scan) {
    scan_streams s = {.channel = NULL};
    ewa_status status = ewa_cloud_create(context, SCAN_POINTS, scan);
    if (status == EWA_OK) status = add_streams(*scan, is_new, &s);
    uint32_t noise = 1;
    for (uint64_t i = 0; status == EWA_OK && i < SCAN_POINTS; i++) {
        const double x = (double)(i % SCAN_LINE) * 0.35, y = (double)(i / SCAN_LINE) * 0.4;
        noise = noise * 1664525u + 1013904223u;
        const double jitter[3] = {noise >> 24 & 15, noise >> 16 & 15, noise >> 12 & 15};
        const double height = 12 * sin(x / 40) * cos(y / 31) + 2 * sin(x / 3) + 80;
        const double place[3] = {x, y, height};
        for (int c = 0; c < 3; c++) {
            s.position[3 * i + (uint64_t)c] = nearbyint(100 * place[c] + jitter[c]) / 100;
            s.color[3 * i + (uint64_t)c] = (uint8_t)(90 + 3 * height / 4 + (double)(noise >> 20 & 7));
        }
        s.intensity[i] = (uint16_t)(300 + 10 * height + (double)(noise >> 8 & 63));
        s.class[i] = height > 85 ? 5 : 2;
        s.returns[i] = 1;
        s.time[i] = 3.1e8 + 4e-6 * (double)i;
        if (is_new) s.channel[i] = 0;
    }
    if (status == EWA_OK) {
        ewa_cloud_set_origin(*scan, (const double[3]){500000, 4200000, 0});
        ewa_cloud_set_grid(*scan, &(ewa_coordinate_grid){{0.01, 0.01, 0.01}, {500000, 4200000, 0}});
    } else {
        ewa_cloud_destroy(scan);
    }
    return status;
}

uint64_t bench_file_bytes(const char *path) {
    FILE *file = fopen(path, "rb");
    if (!file) return 0;
    const long size = fseek(file, 0, SEEK_END) == 0 ? ftell(file) : 0;
    fclose(file);
    return size > 0 ? (uint64_t)size : 0;
}

static void report(const bench_sink *sink, const bench_plan *plan, const char *name, uint32_t threads,
                   double *time_s, uint64_t points, uint64_t bytes) {
    const bench_stage_row row = {.stage = name,
                                 .threads = threads,
                                 .time = bench_summarise(time_s, plan->frame_count),
                                 .item_count = points,
                                 .bytes = bytes};
    bench_report_stage(sink, &row);
}

/// Reads a file as often as the plan says; `*points` gets how many there are.
static ewa_status time_read(ewa_context *context, const bench_plan *plan, const char *path, double *time_s,
                            uint64_t *points) {
    ewa_status status = EWA_OK;
    for (size_t run = 0; status == EWA_OK && run < plan->frame_count; run++) {
        ewa_cloud *cloud = NULL;
        const double started_s = clock_now_s();
        status = ewa_cloud_load(context, path, &cloud);
        time_s[run] = clock_now_s() - started_s;
        if (cloud) *points = ewa_cloud_point_count(cloud);
        ewa_cloud_destroy(&cloud);
    }
    return status;
}

static ewa_status time_write(const ewa_cloud *scan, const bench_plan *plan, const char *path,
                             double *time_s) {
    ewa_status status = EWA_OK;
    for (size_t run = 0; status == EWA_OK && run < plan->frame_count; run++) {
        const double started_s = clock_now_s();
        status = ewa_cloud_save(scan, path, NULL);
        time_s[run] = clock_now_s() - started_s;
    }
    return status;
}

/// All formats with one number of threads.
static ewa_status measure(ewa_context *context, const bench_plan *plan, const char *folder, double *time_s,
                          const bench_sink *sink) {
    const uint32_t threads = ewa_context_worker_count(context);
    ewa_status status = EWA_OK;
    for (size_t k = 0; status == EWA_OK && k < sizeof kinds / sizeof kinds[0]; k++) {
        char path[SCRATCH_PATH_BYTES];
        snprintf(path, sizeof path, "%s/scan%s", folder, kinds[k].suffix);
        ewa_cloud *scan = NULL;
        uint64_t points = SCAN_POINTS;
        status = make_scan(context, kinds[k].is_new, &scan);
        if (status == EWA_OK) status = time_write(scan, plan, path, time_s);
        const uint64_t bytes = bench_file_bytes(path);
        if (status == EWA_OK) report(sink, plan, kinds[k].write, threads, time_s, points, bytes);
        if (status == EWA_OK) status = time_read(context, plan, path, time_s, &points);
        if (status == EWA_OK) report(sink, plan, kinds[k].read, threads, time_s, points, bytes);
        ewa_cloud_destroy(&scan);
        remove(path);
    }
    return status;
}

bool bench_files(cli_session *session, const bench_plan *plan, const bench_sink *sink) {
    char folder[SESSION_FOLDER_BYTES];
    if (!session_make_folder(session, folder)) return false;
    double *time_s = malloc(BENCH_MAX_FRAMES * sizeof *time_s);
    bool done = time_s != NULL;
    if (!done) session_fail(session, "out of memory for the times of %d runs", (int)BENCH_MAX_FRAMES);
    for (size_t i = 0; done && i < plan->thread_counts; i++) {
        ewa_context *context = session_context(session, plan->threads[i], plan->sets[0].mask);
        const ewa_status status = context ? measure(context, plan, folder, time_s, sink) : EWA_ERROR_MEMORY;
        done = status == EWA_OK;
        if (!done) session_failed(session, status);
        ewa_context_destroy(&context);
    }
    free(time_s);
    rmdir(folder);
    return done;
}

bool bench_files_read(cli_session *session, const bench_plan *plan, const char *const *paths, size_t count,
                      const bench_sink *sink) {
    double *time_s = malloc(BENCH_MAX_FRAMES * sizeof *time_s);
    bool done = time_s != NULL;
    if (!done) session_fail(session, "out of memory for the times of %d runs", (int)BENCH_MAX_FRAMES);
    for (size_t i = 0; done && i < plan->thread_counts * count; i++) {
        const char *path = paths[i % count], *slash = strrchr(path, '/');
        ewa_context *context = session_context(session, plan->threads[i / count], plan->sets[0].mask);
        uint64_t points = 0;
        char name[96];
        snprintf(name, sizeof name, "read %.80s", slash ? slash + 1 : path);
        const ewa_status status =
            context ? time_read(context, plan, path, time_s, &points) : EWA_ERROR_MEMORY;
        done = status == EWA_OK;
        if (done)
            report(sink, plan, name, plan->threads[i / count], time_s, points, bench_file_bytes(path));
        else
            session_failed(session, status);
        ewa_context_destroy(&context);
    }
    free(time_s);
    return done;
}
