// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa_cloud_color_from_photos(): its arguments, the photographs one after the other, what is said of them, and the
// colours.
#include "base/options.h"
#include "cloud/cloud.h"
#include "cloud/color.h"
#include "photos/parts.h"
#include "surface/proxy.h"
#include "surface/surfel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// A point that a photograph shows less of, in pixels, is not seen by it.
static const double LEAST_SEEN_PX = 0.02;

/// Parts of the progress.
static const double SAMPLED = 0.3, SETTLED = 0.35, FITTED = 0.8;

#define AT(member) offsetof(ewa_photos_options, member)

static const ewa_option option_rows[] = {
    {"method", EWA_OPTION_CHOICE, AT(method), .words = "fit|median|mean|best",
     .help = "colours whose pictures differ least from the photographs; or, of what these show at a point, the "
             "weighted median, the weighted mean, or that of the one that sees it largest"},
    {"exposure", EWA_OPTION_CHOICE, AT(exposure), .words = "gain|gain-offset|off",
     .help = "what photographs are corrected by, channel by channel: gain, gain and offset, or nothing"},
    {"hold_out", EWA_OPTION_U32, AT(hold_out), 0, 65535,
     .help = "photographs 0, N, 2N, ... are not used and compared with the result; 0: all are used"},
    {"rounds", EWA_OPTION_U32, AT(rounds), 1, 20, .initial = 3,
     .help = "rounds of the fit, each with new weights of pixels and exposures"},
    {"robust", EWA_OPTION_F64, AT(robust), 0, 1, .initial = 0.05,
     .help = "difference of sRGB numbers in [0, 1] at which a pixel counts a quarter; 0: all count"},
    {"ridge", EWA_OPTION_F64, AT(ridge), 0, 10, EWA_OPTION_ABOVE, .initial = 0.1,
     .help = "pull of the fit towards the median, of the median point's own weight"},
    {"spacing_px", EWA_OPTION_F64, AT(spacing_px), 0, 100, .initial = 2,
     .help = "photographs are halved while points stay so many pixels apart; 0: never"},
    {"cutoff", EWA_OPTION_F64, AT(cutoff), 0, 4, EWA_OPTION_ABOVE, .initial = 3,
     .help = "standard deviations at which kernels end"},
};

const ewa_option_table ewa_photos_options_table = EWA_OPTION_TABLE(ewa_photos_options, option_rows);

void ewa_photos_options_init(ewa_photos_options *options, size_t struct_size) {
    ewa_options_init(&ewa_photos_options_table, options, struct_size);
}

/// Orders photographs by their cameras, so that what is added up does not depend on the order in which they come.
static int compare_photos(const void *a, const void *b) {
    const ewa_photo_state *left = a, *right = b;
    const ewa_camera *cameras[2] = {&left->photo->camera, &right->photo->camera};
    double keys[2][20];
    for (int i = 0; i < 2; i++) {
        memcpy(keys[i], cameras[i]->world_to_camera, sizeof cameras[i]->world_to_camera);
        const double lens[4] = {cameras[i]->fx_px, cameras[i]->fy_px, cameras[i]->cx_px, cameras[i]->cy_px};
        memcpy(keys[i] + 16, lens, sizeof lens);
    }
    for (int i = 0; i < 20; i++)
        if (keys[0][i] != keys[1][i]) return keys[0][i] < keys[1][i] ? -1 : 1;
    return (left->number > right->number) - (left->number < right->number);
}

typedef struct sample_job {
    const ewa_photo_view *view;
    double *sums; ///< [point][4]: weight, weighted colour
} sample_job;

static void sample_piece(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const sample_job *job = data;
    const ewa_photo_view *view = job->view;
    const uint32_t begin = index * EWA_PHOTO_PIECE;
    for (uint32_t point = begin; point < begin + EWA_PHOTO_PIECE && point < view->point_count; point++) {
        double *sum = job->sums + 4 * (size_t)point;
        memset(sum, 0, 4 * sizeof *sum);
        for (uint64_t i = view->point_starts[point]; i < view->point_starts[point + 1]; i++) {
            const ewa_photo_pixel *pixel = &view->pixels[view->by_point[i].index];
            const double weight = (double)view->by_point[i].weight * (double)pixel->weight;
            sum[0] += weight;
            for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) sum[c + 1] += weight * (double)pixel->color[c];
        }
    }
}

/// Keeps what a photograph says of the points that it sees.
static ewa_status sample(ewa_photos_job *job, ewa_photo_state *photo, const ewa_photo_view *view, double *sums) {
    sample_job sampling = {view, sums};
    ewa_parallel(job->context, sample_piece, &sampling, (job->point_count + EWA_PHOTO_PIECE - 1) / EWA_PHOTO_PIECE);
    uint32_t count = 0;
    for (uint32_t i = 0; i < job->point_count; i++) count += sums[4 * (size_t)i] > LEAST_SEEN_PX;
    photo->report.point_count = count;
    photo->report.pixel_count = view->pixel_count;
    photo->report.width_px = view->width_px, photo->report.height_px = view->height_px;
    if (count == 0)
        ewa_report(job->context, EWA_SEVERITY_WARNING, "%s: photograph %u sees none of the points",
                   photo->photo->path ? photo->photo->path : "photos", photo->number);
    if (count == 0 || photo->held_out) return EWA_OK;
    photo->samples = ewa_allocate(job->context, count, sizeof *photo->samples);
    if (!photo->samples) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < job->point_count; i++) {
        const double *sum = sums + 4 * (size_t)i;
        if (!(sum[0] > LEAST_SEEN_PX)) continue;
        ewa_photo_sample *to = &photo->samples[photo->sample_count++];
        *to = (ewa_photo_sample){.point = i, .weight = (float)sum[0]};
        for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) to->color[c] = (float)(sum[c + 1] / sum[0]);
        job->counts[i]++;
    }
    return EWA_OK;
}

/// Opens the view of a photograph.
static ewa_status look(ewa_photos_job *job, ewa_photo_state *photo, double fraction, ewa_photo_view *view) {
    EWA_TRY(ewa_progress(job->context, "photos", fraction));
    return ewa_photo_view_make(job->cloud, photo->photo, photo->number, job->unit_coverage, &job->options,
                               fraction, &photo->halvings, view);
}

static ewa_status sample_all(ewa_photos_job *job) {
    double *sums = ewa_allocate(job->context, (size_t)job->point_count * 4, sizeof *sums);
    ewa_status status = sums ? EWA_OK : EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < job->photo_count && status == EWA_OK; i++) {
        ewa_photo_view view;
        status = look(job, &job->photos[i], SAMPLED * i / job->photo_count, &view);
        if (status != EWA_OK) break;
        status = sample(job, &job->photos[i], &view, sums);
        ewa_photo_view_free(&view);
    }
    ewa_release(job->context, sums, (size_t)job->point_count * 4, sizeof *sums);
    return status;
}

/// Lists the samples of each point.
static ewa_status list_samples(ewa_photos_job *job) {
    uint64_t *starts = job->sample_starts;
    starts[0] = 0;
    for (uint32_t i = 0; i < job->point_count; i++) starts[i + 1] = starts[i] + job->counts[i];
    const uint64_t total = starts[job->point_count];
    if (total == 0)
        return ewa_fail(job->context, EWA_ERROR_ARGUMENT, "photos: none of %u photographs that are used sees any of %u points",
                        job->photo_count, job->point_count);
    job->samples = ewa_allocate(job->context, total, sizeof *job->samples);
    job->sample_photos = ewa_allocate(job->context, total, sizeof *job->sample_photos);
    if (!job->samples || !job->sample_photos) return EWA_ERROR_MEMORY;
    for (uint32_t k = job->photo_count; k-- > 0;)
        for (uint32_t i = 0; i < job->photos[k].sample_count; i++) {
            const ewa_photo_sample *sample = &job->photos[k].samples[i];
            const uint64_t at = --starts[sample->point + 1];
            job->samples[at] = sample, job->sample_photos[at] = (uint16_t)k;
        }
    memmove(starts, starts + 1, job->point_count * sizeof *starts);
    starts[job->point_count] = total;
    return EWA_OK;
}

/// What all pixels come to.
typedef struct error_sums {
    double square[2]; ///< of photographs that are used, that are not
    uint64_t count[2];
} error_sums;

/// A view beside its photograph.
typedef struct compare_job {
    const ewa_photos_job *job;
    const ewa_photo_view *view;
    ewa_photo_state *photo;
    double *shown;   ///< [pixel][EWA_PHOTO_CHANNELS]: A c, then
    double *squares; ///< [pixel]: mean over the channels, sRGB
} compare_job;

static void get_pair(const void *user, uint32_t i, double shown[EWA_PHOTO_CHANNELS], double color[EWA_PHOTO_CHANNELS],
                     double *weight) {
    const compare_job *at = user;
    for (size_t c = 0; c < EWA_PHOTO_CHANNELS; c++) {
        shown[c] = (double)at->view->pixels[i].color[c];
        color[c] = at->shown[i * (size_t)EWA_PHOTO_CHANNELS + c];
    }
    *weight = (double)at->view->pixels[i].weight;
}

static void compare_piece(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const compare_job *at = data;
    const uint32_t begin = index * EWA_PHOTO_PIECE;
    for (uint32_t i = begin; i < begin + EWA_PHOTO_PIECE && i < at->view->pixel_count; i++) {
        double shown[EWA_PHOTO_CHANNELS], color[EWA_PHOTO_CHANNELS], weight, square = 0;
        get_pair(at, i, shown, color, &weight);
        for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) {
            const double wanted = at->photo->gain[c] * color[c] + at->photo->offset[c];
            const double difference =
                ewa_srgb_encode(ewa_color_clamp01(shown[c])) - ewa_srgb_encode(ewa_color_clamp01(wanted));
            square += difference * difference / EWA_PHOTO_CHANNELS;
        }
        at->squares[i] = square;
    }
}

/// Compares a view, and adds to the residuals of its points.
static void compare(compare_job *at, double *residuals, error_sums *sums) {
    enum { STEPS = 12, WIDE_STEPS = 4 };
    const ewa_photos_job *job = at->job;
    ewa_photo_state *photo = at->photo;
    const ewa_photo_view *view = at->view;
    ewa_photo_view_show(view, job->color, at->shown);
    const ewa_exposure_pairs pairs = {view->pixel_count, at, get_pair};
    for (int step = 0; step < STEPS && photo->held_out; step++)
        ewa_exposure_step(&pairs, job->options.exposure,
                          job->options.robust * ldexp(1, step < WIDE_STEPS ? WIDE_STEPS - step : 0), photo->gain,
                          photo->offset);
    ewa_parallel(job->context, compare_piece, at, (view->pixel_count + EWA_PHOTO_PIECE - 1) / EWA_PHOTO_PIECE);
    double square = 0;
    uint64_t rejected = 0;
    for (uint32_t i = 0; i < view->pixel_count; i++) {
        square += at->squares[i];
        rejected += at->squares[i] > job->options.robust * job->options.robust;
    }
    for (uint32_t point = 0; point < view->point_count && !photo->held_out; point++)
        for (uint64_t i = view->point_starts[point]; i < view->point_starts[point + 1]; i++) {
            const ewa_photo_entry *entry = &view->by_point[i];
            const double weight = (double)entry->weight * (double)view->pixels[entry->index].weight;
            residuals[2 * (size_t)point] += weight;
            residuals[2 * (size_t)point + 1] += weight * at->squares[entry->index];
        }
    photo->report.rms = view->pixel_count ? sqrt(square / view->pixel_count) : 0;
    photo->report.rejected =
        job->options.robust > 0 && view->pixel_count ? (double)rejected / view->pixel_count : 0;
    sums->square[photo->held_out] += square, sums->count[photo->held_out] += view->pixel_count;
}

static double decibels(double rms) { return -20 * log10(rms); }

static ewa_status compare_all(ewa_photos_job *job, double begin, double *residuals, ewa_photos_report *report) {
    error_sums sums = {.square = {0}};
    for (uint32_t i = 0; i < job->photo_count; i++) {
        ewa_photo_state *photo = &job->photos[i];
        ewa_photo_view view;
        EWA_TRY(look(job, photo, begin + (1 - begin) * i / job->photo_count, &view));
        const size_t size = (size_t)view.pixel_count * (EWA_PHOTO_CHANNELS + 1);
        double *room = ewa_allocate(job->context, size, sizeof *room);
        compare_job at = {job, &view, photo, room, room + (size_t)view.pixel_count * EWA_PHOTO_CHANNELS};
        if (room) compare(&at, residuals, &sums);
        ewa_release(job->context, room, size, sizeof *room);
        ewa_photo_view_free(&view);
        if (!room) return EWA_ERROR_MEMORY;
        memcpy(photo->report.gain, photo->gain, sizeof photo->gain);
        memcpy(photo->report.offset, photo->offset, sizeof photo->offset);
        photo->report.held_out = photo->held_out;
        photo->report.psnr_db = photo->report.pixel_count ? decibels(photo->report.rms) : NAN;
        ++*(photo->held_out ? &report->held_out_count : &report->used_count);
    }
    report->rms = sums.count[0] ? sqrt(sums.square[0] / (double)sums.count[0]) : 0;
    report->held_out_rms = sums.count[1] ? sqrt(sums.square[1] / (double)sums.count[1]) : 0;
    report->psnr_db = sums.count[0] ? decibels(report->rms) : NAN;
    report->held_out_psnr_db = sums.count[1] ? decibels(report->held_out_rms) : NAN;
    return EWA_OK;
}

/// Reads the colours that the points have.
static void read_colors(ewa_photos_job *job, double *alpha) {
    const ewa_attribute *color = ewa_cloud_find(job->cloud, EWA_COLOR);
    const bool given = color && color->component_count >= 3;
    ewa_color_table table;
    ewa_color_table_make(&table);
    for (uint32_t i = 0; i < job->point_count; i++) {
        double value[4], *to = job->color + (size_t)i * EWA_PHOTO_CHANNELS;
        for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) to[c] = EWA_DEFAULT_GREY;
        alpha[i] = 1;
        if (!given) continue;
        ewa_attribute_read_f64(color, i, 1, value);
        ewa_color_decode(&table, color, value, to);
        alpha[i] = ewa_color_alpha(color, value);
    }
}

/// Adds the three streams, all or none.
static ewa_status write(ewa_photos_job *job, const double *alpha, const double *residuals, ewa_photos_report *report) {
    ewa_context *context = job->context;
    const ewa_attribute *old = ewa_cloud_find(job->cloud, EWA_COLOR);
    const size_t count = job->point_count, components = old && old->component_count == 4 ? 4 : 3;
    float *color = ewa_allocate(context, count * components, sizeof *color), *stream, *residual;
    uint16_t *counts;
    if (!color) return EWA_ERROR_MEMORY;
    report->low = INFINITY, report->high = -INFINITY;
    for (size_t i = 0; i < count; i++) {
        for (size_t c = 0; c < EWA_PHOTO_CHANNELS; c++) {
            const float number = (float)job->color[i * EWA_PHOTO_CHANNELS + c];
            color[i * components + c] = number;
            if (job->counts[i]) report->low = fminf(report->low, number), report->high = fmaxf(report->high, number);
        }
        if (components == 4) color[4 * i + 3] = (float)alpha[i];
        report->seen_count += job->counts[i] > 0;
    }
    ewa_status status = ewa_cloud_add(job->cloud, EWA_PHOTO_COUNT, EWA_U16, 1, (void **)&counts);
    if (status == EWA_OK) status = ewa_cloud_add(job->cloud, EWA_PHOTO_RESIDUAL, EWA_F32, 1, (void **)&residual);
    if (status == EWA_OK) status = ewa_cloud_add(job->cloud, EWA_COLOR, EWA_F32, (uint32_t)components, (void **)&stream);
    if (status != EWA_OK) {
        ewa_cloud_remove(job->cloud, EWA_PHOTO_COUNT);
        ewa_cloud_remove(job->cloud, EWA_PHOTO_RESIDUAL);
    } else {
        memcpy(stream, color, count * components * sizeof *stream);
        memcpy(counts, job->counts, count * sizeof *counts);
        for (size_t i = 0; i < count; i++)
            residual[i] = residuals[2 * i] > 0 ? (float)sqrt(residuals[2 * i + 1] / residuals[2 * i]) : 0;
    }
    ewa_release(context, color, count * components, sizeof *color);
    return status;
}

static ewa_status run(ewa_photos_job *job, double *alpha, double *residuals, ewa_photos_report *report) {
    read_colors(job, alpha);
    EWA_TRY(sample_all(job));
    EWA_TRY(list_samples(job));
    EWA_TRY(ewa_photos_settle(job, SAMPLED, SETTLED));
    const bool fit = job->options.method == EWA_PHOTOS_FIT;
    if (fit) EWA_TRY(ewa_photos_fit(job, SETTLED, FITTED));
    EWA_TRY(compare_all(job, fit ? FITTED : SETTLED, residuals, report));
    EWA_TRY(ewa_progress(job->context, "photos", 1));
    return write(job, alpha, residuals, report);
}

/// With memory for the points and the photographs.
static ewa_status start(ewa_photos_job *job, const ewa_photo *photos, ewa_photos_report *report,
                        ewa_photo_report *per_photo) {
    ewa_context *context = job->context;
    const size_t points = job->point_count;
    job->photos = ewa_allocate_zeroed(context, job->photo_count, sizeof *job->photos);
    job->color = ewa_allocate(context, points * EWA_PHOTO_CHANNELS, sizeof *job->color);
    job->counts = ewa_allocate_zeroed(context, points, sizeof *job->counts);
    job->sample_starts = ewa_allocate(context, points + 1, sizeof *job->sample_starts);
    double *alpha = ewa_allocate(context, points, sizeof *alpha);
    double *residuals = ewa_allocate_zeroed(context, 2 * points, sizeof *residuals);
    ewa_status status = EWA_ERROR_MEMORY;
    if (job->photos && job->color && job->counts && job->sample_starts && alpha && residuals) {
        for (uint32_t i = 0; i < job->photo_count; i++) {
            ewa_photo_state *photo = &job->photos[i];
            *photo = (ewa_photo_state){.photo = &photos[i], .number = i, .halvings = UINT32_MAX};
            photo->held_out = job->options.hold_out && i % job->options.hold_out == 0;
            for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) photo->gain[c] = 1;
        }
        qsort(job->photos, job->photo_count, sizeof *job->photos, compare_photos);
        status = run(job, alpha, residuals, report);
    }
    for (uint32_t i = 0; job->photos && i < job->photo_count; i++) {
        ewa_photo_state *photo = &job->photos[i];
        if (status == EWA_OK && per_photo) per_photo[photo->number] = photo->report;
        ewa_release(context, photo->samples, photo->report.point_count, sizeof *photo->samples);
    }
    const uint64_t samples = job->samples ? job->sample_starts[points] : 0;
    ewa_release(context, job->samples, samples, sizeof *job->samples);
    ewa_release(context, job->sample_photos, samples, sizeof *job->sample_photos);
    ewa_release(context, job->photos, job->photo_count, sizeof *job->photos);
    ewa_release(context, job->color, points * EWA_PHOTO_CHANNELS, sizeof *job->color);
    ewa_release(context, job->counts, points, sizeof *job->counts);
    ewa_release(context, job->sample_starts, points + 1, sizeof *job->sample_starts);
    ewa_release(context, alpha, points, sizeof *alpha);
    ewa_release(context, residuals, 2 * points, sizeof *residuals);
    return status;
}

ewa_status ewa_cloud_color_from_photos(ewa_cloud *cloud, const ewa_photo *photos, uint32_t count,
                                       const ewa_photos_options *options, ewa_photos_report *report,
                                       ewa_photo_report *per_photo) {
    if (!cloud) return EWA_ERROR_ARGUMENT;
    ewa_photos_job job = {.context = ewa_cloud_context(cloud), .cloud = cloud, .photo_count = count};
    ewa_photos_options_init(&job.options, sizeof job.options);
    EWA_TRY(ewa_options_take(job.context, &ewa_photos_options_table, options, &job.options));
    if (!photos || count == 0) return ewa_fail(job.context, EWA_ERROR_ARGUMENT, "photos: there are no photographs");
    const uint64_t points = ewa_cloud_point_count(cloud);
    if (count > EWA_PHOTO_MAX || points > UINT32_MAX - EWA_PHOTO_PIECE)
        return ewa_fail(job.context, EWA_ERROR_LIMIT, "photos: %u photographs and %llu points; there may be %d and %u", count,
                        (unsigned long long)points, EWA_PHOTO_MAX, UINT32_MAX - EWA_PHOTO_PIECE);
    for (uint32_t i = 0; i < count; i++) EWA_TRY(ewa_camera_check(job.context, &photos[i].camera));
    if (job.options.hold_out == 1)
        return ewa_fail(job.context, EWA_ERROR_ARGUMENT, "photos: hold_out is 1, which leaves no photograph to use");
    job.point_count = (uint32_t)points;
    ewa_surfels_options surfels;
    ewa_surfels_options_init(&surfels, sizeof surfels);
    surfels.cutoff = job.options.cutoff;
    EWA_TRY(ewa_surfels_measure_unit_coverage(cloud, &surfels, &job.unit_coverage));
    ewa_photos_report made = {.used_count = 0};
    const ewa_status status = start(&job, photos, &made, per_photo);
    if (status == EWA_OK && report) *report = made;
    return status;
}
