// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The program where no helper reads rare formats of meshes (WASI, Windows).
#include "cli/input/import.h"

bool import_is_named(const char *path) {
    (void)path;
    return false;
}

bool import_load(cli_session *session, const char *path, uint32_t wanted, ewa_model *model) {
    (void)wanted, (void)model;
    session_fail(session, "%s: no helper that reads it can be started on this system", path);
    return false;
}

bool import_run(cli_session *session, const char *helper, const char *path, const import_limits *limits,
                uint8_t **bytes, size_t *size_bytes) {
    (void)helper, (void)limits;
    *bytes = NULL;
    *size_bytes = 0;
    session_fail(session, "%s: no helper that reads it can be started on this system", path);
    return false;
}
