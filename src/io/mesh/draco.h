// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Meshes that Draco has packed: what is reached of its C++.
#ifndef EWA_SRC_MESH_DRACO_H
#define EWA_SRC_MESH_DRACO_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ewa_draco ewa_draco;

/// What became of a call.
typedef enum ewa_draco_result { EWA_DRACO_DONE, EWA_DRACO_BROKEN, EWA_DRACO_MEMORY } ewa_draco_result;

/// Decodes; the caller closes. No more than so many faces and points may come out: more is broken. `reason` gets why it
/// is broken. Any thread.
ewa_draco_result ewa_draco_open(const uint8_t *bytes, size_t size_bytes, uint64_t face_limit,
                                uint64_t point_limit, ewa_draco **mesh, char *reason, size_t reason_bytes);
void ewa_draco_close(ewa_draco **mesh);

uint64_t ewa_draco_faces(const ewa_draco *mesh);
uint64_t ewa_draco_points(const ewa_draco *mesh);

/// Writes the corners of all faces: 3 numbers of points each.
void ewa_draco_corners(const ewa_draco *mesh, double *corners);

/// Writes the numbers of an attribute, `components` for each point, integers as they are; false when there is none with
/// this id, or it has other components.
bool ewa_draco_attribute(const ewa_draco *mesh, uint32_t id, uint32_t components, double *numbers);

#ifdef __cplusplus
}
#endif
#endif
