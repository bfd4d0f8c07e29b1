// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The viewer: its life, and what happens at each frame.
#include "inner.h"
#include "navigate.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// So long after the last change the whole picture is drawn.
static const double SETTLE_S = 0.08;
/// What a move of the camera takes.
static const double ANIMATION_S = 0.25;
/// What the way from one keyframe to the next takes where it is only looked at: as in a film of 60 frames, 30 a second.
static const double PREVIEW_KEY_S = 2;
/// No window is larger.
static const double MAX_PX = 1 << 27, MAX_SIDE_PX = 32768;
/// Windows of more pixels are drawn at half their size while something moves.
static const double LARGE_PX = 2e6;
/// Moving pictures become plainer after so many that take so many times their budget, and finer after so many
/// that would take so much of it.
static const double TOO_SLOW = 1.4, MUCH_FASTER = 0.7;
/// Octrees get coarser by small steps, which few can tell: what else a picture takes has room in the budget, too.
static const double TOO_SLOW_BY_STEPS = 0.8;
/// Of volumes and octrees, whose pictures choose no level by themselves, one that takes so many times its budget is enough.
static const double FAR_TOO_SLOW = 4, FAR_TOO_SLOW_BY_STEPS = 1.5;
enum { SLOW_PICTURES = 2, FAST_PICTURES = 8 };
/// How plain they become: how many times as coarse octrees and Gaussians are as when nothing moves, at which level volumes are drawn, and by how much the sides
/// of the picture are divided.
/// Where the last is too slow, there are fewer pictures: those of less could not be told from others.
static const struct {
    double coarser;
    uint32_t voxel_level, divisor;
} plainness[] = {{2, 1, 1}, {2.4, 1, 1}, {2.8, 1, 1}, {4, 2, 1}, {2, 1, 2}, {2.8, 1, 2}, {4, 2, 2}};
/// What drawing a volume takes beside drawing it at the level before, which has eight times the voxels and as many pixels.
static const double LEVEL_SHARE = 0.25;
/// The first steps, which octrees take to have more frames: half the size with surfels of twice its pixels shows what the whole one with four does.
enum { SMALL_STEPS = 4, FIRST_STEP = 3 };
/// What pixels take beside surfels that are twice as coarse as when nothing moves, as a share of both.
static const double PIXELS_SHARE = 0.45;
enum { PLAINEST = sizeof plainness / sizeof plainness[0] - 1 };
/// Surfaces that show through each other at silhouettes of them, at most: the third and all behind it are seen in few pixels.
enum { MOVING_EDGE_LAYERS = 2 };
/// Time for reading the nodes of octrees, of each picture while they get finer.
static const double REFINE_S = 0.15, LONGEST_REFINE_S = 1;
/// Without threads, a whole picture holds up the hand: it waits for such a share of what the last one took, and no longer than this.
static const double SETTLE_SHARE = 0.5, LONGEST_SETTLE_S = 0.5;
/// So many of their nodes are read at once while something moves, and while nothing does.
enum { NODES_MOVING = 2, NODES_STILL = 8 };
/// Nodes that have come are shown after so long, and after so many times what drawing them takes.
static const double SHOW_NODES_S = 0.25, SHOW_NODES_SHARE = 4;
/// Gaussians that have levels are drawn within so many pixels of all while something moves, times how coarse octrees are: they are
/// the nearest to what is there at twice that.
static const double MOVING_MERGE_PX = 1;
/// Octrees are no coarser than this while something moves, whatever was asked for.
static const double MAX_SPACING_PX = 64, MAX_ERROR = 255;
/// When to ask again, while something is under way and when nothing is.
static const double SOON_S = 0.002, LATER_S = 0.1;
/// Beside the ticket of a composed picture: it was whole.
static const uint64_t WHOLE = (uint64_t)1 << 63;

void viewer_change(viewer *v) {
    v->revision++;
    v->changed_s = v->now_s;
}

void viewer_mark(viewer *v) { v->marks++; }

void viewer_tell(viewer *v, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(v->state.message, sizeof v->state.message, format, arguments);
    va_end(arguments);
    v->state.message_s = v->now_s;
    if (v->services.say) v->services.say(v->services.user, true, v->state.message);
}

void viewer_note(viewer *v, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(v->state.note, sizeof v->state.note, format, arguments);
    va_end(arguments);
    v->state.note_s = v->now_s;
}

void viewer_say(viewer *v, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(v->said, sizeof v->said, format, arguments);
    va_end(arguments);
    if (v->services.say) v->services.say(v->services.user, false, v->said);
}

static uint32_t pixels(double points, double scale) {
    const double size = floor(points * scale + 0.5);
    return size < 1 ? 1 : size > MAX_SIDE_PX ? (uint32_t)MAX_SIDE_PX : (uint32_t)size;
}

void viewer_coloring_init(viewer_coloring *coloring) {
    *coloring = (viewer_coloring){.alpha = 1, .radius_scale = 1};
}

void viewer_look_init(viewer_look *look) {
    *look = (viewer_look){.transfer = NULL};
    ewa_scene_options_init(&look->scene, sizeof look->scene);
    ewa_furniture_options_init(&look->furniture, sizeof look->furniture);
    ewa_coloring_init(&look->coloring, sizeof look->coloring);
}

/// Has everything shown as the options say. False: a path is too long.
static bool take_look(viewer *v, const viewer_look *look) {
    const char *title = look->furniture.title ? look->furniture.title : "", *transfer = look->transfer ? look->transfer : "";
    v->base = look->scene;
    v->render = look->scene.render;
    v->lod = look->scene.lod;
    v->furniture = look->furniture;
    v->furniture.title = title[0] ? v->title : NULL;
    v->coloring = look->coloring;
    cutaway_take(v);
    snprintf(v->title, sizeof v->title, "%s", title);
    return snprintf(v->transfer, sizeof v->transfer, "%s", transfer) < (int)sizeof v->transfer;
}

ewa_status viewer_create(const viewer_options *options, viewer **made) {
    *made = NULL;
    if (!(options->scale > 0 && isfinite(options->scale)) || !options->width || !options->height)
        return EWA_ERROR_ARGUMENT;
    viewer *v = calloc(1, sizeof *v);
    if (!v) return EWA_ERROR_MEMORY;
    if (!options->stepped) own_files_clean();
    v->services = options->services;
    v->waits = options->waits;
    v->stepped = options->stepped;
    v->width = options->width, v->height = options->height, v->scale = options->scale;
    settings_init(v);
    viewer_look usual;
    viewer_look_init(&usual);
    const bool fits = take_look(v, options->look ? options->look : &usual);
    ewa_camera_init(&v->camera);
    if (options->camera) {
        v->camera = *options->camera;
        v->placed = true;
    }
    v->up_world[2] = 1;
    v->reach_world = v->fly_speed = 1;
    if (!options->camera) navigate_move(&v->camera, (double[3]){0, 0, -3});
    ewa_camera_resize(&v->camera, EWA_RESIZE_HEIGHT, pixels(v->width, v->scale), pixels(v->height, v->scale));
    v->revision = 1;
    v->state.panels = true;
    v->turns = malloc(sizeof *v->turns);
    if (v->turns) turns_init(&v->turns->files);
    if (v->turns) turns_init(&v->turns->nodes);
    ewa_status status = !fits ? EWA_ERROR_ARGUMENT : v->turns ? loader_create(&v->services, v->stepped, &v->loader) : EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = painter_create(options, &v->painter);
    if (status == EWA_OK && !v->stepped && !v->waits) status = node_reader_create(v->turns, &v->node_reader);
    if (status == EWA_OK)
        status = paint_tools_make(options, EWA_BACKEND_CPU, NULL, NULL, &v->probe);
    if (status == EWA_OK) status = ewa_scene_create(v->probe.context, NULL, &v->scene);
    if (status != EWA_OK) viewer_destroy(&v);
    *made = v;
    return status;
}

bool viewer_stop(viewer *v) {
    const bool loads = !loader_stop(v->loader), draws = !painter_stop(v->painter);
    const bool reads = v->node_reader && !node_reader_stop(v->node_reader);
    return !loads && !draws && !reads;
}

void viewer_destroy(viewer **made) {
    viewer *v = *made;
    if (!v) return;
    film_free(v);
    loader_destroy(&v->loader);
    node_reader_destroy(&v->node_reader);
    painter_destroy(&v->painter);
    for (size_t i = 0; i < v->item_count; i++) {
        ewa_asset_release(&v->items[i].preview);
        ewa_asset_release(&v->items[i].asset);
        free(v->items[i].values);
    }
    own_files_remove(v);
    ewa_scene_destroy(&v->scene);
    history_free(v);
    profile_free(v);
    free(v->selection.places_world);
    for (size_t i = 0; i < v->file_count; i++) ewa_scene_file_destroy(&v->files[i]);
    free(v->files);
    paint_tools_free(&v->probe);
    if (v->turns) turns_free(&v->turns->files);
    if (v->turns) turns_free(&v->turns->nodes);
    free(v->turns);
    free(v->composed);
    free(v);
    *made = NULL;
}

void viewer_go(viewer *v, const ewa_camera *to) {
    v->film.previews = false;
    v->animated = v->settings.animate && v->now_s > 0 && to->projection == v->camera.projection;
    v->animation_s = v->now_s;
    v->animation_from = v->camera;
    v->animation_to = *to;
    if (!v->animated) v->camera = *to;
    viewer_change(v);
}

/// Where the camera is on its way, without a jump at either end.
static void animate(viewer *v) {
    if (!v->animated) return;
    if (v->film.previews) {
        v->animated = film_look(v, (v->now_s - v->animation_s) / PREVIEW_KEY_S);
        return;
    }
    const double share = (v->now_s - v->animation_s) / ANIMATION_S;
    v->animated = share < 1;
    ewa_camera_path *path = NULL;
    const ewa_camera keys[2] = {v->animation_from, v->animation_to};
    if (!v->animated || ewa_camera_path_create(v->probe.context, keys, 2, false, &path) != EWA_OK ||
        ewa_camera_path_at(path, share * share * (3 - 2 * share), &v->camera) != EWA_OK) {
        v->camera = v->animation_to;
        v->animated = false;
    }
    ewa_camera_path_destroy(&path);
    viewer_change(v);
}

bool viewer_size_fits(double width, double height, double scale) {
    const double wide_px = width * scale, high_px = height * scale;
    return width >= 1 && height >= 1 && scale > 0 && wide_px * high_px <= MAX_PX && wide_px <= MAX_SIDE_PX &&
           high_px <= MAX_SIDE_PX;
}

static void resize(viewer *v, const viewer_event *event) {
    if (!viewer_size_fits(event->x, event->y, event->amount)) return;
    v->width = event->x, v->height = event->y, v->scale = event->amount;
    const uint32_t width_px = pixels(v->width, v->scale), height_px = pixels(v->height, v->scale);
    if (width_px == v->camera.width_px && height_px == v->camera.height_px) return;
    ewa_camera_resize(&v->camera, EWA_RESIZE_HEIGHT, width_px, height_px);
    if (v->animated) {
        ewa_camera_resize(&v->animation_from, EWA_RESIZE_HEIGHT, width_px, height_px);
        ewa_camera_resize(&v->animation_to, EWA_RESIZE_HEIGHT, width_px, height_px);
    }
    viewer_change(v);
}

/// Goes on to a time; clocks do not run backwards.
static void advance(viewer *v, double time_s) {
    const double passed_s = time_s - v->now_s;
    if (!(passed_s > 0)) return;
    v->now_s = time_s;
    animate(v);
    if (v->fly_keys) keys_fly(v, passed_s < 0.1 ? passed_s : 0.1);
}

void viewer_handle(viewer *v, const viewer_event *event) {
    advance(v, event->time_s);
    switch (event->kind) {
    case VIEWER_RESIZE:
        resize(v, event);
        break;
    case VIEWER_DROP:
        history_begin(v);
        if (event->text) items_open(v, event->text);
        history_end(v);
        break;
    case VIEWER_KEY:
    case VIEWER_KEY_RELEASE:
        keys_handle(v, event);
        break;
    case VIEWER_LEAVE:
        v->fly_keys = 0;
        pointer_handle(v, event);
        break;
    default:
        pointer_handle(v, event);
        break;
    }
}

void viewer_scene(const viewer *v, paint_scene *scene) {
    *scene = (paint_scene){.camera = v->camera, .turns = v->turns, .options = v->base};
    scene->options.render = v->render;
    scene->options.lod = v->lod;
    // Without threads, reading for as long as drawing takes gets everything drawn half as often.
    const double refine_s = v->stepped ? fmin(fmax(REFINE_S, 0.5 * v->whole_s), LONGEST_REFINE_S) : REFINE_S;
    scene->options.lod.load_s = v->waits ? 0 : refine_s;
    scene->options.volumes.density_scale *= v->settings.volume_density;
    cutaway_apply(v, &scene->options.render);
    items_gather(v, scene);
}

/// By how much the sides of a picture are divided at least while something moves.
static uint32_t min_divisor(const viewer *v) {
    return (double)v->camera.width_px * v->camera.height_px > LARGE_PX ? 2 : 1;
}

static uint32_t voxel_level_of(const viewer *v, uint32_t plain) {
    return plainness[plain].voxel_level < v->voxel_level ? plainness[plain].voxel_level : v->voxel_level;
}

/// What pictures of one plainness take beside those of another one, about.
static double work_of(const viewer *v, uint32_t plain) {
    const double divisor = v->settings.reduce ? fmax(plainness[plain].divisor, min_divisor(v)) : 1;
    const double share = v->octrees || v->gaussian_levels ? PIXELS_SHARE : 1, finer = plainness[0].coarser / plainness[plain].coarser;
    const double levels = v->volumes ? pow(LEVEL_SHARE, voxel_level_of(v, plain)) : 1;
    return levels * (share + (1 - share) * finer * finer) / (divisor * divisor);
}

/// Makes moving pictures plainer where they take too long, and finer again, by steps that change something.
static void adapt(viewer *v, const paint_result *newest) {
    if (!newest || newest->whole || newest->ticket == v->adapted) return;
    v->adapted = newest->ticket;
    const double budget_s = 1e-3 * v->settings.budget_ms, work = work_of(v, v->plain);
    uint32_t plainer = v->plain, finer = v->plain;
    const bool steps = v->octrees && !v->volumes && v->plain < SMALL_STEPS;
    const double too_slow = steps ? TOO_SLOW_BY_STEPS : TOO_SLOW;
    const uint32_t plainest = steps ? SMALL_STEPS : PLAINEST;
    const bool far_too_slow = (v->volumes && newest->drawn_s > FAR_TOO_SLOW * budget_s) ||
                              (steps && newest->drawn_s > FAR_TOO_SLOW_BY_STEPS * budget_s);
    while (plainer < plainest && (work_of(v, plainer) >= work ||
                                  (far_too_slow && newest->drawn_s * work_of(v, plainer) > too_slow * budget_s * work)))
        plainer++;
    while (finer > 0 && work_of(v, finer) <= work) finer--;
    const bool slow = newest->drawn_s > too_slow * budget_s;
    const bool fast = newest->drawn_s * work_of(v, finer) / work < MUCH_FASTER * budget_s;
    v->slow_count = slow ? v->slow_count + 1 : 0;
    v->fast_count = fast ? v->fast_count + 1 : 0;
    const uint32_t before = v->plain;
    if ((v->slow_count >= SLOW_PICTURES || far_too_slow) && work_of(v, plainer) < work) v->plain = plainer;
    if (v->fast_count >= FAST_PICTURES && work_of(v, finer) > work) v->plain = finer;
    if (v->plain != before) v->slow_count = v->fast_count = 0;
}

/// A scene that is drawn within the time of a frame.
static void make_quick(const viewer *v, paint_scene *scene) {
    ewa_scene_options *options = &scene->options;
    options->render.budget_s = 1e-3 * v->settings.budget_ms;
    options->volumes.level = voxel_level_of(v, v->plain);
    if ((v->plain || scene->octrees) && options->render.edge_layers > MOVING_EDGE_LAYERS) {
        options->render.edge_layers = MOVING_EDGE_LAYERS;
        scene->coarse = true;
    }
    if (scene->octrees) {
        const double coarser = plainness[v->plain].coarser;
        scene->coarse = true;
        options->lod.load_s = 0.5 * options->render.budget_s;
        options->lod.spacing_px = fmin(coarser * options->lod.spacing_px, MAX_SPACING_PX);
        options->lod.error = fmin(coarser * options->lod.error, MAX_ERROR);
    }
    if (v->gaussian_levels) {
        scene->coarse = true;
        options->lod.load_s = 0.5 * options->render.budget_s; // of streamed ones
        options->gaussians.merge_px = fmax(options->gaussians.merge_px, MOVING_MERGE_PX * plainness[v->plain].coarser);
    }
    const uint32_t minimum = min_divisor(v), wanted = plainness[v->plain].divisor;
    const uint32_t divisor = wanted > minimum ? wanted : minimum;
    if (!v->settings.reduce || divisor == 1) return;
    scene->reduced = true;
    ewa_camera *camera = &scene->camera;
    camera->width_px = (camera->width_px + divisor - 1) / divisor;
    camera->height_px = (camera->height_px + divisor - 1) / divisor;
    camera->fx_px /= divisor, camera->fy_px /= divisor, camera->cx_px /= divisor, camera->cy_px /= divisor;
}

static void post(viewer *v, bool whole) {
    paint_scene scene;
    viewer_scene(v, &scene);
    scene.options.lod.resident_only = v->node_reader != NULL;
    if (!whole) make_quick(v, &scene);
    v->posted = v->revision;
    v->posted_whole = whole;
    if (v->node_reader && scene.octrees) {
        node_reader_state state;
        node_reader_tell(v->node_reader, &state);
        scene.arrived_count = state.arrived_count;
        node_reader_post(v->node_reader, &scene, whole ? NODES_STILL : NODES_MOVING, !whole);
    }
    painter_post(v->painter, &scene, v->revision, whole);
}

/// Whether something moves by itself or is held.
static bool is_moving(const viewer *v) {
    const double settle_s = v->stepped ? fmin(fmax(SETTLE_S, SETTLE_SHARE * v->whole_s), LONGEST_SETTLE_S) : SETTLE_S;
    return v->animated || v->fly_keys || v->now_s - v->changed_s < settle_s;
}

/// Whether a picture shows all nodes of octrees that will come.
static bool is_complete(const viewer *v, const paint_result *newest) {
    if (!v->node_reader || !v->octrees || !newest->lacks_nodes) return true;
    node_reader_state state;
    node_reader_tell(v->node_reader, &state);
    return !state.busy && newest->arrived_count == state.arrived_count;
}

/// Has nodes read of a scene that is new, before there is something to draw; true: they have not come yet.
static bool awaits_nodes(viewer *v) {
    if (!v->node_reader || !v->octrees) return false;
    node_reader_state state;
    node_reader_tell(v->node_reader, &state);
    if (state.ready) return false;
    paint_scene scene;
    viewer_scene(v, &scene);
    if (!state.busy) node_reader_post(v->node_reader, &scene, NODES_MOVING, false);
    return true;
}

/// Whether nodes have come that are to be shown now: at the end, and now and then before.
static bool is_to_be_refined(viewer *v, const paint_result *newest) {
    if (!v->node_reader || !v->octrees) {
        if (!newest->to_refine || newest->drawn_count == v->refined) return false;
        v->refined = newest->drawn_count;
        return true;
    }
    if (!newest->lacks_nodes) return false;
    node_reader_state state;
    node_reader_tell(v->node_reader, &state);
    if (newest->arrived_count == state.arrived_count) return false;
    if (state.busy && v->now_s - v->refined_s < fmax(SHOW_NODES_S, SHOW_NODES_SHARE * newest->drawn_s)) return false;
    v->refined_s = v->now_s;
    return true;
}

/// Has drawn what there is to draw: at once and roughly while something moves, else whole.
static void schedule(viewer *v, const paint_result *newest) {
    if (v->waits) {
        if (v->posted == v->revision && newest) return;
        post(v, true);
        painter_wait(v->painter);
        return;
    }
    if (awaits_nodes(v)) return;
    if (v->posted != v->revision) {
        painter_hurry(v->painter);
        // The first time from the coarse side: a hand that begins to turn is not kept waiting.
        if (v->octrees && !v->adapted && v->plain < FIRST_STEP) v->plain = FIRST_STEP;
        if (!painter_is_busy(v->painter)) post(v, false);
        return;
    }
    if (newest && newest->ticket == v->posted && newest->whole) v->posted_whole = true;
    if (v->posted_whole && newest && newest->ticket == v->posted && !painter_is_busy(v->painter) &&
        is_to_be_refined(v, newest))
        v->posted_whole = false; // once more, with the nodes that have come
    if (!v->posted_whole && !is_moving(v) && !painter_is_busy(v->painter)) post(v, true);
}

/// Puts marks and furniture over the newest picture.
static void compose(viewer *v, const paint_result *newest) {
    const uint64_t ticket = newest->ticket | (newest->whole ? WHOLE : 0);
    const bool same = ticket == v->composed_ticket && newest->drawn_count == v->composed_drawn;
    if (v->number && same && v->marks == v->composed_marks) return;
    const size_t wanted = 4 * (size_t)newest->width_px * newest->height_px;
    if (wanted > v->composed_bytes) {
        uint8_t *larger = realloc(v->composed, wanted);
        if (!larger) return; // the picture before stays
        v->composed = larger;
        v->composed_bytes = wanted;
    }
    memcpy(v->composed, newest->rgba8, wanted);
    overlay_draw(v, &newest->camera, v->furniture.ink, false, v->composed);
    v->composed_ticket = ticket;
    v->composed_drawn = newest->drawn_count;
    v->composed_marks = v->marks;
    v->number++;
}

void viewer_frame(viewer *v, double time_s, viewer_picture *picture) {
    *picture = (viewer_picture){.rgba8 = NULL};
    advance(v, time_s);
    if (v->services.interrupted && v->services.interrupted(v->services.user)) v->state.quit = true;
    if (v->stepped) loader_step(v->loader);
    items_update(v);
    film_step(v);
    const char *failure;
    const paint_result *newest = painter_newest(v->painter, &failure);
    adapt(v, newest);
    schedule(v, newest);
    if (v->stepped) painter_wait(v->painter);
    if (v->waits || v->stepped) newest = painter_newest(v->painter, &failure);
    if (v->stepped && v->posted_whole && newest && newest->ticket == v->posted) v->whole_s = newest->drawn_s;
    if (v->stepped && !failure && !(newest && newest->whole && newest->ticket == v->posted))
        v->posted_whole = false; // it was given up, or nodes of octrees have come: once more
    if (failure) viewer_tell(v, "the picture cannot be drawn: %s", failure);
    v->state.moving = is_moving(v);
    const bool complete = newest && is_complete(v, newest);
    const bool still =
        complete && newest->whole && newest->ticket == v->revision && !v->animated && !v->fly_keys;
    picture->spare_s = v->film.active ? 0 : still && !loader_is_busy(v->loader) ? LATER_S : SOON_S;
    if (!newest) return;
    compose(v, newest);
    v->composed_complete = complete;
    picture->rgba8 = v->composed;
    picture->width_px = newest->width_px;
    picture->height_px = newest->height_px;
    picture->number = v->number;
    picture->still = still;
    picture->level = newest->level;
    picture->splat_count = newest->splat_count;
    picture->drawn_s = newest->drawn_s;
}

bool viewer_is_still(const viewer *v) {
    return !v->film.active && v->number && v->composed_ticket == (v->revision | WHOLE) && v->composed_marks == v->marks &&
           v->composed_complete && !v->animated && !v->fly_keys && !loader_is_busy(v->loader);
}

bool viewer_is_loading(const viewer *v) { return loader_is_busy(v->loader); }

void viewer_get_camera(const viewer *v, ewa_camera *camera) { *camera = v->camera; }

void viewer_get_state(const viewer *v, viewer_state *state) {
    *state = v->state;
    state->flying = v->fly_keys != 0;
    state->free_width = profile_free_width(v);
    state->learns = v->learns;
    state->keyframes = v->film.key_count;
    state->keyframe_at = v->film.at;
    state->previews = v->animated && v->film.previews;
    if (v->film.active) {
        snprintf(state->loading, sizeof state->loading, "%.255s", v->film.path);
        snprintf(state->stage, sizeof state->stage, "frame %u of %u,", v->film.frame + 1, v->film.count);
        state->fraction = (double)v->film.frame / v->film.count;
        state->queued = 0;
        return;
    }
    char path[VIEWER_PATH_BYTES];
    loader_tell(v->loader, path, state->stage, &state->fraction, &state->queued);
    const char *slash = strrchr(path, '/');
    const char *const name = slash ? slash + 1 : path;
    // Orders without a path make the scene.
    snprintf(state->loading, sizeof state->loading, "%.255s", name[0] || !state->stage[0] ? name : "making surfels");
}

bool viewer_open(viewer *v, const char *path) { return items_open(v, path); }

const char *viewer_opened(const viewer *v, uint64_t *number) {
    *number = v->opened_count;
    return v->opened;
}

const char *viewer_said(const viewer *v) { return v->said; }
