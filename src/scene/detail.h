// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Surfels that are drawn many times, by the levels that are enough for a frame.
#ifndef EWA_SRC_SCENE_DETAIL_H
#define EWA_SRC_SCENE_DETAIL_H

#include "base/base.h"
#include "ewa/render.h"

/// What a renderer keeps of the surfels that it draws: their levels, and how far these are off.
typedef struct ewa_details {
    ewa_buffer items, finest;
    uint32_t count;
    uint64_t frame;
    /// Of each of the surfels of the last frame: who is to say into how many parts its pixels are divided, all surfels or the level;
    /// NULL: they are drawn as they are.
    const ewa_surfels *const *parts_of;
} ewa_details;

void ewa_details_free(ewa_context *context, ewa_details *details);

/// Puts in the place of each of `count` surfels the coarsest of their levels that is no sparser than the frame's pixels and
/// with which the frame is expected to be off by no more than `max_rms` (in 1/255 of sRGB, the root of the mean square over
/// all of its pixels), in parts of pixels that these or, where they are drawn `alone` (without octrees), all surfels ask for, whichever is
/// cheaper. Surfels without levels get them when the first frame can do with them, for as long as frames have these surfels. What
/// is chosen depends on surfels, camera and options alone. Sets `*level` to the coarsest. Errors: those of ewa_render().
ewa_status ewa_details_choose(ewa_context *context, ewa_details *details, const ewa_camera *camera,
                              const ewa_render_options *options, double max_rms, bool alone, const ewa_surfels **surfels,
                              uint32_t count, uint32_t *level);

#endif
