// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From the cotangents of a pixel to those of its surfaces' sums (docs/math.md section 15). Each function that ends in
// _pull_back is the transposed derivative of the one of the same name in sums.c, shade.c, or here.
#include "reference/adjoint_pixel.h"
#include "surface/semantics.h"

#include <string.h>

void ewa_reference_layer_settle(const ewa_reference_resolve *to, double x_px, double y_px, uint32_t index, double through,
                                const ewa_reference_cover *first, ewa_reference_layer *layer) {
    layer->merged = to->layering.merge_last && index + 1 == to->layering.max_layers;
    layer->through = through;
    layer->covered = 1;
    layer->cover = (ewa_reference_cover){.share = 0};
    layer->sums = ewa_reference_settle(&layer->gathered, to->unit_coverage, layer->merged);
    layer->surface = ewa_reference_surface_of(to->view, &layer->sums, x_px, y_px);
    layer->shaded = ewa_reference_shade(to->shading, NULL, &layer->surface, &layer->surface, &layer->surface);
    if (to->options->edge_antialiasing) {
        layer->cover = ewa_reference_cover_of(&layer->gathered, to->unit_coverage, to->options->edge_threshold,
                                              layer->merged);
        layer->covered = index == 0 || to->layering.transparent ? layer->cover.share
                                                                : ewa_reference_cover_behind(first, &layer->cover);
    }
    layer->single = layer->covered;
    if (to->layering.transparent) layer->single *= to->options->opacity * layer->sums.opacity / layer->sums.weight;
    layer->alpha = layer->single;
    if (layer->merged)
        layer->alpha = ewa_reference_merged_alpha(layer->single, layer->sums.weight / to->unit_coverage);
}

void ewa_reference_material_of(const ewa_reference_resolve *to, float numbers[5]) {
    const ewa_material *m = &to->shading->materials[0];
    const float all[5] = {m->ambient, m->diffuse, m->specular, m->shininess, m->reflection};
    memcpy(numbers, all, sizeof all);
}

/// Gathers one surface behind those that are there, and what it comes to.
static void gather(const ewa_reference_resolve *to, double x_px, double y_px, const ewa_reference_fragment *fragments,
                   uint32_t count, uint32_t index, ewa_reference_layer *layers) {
    ewa_reference_layer *layer = &layers[index];
    float numbers[5];
    ewa_reference_material_of(to, numbers);
    *layer = (ewa_reference_layer){.covered = 1};
    for (uint32_t i = 0; i < count; i++) {
        const ewa_reference_fragment *from = &fragments[i];
        if (from->layer != index) continue;
        ewa_reference_gather(&layer->gathered, from->splat, &from->sample, from->sample.weight,
                             to->layering.transparent ? from->splat->opacity : 1, numbers);
    }
    const double through = index > 0 ? layers[index - 1].through * (1 - layers[index - 1].alpha) : 1;
    ewa_reference_layer_settle(to, x_px, y_px, index, through, &layers[0].cover, layer);
}

/// Whether what a splat is at a pixel is behind the surfaces that there are.
static bool is_behind(const ewa_reference_fragment *fragment, double passed) {
    return fragment->sample.z > passed && !(fragment->splat->concave && passed > -INFINITY);
}

uint32_t ewa_reference_layers_find(const ewa_reference_resolve *to, double x_px, double y_px,
                                   ewa_reference_fragment *fragments, uint32_t count, ewa_reference_layer *layers) {
    for (uint32_t i = 0; i < count; i++) fragments[i].layer = EWA_NO_LAYER;
    const uint32_t max_layers = to->layering.max_layers;
    double passed = -INFINITY, through = 1;
    uint32_t index = 0;
    for (; index < max_layers && through > 0; index++) {
        double bound = INFINITY; // B(x)
        const bool merged = to->layering.merge_last && index + 1 == max_layers;
        for (uint32_t i = 0; i < count && !merged; i++)
            if (is_behind(&fragments[i], passed))
                bound = fmin(bound, fragments[i].sample.z + fragments[i].splat->epsilon);
        if (!merged && !(bound < INFINITY)) break;
        double weight = 0;
        for (uint32_t i = 0; i < count; i++)
            if (is_behind(&fragments[i], passed) && fragments[i].sample.z <= bound)
                fragments[i].layer = index, weight += fragments[i].sample.weight;
        if (!(weight > 0)) break;
        gather(to, x_px, y_px, fragments, count, index, layers);
        through = layers[index].through * (1 - layers[index].alpha);
        passed = bound;
    }
    return index;
}

void ewa_reference_layers_gather(const ewa_reference_resolve *to, double x_px, double y_px,
                                 const ewa_reference_fragment *fragments, uint32_t count, uint32_t layer_count,
                                 ewa_reference_layer *layers) {
    for (uint32_t i = 0; i < layer_count; i++)
        gather(to, x_px, y_px, fragments, count, i, layers);
}

/// What is behind a surface, over which it is put: rgba, premultiplied.
static void put_over(const ewa_reference_layer *layer, double behind[4]) {
    const double front[4] = {layer->shaded.x, layer->shaded.y, layer->shaded.z, 1};
    for (int c = 0; c < 4; c++) behind[c] = layer->alpha * front[c] + (1 - layer->alpha) * behind[c];
}

static void set_background(const ewa_reference_resolve *to, double rgba[4]) {
    const float *from = to->options->background;
    for (int c = 0; c < 4; c++) rgba[c] = c < 3 ? (double)from[c] * (double)from[3] : (double)from[3];
}

ewa_reference_values ewa_reference_layers_show(const ewa_reference_resolve *to, const ewa_reference_layer *layers,
                                               uint32_t layer_count) {
    ewa_reference_values shown = {.depth = INFINITY};
    set_background(to, shown.rgba);
    for (uint32_t i = layer_count; i-- > 0;) put_over(&layers[i], shown.rgba);
    if (layer_count == 0) return shown;
    const ewa_reference_sums *sums = &layers[0].sums;
    const double length = vec3_length(sums->normal_world);
    if (length > 0) vec3_store(vec3_scale(sums->normal_world, 1 / length), shown.normal);
    shown.depth = sums->z / sums->weight;
    shown.coverage = sums->weight / to->unit_coverage;
    return shown;
}

/// Of a vector's direction, v / |v|: what its cotangent gives the vector's.
static ewa_vec3 direction_pull_back(ewa_vec3 unit, double length, ewa_vec3 cotangent) {
    return vec3_scale(vec3_sub(cotangent, vec3_scale(unit, vec3_dot(unit, cotangent))), 1 / length);
}

/// The direction to the eye in world space, -d A / |d A|.
static void view_pull_back(const ewa_reference_resolve *to, double x_px, double y_px, ewa_vec3 cotangent_world,
                           double camera[EWA_CAMERA_NUMBERS]) {
    const ewa_reference_view *view = to->view;
    const ewa_mat3 *linear = &view->placement.linear;
    const ewa_vec3 d = ewa_reference_ray(view, x_px, y_px);
    const double length = vec3_length(d), scale = vec3_length(mat3_row(linear, 2));
    const ewa_vec3 toward = vec3_scale(d, -1 / length);
    const ewa_vec3 cotangent = vec3_scale(mat3_mul_vec3(linear, cotangent_world), 1 / scale);
    const ewa_vec3 turn = vec3_cross(cotangent, toward); // the world turns against the camera
    camera[EWA_CAMERA_ROTATION] += turn.x;
    camera[EWA_CAMERA_ROTATION + 1] += turn.y;
    camera[EWA_CAMERA_ROTATION + 2] += turn.z;
    if (view->orthographic) return;
    const ewa_vec3 ray = vec3_scale(direction_pull_back(toward, length, cotangent), -1);
    camera[EWA_CAMERA_FOCAL] -= ray.x * d.x / view->fx_px;
    camera[EWA_CAMERA_FOCAL + 1] -= ray.y * d.y / view->fy_px;
    camera[EWA_CAMERA_PRINCIPAL] -= ray.x / view->fx_px;
    camera[EWA_CAMERA_PRINCIPAL + 1] -= ray.y / view->fy_px;
}

/// ewa_reference_shade() without highlights, and ewa_reference_surface_of().
static void shade_pull_back(const ewa_reference_resolve *to, double x_px, double y_px, const ewa_reference_layer *layer,
                            ewa_vec3 shaded, ewa_reference_sums *sums, double camera[EWA_CAMERA_NUMBERS]) {
    const ewa_reference_surface *at = &layer->surface;
    const ewa_shading_setup *setup = to->shading;
    double light[3] = {1, 1, 1}; // that the colour is multiplied by
    const double color[3] = {at->color.x, at->color.y, at->color.z}, given[3] = {shaded.x, shaded.y, shaded.z};
    ewa_vec3 normal = {0, 0, 0}, view = {0, 0, 0};
    for (int c = 0; c < 3 && setup->lit; c++) light[c] = at->ambient;
    for (uint32_t i = 0; i < setup->light_count && setup->lit; i++) {
        const ewa_vec3 toward = setup->lights[i].headlight ? at->view_world : setup->lights[i].toward_world;
        const double facing = vec3_dot(at->normal_world, toward);
        if (facing <= 0) continue;
        double by_facing = 0;
        for (int c = 0; c < 3; c++) {
            light[c] += at->diffuse * setup->lights[i].color[c] * facing;
            by_facing += given[c] * color[c] * at->diffuse * setup->lights[i].color[c];
        }
        normal = vec3_add(normal, vec3_scale(toward, by_facing));
        if (setup->lights[i].headlight) view = vec3_add(view, vec3_scale(at->normal_world, by_facing));
    }
    if (setup->lit) view_pull_back(to, x_px, y_px, view, camera);
    const ewa_vec3 by_color = vec3_make(given[0] * light[0], given[1] * light[1], given[2] * light[2]);
    const ewa_reference_sums *of = &layer->sums;
    if (of->opacity > 0) {
        sums->color = vec3_add(sums->color, vec3_scale(by_color, 1 / of->opacity));
        sums->opacity -= vec3_dot(by_color, at->color) / of->opacity;
    }
    const double length = vec3_length(of->normal_world), minimum = EWA_SHADED_NORMAL * of->weight;
    if (length >= minimum && length > 0) {
        sums->normal_world = vec3_add(sums->normal_world, direction_pull_back(at->normal_world, length, normal));
    } else {
        sums->normal_world = vec3_add(sums->normal_world, vec3_scale(normal, 1 / minimum));
        sums->weight -= vec3_dot(normal, at->normal_world) / of->weight;
    }
}

/// ewa_reference_cover_of().
static void cover_pull_back(const ewa_reference_gathered *surface, double minimum, bool merged,
                            const ewa_reference_cover *cotangent, double *weight, ewa_reference_cut *cut) {
    const double q = surface->facing.weight + surface->is_back.weight;
    const ewa_reference_cut *of = &surface->cut;
    if (q < minimum) *weight += cotangent->whole / minimum;
    if (merged || !(of->whole > 0)) {
        if (q < minimum) *weight += cotangent->share / minimum;
        return;
    }
    const double uncut = fmax(0, q - of->kept), length = hypot(of->inward[0], of->inward[1]);
    const double along = length / of->whole, slope = 1 / (EWA_EDGES_AGREE - EWA_EDGES_OPPOSE);
    const double place = (along - EWA_EDGES_OPPOSE) * slope, alone = fmin(fmax(place, 0), 1);
    const double behind = uncut + alone * of->whole, other = q / fmax(minimum, behind);
    double by_uncut = 0, by_whole = 0, by_q = 0;
    if (uncut / minimum >= other && uncut < minimum) {
        by_uncut = cotangent->share / minimum;
    } else if (uncut / minimum < other && other < 1) {
        by_q = cotangent->share / fmax(minimum, behind);
        if (behind > minimum) {
            by_uncut = -cotangent->share * other / behind;
            by_whole = by_uncut * alone;
            if (place > 0 && place < 1) {
                const double by_along = by_uncut * of->whole * slope;
                by_whole -= by_along * along / of->whole;
                for (int c = 0; c < 2; c++) cut->inward[c] += by_along * of->inward[c] / (length * of->whole);
            }
        }
    }
    for (int c = 0; c < 2; c++) {
        const double mean = of->inward[c] / (uncut + of->whole), by_sum = cotangent->inward[c] / (uncut + of->whole);
        cut->inward[c] += by_sum;
        by_uncut -= by_sum * mean, by_whole -= by_sum * mean;
    }
    if (q > of->kept) by_q += by_uncut, cut->kept -= by_uncut;
    cut->whole += by_whole;
    *weight += by_q;
}

/// ewa_reference_cover_behind(), whose value has the cotangent `covered`.
static void cover_behind_pull_back(const ewa_reference_cover *first, const ewa_reference_cover *behind, double covered,
                                   ewa_reference_cover *of_first, ewa_reference_cover *of_behind) {
    const double along = first->inward[0] * behind->inward[0] + first->inward[1] * behind->inward[1];
    const double open = 1 - first->share, over = behind->share, part = fmin(1, 2 * fabs(along));
    of_behind->share += covered;
    if (!(open > 0)) return;
    const double related = along > 0 ? fmax(0, over - first->share) / open : behind->whole;
    of_behind->share -= part * covered;
    if (along > 0 && over > first->share) {
        of_behind->share += part * covered / open;
        of_first->share += part * covered * (related - 1) / open;
    } else if (!(along > 0)) {
        of_behind->whole += part * covered;
    }
    if (2 * fabs(along) >= 1) return;
    const double by_along = (along < 0 ? -2 : 2) * covered * (related - over);
    for (int c = 0; c < 2; c++) {
        of_first->inward[c] += by_along * behind->inward[c];
        of_behind->inward[c] += by_along * first->inward[c];
    }
}

/// Adds the product of two sums' channels but for weights and materials.
static double product(const ewa_reference_sums *a, const ewa_reference_sums *b) {
    return vec3_dot(a->color, b->color) + vec3_dot(a->normal_world, b->normal_world) + a->z * b->z +
           a->opacity * b->opacity;
}

static ewa_reference_sums scaled(const ewa_reference_sums *sums, double scale, double weight) {
    return (ewa_reference_sums){.weight = weight,
                                .color = vec3_scale(sums->color, scale),
                                .normal_world = vec3_scale(sums->normal_world, scale),
                                .z = sums->z * scale,
                                .opacity = sums->opacity * scale};
}

/// ewa_reference_settle().
static void settle_pull_back(const ewa_reference_gathered *surface, double unit_coverage, bool merged,
                             const ewa_reference_sums *sums, ewa_reference_gathered *to) {
    if (merged) {
        to->facing = to->is_back = *sums;
        return;
    }
    const double front = surface->facing.weight, back = surface->is_back.weight, q = front + back;
    if (!(front > 0 && back > 0)) {
        *(front > 0 ? &to->facing : &to->is_back) = *sums;
        return;
    }
    const double minimum = EWA_FRONT * unit_coverage, share = fmin(1, front / minimum);
    const double of_front = product(sums, &surface->facing) / front, of_back = product(sums, &surface->is_back) / back;
    const double by_q = sums->weight + share * of_front + (1 - share) * of_back;
    const double by_share = front < minimum ? q * (of_front - of_back) / minimum : 0;
    to->facing = scaled(sums, q * share / front, by_q + by_share - q * share * of_front / front);
    to->is_back = scaled(sums, q * (1 - share) / back, by_q - q * (1 - share) * of_back / back);
}

/// The planes that belong to the nearest surface.
static void planes_pull_back(const ewa_reference_resolve *to, const ewa_reference_values *cotangent,
                             const ewa_reference_sums *of, ewa_reference_sums *sums) {
    const double length = vec3_length(of->normal_world);
    const ewa_vec3 unit = vec3_scale(of->normal_world, length > 0 ? 1 / length : 0);
    if (length > 0)
        sums->normal_world =
            vec3_add(sums->normal_world, direction_pull_back(unit, length, vec3_load(cotangent->normal)));
    sums->z += cotangent->depth / of->weight;
    sums->weight += cotangent->coverage / to->unit_coverage - cotangent->depth * of->z / (of->weight * of->weight);
}

void ewa_reference_layers_pull_back(const ewa_reference_resolve *to, double x_px, double y_px,
                                    const ewa_reference_values *cotangent, ewa_reference_layer *layers,
                                    uint32_t layer_count, double camera[EWA_CAMERA_NUMBERS]) {
    const double minimum = to->options->edge_threshold * to->unit_coverage;
    double behind[4];
    set_background(to, behind);
    for (uint32_t i = 0; i < layer_count; i++) layers[i].cotangent = (ewa_reference_gathered){.cut.kept = 0};
    ewa_reference_cover of_first = {.share = 0};
    for (uint32_t i = layer_count; i-- > 0;) {
        ewa_reference_layer *layer = &layers[i];
        const double through = layer->through;
        const double front[4] = {layer->shaded.x, layer->shaded.y, layer->shaded.z, 1};
        double by_alpha = 0;
        for (int c = 0; c < 4; c++) by_alpha += through * (front[c] - behind[c]) * cotangent->rgba[c];
        put_over(layer, behind);
        ewa_reference_sums sums = {.weight = 0};
        shade_pull_back(to, x_px, y_px, layer,
                        vec3_scale(vec3_load(cotangent->rgba), through * layer->alpha), &sums, camera);
        if (layer->merged) {
            double by_coverage;
            ewa_reference_merged_alpha_pull_back(layer->single, layer->sums.weight / to->unit_coverage, by_alpha, &by_alpha,
                                                 &by_coverage);
            sums.weight += by_coverage / to->unit_coverage;
        }
        double covered = by_alpha;
        if (to->layering.transparent) {
            const double opacity = to->options->opacity / layer->sums.weight;
            covered *= opacity * layer->sums.opacity;
            sums.opacity += by_alpha * layer->covered * opacity;
            sums.weight -= by_alpha * layer->covered * opacity * layer->sums.opacity / layer->sums.weight;
        }
        if (i == 0) planes_pull_back(to, cotangent, &layer->sums, &sums);
        ewa_reference_cover of_cover = {.share = 0};
        if (i == 0) of_cover = of_first;
        if (i == 0 || to->layering.transparent)
            of_cover.share += covered;
        else
            cover_behind_pull_back(&layers[0].cover, &layer->cover, covered, &of_first, &of_cover);
        if (to->options->edge_antialiasing)
            cover_pull_back(&layer->gathered, minimum, layer->merged, &of_cover, &sums.weight, &layer->cotangent.cut);
        settle_pull_back(&layer->gathered, to->unit_coverage, layer->merged, &sums, &layer->cotangent);
    }
}
