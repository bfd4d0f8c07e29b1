// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the tables of docs/texture.md.
//
//   measure_texture quality [IMAGE...]  methods against the truth, by bands
//   measure_texture tune [IMAGE...]     hybrid with other kernels, against the truth
//   measure_texture speed [THREADS]     four maps, times and rates
//   measure_texture ratio FILE.csv      hybrid over splat: time and difference, over the minified share
//   measure_texture files FOLDER [IMAGE]       writes texture.png and truth.png; prints a perspective for
//   others measure_texture error PICTURE [IMAGE]      compares a picture with the truth
#include "measure/measure.h"
#include "measure/texture_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const char *const method_names[] = {"hybrid", "splat", "point", "bilinear"};

static ewa_texture_options options_of(ewa_texture_method method) {
    WITH_DEFAULTS(ewa_texture_options, options);
    options.method = method;
    return options;
}

static void print_errors(const char *name, const texture_errors *errors) {
    printf("| %-28s | %6.2f | %6.2f | %6.2f | %6.2f |\n", name, errors->psnr_db[0], errors->psnr_db[1],
           errors->psnr_db[2], errors->all_db);
}

static texture_errors errors_of(ewa_context *context, const texture_scene *scene,
                                const ewa_texture_options *options) {
    ewa_image picture;
    check(texture_scene_draw(context, scene, options, &picture, NULL));
    const texture_errors errors = texture_scene_compare(scene, &picture);
    ewa_image_free(&picture);
    return errors;
}

static void measure_quality(ewa_context *context, const char *path) {
    texture_scene scene;
    check(texture_scene_make(context, path, &scene));
    printf("\n| %-28s |   near | middle | horizon |   all |\n|---|---:|---:|---:|---:|\n",
           path ? path : "checker");
    ewa_image splats;
    ewa_texture_options options = options_of(EWA_TEXTURE_SPLAT);
    check(texture_scene_draw(context, &scene, &options, &splats, NULL));
    for (int method = 0; method < 4; method++) {
        options = options_of((ewa_texture_method)method);
        const texture_errors errors = errors_of(context, &scene, &options);
        print_errors(method_names[method], &errors);
    }
    ewa_image hybrid;
    options = options_of(EWA_TEXTURE_HYBRID);
    check(texture_scene_draw(context, &scene, &options, &hybrid, NULL));
    texture_errors between;
    for (int band = 0; band < TEXTURE_BANDS; band++)
        between.psnr_db[band] = texture_psnr_db(&scene, &hybrid, &splats, band);
    between.all_db = texture_psnr_db(&scene, &hybrid, &splats, -1);
    print_errors("hybrid against splat", &between);
    ewa_image_free(&hybrid);
    ewa_image_free(&splats);
    texture_scene_free(&scene);
}

static void measure_tuning(ewa_context *context, const char *path) {
    texture_scene scene;
    check(texture_scene_make(context, path, &scene));
    printf("\n%s\n", path ? path : "checker");
    static const double kernels[][4] = {// h, F, sigma, spacing
                                        {0.5, 2, 0.5, 0.5},     {0.4, 2.5, 0.5, 0.5},  {0.4, 2.5, 0.45, 0.5},
                                        {0.4, 2.5, 0.4, 0.5},   {0.4, 2.5, 0.35, 0.5}, {0.35, 2.8, 0.4, 0.5},
                                        {0.33, 3, 0.4, 0.5},    {0.3, 3, 0.4, 0.5},    {0.35, 2.8, 0.35, 0.5},
                                        {0.35, 2.8, 0.45, 0.5}, {0.4, 2.5, 0.4, 0.7},  {0.4, 2.5, 0.4, 0.35},
                                        {0.3, 3.3, 0.35, 0.5},  {0.33, 3, 0.45, 0.5},  {0.33, 3, 0.35, 0.5}};
    for (size_t k = 0; k < sizeof kernels / sizeof kernels[0]; k++) {
        ewa_texture_options options = options_of(EWA_TEXTURE_HYBRID);
        options.prefilter_px = kernels[k][0];
        options.cutoff = kernels[k][1];
        options.sigma_texels = kernels[k][2];
        options.point_spacing_px = kernels[k][3];
        char name[64];
        snprintf(name, sizeof name, "h %.2f F %.1f s %.2f d %.2f", kernels[k][0], kernels[k][1],
                 kernels[k][2], kernels[k][3]);
        const texture_errors errors = errors_of(context, &scene, &options);
        print_errors(name, &errors);
    }
    texture_scene_free(&scene);
}

/// Textures of noise over a few scales, RGBA8, opaque.
static uint8_t *make_noise(uint32_t side) {
    uint8_t *pixels = malloc((size_t)side * side * 4);
    if (!pixels) check(EWA_ERROR_MEMORY);
    uint32_t state = 1;
    for (uint32_t i = 0; i < side * side; i++) {
        state = state * 1664525u + 1013904223u;
        const uint32_t x = i % side, y = i / side, check_value = (x / 16 + y / 16) % 2 ? 60 : 180;
        for (int c = 0; c < 3; c++)
            pixels[4 * i + (uint32_t)c] = (uint8_t)(check_value + (state >> (8 + 5 * c)) % 60);
        pixels[4 * i + 3] = 255;
    }
    return pixels;
}

/// A map to measure.
typedef struct speed_case {
    const char *name;
    uint32_t texture_side, width, height;
    bool repeat;
    double corners[4][2];
} speed_case;

static const speed_case speed_cases[] = {
    {"plane, 4 Mpix", 2048, 2048, 2048, false, {{60, 20}, {2030, 110}, {1960, 2040}, {15, 1900}}},
    {"rotated, minified by 3", 2048, 720, 720, false, {{200, 0}, {793, 341}, {452, 934}, {-141, 593}}},
    {"magnified by 4", 512, 2048, 2048, false, {{0, 0}, {2048, 0}, {2048, 2048}, {0, 2048}}},
    {"to the horizon", 1024, 1024, 1024, true, {{502, 522}, {530, 522}, {4000, 1200}, {-3000, 1200}}},
};

static double best_s(ewa_context *context, const speed_case *one, const uint8_t *pixels,
                     ewa_texture_method method, ewa_texture_stats *stats) {
    const ewa_texture_source source = {
        pixels, EWA_PIXEL_SRGB8, 4, one->texture_side, one->texture_side, one->texture_side * 4u};
    uint8_t *out = calloc((size_t)one->width * one->height, 4);
    if (!out) check(EWA_ERROR_MEMORY);
    const ewa_texture_target target = {out, EWA_PIXEL_SRGB8, 4, one->width, one->height, one->width * 4u};
    ewa_mat3 map;
    check(ewa_texture_map_from_corners(context, one->texture_side, one->texture_side, one->corners, &map));
    ewa_texture_options options = options_of(method);
    options.repeat = one->repeat;
    double best = INFINITY;
    const double started_s = now_s();
    for (int i = 0; i < 9 && (i < 2 || now_s() - started_s < 1); i++) {
        ewa_texture_stats run;
        check(ewa_texture_map(context, &source, &map, &options, &target, &run));
        if (run.total_s < best) {
            best = run.total_s;
            *stats = run;
        }
    }
    free(out);
    return best;
}

static void measure_speed(ewa_context *context) {
    printf("| map | method | ms | picture Mpix/s | texels Mpix/s | drawn M/s | levels ms "
           "|\n|---|---|---:|---:|---:|---:|"
           "---:|\n");
    for (size_t k = 0; k < sizeof speed_cases / sizeof speed_cases[0]; k++) {
        const speed_case *one = &speed_cases[k];
        uint8_t *pixels = make_noise(one->texture_side);
        for (int method = 0; method < 4; method++) {
            if (one->repeat && method == EWA_TEXTURE_SPLAT) continue;
            ewa_texture_stats stats = {0};
            const double s = best_s(context, one, pixels, (ewa_texture_method)method, &stats);
            const double picture = (double)one->width * one->height * 1e-6;
            const double drawn = (double)(stats.splat_count + stats.point_count) * 1e-6;
            printf("| %s | %s | %.1f | %.1f | %.1f | %.1f | %.1f |\n", one->name, method_names[method],
                   1e3 * s, picture / s, (double)stats.texel_count * 1e-6 / s, drawn / s,
                   1e3 * stats.levels_s);
        }
        free(pixels);
    }
}

/// Floors seen from ever higher up: the share of the texels that are points goes from 0 to 1.
static void measure_ratio(ewa_context *context, const char *path) {
    FILE *file = fopen(path, "w");
    if (!file) check(EWA_ERROR_IO);
    fprintf(file, "scale,minified_share,hybrid_ms,splat_ms,ratio,psnr_db\n");
    texture_scene scene;
    check(texture_scene_make(context, NULL, &scene));
    const ewa_mat3 floor_map = scene.map;
    for (double scale = 4; scale > 0.08; scale /= 1.3) {
        const ewa_mat3 zoom = {{{scale, 0, 0}, {0, scale, 0}, {256 - 256 * scale, 380 - 380 * scale, 1}}};
        scene.map = ewa_mat3_concatenate(&floor_map, &zoom);
        ewa_texture_stats best[2] = {{.total_s = INFINITY}, {.total_s = INFINITY}};
        ewa_image pictures[2] = {{.pixels = NULL}, {.pixels = NULL}};
        for (int i = 0; i < 8; i++) {
            const ewa_texture_options options = options_of(i % 2 ? EWA_TEXTURE_SPLAT : EWA_TEXTURE_HYBRID);
            ewa_texture_stats stats;
            ewa_image_free(&pictures[i % 2]);
            check(texture_scene_draw(context, &scene, &options, &pictures[i % 2], &stats));
            if (stats.total_s < best[i % 2].total_s) best[i % 2] = stats;
        }
        // Where both apply: pixels inside of the texture.
        double squares = 0, count = 0;
        for (size_t i = 0; i < (size_t)TEXTURE_SIDE * TEXTURE_SIDE * 3; i++) {
            const float a = pictures[0].pixels[i], b = pictures[1].pixels[i];
            if (!(a > 0 && b > 0)) continue;
            const double difference = (double)ewa_srgb_from_linear(a) - (double)ewa_srgb_from_linear(b);
            squares += difference * difference;
            count++;
        }
        const double texels = (double)best[0].texel_count;
        fprintf(file, "%.4g,%.4f,%.3f,%.3f,%.3f,%.2f\n", scale, (double)best[0].point_texel_count / texels,
                1e3 * best[0].total_s, 1e3 * best[1].total_s, best[0].total_s / best[1].total_s,
                -10 * log10(squares / count));
        for (int i = 0; i < 2; i++) ewa_image_free(&pictures[i]);
    }
    texture_scene_free(&scene);
    fclose(file);
}

static void write_files(ewa_context *context, const char *folder, const char *image) {
    texture_scene scene;
    check(texture_scene_make(context, image, &scene));
    char path[1024];
    snprintf(path, sizeof path, "%s/texture.png", folder);
    check(ewa_image_save(&scene.texture, path, NULL));
    snprintf(path, sizeof path, "%s/truth.png", folder);
    check(ewa_image_save(&scene.truth, path, NULL));
    // Control points for others: texels inside the picture's view, and where they go.
    const double width = scene.texture.width_px, height = scene.texture.height_px;
    const double texels[4][2] = {
        {0, 0}, {width, 0}, {0.6 * width, 0.95 * height}, {0.4 * width, 0.95 * height}};
    for (int i = 0; i < 4; i++) {
        const ewa_vec3 p = ewa_point2_transform((ewa_vec3){texels[i][0], texels[i][1], 1}, &scene.map);
        printf("%.9g,%.9g %.9g,%.9g ", texels[i][0], texels[i][1], p.x / p.z, p.y / p.z);
    }
    printf("\n");
    texture_scene_free(&scene);
}

/// Nine numbers for ewa texture --homography.
static void print_homography(ewa_context *context, const char *image) {
    texture_scene scene;
    check(texture_scene_make(context, image, &scene));
    for (int i = 0; i < 9; i++) printf("%s%.17g", i ? "," : "", scene.map.m[i % 3][i / 3]);
    printf("\n");
    texture_scene_free(&scene);
}

static void print_file_error(ewa_context *context, const char *name, const char *image) {
    texture_scene scene;
    check(texture_scene_make(context, image, &scene));
    ewa_image picture;
    check(ewa_image_load(context, name, &picture));
    if (picture.width_px != TEXTURE_SIDE || picture.height_px != TEXTURE_SIDE || picture.channel_count < 3)
        check(EWA_ERROR_FORMAT);
    const texture_errors errors = texture_scene_compare(&scene, &picture);
    print_errors(name, &errors);
    ewa_image_free(&picture);
    texture_scene_free(&scene);
}

int main(int count, char **words) {
    const char *what = count > 1 ? words[1] : "quality";
    uint32_t thread_count = strcmp(what, "ratio") == 0 ? 1 : 0;
    if (strcmp(what, "speed") == 0) thread_count = count > 2 ? (uint32_t)strtoul(words[2], NULL, 10) : 1;
    ewa_context *context = make_context(thread_count);
    if (strcmp(what, "quality") == 0 || strcmp(what, "tune") == 0) {
        void (*measure)(ewa_context *, const char *) = *what == 'q' ? measure_quality : measure_tuning;
        measure(context, NULL);
        for (int i = 2; i < count; i++) measure(context, words[i]);
    } else if (strcmp(what, "speed") == 0) {
        measure_speed(context);
    } else if (strcmp(what, "ratio") == 0 && count == 3) {
        measure_ratio(context, words[2]);
    } else if (strcmp(what, "files") == 0 && count >= 3) {
        write_files(context, words[2], count > 3 ? words[3] : NULL);
    } else if (strcmp(what, "homography") == 0 && count >= 3) {
        print_homography(context, count > 3 ? words[3] : NULL);
    } else if (strcmp(what, "error") == 0 && count >= 3) {
        print_file_error(context, words[2], count > 3 ? words[3] : NULL);
    } else {
        fprintf(stderr, "measure_texture quality|tune|speed|ratio|files|homography|error\n");
        return 2;
    }
    ewa_context_destroy(&context);
    return 0;
}
