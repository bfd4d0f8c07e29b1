// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cameras, the inner side: what is wrong with one, for whoever reports it with more context.
#ifndef EWA_SRC_HOMOGENEOUS_CAMERA_H
#define EWA_SRC_HOMOGENEOUS_CAMERA_H

#include "ewa/camera.h"

enum { EWA_CAMERA_PROBLEM_BYTES = 160, EWA_CAMERA_MAX_SIDE_PX = 65536 };

/// Looks for what ewa_camera_check() refuses; returns true and says what it is, naming the member.
bool ewa_camera_find_problem(const ewa_camera *camera, char text[EWA_CAMERA_PROBLEM_BYTES]);

#endif
