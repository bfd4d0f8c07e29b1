// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a test makes and gives back where its scope ends.
#ifndef EWA_TESTS_OWNED_H
#define EWA_TESTS_OWNED_H

#include <stdlib.h>
#include <string.h>

/// Declares a variable that is given back at the end of its scope, the last one first, by a function that takes its
/// address: OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL. It need not be read: a test may only make it.
#define OWNED(destroy) __attribute__((cleanup(destroy), unused))

/// For OWNED: gives back what malloc() made; `variable` is the address of the pointer.
static inline void check_free(void *variable) {
    void *memory;
    memcpy(&memory, variable, sizeof memory);
    free(memory);
}

#endif
