// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Homogeneous coordinates: points, lines, planes, conics, maps, perspective, clipping (docs/homogeneous.md).
//
// Row vectors: x' = x M; the map A followed by B is A B. w = 0 is a direction and never an error by itself.
// Functions that return a value are sums of products: total, without divisions; NaN passes through. Functions
// that return ewa_status give EWA_ERROR_NUMERIC, and leave their outputs alone, when a number that comes in is
// not finite or what they are asked for does not exist (a result that is zero to within rounding counts as
// zero). Outputs may alias inputs. Any thread may call anything here.
//
// Based on: Bloomenthal and Rokne, Homogeneous Coordinates (HC below); Blinn, A Homogeneous Formulation for
// Lines in 3 Space, 1977; Blinn and Newell, Clipping Using Homogeneous Coordinates, 1978; Blinn, Hyperbolic
// Interpolation, 1992.
#ifndef EWA_HOMOGENEOUS_H
#define EWA_HOMOGENEOUS_H

#include "ewa/base.h"
#include "ewa/camera.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Three numbers: a vector (x, y, z), a point of the plane [x y w] with z as its w, or a line of the plane
/// (a, b, c) with a x + b y + c w = 0.
typedef struct ewa_vec3 {
    double x, y, z;
} ewa_vec3;

/// Four numbers: a point of space [x y z w], or a plane (a, b, c, d) with a x + b y + c z + d w = 0.
typedef struct ewa_vec4 {
    double x, y, z, w;
} ewa_vec4;

/// A map of the plane, x' = x M for a row vector x: m[row][column].
typedef struct ewa_mat3 {
    double m[3][3];
} ewa_mat3;

/// A map of space, x' = x M for a row vector x: m[row][column].
typedef struct ewa_mat4 {
    double m[4][4];
} ewa_mat4;

/// A line of space in Plücker form: for points p, q on it direction = pw q - qw p and moment = p x q (of
/// their x, y, z), so that direction . moment = 0. A line at infinity has direction 0.
typedef struct ewa_line3 {
    ewa_vec3 direction, moment;
} ewa_line3;

/// A symmetric 3x3 matrix. As a conic Q it holds the points x Q x' = 0, that is
/// xx x^2 + 2 xy x y + yy y^2 + 2 xw x w + 2 yw y w + ww w^2 = 0; as a dual conic D the tangent
/// lines l D l' = 0.
typedef struct ewa_conic {
    double xx, xy, xw, yy, yw, ww;
} ewa_conic;

// ---- Points, lines, planes (HC, Homogeneous Lines) -------------------------------------------------------

/// Divides a point of the plane by its w: xy = (x/w, y/w).
/// Errors: EWA_ERROR_NUMERIC for a direction (w = 0) and when the quotient overflows.
EWA_API ewa_status ewa_point2_divide(ewa_vec3 point, double xy[2]);

/// Divides a point of space by its w: xyz = (x/w, y/w, z/w). Errors as ewa_point2_divide().
EWA_API ewa_status ewa_point3_divide(ewa_vec4 point, double xyz[3]);

/// Joins two points by a line, p x q; two directions give the line at infinity.
/// Errors: EWA_ERROR_NUMERIC when both are the same point.
EWA_API ewa_status ewa_line2_join(ewa_vec3 p, ewa_vec3 q, ewa_vec3 *line);

/// Meets two lines in a point, k x l; parallel lines meet in a direction [b -a 0].
/// Errors: EWA_ERROR_NUMERIC when both are the same line.
EWA_API ewa_status ewa_line2_meet(ewa_vec3 k, ewa_vec3 l, ewa_vec3 *point);

/// Returns the incidence product of a point and a line of the plane: 0 on the line, of one sign on each side
/// (w > 0).
EWA_API double ewa_incidence2(ewa_vec3 point, ewa_vec3 line);

/// Returns the incidence product of a point and a plane: 0 on the plane, of one sign on each side (w > 0).
EWA_API double ewa_incidence3(ewa_vec4 point, ewa_vec4 plane);

/// Measures the signed distance of a point to a line, positive on the side that (a, b) points to.
/// Errors: EWA_ERROR_NUMERIC for a direction and for the line at infinity.
EWA_API ewa_status ewa_line2_distance(ewa_vec3 line, ewa_vec3 point, double *distance);

/// Joins three points by a plane.
/// Errors: EWA_ERROR_NUMERIC when they lie on one line.
EWA_API ewa_status ewa_plane_join(ewa_vec4 p, ewa_vec4 q, ewa_vec4 r, ewa_vec4 *plane);

/// Meets three planes in a point; a direction when their lines of intersection are parallel.
/// Errors: EWA_ERROR_NUMERIC when they share a line.
EWA_API ewa_status ewa_plane_meet(ewa_vec4 a, ewa_vec4 b, ewa_vec4 c, ewa_vec4 *point);

/// Measures the signed distance of a point to a plane, positive on the side that (a, b, c) points to.
/// Errors: EWA_ERROR_NUMERIC for a direction and for the plane at infinity.
EWA_API ewa_status ewa_plane_distance(ewa_vec4 plane, ewa_vec4 point, double *distance);

// ---- Coordinates in a triangle (HC, Introduction, figure 1) ----------------------------------------------

/// Gives the weights (Möbius) of a point at the vertices of a triangle: point = sum of weight times vertex
/// with w = 1. They sum to the point's w: 1 for [x y 1], 0 for a direction. Errors: EWA_ERROR_NUMERIC when a
/// vertex is a direction or the triangle has no area.
EWA_API ewa_status ewa_triangle_barycentric(const ewa_vec3 triangle[3], ewa_vec3 point, double weights[3]);

/// Gives the point [x y w] of weights, w being their sum; scaling all of them does not move it.
/// Errors as ewa_triangle_barycentric().
EWA_API ewa_status ewa_triangle_point(const ewa_vec3 triangle[3], const double weights[3], ewa_vec3 *point);

/// Gives the trilinear (Plücker) coordinates of a point: its signed distances, times its w, to the edges
/// opposite to vertex 0, 1, 2, positive on the inner side. Errors as ewa_triangle_barycentric().
EWA_API ewa_status ewa_triangle_distances(const ewa_vec3 triangle[3], ewa_vec3 point, double distances[3]);

/// Gives the point [x y w] of trilinear coordinates; scaling all of them does not move it.
/// Errors as ewa_triangle_barycentric().
EWA_API ewa_status ewa_triangle_point_from_distances(const ewa_vec3 triangle[3], const double distances[3],
                                                     ewa_vec3 *point);

// ---- Lines of space (Blinn 1977) -------------------------------------------------------------------------

/// Joins two points by a line. Errors: EWA_ERROR_NUMERIC when both are the same point.
EWA_API ewa_status ewa_line3_join(ewa_vec4 p, ewa_vec4 q, ewa_line3 *line);

/// Meets two planes in a line; parallel planes meet in a line at infinity.
/// Errors: EWA_ERROR_NUMERIC when both are the same plane.
EWA_API ewa_status ewa_line3_meet(ewa_vec4 a, ewa_vec4 b, ewa_line3 *line);

/// Meets a line with a plane in a point; a direction when they are parallel.
/// Errors: EWA_ERROR_NUMERIC when the line lies in the plane.
EWA_API ewa_status ewa_line3_meet_plane(ewa_line3 line, ewa_vec4 plane, ewa_vec4 *point);

/// Joins a line with a point by a plane. Errors: EWA_ERROR_NUMERIC when the point is on the line.
EWA_API ewa_status ewa_line3_join_point(ewa_line3 line, ewa_vec4 point, ewa_vec4 *plane);

/// Returns k.direction . l.moment + l.direction . k.moment: 0 where two lines meet or are parallel, else its
/// sign says which way one turns around the other.
EWA_API double ewa_line3_incidence(ewa_line3 k, ewa_line3 l);

/// Returns the line through the mapped points of a line: A' = M' A M for A = p'q - q'p.
EWA_API ewa_line3 ewa_line3_transform(ewa_line3 line, const ewa_mat4 *map);

// ---- Maps (HC, Transformations, Sequences) ---------------------------------------------------------------

/// Returns A B: first `first`, then `second`.
EWA_API ewa_mat3 ewa_mat3_concatenate(const ewa_mat3 *first, const ewa_mat3 *second);
EWA_API ewa_mat4 ewa_mat4_concatenate(const ewa_mat4 *first, const ewa_mat4 *second);

/// Inverts a map. Errors: EWA_ERROR_NUMERIC when it is singular to within rounding.
EWA_API ewa_status ewa_mat3_invert(const ewa_mat3 *map, ewa_mat3 *inverse);
EWA_API ewa_status ewa_mat4_invert(const ewa_mat4 *map, ewa_mat4 *inverse);

// ---- What a map does -------------------------------------------------------------------------------------
// docs/math.md section 1. "Pull" goes from the image back to the source and needs no inverse; to send many
// things forward, invert the map once and pull by the inverse.

EWA_API ewa_vec3 ewa_point2_transform(ewa_vec3 point, const ewa_mat3 *map); ///< p M
EWA_API ewa_vec4 ewa_point3_transform(ewa_vec4 point, const ewa_mat4 *map); ///< p M
EWA_API ewa_vec3 ewa_line2_pull(ewa_vec3 image_line, const ewa_mat3 *map); ///< l M': the line that maps to it
EWA_API ewa_vec4 ewa_plane_pull(ewa_vec4 image_plane, const ewa_mat4 *map); ///< l M': the same of space

/// Maps a line, l M^-T (row vector), keeping incidence products. Errors: EWA_ERROR_NUMERIC for a singular
/// map.
EWA_API ewa_status ewa_line2_transform(ewa_vec3 line, const ewa_mat3 *map, ewa_vec3 *image_line);

/// Maps a plane, l M^-T (row vector), keeping incidence products. Errors: EWA_ERROR_NUMERIC for a singular
/// map.
EWA_API ewa_status ewa_plane_transform(ewa_vec4 plane, const ewa_mat4 *map, ewa_vec4 *image_plane);

EWA_API double ewa_conic_value(const ewa_conic *conic, ewa_vec3 point);   ///< x Q x'
EWA_API ewa_vec3 ewa_conic_polar(const ewa_conic *conic, ewa_vec3 point); ///< x Q; on the conic: tangent
EWA_API ewa_conic ewa_conic_dual(const ewa_conic *conic);                 ///< adj(Q): the tangents of Q
EWA_API ewa_conic ewa_conic_pull(const ewa_conic *image_conic, const ewa_mat3 *map);    ///< M Q M'
EWA_API ewa_conic ewa_dual_conic_transform(const ewa_conic *dual, const ewa_mat3 *map); ///< M' D M

/// Maps a conic, M^-1 Q M^-T. Errors: EWA_ERROR_NUMERIC for a singular map.
EWA_API ewa_status ewa_conic_transform(const ewa_conic *conic, const ewa_mat3 *map, ewa_conic *image_conic);

/// Reads an ellipse off its dual conic: centre c and shape S = (xx, xy, yy) with the boundary
/// (x - c) S^-1 (x - c)' = 1, so that sqrt(xx) and sqrt(yy) are the half sides of its tight box
/// (docs/math.md section 3).
/// Errors: EWA_ERROR_NUMERIC when it is no real ellipse.
EWA_API ewa_status ewa_dual_conic_ellipse(const ewa_conic *dual, double center[2], double shape[3]);

// ---- Perspective (HC, Perspective Space) -----------------------------------------------------------------

/// Makes the map from the world to clip space of a camera: its picture's edges go to x', y' = -1 (left, top)
/// and 1, `near_z` and `far_z` to 0 and 1; in perspective far_z may be INFINITY, and w' = z / near_z. Errors:
/// EWA_ERROR_NUMERIC for a camera or a range of depths that makes none.
EWA_API ewa_status ewa_camera_clip_map(const ewa_camera *camera, double near_z, double far_z,
                                       ewa_mat4 *world_to_clip);

// ---- Clipping (HC, Homogeneous Clipping) -----------------------------------------------------------------
// Visible is -1 <= x/w, y/w <= 1, 0 <= z/w <= 1: for positive w  -w <= x, y <= w, 0 <= z <= w, for negative w
// the reverse. What joins a point of positive w to one of negative w passes through infinity (an external
// segment) and can have a visible part on either side. Numbers carried along (attributes) are linear in
// alpha.

typedef enum ewa_clip_plane {
    EWA_CLIP_LEFT = 0, ///< x + w = 0
    EWA_CLIP_RIGHT,    ///< w - x = 0
    EWA_CLIP_BOTTOM,   ///< y + w = 0
    EWA_CLIP_TOP,      ///< w - y = 0
    EWA_CLIP_NEAR,     ///< z = 0
    EWA_CLIP_FAR,      ///< w - z = 0
} ewa_clip_plane;

enum {
    EWA_VISIBLE_POSITIVE = 1, ///< part 0: where w is positive
    EWA_VISIBLE_NEGATIVE = 2, ///< part 1: where w is negative
    EWA_VISIBLE_INVALID = 255 ///< a batch segment with an end that is no point
};

/// A visible part of a segment: where it begins and ends, alpha in [0, 1], and its ends, inside or on the
/// planes.
typedef struct ewa_segment_part {
    double alpha[2];
    ewa_vec4 end[2];
} ewa_segment_part;

/// Gives the alpha at which the line p1 + alpha (p2 - p1) meets each clip plane; bit i of `crossed` says
/// whether it meets plane i in one point, alpha[i] is 0 where not.
EWA_API ewa_status ewa_clip_alphas(ewa_vec4 p1, ewa_vec4 p2, double alpha[6], uint32_t *crossed);

/// Clips a segment; bits EWA_VISIBLE_* of `visible` say which of the two parts exist, parts that do not are
/// not set. Errors: EWA_ERROR_NUMERIC when an end is not finite or [0 0 0 0].
EWA_API ewa_status ewa_clip_segment(ewa_vec4 p1, ewa_vec4 p2, ewa_segment_part parts[2], uint32_t *visible);

/// Clips a convex polygon of `point_count` >= 3 corners, each with `attribute_count` numbers (may be 0) in
/// `attributes`, tightly packed. `clipped_points` and `clipped_attributes` hold 3 (point_count + 6) corners:
/// the first clipped_count[0] are the part with positive w, clipped_count[1] from number point_count + 6 on
/// the part with negative w, the rest is working space; 0 corners: nothing is visible. They must not overlap
/// the input. A corner made on an edge does not depend on the edge's direction, so that neighbours stay
/// joined. Errors: EWA_ERROR_ARGUMENT for fewer than 3 or more than 2^20 corners, EWA_ERROR_NUMERIC when a
/// number is not finite.
EWA_API ewa_status ewa_clip_polygon(const ewa_vec4 *points, const double *attributes, uint32_t point_count,
                                    uint32_t attribute_count, ewa_vec4 *clipped_points,
                                    double *clipped_attributes, uint32_t clipped_count[2]);

/// Segments for ewa_clip_segments(): one array of `count` floats for each coordinate x, y, z, w of the two
/// ends.
typedef struct ewa_segment_batch {
    uint64_t count;
    const float *end[2][4]; ///< [end][coordinate]
} ewa_segment_batch;

/// What ewa_clip_segments() writes, arrays of `count` elements; part 0 has positive, part 1 negative w.
typedef struct ewa_segment_clips {
    uint8_t *visible;   ///< EWA_VISIBLE_* bits, or EWA_VISIBLE_INVALID
    float *alpha[2][2]; ///< [part][end]; 1 and 0 where the part does not exist
    /// [part][end][coordinate]: the clipped ends, 0 where there are none; all NULL: not wanted
    float *end[2][2][4];
} ewa_segment_clips;

/// Clips many segments in single precision, on the context's threads: like ewa_clip_segment() but for
/// rounding, the same bytes from every instruction set and number of threads. Arrays need no alignment and
/// must not overlap. Errors: EWA_ERROR_NUMERIC, after all others are done, when some segments are marked
/// invalid: an end has a coordinate beyond +-2^124 or not finite, or is [0 0 0 0]. EWA_ERROR_ARGUMENT for a
/// NULL array.
EWA_API ewa_status ewa_clip_segments(ewa_context *context, const ewa_segment_batch *segments,
                                     const ewa_segment_clips *clips);

// ---- Hyperbolic interpolation (HC, Associated Vertex Transformations; Blinn 1992; Heckbert 1989) ---------

/// Fits value = (a sx + b sy + c) / (d sx + e sy + f) to numbers at three corners of a projected polygon:
/// corners are homogeneous, of either sign of w, sx = x/w, sy = y/w; `values` holds `count` numbers per
/// corner, corner after corner; numerators[i] = (a, b, c) of number i and the common denominator (d, e, f).
/// Errors: EWA_ERROR_NUMERIC when the polygon is seen edge-on.
EWA_API ewa_status ewa_hyperbolic_fit(const ewa_vec4 corners[3], const double *values, uint32_t count,
                                      ewa_vec3 *numerators, ewa_vec3 *denominator);

/// Evaluates a fit at a place on the screen. Errors: EWA_ERROR_NUMERIC on the polygon's horizon, where it is
/// infinite.
EWA_API ewa_status ewa_hyperbolic_at(ewa_vec3 numerator, ewa_vec3 denominator, double screen_x,
                                     double screen_y, double *value);

/// Gives alpha along a segment with ends of w1 and w2 for the share `t` of its projection, so that any
/// attribute is a1 + alpha (a2 - a1) there. Errors: EWA_ERROR_NUMERIC where t is the vanishing point.
EWA_API ewa_status ewa_hyperbolic_alpha(double w1, double w2, double t, double *alpha);

#ifdef __cplusplus
}
#endif
#endif
