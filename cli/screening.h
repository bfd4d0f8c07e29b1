// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a file of points turns out to be that its suffix does not say: Gaussians, normals that are none,
// floats too coarse for their coordinates, degrees.
#ifndef EWA_CLI_SCREENING_H
#define EWA_CLI_SCREENING_H

#include "session.h"

/// A scene of Gaussian splatting, by the attributes that its training programs write.
typedef struct gaussian_facts {
    uint32_t dimensions; ///< 3, or 2 for flat ones; 0: the cloud holds none
    uint32_t sh_degree;  ///< of the colours' spherical harmonics
    bool filtered;       ///< with a 3D filter for each (Mip-Splatting)
} gaussian_facts;

gaussian_facts screening_find_gaussians(const ewa_cloud *cloud);

/// Writes what a scene is, such as "3D Gaussians, spherical harmonics of degree 3".
void screening_describe_gaussians(const gaussian_facts *facts, size_t text_bytes, char *text);

/// Gives the centres of Gaussians that have no colours those that no direction changes. False after reporting.
bool screening_color_gaussians(cli_session *session, ewa_cloud *cloud);

/// Whether a cloud without radii may be made into surfels: false after reporting that it holds Gaussians.
bool screening_admit(cli_session *session, const char *path, const ewa_cloud *cloud);

/// Removes the normals when all are zero, which some programs write for none; says so.
void screening_drop_zero_normals(cli_session *session, const char *path, ewa_cloud *cloud);

/// Whether coordinates are longitudes and latitudes in degrees, by the cloud's coordinate reference system or by
/// how small its extent is beside its heights; writes what that means, and what helps, to `text`.
bool screening_find_degrees(const ewa_cloud *cloud, size_t text_bytes, char *text);

/// Warns of coordinates in degrees.
void screening_check_degrees(cli_session *session, const char *path, const ewa_cloud *cloud);

/// Warns when the steps of float coordinates are not small beside the distances of the points.
void screening_check_steps(cli_session *session, const char *path, const ewa_cloud *cloud);

#endif
