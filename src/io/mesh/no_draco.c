// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What stands for draco.cpp in a library without Draco: no mesh is opened, so nothing else is ever called.
#include "io/mesh/draco.h"

#include <stdio.h>

ewa_draco_result ewa_draco_open(const uint8_t *bytes, size_t size_bytes, uint64_t face_limit,
                                uint64_t point_limit, ewa_draco **mesh, char *reason, size_t reason_bytes) {
    (void)bytes, (void)size_bytes, (void)face_limit, (void)point_limit;
    *mesh = NULL;
    snprintf(reason, reason_bytes, "it is packed by Draco, which this build has not (EWA_WITH_DRACO)");
    return EWA_DRACO_BROKEN;
}

void ewa_draco_close(ewa_draco **mesh) { *mesh = NULL; }

uint64_t ewa_draco_faces(const ewa_draco *mesh) {
    (void)mesh;
    return 0;
}

uint64_t ewa_draco_points(const ewa_draco *mesh) {
    (void)mesh;
    return 0;
}

void ewa_draco_corners(const ewa_draco *mesh, double *corners) { (void)mesh, (void)corners; }

bool ewa_draco_attribute(const ewa_draco *mesh, uint32_t id, uint32_t components, double *numbers) {
    (void)mesh, (void)id, (void)components, (void)numbers;
    return false;
}
