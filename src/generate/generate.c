// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Test objects: options, and the jittered cells that all objects share.
//
// A patch of n points is cut into rows of cells of equal area, about as wide as high: row r starts at cell
// C(r), the nearest integer to n times the share of the area below it, and lies between the area coordinates
// C(r)/n and C(r+1)/n. So the count is exact, the cells fill the surface to its edge, and no place is farther
// from its cell's point than (1 + jitter)/2 of the cell's diagonal. Every number comes from the index of its
// point alone.
#include "generate/generate.h"
#include "base/base.h"
#include "base/options.h"
#include "generate/solid.h"
#include "math/generate_number.h"

#include <math.h>
#include <string.h>

/// Points that one progress report covers, and points of one parallel task.
enum { STRETCH_POINTS = 1 << 22, TASK_POINTS = 1 << 14 };

/// Jittered points need wider discs, so that the sum of their kernels nowhere falls under what edge
/// antialiasing takes for an edge: 1.6 spacings for jitter 0.5, 2.1 for 1 (docs/quality.md).
static const double JITTER_SPREAD = 0.8;

/// Where a patch's points and rows begin; one more says where the last one's end.
typedef struct patch_start {
    uint64_t point, row;
} patch_start;

typedef struct generate_job {
    const ewa_generate_options *options;
    uint32_t patch_count;
    patch_start *starts; // patch_count + 1
    uint64_t key;
    double spacing; // in units of size_world
    ewa_terrain terrain;
    ewa_town_patch *town; // EWA_TOWN_PATCHES, of a town
    uint64_t first_row, end_row; // of the current stretch, over all patches
    uint32_t parts;
    float *position, *normal, *radius, *curvature; // all but the first may be NULL
    uint8_t *color;
} generate_job;

#define AT(member) offsetof(ewa_generate_options, member)

/// The bounds of lengths keep every output a normal float.
static const ewa_option option_rows[] = {
    {"object", EWA_OPTION_CHOICE, AT(object), .words = "plane|checker|cube|sphere|torus|terrain|csg|town",
     .help = "which object is made"},
    {"point_count", EWA_OPTION_U64, AT(point_count), 0, INFINITY, EWA_OPTION_BELOW, .initial = 100000,
     .help = "how many points; with rows on edges at most so many"},
    {"seed", EWA_OPTION_U64, AT(seed), 0, INFINITY, EWA_OPTION_BELOW, .initial = 1,
     .help = "same seed, same bytes, on every machine"},
    {"size_world", EWA_OPTION_F64, AT(size_world), 1e-25, 1e25, .initial = 2,
     .help = "edge of plane, cube, terrain and town, outer diameter of sphere and torus, length of csg, in "
             "world units"},
    {"jitter", EWA_OPTION_F64, AT(jitter), 0, 1, .initial = 0.5,
     .help = "0: a regular grid, 1: anywhere in the cell"},
    {"checks", EWA_OPTION_F64, AT(checks), 1e-6, 1e6, .initial = 16,
     .help = "squares along an edge of the checkerboard and of the cube's faces"},
    {"radius_scale", EWA_OPTION_F64, AT(radius_scale), 1e-6, 1e6, EWA_OPTION_OR_ZERO,
     .help = "support radius in units of the spacing; 0: closed for the jitter"},
    {"positions_only", EWA_OPTION_BOOL, AT(positions_only), .help = "leave out normals and radii"},
    {"sharp", EWA_OPTION_BOOL, AT(sharp),
     .help = "cube and csg: rows of points on every edge, and clip lines"},
    {"texcoords", EWA_OPTION_BOOL, AT(texcoords), .help = "add texture coordinates"},
};

const ewa_option_table ewa_generate_options_table = EWA_OPTION_TABLE(ewa_generate_options, option_rows);

void ewa_generate_options_init(ewa_generate_options *options, size_t struct_size) {
    ewa_options_init(&ewa_generate_options_table, options, struct_size);
}

/// Support radius in units of the spacing.
static double choose_radius_scale(const ewa_generate_options *options) {
    if (options->radius_scale > 0) return options->radius_scale;
    const bool in_rows = options->sharp || options->object == EWA_OBJECT_CSG;
    return EWA_DEFAULT_RADIUS_SCALE * (in_rows ? 1 : 1 + JITTER_SPREAD * options->jitter);
}

static ewa_status check_together(ewa_context *context, const ewa_generate_options *options) {
    if (options->sharp && !ewa_solid_shape_of(options->object))
        return ewa_fail(context, EWA_ERROR_ARGUMENT,
                        "generate: sharp goes with the cube and the part only, object is %d",
                        (int)options->object);
    if (options->texcoords && options->positions_only)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "generate: texcoords need the normals");
    return EWA_OK;
}

/// Area of the object in units of size_world^2 (terrain: of its ground).
static double object_area(ewa_object object) {
    const double pi = 3.141592653589793;
    switch (object) {
    case EWA_OBJECT_CUBE:
        return 6;
    case EWA_OBJECT_SPHERE:
        return pi;
    case EWA_OBJECT_TORUS:
        return pi * pi * EWA_TORUS_MAJOR * EWA_TORUS_MINOR;
    default:
        return 1;
    }
}

/// How far it is across the rows of a patch, in units of size_world.
static double object_height(ewa_object object) {
    const double pi = 3.141592653589793;
    switch (object) {
    case EWA_OBJECT_SPHERE:
        return pi / 2;
    case EWA_OBJECT_TORUS:
        return pi * EWA_TORUS_MINOR;
    default:
        return 1;
    }
}

/// Share of a patch's area below this share of its height, on the surface.
static double area_below(const generate_job *job, double height) {
    double sine, cosine;
    switch (job->options->object) {
    case EWA_OBJECT_SPHERE:
        ewa_generate_sincos(height / 2, &sine, &cosine);
        return (1 - cosine) / 2;
    case EWA_OBJECT_TORUS:
        ewa_generate_sincos(height, &sine, &cosine);
        return height + EWA_TORUS_MINOR / EWA_TORUS_MAJOR * sine / 6.283185307179586;
    default:
        return height;
    }
}

static uint64_t row_start(const generate_job *job, uint64_t point_count, uint64_t row, uint64_t row_count) {
    if (row >= row_count) return point_count;
    const double height = (double)row / (double)row_count;
    const uint64_t start = (uint64_t)((double)point_count * area_below(job, height) + 0.5);
    return start < point_count ? start : point_count;
}

static void fill_block(const generate_job *job, ewa_generate_block *block) {
    switch (job->options->object) {
    case EWA_OBJECT_PLANE:
        ewa_generate_plane(block);
        break;
    case EWA_OBJECT_CHECKER:
        ewa_generate_checker(block, job->options->checks);
        break;
    case EWA_OBJECT_CUBE:
        ewa_generate_cube(block, job->options->checks);
        break;
    case EWA_OBJECT_SPHERE:
        ewa_generate_sphere(block);
        break;
    case EWA_OBJECT_TORUS:
        ewa_generate_torus(block);
        break;
    case EWA_OBJECT_TERRAIN:
        ewa_generate_terrain(&job->terrain, block);
        break;
    case EWA_OBJECT_TOWN:
        ewa_generate_town(job->town, block);
        break;
    case EWA_OBJECT_CSG: // has no cells of equal area: solid.c
        break;
    }
}

static uint8_t to_byte(float value) { return value <= 0 ? 0 : value >= 255 ? 255 : (uint8_t)(value + 0.5f); }

static void store_block(const generate_job *job, const ewa_generate_block *block, uint64_t first) {
    const double size = job->options->size_world;
    for (uint32_t i = 0; i < block->count; i++) {
        for (uint32_t c = 0; c < 3; c++) {
            job->position[3 * (first + i) + c] = (float)(size * block->position[i][c]);
            job->color[3 * (first + i) + c] = to_byte(block->color[i][c]);
        }
    }
    if (!job->normal) return;
    const double scale = size * job->options->radius_scale;
    for (uint32_t i = 0; i < block->count; i++) {
        for (uint32_t c = 0; c < 3; c++) job->normal[3 * (first + i) + c] = (float)block->normal[i][c];
        job->radius[first + i] = (float)(scale * block->radius[i]);
        if (job->curvature) job->curvature[first + i] = (float)(block->curvature[i] / size);
    }
}

static void generate_row(const generate_job *job, uint32_t patch, uint64_t row, ewa_generate_block *block) {
    const patch_start *at = &job->starts[patch];
    const uint64_t patch_first = at[0].point, patch_points = at[1].point - at[0].point;
    const uint64_t row_count = at[1].row - at[0].row;
    const uint64_t start = row_start(job, patch_points, row, row_count),
                   end = row_start(job, patch_points, row + 1, row_count);
    if (start == end) return;
    const double width = 1 / (double)(end - start);
    const double low = (double)start / (double)patch_points,
                 height = (double)(end - start) / (double)patch_points;
    const double jitter = job->options->jitter;
    block->patch = patch;
    for (uint64_t first = start; first < end; first += block->count) {
        block->count = end - first < EWA_GENERATE_BLOCK ? (uint32_t)(end - first) : EWA_GENERATE_BLOCK;
        for (uint32_t i = 0; i < block->count; i++) {
            const uint64_t random = ewa_generate_random(job->key, patch_first + first + i);
            const double across = (double)(random >> 40) * 0x1p-24 - 0.5;
            const double along = (double)(random >> 16 & 0xffffff) * 0x1p-24 - 0.5;
            block->u[i] = ((double)(first - start + i) + 0.5 + jitter * along) * width;
            block->v[i] = low + (0.5 + jitter * across) * height;
            block->grain[i] = (float)(random & 0xffff) * 0x1p-15f - 1;
        }
        fill_block(job, block);
        store_block(job, block, patch_first + first);
    }
}

/// The patch of a row, rows being counted over all patches.
static uint32_t find_patch(const generate_job *job, uint64_t row) {
    uint32_t low = 0, high = job->patch_count - 1;
    while (low < high) {
        const uint32_t middle = (low + high + 1) / 2;
        if (job->starts[middle].row <= row)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

static void generate_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const generate_job *job = data;
    ewa_generate_block block;
    block.spacing = job->spacing;
    const uint64_t row_count = job->end_row - job->first_row;
    const uint64_t end = job->first_row + ewa_split(row_count, job->parts, part + 1);
    uint64_t row = job->first_row + ewa_split(row_count, job->parts, part);
    for (uint32_t patch = find_patch(job, row); row < end; row++) {
        while (job->starts[patch + 1].row <= row) patch++;
        generate_row(job, patch, row - job->starts[patch].row, &block);
    }
}

static ewa_status run(ewa_context *context, generate_job *job) {
    const uint64_t point_count = job->options->point_count;
    const uint64_t row_count = job->starts[job->patch_count].row;
    const uint32_t stretches = (uint32_t)(point_count / STRETCH_POINTS + 1);
    for (uint32_t stretch = 0; stretch < stretches; stretch++) {
        EWA_TRY(ewa_progress(context, "generate", (double)stretch / stretches));
        job->first_row = ewa_split(row_count, stretches, stretch);
        job->end_row = ewa_split(row_count, stretches, stretch + 1);
        job->parts = (uint32_t)(point_count / stretches / TASK_POINTS + 1);
        ewa_parallel(context, generate_part, job, job->parts);
    }
    return ewa_progress(context, "generate", 1);
}

static ewa_status add_attributes(ewa_cloud *cloud, generate_job *job) {
    void *position = NULL, *normal = NULL, *color = NULL, *radius = NULL, *curvature = NULL;
    const bool bends = job->options->object == EWA_OBJECT_SPHERE || job->options->object == EWA_OBJECT_TORUS;
    ewa_status status = ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, &position);
    if (status == EWA_OK && !job->options->positions_only)
        status = ewa_cloud_add(cloud, EWA_NORMAL, EWA_F32, 3, &normal);
    if (status == EWA_OK) status = ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, &color);
    if (status == EWA_OK && !job->options->positions_only)
        status = ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, &radius);
    if (status == EWA_OK && !job->options->positions_only && bends)
        status = ewa_cloud_add(cloud, EWA_CURVATURE, EWA_F32, 1, &curvature);
    job->position = position;
    job->normal = normal;
    job->color = color;
    job->radius = radius;
    job->curvature = curvature;
    return status;
}

/// Divides the points among patches and these into rows.
static void divide(generate_job *job, double area) {
    const uint64_t total = job->options->point_count;
    patch_start at = {0, 0};
    double below = 0;
    for (uint32_t p = 0; p < job->patch_count; p++) {
        job->starts[p] = at;
        const double height = job->town ? job->town[p].height : object_height(job->options->object);
        const double rows = height / job->spacing + 0.5;
        below += job->town ? job->town[p].area : 0;
        at.point = job->town ? (uint64_t)((double)total * (below / area) + 0.5)
                             : ewa_split(total, job->patch_count, p + 1);
        at.row += rows < 1 ? 1 : (uint32_t)rows;
    }
    at.point = total;
    job->starts[job->patch_count] = at;
}

/// Sets what the object consists of.
static ewa_status lay_out(ewa_context *context, generate_job *job) {
    const ewa_generate_options *options = job->options;
    const ewa_object object = options->object;
    const bool is_town = object == EWA_OBJECT_TOWN;
    job->patch_count = object == EWA_OBJECT_CUBE ? 6 : is_town ? EWA_TOWN_PATCHES : 1;
    job->starts = ewa_allocate_zeroed(context, job->patch_count + 1, sizeof *job->starts);
    if (is_town) job->town = ewa_allocate_zeroed(context, EWA_TOWN_PATCHES, sizeof *job->town);
    if (!job->starts || (is_town && !job->town)) return EWA_ERROR_MEMORY;
    const uint64_t count = options->point_count ? options->point_count : 1;
    const double area = is_town ? ewa_town_make(options->seed, job->town) : object_area(object);
    job->key = ewa_generate_random(options->seed, 0);
    job->spacing = sqrt(area / (double)count);
    if (object == EWA_OBJECT_TERRAIN) ewa_terrain_init(&job->terrain, options->seed, count);
    divide(job, area);
    return EWA_OK;
}

ewa_status ewa_cloud_generate(ewa_context *context, const ewa_generate_options *given, ewa_cloud **cloud) {
    if (!context || !cloud) return EWA_ERROR_ARGUMENT;
    *cloud = NULL;
    ewa_generate_options chosen, *options = &chosen;
    ewa_generate_options_init(options, sizeof *options);
    EWA_TRY(ewa_options_take(context, &ewa_generate_options_table, given, options));
    EWA_TRY(check_together(context, options));
    options->radius_scale = choose_radius_scale(options);
    ewa_cloud *made = NULL;
    ewa_status status = EWA_OK;
    if (options->sharp || options->object == EWA_OBJECT_CSG) {
        status = ewa_generate_solid(context, options, &made);
        if (status == EWA_OK && options->texcoords) status = ewa_generate_charts(options, made);
        if (status != EWA_OK) ewa_cloud_destroy(&made);
        *cloud = made;
        return status;
    }
    generate_job job = {.options = options};
    status = ewa_cloud_create(context, options->point_count, &made);
    if (status == EWA_OK) status = lay_out(context, &job);
    if (status == EWA_OK) status = add_attributes(made, &job);
    if (status == EWA_OK && options->point_count) status = run(context, &job);
    ewa_release(context, job.starts, job.patch_count + 1, sizeof *job.starts);
    ewa_release(context, job.town, EWA_TOWN_PATCHES, sizeof *job.town);
    if (status == EWA_OK && options->texcoords) status = ewa_generate_charts(options, made);
    if (status != EWA_OK) ewa_cloud_destroy(&made);
    *cloud = made;
    return status;
}
