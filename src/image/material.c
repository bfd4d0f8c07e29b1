// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Defaults of lights and materials, and the ranges of a material's numbers.
#include "image/material.h"
#include "base/base.h"

#include <stddef.h>

const ewa_material_member ewa_material_members[EWA_MATERIAL_MEMBERS] = {
    {"ambient", offsetof(ewa_material, ambient), 0, 1000},
    {"diffuse", offsetof(ewa_material, diffuse), 0, 1000},
    {"specular", offsetof(ewa_material, specular), 0, 1000},
    {"shininess", offsetof(ewa_material, shininess), 1, 65536},
    {"reflection", offsetof(ewa_material, reflection), 0, 1000},
};

ewa_status ewa_material_check(ewa_context *context, const char *where, uint32_t index,
                              const ewa_material *material) {
    for (int i = 0; i < EWA_MATERIAL_MEMBERS; i++) {
        const ewa_material_member *member = &ewa_material_members[i];
        const double value = (double)*(const float *)(const void *)((const char *)material + member->offset);
        if (!(value >= member->least && value <= member->most))
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: %s of material %u is %g, allowed is [%g, %g]",
                            where, member->name, index, value, member->least, member->most);
    }
    return EWA_OK;
}

void ewa_material_init(ewa_material *material) {
    if (!material) return;
    *material = (ewa_material){
        .ambient = 0.15f, .diffuse = 0.85f, .specular = 0.3f, .shininess = 32, .reflection = 0.25f};
}

void ewa_light_init(ewa_light *light) {
    if (!light) return;
    *light = (ewa_light){.color = {1, 1, 1}};
}
