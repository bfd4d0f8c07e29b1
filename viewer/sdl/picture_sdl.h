// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The viewer's picture in a window.
#ifndef EWA_VIEWER_SDL_PICTURE_H
#define EWA_VIEWER_SDL_PICTURE_H

#include <SDL.h>

#include "viewer/viewer.h"

/// Where pictures go.
typedef struct picture_window {
    SDL_Renderer *renderer;
    bool software; ///< the processor draws the window
    SDL_Texture *texture;
    uint32_t width_px, height_px; ///< of the texture
    uint64_t number;              ///< of the picture in it; 0: none
} picture_window;

/// Makes a renderer for a window: one of a GPU, where a real one drives the screen. Returns false with SDL's
/// error; else ends with picture_window_close().
bool picture_window_open(SDL_Window *window, picture_window *opened);
void picture_window_close(picture_window *window);

/// Draws a picture over the window right of `left_px` and below `top_px`, over a checkerboard where it is transparent;
/// nothing is presented. `scale`: pixels per point.
void picture_window_draw(picture_window *window, const viewer_picture *picture, double scale, int left_px, int top_px);

/// Writes a row of pixels as XRGB; what is transparent lies over a checkerboard of `cell_px`.
void picture_row(const uint8_t *rgba8, uint32_t width_px, uint32_t y_px, uint32_t cell_px, uint32_t *xrgb);

#endif
