// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Renderers on graphics processors, and what devices there are (docs/gpu.md).
#ifndef EWA_GPU_H
#define EWA_GPU_H

#include "ewa/render.h"

#ifdef __cplusplus
extern "C" {
#endif

/// What draws the frames of a renderer.
typedef enum ewa_backend_kind {
    EWA_BACKEND_CPU,       ///< threads and vectors of the processor
    EWA_BACKEND_GL,        ///< compute programs of OpenGL 4.3: the same bytes on a device that is exact
    EWA_BACKEND_GL_RASTER, ///< the pipeline of "Perspective Accurate Splatting" by OpenGL 3.3: close to it
    EWA_BACKEND_AUTO,      ///< the faster of CPU and GL, where that is exact and no software
} ewa_backend_kind;

/// Makes a renderer with a back end; ewa_renderer_create() makes one for the CPU. Every call of ewa/render.h takes it. Frames
/// of EWA_BACKEND_GL and EWA_BACKEND_GL_RASTER fail where the device cannot draw them, those of EWA_BACKEND_AUTO
/// are then drawn by the CPU, and a warning says why. The caller destroys it. Errors: EWA_ERROR_ARGUMENT,
/// EWA_ERROR_MEMORY, EWA_ERROR_UNSUPPORTED (no such device; a library without OpenGL; not for EWA_BACKEND_AUTO).
EWA_API ewa_status ewa_renderer_create_on(ewa_context *context, ewa_backend_kind kind,
                                          ewa_renderer **renderer);

#ifdef __cplusplus
}
#endif
#endif
