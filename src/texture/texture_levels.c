// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pre-summed levels of a texture, along each axis by itself: level [u][v] holds the averages over runs of
// size[u] by size[v] texels, so that a point of a level stands for these with the same sum of weights.
//
// Every texel is in exactly one run: sizes of repeated textures divide their sides, others stop at whole
// runs, and what is left over at the border is drawn from finer levels.
#include "texture/texture.h"

#include <math.h>
#include <string.h>

enum { TASK_ROWS = 16, CHUNK_TEXELS = 64 };

static uint32_t smallest_factor(uint32_t n) {
    for (uint32_t p = 2; p <= n / p; p++)
        if (n % p == 0) return p;
    return n;
}

static void describe_axis(uint32_t side, uint32_t node, bool repeat, ewa_texture_axis *axis) {
    axis->count[0] = side;
    axis->factor[0] = 1;
    axis->size[0] = 1;
    uint32_t l = 1;
    // Until one block holds the whole texture.
    for (uint32_t left = side; repeat ? left > 1 : axis->size[l - 1] * node < side; l++) {
        axis->factor[l] = repeat ? smallest_factor(left) : 2;
        left /= axis->factor[l];
        axis->count[l] = left;
        axis->size[l] = axis->size[l - 1] * axis->factor[l];
    }
    axis->stored_count = l;
    // A repeated texture goes on: 2^40 texels reach every horizon.
    for (; repeat && l < EWA_TEXTURE_MAX_LEVELS && axis->size[l - 1] < 0x1p40; l++) {
        axis->factor[l] = 2;
        axis->count[l] = 1;
        axis->size[l] = 2 * axis->size[l - 1];
    }
    axis->level_count = l;
}

void ewa_texture_levels_describe(ewa_texture_plan *plan) {
    describe_axis(plan->source.width_px, EWA_TEXTURE_NODE_U, plan->options.repeat, &plan->axes[0]);
    describe_axis(plan->source.height_px, EWA_TEXTURE_NODE_V, plan->options.repeat, &plan->axes[1]);
}

/// A level and the one that it is made from, which is finer along one axis.
typedef struct level_task {
    const ewa_texture_plan *plan;
    uint32_t u, v;      ///< of the level
    uint32_t from[2];   ///< of the finer one
    const float *finer; ///< NULL: the texture itself
} level_task;

static void average_rows(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const level_task *task = data;
    const ewa_texture_plan *plan = task->plan;
    const uint32_t width = plan->axes[0].count[task->u], height = plan->axes[1].count[task->v];
    const uint32_t finer_width = plan->axes[0].count[task->from[0]];
    const uint32_t factor_u = task->u == task->from[0] ? 1 : plan->axes[0].factor[task->u];
    const uint32_t factor_v = task->v == task->from[1] ? 1 : plan->axes[1].factor[task->v];
    const float share = 1 / (float)(factor_u * factor_v);
    float(*level)[4] = (float(*)[4])plan->levels[task->u][task->v];
    for (uint32_t y = index * TASK_ROWS; y < height && y < (index + 1) * TASK_ROWS; y++) {
        float(*out)[4] = level + (size_t)y * width;
        memset(out, 0, width * sizeof *out);
        for (uint32_t j = 0; j < factor_v; j++) {
            const uint32_t row = y * factor_v + j, end = width * factor_u;
            uint32_t x = 0, left = factor_u;
            for (uint32_t first = 0; first < end; first += CHUNK_TEXELS) {
                const uint32_t count = end - first < CHUNK_TEXELS ? end - first : CHUNK_TEXELS;
                float decoded[CHUNK_TEXELS][4];
                const float(*texels)[4] = (const float(*)[4])decoded;
                if (task->finer)
                    texels = (const float(*)[4])task->finer + (size_t)row * finer_width + first;
                else
                    ewa_texel_read_row(&plan->source, first, row, count, decoded);
                for (uint32_t i = 0; i < count; i++) {
                    for (int c = 0; c < 4; c++) out[x][c] += texels[i][c] * share;
                    if (--left) continue;
                    x++;
                    left = factor_u;
                }
            }
        }
    }
}

static size_t level_texels(const ewa_texture_plan *plan, uint32_t u, uint32_t v) {
    return (size_t)plan->axes[0].count[u] * plan->axes[1].count[v];
}

/// Makes a level and, before it, those that it is made from.
static ewa_status make_level(ewa_texture_plan *plan, uint32_t u, uint32_t v, ewa_texture_stats *stats) {
    if ((u == 0 && v == 0) || plan->levels[u][v]) return EWA_OK;
    const bool along_v = v > 0 && (u == 0 || plan->levels[u][v - 1] || (!plan->levels[u - 1][v] && v >= u));
    level_task task = {plan, u, v, {along_v ? u : u - 1, along_v ? v - 1 : v}, NULL};
    EWA_TRY(make_level(plan, task.from[0], task.from[1], stats));
    task.finer = plan->levels[task.from[0]][task.from[1]];
    plan->levels[u][v] = ewa_allocate(plan->context, level_texels(plan, u, v), 4 * sizeof(float));
    if (!plan->levels[u][v]) return EWA_ERROR_MEMORY;
    stats->level_bytes += level_texels(plan, u, v) * 4 * sizeof(float);
    ewa_parallel(plan->context, average_rows, &task, (plan->axes[1].count[v] + TASK_ROWS - 1) / TASK_ROWS);
    return EWA_OK;
}

ewa_status ewa_texture_levels_make(ewa_texture_plan *plan, const uint8_t *wanted, ewa_texture_stats *stats) {
    ewa_status status = EWA_OK;
    for (uint32_t u = 0; u < plan->axes[0].stored_count; u++)
        for (uint32_t v = 0; v < plan->axes[1].stored_count && status == EWA_OK; v++)
            if (wanted[u * EWA_TEXTURE_MAX_LEVELS + v]) status = make_level(plan, u, v, stats);
    return status;
}

void ewa_texture_levels_free(ewa_texture_plan *plan) {
    for (uint32_t u = 0; u < EWA_TEXTURE_MAX_LEVELS; u++)
        for (uint32_t v = 0; v < EWA_TEXTURE_MAX_LEVELS; v++)
            if (plan->levels[u][v])
                ewa_release(plan->context, plan->levels[u][v], level_texels(plan, u, v), 4 * sizeof(float));
}

/// Index in [0, count) of a texel of a repeated texture.
static uint32_t wrap(int64_t index, uint32_t count) {
    const int64_t rest = index % count;
    return (uint32_t)(rest < 0 ? rest + count : rest);
}

void ewa_texture_levels_read(const ewa_texture_plan *plan, uint32_t level_u, uint32_t level_v, int64_t u,
                             int64_t v, ewa_texture_block *block) {
    const uint32_t width = plan->axes[0].count[level_u], height = plan->axes[1].count[level_v];
    const float(*level)[4] = (const float(*)[4])plan->levels[level_u][level_v];
    for (uint32_t j = 0; j < block->height; j++) {
        const uint32_t row = wrap(v + j, height);
        for (uint32_t done = 0; done < block->width;) {
            const uint32_t column = wrap(u + done, width), left = block->width - done;
            const uint32_t run = left < width - column ? left : width - column;
            if (level)
                memcpy(block->colors[j][done], level[(size_t)row * width + column], run * sizeof *level);
            else
                ewa_texel_read_row(&plan->source, column, row, run, &block->colors[j][done]);
            done += run;
        }
    }
}
