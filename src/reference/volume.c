// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The reference renderer of volumes: every voxel a splat in double precision, composited front to back pixel
// by pixel. It is the definition of what ewa_volume_render() draws; docs/math.md section 12 is its
// specification.
//
// Based on: X. Yuan, M. Nguyen, H. Xu, B. Chen, "Hybrid Forward Resampling and Volume Rendering", 2003,
// section 4; L. Westover, "Footprint Evaluation for Volume Rendering", 1990 (splats composited one by one).
//
// Nothing of src/volume is used here, which this judges: the grid's view, depth units, classification and section
// planes are its own.
#include "reference/volume.h"
#include "base/base.h"
#include "base/options.h"
#include "image/material.h"
#include "image/srgb.h"
#include "image/transfer.h"
#include "math/ellipse.h"
#include "reference/classify.h"
#include "reference/section.h"
#include "reference/shade.h"
#include "surface/options.h"

#include <stdlib.h>
#include <string.h>

enum { BANDS_PER_WORKER = 4 }; ///< pieces of the picture, so that uneven ones level out

static const double PI = 3.14159265358979323846;

/// Beyond so many units a voxel is not drawn.
static const double FARTHEST = 1e17;

/// The grid before the camera, in units of its shortest spacing.
typedef struct view {
    bool orthographic;
    double fx_px, fy_px, cx_px, cy_px; ///< orthographic: pixels per unit
    double unit_camera;                ///< a unit in camera space
    ewa_mat3 axes;                     ///< rows: steps along i, j, k in camera space
    ewa_vec3 origin;                   ///< voxel 0, 0, 0 in camera space
    ewa_mat3 covariance, inverse;      ///< Sigma of every voxel, and Sigma^-1
    double depth_sigma;                ///< sqrt(Sigma33)
    double bend;                       ///< orthographic: by how much the order falls off the axis, 1 / length
    double near;                       ///< perspective: how far a kernel reaches along the axis
    double cutoff, cutoff2, prefilter2_px2;
    double splat_peak; ///< G: optical depth through a voxel's middle per extinction and standard deviation
    double depth_unit, first_far_unit;
} view;

/// A voxel on the screen.
typedef struct splat {
    uint64_t number; ///< of the voxel: decides between equal depths
    ewa_vec3 place;  ///< camera space
    double unit;     ///< number of its depth unit
    bool near;       ///< at the eye: its kernel may reach behind it, where it is no ellipse on the screen
    double distance; ///< by which splats of a depth unit are sorted
    ewa_vec3 color;  ///< shaded
    double extinction;
    double center_px[2];
    double conic[3];       ///< of the filtered ellipse: 1 on its rim
    double unfilter[2][2]; ///< from offsets in the filtered ellipse to those in the true one
    double attenuation;    ///< sqrt(|V| / |V'|)
    double reach_px[2];    ///< half the box of the filtered ellipse
} splat;

typedef struct pixel {
    double color[3], through, depth;
} pixel;

typedef struct reference {
    ewa_volume_options options;
    ewa_camera camera;
    const ewa_volume *volume;
    const ewa_transfer *transfer;
    view grid;
    ewa_shading_setup shading;
    splat *splats;
    uint64_t splat_count;
    pixel *pixels;
    uint32_t band_count;
    ewa_frame frame;
} reference;

/// The number of the depth unit that holds a depth; voxel 0, 0, 0 is in the middle of unit 0.
static double unit_of(const view *grid, double z) {
    return floor((z - grid->origin.z) / grid->depth_unit + 0.5);
}

static view make_view(const ewa_volume *volume, const ewa_camera *camera, const ewa_volume_options *options) {
    const double *m = camera->world_to_camera, *g = volume->index_to_world;
    const double spacing = ewa_reference_spacing(volume), sigma = options->sigma;
    double squares = 0;
    for (int i = 0; i < 11; i++) squares += i % 4 < 3 ? m[i] * m[i] : 0;
    const double scale = sqrt(squares / 3);
    view v = {.orthographic = camera->projection == EWA_ORTHOGRAPHIC,
              .fx_px = camera->fx_px,
              .fy_px = camera->fy_px,
              .cx_px = camera->cx_px,
              .cy_px = camera->cy_px,
              .unit_camera = spacing * scale,
              .cutoff = options->cutoff,
              .cutoff2 = options->cutoff * options->cutoff,
              .prefilter2_px2 = options->prefilter_px * options->prefilter_px};
    if (v.orthographic) v.fx_px *= v.unit_camera, v.fy_px *= v.unit_camera;
    double origin[3], shortest = INFINITY;
    for (int row = 0; row < 3; row++) {
        // Lengths over the spacing first: products might leave the range of doubles. The camera's scale last: voxels
        // that are equally far away stay so.
        const double *r = m + 4 * row;
        for (int axis = 0; axis < 3; axis++)
            v.axes.m[axis][row] = (r[0] * (g[axis] / spacing) + r[1] * (g[4 + axis] / spacing) +
                                   r[2] * (g[8 + axis] / spacing)) *
                                  (1 / scale);
        origin[row] =
            (r[0] * (g[3] / spacing) + r[1] * (g[7] / spacing) + r[2] * (g[11] / spacing) + r[3] / spacing) *
            (1 / scale);
    }
    v.origin = vec3_load(origin);
    for (int axis = 0; axis < 3; axis++) shortest = fmin(shortest, vec3_length(mat3_row(&v.axes, axis)));
    // Sigma = sigma^2 A A', the axes being columns.
    const ewa_mat3 columns = mat3_transpose(&v.axes), product = mat3_multiply(&columns, &v.axes);
    v.covariance = mat3_scale(&product, sigma * sigma);
    const ewa_mat3 adjugate = mat3_adjugate(&v.covariance);
    v.inverse = mat3_scale(&adjugate, 1 / mat3_determinant(&v.covariance));
    v.depth_sigma = sqrt(v.covariance.m[2][2]);
    v.near = v.orthographic ? 0 : v.cutoff * v.depth_sigma;
    v.bend = v.orthographic ? tan(20 * PI / 180) * v.fy_px / camera->height_px : 0;
    // The root of Sigma's determinant is sigma^3 times a voxel's size.
    v.splat_peak = 1 / (2 * PI * sigma * sigma * sigma * (1 - exp(-v.cutoff2 / 2)));
    v.depth_unit = shortest * options->depth_unit;
    // Units in front of it: rays that meet a kernel's rim may do so less than three standard deviations ahead.
    v.first_far_unit = v.orthographic ? -INFINITY : unit_of(&v, v.depth_sigma * sqrt(v.cutoff2 + 9)) + 1;
    return v;
}

static ewa_vec3 shade(const reference *work, const ewa_reference_voxel *voxel, ewa_vec3 place) {
    const ewa_material *m = &work->shading.materials[0];
    const ewa_vec3 marked = {EWA_MARKED_SPLAT_RED, EWA_MARKED_SPLAT_OTHER, EWA_MARKED_SPLAT_OTHER};
    const ewa_vec3 color = work->options.mark_splats ? marked : voxel->color;
    if (!work->shading.lit) return color;
    if (vec3_length(voxel->normal_world) == 0)
        return vec3_scale(color, (double)m->ambient + (double)m->diffuse);
    ewa_vec3 toward = work->grid.orthographic ? vec3_make(0, 0, -1) : vec3_scale(place, -1);
    vec3_normalize(&toward);
    ewa_reference_surface at = {.there = true,
                                .color = color,
                                .normal_world = voxel->normal_world,
                                .ambient = (double)m->ambient,
                                .diffuse = (double)m->diffuse,
                                .specular = (double)m->specular,
                                .shininess = (double)m->shininess};
    const double *rows = work->camera.world_to_camera; // a rotation but for its scale
    at.view_world = vec3_make(rows[0] * toward.x + rows[4] * toward.y + rows[8] * toward.z,
                              rows[1] * toward.x + rows[5] * toward.y + rows[9] * toward.z,
                              rows[2] * toward.x + rows[6] * toward.y + rows[10] * toward.z);
    vec3_normalize(&at.view_world);
    if (vec3_dot(at.normal_world, at.view_world) < 0) at.normal_world = vec3_scale(at.normal_world, -1);
    const ewa_reference_surface nothing = {.there = false};
    return ewa_reference_shade(&work->shading, NULL, &at, &nothing, &nothing);
}

/// V in pixels and the ellipse's centre (docs/math.md section 3, sheared).
static void project(const view *grid, ewa_vec3 p, double v[3], double center_px[2]) {
    const ewa_mat3 *s = &grid->covariance;
    const double fx = grid->fx_px, fy = grid->fy_px;
    if (grid->orthographic) {
        v[0] = s->m[0][0] * fx * fx, v[1] = s->m[0][1] * fx * fy, v[2] = s->m[1][1] * fy * fy;
        center_px[0] = fx * p.x + grid->cx_px, center_px[1] = fy * p.y + grid->cy_px;
        return;
    }
    const double x = p.x / p.z, y = p.y / p.z, k = 1 / (p.z * p.z - grid->cutoff2 * s->m[2][2]);
    const double s13 = s->m[0][2] - x * s->m[2][2], s23 = s->m[1][2] - y * s->m[2][2];
    const double s11 = s->m[0][0] - 2 * x * s->m[0][2] + x * x * s->m[2][2];
    const double s12 = s->m[0][1] - x * s->m[1][2] - y * s->m[0][2] + x * y * s->m[2][2];
    const double s22 = s->m[1][1] - 2 * y * s->m[1][2] + y * y * s->m[2][2];
    double shift[2];
    ewa_ellipse_project((const double[5]){s11, s12, s22, s13, s23}, k, grid->cutoff2, v, shift);
    v[0] *= fx * fx, v[1] *= fx * fy, v[2] *= fy * fy;
    center_px[0] = fx * (x + shift[0]) + grid->cx_px, center_px[1] = fy * (y + shift[1]) + grid->cy_px;
}

/// Lower triangle L with L L' = V.
static void cholesky(const double v[3], double l[3]) {
    l[0] = sqrt(v[0]);
    l[1] = v[1] / l[0];
    l[2] = sqrt(v[2] - l[1] * l[1]);
}

static bool make_splat(const reference *work, const ewa_reference_voxel *voxel, ewa_vec3 place, splat *made) {
    const view *grid = &work->grid;
    // Perspective: nothing of the kernel is ahead of the eye.
    if ((!grid->orthographic && !(place.z > -grid->near)) || !(place.z < FARTHEST)) return false;
    made->place = place;
    made->unit = unit_of(grid, place.z);
    made->near = made->unit < grid->first_far_unit;
    made->distance = grid->orthographic ? place.z + grid->bend * (place.x * place.x + place.y * place.y)
                                        : vec3_length(place);
    made->color = shade(work, voxel, place);
    made->extinction = voxel->extinction * work->options.density_scale;
    if (made->near) {
        made->center_px[0] = made->center_px[1] = 0;
        made->reach_px[0] = made->reach_px[1] = INFINITY;
        return true;
    }
    double v[3], l[3], filtered[3], m[3];
    project(grid, place, v, made->center_px);
    memcpy(filtered, v, sizeof filtered);
    filtered[0] += grid->prefilter2_px2, filtered[2] += grid->prefilter2_px2;
    const double area = v[0] * v[2] - v[1] * v[1];
    const double filtered_area = filtered[0] * filtered[2] - filtered[1] * filtered[1];
    made->attenuation = sqrt(area / filtered_area);
    made->conic[0] = filtered[2] / filtered_area / grid->cutoff2;
    made->conic[1] = -filtered[1] / filtered_area / grid->cutoff2;
    made->conic[2] = filtered[0] / filtered_area / grid->cutoff2;
    made->reach_px[0] = grid->cutoff * sqrt(filtered[0]);
    made->reach_px[1] = grid->cutoff * sqrt(filtered[2]);
    cholesky(v, l);
    cholesky(filtered, m);
    made->unfilter[0][0] = l[0] / m[0], made->unfilter[0][1] = 0;
    made->unfilter[1][0] = (l[1] - l[2] * m[1] / m[2]) / m[0], made->unfilter[1][1] = l[2] / m[2];
    return true;
}

/// How a ray passes a voxel.
typedef struct closest_point {
    double distance2; ///< Mahalanobis distance squared
    double length;    ///< of a standard deviation along the ray
    double ahead;     ///< perspective: where it is nearest, in standard deviations from the eye
} closest_point;

/// The ray through a place on the screen.
static closest_point closest_to(const view *grid, ewa_vec3 p, double x_px, double y_px) {
    ewa_vec3 ray = vec3_make(0, 0, 1), from;
    if (grid->orthographic) {
        from =
            vec3_make((x_px - grid->cx_px) / grid->fx_px - p.x, (y_px - grid->cy_px) / grid->fy_px - p.y, 0);
    } else {
        ray = vec3_make((x_px - grid->cx_px) / grid->fx_px, (y_px - grid->cy_px) / grid->fy_px, 1);
        from = vec3_sub(vec3_scale(ray, p.z), p); // from the voxel to the ray, across the axis
    }
    const double a = vec3_dot(ray, mat3_mul_vec3(&grid->inverse, ray));
    const double b = vec3_dot(ray, mat3_mul_vec3(&grid->inverse, from));
    const double c = vec3_dot(from, mat3_mul_vec3(&grid->inverse, from));
    const double ahead = vec3_dot(ray, mat3_mul_vec3(&grid->inverse, p)) / sqrt(a);
    return (closest_point){c - b * b / a, vec3_length(ray) / sqrt(a), grid->orthographic ? INFINITY : ahead};
}

/// Phi, the share of a normal distribution below t.
static double share_below(double t) { return 0.5 * erfc(-t / sqrt(2)); }

/// The optical depth of a voxel at the eye: what of its kernel lies ahead.
static double optical_depth_near(const reference *work, const splat *at, double x_px, double y_px) {
    const view *grid = &work->grid;
    const closest_point by = closest_to(grid, at->place, x_px, y_px);
    if (by.distance2 >= grid->cutoff2 || by.ahead <= -grid->cutoff) return 0;
    return at->extinction * grid->splat_peak * by.length * exp(-by.distance2 / 2) * share_below(by.ahead);
}

/// The optical depth of a voxel at a pixel's centre; 0 outside of its ellipse.
static double optical_depth(const reference *work, const splat *at, double x_px, double y_px) {
    const view *grid = &work->grid;
    if (at->near) return optical_depth_near(work, at, x_px, y_px);
    const double dx = x_px - at->center_px[0], dy = y_px - at->center_px[1];
    const double i2 = at->conic[0] * dx * dx + 2 * at->conic[1] * dx * dy + at->conic[2] * dy * dy;
    if (i2 >= 1) return 0;
    const double true_x = at->center_px[0] + at->unfilter[0][0] * dx + at->unfilter[0][1] * dy;
    const double true_y = at->center_px[1] + at->unfilter[1][0] * dx + at->unfilter[1][1] * dy;
    closest_point by = closest_to(grid, at->place, true_x, true_y);
    if (work->options.index == EWA_INDEX_TABLE && grid->orthographic) {
        by.distance2 = grid->cutoff2 * i2;
    } else if (work->options.index == EWA_INDEX_TABLE) {
        const double c = vec3_dot(at->place, mat3_mul_vec3(&grid->inverse, at->place));
        by.length = vec3_length(at->place) / sqrt(c);
        by.distance2 = grid->cutoff2 * i2 / (1 - (1 - i2) * grid->cutoff2 / c);
    }
    // All of the kernel is ahead, but for next to nothing.
    return at->extinction * grid->splat_peak * by.length * at->attenuation * exp(-by.distance2 / 2);
}

/// The share of a voxel that lies in front of the surface, and within the section planes.
static double share_in_front(const reference *work, size_t index, double z) {
    const ewa_volume_options *o = &work->options;
    if (!o->surface_depth && !o->section_count) return 1;
    const double unit = work->grid.unit_camera, root = work->grid.depth_sigma * sqrt(2);
    const uint32_t width = work->camera.width_px;
    double enter, leave;
    ewa_reference_cut_ray(&work->camera, (const double(*)[4])o->section_planes, o->section_count,
                          (double)(index % width) + 0.5, (double)(index / width) + 0.5, &enter, &leave);
    if (o->surface_depth) leave = fmin(leave, (double)o->surface_depth[index]);
    return fmax(0.5 * erfc((z - leave / unit) / root) - 0.5 * erfc((z - enter / unit) / root), 0);
}

static void composite(const reference *work, const splat *at, uint32_t y_begin, uint32_t y_end) {
    const double width = work->camera.width_px;
    const double left = fmax(0, ceil(at->center_px[0] - at->reach_px[0] - 0.5));
    const double right = fmin(width, floor(at->center_px[0] + at->reach_px[0] - 0.5) + 1);
    const double top = fmax(y_begin, ceil(at->center_px[1] - at->reach_px[1] - 0.5));
    const double bottom = fmin(y_end, floor(at->center_px[1] + at->reach_px[1] - 0.5) + 1);
    for (double y = top; y < bottom; y++)
        for (double x = left; x < right; x++) {
            const size_t index = (size_t)y * work->camera.width_px + (size_t)x;
            const double t = optical_depth(work, at, x + 0.5, y + 0.5);
            if (t == 0) continue;
            pixel *to = &work->pixels[index];
            const double through = to->through * exp(-t * share_in_front(work, index, at->place.z));
            const double weight = to->through - through;
            to->color[0] += weight * at->color.x;
            to->color[1] += weight * at->color.y;
            to->color[2] += weight * at->color.z;
            if (to->through > 0.5 && through <= 0.5) to->depth = fmax(at->place.z, 0);
            to->through = through;
        }
}

/// Depth, normal and coverage of voxels and surface together: the voxels' depth where they take half of the light in
/// front of the surface, else the surface's.
static void write_geometry(const reference *work, size_t index) {
    const pixel *at = &work->pixels[index];
    const ewa_volume_options *o = &work->options;
    const ewa_frame *frame = &work->frame;
    const double own = o->surface_depth ? (double)o->surface_depth[index] : INFINITY;
    const double voxels = isinf(at->depth) ? INFINITY : at->depth * work->grid.unit_camera;
    const double covered = o->surface_coverage ? (double)o->surface_coverage[index]
                           : o->surface_rgba   ? (double)o->surface_rgba[4 * index + 3]
                                               : 0;
    if (frame->depth) frame->depth[index] = (float)fmin(voxels, own);
    if (frame->coverage) frame->coverage[index] = (float)(covered + (1 - at->through) * fmax(0, 1 - covered));
    for (size_t c = 0; c < 3 && frame->normal; c++)
        frame->normal[3 * index + c] =
            o->surface_normal && own <= voxels ? o->surface_normal[3 * index + c] : 0;
}

static void write_pixel(const reference *work, size_t index) {
    const pixel *at = &work->pixels[index];
    const ewa_frame *frame = &work->frame;
    const float *background = work->options.background, *surface = work->options.surface_rgba;
    double out[4];
    for (int c = 0; c < 4; c++) {
        const double behind = surface ? (double)surface[4 * index + (size_t)c]
                              : c < 3 ? (double)background[c] * (double)background[3]
                                      : (double)background[3];
        out[c] = (c < 3 ? at->color[c] : 1 - at->through) + at->through * behind;
    }
    write_geometry(work, index);
    for (size_t c = 0; c < 4 && frame->rgba; c++) frame->rgba[4 * index + c] = (float)out[c];
    for (size_t c = 0; c < 3 && frame->rgba8; c++)
        frame->rgba8[4 * index + c] = out[3] > 0 ? ewa_srgb8_from_linear((float)(out[c] / out[3])) : 0;
    if (frame->rgba8) frame->rgba8[4 * index + 3] = (uint8_t)(255 * fmin(out[3], 1) + 0.5);
}

/// All splats over some rows of the picture; no pixel is touched by two pieces.
static void render_band(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const reference *work = data;
    const uint32_t height = work->camera.height_px, width = work->camera.width_px;
    const uint32_t begin = (uint32_t)ewa_split(height, work->band_count, index);
    const uint32_t end = (uint32_t)ewa_split(height, work->band_count, index + 1);
    for (size_t i = (size_t)begin * width; i < (size_t)end * width; i++)
        work->pixels[i] = (pixel){.through = 1, .depth = INFINITY};
    for (uint64_t i = 0; i < work->splat_count; i++) {
        const splat *at = &work->splats[i];
        if (at->center_px[1] + at->reach_px[1] > begin && at->center_px[1] - at->reach_px[1] < end)
            composite(work, at, begin, end);
    }
    for (size_t i = (size_t)begin * width; i < (size_t)end * width; i++) write_pixel(work, i);
}

/// By depth unit, then by distance.
static int by_depth(const void *a, const void *b) {
    const splat *left = a, *right = b;
    if (left->unit != right->unit) return left->unit < right->unit ? -1 : 1;
    if (left->distance != right->distance) return left->distance < right->distance ? -1 : 1;
    return left->number < right->number ? -1 : left->number > right->number;
}

/// Counts the splats, or makes them when there is room.
static uint64_t gather(const reference *work, splat *splats) {
    const uint32_t *dims = work->volume->dims;
    const view *grid = &work->grid;
    uint64_t count = 0, number = 0;
    for (uint32_t k = 0; k < dims[2]; k++)
        for (uint32_t j = 0; j < dims[1]; j++)
            for (uint32_t i = 0; i < dims[0]; i++, number++) {
                ewa_reference_voxel voxel;
                splat made = {.number = number};
                if (!ewa_reference_classify(work->volume, work->transfer, i, j, k, &voxel)) continue;
                const ewa_vec3 steps = vec3_mul_mat3(vec3_make(i, j, k), &grid->axes);
                if (!make_splat(work, &voxel, vec3_add(grid->origin, steps), &made)) continue;
                if (splats) splats[count] = made;
                count++;
            }
    return count;
}

/// With `work` complete but for the memory: allocates, projects, sorts, draws.
static ewa_status render(ewa_context *context, reference *work) {
    const size_t pixel_count = (size_t)work->camera.width_px * work->camera.height_px;
    work->splat_count = gather(work, NULL);
    work->splats = ewa_allocate(context, work->splat_count, sizeof *work->splats);
    work->pixels = ewa_allocate(context, pixel_count, sizeof *work->pixels);
    ewa_status status = work->splats && work->pixels ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = ewa_progress(context, "reference", 0.1);
    if (status == EWA_OK) {
        gather(work, work->splats);
        qsort(work->splats, work->splat_count, sizeof *work->splats, by_depth);
        status = ewa_progress(context, "reference", 0.2);
    }
    if (status == EWA_OK) {
        work->band_count = BANDS_PER_WORKER * ewa_context_worker_count(context);
        if (work->band_count > work->camera.height_px) work->band_count = work->camera.height_px;
        ewa_parallel(context, render_band, work, work->band_count);
        status = ewa_progress(context, "reference", 1);
    }
    ewa_release(context, work->splats, work->splat_count, sizeof *work->splats);
    ewa_release(context, work->pixels, pixel_count, sizeof *work->pixels);
    return status;
}

/// Lights and the one material, as ewa_render() takes them.
static ewa_shading_setup make_shading(const ewa_volume_options *options) {
    ewa_render_options render;
    ewa_shading_setup made;
    ewa_render_options_init(&render, sizeof render);
    render.shading = options->shading;
    memcpy(render.lights, options->lights, sizeof render.lights);
    render.light_count = options->light_count;
    render.materials = &options->material;
    render.material_count = 1;
    ewa_shading_setup_make(&render, &made);
    made.materials[0] = options->material; // also without highlights
    return made;
}

static ewa_status choose_options(ewa_context *context, const ewa_volume_options *given,
                                 ewa_volume_options *chosen) {
    ewa_volume_options_init(chosen, sizeof *chosen);
    EWA_TRY(ewa_options_take(context, &ewa_volume_options_table, given, chosen));
    EWA_TRY(ewa_option_check_lights(context, chosen->lights, chosen->light_count));
    EWA_TRY(ewa_material_check(context, "options", 0, &chosen->material));
    EWA_TRY(ewa_option_check_background(context, chosen->background));
    EWA_TRY(ewa_option_check_sections(context, (const double(*)[4])chosen->section_planes,
                                      chosen->section_count));
    const bool first = chosen->surface_depth, second = chosen->surface_rgba;
    const bool more = chosen->surface_normal || chosen->surface_coverage;
    if (first != second || (more && !first))
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "reference: planes of a surface that lack others");
    return EWA_OK;
}

ewa_status ewa_volume_render_reference(const ewa_volume *volume, const ewa_transfer *transfer,
                                       const ewa_camera *camera, const ewa_volume_options *options,
                                       const ewa_frame *frame) {
    if (!volume || !volume->context || !volume->voxels || !transfer || !camera || !frame)
        return EWA_ERROR_ARGUMENT;
    ewa_context *context = volume->context;
    reference work = {.camera = *camera, .frame = *frame, .volume = volume, .transfer = transfer};
    EWA_TRY(choose_options(context, options, &work.options));
    EWA_TRY(ewa_camera_check(context, camera));
    EWA_TRY(ewa_transfer_check(context, "transfer function", transfer));
    if (ewa_reference_spacing(volume) == 0)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "reference: index_to_world is not invertible");
    work.grid = make_view(volume, camera, &work.options);
    work.shading = make_shading(&work.options);
    return render(context, &work);
}
