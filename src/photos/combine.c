// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours of points from what each photograph says of them, and exposures from what they say of the same points.
#include "photos/parts.h"

#include <math.h>
#include <string.h>

enum {
    MAX_STEPS = 200, ///< of exposures and colours by turns
    WIDE_STEPS = 6,  ///< that begin with robust weights of a larger scale, half of it in each
};

/// The largest change of a gain or an offset with which the turns end.
static const double CONVERGED = 2e-6;

/// One photograph's number and weight.
typedef struct said {
    double number, weight;
} said;

/// The number at half of the weight, the mean of two where it is between them. Sorts what there is. Lengths count, not
/// areas: with these, one near photograph often has half of all weight, and its mistakes would be the median.
static double median_of(said *numbers, uint32_t count) {
    double total = 0, below = 0;
    for (uint32_t i = 0; i < count; i++) {
        const said at = {numbers[i].number, sqrt(numbers[i].weight)};
        uint32_t k = i;
        for (; k > 0 && numbers[k - 1].number > at.number; k--) numbers[k] = numbers[k - 1];
        numbers[k] = at;
        total += at.weight;
    }
    for (uint32_t i = 0; i + 1 < count; i++) {
        below += numbers[i].weight;
        if (2 * below == total) return 0.5 * (numbers[i].number + numbers[i + 1].number);
        if (2 * below > total) return numbers[i].number;
    }
    return numbers[count - 1].number;
}

static double mean_of(const said *numbers, uint32_t count) {
    double sum = 0, total = 0;
    for (uint32_t i = 0; i < count; i++) sum += numbers[i].weight * numbers[i].number, total += numbers[i].weight;
    return sum / total;
}

static double best_of(const said *numbers, uint32_t count) {
    const said *best = numbers;
    for (uint32_t i = 1; i < count; i++)
        if (numbers[i].weight > best->weight) best = &numbers[i];
    return best->number;
}

typedef struct combine_job {
    ewa_photos_job *job;
    ewa_photos_method method;
    uint32_t step; ///< every so many-th point gets a colour
    said *room;    ///< [worker][photographs]
} combine_job;

static void combine_piece(void *data, uint32_t index, uint32_t worker) {
    const combine_job *combine = data;
    ewa_photos_job *job = combine->job;
    said *numbers = combine->room + (size_t)worker * job->photo_count;
    const uint32_t begin = index * EWA_PHOTO_PIECE;
    const uint32_t start = (begin + combine->step - 1) / combine->step * combine->step;
    for (uint32_t point = start; point < begin + EWA_PHOTO_PIECE && point < job->point_count; point += combine->step) {
        const uint64_t first = job->sample_starts[point];
        const uint32_t count = job->counts[point];
        for (size_t c = 0; c < EWA_PHOTO_CHANNELS && count; c++) {
            for (uint32_t i = 0; i < count; i++) {
                const ewa_photo_state *photo = &job->photos[job->sample_photos[first + i]];
                const ewa_photo_sample *sample = job->samples[first + i];
                const double vignette = ewa_photo_vignette(job->vignetting, (double)sample->radius2);
                numbers[i] = (said){((double)sample->color[c] / vignette - photo->offset[c]) / photo->gain[c],
                                    (double)sample->weight};
            }
            job->color[(size_t)point * EWA_PHOTO_CHANNELS + c] =
                combine->method == EWA_PHOTOS_MEAN   ? mean_of(numbers, count)
                : combine->method == EWA_PHOTOS_BEST ? best_of(numbers, count)
                                                     : median_of(numbers, count);
        }
    }
}

/// Sets the colours of every `step`th point.
static ewa_status combine_some(ewa_photos_job *job, ewa_photos_method method, uint32_t step) {
    const size_t room = (size_t)ewa_context_worker_count(job->context) * job->photo_count;
    combine_job combine = {job, method, step, ewa_allocate(job->context, room, sizeof *combine.room)};
    if (!combine.room) return EWA_ERROR_MEMORY;
    ewa_parallel(job->context, combine_piece, &combine, (job->point_count + EWA_PHOTO_PIECE - 1) / EWA_PHOTO_PIECE);
    ewa_release(job->context, combine.room, room, sizeof *combine.room);
    return EWA_OK;
}

ewa_status ewa_photos_combine(ewa_photos_job *job, ewa_photos_method method) { return combine_some(job, method, 1); }

/// The samples of a photograph beside the colours of their points.
typedef struct sample_pairs {
    const ewa_photos_job *job;
    const ewa_photo_state *photo;
} sample_pairs;

static void get_pair(const void *user, uint32_t i, double shown[EWA_PHOTO_CHANNELS], double color[EWA_PHOTO_CHANNELS],
                     double *weight) {
    const sample_pairs *pairs = user;
    const ewa_photo_sample *sample = &pairs->photo->samples[i];
    const double vignette = ewa_photo_vignette(pairs->job->vignetting, (double)sample->radius2);
    for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) shown[c] = (double)sample->color[c] / vignette;
    memcpy(color, pairs->job->color + (size_t)sample->point * EWA_PHOTO_CHANNELS, EWA_PHOTO_CHANNELS * sizeof *color);
    // What one photograph alone says of a point says nothing about its exposure.
    *weight = pairs->job->counts[sample->point] > 1 ? (double)sample->weight : 0;
}

typedef struct exposure_job {
    ewa_photos_job *job;
    double scale;
} exposure_job;

static void expose_photo(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const exposure_job *exposure = data;
    ewa_photo_state *photo = &exposure->job->photos[index];
    const sample_pairs user = {exposure->job, photo};
    const ewa_exposure_pairs pairs = {photo->telling_count, 1, &user, get_pair};
    if (ewa_photo_is_exposed(photo))
        ewa_exposure_step(&pairs, exposure->job->options.exposure, exposure->scale, photo->gain, photo->offset);
}

/// Finds the vignetting that what photographs say agrees with best.
static void find_vignetting(ewa_photos_job *job, double scale) {
    double sums[EWA_VIGNETTING_SUMS] = {0};
    for (uint32_t k = 0; k < job->photo_count; k++) {
        const ewa_photo_state *photo = &job->photos[k];
        const sample_pairs pairs = {job, photo};
        for (uint32_t i = 0; i < (ewa_photo_is_exposed(photo) ? photo->telling_count : 0); i++) {
            const double radius2 = (double)photo->samples[i].radius2, vignette = ewa_photo_vignette(job->vignetting, radius2);
            double shown[EWA_PHOTO_CHANNELS], wanted[EWA_PHOTO_CHANNELS], weight;
            get_pair(&pairs, i, shown, wanted, &weight);
            for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) wanted[c] = photo->gain[c] * wanted[c] + photo->offset[c];
            weight *= ewa_robust_weight(shown, wanted, scale);
            for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) shown[c] *= vignette;
            ewa_vignetting_add(shown, wanted, radius2, weight, sums);
        }
    }
    ewa_vignetting_solve(sums, job->vignetting);
}

/// Gains and offsets of all photographs.
static void copy_exposures(const ewa_photos_job *job, double *to) {
    for (uint32_t i = 0; i < job->photo_count; i++)
        for (size_t c = 0; c < EWA_PHOTO_CHANNELS; c++) {
            to[(i * EWA_PHOTO_CHANNELS + c) * 2] = job->photos[i].gain[c];
            to[(i * EWA_PHOTO_CHANNELS + c) * 2 + 1] = job->photos[i].offset[c];
        }
}

static ewa_status find_exposures(ewa_photos_job *job, double begin, double end, double *before, double *after,
                                 size_t count) {
    for (int step = 0; step < MAX_STEPS; step++) {
        EWA_TRY(ewa_progress(job->context, "photos: exposures", begin + (end - begin) * step / MAX_STEPS));
        const double wide = step < WIDE_STEPS ? ldexp(1, WIDE_STEPS - step) : 1;
        exposure_job exposure = {job, job->options.robust * wide};
        EWA_TRY(combine_some(job, EWA_PHOTOS_MEDIAN, ewa_exposure_stride(job->point_count)));
        copy_exposures(job, before);
        ewa_parallel(job->context, expose_photo, &exposure, job->photo_count);
        ewa_exposures_centre(job, NULL, 0);
        copy_exposures(job, after);
        const double lens[2] = {job->vignetting[0], job->vignetting[1]};
        if (job->options.vignetting) find_vignetting(job, exposure.scale);
        double change = fmax(fabs(job->vignetting[0] - lens[0]), fabs(job->vignetting[1] - lens[1]));
        for (size_t i = 0; i < count; i++) change = fmax(change, fabs(after[i] - before[i]));
        if (step >= WIDE_STEPS && change < CONVERGED) break;
    }
    return EWA_OK;
}

ewa_status ewa_photos_alternate(ewa_photos_job *job, double begin, double end) {
    const size_t count = (size_t)job->photo_count * EWA_PHOTO_CHANNELS * 2;
    ewa_status status = EWA_OK;
    if (job->options.exposure != EWA_EXPOSURE_OFF || job->options.vignetting) {
        double *room = ewa_allocate(job->context, 2 * count, sizeof *room);
        status = room ? find_exposures(job, begin, end, room, room + count, count) : EWA_ERROR_MEMORY;
        ewa_release(job->context, room, 2 * count, sizeof *room);
    }
    const ewa_photos_method method = job->options.method;
    return status == EWA_OK ? ewa_photos_combine(job, method == EWA_PHOTOS_FIT ? EWA_PHOTOS_MEDIAN : method) : status;
}
