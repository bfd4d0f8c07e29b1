// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Never compiled.
int ewa_roof(void) { return 0; }
