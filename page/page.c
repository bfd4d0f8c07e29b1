// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The viewer (viewer/viewer.h) as a module of WebAssembly: a page hands over events and commands with their times, and pictures
// come out, drawn by as many threads as the page gives (page/threads.h). Files are those that the page has (page/files.js): what is shown is read where it lies, part by part,
// texts and pictures go by WASI. A page makes an instance of the module for each view.
#include "threads.h"
#include "viewer/viewer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXPORT(name) __attribute__((export_name(#name))) name
#define IMPORT(name) __attribute__((import_module("ewa"), import_name(#name))) page_##name

/// The page is told a message (`message`) or a line of results, such as a pick.
void IMPORT(say)(bool message, const char *text);
/// The page is told the share of a stage of loading that is done.
void IMPORT(progress)(const char *stage, double fraction);
/// The page is asked whether an event waits.
bool IMPORT(waiting)(void);

/// The page opens a file that it has; returns its number and sets its size, or -1 where there is none of that name.
int IMPORT(open_file)(const char *path, double *size_bytes);
/// The page copies bytes of it to memory; returns how many, 0 for none more, or -1.
int IMPORT(read_file)(int file, double at_bytes, void *bytes, uint32_t size_bytes);
void IMPORT(close_file)(int file);

/// What a page may hold: phones give a tab no more.
static const uint64_t MEMORY_BYTES = (uint64_t)2 << 30;
/// Of octrees: malloc of this C library takes powers of two, up to twice as much.
static const uint64_t NODE_BYTES = (uint64_t)1 << 29;

enum { TEXT_BYTES = 4 * VIEWER_TEXT_BYTES };

/// What a page is told of a picture, in the order of page/module.js; the address is 0 where there is no picture yet.
typedef struct page_report {
    double rgba8, width_px, height_px; ///< 4 bytes a pixel, rows from the top, sRGB, straight alpha
    double number;                     ///< another one for another picture
    double still, loading;             ///< 1: nothing will change by itself; something is not there yet
    double spare_s, drawn_s;           ///< when to ask again; what drawing took
    double level, splat_count;
} page_report;

typedef struct page {
    viewer *viewer;
    ewa_context *context; ///< of what is loaded
    page_threads threads; ///< that draw
    viewer_news news;
    page_report report;
    double place_world[3];
    viewer_item item;
    char text[TEXT_BYTES]; ///< what goes in and out
} page;

/// Makes a viewer of a picture of so many CSS pixels, each of which is `scale` pixels, drawn by `thread_count` threads, this one
/// among them; NULL where there is no memory, or where the host's multiply-add rounds twice and the exact module is to be loaded.
page *EXPORT(page_create)(uint32_t width, uint32_t height, double scale, uint32_t thread_count);

/// Returns the threads of a viewer, which page_thread_work() takes.
page_threads *EXPORT(page_get_threads)(page *p);

/// Returns the room, page_text_bytes() large, for the text of a call, ended by 0, and for what some calls answer.
char *EXPORT(page_text)(page *p);
uint32_t EXPORT(page_text_bytes)(void);

/// Opens the file that the text names; it is loaded by the next frames.
bool EXPORT(page_open)(page *p);

/// Does what the text says in the language of docs/viewer.md.
bool EXPORT(page_do)(page *p);

/// Takes an event, as viewer_event has it, but drops: files are opened by page_open().
void EXPORT(page_event)(page *p, int kind, double time_s, double x, double y, int button, int clicks, uint32_t modifiers, int key,
                        double amount);

/// Advances to a time; the report is valid until the next call.
const page_report *EXPORT(page_frame)(page *p, double time_s);

/// Returns the place of a pick (0) or of the second one of a measure (1), three numbers; NULL: there is none.
const double *EXPORT(page_pick)(page *p, int index);

/// The text becomes what the viewer says of the last pick, line by line.
void EXPORT(page_picked)(page *p);

/// The text becomes lines about what is open, or empty: name, kind, count, attribute of its colours, first and last number of
/// these, and, for each class, number, colour and name; then the names of all attributes. False: there is no such thing.
bool EXPORT(page_item)(page *p, uint32_t index);

/// The text becomes the keys and what they do, of a row of the help; false: there is no such row.
bool EXPORT(page_help)(page *p, uint32_t row);

static void hear_message(void *user, ewa_severity severity, const char *text) {
    page *p = user;
    if (p->news.message) p->news.message(p->news.user, severity, text);
}

static bool hear_progress(void *user, const char *stage, double fraction) {
    page *p = user;
    page_progress(stage, fraction);
    return !p->news.progress || p->news.progress(p->news.user, stage, fraction);
}

static int64_t read_file(void *user, uint64_t at_bytes, void *bytes, size_t size_bytes) {
    return page_read_file((int)(intptr_t)user, (double)at_bytes, bytes, (uint32_t)size_bytes);
}

static void close_file(void *user) { page_close_file((int)(intptr_t)user); }

static bool open_file(void *user, const char *path, ewa_file_source *file) {
    (void)user;
    double size_bytes = 0;
    const int number = page_open_file(path, &size_bytes);
    if (number < 0) return false;
    *file = (ewa_file_source){.size_bytes = (uint64_t)size_bytes, .read_at = read_file, .close = close_file, .user = (void *)(intptr_t)number};
    return true;
}

static ewa_context *context(void *user, const viewer_news *news) {
    page *p = user;
    p->news = *news;
    if (p->context) return p->context;
    ewa_context_options options;
    ewa_context_options_init(&options, sizeof options);
    options.message = hear_message;
    options.progress = hear_progress;
    options.message_user = options.progress_user = p;
    options.message_level = EWA_SEVERITY_WARNING;
    options.open_file = open_file;
    options.limits.max_memory_bytes = MEMORY_BYTES;
    return ewa_context_create(&options, &p->context) == EWA_OK ? p->context : NULL;
}

static bool load(void *user, const char *path, const ewa_asset_options *said, const viewer_news *news, ewa_asset **asset) {
    page *p = user;
    (void)news; // the context tells it
    ewa_asset_options options = *said;
    options.gaussian_levels = true;
    if (options.voxel_level_count < VIEWER_VOXEL_LEVELS) options.voxel_level_count = VIEWER_VOXEL_LEVELS;
    return ewa_asset_load(p->context, path, &options, asset) == EWA_OK;
}

static bool place(void *user, ewa_scene *scene, const char *view, bool color_bar, ewa_camera *camera, double up_world[3]) {
    (void)user;
    ewa_view_options options;
    ewa_view_info info;
    ewa_view_options_init(&options, sizeof options);
    options.width_px = camera->width_px;
    options.height_px = camera->height_px;
    options.color_bar = color_bar;
    if (view) options.view = viewer_view_find(view);
    if (ewa_scene_place_camera(scene, &options, camera, &info) != EWA_OK) return false;
    memcpy(up_world, info.up_world, sizeof info.up_world);
    return true;
}

static void say(void *user, bool message, const char *text) {
    (void)user;
    page_say(message, text);
}

static bool waiting(void *user) {
    (void)user;
    return page_waiting();
}

static void *allocate(void *user, size_t size_bytes) {
    (void)user;
    return size_bytes > SIZE_MAX - 63 ? NULL : aligned_alloc(64, (size_bytes + 63) / 64 * 64);
}

static void release(void *user, void *memory, size_t size_bytes) {
    (void)user, (void)size_bytes;
    free(memory);
}

page *page_create(uint32_t width, uint32_t height, double scale, uint32_t thread_count) {
    page *made = calloc(1, sizeof *made);
    if (!made) return NULL;
    page_threads_init(&made->threads);
    viewer_look look;
    viewer_look_init(&look);
    look.scene.lod.memory_bytes = NODE_BYTES;
    const viewer_options options = {
        .services = {.user = made, .context = context, .load = load, .place = place, .say = say, .waiting = waiting},
        .thread_count = 1,
        .executor = {.user = &made->threads, .worker_count = thread_count, .run = thread_count > 1 ? page_threads_run : NULL},
        // The library asks a caller's allocator on the calling thread only, and malloc of this C library has no lock.
        .allocator = {.allocate = allocate, .release = release},
        .cpu_mask = EWA_CPU_ALL,
        .width = width,
        .height = height,
        .scale = scale,
        .look = &look,
        .stepped = true};
    if (viewer_create(&options, &made->viewer) == EWA_OK) return made;
    free(made);
    return NULL;
}

page_threads *page_get_threads(page *p) { return &p->threads; }

char *page_text(page *p) { return p->text; }

uint32_t page_text_bytes(void) { return TEXT_BYTES; }

bool page_open(page *p) { return viewer_open(p->viewer, p->text); }

bool page_do(page *p) { return viewer_do(p->viewer, p->text); }

void page_event(page *p, int kind, double time_s, double x, double y, int button, int clicks, uint32_t modifiers, int key,
                double amount) {
    const viewer_event event = {.kind = (viewer_event_kind)kind,
                                .time_s = time_s,
                                .x = x,
                                .y = y,
                                .button = button,
                                .clicks = clicks,
                                .modifiers = modifiers,
                                .key = key,
                                .amount = amount};
    viewer_handle(p->viewer, &event);
}

const page_report *page_frame(page *p, double time_s) {
    viewer_picture picture;
    viewer_frame(p->viewer, time_s, &picture);
    p->report = (page_report){.rgba8 = (double)(uintptr_t)picture.rgba8,
                              .width_px = picture.width_px,
                              .height_px = picture.height_px,
                              .number = (double)picture.number,
                              .still = viewer_is_still(p->viewer),
                              .loading = viewer_is_loading(p->viewer),
                              .spare_s = picture.spare_s,
                              .drawn_s = picture.drawn_s,
                              .level = picture.level,
                              .splat_count = (double)picture.splat_count};
    return &p->report;
}

const double *page_pick(page *p, int index) {
    return viewer_get_pick(p->viewer, index, p->place_world) ? p->place_world : NULL;
}

void page_picked(page *p) {
    viewer_state state;
    viewer_get_state(p->viewer, &state);
    snprintf(p->text, sizeof p->text, "%s", state.picked);
}

static const char *kind_of(const viewer_item *item) {
    return item->volume ? "voxels" : item->gaussians ? "Gaussians" : item->mesh ? "points on a mesh" : "points";
}

bool page_item(page *p, uint32_t index) {
    viewer_item *item = &p->item;
    if (!viewer_item_get(p->viewer, index, item)) return false;
    const viewer_coloring *coloring = &item->coloring;
    int used = snprintf(p->text, sizeof p->text, "name\t%s\nkind\t%s\ncount\t%llu\n", item->name, kind_of(item),
                        (unsigned long long)item->count);
    if (coloring->attribute[0] && used < TEXT_BYTES)
        used += snprintf(p->text + used, TEXT_BYTES - (size_t)used, "color\t%s\nrange\t%.9g\t%.9g\n", coloring->attribute,
                         coloring->range[0], coloring->range[1]);
    for (uint32_t k = 0; k < coloring->class_count && used < TEXT_BYTES; k++) {
        const viewer_class *c = &coloring->classes[k];
        used += snprintf(p->text + used, TEXT_BYTES - (size_t)used, "class\t%.9g\t%d\t%d\t%d\t%s\n", c->value, c->srgb[0],
                         c->srgb[1], c->srgb[2], c->name);
    }
    char name[EWA_NAME_BYTES + 4];
    for (uint32_t k = 0; viewer_attribute_at(p->viewer, index, k, name) && used < TEXT_BYTES; k++)
        used += snprintf(p->text + used, TEXT_BYTES - (size_t)used, "attribute\t%s\n", name);
    return true;
}

bool page_help(page *p, uint32_t row) {
    viewer_help help;
    const bool found = viewer_help_at(NULL, row, &help);
    if (found) snprintf(p->text, sizeof p->text, "%s\t%s", help.keys, help.what);
    return found;
}
