// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Transfer functions, inner side.
#ifndef EWA_SRC_IMAGE_TRANSFER_H
#define EWA_SRC_IMAGE_TRANSFER_H

#include "ewa/volume.h"

/// The optical depth of a layer that hides `opacity` of what is behind: -log(1 - opacity), the same bits on
/// every machine; opacities from 1 - 2^-20 on count as that.
double ewa_extinction_of_opacity(double opacity);

/// Appends a point; `srgb` is 0xrrggbb. Nothing is checked.
void ewa_transfer_add(ewa_transfer *transfer, double value, uint32_t srgb, double extinction);

/// The unit of length of presets: what fills a picture has 128 of them.
double ewa_transfer_unit(const ewa_volume_facts *facts);

/// EWA_ERROR_NUMERIC when a volume has no range of values that colours could be spread over.
ewa_status ewa_transfer_check_facts(const ewa_volume *volume, const ewa_volume_facts *facts);

/// Checks what ewa_transfer says of its members; `name` is for the message. Errors: EWA_ERROR_ARGUMENT.
ewa_status ewa_transfer_check(ewa_context *context, const char *name, const ewa_transfer *transfer);

#endif
