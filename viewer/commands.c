// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The language of commands, which keys, panels and scripts speak.
#include "inner.h"
#include "navigate.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WORD_BYTES = 128 };

/// Of a perspective camera that was orthographic before.
static const double DEFAULT_FOV_DEG = 30;

/// The picture's numbers of keys.
static const double NOTCH = 0.85, FIRST_EYE_DOME = 1, FIRST_POINT_PX = 3;

/// Takes the first word off a text; empty at its end.
static const char *take_word(const char *text, char word[WORD_BYTES]) {
    size_t used = 0;
    while (*text == ' ') text++;
    for (; *text && *text != ' '; text++)
        if (used + 1 < WORD_BYTES) word[used++] = *text;
    word[used] = 0;
    while (*text == ' ') text++;
    return text;
}

static bool refuse(viewer *v, const char *command, const char *text, const char *wanted) {
    viewer_tell(v, "%s: '%s' is not %s", command, text, wanted);
    return false;
}

/// Reads "on", "off" or "next".
static bool read_switch(viewer *v, const char *command, const char *text, bool now, bool *value) {
    if (strcmp(text, "on") == 0)
        *value = true;
    else if (strcmp(text, "off") == 0)
        *value = false;
    else if (strcmp(text, "next") == 0)
        *value = !now;
    else
        return refuse(v, command, text, "on, off or next");
    return true;
}

/// Reads the number of an item.
static bool read_item(viewer *v, const char *command, const char *word, size_t *index) {
    char *end;
    errno = 0;
    const unsigned long number = strtoul(word, &end, 10);
    if (!word[0] || *end || errno || word[0] == '-' || number >= v->item_count)
        return refuse(v, command, word, "the number of something that is open");
    *index = number;
    return true;
}

static bool is_ortho(const viewer *v) { return v->camera.projection == EWA_ORTHOGRAPHIC; }
static bool is_eye_dome(const viewer *v) { return v->render.eye_dome > 0; }
static bool is_points(const viewer *v) { return v->render.point_size_px > 0; }
static bool is_box(const viewer *v) { return v->cutaway.box; }
static bool is_slab(const viewer *v) { return v->cutaway.slab; }
static bool is_profile(const viewer *v) { return v->profile.shown; }
static bool is_measuring(const viewer *v) { return v->measures; }
static bool is_help(const viewer *v) { return v->state.help; }
static bool is_panels(const viewer *v) { return v->state.panels; }
static bool is_fullscreen(const viewer *v) { return v->state.fullscreen; }

bool commands_ask(viewer *v, viewer_question question) {
    v->state.question = question;
    return true;
}

void commands_put_away(viewer *v) {
    v->selection.tool = SELECT_OFF;
    v->selection.corner_count = 0;
    v->selection.pressed = false; // the button may be held: an outline that was begun is given up
    v->transform = (viewer_transform){.tool = TRANSFORM_OFF};
    v->measures = v->measures_kind = false;
    v->measuring.count = 0;
    viewer_mark(v);
}

static bool do_open(viewer *v, const char *rest) {
    if (!rest[0]) return commands_ask(v, VIEWER_ASKS_OPEN);
    v->state.question = VIEWER_ASKS_NOTHING;
    return items_open(v, rest);
}

static bool do_scene(viewer *v, const char *rest) {
    if (strcmp(rest, "save") == 0) return commands_ask(v, VIEWER_ASKS_SAVE_SCENE);
    v->state.question = VIEWER_ASKS_NOTHING;
    return shot_scene(v, rest);
}

static bool do_close(viewer *v, const char *rest) {
    size_t index;
    return read_item(v, "close", rest, &index) && items_close(v, index);
}

static bool do_show(viewer *v, const char *rest) {
    char word[WORD_BYTES];
    size_t index;
    rest = take_word(rest, word);
    if (!read_item(v, "show", word, &index) ||
        !read_switch(v, "show", rest, v->items[index].visible, &v->items[index].visible))
        return false;
    items_refresh(v);
    return true;
}

bool commands_take_item(viewer *v, const char *command, const char **rest, size_t *index) {
    char word[WORD_BYTES];
    *rest = take_word(*rest, word);
    return read_item(v, command, word, index);
}

/// Has an item stand at another place of the list.
static bool do_order(viewer *v, const char *rest) {
    size_t from, to;
    if (!commands_take_item(v, "order", &rest, &from) || !commands_take_item(v, "order", &rest, &to)) return false;
    items_move(v, from, to);
    return true;
}

static bool do_name(viewer *v, const char *rest) {
    char word[WORD_BYTES];
    size_t index;
    rest = take_word(rest, word);
    if (!read_item(v, "name", word, &index)) return false;
    snprintf(v->items[index].name, sizeof v->items[index].name, "%s", rest);
    viewer_mark(v);
    return true;
}

static bool do_tint(viewer *v, const char *rest) {
    char word[WORD_BYTES], end;
    size_t index;
    double n[3];
    rest = take_word(rest, word);
    if (!read_item(v, "tint", word, &index)) return false;
    viewer_coloring *wish = &v->items[index].wish;
    const bool none = strcmp(rest, "none") == 0;
    bool fine = none || sscanf(rest, "%lf,%lf,%lf%c", &n[0], &n[1], &n[2], &end) == 3;
    for (int c = 0; c < 3; c++) fine = fine && (none || (n[c] >= 0 && n[c] <= 1));
    if (!fine) return refuse(v, "tint", rest, "r,g,b in [0, 1] or none");
    wish->tinted = !none;
    if (!none) memcpy(wish->tint, n, sizeof n);
    items_recolor(v, index);
    return true;
}

static bool do_alpha(viewer *v, const char *rest) {
    char word[WORD_BYTES], end;
    size_t index;
    double alpha;
    rest = take_word(rest, word);
    if (!read_item(v, "alpha", word, &index)) return false;
    if (sscanf(rest, "%lf%c", &alpha, &end) != 1 || !(alpha >= 0 && alpha <= 1))
        return refuse(v, "alpha", rest, "a number in [0, 1]");
    v->items[index].wish.alpha = alpha;
    items_recolor(v, index);
    return true;
}

/// The words for the colours of numbers are the library's.
static void write_map(ewa_coloring_map map, char word[EWA_OPTION_TEXT_BYTES]) {
    const ewa_coloring coloring = {.map = map};
    ewa_option_get(ewa_option_find(&ewa_coloring_table, "map"), &coloring, word);
}

static bool read_map(const char *word, ewa_coloring_map *map) {
    ewa_coloring coloring;
    const bool fine = ewa_option_set(ewa_option_find(&ewa_coloring_table, "map"), &coloring, word, NULL) == EWA_OK;
    if (fine) *map = coloring.map;
    return fine;
}

/// Colours that item 0 can have, one after another.
static void cycle_color(viewer *v) {
    for (size_t i = 0; i < v->item_count; i++) {
        scene_item *item = &v->items[i];
        char name[EWA_NAME_BYTES + 4];
        uint32_t k = 0;
        if (item->wish.attribute[0]) {
            while (viewer_attribute_at(v, i, k, name) && strcmp(name, item->wish.attribute) != 0) k++;
            k++;
        }
        const bool more = viewer_attribute_at(v, i, k, name) != NULL;
        snprintf(item->wish.attribute, sizeof item->wish.attribute, "%s", more ? name : "");
        item->wish.ranged = item->wish.percent[0] = item->wish.percent[1] = false;
        items_recolor(v, i);
    }
}

static bool do_color(viewer *v, const char *rest) {
    char word[WORD_BYTES], map[WORD_BYTES], end;
    size_t index;
    if (strcmp(rest, "next") == 0) {
        cycle_color(v);
        return true;
    }
    rest = take_word(rest, word);
    if (!read_item(v, "color", word, &index)) return false;
    viewer_coloring wish = v->items[index].wish;
    rest = take_word(rest, word);
    if (!word[0]) return refuse(v, "color", word, "the name of an attribute, auto or none");
    if (strlen(word) >= sizeof wish.attribute) return refuse(v, "color", word, "an attribute");
    snprintf(wish.attribute, sizeof wish.attribute, "%.60s", strcmp(word, "auto") == 0 ? "" : word);
    wish.ranged = wish.percent[0] = wish.percent[1] = false;
    rest = take_word(rest, map);
    if (map[0] && !read_map(map, &wish.map)) return refuse(v, "color", map, "a colour map");
    if (rest[0]) {
        wish.ranged = sscanf(rest, "%lf,%lf%c", &wish.range[0], &wish.range[1], &end) == 2 &&
                      isfinite(wish.range[0]) && isfinite(wish.range[1]);
        if (!wish.ranged) return refuse(v, "color", rest, "a range LOW,HIGH");
    }
    v->items[index].wish = wish;
    items_recolor(v, index);
    return true;
}

static bool do_colormap(viewer *v, const char *rest) {
    for (size_t i = 0; i < v->item_count; i++) {
        ewa_coloring_map *map = &v->items[i].wish.map;
        if (strcmp(rest, "next") == 0)
            *map = (ewa_coloring_map)((*map + 1) % (EWA_COLORING_CLASSES + 1));
        else if (!read_map(rest, map))
            return refuse(v, "colormap", rest, "a colour map or next");
        if (!ewa_coloring_is_own(v->items[i].coloring.attribute)) items_recolor(v, i);
    }
    return true;
}

static bool do_radius(viewer *v, const char *rest) {
    double factor;
    char end;
    if (sscanf(rest, "%lf%c", &factor, &end) != 1 || !(factor > 0.01 && factor < 100))
        return refuse(v, "radius", rest, "a factor");
    for (size_t i = 0; i < v->item_count; i++) {
        double *scale = &v->items[i].wish.radius_scale;
        *scale = fmin(fmax(*scale * factor, 1e-3), 100);
        items_recolor(v, i);
    }
    return true;
}

static bool do_set(viewer *v, const char *rest) {
    char name[WORD_BYTES];
    rest = take_word(rest, name);
    return viewer_setting_set(v, name, rest);
}

/// Steps to the next word of a choice, or turns a switch.
static bool do_next(viewer *v, const char *rest) {
    char now[EWA_OPTION_TEXT_BYTES];
    if (!viewer_setting_get(v, rest, now)) return refuse(v, "next", rest, "a setting");
    if (strcmp(now, "on") == 0) return viewer_setting_set(v, rest, "off");
    if (strcmp(now, "off") == 0) return viewer_setting_set(v, rest, "on");
    const char *group;
    const ewa_option *option = NULL;
    for (uint32_t i = 0; (option = viewer_setting_at(v, i, &group)); i++)
        if (strcmp(option->name, rest) == 0) break;
    if (!option || option->type != EWA_OPTION_CHOICE) return refuse(v, "next", rest, "a choice");
    const char *at = option->words;
    const size_t length = strlen(now);
    while (!(strncmp(at, now, length) == 0 && (at[length] == '|' || !at[length]))) at = strchr(at, '|') + 1;
    at = at[length] ? at + length + 1 : option->words;
    snprintf(now, sizeof now, "%.*s", (int)strcspn(at, "|"), at);
    return viewer_setting_set(v, rest, now);
}

static bool set_number(viewer *v, const char *name, double number) {
    char text[64];
    snprintf(text, sizeof text, "%.17g", number);
    return viewer_setting_set(v, name, text);
}

static bool do_eye_dome(viewer *v, const char *rest) {
    bool on = is_eye_dome(v);
    return read_switch(v, "dome", rest, on, &on) && set_number(v, "eye_dome", on ? FIRST_EYE_DOME : 0);
}

static bool do_points(viewer *v, const char *rest) {
    bool on = is_points(v);
    return read_switch(v, "points", rest, on, &on) &&
           set_number(v, "point_size_px", on ? FIRST_POINT_PX * v->scale : 0);
}

int viewer_view_find(const char *word) {
    for (int i = EWA_VIEW_FRONT; i <= EWA_VIEW_ISO; i++)
        if (strcmp(word, ewa_upright_place(&(ewa_upright){.view = (ewa_named_view)i})) == 0) return i;
    return -1;
}

static bool do_view(viewer *v, const char *rest) {
    const bool reset = strcmp(rest, "reset") == 0;
    if (!reset && viewer_view_find(rest) < 0)
        return refuse(v, "view", rest, "front, back, left, right, top, bottom, iso or reset");
    items_place(v, reset ? NULL : rest, true);
    return true;
}

static bool do_mode(viewer *v, const char *rest) { return viewer_setting_set(v, "navigation", rest); }

static bool do_ortho(viewer *v, const char *rest) {
    bool ortho = is_ortho(v);
    if (!read_switch(v, "ortho", rest, ortho, &ortho)) return false;
    v->animated = false;
    v->placed = true;
    navigate_set_ortho(&v->camera, ortho, v->pivot_world, DEFAULT_FOV_DEG);
    viewer_change(v);
    return true;
}

static bool do_focus(viewer *v, const char *rest) {
    (void)rest;
    double place_world[3];
    if (!pick_surface(v, v->x, v->y, 24, place_world)) return true;
    memcpy(v->pivot_world, place_world, sizeof place_world);
    ewa_camera to = v->camera;
    navigate_center(&to, place_world);
    v->placed = true;
    viewer_go(v, &to);
    return true;
}

static bool do_zoom(viewer *v, const char *rest) {
    double notches;
    char end;
    if (sscanf(rest, "%lf%c", &notches, &end) != 1 || !(fabs(notches) <= 100))
        return refuse(v, "zoom", rest, "a number of notches");
    v->placed = true;
    v->animated = false;
    navigate_zoom(&v->camera, v->pivot_world, pow(NOTCH, notches));
    viewer_change(v);
    return true;
}

static bool do_turn(viewer *v, const char *rest) {
    double right_deg, down_deg;
    char end;
    if (sscanf(rest, "%lf %lf%c", &right_deg, &down_deg, &end) != 2 || !(fabs(right_deg) <= 360 && fabs(down_deg) <= 360))
        return refuse(v, "turn", rest, "two numbers of degrees, to the right and down");
    v->placed = true;
    v->animated = false;
    const bool trackball = v->settings.navigation == NAVIGATION_TRACKBALL;
    navigate_orbit(&v->camera, v->pivot_world, trackball ? NULL : v->up_world, right_deg, down_deg);
    viewer_change(v);
    return true;
}

static bool do_section(viewer *v, const char *what, const char *rest) {
    const bool on = strcmp(what, "box") == 0 ? v->cutaway.box : v->cutaway.slab;
    return cutaway_set(v, what, strcmp(rest, "next") == 0 ? (on ? "off" : "on") : rest);
}

static bool do_box(viewer *v, const char *rest) { return do_section(v, "box", rest); }
static bool do_slab(viewer *v, const char *rest) { return do_section(v, "slab", rest); }

/// One thing at a time: what lies on top first.
static bool do_cancel(viewer *v, const char *rest) {
    (void)rest;
    const bool asks = v->state.question != VIEWER_ASKS_NOTHING, help = v->state.help;
    v->state.question = VIEWER_ASKS_NOTHING;
    if (asks) return true;
    v->state.help = false;
    if (help) return true;
    v->state.message[0] = v->state.note[0] = 0;
    const bool films = v->film.active;
    film_free(v);
    if (films) return true;
    const bool picked = v->picks[0].given;
    if (items_cancel(v)) {
        viewer_note(v, "loading was given up");
    } else if (v->transform.tool) {
        v->transform = (viewer_transform){.tool = TRANSFORM_OFF};
        viewer_mark(v);
    } else if (v->selection.tool || v->selection.given) {
        v->selection.tool = SELECT_OFF;
        select_clear(v);
    } else if (picked) {
        pick_clear(v);
    } else {
        v->measures = v->measures_kind = false;
    }
    return true;
}

static bool do_measure(viewer *v, const char *rest) {
    const bool is_switch = strcmp(rest, "on") == 0 || strcmp(rest, "off") == 0 || strcmp(rest, "next") == 0;
    const bool before = v->measures;
    if (is_switch) commands_put_away(v);
    if (is_switch) v->measures = before;
    return is_switch ? read_switch(v, "measure", rest, v->measures, &v->measures) : measures_command(v, rest);
}

static bool do_clear(viewer *v, const char *rest) {
    (void)rest;
    pick_clear(v);
    select_clear(v);
    return true;
}

static bool do_help(viewer *v, const char *rest) {
    v->learns = NULL; // the help is where one is asked for
    return read_switch(v, "help", rest, v->state.help, &v->state.help);
}

static bool do_panels(viewer *v, const char *rest) {
    return read_switch(v, "panels", rest, v->state.panels, &v->state.panels);
}

static bool do_fullscreen(viewer *v, const char *rest) {
    return read_switch(v, "fullscreen", rest, v->state.fullscreen, &v->state.fullscreen);
}

static bool do_quit(viewer *v, const char *rest) {
    (void)rest;
    v->state.quit = true;
    return true;
}

static const struct {
    const char *name;
    bool (*run)(viewer *v, const char *rest);
    bool (*is_on)(const viewer *v); ///< of switches
    bool (*holds)(const viewer *v, const char *rest); ///< whether the hand holds the tool that the rest names
} commands[] = {
    {"open", do_open, NULL, NULL},
    {"close", do_close, NULL, NULL},
    {"show", do_show, NULL, NULL},
    {"name", do_name, NULL, NULL},
    {"order", do_order, NULL, NULL},
    {"move", transform_move, NULL, NULL},
    {"rotate", transform_turn, NULL, NULL},
    {"scale", transform_scale, NULL, NULL},
    {"photos", photos_do, NULL, NULL},
    {"transfer", transfers_command, NULL, NULL},
    {"transform", transform_command, NULL, transform_holds},
    {"tint", do_tint, NULL, NULL},
    {"alpha", do_alpha, NULL, NULL},
    {"color", do_color, NULL, NULL},
    {"colormap", do_colormap, NULL, NULL},
    {"radius", do_radius, NULL, NULL},
    {"set", do_set, NULL, NULL},
    {"next", do_next, NULL, NULL},
    {"dome", do_eye_dome, is_eye_dome, NULL},
    {"points", do_points, is_points, NULL},
    {"view", do_view, NULL, NULL},
    {"mode", do_mode, NULL, NULL},
    {"ortho", do_ortho, is_ortho, NULL},
    {"focus", do_focus, NULL, NULL},
    {"zoom", do_zoom, NULL, NULL},
    {"turn", do_turn, NULL, NULL},
    {"box", do_box, is_box, NULL},
    {"slab", do_slab, is_slab, NULL},
    {"measure", do_measure, is_measuring, measures_holds},
    {"camera", shot_camera, NULL, NULL},
    {"shot", shot_command, NULL, NULL},
    {"keyframe", film_keyframe, NULL, NULL},
    {"film", film_command, NULL, NULL},
    {"scene", do_scene, NULL, NULL},
    {"cancel", do_cancel, NULL, NULL},
    {"clear", do_clear, NULL, NULL},
    {"keys", actions_keys, NULL, NULL},
    {"help", do_help, is_help, NULL},
    {"panels", do_panels, is_panels, NULL},
    {"profile", profile_do, is_profile, NULL},
    {"select", select_command, NULL, select_holds},
    {"hide", select_hide, NULL, NULL},
    {"keep", select_keep, NULL, NULL},
    {"unhide", select_unhide, NULL, NULL},
    {"cut", select_cut, NULL, NULL},
    {"undo", history_undo, NULL, NULL},
    {"redo", history_redo, NULL, NULL},
    {"fullscreen", do_fullscreen, is_fullscreen, NULL},
    {"quit", do_quit, NULL, NULL},
};

enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };

/// Finds the command of a line; COMMAND_COUNT: there is none. `rest`: what follows its name.
static size_t find_command(const char *line, char word[WORD_BYTES], const char **rest) {
    *rest = take_word(line, word);
    size_t i = 0;
    while (i < COMMAND_COUNT && strcmp(word, commands[i].name) != 0) i++;
    return i;
}

bool viewer_do(viewer *v, const char *command) {
    char word[WORD_BYTES];
    const char *rest;
    const size_t i = find_command(command, word, &rest);
    if (i < COMMAND_COUNT) {
        const bool changes = commands[i].run != history_undo && commands[i].run != history_redo;
        if (changes) history_begin(v);
        const bool done = commands[i].run(v, rest);
        if (changes) history_end(v);
        return done;
    }
    viewer_tell(v, "there is no command '%s'", word);
    return false;
}

bool viewer_action_is_lit(const viewer *v, const viewer_action *action) {
    char word[WORD_BYTES];
    const char *rest;
    bool on;
    const size_t i = find_command(action->command, word, &rest);
    if (i < COMMAND_COUNT && commands[i].holds && commands[i].holds(v, rest)) return true;
    return viewer_action_is_switch(v, action, &on) && on;
}

bool viewer_action_is_switch(const viewer *v, const viewer_action *action, bool *on) {
    char word[WORD_BYTES], value[EWA_OPTION_TEXT_BYTES];
    const char *rest;
    const size_t i = find_command(action->command, word, &rest);
    if (i < COMMAND_COUNT && commands[i].is_on && strcmp(rest, "next") == 0) {
        *on = commands[i].is_on(v);
        return true;
    }
    if (strcmp(word, "next") != 0 || !viewer_setting_get(v, rest, value)) return false;
    *on = strcmp(value, "on") == 0;
    return *on || strcmp(value, "off") == 0;
}

bool commands_value(const viewer *v, const viewer_action *action, char text[EWA_OPTION_TEXT_BYTES]) {
    char word[WORD_BYTES];
    const char *rest;
    bool on;
    (void)find_command(action->command, word, &rest);
    const viewer_coloring *first = v->item_count ? &v->items[0].wish : NULL;
    const char *said = NULL;
    char map[EWA_OPTION_TEXT_BYTES];
    if (viewer_action_is_switch(v, action, &on))
        said = on ? "on" : "off";
    else if (strcmp(word, "color") == 0 && first)
        said = first->attribute[0] ? first->attribute : "automatic";
    else if (strcmp(word, "colormap") == 0 && first)
        write_map(first->map, map), said = map;
    if (said) {
        snprintf(text, EWA_OPTION_TEXT_BYTES, "%s", said);
        return true;
    }
    if (strcmp(word, "radius") == 0 && first) {
        snprintf(text, EWA_OPTION_TEXT_BYTES, "%.3g times", first->radius_scale);
        return true;
    }
    return strcmp(word, "next") == 0 && viewer_setting_get(v, rest, text);
}
