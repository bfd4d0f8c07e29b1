// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Another program that draws the bench's scenes, frame by frame in turns.
#ifndef EWA_BENCH_COMPETITOR_H
#define EWA_BENCH_COMPETITOR_H

#include "bench/scene.h"
#include "cli/base/child.h"

enum { BENCH_COMPETITOR_NAME_BYTES = 128 };

/// The program with one scene and one number of threads; zero-initialise.
typedef struct bench_competitor {
    const char *program;
    char name[BENCH_COMPETITOR_NAME_BYTES]; ///< as it calls itself
    child_process child;
} bench_competitor;

/// Starts `program CLOUD.ply CAMERA.json THREADS` and waits for the line with its name, which says that it is
/// ready. The files lie in TMPDIR until then. Returns false after reporting.
bool bench_competitor_start(cli_session *session, const char *program, const bench_scene *scene,
                            uint32_t threads, bench_competitor *other);

/// Has it draw a frame: from the line that asks for it to the line that answers. False after reporting.
bool bench_competitor_draw(cli_session *session, bench_competitor *other, double *took_s);

/// Lets it end of itself, by the end of its standard input; false after reporting that it fails then.
bool bench_competitor_end(cli_session *session, bench_competitor *other);

/// Ends it, whatever it does; does nothing where there is none.
void bench_competitor_drop(bench_competitor *other);

#endif
