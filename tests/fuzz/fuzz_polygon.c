// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target: any bytes as an outline and as a filter; what can be read can be looked at.
#include "fuzz.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ewa/select.h"

static void try_filter(const uint8_t *bytes, size_t size_bytes) {
    char *text = malloc(size_bytes + 1);
    if (!text) return;
    memcpy(text, bytes, size_bytes);
    text[size_bytes] = 0;
    static ewa_filter filter;
    memset(&filter, 0, sizeof filter);
    char problem[EWA_OPTION_TEXT_BYTES] = "";
    const ewa_status status = ewa_filter_add(&filter, text, problem);
    if ((status == EWA_OK) != (filter.term_count > 0) || (status == EWA_OK) != (problem[0] == 0)) abort();
    for (uint32_t t = 0; t < filter.term_count; t++)
        for (uint32_t r = 0; r < filter.terms[t].range_count; r++)
            if (!(filter.terms[t].ranges[r].low <= filter.terms[t].ranges[r].high)) abort();
    free(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    try_filter(bytes, size_bytes);
    ewa_context *context = fuzz_context(1, 0, NULL);
    ewa_polygon *polygon = NULL;
    if (ewa_polygon_read(context, "fuzz", bytes, size_bytes, &polygon) == EWA_OK) {
        double box[4], points[6] = {0};
        ewa_polygon_box(polygon, box);
        if (!(box[0] <= box[2] && box[1] <= box[3]) || !isfinite(box[0]) || !isfinite(box[3])) abort();
        ewa_cloud *cloud = NULL;
        uint8_t marks[2] = {1, 1};
        points[3] = 0.5 * box[0] + 0.5 * box[2];
        points[4] = 0.5 * box[1] + 0.5 * box[3];
        if (ewa_cloud_create(context, 2, &cloud) == EWA_OK &&
            ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F64, 3, points, 0) == EWA_OK &&
            ewa_polygon_mark(polygon, cloud, marks) != EWA_OK)
            abort();
        ewa_cloud_destroy(&cloud);
    }
    ewa_polygon_destroy(&polygon);
    ewa_context_destroy(&context);
    return 0;
}
