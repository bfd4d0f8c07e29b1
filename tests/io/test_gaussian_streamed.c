// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Streamed SOG: of each leaf of lod-meta.json the finest level, in the leaves' order, and the environment; what is wrong in it is said, and
// every cut of it is refused.
#include "gaussian_sample.h"
#include "scratch.h"

enum { COUNT = 24 };

/// The files that lod-meta.json names.
static void write_files(ewa_context *context) {
    static const char *const names[] = {"fine.sog", "coarse.sog", "sky.sog"};
    char path[512];
    for (uint32_t f = 0; f < 3; f++) {
        OWNED(ewa_gaussians_free) ewa_gaussians set;
        assert_int_equal(ewa_gaussians_create(context, f == 0 ? COUNT : 2, f == 0, &set), EWA_OK);
        for (uint32_t i = 0; i < set.count; i++) {
            for (uint32_t k = 0; k < 3; k++) set.centers[3 * i + k] = (float)(10 * f + i + 0.1 * k), set.scales[3 * i + k] = 0.1f;
            set.rotations[4 * i] = 1;
            set.opacities[i] = 0.5f;
        }
        for (uint32_t k = 0; f == 0 && k < 12 * COUNT; k++) set.harmonics[k] = (float)(k % 12) * 0.1f;
        assert_int_equal(ewa_gaussians_save(&set, scratch_path(names[f], path), NULL), EWA_OK);
    }
}

static const char good[] =
    "{\"version\":1,\"asset\":{\"generator\":\"by hand\"},\"lodLevels\":2,\"environment\":\"sky.sog\",\"filenames\":[\"coarse.sog\",\"fine.sog\"],"
    "\"tree\":{\"bound\":{\"min\":[0,0,0],\"max\":[1,1,1]},\"children\":[{\"lods\":{\"1\":{\"file\":0,\"offset\":0,\"count\":2},"
    "\"0\":{\"file\":1,\"offset\":16,\"count\":8}}},{\"children\":[{\"lods\":{\"1\":{\"file\":0,\"offset\":1,\"count\":1}}},"
    "{\"lods\":{\"0\":{\"file\":1,\"offset\":0,\"count\":4}}}]}]}}";

static ewa_status load(ewa_context *context, const char *text, size_t size_bytes, ewa_gaussians *set, ewa_gaussian_facts *facts) {
    char path[512];
    scratch_write(scratch_path("lod-meta.json", path), (const uint8_t *)text, size_bytes);
    return ewa_gaussians_load(context, path, set, facts);
}

static void check_same(const ewa_gaussians *a, uint32_t i, const ewa_gaussians *b, uint32_t j) {
    assert_memory_equal(a->centers + 3 * i, b->centers + 3 * j, 3 * sizeof(float));
    assert_memory_equal(a->scales + 3 * i, b->scales + 3 * j, 3 * sizeof(float));
    assert_memory_equal(a->rotations + 4 * i, b->rotations + 4 * j, 4 * sizeof(float));
    assert_true(a->opacities[i] == b->opacities[j]);
    const uint32_t own = 3 * (a->sh_degree + 1) * (a->sh_degree + 1), other = 3 * (b->sh_degree + 1) * (b->sh_degree + 1);
    for (uint32_t k = 0; k < own; k++)
        assert_true(a->harmonics[own * i + k] == (k < other ? b->harmonics[other * j + k] : 0));
}

TEST_LOGGED(finest_levels, 2) {
    ewa_gaussians set, files[3];
    ewa_gaussian_facts facts;
    ewa_gaussian_format format;
    static const char *const names[] = {"fine.sog", "coarse.sog", "sky.sog"};
    char path[512];
    write_files(context);
    for (int f = 0; f < 3; f++) assert_int_equal(ewa_gaussians_load(context, scratch_path(names[f], path), &files[f], NULL), EWA_OK);
    assert_int_equal(load(context, good, sizeof good - 1, &set, &facts), EWA_OK);
    assert_int_equal(ewa_gaussians_probe(context, scratch_path("lod-meta.json", path), &format), EWA_OK);
    assert_int_equal(format, EWA_GAUSSIANS_STREAMED_SOG);
    assert_string_equal(ewa_gaussian_format_name(facts.format), "streamed SOG");
    assert_int_equal(facts.version, 1);
    assert_int_equal(set.count, 8 + 1 + 4 + 2);
    assert_int_equal(set.sh_degree, 1);
    for (uint32_t i = 0; i < set.count; i++)
        check_same(&set, i, i < 8 ? &files[0] : i < 9 ? &files[1] : i < 13 ? &files[0] : &files[2],
                   i < 8 ? 16 + i : i < 9 ? 1 : i < 13 ? i - 9 : i - 13);
    ewa_gaussians_free(&set);
    for (int f = 0; f < 3; f++) ewa_gaussians_free(&files[f]);
    assert_int_equal(ewa_gaussians_load_memory(context, good, sizeof good - 1, "lod-meta.json", NULL, &set, NULL), EWA_ERROR_IO);
    assert_non_null(strstr(log->text, "no folder"));
}

TEST(wrong) {
    static const struct {
        const char *from, *to, *said;
        ewa_status status;
    } cases[] = {
        {"\"version\":1", "\"version\":2", "version 2", EWA_ERROR_UNSUPPORTED},
        {"\"version\":1", "\"version\":\"1\"", "version is no number", EWA_ERROR_FORMAT},
        {"[\"coarse.sog\",\"fine.sog\"]", "{}", "filenames is no list", EWA_ERROR_FORMAT},
        {"[\"coarse.sog\",", "[7,", "no name", EWA_ERROR_FORMAT},
        {"\"sky.sog\"", "{}", "environment is no name", EWA_ERROR_FORMAT},
        {"\"sky.sog\"", "\"moon.sog\"", "moon.sog", EWA_ERROR_IO},
        {"\"fine.sog\"", "\"lod-meta.json\"", "is no SOG", EWA_ERROR_FORMAT},
        {"\"fine.sog\"", "\"/etc/fine.sog\"", "absolute", EWA_ERROR_IO},
        {"{\"lods\":{\"1\"", "7,{\"lods\":{\"1\"", "a node that is none", EWA_ERROR_FORMAT},
        {"\"children\":[{\"lods\"", "\"children\":[{\"children\":{},\"lods\"", "a node that is none", EWA_ERROR_FORMAT},
        {"\"1\":{\"file\":0,\"offset\":0", "\"one\":{\"file\":0,\"offset\":0", "is no number", EWA_ERROR_FORMAT},
        {"\"file\":1,\"offset\":16", "\"file\":2,\"offset\":16", "not named", EWA_ERROR_FORMAT},
        {"\"offset\":16", "\"offset\":-1", "not named", EWA_ERROR_FORMAT},
        {"\"offset\":16", "\"offset\":17", "which has 24", EWA_ERROR_FORMAT},
        {"\"offset\":0,\"count\":4", "\"offset\":0,\"count\":17", "which has 24", EWA_ERROR_FORMAT}, // 8 of them twice
        {"\"count\":8", "\"count\":4294967295", "which has 24", EWA_ERROR_FORMAT},
        {"\"count\":8", "\"count\":0.5", "not named", EWA_ERROR_FORMAT},
    };
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    write_files(context);
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; n++) {
        char text[1024];
        OWNED(ewa_gaussians_free) ewa_gaussians set;
        const char *at = strstr(good, cases[n].from);
        assert_non_null(at);
        snprintf(text, sizeof text, "%.*s%s%s", (int)(at - good), good, cases[n].to, at + strlen(cases[n].from));
        log.count = 0;
        const ewa_status status = load(context, text, strlen(text), &set, NULL);
        if (status != cases[n].status || (cases[n].said && !strstr(log.text, cases[n].said)))
            fail_msg("case %zu: %d, %s", n, (int)status, log.text);
    }
}

TEST_LOGGED(cut_short, 1) {
    write_files(context);
    for (size_t size = 0; size < sizeof good - 1; size++) {
        ewa_gaussians set;
        log->count = 0;
        assert_int_not_equal(load(context, good, size, &set, NULL), EWA_OK);
        assert_true(log->count > 0 && !set.centers);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
