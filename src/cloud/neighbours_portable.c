// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The hot loops of the neighbour search for any machine.
#define WIDE_PORTABLE
#define KERNELS ewa_search_kernels_portable
#include "cloud/neighbours_body.h"
