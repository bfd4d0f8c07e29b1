// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Edits of inputs by what they are: values of JSON and XML, words of headers in text, fields of headers in binary. Bytes that
// are changed one by one seldom get past the tokenizer, and never say "count": 4294967295 in an otherwise whole file.
//
// Every target is linked with mutator.c, whose LLVMFuzzerCustomMutator takes such an edit three times of four, and libFuzzer's own
// otherwise and where no edit fits.
#ifndef EWA_TESTS_FUZZ_GRAMMAR_H
#define EWA_TESTS_FUZZ_GRAMMAR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// An input that is edited in place. Once an edit did not fit, `full` stays set and the bytes are not to be used.
typedef struct fuzz_input {
    uint8_t *bytes;
    size_t size_bytes, room_bytes;
    uint64_t random; ///< state of fuzz_below()
    bool full;
} fuzz_input;

/// A part of an input; `begin` <= `end` <= size_bytes.
typedef struct fuzz_span {
    size_t begin, end;
    size_t whole_begin; ///< of what is removed or doubled: before the key of a member, else `begin`
    char kind;          ///< says what it may be exchanged with
} fuzz_span;

enum { FUZZ_SPANS = 4096 }; ///< what an input has beyond these is never edited

typedef struct fuzz_spans {
    fuzz_span items[FUZZ_SPANS];
    size_t count;
} fuzz_spans;

/// A number below `limit`, which is at least 1.
uint32_t fuzz_below(fuzz_input *input, uint32_t limit);
/// Puts `with_bytes` bytes, which may lie in the input, in the place of those from `begin` to `end`.
void fuzz_splice(fuzz_input *input, size_t begin, size_t end, const void *with, size_t with_bytes);
/// A number that readers are known to stumble over, as text: borders of integers and floats.
const char *fuzz_number_word(fuzz_input *input);
/// Puts a number near the one that the span begins with in its place: counts are often right but for one.
void fuzz_change_number(fuzz_input *input, const fuzz_span *span);
/// Notes a span, unless there are FUZZ_SPANS.
void fuzz_note(fuzz_spans *spans, size_t begin, size_t end, size_t whole_begin, char kind);

/// Lists the values of the JSON text that begins at `begin`; returns where it ends, or 0 when there is none.
size_t fuzz_json_spans(const fuzz_input *input, size_t begin, fuzz_spans *spans);
/// Changes one of them.
void fuzz_json_edit(fuzz_input *input, const fuzz_spans *spans);

/// The same for XML: values of attributes, texts and elements.
size_t fuzz_xml_spans(const fuzz_input *input, size_t begin, fuzz_spans *spans);
void fuzz_xml_edit(fuzz_input *input, const fuzz_spans *spans);

/// Changes a word or a line of the text that the input begins with; false when it begins with none.
bool fuzz_words_edit(fuzz_input *input);
/// Changes a field of a header: one that the format is known to have, or any aligned one.
void fuzz_field_edit(fuzz_input *input);

/// Whether the input is an E57 file: `plain` becomes its pages without their checksums; give it to fuzz_e57_close().
bool fuzz_e57_open(const fuzz_input *input, fuzz_input *plain);
/// Puts pages back, with zeros for checksums, which the target makes fit, and frees `plain`.
void fuzz_e57_close(fuzz_input *input, fuzz_input *plain);
/// Makes the lengths of what the text from `begin` to `end` lies in (a chunk of a GLB, a stored file of a zip archive, the XML of an
/// E57) those that it has after it ends at `new_end`. Text in other files needs none.
void fuzz_fit_lengths(fuzz_input *input, size_t begin, size_t end, size_t new_end);

/// Makes one edit. False, with the bytes as they were, when there is nothing to edit or no room for it.
bool fuzz_grammar_edit(uint8_t *bytes, size_t *size_bytes, size_t room_bytes, uint64_t seed);

#endif
