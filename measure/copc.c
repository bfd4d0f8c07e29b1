// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Says how fast COPC files are written and read by nodes: measure_copc FILE POINTS makes a terrain of so many points
// with normals and radii in 16 bits, writes it to FILE and reads it; measure_copc FILE reads any tree (docs/files.md).
#include "base/base.h"
#include "ewa/ewa.h"
#include "io/octree.h"
#include "measure/measure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LEVELS = 5, NODES = 341, ROUNDS = 3 };
static const double side_world = 1000;

static double uniform(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 33) * 0x1p-31;
}

/// The points of one cube: a piece of the terrain.
static ewa_cloud *make_node(ewa_context *context, const ewa_octree_key *key, uint64_t count) {
    ewa_cloud *cloud = NULL;
    double *position;
    uint16_t *intensity, *color, *radius;
    int16_t *normal;
    check(ewa_cloud_create(context, count, &cloud));
    ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, (void **)&position);
    ewa_cloud_add(cloud, "intensity", EWA_U16, 1, (void **)&intensity);
    ewa_cloud_add(cloud, EWA_COLOR, EWA_U16, 3, (void **)&color);
    ewa_cloud_add(cloud, EWA_NORMAL, EWA_I16, 3, (void **)&normal);
    ewa_cloud_add(cloud, EWA_RADIUS, EWA_U16, 1, (void **)&radius);
    check(ewa_cloud_set_note(cloud, "scale.radius", "0.001", 5));
    uint64_t state = (uint64_t)key->level << 40 | (uint64_t)key->cell[0] << 20 | (uint64_t)key->cell[1];
    const double cell_world = side_world / (1 << key->level);
    // Along lines, as scanners and those who sort points have them.
    for (uint64_t i = 0; i < count; i++) {
        const double lines = sqrt((double)count), line = floor((double)i / lines);
        const double x =
            (key->cell[0] + ((double)i - line * lines + uniform(&state)) / (lines + 1)) * cell_world;
        const double y = (key->cell[1] + (line + uniform(&state)) / (lines + 1)) * cell_world;
        const double slope = 0.4 * cos(x / 50) * cos(y / 70), shade = 128 + 60 * sin(x / 20) * sin(y / 30);
        position[3 * i] = x;
        position[3 * i + 1] = y;
        position[3 * i + 2] = 20 * sin(x / 50) * cos(y / 70) + 0.02 * uniform(&state);
        const double length = sqrt(1 + slope * slope);
        normal[3 * i] = (int16_t)(-32767 * slope / length + 400 * (uniform(&state) - 0.5));
        normal[3 * i + 1] = (int16_t)(400 * (uniform(&state) - 0.5));
        normal[3 * i + 2] = (int16_t)(32000 / length);
        for (int c = 0; c < 3; c++)
            color[3 * i + c] = (uint16_t)(257 * (uint32_t)(shade + 20 * uniform(&state)));
        intensity[i] = (uint16_t)(200 + 100 * uniform(&state));
        radius[i] = (uint16_t)(200 + 40 * uniform(&state));
    }
    return cloud;
}

static void write_file(ewa_context *context, const char *path, uint64_t count) {
    ewa_octree_key keys[NODES];
    ewa_cloud *pieces[NODES];
    static ewa_octree_chunk chunks[NODES];
    uint32_t node_count = 0;
    for (int32_t level = 0; level < LEVELS; level++)
        for (int32_t at = 0; at < 1 << (2 * level); at++) {
            const ewa_octree_key key = {level, {at & ((1 << level) - 1), at >> level, 0}};
            keys[node_count] = key;
            pieces[node_count++] = make_node(context, &key, count / NODES);
        }
    ewa_octree_plan plan = {.prototype = pieces[0], .side_world = side_world, .spacing_world = 2};
    plan.low_world[2] = plan.bounds.low_world[2] = -25;
    plan.bounds.finite_count = count;
    for (int c = 0; c < 3; c++) plan.bounds.high_world[c] = c < 2 ? side_world : 25;
    for (int round = 0; round < ROUNDS; round++) {
        ewa_octree_writer *writer = NULL;
        const double begin_s = ewa_now_s();
        check(ewa_octree_writer_open(context, path, &plan, &writer));
        check(ewa_octree_encode(writer, keys, (const ewa_cloud *const *)pieces, NODES, chunks));
        const double encoded_s = ewa_now_s();
        for (uint32_t i = 0; i < NODES; i++) check(ewa_octree_append(writer, &chunks[i]));
        check(ewa_octree_writer_commit(&writer));
        const double end_s = ewa_now_s();
        uint64_t bytes = 0;
        for (uint32_t i = 0; i < NODES; i++) bytes += chunks[i].size_bytes;
        const double points = (double)(count / NODES * NODES);
        printf("encoded %.2f M points/s, with the file %.2f M points/s, %.1f bytes a point\n",
               1e-6 * points / (encoded_s - begin_s), 1e-6 * points / (end_s - begin_s),
               (double)bytes / points);
    }
    for (uint32_t i = 0; i < NODES; i++) {
        ewa_octree_chunk_free(context, &chunks[i]);
        ewa_cloud_destroy(&pieces[i]);
    }
}

static void read_file(ewa_context *context, const char *path) {
    for (int round = 0; round < ROUNDS; round++) {
        ewa_octree *octree = NULL;
        const double begin_s = ewa_now_s();
        check(ewa_octree_open(context, path, &octree));
        const double opened_s = ewa_now_s();
        const ewa_octree_facts *facts = ewa_octree_describe(octree);
        enum { AT_ONCE = 64 };
        for (uint32_t first = 0; first < facts->node_count; first += AT_ONCE) {
            uint32_t indices[AT_ONCE], count = 0;
            ewa_cloud *clouds[AT_ONCE];
            for (; count < AT_ONCE && first + count < facts->node_count; count++)
                indices[count] = first + count;
            check(ewa_octree_read(octree, indices, count, NULL, clouds));
            for (uint32_t i = 0; i < count; i++) ewa_cloud_destroy(&clouds[i]);
        }
        const double end_s = ewa_now_s();
        printf("opened in %.1f ms; %u nodes, %.0f nodes/s, %.2f M points/s\n", 1e3 * (opened_s - begin_s),
               facts->node_count, facts->node_count / (end_s - opened_s),
               1e-6 * (double)facts->point_count / (end_s - opened_s));
        ewa_octree_close(&octree);
    }
}

int main(int argc, char **argv) {
    if (argc < 2) {
        fprintf(stderr, "usage: measure_copc FILE [POINTS]\n");
        return 2;
    }
    for (uint32_t threads = 1; threads <= 2; threads++) {
        ewa_context *context = make_context(threads);
        printf("%u thread%s\n", threads, threads == 1 ? "" : "s");
        if (argc > 2) write_file(context, argv[1], strtoull(argv[2], NULL, 10));
        read_file(context, argv[1]);
        ewa_context_destroy(&context);
    }
    return 0;
}
