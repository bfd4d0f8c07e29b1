// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A checkerboard to the horizon with its ray-traced truth, for measuring what a reconstruction loses and what
// it aliases.
//
// 250,000 surfels, one per cell of a 500 x 500 grid on a square of edge 2, jittered; 100 x 100 black and
// white squares. The eye is 0.1 above the middle of the near edge and looks horizontally, 60 degrees high,
// 512 x 512 pixels: squares are 5 surfels wide, 190 pixels high at the lower edge of the picture and less
// than one at the far edge of the plane.
#ifndef EWA_TESTS_QUALITY_CHECKER_SCENE_H
#define EWA_TESTS_QUALITY_CHECKER_SCENE_H

#include "defaults.h"
#include "owned.h"
#include "ewa/ewa.h"

enum { CHECKER_SIDE = 512, CHECKER_BANDS = 3, CHECKER_POINTS = 250000 };

/// The truth, linear grey in [0, 1], under two pixel filters.
typedef struct checker_truth {
    ewa_camera camera;
    /// Of each row: 0 where squares are less than 2 pixels high, 1 below 8, 2 above; -1 above the horizon.
    int band[CHECKER_SIDE];
    bool counts[CHECKER_SIDE][CHECKER_SIDE];  ///< pixels whose filters see the plane only
    double box[CHECKER_SIDE][CHECKER_SIDE];   ///< mean over the pixel's square
    double gauss[CHECKER_SIDE][CHECKER_SIDE]; ///< Gaussian of half a pixel's standard deviation
} checker_truth;

/// How the board is reconstructed.
typedef struct checker_setting {
    ewa_kernel kernel;
    double cutoff;       ///< F
    double prefilter_px; ///< h
    double sigma;        ///< standard deviation of the kernels in units of the spacing
    double jitter;       ///< 0.4 is the board of the documented tables
    bool one_pass;       ///< the nearest splat wins
} checker_setting;

/// What came out, by bands: far, middle, near.
typedef struct checker_errors {
    double box_percent[CHECKER_BANDS];   ///< RMSE in % of the contrast, edge antialiasing off
    double gauss_percent[CHECKER_BANDS]; ///< the same against the Gaussian truth
    double box_psnr_db, gauss_psnr_db;   ///< all bands, peak 1
    uint64_t pixel_count, hole_count;    ///< all bands: pixels compared, pixels that no surfel reached
    double translucent_percent;          ///< pixels with alpha < 0.999 when edge antialiasing is on
    double lowest_alpha;                 ///< with edge antialiasing on
} checker_errors;

/// Traces the truth: rows are cut into 32 lines each, the board is integrated along them exactly. `zoom`
/// multiplies the focal length; 1 is the picture that is described above.
void checker_trace(ewa_context *context, double zoom, checker_truth *truth);

/// Makes the board's surfels; the caller destroys them. Errors are those of the library.
ewa_status checker_make(ewa_context *context, const checker_setting *setting, ewa_surfels **surfels);

/// From what else than surfels with radii the board is made, all by defaults, and whether its colours are refitted.
typedef enum checker_source { CHECKER_OF_POINTS, CHECKER_OF_POINTS_REFITTED, CHECKER_OF_MESH } checker_source;

/// Makes the board's surfels of its points and colours alone, a jitter of 0.4, or of as many points on a textured mesh,
/// drawn with `radius_scale` times their radii. The caller destroys them. Errors are those of the library.
ewa_status checker_make_from(ewa_context *context, checker_source source, double radius_scale, ewa_surfels **surfels);

/// The options that a setting asks for, without light and without edge antialiasing.
ewa_render_options checker_options(const checker_setting *setting);

/// Draws the board with ewa_render() and compares. Errors are those of the library.
ewa_status checker_compare(ewa_context *context, const checker_truth *truth, const ewa_render_options *options,
                           const ewa_surfels *surfels, checker_errors *errors);

/// The same of what checker_make() makes.
ewa_status checker_measure(ewa_context *context, const checker_truth *truth, const checker_setting *setting,
                           checker_errors *errors);

#endif
