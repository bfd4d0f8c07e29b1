// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Transfer functions: checks, opacity, and one from the histogram alone.
// Based on: N. Otsu, "A Threshold Selection Method from Gray-Level Histograms", 1979, equation 12 (what
// separates the classes).
#include "image/transfer.h"
#include "base/base.h"
#include "ewa/image.h"

#include <math.h>

enum { BINS = 256, SMOOTH = 3, UNITS = 128 };

/// Count, as a share of the empty peak's, below which that peak has ended.
static const double PEAK_END = 0.01;

/// Optical depth that the veil and what is inside of it should have along a ray that goes through its share
/// of the volume; the least extinction per unit that this may lead to, the greatest of a veil (a thin haze is
/// noise), and that of solid matter.
static const double VEIL_DEPTH = 0.5, BODY_DEPTH = 4, LEAST = 0.002, THICK = 0.05, SOLID = 0.7;

static const uint32_t VEIL_COLOR = 0xc98a66, BODY_COLOR = 0xe8c9a0, SOLID_COLOR = 0xfff8ec;

double ewa_extinction_of_opacity(double opacity) {
    double left = 1 - opacity;
    if (!(left > 0x1p-20)) left = 0x1p-20;
    int exponent;
    double m = frexp(left, &exponent);
    if (m < 0.7071067811865476) {
        m *= 2;
        exponent--;
    }
    // log m = 2 artanh((m - 1) / (m + 1)), by its series: |s| < 0.172.
    const double s = (m - 1) / (m + 1), ss = s * s;
    double sum = 0;
    for (int k = 21; k >= 1; k -= 2) sum = sum * ss + 1.0 / k;
    return 0 - (2 * s * sum + 0.6931471805599453 * exponent);
}

void ewa_transfer_add(ewa_transfer *transfer, double value, uint32_t srgb, double extinction) {
    ewa_transfer_point *point = &transfer->points[transfer->point_count++];
    point->value = value;
    point->extinction = (float)extinction;
    for (int c = 0; c < 3; c++)
        point->color[c] = ewa_linear_from_srgb((float)(srgb >> (16 - 8 * c) & 255) / 255.0f);
}

double ewa_transfer_unit(const ewa_volume_facts *facts) {
    double longest = 0;
    for (int k = 0; k < 3; k++) longest = fmax(longest, facts->high_world[k] - facts->low_world[k]);
    return longest > 0 ? longest / UNITS : 1;
}

ewa_status ewa_transfer_check_facts(const ewa_volume *volume, const ewa_volume_facts *facts) {
    if (facts->finite_count && facts->low < facts->high) return EWA_OK;
    return facts->finite_count
               ? ewa_fail(volume->context, EWA_ERROR_NUMERIC,
                          "all voxels are %g: there is nothing to tell apart; say what they look like",
                          facts->low)
               : ewa_fail(volume->context, EWA_ERROR_NUMERIC, "no voxel is a finite number");
}

ewa_status ewa_transfer_check(ewa_context *context, const char *name, const ewa_transfer *transfer) {
    if (!context || !name || !transfer) return EWA_ERROR_ARGUMENT;
    if (transfer->point_count < 2 || transfer->point_count > EWA_MAX_TRANSFER_POINTS)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: %u points, allowed are 2 to %d", name,
                        transfer->point_count, EWA_MAX_TRANSFER_POINTS);
    for (uint32_t i = 0; i < transfer->point_count; i++) {
        const ewa_transfer_point *p = &transfer->points[i];
        bool good = isfinite(p->value) && p->extinction >= 0 && isfinite(p->extinction);
        for (int c = 0; c < 3; c++) good &= p->color[c] >= 0 && isfinite(p->color[c]);
        if (!good)
            return ewa_fail(context, EWA_ERROR_ARGUMENT,
                            "%s: point %u: value, colour or extinction negative or not finite", name, i);
        if (i && p->value < p[-1].value)
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: point %u: its value %g is below the one before",
                            name, i, p->value);
    }
    const double low = transfer->gradient_low, high = transfer->gradient_high;
    if (!(transfer->unit_length_world >= 0) || !isfinite(transfer->unit_length_world))
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: a unit length of %g", name,
                        transfer->unit_length_world);
    if (!(low >= 0) || !(high >= low) || !isfinite(high))
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: a gradient ramp from %g to %g", name, low, high);
    return EWA_OK;
}

/// Means over 2 SMOOTH + 1 bins, so that the gaps between the values of integers do not count.
static void smooth(const uint64_t histogram[BINS], double smoothed[BINS]) {
    for (int i = 0; i < BINS; i++) {
        double sum = 0;
        for (int k = -SMOOTH; k <= SMOOTH; k++) {
            // The first and the last bin hold what is cut off: they are nobody's neighbours.
            const int j = i + k;
            if (j >= 1 && j < BINS - 1) sum += (double)histogram[j];
        }
        smoothed[i] = sum / (2 * SMOOTH + 1);
    }
    smoothed[0] = fmax(smoothed[0], (double)histogram[0]);
}

/// The bin where the largest peak has come down: to next to nothing, or to the valley before the next peak.
static int find_empty_end(const double smoothed[BINS]) {
    int peak = 0;
    for (int i = 1; i < BINS / 2; i++)
        if (smoothed[i] > smoothed[peak]) peak = i;
    int at = peak + 1;
    for (; at < BINS - 2 * SMOOTH - 2; at++) {
        bool valley = at > peak + SMOOTH && smoothed[at] > 0;
        for (int k = 1; k <= 2 * SMOOTH; k++) valley &= smoothed[at] <= smoothed[at + k];
        if (valley || smoothed[at] < PEAK_END * smoothed[peak]) break;
    }
    return at;
}

/// The bin in (first, BINS) from which on the upper of two classes begins.
static int split(const uint64_t histogram[BINS], int first) {
    double all = 0, moment = 0, below = 0, below_moment = 0, best = -1;
    for (int i = first; i < BINS; i++) {
        all += (double)histogram[i];
        moment += (double)histogram[i] * i;
    }
    int at = first + 1;
    for (int i = first; i + 1 < BINS; i++) {
        below += (double)histogram[i];
        below_moment += (double)histogram[i] * i;
        const double above = all - below;
        if (!(below > 0) || !(above > 0)) continue;
        const double apart = below_moment / below - (moment - below_moment) / above;
        const double between = below * above * apart * apart;
        if (between > best) {
            best = between;
            at = i + 1;
        }
    }
    return at;
}

/// The extinction per unit with which the bins [first, last) have `depth` along a ray.
static double extinction_for(const ewa_volume_facts *facts, int first, int last, double depth) {
    double count = 0;
    for (int i = first; i < last; i++) count += (double)facts->histogram[i];
    // A ray through the middle of an object meets more of it than a mean one: three times, roughly.
    const double path_units = UNITS * fmin(1, 3 * count / (double)facts->finite_count);
    return path_units > 0 ? fmin(fmax(depth / path_units, LEAST), SOLID) : SOLID;
}

/// The value in the middle of a bin; never beyond the range, whatever is rounded.
static double value_at(const ewa_volume_facts *facts, double bin) {
    return fmin(facts->low + (facts->high - facts->low) * bin / (BINS - 1), facts->high);
}

ewa_status ewa_transfer_automatic(const ewa_volume *volume, const ewa_volume_facts *facts,
                                  ewa_transfer *transfer) {
    if (!volume || !facts || !transfer) return EWA_ERROR_ARGUMENT;
    const ewa_status status = ewa_transfer_check_facts(volume, facts);
    if (status != EWA_OK) return status;
    double smoothed[BINS];
    smooth(facts->histogram, smoothed);
    const int empty = find_empty_end(smoothed);
    const int body = split(facts->histogram, empty), solid = split(facts->histogram, body);
    const double veil = fmin(extinction_for(facts, empty, body, VEIL_DEPTH), THICK),
                 inner = fmax(extinction_for(facts, body, solid, BODY_DEPTH), veil);
    *transfer = (ewa_transfer){.unit_length_world = ewa_transfer_unit(facts)};
    const double edge = 0.5 * (empty + body), middle = 0.5 * (body + solid), top = 0.5 * (solid + BINS - 1);
    ewa_transfer_add(transfer, value_at(facts, empty), VEIL_COLOR, 0);
    ewa_transfer_add(transfer, value_at(facts, edge), VEIL_COLOR, veil);
    ewa_transfer_add(transfer, value_at(facts, middle), BODY_COLOR, inner);
    ewa_transfer_add(transfer, value_at(facts, top), SOLID_COLOR, fmax(SOLID, inner));
    ewa_transfer_add(transfer, facts->high, SOLID_COLOR, fmax(SOLID, inner));
    return EWA_OK;
}
