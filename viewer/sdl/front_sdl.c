// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The window: made, kept up to date, closed. It sleeps while nothing changes, and needs no GPU.
#include "display_sdl.h"
#include "events_sdl.h"
#include "panel.h"
#include "picture_sdl.h"
#include "preferences.h"
#include "viewer/front.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/// A second's worth of pictures, at the rate of the fastest screens.
enum { MAX_TIMES = 256 };

/// The longest sleep: something may have gone unnoticed. The shortest: how late a picture may be seen.
static const double longest_sleep_s = 10, shortest_sleep_s = 0.002;
/// Frames that the panels take until every size has settled after something has happened.
enum { SETTLING_FRAMES = 3 };
/// What borders of windows take at most, their titles among them.
enum { BORDER_POINTS = 64 };
/// What threads may take to give up when a person ends the program.
enum { LONGEST_END_MS = 100, END_STEP_MS = 5 };

typedef struct front_window {
    viewer *viewer;
    events_window events;
    picture_window picture;
    panel *panel;
    viewer_state state;
    recent_files recent;
    uint64_t opened_count; ///< of what `recent` has seen
    char preferences[PREFERENCES_BYTES]; ///< at the start
    char title[2 * VIEWER_NAME_BYTES];
    bool closed;
    bool scripted; ///< time is what the script says
    double scripted_s;
    double refresh_s;          ///< between two images of the screen
    double drawn_at_s;         ///< when the window was last drawn
    int unsettled;             ///< frames to draw though the picture is the same
    double times_s[MAX_TIMES]; ///< when the last pictures came, in a ring
    uint64_t times_count;
} front_window;

static double clock_s(const front_window *front) {
    if (front->scripted) return front->scripted_s;
    return (double)SDL_GetPerformanceCounter() / (double)SDL_GetPerformanceFrequency();
}

static void set_clipboard(void *user, const char *text) {
    (void)user;
    SDL_SetClipboardText(text);
}

static bool get_clipboard(void *user, char *text, size_t text_bytes) {
    (void)user;
    char *found = SDL_GetClipboardText();
    const bool fits = found && *found && strlen(found) < text_bytes;
    if (fits) memcpy(text, found, strlen(found) + 1);
    SDL_free(found);
    return fits;
}

static double find_refresh_s(SDL_Window *window) {
    SDL_DisplayMode mode;
    const int display = SDL_GetWindowDisplayIndex(window);
    if (display < 0 || SDL_GetCurrentDisplayMode(display, &mode) != 0 || mode.refresh_rate < 20)
        return 1.0 / 60;
    return 1.0 / mode.refresh_rate;
}

/// Tells the viewer how large the picture is.
static void measure(front_window *front) {
    viewer_event size;
    events_measure(&front->events, &size);
    size.time_s = clock_s(front);
    viewer_handle(front->viewer, &size);
}

/// Puts the picture beside what the panels take, and fills the screen or not.
static void arrange(front_window *front) {
    events_window *events = &front->events;
    viewer_get_state(front->viewer, &front->state);
    const bool fills = (SDL_GetWindowFlags(events->window) & SDL_WINDOW_FULLSCREEN_DESKTOP) != 0;
    if (fills != front->state.fullscreen)
        SDL_SetWindowFullscreen(events->window, front->state.fullscreen ? SDL_WINDOW_FULLSCREEN_DESKTOP : 0);
    int width_px, height_px;
    SDL_GetWindowSizeInPixels(events->window, &width_px, &height_px);
    panel_insets insets;
    panel_measure(&front->state, width_px, height_px, events->scale, &insets);
    if (insets.left_px == events->left_px && insets.top_px == events->top_px) return;
    events->left_px = insets.left_px;
    events->top_px = insets.top_px;
    front->unsettled = SETTLING_FRAMES;
    measure(front);
}

/// Has the window's title say what is open.
static void entitle(front_window *front) {
    const size_t count = viewer_item_count(front->viewer);
    viewer_item first;
    char title[sizeof front->title] = "ewa";
    if (viewer_item_get(front->viewer, 0, &first))
        snprintf(title, sizeof title, count > 1 ? "%s and %zu more - ewa" : "%s - ewa", first.name, count - 1);
    if (strcmp(title, front->title) == 0) return;
    memcpy(front->title, title, sizeof title);
    SDL_SetWindowTitle(front->events.window, title);
}

/// Gives on an event, to the panels first.
static void handle(front_window *front, const SDL_Event *event) {
    viewer_event translated;
    front->unsettled = SETTLING_FRAMES;
    if (event->type == SDL_QUIT) front->closed = true;
    if (event->type == SDL_RENDER_DEVICE_RESET || event->type == SDL_RENDER_TARGETS_RESET)
        front->picture.number = 0;
    const bool resized =
        event->type == SDL_WINDOWEVENT && (event->window.event == SDL_WINDOWEVENT_SIZE_CHANGED ||
                                           event->window.event == SDL_WINDOWEVENT_DISPLAY_CHANGED);
    if (resized) {
        front->refresh_s = find_refresh_s(front->events.window);
        measure(front);
    } else if (!(front->panel && panel_event(front->panel, front->viewer, event, clock_s(front))) &&
               events_translate(&front->events, event, clock_s(front), &translated)) {
        viewer_handle(front->viewer, &translated);
    }
    if (event->type == SDL_DROPFILE) SDL_free(event->drop.file);
}

/// Handles what has happened.
static void pump(front_window *front) {
    SDL_Event event;
    while (SDL_PollEvent(&event)) handle(front, &event);
}

/// Counts a new picture and returns how many come in a second, 0 when they do not follow each other.
static double count_frames(front_window *front, bool fresh) {
    const double now_s = clock_s(front);
    if (fresh) front->times_s[front->times_count++ % MAX_TIMES] = now_s;
    uint64_t recent = 0;
    double first_s = now_s;
    while (recent < MAX_TIMES && recent < front->times_count) {
        const double time_s = front->times_s[(front->times_count - 1 - recent) % MAX_TIMES];
        if (now_s - time_s > 1) break;
        first_s = time_s;
        recent++;
    }
    const double last_s = recent ? front->times_s[(front->times_count - 1) % MAX_TIMES] : now_s;
    return recent > 2 && last_s > first_s ? (double)(recent - 1) / (last_s - first_s) : 0;
}

/// Draws the window: the picture, and panels over it where there is something to say.
static void draw(front_window *front, const viewer_picture *picture) {
    const panel_facts facts = {.picture = *picture,
                               .frames_per_s = count_frames(front, picture->number != front->picture.number),
                               .scale = front->events.scale,
                               .now_s = clock_s(front),
                               .recent = front->scripted ? NULL : &front->recent};
    picture_window_draw(&front->picture, picture, front->events.scale, front->events.left_px, front->events.top_px);
    const bool wanted = !front->scripted || front->state.panels || front->state.help || front->state.question;
    if (wanted && !front->panel) front->panel = panel_create(front->events.window, front->picture.renderer);
    if (wanted && front->panel) panel_draw(front->panel, front->viewer, &facts);
    SDL_RenderPresent(front->picture.renderer);
    front->drawn_at_s = facts.now_s;
    if (front->unsettled) front->unsettled--;
}

/// Keeps what was opened for the next session.
static void note_opened(front_window *front) {
    uint64_t number;
    const char *path = viewer_opened(front->viewer, &number);
    if (number == front->opened_count) return;
    front->opened_count = number;
    recent_add(&front->recent, path);
}

/// Shows the window until it is closed.
static void live(front_window *front) {
    recent_read(&front->recent);
    while (!front->closed) {
        viewer_picture picture;
        pump(front);
        arrange(front);
        viewer_frame(front->viewer, clock_s(front), &picture);
        note_opened(front);
        entitle(front);
        viewer_get_state(front->viewer, &front->state);
        front->closed = front->closed || front->state.quit;
        const double since_s = clock_s(front) - front->drawn_at_s;
        const double panel_s = front->panel ? panel_spare_s(front->panel) : INFINITY;
        const bool changed =
            picture.number != front->picture.number || front->unsettled || since_s >= panel_s;
        if (changed && since_s >= front->refresh_s) {
            draw(front, &picture);
            continue;
        }
        double sleep_s = fmin(picture.spare_s, fmin(panel_s - since_s, longest_sleep_s));
        if (changed) sleep_s = front->refresh_s - since_s;
        SDL_WaitEventTimeout(NULL, (int)ceil(fmax(sleep_s, shortest_sleep_s) * 1000));
    }
}

/// What a script does is put into SDL's queue and taken out again at once, so that its time is kept.
static void script_event(void *user, const viewer_event *event) {
    front_window *front = user;
    front->scripted_s = event->time_s;
    events_push(&front->events, event);
    pump(front);
}

static bool script_step(void *user, double time_s, viewer_picture *picture) {
    front_window *front = user;
    front->scripted_s = time_s;
    pump(front);
    arrange(front);
    viewer_frame(front->viewer, time_s, picture);
    viewer_get_state(front->viewer, &front->state);
    draw(front, picture);
    return !front->closed && !front->state.quit;
}

/// Takes the window away and has everything given up. Where a thread is in the middle of something for longer, as of a
/// read from a network that does not come, the program ends without it: a person is not kept waiting.
static void end_soon(front_window *front, int exit_status) {
    SDL_HideWindow(front->events.window);
    for (int waited_ms = 0; !viewer_stop(front->viewer); waited_ms += END_STEP_MS) {
        if (waited_ms >= LONGEST_END_MS) {
            fflush(NULL);
            _exit(exit_status);
        }
        SDL_Delay(END_STEP_MS);
    }
}

/// Makes the viewer while the window comes up, so that files load meanwhile.
static bool open_viewer(front_window *front, const front_job *job) {
    viewer_event size;
    viewer_options options = job->options;
    events_measure(&front->events, &size);
    options.width = (uint32_t)lround(size.x);
    options.height = (uint32_t)lround(size.y);
    options.scale = size.amount;
    options.services.clipboard_set = set_clipboard;
    options.services.clipboard_get = get_clipboard;
    if (viewer_create(&options, &front->viewer) != EWA_OK) return false;
    if (front->scripted)
        viewer_do(front->viewer, "panels off");
    else
        preferences_read(front->viewer, front->preferences);
    arrange(front);
    for (size_t i = 0; i < job->path_count; i++) viewer_open(front->viewer, job->paths[i]);
    return true;
}

static int run(front_window *front, const front_job *job) {
    if (!open_viewer(front, job)) {
        fputs("ewa: out of memory\n", stderr);
        return 1;
    }
    if (!picture_window_open(front->events.window, &front->picture)) return display_refuse("renderer", front->events.window);
    front->refresh_s = find_refresh_s(front->events.window);
    if (front->scripted) {
        const script_host host = {.user = front, .event = script_event, .step = script_step};
        pump(front);
        return script_run(front->viewer, job, &host);
    }
    live(front);
    preferences_write(front->viewer, front->preferences);
    end_soon(front, 0);
    return 0;
}

int front_window_run(const front_job *job) {
    if (!display_start(job->script_path != NULL)) return display_refuse("display", NULL);
    front_window front = {.scripted = job->script_path != NULL};
    front.events.zoom = front.scripted ? job->options.scale : display_find_zoom();
    int width = (int)lround(job->options.width * front.events.zoom);
    int height = (int)lround(job->options.height * front.events.zoom);
    uint32_t flags = SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI;
    SDL_Rect screen;
    if (!front.scripted && SDL_GetDisplayUsableBounds(0, &screen) == 0) {
        // The desktop alone knows what its borders take of a screen that is filled.
        const int border = (int)lround(BORDER_POINTS * front.events.zoom);
        if (width + border > screen.w || height + border > screen.h) flags |= SDL_WINDOW_MAXIMIZED;
        width = SDL_min(width, screen.w);
        height = SDL_min(height, screen.h);
    }
    front.events.window =
        SDL_CreateWindow("ewa", SDL_WINDOWPOS_UNDEFINED, SDL_WINDOWPOS_UNDEFINED, width, height, flags);
    int exit_status = front.events.window ? run(&front, job) : display_refuse("window", NULL);
    viewer_destroy(&front.viewer);
    panel_destroy(&front.panel);
    picture_window_close(&front.picture);
    if (front.events.window) SDL_DestroyWindow(front.events.window);
    SDL_Quit();
    return exit_status;
}
