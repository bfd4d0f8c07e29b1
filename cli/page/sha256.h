// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// SHA-256 (FIPS 180-4), by which a Content-Security-Policy names the scripts that may run.
#ifndef EWA_CLI_PAGE_SHA256_H
#define EWA_CLI_PAGE_SHA256_H

#include <stddef.h>
#include <stdint.h>

enum { SHA256_BYTES = 32 };

/// Writes the digest of some bytes.
void sha256(const void *bytes, size_t size_bytes, uint8_t digest[SHA256_BYTES]);

#endif
