// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One pixel in double precision, from the splats that count at it to its surfaces and its values, and back: from the
// cotangents of the values to those of what has gathered of each surface (docs/math.md section 15). A cotangent of a
// number is the derivative of a loss by it.
#ifndef EWA_SRC_REFERENCE_ADJOINT_PIXEL_H
#define EWA_SRC_REFERENCE_ADJOINT_PIXEL_H

#include "reference/layering.h"
#include "reference/shade.h"

/// A small motion of a camera, and changes of its lens: what its ten cotangents are of.
enum {
    EWA_CAMERA_ROTATION = 0,    ///< three: p becomes p + r x p in camera space
    EWA_CAMERA_TRANSLATION = 3, ///< three: p becomes p + t, in units of the camera
    EWA_CAMERA_FOCAL = 6,       ///< two, pixels; orthographic: pixels per unit of the camera
    EWA_CAMERA_PRINCIPAL = 8,   ///< two, pixels
    EWA_CAMERA_NUMBERS = 10,
};

/// What of a frame decides how sums become pixels.
typedef struct ewa_reference_resolve {
    const ewa_reference_view *view;
    const ewa_render_options *options; ///< checked; three passes, no highlights
    const ewa_shading_setup *shading;
    double unit_coverage; ///< q0
    ewa_reference_layering layering;
} ewa_reference_resolve;

/// A splat at a pixel.
typedef struct ewa_reference_fragment {
    const ewa_reference_splat *splat;
    uint64_t index; ///< of the splat
    uint32_t layer; ///< the surface that it is part of, from the nearest on; EWA_NO_LAYER: none that is drawn
    ewa_reference_sample sample;
} ewa_reference_fragment;

#define EWA_NO_LAYER UINT32_MAX

/// A surface at a pixel.
typedef struct ewa_reference_layer {
    ewa_reference_gathered gathered;
    ewa_reference_sums sums;
    ewa_reference_cover cover;
    ewa_reference_surface surface;
    ewa_vec3 shaded;                  ///< straight
    bool merged;                      ///< all that is left, not one surface
    double covered;                   ///< share of what the surfaces in front of it leave open, before its opacity
    double single;                    ///< the same with its opacity
    double alpha;                     ///< that, or, of a merged layer, of as many surfaces as it is
    double through;                   ///< what the surfaces in front of it leave open
    ewa_reference_gathered cotangent; ///< of `gathered`, but for its materials
} ewa_reference_layer;

/// The values of a pixel, or their cotangents, as in ewa_frame. Depths are in units of the view's placement.
typedef struct ewa_reference_values {
    double rgba[4], depth, normal[3], coverage;
} ewa_reference_values;

/// Finds the surfaces that fragments of one pixel make, the nearest first, and which each is part of. There are no
/// more than there are fragments. Returns how many. x_px, y_px: the pixel's centre.
uint32_t ewa_reference_layers_find(const ewa_reference_resolve *to, double x_px, double y_px,
                                   ewa_reference_fragment *fragments, uint32_t count, ewa_reference_layer *layers);

/// Sets what a surface comes to, of which `gathered` is there: surface `index`, 0 being the nearest; `through`: what those in
/// front leave open; `first`: the nearest one's cover. Any thread.
void ewa_reference_layer_settle(const ewa_reference_resolve *to, double x_px, double y_px, uint32_t index, double through,
                                const ewa_reference_cover *first, ewa_reference_layer *layer);

/// The material of all surfaces: ambient, diffuse, specular, shininess, reflection.
void ewa_reference_material_of(const ewa_reference_resolve *to, float numbers[5]);

/// Gathers so many surfaces of which the fragments say that they are part.
void ewa_reference_layers_gather(const ewa_reference_resolve *to, double x_px, double y_px,
                                 const ewa_reference_fragment *fragments, uint32_t count, uint32_t layer_count,
                                 ewa_reference_layer *layers);

/// Returns the pixel's values.
ewa_reference_values ewa_reference_layers_show(const ewa_reference_resolve *to, const ewa_reference_layer *layers,
                                               uint32_t layer_count);

/// Sets the cotangents of what has gathered from those of the values, and adds what the directions to the eye give the
/// camera's, of whose focal lengths those in units of the view are meant.
void ewa_reference_layers_pull_back(const ewa_reference_resolve *to, double x_px, double y_px,
                                    const ewa_reference_values *cotangent, ewa_reference_layer *layers,
                                    uint32_t layer_count, double camera[EWA_CAMERA_NUMBERS]);

#endif
