// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours of points from photographs whose cameras are known.
#ifndef EWA_PHOTOS_H
#define EWA_PHOTOS_H

#include "ewa/cloud.h"
#include "ewa/io.h"
#include "ewa/options.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Attributes that ewa_cloud_color_from_photos() adds: U16, how many photographs see the point; F32, how far its
/// pixels are from theirs, rms of sRGB numbers in [0, 1], 0 where none does.
#define EWA_PHOTO_COUNT    "photo_count"
#define EWA_PHOTO_RESIDUAL "photo_residual"

/// Makes the picture of a pinhole of one that a lens has taken: the elliptical Gaussian of each pixel, seen through the
/// lens, as in ewa_texture_map(). `camera`: its size is the picture's. `pinhole` becomes RGBA, premultiplied, transparent where the lens
/// shows nothing; the caller frees it. Errors: EWA_ERROR_ARGUMENT (sizes that differ, other than 1, 3 or 4 channels,
/// numbers of the lens that are not finite), EWA_ERROR_MEMORY, EWA_CANCELLED. Progress stage: "undistort".
/// Based on: P. Heckbert, "Fundamentals of Texture Mapping and Image Warping", 1989 (the filter).
EWA_API ewa_status ewa_image_undistort(const ewa_image *image, const ewa_camera *camera, const ewa_lens *lens,
                                       ewa_image *pinhole);

/// Makes the picture that the pinhole of a photograph's camera took: read where the photograph has none at hand; what is
/// transparent in it lies over `background`, sRGB numbers, as where Gaussians are trained (NULL: stays as it is); what its mask
/// has black is transparent; then undistorted. `image` gets 1, 3 or 4 channels, linear light, premultiplied, transparent where a lens shows nothing; the
/// caller frees it. Errors (image empty): EWA_ERROR_ARGUMENT (another size than its camera's, neither path nor image, other
/// channels), those of ewa_image_load() and ewa_image_undistort().
EWA_API ewa_status ewa_photo_load(ewa_context *context, const ewa_photo *photo, const float background[3],
                                  ewa_image *image);

/// How near a picture is to the true one.
typedef struct ewa_image_quality {
    uint64_t pixel_count;      ///< that are compared
    double mean_squared_error; ///< of sRGB numbers in [0, 1]
    double psnr_db;            ///< -10 log10 of that; infinite where nothing differs, NaN where nothing is compared
    double ssim;               ///< structural similarity, at most 1: mean over pixels and channels; NaN where nothing is compared
} ewa_image_quality;

/// Compares two pictures of one size in sRGB numbers, clamped to [0, 1]. `image`, `reference`: 1, 3 or 4 channels, linear light,
/// premultiplied; pixels where `reference` is not opaque or not finite are not compared. SSIM has a window of 11 x 11 pixels, a
/// Gaussian of 1.5, beyond whose picture there are zeros, and the constants 0.01 and 0.03, as 3DGS reports it. The same numbers
/// for every number of threads. Progress stage: "compare". Errors: EWA_ERROR_ARGUMENT (sizes or channels), EWA_ERROR_MEMORY,
/// EWA_CANCELLED.
/// Source: Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment", 2004, equation 13.
EWA_API ewa_status ewa_image_compare(const ewa_image *image, const ewa_image *reference, ewa_image_quality *quality);

typedef enum ewa_photos_method {
    EWA_PHOTOS_FIT = 0,    ///< colours whose pictures differ least from the photographs
    EWA_PHOTOS_MEDIAN = 1, ///< weighted median over the photographs that see a point
    EWA_PHOTOS_MEAN = 2,   ///< weighted mean over them
    EWA_PHOTOS_BEST = 3,   ///< of the one that sees it largest
} ewa_photos_method;

typedef enum ewa_photos_exposure {
    EWA_EXPOSURE_GAIN = 0,        ///< of each channel of each photograph
    EWA_EXPOSURE_GAIN_OFFSET = 1, ///< the same with an offset: of haze and stray light; blur looks like these
    EWA_EXPOSURE_OFF = 2, ///< as the photographs are
} ewa_photos_exposure;

/// How photographs become colours. Fill with ewa_photos_options_init().
typedef struct ewa_photos_options {
    size_t struct_size;
    ewa_photos_method method;     ///< default EWA_PHOTOS_FIT
    ewa_photos_exposure exposure; ///< default EWA_EXPOSURE_GAIN
    /// Photographs 0, N, 2N, ... are not used and compared with the result; 0 (default): all are used
    uint32_t hold_out;
    uint32_t rounds;   ///< of the fit: weights of pixels and exposures are found anew in each; [1, 20]; default 3
    double robust;     ///< difference of sRGB numbers at which a pixel counts a quarter; 0: all count; [0, 1]; default 0.05
    double ridge;      ///< of the fit: pull towards the median, of the median point's own weight; (0, 10]; default 0.1
    double spacing_px; ///< photographs are halved while points stay so far apart; 0: never; [0, 100]; default 2
    double cutoff;     ///< F: a "radius" is so many standard deviations; (0, 4]; default 3
    /// With the method fit: steps by which the pose of each photograph is refined in each round, and as many in all of those that are held
    /// out; [0, 20]; 0 (default): poses are taken as they are; not with other methods
    uint32_t pose_steps;
    bool vignetting; ///< how much darker photographs are towards their corners is found, if one lens has taken them; default false
} ewa_photos_options;

EWA_API extern const ewa_option_table ewa_photos_options_table;
EWA_API void ewa_photos_options_init(ewa_photos_options *options, size_t struct_size);

/// What one photograph came to.
typedef struct ewa_photo_report {
    bool held_out;
    uint32_t width_px, height_px; ///< as it was looked at, after halving
    uint64_t pixel_count; ///< that a surface fills; 0: it sees none of the points
    uint64_t point_count; ///< that it sees
    double gain[3], offset[3]; ///< it shows gain * colour + offset, linear light
    double rms;      ///< difference from the points' picture, sRGB numbers in [0, 1]
    double rejected; ///< share of its pixels that count less than a quarter
    double psnr_db;  ///< the same as rms; infinite where nothing differs, NaN where it sees none of the points
    double world_to_camera[16]; ///< the pose, as pose steps have refined it
    double shift_px; ///< how far these have moved what is seen, in pixels after halving: root of the mean square
} ewa_photo_report;

/// What was done.
typedef struct ewa_photos_report {
    uint32_t used_count, held_out_count; ///< photographs
    uint64_t seen_count;                 ///< points that some photograph sees; the others keep their colours
    double rms, held_out_rms;            ///< over all pixels of those that were used, of those that were not
    double psnr_db, held_out_psnr_db;    ///< NaN: there are none
    double vignetting[2];                ///< a, b: 1 + a r^2 + b r^4 is left of the light, r being 1 in the corners
    float low, high;                     ///< smallest and largest number of the colours that are new
} ewa_photos_report;

/// Gives surfels the colours that photographs show: "color" F32, linear light, 3 components, or 4 where there were 4. A
/// pixel is the weighted mean of the surfels of its nearest surface, with the weights that ewa_render() has
/// (docs/math.md section 15: what it changes by their colours); pixels that a surface does not fill do not count, nor
/// those of photographs that are not opaque, and those at either end of the range count a tenth. Exposures are found from what
/// the photographs say of the same points, the mean of the logarithms of their gains being 0. The fit minimises
///
///     sum over photographs and pixels  w |A c - (photo - offset)/gain|^2 + ridge |c - median|^2
///
/// by conjugate gradients, with w the robust weights of Geman and McClure; poses follow the gradient of the pictures
/// meanwhile (docs/photos.md). Colours may leave [0, 1]; nothing but output
/// clamps them. Photographs of lenses are undistorted. One photograph is in memory at a time. The order of the photographs
/// counts where some are held out, and of those with the same camera; else it does not, nor does the number of threads.
///
/// `cloud`: "position" and what surfels need (see ewa_surfels_create()). `per_photo`: `count` reports; it, `options` and
/// `report` may be NULL. Progress stages, whose
/// shares go on from one to the next: "photos: samples", "photos: exposures", "photos: fit", "photos: comparison". After a failure the colours are as they were; "photo_count" and
/// "photo_residual" of an earlier call may be gone. Errors: EWA_ERROR_ARGUMENT (options;
/// no photographs; a photograph of another size than its camera, with neither path nor image, of other than 1, 3 or 4
/// channels; none that sees a point), those of ewa_image_load(), EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_CANCELLED. A
/// warning names a photograph that sees no point.
/// Based on: S. Geman, D. McClure, "Statistical Methods for Tomographic Image Reconstruction", 1987 (weights).
EWA_API ewa_status ewa_cloud_color_from_photos(ewa_cloud *cloud, const ewa_photo *photos, uint32_t count,
                                               const ewa_photos_options *options, ewa_photos_report *report,
                                               ewa_photo_report *per_photo);

#ifdef __cplusplus
}
#endif
#endif
