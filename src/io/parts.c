// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the library was built with.
#include "ewa/io.h"

const char *ewa_parts(void) { return EWA_PARTS; }
