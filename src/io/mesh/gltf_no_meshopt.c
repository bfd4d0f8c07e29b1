// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What stands for gltf_meshopt.c in a library without meshoptimizer.
#include "base/base.h"
#include "io/mesh/gltf.h"

ewa_status ewa_gltf_unpack_view(gltf *g, uint64_t index, const cJSON *packed, const uint8_t *bytes,
                                uint64_t size_bytes, uint64_t stride, gltf_buffer *unpacked) {
    (void)index, (void)packed, (void)bytes, (void)size_bytes, (void)stride, (void)unpacked;
    return ewa_fail(g->build->context, EWA_ERROR_UNSUPPORTED,
                    "%s: it is packed by meshoptimizer, which this build has not (EWA_WITH_MESHOPT)",
                    g->build->source->name);
}
