// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Outlines on the map: which points are inside. Edges are listed by the bands of y that they cross, so that a
// point meets few of them.
//
// Based on M. Shimrat, "Algorithm 112: Position of point relative to polygon", 1962 (even and odd crossings).
#include "base/base.h"
#include "cloud/cloud.h"
#include "cloud/marks.h"

#include <math.h>
#include <string.h>

enum { MAX_BANDS = 1024, MAX_CORNERS = 1 << 28 };

/// An edge from its lower to its upper end.
typedef struct polygon_edge {
    double low_x, low_y, high_x, high_y;
} polygon_edge;

struct ewa_polygon {
    ewa_context *context;
    uint64_t edge_count, entry_count;
    polygon_edge *edges;
    uint32_t *entries; ///< edges, band by band
    uint32_t band_count;
    uint64_t first_entry[MAX_BANDS + 1];
    double box_world[4], bands_per_unit;
};

static uint32_t band_of(const ewa_polygon *polygon, double y) {
    const double band = (y - polygon->box_world[1]) * polygon->bands_per_unit;
    return band > 0 ? (band < polygon->band_count ? (uint32_t)band : polygon->band_count - 1) : 0;
}

/// Adds the edges of a ring and widens the box.
static void add_ring(ewa_polygon *polygon, const double *corners, uint32_t count) {
    double *box = polygon->box_world;
    for (uint32_t i = 0; i < count; i++) {
        const double *a = corners + 2 * (size_t)i, *b = corners + 2 * (size_t)(i + 1 < count ? i + 1 : 0);
        const bool up = a[1] < b[1] || (a[1] == b[1] && a[0] < b[0]);
        const double *low = up ? a : b, *high = up ? b : a;
        polygon->edges[polygon->edge_count++] = (polygon_edge){low[0], low[1], high[0], high[1]};
        for (int c = 0; c < 2; c++) {
            box[c] = fmin(box[c], a[c]);
            box[c + 2] = fmax(box[c + 2], a[c]);
        }
    }
}

/// Chooses as many bands as the edges are not listed too often for; counts what each lists.
static void plan_bands(ewa_polygon *polygon) {
    const double height = polygon->box_world[3] - polygon->box_world[1];
    for (polygon->band_count = MAX_BANDS;; polygon->band_count /= 2) {
        const double per_unit = polygon->band_count / height;
        polygon->bands_per_unit = isfinite(per_unit) ? per_unit : 0;
        memset(polygon->first_entry, 0, sizeof polygon->first_entry);
        polygon->entry_count = 0;
        for (uint64_t e = 0; e < polygon->edge_count; e++) {
            const uint32_t first = band_of(polygon, polygon->edges[e].low_y),
                           last = band_of(polygon, polygon->edges[e].high_y);
            for (uint32_t band = first; band <= last; band++) polygon->first_entry[band + 1]++;
            polygon->entry_count += last - first + 1;
        }
        if (polygon->band_count == 1 || polygon->entry_count <= 8 * polygon->edge_count + MAX_BANDS) break;
    }
    for (uint32_t band = 0; band < polygon->band_count; band++)
        polygon->first_entry[band + 1] += polygon->first_entry[band];
}

/// Lists the edges of each band.
static ewa_status list_edges(ewa_polygon *polygon) {
    plan_bands(polygon);
    polygon->entries = ewa_allocate(polygon->context, polygon->entry_count, sizeof *polygon->entries);
    if (!polygon->entries) return EWA_ERROR_MEMORY;
    uint64_t next[MAX_BANDS];
    memcpy(next, polygon->first_entry, sizeof next);
    for (uint64_t e = 0; e < polygon->edge_count; e++) {
        const uint32_t last = band_of(polygon, polygon->edges[e].high_y);
        for (uint32_t band = band_of(polygon, polygon->edges[e].low_y); band <= last; band++)
            polygon->entries[next[band]++] = (uint32_t)e;
    }
    return EWA_OK;
}

static ewa_status check_corners(ewa_context *context, const double *corners, const uint32_t *ring_counts,
                                uint32_t ring_count, uint64_t *total) {
    *total = 0;
    for (uint32_t r = 0; r < ring_count; r++) {
        if (ring_counts[r] < 3)
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "polygon: ring %u has %u corners, fewer than 3",
                            r + 1, ring_counts[r]);
        *total += ring_counts[r];
    }
    if (*total > MAX_CORNERS)
        return ewa_fail(context, EWA_ERROR_LIMIT, "polygon: %llu corners, more than %d",
                        (unsigned long long)*total, MAX_CORNERS);
    for (uint64_t i = 0; i < 2 * *total; i++)
        if (!isfinite(corners[i]))
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "polygon: corner %llu is not finite",
                            (unsigned long long)(i / 2 + 1));
    return EWA_OK;
}

ewa_status ewa_polygon_create(ewa_context *context, const double *corners_world, const uint32_t *ring_counts,
                              uint32_t ring_count, ewa_polygon **polygon) {
    if (!polygon) return EWA_ERROR_ARGUMENT;
    *polygon = NULL;
    if (!context || !corners_world || !ring_counts || ring_count == 0) return EWA_ERROR_ARGUMENT;
    uint64_t total;
    EWA_TRY(check_corners(context, corners_world, ring_counts, ring_count, &total));
    ewa_polygon *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->box_world[0] = made->box_world[1] = INFINITY;
    made->box_world[2] = made->box_world[3] = -INFINITY;
    made->edges = ewa_allocate(context, total, sizeof *made->edges);
    ewa_status status = EWA_OK;
    if (made->edges) {
        for (uint32_t r = 0; r < ring_count; corners_world += 2 * (size_t)ring_counts[r++])
            add_ring(made, corners_world, ring_counts[r]);
        status = list_edges(made);
    } else {
        made->edge_count = total; // for the release
        status = EWA_ERROR_MEMORY;
    }
    if (status == EWA_OK)
        *polygon = made;
    else
        ewa_polygon_destroy(&made);
    return status;
}

void ewa_polygon_destroy(ewa_polygon **polygon) {
    if (!polygon || !*polygon) return;
    ewa_polygon *old = *polygon;
    ewa_release(old->context, old->entries, old->entry_count, sizeof *old->entries);
    ewa_release(old->context, old->edges, old->edge_count, sizeof *old->edges);
    ewa_release(old->context, old, 1, sizeof *old);
    *polygon = NULL;
}

void ewa_polygon_box(const ewa_polygon *polygon, double box_world[4]) {
    memcpy(box_world, polygon->box_world, sizeof polygon->box_world);
}

/// Whether a point is on an edge or has an odd number of them to its right.
static bool is_inside(const ewa_polygon *polygon, double x, double y) {
    const double *box = polygon->box_world;
    if (!(x >= box[0] && y >= box[1] && x <= box[2] && y <= box[3])) return false;
    const uint32_t band = band_of(polygon, y);
    bool inside = false;
    for (uint64_t k = polygon->first_entry[band]; k < polygon->first_entry[band + 1]; k++) {
        const polygon_edge *e = &polygon->edges[polygon->entries[k]];
        if (y < e->low_y || y > e->high_y) continue;
        // Above 0 to the left of the edge. Differences first: map coordinates are large.
        const double side = (e->high_x - e->low_x) * (y - e->low_y) - (x - e->low_x) * (e->high_y - e->low_y);
        if (side == 0 && x >= fmin(e->low_x, e->high_x) && x <= fmax(e->low_x, e->high_x)) return true;
        if (y < e->high_y && side > 0) inside = !inside;
    }
    return inside;
}

/// What the blocks of a cloud are looked at with.
typedef struct polygon_view {
    const ewa_polygon *polygon;
    ewa_scalar x, y;
} polygon_view;

static void mark_block(const void *data, uint64_t first, uint32_t count, uint8_t *marks) {
    const polygon_view *view = data;
    double x[EWA_MARK_BLOCK], y[EWA_MARK_BLOCK];
    ewa_scalar_read(&view->x, first, count, x);
    ewa_scalar_read(&view->y, first, count, y);
    for (uint32_t i = 0; i < count; i++) marks[i] = marks[i] && is_inside(view->polygon, x[i], y[i]);
}

ewa_status ewa_polygon_mark(const ewa_polygon *polygon, const ewa_cloud *cloud, uint8_t *marks) {
    if (!polygon || !cloud || !marks) return EWA_ERROR_ARGUMENT;
    polygon_view view = {.polygon = polygon};
    if (!ewa_marks_position(cloud)) return EWA_ERROR_ARGUMENT;
    EWA_TRY(ewa_cloud_find_scalar(cloud, EWA_POSITION ".x", &view.x));
    EWA_TRY(ewa_cloud_find_scalar(cloud, EWA_POSITION ".y", &view.y));
    ewa_mark_blocks(cloud, mark_block, &view, marks);
    return EWA_OK;
}
