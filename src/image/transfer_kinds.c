// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Automatic transfer functions of volumes that are no scans: labels, fields, pictures, noise.
// docs/volume_files.md says the rules.
//
// Based on: M. Levoy, "Display of Surfaces from Volume Data", 1988, section 3 (shells of equal thickness around
// values).
#include "image/transfer_kinds.h"
#include "base/base.h"
#include "ewa/image.h"
#include "image/transfer.h"

#include <math.h>

enum { BINS = EWA_SURFACE_BINS, SHELLS = 4, GREYS = 32 };

/// Extinction per unit length of solid matter; that of a picture, whose one slice lets next to nothing through.
static const double SOLID = 0.7, OPAQUE = 12;

/// Share of the transitions to other labels from which on a label that comes before them surrounds them; the optical
/// depth of such a label along a mean line of sight, shared by all of its kind.
static const double AROUND = 0.6, AROUND_DEPTH = 0.5;

/// Share of the voxels within the outermost shell, at most and, where it is moved inwards, at least; how much of the
/// box's faces it may cut then; share of what it encloses that the core does; half the thickness of a shell as a share of
/// the way to the next, and at most where it is thinner than so many voxels; its optical depth, from the outermost on.
static const double OUTER_SHARE = 0.2, MIN_SHARE = 0.05, FACE_SHARE = 0.05, CORE_SHARE = 0.02, THICK = 0.3,
                    THICKEST = 0.5, RESOLVED_VOXELS = 3;
static const double SHELL_DEPTH[SHELLS - 1] = {0.12, 0.25, 0.45};
static const uint32_t SHELL_COLOR[SHELLS] = {0x4f86d9, 0x45bfa6, 0xf0c050, 0xe0583c};

/// Optical depth of noise through all of the box, at its highest value.
static const double FOG_DEPTH = 3;

static uint32_t class_color(float code) {
    uint8_t srgb[3];
    ewa_class_color((uint32_t)fabsf(code), srgb);
    return (uint32_t)srgb[0] << 16 | (uint32_t)srgb[1] << 8 | srgb[2];
}

ewa_status ewa_transfer_labels(const ewa_volume *volume, const ewa_volume_facts *facts,
                               const ewa_volume_labels *labels, ewa_transfer *transfer) {
    ewa_label_sight sights[EWA_MAX_LABELS];
    EWA_TRY(ewa_volume_labels_look(volume, labels, sights));
    *transfer = (ewa_transfer){.unit_length_world = ewa_transfer_unit(facts)};
    const double *step = facts->spacing_world, step_world = 3 / (1 / step[0] + 1 / step[1] + 1 / step[2]);
    uint32_t around = 0;
    for (uint32_t i = 0; i < labels->count; i++) around += sights[i].before > AROUND;
    for (uint32_t i = 0; i < labels->count; i++) {
        double extinction = i == labels->surrounding ? 0 : OPAQUE;
        if (sights[i].before > AROUND) {
            const double path_world = step_world * sights[i].voxels / sights[i].entries;
            extinction = fmin(AROUND_DEPTH / around * transfer->unit_length_world / path_world, SOLID);
        }
        ewa_transfer_add(transfer, (double)labels->codes[i], class_color(labels->codes[i]), extinction);
    }
    return EWA_OK;
}

/// The first threshold from `from` on with at most this share of the voxels above it.
static int threshold_of_share(const ewa_volume_surfaces *s, int from, double share) {
    int t = from;
    while (t < BINS - 1 && s->above[t] > share * s->count) t++;
    return t;
}

/// How thick what lies between two thresholds is, in voxels: its volume over its area.
static double thickness_of(const ewa_volume_surfaces *s, double from, double to) {
    const int low = (int)fmax(from, 1), high = (int)fmin(to + 1, BINS - 1);
    double area = 0;
    for (int t = low; t <= high; t++) area += s->area[t] / (high - low + 1);
    // Faces of voxels have 1.5 times the area of the surface that they stand for.
    return 1.5 * (s->above[low] - s->above[high]) / fmax(area, 1);
}

/// Where the outermost shell lies: not cut by the faces of the box, if the field is lower there.
static int outermost(const ewa_volume_surfaces *s) {
    const int first = threshold_of_share(s, 1, OUTER_SHARE);
    for (int t = first; t < BINS - SHELLS && s->above[t] > MIN_SHARE * s->count; t++)
        if (s->borders[t] <= FACE_SHARE * s->border_count) return t;
    return first;
}

/// The values of the shells: each encloses the same share of what the one around it does.
static void find_shells(const ewa_volume_surfaces *s, double places[SHELLS]) {
    const int outer = outermost(s);
    for (int i = 0; i < SHELLS; i++) {
        const double share = s->above[outer] / s->count * pow(CORE_SHARE, (double)i / (SHELLS - 1));
        places[i] = threshold_of_share(s, outer, share);
        if (i) places[i] = fmax(places[i], places[i - 1] + 1);
    }
}

void ewa_transfer_field(const ewa_volume_facts *facts, const ewa_volume_surfaces *s, ewa_transfer *transfer) {
    double places[SHELLS];
    find_shells(s, places);
    *transfer = (ewa_transfer){.unit_length_world = ewa_transfer_unit(facts)};
    const double *step = facts->spacing_world, step_world = 3 / (1 / step[0] + 1 / step[1] + 1 / step[2]);
    for (int i = 0; i + 1 < SHELLS; i++) {
        const double above = places[i + 1] - places[i];
        const double room = i ? fmin(places[i] - places[i - 1], above) : fmin(places[i], above);
        double half = THICK * room;
        while (half + 0.05 * room <= THICKEST * room &&
               thickness_of(s, places[i] - half, places[i] + half) < RESOLVED_VOXELS)
            half += 0.05 * room;
        // A ramp up and down is half as much as a plateau. A shell that the voxels do not resolve would be dashes: what
        // is within it is filled up to the next.
        double thickness = 0.5 * thickness_of(s, places[i] - half, places[i] + half);
        const bool filled = thickness < 0.5 * RESOLVED_VOXELS;
        if (filled) thickness = thickness_of(s, places[i], places[i + 1]);
        const double thickness_world = fmax(thickness, 1) * step_world;
        const double extinction = fmin(SHELL_DEPTH[i] * transfer->unit_length_world / thickness_world, SOLID);
        ewa_transfer_add(transfer, ewa_surfaces_value(s, places[i] - half), SHELL_COLOR[i], 0);
        ewa_transfer_add(transfer, ewa_surfaces_value(s, places[i]), SHELL_COLOR[i], extinction);
        ewa_transfer_add(transfer, ewa_surfaces_value(s, places[i] + half), SHELL_COLOR[i],
                         filled ? extinction : 0);
    }
    const double core = places[SHELLS - 1], below = core - THICK * (core - places[SHELLS - 2]);
    ewa_transfer_add(transfer, ewa_surfaces_value(s, below), SHELL_COLOR[SHELLS - 1], 0);
    ewa_transfer_add(transfer, ewa_surfaces_value(s, core), SHELL_COLOR[SHELLS - 1], SOLID);
    ewa_transfer_add(transfer, fmax(facts->high, ewa_surfaces_value(s, core)), SHELL_COLOR[SHELLS - 1],
                     SOLID);
}

void ewa_transfer_picture(const ewa_volume_facts *facts, const ewa_volume_surfaces *s,
                          ewa_transfer *transfer) {
    *transfer = (ewa_transfer){.unit_length_world = 0};
    const double low = s->low, width = s->high - s->low;
    if (facts->low < low) ewa_transfer_add(transfer, facts->low, 0, OPAQUE);
    for (uint32_t i = 0; i < GREYS; i++) {
        const uint32_t grey = (255 * i + GREYS / 2) / (GREYS - 1);
        ewa_transfer_add(transfer, low + width * i / (GREYS - 1), grey << 16 | grey << 8 | grey, OPAQUE);
    }
    if (facts->high > s->high) ewa_transfer_add(transfer, facts->high, 0xffffff, OPAQUE);
}

void ewa_transfer_noise(const ewa_volume_facts *facts, ewa_transfer *transfer) {
    *transfer = (ewa_transfer){.unit_length_world = ewa_transfer_unit(facts)};
    double longest = 0;
    for (int axis = 0; axis < 3; axis++)
        longest = fmax(longest, facts->high_world[axis] - facts->low_world[axis]);
    ewa_transfer_add(transfer, facts->low, 0x404040, 0);
    ewa_transfer_add(transfer, facts->high, 0xf0f0f0,
                     FOG_DEPTH * transfer->unit_length_world / fmax(longest, transfer->unit_length_world));
}
