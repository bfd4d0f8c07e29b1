// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The table of footprint indices.
#include "volume/footprint.h"

void ewa_footprint_table_make(ewa_footprint_table *table) {
    for (int row = 0; row < EWA_FOOTPRINT_ANGLES; row++) {
        const double sine2 = EWA_FOOTPRINT_END * row / (EWA_FOOTPRINT_ANGLES - 1);
        for (int step = 0; step < EWA_FOOTPRINT_STEPS; step++) {
            const double low = (double)step / EWA_FOOTPRINT_STEPS, high = (step + 1.0) / EWA_FOOTPRINT_STEPS;
            const double at_low = ewa_footprint_index2(low, sine2) - low;
            table->start[row][step] = (float)at_low;
            table->growth[row][step] = (float)(ewa_footprint_index2(high, sine2) - high - at_low);
        }
    }
}
