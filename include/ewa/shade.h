// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What surfaces are made of and what shines on them: materials, lights, environments.
#ifndef EWA_SHADE_H
#define EWA_SHADE_H

#include "ewa/image.h"
#include "ewa/options.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    EWA_MAX_LIGHTS = 8,
    EWA_MAX_MATERIALS = 256,
};

/// How a surface returns light. With unit vectors N (normal), L (towards a light), V (towards the eye), H
/// between L and V, and R, the reflection of V in N, a surface of a colour looks
///   colour (ambient + diffuse sum_lights light max(0, N.L))
///   + specular sum_lights light max(0, N.H)^shininess + reflection environment(R).
/// Fill with ewa_material_init().
typedef struct ewa_material {
    float ambient;    ///< light from everywhere; [0, 1000]; default 0.15
    float diffuse;    ///< [0, 1000]; default 0.85
    float specular;   ///< strength of the highlights, which have the light's colour; [0, 1000]; default 0.3
    float shininess;  ///< exponent of the highlights; [1, 65536]; default 32
    float reflection; ///< strength of the environment's mirror image; [0, 1000]; default 0.25
} ewa_material;

EWA_API extern const ewa_option_table ewa_material_table;
/// Sets the defaults.
EWA_API void ewa_material_init(ewa_material *material);

/// A light so far away that it comes from one direction. Fill with ewa_light_init().
typedef struct ewa_light {
    double direction_world[3]; ///< towards the light, any length; 0, 0, 0 (default): headlight, from the eye
    float color[3];            ///< linear, [0, 1e6] each; default 1, 1, 1
} ewa_light;

/// Sets a white headlight.
EWA_API void ewa_light_init(ewa_light *light);

/// What mirrors show: a picture of all directions, filtered for every footprint that a pixel's reflections
/// may have. Immutable once made; any number of renderers may use it.
///
/// The picture is equirectangular, as OpenEXR's latitude-longitude maps: the upper edge is the direction +y,
/// the lower edge -y, the middle +z; u runs from longitude +180 degrees at the left edge to -180 at the right
/// one, and longitude 90, a quarter from the left, is +x. (`environment_up` of ewa_render_options turns it.)
typedef struct ewa_environment ewa_environment;

/// Makes an environment of an image of 1 (grey), 3 or 4 (RGB first) channels, linear light; the image is not
/// needed afterwards. Numbers that are negative or not finite become 0, those above 1e8 become 1e8. Memory:
/// 16 bytes per pixel. Errors: EWA_ERROR_ARGUMENT (image, channels), EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_environment_create(const ewa_image *image, ewa_environment **environment);
/// Accepts a pointer to NULL; sets `*environment` to NULL.
EWA_API void ewa_environment_destroy(ewa_environment **environment);

#ifdef __cplusplus
}
#endif
#endif
