// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Never compiled: what is right and what is wrong in it is in found.txt. docs/math.md section 0.
#define EWA_THING 1

typedef struct ewa_thing {
    int part; ///< of docs/math.md section
              ///< 4, and NONE_SUCH
} ewa_thing;

/// Returns `ewa_lost`, or lost_part, as ewa_thing_make() does.
const char *ewa_thing_make(void) { return "// ewa_no_comment"; }
