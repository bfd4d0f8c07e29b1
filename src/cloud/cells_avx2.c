// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Codes of cells, AVX2.
#define KERNEL ewa_code_cells_avx2
#include "cloud/cells_body.h"
