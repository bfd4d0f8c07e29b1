// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Buffer views of glTF that meshoptimizer has packed: what the extension says is checked, its decoders do the rest.
//
// Based on: A. Kapoulkine, D. McCurdy, "EXT_meshopt_compression", 2020, and its draft of Khronos with the same name for
// its members.
#include "base/base.h"
#include "base/unpacking.h"
#include "io/mesh/gltf.h"

#include <meshoptimizer.h>

enum { MAX_STRIDE = 256, MAX_RATIO = 64 };

/// What a view says of its packed bytes.
typedef struct packed_view {
    const uint8_t *bytes;
    uint64_t size_bytes, stride, count;
    const char *mode, *filter;
} packed_view;

static const char *word_of(const cJSON *object, const char *name, const char *otherwise) {
    const cJSON *word = ewa_gltf_member(object, name);
    return cJSON_IsString(word) ? word->valuestring : otherwise;
}

static bool is_filter(const packed_view *view, const char *name) { return strcmp(view->filter, name) == 0; }

/// What is wrong with it; NULL: nothing. The decoders take for granted what is checked here, and few bytes must not claim
/// to be many: a byte of a block of vertices takes two bits for 16 of them at least, an index a third of a byte.
static const char *find_problem(const packed_view *view) {
    uint64_t all;
    if (__builtin_mul_overflow(view->count, view->stride, &all)) return "count is too large";
    if (strcmp(view->mode, "ATTRIBUTES") == 0) {
        if (view->stride == 0 || view->stride > MAX_STRIDE || view->stride % 4)
            return "byteStride is not 4, 8 .. 256";
        if (all / MAX_RATIO > view->size_bytes) return "it is shorter than so many vertices";
        if (is_filter(view, "OCTAHEDRAL"))
            return view->stride == 4 || view->stride == 8 ? NULL : "byteStride is not 4 or 8";
        if (is_filter(view, "QUATERNION")) return view->stride == 8 ? NULL : "byteStride is not 8";
        return is_filter(view, "NONE") || is_filter(view, "EXPONENTIAL") ? NULL : "its filter is not known";
    }
    const bool triangles = strcmp(view->mode, "TRIANGLES") == 0;
    if (!triangles && strcmp(view->mode, "INDICES") != 0) return "its mode is not known";
    if (view->stride != 2 && view->stride != 4) return "byteStride of indices is not 2 or 4";
    if (triangles && view->count % 3) return "count is no multiple of 3";
    if (!is_filter(view, "NONE")) return "indices have a filter";
    return view->count / (triangles ? 3 : 1) > view->size_bytes ? "it is shorter than so many indices" : NULL;
}

/// Decodes; false when the bytes are no such stream.
static bool decode(const packed_view *view, uint8_t *to) {
    const size_t count = (size_t)view->count, stride = (size_t)view->stride, size = (size_t)view->size_bytes;
    if (strcmp(view->mode, "TRIANGLES") == 0)
        return meshopt_decodeIndexBuffer(to, count, stride, view->bytes, size) == 0;
    if (strcmp(view->mode, "INDICES") == 0)
        return meshopt_decodeIndexSequence(to, count, stride, view->bytes, size) == 0;
    if (meshopt_decodeVertexBuffer(to, count, stride, view->bytes, size) != 0) return false;
    if (is_filter(view, "OCTAHEDRAL")) meshopt_decodeFilterOct(to, count, stride);
    if (is_filter(view, "QUATERNION")) meshopt_decodeFilterQuat(to, count, stride);
    if (is_filter(view, "EXPONENTIAL")) meshopt_decodeFilterExp(to, count, stride);
    return true;
}

ewa_status ewa_gltf_unpack_view(gltf *g, uint64_t index, const cJSON *packed, const uint8_t *bytes,
                                uint64_t size_bytes, uint64_t stride, gltf_buffer *unpacked) {
    packed_view view = {.bytes = bytes,
                        .size_bytes = size_bytes,
                        .stride = stride,
                        .mode = word_of(packed, "mode", ""),
                        .filter = word_of(packed, "filter", "NONE")};
    if (!ewa_gltf_count(packed, "count", 0, &view.count))
        return ewa_gltf_fail(g, "bufferViews", index, "count of its packed bytes is no count");
    const char *problem = find_problem(&view);
    if (problem) return ewa_gltf_fail(g, "bufferViews", index, problem);
    const uint64_t all = view.count * view.stride;
    EWA_TRY(ewa_memory_check_unpacked(g->build->context, size_bytes, EWA_UNPACKED_RATIO, all, "%s: bufferViews[%llu] unpacked",
                                      g->build->source->name, (unsigned long long)index));
    unpacked->decoded = ewa_allocate(g->build->context, (size_t)view.count, (size_t)view.stride);
    if (!unpacked->decoded) return EWA_ERROR_MEMORY;
    unpacked->decoded_room = (size_t)all;
    if (!decode(&view, unpacked->decoded))
        return ewa_gltf_fail(g, "bufferViews", index,
                             "its packed bytes are broken, or of a newer version of meshoptimizer's codec");
    unpacked->bytes = unpacked->decoded;
    unpacked->size_bytes = (size_t)all;
    unpacked->opened = true;
    ewa_gltf_grant(g, all);
    return EWA_OK;
}
