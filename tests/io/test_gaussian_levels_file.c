// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// lod-meta.json as it is written: its finest level is the set, every other level a quarter of the one before, of which each stands for
// its neighbours in the same leaf; the same files for every number of threads, and none where one cannot be written.
#include "gaussian_sample.h"
#include "scratch.h"

#include <sys/stat.h>
#include <unistd.h>

enum { COUNT = 20000, LEAVES = 3, LEVELS = 5 };

/// Gaussians of one size and opacity in a cube, so that what stands for some is at the mean of their places.
static void make_set(ewa_context *context, uint32_t count, uint32_t sh_degree, ewa_gaussians *set) {
    check_random random = {7};
    assert_int_equal(ewa_gaussians_create(context, count, sh_degree, set), EWA_OK);
    const size_t numbers = 3 * (size_t)(sh_degree + 1) * (sh_degree + 1);
    set->origin[1] = 100;
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < 3; k++) {
            set->centers[3 * i + k] = (float)check_uniform(&random, -1, 1);
            set->scales[3 * i + k] = 0.01f;
        }
        set->rotations[4 * i] = 1;
        set->opacities[i] = 0.5f;
        for (size_t k = 0; k < numbers; k++) set->harmonics[numbers * i + k] = k < 3 ? set->centers[3 * i + k] : 0.25f;
    }
}

static const char *file_path(const char *folder, uint32_t level, uint32_t number, char path[512]) {
    char name[64];
    snprintf(name, sizeof name, "%s/%u_%u.sog", folder, level, number);
    return scratch_path(name, path);
}
static const char *level_path(const char *folder, uint32_t level, char path[512]) { return file_path(folder, level, 0, path); }

static const char *make_folder(const char *folder, char path[512]) {
    char name[64];
    mkdir(scratch_path(folder, path), 0777);
    snprintf(name, sizeof name, "%s/lod-meta.json", folder);
    return scratch_path(name, path);
}

static void remove_folder(const char *folder) {
    char path[512], name[64];
    for (uint32_t level = 0; level < LEVELS; level++)
        for (uint32_t number = 0; number < 2; number++) remove(file_path(folder, level, number, path));
    snprintf(name, sizeof name, "%s/lod-meta.json", folder);
    remove(scratch_path(name, path));
    rmdir(scratch_path(folder, path));
}

static void check_same_file(const char *one, const char *other) {
    size_t sizes[2];
    uint8_t *bytes[] = {scratch_read(one, &sizes[0]), scratch_read(other, &sizes[1])};
    assert_int_equal(sizes[0], sizes[1]);
    assert_memory_equal(bytes[0], bytes[1], sizes[0]);
    free(bytes[0]), free(bytes[1]);
}

/// Checks that two folders have the same files; returns how many of levels.
static uint32_t check_same_folders(const char *one, const char *other) {
    char paths[2][512];
    uint32_t count = 0;
    check_same_file(make_folder(one, paths[0]), make_folder(other, paths[1]));
    for (uint32_t level = 0; level < LEVELS; level++)
        for (uint32_t number = 0; number < 2; number++) {
            const bool there = access(file_path(one, level, number, paths[0]), F_OK) == 0;
            assert_true(there == (access(file_path(other, level, number, paths[1]), F_OK) == 0));
            if (there) check_same_file(paths[0], paths[1]);
            count += there;
        }
    return count;
}

static double world(const ewa_gaussians *set, size_t i, size_t k) { return set->origin[k] + (double)set->centers[3 * i + k]; }

static int compare_places(const void *a, const void *b) {
    const double *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p[k] != q[k]) return p[k] < q[k] ? -1 : 1;
    return 0;
}

/// Checks that two sets have the same sorted first coordinates, to within a step.
static void check_places(const ewa_gaussians *a, const ewa_gaussians *b, double step) {
    static double places[2][COUNT][3];
    for (size_t i = 0; i < COUNT; i++)
        for (size_t k = 0; k < 3; k++) places[0][i][k] = world(a, i, k), places[1][i][k] = world(b, i, k);
    for (int n = 0; n < 2; n++) qsort(places[n], COUNT, sizeof places[n][0], compare_places);
    for (size_t i = 0; i < COUNT; i++) assert_true(fabs(places[0][i][0] - places[1][i][0]) < step);
}

TEST(levels) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, &(check_log){.count = 0});
    ewa_gaussians set, all, level;
    ewa_gaussian_facts facts;
    char path[512];
    const char *meta = make_folder("levels", path);
    make_set(context, COUNT, 1, &set);
    assert_int_equal(ewa_gaussians_save(&set, meta, NULL), EWA_OK);
    assert_int_equal(ewa_gaussians_load(context, meta, &all, &facts), EWA_OK);
    assert_int_equal(facts.format, EWA_GAUSSIANS_STREAMED_SOG);
    ewa_gaussians by_folder;
    assert_int_equal(ewa_gaussians_load(context, scratch_path("levels", path), &by_folder, &facts), EWA_OK);
    assert_int_equal(by_folder.count, all.count);
    assert_memory_equal(by_folder.centers, all.centers, 3 * sizeof(float) * all.count);
    ewa_gaussians_free(&by_folder);
    assert_int_equal(all.count, COUNT);
    assert_int_equal(all.sh_degree, 1);
    check_places(&set, &all, 1e-3);
    for (uint32_t l = 1; l < LEVELS; l++) {
        assert_int_equal(ewa_gaussians_load(context, level_path("levels", l, path), &level, NULL), EWA_OK);
        size_t at = 0;
        double wide = 0, widest = 0;
        for (uint32_t leaf = 0; leaf < LEAVES; leaf++) {
            const size_t first = (size_t)COUNT / LEAVES * leaf + COUNT % LEAVES * leaf / LEAVES,
                         end = (size_t)COUNT / LEAVES * (leaf + 1) + COUNT % LEAVES * (leaf + 1) / LEAVES;
            for (const size_t last = at + (end - first - 1) / ((size_t)1 << 2 * l) + 1; at < last; at++) {
                assert_true(at < level.count);
                bool within = false; // of what the leaf has
                for (size_t i = first; i < end && !within; i++) {
                    double apart2 = 0;
                    for (size_t k = 0; k < 3; k++) apart2 += (world(&all, i, k) - world(&level, at, k)) * (world(&all, i, k) - world(&level, at, k));
                    within = sqrt(apart2) < 2 * cbrt((double)(1u << 2 * l) / COUNT);
                }
                assert_true(within);
                for (size_t k = 0; k < 3; k++) { // the mean colour
                    assert_true(fabs((double)level.harmonics[12 * at + k] - (world(&level, at, k) - set.origin[k])) < 0.02);
                    wide += (double)level.scales[3 * at + k] / (3 * (double)level.count);
                    widest = fmax(widest, (double)level.scales[3 * at + k]);
                }
            }
        }
        assert_int_equal(at, level.count);
        // Groups are as wide as their share of the cube, not strewn over the leaf: a side of s has deviation s / sqrt(12).
        const double side = 2 * cbrt((double)(1u << 2 * l) / COUNT);
        assert_true(wide > 0.5 * side / sqrt(12.0) && wide < 1.5 * hypot(side / sqrt(12.0), 0.01));
        print_message("level %u: Gaussians are %.2f wide for %.2f, the widest is %.2f\n", l, wide, hypot(side / sqrt(12.0), 0.01), widest);
        assert_true(widest < 5 * hypot(side / sqrt(12.0), 0.01));
        ewa_gaussians_free(&level);
    }
    remove_folder("levels");
    ewa_gaussians_free(&set);
    ewa_gaussians_free(&all);
}

TEST(same_files) {
    static const char *const names[] = {"one", "three"};
    char path[512];
    for (int n = 0; n < 2; n++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(n ? 3 : 1, NULL);
        OWNED(ewa_gaussians_free) ewa_gaussians set;
        make_set(context, COUNT, 0, &set);
        assert_int_equal(ewa_gaussians_save(&set, make_folder(names[n], path), NULL), EWA_OK);
    }
    assert_int_equal(check_same_folders(names[0], names[1]), LEVELS);
    remove_folder("one");
    remove_folder("three");
}

/// Levels of a file of which a part is in memory are those of the set: of several bins, one of which is divided again and again, of what is up
/// along z, of classes, which have no room; and of files that are read whole.
TEST(of_files) {
    enum { MANY = 320000 }; // more than a bin of 16 MiB, and two files of the finest level
    static const char *const names[] = {"whole", "parts"};
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, &log);
    for (int n = 0; n < 3; n++) {
        const uint32_t many = n == 0 ? MANY : COUNT;
        ewa_gaussians set;
        ewa_gaussian_facts facts;
        char path[512], file[512];
        uint64_t count = 0;
        make_set(context, many, n == 1 ? 1 : 0, &set);
        memset(set.origin, 0, sizeof set.origin); // with one, centres are doubles, and the file is read as a whole
        for (uint32_t i = 0; i < many && n == 0; i++) // nearly all within a part in 10,000 of the box, a few far away
            for (size_t k = 0; k < 3; k++) set.centers[3 * (size_t)i + k] *= i % 1000 ? 1e-4f : 1;
        if (n == 1) assert_int_equal(ewa_gaussians_add_classes(&set), EWA_OK);
        WITH_DEFAULTS(ewa_gaussians_save_options, options);
        assert_int_equal(ewa_gaussians_save(&set, scratch_path(n == 2 ? "set.splat" : "set.ply", file), NULL), EWA_OK);
        ewa_gaussians_free(&set);
        log.count = 0;
        assert_int_equal(ewa_gaussians_convert(context, file, make_folder(names[1], path), NULL, &count), EWA_OK);
        assert_int_equal(count, many);
        assert_int_equal(log.count, n == 1);
        assert_int_equal(ewa_gaussians_load(context, file, &set, &facts), EWA_OK);
        assert_int_equal(ewa_gaussians_save(&set, make_folder(names[0], path), &options), EWA_OK);
        ewa_gaussians_free(&set);
        assert_int_equal(check_same_folders(names[0], names[1]), n ? LEVELS : LEVELS + 1);
        remove_folder(names[0]);
        remove_folder(names[1]);
        assert_int_equal(unlink(file), 0);
    }
}

/// Files that are cut, or have a number that is none, are refused as when they are read, and leave nothing.
TEST_LOGGED(broken_files, 1) {
    ewa_gaussians set, read;
    char path[512], file[512];
    size_t size = 0;
    make_set(context, 100, 0, &set);
    memset(set.origin, 0, sizeof set.origin);
    assert_int_equal(ewa_gaussians_save(&set, scratch_path("broken.ply", file), NULL), EWA_OK);
    ewa_gaussians_free(&set);
    uint8_t *bytes = scratch_read(file, &size);
    const char *meta = make_folder("broken", path);
    for (size_t length = 0; length <= size; length += length < size && size - length > 13 ? 13 : 1) {
        uint64_t count = 7;
        if (length == size) memset(bytes + size - 4, 0xff, 4); // of a quaternion
        scratch_write(file, bytes, length);
        const ewa_status status = ewa_gaussians_load(context, file, &read, NULL);
        assert_true(status != EWA_OK);
        assert_int_equal(ewa_gaussians_convert(context, file, meta, NULL, &count), status);
        assert_true(access(meta, F_OK) != 0 && access(level_path("broken", 0, (char[512]){0}), F_OK) != 0);
    }
    free(bytes);
    unlink(file);
    remove_folder("broken");
}

TEST_LOGGED(refused, 1) {
    OWNED(ewa_gaussians_free) ewa_gaussians set;
    char path[512];
    make_set(context, 100, 4, &set);
    make_folder("refused", path);
    mkdir(level_path("refused", 3, path), 0777); // a folder is in the way
    assert_int_equal(ewa_gaussians_save(&set, make_folder("refused", path), NULL), EWA_ERROR_IO);
    assert_true(access(path, F_OK) != 0 && access(level_path("refused", 0, path), F_OK) != 0);
    rmdir(level_path("refused", 3, path));
    log->count = 0;
    assert_int_equal(ewa_gaussians_save(&set, make_folder("refused", path), NULL), EWA_OK);
    assert_int_equal(log->count, 1); // degree 4 has no room, said once
    assert_non_null(strstr(log->text, "degree 4"));
    set.flat = true;
    for (size_t i = 0; i < set.count; i++) set.scales[3 * i + 2] = 0;
    assert_int_equal(ewa_gaussians_save(&set, path, NULL), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(log->text, "have no levels"));
    remove_folder("refused");
}

int main(void) { return RUN_TESTS(NULL, NULL); }
