// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the times of docs/gaussians.md: measure_gaussians FILE [COPIES [WIDTH HEIGHT [THREADS [MERGE_PX [DEGREE [gl]]]]]]. The file is seen
// from +x, with y down; copies stand side by side and in rows, with harmonics of degree 3. "gl": by the graphics processor.
// FILE "ball": 90,000 in a ball, where there is no file.
#include "ewa/ewa.h"
#include "gl/backends.h"
#include "measure/measure.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 21, DEGREE = 3 };

/// As many copies, 0.9 apart along z, four to a row; rows are 2 apart along x.
static ewa_gaussians copy_set(const ewa_gaussians *one, uint32_t copies, uint32_t sh_degree) {
    ewa_gaussians all;
    check(ewa_gaussians_create(one->context, one->count * copies, sh_degree, &all));
    const size_t numbers = 3 * (size_t)(sh_degree + 1) * (sh_degree + 1);
    const size_t own = 3 * (size_t)(one->sh_degree + 1) * (one->sh_degree + 1);
    uint64_t random = 1;
    for (size_t i = 0; i < all.count; i++) {
        const size_t from = i % one->count, copy = i / one->count;
        memcpy(all.centers + 3 * i, one->centers + 3 * from, 3 * sizeof(float));
        all.centers[3 * i] -= 2 * (float)(copy / 4);
        all.centers[3 * i + 1] += 0.15f * (float)(copy / 4);
        all.centers[3 * i + 2] += 0.9f * (float)(copy % 4);
        memcpy(all.scales + 3 * i, one->scales + 3 * from, 3 * sizeof(float));
        memcpy(all.rotations + 4 * i, one->rotations + 4 * from, 4 * sizeof(float));
        all.opacities[i] = one->opacities[from];
        for (size_t k = 0; k < numbers; k++) {
            random = random * 6364136223846793005u + 1442695040888963407u;
            const float noise = (float)((int64_t)(random >> 40) % 1000 - 500) / 5000;
            all.harmonics[numbers * i + k] = k < own ? one->harmonics[own * from + k] : noise;
        }
    }
    return all;
}

static float random_share(uint64_t *random) {
    *random = *random * 6364136223846793005u + 1442695040888963407u;
    return (float)(*random >> 40) / (1 << 24);
}

/// Flat ones of many sizes in a ball of radius 1, about y = -1.
static void make_ball(ewa_context *context, ewa_gaussians *set) {
    enum { COUNT = 90000 };
    uint64_t random = 1;
    check(ewa_gaussians_create(context, COUNT, 0, set));
    for (size_t i = 0; i < COUNT; i++) {
        float *center = set->centers + 3 * i, squares = 2;
        while (squares > 1) {
            squares = 0;
            for (int k = 0; k < 3; k++) center[k] = 2 * random_share(&random) - 1, squares += center[k] * center[k];
        }
        center[1] -= 1;
        for (int k = 0; k < 3; k++) {
            set->scales[3 * i + (size_t)k] = (k < 2 ? 0.02f : 0.002f) * random_share(&random);
            set->harmonics[3 * i + (size_t)k] = 3 * random_share(&random) - 1.5f;
        }
        float *rotation = set->rotations + 4 * i;
        rotation[0] = 0.5f, rotation[1 + i % 3] = 0.8660254f;
        set->opacities[i] = 0.05f + 0.9f * random_share(&random);
    }
}

int main(int argc, char **argv) {
    const uint32_t copies = argc > 2 ? (uint32_t)atoi(argv[2]) : 1;
    ewa_gaussians set;
    if (argc < 2) return fprintf(stderr, "measure_gaussians FILE [COPIES [WIDTH HEIGHT [THREADS [MERGE_PX [DEGREE [gl]]]]]]\n"), 2;
    ewa_context *context = make_context(argc > 5 ? (uint32_t)atoi(argv[5]) : 0);
    if (strcmp(argv[1], "ball") == 0)
        make_ball(context, &set);
    else
        check(ewa_gaussians_load(context, argv[1], &set, NULL));
    if (copies > 1) {
        ewa_gaussians all = copy_set(&set, copies, argc > 7 ? (uint32_t)atoi(argv[7]) : DEGREE);
        ewa_gaussians_free(&set);
        set = all;
    }
    ewa_splats *splats;
    ewa_splats_info info;
    ewa_gaussian_renderer *renderer;
    const double begin_s = now_s();
    check(ewa_splats_create(&set, false, &splats));
    printf("resident in %.2f s\n", now_s() - begin_s);
    check(ewa_gaussian_renderer_create(context, &renderer));
    const bool by_device = argc > 8;
    ewa_renderer *surfaces;
    check(ewa_renderer_create_on(context, by_device ? EWA_BACKEND_GL : EWA_BACKEND_CPU, &surfaces));
    check(ewa_gl_gaussians_attach(context, surfaces, renderer));
    ewa_splats_describe(splats, &info);
    ewa_camera camera;
    ewa_camera_init(&camera);
    camera.width_px = argc > 4 ? (uint32_t)atoi(argv[3]) : 800;
    camera.height_px = argc > 4 ? (uint32_t)atoi(argv[4]) : 800;
    check(ewa_camera_set_fov(&camera, 40));
    check(ewa_camera_frame(&camera, &info.core, (const double[3]){-1, 0.1, 0.3}, (const double[3]){0, -1, 0},
                           0.02));
    uint8_t *rgba8 = malloc((size_t)camera.width_px * camera.height_px * 4);
    if (!rgba8) return 1;
    const ewa_frame frame = {.rgba8 = rgba8};
    printf("%u Gaussians of degree %u, %.1f bytes each, %u x %u, %u threads\n", info.splat_count,
           info.sh_degree, (double)info.resident_bytes / info.splat_count, camera.width_px, camera.height_px,
           ewa_context_worker_count(context));
    for (int n = 0; n < 4; n += by_device ? 2 : 1) { // the device has no rays
        WITH_DEFAULTS(ewa_gaussian_options, options);
        options.merge_px = argc > 6 ? atof(argv[6]) : 0;
        options.projection = (ewa_gaussian_projection)(n / 2);
        options.order = n % 2 ? EWA_ORDER_RAY : EWA_ORDER_CENTER;
        ewa_gaussian_stats stats;
        double times[ROUNDS];
        for (int i = -2; i < ROUNDS; i++) {
            check(ewa_gaussian_render(renderer, splats, &camera, &options, &frame, &stats));
            if (i >= 0) times[i] = stats.total_s;
        }
        qsort(times, ROUNDS, sizeof *times, compare_doubles);
        printf("%s by %s: median %.1f ms, least %.1f ms; %llu visible, %llu in tiles, %llu in blocks, %llu sorted; %s ms: "
               "project %.1f, "
               "bin %.1f, draw %.1f\n",
               n / 2 ? "exact  " : "trained", n % 2 ? "rays   " : "centres", 1e3 * times[ROUNDS / 2], 1e3 * times[0],
               (unsigned long long)stats.visible_count, (unsigned long long)stats.tile_count, (unsigned long long)stats.block_count,
               (unsigned long long)stats.sorted_count, by_device ? "device" : "thread", 1e3 * stats.project_s, 1e3 * stats.bin_s,
               1e3 * stats.draw_s);
    }
    free(rgba8);
    ewa_gaussian_renderer_destroy(&renderer);
    ewa_renderer_destroy(&surfaces);
    ewa_splats_destroy(&splats);
    ewa_gaussians_free(&set);
    ewa_context_destroy(&context);
    return 0;
}
