// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The header of an OpenEXR file, of which OpenEXR's C++ is to see what pixels need.
#ifndef EWA_SRC_EXR_HEADER_H
#define EWA_SRC_EXR_HEADER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Whether a file has one part, of lines or tiles, so that its header is one list of attributes.
bool ewa_exr_has_one_part(const uint8_t *bytes, size_t size_bytes);

/// Measures the header of a file of one part, from the first byte to the zero that ends it; 0 where it is damaged.
size_t ewa_exr_measure_header(const uint8_t *bytes, size_t size_bytes);

/// Copies a header that has been measured to `header`, which has room for as many bytes. In place of the attributes that pixels do not
/// need stands one without a meaning, as long as these, since offsets of the file count from its first byte.
void ewa_exr_copy_header(const uint8_t *bytes, size_t header_bytes, uint8_t *header);

#endif
