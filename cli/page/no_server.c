// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The program without CivetWeb: it serves nothing.
#include "cli/page/server.h"

folder_server *folder_server_start(cli_session *session, const char *folder, uint16_t *port) {
    (void)port;
    session_fail(session, "%s: this build serves no folders (EWA_WITH_CIVETWEB)", folder);
    return NULL;
}

void folder_server_stop(folder_server *server) { (void)server; }
