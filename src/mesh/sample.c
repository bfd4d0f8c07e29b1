// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From a mesh to surfels: options, and what every point gets once the places are chosen.
#include "base/base.h"
#include "base/options.h"
#include "cloud/decimals.h"
#include "estimate/curvature.h"
#include "ewa/acquire.h"
#include "homogeneous/vec.h"
#include "mesh/clip.h"
#include "mesh/color.h"
#include "mesh/poisson_disc.h"

#include <math.h>
#include <string.h>

/// Between looks at whether to go on, as many tasks as keep many workers busy.
enum { TASK_POINTS = 1 << 12 };

/// A mesh that is more than so many spacings long gets places in doubles: floats, from one corner of it,
/// would miss by more than a thousandth of a spacing at the other.
#define WIDE_SPACINGS 16384.0

typedef struct sample_job {
    const mesh_surface *surface;
    const ewa_mesh_sample_options *options;
    const poisson_sample *samples;
    uint64_t count;
    double spacing, unit; // of the samples
    mesh_edge_grid grid;
    mesh_colors colors;
    float *position; // or:
    double *wide_position;
    float *normal, *radius, *tangent_u, *tangent_v, *clip[2];
    uint8_t *color, *clip_mode;
    float *tint, *texcoord, *gradient[2]; // of meshes with pictures, the tint in place of the color
    uint32_t *texture, *part;
    void **attributes; // of the mesh, in their order; NULL: not taken
    uint32_t attribute_count;
} sample_job;

#define AT(member) offsetof(ewa_mesh_sample_options, member)

static const ewa_option option_rows[] = {
    {"point_count", EWA_OPTION_U64, AT(point_count), 0, INFINITY, EWA_OPTION_BELOW, .initial = 100000,
     .help = "about how many points"},
    {"spacing_world", EWA_OPTION_F64, AT(spacing_world), 0, INFINITY, EWA_OPTION_BELOW, .unit = "world",
     .help = "square root of the area per point away from edges, in world units; 0: by the count"},
    {"seed", EWA_OPTION_U64, AT(seed), 0, INFINITY, EWA_OPTION_BELOW, .initial = 1,
     .help = "same seed, same bytes, on every machine"},
    {"crease_degrees", EWA_OPTION_F64, AT(crease_degrees), 0, 180, .initial = 35, .unit = "deg",
     .help = "edges that bend by more are sharp"},
    {"radius_scale", EWA_OPTION_F64, AT(radius_scale), 0.5, 10, .initial = 1.6,
     .help = "support radius in units of the spacing"},
    {"cutoff", EWA_OPTION_F64, AT(cutoff), 0, 4, EWA_OPTION_ABOVE, .initial = 3,
     .help = "standard deviations at which kernels end: axes are the support radius over this"},
    {"clip_lines", EWA_OPTION_BOOL, AT(clip_lines), .initial = true,
     .help = "make sharp edges, corners and borders exact by clip lines"},
    {"smooth_normals", EWA_OPTION_BOOL, AT(smooth_normals), .initial = true,
     .help = "interpolate normals across edges that are not sharp; off: those of the triangles"},
    {"texture_filter", EWA_OPTION_CHOICE, AT(texture_filter), .words = "nearest|ewa|optimal",
     .initial = EWA_TEXTURE_OPTIMAL, .help = "how pictures come onto the points"},
    {"pixel_sigma_px", EWA_OPTION_F64, AT(pixel_sigma_px), 0.3, 8, .initial = 0.5, .unit = "px",
     .help = "standard deviation of the Gaussian that stands for one pixel of a picture, in pixels"},
    {"texcoords", EWA_OPTION_BOOL, AT(texcoords), .help = "keep texture coordinates"},
};

const ewa_option_table ewa_mesh_sample_options_table = EWA_OPTION_TABLE(ewa_mesh_sample_options, option_rows);

void ewa_mesh_sample_options_init(ewa_mesh_sample_options *options, size_t struct_size) {
    ewa_options_init(&ewa_mesh_sample_options_table, options, struct_size);
}

static ewa_status check_count(ewa_context *context, const ewa_mesh_sample_options *options) {
    const uint64_t limit = ewa_context_limits(context)->max_points;
    if (options->spacing_world > 0 || (options->point_count > 0 && options->point_count <= limit))
        return EWA_OK;
    return ewa_fail(context, options->point_count ? EWA_ERROR_LIMIT : EWA_ERROR_ARGUMENT,
                    "sample: point_count is %llu, must be in [1, %llu]",
                    (unsigned long long)options->point_count, (unsigned long long)limit);
}

static ewa_vec3 load_normal(const float n[3]) { return vec3_make((double)n[0], (double)n[1], (double)n[2]); }

/// Weights of the place on a triangle's rim that is nearest to a point; `to` leads from it to the three vertices.
static void weights_on_rim(const ewa_vec3 to[3], double weight[3]) {
    double nearest2 = INFINITY;
    for (int c = 0; c < 3; c++) {
        const int next = (c + 1) % 3;
        const ewa_vec3 edge = vec3_sub(to[next], to[c]);
        const double length2 = vec3_dot(edge, edge);
        const double along = length2 > 0 ? fmin(fmax(-vec3_dot(to[c], edge) / length2, 0), 1) : 0;
        const ewa_vec3 off = vec3_add(to[c], vec3_scale(edge, along));
        const double off2 = vec3_dot(off, off);
        if (!(off2 < nearest2)) continue;
        nearest2 = off2;
        weight[c] = 1 - along;
        weight[next] = along;
        weight[(c + 2) % 3] = 0;
    }
}

/// Weights of the three vertices of a triangle at a sample on it, and its place in the triangle's plane. Samples are
/// rounded to the mesh's unit, and needles may be thinner: what lies beside the triangle is put on its rim.
static ewa_vec3 weights_at(const sample_job *job, const poisson_sample *sample, double weight[3]) {
    const mesh_surface *surface = job->surface;
    const uint32_t *vertex = surface->mesh->triangles + 3 * (size_t)surface->source[sample->triangle];
    const ewa_vec3 n = load_normal(surface->normal[sample->triangle]);
    const ewa_vec3 at = vec3_scale(
        vec3_make((double)sample->at[0] + 0.5, (double)sample->at[1] + 0.5, (double)sample->at[2] + 0.5),
        job->unit);
    ewa_vec3 place[3], to[3], sum_place = {0, 0, 0};
    for (int c = 0; c < 3; c++) {
        place[c] = ewa_mesh_place(surface, vertex[c]);
        to[c] = vec3_sub(place[c], at);
    }
    double sum = 0;
    bool inside = true;
    for (int c = 0; c < 3; c++) {
        weight[c] = vec3_dot(vec3_cross(to[(c + 1) % 3], to[(c + 2) % 3]), n);
        inside &= weight[c] >= 0;
        sum += weight[c];
    }
    inside &= sum > 0;
    for (int c = 0; c < 3 && inside; c++) weight[c] /= sum;
    if (!inside) weights_on_rim(to, weight);
    for (int c = 0; c < 3; c++) sum_place = vec3_add(sum_place, vec3_scale(place[c], weight[c]));
    return sum_place;
}

/// The mesh's own normals at a place; false where one of them is missing or bends from the triangle like a
/// sharp edge.
static bool given_normal_at(const mesh_surface *surface, uint32_t triangle, const double weight[3],
                            ewa_vec3 *normal) {
    const uint32_t *vertex = surface->mesh->triangles + 3 * (size_t)surface->source[triangle];
    const ewa_vec3 flat = load_normal(surface->normal[triangle]);
    ewa_vec3 sum = {0, 0, 0};
    for (int c = 0; c < 3; c++) {
        ewa_vec3 n = load_normal(surface->mesh->normals + 3 * (size_t)vertex[c]);
        if (!vec3_normalize(&n) || !(vec3_dot(n, flat) > fmax(surface->crease_cosine, 0))) return false;
        sum = vec3_add(sum, vec3_scale(n, weight[c]));
    }
    *normal = sum;
    return vec3_normalize(normal);
}

static ewa_vec3 normal_at(const sample_job *job, uint32_t triangle, const double weight[3]) {
    const mesh_surface *surface = job->surface;
    ewa_vec3 sum = {0, 0, 0};
    if (surface->mesh->normals && job->options->smooth_normals &&
        given_normal_at(surface, triangle, weight, &sum))
        return sum;
    sum = vec3_make(0, 0, 0);
    const ewa_vec3 flat = load_normal(surface->normal[triangle]);
    for (int c = 0; c < 3; c++) {
        const float *group = surface->group_normal[surface->corner_group[3 * (size_t)triangle + (size_t)c]];
        const ewa_vec3 n = load_normal(group);
        // At the tip of a cone the mean lies across all of its triangles: discs of that normal would leave gaps.
        const bool tip = !(vec3_dot(n, flat) > fmax(surface->crease_cosine, 0));
        sum = vec3_add(sum, vec3_scale(tip ? flat : n, weight[c]));
    }
    return vec3_normalize(&sum) && vec3_dot(sum, flat) > 0 ? sum : flat;
}

static void store(float *to, ewa_vec3 v, double scale) {
    to[0] = (float)(v.x * scale);
    to[1] = (float)(v.y * scale);
    to[2] = (float)(v.z * scale);
}

/// Keeps a place; returns it as it is kept.
static ewa_vec3 store_place(const sample_job *job, uint64_t i, ewa_vec3 place) {
    if (job->wide_position) {
        vec3_store(place, job->wide_position + 3 * i);
        return place;
    }
    float *to = job->position + 3 * i;
    store(to, place, 1);
    return vec3_make((double)to[0], (double)to[1], (double)to[2]);
}

static void finish_clip(const sample_job *job, uint64_t i, ewa_vec3 place, ewa_vec3 normal) {
    const double radius = job->options->radius_scale * job->spacing, sigma = radius / job->options->cutoff;
    const ewa_vec3 axis = fabs(normal.x) < 0.6 ? vec3_make(1, 0, 0) : vec3_make(0, 1, 0);
    ewa_vec3 u = vec3_cross(axis, normal);
    vec3_normalize(&u);
    const ewa_vec3 v = vec3_cross(normal, u);
    mesh_clip_disc disc = {.radius_world = radius, .part = job->surface->part[job->samples[i].triangle]};
    vec3_store(place, disc.center);
    vec3_store(u, disc.u);
    vec3_store(v, disc.v);
    vec3_store(normal, disc.normal);
    ewa_mesh_clip_disc(&job->grid, &disc);
    store(job->tangent_u + 3 * i, u, sigma);
    store(job->tangent_v + 3 * i, v, sigma);
    for (int k = 0; k < 2; k++) {
        float *line = job->clip[k] + 3 * i;
        line[0] = (float)disc.line[k][0];
        line[1] = (float)disc.line[k][1];
        line[2] = (float)(disc.line[k][2] / sigma);
    }
    job->clip_mode[i] = disc.either;
}

static void finish_color(const sample_job *job, uint64_t i, const double weight[3]) {
    const uint32_t components = job->colors.component_count,
                   triangle = job->surface->source[job->samples[i].triangle];
    float color[4];
    ewa_mesh_color_at(&job->colors, triangle, weight, color);
    if (job->color)
        ewa_mesh_color_encode(&job->colors, color, job->color + components * i);
    else
        memcpy(job->tint + components * i, color, components * sizeof *color);
    if (job->texture) job->texture[i] = job->surface->mesh->triangle_materials[triangle];
}

/// Gives a point the attributes of the vertices around: numbers between theirs, of whole ones those of the nearest.
static void finish_attributes(const sample_job *job, uint64_t i, const double weight[3]) {
    const ewa_mesh *mesh = job->surface->mesh;
    const uint32_t *vertex = mesh->triangles + 3 * (size_t)job->surface->source[job->samples[i].triangle];
    const int nearest = weight[1] > weight[0] ? (weight[2] > weight[1] ? 2 : 1) : weight[2] > weight[0] ? 2 : 0;
    for (uint32_t k = 0; k < job->attribute_count; k++) {
        const ewa_attribute *from = ewa_cloud_attribute_at(mesh->attributes, k);
        const uint32_t components = from->component_count;
        const size_t bytes = components * ewa_type_bytes(from->type);
        uint8_t *to = job->attributes[k];
        if (!to) continue;
        to += i * bytes;
        if (from->type != EWA_F32 && from->type != EWA_F64) {
            memcpy(to, (const uint8_t *)from->data + vertex[nearest] * from->stride_bytes, bytes);
            continue;
        }
        double sum[4] = {0}, numbers[4];
        for (int v = 0; v < 3; v++) {
            ewa_attribute_read_f64(from, vertex[v], 1, numbers);
            for (uint32_t c = 0; c < components && weight[v] != 0; c++) sum[c] += weight[v] * numbers[c];
        }
        for (uint32_t c = 0; c < components; c++) {
            if (from->type == EWA_F32)
                ((float *)(void *)to)[c] = (float)sum[c];
            else
                ((double *)(void *)to)[c] = sum[c];
        }
    }
}

static void finish_points(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const sample_job *job = data;
    const uint64_t first = (uint64_t)part * TASK_POINTS;
    const uint64_t end = first + TASK_POINTS < job->count ? first + TASK_POINTS : job->count;
    for (uint64_t i = first; i < end; i++) {
        const poisson_sample *sample = &job->samples[i];
        double weight[3];
        const ewa_vec3 place = store_place(job, i, weights_at(job, sample, weight));
        const ewa_vec3 normal = normal_at(job, sample->triangle, weight);
        store(job->normal + 3 * i, normal, 1);
        if (job->colors.component_count) finish_color(job, i, weight);
        if (job->attribute_count) finish_attributes(job, i, weight);
        if (job->part) job->part[i] = job->surface->part[sample->triangle];
        if (job->texcoord)
            ewa_mesh_chart_at(job->surface->mesh, job->surface->source[sample->triangle], weight,
                              job->texcoord + 2 * i, job->gradient[0] + 3 * i, job->gradient[1] + 3 * i);
        if (job->radius)
            job->radius[i] = (float)(job->options->radius_scale * job->spacing);
        else
            finish_clip(job, i, place, normal);
    }
}

static ewa_status add_attributes(sample_job *job, ewa_cloud *cloud) {
    const bool sharp = job->surface->edge_count > 0, colored = job->colors.component_count > 0,
               pictures = job->colors.has_pictures, charts = pictures || job->options->texcoords,
               wide = job->unit * 0x1p32 > WIDE_SPACINGS * job->spacing;
    const struct {
        const char *name;
        ewa_type type;
        uint32_t component_count;
        bool wanted;
        void *data;
    } rows[] = {
        {EWA_POSITION, EWA_F32, 3, !wide, &job->position},
        {EWA_POSITION, EWA_F64, 3, wide, &job->wide_position},
        {EWA_NORMAL, EWA_F32, 3, true, &job->normal},
        {EWA_COLOR, EWA_U8, job->colors.component_count, colored && !pictures, &job->color},
        {EWA_COLOR, EWA_F32, job->colors.component_count, pictures, &job->tint},
        {EWA_TEXCOORD, EWA_F32, 2, charts, &job->texcoord},
        {EWA_TEXCOORD_S, EWA_F32, 3, charts, &job->gradient[0]},
        {EWA_TEXCOORD_T, EWA_F32, 3, charts, &job->gradient[1]},
        {EWA_TEXTURE_PART, EWA_U32, 1, charts, &job->part},
        {EWA_TEXTURE, EWA_U32, 1, charts && job->surface->mesh->material_count > 0, &job->texture},
        {EWA_RADIUS, EWA_F32, 1, !sharp, &job->radius},
        {EWA_TANGENT_U, EWA_F32, 3, sharp, &job->tangent_u},
        {EWA_TANGENT_V, EWA_F32, 3, sharp, &job->tangent_v},
        {EWA_CLIP0, EWA_F32, 3, sharp, &job->clip[0]},
        {EWA_CLIP1, EWA_F32, 3, sharp, &job->clip[1]},
        {EWA_CLIP_MODE, EWA_U8, 1, sharp, &job->clip_mode},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if (rows[i].wanted)
            EWA_TRY(ewa_cloud_add(cloud, rows[i].name, rows[i].type, rows[i].component_count, rows[i].data));
    return EWA_OK;
}

/// Adds the attributes of the mesh's vertices, but for names that the points have.
static ewa_status add_vertex_attributes(sample_job *job, ewa_cloud *cloud) {
    const ewa_cloud *from = job->surface->mesh->attributes;
    const uint32_t count = from ? ewa_cloud_attribute_count(from) : 0;
    if (!count) return EWA_OK;
    job->attributes = ewa_allocate_zeroed(job->surface->context, count, sizeof *job->attributes);
    if (!job->attributes) return EWA_ERROR_MEMORY;
    job->attribute_count = count;
    for (uint32_t k = 0; k < count; k++) {
        const ewa_attribute *a = ewa_cloud_attribute_at(from, k);
        if (!ewa_cloud_find(cloud, a->name))
            EWA_TRY(ewa_cloud_add(cloud, a->name, a->type, a->component_count, &job->attributes[k]));
    }
    return EWA_OK;
}

/// The spacing that gives about so many points: of area / s^2 + rows / s = count.
static double choose_spacing(const mesh_surface *surface, const ewa_mesh_sample_options *options) {
    if (options->spacing_world > 0) return options->spacing_world;
    const double count = (double)options->point_count, area = surface->area_below[surface->triangle_count];
    const double rows = ewa_mesh_poisson_rows(surface);
    return (rows + sqrt(rows * rows + 4 * area * count)) / (2 * count);
}

/// Puts the mesh's pictures onto the finished points, and takes away what was needed for that only.
static ewa_status add_pictures(const sample_job *job, ewa_cloud *cloud) {
    const ewa_mesh *mesh = job->surface->mesh;
    ewa_acquire_options options;
    ewa_acquire_options_init(&options, sizeof options);
    options.filter = job->options->texture_filter;
    options.pixel_sigma_px = job->options->pixel_sigma_px;
    options.cutoff = job->options->cutoff;
    options.modulate = true;
    ewa_image *images = ewa_allocate(mesh->context, mesh->material_count, sizeof *images);
    if (!images) return EWA_ERROR_MEMORY;
    for (uint32_t m = 0; m < mesh->material_count; m++)
        images[m] = mesh->textures[mesh->materials[m].texture];
    const ewa_status status = ewa_cloud_acquire(cloud, images, mesh->material_count, &options, NULL);
    ewa_release(mesh->context, images, mesh->material_count, sizeof *images);
    if (job->options->texcoords) return status;
    ewa_cloud_remove(cloud, EWA_TEXCOORD);
    ewa_cloud_remove(cloud, EWA_TEXCOORD_S);
    ewa_cloud_remove(cloud, EWA_TEXCOORD_T);
    ewa_cloud_remove(cloud, EWA_TEXTURE);
    ewa_cloud_remove(cloud, EWA_TEXTURE_PART);
    return status;
}

static ewa_status sample(ewa_context *context, sample_job *job, ewa_cloud **cloud) {
    poisson_sample *samples = NULL;
    uint64_t capacity = 0;
    job->spacing = choose_spacing(job->surface, job->options);
    job->unit = ewa_mesh_poisson_unit(job->surface);
    EWA_TRY(ewa_mesh_sample_poisson_disc(job->surface, job->spacing, job->options->seed, &samples, &capacity,
                                         &job->count));
    job->samples = samples;
    ewa_cloud *made = NULL;
    ewa_status status =
        ewa_mesh_edge_grid_make(job->surface, job->options->radius_scale * job->spacing, &job->grid);
    if (status == EWA_OK) status = ewa_mesh_colors_make(job->surface->mesh, &job->colors);
    if (status == EWA_OK) status = ewa_cloud_create(context, job->count, &made);
    if (status == EWA_OK) status = add_attributes(job, made);
    if (status == EWA_OK) status = add_vertex_attributes(job, made);
    if (status == EWA_OK) ewa_cloud_set_origin(made, job->surface->origin_world);
    if (status == EWA_OK)
        status = ewa_parallel_within(context, "sample", 0.7, 1, finish_points, job,
                                     (uint32_t)((job->count + TASK_POINTS - 1) / TASK_POINTS));
    if (status == EWA_OK) {
        ewa_report(context, EWA_SEVERITY_INFO, "sample: spacing %g, %u triangles, %u sides of sharp edges",
                   job->spacing, job->surface->triangle_count, job->surface->edge_count);
        status = ewa_progress(context, "sample", 1);
    }
    ewa_mesh_edge_grid_free(&job->grid);
    ewa_release(context, job->attributes, job->attribute_count, sizeof *job->attributes);
    ewa_release(context, samples, capacity, sizeof *samples);
    if (status == EWA_OK) status = ewa_curvature_add(made);
    if (status == EWA_OK && job->colors.has_pictures) status = add_pictures(job, made);
    if (status != EWA_OK) ewa_cloud_destroy(&made);
    *cloud = made;
    return status;
}

static ewa_status check_mesh(const ewa_mesh *mesh, const ewa_mesh_sample_options *options) {
    const bool complete =
        (mesh->positions || !mesh->vertex_count) && (mesh->triangles || !mesh->triangle_count) &&
        (!mesh->material_count || (mesh->materials && mesh->triangle_materials && mesh->textures));
    if (!complete) return ewa_fail(mesh->context, EWA_ERROR_ARGUMENT, "sample: the mesh lacks a stream");
    if (options->texcoords && !mesh->texcoords)
        return ewa_fail(mesh->context, EWA_ERROR_ARGUMENT, "sample: the mesh has no texture coordinates");
    if (mesh->attributes && ewa_cloud_point_count(mesh->attributes) != mesh->vertex_count)
        return ewa_fail(mesh->context, EWA_ERROR_ARGUMENT, "sample: attributes of %llu vertices, there are %u",
                        (unsigned long long)ewa_cloud_point_count(mesh->attributes), mesh->vertex_count);
    // Half edges are numbered by 32 bits.
    if (mesh->triangle_count > UINT32_MAX / 4)
        return ewa_fail(mesh->context, EWA_ERROR_LIMIT, "sample: %u triangles, %u can be",
                        mesh->triangle_count, UINT32_MAX / 4);
    return EWA_OK;
}

/// Positions relative to the low corner of all vertices, as exact as the decimals that files have: the same
/// mesh anywhere has the same numbers. NULL without memory.
static double *place_near(const ewa_mesh *mesh, double corner_world[3]) {
    const size_t count = mesh->vertex_count;
    double *near = ewa_allocate(mesh->context, count, 3 * sizeof *near);
    for (int c = 0; c < 3 && near; c++) {
        double low = INFINITY;
        for (size_t i = 0; i < count; i++)
            if (isfinite(mesh->positions[3 * i + (size_t)c]))
                low = fmin(low, mesh->positions[3 * i + (size_t)c]);
        corner_world[c] = isfinite(low) ? low : 0;
        const double parts = ewa_decimals_find(mesh->positions + c, count, 3);
        for (size_t i = 0; i < count; i++)
            near[3 * i + (size_t)c] =
                ewa_decimals_subtract(mesh->positions[3 * i + (size_t)c], corner_world[c], parts);
    }
    return near;
}

ewa_status ewa_mesh_sample(const ewa_mesh *mesh, const ewa_mesh_sample_options *given, ewa_cloud **cloud) {
    if (!mesh || !mesh->context || !cloud) return EWA_ERROR_ARGUMENT;
    *cloud = NULL;
    ewa_mesh_sample_options chosen, *options = &chosen;
    ewa_mesh_sample_options_init(options, sizeof *options);
    EWA_TRY(ewa_options_take(mesh->context, &ewa_mesh_sample_options_table, given, options));
    EWA_TRY(check_count(mesh->context, options));
    EWA_TRY(check_mesh(mesh, options));
    ewa_mesh near = *mesh;
    double corner_world[3];
    near.positions = place_near(mesh, corner_world);
    mesh_surface surface;
    ewa_status status = near.positions ? ewa_mesh_surface_make(&near, options, &surface) : EWA_ERROR_MEMORY;
    if (status == EWA_OK) {
        sample_job job = {.surface = &surface, .options = options};
        status = sample(mesh->context, &job, cloud);
        ewa_mesh_surface_free(&surface);
    }
    if (status == EWA_OK) {
        double origin_world[3];
        ewa_cloud_origin(*cloud, origin_world);
        for (int c = 0; c < 3; c++) origin_world[c] += corner_world[c];
        ewa_cloud_set_origin(*cloud, origin_world);
    }
    ewa_release(mesh->context, near.positions, mesh->vertex_count, 3 * sizeof *near.positions);
    return status;
}
