// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A textured plane, magnified: pictures with plain and with refitted colours against the texture itself.
#ifndef EWA_TESTS_REFIT_SCENE_H
#define EWA_TESTS_REFIT_SCENE_H

#include "ewa/ewa.h"

/// One case. The plane is 2 wide, the picture shows the middle 1.6 of it.
typedef struct refit_setting {
    ewa_procedure texture;
    double frequency; ///< features per unit
    uint32_t point_count;
    double jitter;       ///< of the points, [0, 1]
    double radius_scale; ///< support radius in spacings
    double noise;        ///< standard deviation of errors in the colours, linear
} refit_setting;

enum { REFIT_PLAIN = -1 }; ///< beside the values of ewa_refit

/// Peak signal to noise ratio in dB of the linear green channel of a picture against the texture under the
/// pixels' filter, or -1 when a call fails. `goal` is an ewa_refit or REFIT_PLAIN; `report` may be NULL.
double refit_scene_psnr(ewa_context *context, const refit_setting *setting, int goal,
                        ewa_refit_report *report);

#endif
