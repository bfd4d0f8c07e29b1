// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The back ends of this room.
#ifndef EWA_SRC_GL_BACKENDS_H
#define EWA_SRC_GL_BACKENDS_H

#include "ewa/gaussian_render.h"
#include "ewa/gpu.h"
#include "ewa/volume_render.h"
#include "surface/backend.h"

/// Compute programs of OpenGL 4.3.
extern const ewa_backend ewa_backend_gl;

/// The pipeline of "Perspective Accurate Splatting" by OpenGL 3.3.
extern const ewa_backend ewa_backend_gl_raster;

/// The processor, and compute programs where they are faster.
extern const ewa_backend ewa_backend_auto;

/// Lets the device of a renderer of surfaces, which is destroyed later, draw Gaussians where it can; that of EWA_BACKEND_AUTO by the
/// same rule. Of other renderers nothing happens. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_gl_gaussians_attach(ewa_context *context, ewa_renderer *surfaces, ewa_gaussian_renderer *gaussians);

/// The same of volumes.
ewa_status ewa_gl_volume_attach(ewa_context *context, ewa_renderer *surfaces, ewa_volume_renderer *volumes);

/// Sets what the device is, of an info of zeros but for the size. Errors: those of ewa_gpu_describe().
ewa_status ewa_gpu_find(ewa_context *context, ewa_gpu_info *info);

#endif
