// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours of splats that stand for numbers. Which colour a number has is decided where it is for all points: the splats become a
// cloud for that.
#include "volume/splat_colors.h"
#include "base/base.h"
#include "math/gaussian.h"
#include "volume/splat_packets.h"

#include <string.h>

enum { LANES = EWA_SPLAT_LANES };

/// The value of the constant harmonic.
static const double CONSTANT = 0.28209479177387814;

/// Packets of a set's levels.
static size_t level_packets(const ewa_splats *splats) { return (size_t)splats->part_count * EWA_SPLAT_MERGED_PACKETS; }

ewa_status ewa_splats_to_cloud(const ewa_splats *splats, bool levels, ewa_cloud **cloud) {
    const size_t first = levels ? splats->packet_count : 0,
                 count = levels ? level_packets(splats) * LANES : splats->info.splat_count;
    ewa_gaussians set;
    *cloud = NULL;
    EWA_TRY(ewa_gaussians_create(splats->context, (uint32_t)count, 0, &set));
    ewa_status status = splats->classes ? ewa_gaussians_add_classes(&set) : EWA_OK;
    if (status != EWA_OK) {
        ewa_gaussians_free(&set);
        return status;
    }
    const double unit = splats->unit_world;
    memcpy(set.origin, splats->origin_world, sizeof set.origin);
    for (size_t i = 0; i < count; i++) {
        const size_t lane = i % LANES;
        const ewa_splat_packet *from = &splats->packets[first + i / LANES];
        for (size_t k = 0; k < 3; k++) {
            set.centers[3 * i + k] = (float)(unit * (double)(*from)[EWA_SPLAT_PLACE + k][lane]);
            set.scales[3 * i + k] = (float)(unit * (double)(*from)[EWA_SPLAT_SCALE + k][lane]);
            set.harmonics[3 * i + k] = (*from)[EWA_SPLAT_COLOR + k][lane];
        }
        for (size_t k = 0; k < 4; k++) set.rotations[4 * i + k] = (*from)[EWA_SPLAT_ROTATION + k][lane];
        set.opacities[i] = (*from)[EWA_SPLAT_OPACITY][lane];
        if (set.classes) set.classes[i] = splats->classes[first + i / LANES][lane];
    }
    status = ewa_gaussians_to_cloud(&set, cloud);
    ewa_gaussians_free(&set);
    return status;
}

/// Takes a cloud's colours, from a packet on.
static void take(ewa_splat_colors *colors, size_t first, const ewa_cloud *cloud) {
    const ewa_attribute *color = ewa_cloud_find(cloud, EWA_COLOR);
    const uint64_t count = color && color->type == EWA_U8 && color->component_count == 3 ? ewa_cloud_point_count(cloud) : 0;
    const uint8_t *codes = count ? color->data : NULL;
    for (uint64_t i = 0; i < count; i++)
        for (uint64_t c = 0; c < 3; c++)
            colors->colors[first + i / LANES][c][i % LANES] = (float)codes[3 * i + c] / 255;
}

ewa_status ewa_splat_colors_create(const ewa_splats *splats, const ewa_cloud *own, const ewa_cloud *levels,
                                   ewa_splat_colors **colors) {
    ewa_context *context = splats->context;
    *colors = NULL;
    ewa_splat_colors *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->serial = ewa_serial_next(context);
    made->packet_count = splats->packet_count + level_packets(splats);
    made->colors = ewa_allocate_zeroed(context, made->packet_count, sizeof *made->colors);
    if (!made->colors) {
        ewa_release(context, made, 1, sizeof *made);
        return EWA_ERROR_MEMORY;
    }
    take(made, 0, own);
    if (levels) take(made, splats->packet_count, levels);
    *colors = made;
    return EWA_OK;
}

void ewa_splat_colors_destroy(ewa_splat_colors **colors) {
    ewa_splat_colors *old = *colors;
    if (!old) return;
    *colors = NULL;
    ewa_release(old->context, old->colors, old->packet_count, sizeof *old->colors);
    ewa_release(old->context, old, 1, sizeof *old);
}

void ewa_splat_colors_apply(const ewa_splat_colors *colors, const ewa_splat_packet *packets, size_t packet,
                            ewa_splat_packet *painted) {
    memcpy(painted, &packets[packet], sizeof *painted);
    for (int c = 0; c < 3; c++)
        for (int lane = 0; lane < LANES; lane++)
            (*painted)[EWA_SPLAT_COLOR + c][lane] = (float)(((double)colors->colors[packet][c][lane] - 0.5) / CONSTANT);
}
