// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How fast files of points are read and written, format by format.
#ifndef EWA_BENCH_FILES_H
#define EWA_BENCH_FILES_H

#include "bench/frames.h"

/// Returns the size of a file; 0 when it cannot be read.
uint64_t bench_file_bytes(const char *path);

/// Measures and reports every format that is written, with a scan of a million points, for the plan's numbers
/// of threads. Files go to a folder in TMPDIR that is removed afterwards. Returns false after reporting.
bool bench_files(cli_session *session, const bench_plan *plan, const bench_sink *sink);

/// Measures and reports how fast files are read that somebody has.
bool bench_files_read(cli_session *session, const bench_plan *plan, const char *const *paths, size_t count,
                      const bench_sink *sink);

#endif
