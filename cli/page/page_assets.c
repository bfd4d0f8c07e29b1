// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What every page brings along: the modules, scripts and style of page/, where they are installed or built.
#include "cli/page/page_assets.h"
#include "cli/base/path.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const page_asset_names[PAGE_ASSET_COUNT] = {
    "files.js", "ranges.js", "module.js", "threads.js", "pictures.js", "worker.js", "look.js", "ewa-view.js",
    "single.js", "page.css", "page.wasm.gz", "page-relaxed.wasm.gz"};

/// Where a file of that number is from the program's folder on: installed; built, by `make` and `make wasm`.
static const char *place_of(int asset, int place) {
    static const char *const scripts[] = {"../share/ewa/page/", "../page/", NULL};
    static const char *const exact[] = {"../share/ewa/page/", "../../wasm/page/", NULL};
    static const char *const relaxed[] = {"../share/ewa/page/", "../../wasm-relaxed/page/", NULL};
    return (asset == PAGE_EXACT_WASM ? exact : asset == PAGE_RELAXED_WASM ? relaxed : scripts)[place];
}

bool page_bytes_read(const char *path, page_bytes *read, int *error) {
    *read = (page_bytes){.bytes = NULL};
    FILE *file = fopen(path, "rb");
    *error = errno;
    if (!file) return false;
    bool done = fseek(file, 0, SEEK_END) == 0;
    const long size = done ? ftell(file) : -1;
    done = size >= 0 && fseek(file, 0, SEEK_SET) == 0;
    *error = errno;
    if (done) {
        read->bytes = malloc((size_t)size + 1);
        done = read->bytes && fread(read->bytes, 1, (size_t)size, file) == (size_t)size;
        *error = read->bytes ? EIO : ENOMEM;
    }
    fclose(file);
    if (done) {
        read->size_bytes = (size_t)size;
        read->bytes[size] = 0;
    } else {
        page_bytes_free(read);
    }
    return done;
}

void page_bytes_free(page_bytes *bytes) {
    free(bytes->bytes);
    *bytes = (page_bytes){.bytes = NULL};
}

/// Loads one and writes where it is. Returns 0, ENOENT where it is nowhere, or the error of a file that cannot be read.
static int load_one(const char *folder, int asset, page_bytes *read, char path[PATH_BYTES]) {
    char own[PATH_BYTES] = "";
    if (!folder && !path_of_own_folder(own)) return ENOENT;
    const char *place;
    for (int i = 0; (place = folder ? (i ? NULL : folder) : place_of(asset, i)); i++) {
        const char *name = page_asset_names[asset];
        const bool built = asset == PAGE_RELAXED_WASM && strstr(place, "wasm-relaxed"); // where both have one name
        const int length = snprintf(path, PATH_BYTES, "%s%s%s%s", own, place, folder ? "/" : "", built ? page_asset_names[PAGE_EXACT_WASM] : name);
        int error = ENAMETOOLONG;
        if (length > 0 && length < PATH_BYTES && page_bytes_read(path, read, &error)) return 0;
        if (error != ENOENT) return error;
    }
    return ENOENT;
}

bool page_assets_load(cli_session *session, const char *folder, page_assets *assets) {
    memset(assets, 0, sizeof *assets);
    for (int i = 0; i < PAGE_ASSET_COUNT; i++) {
        char path[PATH_BYTES] = "";
        const int error = load_one(folder, i, &assets->each[i], path);
        if (!error || (error == ENOENT && i == PAGE_RELAXED_WASM)) continue;
        session->subject = NULL;
        if (error != ENOENT)
            session_fail(session, "%s%s: %s", folder ? "--assets: " : "", path, strerror(error));
        else if (folder)
            session_fail(session, "--assets: %s: there is no %s", folder, page_asset_names[i]);
        else
            session_fail(session,
                         "page: %s, which pages draw with, is not installed: `make wasm` in the sources builds it, and "
                         "`make install` puts it where it is found; --assets names another folder",
                         page_asset_names[i]);
        return false;
    }
    if (!assets->each[PAGE_RELAXED_WASM].bytes)
        session_warn(session, "page: without %s pages draw some four times as slowly", page_asset_names[PAGE_RELAXED_WASM]);
    return true;
}

void page_assets_free(page_assets *assets) {
    for (int i = 0; i < PAGE_ASSET_COUNT; i++) page_bytes_free(&assets->each[i]);
}

bool page_assets_join(const page_assets *assets, const page_asset *modules, size_t count, page_bytes *joined) {
    static const char import[] = "import ", export[] = "export ";
    size_t room = 1;
    for (size_t i = 0; i < count; i++) room += assets->each[modules[i]].size_bytes + 1;
    *joined = (page_bytes){.bytes = malloc(room)};
    if (!joined->bytes) return false;
    char *to = joined->bytes;
    for (size_t i = 0; i < count; i++) {
        for (const char *line = assets->each[modules[i]].bytes; *line;) {
            const size_t length = strcspn(line, "\n");
            const bool is_import = strncmp(line, import, sizeof import - 1) == 0;
            const size_t skip = strncmp(line, export, sizeof export - 1) == 0 ? sizeof export - 1 : 0;
            if (!is_import) {
                memcpy(to, line + skip, length - skip);
                to += length - skip;
                *to++ = '\n';
            }
            line += length + (line[length] == '\n');
        }
    }
    *to = 0;
    joined->size_bytes = (size_t)(to - joined->bytes);
    return true;
}
