// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Rates of a device, by its own clock (GL_TIME_ELAPSED) where it has one.
#ifndef EWA_TOOLS_GPU_PROBE_RATES_H
#define EWA_TOOLS_GPU_PROBE_RATES_H

#include "gl/memory.h"
#include "gl/variant.h"

enum { PROBE_WIDTH_PX = 1280, PROBE_HEIGHT_PX = 1024, PROBE_SPLAT_PX = 5 };

/// A way to add splats up.
typedef enum probe_way { PROBE_GATHER, PROBE_SHARED_ATOMICS, PROBE_GLOBAL_ATOMICS, PROBE_WAYS } probe_way;

/// What was measured; 0: it could not be.
typedef struct probe_rates {
    uint32_t splat_count;                ///< of PROBE_SPLAT_PX squared pixels
    double fma_tflops;                   ///< two operations each
    double way_ms[PROBE_WAYS];           ///< of seven sums of whole numbers per pixel
    bool ways_agree;                     ///< all have the same sums
    double blend32_gpx_s, blend16_gpx_s; ///< additions of four numbers to RGBA32F and RGBA16F
    double readback_ms, readback_mb;     ///< of a buffer, by the wall
    double wait_ms, dispatch_ms;         ///< for one dispatch, by the wall; of many that do nothing, each
    double upload_ms, clear_ms;          ///< of a picture of 4 bytes a pixel
    double compile_ms;                   ///< of the set-up program, by the wall
    double double_tflops;                ///< as fma_tflops, in double precision
    uint32_t pass_splat_count, pass_width_px, pass_height_px; ///< of the frame whose passes were measured
    double pass_ms[EWA_GL_PASSES];       ///< of each pass; 0: the device has no clock
} probe_rates;

/// Something that is measured.
typedef void probe_work(void *user);

/// Returns the shortest time in seconds of a few runs after one that warms up.
double probe_time(ewa_gl *device, probe_work *work, void *user);

/// Measures all; the device is entered, and has compute programs. Errors: EWA_ERROR_MEMORY, EWA_ERROR_UNSUPPORTED.
ewa_status probe_measure(ewa_gl *device, probe_rates *rates);

/// Measures what a frame pays beside its work, with a buffer for two pictures. Errors: as probe_measure().
ewa_status probe_latencies(ewa_gl *device, const ewa_gl_buffer *buffer, probe_rates *rates);

/// Measures the passes of a frame; the device is not entered. Errors: those of ewa_renderer_create_on() and ewa_render().
ewa_status probe_passes(ewa_context *context, bool software, probe_rates *rates);

/// Measures blending into floats of `bits`, in billions of pixels per second. Errors: as probe_measure().
ewa_status probe_blending(ewa_gl *device, int bits, uint32_t splat_count, double *gpx_s);

#endif
