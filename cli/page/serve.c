// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa serve: the files of a folder by HTTP, for browsers and programs of this machine.
#include "cli/base/commands.h"
#include "cli/page/server.h"

#include <stdio.h>
#include <sys/stat.h>
#include <time.h>

typedef struct serve_arguments {
    common_arguments common; // first
    int64_t port;
} serve_arguments;

enum { DEFAULT_PORT = 8000, POLL_NS = 20000000 };

static const cli_option serve_table[] = {
    {"port", OPTION_INTEGER, offsetof(serve_arguments, port), "N", "[0, 65535]",
     .help = "where it listens, at 127.0.0.1; 0: wherever there is room", .letter = 'p'},
};

static void set_defaults(void *data) {
    serve_arguments *arguments = data;
    arguments->port = DEFAULT_PORT;
}

static int run(const void *data) {
    const serve_arguments *arguments = data;
    const char *folder = arguments->common.operand_count ? arguments->common.operands[0] : ".";
    cli_session session;
    if (!session_start(&session, &arguments->common)) return session_end(&session, EXIT_FAILED);
    struct stat facts;
    uint16_t port = (uint16_t)arguments->port;
    folder_server *server = NULL;
    if (stat(folder, &facts) == 0 && !S_ISDIR(facts.st_mode))
        session_fail(&session, "%s: no folder; 'ewa page %s --folder DIR' makes one", folder, folder);
    else
        server = folder_server_start(&session, folder, &port);
    if (!server) return session_end(&session, EXIT_FAILED);
    printf("http://127.0.0.1:%u/\n", (unsigned)port);
    fflush(stdout);
    session_note(&session, "Ctrl-C ends it");
    const double limit_s = session.limits.max_seconds;
    bool late = false;
    while (!session_interrupted() && !late) {
        nanosleep(&(struct timespec){.tv_nsec = POLL_NS}, NULL);
        late = limit_s > 0 && clock_now_s() - session.started_s > limit_s;
    }
    folder_server_stop(server);
    if (late) session_fail(&session, "%g s are over (--max-seconds)", limit_s);
    return session_end(&session, late ? EXIT_FAILED : EXIT_DONE);
}

static const option_group serve_options = OPTION_GROUP("Server", serve_table);
const cli_command serve_command = {
    .name = "serve",
    .operands = "[DIR]",
    .summary = "show a folder to browsers of this machine",
    .details = "Prints the address, and answers until it is interrupted: for pages of 'ewa page --folder', and to try what reads from servers. "
               "Files come as they are, whole or in parts (ranges), with the headers by which pages may have threads. It listens at 127.0.0.1, "
               "which no other machine reaches; names that begin with a dot are left out, links out of the folder are not followed, nothing is "
               "run or written. For other machines there are web servers.",
    .examples = "ewa page survey.laz --folder site && ewa serve site\n"
                "ewa serve --port 0 data\n",
    .low_operands = 0,
    .high_operands = 1,
    .groups = (const option_group *const[]){&serve_options, NULL},
    .arguments_bytes = sizeof(serve_arguments),
    .set_defaults = set_defaults,
    .run = run,
};
