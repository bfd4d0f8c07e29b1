// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the Gaussians of a file are, for ewa info.
#include "cli/info/info_gaussians.h"
#include "cli/info/info_facts.h"
#include "cli/input/gaussian_files.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static int compare_floats(const void *a, const void *b) {
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/// Puts numbers in order; their 5 %, median and 95 %.
static void find_percentiles(float *numbers, uint32_t count, double found[3]) {
    static const double shares[3] = {0.05, 0.5, 0.95};
    qsort(numbers, count, sizeof *numbers, compare_floats);
    for (int i = 0; i < 3; i++) found[i] = (double)numbers[(uint32_t)(shares[i] * (count - 1))];
}

static bool measure(cli_session *session, const char *path, const ewa_gaussians *set, gaussians_told *told) {
    float *numbers = malloc(set->count * sizeof *numbers);
    if (!numbers) {
        session_fail(session, "out of memory: %u numbers", set->count);
        return false;
    }
    for (size_t i = 0; i < set->count; i++) {
        const float *scales = set->scales + 3 * i;
        const double product = (double)scales[0] * (double)scales[1] * (set->flat ? 1 : (double)scales[2]);
        numbers[i] = (float)(set->flat ? sqrt(product) : cbrt(product));
    }
    find_percentiles(numbers, set->count, told->scales_world);
    for (size_t i = 0; i < set->count; i++) numbers[i] = set->opacities[i];
    find_percentiles(numbers, set->count, told->opacities);
    free(numbers);
    told->count = set->count;
    told->sh_degree = set->sh_degree;
    told->flat = set->flat;
    told->antialiased = set->antialiased;
    if (ewa_gaussians_measure(set, &told->bounds) != EWA_OK) return false;
    ewa_asset_source source = {.name = path, .gaussians = set};
    for (int c = 0; c < 3; c++) source.up_world[c] = told->file.up_world[c];
    ewa_asset *asset = NULL;
    ewa_status status = ewa_asset_create(session->context, &source, NULL, &asset);
    if (status == EWA_OK) status = ewa_asset_find_upright(asset, &told->upright);
    ewa_asset_release(&asset);
    return session_passed(session, status);
}

bool info_gaussians_gather(cli_session *session, const char *path, gaussians_told *told) {
    ewa_gaussians set;
    *told = (gaussians_told){.count = 0};
    if (!gaussian_files_load(session, path, &set, &told->file)) return false;
    const bool done = measure(session, path, &set, told);
    ewa_gaussians_free(&set);
    return done;
}

static double bytes_each(const gaussians_told *told) {
    return (double)told->file.size_bytes / (double)told->count;
}

void info_gaussians_print(const gaussians_told *told) {
    const ewa_gaussian_columns facts = {told->flat ? 2 : 3, told->sh_degree, told->file.filtered};
    char text[EWA_DIAGNOSIS_TEXT_BYTES];
    ewa_gaussian_columns_describe(&facts, text);
    printf("  holds       %s\n", text);
    printf("  trained     %s\n", told->antialiased ? "with a filter that keeps opacities (antialiased)"
                                                   : "with a filter that thickens (as 3DGS)");
    printf("  sizes       median %.4g (5 %%: %.4g, 95 %%: %.4g), standard deviations\n",
           told->scales_world[1], told->scales_world[0], told->scales_world[2]);
    printf("  opacities   median %.4g (5 %%: %.4g, 95 %%: %.4g)\n", told->opacities[1], told->opacities[0],
           told->opacities[2]);
    printf("  bytes       %llu, %.4g per Gaussian\n", (unsigned long long)told->file.size_bytes,
           bytes_each(told));
}

void info_gaussians_write(json_writer *json, const gaussians_told *told) {
    json_object(json, "gaussians");
    json_text(json, "format", ewa_gaussian_format_name(told->file.format));
    if (told->file.version) json_count(json, "version", told->file.version);
    json_count(json, "count", told->count);
    json_count(json, "dimensions", told->flat ? 2 : 3);
    json_count(json, "sh_degree", told->sh_degree);
    json_flag(json, "filtered", told->file.filtered);
    json_flag(json, "antialiased", told->antialiased);
    json_number(json, "median_size", told->scales_world[1]);
    json_number(json, "median_opacity", told->opacities[1]);
    json_number(json, "bytes_each", bytes_each(told));
    json_close(json, '}');
}

static void print_text(const char *path, const gaussians_told *told) {
    const double *low = told->bounds.low_world, *high = told->bounds.high_world;
    printf("%s\n", path);
    printf("  format      %s", ewa_gaussian_format_name(told->file.format));
    if (told->file.version) printf(", version %u", told->file.version);
    printf("\n  gaussians   %u\n", told->count);
    printf("  low         %.8g %.8g %.8g\n", low[0], low[1], low[2]);
    printf("  high        %.8g %.8g %.8g\n", high[0], high[1], high[2]);
    printf("  extent      %.6g %.6g %.6g\n", high[0] - low[0], high[1] - low[1], high[2] - low[2]);
    info_upright_print(&told->upright);
    info_gaussians_print(told);
}

static void print_json(json_writer *json, const char *path, const gaussians_told *told) {
    json_object(json, NULL);
    json_text(json, "file", path);
    json_text(json, "format", ewa_gaussian_format_name(told->file.format));
    json_count(json, "points", told->count);
    json_vector(json, "low", 3, told->bounds.low_world);
    json_vector(json, "high", 3, told->bounds.high_world);
    info_upright_write(json, &told->upright);
    info_gaussians_write(json, told);
    json_close(json, '}');
}

bool info_gaussians(cli_session *session, const char *path, json_writer *json) {
    gaussians_told told;
    if (!info_gaussians_gather(session, path, &told)) return false;
    if (json)
        print_json(json, path, &told);
    else
        print_text(path, &told);
    return true;
}
