// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Transfer functions by name.
#include "base/base.h"
#include "image/transfer.h"

#include <math.h>
#include <string.h>

enum { MAX_STOPS = 8, BINS = 256 };

/// Values of a CT volume: air is near -1000.
static const double LOWEST_AIR = -3100, HIGHEST_AIR = -500, MIN_BONE = 400;

/// Share of the voxels that are above the range that presets are spread over.
static const double TOP_SHARE = 0.0005;

/// One point: a value in Hounsfield units and, for volumes in other units, as a share of the range.
typedef struct preset_stop {
    double hounsfield, share;
    uint32_t srgb;
    double opacity; ///< of one unit length
} preset_stop;

typedef struct preset {
    const char *name, *what;
    preset_stop stops[MAX_STOPS];
    uint32_t stop_count;
} preset;

/// What has no meaning in Hounsfield units.
#define NONE NAN

static const preset presets[] = {
    {"bone",
     "CT: bone in ivory, the rest away",
     {{150, 0.36, 0x8a3a22, 0},
      {230, 0.42, 0xc08a5c, 0.05},
      {400, 0.50, 0xe8d2a8, 0.35},
      {1000, 0.75, 0xfff6e4, 0.7},
      {3000, 1, 0xffffff, 0.8}},
     5},
    {"soft",
     "CT: skin and muscle translucent, bone solid",
     {{-350, 0.12, 0xb87a5c, 0},
      {-120, 0.19, 0xd69a78, 0.014},
      {20, 0.25, 0xc86a50, 0.008},
      {90, 0.30, 0xb04a38, 0.012},
      {250, 0.44, 0xe4cca4, 0.3},
      {1000, 0.75, 0xfff6e4, 0.7},
      {3000, 1, 0xffffff, 0.8}},
     7},
    {"skin",
     "CT: the skin as a surface",
     {{-450, 0.10, 0xd8a080, 0},
      {-200, 0.17, 0xe0ac8c, 0.45},
      {100, 0.30, 0xe4b494, 0.7},
      {3000, 1, 0xf4e4d4, 0.8}},
     4},
    {"vessels",
     "CT or MR angiography: contrast agent in red, dense matter ivory",
     {{100, 0.22, 0x7a1410, 0},
      {180, 0.34, 0xb42018, 0.12},
      {350, 0.55, 0xd8402c, 0.5},
      {700, 0.80, 0xf4c49c, 0.7},
      {3000, 1, 0xfff6e4, 0.8}},
     5},
    {"mri",
     "MR: grey matter and skin, by brightness",
     {{NONE, 0.10, 0x5a4a44, 0},
      {NONE, 0.22, 0x96786a, 0.015},
      {NONE, 0.45, 0xc4a48e, 0.05},
      {NONE, 0.70, 0xe8d8c4, 0.15},
      {NONE, 1, 0xffffff, 0.4}},
     5},
    {"gray",
     "a grey ramp: black and empty to white and dense",
     {{NONE, 0, 0x000000, 0}, {NONE, 1, 0xffffff, 0.25}},
     2},
    {"fog",
     "grey blue, which shows before white and black; denser with the value, never solid",
     {{NONE, 0, 0x8494a4, 0}, {NONE, 1, 0x8494a4, 0.03}},
     2},
};

const char *ewa_transfer_preset_name(uint32_t index, const char **what) {
    if (index >= sizeof presets / sizeof presets[0]) return NULL;
    if (what) *what = presets[index].what;
    return presets[index].name;
}

/// Whether the values are Hounsfield units.
static bool is_hounsfield(const ewa_volume_facts *facts) {
    return facts->low >= LOWEST_AIR && facts->low <= HIGHEST_AIR && facts->high >= MIN_BONE;
}

/// The range that shares are of: all but the few greatest values.
static void find_range(const ewa_volume_facts *facts, double range[2]) {
    uint64_t above = 0;
    int top = BINS - 1;
    while (top > 1 && (double)(above + facts->histogram[top]) < TOP_SHARE * (double)facts->finite_count)
        above += facts->histogram[top--];
    range[0] = facts->low;
    range[1] = facts->low + (facts->high - facts->low) * top / (BINS - 1);
}

ewa_status ewa_transfer_preset(const ewa_volume *volume, const ewa_volume_facts *facts, const char *name,
                               ewa_transfer *transfer) {
    if (!volume || !facts || !name || !transfer) return EWA_ERROR_ARGUMENT;
    const preset *found = NULL;
    for (size_t i = 0; i < sizeof presets / sizeof presets[0]; i++)
        if (strcmp(presets[i].name, name) == 0) found = &presets[i];
    if (!found) return ewa_fail(volume->context, EWA_ERROR_ARGUMENT, "no preset '%.80s'", name);
    EWA_TRY(ewa_transfer_check_facts(volume, facts));
    double range[2];
    find_range(facts, range);
    const bool hounsfield = is_hounsfield(facts) && !isnan(found->stops[0].hounsfield);
    *transfer = (ewa_transfer){.unit_length_world = ewa_transfer_unit(facts)};
    for (uint32_t i = 0; i < found->stop_count; i++) {
        const preset_stop *stop = &found->stops[i];
        const double value = hounsfield ? stop->hounsfield : range[0] + stop->share * (range[1] - range[0]);
        ewa_transfer_add(transfer, value, stop->srgb, ewa_extinction_of_opacity(stop->opacity));
    }
    // What is above the last point looks like it.
    const ewa_transfer_point *last = &transfer->points[transfer->point_count - 1];
    if (last->value < facts->high) {
        transfer->points[transfer->point_count] = *last;
        transfer->points[transfer->point_count++].value = facts->high;
    }
    return EWA_OK;
}
