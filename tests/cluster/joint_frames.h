// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Frames of several sources of every kind, which ranks hold.
#ifndef EWA_TESTS_CLUSTER_JOINT_FRAMES_H
#define EWA_TESTS_CLUSTER_JOINT_FRAMES_H

#include "splat/picture.h"
#include "surface/render.h"

enum { JOINT_FRAMES = 22, JOINT_WIDTH_PX = 150, JOINT_HEIGHT_PX = 131, JOINT_PARTS = 5 };

/// A frame of JOINT_PARTS sources.
typedef struct joint_frame {
    bool clips, materials; ///< some parts have clip lines; all have materials
    bool planes;           ///< all planes are asked for, not rgba8 alone
    ewa_render_source how[JOINT_PARTS];
    ewa_material table[3];
    ewa_camera camera;
    ewa_render_options options;
} joint_frame;

/// Frame `index` of JOINT_FRAMES; not to be moved.
void joint_frame_make(ewa_context *context, int index, joint_frame *made);

/// Draws parts `rank`, `rank` + rank_count, ... of a frame.
ewa_status joint_frame_draw(ewa_context *context, ewa_renderer *renderer, const joint_frame *of,
                            uint32_t rank, uint32_t rank_count, const picture *into);

/// Whether two pictures of a frame have the same bytes.
bool joint_frame_same(const joint_frame *of, const picture *a, const picture *b);

#endif
