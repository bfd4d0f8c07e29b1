// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target: command lines. The first byte chooses the command, the others are its words, each ended by a
// zero byte or a line feed. Nothing is executed.
#include "cli/base/commands.h"
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

enum { MAX_WORDS = 64 };

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    if (size_bytes == 0) return 0;
    const cli_command *command = all_commands[bytes[0] % all_commands_count];
    char *text = malloc(size_bytes);
    void *arguments = malloc(command->arguments_bytes);
    if (!text || !arguments) abort();
    memcpy(text, bytes + 1, size_bytes - 1);
    text[size_bytes - 1] = 0;
    const char *words[MAX_WORDS], *operands[MAX_WORDS];
    size_t count = 0;
    for (size_t i = 0; i < size_bytes - 1 && count < MAX_WORDS; i++) {
        words[count++] = text + i;
        while (i < size_bytes - 1 && text[i] && text[i] != '\n') i++;
        text[i] = 0;
    }
    char message[OPTION_ERROR_BYTES] = "";
    options_default(command, arguments);
    const bool accepted = options_parse(command, count, words, operands, arguments, message);
    const common_arguments *common = arguments;
    // A refusal says why; what is accepted keeps the promises that commands rely on.
    if (!accepted && !message[0]) abort();
    if (strlen(message) >= OPTION_ERROR_BYTES) abort();
    if (accepted && !common->help &&
        (common->operand_count < command->low_operands || common->operand_count > command->high_operands ||
         common->threads < 0 || common->threads > 256))
        abort();
    free(arguments);
    free(text);
    return 0;
}
