// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures in tests: every plane of a frame, and the comparison of a picture with the reference's.
#ifndef EWA_TESTS_SPLAT_PICTURE_H
#define EWA_TESTS_SPLAT_PICTURE_H

#include "check.h"
#include "scenes/scene.h"

/// A frame with all of its planes.
typedef struct picture {
    uint32_t width_px, height_px;
    ewa_frame frame;
} picture;

/// Sets one white light from a direction.
void picture_set_light(ewa_render_options *options, double x, double y, double z);

picture picture_make(uint32_t width_px, uint32_t height_px);
void picture_free(picture *made);

/// The reference's picture of a scene; options may be NULL; fails the test on errors.
picture picture_of_scene(const scene *of, const ewa_surfels_options *surfels_options,
                         const ewa_render_options *options);

enum { PICTURE_SIDE_PX = 160, PICTURE_SMALL_PX = 96 };

/// A small scene for the plain pipeline, of few points.
scene picture_small_scene(ewa_context *context, scene_kind kind);

/// A scene of that size whose q0 is the one that the surfels measure.
scene picture_measured_scene(ewa_context *context, scene_kind kind, uint64_t points,
                             const ewa_surfels_options *options);

/// The fast pipeline's picture of a cloud; fails the test on errors.
picture picture_draw(ewa_context *context, const ewa_cloud *cloud, const ewa_camera *camera,
                     const ewa_surfels_options *surfels_options, const ewa_render_options *options);

/// Pixels where a tiny difference of arithmetic may change which surfels take part.
enum {
    PICTURE_ON_CUTOFF = 1, ///< some visible surfel's r^2 is within a band of F^2
    PICTURE_ON_BOUND = 2,  ///< some surfel's depth is within a band of B(x) (one pass: two nearest within it)
};

/// Marks them: `mask` has width * height bytes. A surfel is on the cutoff when |r^2 - F^2| < support_band F^2
/// and it is not hidden, on the bound when |z - B| < depth_band z.
void picture_mark_edges(const scene *of, const ewa_surfels_options *surfels_options,
                        const ewa_render_options *options, double support_band, double depth_band,
                        uint8_t *mask);

/// Gives two thirds of the points of a cloud with tangent axes one or two clip lines.
void picture_add_clips(ewa_cloud *cloud);

/// How far a picture is from the reference. Errors: colour absolute (premultiplied linear), depth relative to
/// z (and to no less than a hundredth of the picture's deepest), coverage in units of q0, relative where it
/// is above 1 (the sum of many kernels has their relative error); the largest of the pixel's.
typedef struct picture_report {
    uint64_t pixel_count;
    uint64_t over_count;                   ///< pixels beyond the threshold, edges included
    uint64_t edge_over_count;              ///< of these on an edge by the mask
    uint64_t edge_count;                   ///< pixels of the mask
    double color, depth, coverage, normal; ///< largest errors away from edges
    uint32_t worst_px[2];                  ///< where the largest of the first three is
} picture_report;

/// Compares all planes; `mask` (may be NULL) is that of picture_mark_edges(). The depths and normals of
/// pixels whose coverage is below `threshold` in both are not compared; normals never count as beyond.
picture_report picture_compare(const picture *reference, const picture *other, double threshold,
                               const uint8_t *mask);

/// Fails the test where two pictures of one size differ in a byte of a plane.
void picture_expect_same(const picture *a, const picture *b);

/// Sets an orthographic camera that frames the cloud.
void picture_set_orthographic(scene *of);

/// Prints the report in one line.
void picture_print(const char *name, const picture_report *report);

/// Holds the fast pipeline to the reference on a scene of picture_measured_scene(): at most one pixel in 200
/// is off by over 2e-3, for cutoffs and ties. `what` says what is special; with `orthographic` the camera is
/// set anew.
void picture_hold(scene *of, const ewa_render_options *options, bool orthographic, const char *what);

#endif
