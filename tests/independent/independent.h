// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A renderer for tests, written a second time from docs/math.md, docs/conventions.md and semantics.h alone.
// It shares no function, constant or table with the library, and takes other ways where there are any: dual
// conics by generic matrices in long double instead of sheared ones, rays by dual numbers instead of derived
// formulas, fragments of a pixel in a list instead of passes over the picture. A mistake that the pipeline
// and the reference make together shows against it. It reads the public structs of camera and options, and
// surfels as plain numbers.
//
// independent_splat.c: what one surfel is on the screen. independent_light.c: shading.
// independent_environment.c: what mirrors show. independent_picture.c: which surfels a pixel shows, and what
// it becomes.
#ifndef EWA_TESTS_INDEPENDENT_H
#define EWA_TESTS_INDEPENDENT_H

#include "ewa/ewa.h"

/// One point of a cloud, by the numbers that its streams hold.
typedef struct independent_surfel {
    double position[3];          ///< world
    bool disc;                   ///< normal and radius; else two conjugate axes, each one standard deviation
    double normal[3];            ///< outward, not zero; with axes: the side, zero for u x v
    double radius;               ///< of the support
    double axis_u[3], axis_v[3]; ///< any two that span a plane
    double color[3], alpha;      ///< linear, straight
    uint32_t material;
    uint32_t clip_count; ///< 0 to 2
    double clip[2][3];   ///< a, b, c: keep a u + b v + c >= 0
    bool clip_either;
} independent_surfel;

/// A picture of all directions, and its smaller copies.
typedef struct independent_level {
    uint32_t width, height;
    double *texels; ///< r, g, b
} independent_level;

typedef struct independent_environment {
    uint32_t count;
    independent_level levels[33];
} independent_environment;

/// Ends the program when there is no memory.
void independent_environment_make(const ewa_image *sky, independent_environment *made);
void independent_environment_free(independent_environment *made);

typedef struct independent_scene {
    const independent_surfel *surfels;
    uint64_t surfel_count;
    double cutoff, radius_scale;
    double unit_coverage; ///< q0
    ewa_camera camera;
    ewa_render_options options;
    const independent_environment *sky; ///< of what options.environment was made of; NULL: none
} independent_scene;

/// Planes of the camera's size, as ewa_frame's but in doubles.
typedef struct independent_picture {
    uint32_t width_px, height_px;
    double *rgba;  ///< linear, premultiplied
    double *srgb;  ///< straight, sRGB curve, [0, 255], not rounded
    double *depth; ///< infinite where nothing is
    double *normal;
    double *coverage;
    bool *doubtful; ///< single precision may decide otherwise here: a surfel ends or hides another within
                    ///< rounding
} independent_picture;

/// Draws a scene; the caller frees the picture with independent_free(). Ends the program when there is no
/// memory.
independent_picture independent_render(const independent_scene *scene);
void independent_free(independent_picture *picture);

// ---- Between its files

typedef long double real;

typedef struct real3 {
    real x, y, z;
} real3;

real3 real3_of(const double v[3]);
real3 real3_add(real3 a, real3 b);
real3 real3_times(real3 a, real factor);
real real3_dot(real3 a, real3 b);
real3 real3_cross(real3 a, real3 b);
real real3_length(real3 a);
/// Zero for zero.
real3 real3_unit(real3 a);

/// How a surfel meets a camera.
typedef struct independent_splat {
    bool dropped, near;
    bool doubtful;    ///< whether it is dropped, near, or seen from its front is within rounding
    real cutoff_band; ///< relative to F^2: r^2 this close may fall on either side
    real depth_band;  ///< as far may z be off
    bool orthographic;
    ewa_kernel kernel;
    real cutoff, prefilter;
    real fx, fy, cx, cy;
    real3 p, u, v, n; ///< camera space; n unit, towards the viewer
    real3 normal_world;
    bool back_facing;              ///< it shows its back: n is turned over
    real center[2];                ///< of the ellipse, pixels
    real variance[3], determinant; ///< V and |V|
    real jacobian[2][2];
    real half_range; ///< R
    real key[3];     ///< of the plane: key[0] x + key[1] y + key[2]
    real key_low, key_high;
    real epsilon;
    real box[4]; ///< x low, high, y low, high of what may count
    uint32_t clip_count;
    bool clip_either;
    real clip[2][3]; ///< signed distance in pixels is clip . (x, y, 1)
} independent_splat;

/// What a splat is at a point of the picture.
typedef struct independent_fragment {
    bool counts;
    bool doubtful; ///< whether it counts is within rounding
    real z, epsilon, weight;
    real share;     ///< of the pixel's square, that clip lines keep; the weight has it
    real inward[2]; ///< mean direction in which they keep
    real depth_band;
    uint32_t splat;
} independent_fragment;

void independent_project(const independent_scene *scene, const independent_surfel *surfel,
                         independent_splat *splat);

void independent_evaluate(const independent_splat *splat, real x, real y, independent_fragment *fragment);

/// A surface of a pixel before it is shaded.
typedef struct independent_surface {
    bool there;
    real3 color;
    real3 normal;     ///< world; as shaded by
    real3 eye;        ///< world, unit: towards the viewer
    real material[5]; ///< ambient, diffuse, specular, shininess, reflection
} independent_surface;

/// `beside` and `below`: of the neighbours within the aligned 2x2 pixels.
real3 independent_shade(const independent_scene *scene, const independent_surface *at,
                        const independent_surface *beside, const independent_surface *below);

/// The environment's light that a surface mirrors.
real3 independent_reflection(const independent_environment *sky, const ewa_render_options *options,
                             const independent_surface *at, const independent_surface *beside,
                             const independent_surface *below);

/// The share of the light that eye-dome lighting leaves of a pixel.
real independent_eye_dome(const independent_scene *scene, const double *depth, int64_t x, int64_t y);

#endif
