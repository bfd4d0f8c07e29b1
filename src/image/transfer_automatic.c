// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A transfer function from the volume alone. Of scans, what surrounds and what encloses is left out, materials
// that hide others are drawn translucent, the densest is solid; other kinds of volumes: transfer_kinds.c.
// docs/volume_files.md says the rules and their limits.
//
// Materials are told apart by the areas of the surfaces between values (volume_surfaces.h). A material fills
// a range of values in which any surface is ragged with its noise: a peak of the area. Between two peaks lies
// a boundary, a clean surface, whose area is small and hardly depends on the value.
//
// Based on: G. Kindlmann, J. Durkin, "Semi-Automatic Generation of Transfer Functions for Direct Volume
// Rendering", 1998 (boundaries, not materials, are what there is to see); V. Pekar, R. Wiemker, D. Hempel,
// "Fast Detection of Meaningful Isosurfaces for Volume Data Visualization", 2001 (found in one pass, by sums
// over surfaces); N. Otsu, "A Threshold Selection Method from Gray-Level Histograms", 1979, equation 12.
#include "base/base.h"
#include "image/transfer.h"
#include "image/transfer_kinds.h"

#include <math.h>
#include <string.h>

enum { BINS = EWA_SURFACE_BINS, MAXIMUM = 48, MAX_CLASSES = 3, SMOOTHINGS = 3 };

/// What a peak has to stand out of the area by; how far the area's fall has to slow down, as a share of the
/// steepest fall before, for a boundary to begin, and how far the area has to have come down from the peak;
/// the same for a mere shoulder, and what the fall has to grow by after that; falls, per bin, which are none.
static const double PEAK = 1.2, SLOW = 0.25, SETTLED = 0.8, SHOULDER = 0.5, DOWN = 0.6, AGAIN = 1.4,
                    FLAT = 0.05, NEARLY_FLAT = 0.03;

/// Faces per voxel of what has no volume to speak of (6: single voxels; 2: sheets of one voxel); share of the
/// voxels that make a class; share of what is to be seen that makes one dense enough to open its container
/// for.
static const double SPECKS = 2.5, CLASS_SHARE = 5e-4, CONTENT_SHARE = 2e-3;

/// Share of the box's faces that has to be outside of what is to be seen. Where padding is followed by a
/// material: how far that is from the padding, as a share of what is above it, when it is air.
static const double BORDER_SHARE = 0.6, AIR_RATIO = 0.4;

/// Share of the lines of sight which a container stands in.
static const double CONTAINER_SHARE = 0.5;

/// Noise falls by 1 / e within one bin over its steepest fall: so many of these go by before anything shows,
/// but not more than this share of the way to where all shows. Where there is no noise but a gradual rise,
/// this share of the lowest class is left out.
static const double NOISE_LENGTHS = 1.5, NOISE_SHARE = 0.7, HAZE_SHARE = 0.25;

/// Optical depth of a mean chord through the lowest class when it hides nothing and when it hides everything;
/// extinctions per unit length between which the class is held; that of solid matter.
static const double OPEN_DEPTH = 3, TRANSLUCENT_DEPTH = 0.5, MINIMUM = 0.004, SOLID = 0.7;

static const uint32_t TRANSLUCENT_COLOR = 0xc98a66, BODY_COLOR = 0xe8c9a0, SOLID_COLOR = 0xfff8ec;

/// Where a material ends and the next begins.
typedef struct boundary {
    int at;      ///< threshold
    int mode;    ///< peak of the material below; 0: none, constant values
    double fall; ///< of the logarithm of the area between both, per bin, at most
} boundary;

/// What the rule goes by.
typedef struct material_map {
    ewa_volume_surfaces surfaces;
    double area[BINS]; ///< smoothed
    int last;          ///< the last threshold that counts
    int peaks[MAXIMUM], valleys[MAXIMUM];
    int peak_count;
    boundary found[MAXIMUM];
    int found_count;
} material_map;

/// Classes from the lowest that shows on.
typedef struct class_list {
    boundary edges[MAXIMUM];
    int count;
    bool natural;           ///< they are materials; else one class, or none, cut in two
    ewa_volume_sight sight; ///< of what lies behind the lowest
    int opened;             ///< containers left out
} class_list;

static void smooth(const double area[BINS], double smoothed[BINS]) {
    for (int t = 0; t < BINS; t++) smoothed[t] = area[t];
    for (int pass = 0; pass < SMOOTHINGS; pass++) {
        double before = smoothed[1];
        for (int t = 1; t < BINS; t++) {
            const double here = smoothed[t], after = smoothed[t + 1 < BINS ? t + 1 : t];
            smoothed[t] = 0.25 * before + 0.5 * here + 0.25 * after;
            before = here;
        }
    }
}

/// Finds the peaks that stand out, and the smallest area after each.
static void find_peaks(material_map *map) {
    const double *area = map->area;
    int low = 1, high = 1;
    bool rising = true;
    for (int t = 1; t <= map->last && map->peak_count < MAXIMUM; t++) {
        if (area[t] < area[low]) low = t;
        if (area[t] > area[high]) high = t;
        if (rising && area[t] * PEAK < area[high]) {
            map->peaks[map->peak_count] = high;
            map->valleys[map->peak_count++] = low = t;
            rising = false;
        } else if (!rising && area[t] > PEAK * area[low]) {
            map->valleys[map->peak_count - 1] = low;
            high = t;
            rising = true;
        }
    }
    if (!rising && map->peak_count) map->valleys[map->peak_count - 1] = low;
    if (rising && map->peak_count < MAXIMUM && area[high] > PEAK * area[low] && high > low) {
        map->peaks[map->peak_count] = high;
        map->valleys[map->peak_count++] = map->last;
    }
}

/// How fast the area falls, as a share of itself per bin.
static double fall_at(const material_map *map, int t) {
    const double before = map->area[t - 1], after = map->area[t + 1];
    return before + after > 0 ? (before - after) / (before + after) : 0;
}

/// Where the area stops falling after a peak, before threshold `end`; at = 0: nowhere.
static boundary find_boundary(const material_map *map, int peak, int end) {
    boundary made = {.mode = peak};
    int slowest = 0;
    for (int t = peak + 1 > 2 ? peak + 1 : 2; t < end && t + 1 < BINS; t++) {
        const double fall = fall_at(map, t);
        if (fall > made.fall) {
            made.fall = fall;
            slowest = 0;
        }
        if (made.fall < FLAT) continue;
        if (!slowest || fall < fall_at(map, slowest)) slowest = t;
        const double minimum = fall_at(map, slowest);
        if (fall <= SLOW * made.fall && map->area[t] <= SETTLED * map->area[peak])
            made.at = t;
        else if (minimum <= SHOULDER * made.fall && fall >= AGAIN * minimum && fall > NEARLY_FLAT &&
                 map->area[slowest] <= DOWN * map->area[peak])
            made.at = slowest;
        if (made.at) return made;
    }
    return made;
}

/// Faces per voxel of what is above a threshold.
static double specks_at(const material_map *map, int t) {
    return map->area[t] / fmax(map->surfaces.above[t], 1);
}

static void add_boundary(material_map *map, boundary made) {
    if (made.at > 0 && map->found_count < MAXIMUM && specks_at(map, made.at) <= SPECKS &&
        (made.at == 1 || map->surfaces.above[made.at] > CLASS_SHARE * map->surfaces.count))
        map->found[map->found_count++] = made;
}

static void find_materials(material_map *map) {
    smooth(map->surfaces.area, map->area);
    find_peaks(map);
    add_boundary(map, (boundary){.at = 1}); // above constant values
    for (int i = 0; i < map->peak_count; i++) {
        const bool is_last = i + 1 == map->peak_count;
        boundary made = find_boundary(map, map->peaks[i], is_last ? map->last : map->peaks[i + 1]);
        if (!made.at && !is_last) made.at = map->valleys[i];
        add_boundary(map, made);
    }
}

/// The threshold in (first, last] from which on the upper of two classes begins; the last where there is
/// none.
static int split(const material_map *map, int first) {
    const double *counts = map->surfaces.counts;
    double all = 0, moment = 0, below = 0, below_moment = 0, best = -1;
    for (int i = first; i <= map->last; i++) {
        all += counts[i];
        moment += counts[i] * i;
    }
    int at = first < map->last ? first + 1 : map->last;
    for (int i = first; i < map->last; i++) {
        below += counts[i];
        below_moment += counts[i] * i;
        const double above = all - below;
        if (!(below > 0) || !(above > 0)) continue;
        const double difference = below_moment / below - (moment - below_moment) / above;
        const double between = below * above * difference * difference;
        if (between > best) {
            best = between;
            at = i + 1;
        }
    }
    return at;
}

/// The mean bin of the voxels in [first, end).
static double mean_bin(const material_map *map, int first, int end) {
    double sum = 0, count = 0;
    for (int i = first; i < end; i++) {
        sum += map->surfaces.counts[i] * i;
        count += map->surfaces.counts[i];
    }
    return count > 0 ? sum / count : first;
}

/// Finds what is outside, and lists the classes above it.
static void list_classes(const material_map *map, class_list *list) {
    const ewa_volume_surfaces *s = &map->surfaces;
    *list = (class_list){.natural = false};
    int first = 0;
    while (first < map->found_count && s->borders[map->found[first].at] > BORDER_SHARE * s->border_count)
        first++;
    if (first == map->found_count) { // matter up to the faces of the box
        list->edges[list->count++] = (boundary){.at = split(map, 0)};
        return;
    }
    const boundary *found = map->found + first, *next = found + 1;
    if (found->mode == 0 && first + 1 < map->found_count) {
        const double padding = mean_bin(map, 0, found->at), dense = mean_bin(map, next->at, BINS);
        if (next->mode - padding < AIR_RATIO * (dense - padding)) first++;
    }
    for (; first < map->found_count; first++) list->edges[list->count++] = map->found[first];
    list->natural = list->count > 1;
}

static void cut_in_two(const material_map *map, class_list *list) {
    if (list->count > 1) return;
    list->edges[list->count++] = (boundary){.at = split(map, list->edges[0].at)};
}

/// Where class `index` begins to show and where it is all there.
static void find_ramp(const material_map *map, const class_list *list, int index, double *start,
                      double *full) {
    const boundary *edge = &list->edges[index];
    const int limit = index + 1 < list->count ? edge[1].at : map->last;
    int middle = limit;
    for (int i = map->peak_count - 1; i >= 0 && list->natural; i--)
        if (map->peaks[i] > edge->at && map->peaks[i] <= limit) middle = map->peaks[i];
    *full = 0.5 * (edge->at + middle);
    *start = edge->at;
    if (edge->fall > 0)
        *start += NOISE_LENGTHS / edge->fall;
    else if (!list->natural && index == 0)
        *start += HAZE_SHARE * (limit - edge->at);
    *start = fmin(*start, edge->at + NOISE_SHARE * (*full - edge->at));
}

/// What class `inner` looks like behind the lowest.
static ewa_status look_at(const ewa_volume *volume, const material_map *map, const class_list *list,
                          int inner, ewa_volume_sight *sight) {
    double start, full, outer;
    find_ramp(map, list, 0, &start, &outer);
    find_ramp(map, list, inner, &start, &full);
    return ewa_volume_sight_measure(
        volume, ewa_surfaces_value(&map->surfaces, outer),
        ewa_surfaces_value(&map->surfaces, list->natural ? full : list->edges[inner].at), sight);
}

/// Leaves out containers: classes that stand, with a gap behind, in front of most of what is denser.
static ewa_status open_containers(const ewa_volume *volume, const material_map *map, class_list *list) {
    for (int inner = 1; list->natural && inner < list->count;) {
        ewa_volume_sight sight;
        EWA_TRY(look_at(volume, map, list, inner, &sight));
        const bool content = map->surfaces.above[list->edges[inner].at] > CONTENT_SHARE * map->surfaces.count;
        if (content && sight.hidden > CONTAINER_SHARE && sight.separated > CONTAINER_SHARE) {
            list->count -= inner;
            memmove(list->edges, list->edges + inner, (size_t)list->count * sizeof *list->edges);
            list->natural = list->count > 1;
            list->opened++;
            inner = 1;
        } else {
            inner++;
        }
    }
    cut_in_two(map, list);
    return look_at(volume, map, list, 1, &list->sight);
}

/// The extinction per unit length of the lowest class.
static double lowest_extinction(const material_map *map, const ewa_volume_facts *facts,
                                const class_list *list) {
    const ewa_volume_surfaces *s = &map->surfaces;
    const double volume = s->above[list->edges[0].at] - s->above[list->edges[1].at];
    // A mean chord is 4 V / A, and faces of voxels have 1.5 times the area of the surface that they stand
    // for. Where matter is full of holes, lines of sight pass more of it than a chord.
    const double chord_voxels = 6 * volume / fmax(map->area[list->edges[0].at], 1);
    const double path_voxels = fmax(chord_voxels, list->sight.passed), hidden = list->sight.hidden,
                 open = 1 - hidden;
    if (!(chord_voxels > 0)) return SOLID;
    const double *step = facts->spacing_world, step_world = 3 / (1 / step[0] + 1 / step[1] + 1 / step[2]);
    const double per_voxel =
        OPEN_DEPTH * open * open / chord_voxels + TRANSLUCENT_DEPTH * hidden / path_voxels;
    return fmin(fmax(per_voxel * ewa_transfer_unit(facts) / step_world, MINIMUM), SOLID);
}

/// Adds a point that looks like the last one.
static void repeat_point(ewa_transfer *transfer, double value) {
    ewa_transfer_point *point = &transfer->points[transfer->point_count++];
    *point = point[-1];
    point->value = fmax(value, point[-1].value);
}

static void add_points(const material_map *map, const ewa_volume_facts *facts, const class_list *list,
                       ewa_transfer *transfer) {
    const int count = list->count < MAX_CLASSES ? list->count : MAX_CLASSES;
    const double lowest = lowest_extinction(map, facts, list);
    for (int i = 0; i < count; i++) {
        const uint32_t color = i == 0 ? TRANSLUCENT_COLOR : i + 1 < count ? BODY_COLOR : SOLID_COLOR;
        const double extinction = i == 0 ? lowest : i + 1 < count ? sqrt(lowest * SOLID) : SOLID;
        double start, full;
        find_ramp(map, list, i, &start, &full);
        const double from = ewa_surfaces_value(&map->surfaces, start);
        if (i == 0)
            ewa_transfer_add(transfer, from, color, 0);
        else if (list->natural) // the class below as it is, up to where this one begins
            repeat_point(transfer, from);
        else
            ewa_transfer_add(transfer, from, BODY_COLOR, sqrt(lowest * SOLID));
        // A class of very many values keeps its differences.
        const bool wide = list->natural && i + 1 == count && map->last - full > BINS / 2;
        ewa_transfer_add(transfer, ewa_surfaces_value(&map->surfaces, full), wide ? BODY_COLOR : color,
                         extinction);
        if (wide) ewa_transfer_add(transfer, map->surfaces.high, color, extinction);
    }
    // What is above the last point looks like it.
    repeat_point(transfer, facts->high);
}

/// The look of a scan.
static ewa_status make_scan(const ewa_volume *volume, const ewa_volume_facts *facts, material_map *map,
                            ewa_transfer *transfer) {
    class_list list;
    find_materials(map);
    list_classes(map, &list);
    EWA_TRY(open_containers(volume, map, &list));
    *transfer = (ewa_transfer){.unit_length_world = ewa_transfer_unit(facts)};
    add_points(map, facts, &list, transfer);
    const double seen = transfer->points[0].value;
    if (list.opened)
        ewa_report(volume->context, EWA_SEVERITY_INFO,
                   "values below %g are left out: surroundings, and what stands around all that is denser",
                   seen);
    else
        ewa_report(volume->context, EWA_SEVERITY_INFO, "values below %g are left out: surroundings", seen);
    return EWA_OK;
}

ewa_status ewa_transfer_automatic(const ewa_volume *volume, const ewa_volume_facts *facts,
                                  ewa_transfer *transfer) {
    if (!volume || !volume->voxels || !facts || !transfer) return EWA_ERROR_ARGUMENT;
    EWA_TRY(ewa_transfer_check_facts(volume, facts));
    ewa_context *context = volume->context;
    material_map map = {.last = BINS - 1};
    ewa_volume_surfaces_measure(volume, facts, &map.surfaces);
    ewa_volume_labels labels;
    switch (ewa_volume_find_kind(volume, facts, &map.surfaces, &labels)) {
    case EWA_KIND_LABELS:
        ewa_report(context, EWA_SEVERITY_INFO, "%u labels: a colour each, %g is left out", labels.count - 1,
                   (double)labels.codes[labels.surrounding]);
        return ewa_transfer_labels(volume, facts, &labels, transfer);
    case EWA_KIND_PICTURE:
        ewa_report(context, EWA_SEVERITY_INFO, "one slice: a picture, black at %g, white at %g",
                   map.surfaces.low, map.surfaces.high);
        ewa_transfer_picture(facts, &map.surfaces, transfer);
        return EWA_OK;
    case EWA_KIND_NOISE:
        ewa_report(context, EWA_SEVERITY_WARNING,
                   "neighbouring voxels have nothing in common: noise, or numbers of other sizes or of "
                   "another type");
        ewa_transfer_noise(facts, transfer);
        return EWA_OK;
    case EWA_KIND_FIELD:
        ewa_transfer_field(facts, &map.surfaces, transfer);
        ewa_report(context, EWA_SEVERITY_INFO,
                   "values change gradually: shells, the outermost at %g, a core from %g on",
                   transfer->points[1].value, transfer->points[transfer->point_count - 2].value);
        return EWA_OK;
    default:
        return make_scan(volume, facts, &map, transfer);
    }
}
