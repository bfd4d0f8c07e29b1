// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From positions to surfels, and test objects.
#ifndef EWA_PREPARE_H
#define EWA_PREPARE_H

#include "ewa/base.h"
#include "ewa/cloud.h"
#include "ewa/options.h"
#include "ewa/volume.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Default support radius of a surfel in units of the local spacing.
#define EWA_DEFAULT_RADIUS_SCALE 1.14

/// Default largest support radius of an estimated surfel in units of the median spacing around it.
#define EWA_DEFAULT_RADIUS_LIMIT 2.75

typedef enum ewa_orientation {
    EWA_ORIENT_PROPAGATE = 0, ///< consistent along the neighbour graph, outward for closed surfaces
    EWA_ORIENT_VIEWPOINT = 1, ///< towards viewpoint_world
    EWA_ORIENT_NONE = 2,      ///< as the eigenvector comes (sign: largest component positive)
    /// by what the cloud knows: towards the scanner of each point ("scan", note "scanners"); else upwards, +z,
    /// where points have a "return_number", as seen from the air; else as PROPAGATE
    EWA_ORIENT_AUTO = 3,
} ewa_orientation;

typedef enum ewa_surfel_shape {
    EWA_SHAPE_DISC = 0,    ///< "radius" from the local spacing
    EWA_SHAPE_ELLIPSE = 1, ///< "tangent_u", "tangent_v" from the local anisotropy of the sampling
} ewa_surfel_shape;

/// How positions become surfels. Fill with ewa_estimate_options_init().
typedef struct ewa_estimate_options {
    size_t struct_size;
    uint32_t neighbour_count;    ///< k, the point itself not counted; 6 to 64; default 16
    ewa_orientation orientation; ///< default EWA_ORIENT_AUTO
    double viewpoint_world[3];   ///< for EWA_ORIENT_VIEWPOINT
    ewa_surfel_shape shape;
    double radius_scale; ///< support radius in units of the local spacing 1/sqrt(density); (0, inf); default
                         ///< 1
    /// Radii that close gaps are at most this many times the median spacing of the places around, a third
    /// more where samples are on lines or discs are enlarged around a void; gaps that need more stay open; [1, inf);
    /// default 2.75
    double radius_limit;
    double cutoff;         ///< F: tangent axes are radius / F long; (0, 4]; default 3
    bool keep_normals;     ///< keep "normal" when the cloud has it; default true
    bool keep_radii;       ///< keep "radius" or tangent axes when the cloud has them; default true
    double outlier_factor; ///< remove points whose mean neighbour distance exceeds mean + factor * deviation;
                           ///< 0: keep all; [0, inf)
} ewa_estimate_options;

EWA_API extern const ewa_option_table ewa_estimate_options_table;
EWA_API void ewa_estimate_options_init(ewa_estimate_options *options, size_t struct_size);

/// Adds what a surfel needs and the cloud lacks: "normal", and "radius" or tangent axes; with these "border" or
/// "clip0" where the surface ends, "surfaceness" where there is none.
///
/// - Neighbours are the k nearest other places, duplicates being one place, with all that are as far as the
///   k-th. Where they lie almost on a line (a scanner's lines far apart) 64 are asked instead.
/// - Normals are the direction of smallest variance, turned as `orientation` says; (0, 0, 1) for a lone
///   point.
/// - Radii are radius_scale times the spacing, and never so small that irregular sampling leaves a hole, but
///   for `radius_limit`: discs around a gap in which kernels would add up to too little are enlarged. Points that
///   are no part of what is around them get no more than radius_scale times the spacing there. Axes have the same area and the proportions of the point's cell among its neighbours,
///   at most 4 : 1, with u x v along the normal. What the old sizes meant goes: "radius" beside new axes,
///   axes beside new radii, clip lines and borders beside either.
/// - Borders are where the 64 nearest places end at a line within the disc's reach, beyond which 12 of them would
///   be by chance: discs end 0.2 spacings behind the outermost places. Gaps that discs may close are none, nor are
///   those between lines of samples; a cloud without borders gets no such stream.
/// - "surfaceness" tells where the 64 nearest places are no surface, as in trees, or on a curve, as wires are; a
///   cloud without such places gets no such stream, and keeps none of before beside new radii or axes.
/// - "signed_curvature" is measured by the normals of the eight nearest places, 0 where these do not tell; a cloud that
///   is flat throughout gets no such stream. What it has of it is kept beside normals that are kept; of a cloud that has all
///   else only this is measured.
/// - Points with coordinates that are not finite get zeros. Coplanar, collinear and identical points get
///   finite results; an info message says how many have no plane.
/// - Outlier removal replaces the cloud by a smaller one, which also lacks the points that are not finite.
///
/// The result depends on the places only: not on threads, instruction sets, nor the order of the points, but
/// that orientation breaks ties between equal costs by the order of places along the Z-order curve. After a
/// failure the cloud has none of the new streams, and may lack those that they replace. Errors:
/// EWA_ERROR_ARGUMENT, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_CANCELLED. One thread per context. Cost: about
/// 0.2 s and 100 bytes per point meanwhile for a million points on two cores (60 without propagation). Based
/// on H. Hoppe et al., "Surface reconstruction from unorganized points", 1992, sections 3.2 and 3.3.
EWA_API ewa_status ewa_cloud_estimate(ewa_cloud **cloud, const ewa_estimate_options *options);

/// Clears the marks (one per point) of points that are far from all others: whose mean distance to their `neighbour_count` nearest
/// places is over the mean of all by more than `outlier_factor` standard deviations, which is above 0; and of points that are not
/// finite. Neighbours are all points, marked or not. What ewa_cloud_estimate() removes; other members of `options` do not count.
/// The same for every number of threads. Progress stage: "outliers". Errors: EWA_ERROR_ARGUMENT (no positions, options), EWA_ERROR_LIMIT
/// (2^32 - 1 points or more), EWA_ERROR_MEMORY, EWA_CANCELLED; marks are as they were then. Source: R. B. Rusu et al., "Towards 3D point
/// cloud based object maps for household environments", 2008, section 5.1 (statistical outlier removal).
EWA_API ewa_status ewa_cloud_mark_outliers(const ewa_cloud *cloud, const ewa_estimate_options *options, uint8_t *marks);

/// What the neighbourhoods of a cloud say about its sampling; world units.
typedef struct ewa_spacing {
    double median_world, mean_world; ///< of 1/sqrt(local density)
    double low_world, high_world;    ///< 5th and 95th percentile
    uint64_t duplicate_count;        ///< points with another point at the same place
} ewa_spacing;

/// Measures the sampling from at most `sample_count` places (0: all), the same ones for every run. All zero
/// but the duplicates when fewer than two places are finite. Errors: EWA_ERROR_ARGUMENT (no positions),
/// EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_CANCELLED.
EWA_API ewa_status ewa_cloud_measure_spacing(const ewa_cloud *cloud, uint64_t sample_count,
                                             ewa_spacing *spacing);

/// What is left of two solids.
typedef enum ewa_csg_operation {
    EWA_CSG_UNION = 0,
    EWA_CSG_INTERSECTION = 1,
    EWA_CSG_DIFFERENCE = 2, ///< A without B
} ewa_csg_operation;

/// How two solids are combined. Fill with ewa_csg_options_init().
typedef struct ewa_csg_options {
    size_t struct_size;
    ewa_csg_operation operation; ///< default EWA_CSG_UNION
    double cutoff; ///< F: standard deviations in a "radius" and in the support of a kernel; (0, 4]; default 3
    const char *names[2]; ///< what messages call A and B, such as their files; default NULL: "csg: operand
                          ///< A", "... B"
} ewa_csg_options;

EWA_API extern const ewa_option_table ewa_csg_options_table;
EWA_API void ewa_csg_options_init(ewa_csg_options *options, size_t struct_size);

/// Combines two closed solids of surfels into one with sharp edges where their surfaces meet.
///
/// - Each cloud has "position", and "normal" with "radius", or "tangent_u" with "tangent_v"; normals point
///   outward. Both belong to one context. Points that are no surfels (not finite or beyond 1e100,
///   no normal, no size) are left out.
/// - Inside and outside are told by the 16 nearest surfels of the other solid, as one plane or, where their
///   normals part by over 37 degrees, as two that meet in a convex or a concave edge.
/// - Surfels that the other surface cuts are split into four of 0.55 the size, up to four times, until they
///   are no coarser than its surfels; clip lines cut them where its planes meet theirs. Centres are at most
///   1.8 standard deviations beyond an edge: less than half a spacing for radii of the default scale.
/// - Clip lines of the operands are kept. Where more than two would meet in one surfel it is split; in the
///   smallest pieces the two lines that cut the most remain.
/// - Where surfaces coincide (within 0.1 of the reach, 6 degrees) A's is kept: for union and intersection if
///   the normals agree, for the difference if they are opposite.
/// - The result has A's origin, A's surfels before B's, each in Morton order; "position", "normal",
///   "tangent_u", "tangent_v", "clip0", "clip1", "clip_mode", and the other attributes (see
///   ewa_cloud_merge()). It may have no points, which is reported as a warning.
///
/// `options` may be NULL; the caller owns `*result`, NULL after a failure. The bytes do not depend on the
/// number of threads. Progress stage: "csg". Errors: EWA_ERROR_ARGUMENT (a missing attribute; an operand that
/// is not closed: its normals weighted by area sum up to over a tenth of the area, or inside and outside of
/// it meet without a surfel between), EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_CANCELLED. Based on B. Adams and
/// P. Dutre, "Interactive boolean operations on surfel-bounded solids", 2003, and M. Zwicker et al.,
/// "Perspective Accurate Splatting", 2004, section 5.
EWA_API ewa_status ewa_cloud_csg(const ewa_cloud *a, const ewa_cloud *b, const ewa_csg_options *options,
                                 ewa_cloud **result);

/// How edges and corners are found. Fill with ewa_feature_options_init().
typedef struct ewa_feature_options {
    size_t struct_size;
    uint32_t neighbour_count; ///< k, the point itself not counted: 16 to 64, or 0: 24 for exact points up to
                              ///< 64 for noisy ones; default 0
    double angle_deg; ///< smallest angle between the normals of two planes that meet in an edge; [10, 120];
                      ///< default 30
    double noise;     ///< standard deviation of the points from the surface in units of the spacing; (-inf,
                      ///< 1]; negative: measured; default -1
    double cutoff;    ///< F: axes made of "radius" are radius / F long; (0, 4]; default 3
    bool project;     ///< move the points of an edge onto their plane; default true
} ewa_feature_options;

EWA_API extern const ewa_option_table ewa_feature_options_table;
EWA_API void ewa_feature_options_init(ewa_feature_options *options, size_t struct_size);

/// What was found.
typedef struct ewa_feature_counts {
    uint64_t snapped_count; ///< points whose normal is now that of their plane
    uint64_t edge_count;    ///< of them: with one clip line
    uint64_t corner_count;  ///< of them: with two
    double noise;           ///< of the points, in units of the spacing
    uint32_t neighbour_count;
} ewa_feature_counts;

/// Finds sharp edges and corners of a sampled surface and cuts the surfels there: "clip0", "clip1",
/// "clip_mode".
///
/// - Neighbourhoods that are not flat are explained by two or three planes, and by a quadric; planes win
///   where they leave clearly less of the points. Neighbours vote: lines that half of the points along them
///   do not confirm are dropped, planes of neighbours that agree are averaged.
/// - A point beside an edge gets the normal of its own plane, is moved onto it (`project`), and gets axes of
///   the size that it had: along the line and across, longer across, because behind the line nothing adds to
///   the coverage. The line is where the planes meet; two lines, for a corner, hold both or either.
/// - All other points keep the bytes of their positions, normals and colours. "radius" becomes axes of the
///   same size, because clip lines belong to axes. Without edges the cloud stays as it was, but for older
///   clip lines.
/// - Points with coordinates that are not finite stay as they are. Positions and normals of integers become
///   floats.
///
/// The cloud needs "position", "normal", and "radius" or tangent axes (ewa_cloud_estimate()); normals have to
/// agree along the surface. `counts` may be NULL. The result does not depend on threads or instruction sets.
/// After a failure the cloud may lack the streams that were to be made. Errors: EWA_ERROR_ARGUMENT,
/// EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_CANCELLED. One thread per context. Cost: docs/features.md.
EWA_API ewa_status ewa_cloud_detect_features(ewa_cloud *cloud, const ewa_feature_options *options,
                                             ewa_feature_counts *counts);

/// What refitted colours should do.
typedef enum ewa_refit {
    EWA_REFIT_INTERPOLATE = 0, ///< the picture has each point's colour at the point
    EWA_REFIT_FIT = 1, ///< the same by least squares, damped: noise and aliases of the colours grow less
} ewa_refit;

/// How colours are refitted. Fill with ewa_refit_options_init().
typedef struct ewa_refit_options {
    size_t struct_size;
    ewa_refit goal; ///< default EWA_REFIT_INTERPOLATE
    double cutoff;  ///< F with which the cloud will be drawn; (0, 4]; default 3
} ewa_refit_options;

EWA_API extern const ewa_option_table ewa_refit_options_table;
EWA_API void ewa_refit_options_init(ewa_refit_options *options, size_t struct_size);

/// What refitting did; colours are linear.
typedef struct ewa_refit_report {
    uint64_t surfel_count;   ///< that got coefficients
    uint64_t left_out_count; ///< of them: whose colour was no equation (centre cut away by clip lines of its
                             ///< own, or over 256 kernels there)
    double before_rms, after_rms; ///< of reconstruction - colour at the points
    float low, high;              ///< smallest and largest coefficient
    uint32_t iteration_count;
} ewa_refit_report;

/// Replaces "color" by coefficients for sharper pictures of the same surfels: EWA blends kernels and divides
/// by their sum, so that with plain colours a point shows a mean of what is around it. Afterwards the
/// reconstruction sum(w r) / sum(r) is at the points what the colours were (interpolate), or nearly (fit).
///
/// "color" becomes F32, linear, beyond [0, 1] where the surface has contrast; alpha stays. Kernels take part
/// as the renderer blends them from near: inside of cutoff and clip lines, normals within 60 degrees. The
/// cloud needs "position" with "normal" and "radius", or with tangent axes, and "color". Points that are no
/// surfels keep their colour. `options` and `report` may be NULL. After a failure the cloud is unchanged. The
/// result does not depend on the number of threads. Progress stage: "refit". Needs about 450 bytes per point
/// meanwhile. Errors: EWA_ERROR_ARGUMENT (what is missing, named), EWA_ERROR_LIMIT, EWA_ERROR_MEMORY,
/// EWA_CANCELLED. The idea of optimal coefficients is that of M. Zwicker et al., "Surface splatting", 2001,
/// section 5; docs/colors.md has figures.
EWA_API ewa_status ewa_cloud_refit_colors(ewa_cloud *cloud, const ewa_refit_options *options,
                                          ewa_refit_report *report);

/// Test objects, centred at the origin. Plane, checker, terrain and town lie in x-y, z up.
typedef enum ewa_object {
    EWA_OBJECT_PLANE = 0,   ///< light grey square
    EWA_OBJECT_CHECKER = 1, ///< black and white square
    EWA_OBJECT_CUBE,        ///< checks of two colours on each face
    EWA_OBJECT_SPHERE,      ///< banded like a planet, poles on the z axis
    EWA_OBJECT_TORUS,       ///< about the z axis, tube radius 1/7 of the outer diameter, winding ribbons
    EWA_OBJECT_TERRAIN,     ///< fractal heights: water (z = 0), sand, grass, rock, snow
    EWA_OBJECT_CSG,         ///< block of 1 x 0.7 x 0.4 edges with a slot, a notch and two round holes
    EWA_OBJECT_TOWN,        ///< 160 boxes with windows, 1,400 trees of loose leaves, streets and lawns
} ewa_object;

/// What to generate. Fill with ewa_generate_options_init().
typedef struct ewa_generate_options {
    size_t struct_size;
    ewa_object object;
    uint64_t point_count; ///< exactly so many points (with rows on edges: at most); default 100000
    uint64_t seed;        ///< same seed, same bytes, on every machine; default 1
    double size_world;    ///< edge of plane, cube, terrain, town; diameter of sphere; outer diameter of torus;
                          ///< [1e-25, 1e25]; default 2
    double jitter; ///< 0: points in the middle of their cells, 1: anywhere in them; [0, 1]; default 0.5
    double checks; ///< squares along one edge of the checker plane and of the cube's faces; [1e-6, 1e6];
                   ///< default 16
    double radius_scale; ///< support radius in units of the local spacing; [1e-6, 1e6], or 0 (default): so
                         ///< that pixels inside are opaque: 1.14 (1 + 0.8 jitter), for rows 1.14. Discs
                         ///< touch everywhere from 0.72 (1 + jitter) on
    bool positions_only; ///< leave out normals and radii; default false
    bool sharp; ///< cube and part: rows of points on every edge, and axes and clip lines in place of radii;
                ///< default false
    bool texcoords; ///< add "texcoord", "texcoord_s", "texcoord_t" (ewa/acquire.h); default false
} ewa_generate_options;

EWA_API extern const ewa_option_table ewa_generate_options_table;
EWA_API void ewa_generate_options_init(ewa_generate_options *options, size_t struct_size);

/// Makes a test object: "position" F32 3, "normal" F32 3 (unit, outward), "color" U8 3 (sRGB), "radius"
/// F32 1. One point lies in each of `point_count` cells of equal area (terrain: of equal ground), about as
/// wide as high, that fill the surface to its edge; the spacing is the square root of a cell's area (terrain:
/// longer on slopes). A town's trees have about one point per cell of their crowns' surface, somewhere in the outer half
/// of the crown, with a normal of its own; one point in 50 of its ground stands a little above it.
///
/// The part, and the cube when `sharp`, have rows of points on every edge instead, and the most points that
/// fit in `point_count`. When `sharp`, "tangent_u", "tangent_v" (radius_scale / 3 of a cell long), "clip0",
/// "clip1", "clip_mode" take the place of "radius": every kernel that reaches an edge is cut there; beside
/// round holes centres lie up to 3/8 of a cell beyond the edge. The rows are regular: seed and jitter change
/// nothing.
///
/// Texture coordinates: plane, checker, terrain and town lie upon the picture, cube and part have it on every face
/// (by the largest component of the normal), the sphere has longitude and latitude, the torus the turns
/// around the ring and around the tube.
///
/// `options` may be NULL for the defaults; the caller owns `*cloud`, which is NULL after a failure. Every
/// number depends on the options alone, not on the machine or the number of threads. Progress stage:
/// "generate". Errors: EWA_ERROR_ARGUMENT (message names the member; too few points for rows on every edge),
/// EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_CANCELLED.
EWA_API ewa_status ewa_cloud_generate(ewa_context *context, const ewa_generate_options *options,
                                      ewa_cloud **cloud);

/// Volumes whose line integrals are known; s is size_world, r the distance from the middle.
typedef enum ewa_volume_object {
    /// U8: a box of 3/4 s of solid cubes, 96 and 255 in turns, empty around; `checks` along its edge
    EWA_VOLUME_CHECKERBOX = 0,
    /// F32: exp(-r^2 / (2 q^2)), q = s / 10. A line at distance d from the middle:
    /// q sqrt(2 pi) exp(-d^2 / (2 q^2))
    EWA_VOLUME_BLOB = 1,
    /// F32: (1 - r^2 / R^2)^2 within R = 0.4 s. A line at distance d < R: 16/15 (R^2 - d^2)^(5/2) / R^4
    EWA_VOLUME_BALL = 2,
    /// U8: a tree of thin tubes of radii from s / 40 down to s / 250, 255 in their middles; those thinner than
    /// 0.9 voxels are that wide and as much fainter
    EWA_VOLUME_VESSELS = 3,
} ewa_volume_object;

/// What volume is made. Fill with ewa_volume_generate_options_init().
typedef struct ewa_volume_generate_options {
    size_t struct_size;
    ewa_volume_object object;
    uint32_t dims[3];  ///< default 128, 128, 128; each >= 2
    double size_world; ///< distance of the outermost voxels along the longest axis; cubes; (0, inf);
                       ///< default 1
    double checks;     ///< of EWA_VOLUME_CHECKERBOX; (0, 1e6]; default 8
    uint64_t seed;     ///< of EWA_VOLUME_VESSELS; default 0
} ewa_volume_generate_options;

EWA_API extern const ewa_option_table ewa_volume_generate_options_table;
EWA_API void ewa_volume_generate_options_init(ewa_volume_generate_options *options, size_t struct_size);

/// Makes a test volume with its middle at the origin, the same bytes on every machine; s is along the longest
/// axis, shorter ones cut. The caller frees it. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_LIMIT,
/// EWA_ERROR_MEMORY, EWA_CANCELLED.
EWA_API ewa_status ewa_volume_generate(ewa_context *context, const ewa_volume_generate_options *options,
                                       ewa_volume *volume);

/// Makes a cloud of what a camera has to have in its picture of a volume: the corners of at most 4096 boxes
/// around the voxels that a transfer function lets see, `reach_steps` ([0, 1000]) steps of the grid wider on
/// all sides; a voxel's kernel reaches sigma times cutoff of ewa_volume_options. Voxels count as seen when a
/// line of sight through all of the volume would show them if it were of nothing else; single ones and pairs
/// are noise and do not count, unless there are no others. The caller owns `*cloud`, which has positions only
/// (F64) and no point when nothing can be seen. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_volume_outline(const ewa_volume *volume, const ewa_transfer *transfer,
                                      double reach_steps, ewa_cloud **cloud);

#ifdef __cplusplus
}
#endif
#endif
