// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Buffers, views and accessors of glTF: where numbers lie and how they are stored.
//
// Based on: "glTF 2.0 Specification", sections 3.6.1 and 3.6.2.
#include "base/base.h"
#include "io/mesh/base64.h"
#include "io/mesh/gltf.h"
#include "io/referenced_file.h"

#include <math.h>
#include <stdio.h>

/// Component types.
enum {
    GLTF_I8 = 5120,
    GLTF_U8 = 5121,
    GLTF_I16 = 5122,
    GLTF_U16 = 5123,
    GLTF_U32 = 5125,
    GLTF_F32 = 5126,
};

static uint32_t component_bytes(uint64_t type) {
    switch (type) {
    case GLTF_I8:
    case GLTF_U8:
        return 1;
    case GLTF_I16:
    case GLTF_U16:
        return 2;
    case GLTF_U32:
    case GLTF_F32:
        return 4;
    default:
        return 0;
    }
}

ewa_status ewa_gltf_decode_uri(const gltf *g, const char *array, uint64_t index, const char *uri,
                               uint8_t **decoded, size_t *room, size_t *size_bytes) {
    const char *comma = strchr(uri, ',');
    if (!comma || comma - uri < 7 || memcmp(comma - 7, ";base64", 7) != 0)
        return ewa_gltf_fail(g, array, index, "a data URI that is not base64");
    const size_t length = strlen(comma + 1);
    *room = ewa_base64_room(length);
    *decoded = ewa_allocate(g->build->context, *room, 1);
    if (!*decoded) return EWA_ERROR_MEMORY;
    size_t used;
    *size_bytes = ewa_base64_read(comma + 1, length, 0, *decoded, *room, &used);
    if (used == length) return EWA_OK;
    ewa_release(g->build->context, *decoded, *room, 1);
    *decoded = NULL;
    return ewa_gltf_fail(g, array, index, "a data URI with letters that base64 has not");
}

static int hex_of(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

bool ewa_gltf_path_of(const char *uri, char *path, size_t room) {
    size_t length = 0;
    for (; *uri && length + 1 < room; uri++) {
        const int high = *uri == '%' ? hex_of(uri[1]) : -1, low = high >= 0 ? hex_of(uri[2]) : -1;
        path[length++] = low >= 0 ? (char)(16 * high + low) : *uri;
        uri += low >= 0 ? 2 : 0;
    }
    path[length] = 0;
    return !*uri;
}

/// Opens a buffer: the chunk of the .glb, a data URI, or a file beside.
static ewa_status open_buffer(gltf *g, uint64_t index) {
    gltf_buffer *buffer = &g->opened[index];
    if (buffer->opened) return EWA_OK;
    const cJSON *uri = ewa_gltf_member(g->buffers.items[index], "uri");
    uint64_t wanted;
    if (!ewa_gltf_count(g->buffers.items[index], "byteLength", 0, &wanted))
        return ewa_gltf_fail(g, "buffers", index, "byteLength is no count");
    if (!uri && index == 0 && g->chunk) {
        buffer->bytes = g->chunk;
        buffer->size_bytes = g->chunk_bytes;
    } else if (!cJSON_IsString(uri)) {
        return ewa_gltf_fail(g, "buffers", index, "there is neither a uri nor a binary chunk");
    } else if (strncmp(uri->valuestring, "data:", 5) == 0) {
        EWA_TRY(ewa_gltf_decode_uri(g, "buffers", index, uri->valuestring, &buffer->decoded,
                                    &buffer->decoded_room, &buffer->size_bytes));
        buffer->bytes = buffer->decoded;
    } else {
        char path[4096], reason[EWA_REASON_BYTES] = "its name is too long", quote[EWA_QUOTE_BYTES];
        const bool fits = ewa_gltf_path_of(uri->valuestring, path, sizeof path);
        const ewa_text name = {path, fits ? strlen(path) : 0};
        if (!g->build->source->path)
            snprintf(reason, sizeof reason, "the mesh is no file that it could lie beside");
        if (!g->build->source->path || !fits ||
            !ewa_referenced_file_map(g->build->context, g->build->source->path, name, &buffer->file, reason))
            return ewa_fail(g->build->context, EWA_ERROR_IO, "%s: buffer %llu, %s: %s",
                            g->build->source->name, (unsigned long long)index,
                            ewa_quote((ewa_text){uri->valuestring, strlen(uri->valuestring)}, quote), reason);
        buffer->bytes = buffer->file.bytes;
        buffer->size_bytes = buffer->file.size_bytes;
        ewa_gltf_grant(g, buffer->size_bytes);
    }
    buffer->opened = true;
    if (buffer->size_bytes < wanted)
        return ewa_gltf_fail(g, "buffers", index, "it is shorter than byteLength says");
    return EWA_OK;
}

void ewa_gltf_close_buffers(gltf *g) {
    for (uint32_t i = 0; g->opened && i < g->buffers.count; i++) {
        ewa_release(g->build->context, g->opened[i].decoded, g->opened[i].decoded_room, 1);
        ewa_file_unmap(g->build->context, &g->opened[i].file);
    }
    ewa_release(g->build->context, g->opened, g->buffers.count, sizeof *g->opened);
    g->opened = NULL;
    for (uint32_t i = 0; g->unpacked && i < g->views.count; i++)
        ewa_release(g->build->context, g->unpacked[i].decoded, g->unpacked[i].decoded_room, 1);
    ewa_release(g->build->context, g->unpacked, g->views.count, sizeof *g->unpacked);
    g->unpacked = NULL;
}

/// The bytes that a view, or its extension, names.
static ewa_status open_range(gltf *g, uint64_t index, const cJSON *view, const uint8_t **bytes,
                             uint64_t *size_bytes, uint64_t *stride) {
    uint64_t buffer, offset;
    if (!ewa_gltf_count(view, "buffer", UINT64_MAX, &buffer) || buffer >= g->buffers.count ||
        !ewa_gltf_count(view, "byteOffset", 0, &offset) ||
        !ewa_gltf_count(view, "byteLength", 0, size_bytes) || !ewa_gltf_count(view, "byteStride", 0, stride))
        return ewa_gltf_fail(g, "bufferViews", index,
                             "buffer, byteOffset, byteLength or byteStride is wrong");
    EWA_TRY(open_buffer(g, buffer));
    const uint64_t there = g->opened[buffer].size_bytes;
    if (offset > there || *size_bytes > there - offset)
        return ewa_gltf_fail(g, "bufferViews", index, "it ends behind its buffer");
    *bytes = there ? g->opened[buffer].bytes + offset : (const uint8_t *)"";
    return EWA_OK;
}

ewa_status ewa_gltf_view(gltf *g, uint64_t index, const uint8_t **bytes, uint64_t *size_bytes,
                         uint64_t *stride) {
    if (index >= g->views.count) return ewa_gltf_fail(g, "bufferViews", index, "there is no such one");
    const cJSON *view = g->views.items[index], *packed = ewa_gltf_extension(view, "EXT_meshopt_compression");
    if (!packed) packed = ewa_gltf_extension(view, "KHR_meshopt_compression");
    if (!packed) return open_range(g, index, view, bytes, size_bytes, stride);
    EWA_TRY(open_range(g, index, packed, bytes, size_bytes, stride));
    if (!g->unpacked)
        g->unpacked = ewa_allocate_zeroed(g->build->context, g->views.count, sizeof *g->unpacked);
    if (!g->unpacked) return EWA_ERROR_MEMORY;
    gltf_buffer *unpacked = &g->unpacked[index];
    if (!unpacked->opened) {
        // A second try would forget the room of a first that failed.
        if (unpacked->decoded) return ewa_gltf_fail(g, "bufferViews", index, "its packed bytes are broken");
        EWA_TRY(ewa_gltf_unpack_view(g, index, packed, *bytes, *size_bytes, *stride, unpacked));
    }
    *bytes = unpacked->bytes;
    *size_bytes = unpacked->size_bytes;
    return EWA_OK;
}

static double load_component(const uint8_t *bytes, uint64_t type, bool normalized) {
    const uint32_t b0 = bytes[0];
    if (type == GLTF_U8) return normalized ? b0 / 255.0 : b0;
    if (type == GLTF_I8) {
        const double value = (int8_t)b0;
        return normalized ? (value < -127 ? -1 : value / 127) : value;
    }
    const uint32_t b01 = b0 | (uint32_t)bytes[1] << 8;
    if (type == GLTF_U16) return normalized ? b01 / 65535.0 : b01;
    if (type == GLTF_I16) {
        const double value = (int16_t)b01;
        return normalized ? (value < -32767 ? -1 : value / 32767) : value;
    }
    const uint32_t bits = b01 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
    if (type == GLTF_U32) return normalized ? bits / 4294967295.0 : bits;
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

static uint32_t component_count(const cJSON *accessor) {
    static const char *const names[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    const cJSON *type = ewa_gltf_member(accessor, "type");
    for (uint32_t i = 0; i < 4 && cJSON_IsString(type); i++)
        if (strcmp(type->valuestring, names[i]) == 0) return i + 1;
    return 0;
}

/// Records in a view, checked: `count` of `bytes` bytes from byte `offset` on.
static ewa_status open_records(gltf *g, uint64_t accessor, uint64_t view, uint64_t offset, uint64_t count,
                               uint64_t bytes, const uint8_t **records, uint64_t *stride) {
    uint64_t size_bytes, last;
    EWA_TRY(ewa_gltf_view(g, view, records, &size_bytes, stride));
    if (*stride == 0) *stride = bytes;
    if (*stride < bytes || (count && (__builtin_mul_overflow(count - 1, *stride, &last) ||
                                      __builtin_add_overflow(last, offset, &last) ||
                                      __builtin_add_overflow(last, bytes, &last) || last > size_bytes)))
        return ewa_gltf_fail(g, "accessors", accessor, "it ends behind its buffer view");
    *records += count ? offset : 0;
    return EWA_OK;
}

/// Puts the numbers of a sparse accessor over those that are there.
static ewa_status apply_sparse(gltf *g, uint64_t index, const cJSON *sparse, uint64_t type, bool normalized,
                               gltf_array *array) {
    const cJSON *indices = ewa_gltf_member(sparse, "indices"), *values = ewa_gltf_member(sparse, "values");
    uint64_t count, view[2], offset[2], index_type, stride[2];
    const uint8_t *records[2];
    const uint32_t bytes = component_bytes(type);
    if (!ewa_gltf_count(sparse, "count", 0, &count) || count > array->count ||
        !ewa_gltf_count(indices, "bufferView", UINT64_MAX, &view[0]) ||
        !ewa_gltf_count(indices, "byteOffset", 0, &offset[0]) ||
        !ewa_gltf_count(indices, "componentType", 0, &index_type) ||
        (index_type != GLTF_U8 && index_type != GLTF_U16 && index_type != GLTF_U32) ||
        !ewa_gltf_count(values, "bufferView", UINT64_MAX, &view[1]) ||
        !ewa_gltf_count(values, "byteOffset", 0, &offset[1]))
        return ewa_gltf_fail(g, "accessors", index, "its sparse part is wrong");
    EWA_TRY(open_records(g, index, view[0], offset[0], count, component_bytes(index_type), &records[0],
                         &stride[0]));
    EWA_TRY(open_records(g, index, view[1], offset[1], count, (uint64_t)bytes * array->components,
                         &records[1], &stride[1]));
    for (uint64_t i = 0; i < count; i++) {
        const double at = load_component(records[0] + i * stride[0], index_type, false);
        if (!(at < (double)array->count))
            return ewa_gltf_fail(g, "accessors", index, "its sparse part replaces what is not there");
        for (uint32_t c = 0; c < array->components; c++)
            array->numbers[(uint64_t)at * array->components + c] =
                load_component(records[1] + i * stride[1] + c * bytes, type, normalized);
    }
    return EWA_OK;
}

static ewa_status read_numbers(gltf *g, uint64_t index, const cJSON *accessor, uint64_t type,
                               gltf_array *array) {
    const bool normalized = cJSON_IsTrue(ewa_gltf_member(accessor, "normalized"));
    const uint32_t bytes = component_bytes(type);
    uint64_t view, offset, stride = 0;
    const uint8_t *records = NULL;
    if (!ewa_gltf_count(accessor, "bufferView", UINT64_MAX, &view) ||
        !ewa_gltf_count(accessor, "byteOffset", 0, &offset))
        return ewa_gltf_fail(g, "accessors", index, "bufferView or byteOffset is wrong");
    if (view != UINT64_MAX)
        EWA_TRY(open_records(g, index, view, offset, array->count, (uint64_t)bytes * array->components,
                             &records, &stride));
    array->numbers =
        ewa_allocate_zeroed(g->build->context, array->count, array->components * sizeof *array->numbers);
    if (!array->numbers) return EWA_ERROR_MEMORY;
    for (uint64_t i = 0; i < array->count && records; i++)
        for (uint32_t c = 0; c < array->components; c++)
            array->numbers[i * array->components + c] =
                load_component(records + i * stride + c * bytes, type, normalized);
    const cJSON *sparse = ewa_gltf_member(accessor, "sparse");
    return sparse ? apply_sparse(g, index, sparse, type, normalized, array) : EWA_OK;
}

static ewa_status open_accessor(const gltf *g, uint64_t index, uint32_t low, uint32_t high, gltf_array *array,
                                uint64_t *type) {
    *array = (gltf_array){0};
    if (index >= g->accessors.count) return ewa_gltf_fail(g, "accessors", index, "there is no such one");
    const cJSON *accessor = g->accessors.items[index];
    array->components = component_count(accessor);
    if (!ewa_gltf_count(accessor, "componentType", 0, type) || !component_bytes(*type) ||
        array->components < low || array->components > high)
        return ewa_gltf_fail(g, "accessors", index, "its type is not what it is used for");
    if (!ewa_gltf_count(accessor, "count", 0, &array->count))
        return ewa_gltf_fail(g, "accessors", index, "count is no count");
    return EWA_OK;
}

ewa_status ewa_gltf_describe(const gltf *g, uint64_t index, uint32_t low, uint32_t high, gltf_array *array,
                             gltf_numbers *form) {
    uint64_t type;
    EWA_TRY(open_accessor(g, index, low, high, array, &type));
    *form = (gltf_numbers){1, -INFINITY};
    if (!cJSON_IsTrue(ewa_gltf_member(g->accessors.items[index], "normalized")) || type == GLTF_F32)
        return EWA_OK;
    const bool is_signed = type == GLTF_I8 || type == GLTF_I16;
    form->share = 1 / (ldexp(1, (int)(8 * component_bytes(type)) - is_signed) - 1);
    form->lowest = is_signed ? -1 : 0;
    return EWA_OK;
}

ewa_status ewa_gltf_read_accessor(gltf *g, uint64_t index, uint32_t low, uint32_t high, gltf_array *array) {
    uint64_t type;
    gltf_array made;
    *array = (gltf_array){0};
    EWA_TRY(open_accessor(g, index, low, high, &made, &type));
    // A short file may name one accessor many times, or one that is all zeros.
    EWA_TRY(ewa_gltf_spend(g, made.count));
    const ewa_status status = read_numbers(g, index, g->accessors.items[index], type, &made);
    // Nobody may see a count whose numbers are not there.
    if (status == EWA_OK)
        *array = made;
    else
        ewa_gltf_free_array(g, &made);
    return status;
}

void ewa_gltf_free_array(const gltf *g, gltf_array *array) {
    ewa_release(g->build->context, array->numbers, array->count, array->components * sizeof *array->numbers);
    *array = (gltf_array){0};
}
