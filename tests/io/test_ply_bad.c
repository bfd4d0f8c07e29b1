// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of the PLY reader on files that are wrong: each fails with a message that names file, place and
// reason, whatever is cut, changed or claimed.
#include "io/ply_sample.h"
#include "io/scratch.h"

#define FIXTURE_THREADS 1
#include "io/fixture.h"

#define XYZ      "property float x\nproperty float y\nproperty float z\n"
#define ASCII    "ply\nformat ascii 1.0\n"
#define BINARY   "ply\nformat binary_little_endian 1.0\n"
#define VERTEX_1 "element vertex 1\n" XYZ

CASE(test_headers_and_their_messages) {
    static const struct {
        const char *text, *message;
        ewa_status status;
    } cases[] = {
        {"", "sample.ply: the file is empty", EWA_ERROR_FORMAT},
        {"solid cube\n", "not a point file", EWA_ERROR_UNSUPPORTED},
        {"pl", "not a point file", EWA_ERROR_UNSUPPORTED},
        {"ply", "line 1: a PLY file begins with a line 'ply'", EWA_ERROR_FORMAT},
        {"plyx\n", "line 1: a PLY file begins", EWA_ERROR_FORMAT},
        {"ply\n", "line 1: the file ends before 'end_header'", EWA_ERROR_FORMAT},
        {"ply\nformat ascii 1.0\ncomment x", "line 3: the file ends before 'end_header'", EWA_ERROR_FORMAT},
        {"ply\nformat ascii\n", "line 2: 'format' wants an encoding and a version", EWA_ERROR_FORMAT},
        {"ply\nformat ascii 2.0\n", "line 2: version '2.0'; 1.0 is read", EWA_ERROR_UNSUPPORTED},
        {"ply\nformat binary_middle_endian 1.0\n", "line 2: encoding 'binary_middle_endian'",
         EWA_ERROR_UNSUPPORTED},
        {ASCII ASCII, "line 3: unknown word 'ply'", EWA_ERROR_FORMAT},
        {ASCII "format ascii 1.0\n", "line 3: a second format", EWA_ERROR_FORMAT},
        {ASCII "element vertex\n", "line 3: 'element' wants a name and a count", EWA_ERROR_FORMAT},
        {ASCII "element vertex -1\n", "line 3: '-1' is no count", EWA_ERROR_FORMAT},
        {ASCII "element vertex 1e3\n", "line 3: '1e3' is no count", EWA_ERROR_FORMAT},
        {ASCII "element vertex 18446744073709551616\n", "line 3: '18446744073709551616' is no count",
         EWA_ERROR_FORMAT},
        {ASCII "element vertex 1 2\n", "line 3: 'element' wants", EWA_ERROR_FORMAT},
        {ASCII "element vertex 1\nelement vertex 2\n", "line 4: element 'vertex' a second time",
         EWA_ERROR_FORMAT},
        {ASCII "property float x\n", "line 3: a property before any element", EWA_ERROR_FORMAT},
        {ASCII "element vertex 1\nproperty x\n", "line 4: 'property' wants", EWA_ERROR_FORMAT},
        {ASCII "element vertex 1\nproperty half x\n", "line 4: unknown type 'half'", EWA_ERROR_FORMAT},
        {ASCII "element vertex 1\nproperty list uchar x\n", "line 4: 'property' wants", EWA_ERROR_FORMAT},
        {ASCII "element vertex 1\nproperty list float int x\n", "line 4: a list cannot be counted by 'float'",
         EWA_ERROR_FORMAT},
        {ASCII "element vertex 1\nproperty float x\nproperty uchar x\n", "line 5: property 'x' a second time",
         EWA_ERROR_FORMAT},
        {ASCII "element vertex 1\nproperty float \x1b[31mred\n", "line 4: the file ends before",
         EWA_ERROR_FORMAT},
        {ASCII "\x1b[31m\xff x\n", "line 3: unknown word '?[31m?'", EWA_ERROR_FORMAT},
        {ASCII "a234567890b234567890c234567890d234567890e234567890 x\n",
         "line 3: unknown word 'a234567890b234567890c234567890d234567890e2...'", EWA_ERROR_FORMAT},
        {"ply\n" VERTEX_1 "end_header\n", "line 6: the header has no 'format'", EWA_ERROR_FORMAT},
        {ASCII "end_header\n", "sample.ply: the header has no element 'vertex'", EWA_ERROR_FORMAT},
        {ASCII "element face 0\nend_header\n", "the header has no element 'vertex'", EWA_ERROR_FORMAT},
        {ASCII "element vertex 0\nend_header\n", "the vertices have no number named 'x'", EWA_ERROR_FORMAT},
        {ASCII "element vertex 0\nproperty float x\nproperty float z\nend_header\n", "no number named 'y'",
         EWA_ERROR_FORMAT},
        {ASCII
         "element vertex 0\nproperty float x\nproperty float y\nproperty list uchar float z\nend_header\n",
         "no number named 'z'", EWA_ERROR_FORMAT},
        {ASCII "element vertex 0\nproperty float radius\nend_header\n", "no number named 'x'",
         EWA_ERROR_FORMAT},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        ewa_cloud *cloud;
        messages.count = 0;
        assert_int_equal(sample_load_text(context, cases[i].text, &cloud), cases[i].status);
        assert_int_equal(messages.count, 1);
        if (!strstr(messages.text, cases[i].message))
            fail_msg("'%s' instead of '%s'", messages.text, cases[i].message);
        assert_int_equal(strncmp(messages.text, "sample.ply: ", 12), 0);
        for (const char *c = messages.text; *c; c++) assert_true(*c >= ' ' && *c <= '~');
    }
}

CASE(test_bodies_and_their_messages) {
    static const struct {
        const char *text, *message;
    } cases[] = {
        {ASCII VERTEX_1 "end_header\n1 2\n",
         "sample.ply: the file ends in 'vertex' 0 of 1 or before: at least 6 bytes "
         "wanted from byte 100 on, 4 are there, 2 are missing"},
        {ASCII VERTEX_1 "end_header\n1.25 2.5\n", "sample.ply: line 8: the file ends in 'vertex' 0 of 1"},
        {ASCII VERTEX_1 "end_header\n1 two 3\n", "line 8: 'vertex' 0 of 1: 'two' is no number of the type"},
        {ASCII VERTEX_1 "end_header\n1 2,5 3\n", "line 8: 'vertex' 0 of 1: '2,5' is no number"},
        {ASCII "element vertex 2\n" XYZ "property uchar u\nend_header\n1 2 3 4\n\n1 2 3 256\n",
         "line 11: 'vertex' 1 of 2: '256' does not fit the type of its property"},
        {ASCII VERTEX_1 "property uchar u\nend_header\n1 2 3 -1\n", "'-1' does not fit"},
        {ASCII VERTEX_1 "property int i\nend_header\n1 2 3 2147483648\n", "'2147483648' does not fit"},
        {ASCII VERTEX_1 "property int i\nend_header\n1 2 3 0.5\n", "'0.5' is no number of the type"},
        {ASCII VERTEX_1 "property int i\nend_header\n1 2 3 nan\n", "'nan' is no number of the type"},
        {ASCII VERTEX_1 "property int i\nend_header\n1 2 3 1e99\n", "'1e99' is no number of the type"},
        {ASCII VERTEX_1 "property list char int l\nend_header\n1 2 3 -1\n", "'-1' is no length of a list"},
        {ASCII VERTEX_1 "property list char int l\nend_header\n1 2 3 x\n", "'x' is no length of a list"},
        {ASCII VERTEX_1 "property list int int l\nend_header\n1 2 3 5 1 2\n",
         "line 9: the file ends in 'vertex' 0"},
        {ASCII VERTEX_1 "end_header\n1 2 3 4\n", "line 8: '4' follows the last of 1 records"},
        {ASCII "element face 2\nproperty list uchar int i\n" VERTEX_1 "end_header\n3 0 1 2\n3 0\n1 2 3\n",
         "the file ends in 'vertex' 0 of 1"},
        {BINARY VERTEX_1 "end_header\n1234567",
         "sample.ply: the file ends in 'vertex' 0 of 1 or before: 12 bytes wanted "
         "from byte 115 on, 7 are there, 5 are missing"},
        {BINARY "element vertex 3\n" XYZ "end_header\n123456789012345678901234",
         "the file ends in 'vertex' 2 of 3 or before: 36 bytes wanted from byte 115 on, 24 are there, 12 are "
         "missing"},
        {BINARY VERTEX_1 "property list char int l\nend_header\n123456789012\xff",
         "byte 152: list 'l' of 'vertex' 0 has a negative length"},
        {BINARY VERTEX_1 "property list uchar int l\nend_header\n123456789012\x02"
                         "1234567",
         "the file ends in 'vertex' 0 of 1: 8 bytes wanted from byte 154 on, 7 are there"},
        {BINARY "element face 1\nproperty list uint double l\n" VERTEX_1 "end_header\n\xff\xff\xff\xff"
                "1234567890123",
         "the file ends in 'face' 0 of 1: 34359738360 bytes wanted"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        ewa_cloud *cloud;
        messages.text[0] = 0;
        assert_int_equal(sample_load_text(context, cases[i].text, &cloud), EWA_ERROR_FORMAT);
        if (!strstr(messages.text, cases[i].message))
            fail_msg("'%s' instead of '%s'", messages.text, cases[i].message);
        assert_int_equal(strncmp(messages.text, "sample.ply: ", 12), 0);
    }
}

CASE(test_lying_counts) {
    static const char *const counts[] = {"2",
                                         "3",
                                         "1000",
                                         "1000000000",
                                         "4294967279",
                                         "4294967296",
                                         "1152921504606846977",
                                         "9223372036854775808",
                                         "18446744073709551615"};
    for (int encoding = 0; encoding < 3; encoding++)
        for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++)
            for (int before = 0; before < 2; before++) {
                // The lie is told of the vertices, or of faces before them.
                char text[512];
                snprintf(text, sizeof text,
                         "ply\nformat %s 1.0\nelement face %s\nproperty int a\nelement vertex %s\n" XYZ
                         "end_header\n",
                         sample_formats[encoding], before ? counts[i] : "0", before ? "1" : counts[i]);
                sample s = {.encoding = (ewa_ply_encoding)encoding};
                sample_text(&s, text);
                for (int c = 0; c < 3; c++) sample_number(&s, EWA_F32, c);
                ewa_cloud *cloud;
                const ewa_status status = sample_load(context, &s, &cloud);
                assert_true(status == EWA_ERROR_FORMAT || status == EWA_ERROR_LIMIT);
            }
}

CASE(test_warnings_about_the_rest) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud;
    assert_int_equal(
        sample_load_text(context,
                         BINARY VERTEX_1
                         "element face 9\nproperty list uchar int i\nend_header\n123456789012\x01",
                         &cloud),
        EWA_OK);
    assert_string_equal(
        messages.text,
        "sample.ply: the file ends within 9 records of 'face'; the vertices before them are whole");
    ewa_cloud_destroy(&cloud);
    // What follows the last element is only worth a note.
    messages.count = 0;
    assert_int_equal(sample_load_text(context, BINARY VERTEX_1 "end_header\n123456789012and more", &cloud),
                     EWA_OK);
    assert_int_equal(messages.count, 0);
}

CASE(test_limits) {
    WITH_DEFAULTS(ewa_context_options, options);
    options.limits.max_points = 2;
    options.message = check_log_keep;
    options.message_user = &messages;
    ewa_context *small = NULL;
    assert_int_equal(ewa_context_create(&options, &small), EWA_OK);
    ewa_cloud *cloud;
    const char *three = ASCII "element vertex 3\n" XYZ "end_header\n1 2 3\n1 2 3\n1 2 3\n";
    assert_int_equal(sample_load_text(small, three, &cloud), EWA_ERROR_LIMIT);
    assert_string_equal(messages.text, "sample.ply: 3 points are over the limit of 2");
    ewa_context_destroy(&small);
    enum { MANY = 100000 };
    options.limits.max_points = MANY;
    options.limits.max_memory_bytes = 1000000;
    static char many[200 + 6 * MANY];
    size_t length = (size_t)snprintf(many, sizeof many, "%s", ASCII "element vertex 100000\n" XYZ "end_header\n");
    for (int i = 0; i < MANY; i++, length += 6) memcpy(many + length, "1 2 3\n", 7);
    assert_int_equal(ewa_context_create(&options, &small), EWA_OK);
    assert_int_equal(sample_load_text(small, many, &cloud), EWA_ERROR_LIMIT);
    assert_non_null(strstr(messages.text, "sample.ply: 100000 points of 12 bytes: 1200000 bytes are needed, "));
    assert_non_null(strstr(messages.text, " of max_memory_bytes 1000000 are left"));
    ewa_context_destroy(&small);

    sample s = {0};
    sample_text(&s, ASCII "element vertex 0\n");
    for (int i = 0; i < 1001; i++) {
        char line[64];
        snprintf(line, sizeof line, "property float p%d\n", i);
        sample_text(&s, line);
    }
    assert_int_equal(sample_load(context, &s, &cloud), EWA_ERROR_LIMIT);
    assert_string_equal(messages.text, "sample.ply: line 1004: more than 1000 properties");
    sample_text(&s, ASCII);
    for (int i = 0; i < 65; i++) {
        char line[64];
        snprintf(line, sizeof line, "element e%d 0\n", i);
        sample_text(&s, line);
    }
    assert_int_equal(sample_load(context, &s, &cloud), EWA_ERROR_LIMIT);
    assert_string_equal(messages.text, "sample.ply: line 67: more than 64 elements");
}

/// A small file with everything: elements before and after, lists, several types.
static sample make_rich(ewa_ply_encoding encoding, bool lists) {
    sample s = sample_start(encoding, "\n");
    sample_text(
        &s, "element camera 1\nproperty float view\nelement vertex 4\nproperty double x\nproperty double y\n"
            "property double z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n");
    if (lists) sample_text(&s, "property list uchar short l\n");
    sample_text(&s, "property float radius\nend_header\n");
    sample_number(&s, EWA_F32, 2.5);
    sample_record_end(&s);
    for (int i = 0; i < 4; i++) {
        for (int c = 0; c < 3; c++) sample_number(&s, EWA_F64, 1000 * i + c + 0.125);
        for (int c = 0; c < 3; c++) sample_number(&s, EWA_U8, 60 * i + c);
        if (lists) {
            sample_number(&s, EWA_U8, i);
            for (int k = 0; k < i; k++) sample_number(&s, EWA_I16, -k);
        }
        sample_number(&s, EWA_F32, 0.5);
        sample_record_end(&s);
    }
    return s;
}

CASE(test_every_truncation) {
    for (int encoding = 0; encoding < 3; encoding++)
        for (int lists = 0; lists < 2; lists++) {
            sample s = make_rich((ewa_ply_encoding)encoding, lists);
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud;
            for (size_t size = 0; size < s.size; size++) {
                messages.count = 0;
                const ewa_status status = sample_load_bytes(context, s.bytes, size, &cloud);
                // Ascii does not show that the last number, "0.5" and a line feed, lost its end.
                const bool may_pass = encoding == EWA_PLY_ASCII && size >= s.size - 3;
                if (!may_pass && (status == EWA_OK || messages.count != 1))
                    fail_msg("%zu of %zu bytes: %s, %d messages", size, s.size, ewa_status_name(status),
                             messages.count);
                if (may_pass) assert_int_equal(status, EWA_OK);
                ewa_cloud_destroy(&cloud);
            }
            assert_int_equal(sample_load(context, &s, &cloud), EWA_OK);
        }
}

CASE(test_changed_bytes_do_no_harm) {
    check_random random = {5};
    for (int encoding = 0; encoding < 3; encoding++)
        for (int lists = 0; lists < 2; lists++) {
            sample s = make_rich((ewa_ply_encoding)encoding, lists);
            ewa_cloud *cloud;
            for (size_t at = 0; at < s.size; at++)
                for (int round = 0; round < 12; round++) {
                    const uint8_t kept = s.bytes[at];
                    static const char usual[] = "\n\r 0919-e.\xff";
                    s.bytes[at] = round < 11 ? (uint8_t)usual[round] : (uint8_t)check_random_u64(&random);
                    if (sample_load_bytes(context, s.bytes, s.size, &cloud) == EWA_OK)
                        ewa_cloud_destroy(&cloud);
                    s.bytes[at] = kept;
                }
            free(s.bytes);
        }
}

CASE(test_failing_allocations) {
    check_memory memory = {.calls_left = -1};
    WITH_DEFAULTS(ewa_context_options, options);
    options.allocator = check_allocator(&memory);
    options.thread_count = 2;
    options.message = check_log_keep;
    options.message_user = &messages;
    ewa_context *own = NULL;
    assert_int_equal(ewa_context_create(&options, &own), EWA_OK);
    char path[512];
    scratch_path("memory.ply", path);
    for (int encoding = 0; encoding < 3; encoding++) {
        sample s = make_rich((ewa_ply_encoding)encoding, true);
        int failures = 0;
        for (bool done = false; !done; failures++) {
            assert_true(failures < 100);
            const int64_t held = memory.held_bytes;
            messages.count = 0;
            memory.calls_left = failures;
            ewa_cloud *cloud = NULL;
            ewa_status status = ewa_cloud_load_memory(own, s.bytes, s.size, "sample.ply", &cloud);
            if (status == EWA_OK) {
                WITH_DEFAULTS(ewa_cloud_save_options, save_options);
                save_options.ply_encoding = (ewa_ply_encoding)encoding;
                status = ewa_cloud_save(cloud, path, &save_options);
            }
            done = memory.calls_left >= 0;
            memory.calls_left = -1;
            ewa_cloud_destroy(&cloud);
            assert_int_equal(status, done ? EWA_OK : EWA_ERROR_MEMORY);
            assert_int_equal(messages.count, done ? 0 : 1);
            assert_true(memory.held_bytes == held);
        }
        assert_true(failures > 8);
        free(s.bytes);
    }
    unlink(path);
    ewa_context_destroy(&own);
    assert_true(memory.held_bytes == 0);
}

static bool cancel_now(void *user, const char *stage, double fraction) {
    (void)stage;
    (void)fraction;
    return --*(int *)user > 0;
}

CASE(test_cancelling) {
    for (int encoding = 0; encoding < 3; encoding++) {
        int calls_left = 1;
        OWNED(ewa_context_destroy) ewa_context *own = check_context_telling(0, cancel_now, &calls_left);
        sample s = make_rich((ewa_ply_encoding)encoding, encoding == 0);
        ewa_cloud *cloud;
        assert_int_equal(sample_load(own, &s, &cloud), EWA_CANCELLED);
    }
}

CASE(test_hostile_files) {
    static const struct {
        const char *path;
        ewa_status status;
    } files[] = {{"hostile/mesh/empty.ply", EWA_ERROR_FORMAT},
                 {"hostile/mesh/crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply", EWA_ERROR_FORMAT},
                 {"hostile/mesh/assimp_issue623.ply", EWA_ERROR_FORMAT},
                 {"hostile/mesh/pdal_no_vertex.ply", EWA_ERROR_FORMAT},
                 {"hostile/mesh/pdal_unsized_dims.ply", EWA_ERROR_FORMAT},
                 {"gaussians/guitar.compressed.ply", EWA_ERROR_UNSUPPORTED},
                 {"hostile/mesh/draco_inf_nan.obj", EWA_ERROR_UNSUPPORTED},
                 {"images/camera.png", EWA_ERROR_UNSUPPORTED}};
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        char path[512];
        if (!check_data(files[i].path, path, sizeof path)) skip();
        ewa_cloud *cloud;
        messages.count = 0;
        assert_int_equal(ewa_cloud_load(context, path, &cloud), files[i].status);
        assert_null(cloud);
        assert_int_equal(messages.count, 1);
        assert_non_null(strstr(messages.text, path));
    }
}

CASE(test_wrong_arguments) {
    ewa_cloud *cloud;
    assert_int_equal(ewa_cloud_load(NULL, "a.ply", &cloud), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_cloud_load(context, NULL, &cloud), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_cloud_load(context, "a.ply", NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_cloud_load_memory(context, NULL, 5, "a.ply", &cloud), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_cloud_load(context, "/no/such.ply", &cloud), EWA_ERROR_IO);
    assert_string_equal(messages.text, "/no/such.ply: No such file or directory");
    assert_null(cloud);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
