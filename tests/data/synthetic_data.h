// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Synthetic files for the files of the data set that tests read: small, made of what facts.h says, the same
// on every machine, and written byte by byte, so that no writer of the library is trusted here.
#ifndef EWA_TESTS_DATA_SYNTHETIC_DATA_H
#define EWA_TESTS_DATA_SYNTHETIC_DATA_H

#include <stdint.h>
#include <stdio.h>

/// Opens `relative` below `folder` for writing, with the folders on the way. Ends the program when that
/// fails.
FILE *synthetic_open(const char *folder, const char *relative);

/// Writes a whole file.
void synthetic_put(const char *folder, const char *relative, const void *bytes, size_t size_bytes);
void synthetic_text(const char *folder, const char *relative, const char *text);

/// Memory of zeros; ends the program when there is none.
void *synthetic_memory(size_t size_bytes);

/// Numbers in [0, 1) that depend on their place alone.
double synthetic_noise(uint64_t place);

void synthetic_images(const char *folder);
void synthetic_volumes(const char *folder);

#endif
