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
    {"File", "Copy camera", "camera copy", "copy the camera as the JSON that --camera reads", 'c', CTRL,
     VIEWER_ICON_NONE},
    {"File", "Paste camera", "camera paste", "look from where a copied camera is", 'v', CTRL, VIEWER_ICON_NONE},
    {"File", "Quit", "quit", "end", 'q', CTRL, VIEWER_ICON_NONE},

    {"Edit", "Undo", "undo", "as it was before the last change; cameras stay", 'z', CTRL, VIEWER_ICON_NONE},
    {"Edit", "Redo", "redo", "the change that was undone, again", 'y', CTRL, VIEWER_ICON_NONE},

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
    {"Tools", "Measure an area", "measure area", "measure an area by clicks around it; a double click ends", 0, 0, VIEWER_ICON_AREA},
    {"Tools", "Measure a way", "measure distance", "measure a way by clicks along it; a double click ends", 0, 0, VIEWER_ICON_WAY},
    {"Tools", "Clip box", "box next", "clip box around everything, whose sides can be dragged", 'c', 0, VIEWER_ICON_BOX},
    {"Tools", "Slab", "slab next", "slab across the view; Alt wheel moves it", 'v', 0, VIEWER_ICON_SLAB},
    {"Tools", "Profile", "profile next", "profile along what was measured", 'r', 0, VIEWER_ICON_PROFILE},
    {"Tools", "Select by rectangle", "select rectangle", "draw a rectangle around points", 'u', 0, VIEWER_ICON_RECTANGLE},
    {"Tools", "Select by lasso", "select lasso", "draw a line around points", 'u', CTRL, VIEWER_ICON_LASSO},
    {"Tools", "Select by polygon", "select polygon", "click corners around points; a double click closes", 'j', 0,
     VIEWER_ICON_POLYGON},
    {"Tools", "Hide", "hide", "hide the selected points", 'i', 0, VIEWER_ICON_HIDE},
    {"Tools", "Keep", "keep", "show the selected points alone", 'i', CTRL, VIEWER_ICON_KEEP},
    {"Tools", "Show all", "unhide", "show all that was hidden", 'o', 0, VIEWER_ICON_SHOW},
    {"Tools", "Move", "transform move", "drag something to another place, as far away as it is", 0, 0, VIEWER_ICON_MOVE},
    {"Tools", "Turn", "transform turn", "drag to turn something about what is up", 0, 0, VIEWER_ICON_TURN},
    {"Tools", "Resize", "transform scale", "drag up or down to make something larger or smaller", 0, 0, VIEWER_ICON_SCALE},
    {"Tools", "Keyframe", "keyframe add", "keep this view as the next keyframe", 0, 0, VIEWER_ICON_KEYFRAME},
    {"Tools", "Film", "film", "make a film through the keyframes, ewa-0001.mp4 and so on", 0, 0, VIEWER_ICON_FILM},
    {"Tools", "Forget picks", "clear", "forget picks, measures and the selection", VIEWER_KEY_DELETE, 0, VIEWER_ICON_CLEAR},
    {"Tools", "Give up", "cancel", "close help or dialog; else give up film or loading; else forget selection, then picks", VIEWER_KEY_ESCAPE, 0,
     VIEWER_ICON_NONE},

    {"Help", "Keys", "help next", "all keys", 'h', 0, VIEWER_ICON_HELP},
};

const viewer_action *viewer_action_at(uint32_t index) {
    return index < sizeof actions / sizeof actions[0] ? &actions[index] : NULL;
}

void viewer_action_keys(const viewer_action *action, char text[VIEWER_KEYS_BYTES]) {
    static const struct {
        int key;
        const char *name;
    } named[] = {{VIEWER_KEY_ENTER, "Enter"}, {VIEWER_KEY_ESCAPE, "Escape"}, {VIEWER_KEY_DELETE, "Delete"},
                 {'\t', "Tab"},               {VIEWER_KEY_LEFT, "Left"},     {VIEWER_KEY_RIGHT, "Right"},
                 {VIEWER_KEY_UP, "Up"},       {VIEWER_KEY_DOWN, "Down"}};
    const int key = action->key;
    const char *ctrl = action->modifiers & VIEWER_CTRL ? "Ctrl " : "";
    text[0] = 0;
    for (size_t i = 0; i < sizeof named / sizeof named[0]; i++)
        if (named[i].key == key) snprintf(text, VIEWER_KEYS_BYTES, "%s%s", ctrl, named[i].name);
    if (text[0] || !key) return;
    if (key >= VIEWER_KEY_F1 && key <= VIEWER_KEY_F12)
        snprintf(text, VIEWER_KEYS_BYTES, "%sF%d", ctrl, key - F);
    else
        snprintf(text, VIEWER_KEYS_BYTES, "%s%c", ctrl, key >= 'a' && key <= 'z' ? key - 'a' + 'A' : key);
}

bool viewer_help_at(uint32_t index, viewer_help *row) {
    const uint32_t gesture_count = sizeof gestures / sizeof gestures[0];
    if (index < gesture_count) {
        *row = (viewer_help){.what = gestures[index].help};
        snprintf(row->keys, sizeof row->keys, "%s", gestures[index].gesture);
        return true;
    }
    index -= gesture_count;
    const viewer_action *action;
    for (uint32_t i = 0; (action = viewer_action_at(i)); i++) {
        if (!action->menu || !action->key || index-- > 0) continue;
        *row = (viewer_help){.menu = action->menu, .what = action->help};
        char keys[VIEWER_KEYS_BYTES];
        viewer_action_keys(action, keys);
        snprintf(row->keys, sizeof row->keys, "%s", keys);
        return true;
    }
    return false;
}

bool viewer_act(viewer *v, const viewer_action *action) {
    if (!viewer_do(v, action->command)) return false;
    char value[EWA_OPTION_TEXT_BYTES];
    if (action->label && commands_value(v, action, value)) viewer_note(v, "%s: %s", action->label, value);
    return true;
}
