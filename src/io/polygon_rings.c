// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Rings of corners that a text tells one after the other.
#include "io/polygon.h"

#include <math.h>

enum { MAX_CORNERS = 1 << 28 };

ewa_status ewa_rings_add(ewa_rings *rings, double x, double y) {
    if (!isfinite(x) || !isfinite(y))
        return ewa_fail(rings->context, EWA_ERROR_FORMAT, "%s: corner %llu is not finite", rings->name,
                        (unsigned long long)(rings->corner_count + 1));
    if (rings->corner_count == MAX_CORNERS)
        return ewa_fail(rings->context, EWA_ERROR_LIMIT, "%s: over %d corners", rings->name, MAX_CORNERS);
    EWA_TRY(ewa_buffer_grow(rings->context, &rings->corners, rings->corner_count, rings->corner_count + 1,
                            2 * sizeof(double)));
    double *corner = (double *)rings->corners.data + 2 * rings->corner_count++;
    corner[0] = x;
    corner[1] = y;
    rings->open_count++;
    return EWA_OK;
}

ewa_status ewa_rings_close(ewa_rings *rings) {
    if (rings->open_count == 0) return EWA_OK;
    const double *last = (const double *)rings->corners.data + 2 * (rings->corner_count - 1),
                 *first = last - 2 * (size_t)(rings->open_count - 1);
    if (rings->open_count > 1 && first[0] == last[0] && first[1] == last[1]) {
        rings->corner_count--;
        rings->open_count--;
    }
    if (rings->open_count < 3)
        return ewa_fail(rings->context, EWA_ERROR_FORMAT,
                        "%s: ring %u of the outline has %u corners, fewer than 3", rings->name,
                        rings->ring_count + 1, rings->open_count);
    EWA_TRY(ewa_buffer_grow(rings->context, &rings->counts, rings->ring_count, rings->ring_count + 1,
                            sizeof(uint32_t)));
    ((uint32_t *)rings->counts.data)[rings->ring_count++] = rings->open_count;
    rings->open_count = 0;
    return EWA_OK;
}
