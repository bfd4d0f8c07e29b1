// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Photographs onto points, in parts: what points show at the pixels of a photograph, what photographs say of each
// point, their exposures, and the colours that fit best.
#ifndef EWA_SRC_PHOTOS_PARTS_H
#define EWA_SRC_PHOTOS_PARTS_H

#include "base/base.h"
#include "ewa/photos.h"
#include "ewa/render.h"
#include "surface/gather.h"

enum {
    EWA_PHOTO_CHANNELS = 3,
    EWA_PHOTO_PIECE = 4096, ///< pixels or points per piece of parallel work
    EWA_PHOTO_MAX = 65535,  ///< photographs
    EWA_VIGNETTING_SUMS = 5,
};

typedef struct ewa_photos_job ewa_photos_job;

/// A pixel of a photograph.
typedef struct ewa_photo_pixel {
    float color[EWA_PHOTO_CHANNELS]; ///< linear light
    float weight; ///< that it has for what it is: of a clipped one less; 0: the photograph says nothing there
} ewa_photo_pixel;

/// A photograph before the points: what it shows, and the matrix A, which takes colours of points to its pixels. A row of A
/// has the parts of the pixel's colour that the renderer gives the surfels of its nearest surface, with the sum 1; pixels
/// that no surface fills have none.
typedef struct ewa_photo_view {
    ewa_context *context;
    const ewa_surfels *surfels;
    ewa_gather_room *room; ///< of all views, which take turns
    ewa_camera camera; ///< of the photograph as it is looked at
    double cutoff;
    uint32_t point_count, pixel_count; ///< of the points; of all the picture
    ewa_photo_pixel *pixels;
} ewa_photo_view;

void ewa_photo_view_free(ewa_photo_view *view);

/// Sets what points show at the pixels of a view, [pixel_count][4]: A colors and 1, or zeros where A has no row. Errors:
/// EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_photo_view_show(const ewa_photo_view *view, const double *colors, float *shown);

/// Adds A' rgba to sums, [point_count][3], of [pixel_count][4] numbers of which the last have no say. Errors: the same.
ewa_status ewa_photo_view_gather(const ewa_photo_view *view, const float *rgba, double *sums);

/// Adds A' diag(weights) A colors to sums, [point_count][3], or, where `colors` is NULL, the diagonal of
/// A' diag(weights) A, thrice. `view` need have no pixels. Errors: the same.
ewa_status ewa_photo_view_normal(const ewa_photo_view *view, const float *weights, const double *colors, double *sums);

/// What one photograph says of a point.
typedef struct ewa_photo_sample {
    uint32_t point;
    float weight; ///< pixels
    float color[EWA_PHOTO_CHANNELS]; ///< as the lens has left it
    float radius2;                   ///< where it shows the point
} ewa_photo_sample;

/// A photograph in the works.
typedef struct ewa_photo_state {
    const ewa_photo *photo;
    uint32_t number, halvings;
    bool held_out;
    double world_to_camera[16]; ///< as poses are refined
    ewa_photo_sample *samples;
    uint32_t sample_count, telling_count; ///< the first so many tell the exposure
    double gain[EWA_PHOTO_CHANNELS], offset[EWA_PHOTO_CHANNELS];
    ewa_photo_report report;
    ewa_photo_view fitted; ///< in a round of the fit, without pixels
    float *fit_weights;    ///< of its pixels; NULL: nothing of it is fitted
} ewa_photo_state;

/// Reads a photograph and halves it as often as points stay `spacing_px` apart, or as often as it was before. Errors: those of
/// ewa_cloud_color_from_photos().
ewa_status ewa_photo_view_make(const ewa_photos_job *job, ewa_photo_state *photo, ewa_photo_view *view);

/// Whether the exposure of a photograph is found here: it is used, and sees enough points; others have the one that they
/// come with.
static inline bool ewa_photo_is_exposed(const ewa_photo_state *photo) {
    enum { MIN_POINTS = 8 };
    return !photo->held_out && photo->sample_count >= MIN_POINTS;
}

/// All of a call.
struct ewa_photos_job {
    ewa_context *context;
    ewa_cloud *cloud;
    ewa_surfels *surfels;
    ewa_gather_room *room;
    ewa_photos_options options;
    uint32_t point_count, photo_count;
    ewa_photo_state *photos; ///< in an order of their cameras
    double vignetting[2];     ///< of all photographs, whose pixels are divided by it
    double *color;            ///< [point][EWA_PHOTO_CHANNELS]
    uint16_t *counts;         ///< [point]
    uint64_t *sample_starts;  ///< [point + 1]
    const ewa_photo_sample **samples; ///< by point, in the order of the photographs
    uint16_t *sample_photos;          ///< the photograph of each
};

/// Takes the picture of a photograph, or reads it; what is transparent in it lies over `background` (ewa_photo_load()).
/// `*owned`: it is to be freed.
ewa_status ewa_photo_take(ewa_context *context, const ewa_photo *photo, uint32_t number, const float background[3],
                          ewa_image *image, bool *owned);

/// Pairs of numbers that an exposure is fitted to: photograph = gain * colour + offset.
typedef struct ewa_exposure_pairs {
    uint32_t count;
    uint32_t step; ///< every so many-th is looked at
    const void *user;
    /// Gives pair `i`: what the photograph shows, what the points show, the weight.
    void (*get)(const void *user, uint32_t i, double shown[EWA_PHOTO_CHANNELS], double color[EWA_PHOTO_CHANNELS],
                double *weight);
} ewa_exposure_pairs;

/// The step with which so many pairs, or points, tell an exposure as well as all: odd, so that no column of a picture is left
/// out.
static inline uint32_t ewa_exposure_stride(uint32_t count) {
    enum { ENOUGH = 1 << 16 };
    return count / ENOUGH | 1;
}

/// Improves the gains and offsets of a photograph by one step of weighted least squares; `scale`: the difference at which
/// a pair counts a quarter, 0: all count.
void ewa_exposure_step(const ewa_exposure_pairs *pairs, ewa_photos_exposure kind, double scale,
                       double gain[EWA_PHOTO_CHANNELS], double offset[EWA_PHOTO_CHANNELS]);

/// A photograph beside what the points show.
typedef struct ewa_photo_match {
    const ewa_photos_job *job;
    ewa_photo_view *view;
    ewa_photo_state *photo;
    float *shown; ///< [pixel][4]: A c and 1, or zeros
} ewa_photo_match;

/// Shows the points, and finds the photograph's exposure by `steps` steps, the first `wide_steps` with robust weights of
/// larger scales, then the pose by so many, each with another of the exposure. Errors: EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_photo_match_refine(const ewa_photo_match *match, int steps, int wide_steps, uint32_t pose_steps);

/// Gives what the photograph shows at a pixel, what the points show, and the weight.
void ewa_photo_match_get(const void *match, uint32_t i, double shown[EWA_PHOTO_CHANNELS], double color[EWA_PHOTO_CHANNELS],
                         double *weight);

/// Square of a place's distance from the middle of the picture, 1 in the corners.
double ewa_photo_radius2(const ewa_camera *camera, double x_px, double y_px);

/// What part of the light a lens leaves at such a place: 1 + a r^2 + b r^4.
double ewa_photo_vignette(const double vignetting[2], double radius2);

/// Adds what a colour says of a and b: the lens leaves `shown` of what is wanted.
void ewa_vignetting_add(const double shown[EWA_PHOTO_CHANNELS], const double wanted[EWA_PHOTO_CHANNELS], double radius2,
                        double weight, double sums[EWA_VIGNETTING_SUMS]);

/// Sets a and b by all that photographs say; where that is next to nothing, they stay.
void ewa_vignetting_solve(const double sums[EWA_VIGNETTING_SUMS], double vignetting[2]);

/// Errors count relative to this and the colour, as they do where numbers are sRGB.
#define EWA_PHOTO_MIN_COLOR 0.02

/// What a pair of linear colours counts, of Geman and McClure. sRGB's curve is taken for a square root here.
double ewa_robust_weight(const double shown[EWA_PHOTO_CHANNELS], const double wanted[EWA_PHOTO_CHANNELS], double scale);

/// Makes the mean of the exposed photographs' log gains 0 and that of their offsets, and changes colours with them; each
/// array of `count` colours.
void ewa_exposures_centre(ewa_photos_job *job, double *const *colors, uint32_t array_count);

/// Finds exposures and the colours of a method but the fit, by what photographs say of points. Progress goes from `begin`
/// to `end`.
ewa_status ewa_photos_alternate(ewa_photos_job *job, double begin, double end);

/// Sets the colours of points by their samples, corrected by exposures. `method` is not the fit. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_photos_combine(ewa_photos_job *job, ewa_photos_method method);

/// Improves the colours: rounds of weights, exposures and conjugate gradients. Progress goes from `begin` to `end`.
ewa_status ewa_photos_fit(ewa_photos_job *job, double begin, double end);

#endif
