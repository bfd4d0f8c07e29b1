// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Never compiled: needs its twin, which needs it, and what is above.
#include "base/front.h"

int ewa_front(int depth) { return depth ? ewa_back(depth - 1) : ewa_roof(); }
