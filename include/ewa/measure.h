// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Measurements between places: distances along a line, heights, angles, areas; and notes at one.
#ifndef EWA_MEASURE_H
#define EWA_MEASURE_H

#include "ewa/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/// What is measured.
typedef enum ewa_measure_kind {
    EWA_MEASURE_DISTANCE = 0, ///< from place to place: 2 or more
    EWA_MEASURE_HEIGHT = 1,   ///< of the second place above the first
    EWA_MEASURE_ANGLE = 2,    ///< at the second of three places
    EWA_MEASURE_AREA = 3,     ///< within 3 or more places
    EWA_MEASURE_NOTE = 4,     ///< nothing: its name is a text at 1 place
} ewa_measure_kind;

/// Returns "distance", "height", "angle", "area" or "note"; NULL beyond the last. Any thread.
EWA_API const char *ewa_measure_kind_name(uint32_t kind);

enum {
    EWA_MEASURE_PLACES = 64, ///< that a measurement of a scene has at most
    EWA_MAX_MEASURES = 64,   ///< that a scene has
    EWA_MEASURE_NAME_BYTES = 64,
};

/// A measurement with a name, as scenes and scene files have it.
typedef struct ewa_measure {
    ewa_measure_kind kind;
    char name[EWA_MEASURE_NAME_BYTES]; ///< UTF-8
    uint32_t count;                    ///< of places
    double places_world[3 * EWA_MEASURE_PLACES];
} ewa_measure;

/// What places are apart. World units, squares of them, degrees.
typedef struct ewa_measurement {
    double length_world;     ///< of the line from place to place; of an area, around it
    double horizontal_world; ///< the same, seen from above
    double rise_world;       ///< of the last place above the first
    double slope_deg;        ///< of the way from the first place to the last, [-90, 90]
    double angle_deg;        ///< at the second of three places, [0, 180]; else 0
    double area;             ///< within the places, of the plane in which it is largest; 0 of fewer than three
    double horizontal_area;  ///< the same, seen from above
} ewa_measurement;

/// Measures `count` places, 3 numbers each in `places_world`, world units, of which differences count alone. `up_world`: what is up,
/// any length but 0. Fills `*measured`, with zeros after a failure. Any thread. Errors: EWA_ERROR_ARGUMENT (fewer places than the
/// kind has, or more; numbers that are not finite; no up).
EWA_API ewa_status ewa_places_measure(ewa_measure_kind kind, const double *places_world, uint32_t count,
                                      const double up_world[3], ewa_measurement *measured);

#ifdef __cplusplus
}
#endif
#endif
