// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Levels of the resident form: a tree over the splats of a part is cut into a quarter as many groups as there are splats for level 1, a sixteenth
// for level 2, and so on. Each splat of a level stands for the splats of a group themselves, not for those of the level before.
#include "volume/splat_levels.h"
#include "base/base.h"
#include "cloud/gaussian_tree.h"
#include "volume/splat_packets.h"

#include <math.h>

_Static_assert((int)EWA_SPLAT_PART_PACKETS * (int)EWA_SPLAT_LANES <= (int)EWA_TREE_GAUSSIANS, "a tree has room for a part");

enum { LANES = EWA_SPLAT_LANES, PART_SPLATS = EWA_SPLAT_PART_PACKETS * LANES, MAX_MERGED = PART_SPLATS / 4 };

typedef struct level_scratch {
    ewa_gaussian_tree tree; ///< of one part
    ewa_gaussians merged; ///< of one level
} level_scratch;

typedef struct level_job {
    ewa_splats *splats;
    const ewa_gaussians *set;
    const uint32_t *order;
    level_scratch *scratch; ///< one per worker
} level_job;

/// Fills one level of a part; returns the RMS distance, world units.
static double make_level(const level_job *job, level_scratch *scratch, uint32_t part, uint32_t level, uint32_t count) {
    const uint32_t merged_count = (count - 1) / (1u << 2 * level) + 1;
    double squares = 0, masses = 0;
    ewa_gaussian_tree_cut(&scratch->tree, merged_count);
    for (uint32_t m = 0; m < merged_count; m++) {
        const double spacing2 = ewa_gaussian_tree_merge(&scratch->tree, job->set, m, &scratch->merged, m);
        const float *scales = scratch->merged.scales + 3 * (size_t)m;
        const double mass = (double)scratch->merged.opacities[m] * (double)(scales[0] * scales[1] + scales[0] * scales[2] + scales[1] * scales[2]);
        squares += mass * spacing2, masses += mass;
    }
    uint32_t packets;
    const size_t packet = ewa_splats_level(job->splats, part, level, &packets);
    for (uint32_t m = 0; m < merged_count; m++)
        ewa_splats_set(job->splats, &scratch->merged, m, packet + m / LANES, m % LANES);
    return masses > 0 ? sqrt(squares / masses) : 0;
}

static void make_part(void *data, uint32_t part, uint32_t worker) {
    const level_job *job = data;
    const ewa_gaussians *set = job->set;
    level_scratch *scratch = &job->scratch[worker];
    ewa_splat_part *made = &job->splats->parts[part];
    const double unit = job->splats->unit_world;
    const size_t begin = (size_t)part * PART_SPLATS, left = job->splats->info.splat_count - begin;
    const uint32_t count = left < PART_SPLATS ? (uint32_t)left : PART_SPLATS;
    double low[3], high[3], squares = 0;
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            const double at = (double)set->centers[3 * (size_t)job->order[begin + i] + k];
            low[k] = i ? fmin(low[k], at) : at;
            high[k] = i ? fmax(high[k], at) : at;
        }
    }
    for (int k = 0; k < 3; k++) {
        made->center[k] = (float)((low[k] + high[k]) / 2 / unit);
        squares += (high[k] - low[k]) * (high[k] - low[k]);
    }
    made->radius = (float)(sqrt(squares) / 2 / unit * (1 + 1e-6));
    ewa_gaussian_tree_make(&scratch->tree, set, job->order + begin, count);
    for (uint32_t level = 1; level <= EWA_SPLAT_LEVELS; level++)
        made->spacing[level - 1] = (float)(make_level(job, scratch, part, level, count) / unit);
}

ewa_status ewa_splats_make_levels(ewa_splats *splats, const ewa_gaussians *set, const uint32_t *order) {
    if (!splats->part_count) return EWA_OK;
    ewa_context *context = splats->context;
    const uint32_t workers = ewa_context_worker_count(context);
    level_job job = {splats, set, order, ewa_allocate_zeroed(context, workers, sizeof(level_scratch))};
    ewa_status status = job.scratch ? EWA_OK : EWA_ERROR_MEMORY;
    for (uint32_t w = 0; w < workers && status == EWA_OK; w++) {
        status = ewa_gaussians_create(context, MAX_MERGED, set->sh_degree, &job.scratch[w].merged);
        if (status == EWA_OK && set->classes) status = ewa_gaussians_add_classes(&job.scratch[w].merged);
    }
    if (status == EWA_OK) status = ewa_parallel_stoppable(context, "levels", make_part, &job, splats->part_count);
    for (uint32_t w = 0; w < workers && job.scratch; w++) ewa_gaussians_free(&job.scratch[w].merged);
    ewa_release(context, job.scratch, workers, sizeof(level_scratch));
    return status;
}
