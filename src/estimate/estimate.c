// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From positions to surfels: normals, radii or tangent axes from the neighbourhood of each place.
#include "base/base.h"
#include "base/options.h"
#include "cloud/border.h"
#include "cloud/cloud.h"
#include "estimate/borders.h"
#include "estimate/curvature.h"
#include "estimate/gaps.h"
#include "estimate/given.h"
#include "estimate/local.h"
#include "estimate/noise.h"
#include "estimate/orient.h"
#include "estimate/outliers.h"
#include "estimate/radii.h"
#include "estimate/sharp.h"
#include "estimate/sight.h"
#include "ewa/prepare.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum {
    TASK_PLACES = 1 << 14,
    COUNTER_STRIDE = 64, // bytes between the counters of workers
};

// Over the limit of radii: how far apart lines of samples may be, between which there is surface.
static const double LINE_LIMIT = 4.0 / 3;
static const double PI = 3.141592653589793;

/// What one worker has seen.
typedef struct counter {
    _Alignas(COUNTER_STRIDE) uint32_t thin;
    uint32_t degenerate;
    given_count given;
} counter;

typedef struct estimate_job {
    const ewa_estimate_options *options;
    const local_kernels *kernels;
    ewa_neighbours *neighbours;
    uint32_t place_count;
    uint32_t wanted; // LOCAL_*
    local_sizing sizing;
    // by place; NULL when not wanted
    float *normals;
    float *spacing;
    uint32_t (*links)[LOCAL_GRAPH_DEGREE];
    bool propagate; // normals are to agree along the links
    bool bends;     // curvatures are to be measured
    uint8_t *notes;  // RADIUS_*
    uint8_t *strewn; // how little a place is part of a surface, of UINT8_MAX; NULL when no sizes are wanted
    border_set *borders; // NULL when no sizes are wanted
    gap_set *gaps;       // NULL when no radii are wanted
    // by point; NULL when not wanted
    float *radius_out, *tangent_u_out, *tangent_v_out, *normal_out, *surfaceness_out, *curvature_out;
    ewa_attribute position, given; // given: normals that are kept; no data: none are
    sight sight;          // where points were seen from, if normals are to point there
    sight_grid grid;      // whether each point stands for a cell
    counter *counters;    // per worker
    local_batch *batches; // per worker: neighbours of a block; later places that wait to be settled together
} estimate_job;

static void set_points(const estimate_job *job, uint32_t place, float *out, const float *values,
                       uint32_t components) {
    uint32_t count;
    const uint32_t *points = ewa_neighbours_points(job->neighbours, place, &count);
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t c = 0; c < components; c++) out[(size_t)components * points[i] + c] = values[c];
}

static void set_axes(const estimate_job *job, uint32_t place, const local_surface *s, uint32_t lane,
                     double radius_world) {
    const double sigma = radius_world / job->options->cutoff, stretch = sqrt((double)s->aspect[lane]);
    float u[3], v[3];
    for (int c = 0; c < 3; c++) {
        // v = n x u
        const int next = (c + 1) % 3, last = (c + 2) % 3;
        const double across = (double)s->normal[next][lane] * (double)s->major[last][lane] -
                              (double)s->normal[last][lane] * (double)s->major[next][lane];
        u[c] = (float)(sigma * stretch * (double)s->major[c][lane]);
        v[c] = (float)(sigma / stretch * across);
    }
    set_points(job, place, job->tangent_u_out, u, 3);
    set_points(job, place, job->tangent_v_out, v, 3);
}

/// A length in single precision; none where that overflows.
static float length_or_none(double length) { return length <= (double)FLT_MAX ? (float)length : 0; }

static void set_size(const estimate_job *job, uint32_t place, const local_surface *s, uint32_t lane,
                     double radius_world) {
    const float radius = length_or_none(radius_world);
    if (job->gaps) job->gaps->radius[place] = radius;
    if (job->tangent_u_out) set_axes(job, place, s, lane, (double)radius);
}

/// Gives a place that is so far off that single precision overflows around it no plane and no size.
static void drop_overflow(uint32_t wanted, local_surface *s, uint32_t lane) {
    float sum = s->spacing[lane];
    for (int c = 0; c < 3; c++) sum += s->normal[c][lane];
    for (int c = 0; c < 3 && wanted & LOCAL_SHAPE; c++) sum += s->major[c][lane];
    if (isfinite(sum)) return;
    for (int c = 0; c < 3; c++) s->normal[c][lane] = c == 2, s->major[c][lane] = c == 0;
    s->spacing[lane] = s->reach[lane] = s->ellipse_reach[lane] = s->variation[lane] = 0;
    s->aspect[lane] = 1;
}

static void set_lane(const estimate_job *job, uint32_t wanted, uint32_t place, local_surface *s,
                     uint32_t lane, double unit) {
    drop_overflow(wanted, s, lane);
    if (job->spacing) job->spacing[place] = length_or_none((double)s->spacing[lane] * unit);
    if (job->normals)
        for (int c = 0; c < 3; c++) job->normals[3 * (size_t)place + (size_t)c] = s->normal[c][lane];
}

/// What is noted about a lane whose neighbours do not tell its size.
static uint8_t note_again(const local_surface *s, uint32_t lane, uint32_t why) {
    const double scatter = ewa_radius_scatter((double)s->variation[lane]);
    return (uint8_t)(why | (uint32_t)(scatter * RADIUS_NOTE_MAX) << RADIUS_NOTE_SHIFT);
}

static void visit(void *user, const ewa_block *block, uint32_t worker) {
    const estimate_job *job = user;
    local_surface s;
    local_batch *batch = &job->batches[worker];
    job->kernels->measure(block, job->wanted, batch, &s);
    if (job->links) job->kernels->link(block, batch, &job->links[block->first_place]);
    if (job->given.data) {
        uint32_t count;
        const uint32_t lane = ewa_given_lane(block);
        const uint32_t *points = ewa_neighbours_points(job->neighbours, block->first_place + lane, &count);
        ewa_given_look(&job->given, points[0], &s, lane, &job->counters[worker].given);
    }
    for (uint32_t lane = 0; lane < block->lane_count; lane++)
        set_lane(job, job->wanted, block->first_place + lane, &s, lane, block->unit_world);
    if (job->wanted) job->kernels->size(job->wanted, &job->sizing, &s);
    if (job->gaps) ewa_gaps_note(job->gaps, block, &s, s.thin | s.doubtful, worker);
    for (uint32_t lane = 0; lane < block->lane_count; lane++) {
        const uint32_t place = block->first_place + lane;
        const bool thin = s.thin >> lane & 1, doubtful = s.doubtful >> lane & 1;
        job->counters[worker].thin += thin;
        if (thin || doubtful) {
            job->notes[place] = note_again(&s, lane, thin ? RADIUS_THIN : RADIUS_DOUBTFUL);
        } else if (job->wanted) {
            job->notes[place] = (uint8_t)(s.ratio[lane] << RADIUS_NOTE_SHIFT);
            set_size(job, place, &s, lane, (double)s.radius[lane] * block->unit_world);
        } else {
            job->notes[place] = 0;
        }
    }
}

/// Links a place to neighbours at even steps of their list: the nearest ones would all be on its own line.
static void link_evenly(const ewa_block *block, uint32_t lane, uint32_t links[LOCAL_GRAPH_DEGREE]) {
    uint32_t inside = 0, seen = 0, linked = 0;
    for (uint32_t i = 0; i < block->candidate_count; i++)
        inside += block->distance2[i][lane] <= block->radius2[lane];
    for (uint32_t i = 0; i < block->candidate_count && linked < LOCAL_GRAPH_DEGREE; i++) {
        if (!(block->distance2[i][lane] <= block->radius2[lane])) continue;
        if (seen++ * LOCAL_GRAPH_DEGREE < linked * inside) continue;
        if (block->place[i] != block->first_place + lane) links[linked++] = block->place[i];
    }
    while (linked < LOCAL_GRAPH_DEGREE) links[linked++] = UINT32_MAX;
}

/// The second visit: to places whose neighbours were almost on a line, as where a scanner's lines are far
/// apart.
static void visit_thin(void *user, const ewa_block *block, uint32_t worker) {
    const estimate_job *job = user;
    local_surface s;
    job->kernels->measure(block, 0, &job->batches[worker], &s);
    for (uint32_t lane = 0; lane < block->lane_count; lane++) {
        const uint32_t place = block->first_place + lane;
        if (!(job->notes[place] & RADIUS_THIN)) continue;
        if (job->links) link_evenly(block, lane, job->links[place]);
        // Still on a line: a curve in space.
        const bool curve = s.thin >> lane & 1;
        if (curve) s.spacing[lane] = s.line_spacing[lane];
        set_lane(job, 0, place, &s, lane, block->unit_world);
        job->notes[place] = note_again(&s, lane, curve ? RADIUS_DOUBTFUL : RADIUS_THIN);
        job->counters[worker].degenerate += s.degenerate >> lane & 1;
    }
}

/// Gives a place its size by many neighbours; returns that, in the lane's units.
static double settle_lane(const estimate_job *job, const local_batch *batch, uint32_t lane, double around,
                          double limit, local_surface *s) {
    const uint32_t place = batch->place[lane];
    drop_overflow(job->wanted, s, lane);
    const double spacing = (double)job->spacing[place] / batch->unit_world[lane];
    const double few = (double)(job->notes[place] >> RADIUS_NOTE_SHIFT) / RADIUS_NOTE_MAX;
    const double many = ewa_radius_scatter((double)s->variation[lane]);
    const double scatter = few < many ? few : many, lone = ewa_radius_lone(spacing, around);
    const radius_place at = {.spacing = spacing < around ? spacing : around,
                             .reach = (double)(job->tangent_u_out ? s->ellipse_reach[lane] : s->reach[lane]),
                             .limit = limit,
                             .scatter = scatter > lone ? scatter : lone};
    const double radius = ewa_radius(&at, job->options->radius_scale, job->options->cutoff);
    set_size(job, place, s, lane, radius * batch->unit_world[lane]);
    const double closed = job->notes[place] & RADIUS_THIN || lone > 0 ? 0 : spacing;
    if (job->gaps) ewa_gaps_set_corner(job->gaps, place, s, lane, closed);
    const bool curve = s->thin >> lane & 1;
    job->strewn[place] = (uint8_t)(curve ? UINT8_MAX : UINT8_MAX * ewa_radius_strewn((double)s->variation[lane]));
    return radius;
}

static double smaller(float a, double b) { return (double)a < b ? (double)a : b; }

/// 1 / sqrt(neighbours per area), wherever they are: less than along one surface where there are several or leaves.
static double spread_of(uint32_t count, float farthest2) {
    return count > 1 ? sqrt(PI * (double)farthest2 / (count - 1)) : 0;
}

/// How much a place is part of a surface.
static float surfaceness(const estimate_job *job, uint32_t place) {
    return 1 - (float)job->strewn[place] / UINT8_MAX;
}

/// Notes where the surface ends near places, and whose discs around reach over that.
static void note_borders(const estimate_job *job, const local_batch *batch, uint32_t lanes,
                         const local_border *border) {
    for (; lanes; lanes &= lanes - 1) {
        const uint32_t lane = (uint32_t)__builtin_ctz(lanes), place = batch->place[lane];
        const double unit = batch->unit_world[lane], distance = (double)border->distance[lane];
        float to_world[3];
        for (int c = 0; c < 3; c++) to_world[c] = (float)((double)border->direction[c][lane] * distance * unit);
        // What looks like one may be a gap between lines of samples.
        if (job->notes[place] & RADIUS_THIN || surfaceness(job, place) < (float)EWA_SURFACE_LIMIT) continue;
        ewa_borders_note(job->borders, place, to_world);
        for (uint32_t i = 0; i < batch->count[lane]; i++) {
            const local_row *row = &batch->row[i];
            const uint8_t note = job->notes[row->place[lane]];
            const double ratio = (double)(note >> RADIUS_NOTE_SHIFT) / RADIUS_NOTE_RATIO;
            const double reach = (double)row->x[lane] + ratio * (double)row->value[lane] / unit;
            if (!(note & RADIUS_AGAIN) && reach > distance) ewa_borders_ask(job->borders, row->place[lane]);
        }
    }
}

/// How far beyond the outermost samples a place's surface ends, as ewa_sight_beyond() says.
static float beyond_of(const estimate_job *job, uint32_t place, const local_surface *s, uint32_t lane) {
    uint32_t count;
    double p[3], normal[3];
    if (!job->grid.given) return 0;
    ewa_attribute_read_f64(&job->position, ewa_neighbours_points(job->neighbours, place, &count)[0], 1, p);
    for (int c = 0; c < 3; c++) normal[c] = (double)s->normal[c][lane];
    return ewa_sight_beyond(&job->grid, p, normal);
}

/// Settles the places that wait, and empties their list.
static void settle(const estimate_job *job, local_batch *batch) {
    const uint32_t count = batch->lane_count;
    local_surface s;
    local_sizes sizes = {.radius = {0}};
    float normal[3][EWA_BLOCK_LANES], farthest2[EWA_BLOCK_LANES];
    job->kernels->median(batch, sizes.around, farthest2);
    for (uint32_t lane = 0; lane < EWA_BLOCK_LANES; lane++) {
        const uint32_t from = lane < count ? lane : 0, place = batch->place[from];
        for (int c = 0; c < 3 && job->normals; c++)
            normal[c][lane] = job->normals[3 * (size_t)place + (size_t)c];
        sizes.around[lane] = (float)((double)sizes.around[from] / batch->unit_world[from]);
        sizes.farthest[lane] = sqrtf(farthest2[from]);
        const float around = sizes.around[lane];
        const bool line = job->notes[place] & RADIUS_THIN;
        const double spacing = line ? LINE_LIMIT * (double)around
                                  : smaller(around, spread_of(batch->count[from], farthest2[from]));
        sizes.limit[lane] = (float)(job->options->radius_limit * spacing);
    }
    job->kernels->enclose(batch, job->wanted, job->normals ? (const float(*)[EWA_BLOCK_LANES])normal : NULL,
                          sizes.limit, &s);
    for (uint32_t lane = 0; lane < count; lane++)
        sizes.radius[lane] = (float)settle_lane(job, batch, lane, (double)sizes.around[lane],
                                                (double)sizes.limit[lane], &s);
    for (uint32_t lane = 0; lane < EWA_BLOCK_LANES; lane++)
        sizes.beyond[lane] = beyond_of(job, batch->place[lane < count ? lane : 0], &s, lane);
    local_border border;
    const uint32_t lanes = ~0u >> (32 - count);
    note_borders(job, batch, job->kernels->border(batch, &s, &sizes, &border) & lanes, &border);
    batch->lane_count = 0;
}

/// The third visit: to places whose cells are open, as at borders and beside holes, that are on lines or on
/// no surface, or sparser than others nearby. All spacings are known then.
static void visit_again(void *user, const ewa_block *block, uint32_t worker) {
    const estimate_job *job = user;
    local_batch *batch = &job->batches[worker];
    uint32_t lanes = 0;
    for (uint32_t lane = 0; lane < block->lane_count; lane++)
        if (job->notes[block->first_place + lane] & RADIUS_AGAIN) lanes |= 1u << lane;
    while (lanes) {
        lanes = job->kernels->collect(block, lanes, job->spacing, batch);
        if (batch->lane_count == EWA_BLOCK_LANES) settle(job, batch);
    }
}

/// Measures again what is noted so.
static ewa_status measure_again(ewa_context *context, estimate_job *job, const ewa_visit_choice *choice) {
    const uint32_t workers = ewa_context_worker_count(context);
    for (uint32_t w = 0; w < workers; w++) job->batches[w].lane_count = 0;
    EWA_TRY(ewa_neighbours_visit(job->neighbours, choice, visit_again, job));
    for (uint32_t w = 0; w < workers; w++)
        if (job->batches[w].lane_count) settle(job, &job->batches[w]);
    return EWA_OK;
}

/// Turns v so that u x v is along the normal.
static void match_axes(const float *normal, const float *u, float *v) {
    float volume = 0;
    for (int c = 0; c < 3; c++)
        volume += normal[c] * (u[(c + 1) % 3] * v[(c + 2) % 3] - u[(c + 2) % 3] * v[(c + 1) % 3]);
    if (volume < 0)
        for (int c = 0; c < 3; c++) v[c] = -v[c];
}

/// Hands the normals of places to their points, towards where these were seen from if that is known.
static void finish_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const estimate_job *job = data;
    const uint32_t begin = task * TASK_PLACES;
    const uint32_t end = job->place_count - begin < TASK_PLACES ? job->place_count : begin + TASK_PLACES;
    for (uint32_t place = begin; place < end; place++) {
        float *normal = &job->normals[3 * (size_t)place];
        uint32_t count;
        const uint32_t *points = ewa_neighbours_points(job->neighbours, place, &count);
        if (job->sight.kind != SIGHT_NONE) {
            double p[3];
            ewa_attribute_read_f64(&job->position, points[0], 1, p);
            if (ewa_sight_is_behind(&job->sight, points[0], p, normal))
                for (int c = 0; c < 3; c++) normal[c] = -normal[c];
        }
        set_points(job, place, job->normal_out, normal, 3);
        for (uint32_t i = 0; i < count && job->tangent_v_out; i++)
            match_axes(normal, &job->tangent_u_out[3 * (size_t)points[i]],
                       &job->tangent_v_out[3 * (size_t)points[i]]);
    }
}

static ewa_status add_output(ewa_cloud *cloud, const char *name, uint32_t components, bool has_gaps,
                             float **out) {
    void *data = NULL;
    EWA_TRY(ewa_cloud_add(cloud, name, EWA_F32, components, &data));
    if (has_gaps) memset(data, 0, components * sizeof **out * ewa_cloud_point_count(cloud));
    *out = data;
    return EWA_OK;
}

/// Hands on how much places are part of a surface.
static void surfaceness_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const estimate_job *job = data;
    const uint32_t begin = task * TASK_PLACES;
    const uint32_t end = job->place_count - begin < TASK_PLACES ? job->place_count : begin + TASK_PLACES;
    for (uint32_t place = begin; place < end; place++) {
        const float value = surfaceness(job, place);
        set_points(job, place, job->surfaceness_out, &value, 1);
    }
}

/// Adds the stream of surfaceness where some place is on no surface.
static ewa_status finish_surfaceness(ewa_cloud *cloud, estimate_job *job, bool has_gaps) {
    uint8_t any = 0;
    for (uint32_t place = 0; place < job->place_count; place++) any |= job->strewn[place];
    if (!any) return EWA_OK;
    EWA_TRY(add_output(cloud, EWA_SURFACENESS, 1, has_gaps, &job->surfaceness_out));
    return ewa_parallel_stoppable(ewa_cloud_context(cloud), "estimate", surfaceness_task, job,
                                  (job->place_count + TASK_PLACES - 1) / TASK_PLACES);
}

/// Measures all places.
static ewa_status measure(ewa_context *context, estimate_job *job) {
    ewa_visit_choice choice = {job->options->neighbour_count, 1, NULL, "estimate", 0, NULL};
    ewa_status status = ewa_neighbours_visit(job->neighbours, &choice, visit, job);
    uint64_t thin = 0;
    for (uint32_t w = 0; w < ewa_context_worker_count(context); w++) thin += job->counters[w].thin;
    choice.neighbour_count = EWA_NEIGHBOURS_MAX;
    choice.chosen = job->notes;
    choice.chosen_bits = RADIUS_THIN;
    if (status == EWA_OK && thin) status = ewa_neighbours_visit(job->neighbours, &choice, visit_thin, job);
    if (status != EWA_OK || !job->wanted) return status;
    ewa_radius_doubt_sparse(context, job->spacing, job->place_count, job->options->radius_limit, job->notes);
    if (job->gaps) ewa_gaps_need(job->gaps, job->notes, job->options->cutoff);
    choice.chosen_bits = RADIUS_AGAIN;
    choice.spacing = job->spacing;
    EWA_TRY(measure_again(context, job, &choice));
    // The fourth visit: to places with closed cells whose discs reach over a border.
    if (ewa_borders_take_asked(job->borders, RADIUS_DOUBTFUL, job->notes)) EWA_TRY(measure_again(context, job, &choice));
    const gap_input input = {job->options, job->neighbours, job->kernels, job->borders, job->spacing, job->strewn, job->radius_out};
    return job->gaps ? ewa_gaps_close(job->gaps, &input) : EWA_OK;
}

static void report_degenerate(ewa_context *context, const estimate_job *job) {
    uint64_t degenerate = 0;
    for (uint32_t w = 0; w < ewa_context_worker_count(context); w++)
        degenerate += job->counters[w].degenerate;
    if (degenerate)
        ewa_report(context, EWA_SEVERITY_INFO,
                   "%llu of %u places are on no plane: less than three neighbours, or all on one line",
                   (unsigned long long)degenerate, job->place_count);
}

/// Adds the stream of curvatures if there are any, by the normals of places, estimated ones or those that the cloud has.
static ewa_status finish_curvature(ewa_cloud *cloud, estimate_job *job, bool has_gaps) {
    ewa_context *context = ewa_cloud_context(cloud);
    float *given = NULL;
    if (!job->normals) {
        given = ewa_allocate(context, job->place_count, 3 * sizeof *given);
        if (!given) return EWA_ERROR_MEMORY;
        ewa_curvature_read_normals(cloud, job->neighbours, given);
    }
    ewa_status status = add_output(cloud, EWA_CURVATURE, 1, has_gaps, &job->curvature_out);
    const curvature_input input = {job->neighbours, (const uint32_t(*)[LOCAL_GRAPH_DEGREE])job->links,
                                   given ? given : job->normals, job->curvature_out};
    if (status == EWA_OK) status = ewa_curvature_measure(context, &input);
    if (status == EWA_OK) ewa_curvature_drop_flat(cloud);
    if (status == EWA_OK && ewa_sharp_find(job->place_count, &input, job->strewn))
        status = ewa_cloud_set_note(cloud, EWA_SHARP_NOTE, "yes", 3);
    ewa_release(context, given, job->place_count, 3 * sizeof *given);
    return status;
}

/// Notes whether the normals that are kept are those of the points' surface.
static ewa_status note_given(ewa_cloud *cloud, const estimate_job *job) {
    given_count all = {0, 0};
    for (uint32_t w = 0; w < ewa_context_worker_count(ewa_cloud_context(cloud)); w++) {
        all.seen += job->counters[w].given.seen;
        all.off += job->counters[w].given.off;
    }
    return ewa_given_note(cloud, &all);
}

/// Turns normals where a depth camera's noise is larger than what they were measured from. Ellipses keep theirs: their axes
/// lie in the planes of few neighbours.
static ewa_status smooth_noise(ewa_cloud *cloud, const estimate_job *job) {
    ewa_context *context = ewa_cloud_context(cloud);
    if (!job->normals || job->tangent_u_out || job->sight.kind == SIGHT_UPWARD) return EWA_OK;
    noise_input input = {job->neighbours, job->place_count, &job->grid, .radius_scale = job->options->radius_scale};
    ewa_cloud_origin(cloud, input.world_origin);
    for (int c = 0; c < 3; c++) input.world_origin[c] = 0 - input.world_origin[c];
    const noise_output output = {job->normals, job->strewn, job->radius_out};
    uint64_t turned = 0;
    EWA_TRY(ewa_noise_smooth(context, &input, &output, &turned));
    if (turned)
        ewa_report(context, EWA_SEVERITY_INFO,
                   "noise of a depth camera: normals of %llu of %u places are those of larger planes",
                   (unsigned long long)turned, job->place_count);
    return EWA_OK;
}

/// Adds and fills the stream of normals.
static ewa_status finish_normals(ewa_cloud *cloud, estimate_job *job, bool has_gaps) {
    ewa_context *context = ewa_cloud_context(cloud);
    ewa_status status = EWA_OK;
    if (job->propagate) {
        const orient_input input = {job->neighbours, (const uint32_t(*)[LOCAL_GRAPH_DEGREE])job->links,
                                    job->spacing};
        status = ewa_orient_propagate(context, &input, job->normals);
    }
    if (status == EWA_OK) status = add_output(cloud, EWA_NORMAL, 3, has_gaps, &job->normal_out);
    if (status == EWA_OK)
        status = ewa_parallel_stoppable(context, "estimate", finish_task, job,
                                        (job->place_count + TASK_PLACES - 1) / TASK_PLACES);
    return status;
}

/// Adds the streams that are wanted, with a tree over the positions at hand.
static ewa_status estimate_with(ewa_cloud *cloud, estimate_job *job, bool normals, bool sizes) {
    ewa_context *context = ewa_cloud_context(cloud);
    const bool alike = job->options->orientation == EWA_ORIENT_PROPAGATE ||
                       (job->options->orientation == EWA_ORIENT_AUTO && job->sight.kind == SIGHT_NONE);
    job->propagate = normals && alike;
    const bool has_gaps = ewa_neighbours_finite_count(job->neighbours) < ewa_cloud_point_count(cloud);
    const bool ellipse = job->options->shape == EWA_SHAPE_ELLIPSE;
    const size_t places = job->place_count, workers = ewa_context_worker_count(context);
    job->wanted = !sizes ? 0 : ellipse ? LOCAL_SHAPE : LOCAL_REACH;
    job->sizing =
        ewa_radius_sizing(job->options->radius_limit, job->options->radius_scale, job->options->cutoff, sizes && !ellipse);
    border_set borders = {0};
    gap_set gaps = {0};
    if (sizes) job->borders = &borders;
    ewa_status status = EWA_OK;
    if (sizes && !ellipse) status = add_output(cloud, EWA_RADIUS, 1, has_gaps, &job->radius_out);
    if (sizes && ellipse) status = add_output(cloud, EWA_TANGENT_U, 3, has_gaps, &job->tangent_u_out);
    if (sizes && ellipse && status == EWA_OK)
        status = add_output(cloud, EWA_TANGENT_V, 3, has_gaps, &job->tangent_v_out);
    if (status == EWA_OK) {
        job->counters = ewa_allocate_zeroed(context, workers, sizeof *job->counters);
        job->notes = ewa_allocate(context, places, sizeof *job->notes);
        job->batches = ewa_allocate(context, workers, sizeof *job->batches);
        bool complete = job->counters && job->notes && job->batches;
        if (normals)
            complete = (job->normals = ewa_allocate(context, places, 3 * sizeof *job->normals)) && complete;
        if (job->propagate || job->bends)
            complete = (job->links = ewa_allocate(context, places, sizeof *job->links)) && complete;
        if (job->propagate || sizes)
            complete = (job->spacing = ewa_allocate(context, places, sizeof *job->spacing)) && complete;
        if (sizes)
            complete = (job->strewn = ewa_allocate_zeroed(context, places, sizeof *job->strewn)) && complete;
        if (sizes) complete = ewa_borders_make(context, job->place_count, &borders) == EWA_OK && complete;
        if (sizes && !ellipse)
            complete = ewa_gaps_make(context, job->place_count, job->gaps = &gaps) == EWA_OK && complete;
        status = complete ? measure(context, job) : EWA_ERROR_MEMORY;
        if (job->gaps) ewa_gaps_free(&gaps);
    }
    if (status == EWA_OK && job->given.data) status = note_given(cloud, job);
    if (status == EWA_OK) status = smooth_noise(cloud, job);
    if (status == EWA_OK) {
        report_degenerate(context, job);
        if (sizes) status = finish_surfaceness(cloud, job, has_gaps);
    }
    if (status == EWA_OK && normals) status = finish_normals(cloud, job, has_gaps);
    if (status == EWA_OK && job->bends) status = finish_curvature(cloud, job, has_gaps);
    ewa_neighbours_end_visits(job->neighbours);
    if (status == EWA_OK && sizes)
        status = ewa_borders_add(job->borders, job->neighbours, job->tangent_u_out, job->tangent_v_out, cloud);
    ewa_borders_free(context, &borders);
    ewa_release(context, job->spacing, places, sizeof *job->spacing);
    ewa_release(context, job->links, places, sizeof *job->links);
    ewa_release(context, job->normals, places, 3 * sizeof *job->normals);
    ewa_release(context, job->batches, workers, sizeof *job->batches);
    ewa_release(context, job->notes, places, sizeof *job->notes);
    ewa_release(context, job->strewn, places, sizeof *job->strewn);
    ewa_release(context, job->counters, workers, sizeof *job->counters);
    return status;
}

static bool has_components(const ewa_cloud *cloud, const char *name, uint32_t components) {
    const ewa_attribute *attribute = ewa_cloud_find(cloud, name);
    return attribute && attribute->component_count == components;
}

static ewa_status estimate(ewa_cloud *cloud, const ewa_estimate_options *options) {
    const bool has_axes = has_components(cloud, EWA_TANGENT_U, 3) && has_components(cloud, EWA_TANGENT_V, 3);
    const bool sizes = !(options->keep_radii && (has_axes || has_components(cloud, EWA_RADIUS, 1)));
    // Axes that are kept have a normal.
    const bool has_normals = has_components(cloud, EWA_NORMAL, 3) || (has_axes && !sizes);
    const bool normals = !(options->keep_normals && has_normals);
    if (!normals && !sizes) return ewa_curvature_complete(cloud);
    estimate_job job = {.options = options,
                        .kernels =
                            EWA_CHOOSE(ewa_context_cpu_features(ewa_cloud_context(cloud)), ewa_local_kernels),
                        .bends = normals || !has_components(cloud, EWA_CURVATURE, 1),
                        .position = *ewa_cloud_find(cloud, EWA_POSITION)};
    if (!normals && has_components(cloud, EWA_NORMAL, 3)) job.given = *ewa_cloud_find(cloud, EWA_NORMAL);
    ewa_neighbours *neighbours = NULL;
    ewa_status status = ewa_sight_make(cloud, options, &job.sight);
    job.grid = ewa_sight_grid(cloud, &job.sight);
    if (status == EWA_OK)
        status = ewa_neighbours_create(ewa_cloud_context(cloud), &job.position,
                                       (uint32_t)ewa_cloud_point_count(cloud), &neighbours);
    if (status != EWA_OK) {
        ewa_sight_free(ewa_cloud_context(cloud), &job.sight);
        return status;
    }
    job.neighbours = neighbours;
    job.place_count = ewa_neighbours_place_count(neighbours);
    status = estimate_with(cloud, &job, normals, sizes);
    ewa_neighbours_destroy(&neighbours);
    ewa_sight_free(ewa_cloud_context(cloud), &job.sight);
    if (status != EWA_OK) {
        // Streams that are not filled must not stay.
        if (job.normal_out) ewa_cloud_remove(cloud, EWA_NORMAL);
        if (job.radius_out) ewa_cloud_remove(cloud, EWA_RADIUS);
        if (job.surfaceness_out) ewa_cloud_remove(cloud, EWA_SURFACENESS);
        if (job.curvature_out) ewa_cloud_remove(cloud, EWA_CURVATURE);
        if (job.tangent_u_out) ewa_cloud_remove(cloud, EWA_TANGENT_U);
        if (job.tangent_v_out) ewa_cloud_remove(cloud, EWA_TANGENT_V);
        return status;
    }
    // What described the old sizes would contradict the new ones.
    if (job.tangent_u_out) ewa_cloud_remove(cloud, EWA_RADIUS);
    if (sizes && !job.surfaceness_out) ewa_cloud_remove(cloud, EWA_SURFACENESS);
    if (job.radius_out) {
        ewa_cloud_remove(cloud, EWA_TANGENT_U);
        ewa_cloud_remove(cloud, EWA_TANGENT_V);
    }
    return EWA_OK;
}

ewa_status ewa_cloud_estimate(ewa_cloud **cloud, const ewa_estimate_options *given) {
    if (!cloud || !*cloud || !given) return EWA_ERROR_ARGUMENT;
    ewa_context *context = ewa_cloud_context(*cloud);
    ewa_estimate_options chosen, *options = &chosen;
    ewa_estimate_options_init(options, sizeof *options);
    EWA_TRY(ewa_options_take(context, &ewa_estimate_options_table, given, options));
    if (!has_components(*cloud, EWA_POSITION, 3))
        return ewa_fail(context, EWA_ERROR_ARGUMENT,
                        "estimate: the cloud has no positions of three components");
    if (ewa_cloud_point_count(*cloud) >= UINT32_MAX)
        return ewa_fail(context, EWA_ERROR_LIMIT, "estimate: %llu points are over the limit of 2^32 - 2",
                        (unsigned long long)ewa_cloud_point_count(*cloud));
    if (options->outlier_factor > 0)
        EWA_TRY(ewa_remove_outliers(cloud, options));
    return estimate(*cloud, options);
}
