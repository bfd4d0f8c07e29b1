// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Another program that draws the bench's scenes, frame by frame in turns. The clock is this program's, so that
// both are measured alike; the pipe between the two costs some ten microseconds.
#include "bench/competitor.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

static const char SUBJECT[] = "--against";

/// Reads one line, cut to `text_bytes`; false after reporting.
static bool read_line(cli_session *session, bench_competitor *other, char *text, size_t text_bytes) {
    size_t length = 0;
    for (;;) {
        char part[BENCH_COMPETITOR_NAME_BYTES];
        const ssize_t got = read(other->child.output, part, sizeof part);
        if (got < 0 && errno == EINTR && !session_interrupted()) continue;
        if (got <= 0) return child_wait(session, &other->child, SUBJECT, other->program, true);
        const char *end = memchr(part, '\n', (size_t)got);
        const size_t wanted = end ? (size_t)(end - part) : (size_t)got, room = text_bytes - 1 - length;
        memcpy(text + length, part, wanted < room ? wanted : room);
        length += wanted < room ? wanted : room;
        if (!end) continue;
        text[length] = 0;
        if (end + 1 == part + got) return true;
        session_fail(session, "%s: %s says more than one line at a time", SUBJECT, other->program);
        return false;
    }
}

bool bench_competitor_start(cli_session *session, const char *program, const bench_scene *scene,
                            uint32_t threads, bench_competitor *other) {
    char folder[SESSION_FOLDER_BYTES], cloud[sizeof folder + 32], camera[sizeof folder + 32], count[16];
    *other = (bench_competitor){.program = program};
    if (!session_make_folder(session, folder)) return false;
    snprintf(cloud, sizeof cloud, "%s/cloud.ply", folder);
    snprintf(camera, sizeof camera, "%s/camera.json", folder);
    snprintf(count, sizeof count, "%u", threads);
    ewa_status status = ewa_cloud_save(scene->cloud, cloud, NULL);
    if (status == EWA_OK) status = ewa_camera_save(session->context, &scene->camera, camera);
    bool done = status == EWA_OK;
    if (!done) session_failed(session, status);
    if (done) {
        const char *const words[] = {program, cloud, camera, count, NULL};
        const int error = child_start(program, words, true, &other->child);
        done = error == 0;
        if (!done) session_fail(session, "%s: %s cannot be started: %s", SUBJECT, program, strerror(error));
    }
    done = done && read_line(session, other, other->name, sizeof other->name);
    remove(cloud);
    remove(camera);
    rmdir(folder);
    return done;
}

bool bench_competitor_draw(cli_session *session, bench_competitor *other, double *took_s) {
    char answer[2];
    const double started_s = clock_now_s();
    ssize_t written;
    do written = write(other->child.input, "\n", 1);
    while (written < 0 && errno == EINTR && !session_interrupted());
    if (written != 1) return child_wait(session, &other->child, SUBJECT, other->program, true);
    const bool done = read_line(session, other, answer, sizeof answer);
    *took_s = clock_now_s() - started_s;
    return done;
}

bool bench_competitor_end(cli_session *session, bench_competitor *other) {
    return child_wait(session, &other->child, SUBJECT, other->program, false);
}

void bench_competitor_drop(bench_competitor *other) { child_drop(&other->child); }
