// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clipping of segments and convex polygons in homogeneous coordinates, for both signs of w; double precision,
// one at a time. The batch clipper (clip_batch.h) follows ewa_clip_segment() step by step.
//
// Visible are two convex cones: where the six boundary coordinates w + x, w - x, w + y, w - y, z, w - z are
// all >= 0, and where all are <= 0. A segment and each cone share one interval of alpha (Liang and Barsky), a
// convex polygon and each cone one convex polygon (Sutherland and Hodgman).
//
// Based on: Bloomenthal and Rokne, Homogeneous Coordinates, section Homogeneous Clipping; Blinn and Newell,
// Clipping Using Homogeneous Coordinates, SIGGRAPH 1978.
#include "homogeneous/clip_planes.h"
#include "homogeneous/noise.h"

/// Coordinates beyond 2^SAFE_EXPONENT are scaled down together, so that no sum overflows.
enum { SAFE_EXPONENT = 1000, MAX_CORNERS = 1 << 20 };

static double largest(ewa_vec4 p) { return fmax(fmax(fabs(p.x), fabs(p.y)), fmax(fabs(p.z), fabs(p.w))); }

/// The power of two to multiply all points of one segment or polygon with; alpha does not depend on it.
static double safe_scale(double largest_number) {
    int exponent = 0;
    frexp(largest_number, &exponent);
    return exponent > SAFE_EXPONENT ? ldexp(1, SAFE_EXPONENT - exponent) : 1;
}

static ewa_vec4 between(ewa_vec4 p1, ewa_vec4 p2, double alpha) {
    return vec4_add(vec4_scale(p1, 1 - alpha), vec4_scale(p2, alpha));
}

/// True where the w of a point between p1 and p2 has cancelled to rounding error. In a visible cone w is 0
/// for the zero vector only, which the segment passes through there: no point at all.
static bool vanishes(ewa_vec4 p1, ewa_vec4 p2, double alpha, ewa_vec4 point) {
    if (alpha == 1) return point.w == 0;
    return fabs(point.w) <= NOISE * (fabs(p1.w) + alpha * fabs(p2.w));
}

/// Takes the last rounding error back: a clipped point lies in its cone, not next to it.
static ewa_vec4 settle(ewa_vec4 p) {
    double reach = fabs(p.w);
    p.x = fmax(-reach, fmin(reach, p.x));
    p.y = fmax(-reach, fmin(reach, p.y));
    p.z = fmax(fmin(0, p.w), fmin(fmax(0, p.w), p.z));
    return p;
}

/// The interval of a segment in the cone of one sign.
static bool clip_to_cone(ewa_vec4 p1, ewa_vec4 p2, double sign, ewa_segment_part *part) {
    double begin = 0, end = 1;
    for (int i = 0; i < 6; i++) {
        double b1 = sign * boundary_coordinate(p1, i), b2 = sign * boundary_coordinate(p2, i);
        if (b1 < 0 && b2 < 0) return false;
        if (b1 < 0) begin = fmax(begin, b1 / (b1 - b2));
        if (b2 < 0) end = fmin(end, b1 / (b1 - b2));
    }
    if (!(begin <= end)) return false;
    double alpha[2] = {begin, end};
    ewa_vec4 point[2];
    bool no_point[2];
    for (int e = 0; e < 2; e++) {
        point[e] = between(p1, p2, alpha[e]);
        no_point[e] = !(sign * point[e].w > 0) || vanishes(p1, p2, alpha[e], point[e]);
    }
    if (no_point[0] && no_point[1]) return false;
    for (int e = 0; e < 2; e++) {
        int from = no_point[e] ? 1 - e : e; // the ends are one projective point: p2 = -k p1
        part->alpha[e] = alpha[from];
        part->end[e] = settle(point[from]);
    }
    return true;
}

ewa_status ewa_clip_alphas(ewa_vec4 p1, ewa_vec4 p2, double alpha[6], uint32_t *crossed) {
    if (!alpha || !crossed) return EWA_ERROR_ARGUMENT;
    if (!vec4_is_finite(p1) || !vec4_is_finite(p2)) return EWA_ERROR_NUMERIC;
    double scale = safe_scale(fmax(largest(p1), largest(p2)));
    p1 = vec4_scale(p1, scale);
    p2 = vec4_scale(p2, scale);
    *crossed = 0;
    for (int i = 0; i < 6; i++) {
        double b1 = boundary_coordinate(p1, i), difference = b1 - boundary_coordinate(p2, i);
        double value = difference != 0 ? b1 / difference : 0;
        bool crosses = difference != 0 && isfinite(value);
        alpha[i] = crosses ? value : 0;
        if (crosses) *crossed |= 1u << i;
    }
    return EWA_OK;
}

ewa_status ewa_clip_segment(ewa_vec4 p1, ewa_vec4 p2, ewa_segment_part parts[2], uint32_t *visible) {
    if (!parts || !visible) return EWA_ERROR_ARGUMENT;
    if (!vec4_is_finite(p1) || !vec4_is_finite(p2) || largest(p1) == 0 || largest(p2) == 0)
        return EWA_ERROR_NUMERIC;
    double scale = safe_scale(fmax(largest(p1), largest(p2)));
    p1 = vec4_scale(p1, scale);
    p2 = vec4_scale(p2, scale);
    *visible = 0;
    for (int k = 0; k < 2; k++)
        if (clip_to_cone(p1, p2, k ? -1 : 1, &parts[k])) {
            for (int e = 0; e < 2; e++) parts[k].end[e] = vec4_scale(parts[k].end[e], 1 / scale);
            *visible |= k ? EWA_VISIBLE_NEGATIVE : EWA_VISIBLE_POSITIVE;
        }
    return EWA_OK;
}

/// Corners of a polygon in the caller's arrays.
typedef struct corners {
    ewa_vec4 *points;
    double *attributes;
    uint32_t count, attribute_count;
} corners;

static void append(corners *to, ewa_vec4 point, const double *attributes1, const double *attributes2,
                   double alpha) {
    to->points[to->count] = point;
    size_t n = to->attribute_count, first = to->count * n;
    for (size_t i = 0; i < n; i++)
        to->attributes[first + i] = (1 - alpha) * attributes1[i] + alpha * attributes2[i];
    to->count++;
}

static const double *attributes_of(const corners *polygon, uint32_t i) {
    return polygon->attribute_count ? polygon->attributes + (size_t)i * polygon->attribute_count : NULL;
}

/// Where the edge from a corner inside to a corner outside crosses: always in this direction, so that the
/// polygons on both sides of an edge get the same corner. [0 0 0 0] where it is no point.
static void append_crossing(corners *to, const corners *from, uint32_t inside, uint32_t outside,
                            double b_inside, double b_outside) {
    double alpha = b_inside / (b_inside - b_outside);
    ewa_vec4 p1 = from->points[inside], p2 = from->points[outside], point = between(p1, p2, alpha);
    // Between planes a corner may well have w = 0; only where all of it has cancelled it is no point.
    if (vec4_is_noise(point, vec4_add(vec4_abs(p1), vec4_scale(vec4_abs(p2), alpha))))
        point = vec4_make(0, 0, 0, 0);
    append(to, point, attributes_of(from, inside), attributes_of(from, outside), alpha);
}

/// One plane: keeps what is inside. A convex polygon grows by one corner at most; one that is not convex is
/// cut off at `capacity`.
static void clip_by_plane(const corners *from, corners *to, int plane, double sign, uint32_t capacity) {
    to->count = 0;
    for (uint32_t i = 0; i < from->count; i++) {
        uint32_t next = i + 1 < from->count ? i + 1 : 0;
        double b1 = sign * boundary_coordinate(from->points[i], plane);
        double b2 = sign * boundary_coordinate(from->points[next], plane);
        if (to->count + 2 > capacity) return;
        if (b1 >= 0) append(to, from->points[i], attributes_of(from, i), attributes_of(from, i), 0);
        if (b1 < 0 && b2 > 0) append_crossing(to, from, next, i, b2, b1);
        if (b1 > 0 && b2 < 0) append_crossing(to, from, i, next, b1, b2);
    }
}

/// Drops corners that are no points, settles the others.
static void settle_corners(corners *polygon, double sign, double scale) {
    corners kept = *polygon;
    kept.count = 0;
    for (uint32_t i = 0; i < polygon->count; i++) {
        ewa_vec4 point = polygon->points[i];
        if (sign * point.w > 0)
            append(&kept, vec4_scale(settle(point), 1 / scale), attributes_of(polygon, i),
                   attributes_of(polygon, i), 0);
    }
    polygon->count = kept.count < 3 ? 0 : kept.count;
}

static void clip_polygon_to_cone(const ewa_vec4 *points, const double *attributes, corners result,
                                 corners work, double sign, double scale, uint32_t capacity,
                                 uint32_t *count) {
    uint32_t point_count = result.count, attribute_count = result.attribute_count;
    result.count = 0;
    for (uint32_t i = 0; i < point_count; i++) {
        const double *own = attribute_count ? attributes + (size_t)i * attribute_count : NULL;
        append(&result, vec4_scale(points[i], scale), own, own, 0);
    }
    for (int plane = 0; plane < 6; plane += 2) { // an even number of planes ends where it began
        clip_by_plane(&result, &work, plane, sign, capacity);
        clip_by_plane(&work, &result, plane + 1, sign, capacity);
    }
    settle_corners(&result, sign, scale);
    *count = result.count;
}

ewa_status ewa_clip_polygon(const ewa_vec4 *points, const double *attributes, uint32_t point_count,
                            uint32_t attribute_count, ewa_vec4 *clipped_points, double *clipped_attributes,
                            uint32_t clipped_count[2]) {
    if (!points || !clipped_points || !clipped_count) return EWA_ERROR_ARGUMENT;
    if (point_count < 3 || point_count > MAX_CORNERS) return EWA_ERROR_ARGUMENT;
    double largest_number = 0;
    for (uint32_t i = 0; i < point_count; i++) {
        if (!vec4_is_finite(points[i])) return EWA_ERROR_NUMERIC;
        largest_number = fmax(largest_number, largest(points[i]));
    }
    for (size_t i = 0; i < (size_t)point_count * attribute_count; i++)
        if (!isfinite(attributes[i])) return EWA_ERROR_NUMERIC;
    uint32_t capacity = point_count + 6;
    corners area[3];
    for (size_t k = 0; k < 3; k++)
        area[k] = (corners){.points = clipped_points + k * capacity,
                            .attributes =
                                attribute_count ? clipped_attributes + k * capacity * attribute_count : NULL,
                            .count = point_count,
                            .attribute_count = attribute_count};
    double scale = safe_scale(largest_number);
    for (int k = 0; k < 2; k++)
        clip_polygon_to_cone(points, attributes, area[k], area[2], k ? -1 : 1, scale, capacity,
                             &clipped_count[k]);
    return EWA_OK;
}
