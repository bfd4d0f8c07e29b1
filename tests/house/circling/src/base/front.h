// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What both twins include; a declaration is no need.
int ewa_front(int depth);
int ewa_back(int depth);
int ewa_roof(void);

static inline int ewa_half(int depth) { return depth / 2; }
