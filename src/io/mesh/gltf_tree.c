// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The members of a glTF file's tree, messages about them, and how much may be made of a file.
//
// Based on: "glTF 2.0 Specification", section 3 (concepts).
#include "base/base.h"
#include "io/mesh/gltf.h"

#include <math.h>

enum {
    MAX_MEMBERS = 128,   // of an object that are looked at
    ITEMS_PER_BYTE = 32, // that may be made of a file, for each byte that it and its buffers have
    ITEM_BYTES = 4,      // that an item takes at least in a mesh
};

ewa_status ewa_gltf_fail(const gltf *g, const char *array, uint64_t index, const char *what) {
    return ewa_fail(g->build->context, EWA_ERROR_FORMAT, "%s: %s[%llu]: %s", g->build->source->name, array,
                    (unsigned long long)index, what);
}

const cJSON *ewa_gltf_member(const cJSON *object, const char *name) {
    const cJSON *member = cJSON_IsObject(object) ? object->child : NULL;
    for (int i = 0; member && i < MAX_MEMBERS; i++, member = member->next)
        if (member->string && strcmp(member->string, name) == 0) return member;
    return NULL;
}

void ewa_gltf_grant(gltf *g, uint64_t size_bytes) {
    // More than that no mesh within the limit has, however often a buffer is named.
    const uint64_t maximum = ewa_context_limits(g->build->context)->max_memory_bytes / ITEM_BYTES;
    const uint64_t room = maximum > g->items_granted ? maximum - g->items_granted : 0;
    const uint64_t items = size_bytes < room / ITEMS_PER_BYTE ? size_bytes * ITEMS_PER_BYTE : room;
    g->items_granted += items;
    g->items_left += items;
}

ewa_status ewa_gltf_spend(gltf *g, uint64_t item_count) {
    if (item_count > g->items_left)
        return ewa_fail(g->build->context, EWA_ERROR_LIMIT,
                        "%s: more vertices and corners than a file of %zu bytes and its buffers may have",
                        g->build->source->name, g->build->source->size_bytes);
    g->items_left -= item_count;
    return EWA_OK;
}

const cJSON *ewa_gltf_extension(const cJSON *object, const char *extension) {
    return ewa_gltf_member(ewa_gltf_member(object, "extensions"), extension);
}

bool ewa_gltf_count(const cJSON *object, const char *name, uint64_t otherwise, uint64_t *value) {
    const cJSON *member = ewa_gltf_member(object, name);
    *value = otherwise;
    if (!member) return true;
    if (!cJSON_IsNumber(member) || !(member->valuedouble >= 0 && member->valuedouble <= 0x1p53) ||
        member->valuedouble != floor(member->valuedouble))
        return false;
    *value = (uint64_t)member->valuedouble;
    return true;
}

bool ewa_gltf_numbers(const cJSON *object, const char *name, uint32_t count, double *values) {
    const cJSON *array = ewa_gltf_member(object, name);
    if (!array) return true;
    if (!cJSON_IsArray(array)) return false;
    uint32_t i = 0;
    const cJSON *item;
    cJSON_ArrayForEach(item, array) {
        if (i == count || !cJSON_IsNumber(item)) return false;
        values[i++] = item->valuedouble;
    }
    return i == count;
}

// ---- nodes
