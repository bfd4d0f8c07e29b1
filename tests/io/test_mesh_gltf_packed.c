// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// glTF packed by Draco and by meshoptimizer, written by other programs: the same torus as unpacked; bytes that are
// missing or wrong.
#include "image/srgb.h"
#include "io/gltf_check.h"

static mesh_messages messages;
static ewa_context *context;

static const char *const packed_names[] = {"torus_draco.glb", "torus_draco_seq.glb", "torus_meshopt.glb",
                                           "torus_meshopt_high.glb"};

enum { PACKED = sizeof packed_names / sizeof packed_names[0] };

static int begin(void **state) {
    context = mesh_context(&messages);
    return 0;
}

static int end(void **state) {
    ewa_context_destroy(&context);
    return 0;
}

static uint8_t *read_corpus(const char *name, size_t *size_bytes) {
    char path[512];
    snprintf(path, sizeof path, "%s/tests/fuzz/corpus/mesh_gltf/%s", getenv("EWA_SOURCE_DIR"), name);
    return scratch_read(path, size_bytes);
}

static void load_corpus(const char *name, ewa_mesh *mesh) {
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = read_corpus(name, &size_bytes);
    mesh_load_bytes(context, &messages, name, bytes, size_bytes, false, mesh);
}

/// The vertex of a mesh that is nearest to a place and a normal; the places' distance.
static uint32_t nearest(const ewa_mesh *mesh, const double place[3], double *distance) {
    uint32_t found = 0;
    *distance = INFINITY;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        double rr = 0;
        for (int k = 0; k < 3; k++) rr += pow(mesh->positions[3 * v + (uint32_t)k] - place[k], 2);
        if (sqrt(rr) < *distance) *distance = sqrt(rr), found = v;
    }
    return found;
}

/// Places within a step of 14 bits, colours within one of 8, the same faces and area.
TEST(test_same_torus) {
    ewa_mesh plain, packed;
    load_corpus("torus.glb", &plain);
    double sum[3];
    const double area = mesh_area(&plain, sum);
    for (int n = 0; n < PACKED; n++) {
        load_corpus(packed_names[n], &packed);
        assert_int_equal(packed.triangle_count, plain.triangle_count);
        assert_int_equal(packed.vertex_count, plain.vertex_count);
        assert_float_equal(mesh_area(&packed, sum), area, 2e-3);
        for (int k = 0; k < 3; k++) assert_float_equal(sum[k], 0, 2e-3); // closed, and turned the same way
        assert_non_null(packed.colors);
        for (uint32_t v = 0; v < packed.vertex_count; v++) {
            double distance;
            const uint32_t other = nearest(&plain, packed.positions + 3 * v, &distance);
            if (distance > 2.8 / 16384) fail_msg("%s: vertex %u is %g off", packed_names[n], v, distance);
            for (int c = 0; c < 4; c++) {
                const float a = plain.colors[4 * other + (uint32_t)c], b = packed.colors[4 * v + (uint32_t)c];
                // Places of the seam have two vertices, whose colours are alike.
                if (fabsf(a - b) > 0.006f)
                    fail_msg("%s: colour %d of vertex %u is %g, not %g", packed_names[n], c, v, b, a);
            }
        }
        ewa_mesh_free(&packed);
    }
    ewa_mesh_free(&plain);
}

/// Loads bytes of which nothing is expected but an end, in memory of their own size.
static ewa_status try_bytes(const uint8_t *bytes, size_t size_bytes) {
    OWNED(check_free) uint8_t *copy = malloc(size_bytes ? size_bytes : 1);
    memcpy(copy, bytes, size_bytes);
    ewa_model model;
    messages = (mesh_messages){.errors = 0};
    const ewa_status status =
        ewa_model_load_memory(context, copy, size_bytes, "a.glb", NULL, EWA_MODEL_MESH, NULL, &model);
    assert_int_equal(status != EWA_OK, messages.errors > 0);
    if (status == EWA_OK) ewa_model_free(&model);
    return status;
}

TEST(test_every_truncation) {
    for (int n = 0; n < PACKED; n++) {
        size_t size_bytes;
        OWNED(check_free) uint8_t *bytes = read_corpus(packed_names[n], &size_bytes);
        for (size_t length = 0; length < size_bytes; length++)
            if (try_bytes(bytes, length) == EWA_OK)
                fail_msg("%s: %zu bytes are enough", packed_names[n], length);
    }
}

static size_t read_length(const uint8_t *bytes) {
    return (size_t)bytes[0] | (size_t)bytes[1] << 8 | (size_t)bytes[2] << 16 | (size_t)bytes[3] << 24;
}

/// Every byte of the packed streams turned over and set to ends of its range; and whole streams of one byte.
TEST(test_wrong_bytes) {
    static const uint8_t values[] = {0, 1, 0x7f, 0x80, 0xff};
    for (int n = 0; n < PACKED; n++) {
        size_t size_bytes;
        OWNED(check_free) uint8_t *bytes = read_corpus(packed_names[n], &size_bytes);
        const size_t first = 28 + read_length(bytes + 12);
        uint32_t refused = 0;
        for (size_t at = first; at < size_bytes; at++) {
            const uint8_t right = bytes[at];
            for (size_t v = 0; v < sizeof values; v++) {
                bytes[at] = values[v];
                refused += try_bytes(bytes, size_bytes) != EWA_OK;
            }
            bytes[at] = (uint8_t)~right;
            refused += try_bytes(bytes, size_bytes) != EWA_OK;
            bytes[at] = right;
        }
        assert_true(refused > 0);
        for (int value = 0; value < 256; value += 51) {
            memset(bytes + first, value, size_bytes - first);
            assert_true(try_bytes(bytes, size_bytes) != EWA_OK);
        }
    }
}

/// Puts other words of the same length into a file's JSON, in all places.
static void replace(uint8_t *bytes, size_t size_bytes, const char *from, const char *to) {
    const size_t length = strlen(from);
    assert_int_equal(length, strlen(to));
    int found = 0;
    for (size_t i = 0; i + length <= size_bytes; i++)
        if (memcmp(bytes + i, from, length) == 0) memcpy(bytes + i, to, length), found++;
    if (!found) fail_msg("%s is nowhere", from);
}

/// What extensions claim that is not so.
TEST(test_wrong_claims) {
    static const struct {
        int file;
        const char *from, *to, *said;
        ewa_status status;
    } cases[] = {
        {0, "\"count\":144", "\"count\":141", "more faces", EWA_ERROR_FORMAT},
        {0, "\"count\":35", "\"count\":20", "more vertices|more than the accessors", EWA_ERROR_FORMAT},
        {0, "\"POSITION\":0", "\"POSITION\":7", "no such", EWA_ERROR_FORMAT},
        {0, "\"count\":144", "\"count\":1e9", "may have", EWA_ERROR_LIMIT},
        {0, "DRACO", "DRACA", "does not begin like", EWA_ERROR_FORMAT},
        {2, "\"mode\":\"ATTRIBUTES\"", "\"mode\":\"ATTRIBUTED\"", "mode is not known", EWA_ERROR_FORMAT},
        {2, "\"mode\":\"TRIANGLES\"", "\"mode\":\"INDICES\"  ", "shorter than so many indices",
         EWA_ERROR_FORMAT},
        {2, "\"count\":144", "\"count\":145", "no multiple of 3", EWA_ERROR_FORMAT},
        {2, "\"byteStride\":2,\"count\":144", "\"byteStride\":2,\"count\":3e9",
         "shorter than so many indices", EWA_ERROR_FORMAT},
        {2, "\"byteLength\":265,\"mode\":\"ATTRIBUTES\",\"byteStride\":8,\"count\":35",
         "\"byteLength\":65,\"mode\":\"ATTRIBUTES\",\"byteStride\":8,\"count\":9e9",
         "shorter than so many vertices", EWA_ERROR_FORMAT},
    };
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; n++) {
        size_t size_bytes;
        OWNED(check_free) uint8_t *bytes = read_corpus(packed_names[cases[n].file], &size_bytes);
        replace(bytes, size_bytes, cases[n].from, cases[n].to);
        const ewa_status status = try_bytes(bytes, size_bytes);
        char said[128];
        snprintf(said, sizeof said, "%s", cases[n].said);
        bool found = false;
        for (char *word = strtok(said, "|"); word; word = strtok(NULL, "|"))
            found |= strstr(messages.text, word) != NULL;
        if (status != cases[n].status || !found)
            fail_msg("%s for %s: %d, %s", cases[n].to, cases[n].from, status, messages.text);
    }
}

static ewa_status load_packed(ewa_context *failing, void *user) {
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = read_corpus(user, &size_bytes);
    ewa_model model;
    const ewa_status status =
        ewa_model_load_memory(failing, bytes, size_bytes, "a.glb", NULL, EWA_MODEL_MESH, NULL, &model);
    if (status == EWA_OK) ewa_model_free(&model);
    return status;
}

TEST(test_failing_allocations) {
    for (int n = 0; n < PACKED; n++) {
        char name[64];
        snprintf(name, sizeof name, "%s", packed_names[n]);
        scratch_fail_each(load_packed, name);
    }
}

int main(void) { return RUN_TESTS(begin, end); }
