// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Primitives of glTF that Draco has packed: which numbers of its mesh stand for which accessor's.
//
// Based on: The Khronos 3D Formats Working Group, "KHR_draco_mesh_compression", 2018.
#include "base/base.h"
#include "io/mesh/draco.h"
#include "io/mesh/gltf.h"

#include <math.h>

enum {
    REASON_BYTES = 128,
    ITEM_BYTES = 160, // that Draco holds for a face or a vertex while it decodes: corners, maps, numbers
};

struct gltf_packed {
    ewa_draco *mesh;
    const cJSON *attributes; ///< ids by name
    uint64_t held_bytes;     ///< by Draco
};

static ewa_status count_of(const gltf *g, uint64_t accessor, uint64_t *count) {
    if (accessor >= g->accessors.count || !ewa_gltf_count(g->accessors.items[accessor], "count", 0, count))
        return ewa_gltf_fail(g, "accessors", accessor, "it has no count");
    return EWA_OK;
}

ewa_status ewa_gltf_open_packed(gltf *g, uint64_t mesh, const cJSON *item, uint64_t positions,
                                uint64_t indices, gltf_packed **packed) {
    *packed = NULL;
    const cJSON *extension = ewa_gltf_extension(item, "KHR_draco_mesh_compression");
    if (!extension) return EWA_OK;
    ewa_context *context = g->build->context;
    uint64_t view, size_bytes, stride, points, corners;
    const uint8_t *bytes;
    char reason[REASON_BYTES] = "";
    if (!ewa_gltf_count(extension, "bufferView", UINT64_MAX, &view))
        return ewa_gltf_fail(g, "meshes", mesh, "bufferView of its Draco extension is wrong");
    EWA_TRY(count_of(g, positions, &points));
    EWA_TRY(count_of(g, indices, &corners));
    EWA_TRY(ewa_gltf_spend(g, points + corners)); // before the decoder makes room for them
    EWA_TRY(ewa_gltf_view(g, view, &bytes, &size_bytes, &stride));
    gltf_packed *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->attributes = ewa_gltf_member(extension, "attributes");
    made->held_bytes = ITEM_BYTES * (points + corners / 3);
    const ewa_status room = ewa_memory_take(context, made->held_bytes, "%s: a Draco mesh of %llu vertices",
                                            g->build->source->name, (unsigned long long)points);
    if (room != EWA_OK) {
        ewa_release(context, made, 1, sizeof *made);
        return room;
    }
    const ewa_draco_result result =
        ewa_draco_open(bytes, (size_t)size_bytes, corners / 3, points, &made->mesh, reason, sizeof reason);
    if (result == EWA_DRACO_DONE) {
        *packed = made;
        return EWA_OK;
    }
    ewa_memory_give(context, made->held_bytes);
    ewa_release(context, made, 1, sizeof *made);
    if (result == EWA_DRACO_MEMORY)
        return ewa_fail(context, EWA_ERROR_MEMORY, "%s: out of memory for what Draco has packed",
                        g->build->source->name);
    return ewa_gltf_fail(g, "meshes", mesh, reason);
}

void ewa_gltf_close_packed(const gltf *g, gltf_packed **packed) {
    if (!*packed) return;
    ewa_draco_close(&(*packed)->mesh);
    ewa_memory_give(g->build->context, (*packed)->held_bytes);
    ewa_release(g->build->context, *packed, 1, sizeof **packed);
    *packed = NULL;
}

bool ewa_gltf_packed_has(const gltf_packed *packed, const char *name) {
    return packed && ewa_gltf_member(packed->attributes, name);
}

ewa_status ewa_gltf_packed_attribute(gltf *g, uint64_t mesh, const gltf_packed *packed, const char *name,
                                     uint64_t accessor, uint32_t low, uint32_t high, gltf_array *array) {
    uint64_t id;
    gltf_numbers form;
    gltf_array made;
    *array = (gltf_array){0};
    EWA_TRY(ewa_gltf_describe(g, accessor, low, high, &made, &form));
    made.count = ewa_draco_points(packed->mesh);
    EWA_TRY(ewa_gltf_spend(g, made.count));
    made.numbers = ewa_allocate_zeroed(g->build->context, made.count, made.components * sizeof *made.numbers);
    if (!made.numbers) return EWA_ERROR_MEMORY;
    if (!ewa_gltf_count(packed->attributes, name, UINT64_MAX, &id) || id > UINT32_MAX ||
        !ewa_draco_attribute(packed->mesh, (uint32_t)id, made.components, made.numbers)) {
        ewa_gltf_free_array(g, &made);
        return ewa_gltf_fail(g, "meshes", mesh, "its Draco mesh has no such attribute");
    }
    for (uint64_t i = 0; i < made.count * made.components; i++)
        made.numbers[i] = fmax(made.numbers[i] * form.share, form.lowest);
    *array = made;
    return EWA_OK;
}

ewa_status ewa_gltf_packed_indices(gltf *g, const gltf_packed *packed, gltf_array *array) {
    gltf_array made = {.count = 3 * ewa_draco_faces(packed->mesh), .components = 1};
    *array = (gltf_array){0};
    EWA_TRY(ewa_gltf_spend(g, made.count));
    made.numbers = ewa_allocate_zeroed(g->build->context, made.count, sizeof *made.numbers);
    if (!made.numbers) return EWA_ERROR_MEMORY;
    ewa_draco_corners(packed->mesh, made.numbers);
    *array = made;
    return EWA_OK;
}
