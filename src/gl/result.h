// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the device makes of a band of rows: bytes and planes, those first that the caller gets. Eye-dome lighting needs colours and
// depths, too, and averages the parts of pixels; these stay on the device.
#ifndef EWA_SRC_GL_RESULT_H
#define EWA_SRC_GL_RESULT_H

#include "surface/eye_dome.h"

/// Planes of a frame.
typedef enum ewa_gl_plane_kind {
    EWA_GL_BYTES,
    EWA_GL_COLORS,
    EWA_GL_DEPTHS,
    EWA_GL_NORMALS,
    EWA_GL_COVERAGES,
    EWA_GL_PLANES
} ewa_gl_plane_kind;

/// A plane of the band.
typedef struct ewa_gl_plane {
    uint8_t *to;        ///< where the caller has the band's first pixel; NULL: it gets none
    uint32_t words;     ///< of a pixel
    int64_t at;         ///< its first word of the result; -1: it is not made
    int64_t mean_at;    ///< that of the averages, which the caller gets instead; -1: there are none
} ewa_gl_plane;

typedef struct ewa_gl_result {
    ewa_gl_plane planes[EWA_GL_PLANES];
    uint32_t finer;        ///< parts of a pixel along each side that are averaged; 1: none are
    uint64_t pixel_count; ///< that the caller gets
    uint64_t read_words, words; ///< those from the start that the caller gets; all
} ewa_gl_result;

/// Lists what is made of so many pixels of a frame that is drawn into `drawn`, from pixel `first` on; of `finer` squared in one
/// their average, for planes of that size. `eye_dome` lights it on the device; NULL: nothing does.
ewa_gl_result ewa_gl_result_of(const ewa_resolve *drawn, const ewa_eye_dome_pass *eye_dome, uint32_t finer, uint64_t first,
                               uint64_t pixel_count);

/// Copies what the caller gets, from `words` that were read back.
void ewa_gl_result_copy(const ewa_gl_result *result, const uint8_t *words);

#endif
