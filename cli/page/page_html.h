// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The text of pages.
#ifndef EWA_CLI_PAGE_HTML_H
#define EWA_CLI_PAGE_HTML_H

#include "cli/page/page_data.h"

/// Data of one page is text in base64, which browsers take up to 512 MB of.
#define PAGE_SINGLE_BYTES ((uint64_t)350 << 20)

/// What is said of a page.
typedef struct page_words {
    const char *title;
    bool color_bar; ///< what colours mean is shown
} page_words;

/// Writes a page that needs no other file: program, style and data are in it, and a policy that lets nothing else run or be asked for.
/// What was written is for the caller to check. False after reporting.
bool page_html_single(cli_session *session, const page_assets *assets, const page_data *data, const page_words *words, FILE *file);

/// Writes the page of a folder that a server has, beside what it needs. False with errno.
bool page_html_folder(const page_words *words, FILE *file);

#endif
