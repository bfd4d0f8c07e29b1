// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Never compiled: nobody comes here.
int end(void) { return 0; }
