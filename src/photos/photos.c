// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa_cloud_color_from_photos(): its arguments, the photographs one after the other, what is said of them, and the
// colours.
#include "base/options.h"
#include "cloud/cloud.h"
#include "cloud/color.h"
#include "photos/parts.h"
#include "surface/packets.h"
#include "surface/surfel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// A point that a photograph shows less of, in pixels, is not seen by it.
static const double MIN_SEEN_PX = 0.02;

/// Parts of the progress.
static const double FITTED = 0.8, SAMPLED = 0.4, EXPOSED = 0.45; // the others are parts of the first

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
    {"pose_steps", EWA_OPTION_U32, AT(pose_steps), 0, 20,
     .help = "with the method fit: steps by which the pose of each photograph is refined in each round, and as many in all of those "
             "that are held out; 0: poses are taken as they are"},
    {"vignetting", EWA_OPTION_BOOL, AT(vignetting),
     .help = "find how much darker photographs are towards their corners, which one lens has taken"},
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

/// Numbers of pixels that go back to points.
typedef struct sample_job {
    const ewa_photo_view *view;
    int pass;
    float *rgba; ///< [pixel][4]
} sample_job;

/// Weight and weighted red and green, or weighted blue: what goes back together.
static void weigh_piece(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const sample_job *job = data;
    const uint32_t begin = index * EWA_PHOTO_PIECE;
    for (uint32_t i = begin; i < begin + EWA_PHOTO_PIECE && i < job->view->pixel_count; i++) {
        const ewa_photo_pixel *pixel = &job->view->pixels[i];
        float *to = job->rgba + 4 * (size_t)i;
        to[0] = pixel->weight * (job->pass ? pixel->color[2] : 1);
        to[1] = job->pass ? 0 : pixel->weight * pixel->color[0];
        to[2] = job->pass ? 0 : pixel->weight * pixel->color[1];
    }
}

/// Sums of what a photograph shows of each point, [point][4]: weight, weighted colour.
static ewa_status add_up(ewa_photos_job *job, const ewa_photo_view *view, float *rgba, double *found, double *sums) {
    for (int pass = 0; pass < 2; pass++) {
        sample_job sampling = {view, pass, rgba};
        ewa_parallel(job->context, weigh_piece, &sampling, (view->pixel_count + EWA_PHOTO_PIECE - 1) / EWA_PHOTO_PIECE);
        memset(found, 0, (size_t)job->point_count * 3 * sizeof *found);
        EWA_TRY(ewa_photo_view_gather(view, rgba, found));
        for (size_t i = 0; i < job->point_count; i++)
            for (size_t c = 0; c < (pass ? 1 : 3); c++) sums[4 * i + 3 * (size_t)pass + c] = found[3 * i + c];
    }
    return EWA_OK;
}

/// Where a photograph shows a point: the square of its distance from the middle.
static double radius2_of(const ewa_photos_job *job, const ewa_photo_state *photo, uint32_t point) {
    const ewa_camera *camera = &photo->photo->camera;
    const double *m = photo->world_to_camera;
    double at[3], origin[3], p[3] = {m[3], m[7], m[11]};
    ewa_cloud_origin(job->cloud, origin);
    ewa_attribute_read_f64(ewa_cloud_find(job->cloud, EWA_POSITION), point, 1, at);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) p[r] += m[4 * r + c] * (at[c] + origin[c]);
    const double depth = camera->projection == EWA_ORTHOGRAPHIC ? 1 : p[2];
    return ewa_photo_radius2(camera, camera->fx_px * p[0] / depth + camera->cx_px, camera->fy_px * p[1] / depth + camera->cy_px);
}

static void keep_sample(ewa_photos_job *job, ewa_photo_state *photo, uint32_t point, const double sum[4]) {
    if (!(sum[0] > MIN_SEEN_PX)) return;
    ewa_photo_sample *to = &photo->samples[photo->sample_count++];
    *to = (ewa_photo_sample){.point = point, .weight = (float)sum[0]};
    if (job->options.vignetting) to->radius2 = (float)radius2_of(job, photo, point);
    const double vignette = ewa_photo_vignette(job->vignetting, (double)to->radius2);
    for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) to->color[c] = (float)(sum[c + 1] / sum[0] * vignette);
    job->counts[point]++;
}

/// Keeps what a photograph says of the points that it sees, of which `sums` tells.
static ewa_status keep_samples(ewa_photos_job *job, ewa_photo_state *photo, const double *sums) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < job->point_count; i++) count += sums[4 * (size_t)i] > MIN_SEEN_PX;
    photo->report.point_count = count;
    photo->sample_count = 0;
    if (count == 0)
        ewa_report(job->context, EWA_SEVERITY_WARNING, "%s: photograph %u sees none of the points",
                   photo->photo->path ? photo->photo->path : "photos", photo->number);
    if (count == 0 || photo->held_out) return EWA_OK;
    photo->samples = ewa_allocate(job->context, count, sizeof *photo->samples);
    if (!photo->samples) return EWA_ERROR_MEMORY;
    // Points that tell exposures first.
    const uint32_t step = ewa_exposure_stride(job->point_count);
    for (int others = 0; others < (step > 1 ? 2 : 1); others++) {
        for (uint32_t i = 0; i < job->point_count; i++)
            if ((i % step > 0) == others) keep_sample(job, photo, i, sums + 4 * (size_t)i);
        if (!others) photo->telling_count = photo->sample_count;
    }
    return EWA_OK;
}

/// Opens the view of a photograph.
static ewa_status look(ewa_photos_job *job, ewa_photo_state *photo, const char *stage, double fraction, ewa_photo_view *view) {
    EWA_TRY(ewa_progress(job->context, stage, fraction));
    return ewa_photo_view_make(job, photo, view);
}

static ewa_status sample(ewa_photos_job *job, ewa_photo_state *photo, double fraction, double *found, double *sums) {
    ewa_photo_view view;
    EWA_TRY(look(job, photo, "photos: samples", fraction, &view));
    float *rgba = ewa_allocate_zeroed(job->context, (size_t)view.pixel_count * 4, sizeof *rgba);
    ewa_status status = rgba ? add_up(job, &view, rgba, found, sums) : EWA_ERROR_MEMORY;
    ewa_release(job->context, rgba, (size_t)view.pixel_count * 4, sizeof *rgba);
    ewa_photo_view_free(&view);
    return status == EWA_OK ? keep_samples(job, photo, sums) : status;
}

static ewa_status sample_all(ewa_photos_job *job, double begin, double end) {
    const size_t points = job->point_count;
    double *room = ewa_allocate(job->context, points * 7, sizeof *room);
    ewa_status status = room ? EWA_OK : EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < job->photo_count && status == EWA_OK; i++)
        status = sample(job, &job->photos[i], begin + (end - begin) * i / job->photo_count, room, room + 3 * points);
    ewa_release(job->context, room, points * 7, sizeof *room);
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

static void compare_piece(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const ewa_photo_match *at = data;
    const uint32_t begin = index * EWA_PHOTO_PIECE;
    for (uint32_t i = begin; i < begin + EWA_PHOTO_PIECE && i < at->view->pixel_count; i++) {
        double shown[EWA_PHOTO_CHANNELS], color[EWA_PHOTO_CHANNELS], weight, square = 0;
        ewa_photo_match_get(at, i, shown, color, &weight);
        for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) {
            const double wanted = at->photo->gain[c] * color[c] + at->photo->offset[c];
            const double difference =
                ewa_srgb_encode(ewa_color_clamp01(shown[c])) - ewa_srgb_encode(ewa_color_clamp01(wanted));
            square += difference * difference / EWA_PHOTO_CHANNELS;
        }
        float *to = at->shown + 4 * (size_t)i;
        to[0] = (float)weight, to[1] = (float)(weight * square), to[2] = 0;
        to[3] = weight > 0 ? (float)square : -1;
    }
}

/// Compares a view, whose points' picture becomes weight, weighted square of what is missing (mean over the channels, sRGB), 0,
/// and the square where the pixel counts, else -1; adds to the residuals of its points, [point][3]: weights, weighted squares, nothing.
static ewa_status compare(ewa_photo_match *at, double *residuals, error_sums *errors) {
    enum { STEPS = 12, WIDE_STEPS = 4 };
    const ewa_photos_job *job = at->job;
    ewa_photo_state *photo = at->photo;
    const ewa_photo_view *view = at->view;
    const uint32_t pose_steps = job->options.pose_steps * job->options.rounds;
    EWA_TRY(ewa_photo_match_refine(at, photo->held_out ? STEPS : 0, WIDE_STEPS, photo->held_out ? pose_steps : 0));
    ewa_parallel(job->context, compare_piece, at, (view->pixel_count + EWA_PHOTO_PIECE - 1) / EWA_PHOTO_PIECE);
    double square = 0;
    uint64_t rejected = 0, count = 0;
    for (size_t i = 0; i < view->pixel_count; i++) {
        const double here = (double)at->shown[4 * i + 3];
        if (here < 0) continue;
        square += here, count++;
        rejected += here > job->options.robust * job->options.robust;
    }
    if (!photo->held_out) EWA_TRY(ewa_photo_view_gather(view, at->shown, residuals));
    photo->report.width_px = view->camera.width_px, photo->report.height_px = view->camera.height_px;
    photo->report.pixel_count = count;
    photo->report.rms = count ? sqrt(square / (double)count) : 0;
    photo->report.rejected = job->options.robust > 0 && count ? (double)rejected / (double)count : 0;
    errors->square[photo->held_out] += square, errors->count[photo->held_out] += count;
    return EWA_OK;
}

static double decibels(double rms) { return -20 * log10(rms); }

static ewa_status compare_one(ewa_photos_job *job, ewa_photo_state *photo, double fraction, double *residuals,
                              error_sums *errors) {
    ewa_photo_view view;
    EWA_TRY(look(job, photo, "photos: comparison", fraction, &view));
    const size_t size = (size_t)view.pixel_count * 4;
    ewa_photo_match at = {job, &view, photo, ewa_allocate(job->context, size, sizeof *at.shown)};
    const ewa_status status = at.shown ? compare(&at, residuals, errors) : EWA_ERROR_MEMORY;
    ewa_release(job->context, at.shown, size, sizeof *at.shown);
    ewa_photo_view_free(&view);
    return status;
}

static ewa_status compare_all(ewa_photos_job *job, double begin, double *residuals, ewa_photos_report *report) {
    error_sums sums = {.square = {0}};
    for (uint32_t i = 0; i < job->photo_count; i++) {
        ewa_photo_state *photo = &job->photos[i];
        EWA_TRY(compare_one(job, photo, begin + (1 - begin) * i / job->photo_count, residuals, &sums));
        memcpy(photo->report.gain, photo->gain, sizeof photo->gain);
        memcpy(photo->report.offset, photo->offset, sizeof photo->offset);
        memcpy(photo->report.world_to_camera, photo->world_to_camera, sizeof photo->world_to_camera);
        photo->report.held_out = photo->held_out;
        photo->report.psnr_db = photo->report.pixel_count ? decibels(photo->report.rms) : NAN;
        ++*(photo->held_out ? &report->held_out_count : &report->used_count);
    }
    report->rms = sums.count[0] ? sqrt(sums.square[0] / (double)sums.count[0]) : 0;
    report->held_out_rms = sums.count[1] ? sqrt(sums.square[1] / (double)sums.count[1]) : 0;
    memcpy(report->vignetting, job->vignetting, sizeof report->vignetting);
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
            residual[i] = residuals[3 * i] > 0 ? (float)sqrt(residuals[3 * i + 1] / residuals[3 * i]) : 0;
    }
    ewa_release(context, color, count * components, sizeof *color);
    return status;
}

/// Frees what photographs say of points, which only settling asks for.
static void drop_samples(ewa_photos_job *job) {
    const uint64_t count = job->samples ? job->sample_starts[job->point_count] : 0;
    ewa_release(job->context, job->samples, count, sizeof *job->samples);
    ewa_release(job->context, job->sample_photos, count, sizeof *job->sample_photos);
    job->samples = NULL, job->sample_photos = NULL;
    for (uint32_t i = 0; job->photos && i < job->photo_count; i++) {
        ewa_photo_state *photo = &job->photos[i];
        ewa_release(job->context, photo->samples, photo->report.point_count, sizeof *photo->samples);
        photo->samples = NULL;
    }
}

/// Finds colours by the poses that there are, and better poses by these. Progress goes from `begin` to `end`.
static ewa_status find_colors(ewa_photos_job *job, double *alpha, double begin, double end) {
    const double sampled = begin + SAMPLED * (end - begin), exposed = begin + EXPOSED * (end - begin);
    read_colors(job, alpha);
    memset(job->counts, 0, job->point_count * sizeof *job->counts);
    EWA_TRY(sample_all(job, begin, sampled));
    EWA_TRY(list_samples(job));
    EWA_TRY(ewa_photos_alternate(job, sampled, exposed));
    drop_samples(job);
    return job->options.method == EWA_PHOTOS_FIT ? ewa_photos_fit(job, exposed, end) : EWA_OK;
}

static ewa_status run(ewa_photos_job *job, double *alpha, double *residuals, ewa_photos_report *report) {
    // By other poses photographs show other colours of the points: medians by false ones are blurred.
    const int count = job->options.method == EWA_PHOTOS_FIT && job->options.pose_steps ? 2 : 1;
    for (int i = 0; i < count; i++) EWA_TRY(find_colors(job, alpha, FITTED * i / count, FITTED * (i + 1) / count));
    EWA_TRY(compare_all(job, FITTED, residuals, report));
    EWA_TRY(ewa_progress(job->context, "photos: comparison", 1));
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
    double *residuals = ewa_allocate_zeroed(context, 3 * points, sizeof *residuals);
    ewa_status status = EWA_ERROR_MEMORY;
    if (job->photos && job->color && job->counts && job->sample_starts && alpha && residuals) {
        for (uint32_t i = 0; i < job->photo_count; i++) {
            ewa_photo_state *photo = &job->photos[i];
            *photo = (ewa_photo_state){.photo = &photos[i], .number = i, .halvings = UINT32_MAX};
            memcpy(photo->world_to_camera, photos[i].camera.world_to_camera, sizeof photo->world_to_camera);
            photo->held_out = job->options.hold_out && i % job->options.hold_out == 0;
            for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) photo->gain[c] = 1;
        }
        qsort(job->photos, job->photo_count, sizeof *job->photos, compare_photos);
        status = run(job, alpha, residuals, report);
    }
    drop_samples(job);
    for (uint32_t i = 0; status == EWA_OK && per_photo && i < job->photo_count; i++)
        per_photo[job->photos[i].number] = job->photos[i].report;
    ewa_release(context, job->photos, job->photo_count, sizeof *job->photos);
    ewa_release(context, job->color, points * EWA_PHOTO_CHANNELS, sizeof *job->color);
    ewa_release(context, job->counts, points, sizeof *job->counts);
    ewa_release(context, job->sample_starts, points + 1, sizeof *job->sample_starts);
    ewa_release(context, alpha, points, sizeof *alpha);
    ewa_release(context, residuals, 3 * points, sizeof *residuals);
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
    if (job.options.pose_steps && job.options.method != EWA_PHOTOS_FIT)
        return ewa_fail(job.context, EWA_ERROR_ARGUMENT, "photos: pose_steps is %u, and poses are refined by the method fit alone",
                        job.options.pose_steps);
    if (job.options.hold_out == 1)
        return ewa_fail(job.context, EWA_ERROR_ARGUMENT, "photos: hold_out is 1, which leaves no photograph to use");
    job.point_count = (uint32_t)points;
    ewa_surfels_options surfels;
    ewa_surfels_options_init(&surfels, sizeof surfels);
    surfels.cutoff = job.options.cutoff;
    EWA_TRY(ewa_surfels_create_kept(cloud, &surfels, &job.surfels));
    ewa_photos_report made = {.used_count = 0};
    ewa_gather_room room = {.state = NULL};
    job.room = &room;
    const ewa_status status = start(&job, photos, &made, per_photo);
    ewa_gather_room_free(job.context, &room);
    ewa_surfels_destroy(&job.surfels);
    if (status == EWA_OK && report) *report = made;
    return status;
}
