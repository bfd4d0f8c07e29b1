// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The back ends of this room.
#ifndef EWA_SRC_GL_BACKENDS_H
#define EWA_SRC_GL_BACKENDS_H

#include "surface/backend.h"

/// Compute programs of OpenGL 4.3.
extern const ewa_backend ewa_backend_gl;

/// The pipeline of "Perspective Accurate Splatting" by OpenGL 3.3.
extern const ewa_backend ewa_backend_gl_raster;

#endif
