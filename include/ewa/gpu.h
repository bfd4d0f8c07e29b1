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
/// are then drawn by the CPU, and a warning says why. Gaussians and volumes of a scene that the device does not draw are always
/// drawn by the CPU (ewa_scene_renderer_describe()). The caller destroys it. Errors: EWA_ERROR_ARGUMENT,
/// EWA_ERROR_MEMORY, EWA_ERROR_UNSUPPORTED (no such device; a library without OpenGL; not for EWA_BACKEND_AUTO).
EWA_API ewa_status ewa_renderer_create_on(ewa_context *context, ewa_backend_kind kind,
                                          ewa_renderer **renderer);

/// How a device calculates, by what it gives for numbers that are hard to round.
typedef enum ewa_gpu_class {
    EWA_GPU_NONE,     ///< no device, or the processor
    EWA_GPU_UNUSABLE, ///< too old or too small for EWA_BACKEND_GL, or its driver does not compile the programs
    EWA_GPU_CLOSE,    ///< draws, but some operations round otherwise: pictures differ in last places
    EWA_GPU_EXACT     ///< every operation gives the bits of the processor: pictures are the same bytes
} ewa_gpu_class;

/// Returns the word for a class: "none", "unusable", "close", "exact".
EWA_API const char *ewa_gpu_class_name(ewa_gpu_class device_class);

/// What a device is and can. Texts end with a zero and are cut where they are longer.
typedef struct ewa_gpu_info {
    size_t struct_size; ///< sizeof(ewa_gpu_info) of the caller, who sets it
    char vendor[128], renderer[128], version[128];
    bool software; ///< the processor does the device's work
    ewa_gpu_class device_class;
    char differs[64];       ///< of a close device: the first operation that gives other bits; else ""
    bool native_fma;        ///< its own fma() is used; false: a few more operations do its work
    bool native_division;   ///< its own division
    bool native_root;       ///< its own square root
    uint64_t storage_bytes; ///< of a buffer that programs see, at most; 0: no compute programs
    uint32_t storage_count; ///< of such buffers at a time
    uint32_t group_threads; ///< of a work group, at most
    uint32_t texture_px;    ///< side of a picture that can be drawn into, at most
    /// All devices that there are, a line each: the number by which the environment takes it (EWA_GL_DEVICE), its name, or why it
    /// cannot be opened.
    char devices[1024];
    bool subnormals;        ///< it has numbers below 1.2e-38; false: they are 0
} ewa_gpu_info;

/// Opens the device that EWA_BACKEND_GL would draw with, tries how it calculates, and closes it. Takes tenths of a second.
/// Errors: EWA_ERROR_ARGUMENT (struct_size), EWA_ERROR_MEMORY, EWA_ERROR_UNSUPPORTED (no device, the message names what to
/// install; a library without OpenGL).
EWA_API ewa_status ewa_gpu_describe(ewa_context *context, ewa_gpu_info *info);

/// What draws the frames of a renderer. Of EWA_BACKEND_GL the stage times of ewa_render_stats are the device's, where it has a
/// clock.
typedef struct ewa_renderer_info {
    size_t struct_size; ///< sizeof(ewa_renderer_info) of the caller, who sets it
    char backend[16];   ///< "cpu", "gl", "gl-raster"; of EWA_BACKEND_AUTO what drew the last frame
    char device[128];   ///< its name; "" for the CPU
    ewa_gpu_class device_class;
    char remark[160]; ///< of EWA_BACKEND_AUTO: why; that a device is software; else ""
    /// Of the last frame by EWA_BACKEND_GL, else 0: how often the device was waited for and read from, programs that it ran, and
    /// bytes that it was sent.
    uint32_t wait_count, readback_count, dispatch_count;
    uint64_t upload_bytes;
    uint64_t readback_bytes; ///< that were read from it
    /// Of ewa_scene_renderer_describe(): what drew the Gaussians and volumes of the last picture, "cpu" or "gl", else "". Where it was the
    /// device, the counts above are theirs.
    char mixture[16];
    char mixture_remark[160]; ///< of EWA_BACKEND_GL and EWA_BACKEND_AUTO: why; else ""
} ewa_renderer_info;

/// Describes a renderer. Errors: EWA_ERROR_ARGUMENT (struct_size).
EWA_API ewa_status ewa_renderer_describe(const ewa_renderer *renderer, ewa_renderer_info *info);

#ifdef __cplusplus
}
#endif
#endif
