// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Every form of Gaussians that is read but plain PLY: small files made by hand give the numbers they were made of; cut
// short at any byte, and broken at random, they are refused with a reason or give a set that is in order.
#include "gaussian_sample.h"
#include "scratch.h"

static bool file_is_spz(int number) { return number >= 5 && number <= 8; }

TEST(forms) {
    static sample_file file;
    uint32_t degree;
    sample_limits limits;
    for (int number = 0; sample_make(number, &file, &degree, &limits); number++) {
        check_log log = {.count = 0};
        OWNED(ewa_context_destroy) ewa_context *context = check_context(2, &log);
        OWNED(ewa_gaussians_free) ewa_gaussians set;
        ewa_gaussian_facts facts;
        if (ewa_gaussians_load_memory(context, file.bytes, file.size, "test", NULL, &set, &facts) != EWA_OK)
            fail_msg("form %d: %s", number, log.text);
        static const ewa_gaussian_format formats[18] = {
            EWA_GAUSSIANS_PACKED_PLY, EWA_GAUSSIANS_PACKED_PLY, EWA_GAUSSIANS_PACKED_PLY,
            EWA_GAUSSIANS_PACKED_PLY, EWA_GAUSSIANS_SPLAT,      EWA_GAUSSIANS_SPZ,
            EWA_GAUSSIANS_SPZ,        EWA_GAUSSIANS_SPZ,        EWA_GAUSSIANS_SPZ,
            EWA_GAUSSIANS_KSPLAT,     EWA_GAUSSIANS_KSPLAT,     EWA_GAUSSIANS_KSPLAT,
            EWA_GAUSSIANS_GLTF,       EWA_GAUSSIANS_GLTF,       EWA_GAUSSIANS_GLTF,
            EWA_GAUSSIANS_GLTF,       EWA_GAUSSIANS_SOG,        EWA_GAUSSIANS_SOG};
        assert_int_equal(facts.format, formats[number]);
        assert_int_equal(facts.size_bytes, file.size);
        assert_int_equal(log.count, 0);
        // Its numbers are right, up, back.
        if (file_is_spz(number)) sample_turn_over(&set);
        sample_check(&set, degree, &limits);
        assert_true(set.antialiased ==
                    (facts.format == EWA_GAUSSIANS_SPZ || number == 16)); // SOG 1 cannot say so
        if (facts.format == EWA_GAUSSIANS_SPZ) assert_int_equal(facts.version, number - 4);
        if (facts.format == EWA_GAUSSIANS_SOG) assert_int_equal(facts.version, number == 16 ? 2 : 1);
    }
}

/// Whether a set is what it says.
static void check_in_order(const ewa_gaussians *set) {
    const uint32_t numbers = 3 * (set->sh_degree + 1) * (set->sh_degree + 1);
    for (uint32_t i = 0; i < set->count; i++) {
        double norm2 = 0, sum = 0;
        for (uint32_t k = 0; k < 4; k++) norm2 += pow((double)set->rotations[4 * i + k], 2);
        assert_true(fabs(norm2 - 1) < 1e-5);
        for (uint32_t k = 0; k < 3; k++) {
            sum += (double)set->centers[3 * i + k];
            assert_true(set->scales[3 * i + k] >= 0 && isfinite(set->scales[3 * i + k]));
        }
        for (uint32_t k = 0; k < numbers; k++) sum += (double)set->harmonics[i * numbers + k];
        assert_true(isfinite(sum));
        assert_true(set->opacities[i] >= 0 && set->opacities[i] <= 1);
    }
}

/// Loads bytes in memory of their own size, so that a sanitizer sees what is read beyond them.
static ewa_status load_exact(ewa_context *context, const uint8_t *bytes, size_t size, check_log *log) {
    OWNED(check_free) uint8_t *own = malloc(size ? size : 1);
    assert_non_null(own);
    memcpy(own, bytes, size);
    OWNED(ewa_gaussians_free) ewa_gaussians set;
    memset(log, 0, sizeof *log);
    const ewa_status status = ewa_gaussians_load_memory(context, own, size, "test", NULL, &set, NULL);
    if (status == EWA_OK)
        check_in_order(&set);
    else
        assert_true(set.centers == NULL && set.count == 0 && log->count > 0);
    return status;
}

TEST(cut_short) {
    static sample_file file;
    uint32_t degree;
    sample_limits limits;
    for (int number = 0; sample_make(number, &file, &degree, &limits); number++) {
        check_log log;
        OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
        for (size_t cut = 0; cut<file.size; cut += cut> 300 && cut + 300 < file.size && number > 8 ? 7 : 1) {
            const ewa_status status = load_exact(context, file.bytes, cut, &log);
            // Whole records of .splat are a .splat.
            if (status == EWA_OK && !(number == 4 && cut % 32 == 0))
                fail_msg("form %d read from %zu bytes", number, cut);
        }
    }
}

TEST(broken) {
    static sample_file file;
    uint32_t degree;
    sample_limits limits;
    check_random random = {3};
    for (int number = 0; sample_make(number, &file, &degree, &limits); number++) {
        check_log log;
        OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
        static uint8_t copy[SAMPLE_ROOM];
        for (int round = 0; round < 600; round++) {
            memcpy(copy, file.bytes, file.size);
            const uint64_t changes = 1 + check_random_u64(&random) % 4;
            for (uint64_t c = 0; c < changes; c++) {
                // Heads are looked at most closely.
                const size_t room = round % 2 && file.size > 64 ? 64 : file.size;
                copy[check_random_u64(&random) % room] = (uint8_t)check_random_u64(&random);
            }
            load_exact(context, copy, file.size, &log);
        }
    }
}

typedef struct refusal {
    int number; ///< of the form
    size_t at;  ///< byte that is changed
    int value;
    ewa_status status;
    const char *reason;
} refusal;

static void refuse(const sample_file *file, ewa_status status, const char *reason) {
    check_log log;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    const ewa_status got = load_exact(context, file->bytes, file->size, &log);
    if (got != status || !strstr(log.text, reason))
        fail_msg("%s: '%s', not '%s'", ewa_status_name(got), log.text, reason);
}

/// Versions, counts and numbers that cannot be.
TEST(lies) {
    static sample_file file;
    uint32_t degree;
    sample_limits limits;
    static const refusal cases[] = {
        {8, 4, 5, EWA_ERROR_UNSUPPORTED, "SPZ of version 5; 1 to 4 are read"},
        {8, 4, 3, EWA_ERROR_FORMAT, "that is not packed"},
        {8, 12, 5, EWA_ERROR_UNSUPPORTED, "spherical harmonics of degree 5"},
        {8, 13, 77, EWA_ERROR_FORMAT, "77 bits of fraction"},
        {8, 8, 4, EWA_ERROR_FORMAT, "stream 0"},
        {8, 11, 127, EWA_ERROR_FORMAT, "which a file of"},
        {8, 15, 5, EWA_ERROR_FORMAT, "a table of 5 streams"},
        {8, 16, 255, EWA_ERROR_FORMAT, "table of 6 streams at byte 255"},
        {9, 1, 0, EWA_ERROR_UNSUPPORTED, "no Gaussians of a known form"},
        {9, 20, 3, EWA_ERROR_UNSUPPORTED, "no Gaussians of a known form"},
        {9, 16, 200, EWA_ERROR_FORMAT, "not as many records as the header says"},
        {9, 4096, 2, EWA_ERROR_FORMAT, "not as many records as the header says"},
        {9, 4096, 9, EWA_ERROR_FORMAT, "more records than it has room for"},
        {10, 4096 + 7, 1, EWA_ERROR_FORMAT, "a section ends behind the file"},
        {10, 4096 + 20, 4, EWA_ERROR_FORMAT, "buckets that are no three floats"},
        {10, 4096 + 32, 2, EWA_ERROR_FORMAT, "fewer buckets than it uses"},
        {10, 4096 + 8, 1, EWA_ERROR_FORMAT, "in none of the buckets"},
        {10, 4096 + 40, 3, EWA_ERROR_UNSUPPORTED, "no Gaussians of a known form"},
        {9, 4096 + 1024 + 28 + 12 + 3, 0xff, EWA_ERROR_FORMAT, "Gaussian 0 of 3: a scale is not finite"},
        {9, 4096 + 1024 + 28 + 3, 0xff, EWA_ERROR_FORMAT, "Gaussian 0 of 3: a coordinate"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assert_true(sample_make(cases[i].number, &file, &degree, &limits));
        file.bytes[cases[i].at] = (uint8_t)cases[i].value;
        if (cases[i].number == 9 && cases[i].at > 5120) file.bytes[cases[i].at - 1] = 0xff;
        refuse(&file, cases[i].status, cases[i].reason);
    }
    // A quaternion of zeros, which the suffix does not let pass for something else.
    sample_splat(&file);
    memset(file.bytes + 32 + 28, 128, 4);
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    ewa_gaussians set;
    assert_int_equal(ewa_gaussians_load_memory(context, file.bytes, file.size, "a.splat", NULL, &set, NULL),
                     EWA_ERROR_FORMAT);
    assert_non_null(strstr(log.text, "Gaussian 1 of 3: the quaternion is zero"));
    assert_int_equal(
        ewa_gaussians_load_memory(context, file.bytes, file.size - 1, "a.SPLAT", NULL, &set, NULL),
        EWA_ERROR_FORMAT);
    assert_non_null(strstr(log.text, "no whole number of records"));
    assert_int_equal(ewa_gaussians_load_memory(context, "", 0, "a.splat", NULL, &set, NULL),
                     EWA_ERROR_FORMAT);
}

/// Replaces a piece of a file by one of the same length.
static void replace(sample_file *file, const char *old, const char *with) {
    const size_t length = strlen(old);
    assert_int_equal(strlen(with), length);
    for (size_t at = 0; at + length <= file->size; at++)
        if (memcmp(file->bytes + at, old, length) == 0) {
            memcpy(file->bytes + at, with, length);
            return;
        }
    fail_msg("there is no %s", old);
}

TEST(words) {
    static sample_file file;
    const struct {
        int number;
        const char *old, *with, *reason;
        ewa_status status;
    } cases[] = {
        {0, "element chunk 1", "element chink 1", "without an element 'chunk'", EWA_ERROR_FORMAT},
        {0, "element vertex 3\nproperty uint packed_position",
         "element vertex 3\nproperty  int packed_position", "without a property packed_position of type uint",
         EWA_ERROR_FORMAT},
        {2, "element sh 3", "element sh 2", "2 records of 9 coefficients", EWA_ERROR_FORMAT},
        {2, "property uchar f_rest_8", "property uchar f_rest_9", "without a property f_rest_8",
         EWA_ERROR_FORMAT},
        {13, "\"ellipse\"", "\"ellipsa\"", "the kernel 'ellipsa'", EWA_ERROR_UNSUPPORTED},
        {13, "\"mode\":0", "\"mode\":4", "is not of points", EWA_ERROR_FORMAT},
        {13, "splatting:SCALE\"", "splatting:SCALA\"", "without SCALE", EWA_ERROR_FORMAT},
        {13, "splatting:ROTATION\"", "splatting:ROTATIVE\"", "without ROTATION", EWA_ERROR_FORMAT},
        {13, "splatting:OPACITY\"", "splatting:OPACITA\"", "without OPACITY or", EWA_ERROR_FORMAT},
    };
    uint32_t degree;
    sample_limits limits;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assert_true(sample_make(cases[i].number, &file, &degree, &limits));
        replace(&file, cases[i].old, cases[i].with);
        refuse(&file, cases[i].status, cases[i].reason);
    }
    sample_sog(&file, "7");
    refuse(&file, EWA_ERROR_UNSUPPORTED, "SOG of version 7; 1 and 2 are read");
    sample_sog(&file, "\"2\"");
    refuse(&file, EWA_ERROR_FORMAT, "version is no number");
}

/// What version 1 of SOG may not say.
TEST(steps) {
    static sample_file meta;
    static const struct {
        const char *old, *with, *reason;
    } cases[] = {
        {"\"shape\":[3,3],\"dtype\"", "\"shape\":\"333\",\"dtype\"", "means.shape begins with no number"},
        {"\"maxs\":[4,4,4]", "\"maxs\":[4,444]", "means.mins or means.maxs are no three numbers"},
        {"\"mins\":[-3,-3,-3]", "\"mins\":[-3,-3,\"\"]", "scales.mins or scales.maxs are no three numbers"},
        {"\"maxs\":[1,1,1,2]", "\"maxs\":[1,1,112]", "sh0.mins or sh0.maxs are no four numbers"},
        {"\"mins\":-0.25", "\"mins\":[0.2]", "shN.mins or shN.maxs is no number"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        sample_sog_meta_1(&meta);
        replace(&meta, cases[i].old, cases[i].with);
        refuse(&meta, EWA_ERROR_FORMAT, cases[i].reason);
    }
}

/// A picture of SOG with other bytes.
TEST(palettes) {
    static sample_file meta, file, directory;
    static const struct {
        int picture;
        uint8_t rgba[4];
        const char *reason;
    } cases[] = {{3, {128, 128, 128, 251}, "a quaternion's alpha is below 252"},
                 {6, {64, 0, 0, 255}, "a label is beyond the palettes"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        sample_sog_meta(&meta, "2");
        file.size = directory.size = 0;
        for (int picture = 0; picture < SAMPLE_PICTURES; picture++) {
            uint8_t *webp = NULL, codes[4 * SAMPLE_COUNT];
            size_t size = sample_sog_picture(picture, false, &webp);
            if (picture == cases[i].picture) {
                WebPFree(webp);
                for (size_t k = 0; k < sizeof codes; k++) codes[k] = cases[i].rgba[k % 4];
                size = WebPEncodeLosslessRGBA(codes, SAMPLE_COUNT, 1, 4 * SAMPLE_COUNT, &webp);
            }
            sample_zip_add(&file, &directory, sample_picture_names[picture], webp, size, false);
            WebPFree(webp);
        }
        sample_zip_add(&file, &directory, "meta.json", meta.bytes, meta.size, true);
        const uint32_t at = (uint32_t)file.size;
        sample_put(&file, directory.bytes, directory.size);
        sample_put(&file, "PK\5\6\0\0\0\0", 8);
        sample_u16(&file, SAMPLE_PICTURES + 1);
        sample_u16(&file, SAMPLE_PICTURES + 1);
        sample_u32(&file, (uint32_t)directory.size);
        sample_u32(&file, at);
        sample_u16(&file, 0);
        refuse(&file, EWA_ERROR_FORMAT, cases[i].reason);
    }
}

/// meta.json with its pictures beside it, and without.
TEST(beside) {
    static sample_file meta;
    char path[512], name[64];
    for (int picture = 0; picture < SAMPLE_PICTURES; picture++) {
        uint8_t *webp = NULL;
        const size_t size = sample_sog_picture(picture, false, &webp);
        snprintf(name, sizeof name, "%s", sample_picture_names[picture]);
        scratch_write(scratch_path(name, path), webp, size);
        WebPFree(webp);
    }
    sample_sog_meta(&meta, "2");
    scratch_write(scratch_path("meta.json", path), meta.bytes, meta.size);
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    ewa_gaussians set;
    ewa_gaussian_format format;
    assert_int_equal(ewa_gaussians_probe(context, path, &format), EWA_OK);
    assert_int_equal(format, EWA_GAUSSIANS_SOG);
    assert_int_equal(ewa_gaussians_load(context, path, &set, NULL), EWA_OK);
    sample_check(&set, 1, &(sample_limits){2e-3, 1e-6, 2e-5, 2e-3, 1e-6, 1e-6});
    ewa_gaussians_free(&set);
    assert_int_equal(ewa_gaussians_load_memory(context, meta.bytes, meta.size, "meta.json", NULL, &set, NULL),
                     EWA_ERROR_IO);
    assert_non_null(strstr(log.text, "means_l.webp"));
}

/// A node moves, turns and scales what hangs on it.
TEST_ON(placed, 1) {
    static sample_file file;
    sample_glb(&file, 1,
               "\"translation\":[10,20,30],\"rotation\":[0,0,0.70710678,0.70710678],\"scale\":[2,2,2],",
               "KHR_gaussian_splatting:");
    OWNED(ewa_gaussians_free) ewa_gaussians set;
    ewa_gaussian_facts facts;
    assert_int_equal(ewa_gaussians_load_memory(context, file.bytes, file.size, "test", NULL, &set, &facts),
                     EWA_OK);
    assert_true(facts.up_world[1] == 1);
    for (uint32_t i = 0; i < SAMPLE_COUNT; i++) {
        sample_near("x", i, set.centers[3 * i], 10 - 2 * sample_center(i, 1), 1e-5);
        sample_near("y", i, set.centers[3 * i + 1], 20 + 2 * sample_center(i, 0), 1e-5);
        sample_near("z", i, set.centers[3 * i + 2], 30 + 2 * sample_center(i, 2), 1e-5);
        for (uint32_t k = 0; k < 3; k++)
            sample_near("scale", i, set.scales[3 * i + k], 2 * sample_scale(i, k), 1e-5);
        // What was seen along x, is seen along y.
        sample_near("y", i, set.harmonics[3 * (4 * i + 1)], sample_rest(3, 0), 1e-5);
        sample_near("x", i, set.harmonics[3 * (4 * i + 3)], -sample_rest(1, 0), 1e-5);
        sample_near("z", i, set.harmonics[3 * (4 * i + 2)], sample_rest(2, 0), 1e-5);
    }
}

/// A .glb of the given JSON, in which %zu is the number of bytes of the buffer.
static void make_glb(sample_file *file, const char *json, const sample_file *body) {
    char text[4096];
    int length = snprintf(text, sizeof text, json, body->size, body->size);
    while (length % 4) text[length++] = ' ';
    file->size = 0;
    sample_text(file, "glTF");
    sample_u32(file, 2);
    sample_u32(file, (uint32_t)(28 + (size_t)length + body->size));
    sample_u32(file, (uint32_t)length);
    sample_text(file, "JSON");
    sample_put(file, text, (size_t)length);
    sample_u32(file, (uint32_t)body->size);
    sample_put(file, "BIN", 4);
    sample_put(file, body->bytes, body->size);
}

/// SPZ in a buffer view, twice: where it is and moved; beside a primitive of triangles, which is left out.
TEST(packed_in_gltf) {
    static sample_file body, file;
    sample_spz(&body, 3, 1);
    make_glb(
        &file,
        "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_gaussian_splatting\"],"
        "\"extensionsRequired\":[\"KHR_gaussian_splatting\",\"KHR_gaussian_splatting_compression_spz_2\"],"
        "\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"translation\":[0,0,50]}],\"meshes\":[{\"primitives\":[{"
        "\"mode\":0,"
        "\"attributes\":{},\"extensions\":{\"KHR_gaussian_splatting\":{\"extensions\":{"
        "\"KHR_gaussian_splatting_compression_spz_2\":{\"bufferView\":0}}}}},{\"attributes\":{}}]}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu}],\"buffers\":[{\"byteLength\":%zu}]}",
        &body);
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    ewa_gaussians set;
    if (ewa_gaussians_load_memory(context, file.bytes, file.size, "test", NULL, &set, NULL) != EWA_OK)
        fail_msg("%s", log.text);
    assert_int_equal(set.count, 2 * SAMPLE_COUNT);
    assert_true(set.antialiased);
    for (uint32_t i = 0; i < SAMPLE_COUNT; i++) {
        sample_near("z", i, set.centers[3 * i + 2], sample_center(i, 2), 1e-3);
        sample_near("z", i, set.centers[3 * (SAMPLE_COUNT + i) + 2], 50 + sample_center(i, 2), 1e-3);
    }
    set.count = SAMPLE_COUNT; // the first half
    sample_check(&set, 1, &(sample_limits){1e-3, 4e-2, 2e-4, 2e-3, 2e-2, 1e-2});
    set.count = 2 * SAMPLE_COUNT;
    ewa_gaussians_free(&set);
    // As a mesh it has nothing to show, and cannot be read without the extension.
    ewa_model model;
    assert_int_equal(
        ewa_model_load_memory(context, file.bytes, file.size, "test", NULL, EWA_MODEL_MESH, NULL, &model),
        EWA_ERROR_UNSUPPORTED);
}

/// A count that a short file cannot have, of accessors without a buffer: refused wherever it is met.
TEST(counts) {
    static sample_file file;
    static const char accessor[] = "{\"componentType\":5126,\"count\":%s,\"type\":\"%s\"}";
    for (int large = 0; large < 5; large++) {
        char text[2048] = "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"mode\":"
                          "0,\"attributes\":{\"POSITION\":0,\"_SCALE\":1,\"_ROTATION\":2,\"COLOR_0\":3,\"_OPACITY\":4},"
                          "\"extensions\":{\"KHR_gaussian_splatting\":{}}}]}],\"accessors\":[";
        static const char *const types[5] = {"VEC3", "VEC3", "VEC4", "VEC4", "SCALAR"};
        for (int i = 0; i < 5; i++) {
            const size_t length = strlen(text);
            snprintf(text + length, sizeof text - length, accessor, i == large ? "4294967295" : "1", types[i]);
            strcat(text, i < 4 ? "," : "]}");
        }
        file.size = 0;
        sample_text(&file, text);
        refuse(&file, EWA_ERROR_LIMIT, "more vertices and corners than a file of");
    }
}

/// The first draft: colours and opacities of the display in COLOR_0.
TEST(draft) {
    static sample_file body, file;
    body.size = 0;
    const double numbers[14] = {1, 2, 3, 0.1, 0.2, 0.3, 0, 0, 0, 1, 1, 0.5, 0, 0.25};
    for (int k = 0; k < 14; k++) sample_f32(&body, numbers[k]);
    make_glb(&file,
             "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_gaussian_splatting\"],\"nodes\":[{"
             "\"mesh\":0}],"
             "\"meshes\":[{\"primitives\":[{\"mode\":0,\"attributes\":{\"POSITION\":0,\"_SCALE\":1,\"_"
             "ROTATION\":2,"
             "\"COLOR_0\":3},\"extensions\":{\"KHR_gaussian_splatting\":{\"colorSpace\":\"lin_rec709_"
             "display\"}}}]}],"
             "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":1,\"type\":\"VEC3\"},"
             "{\"bufferView\":0,\"byteOffset\":12,\"componentType\":5126,\"count\":1,\"type\":\"VEC3\"},"
             "{\"bufferView\":0,\"byteOffset\":24,\"componentType\":5126,\"count\":1,\"type\":\"VEC4\"},"
             "{\"bufferView\":0,\"byteOffset\":40,\"componentType\":5126,\"count\":1,\"type\":\"VEC4\"}],"
             "\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu}],\"buffers\":[{\"byteLength\":%zu}]}",
             &body);
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    OWNED(ewa_gaussians_free) ewa_gaussians set;
    if (ewa_gaussians_load_memory(context, file.bytes, file.size, "test", NULL, &set, NULL) != EWA_OK)
        fail_msg("%s", log.text);
    assert_non_null(strstr(log.text, "linear light")); // which a set cannot say
    const double wanted[3] = {0.5 / 0.28209479177387814, 0, -0.5 / 0.28209479177387814};
    for (uint32_t k = 0; k < 3; k++) sample_near("colour", k, set.harmonics[k], wanted[k], 1e-6);
    assert_true(set.opacities[0] == 0.25f && set.rotations[0] == 1 && set.scales[2] == 0.3f);
}

/// SPZ that names its axes: whichever these are, a set has right, down, front.
TEST(axes) {
    static sample_file plain, file;
    for (uint32_t number = 4; number <= 9; number++) {
        sample_spz(&plain, 4, 4);
        file.size = 0;
        sample_put(&file, plain.bytes, 32);
        file.bytes[14] |= 2;
        file.bytes[16] = 32 + 12;
        sample_u32(&file, 0xadbe0003u);
        sample_u32(&file, 4);
        sample_u32(&file, number);
        sample_put(&file, plain.bytes + 32, plain.size - 32);
        if (number == 9) {
            refuse(&file, EWA_ERROR_UNSUPPORTED, "axes of number 9");
            continue;
        }
        if (number != 4 && number != 6) continue; // right, up, back; right, down, front
        OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
        OWNED(ewa_gaussians_free) ewa_gaussians set;
        ewa_gaussian_facts facts;
        assert_int_equal(
            ewa_gaussians_load_memory(context, file.bytes, file.size, "test", NULL, &set, &facts), EWA_OK);
        assert_true(facts.up_world[1] == -1);
        if (number == 4) sample_turn_over(&set);
        sample_check(&set, 4, &(sample_limits){1e-3, 4e-2, 2e-4, 2e-3, 2e-2, 1e-2});
    }
}

/// Memory that runs out anywhere leaves nothing behind.
TEST(memory) {
    static sample_file file;
    uint32_t degree;
    sample_limits limits;
    for (int number = 0; sample_make(number, &file, &degree, &limits); number++) {
        bool reached = true; // the allocation that fails
        long calls = 0;
        for (; reached; calls++) {
            check_memory held = {.calls_left = -1};
            ewa_context *context = check_context_on(1, &held);
            held.calls_left = calls;
            ewa_gaussians set;
            const ewa_status status =
                ewa_gaussians_load_memory(context, file.bytes, file.size, "test", NULL, &set, NULL);
            reached = held.calls_left < 0;
            held.calls_left = -1;
            if (status == EWA_OK && file_is_spz(number)) sample_turn_over(&set);
            if (status == EWA_OK) {
                sample_check(&set, degree, &limits);
            } else {
                // Also while it is found out what form the file is of.
                if (status != EWA_ERROR_MEMORY)
                    fail_msg("form %d, allocation %ld: status %d", number, calls, status);
                assert_true(reached && set.centers == NULL);
            }
            ewa_gaussians_free(&set);
            ewa_context_destroy(&context);
            assert_int_equal(held.held_bytes, 0);
        }
        if (calls < 5) fail_msg("form %d: %ld allocations", number, calls);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
