// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One photograph: what it shows, and what points show there. Weights are those of the renderer, there and back
// (src/surface/gather.h; docs/math.md section 15), so that what is hidden for it is hidden here.
#include "cloud/cloud.h"
#include "ewa/prepare.h"
#include "image/srgb.h"
#include "photos/parts.h"
#include "reference/adjoint_frame.h"

#include <math.h>
#include <string.h>

enum {
    MAX_HALVINGS = 12,
    SPACING_SAMPLE = 1 << 15, ///< points whose spacing is looked at
    OCTAVE_BINS = 16,         ///< of spacings
    OCTAVES = 64,
    BIN_COUNT = OCTAVES * OCTAVE_BINS,
};

/// Pixels that show less of the nearest surface show something behind it too.
static const float FULL = 0.99f;
/// Of a pixel with a number below the code 1 or above 254: what is clipped may have been any number beyond.
static const float CLIPPED_WEIGHT = 0.1f;

/// How pictures of points are drawn that are compared with photographs.
static void set_options(ewa_render_options *render) {
    ewa_render_options_init(render, sizeof *render);
    render->shading = EWA_SHADING_NONE;
    render->edge_layers = 1; // what is behind the nearest surface is not asked for
}

/// How far the neighbours of a surfel are, in pixels.
static double spacing_of(const ewa_reference_view *view, const ewa_reference_splat *splat) {
    const double sigma = sqrt(vec3_length(splat->axis_u) * vec3_length(splat->axis_v));
    const double scale = 0.5 * (view->fx_px + view->fy_px) / (view->orthographic ? 1 : splat->center.z);
    return sigma * view->cutoff / EWA_DEFAULT_RADIUS_SCALE * scale;
}

/// How often a photograph can be halved: its points stay at least `spacing_px` apart, in the median.
static ewa_status find_halvings(const ewa_photos_job *job, const ewa_camera *camera, uint32_t *halvings) {
    *halvings = 0;
    if (job->options.spacing_px <= 0) return EWA_OK;
    ewa_render_options render;
    ewa_surfels_options surfels;
    ewa_reference_frame frame;
    set_options(&render);
    ewa_surfels_options_init(&surfels, sizeof surfels);
    surfels.cutoff = job->options.cutoff;
    EWA_TRY(ewa_reference_frame_make(job->cloud, &surfels, 1, camera, &render, &frame));
    uint64_t sums[BIN_COUNT] = {0}, total = 0, below = 0;
    const uint64_t step = frame.point_count / SPACING_SAMPLE + 1;
    for (uint64_t i = 0; i < frame.point_count; i += step) {
        ewa_surfel surfel;
        ewa_reference_splat splat;
        ewa_reference_frame_project(&frame, i, 1, &surfel, &splat);
        if (!splat.drawn || splat.by_rays || splat.x_begin >= splat.x_end || splat.y_begin >= splat.y_end) continue;
        int exponent;
        const double part = frexp(spacing_of(&frame.view, &splat), &exponent);
        const int bin = (exponent + OCTAVES / 2) * OCTAVE_BINS + (int)((part - 0.5) * 2 * OCTAVE_BINS);
        if (bin >= 0 && bin < BIN_COUNT) sums[bin]++, total++;
    }
    int bin = 0;
    while (bin < BIN_COUNT && 2 * (below += sums[bin]) < total) bin++;
    double median = total ? ldexp(0.5 + 0.5 * (bin % OCTAVE_BINS) / OCTAVE_BINS, bin / OCTAVE_BINS - OCTAVES / 2) : 0;
    for (; median >= 2 * job->options.spacing_px && *halvings < MAX_HALVINGS; median /= 2) ++*halvings;
    return EWA_OK;
}

/// Makes a picture of half the size, of means of four pixels; an odd row or column at the end is left out.
static ewa_status halve(ewa_context *context, const ewa_image *from, ewa_image *to) {
    EWA_TRY(ewa_image_create(context, from->width_px / 2, from->height_px / 2, from->channel_count, to));
    const size_t channels = from->channel_count, stride = from->width_px * channels;
    for (size_t y = 0; y < to->height_px; y++)
        for (size_t x = 0; x < to->width_px; x++)
            for (size_t c = 0; c < channels; c++) {
                const float *at = from->pixels + 2 * y * stride + 2 * x * channels + c;
                to->pixels[(y * to->width_px + x) * channels + c] =
                    0.25f * (at[0] + at[channels] + at[stride] + at[stride + channels]);
            }
    return EWA_OK;
}

/// Halves a photograph with its camera; `*image` is another one then, which is owned.
static ewa_status halve_often(ewa_context *context, uint32_t halvings, ewa_camera *camera, ewa_image *image, bool *owned) {
    for (uint32_t i = 0; i < halvings && image->width_px > 1 && image->height_px > 1; i++) {
        ewa_image smaller;
        EWA_TRY(halve(context, image, &smaller));
        if (*owned) ewa_image_free(image);
        *image = smaller, *owned = true;
        camera->width_px = smaller.width_px, camera->height_px = smaller.height_px;
        camera->fx_px /= 2, camera->fy_px /= 2, camera->cx_px /= 2, camera->cy_px /= 2;
    }
    return EWA_OK;
}

/// Whether a photograph says anything at a pixel: where it is not transparent, and its numbers are.
static bool is_photographed(const ewa_image *image, size_t index) {
    const float *at = image->pixels + index * image->channel_count;
    bool good = image->channel_count != 4 || at[3] > 0.999f;
    for (uint32_t c = 0; c < image->channel_count; c++) good = good && isfinite(at[c]);
    return good;
}

/// What a pixel of a photograph shows, of which the lens left the part `vignette`.
static ewa_photo_pixel read_pixel(const ewa_image *image, size_t index, float vignette) {
    const float *at = image->pixels + index * image->channel_count;
    ewa_photo_pixel pixel = {.weight = 0};
    if (!is_photographed(image, index)) return pixel;
    pixel.weight = 1;
    for (uint32_t c = 0; c < EWA_PHOTO_CHANNELS; c++) {
        pixel.color[c] = at[image->channel_count < 3 ? 0 : c];
        if (pixel.color[c] < ewa_srgb_decoded[1] || pixel.color[c] > ewa_srgb_decoded[254]) pixel.weight = CLIPPED_WEIGHT;
        pixel.color[c] /= vignette;
    }
    return pixel;
}

/// A view on its way from the photograph.
typedef struct read_job {
    const double *vignetting;
    const ewa_image *image;
    ewa_photo_view *view;
} read_job;

static float vignette_at(const read_job *job, uint32_t pixel) {
    const uint32_t width = job->view->camera.width_px;
    return (float)ewa_photo_vignette(job->vignetting,
                                     ewa_photo_radius2(&job->view->camera, pixel % width + 0.5, pixel / width + 0.5));
}

static void read_piece(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const read_job *job = data;
    const uint32_t begin = index * EWA_PHOTO_PIECE;
    for (uint32_t i = begin; i < begin + EWA_PHOTO_PIECE && i < job->view->pixel_count; i++)
        job->view->pixels[i] = read_pixel(job->image, i, vignette_at(job, i));
}

/// With the picture at hand.
static ewa_status make(const ewa_photos_job *job, uint32_t *halvings, ewa_photo_view *view, ewa_image *image, bool *owned) {
    if (*halvings == UINT32_MAX) EWA_TRY(find_halvings(job, &view->camera, halvings));
    EWA_TRY(halve_often(job->context, *halvings, &view->camera, image, owned));
    view->pixel_count = image->width_px * image->height_px;
    view->pixels = ewa_allocate(job->context, view->pixel_count, sizeof *view->pixels);
    if (!view->pixels) return EWA_ERROR_MEMORY;
    read_job reading = {job->vignetting, image, view};
    ewa_parallel(job->context, read_piece, &reading, (view->pixel_count + EWA_PHOTO_PIECE - 1) / EWA_PHOTO_PIECE);
    return EWA_OK;
}

ewa_status ewa_photo_view_make(const ewa_photos_job *job, ewa_photo_state *photo, ewa_photo_view *view) {
    *view = (ewa_photo_view){.context = job->context, .surfels = job->surfels, .room = job->room,
                             .camera = photo->photo->camera, .cutoff = job->options.cutoff, .point_count = job->point_count};
    memcpy(view->camera.world_to_camera, photo->world_to_camera, sizeof photo->world_to_camera);
    ewa_image image;
    bool owned;
    EWA_TRY(ewa_photo_take(job->context, photo->photo, photo->number, NULL, &image, &owned));
    const ewa_status status = make(job, &photo->halvings, view, &image, &owned);
    if (owned) ewa_image_free(&image);
    if (status != EWA_OK) ewa_photo_view_free(view);
    return status;
}

void ewa_photo_view_free(ewa_photo_view *view) {
    ewa_release(view->context, view->pixels, view->pixel_count, sizeof *view->pixels);
    view->pixels = NULL;
}

/// A way between the points and the view's filled pixels.
static ewa_gather_request request_of(const ewa_photo_view *view) {
    ewa_gather_request request = {.surfels = view->surfels, .point_count = view->point_count, .camera = view->camera,
                                  .filled = true, .minimum_alpha = FULL, .room = view->room};
    set_options(&request.options);
    return request;
}

ewa_status ewa_photo_view_show(const ewa_photo_view *view, const double *colors, float *shown) {
    ewa_gather_request request = request_of(view);
    request.colors = colors, request.shown = shown;
    return ewa_gather_run(&request, NULL);
}

ewa_status ewa_photo_view_gather(const ewa_photo_view *view, const float *rgba, double *sums) {
    ewa_gather_request request = request_of(view);
    request.rgba = rgba, request.sums = sums;
    return ewa_gather_run(&request, NULL);
}

ewa_status ewa_photo_view_normal(const ewa_photo_view *view, const float *weights, const double *colors, double *sums) {
    ewa_gather_request request = request_of(view);
    request.weights = weights, request.colors = colors, request.sums = sums, request.squares = !colors;
    return ewa_gather_run(&request, NULL);
}
