// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the options say about light, in the form that both renderers start from.
#ifndef EWA_SRC_SURFACE_SHADING_H
#define EWA_SRC_SURFACE_SHADING_H

#include "ewa/render.h"
#include "homogeneous/vec.h"

/// A light of a picture.
typedef struct ewa_shading_light {
    bool headlight;
    ewa_vec3 toward_world; ///< unit; of headlights zero
    double color[3];
} ewa_shading_light;

/// Lights and materials of a picture, defaults filled in.
typedef struct ewa_shading_setup {
    bool lit;        ///< normals are needed
    bool highlights; ///< specular, and reflection when there is an environment
    uint32_t light_count;
    ewa_shading_light lights[EWA_MAX_LIGHTS];
    bool has_table;          ///< else the one material is everybody's
    uint32_t material_count; ///< 1 or more
    ewa_material materials[EWA_MAX_MATERIALS];
    ewa_mat3 environment_from_world;
} ewa_shading_setup;

/// Fills the setup from checked options.
void ewa_shading_setup_make(const ewa_render_options *options, ewa_shading_setup *setup);

/// Fails when the largest material of a cloud's surfels is not in the table. Errors: EWA_ERROR_ARGUMENT.
ewa_status ewa_shading_check_materials(ewa_context *context, const ewa_shading_setup *setup,
                                       uint32_t largest);

#endif
