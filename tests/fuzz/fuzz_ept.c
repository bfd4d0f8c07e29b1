// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target of EPT folders: the input is ept.json, the hierarchy, one of its parts, and the file of the root's points,
// with "----" between them.
#define _GNU_SOURCE // mkdtemp, memmem
#include "fuzz_octree.h"

#include <sys/stat.h>
#include <unistd.h>

static const char *const names[] = {"ept.json", "ept-hierarchy/0-0-0-0.json", "ept-hierarchy/1-0-0-0.json",
                                    "ept-data/0-0-0-0."};
static const char *const suffixes[] = {"laz", "bin", "zst"};
enum { FILE_COUNT = 4, SUFFIX_COUNT = 3, PATH_BYTES = 128 };

static const char *path_of(const char *folder, int file, int suffix, char path[PATH_BYTES]) {
    snprintf(path, PATH_BYTES, "%s/%s%s", folder, names[file],
             file == FILE_COUNT - 1 ? suffixes[suffix] : "");
    return path;
}

static void write_file(const char *path, const uint8_t *bytes, size_t size_bytes) {
    FILE *file = fopen(path, "wb");
    fuzz_require(file && fwrite(bytes, 1, size_bytes, file) == size_bytes, "a file");
    fclose(file);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    char folder[] = "/tmp/ewa-fuzz-ept-XXXXXX", path[PATH_BYTES];
    const size_t whole_bytes = size_bytes;
    fuzz_require(mkdtemp(folder) != NULL, "a folder");
    for (int i = 0; i < 2; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, i ? "ept-data" : "ept-hierarchy");
        fuzz_require(mkdir(path, 0700) == 0, "a folder within");
    }
    for (int file = 0; file < FILE_COUNT; file++) {
        const uint8_t *end = file < FILE_COUNT - 1 ? memmem(bytes, size_bytes, "----", 4) : NULL;
        const size_t part_bytes = end ? (size_t)(end - bytes) : size_bytes;
        for (int i = 0; i < (file < FILE_COUNT - 1 ? 1 : SUFFIX_COUNT); i++)
            write_file(path_of(folder, file, i, path), bytes, part_bytes);
        bytes += part_bytes + (end ? 4 : 0);
        size_bytes -= part_bytes + (end ? 4 : 0);
    }
    fuzz_octree(folder, whole_bytes);
    for (int file = 0; file < FILE_COUNT; file++)
        for (int i = 0; i < SUFFIX_COUNT; i++) unlink(path_of(folder, file, i, path));
    for (int i = 0; i < 2; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, i ? "ept-data" : "ept-hierarchy");
        rmdir(path);
    }
    rmdir(folder);
    return 0;
}
