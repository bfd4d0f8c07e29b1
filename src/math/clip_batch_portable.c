// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The batch clipper, 4 lanes.
#define LANES  4
#define KERNEL ewa_clip_segments_portable
#include "math/clip_batch_body.h"
