// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What points turn out to be that nothing says: the columns of Gaussians, normals that are none, floats too coarse for
// their coordinates, degrees, numbers that are none.
#ifndef EWA_DIAGNOSIS_H
#define EWA_DIAGNOSIS_H

#include "ewa/base.h"
#include "ewa/cloud.h"
#include "ewa/render.h"

#ifdef __cplusplus
extern "C" {
#endif

/// The columns of a scene of Gaussian splatting among a cloud's attributes.
typedef struct ewa_gaussian_columns {
    uint32_t dimensions; ///< 3, or 2 for flat ones; 0: there are none
    uint32_t sh_degree;  ///< of the colours' spherical harmonics
    bool filtered;       ///< with a 3D filter for each (Mip-Splatting)
} ewa_gaussian_columns;

enum { EWA_DIAGNOSIS_TEXT_BYTES = 400 };

/// Finds the columns that training programs write. Any thread.
EWA_API ewa_gaussian_columns ewa_cloud_find_gaussians(const ewa_cloud *cloud);

/// Writes what they are, such as "3D Gaussians, spherical harmonics of degree 3". Any thread.
EWA_API void ewa_gaussian_columns_describe(const ewa_gaussian_columns *columns,
                                           char text[EWA_DIAGNOSIS_TEXT_BYTES]);

/// Refuses the columns of Gaussians without normals and radii, which would be drawn as something else. Errors:
/// EWA_ERROR_UNSUPPORTED.
EWA_API ewa_status ewa_cloud_refuse_gaussians(const ewa_cloud *cloud);

/// Whether coordinates are longitudes and latitudes in degrees, by the cloud's coordinate reference system or by how
/// small its extent is beside its heights; writes what that means, and what helps. Any thread.
EWA_API bool ewa_cloud_find_degrees(const ewa_cloud *cloud, char text[EWA_DIAGNOSIS_TEXT_BYTES]);

/// Warns of coordinates in degrees.
EWA_API void ewa_cloud_check_degrees(const ewa_cloud *cloud);

/// Warns when the steps of float coordinates are not small beside the distances of the points.
EWA_API void ewa_cloud_check_steps(const ewa_cloud *cloud);

/// Removes the normals when all are zero or not finite, which some programs write for none; a note says so.
EWA_API void ewa_cloud_drop_zero_normals(ewa_cloud *cloud);

/// Points by what is wrong with them, each under the first that applies; colours for themselves.
typedef struct ewa_cloud_invalid_points {
    uint64_t position_count; ///< coordinates not finite
    uint64_t normal_count;   ///< normal zero or not finite
    uint64_t radius_count;   ///< radius zero, negative or not finite
    uint64_t axis_count;     ///< tangent axis zero or not finite
    uint64_t color_count;    ///< colour not finite
} ewa_cloud_invalid_points;

/// Counts the invalid points of a cloud. Any thread.
EWA_API void ewa_cloud_count_invalid_points(const ewa_cloud *cloud, ewa_cloud_invalid_points *counts);

/// Warns which points of a cloud are left out of its surfels and why, which colours are not the file's, and of float colours that are more
/// than white in the mean, as those that count to 255 are. Errors: EWA_ERROR_FORMAT (none can be drawn).
EWA_API ewa_status ewa_cloud_report_invalid_points(const ewa_cloud *cloud, const ewa_surfels_info *surfels);

#ifdef __cplusplus
}
#endif
#endif
