// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Memory of volumes.
#include "ewa/volume.h"
#include "base/base.h"

static bool is_voxel_type(ewa_type type) {
    return type == EWA_U8 || type == EWA_I8 || type == EWA_U16 || type == EWA_I16 || type == EWA_F32;
}

ewa_status ewa_volume_create(ewa_context *context, const uint32_t dims[3], ewa_type type,
                             ewa_volume *volume) {
    if (!context || !dims || !volume) return EWA_ERROR_ARGUMENT;
    *volume = (ewa_volume){0};
    if (!is_voxel_type(type))
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "volume: voxels of type %d", (int)type);
    const size_t type_bytes = ewa_type_bytes(type);
    uint64_t bytes = type_bytes;
    for (int axis = 0; axis < 3; axis++) {
        if (dims[axis] == 0)
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "volume: %u x %u x %u voxels", dims[0], dims[1],
                            dims[2]);
        if (__builtin_mul_overflow(bytes, dims[axis], &bytes)) bytes = UINT64_MAX;
    }
    EWA_TRY(ewa_memory_check(context, bytes, "volume of %u x %u x %u voxels", dims[0], dims[1], dims[2]));
    ewa_volume made = {.context = context, .dims = {dims[0], dims[1], dims[2]}, .type = type};
    made.voxels = ewa_allocate_zeroed(context, bytes / type_bytes, type_bytes);
    if (!made.voxels) return EWA_ERROR_MEMORY;
    for (int axis = 0; axis < 3; axis++) {
        made.index_to_world[5 * axis] = 1;
        made.index_to_world[4 * axis + 3] = -0.5 * (dims[axis] - 1.0);
    }
    *volume = made;
    return EWA_OK;
}

void ewa_volume_free(ewa_volume *volume) {
    if (!volume || !volume->context) return;
    const size_t count = (size_t)volume->dims[0] * volume->dims[1] * volume->dims[2];
    if (volume->voxels) ewa_release(volume->context, volume->voxels, count, ewa_type_bytes(volume->type));
    *volume = (ewa_volume){0};
}
