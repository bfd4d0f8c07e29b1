// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Stand-ins for the files of the data set that tests read: small, made of what facts.h says, the same on
// every machine, and written byte by byte, so that no writer of the library is trusted here.
#ifndef EWA_TESTS_STAND_INS_H
#define EWA_TESTS_STAND_INS_H

#include <stdint.h>
#include <stdio.h>

/// Opens `relative` below `folder` for writing, with the folders on the way. Ends the program when that
/// fails.
FILE *stand_in_open(const char *folder, const char *relative);

/// Writes a whole file.
void stand_in_put(const char *folder, const char *relative, const void *bytes, size_t size_bytes);
void stand_in_text(const char *folder, const char *relative, const char *text);

/// Memory of zeros; ends the program when there is none.
void *stand_in_memory(size_t size_bytes);

/// Numbers in [0, 1) that depend on their place alone.
double stand_in_noise(uint64_t place);

void stand_in_images(const char *folder);
void stand_in_volumes(const char *folder);

#endif
