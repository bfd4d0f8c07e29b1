// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target: any bytes as a camera file: JSON, XML of Metashape, or, by the first byte, the two files of a COLMAP model (text
// 't', binary 'b') one after the other, the length of the first in the second byte.
#include "fuzz.h"
#include "io/camera/file.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    ewa_context *context = fuzz_context(1, 0, NULL);
    ewa_camera_list list = {.context = context, .name = "fuzz", .lens_suffices = true};
    if (size_bytes >= 2 && (bytes[0] == 't' || bytes[0] == 'b')) {
        const size_t first = bytes[1] < size_bytes - 2 ? bytes[1] : size_bytes - 2;
        ewa_camera_list_read_colmap_memory(&list, bytes[0] == 't', bytes + 2, first, bytes + 2 + first,
                                           size_bytes - 2 - first);
    } else if (size_bytes && bytes[0] == '<') {
        list.takes_lenses = size_bytes % 2;
        ewa_camera_list_read_metashape(&list, bytes, size_bytes);
    } else {
        ewa_camera_list_read_json(&list, NULL, bytes, size_bytes);
    }
    ewa_camera_list_free(&list);
    ewa_context_destroy(&context);
    return 0;
}
