// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Defaults of lights and materials, and the ranges of a material's numbers.
#include "image/material.h"
#include "base/base.h"
#include "base/options.h"

#include <stddef.h>

#define AT(member) offsetof(ewa_material, member)

static const ewa_option material_rows[] = {
    {"ambient", EWA_OPTION_F32, AT(ambient), 0, 1000, .initial = 0.15, .help = "light from everywhere"},
    {"diffuse", EWA_OPTION_F32, AT(diffuse), 0, 1000, .initial = 0.85,
     .help = "light from the lights, in all directions"},
    {"specular", EWA_OPTION_F32, AT(specular), 0, 1000, .initial = 0.3,
     .help = "strength of the highlights, which have the light's colour"},
    {"shininess", EWA_OPTION_F32, AT(shininess), 1, 65536, .initial = 32,
     .help = "exponent of the highlights"},
    {"reflection", EWA_OPTION_F32, AT(reflection), 0, 1000, .initial = 0.25,
     .help = "strength of the environment's mirror image"},
};

const ewa_option_table ewa_material_table = EWA_OPTION_TABLE(ewa_material, material_rows);

ewa_status ewa_material_check(ewa_context *context, const char *where, uint32_t index,
                              const ewa_material *material) {
    for (size_t i = 0; i < ewa_material_table.option_count; i++) {
        const ewa_option *member = &material_rows[i];
        const double value = ewa_option_number(member, material, 0);
        char range[EWA_OPTION_TEXT_BYTES];
        ewa_option_range(member, range);
        if (!ewa_option_allows(member, value))
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: %s of material %u is %g, allowed is %s", where,
                            member->name, index, value, range);
    }
    return EWA_OK;
}

void ewa_material_init(ewa_material *material) {
    ewa_options_init(&ewa_material_table, material, sizeof *material);
}

void ewa_light_init(ewa_light *light) {
    if (!light) return;
    *light = (ewa_light){.color = {1, 1, 1}};
}
