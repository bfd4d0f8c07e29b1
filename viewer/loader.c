// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The thread that loads files, colours them and makes surfels anew, one order after another; without one, the same in the caller's.
#include "loader.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct loader {
    viewer_services services;
    pthread_t thread;
    bool stepped, started;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    atomic_bool give_up;
    // Under the lock:
    bool quits;
    loader_note *orders, *reports; ///< the oldest first
    loader_note *current;          ///< the thread's own while it works
    bool forgotten;                ///< of `current`: nobody waits for what comes of it
    ewa_scene *last;               ///< the thread's own: what was made before, which others share
    char stage[64];
    double fraction;
};

static void release_scene(loader_scene *of) {
    for (uint32_t i = 0; i < of->count; i++) ewa_asset_release(&of->assets[i]);
    of->count = 0;
}

void loader_note_free(loader_note *note) {
    if (!note) return;
    ewa_asset_release(&note->asset);
    free(note->values);
    release_scene(&note->of);
    ewa_scene_destroy(&note->scene);
    free(note);
}

static void free_list(loader_note **list) {
    while (*list) {
        loader_note *first = *list;
        *list = first->next;
        loader_note_free(first);
    }
}

static void append(loader_note **list, loader_note *note) {
    while (*list) list = &(*list)->next;
    note->next = NULL;
    *list = note;
}

/// Hands over what has come of an order, unless it was forgotten; with the lock.
static void report_result(loader *l, loader_note *note) {
    if (l->forgotten)
        loader_note_free(note);
    else
        append(&l->reports, note);
    pthread_cond_broadcast(&l->changed);
}

static bool on_progress(void *user, const char *stage, double fraction) {
    loader *l = user;
    const bool own = l->stepped ? l->current != NULL : pthread_equal(pthread_self(), l->thread);
    if (!own) return true; // an octree that is drawn
    pthread_mutex_lock(&l->lock);
    snprintf(l->stage, sizeof l->stage, "%s", stage);
    l->fraction = fraction;
    pthread_mutex_unlock(&l->lock);
    return !atomic_load(&l->give_up);
}

static void on_message(void *user, ewa_severity severity, const char *text) {
    loader *l = user;
    loader_note *note = calloc(1, sizeof *note);
    if (!note) return;
    note->kind = LOADER_MESSAGE;
    note->severity = severity;
    snprintf(note->text, sizeof note->text, "%s", text);
    pthread_mutex_lock(&l->lock);
    append(&l->reports, note);
    pthread_cond_broadcast(&l->changed);
    pthread_mutex_unlock(&l->lock);
}

static void on_preview(void *user, ewa_asset *asset, bool as_points) {
    loader *l = user;
    loader_note *note = calloc(1, sizeof *note);
    if (!note) {
        ewa_asset_release(&asset);
        return;
    }
    note->kind = LOADER_PREVIEW;
    note->item = l->current->item;
    memcpy(note->path, l->current->path, sizeof note->path);
    note->asset = asset;
    note->as_points = as_points;
    pthread_mutex_lock(&l->lock);
    report_result(l, note);
    pthread_mutex_unlock(&l->lock);
}

/// Returns how many levels surfels are to have: none of so few that one cannot tell what is seen.
static uint32_t level_count_of(const loader_scene *of) {
    enum { MOST = 8, FEWEST_SURFELS = 12000 };
    uint64_t count = 0;
    for (uint32_t i = 0; i < of->count; i++) {
        ewa_asset_info info;
        ewa_asset_describe(of->assets[i], &info);
        if (info.kind == EWA_ASSET_MESH) return MOST; // as many as its area says
        if (info.kind == EWA_ASSET_POINTS && of->instances[i].visible) count += info.count;
    }
    uint32_t levels = 1; // all of them
    while (levels < MOST && (count /= 4) >= FEWEST_SURFELS) levels++;
    return levels;
}

/// Makes the scene of an order, with what it has in common with the last one.
static bool make_scene(loader *l, ewa_context *context, loader_note *order) {
    ewa_scene_options options = order->of.options;
    options.surfels.level_count = level_count_of(&order->of);
    ewa_scene *scene = NULL;
    ewa_status status = ewa_scene_create(context, &options, &scene);
    for (uint32_t i = 0; i < order->of.count && status == EWA_OK; i++)
        status = ewa_scene_add(scene, order->of.assets[i], &order->of.instances[i]);
    if (status == EWA_OK && l->last) ewa_scene_reuse(scene, l->last);
    if (status == EWA_OK) status = ewa_scene_commit(scene);
    ewa_scene *copy = NULL;
    if (status == EWA_OK) status = ewa_scene_copy(scene, context, &copy);
    if (status != EWA_OK) {
        ewa_scene_destroy(&scene);
        return false;
    }
    ewa_scene_destroy(&l->last);
    l->last = copy;
    order->scene = scene;
    return true;
}

/// Counts what values a volume's file holds.
static bool count_values(ewa_context *context, loader_note *order) {
    ewa_volume volume;
    order->values = calloc(1, sizeof *order->values);
    if (!order->values || ewa_volume_load(context, order->path, NULL, &volume) != EWA_OK) return false;
    const char *transfer = order->load.transfer;
    const bool done = ewa_volume_measure(&volume, &order->values->facts) == EWA_OK &&
                      ewa_transfer_choose(context, transfer[0] ? transfer : NULL, &volume, &order->values->transfer) == EWA_OK;
    ewa_volume_free(&volume);
    return done;
}

/// Carries out an order, which becomes its report.
static void carry_out(loader *l, loader_note *order) {
    const viewer_news news = {l, on_progress, on_message, on_preview};
    const viewer_services *s = &l->services;
    ewa_context *context = s->context(s->user, &news);
    ewa_scene_entry entry;
    if (!order->file || ewa_scene_file_entry(order->file, order->entry, &entry) != EWA_OK)
        ewa_asset_options_init(&entry.asset, sizeof entry.asset);
    memcpy(entry.asset.to_world, order->load.to_world, sizeof entry.asset.to_world);
    if (order->load.transfer[0]) entry.asset.transfer = order->load.transfer;
    const char *path = order->load.colored[0] ? order->load.colored : order->path;
    bool done = context != NULL;
    if (order->kind == LOADER_VALUES)
        done = done && count_values(context, order);
    else if (order->kind == LOADER_PHOTOS)
        done = done && s->photos(s->user, path, &entry.asset, &order->photos, &news, &order->found);
    else if (order->kind == LOADER_LOAD)
        done = done && s->load(s->user, path, &entry.asset, &news, &order->asset);
    else
        done = done && make_scene(l, context, order);
    if (!done) order->kind = LOADER_FAILED;
}

/// Carries out the oldest order. With the lock, but for the work.
static void do_next(loader *l) {
    loader_note *order = l->orders;
    l->orders = order->next;
    order->next = NULL;
    l->current = order;
    l->forgotten = false;
    l->fraction = 0;
    l->stage[0] = 0;
    atomic_store(&l->give_up, false);
    pthread_mutex_unlock(&l->lock);
    carry_out(l, order);
    pthread_mutex_lock(&l->lock);
    l->current = NULL;
    report_result(l, order);
}

static void *run(void *data) {
    loader *l = data;
    pthread_mutex_lock(&l->lock);
    while (!l->quits) {
        if (l->orders)
            do_next(l);
        else
            pthread_cond_wait(&l->changed, &l->lock);
    }
    pthread_mutex_unlock(&l->lock);
    return NULL;
}

ewa_status loader_create(const viewer_services *services, bool stepped, loader **made) {
    *made = NULL;
    loader *l = calloc(1, sizeof *l);
    if (!l) return EWA_ERROR_MEMORY;
    l->services = *services;
    pthread_mutex_init(&l->lock, NULL);
    pthread_cond_init(&l->changed, NULL);
    l->stepped = stepped;
    l->started = !stepped && pthread_create(&l->thread, NULL, run, l) == 0;
    *made = l;
    if (!stepped && !l->started) loader_destroy(made);
    return *made ? EWA_OK : EWA_ERROR_MEMORY;
}

bool loader_stop(loader *l) {
    pthread_mutex_lock(&l->lock);
    l->quits = true;
    atomic_store(&l->give_up, true);
    pthread_cond_broadcast(&l->changed);
    const bool rests = !l->current;
    pthread_mutex_unlock(&l->lock);
    return rests;
}

void loader_destroy(loader **made) {
    loader *l = *made;
    if (!l) return;
    if (l->started) {
        (void)loader_stop(l);
        pthread_join(l->thread, NULL);
    }
    free_list(&l->orders);
    free_list(&l->reports);
    ewa_scene_destroy(&l->last);
    pthread_cond_destroy(&l->changed);
    pthread_mutex_destroy(&l->lock);
    free(l);
    *made = NULL;
}

static void post(loader *l, loader_note *order) {
    pthread_mutex_lock(&l->lock);
    append(&l->orders, order);
    pthread_cond_broadcast(&l->changed);
    pthread_mutex_unlock(&l->lock);
}

/// An order of an item's file; NULL: out of memory.
static loader_note *make_order(loader_kind kind, uint64_t item, const char *path) {
    loader_note *order = calloc(1, sizeof *order);
    if (!order) return NULL;
    order->kind = kind;
    order->item = item;
    snprintf(order->path, sizeof order->path, "%s", path);
    return order;
}

bool loader_load(loader *l, uint64_t item, const char *path, const ewa_scene_file *file, uint32_t entry, const item_load *load) {
    loader_note *order = make_order(LOADER_LOAD, item, path);
    if (!order) return false;
    order->file = file;
    order->entry = entry;
    order->load = *load;
    post(l, order);
    return true;
}

bool loader_count(loader *l, uint64_t item, const char *path, const item_load *load) {
    loader_note *order = make_order(LOADER_VALUES, item, path);
    if (!order) return false;
    order->load = *load;
    post(l, order);
    return true;
}

bool loader_photos(loader *l, uint64_t item, const char *path, const ewa_scene_file *file, uint32_t entry,
                   const viewer_photos *photos) {
    loader_note *order = make_order(LOADER_PHOTOS, item, path);
    if (!order) return false;
    order->file = file;
    order->entry = entry;
    order->photos = *photos;
    ewa_asset_options usual; // cameras are in the coordinates of the file
    ewa_asset_options_init(&usual, sizeof usual);
    memcpy(order->load.to_world, usual.to_world, sizeof usual.to_world);
    post(l, order);
    return true;
}

/// Takes the orders of an item out of the queue; with the lock.
static void drop_orders(loader *l, uint64_t item) {
    for (loader_note **at = &l->orders; *at;) {
        loader_note *order = *at;
        if (order->item != item) {
            at = &order->next;
            continue;
        }
        *at = order->next;
        loader_note_free(order);
    }
}

bool loader_make(loader *l, loader_scene *of) {
    loader_note *order = calloc(1, sizeof *order);
    if (!order) {
        release_scene(of);
        return false;
    }
    order->kind = LOADER_SCENE;
    order->of = *of;
    pthread_mutex_lock(&l->lock);
    drop_orders(l, 0);
    pthread_mutex_unlock(&l->lock);
    post(l, order);
    return true;
}

/// Gives up the order that is under way, if there is one; with the lock. Nothing more is reported of a file.
static void give_up_current(loader *l) {
    if (!l->current) return;
    atomic_store(&l->give_up, true);
    l->forgotten = l->current->item != 0;
}

void loader_cancel(loader *l) {
    pthread_mutex_lock(&l->lock);
    for (loader_note *order; (order = l->orders);) {
        l->orders = order->next;
        if (order->kind != LOADER_SCENE) {
            loader_note_free(order);
            continue;
        }
        order->kind = LOADER_FAILED;
        append(&l->reports, order);
    }
    give_up_current(l);
    pthread_mutex_unlock(&l->lock);
}

void loader_forget(loader *l, uint64_t item) {
    pthread_mutex_lock(&l->lock);
    drop_orders(l, item);
    if (l->current && l->current->item == item) give_up_current(l);
    pthread_mutex_unlock(&l->lock);
}

void loader_step(loader *l) {
    pthread_mutex_lock(&l->lock);
    if (l->stepped && l->orders) do_next(l);
    pthread_mutex_unlock(&l->lock);
}

void loader_wait(loader *l) {
    pthread_mutex_lock(&l->lock);
    while (l->stepped && l->orders) do_next(l);
    while (l->orders || l->current) pthread_cond_wait(&l->changed, &l->lock);
    pthread_mutex_unlock(&l->lock);
}

bool loader_is_busy(loader *l) {
    pthread_mutex_lock(&l->lock);
    const bool busy = l->orders || l->current || l->reports;
    pthread_mutex_unlock(&l->lock);
    return busy;
}

loader_note *loader_take(loader *l) {
    pthread_mutex_lock(&l->lock);
    loader_note *note = l->reports;
    if (note) l->reports = note->next;
    pthread_mutex_unlock(&l->lock);
    return note;
}

void loader_tell(loader *l, char path[VIEWER_PATH_BYTES], char stage[64], double *fraction,
                 uint32_t *waiting) {
    pthread_mutex_lock(&l->lock);
    snprintf(path, VIEWER_PATH_BYTES, "%s", l->current ? l->current->path : "");
    snprintf(stage, sizeof l->stage, "%s", l->current ? l->stage : "");
    *fraction = l->fraction;
    *waiting = 0;
    for (const loader_note *order = l->orders; order; order = order->next)
        *waiting += order->kind == LOADER_LOAD;
    pthread_mutex_unlock(&l->lock);
}
