// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From files of points to an octree, or to a part of one: all are read once to gather statistics and once to
// distribute them to temporary storage by regions, which are made of them.
#include "base/options.h"
#include "lod/assemble.h"
#include "lod/part.h"

enum {
    BYTES_PER_POINT = 640, ///< of a region that is made
    KEPT_SHARE = 2,        ///< of the memory for decoded points, which are kept until they are distributed
};

static const ewa_option build_rows[] = {
    {"memory_bytes", EWA_OPTION_U64, offsetof(ewa_lod_build_options, memory_bytes), 0x1p26, 0x1p50,
     .initial = 0x1p31, .unit = "bytes", .help = "memory for points at hand"},
    {"subset", EWA_OPTION_U32, offsetof(ewa_lod_build_options, subset), 0, 65535,
     .help = "which part is made, counted from 0"},
    {"subset_count", EWA_OPTION_U32, offsetof(ewa_lod_build_options, subset_count), 1, 65536, .initial = 1,
     .help = "how many parts are made, to be merged; 1: the whole at once"},
    {"keep_going", EWA_OPTION_BOOL, offsetof(ewa_lod_build_options, keep_going),
     .help = "step over damaged pieces of files"},
};

const ewa_option_table ewa_lod_build_options_table = EWA_OPTION_TABLE(ewa_lod_build_options, build_rows);

void ewa_lod_build_options_init(ewa_lod_build_options *options, size_t struct_size) {
    ewa_options_init(&ewa_lod_build_options_table, options, struct_size);
}

/// A builder whose regions are made from points that were spooled.
typedef struct distribution_builder {
    ewa_lod_builder base;
    ewa_distribution distribution;
} distribution_builder;

static ewa_status make_region(ewa_lod_builder *b, uint32_t index, ewa_region_result *result) {
    distribution_builder *s = (distribution_builder *)b;
    return ewa_region_make(&b->plan, &s->distribution, &s->distribution.regions[index], result);
}

static ewa_status build(ewa_context *context, ewa_inputs *inputs, const char *out,
                        const ewa_lod_build_options *options, ewa_lod_build_stats *stats) {
    distribution_builder s = {.base = {.context = context, .get = make_region}};
    ewa_lod_builder *b = &s.base;
    ewa_statistics statistics;
    const double start = ewa_now_s();
    ewa_status status = ewa_statistics_make(inputs, &statistics);
    const double counted = ewa_now_s();
    const uint64_t max_points = options->memory_bytes / BYTES_PER_POINT;
    if (status == EWA_OK)
        status = ewa_distribution_make(inputs, &statistics, out, max_points, options->subset,
                                       options->subset_count, &s.distribution);
    ewa_inputs_forget(inputs);
    const double distributed = ewa_now_s();
    if (status == EWA_OK) status = ewa_region_plan_make(context, &statistics, inputs->prototype, options->attributes, &b->plan);
    ewa_lod_region *regions = NULL;
    if (status == EWA_OK && !(regions = ewa_allocate(context, s.distribution.region_count, sizeof *regions)))
        status = EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < s.distribution.region_count && status == EWA_OK; i++)
        regions[i] = (ewa_lod_region){s.distribution.regions[i].key, s.distribution.regions[i].point_count};
    b->regions = regions;
    b->region_count = s.distribution.region_count;
    if (status == EWA_OK) {
        b->stats.temporary_bytes = ewa_spool_size(s.distribution.spool);
        status = options->subset_count > 1
                     ? ewa_lod_part_write(b, out, options->subset, options->subset_count)
                     : ewa_lod_write(b, out);
    }
    b->stats.statistics_s = counted - start;
    b->stats.distribute_s = distributed - counted;
    b->stats.estimate_s = b->plan.estimate_s;
    b->stats.merge_s = b->plan.merge_s;
    b->stats.write_s = b->plan.encode_s;
    b->stats.total_s = ewa_now_s() - start;
    if (stats) *stats = b->stats;
    ewa_release(context, regions, s.distribution.region_count, sizeof *regions);
    ewa_region_plan_free(&b->plan);
    if (s.distribution.context) ewa_distribution_free(&s.distribution);
    ewa_statistics_free(context, &statistics);
    return status;
}

ewa_status ewa_lod_build(ewa_context *context, const char *const *paths, uint32_t path_count, const char *out,
                         const ewa_lod_build_options *options, ewa_lod_build_stats *stats) {
    if (!context || !paths || path_count == 0 || !out) return EWA_ERROR_ARGUMENT;
    if (stats) *stats = (ewa_lod_build_stats){0};
    ewa_lod_build_options chosen;
    ewa_lod_build_options_init(&chosen, sizeof chosen);
    EWA_TRY(ewa_options_take(context, &ewa_lod_build_options_table, options, &chosen));
    if (chosen.subset >= chosen.subset_count)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "options: subset is %u of %u", chosen.subset,
                        chosen.subset_count);
    ewa_inputs inputs;
    ewa_status status = ewa_inputs_open(context, paths, path_count, chosen.keep_going, chosen.memory_bytes / KEPT_SHARE, &inputs);
    if (status == EWA_OK) status = build(context, &inputs, out, &chosen, stats);
    ewa_inputs_free(&inputs);
    return status;
}
