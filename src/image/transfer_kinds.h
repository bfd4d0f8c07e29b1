// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Automatic transfer functions of volumes that are no scans.
#ifndef EWA_SRC_IMAGE_TRANSFER_KINDS_H
#define EWA_SRC_IMAGE_TRANSFER_KINDS_H

#include "image/volume_kind.h"

/// A colour per label, by ewa_class_color(); a label that stands around most others is translucent. Errors:
/// EWA_ERROR_MEMORY.
ewa_status ewa_transfer_labels(const ewa_volume *volume, const ewa_volume_facts *facts,
                               const ewa_volume_labels *labels, ewa_transfer *transfer);

/// Translucent shells around a solid core, at values whose surfaces enclose ever less.
void ewa_transfer_field(const ewa_volume_facts *facts, const ewa_volume_surfaces *surfaces,
                        ewa_transfer *transfer);

/// Greys from black to white, solid.
void ewa_transfer_picture(const ewa_volume_facts *facts, const ewa_volume_surfaces *surfaces,
                          ewa_transfer *transfer);

/// Grey fog.
void ewa_transfer_noise(const ewa_volume_facts *facts, ewa_transfer *transfer);

#endif
