// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The places of a cloud's scanners, which its note "scanners" has as text.
#ifndef EWA_SRC_CLOUD_SCANNERS_H
#define EWA_SRC_CLOUD_SCANNERS_H

#include "ewa/cloud.h"

/// Reads up to `maximum` places. Returns how many there are; 0: there is no such note, or something else stands in it. Any thread.
size_t ewa_cloud_read_scanners(const ewa_cloud *cloud, size_t maximum, double (*world)[3]);

/// Writes the note, a line each. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_cloud_write_scanners(ewa_cloud *cloud, size_t count, const double (*world)[3]);

#endif
