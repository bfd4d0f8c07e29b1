// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Gaussians that are written and read again: what each form keeps, and how exactly; what it cannot keep is said.
#include "gaussian_sample.h"
#include "scratch.h"

#include <float.h>

/// The sample as a set, of any degree.
static void make_set(ewa_context *context, uint32_t sh_degree, ewa_gaussians *set) {
    assert_int_equal(ewa_gaussians_create(context, SAMPLE_COUNT, sh_degree, set), EWA_OK);
    const uint32_t coefficients = (sh_degree + 1) * (sh_degree + 1);
    for (uint32_t i = 0; i < SAMPLE_COUNT; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            set->centers[3 * i + k] = (float)sample_center(i, k);
            set->scales[3 * i + k] = (float)sample_scale(i, k);
            for (uint32_t n = 0; n < coefficients; n++)
                set->harmonics[3 * (i * coefficients + n) + k] =
                    (float)(n ? sample_rest(n, k) : sample_first(i));
        }
        for (uint32_t k = 0; k < 4; k++) set->rotations[4 * i + k] = (float)sample_turn(i, k);
        set->opacities[i] = (float)sample_opacity(i);
    }
}

static void swap_numbers(float *a, float *b, uint32_t count) {
    for (uint32_t k = 0; k < count; k++) {
        const float kept = a[k];
        a[k] = b[k];
        b[k] = kept;
    }
}

/// Orders a set by x: SOG has an order of its own.
static void order(ewa_gaussians *set) {
    const uint32_t numbers = 3 * (set->sh_degree + 1) * (set->sh_degree + 1);
    for (uint32_t i = 1; i < set->count; i++)
        for (uint32_t j = i; j && set->centers[3 * j] < set->centers[3 * j - 3]; j--) {
            swap_numbers(set->centers + 3 * j, set->centers + 3 * j - 3, 3);
            swap_numbers(set->scales + 3 * j, set->scales + 3 * j - 3, 3);
            swap_numbers(set->rotations + 4 * j, set->rotations + 4 * j - 4, 4);
            swap_numbers(set->opacities + j, set->opacities + j - 1, 1);
            swap_numbers(set->harmonics + numbers * j, set->harmonics + numbers * (j - 1), numbers);
        }
}

/// Writes and reads again.
static void pass(ewa_context *context, const ewa_gaussians *set, const char *name, uint32_t sh_degree,
                 uint32_t spz_version, ewa_gaussians *read, ewa_gaussian_facts *facts) {
    char path[512];
    WITH_DEFAULTS(ewa_gaussians_save_options, options);
    if (sh_degree < 4) options.sh_degree = sh_degree;
    if (spz_version) options.spz_version = spz_version;
    assert_int_equal(ewa_gaussians_save(set, scratch_path(name, path), &options), EWA_OK);
    assert_int_equal(ewa_gaussians_load(context, path, read, facts), EWA_OK);
}

TEST(round_trips) {
    static const struct {
        const char *name;
        uint32_t version, degree;
        ewa_gaussian_format format;
        sample_limits limits;
    } cases[] = {{"a.ply", 0, 4, EWA_GAUSSIANS_PLY, {0, 1e-6, 1e-6, 1e-6, 0, 0}},
                 {"a.ply", 0, 1, EWA_GAUSSIANS_PLY, {0, 1e-6, 1e-6, 1e-6, 0, 0}},
                 {"a.compressed.ply", 0, 4, EWA_GAUSSIANS_PACKED_PLY, {2e-2, 2e-3, 1e-5, 2e-3, 3e-2, 2e-2}},
                 {"a.compressed.ply", 0, 1, EWA_GAUSSIANS_PACKED_PLY, {2e-2, 2e-3, 1e-5, 2e-3, 3e-2, 2e-2}},
                 {"a.splat", 0, 0, EWA_GAUSSIANS_SPLAT, {0, 0, 2e-4, 2e-3, 1e-2, 0}},
                 {"a.spz", 2, 3, EWA_GAUSSIANS_SPZ, {4e-6, 4e-2, 2e-4, 2e-3, 2e-2, 1e-2}},
                 {"a.spz", 0, 4, EWA_GAUSSIANS_SPZ, {4e-6, 4e-2, 2e-6, 2e-3, 2e-2, 1e-2}},
                 {"a.spz", 4, 4, EWA_GAUSSIANS_SPZ, {4e-6, 4e-2, 2e-6, 2e-3, 2e-2, 1e-2}},
                 {"a.spz", 4, 0, EWA_GAUSSIANS_SPZ, {4e-6, 4e-2, 2e-6, 2e-3, 2e-2, 1e-2}},
                 {"a.glb", 0, 3, EWA_GAUSSIANS_GLTF, {0, 1e-7, 1e-7, 0, 0, 0}},
                 {"a.glb", 0, 0, EWA_GAUSSIANS_GLTF, {0, 1e-7, 1e-7, 0, 0, 0}},
                 {"a.sog", 0, 3, EWA_GAUSSIANS_SOG, {1e-4, 1e-6, 2e-5, 2e-3, 1e-6, 1e-6}},
                 {"a.sog", 0, 1, EWA_GAUSSIANS_SOG, {1e-4, 1e-6, 2e-5, 2e-3, 1e-6, 1e-6}},
                 {"meta.json", 0, 0, EWA_GAUSSIANS_SOG, {1e-4, 1e-6, 2e-5, 2e-3, 1e-6, 1e-6}}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        for (int antialiased = 0; antialiased < 2; antialiased++) {
            OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
            OWNED(ewa_gaussians_free) ewa_gaussians set, read;
            ewa_gaussian_facts facts;
            make_set(context, 4, &set);
            set.antialiased = antialiased;
            pass(context, &set, cases[i].name, cases[i].degree, cases[i].version, &read, &facts);
            assert_int_equal(facts.format, cases[i].format);
            if (facts.format == EWA_GAUSSIANS_SPZ)
                assert_int_equal(facts.version, cases[i].version ? cases[i].version : 3);
            const bool says = cases[i].format == EWA_GAUSSIANS_PLY || cases[i].format == EWA_GAUSSIANS_SPZ || cases[i].format == EWA_GAUSSIANS_SOG;
            assert_true(read.antialiased == (antialiased && says));
            if (facts.format == EWA_GAUSSIANS_SOG) order(&read);
            if (facts.format == EWA_GAUSSIANS_GLTF) sample_turn_over(&read);
            assert_false(read.flat);
            sample_check(&read, cases[i].degree, &cases[i].limits);
        }
}

/// What is up in a set becomes what is up in files, and -y when these are read; colours go along.
TEST_ON(upright, 1) {
    enum { FORMS = 5 };
    static const double ups[3][3] = {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const double wanted[3][3] = {{1, 2, 3}, {1, -2, -3}, {1, -3, 2}}; // of (1, 2, 3) with -y up
    for (int u = 0; u < 3; u++)
        for (int form = 0; form < FORMS; form++) {
            static const char *const names[FORMS] = {"u.ply", "u.splat", "u.spz", "u.glb", "u.sog"};
            char path[512];
            OWNED(ewa_gaussians_free) ewa_gaussians set, read;
            WITH_DEFAULTS(ewa_gaussians_save_options, options);
            memcpy(options.up_world, ups[u], sizeof ups[u]);
            options.spz_version = 4;
            make_set(context, 1, &set);
            for (int k = 0; k < 3; k++) set.centers[k] = (float)(k + 1);
            assert_int_equal(ewa_gaussians_save(&set, scratch_path(names[form], path), &options), EWA_OK);
            assert_int_equal(ewa_gaussians_load(context, path, &read, NULL), EWA_OK);
            if (form == 3) sample_turn_over(&read); // y is up in glTF
            for (uint32_t i = 0; i < SAMPLE_COUNT && form == 4; i++) // in an order of its own
                if (fabs((double)read.centers[3 * i] - wanted[u][0]) < 1e-3 && fabs((double)read.centers[3 * i + 1] - wanted[u][1]) < 1e-3)
                    memcpy(read.centers, read.centers + 3 * i, 3 * sizeof(float));
            for (uint32_t k = 0; k < 3; k++) {
                sample_near("centre", k, read.centers[k], wanted[u][k], form == 4 ? 1e-4 : 1e-5);
                assert_true(set.centers[k] == (float)(k + 1));
            }
            // The harmonics of degree 1 are -y, z and -x: their coefficients are a vector that turns along.
            const double v[3] = {-sample_rest(3, 0), -sample_rest(1, 0), sample_rest(2, 0)};
            const double turned[3][3] = {{v[0], v[1], v[2]}, {v[0], -v[1], -v[2]}, {v[0], -v[2], v[1]}};
            const uint32_t of[3] = {9, 3, 6}; // x y z
            for (uint32_t k = 0; k < 3 && read.sh_degree; k++)
                sample_near("colour", k, (k < 2 ? -1 : 1) * read.harmonics[of[k]], turned[u][k], 1e-2);
        }
}

/// Random turns come back, whichever component is the largest.
TEST_ON(turns, 1) {
    enum { TURNS = 500 };
    static const struct {
        const char *name;
        uint32_t version;
        double limit; ///< of 1 - the cosine of half the angle between
    } cases[] = {
        {"t.splat", 0, 2e-4}, {"t.sog", 0, 5e-5}, {"t.glb", 0, 1e-6}, {"t.spz", 2, 6e-3}, {"t.spz", 3, 4e-6}, {"t.spz", 4, 4e-6}, {"t.ply", 0, 1e-6}};
    check_random random = {11};
    ewa_gaussians set, read;
    assert_int_equal(ewa_gaussians_create(context, TURNS, 0, &set), EWA_OK);
    for (uint32_t i = 0; i < TURNS; i++) {
        double q[4], norm2 = 0;
        for (int k = 0; k < 4; k++) {
            q[k] = i < 4 ? k == (int)i : check_uniform(&random, -1, 1);
            norm2 += q[k] * q[k];
        }
        for (uint32_t k = 0; k < 4; k++) set.rotations[4 * i + k] = (float)(q[k] / sqrt(norm2));
        for (uint32_t k = 0; k < 3; k++) set.scales[3 * i + k] = 1;
        set.centers[3 * i] = (float)i; // by which it is known again
    }
    for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
        pass(context, &set, cases[c].name, 0, cases[c].version, &read, NULL);
        if (strcmp(cases[c].name, "t.sog") == 0) order(&read);
        if (strcmp(cases[c].name, "t.glb") == 0) sample_turn_over(&read);
        for (uint32_t i = 0; i < TURNS; i++) {
            double cosine = 0;
            for (uint32_t k = 0; k < 4; k++)
                cosine += (double)set.rotations[4 * i + k] * (double)read.rotations[4 * i + k];
            if (fabs(cosine) < 1 - cases[c].limit)
                fail_msg("%s %u: turn %u comes back with %g", cases[c].name, cases[c].version, i,
                         1 - fabs(cosine));
        }
        ewa_gaussians_free(&read);
    }
    ewa_gaussians_free(&set);
}

/// Flat ones, opacities of 0 and 1, scales of 0, places far away.
TEST_LOGGED(corners, 1) {
    ewa_gaussians set, read;
    make_set(context, 0, &set);
    set.flat = true;
    for (int i = 0; i < 3; i++) set.scales[3 * i + 2] = 0;
    set.opacities[0] = 0, set.opacities[1] = 1;
    set.scales[0] = 0;
    set.origin[0] = 4e6, set.origin[1] = 5e5;
    pass(context, &set, "flat.ply", 4, 0, &read, NULL);
    assert_true(read.flat && read.scales[2] == 0 && read.scales[0] < 1e-29f);
    assert_true(read.opacities[0] < 1e-7f && read.opacities[1] == 1);
    for (uint32_t i = 0; i < 9; i++)
        assert_true(set.origin[i % 3] + (double)set.centers[i] ==
                    read.origin[i % 3] + (double)read.centers[i]);
    assert_int_equal(log->count, 0);
    ewa_gaussians_free(&read);
    pass(context, &set, "flat.spz", 4, 0, &read, NULL);
    assert_true(!read.flat && log->count == 2); // that they are flat, and that steps are large
    for (uint32_t i = 0; i < 9; i++)
        assert_true(fabs(set.origin[i % 3] + (double)set.centers[i] - (double)read.centers[i]) <= 0.51);
    ewa_gaussians_free(&read);
    log->count = 0;
    set.origin[0] = 4000;
    pass(context, &set, "flat.sog", 4, 0, &read, NULL);
    order(&read);
    assert_true(read.flat && read.scales[2] == 0 && read.scales[0] < 3e-9f && log->count == 0);
    assert_true(read.opacities[0] == 0 && read.opacities[1] == 1);
    sample_near("colour without opacity", 0, read.harmonics[0], sample_first(0), 1e-6);
    for (uint32_t i = 0; i < 9; i++)
        assert_true(fabs(set.origin[i % 3] + (double)set.centers[i] - (double)read.centers[i]) <= (i % 3 ? 1 : 0.01));
    ewa_gaussians_free(&read);
    pass(context, &set, "flat.glb", 4, 0, &read, NULL);
    assert_true(!read.flat && read.scales[2] == 0 && log->count == 1);
    ewa_gaussians_free(&read);
    char path[512];
    set.origin[0] = 1e7;
    assert_int_equal(ewa_gaussians_save(&set, scratch_path("far.spz", path), NULL), EWA_ERROR_LIMIT);
    assert_non_null(strstr(log->text, "24 bits"));
    ewa_gaussians_free(&set);
}

/// What is lost is said, with numbers.
TEST_LOGGED(losses, 1) {
    ewa_gaussians set, read;
    make_set(context, 2, &set);
    pass(context, &set, "loss.splat", 4, 0, &read, NULL);
    assert_int_equal(log->count, 1);
    assert_non_null(strstr(log->text, "degree 1 to 2"));
    ewa_gaussians_free(&read);
    set.harmonics[0] = 9;
    pass(context, &set, "loss.splat", 4, 0, &read, NULL);
    assert_non_null(strstr(log->text, "colours of 1 Gaussians"));
    ewa_gaussians_free(&read);
    ewa_gaussians_free(&set);
    static const char *const names[] = {"loss.sog", "loss.glb"};
    make_set(context, 4, &set);
    for (int n = 0; n < 2; n++) {
        log->count = 0;
        pass(context, &set, names[n], 4, 0, &read, NULL);
        assert_int_equal(read.sh_degree, 3);
        assert_int_equal(log->count, 1);
        assert_non_null(strstr(log->text, "degree 4"));
        ewa_gaussians_free(&read);
    }
    ewa_gaussians_free(&set);
}

/// PLY keeps classes, with another up too; of parts each Gaussian keeps its own; other forms say that they have no room.
TEST_LOGGED(classes, 1) {
    ewa_gaussians set, read, kept;
    make_set(context, 0, &set);
    assert_int_equal(ewa_gaussians_add_classes(&set), EWA_OK);
    assert_int_equal(set.classes[0], 0);
    for (int i = 0; i < SAMPLE_COUNT; i++) set.classes[i] = (uint16_t)(300 * i + 2);
    assert_int_equal(ewa_gaussians_add_classes(&set), EWA_OK); // as they are
    assert_int_equal(set.classes[1], 302);
    char path[512];
    WITH_DEFAULTS(ewa_gaussians_save_options, options);
    for (int n = 0; n < 2; n++) {
        options.up_world[2] = n;
        assert_int_equal(ewa_gaussians_save(&set, scratch_path("classes.ply", path), &options), EWA_OK);
        assert_int_equal(ewa_gaussians_load(context, path, &read, NULL), EWA_OK);
        assert_memory_equal(read.classes, set.classes, SAMPLE_COUNT * sizeof *set.classes);
        assert_int_equal(ewa_gaussians_keep(&read, (const uint8_t[]){0, 1, 1}, &kept), EWA_OK);
        assert_true(kept.count == 2 && kept.classes[0] == 302 && kept.classes[1] == 602);
        ewa_gaussians_free(&kept);
        ewa_gaussians_free(&read);
    }
    assert_int_equal(log->count, 0);
    pass(context, &set, "classes.spz", 4, 0, &read, NULL);
    assert_null(read.classes);
    assert_int_equal(log->count, 1);
    assert_non_null(strstr(log->text, "SPZ has no room for classes"));
    ewa_gaussians_free(&read);
    ewa_gaussians_free(&set);
}

TEST_LOGGED(refused, 1) {
    ewa_gaussians set, none = {.context = context};
    char path[512];
    make_set(context, 0, &set);
    assert_int_equal(ewa_gaussians_save(&set, scratch_path("a.las", path), NULL), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(log->text, ".ply, .compressed.ply, .splat, .spz, .glb, .sog, meta.json and lod-meta.json"));
    assert_int_equal(ewa_gaussians_save(&none, scratch_path("a.ply", path), NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_gaussians_save(NULL, path, NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_gaussians_save(&set, "/nowhere/at/all.spz", NULL), EWA_ERROR_IO);
    WITH_DEFAULTS(ewa_gaussians_save_options, options);
    options.spz_version = 5;
    assert_int_equal(ewa_gaussians_save(&set, path, &options), EWA_ERROR_ARGUMENT);
    float *const numbers[] = {&set.centers[4], &set.scales[4], &set.opacities[1], &set.harmonics[4],
                              &set.rotations[4]};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        const float old = *numbers[i];
        *numbers[i] = NAN;
        assert_int_equal(ewa_gaussians_save(&set, path, NULL), EWA_ERROR_ARGUMENT);
        assert_non_null(strstr(log->text, "Gaussian 1 of 3"));
        *numbers[i] = old;
    }
    set.scales[4] = -1;
    assert_int_equal(ewa_gaussians_save(&set, path, NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_gaussians_format_of("x.SPZ"), EWA_GAUSSIANS_SPZ);
    assert_int_equal(ewa_gaussians_format_of("x.Compressed.ply"), EWA_GAUSSIANS_PACKED_PLY);
    assert_int_equal(ewa_gaussians_format_of("compressed.ply"), EWA_GAUSSIANS_PLY);
    assert_int_equal(ewa_gaussians_format_of("x.spz/y"), EWA_GAUSSIANS_NONE);
    assert_int_equal(ewa_gaussians_format_of("x.SOG"), EWA_GAUSSIANS_SOG);
    assert_int_equal(ewa_gaussians_format_of("x/meta.json"), EWA_GAUSSIANS_SOG);
    assert_int_equal(ewa_gaussians_format_of("x/lod-meta.json"), EWA_GAUSSIANS_STREAMED_SOG);
    assert_int_equal(ewa_gaussians_format_of("x.glb"), EWA_GAUSSIANS_GLTF);
    assert_int_equal(ewa_gaussians_format_of("-"), EWA_GAUSSIANS_PLY);
    ewa_gaussians_free(&set);
}

/// Compressed PLY of several chunks, the last one not full: in another order, each within a step of the chunks that
/// neighbours share; one far away costs its own chunk alone.
TEST_ON(chunks, 2) {
    enum { COUNT = 5000 };
    check_random random = {5};
    OWNED(ewa_gaussians_free) ewa_gaussians set, read;
    assert_int_equal(ewa_gaussians_create(context, COUNT, 1, &set), EWA_OK);
    for (size_t i = 0; i < COUNT; i++) {
        for (size_t k = 0; k < 3; k++) {
            set.centers[3 * i + k] = (float)(check_uniform(&random, -1, 1) + (i == 7 ? 1000 : 0));
            set.scales[3 * i + k] = (float)exp(check_uniform(&random, -8, -2));
            for (size_t n = 0; n < 4; n++) set.harmonics[12 * i + 3 * n + k] = (float)check_uniform(&random, -1, 1);
        }
        set.rotations[4 * i] = 1;
        set.opacities[i] = (float)((double)i / COUNT); // by which it is known again, within 1/510
    }
    pass(context, &set, "chunks.compressed.ply", 4, 0, &read, NULL);
    assert_int_equal(read.count, COUNT);
    double worst[3] = {0, 0, 0};
    uint32_t coarse = 0;
    for (size_t i = 0; i < COUNT; i++) {
        double nearest = INFINITY;
        size_t found = 0;
        const size_t middle = (size_t)(read.opacities[i] * COUNT);
        for (size_t k = middle > 20 ? middle - 20 : 0; k < middle + 20 && k < COUNT; k++) {
            double away = 0;
            for (size_t a = 0; a < 3; a++) away = fmax(away, fabs((double)(set.centers[3 * k + a] - read.centers[3 * i + a])));
            if (away < nearest) nearest = away, found = k;
        }
        if (nearest > 3e-3) {
            coarse++;
            continue;
        }
        worst[0] = fmax(worst[0], nearest);
        for (size_t a = 0; a < 3; a++) {
            const double ratio = (double)(read.scales[3 * i + a] / set.scales[3 * found + a]);
            worst[1] = fmax(worst[1], fabs(log(ratio)));
            for (size_t n = 1; n < 4; n++)
                worst[2] = fmax(worst[2], fabs((double)(read.harmonics[12 * i + 3 * n + a] - set.harmonics[12 * found + 3 * n + a])));
        }
    }
    print_message("chunks: centres within %g, scales %g, harmonics %g, but for %u\n", worst[0], worst[1], worst[2], coarse);
    assert_true(coarse <= 256 && worst[0] < 2e-3 && worst[1] < 4e-3 && worst[2] < 1.6e-2 + 1e-6);
}

/// SOG of many that share palettes and codes: each within the steps of these, those far from all others too.
TEST_ON(codes, 2) {
    enum { COUNT = 5000, SH = 16 };
    check_random random = {5};
    OWNED(ewa_gaussians_free) ewa_gaussians set, read;
    assert_int_equal(ewa_gaussians_create(context, COUNT, 3, &set), EWA_OK);
    for (size_t i = 0; i < COUNT; i++) {
        const double kind = (double)(i % 300) - 150; // of which each has palettes of its own
        for (size_t k = 0; k < 3; k++) {
            set.centers[3 * i + k] = (float)(k ? check_uniform(&random, -1, 1) : (double)i / COUNT);
            set.scales[3 * i + k] = (float)exp(i == 7 ? 6 : check_uniform(&random, -8, -2));
            set.harmonics[3 * SH * i + k] = (float)(i == 8 ? 40 : check_uniform(&random, -2, 2));
            for (size_t n = 1; n < SH; n++)
                set.harmonics[3 * (SH * i + n) + k] = (float)(sin(kind * (double)(3 * n + k)) * 0.2 + check_uniform(&random, -1e-3, 1e-3));
        }
        set.rotations[4 * i] = 1;
    }
    pass(context, &set, "codes.sog", 4, 0, &read, NULL);
    order(&read);
    double worst[3] = {0, 0, 0};
    for (size_t i = 0; i < COUNT; i++)
        for (size_t k = 0; k < 3; k++) {
            const size_t first = 3 * SH * i + k;
            if (i != 7) worst[0] = fmax(worst[0], fabs(log((double)(read.scales[3 * i + k] / set.scales[3 * i + k]))));
            if (i != 8) worst[1] = fmax(worst[1], fabs((double)(read.harmonics[first] - set.harmonics[first])));
            for (size_t n = 1; n < SH; n++)
                worst[2] = fmax(worst[2], fabs((double)(read.harmonics[first + 3 * n] - set.harmonics[first + 3 * n])));
        }
    print_message("codes: scales within %g, colours %g, harmonics %g\n", worst[0], worst[1], worst[2]);
    assert_true(worst[0] < 0.02 && worst[1] < 0.02 && worst[2] < 6e-3);
    assert_true(fabs(log((double)read.scales[21]) - 6) < 0.05 && fabs((double)read.harmonics[3 * SH * 8] - 40) < 0.2);
}

/// Files beside meta.json get their names together: none where one cannot.
TEST(beside) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &(check_log){.count = 0});
    OWNED(ewa_gaussians_free) ewa_gaussians set;
    char path[512];
    make_set(context, 0, &set);
    scratch_path("beside", path);
    mkdir(path, 0777);
    scratch_path("beside/quats.webp", path); // a folder is in the way
    mkdir(path, 0777);
    assert_int_equal(ewa_gaussians_save(&set, scratch_path("beside/meta.json", path), NULL), EWA_ERROR_IO);
    assert_true(access(path, F_OK) != 0);
    assert_true(access(scratch_path("beside/means_l.webp", path), F_OK) != 0);
    rmdir(scratch_path("beside/quats.webp", path));
    assert_int_equal(ewa_gaussians_save(&set, scratch_path("beside/meta.json", path), NULL), EWA_OK);
    for (int picture = 0; picture < 5; picture++) {
        char name[64];
        snprintf(name, sizeof name, "beside/%s", sample_picture_names[picture]);
        assert_int_equal(remove(scratch_path(name, path)), 0);
    }
    remove(scratch_path("beside/meta.json", path));
}

/// The same bytes for any number of threads.
TEST(same_bytes) {
    static const char *const names[] = {"s.ply", "s.splat", "s.spz", "s.compressed.ply", "s.glb", "s.sog"};
    for (int n = 0; n < 6; n++) {
        OWNED(check_free) uint8_t *first = NULL;
        size_t first_size = 0;
        for (uint32_t threads = 1; threads < 4; threads++) {
            OWNED(ewa_context_destroy) ewa_context *context = check_context(threads, NULL);
            OWNED(ewa_gaussians_free) ewa_gaussians set;
            char path[512];
            make_set(context, 3, &set);
            assert_int_equal(ewa_gaussians_save(&set, scratch_path(names[n], path), NULL), EWA_OK);
            size_t size;
            uint8_t *bytes = scratch_read(path, &size);
            if (first) {
                assert_int_equal(size, first_size);
                assert_memory_equal(bytes, first, size);
                free(bytes);
            } else {
                first = bytes, first_size = size;
            }
        }
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
