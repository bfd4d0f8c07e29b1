// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Solid textures: colours that are functions of space, filtered by the surfels' own kernels.
#ifndef EWA_PROCEDURE_H
#define EWA_PROCEDURE_H

#include "ewa/base.h"
#include "ewa/cloud.h"
#include "ewa/options.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum ewa_procedure {
    EWA_PROCEDURE_CHECKER = 0, ///< cubes of two colours, `frequency` / 2 pairs per unit
    EWA_PROCEDURE_MARBLE = 1,  ///< veins about 1 / frequency apart, bent by noise
    EWA_PROCEDURE_WOOD = 2,    ///< year rings about the z axis, 1 / frequency apart, with grain
    EWA_PROCEDURE_NOISE = 3,   ///< five octaves of random waves, the longest 1 / frequency long
} ewa_procedure;

/// A solid texture. Fill with ewa_procedure_options_init().
typedef struct ewa_procedure_options {
    size_t struct_size;
    ewa_procedure procedure;
    double frequency;   ///< features per world unit; (0, 1e9]; default 8
    double prefilter;   ///< standard deviation of the filter in units of the surfel's axes; 0: none, which
                        ///< aliases; [0, 10]; default 1
    double cutoff;      ///< F: sigma = radius / F where there are no axes; (0, 4]; default 3
    uint64_t seed;      ///< of the noise; default 1
    float colors[2][3]; ///< linear, each number in [0, 1]: checker: of the two cubes; marble: stone, veins;
                        ///< wood: early, late wood; noise: low, high. Defaults depend on `procedure`
} ewa_procedure_options;

EWA_API extern const ewa_option_table ewa_procedure_options_table;
/// Sets every member to its default, colours to those of `procedure`.
EWA_API void ewa_procedure_options_init(ewa_procedure_options *options, ewa_procedure procedure,
                                        size_t struct_size);

/// Gives the points of a cloud the colours of a solid texture: "color" U8 (sRGB), 3 components, or 4 with the
/// alpha of the colour that it replaces.
///
/// Every surfel gets the mean of the texture under its own Gaussian (axes tangent_u, tangent_v, or a disc of
/// radius / cutoff), computed in closed form or as a Fourier series, so that details finer than the surfels
/// fade into their mean, whatever the frequency. The texture is fixed in world space, the cloud's origin
/// included. Points that are no surfels get its value at their place; those with coordinates that are not
/// finite the mean of the two colours.
///
/// The cloud needs "position", and unless `prefilter` is 0 "normal" and "radius", or "tangent_u" and
/// "tangent_v". The result does not depend on the number of threads nor on the machine. Progress stage:
/// "procedure". Errors (cloud unchanged): EWA_ERROR_ARGUMENT (what is missing or out of range, named),
/// EWA_ERROR_MEMORY, EWA_CANCELLED. docs/colors.md has the formulas. Marble and wood are after K. Perlin, "An
/// image synthesizer", 1985.
EWA_API ewa_status ewa_cloud_color_by_procedure(ewa_cloud *cloud, const ewa_procedure_options *options);

#ifdef __cplusplus
}
#endif
#endif
