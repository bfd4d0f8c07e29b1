// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Draco, which has no C API. Nothing is thrown beyond this file.
#include "io/mesh/draco.h"

#include <draco/compression/decode.h>

#include <cstdio>
#include <memory>
#include <new>

struct ewa_draco {
    std::unique_ptr<draco::Mesh> mesh;
};

namespace {

enum { HEAD_BYTES = 11, METHOD_SEQUENTIAL = 0, MAX_VARINT_BYTES = 5 };

ewa_draco_result fail(char *reason, size_t reason_bytes, const char *text) {
    std::snprintf(reason, reason_bytes, "%s", text);
    return EWA_DRACO_BROKEN;
}

/// Reads a number of 7 bits a byte, the lowest first; false at the end.
bool read_varint(const uint8_t *bytes, size_t size_bytes, size_t *at, uint64_t *value) {
    *value = 0;
    for (int i = 0; i < MAX_VARINT_BYTES && *at < size_bytes; i++) {
        const uint8_t byte = bytes[(*at)++];
        *value |= static_cast<uint64_t>(byte & 127) << 7 * i;
        if (!(byte & 128)) return true;
    }
    return false;
}

/// What is wrong with the head and its counts, which the decoder would make room for before it has looked at the rest;
/// nullptr: nothing.
const char *find_problem(const uint8_t *bytes, size_t size_bytes, uint64_t face_limit, uint64_t point_limit) {
    if (size_bytes < HEAD_BYTES + 1 || std::memcmp(bytes, "DRACO", 5) != 0)
        return "it does not begin like Draco";
    if (bytes[5] != 2 || bytes[6] < 2) return "Draco of a version before 2.2, which glTF does not have";
    if (bytes[7] != draco::TRIANGULAR_MESH) return "Draco of points, not of a mesh";
    if (bytes[10] & 0x80) return "Draco with metadata, which glTF does not have";
    // Sequential: faces, points. Edge breaker: how it walks, vertices, faces.
    const bool sequential = bytes[8] == METHOD_SEQUENTIAL;
    size_t at = HEAD_BYTES + (sequential ? 0 : 1);
    uint64_t first, second;
    if (!read_varint(bytes, size_bytes, &at, &first) || !read_varint(bytes, size_bytes, &at, &second))
        return "Draco that ends in its head";
    const uint64_t faces = sequential ? first : second, points = sequential ? second : first;
    if (faces > face_limit) return "Draco of more faces than the accessor of indices has";
    return points > point_limit ? "Draco of more vertices than the accessor of positions has" : nullptr;
}

} // namespace

ewa_draco_result ewa_draco_open(const uint8_t *bytes, size_t size_bytes, uint64_t face_limit,
                                uint64_t point_limit, ewa_draco **mesh, char *reason, size_t reason_bytes) {
    *mesh = nullptr;
    try {
        const char *problem = find_problem(bytes, size_bytes, face_limit, point_limit);
        if (problem) return fail(reason, reason_bytes, problem);
        draco::DecoderBuffer buffer;
        buffer.Init(reinterpret_cast<const char *>(bytes), size_bytes);
        draco::Decoder decoder;
        auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
        if (!decoded.ok()) return fail(reason, reason_bytes, "Draco's bytes are broken");
        auto made = std::make_unique<ewa_draco>();
        made->mesh = std::move(decoded).value();
        if (made->mesh->num_faces() > face_limit || made->mesh->num_points() > point_limit)
            return fail(reason, reason_bytes, "Draco of more than the accessors have");
        *mesh = made.release();
        return EWA_DRACO_DONE;
    } catch (const std::bad_alloc &) {
        return EWA_DRACO_MEMORY;
    } catch (...) {
        return fail(reason, reason_bytes, "Draco's bytes are broken");
    }
}

void ewa_draco_close(ewa_draco **mesh) {
    delete *mesh;
    *mesh = nullptr;
}

uint64_t ewa_draco_faces(const ewa_draco *mesh) { return mesh->mesh->num_faces(); }

uint64_t ewa_draco_points(const ewa_draco *mesh) { return mesh->mesh->num_points(); }

void ewa_draco_corners(const ewa_draco *mesh, double *corners) {
    for (uint32_t f = 0; f < mesh->mesh->num_faces(); f++)
        for (int c = 0; c < 3; c++) *corners++ = mesh->mesh->face(draco::FaceIndex(f))[c].value();
}

namespace {

/// The numbers as they are stored, so that what a share is of is up to the accessor.
template <typename Number>
bool read_as(const draco::PointAttribute &attribute, uint32_t points, uint32_t components, double *to) {
    for (uint32_t i = 0; i < points; i++) {
        const draco::AttributeValueIndex at = attribute.mapped_index(draco::PointIndex(i));
        if (at.value() >= attribute.size()) return false;
        Number values[4];
        attribute.GetValue(at, values);
        for (uint32_t c = 0; c < components; c++) *to++ = static_cast<double>(values[c]);
    }
    return true;
}

} // namespace

bool ewa_draco_attribute(const ewa_draco *mesh, uint32_t id, uint32_t components, double *numbers) {
    const draco::PointAttribute *attribute = mesh->mesh->GetAttributeByUniqueId(id);
    if (!attribute || attribute->num_components() != static_cast<int>(components) || components > 4)
        return false;
    const uint32_t points = mesh->mesh->num_points();
    switch (attribute->data_type()) {
    case draco::DT_INT8:
        return read_as<int8_t>(*attribute, points, components, numbers);
    case draco::DT_UINT8:
        return read_as<uint8_t>(*attribute, points, components, numbers);
    case draco::DT_INT16:
        return read_as<int16_t>(*attribute, points, components, numbers);
    case draco::DT_UINT16:
        return read_as<uint16_t>(*attribute, points, components, numbers);
    case draco::DT_INT32:
        return read_as<int32_t>(*attribute, points, components, numbers);
    case draco::DT_UINT32:
        return read_as<uint32_t>(*attribute, points, components, numbers);
    case draco::DT_FLOAT32:
        return read_as<float>(*attribute, points, components, numbers);
    default:
        return false;
    }
}
