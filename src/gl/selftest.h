// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How a device calculates: what of its arithmetic is correctly rounded, and whether all that the pipeline is
// made of gives the bits of the processor.
#ifndef EWA_SRC_GL_SELFTEST_H
#define EWA_SRC_GL_SELFTEST_H

#include "gl/variant.h"

/// What a trial has found.
typedef struct ewa_gl_verdict {
    ewa_gl_arithmetic own;        ///< what of the device's arithmetic is correctly rounded
    ewa_gl_arithmetic arithmetic; ///< what of it is to be used
    bool exact;                   ///< with that every operation gives the bits of the processor
    bool subnormals;              ///< it has numbers below the normal ones; else they are 0
    const char *differs;          ///< the first operation that does not; NULL: none
} ewa_gl_verdict;

/// Tries the arithmetic of a device that has compute programs and doubles, and is entered. Errors: EWA_ERROR_MEMORY,
/// EWA_ERROR_UNSUPPORTED (its compiler's words, or it is lost).
ewa_status ewa_gl_selftest(ewa_gl *device, ewa_gl_verdict *verdict);

#endif
