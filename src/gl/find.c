// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the device is that the compute pipeline would draw with.
#include "gl/backends.h"
#include "gl/compute.h"

#include <stdio.h>

ewa_status ewa_gpu_find(ewa_context *context, ewa_gpu_info *info) {
    ewa_gl *device;
    EWA_TRY(ewa_gl_open(context, &device));
    ewa_gl_list(info->devices, sizeof info->devices);
    const ewa_gl_facts *facts = &device->facts;
    snprintf(info->vendor, sizeof info->vendor, "%s", facts->vendor);
    snprintf(info->renderer, sizeof info->renderer, "%s", facts->renderer);
    snprintf(info->version, sizeof info->version, "%s", facts->version);
    info->software = facts->software;
    info->storage_bytes = facts->storage_bytes, info->storage_count = facts->storage_count;
    info->group_threads = facts->group_threads, info->texture_px = facts->texture_px;
    ewa_gl_verdict verdict;
    ewa_failures_soften(context, true);
    ewa_status status = ewa_gl_try(device, &verdict);
    ewa_failures_soften(context, false);
    ewa_gl_close(&device);
    if (status != EWA_OK) { // there is one: no failure of the question
        info->device_class = EWA_GPU_UNUSABLE;
        return status == EWA_ERROR_MEMORY ? status : EWA_OK;
    }
    info->device_class = verdict.exact ? EWA_GPU_EXACT : EWA_GPU_CLOSE;
    if (verdict.differs) snprintf(info->differs, sizeof info->differs, "%s", verdict.differs);
    info->native_fma = verdict.arithmetic.fused;
    info->native_division = verdict.arithmetic.divides;
    info->native_root = verdict.arithmetic.roots;
    info->subnormals = verdict.subnormals;
    return EWA_OK;
}
