// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What tests ask of this room: EWA_GL_TUNING in the environment, "name=value name=value".
//
// tile_px, unit, page: sizes of work; turns: of loops in a dispatch that draws volumes; storage, blocks, groups: bytes of a storage block, how many there are, and groups of a
// dispatch, at most; arith: "close" takes the device's own
// arithmetic as it is, "emulated" nothing of it; nodevice=1: there is none; lose=N, hang=N: the N-th wait for the device finds
// it lost, or hanging; software=1: EWA_BACKEND_AUTO takes devices that are software; auto=gl: and finds them faster.
#ifndef EWA_SRC_GL_TUNING_H
#define EWA_SRC_GL_TUNING_H

#include <stdbool.h>
#include <stdint.h>

/// Returns the number that a name has, or `otherwise`.
uint64_t ewa_gl_tuning(const char *name, uint64_t otherwise);

/// Whether a name has that word.
bool ewa_gl_tuning_is(const char *name, const char *word);

#endif
