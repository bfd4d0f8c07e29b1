// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files by HTTP, by CivetWeb, which knows ranges, dates and kinds of files.
#define _DEFAULT_SOURCE // realpath
#include "cli/base/path.h"
#include "cli/page/server.h"

#include <civetweb.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { STATUS_FORBIDDEN = 403, STATUS_NOT_FOUND = 404, STATUS_METHOD = 405, STATUS_RANGE = 416, ERROR_BYTES = 256 };

struct folder_server {
    struct mg_context *civetweb;
    char *root; ///< links resolved, without a '/' at its end
};

/// Whether a request is for this machine by its own name: a page of another site may have its name lead here.
static bool is_local(const char *host) {
    static const char *const names[] = {"127.0.0.1", "localhost"};
    for (size_t i = 0; host && i < sizeof names / sizeof names[0]; i++) {
        const size_t length = strlen(names[i]);
        if (strncasecmp(host, names[i], length) == 0 && (!host[length] || host[length] == ':')) return true;
    }
    return false;
}

/// Finds what a path of the server leads to, which may be nothing; false where it does not lie below its folder.
static bool find(const folder_server *server, const char *path, struct stat *facts) {
    char named[PATH_BYTES];
    *facts = (struct stat){0};
    if (strstr(path, "/.")) return false;
    if (snprintf(named, sizeof named, "%s%s", server->root, path) >= (int)sizeof named) return false;
    char *resolved = realpath(named, NULL);
    if (!resolved) return true;
    const size_t length = strlen(server->root);
    const bool below = strncmp(resolved, server->root, length) == 0 && (!resolved[length] || resolved[length] == '/');
    const bool found = below && stat(resolved, facts) == 0;
    free(resolved);
    return found;
}

/// Whether a file has the part that is asked for by "bytes=FIRST-[LAST]", which CivetWeb does not look at. Of other ranges it sends the whole.
static bool has_range(const char *range, off_t size_bytes) {
    static const char unit[] = "bytes=";
    if (!range || strncmp(range, unit, sizeof unit - 1) != 0) return true;
    char *end;
    const char *from = range + sizeof unit - 1;
    const unsigned long long first = strtoull(from, &end, 10);
    if (end == from || *end != '-' || *from == '-') return true;
    from = end + 1;
    const unsigned long long last = strtoull(from, &end, 10), size = (unsigned long long)size_bytes;
    // CivetWeb promises a byte too many where the last one lies behind the file: it is asked for the rest in other words.
    if (end != from && last >= first && last >= size) *(char *)from = 0;
    return first < size && (end == from || last >= first);
}

/// Refuses what is none of the folder's; 0: CivetWeb goes on.
static int look_at_request(struct mg_connection *connection) {
    const struct mg_request_info *request = mg_get_request_info(connection);
    const folder_server *server = request->user_data;
    struct stat facts = {0};
    int status = 0;
    if (strcmp(request->request_method, "GET") != 0 && strcmp(request->request_method, "HEAD") != 0)
        status = STATUS_METHOD;
    else if (!is_local(mg_get_header(connection, "Host")))
        status = STATUS_FORBIDDEN;
    else if (!request->local_uri || !find(server, request->local_uri, &facts))
        status = STATUS_NOT_FOUND;
    else if (S_ISREG(facts.st_mode) && !has_range(mg_get_header(connection, "Range"), facts.st_size))
        status = STATUS_RANGE;
    if (status) mg_send_http_error(connection, status, "%s", "");
    return status;
}

/// CivetWeb says nothing itself.
static int keep_quiet(const struct mg_connection *connection, const char *message) {
    (void)connection;
    (void)message;
    return 1;
}

folder_server *folder_server_start(cli_session *session, const char *folder, uint16_t *port) {
    folder_server *server = calloc(1, sizeof *server);
    if (server) server->root = realpath(folder, NULL);
    if (!server || !server->root) {
        session_fail(session, "%s: %s", folder, server ? "there is no such folder" : "out of memory");
        free(server);
        return NULL;
    }
    char listens[32];
    snprintf(listens, sizeof listens, "127.0.0.1:%u", (unsigned)*port);
    const char *options[] = {"document_root", server->root,
                             "listening_ports", listens,
                             "num_threads", "8",
                             "enable_keep_alive", "yes",
                             "keep_alive_timeout_ms", "200", // what an interrupt may wait for
                             "tcp_nodelay", "1",
                             "cgi_pattern", "", // nothing is run
                             "ssi_pattern", "",
                             "hide_files_patterns", ".**", // of lists of folders, by names alone
                             "static_file_max_age", "0",
                             "extra_mime_types", ".mjs=text/javascript,.wasm=application/wasm,.json=application/json",
                             "additional_header",
                             "Cross-Origin-Opener-Policy: same-origin\r\nCross-Origin-Embedder-Policy: require-corp",
                             NULL};
    const struct mg_callbacks callbacks = {.begin_request = look_at_request, .log_message = keep_quiet};
    char why[ERROR_BYTES] = "";
    struct mg_init_data init = {&callbacks, server, options};
    struct mg_error_data error = {.text = why, .text_buffer_size = sizeof why};
    mg_init_library(0);
    server->civetweb = mg_start2(&init, &error);
    struct mg_server_port bound;
    if (server->civetweb && mg_get_server_ports(server->civetweb, 1, &bound) == 1) {
        *port = (uint16_t)bound.port;
        return server;
    }
    session_fail(session, "--port %u: cannot be listened at, such as when another program does; --port 0 takes any that is free (%s)",
                 (unsigned)*port, why);
    folder_server_stop(server);
    return NULL;
}

void folder_server_stop(folder_server *server) {
    if (!server) return;
    if (server->civetweb) mg_stop(server->civetweb);
    mg_exit_library();
    free(server->root);
    free(server);
}
