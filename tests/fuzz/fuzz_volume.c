// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target: any bytes as a volume file, the format by their content; those of no format as raw numbers of
// a size that the first byte says. What is read can be measured, and a look be made for it.
#include "ewa/io.h"
#include "fuzz.h"
#include "image/transfer.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    WITH_DEFAULTS(ewa_context_options, options);
    options.thread_count = 1;
    options.limits.max_memory_bytes = 1 << 24;
    ewa_context *context = NULL;
    if (ewa_context_create(&options, &context) != EWA_OK) return 0;
    ewa_volume volume;
    ewa_status status =
        ewa_volume_load_memory(context, bytes, size_bytes, "fuzz_2x2x2_uint8.raw", NULL, &volume);
    if ((status == EWA_OK) != (volume.voxels != NULL)) abort();
    if (status == EWA_OK) {
        ewa_volume_facts facts;
        ewa_transfer transfer;
        if (ewa_volume_measure(&volume, &facts) != EWA_OK) abort();
        status = ewa_transfer_automatic(&volume, &facts, &transfer);
        if (status == EWA_OK && ewa_transfer_check(context, "fuzz", &transfer) != EWA_OK) abort();
    }
    ewa_volume_free(&volume);
    if (size_bytes > 1) {
        WITH_DEFAULTS(ewa_volume_load_options, raw);
        raw.dims[0] = bytes[0] % 8 + 1u;
        raw.dims[1] = bytes[0] / 8 % 8 + 1u;
        raw.dims[2] = bytes[0] / 64 + 1u;
        raw.type = bytes[1] % 8;
        status = ewa_volume_load_memory(context, bytes + 2, size_bytes - 2, "fuzz", &raw, &volume);
        if ((status == EWA_OK) != (volume.voxels != NULL)) abort();
        ewa_volume_free(&volume);
    }
    ewa_context_destroy(&context);
    return 0;
}
