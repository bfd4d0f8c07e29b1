// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Solid textures onto the points of a cloud.
#include "ewa/procedure.h"
#include "base/base.h"
#include "base/options.h"
#include "cloud/cloud.h"
#include "cloud/color.h"
#include "colors/pattern.h"

#include <string.h>

enum {
    TASK_POINTS = 1024,
    STAGE_TASKS = 256, // between two reports of progress
};

typedef struct color_job {
    const ewa_procedure_options *options;
    const ewa_attribute *position, *normal, *radius, *tangent[2], *color;
    double origin_world[3];
    pattern pattern;
    uint64_t point_count;
    uint32_t component_count;
    uint32_t first_task;
    uint8_t *made;
} color_job;

static ewa_vec3 read_vec3(const ewa_attribute *attribute, uint64_t point) {
    double v[3];
    ewa_attribute_read_f64(attribute, point, 1, v);
    return vec3_load(v);
}

/// Axes of the kernel, times the prefilter; zero for what is no surfel.
static void read_footprint(const color_job *job, uint64_t point, pattern_footprint *footprint) {
    const double scale = job->options->prefilter;
    footprint->u = footprint->v = vec3_make(0, 0, 0);
    if (!(scale > 0)) return;
    if (job->tangent[0]) {
        footprint->u = vec3_scale(read_vec3(job->tangent[0], point), scale);
        footprint->v = vec3_scale(read_vec3(job->tangent[1], point), scale);
    } else {
        double radius;
        ewa_attribute_read_f64(job->radius, point, 1, &radius);
        ewa_vec3 normal = read_vec3(job->normal, point);
        if (!(radius > 0) || !vec3_normalize(&normal)) return;
        const ewa_vec3 helper = fabs(normal.x) < 0.6 ? vec3_make(1, 0, 0) : vec3_make(0, 1, 0);
        ewa_vec3 along = vec3_cross(helper, normal);
        vec3_normalize(&along);
        const double sigma = scale * radius / job->options->cutoff;
        footprint->u = vec3_scale(along, sigma);
        footprint->v = vec3_scale(vec3_cross(normal, along), sigma);
    }
    if (!vec3_is_finite(footprint->u) || !vec3_is_finite(footprint->v))
        footprint->u = footprint->v = vec3_make(0, 0, 0);
}

static void color_points(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const color_job *job = data;
    const uint64_t first = (uint64_t)(job->first_task + index) * TASK_POINTS;
    const uint64_t end = first + TASK_POINTS < job->point_count ? first + TASK_POINTS : job->point_count;
    for (uint64_t i = first; i < end; i++) {
        pattern_footprint footprint;
        read_footprint(job, i, &footprint);
        footprint.place = vec3_add(read_vec3(job->position, i), vec3_load(job->origin_world));
        const double share =
            vec3_is_finite(footprint.place) ? ewa_pattern_mean(&job->pattern, &footprint) : 0.5;
        uint8_t *to = job->made + i * job->component_count;
        for (int c = 0; c < 3; c++) {
            const double low = (double)job->options->colors[0][c], high = (double)job->options->colors[1][c];
            to[c] = ewa_srgb8_from_linear((float)(low + share * (high - low)));
        }
        if (job->component_count == 4) {
            double value[4];
            ewa_attribute_read_f64(job->color, i, 1, value);
            to[3] = (uint8_t)(255 * ewa_color_alpha(job->color, value) + 0.5);
        }
    }
}

#define AT(member) offsetof(ewa_procedure_options, member)

static const ewa_option option_rows[] = {
    {"procedure", EWA_OPTION_CHOICE, AT(procedure), .words = "checker|marble|wood|noise",
     .help = "which solid texture"},
    {"frequency", EWA_OPTION_F64, AT(frequency), 0, 1e9, EWA_OPTION_ABOVE, .initial = 8,
     .help = "features per world unit: cubes, veins, rings, waves"},
    {"prefilter", EWA_OPTION_F64, AT(prefilter), 0, 10, .initial = 1,
     .help = "width of the filter in units of the surfel's kernel; 0: none, which aliases"},
    {"cutoff", EWA_OPTION_F64, AT(cutoff), 0, 4, EWA_OPTION_ABOVE, .initial = 3,
     .help = "standard deviations at which kernels end"},
    {"seed", EWA_OPTION_U64, AT(seed), 0, INFINITY, EWA_OPTION_BELOW, .initial = 1,
     .help = "same seed, same noise"},
    {"colors", EWA_OPTION_F32, AT(colors), 0, 1, .count = 6,
     .help = "two linear colours, whose defaults go with the procedure"},
};

const ewa_option_table ewa_procedure_options_table = EWA_OPTION_TABLE(ewa_procedure_options, option_rows);

void ewa_procedure_options_init(ewa_procedure_options *options, ewa_procedure procedure, size_t struct_size) {
    static const float colors[][2][3] = {
        {{0.82f, 0.80f, 0.76f}, {0.035f, 0.04f, 0.06f}},
        {{0.86f, 0.84f, 0.80f}, {0.06f, 0.075f, 0.11f}},
        {{0.62f, 0.33f, 0.13f}, {0.17f, 0.06f, 0.02f}},
        {{0.02f, 0.06f, 0.16f}, {0.92f, 0.86f, 0.72f}},
    };
    ewa_options_init(&ewa_procedure_options_table, options, struct_size);
    if (!options || struct_size < AT(colors) + sizeof options->colors) return;
    options->procedure = procedure;
    if ((unsigned)procedure < sizeof colors / sizeof *colors)
        memcpy(options->colors, colors[procedure], sizeof options->colors);
}

/// A stream of so many components, NULL when there is none such.
static const ewa_attribute *find(const ewa_cloud *cloud, const char *name, uint32_t components) {
    const ewa_attribute *attribute = ewa_cloud_find(cloud, name);
    return attribute && attribute->component_count == components ? attribute : NULL;
}

static ewa_status find_streams(const ewa_cloud *cloud, color_job *job) {
    job->position = find(cloud, EWA_POSITION, 3);
    job->normal = find(cloud, EWA_NORMAL, 3);
    job->radius = find(cloud, EWA_RADIUS, 1);
    job->tangent[0] = find(cloud, EWA_TANGENT_U, 3);
    job->tangent[1] = find(cloud, EWA_TANGENT_V, 3);
    job->color = find(cloud, EWA_COLOR, 4);
    if (!job->tangent[1]) job->tangent[0] = NULL;
    ewa_context *context = ewa_cloud_context(cloud);
    if (!job->position)
        return ewa_fail(context, EWA_ERROR_ARGUMENT,
                        "procedure: the cloud has no 'position' of 3 components");
    if (job->options->prefilter > 0 && !job->tangent[0] && !(job->normal && job->radius))
        return ewa_fail(context, EWA_ERROR_ARGUMENT,
                        "procedure: a prefilter needs 'normal' and 'radius', or 'tangent_u' and 'tangent_v'");
    return EWA_OK;
}

ewa_status ewa_cloud_color_by_procedure(ewa_cloud *cloud, const ewa_procedure_options *given) {
    if (!cloud || !given) return EWA_ERROR_ARGUMENT;
    ewa_context *context = ewa_cloud_context(cloud);
    ewa_procedure_options chosen, *options = &chosen;
    ewa_procedure_options_init(options, EWA_PROCEDURE_CHECKER, sizeof *options);
    color_job job = {.options = options, .point_count = ewa_cloud_point_count(cloud)};
    EWA_TRY(ewa_options_take(context, &ewa_procedure_options_table, given, options));
    EWA_TRY(find_streams(cloud, &job));
    job.component_count = job.color ? 4 : 3;
    ewa_cloud_origin(cloud, job.origin_world);
    ewa_pattern_make(options, &job.pattern);
    const size_t bytes = job.point_count * job.component_count;
    job.made = ewa_allocate(context, bytes, 1);
    if (!job.made) return EWA_ERROR_MEMORY;
    const uint32_t tasks = (uint32_t)((job.point_count + TASK_POINTS - 1) / TASK_POINTS);
    ewa_status status = EWA_OK;
    for (job.first_task = 0; status == EWA_OK && job.first_task < tasks; job.first_task += STAGE_TASKS) {
        status = ewa_progress(context, "procedure", (double)job.first_task / tasks);
        const uint32_t left = tasks - job.first_task;
        if (status == EWA_OK)
            ewa_parallel(context, color_points, &job, left < STAGE_TASKS ? left : STAGE_TASKS);
    }
    if (status == EWA_OK) status = ewa_progress(context, "procedure", 1);
    uint8_t *stream;
    if (status == EWA_OK)
        status = ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, job.component_count, (void **)&stream);
    if (status == EWA_OK) memcpy(stream, job.made, bytes);
    ewa_release(context, job.made, bytes, 1);
    return status;
}
