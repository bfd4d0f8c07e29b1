// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scripts: lines of events with their times, commands and checks (docs/viewer.md).
#include "front.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { LINE_BYTES = 8192, WORD_BYTES = 4096, MAX_FRAMES = 1 << 20 };

/// A script that runs.
typedef struct script {
    viewer *viewer;
    const front_job *job;
    const script_host *host;
    const char *name;
    int line;
    double time_s, began_s; ///< the script's clock, and when it began by the machine's
    viewer_picture picture;
    bool closed;
    double *intervals_s; ///< between pictures shown while something moved
    size_t interval_count;
    double first_s;            ///< from the program's start to the first picture of something
    double shown_s;            ///< when the last picture came; negative: none yet
    double settled_s, event_s; ///< longest way from the last event to the whole picture; when that was
    bool settling;
    bool moved; ///< something, since the last picture came
} script;

static double now_s(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static bool fail(const script *s, const char *what, const char *detail) {
    fprintf(stderr, "ewa: %s:%d: %s%s%s\n", s->name, s->line, what, detail ? ": " : "", detail ? detail : "");
    return false;
}

/// Notes what a step showed.
static void take_times(script *s, uint64_t number_before) {
    viewer_state state;
    viewer_get_state(s->viewer, &state);
    s->moved = s->moved || state.moving;
    if (!s->job->timings || s->picture.number == number_before) return;
    if (s->picture.splat_count && !(s->first_s > 0)) s->first_s = now_s() - s->job->started_s;
    const double at_s = now_s() - s->began_s;
    // Pictures that get finer after the end of a movement are no frames of it; the first of them has the wait that a hand may feel.
    if (s->shown_s >= 0 && s->interval_count < MAX_FRAMES && s->settling && s->moved && !s->picture.still)
        s->intervals_s[s->interval_count++] = at_s - s->shown_s;
    s->shown_s = at_s;
    s->moved = state.moving;
    if (s->picture.still && s->settling) {
        s->settling = false;
        s->settled_s = fmax(s->settled_s, at_s - s->event_s);
    }
}

/// One frame at the script's time.
static bool step(script *s) {
    const uint64_t before = s->picture.number;
    if (!s->host->step(s->host->user, s->time_s, &s->picture)) s->closed = true;
    take_times(s, before);
    return !s->closed;
}

/// Waits for a moment.
static void rest(void) { nanosleep(&(struct timespec){.tv_nsec = 500000}, NULL); }

/// Goes on to a time: at once, or as time passes when that is what is measured.
static bool reach(script *s, double time_s) {
    if (time_s < s->time_s) return fail(s, "time runs backwards", NULL);
    while (s->job->timings && now_s() - s->began_s < time_s) {
        s->time_s = now_s() - s->began_s;
        const uint64_t before = s->picture.number;
        if (!step(s)) return false;
        if (s->picture.number == before) rest(); // what draws needs the processors
    }
    s->time_s = time_s;
    return true;
}

/// Draws until nothing moves any more; time goes on in steps of a hundredth of a second.
static bool settle(script *s) {
    viewer_state state;
    viewer_get_state(s->viewer, &state);
    if (state.flying) return fail(s, "nothing comes to rest while a key is held by which the camera flies: keyup", NULL);
    for (int i = 0; i < 100000; i++) {
        if (s->job->timings) s->time_s = fmax(s->time_s, now_s() - s->began_s);
        if (!step(s)) return false;
        if (s->picture.still && viewer_is_still(s->viewer)) return true;
        if (s->job->timings || !s->job->options.waits) nanosleep(&(struct timespec){.tv_nsec = 200000}, NULL);
        if (!s->job->timings) s->time_s += 0.01;
    }
    return fail(s, "the picture does not come to rest", NULL);
}

static uint32_t read_modifiers(const char *text) {
    uint32_t bits = 0;
    if (strstr(text, "shift")) bits |= VIEWER_SHIFT;
    if (strstr(text, "ctrl")) bits |= VIEWER_CTRL;
    if (strstr(text, "alt")) bits |= VIEWER_ALT;
    return bits;
}

static int read_button(const char *text) {
    return strstr(text, "right") ? VIEWER_RIGHT : strstr(text, "middle") ? VIEWER_MIDDLE : VIEWER_LEFT;
}

/// A key by its character or name; 0: there is none.
static int read_key(const char *word) {
    static const struct {
        const char *name;
        int key;
    } names[] = {{"enter", VIEWER_KEY_ENTER},   {"escape", VIEWER_KEY_ESCAPE},
                 {"delete", VIEWER_KEY_DELETE}, {"tab", '\t'},
                 {"left", VIEWER_KEY_LEFT},     {"right", VIEWER_KEY_RIGHT},
                 {"up", VIEWER_KEY_UP},         {"down", VIEWER_KEY_DOWN}};
    int number;
    if (word[0] && !word[1]) return tolower((unsigned char)word[0]);
    if (word[0] == 'f' && sscanf(word, "f%d", &number) == 1 && number >= 1 && number <= 12)
        return VIEWER_KEY_F1 + number - 1;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (strcmp(word, names[i].name) == 0) return names[i].key;
    return 0;
}

/// Times go from here, where everything was still before.
static void begin_motion(script *s) {
    static const double PAUSE_S = 0.1;
    const double before_s = s->event_s;
    s->event_s = now_s() - s->began_s;
    if (!s->settling || s->event_s - before_s > PAUSE_S) s->shown_s = s->event_s;
    s->settling = true;
}

static void send(script *s, viewer_event event) {
    event.time_s = s->time_s;
    begin_motion(s);
    s->host->event(s->host->user, &event);
}

/// Lets an event of the script happen; false: the word is none.
static bool do_event(script *s, const char *word, const char *rest, bool *fine) {
    viewer_event event = {.clicks = 1, .modifiers = read_modifiers(rest), .button = read_button(rest)};
    char name[WORD_BYTES];
    int wanted = 2;
    int got = sscanf(rest, "%lf %lf %lf", &event.x, &event.y, &event.amount);
    if (strcmp(word, "move") == 0) {
        event.kind = VIEWER_MOVE;
    } else if (strcmp(word, "press") == 0 || strcmp(word, "release") == 0) {
        event.kind = word[0] == 'p' ? VIEWER_PRESS : VIEWER_RELEASE;
        if (strstr(rest, "double")) event.clicks = 2;
    } else if (strcmp(word, "wheel") == 0 || strcmp(word, "pinch") == 0) {
        event.kind = word[0] == 'w' ? VIEWER_WHEEL : VIEWER_PINCH;
        wanted = 3;
    } else if (strcmp(word, "resize") == 0) {
        event.kind = VIEWER_RESIZE;
        if (got == 2) event.amount = 1;
    } else if (strcmp(word, "key") == 0 || strcmp(word, "keyup") == 0) {
        event.kind = word[3] ? VIEWER_KEY_RELEASE : VIEWER_KEY;
        event.modifiers = 0;
        if (sscanf(rest, "%4095s", name) == 1) {
            event.key = read_key(name);
            event.modifiers = read_modifiers(rest + strlen(name));
        }
        got = event.key ? 2 : 0;
    } else if (strcmp(word, "drop") == 0) {
        event.kind = VIEWER_DROP;
        event.text = rest;
        got = rest[0] ? 2 : 0;
    } else if (strcmp(word, "leave") == 0) {
        event.kind = VIEWER_LEAVE;
        got = 2;
    } else {
        return false;
    }
    *fine = got >= wanted || fail(s, "not enough of what belongs to", word);
    if (*fine) send(s, event);
    return true;
}

/// FNV-1a over size and pixels.
static uint64_t hash_picture(const viewer_picture *picture) {
    uint64_t hash = 0xcbf29ce484222325u;
    const size_t count = 4 * (size_t)picture->width_px * picture->height_px;
    const uint32_t size[2] = {picture->width_px, picture->height_px};
    for (int i = 0; i < 8; i++) hash = (hash ^ (size[i / 4] >> 8 * (i % 4) & 255)) * 0x100000001b3u;
    for (size_t i = 0; i < count; i++) hash = (hash ^ picture->rgba8[i]) * 0x100000001b3u;
    return hash;
}

static bool save_shown(script *s, const char *path) {
    ewa_context *context = NULL;
    ewa_status status = ewa_context_create(NULL, &context);
    if (status == EWA_OK)
        status = ewa_png_save(context, path, s->picture.width_px, s->picture.height_px, 4, s->picture.rgba8,
                              4 * (size_t)s->picture.width_px);
    ewa_context_destroy(&context);
    return status == EWA_OK || fail(s, "the picture cannot be saved", path);
}

/// Compares the picture with a file, pixel by pixel.
static bool expect_same(script *s, const char *path) {
    ewa_context *context = NULL;
    ewa_image image = {.context = NULL};
    ewa_status status = ewa_context_create(NULL, &context);
    if (status == EWA_OK) status = ewa_image_load(context, path, &image);
    if (status != EWA_OK) fail(s, "the picture cannot be loaded", path);
    bool same =
        status == EWA_OK && image.width_px == s->picture.width_px && image.height_px == s->picture.height_px;
    size_t off = 0;
    for (size_t i = 0; same && i < (size_t)image.width_px * image.height_px; i++) {
        const uint8_t *shown = &s->picture.rgba8[4 * i];
        const float alpha = shown[3] / 255.0f, *other = &image.pixels[i * image.channel_count];
        bool fits = image.channel_count < 4 ? shown[3] == 255 : fabsf(other[3] - alpha) < 1e-3f;
        for (uint32_t c = 0; c < 3; c++) {
            const float own = ewa_linear_from_srgb(shown[c] / 255.0f) * alpha;
            fits = fits && fabsf(own - other[image.channel_count < 3 ? 0 : c]) < 1e-4f;
        }
        off += !fits;
    }
    char detail[128];
    snprintf(detail, sizeof detail, "%zu pixels differ", off);
    if (status == EWA_OK && !same) fail(s, "the picture has another size than", path);
    if (off) fail(s, path, detail);
    ewa_image_free(&image);
    ewa_context_destroy(&context);
    return same && !off;
}

/// Compares what was said last; a star at the end stands for anything.
static bool expect_text(script *s, const char *kind, const char *said, const char *wanted) {
    const size_t length = strlen(wanted);
    const bool open = length && wanted[length - 1] == '*';
    const bool same = open ? strncmp(said, wanted, length - 1) == 0 : strcmp(said, wanted) == 0;
    if (!same) fprintf(stderr, "ewa: %s:%d: %s is '%s', not '%s'\n", s->name, s->line, kind, said, wanted);
    return same;
}

static bool expect_hash(script *s, const char *rest) {
    char text[32];
    snprintf(text, sizeof text, "%016llx", (unsigned long long)hash_picture(&s->picture));
    return strcmp(text, rest) == 0 || fail(s, "the picture's hash is", text);
}

/// Does what a line says after its time.
static bool do_line(script *s, const char *word, const char *rest) {
    bool fine = true;
    viewer_state state;
    if (do_event(s, word, rest, &fine)) return fine;
    if (strcmp(word, "do") == 0) {
        begin_motion(s);
        return viewer_do(s->viewer, rest) || fail(s, "refused", rest);
    }
    if (strcmp(word, "refuse") == 0) return !viewer_do(s->viewer, rest) || fail(s, "not refused", rest);
    if (strcmp(word, "frame") == 0) return step(s);
    if (strcmp(word, "settle") == 0) return settle(s);
    if (strcmp(word, "shot") == 0) return settle(s) && save_shown(s, rest);
    if (strcmp(word, "expect-same") == 0) return settle(s) && expect_same(s, rest);
    if (strcmp(word, "expect-hash") == 0) return settle(s) && expect_hash(s, rest);
    if (strcmp(word, "expect-said") == 0)
        return expect_text(s, "what was said", viewer_said(s->viewer), rest);
    if (strcmp(word, "expect-message") == 0) {
        viewer_get_state(s->viewer, &state);
        return expect_text(s, "the message", state.message, rest);
    }
    if (strcmp(word, "wait") == 0) return reach(s, s->time_s + strtod(rest, NULL));
    return fail(s, "there is no such word", word);
}

static bool run_line(script *s, char *line) {
    line[strcspn(line, "\r\n")] = 0;
    while (*line == ' ') line++;
    if (!*line || *line == '#') return true;
    char *end;
    const double time_s = strtod(line, &end);
    if (end != line && *end == ' ') {
        if (!isfinite(time_s) || !reach(s, time_s)) return false;
        line = end;
        while (*line == ' ') line++;
    }
    char word[32];
    const size_t length = strcspn(line, " ");
    if (length >= sizeof word) return fail(s, "there is no such word", line);
    memcpy(word, line, length);
    word[length] = 0;
    line += length;
    while (*line == ' ') line++;
    return do_line(s, word, line);
}

static int compare_times(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void print_times(script *s) {
    const size_t n = s->interval_count;
    qsort(s->intervals_s, n, sizeof *s->intervals_s, compare_times);
    double sum_s = 0;
    for (size_t i = 0; i < n; i++) sum_s += s->intervals_s[i];
    if (n)
        printf("timings %zu frames, mean %.1f ms, median %.1f ms, 95 %% %.1f ms, largest %.1f ms, %.1f "
               "frames/s\n",
               n, 1e3 * sum_s / (double)n, 1e3 * s->intervals_s[n / 2], 1e3 * s->intervals_s[n * 95 / 100],
               1e3 * s->intervals_s[n - 1], (double)n / sum_s);
    printf("timings first picture %.3f s after the start\n", s->first_s);
    printf("timings whole picture at most %.3f s after the last event\n", s->settled_s);
}

int script_run(viewer *v, const front_job *job, const script_host *host) {
    script s = {.viewer = v, .job = job, .host = host, .name = job->script_path, .shown_s = -1};
    const bool from_input = strcmp(job->script_path, "-") == 0;
    FILE *file = from_input ? stdin : fopen(job->script_path, "r");
    if (!file) {
        fprintf(stderr, "ewa: %s: cannot be opened\n", job->script_path);
        return 1;
    }
    s.intervals_s = calloc(job->timings ? MAX_FRAMES : 1, sizeof *s.intervals_s);
    char line[LINE_BYTES];
    s.began_s = now_s();
    bool fine = s.intervals_s != NULL;
    while (fine && !s.closed && fgets(line, sizeof line, file)) {
        s.line++;
        fine = run_line(&s, line);
    }
    if (fine && job->timings && !s.closed) settle(&s);
    if (fine && job->timings) print_times(&s);
    free(s.intervals_s);
    if (!from_input) fclose(file);
    return fine ? 0 : 1;
}

// Without a window, events reach the viewer as they are.
static void pass_event(void *user, const viewer_event *event) { viewer_handle(user, event); }

static bool pass_step(void *user, double time_s, viewer_picture *picture) {
    viewer_frame(user, time_s, picture);
    viewer_state state;
    viewer_get_state(user, &state);
    return !state.quit;
}

int front_script_run(const front_job *job) {
    viewer *v = NULL;
    const ewa_status status = viewer_create(&job->options, &v);
    if (status != EWA_OK) {
        fprintf(stderr, "ewa: the viewer cannot be made: %s\n", ewa_status_name(status));
        return 1;
    }
    for (size_t i = 0; i < job->path_count; i++) viewer_open(v, job->paths[i]);
    const int exit_status = script_run(v, job, &(script_host){v, pass_event, pass_step});
    viewer_destroy(&v);
    return exit_status;
}
