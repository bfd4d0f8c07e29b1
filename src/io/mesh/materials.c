// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Material tables from JSON. Members are checked by name, so that a misspelt one is not taken for a default.
#include "io/mesh/materials.h"
#include "base/base.h"
#include "base/options.h"
#include "ewa/io.h"
#include "image/material.h"
#include "io/file.h"
#include "io/json_text.h"
#include "io/text.h"

#include <string.h>

static ewa_status read_member(ewa_context *context, const char *name, uint32_t index, const cJSON *item,
                              ewa_material *material) {
    if (strcmp(item->string, "name") == 0) return EWA_OK;
    const ewa_option *member = ewa_option_find(&ewa_material_table, item->string);
    if (member && !cJSON_IsNumber(item))
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: %s of material %u is not a number", name,
                        member->name, index);
    if (member) {
        ewa_option_put(member, material, 0, item->valuedouble);
        return EWA_OK;
    }
    char quote[EWA_QUOTE_BYTES];
    return ewa_fail(context, EWA_ERROR_FORMAT, "%s: material %u has an unknown member %s", name, index,
                    ewa_quote((ewa_text){item->string, strlen(item->string)}, quote));
}

static ewa_status read_material(ewa_context *context, const char *name, uint32_t index, const cJSON *object,
                                ewa_material *material) {
    ewa_material_init(material);
    if (!cJSON_IsObject(object))
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: material %u is not an object", name, index);
    const cJSON *item;
    cJSON_ArrayForEach(item, object) { EWA_TRY(read_member(context, name, index, item, material)); }
    return ewa_material_check(context, name, index, material) == EWA_OK ? EWA_OK : EWA_ERROR_FORMAT;
}

ewa_status ewa_materials_read(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                              ewa_material materials[EWA_MAX_MATERIALS], uint32_t *count) {
    *count = 0;
    ewa_json json;
    EWA_TRY(ewa_json_parse(context, name, "a material table", bytes, size_bytes, &json));
    const cJSON *root = json.root;
    const cJSON *list = cJSON_IsObject(root) ? cJSON_GetObjectItemCaseSensitive(root, "materials") : root;
    ewa_status status = EWA_OK;
    if (!cJSON_IsArray(list) || !list->child)
        status = ewa_fail(context, EWA_ERROR_FORMAT,
                          "%s: neither an array of materials nor an object with one, 'materials'", name);
    uint32_t read = 0;
    for (const cJSON *item = list ? list->child : NULL; status == EWA_OK && item; item = item->next) {
        if (read == EWA_MAX_MATERIALS)
            status =
                ewa_fail(context, EWA_ERROR_LIMIT, "%s: more than %d materials", name, EWA_MAX_MATERIALS);
        else
            status = read_material(context, name, read, item, &materials[read]);
        read++;
    }
    ewa_json_free(context, &json);
    if (status == EWA_OK) *count = read;
    return status;
}

ewa_status ewa_materials_load(ewa_context *context, const char *path,
                              ewa_material materials[EWA_MAX_MATERIALS], uint32_t *count) {
    if (!context || !path || !materials || !count) return EWA_ERROR_ARGUMENT;
    *count = 0;
    ewa_file file;
    EWA_TRY(ewa_file_map(context, path, &file));
    ewa_status status = ewa_materials_read(context, path, file.bytes, file.size_bytes, materials, count);
    ewa_file_unmap(context, &file);
    return status;
}
