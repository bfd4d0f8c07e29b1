// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Opens what a mesh names by itself; open(path) in a comment, "fopen(" in a text and writer->open() are none.
#include <sys/stat.h>

static int look(const char *path, format *writer) {
    writer->open(path, "fopen(");
    FILE *file = fopen(path, "rb");
    return ewa_file_map(context, joined, &mapped);
}
