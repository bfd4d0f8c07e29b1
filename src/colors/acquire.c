// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Textures onto surfels: options, surfels with their charts, the nearest pixel and the filtered colour, and
// where the colours go (docs/math.md section 10).
// Based on M. Zwicker, H. Pfister, J. van Baar, M. Gross, "Surface Splatting", 2001, section 5.
#include "colors/acquire.h"
#include "base/base.h"
#include "base/options.h"
#include "cloud/cloud.h"
#include "cloud/morton.h"
#include "colors/acquire_stretch.h"
#include "homogeneous/frame.h"
#include "image/srgb.h"

#include <string.h>

/// What is darker than this share of opaque has no colour of its own to divide out.
#define MIN_ALPHA (1.0 / 512)

typedef struct acquire_job {
    ewa_acquire_set set;
    const ewa_acquire_options *options;
    const ewa_image *images;
    const ewa_attribute *position, *normal, *radius, *tangent[2], *clip[2], *clip_mode;
    const ewa_attribute *texcoord, *gradient[2], *texture, *part, *color;
    double (*colors)[4];
    uint32_t channel_count;
    float *output;
} acquire_job;

#define AT(member) offsetof(ewa_acquire_options, member)

static const ewa_option option_rows[] = {
    {"filter", EWA_OPTION_CHOICE, AT(filter), .words = "nearest|ewa|optimal", .initial = EWA_TEXTURE_OPTIMAL,
     .help = "nearest: the pixel at the point; ewa: the mean under the surfel; optimal: the sharpest, by "
             "least squares, colours may leave [0, 1]"},
    {"fit", EWA_OPTION_CHOICE, AT(fit), .words = "normalized|sum",
     .help = "what optimal colours minimise: the error of the surface as it is drawn, or the paper's sum"},
    {"wrap_s", EWA_OPTION_CHOICE, AT(wrap_s), .words = "repeat|clamp",
     .help = "what lies beyond the left and right edges"},
    {"wrap_t", EWA_OPTION_CHOICE, AT(wrap_t), .words = "repeat|clamp",
     .help = "what lies beyond the lower and upper edges"},
    {"pixel_sigma_px", EWA_OPTION_F64, AT(pixel_sigma_px), 0.3, 8, .initial = 0.5, .unit = "px",
     .help = "standard deviation of the Gaussian that stands for one pixel of the picture, in pixels"},
    {"cutoff", EWA_OPTION_F64, AT(cutoff), 0, 4, EWA_OPTION_ABOVE, .initial = 3,
     .help = "standard deviations in a radius"},
    {"ridge", EWA_OPTION_F64, AT(ridge), 1e-6, 1, .initial = 5e-3,
     .help = "pull of the optimal colours towards the filtered ones"},
    {"modulate", EWA_OPTION_BOOL, AT(modulate), .help = "multiply with the colours that the cloud has"},
};

const ewa_option_table ewa_acquire_options_table = EWA_OPTION_TABLE(ewa_acquire_options, option_rows);

void ewa_acquire_options_init(ewa_acquire_options *options, size_t struct_size) {
    ewa_options_init(&ewa_acquire_options_table, options, struct_size);
}

static ewa_status find_streams(const ewa_cloud *cloud, acquire_job *job) {
    ewa_context *context = job->set.context;
    const struct {
        const char *name;
        uint32_t components; ///< 0: 3 or 4
        bool needed;
        const ewa_attribute **to;
    } rows[] = {
        {EWA_POSITION, 3, true, &job->position},      {EWA_TEXCOORD, 2, true, &job->texcoord},
        {EWA_TEXCOORD_S, 3, true, &job->gradient[0]}, {EWA_TEXCOORD_T, 3, true, &job->gradient[1]},
        {EWA_NORMAL, 3, false, &job->normal},         {EWA_RADIUS, 1, false, &job->radius},
        {EWA_TANGENT_U, 3, false, &job->tangent[0]},  {EWA_TANGENT_V, 3, false, &job->tangent[1]},
        {EWA_CLIP0, 3, false, &job->clip[0]},         {EWA_CLIP1, 3, false, &job->clip[1]},
        {EWA_CLIP_MODE, 1, false, &job->clip_mode},   {EWA_TEXTURE, 1, false, &job->texture},
        {EWA_TEXTURE_PART, 1, false, &job->part},     {EWA_COLOR, 0, false, &job->color},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const ewa_attribute *found = ewa_cloud_find(cloud, rows[i].name);
        *rows[i].to = found;
        if (!found && rows[i].needed)
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "texture: the cloud has no '%s'", rows[i].name);
        if (!found) continue;
        const uint32_t count = found->component_count;
        if (rows[i].components ? count != rows[i].components : count < 3)
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "texture: '%s' has %u components", rows[i].name,
                            count);
    }
    if (!job->tangent[0] || !job->tangent[1]) job->tangent[0] = job->tangent[1] = NULL;
    if (job->tangent[0]) job->radius = NULL;
    if (!job->tangent[0] && !(job->normal && job->radius))
        return ewa_fail(context, EWA_ERROR_ARGUMENT,
                        "texture: the cloud has neither '%s' with '%s' nor '%s' with '%s'", EWA_NORMAL,
                        EWA_RADIUS, EWA_TANGENT_U, EWA_TANGENT_V);
    if (!job->options->modulate) job->color = NULL;
    job->set.has_parts = job->part != NULL;
    return EWA_OK;
}

static void read_vector(const ewa_attribute *attribute, uint64_t point, double *values) {
    if (attribute) ewa_attribute_read_f64(attribute, point, 1, values);
}

/// Full scale of integers of a type, 0 for floats.
static double full_scale(ewa_type type) {
    static const double scales[] = {0, 0, 127, 255, 32767, 65535, 2147483647.0, 4294967295.0};
    return scales[type];
}

/// What the texture is multiplied with, premultiplied.
static void read_tint(const acquire_job *job, uint64_t index, float tint[4]) {
    double color[4] = {1, 1, 1, 1};
    if (job->color) {
        const double scale = full_scale(job->color->type);
        read_vector(job->color, index, color);
        for (uint32_t c = 0; c < job->color->component_count && scale > 0; c++) {
            const double unit = fmin(fmax(color[c] / scale, 0), 1);
            color[c] = c < 3 ? ewa_srgb_decode(unit) : unit;
        }
    }
    for (int c = 0; c < 4; c++)
        if (!isfinite(color[c])) color[c] = 1;
    for (int c = 0; c < 3; c++) tint[c] = (float)(color[c] * color[3]);
    tint[3] = (float)color[3];
}

static bool is_finite3(const double v[3]) { return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]); }

/// Sets normal and axes; what is no surfel keeps zeros.
static void read_shape(const acquire_job *job, uint64_t index, ewa_acquire_point *point) {
    double normal[3] = {0}, u[3] = {0}, v[3] = {0}, radius = 0;
    read_vector(job->normal, index, normal);
    read_vector(job->radius, index, &radius);
    read_vector(job->tangent[0], index, u);
    read_vector(job->tangent[1], index, v);
    ewa_vec3 n = vec3_load(normal), tu = vec3_load(u), tv = vec3_load(v);
    if (job->tangent[0]) {
        if (!is_finite3(normal) || !job->normal || vec3_dot(n, n) == 0) n = vec3_cross(tu, tv);
        if (!is_finite3(u) || !is_finite3(v) || vec3_length(vec3_cross(tu, tv)) == 0) return;
    }
    if (!vec3_normalize(&n) || !is_finite3(point->place)) return;
    if (!job->tangent[0]) {
        const double sigma = radius / job->options->cutoff;
        if (!(sigma > 0 && sigma < INFINITY)) return;
        ewa_vec3 axis[2];
        ewa_frame_of(n, axis);
        tu = vec3_scale(axis[0], sigma);
        tv = vec3_scale(axis[1], sigma);
    }
    const double rows[3][3] = {{n.x, n.y, n.z}, {tu.x, tu.y, tu.z}, {tv.x, tv.y, tv.z}};
    for (int c = 0; c < 3; c++) {
        point->normal[c] = (float)rows[0][c];
        point->axis[0][c] = (float)rows[1][c];
        point->axis[1][c] = (float)rows[2][c];
    }
}

/// Clip lines as half spaces. Of a pair of which either holds (a concave corner) none is kept: hardly
/// anything is cut away there.
static void read_sides(const acquire_job *job, uint64_t index, ewa_acquire_point *point) {
    double mode = 0;
    read_vector(job->clip_mode, index, &mode);
    if (!job->tangent[0] || mode == 1) return;
    const ewa_vec3 u = vec3_make((double)point->axis[0][0], (double)point->axis[0][1],
                                 (double)point->axis[0][2]),
                   v = vec3_make((double)point->axis[1][0], (double)point->axis[1][1],
                                 (double)point->axis[1][2]);
    const double uu = vec3_dot(u, u), uv = vec3_dot(u, v), vv = vec3_dot(v, v), d = uu * vv - uv * uv;
    if (!(d > 0)) return;
    for (int k = 0; k < 2; k++) {
        double line[3] = {0};
        read_vector(job->clip[k], index, line);
        if (!is_finite3(line)) continue;
        // a u + b v of a place is g . (place - centre), g in the plane of the axes.
        const double gu = (line[0] * vv - line[1] * uv) / d, gv = (line[1] * uu - line[0] * uv) / d;
        const ewa_vec3 g = vec3_add(vec3_scale(u, gu), vec3_scale(v, gv));
        const double length = vec3_length(g);
        if (!(length > 0)) continue;
        const double side[4] = {g.x / length, g.y / length, g.z / length, line[2] / length};
        for (int c = 0; c < 4; c++) point->side[point->side_count][c] = (float)side[c];
        point->side_count++;
    }
}

static void read_chart(const acquire_job *job, uint64_t index, ewa_acquire_point *point) {
    double at[2] = {0}, gradient[2][3] = {{0}}, texture = 0, part = 0;
    read_vector(job->texcoord, index, at);
    read_vector(job->gradient[0], index, gradient[0]);
    read_vector(job->gradient[1], index, gradient[1]);
    read_vector(job->texture, index, &texture);
    read_vector(job->part, index, &part);
    point->part = part >= 0 && part <= UINT32_MAX ? (uint32_t)part : 0;
    point->texture = EWA_ACQUIRE_NO_TEXTURE;
    if (!(texture >= 0 && texture < job->set.texture_count)) return;
    const ewa_texture *picture = &job->set.textures[(uint32_t)texture];
    if (!picture->level_count || !isfinite(at[0]) || !isfinite(at[1]) || !is_finite3(gradient[0]) ||
        !is_finite3(gradient[1]))
        return;
    const double width = picture->levels[0].width_px, height = picture->levels[0].height_px;
    point->texture = (uint32_t)texture;
    point->at_px[0] = width * at[0];
    point->at_px[1] = height * (1 - at[1]);
    for (int c = 0; c < 3; c++) {
        point->gradient[0][c] = (float)(width * gradient[0][c]);
        point->gradient[1][c] = (float)(-height * gradient[1][c]);
    }
}

static void read_points(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const acquire_job *job = data;
    const ewa_acquire_stretch range = ewa_acquire_range(&job->set, part);
    for (uint32_t i = range.first; i < range.end; i++) {
        ewa_acquire_point *point = &job->set.points[i];
        const uint64_t index = job->set.order[i];
        *point = (ewa_acquire_point){0};
        read_vector(job->position, index, point->place);
        read_shape(job, index, point);
        read_sides(job, index, point);
        read_chart(job, index, point);
        read_tint(job, index, point->tint);
    }
}

static bool is_surfel(const ewa_acquire_point *point) {
    return point->axis[0][0] != 0 || point->axis[0][1] != 0 || point->axis[0][2] != 0;
}

static void filter_points(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const acquire_job *job = data;
    const ewa_acquire_set *set = &job->set;
    const ewa_acquire_stretch range = ewa_acquire_range(&job->set, part);
    for (uint32_t i = range.first; i < range.end; i++) {
        const ewa_acquire_point *point = &set->points[i];
        double *color = job->colors[i];
        if (job->options->filter != EWA_TEXTURE_NEAREST && is_surfel(point)) {
            ewa_acquire_pair alone;
            ewa_acquire_single(point, &alone);
            ewa_acquire_look(set, point, &alone, color);
            continue;
        }
        for (int c = 0; c < 4; c++) color[c] = 1;
        if (point->texture != EWA_ACQUIRE_NO_TEXTURE)
            ewa_texture_nearest(&set->textures[point->texture], point->at_px[0], point->at_px[1], color);
        for (int c = 0; c < 4; c++) color[c] *= (double)point->tint[c];
    }
}

/// Back to the order of the cloud, and to straight alpha.
static void write_points(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const acquire_job *job = data;
    const ewa_acquire_stretch range = ewa_acquire_range(&job->set, part);
    for (uint32_t i = range.first; i < range.end; i++) {
        float *to = job->output + (size_t)job->set.order[i] * job->channel_count;
        const double *color = job->colors[i];
        const bool divides = job->channel_count == 4 && color[3] > MIN_ALPHA;
        for (int c = 0; c < 3; c++) to[c] = (float)(divides ? color[c] / color[3] : color[c]);
        if (job->channel_count == 4) to[3] = (float)fmin(fmax(color[3], 0), 1);
    }
}

/// The first of the pictures that has the pixels of another: many materials may have one.
static uint32_t first_alike(const acquire_job *job, uint32_t index) {
    const ewa_image *image = &job->images[index];
    uint32_t first = 0;
    while (job->images[first].pixels != image->pixels || job->images[first].width_px != image->width_px ||
           job->images[first].height_px != image->height_px ||
           job->images[first].channel_count != image->channel_count)
        first++;
    return first;
}

/// Makes the textures, of alike pictures the first; the others are views of it.
static ewa_status make_textures(acquire_job *job) {
    ewa_acquire_set *set = &job->set;
    set->textures = ewa_allocate_zeroed(set->context, set->texture_count, sizeof *set->textures);
    if (!set->textures) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < set->texture_count; i++) {
        if (!job->images[i].pixels) continue;
        const uint32_t first = first_alike(job, i);
        ewa_image image = job->images[i];
        image.context = set->context;
        if (first == i)
            EWA_TRY(ewa_texture_make(&image, job->options->wrap_s, job->options->wrap_t, &set->textures[i]));
        set->textures[i] = set->textures[first];
    }
    return EWA_OK;
}

static void free_textures(acquire_job *job) {
    ewa_acquire_set *set = &job->set;
    for (uint32_t i = 0; set->textures && i < set->texture_count; i++)
        if (set->textures[i].level_count && first_alike(job, i) == i) ewa_texture_free(&set->textures[i]);
    ewa_release(set->context, set->textures, set->texture_count, sizeof *set->textures);
}

/// The larger standard deviation of a kernel.
static double sigma_of(const ewa_acquire_point *point) {
    double maximum = 0;
    for (int k = 0; k < 2; k++) {
        const ewa_vec3 t =
            vec3_make((double)point->axis[k][0], (double)point->axis[k][1], (double)point->axis[k][2]);
        maximum = fmax(maximum, vec3_dot(t, t));
    }
    return sqrt(maximum);
}

/// Mean of the sizes that have the binary exponent of the median: what is usual, whatever the outliers.
static double usual_sigma(const ewa_acquire_set *set) {
    enum { EXPONENTS = 512 }; // of floats, and of their squares' roots
    uint32_t counts[EXPONENTS] = {0}, surfels = 0, below = 0;
    double sums[EXPONENTS] = {0};
    for (uint32_t i = 0; i < set->count; i++) {
        if (!is_surfel(&set->points[i])) continue;
        const double sigma = sigma_of(&set->points[i]);
        int exponent;
        frexp(sigma, &exponent);
        counts[exponent + EXPONENTS / 2]++;
        sums[exponent + EXPONENTS / 2] += sigma;
        surfels++;
    }
    int middle = 0;
    while (middle < EXPONENTS - 1 && 2 * (below + counts[middle]) < surfels + 1) below += counts[middle++];
    return surfels ? sums[middle] / counts[middle] : 1;
}

/// Counts what is textured, and finds out about sizes and alpha.
static void fill_report(acquire_job *job, ewa_acquire_report *report) {
    ewa_acquire_set *set = &job->set;
    bool opaque = true;
    for (uint32_t i = 0; i < set->count; i++) {
        const ewa_acquire_point *point = &set->points[i];
        report->textured_count += point->texture != EWA_ACQUIRE_NO_TEXTURE;
        opaque = opaque && point->tint[3] >= 1 &&
                 (point->texture == EWA_ACQUIRE_NO_TEXTURE || set->textures[point->texture].opaque);
    }
    set->usual_sigma_world = usual_sigma(set);
    job->channel_count = opaque ? 3 : 4;
}

static ewa_status run(ewa_cloud *cloud, acquire_job *job, ewa_acquire_report *report) {
    ewa_acquire_set *set = &job->set;
    ewa_context *context = set->context;
    const bool is_optimal = job->options->filter == EWA_TEXTURE_OPTIMAL;
    EWA_TRY(find_streams(cloud, job));
    EWA_TRY(make_textures(job));
    set->order = ewa_allocate(context, set->count, sizeof *set->order);
    set->points = ewa_allocate(context, set->count, sizeof *set->points);
    job->colors = ewa_allocate(context, set->count, sizeof *job->colors);
    if (!set->order || !set->points || !job->colors) return EWA_ERROR_MEMORY;
    EWA_TRY(ewa_morton_order(context, job->position, set->count, set->order, NULL, NULL));
    EWA_TRY(ewa_acquire_run(set, read_points, job, 0, 0.1));
    fill_report(job, report);
    ewa_status status = ewa_acquire_run(set, filter_points, job, 0.1, is_optimal ? 0.2 : 1);
    if (status == EWA_OK && is_optimal)
        status = ewa_acquire_optimize(set, job->options, job->channel_count, job->colors, report);
    void *output = NULL;
    if (status == EWA_OK) status = ewa_progress(context, "texture", 1);
    if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_COLOR, EWA_F32, job->channel_count, &output);
    job->output = output;
    if (status == EWA_OK)
        ewa_parallel(context, write_points, job, (set->count + EWA_ACQUIRE_TASK_POINTS - 1) / EWA_ACQUIRE_TASK_POINTS);
    return status;
}

ewa_status ewa_cloud_acquire(ewa_cloud *cloud, const ewa_image *textures, uint32_t texture_count,
                             const ewa_acquire_options *given, ewa_acquire_report *report) {
    if (!cloud || (!textures && texture_count)) return EWA_ERROR_ARGUMENT;
    ewa_context *context = ewa_cloud_context(cloud);
    ewa_acquire_options chosen, *options = &chosen;
    ewa_acquire_options_init(options, sizeof *options);
    ewa_acquire_report ignored;
    if (!report) report = &ignored;
    *report = (ewa_acquire_report){0};
    EWA_TRY(ewa_options_take(context, &ewa_acquire_options_table, given, options));
    if (ewa_cloud_point_count(cloud) >= UINT32_MAX)
        return ewa_fail(context, EWA_ERROR_LIMIT, "texture: more than 4294967294 points");
    acquire_job job = {.options = options, .images = textures};
    job.set = (ewa_acquire_set){
        .context = context,
        .count = (uint32_t)ewa_cloud_point_count(cloud),
        .texture_count = texture_count,
        .cutoff = options->cutoff,
        .pixel_variance_px2 = options->pixel_sigma_px * options->pixel_sigma_px,
    };
    const ewa_status status = run(cloud, &job, report);
    free_textures(&job);
    ewa_release(context, job.set.order, job.set.count, sizeof *job.set.order);
    ewa_release(context, job.set.points, job.set.count, sizeof *job.set.points);
    ewa_release(context, job.colors, job.set.count, sizeof *job.colors);
    return status;
}
