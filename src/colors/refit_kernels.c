// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Kernels at the centres of other surfels, as the renderer weighs them where the surface is seen from near:
// exp(-r^2 / 2) inside of the cutoff and of the clip lines, all of the same height.
#include "colors/refit_kernels.h"
#include "base/base.h"
#include "math/gaussian.h"

#include <math.h>

enum {
    TASK_ROWS = 1024,
    STACK_NODES = EWA_SOLID_MAX_LEVELS * EWA_SOLID_ARITY,
};

// Surfels whose normals part by more than 60 degrees belong to different sides of an edge.
static const double MIN_COSINE = 0.5;

typedef struct build_job {
    const ewa_solid *solid;
    double cutoff2;
    bool clipped; // some surfels have clip lines
    refit_matrix *matrix;
} build_job;

typedef struct entry {
    uint32_t column;
    double r2; // of the kernel exp(-r2 / 2), then the kernel
} entry;

/// Whether the clip lines of a surfel keep the place (u, v) of its plane, in standard deviations.
static bool kept(const ewa_solid *solid, uint32_t surfel, double u, double v) {
    ewa_vec3 lines[2];
    bool either;
    const uint32_t count = ewa_solid_lines(solid, surfel, lines, &either);
    uint32_t held = 0;
    for (uint32_t k = 0; k < count; k++) held += lines[k].x * u + lines[k].y * v + lines[k].z >= 0;
    return either ? held > 0 : held == count;
}

/// r^2 of the kernel of a surfel at a place of a surface with that normal; negative: it does not take part.
static double r2_at(const build_job *job, uint32_t index, ewa_vec3 place, ewa_vec3 normal) {
    const ewa_solid_surfel *surfel = &job->solid->surfels[index];
    const ewa_vec3 d = vec3_sub(place, surfel->center);
    if (!(vec3_dot(d, d) < surfel->reach * surfel->reach)) return -1;
    if (vec3_dot(surfel->normal, normal) < MIN_COSINE) return -1;
    // d = u tu + v tv + (...) n, for axes that need not be orthogonal.
    const ewa_vec3 tu = surfel->axis[0], tv = surfel->axis[1];
    const double uu = vec3_dot(tu, tu), uv = vec3_dot(tu, tv), vv = vec3_dot(tv, tv), a = vec3_dot(d, tu),
                 b = vec3_dot(d, tv), determinant = uu * vv - uv * uv;
    const double u = (a * vv - b * uv) / determinant, v = (b * uu - a * uv) / determinant;
    const double r2 = u * u + v * v;
    return r2 < job->cutoff2 && (!job->clipped || kept(job->solid, index, u, v)) ? r2 : -1;
}

/// Without libm's care for what is not a number, of which there is none here.
static inline double beyond(double low, double high, double p) {
    const double below = low - p, above = p - high, outside = below > above ? below : above;
    return outside > 0 ? outside : 0;
}

/// Finds the kernels at the centre of surfel `row`, ascending; returns how many there are, 0 where there is
/// no equation.
static uint32_t find_row(const build_job *job, uint32_t row, entry entries[REFIT_ROW_MAX]) {
    const ewa_solid *solid = job->solid;
    const ewa_vec3 p = solid->surfels[row].center, normal = solid->surfels[row].normal;
    struct {
        uint32_t level, index;
    } stack[STACK_NODES];
    uint32_t depth = 1, count = 0;
    bool own = false;
    stack[0].level = solid->level_count - 1;
    stack[0].index = 0;
    while (depth) {
        depth--;
        const uint32_t level = stack[depth].level, first = stack[depth].index * EWA_SOLID_ARITY,
                       maximum = level ? solid->level_nodes[level - 1] : solid->count,
                       end = first + EWA_SOLID_ARITY < maximum ? first + EWA_SOLID_ARITY : maximum;
        for (uint32_t child = end; level && child-- > first;) {
            const ewa_solid_node *node = &solid->nodes[solid->level_first[level - 1] + child];
            const double x = beyond(node->low.x, node->high.x, p.x),
                         y = beyond(node->low.y, node->high.y, p.y),
                         z = beyond(node->low.z, node->high.z, p.z);
            if (x * x + y * y + z * z > node->reach * node->reach) continue;
            stack[depth].level = level - 1, stack[depth].index = child;
            depth++;
        }
        for (uint32_t k = first; !level && k < end; k++) {
            const double r2 = r2_at(job, k, p, normal);
            if (r2 < 0) continue;
            if (count == REFIT_ROW_MAX) return 0;
            entries[count++] = (entry){k, r2};
            own = own || k == row;
        }
    }
    return own ? count : 0;
}

static void count_rows(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const build_job *job = data;
    entry entries[REFIT_ROW_MAX];
    const uint32_t first = part * TASK_ROWS, left = job->matrix->count - first;
    for (uint32_t i = 0; i < (left < TASK_ROWS ? left : TASK_ROWS); i++)
        job->matrix->forward.starts[first + i + 1] = find_row(job, first + i, entries);
}

static void fill_rows(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const build_job *job = data;
    const refit_rows *rows = &job->matrix->forward;
    entry entries[REFIT_ROW_MAX];
    const uint32_t first = part * TASK_ROWS, left = job->matrix->count - first;
    for (uint32_t i = 0; i < (left < TASK_ROWS ? left : TASK_ROWS); i++) {
        const uint32_t count = find_row(job, first + i, entries);
        double sum = 0;
        for (uint32_t e = 0; e < count; e++) sum += entries[e].r2 = ewa_exp(-0.5 * entries[e].r2);
        for (uint32_t e = 0; e < count; e++) {
            rows->columns[rows->starts[first + i] + e] = entries[e].column;
            rows->values[rows->starts[first + i] + e] = (float)(entries[e].r2 / sum);
        }
    }
}

/// Fills the backward rows: rows of the forward ones come in order, so columns ascend here too.
static void transpose(refit_matrix *matrix) {
    const refit_rows *from = &matrix->forward;
    refit_rows *to = &matrix->backward;
    const uint32_t count = matrix->count;
    for (uint64_t e = 0; e < from->entry_count; e++) to->starts[from->columns[e] + 1]++;
    for (uint32_t i = 0; i < count; i++) to->starts[i + 1] += to->starts[i];
    for (uint32_t row = 0; row < count; row++)
        for (uint64_t e = from->starts[row]; e < from->starts[row + 1]; e++) {
            const uint64_t at = to->starts[from->columns[e]]++;
            to->columns[at] = row;
            to->values[at] = from->values[e];
        }
    // Each start has become the next one's.
    for (uint32_t i = count; i > 0; i--) to->starts[i] = to->starts[i - 1];
    to->starts[0] = 0;
}

static bool allocate_entries(ewa_context *context, refit_rows *rows, uint64_t count) {
    rows->entry_count = count;
    rows->columns = ewa_allocate(context, count, sizeof *rows->columns);
    rows->values = ewa_allocate(context, count, sizeof *rows->values);
    return rows->columns && rows->values;
}

ewa_status ewa_refit_matrix_make(const ewa_solid *solid, double cutoff, refit_matrix *matrix) {
    ewa_context *context = solid->context;
    *matrix = (refit_matrix){.context = context, .count = solid->count};
    const uint32_t count = solid->count, parts = (uint32_t)(((uint64_t)count + TASK_ROWS - 1) / TASK_ROWS);
    refit_rows *forward = &matrix->forward, *backward = &matrix->backward;
    forward->starts = ewa_allocate_zeroed(context, (size_t)count + 1, sizeof *forward->starts);
    backward->starts = ewa_allocate_zeroed(context, (size_t)count + 1, sizeof *backward->starts);
    if (!forward->starts || !backward->starts) return EWA_ERROR_MEMORY;
    const bool clipped = ewa_cloud_find(solid->cloud, EWA_CLIP0) || ewa_cloud_find(solid->cloud, EWA_CLIP1);
    build_job job = {solid, cutoff * cutoff, clipped, matrix};
    ewa_parallel(context, count_rows, &job, parts);
    for (uint32_t i = 0; i < count; i++) {
        matrix->empty_count += forward->starts[i + 1] == 0;
        forward->starts[i + 1] += forward->starts[i];
    }
    const uint64_t entries = forward->starts[count], limit = ewa_context_limits(context)->max_memory_bytes,
                   bytes = 2 * entries * (sizeof *forward->columns + sizeof *forward->values);
    if (bytes > limit)
        return ewa_fail(context, EWA_ERROR_LIMIT,
                        "refit: %u surfels overlap %llu times, which needs %llu bytes; the limit is %llu",
                        count, (unsigned long long)entries, (unsigned long long)bytes,
                        (unsigned long long)limit);
    if (!allocate_entries(context, forward, entries) || !allocate_entries(context, backward, entries))
        return EWA_ERROR_MEMORY;
    ewa_parallel(context, fill_rows, &job, parts);
    transpose(matrix);
    return EWA_OK;
}

void ewa_refit_matrix_free(refit_matrix *matrix) {
    refit_rows *const both[] = {&matrix->forward, &matrix->backward};
    for (int k = 0; k < 2; k++) {
        refit_rows *rows = both[k];
        ewa_release(matrix->context, rows->values, rows->entry_count, sizeof *rows->values);
        ewa_release(matrix->context, rows->columns, rows->entry_count, sizeof *rows->columns);
        ewa_release(matrix->context, rows->starts, (size_t)matrix->count + 1, sizeof *rows->starts);
    }
    *matrix = (refit_matrix){0};
}
