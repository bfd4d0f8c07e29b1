// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A frame on its way back: lists of each tile's splats, the tiles, and from each splat's sums to its point and the
// camera.
#include "adjoint/tiles.h"
#include "base/base.h"
#include "surface/semantics.h"

#include <string.h>

enum {
    CHAIN_POINTS = 1024, ///< points per piece of parallel work
    BLOCK_POINTS = 32,   ///< that are read together
    UNIT_BITS = 36,      ///< units per bound of a term
    SPLAT_SAMPLES = 16,  ///< that are kept of a splat on the average
    MAX_SAMPLES = 1 << 13, ///< of a tile: a megabyte
};

/// Where a splat may be seen: more than it is.
typedef struct reach {
    double x_px[2], y_px[2]; ///< from, to
    double begin;            ///< no depth is smaller
    double end;              ///< no distance of its disc along the view is larger
} reach;

/// Of a surfel near the eye, or whatever its numbers are.
static bool find_reach_exactly(const ewa_reference_view *view, const ewa_surfel *surfel, reach *found) {
    ewa_reference_splat splat;
    ewa_reference_project(view, surfel, &splat);
    if (!splat.drawn) return false;
    double begin = splat.center.z - splat.half_range;
    if (!splat.by_rays) begin = view->orthographic ? -splat.key_high : 1 / splat.key_high;
    *found = (reach){{splat.x_begin, splat.x_end}, {splat.y_begin, splat.y_end}, begin,
                     fabs(splat.center.z) + splat.half_range};
    return true;
}

/// The box of the filtered ellipse (docs/math.md section 3), with room for the way of a splat at its contour, and depths
/// from a sphere around the disc on. False: it is not drawn.
static bool find_reach(const ewa_reference_view *view, const ewa_surfel *surfel, reach *found) {
    const bool flat = view->orthographic;
    const ewa_mat3 *linear = &view->placement.linear;
    const ewa_vec3 p = ewa_placement_apply(&view->placement, vec3_load(surfel->center));
    const double scale = vec3_length(mat3_row(linear, 2)), F = view->cutoff;
    const double sigma = vec3_length(vec3_load(surfel->axis_u_world)) * scale, radius = F * sigma;
    if (surfel->billboard || !(p.z > 2 * radius) || !(sigma * fmax(view->fx_px, view->fy_px) < (flat ? 1 : p.z) * EWA_BROAD_PX))
        return find_reach_exactly(view, surfel, found);
    const ewa_vec3 axes[2] = {mat3_mul_vec3(linear, vec3_load(surfel->axis_u_world)),
                              mat3_mul_vec3(linear, vec3_load(surfel->axis_v_world))};
    const double x0 = flat ? 0 : p.x / p.z, y0 = flat ? 0 : p.y / p.z;
    double s11 = 0, s22 = 0, s13 = 0, s23 = 0, s33 = 0;
    for (int i = 0; i < 2; i++) {
        const double x = view->fx_px * (axes[i].x - x0 * axes[i].z), y = view->fy_px * (axes[i].y - y0 * axes[i].z);
        s11 += x * x, s22 += y * y, s13 += x * axes[i].z, s23 += y * axes[i].z, s33 += axes[i].z * axes[i].z;
    }
    const double F2 = flat || view->kernel != EWA_KERNEL_PERSPECTIVE ? 0 : F * F, h2 = view->prefilter_px * view->prefilter_px;
    const double k = flat ? 1 : 1 / (p.z * p.z - F2 * s33);
    const double center_px[2] = {view->fx_px * (flat ? p.x : x0) + view->cx_px - F2 * k * s13,
                                 view->fy_px * (flat ? p.y : y0) + view->cy_px - F2 * k * s23};
    const ewa_vec3 n = mat3_mul_vec3(linear, vec3_load(surfel->normal_world));
    const double sine = (flat ? n.z : vec3_dot(n, p) / p.z) / scale;
    const double depth = flat ? 1 : p.z, sigma_px = fmax(view->fx_px, view->fy_px) * sigma / depth;
    const double across = view->prefilter_px + EWA_CONTOUR_WIDTH * sigma_px * fabs(sine); // no less than E of section 5
    const double bend = 2 * fabs(surfel->curvature_world) / scale * depth / view->fx_px;
    const bool moves = sine * sine < fmin(EWA_CONTOUR_REACH * across * bend, view->contour_sine2);
    const double way_px = moves ? view->contour_shift * across : 0;
    const double half_px[2] = {F * sqrt(k * s11 + F2 * k * k * s13 * s13 + h2) * (1 + 1e-9) + way_px,
                               F * sqrt(k * s22 + F2 * k * k * s23 * s23 + h2) * (1 + 1e-9) + way_px};
    const double free = fmin(EWA_FREE_RADII * radius, EWA_FREE_DEPTH * p.z);
    *found = (reach){{center_px[0] - half_px[0], center_px[0] + half_px[0]},
                     {center_px[1] - half_px[1], center_px[1] + half_px[1]},
                     flat ? p.z - radius - free : 1 / (1 / (p.z - radius) + free / (p.z * p.z)),
                     p.z + radius};
    return true;
}

/// Tiles [first, end) along a side that have pixels whose centres are within; none: `end` is 0.
static void tiles_along(const double reach_px[2], uint32_t size_px, uint32_t side_px, uint32_t *first, uint32_t *end) {
    const double from = fmax(ceil(reach_px[0] - 0.5), 0), to = fmin(floor(reach_px[1] + 0.5), size_px);
    *first = *end = 0;
    if (!(from < to)) return;
    *first = (uint32_t)from / side_px, *end = ((uint32_t)to + side_px - 1) / side_px;
}

static ewa_adjoint_range range_of(const ewa_tiles *tiles, const reach *found) {
    uint32_t x[2], y[2];
    tiles_along(found->x_px, tiles->width_px, tiles->side_px, &x[0], &x[1]);
    tiles_along(found->y_px, tiles->height_px, tiles->side_px, &y[0], &y[1]);
    return x[1] && y[1] ? (ewa_adjoint_range){x[0] | y[0] << 16, x[1] | y[1] << 16} : (ewa_adjoint_range){0, 0};
}

/// Lists a splat in the tiles that it may reach; returns whether there are any.
static bool list_splat(const ewa_adjoint_job *job, ewa_adjoint_scratch *s, uint32_t point, const reach *found, uint32_t next,
                       const ewa_bin_items *items) {
    const ewa_adjoint_range range = job->ranges[point] = range_of(&job->tiles, found);
    if (range.end == 0) return false;
    job->begins[point] = nextafterf((float)found->begin, -INFINITY);
    items->ids[next] = (int32_t)point, items->first[next] = (int32_t)range.first, items->end[next] = (int32_t)range.end;
    s->largest_depth = fmax(s->largest_depth, found->end);
    return true;
}

static void measure_color(ewa_adjoint_scratch *s, const double color[3]) {
    for (int c = 0; c < 3; c++) s->largest_color = fmax(s->largest_color, fabs(color[c]));
}

/// Up to eight plain discs. Returns how many are listed, from `next` on.
static uint32_t find_discs(const ewa_adjoint_job *job, ewa_adjoint_scratch *s, uint32_t first, uint32_t count, uint32_t next,
                           const ewa_bin_items *items) {
    ewa_disc_points discs;
    ewa_disc_splats splats;
    uint32_t points[EWA_DISC_LANES], listed = 0;
    const ewa_attribute *color_stream = job->frame.reader.color;
    const bool of_any_size = color_stream && ewa_color_full_scale(color_stream->type) == 0; // others are at most 1
    if (!of_any_size) s->largest_color = 1;
    for (uint32_t lane = 0; lane < count; lane++) points[lane] = first + lane;
    ewa_adjoint_discs_read(&job->frame.reader, points, count, &discs);
    job->disc_kernels->project(&job->disc_view, &discs, &splats);
    for (uint32_t lane = 0; lane < count; lane++) {
        reach found = {{splats.box[0][lane], splats.box[1][lane]}, {splats.box[2][lane], splats.box[3][lane]},
                       job->disc_view.flat ? -splats.key_high[lane] : 1 / splats.key_high[lane],
                       splats.center[2][lane] + splats.half_range[lane]};
        if (splats.drawn[lane] < 0) {
            ewa_surfel surfel;
            bool drawable;
            ewa_surfel_read(&job->frame.reader, points[lane], 1, &surfel, &drawable);
            if (!find_reach_exactly(&job->frame.view, &surfel, &found)) continue;
        }
        if (splats.drawn[lane] == 0 || !list_splat(job, s, points[lane], &found, next + listed, items)) continue;
        listed++;
        if (!of_any_size) continue;
        double color[3], opacity;
        ewa_adjoint_read_color(&job->frame.reader, points[lane], color, &opacity);
        measure_color(s, color);
    }
    return listed;
}

static uint32_t find_splats(const void *data, uint32_t worker, uint32_t first, uint32_t count,
                            const ewa_bin_items *items) {
    const ewa_adjoint_job *job = data;
    ewa_adjoint_scratch *s = &job->scratch[worker];
    uint32_t next = first;
    ewa_surfel surfels[BLOCK_POINTS];
    bool drawable[BLOCK_POINTS];
    memset(job->ranges + first, 0, count * sizeof *job->ranges);
    for (uint32_t i = first; i < first + count && job->discs; i += EWA_DISC_LANES) {
        const uint32_t left = first + count - i;
        next += find_discs(job, s, i, left < EWA_DISC_LANES ? left : EWA_DISC_LANES, next, items);
    }
    for (uint32_t i = first; i < first + count && !job->discs; i++) {
        const uint32_t in_block = (i - first) % BLOCK_POINTS, left = first + count - i;
        if (in_block == 0)
            ewa_surfel_read(&job->frame.reader, i, left < BLOCK_POINTS ? left : BLOCK_POINTS, surfels, drawable);
        reach found;
        if (!drawable[in_block] || !find_reach(&job->frame.view, &surfels[in_block], &found)) continue;
        if (!list_splat(job, s, i, &found, next, items)) continue;
        measure_color(s, surfels[in_block].color_linear);
        next++;
    }
    return next - first;
}

static double largest_of(const float *plane, size_t count) {
    float largest = 0;
    for (size_t i = 0; i < count && plane; i++) largest = fmaxf(fabsf(plane[i]), largest);
    return (double)largest;
}

/// What terms are rounded to: 2^-36 of what none is much larger than.
static void set_units(ewa_adjoint_job *job) {
    const size_t pixels = (size_t)job->tiles.width_px * job->tiles.height_px;
    const ewa_shading_setup *shading = &job->frame.shading;
    double color = 0, depth = 0, light = 1;
    for (uint32_t i = 0; i < job->worker_count; i++) {
        color = fmax(color, job->scratch[i].largest_color);
        depth = fmax(depth, job->scratch[i].largest_depth);
    }
    for (uint32_t i = 0; i < shading->light_count && shading->lit; i++)
        light += fmax(shading->lights[i].color[0], fmax(shading->lights[i].color[1], shading->lights[i].color[2]));
    const double by_color = largest_of(job->cotangent.rgba, 4 * pixels) * light;
    const double by_depth = largest_of(job->cotangent.depth, pixels) * job->frame.view.placement.unit * depth;
    const double others = by_color * (1 + color) + by_depth + largest_of(job->cotangent.normal, 3 * pixels) +
                          largest_of(job->cotangent.coverage, pixels) / job->frame.resolve.unit_coverage;
    const double bounds[3] = {by_color, others, by_depth};
    double *const units[3] = {&job->units.color, &job->units.other, &job->units.depth};
    for (int i = 0; i < 3; i++) *units[i] = bounds[i] > 0 ? ldexp(1, UNIT_BITS - ilogb(bounds[i])) : 1;
}

/// Whether pixels that a surface fills end by `filling`, and what it says. Units are set.
static void set_filling(ewa_adjoint_job *job) {
    const ewa_reference_resolve *to = &job->frame.resolve;
    const ewa_reference_view *view = &job->frame.view;
    const ewa_frame_cotangent *by = &job->cotangent;
    const uint32_t light_count = to->shading->lit ? to->shading->light_count : 0;
    job->fills = by->rgba && !by->depth && !by->normal && !by->coverage && !job->gradient.rgba && job->width && !to->layering.transparent &&
                 light_count <= EWA_ADJOINT_LIGHTS;
    if (!job->fills) return;
    float material[5];
    ewa_reference_material_of(to, material);
    ewa_adjoint_filling *filling = &job->filling;
    *filling = (ewa_adjoint_filling){.minimum = to->options->edge_antialiasing ? to->options->edge_threshold * to->unit_coverage : 0,
                                     .ambient = light_count ? (double)material[0] : 0,
                                     .diffuse = light_count ? (double)material[1] : 0,
                                     .unlit = light_count ? 0 : 1,
                                     .inverse_scale = 1 / vec3_length(mat3_row(&view->placement.linear, 2)),
                                     .rgba = by->rgba,
                                     .stride_px = job->tiles.width_px,
                                     .with_camera = light_count && job->gradient.camera};
    for (uint32_t i = 0; i < light_count; i++) {
        const ewa_shading_light *from = &to->shading->lights[i];
        filling->lights[i] = (ewa_adjoint_light){.toward_world = from->toward_world, .headlight = from->headlight ? 1 : 0};
        memcpy(filling->lights[i].color, from->color, sizeof from->color);
    }
    const double fx = ewa_adjoint_power_of(view->fx_px), fy = ewa_adjoint_power_of(view->fy_px);
    const double sizes[EWA_CAMERA_NUMBERS] = {1, 1, 1, 1, 1, 1, fx, fy, fx, fy};
    for (int i = 0; i < EWA_CAMERA_NUMBERS; i++) filling->scales[i] = job->units.other * sizes[i];
}

/// Points at a part of a stream where it is wanted.
static void store_point(double *stream, uint64_t point, int components, const double *values) {
    if (stream) memcpy(stream + point * (uint64_t)components, values, (size_t)components * sizeof *values);
}

/// The sums of a point.
static void read_sums(const ewa_adjoint_job *job, uint64_t point, const double scales[EWA_MOMENT_COUNT],
                      double moments[EWA_MOMENT_COUNT]) {
    const int64_t *sums = job->sums + point * job->width;
    for (uint32_t m = 0; m < EWA_MOMENT_COUNT; m++)
        moments[m] = m < job->width ? (double)sums[m] / scales[m] : 0;
}

/// Whether a point is anywhere seen.
static bool has_sums(const ewa_adjoint_job *job, uint64_t point) {
    const int64_t *sums = job->sums + point * job->width;
    int64_t any = 0;
    for (uint32_t m = 0; m < job->width; m++) any |= sums[m];
    return any != 0;
}

/// From the sums of a point, whose surfel has been read where there are any.
static void pull_back_point(const ewa_adjoint_job *job, ewa_adjoint_scratch *s, uint64_t point, const ewa_surfel *surfel, bool seen) {
    ewa_reference_point_cotangent at;
    memset(&at, 0, sizeof at);
    if (seen) {
        double scales[EWA_MOMENT_COUNT], moments[EWA_MOMENT_COUNT], camera[EWA_CAMERA_NUMBERS] = {0};
        ewa_reference_splat splat;
        ewa_reference_surfel_cotangent of_surfel;
        ewa_reference_project(&job->frame.view, surfel, &splat);
        ewa_adjoint_scales(job, &splat, scales);
        read_sums(job, point, scales, moments);
        ewa_reference_moments_pull_back(&job->frame.view, &splat, surfel, moments, &of_surfel, camera);
        ewa_reference_surfel_pull_back(&job->frame.reader, point, surfel, &of_surfel, &at);
        for (int i = 0; i < EWA_CAMERA_NUMBERS && s->camera; i++) ewa_exact_add(&s->camera[i], camera[i]);
    }
    const ewa_gradient *to = &job->gradient;
    store_point(to->color, point, 3, at.color);
    store_point(to->opacity, point, 1, &at.opacity);
    store_point(to->position, point, 3, at.position);
    store_point(to->normal, point, 3, at.normal);
    store_point(to->radius, point, 1, &at.radius);
    store_point(to->tangent_u, point, 3, at.tangent_u);
    store_point(to->tangent_v, point, 3, at.tangent_v);
}

/// Up to eight plain discs that are seen.
static void pull_back_discs(const ewa_adjoint_job *job, ewa_adjoint_scratch *s, const uint32_t *points, uint32_t count) {
    const ewa_gradient *to = &job->gradient;
    const double units[3] = {job->units.color, job->units.other, job->units.depth};
    ewa_disc_points discs;
    ewa_disc_cotangents by;
    memset(&by, 0, sizeof by);
    ewa_adjoint_discs_read(&job->frame.reader, points, count, &discs);
    for (uint32_t lane = 0; lane < count; lane++)
        for (uint32_t m = 0; m < job->width; m++) by.sums[m][lane] = (double)job->sums[(size_t)points[lane] * job->width + m];
    job->disc_kernels->pull_back(&job->disc_view, &discs, units, &by);
    for (uint32_t lane = 0; lane < count; lane++) {
        if (by.drawn[lane] < 0) { // near
            ewa_surfel surfel;
            bool drawable;
            ewa_surfel_read(&job->frame.reader, points[lane], 1, &surfel, &drawable);
            pull_back_point(job, s, points[lane], &surfel, true);
            continue;
        }
        double color[3], position[3], normal[3];
        for (int c = 0; c < 3; c++) {
            color[c] = by.sums[EWA_MOMENT_COLOR + c][lane] / units[0];
            position[c] = by.position[c][lane], normal[c] = by.normal[c][lane];
        }
        const double opacity = by.sums[EWA_MOMENT_OPACITY][lane] / units[1];
        store_point(to->color, points[lane], 3, color);
        store_point(to->opacity, points[lane], 1, &opacity);
        store_point(to->position, points[lane], 3, position);
        store_point(to->normal, points[lane], 3, normal);
        store_point(to->radius, points[lane], 1, &by.radius[lane]);
        for (int i = 0; i < EWA_CAMERA_NUMBERS && s->camera; i++) ewa_exact_add(&s->camera[i], by.camera[i][lane]);
    }
}

static void clear_points(double *stream, uint64_t first, uint64_t count, uint64_t components) {
    if (stream) memset(stream + first * components, 0, count * components * sizeof *stream);
}

/// Points of a frame of plain discs.
static void pull_back_disc_piece(const ewa_adjoint_job *job, ewa_adjoint_scratch *s, uint64_t first, uint64_t end) {
    const ewa_gradient *to = &job->gradient;
    double *const of_one[] = {to->opacity, to->radius};
    double *const of_three[] = {to->color, to->position, to->normal, to->tangent_u, to->tangent_v};
    for (size_t i = 0; i < sizeof of_one / sizeof *of_one; i++) clear_points(of_one[i], first, end - first, 1);
    for (size_t i = 0; i < sizeof of_three / sizeof *of_three; i++) clear_points(of_three[i], first, end - first, 3);
    uint32_t points[EWA_DISC_LANES], count = 0;
    for (uint64_t i = first; i < end; i++) {
        if (has_sums(job, i)) points[count++] = (uint32_t)i;
        if (count == 0 || (count < EWA_DISC_LANES && i + 1 < end)) continue;
        pull_back_discs(job, s, points, count);
        count = 0;
    }
}

/// Points that are read together, as far as some are seen.
static void pull_back_block(const ewa_adjoint_job *job, ewa_adjoint_scratch *s, uint64_t first, uint64_t count) {
    ewa_surfel surfels[BLOCK_POINTS];
    bool drawable[BLOCK_POINTS], seen[BLOCK_POINTS], any = false;
    for (uint64_t i = 0; i < count; i++) any |= seen[i] = has_sums(job, first + i);
    if (any) ewa_surfel_read(&job->frame.reader, first, count, surfels, drawable);
    for (uint64_t i = 0; i < count; i++) pull_back_point(job, s, first + i, &surfels[i], seen[i]);
}

static void pull_back_piece(void *data, uint32_t index, uint32_t worker) {
    const ewa_adjoint_job *job = data;
    const uint64_t begin = (uint64_t)index * CHAIN_POINTS, left = job->frame.point_count - begin;
    const uint64_t end = begin + (left < CHAIN_POINTS ? left : CHAIN_POINTS);
    if (job->width > EWA_MOMENT_OPACITY && job->discs) {
        pull_back_disc_piece(job, &job->scratch[worker], begin, end);
        return;
    }
    if (job->width > EWA_MOMENT_OPACITY) {
        for (uint64_t i = begin; i < end; i += BLOCK_POINTS)
            pull_back_block(job, &job->scratch[worker], i, end - i < BLOCK_POINTS ? end - i : BLOCK_POINTS);
        return;
    }
    for (uint64_t i = begin; i < end; i++) {
        double moments[EWA_MOMENT_COUNT], scales[EWA_MOMENT_COUNT];
        for (int m = 0; m < EWA_MOMENT_COUNT; m++) scales[m] = job->units.color;
        read_sums(job, i, scales, moments);
        store_point(job->gradient.color, i, 3, moments + EWA_MOMENT_COLOR);
    }
}

/// Gives the workers what they need for the tiles.
static ewa_status reserve(ewa_adjoint_job *job) {
    ewa_context *context = job->frame.context;
    const uint32_t splats = (uint32_t)job->lists.largest, max_layers = job->frame.resolve.layering.max_layers;
    job->surface_count = splats < max_layers ? (splats > 0 ? splats : 1) : max_layers;
    const size_t pixels = (size_t)job->tiles.side_px * job->tiles.side_px, surfaces = job->surface_count;
    for (uint32_t i = 0; i < job->worker_count; i++) {
        ewa_adjoint_scratch *s = &job->scratch[i];
        s->splat_capacity = splats;
        s->plane_capacity = surfaces * ewa_adjoint_block_count(job) * EWA_PLANES * EWA_EIGHT_LANES;
        s->near_first = ewa_allocate(context, splats, sizeof *s->near_first);
        s->near_room = ewa_allocate(context, splats, sizeof *s->near_room);
        s->splats = ewa_allocate(context, splats, sizeof *s->splats);
        s->order = ewa_allocate(context, splats, sizeof *s->order);
        s->planes = ewa_allocate(context, s->plane_capacity, sizeof *s->planes);
        s->reached = ewa_allocate(context, surfaces, sizeof *s->reached);
        s->visits = ewa_allocate(context, surfaces * splats, sizeof *s->visits);
        s->samples.capacity = splats < MAX_SAMPLES / SPLAT_SAMPLES ? SPLAT_SAMPLES * splats : MAX_SAMPLES;
        s->samples.items = ewa_allocate(context, s->samples.capacity, sizeof *s->samples.items);
        s->layers = ewa_allocate(context, surfaces, sizeof *s->layers);
        s->pixels = ewa_allocate(context, pixels, sizeof *s->pixels);
        s->done = ewa_allocate(context, ewa_adjoint_block_count(job), sizeof *s->done);
        if (!s->near_first || !s->near_room || !s->splats || !s->order || !s->planes || !s->reached || !s->visits || !s->samples.items ||
            !s->layers || !s->pixels || !s->done)
            return EWA_ERROR_MEMORY;
    }
    return EWA_OK;
}

static void release(ewa_adjoint_job *job) {
    ewa_context *context = job->frame.context;
    const size_t pixels = (size_t)job->tiles.side_px * job->tiles.side_px;
    for (uint32_t i = 0; job->scratch && i < job->worker_count; i++) {
        ewa_adjoint_scratch *s = &job->scratch[i];
        ewa_release(context, s->near_first, s->splat_capacity, sizeof *s->near_first);
        ewa_release(context, s->near_room, s->splat_capacity, sizeof *s->near_room);
        ewa_release(context, s->splats, s->splat_capacity, sizeof *s->splats);
        ewa_release(context, s->order, s->splat_capacity, sizeof *s->order);
        ewa_release(context, s->planes, s->plane_capacity, sizeof *s->planes);
        ewa_release(context, s->visits, (size_t)job->surface_count * s->splat_capacity, sizeof *s->visits);
        ewa_release(context, s->samples.items, s->samples.capacity, sizeof *s->samples.items);
        ewa_release(context, s->reached, job->surface_count, sizeof *s->reached);
        ewa_release(context, s->layers, job->surface_count, sizeof *s->layers);
        ewa_release(context, s->pixels, pixels, sizeof *s->pixels);
        ewa_release(context, s->done, ewa_adjoint_block_count(job), sizeof *s->done);
        ewa_release(context, s->camera, EWA_CAMERA_NUMBERS, sizeof *s->camera);
    }
    const uint64_t points = job->frame.point_count;
    ewa_release(context, job->scratch, job->worker_count, sizeof *job->scratch);
    ewa_release(context, job->sums, points * job->width, sizeof *job->sums);
    ewa_release(context, job->begins, points, sizeof *job->begins);
    ewa_release(context, job->ranges, points, sizeof *job->ranges);
    ewa_bin_lists_free(context, &job->lists);
}

/// Makes what finding splats needs.
static ewa_status start(ewa_adjoint_job *job) {
    ewa_context *context = job->frame.context;
    job->worker_count = ewa_context_worker_count(context);
    job->kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_adjoint_kernels);
    job->discs = ewa_adjoint_discs_make(&job->frame, &job->disc_view);
    job->disc_kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_disc_kernels);
    job->ranges = ewa_allocate(context, job->frame.point_count, sizeof *job->ranges);
    job->begins = ewa_allocate(context, job->frame.point_count, sizeof *job->begins);
    if (job->width) job->sums = ewa_allocate_zeroed(context, job->frame.point_count * job->width, sizeof *job->sums);
    job->scratch = ewa_allocate_zeroed(context, job->worker_count, sizeof *job->scratch);
    if (!job->ranges || !job->begins || (job->width && !job->sums) || !job->scratch) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < job->worker_count && job->gradient.camera; i++) {
        job->scratch[i].camera = ewa_allocate_zeroed(context, EWA_CAMERA_NUMBERS, sizeof *job->scratch[i].camera);
        if (!job->scratch[i].camera) return EWA_ERROR_MEMORY;
    }
    return EWA_OK;
}

/// The camera's numbers, each the exact sum of all.
static void store_camera(const ewa_adjoint_job *job) {
    ewa_camera_cotangent *to = job->gradient.camera;
    if (!to) return;
    double *const members[EWA_CAMERA_NUMBERS] = {
        &to->rotation[0],    &to->rotation[1],    &to->rotation[2], &to->translation[0], &to->translation[1],
        &to->translation[2], &to->focal_px[0],    &to->focal_px[1], &to->principal_px[0], &to->principal_px[1]};
    for (int i = 0; i < EWA_CAMERA_NUMBERS; i++) {
        ewa_exact_sum sum = {.not_finite = false};
        for (uint32_t worker = 0; worker < job->worker_count; worker++)
            ewa_exact_join(&sum, &job->scratch[worker].camera[i]);
        *members[i] = ewa_exact_value(&sum);
    }
}

void ewa_adjoint_warn_unseen(ewa_context *context, uint64_t point_count, uint32_t width_px, uint32_t height_px) {
    ewa_report(context, EWA_SEVERITY_WARNING, "gradients: none of %llu surfels is in the picture of %u x %u pixels",
               (unsigned long long)point_count, width_px, height_px);
}

static ewa_status run(ewa_adjoint_job *job) {
    ewa_context *context = job->frame.context;
    EWA_TRY(start(job));
    EWA_TRY(ewa_bin_lists_fill(context, &job->lists, job->tiles.columns, job->tiles.rows,
                               (uint32_t)job->frame.point_count, find_splats, job));
    if (job->lists.item_count == 0)
        ewa_adjoint_warn_unseen(context, job->frame.point_count, job->tiles.width_px, job->tiles.height_px);
    set_units(job);
    set_filling(job);
    EWA_TRY(reserve(job));
    EWA_TRY(ewa_parallel_within(context, "gradients", 0.1, 0.9, ewa_adjoint_tile, job, ewa_tiles_count(&job->tiles)));
    if (job->width)
        EWA_TRY(ewa_parallel_within(context, "gradients", 0.9, 1, pull_back_piece, job,
                                    (uint32_t)((job->frame.point_count + CHAIN_POINTS - 1) / CHAIN_POINTS)));
    store_camera(job);
    return EWA_OK;
}

ewa_status ewa_adjoint_run(ewa_adjoint_job *job) {
    const ewa_status status = run(job);
    release(job);
    return status;
}
