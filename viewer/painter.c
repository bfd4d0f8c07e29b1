// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The thread that draws; without one, the same in the caller's.
#include "painter.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct painter {
    viewer_services services;
    paint_tools tools;
    pthread_t thread;
    bool stepped, started;
    pthread_mutex_t lock;
    pthread_cond_t changed; ///< something was posted, or became idle
    atomic_bool give_up;
    // Under the lock:
    bool quits, waits, draws;
    bool whole; ///< of what is drawn
    bool next_whole;
    uint64_t next_ticket;
    paint_scene next, now; ///< `now` is the thread's own while it draws
    paint_result results[3];
    uint64_t drawn_count;
    int drawing, newest, shown; ///< indices of `results`; newest -1: none yet
    ewa_status failure;
    char failure_text[PAINT_TEXT_BYTES], told[PAINT_TEXT_BYTES]; ///< `told` is the caller's
};

static bool on_progress(void *user, const char *stage, double fraction) {
    (void)stage, (void)fraction;
    painter *p = user;
    if (p->stepped && p->whole && p->services.waiting && p->services.waiting(p->services.user)) return false;
    return !atomic_load_explicit(&p->give_up, memory_order_relaxed);
}

static void on_message(void *user, ewa_severity severity, const char *text) {
    (void)severity;
    paint_tools *tools = user;
    snprintf(tools->message, sizeof tools->message, "%s", text);
}

ewa_status paint_tools_make(const viewer_options *wanted, ewa_backend_kind backend, ewa_progress_callback *progress, void *user,
                            paint_tools *tools) {
    *tools = (paint_tools){.context = NULL};
    ewa_context_options options;
    ewa_context_options_init(&options, sizeof options);
    options.thread_count = wanted->thread_count;
    options.executor = wanted->executor;
    if (wanted->allocator.allocate) options.allocator = wanted->allocator;
    options.cpu_mask = wanted->cpu_mask;
    options.progress = progress;
    options.progress_user = user;
    options.message = on_message;
    options.message_user = tools;
    options.message_level = EWA_SEVERITY_ERROR;
    ewa_status status = ewa_context_create(&options, &tools->context);
    if (status == EWA_OK)
        status = ewa_scene_renderer_create(tools->context, backend, NULL, &tools->renderer);
    if (status != EWA_OK) paint_tools_free(tools);
    return status;
}

void paint_tools_free(paint_tools *tools) {
    ewa_scene_renderer_destroy(&tools->renderer);
    ewa_context_destroy(&tools->context);
    *tools = (paint_tools){.context = NULL};
}

ewa_status paint_scene_draw(paint_tools *tools, const paint_scene *scene, const ewa_frame *frame, paint_stats *stats) {
    ewa_scene_stats took = {.total_s = 0};
    const bool reads = scene->octrees && !scene->options.lod.resident_only;
    if (reads) turns_take(&scene->turns->files);
    if (scene->octrees) turns_take(&scene->turns->nodes);
    const ewa_status status =
        ewa_scene_draw(scene->scene, tools->renderer, &scene->camera, &scene->options, frame, &took);
    if (scene->octrees) turns_give(&scene->turns->nodes);
    if (reads) turns_give(&scene->turns->files);
    if (stats) *stats = (paint_stats){took.render, took.lod.missing_count, took.lod.loaded_count};
    return status;
}

/// Draws what `now` says into the result that is neither shown nor the newest. Without the lock.
static ewa_status draw_now(painter *p, paint_result *result) {
    const ewa_camera *camera = &p->now.camera;
    const size_t wanted = 4 * (size_t)camera->width_px * camera->height_px;
    if (wanted > result->capacity_bytes) {
        free(result->rgba8);
        result->rgba8 = malloc(wanted);
        result->capacity_bytes = result->rgba8 ? wanted : 0;
        if (!result->rgba8) return EWA_ERROR_MEMORY;
    }
    paint_stats stats = {.missing_count = 0};
    const ewa_status status = paint_scene_draw(&p->tools, &p->now, &(ewa_frame){.rgba8 = result->rgba8}, &stats);
    result->width_px = camera->width_px;
    result->height_px = camera->height_px;
    result->level = stats.render.level;
    result->splat_count = stats.render.splat_count;
    result->drawn_s = stats.render.total_s;
    result->arrived_count = p->now.arrived_count;
    result->lacks_nodes = stats.missing_count > 0;
    result->to_refine = stats.missing_count && stats.loaded_count;
    return status;
}

/// Draws the scene that waits. With the lock, but for the drawing.
static void draw_next(painter *p) {
    p->now = p->next;
    p->whole = p->next_whole;
    const uint64_t ticket = p->next_ticket;
    p->waits = false;
    p->draws = true;
    atomic_store(&p->give_up, false);
    p->drawing = 0;
    while (p->drawing == p->newest || p->drawing == p->shown) p->drawing++;
    paint_result *result = &p->results[p->drawing];
    pthread_mutex_unlock(&p->lock);
    const ewa_status status = draw_now(p, result);
    pthread_mutex_lock(&p->lock);
    p->draws = false;
    if (status == EWA_OK) {
        result->ticket = ticket;
        result->drawn_count = ++p->drawn_count;
        const bool full = !p->now.reduced && !result->level && !p->now.options.volumes.level && !p->now.coarse;
        result->whole = (p->whole || full) && !result->to_refine;
        result->camera = p->now.camera;
        p->newest = p->drawing;
    }
    if (status != EWA_CANCELLED) p->failure = status;
    if (p->failure != EWA_OK) memcpy(p->failure_text, p->tools.message, sizeof p->failure_text);
    pthread_cond_broadcast(&p->changed);
}

static void *run(void *data) {
    painter *p = data;
    pthread_mutex_lock(&p->lock);
    while (!p->quits) {
        if (p->waits)
            draw_next(p);
        else
            pthread_cond_wait(&p->changed, &p->lock);
    }
    pthread_mutex_unlock(&p->lock);
    return NULL;
}

ewa_status painter_create(const viewer_options *options, painter **made) {
    *made = NULL;
    painter *p = calloc(1, sizeof *p);
    if (!p) return EWA_ERROR_MEMORY;
    p->services = options->services;
    p->stepped = options->stepped;
    p->newest = p->shown = -1;
    pthread_mutex_init(&p->lock, NULL);
    pthread_cond_init(&p->changed, NULL);
    ewa_status status = paint_tools_make(options, options->backend, on_progress, p, &p->tools);
    if (status == EWA_OK && !p->stepped) {
        p->started = pthread_create(&p->thread, NULL, run, p) == 0;
        if (!p->started) status = EWA_ERROR_MEMORY;
    }
    if (status != EWA_OK) painter_destroy(&p);
    *made = p;
    return status;
}

bool painter_stop(painter *p) {
    pthread_mutex_lock(&p->lock);
    p->quits = true;
    atomic_store(&p->give_up, true);
    pthread_cond_broadcast(&p->changed);
    const bool rests = !p->draws;
    pthread_mutex_unlock(&p->lock);
    return rests;
}

void painter_destroy(painter **made) {
    painter *p = *made;
    if (!p) return;
    if (p->started) {
        (void)painter_stop(p);
        pthread_join(p->thread, NULL);
    }
    for (int k = 0; k < 3; k++) free(p->results[k].rgba8);
    paint_tools_free(&p->tools);
    pthread_cond_destroy(&p->changed);
    pthread_mutex_destroy(&p->lock);
    free(p);
    *made = NULL;
}

void painter_post(painter *p, const paint_scene *scene, uint64_t ticket, bool whole) {
    pthread_mutex_lock(&p->lock);
    p->next = *scene;
    p->next_ticket = ticket;
    p->next_whole = whole;
    p->waits = true;
    pthread_cond_broadcast(&p->changed);
    pthread_mutex_unlock(&p->lock);
}

bool painter_is_busy(painter *p) {
    pthread_mutex_lock(&p->lock);
    const bool busy = p->waits || p->draws;
    pthread_mutex_unlock(&p->lock);
    return busy;
}

void painter_hurry(painter *p) {
    pthread_mutex_lock(&p->lock);
    if (p->draws && p->whole) atomic_store(&p->give_up, true);
    p->waits = false;
    pthread_mutex_unlock(&p->lock);
}

void painter_rest(painter *p) {
    pthread_mutex_lock(&p->lock);
    p->waits = false;
    if (p->draws) atomic_store(&p->give_up, true);
    while (p->draws) pthread_cond_wait(&p->changed, &p->lock);
    pthread_mutex_unlock(&p->lock);
}

void painter_wait(painter *p) {
    pthread_mutex_lock(&p->lock);
    if (p->stepped && p->waits) draw_next(p);
    while (p->draws || p->waits) pthread_cond_wait(&p->changed, &p->lock);
    pthread_mutex_unlock(&p->lock);
}

const paint_result *painter_newest(painter *p, const char **failure) {
    pthread_mutex_lock(&p->lock);
    p->shown = p->newest;
    *failure = NULL;
    if (p->failure != EWA_OK) {
        snprintf(p->told, sizeof p->told, "%s",
                 p->failure_text[0] ? p->failure_text : ewa_status_name(p->failure));
        *failure = p->told;
    }
    p->failure = EWA_OK;
    const paint_result *result = p->shown >= 0 ? &p->results[p->shown] : NULL;
    pthread_mutex_unlock(&p->lock);
    return result;
}
