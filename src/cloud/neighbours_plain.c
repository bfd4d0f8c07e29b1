// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The hot loops of the neighbour search for any machine that GCC or Clang knows.
#define WIDTH   4
#define KERNELS ewa_search_kernels_plain
#include "cloud/neighbours_body.h"
