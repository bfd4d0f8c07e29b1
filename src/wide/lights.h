// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What kernels are told of a light.
#ifndef EWA_SRC_WIDE_LIGHTS_H
#define EWA_SRC_WIDE_LIGHTS_H

#include <stdbool.h>

/// A light in the space that the kernel shades in.
typedef struct ewa_kernel_light {
    bool headlight;  ///< from the eye: no direction of its own but in orthographic views
    float toward[3]; ///< unit
    float color[3];
} ewa_kernel_light;

#endif
