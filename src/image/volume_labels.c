// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which labels of a volume stand before others, seen from the six sides of its box.
#include "base/base.h"
#include "image/volume.h"
#include "image/volume_kind.h"

#include <string.h>

enum { COLUMNS = 48 };

/// Sums over lines of sight.
typedef struct label_sums {
    ewa_label_sight *sights;
    double meetings; ///< of labels, over all lines
    uint32_t order[EWA_MAX_LABELS];
    bool met[EWA_MAX_LABELS]; ///< on the line at hand
} label_sums;

/// One line of sight, from `at` on in steps of `step`.
static void look_along(const float *at, ptrdiff_t step, uint32_t count, const ewa_volume_labels *labels,
                       label_sums *sums) {
    uint32_t met_count = 0;
    memset(sums->met, 0, sizeof sums->met);
    for (uint32_t i = 0; i < count; i++, at += step) {
        const uint32_t here = ewa_volume_label_index(labels, *at);
        if (here >= labels->count || here == labels->surrounding) continue;
        sums->sights[here].voxels++;
        if (sums->met[here]) continue;
        for (uint32_t n = 0; n < met_count; n++) sums->sights[sums->order[n]].before++;
        sums->sights[here].entries++;
        sums->meetings++;
        sums->met[here] = true;
        sums->order[met_count++] = here;
    }
}

ewa_status ewa_volume_labels_look(const ewa_volume *volume, const ewa_volume_labels *labels,
                                  ewa_label_sight sights[EWA_MAX_LABELS]) {
    const uint32_t *dims = volume->dims;
    const uint64_t strides[3] = {1, dims[0], (uint64_t)dims[0] * dims[1]};
    uint32_t longest = dims[0];
    for (int axis = 1; axis < 3; axis++) longest = dims[axis] > longest ? dims[axis] : longest;
    memset(sights, 0, EWA_MAX_LABELS * sizeof *sights);
    float *numbers = ewa_allocate(volume->context, longest, sizeof *numbers);
    if (!numbers) return EWA_ERROR_MEMORY;
    label_sums sums = {.sights = sights};
    for (int axis = 0; axis < 3; axis++) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const uint32_t u_step = 1 + dims[u] / COLUMNS, v_step = 1 + dims[v] / COLUMNS;
        for (uint32_t b = v_step / 2; b < dims[v]; b += v_step)
            for (uint32_t a = u_step / 2; a < dims[u]; a += u_step) {
                ewa_volume_read_column(volume, a * strides[u] + b * strides[v], strides[axis], dims[axis],
                                       numbers);
                look_along(numbers, 1, dims[axis], labels, &sums);
                look_along(numbers + dims[axis] - 1, -1, dims[axis], labels, &sums);
            }
    }
    ewa_release(volume->context, numbers, longest, sizeof *numbers);
    for (uint32_t i = 0; i < labels->count; i++) {
        const double others = sums.meetings - sights[i].entries;
        sights[i].before = others > 0 ? sights[i].before / others : 0;
    }
    return EWA_OK;
}
