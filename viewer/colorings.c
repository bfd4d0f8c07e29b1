// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How items are coloured and shown: as scene files say, as the program says for all, as a person wishes.
#include "inner.h"

#include <stdio.h>
#include <string.h>

void colorings_take(const ewa_coloring *coloring, viewer_coloring *wish) {
    memcpy(wish->attribute, coloring->attribute, sizeof wish->attribute);
    wish->map = coloring->map;
    wish->ranged = coloring->ranged;
    memcpy(wish->range, coloring->range, sizeof wish->range);
    memcpy(wish->percent, coloring->percent, sizeof wish->percent);
    wish->tinted = coloring->tinted;
    memcpy(wish->tint, coloring->tint, sizeof wish->tint);
}

void colorings_take_instance(const ewa_instance *instance, scene_item *item) {
    const ewa_coloring *said = &instance->coloring;
    item->visible = instance->visible;
    item->material = instance->material;
    if (said->tinted || said->attribute[0]) colorings_take(said, &item->wish);
    item->wish.alpha = instance->opacity;
    item->wish.radius_scale = instance->radius_scale;
}

ewa_instance colorings_instance(const scene_item *item) {
    ewa_instance instance;
    ewa_asset_info info;
    ewa_instance_init(&instance, sizeof instance);
    ewa_asset_describe(item->asset, &info);
    instance.visible = item->visible;
    if (!info.colorable) return instance;
    const viewer_coloring *wish = &item->wish;
    memcpy(instance.coloring.attribute, wish->attribute, sizeof instance.coloring.attribute);
    instance.coloring.map = wish->map;
    instance.coloring.ranged = wish->ranged;
    memcpy(instance.coloring.percent, wish->percent, sizeof instance.coloring.percent);
    memcpy(instance.coloring.range, wish->range, sizeof instance.coloring.range);
    instance.coloring.tinted = wish->tinted;
    memcpy(instance.coloring.tint, wish->tint, sizeof instance.coloring.tint);
    if (!info.changeable) return instance;
    instance.material = item->material;
    instance.opacity = wish->alpha;
    instance.radius_scale = wish->radius_scale;
    return instance;
}

void colorings_take_legend(const ewa_legend *legend, viewer_coloring *coloring) {
    coloring->class_count = 0;
    if (!legend) return;
    memcpy(coloring->attribute, legend->attribute, sizeof coloring->attribute);
    memcpy(coloring->range, legend->range, sizeof coloring->range);
    coloring->length = legend->length;
    coloring->percent[0] = coloring->percent[1] = false;
    for (uint32_t k = 0; k < legend->category_count && k < VIEWER_MAX_CLASSES; k++) {
        viewer_class *to = &coloring->classes[coloring->class_count++];
        to->value = legend->categories[k].value;
        memcpy(to->srgb, legend->categories[k].srgb, sizeof to->srgb);
        snprintf(to->name, sizeof to->name, "%s", legend->categories[k].name ? legend->categories[k].name : "");
    }
}

bool colorings_is_program(const viewer *v, const viewer_coloring *wish) {
    return wish->attribute[0] && strcmp(wish->attribute, v->coloring.attribute) == 0;
}
