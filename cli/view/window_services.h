// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the viewer asks of the program: files loaded, coloured and framed as every command does it.
#ifndef EWA_CLI_VIEW_WINDOW_SERVICES_H
#define EWA_CLI_VIEW_WINDOW_SERVICES_H

#include "cli/render/look.h"
#include "cli/render/video.h"
#include "cli/render/view.h"
#include "viewer/viewer.h"

/// What the services work with; it stays as long as the viewer.
typedef struct window_services {
    const view_arguments *view; ///< the camera's options
    const look_arguments *look;
    light_objects lit_by;
    uint32_t thread_count;
    cli_session session;       ///< of the thread that places cameras
    cli_session loading;       ///< of the thread that loads and makes scenes
    session_listener listener; ///< of its news
    const char *film_path;     ///< as it was asked for, borrowed; of numbered pictures:
    uint32_t film_width_px, film_height_px, film_count;
    bool film_opaque;
    cli_video video; ///< else
} window_services;

/// Makes the services, and how things are shown at first; free the services after the viewer, also when this returns false, after
/// reporting. The arguments stay as long.
bool window_services_make(window_services *own, const view_arguments *view, const look_arguments *arguments, viewer_look *look,
                          viewer_services *services);
void window_services_free(window_services *own);

#endif
