// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a person can have done: each key does one thing, and docs/viewer.md says what the table of actions says.
#include "check.h"
#include "view_contents.h"
#include "viewer/viewer.h"

enum { TEXT_BYTES = 1 << 16 };

TEST(keys_do_one_thing) {
    const viewer_action *one, *other;
    for (uint32_t i = 0; (one = viewer_action_at(i)); i++)
        for (uint32_t k = 0; k < i && (other = viewer_action_at(k)); k++)
            if (one->key && one->key == other->key && one->modifiers == other->modifiers)
                fail_msg("%s and %s have one key", one->command, other->command);
}

TEST(rows_of_menus_are_whole) {
    const viewer_action *action;
    for (uint32_t i = 0; (action = viewer_action_at(i)); i++) {
        if (!action->menu) {
            assert_int_equal(action->icon, VIEWER_ICON_NONE);
            continue;
        }
        assert_true(action->label[0] && action->help[0] && action->command[0]);
    }
    char keys[VIEWER_KEYS_BYTES];
    viewer_action_keys(NULL, &(viewer_action){.key = VIEWER_KEY_F12, .modifiers = VIEWER_CTRL}, keys);
    assert_string_equal(keys, "Ctrl F12");
    viewer_action_keys(NULL, &(viewer_action){.key = '['}, keys);
    assert_string_equal(keys, "[");
    viewer_action_keys(NULL, &(viewer_action){.key = 0}, keys);
    assert_string_equal(keys, "");
}

/// The table of docs/viewer.md.
static void write_table(char text[TEXT_BYTES]) {
    size_t used = (size_t)snprintf(text, TEXT_BYTES,
                                    "| menu | row or gesture | key | does | command |\n|---|---|---|---|---|\n");
    viewer_help row;
    for (uint32_t i = 0; viewer_help_at(NULL, i, &row) && !row.action; i++)
        used += (size_t)snprintf(text + used, TEXT_BYTES - used, "| | %s | | %s | |\n", row.keys, row.what);
    const char *before = "";
    const viewer_action *action;
    for (uint32_t i = 0; (action = viewer_action_at(i)); i++) {
        if (!action->menu) continue;
        char keys[VIEWER_KEYS_BYTES];
        viewer_action_keys(NULL, action, keys);
        used += (size_t)snprintf(text + used, TEXT_BYTES - used, "| %s | %s | %s | %s | `%s` |\n",
                                 strcmp(before, action->menu) != 0 ? action->menu : "", action->label, keys, action->help,
                                 action->command);
        before = action->menu;
    }
}

TEST(docs_say_the_same) {
    static char wanted[TEXT_BYTES], docs[TEXT_BYTES];
    write_table(wanted);
    FILE *file = fopen(DOCS_PATH, "r");
    assert_non_null(file);
    docs[fread(docs, 1, sizeof docs - 1, file)] = 0;
    assert_int_equal(fclose(file), 0);
    if (strstr(docs, wanted)) return;
    file = fopen("viewer_actions.md", "w");
    assert_true(file && fputs(wanted, file) >= 0 && fclose(file) == 0);
    fail_msg("the table of docs/viewer.md is not that of viewer_actions.md, in this folder");
}

/// A viewer of nothing.
static viewer *make_viewer(void) {
    static view_contents contents;
    return view_contents_viewer(&contents);
}

static const viewer_action *find(const char *command) {
    const viewer_action *action;
    for (uint32_t i = 0; (action = viewer_action_at(i)); i++)
        if (strcmp(action->command, command) == 0) return action;
    fail_msg("there is no action %s", command);
    return NULL;
}

/// Switches say how they are, and what was done is noted.
TEST(actions_are_noted) {
    viewer *v = make_viewer();
    viewer_state now;
    bool on = true;
    assert_true(viewer_action_is_switch(v, find("dome next"), &on));
    assert_false(on);
    assert_true(viewer_act(v, find("dome next")));
    assert_true(viewer_action_is_switch(v, find("dome next"), &on));
    assert_true(on);
    viewer_get_state(v, &now);
    assert_string_equal(now.note, "Eye-dome lighting: on");
    assert_true(viewer_action_is_switch(v, find("next axes"), &on));
    assert_false(viewer_action_is_switch(v, find("next shading"), &on));
    assert_true(viewer_act(v, find("next shading")));
    viewer_get_state(v, &now);
    assert_string_equal(now.note, "Shading: phong");
    assert_false(viewer_action_is_switch(v, find("shot"), &on));
    viewer_destroy(&v);
}

/// The button of the tool that the hand holds is lit, and of no other.
TEST(tools_are_lit) {
    viewer *v = make_viewer();
    assert_false(viewer_action_is_lit(v, find("select lasso")));
    assert_true(viewer_act(v, find("select lasso")));
    assert_true(viewer_action_is_lit(v, find("select lasso")));
    assert_false(viewer_action_is_lit(v, find("select polygon")));
    assert_false(viewer_action_is_lit(v, find("box next")));
    assert_true(viewer_act(v, find("select lasso")));
    assert_false(viewer_action_is_lit(v, find("select lasso")));
    assert_true(viewer_act(v, find("measure area")));
    assert_true(viewer_action_is_lit(v, find("measure area")));
    assert_false(viewer_action_is_lit(v, find("measure angle")));
    assert_false(viewer_action_is_lit(v, find("measure next")));
    // Another tool takes its place; once more puts it away.
    static const char *const tools[] = {"select lasso", "transform move", "measure note", "measure next", "measure area", "select polygon"};
    enum { COUNT = sizeof tools / sizeof tools[0] };
    for (int i = 0; i < COUNT; i++) {
        assert_true(viewer_act(v, find(tools[i])));
        for (int k = 0; k < COUNT; k++)
            if (viewer_action_is_lit(v, find(tools[k])) != (k == i)) fail_msg("%s after %s", tools[k], tools[i]);
    }
    assert_true(viewer_act(v, find("select polygon")));
    assert_false(viewer_action_is_lit(v, find("select polygon")));
    viewer_destroy(&v);
}

/// Escape takes away what lies on top, one thing at a time.
TEST(escape_goes_down) {
    viewer *v = make_viewer();
    viewer_state now;
    assert_true(viewer_do(v, "help on"));
    assert_true(viewer_do(v, "open"));
    viewer_get_state(v, &now);
    assert_true(now.help && now.question == VIEWER_ASKS_OPEN);
    assert_true(viewer_do(v, "cancel"));
    viewer_get_state(v, &now);
    assert_true(now.help && now.question == VIEWER_ASKS_NOTHING);
    assert_true(viewer_do(v, "cancel"));
    viewer_get_state(v, &now);
    assert_false(now.help);
    assert_true(viewer_do(v, "scene save"));
    viewer_get_state(v, &now);
    assert_int_equal(now.question, VIEWER_ASKS_SAVE_SCENE);
    viewer_destroy(&v);
}

/// What cannot be written asks for no name.
TEST(nothing_is_asked_for_nothing) {
    viewer *v = make_viewer();
    static const char *const commands[] = {"cut", "measure save", "profile save"};
    for (int i = 0; i < 3; i++) {
        viewer_state now;
        assert_false(viewer_act(v, find(commands[i])));
        viewer_get_state(v, &now);
        assert_int_equal(now.question, VIEWER_ASKS_NOTHING);
    }
    assert_true(viewer_do(v, "measure note 1,2,3 here"));
    viewer_state now;
    assert_true(viewer_act(v, find("measure save")));
    viewer_get_state(v, &now);
    assert_int_equal(now.question, VIEWER_ASKS_SAVE_MEASURES);
    // A bar without colours says so.
    assert_true(viewer_act(v, find("next color_bar")));
    viewer_get_state(v, &now);
    assert_string_equal(now.note, "Colour bar: on, once something has the colours of an attribute");
    viewer_destroy(&v);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
