// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Surfels beside edges: plane, axes and clip lines from the model of their place.
#include "base/base.h"
#include "cloud/border.h"
#include "cloud/cloud.h"
#include "edges/features.h"
#include "estimate/curvature.h"
#include "homogeneous/frame.h"

#include <math.h>
#include <string.h>

enum { TASK_POINTS = 1 << 14 };

// Behind a line nothing adds to the coverage: supports of clipped surfels are longer by these factors.
#define STRETCH_ACROSS 1.5
#define STRETCH_ALONG  1.1
// Points farther from their plane than this many standard deviations, or this share of the spacing, are of
// something else.
#define OUTLIER_NOISE   4.0
#define OUTLIER_SPACING 0.3

/// A stream that is edited: floats or doubles that the cloud owns.
typedef struct edited {
    float *f32;
    double *f64;
} edited;

typedef struct write_job {
    const feature_result *result;
    uint32_t *place_of; // by point; UINT32_MAX: at none
    uint64_t point_count;
    double cutoff;
    bool project;
    edited position, normal;
    const ewa_attribute *radius; // NULL: axes are there
    const ewa_attribute *border; // of discs; NULL: none
    float (*u)[3], (*v)[3], (*clip[2])[3];
    uint8_t *either;
    uint32_t (*counted)[3]; // by task: snapped, with one line, with two
} write_job;

static void add_to(edited *stream, uint64_t point, int component, double value) {
    if (stream->f32)
        stream->f32[3 * point + (uint64_t)component] =
            (float)((double)stream->f32[3 * point + (uint64_t)component] + value);
    else
        stream->f64[3 * point + (uint64_t)component] += value;
}

static double get(const edited *stream, uint64_t point, int component) {
    const uint64_t at = 3 * point + (uint64_t)component;
    return stream->f32 ? (double)stream->f32[at] : stream->f64[at];
}

/// Two unit vectors with u x v = n.
static void make_frame(const double n[3], double u[3], double v[3]) {
    ewa_vec3 axis[2];
    ewa_frame_of(vec3_load(n), axis);
    vec3_store(axis[0], u);
    vec3_store(axis[1], v);
}

/// The standard deviation of a round kernel with the area of the surfel's.
static double size_of(const write_job *job, uint64_t point) {
    if (job->radius) {
        double radius;
        ewa_attribute_read_f64(job->radius, point, 1, &radius);
        return radius / job->cutoff;
    }
    double uu = 0, vv = 0;
    for (int c = 0; c < 3; c++) {
        uu += (double)job->u[point][c] * (double)job->u[point][c];
        vv += (double)job->v[point][c] * (double)job->v[point][c];
    }
    return sqrt(sqrt(uu) * sqrt(vv));
}

/// Gives a disc its axes.
static void set_axes(const write_job *job, uint64_t point, double sigma) {
    double n[3], u[3], v[3], length2 = 0;
    for (int c = 0; c < 3; c++) {
        n[c] = get(&job->normal, point, c);
        length2 += n[c] * n[c];
    }
    const bool has_plane = length2 > 0 && isfinite(length2);
    for (int c = 0; c < 3 && has_plane; c++) n[c] /= sqrt(length2);
    if (has_plane) make_frame(n, u, v);
    for (int c = 0; c < 3; c++) {
        job->u[point][c] = has_plane ? (float)(sigma * u[c]) : 0;
        job->v[point][c] = has_plane ? (float)(sigma * v[c]) : 0;
    }
}

/// Snaps a point to its plane; returns the number of its clip lines.
static uint32_t snap(write_job *job, uint64_t point, const feature_model *model, uint32_t active,
                     double height) {
    static const double middle[3] = {0, 0, 0};
    const double sigma = size_of(job, point), *n = model->normal[active];
    feature_line lines[2];
    bool either;
    const uint32_t count =
        ewa_feature_lines(model, active, middle, FEATURE_REACH * sigma * job->cutoff, lines, &either);
    double side = 0, u[3], v[3];
    for (int c = 0; c < 3; c++) side += n[c] * get(&job->normal, point, c);
    const double sign = side < 0 ? -1 : 1;
    for (int c = 0; c < 3; c++) add_to(&job->normal, point, c, sign * n[c] - get(&job->normal, point, c));
    for (int c = 0; c < 3 && job->project; c++) add_to(&job->position, point, c, -height * n[c]);
    make_frame(n, u, v);
    if (count) {
        memcpy(v, lines[0].across, sizeof v);
        for (int c = 0; c < 3; c++) u[c] = v[(c + 1) % 3] * n[(c + 2) % 3] - v[(c + 2) % 3] * n[(c + 1) % 3];
    }
    // u x v is along the cloud's normal.
    const double across = sigma * (count ? STRETCH_ACROSS : 1);
    const double along = sign * sigma * (count > 1 ? STRETCH_ACROSS : count ? STRETCH_ALONG : 1);
    for (int c = 0; c < 3; c++) {
        job->u[point][c] = (float)(along * u[c]);
        job->v[point][c] = (float)(across * v[c]);
    }
    for (uint32_t k = 0; k < count; k++) {
        double a = 0, b = 0;
        for (int c = 0; c < 3; c++) {
            a += lines[k].across[c] * u[c] * along;
            b += lines[k].across[c] * v[c] * across;
        }
        const double scale = 1 / sqrt(a * a + b * b);
        job->clip[k][point][0] = k == 0 ? 0 : (float)(a * scale); // the frame follows the first line
        job->clip[k][point][1] = (float)(b * scale);
        job->clip[k][point][2] = (float)(lines[k].distance * scale);
    }
    job->either[point] = count == 2 && either;
    return count;
}

/// Gives a disc that got axes the clip line of its border.
static void set_border(const write_job *job, uint64_t point) {
    const float *u = job->u[point], *v = job->v[point];
    const double axis_u[3] = {(double)u[0], (double)u[1], (double)u[2]},
                 axis_v[3] = {(double)v[0], (double)v[1], (double)v[2]};
    double to[3], line[3];
    ewa_attribute_read_f64(job->border, point, 1, to);
    ewa_border_line(to, axis_u, axis_v, line);
    for (int c = 0; c < 3; c++) job->clip[0][point][c] = (float)line[c];
}

static void write_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    static const double middle[3] = {0, 0, 0};
    write_job *job = data;
    const feature_result *result = job->result;
    const uint64_t begin = (uint64_t)task * TASK_POINTS;
    const uint64_t end = job->point_count - begin < TASK_POINTS ? job->point_count : begin + TASK_POINTS;
    for (uint64_t point = begin; point < end; point++) {
        const uint32_t place = job->place_of[point];
        const uint32_t slot = place == UINT32_MAX ? UINT32_MAX : result->slot[place];
        if (slot != UINT32_MAX && result->models[slot].plane_count) {
            const feature_model *model = &result->models[slot];
            const double spacing = (double)result->spacing[place];
            const uint32_t active = ewa_feature_active(model, middle);
            const double height = feature_height(model, active, middle);
            if (fabs(height) <= spacing * fmax(OUTLIER_NOISE * result->noise, OUTLIER_SPACING)) {
                const uint32_t lines = snap(job, point, model, active, height);
                job->counted[task][0]++;
                if (lines) job->counted[task][lines]++;
                if (!lines && job->border) set_border(job, point);
                continue;
            }
        }
        if (job->radius) set_axes(job, point, size_of(job, point));
        if (job->border) set_border(job, point);
    }
}

/// Makes a stream of three components one that the cloud owns and that holds floats or doubles.
static ewa_status edit_stream(ewa_cloud *cloud, const char *name, edited *stream) {
    ewa_context *context = ewa_cloud_context(cloud);
    const ewa_attribute *found = ewa_cloud_find(cloud, name);
    const bool wide = found->type == EWA_F64;
    const uint64_t count = ewa_cloud_point_count(cloud);
    const size_t size = wide ? sizeof(double) : sizeof(float);
    void *data = found->data;
    if (found->borrowed || (!wide && found->type != EWA_F32)) {
        void *copy = ewa_allocate(context, 3 * count, size);
        if (!copy) return EWA_ERROR_MEMORY;
        if (wide)
            ewa_attribute_read_f64(found, 0, count, copy);
        else
            ewa_attribute_read_f32(found, 0, count, copy);
        const ewa_status status = ewa_cloud_add(cloud, name, wide ? EWA_F64 : EWA_F32, 3, &data);
        if (status == EWA_OK) memcpy(data, copy, 3 * count * size);
        ewa_release(context, copy, 3 * count, size);
        EWA_TRY(status);
    }
    *stream = (edited){wide ? NULL : data, wide ? data : NULL};
    return EWA_OK;
}

/// Makes the axes a stream of floats, from those that the cloud has or for its radii.
static ewa_status edit_axes(ewa_cloud *cloud, const char *name, bool given, float (**axes)[3]) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    void *data = NULL;
    float *copy = NULL;
    if (given) {
        copy = ewa_allocate(ewa_cloud_context(cloud), 3 * count, sizeof *copy);
        if (!copy) return EWA_ERROR_MEMORY;
        ewa_attribute_read_f32(ewa_cloud_find(cloud, name), 0, count, copy);
    }
    const ewa_status status = ewa_cloud_add(cloud, name, EWA_F32, 3, &data);
    if (status == EWA_OK && given) memcpy(data, copy, 3 * count * sizeof *copy);
    ewa_release(ewa_cloud_context(cloud), copy, 3 * count, sizeof *copy);
    *axes = data;
    return status;
}

static ewa_status add_zeros(ewa_cloud *cloud, const char *name, ewa_type type, uint32_t components,
                            void **data) {
    EWA_TRY(ewa_cloud_add(cloud, name, type, components, data));
    memset(*data, 0, components * ewa_type_bytes(type) * ewa_cloud_point_count(cloud));
    return EWA_OK;
}

static bool is_axis(const ewa_cloud *cloud, const char *name) {
    const ewa_attribute *attribute = ewa_cloud_find(cloud, name);
    return attribute && attribute->component_count == 3;
}

static ewa_status prepare_streams(ewa_cloud *cloud, write_job *job) {
    const bool has_axes = is_axis(cloud, EWA_TANGENT_U) && is_axis(cloud, EWA_TANGENT_V);
    void *clip[2] = {NULL, NULL}, *either = NULL;
    EWA_TRY(edit_stream(cloud, EWA_POSITION, &job->position));
    EWA_TRY(edit_stream(cloud, EWA_NORMAL, &job->normal));
    EWA_TRY(edit_axes(cloud, EWA_TANGENT_U, has_axes, &job->u));
    EWA_TRY(edit_axes(cloud, EWA_TANGENT_V, has_axes, &job->v));
    EWA_TRY(add_zeros(cloud, EWA_CLIP0, EWA_F32, 3, &clip[0]));
    EWA_TRY(add_zeros(cloud, EWA_CLIP1, EWA_F32, 3, &clip[1]));
    EWA_TRY(add_zeros(cloud, EWA_CLIP_MODE, EWA_U8, 1, &either));
    job->clip[0] = clip[0], job->clip[1] = clip[1], job->either = either;
    job->radius = has_axes ? NULL : ewa_cloud_find(cloud, EWA_RADIUS);
    job->border = has_axes ? NULL : ewa_cloud_find(cloud, EWA_BORDER);
    return EWA_OK;
}

static void drop_clips(ewa_cloud *cloud) {
    ewa_cloud_remove(cloud, EWA_CLIP0);
    ewa_cloud_remove(cloud, EWA_CLIP1);
    ewa_cloud_remove(cloud, EWA_CLIP_MODE);
}

/// Fills the table from points to places; returns whether any place has a model.
static bool find_places(const feature_result *result, uint32_t *place_of) {
    bool any = false;
    for (uint32_t place = 0; place < ewa_neighbours_place_count(result->neighbours); place++) {
        uint32_t count;
        const uint32_t *points = ewa_neighbours_points(result->neighbours, place, &count);
        for (uint32_t i = 0; i < count; i++) place_of[points[i]] = place;
        any = any || (result->slot[place] != UINT32_MAX && result->models[result->slot[place]].plane_count);
    }
    return any;
}

ewa_status ewa_feature_write(ewa_cloud *cloud, const ewa_feature_options *options,
                             const feature_result *result, ewa_feature_counts *counts) {
    ewa_context *context = ewa_cloud_context(cloud);
    write_job job = {.result = result,
                     .point_count = ewa_cloud_point_count(cloud),
                     .cutoff = options->cutoff,
                     .project = options->project};
    const uint32_t tasks = (uint32_t)((job.point_count + TASK_POINTS - 1) / TASK_POINTS);
    job.place_of = ewa_allocate(context, job.point_count, sizeof *job.place_of);
    job.counted = ewa_allocate_zeroed(context, tasks, sizeof *job.counted);
    ewa_status status = job.place_of && job.counted ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) {
        memset(job.place_of, 0xff, job.point_count * sizeof *job.place_of);
        drop_clips(cloud);
        if (find_places(result, job.place_of)) {
            status = prepare_streams(cloud, &job);
            if (status == EWA_OK)
                ewa_parallel(context, write_task, &job, tasks);
            else
                drop_clips(cloud);
            if (status == EWA_OK && job.radius) ewa_cloud_remove(cloud, EWA_RADIUS);
            if (status == EWA_OK) ewa_cloud_remove(cloud, EWA_BORDER);
            // It was measured across edges, by normals that turned round them.
            if (status == EWA_OK && ewa_cloud_find(cloud, EWA_CURVATURE)) status = ewa_curvature_add(cloud);
        }
    }
    for (uint32_t task = 0; task < tasks && status == EWA_OK; task++) {
        counts->snapped_count += job.counted[task][0];
        counts->edge_count += job.counted[task][1];
        counts->corner_count += job.counted[task][2];
    }
    ewa_release(context, job.counted, tasks, sizeof *job.counted);
    ewa_release(context, job.place_of, job.point_count, sizeof *job.place_of);
    return status;
}
