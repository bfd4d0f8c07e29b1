// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The thread that reads nodes of octrees while pictures are drawn of those that are there.
#define _DARWIN_C_SOURCE // waits for a span, on macOS
#include "node_reader.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>

/// While something moves, nodes rest for so many times what they took: decoding them takes the processors from drawing, which is what a hand sees.
static const double REST_SHARE = 1.5;

struct node_reader {
    octree_turns *turns;
    ewa_context *context;
    ewa_scene_reader *reader;
    pthread_t thread;
    bool started;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    // Under the lock:
    bool quits, waits, reads;
    uint32_t resting; ///< who waits for it to be at rest
    paint_scene next, now; ///< `now` is the thread's own while it reads
    uint32_t next_max_count, max_count;
    bool next_moving;
    struct timespec rest_end; ///< nothing is read before, while something moves
    node_reader_state state;
};

/// Reads the most urgent nodes; returns how many have come, and in `*more` whether some may be left. Without the lock.
static uint32_t read_some(node_reader *r, bool *more) {
    uint32_t count = 0;
    turns_take(&r->turns->files);
    turns_take(&r->turns->nodes);
    ewa_status status =
        ewa_scene_reader_choose(r->reader, r->now.scene, &r->now.camera, &r->now.options, r->max_count, &count);
    turns_give(&r->turns->nodes);
    *more = status == EWA_OK && count > 0;
    if (*more) {
        status = ewa_scene_reader_read(r->reader);
        turns_take(&r->turns->nodes);
        ewa_scene_reader_put(r->reader);
        turns_give(&r->turns->nodes);
    }
    turns_give(&r->turns->files);
    return status == EWA_OK ? count : 0;
}

static double seconds_between(const struct timespec *from, const struct timespec *to) {
    return (double)(to->tv_sec - from->tv_sec) + 1e-9 * (double)(to->tv_nsec - from->tv_nsec);
}

/// Sets until when nothing is read after something has been since `began`.
static void begin_rest(node_reader *r, const struct timespec *began) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    const double end_s = 1e-9 * (double)now.tv_nsec + REST_SHARE * fmax(seconds_between(began, &now), 0);
    r->rest_end = (struct timespec){now.tv_sec + (time_t)end_s, (long)(1e9 * (end_s - floor(end_s)))};
}

/// Makes the condition one whose waits end by the clock that nobody sets.
static void make_condition(pthread_cond_t *condition) {
#ifdef __APPLE__ // has no such attribute, but waits for a span
    pthread_cond_init(condition, NULL);
#else
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_cond_init(condition, &attributes);
    pthread_condattr_destroy(&attributes);
#endif
}

/// Waits for something new until the rest ends, which is later than `now`. With the lock.
static void wait_until_rest_end(node_reader *r, const struct timespec *now) {
#ifdef __APPLE__
    const double left_s = seconds_between(now, &r->rest_end);
    const struct timespec left = {(time_t)left_s, (long)(1e9 * (left_s - floor(left_s)))};
    pthread_cond_timedwait_relative_np(&r->changed, &r->lock, &left);
#else
    (void)now;
    pthread_cond_timedwait(&r->changed, &r->lock, &r->rest_end);
#endif
}

/// Whether it rests still, after a while of that or something new. With the lock.
static bool rests(node_reader *r, bool more) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    if (!r->next_moving || r->resting || !(r->waits || more) || seconds_between(&now, &r->rest_end) <= 0) return false;
    wait_until_rest_end(r, &now);
    return true;
}

static void *run(void *data) {
    node_reader *r = data;
    bool more = false;
    pthread_mutex_lock(&r->lock);
    while (!r->quits) {
        if (rests(r, more)) continue;
        if (r->waits) {
            r->now = r->next;
            r->max_count = r->next_max_count;
            r->waits = false;
        } else if (!more || r->resting) {
            more = r->reads = r->state.busy = false;
            pthread_cond_broadcast(&r->changed);
            pthread_cond_wait(&r->changed, &r->lock);
            continue;
        }
        r->reads = true;
        pthread_mutex_unlock(&r->lock);
        struct timespec began;
        clock_gettime(CLOCK_MONOTONIC, &began);
        const uint32_t count = read_some(r, &more);
        pthread_mutex_lock(&r->lock);
        begin_rest(r, &began);
        r->state.arrived_count += count;
        r->state.ready = r->state.ready || !r->resting;
    }
    r->reads = r->state.busy = false;
    pthread_mutex_unlock(&r->lock);
    return NULL;
}

ewa_status node_reader_create(octree_turns *of_octrees, node_reader **made) {
    *made = NULL;
    node_reader *r = calloc(1, sizeof *r);
    if (!r) return EWA_ERROR_MEMORY;
    r->turns = of_octrees;
    pthread_mutex_init(&r->lock, NULL);
    make_condition(&r->changed);
    ewa_context_options options;
    ewa_context_options_init(&options, sizeof options);
    options.thread_count = 1; // octrees have threads of their own
    ewa_status status = ewa_context_create(&options, &r->context);
    if (status == EWA_OK) status = ewa_scene_reader_create(r->context, &r->reader);
    if (status == EWA_OK) {
        r->started = pthread_create(&r->thread, NULL, run, r) == 0;
        if (!r->started) status = EWA_ERROR_MEMORY;
    }
    if (status != EWA_OK) node_reader_destroy(&r);
    *made = r;
    return status;
}

bool node_reader_stop(node_reader *r) {
    pthread_mutex_lock(&r->lock);
    r->quits = true;
    pthread_cond_broadcast(&r->changed);
    const bool rests = !r->reads;
    pthread_mutex_unlock(&r->lock);
    return rests;
}

void node_reader_destroy(node_reader **made) {
    node_reader *r = *made;
    if (!r) return;
    if (r->started) {
        (void)node_reader_stop(r);
        pthread_join(r->thread, NULL);
    }
    ewa_scene_reader_destroy(&r->reader);
    ewa_context_destroy(&r->context);
    pthread_cond_destroy(&r->changed);
    pthread_mutex_destroy(&r->lock);
    free(r);
    *made = NULL;
}

void node_reader_post(node_reader *r, const paint_scene *scene, uint32_t max_count, bool moving) {
    pthread_mutex_lock(&r->lock);
    r->next_moving = moving;
    r->next = *scene;
    r->next_max_count = max_count;
    r->waits = r->state.busy = true;
    pthread_cond_broadcast(&r->changed);
    pthread_mutex_unlock(&r->lock);
}

void node_reader_rest(node_reader *r) {
    pthread_mutex_lock(&r->lock);
    r->waits = false;
    r->resting++;
    while (r->reads) pthread_cond_wait(&r->changed, &r->lock);
    r->resting--;
    r->state.busy = r->state.ready = false;
    pthread_mutex_unlock(&r->lock);
}

void node_reader_tell(node_reader *r, node_reader_state *state) {
    pthread_mutex_lock(&r->lock);
    *state = r->state;
    pthread_mutex_unlock(&r->lock);
}
