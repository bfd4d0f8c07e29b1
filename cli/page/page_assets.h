// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What every page brings along: the modules, scripts and style of page/, where they are installed or built.
#ifndef EWA_CLI_PAGE_ASSETS_H
#define EWA_CLI_PAGE_ASSETS_H

#include "cli/base/session.h"

/// Files of a page, in the order of page_asset_names.
typedef enum page_asset {
    PAGE_FILES_JS,
    PAGE_RANGES_JS,
    PAGE_MODULE_JS,
    PAGE_THREADS_JS,
    PAGE_PICTURES_JS,
    PAGE_WORKER_JS,
    PAGE_LOOK_JS,
    PAGE_VIEW_JS,
    PAGE_SINGLE_JS,
    PAGE_STYLE_CSS,
    PAGE_EXACT_WASM,
    PAGE_RELAXED_WASM, ///< may be missing
    PAGE_ASSET_COUNT,
} page_asset;

extern const char *const page_asset_names[PAGE_ASSET_COUNT];

/// Bytes in memory, ended by a 0 that does not count.
typedef struct page_bytes {
    char *bytes;
    size_t size_bytes;
} page_bytes;

typedef struct page_assets {
    page_bytes each[PAGE_ASSET_COUNT];
} page_assets;

/// Loads all of them from `folder`, or, where that is NULL, from beside the program. False after reporting, which says how to
/// get them; free with page_assets_free() in any case.
bool page_assets_load(cli_session *session, const char *folder, page_assets *assets);
void page_assets_free(page_assets *assets);

/// Makes one script of modules, in an order in which each finds what it needs: lines of imports go, and the word export in front
/// of a line. False: no memory.
bool page_assets_join(const page_assets *assets, const page_asset *modules, size_t count, page_bytes *joined);

/// Reads a whole file; false with an error number.
bool page_bytes_read(const char *path, page_bytes *read, int *error);
void page_bytes_free(page_bytes *bytes);

#endif
