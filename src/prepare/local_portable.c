// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Normals, spacing and shape of neighbourhoods for any machine.
#define WIDE_PORTABLE
#define KERNELS ewa_local_kernels_portable
#include "prepare/local_body.h"
