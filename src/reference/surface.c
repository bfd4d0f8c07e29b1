// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The reference renderer: three passes over all splats in double precision, one pixel after another. It is
// the definition of what ewa_render() draws; docs/math.md sections 2 to 9 and semantics.h are its
// specification. Based on: M. Zwicker, H. Pfister, J. van Baar, M. Gross, "Surface Splatting", 2001, sections
// 4 and 7; M. Zwicker, J. Rasanen, M. Botsch, C. Dachsbacher, M. Pauly, "Perspective Accurate Splatting",
// 2004, section 6.
#include "reference/surface.h"
#include "base/base.h"
#include "cloud/cloud.h"
#include "image/srgb.h"
#include "reference/contour.h"
#include "reference/layering.h"
#include "reference/shade.h"
#include "reference/sums.h"
#include "surface/options.h"
#include "surface/points.h"
#include "surface/semantics.h"

#include <string.h>

enum {
    PROJECT_POINTS = 4096, ///< surfels per piece of parallel work
    READ_POINTS = 64,      ///< surfels on the stack at a time
    BANDS_PER_WORKER = 4,  ///< pieces of the picture, so that uneven ones level out
};

static const uint64_t NOBODY = UINT64_MAX;

/// What gathers at a pixel: the sums of one surface, and what the surfaces in front of it have become.
typedef struct pixel {
    double bound;     ///< three passes: B(x) = min(z + eps); one pass: z of the nearest splat
    uint64_t nearest; ///< one pass: the splat that wins
    ewa_reference_gathered gathered;
    ewa_reference_sums sums;         ///< what that comes to
    ewa_vec3 shaded;                 ///< straight colour
    double depth;                    ///< of the first surface; +infinity: nothing
    ewa_reference_cover first_cover; ///< of the first surface
    double passed;                   ///< B(x) of the surface before: splats up to there are done
    ewa_vec3 in_front;               ///< premultiplied colour of the surfaces before
    double through;                  ///< the share of the pixel that they leave open
} pixel;

typedef struct reference {
    ewa_reference_view view;
    ewa_surfel_reader reader;
    ewa_render_options options;
    double unit_coverage;
    uint64_t surfel_count;
    ewa_reference_splat *splats;
    uint8_t *materials; ///< [surfel]
    ewa_reference_layering layering;
    uint32_t band_count;
    pixel *pixels;
    ewa_shading_setup shading;
    ewa_frame frame;
} reference;

static void project_piece(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const reference *work = data;
    const uint64_t begin = (uint64_t)index * PROJECT_POINTS, left = work->surfel_count - begin;
    const uint64_t end = begin + (left < PROJECT_POINTS ? left : PROJECT_POINTS);
    ewa_surfel surfels[READ_POINTS];
    bool drawable[READ_POINTS];
    for (uint64_t first = begin; first < end; first += READ_POINTS) {
        const uint64_t count = end - first < READ_POINTS ? end - first : READ_POINTS;
        ewa_surfel_read(&work->reader, first, count, surfels, drawable);
        for (uint64_t i = 0; i < count; i++) {
            if (drawable[i])
                ewa_reference_project(&work->view, &surfels[i], &work->splats[first + i]);
            else
                work->splats[first + i].drawn = false;
            work->materials[first + i] = drawable[i] ? (uint8_t)surfels[i].material : 0;
        }
    }
}

/// Orders two splats of equal depth by what they look like, so that the order of the points cannot decide.
static bool precedes(const ewa_reference_splat *a, const ewa_reference_splat *b) {
    const double left[6] = {a->color.x,        a->color.y,        a->color.z,
                            a->normal_world.x, a->normal_world.y, a->normal_world.z};
    const double right[6] = {b->color.x,        b->color.y,        b->color.z,
                             b->normal_world.x, b->normal_world.y, b->normal_world.z};
    for (int i = 0; i < 6; i++)
        if (left[i] != right[i]) return left[i] < right[i];
    return false;
}

/// Whether what a splat is at a pixel belongs to surfaces that have been made.
static bool has_passed(const pixel *at, const ewa_reference_splat *splat, const ewa_reference_sample *sample) {
    return sample->z <= at->passed || (splat->concave && at->passed > -INFINITY);
}

/// First pass (PAS 6, SS 4): B(x) = min over the splats that count at x of z + eps.
static void lower_bound(const reference *work, pixel *at, uint64_t index,
                        const ewa_reference_sample *sample) {
    const ewa_reference_splat *splat = &work->splats[index];
    if (has_passed(at, splat, sample)) return;
    if (work->options.passes == 3) {
        at->bound = fmin(at->bound, sample->z + splat->epsilon);
    } else if (sample->z < at->bound || (sample->z == at->bound && at->nearest != NOBODY &&
                                         precedes(splat, &work->splats[at->nearest]))) {
        at->bound = sample->z;
        at->nearest = index;
    }
}

/// Second pass: sums over the splats with z <= B(x), or the nearest splat alone.
static void accumulate(const reference *work, pixel *at, uint64_t index, const ewa_reference_sample *sample) {
    const ewa_reference_splat *splat = &work->splats[index];
    if (has_passed(at, splat, sample)) return;
    if (work->options.passes == 3 ? sample->z > at->bound : index != at->nearest) return;
    const ewa_material *m = &work->shading.materials[work->shading.has_table ? work->materials[index] : 0];
    const float numbers[5] = {m->ambient, m->diffuse, m->specular, m->shininess, m->reflection};
    ewa_reference_gather(&at->gathered, splat, sample, work->options.passes == 3 ? sample->weight : 1,
                         work->layering.transparent ? splat->opacity : 1, numbers);
}

typedef void splat_pass(const reference *work, pixel *at, uint64_t index, const ewa_reference_sample *sample);

/// Calls `pass` for every splat that counts at a pixel of rows [y_begin, y_end), in the order of the points.
static void walk(const reference *work, int32_t y_begin, int32_t y_end, splat_pass *pass) {
    const double F = work->view.cutoff;
    for (uint64_t k = 0; k < work->surfel_count; k++) {
        const ewa_reference_splat *splat = &work->splats[k];
        if (!splat->drawn) continue;
        const int32_t first = splat->y_begin > y_begin ? splat->y_begin : y_begin;
        const int32_t last = splat->y_end < y_end ? splat->y_end : y_end;
        for (int32_t y = first; y < last; y++) {
            pixel *row = &work->pixels[(size_t)y * (size_t)work->view.width_px];
            for (int32_t x = splat->x_begin; x < splat->x_end; x++) {
                ewa_reference_sample sample;
                if (ewa_reference_sample_at(&work->view, splat, x + 0.5, y + 0.5, &sample) &&
                    sample.distance2 < F * F)
                    pass(work, &row[x], k, &sample);
            }
        }
    }
}

/// The surface that has gathered at a pixel.
static ewa_reference_surface surface_at(const reference *work, int32_t x, int32_t y) {
    if (x >= work->view.width_px || y >= work->view.height_px) return (ewa_reference_surface){.there = false};
    const pixel *at = &work->pixels[(size_t)y * (size_t)work->view.width_px + (size_t)x];
    return ewa_reference_surface_of(&work->view, &at->sums, x + 0.5, y + 0.5);
}

/// Shades the surface of a pixel, whose neighbours must still have theirs.
static void shade(const reference *work, int32_t x, int32_t y) {
    const ewa_reference_surface at = surface_at(work, x, y);
    if (!at.there) return;
    const ewa_reference_surface beside = surface_at(work, x ^ 1, y), below = surface_at(work, x, y ^ 1);
    work->pixels[(size_t)y * (size_t)work->view.width_px + (size_t)x].shaded =
        ewa_reference_shade(&work->shading, work->options.environment, &at, &beside, &below);
}

/// Writes what belongs to the nearest surface.
static void write_surface(const ewa_frame *frame, size_t index, double depth, ewa_vec3 normal,
                          double coverage) {
    if (frame->depth) frame->depth[index] = (float)depth;
    if (frame->normal) {
        frame->normal[3 * index] = (float)normal.x;
        frame->normal[3 * index + 1] = (float)normal.y;
        frame->normal[3 * index + 2] = (float)normal.z;
    }
    if (frame->coverage) frame->coverage[index] = (float)coverage;
}

/// Whether a layer is all that is left (semantics.h, layers).
static bool is_merged(const reference *work, uint32_t layer) {
    return work->layering.merge_last && layer + 1 == work->layering.max_layers;
}

/// Third pass (SS 7): divide by the weights, shade, cover; then make the pixel ready for the surface behind.
/// Returns whether one could show.
static bool resolve_surface(const reference *work, uint32_t layer, int32_t x, int32_t y) {
    const size_t index = (size_t)y * (size_t)work->view.width_px + (size_t)x;
    pixel *at = &work->pixels[index];
    const ewa_reference_sums *sums = &at->sums;
    const double q = sums->weight;
    double alpha = 0, coverage = 0, depth = INFINITY;
    ewa_vec3 normal = {0, 0, 0};
    if (q > 0) {
        const double length = vec3_length(sums->normal_world);
        if (length > 0) normal = vec3_scale(sums->normal_world, 1 / length);
        depth = sums->z / q;
        coverage = work->options.passes == 3 ? q / work->unit_coverage : 1;
        alpha = 1;
        if (work->options.edge_antialiasing && work->options.passes == 3) {
            const ewa_reference_cover cover = ewa_reference_cover_of(
                &at->gathered, work->unit_coverage, work->options.edge_threshold, is_merged(work, layer));
            alpha = layer == 0 || work->layering.transparent ? cover.share
                                                    : ewa_reference_cover_behind(&at->first_cover, &cover);
            if (layer == 0) at->first_cover = cover;
        }
        if (work->layering.transparent) alpha *= work->options.opacity * sums->opacity / q;
        if (is_merged(work, layer)) alpha = ewa_reference_merged_alpha(alpha, coverage);
        at->in_front = vec3_add(at->in_front, vec3_scale(at->shaded, alpha * at->through));
        at->through *= 1 - alpha;
    }
    if (layer == 0) {
        write_surface(&work->frame, index, depth * work->view.placement.unit, normal, coverage);
        at->depth = depth;
    }
    const bool open = q > 0 && at->through > 0;
    *at = (pixel){.bound = open ? INFINITY : -INFINITY,
                  .nearest = NOBODY,
                  .passed = open ? at->bound : INFINITY,
                  .depth = at->depth,
                  .first_cover = at->first_cover,
                  .in_front = at->in_front,
                  .through = at->through};
    return open;
}

static double depth_of_pixel(const void *pixels, size_t index) {
    const pixel *at = pixels;
    return at[index].depth;
}

/// The share of a pixel's light that eye-dome lighting leaves.
static double eye_dome(const reference *work, size_t index) {
    if (work->options.eye_dome == 0) return 1;
    const ewa_reference_view *view = &work->view;
    const ewa_reference_depths depths = {.width_px = (uint32_t)view->width_px,
                                         .height_px = (uint32_t)view->height_px,
                                         .orthographic = view->orthographic,
                                         .view_height_world = view->height_px / view->fy_px,
                                         .depth = depth_of_pixel,
                                         .data = work->pixels};
    return ewa_reference_eye_dome(&depths, work->options.eye_dome, (uint32_t)(index % depths.width_px),
                                  (uint32_t)(index / depths.width_px));
}

/// Puts the pixel over the background.
static void write_color(const reference *work, size_t index) {
    const pixel *at = &work->pixels[index];
    const ewa_vec3 front = vec3_scale(at->in_front, eye_dome(work, index));
    const float *background = work->options.background;
    const double behind = (double)background[3] * at->through, a = 1 - at->through + behind;
    const double rgb[3] = {front.x + (double)background[0] * behind, front.y + (double)background[1] * behind,
                           front.z + (double)background[2] * behind};
    const ewa_frame *frame = &work->frame;
    if (frame->rgba) {
        for (int c = 0; c < 3; c++) frame->rgba[4 * index + (size_t)c] = (float)rgb[c];
        frame->rgba[4 * index + 3] = (float)a;
    }
    if (frame->rgba8) {
        for (int c = 0; c < 3; c++)
            frame->rgba8[4 * index + (size_t)c] = a > 0 ? ewa_srgb8_from_linear((float)(rgb[c] / a)) : 0;
        frame->rgba8[4 * index + 3] = (uint8_t)(255 * a + 0.5);
    }
}

/// The first row of a piece of the picture: an even one, as shading looks at 2x2 pixels.
static int32_t band_begin(const reference *work, uint32_t index) {
    const int32_t rows = work->view.height_px;
    const int32_t begin = 2 * (int32_t)ewa_split(((uint32_t)rows + 1) / 2, work->band_count, index);
    return begin < rows ? begin : rows;
}

/// All passes over some rows of the picture; no pixel is touched by two pieces.
static void render_band(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const reference *work = data;
    const int32_t begin = band_begin(work, index), end = band_begin(work, index + 1);
    const size_t width = (size_t)work->view.width_px;
    const size_t first_pixel = (size_t)begin * width, end_pixel = (size_t)end * width;
    for (size_t i = first_pixel; i < end_pixel; i++)
        work->pixels[i] = (pixel){.bound = INFINITY, .nearest = NOBODY, .passed = -INFINITY, .through = 1};
    bool open = true;
    for (uint32_t layer = 0; layer < work->layering.max_layers && open; layer++) {
        // The last of so many layers is all that is left: there is no bound then.
        const bool merged = is_merged(work, layer);
        if (!merged) walk(work, begin, end, lower_bound);
        walk(work, begin, end, accumulate);
        for (size_t i = first_pixel; i < end_pixel; i++)
            work->pixels[i].sums =
                ewa_reference_settle(&work->pixels[i].gathered, work->unit_coverage, merged);
        open = false;
        for (int32_t y = begin; y < end; y++)
            for (int32_t x = 0; x < work->view.width_px; x++) shade(work, x, y);
        for (int32_t y = begin; y < end; y++)
            for (int32_t x = 0; x < work->view.width_px; x++) open |= resolve_surface(work, layer, x, y);
    }
}

static void write_band(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const reference *work = data;
    const size_t width = (size_t)work->view.width_px, end = (size_t)band_begin(work, index + 1) * width;
    for (size_t i = (size_t)band_begin(work, index) * width; i < end; i++) write_color(work, i);
}

static ewa_status check_materials(ewa_context *context, const reference *work) {
    uint8_t largest = 0;
    for (uint64_t i = 0; i < work->surfel_count; i++)
        if (work->materials[i] > largest) largest = work->materials[i];
    return ewa_shading_check_materials(context, &work->shading, largest);
}

/// With `work` complete but for the memory: allocates, projects, draws.
static ewa_status render(ewa_context *context, reference *work) {
    const size_t pixel_count = (size_t)work->view.width_px * (size_t)work->view.height_px;
    work->splats = ewa_allocate(context, work->surfel_count, sizeof *work->splats);
    work->materials = ewa_allocate(context, work->surfel_count, sizeof *work->materials);
    work->pixels = ewa_allocate(context, pixel_count, sizeof *work->pixels);
    ewa_status status = work->splats && work->materials && work->pixels ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = ewa_progress(context, "reference", 0);
    if (status == EWA_OK) {
        const uint64_t pieces = (work->surfel_count + PROJECT_POINTS - 1) / PROJECT_POINTS;
        ewa_parallel(context, project_piece, work, (uint32_t)pieces);
        status = check_materials(context, work);
    }
    if (status == EWA_OK) status = ewa_progress(context, "reference", 0.25);
    if (status == EWA_OK) {
        ewa_parallel(context, render_band, work, work->band_count);
        ewa_parallel(context, write_band, work, work->band_count);
        status = ewa_progress(context, "reference", 1);
    }
    ewa_release(context, work->pixels, pixel_count, sizeof *work->pixels);
    ewa_release(context, work->materials, work->surfel_count, sizeof *work->materials);
    ewa_release(context, work->splats, work->surfel_count, sizeof *work->splats);
    return status;
}

/// Averages finer x finer parts of every pixel: colours, coverages and normals; the nearest of their depths.
static void average_parts(const ewa_frame *fine, uint32_t finer, const ewa_camera *camera, const ewa_frame *frame) {
    const size_t width = camera->width_px, parts = (size_t)finer * finer;
    for (size_t i = 0; i < width * camera->height_px; i++) {
        double rgba[4] = {0}, normal[3] = {0}, coverage = 0, nearest = INFINITY;
        for (size_t part = 0; part < parts; part++) {
            const size_t y = i / width * finer + part / finer, x = i % width * finer + part % finer;
            const size_t at = y * width * finer + x;
            for (int c = 0; c < 4; c++) rgba[c] += (double)fine->rgba[4 * at + (size_t)c] / (double)parts;
            for (int c = 0; c < 3; c++) normal[c] += (double)fine->normal[3 * at + (size_t)c];
            coverage += (double)fine->coverage[at] / (double)parts;
            nearest = fmin(nearest, (double)fine->depth[at]);
        }
        const double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
        const double a = fmin(rgba[3], 1);
        for (size_t c = 0; c < 4; c++) {
            if (frame->rgba) frame->rgba[4 * i + c] = (float)rgba[c];
            const double straight = c < 3 && a > 0 ? rgba[c] / a : 0;
            const uint8_t code = c < 3 ? ewa_srgb8_from_linear((float)straight) : (uint8_t)(255 * a + 0.5);
            if (frame->rgba8) frame->rgba8[4 * i + c] = code;
        }
        for (size_t c = 0; c < 3 && frame->normal; c++)
            frame->normal[3 * i + c] = (float)(length > 0 ? normal[c] / length : 0);
        if (frame->coverage) frame->coverage[i] = (float)coverage;
        if (frame->depth) frame->depth[i] = (float)nearest;
    }
}

/// Draws every pixel as so many squared as the options say.
static ewa_status render_parts(const ewa_cloud *cloud, const ewa_surfels_options *surfels_options, double unit_coverage,
                               const ewa_camera *camera, const ewa_render_options *options, const ewa_frame *frame) {
    enum { FLOATS = 4 + 3 + 1 + 1 };
    ewa_context *context = ewa_cloud_context(cloud);
    const uint32_t finer = options->supersampling;
    ewa_render_options plain = *options;
    plain.supersampling = 1, plain.point_size_px *= finer;
    ewa_camera fine = *camera;
    fine.width_px *= finer, fine.height_px *= finer;
    fine.fx_px *= finer, fine.fy_px *= finer, fine.cx_px *= finer, fine.cy_px *= finer;
    const size_t count = (size_t)fine.width_px * fine.height_px;
    float *planes = ewa_allocate(context, count * FLOATS, sizeof *planes);
    if (!planes) return EWA_ERROR_MEMORY;
    const ewa_frame parts = {.rgba = planes,
                             .normal = planes + 4 * count,
                             .depth = planes + 7 * count,
                             .coverage = planes + 8 * count};
    const ewa_status status = ewa_render_reference(cloud, surfels_options, unit_coverage, &fine, &plain, &parts);
    if (status == EWA_OK) average_parts(&parts, finer, camera, frame);
    ewa_release(context, planes, count * FLOATS, sizeof *planes);
    return status;
}

ewa_status ewa_render_reference(const ewa_cloud *cloud, const ewa_surfels_options *surfels_options,
                                double unit_coverage, const ewa_camera *camera,
                                const ewa_render_options *options, const ewa_frame *frame) {
    if (!cloud) return EWA_ERROR_ARGUMENT;
    ewa_context *context = ewa_cloud_context(cloud);
    if (!camera || !frame)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "reference: no %s", camera ? "frame" : "camera");
    if (!(unit_coverage > 0) || !isfinite(unit_coverage))
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "reference: unit_coverage is %g, must be positive",
                        unit_coverage);
    reference work = {
        .unit_coverage = unit_coverage, .surfel_count = ewa_cloud_point_count(cloud), .frame = *frame};
    ewa_surfels_options chosen;
    EWA_TRY(ewa_surfels_options_choose(context, surfels_options, &chosen));
    EWA_TRY(ewa_render_options_choose(context, options, &work.options));
    EWA_TRY(ewa_camera_check(context, camera));
    if (work.options.supersampling > 1)
        return render_parts(cloud, &chosen, unit_coverage, camera, &work.options, frame);
    EWA_TRY(ewa_surfel_reader_open(cloud, &chosen, &work.reader));
    work.layering = ewa_reference_layering_of(&work.options, &work.reader, work.surfel_count);
    if (work.options.point_size_px > 0)
        work.unit_coverage = ewa_point_profile_make(&work.options).unit_coverage;
    ewa_reference_view_make(camera, chosen.cutoff, &work.options, &work.view);
    ewa_bounds box;
    ewa_position_measure(context, work.reader.position, work.surfel_count, &box);
    ewa_reference_view_place(camera, work.reader.origin_world, &box, &work.view);
    ewa_reference_view_contours(&work.options, work.layering.transparent, &work.view);
    ewa_shading_setup_make(&work.options, &work.shading);
    const uint64_t bands = (uint64_t)ewa_context_worker_count(context) * BANDS_PER_WORKER;
    work.band_count = bands < camera->height_px ? (uint32_t)bands : camera->height_px;
    return render(context, &work);
}
