// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From splats to a pixel's surface in double precision: separate sums of front- and back-facing splats and of
// what clip lines cut (docs/math.md sections 6 to 8).
#include "reference/sums.h"
#include "surface/semantics.h"

static void add_scaled(ewa_reference_sums *to, const ewa_reference_sums *from, double scale) {
    to->weight += scale * from->weight;
    to->color = vec3_add(to->color, vec3_scale(from->color, scale));
    to->normal_world = vec3_add(to->normal_world, vec3_scale(from->normal_world, scale));
    to->z += scale * from->z;
    to->opacity += scale * from->opacity;
    for (int i = 0; i < 5; i++) to->material[i] += scale * from->material[i];
}

void ewa_reference_gather(ewa_reference_gathered *to, const ewa_reference_splat *splat,
                          const ewa_reference_sample *sample, double weight, double opacity,
                          const float material[5]) {
    ewa_reference_sums one = {.weight = 1,
                              .color = vec3_scale(splat->color, opacity),
                              .normal_world = splat->normal_world,
                              .z = sample->z,
                              .opacity = opacity};
    for (int i = 0; i < 5; i++) one.material[i] = (double)material[i];
    add_scaled(splat->is_back ? &to->is_back : &to->facing, &one, weight);
    const double cut = fmin(1, (1 - sample->share) / EWA_CUT), whole = cut * weight / sample->share;
    to->cut.kept += cut * weight;
    to->cut.whole += whole;
    for (int c = 0; c < 2; c++) to->cut.inward[c] += whole * sample->inward[c];
}

ewa_reference_sums ewa_reference_settle(const ewa_reference_gathered *surface, double unit_coverage,
                                        bool merged) {
    const double front = surface->facing.weight, back = surface->is_back.weight;
    const double share = back > 0 ? fmin(1, front / (EWA_FRONT * unit_coverage)) : 1;
    ewa_reference_sums sums = {.weight = 0};
    if (front > 0) add_scaled(&sums, &surface->facing, merged ? 1 : (front + back) * share / front);
    if (back > 0) add_scaled(&sums, &surface->is_back, merged ? 1 : (front + back) * (1 - share) / back);
    return sums;
}

ewa_reference_cover ewa_reference_cover_of(const ewa_reference_gathered *surface, double unit_coverage,
                                           double threshold, bool merged) {
    const double q = surface->facing.weight + surface->is_back.weight, minimum = threshold * unit_coverage;
    const ewa_reference_cut *cut = &surface->cut;
    ewa_reference_cover cover = {.share = fmin(1, q / minimum), .whole = fmin(1, q / minimum)};
    if (merged || !(cut->whole > 0)) return cover;
    const double uncut = fmax(0, q - cut->kept);
    const double along = hypot(cut->inward[0], cut->inward[1]) / cut->whole;
    const double alone = fmin(fmax((along - EWA_EDGES_OPPOSE) / (EWA_EDGES_AGREE - EWA_EDGES_OPPOSE), 0), 1);
    cover.share = fmin(1, fmax(uncut / minimum, q / fmax(minimum, uncut + alone * cut->whole)));
    for (int c = 0; c < 2; c++) cover.inward[c] = cut->inward[c] / (uncut + cut->whole);
    return cover;
}

double ewa_reference_cover_behind(const ewa_reference_cover *first, const ewa_reference_cover *behind) {
    const double along = first->inward[0] * behind->inward[0] + first->inward[1] * behind->inward[1];
    const double open = 1 - first->share, over = behind->share;
    if (!(open > 0)) return over;
    const double related = along > 0 ? fmax(0, over - first->share) / open : behind->whole;
    return over + fmin(1, 2 * fabs(along)) * (related - over);
}
