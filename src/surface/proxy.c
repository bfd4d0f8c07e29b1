// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Surfels that take part in what the sources of a frame share, and draw nothing.
#include "surface/proxy.h"
#include "base/base.h"
#include "surface/packets.h"

#include <math.h>

/// One level; NULL: no memory.
static ewa_surfels *copy_level(const ewa_surfels *surfels) {
    ewa_surfels *made = ewa_allocate_zeroed(surfels->context, 1, sizeof *made);
    if (!made) return NULL;
    *made = *surfels;
    made->with_opacities |= surfels->opacities != NULL;
    made->with_materials |= surfels->materials != NULL;
    made->with_clips |= surfels->clip_masks != NULL;
    made->count = made->packet_count = 0;
    made->bounds_stride = 0;
    made->clip_count = 0;
    made->packets = NULL;
    made->materials = NULL;
    made->curvatures = NULL;
    made->opacities = made->clip_masks = NULL;
    made->clip_first = NULL;
    made->clips = NULL;
    made->bounds = (ewa_packet_bounds){0};
    made->bounds_memory = NULL;
    made->coarser = NULL;
    return made;
}

ewa_status ewa_surfels_proxy(const ewa_surfels *surfels, ewa_surfels **proxy) {
    if (!proxy) return EWA_ERROR_ARGUMENT;
    *proxy = NULL;
    if (!surfels) return EWA_ERROR_ARGUMENT;
    for (ewa_surfels **next = proxy; surfels; surfels = surfels->coarser, next = &(*next)->coarser) {
        *next = copy_level(surfels);
        if (*next) continue;
        ewa_surfels_destroy(proxy);
        return EWA_ERROR_MEMORY;
    }
    return EWA_OK;
}

ewa_status ewa_surfels_set_unit_coverage(ewa_surfels *surfels, double unit_coverage) {
    if (!surfels) return EWA_ERROR_ARGUMENT;
    if (!(unit_coverage > 0) || !isfinite(unit_coverage))
        return ewa_fail(surfels->context, EWA_ERROR_ARGUMENT, "surfels: a unit coverage of %g is not above 0",
                        unit_coverage);
    for (; surfels; surfels = surfels->coarser) surfels->unit_coverage = unit_coverage;
    return EWA_OK;
}

ewa_status ewa_surfels_measure_unit_coverage(const ewa_cloud *cloud, const ewa_surfels_options *options,
                                             double *unit_coverage) {
    ewa_surfels *surfels = NULL;
    EWA_TRY(ewa_surfels_create(cloud, options, &surfels));
    *unit_coverage = surfels->unit_coverage;
    ewa_surfels_destroy(&surfels);
    return EWA_OK;
}
