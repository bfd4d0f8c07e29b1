// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target: any bytes as a transfer function. What is read can be drawn with.
#include "ewa/volume.h"
#include "fuzz.h"
#include "image/transfer.h"
#include "io/volume/transfer.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    ewa_context *context = fuzz_context(1, 0, NULL);
    ewa_transfer transfer;
    const ewa_status status = ewa_transfer_read(context, "fuzz", bytes, size_bytes, &transfer);
    if ((status == EWA_OK) != (transfer.point_count > 0)) abort();
    if (status == EWA_OK && ewa_transfer_check(context, "fuzz", &transfer) != EWA_OK) abort();
    ewa_context_destroy(&context);
    return 0;
}
