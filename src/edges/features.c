// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sharp edges and corners of a cloud: which neighbourhoods to look at, what fits them, what neighbours
// confirm.
#include "edges/features.h"
#include "base/base.h"
#include "base/options.h"
#include "cloud/cloud.h"
#include "estimate/local.h"
#include "math/angle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    MIN_NEIGHBOURS = 16,
    EXACT_NEIGHBOURS = 24,
    NOISE_NEIGHBOURS = 32, // the neighbourhoods that noise is measured in
    NOISE_BLOCKS = 512,    // about as many are measured
    ROUNDS = 2,            // of averaging
    TASK_PLACES = 1 << 14,
};

// Neighbours that are added per spacing of noise.
#define NOISE_GAIN 160.0
// The share of variance along the normal of a fold at the reach of a disc, over the squared tangent of half
// its angle.
#define FOLD_VARIATION 0.02
// Planes of neighbours are the same when their normals differ by less than 18 degrees, and where they are by
// less than this share of the spacing.
#define SAME_COSINE 0.95
#define SAME_HEIGHT 0.6
// Neighbours closer to an edge than this many spacings vote on it.
#define VOTER_REACH 1.5

typedef struct feature_job {
    ewa_context *context;
    const local_kernels *kernels;
    ewa_neighbours *neighbours;
    uint32_t place_count, neighbour_count, model_count;
    double noise, cos_threshold, min_variation;
    float (*normals)[3]; // by place, unit or zero
    float *spacing;      // by place, world units
    float *noise_of;     // by place: of the measured ones, else negative
    uint8_t *chosen;     // by place
    uint32_t *slot;      // by place: index of its model
    feature_model *models, *averaged;
    local_batch *batches; // per worker
    ewa_attribute normal;
} feature_job;

/// Collects the neighbourhood of a lane, in block units.
static void gather(const feature_job *job, const ewa_block *block, uint32_t lane, feature_points *points) {
    points->count = 0;
    for (uint32_t i = 0; i < block->candidate_count && points->count < FEATURE_POINTS; i++) {
        if (!(block->distance2[i][lane] <= block->radius2[lane])) continue;
        const uint32_t n = points->count++;
        points->x[n] = (double)block->x[i] - (double)block->lane_x[lane];
        points->y[n] = (double)block->y[i] - (double)block->lane_y[lane];
        points->z[n] = (double)block->z[i] - (double)block->lane_z[lane];
        memcpy(points->normal[n], job->normals[block->place[i]], sizeof points->normal[n]);
    }
}

/// Measures the noise around the first place of a block.
static void visit_noise(void *user, const ewa_block *block, uint32_t worker) {
    const feature_job *job = user;
    local_surface s;
    job->kernels->measure(block, 0, &job->batches[worker], &s);
    feature_points points;
    gather(job, block, 0, &points);
    const double spacing = (double)s.spacing[0];
    if (spacing > 0)
        job->noise_of[block->first_place] = (float)(ewa_feature_quadric_residual(&points) / spacing);
}

/// Chooses the places whose neighbourhoods are not flat.
static void visit_choose(void *user, const ewa_block *block, uint32_t worker) {
    const feature_job *job = user;
    local_surface s;
    job->kernels->measure(block, 0, &job->batches[worker], &s);
    for (uint32_t lane = 0; lane < block->lane_count; lane++) {
        const uint32_t place = block->first_place + lane;
        job->spacing[place] = (float)((double)s.spacing[lane] * block->unit_world);
        job->chosen[place] = (double)s.variation[lane] > job->min_variation && !(s.degenerate >> lane & 1);
    }
}

static void visit_fit(void *user, const ewa_block *block, uint32_t worker) {
    (void)worker;
    const feature_job *job = user;
    for (uint32_t lane = 0; lane < block->lane_count; lane++) {
        const uint32_t place = block->first_place + lane, slot = job->slot[place];
        if (slot == UINT32_MAX) continue;
        feature_points points;
        gather(job, block, lane, &points);
        const double spacing = (double)job->spacing[place] / block->unit_world;
        const feature_scale scale = {spacing, job->noise * spacing, job->cos_threshold};
        feature_model *model = &job->models[slot];
        ewa_feature_fit(&points, &scale, model);
        for (uint32_t p = 0; p < model->plane_count; p++) model->offset[p] *= block->unit_world;
    }
}

/// The model of a neighbour, relative to the place `from` it by `offset`.
static feature_model moved(const feature_model *model, const double offset[3]) {
    feature_model made = *model;
    for (uint32_t p = 0; p < made.plane_count; p++) {
        const double *n = made.normal[p];
        made.offset[p] += n[0] * offset[0] + n[1] * offset[1] + n[2] * offset[2];
    }
    return made;
}

/// The nearest plane of a model that is plane p of another one; UINT32_MAX when there is none.
static uint32_t same_plane(const feature_model *model, const feature_model *other, uint32_t p,
                           double height) {
    uint32_t best = UINT32_MAX;
    double closest = SAME_COSINE;
    for (uint32_t q = 0; q < other->plane_count; q++) {
        const double *a = model->normal[p], *b = other->normal[q];
        const double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        if (cosine <= closest || fabs(model->offset[p] - other->offset[q]) > height) continue;
        closest = cosine;
        best = q;
    }
    return best;
}

/// One neighbour with a model, relative to the lane.
typedef struct neighbour_model {
    feature_model model;
    double distance2;
} neighbour_model;

/// Whether a place is within reach of an edge of the model.
static bool is_near(const feature_model *model, const double place[3], double reach) {
    feature_line lines[2];
    bool either;
    return ewa_feature_lines(model, ewa_feature_active(model, place), place, reach, lines, &either) > 0;
}

/// Adopts the model of the nearest neighbour whose edge is in reach, where the place has none.
static void adopt(const ewa_block *block, uint32_t lane, const feature_job *job, double reach,
                  feature_model *model) {
    const double middle[3] = {0, 0, 0};
    float nearest = INFINITY;
    for (uint32_t i = 0; i < block->candidate_count; i++) {
        const uint32_t slot = job->slot[block->place[i]];
        if (!(block->distance2[i][lane] <= block->radius2[lane]) || !(block->distance2[i][lane] < nearest) ||
            slot == UINT32_MAX || job->models[slot].plane_count == 0)
            continue;
        const double offset[3] = {((double)block->x[i] - (double)block->lane_x[lane]) * block->unit_world,
                                  ((double)block->y[i] - (double)block->lane_y[lane]) * block->unit_world,
                                  ((double)block->z[i] - (double)block->lane_z[lane]) * block->unit_world};
        const feature_model other = moved(&job->models[slot], offset);
        if (!is_near(&other, middle, reach)) continue;
        nearest = block->distance2[i][lane];
        *model = other;
    }
}

/// What neighbours say about a model.
typedef struct poll {
    uint32_t voters, agreeing;
    double normal[FEATURE_PLANES][3], offset[FEATURE_PLANES];
    uint32_t count[FEATURE_PLANES]; // how many planes were added up
} poll;

static void ask(const feature_model *model, const feature_model *other, bool votes, double height,
                poll *result) {
    uint32_t same[FEATURE_PLANES], found = 0;
    for (uint32_t p = 0; p < model->plane_count; p++) {
        same[p] = same_plane(model, other, p, height);
        found += same[p] != UINT32_MAX;
    }
    // An edge agrees with a corner that it runs into, and the other way round.
    const bool agrees = other->plane_count && (found == model->plane_count || found == other->plane_count);
    result->voters += votes;
    result->agreeing += votes && agrees;
    if (!agrees) return;
    for (uint32_t p = 0; p < model->plane_count; p++) {
        if (same[p] == UINT32_MAX) continue;
        for (int c = 0; c < 3; c++) result->normal[p][c] += other->normal[same[p]][c];
        result->offset[p] += other->offset[same[p]];
        result->count[p]++;
    }
}

/// Sets the planes to the means of those that agree; false when too few do.
static bool settle(const poll *result, feature_model *model) {
    if (result->agreeing < 3 || 2 * result->agreeing < result->voters) return false;
    for (uint32_t p = 0; p < model->plane_count; p++) {
        const double *n = result->normal[p];
        const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        if (result->count[p] < 3 || !(length > 0)) return false;
        for (int c = 0; c < 3; c++) model->normal[p][c] = n[c] / length;
        model->offset[p] = result->offset[p] / result->count[p];
    }
    return true;
}

static void visit_agree(void *user, const ewa_block *block, uint32_t worker) {
    (void)worker;
    const feature_job *job = user;
    for (uint32_t lane = 0; lane < block->lane_count; lane++) {
        const uint32_t place = block->first_place + lane, own = job->slot[place];
        if (own == UINT32_MAX) continue;
        const double spacing = (double)job->spacing[place];
        feature_model model = job->models[own];
        if (!model.plane_count) adopt(block, lane, job, VOTER_REACH * spacing, &model);
        poll result = {0};
        for (uint32_t i = 0; i < block->candidate_count && model.plane_count; i++) {
            if (!(block->distance2[i][lane] <= block->radius2[lane])) continue;
            const double offset[3] = {((double)block->x[i] - (double)block->lane_x[lane]) * block->unit_world,
                                      ((double)block->y[i] - (double)block->lane_y[lane]) * block->unit_world,
                                      ((double)block->z[i] - (double)block->lane_z[lane]) *
                                          block->unit_world};
            const uint32_t slot = job->slot[block->place[i]];
            feature_model other = {0};
            if (slot != UINT32_MAX) other = moved(&job->models[slot], offset);
            const bool votes = is_near(&model, offset, VOTER_REACH * spacing);
            ask(&model, &other, votes, SAME_HEIGHT * spacing, &result);
        }
        if (model.plane_count && !settle(&result, &model)) model.plane_count = 0;
        job->averaged[own] = model;
    }
}

static void normals_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const feature_job *job = data;
    const uint32_t begin = task * TASK_PLACES;
    const uint32_t end = job->place_count - begin < TASK_PLACES ? job->place_count : begin + TASK_PLACES;
    for (uint32_t place = begin; place < end; place++) {
        uint32_t count;
        double n[3];
        ewa_attribute_read_f64(&job->normal, ewa_neighbours_points(job->neighbours, place, &count)[0], 1, n);
        const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        const double scale = length > 0 && isfinite(length) ? 1 / length : 0;
        for (int c = 0; c < 3; c++) job->normals[place][c] = scale > 0 ? (float)(n[c] * scale) : 0;
    }
}

static int compare_floats(const void *a, const void *b) {
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/// The median of what the sample of neighbourhoods says.
static ewa_status measure_noise(feature_job *job) {
    for (uint32_t place = 0; place < job->place_count; place++) job->noise_of[place] = -1;
    const uint32_t step = job->place_count / (EWA_BLOCK_LANES * NOISE_BLOCKS);
    const ewa_visit_choice choice = {NOISE_NEIGHBOURS, step ? step : 1, NULL, "noise", 0, NULL};
    EWA_TRY(ewa_neighbours_visit(job->neighbours, &choice, visit_noise, job));
    uint32_t count = 0;
    for (uint32_t place = 0; place < job->place_count; place++)
        if (job->noise_of[place] >= 0) job->noise_of[count++] = job->noise_of[place];
    qsort(job->noise_of, count, sizeof *job->noise_of, compare_floats);
    job->noise = count ? fmin((double)job->noise_of[count / 2], 1) : 0;
    return EWA_OK;
}

/// Numbers the chosen places and makes room for their models.
static ewa_status number_models(feature_job *job) {
    job->model_count = 0;
    for (uint32_t place = 0; place < job->place_count; place++)
        job->slot[place] = job->chosen[place] ? job->model_count++ : UINT32_MAX;
    job->models = ewa_allocate_zeroed(job->context, job->model_count, sizeof *job->models);
    job->averaged = ewa_allocate_zeroed(job->context, job->model_count, sizeof *job->averaged);
    return job->models && job->averaged ? EWA_OK : EWA_ERROR_MEMORY;
}

static ewa_status detect(feature_job *job, const ewa_feature_options *options) {
    ewa_parallel(job->context, normals_task, job, (job->place_count + TASK_PLACES - 1) / TASK_PLACES);
    job->noise = options->noise;
    ewa_status status = EWA_OK;
    if (options->noise < 0) status = measure_noise(job);
    const double wanted = EXACT_NEIGHBOURS + NOISE_GAIN * job->noise;
    job->neighbour_count = options->neighbour_count;
    if (!job->neighbour_count)
        job->neighbour_count = wanted < EWA_NEIGHBOURS_MAX ? (uint32_t)wanted : EWA_NEIGHBOURS_MAX;
    const double half = ewa_tan(options->angle_deg * EWA_PI / 360), half2 = half * half;
    job->cos_threshold = (1 - half2) / (1 + half2);
    // The neighbourhood is a disc of k spacings squared; its variance is half of its squared radius. What
    // noise adds varies by sqrt(2 / k) of itself.
    const double k = job->neighbour_count, from_noise = 2 * EWA_PI * job->noise * job->noise / k;
    job->min_variation = from_noise * (1 + 2 * sqrt(2 / k)) + FOLD_VARIATION * half2;
    ewa_visit_choice choice = {job->neighbour_count, 1, NULL, "choose", 0, NULL};
    EWA_TRY(status);
    EWA_TRY(ewa_neighbours_visit(job->neighbours, &choice, visit_choose, job));
    EWA_TRY(number_models(job));
    choice.chosen = job->chosen;
    choice.stage = "fit";
    EWA_TRY(ewa_neighbours_visit(job->neighbours, &choice, visit_fit, job));
    choice.stage = "agree";
    for (int round = 0; round < ROUNDS && status == EWA_OK; round++) {
        status = ewa_neighbours_visit(job->neighbours, &choice, visit_agree, job);
        feature_model *swap = job->models;
        job->models = job->averaged;
        job->averaged = swap;
    }
    return status;
}

static ewa_status detect_with(ewa_cloud *cloud, const ewa_feature_options *options, feature_job *job,
                              ewa_feature_counts *counts) {
    ewa_context *context = job->context;
    const size_t places = job->place_count;
    job->normals = ewa_allocate(context, places, sizeof *job->normals);
    job->spacing = ewa_allocate(context, places, sizeof *job->spacing);
    job->noise_of = ewa_allocate(context, places, sizeof *job->noise_of);
    job->chosen = ewa_allocate(context, places, sizeof *job->chosen);
    job->slot = ewa_allocate(context, places, sizeof *job->slot);
    const size_t workers = ewa_context_worker_count(context);
    job->batches = ewa_allocate(context, workers, sizeof *job->batches);
    ewa_status status = EWA_ERROR_MEMORY;
    if (job->normals && job->spacing && job->noise_of && job->chosen && job->slot && job->batches)
        status = detect(job, options);
    if (status == EWA_OK) {
        counts->noise = job->noise;
        counts->neighbour_count = job->neighbour_count;
        ewa_neighbours_end_visits(job->neighbours);
        const feature_result result = {job->neighbours, job->slot, job->models, job->spacing, job->noise};
        status = ewa_feature_write(cloud, options, &result, counts);
    }
    ewa_release(context, job->averaged, job->model_count, sizeof *job->averaged);
    ewa_release(context, job->models, job->model_count, sizeof *job->models);
    ewa_release(context, job->batches, workers, sizeof *job->batches);
    ewa_release(context, job->slot, places, sizeof *job->slot);
    ewa_release(context, job->chosen, places, sizeof *job->chosen);
    ewa_release(context, job->noise_of, places, sizeof *job->noise_of);
    ewa_release(context, job->spacing, places, sizeof *job->spacing);
    ewa_release(context, job->normals, places, sizeof *job->normals);
    return status;
}

static bool has_components(const ewa_cloud *cloud, const char *name, uint32_t components) {
    const ewa_attribute *attribute = ewa_cloud_find(cloud, name);
    return attribute && attribute->component_count == components;
}

static ewa_status check(const ewa_cloud *cloud) {
    ewa_context *context = ewa_cloud_context(cloud);
    const bool has_axes = has_components(cloud, EWA_TANGENT_U, 3) && has_components(cloud, EWA_TANGENT_V, 3);
    if (!has_components(cloud, EWA_POSITION, 3) || !has_components(cloud, EWA_NORMAL, 3) ||
        !(has_axes || has_components(cloud, EWA_RADIUS, 1)))
        return ewa_fail(
            context, EWA_ERROR_ARGUMENT,
            "features: the cloud needs 'position' and 'normal' of three components, and 'radius' or "
            "'tangent_u' and 'tangent_v'");
    if (ewa_cloud_point_count(cloud) >= UINT32_MAX)
        return ewa_fail(context, EWA_ERROR_LIMIT, "features: %llu points are over the limit of 2^32 - 2",
                        (unsigned long long)ewa_cloud_point_count(cloud));
    return EWA_OK;
}

#define AT(member) offsetof(ewa_feature_options, member)

static const ewa_option option_rows[] = {
    {"neighbour_count", EWA_OPTION_U32, AT(neighbour_count), MIN_NEIGHBOURS, EWA_NEIGHBOURS_MAX,
     EWA_OPTION_OR_ZERO,
     .help = "nearest neighbours that planes are fitted to; 0: 24 for exact points up to 64 for noisy ones"},
    {"angle_deg", EWA_OPTION_F64, AT(angle_deg), 10, 120, .initial = 30, .unit = "deg",
     .help =
         "smallest angle between the normals of two planes that meet in an edge; less is a smooth surface"},
    {"noise", EWA_OPTION_F64, AT(noise), -INFINITY, 1, EWA_OPTION_ABOVE, .initial = -1,
     .help = "standard deviation of the points from the surface in units of the spacing; negative: measured"},
    {"cutoff", EWA_OPTION_F64, AT(cutoff), 0, 4, EWA_OPTION_ABOVE, .initial = 3,
     .help = "standard deviations at which kernels end: axes are the support radius over this"},
    {"project", EWA_OPTION_BOOL, AT(project), .initial = true,
     .help = "move the points beside an edge onto their plane"},
};

const ewa_option_table ewa_feature_options_table = EWA_OPTION_TABLE(ewa_feature_options, option_rows);

void ewa_feature_options_init(ewa_feature_options *options, size_t struct_size) {
    ewa_options_init(&ewa_feature_options_table, options, struct_size);
}

ewa_status ewa_cloud_detect_features(ewa_cloud *cloud, const ewa_feature_options *given,
                                     ewa_feature_counts *counts) {
    if (!cloud || !given) return EWA_ERROR_ARGUMENT;
    ewa_feature_counts found = {0};
    if (counts) *counts = found;
    ewa_context *context = ewa_cloud_context(cloud);
    ewa_feature_options chosen, *options = &chosen;
    ewa_feature_options_init(options, sizeof *options);
    EWA_TRY(ewa_options_take(context, &ewa_feature_options_table, given, options));
    EWA_TRY(check(cloud));
    feature_job job = {.context = context,
                       .kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_local_kernels),
                       .normal = *ewa_cloud_find(cloud, EWA_NORMAL)};
    EWA_TRY(ewa_neighbours_create(context, ewa_cloud_find(cloud, EWA_POSITION),
                                  (uint32_t)ewa_cloud_point_count(cloud), &job.neighbours));
    job.place_count = ewa_neighbours_place_count(job.neighbours);
    ewa_status status = detect_with(cloud, options, &job, &found);
    ewa_neighbours_destroy(&job.neighbours);
    if (status == EWA_OK && counts) *counts = found;
    return status;
}
