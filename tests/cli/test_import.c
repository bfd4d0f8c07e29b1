// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The helper that imports rare formats: helpers that die, hang, grow, talk and lie, and the real one where it
// is built.
#define _DEFAULT_SOURCE // mkdtemp
#include "check_session.h"
#include "cli/input/import.h"
#include "io/scratch.h"

#include <fcntl.h>
#include <math.h>

static char said[4096];

/// Writes a helper as a script; its path is valid until the next call.
static const char *make_helper(const char *script) {
    static char path[512];
    char text[1024];
    snprintf(text, sizeof text, "#!/bin/sh\n%s\n", script);
    scratch_write(scratch_path("helper.sh", path), text, strlen(text));
    assert_int_equal(chmod(path, 0755), 0);
    return path;
}

/// Runs a helper with standard error going to `said`.
static bool run_helper(const char *helper, const char *path, double wall_s, uint64_t output_bytes,
                       uint8_t **bytes, size_t *size_bytes) {
    char errors[512];
    const import_limits limits = {
        .wall_s = wall_s, .cpu_s = 5, .memory_bytes = (uint64_t)1 << 30, .output_bytes = output_bytes};
    const int kept = fcntl(2, F_DUPFD_CLOEXEC, 0);
    scratch_path("helper.err", errors);
    assert_non_null(freopen(errors, "w", stderr));
    const bool done = import_run(&session, helper, path, &limits, bytes, size_bytes);
    fflush(stderr);
    dup2(kept, 2);
    close(kept);
    size_t size;
    char *text = (char *)scratch_read(errors, &size);
    text[size] = 0;
    snprintf(said, sizeof said, "%s", text);
    free(text);
    return done;
}

TEST_WITHIN(test_helpers, session_begin, session_finish) {
    static const struct {
        const char *script, *said; ///< NULL: it is well
    } cases[] = {
        {"printf abc", NULL},
        {"cat \"$3\"", NULL},
        {"test -z \"$(cat)\"", NULL}, // there is nothing to read
        {"printf abc; exit 3", "model.fbx: the import helper failed (status 3)"},
        {"exit 127", "helper.sh cannot be started (status 127)"},
        {"echo the file is odd >&2; exit 1", "model.fbx: the file is odd"},
        {"printf 'two\\nlines\\033[0m' >&2; exit 1", "model.fbx: two lines"},
        {"kill -SEGV $$", "model.fbx: the import helper died (signal 11)"},
        {"kill -XCPU $$", "model.fbx: the import helper takes too long"},
        {"sleep 60", "model.fbx: the import helper was ended: it takes too long"},
        {"exec >&- 2>&-; sleep 60", "model.fbx: the import helper was ended: it takes too long"},
        {"exec yes", "model.fbx: the import helper was ended: it gives too much"},
        {"exec yes >&2", "model.fbx: the import helper was ended: it takes too long"},
    };
    char path[512];
    scratch_write(scratch_path("model.fbx", path), "xyz", 3);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        OWNED(check_free) uint8_t *bytes = NULL;
        size_t size = 7;
        const double before_s = clock_now_s();
        const bool done = run_helper(make_helper(cases[i].script), path, 1.5, 1 << 20, &bytes, &size);
        assert_true(clock_now_s() - before_s < 30);
        if (done != (cases[i].said == NULL))
            fail_msg("'%s' %s: %s", cases[i].script, done ? "is well" : "fails", said);
        if (done) {
            assert_string_equal(said, "");
            assert_int_equal(size, i < 2 ? 3 : 0);
            if (i < 2) assert_memory_equal(bytes, i ? "xyz" : "abc", 3);
        } else {
            assert_true(!bytes && size == 0);
            if (!strstr(said, cases[i].said)) fail_msg("'%s' said %s", cases[i].script, said);
        }
    }
    OWNED(check_free) uint8_t *bytes;
    size_t size;
    assert_false(run_helper("/no/such/helper", path, 1, 100, &bytes, &size));
    // The reason is known where the system tells it, which qemu does not.
    if (!strstr(said, "the import helper /no/such/helper cannot be started: No such file or directory") &&
        !strstr(said, "the import helper /no/such/helper cannot be started (status 127)"))
        fail_msg("/no/such/helper said %s", said);
    // Words beside a mesh are a warning.
    assert_true(run_helper(make_helper("echo two pictures are missing >&2; printf abc"), path, 5, 100, &bytes,
                           &size));
    assert_non_null(strstr(said, "warning: "));
    assert_non_null(strstr(said, "two pictures are missing"));
}

TEST_WITHIN(test_names, session_begin, session_finish) {
    static const char *const imported[] = {"a.fbx", "a.FBX", "x/y.dae", "a.3ds"}, *const not_imported[] = {
                                                                                      "a.obj",  "a.ply",
                                                                                      "a",      "fbx",
                                                                                      "a.gltf", "a.fbx.ply"};
    for (size_t i = 0; i < sizeof imported / sizeof imported[0]; i++)
        assert_true(import_is_named(imported[i]));
    for (size_t i = 0; i < sizeof not_imported / sizeof not_imported[0]; i++)
        assert_false(import_is_named(not_imported[i]));
}

/// A Collada triangle in a node that moves it, with a picture and a colour.
static const char collada[] =
    "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
    "version=\"1.4.1\"><asset><up_axis>Y_UP</up_axis></asset>"
    "<library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"pa\" count=\"9\">0 0 0 "
    "1 0 0 0 1 0</float_array><technique_common>"
    "<accessor source=\"#pa\" count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" "
    "type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor>"
    "</technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" "
    "source=\"#p\"/></vertices><triangles count=\"1\">"
    "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 "
    "2</p></triangles></mesh></geometry></library_geometries>"
    "<library_visual_scenes><visual_scene id=\"s\"><node><translate>500000 0 2</translate><scale>2 2 "
    "2</scale><instance_geometry url=\"#g\"/></node></visual_scene>"
    "</library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";

/// The real helper: a mesh, broken files, files that are none, no memory.
TEST_WITHIN(test_real_helper, session_begin, session_finish) {
    const char *helper = getenv("EWA_IMPORT");
    char path[512];
    uint8_t *bytes;
    size_t size;
    if (!helper) skip();
    scratch_write(scratch_path("model.dae", path), collada, sizeof collada - 1);
    if (!run_helper(helper, path, 60, 1 << 20, &bytes, &size)) fail_msg("%s", said);
    ewa_model model;
    assert_int_equal(
        ewa_model_load_memory(session.context, bytes, size, path, path, EWA_MODEL_MESH, NULL, &model),
        EWA_OK);
    assert_int_equal(model.mesh.triangle_count, 1);
    double low = INFINITY, high = -INFINITY;
    for (uint32_t v = 0; v < 3; v++) {
        low = fmin(low, model.mesh.positions[3 * v]);
        high = fmax(high, model.mesh.positions[3 * v]);
    }
    assert_true(low == 500000 && high == 500002);
    ewa_model_free(&model);
    free(bytes);
    for (size_t cut = 0; cut < sizeof collada - 1; cut += 97) {
        scratch_write(scratch_path("model.dae", path), collada, cut);
        if (run_helper(helper, path, 60, 1 << 20, &bytes, &size))
            free(bytes);
        else
            assert_true(strstr(said, "model.dae: ") != NULL);
    }
    scratch_write(scratch_path("model.fbx", path), "Kaydara FBX Binary  \0\x1a\0\xff\xff\xff\xff", 27);
    assert_false(run_helper(helper, path, 60, 1 << 20, &bytes, &size));
    // What this Assimp has no reader for is said, not what others miss in it.
    static const char vrml[] = "#VRML V2.0 utf8\nShape { geometry Box { } }\n";
    scratch_write(scratch_path("model.wrl", path), vrml, sizeof vrml - 1);
    if (run_helper(helper, path, 60, 1 << 20, &bytes, &size))
        free(bytes);
    else
        assert_non_null(strstr(said, "does not read such files: exported as glTF or OBJ they are read"));
    unlink(scratch_path("pipe.fbx", path));
    assert_int_equal(mkfifo(path, 0666), 0);
    assert_false(run_helper(helper, path, 60, 1 << 20, &bytes, &size));
    assert_non_null(strstr(said, "no pipe"));
    assert_false(run_helper(helper, "/no/such.dae", 60, 1 << 20, &bytes, &size));
    assert_non_null(strstr(said, "No such file"));
}

int main(void) { return RUN_TESTS(NULL, NULL); }
