// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Never compiled: tools/check_layers.cmake must refuse these includes, and the option in the message.
#include "cloud/roof.h"
#include "ewa/roof.h"
static const char *const message = "it is damaged (--keep-going steps over it)";
