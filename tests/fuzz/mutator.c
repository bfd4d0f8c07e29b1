// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What libFuzzer calls for a new input.
#include "grammar.h"

size_t LLVMFuzzerMutate(uint8_t *bytes, size_t size_bytes, size_t room_bytes);
size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size_bytes, size_t room_bytes, unsigned seed);

size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size_bytes, size_t room_bytes, unsigned seed) {
    if (seed % 4 == 0 || !fuzz_grammar_edit(bytes, &size_bytes, room_bytes, seed)) return LLVMFuzzerMutate(bytes, size_bytes, room_bytes);
    return size_bytes;
}
