// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Polygons to triangles: convex ones as fans, others by clipping ears. A polygon is projected along the
// largest component of its normal; only differences of places are used, so that a polygon far from the origin
// is cut as the same one at it.
//
// Based on: G. H. Meisters, "Polygons have ears", American Mathematical Monthly 82, 1975; M. E. Newell's
// normal as in F. Tampieri, "Newell's method for computing the plane equation of a polygon", Graphics Gems
// III, 1992.
#include "base/base.h"
#include "io/mesh/build.h"

#include <math.h>

/// Tests that a corner may cost on top of what every file may; simple outlines need a tenth.
enum { TESTS_PER_CORNER = 256 };

/// A corner that is not clipped yet.
typedef struct polygon_corner {
    double x, y;             ///< projected
    uint32_t source;         ///< corner of the polygon
    uint32_t previous, next; ///< around the rest
    bool reflex;             ///< it turns right, or not at all; only such corners can lie in an ear
} polygon_corner;

typedef struct polygon {
    ewa_mesh_build *build;
    const ewa_mesh_corner *corners;
    polygon_corner *at;
    uint32_t count; ///< corners that are left
    // The reflex corners of the beginning in a grid over the box of the polygon, side x side cells.
    uint32_t side;
    uint32_t *first, *reflex; ///< sums of corners per cell, and the corners by cell
    double low[2], per_unit[2];
} polygon;

static const double *place(const ewa_mesh_build *build, const ewa_mesh_corner *corner) {
    return (const double *)build->positions.items + 3 * (size_t)corner->position;
}

/// Twice the signed area of a triangle, positive when it turns left.
static double turn(const polygon_corner *a, const polygon_corner *b, const polygon_corner *c) {
    return (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x);
}

static double turn_at(const polygon *p, uint32_t i) {
    return turn(&p->at[p->at[i].previous], &p->at[i], &p->at[p->at[i].next]);
}

/// Newell's normal, from places relative to the first.
static void find_normal(const ewa_mesh_build *build, const ewa_mesh_corner *corners, uint64_t count,
                        double normal[3]) {
    const double *origin = place(build, &corners[0]);
    double before[3] = {0, 0, 0};
    normal[0] = normal[1] = normal[2] = 0;
    for (uint64_t i = 1; i < count; i++) {
        const double *world = place(build, &corners[i]);
        const double at[3] = {world[0] - origin[0], world[1] - origin[1], world[2] - origin[2]};
        for (int c = 0; c < 3; c++) {
            const int d = (c + 1) % 3, e = (c + 2) % 3;
            normal[c] += before[d] * at[e] - before[e] * at[d];
        }
        memcpy(before, at, sizeof before);
    }
}

/// Projects the corners, less those at the place of the one before, so that the polygon turns left. False
/// when it has no area or places that are not finite.
static bool project(polygon *p, uint64_t count) {
    const ewa_mesh_build *build = p->build;
    double normal[3];
    find_normal(build, p->corners, count, normal);
    const double size[3] = {fabs(normal[0]), fabs(normal[1]), fabs(normal[2])};
    const int axis = size[0] > size[1] ? (size[0] > size[2] ? 0 : 2) : (size[1] > size[2] ? 1 : 2);
    if (!(size[axis] > 0) || !isfinite(size[0] + size[1] + size[2])) return false;
    const int x = normal[axis] > 0 ? (axis + 1) % 3 : (axis + 2) % 3, y = 3 - axis - x;
    const double *origin = place(build, &p->corners[0]);
    for (uint64_t i = 0; i < count; i++) {
        const double *world = place(build, &p->corners[i]),
                     *last = place(build, &p->corners[(i + count - 1) % count]);
        if (memcmp(world, last, 3 * sizeof *world) == 0) continue;
        p->at[p->count++] =
            (polygon_corner){.x = world[x] - origin[x], .y = world[y] - origin[y], .source = (uint32_t)i};
    }
    for (uint32_t i = 0; i < p->count; i++) {
        p->at[i].previous = i ? i - 1 : p->count - 1;
        p->at[i].next = i + 1 < p->count ? i + 1 : 0;
    }
    return p->count >= 3;
}

static bool is_convex(const polygon *p) {
    for (uint32_t i = 0; i < p->count; i++)
        if (!(turn_at(p, i) > 0)) return false;
    return true;
}

static bool same_place(const polygon_corner *a, const polygon_corner *b) {
    return a->x == b->x && a->y == b->y;
}

static void spend(ewa_mesh_build *build, uint64_t tests) {
    build->cut_tests_left -= tests < build->cut_tests_left ? tests : build->cut_tests_left;
}

static uint32_t cell_along(const polygon *p, int axis, double value) {
    const double cell = (value - p->low[axis]) * p->per_unit[axis];
    return cell > 0 ? (cell < p->side ? (uint32_t)cell : p->side - 1) : 0;
}

/// Sorts the reflex corners by cells; a grid of about as many cells as there are such corners.
static void fill_grid(polygon *p) {
    double high[2] = {-INFINITY, -INFINITY};
    uint32_t reflex_count = 0;
    p->low[0] = p->low[1] = INFINITY;
    for (uint32_t i = 0; i < p->count; i++) {
        p->at[i].reflex = !(turn_at(p, i) > 0);
        reflex_count += p->at[i].reflex;
        const double at[2] = {p->at[i].x, p->at[i].y};
        for (int k = 0; k < 2; k++) {
            p->low[k] = fmin(p->low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
    p->side = 1;
    while ((p->side + 1) * (p->side + 1) <= reflex_count) p->side++;
    for (int k = 0; k < 2; k++) p->per_unit[k] = high[k] > p->low[k] ? p->side / (high[k] - p->low[k]) : 0;
    memset(p->first, 0, ((size_t)p->side * p->side + 2) * sizeof *p->first);
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t i = 0; i < p->count; i++) {
            if (!p->at[i].reflex) continue;
            const uint32_t cell = cell_along(p, 1, p->at[i].y) * p->side + cell_along(p, 0, p->at[i].x);
            if (pass == 0)
                p->first[cell + 2]++;
            else
                p->reflex[p->first[cell + 1]++] = i;
        }
        for (uint32_t c = 0; pass == 0 && c < p->side * p->side; c++) p->first[c + 2] += p->first[c + 1];
    }
}

/// Whether a corner can be cut off: no other lies in its triangle. Corners at the places of its three are
/// those of a cut between an outline and a hole, and do not count.
static bool is_ear(polygon *p, uint32_t i) {
    const polygon_corner *a = &p->at[p->at[i].previous], *b = &p->at[i], *c = &p->at[p->at[i].next];
    const double low_x = fmin(a->x, fmin(b->x, c->x)), high_x = fmax(a->x, fmax(b->x, c->x));
    const double low_y = fmin(a->y, fmin(b->y, c->y)), high_y = fmax(a->y, fmax(b->y, c->y));
    const uint32_t first_column = cell_along(p, 0, low_x), last_column = cell_along(p, 0, high_x),
                   last_row = cell_along(p, 1, high_y);
    for (uint32_t row = cell_along(p, 1, low_y); row <= last_row; row++) {
        const uint32_t begin = p->first[row * p->side + first_column],
                       end = p->first[row * p->side + last_column + 1];
        spend(p->build, end - begin + 1);
        for (uint32_t k = begin; k < end; k++) {
            const polygon_corner *q = &p->at[p->reflex[k]];
            if (!q->reflex || q->x < low_x || q->x > high_x || q->y < low_y || q->y > high_y) continue;
            if (q == a || q == b || q == c || same_place(q, a) || same_place(q, b) || same_place(q, c))
                continue;
            if (turn(a, b, q) >= 0 && turn(b, c, q) >= 0 && turn(c, a, q) >= 0) return false;
        }
    }
    return true;
}

static ewa_status clip(polygon *p, uint32_t i) {
    const polygon_corner *b = &p->at[i];
    const uint32_t before = b->previous, after = b->next;
    const ewa_status status = ewa_mesh_add_triangle(p->build, &p->corners[p->at[before].source],
                                                    &p->corners[b->source], &p->corners[p->at[after].source]);
    p->at[i].reflex = false;
    p->at[before].next = after;
    p->at[after].previous = before;
    p->count--;
    // What turned left goes on doing so; what turned right may begin to.
    p->at[before].reflex = p->at[before].reflex && !(turn_at(p, before) > 0);
    p->at[after].reflex = p->at[after].reflex && !(turn_at(p, after) > 0);
    return status;
}

/// Clips ears until three corners are left. When a whole round finds none, corners without an area are taken
/// for ears, then any: the polygon meets itself there.
static ewa_status clip_ears(polygon *p) {
    ewa_status status = EWA_OK;
    uint32_t i = 0, passed = 0;
    enum { STRICT, FLAT, ANY } rule = STRICT;
    bool well = true;
    while (p->count > 3 && status == EWA_OK) {
        const double turned = turn_at(p, i);
        spend(p->build, 1);
        const bool fits = rule == ANY || p->build->cut_tests_left == 0 ||
                          ((turned > 0 || (rule == FLAT && turned == 0)) && is_ear(p, i));
        const uint32_t next = p->at[i].next;
        if (fits) {
            well = well && rule != ANY && p->build->cut_tests_left > 0;
            status = clip(p, i);
            rule = STRICT;
            passed = 0;
            i = p->at[next].next; // not the neighbour: that makes slivers
        } else {
            i = next;
            if (++passed >= p->count) {
                rule = rule == STRICT ? FLAT : ANY;
                passed = 0;
            }
        }
    }
    p->build->uncut_count += !well;
    return status == EWA_OK ? clip(p, i) : status;
}

static ewa_status add_fan(ewa_mesh_build *build, const ewa_mesh_corner *corners, uint64_t count) {
    for (uint64_t i = 2; i < count; i++)
        EWA_TRY(ewa_mesh_add_triangle(build, &corners[0], &corners[i - 1], &corners[i]));
    return EWA_OK;
}

/// Adds the triangles of a polygon of more than three corners whose places are there.
static ewa_status cut_polygon(ewa_mesh_build *build, const ewa_mesh_corner *corners, uint64_t count) {
    if (count >= EWA_MESH_NONE)
        return ewa_fail(build->context, EWA_ERROR_LIMIT, "%s: a polygon of %llu corners", build->source->name,
                        (unsigned long long)count);
    // The corners, the sums of at most as many cells, and the reflex corners.
    const uint64_t bytes = count * sizeof(polygon_corner) + (2 * count + 2) * sizeof(uint32_t);
    build->scratch.count = 0;
    EWA_TRY(ewa_mesh_list_grow(build, &build->scratch, bytes));
    polygon p = {.build = build, .corners = corners, .at = build->scratch.items};
    p.first = (uint32_t *)(p.at + count);
    p.reflex = p.first + count + 2;
    if (!project(&p, count)) return add_fan(build, corners, count);
    if (is_convex(&p)) {
        for (uint32_t i = 2; i < p.count; i++)
            EWA_TRY(ewa_mesh_add_triangle(build, &corners[p.at[0].source], &corners[p.at[i - 1].source],
                                          &corners[p.at[i].source]));
        return EWA_OK;
    }
    build->cut_tests_left += TESTS_PER_CORNER * count;
    fill_grid(&p);
    return clip_ears(&p);
}

ewa_status ewa_mesh_add_polygon(ewa_mesh_build *build, const ewa_mesh_corner *corners, uint64_t count) {
    build->face_count++;
    if (count < 3) {
        build->short_count++;
        return EWA_OK;
    }
    for (uint64_t i = 0; i < count; i++)
        if (corners[i].position >= build->positions.count) {
            build->beyond_count++;
            return EWA_OK;
        }
    return count == 3 ? ewa_mesh_add_triangle(build, &corners[0], &corners[1], &corners[2])
                      : cut_polygon(build, corners, count);
}
