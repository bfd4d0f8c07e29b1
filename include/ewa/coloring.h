// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours of points that stand for a number: an attribute, one of its components, a coordinate.
#ifndef EWA_COLORING_H
#define EWA_COLORING_H

#include "ewa/base.h"
#include "ewa/cloud.h"
#include "ewa/furniture.h"
#include "ewa/image.h"
#include "ewa/options.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Colours of ewa_coloring beside those of ewa_colormap, which are these without the first and the last.
typedef enum ewa_coloring_map {
    EWA_COLORING_AUTO = 0, ///< classes for whole numbers that are called so and have no range, else viridis
    EWA_COLORING_VIRIDIS = 1,
    EWA_COLORING_TURBO = 2,
    EWA_COLORING_GRAY = 3,
    EWA_COLORING_PLASMA = 4,
    EWA_COLORING_INFERNO = 5,
    EWA_COLORING_MAGMA = 6,
    EWA_COLORING_CIVIDIS = 7,
    EWA_COLORING_COOLWARM = 8,
    EWA_COLORING_CLASSES = 9, ///< whole numbers by ewa_class_color()
} ewa_coloring_map;

enum { EWA_SCALAR_NAME_BYTES = EWA_NAME_BYTES + 4 };

/// How points are coloured. Fill with ewa_coloring_init().
typedef struct ewa_coloring {
    size_t struct_size;
    /// What ewa_cloud_find_scalar() takes: "intensity", "normal.x", "z", "red"; "rgb" or "color": the points' own colours;
    /// "none": these, or grey; empty (default) or "auto": likewise, but in scenes scans without colours show a strength of
    /// light or their height (docs/scene.md).
    char attribute[EWA_SCALAR_NAME_BYTES];
    ewa_coloring_map map; ///< default EWA_COLORING_AUTO
    bool ranged;          ///< `range` is given; default false: the smallest to the largest number, of strengths of light
                          ///< (intensity, nir, amplitude, reflectance) the 2nd to the 98th percentile
    bool percent[2];      ///< an end of `range` is a percentile, 0 to 100; default false
    double range[2];      ///< numbers of the first and the last colour
    bool tinted;          ///< without an attribute, all points have the colour `tint`; default false
    double tint[3];       ///< sRGB, [0, 1]
} ewa_coloring;

EWA_API extern const ewa_option_table ewa_coloring_table;
EWA_API void ewa_coloring_init(ewa_coloring *coloring, size_t struct_size);

/// Whether a word means the points' own colours: empty, "auto", "none", "rgb" or "color". Any thread.
EWA_API bool ewa_coloring_is_own(const char *attribute);

/// Whether an attribute of this name holds codes of classes, where it holds whole numbers. Any thread.
EWA_API bool ewa_coloring_names_classes(const char *name);

/// Different numbers that are all whole of which a legend shows each, unless a range is given; lengths, colours and strengths
/// of light have a bar.
enum { EWA_LEGEND_NUMBERS = 16 };

/// What colours mean; free with ewa_legend_free().
typedef struct ewa_legend {
    ewa_context *context;
    ewa_colormap colormap;    ///< of numbers
    double range[2];          ///< numbers of the first and the last colour
    bool length;              ///< the numbers are lengths of the world
    bool classes;             ///< colours are those of classes, not of numbers
    uint32_t category_count;  ///< classes, or the numbers where they are whole and at most EWA_LEGEND_NUMBERS; 0: none
    ewa_category *categories; ///< by code
    char *names; ///< of classes, EWA_CLASS_NAME_BYTES each
    uint64_t grey_count; ///< points whose number has no colour: not finite, or no class where these are shown
    char attribute[EWA_SCALAR_NAME_BYTES]; ///< the word for the number
} ewa_legend;

/// Replaces the colours of clouds by those of a number, on one scale for all of them; without an attribute by the tint,
/// or not at all. Points whose number has no colour become grey. After a failure the clouds may have lost their
/// colours. `*legend` is zeroed where the colours are the points' own. Errors: EWA_ERROR_ARGUMENT (no such attribute,
/// which cloud; own colours where there are none; options), EWA_ERROR_MEMORY. One thread per context.
EWA_API ewa_status ewa_clouds_color(ewa_cloud *const *clouds, uint32_t count, const ewa_coloring *coloring,
                                    ewa_legend *legend);

/// Frees a legend and zeroes it; accepts NULL and a zeroed struct.
EWA_API void ewa_legend_free(ewa_legend *legend);

#ifdef __cplusplus
}
#endif
#endif
