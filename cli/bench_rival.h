// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Another program that draws the bench's scenes, frame by frame in turns.
#ifndef EWA_CLI_BENCH_RIVAL_H
#define EWA_CLI_BENCH_RIVAL_H

#include "bench_scene.h"
#include "child.h"

enum { BENCH_RIVAL_NAME_BYTES = 128 };

/// The program with one scene and one number of threads; zero-initialise.
typedef struct bench_rival {
    const char *program;
    char name[BENCH_RIVAL_NAME_BYTES]; ///< as it calls itself
    child_process child;
} bench_rival;

/// Starts `program CLOUD.ply CAMERA.json THREADS` and waits for the line with its name, which says that it is
/// ready. The files lie in TMPDIR until then. Returns false after reporting.
bool bench_rival_start(cli_session *session, const char *program, const bench_scene *scene, uint32_t threads,
                       bench_rival *rival);

/// Has it draw a frame: from the line that asks for it to the line that answers. False after reporting.
bool bench_rival_draw(cli_session *session, bench_rival *rival, double *took_s);

/// Lets it end of itself, by the end of its standard input; false after reporting that it fails then.
bool bench_rival_end(cli_session *session, bench_rival *rival);

/// Ends it, whatever it does; does nothing where there is none.
void bench_rival_drop(bench_rival *rival);

#endif
