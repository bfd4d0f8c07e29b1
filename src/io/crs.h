// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What coordinate reference systems of clouds count in: their notes "crs" and "crs_unit".
#ifndef EWA_SRC_CRS_H
#define EWA_SRC_CRS_H

#include "ewa/cloud.h"

/// What coordinates count.
typedef enum ewa_crs_unit {
    EWA_CRS_UNKNOWN = 0, ///< nothing says it, another length, or heights in another one than x and y, but for two kinds of feet
    EWA_CRS_DEGREES = 1, ///< of longitude and latitude
    EWA_CRS_METRES = 2,
    EWA_CRS_FEET = 3,    ///< 0.3048 m
    EWA_CRS_US_FEET = 4, ///< 1200 / 3937 m
} ewa_crs_unit;

/// Says what a cloud's coordinates count. Source: OGC 01-009, section 7; OGC 18-010r7, "WKT-CRS 2". Any thread.
ewa_crs_unit ewa_cloud_crs_unit(const ewa_cloud *cloud);

/// Returns the name of a unit of length: "m", "ft", "US ft"; NULL: it is none.
const char *ewa_crs_unit_name(ewa_crs_unit unit);

/// Returns the unit of an EPSG code, as keys of GeoTIFF name it.
ewa_crs_unit ewa_crs_unit_of_code(uint32_t code);

#endif
