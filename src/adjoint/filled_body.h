// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of kernels_body.h: pixels that one opaque surface fills, which most are, eight at a time, from the cotangents of
// their colours to those of the surface's sums. Reference: ewa_reference_layers_pull_back(), of which these are the very
// numbers; docs/math.md section 15.
//
// Loops over lanes are written as for one pixel; compilers make vectors of them.
#ifndef EWA_SRC_ADJOINT_FILLED_BODY_H
#define EWA_SRC_ADJOINT_FILLED_BODY_H

#include "adjoint/eight.h"
#include "adjoint/kernels.h"

#if defined(__clang__)
#define UNROLL_LIGHTS _Pragma("clang loop unroll(full)")
#else
#define UNROLL_LIGHTS _Pragma("GCC unroll 4")
#endif

/// The cotangents of a block's colours; 0 beyond the picture.
EIGHT void load_cotangents(const ewa_adjoint_filling *by, uint32_t column, uint32_t row, double given[3][LANES]) {
    memset(given, 0, 3 * LANES * sizeof(double));
    for (uint32_t lane = 0; lane < LANES; lane++) {
        const uint32_t x = EWA_EIGHT_COLUMNS * column + lane % EWA_EIGHT_COLUMNS,
                       y = EWA_EIGHT_ROWS * row + lane / EWA_EIGHT_COLUMNS;
        if (x >= by->width_px || y >= by->height_px) continue;
        for (uint32_t c = 0; c < 3; c++) given[c][lane] = (double)by->rgba[4 * ((size_t)y * by->stride_px + x) + c];
    }
}

/// What a block's pixels start from, and what directions to the eye give the camera's cotangents, by its number.
typedef struct camera_lanes {
    double given[3][LANES]; ///< cotangents of colours
    double by[EWA_CAMERA_NUMBERS][LANES];
} camera_lanes;

/// The sums of a block's pixels, those that count, and what they become.
typedef struct filled_lanes {
    double sides[2][EWA_SIDE_PLANES][LANES], bound[LANES], whole[LANES];
    double to[EWA_SIDE_PLANES][LANES]; ///< cotangents, of the side that has sums
    int64_t done[LANES], filled[LANES], is_back[LANES]; ///< all bits, or none
} filled_lanes;

EIGHT double on_side(const filled_lanes *at, int plane, int lane, bool is_back) {
    const double front = at->sides[0][plane][lane], back = at->sides[1][plane][lane];
    return is_back ? back : front;
}

/// The cotangents of the sums of all lanes, and what they give the camera.
EIGHT void fill_lanes(const ewa_reference_view *view, const ewa_adjoint_filling *by, double left_px, double top_px,
                      filled_lanes *at, camera_lanes *camera) {
    double given[3][LANES];
    memcpy(given, camera->given, sizeof given);
    const ewa_mat3 linear = view->placement.linear;
    const double cx = view->cx_px, cy = view->cy_px, fx = view->fx_px, fy = view->fy_px, slopes = view->orthographic ? 0 : 1;
    const double least = by->minimum, of_ambient = by->ambient, of_diffuse = by->diffuse, unlit = by->unlit, to_world = by->inverse_scale;
    ewa_adjoint_light lights[EWA_ADJOINT_LIGHTS];
    memcpy(lights, by->lights, sizeof lights);
    for (int lane = 0; lane < LANES; lane++) {
        const double front = at->sides[0][EWA_PLANE_WEIGHT][lane], back = at->sides[1][EWA_PLANE_WEIGHT][lane], q = front + back;
        const bool is_there = (at->bound[lane] < __builtin_inf()) & (q > 0), is_back = !(front > 0);
        const bool filled = is_there & (q >= least) & ((front > 0) != (back > 0)) & !(at->whole[lane] > 0);
        at->done[lane] = (!is_there | filled) ? -1 : 0, at->filled[lane] = filled ? -1 : 0, at->is_back[lane] = is_back ? -1 : 0;
        at->bound[lane] = is_there ? at->bound[lane] : -__builtin_inf(); // nothing counts
        const double weight = filled ? q : 1, inverse = 1 / weight;
        const ewa_vec3 sum = {on_side(at, EWA_PLANE_NORMAL, lane, is_back), on_side(at, EWA_PLANE_NORMAL + 1, lane, is_back),
                              on_side(at, EWA_PLANE_NORMAL + 2, lane, is_back)};
        const double length = __builtin_sqrt(vec3_dot(sum, sum)), minimum = EWA_SHADED_NORMAL * weight;
        const bool is_long = length >= minimum;
        const ewa_vec3 normal = vec3_scale(sum, 1 / (is_long ? length : minimum));
        const ewa_vec3 color = {on_side(at, EWA_PLANE_COLOR, lane, is_back) * inverse,
                                on_side(at, EWA_PLANE_COLOR + 1, lane, is_back) * inverse,
                                on_side(at, EWA_PLANE_COLOR + 2, lane, is_back) * inverse};
        // The ray, and the direction to the eye in the world.
        const double x = left_px + lane % EWA_EIGHT_COLUMNS, y = top_px + lane / EWA_EIGHT_COLUMNS;
        const ewa_vec3 ray = {(x - cx) / fx * slopes, (y - cy) / fy * slopes, 1};
        const ewa_vec3 turned = vec3_scale(vec3_mul_mat3(ray, &linear), -1);
        const ewa_vec3 view_world = vec3_scale(turned, 1 / __builtin_sqrt(vec3_dot(turned, turned)));
        // What colours are multiplied by, and what the loss changes by the normal and by the direction to the eye.
        const double ambient = weight * of_ambient * inverse, diffuse = weight * of_diffuse * inverse;
        double light[3] = {ambient + unlit, ambient + unlit, ambient + unlit};
        ewa_vec3 by_normal = {0, 0, 0}, by_view = {0, 0, 0};
        UNROLL_LIGHTS
        for (int i = 0; i < EWA_ADJOINT_LIGHTS; i++) {
            const ewa_adjoint_light *source = &lights[i];
            const ewa_vec3 toward = vec3_add(source->toward_world, vec3_scale(view_world, source->headlight));
            const double facing = vec3_dot(normal, toward), lit = facing > 0 ? facing : 0;
            const double changes = given[0][lane] * color.x * diffuse * source->color[0] +
                                   given[1][lane] * color.y * diffuse * source->color[1] +
                                   given[2][lane] * color.z * diffuse * source->color[2];
            const double by_facing = facing > 0 ? changes : 0;
            light[0] += diffuse * source->color[0] * lit;
            light[1] += diffuse * source->color[1] * lit;
            light[2] += diffuse * source->color[2] * lit;
            by_normal = vec3_add(by_normal, vec3_scale(toward, by_facing));
            by_view = vec3_add(by_view, vec3_scale(normal, source->headlight * by_facing));
        }
        // To the sums.
        const ewa_vec3 by_color = {given[0][lane] * light[0], given[1][lane] * light[1], given[2][lane] * light[2]};
        const double along = vec3_dot(normal, by_normal);
        const ewa_vec3 by_sum = vec3_scale(vec3_sub(by_normal, vec3_scale(normal, is_long ? along : 0)),
                                           1 / (is_long ? length : minimum));
        at->to[EWA_PLANE_WEIGHT][lane] = is_long ? 0 : -along / weight;
        at->to[EWA_PLANE_COLOR][lane] = by_color.x * inverse;
        at->to[EWA_PLANE_COLOR + 1][lane] = by_color.y * inverse;
        at->to[EWA_PLANE_COLOR + 2][lane] = by_color.z * inverse;
        at->to[EWA_PLANE_NORMAL][lane] = by_sum.x;
        at->to[EWA_PLANE_NORMAL + 1][lane] = by_sum.y;
        at->to[EWA_PLANE_NORMAL + 2][lane] = by_sum.z;
        at->to[EWA_PLANE_Z][lane] = 0;
        at->to[EWA_PLANE_OPACITY][lane] = -vec3_dot(by_color, color) / weight;
        // To the camera, against which the world turns.
        const double slant = __builtin_sqrt(vec3_dot(ray, ray));
        const ewa_vec3 toward = vec3_scale(ray, -1 / slant), cotangent = vec3_scale(mat3_mul_vec3(&linear, by_view), to_world);
        const ewa_vec3 turn = vec3_cross(cotangent, toward);
        const ewa_vec3 across = vec3_sub(cotangent, vec3_scale(toward, vec3_dot(toward, cotangent)));
        const ewa_vec3 by_ray = vec3_scale(across, slopes / slant); // of the ray back
        camera->by[EWA_CAMERA_ROTATION][lane] = filled ? turn.x : 0;
        camera->by[EWA_CAMERA_ROTATION + 1][lane] = filled ? turn.y : 0;
        camera->by[EWA_CAMERA_ROTATION + 2][lane] = filled ? turn.z : 0;
        camera->by[EWA_CAMERA_FOCAL][lane] = filled ? by_ray.x * ray.x / fx : 0;
        camera->by[EWA_CAMERA_FOCAL + 1][lane] = filled ? by_ray.y * ray.y / fy : 0;
        camera->by[EWA_CAMERA_PRINCIPAL][lane] = filled ? by_ray.x / fx : 0;
        camera->by[EWA_CAMERA_PRINCIPAL + 1][lane] = filled ? by_ray.y / fy : 0;
    }
}

/// The pixels of a block that are filled: sets cotangents instead of their sums. Returns the lanes that are at their end, by bits.
EIGHT uint32_t fill_block(const ewa_adjoint_area *area, const ewa_adjoint_filling *by, uint32_t column, uint32_t row,
                          camera_lanes *camera) {
    const block at = block_at(area, column, row);
    filled_lanes lanes;
    memcpy(lanes.sides, at.planes, sizeof lanes.sides);
    memcpy(lanes.bound, at.planes + EWA_PLANE_BOUND * LANES, sizeof lanes.bound);
    memcpy(lanes.whole, at.planes + EWA_PLANE_WHOLE * LANES, sizeof lanes.whole);
    load_cotangents(by, column, row, camera->given);
    fill_lanes(area->view, by, at.x_px, at.y_px, &lanes, camera);
    memcpy(at.planes + EWA_PLANE_BOUND * LANES, lanes.bound, sizeof lanes.bound);
    m8 filled, is_back;
    memcpy(&filled, lanes.filled, sizeof filled);
    memcpy(&is_back, lanes.is_back, sizeof is_back);
    for (int p = 0; p < EWA_SIDE_PLANES; p++) {
        const d8 to = d8_load(lanes.to[p]), none = d8_set(0);
        d8_store(at.planes + p * LANES, d8_select(filled, d8_select(is_back, none, to), d8_load(lanes.sides[0][p])));
        d8_store(at.planes + (EWA_SIDE_PLANES + p) * LANES,
                 d8_select(filled, d8_select(is_back, to, none), d8_load(lanes.sides[1][p])));
    }
    uint32_t bits = 0;
    for (uint32_t lane = 0; lane < LANES; lane++) bits |= (uint32_t)(lanes.done[lane] & 1) << lane;
    return bits;
}

static void fill(const ewa_adjoint_area *area, const ewa_adjoint_filling *by, uint8_t *done, double camera[EWA_CAMERA_NUMBERS]) {
    camera_lanes terms;
    d8 sums[EWA_CAMERA_NUMBERS];
    memset(&terms, 0, sizeof terms);
    for (int i = 0; i < EWA_CAMERA_NUMBERS; i++) sums[i] = d8_set(WHOLE);
    for (uint32_t row = 0; row < area->rows; row++)
        for (uint32_t column = 0; column < area->columns; column++) {
            done[(size_t)row * area->columns + column] = (uint8_t)fill_block(area, by, column, row, &terms);
            for (int i = 0; i < EWA_CAMERA_NUMBERS && by->with_camera; i++)
                sums[i] = d8_add(sums[i], d8_odd(d8_mul(d8_load(terms.by[i]), d8_set(by->scales[i]))));
        }
    for (int i = 0; i < EWA_CAMERA_NUMBERS && by->with_camera; i++) {
        const double total = d8_total(d8_sub(sums[i], d8_set(WHOLE)));
        camera[i] = total > -0x1p52 && total < 0x1p52 ? total / by->scales[i] : 0;
    }
}

#endif
