// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Numbers by their rank: medians, percentiles.
#ifndef EWA_CLI_RANK_H
#define EWA_CLI_RANK_H

#include <stddef.h>

/// Returns the number that would be at place `rank` in [0, count) if the numbers, of which none is NaN, were
/// sorted; shuffles and overwrites them.
double rank_select(double *numbers, size_t count, size_t rank);

#endif
