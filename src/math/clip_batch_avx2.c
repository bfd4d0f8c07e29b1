// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The batch clipper, 8 lanes.
#define LANES  8
#define KERNEL ewa_clip_segments_avx2
#include "math/clip_batch_body.h"
