// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which labels of a volume stand before others, seen from the six sides of its box.
#include "base/base.h"
#include "image/volume.h"
#include "image/volume_kind.h"

#include <string.h>

/// Sums over lines of sight.
typedef struct label_sums {
    const ewa_volume_labels *labels;
    ewa_label_sight *sights;
    double entered; ///< of labels, over all lines
    uint32_t order[EWA_MAX_LABELS];
    bool seen[EWA_MAX_LABELS]; ///< on the line at hand
} label_sums;

static void look_along(void *user, const float *at, ptrdiff_t step, uint32_t count) {
    label_sums *sums = user;
    const ewa_volume_labels *labels = sums->labels;
    uint32_t seen_count = 0;
    memset(sums->seen, 0, sizeof sums->seen);
    for (uint32_t i = 0; i < count; i++, at += step) {
        const uint32_t here = ewa_volume_label_index(labels, *at);
        if (here >= labels->count || here == labels->surrounding) continue;
        sums->sights[here].voxels++;
        if (sums->seen[here]) continue;
        for (uint32_t n = 0; n < seen_count; n++) sums->sights[sums->order[n]].before++;
        sums->sights[here].entries++;
        sums->entered++;
        sums->seen[here] = true;
        sums->order[seen_count++] = here;
    }
}

ewa_status ewa_volume_labels_look(const ewa_volume *volume, const ewa_volume_labels *labels,
                                  ewa_label_sight sights[EWA_MAX_LABELS]) {
    memset(sights, 0, EWA_MAX_LABELS * sizeof *sights);
    label_sums sums = {.labels = labels, .sights = sights};
    EWA_TRY(ewa_volume_look_through(volume, look_along, &sums));
    for (uint32_t i = 0; i < labels->count; i++) {
        const double others = sums.entered - sights[i].entries;
        sights[i].before = others > 0 ? sights[i].before / others : 0;
    }
    return EWA_OK;
}
