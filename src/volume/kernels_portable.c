// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The kernels of volumes for any machine.
#define WIDE_PORTABLE
#define VOLUME_NAME    "portable"
#define VOLUME_KERNELS ewa_volume_kernels_portable
#include "volume/kernels_body.h"
