// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The fit: colours c whose pictures A c differ least from the photographs. A' W A is solved for the change of the colours
// by conjugate gradients, each of whose steps goes to the pixels of all photographs and back; weights and exposures are
// then found anew.
#include "colors/gradient.h"
#include "photos/parts.h"

#include <math.h>
#include <string.h>

enum {
    CG_STEPS = 5,
    EXPOSURE_STEPS = 3, ///< per photograph and round
    OCTAVE_BINS = 16,
    OCTAVES = 256,
    BIN_COUNT = OCTAVES * OCTAVE_BINS,
};

/// Of the gradient, relative to the first, at which the steps end: pictures do not change any more.
static const double TOLERANCE = 1e-4;

/// A round: the photographs' weights are in their states.
typedef struct fit_round {
    ewa_photos_job *job;
    double *start;    ///< what the ridge pulls to
    double *sides;    ///< A' W rest
    double *diagonal; ///< of A' W A
    double *product;  ///< A' W A direction, by steps; all [point][EWA_PHOTO_CHANNELS]
    double *change;
    double ridge;
    double begin, end; ///< of the progress of the steps
    int steps;         ///< that have begun
    ewa_status status; ///< of the products
} fit_round;

static const char STAGE[] = "photos: fit";

static void weigh_piece(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const ewa_photo_match *at = data;
    const uint32_t begin = index * EWA_PHOTO_PIECE;
    const double *gain = at->photo->gain, *offset = at->photo->offset;
    for (uint32_t i = begin; i < begin + EWA_PHOTO_PIECE && i < at->view->pixel_count; i++) {
        double shown[EWA_PHOTO_CHANNELS], color[EWA_PHOTO_CHANNELS], wanted[EWA_PHOTO_CHANNELS], weight, mean = 0;
        ewa_photo_match_get(at, i, shown, color, &weight);
        for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) {
            wanted[c] = gain[c] * color[c] + offset[c];
            mean += fmax(color[c], 0) / EWA_PHOTO_CHANNELS;
        }
        weight *= ewa_robust_weight(shown, wanted, at->job->options.robust) / (mean + EWA_PHOTO_MIN_COLOR);
        at->photo->fit_weights[i] = (float)weight;
        float *rest = at->shown + 4 * (size_t)i;
        for (int c = 0; c < EWA_PHOTO_CHANNELS; c++)
            rest[c] = (float)(weight * ((shown[c] - offset[c]) / gain[c] - color[c]));
    }
}

static ewa_status add_photo(ewa_photo_match *at, fit_round *round) {
    const ewa_photos_job *job = at->job;
    const bool exposed = ewa_photo_is_exposed(at->photo);
    EWA_TRY(ewa_photo_match_refine(at, exposed ? EXPOSURE_STEPS : 0, 0, exposed ? job->options.pose_steps : 0));
    at->photo->fitted.camera = at->view->camera;
    ewa_parallel(job->context, weigh_piece, at, (at->view->pixel_count + EWA_PHOTO_PIECE - 1) / EWA_PHOTO_PIECE);
    EWA_TRY(ewa_photo_view_gather(at->view, at->shown, round->sides));
    return ewa_photo_view_normal(at->view, at->photo->fit_weights, NULL, round->diagonal);
}

/// Adds a photograph's weights and right sides. Its view stays without the pixels.
static ewa_status add_view(fit_round *round, ewa_photo_state *photo, ewa_photo_view *view) {
    ewa_context *context = round->job->context;
    const size_t size = (size_t)view->pixel_count * 4;
    photo->fitted = *view, photo->fitted.pixels = NULL;
    photo->fit_weights = ewa_allocate(context, view->pixel_count, sizeof *photo->fit_weights);
    ewa_photo_match at = {round->job, view, photo, ewa_allocate(context, size, sizeof *at.shown)};
    const ewa_status status = at.shown && photo->fit_weights ? add_photo(&at, round) : EWA_ERROR_MEMORY;
    ewa_release(context, at.shown, size, sizeof *at.shown);
    return status;
}

/// Sets the product of A' W A and a direction; a unit matrix's after a failure, which `status` tells at the end.
static void multiply_all(void *system, const double *direction) {
    fit_round *round = system;
    const ewa_photos_job *job = round->job;
    const size_t size = (size_t)job->point_count * EWA_PHOTO_CHANNELS;
    memset(round->product, 0, size * sizeof *round->product);
    for (uint32_t i = 0; i < job->photo_count && round->status == EWA_OK; i++) {
        const ewa_photo_state *photo = &job->photos[i];
        if (!photo->fit_weights) continue;
        const double done = round->steps + (double)i / job->photo_count;
        round->status = ewa_progress(job->context, STAGE, round->begin + (round->end - round->begin) * done / CG_STEPS);
        if (round->status == EWA_OK) round->status = ewa_photo_view_normal(&photo->fitted, photo->fit_weights, direction, round->product);
    }
    round->steps++;
    if (round->status != EWA_OK) memcpy(round->product, direction, size * sizeof *direction);
}

static void multiply(const void *system, uint32_t block, const double *direction, double *product) {
    const fit_round *round = system;
    const size_t end = (size_t)ewa_gradient_block_end(round->job->point_count, block) * EWA_PHOTO_CHANNELS;
    for (size_t i = (size_t)block * EWA_GRADIENT_BLOCK_ROWS * EWA_PHOTO_CHANNELS; i < end; i++)
        product[i] = round->product[i] + round->ridge * direction[i];
}

static void precondition(const void *system, uint32_t block, const double *residual, double *result) {
    const fit_round *round = system;
    const size_t end = (size_t)ewa_gradient_block_end(round->job->point_count, block) * EWA_PHOTO_CHANNELS;
    for (size_t i = (size_t)block * EWA_GRADIENT_BLOCK_ROWS * EWA_PHOTO_CHANNELS; i < end; i++)
        result[i] = residual[i] / (round->diagonal[i] + round->ridge);
}

/// The median of the diagonal's numbers but for zeros, within a sixteenth of an octave; 0: all are.
static double median_of(const fit_round *round) {
    uint64_t bins[BIN_COUNT] = {0}, total = 0, below = 0;
    for (size_t i = 0; i < round->job->point_count; i++) {
        int exponent;
        const double part = frexp(round->diagonal[i * EWA_PHOTO_CHANNELS], &exponent);
        const int bin = (exponent + OCTAVES / 2) * OCTAVE_BINS + (int)((part - 0.5) * 2 * OCTAVE_BINS);
        if (bin >= 0 && bin < BIN_COUNT && part > 0) bins[bin]++, total++;
    }
    int bin = 0;
    while (bin < BIN_COUNT - 1 && 2 * (below += bins[bin]) < total) bin++;
    return total ? ldexp(0.5 + 0.5 * (bin % OCTAVE_BINS) / OCTAVE_BINS, bin / OCTAVE_BINS - OCTAVES / 2) : 0;
}

/// Solves for the change of the colours and adds it.
static ewa_status improve(fit_round *round, double begin, double end) {
    ewa_photos_job *job = round->job;
    const size_t size = (size_t)job->point_count * EWA_PHOTO_CHANNELS;
    round->ridge = job->options.ridge * median_of(round);
    round->begin = begin, round->end = end, round->steps = 0;
    if (!(round->ridge > 0)) return EWA_OK;
    for (size_t i = 0; i < size; i++) round->sides[i] -= round->ridge * (job->color[i] - round->start[i]);
    const ewa_conjugate_gradient gradient = {.context = job->context,
                                   .size = job->point_count,
                                   .count = EWA_PHOTO_CHANNELS,
                                   .solution = round->change,
                                   .residual = round->sides,
                                   .system = round,
                                   .prepare = multiply_all,
                                   .multiply = multiply,
                                   .precondition = precondition,
                                   .tolerance = TOLERANCE,
                                   .max_iterations = CG_STEPS,
                                   .stage = STAGE,
                                   .silent = true};
    uint32_t steps;
    const ewa_status status = ewa_conjugate_gradient_run(&gradient, &steps);
    EWA_TRY(round->status);
    EWA_TRY(status);
    for (size_t i = 0; i < size; i++)
        if (job->counts[i / EWA_PHOTO_CHANNELS]) job->color[i] += round->change[i];
    return EWA_OK;
}

static void drop_weights(ewa_photos_job *job) {
    for (uint32_t i = 0; i < job->photo_count; i++) {
        ewa_photo_state *photo = &job->photos[i];
        ewa_release(job->context, photo->fit_weights, photo->fitted.pixel_count, sizeof *photo->fit_weights);
        photo->fit_weights = NULL;
    }
}

/// One round over all photographs.
static ewa_status run_round(fit_round *round, double begin, double end) {
    ewa_photos_job *job = round->job;
    const size_t size = (size_t)job->point_count * EWA_PHOTO_CHANNELS;
    const double middle = begin + 0.4 * (end - begin);
    memset(round->sides, 0, size * sizeof *round->sides);
    memset(round->diagonal, 0, size * sizeof *round->diagonal);
    for (uint32_t i = 0; i < job->photo_count; i++) {
        ewa_photo_state *photo = &job->photos[i];
        EWA_TRY(ewa_progress(job->context, STAGE, begin + (middle - begin) * i / job->photo_count));
        if (photo->held_out || photo->sample_count == 0) continue;
        ewa_photo_view view;
        EWA_TRY(ewa_photo_view_make(job, photo, &view));
        const ewa_status status = add_view(round, photo, &view);
        ewa_photo_view_free(&view);
        EWA_TRY(status);
    }
    return improve(round, middle, end);
}

ewa_status ewa_photos_fit(ewa_photos_job *job, double begin, double end) {
    const size_t size = (size_t)job->point_count * EWA_PHOTO_CHANNELS;
    enum { VECTORS = 5 };
    double *room = ewa_allocate(job->context, VECTORS * size, sizeof *room);
    if (!room) return EWA_ERROR_MEMORY;
    fit_round round = {.job = job, .start = room, .sides = room + size, .diagonal = room + 2 * size,
                       .product = room + 3 * size, .change = room + 4 * size};
    memcpy(round.start, job->color, size * sizeof *room);
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < job->options.rounds && status == EWA_OK; i++) {
        status = run_round(&round, begin + (end - begin) * i / job->options.rounds,
                           begin + (end - begin) * (i + 1) / job->options.rounds);
        drop_weights(job);
        double *const both[] = {job->color, round.start};
        if (status == EWA_OK) ewa_exposures_centre(job, both, 2);
    }
    ewa_release(job->context, room, VECTORS * size, sizeof *room);
    return status;
}
