// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A scene cut into cubes, one source each.
#include "splat/cubes.h"

/// The cube of a place in a box.
static uint32_t cube_of(const double place[3], const ewa_bounds *box, uint32_t per_axis) {
    uint32_t cube = 0;
    for (int c = 0; c < 3; c++) {
        const double side = box->high_world[c] - box->low_world[c];
        const double at = side > 0 ? (place[c] - box->low_world[c]) / side * per_axis : 0;
        cube = cube * per_axis + (at < per_axis ? (uint32_t)at : per_axis - 1);
    }
    return cube;
}

cubes cubes_make(const ewa_cloud *cloud, uint32_t per_axis) {
    cubes made = {.count = 0};
    const uint64_t count = ewa_cloud_point_count(cloud);
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    ewa_bounds box = {.low_world = {1e300, 1e300, 1e300}, .high_world = {-1e300, -1e300, -1e300}};
    double(*places)[3] = malloc(count * sizeof *places);
    uint64_t *indices = malloc(count * sizeof *indices);
    assert_true(places && indices);
    for (uint64_t i = 0; i < count; i++) {
        ewa_attribute_read_f64(position, i, 1, places[i]);
        for (int c = 0; c < 3; c++) {
            if (places[i][c] < box.low_world[c]) box.low_world[c] = places[i][c];
            if (places[i][c] > box.high_world[c]) box.high_world[c] = places[i][c];
        }
    }
    for (uint32_t cube = 0; cube < per_axis * per_axis * per_axis; cube++) {
        uint64_t here = 0;
        for (uint64_t i = 0; i < count; i++)
            if (cube_of(places[i], &box, per_axis) == cube) indices[here++] = i;
        if (!here) continue;
        OWNED(ewa_cloud_destroy) ewa_cloud *part = NULL;
        assert_int_equal(ewa_cloud_select(cloud, indices, here, &part), EWA_OK);
        assert_int_equal(ewa_surfels_create(part, NULL, &made.part[made.count++]), EWA_OK);
    }
    free(indices);
    free(places);
    return made;
}

void cubes_free(cubes *made) {
    for (uint32_t i = 0; i < made->count; i++) ewa_surfels_destroy(&made->part[i]);
}

uint32_t cubes_largest_step(const picture *a, const picture *b) {
    uint32_t largest = 0;
    for (size_t i = 0; i < 4 * (size_t)a->width_px * a->height_px; i++) {
        const int step = abs((int)a->frame.rgba8[i] - (int)b->frame.rgba8[i]);
        if ((uint32_t)step > largest) largest = (uint32_t)step;
    }
    return largest;
}
