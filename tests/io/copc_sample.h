// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Points that the tests make for octrees, their nodes, and the comparison of points whatever their order.
#ifndef EWA_TESTS_COPC_SAMPLE_H
#define EWA_TESTS_COPC_SAMPLE_H

#include "check.h"
#include "io/octree.h"

#include <math.h>
#include <string.h>

static const double copc_low_world[3] = {500000, 4200000, 90}, copc_side_world = 64;

/// Points in the cube with what a LAS file and surfels have; normals and radii in 16 bits.
static inline ewa_cloud *copc_cloud(ewa_context *context, uint64_t count, bool wide_colors) {
    double *position, *time;
    uint16_t *intensity, *radius;
    uint8_t *class, *number, *returns;
    int16_t *normal;
    float *deviation;
    void *color;
    ewa_cloud *cloud = check_cloud_of(context, count);
    ewa_cloud_set_origin(cloud, copc_low_world);
    ewa_cloud_set_grid(cloud, &(ewa_coordinate_grid){{0.001, 0.001, 0.01}, {500000, 4200000, 0}});
    ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, (void **)&position);
    ewa_cloud_add(cloud, "intensity", EWA_U16, 1, (void **)&intensity);
    ewa_cloud_add(cloud, "return_number", EWA_U8, 1, (void **)&number);
    ewa_cloud_add(cloud, "number_of_returns", EWA_U8, 1, (void **)&returns);
    ewa_cloud_add(cloud, "classification", EWA_U8, 1, (void **)&class);
    ewa_cloud_add(cloud, "gps_time", EWA_F64, 1, (void **)&time);
    ewa_cloud_add(cloud, EWA_COLOR, wide_colors ? EWA_U16 : EWA_U8, 3, &color);
    ewa_cloud_add(cloud, EWA_NORMAL, EWA_I16, 3, (void **)&normal);
    ewa_cloud_add(cloud, EWA_RADIUS, EWA_U16, 1, (void **)&radius);
    ewa_cloud_add(cloud, "deviation", EWA_F32, 1, (void **)&deviation);
    ewa_cloud_set_note(cloud, "scale.radius", "0.0005", 6);
    check_random random = {count};
    for (uint64_t i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++) {
            const double step = c == 2 ? 0.01 : 0.001;
            position[3 * i + c] = floor(check_uniform(&random, 0, copc_side_world) / step) * step;
            normal[3 * i + c] = (int16_t)check_uniform(&random, -32767, 32768);
            const uint64_t shade = check_random_u64(&random);
            if (wide_colors)
                ((uint16_t *)color)[3 * i + c] = (uint16_t)shade;
            else
                ((uint8_t *)color)[3 * i + c] = (uint8_t)shade;
        }
        intensity[i] = (uint16_t)check_random_u64(&random);
        number[i] = (uint8_t)(1 + i % 7);
        returns[i] = 7;
        class[i] = (uint8_t)(i % 20);
        time[i] = 1000 + 0.25 * (double)i;
        radius[i] = (uint16_t)(1 + check_random_u64(&random) % 1000);
        deviation[i] = (float)check_uniform(&random, -1, 1);
    }
    return cloud;
}

/// The nodes of a tree. Free with copc_nodes_free().
typedef struct copc_nodes {
    ewa_octree_key *keys;
    ewa_cloud **pieces;
    uint32_t count;
} copc_nodes;

/// Shares points out to the nodes of `level_count` levels, in no particular order, by where they are.
static inline copc_nodes copc_share(const ewa_cloud *cloud, int32_t level_count) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    OWNED(check_free) ewa_octree_key *all = calloc(count + 1, sizeof *all);
    OWNED(check_free) uint64_t *indices = malloc((count + 1) * sizeof *indices);
    OWNED(check_free) bool *taken = calloc(count + 1, 1);
    copc_nodes nodes = {calloc(count + 1, sizeof *nodes.keys), calloc(count + 1, sizeof(ewa_cloud *)), 0};
    assert_true(all && indices && taken && nodes.keys && nodes.pieces);
    for (uint64_t i = 0; i < count; i++) {
        double at[4];
        ewa_attribute_read_f64(position, i, 1, at);
        all[i].level = (int32_t)(i * 7 % (uint64_t)level_count);
        for (int c = 0; c < 3; c++)
            all[i].cell[c] = (int32_t)(at[c] / copc_side_world * (double)(1 << all[i].level));
    }
    for (uint64_t i = 0; i < count; i++) {
        if (taken[i]) continue;
        uint64_t kept = 0;
        for (uint64_t k = i; k < count; k++) {
            if (taken[k] || ewa_octree_key_compare(&all[i], &all[k]) != 0) continue;
            taken[k] = true;
            indices[kept++] = k;
        }
        nodes.keys[nodes.count] = all[i];
        assert_int_equal(ewa_cloud_select(cloud, indices, kept, &nodes.pieces[nodes.count++]), EWA_OK);
    }
    return nodes;
}

static inline void copc_nodes_free(copc_nodes *nodes) {
    for (uint32_t i = 0; i < nodes->count; i++) ewa_cloud_destroy(&nodes->pieces[i]);
    free(nodes->keys);
    free(nodes->pieces);
}

static inline ewa_octree_plan copc_plan(const ewa_cloud *prototype) {
    ewa_octree_plan plan = {.prototype = prototype, .side_world = copc_side_world, .spacing_world = 0.5};
    memcpy(plan.low_world, copc_low_world, sizeof plan.low_world);
    plan.bounds.finite_count = 1;
    for (int c = 0; c < 3; c++) {
        plan.bounds.low_world[c] = copc_low_world[c];
        plan.bounds.high_world[c] = copc_low_world[c] + copc_side_world;
    }
    return plan;
}

/// Writes nodes, and levels of `levels_bytes` bytes (0: none), to a file. Returns the first failure.
static inline ewa_status copc_write(ewa_context *context, const char *path, const ewa_octree_plan *plan,
                                    const copc_nodes *nodes, uint64_t levels_bytes) {
    ewa_octree_writer *writer = NULL;
    ewa_status status = ewa_octree_writer_open(context, path, plan, &writer);
    if (status != EWA_OK) {
        assert_null(writer);
        return status;
    }
    ewa_octree_chunk *chunks = calloc(nodes->count + 1, sizeof *chunks);
    assert_non_null(chunks);
    status =
        ewa_octree_encode(writer, nodes->keys, (const ewa_cloud *const *)nodes->pieces, nodes->count, chunks);
    for (uint32_t i = 0; i < nodes->count && status == EWA_OK; i++)
        status = ewa_octree_append(writer, &chunks[i]);
    if (status == EWA_OK && levels_bytes) status = ewa_octree_levels_begin(writer, levels_bytes);
    for (uint64_t i = 0; i < levels_bytes && status == EWA_OK; i++) {
        const uint8_t byte = (uint8_t)(i * 31);
        status = ewa_octree_levels_put(writer, &byte, 1);
    }
    for (uint32_t i = 0; i < nodes->count; i++) ewa_octree_chunk_free(context, &chunks[i]);
    free(chunks);
    if (status == EWA_OK) return ewa_octree_writer_commit(&writer);
    ewa_octree_writer_abort(&writer);
    return status;
}

static size_t copc_row_bytes; ///< of what is sorted

static inline int copc_compare_rows(const void *a, const void *b) { return memcmp(a, b, copc_row_bytes); }

/// All numbers of some clouds' points, point by point, in order; the caller frees.
static inline uint8_t *copc_rows(ewa_cloud *const *clouds, uint32_t cloud_count, uint64_t *count) {
    size_t row_bytes = 0;
    *count = 0;
    for (uint32_t k = 0; k < cloud_count; k++) *count += ewa_cloud_point_count(clouds[k]);
    for (uint32_t a = 0; a < ewa_cloud_attribute_count(clouds[0]); a++) {
        const ewa_attribute *attribute = ewa_cloud_attribute_at(clouds[0], a);
        row_bytes += attribute->component_count * ewa_type_bytes(attribute->type);
    }
    uint8_t *rows = malloc(*count * row_bytes + 1), *row = rows;
    assert_non_null(rows);
    for (uint32_t k = 0; k < cloud_count; k++) {
        assert_int_equal(ewa_cloud_attribute_count(clouds[k]), ewa_cloud_attribute_count(clouds[0]));
        for (uint64_t i = 0; i < ewa_cloud_point_count(clouds[k]); i++) {
            for (uint32_t a = 0; a < ewa_cloud_attribute_count(clouds[k]); a++) {
                const ewa_attribute *attribute = ewa_cloud_attribute_at(clouds[k], a);
                const size_t bytes = attribute->component_count * ewa_type_bytes(attribute->type);
                memcpy(row, (const uint8_t *)attribute->data + i * attribute->stride_bytes, bytes);
                row += bytes;
            }
        }
    }
    copc_row_bytes = row_bytes;
    if (*count) qsort(rows, *count, row_bytes, copc_compare_rows);
    return rows;
}

/// Reads all nodes of a tree; the caller destroys the clouds and frees the array.
static inline ewa_cloud **copc_read_all(ewa_octree *octree, ewa_status *status) {
    const uint32_t count = ewa_octree_describe(octree)->node_count;
    OWNED(check_free) uint32_t *indices = malloc((count + 1) * sizeof *indices);
    ewa_cloud **clouds = calloc(count + 1, sizeof *clouds);
    assert_true(indices && clouds);
    // In an order that is not the file's.
    for (uint32_t i = 0; i < count; i++) indices[i] = count - 1 - i;
    *status = ewa_octree_read(octree, indices, count, NULL, clouds);
    for (uint32_t i = 0; i < count; i++) assert_int_equal(clouds[i] != NULL, *status == EWA_OK);
    return clouds;
}

static inline void copc_free_all(ewa_cloud **clouds, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) ewa_cloud_destroy(&clouds[i]);
    free(clouds);
}

/// Opens an octree and reads all of its nodes; the first failure.
static inline ewa_status copc_open_and_read(ewa_context *of, const char *name) {
    OWNED(ewa_octree_close) ewa_octree *octree = NULL;
    ewa_status status = ewa_octree_open(of, name, &octree);
    if (status == EWA_OK) {
        const uint32_t count = ewa_octree_describe(octree)->node_count;
        ewa_cloud **clouds = copc_read_all(octree, &status);
        copc_free_all(clouds, count);
    } else {
        assert_null(octree);
    }
    return status;
}

/// Holds the points of all nodes to those of a cloud: same attributes, origin and numbers.
static inline void copc_expect(ewa_octree *octree, ewa_cloud *whole) {
    const ewa_octree_facts *facts = ewa_octree_describe(octree);
    ewa_status status;
    ewa_cloud **clouds = copc_read_all(octree, &status);
    assert_int_equal(status, EWA_OK);
    assert_int_equal(ewa_cloud_attribute_count(clouds[0]), ewa_cloud_attribute_count(whole));
    for (uint32_t a = 0; a < ewa_cloud_attribute_count(whole); a++) {
        const ewa_attribute *left = ewa_cloud_attribute_at(whole, a),
                            *right = ewa_cloud_attribute_at(clouds[0], a);
        assert_string_equal(left->name, right->name);
        assert_int_equal(left->type, right->type);
        assert_int_equal(left->component_count, right->component_count);
    }
    double origin_world[3], other_world[3];
    ewa_cloud_origin(whole, origin_world);
    ewa_cloud_origin(clouds[0], other_world);
    assert_memory_equal(origin_world, other_world, sizeof origin_world);
    uint64_t count, whole_count;
    uint8_t *rows = copc_rows(clouds, facts->node_count, &count);
    uint8_t *whole_rows = copc_rows(&whole, 1, &whole_count);
    assert_int_equal(count, whole_count);
    assert_int_equal(count, facts->point_count);
    assert_memory_equal(rows, whole_rows, count * copc_row_bytes);
    free(rows);
    free(whole_rows);
    copc_free_all(clouds, facts->node_count);
}

#endif
