// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Transfer functions in files, the inner side.
#ifndef EWA_SRC_IO_VOLUME_TRANSFER_H
#define EWA_SRC_IO_VOLUME_TRANSFER_H

#include "ewa/volume.h"

/// ewa_transfer_load() from memory; `name` stands for the file in messages.
ewa_status ewa_transfer_read(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                             ewa_transfer *transfer);

#endif
