// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Points by their numbers: filters and boxes clear the marks of points that they do not want.
#include "base/base.h"
#include "cloud/cloud.h"
#include "cloud/marks.h"

#include <math.h>
#include <string.h>

/// A term and the numbers that it looks at, its ranges closed and in the numbers of the attribute.
typedef struct bound_term {
    ewa_scalar scalar;
    bool outside;
    uint32_t range_count;
    double low[EWA_FILTER_RANGES], high[EWA_FILTER_RANGES];
} bound_term;

static void bind_ranges(const ewa_filter_term *term, bound_term *bound) {
    const bool rounded = bound->scalar.attribute.type == EWA_F32 && bound->scalar.shift_world == 0;
    bound->outside = term->outside;
    bound->range_count = term->range_count;
    for (uint32_t r = 0; r < term->range_count; r++) {
        const ewa_filter_range *range = &term->ranges[r];
        const double low = rounded ? (double)(float)range->low : range->low;
        const double high = rounded ? (double)(float)range->high : range->high;
        // The next double is beyond an open end, and no number lies between.
        bound->low[r] = range->low_open ? nextafter(low, INFINITY) : low;
        bound->high[r] = range->high_open ? nextafter(high, -INFINITY) : high;
    }
}

static void mark_block(const void *data, uint64_t first, uint32_t count, uint8_t *marks) {
    const bound_term *term = data;
    double numbers[EWA_MARK_BLOCK];
    uint8_t hits[EWA_MARK_BLOCK] = {0};
    ewa_scalar_read(&term->scalar, first, count, numbers);
    for (uint32_t r = 0; r < term->range_count; r++) {
        const double low = term->low[r], high = term->high[r];
        for (uint32_t i = 0; i < count; i++) hits[i] |= (uint8_t)((numbers[i] >= low) & (numbers[i] <= high));
    }
    if (term->outside)
        for (uint32_t i = 0; i < count; i++) hits[i] = (uint8_t)(!hits[i] & (numbers[i] == numbers[i]));
    for (uint32_t i = 0; i < count; i++) marks[i] = (uint8_t)(hits[i] & (marks[i] != 0));
}

ewa_status ewa_filter_mark(const ewa_filter *filter, const ewa_cloud *cloud, uint8_t *marks) {
    if (!filter || !cloud || !marks) return EWA_ERROR_ARGUMENT;
    for (uint32_t t = 0; t < filter->term_count; t++) {
        bound_term bound;
        EWA_TRY(ewa_cloud_find_scalar(cloud, filter->terms[t].name, &bound.scalar));
        bind_ranges(&filter->terms[t], &bound);
        ewa_mark_blocks(cloud, mark_block, &bound, marks);
    }
    return EWA_OK;
}

static const char *const axes[] = {EWA_POSITION ".x", EWA_POSITION ".y", EWA_POSITION ".z"};

ewa_status ewa_box_mark(const double corners_world[2][3], const ewa_cloud *cloud, uint8_t *marks) {
    if (!corners_world || !cloud || !marks) return EWA_ERROR_ARGUMENT;
    ewa_filter filter = {.term_count = 3};
    for (int c = 0; c < 3; c++) {
        ewa_filter_term *term = &filter.terms[c];
        const double a = corners_world[0][c], b = corners_world[1][c];
        memcpy(term->name, axes[c], strlen(axes[c]));
        term->range_count = 1;
        term->ranges[0] = (ewa_filter_range){.low = a < b ? a : b, .high = a < b ? b : a};
    }
    return ewa_filter_mark(&filter, cloud, marks);
}

typedef struct sphere_view {
    double center_world[3], radius_world;
    ewa_scalar coordinates[3];
} sphere_view;

static void mark_in_sphere(const void *data, uint64_t first, uint32_t count, uint8_t *marks) {
    const sphere_view *view = data;
    double numbers[EWA_MARK_BLOCK], distances2[EWA_MARK_BLOCK] = {0};
    for (int c = 0; c < 3; c++) {
        ewa_scalar_read(&view->coordinates[c], first, count, numbers);
        for (uint32_t i = 0; i < count; i++)
            distances2[i] += (numbers[i] - view->center_world[c]) * (numbers[i] - view->center_world[c]);
    }
    for (uint32_t i = 0; i < count; i++)
        marks[i] = (uint8_t)(marks[i] && distances2[i] <= view->radius_world * view->radius_world);
}

ewa_status ewa_sphere_mark(const double center_world[3], double radius_world, const ewa_cloud *cloud, uint8_t *marks) {
    if (!center_world || !cloud || !marks || !(radius_world >= 0)) return EWA_ERROR_ARGUMENT;
    sphere_view view = {.radius_world = radius_world};
    for (int c = 0; c < 3; c++) {
        view.center_world[c] = center_world[c];
        EWA_TRY(ewa_cloud_find_scalar(cloud, axes[c], &view.coordinates[c]));
    }
    ewa_mark_blocks(cloud, mark_in_sphere, &view, marks);
    return EWA_OK;
}
