// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The batch clipper, 16 lanes.
#define LANES  16
#define KERNEL ewa_clip_segments_avx512
#include "math/clip_batch_body.h"
