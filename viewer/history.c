// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Undo and redo: what is open, how it is shown, what is hidden, cut away, picked, measured and kept as keyframes, as it was before a command or
// a gesture that changed it. Cameras are left out: people go back by views. What was closed is loaded again, so that closing
// gives memory back.
#include "inner.h"

#include <stdlib.h>
#include <string.h>

/// What of an item a snapshot keeps.
typedef struct item_state {
    uint64_t id;
    char path[VIEWER_PATH_BYTES], name[VIEWER_NAME_BYTES];
    const ewa_scene_file *file;
    uint32_t entry;
    bool visible, named;
    uint32_t material;
    item_load load;
    viewer_coloring wish;
} item_state;

struct viewer_snapshot {
    viewer_settings settings;
    ewa_render_options render;
    ewa_furniture_options furniture;
    ewa_lod_options lod;
    ewa_gaussian_options gaussians;
    char title[VIEWER_NAME_BYTES];
    uint32_t region_count;
    ewa_region regions[EWA_MAX_REGIONS];
    viewer_cutaway cutaway;
    viewer_pick picks[2];
    char picked[VIEWER_TEXT_BYTES];
    bool profile;
    double profile_width;
    uint32_t profile_corner_count;
    double profile_corners[3 * EWA_PROFILE_CORNERS];
    uint32_t key_count;
    ewa_camera keys[EWA_MAX_KEYFRAMES];
    size_t measure_count, item_count;
    ewa_measure *measures;
    item_state *items;
};

static void free_snapshot(viewer_snapshot **given) {
    viewer_snapshot *s = *given;
    *given = NULL;
    if (!s) return;
    free(s->items);
    free(s->measures);
    free(s);
}

/// Copies what there is of items; without memory there are none.
static bool take_items(const viewer *v, viewer_snapshot *s) {
    s->items = calloc(v->item_count + 1, sizeof *s->items);
    if (!s->items) return false;
    s->item_count = v->item_count;
    for (size_t i = 0; i < v->item_count; i++) {
        const scene_item *from = &v->items[i];
        item_state *to = &s->items[i];
        to->id = from->id;
        memcpy(to->path, from->path, sizeof to->path);
        memcpy(to->name, from->name, sizeof to->name);
        to->file = from->file;
        to->entry = from->entry;
        to->visible = from->visible, to->named = from->named;
        to->material = from->material;
        to->load = from->load;
        memcpy(&to->wish, &from->wish, sizeof to->wish);
    }
    return true;
}

/// Copies the state; NULL: out of memory.
static viewer_snapshot *take(const viewer *v) {
    viewer_snapshot *s = calloc(1, sizeof *s);
    if (!s) return NULL;
    memcpy(&s->settings, &v->settings, sizeof s->settings);
    memcpy(&s->render, &v->render, sizeof s->render);
    memcpy(&s->furniture, &v->furniture, sizeof s->furniture);
    memcpy(&s->lod, &v->lod, sizeof s->lod);
    memcpy(&s->gaussians, &v->base.gaussians, sizeof s->gaussians);
    memcpy(s->title, v->title, sizeof s->title);
    s->region_count = v->base.region_count;
    memcpy(s->regions, v->base.regions, s->region_count * sizeof s->regions[0]);
    memcpy(&s->cutaway, &v->cutaway, sizeof s->cutaway);
    memcpy(s->picks, v->picks, sizeof s->picks);
    memcpy(s->picked, v->state.picked, sizeof s->picked);
    s->profile = v->profile.shown;
    s->profile_width = v->profile.width_world;
    s->profile_corner_count = v->profile.corner_count;
    memcpy(s->profile_corners, v->profile.corners_world, sizeof s->profile_corners);
    s->key_count = v->film.key_count;
    memcpy(s->keys, v->film.keys, s->key_count * sizeof s->keys[0]);
    s->measure_count = v->measure_count;
    s->measures = calloc(v->measure_count + 1, sizeof *s->measures);
    if (s->measures) memcpy(s->measures, v->measure_list, v->measure_count * sizeof *s->measures);
    if (!s->measures || !take_items(v, s)) free_snapshot(&s);
    return s;
}

static bool items_agree(const viewer_snapshot *a, const viewer_snapshot *b) {
    bool agree = a->item_count == b->item_count;
    for (size_t i = 0; agree && i < a->item_count; i++) {
        const item_state *p = &a->items[i], *q = &b->items[i];
        agree = p->id == q->id && p->visible == q->visible && p->material == q->material &&
                strcmp(p->name, q->name) == 0 && memcmp(&p->load, &q->load, sizeof p->load) == 0 && memcmp(&p->wish, &q->wish, sizeof p->wish) == 0;
    }
    return agree;
}

static bool agree(const viewer_snapshot *a, const viewer_snapshot *b) {
    return memcmp(&a->settings, &b->settings, sizeof a->settings) == 0 &&
           memcmp(&a->render, &b->render, sizeof a->render) == 0 &&
           memcmp(&a->furniture, &b->furniture, sizeof a->furniture) == 0 && memcmp(&a->lod, &b->lod, sizeof a->lod) == 0 &&
           memcmp(&a->gaussians, &b->gaussians, sizeof a->gaussians) == 0 &&
           strcmp(a->title, b->title) == 0 && a->region_count == b->region_count &&
           memcmp(a->regions, b->regions, sizeof a->regions) == 0 && memcmp(&a->cutaway, &b->cutaway, sizeof a->cutaway) == 0 &&
           memcmp(a->picks, b->picks, sizeof a->picks) == 0 && a->profile == b->profile &&
           a->profile_width == b->profile_width && a->profile_corner_count == b->profile_corner_count &&
           memcmp(a->profile_corners, b->profile_corners, sizeof a->profile_corners) == 0 &&
           a->key_count == b->key_count && memcmp(a->keys, b->keys, a->key_count * sizeof a->keys[0]) == 0 &&
           a->measure_count == b->measure_count &&
           memcmp(a->measures, b->measures, a->measure_count * sizeof *a->measures) == 0 && items_agree(a, b);
}

static void clear(viewer_snapshot **list, size_t *count) {
    while (*count) free_snapshot(&list[--*count]);
}

/// Puts a snapshot on a list, whose oldest goes where it is full.
static void push(viewer_snapshot **list, size_t *count, viewer_snapshot *snapshot) {
    if (*count == VIEWER_HISTORY) {
        free_snapshot(&list[0]);
        memmove(list, list + 1, --*count * sizeof *list);
    }
    list[(*count)++] = snapshot;
}

void history_free(viewer *v) {
    viewer_history *h = &v->history;
    free_snapshot(&h->before);
    clear(h->undo, &h->undo_count);
    clear(h->redo, &h->redo_count);
}

void history_begin(viewer *v) {
    viewer_history *h = &v->history;
    if (h->depth++) return; // what began first takes it all
    free_snapshot(&h->before);
    h->before = take(v);
}

void history_end(viewer *v) {
    viewer_history *h = &v->history;
    if (!h->depth || --h->depth) return;
    viewer_snapshot *now = h->before ? take(v) : NULL;
    if (now && !agree(h->before, now)) {
        push(h->undo, &h->undo_count, h->before);
        h->before = NULL;
        clear(h->redo, &h->redo_count);
    }
    free_snapshot(&now);
    free_snapshot(&h->before);
}

static const item_state *find_state(const viewer_snapshot *s, uint64_t id) {
    for (size_t i = 0; i < s->item_count; i++)
        if (s->items[i].id == id) return &s->items[i];
    return NULL;
}

/// Moves an item to its place in the list, or has one that was closed loaded again. False: it is gone.
static bool place_item(viewer *v, const item_state *state, size_t to) {
    size_t at = to;
    while (at < v->item_count && v->items[at].id != state->id) at++;
    scene_item item;
    if (at < v->item_count) {
        item = v->items[at];
        memmove(&v->items[to + 1], &v->items[to], (at - to) * sizeof item);
    } else {
        if (v->item_count == VIEWER_MAX_ITEMS || !loader_load(v->loader, state->id, state->path, state->file, state->entry, &state->load))
            return false;
        item = (scene_item){.id = state->id, .file = state->file, .entry = state->entry};
        memcpy(item.path, state->path, sizeof item.path);
        memcpy(&item.coloring, &state->wish, sizeof item.coloring);
        item.load = item.shown_load = state->load;
        memmove(&v->items[to + 1], &v->items[to], (v->item_count - to) * sizeof item);
        v->item_count++;
    }
    memcpy(item.name, state->name, sizeof item.name);
    item.visible = state->visible, item.named = state->named;
    item.material = state->material;
    memcpy(&item.wish, &state->wish, sizeof item.wish);
    v->items[to] = item;
    return items_reload(v, to, &state->load);
}

static void restore(viewer *v, const viewer_snapshot *s) {
    for (size_t i = v->item_count; i-- > 0;)
        if (!find_state(s, v->items[i].id)) items_close(v, i);
    size_t to = 0;
    for (size_t i = 0; i < s->item_count; i++) to += place_item(v, &s->items[i], to);
    v->settings = s->settings;
    v->render = s->render;
    v->furniture = s->furniture;
    v->lod = s->lod;
    memcpy(&v->base.gaussians, &s->gaussians, sizeof s->gaussians);
    memcpy(v->title, s->title, sizeof v->title);
    v->base.region_count = s->region_count;
    memcpy(v->base.regions, s->regions, sizeof v->base.regions);
    v->cutaway = s->cutaway;
    memcpy(v->picks, s->picks, sizeof v->picks);
    memcpy(v->state.picked, s->picked, sizeof v->state.picked);
    v->film.key_count = s->key_count;
    memcpy(v->film.keys, s->keys, s->key_count * sizeof s->keys[0]);
    v->measure_count = s->measure_count;
    memcpy(v->measure_list, s->measures, s->measure_count * sizeof *s->measures);
    items_refresh(v);
    profile_free(v);
    v->profile.width_world = s->profile_width;
    v->profile.corner_count = s->profile_corner_count;
    memcpy(v->profile.corners_world, s->profile_corners, sizeof v->profile.corners_world);
    if (s->profile) profile_take(v);
    select_clear(v);
    viewer_change(v);
    viewer_mark(v);
}

/// Goes to the newest snapshot of a list, and keeps what there was on the other.
static bool go(viewer *v, const char *word, viewer_snapshot **from, size_t *from_count, viewer_snapshot **to, size_t *to_count) {
    if (!*from_count) {
        viewer_tell(v, "%s: there is nothing to %s", word, word);
        return false;
    }
    viewer_snapshot *now = take(v), *then = from[--*from_count];
    if (now) push(to, to_count, now);
    restore(v, then);
    free_snapshot(&then);
    viewer_note(v, "%s", word);
    return true;
}

bool history_undo(viewer *v, const char *rest) {
    (void)rest;
    viewer_history *h = &v->history;
    return go(v, "undo", h->undo, &h->undo_count, h->redo, &h->redo_count);
}

bool history_redo(viewer *v, const char *rest) {
    (void)rest;
    viewer_history *h = &v->history;
    return go(v, "redo", h->redo, &h->redo_count, h->undo, &h->undo_count);
}
