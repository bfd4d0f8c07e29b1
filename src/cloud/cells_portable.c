// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Codes of cells, plain C.
#define KERNEL ewa_code_cells_portable
#include "cloud/cells_body.h"
