// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A file of Gaussians to another.
#include "base/options.h"
#include "io/gaussian/levels_write.h"

ewa_status ewa_gaussians_convert(ewa_context *context, const char *from, const char *to, const ewa_gaussians_save_options *options, uint64_t *count) {
    if (!context || !from || !to || !count) return EWA_ERROR_ARGUMENT;
    ewa_gaussians_save_options chosen;
    ewa_gaussian_facts facts;
    ewa_gaussians set;
    *count = 0;
    ewa_gaussians_save_options_init(&chosen, sizeof chosen);
    EWA_TRY(ewa_options_take(context, &ewa_gaussians_save_options_table, options, &chosen));
    if (ewa_gaussians_format_of(to) == EWA_GAUSSIANS_STREAMED_SOG) EWA_TRY(ewa_gaussians_write_file_levels(context, from, to, &chosen, count));
    if (*count) return EWA_OK;
    EWA_TRY(ewa_gaussians_load(context, from, &set, &facts));
    memcpy(chosen.up_world, facts.up_world, sizeof chosen.up_world);
    const ewa_status status = ewa_gaussians_save(&set, to, &chosen);
    *count = set.count;
    ewa_gaussians_free(&set);
    return status;
}
