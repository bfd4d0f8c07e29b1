// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The contact sheet of ewa compare.
#include "cli/render/compare_sheet.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE_PX = 400, GAP_PX = 4, LABEL_PX = 26, TEXT_PX = 15 };

/// Differences are shown so many times as large.
static const double LOUDER = 4;

static void free_row(sheet_row *row) {
    for (int i = 0; i < SHEET_COLUMNS; i++) free(row->rgba8[i]);
    *row = (sheet_row){.width_px = 0};
}

/// What is seen of a pixel: photograph, picture, difference; display values. False: it was not compared.
static bool look_at(const ewa_photo_comparison *found, size_t pixel, double seen[SHEET_COLUMNS][3]) {
    const ewa_image *photo = &found->photo;
    const float *a = photo->pixels + pixel * photo->channel_count, *b = found->picture.pixels + 4 * pixel;
    double off = 0;
    for (int c = 0; c < 3; c++) {
        seen[0][c] = (double)ewa_srgb_from_linear(a[photo->channel_count < 3 ? 0 : c]);
        seen[1][c] = (double)ewa_srgb_from_linear(b[c]);
        off += fabs(seen[0][c] - seen[1][c]) / 3;
    }
    uint8_t srgb[3];
    ewa_colormap_color(EWA_COLORMAP_INFERNO, LOUDER * off, srgb);
    for (int c = 0; c < 3; c++) seen[2][c] = srgb[c] / 255.0;
    return photo->channel_count != 4 || a[3] > 0.999f;
}

/// Fills the three pictures of a row with means of squares of `step` pixels; grey where nothing was compared.
static void shrink(const ewa_photo_comparison *found, uint32_t step, sheet_row *row) {
    const uint32_t width = found->picture.width_px, height = found->picture.height_px;
    for (size_t i = 0; i < (size_t)row->width_px * row->height_px; i++) {
        const uint32_t left = step * (uint32_t)(i % row->width_px), top = step * (uint32_t)(i / row->width_px);
        double sums[SHEET_COLUMNS][3] = {{0}}, count = 0;
        for (uint32_t y = top; y < top + step && y < height; y++)
            for (uint32_t x = left; x < left + step && x < width; x++) {
                double seen[SHEET_COLUMNS][3];
                if (!look_at(found, (size_t)y * width + x, seen)) continue;
                for (int k = 0; k < SHEET_COLUMNS; k++)
                    for (int c = 0; c < 3; c++) sums[k][c] += seen[k][c];
                count++;
            }
        for (int k = 0; k < SHEET_COLUMNS; k++) {
            for (size_t c = 0; c < 3; c++)
                row->rgba8[k][4 * i + c] = count > 0 ? (uint8_t)(255 * sums[k][c] / count + 0.5) : 128;
            row->rgba8[k][4 * i + 3] = 255;
        }
    }
}

static bool out_of_memory(cli_session *session) {
    session_fail(session, "out of memory for the sheet");
    return false;
}

bool compare_sheet_add(cli_session *session, compare_sheet *sheet, const char *name, const ewa_photo_comparison *found) {
    uint32_t at = 0;
    while (at < sheet->count && sheet->rows[at].psnr_db <= found->quality.psnr_db) at++;
    if (at >= sheet->limit || isnan(found->quality.psnr_db)) return true;
    const uint32_t width = found->picture.width_px, height = found->picture.height_px;
    const uint32_t larger = width > height ? width : height, step = (larger + SIDE_PX - 1) / SIDE_PX;
    sheet_row row = {.psnr_db = found->quality.psnr_db,
                     .ssim = found->quality.ssim,
                     .width_px = (width + step - 1) / step,
                     .height_px = (height + step - 1) / step};
    strncat(row.name, name, sizeof row.name - 1);
    for (int i = 0; i < SHEET_COLUMNS; i++) {
        row.rgba8[i] = malloc((size_t)row.width_px * row.height_px * 4);
        if (row.rgba8[i]) continue;
        free_row(&row);
        return out_of_memory(session);
    }
    shrink(found, step, &row);
    if (sheet->count == sheet->limit) free_row(&sheet->rows[--sheet->count]);
    memmove(&sheet->rows[at + 1], &sheet->rows[at], (sheet->count - at) * sizeof row);
    sheet->rows[at] = row;
    sheet->count++;
    return true;
}

static void draw_row(const ewa_canvas *canvas, const sheet_row *row, uint32_t top_px) {
    static const uint8_t ink[4] = {235, 235, 235, 255};
    char label[256];
    snprintf(label, sizeof label, "%s   %.2f dB   SSIM %.4f", row->name, row->psnr_db, row->ssim);
    const ewa_text_style style = {
        .height_px = TEXT_PX, .rgba = {ink[0], ink[1], ink[2], ink[3]}, .anchor = EWA_TEXT_LEFT_MIDDLE};
    ewa_draw_text(canvas, label, GAP_PX, top_px + LABEL_PX / 2.0, &style);
    for (uint32_t k = 0; k < SHEET_COLUMNS; k++)
        for (uint32_t y = 0; y < row->height_px; y++) {
            const size_t to = (size_t)(top_px + LABEL_PX + y) * canvas->width_px + k * (row->width_px + GAP_PX);
            memcpy(canvas->rgba8 + 4 * to, row->rgba8[k] + 4 * (size_t)y * row->width_px, 4 * (size_t)row->width_px);
        }
}

bool compare_sheet_save(cli_session *session, const compare_sheet *sheet, const char *path) {
    static const uint8_t ground[4] = {40, 40, 40, 255};
    uint32_t width = 1, height = 0;
    for (uint32_t i = 0; i < sheet->count; i++) {
        const uint32_t own = SHEET_COLUMNS * (sheet->rows[i].width_px + GAP_PX) - GAP_PX;
        if (own > width) width = own;
        height += LABEL_PX + sheet->rows[i].height_px + GAP_PX;
    }
    if (!sheet->count) {
        session_fail(session, "%s: no photograph has a pixel that could be compared", path);
        return false;
    }
    uint8_t *rgba8 = malloc((size_t)width * height * 4);
    if (!rgba8) return out_of_memory(session);
    for (size_t i = 0; i < (size_t)width * height; i++) memcpy(rgba8 + 4 * i, ground, 4);
    const ewa_canvas canvas = {rgba8, width, height};
    uint32_t top = 0;
    for (uint32_t i = 0; i < sheet->count; i++) {
        draw_row(&canvas, &sheet->rows[i], top);
        top += LABEL_PX + sheet->rows[i].height_px + GAP_PX;
    }
    const ewa_status status = ewa_pixels_save(session->context, path, width, height, 4, rgba8, 4 * (size_t)width, NULL);
    free(rgba8);
    return session_passed(session, status);
}

void compare_sheet_free(compare_sheet *sheet) {
    for (uint32_t i = 0; i < sheet->count; i++) free_row(&sheet->rows[i]);
    sheet->count = 0;
}
