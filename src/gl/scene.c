// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What programs see of a frame. Numbers that the kernels make of a view are made here, with the same roundings.
#include "gl/scene.h"

#include <assert.h>
#include <string.h>

static_assert(sizeof(ewa_gl_view) == 200 && sizeof(ewa_gl_clip) == 144 && sizeof(ewa_gl_near) == 268 &&
                  sizeof(ewa_gl_placement) == 456 && sizeof(ewa_gl_tally) == 64 && sizeof(ewa_gl_segment) == 32,
              "as std430 has them");

void ewa_gl_view_set(ewa_gl_view *to, const ewa_view *from, bool hides) {
    memset(to, 0, sizeof *to);
    memcpy(to->focal_px, from->focal_px, sizeof to->focal_px);
    memcpy(to->principal_px, from->principal_px, sizeof to->principal_px);
    memcpy(to->rotation, from->rotation, sizeof to->rotation);
    to->scale = from->scale;
    to->fx_px = from->fx_px, to->fy_px = from->fy_px;
    to->inverse_fx = 1 / from->fx_px, to->inverse_fy = 1 / from->fy_px;
    to->zoom = from->zoom, to->fx_zoomed = from->fx_zoomed, to->fy_zoomed = from->fy_zoomed;
    to->broad = from->broad;
    to->cutoff = from->cutoff, to->cutoff2 = from->cutoff2, to->inverse_cutoff = 1 / from->cutoff;
    to->center_scale = -from->cutoff2 / from->zoom;
    to->prefilter2_px2 = from->prefilter2_px2, to->reach_px = from->reach_px;
    if (from->point_sigma_px > 0) {
        const float x = from->point_sigma_px / from->fx_zoomed, y = from->point_sigma_px / from->fy_zoomed;
        to->point_x = x, to->point_y = y;
        to->point_major = x < y ? y : x, to->point_minor = x < y ? x : y;
        to->point_sigma = to->point_major / from->zoom;
    }
    to->tolerance = from->tolerance, to->grazing = from->grazing;
    to->exponent_scale = from->exponent_scale, to->exponent_end = from->exponent_end;
    to->sum_scale = from->sum_scale, to->color_scale = from->color_scale, to->depth_scale = from->depth_scale;
    to->doublings = from->doublings;
    to->contour_shift = from->contour_shift, to->contour_sine2 = from->contour_sine2;
    to->curvature_scale = from->curvature_scale;
    const struct {
        bool set;
        uint32_t flag;
    } flags[] = {{from->orthographic, EWA_GL_ORTHOGRAPHIC},
                 {from->cull_back, EWA_GL_CULL_BACK},
                 {from->ellipses, EWA_GL_ELLIPSES},
                 {from->affine, EWA_GL_AFFINE},
                 {from->source, EWA_GL_SOURCE},
                 {from->circular, EWA_GL_CIRCULAR},
                 {from->raycast, EWA_GL_RAYCAST},
                 {from->point_sigma_px > 0, EWA_GL_POINTS},
                 {hides, EWA_GL_HIDES},
                 {from->transparent, EWA_GL_SEE_THROUGH}};
    for (size_t i = 0; i < sizeof flags / sizeof flags[0]; i++) to->flags |= flags[i].set ? flags[i].flag : 0;
}

void ewa_gl_placement_set(ewa_gl_placement *to, const ewa_view *from, uint8_t material) {
    memset(to, 0, sizeof *to);
    memcpy(to->linear, from->linear, sizeof to->linear);
    memcpy(to->anchor, from->anchor, sizeof to->anchor);
    memcpy(to->offset, from->offset, sizeof to->offset);
    memcpy(to->sections, from->sections, sizeof to->sections);
    memcpy(to->side_planes, from->side_planes, sizeof to->side_planes);
    to->cx_px = from->cx_px, to->cy_px = from->cy_px, to->margin_px = from->margin_px;
    to->section_reach = from->section_reach, to->section_count = from->section_count;
    to->width_px = from->width_px, to->height_px = from->height_px;
    to->material = material;
}

void ewa_gl_clip_set(ewa_gl_clip *to, const ewa_clip *from) {
    memset(to, 0, sizeof *to);
    for (uint32_t i = 0; i < from->count; i++) memcpy(to->lines[i], &from->line[i], sizeof from->line[i]);
    to->count = from->count;
    to->either = from->either;
}

void ewa_gl_near_set(ewa_gl_near *to, const ewa_near_record *from, uint32_t source) {
    memset(to, 0, sizeof *to);
    memcpy(to->u, from->u, sizeof to->u);
    memcpy(to->v, from->v, sizeof to->v);
    memcpy(to->w, from->w, sizeof to->w);
    memcpy(to->z, from->z, sizeof to->z);
    to->depth_low = from->depth_low, to->depth_high = from->depth_high, to->tolerance = from->tolerance;
    memcpy(to->color, from->color, sizeof to->color);
    memcpy(to->normal, from->normal, sizeof to->normal);
    to->opacity = from->opacity;
    memcpy(to->material, from->material, sizeof to->material);
    to->flags = (from->is_back ? EWA_BACK_FACING_BIT : 0) | (from->clipped ? EWA_CLIP_BIT : 0);
    to->source = source;
    if (from->clipped) ewa_gl_clip_set(&to->clip, &from->clip);
}

void ewa_gl_resolve_set(ewa_gl_resolve *to, const ewa_resolve *from) {
    memset(to, 0, sizeof *to);
    to->unit_coverage_inverse = from->unit_coverage_inverse, to->alpha_scale = from->alpha_scale;
    to->covering = from->covering, to->front_scale = from->front_scale;
    to->color_unit = from->color_unit;
    memcpy(to->material_units, from->material_units, sizeof to->material_units);
    to->opacity = from->opacity, to->depth_unit = from->depth_unit;
    to->depth_per_share = from->depth_per_share;
    memcpy(to->material, from->material, sizeof to->material);
    memcpy(to->environment_from_camera, from->environment_from_camera, sizeof to->environment_from_camera);
    memcpy(to->background, from->background, sizeof to->background);
    memcpy(to->ray_x, from->ray_x, sizeof to->ray_x);
    memcpy(to->ray_y, from->ray_y, sizeof to->ray_y);
    memcpy(to->to_world, from->to_world, sizeof to->to_world);
    to->flags = (from->edge_antialiasing ? 1u : 0) | (from->transparent ? 2u : 0) |
                (from->one_pass ? 4u : 0) | (from->orthographic ? 8u : 0);
    to->shading = (uint32_t)from->shading;
    to->light_count = from->light_count;
    for (uint32_t i = 0; i < from->light_count; i++) {
        to->lights[i].headlight = from->lights[i].headlight;
        memcpy(to->lights[i].toward, from->lights[i].toward, sizeof to->lights[i].toward);
        memcpy(to->lights[i].color, from->lights[i].color, sizeof to->lights[i].color);
    }
    if (!from->environment) return;
    const ewa_environment *environment = from->environment;
    const float texels = (float)environment->levels[0].height * 0.318309886f;
    to->texels_per_radian2 = texels * texels;
    to->level_count = environment->level_count;
    uint32_t first = 0;
    for (uint32_t i = 0; i < environment->level_count; i++) {
        const ewa_environment_level *level = &environment->levels[i];
        to->levels[i].width = level->width, to->levels[i].height = level->height;
        to->levels[i].first = first;
        first += 3 * level->width * level->height;
    }
}
