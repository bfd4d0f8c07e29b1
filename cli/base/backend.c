// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What is said of what draws the frames.
#include "cli/base/backend.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

void backend_warn(cli_session *session, int backend, const ewa_renderer *renderer) {
    ewa_renderer_info info = {.struct_size = sizeof info};
    if (backend == EWA_BACKEND_CPU || backend == EWA_BACKEND_AUTO) return;
    if (ewa_renderer_describe(renderer, &info) == EWA_OK && *info.remark)
        session_warn(session, "%s: --backend cpu is many times faster", info.remark);
}

void backend_write(json_writer *json, const ewa_renderer_info *info) {
    json_text(json, "backend", info->backend);
    if (*info->device) json_text(json, "device", info->device);
    if (*info->device) json_text(json, "device_class", ewa_gpu_class_name(info->device_class));
    if (*info->remark) json_text(json, "backend_remark", info->remark);
    if (*info->mixture) json_text(json, "mixture_backend", info->mixture);
    if (*info->mixture_remark) json_text(json, "mixture_remark", info->mixture_remark);
    if (!info->dispatch_count) return;
    json_count(json, "device_waits", info->wait_count);
    json_count(json, "device_readbacks", info->readback_count);
    json_count(json, "device_dispatches", info->dispatch_count);
    json_count(json, "device_upload_bytes", info->upload_bytes);
    json_count(json, "device_readback_bytes", info->readback_bytes);
}

static void write_gpu(json_writer *json, const ewa_gpu_info *gpu) {
    json_object(json, "gpu");
    json_text(json, "vendor", gpu->vendor);
    json_text(json, "renderer", gpu->renderer);
    json_text(json, "version", gpu->version);
    json_flag(json, "software", gpu->software);
    json_text(json, "class", ewa_gpu_class_name(gpu->device_class));
    if (*gpu->differs) json_text(json, "differs", gpu->differs);
    json_flag(json, "native_fma", gpu->native_fma);
    json_flag(json, "native_division", gpu->native_division);
    json_flag(json, "native_root", gpu->native_root);
    json_flag(json, "subnormals", gpu->subnormals);
    json_text(json, "devices", gpu->devices);
    json_count(json, "storage_bytes", gpu->storage_bytes);
    json_count(json, "storage_buffers", gpu->storage_count);
    json_count(json, "group_threads", gpu->group_threads);
    json_count(json, "texture_px", gpu->texture_px);
    json_close(json, '}');
}

static void print_gpu(const ewa_gpu_info *gpu) {
    static const char *const meanings[] = {
        [EWA_GPU_NONE] = "",
        [EWA_GPU_UNUSABLE] = " (not for --backend gl)",
        [EWA_GPU_CLOSE] = " (pictures differ from the processor's in last places)",
        [EWA_GPU_EXACT] = " (the same pictures as the processor)",
    };
    printf("gpu\n  renderer    %s%s\n  vendor      %s\n  version     %s\n", gpu->renderer,
           gpu->software ? ", software" : "", gpu->vendor, gpu->version);
    printf("  class       %s%s\n", ewa_gpu_class_name(gpu->device_class), meanings[gpu->device_class]);
    if (*gpu->differs) printf("  differs     %s\n", gpu->differs);
    if (gpu->device_class >= EWA_GPU_CLOSE)
        printf("  arithmetic  fma %s, division %s, square root %s%s\n", gpu->native_fma ? "native" : "emulated",
               gpu->native_division ? "native" : "emulated", gpu->native_root ? "native" : "emulated",
               gpu->subnormals ? "" : ", no numbers below 1.2e-38");
    printf("  storage     %" PRIu32 " buffers of %" PRIu64 " MiB at most\n", gpu->storage_count,
           gpu->storage_bytes >> 20);
    printf("  groups      %" PRIu32 " threads at most\n", gpu->group_threads);
    printf("  pictures    %" PRIu32 " px at most\n", gpu->texture_px);
    for (const char *line = gpu->devices, *end = line; *line; line = end + (*end == '\n')) {
        end = line + strcspn(line, "\n");
        printf("  device      %.*s\n", (int)(end - line), line);
    }
}

bool backend_print_gpu(cli_session *session, json_writer *json) {
    ewa_gpu_info gpu = {.struct_size = sizeof gpu};
    if (!session_passed(session, ewa_gpu_describe(session->context, &gpu))) return false;
    if (json)
        write_gpu(json, &gpu);
    else
        print_gpu(&gpu);
    return true;
}
