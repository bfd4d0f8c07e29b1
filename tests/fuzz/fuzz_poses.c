// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target: any bytes as poses; what can be read are cameras.
#include "fuzz.h"
#include "io/camera/file.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    ewa_context *context = fuzz_context(1, 0, NULL);
    ewa_camera lens;
    ewa_camera_init(&lens);
    ewa_camera_list list = {.context = context, .name = "fuzz"};
    const ewa_status status = ewa_camera_list_read_poses(&list, &lens, bytes, size_bytes);
    for (size_t i = 0; status == EWA_OK && i < list.count; i++)
        if (ewa_camera_check(context, &list.cameras[i]) != EWA_OK) abort();
    ewa_camera_list_free(&list);
    ewa_context_destroy(&context);
    return 0;
}
