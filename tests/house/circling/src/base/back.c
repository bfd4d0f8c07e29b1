// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Never compiled.
#include "base/front.h"

int ewa_back(int depth) { return ewa_half(ewa_front(depth)); }
