// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A web server of this machine alone for the files below a folder.
#ifndef EWA_CLI_PAGE_SERVER_H
#define EWA_CLI_PAGE_SERVER_H

#include "cli/base/session.h"

typedef struct folder_server folder_server;

/// Answers requests for files below a folder on threads of its own, at 127.0.0.1: parts of files (ranges), files as they are, with the headers by
/// which a page may have threads. Files whose names begin with a dot, and links that lead out of the folder, are not there; nothing is
/// run, nothing written, and who asks by another name than localhost is refused. Listens at `*port`, 0: at any that is free, which `*port`
/// is then. NULL after reporting.
folder_server *folder_server_start(cli_session *session, const char *folder, uint16_t *port);

/// Ends it; may be NULL.
void folder_server_stop(folder_server *server);

#endif
