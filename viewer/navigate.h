// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How cameras move: functions of a camera alone, which keep what the hand holds under the hand.
#ifndef EWA_VIEWER_NAVIGATE_H
#define EWA_VIEWER_NAVIGATE_H

#include "ewa/ewa.h"

/// Gives the pixel and the depth (camera-space z) of a point; false: it is not in front of a perspective
/// camera.
bool navigate_project(const ewa_camera *camera, const double point_world[3], double place_px[2],
                      double *depth);

/// Gives the point at a depth behind a place of the picture.
void navigate_unproject(const ewa_camera *camera, double x_px, double y_px, double depth,
                        double point_world[3]);

/// Returns the depth (camera-space z) of a point.
double navigate_depth(const ewa_camera *camera, const double point_world[3]);

/// Carries the camera about a pivot so that what is in front of the pivot follows the hand: by `right_deg`
/// about `up_world`, then by `down_deg` about the picture's horizontal, never over the poles. `up_world` NULL:
/// about the picture's own axes, without end (a trackball).
void navigate_orbit(ewa_camera *camera, const double pivot_world[3], const double *up_world, double right_deg,
                    double down_deg);

/// Turns the camera about its eye; as navigate_orbit() else.
void navigate_look(ewa_camera *camera, const double up_world[3], double right_deg, double down_deg);

/// Moves the camera across the picture so that a point at `depth` follows the hand by so many pixels.
void navigate_pan(ewa_camera *camera, double depth, double x_px, double y_px);

/// Multiplies the distance to a point by `factor`, which stays where it is in the picture; an orthographic
/// camera's scale instead.
void navigate_zoom(ewa_camera *camera, const double point_world[3], double factor);

/// Moves the camera along its own axes (right, down, ahead), world units.
void navigate_move(ewa_camera *camera, const double by[3]);

/// Moves the camera across the picture so that a point comes into the middle of the picture, at its depth.
void navigate_center(ewa_camera *camera, const double point_world[3]);

/// Makes the camera orthographic or perspective (with `fov_deg` vertically) so that what is at a point keeps
/// its size.
void navigate_set_ortho(ewa_camera *camera, bool ortho, const double point_world[3], double fov_deg);

#endif
