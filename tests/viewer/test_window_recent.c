// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What is kept from one session to the next: the files that were opened last, the newest first, each once; how a person
// works; and no harm where it cannot be.
#include "check.h"
#include "view_contents.h"
#include "viewer/sdl/preferences.h"
#include "viewer/sdl/recent.h"

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static recent_files files, again;

static int make_folder(void **state) {
    char whole[1024];
    (void)mkdir("recent_files", 0700); // of a run before
    if (chdir("recent_files") != 0 || !getcwd(whole, sizeof whole)) return -1;
    (void)unlink("ewa/recent");
    (void)unlink("ewa/view");
    return setenv("XDG_STATE_HOME", whole, 1) != 0 || setenv("XDG_CONFIG_HOME", whole, 1) != 0;
}

static void write_file(const char *path, const char *text) {
    FILE *file = fopen(path, "w");
    assert_true(file && fputs(text, file) >= 0 && fclose(file) == 0);
}

static const char *name_of(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/// They are set where a session begins, which is nothing that could be undone; what is none of them is left out.
TEST(preferences_are_kept) {
    static view_contents contents;
    char lines[PREFERENCES_BYTES], value[EWA_OPTION_TEXT_BYTES];
    for (int session = 0; session < 2; session++) {
        viewer *v = view_contents_viewer(&contents);
        if (session) write_file("ewa/view", "set navigation fly\nquit\nset shading phong\nset budget_ms\nset animate\n");
        preferences_read(v, lines);
        viewer_state now;
        viewer_get_state(v, &now);
        assert_false(now.quit);
        assert_true(viewer_setting_get(v, "navigation", value));
        assert_string_equal(value, session ? "fly" : "turntable");
        assert_true(viewer_setting_get(v, "shading", value));
        assert_string_equal(value, "lambert");
        assert_false(viewer_do(v, "undo"));
        assert_true(viewer_do(v, "set budget_ms 40") && viewer_do(v, "keys Ctrl+K view top") && viewer_do(v, "keys none view front"));
        preferences_write(v, lines);
        viewer_destroy(&v);
    }
    viewer *v = view_contents_viewer(&contents);
    preferences_read(v, lines);
    assert_true(viewer_setting_get(v, "budget_ms", value));
    assert_string_equal(value, "40");
    // Keys that were chosen are there again, those of others as they were.
    const viewer_action *action;
    char keys[VIEWER_KEYS_BYTES];
    for (uint32_t i = 0; (action = viewer_action_at(i)); i++) {
        viewer_action_keys(v, action, keys);
        if (strcmp(action->command, "view top") == 0) assert_string_equal(keys, "Ctrl K");
        if (strcmp(action->command, "view front") == 0) assert_string_equal(keys, "");
        if (strcmp(action->command, "view iso") == 0) assert_string_equal(keys, "9");
    }
    viewer_destroy(&v);
}

TEST(the_newest_is_first) {
    recent_read(&files);
    assert_int_equal(files.count, 0);
    char name[32];
    for (int i = 0; i < RECENT_FILES + 3; i++) {
        snprintf(name, sizeof name, "scan %d.ply", i);
        write_file(name, "");
        recent_add(&files, name);
    }
    recent_add(&files, "scan 8.ply");
    recent_add(&files, "https://host/x.copc.laz");
    recent_add(&files, "nothing.ply"); // not there
    recent_read(&again);
    assert_int_equal(again.count, RECENT_FILES);
    for (uint32_t i = 0; i < again.count; i++) assert_string_equal(again.paths[i], files.paths[i]);
    assert_string_equal(again.paths[0], "https://host/x.copc.laz");
    assert_string_equal(name_of(again.paths[1]), "scan 8.ply");
    assert_int_equal(again.paths[1][0], '/');
    assert_string_equal(name_of(again.paths[2]), "scan 12.ply");
    assert_string_equal(name_of(again.paths[RECENT_FILES - 1]), "scan 4.ply");
}

TEST(broken_texts_do_no_harm) {
    static char line[3 * VIEWER_PATH_BYTES];
    memset(line, 'x', sizeof line - 1);
    write_file("ewa/recent", line);
    recent_read(&again);
    assert_int_equal(again.count, 0);
    write_file("ewa/recent", "/a\n/b\n\n/c\n");
    recent_read(&again);
    assert_int_equal(again.count, 2);
    write_file("ewa/recent", "/a\n/cut short");
    recent_read(&again);
    assert_int_equal(again.count, 1);
}

TEST(without_a_place_they_are_of_this_session) {
    assert_int_equal(setenv("XDG_STATE_HOME", "/dev/null/nowhere", 1), 0);
    recent_read(&again);
    assert_int_equal(again.count, 0);
    recent_add(&again, "scan 1.ply");
    assert_int_equal(again.count, 1);
    // A relative one does not count.
    assert_int_equal(setenv("XDG_STATE_HOME", "state", 1), 0);
    assert_int_equal(unsetenv("HOME"), 0);
    recent_add(&again, "scan 2.ply");
    assert_int_equal(again.count, 2);
    assert_int_not_equal(access("state", F_OK), 0);
}

int main(void) { return RUN_TESTS(make_folder, NULL); }
