// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Never compiled: tools/check_layers.cmake must refuse these includes of C++ sources, too.
#include "cloud/roof.h"
