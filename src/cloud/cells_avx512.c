// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Codes of cells, AVX-512.
#define KERNEL ewa_code_cells_avx512
#include "cloud/cells_body.h"
