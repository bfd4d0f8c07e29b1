// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Curvatures: what kernels make of a place and its neighbours (local_curvature_body.h), averaged twice by how far it is to be
// trusted.
#include "estimate/curvature.h"
#include "base/base.h"
#include "cloud/cloud.h"
#include "homogeneous/vec.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

enum { TASK_PLACES = 1 << 13, LANES = EWA_BLOCK_LANES };

// Curvatures times the reach of the neighbours, which are at most its sines: from here on they count less, and from there
// on not at all. Estimated normals turn round an edge so fast, and splats that followed them would leave gaps there.
static const double SOFT_BEND = 0.3, SHARP_BEND = 0.4;
// Share of a place and its neighbours that must know how they bend, as means of these over theirs.
static const double AGREEING_SHARE = 0.3;
// Neighbours that may bend to the other side, or not at all.
static const uint32_t DISSENTING = 1;
// How often neighbours are asked, each time of one ring more; what drops out later than in round WHOLLY, counted from 0, keeps a part.
enum { ROUNDS = 8, WHOLLY = 3 };

// Ways to bend, in steps of what tells the round apart.
enum { FLAT = 0, CONCAVE = 64, CONVEX = 128, SIDES = CONCAVE | CONVEX };

typedef struct curvature_job {
    const curvature_input *input;
    const local_kernels *kernels;
    uint32_t place_count;
    const float *const *offsets; // of places, if these say all; else
    double (*position)[3];
    float (*fit)[2];          // signed curvature and how far it is to be trusted
    float (*smooth)[2];       // the same, means of a place and its neighbours
    float *mean;              // by place, over smooth ones
    _Atomic uint8_t *states; // of each place: the way it bends, and the round in which it dropped out (ROUNDS: none)
    uint8_t round;
    atomic_bool any_dropped; // in this round
} curvature_job;

static double larger(double a, double b) { return b > a ? b : a; }

/// The way from one place to another.
static inline void find_way(const curvature_job *job, uint32_t from, uint32_t to, double way[3]) {
    if (job->offsets)
        for (int c = 0; c < 3; c++) way[c] = (double)(job->offsets[c][to] - job->offsets[c][from]);
    else
        for (int c = 0; c < 3; c++) way[c] = job->position[to][c] - job->position[from][c];
}

/// Puts a place and its neighbours into a lane; returns the length that ways are in units of, 0 if there is none.
static double set_fan(const curvature_job *job, uint32_t place, uint32_t lane, local_fans *fans) {
    const uint32_t *links = job->input->links[place];
    const float *own = &job->input->normals[3 * (size_t)place];
    uint32_t count = LOCAL_GRAPH_DEGREE;
    while (count && links[count - 1] == UINT32_MAX) count--;
    double way[3] = {0}, scale = 0, unit = 0;
    if (count) find_way(job, place, links[count - 1], way); // the farthest
    for (int c = 0; c < 3; c++) unit = larger(unit, fabs(way[c]));
    if (unit > 0) scale = 1 / unit;
    for (int c = 0; c < 3; c++) fans->own[c][lane] = own[c];
    for (uint32_t i = 0; i < LOCAL_GRAPH_DEGREE; i++) {
        const float *normal = &job->input->normals[3 * (size_t)(i < count ? links[i] : place)];
        const bool there = i < count && (normal[0] != 0 || normal[1] != 0 || normal[2] != 0);
        if (there) find_way(job, place, links[i], way);
        for (int c = 0; c < 3; c++) {
            fans->way[i][c][lane] = there ? (float)(way[c] * scale) : 0;
            fans->normal[i][c][lane] = there ? normal[c] : 0;
        }
    }
    return isfinite(scale) ? unit : 0;
}

static void fit_places(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const curvature_job *job = data;
    const uint32_t begin = task * TASK_PLACES;
    const uint32_t end = job->place_count - begin < TASK_PLACES ? job->place_count : begin + TASK_PLACES;
    local_fans fans;
    float curvature[LANES], trust[LANES];
    double unit[LANES];
    for (uint32_t first = begin; first < end; first += LANES) {
        for (uint32_t lane = 0; lane < LANES; lane++)
            unit[lane] = set_fan(job, first + lane < end ? first + lane : first, lane, &fans);
        job->kernels->curve(&fans, curvature, trust);
        for (uint32_t lane = 0; lane < LANES && first + lane < end; lane++) {
            float *fit = job->fit[first + lane];
            const float value = unit[lane] > 0 ? (float)((double)curvature[lane] / unit[lane]) : 0;
            fit[0] = isfinite(value) ? value : 0;
            const double blunt = (SHARP_BEND - fabs((double)curvature[lane])) / (SHARP_BEND - SOFT_BEND);
            fit[1] = isfinite(value) && unit[lane] > 0 && blunt > 0 ? trust[lane] * (float)(blunt < 1 ? blunt : 1) : 0;
        }
    }
}

/// Sums over a place and its neighbours, by trust.
typedef struct trusted {
    double weight, sum, squares, count;
} trusted;

static inline trusted add_trusted(const curvature_job *job, const float (*curvature)[2], uint32_t place) {
    const uint32_t *links = job->input->links[place];
    const double value = (double)curvature[place][0], weight = (double)curvature[place][1];
    trusted all = {weight, value * weight, value * value * weight, 1};
    for (int i = 0; i < LOCAL_GRAPH_DEGREE && links[i] != UINT32_MAX; i++) {
        const float *other = curvature[links[i]];
        const double trust = (double)other[1], part = (double)other[0] * trust;
        all.sum += part, all.squares += (double)other[0] * part, all.weight += trust, all.count++;
    }
    return all;
}

/// Takes the noise of single places out of what they and their neighbours say: that of saddles, which bend little in the
/// mean, is as large as they are.
static void smooth_places(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const curvature_job *job = data;
    const uint32_t begin = task * TASK_PLACES;
    const uint32_t end = job->place_count - begin < TASK_PLACES ? job->place_count : begin + TASK_PLACES;
    for (uint32_t place = begin; place < end; place++) {
        const trusted all = add_trusted(job, (const float(*)[2])job->fit, place);
        job->smooth[place][0] = all.weight > 0 ? (float)(all.sum / all.weight) : 0;
        job->smooth[place][1] = (float)(all.weight / all.count);
    }
}

/// The mean of a place and its neighbours by trust, less how far these are apart: places beside an edge do not agree, nor
/// do those of rough ground, and a contour that stays fat is better than one that is torn.
static float average(const curvature_job *job, uint32_t place) {
    const trusted all = add_trusted(job, (const float(*)[2])job->smooth, place);
    if (!(all.weight > 0)) return 0;
    const double mean = all.sum / all.weight, variance = all.squares / all.weight - mean * mean;
    const double size = fabs(mean) - (variance > 0 ? sqrt(variance) : 0), enough = AGREEING_SHARE * all.count;
    if (!(size > 0)) return 0;
    return (float)copysign(all.weight < enough ? size * all.weight / enough : size, mean);
}

static void average_places(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const curvature_job *job = data;
    const uint32_t begin = task * TASK_PLACES;
    const uint32_t end = job->place_count - begin < TASK_PLACES ? job->place_count : begin + TASK_PLACES;
    for (uint32_t place = begin; place < end; place++) {
        const float mean = job->mean[place] = average(job, place);
        atomic_init(&job->states[place], (uint8_t)(ROUNDS + (mean > 0 ? CONVEX : mean < 0 ? CONCAVE : FLAT)));
    }
}

static inline uint8_t state_of(const curvature_job *job, uint32_t place) {
    return atomic_load_explicit(&job->states[place], memory_order_relaxed);
}

/// Whether no more than DISSENTING neighbours bend to the other side, do not bend, or have dropped out in an earlier round. Who drops out in this
/// one counts still, so that it does not matter who is asked first.
static bool is_shared(const curvature_job *job, uint32_t place, uint8_t side) {
    const uint32_t *links = job->input->links[place];
    // What bends to this side and has not dropped out earlier lies in [there, side + ROUNDS].
    const uint8_t there = (uint8_t)(side + job->round), rounds_left = (uint8_t)(ROUNDS - job->round);
    uint32_t others = 0;
    for (uint32_t i = 0; i < LOCAL_GRAPH_DEGREE; i++) {
        const uint32_t link = links[i] == UINT32_MAX ? place : links[i]; // there are none: the place agrees with itself
        others += (uint8_t)(state_of(job, link) - there) > rounds_left;
    }
    return others <= DISSENTING;
}

static void drop_places(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    curvature_job *job = data;
    const uint32_t begin = task * TASK_PLACES;
    const uint32_t end = job->place_count - begin < TASK_PLACES ? job->place_count : begin + TASK_PLACES;
    bool any = false;
    for (uint32_t place = begin; place < end; place++) {
        const uint8_t state = state_of(job, place), side = state & SIDES;
        if (side == FLAT || state - side < ROUNDS || is_shared(job, place, side)) continue;
        atomic_store_explicit(&job->states[place], (uint8_t)(job->round + side), memory_order_relaxed);
        any = true;
    }
    if (any) atomic_store_explicit(&job->any_dropped, true, memory_order_relaxed);
}

static void hand_out(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const curvature_job *job = data;
    const uint32_t begin = task * TASK_PLACES;
    const uint32_t end = job->place_count - begin < TASK_PLACES ? job->place_count : begin + TASK_PLACES;
    for (uint32_t place = begin; place < end; place++) {
        uint32_t count;
        const uint32_t *points = ewa_neighbours_points(job->input->neighbours, place, &count);
        const int rounds = state_of(job, place) & ~SIDES;
        const float share = rounds > WHOLLY ? (float)(rounds - WHOLLY) / (ROUNDS - WHOLLY) : 0;
        for (uint32_t i = 0; i < count; i++) job->input->curvature[points[i]] = share * job->mean[place];
    }
}

/// Leaves the curvatures of what bends to one side for some way around: on rough ground splats that moved at contours would leave gaps, since
/// others beside them do not.
static ewa_status leave_shared(ewa_context *context, curvature_job *job, uint32_t tasks) {
    bool any = true; // where none drops out in a round, none does later
    for (job->round = 0; job->round < ROUNDS && any; job->round++) {
        atomic_init(&job->any_dropped, false);
        EWA_TRY(ewa_parallel_stoppable(context, "estimate", drop_places, job, tasks));
        any = atomic_load_explicit(&job->any_dropped, memory_order_relaxed);
    }
    return ewa_parallel_stoppable(context, "estimate", hand_out, job, tasks);
}

static void copy_positions(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const curvature_job *job = data;
    const uint32_t begin = task * TASK_PLACES;
    const uint32_t count = job->place_count - begin < TASK_PLACES ? job->place_count - begin : TASK_PLACES;
    ewa_neighbours_positions(job->input->neighbours, begin, count, job->position + begin);
}

ewa_status ewa_curvature_measure(ewa_context *context, const curvature_input *input) {
    curvature_job job = {.input = input,
                         .kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_local_kernels),
                         .place_count = ewa_neighbours_place_count(input->neighbours),
                         .offsets = ewa_neighbours_offsets(input->neighbours)};
    const uint32_t tasks = (job.place_count + TASK_PLACES - 1) / TASK_PLACES;
    if (!job.offsets) job.position = ewa_allocate(context, job.place_count, sizeof *job.position);
    job.fit = ewa_allocate(context, job.place_count, sizeof *job.fit);
    job.smooth = ewa_allocate(context, job.place_count, sizeof *job.smooth);
    job.mean = ewa_allocate(context, job.place_count, sizeof *job.mean);
    job.states = ewa_allocate(context, job.place_count, sizeof *job.states);
    ewa_status status = (job.offsets || job.position) && job.fit && job.smooth && job.mean && job.states ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK && job.position) ewa_parallel(context, copy_positions, &job, tasks);
    if (status == EWA_OK) status = ewa_parallel_stoppable(context, "estimate", fit_places, &job, tasks);
    if (status == EWA_OK) status = ewa_parallel_stoppable(context, "estimate", smooth_places, &job, tasks);
    if (status == EWA_OK) status = ewa_parallel_stoppable(context, "estimate", average_places, &job, tasks);
    if (status == EWA_OK) status = leave_shared(context, &job, tasks);
    ewa_release(context, job.states, job.place_count, sizeof *job.states);
    ewa_release(context, job.mean, job.place_count, sizeof *job.mean);
    ewa_release(context, job.smooth, job.place_count, sizeof *job.smooth);
    ewa_release(context, job.fit, job.place_count, sizeof *job.fit);
    if (job.position) ewa_release(context, job.position, job.place_count, sizeof *job.position);
    return status;
}

/// What links the places of a cloud whose normals are known.
typedef struct link_job {
    const local_kernels *kernels;
    local_batch *batches; // per worker
    uint32_t (*links)[LOCAL_GRAPH_DEGREE];
} link_job;

static void link_places(void *user, const ewa_block *block, uint32_t worker) {
    const link_job *job = user;
    local_surface ignored;
    job->kernels->measure(block, 0, &job->batches[worker], &ignored);
    job->kernels->link(block, &job->batches[worker], &job->links[block->first_place]);
}

/// What the normals of a cloud are read by.
typedef struct normal_job {
    const ewa_neighbours *neighbours;
    const ewa_attribute *normal; // NULL: across the axes
    const ewa_attribute *axes[2];
    float *normals;
} normal_job;

static void read_normals(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const normal_job *job = data;
    const uint32_t places = ewa_neighbours_place_count(job->neighbours), begin = task * TASK_PLACES;
    const uint32_t end = places - begin < TASK_PLACES ? places : begin + TASK_PLACES;
    const bool floats = job->normal && job->normal->type == EWA_F32;
    for (uint32_t place = begin; place < end; place++) {
        uint32_t count;
        double n[3];
        const uint32_t point = ewa_neighbours_points(job->neighbours, place, &count)[0];
        ewa_vec3 unit;
        if (floats) {
            const char *at = (const char *)job->normal->data + (size_t)point * job->normal->stride_bytes;
            for (int c = 0; c < 3; c++) n[c] = (double)((const float *)(const void *)at)[c];
            unit = vec3_load(n);
        } else if (job->normal) {
            ewa_attribute_read_f64(job->normal, point, 1, n);
            unit = vec3_load(n);
        } else {
            ewa_attribute_read_f64(job->axes[0], point, 1, n);
            unit = vec3_load(n);
            ewa_attribute_read_f64(job->axes[1], point, 1, n);
            unit = vec3_cross(unit, vec3_load(n));
        }
        if (!vec3_normalize(&unit)) unit = vec3_make(0, 0, 0);
        float *to = &job->normals[3 * (size_t)place];
        to[0] = (float)unit.x, to[1] = (float)unit.y, to[2] = (float)unit.z;
    }
}

void ewa_curvature_read_normals(const ewa_cloud *cloud, const ewa_neighbours *neighbours, float *normals) {
    normal_job job = {neighbours, ewa_cloud_find(cloud, EWA_NORMAL),
                      {ewa_cloud_find(cloud, EWA_TANGENT_U), ewa_cloud_find(cloud, EWA_TANGENT_V)}, normals};
    ewa_parallel(ewa_cloud_context(cloud), read_normals, &job,
                 (ewa_neighbours_place_count(neighbours) + TASK_PLACES - 1) / TASK_PLACES);
}

static ewa_status measure_cloud(ewa_cloud *cloud, const ewa_neighbours *neighbours, float *curvature) {
    ewa_context *context = ewa_cloud_context(cloud);
    const size_t places = ewa_neighbours_place_count(neighbours), workers = ewa_context_worker_count(context);
    link_job job = {.kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_local_kernels),
                    .batches = ewa_allocate(context, workers, sizeof *job.batches),
                    .links = ewa_allocate(context, places, sizeof *job.links)};
    float *normals = ewa_allocate(context, places, 3 * sizeof *normals);
    ewa_status status = job.batches && job.links && normals ? EWA_OK : EWA_ERROR_MEMORY;
    const ewa_visit_choice choice = {LOCAL_GRAPH_DEGREE, 1, NULL, "estimate", 0, NULL};
    if (status == EWA_OK) status = ewa_neighbours_visit(neighbours, &choice, link_places, &job);
    if (status == EWA_OK) {
        ewa_curvature_read_normals(cloud, neighbours, normals);
        const curvature_input input = {neighbours, (const uint32_t(*)[LOCAL_GRAPH_DEGREE])job.links, normals,
                                       curvature};
        status = ewa_curvature_measure(context, &input);
    }
    ewa_release(context, normals, places, 3 * sizeof *normals);
    ewa_release(context, job.links, places, sizeof *job.links);
    ewa_release(context, job.batches, workers, sizeof *job.batches);
    return status;
}

void ewa_curvature_drop_flat(ewa_cloud *cloud) {
    const ewa_attribute *made = ewa_cloud_find(cloud, EWA_CURVATURE);
    const float *values = made->data;
    bool bends = false;
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud) && !bends; i++) bends = values[i] != 0;
    if (!bends) ewa_cloud_remove(cloud, EWA_CURVATURE);
}

ewa_status ewa_curvature_add(ewa_cloud *cloud) {
    ewa_neighbours *neighbours = NULL;
    void *points = NULL;
    EWA_TRY(ewa_cloud_add(cloud, EWA_CURVATURE, EWA_F32, 1, &points));
    memset(points, 0, sizeof(float) * ewa_cloud_point_count(cloud));
    ewa_status status = ewa_neighbours_create(ewa_cloud_context(cloud), ewa_cloud_find(cloud, EWA_POSITION),
                                              (uint32_t)ewa_cloud_point_count(cloud), &neighbours);
    if (status == EWA_OK) status = measure_cloud(cloud, neighbours, points);
    ewa_neighbours_destroy(&neighbours);
    if (status == EWA_OK)
        ewa_curvature_drop_flat(cloud);
    else
        ewa_cloud_remove(cloud, EWA_CURVATURE);
    return status;
}

bool ewa_curvature_is_lacking(const ewa_cloud *cloud) {
    const ewa_attribute *curvature = ewa_cloud_find(cloud, EWA_CURVATURE);
    if (!curvature) return !ewa_cloud_find(cloud, EWA_CLIP0);
    bool lacking = false;
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud) && !lacking; i++) {
        double value[4];
        ewa_attribute_read_f64(curvature, i, 1, value);
        lacking = isnan(value[0]);
    }
    return lacking;
}

/// Makes a cloud of what curvatures of some points are measured by.
static ewa_status select_places(const ewa_cloud *cloud, const uint64_t *points, uint64_t count, ewa_cloud **part) {
    static const char *const names[] = {EWA_POSITION, EWA_NORMAL, EWA_TANGENT_U, EWA_TANGENT_V};
    ewa_cloud *bare = NULL;
    ewa_status status = ewa_cloud_create(ewa_cloud_context(cloud), ewa_cloud_point_count(cloud), &bare);
    for (size_t k = 0; k < sizeof names / sizeof names[0] && status == EWA_OK; k++) {
        const ewa_attribute *a = ewa_cloud_find(cloud, names[k]);
        if (a) status = ewa_cloud_borrow(bare, a->name, a->type, a->component_count, a->data, a->stride_bytes);
    }
    if (status == EWA_OK) status = ewa_cloud_select(bare, points, count, part);
    ewa_cloud_destroy(&bare);
    return status;
}

ewa_status ewa_curvature_complete(ewa_cloud *cloud) {
    if (!ewa_curvature_is_lacking(cloud)) return EWA_OK;
    const ewa_attribute *known = ewa_cloud_find(cloud, EWA_CURVATURE);
    if (!known || known->component_count != 1) return ewa_curvature_add(cloud);
    ewa_context *context = ewa_cloud_context(cloud);
    const uint64_t count = ewa_cloud_point_count(cloud);
    uint64_t *points = ewa_allocate(context, count, sizeof *points), lacking = 0;
    double *values = ewa_allocate(context, count, sizeof *values);
    ewa_cloud *part = NULL;
    void *data = NULL;
    ewa_status status = points && values ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) {
        ewa_attribute_read_f64(known, 0, count, values);
        for (uint64_t i = 0; i < count; i++)
            if (isnan(values[i])) points[lacking++] = i;
        status = select_places(cloud, points, lacking, &part);
    }
    if (status == EWA_OK) status = ewa_curvature_add(part);
    const ewa_attribute *found = status == EWA_OK ? ewa_cloud_find(part, EWA_CURVATURE) : NULL;
    for (uint64_t k = 0; k < lacking && status == EWA_OK; k++)
        values[points[k]] = found ? (double)((const float *)found->data)[k] : 0;
    if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_CURVATURE, EWA_F64, 1, &data);
    if (status == EWA_OK) memcpy(data, values, count * sizeof *values);
    ewa_cloud_destroy(&part);
    ewa_release(context, values, count, sizeof *values);
    ewa_release(context, points, count, sizeof *points);
    return status;
}
