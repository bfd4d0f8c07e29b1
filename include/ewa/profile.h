// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Profiles: the points of a scene beside a line on the map, by how far along it and how high they are; as points with all
// that their files say, and as a graph. docs/profile.md.
#ifndef EWA_PROFILE_H
#define EWA_PROFILE_H

#include "ewa/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { EWA_PROFILE_CORNERS = 1024 }; ///< of a line, at most

/// Streams that the points of a profile have beside those of their files, F64, world units: how far along the line, from its
/// first corner on; how far to its right, seen from above, to its left below zero; how far along what is up, from the world's
/// origin on (tables of text call z a height).
#define EWA_PROFILE_STATION "station"
#define EWA_PROFILE_OFFSET  "offset"
#define EWA_PROFILE_HEIGHT  "profile_height"

/// What is taken beside a line. Fill with ewa_profile_options_init().
typedef struct ewa_profile_options {
    size_t struct_size;
    double width_world; ///< of the strip, half of it on each side; (0, 1e30]; default 1
    /// What is up, any length; zeros (default): as the scene's options, else its files say, z of surveyed ones, else as
    /// ewa_scene_place_camera() finds it.
    double up_world[3];
} ewa_profile_options;

EWA_API extern const ewa_option_table ewa_profile_options_table;
EWA_API void ewa_profile_options_init(ewa_profile_options *options, size_t struct_size);

/// The points beside a line; free with ewa_profile_free().
typedef struct ewa_profile {
    ewa_context *context;
    ewa_cloud *points;   ///< by station, then height and offset; may be none
    uint8_t *srgb;       ///< 3 of each point: as the scene colours it without light; grey 96 of those without a colour
    double length_world; ///< of the line, seen from above
    double up_world[3];  ///< unit
    const char *unit;    ///< of the world, as ewa_scene_info.unit; NULL: nothing says it
} ewa_profile;

/// Reads a line: "x,y;x,y;..." or with three numbers a corner, world units; the third is 0 where there are two.
/// `corners_world` has room for 3 numbers of EWA_PROFILE_CORNERS corners. What is wrong goes to `problem`, which may be NULL. Any
/// thread. Errors: EWA_ERROR_ARGUMENT (no numbers, fewer than two corners, too many).
EWA_API ewa_status ewa_profile_line_read(const char *text, double *corners_world, uint32_t *corner_count,
                                         char problem[EWA_OPTION_TEXT_BYTES]);

/// Takes the points of a scene beside a line of `corner_count` >= 2 corners, 3 numbers each in `corners_world`, of which only
/// what is across the up axis counts:
/// those that are visible, not cut away by the sections of the scene's options, no farther from the line than half the
/// width, and not before its first corner nor beyond its last one. A point is beside the nearest place of the line, at a
/// bend the earlier one. Clouds and octrees have points; meshes those on their faces; Gaussians, volumes and resident
/// surfels have none, which a note says. Stations, offsets and heights are decimals of a thousandth of the files' grid,
/// where they have one. The caller frees `*profile`, zeroed after a failure. One thread per context; octrees are used
/// meanwhile. Errors: EWA_ERROR_ARGUMENT (options; a line without a length; points that are gone), EWA_ERROR_NUMERIC, EWA_ERROR_MEMORY, those
/// of ewa_lod_read(), ewa_clouds_color() and ewa_scene_place_camera().
EWA_API ewa_status ewa_scene_profile(ewa_scene *scene, const double *corners_world, uint32_t corner_count,
                                     const ewa_profile_options *options, ewa_profile *profile);

/// Frees a profile and zeroes it; accepts NULL and a zeroed struct.
EWA_API void ewa_profile_free(ewa_profile *profile);

/// How the graph of a profile looks. Fill with ewa_profile_graph_options_init().
typedef struct ewa_profile_graph_options {
    size_t struct_size;
    double exaggeration;  ///< pixels of a unit of height by those of a unit of the line; [0, 1e6]; 0 (default): it fills the room
    double point_size_px; ///< diameter of dots; [0, 256]; 0 (default): 2 points
    double pixel_scale;   ///< pixels per point, of which text has 12; [0, 100]; 0 (default): as of furniture
    const char *title;    ///< UTF-8, borrowed; NULL: none
    const char *unit;     ///< of the world, behind the names of the axes; NULL: that of the profile
} ewa_profile_graph_options;

EWA_API extern const ewa_option_table ewa_profile_graph_options_table;
EWA_API void ewa_profile_graph_options_init(ewa_profile_graph_options *options, size_t struct_size);

/// Draws the graph of a profile on white: stations to the right, heights upward, dots in the points' colours, those nearest
/// to the line over the others; a step of the vertical scale that is not that of the horizontal one is written above. What
/// has no room is left out. The same bytes on every machine. `options` may be NULL. Errors (the canvas is unchanged):
/// EWA_ERROR_ARGUMENT, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_profile_draw(const ewa_profile *profile, const ewa_profile_graph_options *options,
                                    const ewa_canvas *canvas);

#ifdef __cplusplus
}
#endif
#endif
