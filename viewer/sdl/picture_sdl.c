// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The viewer's picture in a window: one streaming texture, and who draws it.
#include "picture_sdl.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

/// Side of a field of the checkerboard, points, and its two greys.
static const double cell_points = 10;
static const uint32_t checker_gray[2] = {0x60, 0x70};

/// Whether OpenGL is played by the processor, which takes five times what drawing without OpenGL takes, from
/// the cores that draw the picture.
static bool opengl_is_software(void) {
    enum { GL_RENDERER_NAME = 0x1F01 };
    const char *(*get_string)(unsigned);
    void *found = SDL_GL_GetProcAddress("glGetString");
    if (!found) return false;
    memcpy(&get_string, &found, sizeof get_string);
    const char *name = get_string(GL_RENDERER_NAME);
    static const char *const players[] = {"llvmpipe", "softpipe", "swrast", "SWR", "Software"};
    for (size_t i = 0; name && i < SDL_arraysize(players); i++)
        if (strstr(name, players[i])) return true;
    return false;
}

/// Whether there may be a GPU: asking OpenGL takes 0.2 s of the first picture's time where there is none.
static bool gpu_is_likely(void) {
#ifdef __linux__
    static const char *const nodes[] = {"/dev/dri/renderD128", "/dev/dri/renderD129", "/dev/nvidia0",
                                        "/dev/dxg"};
    for (size_t i = 0; i < SDL_arraysize(nodes); i++)
        if (access(nodes[i], F_OK) == 0) return true;
    return false;
#else
    return true;
#endif
}

bool picture_window_open(SDL_Window *window, picture_window *opened) {
    *opened = (picture_window){.renderer = NULL};
    const bool asked = SDL_GetHint(SDL_HINT_RENDER_DRIVER) != NULL;
    if (asked || gpu_is_likely())
        opened->renderer = SDL_CreateRenderer(window, -1, SDL_RENDERER_PRESENTVSYNC);
    SDL_RendererInfo facts = {.name = ""};
    if (opened->renderer) SDL_GetRendererInfo(opened->renderer, &facts);
    if (!asked && strncmp(facts.name, "opengl", 6) == 0 && opengl_is_software()) {
        SDL_DestroyRenderer(opened->renderer);
        opened->renderer = NULL;
    }
    if (!opened->renderer) opened->renderer = SDL_CreateRenderer(window, -1, SDL_RENDERER_SOFTWARE);
    if (opened->renderer) SDL_GetRendererInfo(opened->renderer, &facts);
    opened->software = (facts.flags & SDL_RENDERER_SOFTWARE) != 0;
    return opened->renderer != NULL;
}

void picture_window_close(picture_window *window) {
    if (window->texture) SDL_DestroyTexture(window->texture);
    if (window->renderer) SDL_DestroyRenderer(window->renderer);
    *window = (picture_window){.texture = NULL};
}

void picture_row(const uint8_t *rgba8, uint32_t width_px, uint32_t y_px, uint32_t cell_px, uint32_t *xrgb) {
    uint8_t opaque = 255;
    for (uint32_t x = 0; x < width_px; x++) opaque &= rgba8[4 * x + 3];
    if (opaque == 255) {
        for (uint32_t x = 0; x < width_px; x++)
            xrgb[x] = (uint32_t)rgba8[4 * x] << 16 | (uint32_t)rgba8[4 * x + 1] << 8 | rgba8[4 * x + 2];
        return;
    }
    for (uint32_t x = 0; x < width_px; x++) {
        const uint8_t *from = rgba8 + 4 * (size_t)x;
        const uint32_t under = checker_gray[(x / cell_px + y_px / cell_px) & 1];
        uint32_t mixed = 0;
        for (int i = 0; i < 3; i++)
            mixed = mixed << 8 | (from[i] * (uint32_t)from[3] + under * (255u - from[3]) + 127) / 255;
        xrgb[x] = mixed;
    }
}

/// Makes the texture's size that of the picture.
static bool fit(picture_window *window, const viewer_picture *picture) {
    if (window->texture && window->width_px == picture->width_px && window->height_px == picture->height_px)
        return true;
    if (window->texture) SDL_DestroyTexture(window->texture);
    window->number = 0;
    window->width_px = picture->width_px;
    window->height_px = picture->height_px;
    window->texture = SDL_CreateTexture(window->renderer, SDL_PIXELFORMAT_RGB888, SDL_TEXTUREACCESS_STREAMING,
                                        (int)picture->width_px, (int)picture->height_px);
    if (!window->texture) return false;
    SDL_SetTextureBlendMode(window->texture, SDL_BLENDMODE_NONE);
    // Without a GPU, between pixels is a matter of milliseconds that the next picture needs.
    SDL_SetTextureScaleMode(window->texture, window->software ? SDL_ScaleModeNearest : SDL_ScaleModeLinear);
    return true;
}

/// Moves the picture to the texture.
static void upload(picture_window *window, const viewer_picture *picture, uint32_t cell_px) {
    void *pixels;
    int stride_bytes;
    if (SDL_LockTexture(window->texture, NULL, &pixels, &stride_bytes) != 0) return;
    for (uint32_t y = 0; y < picture->height_px; y++)
        picture_row(picture->rgba8 + 4 * (size_t)y * picture->width_px, picture->width_px, y, cell_px,
                    (uint32_t *)((uint8_t *)pixels + (size_t)y * (size_t)stride_bytes));
    SDL_UnlockTexture(window->texture);
    window->number = picture->number;
}

void picture_window_draw(picture_window *window, const viewer_picture *picture, double scale, int left_px, int top_px) {
    int width_px = 0, height_px = 0;
    SDL_GetRendererOutputSize(window->renderer, &width_px, &height_px);
    const SDL_Rect place = {left_px, top_px, width_px - left_px, height_px - top_px};
    const bool shown = picture->number && picture->rgba8 && fit(window, picture);
    if (!shown || left_px || top_px) {
        SDL_SetRenderDrawColor(window->renderer, 0x20, 0x22, 0x25, 255);
        SDL_RenderClear(window->renderer);
    }
    if (!shown) return;
    if (window->number != picture->number) {
        const double share = place.w > 0 ? (double)picture->width_px / place.w : 1;
        upload(window, picture, (uint32_t)fmax(1, nearbyint(cell_points * scale * share)));
    }
    SDL_RenderCopy(window->renderer, window->texture, NULL, &place);
}
