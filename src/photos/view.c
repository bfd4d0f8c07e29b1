// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One photograph: which points show at which of its pixels, and how much. Weights are the derivative of the picture by
// the points' colours (docs/math.md section 15), so that what is hidden for the renderer is hidden here.
#include "cloud/cloud.h"
#include "ewa/prepare.h"
#include "image/srgb.h"
#include "photos/parts.h"
#include "reference/adjoint_rows.h"
#include "reference/contour.h"
#include "tiling/bin.h"
#include "tiling/tiles.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    TILE_PX = 32,
    MAX_HALVINGS = 12,
    OCTAVE_BINS = 16, ///< of spacings
    OCTAVES = 64,
    BIN_COUNT = OCTAVES * OCTAVE_BINS,
};

/// Pixels that show less of the nearest surface show something behind it too.
static const double FULL = 0.99;
/// Sides of the range of a photograph's numbers: what is clipped may have been any number beyond.
static const float DARK_SRGB = 1 / 255.0f, BRIGHT_SRGB = 254 / 255.0f, CLIPPED_WEIGHT = 0.1f;

/// What a tile has found, in its part of what all tiles share.
typedef struct tile_rows {
    uint64_t entry_begin, entry_count;
    uint32_t pixel_begin, pixel_count;
} tile_rows;

/// A pixel of a tile: where it is and how many entries it has.
typedef struct pixel_row {
    uint32_t index, entry_count;
} pixel_row;

typedef struct view_job {
    ewa_context *context;
    ewa_reference_frame frame;
    ewa_tiles tiles;
    ewa_bin_lists lists;
    ewa_reference_rows *rows; ///< [worker]
    uint32_t worker_count;
    tile_rows *found;   ///< [tile]
    pixel_row *pixels;  ///< [pixel of the picture], those of a tile together
    uint64_t *bounds;   ///< [worker][tile]: pixels in the boxes of splats
    ewa_photo_view *view;
    const ewa_image *image;
    double fraction; ///< of the call that is done: its progress meanwhile
    uint64_t *histograms; ///< [worker][BIN_COUNT]
} view_job;

static ewa_status open_frame(const ewa_cloud *cloud, const ewa_camera *camera, double unit_coverage,
                             const ewa_photos_options *options, ewa_reference_frame *frame) {
    ewa_render_options render;
    ewa_surfels_options surfels;
    ewa_render_options_init(&render, sizeof render);
    ewa_surfels_options_init(&surfels, sizeof surfels);
    render.shading = EWA_SHADING_NONE;
    render.edge_layers = 1; // what is behind the nearest surface is not asked for
    surfels.cutoff = options->cutoff;
    EWA_TRY(ewa_reference_frame_make(cloud, &surfels, unit_coverage, camera, &render, frame));
    ewa_reference_view_contours(&frame->options, frame->resolve.layering.transparent, &frame->view);
    return EWA_OK;
}

/// How far the neighbours of a surfel are, in pixels.
static double spacing_of(const ewa_reference_view *view, const ewa_reference_splat *splat) {
    const double sigma = sqrt(vec3_length(splat->axis_u) * vec3_length(splat->axis_v));
    const double scale = 0.5 * (view->fx_px + view->fy_px) / (view->orthographic ? 1 : splat->center.z);
    return sigma * view->cutoff / EWA_DEFAULT_RADIUS_SCALE * scale;
}

static void measure_piece(void *data, uint32_t index, uint32_t worker) {
    const view_job *job = data;
    const uint64_t begin = (uint64_t)index * EWA_PHOTO_PIECE, count = job->frame.point_count;
    for (uint64_t i = begin; i < begin + EWA_PHOTO_PIECE && i < count; i++) {
        ewa_surfel surfel;
        ewa_reference_splat splat;
        ewa_reference_frame_project(&job->frame, i, 1, &surfel, &splat);
        if (ewa_reference_tiles_of(&splat, TILE_PX).end == 0 || splat.by_rays) continue;
        int exponent;
        const double part = frexp(spacing_of(&job->frame.view, &splat), &exponent);
        const int bin = (exponent + OCTAVES / 2) * OCTAVE_BINS + (int)((part - 0.5) * 2 * OCTAVE_BINS);
        if (bin >= 0 && bin < BIN_COUNT) job->histograms[(size_t)worker * BIN_COUNT + (size_t)bin]++;
    }
}

/// How often a photograph can be halved: its points stay at least `spacing_px` apart, in the median.
static ewa_status find_halvings(view_job *job, double spacing_px, uint32_t *halvings) {
    *halvings = 0;
    if (spacing_px <= 0) return EWA_OK;
    const size_t size = (size_t)job->worker_count * BIN_COUNT;
    job->histograms = ewa_allocate_zeroed(job->context, size, sizeof *job->histograms);
    if (!job->histograms) return EWA_ERROR_MEMORY;
    ewa_parallel(job->context, measure_piece, job,
                 (uint32_t)((job->frame.point_count + EWA_PHOTO_PIECE - 1) / EWA_PHOTO_PIECE));
    uint64_t sums[BIN_COUNT] = {0}, total = 0, below = 0;
    for (size_t i = 0; i < size; i++) sums[i % BIN_COUNT] += job->histograms[i], total += job->histograms[i];
    ewa_release(job->context, job->histograms, size, sizeof *job->histograms);
    int bin = 0;
    while (bin < BIN_COUNT && 2 * (below += sums[bin]) < total) bin++;
    double median = total ? ldexp(0.5 + 0.5 * (bin % OCTAVE_BINS) / OCTAVE_BINS, bin / OCTAVE_BINS - OCTAVES / 2) : 0;
    for (; median >= 2 * spacing_px && *halvings < MAX_HALVINGS; median /= 2) ++*halvings;
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

/// Adds the pixels of a splat's box to those of its tiles: no tile has more entries.
static void add_bounds(const view_job *job, const ewa_reference_splat *splat, ewa_reference_tiles range, uint64_t *bounds) {
    for (uint32_t row = range.first >> 16; row < range.end >> 16; row++)
        for (uint32_t column = range.first & 0xffff; column < (range.end & 0xffff); column++) {
            const int32_t x = (int32_t)(column * TILE_PX), y = (int32_t)(row * TILE_PX);
            const int32_t x0 = splat->x_begin > x ? splat->x_begin : x, y0 = splat->y_begin > y ? splat->y_begin : y;
            const int32_t x1 = splat->x_end < x + TILE_PX ? splat->x_end : x + TILE_PX;
            const int32_t y1 = splat->y_end < y + TILE_PX ? splat->y_end : y + TILE_PX;
            bounds[row * job->tiles.columns + column] += (uint64_t)(x1 - x0) * (uint64_t)(y1 - y0);
        }
}

static uint32_t find_splats(const void *data, uint32_t worker, uint32_t first, uint32_t count,
                            const ewa_bin_items *items) {
    const view_job *job = data;
    uint64_t *bounds = job->bounds + (size_t)worker * ewa_tiles_count(&job->tiles);
    uint32_t next = first;
    for (uint32_t i = first; i < first + count; i++) {
        ewa_surfel surfel;
        ewa_reference_splat splat;
        ewa_reference_frame_project(&job->frame, i, 1, &surfel, &splat);
        const ewa_reference_tiles range = ewa_reference_tiles_of(&splat, TILE_PX);
        if (range.end == 0) continue;
        add_bounds(job, &splat, range, bounds);
        items->ids[next] = (int32_t)i, items->first[next] = (int32_t)range.first, items->end[next] = (int32_t)range.end;
        next++;
    }
    return next - first;
}

/// A tile in the works.
typedef struct tile_work {
    view_job *job;
    ewa_reference_rows *rows;
    tile_rows *found;
    const uint32_t *points;
} tile_work;

/// Whether a photograph says anything at a pixel: where it is not transparent, and its numbers are.
static bool is_photographed(const ewa_image *image, size_t index) {
    const float *at = image->pixels + index * image->channel_count;
    bool good = image->channel_count != 4 || at[3] > 0.999f;
    for (uint32_t c = 0; c < image->channel_count; c++) good = good && isfinite(at[c]);
    return good;
}

/// Adds the entries of a pixel, if a surface fills it; an ewa_reference_pixel.
static void add_pixel(void *user, uint32_t x, uint32_t y, ewa_reference_fragment *fragments, uint32_t count) {
    tile_work *work = user;
    const ewa_reference_resolve *to = &work->job->frame.resolve;
    const size_t index = (size_t)y * work->job->tiles.width_px + x;
    tile_rows *found = work->found;
    if (count == 0 || !is_photographed(work->job->image, index)) return;
    ewa_reference_layer *layers = work->rows->layers;
    if (ewa_reference_layers_find(to, x + 0.5, y + 0.5, fragments, count, layers) == 0 || layers[0].alpha < FULL) return;
    const double whole = 1 / layers[0].alpha; // rows of the matrix have the sum 1
    const ewa_reference_values cotangent = {.rgba = {whole, whole, whole, 0}};
    double camera[EWA_CAMERA_NUMBERS] = {0};
    ewa_reference_layers_pull_back(to, x + 0.5, y + 0.5, &cotangent, layers, 1, camera);
    pixel_row *row = work->job->pixels + found->pixel_begin + found->pixel_count++;
    ewa_photo_entry *entries = work->job->view->entries + found->entry_begin + found->entry_count;
    *row = (pixel_row){(uint32_t)index, 0};
    for (uint32_t i = 0; i < count; i++) {
        const ewa_reference_fragment *from = &fragments[i];
        if (from->layer != 0) continue;
        const ewa_reference_gathered *of = &layers[0].cotangent;
        const double by_color = from->splat->is_back ? of->is_back.color.x : of->facing.color.x;
        const double weight = from->sample.weight * (to->layering.transparent ? from->splat->opacity : 1) * by_color;
        if (weight > 0) entries[row->entry_count++] = (ewa_photo_entry){work->points[from->index], (float)weight};
    }
    found->entry_count += row->entry_count;
}

static void find_tile(void *data, uint32_t index, uint32_t worker) {
    view_job *job = data;
    const ewa_tile_rect place = ewa_tiles_rect(&job->tiles, index);
    const uint64_t first = job->lists.starts[index];
    const uint32_t count = (uint32_t)(job->lists.starts[index + 1] - first);
    if (count == 0) return;
    tile_work work = {job, &job->rows[worker], &job->found[index], job->lists.ids + first};
    ewa_reference_rows_fill(&job->frame, work.rows, work.points, count);
    for (uint32_t y = place.y_px; y < place.y_px + place.height_px && ewa_goes_on(job->context, worker); y++)
        ewa_reference_rows_walk(&job->frame, work.rows, count, place.x_px, place.width_px, y, add_pixel, &work);
}

/// What a pixel of a photograph shows.
static ewa_photo_pixel read_pixel(const ewa_image *image, size_t index) {
    const float *at = image->pixels + index * image->channel_count;
    ewa_photo_pixel pixel = {.weight = 1};
    for (uint32_t c = 0; c < EWA_PHOTO_CHANNELS; c++) {
        pixel.color[c] = at[image->channel_count < 3 ? 0 : c];
        const float srgb = ewa_srgb_from_linear(pixel.color[c]);
        if (srgb < DARK_SRGB || srgb > BRIGHT_SRGB) pixel.weight = CLIPPED_WEIGHT;
    }
    return pixel;
}

/// Moves what tiles have found together, and reads its pixels.
static void close_up(view_job *job) {
    ewa_photo_view *view = job->view;
    uint64_t next = 0;
    uint32_t pixel = 0;
    for (uint32_t i = 0; i < ewa_tiles_count(&job->tiles); i++) {
        const tile_rows *found = &job->found[i];
        if (found->entry_count)
            memmove(view->entries + next, view->entries + found->entry_begin, found->entry_count * sizeof *view->entries);
        for (uint32_t k = 0; k < found->pixel_count; k++) {
            const pixel_row *row = &job->pixels[found->pixel_begin + k];
            view->pixels[pixel] = read_pixel(job->image, row->index);
            view->row_starts[pixel++] = next;
            next += row->entry_count;
        }
    }
    view->row_starts[pixel] = next;
}

/// Lists the entries of each point, by the pixels' order.
static void turn(ewa_photo_view *view) {
    uint64_t *starts = view->point_starts; // of the point before, until all are placed
    memset(starts, 0, ((size_t)view->point_count + 1) * sizeof *starts);
    const uint64_t count = view->row_starts[view->pixel_count];
    for (uint64_t i = 0; i < count; i++) starts[view->entries[i].index + 1]++;
    for (uint32_t i = 0; i < view->point_count; i++) starts[i + 1] += starts[i];
    for (uint32_t row = view->pixel_count; row-- > 0;)
        for (uint64_t i = view->row_starts[row + 1]; i-- > view->row_starts[row];) {
            const ewa_photo_entry *from = &view->entries[i];
            view->by_point[--starts[from->index + 1]] = (ewa_photo_entry){row, from->weight};
        }
    // Each start has moved from its point's end to its begin: one place too far up.
    memmove(starts, starts + 1, view->point_count * sizeof *starts);
    starts[view->point_count] = count;
}

/// Gathers what the tiles have found.
static ewa_status gather(view_job *job) {
    ewa_photo_view *view = job->view;
    for (uint32_t i = 0; i < ewa_tiles_count(&job->tiles); i++) view->pixel_count += job->found[i].pixel_count;
    view->pixels = ewa_allocate(job->context, view->pixel_count, sizeof *view->pixels);
    view->row_starts = ewa_allocate_zeroed(job->context, (size_t)view->pixel_count + 1, sizeof *view->row_starts);
    view->point_starts = ewa_allocate(job->context, (size_t)view->point_count + 1, sizeof *view->point_starts);
    if (!view->pixels || !view->row_starts || !view->point_starts) return EWA_ERROR_MEMORY;
    close_up(job);
    view->by_point = ewa_allocate(job->context, view->row_starts[view->pixel_count], sizeof *view->by_point);
    if (!view->by_point) return EWA_ERROR_MEMORY;
    turn(view);
    return EWA_OK;
}

/// Makes room for what tiles may find. Tasks cannot: memory comes from the thread that calls the library.
static ewa_status reserve(view_job *job) {
    ewa_context *context = job->context;
    const uint32_t tile_count = ewa_tiles_count(&job->tiles);
    uint64_t entries = 0;
    uint32_t pixels = 0;
    job->rows = ewa_allocate_zeroed(context, job->worker_count, sizeof *job->rows);
    job->found = ewa_allocate_zeroed(context, tile_count, sizeof *job->found);
    job->pixels = ewa_allocate(context, (size_t)job->tiles.width_px * job->tiles.height_px, sizeof *job->pixels);
    if (!job->rows || !job->found || !job->pixels) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < tile_count; i++) {
        const ewa_tile_rect place = ewa_tiles_rect(&job->tiles, i);
        job->found[i] = (tile_rows){.entry_begin = entries, .pixel_begin = pixels};
        for (uint32_t worker = 0; worker < job->worker_count; worker++)
            entries += job->bounds[(size_t)worker * tile_count + i];
        pixels += place.width_px * place.height_px;
    }
    job->view->entry_capacity = entries;
    job->view->entries = ewa_allocate(context, entries, sizeof *job->view->entries);
    if (!job->view->entries) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < job->worker_count; i++)
        EWA_TRY(ewa_reference_rows_reserve(context, &job->rows[i], (uint32_t)job->lists.largest,
                                          job->frame.resolve.layering.most, TILE_PX));
    return EWA_OK;
}

static ewa_status find_rows(view_job *job) {
    ewa_context *context = job->context;
    job->tiles = ewa_tiles_make(job->view->width_px, job->view->height_px, TILE_PX);
    job->bounds = ewa_allocate_zeroed(context, (size_t)job->worker_count * ewa_tiles_count(&job->tiles),
                                      sizeof *job->bounds);
    if (!job->bounds) return EWA_ERROR_MEMORY;
    EWA_TRY(ewa_bin_lists_fill(context, &job->lists, job->tiles.columns, job->tiles.rows, job->view->point_count,
                               find_splats, job));
    EWA_TRY(reserve(job));
    EWA_TRY(ewa_parallel_within(context, "photos", job->fraction, job->fraction, find_tile, job,
                                ewa_tiles_count(&job->tiles)));
    return gather(job);
}

static void release(view_job *job) {
    for (uint32_t i = 0; job->rows && i < job->worker_count; i++) ewa_reference_rows_free(job->context, &job->rows[i]);
    const size_t tile_count = job->tiles.side_px ? ewa_tiles_count(&job->tiles) : 0;
    ewa_release(job->context, job->rows, job->worker_count, sizeof *job->rows);
    ewa_release(job->context, job->found, tile_count, sizeof *job->found);
    ewa_release(job->context, job->bounds, job->worker_count * tile_count, sizeof *job->bounds);
    ewa_release(job->context, job->pixels, (size_t)job->tiles.width_px * job->tiles.height_px, sizeof *job->pixels);
    ewa_bin_lists_free(job->context, &job->lists);
}

/// Takes the picture of a photograph, or reads it; `*owned`: it is to be freed.
static ewa_status take_image(ewa_context *context, const ewa_photo *photo, uint32_t number, ewa_image *image, bool *owned) {
    char name[32];
    snprintf(name, sizeof name, "photograph %u", number);
    const char *subject = photo->path ? photo->path : name;
    *owned = false;
    if (!photo->image && !photo->path)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: has neither a path nor an image", subject);
    if (photo->image) {
        *image = *photo->image;
        image->context = context; // a caller's may have none
    } else {
        EWA_TRY(ewa_image_load(context, photo->path, image));
        *owned = true;
    }
    const ewa_camera *camera = &photo->camera;
    ewa_status status = EWA_OK;
    if (!image->pixels || image->width_px != camera->width_px || image->height_px != camera->height_px)
        status = ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: is %u x %u pixels, and its camera is of %u x %u", subject,
                          image->width_px, image->height_px, camera->width_px, camera->height_px);
    else if (image->channel_count != 1 && image->channel_count != 3 && image->channel_count != 4)
        status = ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: has %u channels; 1, 3 or 4 are needed", subject,
                          image->channel_count);
    if (status == EWA_OK && photo->lens.model != EWA_LENS_PINHOLE) {
        ewa_image pinhole;
        status = ewa_image_undistort(image, camera, &photo->lens, &pinhole);
        if (*owned) ewa_image_free(image);
        *image = pinhole, *owned = status == EWA_OK;
    }
    if (status != EWA_OK && *owned) ewa_image_free(image);
    return status;
}

/// With the picture at hand.
static ewa_status make(view_job *job, const ewa_cloud *cloud, ewa_camera camera, double unit_coverage,
                       const ewa_photos_options *options, uint32_t *halvings, ewa_image *image, bool *owned) {
    job->worker_count = ewa_context_worker_count(job->context);
    EWA_TRY(open_frame(cloud, &camera, unit_coverage, options, &job->frame));
    if (*halvings == UINT32_MAX) EWA_TRY(find_halvings(job, options->spacing_px, halvings));
    if (*halvings > 0) {
        EWA_TRY(halve_often(job->context, *halvings, &camera, image, owned));
        EWA_TRY(open_frame(cloud, &camera, unit_coverage, options, &job->frame));
    }
    job->image = image;
    job->view->width_px = camera.width_px, job->view->height_px = camera.height_px;
    return find_rows(job);
}

ewa_status ewa_photo_view_make(const ewa_cloud *cloud, const ewa_photo *photo, uint32_t number, double unit_coverage,
                               const ewa_photos_options *options, double fraction, uint32_t *halvings,
                               ewa_photo_view *view) {
    ewa_context *context = ewa_cloud_context(cloud);
    *view = (ewa_photo_view){.context = context, .point_count = (uint32_t)ewa_cloud_point_count(cloud)};
    ewa_image image;
    bool owned;
    EWA_TRY(take_image(context, photo, number, &image, &owned));
    view_job job = {.context = context, .view = view, .fraction = fraction};
    const ewa_status status = make(&job, cloud, photo->camera, unit_coverage, options, halvings, &image, &owned);
    release(&job);
    if (owned) ewa_image_free(&image);
    if (status != EWA_OK) ewa_photo_view_free(view);
    return status;
}

void ewa_photo_view_free(ewa_photo_view *view) {
    ewa_context *context = view->context;
    const uint64_t entries = view->row_starts ? view->row_starts[view->pixel_count] : 0;
    ewa_release(context, view->entries, view->entry_capacity, sizeof *view->entries);
    ewa_release(context, view->by_point, entries, sizeof *view->by_point);
    ewa_release(context, view->point_starts, (size_t)view->point_count + 1, sizeof *view->point_starts);
    ewa_release(context, view->row_starts, (size_t)view->pixel_count + 1, sizeof *view->row_starts);
    ewa_release(context, view->pixels, view->pixel_count, sizeof *view->pixels);
    *view = (ewa_photo_view){.context = NULL};
}

/// What a piece of pixels shows.
typedef struct show_job {
    const ewa_photo_view *view;
    const double *color;
    double *shown;
} show_job;

static void show_piece(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const show_job *job = data;
    const uint32_t begin = index * EWA_PHOTO_PIECE;
    for (uint32_t row = begin; row < begin + EWA_PHOTO_PIECE && row < job->view->pixel_count; row++) {
        double sum[EWA_PHOTO_CHANNELS] = {0};
        for (uint64_t i = job->view->row_starts[row]; i < job->view->row_starts[row + 1]; i++) {
            const ewa_photo_entry *entry = &job->view->entries[i];
            const double *color = job->color + (size_t)entry->index * EWA_PHOTO_CHANNELS;
            for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) sum[c] += (double)entry->weight * color[c];
        }
        memcpy(job->shown + (size_t)row * EWA_PHOTO_CHANNELS, sum, sizeof sum);
    }
}

void ewa_photo_view_show(const ewa_photo_view *view, const double *color, double *shown) {
    show_job job = {view, color, shown};
    ewa_parallel(view->context, show_piece, &job, (view->pixel_count + EWA_PHOTO_PIECE - 1) / EWA_PHOTO_PIECE);
}
