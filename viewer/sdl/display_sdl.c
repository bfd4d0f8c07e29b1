// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The display that a window is on. SDL says little of why there is none.
#include "display_sdl.h"

#include <SDL_syswm.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char elsewhere[] = "draw without a window: ewa render";

/// Whether a driver has no window that anybody sees.
static bool is_unseen(const char *driver) {
    return driver && (strcmp(driver, "dummy") == 0 || strcmp(driver, "offscreen") == 0);
}

int display_refuse(const char *what, const SDL_Window *window) {
    const char *const why = *SDL_GetError() ? SDL_GetError() : "SDL does not say why";
    const char *const asked = SDL_getenv("SDL_VIDEODRIVER");
    const char *const x11 = SDL_getenv("DISPLAY"), *const wayland = SDL_getenv("WAYLAND_DISPLAY");
    fprintf(stderr, "ewa: view: no %s (%s): ", what, why);
    if (is_unseen(asked))
        fprintf(stderr, "nobody sees a window of SDL_VIDEODRIVER=%s: unset it, run a script (--script), or %s\n", asked,
                elsewhere);
    else if (window) // which SDL can do without a GPU wherever pixels are red, green and blue
        fprintf(stderr, "the display's pixels may have too few bits: start it with a depth of 24, or %s\n", elsewhere);
    else if (asked && *asked)
        fprintf(stderr, "SDL_VIDEODRIVER=%s cannot be used: unset it, so that one is found, or %s\n", asked, elsewhere);
    else if ((x11 && *x11) || (wayland && *wayland))
        fprintf(stderr, "%s=%s cannot be opened: is it there, and may you use it (ssh -X, xhost)? Or %s\n",
                x11 && *x11 ? "DISPLAY" : "WAYLAND_DISPLAY", x11 && *x11 ? x11 : wayland, elsewhere);
    else
        fprintf(stderr, "set DISPLAY or WAYLAND_DISPLAY (SDL_VIDEODRIVER chooses among several), or %s\n", elsewhere);
    return 1;
}

#ifdef SDL_VIDEO_DRIVER_X11
/// Xlib ends the program when this returns, and before that can do nothing any more; exit() would wait for threads that draw.
static int on_lost(Display *display) {
    static const char line[] =
        "ewa: view: the display has gone: start again when it is back, or draw without a window: ewa render\n";
    (void)display;
    (void)!write(STDERR_FILENO, line, sizeof line - 1);
    _exit(1);
}

/// Has what is said where the X server goes away be the program's own words.
static void watch(void) {
    XIOErrorHandler (*set_handler)(XIOErrorHandler) = NULL;
    void *library = SDL_LoadObject("libX11.so.6");
    void *found = library ? SDL_LoadFunction(library, "XSetIOErrorHandler") : NULL;
    if (found) memcpy(&set_handler, &found, sizeof found);
    if (set_handler) set_handler(on_lost);
    SDL_UnloadObject(library); // SDL holds it
}
#endif

bool display_start(bool scripted) {
    SDL_SetHint(SDL_HINT_VIDEO_ALLOW_SCREENSAVER, "1");
    SDL_SetHint(SDL_HINT_MOUSE_FOCUS_CLICKTHROUGH, "1");
    // Else SDL looks for OpenGL behind the renderer that is to do without it.
    SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
    const bool asked = SDL_GetHint(SDL_HINT_VIDEODRIVER) != NULL;
#ifdef __linux__
    // Wayland's library prints a line of its own when it is tried without.
    if (!asked && !SDL_getenv("XDG_RUNTIME_DIR")) SDL_SetHint(SDL_HINT_VIDEODRIVER, "x11");
#endif
    if (SDL_Init(SDL_INIT_VIDEO) != 0) return false;
    const char *driver = SDL_GetCurrentVideoDriver();
    if (is_unseen(driver) && !(asked && scripted)) {
        SDL_Quit();
        SDL_SetError(asked ? "it has no screen" : "no display can be opened");
        return false;
    }
#ifdef SDL_VIDEO_DRIVER_X11
    if (driver && strcmp(driver, "x11") == 0) watch();
#endif
    return true;
}

double display_find_zoom(void) {
    double zoom = 1;
#ifdef SDL_VIDEO_DRIVER_X11
    // SDL knows the size of the glass alone, not what was chosen.
    const char *driver = SDL_GetCurrentVideoDriver();
    void *library = driver && strcmp(driver, "x11") == 0 ? SDL_LoadObject("libX11.so.6") : NULL;
    Display *(*open_display)(const char *) = NULL;
    char *(*get_default)(Display *, const char *, const char *) = NULL;
    int (*close_display)(Display *) = NULL;
    if (library) {
        void *found[] = {SDL_LoadFunction(library, "XOpenDisplay"), SDL_LoadFunction(library, "XGetDefault"),
                         SDL_LoadFunction(library, "XCloseDisplay")};
        memcpy(&open_display, &found[0], sizeof found[0]);
        memcpy(&get_default, &found[1], sizeof found[1]);
        memcpy(&close_display, &found[2], sizeof found[2]);
    }
    Display *display = open_display && get_default && close_display ? open_display(NULL) : NULL;
    if (display) {
        // In quarters, as desktops have it.
        const char *text = get_default(display, "Xft", "dpi");
        const double wished = text ? nearbyint(SDL_strtod(text, NULL) / 96 * 4) / 4 : 1;
        if (wished >= 1 && wished <= 8) zoom = wished;
        close_display(display);
    }
    SDL_UnloadObject(library);
#endif
    return zoom;
}
