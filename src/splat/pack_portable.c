// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The packing kernel, plain C.
#define KERNEL ewa_pack_portable
#include "splat/pack_body.h"
