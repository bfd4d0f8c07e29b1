// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A sheet of the photographs that pictures differ from most: photograph, picture, difference.
#ifndef EWA_CLI_RENDER_COMPARE_SHEET_H
#define EWA_CLI_RENDER_COMPARE_SHEET_H

#include "cli/base/session.h"

enum { SHEET_MAX_ROWS = 64, SHEET_COLUMNS = 3 };

/// A row: three small pictures of one size.
typedef struct sheet_row {
    double psnr_db, ssim;
    char name[128];
    uint32_t width_px, height_px;
    uint8_t *rgba8[SHEET_COLUMNS];
} sheet_row;

/// The worst so far, worst first. Zero-initialise but for `limit`.
typedef struct compare_sheet {
    uint32_t limit, count; ///< `limit` at most SHEET_MAX_ROWS
    sheet_row rows[SHEET_MAX_ROWS];
} compare_sheet;

/// Takes a photograph onto the sheet if it is among the worst. Returns false after reporting.
bool compare_sheet_add(cli_session *session, compare_sheet *sheet, const char *name, const ewa_photo_comparison *found);

/// Writes the sheet; false after reporting.
bool compare_sheet_save(cli_session *session, const compare_sheet *sheet, const char *path);
void compare_sheet_free(compare_sheet *sheet);

#endif
