// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the tables of docs/quality.md, "Radii of scans": of the files that are named, or of samplings that
// are known. measure_radii [-n NEAR_CAMERAS] [FILE...]
#include "quality/radii_scene.h"

#include <math.h>

static void print_head(void) {
    printf("| cloud | points | inside | of a million inside: empty | alpha < 0.5 | alpha < 0.99 | empty, "
           "with rims "
           "| radius / spacing: median | mean | 99.9 %% | largest | of the diagonal |\n"
           "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
}

static void print_row(ewa_context *context, const char *name, const ewa_cloud *cloud, uint32_t near_count) {
    radii_sizes sizes;
    radii_holes holes;
    radii_measure_sizes(cloud, 300, &sizes);
    radii_measure_holes(context, cloud, RADII_WHOLE | RADII_NEAR, near_count, &holes);
    const double per_million = 1e6 / ((double)holes.inside + 1e-9);
    printf("| %s | %llu | %llu | %.1f | %.1f | %.0f | %.0f | %.2f | %.2f | %.2f | %.2f | %.3f |\n", name,
           (unsigned long long)ewa_cloud_point_count(cloud), (unsigned long long)holes.inside,
           per_million * (double)holes.empty, per_million * (double)holes.translucent,
           per_million * (double)holes.thin, per_million * (double)holes.rim, sizes.median, sizes.mean,
           sizes.permille_999, sizes.largest, sizes.of_diagonal);
    fflush(stdout);
}

static void estimate(ewa_cloud **cloud) {
    WITH_DEFAULTS(ewa_estimate_options, options);
    const bool has_axes = ewa_cloud_find(*cloud, EWA_TANGENT_U) != NULL;
    options.keep_radii = !has_axes; // radii of a file, as another version wrote them, are judged as they are
    assert_int_equal(ewa_cloud_estimate(cloud, &options), EWA_OK);
}

static void print_file(ewa_context *context, const char *path, uint32_t near_count) {
    ewa_cloud *cloud = NULL;
    if (ewa_cloud_load(context, path, &cloud) != EWA_OK) {
        fprintf(stderr, "measure_radii: cannot read %s\n", path);
        exit(1);
    }
    // Its cameras stand about the streams.
    ewa_cloud_set_origin(cloud, (const double[3]){0});
    estimate(&cloud);
    const char *slash = strrchr(path, '/');
    print_row(context, slash ? slash + 1 : path, cloud, near_count);
    ewa_cloud_destroy(&cloud);
}

static void print_known(ewa_context *context, uint32_t near_count) {
    static const struct {
        const char *name;
        radii_kind kind;
        double detail;
        uint32_t count;
    } rows[] = {{"random plane", RADII_PLANE, 0, 10000},
                {"random plane", RADII_PLANE, 0, 100000},
                {"random plane", RADII_PLANE, 0, 1000000},
                {"random plane", RADII_PLANE, 0, 10000000},
                {"random sphere", RADII_SPHERE, 0, 10000},
                {"random sphere", RADII_SPHERE, 0, 100000},
                {"random sphere", RADII_SPHERE, 0, 1000000},
                {"random terrain", RADII_TERRAIN, 0, 100000},
                {"random terrain", RADII_TERRAIN, 0, 1000000},
                {"scan lines 3 : 1", RADII_LINES, 3, 60000},
                {"scan lines 5 : 1", RADII_LINES, 5, 60000},
                {"scan lines 10 : 1", RADII_LINES, 10, 60000},
                {"scan lines 20 : 1", RADII_LINES, 20, 60000},
                {"noise of 0.25 spacings", RADII_NOISY, 0.25, 60000},
                {"noise of 0.5 spacings", RADII_NOISY, 0.5, 60000},
                {"noise of 1 spacing", RADII_NOISY, 1, 60000},
                {"two densities, 1 : 2", RADII_STEP, 2, 60000},
                {"two densities, 1 : 5", RADII_STEP, 5, 60000},
                {"lone points over a plane", RADII_LONE, 0, 60000},
                {"a helix", RADII_CURVE, 0, 110},
                {"fog", RADII_FOG, 0, 60000}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        ewa_cloud *cloud = NULL;
        float *xyz = NULL;
        assert_int_equal(ewa_cloud_create(context, rows[i].count, &cloud), EWA_OK);
        assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, (void **)&xyz), EWA_OK);
        radii_scene_fill(rows[i].kind, rows[i].detail, rows[i].count, xyz);
        estimate(&cloud);
        print_row(context, rows[i].name, cloud, near_count);
        ewa_cloud_destroy(&cloud);
    }
}

int main(int count, char **words) {
    uint32_t near_count = 12;
    int first = 1;
    if (count > 2 && strcmp(words[1], "-n") == 0) {
        near_count = (uint32_t)strtoul(words[2], NULL, 10);
        first = 3;
    }
    ewa_context *context = check_context(0, NULL);
    print_head();
    for (int i = first; i < count; i++) print_file(context, words[i], near_count);
    if (first == count) print_known(context, near_count);
    ewa_context_destroy(&context);
    return 0;
}
