// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa view: the viewer, in a window by the program ewa-view beside this one, or run by a script without any.
#include "cli/view/window.h"
#include "cli/base/backend.h"
#include "cli/base/child.h"
#include "cli/base/commands.h"
#include "cli/input/inputs.h"
#include "cli/view/window_services.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

typedef struct window_arguments {
    frames_arguments frames; // first; the camera's options of it are taken, there are no frames
    look_arguments look;     // second
    const char *script_path;
    bool timings, window;
    double scale;
    int backend;
} window_arguments;

static const cli_option window_table[] = {
    {"script", OPTION_TEXT, offsetof(window_arguments, script_path), "FILE",
     .help = "do what the lines of a file say, in place of a person (docs/viewer.md), without a window; -: "
             "standard input"},
    {"timings", OPTION_FLAG, offsetof(window_arguments, timings),
     .help = "keep the times of the script, and print what the pictures took", .needs = "script"},
    {"window", OPTION_FLAG, offsetof(window_arguments, window), .help = "run the script in a window",
     .needs = "script"},
    {"scale", OPTION_NUMBER, offsetof(window_arguments, scale), "N", "[0.25, 8]",
     .help = "pixels per point of the script's screen", .needs = "script"},
    BACKEND_OPTION(offsetof(window_arguments, backend)),
};

_Static_assert(offsetof(window_arguments, look) == LOOK_OFFSET, "the look's tables say so");

static void set_defaults(void *data) {
    window_arguments *arguments = data;
    view_set_defaults(&arguments->frames.view);
    look_set_defaults(&arguments->look);
    arguments->frames.view.size = (option_size){1280, 800, false};
    arguments->scale = 1;
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const window_arguments *arguments = data;
    return look_check(&arguments->look, NULL, message) && view_check(&arguments->frames.view, false, message);
}

/// Keeps memory flat over hours: else the C library gives each thread that loads or draws a heap of its own, which stays when the
/// thread ends, and takes larger and larger blocks from it, the larger ones that were given back: one small block behind one of a
/// cloud then keeps as much for good.
static void keep_memory_flat(void) {
#ifdef M_ARENA_MAX
    mallopt(M_ARENA_MAX, 1);
#endif
#ifdef M_MMAP_THRESHOLD
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
}

int window_run(const void *data, int (*front)(const front_job *job)) {
    keep_memory_flat();
    const window_arguments *arguments = data;
    const view_arguments *view = &arguments->frames.view;
    const common_arguments *common = &view->common;
    window_services services;
    viewer_look look;
    front_job job = {.paths = common->operands,
                     .path_count = common->operand_count,
                     .script_path = arguments->script_path,
                     .timings = arguments->timings,
                     .started_s = clock_now_s(),
                     .options = {.thread_count = (uint32_t)common->threads,
                                 .cpu_mask = EWA_CPU_ALL,
                                 .backend = (ewa_backend_kind)arguments->backend,
                                 .width = view->size.width_px,
                                 .height = view->size.height_px,
                                 .scale = arguments->scale,
                                 .look = &look,
                                 .waits = arguments->script_path && !arguments->timings}};
    const bool made = window_services_make(&services, view, &arguments->look, &look, &job.options.services);
    const int exit_status = made ? front(&job) : EXIT_FAILED;
    window_services_free(&services);
    return exit_status;
}

/// Becomes the program that has windows. Returns only when it cannot.
static int start_window(const common_arguments *common) {
    cli_session session = {.quiet = false};
    return child_become(&session, "viewer/sdl", "ewa-view",
                        "view: the program ewa-view, which has the window, is not installed (it is "
                        "built where SDL2 and Dear ImGui are found); 'ewa render' draws without",
                        common);
}

static int run(const void *data) {
    const window_arguments *arguments = data;
    const bool headless = arguments->script_path && !arguments->window;
    return headless ? window_run(data, front_script_run) : start_window(&arguments->frames.view.common);
}

static const option_group window_options = OPTION_GROUP("Window", window_table);
const cli_command view_command = {
    .name = "view",
    .operands = "[IN...]",
    .summary = "show clouds, meshes and volumes in a window",
    .details =
        "Drag to turn about what is under the pointer, drag with the right button to move, turn the wheel to "
        "come nearer; click to pick a point, Shift-click a second one to measure; h shows all keys. Files "
        "can "
        "be dropped onto the window. While something moves, fewer and larger surfels are drawn, so that "
        "the picture keeps up; when all is still it is the one that 'ewa render' draws with the camera that "
        "Ctrl-C copies. No graphics card is needed.",
    .examples = "ewa view scan.ply\n"
                "ewa view scan.ply volume.nrrd --view iso\n"
                "ewa view survey.laz --color-by classification --color-bar\n"
                "ewa view scan.ply --script session.txt --timings\n",
    .high_operands = VIEWER_MAX_ITEMS,
    .groups = (const option_group *const[]){&window_options, &cloud_input_options, &view_options, LOOK_GROUPS, NULL},
    .arguments_bytes = sizeof(window_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
