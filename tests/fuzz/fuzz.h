// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The entry point of every fuzz target, as libFuzzer calls it.
#ifndef EWA_TESTS_FUZZ_H
#define EWA_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>

/// Tries one input; returns 0, or aborts when something does not hold that must.
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes);

#endif
