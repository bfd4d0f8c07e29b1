// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files that another file names: which are opened, and which are not, whatever the name.
#include "io/mesh/base64.h"
#include "io/referenced_file.h"
#include "io/scratch.h"

static char mesh[512];

/// A folder "beside" with a mesh, files and folders, links and a pipe.
static int make_folder(void **state) {
    char path[512], target[512];
    scratch_path("beside_outside.txt", path);
    scratch_write(path, "outside", 7);
    scratch_path("beside", path);
    mkdir(path, 0777);
    scratch_path("beside/inner", path);
    mkdir(path, 0777);
    scratch_path("beside/mesh.obj", mesh);
    scratch_write(mesh, "mesh", 4);
    scratch_write(scratch_path("beside/a file.txt", path), "file", 4);
    scratch_write(scratch_path("beside/inner/deep.txt", path), "deep", 4);
    scratch_write(scratch_path("beside/empty.txt", path), "", 0);
    static const char *const links[][2] = {{"beside/to_file", "a file.txt"},
                                           {"beside/to_inner", "inner"},
                                           {"beside/to_outside", "../beside_outside.txt"},
                                           {"beside/to_parent", ".."},
                                           {"beside/to_root", "/"},
                                           {"beside/to_zero", "/dev/zero"},
                                           {"beside/to_itself", "to_itself"},
                                           {"beside/to_nothing", "nothing"}};
    for (size_t i = 0; i < sizeof links / sizeof links[0]; i++) {
        unlink(scratch_path(links[i][0], target));
        assert_int_equal(symlink(links[i][1], target), 0);
    }
    unlink(scratch_path("beside/pipe", path));
    assert_int_equal(mkfifo(path, 0666), 0);
    return 0;
}

TEST_ON(test_names, 1) {
    static const struct {
        const char *name, *content, *reason; ///< one of the two
    } cases[] = {
        {"a file.txt", "file", NULL},
        {"./a file.txt", "file", NULL},
        {"inner/deep.txt", "deep", NULL},
        {"inner\\deep.txt", "deep", NULL},
        {"inner//deep.txt", "deep", NULL},
        {"inner/../a file.txt", "file", NULL},
        {"../beside/a file.txt", "file", NULL}, // leads back
        {"to_file", "file", NULL},
        {"to_inner/deep.txt", "deep", NULL},
        {"empty.txt", "", NULL},
        {"mesh.obj", "mesh", NULL},
        {"/somewhere/else/a file.txt", "file", NULL}, // the last part, beside
        {"C:\\textures\\a file.txt", "file", NULL},
        {"C:a file.txt", "file", NULL},
        {"file:///tmp/a file.txt", "file", NULL},
        {"nowhere/a file.txt", "file", NULL},
        {"none.txt", NULL, "it is not there"},
        {"to_nothing", NULL, "it is not there"},
        {"to_itself", NULL, "it is a link that changes"},
        {"to_outside", NULL, "it is not below the folder"},
        {"to_zero", NULL, "it is not below the folder"},
        {"to_parent/beside_outside.txt", NULL, "it is not below the folder"},
        {"to_root/etc/passwd", NULL, "it is not below the folder"},
        {"../beside_outside.txt", NULL, "it is not below the folder"},
        {"inner/../../beside_outside.txt", NULL, "it is not below the folder"},
        {"/etc/passwd", NULL, "its name is absolute"},
        {"/dev/stdin", NULL, "its name is absolute"},
        {"pipe", NULL, "it is no regular file"},
        {"inner", NULL, "it is no regular file"},
        {"to_inner", NULL, "it is no regular file"},
        {".", NULL, "it is not below the folder"},
        {"inner/.", NULL, "it is no regular file"},
        {"", NULL, "it has no name"},
        {"mesh.obj/x", NULL, "it is not there"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char reason[EWA_REASON_BYTES] = "";
        ewa_file file;
        const bool there =
            ewa_referenced_file_map(context, mesh, (ewa_text){cases[i].name, strlen(cases[i].name)}, &file, reason);
        if (there != (cases[i].content != NULL)) fail_msg("'%s': %s", cases[i].name, reason);
        if (there) {
            assert_int_equal(file.size_bytes, strlen(cases[i].content));
            if (file.size_bytes) assert_memory_equal(file.bytes, cases[i].content, file.size_bytes);
        } else if (!strstr(reason, cases[i].reason)) {
            fail_msg("'%s': '%s' is not in '%s'", cases[i].name, cases[i].reason, reason);
        }
        ewa_file_unmap(context, &file);
    }
    char reason[EWA_REASON_BYTES], longest[6000];
    ewa_file file;
    memset(longest, 'x', sizeof longest);
    assert_false(ewa_referenced_file_map(context, mesh, (ewa_text){longest, sizeof longest}, &file, reason));
    assert_string_equal(reason, "its name is too long");
    assert_false(ewa_referenced_file_map(context, mesh, (ewa_text){longest, 300}, &file, reason));
    assert_false(ewa_referenced_file_map(context, mesh, (ewa_text){"a\0b", 3}, &file, reason));
    assert_false(ewa_referenced_file_map(context, "/no/such/folder/mesh.obj", (ewa_text){"a", 1}, &file, reason));
}

/// A mesh in the working folder, and one in the root.
TEST_ON(test_folders, 1) {
    char reason[EWA_REASON_BYTES], back[4096], folder[512];
    ewa_file file;
    assert_non_null(getcwd(back, sizeof back));
    assert_int_equal(chdir(scratch_path("beside", folder)), 0);
    assert_true(ewa_referenced_file_map(context, "mesh.obj", (ewa_text){"a file.txt", 10}, &file, reason));
    ewa_file_unmap(context, &file);
    assert_false(ewa_referenced_file_map(context, "mesh.obj", (ewa_text){"../beside_outside.txt", 21}, &file, reason));
    assert_false(ewa_referenced_file_map(context, "/mesh.obj", (ewa_text){"no/such", 7}, &file, reason));
    assert_int_equal(chdir(back), 0);
}

TEST(test_base64) {
    static const struct {
        const char *letters, *bytes; ///< NULL: refused
    } cases[] = {{"", ""},
                 {"Zg==", "f"},
                 {"Zm8=", "fo"},
                 {"Zm9v", "foo"},
                 {"Zm9vYg==", "foob"},
                 {"Zm9vYmE=", "fooba"},
                 {"Zm9vYmFy", "foobar"},
                 {"Zm9vYg", "foob"},
                 {" Zm\n9v\tYg = = \r", "foob"},
                 {"Zg==Zg", "ff"},
                 {"Z", NULL},
                 {"Zm9vY", NULL},
                 {"Zm-v", NULL},
                 {"+/+/", "\xfb\xff\xbf"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const size_t length = strlen(cases[i].letters), room = ewa_base64_room(length);
        OWNED(check_free) uint8_t *bytes = malloc(room);
        assert_non_null(bytes);
        size_t used = 99;
        const size_t size = ewa_base64_read(cases[i].letters, length, 0, bytes, room, &used);
        if ((used == length) != (cases[i].bytes != NULL)) fail_msg("'%s': %zu", cases[i].letters, used);
        if (cases[i].bytes) {
            assert_int_equal(size, strlen(cases[i].bytes));
            assert_memory_equal(bytes, cases[i].bytes, size);
        }
    }
}

int main(void) { return RUN_TESTS(make_folder, NULL); }
