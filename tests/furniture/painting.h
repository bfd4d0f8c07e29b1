// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Canvases for tests.
#ifndef EWA_TESTS_PAINTING_H
#define EWA_TESTS_PAINTING_H

#include "check.h"

/// A canvas of its own memory, so that a sanitizer sees what is written beside it.
static inline ewa_canvas painting_make(uint32_t width_px, uint32_t height_px, const uint8_t rgba[4]) {
    ewa_canvas canvas = {malloc((size_t)width_px * height_px * 4), width_px, height_px};
    assert_non_null(canvas.rgba8);
    for (size_t i = 0; i < (size_t)width_px * height_px; i++) memcpy(canvas.rgba8 + 4 * i, rgba, 4);
    return canvas;
}

/// The same, with nothing on it: what is drawn shows in alpha how much of each pixel it covers.
static inline ewa_canvas painting_empty(uint32_t width_px, uint32_t height_px) {
    return painting_make(width_px, height_px, (const uint8_t[4]){0, 0, 0, 0});
}

static inline const uint8_t *painting_at(const ewa_canvas *canvas, uint32_t x, uint32_t y) {
    return canvas->rgba8 + 4 * ((size_t)y * canvas->width_px + x);
}

/// Fills the pixels from one corner up to another, which does not belong to them.
static inline void painting_fill(const ewa_canvas *canvas, uint32_t left, uint32_t top, uint32_t right, uint32_t bottom,
                                 const uint8_t rgba[4]) {
    for (uint32_t y = top; y < bottom; y++)
        for (uint32_t x = left; x < right; x++) memcpy(canvas->rgba8 + 4 * ((size_t)y * canvas->width_px + x), rgba, 4);
}

/// Sum of all pixels' coverage.
static inline double painting_area(const ewa_canvas *canvas) {
    double sum = 0;
    for (size_t i = 0; i < (size_t)canvas->width_px * canvas->height_px; i++)
        sum += canvas->rgba8[4 * i + 3] / 255.0;
    return sum;
}

/// FNV-1a of all bytes.
static inline uint64_t painting_hash(const ewa_canvas *canvas) {
    uint64_t hash = 0xcbf29ce484222325u;
    for (size_t i = 0; i < (size_t)canvas->width_px * canvas->height_px * 4; i++)
        hash = (hash ^ canvas->rgba8[i]) * 0x100000001b3u;
    return hash;
}

static inline bool painting_same(const ewa_canvas *a, const ewa_canvas *b) {
    return a->width_px == b->width_px && a->height_px == b->height_px &&
           memcmp(a->rgba8, b->rgba8, (size_t)a->width_px * a->height_px * 4) == 0;
}

static inline void painting_clear(const ewa_canvas *canvas) {
    memset(canvas->rgba8, 0, (size_t)canvas->width_px * canvas->height_px * 4);
}

#endif
