// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a pixel gets does not depend on the order of the surfels, on how they are spread over sources, or on
// how the picture is cut into tiles: the same bytes, over random scenes of all kinds of cameras, kernels,
// lights, layers and clip lines.
#include "base/base.h"
#include "surface/packets.h"
#include "surface/render.h"
#include "tests/check.h"
#include "tests/independent/random_scene.h"

#include <stdlib.h>
#include <string.h>

enum { PLANES = 5 };

/// Memory of a frame, plane by plane.
typedef struct planes {
    ewa_frame frame;
    void *data[PLANES];
    size_t bytes[PLANES];
} planes;

static void planes_make(planes *made, const ewa_camera *camera) {
    static const size_t sizes[PLANES] = {4, 4 * sizeof(float), sizeof(float), 3 * sizeof(float),
                                         sizeof(float)};
    for (int i = 0; i < PLANES; i++) {
        made->bytes[i] = sizes[i] * camera->width_px * camera->height_px;
        made->data[i] = calloc(1, made->bytes[i]);
        assert_non_null(made->data[i]);
    }
    made->frame = (ewa_frame){.rgba8 = made->data[0],
                              .rgba = made->data[1],
                              .depth = made->data[2],
                              .normal = made->data[3],
                              .coverage = made->data[4]};
}

static void planes_free(planes *made) {
    for (int i = 0; i < PLANES; i++) free(made->data[i]);
}

static void hold_same(const planes *a, const planes *b, const char *what, uint64_t seed, const char *words) {
    static const char *const names[PLANES] = {"rgba8", "rgba", "depth", "normal", "coverage"};
    for (int i = 0; i < PLANES; i++)
        if (memcmp(a->data[i], b->data[i], a->bytes[i]) != 0)
            fail_msg("scene %llu, %s: other bytes of %s: %s", (unsigned long long)seed, what, names[i],
                     words);
}

/// Moves entry order[i] of an array of packets to entry i.
static void permute(void *array, size_t size_bytes, const uint32_t *order, uint32_t count) {
    if (!array) return;
    OWNED(check_free) char *copy = malloc(size_bytes * count);
    assert_non_null(copy);
    memcpy(copy, array, size_bytes * count);
    for (uint32_t i = 0; i < count; i++)
        memcpy((char *)array + size_bytes * i, copy + size_bytes * order[i], size_bytes);
}

static void shuffle_packets(ewa_surfels *s, check_random *random) {
    OWNED(check_free) uint32_t *order = malloc(s->packet_count * sizeof *order);
    assert_non_null(order);
    for (uint32_t i = 0; i < s->packet_count; i++) {
        const uint32_t j = (uint32_t)(check_random_u64(random) % (i + 1));
        order[i] = order[j];
        order[j] = i;
    }
    const struct {
        void *array;
        size_t size_bytes;
    } arrays[] = {{s->packets, sizeof *s->packets},
                  {s->materials, EWA_PACKET_LANES * sizeof *s->materials},
                  {s->opacities, EWA_PACKET_LANES * sizeof *s->opacities},
                  {s->clip_masks, sizeof *s->clip_masks},
                  {s->clip_first, sizeof *s->clip_first},
                  {s->bounds.center_x, sizeof *s->bounds.center_x},
                  {s->bounds.center_y, sizeof *s->bounds.center_y},
                  {s->bounds.center_z, sizeof *s->bounds.center_z},
                  {s->bounds.radius, sizeof *s->bounds.radius},
                  {s->bounds.colors, sizeof *s->bounds.colors},
                  {s->bounds.cone, sizeof *s->bounds.cone}};
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; i++)
        permute(arrays[i].array, arrays[i].size_bytes, order, s->packet_count);
}

enum { MAX_PARTS = 7, VECTOR = 16 };

/// Packets [first, first + count) of surfels as a set of their own; `first` is a multiple of VECTOR.
static ewa_surfels part_of(const ewa_surfels *s, uint32_t first, uint32_t count) {
    ewa_surfels part = *s;
    part.packet_count = count;
    part.count = count * EWA_PACKET_LANES;
    part.packets += first;
    if (part.materials) part.materials += (size_t)first * EWA_PACKET_LANES;
    if (part.opacities) part.opacities += (size_t)first * EWA_PACKET_LANES;
    if (part.clip_masks) part.clip_masks += first;
    if (part.clip_first) part.clip_first += first;
    part.bounds.center_x += first, part.bounds.center_y += first, part.bounds.center_z += first;
    part.bounds.radius += first, part.bounds.colors += first, part.bounds.cone += first;
    part.bounds_stride = (count + VECTOR - 1) / VECTOR * VECTOR;
    return part;
}

/// Draws the surfels in `parts` parts, added in random order.
static void draw_parts(ewa_renderer *renderer, const ewa_surfels *s, uint32_t parts, const random_scene *made,
                       const ewa_frame *frame, check_random *random) {
    ewa_surfels part[MAX_PARTS];
    const uint32_t vectors = (s->packet_count + VECTOR - 1) / VECTOR;
    for (uint32_t i = 0; i < parts; i++) {
        const uint32_t first = vectors * i / parts * VECTOR, end = vectors * (i + 1) / parts * VECTOR;
        part[i] = part_of(s, first, (end < s->packet_count ? end : s->packet_count) - first);
    }
    for (uint32_t i = parts; i-- > 1;) {
        const uint32_t j = (uint32_t)(check_random_u64(random) % (i + 1));
        const ewa_surfels other = part[i];
        part[i] = part[j], part[j] = other;
    }
    assert_int_equal(ewa_render_begin(renderer, &made->scene.camera, &made->scene.options, frame), EWA_OK);
    for (uint32_t i = 0; i < parts; i++) assert_int_equal(ewa_render_add(renderer, &part[i]), EWA_OK);
    assert_int_equal(ewa_render_finish(renderer, NULL), EWA_OK);
}

/// The same by other instruction sets and numbers of threads.
static void hold_machines(const ewa_surfels *surfels, const random_scene *made, uint64_t seed,
                          const planes *first, const planes *other, check_random *random) {
    static const struct {
        uint32_t cpu_mask, threads, parts;
    } machines[] = {{0, 1, 1}, {EWA_CPU_AVX2, 3, 2}, {EWA_CPU_ALL, 5, 3}};
    for (size_t i = 0; i < sizeof machines / sizeof machines[0]; i++) {
        WITH_DEFAULTS(ewa_context_options, options);
        options.cpu_mask = machines[i].cpu_mask;
        options.thread_count = machines[i].threads;
        OWNED(ewa_context_destroy) ewa_context *context = NULL;
        assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
        OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
        draw_parts(renderer, surfels, machines[i].parts, made, &other->frame, random);
        hold_same(first, other, "another machine", seed, made->words);
    }
}

static void hold_scene(ewa_context *context, uint64_t seed, random_scene *made) {
    static const uint32_t tiles_px[] = {128, 64, 32, 16};
    check_random random = {seed + 1};
    OWNED(planes_free) planes first, other;
    planes_make(&first, &made->scene.camera);
    planes_make(&other, &made->scene.camera);
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(made->cloud, &made->surfels_options);
    ewa_renderer *renderer = check_renderer(context);
    const ewa_camera *camera = &made->scene.camera;
    const ewa_render_options *options = &made->scene.options;
    assert_int_equal(ewa_render(renderer, surfels, camera, options, &first.frame, NULL), EWA_OK);
    for (size_t i = 0; i < sizeof tiles_px / sizeof tiles_px[0]; i++) {
        char what[64];
        ewa_renderer_set_tile(renderer, tiles_px[i]);
        if (i == 2) shuffle_packets(surfels, &random);
        assert_int_equal(ewa_render(renderer, surfels, camera, options, &other.frame, NULL), EWA_OK);
        snprintf(what, sizeof what, "tiles of %u pixels%s", tiles_px[i], i >= 2 ? ", shuffled packets" : "");
        hold_same(&first, &other, what, seed, made->words);
    }
    for (uint32_t parts = 1; parts <= MAX_PARTS; parts++) {
        char what[64];
        ewa_renderer_set_tile(renderer, tiles_px[parts % 4]);
        draw_parts(renderer, surfels, parts, made, &other.frame, &random);
        snprintf(what, sizeof what, "%u sources", parts);
        hold_same(&first, &other, what, seed, made->words);
    }
    ewa_renderer_destroy(&renderer);
    hold_machines(surfels, made, seed, &first, &other, &random);
}

TEST_ON(test_random, 0) {
    for (uint64_t seed = 0; seed < EWA_RANDOM_SCENES; seed++) {
        OWNED(random_scene_free) random_scene made;
        random_scene_make(context, seed, &made);
        hold_scene(context, seed, &made);
    }
}

TEST_ON(test_named, 0) {
    random_scene made;
    for (uint32_t i = 0; named_scene_make(context, i, &made); i++) {
        hold_scene(context, i, &made);
        random_scene_free(&made);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
