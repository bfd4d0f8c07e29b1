// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Runs a fuzz target over files and folders of files, so that a corpus is an ordinary test with any compiler.
#define _DEFAULT_SOURCE // scandir
#include "fuzz.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int replay_file(const char *path) {
    FILE *file = fopen(path, "rb");
    if (!file) {
        perror(path);
        return -1;
    }
    fseek(file, 0, SEEK_END);
    const long size = ftell(file);
    rewind(file);
    // Exactly as many bytes as the input has, so that a sanitizer sees the first one too many.
    uint8_t *bytes = size >= 0 ? malloc(size ? (size_t)size : 1) : NULL;
    const int whole = bytes && fread(bytes, 1, (size_t)size, file) == (size_t)size;
    fclose(file);
    if (whole) {
        printf("%s\n", path);
        fflush(stdout);
        LLVMFuzzerTestOneInput(bytes, (size_t)size);
    } else {
        fprintf(stderr, "%s: cannot be read\n", path);
    }
    free(bytes);
    return whole ? 1 : -1;
}

/// Returns the number of inputs that ran, or -1.
static int replay(const char *path) {
    struct dirent **entries;
    const int count = scandir(path, &entries, NULL, alphasort);
    if (count < 0) return replay_file(path);
    int total = 0;
    for (int i = 0; i < count; i++) {
        char inner[4096];
        if (total >= 0 && entries[i]->d_name[0] != '.') {
            snprintf(inner, sizeof inner, "%s/%s", path, entries[i]->d_name);
            const int ran = replay(inner);
            total = ran < 0 ? -1 : total + ran;
        }
        free(entries[i]);
    }
    free(entries);
    return total;
}

int main(int argument_count, char **arguments) {
    int total = 0;
    for (int i = 1; i < argument_count; i++) {
        const int ran = replay(arguments[i]);
        if (ran < 0) return EXIT_FAILURE;
        total += ran;
    }
    printf("%d inputs\n", total);
    // A corpus that went missing must not pass for a clean one.
    return total ? EXIT_SUCCESS : EXIT_FAILURE;
}
