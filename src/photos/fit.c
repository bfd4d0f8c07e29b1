// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The fit: colours c whose pictures A c differ least from the photographs. A' W A is added up photograph by photograph,
// and solved for the change of the colours by conjugate gradients; weights and exposures are then found anew.
#include "colors/gradient.h"
#include "photos/normal.h"
#include "photos/parts.h"

#include <math.h>
#include <string.h>

enum {
    CG_STEPS = 20,
    EXPOSURE_STEPS = 3, ///< per photograph and round
};

/// Of the gradient, relative to the first, at which the steps end: pictures do not change any more.
static const double TOLERANCE = 1e-4;

/// One photograph of a round.
typedef struct fit_photo {
    ewa_photos_job *job;
    const ewa_photo_view *view;
    ewa_photo_state *photo;
    double *shown;  ///< [pixel][EWA_PHOTO_CHANNELS]: A c
    double *rest;   ///< [pixel][EWA_PHOTO_CHANNELS]: weight times what is missing
    double *weight; ///< [pixel]
} fit_photo;

static void get_pair(const void *user, uint32_t i, double shown[EWA_PHOTO_CHANNELS], double color[EWA_PHOTO_CHANNELS],
                     double *weight) {
    const fit_photo *at = user;
    const ewa_photo_pixel *pixel = &at->view->pixels[i];
    for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) shown[c] = (double)pixel->color[c];
    memcpy(color, at->shown + (size_t)i * EWA_PHOTO_CHANNELS, EWA_PHOTO_CHANNELS * sizeof *color);
    *weight = (double)pixel->weight;
}

static void weigh_piece(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    fit_photo *at = data;
    const uint32_t begin = index * EWA_PHOTO_PIECE;
    const double *gain = at->photo->gain, *offset = at->photo->offset;
    for (uint32_t i = begin; i < begin + EWA_PHOTO_PIECE && i < at->view->pixel_count; i++) {
        double shown[EWA_PHOTO_CHANNELS], color[EWA_PHOTO_CHANNELS], wanted[EWA_PHOTO_CHANNELS], weight, mean = 0;
        get_pair(at, i, shown, color, &weight);
        for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) {
            wanted[c] = gain[c] * color[c] + offset[c];
            mean += fmax(color[c], 0) / EWA_PHOTO_CHANNELS;
        }
        weight *= ewa_robust_weight(shown, wanted, at->job->options.robust) / (mean + EWA_PHOTO_LEAST_COLOR);
        at->weight[i] = weight;
        double *rest = at->rest + (size_t)i * EWA_PHOTO_CHANNELS;
        for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) rest[c] = weight * ((shown[c] - offset[c]) / gain[c] - color[c]);
    }
}

static ewa_status add_photo(fit_photo *at, ewa_normal *normal) {
    const ewa_photos_job *job = at->job;
    const ewa_exposure_pairs pairs = {at->view->pixel_count, at, get_pair};
    ewa_photo_view_show(at->view, job->color, at->shown);
    for (int step = 0; step < EXPOSURE_STEPS && ewa_photo_is_exposed(at->photo); step++)
        ewa_exposure_step(&pairs, job->options.exposure, job->options.robust, at->photo->gain, at->photo->offset);
    ewa_parallel(job->context, weigh_piece, at, (at->view->pixel_count + EWA_PHOTO_PIECE - 1) / EWA_PHOTO_PIECE);
    return ewa_normal_add(normal, at->view, at->weight, at->rest);
}

static ewa_status add_view(ewa_photos_job *job, ewa_photo_state *photo, const ewa_photo_view *view, ewa_normal *normal) {
    const size_t size = (size_t)view->pixel_count * EWA_PHOTO_CHANNELS;
    fit_photo at = {.job = job, .view = view, .photo = photo};
    at.shown = ewa_allocate(job->context, size, sizeof *at.shown);
    at.rest = ewa_allocate(job->context, size, sizeof *at.rest);
    at.weight = ewa_allocate(job->context, view->pixel_count, sizeof *at.weight);
    const ewa_status status = at.shown && at.rest && at.weight ? add_photo(&at, normal) : EWA_ERROR_MEMORY;
    ewa_release(job->context, at.shown, size, sizeof *at.shown);
    ewa_release(job->context, at.rest, size, sizeof *at.rest);
    ewa_release(job->context, at.weight, view->pixel_count, sizeof *at.weight);
    return status;
}

/// What the equations are solved for.
typedef struct fit_system {
    const ewa_normal *normal;
    double ridge;
} fit_system;

static void multiply(const void *system, uint32_t block, const double *direction, double *product) {
    const fit_system *fit = system;
    const ewa_normal *normal = fit->normal;
    const ewa_normal_block *rows = &normal->blocks[block];
    const uint32_t end = ewa_gradient_block_end(normal->count, block);
    for (uint32_t row = block * EWA_GRADIENT_BLOCK_ROWS, k = 0; row < end; row++, k++) {
        const double *own = direction + (size_t)row * EWA_PHOTO_CHANNELS;
        double sum[EWA_PHOTO_CHANNELS];
        for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) sum[c] = fit->ridge * own[c];
        for (uint32_t i = rows->starts ? rows->starts[k] : 0; rows->starts && i < rows->starts[k + 1]; i++) {
            const ewa_photo_entry *entry = &rows->entries[i];
            const double *at = direction + (size_t)entry->index * EWA_PHOTO_CHANNELS;
            for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) sum[c] += (double)entry->weight * at[c];
        }
        memcpy(product + (size_t)row * EWA_PHOTO_CHANNELS, sum, sizeof sum);
    }
}

/// Solves for the change of the colours and adds it. `start`: what the ridge pulls to.
static ewa_status improve(ewa_photos_job *job, ewa_normal *normal, const double *start, double *change, double begin,
                          double end) {
    const size_t size = (size_t)job->point_count * EWA_PHOTO_CHANNELS;
    const fit_system system = {normal, job->options.ridge * ewa_normal_median(normal)};
    if (!(system.ridge > 0)) return EWA_OK;
    for (size_t i = 0; i < size; i++) normal->sides[i] -= system.ridge * (job->color[i] - start[i]);
    const ewa_conjugate_gradient gradient = {.context = job->context,
                                   .size = job->point_count,
                                   .count = EWA_PHOTO_CHANNELS,
                                   .solution = change,
                                   .residual = normal->sides,
                                   .system = (void *)&system,
                                   .multiply = multiply,
                                   .tolerance = TOLERANCE,
                                   .max_iterations = CG_STEPS,
                                   .stage = "photos",
                                   .begin = begin,
                                   .end = end};
    uint32_t steps;
    EWA_TRY(ewa_conjugate_gradient_run(&gradient, &steps));
    for (size_t i = 0; i < size; i++)
        if (job->counts[i / EWA_PHOTO_CHANNELS]) job->color[i] += change[i];
    return EWA_OK;
}

/// One round over all photographs.
static ewa_status run_round(ewa_photos_job *job, double *start, double *change, double begin, double end) {
    ewa_normal normal;
    ewa_status status = ewa_normal_make(job->context, job->point_count, &normal);
    for (uint32_t i = 0; i < job->photo_count && status == EWA_OK; i++) {
        ewa_photo_state *photo = &job->photos[i];
        const double fraction = begin + (end - begin) * 0.9 * i / job->photo_count;
        status = ewa_progress(job->context, "photos", fraction);
        if (photo->held_out || photo->sample_count == 0 || status != EWA_OK) continue;
        ewa_photo_view view;
        status = ewa_photo_view_make(job->cloud, photo->photo, photo->number, job->unit_coverage, &job->options,
                                     fraction, &photo->halvings, &view);
        if (status != EWA_OK) break;
        status = add_view(job, photo, &view, &normal);
        ewa_photo_view_free(&view);
    }
    if (status == EWA_OK) status = improve(job, &normal, start, change, begin + 0.9 * (end - begin), end);
    ewa_normal_free(&normal);
    double *const both[] = {job->color, start};
    if (status == EWA_OK) ewa_exposures_centre(job, both, 2);
    return status;
}

ewa_status ewa_photos_fit(ewa_photos_job *job, double begin, double end) {
    const size_t size = (size_t)job->point_count * EWA_PHOTO_CHANNELS;
    double *start = ewa_allocate(job->context, size, sizeof *start);
    double *change = ewa_allocate(job->context, size, sizeof *change);
    ewa_status status = start && change ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) memcpy(start, job->color, size * sizeof *start);
    for (uint32_t round = 0; round < job->options.rounds && status == EWA_OK; round++)
        status = run_round(job, start, change, begin + (end - begin) * round / job->options.rounds,
                           begin + (end - begin) * (round + 1) / job->options.rounds);
    ewa_release(job->context, start, size, sizeof *start);
    ewa_release(job->context, change, size, sizeof *change);
    return status;
}
