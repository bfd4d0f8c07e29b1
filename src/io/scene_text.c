// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scene files, the outer side: JSON text to members with their places.
#include "io/scene_text.h"
#include "base/base.h"
#include "io/number.h"
#include "io/reader.h"

#include <stdio.h>
#include <string.h>

enum { VERSION = 1 };

static const char *const groups[] = {NULL, "surfels", "lod", "render", "gaussians", "volumes"};

bool ewa_scene_text_probe(const uint8_t *bytes, size_t size_bytes) {
    static const char first[] = "{\"ewa_scene\"";
    size_t have = 0;
    for (size_t i = ewa_bytes_mark(bytes, size_bytes); i < size_bytes && have < sizeof first - 1; i++) {
        const uint8_t c = bytes[i];
        if (have < 2 && (c == ' ' || c == '\t' || c == '\r' || c == '\n')) continue;
        if (c != (uint8_t)first[have++]) return false;
    }
    return have == sizeof first - 1;
}

void ewa_scene_text_place(const ewa_scene_member *member, char place[EWA_SCENE_PLACE_BYTES]) {
    const char *name = member->name ? member->name : "", *dot = member->name ? "." : "";
    switch (member->section) {
    case EWA_SCENE_OPTIONS:
        snprintf(place, EWA_SCENE_PLACE_BYTES, "options.%.60s", name);
        return;
    case EWA_SCENE_LIGHT:
        snprintf(place, EWA_SCENE_PLACE_BYTES, "options.lights[%u]%s%.50s", member->index, dot, name);
        return;
    case EWA_SCENE_SECTION_PLANE:
        snprintf(place, EWA_SCENE_PLACE_BYTES, "options.section_planes[%u]", member->index);
        return;
    case EWA_SCENE_REGION:
        snprintf(place, EWA_SCENE_PLACE_BYTES, "options.regions[%u]%s%.50s", member->index, dot, name);
        return;
    case EWA_SCENE_MEASURE:
        snprintf(place, EWA_SCENE_PLACE_BYTES, "measures[%u]%s%.60s", member->index, dot, name);
        return;
    case EWA_SCENE_ITEM:
        snprintf(place, EWA_SCENE_PLACE_BYTES, "items[%u]%s%.60s", member->index, dot, name);
        return;
    default:
        snprintf(place, EWA_SCENE_PLACE_BYTES, "options.%s.%.60s", groups[member->section], name);
    }
}

static ewa_status fail(const ewa_scene_text *text, const ewa_scene_member *at, const char *what) {
    char place[EWA_SCENE_PLACE_BYTES];
    ewa_scene_text_place(at, place);
    return ewa_fail(text->context, EWA_ERROR_FORMAT, "%s: %s: %s", text->name, place, what);
}

static ewa_status put(ewa_scene_text *text, const char *chars, size_t length) {
    if (!length) return EWA_OK;
    ewa_buffer buffer = {text->values, text->values_bytes};
    const ewa_status status =
        ewa_buffer_grow(text->context, &buffer, text->values_size, text->values_size + length, 1);
    text->values = buffer.data;
    text->values_bytes = buffer.capacity_bytes;
    EWA_TRY(status);
    memcpy(text->values + text->values_size, chars, length);
    text->values_size += length;
    return EWA_OK;
}

/// Writes a string, a number or a switch; `*known` says whether it is one.
static ewa_status put_single(ewa_scene_text *text, const cJSON *value, bool *known) {
    char number[EWA_NUMBER_BYTES];
    *known = true;
    if (cJSON_IsString(value)) return put(text, value->valuestring, strlen(value->valuestring));
    if (cJSON_IsBool(value)) return cJSON_IsTrue(value) ? put(text, "on", 2) : put(text, "off", 3);
    if (cJSON_IsNumber(value)) return put(text, number, ewa_number_write_f64(value->valuedouble, number));
    *known = false;
    return EWA_OK;
}

/// Adds a member, whose value is a single one or an array of such.
static ewa_status add(ewa_scene_text *text, ewa_scene_section section, uint32_t index, const cJSON *item) {
    ewa_buffer buffer = {text->members, text->members_bytes};
    ewa_status status = ewa_buffer_grow(text->context, &buffer, text->member_count, text->member_count + 1,
                                        sizeof *text->members);
    text->members = buffer.data;
    text->members_bytes = buffer.capacity_bytes;
    EWA_TRY(status);
    const ewa_scene_member member = {section, index, item->string, text->values_size};
    text->members[text->member_count++] = member;
    bool known = true;
    if (!cJSON_IsArray(item)) {
        EWA_TRY(put_single(text, item, &known));
    } else {
        const cJSON *value;
        cJSON_ArrayForEach(value, item) {
            if (status == EWA_OK && value != item->child) status = put(text, ",", 1);
            if (status == EWA_OK) status = put_single(text, value, &known);
            if (status != EWA_OK || !known) break;
        }
    }
    if (status == EWA_OK && !known)
        return fail(text, &member, "is neither a text, a number, true or false, nor an array of these");
    return status == EWA_OK ? put(text, "", 1) : status;
}

/// Adds all members of an object; none may stand in it twice.
static ewa_status add_object(ewa_scene_text *text, ewa_scene_section section, uint32_t index,
                             const cJSON *object) {
    const size_t first = text->member_count;
    if (!cJSON_IsObject(object)) {
        const ewa_scene_member at = {section, index, section == EWA_SCENE_ITEM || section == EWA_SCENE_MEASURE ? NULL : object->string, 0};
        return fail(text, &at, "is no object");
    }
    ewa_status status = EWA_OK;
    const cJSON *item;
    cJSON_ArrayForEach(item, object) {
        status = add(text, section, index, item);
        for (size_t i = first; i + 1 < text->member_count && status == EWA_OK; i++)
            if (strcmp(text->members[i].name, item->string) == 0)
                status = fail(text, &text->members[i], "is there twice");
        // No section has as many members; the square above stays small.
        if (status == EWA_OK && text->member_count - first > 256)
            status = fail(text, &text->members[first + 256], "is one member too many");
        if (status != EWA_OK) break;
    }
    return status;
}

static ewa_status read_list(ewa_scene_text *text, ewa_scene_section section, const cJSON *list,
                            uint32_t *count) {
    const ewa_scene_member at = {EWA_SCENE_OPTIONS, 0, list->string, 0};
    if (!cJSON_IsArray(list)) return fail(text, &at, "is no array");
    const cJSON *item;
    cJSON_ArrayForEach(item, list) {
        if (*count == EWA_SCENE_FILE_ITEMS)
            return ewa_fail(text->context, EWA_ERROR_LIMIT, "%s: '%s' has more than %d members", text->name,
                            list->string, EWA_SCENE_FILE_ITEMS);
        const ewa_scene_member plane = {section, *count, NULL, 0};
        if (section == EWA_SCENE_SECTION_PLANE && !cJSON_IsArray(item))
            return fail(text, &plane, "is no array");
        else if (section == EWA_SCENE_SECTION_PLANE)
            EWA_TRY(add(text, section, *count, item));
        else
            EWA_TRY(add_object(text, section, *count, item));
        (*count)++;
    }
    return EWA_OK;
}

static ewa_status read_options(ewa_scene_text *text, const cJSON *options) {
    if (!cJSON_IsObject(options))
        return ewa_fail(text->context, EWA_ERROR_FORMAT, "%s: options: is no object", text->name);
    ewa_status status = EWA_OK;
    const cJSON *item;
    cJSON_ArrayForEach(item, options) {
        ewa_scene_section section = EWA_SCENE_OPTIONS;
        for (int g = 1; g < (int)(sizeof groups / sizeof groups[0]); g++)
            if (strcmp(item->string, groups[g]) == 0) section = (ewa_scene_section)g;
        if (strcmp(item->string, "lights") == 0)
            status = read_list(text, EWA_SCENE_LIGHT, item, &text->light_count);
        else if (strcmp(item->string, "section_planes") == 0)
            status = read_list(text, EWA_SCENE_SECTION_PLANE, item, &text->section_count);
        else if (strcmp(item->string, "regions") == 0)
            status = read_list(text, EWA_SCENE_REGION, item, &text->region_count);
        else if (section != EWA_SCENE_OPTIONS)
            status = add_object(text, section, 0, item);
        else
            status = add(text, section, 0, item);
        if (status != EWA_OK) break;
    }
    return status;
}

/// Keyframes are a list of cameras, as ewa_camera_save_list() writes it.
static ewa_status read_keyframes(ewa_scene_text *text, const cJSON *item) {
    if (!cJSON_IsArray(item)) return ewa_fail(text->context, EWA_ERROR_FORMAT, "%s: keyframes: is no array", text->name);
    text->keyframes = (ewa_camera_list){.context = text->context, .name = text->name};
    if (!item->child) return EWA_OK;
    return ewa_camera_list_read_tree(&text->keyframes, item);
}

/// A camera is one of our format, as ewa_camera_save() writes it.
static ewa_status read_camera(ewa_scene_text *text, const cJSON *item) {
    ewa_camera_list list = {.context = text->context, .name = text->name};
    ewa_status status = EWA_OK;
    if (!cJSON_IsObject(item))
        status = ewa_fail(text->context, EWA_ERROR_FORMAT, "%s: camera: is no object", text->name);
    else
        status = ewa_camera_list_read_tree(&list, item);
    if (status == EWA_OK && list.count != 1)
        status = ewa_fail(text->context, EWA_ERROR_FORMAT, "%s: camera: holds %zu cameras", text->name,
                          list.count);
    if (status == EWA_OK) text->camera = list.cameras[0];
    text->has_camera = status == EWA_OK;
    ewa_camera_list_free(&list);
    return status;
}

static ewa_status read_root(ewa_scene_text *text, const cJSON *root) {
    const cJSON *version = cJSON_GetObjectItemCaseSensitive(root, "ewa_scene");
    if (!cJSON_IsNumber(version))
        return ewa_fail(text->context, EWA_ERROR_FORMAT,
                        "%s: no scene: the member 'ewa_scene', a number, is missing", text->name);
    if (version->valuedouble != VERSION)
        return ewa_fail(text->context, EWA_ERROR_UNSUPPORTED, "%s: ewa_scene is %g; this version reads %d",
                        text->name, version->valuedouble, VERSION);
    ewa_status status = EWA_OK;
    const cJSON *item;
    enum { NAME_COUNT = 6 };
    bool seen[NAME_COUNT] = {false};
    static const char *const names[NAME_COUNT] = {"ewa_scene", "options", "camera", "items", "measures", "keyframes"};
    cJSON_ArrayForEach(item, root) {
        int which = 0;
        while (which < NAME_COUNT && strcmp(item->string, names[which]) != 0) which++;
        if (which == NAME_COUNT || seen[which])
            return ewa_fail(text->context, EWA_ERROR_FORMAT, "%s: member '%.60s' %s", text->name, item->string,
                            which == NAME_COUNT ? "is none of ewa_scene, options, camera, items, measures, keyframes" : "is there twice");
        seen[which] = true;
        if (which == 1) status = read_options(text, item);
        if (which == 2) status = read_camera(text, item);
        if (which == 3) status = read_list(text, EWA_SCENE_ITEM, item, &text->item_count);
        if (which == 4) status = read_list(text, EWA_SCENE_MEASURE, item, &text->measure_count);
        if (which == 5) status = read_keyframes(text, item);
        EWA_TRY(status);
    }
    return EWA_OK;
}

ewa_status ewa_scene_text_read(ewa_context *context, const char *name, const uint8_t *bytes,
                               size_t size_bytes, ewa_scene_text *text) {
    *text = (ewa_scene_text){.context = context, .name = name};
    if (size_bytes > EWA_SCENE_FILE_BYTES)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%s: %zu bytes, more than a scene file may have (%d)", name,
                        size_bytes, EWA_SCENE_FILE_BYTES);
    EWA_TRY(ewa_json_parse(context, name, "a scene file", bytes, size_bytes, &text->tree));
    ewa_status status = read_root(text, text->tree.root);
    if (status != EWA_OK) ewa_scene_text_free(text);
    return status;
}

void ewa_scene_text_free(ewa_scene_text *text) {
    ewa_release(text->context, text->members, text->members_bytes, 1);
    ewa_release(text->context, text->values, text->values_bytes, 1);
    ewa_json_free(text->context, &text->tree);
    if (text->keyframes.context) ewa_camera_list_free(&text->keyframes);
    *text = (ewa_scene_text){.context = NULL};
}
