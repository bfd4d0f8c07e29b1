// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Assets of streamed Gaussians. The coarsest level of all leaves is read, which says how far what it stands for is apart: a merged Gaussian is as wide
// as what it was made of. Between the levels of a leaf that falls as surfaces have it, with the root of how many there are.
#include "base/base.h"
#include "framing/conventions.h"
#include "math/box.h"
#include "scene/streamed.h"
#include "volume/splats.h"

#include <math.h>
#include <string.h>

/// Measures the ranges of all leaves by their coarsest levels, which follow each other in `set`.
static ewa_status measure(ewa_asset_stream *stream, const ewa_gaussians *set) {
    const ewa_streamed_leaf *leaves = stream->file.leaves.data;
    const ewa_streamed_range *ranges = stream->file.ranges.data;
    stream->spacing_world = ewa_allocate_zeroed(stream->context, stream->file.range_count, sizeof *stream->spacing_world);
    if (!stream->spacing_world) return EWA_ERROR_MEMORY;
    size_t at = 0;
    for (uint32_t i = 0; i < stream->file.leaf_count; i++) {
        const ewa_streamed_leaf *leaf = &leaves[i];
        const double finest = ranges[leaf->first].count, coarsest = ranges[leaf->first + leaf->count - 1].count;
        double squares = 0, masses = 0;
        for (const size_t end = at + (size_t)coarsest; at < end; at++) {
            const float *s = set->scales + 3 * at;
            const double a = (double)s[0], b = (double)s[1], c = (double)s[2];
            const double mass = (double)set->opacities[at] * (a * b + a * c + b * c);
            squares += mass * (a * a + b * b + c * c), masses += mass;
        }
        const double spacing2 = masses > 0 ? squares / masses : 0, range = 1 / coarsest - 1 / finest;
        for (uint32_t k = 1; k < leaf->count && range > 0; k++) {
            const double share = (1 / (double)ranges[leaf->first + k].count - 1 / finest) / range;
            stream->spacing_world[leaf->first + k] = sqrt(spacing2 * fmin(fmax(share, 0), 1));
        }
        stream->count += ranges[leaf->first].count;
    }
    stream->count += set->count - at; // the environment
    return EWA_OK;
}

/// Makes the outline of the coarsest, half as wide at least: about as far as the finest reach that they stand for.
static ewa_status make_outline(ewa_asset *asset, ewa_gaussians *set) {
    const ewa_asset_stream *stream = asset->stream;
    const ewa_streamed_leaf *leaves = stream->file.leaves.data;
    const ewa_streamed_range *ranges = stream->file.ranges.data;
    size_t at = 0;
    for (uint32_t i = 0; i < stream->file.leaf_count; i++) {
        const uint32_t finest = ranges[leaves[i].first].count, coarsest = ranges[leaves[i].first + leaves[i].count - 1].count;
        const float narrower = (float)fmax(sqrt(fmin((double)coarsest / finest, 1)), 0.5);
        for (const size_t end = at + coarsest; at < end; at++)
            for (int k = 0; k < 3; k++) set->scales[3 * at + (size_t)k] *= narrower;
    }
    ewa_splats_info info;
    ewa_splats_describe(asset->splats, &info);
    ewa_cloud_destroy(&asset->outline);
    return ewa_gaussians_outline(set, &info.core, &asset->outline);
}

ewa_status ewa_asset_stream_gaussians(const ewa_asset_job *job, const char *path, bool *taken) {
    static const double nothing_said[3] = {0, 0, 0};
    ewa_asset *asset = job->asset;
    ewa_context *context = asset->context;
    ewa_streamed file;
    EWA_TRY(ewa_streamed_open_file(context, path, &file));
    *taken = file.context;
    if (!*taken) return EWA_OK;
    ewa_asset_stream *stream = ewa_allocate_zeroed(context, 1, sizeof *stream);
    if (!stream) {
        ewa_streamed_free(&file);
        return EWA_ERROR_MEMORY;
    }
    stream->context = context;
    stream->file = file;
    asset->stream = stream;
    ewa_gaussians set;
    EWA_TRY(ewa_streamed_join(context, &stream->file, true, &set));
    const double degree_bytes = 2 * 3 * ((double)ewa_sh_count(set.sh_degree) - 1);
    stream->bytes_each = EWA_SPLAT_NUMBERS * sizeof(float) + (size_t)degree_bytes;
    ewa_status status = ewa_asset_take_gaussians(job, &set, nothing_said); // which moves the set
    if (status == EWA_OK) status = measure(stream, &set);
    if (status == EWA_OK) status = make_outline(asset, &set);
    ewa_gaussians_free(&set);
    EWA_TRY(status);
    ewa_streamed_leaf *leaves = stream->file.leaves.data;
    for (uint32_t i = 0; i < stream->file.leaf_count && ewa_asset_is_moved(asset); i++)
        if (isfinite(leaves[i].low_world[0])) ewa_box_transform(asset->to_world, leaves[i].low_world, leaves[i].high_world);
    asset->count = stream->count;
    ewa_report(context, EWA_SEVERITY_INFO, "%llu Gaussians in %u leaves, of which each picture reads what it needs",
               (unsigned long long)stream->count, stream->file.leaf_count);
    return EWA_OK;
}

void ewa_asset_stream_free(ewa_asset_stream **given) {
    ewa_asset_stream *stream = *given;
    if (!stream) return;
    *given = NULL;
    ewa_release(stream->context, stream->spacing_world, stream->file.range_count, sizeof *stream->spacing_world);
    ewa_streamed_free(&stream->file);
    ewa_release(stream->context, stream, 1, sizeof *stream);
}
