// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Photographs of lenses as pinholes would have taken them: the Gaussian of a pixel, seen through the lens, is an ellipse
// on the photograph, whose mean is taken.
//
// Based on: P. Heckbert, "Fundamentals of Texture Mapping and Image Warping", 1989 (elliptical weighted averages).
#include "base/base.h"
#include "ewa/photos.h"
#include "image/texture.h"
#include "math/angle.h"

#include <math.h>

/// Standard deviations of a pixel of the new picture and of the photograph, in pixels of each: those of texture.h's maps.
static const double PIXEL_SIGMA_PX = 0.3, PHOTO_SIGMA_PX = 0.4;
/// Slopes are looked at up to this one, in so many steps: where a lens turns back, it shows nothing beyond.
static const double MAX_SLOPE = 20;

enum { REACH_STEPS = 4000 };

typedef struct undistort_job {
    const ewa_camera *camera;
    const ewa_lens *lens;
    double reach; ///< largest slope that the lens shows
    ewa_texture texture;
    ewa_image *to;
} undistort_job;

/// How far from the middle a lens shows the slope `r`, without what is tangential.
static double radius_of(const ewa_lens *lens, double r) {
    const double *k = lens->radial;
    if (lens->model == EWA_LENS_FISHEYE) {
        const double a = ewa_atan(r), a2 = a * a;
        return a * (1 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3]))));
    }
    const double r2 = r * r;
    return r * (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[2]))) / (1 + r2 * (k[3] + r2 * (k[4] + r2 * k[5])));
}

static double reach_of(const ewa_lens *lens) {
    double last = 0;
    for (int i = 1; i <= REACH_STEPS; i++) {
        const double shown = radius_of(lens, MAX_SLOPE * i / REACH_STEPS);
        if (!(shown > last)) return MAX_SLOPE * (i - 1) / REACH_STEPS;
        last = shown;
    }
    return MAX_SLOPE;
}

/// Where the lens shows what the pinhole shows at a place, pixels. False beyond its reach.
static bool distort(const undistort_job *job, double x_px, double y_px, double shown_px[2]) {
    const ewa_camera *camera = job->camera;
    const double x = (x_px - camera->cx_px) / camera->fx_px, y = (y_px - camera->cy_px) / camera->fy_px;
    const double r2 = x * x + y * y, r = sqrt(r2), *p = job->lens->tangential;
    if (r > job->reach) return false;
    const double f = r > 1e-9 ? radius_of(job->lens, r) / r : 1;
    double shown[2] = {x * f, y * f};
    if (job->lens->model == EWA_LENS_BROWN) {
        shown[0] += 2 * p[0] * x * y + p[1] * (r2 + 2 * x * x);
        shown[1] += 2 * p[1] * x * y + p[0] * (r2 + 2 * y * y);
    }
    shown_px[0] = camera->fx_px * shown[0] + camera->cx_px, shown_px[1] = camera->fy_px * shown[1] + camera->cy_px;
    return true;
}

/// Sets the ellipse of a pixel on the photograph; false where the lens does not show all of it.
static bool find_gauss(const undistort_job *job, double x_px, double y_px, ewa_texture_gauss *gauss) {
    double middle[2], ends[4][2];
    if (!distort(job, x_px, y_px, middle) || !distort(job, x_px + 0.5, y_px, ends[0]) ||
        !distort(job, x_px - 0.5, y_px, ends[1]) || !distort(job, x_px, y_px + 0.5, ends[2]) ||
        !distort(job, x_px, y_px - 0.5, ends[3]))
        return false;
    if (!(middle[0] >= 0 && middle[0] <= job->camera->width_px && middle[1] >= 0 && middle[1] <= job->camera->height_px))
        return false;
    const double u[2] = {ends[0][0] - ends[1][0], ends[0][1] - ends[1][1]};
    const double v[2] = {ends[2][0] - ends[3][0], ends[2][1] - ends[3][1]};
    const double own = PHOTO_SIGMA_PX * PHOTO_SIGMA_PX, pixel = PIXEL_SIGMA_PX * PIXEL_SIGMA_PX;
    *gauss = (ewa_texture_gauss){middle[0],
                                 middle[1],
                                 own + pixel * (u[0] * u[0] + v[0] * v[0]),
                                 pixel * (u[0] * u[1] + v[0] * v[1]),
                                 own + pixel * (u[1] * u[1] + v[1] * v[1])};
    return true;
}

static void undistort_row(void *data, uint32_t y, uint32_t worker) {
    (void)worker;
    const undistort_job *job = data;
    const uint32_t width = job->to->width_px;
    float *to = job->to->pixels + (size_t)y * width * 4;
    for (uint32_t x = 0; x < width; x++, to += 4) {
        ewa_texture_gauss gauss;
        double color[4];
        if (!find_gauss(job, x + 0.5, y + 0.5, &gauss)) continue; // transparent, as it is made
        ewa_texture_round(&gauss);
        ewa_texture_mean(&job->texture, ewa_texture_level_of(&job->texture, &gauss), &gauss, color);
        for (int c = 0; c < 4; c++) to[c] = (float)color[c];
        if (job->texture.opaque) to[3] = 1;
    }
}

static ewa_status check(const ewa_image *image, const ewa_camera *camera, const ewa_lens *lens) {
    ewa_context *context = image->context;
    EWA_TRY(ewa_camera_check(context, camera));
    if (!image->pixels || image->width_px != camera->width_px || image->height_px != camera->height_px)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "undistort: the picture is of %u x %u pixels, its camera of %u x %u",
                        image->width_px, image->height_px, camera->width_px, camera->height_px);
    for (int i = 0; i < 8; i++) {
        const double number = i < 6 ? lens->radial[i] : lens->tangential[i - 6];
        if (!isfinite(number))
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "undistort: %c%d of the lens is %g", i < 6 ? 'k' : 'p',
                            i < 6 ? i + 1 : i - 5, number);
    }
    if ((unsigned)lens->model > EWA_LENS_FISHEYE)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "undistort: model is %d, which there is not", (int)lens->model);
    return EWA_OK;
}

ewa_status ewa_image_undistort(const ewa_image *image, const ewa_camera *camera, const ewa_lens *lens, ewa_image *pinhole) {
    if (pinhole) *pinhole = (ewa_image){.context = NULL};
    if (!image || !camera || !lens || !pinhole) return EWA_ERROR_ARGUMENT;
    EWA_TRY(check(image, camera, lens));
    undistort_job job = {.camera = camera, .lens = lens, .reach = reach_of(lens), .to = pinhole};
    ewa_status status = ewa_texture_make(image, EWA_TEXTURE_CLAMP, EWA_TEXTURE_CLAMP, &job.texture);
    if (status == EWA_OK) status = ewa_image_create(image->context, camera->width_px, camera->height_px, 4, pinhole);
    if (status == EWA_OK)
        status = ewa_parallel_stoppable(image->context, "undistort", undistort_row, &job, camera->height_px);
    ewa_texture_free(&job.texture);
    if (status != EWA_OK) ewa_image_free(pinhole);
    return status;
}
