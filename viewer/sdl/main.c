// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The program ewa-view: `ewa view` with a window. A program of its own, so that no other command waits for the
// libraries that windows need.
#include "cli/base/commands.h"
#include "cli/base/json.h"
#include "cli/view/window.h"


static int show(const void *arguments) { return window_run(arguments, front_window_run); }

int main(int argc, char **argv) {
    process_start();
    cli_command command = view_command;
    command.run = show;
    const int exit_status =
        command_run(&command, NULL, argc > 0 ? (size_t)argc - 1 : 0, (const char *const *)argv + 1);
    cli_session session = {.quiet = false};
    return output_flush(&session, exit_status);
}
