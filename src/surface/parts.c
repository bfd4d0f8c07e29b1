// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The median size of what a frame shows says into how many parts pixels are divided: a sum of whole numbers, so that neither
// order nor processes count, and continuous in the camera, so that nothing pops.
#include "surface/parts.h"
#include "homogeneous/camera.h"
#include "surface/packets.h"
#include "surface/semantics.h"

#include <math.h>

/// Packets of which the sizes are looked at, at most.
enum { SAMPLED_PACKETS = 1 << 11 };

/// Octaves within which more parts take over, in steps so many to an octave: the last bits of a logarithm differ between machines.
static const double BLEND = 0.125, STEPS = 8192;

/// Units of areas in a square pixel, and the largest area that one call adds.
static const double AREA_UNIT = 0x1p24, LARGEST_AREA = 0x1p26;

void ewa_part_areas_add(ewa_part_areas *areas, double radius_px, double area) {
    if (!(area > 0)) return;
    const double octaves = radius_px > 0 ? log2(EWA_PART_RADIUS_PX / radius_px) : EWA_PART_PLACES;
    const double place = fmin(fmax(octaves * EWA_PART_STEPS - EWA_PART_FIRST, 0), EWA_PART_PLACES - 1);
    const int low = place < EWA_PART_PLACES - 1 ? (int)place : EWA_PART_PLACES - 2;
    const double units = ceil(fmin(area, LARGEST_AREA) * AREA_UNIT);
    const int64_t above = (int64_t)(units * (place - low));
    areas->at[low] += (int64_t)units - above;
    areas->at[low + 1] += above;
}

double ewa_part_areas_octaves(const ewa_part_areas *areas) {
    double all = 0;
    for (int i = 0; i < EWA_PART_PLACES; i++) all += (double)areas->at[i];
    // Of what is at a place half counts as below it, of the first one, where all that is larger is, all; in between it goes up evenly.
    double below = (double)areas->at[0], here = below, place = 0;
    for (int i = 1; i < EWA_PART_PLACES && here < all / 2; i++) {
        const double next = below + (double)areas->at[i] / 2;
        place = next >= all / 2 ? i - 1 + (all / 2 - here) / (next - here) : i;
        below += (double)areas->at[i];
        here = next;
    }
    return (place + EWA_PART_FIRST) / EWA_PART_STEPS;
}

ewa_division ewa_parts_for(double octaves, const ewa_camera *camera) {
    const uint64_t side_px = camera->width_px > camera->height_px ? camera->width_px : camera->height_px;
    ewa_division parts = {.count = 1};
    for (int k = 0; k < 3 && octaves > k && 2 * parts.count * side_px <= EWA_CAMERA_MAX_SIDE_PX; k++) {
        if (octaves < k + BLEND) {
            parts.finer_share = floor((octaves - k) * STEPS) / (BLEND * STEPS);
            break;
        }
        parts.count *= 2;
    }
    return parts;
}

void ewa_part_areas_add_surfels(ewa_part_areas *areas, const ewa_camera *camera, const ewa_surfels *surfels, uint32_t step) {
    const double *m = camera->world_to_camera;
    const double zoom = fmax(camera->fx_px, camera->fy_px);
    for (uint32_t p = 0; p < surfels->packet_count; p += step) {
        const ewa_vec3 center = ewa_packet_center(surfels, p);
        const double at[3] = {center.x * surfels->unit + surfels->origin_world[0],
                              center.y * surfels->unit + surfels->origin_world[1],
                              center.z * surfels->unit + surfels->origin_world[2]};
        double camera_at[3];
        for (int r = 0; r < 3; r++)
            camera_at[r] = m[4 * r] * at[0] + m[4 * r + 1] * at[1] + m[4 * r + 2] * at[2] + m[4 * r + 3];
        const bool flat = camera->projection == EWA_ORTHOGRAPHIC;
        const double depth = flat ? 1 : camera_at[2], sigma = (double)surfels->packets[p].sigma[0] * surfels->unit;
        if (!(camera_at[2] > 0) || !(sigma > 0)) continue;
        const double x = camera->fx_px * camera_at[0] / depth + camera->cx_px;
        const double y = camera->fy_px * camera_at[1] / depth + camera->cy_px;
        if (x < 0 || y < 0 || x > camera->width_px || y > camera->height_px) continue;
        const double scale = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
        const double radius_px = surfels->cutoff * sigma * scale * zoom / depth;
        ewa_part_areas_add(areas, radius_px, radius_px * radius_px);
    }
}

uint32_t ewa_part_areas_step(uint64_t packet_count) { return (uint32_t)(packet_count / SAMPLED_PACKETS) + 1; }
