// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours from an attribute.
#ifndef EWA_CLI_COLOR_BY_H
#define EWA_CLI_COLOR_BY_H

#include "session.h"

/// Colormaps of color_by() beside those of the library.
enum {
    COLOR_BY_AUTO = -1, ///< classes for whole numbers that are called so, else viridis
    COLOR_BY_CLASSES = EWA_COLORMAP_COOLWARM + 1, ///< whole numbers by ewa_class_color()
};

/// What the colours mean.
typedef struct color_scale {
    ewa_colormap colormap;
    double range[2];          ///< numbers of the first and the last colour
    bool length;              ///< the numbers are lengths of the world
    ewa_category *categories; ///< classes in place of numbers, by code; NULL: none
    char (*names)[EWA_CLASS_NAME_BYTES];
    uint32_t category_count;
} color_scale;

/// Whether an attribute of this name holds codes of classes, where it holds whole numbers.
bool color_by_names_classes(const char *name);

/// Whether color_by() shows an attribute as classes when neither colormap nor range are given.
bool color_by_shows_classes(cli_session *session, const ewa_cloud *cloud, const char *word);

/// Whether a word means the file's own colours.
bool color_by_is_own(const char *word);

/// Replaces the colours of a cloud by those of the number that a word means (ewa_cloud_find_scalar()), unless it
/// means the colours themselves; numbers that are not finite, or
/// no classes where those are shown, become grey. `colormap`: of the library, or COLOR_BY_*. A `range` that is not
/// given: from the least to the greatest, of intensities without the outermost two per cent. Returns false after reporting; free `scale` in any case.
bool color_by(cli_session *session, ewa_cloud *cloud, const char *word, int colormap,
              const option_bounds *range, color_scale *scale);
void color_scale_free(color_scale *scale);

#endif
