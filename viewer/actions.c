// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a person can have done, said once: keys, menus, the toolbar, the help and docs/viewer.md are made of these rows.
#include "inner.h"

#include <stdio.h>
#include <string.h>

static const struct {
    const char *gesture, *help;
} gestures[] = {
    {"drag", "turn about what is under the pointer (fly: look around)"},
    {"right drag, Shift drag", "move along; what was grasped stays under the hand"},
    {"wheel, pinch, Ctrl drag", "nearer and farther, to what is under the pointer"},
    {"click", "pick the point that is seen there: number, coordinates, attributes"},
    {"Shift click", "measure from the pick before"},
    {"double click", "bring what is there into the middle"},
    {"W A S D Q E", "fly, where the navigation says so; the wheel makes it faster"},
    {"drag a side of the clip box", "move it; with Ctrl, turn the box about what is up"},
    {"Alt wheel", "move the slab; with Ctrl, make it thicker"},
};

enum { F = VIEWER_KEY_F1 - 1, CTRL = VIEWER_CTRL };

/// Rows of a menu follow each other. A row without a menu is another key of a command.
static const viewer_action actions[] = {
    {"File", "Open...", "open", "open a cloud, a mesh, a volume, Gaussians or a scene file", 'o', CTRL, VIEWER_ICON_OPEN},
    {"File", "Save scene...", "scene save", "save what is open and how it is shown as a scene file", 's', CTRL,
     VIEWER_ICON_NONE},
    {"File", "Save picture", "shot", "save the picture as ewa-0001.png and so on", F + 12, 0, VIEWER_ICON_PICTURE},
    {"File", "Save without background", "shot transparent", "save the picture with a transparent background", F + 12,
     CTRL, VIEWER_ICON_NONE},
    {"File", "Save selection...", "cut", "write what is selected to a file, with all that its file says of it", 0, 0, VIEWER_ICON_NONE},
    {"File", "Save measurements...", "measure save", "write measurements and notes to a table (.csv)", 0, 0, VIEWER_ICON_NONE},
    {"File", "Save profile...", "profile save", "write the profile's graph (.png, .jpg) or its points (.csv, .las, ...)", 0, 0, VIEWER_ICON_NONE},
    {"File", "Copy camera", "camera copy", "copy the camera as the JSON that --camera reads", 'c', CTRL,
     VIEWER_ICON_NONE},
    {"File", "Paste camera", "camera paste", "look from where a copied camera is", 'v', CTRL, VIEWER_ICON_NONE},
    {"File", "Quit", "quit", "end", 'q', CTRL, VIEWER_ICON_NONE},

    {"Edit", "Undo", "undo", "as it was before the last change; cameras stay", 'z', CTRL, VIEWER_ICON_UNDO},
    {"Edit", "Redo", "redo", "the change that was undone, again", 'y', CTRL, VIEWER_ICON_REDO},

    {"View", "Home", "view reset", "all of it, as at first", VIEWER_KEY_ENTER, 0, VIEWER_ICON_HOME},
    {"View", "Front", "view front", "from the front", '1', 0, VIEWER_ICON_FRONT},
    {"View", "Back", "view back", "from the back", '1', CTRL, VIEWER_ICON_NONE},
    {"View", "Right", "view right", "from the right", '3', 0, VIEWER_ICON_RIGHT},
    {"View", "Left", "view left", "from the left", '3', CTRL, VIEWER_ICON_NONE},
    {"View", "Top", "view top", "from above", '7', 0, VIEWER_ICON_TOP},
    {"View", "Bottom", "view bottom", "from below", '7', CTRL, VIEWER_ICON_NONE},
    {"View", "Corner", "view iso", "from a corner", '9', 0, VIEWER_ICON_CORNER},
    {"View", "Orthographic", "ortho next", "orthographic or perspective", '5', 0, VIEWER_ICON_ORTHO},
    {"View", "Focus", "focus", "turn about what is under the pointer, in the middle", 'f', 0, VIEWER_ICON_NONE},
    {"View", "Navigation", "next navigation", "turntable, trackball or fly", 'k', 0, VIEWER_ICON_NONE},
    {"View", "Nearer", "zoom 1", "nearer", '+', 0, VIEWER_ICON_NONE},
    {NULL, NULL, "zoom 1", NULL, '=', 0, VIEWER_ICON_NONE},
    {"View", "Farther", "zoom -1", "farther", '-', 0, VIEWER_ICON_NONE},
    {"View", "Turn left", "turn -5 0", "turn by five degrees", VIEWER_KEY_LEFT, 0, VIEWER_ICON_NONE},
    {"View", "Turn right", "turn 5 0", "turn by five degrees", VIEWER_KEY_RIGHT, 0, VIEWER_ICON_NONE},
    {"View", "Turn up", "turn 0 -5", "turn by five degrees", VIEWER_KEY_UP, 0, VIEWER_ICON_NONE},
    {"View", "Turn down", "turn 0 5", "turn by five degrees", VIEWER_KEY_DOWN, 0, VIEWER_ICON_NONE},
    {"View", "Full screen", "fullscreen next", "the whole screen, or a window", F + 11, 0, VIEWER_ICON_NONE},
    {"View", "Panels", "panels next", "show or hide bars and panels", '\t', 0, VIEWER_ICON_NONE},

    {"Look", "Colours", "color next", "colours: the file's, then each attribute", 's', 0, VIEWER_ICON_NONE},
    {"Look", "Colour map", "colormap next", "the next colour map", 'm', 0, VIEWER_ICON_NONE},
    {"Look", "Colour bar", "next color_bar", "the numbers of the colours, at the side", 'b', 0, VIEWER_ICON_NONE},
    {"Look", "Photographs...", "photos", "colours from photographs, whose cameras are chosen", 'y', 0, VIEWER_ICON_PHOTOS},
    {"Look", "Shading", "next shading", "shading: none, lambert or phong", 'l', 0, VIEWER_ICON_NONE},
    {"Look", "Eye-dome lighting", "dome next", "eye-dome lighting: darker where depths step", 'e', 0, VIEWER_ICON_NONE},
    {"Look", "Kernel", "next kernel", "the next kernel of splats", 'n', 0, VIEWER_ICON_NONE},
    {"Look", "Points", "points next", "points in place of surfels", 'p', 0, VIEWER_ICON_NONE},
    {"Look", "Smaller surfels", "radius 0.8", "smaller surfels", '[', 0, VIEWER_ICON_NONE},
    {"Look", "Larger surfels", "radius 1.25", "larger surfels", ']', 0, VIEWER_ICON_NONE},
    {"Look", "Axes", "next axes", "axes in the corner", 'x', 0, VIEWER_ICON_NONE},
    {"Look", "Scale bar", "next scale_bar", "a length of the scene in the corner", 'g', 0, VIEWER_ICON_NONE},

    {"Tools", "Measure", "measure next", "every second click measures from the one before, as Shift click does at any time", 't',
     0, VIEWER_ICON_MEASURE},
    {"Tools", "Measure a height", "measure height", "measure a height by two clicks", 't', CTRL, VIEWER_ICON_HEIGHT},
    {"Tools", "Measure an angle", "measure angle", "measure an angle by three clicks", 0, 0, VIEWER_ICON_ANGLE},
    {"Tools", "Measure an area", "measure area", "measure an area by clicks around it; a double click or Enter ends", 0, 0, VIEWER_ICON_AREA},
    {"Tools", "Measure a way", "measure distance", "measure a way by clicks along it; a double click or Enter ends", 0, 0, VIEWER_ICON_WAY},
    {"Tools", "Annotate", "measure note", "write a text at a place: click there, then name it in the panel", 0, 0, VIEWER_ICON_NOTE},
    {"Tools", "Clip box", "box next", "clip box around everything, whose sides can be dragged", 'c', 0, VIEWER_ICON_BOX},
    {"Tools", "Clip box across the view", "box view", "clip box whose sides are those of the picture", 'c', VIEWER_ALT, VIEWER_ICON_NONE},
    {"Tools", "Slab", "slab next", "slab across the view; Alt wheel moves it", 'v', 0, VIEWER_ICON_SLAB},
    {"Tools", "Profile", "profile next", "profile along what was measured", 'r', 0, VIEWER_ICON_PROFILE},
    {"Tools", "Select by rectangle", "select rectangle", "draw a rectangle around points", 'u', 0, VIEWER_ICON_RECTANGLE},
    {"Tools", "Select by lasso", "select lasso", "draw a line around points", 'u', CTRL, VIEWER_ICON_LASSO},
    {"Tools", "Select by polygon", "select polygon", "click corners around points; a double click or Enter closes", 'j', 0,
     VIEWER_ICON_POLYGON},
    {"Tools", "Select in the clip box", "select box clip", "what is in the clip box", 0, 0, VIEWER_ICON_NONE},
    {"Tools", "Hide", "hide", "hide the selected points", 'i', 0, VIEWER_ICON_HIDE},
    {"Tools", "Keep", "keep", "show the selected points alone", 'i', CTRL, VIEWER_ICON_KEEP},
    {"Tools", "Show all", "unhide", "show all that was hidden", 'o', 0, VIEWER_ICON_SHOW},
    {"Tools", "Move", "transform move", "drag something to another place, as far away as it is", 0, 0, VIEWER_ICON_MOVE},
    {"Tools", "Turn", "transform turn", "drag to turn something about what is up", 0, 0, VIEWER_ICON_TURN},
    {"Tools", "Resize", "transform scale", "drag up or down to make something larger or smaller", 0, 0, VIEWER_ICON_SCALE},
    {"Tools", "Keyframe", "keyframe add", "keep this view as the next keyframe", 0, 0, VIEWER_ICON_KEYFRAME},
    {"Tools", "Preview the film", "film preview", "let the camera travel through the keyframes", 0, 0, VIEWER_ICON_NONE},
    {"Tools", "Film", "film", "make a film through the keyframes, ewa-0001.mp4 and so on", 0, 0, VIEWER_ICON_FILM},
    {"Tools", "Forget picks", "clear", "forget picks, measures and the selection", VIEWER_KEY_DELETE, 0, VIEWER_ICON_CLEAR},
    {"Tools", "Give up", "cancel", "close help or dialog; else give up film or loading; else forget selection, then picks", VIEWER_KEY_ESCAPE, 0,
     VIEWER_ICON_NONE},

    {"Help", "Keys", "help next", "all keys", 'h', 0, VIEWER_ICON_HELP},
};

enum { ACTION_COUNT = sizeof actions / sizeof actions[0] };
_Static_assert((int)ACTION_COUNT <= (int)VIEWER_MAX_ACTIONS, "each action has room for a key");

const viewer_action *viewer_action_at(uint32_t index) { return index < ACTION_COUNT ? &actions[index] : NULL; }

bool viewer_action_begins_group(const viewer_action *action) {
    static const char *const first[] = {"scene save", "cut", "camera copy", "quit", "ortho next", "zoom 1", "turn -5 0", "fullscreen next", "photos",
                                        "radius 0.8", "next axes", "box next", "select rectangle", "hide", "transform move", "keyframe add", "clear"};
    for (size_t i = 0; i < sizeof first / sizeof first[0]; i++)
        if (strcmp(action->command, first[i]) == 0) return action->menu != NULL;
    return false;
}

static const struct {
    int key;
    const char *name;
} named[] = {{VIEWER_KEY_ENTER, "Enter"}, {VIEWER_KEY_ESCAPE, "Escape"}, {VIEWER_KEY_DELETE, "Delete"},
             {'\t', "Tab"},               {VIEWER_KEY_LEFT, "Left"},     {VIEWER_KEY_RIGHT, "Right"},
             {VIEWER_KEY_UP, "Up"},       {VIEWER_KEY_DOWN, "Down"},     {' ', "Space"}};

enum { NAMED_COUNT = sizeof named / sizeof named[0] };

/// Writes a key's name, with `between` behind Ctrl and Alt.
static void write_key(viewer_key key, char between, char text[VIEWER_KEYS_BYTES]) {
    char name[8] = "";
    text[0] = 0;
    if (!key.key) return;
    for (int i = 0; i < NAMED_COUNT; i++)
        if (named[i].key == key.key) snprintf(name, sizeof name, "%s", named[i].name);
    if (!name[0] && key.key >= VIEWER_KEY_F1 && key.key <= VIEWER_KEY_F12)
        snprintf(name, sizeof name, "F%d", key.key - F);
    else if (!name[0])
        snprintf(name, sizeof name, "%c", key.key >= 'a' && key.key <= 'z' ? key.key - 'a' + 'A' : key.key);
    snprintf(text, VIEWER_KEYS_BYTES, "%s%.*s%s%.*s%s", key.modifiers & CTRL ? "Ctrl" : "", (key.modifiers & CTRL) != 0, &between,
             key.modifiers & VIEWER_ALT ? "Alt" : "", (key.modifiers & VIEWER_ALT) != 0, &between, name);
}

/// Reads what write_key() writes, with + between.
static bool read_key(const char *text, viewer_key *key) {
    *key = (viewer_key){.chosen = true};
    if (strcmp(text, "none") == 0) return true;
    if (strncmp(text, "Ctrl+", 5) == 0) key->modifiers |= CTRL, text += 5;
    if (strncmp(text, "Alt+", 4) == 0) key->modifiers |= VIEWER_ALT, text += 4;
    char end;
    int number;
    for (int i = 0; i < NAMED_COUNT; i++)
        if (strcmp(named[i].name, text) == 0) key->key = named[i].key;
    if (!key->key && sscanf(text, "F%d%c", &number, &end) == 1 && number >= 1 && number <= 12) key->key = F + number;
    if (!key->key && text[0] > ' ' && text[0] < 127 && !text[1])
        key->key = text[0] >= 'A' && text[0] <= 'Z' ? text[0] - 'A' + 'a' : text[0];
    return key->key != 0;
}

viewer_key actions_key(const viewer *v, const viewer_action *action) {
    if (v && action >= actions && action < actions + ACTION_COUNT && v->keys[action - actions].chosen) return v->keys[action - actions];
    return (viewer_key){.key = action->key, .modifiers = action->modifiers};
}

void actions_set_key(viewer *v, const viewer_action *action, int key, uint32_t modifiers) {
    for (size_t i = 0; i < ACTION_COUNT && key; i++) {
        const viewer_key other = actions_key(v, &actions[i]);
        if (other.key == key && other.modifiers == modifiers) v->keys[i] = (viewer_key){.chosen = true};
    }
    v->keys[action - actions] = (viewer_key){true, key, modifiers};
    if (key == action->key && modifiers == action->modifiers) v->keys[action - actions].chosen = false;
    v->learns = NULL;
}

/// The row of a command; NULL: there is none.
static const viewer_action *find_row(const char *command) {
    for (size_t i = 0; i < ACTION_COUNT; i++)
        if (actions[i].menu && strcmp(actions[i].command, command) == 0) return &actions[i];
    return NULL;
}

bool actions_keys(viewer *v, const char *rest) {
    char word[VIEWER_KEYS_BYTES] = "";
    int behind = 0;
    viewer_key key;
    if (strcmp(rest, "default") == 0) {
        memset(v->keys, 0, sizeof v->keys);
        return true;
    }
    const bool told = sscanf(rest, "%15s %n", word, &behind) == 1 && rest[behind];
    const viewer_action *action = told ? find_row(rest + behind) : NULL;
    if (action && strcmp(word, "learn") == 0) {
        v->learns = action;
        return true;
    }
    if (action && read_key(word, &key)) {
        actions_set_key(v, action, key.key, key.modifiers);
        return true;
    }
    viewer_tell(v, "keys: '%s' is neither default nor KEY COMMAND, a key such as Ctrl+K, F5 or Enter, none, or learn, and a row of the menus", rest);
    return false;
}

void viewer_action_keys(const viewer *v, const viewer_action *action, char text[VIEWER_KEYS_BYTES]) {
    write_key(actions_key(v, action), ' ', text);
}

bool viewer_action_choice(const viewer *v, const viewer_action *action, char text[VIEWER_TEXT_BYTES]) {
    const viewer_key key = actions_key(v, action);
    char keys[VIEWER_KEYS_BYTES];
    write_key(key, '+', keys);
    if (key.chosen && action->menu) snprintf(text, VIEWER_TEXT_BYTES, "keys %s %s", keys[0] ? keys : "none", action->command);
    return key.chosen && action->menu;
}

bool viewer_help_at(const viewer *v, uint32_t index, viewer_help *row) {
    const uint32_t gesture_count = sizeof gestures / sizeof gestures[0];
    if (index < gesture_count) {
        *row = (viewer_help){.heading = "Mouse", .what = gestures[index].help};
        snprintf(row->keys, sizeof row->keys, "%s", gestures[index].gesture);
        return true;
    }
    index -= gesture_count;
    const viewer_action *action;
    for (uint32_t i = 0; (action = viewer_action_at(i)); i++) {
        if (!action->menu || !(action->key || actions_key(v, action).key) || index-- > 0) continue;
        *row = (viewer_help){.action = action, .heading = action->menu, .what = action->help};
        char keys[VIEWER_KEYS_BYTES];
        viewer_action_keys(v, action, keys);
        snprintf(row->keys, sizeof row->keys, "%s", keys);
        return true;
    }
    return false;
}

bool viewer_act(viewer *v, const viewer_action *action) {
    if (!viewer_do(v, action->command)) return false;
    char value[EWA_OPTION_TEXT_BYTES];
    if (!action->label || !commands_value(v, action, value)) return true;
    const bool nothing = strcmp(action->command, "next color_bar") == 0 && v->furniture.color_bar && !overlay_has_color_bar(v);
    viewer_note(v, "%s: %s%s", action->label, value, nothing ? ", once something has the colours of an attribute" : "");
    return true;
}
