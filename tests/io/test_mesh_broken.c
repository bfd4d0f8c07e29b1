// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Meshes that are wrong: every truncation of a file of each format, thousands of seeded changes of it, the
// n-th allocation failing, limits. Each is a mesh or a clear failure; mesh_real has hostile files from
// elsewhere.
#include "io/mesh_check.h"

#include <time.h>

typedef struct sample {
    const char *name;
    const uint8_t *bytes;
    size_t size_bytes;
} sample;

#define PLY_HEAD(format)                                                                                     \
    "ply\nformat " format                                                                                    \
    " 1.0\ncomment TextureFile none.png\nelement camera 1\nproperty list uchar float k\n"                    \
    "element vertex 5\nproperty float x\nproperty float y\nproperty double z\nproperty uchar red\n"          \
    "property uchar green\nproperty uchar blue\nproperty float nx\nproperty float ny\nproperty float nz\n"   \
    "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"           \
    "property int texnumber\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"

static const char ply[] =
    PLY_HEAD("ascii") "2 0.5 1\n0 0 0 255 0 0 0 0 1\n2 0 0 255 0 0 0 0 1\n2 3 0 255 0 0 0 0 1\n"
                      "0 3 0 255 0 0 0 0 1\n1 4 0 1 2 3 0 0 1\n3 0 1 2 6 0 0 1 0 1 1 0\n"
                      "5 0 1 2 4 3 0 0\n6 0 1 2 -1 3 4\n";
static const char obj[] =
    "# a\nmtllib none.mtl\no a\nv 0 0 0 1 0 0\nv 2 0 0 1 0 0\nv 2 3 0 1 0 0\nv 0 3 0 1 0 0\nv 1 4 0\n"
    "vt 0 0\nvt 1 0\nvn 0 0 1\ng b\nusemtl m\ns 1\nf 1/1/1 2/2/1 \\\n3/2/1\nf -5 -4 -3 -1 -2\nl 1 2\np 1\nf "
    "1//1 3//1 4//1\n";
static const char stl[] =
    "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 0 0\nvertex 2 3 0\nendloop\nendfacet\n"
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 3 0\nvertex 0 3 0\nvertex 1 5 "
    "2\nendloop\nendfacet\nendsolid s\n";
static const char off[] =
    "STCNOFF\n4 2 5\n0 0 0 0 0 1 1 0 0 1 0 0\n2 0 0 0 0 1 1 0 0 1 1 0\n2 3 0 0 0 1 1 0 0 1 1 1\n"
    "0 3 0 0 0 1 1 0 0 1 0 1\n4 0 1 2 3\n3 0 1 2 0 255 0\n";
static const char gltf[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"children\":[1],\"scale\":[1,"
    "2,-1]},{\"mesh\":0}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"material\":0,\"mode\":"
    "5}]}],\"materials\":[{\"alphaMode\":\"MASK\","
    "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,1,1,1],\"baseColorTexture\":{\"index\":0,"
    "\"extensions\":{\"KHR_texture_transform\":{\"offset\":[1,0]}}}}}],"
    "\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z8AAAAMBAQDJ/"
    "pLvAAAAAElFTkSuQmCC\"}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{"
    "\"count\":1,\"indices\":{\"bufferView\":1,\"componentType\":5121},"
    "\"values\":{\"bufferView\":0}}},{\"bufferView\":0,\"componentType\":5121,\"normalized\":true,\"count\":"
    "3,\"type\":\"VEC2\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},"
    "{\"buffer\":0,\"byteOffset\":1,\"byteLength\":1}],"
    "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/"
    "octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";

static uint8_t binary_ply[1024], binary_stl[256], glb[4096];

/// A number, lowest byte first.
static size_t put(uint8_t *to, uint64_t value, int bytes) {
    for (int i = 0; i < bytes; i++) to[i] = (uint8_t)(value >> 8 * i);
    return (size_t)bytes;
}

static size_t put_float(uint8_t *to, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return put(to, bits, 4);
}

static size_t make_binary_ply(void) {
    static const double places[5][3] = {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}, {1, 4, 0}};
    size_t at =
        (size_t)snprintf((char *)binary_ply, sizeof binary_ply, "%s", PLY_HEAD("binary_little_endian"));
    at += put(binary_ply + at, 1, 1);
    at += put_float(binary_ply + at, 0.5f);
    for (int v = 0; v < 5; v++) {
        uint64_t bits;
        at += put_float(binary_ply + at, (float)places[v][0]);
        at += put_float(binary_ply + at, (float)places[v][1]);
        memcpy(&bits, &places[v][2], sizeof bits);
        at += put(binary_ply + at, bits, 8);
        at += put(binary_ply + at, 0xff, 3);
        for (int c = 0; c < 3; c++) at += put_float(binary_ply + at, c == 2);
    }
    for (int f = 0; f < 2; f++) {
        static const int corners[2][5] = {{0, 1, 2}, {0, 1, 2, 4, 3}};
        const int count = f ? 5 : 3;
        at += put(binary_ply + at, (uint64_t)count, 1);
        for (int c = 0; c < count; c++) at += put(binary_ply + at, (uint64_t)corners[f][c], 4);
        at += put(binary_ply + at, (uint64_t)(2 * count), 1);
        for (int c = 0; c < 2 * count; c++) at += put_float(binary_ply + at, (float)c);
        at += put(binary_ply + at, 0, 4);
    }
    at += put(binary_ply + at, 4, 4);
    for (int c = 0; c < 4; c++) at += put(binary_ply + at, c == 3 ? 0xffffffffu : (uint64_t)c, 4);
    return at;
}

static size_t make_binary_stl(void) {
    static const char head[] = "COLOR=\xff\x80\x40\xff";
    size_t at = 80;
    memset(binary_stl, ' ', at);
    memcpy(binary_stl, head, sizeof head - 1);
    at += put(binary_stl + at, 2, 4);
    for (int t = 0; t < 2; t++) {
        for (int i = 0; i < 12; i++) at += put_float(binary_stl + at, (float)(i * (i + t) % 5));
        at += put(binary_stl + at, 31, 2);
    }
    return at;
}

static size_t make_glb(void) {
    const size_t json = (sizeof gltf + 2) / 4 * 4;
    memcpy(glb, "glTF", 4);
    put(glb + 4, 2, 4);
    put(glb + 8, 28 + json + 36, 4);
    put(glb + 12, json, 4);
    memcpy(glb + 16, "JSON", 4);
    memset(glb + 20, ' ', json);
    memcpy(glb + 20, gltf, sizeof gltf - 1);
    put(glb + 20 + json, 36, 4);
    memcpy(glb + 24 + json, "BIN", 4);
    memset(glb + 28 + json, 0x3f, 36);
    return 28 + json + 36;
}

enum { SAMPLES = 8 };
static sample samples[SAMPLES];

static int make_samples(void **state) {
    const sample made[SAMPLES] = {
        {"a.ply", (const uint8_t *)ply, sizeof ply - 1},    {"b.ply", binary_ply, make_binary_ply()},
        {"a.obj", (const uint8_t *)obj, sizeof obj - 1},    {"a.stl", (const uint8_t *)stl, sizeof stl - 1},
        {"b.stl", binary_stl, make_binary_stl()},           {"a.off", (const uint8_t *)off, sizeof off - 1},
        {"a.gltf", (const uint8_t *)gltf, sizeof gltf - 1}, {"a.glb", glb, make_glb()}};
    memcpy(samples, made, sizeof made);
    return 0;
}

/// Loads exactly so many bytes, so that a sanitizer sees the first one too many; checks what comes.
static ewa_status try_bytes(ewa_context *context, mesh_messages *messages, const char *name,
                            const uint8_t *bytes, size_t size_bytes) {
    uint8_t *copy = malloc(size_bytes ? size_bytes : 1);
    memcpy(copy, bytes, size_bytes);
    ewa_model model;
    *messages = (mesh_messages){.errors = 0};
    const ewa_status status = ewa_model_load_memory(context, copy, size_bytes, name, NULL,
                                                    EWA_MODEL_MESH | EWA_MODEL_POINTS, NULL, &model);
    free(copy);
    if (status == EWA_OK) {
        assert_int_equal(messages->errors, 0);
        assert_non_null(model.points);
        for (uint64_t i = 0; i < 3 * (uint64_t)model.mesh.triangle_count; i++)
            assert_true(model.mesh.triangles[i] < model.mesh.vertex_count);
        for (uint32_t t = 0; model.mesh.material_count && t < model.mesh.triangle_count; t++)
            assert_true(model.mesh.triangle_materials[t] < model.mesh.material_count);
        bool closed;
        if (model.mesh.triangle_count) assert_int_equal(ewa_mesh_is_closed(&model.mesh, &closed), EWA_OK);
        ewa_model_free(&model);
    } else {
        assert_true(messages->errors > 0);
        assert_true(!model.mesh.positions && !model.points && !model.elements);
    }
    return status;
}

TEST(test_samples_load) {
    mesh_messages messages;
    OWNED(ewa_context_destroy) ewa_context *context = mesh_context(&messages);
    for (int i = 0; i < SAMPLES; i++) {
        const ewa_status status =
            try_bytes(context, &messages, samples[i].name, samples[i].bytes, samples[i].size_bytes);
        if (status != EWA_OK) fail_msg("%s: %s", samples[i].name, messages.text);
    }
}

TEST(test_every_truncation) {
    mesh_messages messages;
    OWNED(ewa_context_destroy) ewa_context *context = mesh_context(&messages);
    for (int i = 0; i < SAMPLES; i++)
        for (size_t size = 0; size < samples[i].size_bytes; size++)
            try_bytes(context, &messages, samples[i].name, samples[i].bytes, size);
}

/// Seeded changes of bytes: flipped bits, numbers of extreme size, pieces doubled, moved and lost.
static size_t change(check_random *random, const sample *from, uint8_t *to, size_t room) {
    size_t size = from->size_bytes;
    memcpy(to, from->bytes, size);
    for (uint64_t changes = 1 + check_random_u64(random) % 4; changes > 0; changes--) {
        const size_t at = check_random_u64(random) % size, length = check_random_u64(random) % 16,
                     left = size - at;
        static const char *const words[] = {"-1", "0", "4294967295", "nan", "1e308",
                                            "-",  "/", " ",          "\n",  "99999999999999999999"};
        switch (check_random_u64(random) % 6) {
        case 0:
            to[at] ^= (uint8_t)(1u << check_random_u64(random) % 8);
            break;
        case 1:
            to[at] = (uint8_t)check_random_u64(random);
            break;
        case 2: // a number of extreme size
            memset(to + at, check_random_u64(random) % 2 ? 0xff : 0x7f, left < 4 ? left : 4);
            break;
        case 3: // a piece twice
            if (size + length >= room || length > left) break;
            memmove(to + at + length, to + at, left);
            size += length;
            break;
        case 4: // a piece less
            if (length >= left) break;
            memmove(to + at, to + at + length, left - length);
            size -= length;
            break;
        default: { // another word
            const char *word = words[check_random_u64(random) % (sizeof words / sizeof words[0])];
            const size_t word_length = strlen(word);
            if (word_length < left) memcpy(to + at, word, word_length);
        }
        }
    }
    return size;
}

TEST(test_changed_bytes) {
    mesh_messages messages;
    OWNED(ewa_context_destroy) ewa_context *context = mesh_context(&messages);
    const char *wanted = getenv("EWA_MUTATIONS");
    const long count = wanted ? atol(wanted) : 2000; // of each format
    uint64_t loaded = 0;
    for (int i = 0; i < SAMPLES; i++) {
        check_random random = {(uint64_t)i + 1};
        for (long k = 0; k < count; k++) {
            uint8_t bytes[8192];
            const size_t size = change(&random, &samples[i], bytes, sizeof bytes);
            loaded += try_bytes(context, &messages, samples[i].name, bytes, size) == EWA_OK;
        }
    }
    // Some are harmless, some are not.
    assert_true(loaded > (uint64_t)count / 2 && loaded < (uint64_t)(SAMPLES * count) * 9 / 10);
    print_message("%llu of %ld changed files are meshes\n", (unsigned long long)loaded, SAMPLES * count);
}

/// A sample as a file with a library and a picture beside it, so that these are read too.
static ewa_status load_file(ewa_context *context, void *user) {
    OWNED(ewa_model_free) ewa_model model;
    const ewa_status status =
        ewa_model_load(context, user, EWA_MODEL_MESH | EWA_MODEL_POINTS | EWA_MODEL_ELEMENTS, NULL, &model);
    bool closed;
    const ewa_status closing = status == EWA_OK ? ewa_mesh_is_closed(&model.mesh, &closed) : status;
    return closing;
}

TEST(test_failing_allocations) {
    char path[512];
    mesh_messages messages;
    ewa_context *context = mesh_context(&messages);
    mesh_picture(context, "none.png", 255, 0, 0);
    ewa_context_destroy(&context);
    static const char library[] =
        "\xff\xfen\0e\0w\0m\0t\0l\0 \0m\0\n\0m\0a\0p\0_\0K\0d\0 \0n\0o\0n\0e\0.\0p\0n\0g\0\n"; // UTF-16
    scratch_write(scratch_path("none.mtl", path), library, sizeof library);
    for (int i = 0; i < SAMPLES; i++) {
        char name[64];
        snprintf(name, sizeof name, "memory_%s", samples[i].name);
        scratch_write(scratch_path(name, path), samples[i].bytes, samples[i].size_bytes);
        scratch_fail_each(load_file, path);
    }
    unlink(scratch_path("none.mtl", path));
    unlink(scratch_path("none.png", path));
}

/// Limits hold before memory is taken: as many points, triangles and bytes as the context allows.
TEST(test_limits) {
    for (int i = 0; i < SAMPLES; i++)
        for (int kind = 0; kind < 2; kind++) {
            mesh_messages messages = {.errors = 0};
            WITH_DEFAULTS(ewa_context_options, options);
            options.thread_count = 1;
            options.message = mesh_keep;
            options.message_user = &messages;
            if (kind)
                options.limits.max_memory_bytes = 96;
            else
                options.limits.max_points = 2;
            OWNED(ewa_context_destroy) ewa_context *context = NULL;
            assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
            const ewa_status status =
                try_bytes(context, &messages, samples[i].name, samples[i].bytes, samples[i].size_bytes);
            // What is small is asked for without a look at its size first.
            if (status != EWA_ERROR_LIMIT && !(kind && status == EWA_ERROR_MEMORY))
                fail_msg("%s: %d %s", samples[i].name, status, messages.text);
            if (kind) mesh_says(&messages, " of max_memory_bytes 96 are left");
        }
    // Counts that lie need no memory: of faces, of corners, of triangles.
    static const char *const lies[] = {
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
        "z\nelement face 4000000000\n"
        "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
        "z\nelement face 1\n"
        "property list uint int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n",
        "OFF\n4000000000 4000000000 0\n0 0 0\n", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n999999999 0 1 2\n"};
    for (size_t i = 0; i < sizeof lies / sizeof lies[0]; i++) {
        check_memory memory = {.calls_left = -1};
        check_log log = {0};
        ewa_context *context = scratch_context(&memory, &log);
        ewa_model model;
        assert_int_equal(ewa_model_load_memory(context, lies[i], strlen(lies[i]), "lie", NULL, EWA_MODEL_MESH,
                                               NULL, &model),
                         EWA_ERROR_FORMAT);
        ewa_context_destroy(&context);
        assert_int_equal(memory.held_bytes, 0);
    }
}

/// Polygons that clip_ears() would work on for hours.
TEST(test_time) {
    enum { CORNERS = 3000, FACES = 40 };
    mesh_messages messages;
    OWNED(ewa_context_destroy) ewa_context *context = mesh_context(&messages);
    OWNED(check_free) char *text = malloc(CORNERS * 64 + (size_t)FACES * CORNERS * 8);
    size_t at = 0;
    check_random random = {3};
    for (int i = 0; i < CORNERS; i++)
        at += (size_t)sprintf(text + at, "v %g %g 0\n", check_uniform(&random, 0, 1),
                              check_uniform(&random, 0, 1));
    for (int f = 0; f < FACES; f++) {
        at += (size_t)sprintf(text + at, "f");
        for (int i = 1; i <= CORNERS; i++) at += (size_t)sprintf(text + at, " %d", i);
        at += (size_t)sprintf(text + at, "\n");
    }
    struct timespec before, after;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &before);
    ewa_model model;
    assert_int_equal(ewa_model_load_memory(context, text, at, "a.obj", NULL, EWA_MODEL_MESH, NULL, &model),
                     EWA_OK);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &after);
    mesh_says(&messages, "polygons meet themselves or are too large");
    ewa_model_free(&model);
    const double took =
        (double)(after.tv_sec - before.tv_sec) + 1e-9 * (double)(after.tv_nsec - before.tv_nsec);
    print_message("%d tangled polygons of %d corners in %.1f s\n", FACES, CORNERS, took);
    assert_true(took < 60); // under sanitizers
}

/// Every format under every name, and what is none.
TEST(test_probe) {
    mesh_messages messages;
    OWNED(ewa_context_destroy) ewa_context *context = mesh_context(&messages);
    static const ewa_model_format formats[SAMPLES] = {EWA_MODEL_PLY,  EWA_MODEL_PLY, EWA_MODEL_OBJ,
                                                      EWA_MODEL_STL,  EWA_MODEL_STL, EWA_MODEL_OFF,
                                                      EWA_MODEL_GLTF, EWA_MODEL_GLTF};
    static const char *const names[] = {"a", "a.ply", "a.obj", "a.stl", "a.off", "a.gltf", "a.txt"};
    for (int i = 0; i < SAMPLES; i++)
        for (size_t n = 0; n < sizeof names / sizeof names[0]; n++) {
            OWNED(ewa_model_free) ewa_model model;
            assert_int_equal(ewa_model_load_memory(context, samples[i].bytes, samples[i].size_bytes, names[n],
                                                   NULL, EWA_MODEL_MESH, NULL, &model),
                             EWA_OK);
            assert_int_equal(model.format, formats[i]);
            assert_true(strcmp(ewa_model_format_name(model.format), "unknown") != 0);
        }
    static const char *const none[] = {"hello world\n",
                                       "v ertex\n",
                                       "f\n",
                                       "\x7f"
                                       "ELF",
                                       "OFFICE 3 4\n",
                                       "P6\n1 1\n",
                                       "vt\n",
                                       "# only a remark\n"};
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
        ewa_model model;
        messages = (mesh_messages){.errors = 0};
        assert_int_equal(ewa_model_load_memory(context, none[i], strlen(none[i]), "a.txt", NULL,
                                               EWA_MODEL_MESH, NULL, &model),
                         EWA_ERROR_UNSUPPORTED);
        mesh_says(&messages,
                  "a.txt: no file of points or triangles of a known format (PLY, LAS, LAZ, E57, PCD, "
                  "PTX, PTS, XYZ, CSV, ASCII grids, GeoTIFF, OBJ, STL, OFF, glTF, VTK)");
    }
    static const struct {
        const char *text, *said;
    } foreign[] = {
        {"# Blender\n\nnewmtl a\nKd 1 1 1\n", "the materials of a mesh (MTL): name the OBJ that uses them"},
        {"# Bundle file v0.3\n2 3\n1000 0 0\n", "a reconstruction of Bundler"},
        {"{\"width\": 3}", "JSON that is no glTF, no octree (EPT), no set of Gaussians (SOG) and no scene file"},
        {"version https://git-lfs.github.com/spec/v1\noid sha256:4d\n", "a pointer of Git LFS"},
        {"<!DOCTYPE html>\n<title>404</title>", "a page of HTML"},
        {"PK\003\004xxxx", "a ZIP archive: unpack it"},
        {"\037\213xxxx", "packed by gzip: unpack it"},
        {"<?xml version=\"1.0\"?>\n<VTKFile type=\"vtkMultiBlockDataSet\">", "a list of files, which are not read without its folder"},
        {"<VTKFile type=\"ImageData\">", "its name has to end in .vti"},
        {"ISO-10303-21;", "CAD (STEP)"},
        {"#VRML V2.0 utf8\n", "VRML, which is not read: exported as glTF or OBJ it is"},
        {"<?xml version=\"1.0\"?>\n<COLLADA version=\"1.4.1\">", "COLLADA, which is not read"},
        {"IDP2xxxx", "a model of a game (MD2)"},
        {"{\"camera_angle_x\": 0.7, \"frames\": [{\"transform_matrix\": []}]}", "cameras (JSON), which have no points"},
        {"\223NUMPY\1", "an array of NumPy: in Python"},
    };
    for (size_t i = 0; i < sizeof foreign / sizeof foreign[0]; i++) {
        for (size_t k = 0; k < sizeof names / sizeof names[0]; k++)
            mesh_refuse(context, &messages, names[k], foreign[i].text, strlen(foreign[i].text), EWA_ERROR_UNSUPPORTED,
                        foreign[i].said);
    }
    static const char dicom[200] = {[128] = 'D', 'I', 'C', 'M'};
    mesh_refuse(context, &messages, "a.dcm", dicom, sizeof dicom, EWA_ERROR_UNSUPPORTED, "DICOM, which is not read: a NIfTI file");
    ewa_model model;
    assert_int_equal(ewa_model_load_memory(context, "", 0, "a.obj", NULL, EWA_MODEL_MESH, NULL, &model),
                     EWA_ERROR_FORMAT);
    assert_int_equal(ewa_model_load(context, "/no/such.obj", EWA_MODEL_MESH, NULL, &model), EWA_ERROR_IO);
    assert_int_equal(ewa_model_load(NULL, "a", 0, NULL, &model), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_model_load_memory(context, NULL, 4, "a", NULL, 0, NULL, &model), EWA_ERROR_ARGUMENT);
    ewa_model_free(NULL);
}

int main(void) { return RUN_TESTS(make_samples, NULL); }
